/*
   Contact forces of a step: block Gauss-Seidel over the pairs on W = G M^-1 G', without forming W. Velocities of the
   nodes are kept up to date; at a pair, with q the relative velocity that they give and p its impulse now,
      q* = q - W_pp p,   p' = the solution of the pair alone with all others as they are (kernels/contact/cone.h),
      v_s += M_s^-1 (p' - p),   v_i -= w_i M_i^-1 (p' - p)
   The normal velocity contains gap / dt, hence q_n dt is the gap at t_{n+1}; the tangential one the sliding velocity.
   It begins with a guess from the forces of the steps before. Pairs that are open and that the motion without contact
   leaves open are not visited; when the others have converged, all are looked at, and those that need force join.
   Bodies that touch and move together without force leave impulses that are rounding: the tolerance is never below
   that.
*/
#include "base/algebra/versions.h"
#include "projectorimpl.h"

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

/*
   The same for a pair whose directions are not coupled: Cartesian, without turning to n, t, b and back. With the
   relative velocity q, offset included, the impulse that solves the pair alone is the projection of z = p - q / w on
   the cone.
*/
INTO_VERSIONS void RowVelocity(const ProjectorRow *row, const PetscReal v[], PetscReal q[3])
{
  const PetscReal *a = &v[3 * row->node[0]], *b = &v[3 * row->node[1]], *c = &v[3 * row->node[2]],
                  *d = &v[3 * row->node[3]], *s = &v[3 * row->node[4]], *w = row->weight, *D = row->D;

  for (int i = 0; i < 3; i++)
    q[i] = (s[i] - ((w[0] * a[i] + w[1] * b[i]) + (w[2] * c[i] + w[3] * d[i]))) + row->offset[i];
  if (!D) return;
  for (int i = 0; i < 3; i++) q[i] += D[3 * i] * s[0] + D[3 * i + 1] * s[1] + D[3 * i + 2] * s[2];
}

/* Velocities of the nodes after an impulse */
INTO_VERSIONS void RowPush(const ProjectorRow *row, const PetscReal p[3], PetscReal v[])
{
  PetscReal *a = &v[3 * row->node[0]], *b = &v[3 * row->node[1]], *c = &v[3 * row->node[2]], *d = &v[3 * row->node[3]];
  PetscReal *s       = &v[3 * row->node[4]];
  const PetscReal *h = row->push, *D = row->D;

  for (int i = 0; i < 3; i++) {
    s[i] += h[4] * p[i];
    a[i] -= h[0] * p[i];
    b[i] -= h[1] * p[i];
    c[i] -= h[2] * p[i];
    d[i] -= h[3] * p[i];
  }
  if (!D) return;
  for (int i = 0; i < 3; i++) s[i] += h[4] * (D[i] * p[0] + D[3 + i] * p[1] + D[6 + i] * p[2]);
}

/* Projects z on the cone |z_T| <= mu z_n: along the tangent plane, not the nearest point. z_n stays, since Coulomb's
   law is not associated; a z that pulls becomes 0 */
INTO_VERSIONS ContactStatus RowProject(const ProjectorRow *row, PetscReal z[3])
{
  const PetscReal normal = row->n[0] * z[0] + row->n[1] * z[1] + row->n[2] * z[2], cone = row->mu * normal;
  PetscReal       square = 0, factor;

  if (!(normal > 0)) {
    z[0] = z[1] = z[2] = 0;
    return CONTACT_OPEN;
  }
  for (int i = 0; i < 3; i++) {
    z[i] -= normal * row->n[i];
    square += z[i] * z[i];
  }
  factor = FrictionShorten(square, cone);
  for (int i = 0; i < 3; i++) z[i] = normal * row->n[i] + factor * z[i];
  return row->mu > 0 && factor == 1 ? CONTACT_STICK : CONTACT_SLIP;
}

/* What the impulse would have to change by, the residual of the natural map, N s; z is the impulse then */
INTO_VERSIONS ContactStatus RowChange(const ProjectorRow *row, const PetscReal q[3], PetscReal z[3],
                                      PetscReal change[3])
{
  ContactStatus status;

  for (int i = 0; i < 3; i++) z[i] = row->p[i] - row->mass * q[i];
  status = RowProject(row, z);
  for (int i = 0; i < 3; i++) change[i] = z[i] - row->p[i];
  return status;
}

