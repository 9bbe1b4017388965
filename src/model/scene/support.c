/*
   Essential supports: directions in which the nodes of a named set are held.
*/
#include "model/modelimpl.h"
#include <squeal/options.h>

PetscErrorCode SupportCheck(MPI_Comm comm, void *owner, void *record)
{
  Support *s = record;

  PetscFunctionBeginUser;
  (void)owner;
  PetscCheck(s->word[0] && strspn(s->word, "xyz") == strlen(s->word), comm, PETSC_ERR_USER_INPUT,
             "-%s_fix '%s' must be some of the letters x, y, z", s->name, s->word);
  for (int d = 0; d < 3; d++) s->fix[d] = strchr(s->word, "xyz"[d]) ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(0);
}
