/*
   The small system of the pairs, w + (W - V D) l - W w = rhs with l = P z + p0, w = Q z + q0, for z:

      [Q + (W - V D) P - W Q] z = rhs - q0 - (W - V D) p0 + W q0,   rhs = G K_a^-1 (f + kappa G'e) - e.

   Dense, it is factored by LAPACK on every rank alike, or solved by least squares where it is singular; too large for
   that, it is solved by GMRES, each application of W and V one pair of triangular solves. The determinant is positive
   without friction whatever is open or closed (a column is either one of W, whose eigenvalues lie in (0, 1], or one of
   I - W); where friction has turned its sign, the equilibrium lies beyond one at which the bodies jam.
*/
#include "statics/pairs/small.h"
#include "base/gather.h"
#include "base/algebra/dense.h"

/* smallest pivot beside the largest: some hundred roundings */
#define SMALL_PIVOT 1e-13
/* singular value beside the largest that is none */
#define SMALL_REDUNDANT 1e-12
/* residual of a singular system that has solutions: pairs which share a force, not a motion that nothing resists */
#define SMALL_CONSISTENT 1e-10

/* Adds column z_j, and with j < 0 the constants p0, q0 (subtracted): y += Q_j + (W - V D) P_j - W Q_j. A row with P =
   Q takes no column of W, and one without friction none of V: with most pairs at one status the sum over r is short. */
static void SmallAddColumn(const Compliance *c, PetscReal friction, PetscInt n, const LawRow law[], PetscInt j,
                           PetscReal y[])
{
  const PetscInt from = j < 0 ? 0 : law[j].first, to = j < 0 ? n : from + law[j].d;

  for (PetscInt r = from; r < to; r++) {
    const PetscReal P = j < 0 ? -law[r].p0 : law[r].P[j - from], Q = j < 0 ? -law[r].q0 : law[r].Q[j - from];

    y[r] += Q;
    for (PetscInt i = 0; i < n && P != Q; i++) y[i] += c->W[r * n + i] * (P - Q);
    for (PetscInt i = 0; i < n && c->V && P != 0 && law[r].slide != 0; i++)
      y[i] -= friction * law[r].slide * P * c->V[r * n + i];
  }
}

/* Factors A in place and solves; whether it is singular, and the sign of the determinant: negative pivots and
   exchanges of rows each turn it */
static PetscErrorCode SmallFactor(PetscInt n, PetscReal A[], PetscReal z[], SmallOutcome *outcome, PetscBool *reversed)
{
  PetscReal     least = PETSC_MAX_REAL, largest = 0;
  PetscBool     singular;
  PetscBLASInt *pivot;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n, &pivot));
  PetscCall(DenseFactor(n, A, pivot, &singular));
  *reversed = PETSC_FALSE;
  for (PetscInt i = 0; i < n; i++) {
    least   = PetscMin(least, PetscAbsReal(A[i * n + i]));
    largest = PetscMax(largest, PetscAbsReal(A[i * n + i]));
    if ((A[i * n + i] < 0) != (pivot[i] != i + 1)) *reversed = (PetscBool) !*reversed;
  }
  *outcome = least > SMALL_PIVOT * largest ? SMALL_GOOD : SMALL_SINGULAR;
  if (*outcome == SMALL_GOOD) PetscCall(DenseSolve(n, A, pivot, PETSC_FALSE, 1, z));
  PetscCall(PetscFree(pivot));
  PetscFunctionReturn(0);
}

/* The least z of those that solve the system where it is singular, as with supports or pairs that share a force: the
   shares are not unique then. Overwrites A. */
