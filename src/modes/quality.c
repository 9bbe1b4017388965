/*
   Errors of each eigenvalue from right (x) and left (y, y^T Q(lambda) = 0) vectors; Q and D as in complexvec.h:

      backward error   |Q x| / ((|lambda|^2 |M| + |lambda| |C| + |K|) |x|)
      condition        |x|_M |y|_M / |y^T D x|
      error            |y^T Q x| / |y^T Q' x|, first order in the residual, and what rounding in K does, ROUNDINGS
                       times: in its entries, in products with it, and in its factors; of a pair that is close to
                       defective, whose condition has no limit, that of its plane (defect.c)
   (F. Tisseur, Lin. Alg. Appl. 309, 2000, for the quadratic problem.)
*/
#include "complexvec.h"

#define QUALITY_BLOCK    16   /* modes whose products are made at once */
#define QUALITY_BACKWARD 1e-6 /* largest backward error that is a solution */
#define ROUNDINGS        3
#define QUALITY_NULL     1e-10 /* |K x| / (|K| |x|) of a rigid motion */
/* x'K x / (lambda^2 x'M x) of one, at most; of an elastic one that does not oscillate 1 at least */
#define QUALITY_ENERGY 0.1
/* root of the largest ratio of M^-1 to the inverse of its diagonal, 8 for brick elements of first order */
#define QUALITY_CONSISTENT 2.9
#define QUALITY_DOUBLE     6.7e7 /* 1 / sqrt(machine epsilon) */
#define QUALITY_NOISE      100   /* lambda^2 below this many times its error is a rigid mode */
#define QUALITY_UNSURE     1e-6  /* without left vectors: growth below this, of |lambda|, may be error */

/* What all modes share: matrices, their Frobenius norms (K, C, M), and work vectors */
typedef struct {
  const PencilMatrices *pencil;
  Mat                   M; /* of all unknowns; the pencil's own without constraints */
  PetscReal             norms[3];
  Vec                   diagonal, scratch; /* diagonal of K */
  Vec                   lightness;         /* roots of 1 / M_ii, 0 where there is no mass */
  ComplexVec            Mx, Cx, z;         /* unknowns of the pencil */
  ComplexVec            full;              /* all unknowns */
  Mat                   KX, CX, MX, MY;    /* products of a block of modes, MY where M is the pencil's own */
  PetscInt              next[2];           /* columns of the next mode in KX, CX and MX, in MY */
} Quality;

/* Length of a complex vector from the parts of a real quadratic form: x^H z for z = A x with A symmetric, or z = x */
static PetscErrorCode ComplexVecSquare(ComplexVec x, ComplexVec z, PetscReal *square)
{
  PetscReal part = 0;

  PetscFunctionBeginUser;
  PetscCall(VecDot(x.r, z.r, square));
  if (x.i) PetscCall(VecDot(x.i, z.i, &part));
  *square += part;
  PetscFunctionReturn(0);
}

/* The products of a block of modes */
static PetscErrorCode QualityBegin(const Modes modes, Quality *q, PetscInt first, PetscInt n)
{
  const Mat A[3]  = {q->pencil->K, q->pencil->M, q->pencil->C};
  Mat       AX[3] = {NULL, NULL, NULL};

  PetscFunctionBeginUser;
  PetscCall(SpectrumMultiply(&modes->right, first, n, A[2] ? 3 : 2, A, AX));
  q->KX = AX[0], q->MX = AX[1], q->CX = AX[2];
  if (modes->left_spectrum.n && q->M == q->pencil->M)
    PetscCall(SpectrumMultiply(&modes->left_spectrum, first, n, 1, &q->M, &q->MY));
  q->next[0] = q->next[1] = 0;
  PetscFunctionReturn(0);
}

static PetscErrorCode QualityEnd(Quality *q)
{
  PetscFunctionBeginUser;
  PetscCall(MatDestroy(&q->KX));
  PetscCall(MatDestroy(&q->CX));
  PetscCall(MatDestroy(&q->MX));
  PetscCall(MatDestroy(&q->MY));
  PetscFunctionReturn(0);
}

/* z = A x from the columns of A X */
static PetscErrorCode QualityTake(Mat AX, PetscInt column, ComplexVec x, ComplexVec z)
{
  Vec product;

  PetscFunctionBeginUser;
  PetscCall(MatDenseGetColumnVecRead(AX, column, &product));
  PetscCall(VecCopy(product, z.r));
  PetscCall(MatDenseRestoreColumnVecRead(AX, column, &product));
  PetscCall(VecSet(z.i, 0));
  if (!x.i) PetscFunctionReturn(0);
  PetscCall(MatDenseGetColumnVecRead(AX, column + 1, &product));
  PetscCall(VecCopy(product, z.i));
  PetscCall(MatDenseRestoreColumnVecRead(AX, column + 1, &product));
  PetscFunctionReturn(0);
}

