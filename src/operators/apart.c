/*
   The pencil of the bodies: every pair open, neither damping nor spin, on request no bushing between two sets,

      lambda^2 M + K,   K of the parts, springs, points and bushings,

   at a point p where the parameters of damping and spin that belong to the bodies are 0,
   whose modes are named and in which those of the coupled bodies are expanded.
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

/* p NULL: the point of the scene. Damping and spin are set to 0 in a copy of p, not taken out of the terms, so that
   the pencil has the parameters of all others. */
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
  PetscCall(PencilGetParameters(*bodies, &n, &parameter, &scene));
  if (!p) p = scene;
  PetscCall(PetscMalloc1(n, &still));
  for (PetscInt i = 0; i < n; i++) {
    PetscBool gyrates, joins = PETSC_FALSE;

    PetscCall(OperatorsUnitIsGyration(parameter[i].unit, &gyrates));
    if (apart) PetscCall(ParameterJoins(operators, &parameter[i], &joins));
    still[i] = (gyrates && parameter[i].body) || joins ? 0 : p[i]; /* a contact that turns is none of them */
  }
  PetscCall(PencilSetParameters(*bodies, still));
  PetscCall(PetscFree(still));
  PetscFunctionReturn(0);
}
