/*
   Products of complex vectors with real matrices; see complexvec.h.
*/
#include "complexvec.h"

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

/* z += a A x; z.i must be there */
static PetscErrorCode ComplexVecMultAdd(Mat A, PetscComplex a, ComplexVec x, Vec work, ComplexVec z)
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

static PetscErrorCode ComplexVecZero(ComplexVec z)
{
  PetscFunctionBeginUser;
  PetscCall(VecSet(z.r, 0));
  if (z.i) PetscCall(VecSet(z.i, 0));
  PetscFunctionReturn(0);
}

PetscErrorCode PencilApplyD(const OperatorsPencil *pencil, PetscComplex lambda, ComplexVec x, Vec work, ComplexVec z)
{
  PetscFunctionBeginUser;
  PetscCall(ComplexVecZero(z));
  PetscCall(ComplexVecMultAdd(pencil->M, 1, x, work, z));
  if (pencil->C && cabs(lambda) > 0) PetscCall(ComplexVecMultAdd(pencil->C, 1 / (2 * lambda), x, work, z));
  PetscFunctionReturn(0);
}

PetscErrorCode PencilApplyQ(const OperatorsPencil *pencil, PetscComplex lambda, ComplexVec x, Vec work, ComplexVec z)
{
  PetscFunctionBeginUser;
  PetscCall(ComplexVecZero(z));
  PetscCall(ComplexVecMultAdd(pencil->K, 1, x, work, z));
  PetscCall(ComplexVecMultAdd(pencil->M, lambda * lambda, x, work, z));
  if (pencil->C) PetscCall(ComplexVecMultAdd(pencil->C, lambda, x, work, z));
  PetscFunctionReturn(0);
}
