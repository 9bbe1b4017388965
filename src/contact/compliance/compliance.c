/*
   ContactCompliance: what it owns, the order of the methods, reports. W is [3 n][3 n] (m/N) in columns as BLAS has
   it; it is symmetric, so that rows are columns.

   Inside, forces are lengths: l = lambda / kappa_p with kappa_p = 3 / trace W_pp (N/m), the stiffness of pair p
   alone, so that l and v = r - slip0 are of one size at each pair: the diagonal blocks of W kappa have the trace 3,
   whatever the units and however stiff one body is beside the other.
*/
#include "complianceimpl.h"

/* relative residual of the laws; chord.c goes on to 1e-15 where rounding lets it */
#define COMPLIANCE_RTOL 1e-12
/* of the larger of two diagonals: what sums of modes and static solutions leave by rounding */
#define COMPLIANCE_SYMMETRIC 1e-10
/* of the largest diagonal: eigenvalues that are negative by less are rounding */
#define COMPLIANCE_DEFINITE 1e-10
#define COMPLIANCE_POWER    30 /* iterations for the largest eigenvalue */
#define COMPLIANCE_MAX_IT   40 /* of Newton's method */

/* Finite, symmetric, with a diagonal that is not negative. The conditions are written so that nan fails them. */
static PetscErrorCode MatrixCheck(PetscInt n, const PetscReal W[])
{
  PetscFunctionBeginUser;
  for (PetscInt j = 0; j < n; j++) {
    PetscCheck(W[j * n + j] >= 0, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
               "Compliance of pair %" PetscInt_FMT ": %g on the diagonal must not be negative", j / 3,
               (double)W[j * n + j]);
    for (PetscInt i = 0; i < j; i++) {
      const PetscReal a = W[j * n + i], b = W[i * n + j], size = PetscMax(W[j * n + j], W[i * n + i]);

      PetscCheck(PetscAbsReal(a - b) <= COMPLIANCE_SYMMETRIC * size, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
                 "Compliance of pairs %" PetscInt_FMT " and %" PetscInt_FMT " is not symmetric or not finite: %g, %g",
                 i / 3, j / 3, (double)a, (double)b);
    }
  }
  PetscFunctionReturn(0);
}

/* kappa = 3 / trace W_pp, N/m; that of the mean where a pair is held in all directions, W_pp = 0, whose force is any
   that the laws ask for */
static void StiffnessSet(ContactCompliance c)
{
  const PetscInt N   = 3 * c->n;
  PetscReal      sum = 0;

  for (PetscInt i = 0; i < N; i++) sum += c->W[i * N + i];
  for (PetscInt p = 0; p < c->n; p++) {
    PetscReal trace = 0;

    for (PetscInt i = 3 * p; i < 3 * p + 3; i++) trace += c->W[i * N + i];
    c->kappa[p] = trace > 0 ? 3 / trace : sum > 0 ? N / sum : 1;
  }
}

/* Statuses are decided by l - a v, a = 1 / sqrt(largest eigenvalue of W kappa): between what a pair feels alone, 1,
   and what all feel together. With 1, a motion of all pairs that hardly changes their forces would change all their
   statuses. Power iteration in the inner product x' kappa y, in which W kappa is symmetric, from a vector that is no
   mode of a symmetric scene. A rough value is enough: any a > 0 has the same solutions. */
static void WeightSet(ContactCompliance c)
{
  const PetscReal    zero = 0, one = 1;
  const PetscBLASInt N = (PetscBLASInt)(3 * c->n), inc = 1;
  PetscReal          largest = 1;

  for (PetscInt i = 0; i < N; i++) c->l[i] = 1 + 0.3 * PetscSinReal((PetscReal)i);
  for (PetscInt k = 0; k < COMPLIANCE_POWER && N; k++) {
    PetscReal before = 0, after = 0;

    for (PetscInt i = 0; i < N; i++) c->force[i] = c->kappa[i / 3] * c->l[i];
    BLASgemv_("N", &N, &N, &one, c->W, &N, c->force, &inc, &zero, c->v, &inc);
    for (PetscInt i = 0; i < N; i++) {
      before += c->kappa[i / 3] * PetscSqr(c->l[i]);
      after += c->kappa[i / 3] * PetscSqr(c->v[i]);
    }
    if (!(after > 0)) break;
    largest = PetscSqrtReal(after / before);
    for (PetscInt i = 0; i < N; i++) c->l[i] = c->v[i] / PetscSqrtReal(after);
  }
  c->weight = 1 / PetscSqrtReal(PetscMax(1, largest));
}

