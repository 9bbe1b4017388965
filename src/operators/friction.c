/*
   Terms of the contact, linearised about steady sliding with normal force N0 and speed v per pair:
      K += k_n N'N + mu k_n (-T'N)             normal stiffness and friction          (seed paper, eq. 1); with a k_n
                                               per area N'A N and -T'A N, A the areas of the pairs
      K += k_t (T'T + B'B)                     pairs that stick, of an interface that holds by friction; also per area
      C += |mu| N / V B'B_w + mu' N T'T_w      friction damping across and along the slip, mu' = d mu / d v
   of each interface. N is its total normal force (of the sliding state, or -contact_force), V its sliding speed or,
   where the slip comes from a rotation, the angular velocity; B'B_w and T'T_w carry N0 / N and V / v of each pair. Only
   closed pairs take part; those of a group g make terms of their own, with the parameter closed_g as one more factor.
   Signs: slip velocity of the slave relative to the master is v t - d/dt (T u) t - d/dt (B u) b, friction on the master
   acts along it, and internal forces stand on the left.
*/
#include "pencilimpl.h"
#include "base/vec3.h"
#include <math.h>

PetscErrorCode TermsProduct(PetscReal scale, Mat L, Vec weights, Mat R, Mat *A)
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

/* Closed pairs of one interface in one group */
typedef struct {
  const ContactInterface *c;
  InterfaceParameters     q;
  PetscReal               total;    /* normal force of the interface, N */
  PetscInt                more;     /* 1 where the terms have the factor closed_g, else 0 */
  PetscInt                closed;   /* index of that parameter */
  PetscInt                n, *pair; /* of this rank */
  Mat                     N, T, B;
} FrictionGroup;

static PetscErrorCode FrictionGroupCreate(Pencil pencil, PetscInt interface, PetscInt group, FrictionGroup *g)
{
  const ContactPair *pairs;
  PetscInt           n, n_all;
  Contact            contact = pencil->operators->contact;

  PetscFunctionBeginUser;
  PetscCall(ContactGetInterfaces(contact, &n, &g->c));
  g->c += interface;
  g->q      = pencil->operators->interface[interface];
  g->total  = pencil->total[interface];
  g->more   = group > 0 ? 1 : 0;
  g->closed = pencil->n_scene + group - 1;
  g->n      = 0;
  PetscCall(ContactGetPairs(contact, &n, &n_all, &pairs));
  PetscCall(PetscMalloc1(n, &g->pair));
  for (PetscInt p = 0; p < n; p++)
    if (pairs[p].interface == interface && pencil->group[p] == group) g->pair[g->n++] = p;
  PetscCall(ContactCreatePairOperators(contact, g->n, g->pair, &g->N, &g->T, &g->B));
  PetscFunctionReturn(0);
}

static PetscErrorCode FrictionGroupDestroy(FrictionGroup *g)
{
  PetscFunctionBeginUser;
  PetscCall(MatDestroy(&g->N));
  PetscCall(MatDestroy(&g->T));
  PetscCall(MatDestroy(&g->B));
  PetscCall(PetscFree(g->pair));
  PetscFunctionReturn(0);
}

/* Weights of the pairs: along = N0 / N, across = N0 / N V / v */
static PetscErrorCode DampingSetWeights(Pencil pencil, const FrictionGroup *g, Vec across, Vec along)
{
  const PetscReal    turning = Vec3Length(g->c->rotation), speed = turning > 0 ? turning : g->c->speed;
  const ContactPair *pairs;
  PetscInt           n, n_all, row;

  PetscFunctionBeginUser;
  PetscCall(VecGetOwnershipRange(across, &row, NULL));
  PetscCall(ContactGetPairs(pencil->operators->contact, &n, &n_all, &pairs));
  for (PetscInt i = 0; i < g->n; i++) {
    const PetscReal share = pencil->force[g->pair[i]] / g->total;

    PetscCall(VecSetValue(across, row + i, share * speed / pairs[g->pair[i]].speed, INSERT_VALUES));
    PetscCall(VecSetValue(along, row + i, share, INSERT_VALUES));
  }
  PetscCall(VecAssemblyBegin(across));
  PetscCall(VecAssemblyEnd(across));
  PetscCall(VecAssemblyBegin(along));
  PetscCall(VecAssemblyEnd(along));
  PetscFunctionReturn(0);
}

/* Terms of the friction damping */
static PetscErrorCode DampingAdd(Pencil pencil, const FrictionGroup *g)
{
  const PetscInt slope[] = {g->q.slope, g->q.force, g->closed}, mu[] = {g->q.mu, g->q.force, g->q.speed, g->closed};
  OperatorsTerm *term;
  Vec            across, along;
  Mat            BB, TT;

  PetscFunctionBeginUser;
  PetscCall(MatCreateVecs(g->T, NULL, &across));
  PetscCall(VecDuplicate(across, &along));
  PetscCall(DampingSetWeights(pencil, g, across, along));
  PetscCall(TermsProduct(1, g->B, across, g->B, &BB));
  PetscCall(TermsProduct(1, g->T, along, g->T, &TT));
  PetscCall(TermsAdd(&pencil->base, OPERATORS_DAMPING, TT, PETSC_TRUE, 2 + g->more, slope));
  PetscCall(TermsAdd(&pencil->base, OPERATORS_DAMPING, BB, PETSC_TRUE, 3 + g->more, mu));
  term                     = &pencil->base.term[pencil->base.n - 1];
  term->factor[0].absolute = PETSC_TRUE;
  term->factor[2].power    = -1;
  PetscCall(MatDestroy(&BB));
  PetscCall(MatDestroy(&TT));
  PetscCall(VecDestroy(&across));
  PetscCall(VecDestroy(&along));
  PetscFunctionReturn(0);
}

