/*
   One simple eigenvalue of the dense problem, followed from a guess (lambda, x, y) by Newton's method with both vectors
   (A. M. Ostrowski's two-sided Rayleigh quotient iteration; H. Schwetlick, K. Schreiber, Linear Algebra Appl. 436,
   2012, for matrix polynomials):

      Q(lambda) u = Q'(lambda) x,   Q(lambda)^T v = Q'(lambda)^T y,   lambda := lambda - v^T Q' x / (v^T Q' u),

   where v^T Q' x = v^T Q u, so that the step does not multiply by a stiff K. Convergence is cubic: three or four complex
   factorisations of size n, where all eigenvalues with their vectors cost a hundred.
*/
#include "densepencil.h"
#include "base/events.h"

#define FOLLOW_STEPS 10
#define FOLLOW_END   (4 * PETSC_MACHINE_EPSILON) /* relative change of lambda that is none */
#define FOLLOW_SMALL 1e-12                       /* a change that no longer shrinks is rounding below this */

void DensePencilEvaluate(const DensePencil *q, PetscComplex lambda, PetscInt first, PetscInt n, PetscComplex Q[])
{
  for (PetscInt j = 0; j < n; j++)
    for (PetscInt i = 0; i < n; i++) {
      const PetscInt at = (first + j) * q->n + first + i;

      Q[j * n + i] = q->K[at] + (q->damped ? lambda * q->C[at] : 0) + lambda * lambda * q->M[at];
    }
}

PetscErrorCode DensePencilDestroy(DensePencil *pencil)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree3(pencil->K, pencil->C, pencil->M));
  PetscFunctionReturn(0);
}

/* z = op(Q'(lambda)) x = 2 lambda op(M) x + op(C) x */
static PetscErrorCode DerivativeApply(const DensePencil *q, PetscComplex lambda, PetscBool transposed,
                                      const PetscComplex x[], PetscComplex z[])
{
  const PetscInt n = q->n;
  PetscComplex  *Cx;

  PetscFunctionBeginUser;
  PetscCall(DenseTimes(&(DenseBlock){q->M, n, n, n}, transposed, 1, x, z));
  for (PetscInt i = 0; i < n; i++) z[i] *= 2 * lambda;
  if (!q->damped) PetscFunctionReturn(0);
  PetscCall(PetscMalloc1(n, &Cx));
  PetscCall(DenseTimes(&(DenseBlock){q->C, n, n, n}, transposed, 1, x, Cx));
  for (PetscInt i = 0; i < n; i++) z[i] += Cx[i];
  PetscCall(PetscFree(Cx));
  PetscFunctionReturn(0);
}

static void Normalise(PetscInt n, PetscComplex x[])
{
  PetscReal square = 0;

  for (PetscInt i = 0; i < n; i++) square += creal(conj(x[i]) * x[i]);
  for (PetscInt i = 0; i < n && square > 0; i++) x[i] /= PetscSqrtReal(square);
}

/* LU of Q(lambda); lambda that is an eigenvalue to the last bit is moved by some of them, but for lambda = 0 */
static PetscErrorCode FactorAt(const DensePencil *q, PetscComplex *lambda, PetscComplex Q[], PetscBLASInt pivot[],
                               PetscBool *singular)
{
  PetscFunctionBeginUser;
  *singular = PETSC_TRUE;
  for (int attempt = 0; attempt < 3 && *singular; attempt++) {
    if (attempt) *lambda *= 1 + 8 * PETSC_MACHINE_EPSILON * attempt;
    DensePencilEvaluate(q, *lambda, 0, q->n, Q);
    PetscCall(DenseComplexFactor(q->n, Q, pivot, singular));
  }
  PetscFunctionReturn(0);
}

/* One step: lambda, x, y are replaced; change = |step|, not finite where y and x have nothing in common, or where
   Q(lambda) stays singular and nothing is replaced */
static PetscErrorCode FollowStep(const DensePencil *q, PetscComplex *lambda, PetscComplex x[], PetscComplex y[],
                                 PetscReal *change)
{
  const PetscInt n = q->n;
  PetscComplex  *Q, *z, *w, step;
  PetscBLASInt  *pivot;
  PetscBool      singular;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc4(n * n, &Q, n, &z, n, &w, n, &pivot));
  PetscCall(FactorAt(q, lambda, Q, pivot, &singular));
  if (singular) {
    *change = INFINITY;
    PetscCall(PetscFree4(Q, z, w, pivot));
    PetscFunctionReturn(0);
  }
  PetscCall(DerivativeApply(q, *lambda, PETSC_FALSE, x, z));
  PetscCall(PetscArraycpy(x, z, n));
  PetscCall(DenseComplexSolve(n, Q, pivot, PETSC_FALSE, 1, x));
  PetscCall(DerivativeApply(q, *lambda, PETSC_TRUE, y, w));
  PetscCall(PetscArraycpy(y, w, n));
  PetscCall(DenseComplexSolve(n, Q, pivot, PETSC_TRUE, 1, y));
  PetscCall(DerivativeApply(q, *lambda, PETSC_FALSE, x, w));
  step = DenseDot(n, y, z) / DenseDot(n, y, w);
  *lambda -= step;
  *change = cabs(step);
  Normalise(n, x);
  Normalise(n, y);
  PetscCall(PetscFree4(Q, z, w, pivot));
  PetscFunctionReturn(0);
}

PetscErrorCode DensePencilFollow(const DensePencil *pencil, PetscComplex *lambda, PetscComplex x[], PetscComplex y[],
                                 PetscBool *found)
{
  PetscReal change = PETSC_MAX_REAL, before;

  PetscFunctionBeginUser;
  PetscCall(EventBegin(EVENT_FOLLOW));
  *found = PETSC_FALSE;
  for (int step = 0; step < FOLLOW_STEPS && !*found && isfinite(change); step++) {
    before = change;
    PetscCall(FollowStep(pencil, lambda, x, y, &change));
    *found = change <= FOLLOW_END * cabs(*lambda) || (change > 0.5 * before && before <= FOLLOW_SMALL * cabs(*lambda))
               ? PETSC_TRUE
               : PETSC_FALSE;
  }
  PetscCall(EventEnd(EVENT_FOLLOW));
  PetscFunctionReturn(0);
}
