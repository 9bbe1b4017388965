/*
   Which pairs of the contact take part, and the stiffness of their preload. Setting them makes the terms of the
   contact anew; terms of the bodies and all parameters of the scene stay. Pairs whose status changes with the
   parameters come in groups: the terms of group g have the factor closed_g (0 open, 1 closed), so that K stays a sum of
   fixed matrices with monomials of the parameters for coefficients.
*/
#include "operatorsimpl.h"

PetscInt OperatorsPairGroup(Operators o, PetscInt pair)
{
  return o->group ? o->group[pair] : 0;
}

/* Raises an error for groups that do not exist or cannot be */
static PetscErrorCode GroupsCheck(Operators o, PetscInt n_groups, const PetscInt group[])
{
  const ContactPair      *pairs;
  const ContactInterface *c;
  PetscInt                n, n_all, n_interfaces, wrong[2] = {0, 0};

  PetscFunctionBeginUser;
  PetscCheck(o->model, o->comm, PETSC_ERR_ARG_WRONGSTATE, "matrices without a model have no pairs of contact");
  PetscCall(ContactGetPairs(o->contact, &n, &n_all, &pairs));
  PetscCall(ContactGetInterfaces(o->contact, &n_interfaces, &c));
  for (PetscInt p = 0; p < n && group; p++) {
    if (group[p] < -1 || group[p] > n_groups) wrong[0] = 1;
    if (group[p] > 0 && c[pairs[p].interface].law == CONTACT_CONSTRAINT) wrong[1] = 1;
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, wrong, 2, MPIU_INT, MPI_MAX, o->comm));
  PetscCheck(!wrong[0], o->comm, PETSC_ERR_ARG_OUTOFRANGE, "a group of pairs is none of -1 .. %" PetscInt_FMT,
             n_groups);
  PetscCheck(!wrong[1], o->comm, PETSC_ERR_SUP,
             "a group of pairs has the exact contact constraint, which is no stiffness that closed_g could scale");
  PetscFunctionReturn(0);
}

/* Keeps the groups, and gives each its parameter */
static PetscErrorCode GroupsSet(Operators o, PetscInt n_groups, const PetscInt group[])
{
  const ContactPair *pairs;
  PetscInt           n, n_all;

  PetscFunctionBeginUser;
  PetscCall(ContactGetPairs(o->contact, &n, &n_all, &pairs));
  PetscCall(PetscFree(o->group));
  if (group) {
    PetscCall(PetscMalloc1(n, &o->group));
    PetscCall(PetscArraycpy(o->group, group, n));
  }
  o->n_groups     = n_groups;
  o->n_parameters = o->n_scene;
  for (PetscInt g = 1; g <= n_groups; g++) PetscCall(ParameterAddClosed(o, g));
  PetscFunctionReturn(0);
}

/* Normal forces of the sliding state, where that is where they come from */
static PetscErrorCode ForcesSet(Operators o)
{
  const ContactInterface *c;
  PetscInt                n;

  PetscFunctionBeginUser;
  PetscCall(ContactGetInterfaces(o->contact, &n, &c));
  for (PetscInt i = 0; i < n; i++) {
    const PetscInt force = o->interface[i].force;

    if (force < 0 || !c[i].preloaded) continue;
    o->p[force]               = c[i].force;
    o->parameter[force].value = c[i].force;
  }
  PetscFunctionReturn(0);
}

PetscErrorCode OperatorsSetClosed(Operators operators, PetscInt n_groups, const PetscInt group[])
{
  PetscFunctionBeginUser;
  PetscCall(GroupsCheck(operators, n_groups, group));
  for (int i = 0; i < N_SUMS; i++)
    if (i != SUM_BODIES) PetscCall(TermsSumDestroy(&operators->sum[i]));
  PetscCall(OperatorsDestroyNullSpaces(operators));
  PetscCall(TermsTruncate(&operators->base, operators->n_body_terms));
  PetscCall(GroupsSet(operators, n_groups, group));
  PetscCall(ForcesSet(operators));
  PetscCall(OperatorsAddContact(operators));
  if (operators->geometric)
    PetscCall(TermsAdd(&operators->base, OPERATORS_STIFFNESS, operators->geometric, PETSC_TRUE, 0, NULL));
  if (operators->follower)
    PetscCall(TermsAdd(&operators->base, OPERATORS_STIFFNESS, operators->follower, PETSC_FALSE, 0, NULL));
  PetscFunctionReturn(0);
}

PetscErrorCode OperatorsSetPreload(Operators operators, Mat geometric, Mat follower)
{
  PetscFunctionBeginUser;
  if (geometric) PetscCall(PetscObjectReference((PetscObject)geometric));
  if (follower) PetscCall(PetscObjectReference((PetscObject)follower));
  PetscCall(MatDestroy(&operators->geometric));
  PetscCall(MatDestroy(&operators->follower));
  operators->geometric = geometric;
  operators->follower  = follower;
  PetscFunctionReturn(0);
}
