/*
   Residuals of eigenpairs of the quadratic problem on real matrices; see residual.h.

      r = K x + lambda C x + lambda^2 M x,   x = V q,   of left vectors with K', C', M'

   in two real columns for a complex mode, in one for a real one. Where friction is apart, K = K_even + left' right, of
   which the transpose is K_even + right' left.
*/
#include "residual.h"
#include "solver/block/orthonormal.h"

#define RESIDUAL_WIDTH 32 /* columns of a part, as many as BlockMultiply() takes at once */

PetscErrorCode ComplexColumnsCreate(PetscInt capacity, PetscInt size, ComplexColumns *c)
{
  PetscFunctionBeginUser;
  *c = (ComplexColumns){.size = size};
  PetscCall(PetscMalloc3(capacity + 1, &c->column, capacity, &c->lambda, 2 * capacity * size, &c->coordinates));
  c->column[0] = 0;
  PetscFunctionReturn(0);
}

PetscErrorCode ComplexColumnsAdd(ComplexColumns *c, PetscComplex lambda, PetscBool is_real, const PetscComplex x[])
{
  PetscReal *re = &c->coordinates[c->n_columns * c->size], *im = re + c->size;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < c->size; i++) {
    re[i] = creal(x[i]);
    if (!is_real) im[i] = cimag(x[i]);
  }
  c->n_columns += is_real ? 1 : 2;
  c->lambda[c->m]   = lambda;
  c->column[++c->m] = c->n_columns;
  PetscFunctionReturn(0);
}

PetscErrorCode ComplexColumnsDestroy(ComplexColumns *c)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree3(c->column, c->lambda, c->coordinates));
  PetscFunctionReturn(0);
}

/* Modes `first` .. `end` - 1 and their columns of the vectors and of the residuals, which stay in a cache while all
   matrices are multiplied with them, with room for products with C and M */
typedef struct {
  const ComplexColumns *c;
  PetscInt              first, end;
  Mat                   X, R, AX[2];
} ResidualPart;

/* What a matrix of T is multiplied by: 0 .. 2 a power of lambda, else that of a law */
static PetscComplex ResidualFactor(const PencilMatrices *pencil, PetscInt which, PetscComplex lambda)
{
  if (which > 2) return PencilLawAt(&pencil->law[which - 3], lambda, NULL);
  return which == 2 ? lambda * lambda : which == 1 ? lambda : 1;
}

/* R += c AX, mode by mode: with c = a + i b the columns are a xr - b xi and a xi + b xr; which: ResidualFactor() */
static PetscErrorCode ResidualScale(const PencilMatrices *pencil, const ResidualPart *p, PetscInt which, Mat AX)
{
  const ComplexColumns *c = p->c;
  const PetscScalar    *ax;
  PetscScalar          *r;
  PetscInt              n, ldx, ldr;

  PetscFunctionBeginUser;
  PetscCall(MatGetLocalSize(AX, &n, NULL));
  PetscCall(MatDenseGetLDA(AX, &ldx));
  PetscCall(MatDenseGetLDA(p->R, &ldr));
  PetscCall(MatDenseGetArrayRead(AX, &ax));
  PetscCall(MatDenseGetArray(p->R, &r));
  for (PetscInt j = p->first; j < p->end; j++) {
    const PetscComplex a  = ResidualFactor(pencil, which, c->lambda[j]);
    const PetscReal    re = creal(a), im = cimag(a);
    const PetscInt     at = c->column[j] - c->column[p->first], two = c->column[j + 1] - c->column[j] == 2;
    const PetscScalar *xr = &ax[at * ldx], *xi = &ax[(at + 1) * ldx];

    for (PetscInt k = 0; k < n; k++) r[at * ldr + k] += re * xr[k] - (two ? im * xi[k] : 0);
    for (PetscInt k = 0; k < n && two; k++) r[(at + 1) * ldr + k] += re * xi[k] + im * xr[k];
  }
  PetscCall(MatDenseRestoreArray(p->R, &r));
  PetscCall(MatDenseRestoreArrayRead(AX, &ax));
  PetscFunctionReturn(0);
}

