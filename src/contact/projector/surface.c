/*
   Nodes of the contact surfaces of a scene, with numbers of their own, those of the masters
   (contact/surface/surface.h), and the slaves. All is made once from the mesh as it is; every rank sees the lists, and
   keeps the slaves whose pairs it solves. Where all ranks solve, that are those whose nodes it owns, up to its share;
   the rest goes to ranks that have less, in the order of the places. Mortar pairs whose sides change are the root's, as
   are few pairs of any kind.
*/
#include "projectorimpl.h"
#include "base/gather.h"
#include <stdlib.h>

/* A slave node as its owner knows it */
typedef struct {
  PetscInt  interface, number, place; /* place: ProjectorPair */
  PetscInt  rank;                     /* owner of the node, then the one that solves its pair */
  PetscReal x[3];
} Slave;

/* Marks the local nodes (from 0) of a set */
static PetscErrorCode VerticesMark(Model model, const char set[], PetscBool mark[])
{
  PetscInt n, *v;

  PetscFunctionBeginUser;
  PetscCall(ModelGetSetNodes(model, set, &n, &v));
  for (PetscInt i = 0; i < n; i++) mark[v[i]] = PETSC_TRUE;
  PetscCall(PetscFree(v));
  PetscFunctionReturn(0);
}

/* All local nodes of contact surfaces, ascending */
static PetscErrorCode SurfaceVerticesFind(Contact contact, PetscInt *n, PetscInt **vertex)
{
  const Mesh *mesh;
  PetscBool  *mark;

  PetscFunctionBeginUser;
  PetscCall(ModelGetMesh(contact->model, &mesh));
  PetscCall(PetscCalloc1(mesh->n_nodes, &mark));
  for (PetscInt i = 0; i < contact->n_interfaces; i++) {
    PetscCall(VerticesMark(contact->model, contact->interfaces[i].slave, mark));
    PetscCall(VerticesMark(contact->model, contact->interfaces[i].master, mark));
  }
  *n = 0;
  for (PetscInt v = 0; v < mesh->n_nodes; v++) *n += mark[v];
  PetscCall(PetscMalloc1(*n, vertex));
  for (PetscInt v = 0, k = 0; v < mesh->n_nodes; v++)
    if (mark[v]) (*vertex)[k++] = v;
  PetscCall(PetscFree(mark));
  PetscFunctionReturn(0);
}

/* The nodes of all ranks: unique[n] ascending global node numbers, and who has them. A node's number of its own is
   its place in unique[]; ~ marks a copy, as 0 has no sign. */
static PetscErrorCode NodesFind(ContactProjector p, PetscInt *n_unique, PetscInt **unique)
{
  ProjectorShare *share = &p->share;
  const Mesh     *mesh;
  PetscInt        n, *vertex, *local, total;

  PetscFunctionBeginUser;
  PetscCall(SurfaceVerticesFind(p->contact, &n, &vertex));
  PetscCall(ModelGetMesh(p->contact->model, &mesh));
  PetscCall(PetscMalloc1(n, &local));
  for (PetscInt i = 0; i < n; i++)
    local[i] = mesh->owned[vertex[i]] ? mesh->number[vertex[i]] : ~mesh->number[vertex[i]];
  PetscCall(ShareSetUp(p->contact->comm, n, local, share)); /* numbers of nodes for a while: negative where not owned */
  total = share->first[share->size];
  PetscCall(PetscMalloc1(total, unique));
  for (PetscInt i = 0; i < total; i++) (*unique)[i] = ShareNode(share, i);
  *n_unique = total;
  PetscCall(PetscSortRemoveDupsInt(n_unique, *unique));
  for (PetscInt i = 0; i < total; i++) {
    const PetscBool owned = share->holder[i] >= 0 ? PETSC_TRUE : PETSC_FALSE;
    PetscInt        node;

    PetscCall(PetscFindInt(ShareNode(share, i), *n_unique, *unique, &node));
    share->holder[i] = owned ? node : ~node;
  }
  share->vertex = vertex;
  PetscCall(ShareSetNodes(share, *n_unique));
  PetscCall(PetscFree(local));
  PetscFunctionReturn(0);
}

