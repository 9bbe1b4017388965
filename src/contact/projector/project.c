/*
   Contact forces of a step: block Gauss-Seidel over the pairs on W = G M^-1 G', without forming W. Velocities of the
   nodes are kept up to date; at a pair, with q the relative velocity that they give and p its impulse now,
      q* = q - W_pp p,   p' = the solution of the pair alone with all others as they are (kernels/contact/cone.h),
      v_s += M_s^-1 (p' - p),   v_i -= w_i M_i^-1 (p' - p)
   The normal velocity contains gap / dt, hence q_n dt is the gap at t_{n+1}; the tangential one the sliding velocity.
   It begins with a guess from the forces of the steps before. Pairs that are open and that the motion without contact
   leaves open are not visited; when the others have converged, all are looked at, and those that need force join.
   Bodies that touch and move together without force leave impulses that are rounding: the tolerance is never below
   that. Where pairs of other ranks move the same nodes, each sweep is one over the pairs of all of them (border.c).
*/
#include "base/algebra/versions.h"
#include "projectorimpl.h"
#include "rows.h"

/* roundings of a relative velocity, by its terms: five products and sums in three directions, and what the velocities
   carry of the sweeps before */
#define NOISE 16

void PairVelocity(const ProjectorPair *pair, const PetscReal v[], PetscReal q[3])
{
  PetscReal        mean[3];
  const PetscReal *slave = PairSlave(pair, v, mean), *w = pair->weight;
  const PetscReal *a = &v[3 * pair->node[0]], *b = &v[3 * pair->node[1]], *c = &v[3 * pair->node[2]],
                  *d = &v[3 * pair->node[3]];
  PetscReal master[3];

  for (int i = 0; i < 3; i++) master[i] = w[0] * a[i] + w[1] * b[i] + w[2] * c[i] + w[3] * d[i];
  for (int k = 4; k < pair->n; k++)
    for (int i = 0; i < 3; i++) master[i] += w[k] * v[3 * pair->node[k] + i];
  for (int i = 0; i < 3; i++) {
    const PetscReal *s = pair->turned[i], *e = pair->e[i];

    q[i] = (s[0] * slave[0] - e[0] * master[0]) + (s[1] * slave[1] - e[1] * master[1]) +
           (s[2] * slave[2] - e[2] * master[2]);
  }
}

/* With the offset: gap at t_{n+1} / dt, and slip velocity */
static void PairSlip(const ProjectorPair *pair, const PetscReal v[], PetscReal q[3])
{
  PairVelocity(pair, v, q);
  for (int i = 0; i < 3; i++) q[i] += pair->offset[i];
}

/* Velocities of the nodes after an impulse p (N s) along n, t, b: on the slave p, on the master's nodes -w_i p; minv
   = 0 of directions that are held keeps these still */
static void PairPush(const ProjectorPair *pair, const PetscReal p[3], const PetscReal minv[], PetscReal v[])
{
  PetscReal slave[3], master[3];

  for (int d = 0; d < 3; d++) {
    slave[d]  = pair->turned[0][d] * p[0] + pair->turned[1][d] * p[1] + pair->turned[2][d] * p[2];
    master[d] = pair->e[0][d] * p[0] + pair->e[1][d] * p[1] + pair->e[2][d] * p[2];
  }
  for (int k = 0; k < pair->n_own; k++)
    for (int d = 0; d < 3; d++) v[3 * pair->own[k] + d] += pair->own_weight[k] * minv[3 * pair->own[k] + d] * slave[d];
  for (int k = 0; k < pair->n; k++)
    for (int d = 0; d < 3; d++) v[3 * pair->node[k] + d] -= pair->weight[k] * minv[3 * pair->node[k] + d] * master[d];
}

/* Solves one pair; returns the square of what its impulse has changed by, N^2 s^2. W may couple the directions
   (masses that differ by direction, or more than four nodes): ConeSolve() finds the direction of slip. */
