/* Meshes for unit tests */
#pragma once

#include <petscdmplex.h>
#include <squeal/mesh.h>

/* A box of hexahedra, whose constructor got two more arguments in PETSc 3.22 */
static inline PetscErrorCode BoxMeshCreate(MPI_Comm comm, const PetscInt faces[3], DM *dm)
{
  PetscFunctionBeginUser;
#if PETSC_VERSION_LT(3, 22, 0)
  PetscCall(DMPlexCreateBoxMesh(comm, 3, PETSC_FALSE, faces, NULL, NULL, NULL, PETSC_TRUE, dm));
#else
  PetscCall(DMPlexCreateBoxMesh(comm, 3, PETSC_FALSE, faces, NULL, NULL, NULL, PETSC_TRUE, 0, PETSC_TRUE, dm));
#endif
  PetscFunctionReturn(0);
}

/* Tables of a unit cube of n[0] x n[1] x n[2] hexahedra of one part, each rank with layers of equal z; the lower rank
   owns the vertices between two. Needs a layer for each rank. */
static inline PetscErrorCode BoxMeshTabulate(MPI_Comm comm, const PetscInt n[3], Mesh *mesh)
{
  static const char *const part[]  = {"disc"};
  const PetscInt           step[3] = {1, n[0] + 1, (n[0] + 1) * (n[1] + 1)};
  PetscMPIInt              rank, size;
  PetscInt                 first, layers, *number, *corner, *cell_first, *cell_part;
  PetscReal               *x;
  const Element          **element;
  PetscBool               *owned;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  PetscCallMPI(MPI_Comm_size(comm, &size));
  first  = n[2] * rank / size;
  layers = n[2] * (rank + 1) / size - first;
  *mesh  = (Mesh){.n_nodes = step[2] * (layers + 1), .n_cells = n[0] * n[1] * layers, .n_parts = 1, .part = part};
  PetscCall(PetscMalloc3(3 * mesh->n_nodes, &x, mesh->n_nodes, &number, mesh->n_nodes, &owned));
  PetscCall(PetscCalloc4(8 * mesh->n_cells, &corner, mesh->n_cells + 1, &cell_first, mesh->n_cells, &cell_part,
                         mesh->n_cells, &element));
  for (PetscInt v = 0; v < mesh->n_nodes; v++) {
    number[v] = v + step[2] * first;
    owned[v]  = rank == 0 || v >= step[2] ? PETSC_TRUE : PETSC_FALSE;
    for (int d = 0; d < 3; d++) x[3 * v + d] = (PetscReal)(number[v] / step[d] % (n[d] + 1)) / (PetscReal)n[d];
  }
  for (PetscInt c = 0; c < mesh->n_cells; c++) {
    element[c]        = ElementFind(DM_POLYTOPE_HEXAHEDRON, 8, "full");
    cell_first[c + 1] = 8 * (c + 1);
    for (PetscInt i = 0; i < 8; i++)
      corner[8 * c + i] = c % n[0] + (i % 4 == 1 || i % 4 == 2) + step[1] * (c / n[0] % n[1] + i % 4 / 2) +
                          step[2] * (c / (n[0] * n[1]) + i / 4);
  }
  mesh->x          = x;
  mesh->number     = number;
  mesh->owned      = owned;
  mesh->element    = element;
  mesh->cell_first = cell_first;
  mesh->cell_node  = corner;
  mesh->cell_part  = cell_part;
  PetscFunctionReturn(0);
}

static inline PetscErrorCode BoxMeshDestroy(Mesh *mesh)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree3(mesh->x, mesh->number, mesh->owned));
  PetscCall(PetscFree4(mesh->cell_node, mesh->cell_first, mesh->cell_part, mesh->element));
  PetscFunctionReturn(0);
}
