/*
   Pairs at the beginning of a step: the facet that each slave faces at the predicted places, the directions n, t, b,
   the compliance W_pp, gap and sliding velocity, the friction coefficient, and a guess of the impulse.

   Where a sliding velocity is given, the displacements are small beside it: the place of the slave on the master is
   that of the undeformed bodies, as in the linear model, moved by the sliding alone, and where the meshes stay it never
   changes. Elsewhere the slave travels with the displacements.

   The guess goes on with the forces of the last steps as a constant, a line or a parabola in time, whichever would have
   guessed the last step best (record.c).
*/
#include "base/algebra/vec3.h"
#include "base/algebra/versions.h"
#include "projectorimpl.h"

void NodesPredict(ContactProjector p, PetscReal dt)
{
  const ProjectorNodes *nodes = &p->nodes;

  for (PetscInt i = 0; i < p->share.n_need; i++)
    for (int d = 0; d < 3; d++) {
      const PetscInt at = 3 * p->share.need[i] + d;

      nodes->predicted[at] = nodes->u[at] + dt * nodes->v[at];
    }
}

/* n, t, b on the ground: turned = e R' = e + e D */
static void PairTurn(const ContactFrame *frame, ProjectorPair *pair)
{
  for (int i = 0; i < 3; i++)
    for (int d = 0; d < 3; d++) {
      pair->turned[i][d] = pair->e[i][d];
      for (int j = 0; j < 3; j++) pair->turned[i][d] += pair->e[i][j] * frame->D[j][d];
    }
}

/* Adds the compliance of the master along axis d, sum_i w_i^2 / M_i */
INTO_VERSIONS PetscReal MasterCompliance(const ProjectorNodes *nodes, const ProjectorPair *pair, int d, PetscReal sum)
{
  for (int k = 0; k < 4; k++) sum += PetscSqr(pair->weight[k]) * nodes->minv[3 * pair->node[k] + d];
  for (int k = 4; k < pair->n; k++) sum += PetscSqr(pair->weight[k]) * nodes->minv[3 * pair->node[k] + d];
  return sum;
}

/* Compliance of the slave along axis d, sum_k v_k^2 / M_k */
INTO_VERSIONS PetscReal SlaveCompliance(const ProjectorNodes *nodes, const ProjectorPair *pair, int d)
{
  PetscReal sum = 0;

  if (pair->n_own == 1) return nodes->minv[3 * pair->slave + d];
  for (int k = 0; k < pair->n_own; k++) sum += PetscSqr(pair->own_weight[k]) * nodes->minv[3 * pair->own[k] + d];
  return sum;
}

/* W_pp = e M_s^-1 e' + e (sum_i w_i^2 M_i^-1) e', 1/kg, the first with the directions turned to the ground. Where
   each node has one mass in all directions (even) that is w I with w = 1/M_s + sum_i w_i^2 / M_i: the cone of such a
   pair is solved by a projection, without a search for the direction of slip (project.c). */
static void PairSetCompliance(const ProjectorNodes *nodes, ProjectorPair *pair)
{
  const PetscReal slave[3] = {SlaveCompliance(nodes, pair, 0), SlaveCompliance(nodes, pair, 1),
                              SlaveCompliance(nodes, pair, 2)};
  PetscBool       even     = pair->n == 4 && pair->n_own == 1 ? nodes->even[pair->slave] : PETSC_FALSE;

  for (int k = 0; k < 4 && even; k++)
    if (pair->weight[k] != 0 && !nodes->even[pair->node[k]]) even = PETSC_FALSE;
  pair->w = even ? MasterCompliance(nodes, pair, 0, slave[0]) : 0;
  if (even) return;
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) {
      pair->W[i][j] = 0;
      for (int d = 0; d < 3; d++)
        pair->W[i][j] += pair->turned[i][d] * slave[d] * pair->turned[j][d] +
                         pair->e[i][d] * MasterCompliance(nodes, pair, d, 0) * pair->e[j][d];
    }
}

/* Sliding velocity along n, t, b in this step, m/s: prescribed, the ramp at the middle of the step as velocities are;
   or that of the frame, the change of the slave's place in it over the step, exact for any turn */
static void PairSetDrift(const ContactProjector p, const ContactStep *step, const PetscReal d_old[3],
                         const PetscReal d_new[3], ProjectorPair *pair)
{
  const ContactSliding *sliding = &p->sliding[pair->interface];

  for (int i = 0; i < 3; i++) pair->drift[i] = 0;
  if (sliding->turning) {
    for (int i = 0; i < 3; i++)
      for (int d = 0; d < 3; d++) pair->drift[i] += pair->e[i][d] * (d_new[d] - d_old[d]) / step->dt;
    return;
  }
  pair->drift[1] = pair->speed * RampValue(&sliding->ramp, step->time + 0.5 * step->dt);
}

