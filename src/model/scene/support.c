/*
   Essential supports: directions in which the vertices of a named set are held.
*/
#include "model/modelimpl.h"
#include <squeal/options.h>

/* Directions of a support from a word such as "xz" */
static PetscErrorCode SupportSetFromOptions(MPI_Comm comm, Support *support)
{
  char prefix[128], title[160], fix[16] = "xyz";

  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(prefix, sizeof(prefix), "%s_", support->name));
  PetscCall(PetscSNPrintf(title, sizeof(title), "Support %s", support->name));
  PetscOptionsBegin(comm, prefix, title, NULL);
  PetscCall(OptionsGetSet(PetscOptionsObject, &support->set));
  PetscCall(
    PetscOptionsString("-fix", "directions that are held: some of x, y, z", "model.h", fix, fix, sizeof(fix), NULL));
  PetscOptionsEnd();
  PetscCheck(fix[0] && strspn(fix, "xyz") == strlen(fix), comm, PETSC_ERR_USER_INPUT,
             "-%s_fix '%s' must be some of the letters x, y, z", support->name, fix);
  for (int d = 0; d < 3; d++) support->fix[d] = strchr(fix, "xyz"[d]) ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(0);
}

PetscErrorCode SupportsSetFromOptions(Model model)
{
  char *names[MODEL_MAX_NAMES];

  PetscFunctionBeginUser;
  PetscCall(OptionsGetNames(model->comm, "-supports", "essential conditions, each the prefix of its -set and -fix",
                            MODEL_MAX_NAMES, &model->scene.n_supports, names));
  PetscCall(PetscCalloc1(model->scene.n_supports, &model->scene.supports));
  for (PetscInt i = 0; i < model->scene.n_supports; i++) {
    model->scene.supports[i].name = names[i];
    PetscCall(SupportSetFromOptions(model->comm, &model->scene.supports[i]));
  }
  PetscFunctionReturn(0);
}