/* Mx, Cx, z = K x, and where M is the pencil's own the norms of x and y in it, of the next mode of the block */
static PetscErrorCode QualityNext(Quality *q, ComplexVec x, ComplexVec y, PetscReal *norm_x, PetscReal *norm_y)
{
  PetscFunctionBeginUser;
  PetscCall(QualityTake(q->KX, q->next[0], x, q->z));
  PetscCall(QualityTake(q->MX, q->next[0], x, q->Mx));
  if (q->CX) PetscCall(QualityTake(q->CX, q->next[0], x, q->Cx));
  q->next[0] += x.i ? 2 : 1;
  if (q->M != q->pencil->M) PetscFunctionReturn(0);
  PetscCall(ComplexVecSquare(x, q->Mx, norm_x));
  *norm_x = PetscSqrtReal(*norm_x);
  if (!y.r) PetscFunctionReturn(0);
  PetscCall(QualityTake(q->MY, q->next[1], y, q->full));
  q->next[1] += y.i ? 2 : 1;
  PetscCall(ComplexVecSquare(y, q->full, norm_y));
  *norm_y = PetscSqrtReal(*norm_y);
  PetscFunctionReturn(0);
}

/* Scales a vector of all unknowns to norm one; the norm before, sqrt(x^H M x), is known where M is the pencil's own */
static PetscErrorCode QualityNormalise(Quality *q, ComplexVec x, PetscReal *norm)
{
  PetscFunctionBeginUser;
  if (q->M != q->pencil->M) {
    PetscCall(ComplexVecMult(q->M, x, q->full));
    PetscCall(ComplexVecSquare(x, q->full, norm));
    *norm = PetscSqrtReal(*norm);
  }
  PetscCall(VecScale(x.r, 1 / *norm));
  if (x.i) PetscCall(VecScale(x.i, 1 / *norm));
  PetscFunctionReturn(0);
}

/* Expands a vector of the pencil to all unknowns in place */
static PetscErrorCode QualityExpand(Quality *q, Pencil pencil, PetscBool left, Vec *x)
{
  Vec u;

  PetscFunctionBeginUser;
  if (!*x || q->M == q->pencil->M) PetscFunctionReturn(0);
  PetscCall(VecDuplicate(q->full.r, &u));
  PetscCall(PencilExpand(pencil, left, *x, u));
  PetscCall(VecDestroy(x));
  *x = u;
  PetscFunctionReturn(0);
}

/* What rounding in K does to x'K x: machine epsilon times the energy without cancellation, sum_i K_ii |x_i|^2 */
static PetscErrorCode QualityNoise(const Quality *q, ComplexVec x, PetscReal *noise)
{
  PetscReal part = 0;

  PetscFunctionBeginUser;
  PetscCall(VecPointwiseMult(q->scratch, x.r, q->diagonal));
  PetscCall(VecDot(q->scratch, x.r, noise));
  if (x.i) {
    PetscCall(VecPointwiseMult(q->scratch, x.i, q->diagonal));
    PetscCall(VecDot(q->scratch, x.i, &part));
  }
  *noise = PETSC_MACHINE_EPSILON * (*noise + part);
  PetscFunctionReturn(0);
}

/* Whether a real x of an eigenvalue of that size is a rigid motion, from Mx and z = K x */
static PetscErrorCode QualityIsSlowing(const Quality *q, PetscReal size, ComplexVec x, PetscReal noise,
                                       PetscBool *slowing)
{
  PetscReal energy, mass, length, force; /* the last two squared */

  PetscFunctionBeginUser;
  PetscCall(VecDot(x.r, q->z.r, &energy));
  PetscCall(VecDot(x.r, q->Mx.r, &mass));
  PetscCall(VecDot(x.r, x.r, &length)); /* VecNorm() may remember that of a time before x was filled */
  PetscCall(VecDot(q->z.r, q->z.r, &force));
  *slowing = PetscAbsReal(energy) <= QUALITY_ENERGY * size * size * mass + QUALITY_NOISE * noise &&
                 force <= PetscSqr(QUALITY_NULL * q->norms[0]) * length
               ? PETSC_TRUE
               : PETSC_FALSE;
  PetscFunctionReturn(0);
}