void ComplianceSetScales(ContactCompliance c)
{
  StiffnessSet(c);
  WeightSet(c);
}

PetscErrorCode ContactComplianceCreate(PetscInt n, const PetscReal W[], ContactCompliance *compliance)
{
  ContactCompliance c;

  PetscFunctionBeginUser;
  PetscCall(MatrixCheck(3 * n, W));
  PetscCall(PetscNew(&c));
  c->n    = n;
  c->W    = W;
  c->rtol = COMPLIANCE_RTOL;
  c->dt   = 1;
  PetscCall(PetscCalloc4(n, &c->kappa, n, &c->friction, n, &c->mu, n, &c->varies));
  PetscCall(PetscCalloc7(3 * n, &c->free, 3 * n, &c->l, 3 * n, &c->v, 3 * n, &c->l0, 3 * n, &c->v0, 3 * n, &c->best,
                         3 * n, &c->force));
  PetscCall(
    PetscCalloc6(n, &c->status, n, &c->law, n, &c->closed, n + 1, &c->row, 2 * n, &c->slide, 3 * n, &c->carries));
  PetscCall(PetscMalloc6(4 * n, &c->chord.index, 4 * n, &c->chord.place, 4 * n, &c->chord.column, 4 * n,
                         &c->chord.border, 4 * n, &c->chord.want, 4 * n, &c->chord.next));
  PetscCall(PetscCalloc4(n, &c->chord.frame, 4 * n, &c->chord.b, 4 * n, &c->chord.s, 4 * n, &c->chord.z));
  PetscCall(PetscCalloc2(3 * n, &c->chord.x, 3 * n, &c->chord.f));
  PetscCall(PetscCalloc1(3 * n, &c->slip));
  PetscCall(PetscMalloc2(3 * n * COMPLIANCE_MIXED, &c->chord.basis, 3 * n * COMPLIANCE_MIXED, &c->chord.step));
  ComplianceSetScales(c);
  c->totals   = (ComplianceReport){.converged = PETSC_TRUE, .worst = -1};
  *compliance = c;
  PetscFunctionReturn(0);
}

PetscErrorCode ContactComplianceCheckDefinite(ContactCompliance c, PetscBool *definite)
{
  const PetscInt     N    = 3 * c->n;
  const PetscBLASInt rows = (PetscBLASInt)N;
  PetscReal         *A, size = 0;
  PetscBLASInt       info;

  PetscFunctionBeginUser;
  *definite = PETSC_TRUE;
  if (!N) PetscFunctionReturn(0);
  PetscCall(PetscMalloc1(N * N, &A));
  PetscCall(PetscArraycpy(A, c->W, N * N));
  for (PetscInt i = 0; i < N; i++) size = PetscMax(size, A[i * N + i]);
  for (PetscInt i = 0; i < N; i++) A[i * N + i] += COMPLIANCE_DEFINITE * size;
  PetscCallBLAS("LAPACKpotrf", LAPACKpotrf_("L", &rows, A, &rows, &info));
  PetscCheck(info >= 0, PETSC_COMM_SELF, PETSC_ERR_LIB, "LAPACK potrf: info %d", (int)info);
  if (info && size > 0) *definite = PETSC_FALSE;
  PetscCall(PetscFree(A));
  PetscFunctionReturn(0);
}

