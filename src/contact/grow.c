/*
   Growing of the closed part of an interface by rows of nodes. Every rank gets the corners of all facets of the slave
   surface by their global numbers, and the status of all pairs, and moves the front alike, so that the ranks that share
   a surface do not matter.
*/
#include "contactimpl.h"
#include "base/gather.h"

/* Status of a node of the slave surface; without pair where a rank has found none */
typedef enum { NODE_WITHOUT_PAIR, NODE_OPEN, NODE_CLOSED } NodeStatus;

/* The slave surface of one interface, on every rank */
typedef struct {
  PetscInt  n_facets, *corner; /* [n_facets][4] places in number */
  PetscInt  n_nodes, *number;  /* global numbers of the vertices, ascending */
  PetscInt *status, *before;   /* NodeStatus of each node, and what it was a row ago */
} GrowSurface;

/* Global numbers of the corners of this rank's facets, array [n] */
static PetscErrorCode CornersLocal(Model model, const char set[], PetscInt *n, PetscInt **corner)
{
  const Mesh *mesh;
  PetscInt    n_facets;

  PetscFunctionBeginUser;
  PetscCall(ModelGetMesh(model, &mesh));
  PetscCall(ModelGetSetFaces(model, set, &n_facets, corner));
  *n = 4 * n_facets;
  for (PetscInt i = 0; i < *n; i++) (*corner)[i] = mesh->number[(*corner)[i]];
  PetscFunctionReturn(0);
}

/* Facets and nodes of the slave surface of an interface, all without pair */
static PetscErrorCode GrowSurfaceCreate(Contact contact, PetscInt interface, GrowSurface *s)
{
  PetscInt n_local, n, *local;

  PetscFunctionBeginUser;
  PetscCall(CornersLocal(contact->model, contact->interfaces[interface].slave, &n_local, &local));
  PetscCall(GatherRecords(contact->comm, n_local, sizeof(PetscInt), local, &n, &s->corner));
  PetscCall(PetscFree(local));
  PetscCall(PetscMalloc1(n, &s->number));
  PetscCall(PetscArraycpy(s->number, s->corner, n));
  s->n_facets = n / 4;
  s->n_nodes  = n;
  PetscCall(PetscSortRemoveDupsInt(&s->n_nodes, s->number));
  for (PetscInt i = 0; i < n; i++) PetscCall(PetscFindInt(s->corner[i], s->n_nodes, s->number, &s->corner[i]));
  PetscCall(PetscCalloc2(s->n_nodes, &s->status, s->n_nodes, &s->before));
  PetscFunctionReturn(0);
}

static PetscErrorCode GrowSurfaceDestroy(GrowSurface *s)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree2(s->status, s->before));
  PetscCall(PetscFree(s->number));
  PetscCall(PetscFree(s->corner));
  PetscFunctionReturn(0);
}

/* Place of the slave node of a local pair among the nodes of the surface */
static PetscErrorCode NodeFind(Contact contact, PetscInt pair, const GrowSurface *s, PetscInt *node)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFindInt(contact->vertex[pair], s->n_nodes, s->number, node));
  PetscCheck(*node >= 0, PETSC_COMM_SELF, PETSC_ERR_PLIB, "a pair's slave node is no corner of the slave surface");
  PetscFunctionReturn(0);
}

/* Status of all nodes from the pairs of all ranks */
static PetscErrorCode SurfaceGather(Contact contact, PetscInt interface, const PetscBool closed[], GrowSurface *s)
{
  PetscFunctionBeginUser;
  for (PetscInt p = 0; p < contact->n_pairs; p++) {
    PetscInt node;

    if (contact->pairs[p].interface != interface) continue;
    PetscCall(NodeFind(contact, p, s, &node));
    s->status[node] = closed[p] ? NODE_CLOSED : NODE_OPEN;
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, s->status, (PetscMPIInt)s->n_nodes, MPIU_INT, MPI_MAX, contact->comm));
  PetscFunctionReturn(0);
}

/* One row: nodes with status `from` that share a facet with one of status `to` get that one */
static PetscErrorCode SurfaceGrow(GrowSurface *s, NodeStatus from, NodeStatus to)
{
  PetscFunctionBeginUser;
  PetscCall(PetscArraycpy(s->before, s->status, s->n_nodes));
  for (PetscInt f = 0; f < s->n_facets; f++) {
    const PetscInt *corner  = &s->corner[4 * f];
    PetscBool       touches = PETSC_FALSE;

    for (int i = 0; i < 4; i++)
      if (s->before[corner[i]] == (PetscInt)to) touches = PETSC_TRUE;
    for (int i = 0; i < 4 && touches; i++)
      if (s->before[corner[i]] == (PetscInt)from) s->status[corner[i]] = to;
  }
  PetscFunctionReturn(0);
}

/* Status of this rank's pairs */
static PetscErrorCode SurfaceScatter(Contact contact, PetscInt interface, const GrowSurface *s, PetscBool closed[])
{
  PetscFunctionBeginUser;
  for (PetscInt p = 0; p < contact->n_pairs; p++) {
    PetscInt node;

    if (contact->pairs[p].interface != interface) continue;
    PetscCall(NodeFind(contact, p, s, &node));
    closed[p] = s->status[node] == NODE_CLOSED ? PETSC_TRUE : PETSC_FALSE;
  }
  PetscFunctionReturn(0);
}

PetscErrorCode ContactGrow(Contact contact, PetscInt rows, PetscBool closed[])
{
  const NodeStatus from = rows > 0 ? NODE_OPEN : NODE_CLOSED, to = rows > 0 ? NODE_CLOSED : NODE_OPEN;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < contact->n_interfaces && rows; i++) {
    GrowSurface s;

    PetscCall(GrowSurfaceCreate(contact, i, &s));
    PetscCall(SurfaceGather(contact, i, closed, &s));
    for (PetscInt k = 0; k < PetscAbsInt(rows); k++) PetscCall(SurfaceGrow(&s, from, to));
    PetscCall(SurfaceScatter(contact, i, &s, closed));
    PetscCall(GrowSurfaceDestroy(&s));
  }
  PetscFunctionReturn(0);
}
