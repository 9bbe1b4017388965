/*
   Small dense problems by LAPACK: getrf, getrs, gelss, geev, syev, sygv, ggev, pstrf. PETSc with real scalars declares
   the real routines only, and not pstrf; the others are declared here.
*/
#include "base/algebra/dense.h"
#include <petscblaslapack.h>

#define LAPACKzgetrf_ PETSCBLASCOMPLEX(getrf, GETRF)
#define LAPACKzgetrs_ PETSCBLASCOMPLEX(getrs, GETRS)
#define LAPACKzggev_  PETSCBLASCOMPLEX(ggev, GGEV)
#define LAPACKzgeev_  PETSCBLASCOMPLEX(geev, GEEV)
#define LAPACKpstrf_  PETSCBLAS(pstrf, PSTRF)
#define BLASzgemm_    PETSCBLASCOMPLEX(gemm, GEMM)

BLAS_EXTERN void LAPACKzgetrf_(const PetscBLASInt *, const PetscBLASInt *, PetscComplex *, const PetscBLASInt *,
                               PetscBLASInt *, PetscBLASInt *);
BLAS_EXTERN void LAPACKzgetrs_(const char *, const PetscBLASInt *, const PetscBLASInt *, const PetscComplex *,
                               const PetscBLASInt *, const PetscBLASInt *, PetscComplex *, const PetscBLASInt *,
                               PetscBLASInt *);
BLAS_EXTERN void LAPACKzggev_(const char *, const char *, const PetscBLASInt *, PetscComplex *, const PetscBLASInt *,
                              PetscComplex *, const PetscBLASInt *, PetscComplex *, PetscComplex *, PetscComplex *,
                              const PetscBLASInt *, PetscComplex *, const PetscBLASInt *, PetscComplex *,
                              const PetscBLASInt *, PetscReal *, PetscBLASInt *);
BLAS_EXTERN void LAPACKzgeev_(const char *, const char *, const PetscBLASInt *, PetscComplex *, const PetscBLASInt *,
                              PetscComplex *, PetscComplex *, const PetscBLASInt *, PetscComplex *,
                              const PetscBLASInt *, PetscComplex *, const PetscBLASInt *, PetscReal *, PetscBLASInt *);
BLAS_EXTERN void BLASzgemm_(const char *, const char *, const PetscBLASInt *, const PetscBLASInt *,
                            const PetscBLASInt *, const PetscComplex *, const PetscComplex *, const PetscBLASInt *,
                            const PetscComplex *, const PetscBLASInt *, const PetscComplex *, PetscComplex *,
                            const PetscBLASInt *);
BLAS_EXTERN void LAPACKpstrf_(const char *, const PetscBLASInt *, PetscReal *, const PetscBLASInt *, PetscBLASInt *,
                              PetscBLASInt *, const PetscReal *, PetscReal *, PetscBLASInt *);

/* Reports a zero pivot to the caller, or stops */
static PetscErrorCode PivotCheck(PetscBLASInt info, PetscBool *singular)
{
  PetscFunctionBeginUser;
  PetscCheck(info >= 0, PETSC_COMM_SELF, PETSC_ERR_LIB, "LAPACK getrf: info %d", (int)info);
  PetscCheck(!info || singular, PETSC_COMM_SELF, PETSC_ERR_MAT_LU_ZRPVT, "Dense matrix is singular at row %d",
             (int)info);
  if (singular) *singular = info ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(0);
}

PetscErrorCode DenseFactor(PetscInt size, PetscReal A[], PetscBLASInt pivot[], PetscBool *singular)
{
  PetscBLASInt n, info;

  PetscFunctionBeginUser;
  PetscCall(PetscBLASIntCast(size, &n));
  PetscCallBLAS("LAPACKgetrf", LAPACKgetrf_(&n, &n, A, &n, pivot, &info));
  PetscCall(PivotCheck(info, singular));
  PetscFunctionReturn(0);
}

