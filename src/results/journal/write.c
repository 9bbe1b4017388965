/*
   Journal: one file of all ranks of its communicator,

      head       magic word, byte order, its own length and checksum, version, sizes
      parts      [parts] of the scene's checksum
      names      [items][32] characters
      table      [ranks][items + 1] numbers of values of each item, then the checksum of the rank's values
      values     of rank 0: item 0, item 1, ...; of rank 1; ...

   Each rank writes and reads its own values. Nothing of a file is used before all ranks have found all of it good.
*/
#include "journalimpl.h"

/* Head, parts, names and the table of all ranks, complete on rank 0, where row [n + 1] of each rank is gathered */
static PetscErrorCode JournalHeadCreate(MPI_Comm comm, Checksum scene, PetscInt n, const JournalItem item[],
                                        uint64_t row[], JournalHead **head)
{
  const ChecksumPart *parts;
  PetscInt            n_parts;
  PetscMPIInt         size, width;
  uint64_t            n_values = 0;
  JournalHead        *h;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(comm, &size));
  PetscCall(PetscMPIIntCast(n + 1, &width));
  for (PetscInt i = 0; i < n; i++) n_values += row[i];
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &n_values, 1, MPI_UINT64_T, MPI_SUM, comm));
  PetscCall(ChecksumGetParts(scene, &n_parts, &parts));
  JournalHead begin = {.magic     = JOURNAL_MAGIC,
                       .order     = JOURNAL_ORDER,
                       .version   = JOURNAL_VERSION,
                       .real_size = sizeof(PetscReal),
                       .n_ranks   = (uint64_t)size,
                       .n_items   = (uint64_t)n,
                       .n_parts   = (uint64_t)n_parts};

  begin.size  = JournalHeadSize(&begin);
  begin.total = begin.size + sizeof(PetscReal) * n_values;
  PetscCall(PetscCalloc((size_t)begin.size, &h));
  *h = begin;
  PetscCall(PetscArraycpy(JournalHeadParts(h), parts, n_parts));
  for (PetscInt i = 0; i < n; i++) PetscCall(PetscStrncpy(JournalHeadName(h, i), item[i].name, JOURNAL_NAME));
  PetscCallMPI(MPI_Gather(row, width, MPI_UINT64_T, JournalHeadRow(h, 0), width, MPI_UINT64_T, 0, comm));
  h->checksum = JournalHeadSum(h);
  *head       = h;
  PetscFunctionReturn(0);
}

PetscErrorCode JournalWrite(const Journal *journal, const char name[], PetscInt n, const JournalItem item[])
{
  ResultsPiece  *piece;
  uint64_t      *row;
  JournalHead   *head;
  PetscMPIInt    rank;
  PetscErrorCode failure;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(journal->comm, &rank));
  PetscCall(PetscCalloc2(n + 1, &row, n + 1, &piece));
  row[n] = CHECKSUM_BEGIN;
  for (PetscInt i = 0; i < n; i++) {
    piece[i + 1] = (ResultsPiece){item[i].values, sizeof(PetscReal) * (size_t)item[i].n};
    row[i]       = (uint64_t)item[i].n;
    row[n]       = ChecksumBytes(row[n], item[i].values, piece[i + 1].size);
  }
  PetscCall(JournalHeadCreate(journal->comm, journal->scene, n, item, row, &head));
  piece[0] = (ResultsPiece){head, rank == 0 ? (size_t)head->size : 0};
  failure =
    ResultsBinaryWrite(journal->results, journal->comm, name, journal->run ? PETSC_FALSE : PETSC_TRUE, n + 1, piece);
  PetscCall(PetscFree(head));
  PetscCall(PetscFree2(row, piece));
  PetscCall(failure);
  PetscFunctionReturn(0);
}

PetscErrorCode JournalKeep(const Journal *journal, const char name[], PetscInt n, const JournalItem item[],
                           PetscBool *kept)
{
  const char    *dir;
  PetscErrorCode failure;

  PetscFunctionBeginUser;
  PetscCall(PetscPushErrorHandler(PetscReturnErrorHandler, NULL));
  failure = JournalWrite(journal, name, n, item);
  PetscCall(PetscPopErrorHandler());
  PetscCheck(!failure || failure == PETSC_ERR_FILE_WRITE, journal->comm, failure, "cannot keep %s", name);
  *kept = failure ? PETSC_FALSE : PETSC_TRUE;
  if (*kept) PetscFunctionReturn(0);
  PetscCall(ResultsGetDirectory(journal->results, &dir));
  PetscCall(PetscFPrintf(journal->comm, stderr, "squeal: warning: cannot write '%s/%s'; a killed %s will begin anew\n",
                         dir, name, journal->run));
  PetscFunctionReturn(0);
}