static PetscErrorCode SmallSolveLeast(PetscInt n, PetscReal A[], PetscReal z[], SmallOutcome *outcome)
{
  PetscReal left = 0, whole = 0, *copy, *rest;
  PetscInt  rank;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(n * n, &copy, n, &rest));
  PetscCall(PetscArraycpy(copy, A, n * n));
  for (PetscInt i = 0; i < n; i++) rest[i] = -z[i], whole += PetscSqr(z[i]);
  PetscCall(DenseLeast(n, n, A, z, SMALL_REDUNDANT, &rank));
  for (PetscInt j = 0; j < n; j++)
    for (PetscInt i = 0; i < n; i++) rest[i] += copy[j * n + i] * z[j];
  for (PetscInt i = 0; i < n; i++) left += PetscSqr(rest[i]);
  *outcome = rank >= 0 && left <= PetscSqr(SMALL_CONSISTENT) * whole ? SMALL_GOOD : SMALL_SINGULAR;
  PetscCall(PetscFree2(copy, rest));
  PetscFunctionReturn(0);
}

/* rhs [rows] */
static PetscErrorCode SmallRightHand(const SmallSystem *s, PetscReal rhs[])
{
  const Compliance *c = s->compliance;

  PetscFunctionBeginUser;
  if (!s->added) {
    PetscCall(PetscArraycpy(rhs, s->free, c->rows->n));
    PetscFunctionReturn(0);
  }
  PetscCall(ComplianceSolve(c, 0, s->f, NULL, s->e, c->u));
  PetscCall(ComplianceGetRows(c, c->u, rhs));
  for (PetscInt i = 0; i < c->rows->n; i++) rhs[i] -= s->e[i];
  PetscFunctionReturn(0);
}

/* z of this rank's rows [rows] */
static PetscErrorCode SmallSolveDense(const SmallSystem *s, PetscReal z[], SmallOutcome *outcome, PetscBool *reversed)
{
  const PairRows *rows = s->compliance->rows;
  const PetscInt  n    = rows->n_all;
  LawRow         *all_law;
  PetscReal      *A, *all, *rhs;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(rows->n, &rhs));
  PetscCall(SmallRightHand(s, rhs));
  PetscCall(PetscCalloc1(n * n, &A));
  PetscCall(GatherRecords(rows->comm, rows->n, sizeof(LawRow), s->law, NULL, &all_law));
  PetscCall(GatherRecords(rows->comm, rows->n, sizeof(PetscReal), rhs, NULL, &all));
  PetscCall(PetscFree(rhs));
  SmallAddColumn(s->compliance, s->friction, n, all_law, -1, all);
  for (PetscInt j = 0; j < n; j++) SmallAddColumn(s->compliance, s->friction, n, all_law, j, &A[j * n]);
  PetscCall(SmallFactor(n, A, all, outcome, reversed));
  if (*outcome == SMALL_SINGULAR) {
    PetscCall(PetscArrayzero(A, n * n));
    for (PetscInt j = 0; j < n; j++) SmallAddColumn(s->compliance, s->friction, n, all_law, j, &A[j * n]);
    PetscCall(SmallSolveLeast(n, A, all, outcome));
    *reversed = PETSC_FALSE;
  }
  if (s->friction == 0) *reversed = PETSC_FALSE; /* where slip is free the determinant is zero, its sign rounding */
  PetscCall(PetscArraycpy(z, &all[rows->begin], rows->n));
  PetscCall(PetscFree(all_law));
  PetscCall(PetscFree(all));
  PetscCall(PetscFree(A));
  PetscFunctionReturn(0);
}

PetscErrorCode SmallSolve(const SmallSystem *system, PetscReal z[], PetscReal l[], PetscReal w[], SmallOutcome *outcome,
                          PetscBool *reversed)
{
  const PairRows *rows = system->compliance->rows;

  PetscFunctionBeginUser;
  *reversed = PETSC_FALSE;
  if (system->compliance->W)
    PetscCall(SmallSolveDense(system, z, outcome, reversed));
  else
    PetscCall(SmallSolveSparse(system, z, outcome));
  SmallApplyLaws(rows, system->law, PETSC_TRUE, z, l, w);
  PetscFunctionReturn(0);
}
