/*
   Terms of the contact, linearised about steady sliding with normal force N0 and speed v per pair:
      K += k_n N'N + mu k_n (-T'N)             normal stiffness and friction          (seed paper, eq. 1)
      C += |mu| N / V B'B_w + mu' N T'T_w      friction damping across and along the slip, mu' = d mu / d v
   of each interface. N is its total normal force, V its sliding speed or, where the slip comes from a rotation, the
   angular velocity; B'B_w and T'T_w carry N0 / N and V / v of each pair. Only closed pairs take part; those of a group
   g make terms of their own, with the parameter closed_g as one more factor. Signs: slip velocity of the slave relative
   to the master is v t - d/dt (T u) t - d/dt (B u) b, friction on the master acts along it, and internal forces stand
   on the left.
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

/* Closed pairs of one interface in one group */
typedef struct {
  PetscInt n, *pair; /* of this rank */
  Mat      N, T, B;
} FrictionRows;

static PetscErrorCode FrictionRowsCreate(Operators o, PetscInt interface, PetscInt group, FrictionRows *rows)
{
  const ContactPair *pairs;
  PetscInt           n, n_all;

  PetscFunctionBeginUser;
  PetscCall(ContactGetPairs(o->contact, &n, &n_all, &pairs));
  PetscCall(PetscMalloc1(n, &rows->pair));
  rows->n = 0;
  for (PetscInt p = 0; p < n; p++)
    if (pairs[p].interface == interface && OperatorsPairGroup(o, p) == group) rows->pair[rows->n++] = p;
  PetscCall(ContactCreatePairOperators(o->contact, rows->n, rows->pair, &rows->N, &rows->T, &rows->B));
  PetscFunctionReturn(0);
}

static PetscErrorCode FrictionRowsDestroy(FrictionRows *rows)
{
  PetscFunctionBeginUser;
  PetscCall(MatDestroy(&rows->N));
  PetscCall(MatDestroy(&rows->T));
  PetscCall(MatDestroy(&rows->B));
  PetscCall(PetscFree(rows->pair));
  PetscFunctionReturn(0);
}

/* Weights of the pairs: along = N0 / N, across = N0 / N V / v */
static PetscErrorCode WeightsSet(Operators o, const ContactInterface *c, const FrictionRows *rows, Vec across,
                                 Vec along)
{
  const PetscReal    speed = AngularVelocity(c) > 0 ? AngularVelocity(c) : c->speed;
  const ContactPair *pairs;
  PetscInt           n, n_all, row;

  PetscFunctionBeginUser;
  PetscCall(VecGetOwnershipRange(across, &row, NULL));
  PetscCall(ContactGetPairs(o->contact, &n, &n_all, &pairs));
  for (PetscInt i = 0; i < rows->n; i++) {
    const ContactPair *pair  = &pairs[rows->pair[i]];
    const PetscReal    share = pair->force / c->force;

    PetscCall(VecSetValue(across, row + i, share * speed / pair->speed, INSERT_VALUES));
    PetscCall(VecSetValue(along, row + i, share, INSERT_VALUES));
  }
  PetscCall(VecAssemblyBegin(across));
  PetscCall(VecAssemblyEnd(across));
  PetscCall(VecAssemblyBegin(along));
  PetscCall(VecAssemblyEnd(along));
  PetscFunctionReturn(0);
}

/* Terms of the friction damping; closed = index of the parameter of the group, not read for group 0 */
static PetscErrorCode DampingAdd(Operators o, const ContactInterface *c, const InterfaceParameters *q,
                                 const FrictionRows *rows, PetscInt group, PetscInt closed)
{
  const PetscInt more = group > 0 ? 1 : 0;
  OperatorsTerm *term;
  Vec            across, along;
  Mat            BB, TT;

  PetscFunctionBeginUser;
  PetscCall(MatCreateVecs(rows->T, NULL, &across));
  PetscCall(VecDuplicate(across, &along));
  PetscCall(WeightsSet(o, c, rows, across, along));
  PetscCall(ProductCreate(1, rows->B, across, rows->B, &BB));
  PetscCall(ProductCreate(1, rows->T, along, rows->T, &TT));
  PetscCall(TermsAdd(&o->base, OPERATORS_DAMPING, TT, PETSC_TRUE, 2 + more, (PetscInt[]){q->slope, q->force, closed}));
  PetscCall(
    TermsAdd(&o->base, OPERATORS_DAMPING, BB, PETSC_TRUE, 3 + more, (PetscInt[]){q->mu, q->force, q->speed, closed}));
  term                     = &o->base.term[o->base.n - 1];
  term->factor[0].absolute = PETSC_TRUE;
  term->factor[2].power    = -1;
  PetscCall(MatDestroy(&BB));
  PetscCall(MatDestroy(&TT));
  PetscCall(VecDestroy(&across));
  PetscCall(VecDestroy(&along));
  PetscFunctionReturn(0);
}

