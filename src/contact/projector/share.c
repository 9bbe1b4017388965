/*
   Exchange between the ranks that have nodes of contact surfaces and the root that solves the contact. Every rank knows
   which nodes each rank has and owns, so that the lists of a message are made without talking; the owner of a node
   sends its values, and all that have it receive its force, hence the same bits. Two collective messages a step, of the
   active nodes alone. A rank without such nodes waits for neither: it needs the head of the second one, not the forces,
   and only when it looks for the active nodes of the next step.
*/
#include "projectorimpl.h"
#include "base/gather.h"

/* number[n]: of the local nodes, ~number where another rank owns the node. Buffers hold three fields of three values
   of all nodes and the head, so that no step allocates. */
PetscErrorCode ShareSetUp(MPI_Comm comm, PetscInt n, const PetscInt number[], ProjectorShare *share)
{
  PetscInt *counts, total;

  PetscFunctionBeginUser;
  for (int k = 0; k < SHARE_FIELDS; k++) {
    PetscCallMPI(MPI_Type_contiguous(3 * (k + 1), MPIU_REAL, &share->record[k]));
    PetscCallMPI(MPI_Type_commit(&share->record[k]));
  }
  share->comm = comm;
  share->n    = n;
  PetscCallMPI(MPI_Comm_rank(comm, &share->rank));
  PetscCallMPI(MPI_Comm_size(comm, &share->size));
  PetscCall(GatherRecords(comm, 1, sizeof(PetscInt), &n, NULL, &counts));
  PetscCall(GatherRecords(comm, n, sizeof(PetscInt), number, &total, &share->holder));
  PetscCall(PetscCalloc1(share->size + 1, &share->first));
  for (PetscMPIInt r = 0; r < share->size; r++) share->first[r + 1] = share->first[r] + counts[r];
  PetscCall(PetscFree(counts));
  PetscCall(PetscMalloc2(n, &share->list[0], n, &share->list[1]));
  share->active = share->list[0];
  PetscCall(PetscCalloc4(share->size, &share->n_send, share->size, &share->send, share->size, &share->n_back,
                         share->size, &share->back));
  PetscCall(PetscMalloc2(total, &share->send_node, total, &share->back_node));
  PetscCall(
    PetscMalloc2(9 * n + SHARE_HEAD, &share->buffer[0], 9 * total + SHARE_HEAD * share->size, &share->buffer[1]));
  PetscFunctionReturn(0);
}

/* Lists of a message, made on every rank alike. Counts and places to the root are in records (one node,
   MPI_Type_contiguous), those back in reals, since the head comes with them. The list before stays valid for the step
   that is under way. */
PetscErrorCode ShareSetActive(ProjectorShare *share, const PetscBool is_active[])
{
  PetscInt    n_send = 0, n_back = 0;
  PetscMPIInt back = 0;

  PetscFunctionBeginUser;
  share->active   = share->active == share->list[0] ? share->list[1] : share->list[0];
  share->n_active = 0;
  for (PetscMPIInt r = 0; r < share->size; r++) {
    const PetscInt first_send = n_send, first_back = n_back;

    for (PetscInt i = share->first[r]; i < share->first[r + 1]; i++) {
      const PetscInt node = ShareNode(share, i);

      if (is_active && !is_active[node]) continue;
      if (share->holder[i] >= 0) share->send_node[n_send++] = node;
      share->back_node[n_back++] = node;
      if (r == share->rank) share->active[share->n_active++] = i - share->first[r];
    }
    share->n_send[r] = (PetscMPIInt)(n_send - first_send);
    share->send[r]   = (PetscMPIInt)first_send;
    share->n_back[r] = (PetscMPIInt)(3 * (n_back - first_back) + SHARE_HEAD);
    share->back[r]   = back;
    back += share->n_back[r];
  }
  PetscFunctionReturn(0);
}

/* From the message of all ranks into the arrays of the root */
static void ShareUnpack(const ProjectorShare *share, PetscInt n, const PetscReal message[], PetscReal *const root[])
{
  const PetscInt n_all = ShareCountSent(share);

  for (PetscInt i = 0; i < n_all; i++)
    for (PetscInt k = 0; k < n; k++)
      for (int d = 0; d < 3; d++) root[k][3 * share->send_node[i] + d] = message[3 * (n * i + k) + d];
}

