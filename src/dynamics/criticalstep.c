/*
   The critical step: the largest dt with

      dt^2 lambda_max(M^-1 (K + 2 C / dt)) <= 2 / b

   at which the fastest oscillation changes its sign in every step (z = -1 in the recursion of tscentral.h with damping
   lagged by half a step; for b = 1/2 and C = beta K it is dt = -beta + sqrt(beta^2 + 4 / omega^2)). Contact only
   restricts the motion, which lowers the frequencies.

   Lanczos iteration (SLEPc) on the symmetric M^-1/2 (K + s C) M^-1/2 at s = 2 / dt, M^-1/2 standing for the
   symmetric Q D^-1/2 with its transpose where superelements make M more than the diagonal D (BodiesApplyRoot()).
   With its largest eigenvector x, x'Mx = 1, k = x'Kx, c = x'Cx, the next dt solves dt^2 k + 2 dt c = 2 / b: from
   above, since another vector may be worse at the new dt. lambda_max is raised by the tolerance of the residual, not
   by the residual that is left, which depends on rounding and ranks: the eigenvalue itself has twice its digits. Upper
   bound of lambda_max for the check: that of the single elements.
*/
#include "dynamicsimpl.h"
#include "base/algebra/synchronize.h"
#include <slepceps.h>

/* changes of s = 2 / dt, each with a Lanczos iteration from the eigenvector before */
#define CRITICAL_MAX_IT 50
#define CRITICAL_RTOL   1e-6 /* of dt */

/* The operator: s, and work: scale = M^-1/2, state vectors x, kx, cx */
typedef struct {
  Dynamics   dynamics;
  PetscReal  s;
  PetscReal *scale, *x, *kx, *cx;
} StepPencil;

/* scale = M^-1/2 (kg^-1/2), 0 in held directions, which thereby drop out of the operator */
static PetscErrorCode StepPencilCreate(Dynamics d, StepPencil *p)
{
  const PetscInt n = d->layout->n;

  PetscFunctionBeginUser;
  *p = (StepPencil){.dynamics = d};
  PetscCall(PetscMalloc4(n, &p->scale, n, &p->x, n, &p->kx, n, &p->cx));
  for (PetscInt i = 0; i < n; i++) p->scale[i] = PetscSqrtReal(d->layout->minv[i]);
  PetscFunctionReturn(0);
}

/* kx = M^-1/2 K M^-1/2 x and the same of C, for the vector x */
static PetscErrorCode StepPencilApply(StepPencil *p, Vec x)
{
  const Dynamics d = p->dynamics;

  PetscFunctionBeginUser;
  PetscCall(StateVectorFromVec(d->model, d->layout, x, p->x));
  PetscCall(BodiesApplyRoot(d->bodies, p->scale, p->x));
  for (PetscInt i = 0; i < d->layout->n; i++) p->x[i] *= p->scale[i];
  PetscCall(BodiesApply(d->bodies, p->x, p->kx, p->cx));
  for (PetscInt i = 0; i < d->layout->n; i++) {
    p->kx[i] *= p->scale[i];
    p->cx[i] *= p->scale[i];
  }
  PetscCall(BodiesApplyRoot(d->bodies, p->scale, p->kx));
  PetscCall(BodiesApplyRoot(d->bodies, p->scale, p->cx));
  PetscFunctionReturn(0);
}

/* y = M^-1/2 (K + s C) M^-1/2 x, (rad/s)^2: symmetric, where M^-1 K is not, so that Lanczos' short recurrence holds */
static PetscErrorCode StepPencilMult(Mat A, Vec x, Vec y)
{
  StepPencil *p;

  PetscFunctionBeginUser;
  PetscCall(MatShellGetContext(A, &p));
  PetscCall(StepPencilApply(p, x));
  for (PetscInt i = 0; i < p->dynamics->layout->n; i++) p->kx[i] += p->s * p->cx[i];
  PetscCall(StateVectorToVec(p->dynamics->model, p->dynamics->layout, p->kx, y));
  PetscFunctionReturn(0);
}

/* x'Kx and x'Cx of the eigenvector x of unit length */
static PetscErrorCode StepPencilRayleigh(StepPencil *p, Vec x, PetscReal *k, PetscReal *c)
{
  const Dynamics d = p->dynamics;
  Vec            y;

  PetscFunctionBeginUser;
  PetscCall(VecDuplicate(x, &y));
  PetscCall(StepPencilApply(p, x));
  PetscCall(StateVectorToVec(d->model, d->layout, p->kx, y));
  PetscCall(VecDot(x, y, k));
  PetscCall(StateVectorToVec(d->model, d->layout, p->cx, y));
  PetscCall(VecDot(x, y, c));
  PetscCall(VecDestroy(&y));
  PetscFunctionReturn(0);
}

/* The operator is a shell in the unknowns of the operators, without a matrix: the kernels multiply. EPS_HEP lets
   SLEPc use Lanczos; the small problems are alike on all ranks (SolverSynchronize()). */
static PetscErrorCode StepPencilCreateSolver(StepPencil *p, Mat *A, EPS *eps)
{
  const Dynamics d = p->dynamics;
  PetscInt       n;
  DS             ds;
  Vec            x;

  PetscFunctionBeginUser;
  PetscCall(OperatorsCreateVec(d->operators, &x));
  PetscCall(VecGetLocalSize(x, &n));
  PetscCall(VecDestroy(&x));
  PetscCall(MatCreateShell(d->comm, n, n, PETSC_DETERMINE, PETSC_DETERMINE, p, A));
  PetscCall(MatShellSetOperation(*A, MATOP_MULT, (void (*)(void))StepPencilMult));
  PetscCall(EPSCreate(d->comm, eps));
  PetscCall(EPSSetOptionsPrefix(*eps, "dynamics_"));
  PetscCall(EPSSetOperators(*eps, *A, NULL));
  PetscCall(EPSSetProblemType(*eps, EPS_HEP));
  PetscCall(EPSSetWhichEigenpairs(*eps, EPS_LARGEST_REAL));
  PetscCall(EPSSetTolerances(*eps, 1e-7, 1000));
  PetscCall(EPSGetDS(*eps, &ds));
  PetscCall(SolverSynchronize(ds));
  PetscFunctionReturn(0);
}

