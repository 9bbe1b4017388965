/*
   Pairs of several ranks that hang together. The graph of W = G M^-1 G' joins two pairs that move one node; a node that
   pairs of more than one rank may move is shared. Ranks that share nodes get colours, those with a node in common
   different ones, and a sweep of Gauss-Seidel is

      for each colour in turn: the pairs at shared nodes of the ranks of that colour; they send the velocities there
      on each rank meanwhile: its other pairs

   so that only one rank at a time changes a shared node, all copies are alike to the last bit, and the sweep is one of
   Gauss-Seidel over all pairs, in an order that depends on the ranks. Hence the answer does by the tolerance
   (ProjectorTolerance). Each rank knows the nodes of all others: colours are found without talking, greedily in the
   order of the ranks. Ranks that nothing joins, as where meshes match, neither wait nor talk.
*/
#include "contact/projector/projectorimpl.h"
#include "base/gather.h"

#define BORDER_TAG 36

/* A node that a rank's pairs may move */
typedef struct {
  PetscInt node, rank;
} Touch;

static PetscErrorCode TouchesGather(ContactProjector p, const PetscBool touched[], PetscInt *n, Touch **all)
{
  Touch   *local;
  PetscInt n_local = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(p->share.n_nodes, &local));
  for (PetscInt i = 0; i < p->share.n_nodes; i++)
    if (touched[i]) local[n_local++] = (Touch){i, p->share.rank};
  PetscCall(GatherRecords(p->share.comm, n_local, sizeof(Touch), local, n, all));
  PetscCall(PetscFree(local));
  PetscFunctionReturn(0);
}

/* joined [size][size] ranks with a node in common; of one node the ranks are in their order, as in `all` */
static PetscErrorCode RanksJoin(const ProjectorShare *share, PetscInt n, const Touch all[], PetscBool joined[])
{
  PetscInt *last, *before; /* of a node: the place of its last rank; of a place: that of the rank before */

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(share->n_nodes, &last, n, &before));
  for (PetscInt i = 0; i < share->n_nodes; i++) last[i] = -1;
  for (PetscInt i = 0; i < n; i++) {
    before[i]         = last[all[i].node];
    last[all[i].node] = i;
    for (PetscInt j = before[i]; j >= 0; j = before[j])
      joined[all[i].rank * share->size + all[j].rank] = joined[all[j].rank * share->size + all[i].rank] = PETSC_TRUE;
  }
  PetscCall(PetscFree2(last, before));
  PetscFunctionReturn(0);
}

/* The least colour that no joined rank before has; the first rank of those that hang together, directly or not */
static void RanksColour(PetscMPIInt size, const PetscBool joined[], PetscMPIInt colour[], PetscMPIInt group[])
{
  PetscBool changed = PETSC_TRUE;

  for (PetscMPIInt r = 0; r < size; r++) {
    colour[r] = 0;
    group[r]  = r;
    for (PetscMPIInt s = 0; s < r; s++)
      if (joined[r * size + s] && colour[s] == colour[r]) {
        colour[r]++;
        s = -1; /* begin anew */
      }
  }
  while (changed) {
    changed = PETSC_FALSE;
    for (PetscMPIInt i = 0; i < size * size; i++)
      if (joined[i] && group[i % size] < group[i / size]) {
        group[i / size] = group[i % size];
        changed         = PETSC_TRUE;
      }
  }
}

/* Nodes in common with rank r, which lie in touches [from, to) of it; mine [n_nodes] those of this rank */
static PetscErrorCode NeighbourSet(ProjectorBorder *border, PetscMPIInt r, PetscInt n, const Touch all[],
                                   const PetscBool mine[], PetscBool shared[])
{
  ProjectorNeighbour *neighbour = &border->neighbour[border->n++];

  PetscFunctionBeginUser;
  *neighbour = (ProjectorNeighbour){.rank = r, .request = MPI_REQUEST_NULL};
  for (PetscInt i = 0; i < n; i++) neighbour->n += all[i].rank == r && mine[all[i].node] ? 1 : 0;
  PetscCall(
    PetscMalloc3(neighbour->n, &neighbour->node, 3 * neighbour->n, &neighbour->out, 3 * neighbour->n, &neighbour->in));
  neighbour->n = 0;
  for (PetscInt i = 0; i < n; i++) {
    if (all[i].rank != r || !mine[all[i].node]) continue;
    neighbour->node[neighbour->n++] = all[i].node;
    shared[all[i].node]             = PETSC_TRUE;
  }
  PetscFunctionReturn(0);
}