PetscErrorCode DenseChoose(PetscInt size, PetscReal A[], PetscReal tolerance, PetscInt *rank, PetscInt chosen[])
{
  PetscBLASInt n, found, info, *pivot;
  PetscReal   *work;

  PetscFunctionBeginUser;
  PetscCall(PetscBLASIntCast(size, &n));
  PetscCall(PetscMalloc2(size, &pivot, 2 * size, &work));
  PetscCallBLAS("LAPACKpstrf", LAPACKpstrf_("L", &n, A, &n, pivot, &found, &tolerance, work, &info));
  PetscCheck(info >= 0, PETSC_COMM_SELF, PETSC_ERR_LIB, "LAPACK pstrf: info %d", (int)info);
  *rank = found;
  for (PetscInt i = 0; i < found; i++) chosen[i] = pivot[i] - 1;
  PetscCall(PetscFree2(pivot, work));
  PetscFunctionReturn(0);
}

PetscErrorCode DenseSolve(PetscInt size, const PetscReal LU[], const PetscBLASInt pivot[], PetscBool transposed,
                          PetscInt m, PetscReal B[])
{
  PetscBLASInt n, nrhs, info;

  PetscFunctionBeginUser;
  PetscCall(PetscBLASIntCast(size, &n));
  PetscCall(PetscBLASIntCast(m, &nrhs));
  PetscCallBLAS("LAPACKgetrs", LAPACKgetrs_(transposed ? "T" : "N", &n, &nrhs, (PetscReal *)LU, &n,
                                            (PetscBLASInt *)pivot, B, &n, &info));
  PetscCheck(!info, PETSC_COMM_SELF, PETSC_ERR_LIB, "LAPACK getrs: info %d", (int)info);
  PetscFunctionReturn(0);
}

PetscErrorCode DenseSolveWith(PetscInt size, PetscReal A[], PetscInt m, PetscReal B[], PetscBool *singular)
{
  PetscBLASInt *pivot;
  PetscBool     none = PETSC_FALSE;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(size, &pivot));
  PetscCall(DenseFactor(size, A, pivot, singular ? &none : NULL));
  if (!none) PetscCall(DenseSolve(size, A, pivot, PETSC_FALSE, m, B));
  if (singular) *singular = none;
  PetscCall(PetscFree(pivot));
  PetscFunctionReturn(0);
}

PetscErrorCode DenseLeast(PetscInt rows, PetscInt columns, PetscReal A[], PetscReal b[], PetscReal rcond,
                          PetscInt *rank)
{
  const PetscInt     most = PetscMax(1, PetscMax(rows, columns));
  const PetscBLASInt one  = 1;
  PetscBLASInt       m, n, ldb, found, work_size, info;
  PetscReal         *singular, *work;

  PetscFunctionBeginUser;
  PetscCall(PetscBLASIntCast(rows, &m));
  PetscCall(PetscBLASIntCast(columns, &n));
  PetscCall(PetscBLASIntCast(most, &ldb));
  PetscCall(PetscBLASIntCast(10 * most, &work_size));
  PetscCall(PetscMalloc2(most, &singular, 10 * most, &work));
  PetscCallBLAS("LAPACKgelss",
                LAPACKgelss_(&m, &n, &one, A, &m, b, &ldb, singular, &rcond, &found, work, &work_size, &info));
  PetscCheck(info >= 0 && (!info || rank), PETSC_COMM_SELF, PETSC_ERR_LIB, "LAPACK gelss: info %d", (int)info);
  if (rank) *rank = info ? -1 : found;
  PetscCall(PetscFree2(singular, work));
  PetscFunctionReturn(0);
}

PetscErrorCode DenseComplexFactor(PetscInt size, PetscComplex A[], PetscBLASInt pivot[], PetscBool *singular)
{
  PetscBLASInt n, info;

  PetscFunctionBeginUser;
  PetscCall(PetscBLASIntCast(size, &n));
  PetscCallBLAS("LAPACKzgetrf", LAPACKzgetrf_(&n, &n, A, &n, pivot, &info));
  PetscCall(PivotCheck(info, singular));
  PetscFunctionReturn(0);
}

