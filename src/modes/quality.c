/*
   Errors of each eigenvalue from right (x) and left (y, y^T Q(lambda) = 0) vectors, Q(lambda) = lambda^2 M + lambda C + K:

      D(lambda) = M + C / (2 lambda), so that Q' = 2 lambda D
      backward error   |Q x| / ((|lambda|^2 |M| + |lambda| |C| + |K|) |x|)
      condition        |x|_M |y|_M / |y^T D x|
      error            |y^T Q x| / |y^T Q' x|, first order in the residual, but not below what rounding in K does
   (F. Tisseur, Lin. Alg. Appl. 309, 2000, for the quadratic problem.) In a cluster of equal eigenvalues the left vectors are
   made biorthogonal to the right ones with respect to D; without that neither number would mean anything for a double mode.
*/
#include "modesimpl.h"
#include <petscblaslapack.h>
#include <complex.h>

#define MATCH   1e-5 /* left and right eigenvalues farther apart than this, relative, are different ones */
#define RIGID   1e-5 /* both smaller than this beside the largest of the window: zeros */
#define RIGID_NOISE 100 /* lambda^2 below this many times its error is a rigid mode */
#define CLUSTER 1e-7 /* eigenvalues nearer than this, relative, are treated as one cluster */

/* One complex vector */
typedef struct {
  Vec r, i; /* i may be NULL: zero */
} Pair;

static PetscComplex Lambda(const Spectrum *s, PetscInt i)
{
  return CMPLX(s->sigma[i], s->omega[i]);
}

/* x^T z without conjugation */
static PetscErrorCode PairDot(Pair x, Pair z, PetscComplex *dot)
{
  PetscReal rr, ri = 0, ir = 0, ii = 0;

  PetscFunctionBeginUser;
  PetscCall(VecDot(x.r, z.r, &rr));
  if (z.i) PetscCall(VecDot(x.r, z.i, &ri));
  if (x.i) PetscCall(VecDot(x.i, z.r, &ir));
  if (x.i && z.i) PetscCall(VecDot(x.i, z.i, &ii));
  *dot = CMPLX(rr - ii, ri + ir);
  PetscFunctionReturn(0);
}

/* z += a A x; z.i must be there */
static PetscErrorCode PairMultAdd(Mat A, PetscComplex a, Pair x, Vec work, Pair z)
{
  PetscFunctionBeginUser;
  PetscCall(MatMult(A, x.r, work));
  PetscCall(VecAXPY(z.r, creal(a), work));
  if (cimag(a) != 0) PetscCall(VecAXPY(z.i, cimag(a), work));
  if (!x.i) PetscFunctionReturn(0);
  PetscCall(MatMult(A, x.i, work));
  PetscCall(VecAXPY(z.i, creal(a), work));
  if (cimag(a) != 0) PetscCall(VecAXPY(z.r, -cimag(a), work));
  PetscFunctionReturn(0);
}

static PetscErrorCode PairZero(Pair z)
{
  PetscFunctionBeginUser;
  PetscCall(VecSet(z.r, 0));
  if (z.i) PetscCall(VecSet(z.i, 0));
  PetscFunctionReturn(0);
}

/* z = D(lambda) x */
static PetscErrorCode ApplyD(const OperatorsPencil *pencil, PetscComplex lambda, Pair x, Vec work, Pair z)
{
  PetscFunctionBeginUser;
  PetscCall(PairZero(z));
  PetscCall(PairMultAdd(pencil->M, 1, x, work, z));
  if (pencil->C && cabs(lambda) > 0) PetscCall(PairMultAdd(pencil->C, 1 / (2 * lambda), x, work, z));
  PetscFunctionReturn(0);
}

