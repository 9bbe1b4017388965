/* A box of hexahedra, whose constructor got two more arguments in PETSc 3.22 */
#pragma once

#include <petscdmplex.h>

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
