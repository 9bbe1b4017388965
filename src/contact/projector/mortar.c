/*
   Mortar pairs in time. Sides and directions of a pair are those of the integrals over both surfaces where they lie
   (contact/mortar/moved.c). Where the meshes stay they are made once, at rest; elsewhere at knots in time, and between
   two of them are means of both (mean.c).

   The next knot lies ahead by the time in which bodies move by KNOT_WAY of a facet against each other, at most
   KNOT_STEPS steps where their velocities are not those of the options; places there are u + (t_1 - t) v_{n-1/2}, or
   those of the sliding that is given. The error of w is that of a line through a smooth function, of the order of
   KNOT_WAY^2.
*/
#include "projectorimpl.h"
#include "base/algebra/vec3.h"

#define KNOT_WAY   (1.0 / 32) /* sizes of a facet */
#define KNOT_STEPS 64

PetscBool MortarTravels(const ContactProjector p, PetscInt i)
{
  return p->mortar[i] && !SlidingStays(&p->sliding[i]) ? PETSC_TRUE : PETSC_FALSE;
}

static PetscBool AnyTravels(const ContactProjector p)
{
  for (PetscInt i = 0; i < p->n_interfaces; i++)
    if (MortarTravels(p, i)) return PETSC_TRUE;
  return PETSC_FALSE;
}

PetscErrorCode ProjectorMortarCreate(ContactProjector p)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < p->n_interfaces; i++) {
    PetscBool mortar;

    PetscCall(ContactIsMortar(p->contact, i, &mortar));
    if (!mortar) continue;
    PetscCall(PetscCalloc1(1, &p->mortar[i]));
    PetscCall(ContactMovedCreate(p->contact, i, &p->mortar[i]->moved));
  }
  PetscFunctionReturn(0);
}

/* Numbers of the projector of the nodes of a surface */
static PetscErrorCode SurfaceNumber(const ContactSurface *s, PetscInt n, const PetscInt unique[], PetscInt **number)
{
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(s->n_nodes, number));
  for (PetscInt v = 0; v < s->n_nodes; v++) PetscCall(PetscFindInt(s->vertex[v], n, unique, &(*number)[v]));
  PetscFunctionReturn(0);
}

/* Whether this rank has pairs of an interface, or may get some */
static PetscBool PairsAreHere(const ContactProjector p, PetscInt i)
{
  for (PetscInt k = 0; k < p->n_pairs; k++)
    if (p->pair[k].interface == i) return PETSC_TRUE;
  return p->share.rank == p->share.root ? PETSC_TRUE : PETSC_FALSE;
}

PetscErrorCode ProjectorMortarNumber(ContactProjector p, PetscInt n, const PetscInt unique[])
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < p->n_interfaces; i++) {
    ProjectorMortar *m = p->mortar[i];
    PetscInt        *number[2];

    if (!m || !PairsAreHere(p, i)) continue;
    PetscCall(SurfaceNumber(&m->moved.slave, n, unique, &number[0]));
    PetscCall(SurfaceNumber(m->moved.master, n, unique, &number[1]));
    PetscCall(ContactMovedNumber(&m->moved, number[0], number[1]));
    for (int k = 0; k < 2; k++) PetscCall(PetscFree(number[k]));
    PetscCall(PetscMalloc1(3 * (m->moved.slave.n_nodes + m->moved.master->n_nodes), &m->x));
    PetscCall(PetscCalloc1(2 * m->moved.slave.n_nodes + 1, &m->first));
  }
  if (p->share.rank == p->share.root && AnyTravels(p)) PetscCall(PetscCalloc1(6 * p->share.n_nodes, &p->u_knot));
  PetscFunctionReturn(0);
}

