/*
   The dense problem Q(lambda) x = (lambda^2 M + lambda C + K) x = 0, y^T Q(lambda) = 0, by shift and invert about a
   real shift s > 0 with P = Q(s) (P = K + s^2 M without damping):

      undamped  P^-1 M x = theta x,                        kappa = -lambda^2 = 1 / theta - s^2,  y = P^-T w
      damped    [0 I; -P^-1 s^2 M, -P^-1 (2 s^2 M + s C)] [x; theta x] = theta [x; theta x],
                lambda = s (1 + 1 / theta),                                                     y = P^-T b

   where w is the left vector of P^-1 M and b the second block of that of the companion matrix. (Put lambda = s (1 +
   nu): nu^2 s^2 M + nu (2 s^2 M + s C) + P = 0, theta = 1 / nu. For a left vector [a; b] the first column of the
   companion equation gives theta a^T = -b^T P^-1 s^2 M, and theta times the second b^T P^-1 (theta^2 P + theta (2 s^2
   M + s C) + s^2 M) = 0.)

   Contact makes K stiff: largest eigenvalues of K x = kappa M x may be 1e14 times those looked for, and QR iterations
   on M^-1 K leave errors of eps times the largest. Here they are eps (kappa + s^2)^2 / (kappa_min + s^2), whatever the
   largest; s^2 between the ends of the window makes that small for all of it. What remains is what rounding in the
   given K does, which callers estimate.

   With laws of materials each is held at its reference frequency w, where its complex stiffness is known exactly,

      (lambda^2 M + lambda C_0 + K_0) x = 0,   K_0 = K + sum_j (G_j(i w) - Re at_j) A_j,

   at_j what K and C have of G_j, in complex arithmetic about the same shifts. C_0, which is C - sum_j Im at_j / w A_j,
   is what else damps; where nothing does the problem is linear in lambda^2, of size n. With hysteretic damping alone
   this is the problem itself for Im lambda > 0. Below the real axis its eigenvalues are those of no material.
*/
#include "pencil.h"

#define FROZEN_NONE 1e-12 /* of the entries of C: less of C_0 is rounding */
#define ON_SHIFT    1e3   /* an eigenvalue nearer to the shift than 1 / this of it spoils the others: another shift */

static PetscErrorCode DenseShiftedCreate(const DensePencil *pencil, PetscReal shift, DenseShifted *w)
{
  PetscFunctionBeginUser;
  w->pencil = pencil;
  w->n      = pencil->n;
  w->N      = pencil->damped ? 2 * w->n : w->n;
  w->shift  = shift;
  PetscCall(PetscMalloc2(w->n * w->n, &w->P, w->n, &w->pivot));
  PetscCall(DenseSchurCreate(w->N, &w->schur));
  PetscFunctionReturn(0);
}

void DensePencilAt(const DensePencil *q, PetscReal linear, PetscReal square, PetscReal P[])
{
  for (PetscInt i = 0; i < q->n * q->n; i++) P[i] = q->K[i] + (q->damped ? linear * q->C[i] : 0) + square * q->M[i];
}

/* Symmetric: M x = theta P x, x in place of Z; definite is false where P is not */
static PetscErrorCode SolveSymmetric(DenseShifted *w, PetscBool *definite)
{
  PetscFunctionBeginUser;
  DensePencilAt(w->pencil, w->shift, w->shift * w->shift, w->P);
  PetscCall(PetscArraycpy(w->schur.Z, w->pencil->M, w->n * w->n));
  PetscCall(DenseSymmetricEigen(w->n, w->schur.Z, w->P, w->schur.wr, definite));
  PetscFunctionReturn(0);
}

