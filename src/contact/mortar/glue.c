/*
   Ties by mortar: both surfaces have the same mean under each dual function phi_p of the slave (mortar.c),

      int phi_p (u^s - u^m - omega x g) dA = 0,   g = sum_k v_k x_k - sum_l w_l x_l  (m),

   with the sides v and w of a mortar pair, and omega the turning of the master at the foot of node p (kernels/contact/
   arm.h), so that rigid motions across a gap are exact. D is diagonal: the node follows without a solve,

      u_p = (sum_l w_l u_l + omega x g - sum_k>0 v_k u_k) / v_p.

   k are nodes without an equation, and of second order the corners beside a side, which follow themselves (operators/
   points/dependents.c). sum_p phi_p = 1: uniform stress passes exactly between any two meshes of flat surfaces.

   Nodes that must stay free for other reasons have no equation, and give phi_k to those beside them (border.c): nodes
   of both surfaces, nodes that follow by another tie, and, along each axis alone, nodes that a support holds. Hence an
   edge at which several ties or a support meet needs no care.
   B. Wohlmuth, Discretization methods and iterative solvers based on domain decomposition, 2001.
*/
#include "mortarimpl.h"
#include "base/algebra/vec3.h"
#include "kernels/contact/arm.h"

#define GLUE_SHARE   0.05 /* of the larger mean facet: how far surfaces are apart at most, where none is given */
#define GLUE_TOUCHES 1e-9 /* of a facet: rounding of the places, no gap */

/* The links of one tie as they are made */
typedef struct {
  Contact               contact;
  PetscInt              tie, n; /* slave nodes of this rank */
  ContactSurface        slave;
  const ContactSurface *master;
  PetscReal             tolerance;           /* m */
  PetscBool            *out[3];              /* [slave nodes] without an equation along an axis */
  MortarPairs           pairs[3], *along[3]; /* the equations, and which are those along an axis: often the same */
  ContactPair          *pair[3];
  PetscInt             *node; /* [n] local */
} Glue;

/* Marks the nodes that stay free along all axes, then those that a support holds along one */
static PetscErrorCode OutMark(Glue *glue)
{
  const Contact contact = glue->contact;
  PetscBool    *out     = glue->out[0];
  PetscInt      at;

  PetscFunctionBeginUser;
  for (PetscInt l = 0; l < contact->n_links; l++) {
    PetscCall(PetscFindInt(contact->links[l].vertex, glue->slave.n_nodes, glue->slave.vertex, &at));
    if (at >= 0) out[at] = PETSC_TRUE;
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, out, (PetscMPIInt)glue->slave.n_nodes, MPIU_BOOL, MPI_LOR, contact->comm));
  for (PetscInt i = 0; i < glue->slave.n_nodes; i++) {
    PetscCall(PetscFindInt(glue->slave.vertex[i], glue->master->n_nodes, glue->master->vertex, &at));
    if (at >= 0) out[i] = PETSC_TRUE;
  }
  for (int d = 1; d < 3; d++) PetscCall(PetscArraycpy(glue->out[d], out, glue->slave.n_nodes));
  for (PetscInt f = 0; f < glue->slave.n_facets; f++)
    for (int j = 0; j < 3 * glue->slave.facet[f].n; j++)
      if (glue->slave.facet[f].unknowns[j / 3][j % 3] < 0)
        glue->out[j % 3][glue->slave.facet[f].node[j / 3]] = PETSC_TRUE;
  PetscFunctionReturn(0);
}

/* A pair for each slave node of this rank */
static PetscErrorCode GlueCreate(Contact contact, PetscInt t, const ContactSurface *master, Glue *glue)
{
  const ContactTie *tie = &contact->ties[t];
  const Mesh       *mesh;

  PetscFunctionBeginUser;
  *glue = (Glue){.contact = contact, .tie = t, .master = master};
  PetscCall(ModelGetMesh(contact->model, &mesh));
  PetscCall(ContactSurfaceCreate(contact, tie->slave, &glue->slave));
  PetscCall(ModelGetOwnedNodes(contact->model, tie->slave, &glue->n, &glue->node));
  glue->tolerance = tie->distance > 0 ? tie->distance : GLUE_SHARE * PetscMax(glue->slave.size, master->size);
  for (int d = 0; d < 3; d++) {
    PetscCall(PetscCalloc1(glue->slave.n_nodes, &glue->out[d]));
    PetscCall(PetscCalloc1(glue->n, &glue->pair[d]));
    for (PetscInt i = 0; i < glue->n; i++) {
      glue->pair[d][i] = (ContactPair){.vertex = mesh->number[glue->node[i]]};
      PetscCall(PetscArraycpy(glue->pair[d][i].x, &mesh->x[3 * glue->node[i]], 3));
    }
  }
  PetscCall(OutMark(glue));
  PetscFunctionReturn(0);
}

