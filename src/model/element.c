/*
   Element - the table of formulations; -model_element chooses the row among those of the mesh's cell shape.

   DMPlex lists the bottom face of a hexahedron as its nodes 0, 3, 2, 1, that is counter-clockwise seen from outside,
   and the top face as 4, 5, 6, 7; closure_order undoes the former.
*/
#include <squeal/element.h>
#include <string.h>
#include "kernels/geometric.h"

#define INCOMPATIBLE "incompatible"
#define FULL         "full"

static const Element elements[] = {
  {.formulation   = INCOMPATIBLE,
   .description   = "8-node hexahedron with incompatible modes (QM6)",
   .shape         = DM_POLYTOPE_HEXAHEDRON,
   .n_nodes       = HEX8_NODES,
   .closure_order = {0, 3, 2, 1, 4, 5, 6, 7},
   .matrices      = Hex8IncompatibleMatrices,
   .geometric     = Hex8IncompatibleGeometric,
   .measure       = Hex8Measure},
  {.formulation   = FULL,
   .description   = "8-node hexahedron, fully integrated",
   .shape         = DM_POLYTOPE_HEXAHEDRON,
   .n_nodes       = HEX8_NODES,
   .closure_order = {0, 3, 2, 1, 4, 5, 6, 7},
   .matrices      = Hex8FullMatrices,
   .geometric     = Hex8FullGeometric,
   .measure       = Hex8Measure}
};

const Element *ElementFind(DMPolytopeType shape, const char formulation[])
{
  for (size_t i = 0; i < sizeof(elements) / sizeof(elements[0]); i++) {
    if (elements[i].shape == shape && !strcmp(elements[i].formulation, formulation)) return &elements[i];
  }
  return NULL;
}

const char *ElementNames(void)
{
  return INCOMPATIBLE ", " FULL;
}