PetscErrorCode DenseComplexSolve(PetscInt size, const PetscComplex LU[], const PetscBLASInt pivot[],
                                 PetscBool transposed, PetscInt m, PetscComplex B[])
{
  PetscBLASInt n, nrhs, info;

  PetscFunctionBeginUser;
  PetscCall(PetscBLASIntCast(size, &n));
  PetscCall(PetscBLASIntCast(m, &nrhs));
  PetscCallBLAS("LAPACKzgetrs", LAPACKzgetrs_(transposed ? "T" : "N", &n, &nrhs, LU, &n, pivot, B, &n, &info));
  PetscCheck(!info, PETSC_COMM_SELF, PETSC_ERR_LIB, "LAPACK getrs: info %d", (int)info);
  PetscFunctionReturn(0);
}

PetscErrorCode DenseEigen(PetscInt size, PetscReal A[], PetscReal wr[], PetscReal wi[], PetscReal L[], PetscReal R[])
{
  PetscBLASInt n, work_size, info;
  PetscReal   *work;

  PetscFunctionBeginUser;
  PetscCall(PetscBLASIntCast(size, &n));
  PetscCall(PetscBLASIntCast(66 * size + 64, &work_size)); /* blocks of 64 columns */
  PetscCall(PetscMalloc1(work_size, &work));
  PetscCallBLAS("LAPACKgeev",
                LAPACKgeev_(L ? "V" : "N", R ? "V" : "N", &n, A, &n, wr, wi, L, &n, R, &n, work, &work_size, &info));
  PetscCheck(!info, PETSC_COMM_SELF, PETSC_ERR_NOT_CONVERGED, "LAPACK geev: info %d", (int)info);
  PetscCall(PetscFree(work));
  PetscFunctionReturn(0);
}

PetscErrorCode DenseComplexEigen(PetscInt size, PetscComplex A[], PetscComplex w[], PetscComplex L[], PetscComplex R[])
{
  PetscBLASInt  n, work_size, info;
  PetscComplex *work;
  PetscReal    *work_real;

  PetscFunctionBeginUser;
  PetscCall(PetscBLASIntCast(size, &n));
  PetscCall(PetscBLASIntCast(66 * size + 64, &work_size)); /* blocks of 64 columns */
  PetscCall(PetscMalloc2(work_size, &work, 2 * size, &work_real));
  PetscCallBLAS("LAPACKzgeev", LAPACKzgeev_(L ? "V" : "N", R ? "V" : "N", &n, A, &n, w, L, &n, R, &n, work, &work_size,
                                            work_real, &info));
  PetscCheck(!info, PETSC_COMM_SELF, PETSC_ERR_NOT_CONVERGED, "LAPACK geev: info %d", (int)info);
  PetscCall(PetscFree2(work, work_real));
  PetscFunctionReturn(0);
}

PetscErrorCode DenseSymmetricEigen(PetscInt size, PetscReal A[], PetscReal B[], PetscReal w[], PetscBool *definite)
{
  const PetscBLASInt type = 1;
  PetscBLASInt       n, work_size, info;
  PetscReal         *work;

  PetscFunctionBeginUser;
  PetscCall(PetscBLASIntCast(size, &n));
  PetscCall(PetscBLASIntCast(66 * size + 64, &work_size));
  PetscCall(PetscMalloc1(work_size, &work));
  if (B)
    PetscCallBLAS("LAPACKsygv", LAPACKsygv_(&type, "V", "U", &n, A, &n, B, &n, w, work, &work_size, &info));
  else
    PetscCallBLAS("LAPACKsyev", LAPACKsyev_("V", "U", &n, A, &n, w, work, &work_size, &info));
  PetscCheck(info >= 0 && (info == 0 || (B && info > n)), PETSC_COMM_SELF, PETSC_ERR_NOT_CONVERGED,
             "LAPACK syev, sygv: info %d", (int)info);
  if (definite) *definite = info ? PETSC_FALSE : PETSC_TRUE;
  PetscCall(PetscFree(work));
  PetscFunctionReturn(0);
}

PetscErrorCode DenseComplexProducts(PetscInt n, PetscInt rows, const PetscComplex A[], PetscInt columns,
                                    const PetscComplex B[], PetscComplex C[])
{
  const PetscComplex one = 1, zero = 0;
  PetscBLASInt       k, m, l;

  PetscFunctionBeginUser;
  PetscCall(PetscBLASIntCast(n, &k));
  PetscCall(PetscBLASIntCast(rows, &m));
  PetscCall(PetscBLASIntCast(columns, &l));
  PetscCallBLAS("BLASzgemm", BLASzgemm_("T", "N", &m, &l, &k, &one, A, &k, B, &k, &zero, C, &m));
  PetscFunctionReturn(0);
}

