/*
   Chains for the ranks, each the next one as it becomes free: transients that settle are much shorter than those that
   do not. The counter is on rank 0, and others add to it one-sided: on one node in shared memory, without its help;
   over a network that cannot add by itself, when rank 0 next enters MPI, so that others may wait until its own chain
   ends.
*/
#include "mapimpl.h"

PetscErrorCode MapShareCreate(MPI_Comm comm, MapShare *share)
{
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  PetscCallMPI(MPI_Win_allocate(rank ? 0 : (MPI_Aint)sizeof(int), (int)sizeof(int), MPI_INFO_NULL, comm,
                                (void *)&share->counter, &share->window));
  PetscCallMPI(MPI_Win_lock_all(0, share->window));
  PetscFunctionReturn(0);
}

PetscErrorCode MapShareBegin(MapShare *share, MPI_Comm comm)
{
  const int   zero = 0;
  PetscMPIInt rank;
  int         last;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  PetscCallMPI(MPI_Barrier(comm));
  if (!rank) PetscCallMPI(MPI_Fetch_and_op(&zero, &last, MPI_INT, 0, 0, MPI_REPLACE, share->window));
  PetscCallMPI(MPI_Win_flush_all(share->window));
  PetscCallMPI(MPI_Barrier(comm));
  PetscFunctionReturn(0);
}

/* *k = the counter, which grows by one: each number goes to one rank. Numbers beyond the last chain tell a rank to
   end. */
PetscErrorCode MapShareNext(MapShare *share, PetscInt *k)
{
  const int one  = 1;
  int       next = 0;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Fetch_and_op(&one, &next, MPI_INT, 0, 0, MPI_SUM, share->window));
  PetscCallMPI(MPI_Win_flush(0, share->window));
  *k = next;
  PetscFunctionReturn(0);
}

PetscErrorCode MapShareDestroy(MapShare *share)
{
  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Win_unlock_all(share->window));
  PetscCallMPI(MPI_Win_free(&share->window));
  PetscFunctionReturn(0);
}
