/* Matrices of all ranks on the first one, which writes them */
#include "substructure/substructureimpl.h"

PetscErrorCode SubstructureCollect(Mat A, Mat *whole)
{
  PetscInt    n;
  PetscMPIInt rank;
  IS          all;
  Mat        *part;
  MPI_Comm    comm;

  PetscFunctionBeginUser;
  PetscCall(PetscObjectGetComm((PetscObject)A, &comm));
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  PetscCall(MatGetSize(A, &n, NULL));
  PetscCall(ISCreateStride(PETSC_COMM_SELF, rank ? 0 : n, 0, 1, &all));
  PetscCall(MatCreateSubMatrices(A, 1, &all, &all, MAT_INITIAL_MATRIX, &part));
  *whole = part[0];
  PetscCall(PetscObjectReference((PetscObject)*whole));
  PetscCall(MatDestroySubMatrices(1, &part));
  PetscCall(ISDestroy(&all));
  if (rank) PetscCall(MatDestroy(whole));
  PetscFunctionReturn(0);
}
