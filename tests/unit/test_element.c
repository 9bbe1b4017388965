/*
   Unit test of the element table against real DMPlex meshes: the closure order of every row gives its node order.

   Meshes: a box of hexahedra, and two cells of which the second is numbered from another corner about another axis, so
   that their common face is turned in one of them.
*/
#include <squeal/element.h>
#include "check.h"
#include "boxmesh.h"

/* Smallest Jacobian measure over all cells, nodes taken in the element's order, and the sum of the volumes */
static PetscErrorCode MeasureMesh(DM dm, const Element *element, double *quality, double *total)
{
  PetscInt           c_start, c_end, v_start, v_end;
  PetscSection       section;
  Vec                coordinates;
  const PetscScalar *xyz;

  PetscFunctionBeginUser;
  PetscCall(DMPlexGetHeightStratum(dm, 0, &c_start, &c_end));
  PetscCall(DMPlexGetDepthStratum(dm, 0, &v_start, &v_end));
  PetscCall(DMGetCoordinateSection(dm, &section));
  PetscCall(DMGetCoordinatesLocal(dm, &coordinates));
  PetscCall(VecGetArrayRead(coordinates, &xyz));
  *quality = PETSC_MAX_REAL;
  *total   = 0;
  for (PetscInt c = c_start; c < c_end; c++) {
    PetscInt *closure = NULL, n_closure, vertices[ELEMENT_MAX_NODES], n = 0, offset;
    double    x[ELEMENT_MAX_DOFS], volume, min_jacobian;

    PetscCall(DMPlexGetTransitiveClosure(dm, c, PETSC_TRUE, &n_closure, &closure));
    for (PetscInt k = 0; k < n_closure; k++) {
      if (closure[2 * k] >= v_start && closure[2 * k] < v_end) vertices[n++] = closure[2 * k];
    }
    PetscCall(DMPlexRestoreTransitiveClosure(dm, c, PETSC_TRUE, &n_closure, &closure));
    for (PetscInt i = 0; i < element->n_nodes; i++) {
      PetscCall(PetscSectionGetOffset(section, vertices[element->closure_order[i]], &offset));
      for (PetscInt k = 0; k < 3; k++) x[3 * i + k] = PetscRealPart(xyz[offset + k]);
    }
    element->measure(x, &volume, &min_jacobian);
    *quality = PetscMin(*quality, min_jacobian);
    *total += volume;
  }
  PetscCall(VecRestoreArrayRead(coordinates, &xyz));
  PetscFunctionReturn(0);
}

/* Box of 2 x 3 x 2 cells, 1 x 1 x 1 m */
static PetscErrorCode CreateBox(DM *dm)
{
  const PetscInt faces[3] = {2, 3, 2};

  PetscFunctionBeginUser;
  PetscCall(BoxMeshCreate(PETSC_COMM_SELF, faces, dm));
  PetscFunctionReturn(0);
}

/* Two unit cubes side by side in x. The second begins at (2, 1, 0), its xi, eta, zeta are z, -x, -y. Cells are given
   in DMPlex's own order, bottom face 0, 3, 2, 1 */
static PetscErrorCode CreateTurnedPair(DM *dm)
{
  const PetscInt cells[16] = {0, 3, 4, 1, 6, 7, 10, 9, 5, 4, 10, 11, 2, 8, 7, 1};
  PetscReal      x[36];

  PetscFunctionBeginUser;
  for (int v = 0; v < 12; v++) {
    x[3 * v]     = v % 3;
    x[3 * v + 1] = v / 3 % 2;
    x[3 * v + 2] = v / 6;
  }
  PetscCall(DMPlexCreateFromCellListPetsc(PETSC_COMM_SELF, 3, 2, 12, 8, PETSC_TRUE, cells, 3, x, dm));
  PetscFunctionReturn(0);
}

/* Breaks when: closure_order does not match DMPlex, so that cells are mirrored or twisted */
static PetscErrorCode TestClosure(const char name[], DM dm, double volume, int *failed)
{
  const Element *element = ElementFind(DM_POLYTOPE_HEXAHEDRON, name);
  double         quality, total;

  PetscFunctionBeginUser;
  PetscCheck(element, PETSC_COMM_SELF, PETSC_ERR_PLIB, "No formulation %s", name);
  PetscCall(MeasureMesh(dm, element, &quality, &total));
  *failed += CheckClose("smallest Jacobian relative to the box", quality, 1, 1e-13);
  *failed += CheckClose("sum of the volumes, m^3", total, volume, 1e-13);
  PetscCall(DMDestroy(&dm));
  PetscFunctionReturn(0);
}

/* Breaks when: a name is missing from the table or from the list for messages, or an unknown one is found */
static PetscErrorCode TestNames(int *failed)
{
  PetscInt n;
  char   **names;

  PetscFunctionBeginUser;
  PetscCall(PetscStrToArray(ElementNames(), ',', &n, &names));
  *failed += CheckClose("formulations listed", (double)n, 2, 0);
  for (PetscInt i = 0; i < n; i++) {
    const char *name = names[i] + (names[i][0] == ' ');

    *failed += CheckTrue("a listed formulation is found", ElementFind(DM_POLYTOPE_HEXAHEDRON, name) != NULL, 0);
  }
  PetscCall(PetscStrToArrayDestroy((int)n, names));
  *failed += CheckTrue("an unknown formulation is not", ElementFind(DM_POLYTOPE_HEXAHEDRON, "none") == NULL, 0);
  *failed += CheckTrue("a shape without rows is not", ElementFind(DM_POLYTOPE_TETRAHEDRON, "full") == NULL, 0);
  PetscFunctionReturn(0);
}

int main(int argc, char **argv)
{
  static const char *const names[] = {"incompatible", "full"};
  int                      failed  = 0;
  DM                       dm;

  PetscFunctionBeginUser;
  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  PetscCall(TestNames(&failed));
  for (int i = 0; i < 2; i++) {
    PetscCall(CreateBox(&dm));
    PetscCall(TestClosure(names[i], dm, 1, &failed));
    PetscCall(CreateTurnedPair(&dm));
    PetscCall(TestClosure(names[i], dm, 2, &failed));
  }
  PetscCall(PetscFinalize());
  printf("%d failed\n", failed);
  return failed ? 1 : 0;
}