/* z = Q(lambda) x; undamped: with the real or complex lambda^2 = -kappa */
static PetscErrorCode ApplyQ(const OperatorsPencil *pencil, PetscComplex lambda, Pair x, Vec work, Pair z)
{
  PetscFunctionBeginUser;
  PetscCall(PairZero(z));
  PetscCall(PairMultAdd(pencil->K, 1, x, work, z));
  PetscCall(PairMultAdd(pencil->M, lambda * lambda, x, work, z));
  if (pencil->C) PetscCall(PairMultAdd(pencil->C, lambda, x, work, z));
  PetscFunctionReturn(0);
}

/* Nearest entry of the left spectrum that is not used yet */
static PetscInt NearestLeft(const Spectrum *left, const PetscBool used[], PetscComplex lambda, PetscReal *distance)
{
  PetscInt best = -1;

  *distance = PETSC_MAX_REAL;
  for (PetscInt j = 0; j < left->n; j++) {
    const PetscReal here = cabs(Lambda(left, j) - lambda);

    if (used[j] || here >= *distance) continue;
    *distance = here;
    best      = j;
  }
  return best;
}

/* Largest |lambda| of a spectrum */
static PetscReal LambdaLargest(const Spectrum *s)
{
  PetscReal largest = 0;

  for (PetscInt j = 0; j < s->n; j++) largest = PetscMax(largest, cabs(Lambda(s, j)));
  return largest;
}

/* Relative distance of two eigenvalues; rigid modes are zeros up to the square root of rounding, hence all alike */
static PetscReal LambdaDistance(PetscComplex a, PetscComplex b, PetscReal largest)
{
  if (PetscMax(cabs(a), cabs(b)) < RIGID * largest) return 0;
  return cabs(a - b) / PetscMax(cabs(a), 1e-3 * largest);
}

PetscErrorCode QualityMatchLeft(Modes modes, PetscReal *worst, PetscBool *complete)
{
  Spectrum *right = &modes->right, *left = &modes->left_spectrum, matched;
  const PetscReal largest = LambdaLargest(right);
  PetscBool      *used;

  PetscFunctionBeginUser;
  *worst    = 0;
  *complete = PETSC_TRUE;
  PetscCall(PetscCalloc1(left->n, &used));
  PetscCall(SpectrumCreate(right->n, &matched));
  for (PetscInt i = 0; i < right->n; i++) {
    PetscReal      distance;
    const PetscInt j = NearestLeft(left, used, Lambda(right, i), &distance);

    if (j >= 0) distance = LambdaDistance(Lambda(right, i), Lambda(left, j), largest);
    *complete = distance <= MATCH ? PETSC_TRUE : PETSC_FALSE;
    if (!*complete) break;
    used[j] = PETSC_TRUE;
    *worst  = PetscMax(*worst, distance);
    PetscCall(SpectrumAdd(&matched, left->sigma[j], left->omega[j], left->xr[j], left->xi[j]));
  }
  for (PetscInt j = 0; j < left->n && right->n; j++) /* a left eigenvalue inside the window without a right one */
    if (!used[j] && left->omega[j] > right->omega[0] * (1 + MATCH) && left->omega[j] < right->omega[right->n - 1] * (1 - MATCH))
      *complete = PETSC_FALSE;
  PetscCall(PetscFree(used));
  PetscCall(SpectrumDestroy(left));
  *left = matched;
  PetscFunctionReturn(0);
}

