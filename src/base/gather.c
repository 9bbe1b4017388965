/*
   Records of all ranks on every rank: MPI_Allgatherv() of a contiguous datatype as long as one record, so that counts
   and displacements, which MPI 3 keeps in int, are those of records and not of bytes.
*/
#include "gather.h"

PetscErrorCode GatherRecords(MPI_Comm comm, PetscInt n_local, size_t size, const void *local, PetscInt *n_all,
                             void *all)
{
  PetscInt64   total = 0;
  PetscMPIInt  n_ranks, n, bytes, *count, *start;
  MPI_Datatype record;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(comm, &n_ranks));
  PetscCall(PetscMalloc2(n_ranks, &count, n_ranks, &start));
  PetscCall(PetscMPIIntCast(n_local, &n));
  PetscCall(PetscMPIIntCast((PetscInt)size, &bytes));
  PetscCallMPI(MPI_Allgather(&n, 1, MPI_INT, count, 1, MPI_INT, comm));
  for (PetscMPIInt r = 0; r < n_ranks; r++) {
    start[r] = (PetscMPIInt)total;
    total += count[r];
  }
  PetscCheck(total <= PETSC_MPI_INT_MAX, comm, PETSC_ERR_SUP, "%" PetscInt64_FMT " records of all ranks exceed an int",
             total);
  PetscCall(PetscMalloc((size_t)total * size, all));
  PetscCallMPI(MPI_Type_contiguous(bytes, MPI_BYTE, &record));
  PetscCallMPI(MPI_Type_commit(&record));
  PetscCallMPI(MPI_Allgatherv(local, n, record, *(void **)all, count, start, record, comm));
  PetscCallMPI(MPI_Type_free(&record));
  PetscCall(PetscFree2(count, start));
  if (n_all) *n_all = (PetscInt)total;
  PetscFunctionReturn(0);
}
