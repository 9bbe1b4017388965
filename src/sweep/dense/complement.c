/*
   The vectors Z of a basis [V Z] without what V can do in their place. With Q in blocks at a real shift h

      T = Q_vv(h)^-1 Q_vz(h),   T' = Q_vv(h)^-T Q_zv(h)^T,   right Z - V T,   left Z - V T',

   do not couple to V at h. Where V has vectors that are stiff, as the short ones of a stiff contact, what they and Z do
   to each other is as large as what each does alone, and only the sum is small: elimination of Z alone changes those
   vectors by more than they are. Without the couplings at h, those at an eigenvalue lambda are (lambda^2 - h^2) M
   + (lambda - h) C, which has no stiffness in it. On the new vectors the matrices are, for A of C, M

      A := A_zz - A_zv T - T'^T (A_vz - A_vv T),   Q(h) := Q_zz(h) - Q_zv(h) T,   K = Q(h) - h C - h^2 M.
*/
#include "estimate.h"
#include "base/algebra/dense.h"

/* A_zz of C or M on the new vectors */
static PetscErrorCode ComplementMatrix(const Estimate *e, const PetscReal A[], PetscReal Z[])
{
  const PetscInt v = e->n_v, z = e->n_z, n = e->pencil.n;
  PetscReal     *coupling;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(v * z, &coupling));
  DenseBlockGet((DenseBlock){A + v * n, v, z, n}, PETSC_FALSE, coupling);
  PetscCall(DenseSubtract((DenseBlock){A, v, v, n}, PETSC_FALSE, z, e->right, coupling));
  DenseBlockGet((DenseBlock){A + v * (n + 1), z, z, n}, PETSC_FALSE, Z);
  PetscCall(DenseSubtract((DenseBlock){A + v, z, v, n}, PETSC_FALSE, z, e->right, Z));
  PetscCall(DenseSubtract((DenseBlock){e->left, z, v, v}, PETSC_TRUE, z, coupling, Z));
  PetscCall(PetscFree(coupling));
  PetscFunctionReturn(0);
}

/* T and T', [n_z][n_v], from Q(h) by one LU of Q_vv; a singular Q_vv leaves Z as it is (T = T' = 0), which makes
   the estimate coarser, not wrong. */
static PetscErrorCode ComplementVectors(Estimate *e, const PetscReal Q[])
{
  const PetscInt v = e->n_v, z = e->n_z, n = e->pencil.n;
  PetscReal     *LU;
  PetscBLASInt  *pivot;
  PetscBool      singular;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(v * v, &LU, v, &pivot));
  DenseBlockGet((DenseBlock){Q, v, v, n}, PETSC_FALSE, LU);
  DenseBlockGet((DenseBlock){Q + v * n, v, z, n}, PETSC_FALSE, e->right);
  DenseBlockGet((DenseBlock){Q + v, z, v, n}, PETSC_TRUE, e->left);
  PetscCall(DenseFactor(v, LU, pivot, &singular));
  if (singular) { /* as they are */
    PetscCall(PetscArrayzero(e->right, v * z));
    PetscCall(PetscArrayzero(e->left, v * z));
  } else {
    PetscCall(DenseSolve(v, LU, pivot, PETSC_FALSE, z, e->right));
    PetscCall(DenseSolve(v, LU, pivot, PETSC_TRUE, z, e->left));
  }
  PetscCall(PetscFree2(LU, pivot));
  PetscFunctionReturn(0);
}

/* h, rad/s, is real: everything stays in real arithmetic. K of the complement comes from Q(h), where the couplings
   vanish, by subtraction of h C + h^2 M: directly formed it would need the stiffness couplings, whose difference is
   what is small. */
PetscErrorCode EstimateComplement(Estimate *e, PetscReal h)
{
  const PetscInt v = e->n_v, z = e->n_z, n = e->pencil.n;
  DensePencil   *own = &e->complement;
  PetscReal     *Q;

  PetscFunctionBeginUser;
  own->n      = z;
  own->damped = e->pencil.damped;
  PetscCall(PetscMalloc3(z * z, &own->K, z * z, &own->C, z * z, &own->M));
  PetscCall(PetscMalloc2(v * z, &e->right, v * z, &e->left));
  PetscCall(PetscMalloc1(n * n, &Q));
  DensePencilAt(&e->pencil, h, h * h, Q);
  PetscCall(ComplementVectors(e, Q));
  PetscCall(ComplementMatrix(e, e->pencil.M, own->M));
  if (own->damped) PetscCall(ComplementMatrix(e, e->pencil.C, own->C));
  DenseBlockGet((DenseBlock){Q + v * (n + 1), z, z, n}, PETSC_FALSE, own->K);
  PetscCall(DenseSubtract((DenseBlock){Q + v, z, v, n}, PETSC_FALSE, z, e->right, own->K));
  for (PetscInt i = 0; i < z * z; i++) own->K[i] -= h * h * own->M[i] + (own->damped ? h * own->C[i] : 0);
  PetscCall(PetscFree(Q));
  PetscFunctionReturn(0);
}
