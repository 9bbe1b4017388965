/*
   Element - the table of formulations; -model_element chooses the row where the cells of a shape have several.

   DMPlex lists the corners of the first face of a cell counter-clockwise seen from outside, so that of a hexahedron's
   it gives 0, 3, 2, 1, of a tetrahedron's 1, 0, 2 and of a wedge's 0, 2, 1; closure_order undoes that.
*/
#include <squeal/element.h>
#include <string.h>
#include "kernels/element/geometric.h"
#include "kernels/element/solidshape.h"

#define INCOMPATIBLE "incompatible"
#define FULL         "full"
#define LOCKS        "too stiff in bending; mesh with second order: "

/* Bits of the corners around each node */
static const unsigned char at_tet[]   = {1, 2, 4, 8, 3, 6, 5, 9, 10, 12};
static const unsigned char at_wedge[] = {1, 2, 4, 8, 16, 32, 3, 6, 5, 24, 48, 40, 9, 18, 36};
static const unsigned char at_hex[]   = {1,   2,   4,  8,  16, 32,  64,  128, 3,  6,   12, 9,   48, 96,
                                         192, 144, 17, 34, 68, 136, 153, 102, 51, 204, 15, 240, 255};

#define ROW_TET   .shape = DM_POLYTOPE_TETRAHEDRON, .n_corners = 4, .closure_order = {1, 0, 2, 3}, .at = at_tet
#define ROW_WEDGE .shape = DM_POLYTOPE_TRI_PRISM, .n_corners = 6, .closure_order = {0, 2, 1, 3, 4, 5}, .at = at_wedge
#define ORDER_HEX .closure_order = {0, 3, 2, 1, 4, 5, 6, 7}
#define ROW_HEX   .shape = DM_POLYTOPE_HEXAHEDRON, .n_corners = 8, ORDER_HEX, .at = at_hex
#define ROW_SOLID .matrices = SolidMatrices, .geometric = SolidGeometric, .measure = SolidMeasure
#define ROW_HEX8  ROW_HEX, .name = "hex8", .vtk = 12, .xdmf = "Hexahedron", .xdmf_number = 9, .row_sums = PETSC_TRUE

/* clang-format off */
static const Element elements[] = {
  {.name        = "tet4",
   .description = "4-node tetrahedron",
   .warning     = LOCKS "tet10",
   .n_nodes     = 4,
   .solid       = &solid_tet4,
   .vtk         = 10,
   .xdmf        = "Tetrahedron",
   .xdmf_number = 6,
   .row_sums    = PETSC_TRUE,
   ROW_TET,
   ROW_SOLID},
  {.name        = "tet10",
   .description = "10-node tetrahedron",
   .n_nodes     = 10,
   .solid       = &solid_tet10,
   .vtk         = 24,
   .xdmf        = "Tetrahedron_10",
   .xdmf_number = 38,
   ROW_TET,
   ROW_SOLID},
  {.name        = "wedge6",
   .description = "6-node wedge",
   .warning     = LOCKS "wedge15",
   .n_nodes     = 6,
   .solid       = &solid_wedge6,
   .vtk         = 13,
   .xdmf        = "Wedge",
   .xdmf_number = 8,
   .row_sums    = PETSC_TRUE,
   ROW_WEDGE,
   ROW_SOLID},
  {.name        = "wedge15",
   .description = "15-node wedge",
   .n_nodes     = 15,
   .solid       = &solid_wedge15,
   .vtk         = 26,
   .xdmf        = "Wedge_15",
   .xdmf_number = 40,
   ROW_WEDGE,
   ROW_SOLID},
  {.formulation = INCOMPATIBLE,
   .description = "8-node hexahedron with incompatible modes (QM6)",
   .n_nodes     = 8,
   .solid       = &solid_hex8,
   .matrices    = Hex8IncompatibleMatrices,
   .geometric   = Hex8IncompatibleGeometric,
   .measure     = Hex8Measure,
   ROW_HEX8},
  {.formulation = FULL,
   .description = "8-node hexahedron, fully integrated",
   .n_nodes     = 8,
   .solid       = &solid_hex8,
   .matrices    = Hex8FullMatrices,
   .geometric   = Hex8FullGeometric,
   .measure     = Hex8Measure,
   ROW_HEX8},
  {.name        = "hex20",
   .description = "20-node hexahedron",
   .n_nodes     = 20,
   .solid       = &solid_hex20,
   .vtk         = 25,
   .xdmf        = "Hexahedron_20",
   .xdmf_number = 48,
   ROW_HEX,
   ROW_SOLID},
  {.name        = "hex27",
   .description = "27-node hexahedron",
   .n_nodes     = 27,
   .solid       = &solid_hex27,
   .vtk         = 29,
   .xdmf        = "Hexahedron_27",
   .xdmf_number = 50,
   .row_sums    = PETSC_TRUE,
   ROW_HEX,
   ROW_SOLID}
};
/* clang-format on */

