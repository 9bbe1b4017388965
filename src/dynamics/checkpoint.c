/*
   Checkpoint: one file of all ranks,

      head       magic word, byte order, its own length and checksum, version, sizes
      parts      [parts] of the scene's checksum
      names      [items][32] characters
      table      [ranks][items + 1] numbers of values of each item, then the checksum of the rank's values
      values     of rank 0: item 0, item 1, ...; of rank 1; ...

   Each rank writes and reads its own values. Nothing of a file is used before all ranks have found all of it good.
*/
#include "checkpointimpl.h"

/* Head, parts, names and the table of all ranks, complete on rank 0, where row [n + 1] of each rank is gathered */
static PetscErrorCode CheckpointHeadCreate(MPI_Comm comm, Checksum scene, PetscInt n, const CheckpointItem item[],
                                           uint64_t row[], CheckpointHead **head)
{
  const ChecksumPart *parts;
  PetscInt            n_parts;
  PetscMPIInt         size, width;
  uint64_t            n_values = 0;
  CheckpointHead     *h;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(comm, &size));
  PetscCall(PetscMPIIntCast(n + 1, &width));
  for (PetscInt i = 0; i < n; i++) n_values += row[i];
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &n_values, 1, MPI_UINT64_T, MPI_SUM, comm));
  PetscCall(ChecksumGetParts(scene, &n_parts, &parts));
  CheckpointHead begin = {.magic     = CHECKPOINT_MAGIC,
                          .order     = CHECKPOINT_ORDER,
                          .version   = CHECKPOINT_VERSION,
                          .real_size = sizeof(PetscReal),
                          .n_ranks   = (uint64_t)size,
                          .n_items   = (uint64_t)n,
                          .n_parts   = (uint64_t)n_parts};

  begin.size  = CheckpointHeadSize(&begin);
  begin.total = begin.size + sizeof(PetscReal) * n_values;
  PetscCall(PetscCalloc((size_t)begin.size, &h));
  *h = begin;
  PetscCall(PetscArraycpy(CheckpointHeadParts(h), parts, n_parts));
  for (PetscInt i = 0; i < n; i++) PetscCall(PetscStrncpy(CheckpointHeadName(h, i), item[i].name, CHECKPOINT_NAME));
  PetscCallMPI(MPI_Gather(row, width, MPI_UINT64_T, CheckpointHeadRow(h, 0), width, MPI_UINT64_T, 0, comm));
  h->checksum = CheckpointHeadSum(h);
  *head       = h;
  PetscFunctionReturn(0);
}

PetscErrorCode CheckpointWrite(MPI_Comm comm, Results results, Checksum scene, PetscInt n, const CheckpointItem item[])
{
  ResultsPiece   *piece;
  uint64_t       *row;
  CheckpointHead *head;
  PetscMPIInt     rank;
  PetscErrorCode  failure;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  PetscCall(PetscCalloc2(n + 1, &row, n + 1, &piece));
  row[n] = CHECKSUM_BEGIN;
  for (PetscInt i = 0; i < n; i++) {
    piece[i + 1] = (ResultsPiece){item[i].values, sizeof(PetscReal) * (size_t)item[i].n};
    row[i]       = (uint64_t)item[i].n;
    row[n]       = ChecksumBytes(row[n], item[i].values, piece[i + 1].size);
  }
  PetscCall(CheckpointHeadCreate(comm, scene, n, item, row, &head));
  piece[0] = (ResultsPiece){head, rank == 0 ? (size_t)head->size : 0};
  failure  = ResultsBinaryWrite(results, CHECKPOINT_FILE, n + 1, piece);
  PetscCall(PetscFree(head));
  PetscCall(PetscFree2(row, piece));
  PetscCall(failure);
  PetscFunctionReturn(0);
}