/*
   Facet of slave k at displacement d in the frame of the master, the nodes at u: on from the facet where it was, else
   the nearest of the candidates. One that comes to the surface anew is taken up above it, or at most `deepest` sizes of
   a facet below: one that comes from the side deeper than that is left alone until it has come up, since making the gap
   good in one step would throw it out.
*/
static void PairFollow(ContactProjector p, PetscInt k, const PetscReal d[3], const PetscReal u[], PetscReal deepest)
{
  ProjectorPair         *pair  = &p->pair[k];
  const ProjectorMaster *m     = &p->master[pair->interface];
  const ContactShape     shape = {.surface = m->surface, .node = m->node, .u = u, .live = m->live};
  const PetscReal       *X     = &p->nodes.x[3 * pair->slave];
  const PetscReal        x[3]  = {X[0] + d[0], X[1] + d[1], X[2] + d[2]};
  ContactFoot            foot  = {pair->facet, {pair->natural[0], pair->natural[1]}, PETSC_MAX_REAL, 0, 0}, walk;

  if (foot.facet >= 0) {
    ContactFootWalk(&shape, x, &foot);
    deepest = PETSC_MAX_REAL; /* it was above: what is below now has been pressed there */
  }
  if (foot.facet < 0) {
    foot = (ContactFoot){.facet = -1, .distance = PETSC_MAX_REAL};
    for (PetscInt c = p->first_candidate[k]; c < p->first_candidate[k + 1]; c++)
      ContactFootTry(&shape, p->candidates.facet[c], x, deepest, &foot);
    if (foot.facet >= 0 && foot.beyond > ContactEdge(m->surface, &m->surface->facet[foot.facet])) foot.facet = -1;
    walk = foot;
    if (foot.facet >= 0) ContactFootWalk(&shape, x, &walk);
    if (walk.facet >= 0) foot = walk;
  }
  pair->facet = foot.facet;
  for (int i = 0; i < 2; i++) pair->natural[i] = foot.natural[i];
}

/* The gap of the mesh between both sides of a mean, m; differences from the slave node first */
static PetscReal MeanGap(ContactProjector p, const ProjectorPair *pair)
{
  const PetscReal *x   = &p->nodes.x[3 * pair->slave];
  PetscReal        gap = 0;

  for (int j = 0; j < 3; j++) {
    PetscReal along = 0;

    for (int k = 1; k < pair->n_own; k++) along += pair->own_weight[k] * (p->nodes.x[3 * pair->own[k] + j] - x[j]);
    for (int i = 0; i < pair->n; i++) along -= pair->weight[i] * (p->nodes.x[3 * pair->node[i] + j] - x[j]);
    gap += pair->e[0][j] * along;
  }
  return gap;
}

/* The gap of the mesh and n . (d - sum_i w_i u_i), the latter as n . (d - u_0 - sum_{i>0} w_i (u_i - u_0)): a common
   motion of both bodies, of metres perhaps, cancels before it is multiplied */
PetscReal PairGap(ContactProjector p, const ProjectorPair *pair, const PetscReal d[3], const PetscReal u[])
{
  const ContactFacet *f = &p->master[pair->interface].surface->facet[pair->facet];
  const PetscReal    *w = pair->weight, *u0 = &u[3 * pair->node[0]];
  PetscReal           gap =
    p->mortar[pair->interface] ? MeanGap(p, pair) : ContactGap(f, w, pair->e[0], &p->nodes.x[3 * pair->slave]);

  for (int j = 0; j < 3; j++) {
    PetscReal along = d[j] - u0[j];

    for (int i = 1; i < 4; i++) along -= w[i] * (u[3 * pair->node[i] + j] - u0[j]);
    for (int i = 4; i < pair->n; i++) along -= w[i] * (u[3 * pair->node[i] + j] - u0[j]);
    gap += pair->e[0][j] * along;
  }
  return gap;
}

/* Means of both sides at displacements `where`; a pair that comes anew is taken as in PairFollow() */
static void PairMean(ContactProjector p, PetscInt k, const PetscReal u[], const PetscReal where[], PetscReal deepest)
{
  ProjectorPair   *pair = &p->pair[k];
  const PetscBool  anew = pair->facet < 0 && deepest < PETSC_MAX_REAL ? PETSC_TRUE : PETSC_FALSE;
  PetscReal        mean_x[3], mean_u[3], d[3];
  const PetscReal *x;

  MeanFind(p, k, where);
  if (!anew || pair->facet < 0) return;
  x = PairSlave(pair, p->nodes.x, mean_x);
  FrameDisplacement(&p->frame[pair->interface], x, PairSlave(pair, u, mean_u), d);
  if (-PairGap(p, pair, d, u) > deepest * p->master[pair->interface].surface->size) pair->facet = -1;
}