/* Largest eigenvalue at s = 2 / dt (s = 0 for dt infinite); x starts the iteration and becomes the eigenvector */
static PetscErrorCode StepPencilLargest(StepPencil *p, EPS eps, PetscReal s, Vec x, PetscReal *lambda)
{
  PetscInt  converged;
  PetscReal rtol;

  PetscFunctionBeginUser;
  p->s = s;
  PetscCall(EPSSetInitialSpace(eps, 1, &x));
  PetscCall(EPSSolve(eps));
  PetscCall(EPSGetConverged(eps, &converged));
  PetscCheck(converged > 0, p->dynamics->comm, PETSC_ERR_NOT_CONVERGED,
             "largest frequency of the mesh did not converge: give -ts_dt");
  PetscCall(EPSGetEigenpair(eps, 0, lambda, NULL, x, NULL));
  PetscCall(EPSGetTolerances(eps, &rtol, NULL));
  *lambda *= 1 + rtol;
  PetscFunctionReturn(0);
}

/* The dt at which an eigenvector with k, c is critical: dt^2 k + 2 dt c = 2 / b */
static PetscReal CriticalVectorStep(PetscReal b, PetscReal k, PetscReal c)
{
  return (2 / b) / (c + PetscSqrtReal(c * c + 2 * k / b));
}

/* From s = 0, without damping, dt = sqrt(2 / (b lambda)), then alternately x at 2 / dt and dt of x, until dt stands
   still. lambda exceeds x'(K + s C)x by the tolerance: what it exceeds is put to k, so that the step keeps it. */
static PetscErrorCode StepPencilFindStep(StepPencil *p, EPS eps, Vec x, PetscReal b, CriticalStep *critical)
{
  PetscReal lambda, k, c, dt, last = 0;

  PetscFunctionBeginUser;
  PetscCall(StepPencilLargest(p, eps, 0, x, &lambda));
  dt            = PetscSqrtReal(2 / (b * lambda));
  critical->its = 1;
  for (PetscInt i = 0; i < CRITICAL_MAX_IT && PetscAbsReal(dt - last) > CRITICAL_RTOL * dt; i++) {
    last = dt;
    PetscCall(StepPencilRayleigh(p, x, &k, &c));
    if (c == 0) break;
    dt = CriticalVectorStep(b, k + PetscMax(0, lambda - k - p->s * c), c);
    PetscCall(StepPencilLargest(p, eps, 2 / dt, x, &lambda));
    critical->its++;
  }
  critical->assembled = dt;
  PetscFunctionReturn(0);
}

/* Largest dt that the elements allow each by itself, dt^2 bound(2 / dt) = 2 / b, from the assembled one downwards:
   every iteration halves the error at least, since bound(s) is linear in s at most. Three figures are enough for a
   check. The assembled step can only be larger (elementbound.c): a smaller bound of it than the elements' means
   that Lanczos has missed the largest eigenvalue. */
static PetscErrorCode CriticalElementStep(Dynamics d, CriticalStep *critical)
{
  PetscReal last = 0, bound;

  PetscFunctionBeginUser;
  critical->element = critical->assembled;
  for (PetscInt i = 0; i < CRITICAL_MAX_IT && PetscAbsReal(critical->element - last) > 1e-3 * last; i++) {
    last = critical->element;
    PetscCall(BodiesGetElementBound(d->bodies, 2 / last, &bound));
    critical->element = PetscSqrtReal(2 / (d->b * bound));
  }
  PetscCheck(critical->element <= (1 + 1e-6) * critical->assembled, d->comm, PETSC_ERR_NOT_CONVERGED,
             "critical step %.6g s by Lanczos iteration, but the stiffest element alone allows %.6g s: give "
             "-ts_dt",
             (double)critical->assembled, (double)critical->element);
  PetscFunctionReturn(0);
}

/* Collective. Each product with K and C costs as much as a step. Masses are the lumped ones of the bodies alone
   (bodies/points/mass.c). */
PetscErrorCode DynamicsFindCriticalStep(Dynamics d)
{
  StepPencil pencil;
  Mat        A;
  EPS        eps;
  Vec        x;

  PetscFunctionBeginUser;
  PetscCall(StepPencilCreate(d, &pencil));
  PetscCall(StepPencilCreateSolver(&pencil, &A, &eps));
  PetscCall(EPSSetFromOptions(eps));
  PetscCall(OperatorsCreateVec(d->operators, &x));
  /* a start with a part along every eigenvector; dt has six digits, so that which one it is does not show */
  PetscCall(VecSetRandom(x, NULL));
  PetscCall(StepPencilFindStep(&pencil, eps, x, d->b, &d->critical));
  PetscCall(CriticalElementStep(d, &d->critical));
  PetscCall(VecDestroy(&x));
  PetscCall(EPSDestroy(&eps));
  PetscCall(MatDestroy(&A));
  PetscCall(PetscFree4(pencil.scale, pencil.x, pencil.kx, pencil.cx));
  PetscFunctionReturn(0);
}