PetscErrorCode ProjectorMortarDestroy(ContactProjector p)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < p->n_interfaces; i++) {
    ProjectorMortar *m = p->mortar[i];

    if (!m) continue;
    for (int k = 0; k < 2; k++) PetscCall(ContactMovedPairsDestroy(&m->knot[k]));
    for (int k = 0; k < 2; k++) PetscCall(PetscFree(m->part[k]));
    PetscCall(ContactMovedDestroy(&m->moved));
    PetscCall(PetscFree(m->x));
    PetscCall(PetscFree(m->first));
    PetscCall(PetscFree(m->node));
    PetscCall(PetscFree(m->weight));
    PetscCall(PetscFree(p->mortar[i]));
  }
  PetscCall(PetscFree(p->u_knot));
  PetscFunctionReturn(0);
}

/* Pairs of knot k of interface i, time t, the nodes at u where displacements move the slaves */
static PetscErrorCode KnotMake(ContactProjector p, PetscInt i, int k, PetscReal t, const PetscReal u[])
{
  ProjectorMortar      *m     = p->mortar[i];
  const ContactSliding *s     = &p->sliding[i];
  const ContactSurface *slave = &m->moved.here[0], *master = &m->moved.here[1];
  PetscReal            *under = &m->x[3 * slave->n_nodes];
  ContactFrame          frame;

  PetscFunctionBeginUser;
  SlidingFrame(&p->contact->interfaces[i], s, t, &frame);
  for (PetscInt v = 0; v < slave->n_nodes; v++) {
    const PetscInt at = 3 * slave->vertex[v];

    FrameDisplacement(&frame, &p->nodes.x[at], s->slides ? &p->nodes.rest[at] : &u[at], &m->x[3 * v]);
  }
  for (PetscInt v = 0; v < master->n_nodes && !s->slides; v++)
    for (int d = 0; d < 3; d++) under[3 * v + d] = u[3 * master->vertex[v] + d];
  PetscCall(ContactMovedPairsDestroy(&m->knot[k]));
  PetscCall(ContactMovedFind(
    &m->moved, (const PetscReal *const[]){SlidingStays(s) ? NULL : m->x, s->slides ? NULL : under}, &m->knot[k]));
  m->has[k] = PETSC_TRUE;
  PetscFunctionReturn(0);
}

/* Adds a side at knot k to the nodes from `first` to `end`; the end then */
static PetscInt SideJoin(ProjectorMortar *m, int k, PetscInt n, const ContactPairNode side[], PetscInt first,
                         PetscInt end)
{
  for (PetscInt j = 0; j < n; j++) {
    PetscInt at = first;

    while (at < end && m->node[at] != side[j].number) at++;
    if (at == end) {
      m->node[end]    = side[j].number;
      m->part[0][end] = m->part[1][end] = 0;
      end++;
    }
    m->part[k][at] += side[j].weight;
  }
  return end;
}

/* Room for the nodes of all pairs, with four of each side at least */
static PetscErrorCode SidesReserve(ProjectorMortar *m)
{
  PetscInt n = 8 * m->moved.slave.n_nodes;

  PetscFunctionBeginUser;
  for (int k = 0; k < 2; k++)
    for (PetscInt v = 0; v < m->moved.slave.n_nodes && m->has[k]; v++)
      n += m->knot[k].pair[v].n_slave + m->knot[k].pair[v].n_master;
  if (n <= m->room) PetscFunctionReturn(0);
  m->room = n + n / 4;
  PetscCall(PetscRealloc(sizeof(PetscInt) * (size_t)m->room, &m->node));
  PetscCall(PetscRealloc(sizeof(PetscReal) * (size_t)m->room, &m->weight));
  for (int k = 0; k < 2; k++) PetscCall(PetscRealloc(sizeof(PetscReal) * (size_t)m->room, &m->part[k]));
  PetscFunctionReturn(0);
}

