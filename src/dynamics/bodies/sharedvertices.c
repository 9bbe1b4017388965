/*
   Sums at the vertices that ranks share. Each rank sends what it has to all others that have the vertex, and each
   adds up what it received and its own in the ascending order of the ranks: the copies stay bitwise equal without any
   owner.
*/
#include "bodiesimpl.h"
#include "base/gather.h"
#include <stdlib.h>

#define SHARED_TAG 5501

/* A vertex on one of the ranks that share it */
typedef struct {
  PetscInt    number; /* global */
  PetscMPIInt rank;
  PetscInt    vertex; /* local on that rank */
} SharedCopy;

static int SharedCopyCompare(const void *a, const void *b)
{
  const SharedCopy *x = a, *y = b;

  if (x->number != y->number) return x->number < y->number ? -1 : 1;
  return (x->rank > y->rank) - (x->rank < y->rank);
}

/* All copies of all shared vertices, sorted by number, then rank */
static PetscErrorCode SharedGatherCopies(Bodies b, const PetscBool shared[], PetscInt *n_all, SharedCopy **all)
{
  SharedCopy *own;
  const Mesh *mesh;
  PetscInt    n = 0;
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(b->comm, &rank));
  PetscCall(ModelGetMesh(b->model, &mesh));
  PetscCall(PetscCalloc1(mesh->n_vertices, &own));
  for (PetscInt v = 0; v < mesh->n_vertices; v++) {
    if (!shared[v]) continue;
    own[n].number = mesh->number[v];
    own[n].rank   = rank;
    own[n].vertex = v;
    n++;
  }
  PetscCall(GatherRecords(b->comm, n, sizeof(SharedCopy), own, n_all, all));
  if (*n_all) qsort(*all, (size_t)*n_all, sizeof(SharedCopy), SharedCopyCompare);
  PetscCall(PetscFree(own));
  PetscFunctionReturn(0);
}

/* End of the copies of one vertex that begin at i */
static PetscInt SharedCopiesEnd(PetscInt n_all, const SharedCopy all[], PetscInt i)
{
  PetscInt end = i + 1;

  while (end < n_all && all[end].number == all[i].number) end++;
  return end;
}

/* This rank's copy among those from begin to end, -1 without */
static PetscInt SharedCopiesFind(const SharedCopy all[], PetscInt begin, PetscInt end, PetscMPIInt rank)
{
  for (PetscInt i = begin; i < end; i++)
    if (all[i].rank == rank) return i;
  return -1;
}

/* Neighbours, and how many vertices are shared with each */
static PetscErrorCode SharedFindNeighbours(Shared *share, PetscInt n_all, const SharedCopy all[], PetscMPIInt rank,
                                           PetscMPIInt size)
{
  PetscInt *count;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(size, &count));
  for (PetscInt i = 0, end; i < n_all; i = end) {
    end = SharedCopiesEnd(n_all, all, i);
    if (SharedCopiesFind(all, i, end, rank) < 0) continue;
    share->n++;
    for (PetscInt j = i; j < end; j++) count[all[j].rank]++;
  }
  count[rank] = 0;
  for (PetscMPIInt r = 0; r < size; r++) share->n_ranks += count[r] > 0;
  PetscCall(PetscMalloc1(share->n_ranks, &share->rank));
  PetscCall(PetscCalloc1(share->n_ranks + 1, &share->start));
  for (PetscMPIInt r = 0, i = 0; r < size; r++) {
    if (!count[r]) continue;
    share->rank[i]      = r;
    share->start[i + 1] = share->start[i] + count[r];
    i++;
  }
  PetscCall(PetscFree(count));
  PetscFunctionReturn(0);
}

/* Places of the shared vertices in the messages, the same on both sides: by global number */
static PetscErrorCode SharedFindSources(Shared *share, PetscInt n_all, const SharedCopy all[], PetscMPIInt rank)
{
  PetscInt *filled, n = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc3(share->n, &share->shared, share->n + 1, &share->source_start, n_all, &share->source));
  PetscCall(PetscMalloc1(share->start[share->n_ranks], &share->vertex));
  PetscCall(PetscMalloc1(share->n_ranks, &filled));
  PetscCall(PetscArraycpy(filled, share->start, share->n_ranks));
  share->source_start[0] = 0;
  for (PetscInt i = 0, end; i < n_all; i = end) {
    PetscInt own, m = share->source_start[n];

    end = SharedCopiesEnd(n_all, all, i);
    own = SharedCopiesFind(all, i, end, rank);
    if (own < 0) continue;
    for (PetscInt j = i; j < end; j++) {
      PetscInt r;

      if (j == own) {
        share->source[m++] = -1;
        continue;
      }
      PetscCall(PetscFindMPIInt(all[j].rank, share->n_ranks, share->rank, &r));
      share->source[m++]         = filled[r];
      share->vertex[filled[r]++] = all[own].vertex;
    }
    share->shared[n]         = all[own].vertex;
    share->source_start[++n] = m;
  }
  PetscCall(PetscFree(filled));
  PetscFunctionReturn(0);
}

