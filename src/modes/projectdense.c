/*
   The dense quadratic problem (lambda^2 I + lambda C + K) x = 0 of a projection, through A z = mu z with

      A = [0 I; -K / w^2 -C / w],   z = [x; mu x],   lambda = w mu,

   w the upper end of the window, which leaves |mu| <= 1 there. Left vectors: u^H A = mu u^H, y = conj of u's second half.
*/
#include "projection.h"
#include "solver/dense.h"

#define EDGE_POINTS 64 /* on each side of the window's edge, where kappa(lambda) is looked at */

/* A, [2 k * 2 k], column-major */
static void CompanionFill(const Projection *p, PetscReal w, PetscReal A[])
{
  const PetscInt k = p->k, n = 2 * k;

  for (PetscInt j = 0; j < k; j++) {
    A[(k + j) * n + j] = 1;
    for (PetscInt i = 0; i < k; i++) {
      A[j * n + k + i]       = -p->K[j * k + i] / (w * w);
      A[(k + j) * n + k + i] = -p->C[j * k + i] / w;
    }
  }
}

/* Whether an eigenvalue belongs to the window: within its growth, or that of an undamped mode in it */
static PetscBool LambdaIsInside(const Projection *p, PetscComplex lambda)
{
  const Window      *w     = p->window;
  const PetscReal    omega = cimag(lambda);
  const PetscComplex kappa = ProjectionKappa(p, lambda);

  if (w->count) return cabs(kappa - p->si.shift) <= p->reach ? PETSC_TRUE : PETSC_FALSE;
  if (omega < w->edge[0] || omega > w->edge[1]) return PETSC_FALSE;
  if (PetscAbsReal(creal(lambda)) <= w->growth) return PETSC_TRUE;
  return creal(kappa) >= PetscSqr(w->edge[0]) && creal(kappa) <= PetscSqr(w->edge[1]) ? PETSC_TRUE : PETSC_FALSE;
}

static PetscReal LambdaFar(const Projection *p, PetscComplex lambda)
{
  return cabs(ProjectionKappa(p, lambda) - p->si.shift);
}

/* Largest |kappa(lambda) - s| on the edge of the window's claim: |sigma| <= growth, low <= omega <= high; or, d away from
   a target */
static PetscReal EdgeReach(const Projection *p, PetscReal d)
{
  const Window *w       = p->window;
  PetscReal     largest = 0;

  for (int i = 0; i <= EDGE_POINTS; i++) {
    const PetscReal t = (PetscReal)i / EDGE_POINTS, sigma = (2 * t - 1) * w->growth;
    const PetscReal omega = w->low + t * (w->high - w->low);

    if (w->count) {
      const PetscComplex at = CMPLX(d * cos(2 * PETSC_PI * t), w->target + d * sin(2 * PETSC_PI * t));

      largest = PetscMax(largest, LambdaFar(p, at));
      continue;
    }
    largest = PetscMax(largest, PetscMax(LambdaFar(p, CMPLX(sigma, w->low)), LambdaFar(p, CMPLX(sigma, w->high))));
    largest =
      PetscMax(largest, PetscMax(LambdaFar(p, CMPLX(-w->growth, omega)), LambdaFar(p, CMPLX(w->growth, omega))));
  }
  return largest;
}

/* Leaves of the chosen eigenvalues, list [n], the count nearest to the target; *d = distance of the farthest */
static void KeepNearest(const Window *window, const PetscComplex lambda[], PetscInt list[], PetscInt *n, PetscReal *d)
{
  const PetscComplex target = CMPLX(0, window->target);

  for (PetscInt i = 1; i < *n; i++)
    for (PetscInt j = i; j > 0 && cabs(lambda[list[j]] - target) < cabs(lambda[list[j - 1]] - target); j--) {
      const PetscInt swap = list[j];

      list[j]     = list[j - 1];
      list[j - 1] = swap;
    }
  *n = PetscMin(*n, window->count);
  *d = *n ? cabs(lambda[list[*n - 1]] - target) : 0;
}