/* Whether a matrix is known to be symmetric */
static PetscErrorCode ResidualIsSymmetric(Mat A, PetscBool *symmetric)
{
  PetscBool known;

  PetscFunctionBeginUser;
  PetscCall(MatIsSymmetricKnown(A, &known, symmetric));
  if (!known) *symmetric = PETSC_FALSE;
  PetscFunctionReturn(0);
}

/* Y = A' X by the columns of A, which takes several times as long as products with its rows */
static PetscErrorCode ResidualMultiplyTransposed(Mat A, Mat X, Mat Y)
{
  Mat AX;

  PetscFunctionBeginUser;
  PetscCall(MatTransposeMatMult(A, X, MAT_INITIAL_MATRIX, PETSC_DEFAULT, &AX));
  PetscCall(MatCopy(AX, Y, SAME_NONZERO_PATTERN));
  PetscCall(MatDestroy(&AX));
  PetscFunctionReturn(0);
}

/* Y[i] = A[i] X, or A[i]' X of those of which `transposed` says so, by rows of all that have them */
static PetscErrorCode ResidualMultiply(const Mat A[3], const PetscBool transposed[3], Mat X, const Mat Y[3])
{
  Mat      from[3], to[3];
  PetscInt n = 0;

  PetscFunctionBeginUser;
  for (int i = 0; i < 3; i++) {
    PetscBool symmetric = PETSC_TRUE;

    if (!A[i]) continue;
    if (transposed[i]) PetscCall(ResidualIsSymmetric(A[i], &symmetric));
    if (symmetric)
      from[n] = A[i], to[n++] = Y[i];
    else
      PetscCall(ResidualMultiplyTransposed(A[i], X, Y[i]));
  }
  PetscCall(BlockMultiplyEach(n, from, X, to));
  PetscFunctionReturn(0);
}

/* R += right' left X, what friction adds to K_even */
static PetscErrorCode ResidualAddFriction(const PencilMatrices *pencil, const ResidualPart *p)
{
  Mat LX, RLX;

  PetscFunctionBeginUser;
  PetscCall(MatMatMult(pencil->left, p->X, MAT_INITIAL_MATRIX, PETSC_DEFAULT, &LX));
  PetscCall(MatTransposeMatMult(pencil->right, LX, MAT_INITIAL_MATRIX, PETSC_DEFAULT, &RLX));
  PetscCall(ResidualScale(pencil, p, 0, RLX));
  PetscCall(MatDestroy(&RLX));
  PetscCall(MatDestroy(&LX));
  PetscFunctionReturn(0);
}

/* The residuals of a part */
static PetscErrorCode ResidualMakePart(const PencilMatrices *pencil, PetscBool transposed, const ResidualPart *p)
{
  const PetscBool pairs = pencil->K_even && (transposed || pencil->K == pencil->K_even) ? PETSC_TRUE : PETSC_FALSE;
  const Mat       A[3] = {pairs ? pencil->K_even : pencil->K, pencil->C, pencil->M}, Y[3] = {p->R, p->AX[0], p->AX[1]};

  PetscFunctionBeginUser;
  PetscCall(ResidualMultiply(A, (PetscBool[3]){pairs ? PETSC_FALSE : transposed, transposed, transposed}, p->X, Y));
  if (pairs) PetscCall(ResidualAddFriction(pencil, p));
  if (pencil->C) PetscCall(ResidualScale(pencil, p, 1, p->AX[0]));
  PetscCall(ResidualScale(pencil, p, 2, p->AX[1]));
  for (PetscInt l = 0; l < pencil->n_laws; l++) {
    const PencilLaw *law = &pencil->law[l];

    PetscCall(ResidualMultiply((Mat[3]){law->A}, (PetscBool[3]){law->symmetric ? PETSC_FALSE : transposed}, p->X,
                               (Mat[3]){p->AX[0]}));
    PetscCall(ResidualScale(pencil, p, 3 + l, p->AX[0]));
  }
  PetscFunctionReturn(0);
}

