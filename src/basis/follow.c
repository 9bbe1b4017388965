/*
   One simple eigenvalue of the dense problem, followed from a guess (lambda, x, y) by Newton's method with both vectors
   (A. M. Ostrowski's two-sided Rayleigh quotient iteration; H. Schwetlick, K. Schreiber, Linear Algebra Appl. 436,
   2012, for matrix polynomials):

      Q(lambda) u = Q'(lambda) x,   Q(lambda)^T v = Q'(lambda)^T y,   lambda := lambda - v^T Q' x / (v^T Q' u),

   where v^T Q' x = v^T Q u, so that the step does not multiply by a stiff K; of T(lambda), with materials of the
   frequency, as well. Convergence is cubic: three or four complex factorisations of size n, where all eigenvalues
   with their vectors cost a hundred. Where a step changed lambda by little its factors serve again: that is inverse
   iteration on Q(lambda) + (mu - lambda) Q'(lambda), which differs from Q(mu) by the square of the change.
*/
#include "pencil.h"
#include "base/events.h"

#define FOLLOW_STEPS 10
#define FOLLOW_END   (4 * PETSC_MACHINE_EPSILON) /* relative change of lambda that is none */
#define FOLLOW_SMALL 1e-12                       /* a change that no longer shrinks is rounding below this */
#define FOLLOW_AGAIN 1e-9                        /* relative change up to which factors serve again */

/* Q(at) and its factors */
typedef struct {
  PetscComplex  at, *Q;
  PetscBLASInt *pivot;
} FollowFactors;

void DensePencilEvaluate(const DensePencil *q, PetscComplex lambda, PetscInt first, PetscInt n, PetscComplex Q[])
{
  for (PetscInt j = 0; j < n; j++)
    for (PetscInt i = 0; i < n; i++) {
      const PetscInt at = (first + j) * q->n + first + i;

      Q[j * n + i] = q->K[at] + (q->damped ? lambda * q->C[at] : 0) + lambda * lambda * q->M[at];
    }
  for (PetscInt l = 0; l < q->n_laws; l++) {
    const PetscComplex h = PencilLawAt(q->law[l].law, lambda, NULL);

    for (PetscInt j = 0; j < n; j++)
      for (PetscInt i = 0; i < n; i++) Q[j * n + i] += h * q->law[l].A[(first + j) * q->n + first + i];
  }
}

PetscErrorCode DensePencilDestroy(DensePencil *pencil)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree3(pencil->K, pencil->C, pencil->M));
  PetscFunctionReturn(0);
}

/* z += a op(A) x */
static PetscErrorCode TimesAdd(PetscInt n, const PetscReal A[], PetscComplex a, PetscBool transposed,
                               const PetscComplex x[], PetscComplex z[])
{
  PetscComplex *Ax;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n, &Ax));
  PetscCall(DenseTimes(&(DenseBlock){A, n, n, n}, transposed, 1, x, Ax));
  for (PetscInt i = 0; i < n; i++) z[i] += a * Ax[i];
  PetscCall(PetscFree(Ax));
  PetscFunctionReturn(0);
}

/* z = op(T'(lambda)) x = 2 lambda op(M) x + op(C) x + sum_j h_j' op(A_j) x */
static PetscErrorCode DerivativeApply(const DensePencil *q, PetscComplex lambda, PetscBool transposed,
                                      const PetscComplex x[], PetscComplex z[])
{
  const PetscInt n = q->n;

  PetscFunctionBeginUser;
  PetscCall(DenseTimes(&(DenseBlock){q->M, n, n, n}, transposed, 1, x, z));
  for (PetscInt i = 0; i < n; i++) z[i] *= 2 * lambda;
  if (q->damped) PetscCall(TimesAdd(n, q->C, 1, transposed, x, z));
  for (PetscInt l = 0; l < q->n_laws; l++) {
    PetscComplex slope;

    (void)PencilLawAt(q->law[l].law, lambda, &slope);
    if (slope != 0) PetscCall(TimesAdd(n, q->law[l].A, slope, transposed, x, z));
  }
  PetscFunctionReturn(0);
}

