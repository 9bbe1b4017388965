/*
   Exchange between the ranks that have nodes of contact surfaces and those that solve pairs. Every rank knows which
   nodes each rank has and owns. The owner of a node sends its values to the ranks that need it for their pairs, sums
   the forces that come back, in the order of the ranks, and sends the sum to all that have a copy, hence the same bits.
   Only active nodes are in a message, and a rank without such nodes waits for none: it needs the head, sums over all
   ranks, when it looks for the active nodes of the next step.
*/
#include "contact/projector/projectorimpl.h"
#include "base/gather.h"

/* Owner of each node, from the lists of all ranks */
static PetscErrorCode OwnersFind(ProjectorShare *share)
{
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(share->n_nodes, &share->owner));
  for (PetscMPIInt r = 0; r < share->size; r++)
    for (PetscInt i = share->first[r]; i < share->first[r + 1]; i++)
      if (share->holder[i] >= 0) share->owner[share->holder[i]] = (PetscSFNode){r, i - share->first[r]};
  PetscFunctionReturn(0);
}

/* Buffers hold three fields of three values of all nodes, so that no step allocates. */
PetscErrorCode ShareSetNodes(ProjectorShare *share, PetscInt n_nodes)
{
  const PetscInt n = share->n;

  PetscFunctionBeginUser;
  share->n_nodes = n_nodes;
  PetscCall(OwnersFind(share));
  PetscCall(PetscMalloc4(n, &share->list[0], n, &share->list[1], n_nodes, &share->need, n, &share->own));
  PetscCall(PetscMalloc4(n, &share->sent, n, &share->copied, n_nodes, &share->from, n, &share->copy_from));
  share->active = share->list[0];
  if (share->size == 1) PetscFunctionReturn(0);
  PetscCall(PetscMalloc3(9 * n, &share->buffer[0], 9 * n_nodes, &share->buffer[1], n_nodes, &share->any));
  for (int k = 0; k < SHARE_FIELDS; k++) {
    PetscCallMPI(MPI_Type_contiguous(3 * (k + 1), MPIU_REAL, &share->record[k]));
    PetscCallMPI(MPI_Type_commit(&share->record[k]));
  }
  PetscCall(PetscSFCreate(share->comm, &share->values));
  PetscCall(PetscSFCreate(share->comm, &share->copies));
  PetscFunctionReturn(0);
}

/* number[n]: of the local nodes, ~number where another rank owns the node */
PetscErrorCode ShareSetUp(MPI_Comm comm, PetscInt n, const PetscInt number[], ProjectorShare *share)
{
  PetscInt *counts;

  PetscFunctionBeginUser;
  share->comm = comm;
  share->n    = n;
  PetscCallMPI(MPI_Comm_rank(comm, &share->rank));
  PetscCallMPI(MPI_Comm_size(comm, &share->size));
  PetscCall(GatherRecords(comm, 1, sizeof(PetscInt), &n, NULL, &counts));
  PetscCall(GatherRecords(comm, n, sizeof(PetscInt), number, NULL, &share->holder));
  PetscCall(PetscCalloc1(share->size + 1, &share->first));
  for (PetscMPIInt r = 0; r < share->size; r++) share->first[r + 1] = share->first[r] + counts[r];
  PetscCall(PetscFree(counts));
  PetscFunctionReturn(0);
}

/* The star forests of the active nodes: values of owners to the ranks that need them; forces of owners to copies.
   `sent` lists the local nodes whose values other ranks need. */
static PetscErrorCode ForestsPlant(ProjectorShare *share)
{
  const PetscInt  n_remote = share->n_need - share->n_own;
  PetscInt        n_copied = 0;
  const PetscInt *degree;

  PetscFunctionBeginUser;
  for (PetscInt j = 0; j < n_remote; j++) share->from[j] = share->owner[share->need[share->n_own + j]];
  PetscCall(
    PetscSFSetGraph(share->values, share->n, n_remote, NULL, PETSC_COPY_VALUES, share->from, PETSC_COPY_VALUES));
  for (PetscInt i = 0; i < share->n_active; i++) {
    const PetscInt node = share->holder[share->first[share->rank] + share->active[i]];

    if (node >= 0) continue;
    share->copied[n_copied]      = share->active[i];
    share->copy_from[n_copied++] = share->owner[~node];
  }
  PetscCall(PetscSFSetGraph(share->copies, share->n, n_copied, share->copied, PETSC_COPY_VALUES, share->copy_from,
                            PETSC_COPY_VALUES));
  PetscCall(PetscSFSetUp(share->copies));
  PetscCall(PetscSFComputeDegreeBegin(share->values, &degree));
  PetscCall(PetscSFComputeDegreeEnd(share->values, &degree));
  share->n_sent = 0;
  for (PetscInt i = 0; i < share->n; i++)
    if (degree[i] > 0) share->sent[share->n_sent++] = i;
  PetscFunctionReturn(0);
}