/* Copies a vector of LAPACK's real storage, scaled to length one; left ones are conjugated */
static void VectorCopy(PetscInt k, const PetscReal *re, const PetscReal *im, PetscBool conjugate, PetscComplex x[])
{
  PetscReal    length = 0;
  PetscComplex square = 0;

  for (PetscInt i = 0; i < k; i++) {
    x[i] = CMPLX(re[i], im ? (conjugate ? -im[i] : im[i]) : 0);
    length += creal(x[i]) * creal(x[i]) + cimag(x[i]) * cimag(x[i]);
    square += x[i] * x[i];
  }
  square = im && cabs(square) > 0 ? conj(csqrt(square / cabs(square))) : 1;
  for (PetscInt i = 0; i < k; i++) x[i] *= square / sqrt(length);
}

/* Room for n modes of a model of this size */
static PetscErrorCode ProjectionModesCreate(PetscInt n, PetscInt size, ProjectionModes *modes)
{
  PetscFunctionBeginUser;
  *modes = (ProjectionModes){.n = n, .size = size};
  PetscCall(PetscMalloc3(n, &modes->lambda, n * size, &modes->vectors[0], n * size, &modes->vectors[1]));
  PetscCall(PetscCalloc2(n, &modes->backward[0], n, &modes->backward[1]));
  PetscFunctionReturn(0);
}

PetscErrorCode ProjectionModesDestroy(ProjectionModes *modes)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree3(modes->lambda, modes->vectors[0], modes->vectors[1]));
  PetscCall(PetscFree2(modes->backward[0], modes->backward[1]));
  PetscFunctionReturn(0);
}

/* Eigenvalues (rad/s) and vectors of the companion form, those of rank 0 on all; L, R [2 k][2 k] */
static PetscErrorCode CompanionSolve(const Projection *p, PetscComplex lambda[], PetscReal L[], PetscReal R[])
{
  const PetscInt  n = 2 * p->k;
  const PetscReal w = PetscMax(PetscMax(p->window->high, p->window->target), PetscSqrtReal(PetscAbsReal(p->si.shift)));
  PetscReal      *A, *wr, *wi;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(n * n, &A));
  PetscCall(PetscMalloc2(n, &wr, n, &wi));
  CompanionFill(p, w, A);
  PetscCall(DenseEigen(n, A, wr, wi, L, R));
  for (PetscInt i = 0; i < n; i++) lambda[i] = w * CMPLX(wr[i], wi[i]);
  PetscCallMPI(MPI_Bcast(lambda, (PetscMPIInt)(2 * n), MPIU_REAL, 0, p->modes->comm));
  PetscCallMPI(MPI_Bcast(L, (PetscMPIInt)(n * n), MPIU_REAL, 0, p->modes->comm));
  PetscCallMPI(MPI_Bcast(R, (PetscMPIInt)(n * n), MPIU_REAL, 0, p->modes->comm));
  PetscCall(PetscFree2(wr, wi));
  PetscCall(PetscFree(A));
  PetscFunctionReturn(0);
}

PetscErrorCode ProjectionEigen(const Projection *p, ProjectionModes *modes)
{
  const PetscInt k = p->k, n = 2 * k;
  PetscComplex  *lambda;
  PetscReal     *L, *R, d = 0;
  PetscInt      *list, m = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc4(n, &lambda, n * n, &L, n * n, &R, n, &list));
  PetscCall(CompanionSolve(p, lambda, L, R));
  for (PetscInt i = 0; i < n; i++)
    if (cimag(lambda[i]) >= 0 && LambdaIsInside(p, lambda[i])) list[m++] = i;
  if (p->window->count) KeepNearest(p->window, lambda, list, &m, &d);
  PetscCall(ProjectionModesCreate(m, k, modes));
  for (PetscInt i = 0; i < m; i++) {
    const PetscInt  at     = list[i] * n;
    const PetscBool paired = cimag(lambda[list[i]]) > 0 ? PETSC_TRUE : PETSC_FALSE;

    modes->lambda[i] = lambda[list[i]];
    VectorCopy(k, &R[at], paired ? &R[at + n] : NULL, PETSC_FALSE, &modes->vectors[0][i * k]);
    VectorCopy(k, &L[at + k], paired ? &L[at + n + k] : NULL, PETSC_TRUE, &modes->vectors[1][i * k]);
  }
  modes->lambda_reach = EdgeReach(p, d);
  PetscCall(PetscFree4(lambda, L, R, list));
  PetscFunctionReturn(0);
}