PetscErrorCode DenseCompanion(const DensePencil *q, const PetscReal s[2], PetscReal P[], PetscBLASInt pivot[],
                              PetscReal B[], PetscBool *singular)
{
  const PetscInt n = q->n, N = q->damped ? 2 * n : n;
  PetscReal     *row; /* lower half, [N][n] */

  PetscFunctionBeginUser;
  DensePencilAt(q, s[0], s[1], P);
  PetscCall(DenseFactor(n, P, pivot, singular));
  if (singular && *singular) PetscFunctionReturn(0);
  if (!q->damped) {
    PetscCall(PetscArraycpy(B, q->M, n * n));
    PetscCall(DenseSolve(n, P, pivot, PETSC_FALSE, n, B));
    PetscFunctionReturn(0);
  }
  PetscCall(PetscMalloc1(n * N, &row));
  for (PetscInt i = 0; i < n * n; i++) {
    row[i]         = -s[1] * q->M[i];
    row[n * n + i] = -(2 * s[1] * q->M[i] + s[0] * q->C[i]);
  }
  PetscCall(DenseSolve(n, P, pivot, PETSC_FALSE, N, row));
  PetscCall(PetscArrayzero(B, N * N));
  for (PetscInt i = 0; i < n; i++) B[(n + i) * N + i] = 1;
  for (PetscInt j = 0; j < N; j++) PetscCall(PetscArraycpy(B + j * N + n, row + j * n, n));
  PetscCall(PetscFree(row));
  PetscFunctionReturn(0);
}

/* General: the standard problem */
static PetscErrorCode SolveGeneral(DenseShifted *w, PetscBool *singular)
{
  PetscFunctionBeginUser;
  PetscCall(
    DenseCompanion(w->pencil, (PetscReal[2]){w->shift, w->shift * w->shift}, w->P, w->pivot, w->schur.T, singular));
  if (!*singular) PetscCall(DenseSchurForm(&w->schur));
  PetscFunctionReturn(0);
}

/* Whether an eigenvalue lies on the shift: |theta| s^2 (undamped), |theta| (damped) are about one otherwise */
static PetscBool IsOnShift(const DenseShifted *w)
{
  const PetscReal unit = w->pencil->damped ? 1 : w->shift * w->shift;

  for (PetscInt i = 0; i < w->N; i++)
    if (hypot(w->schur.wr[i], w->schur.wi[i]) * unit > ON_SHIFT) return PETSC_TRUE;
  return PETSC_FALSE;
}

PetscErrorCode DenseShiftedSolve(const DensePencil *pencil, PetscReal shift, DenseShifted *w)
{
  PetscBool bad = PETSC_TRUE;

  PetscFunctionBeginUser;
  PetscCall(DenseShiftedCreate(pencil, shift, w));
  for (int attempt = 0; attempt < 12 && bad; attempt++) {
    if (attempt) w->shift *= 1.7;
    if (pencil->symmetric) {
      PetscCall(SolveSymmetric(w, &bad));
      bad = bad ? PETSC_FALSE : PETSC_TRUE;
    } else {
      PetscCall(SolveGeneral(w, &bad));
    }
    if (!bad) bad = IsOnShift(w);
  }
  PetscCheck(!bad, PETSC_COMM_SELF, PETSC_ERR_NOT_CONVERGED,
             "dense pencil of size %" PetscInt_FMT ": no shift up to %.6g rad/s at which it is regular", w->n,
             (double)w->shift);
  PetscFunctionReturn(0);
}

PetscBool DenseShiftedLambda(const DenseShifted *w, PetscInt i, PetscComplex *lambda)
{
  const PetscReal    wr = w->schur.wr[i], wi = w->schur.wi[i];
  const PetscComplex theta = CMPLX(wr, wi);
  PetscComplex       kappa;

  if (theta == 0) return PETSC_FALSE;
  if (w->pencil->damped) {
    *lambda = wi == 0 ? CMPLX(w->shift * (1 + 1 / wr), 0) : w->shift * (1 + 1 / theta);
    return cimag(*lambda) >= 0 ? PETSC_TRUE : PETSC_FALSE;
  }
  if (wi == 0) {
    const PetscReal real = 1 / wr - w->shift * w->shift;

    *lambda = real > 0 ? CMPLX(0, PetscSqrtReal(real)) : CMPLX(PetscSqrtReal(-real), 0);
    return PETSC_TRUE;
  }
  kappa   = 1 / theta - w->shift * w->shift;
  *lambda = csqrt(-kappa);
  if (cimag(*lambda) < 0) *lambda = -*lambda;
  return PETSC_TRUE;
}