/* Areas of the pairs where the stiffness is per area, else NULL */
static PetscErrorCode PenaltyCreateWeights(Pencil pencil, const FrictionGroup *g, Vec *weights)
{
  const ContactPair *pairs;
  PetscInt           n, n_all, row;

  PetscFunctionBeginUser;
  *weights = NULL;
  if (!g->c->per_area) PetscFunctionReturn(0);
  PetscCall(ContactGetPairs(pencil->operators->contact, &n, &n_all, &pairs));
  PetscCall(MatCreateVecs(g->N, NULL, weights));
  PetscCall(VecGetOwnershipRange(*weights, &row, NULL));
  for (PetscInt i = 0; i < g->n; i++)
    PetscCall(VecSetValue(*weights, row + i, ContactPairStiffness(g->c, &pairs[g->pair[i]], 1), INSERT_VALUES));
  PetscCall(VecAssemblyBegin(*weights));
  PetscCall(VecAssemblyEnd(*weights));
  PetscFunctionReturn(0);
}

/* Terms of the penalty law; without friction where nothing says along what the interface slides */
static PetscErrorCode PenaltyAdd(Pencil pencil, const FrictionGroup *g)
{
  const PetscInt kn[] = {g->q.kn, g->closed}, mu[] = {g->q.kn, g->q.mu, g->closed};
  Mat            NN, TN, WN;
  Vec            weights;

  PetscFunctionBeginUser;
  PetscCall(PenaltyCreateWeights(pencil, g, &weights));
  PetscCall(TermsProduct(1, g->N, weights, g->N, &NN));
  PetscCall(TermsAdd(&pencil->base, OPERATORS_STIFFNESS, NN, PETSC_TRUE, 1 + g->more, kn));
  PetscCall(MatDestroy(&NN));
  if (g->q.mu >= 0) {
    PetscCall(MatDuplicate(g->N, MAT_COPY_VALUES, &WN));
    PetscCall(MatScale(WN, -1));
    if (weights) PetscCall(MatDiagonalScale(WN, weights, NULL));
    PetscCall(TermsProduct(1, g->T, NULL, WN, &TN));
    PetscCall(TermsAdd(&pencil->base, OPERATORS_STIFFNESS, TN, PETSC_FALSE, 2 + g->more, mu));
    PetscCall(TermsSetFactors(&pencil->base, g->T, WN));
    PetscCall(MatDestroy(&WN));
    PetscCall(MatDestroy(&TN));
  }
  PetscCall(VecDestroy(&weights));
  PetscFunctionReturn(0);
}

/* 1 or the area of each pair that sticks, 0 of one that slips */
static PetscErrorCode HoldCreateWeights(Pencil pencil, const FrictionGroup *g, Vec *weights)
{
  const ContactPair *pairs;
  PetscInt           n, n_all, row;

  PetscFunctionBeginUser;
  PetscCall(ContactGetPairs(pencil->operators->contact, &n, &n_all, &pairs));
  PetscCall(MatCreateVecs(g->T, NULL, weights));
  PetscCall(VecGetOwnershipRange(*weights, &row, NULL));
  for (PetscInt i = 0; i < g->n; i++) {
    const PetscInt  p     = g->pair[i];
    const PetscReal holds = g->c->kt_per_area ? pairs[p].area : 1;

    if (!pencil->slips[p]) PetscCall(VecSetValue(*weights, row + i, holds, INSERT_VALUES));
  }
  PetscCall(VecAssemblyBegin(*weights));
  PetscCall(VecAssemblyEnd(*weights));
  PetscFunctionReturn(0);
}

/* Terms of the pairs that stick */
static PetscErrorCode HoldAdd(Pencil pencil, const FrictionGroup *g)
{
  const PetscInt kt[] = {g->q.kt, g->closed};
  Vec            weights;
  Mat            along[2];

  PetscFunctionBeginUser;
  PetscCall(HoldCreateWeights(pencil, g, &weights));
  PetscCall(TermsProduct(1, g->T, weights, g->T, &along[0]));
  PetscCall(TermsProduct(1, g->B, weights, g->B, &along[1]));
  for (int i = 0; i < 2; i++) {
    PetscCall(TermsAdd(&pencil->base, OPERATORS_STIFFNESS, along[i], PETSC_TRUE, 1 + g->more, kt));
    PetscCall(MatDestroy(&along[i]));
  }
  PetscCall(VecDestroy(&weights));
  PetscFunctionReturn(0);
}

