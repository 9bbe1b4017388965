/*
   Terms of the contact, linearised about steady sliding with normal force N0 and speed v per pair:
      K += k_n N'N + mu k_n (-T'N)             normal stiffness and friction          (seed paper, eq. 1)
      C += |mu| N / V B'B_w + mu' N T'T_w      friction damping across and along the slip, mu' = d mu / d v
   of each interface. N is its total normal force, V its sliding speed or, where the slip comes from a rotation, the
   angular velocity; B'B_w and T'T_w carry N0 / N and V / v of each pair. Signs: slip velocity of the slave relative to
   the master is v t - d/dt (T u) t - d/dt (B u) b, friction on the master acts along it, and internal forces stand on
   the left.
*/
#include "operatorsimpl.h"
#include <math.h>

/* scale L' W R with W = diag(weights), or the identity where weights is NULL */
static PetscErrorCode ProductCreate(PetscReal scale, Mat L, Vec weights, Mat R, Mat *A)
{
  Mat WR = R;

  PetscFunctionBeginUser;
  if (weights) {
    PetscCall(MatDuplicate(R, MAT_COPY_VALUES, &WR));
    PetscCall(MatDiagonalScale(WR, weights, NULL));
  }
  PetscCall(MatTransposeMatMult(L, WR, MAT_INITIAL_MATRIX, PETSC_DEFAULT, A));
  PetscCall(MatProductClear(*A));
  PetscCall(MatScale(*A, scale));
  if (weights) PetscCall(MatDestroy(&WR));
  PetscFunctionReturn(0);
}

/* Angular velocity of the master, rad/s */
static PetscReal AngularVelocity(const ContactInterface *c)
{
  const PetscReal *w = c->rotation;

  return PetscSqrtReal(w[0] * w[0] + w[1] * w[1] + w[2] * w[2]);
}

/* Weights of the pairs of one interface: along = N0 / N, across = N0 / N V / v */
static PetscErrorCode WeightsSet(Operators o, PetscInt interface, const ContactInterface *c, Vec across, Vec along)
{
  const PetscReal    speed = AngularVelocity(c) > 0 ? AngularVelocity(c) : c->speed;
  const ContactPair *pairs;
  PetscInt           n, n_all, row;

  PetscFunctionBeginUser;
  PetscCall(VecGetOwnershipRange(across, &row, NULL));
  PetscCall(ContactGetPairs(o->contact, &n, &n_all, &pairs));
  for (PetscInt p = 0; p < n; p++) {
    const PetscReal share = pairs[p].force / c->force;

    if (pairs[p].interface != interface) continue;
    PetscCall(VecSetValue(across, row, share * speed / pairs[p].speed, INSERT_VALUES));
    PetscCall(VecSetValue(along, row++, share, INSERT_VALUES));
  }
  PetscCall(VecAssemblyBegin(across));
  PetscCall(VecAssemblyEnd(across));
  PetscCall(VecAssemblyBegin(along));
  PetscCall(VecAssemblyEnd(along));
  PetscFunctionReturn(0);
}

/* Parameters and terms of the friction damping of one interface; mu = index of its friction coefficient */
static PetscErrorCode DampingAdd(Operators o, PetscInt interface, const ContactInterface *c, PetscInt mu, Mat T, Mat B)
{
  const PetscReal turning = AngularVelocity(c);
  OperatorsTerm  *term;
  PetscInt        slope, force, speed;
  Vec             across, along;
  Mat             BB, TT;

  PetscFunctionBeginUser;
  PetscCall(ParameterAdd(o, c->name, "mu_slope", "s/m", c->mu_slope, -INFINITY, PETSC_FALSE, &slope));
  PetscCall(ParameterAdd(o, c->name, "force", "N", c->force, 0, PETSC_TRUE, &force));
  if (turning > 0)
    PetscCall(ParameterAdd(o, c->name, "rotation", "rad/s", turning, 0, PETSC_FALSE, &speed));
  else
    PetscCall(ParameterAdd(o, c->name, "speed", "m/s", c->speed, 0, PETSC_FALSE, &speed));
  PetscCall(MatCreateVecs(T, NULL, &across));
  PetscCall(VecDuplicate(across, &along));
  PetscCall(WeightsSet(o, interface, c, across, along));
  PetscCall(ProductCreate(1, B, across, B, &BB));
  PetscCall(ProductCreate(1, T, along, T, &TT));
  PetscCall(TermsAdd(&o->base, OPERATORS_DAMPING, TT, PETSC_TRUE, 2, (PetscInt[]){slope, force}));
  PetscCall(TermsAdd(&o->base, OPERATORS_DAMPING, BB, PETSC_TRUE, 3, (PetscInt[]){mu, force, speed}));
  term                     = &o->base.term[o->base.n - 1];
  term->factor[0].absolute = PETSC_TRUE;
  term->factor[2].power    = -1;
  PetscCall(MatDestroy(&BB));
  PetscCall(MatDestroy(&TT));
  PetscCall(VecDestroy(&across));
  PetscCall(VecDestroy(&along));
  PetscFunctionReturn(0);
}

/* Parameter and terms of the penalty law of one interface; mu = -1 where nothing says along what it slides */
static PetscErrorCode PenaltyAdd(Operators o, const ContactInterface *c, PetscInt mu, Mat N, Mat T)
{
  PetscInt kn;
  Mat      NN, TN;

  PetscFunctionBeginUser;
  PetscCall(ParameterAdd(o, c->name, "kn", "N/m", c->kn, 0, PETSC_FALSE, &kn));
  PetscCall(ProductCreate(1, N, NULL, N, &NN));
  PetscCall(TermsAdd(&o->base, OPERATORS_STIFFNESS, NN, PETSC_TRUE, 1, &kn));
  PetscCall(MatDestroy(&NN));
  if (mu < 0) PetscFunctionReturn(0);
  PetscCall(ProductCreate(-1, T, NULL, N, &TN));
  PetscCall(TermsAdd(&o->base, OPERATORS_STIFFNESS, TN, PETSC_FALSE, 2, (PetscInt[]){kn, mu}));
  PetscCall(MatDestroy(&TN));
  PetscFunctionReturn(0);
}

PetscErrorCode OperatorsAddContact(Operators o)
{
  const ContactInterface *c;
  PetscInt                n;

  PetscFunctionBeginUser;
  PetscCall(ContactGetInterfaces(o->contact, &n, &c));
  PetscCall(PetscMalloc1(n, &o->interface_mu));
  for (PetscInt i = 0; i < n; i++) {
    Mat N, T, B;

    o->interface_mu[i] = -1;
    PetscCall(ContactCreateOperators(o->contact, i, &N, &T, &B));
    if (c[i].slides) PetscCall(ParameterAddMu(o, c[i].name, c[i].mu, &o->interface_mu[i]));
    if (c[i].law == CONTACT_PENALTY) PetscCall(PenaltyAdd(o, &c[i], o->interface_mu[i], N, T));
    if (c[i].damping) PetscCall(DampingAdd(o, i, &c[i], o->interface_mu[i], T, B));
    PetscCall(MatDestroy(&N));
    PetscCall(MatDestroy(&T));
    PetscCall(MatDestroy(&B));
  }
  PetscFunctionReturn(0);
}