/* Rows of vector i from offset on, x [n]; conjugate for left vectors */
static PetscErrorCode VectorGet(const DenseShifted *w, PetscInt i, PetscInt offset, PetscBool left, PetscComplex x[])
{
  const PetscReal wi = w->schur.wi[i], sign = (wi > 0 ? 1 : -1) * (left ? -1 : 1);
  PetscReal      *v;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(2 * w->N, &v));
  PetscCall(DenseSchurVector(&w->schur, wi < 0 ? i - 1 : i, left, v));
  for (PetscInt k = 0; k < w->n; k++) x[k] = CMPLX(v[offset + k], wi == 0 ? 0 : sign * v[w->N + offset + k]);
  PetscCall(PetscFree(v));
  PetscFunctionReturn(0);
}

PetscErrorCode DenseShiftedRight(const DenseShifted *w, PetscInt i, PetscComplex x[])
{
  PetscFunctionBeginUser;
  if (!w->pencil->symmetric) PetscCall(VectorGet(w, i, 0, PETSC_FALSE, x));
  for (PetscInt k = 0; k < w->n && w->pencil->symmetric; k++) x[k] = w->schur.Z[i * w->n + k];
  PetscFunctionReturn(0);
}

PetscErrorCode DenseShiftedLeft(const DenseShifted *w, PetscInt i, PetscComplex y[])
{
  const PetscInt n = w->n;
  PetscReal     *parts;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(2 * n, &parts));
  PetscCall(VectorGet(w, i, w->N - n, PETSC_TRUE, y));
  DenseSplit(n, y, parts);
  PetscCall(DenseSolve(n, w->P, w->pivot, PETSC_TRUE, 2, parts));
  DenseUnite(n, parts, y);
  PetscCall(PetscFree(parts));
  PetscFunctionReturn(0);
}

PetscErrorCode DenseShiftedDestroy(DenseShifted *w)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree2(w->P, w->pivot));
  PetscCall(DenseSchurDestroy(&w->schur));
  PetscFunctionReturn(0);
}

/* K_0 and C_0; damped = C_0 is not zero */
static void FrozenForm(const DensePencil *q, PetscReal C[], PetscComplex K[], PetscBool *damped)
{
  const PetscInt square  = q->n * q->n;
  PetscReal      largest = 0, rest = 0;

  for (PetscInt i = 0; i < square; i++) {
    K[i]    = q->K[i];
    C[i]    = q->damped ? q->C[i] : 0;
    largest = PetscMax(largest, PetscAbsReal(C[i]));
  }
  for (PetscInt l = 0; l < q->n_laws; l++) {
    PencilLaw    held = *q->law[l].law;
    PetscComplex h, slope;

    held.held = 1;
    h         = PencilLawAt(&held, CMPLX(0, held.reference), &slope); /* h_0 = h + (lambda - i w) slope */
    h -= CMPLX(0, held.reference) * slope;
    for (PetscInt i = 0; i < square; i++) {
      K[i] += h * q->law[l].A[i];
      C[i] += creal(slope) * q->law[l].A[i];
    }
  }
  for (PetscInt i = 0; i < square; i++) rest = PetscMax(rest, PetscAbsReal(C[i]));
  *damped = rest > FROZEN_NONE * largest ? PETSC_TRUE : PETSC_FALSE;
}

