/*
   The sliding state as a value, and what a pencil takes from it: which pairs take part, their normal forces, and the
   point. Pairs whose status changes with the parameters come in groups: the terms of group g have the factor closed_g
   (0 open, 1 closed), so that K stays a sum of fixed matrices with monomials of the parameters for coefficients.
*/
#include "pencilimpl.h"

PetscErrorCode SlidingStateCreate(PetscInt n_pairs, PetscInt n_groups, const PetscInt group[], SlidingState *state)
{
  PetscFunctionBeginUser;
  *state = (SlidingState){.n_pairs = n_pairs, .n_groups = n_groups};
  PetscCall(PetscMalloc1(n_pairs, &state->group));
  PetscCall(PetscArraycpy(state->group, group, n_pairs));
  PetscFunctionReturn(0);
}

PetscErrorCode SlidingStateDestroy(SlidingState *state)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(state->group));
  PetscCall(PetscFree(state->slips));
  PetscCall(PetscFree(state->lambda_n));
  PetscCall(PetscFree(state->p));
  PetscCall(MatDestroy(&state->geometric));
  PetscCall(MatDestroy(&state->follower));
  PetscFunctionReturn(0);
}

/* Raises an error for groups that do not exist or cannot be */
static PetscErrorCode StateCheckGroups(Pencil pencil, const ContactPair pairs[], const SlidingState *state)
{
  const ContactInterface *c;
  PetscInt                n_interfaces, wrong[2] = {0, 0};

  PetscFunctionBeginUser;
  PetscCall(ContactGetInterfaces(pencil->operators->contact, &n_interfaces, &c));
  for (PetscInt p = 0; p < state->n_pairs; p++) {
    if (state->group[p] < -1 || state->group[p] > state->n_groups) wrong[0] = 1;
    if (state->group[p] > 0 && c[pairs[p].interface].law == CONTACT_CONSTRAINT) wrong[1] = 1;
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, wrong, 2, MPIU_INT, MPI_MAX, pencil->comm));
  PetscCheck(!wrong[0], pencil->comm, PETSC_ERR_ARG_OUTOFRANGE, "a group of pairs is none of -1 .. %" PetscInt_FMT,
             state->n_groups);
  PetscCheck(!wrong[1], pencil->comm, PETSC_ERR_SUP,
             "a group of pairs has the exact contact constraint, which is no stiffness that closed_g could scale");
  PetscFunctionReturn(0);
}

/* Groups and normal forces (N) of the local pairs, and the sums of the forces over each interface on all ranks. The
   parameter <contact>_force becomes that sum where the state has forces: friction damping is proportional to it. */
static PetscErrorCode StateTakePairs(Pencil pencil, const SlidingState *state)
{
  const ContactPair      *pairs;
  const ContactInterface *c;
  PetscInt                n_all, n_interfaces;
  Contact                 contact = pencil->operators->contact;

  PetscFunctionBeginUser;
  PetscCall(ContactGetPairs(contact, &pencil->n_pairs, &n_all, &pairs));
  PetscCall(ContactGetInterfaces(contact, &n_interfaces, &c));
  PetscCall(PetscCalloc1(pencil->n_pairs, &pencil->group));
  PetscCall(PetscCalloc1(pencil->n_pairs, &pencil->slips));
  PetscCall(PetscMalloc1(pencil->n_pairs, &pencil->force));
  PetscCall(PetscCalloc1(n_interfaces, &pencil->total));
  if (state) {
    PetscCheck(state->n_pairs == pencil->n_pairs, PETSC_COMM_SELF, PETSC_ERR_ARG_SIZ, "state of other pairs");
    PetscCall(StateCheckGroups(pencil, pairs, state));
    PetscCall(PetscArraycpy(pencil->group, state->group, pencil->n_pairs));
    if (state->slips) PetscCall(PetscArraycpy(pencil->slips, state->slips, pencil->n_pairs));
  }
  for (PetscInt i = 0; i < n_interfaces; i++) pencil->total[i] = pencil->has_forces ? 0 : c[i].force;
  for (PetscInt p = 0; p < pencil->n_pairs; p++) {
    pencil->force[p] = pencil->has_forces ? state->lambda_n[p] : pairs[p].force;
    if (pencil->has_forces) pencil->total[pairs[p].interface] += pencil->force[p];
  }
  if (!pencil->has_forces) PetscFunctionReturn(0);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, pencil->total, (PetscMPIInt)n_interfaces, MPIU_REAL, MPI_SUM, pencil->comm));
  for (PetscInt i = 0; i < n_interfaces; i++) {
    const PetscInt force = pencil->operators->interface[i].force;

    if (force >= 0) pencil->parameters.p[force] = pencil->total[i];
  }
  PetscFunctionReturn(0);
}

PetscErrorCode PencilTakeState(Pencil pencil, const SlidingState *state)
{
  const Parameters *scene = &pencil->operators->parameters;

  PetscFunctionBeginUser;
  PetscCheck(!state || pencil->operators->model, pencil->comm, PETSC_ERR_ARG_WRONGSTATE,
             "matrices without a model have no pairs of contact");
  pencil->n_scene    = scene->n;
  pencil->from_state = state ? PETSC_TRUE : PETSC_FALSE;
  pencil->has_forces = state && state->has_forces ? PETSC_TRUE : PETSC_FALSE;
  pencil->n_groups   = state ? state->n_groups : 0;
  PetscCall(ParametersTake(&pencil->parameters, scene));
  for (PetscInt g = 1; g <= pencil->n_groups; g++) {
    char name[32];

    PetscCall(PetscSNPrintf(name, sizeof(name), "closed_%" PetscInt_FMT, g));
    PetscCall(ParametersAddShare(&pencil->parameters, name));
  }
  if (state && state->p) {
    PetscCheck(state->n_parameters == scene->n, pencil->comm, PETSC_ERR_ARG_SIZ, "state of other parameters");
    PetscCall(PetscArraycpy(pencil->parameters.p, state->p, scene->n));
  }
  if (pencil->operators->model) PetscCall(StateTakePairs(pencil, state));
  PetscFunctionReturn(0);
}

PetscErrorCode PencilGetClosed(Pencil pencil, PencilClosed *closed, PetscBool *from_state)
{
  const ContactPair      *pairs = NULL;
  const ContactInterface *c     = NULL;
  PetscInt                n;

  PetscFunctionBeginUser;
  *from_state = pencil->from_state;
  *closed     = (PencilClosed){0};
  if (pencil->n_pairs) PetscCall(ContactGetPairs(pencil->operators->contact, &n, &n, &pairs));
  if (pencil->n_pairs) PetscCall(ContactGetInterfaces(pencil->operators->contact, &n, &c));
  for (PetscInt p = 0; p < pencil->n_pairs; p++) {
    if (pencil->group[p] < 0) continue;
    closed->n++;
    if (c[pairs[p].interface].kt > 0) *(pencil->slips[p] ? &closed->n_limit : &closed->n_stick) += 1;
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, closed, 3, MPIU_INT, MPI_SUM, pencil->comm));
  PetscFunctionReturn(0);
}
