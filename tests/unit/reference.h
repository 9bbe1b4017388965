/* What stiffness and damping of a brake are to do: the action of the bodies and of N, T, B of the contact, row by row */
#pragma once

#include "brake.h"
#include "pairs.h"
#include <string.h>

/* y += scale L' diag(weight) R x, weight of this rank's rows */
static inline PetscErrorCode AddProduct(PetscReal scale, Mat L, const PetscReal weight[], Mat R, Vec x, Vec y)
{
  PetscScalar *value;
  PetscInt     n;
  Vec          r, z;

  PetscFunctionBeginUser;
  PetscCall(MatCreateVecs(R, NULL, &r));
  PetscCall(MatMult(R, x, r));
  PetscCall(VecGetLocalSize(r, &n));
  PetscCall(VecGetArray(r, &value));
  for (PetscInt i = 0; i < n; i++) value[i] *= scale * weight[i];
  PetscCall(VecRestoreArray(r, &value));
  PetscCall(VecDuplicate(y, &z));
  PetscCall(MatMultTranspose(L, r, z));
  PetscCall(VecAXPY(y, 1, z));
  PetscCall(VecDestroy(&r));
  PetscCall(VecDestroy(&z));
  PetscFunctionReturn(0);
}

/* K x of the penalty law: bodies, and k_n N'N - mu k_n T'N of each interface, its pairs as far as they are closed */
static inline PetscErrorCode ReferenceStiffness(Chain *chain, const PetscReal factor[], Vec x, Vec y)
{
  const ContactInterface *c;
  const PetscReal        *point;
  PetscInt                n_interfaces, first = 0, n;
  Mat                     bodies, N, T;

  PetscFunctionBeginUser;
  PetscCall(PencilGetParameters(chain->pencil, NULL, NULL, &point));
  PetscCall(OperatorsGetBodies(chain->operators, point, &bodies, NULL, NULL));
  PetscCall(MatMult(bodies, x, y));
  PetscCall(ContactGetInterfaces(chain->contact, &n_interfaces, &c));
  for (PetscInt i = 0; i < n_interfaces; i++, first += n) {
    PetscReal   mu, kn;
    PressureLaw law;

    PetscCall(OperatorsGetInterface(chain->operators, point, i, &mu, &law));
    kn = PressureSlope(&law, 0);
    PetscCall(InterfaceOperators(chain->contact, i, &N, &T, NULL));
    PetscCall(MatGetLocalSize(N, &n, NULL));
    PetscCall(AddProduct(kn, N, &factor[first], N, x, y));
    PetscCall(AddProduct(-mu * kn, T, &factor[first], N, x, y));
    PetscCall(MatDestroy(&N));
    PetscCall(MatDestroy(&T));
  }
  PetscFunctionReturn(0);
}

/* Value of a parameter by name */
static inline PetscErrorCode ParameterGet(Pencil o, const char name[], PetscReal *value)
{
  const OperatorsParameter *q;
  const PetscReal          *p;
  PetscInt                  n;

  PetscFunctionBeginUser;
  *value = NAN;
  PetscCall(PencilGetParameters(o, &n, &q, &p));
  for (PetscInt i = 0; i < n; i++)
    if (!strcmp(q[i].name, name)) *value = p[i];
  PetscFunctionReturn(0);
}

/* C x: that of the bodies, and |mu| / v B'(N0) B + mu' T'(N0) T of the pairs, N0 as lambda_n or, where it is NULL, as
   -contact_force shared by area; one interface */
static inline PetscErrorCode ReferenceDamping(Chain *chain, const PetscReal factor[], const PetscReal lambda_n[], Vec x,
                                              Vec y)
{
  const ContactPair *pair;
  const PetscReal   *point;
  PetscInt           n, n_all;
  PetscReal          force, mu, slope, speed, total = 0, weight[MAX_PAIRS];
  PressureLaw        law;
  Mat                C, T, B;

  PetscFunctionBeginUser;
  PetscCall(PencilGetParameters(chain->pencil, NULL, NULL, &point));
  PetscCall(OperatorsGetBodies(chain->operators, point, NULL, NULL, &C));
  PetscCall(MatMult(C, x, y));
  PetscCall(ParameterGet(chain->pencil, "contact_force", &force));
  PetscCall(ParameterGet(chain->pencil, "contact_mu_slope", &slope));
  PetscCall(ParameterGet(chain->pencil, "contact_speed", &speed));
  PetscCall(OperatorsGetInterface(chain->operators, point, 0, &mu, &law));
  PetscCall(ContactGetPairs(chain->contact, &n, &n_all, &pair));
  for (PetscInt p = 0; p < n; p++) total += pair[p].area;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &total, 1, MPIU_REAL, MPI_SUM, PETSC_COMM_WORLD));
  for (PetscInt p = 0; p < n; p++) weight[p] = factor[p] * (lambda_n ? lambda_n[p] : force * pair[p].area / total);
  PetscCall(InterfaceOperators(chain->contact, 0, NULL, &T, &B));
  PetscCall(AddProduct(PetscAbsReal(mu) / speed, B, weight, B, x, y));
  PetscCall(AddProduct(slope, T, weight, T, x, y));
  PetscCall(MatDestroy(&T));
  PetscCall(MatDestroy(&B));
  PetscFunctionReturn(0);
}

/* |A x - y| / |y| */
static inline PetscErrorCode ActionDistance(Mat A, Vec x, Vec y, PetscReal *distance)
{
  PetscReal norm;
  Vec       z;

  PetscFunctionBeginUser;
  PetscCall(VecDuplicate(y, &z));
  PetscCall(MatMult(A, x, z));
  PetscCall(VecAXPY(z, -1, y));
  PetscCall(VecNorm(z, NORM_2, distance));
  PetscCall(VecNorm(y, NORM_2, &norm));
  *distance /= norm;
  PetscCall(VecDestroy(&z));
  PetscFunctionReturn(0);
}
