/*
   Products of complex vectors with real matrices; see complexvec.h.
*/
#include "complexvec.h"
#include "solver/block/orthonormal.h"

PetscErrorCode ComplexVecDot(ComplexVec x, ComplexVec z, PetscComplex *dot)
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

PetscErrorCode ComplexVecAXPY(PetscComplex a, ComplexVec x, ComplexVec z)
{
  PetscFunctionBeginUser;
  PetscCall(VecAXPY(z.r, creal(a), x.r));
  if (cimag(a) != 0) PetscCall(VecAXPY(z.i, cimag(a), x.r));
  if (!x.i) PetscFunctionReturn(0);
  PetscCall(VecAXPY(z.i, creal(a), x.i));
  if (cimag(a) != 0) PetscCall(VecAXPY(z.r, -cimag(a), x.i));
  PetscFunctionReturn(0);
}

PetscErrorCode ComplexVecMult(Mat A, ComplexVec x, ComplexVec z)
{
  PetscFunctionBeginUser;
  PetscCall(MatMult(A, x.r, z.r));
  if (x.i)
    PetscCall(MatMult(A, x.i, z.i));
  else
    PetscCall(VecSet(z.i, 0));
  PetscFunctionReturn(0);
}

/* z += a A x */
static PetscErrorCode ComplexVecMultAdd(Mat A, PetscComplex a, ComplexVec x, Vec work, ComplexVec z)
{
  PetscFunctionBeginUser;
  PetscCall(MatMult(A, x.r, work));
  PetscCall(ComplexVecAXPY(a, (ComplexVec){work, NULL}, z));
  if (!x.i) PetscFunctionReturn(0);
  PetscCall(MatMult(A, x.i, work));
  PetscCall(ComplexVecAXPY(a * I, (ComplexVec){work, NULL}, z));
  PetscFunctionReturn(0);
}

PetscErrorCode ComplexVecAddLaws(const PencilMatrices *pencil, PetscComplex lambda, ComplexVec x, ComplexVec z,
                                 ComplexVec d)
{
  Vec work;

  PetscFunctionBeginUser;
  if (!pencil->n_laws) PetscFunctionReturn(0);
  PetscCall(VecDuplicate(x.r, &work));
  for (PetscInt l = 0; l < pencil->n_laws; l++) {
    PetscComplex       slope;
    const PetscComplex h = PencilLawAt(&pencil->law[l], lambda, &slope);

    if (z.r) PetscCall(ComplexVecMultAdd(pencil->law[l].A, h, x, work, z));
    if (d.r && lambda != 0) PetscCall(ComplexVecMultAdd(pencil->law[l].A, slope / (2 * lambda), x, work, d));
  }
  PetscCall(VecDestroy(&work));
  PetscFunctionReturn(0);
}

PetscErrorCode ComplexVecApplyD(const PencilMatrices *pencil, PetscComplex lambda, ComplexVec x, Vec work, ComplexVec z)
{
  PetscFunctionBeginUser;
  PetscCall(ComplexVecMult(pencil->M, x, z));
  if (pencil->C && cabs(lambda) > 0) PetscCall(ComplexVecMultAdd(pencil->C, 1 / (2 * lambda), x, work, z));
  PetscCall(ComplexVecAddLaws(pencil, lambda, x, (ComplexVec){NULL, NULL}, z));
  PetscFunctionReturn(0);
}

PetscErrorCode SpectrumMultiply(const Spectrum *s, PetscInt first, PetscInt n, PetscInt n_matrices, const Mat A[],
                                Mat AX[])
{
  PetscInt n_local, n_columns = n, column = 0;
  Mat      X;

  PetscFunctionBeginUser;
  for (PetscInt i = first; i < first + n; i++) n_columns += s->xi[i] ? 1 : 0;
  PetscCall(MatGetLocalSize(A[0], &n_local, NULL));
  PetscCall(
    MatCreateDense(PetscObjectComm((PetscObject)A[0]), n_local, PETSC_DECIDE, PETSC_DETERMINE, n_columns, NULL, &X));
  for (PetscInt i = first; i < first + n; i++)
    for (int part = 0; part < 2; part++) {
      const Vec from = part ? s->xi[i] : s->xr[i];
      Vec       to;

      if (!from) continue;
      PetscCall(MatDenseGetColumnVecWrite(X, column, &to));
      PetscCall(VecCopy(from, to));
      PetscCall(MatDenseRestoreColumnVecWrite(X, column++, &to));
    }
  for (PetscInt i = 0; i < n_matrices; i++) PetscCall(MatDuplicate(X, MAT_DO_NOT_COPY_VALUES, &AX[i]));
  PetscCall(BlockMultiplyEach(n_matrices, A, X, AX));
  PetscCall(MatDestroy(&X));
  PetscFunctionReturn(0);
}
