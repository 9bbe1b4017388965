/*
   Essential supports: directions in which the nodes of a named set are held.
*/
#include "model/modelimpl.h"
#include <squeal/options.h>

/* Directions of a support from a word such as "xz" */
static PetscErrorCode SupportRead(OptionsItems PetscOptionsObject, void *owner, void *record)
{
  Support *support = record;
  char     fix[16] = "xyz";

  PetscFunctionBeginUser;
  (void)owner;
  PetscCall(OptionsGetSet(PetscOptionsObject, &support->set));
  PetscCall(
    PetscOptionsString("-fix", "directions that are held: some of x, y, z", "model.h", fix, fix, sizeof(fix), NULL));
  PetscCheck(fix[0] && strspn(fix, "xyz") == strlen(fix), PetscOptionsObject->comm, PETSC_ERR_USER_INPUT,
             "-%s_fix '%s' must be some of the letters x, y, z", support->name, fix);
  for (int d = 0; d < 3; d++) support->fix[d] = strchr(fix, "xyz"[d]) ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(0);
}

const OptionsList supports_list = {"-supports", "essential conditions, each the prefix of its -set and -fix", "Support",
                                   sizeof(Support), SupportRead};