PetscErrorCode ContactComplianceSetFriction(ContactCompliance c, const FrictionLaw friction[], PetscReal dt)
{
  PetscFunctionBeginUser;
  for (PetscInt p = 0; p < c->n; p++) {
    const PetscReal mu = FrictionSteady(&friction[p]);

    PetscCheck(mu >= 0 && FrictionIsValid(&friction[p]), PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
               "Friction coefficient of pair %" PetscInt_FMT " is %g; must be finite and not negative", p, (double)mu);
    c->friction[p] = friction[p];
    c->mu[p]       = mu;
    c->varies[p]   = FrictionVaries(&friction[p]);
    PetscCheck(!c->varies[p] || dt > 0, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
               "Step of friction that changes with the slip speed is %g s; must be positive", (double)dt);
  }
  c->dt = dt;
  PetscFunctionReturn(0);
}

PetscErrorCode ContactComplianceSetTolerance(ContactCompliance c, PetscReal rtol)
{
  PetscFunctionBeginUser;
  PetscCheck(rtol > 0 && rtol < 1, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
             "Tolerance of contact on a compliance is %g; must be between 0 and 1", (double)rtol);
  c->rtol = rtol;
  PetscFunctionReturn(0);
}

/* Motions without forces, free = q - (0, slip0), m, and the guess; a guess that pulls or drives is none. Not finite
   is an error here, before it can run through all four methods. */
static PetscErrorCode StepBegin(ContactCompliance c, const PetscReal q[], const PetscReal slip0[],
                                const PetscReal lambda[])
{
  PetscFunctionBeginUser;
  c->blend  = 0;
  c->report = (ComplianceReport){.worst = -1, .steps = 1};
  for (PetscInt p = 0; p < c->n; p++) {
    for (PetscInt i = 0; i < 3; i++) {
      const PetscReal at = q[3 * p + i] - (i ? slip0[2 * p + i - 1] : 0), force = lambda[3 * p + i] / c->kappa[p];

      PetscCheck(!PetscIsInfOrNanReal(at) && !PetscIsInfOrNanReal(force), PETSC_COMM_SELF, PETSC_ERR_FP,
                 "Contact pair %" PetscInt_FMT ": displacement %g m or force %g N is not finite", p, (double)at,
                 (double)lambda[3 * p + i]);
      c->free[3 * p + i] = at;
      c->l[3 * p + i]    = lambda[3 * p] > 0 ? force : 0;
    }
    c->status[p] = lambda[3 * p] > 0 ? CONTACT_SLIP : CONTACT_OPEN;
  }
  PetscFunctionReturn(0);
}

/* Forces out, statuses decided */
static void StepEnd(ContactCompliance c, PetscReal lambda[])
{
  ComplianceChoose(c);
  for (PetscInt i = 0; i < 3 * c->n; i++) lambda[i] = c->kappa[i / 3] * c->l[i];
}

/* Adds the report of the step to that of all. The residual is relative to scale + noise / rtol, hence below rtol
   exactly where ComplianceIsSolved() says so. The route of all is the last resort that any step took. */
static void StepReport(ContactCompliance c, const ComplianceMiss *miss)
{
  ComplianceReport *one = &c->report, *all = &c->totals;

  one->converged = ComplianceIsSolved(c, miss);
  one->residual  = miss->largest > 0 ? miss->largest / (miss->scale + miss->noise / c->rtol) : 0;
  one->worst     = miss->worst;
  one->routes[one->route]++;
  all->converged = one->converged && all->converged ? PETSC_TRUE : PETSC_FALSE;
  all->route     = PetscMax(all->route, one->route);
  all->iterations += one->iterations;
  all->factors += one->factors;
  all->steps++;
  for (PetscInt i = 0; i < COMPLIANCE_N_ROUTES; i++) all->routes[i] += one->routes[i];
  if (!(one->residual > all->residual)) return;
  all->residual = one->residual;
  all->worst    = one->worst;
}