static PetscErrorCode GlueDestroy(Glue *glue)
{
  PetscFunctionBeginUser;
  for (int d = 0; d < 3; d++) {
    PetscCall(PetscFree(glue->pairs[d].sides));
    if (glue->along[d] == &glue->pairs[d]) PetscCall(MortarPairsDestroy(&glue->pairs[d]));
    PetscCall(PetscFree(glue->pair[d]));
    PetscCall(PetscFree(glue->out[d]));
  }
  PetscCall(PetscFree(glue->node));
  PetscCall(ContactSurfaceDestroy(&glue->slave));
  PetscFunctionReturn(0);
}

/* Whether node p of one side of an edge follows one that follows it: what a row has beside its node is free, or a node
   on which this depends as shape functions do, a corner of a side, or that or a side of a middle */
static PetscBool RowTurns(const MortarPairs *m, PetscInt p)
{
  const ContactSurface *slave = m->mortar.slave;
  ContactPairNode       mean[FACET_NODES];
  const int             n_mean = MortarMean(m, m->node[p], mean);
  PetscInt              at;

  for (PetscInt k = 1; k < m->pair[p].n_slave; k++) {
    PetscBool own = PETSC_FALSE;

    for (int i = 1; i < n_mean; i++)
      if (mean[i].number == m->pair[p].slave[k].number) own = PETSC_TRUE;
    if (own) continue;
    if (PetscFindInt(m->pair[p].slave[k].number, slave->n_nodes, slave->vertex, &at) || at < 0) return PETSC_TRUE;
    if (m->border.kept[at]) return PETSC_TRUE;
  }
  return m->pair[p].slave[0].weight > 0 ? PETSC_FALSE : PETSC_TRUE;
}

/* Raises the error for faces of second order that end beyond the master */
static PetscErrorCode GlueCheckRows(const Glue *glue, const MortarPairs *m)
{
  const ContactTie *tie   = &glue->contact->ties[glue->tie];
  PetscInt          turns = 0;

  PetscFunctionBeginUser;
  for (PetscInt p = 0; p < m->n_pairs; p++)
    if (m->pair[p].area > 0 && RowTurns(m, p)) turns++;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &turns, 1, MPIU_INT, MPI_SUM, glue->contact->comm));
  PetscCheck(!turns, glue->contact->comm, PETSC_ERR_SUP,
             "tie %s: the border of %s cuts faces of %s so that %" PetscInt_FMT " of its nodes would follow each "
             "other; swap -%s_surfaces, or give -%s_discretization node",
             tie->name, tie->master, tie->slave, turns, tie->name, tie->name);
  PetscFunctionReturn(0);
}

/* The equations along each axis; those of an axis before, where the same nodes have none */
static PetscErrorCode GlueMakePairs(Glue *glue, PetscReal *held, PetscReal x[3])
{
  const ContactTie *tie = &glue->contact->ties[glue->tie];

  PetscFunctionBeginUser;
  for (int d = 0; d < 3; d++) {
    MortarPairs *m = &glue->pairs[d];

    for (int e = 0; e < d && !glue->along[d]; e++) {
      PetscBool same;

      PetscCall(PetscArraycmp(glue->out[d], glue->out[e], glue->slave.n_nodes, &same));
      if (same) glue->along[d] = glue->along[e];
    }
    if (glue->along[d]) continue;
    glue->along[d] = m;
    *m             = (MortarPairs){.pair = glue->pair[d], .n_pairs = glue->n, .out = glue->out[d], .direction = d};
    PetscCall(MortarPairsMake(glue->contact->comm, &glue->slave, glue->master, glue->tolerance, m));
    PetscCall(MortarSumsCheck(glue->contact->comm, "tie", tie->name, tie->slave, tie->master, m));
    PetscCall(GlueCheckRows(glue, m));
    if (m->lost >= 0) {
      *held = 1;
      PetscCall(PetscArraycpy(x, glue->slave.facet[m->lost].x[0], 3));
    }
  }
  PetscFunctionReturn(0);
}

/* The nodes of a link as they are added */
typedef struct {
  PetscInt         n;
  ContactLinkNode *node;
} LinkNodes;

/* Adds to row d of what a link has of a node */
static void LinkAdd(PetscInt number, const PetscInt unknown[3], int d, const PetscReal row[3], LinkNodes *link)
{
  PetscInt i = 0;

  while (i < link->n && link->node[i].number != number) i++;
  if (i == link->n) link->node[link->n++] = (ContactLinkNode){number, {unknown[0], unknown[1], unknown[2]}, 0, {0}};
  for (int e = 0; e < 3; e++) link->node[i].follow[3 * d + e] += row[e];
}