PetscErrorCode DenseComplexEigenvalues(PetscInt size, PetscComplex A[], PetscComplex B[], PetscComplex w[])
{
  const PetscBLASInt one = 1;
  PetscBLASInt       n, work_size, info;
  PetscComplex      *beta, *work;
  PetscReal         *work_real;

  PetscFunctionBeginUser;
  PetscCall(PetscBLASIntCast(size, &n));
  PetscCall(PetscBLASIntCast(33 * size, &work_size));
  PetscCall(PetscMalloc3(size, &beta, work_size, &work, 8 * size, &work_real));
  PetscCallBLAS("LAPACKzggev", LAPACKzggev_("N", "N", &n, A, &n, B, &n, w, beta, NULL, &one, NULL, &one, work,
                                            &work_size, work_real, &info));
  PetscCheck(!info, PETSC_COMM_SELF, PETSC_ERR_NOT_CONVERGED, "LAPACK ggev: info %d", (int)info);
  for (PetscInt i = 0; i < size; i++) w[i] = beta[i] == 0 ? CMPLX(INFINITY, 0) : w[i] / beta[i];
  PetscCall(PetscFree3(beta, work, work_real));
  PetscFunctionReturn(0);
}

void DenseSplit(PetscInt n, const PetscComplex x[], PetscReal parts[])
{
  for (PetscInt i = 0; i < n; i++) parts[i] = creal(x[i]), parts[n + i] = cimag(x[i]);
}

void DenseUnite(PetscInt n, const PetscReal parts[], PetscComplex x[])
{
  for (PetscInt i = 0; i < n; i++) x[i] = CMPLX(parts[i], parts[n + i]);
}

PetscErrorCode DenseTimes(const DenseBlock *block, PetscBool transposed, PetscInt m, const PetscComplex X[],
                          PetscComplex Y[])
{
  const PetscInt  rows = block->rows, columns = block->columns;
  const PetscReal one = 1, zero = 0;
  PetscReal      *x, *y;
  PetscBLASInt    r, c, lda, m2;

  PetscFunctionBeginUser;
  if (!rows || !columns || !m) PetscFunctionReturn(0);
  PetscCall(PetscBLASIntCast(rows, &r));
  PetscCall(PetscBLASIntCast(columns, &c));
  PetscCall(PetscBLASIntCast(block->stride, &lda));
  PetscCall(PetscBLASIntCast(2 * m, &m2));
  PetscCall(PetscMalloc2(2 * m * columns, &x, 2 * m * rows, &y));
  DenseSplit(m * columns, X, x);
  PetscCallBLAS("BLASgemm",
                BLASgemm_(transposed ? "T" : "N", "N", &r, &m2, &c, &one, block->A, &lda, x, &c, &zero, y, &r));
  DenseUnite(m * rows, y, Y);
  PetscCall(PetscFree2(x, y));
  PetscFunctionReturn(0);
}

PetscErrorCode DenseSubtract(DenseBlock A, PetscBool transposed, PetscInt m, const PetscReal X[], PetscReal Y[])
{
  const PetscReal minus = -1, one = 1;
  PetscBLASInt    rows, columns, n, stride;

  PetscFunctionBeginUser;
  if (!A.rows || !A.columns || !m) PetscFunctionReturn(0);
  PetscCall(PetscBLASIntCast(A.rows, &rows));
  PetscCall(PetscBLASIntCast(A.columns, &columns));
  PetscCall(PetscBLASIntCast(m, &n));
  PetscCall(PetscBLASIntCast(A.stride, &stride));
  PetscCallBLAS("BLASgemm", BLASgemm_(transposed ? "T" : "N", "N", &rows, &n, &columns, &minus, A.A, &stride, X,
                                      &columns, &one, Y, &rows));
  PetscFunctionReturn(0);
}

void DenseBlockGet(DenseBlock block, PetscBool transposed, PetscReal entries[])
{
  for (PetscInt j = 0; j < block.columns; j++)
    for (PetscInt i = 0; i < block.rows; i++)
      entries[transposed ? i * block.columns + j : j * block.rows + i] = block.A[j * block.stride + i];
}

