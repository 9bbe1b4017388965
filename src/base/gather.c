/*
   Records of all ranks on every rank, or on the rank that each is sent to: MPI_Allgatherv() or MPI_Alltoallv() of a
   contiguous datatype as long as one record, so that counts and displacements, which MPI 3 keeps in int, are those of
   records and not of bytes.
*/
#include "gather.h"

/* Places of records that come in these numbers from the ranks, or go to them; their sum, an error on all ranks where
   one has too many */
static PetscErrorCode Places(MPI_Comm comm, const PetscMPIInt count[], PetscMPIInt start[], PetscInt *sum)
{
  PetscInt64  total = 0, most;
  PetscMPIInt n_ranks;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(comm, &n_ranks));
  for (PetscMPIInt r = 0; r < n_ranks; r++) {
    start[r] = (PetscMPIInt)total;
    total += count[r];
  }
  PetscCallMPI(MPI_Allreduce(&total, &most, 1, MPIU_INT64, MPI_MAX, comm));
  PetscCheck(most <= PETSC_MPI_INT_MAX, comm, PETSC_ERR_SUP, "%" PetscInt64_FMT " records for one rank exceed an int",
             most);
  *sum = (PetscInt)total;
  PetscFunctionReturn(0);
}

/* A datatype as long as one record */
static PetscErrorCode RecordCreate(size_t size, MPI_Datatype *record)
{
  PetscMPIInt bytes;

  PetscFunctionBeginUser;
  PetscCall(PetscMPIIntCast((PetscInt)size, &bytes));
  PetscCallMPI(MPI_Type_contiguous(bytes, MPI_BYTE, record));
  PetscCallMPI(MPI_Type_commit(record));
  PetscFunctionReturn(0);
}

PetscErrorCode GatherRecords(MPI_Comm comm, PetscInt n_local, size_t size, const void *local, PetscInt *n_all,
                             void *all)
{
  PetscInt     total;
  PetscMPIInt  n_ranks, n, *count, *start;
  MPI_Datatype record;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(comm, &n_ranks));
  PetscCall(PetscMalloc2(n_ranks, &count, n_ranks, &start));
  PetscCall(PetscMPIIntCast(n_local, &n));
  PetscCallMPI(MPI_Allgather(&n, 1, MPI_INT, count, 1, MPI_INT, comm));
  PetscCall(Places(comm, count, start, &total));
  PetscCall(PetscMalloc((size_t)total * size, all));
  PetscCall(RecordCreate(size, &record));
  PetscCallMPI(MPI_Allgatherv(local, n, record, *(void **)all, count, start, record, comm));
  PetscCallMPI(MPI_Type_free(&record));
  PetscCall(PetscFree2(count, start));
  if (n_all) *n_all = total;
  PetscFunctionReturn(0);
}

/* The records in the order of the ranks that they go to, each rank's from to_start; to_start is then where each ends */
static PetscErrorCode RecordsSort(PetscInt n, size_t size, const char local[], const PetscMPIInt rank[],
                                  PetscMPIInt to_start[], char out[])
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < n; i++)
    PetscCall(PetscMemcpy(&out[(size_t)to_start[rank[i]]++ * size], &local[(size_t)i * size], size));
  PetscFunctionReturn(0);
}

PetscErrorCode ExchangeRecords(MPI_Comm comm, PetscInt *n, size_t size, void *local, const PetscMPIInt rank[], void *in)
{
  PetscInt     n_out, total;
  PetscMPIInt  n_ranks, *to, *to_start, *from, *from_start;
  char        *out;
  MPI_Datatype record;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(comm, &n_ranks));
  PetscCall(PetscCalloc4(n_ranks, &to, n_ranks, &to_start, n_ranks, &from, n_ranks, &from_start));
  for (PetscInt i = 0; i < *n; i++) to[rank[i]]++;
  PetscCallMPI(MPI_Alltoall(to, 1, MPI_INT, from, 1, MPI_INT, comm));
  PetscCall(Places(comm, to, to_start, &n_out));
  PetscCall(Places(comm, from, from_start, &total));
  PetscCall(PetscMalloc1((size_t)n_out * size, &out));
  PetscCall(RecordsSort(n_out, size, *(char **)local, rank, to_start, out));
  PetscCall(PetscFree(*(void **)local));
  for (PetscMPIInt r = 0; r < n_ranks; r++) to_start[r] -= to[r];
  PetscCall(PetscMalloc((size_t)total * size, in));
  PetscCall(RecordCreate(size, &record));
  PetscCallMPI(MPI_Alltoallv(out, to, to_start, record, *(void **)in, from, from_start, record, comm));
  PetscCallMPI(MPI_Type_free(&record));
  PetscCall(PetscFree(out));
  PetscCall(PetscFree4(to, to_start, from, from_start));
  *n = total;
  PetscFunctionReturn(0);
}