static PetscReal PairSolve(ProjectorPair *pair, const PetscReal minv[], PetscReal v[])
{
  PetscReal q[3], p[3], change = 0;

  PairSlip(pair, v, q);
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) q[i] -= pair->W[i][j] * pair->p[j];
  pair->status = ConeSolve((const double(*)[3])pair->W, q, pair->mu, p);
  for (int i = 0; i < 3; i++) {
    const PetscReal after = p[i];

    p[i] -= pair->p[i];
    pair->p[i] = after;
    change += p[i] * p[i];
  }
  if (change > 0) PairPush(pair, p, minv, v);
  return change;
}

PetscReal PairMass(const ProjectorPair *pair)
{
  if (pair->w > 0) return 1 / pair->w;
  return pair->W[0][0] > 0 ? 1 / (pair->W[0][0] + pair->W[1][1] + pair->W[2][2]) : 0;
}

/* Velocity of the slave relative to the master along its normal, offset included */
INTO_VERSIONS PetscReal NormalVelocity(const ContactProjector p, PetscInt k)
{
  const ProjectorRow *row = &p->row[k];
  PetscReal           q[3];

  if (row->mass > 0) {
    RowVelocity(row, p->nodes.v, q);
    return q[0] * row->n[0] + q[1] * row->n[1] + q[2] * row->n[2];
  }
  PairSlip(&p->pair[k], p->nodes.v, q);
  return q[0];
}

/* Rounding of the relative velocity of a pair as an impulse, N s: NOISE eps mass times the sum of the terms' sizes
   (m/s) */
INTO_VERSIONS PetscReal PairNoise(ContactProjector p, PetscInt k)
{
  const ProjectorPair *pair = &p->pair[k];
  const ProjectorRow  *row  = &p->row[k];
  PetscReal            sum  = 0;

  if (row->mass > 0) return NOISE * PETSC_MACHINE_EPSILON * row->mass * RowSize(row, p->nodes.v);
  for (int d = 0; d < 3; d++) {
    sum += PetscAbsReal(p->nodes.v[3 * pair->slave + d]) + PetscAbsReal(pair->offset[d]);
    for (int i = 1; i < pair->n_own; i++) sum += PetscAbsReal(pair->own_weight[i] * p->nodes.v[3 * pair->own[i] + d]);
    for (int i = 0; i < 4; i++) sum += PetscAbsReal(pair->weight[i] * p->nodes.v[3 * pair->node[i] + d]);
  }
  for (int k = 12; k < 3 * pair->n; k++)
    sum += PetscAbsReal(pair->weight[k / 3] * p->nodes.v[3 * pair->node[k / 3] + k % 3]);
  return NOISE * PETSC_MACHINE_EPSILON * PairMass(pair) * sum;
}