/* Solves G A = I for the complex m x m matrix G (row-major) through its real form [Re -Im; Im Re] of order 2 m */
static PetscErrorCode ComplexInverse(PetscInt m, const PetscComplex G[], PetscComplex inverse[])
{
  const PetscInt n2 = 2 * m;
  PetscReal     *a, *b;
  PetscBLASInt   n, *pivots, info;

  PetscFunctionBeginUser;
  PetscCall(PetscBLASIntCast(n2, &n));
  PetscCall(PetscCalloc3(n2 * n2, &a, n2 * n2, &b, n2, &pivots));
  for (PetscInt i = 0; i < m; i++) {
    for (PetscInt j = 0; j < m; j++) {
      a[i + j * n2]           = creal(G[i * m + j]);
      a[i + m + (j + m) * n2] = creal(G[i * m + j]);
      a[i + m + j * n2]       = cimag(G[i * m + j]);
      a[i + (j + m) * n2]     = -cimag(G[i * m + j]);
    }
    b[i + i * n2] = 1;
  }
  PetscCallBLAS("LAPACKgesv", LAPACKgesv_(&n, &n, a, &n, pivots, b, &n, &info));
  for (PetscInt i = 0; i < m * m; i++) inverse[i] = info ? (i % (m + 1) == 0) : CMPLX(b[i / m + (i % m) * n2], b[i / m + m + (i % m) * n2]);
  PetscCall(PetscFree3(a, b, pivots));
  PetscFunctionReturn(0);
}

/* Replaces the left vectors first .. first + m - 1 by combinations with y_i^T D x_j = delta_ij */
static PetscErrorCode Biorthogonalise(const OperatorsPencil *pencil, const Spectrum *right, PetscInt first, PetscInt m, Vec work[3], Spectrum *left)
{
  PetscComplex *G, *inverse;
  Vec          *yr, *yi;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(m * m, &G, m * m, &inverse));
  for (PetscInt j = 0; j < m; j++) {
    const Pair x = {right->xr[first + j], right->xi[first + j]}, z = {work[1], work[2]};

    PetscCall(ApplyD(pencil, Lambda(right, first), x, work[0], z));
    for (PetscInt i = 0; i < m; i++) PetscCall(PairDot((Pair){left->xr[first + i], left->xi[first + i]}, z, &G[i * m + j]));
  }
  PetscCall(ComplexInverse(m, G, inverse));
  PetscCall(VecDuplicateVecs(work[0], m, &yr));
  PetscCall(VecDuplicateVecs(work[0], m, &yi));
  for (PetscInt i = 0; i < m; i++)
    for (PetscInt j = 0; j < m; j++) {
      const PetscComplex a = inverse[i * m + j];

      PetscCall(VecAXPY(yr[i], creal(a), left->xr[first + j]));
      PetscCall(VecAXPY(yi[i], cimag(a), left->xr[first + j]));
      if (!left->xi[first + j]) continue;
      PetscCall(VecAXPY(yr[i], -cimag(a), left->xi[first + j]));
      PetscCall(VecAXPY(yi[i], creal(a), left->xi[first + j]));
    }
  for (PetscInt i = 0; i < m; i++) {
    PetscCall(VecCopy(yr[i], left->xr[first + i]));
    if (!left->xi[first + i] && right->xi[first + i]) PetscCall(VecDuplicate(yi[i], &left->xi[first + i]));
    if (left->xi[first + i]) PetscCall(VecCopy(yi[i], left->xi[first + i]));
  }
  PetscCall(VecDestroyVecs(m, &yr));
  PetscCall(VecDestroyVecs(m, &yi));
  PetscCall(PetscFree2(G, inverse));
  PetscFunctionReturn(0);
}

/* Cluster by cluster */
static PetscErrorCode BiorthogonaliseAll(Modes modes, const OperatorsPencil *pencil, Vec work[3])
{
  const Spectrum *right   = &modes->right;
  const PetscReal largest = LambdaLargest(right);

  PetscFunctionBeginUser;
  for (PetscInt first = 0, m; first < right->n; first += m) {
    for (m = 1; first + m < right->n; m++)
      if (LambdaDistance(Lambda(right, first + m), Lambda(right, first + m - 1), largest) > CLUSTER) break;
    if (m > 1) PetscCall(Biorthogonalise(pencil, right, first, m, work, &modes->left_spectrum));
  }
  PetscFunctionReturn(0);
}