/* Slaves of this rank of one interface, appended */
static PetscErrorCode SlavesAppend(Contact contact, PetscInt interface, PetscInt *n_slaves, Slave **slave)
{
  const Mesh *mesh;
  PetscMPIInt rank;
  PetscInt    n, *v;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(contact->comm, &rank));
  PetscCall(ModelGetMesh(contact->model, &mesh));
  PetscCall(ModelGetOwnedNodes(contact->model, contact->interfaces[interface].slave, &n, &v));
  PetscCall(PetscRealloc(sizeof(Slave) * (size_t)(*n_slaves + n), slave));
  for (PetscInt i = 0; i < n; i++) {
    Slave *s = &(*slave)[(*n_slaves)++];

    *s = (Slave){.interface = interface, .number = mesh->number[v[i]], .rank = rank};
    PetscCall(PetscArraycpy(s->x, &mesh->x[3 * v[i]], 3));
  }
  PetscCall(PetscFree(v));
  PetscFunctionReturn(0);
}

/* The rank with most slaves, the first of them */
static PetscErrorCode RootFind(MPI_Comm comm, PetscInt n_slaves, PetscMPIInt *root)
{
  struct {
    int n, rank;
  } most = {(int)n_slaves, 0};

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(comm, &most.rank));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &most, 1, MPI_2INT, MPI_MAXLOC, comm));
  *root = most.rank;
  PetscFunctionReturn(0);
}

/* By interface, then place, so that the order does not depend on the ranks */
static int SlaveCompare(const void *left, const void *right)
{
  const Slave *a = (const Slave *)left, *b = (const Slave *)right;

  if (a->interface != b->interface) return a->interface < b->interface ? -1 : 1;
  if (ContactPlaceCompare(a->x, b->x)) return ContactPlaceCompare(a->x, b->x);
  return (a->place > b->place) - (a->place < b->place);
}

/* Places of the slaves of mortar interfaces; those at folds get a slave for each further side, appended */
static PetscErrorCode SlavesPlace(ContactProjector p, PetscInt *n_slaves, Slave **slave)
{
  const PetscInt n     = *n_slaves;
  PetscInt       extra = 0;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < p->n_interfaces; i++)
    if (p->mortar[i]) extra += p->mortar[i]->moved.slave.n_nodes;
  PetscCall(PetscRealloc(sizeof(Slave) * (size_t)(n + extra), slave));
  for (PetscInt k = 0; k < n; k++) {
    const ProjectorMortar *m    = p->mortar[(*slave)[k].interface];
    const ContactSurface  *s    = m ? &m->moved.slave : NULL;
    PetscInt               side = s ? s->n_sorted : 0;

    if (s) PetscCall(PetscFindInt((*slave)[k].number, s->n_sorted, s->vertex, &(*slave)[k].place));
    for (; s && side < s->n_nodes; side++) {
      if (s->vertex[side] != (*slave)[k].number) continue;
      (*slave)[*n_slaves]           = (*slave)[k];
      (*slave)[(*n_slaves)++].place = side;
    }
  }
  PetscFunctionReturn(0);
}