PetscErrorCode ComplianceSolveLines(ContactCompliance c, const PetscReal q[], const PetscReal slip0[],
                                    PetscReal lambda[])
{
  ComplianceMiss miss;

  PetscFunctionBeginUser;
  PetscCall(StepBegin(c, q, slip0, lambda));
  PetscCall(ComplianceChordIterate(c, &miss));
  for (c->report.route = COMPLIANCE_CHORD; !ComplianceIsSolved(c, &miss) && c->report.route < COMPLIANCE_PATH;) {
    c->report.route++;
    if (c->report.route == COMPLIANCE_NEWTON) PetscCall(ComplianceIterate(c, PETSC_FALSE, COMPLIANCE_MAX_IT, &miss));
    if (c->report.route == COMPLIANCE_DAMPED) PetscCall(ComplianceIterate(c, PETSC_TRUE, COMPLIANCE_MAX_IT, &miss));
    if (c->report.route == COMPLIANCE_PATH) PetscCall(ComplianceFollow(c, &miss));
  }
  if (ComplianceIsSolved(c, &miss)) PetscCall(ComplianceRefine(c, &miss));
  StepReport(c, &miss);
  StepEnd(c, lambda);
  PetscFunctionReturn(0);
}

PetscErrorCode ContactComplianceSolve(ContactCompliance c, const PetscReal q[], const PetscReal slip0[],
                                      PetscReal lambda[], PetscReal r[], ComplianceReport *report)
{
  PetscFunctionBeginUser;
  if (c->springs.law)
    PetscCall(ComplianceSolveSprings(c, q, slip0, lambda));
  else
    PetscCall(ComplianceSolveLines(c, q, slip0, lambda));
  for (PetscInt p = 0; p < c->n; p++) {
    for (PetscInt i = 0; i < 3; i++) c->slip[3 * p + i] = c->v[3 * p + i] - (i ? 0 : ComplianceLineClosing(c, p));
    for (PetscInt i = 0; i < 3 && r; i++) r[3 * p + i] = c->slip[3 * p + i] + (i ? slip0[2 * p + i - 1] : 0);
  }
  if (report) *report = c->report;
  PetscFunctionReturn(0);
}

PetscErrorCode ContactComplianceGetStatus(ContactCompliance c, const ContactStatus **status)
{
  PetscFunctionBeginUser;
  *status = c->status;
  PetscFunctionReturn(0);
}

PetscErrorCode ContactComplianceGetSlip(ContactCompliance c, const PetscReal **slip)
{
  PetscFunctionBeginUser;
  *slip = c->slip;
  PetscFunctionReturn(0);
}

PetscErrorCode ContactComplianceGetTotals(ContactCompliance c, ComplianceReport *report)
{
  PetscFunctionBeginUser;
  *report = c->totals;
  PetscFunctionReturn(0);
}

PetscErrorCode ContactComplianceDestroy(ContactCompliance *compliance)
{
  ContactCompliance c = *compliance;

  PetscFunctionBeginUser;
  if (!c) PetscFunctionReturn(0);
  PetscCall(PetscFree4(c->kappa, c->friction, c->mu, c->varies));
  PetscCall(PetscFree7(c->free, c->l, c->v, c->l0, c->v0, c->best, c->force));
  PetscCall(PetscFree6(c->status, c->law, c->closed, c->row, c->slide, c->carries));
  PetscCall(PetscFree3(c->A, c->rhs, c->pivot));
  PetscCall(PetscFree6(c->chord.index, c->chord.place, c->chord.column, c->chord.border, c->chord.want, c->chord.next));
  PetscCall(PetscFree4(c->chord.frame, c->chord.b, c->chord.s, c->chord.z));
  PetscCall(PetscFree2(c->chord.x, c->chord.f));
  PetscCall(PetscFree2(c->chord.basis, c->chord.step));
  PetscCall(PetscFree6(c->chord.LU, c->chord.V, c->chord.S, c->chord.row, c->chord.at, c->chord.small));
  PetscCall(ComplianceDualDestroy(c));
  PetscCall(ComplianceDestroySprings(c));
  PetscCall(PetscFree(c->slip));
  PetscCall(PetscFree(*compliance));
  PetscFunctionReturn(0);
}