PetscErrorCode DenseEnergies(PetscInt n, const PetscReal E[], PetscInt m, const PetscComplex X[], PetscReal energy[])
{
  PetscComplex *EX;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(m * n, &EX));
  PetscCall(DenseTimes(&(DenseBlock){E, n, n, n}, PETSC_FALSE, m, X, EX));
  for (PetscInt i = 0; i < m; i++) {
    energy[i] = 0;
    for (PetscInt k = i * n; k < (i + 1) * n; k++) energy[i] += creal(conj(X[k]) * EX[k]);
  }
  PetscCall(PetscFree(EX));
  PetscFunctionReturn(0);
}

PetscComplex DenseDot(PetscInt n, const PetscComplex x[], const PetscComplex y[])
{
  PetscComplex sum = 0;

  for (PetscInt i = 0; i < n; i++) sum += x[i] * y[i];
  return sum;
}

static PetscReal Norm(PetscInt n, const PetscComplex x[])
{
  PetscReal sum = 0;

  for (PetscInt i = 0; i < n; i++) sum += PetscSqr(creal(x[i])) + PetscSqr(cimag(x[i]));
  return PetscSqrtReal(sum);
}

/* x -= q q^H x */
static void Remove(PetscInt n, const PetscComplex q[], PetscComplex x[])
{
  PetscComplex c = 0;

  for (PetscInt i = 0; i < n; i++) c += conj(q[i]) * x[i];
  for (PetscInt i = 0; i < n; i++) x[i] -= c * q[i];
}

/* The longest of the columns first .. m - 1 comes to place first; its norm */
static PetscReal Pivot(PetscInt n, PetscInt m, PetscInt first, PetscComplex X[])
{
  PetscInt  longest = first;
  PetscReal norm    = 0;

  for (PetscInt j = first; j < m; j++) {
    const PetscReal here = Norm(n, X + j * n);

    if (here > norm) norm = here, longest = j;
  }
  for (PetscInt i = 0; i < n && longest != first; i++) {
    const PetscComplex swap = X[first * n + i];

    X[first * n + i]   = X[longest * n + i];
    X[longest * n + i] = swap;
  }
  return norm;
}

PetscErrorCode DenseOrthonormalise(PetscInt n, PetscInt m, PetscReal drop, PetscComplex X[], PetscInt *kept)
{
  PetscReal longest = 0;

  PetscFunctionBeginUser;
  for (*kept = 0; *kept < m; ++*kept) {
    PetscComplex *const q    = X + *kept * n;
    PetscReal           norm = Pivot(n, m, *kept, X);

    longest = PetscMax(longest, norm);
    if (norm <= drop * longest) break;
    for (int twice = 0; twice < 2; twice++) { /* once leaves the rounding of what was subtracted from q before */
      norm = Norm(n, q);
      for (PetscInt i = 0; i < n; i++) q[i] /= norm;
      for (PetscInt k = 0; k < *kept && !twice; k++) Remove(n, X + k * n, q);
    }
    for (PetscInt j = *kept + 1; j < m; j++) Remove(n, q, X + j * n);
  }
  PetscCall(PetscArrayzero(X + *kept * n, (m - *kept) * n));
  PetscFunctionReturn(0);
}

PetscErrorCode DenseRealSpan(PetscInt n, PetscInt m, PetscReal drop, PetscComplex X[], PetscInt *kept)
{
  PetscComplex *both;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(2 * m * n, &both));
  for (PetscInt i = 0; i < m * n; i++) {
    const PetscReal norm = i % n ? 0 : Norm(n, X + i);

    for (PetscInt k = i; k < i + n && norm > 0; k++) X[k] /= norm;
    both[i]         = creal(X[i]);
    both[m * n + i] = cimag(X[i]);
  }
  PetscCall(DenseOrthonormalise(n, 2 * m, drop, both, kept));
  *kept = PetscMin(*kept, m);
  PetscCall(PetscArraycpy(X, both, *kept * n));
  PetscCall(PetscFree(both));
  PetscFunctionReturn(0);
}