/* Neighbours in the order of their colours, those before this rank's own first */
static PetscErrorCode NeighboursFind(ContactProjector p, PetscInt n, const Touch all[], const PetscBool joined[],
                                     const PetscMPIInt colour[])
{
  const ProjectorShare *share  = &p->share;
  ProjectorBorder      *border = &p->border;
  PetscBool            *mine;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(share->n_nodes, &mine));
  for (PetscInt i = 0; i < n; i++)
    if (all[i].rank == share->rank) mine[all[i].node] = PETSC_TRUE;
  PetscCall(PetscCalloc2(share->size, &border->neighbour, share->n_nodes, &border->shared));
  for (PetscMPIInt c = 0; c < share->size; c++) {
    if (c == colour[share->rank]) border->n_before = border->n;
    for (PetscMPIInt r = 0; r < share->size; r++)
      if (colour[r] == c && joined[share->rank * share->size + r])
        PetscCall(NeighbourSet(border, r, n, all, mine, border->shared));
  }
  PetscCall(PetscFree(mine));
  PetscFunctionReturn(0);
}

PetscErrorCode BorderDestroy(ProjectorBorder *border)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < border->n; i++) {
    PetscCallMPI(MPI_Wait(&border->neighbour[i].request, MPI_STATUS_IGNORE));
    PetscCall(PetscFree3(border->neighbour[i].node, border->neighbour[i].out, border->neighbour[i].in));
  }
  PetscCall(PetscFree2(border->neighbour, border->shared));
  if (border->n) PetscCallMPI(MPI_Comm_free(&border->comm));
  *border = (ProjectorBorder){.n = 0};
  PetscFunctionReturn(0);
}

PetscErrorCode BorderFind(ContactProjector p, const PetscBool touched[])
{
  const PetscMPIInt size = p->share.size;
  PetscMPIInt      *colour, *group;
  PetscBool        *joined;
  PetscInt          n;
  Touch            *all;
  MPI_Comm          comm;

  PetscFunctionBeginUser;
  PetscCall(BorderDestroy(&p->border));
  PetscCall(TouchesGather(p, touched, &n, &all));
  PetscCall(PetscMalloc2(size, &colour, size, &group));
  PetscCall(PetscCalloc1((size_t)size * (size_t)size, &joined));
  PetscCall(RanksJoin(&p->share, n, all, joined));
  RanksColour(size, joined, colour, group);
  PetscCall(NeighboursFind(p, n, all, joined, colour));
  PetscCallMPI(MPI_Comm_split(p->share.comm, p->border.n ? group[p->share.rank] : MPI_UNDEFINED, p->share.rank, &comm));
  p->border.comm = comm;
  PetscCall(PetscFree(joined));
  PetscCall(PetscFree2(colour, group));
  PetscCall(PetscFree(all));
  PetscFunctionReturn(0);
}

/* Takes the velocities at shared nodes from neighbours [from, to), in the order of their colours */
static PetscErrorCode BorderTake(ContactProjector p, PetscInt from, PetscInt to)
{
  PetscFunctionBeginUser;
  for (PetscInt i = from; i < to; i++) {
    const ProjectorNeighbour *b = &p->border.neighbour[i];

    PetscCallMPI(
      MPI_Recv(b->in, (PetscMPIInt)(3 * b->n), MPIU_REAL, b->rank, BORDER_TAG, p->share.comm, MPI_STATUS_IGNORE));
    for (PetscInt j = 0; j < 3 * b->n; j++) p->nodes.v[3 * b->node[j / 3] + j % 3] = b->in[j];
  }
  PetscFunctionReturn(0);
}

PetscErrorCode BorderBegin(ContactProjector p)
{
  PetscFunctionBeginUser;
  PetscCall(BorderTake(p, 0, p->border.n_before));
  PetscFunctionReturn(0);
}

PetscErrorCode BorderSend(ContactProjector p)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < p->border.n; i++) {
    ProjectorNeighbour *b = &p->border.neighbour[i];

    PetscCallMPI(MPI_Wait(&b->request, MPI_STATUS_IGNORE));
    for (PetscInt j = 0; j < 3 * b->n; j++) b->out[j] = p->nodes.v[3 * b->node[j / 3] + j % 3];
    PetscCallMPI(
      MPI_Isend(b->out, (PetscMPIInt)(3 * b->n), MPIU_REAL, b->rank, BORDER_TAG, p->share.comm, &b->request));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode BorderEnd(ContactProjector p)
{
  PetscFunctionBeginUser;
  PetscCall(BorderTake(p, p->border.n_before, p->border.n));
  PetscFunctionReturn(0);
}

PetscErrorCode BorderLargest(const ContactProjector p, PetscInt n, PetscReal values[])
{
  PetscFunctionBeginUser;
  if (!p->border.n) PetscFunctionReturn(0);
  for (PetscInt i = 0; i < n; i++)
    if (PetscIsNanReal(values[i])) values[i] = PETSC_INFINITY; /* the largest of what is no number is not defined */
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, values, (PetscMPIInt)n, MPIU_REAL, MPIU_MAX, p->border.comm));
  PetscFunctionReturn(0);
}