/* Facet that a slave faces at predicted displacements; one that faced none must have come to one at u already */
static void PairFind(ContactProjector p, PetscInt k, const PetscReal u[], const PetscReal predicted[],
                     PetscReal deepest)
{
  ProjectorPair      *pair  = &p->pair[k];
  const ContactFrame *frame = &p->frame[pair->interface];
  const PetscReal    *x     = &p->nodes.x[3 * pair->slave];
  PetscReal           d[3];

  if (pair->facet < 0) {
    FrameDisplacement(frame, x, &u[3 * pair->slave], d);
    PairFollow(p, k, d, u, deepest);
    if (pair->facet < 0) return;
  }
  FrameDisplacement(frame, x, &predicted[3 * pair->slave], d);
  PairFollow(p, k, d, predicted, deepest);
}

/* Whether friction needs the direction of a sliding that is given */
static PetscBool PairNeedsSlip(ContactProjector p, const ProjectorPair *pair)
{
  const FrictionLaw *law = &p->contact->interfaces[pair->interface].friction;

  return p->sliding[pair->interface].slides && (FrictionExists(law) || FrictionVaries(law)) ? PETSC_TRUE : PETSC_FALSE;
}

/* Nodes, weights and n, t, b at the foot of a slave that slides along a vector */
static PetscReal PairFoot(ContactProjector p, ProjectorPair *pair, const PetscReal along[3])
{
  const ProjectorMaster *master = &p->master[pair->interface];
  const ContactFacet    *facet  = &master->surface->facet[pair->facet];

  pair->n = PetscMax(facet->n, 4);
  for (int i = 0; i < pair->n; i++) pair->node[i] = master->node[facet->node[i < facet->n ? i : 0]];
  pair->weight[3] = 0;
  return ContactBasis(facet, pair->natural, along, pair->weight, pair->e);
}

/* A pair at its place for Gauss-Seidel, Cartesian; mass 0 where the directions are coupled */
static void PairPlaceRow(const ContactProjector p, const ProjectorPair *pair, ProjectorRow *row)
{
  const PetscReal *minv = p->nodes.minv;

  *row = (ProjectorRow){.mass = pair->w > 0 ? 1 / pair->w : 0};
  if (p->sliding[pair->interface].turning) row->D = &p->frame[pair->interface].D[0][0];
  for (int i = 0; i < 4; i++) {
    row->node[i]   = (int)pair->node[i];
    row->weight[i] = pair->weight[i];
    row->push[i]   = pair->weight[i] * minv[3 * pair->node[i]];
  }
  row->node[4] = (int)pair->slave;
  row->push[4] = minv[3 * pair->slave];
  for (int d = 0; d < 3; d++) row->n[d] = pair->e[0][d];
}

/* PETSC_FALSE: no facet in reach. A triangle gets its first node as a fourth one with weight 0, so that sums over
   nodes need no branch. */
PetscBool PairPlace(ContactProjector p, PetscInt k, const PetscReal u[], const PetscReal predicted[], PetscReal deepest)
{
  ProjectorPair        *pair    = &p->pair[k];
  const ContactSliding *sliding = &p->sliding[pair->interface];
  const ContactFrame   *frame   = &p->frame[pair->interface];
  const PetscReal      *x = &p->nodes.x[3 * pair->slave], *where = sliding->slides ? p->nodes.rest : predicted;
  PetscReal             place[3], along[3];

  for (int i = 0; i < 3; i++) pair->p[i] = pair->q[i] = 0;
  pair->status = CONTACT_OPEN;
  if (p->mortar[pair->interface])
    PairMean(p, k, u, where, deepest);
  else if (!pair->found)
    PairFind(p, k, sliding->slides ? p->nodes.rest : u, where, deepest);
  pair->found = SlidingStays(sliding);
  if (pair->facet < 0) {
    pair->slip = -1;
    return PETSC_FALSE;
  }
  if (pair->found && pair->ready) return PETSC_TRUE;
  FrameDisplacement(frame, x, &where[3 * pair->slave], place);
  for (int i = 0; i < 3; i++) place[i] += x[i];
  ContactSlideAlong(&p->contact->interfaces[pair->interface], place, along);
  pair->speed   = p->mortar[pair->interface] ? ContactTangents(along, pair->e) : PairFoot(p, pair, along);
  pair->no_slip = pair->speed == 0 && PairNeedsSlip(p, pair) ? PETSC_TRUE : PETSC_FALSE;
  if (!sliding->rotates) {
    const PetscReal part = sliding->turning ? pair->speed / Vec3Length(along) : 1;

    pair->speed = sliding->slides ? part * sliding->speed : 0;
  }
  PairTurn(frame, pair);
  PairSetCompliance(&p->nodes, pair);
  PairPlaceRow(p, pair, &p->row[k]);
  if (pair->found) pair->gap = PairGap(p, pair, p->nodes.rest, p->nodes.rest);
  pair->ready = PETSC_TRUE;
  return PETSC_TRUE;
}

