/*
   ContactCompliance: what it owns, options, reports. W is [3 n][3 n] (m/N) in columns as BLAS has
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

/* What any solver has, for n pairs */
static PetscErrorCode ComplianceAllocate(PetscInt n, ContactCompliance *compliance)
{
  ContactCompliance c;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&c));
  c->n    = n;
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
  PetscCall(PetscCalloc3(3 * n, &c->slip, n, &c->rests, n, &c->hold));
  PetscCall(PetscMalloc2(3 * n * COMPLIANCE_MIXED, &c->chord.basis, 3 * n * COMPLIANCE_MIXED, &c->chord.step));
  c->totals   = (ComplianceReport){.converged = PETSC_TRUE, .worst = -1};
  *compliance = c;
  PetscFunctionReturn(0);
}

PetscErrorCode ContactComplianceCreate(PetscInt n, const PetscReal W[], ContactCompliance *compliance)
{
  PetscFunctionBeginUser;
  PetscCall(MatrixCheck(3 * n, W));
  PetscCall(ComplianceAllocate(n, compliance));
  (*compliance)->W = W;
  PetscCall(ComplianceSetScales(*compliance));
  PetscFunctionReturn(0);
}

PetscErrorCode ContactComplianceCreateMap(PetscInt n, const ComplianceMap *map, ContactCompliance *compliance)
{
  ComplianceKrylov *k;

  PetscFunctionBeginUser;
  PetscCall(ComplianceAllocate(n, compliance));
  k      = &(*compliance)->krylov;
  k->map = *map;
  PetscCall(PetscCalloc4(3 * n, &k->held, 3 * n, &k->released, 3 * n, &k->motion, 3 * n, &k->force));
  PetscCall(PetscArraycpy((*compliance)->kappa, map->kappa, n));
  PetscCall(ComplianceSetScales(*compliance));
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

PetscErrorCode ContactComplianceSetResting(ContactCompliance c, const ContactStatus status[])
{
  PetscFunctionBeginUser;
  for (PetscInt p = 0; p < c->n; p++)
    c->rests[p] = c->varies[p] && status[p] == CONTACT_STICK ? PETSC_TRUE : PETSC_FALSE;
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

PetscErrorCode ContactComplianceSolve(ContactCompliance c, const PetscReal q[], const PetscReal slip0[],
                                      PetscReal lambda[], PetscReal r[], ComplianceReport *report)
{
  PetscFunctionBeginUser;
  if (c->springs.law)
    PetscCall(ComplianceSolveSprings(c, q, slip0, lambda));
  else
    PetscCall(ComplianceSolveLines(c, q, slip0, lambda));
  ComplianceReportStep(c);
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
  PetscCall(ComplianceNearDestroy(c));
  PetscCall(ComplianceDualDestroy(c));
  PetscCall(ComplianceDestroySprings(c));
  PetscCall(PetscFree4(c->krylov.held, c->krylov.released, c->krylov.motion, c->krylov.force));
  PetscCall(PetscFree3(c->slip, c->rests, c->hold));
  PetscCall(PetscFree(*compliance));
  PetscFunctionReturn(0);
}
