/*
   The small system of the pairs, w + (W - V D) l - W w = rhs with l = P z + p0, w = Q z + q0, for z:

      [Q + (W - V D) P - W Q] z = rhs - q0 - (W - V D) p0 + W q0.

   Dense, it is factored by LAPACK on every rank alike, or solved by least squares where it is singular; too large for
   that, it is solved by GMRES, each application of W and V one pair of triangular solves. The determinant is positive
   without friction whatever is open or closed (a column is either one of W, whose eigenvalues lie in (0, 1], or one of
   I - W); where friction has turned its sign, the equilibrium lies beyond one at which the bodies jam.
*/
#include "statics/staticsimpl.h"
#include "base/gather.h"
#include "base/algebra/dense.h"

/* smallest pivot beside the largest: some hundred roundings */
#define SMALL_PIVOT 1e-13
/* singular value beside the largest that is none */
#define SMALL_REDUNDANT 1e-12
/* residual of a singular system that has solutions: pairs which share a force, not a motion that nothing resists */
#define SMALL_CONSISTENT 1e-10
#define GMRES_ENOUGH     1e-10 /* of GMRES that gets no farther; refinement of the whole does the rest */
#define GMRES_RESTART    300
#define GMRES_STEPS      300

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

/* z of this rank's rows [rows] */
static PetscErrorCode SmallSolveDense(const SmallSystem *s, PetscReal z[], SmallOutcome *outcome, PetscBool *reversed)
{
  const PairRows *rows = s->compliance->rows;
  const PetscInt  n    = rows->n_all;
  LawRow         *all_law;
  PetscReal      *A, *all;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(n * n, &A));
  PetscCall(GatherRecords(rows->comm, rows->n, sizeof(LawRow), s->law, NULL, &all_law));
  PetscCall(GatherRecords(rows->comm, rows->n, sizeof(PetscReal), s->rhs, NULL, &all));
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

/* The matrix-free system, and work [rows] */
typedef struct {
  const SmallSystem *system;
  PetscReal         *l, *w;
} SmallShell;

/* l = P z, w = Q z; with p0, q0 when they are wanted */
static void SmallApplyLaws(const PairRows *rows, const LawRow law[], PetscBool constants, const PetscReal z[],
                           PetscReal l[], PetscReal w[])
{
  for (PetscInt i = 0; i < rows->n; i++) {
    const LawRow *a = &law[i];

    l[i] = constants ? a->p0 : 0;
    w[i] = constants ? a->q0 : 0;
    for (PetscInt k = 0; k < a->d; k++) {
      l[i] += a->P[k] * z[a->first - rows->begin + k];
      w[i] += a->Q[k] * z[a->first - rows->begin + k];
    }
  }
}

/* y = [Q + (W - V D) P - W Q] z */
static PetscErrorCode SmallShellMult(Mat A, Vec z, Vec y)
{
  const PetscScalar *from;
  PetscScalar       *to;
  SmallShell        *s;

  PetscFunctionBeginUser;
  PetscCall(MatShellGetContext(A, &s));
  PetscCall(VecGetArrayRead(z, &from));
  SmallApplyLaws(s->system->compliance->rows, s->system->law, PETSC_FALSE, from, s->l, s->w);
  PetscCall(VecRestoreArrayRead(z, &from));
  PetscCall(VecGetArray(y, &to));
  PetscCall(ComplianceApply(s->system->compliance, s->system->friction, s->l, s->w, to));
  PetscCall(VecRestoreArray(y, &to));
  PetscFunctionReturn(0);
}

