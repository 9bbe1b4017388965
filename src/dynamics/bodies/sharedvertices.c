/*
   Sums at the nodes that ranks share. Each rank sends what it has to all others that have the node, and each adds up
   what it received and its own in the ascending order of the ranks: the copies stay bitwise equal without any owner.
*/
#include "bodiesimpl.h"

/* any: the communicator is a copy of its own */
#define SHARED_TAG 5501

/* Vertices that this rank has in common with each other one, in an order that both have alike
   (ISLocalToGlobalMappingGetInfo()), and all of these in its own name. Ranks ascend, so that the sums do. */
static PetscErrorCode SharedFindRanks(Shared *share, const Mesh *mesh)
{
  ISLocalToGlobalMapping map;
  PetscInt               n, *ranks, *n_common, **common, *order, n_all = 0;

  PetscFunctionBeginUser;
  PetscCall(ISLocalToGlobalMappingCreate(share->comm, 1, mesh->n_nodes, mesh->number, PETSC_USE_POINTER, &map));
  PetscCall(ISLocalToGlobalMappingGetInfo(map, &n, &ranks, &n_common, &common));
  PetscCall(PetscCalloc1(mesh->n_nodes, &share->shared));
  for (PetscInt i = 0; i < n; i++) {
    n_all += n_common[i];
    for (PetscInt k = 0; k < n_common[i] && ranks[i] != share->self; k++) share->shared[common[i][k]] = PETSC_TRUE;
  }
  for (PetscInt v = 0; v < mesh->n_nodes; v++) n_all += share->shared[v];
  PetscCall(PetscMalloc3(n + 1, &share->rank, n + 2, &share->start, n_all, &share->vertex));
  PetscCall(PetscMalloc1(n + 1, &order));
  share->rank[share->n_ranks] = share->self;
  order[share->n_ranks++]     = -1;
  for (PetscInt i = 0; i < n; i++) {
    if (ranks[i] == share->self) continue;
    share->rank[share->n_ranks] = ranks[i];
    order[share->n_ranks++]     = i;
  }
  PetscCall(PetscSortIntWithArray(share->n_ranks, share->rank, order));
  share->start[0] = 0;
  for (PetscInt i = 0, end = 0; i < share->n_ranks; share->start[++i] = end) {
    for (PetscInt k = 0; order[i] >= 0 && k < n_common[order[i]]; k++) share->vertex[end++] = common[order[i]][k];
    for (PetscInt v = 0; order[i] < 0 && v < mesh->n_nodes; v++)
      if (share->shared[v]) share->vertex[end++] = v;
  }
  PetscCall(PetscFree(order));
  PetscCall(ISLocalToGlobalMappingRestoreInfo(map, &n, &ranks, &n_common, &common));
  PetscCall(ISLocalToGlobalMappingDestroy(&map));
  PetscFunctionReturn(0);
}

/* Persistent requests with the other ranks, receiving first */
static PetscErrorCode SharedCreateRequests(Shared *share)
{
  const PetscInt n_values = 3 * share->start[share->n_ranks];

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc3(n_values, &share->send, n_values, &share->receive, 2 * (share->n_ranks - 1), &share->request));
  for (PetscInt i = 0, k = 0; i < share->n_ranks; i++) {
    const PetscInt    begin = 3 * share->start[i];
    const PetscMPIInt rank  = (PetscMPIInt)share->rank[i];
    PetscMPIInt       n;

    if (rank == share->self) share->own = i;
    if (rank == share->self) continue;
    PetscCall(PetscMPIIntCast(3 * share->start[i + 1] - begin, &n));
    PetscCallMPI(
      MPI_Recv_init(share->receive + begin, n, MPIU_REAL, rank, SHARED_TAG, share->comm, &share->request[k]));
    PetscCallMPI(MPI_Send_init(share->send + begin, n, MPIU_REAL, rank, SHARED_TAG, share->comm,
                               &share->request[share->n_ranks - 1 + k++]));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode SharedSetUp(Bodies b)
{
  Shared *share = &b->share;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_dup(b->comm, &share->comm));
  PetscCallMPI(MPI_Comm_rank(b->comm, &share->self));
  PetscCall(SharedFindRanks(share, b->mesh));
  PetscCall(SharedCreateRequests(share));
  PetscFunctionReturn(0);
}

/* Receives are started before the values are packed, so that no message waits for room. x [layout n] is read here
   and written in SharedEnd() alone; in between other nodes may change. */
PetscErrorCode SharedBegin(Shared *share, const Layout *layout, const PetscReal x[])
{
  const PetscInt own = 3 * share->start[share->own], n_own = 3 * share->start[share->own + 1] - own;
  const PetscInt n_all = 3 * share->start[share->n_ranks] - n_own; /* values sent, and received, for -log_view */
  const int      n     = (int)share->n_ranks - 1;

  PetscFunctionBeginUser;
  if (!n) PetscFunctionReturn(0);
  PetscCallMPI(MPI_Startall_irecv((PetscMPIInt)n_all, MPIU_REAL, n, share->request));
  for (PetscInt i = 0; i < share->start[share->n_ranks]; i++) {
    const PetscInt at = layout->at[share->vertex[i]], step = layout->step[share->vertex[i]];

    for (PetscInt j = 0; j < 3; j++) share->send[3 * i + j] = x[at + j * step];
  }
  PetscCallMPI(MPI_Startall_isend((PetscMPIInt)n_all, MPIU_REAL, n, share->request + n));
  PetscCall(PetscArraycpy(share->receive + own, share->send + own, n_own));
  PetscFunctionReturn(0);
}

/* Shared nodes begin at zero and take all parts, the own one in its turn: with the same parts in the same order all
   copies are bitwise equal. */
PetscErrorCode SharedEnd(Shared *share, const Layout *layout, PetscReal x[])
{
  const int n = (int)share->n_ranks - 1;

  PetscFunctionBeginUser;
  if (!n) PetscFunctionReturn(0);
  PetscCallMPI(MPI_Waitall(2 * n, share->request, MPI_STATUSES_IGNORE));
  for (PetscInt i = share->start[share->own]; i < share->start[share->own + 1]; i++)
    for (PetscInt j = 0; j < 3; j++) x[layout->at[share->vertex[i]] + j * layout->step[share->vertex[i]]] = 0;
  for (PetscInt i = 0; i < share->start[share->n_ranks]; i++) {
    const PetscInt at = layout->at[share->vertex[i]], step = layout->step[share->vertex[i]];

    for (PetscInt j = 0; j < 3; j++) x[at + j * step] += share->receive[3 * i + j];
  }
  PetscFunctionReturn(0);
}

PetscErrorCode SharedDestroy(Shared *share)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < 2 * (share->n_ranks - 1); i++) PetscCallMPI(MPI_Request_free(&share->request[i]));
  PetscCall(PetscFree3(share->send, share->receive, share->request));
  PetscCall(PetscFree3(share->rank, share->start, share->vertex));
  PetscCall(PetscFree(share->shared));
  if (share->comm != MPI_COMM_NULL) PetscCallMPI(MPI_Comm_free(&share->comm));
  PetscFunctionReturn(0);
}
