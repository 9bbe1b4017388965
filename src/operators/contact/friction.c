/*
   Terms of the contact, linearised about steady sliding with normal force N0 and speed v per pair:
      K += k_n N'N + mu k_n (-T'N)             normal stiffness and friction          (seed paper, eq. 1); with a k_n
                                               per area N'A N and -T'A N, A the areas of the pairs; where the
                                               pressure is not linear, k_n of each pair at its pressure
      K += k_t (T'T + B'B)                     pairs that stick, of an interface that holds by friction; also per area
      C += |mu| N / V B'B_w + mu' N T'T_w      friction damping across and along the slip, mu' = d mu / d v
   of each interface. N is its total normal force (of the sliding state, or -contact_force), V its sliding speed or,
   where the slip comes from a rotation, the angular velocity; B'B_w and T'T_w carry N0 / N and V / v of each pair.
   Where mu differs from pair to pair, terms with mu or mu' stand once for each of several speeds k, with the pairs'
   parts L_k (frictionfactor.c). Only closed pairs take part; those of a group g make terms of their own, with the
   parameter closed_g as one more factor. Signs: slip velocity of the slave relative to the master is v t - d/dt (T u) t
   - d/dt (B u) b, friction on the master acts along it, and internal forces stand on the left.
*/
#include "operators/pencilimpl.h"
#include "base/algebra/vec3.h"
#include <math.h>

/* A = scale L' diag(weights) R, weights NULL for ones. R is copied where it is weighted: T is also the left factor
   of other terms. */
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
  PetscInt                interface, group;
  PetscReal               total;    /* normal force of the interface, N */
  PetscInt                more;     /* 1 where the terms have the factor closed_g, else 0 */
  PetscInt                closed;   /* index of that parameter */
  PetscInt                n, *pair; /* of this rank */
  Mat                     N, T, B;
} FrictionGroup;

/* Closed pairs of this rank in one group, maybe none, with their rows N, T, B [pairs][unknowns]. Group 0 is closed
   always, and has no factor closed_g. */
