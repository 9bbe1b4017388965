/*
   From the sliding state to the operators of the modes: the closed pairs, with rows of pairs more or less where
   -static_rows asks for it, the normal forces that friction damping needs, and the optional stiffness of the preload.
*/
#include "preload.h"
#include "staticsimpl.h"

PetscErrorCode StaticsGetClosed(Statics s, PetscBool closed[])
{
  Contact contact;

  PetscFunctionBeginUser;
  PetscCheck(s->solved, s->comm, PETSC_ERR_ARG_WRONGSTATE, "StaticsSolve() comes first");
  for (PetscInt p = 0; p < s->rows.n_pairs; p++)
    closed[p] = s->state[p].status != CONTACT_OPEN ? PETSC_TRUE : PETSC_FALSE;
  PetscCall(OperatorsGetModel(s->operators, NULL, &contact));
  if (s->rows_more) PetscCall(ContactGrow(contact, s->rows_more, closed));
  PetscFunctionReturn(0);
}

PetscErrorCode StaticsIsAffine(Statics s, PetscBool *affine)
{
  const ContactInterface *interfaces;
  PetscInt                n;
  Contact                 contact;

  PetscFunctionBeginUser;
  *affine = s->geometric || s->follower ? PETSC_FALSE : PETSC_TRUE;
  PetscCall(OperatorsGetModel(s->operators, NULL, &contact));
  PetscCall(ContactGetInterfaces(contact, &n, &interfaces));
  for (PetscInt i = 0; i < n; i++)
    if (interfaces[i].damping) *affine = PETSC_FALSE;
  PetscFunctionReturn(0);
}

/* Modes about the sliding state need one: every pair slides or is open */
static PetscErrorCode SlidingCheck(Statics s)
{
  const ContactInterface *interfaces;
  PetscInt                n;
  Contact                 contact;

  PetscFunctionBeginUser;
  PetscCall(OperatorsGetModel(s->operators, NULL, &contact));
  PetscCall(ContactGetInterfaces(contact, &n, &interfaces));
  for (PetscInt i = 0; i < n; i++)
    PetscCheck(interfaces[i].preloaded || interfaces[i].force == 0, s->comm, PETSC_ERR_USER_INPUT,
               "-%s_force %.6g does nothing with -modes_contact static, which takes the normal forces from the -loads",
               interfaces[i].name, (double)interfaces[i].force);
  for (PetscInt i = 0; i < n; i++)
    PetscCheck(interfaces[i].slides || interfaces[i].mu == 0, s->comm, PETSC_ERR_USER_INPUT,
               "-modes_contact static needs to know along what contact %s slides: give -%s_slip x,y,z or -%s_rotation",
               interfaces[i].name, interfaces[i].name, interfaces[i].name);
  PetscFunctionReturn(0);
}

/* Hands on the pairs, their forces and the preload */
static PetscErrorCode HandOn(Statics s)
{
  PetscBool *closed;
  PetscReal *force;
  PetscInt  *group;
  Contact    contact;
  Mat        geometric = NULL, follower = NULL;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc3(s->rows.n_pairs, &closed, s->rows.n_pairs, &force, s->rows.n_pairs, &group));
  PetscCall(StaticsGetClosed(s, closed));
  for (PetscInt p = 0; p < s->rows.n_pairs; p++) {
    group[p] = closed[p] ? 0 : -1;
    force[p] = s->state[p].lambda_n;
  }
  PetscCall(OperatorsGetModel(s->operators, NULL, &contact));
  PetscCall(ContactSetForces(contact, force));
  if (s->geometric) PetscCall(GeometricStiffnessCreate(s->operators, s->u, &geometric));
  if (s->follower) PetscCall(FollowerStiffnessCreate(s->operators, s->state, &follower));
  PetscCall(OperatorsSetPreload(s->operators, geometric, follower));
  PetscCall(OperatorsSetClosed(s->operators, 0, group));
  PetscCall(MatDestroy(&geometric));
  PetscCall(MatDestroy(&follower));
  PetscCall(PetscFree3(closed, force, group));
  PetscFunctionReturn(0);
}

/* Present values of the parameters of the scene, [n_parameters] */
static PetscErrorCode ParametersTake(Statics s, PetscReal p[])
{
  const OperatorsParameter *parameters;
  PetscInt                  n;

  PetscFunctionBeginUser;
  PetscCall(OperatorsGetParameters(s->operators, &n, &parameters));
  for (PetscInt i = 0; i < s->n_parameters; i++) p[i] = parameters[i].value;
  PetscFunctionReturn(0);
}

PetscErrorCode StaticsLinearise(Statics s)
{
  PetscBool  same = PETSC_FALSE;
  PetscReal *p;

  PetscFunctionBeginUser;
  PetscCall(StaticsSetUp(s));
  PetscCall(SlidingCheck(s));
  PetscCall(PetscMalloc1(s->n_parameters, &p));
  PetscCall(ParametersTake(s, p));
  if (s->linearised) PetscCall(PetscArraycmp(p, s->linearised, s->n_parameters, &same));
  if (!same) {
    PetscCall(StaticsSolve(s));
    PetscCall(HandOn(s));
    PetscCall(StaticsRelease(s));
    PetscCall(ParametersTake(s, p)); /* the normal force is one of them, with friction damping */
  }
  PetscCall(PetscFree(s->linearised));
  s->linearised = p;
  PetscFunctionReturn(0);
}
