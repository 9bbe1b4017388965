/*
   Invariant planes of the undamped problem K x = kappa M x. At lock-in two vectors become parallel, while the plane
   that they span, and with it the mean and the discriminant of its two eigenvalues, stay smooth functions of the
   parameter. From vectors that are parallel up to rounding the plane cannot be had; inverse iteration of two columns at
   once,

      X <- orth((K - s M)^-1 M X),   Y <- orth((K - s M)^-T M^T Y),

   finds it to rounding: the error shrinks in each step by the ratio of distances of the pair and of the next eigenvalue
   from the shift s. The shift is kept off the pair, lest the plane be lost to its first vector.
   Reference: G. W. Stewart, J.-G. Sun, Matrix Perturbation Theory, Academic Press 1990, chapter V.
*/
#include "frame.h"
#include <petscblaslapack.h>

#define PARALLEL 1e-12

/* Norm of a column */
static PetscReal ColumnNorm(PetscInt N, const PetscComplex x[])
{
  PetscReal sum = 0;

  for (PetscInt r = 0; r < N; r++) sum += creal(x[r] * conj(x[r]));
  return PetscSqrtReal(sum);
}

static void ColumnsSwap(PetscInt N, PetscComplex a[], PetscComplex b[])
{
  for (PetscInt r = 0; r < N && a != b; r++) {
    const PetscComplex t = a[r];

    a[r] = b[r], b[r] = t;
  }
}

PetscErrorCode ModePlaneOrthonormalise(PetscInt N, PetscInt k, PetscComplex X[])
{
  PetscReal largest = 0;

  PetscFunctionBeginUser;
  for (PetscInt a = 0; a < k; a++) {
    PetscComplex *const x = X + a * N;
    PetscReal           norm;

    for (PetscInt b = a + 1; b < k; b++)
      if (ColumnNorm(N, X + b * N) > ColumnNorm(N, x)) ColumnsSwap(N, x, X + b * N);
    norm = ColumnNorm(N, x);
    if (a == 0) largest = norm;
    for (PetscInt r = 0; r < N; r++) x[r] = norm > PARALLEL * largest ? x[r] / norm : 0;
    for (int twice = 0; twice < 2; twice++) {
      for (PetscInt b = a + 1; b < k; b++) {
        PetscComplex dot = 0;

        for (PetscInt r = 0; r < N; r++) dot += conj(x[r]) * X[b * N + r];
        for (PetscInt r = 0; r < N; r++) X[b * N + r] -= dot * x[r];
      }
    }
  }
  PetscFunctionReturn(0);
}

/* The k leading orthonormal columns of Re and Im of the given k vectors; columns that are missing are filled with
   numbers that have no structure, for the iteration to turn into the plane */
static PetscErrorCode PlaneReal(PetscInt N, PetscInt k, const PetscInt member[], const PetscComplex vectors[],
                                PetscReal X[])
{
  PetscComplex *Z;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(2 * k * N, &Z));
  for (PetscInt a = 0; a < k; a++) {
    for (PetscInt r = 0; r < N; r++) {
      Z[2 * a * N + r]       = creal(vectors[member[a] * N + r]);
      Z[(2 * a + 1) * N + r] = cimag(vectors[member[a] * N + r]);
    }
  }
  PetscCall(ModePlaneOrthonormalise(N, 2 * k, Z));
  for (PetscInt a = 0; a < k; a++) {
    for (PetscInt r = 0; r < N; r++)
      X[a * N + r] = ColumnNorm(N, Z + a * N) > 0 ? creal(Z[a * N + r]) : sin(1.0 + (a + 1.3) * (r + 1.7) * (r + 0.9));
  }
  PetscCall(PetscFree(Z));
  PetscFunctionReturn(0);
}

