/* One option, read where its row says. A value is read where it lies */
#include "row.h"
#include <string.h>

static void *QuantityValue(const Quantity *row, void *owner)
{
  return (char *)owner + row->at;
}

/* One of the words of a row, kept as int */
static PetscErrorCode QuantityReadWord(const char option[], const Quantity *row, int *value, PetscBool *given)
{
  PetscInt n = 0, chosen = *value;

  PetscFunctionBeginUser;
  PetscCheck(row->size == sizeof(*value), PETSC_COMM_SELF, PETSC_ERR_PLIB, "%s is no enumeration", row->name);
  while (row->words[n]) n++;
  PetscCall(PetscOptionsGetEList(NULL, NULL, option, row->words, n, &chosen, given));
  *value = (int)chosen;
  PetscFunctionReturn(0);
}

/* A text of at most size - 2 characters: one that fills its room may have been cut */
static PetscErrorCode QuantityReadText(MPI_Comm comm, const char option[], size_t size, char text[], PetscBool *given)
{
  PetscFunctionBeginUser;
  PetscCall(PetscOptionsGetString(NULL, NULL, option, text, size, given));
  PetscCheck(strlen(text) + 1 < size, comm, PETSC_ERR_USER_INPUT, "%s %.40s... is too long: give at most %d characters",
             option, text, (int)size - 2);
  PetscFunctionReturn(0);
}

/* A word of any length that its owner keeps; unchanged where it is not given */
static PetscErrorCode QuantityReadName(MPI_Comm comm, const char option[], char **name, PetscBool *given)
{
  char text[QUANTITY_HELP] = "";

  PetscFunctionBeginUser;
  PetscCall(QuantityReadText(comm, option, sizeof(text), text, given));
  if (!*given) PetscFunctionReturn(0);
  PetscCall(PetscFree(*name));
  PetscCall(PetscStrallocpy(text, name));
  PetscFunctionReturn(0);
}

/* As many words as its place holds */
static PetscErrorCode QuantityReadNames(MPI_Comm comm, const char option[], const Quantity *row, char *name[],
                                        PetscBool *given)
{
  const PetscInt most = (PetscInt)(row->size / sizeof(*name));
  PetscInt       n    = most + 1;
  char         **items;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(n, &items));
  PetscCall(OptionsGetItems(option, &n, items, given));
  PetscCheck(!*given || n == most, comm, PETSC_ERR_USER_INPUT,
             "%s has %" PetscInt_FMT " names; give %" PetscInt_FMT ": %s", option, n, most, row->why);
  for (PetscInt i = 0; i < most && *given; i++) name[i] = items[i];
  PetscCall(PetscFree(items));
  PetscFunctionReturn(0);
}

/* As many values as are given, in an array of its own */
static PetscErrorCode QuantityReadMany(MPI_Comm comm, const char option[], PetscInt room, PetscReal **values,
                                       PetscInt *n, PetscBool *given)
{
  PetscReal *all;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1((size_t)room, &all));
  PetscCall(OptionsGetSome(comm, option, &(OptionsRoom){room, all, NULL}, n));
  if (*n) PetscCall(PetscMalloc1(*n, values));
  PetscCall(PetscArraycpy(*values, all, *n));
  *given = *n ? PETSC_TRUE : PETSC_FALSE;
  PetscCall(PetscFree(all));
  PetscFunctionReturn(0);
}

/* At most as many values as its place holds; how many, stands at .count */
static PetscErrorCode QuantityReadList(MPI_Comm comm, const char option[], const Quantity *row, void *owner,
                                       PetscBool *given)
{
  const PetscBool integers = row->kind == QUANTITY_INTS ? PETSC_TRUE : PETSC_FALSE;
  const size_t    size     = integers ? sizeof(PetscInt) : sizeof(PetscReal);
  void           *value    = QuantityValue(row, owner);
  PetscInt        n;

  PetscFunctionBeginUser;
  PetscCall(OptionsGetSome(
    comm, option, &(OptionsRoom){(PetscInt)(row->size / size), integers ? NULL : value, integers ? value : NULL}, &n));
  *given = n ? PETSC_TRUE : PETSC_FALSE;
  if (*given) *(PetscInt *)((char *)owner + row->count) = n;
  PetscFunctionReturn(0);
}

