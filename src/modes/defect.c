/*
   Errors of modes whose right and left vectors are next to orthogonal: of a pair of eigenvalues that is close to
   defective, as at a lock-in. Their condition c = |x| |y| / |y^T D x| has no limit, nor has the error of first order,
   c e, e what is wrong with the matrices. In the plane of such a pair, with an orthonormal basis x, v,

      A = [kappa_1, h; 0, kappa_2],   kappa = -lambda^2,   c = sqrt(1 + (h / (kappa_1 - kappa_2))^2),

   and what a change E of A does to an eigenvalue is the nearest root s of

      (s - kappa_1 - E_11) (s - kappa_2 - E_22) = E_21 (h + E_12),   |s - kappa| <= 2 e + sqrt(e (h + e)),

   which holds at h / (kappa_1 - kappa_2) = infinity too, where c e does not. The departure from a normal matrix is
   h = x^H Q(lambda) v, since Q(lambda) v = (A - kappa) v. For v, which the pair has but the solution may not, the left
   vector stands, conj(y), which is orthogonal to x there. Where three modes meet, eigenvalues move by (h^2 e)^(1/3)
   instead, and come out so far apart that c e is of that size. So no third may lie within DEFECT_REACH c e; what is
   beyond DEFECT_APART of the eigenvalue is too far to meet it.
*/
#include "complexvec.h"

#define DEFECT_FROM  100 /* condition; below it the first order is as good */
#define DEFECT_REACH 30
#define DEFECT_APART 1e-4

PetscBool DefectIsNear(PetscReal condition)
{
  return condition < DEFECT_FROM ? PETSC_FALSE : PETSC_TRUE;
}

/* |x^H z| */
static PetscErrorCode InnerSize(ComplexVec x, ComplexVec z, PetscReal *size)
{
  PetscComplex re, im = 0;

  PetscFunctionBeginUser;
  PetscCall(ComplexVecDot((ComplexVec){x.r, NULL}, z, &re));
  if (x.i) PetscCall(ComplexVecDot((ComplexVec){x.i, NULL}, z, &im));
  *size = cabs(re - I * im);
  PetscFunctionReturn(0);
}

PetscErrorCode DefectMeasure(const PencilMatrices *pencil, PetscComplex lambda, const ComplexVec v[2], ComplexVec Qx,
                             ComplexVec work, Defect *defect)
{
  const Mat          A[3]      = {pencil->K, pencil->C, pencil->M};
  const PetscComplex factor[3] = {1, conj(lambda), conj(lambda) * conj(lambda)};

  PetscFunctionBeginUser;
  defect->near = PETSC_TRUE;
  PetscCall(InnerSize(v[0], Qx, &defect->along));
  PetscCall(VecSet(Qx.r, 0));
  PetscCall(VecSet(Qx.i, 0));
  for (int k = 0; k < 3; k++) { /* conj(Q v) = conj(Q) y */
    if (!A[k]) continue;
    PetscCall(ComplexVecMult(A[k], v[1], work));
    PetscCall(ComplexVecAXPY(factor[k], work, Qx));
  }
  PetscCall(ComplexVecAddLaws(pencil, lambda, (ComplexVec){v[1].r, v[1].i}, Qx, (ComplexVec){NULL, NULL}));
  PetscCall(VecScale(Qx.i, -1));
  PetscCall(InnerSize(v[0], Qx, &defect->departure));
  PetscFunctionReturn(0);
}

PetscReal DefectError(const Spectrum *s, PetscInt i, const Defect *defect, PetscReal across, PetscReal first)
{
  const PetscComplex lambda = SpectrumLambda(s, i);
  const PetscReal    size = cabs(lambda), reach = PetscMin(DEFECT_REACH * first / (2 * size), DEFECT_APART * size);
  PetscInt           n = 0;

  if (!defect->near) return first;
  for (PetscInt k = 0; k < s->n; k++)
    if (k != i && cabs(SpectrumLambda(s, k) - lambda) <= reach) n++;
  if (n > 1) return first;
  return PetscMin(first, 2 * defect->along + PetscSqrtReal(across * (defect->departure + across)));
}