/* X = op(LU)^-1 op(M) X, then orthonormal; change = how far the plane turned */
static PetscErrorCode PlaneStep(const ModeFrame *f, const PetscReal LU[], const PetscBLASInt pivots[],
                                PetscBool transposed, PetscInt k, PetscReal X[], PetscReal work[], PetscReal *change)
{
  const PetscReal one = 1, zero = 0;
  const char     *op = transposed ? "T" : "N";
  PetscBLASInt    n, columns, info, n_work;
  PetscReal      *tau = work + 3 * k * f->size, *old = work + k * f->size, *query = work + 2 * k * f->size;

  PetscFunctionBeginUser;
  PetscCall(PetscBLASIntCast(f->size, &n));
  PetscCall(PetscBLASIntCast(k, &columns));
  n_work = n * columns;
  PetscCall(PetscArraycpy(old, X, k * f->size));
  PetscCallBLAS("BLASgemm", BLASgemm_(op, "N", &n, &columns, &n, &one, f->M, &n, X, &n, &zero, work, &n));
  PetscCallBLAS("LAPACKgetrs", LAPACKgetrs_(op, &n, &columns, LU, &n, pivots, work, &n, &info));
  PetscCall(PetscArraycpy(X, work, k * f->size));
  PetscCallBLAS("LAPACKgeqrf", LAPACKgeqrf_(&n, &columns, X, &n, tau, query, &n_work, &info));
  PetscCallBLAS("LAPACKorgqr", LAPACKorgqr_(&n, &columns, &columns, X, &n, tau, query, &n_work, &info));
  /* |old - X X' old| */
  PetscCallBLAS("BLASgemm", BLASgemm_("T", "N", &columns, &columns, &n, &one, X, &n, old, &n, &zero, tau, &columns));
  *change = 0;
  for (PetscInt a = 0; a < k; a++) {
    for (PetscInt r = 0; r < f->size; r++) {
      PetscReal rest = old[a * f->size + r];

      for (PetscInt b = 0; b < k; b++) rest -= X[b * f->size + r] * tau[a * k + b];
      *change = PetscMax(*change, PetscAbsReal(rest));
    }
  }
  PetscFunctionReturn(0);
}

PetscErrorCode ModePlaneIterate(const ModeFrame *f, PetscReal shift, PetscInt k, PetscReal X[], PetscReal Y[])
{
  const PetscInt size = f->size;
  PetscReal     *LU, *work, change_x = 1, change_y = 1;
  PetscBLASInt  *pivots, n, info;

  PetscFunctionBeginUser;
  PetscCall(PetscBLASIntCast(size, &n));
  PetscCall(PetscMalloc3(size * size, &LU, size, &pivots, 3 * k * size + k * (k + 1), &work));
  for (PetscInt r = 0; r < size * size; r++) LU[r] = f->K[r] - shift * f->M[r];
  PetscCallBLAS("LAPACKgetrf", LAPACKgetrf_(&n, &n, LU, &n, pivots, &info));
  PetscCheck(info >= 0, PETSC_COMM_SELF, PETSC_ERR_LIB, "LAPACK getrf: info %d", (int)info);
  for (int step = 0; step < 40 && info == 0 && PetscMax(change_x, change_y) > 1e-15; step++) {
    const PetscReal before = PetscMax(change_x, change_y);

    PetscCall(PlaneStep(f, LU, pivots, PETSC_FALSE, k, X, work, &change_x));
    PetscCall(PlaneStep(f, LU, pivots, PETSC_TRUE, k, Y, work, &change_y));
    if (step > 3 && before < 1e-12 && PetscMax(change_x, change_y) > 0.3 * before) break;
  }
  PetscCall(PetscFree3(LU, pivots, work));
  PetscFunctionReturn(0);
}

/* A shift off the plane's eigenvalues and much closer to them than any other; false where there is none, which is when
   the eigenvalues of the plane are far apart and the given vectors good */
static PetscBool PlaneShift(const ModeFrame *f, PetscInt k, const PetscInt member[], PetscReal *shift)
{
  PetscReal mean = 0, distance = PETSC_MAX_REAL, spread = 0, offset;

  for (PetscInt a = 0; a < k; a++) mean += creal(ModeFrameEigenvalue(f, f->modes.lambda[member[a]])) / k;
  for (PetscInt i = 0; i < f->modes.n; i++) {
    const PetscReal from_mean = cabs(ModeFrameEigenvalue(f, f->modes.lambda[i]) - mean);
    PetscBool       inside    = PETSC_FALSE;

    for (PetscInt a = 0; a < k; a++) inside = (PetscBool)(inside || member[a] == i);
    if (inside)
      spread = PetscMax(spread, from_mean);
    else
      distance = PetscMin(distance, from_mean);
  }
  offset = PetscMax(1e-3 * PetscMax(PetscAbsReal(mean), 1e-6 * PetscSqr(f->scale)), 3 * spread);
  offset = PetscMin(offset, PetscMax(0.05 * distance, 1.5 * spread));
  *shift = mean + offset;
  return spread + offset < 0.3 * distance ? PETSC_TRUE : PETSC_FALSE;
}

PetscErrorCode ModePlaneRefine(const ModeFrame *f, PetscInt k, const PetscInt member[], PetscReal X[], PetscReal Y[])
{
  PetscReal shift;

  PetscFunctionBeginUser;
  PetscCall(PlaneReal(f->size, k, member, f->modes.x, X));
  PetscCall(PlaneReal(f->size, k, member, f->modes.y, Y));
  if (f->refine && PlaneShift(f, k, member, &shift)) PetscCall(ModePlaneIterate(f, shift, k, X, Y));
  PetscFunctionReturn(0);
}