/* One pair per slave, without partner as yet */
static PetscErrorCode PairsCreate(ContactProjector p, PetscInt n, const Slave slave[], const PetscInt unique[])
{
  static const PetscReal one = 1;

  PetscFunctionBeginUser;
  p->n_pairs = n;
  PetscCall(PetscCalloc2(CONTACT_MAX_MASTER * n, &p->node, CONTACT_MAX_MASTER * n, &p->weight));
  PetscCall(PetscCalloc3(n, &p->pair, n, &p->row, n, &p->state));
  PetscCall(PetscMalloc5(n, &p->interface, n, &p->number, 3 * n, &p->slave_x, n, &p->visited, n, &p->visit));
  PetscCall(PetscCalloc1(n, &p->at_border));
  PetscCall(PetscCalloc2(n + 1, &p->first_candidate, 3 * n, &p->place));
  for (PetscInt i = 0; i < n; i++) {
    p->pair[i].interface = p->interface[i] = slave[i].interface;
    p->pair[i].facet                       = -1;
    p->pair[i].place                       = slave[i].place;
    p->pair[i].node                        = &p->node[CONTACT_MAX_MASTER * i];
    p->pair[i].weight                      = &p->weight[CONTACT_MAX_MASTER * i];
    p->pair[i].n_own                       = 1;
    p->pair[i].own                         = &p->pair[i].slave;
    p->pair[i].own_weight                  = &one;
    p->number[i]                           = slave[i].number;
    PetscCall(PetscFindInt(slave[i].number, p->share.n_nodes, unique, &p->pair[i].slave));
    PetscCall(PetscArraycpy(&p->slave_x[3 * i], slave[i].x, 3));
  }
  PetscFunctionReturn(0);
}

/* Which rank solves each pair, and of these the ones of this rank, in their order */
static PetscErrorCode SlavesDeal(ContactProjector p, PetscInt *n, Slave slave[])
{
  const PetscMPIInt size = p->share.size, root = p->share.root;
  const PetscInt    most = (*n + size - 1) / size;
  const Mesh       *mesh;
  PetscInt         *has, turn = 0, mine = 0, n_cells;

  PetscFunctionBeginUser;
  PetscCall(ModelGetMesh(p->contact->model, &mesh));
  PetscCallMPI(MPI_Allreduce(&mesh->n_cells, &n_cells, 1, MPIU_INT, MPI_SUM, p->share.comm));
  p->spread = p->ranks == PROJECTOR_ALL || (p->ranks == PROJECTOR_AUTO && ModelSharesPairs(*n, size, n_cells));
  p->fine   = p->ranks == PROJECTOR_ALL || (p->ranks == PROJECTOR_AUTO && *n >= MODEL_MANY_PAIRS);
  PetscCall(PetscCalloc1(size, &has));
  for (PetscInt i = 0; i < *n; i++) {
    if (!p->spread || MortarTravels(p, slave[i].interface))
      slave[i].rank = ~root;
    else if (++has[slave[i].rank] > most)
      slave[i].rank = size; /* one too many */
  }
  for (PetscInt i = 0; i < *n; i++) {
    while (slave[i].rank == size && has[turn] >= most) turn++;
    if (slave[i].rank == size) has[turn]++;
    if (slave[i].rank == size) slave[i].rank = turn;
    slave[i].rank = PetscMax(slave[i].rank, ~slave[i].rank);
    if (slave[i].rank == p->share.rank) slave[mine++] = slave[i];
  }
  *n              = mine;
  p->share.solves = mine || p->share.rank == root ? PETSC_TRUE : PETSC_FALSE;
  PetscCall(PetscFree(has));
  PetscFunctionReturn(0);
}

/* Slaves of all ranks, the root, and the pairs of this rank */
static PetscErrorCode SlavesFind(ContactProjector p, const PetscInt unique[])
{
  PetscInt n_local = 0, n;
  Slave   *local   = NULL, *all;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < p->n_interfaces; i++) PetscCall(SlavesAppend(p->contact, i, &n_local, &local));
  PetscCall(RootFind(p->contact->comm, n_local, &p->share.root));
  PetscCall(GatherRecords(p->contact->comm, n_local, sizeof(Slave), local, &n, &all));
  PetscCall(SlavesPlace(p, &n, &all));
  if (n) qsort(all, (size_t)n, sizeof(Slave), SlaveCompare);
  PetscCall(SlavesDeal(p, &n, all));
  PetscCall(PairsCreate(p, n, all, unique));
  PetscCall(PetscFree(local));
  PetscCall(PetscFree(all));
  PetscFunctionReturn(0);
}