/* Norm sqrt(x^H M x) of a vector of all unknowns, and scales it to one */
static PetscErrorCode NormaliseM(Mat M, Pair x, Vec work, PetscReal *norm)
{
  PetscReal square, part = 0;

  PetscFunctionBeginUser;
  PetscCall(MatMult(M, x.r, work));
  PetscCall(VecDot(x.r, work, &square));
  if (x.i) {
    PetscCall(MatMult(M, x.i, work));
    PetscCall(VecDot(x.i, work, &part));
  }
  *norm = PetscSqrtReal(square + part);
  PetscCall(VecScale(x.r, 1 / *norm));
  if (x.i) PetscCall(VecScale(x.i, 1 / *norm));
  PetscFunctionReturn(0);
}

/* Expands a vector of the pencil to all unknowns in place */
static PetscErrorCode Expand(Operators operators, PetscBool left, Vec *x)
{
  Vec u;

  PetscFunctionBeginUser;
  if (!*x) PetscFunctionReturn(0);
  PetscCall(OperatorsCreateVec(operators, &u));
  PetscCall(OperatorsExpand(operators, left, *x, u));
  PetscCall(VecDestroy(x));
  *x = u;
  PetscFunctionReturn(0);
}

/* Frobenius norms of K, C, M */
static PetscErrorCode PencilNorms(const OperatorsPencil *pencil, PetscReal norms[3])
{
  PetscFunctionBeginUser;
  norms[1] = 0;
  PetscCall(MatNorm(pencil->K, NORM_FROBENIUS, &norms[0]));
  if (pencil->C) PetscCall(MatNorm(pencil->C, NORM_FROBENIUS, &norms[1]));
  PetscCall(MatNorm(pencil->M, NORM_FROBENIUS, &norms[2]));
  PetscFunctionReturn(0);
}

/* What rounding in K does to x'K x: machine epsilon times the energy without cancellation, sum_i K_ii |x_i|^2 */
static PetscErrorCode RoundingNoise(Pair x, Vec diagonal, Vec work, PetscReal *noise)
{
  PetscReal part = 0;

  PetscFunctionBeginUser;
  PetscCall(VecPointwiseMult(work, x.r, diagonal));
  PetscCall(VecDot(work, x.r, noise));
  if (x.i) {
    PetscCall(VecPointwiseMult(work, x.i, diagonal));
    PetscCall(VecDot(work, x.i, &part));
  }
  *noise = PETSC_MACHINE_EPSILON * (*noise + part);
  PetscFunctionReturn(0);
}

/* Backward error of mode i, |y^T Q x| and |y^T D x| in the unknowns of the pencil; y_Dx is not touched without left vectors */
static PetscErrorCode MeasureResidual(Modes modes, const OperatorsPencil *pencil, PetscInt i, const PetscReal norms[3], Vec work[4], Mode *mode,
                                      PetscReal *y_Qx, PetscReal *y_Dx, PetscReal *noise)
{
  const Spectrum    *right = &modes->right, *left = &modes->left_spectrum;
  const PetscComplex lambda = Lambda(right, i);
  const Pair         x = {right->xr[i], right->xi[i]}, z = {work[1], work[2]};
  PetscReal          size, part, residual, bound;
  PetscComplex       dot;

  PetscFunctionBeginUser;
  PetscCall(ApplyQ(pencil, lambda, x, work[0], z));
  PetscCall(VecNorm(x.r, NORM_2, &size));
  if (x.i) PetscCall(VecNorm(x.i, NORM_2, &part));
  if (x.i) size = PetscSqrtReal(size * size + part * part);
  PetscCall(VecNorm(z.r, NORM_2, &residual));
  PetscCall(VecNorm(z.i, NORM_2, &part));
  residual             = PetscSqrtReal(residual * residual + part * part);
  bound                = cabs(lambda) * cabs(lambda) * norms[2] + cabs(lambda) * norms[1] + norms[0];
  mode->backward_error = residual / (bound * size);
  PetscCall(RoundingNoise(x, work[3], work[0], noise));
  if (!left->n) PetscFunctionReturn(0);
  PetscCall(PairDot((Pair){left->xr[i], left->xi[i]}, z, &dot));
  *y_Qx = cabs(dot);
  PetscCall(ApplyD(pencil, lambda, x, work[0], z));
  PetscCall(PairDot((Pair){left->xr[i], left->xi[i]}, z, &dot));
  *y_Dx = cabs(dot);
  PetscFunctionReturn(0);
}