static PetscErrorCode QuantityReadNumber(MPI_Comm comm, const char option[], const Quantity *row, void *value,
                                         PetscBool *given)
{
  const PetscInt n_ints = (PetscInt)(row->size / sizeof(PetscInt)), n_reals = (PetscInt)(row->size / sizeof(PetscReal));

  PetscFunctionBeginUser;
  if (row->kind == QUANTITY_INT)
    PetscCall(OptionsGetInt(comm, option, value, given));
  else if (row->kind == QUANTITY_REAL)
    PetscCall(OptionsGetReal(comm, option, value, given));
  else if (row->kind == QUANTITY_INTS)
    PetscCall(OptionsGetInts(comm, option, n_ints, value, given));
  else
    PetscCall(OptionsGetReals(comm, option, n_reals, value, given));
  PetscFunctionReturn(0);
}

PetscErrorCode QuantityGetOption(const char name[], const Quantity *row, size_t size, char option[])
{
  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(option, size, "-%s%s%s", name ? name : "", name ? "_" : "", row->name + 1));
  PetscFunctionReturn(0);
}

/* Raises an error for an option without a value, before others are told that it is not there */
static PetscErrorCode QuantityCheckValue(MPI_Comm comm, const char option[])
{
  const char *text;
  PetscBool   set;

  PetscFunctionBeginUser;
  PetscCall(PetscOptionsFindPair(NULL, NULL, option, &text, &set));
  PetscCheck(!set || (text && text[0]), comm, PETSC_ERR_USER_INPUT,
             "%s has no value; give one, or leave the option out", option);
  PetscFunctionReturn(0);
}

/* The value of an option of this name, unchanged where it is not given */
static PetscErrorCode QuantityReadValue(MPI_Comm comm, const char option[], const Quantity *row, void *owner,
                                        PetscBool *given)
{
  void     *value = QuantityValue(row, owner);
  PetscInt *n     = row->count ? (PetscInt *)((char *)owner + row->count) : NULL;

  PetscFunctionBeginUser;
  if (row->kind <= QUANTITY_MANY) PetscCall(QuantityCheckValue(comm, option));
  if (row->kind <= QUANTITY_MANY) PetscCall(OptionsCheckNumber(option));
  switch (row->kind) {
  case QUANTITY_BOOL:
    PetscCall(OptionsGetBool(option, value, given));
    break;
  case QUANTITY_WORD:
    PetscCall(QuantityReadWord(option, row, value, given));
    break;
  case QUANTITY_TEXT:
    PetscCall(QuantityReadText(comm, option, row->size, value, given));
    break;
  case QUANTITY_NAMES:
    if (n)
      PetscCall(OptionsGetWords(comm, option, n, value));
    else
      PetscCall(QuantityReadNames(comm, option, row, value, given));
    if (n && *n) *given = PETSC_TRUE;
    break;
  case QUANTITY_MANY:
    PetscCall(QuantityReadMany(comm, option, row->room, value, n, given));
    break;
  case QUANTITY_NAME:
    PetscCall(QuantityReadName(comm, option, value, given));
    break;
  case QUANTITY_VIEWER:
    PetscCall(OptionsGetViewer(comm, option, value));
    break;
  case QUANTITY_PREFIX:
    break;
  case QUANTITY_PATH:
    PetscCall(OptionsGetPath(comm, option, value, given));
    break;
  default:
    if (row->count)
      PetscCall(QuantityReadList(comm, option, row, owner, given));
    else
      PetscCall(QuantityReadNumber(comm, option, row, value, given));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode QuantityRead(MPI_Comm comm, const char name[], const Quantity *row, void *owner)
{
  PetscBool own, given = PETSC_FALSE;
  char      option[QUANTITY_HELP];

  PetscFunctionBeginUser;
  PetscCall(QuantityGetOption(name, row, sizeof(option), option));
  PetscCall(OptionsIsOwn(option, &own));
  if (own) PetscCall(QuantityReadValue(comm, option, row, owner, &given));
  if (row->given) *(PetscBool *)((char *)owner + row->given) = given;
  PetscFunctionReturn(0);
}