/* The residuals R of X */
static PetscErrorCode ResidualOf(const PencilMatrices *pencil, PetscBool transposed, const ComplexColumns *c, Mat X,
                                 Mat R)
{
  ResidualPart p = {.c = c};

  PetscFunctionBeginUser;
  for (; p.first < c->m; p.first = p.end) {
    const PetscInt from = c->column[p.first];

    for (p.end = p.first + 1; p.end < c->m && c->column[p.end + 1] - from <= RESIDUAL_WIDTH;) p.end++;
    PetscCall(MatDenseGetSubMatrix(X, PETSC_DECIDE, PETSC_DECIDE, from, c->column[p.end], &p.X));
    PetscCall(MatDenseGetSubMatrix(R, PETSC_DECIDE, PETSC_DECIDE, from, c->column[p.end], &p.R));
    for (int i = 0; i < 2; i++) PetscCall(MatDuplicate(p.X, MAT_DO_NOT_COPY_VALUES, &p.AX[i]));
    PetscCall(ResidualMakePart(pencil, transposed, &p));
    for (int i = 0; i < 2; i++) PetscCall(MatDestroy(&p.AX[i]));
    PetscCall(MatDenseRestoreSubMatrix(R, &p.R));
    PetscCall(MatDenseRestoreSubMatrix(X, &p.X));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode ResidualMake(const PencilMatrices *pencil, PetscBool transposed, const ComplexColumns *c, BV V, BV *X,
                            BV R)
{
  Mat x, r;

  PetscFunctionBeginUser;
  PetscCall(BlockCreate(V, c->n_columns, X));
  PetscCall(BlockLift(V, c->size, c->n_columns, c->coordinates, *X));
  PetscCall(BVGetMat(*X, &x));
  PetscCall(BVGetMat(R, &r));
  PetscCall(ResidualOf(pencil, transposed, c, x, r));
  PetscCall(BVRestoreMat(R, &r));
  PetscCall(BVRestoreMat(*X, &x));
  PetscFunctionReturn(0);
}

/* The active columns of Z of one side, Z = P^-1 R or P^-T R, P = Q at the shift */
static PetscErrorCode ResidualSolve(const ShiftInvert *factor, PetscBool transposed, BV R, BV Z)
{
  Mat from, to;

  PetscFunctionBeginUser;
  PetscCall(BVGetMat(R, &from));
  PetscCall(BVGetMat(Z, &to));
  PetscCall(ShiftInvertApplyBlock(factor, transposed, from, to));
  PetscCall(BVRestoreMat(Z, &to));
  PetscCall(BVRestoreMat(R, &from));
  PetscFunctionReturn(0);
}

/* Of both sides at once where friction is an update of symmetric factors: P^-1 and P^-T share their substitutions, and
   a block of both reads the factors once. */
PetscErrorCode ResidualsSolve(const ShiftInvert *factor, const BV R[2], BV Z)
{
  PetscInt  n[2] = {0, 0};
  PetscBool both;
  Mat       all;

  PetscFunctionBeginUser;
  for (int i = 0; i < 2; i++)
    if (R[i]) PetscCall(BVGetActiveColumns(R[i], NULL, &n[i]));
  both = n[0] && n[1] && factor->update ? PETSC_TRUE : PETSC_FALSE;
  for (int i = 0; i < 2; i++) {
    if (!n[i]) continue;
    PetscCall(BVSetActiveColumns(Z, i ? n[0] : 0, i ? n[0] + n[1] : n[0]));
    if (both)
      PetscCall(BVCopy(R[i], Z));
    else
      PetscCall(ResidualSolve(factor, i ? PETSC_TRUE : PETSC_FALSE, R[i], Z));
  }
  PetscCall(BVSetActiveColumns(Z, 0, n[0] + n[1]));
  if (!both) PetscFunctionReturn(0);
  PetscCall(BVGetMat(Z, &all));
  PetscCall(ShiftInvertApplyBoth((void *)factor, n[0], all));
  PetscCall(BVRestoreMat(Z, &all));
  PetscFunctionReturn(0);
}