/* The companion matrix about the shift in B [N * N], factors of P */
static PetscErrorCode FrozenCompanion(DenseFrozen *f, const DensePencil *q, const PetscReal C[], PetscComplex B[])
{
  const PetscInt  n = f->n, N = f->N, first = N - n;
  const PetscReal s = f->shift;
  PetscComplex   *row; /* [N][n] */

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < n * n; i++) f->P[i] += s * s * q->M[i] + (f->damped ? s * C[i] : 0);
  PetscCall(DenseComplexFactor(n, f->P, f->pivot, NULL));
  PetscCall(PetscMalloc1(n * N, &row));
  for (PetscInt i = 0; i < n * n; i++) row[i] = f->damped ? -s * s * q->M[i] : q->M[i];
  for (PetscInt i = 0; i < n * n && f->damped; i++) row[n * n + i] = -(2 * s * s * q->M[i] + s * C[i]);
  PetscCall(DenseComplexSolve(n, f->P, f->pivot, PETSC_FALSE, N, row));
  PetscCall(PetscArrayzero(B, N * N));
  for (PetscInt i = 0; i < first; i++) B[(n + i) * N + i] = 1;
  for (PetscInt j = 0; j < N; j++) PetscCall(PetscArraycpy(B + j * N + first, row + j * n, n));
  PetscCall(PetscFree(row));
  PetscFunctionReturn(0);
}

PetscErrorCode DenseFrozenSolve(MPI_Comm comm, const DensePencil *pencil, PetscReal shift, PetscBool vectors,
                                DenseFrozen *f)
{
  const PetscInt n = pencil->n;
  PetscReal     *C;
  PetscComplex  *B;

  PetscFunctionBeginUser;
  *f = (DenseFrozen){.n = n, .N = n, .shift = shift};
  PetscCall(PetscMalloc1(n * n, &C));
  PetscCall(PetscMalloc2(n * n, &f->P, n, &f->pivot));
  FrozenForm(pencil, C, f->P, &f->damped);
  PetscCallMPI(MPI_Bcast(&f->damped, 1, MPIU_BOOL, 0, comm));
  if (f->damped) f->N = 2 * n;
  PetscCall(PetscMalloc1(f->N * f->N, &B));
  PetscCall(PetscMalloc1(f->N, &f->theta));
  PetscCall(FrozenCompanion(f, pencil, C, B));
  if (vectors) PetscCall(PetscMalloc2(f->N * f->N, &f->left, f->N * f->N, &f->right));
  PetscCall(DenseComplexEigen(f->N, B, f->theta, f->left, f->right));
  PetscCall(PetscFree(B));
  PetscCall(PetscFree(C));
  PetscFunctionReturn(0);
}

PetscBool DenseFrozenLambda(const DenseFrozen *f, PetscInt i, PetscComplex *lambda)
{
  const PetscComplex theta = f->theta[i];

  if (theta == 0) return PETSC_FALSE;
  *lambda = f->damped ? f->shift * (1 + 1 / theta) : csqrt(f->shift * f->shift - 1 / theta);
  if (!f->damped && cimag(*lambda) < 0) *lambda = -*lambda;
  return PETSC_TRUE;
}

void DenseFrozenRight(const DenseFrozen *f, PetscInt i, PetscComplex x[])
{
  for (PetscInt k = 0; k < f->n; k++) x[k] = f->right[i * f->N + k];
}

PetscErrorCode DenseFrozenLeft(const DenseFrozen *f, PetscInt i, PetscComplex y[])
{
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < f->n; k++) y[k] = conj(f->left[i * f->N + f->N - f->n + k]);
  PetscCall(DenseComplexSolve(f->n, f->P, f->pivot, PETSC_TRUE, 1, y));
  PetscFunctionReturn(0);
}

PetscErrorCode DenseFrozenDestroy(DenseFrozen *f)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree2(f->P, f->pivot));
  PetscCall(PetscFree(f->theta));
  PetscCall(PetscFree2(f->left, f->right));
  PetscFunctionReturn(0);
}
