/*
   The pencil of the bodies: every pair open, neither damping nor spin, on request no bushing between two sets,

      lambda^2 M + K,   K of the parts, springs, points and bushings,

   at a point p where the parameters of damping and spin that belong to the bodies are 0,
   whose modes are named and in which those of the coupled bodies are expanded.

   Of a pencil with contact, K_bodies = K + D in all unknowns: D takes off the terms of the contact, of bushings between
   two sets, of preload and spin. Most of its rows are empty, but for a body that spins or is preloaded, and it is kept
   where the terms are not.
*/
#include "pencilimpl.h"

/* Damping and spin are told by the unit of their parameter, which no stiffness, mass or density has: alpha (1/s),
   beta (s), dashpots (N s/m, in total or per area N s/m^3, N m s/rad), spin (rad/s) */
PetscErrorCode OperatorsUnitIsGyration(const char unit[], PetscBool *is)
{
  static const char *const units[] = {"1/s", "s", "N s/m", "N s/m^3", "N m s/rad", "rad/s"};

  PetscFunctionBeginUser;
  *is = PETSC_FALSE;
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(units) && !*is; i++) PetscCall(PetscStrcmp(unit, units[i], is));
  PetscFunctionReturn(0);
}

/* Whether a parameter is a stiffness of a bushing between two sets */
static PetscErrorCode ParameterJoins(Operators operators, const OperatorsParameter *parameter, PetscBool *joins)
{
  static const char *const what[] = {"stiffness", "turn_stiffness"};
  const ModelScene        *scene;

  PetscFunctionBeginUser;
  *joins = PETSC_FALSE;
  PetscCall(ModelGetScene(operators->model, &scene));
  for (PetscInt i = 0; i < 2 * scene->n_joints && !*joins; i++) {
    const Joint *joint = &scene->joints[i / 2];
    char         name[sizeof(parameter->name)];
    size_t       length;

    if (!joint->set[1][0]) continue;
    PetscCall(PetscSNPrintf(name, sizeof(name), "%s_%s", joint->name, what[i % 2]));
    PetscCall(PetscStrlen(name, &length));
    PetscCall(PetscStrncmp(parameter->name, name, length, joins));
  }
  PetscFunctionReturn(0);
}

/* The sliding state in which all pairs are open */
static PetscErrorCode StateCreateOpen(Contact contact, SlidingState *state)
{
  PetscInt           n_pairs, n_all, *open;
  const ContactPair *pair;

  PetscFunctionBeginUser;
  PetscCall(ContactGetPairs(contact, &n_pairs, &n_all, &pair));
  PetscCall(PetscMalloc1(n_pairs, &open));
  for (PetscInt i = 0; i < n_pairs; i++) open[i] = -1;
  PetscCall(SlidingStateCreate(n_pairs, 0, open, state));
  PetscCall(PetscFree(open));
  PetscFunctionReturn(0);
}

/* The point `still` [n] of the bodies: damping and spin are 0 in a copy of p, not taken out of the terms, so that the
   pencil has the parameters of all others */
static PetscErrorCode PointOfBodies(Operators operators, PetscInt n, const OperatorsParameter parameter[],
                                    const PetscReal p[], PetscBool apart, PetscReal still[])
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < n; i++) {
    PetscBool gyrates, joins = PETSC_FALSE;

    PetscCall(OperatorsUnitIsGyration(parameter[i].unit, &gyrates));
    if (apart) PetscCall(ParameterJoins(operators, &parameter[i], &joins));
    if (parameter[i].law) gyrates = PETSC_FALSE;
    still[i] = ((gyrates || (parameter[i].damps && !parameter[i].law)) && parameter[i].body) || joins
                 ? 0
                 : p[i]; /* a contact that turns is none of them */
  }
  PetscFunctionReturn(0);
}

