/*
   Products of complex vectors, as pairs of real ones, with the real matrices of terms.
*/
#include "products.h"
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