/* What changes from step to step of a pair as Gauss-Seidel sees it */
INTO_VERSIONS void PairSetRow(const ProjectorPair *pair, const PetscReal impulse[3], ProjectorRow *row)
{
  row->mu = pair->mu;
  for (int d = 0; d < 3; d++) {
    row->p[d]      = impulse[d];
    row->offset[d] = 0;
    for (int i = 0; i < 3; i++) row->offset[d] += pair->e[i][d] * pair->offset[i];
  }
}

/* Guess of the impulse in the frame of the master, N s: none where it would pull */
INTO_VERSIONS void PairGuess(const ProjectorPair *pair, PetscInt order, PetscReal kick, PetscReal impulse[3])
{
  static const PetscReal factor[PROJECTOR_PAST][PROJECTOR_PAST] = {{1, 0, 0}, {2, -1, 0}, {3, -3, 1}};
  PetscReal              normal                                 = 0;

  for (int d = 0; d < 3; d++) {
    impulse[d] = 0;
    for (PetscInt i = 0; i <= order; i++) impulse[d] += kick * factor[order][i] * pair->lambda[i][d];
    normal += impulse[d] * pair->e[0][d];
  }
  for (int d = 0; d < 3 && normal <= 0; d++) impulse[d] = 0;
}

/* n . (u_s - sum w_i u_i) of displacements in a frame that stands still, m */
INTO_VERSIONS PetscReal NormalDisplacement(const ProjectorPair *pair, const PetscReal u[])
{
  PetscReal sum = 0;

  const PetscReal *slave;
  PetscReal        mean[3];

  slave = PairSlave(pair, u, mean);
  for (int d = 0; d < 3; d++) {
    PetscReal master = 0;

    for (int i = 0; i < 4; i++) master += pair->weight[i] * u[3 * pair->node[i] + d];
    sum += pair->e[0][d] * (slave[d] - master);
  }
  for (int k = 12; k < 3 * pair->n; k++)
    sum -= pair->e[0][k % 3] * pair->weight[k / 3] * u[3 * pair->node[k / 3] + k % 3];
  return sum;
}

/* One pair, k, at the beginning of a step */
INTO_VERSIONS void PairPrepare(ContactProjector p, PetscInt k, const ContactStep *step)
{
  ProjectorPair   *pair = &p->pair[k];
  const PetscReal *x, *u;
  PetscReal        before[3], after[3], impulse[3], mean_x[3], mean_u[3];

  if (!PairPlace(p, k, p->nodes.u, p->nodes.predicted, PROJECTOR_DEEPEST)) return;
  x = PairSlave(pair, p->nodes.x, mean_x);
  u = PairSlave(pair, p->nodes.u, mean_u);
  if (pair->found) {
    PairSetDrift(p, step, u, u, pair);
    pair->offset[0] = (pair->gap + NormalDisplacement(pair, p->nodes.u)) / step->dt;
  } else {
    FrameDisplacement(&p->frame_old[pair->interface], x, u, before);
    FrameDisplacement(&p->frame[pair->interface], x, u, after);
    PairSetDrift(p, step, before, after, pair);
    pair->offset[0] = PairGap(p, pair, after, p->nodes.u) / step->dt;
  }
  PairSetFriction(p, step->time, pair);
  pair->offset[1] = pair->drift[1];
  pair->offset[2] = pair->drift[2];
  PairGuess(pair, p->order, step->kick, impulse);
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) pair->p[i] += pair->e[i][j] * impulse[j];
  PairSetRow(pair, impulse, &p->row[k]);
}

static VERSIONS void PairsPrepareAll(ContactProjector p, const ContactStep *step)
{
  p->beyond[0] = -1;
  for (PetscInt k = 0; k < p->n_pairs; k++) PairPrepare(p, k, step);
}

PetscErrorCode PairsPrepare(ContactProjector p, const ContactStep *step)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < p->n_interfaces; i++) {
    const ContactInterface *c = &p->contact->interfaces[i];

    SlidingFrame(c, &p->sliding[i], step->time, &p->frame_old[i]);
    SlidingFrame(c, &p->sliding[i], step->time + step->dt, &p->frame[i]);
  }
  NodesPredict(p, step->dt);
  if (p->search_next) PetscCall(ProjectorSearch(p, step->time + step->dt, 1, p->nodes.predicted));
  PetscCall(ProjectorMortarStep(p, step));
  PairsPrepareAll(p, step);
  PetscFunctionReturn(0);
}