/* Backward error of an eigenpair, |y^T Q x|, |y^T D x|; the root of sum_i |(Q x)_i|^2 / M_ii, and what
   rounding in K adds to it */
typedef struct {
  PetscReal    backward, y_Qx, y_Dx, residual;
  PetscComplex product; /* y^T D x */
} QualityProducts;

/* Root of sum_i |d_i x_i|^2 / M_ii, d = 1 for NULL */
static PetscErrorCode QualityWeigh(Quality *q, ComplexVec x, Vec d, PetscReal *norm)
{
  PetscReal square;

  PetscFunctionBeginUser;
  *norm = 0;
  for (int part = 0; part < (x.i ? 2 : 1); part++) {
    PetscCall(VecPointwiseMult(q->scratch, part ? x.i : x.r, q->lightness));
    if (d) PetscCall(VecPointwiseMult(q->scratch, q->scratch, d));
    PetscCall(VecDot(q->scratch, q->scratch, &square));
    *norm += square;
  }
  *norm = PetscSqrtReal(*norm);
  PetscFunctionReturn(0);
}

/* From Mx, Cx and z = K x; it overwrites Mx and z; the products with y are not touched without a left vector */
static PetscErrorCode QualityResidual(Quality *q, PetscComplex lambda, ComplexVec x, ComplexVec y, QualityProducts *p)
{
  const PencilMatrices *pencil = q->pencil;
  const PetscReal       size = cabs(lambda), bound = size * size * q->norms[2] + size * q->norms[1] + q->norms[0];
  PetscReal             length, residual;
  PetscComplex          dot;

  PetscFunctionBeginUser;
  PetscCall(ComplexVecAXPY(lambda * lambda, q->Mx, q->z));
  if (pencil->C) PetscCall(ComplexVecAXPY(lambda, q->Cx, q->z));
  PetscCall(ComplexVecAddLaws(pencil, lambda, x, q->z, q->Mx));
  PetscCall(ComplexVecSquare(x, x, &length));
  PetscCall(ComplexVecSquare(q->z, q->z, &residual));
  p->backward = PetscSqrtReal(residual / length) / bound;
  PetscCall(QualityWeigh(q, q->z, NULL, &p->residual));
  PetscCall(QualityWeigh(q, x, q->diagonal, &residual));
  p->residual += ROUNDINGS * PETSC_MACHINE_EPSILON * residual;
  if (!y.r) PetscFunctionReturn(0);
  PetscCall(ComplexVecDot(y, q->z, &dot));
  p->y_Qx = cabs(dot);
  if (pencil->C && size > 0) PetscCall(ComplexVecAXPY(1 / (2 * lambda), q->Cx, q->Mx));
  PetscCall(ComplexVecDot(y, q->Mx, &p->product));
  p->y_Dx = cabs(p->product);
  PetscFunctionReturn(0);
}

/* Expands both parts of a vector to all unknowns in place, and normalises it */
static PetscErrorCode QualityFinish(Quality *q, Pencil pencil, PetscBool left, Vec *r, Vec *i, PetscReal *norm)
{
  PetscFunctionBeginUser;
  PetscCall(QualityExpand(q, pencil, left, r));
  PetscCall(QualityExpand(q, pencil, left, i));
  PetscCall(QualityNormalise(q, (ComplexVec){*r, *i}, norm));
  PetscFunctionReturn(0);
}

/* Raises an error for a mode at freq (Hz) that is none, or of which nothing can be told */
static PetscErrorCode ModeCheck(Modes modes, const Mode *mode, PetscReal freq)
{
  PetscFunctionBeginUser;
  PetscCheck(isfinite(mode->error) && isfinite(mode->sigma) && isfinite(mode->omega), modes->comm,
             PETSC_ERR_NOT_CONVERGED, "mode at %.6g Hz has an error of %g Hz: whether it grows cannot be told",
             (double)freq, (double)mode->error);
  PetscCheck(
    mode->rigid || mode->backward_error < QUALITY_BACKWARD, modes->comm, PETSC_ERR_NOT_CONVERGED,
    "the eigensolver returned a mode at %.6g Hz with a backward error of %.2g, more than %.0e: it is none, or the "
    "matrices are too badly scaled; tighten -eps_tol or -pep_tol where they are given",
    (double)freq, (double)mode->backward_error, QUALITY_BACKWARD);
  PetscFunctionReturn(0);
}