/* The list before stays valid for the step that is under way */
PetscErrorCode ShareSetActive(ProjectorShare *share, const PetscBool needed[])
{
  const PetscInt  *here = &share->holder[share->first[share->rank]];
  const PetscBool *any  = needed;

  PetscFunctionBeginUser;
  if (needed && share->size > 1) {
    PetscCallMPI(MPI_Allreduce(needed, share->any, (PetscMPIInt)share->n_nodes, MPIU_BOOL, MPI_LOR, share->comm));
    any = share->any;
  }
  share->active   = share->active == share->list[0] ? share->list[1] : share->list[0];
  share->n_active = share->n_own = 0;
  for (PetscInt i = 0; i < share->n; i++) {
    const PetscInt node = PetscMax(here[i], ~here[i]);

    if (!any || any[node]) share->active[share->n_active++] = i;
    if (here[i] < 0 || !share->solves || (needed && !needed[node])) continue;
    share->need[share->n_own]  = node;
    share->own[share->n_own++] = i;
  }
  share->n_need = share->n_own;
  for (PetscInt node = 0; node < share->n_nodes && share->solves; node++)
    if (share->owner[node].rank != share->rank && (!needed || needed[node])) share->need[share->n_need++] = node;
  if (share->size > 1) PetscCall(ForestsPlant(share));
  PetscFunctionReturn(0);
}

PetscErrorCode ShareGather(ProjectorShare *share, PetscInt n, const PetscReal *const local[], PetscReal *const all[])
{
  const PetscInt *remote = &share->need[share->n_own], n_remote = share->n_need - share->n_own;
  PetscReal      *message = share->buffer[0];

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < share->n_own; i++)
    for (PetscInt k = 0; k < n; k++)
      for (int d = 0; d < 3; d++) all[k][3 * share->need[i] + d] = local[k][3 * share->own[i] + d];
  if (share->size == 1) PetscFunctionReturn(0);
  for (PetscInt i = 0; i < share->n_sent; i++)
    for (PetscInt k = 0; k < n; k++)
      for (int d = 0; d < 3; d++) message[3 * (n * share->sent[i] + k) + d] = local[k][3 * share->sent[i] + d];
  PetscCall(PetscSFBcastBegin(share->values, share->record[n - 1], message, share->buffer[1], MPI_REPLACE));
  PetscCall(PetscSFBcastEnd(share->values, share->record[n - 1], message, share->buffer[1], MPI_REPLACE));
  message = share->buffer[1];
  for (PetscInt j = 0; j < n_remote; j++)
    for (PetscInt k = 0; k < n; k++)
      for (int d = 0; d < 3; d++) all[k][3 * remote[j] + d] = *message++;
  PetscFunctionReturn(0);
}

PetscErrorCode ShareReturn(ProjectorShare *share, const PetscReal all[], PetscReal local[])
{
  const PetscInt *remote = &share->need[share->n_own], n_remote = share->n_need - share->n_own;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < share->n_active; i++)
    for (int d = 0; d < 3; d++) local[3 * share->active[i] + d] = 0;
  for (PetscInt i = 0; i < share->n_own; i++)
    for (int d = 0; d < 3; d++) local[3 * share->own[i] + d] = all[3 * share->need[i] + d];
  if (share->size == 1) PetscFunctionReturn(0);
  for (PetscInt j = 0; j < n_remote; j++)
    for (int d = 0; d < 3; d++) share->buffer[1][3 * j + d] = all[3 * remote[j] + d];
  PetscCall(PetscSFReduceBegin(share->values, share->record[0], share->buffer[1], local, MPIU_SUM));
  PetscCall(PetscSFReduceEnd(share->values, share->record[0], share->buffer[1], local, MPIU_SUM));
  PetscCall(PetscSFBcastBegin(share->copies, share->record[0], local, local, MPI_REPLACE));
  PetscCall(PetscSFBcastEnd(share->copies, share->record[0], local, local, MPI_REPLACE));
  PetscFunctionReturn(0);
}

PetscErrorCode ShareHeadBegin(ProjectorShare *share, PetscInt n, const PetscReal head[])
{
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < n; k++) share->head[0][k] = share->head[1][k] = head[k];
  if (share->size > 1)
    PetscCallMPI(MPI_Iallreduce(share->head[0], share->head[1], (PetscMPIInt)n, MPIU_REAL, MPIU_SUM, share->comm,
                                &share->request));
  PetscFunctionReturn(0);
}

PetscErrorCode ShareHeadEnd(ProjectorShare *share, const PetscReal **head)
{
  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Wait(&share->request, MPI_STATUS_IGNORE));
  *head = share->head[1];
  PetscFunctionReturn(0);
}

PetscErrorCode ShareWorst(const ProjectorShare *share, PetscInt n, PetscReal record[])
{
  struct {
    double key;
    int    rank;
  } worst = {(double)record[0], share->rank};

  PetscFunctionBeginUser;
  if (share->size == 1) PetscFunctionReturn(0);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &worst, 1, MPI_DOUBLE_INT, MPI_MAXLOC, share->comm));
  PetscCallMPI(MPI_Bcast(record, (PetscMPIInt)n, MPIU_REAL, worst.rank, share->comm));
  PetscFunctionReturn(0);
}

PetscErrorCode ShareDestroy(ProjectorShare *share)
{
  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Wait(&share->request, MPI_STATUS_IGNORE));
  for (int k = 0; k < SHARE_FIELDS; k++)
    if (share->record[k]) PetscCallMPI(MPI_Type_free(&share->record[k]));
  PetscCall(PetscSFDestroy(&share->values));
  PetscCall(PetscSFDestroy(&share->copies));
  PetscCall(PetscFree(share->vertex));
  PetscCall(PetscFree(share->owner));
  PetscCall(PetscFree4(share->list[0], share->list[1], share->need, share->own));
  PetscCall(PetscFree4(share->sent, share->copied, share->from, share->copy_from));
  PetscCall(PetscFree3(share->buffer[0], share->buffer[1], share->any));
  PetscCall(PetscFree(share->first));
  PetscCall(PetscFree(share->holder));
  PetscFunctionReturn(0);
}
