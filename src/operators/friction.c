/*
   Contact in the matrices, linearised about steady sliding with normal force N0 and speed v per pair:
      K += k_n N'N                         normal stiffness, symmetric          (seed paper, eq. 1)
      H  = - sum_i (mu_i / mu) k_n T'N     friction per unit mu, unsymmetric     (seed paper, eq. 1)
      C += (|mu| N0 / v) B'B + mu' N0 T'T    friction damping across and along the slip, mu' = d mu / d v
   mu is the largest friction coefficient of all interfaces in absolute value. Signs: slip velocity of the slave
   relative to the master is v t - d/dt (T u) t - d/dt (B u) b, friction on the master acts along it, and internal
   forces stand on the left.
*/
#include "operatorsimpl.h"

/* A += scale L' W R with W = diag(weights), or the identity where weights is NULL; A may be NULL and is then made */
static PetscErrorCode ProductAdd(PetscReal scale, Mat L, Vec weights, Mat R, Mat *A)
{
  Mat product, WR = R;

  PetscFunctionBeginUser;
  if (weights) {
    PetscCall(MatDuplicate(R, MAT_COPY_VALUES, &WR));
    PetscCall(MatDiagonalScale(WR, weights, NULL));
  }
  PetscCall(MatTransposeMatMult(L, WR, MAT_INITIAL_MATRIX, PETSC_DEFAULT, &product));
  if (weights) PetscCall(MatDestroy(&WR));
  if (*A) {
    PetscCall(MatAXPY(*A, scale, product, DIFFERENT_NONZERO_PATTERN));
    PetscCall(MatDestroy(&product));
  } else {
    PetscCall(MatScale(product, scale));
    *A = product;
  }
  PetscFunctionReturn(0);
}

/* Friction damping of one interface */
static PetscErrorCode DampingAdd(Operators o, PetscInt interface, const ContactInterface *c, Mat T, Mat B)
{
  const ContactPair *pairs;
  PetscInt           n, n_all, row;
  Vec                across, along;

  PetscFunctionBeginUser;
  PetscCall(MatCreateVecs(T, NULL, &across));
  PetscCall(VecDuplicate(across, &along));
  PetscCall(VecGetOwnershipRange(across, &row, NULL));
  PetscCall(ContactGetPairs(o->contact, &n, &n_all, &pairs));
  for (PetscInt p = 0; p < n; p++) {
    if (pairs[p].interface != interface) continue;
    PetscCall(VecSetValue(across, row, PetscAbsReal(c->mu) * pairs[p].force / pairs[p].speed, INSERT_VALUES));
    PetscCall(VecSetValue(along, row, c->mu_slope * pairs[p].force, INSERT_VALUES));
    row++;
  }
  PetscCall(VecAssemblyBegin(across));
  PetscCall(VecAssemblyEnd(across));
  PetscCall(VecAssemblyBegin(along));
  PetscCall(VecAssemblyEnd(along));
  if (c->mu != 0) PetscCall(ProductAdd(1, B, across, B, &o->A[OPERATOR_C]));
  if (c->mu_slope != 0) PetscCall(ProductAdd(1, T, along, T, &o->A[OPERATOR_C]));
  PetscCall(VecDestroy(&across));
  PetscCall(VecDestroy(&along));
  PetscFunctionReturn(0);
}

PetscErrorCode OperatorsAddContact(Operators o)
{
  const ContactInterface *c;
  PetscInt                n;

  PetscFunctionBeginUser;
  PetscCall(ContactGetInterfaces(o->contact, &n, &c));
  o->mu = 0;
  for (PetscInt i = 0; i < n; i++)
    if (PetscAbsReal(c[i].mu) > PetscAbsReal(o->mu)) o->mu = c[i].mu;
  for (PetscInt i = 0; i < n; i++) {
    Mat N, T, B;

    PetscCall(ContactCreateOperators(o->contact, i, &N, &T, &B));
    if (c[i].law == CONTACT_PENALTY) {
      PetscCall(ProductAdd(c[i].kn, N, NULL, N, &o->A[OPERATOR_K]));
      if (o->mu != 0) PetscCall(ProductAdd(-c[i].kn * c[i].mu / o->mu, T, NULL, N, &o->A[OPERATOR_H]));
    }
    if (c[i].damping) PetscCall(DampingAdd(o, i, &c[i], T, B));
    PetscCall(MatDestroy(&N));
    PetscCall(MatDestroy(&T));
    PetscCall(MatDestroy(&B));
  }
  PetscFunctionReturn(0);
}