/* Parameters of one interface */
static PetscErrorCode InterfaceAddParameters(Operators o, const ContactInterface *c, InterfaceParameters *q)
{
  const PetscReal turning = Vec3Length(c->rotation); /* rad/s */
  const struct {
    PetscBool          there;
    const char        *name;
    OperatorsParameter like;
    PetscInt          *index;
  } what[] = {
    {c->law == CONTACT_PENALTY,
     c->per_area ? "kn_per_area" : "kn",
     {.unit = c->per_area ? "N/m^3" : "N/m", .value = c->kn},
     &q->kn                                                                                                                },
    {c->kt > 0,
     c->kt_per_area ? "kt_per_area" : "kt",
     {.unit = c->kt_per_area ? "N/m^3" : "N/m", .value = c->kt},
     &q->kt                                                                                                                },
    {!c->slides && c->kt > 0 && c->mu > 0, "mu",       {.unit = "", .value = c->mu, .state = PETSC_TRUE},         &q->grip },
    {c->damping,                           "mu_slope", {.unit = "s/m", .value = c->mu_slope, .lower = -INFINITY}, &q->slope},
    {c->damping,                           "force",    {.unit = "N", .value = c->force, .closed = PETSC_TRUE},    &q->force},
    {c->damping && turning > 0,            "rotation", {.unit = "rad/s", .value = turning},                       &q->speed},
    {c->damping && turning <= 0,           "speed",    {.unit = "m/s", .value = c->speed},                        &q->speed},
  };

  PetscFunctionBeginUser;
  *q = (InterfaceParameters){-1, -1, -1, -1, -1, -1, -1};
  if (c->slides) PetscCall(OperatorsAddMu(o, c->name, c->mu, &q->mu));
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(what); i++)
    if (what[i].there) PetscCall(ParametersAdd(&o->parameters, c->name, what[i].name, &what[i].like, what[i].index));
  PetscFunctionReturn(0);
}

PetscErrorCode OperatorsAddContactParameters(Operators o)
{
  const ContactInterface *c;
  PetscInt                n;

  PetscFunctionBeginUser;
  PetscCall(ContactGetInterfaces(o->contact, &n, &c));
  PetscCall(PetscMalloc1(n, &o->interface));
  for (PetscInt i = 0; i < n; i++) PetscCall(InterfaceAddParameters(o, &c[i], &o->interface[i]));
  PetscFunctionReturn(0);
}

PetscErrorCode PencilAddContact(Pencil pencil)
{
  const ContactInterface *c;
  PetscInt                n, n_rows;
  FrictionGroup           g;

  PetscFunctionBeginUser;
  PetscCall(ContactGetInterfaces(pencil->operators->contact, &n, &c));
  for (PetscInt i = 0; i < n; i++)
    for (PetscInt group = 0; group <= pencil->n_groups; group++) {
      PetscCall(FrictionGroupCreate(pencil, i, group, &g));
      PetscCall(MatGetSize(g.N, &n_rows, NULL));
      if (n_rows && c[i].law == CONTACT_PENALTY) PetscCall(PenaltyAdd(pencil, &g));
      if (n_rows && c[i].kt > 0) PetscCall(HoldAdd(pencil, &g));
      if (n_rows && c[i].damping && c[i].slides && g.total > 0) PetscCall(DampingAdd(pencil, &g));
      PetscCall(FrictionGroupDestroy(&g));
    }
  PetscFunctionReturn(0);
}

PetscErrorCode PencilCheckSliding(Pencil pencil)
{
  const ContactInterface *c;
  PetscInt                n, n_closed = 0;

  PetscFunctionBeginUser;
  if (!pencil->operators->model) PetscFunctionReturn(0);
  for (PetscInt p = 0; p < pencil->n_pairs; p++) n_closed += pencil->group[p] >= 0;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &n_closed, 1, MPIU_INT, MPI_SUM, pencil->comm));
  if (pencil->from_state && !n_closed) PetscFunctionReturn(0); /* the bodies alone */
  PetscCall(ContactGetInterfaces(pencil->operators->contact, &n, &c));
  for (PetscInt i = 0; i < n; i++) {
    PetscCheck(c[i].slides || ((c[i].mu == 0 || c[i].kt > 0) && !c[i].damping), pencil->comm, PETSC_ERR_USER_INPUT,
               "contact %s: the sliding velocity vanishes in the surface at some pair; give -%s_slip x,y,z along the "
               "surface, or -%s_kt (N/m per pair) where it holds by friction",
               c[i].name, c[i].name, c[i].name);
    PetscCheck(!c[i].damping || c[i].force > 0 || pencil->has_forces, pencil->comm, PETSC_ERR_USER_INPUT,
               "-%s_friction_damping needs a positive -%s_force (N), or -modes_contact static", c[i].name, c[i].name);
    PetscCheck(c[i].damping || c[i].mu_slope == 0, pencil->comm, PETSC_ERR_USER_INPUT,
               "-%s_mu_slope does nothing without -%s_friction_damping", c[i].name, c[i].name);
  }
  PetscFunctionReturn(0);
}