/* The system, and its solver without a preconditioner: residuals of rtol |b| are left, |b| = whole */
static PetscErrorCode SmallCreateGMRES(SmallShell *s, Vec b, PetscReal *whole, Mat *A, KSP *ksp)
{
  const PetscReal rtol = s->system->rtol;
  MPI_Comm        comm = s->system->compliance->rows->comm;
  PetscInt        n;
  PC              pc;

  PetscFunctionBeginUser;
  PetscCall(VecGetLocalSize(b, &n));
  PetscCall(VecNorm(b, NORM_2, whole));
  PetscCall(MatCreateShell(comm, n, n, PETSC_DETERMINE, PETSC_DETERMINE, s, A));
  PetscCall(MatShellSetOperation(*A, MATOP_MULT, (void (*)(void))SmallShellMult));
  PetscCall(KSPCreate(comm, ksp));
  PetscCall(KSPSetOptionsPrefix(*ksp, "st_pairs_"));
  PetscCall(KSPSetOperators(*ksp, *A, *A));
  PetscCall(KSPSetType(*ksp, KSPGMRES));
  PetscCall(KSPGMRESSetRestart(*ksp, GMRES_RESTART));
  PetscCall(KSPGMRESSetCGSRefinementType(*ksp, KSP_GMRES_CGS_REFINE_IFNEEDED));
  PetscCall(KSPSetTolerances(*ksp, PETSC_SMALL * PETSC_SMALL, rtol * *whole, PETSC_DEFAULT, GMRES_STEPS));
  PetscCall(KSPGetPC(*ksp, &pc));
  PetscCall(PCSetType(pc, PCNONE));
  PetscCall(KSPSetFromOptions(*ksp));
  PetscFunctionReturn(0);
}

/* z = z + A^-1 (b - A z) by GMRES; from 0 where the guess z leaves more than that does */
static PetscErrorCode SmallRunGMRES(SmallShell *s, Vec b, Vec z, SmallOutcome *outcome)
{
  KSPConvergedReason reason;
  PetscReal          left, whole;
  KSP                ksp;
  Mat                A;
  Vec                r, dz;

  PetscFunctionBeginUser;
  PetscCall(SmallCreateGMRES(s, b, &whole, &A, &ksp));
  PetscCall(VecDuplicate(b, &r));
  PetscCall(VecDuplicate(b, &dz));
  PetscCall(MatMult(A, z, r));
  PetscCall(VecAYPX(r, -1, b));
  PetscCall(VecNorm(r, NORM_2, &left));
  if (!(left < whole)) {
    PetscCall(VecSet(z, 0));
    PetscCall(VecCopy(b, r));
  }
  PetscCall(KSPSolve(ksp, r, dz));
  PetscCall(VecAXPY(z, 1, dz));
  PetscCall(KSPGetConvergedReason(ksp, &reason));
  PetscCall(KSPGetResidualNorm(ksp, &left));
  *outcome = reason > 0 || left <= GMRES_ENOUGH * whole ? SMALL_GOOD : SMALL_UNSOLVED;
  PetscCall(VecDestroy(&r));
  PetscCall(VecDestroy(&dz));
  PetscCall(KSPDestroy(&ksp));
  PetscCall(MatDestroy(&A));
  PetscFunctionReturn(0);
}

/* z of this rank's rows [rows], from a guess of it */
static PetscErrorCode SmallSolveGMRES(const SmallSystem *system, PetscReal z[], SmallOutcome *outcome)
{
  const Compliance *c = system->compliance;
  const PetscInt    n = c->rows->n;
  SmallShell        s = {.system = system};
  PetscScalar      *value;
  PetscReal        *y;
  Vec               b, x;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc3(n, &s.l, n, &s.w, n, &y));
  PetscCall(VecDuplicate(c->row, &b));
  PetscCall(VecDuplicate(c->row, &x));
  for (PetscInt i = 0; i < n; i++) {
    s.l[i] = system->law[i].p0;
    s.w[i] = system->law[i].q0;
  }
  PetscCall(ComplianceApply(c, system->friction, s.l, s.w, y));
  PetscCall(VecGetArray(b, &value));
  for (PetscInt i = 0; i < n; i++) value[i] = system->rhs[i] - y[i];
  PetscCall(VecRestoreArray(b, &value));
  PetscCall(VecGetArray(x, &value));
  PetscCall(PetscArraycpy(value, z, n));
  PetscCall(VecRestoreArray(x, &value));
  PetscCall(SmallRunGMRES(&s, b, x, outcome));
  PetscCall(VecGetArray(x, &value));
  PetscCall(PetscArraycpy(z, value, n));
  PetscCall(VecRestoreArray(x, &value));
  PetscCall(VecDestroy(&b));
  PetscCall(VecDestroy(&x));
  PetscCall(PetscFree3(s.l, s.w, y));
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
    PetscCall(SmallSolveGMRES(system, z, outcome));
  SmallApplyLaws(rows, system->law, PETSC_TRUE, z, l, w);
  PetscFunctionReturn(0);
}