static PetscErrorCode FrictionGroupCreate(Pencil pencil, PetscInt interface, PetscInt group, FrictionGroup *g)
{
  const ContactPair *pairs;
  PetscInt           n, n_all;
  Contact            contact = pencil->operators->contact;

  PetscFunctionBeginUser;
  PetscCall(ContactGetInterfaces(contact, &n, &g->c));
  g->c += interface;
  g->interface = interface;
  g->group     = group;
  g->q         = pencil->operators->interface[interface];
  g->total     = pencil->total[interface];
  g->more      = group > 0 ? 1 : 0;
  g->closed    = pencil->n_scene + group - 1;
  g->n         = 0;
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

/* Weights of the pairs at speed k: along = L_k N0 / N, across = L_k N0 / N V / v, so that with the
   parameters N (N), V (m/s, or rad/s beside a V / v in rad/m) and mu, mu' the terms are N s/m */
static PetscErrorCode DampingSetWeights(Pencil pencil, const FrictionGroup *g, PetscInt k, Vec across, Vec along)
{
  const PetscReal    speed = g->q.stated;
  const ContactPair *pairs;
  PetscInt           n, n_all, row;

  PetscFunctionBeginUser;
  PetscCall(VecGetOwnershipRange(across, &row, NULL));
  PetscCall(ContactGetPairs(pencil->operators->contact, &n, &n_all, &pairs));
  for (PetscInt i = 0; i < g->n; i++) {
    const PetscInt  p   = g->pair[i];
    const PetscReal own = pairs[p].speed, force = pencil->force[p] / g->total;
    const PetscReal mu    = PencilFrictionShare(pencil, g->interface, k, p, FRICTION_VALUE);
    const PetscReal slope = PencilFrictionShare(pencil, g->interface, k, p, FRICTION_SLOPE);

    PetscCall(VecSetValue(across, row + i, mu * force * speed / own, INSERT_VALUES));
    PetscCall(VecSetValue(along, row + i, slope * force, INSERT_VALUES));
  }
  PetscCall(VecAssemblyBegin(across));
  PetscCall(VecAssemblyEnd(across));
  PetscCall(VecAssemblyBegin(along));
  PetscCall(VecAssemblyEnd(along));
  PetscFunctionReturn(0);
}

/* The term L' W L, W = diag(weights), of the damping, with n factors */
static PetscErrorCode DampingAddProduct(Pencil pencil, const FrictionGroup *g, Mat L, Vec weights, PetscInt n,
                                        const PetscInt factor[])
{
  Mat WL, A;

  PetscFunctionBeginUser;
  PetscCall(MatDuplicate(L, MAT_COPY_VALUES, &WL));
  PetscCall(MatDiagonalScale(WL, weights, NULL));
  PetscCall(TermsProduct(1, L, NULL, WL, &A));
  PetscCall(TermsAdd(&pencil->base, OPERATORS_DAMPING, A, PETSC_TRUE, n, factor));
  PetscCall(TermsSetFactors(&pencil->base, L, WL, g->interface, g->group));
  PetscCall(MatDestroy(&WL));
  PetscCall(MatDestroy(&A));
  PetscFunctionReturn(0);
}

/* Terms of the friction damping at speed k: mu' N T'T_w and |mu| N / V B'B_w. The factor 0 of both is the law's, by
   TermsSetFriction(); -1 stands in its place until then. |mu|: damping across the slip dissipates whichever way
   friction acts. */
static PetscErrorCode DampingAdd(Pencil pencil, const FrictionGroup *g, PetscInt k)
{
  const PetscInt slope[] = {-1, g->q.force, g->closed}, mu[] = {-1, g->q.force, g->q.speed, g->closed};
  OperatorsTerm *term;
  Vec            across, along;

  PetscFunctionBeginUser;
  PetscCall(MatCreateVecs(g->T, NULL, &across));
  PetscCall(VecDuplicate(across, &along));
  PetscCall(DampingSetWeights(pencil, g, k, across, along));
  PetscCall(DampingAddProduct(pencil, g, g->T, along, 2 + g->more, slope));
  PetscCall(TermsSetFriction(&pencil->base, 0, &g->q.node[k], !FrictionNeedsPressure(&g->c->friction)));
  PetscCall(TermsSetCause(&pencil->base, "falling friction", NULL, g->c->name));
  PetscCall(DampingAddProduct(pencil, g, g->B, across, 3 + g->more, mu));
  PetscCall(TermsSetFriction(&pencil->base, 0, &g->q.node[k], PETSC_FALSE));
  PetscCall(TermsSetCause(&pencil->base, "friction damping", NULL, g->c->name));
  term                     = &pencil->base.term[pencil->base.n - 1];
  term->factor[0].absolute = PETSC_TRUE;
  term->factor[2].power    = -1;
  PetscCall(VecDestroy(&across));
  PetscCall(VecDestroy(&along));
  PetscFunctionReturn(0);
}

/* What the parameter kn of a pair is multiplied by: its area (m^2) where the stiffness is per area, else 1; where the
   pressure is not linear, of which no parameter is left, the stiffness itself (N/m), at the force of the sliding
   state */
static PetscErrorCode PairWeight(Pencil pencil, const FrictionGroup *g, PetscInt p, PetscReal *weight)
{
  PressureLaw        law = PressureLinear(1);
  const ContactPair *pairs;
  PetscReal          mu;
  PetscInt           n, n_all;

  PetscFunctionBeginUser;
  PetscCall(ContactGetPairs(pencil->operators->contact, &n, &n_all, &pairs));
  if (g->q.kn < 0) PetscCall(OperatorsGetInterface(pencil->operators, pencil->parameters.p, g->interface, &mu, &law));
  *weight = ContactPairStiffness(g->c, &pairs[p], &law, pencil->force[p]);
  PetscFunctionReturn(0);
}

/* These weights, NULL where all are 1 */
static PetscErrorCode PenaltyCreateWeights(Pencil pencil, const FrictionGroup *g, Vec *weights)
{
  PetscReal weight;
  PetscInt  row;

  PetscFunctionBeginUser;
  *weights = NULL;
  if (!g->c->per_area && g->q.kn >= 0) PetscFunctionReturn(0);
  PetscCall(MatCreateVecs(g->N, NULL, weights));
  PetscCall(VecGetOwnershipRange(*weights, &row, NULL));
  for (PetscInt i = 0; i < g->n; i++) {
    PetscCall(PairWeight(pencil, g, g->pair[i], &weight));
    PetscCall(VecSetValue(*weights, row + i, weight, INSERT_VALUES));
  }
  PetscCall(VecAssemblyBegin(*weights));
  PetscCall(VecAssemblyEnd(*weights));
  PetscFunctionReturn(0);
}

/* The same times their part at speed k of several; NULL where all are 1 */
static PetscErrorCode SlideCreateWeights(Pencil pencil, const FrictionGroup *g, PetscInt k, Vec *weights)
{
  PetscReal weight;
  PetscInt  row;

  PetscFunctionBeginUser;
  PetscCall(PenaltyCreateWeights(pencil, g, weights));
  if (g->q.n_nodes == 1 && !FrictionNeedsPressure(&g->c->friction)) PetscFunctionReturn(0);
  if (!*weights) PetscCall(MatCreateVecs(g->N, NULL, weights));
  PetscCall(VecGetOwnershipRange(*weights, &row, NULL));
  for (PetscInt i = 0; i < g->n; i++) {
    PetscCall(PairWeight(pencil, g, g->pair[i], &weight));
    weight *= PencilFrictionShare(pencil, g->interface, k, g->pair[i], FRICTION_TANGENT);
    PetscCall(VecSetValue(*weights, row + i, weight, INSERT_VALUES));
  }
  PetscCall(VecAssemblyBegin(*weights));
  PetscCall(VecAssemblyEnd(*weights));
  PetscFunctionReturn(0);
}

/* The term of friction at speed k, k_n mu(v_k) T' (-L_k A N), unsymmetric, with its two factors for factors.c. Without
   a parameter kn the list of factors begins one later */
static PetscErrorCode SlideAdd(Pencil pencil, const FrictionGroup *g, PetscInt k)
{
  const PetscInt mu[] = {g->q.kn, -1, g->closed}, own = g->q.kn < 0 ? 1 : 0;
  Mat            TN, WN;
  Vec            weights;

  PetscFunctionBeginUser;
  PetscCall(SlideCreateWeights(pencil, g, k, &weights));
  PetscCall(MatDuplicate(g->N, MAT_COPY_VALUES, &WN));
  PetscCall(MatScale(WN, -1));
  if (weights) PetscCall(MatDiagonalScale(WN, weights, NULL));
  PetscCall(TermsProduct(1, g->T, NULL, WN, &TN));
  PetscCall(TermsAdd(&pencil->base, OPERATORS_STIFFNESS, TN, PETSC_FALSE, 2 - own + g->more, mu + own));
  PetscCall(TermsSetFriction(&pencil->base, 1 - own, &g->q.node[k], PETSC_FALSE));
  PetscCall(TermsSetCause(&pencil->base, "friction", NULL, g->c->name));
  PetscCall(TermsSetFactors(&pencil->base, g->T, WN, g->interface, g->group));
  PetscCall(MatDestroy(&WN));
  PetscCall(MatDestroy(&TN));
  PetscCall(VecDestroy(&weights));
  PetscFunctionReturn(0);
}

/* Terms of the penalty law; without friction where nothing says along what the interface slides */
static PetscErrorCode PenaltyAdd(Pencil pencil, const FrictionGroup *g)
{
  const PetscInt kn[] = {g->q.kn, g->closed}, own = g->q.kn < 0 ? 1 : 0;
  Mat            NN, WN;
  Vec            weights;

  PetscFunctionBeginUser;
  PetscCall(PenaltyCreateWeights(pencil, g, &weights));
  PetscCall(MatDuplicate(g->N, MAT_COPY_VALUES, &WN));
  if (weights) PetscCall(MatDiagonalScale(WN, weights, NULL));
  PetscCall(TermsProduct(1, g->N, NULL, WN, &NN));
  PetscCall(TermsAdd(&pencil->base, OPERATORS_STIFFNESS, NN, PETSC_TRUE, 1 - own + g->more, kn + own));
  PetscCall(TermsSetFactors(&pencil->base, g->N, WN, g->interface, g->group));
  PetscCall(MatDestroy(&WN));
  PetscCall(MatDestroy(&NN));
  PetscCall(VecDestroy(&weights));
  for (PetscInt k = 0; k < g->q.n_nodes; k++) PetscCall(SlideAdd(pencil, g, k));
  PetscFunctionReturn(0);
}

/* 1 or the area (m^2) of each pair that sticks, 0 of one that slips: sticking is known of a sliding state alone. */
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

/* n_rows is the number of pairs on all ranks: the products are collective, and groups that no rank has are left out
   by all */
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
      for (PetscInt k = 0; k < g.q.n_nodes && n_rows && c[i].damping && g.total > 0; k++)
        PetscCall(DampingAdd(pencil, &g, k));
      PetscCall(FrictionGroupDestroy(&g));
    }
  PetscFunctionReturn(0);
}

