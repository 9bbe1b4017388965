/*
   The laws of all pairs at forces l (divided by the stiffness of their pair, m) and motions v = free + W kappa l
   (kernels/contact/coulomb.h, with w = -v); (1 - t) W kappa + t I stands for W kappa on the way of path.c.

   Residual of a pair, m: the root of the squares of

      l_n - max(0, l_n - v_n)   and   p - Proj(p + d)  on the disc of radius mu l_n,   p = -l_T, d = v_T

   It is 0 where the laws hold and there alone, continuous, and needs no status.
*/
#include "complianceimpl.h"

#define MOTION_NOISE 4 /* roundings of v by its terms */
/* rows from which a product reads half of W, where more than this part of its columns has forces: with 725 it takes
   0.67 of the time of all columns, with 1452 and 3072 0.6, with 363 as much */
#define MOTION_LARGE 600
#define MOTION_MOST  0.7

/* mu of the slip speed |v_T| / dt (m/s) at the present v, and how it falls per length of w: d mu / d|w_T| = mu'(s) /
   (dt weight), 1/m, since |w_T| = weight |v_T|; of the pressure at the present l. A pair that is held has mu(0). k
   infinite: the pair has no compliance of its own, it is in W. */
CoulombPair ComplianceGetPair(const ContactCompliance c, PetscInt p, PetscReal weight, PetscReal w[3])
{
  FrictionLaw law;
  PetscReal   slip = 0;
  CoulombPair pair = {.d = 3, .mu = c->mu[p], .k = INFINITY};

  for (PetscInt i = 0; i < 3; i++) w[i] = -weight * c->v[3 * p + i];
  if (!c->varies[p]) return pair;
  law = FrictionPressed(&c->friction[p], c->kappa[p] * c->l[3 * p]);
  if (c->hold[p] != HOLD_RESTS) slip = hypot(c->v[3 * p + 1], c->v[3 * p + 2]) / c->dt;
  pair.mu   = FrictionMu(&law, slip);
  pair.rise = FrictionRise(&law, slip);
  if (c->hold[p] != HOLD_RESTS) pair.fall = pair.mu > 0 ? FrictionSlope(&law, slip) / (c->dt * weight) : 0;
  return pair;
}

/* Columns of pairs without force are left out, most of them when few are closed. Where most carry and W is larger than
   the cache of a core, half of it is read instead. */
void ComplianceAddMotion(ContactCompliance c, PetscReal y[])
{
  const PetscInt N = 3 * c->n;
  PetscInt       n = 0;

  for (PetscInt i = 0; i < N; i++) n += c->l[i] != 0;
  if (N >= MOTION_LARGE && (PetscReal)n > MOTION_MOST * (PetscReal)N) {
    for (PetscInt i = 0; i < N; i++) c->force[i] = (1 - c->blend) * c->kappa[i / 3] * c->l[i];
    ComplianceAddSymmetric(N, c->W, c->force, y);
    return;
  }
  n = 0;
  for (PetscInt i = 0; i < N; i++) {
    const PetscReal force = (1 - c->blend) * c->kappa[i / 3] * c->l[i];

    if (force == 0) continue;
    c->force[n]     = force;
    c->carries[n++] = i;
  }
  ComplianceAddColumns(N, c->W, n, c->carries, c->force, y);
}

/* v = free + [(1 - t) W kappa + t I] l */
PetscErrorCode ComplianceMove(ContactCompliance c)
{
  const PetscInt N = 3 * c->n;

  PetscFunctionBeginUser;
  if (ComplianceIsMap(c)) {
    for (PetscInt i = 0; i < N; i++) c->force[i] = c->kappa[i / 3] * c->l[i];
    PetscCall(c->krylov.map.move(c->krylov.map.ctx, c->force, c->v));
    for (PetscInt i = 0; i < N; i++) c->v[i] += c->free[i];
    PetscFunctionReturn(0);
  }
  for (PetscInt i = 0; i < N; i++) c->v[i] = c->free[i] + c->blend * c->l[i];
  ComplianceAddMotion(c, c->v);
  PetscFunctionReturn(0);
}

/* noise: v of a closed pair is a small difference of free and W kappa l. What rounding of the two leaves, also in mu
   where that falls steeply, is not the method's fault, and a residual below it cannot be asked for. */
void ComplianceMeasure(const ContactCompliance c, ComplianceMiss *miss)
{
  PetscReal sum = 0, size = 0, steepest = 1;

  *miss = (ComplianceMiss){.worst = -1};
  for (PetscInt p = 0; p < c->n; p++) {
    const PetscReal *l = &c->l[3 * p], *v = &c->v[3 * p];
    PetscReal        w[3], square;
    CoulombPair      pair;

    if (l[0] == 0 && l[1] == 0 && l[2] == 0 && v[0] >= 0) continue; /* open */
    pair   = ComplianceGetPair(c, p, 1, w);
    square = PetscSqr(l[0] - PetscMax(0, l[0] - v[0])) + PetscSqr(CoulombResidual(&pair, l, w));
    sum += square;
    steepest = PetscMax(steepest, PetscAbsReal(pair.fall) * l[0]);
    for (PetscInt i = 0; i < 3; i++) {
      miss->scale = PetscMax(miss->scale, PetscAbsReal(l[i]));
      if (l[0] > 0) size = PetscMax(size, PetscAbsReal(c->free[3 * p + i]) + PetscAbsReal(v[i]));
    }
    if (square <= PetscSqr(miss->largest)) continue; /* takes what is no number */
    miss->largest = PetscSqrtReal(square);
    miss->worst   = p;
  }
  miss->norm  = PetscSqrtReal(sum);
  miss->noise = MOTION_NOISE * PETSC_MACHINE_EPSILON * size * steepest;
}

PetscBool ComplianceIsSolved(const ContactCompliance c, const ComplianceMiss *miss)
{
  return miss->largest <= c->rtol * miss->scale + miss->noise ? PETSC_TRUE : PETSC_FALSE;
}

/* Friction per normal force where pair p slides at the present l, v: -mu times the direction of the trial slip; 0
   where that has no length */
void ComplianceTurn(const ContactCompliance c, PetscInt p, PetscReal d[2])
{
  PetscReal         w[3];
  const CoulombPair pair   = ComplianceGetPair(c, p, c->weight, w);
  const PetscReal   length = CoulombTrial(&pair, &c->l[3 * p], w, d);

  for (PetscInt i = 0; i < 2; i++) d[i] *= length > 0 ? -pair.mu / length : 0;
}

void ComplianceChoose(ContactCompliance c)
{
  for (PetscInt p = 0; p < c->n; p++) {
    PetscReal         w[3];
    const CoulombPair pair = ComplianceGetPair(c, p, c->weight, w);

    c->status[p] = CoulombDecide(&pair, c->status[p], &c->l[3 * p], w, 0);
  }
}
