/*
   Groups of pairs (status.c) as affine terms of a pencil,

      K(p) = K_0(p) + sum_g closed_g (k_n N_g' N_g - mu k_n T_g' N_g),

   N_g, T_g the rows of the pairs of group g: each status is a class of points with its own values 0 or 1 of closed_g,
   and one basis serves all of them.
*/
#include "groups.h"

/* Whether some pair of a group obeys the exact constraint, alike on all ranks */
static PetscErrorCode GroupsAreExact(MPI_Comm comm, Operators operators, const PetscInt group[], PetscBool *exact)
{
  const ContactPair *pair;
  Contact            contact;
  PetscInt           n, n_all;

  PetscFunctionBeginUser;
  *exact = PETSC_FALSE;
  PetscCall(OperatorsGetModel(operators, NULL, &contact));
  PetscCall(ContactGetPairs(contact, &n, &n_all, &pair));
  for (PetscInt p = 0; p < n; p++) {
    PetscReal   mu;
    PressureLaw law;

    PetscCall(OperatorsGetInterface(operators, NULL, pair[p].interface, &mu, &law));
    if (group[p] > 0 && PetscIsInfReal(PressureSlope(&law, 0))) *exact = PETSC_TRUE;
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, exact, 1, MPIU_BOOL, MPI_LOR, comm));
  PetscFunctionReturn(0);
}

PetscErrorCode StatusPencilCreate(const StatusList *list, Operators operators, PetscBool *exact, StatusPencil *made)
{
  PetscInt    *group;
  SlidingState state;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(list->n_local, &group));
  PetscCall(StatusListGroup(list, group, &made->n_groups, &made->closed));
  PetscCall(GroupsAreExact(list->comm, operators, group, exact));
  if (!*exact) {
    PetscCall(SlidingStateCreate(list->n_local, made->n_groups, group, &state));
    PetscCall(OperatorsLinearise(operators, &state, &made->pencil));
    PetscCall(SlidingStateDestroy(&state));
    PetscCall(PencilGetParameters(made->pencil, &made->n_parameters, NULL, NULL));
  }
  PetscCall(PetscFree(group));
  PetscFunctionReturn(0);
}

PetscErrorCode StatusPencilFormPattern(const StatusPencil *made, PetscReal p[])
{
  PencilMatrices matrices;

  PetscFunctionBeginUser;
  for (PetscInt g = 1; g <= made->n_groups; g++) p[made->n_parameters - g] = 1;
  PetscCall(PencilSetParameters(made->pencil, p));
  PetscCall(PencilGetMatrices(made->pencil, &matrices));
  PetscCall(PencilGetFrictionless(made->pencil, &matrices));
  PetscFunctionReturn(0);
}
