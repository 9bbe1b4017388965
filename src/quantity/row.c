/* One option, read where its row says. A value is read where it lies */
#include "row.h"
#include <string.h>

static void *QuantityValue(const Quantity *row, void *owner)
{
  return (char *)owner + row->at;
}

/* One of the words of a row, kept as int */
static PetscErrorCode QuantityReadWord(OptionsItems PetscOptionsObject, const char header[], const Quantity *row,
                                       const char help[], int *value, PetscBool *given)
{
  PetscInt n = 0, chosen = *value;

  PetscFunctionBeginUser;
  PetscCheck(row->size == sizeof(*value), PETSC_COMM_SELF, PETSC_ERR_PLIB, "%s is no enumeration", row->name);
  while (row->words[n]) n++;
  PetscCall(
    PetscOptionsEList(row->name, help, header, row->words, n, chosen < n ? row->words[chosen] : "", &chosen, given));
  *value = (int)chosen;
  PetscFunctionReturn(0);
}

/* Raises an error for a word that fills its room, and may have been cut */
static PetscErrorCode TextCheckLength(OptionsItems PetscOptionsObject, const Quantity *row, const char text[],
                                      size_t size)
{
  const char *const prefix = PetscOptionsObject->prefix ? PetscOptionsObject->prefix : "";

  PetscFunctionBeginUser;
  PetscCheck(strlen(text) + 1 < size, PetscOptionsObject->comm, PETSC_ERR_USER_INPUT,
             "-%s%s %.40s... is too long: give at most %d characters", prefix, row->name + 1, text, (int)size - 2);
  PetscFunctionReturn(0);
}

static PetscErrorCode QuantityReadText(OptionsItems PetscOptionsObject, const char header[], const Quantity *row,
                                       const char help[], char text[], PetscBool *given)
{
  char initial[PETSC_MAX_PATH_LEN];

  PetscFunctionBeginUser;
  PetscCall(PetscStrncpy(initial, text, sizeof(initial))); /* the text is written before PETSc's help shows it */
  PetscCall(PetscOptionsString(row->name, help, header, initial, text, row->size, given));
  PetscCall(TextCheckLength(PetscOptionsObject, row, text, row->size));
  PetscFunctionReturn(0);
}

/* A word of any length that its owner keeps; unchanged where it is not given */
static PetscErrorCode QuantityReadName(OptionsItems PetscOptionsObject, const char header[], const Quantity *row,
                                       const char help[], char **name, PetscBool *given)
{
  char text[QUANTITY_HELP] = "";

  PetscFunctionBeginUser;
  PetscCall(PetscStrncpy(text, *name, sizeof(text)));
  PetscCall(PetscOptionsString(row->name, help, header, *name, text, sizeof(text), given));
  PetscCall(TextCheckLength(PetscOptionsObject, row, text, sizeof(text)));
  PetscCall(PetscFree(*name));
  PetscCall(PetscStrallocpy(text, name));
  PetscFunctionReturn(0);
}

/* As many words as its place holds */
static PetscErrorCode QuantityReadNames(OptionsItems PetscOptionsObject, const Quantity *row, const char help[],
                                        char *name[], PetscBool *given)
{
  const PetscInt most = (PetscInt)(row->size / sizeof(*name));
  PetscInt       n    = most + 1;
  char         **items;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(n, &items));
  PetscCall(OptionsGetItems(PetscOptionsObject, row->name, help, &n, items, given));
  PetscCheck(!*given || n == most, PetscOptionsObject->comm, PETSC_ERR_USER_INPUT,
             "-%s%s has %" PetscInt_FMT " names; give %" PetscInt_FMT ": %s", PetscOptionsObject->prefix, row->name + 1,
             n, most, row->why);
  for (PetscInt i = 0; i < most && *given; i++) name[i] = items[i];
  PetscCall(PetscFree(items));
  PetscFunctionReturn(0);
}

/* As many values as are given, in an array of its own */
static PetscErrorCode QuantityReadMany(OptionsItems PetscOptionsObject, const Quantity *row, const char help[],
                                       PetscReal **values, PetscInt *n, PetscBool *given)
{
  PetscReal *all;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1((size_t)row->room, &all));
  PetscCall(OptionsGetSome(PetscOptionsObject, row->name, help, "", &(OptionsRoom){row->room, all, NULL}, n));
  if (*n) PetscCall(PetscMalloc1(*n, values));
  PetscCall(PetscArraycpy(*values, all, *n));
  *given = *n ? PETSC_TRUE : PETSC_FALSE;
  PetscCall(PetscFree(all));
  PetscFunctionReturn(0);
}

/* At most as many values as its place holds; how many, stands at .count */
static PetscErrorCode QuantityReadList(OptionsItems PetscOptionsObject, const Quantity *row, const char help[],
                                       void *owner, PetscBool *given)
{
  const PetscBool integers = row->kind == QUANTITY_INTS ? PETSC_TRUE : PETSC_FALSE;
  const size_t    size     = integers ? sizeof(PetscInt) : sizeof(PetscReal);
  void           *value    = QuantityValue(row, owner);
  PetscInt        n;

  PetscFunctionBeginUser;
  PetscCall(
    OptionsGetSome(PetscOptionsObject, row->name, help, row->text ? row->text : "",
                   &(OptionsRoom){(PetscInt)(row->size / size), integers ? NULL : value, integers ? value : NULL}, &n));
  *given = n ? PETSC_TRUE : PETSC_FALSE;
  if (*given) *(PetscInt *)((char *)owner + row->count) = n;
  PetscFunctionReturn(0);
}

