/*
   The quadratic problem (lambda^2 M + lambda C + K) x = 0 in its standard form A z = s B z:

      undamped  z = x,                      s = kappa = -lambda^2, A = K,  B = M
      damped    z = [x; lambda x / scale],  s = lambda,            A = [-K / scale, 0; 0, scale M],
                                                                   B = [C / scale, M; M, 0]

   so that w^T B z = (lambda_w + lambda_z) y^T M x + y^T C x over scale, which is zero between different modes. Left
   vectors have the same form, [y; lambda y / scale].
*/
#include "standard.h"

PetscInt StandardSize(const StandardForm *f)
{
  return f->damped ? 2 * f->n : f->n;
}

/* s of lambda: kappa = -lambda^2, (rad/s)^2, or lambda, rad/s. */
PetscComplex StandardValue(const StandardForm *f, PetscComplex lambda)
{
  return f->damped ? lambda : -lambda * lambda;
}

/* lambda of s, of the two roots that with omega >= 0; a negative kappa gives the growing one, +sqrt(-kappa). */
PetscComplex StandardLambda(const StandardForm *f, PetscComplex s)
{
  const PetscComplex lambda = f->damped ? s : csqrt(-s);

  return cimag(lambda) < 0 ? -lambda : lambda;
}

/* z [N] of x [n]. The second block is divided by scale, rad/s, a frequency of the size of |lambda|, so that both
   blocks are of one size. */
void StandardVector(const StandardForm *f, PetscComplex lambda, const PetscComplex x[], PetscComplex z[])
{
  for (PetscInt i = 0; i < f->n; i++) {
    z[i] = x[i];
    if (f->damped) z[f->n + i] = lambda * x[i] / f->scale;
  }
}

/* y += factor op(A) x, [n] */
static PetscErrorCode AddTimes(const StandardForm *f, const PetscReal A[], PetscBool transposed, PetscReal factor,
                               const PetscComplex x[], PetscComplex y[])
{
  PetscComplex *Ax;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(f->n, &Ax));
  PetscCall(DenseTimes(&(DenseBlock){A, f->n, f->n, f->pencil->n}, transposed, 1, x, Ax));
  for (PetscInt i = 0; i < f->n; i++) y[i] += factor * Ax[i];
  PetscCall(PetscFree(Ax));
  PetscFunctionReturn(0);
}

PetscErrorCode StandardApply(const StandardForm *f, StandardMatrix matrix, PetscBool transposed, PetscInt m,
                             const PetscComplex X[], PetscComplex Y[])
{
  const DensePencil *q = f->pencil;
  const PetscInt     n = f->n, N = StandardSize(f);

  PetscFunctionBeginUser;
  if (!f->damped) {
    PetscCall(DenseTimes(&(DenseBlock){matrix == STANDARD_A ? q->K : q->M, n, n, q->n}, transposed, m, X, Y));
    PetscFunctionReturn(0);
  }
  PetscCall(PetscArrayzero(Y, m * N));
  for (PetscInt a = 0; a < m; a++, X += N, Y += N) {
    if (matrix == STANDARD_A) {
      PetscCall(AddTimes(f, q->K, transposed, -1 / f->scale, X, Y));
      PetscCall(AddTimes(f, q->M, transposed, f->scale, X + n, Y + n));
    } else {
      PetscCall(AddTimes(f, q->C, transposed, 1 / f->scale, X, Y));
      PetscCall(AddTimes(f, q->M, transposed, 1, X + n, Y));
      PetscCall(AddTimes(f, q->M, transposed, 1, X, Y + n));
    }
  }
  PetscFunctionReturn(0);
}

PetscErrorCode StandardProject(const StandardForm *f, PetscInt m, const PetscComplex X[], const PetscComplex Y[],
                               PetscComplex H[], PetscComplex G[])
{
  const PetscInt N = StandardSize(f);
  PetscComplex  *AX, *BX;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(m * N, &AX, m * N, &BX));
  PetscCall(StandardApply(f, STANDARD_A, PETSC_FALSE, m, X, AX));
  PetscCall(StandardApply(f, STANDARD_B, PETSC_FALSE, m, X, BX));
  for (PetscInt i = 0; i < m; i++)
    for (PetscInt j = 0; j < m; j++) {
      H[j * m + i] = DenseDot(N, Y + i * N, AX + j * N);
      G[j * m + i] = DenseDot(N, Y + i * N, BX + j * N);
    }
  PetscCall(PetscFree2(AX, BX));
  PetscFunctionReturn(0);
}