/* p NULL: the point of the scene */
PetscErrorCode OperatorsLineariseBodies(Operators operators, const PetscReal p[], PetscBool apart, Pencil *bodies)
{
  const OperatorsParameter *parameter;
  const PetscReal          *scene;
  PetscReal                *still;
  PetscInt                  n;
  SlidingState              state;

  PetscFunctionBeginUser;
  PetscCall(StateCreateOpen(operators->contact, &state));
  PetscCall(OperatorsLinearise(operators, &state, bodies));
  PetscCall(SlidingStateDestroy(&state));
  PencilDropLoss(*bodies);
  PetscCall(PencilGetParameters(*bodies, &n, &parameter, &scene));
  PetscCall(PetscMalloc1(n, &still));
  PetscCall(PointOfBodies(operators, n, parameter, p ? p : scene, apart, still));
  PetscCall(PencilSetParameters(*bodies, still));
  PetscCall(PetscFree(still));
  PetscFunctionReturn(0);
}

/* How many terms, the first ones, are of the bodies */
static PetscInt TermsOfBodies(Pencil pencil)
{
  return pencil->operators->terms.n + pencil->operators->spin.n;
}

/* Coefficients of the terms in the bodies apart [terms] */
static PetscErrorCode CoefficientsApart(Pencil pencil, PetscReal c[])
{
  const Parameters *parameters = &pencil->parameters;
  PetscReal        *still;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(parameters->n, &still));
  PetscCall(PointOfBodies(pencil->operators, parameters->n, parameters->list, parameters->p, PETSC_TRUE, still));
  for (PetscInt t = 0; t < pencil->base.n; t++)
    c[t] = t < TermsOfBodies(pencil) ? OperatorsTermCoefficient(&pencil->base.term[t], still) : 0;
  PetscCall(PetscFree(still));
  PetscFunctionReturn(0);
}

PetscErrorCode PencilGetTermsApart(Pencil pencil, PetscInt *n, Mat **terms)
{
  PetscReal *c;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(pencil->base.n, terms));
  PetscCall(PetscMalloc1(pencil->base.n, &c));
  PetscCall(CoefficientsApart(pencil, c));
  *n = 0;
  for (PetscInt t = 0; t < pencil->base.n; t++)
    if (c[t] != 0 && pencil->base.term[t].kind != OPERATORS_DAMPING) (*terms)[(*n)++] = pencil->base.term[t].A;
  PetscCall(PetscFree(c));
  PetscFunctionReturn(0);
}

/* D: of what PencilGetStiffnessApart() takes for K */
PetscErrorCode PencilKeepApart(Pencil pencil)
{
  PetscReal *c;
  PetscBool  none = PETSC_TRUE;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(pencil->base.n, &c));
  PetscCall(CoefficientsApart(pencil, c));
  for (PetscInt t = 0; t < pencil->base.n; t++) {
    const OperatorsTerm *term = &pencil->base.term[t];
    const PetscBool      counts =
      term->kind == OPERATORS_STIFFNESS && !(pencil->Zr && term->frictional) ? PETSC_TRUE : PETSC_FALSE;

    c[t] = counts ? c[t] - OperatorsTermCoefficient(term, pencil->parameters.p) : 0;
    if (c[t] != 0) none = PETSC_FALSE;
  }
  PetscCall(TermsSumDestroy(&pencil->joining));
  if (!none) PetscCall(TermsSumAdd(&pencil->base, c, &pencil->joining));
  pencil->keeps_apart = PETSC_TRUE;
  PetscCall(PetscFree(c));
  PetscFunctionReturn(0);
}

/* K with friction, which is there, or where constraints project the pencil its symmetric part in all unknowns */
PetscErrorCode PencilGetStiffnessApart(Pencil pencil, Mat *K, Mat *less)
{
  PencilMatrices m;
  PencilParts    parts;

  PetscFunctionBeginUser;
  PetscCheck(pencil->keeps_apart, pencil->comm, PETSC_ERR_ARG_WRONGSTATE, "PencilKeepApart() was not called");
  if (pencil->Zr) {
    PetscCall(PencilGetParts(pencil, &parts));
    *K = parts.K;
  } else {
    PetscCall(PencilGetMatrices(pencil, &m));
    *K = m.K;
  }
  *less = pencil->joining.A;
  PetscFunctionReturn(0);
}