/* Persistent requests, receiving first */
static PetscErrorCode SharedCreateRequests(Shared *share)
{
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc3(3 * share->start[share->n_ranks], &share->send, 3 * share->start[share->n_ranks],
                         &share->receive, 2 * share->n_ranks, &share->request));
  for (PetscMPIInt i = 0; i < share->n_ranks; i++) {
    const PetscInt begin = 3 * share->start[i];
    PetscMPIInt    n;

    PetscCall(PetscMPIIntCast(3 * share->start[i + 1] - begin, &n));
    PetscCallMPI(
      MPI_Recv_init(share->receive + begin, n, MPIU_REAL, share->rank[i], SHARED_TAG, share->comm, &share->request[i]));
    PetscCallMPI(MPI_Send_init(share->send + begin, n, MPIU_REAL, share->rank[i], SHARED_TAG, share->comm,
                               &share->request[share->n_ranks + i]));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode SharedSetUp(Bodies b)
{
  Shared     *share = &b->share;
  const Mesh *mesh;
  PetscBool  *shared;
  PetscInt    n_all;
  SharedCopy *all;
  PetscMPIInt rank, size;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(b->comm, &rank));
  PetscCallMPI(MPI_Comm_size(b->comm, &size));
  PetscCall(ModelGetMesh(b->model, &mesh));
  PetscCall(ModelGetShared(b->model, &shared));
  PetscCall(PetscMalloc1(mesh->n_vertices, &b->layout.owned));
  PetscCall(PetscArraycpy(b->layout.owned, mesh->owned, mesh->n_vertices));
  PetscCall(SharedGatherCopies(b, shared, &n_all, &all));
  PetscCall(SharedFindNeighbours(share, n_all, all, rank, size));
  PetscCall(SharedFindSources(share, n_all, all, rank));
  PetscCallMPI(MPI_Comm_dup(b->comm, &share->comm));
  PetscCall(SharedCreateRequests(share));
  PetscCall(PetscFree(shared));
  PetscCall(PetscFree(all));
  PetscFunctionReturn(0);
}

PetscErrorCode SharedBegin(Shared *share, const Layout *layout, const PetscReal x[])
{
  PetscFunctionBeginUser;
  if (!share->n_ranks) PetscFunctionReturn(0);
  PetscCallMPI(MPI_Startall(share->n_ranks, share->request));
  for (PetscInt i = 0; i < share->start[share->n_ranks]; i++) {
    const PetscInt at = layout->at[share->vertex[i]], step = layout->step[share->vertex[i]];

    for (PetscInt j = 0; j < 3; j++) share->send[3 * i + j] = x[at + j * step];
  }
  PetscCallMPI(MPI_Startall(share->n_ranks, share->request + share->n_ranks));
  PetscFunctionReturn(0);
}

PetscErrorCode SharedEnd(Shared *share, const Layout *layout, PetscReal x[])
{
  PetscFunctionBeginUser;
  if (!share->n_ranks) PetscFunctionReturn(0);
  PetscCallMPI(MPI_Waitall(2 * share->n_ranks, share->request, MPI_STATUSES_IGNORE));
  for (PetscInt i = 0; i < share->n; i++) {
    const PetscInt at = layout->at[share->shared[i]], step = layout->step[share->shared[i]];

    for (PetscInt j = 0; j < 3; j++) {
      PetscReal sum = 0;

      for (PetscInt s = share->source_start[i]; s < share->source_start[i + 1]; s++)
        sum += share->source[s] < 0 ? x[at + j * step] : share->receive[3 * share->source[s] + j];
      x[at + j * step] = sum;
    }
  }
  PetscFunctionReturn(0);
}

PetscErrorCode SharedDestroy(Shared *share)
{
  PetscFunctionBeginUser;
  for (PetscMPIInt i = 0; i < 2 * share->n_ranks; i++) PetscCallMPI(MPI_Request_free(&share->request[i]));
  PetscCall(PetscFree3(share->send, share->receive, share->request));
  PetscCall(PetscFree3(share->shared, share->source_start, share->source));
  PetscCall(PetscFree(share->vertex));
  PetscCall(PetscFree(share->rank));
  PetscCall(PetscFree(share->start));
  if (share->comm != MPI_COMM_NULL) PetscCallMPI(MPI_Comm_free(&share->comm));
  PetscFunctionReturn(0);
}
