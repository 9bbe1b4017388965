/*
   The records of the changes and of the modes that they make: read, known to others, freed.
*/
#include "changes.h"
#include <string.h>

/* The change that one is made with */
static PetscErrorCode ChangeFindFirst(Modes modes, PetscInt i)
{
  ModesChange change = &modes->change[i];

  PetscFunctionBeginUser;
  change->before = -1;
  if (!change->with[0]) PetscFunctionReturn(0);
  for (PetscInt k = 0; k < i; k++)
    if (!strcmp(modes->change[k].name, change->with)) change->before = k;
  PetscCheck(change->before >= 0, modes->comm, PETSC_ERR_USER_INPUT,
             "-%s_with '%s' is none of -modes_changes before %s: put that one first", change->name, change->with,
             change->name);
  PetscFunctionReturn(0);
}

PetscErrorCode ChangesSetFromOptions(Modes modes)
{
  PetscFunctionBeginUser;
  PetscCall(QuantitiesReadList(modes->comm, &changes_list, modes, &modes->n_changes, &modes->change));
  for (PetscInt i = 0; i < modes->n_changes; i++) PetscCall(ChangeFindFirst(modes, i));
  PetscFunctionReturn(0);
}

PetscBool ChangeHasParameter(const Modes modes, PetscInt i)
{
  return modes->change[i].parameter[0] ? PETSC_TRUE : PETSC_FALSE;
}

PetscErrorCode ChangesVisit(Modes modes, const QuantityVisitor *visitor)
{
  PetscFunctionBeginUser;
  PetscCall(QuantitiesVisitList(visitor, &changes_list, modes->n_changes, modes->change));
  PetscFunctionReturn(0);
}

PetscErrorCode ChangesReset(Modes modes)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < modes->n_changes && modes->changed; i++) PetscCall(PetscFree(modes->changed[i].mode));
  PetscCall(PetscFree(modes->changed));
  PetscFunctionReturn(0);
}

PetscErrorCode ChangesDestroy(Modes modes)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < modes->n_changes; i++) {
    ModesChange change = &modes->change[i];
    char      **own[]  = {&change->name,    &change->part,       &change->to_part, &change->with,
                          &change->unknown, &change->to_unknown, &change->set,     &change->parameter};

    for (size_t k = 0; k < PETSC_STATIC_ARRAY_LENGTH(own); k++) PetscCall(PetscFree(*own[k]));
  }
  PetscCall(PetscFree(modes->change));
  PetscFunctionReturn(0);
}