/* Condition, error, and what follows from them; the vectors become vectors of all unknowns with M-norm one */
static PetscErrorCode MeasureMode(Modes modes, const OperatorsPencil *pencil, Mat M, PetscInt i, const PetscReal norms[3], Vec work[4], Vec full)
{
  Spectrum       *right = &modes->right, *left = &modes->left_spectrum;
  Mode           *mode  = &modes->mode[i];
  const PetscReal size  = cabs(Lambda(right, i));
  PetscReal       y_Qx = 0, y_Dx = 1, norm_x, norm_y = 1, noise, kappa;

  PetscFunctionBeginUser;
  PetscCall(MeasureResidual(modes, pencil, i, norms, work, mode, &y_Qx, &y_Dx, &noise));
  PetscCall(Expand(modes->operators, PETSC_FALSE, &right->xr[i]));
  PetscCall(Expand(modes->operators, PETSC_FALSE, &right->xi[i]));
  PetscCall(NormaliseM(M, (Pair){right->xr[i], right->xi[i]}, full, &norm_x));
  if (left->n) {
    PetscCall(Expand(modes->operators, PETSC_TRUE, &left->xr[i]));
    PetscCall(Expand(modes->operators, PETSC_TRUE, &left->xi[i]));
    PetscCall(NormaliseM(M, (Pair){left->xr[i], left->xi[i]}, full, &norm_y));
  }
  mode->sigma     = right->sigma[i];
  mode->omega     = right->omega[i];
  mode->condition = left->n ? norm_x * norm_y / y_Dx : NAN;
  noise *= (left->n ? mode->condition : 1) / (norm_x * norm_x);
  kappa       = PetscMax(noise, left->n ? y_Qx / y_Dx : 0); /* error of lambda^2 */
  mode->rigid = size * size <= RIGID_NOISE * kappa ? PETSC_TRUE : PETSC_FALSE;
  mode->error = mode->rigid ? PetscMax(size, PetscSqrtReal(kappa)) : kappa / (2 * size);
  if (mode->rigid) mode->sigma = mode->omega = 0;
  mode->unstable = mode->sigma > 3 * mode->error && mode->sigma > 1e-9 * size ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(0);
}

PetscErrorCode QualityMeasure(Modes modes, const OperatorsPencil *pencil)
{
  PetscReal norms[3];
  Vec       work[4], full; /* three for products, and the diagonal of K */
  Mat       M;

  PetscFunctionBeginUser;
  for (int k = 0; k < 4; k++) PetscCall(MatCreateVecs(pencil->K, &work[k], NULL));
  PetscCall(MatGetDiagonal(pencil->K, work[3]));
  PetscCall(OperatorsCreateVec(modes->operators, &full));
  PetscCall(OperatorsGetMatrices(modes->operators, NULL, &M, NULL, NULL, NULL));
  PetscCall(PencilNorms(pencil, norms));
  if (modes->left_spectrum.n) PetscCall(BiorthogonaliseAll(modes, pencil, work));
  modes->n = modes->right.n;
  PetscCall(PetscCalloc1(modes->n, &modes->mode));
  for (PetscInt i = 0; i < modes->n; i++) PetscCall(MeasureMode(modes, pencil, M, i, norms, work, full));
  for (int k = 0; k < 4; k++) PetscCall(VecDestroy(&work[k]));
  PetscCall(VecDestroy(&full));
  PetscFunctionReturn(0);
}
