/*
   Products of complex vectors, as pairs of real ones x = x_0 + i x_1, with the real matrices of terms:

      x^H A x = x_0'A x_0 + x_1'A x_1 + i (x_0'A x_1 - x_1'A x_0),   y'z = sum_kl i^(k + l) y_k'z_l

   A real vector has no second part. The imaginary part of x^H A x comes from the skew part of A alone.
*/
#include "products.h"
#include "base/algebra/product.h"
#include <complex.h>

PetscErrorCode VectorForm(const CauseVector *v, Mat A, PetscReal form[2])
{
  PetscScalar d[2] = {0, 0};

  PetscFunctionBeginUser;
  form[0] = form[1] = 0;
  for (int k = 0; k < 2 && v->x[k]; k++) {
    PetscCall(MatMult(A, v->x[k], v->y));
    PetscCall(VecMDot(v->y, v->x[1] ? 2 : 1, v->x, d));
    form[0] += PetscRealPart(d[k]);
    form[1] += k ? PetscRealPart(d[0]) : -PetscRealPart(d[1]);
  }
  PetscFunctionReturn(0);
}

PetscErrorCode CauseBlockCreate(PetscInt n, const CauseVector v[], CauseBlock *block)
{
  PetscFunctionBeginUser;
  *block = (CauseBlock){.v = v};
  for (PetscInt i = 0; i < n; i++) {
    block->column[i] = block->n_columns;
    block->n_columns += v[i].x[1] ? 2 : 1;
  }
  PetscFunctionReturn(0);
}

/* X of the vectors, and room for A X */
static PetscErrorCode CauseBlockFill(CauseBlock *block)
{
  const CauseVector *v = block->v;
  PetscInt           n_own;

  PetscFunctionBeginUser;
  PetscCall(VecGetLocalSize(v->x[0], &n_own));
  PetscCall(MatCreateDense(PetscObjectComm((PetscObject)v->x[0]), n_own, PETSC_DECIDE, PETSC_DETERMINE,
                           block->n_columns, NULL, &block->X));
  for (PetscInt i = 0, k = 0; k < block->n_columns; i++)
    for (int part = 0; part < 2 && v[i].x[part]; part++, k++) {
      Vec column;

      PetscCall(MatDenseGetColumnVecWrite(block->X, k, &column));
      PetscCall(VecCopy(v[i].x[part], column));
      PetscCall(MatDenseRestoreColumnVecWrite(block->X, k, &column));
    }
  PetscCall(MatDuplicate(block->X, MAT_DO_NOT_COPY_VALUES, &block->AX));
  PetscFunctionReturn(0);
}

PetscErrorCode CauseBlockMultiply(CauseBlock *block, Mat A, PetscBool *done)
{
  MatInfo  info;
  PetscInt n;

  PetscFunctionBeginUser;
  PetscCall(MatGetInfo(A, MAT_GLOBAL_SUM, &info));
  PetscCall(MatGetSize(A, &n, NULL));
  *done = info.nz_used > n ? PETSC_TRUE : PETSC_FALSE;
  if (!*done) PetscFunctionReturn(0);
  if (!block->X) PetscCall(CauseBlockFill(block));
  PetscCall(BlockMultiply(A, block->X, block->AX));
  PetscFunctionReturn(0);
}

PetscErrorCode CauseBlockForm(const CauseBlock *block, PetscInt i, PetscReal form[2])
{
  const CauseVector *v    = &block->v[i];
  PetscScalar        d[2] = {0, 0};

  PetscFunctionBeginUser;
  form[0] = form[1] = 0;
  for (int k = 0; k < 2 && v->x[k]; k++) {
    Vec product;

    PetscCall(MatDenseGetColumnVecRead(block->AX, block->column[i] + k, &product));
    PetscCall(VecMDot(product, v->x[1] ? 2 : 1, v->x, d));
    PetscCall(MatDenseRestoreColumnVecRead(block->AX, block->column[i] + k, &product));
    form[0] += PetscRealPart(d[k]);
    form[1] += k ? PetscRealPart(d[0]) : -PetscRealPart(d[1]);
  }
  PetscFunctionReturn(0);
}

PetscErrorCode CauseBlockDestroy(CauseBlock *block)
{
  PetscFunctionBeginUser;
  PetscCall(MatDestroy(&block->X));
  PetscCall(MatDestroy(&block->AX));
  PetscFunctionReturn(0);
}

PetscErrorCode VectorRestrict(Pencil pencil, const CauseVector *u, CauseVector *q)
{
  PetscFunctionBeginUser;
  *q = (CauseVector){{NULL, NULL}, NULL};
  if (!pencil->Zr) PetscFunctionReturn(0);
  for (int k = 0; k < 2 && u->x[k]; k++) {
    PetscCall(MatCreateVecs(pencil->Zr, &q->x[k], NULL));
    PetscCall(PencilRestrict(pencil, u->x[k], q->x[k]));
  }
  PetscCall(VecDuplicate(q->x[0], &q->y));
  PetscFunctionReturn(0);
}

PetscErrorCode VectorDestroy(CauseVector *v)
{
  PetscFunctionBeginUser;
  for (int k = 0; k < 2; k++) PetscCall(VecDestroy(&v->x[k]));
  PetscCall(VecDestroy(&v->y));
  PetscFunctionReturn(0);
}

/* product = y' z, without conjugation */
static PetscErrorCode VectorDot(const CauseVector *y, const CauseVector *z, PetscComplex *product)
{
  PetscScalar d[2];

  PetscFunctionBeginUser;
  *product = 0;
  for (int k = 0; k < 2 && z->x[k]; k++) {
    PetscCall(VecMDot(z->x[k], y->x[1] ? 2 : 1, (Vec *)y->x, d));
    *product += (k ? I : 1) * CMPLX(d[0], y->x[1] ? d[1] : 0);
  }
  PetscFunctionReturn(0);
}

PetscErrorCode VectorProduct(const CauseVector *y, Mat A, PetscBool turned, const CauseVector *x, PetscComplex *product)
{
  CauseVector z = {{NULL, NULL}, NULL};

  PetscFunctionBeginUser;
  for (int k = 0; k < 2 && x->x[k]; k++) {
    PetscCall(VecDuplicate(x->x[k], &z.x[k]));
    if (turned)
      PetscCall(MatMultTranspose(A, x->x[k], z.x[k]));
    else
      PetscCall(MatMult(A, x->x[k], z.x[k]));
  }
  PetscCall(VectorDot(y, &z, product));
  PetscCall(VectorDestroy(&z));
  PetscFunctionReturn(0);
}