/* Returns the square of the change */
INTO_VERSIONS PetscReal RowSolve(ProjectorRow *row, PetscReal v[])
{
  PetscReal q[3], z[3], change[3];

  RowVelocity(row, v, q);
  row->status = RowChange(row, q, z, change);
  for (int i = 0; i < 3; i++) row->p[i] = z[i];
  RowPush(row, change, v);
  return change[0] * change[0] + change[1] * change[1] + change[2] * change[2];
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

/* Sum of the sizes of the terms of a relative velocity, m/s */
INTO_VERSIONS PetscReal RowSize(const ProjectorRow *row, const PetscReal v[])
{
  const PetscReal *a = &v[3 * row->node[0]], *b = &v[3 * row->node[1]], *c = &v[3 * row->node[2]],
                  *d = &v[3 * row->node[3]], *s = &v[3 * row->node[4]], *w = row->weight;
  PetscReal sum = 0;

  for (int i = 0; i < 3; i++)
    sum +=
      (PetscAbsReal(s[i]) + PetscAbsReal(row->offset[i])) + ((PetscAbsReal(w[0] * a[i]) + PetscAbsReal(w[1] * b[i])) +
                                                             (PetscAbsReal(w[2] * c[i]) + PetscAbsReal(w[3] * d[i])));
  return sum;
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

/* The guesses act; the pairs that have one, or that the motion closes, are to be visited. All pairs are looked at
   before any guess acts, so that which ones are visited does not depend on their order. scale: the largest guess,
   noise: of any pair, N s. */
static VERSIONS PetscInt PairsBegin(ContactProjector p, PetscReal *scale, PetscReal *noise)
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
  }
  for (PetscInt i = 0; i < n; i++) {
    const PetscInt k = p->visit[i];

    if (p->row[k].mass > 0)
      RowPush(&p->row[k], p->row[k].p, p->nodes.v);
    else
      PairPush(&p->pair[k], p->pair[k].p, p->nodes.minv, p->nodes.v);
  }
  return n;
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

/* Sweeps until the next one would change impulses by less than the tolerance, going by how fast the changes (squared)
   decrease, in the step before where this one has not shown it yet, or max_it are done; scale is the largest impulse,
   of the step before or now */
static VERSIONS void PairsSweep(ContactProjector p, PetscInt n, PetscReal before, PetscReal *scale,
                                ProjectorConvergence *c)
{
  while (c->sweeps < p->max_it) {
    const PetscReal last = c->change;

    c->change = 0;
    *scale    = before;
    for (PetscInt i = 0; i < n; i++) PairVisit(p, p->visit[i], &c->change, scale);
    c->sweeps++;
    if (last > 0) p->rate = PetscMin(1, c->change / last);
    if (!(c->change * p->rate > PetscSqr(0.5 * (PROJECTOR_RTOL * *scale + c->noise)))) break;
  }
}

/* Converged where the residual of all pairs is at most PROJECTOR_RTOL times the largest impulse plus noise. Sweeps
   alone do not tell that: each sees a pair before the later ones have moved its nodes. The loop ends, since sweeps
   only grow; without any pair to visit PairsCheck() finds residuals of 0 or adds one. */
void PairsSolve(ContactProjector p, ProjectorConvergence *c)
{
  PetscReal before, scale, residual;
  PetscInt  n;

  *c    = (ProjectorConvergence){.worst = -1};
  n     = PairsBegin(p, &before, &c->noise);
  scale = before;
  do {
    if (n > 0) PairsSweep(p, n, before, &scale, c);
    residual = PairsCheck(p, &n, &c->worst);
    c->checks++;
    c->residual = residual == 0 ? 0 : residual / (scale + c->noise / PROJECTOR_RTOL);
    /* not where it is no number */
    c->converged = residual <= PROJECTOR_RTOL * scale + c->noise ? PETSC_TRUE : PETSC_FALSE;
  } while (!c->converged && c->sweeps < p->max_it && !PetscIsNanReal(residual));
}