/* The nodes that this rank owns among the active ones; their number */
static PetscMPIInt SharePackOwn(const ProjectorShare *share, PetscInt n, const PetscReal *const local[],
                                PetscReal message[])
{
  PetscMPIInt n_own = 0;

  for (PetscInt i = 0; i < share->n_active; i++) {
    const PetscInt at = 3 * share->active[i];

    if (share->holder[share->first[share->rank] + share->active[i]] < 0) continue;
    for (PetscInt k = 0; k < n; k++)
      for (int d = 0; d < 3; d++) message[3 * (n * n_own + k) + d] = local[k][at + d];
    n_own++;
  }
  return n_own;
}

PetscErrorCode ShareGather(ProjectorShare *share, PetscInt n, const PetscReal *const local[], PetscReal *const root[])
{
  const MPI_Datatype record = share->record[n - 1];
  PetscMPIInt        n_own;

  PetscFunctionBeginUser;
  if (share->size == 1) {
    for (PetscInt i = 0; i < share->n_active; i++)
      for (PetscInt k = 0; k < n; k++)
        for (int d = 0; d < 3; d++) root[k][3 * share->send_node[i] + d] = local[k][3 * share->active[i] + d];
    PetscFunctionReturn(0);
  }
  n_own = SharePackOwn(share, n, local, share->buffer[0]);
  PetscCallMPI(MPI_Gatherv(share->buffer[0], n_own, record, share->buffer[1], share->n_send, share->send, record,
                           share->root, share->comm));
  if (share->rank == share->root) ShareUnpack(share, n, share->buffer[1], root);
  PetscFunctionReturn(0);
}

/* Head and forces of all ranks, one after the other */
static void SharePack(const ProjectorShare *share, const PetscReal root[], const PetscReal head[], PetscReal message[])
{
  PetscInt node = 0;

  for (PetscMPIInt r = 0; r < share->size; r++) {
    PetscReal     *to = &message[share->back[r]];
    const PetscInt n  = (share->n_back[r] - SHARE_HEAD) / 3;

    for (int k = 0; k < SHARE_HEAD; k++) *to++ = head[k];
    for (PetscInt i = 0; i < n; i++, node++)
      for (int d = 0; d < 3; d++) *to++ = root[3 * share->back_node[node] + d];
  }
}

PetscErrorCode ShareReturnBegin(ProjectorShare *share, const PetscReal root[], const PetscReal head[SHARE_HEAD])
{
  PetscReal *message = share->buffer[0];

  PetscFunctionBeginUser;
  if (share->rank == share->root) SharePack(share, root, head, share->size > 1 ? share->buffer[1] : message);
  if (share->size > 1)
    PetscCallMPI(MPI_Iscatterv(share->buffer[1], share->n_back, share->back, MPIU_REAL, message,
                               share->n_back[share->rank], MPIU_REAL, share->root, share->comm, &share->request));
  PetscFunctionReturn(0);
}

PetscErrorCode ShareReturnEnd(ProjectorShare *share, PetscReal head[SHARE_HEAD])
{
  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Wait(&share->request, MPI_STATUS_IGNORE));
  for (int k = 0; k < SHARE_HEAD; k++) head[k] = share->buffer[0][k];
  PetscFunctionReturn(0);
}

PetscErrorCode ShareGetForces(ProjectorShare *share, PetscReal local[])
{
  const PetscReal *message = &share->buffer[0][SHARE_HEAD];

  PetscFunctionBeginUser;
  if (!share->n_active) PetscFunctionReturn(0);
  PetscCallMPI(MPI_Wait(&share->request, MPI_STATUS_IGNORE));
  for (PetscInt i = 0; i < share->n_active; i++)
    for (int d = 0; d < 3; d++) local[3 * share->active[i] + d] = *message++;
  PetscFunctionReturn(0);
}

PetscErrorCode ShareDestroy(ProjectorShare *share)
{
  PetscFunctionBeginUser;
  for (int k = 0; k < SHARE_FIELDS; k++)
    if (share->record[k]) PetscCallMPI(MPI_Type_free(&share->record[k]));
  PetscCall(PetscFree(share->vertex));
  PetscCall(PetscFree2(share->list[0], share->list[1]));
  PetscCall(PetscFree(share->first));
  PetscCall(PetscFree(share->holder));
  PetscCall(PetscFree4(share->n_send, share->send, share->n_back, share->back));
  PetscCall(PetscFree2(share->send_node, share->back_node));
  PetscCall(PetscFree2(share->buffer[0], share->buffer[1]));
  PetscFunctionReturn(0);
}
