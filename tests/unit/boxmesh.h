/* Meshes for unit tests */
#pragma once

#include <petscdmplex.h>

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

/* Box of hexahedra, distributed, with three unknowns per vertex */
static inline PetscErrorCode BoxMeshDistributed(MPI_Comm comm, const PetscInt faces[3], DM *dm)
{
  PetscInt     start, end;
  PetscSection section;
  DM           distributed;

  PetscFunctionBeginUser;
  PetscCall(BoxMeshCreate(comm, faces, dm));
  PetscCall(DMPlexDistribute(*dm, 0, NULL, &distributed));
  if (distributed) {
    PetscCall(DMDestroy(dm));
    *dm = distributed;
  }
  PetscCall(PetscSectionCreate(comm, &section));
  PetscCall(DMPlexGetChart(*dm, &start, &end));
  PetscCall(PetscSectionSetChart(section, start, end));
  PetscCall(DMPlexGetDepthStratum(*dm, 0, &start, &end));
  for (PetscInt v = start; v < end; v++) PetscCall(PetscSectionSetDof(section, v, 3));
  PetscCall(PetscSectionSetUp(section));
  PetscCall(DMSetLocalSection(*dm, section));
  PetscCall(PetscSectionDestroy(&section));
  PetscFunctionReturn(0);
}