static PetscErrorCode QuantityReadNumber(OptionsItems PetscOptionsObject, const Quantity *row, const char help[],
                                         void *value, PetscBool *given)
{
  PetscInt  *integer = value;
  PetscReal *real    = value;

  PetscFunctionBeginUser;
  if (row->kind == QUANTITY_INT)
    PetscCall(OptionsGetInt(PetscOptionsObject, row->name, help, *integer, integer, given));
  else if (row->kind == QUANTITY_REAL)
    PetscCall(OptionsGetReal(PetscOptionsObject, row->name, help, *real, real, given));
  else if (row->kind == QUANTITY_INTS)
    PetscCall(
      OptionsGetInts(PetscOptionsObject, row->name, help, (PetscInt)(row->size / sizeof(*integer)), integer, given));
  else
    PetscCall(OptionsGetReals(PetscOptionsObject, row->name, help, (PetscInt)(row->size / sizeof(*real)), real, given));
  PetscFunctionReturn(0);
}

/* The unit behind what the help says first, and whether it is required: "largest growth, 1/s (0: any)" */
static PetscErrorCode HelpWithUnit(const Quantity *row, size_t size, char help[])
{
  const char  *second = strpbrk(row->help, ";(");
  const size_t length = strlen(row->help);
  size_t       first  = second ? (size_t)(second - row->help) : length;

  PetscFunctionBeginUser;
  if (first < length && first > 0 && row->help[first - 1] == ' ') first--;
  PetscCall(PetscSNPrintf(help, size, "%.*s%s%s%s%s", (int)first, row->help, row->unit ? ", " : "",
                          row->unit ? row->unit : "", row->required ? " (required)" : "", row->help + first));
  PetscFunctionReturn(0);
}

PetscErrorCode QuantityGetOption(const char name[], const Quantity *row, size_t size, char option[])
{
  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(option, size, "-%s%s%s", name ? name : "", name ? "_" : "", row->name + 1));
  PetscFunctionReturn(0);
}

/* Raises an error for an option without a value, before others are told that it is not there */
static PetscErrorCode QuantityCheckValue(OptionsItems PetscOptionsObject, const Quantity *row)
{
  const char *const prefix = PetscOptionsObject->prefix;
  const char       *text;
  PetscBool         set;

  PetscFunctionBeginUser;
  PetscCall(PetscOptionsFindPair(PetscOptionsObject->options, prefix, row->name, &text, &set));
  PetscCheck(!set || (text && text[0]), PetscOptionsObject->comm, PETSC_ERR_USER_INPUT,
             "-%s%s has no value; give one, or leave the option out", prefix ? prefix : "", row->name + 1);
  PetscFunctionReturn(0);
}

PetscErrorCode QuantityRead(OptionsItems PetscOptionsObject, const char header[], const Quantity *row, void *owner)
{
  void     *value = QuantityValue(row, owner);
  PetscInt *n     = row->count ? (PetscInt *)((char *)owner + row->count) : NULL;
  PetscBool given = PETSC_FALSE;
  char      help[QUANTITY_HELP];

  PetscFunctionBeginUser;
  PetscCall(HelpWithUnit(row, sizeof(help), help));
  if (row->kind <= QUANTITY_MANY) PetscCall(QuantityCheckValue(PetscOptionsObject, row));
  if (row->kind <= QUANTITY_MANY) PetscCall(OptionsCheckNumber(PetscOptionsObject, row->name));
  switch (row->kind) {
  case QUANTITY_BOOL:
    PetscCall(OptionsGetBool(PetscOptionsObject, row->name, help, value));
    PetscCall(PetscOptionsHasName(PetscOptionsObject->options, PetscOptionsObject->prefix, row->name, &given));
    break;
  case QUANTITY_WORD:
    PetscCall(QuantityReadWord(PetscOptionsObject, header, row, help, value, &given));
    break;
  case QUANTITY_TEXT:
    PetscCall(QuantityReadText(PetscOptionsObject, header, row, help, value, &given));
    break;
  case QUANTITY_NAMES:
    if (n)
      PetscCall(OptionsGetWords(PetscOptionsObject->comm, row->name, help, n, value));
    else
      PetscCall(QuantityReadNames(PetscOptionsObject, row, help, value, &given));
    if (n && *n) given = PETSC_TRUE;
    break;
  case QUANTITY_MANY:
    PetscCall(QuantityReadMany(PetscOptionsObject, row, help, value, n, &given));
    break;
  case QUANTITY_NAME:
    PetscCall(QuantityReadName(PetscOptionsObject, header, row, help, value, &given));
    break;
  case QUANTITY_VIEWER:
    PetscCall(OptionsGetViewer(PetscOptionsObject->comm, row->name, help, value));
    break;
  case QUANTITY_PREFIX:
    break;
  case QUANTITY_PATH:
    PetscCall(OptionsGetPath(PetscOptionsObject, row->name, help, value, &given));
    break;
  default:
    if (row->count)
      PetscCall(QuantityReadList(PetscOptionsObject, row, help, owner, &given));
    else
      PetscCall(QuantityReadNumber(PetscOptionsObject, row, help, value, &given));
  }
  if (row->given) *(PetscBool *)((char *)owner + row->given) = given;
  PetscFunctionReturn(0);
}