/* Nodes of both knots, of the master four at least: more of weight 0 */
static PetscErrorCode SidesJoin(ProjectorMortar *m)
{
  PetscInt end = 0;

  PetscFunctionBeginUser;
  PetscCall(SidesReserve(m));
  for (PetscInt v = 0; v < m->moved.slave.n_nodes; v++) {
    PetscInt first = m->first[2 * v] = end;

    for (int k = 0; k < 2; k++) {
      const ContactPair *pair = m->has[k] ? &m->knot[k].pair[v] : NULL;

      if (pair && pair->area > 0) end = SideJoin(m, k, pair->n_slave, pair->slave, first, end);
    }
    m->first[2 * v + 1] = first = end;
    for (int k = 0; k < 2; k++) {
      const ContactPair *pair = m->has[k] ? &m->knot[k].pair[v] : NULL;

      if (pair && pair->area > 0) end = SideJoin(m, k, pair->n_master, pair->master, first, end);
    }
    for (; end > first && end < first + 4; end++) {
      m->node[end]    = m->node[first];
      m->part[0][end] = m->part[1][end] = 0;
    }
  }
  m->first[2 * m->moved.slave.n_nodes] = end;
  PetscFunctionReturn(0);
}

/* Speed of an interface's bodies against each other that the options give, at most, or that of their nodes, m/s */
static PetscReal MortarSpeed(const ContactProjector p, PetscInt i)
{
  const ContactSliding *s     = &p->sliding[i];
  const ContactSurface *slave = &p->mortar[i]->moved.here[0], *master = &p->mortar[i]->moved.here[1];
  const PetscReal      *mean = &p->nodes.before[3 * slave->vertex[0]];
  PetscReal             most = 0;

  for (PetscInt v = 0; v < slave->n_nodes + master->n_nodes; v++) {
    const PetscInt at = 3 * (v < slave->n_nodes ? slave->vertex[v] : master->vertex[v - slave->n_nodes]);
    PetscReal      w[3];

    if (s->slides)
      ContactSlideAlong(&p->contact->interfaces[i], &p->nodes.x[at], w);
    else
      for (int d = 0; d < 3; d++) w[d] = p->nodes.before[at + d] - mean[d];
    most = PetscMax(most, Vec3Length(w));
  }
  return s->slides && !s->rotates ? s->speed : most;
}

/* From one knot to the next, s */
static PetscReal KnotLength(const ContactProjector p, PetscReal dt)
{
  PetscReal length = PETSC_MAX_REAL;

  for (PetscInt i = 0; i < p->n_interfaces; i++) {
    PetscReal speed, size;

    if (!MortarTravels(p, i)) continue;
    speed = MortarSpeed(p, i);
    size  = PetscMin(p->mortar[i]->moved.slave.size, p->mortar[i]->moved.master->size);
    if (speed * length > KNOT_WAY * size) length = KNOT_WAY * size / speed;
    if (!p->sliding[i].slides) length = PetscMin(length, KNOT_STEPS * dt);
  }
  return PetscMax(length, dt);
}

PetscErrorCode ProjectorMortarStart(ContactProjector p, PetscReal t, const PetscReal u[])
{
  PetscFunctionBeginUser;
  p->knot[0] = p->knot[1] = t;
  p->between              = 0;
  if (p->u_knot)
    for (int k = 0; k < 2; k++) PetscCall(PetscArraycpy(&p->u_knot[3 * k * p->share.n_nodes], u, 3 * p->share.n_nodes));
  for (PetscInt i = 0; i < p->n_interfaces; i++) {
    if (!MortarIsHere(p, i)) continue;
    p->mortar[i]->has[1] = PETSC_FALSE;
    PetscCall(KnotMake(p, i, 0, t, u));
    PetscCall(SidesJoin(p->mortar[i]));
  }
  PetscFunctionReturn(0);
}

