/*
   The terms of a change and of those that it is made with: forces at nodes, layers over many, and what the parameters
   of all of them add together, for a term may depend on two of them.
*/
#include "changes.h"

PetscErrorCode ChangeCreateTerms(Modes modes, PetscInt i, PetscInt *n, ChangeTerm **terms)
{
  PetscInt  most = 0, n_parameter = 0;
  PetscBool parameters = PETSC_FALSE;

  PetscFunctionBeginUser;
  for (PetscInt k = i; k >= 0; k = modes->change[k].before) {
    if (modes->change[k].parameter[0]) parameters = PETSC_TRUE;
    most += CHANGE_TERMS;
  }
  if (parameters) PetscCall(ChangeCountParameterTerms(modes, &n_parameter));
  PetscCall(PetscCalloc1(most + n_parameter, terms));
  *n = 0;
  for (PetscInt k = i; k >= 0; k = modes->change[k].before) {
    ModesChange change = &modes->change[k];

    if (change->set[0] || change->has_ring)
      PetscCall(ChangeAddLayer(modes, change, n, *terms));
    else if (!change->parameter[0])
      PetscCall(ChangeAddForces(modes, change, n, *terms));
  }
  if (parameters) PetscCall(ChangeAddParameters(modes, i, n, *terms));
  PetscFunctionReturn(0);
}

PetscErrorCode ChangeDestroyTerms(PetscInt n, ChangeTerm **terms)
{
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < n; k++) {
    PetscCall(VecDestroy(&(*terms)[k].force));
    PetscCall(MatDestroy(&(*terms)[k].A));
  }
  PetscCall(PetscFree(*terms));
  PetscFunctionReturn(0);
}