/* Adds row d of omega x g / v_p, the turning of the master at the foot of the pair's node */
static void LinkTurn(const ContactSurface *master, const ContactPair *pair, const PetscReal offset[3], int d,
                     LinkNodes *link)
{
  const ContactFacet *f;
  ContactFoot         foot;
  PetscReal           w[FACET_NODES], A[FACET_NODES][9];

  ContactFootFind(master, pair->x, &foot);
  if (foot.facet < 0) return;
  f = &master->facet[foot.facet];
  if (Vec3Length(offset) < GLUE_TOUCHES * f->size) return;
  FacetWeights(f->n, foot.natural, w);
  FacetArm(f->n, (const double(*)[3])f->x, foot.natural, offset, A);
  for (int i = 0; i < f->n; i++) {
    PetscReal row[3];

    for (int e = 0; e < 3; e++) row[e] = (A[i][3 * d + e] - (d == e ? w[i] : 0)) / pair->slave[0].weight;
    LinkAdd(master->vertex[f->node[i]], f->unknowns[i], d, row, link);
  }
}

/* Adds row d of c times the nodes of a side from the first on */
static void LinkAddSide(PetscInt first, PetscInt n, const ContactPairNode side[], int d, PetscReal c, LinkNodes *link)
{
  for (PetscInt k = first; k < n; k++) {
    PetscReal row[3] = {0, 0, 0};

    row[d] = c * side[k].weight;
    LinkAdd(side[k].number, side[k].unknown, d, row, link);
  }
}

/* The link of node i of this rank, room for what it follows; n_master 0 where it has no equation along any axis.
   The rows of axes without one are 0: a support holds the node there. */
static PetscErrorCode GlueLink(const Glue *glue, PetscInt i, ContactLinkNode node[], ContactLink *link,
                               PetscReal *distance)
{
  const Mesh    *mesh;
  const PetscInt v     = glue->node[i];
  LinkNodes      nodes = {0, node};

  PetscFunctionBeginUser;
  PetscCall(ModelGetMesh(glue->contact->model, &mesh));
  *link = (ContactLink){.tie = glue->tie, .node = v, .vertex = mesh->number[v], .master = node};
  for (int d = 0; d < 3; d++) {
    const MortarPairs *m    = glue->along[d];
    const ContactPair *pair = &m->pair[i];
    PetscReal          offset[3];

    link->x[d]     = mesh->x[3 * v + d];
    link->slave[d] = mesh->unknown[3 * v + d];
    if (pair->area <= 0) continue;
    PetscCall(MortarOffset(m, i, offset));
    *distance = PetscMax(*distance, Vec3Length(offset));
    LinkAddSide(0, pair->n_master, pair->master, d, 1 / pair->slave[0].weight, &nodes);
    LinkAddSide(1, pair->n_slave, pair->slave, d, -1 / pair->slave[0].weight, &nodes);
    LinkTurn(glue->master, pair, offset, d, &nodes);
  }
  link->n_master = nodes.n;
  PetscFunctionReturn(0);
}

/* Room for the nodes of all links of this rank */
static PetscInt GlueRoom(const Glue *glue)
{
  PetscInt room = 0;

  for (PetscInt i = 0; i < glue->n; i++)
    for (int d = 0; d < 3; d++)
      if (glue->along[d]->pair[i].area > 0)
        room += glue->along[d]->pair[i].n_master + glue->along[d]->pair[i].n_slave + FACET_NODES;
  return room;
}

/* Whether a node without a link is beside the master, not left out for other reasons */
static PetscBool NodeIsOff(const Glue *glue, PetscInt i)
{
  const PetscInt at = glue->along[0]->node[i];

  for (int d = 0; d < 3; d++)
    if (glue->out[d][at]) return PETSC_FALSE;
  return PETSC_TRUE;
}

PetscErrorCode ContactGlue(Contact contact, PetscInt t, const ContactSurface *master, ContactTie *count,
                           PetscReal *held, PetscReal x[3])
{
  ContactLinkNode *node;
  Glue             glue;

  PetscFunctionBeginUser;
  PetscCall(GlueCreate(contact, t, master, &glue));
  PetscCall(GlueMakePairs(&glue, held, x));
  PetscCall(PetscMalloc1(GlueRoom(&glue), &node));
  PetscCall(PetscRealloc(sizeof(ContactLink) * (size_t)(contact->n_links + glue.n), &contact->links));
  contact->followed[t] = node;
  for (PetscInt i = 0; i < glue.n; i++) {
    ContactLink *link = &contact->links[contact->n_links];

    PetscCall(GlueLink(&glue, i, node, link, &count->offset));
    node += link->n_master;
    if (link->n_master)
      contact->n_links++, count->n++;
    else if (NodeIsOff(&glue, i))
      count->n_off++;
  }
  PetscCall(GlueDestroy(&glue));
  PetscFunctionReturn(0);
}