/* Measures the plane of a pair, of vectors v = x, y, where the condition, of norms in the pencil's own M, is large;
   QualityResidual() has left Q x in z and D x in Mx */
static PetscErrorCode QualityFindDefect(Quality *q, PetscComplex lambda, const ComplexVec v[2], PetscReal y_Dx,
                                        PetscReal norm[2], Defect *defect)
{
  PetscFunctionBeginUser;
  *defect = (Defect){.near = PETSC_FALSE};
  if (!v[1].r) PetscFunctionReturn(0);
  if (q->M != q->pencil->M) {
    PetscCall(ComplexVecMult(q->pencil->M, v[1], q->Cx));
    PetscCall(ComplexVecSquare(v[0], q->Mx, &norm[0]));
    PetscCall(ComplexVecSquare(v[1], q->Cx, &norm[1]));
    for (int k = 0; k < 2; k++) norm[k] = PetscSqrtReal(PetscAbsReal(norm[k]));
  }
  if (DefectIsNear(norm[0] * norm[1] / y_Dx)) PetscCall(DefectMeasure(q->pencil, lambda, v, q->z, q->Cx, defect));
  PetscFunctionReturn(0);
}

/* Error of lambda^2; noise is that of x with |x|_M = 1 */
static PetscReal QualitySquare(const Modes modes, PetscInt i, const QualityProducts *p, Defect *defect,
                               const PetscReal norm[2], PetscReal noise)
{
  const PetscReal product = norm[0] * norm[1], rounding = ROUNDINGS * noise;
  const PetscReal condition = p->y_Dx > 0 ? product / p->y_Dx : PETSC_MAX_REAL;

  defect->along = defect->along / (norm[0] * norm[0]) + rounding;
  defect->departure /= product;
  return DefectError(&modes->right, i, defect, rounding + p->y_Qx / product,
                     rounding * PetscMax(1, condition) + p->y_Qx / product * condition);
}

/* Condition, error, and what follows from them; the vectors become vectors of all unknowns with M-norm one */
static PetscErrorCode QualityMeasureMode(Modes modes, Quality *q, PetscInt i)
{
  Spectrum          *right = &modes->right, *left = &modes->left_spectrum;
  Mode              *mode     = &modes->mode[i];
  const PetscBool    has_left = left->n ? PETSC_TRUE : PETSC_FALSE;
  const PetscComplex lambda   = SpectrumLambda(right, i);
  const ComplexVec x = {right->xr[i], right->xi[i]}, y = {has_left ? left->xr[i] : NULL, has_left ? left->xi[i] : NULL};
  PetscReal        size = cabs(lambda), norm[2] = {1, 1}, noise, square, amplified = 1;
  QualityProducts  p = {.y_Dx = 1};
  Defect           defect;
  ModesLimit       limit;

  PetscFunctionBeginUser;
  PetscCall(QualityNext(q, x, y, &norm[0], &norm[1]));
  PetscCall(QualityNoise(q, x, &noise));
  if (cimag(lambda) == 0 && q->pencil->C) PetscCall(QualityIsSlowing(q, size, x, noise, &mode->slowing));
  PetscCall(QualityResidual(q, lambda, x, y, &p));
  PetscCall(QualityFindDefect(q, lambda, (ComplexVec[2]){x, y}, p.y_Dx, norm, &defect));
  PetscCall(QualityFinish(q, modes->pencil, PETSC_FALSE, &right->xr[i], &right->xi[i], &norm[0]));
  if (has_left) PetscCall(QualityFinish(q, modes->pencil, PETSC_TRUE, &left->xr[i], &left->xi[i], &norm[1]));
  modes->residual[i]   = QUALITY_CONSISTENT * p.residual / norm[0];
  mode->backward_error = p.backward;
  mode->sigma          = creal(lambda);
  mode->omega          = cimag(lambda);
  mode->product[0]     = creal(p.product) / (norm[0] * norm[1]);
  mode->product[1]     = cimag(p.product) / (norm[0] * norm[1]);
  mode->condition      = !has_left ? NAN : p.y_Dx > 0 ? norm[0] * norm[1] / p.y_Dx : INFINITY;
  noise /= norm[0] * norm[0];
  /* error of lambda^2: of a double eigenvalue, whose condition has no limit, the root of rounding */
  if (has_left && isfinite(mode->condition)) amplified = PetscMax(1, mode->condition);
  square      = PetscMin(amplified, QUALITY_DOUBLE) * PetscMax(noise, has_left ? p.y_Qx / (norm[0] * norm[1]) : 0);
  mode->rigid = size * size <= QUALITY_NOISE * square ? PETSC_TRUE : PETSC_FALSE;
  square      = has_left ? QualitySquare(modes, i, &p, &defect, norm, noise) : ROUNDINGS * noise;
  mode->error = mode->rigid ? PetscSqrtReal(size * size + square) : square / (2 * size);
  if (mode->rigid) mode->sigma = mode->omega = 0;
  if (mode->rigid) mode->slowing = PETSC_FALSE;
  PetscCall(ModesGetLimit(modes, &limit));
  mode->state    = ModesLimitJudge(&limit, mode->sigma, mode->omega,
                                has_left ? mode->error : PetscMax(mode->error, QUALITY_UNSURE * size));
  mode->unstable = mode->state == MODE_UNSTABLE ? PETSC_TRUE : PETSC_FALSE;
  PetscCall(ModeCheck(modes, mode, cimag(lambda) / (2 * PETSC_PI)));
  if (!has_left) mode->error = NAN;
  PetscFunctionReturn(0);
}