/* The later knot becomes the earlier one, and a new one is made; places there in u_knot */
static PetscErrorCode KnotsAdvance(ContactProjector p, const ContactStep *step)
{
  const PetscInt n     = 3 * p->share.n_nodes;
  PetscReal     *ahead = &p->u_knot[n];

  PetscFunctionBeginUser;
  p->knot[0] = p->knot[1];
  p->knot[1] += KnotLength(p, step->dt);
  PetscCall(PetscArraycpy(p->u_knot, ahead, n));
  for (PetscInt j = 0; j < n; j++) ahead[j] = p->nodes.u[j] + (p->knot[1] - step->time) * p->nodes.before[j];
  for (PetscInt i = 0; i < p->n_interfaces; i++) {
    ProjectorMortar *m = p->mortar[i];

    if (!MortarTravels(p, i)) continue;
    if (m->has[1]) {
      const ContactMovedPairs keep = m->knot[0];

      m->knot[0] = m->knot[1];
      m->knot[1] = keep;
    }
    PetscCall(KnotMake(p, i, 1, p->knot[1], ahead));
    PetscCall(SidesJoin(m));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode ProjectorMortarStep(ContactProjector p, const ContactStep *step)
{
  const PetscReal t = step->time + step->dt;

  PetscFunctionBeginUser;
  if (!p->u_knot) PetscFunctionReturn(0);
  if (t > p->knot[1] + 1e-6 * step->dt) PetscCall(KnotsAdvance(p, step));
  p->between = PetscMin(1, PetscMax(0, (t - p->knot[0]) / (p->knot[1] - p->knot[0])));
  PetscFunctionReturn(0);
}

PetscErrorCode MortarActivate(ContactProjector p, PetscInt i, PetscReal reach, const PetscReal u[])
{
  const ContactSurface *slave = &p->mortar[i]->moved.here[0];
  ProjectorMaster      *m     = &p->master[i];
  const ContactShape    shape = {.surface = m->surface, .node = m->node, .u = u};
  ContactFacetList     *near  = &p->mortar[i]->moved.near;

  PetscFunctionBeginUser;
  for (PetscInt f = 0; f < slave->n_facets; f++) {
    const ContactFacet *facet     = &slave->facet[f];
    PetscReal           middle[3] = {0, 0, 0}, x[FACET_NODES][3], size = 0;

    for (int j = 0; j < facet->n; j++) {
      const PetscInt at = 3 * slave->vertex[facet->node[j]];

      FrameDisplacement(&p->frame[i], &p->nodes.x[at], &u[at], x[j]);
      for (int d = 0; d < 3; d++) x[j][d] += p->nodes.x[at + d];
      for (int d = 0; d < 3; d++) middle[d] += x[j][d] / facet->n;
    }
    for (int j = 0; j < facet->n; j++) {
      const PetscReal away[3] = {x[j][0] - middle[0], x[j][1] - middle[1], x[j][2] - middle[2]};

      size = PetscMax(size, Vec3Length(away));
    }
    near->n = 0;
    PetscCall(ContactFacetsNear(&shape, m->box, middle, size + reach, near));
    for (PetscInt c = 0; c < near->n; c++) m->live[near->facet[c]] = PETSC_TRUE;
  }
  PetscFunctionReturn(0);
}

PetscInt MortarMemoryLength(const ContactProjector p)
{
  return p->u_knot ? 3 + 6 * p->share.n_nodes : 0;
}

void MortarGetMemory(const ContactProjector p, PetscReal values[])
{
  if (!p->u_knot) return;
  values[0] = p->knot[0];
  values[1] = p->knot[1];
  values[2] = p->between;
  for (PetscInt j = 0; j < 6 * p->share.n_nodes; j++) values[3 + j] = p->u_knot[j];
}

/* Knots that are the same moment, at the start, are one */
PetscErrorCode MortarSetMemory(ContactProjector p, const PetscReal values[])
{
  PetscFunctionBeginUser;
  PetscCall(ProjectorMortarStart(p, values ? values[0] : 0, values ? &values[3] : p->nodes.rest));
  if (!p->u_knot) PetscFunctionReturn(0);
  p->knot[1] = values[1];
  p->between = values[2];
  PetscCall(PetscArraycpy(p->u_knot, &values[3], 6 * p->share.n_nodes));
  for (PetscInt i = 0; i < p->n_interfaces && p->knot[1] > p->knot[0]; i++) {
    if (!MortarTravels(p, i)) continue;
    PetscCall(KnotMake(p, i, 1, p->knot[1], &p->u_knot[3 * p->share.n_nodes]));
    PetscCall(SidesJoin(p->mortar[i]));
  }
  PetscFunctionReturn(0);
}