/* Whether a pair moves a node that pairs of other ranks move too */
static PetscBool PairIsAtBorder(const ProjectorPair *pair, const PetscBool shared[])
{
  for (int k = 0; k < pair->n_own; k++)
    if (shared[pair->own[k]]) return PETSC_TRUE;
  for (int k = 0; k < pair->n; k++)
    if (shared[pair->node[k]] && PetscAbsReal(pair->weight[k]) > BORDER_WEIGHT) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* Finds the pairs that have a guess or that the motion closes, which are to be visited; scale: the largest guess,
   noise: of any pair, N s. All pairs are looked at before any guess acts, so that which ones are visited does not
   depend on their order. */
static VERSIONS PetscInt PairsLook(ContactProjector p, PetscReal *scale, PetscReal *noise)
{
  PetscInt n = 0;

  *scale = *noise = 0;
  for (PetscInt k = 0; k < p->n_pairs; k++) {
    const ProjectorPair *pair = &p->pair[k];

    p->visited[k] = PETSC_FALSE;
    if (pair->facet < 0) continue;
    *scale        = PetscMax(*scale, PetscAbsReal(pair->p[0]));
    *noise        = PetscMax(*noise, PairNoise(p, k));
    p->visited[k] = pair->p[0] > 0 || NormalVelocity(p, k) < 0 ? PETSC_TRUE : PETSC_FALSE;
    if (p->visited[k]) p->visit[n++] = k;
    if (p->border.n) p->at_border[k] = PairIsAtBorder(pair, p->border.shared);
  }
  return n;
}

/* Which of the visited pairs: all, those at shared nodes, the others */
typedef enum { PASS_ALL, PASS_BORDER, PASS_INSIDE } Pass;

static inline PetscBool PassTakes(const ContactProjector p, Pass pass, PetscInt k)
{
  return pass == PASS_ALL || p->at_border[k] == (pass == PASS_BORDER) ? PETSC_TRUE : PETSC_FALSE;
}

/* The guesses act */
static VERSIONS void PairsPush(ContactProjector p, PetscInt n, Pass pass)
{
  for (PetscInt i = 0; i < n; i++) {
    const PetscInt k = p->visit[i];

    if (!PassTakes(p, pass, k)) continue;
    if (p->row[k].mass > 0)
      RowPush(&p->row[k], p->row[k].p, p->nodes.v);
    else
      PairPush(&p->pair[k], p->pair[k].p, p->nodes.minv, p->nodes.v);
  }
}

/* A vector along n, t, b */
INTO_VERSIONS void PairTurnIn(const ProjectorPair *pair, const PetscReal x[3], PetscReal y[3])
{
  for (int i = 0; i < 3; i++) y[i] = pair->e[i][0] * x[0] + pair->e[i][1] * x[1] + pair->e[i][2] * x[2];
}

/* Residual of one pair, N s; its velocity and impulse along n, t, b */
INTO_VERSIONS PetscReal PairMiss(ContactProjector p, PetscInt k)
{
  ProjectorPair      *pair = &p->pair[k];
  const ProjectorRow *row  = &p->row[k];
  PetscReal           q[3], z[3], change[3];

  if (row->mass == 0) {
    PairSlip(pair, p->nodes.v, pair->q);
    return ConeResidual(PairMass(pair), pair->q, pair->mu, pair->p);
  }
  RowVelocity(row, p->nodes.v, q);
  (void)RowChange(row, q, z, change);
  PairTurnIn(pair, q, pair->q);
  PairTurnIn(pair, row->p, pair->p);
  pair->status = row->status;
  return PetscSqrtReal(change[0] * change[0] + change[1] * change[1] + change[2] * change[2]);
}

/* Slip velocities and largest residual (N s) of all pairs; pairs that need force (their gap would be negative) join
   the visited ones. nan is kept once it is there: the comparison with it is never true. */
static VERSIONS PetscReal PairsCheck(ContactProjector p, PetscInt *n, PetscInt *worst)
{
  PetscReal largest = 0;

  for (PetscInt k = 0; k < p->n_pairs; k++) {
    const ProjectorPair *pair = &p->pair[k];
    PetscReal            residual;

    if (pair->facet < 0) continue;
    residual = PairMiss(p, k);
    if (!p->visited[k]) {
      if (pair->q[0] >= 0 || PairMass(pair) == 0) continue;
      p->visited[k]    = PETSC_TRUE;
      p->visit[(*n)++] = k;
    }
    if (residual <= largest || PetscIsNanReal(largest)) continue;
    largest = residual;
    *worst  = k;
  }
  return largest;
}

/* Visits pair k; its impulse changes by `change`, at most, and the largest normal one is `scale` at least */
INTO_VERSIONS void PairVisit(ContactProjector p, PetscInt k, PetscReal *change, PetscReal *scale)
{
  ProjectorRow *row = &p->row[k];
  PetscReal     square, normal;

  if (row->mass > 0) {
    square = RowSolve(row, p->nodes.v);
    normal = row->p[0] * row->n[0] + row->p[1] * row->n[1] + row->p[2] * row->n[2];
  } else {
    square = PairSolve(&p->pair[k], p->nodes.minv, p->nodes.v);
    normal = p->pair[k].p[0];
  }
  *change = square > *change ? square : *change;
  *scale  = normal > *scale ? normal : *scale;
}

/* One sweep: the squared change of an impulse, at most, and the largest of them, if above scale */
static VERSIONS void PairsVisit(ContactProjector p, PetscInt n, Pass pass, PetscReal *change, PetscReal *scale)
{
  for (PetscInt i = 0; i < n; i++)
    if (PassTakes(p, pass, p->visit[i])) PairVisit(p, p->visit[i], change, scale);
}

/* The guesses act, or where size is given, [2] of PairsVisit(), a sweep; in turn with the neighbours. */
static PetscErrorCode PairsPass(ContactProjector p, PetscInt n, PetscReal size[2])
{
  PetscFunctionBeginUser;
  for (int inside = 0; inside < 2; inside++) {
    const Pass pass = !p->border.n ? PASS_ALL : inside ? PASS_INSIDE : PASS_BORDER;

    if (p->border.n && !inside) PetscCall(BorderBegin(p));
    if (size)
      PairsVisit(p, n, pass, &size[0], &size[1]);
    else
      PairsPush(p, n, pass);
    if (!p->border.n) PetscFunctionReturn(0);
    if (!inside) PetscCall(BorderSend(p));
  }
  PetscCall(BorderEnd(p));
  if (size) PetscCall(BorderLargest(p, 2, size));
  PetscFunctionReturn(0);
}

/* Whether a sweep whose change (squared) comes after `last`, or after none, 0, is the last one: the next would change
   impulses by less than the tolerance, going by how fast changes decrease, in the step before where this one has not
   shown it yet. Where the order of pairs depends on the ranks, sweeps go on until changes are rounding: those of one
   term, or no longer decreasing. */
static PetscBool SweepIsLast(const ContactProjector p, const ProjectorConvergence *c, PetscReal last, PetscReal scale)
{
  const PetscReal next = c->change * p->rate;

  if (next > PetscSqr(0.5 * (ProjectorTolerance(p) * scale + c->noise))) return PETSC_FALSE;
  if (!p->fine || next <= PetscSqr(0.5 * c->noise / NOISE)) return PETSC_TRUE;
  return last > 0 && c->change > 0.25 * last ? PETSC_TRUE : PETSC_FALSE;
}

/* Sweeps until the last one or max_it are done; scale is the largest impulse, of the step before or now */
static PetscErrorCode PairsSweep(ContactProjector p, PetscInt n, PetscReal before, PetscReal *scale,
                                 ProjectorConvergence *c)
{
  PetscFunctionBeginUser;
  while (c->sweeps < p->max_it) {
    const PetscReal last    = c->change;
    PetscReal       size[2] = {0, before};

    PetscCall(PairsPass(p, n, size));
    c->change = size[0];
    *scale    = size[1];
    c->sweeps++;
    if (last > 0) p->rate = PetscMin(1, c->change / last);
    if (SweepIsLast(p, c, last, *scale)) break;
  }
  PetscFunctionReturn(0);
}

/* Converged where the residual of all pairs is at most the tolerance times the largest impulse plus noise. Sweeps
   alone do not tell that: each sees a pair before the later ones have moved its nodes. The loop ends, since sweeps
   only grow; without any pair to visit PairsCheck() finds residuals of 0 or adds one. All ranks that hang together
   go through it alike. */
PetscErrorCode PairsSolve(ContactProjector p, ProjectorConvergence *c)
{
  const PetscReal rtol    = ProjectorTolerance(p);
  PetscReal       most[4] = {0}, scale, residual; /* largest impulse before, noise, pairs to be visited, rate */
  PetscInt        n;

  PetscFunctionBeginUser;
  *c      = (ProjectorConvergence){.worst = -1};
  n       = PairsLook(p, &most[0], &most[1]);
  most[2] = (PetscReal)n;
  most[3] = p->rate;
  PetscCall(BorderLargest(p, 4, most));
  p->rate = most[3]; /* that of ranks which come together in this step differs */
  PetscCall(PairsPass(p, n, NULL));
  c->noise = most[1];
  scale    = most[0];
  do {
    PetscReal all[2];

    if (most[2] > 0) PetscCall(PairsSweep(p, n, most[0], &scale, c));
    all[0] = c->own = PairsCheck(p, &n, &c->worst);
    all[1]          = (PetscReal)n;
    PetscCall(BorderLargest(p, 2, all));
    residual = all[0];
    most[2]  = all[1];
    c->checks++;
    c->residual = residual == 0 ? 0 : residual / (scale + c->noise / rtol);
    c->own      = c->own == 0 ? 0 : c->own / (scale + c->noise / rtol);
    /* not where it is no number */
    c->converged = residual <= rtol * scale + c->noise ? PETSC_TRUE : PETSC_FALSE;
  } while (!c->converged && c->sweeps < p->max_it && !PetscIsInfOrNanReal(residual));
  PetscFunctionReturn(0);
}