static void Normalise(PetscInt n, PetscComplex x[])
{
  PetscReal square = 0;

  for (PetscInt i = 0; i < n; i++) square += creal(conj(x[i]) * x[i]);
  for (PetscInt i = 0; i < n && square > 0; i++) x[i] /= PetscSqrtReal(square);
}

/* LU of Q(lambda); lambda that is an eigenvalue to the last bit is moved by some of them, but for lambda = 0 */
static PetscErrorCode FactorAt(const DensePencil *q, PetscComplex lambda, FollowFactors *factors, PetscBool *singular)
{
  PetscFunctionBeginUser;
  *singular = PETSC_TRUE;
  for (int attempt = 0; attempt < 3 && *singular; attempt++) {
    if (attempt) lambda *= 1 + 8 * PETSC_MACHINE_EPSILON * attempt;
    DensePencilEvaluate(q, lambda, 0, q->n, factors->Q);
    PetscCall(DenseComplexFactor(q->n, factors->Q, factors->pivot, singular));
  }
  factors->at = lambda;
  PetscFunctionReturn(0);
}

/* One step with the factors: lambda, x, y are replaced; change = |that of lambda|, not finite where y and x have
   nothing in common */
static PetscErrorCode FollowStep(const DensePencil *q, const FollowFactors *factors, PetscComplex *lambda,
                                 PetscComplex x[], PetscComplex y[], PetscReal *change)
{
  const PetscInt     n   = q->n;
  const PetscComplex was = *lambda;
  PetscComplex      *z, *w;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(n, &z, n, &w));
  PetscCall(DerivativeApply(q, factors->at, PETSC_FALSE, x, z));
  PetscCall(PetscArraycpy(x, z, n));
  PetscCall(DenseComplexSolve(n, factors->Q, factors->pivot, PETSC_FALSE, 1, x));
  PetscCall(DerivativeApply(q, factors->at, PETSC_TRUE, y, w));
  PetscCall(PetscArraycpy(y, w, n));
  PetscCall(DenseComplexSolve(n, factors->Q, factors->pivot, PETSC_TRUE, 1, y));
  PetscCall(DerivativeApply(q, factors->at, PETSC_FALSE, x, w));
  *lambda = factors->at - DenseDot(n, y, z) / DenseDot(n, y, w);
  *change = cabs(*lambda - was);
  Normalise(n, x);
  Normalise(n, y);
  PetscCall(PetscFree2(z, w));
  PetscFunctionReturn(0);
}

PetscErrorCode DensePencilFollow(const DensePencil *pencil, PetscComplex *lambda, PetscComplex x[], PetscComplex y[],
                                 PetscBool *found)
{
  const PetscInt n      = pencil->n;
  PetscReal      change = PETSC_MAX_REAL, before;
  FollowFactors  factors;

  PetscFunctionBeginUser;
  PetscCall(EventBegin(EVENT_FOLLOW));
  PetscCall(PetscMalloc2(n * n, &factors.Q, n, &factors.pivot));
  *found = PETSC_FALSE;
  for (int step = 0; step < FOLLOW_STEPS && !*found && isfinite(change); step++) {
    PetscBool singular = PETSC_FALSE;

    before = change;
    if (!(change <= FOLLOW_AGAIN * cabs(*lambda))) PetscCall(FactorAt(pencil, *lambda, &factors, &singular));
    if (singular) break;
    PetscCall(FollowStep(pencil, &factors, lambda, x, y, &change));
    *found = change <= FOLLOW_END * cabs(*lambda) || (change > 0.5 * before && before <= FOLLOW_SMALL * cabs(*lambda))
               ? PETSC_TRUE
               : PETSC_FALSE;
  }
  PetscCall(PetscFree2(factors.Q, factors.pivot));
  PetscCall(EventEnd(EVENT_FOLLOW));
  PetscFunctionReturn(0);
}