/* Terms of the penalty law; without friction where nothing says along what the interface slides */
static PetscErrorCode PenaltyAdd(Operators o, const InterfaceParameters *q, const FrictionRows *rows, PetscInt group,
                                 PetscInt closed)
{
  const PetscInt more = group > 0 ? 1 : 0;
  Mat            NN, TN;

  PetscFunctionBeginUser;
  PetscCall(ProductCreate(1, rows->N, NULL, rows->N, &NN));
  PetscCall(TermsAdd(&o->base, OPERATORS_STIFFNESS, NN, PETSC_TRUE, 1 + more, (PetscInt[]){q->kn, closed}));
  PetscCall(MatDestroy(&NN));
  if (q->mu < 0) PetscFunctionReturn(0);
  PetscCall(ProductCreate(-1, rows->T, NULL, rows->N, &TN));
  PetscCall(TermsAdd(&o->base, OPERATORS_STIFFNESS, TN, PETSC_FALSE, 2 + more, (PetscInt[]){q->kn, q->mu, closed}));
  PetscCall(MatDestroy(&TN));
  PetscFunctionReturn(0);
}

/* Parameters of one interface */
static PetscErrorCode ParametersAdd(Operators o, const ContactInterface *c, InterfaceParameters *q)
{
  const PetscReal turning = AngularVelocity(c);

  PetscFunctionBeginUser;
  *q = (InterfaceParameters){-1, -1, -1, -1, -1};
  if (c->slides) PetscCall(ParameterAddMu(o, c->name, c->mu, &q->mu));
  if (c->law == CONTACT_PENALTY) PetscCall(ParameterAdd(o, c->name, "kn", "N/m", c->kn, 0, PETSC_FALSE, &q->kn));
  if (!c->damping) PetscFunctionReturn(0);
  PetscCall(ParameterAdd(o, c->name, "mu_slope", "s/m", c->mu_slope, -INFINITY, PETSC_FALSE, &q->slope));
  PetscCall(ParameterAdd(o, c->name, "force", "N", c->force, 0, PETSC_TRUE, &q->force));
  if (turning > 0)
    PetscCall(ParameterAdd(o, c->name, "rotation", "rad/s", turning, 0, PETSC_FALSE, &q->speed));
  else
    PetscCall(ParameterAdd(o, c->name, "speed", "m/s", c->speed, 0, PETSC_FALSE, &q->speed));
  PetscFunctionReturn(0);
}

PetscErrorCode OperatorsAddContactParameters(Operators o)
{
  const ContactInterface *c;
  PetscInt                n;

  PetscFunctionBeginUser;
  PetscCall(ContactGetInterfaces(o->contact, &n, &c));
  PetscCall(PetscMalloc1(n, &o->interface));
  for (PetscInt i = 0; i < n; i++) PetscCall(ParametersAdd(o, &c[i], &o->interface[i]));
  PetscFunctionReturn(0);
}

/* Terms of the pairs of one interface in one group */
static PetscErrorCode GroupAdd(Operators o, const ContactInterface *c, PetscInt interface, PetscInt group)
{
  const InterfaceParameters *q      = &o->interface[interface];
  const PetscInt             closed = o->n_scene + group - 1;
  PetscInt                   n_rows;
  FrictionRows               rows;

  PetscFunctionBeginUser;
  PetscCall(FrictionRowsCreate(o, interface, group, &rows));
  PetscCall(MatGetSize(rows.N, &n_rows, NULL));
  if (n_rows && c->law == CONTACT_PENALTY) PetscCall(PenaltyAdd(o, q, &rows, group, closed));
  if (n_rows && c->damping && c->slides && c->force > 0) PetscCall(DampingAdd(o, c, q, &rows, group, closed));
  PetscCall(FrictionRowsDestroy(&rows));
  PetscFunctionReturn(0);
}

PetscErrorCode OperatorsAddContact(Operators o)
{
  const ContactInterface *c;
  PetscInt                n;

  PetscFunctionBeginUser;
  PetscCall(ContactGetInterfaces(o->contact, &n, &c));
  for (PetscInt i = 0; i < n; i++)
    for (PetscInt group = 0; group <= o->n_groups; group++) PetscCall(GroupAdd(o, &c[i], i, group));
  PetscFunctionReturn(0);
}

PetscErrorCode OperatorsCheckLinear(Operators o)
{
  const ContactInterface *c;
  PetscInt                n;

  PetscFunctionBeginUser;
  if (!o->model) PetscFunctionReturn(0);
  PetscCall(ContactGetInterfaces(o->contact, &n, &c));
  for (PetscInt i = 0; i < n; i++) {
    PetscCheck(c[i].slides || (c[i].mu == 0 && !c[i].damping), o->comm, PETSC_ERR_USER_INPUT,
               "contact %s: the sliding velocity vanishes in the surface at some pair; give -%s_slip x,y,z along the "
               "surface",
               c[i].name, c[i].name);
    PetscCheck(!c[i].damping || c[i].force > 0 || c[i].preloaded, o->comm, PETSC_ERR_USER_INPUT,
               "-%s_friction_damping needs a positive -%s_force (N), or -modes_contact static", c[i].name, c[i].name);
    PetscCheck(c[i].damping || c[i].mu_slope == 0, o->comm, PETSC_ERR_USER_INPUT,
               "-%s_mu_slope does nothing without -%s_friction_damping", c[i].name, c[i].name);
  }
  PetscFunctionReturn(0);
}
