/*
   From an equilibrium to the sliding state that a pencil is made about: the closed pairs (rows closed or opened at
   their edge where -static_rows asks for it), the normal forces that friction damping needs, and the optional
   stiffness of the preload.
*/
#include "preload.h"
#include "staticsimpl.h"

PetscErrorCode StaticsIsAffine(Statics s, PetscBool *affine)
{
  const ContactInterface *interfaces;
  PetscInt                n;

  PetscFunctionBeginUser;
  *affine = s->geometric || s->follower ? PETSC_FALSE : PETSC_TRUE;
  PetscCall(ContactGetInterfaces(s->contact, &n, &interfaces));
  for (PetscInt i = 0; i < n; i++)
    if (interfaces[i].damping || interfaces[i].kt > 0 || !PressureIsLinear(&interfaces[i].pressure))
      *affine = PETSC_FALSE;
  PetscFunctionReturn(0);
}

/* Modes about the sliding state need one: every pair slides, is open, or belongs to an interface that holds by
   friction */
static PetscErrorCode StaticsCheckSliding(Statics s)
{
  const ContactInterface *c = s->rows.interface;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < s->rows.n_interfaces; i++)
    PetscCheck(c[i].force == 0, s->comm, PETSC_ERR_USER_INPUT,
               "-%s_force %.6g does nothing with -modes_contact static, which takes the normal forces from the -loads; "
               "leave it out",
               c[i].name, (double)c[i].force);
  for (PetscInt i = 0; i < s->rows.n_interfaces; i++)
    PetscCheck(c[i].slides || !FrictionExists(&c[i].friction) || c[i].kt > 0, s->comm, PETSC_ERR_USER_INPUT,
               "modes about the sliding state need to know along what contact %s slides: give -%s_slip x,y,z or "
               "-%s_rotation, or "
               "-%s_kt (N/m per pair) where it holds by friction; or -modes_contact all",
               c[i].name, c[i].name, c[i].name, c[i].name);
  PetscFunctionReturn(0);
}

PetscErrorCode StaticsSolveSliding(Statics s, const PetscReal p[], SlidingState *state)
{
  PetscBool *closed;
  PetscInt  *group;

  PetscFunctionBeginUser;
  PetscCall(StaticsSetUp(s, p));
  PetscCall(StaticsCheckSliding(s));
  PetscCall(StaticsSolveWorn(s, p));
  PetscCall(PetscMalloc2(s->rows.n_pairs, &closed, s->rows.n_pairs, &group));
  for (PetscInt i = 0; i < s->rows.n_pairs; i++) closed[i] = (PetscBool)(s->state[i].status != CONTACT_OPEN);
  if (s->rows_more) PetscCall(ContactGrow(s->contact, s->rows_more, closed));
  for (PetscInt i = 0; i < s->rows.n_pairs; i++) group[i] = closed[i] ? 0 : -1;
  PetscCall(SlidingStateCreate(s->rows.n_pairs, 0, group, state));
  PetscCall(PetscFree2(closed, group));
  state->has_forces = PETSC_TRUE;
  PetscCall(PetscMalloc1(state->n_pairs, &state->slips));
  for (PetscInt i = 0; i < state->n_pairs; i++)
    state->slips[i] = s->state[i].status != CONTACT_STICK && !s->rows.interface[s->rows.pair[i].interface].slides;
  PetscCall(PetscMalloc1(state->n_pairs, &state->lambda_n));
  for (PetscInt i = 0; i < state->n_pairs; i++) state->lambda_n[i] = s->state[i].lambda_n;
  state->n_parameters = s->n_parameters;
  PetscCall(PetscMalloc1(state->n_parameters, &state->p));
  PetscCall(PetscArraycpy(state->p, s->p, state->n_parameters));
  if (s->geometric)
    PetscCall(
      GeometricStiffnessCreate(s->operators, s->p, s->u, StagesGet(s, StagesCount(s) - 1)->share, &state->geometric));
  if (s->follower) PetscCall(FollowerStiffnessCreate(s->operators, s->state, &state->follower));
  PetscFunctionReturn(0);
}