/* Arrays of the nodes on the ranks that have pairs, with their places */
static PetscErrorCode NodesCreate(ContactProjector p)
{
  ProjectorNodes *nodes = &p->nodes;
  const PetscInt  n     = p->share.solves ? p->share.n_nodes : 0;
  const Mesh     *mesh;
  PetscReal      *local;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc7(3 * n, &nodes->x, 3 * n, &nodes->minv, 3 * n, &nodes->u, 3 * n, &nodes->before, 3 * n,
                         &nodes->v, 3 * n, &nodes->force, 3 * n, &nodes->predicted));
  PetscCall(PetscCalloc4(3 * n, &nodes->rest, n, &nodes->even, 3 * n, &p->u_search, p->share.n_nodes, &p->is_active));
  PetscCall(ModelGetMesh(p->contact->model, &mesh));
  PetscCall(PetscMalloc1(3 * p->share.n, &local));
  for (PetscInt i = 0; i < 3 * p->share.n; i++) local[i] = mesh->x[3 * p->share.vertex[i / 3] + i % 3];
  PetscCall(ShareGather(&p->share, 1, (const PetscReal *const[]){local}, (PetscReal *const[]){nodes->x}));
  PetscCall(PetscFree(local));
  PetscFunctionReturn(0);
}

/* The master of interface i, whose nodes are among the n of unique[] */
static PetscErrorCode MasterCreate(ContactProjector p, PetscInt i, PetscInt n, const PetscInt unique[])
{
  ProjectorMaster *m = &p->master[i];

  PetscFunctionBeginUser;
  PetscCall(ContactGetSurface(p->contact, i, &m->surface));
  PetscCall(PetscCalloc4(m->surface->n_nodes, &m->node, m->surface->n_nodes, &m->seen, m->surface->n_facets, &m->live,
                         m->surface->n_boxes, &m->box));
  for (PetscInt k = 0; k < m->surface->n_nodes; k++)
    PetscCall(PetscFindInt(m->surface->vertex[k], n, unique, &m->node[k]));
  PetscFunctionReturn(0);
}

PetscErrorCode ProjectorSetUpSurfaces(ContactProjector p)
{
  PetscInt *unique, n;

  PetscFunctionBeginUser;
  PetscCall(NodesFind(p, &n, &unique));
  PetscCall(ProjectorMortarCreate(p));
  PetscCall(SlavesFind(p, unique));
  PetscCall(ShareSetActive(&p->share, NULL));
  PetscCall(NodesCreate(p));
  for (PetscInt i = 0; i < p->n_interfaces; i++) PetscCall(MasterCreate(p, i, n, unique));
  PetscCall(ProjectorMortarNumber(p, n, unique));
  PetscCall(PetscFree(unique));
  PetscFunctionReturn(0);
}

PetscErrorCode ProjectorDestroySurfaces(ContactProjector p)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < p->n_interfaces; i++)
    PetscCall(PetscFree4(p->master[i].node, p->master[i].seen, p->master[i].live, p->master[i].box));
  PetscCall(ProjectorMortarDestroy(p));
  PetscCall(PetscFree2(p->node, p->weight));
  PetscCall(PetscFree3(p->pair, p->row, p->state));
  PetscCall(PetscFree(p->at_border));
  PetscCall(PetscFree5(p->interface, p->number, p->slave_x, p->visited, p->visit));
  PetscCall(PetscFree2(p->first_candidate, p->place));
  PetscCall(PetscFree(p->candidates.facet));
  PetscCall(
    PetscFree7(p->nodes.x, p->nodes.minv, p->nodes.u, p->nodes.before, p->nodes.v, p->nodes.force, p->nodes.predicted));
  PetscCall(PetscFree4(p->nodes.rest, p->nodes.even, p->u_search, p->is_active));
  PetscCall(ShareDestroy(&p->share));
  PetscFunctionReturn(0);
}
