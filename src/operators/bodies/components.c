/*
   Terms of stiffnesses (N/m), dampings (N s/m) or masses that are given along x, y, z and spread over nodes by shares:
   one term where the components that are given are equal, else one for each direction.
*/
#include "operators/operatorsimpl.h"

/* Parameter and term of the directions of the mask, which share one value */
static PetscErrorCode ComponentsAddTerm(Operators o, const Components *c, const char what[], const PetscBool mask[3],
                                        PetscReal value, PetscInt index[3])
{
  PetscInt parameter;
  Mat      A;

  PetscFunctionBeginUser;
  PetscCall(
    ParametersAdd(&o->parameters, c->owner, what, &(OperatorsParameter){.row = c->row, .value = value}, &parameter));
  if (!o->omit) {
    PetscCall(c->create(o, c->of, mask, &A));
    PetscCall(TermsAdd(&o->terms, c->kind, A, PETSC_TRUE, 1, &parameter));
    PetscCall(TermsSetCause(&o->terms, c->cause, c->owner, what));
    PetscCall(MatDestroy(&A));
  }
  for (int d = 0; d < 3; d++)
    if (mask[d]) index[d] = parameter;
  PetscFunctionReturn(0);
}

/* index [3]: the parameter of each direction, -1 of one that is not given. A value of 0 counts as not given. */
PetscErrorCode OperatorsAddComponents(Operators o, const Components *c, PetscInt index[3])
{
  PetscBool mask[3], uniform = PETSC_TRUE, any = PETSC_FALSE;
  PetscReal value = 0;

  PetscFunctionBeginUser;
  for (int d = 0; d < 3; d++) {
    index[d] = -1;
    mask[d]  = c->value[d] != 0 ? PETSC_TRUE : PETSC_FALSE;
    if (mask[d] && value != 0 && c->value[d] != value) uniform = PETSC_FALSE;
    if (mask[d]) value = c->value[d], any = PETSC_TRUE;
  }
  if (any && uniform) PetscCall(ComponentsAddTerm(o, c, c->what, mask, value, index));
  for (int d = 0; d < 3 && !uniform; d++) {
    const PetscBool only[3] = {(PetscBool)(d == 0), (PetscBool)(d == 1), (PetscBool)(d == 2)};
    char            name[32];

    if (!mask[d]) continue;
    PetscCall(PetscSNPrintf(name, sizeof(name), "%s_%c", c->what, "xyz"[d]));
    PetscCall(ComponentsAddTerm(o, c, name, only, c->value[d], index));
  }
  PetscFunctionReturn(0);
}
