/* main() of a unit test that needs PETSc */
#pragma once

#include <petscsys.h>
#include <stdio.h>

/* Runs the tests of a file, which are told the number of ranks and count what failed; the exit status */
static inline int PetscMain(int argc, char **argv, PetscErrorCode (*tests)(PetscMPIInt size, int *failed))
{
  PetscMPIInt size;
  int         failed = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  PetscCallMPI(MPI_Comm_size(PETSC_COMM_WORLD, &size));
  PetscCall(tests(size, &failed));
  PetscCall(PetscOptionsClear(NULL));
  PetscCall(PetscFinalize());
  printf("%d failed\n", failed);
  return failed ? 1 : 0;
}