#define N_ELEMENTS (sizeof(elements) / sizeof(elements[0]))

_Static_assert(N_ELEMENTS < ELEMENT_MAX_ROWS, "the table of elements is longer than those who list it take");

const Element *ElementFind(DMPolytopeType shape, PetscInt n_nodes, const char formulation[])
{
  for (size_t i = 0; i < N_ELEMENTS; i++) {
    const Element *e = &elements[i];

    if (e->shape == shape && e->n_nodes == n_nodes && (!e->formulation || !strcmp(e->formulation, formulation)))
      return e;
  }
  return NULL;
}

const Element *ElementGet(PetscInt i)
{
  return i < (PetscInt)N_ELEMENTS ? &elements[i] : NULL;
}

const Element *ElementPoint(void)
{
  static const Element point = {.name        = "point",
                                .xdmf        = "Polyvertex",
                                .shape       = DM_POLYTOPE_POINT,
                                .vtk         = 1,
                                .xdmf_number = 1,
                                .n_nodes     = 1,
                                .n_corners   = 1};

  return &point;
}

PetscBool ElementIsFormulation(const char formulation[])
{
  for (size_t i = 0; i < N_ELEMENTS; i++)
    if (elements[i].formulation && !strcmp(elements[i].formulation, formulation)) return PETSC_TRUE;
  return PETSC_FALSE;
}

const char *ElementFormulations(void)
{
  return INCOMPATIBLE ", " FULL;
}

PetscErrorCode ElementMatrices(const Element *e, const PetscReal x[], const Elasticity *material, PetscReal stiffness[],
                               PetscReal mass[])
{
  PetscFunctionBeginUser;
  PetscCheck(!e->matrices(e->solid, x, material, stiffness, mass), PETSC_COMM_SELF, PETSC_ERR_PLIB,
             "element is inverted");
  PetscFunctionReturn(0);
}

PetscErrorCode ElementGeometric(const Element *e, const PetscReal x[], const Elasticity *material, const PetscReal u[],
                                PetscReal stiffness[])
{
  PetscFunctionBeginUser;
  PetscCheck(!e->geometric(e->solid, x, material, u, stiffness), PETSC_COMM_SELF, PETSC_ERR_PLIB,
             "element is inverted");
  PetscFunctionReturn(0);
}

void ElementLump(const Element *e, const PetscReal mass[], PetscReal lumped[])
{
  const PetscInt n   = e->n_nodes;
  PetscReal      all = 0, trace = 0;
  PetscBool      positive = e->row_sums;

  for (PetscInt a = 0; a < n; a++) {
    lumped[a] = 0;
    for (PetscInt b = 0; b < n; b++) lumped[a] += mass[3 * a * (3 * n) + 3 * b];
    all += lumped[a];
    trace += mass[3 * a * (3 * n) + 3 * a];
    if (!(lumped[a] > 0)) positive = PETSC_FALSE;
  }
  for (PetscInt a = 0; a < n && !positive; a++) lumped[a] = mass[3 * a * (3 * n) + 3 * a] * all / trace;
}