/* Norms and work vectors; of M the roots of 1 / M_ii */
static PetscErrorCode QualityCreate(Modes modes, const PencilMatrices *pencil, Quality *q)
{
  Vec *const   work[] = {&q->diagonal, &q->scratch, &q->Mx.r, &q->Mx.i, &q->Cx.r, &q->Cx.i, &q->z.r, &q->z.i};
  PetscScalar *m;
  PetscInt     n;

  PetscFunctionBeginUser;
  *q = (Quality){.pencil = pencil};
  PetscCall(MatNorm(pencil->K, NORM_FROBENIUS, &q->norms[0]));
  if (pencil->C) PetscCall(MatNorm(pencil->C, NORM_FROBENIUS, &q->norms[1]));
  PetscCall(MatNorm(pencil->M, NORM_FROBENIUS, &q->norms[2]));
  for (size_t k = 0; k < PETSC_STATIC_ARRAY_LENGTH(work); k++) PetscCall(MatCreateVecs(pencil->K, work[k], NULL));
  PetscCall(MatGetDiagonal(pencil->K, q->diagonal));
  PetscCall(VecDuplicate(q->diagonal, &q->lightness));
  PetscCall(MatGetDiagonal(pencil->M, q->lightness));
  PetscCall(VecGetLocalSize(q->lightness, &n));
  PetscCall(VecGetArray(q->lightness, &m));
  for (PetscInt i = 0; i < n; i++) m[i] = m[i] > 0 ? 1 / PetscSqrtReal(m[i]) : 0;
  PetscCall(VecRestoreArray(q->lightness, &m));
  PetscCall(PencilGetMass(modes->pencil, &q->M));
  PetscCall(MatCreateVecs(q->M, &q->full.r, NULL));
  PetscCall(VecDuplicate(q->full.r, &q->full.i));
  PetscFunctionReturn(0);
}

static PetscErrorCode QualityDestroy(Quality *q)
{
  Vec *const work[] = {&q->diagonal, &q->scratch, &q->Mx.r, &q->Mx.i,   &q->Cx.r,
                       &q->Cx.i,     &q->z.r,     &q->z.i,  &q->full.r, &q->full.i};

  PetscFunctionBeginUser;
  for (size_t k = 0; k < PETSC_STATIC_ARRAY_LENGTH(work); k++) PetscCall(VecDestroy(work[k]));
  PetscCall(VecDestroy(&q->lightness));
  PetscFunctionReturn(0);
}

PetscErrorCode QualityMeasure(Modes modes, const PencilMatrices *pencil)
{
  Quality q;

  PetscFunctionBeginUser;
  PetscCall(QualityCreate(modes, pencil, &q));
  if (modes->left_spectrum.n) PetscCall(LeftBiorthogonalise(modes, pencil, (Vec[]){q.scratch, q.z.r, q.z.i}));
  modes->n = modes->right.n;
  PetscCall(PetscCalloc1(modes->n, &modes->mode));
  PetscCall(PetscMalloc1(modes->n, &modes->residual));
  for (PetscInt first = 0; first < modes->n; first += QUALITY_BLOCK) {
    const PetscInt n = PetscMin(QUALITY_BLOCK, modes->n - first);

    PetscCall(QualityBegin(modes, &q, first, n));
    for (PetscInt i = first; i < first + n; i++) PetscCall(QualityMeasureMode(modes, &q, i));
    PetscCall(QualityEnd(&q));
  }
  PetscCall(QualityDestroy(&q));
  PetscFunctionReturn(0);
}