/* Raises an error for friction that changes with the slip speed, where modes are to know nothing of it */
static PetscErrorCode FrictionCheckDamps(MPI_Comm comm, const ContactInterface *c)
{
  const FrictionParameter *parameter;
  const PetscInt           n = FrictionGetParameters(&c->friction, &parameter);

  PetscFunctionBeginUser;
  if (c->damping) PetscFunctionReturn(0);
  for (PetscInt j = 0; j < n; j++)
    PetscCheck(parameter[j].steady || c->friction.parameter[j] == 0, comm, PETSC_ERR_USER_INPUT,
               "-%s_%s does nothing without -%s_friction_damping", c->name, parameter[j].row.name + 1, c->name);
  PetscCheck(!c->slides || !FrictionVaries(&c->friction), comm, PETSC_ERR_USER_INPUT,
             "friction of contact %s changes with the slip speed: give -%s_friction_damping, which damps with mu' N",
             c->name, c->name);
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
    PetscCheck(c[i].slides || ((!FrictionExists(&c[i].friction) || c[i].kt > 0) && !c[i].damping), pencil->comm,
               PETSC_ERR_USER_INPUT,
               "contact %s: the sliding velocity vanishes in the surface at some pair; give -%s_slip x,y,z along the "
               "surface, or -%s_kt (N/m per pair) where it holds by friction",
               c[i].name, c[i].name, c[i].name);
    PetscCheck(!c[i].damping || c[i].force > 0 || pencil->has_forces, pencil->comm, PETSC_ERR_USER_INPUT,
               "-%s_friction_damping needs a positive -%s_force (N), or -modes_contact static", c[i].name, c[i].name);
    PetscCheck(!FrictionNeedsPressure(&c[i].friction) || c[i].force > 0 || pencil->has_forces, pencil->comm,
               PETSC_ERR_USER_INPUT,
               "contact %s: friction of a table is that at a pressure: give -%s_force (N), or -loads and "
               "-modes_contact static",
               c[i].name, c[i].name);
    PetscCall(FrictionCheckDamps(pencil->comm, &c[i]));
    PetscCheck(c[i].law == CONTACT_CONSTRAINT || PressureIsLinear(&c[i].pressure) || c[i].force > 0 ||
                 pencil->has_forces,
               pencil->comm, PETSC_ERR_USER_INPUT,
               "contact %s: the stiffness of -%s_pressure_law %s is that at a pressure: give -%s_force (N), or -loads "
               "and -modes_contact static",
               c[i].name, c[i].name, PressureGetName(&c[i].pressure), c[i].name);
  }
  PetscFunctionReturn(0);
}

PetscErrorCode PencilCheckPressure(Pencil pencil, const PetscReal p[])
{
  const ContactInterface *c;
  PetscInt                n;

  PetscFunctionBeginUser;
  if (!pencil->operators->model) PetscFunctionReturn(0);
  PetscCall(ContactGetInterfaces(pencil->operators->contact, &n, &c));
  for (PetscInt i = 0; i < n; i++) PetscCall(PencilCheckTable(pencil, i, p));
  if (pencil->has_forces) PetscFunctionReturn(0);
  for (PetscInt i = 0; i < n; i++) {
    const PetscInt force = pencil->operators->interface[i].force;

    PetscCheck(PressureIsLinear(&c[i].pressure) || force < 0 || p[force] == pencil->parameters.p[force], pencil->comm,
               PETSC_ERR_USER_INPUT,
               "%s_force changes the stiffness of -%s_pressure_law %s from point to point; vary the -loads, with "
               "-modes_contact static",
               c[i].name, c[i].name, PressureGetName(&c[i].pressure));
  }
  PetscFunctionReturn(0);
}
