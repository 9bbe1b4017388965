/* Rows of options: checked and summed; row.c reads them, visit.c refuses them */
#include "row.h"
#include "base/options/help.h"
#include "base/text.h"
#include <stdlib.h>
#include <string.h>

/* An upper limit of rounding alone: nobody comes near it */
#define QUANTITY_FAR 1e20

/* What a row asks of its value, e.g. "must lie between 0 and 1" */
static PetscErrorCode LimitsDescribe(const Quantity *row, PetscReal x, size_t size, char text[])
{
  const double    least = (double)row->least, most = (double)row->most;
  const PetscBool far = row->most >= QUANTITY_FAR && x < row->most ? PETSC_TRUE : PETSC_FALSE;

  PetscFunctionBeginUser;
  if (row->most != 0 && !far)
    PetscCall(PetscSNPrintf(text, size, "must lie between %.10g and %.10g", least, most));
  else if (row->least != 0)
    PetscCall(PetscSNPrintf(text, size, "must be at least %.6g", least));
  else
    PetscCall(PetscStrncpy(text, row->open && !row->none ? "must be positive" : "must not be negative", size));
  if (row->unit) PetscCall(WordsAdd(text, " (", size));
  if (row->unit) PetscCall(WordsAdd(text, row->unit, size));
  if (row->unit) PetscCall(WordsAdd(text, ")", size));
  if (row->why) PetscCall(WordsAdd(text, ": ", size));
  if (row->why) PetscCall(WordsAdd(text, row->why, size));
  PetscFunctionReturn(0);
}

/* Whether a number is outside the limits of its row */
static PetscBool QuantityIsOutside(const Quantity *row, PetscReal x)
{
  if (!(x >= row->least) || (row->open && x == row->least)) return PETSC_TRUE;
  return row->most != 0 && (x > row->most || (row->open && x == row->most)) ? PETSC_TRUE : PETSC_FALSE;
}

/* Where the values of a row lie */
static const void *QuantityValues(const Quantity *row, const void *owner)
{
  const char *const at   = (const char *)owner + row->at;
  const PetscBool   kept = row->kind == QUANTITY_MANY || (row->kind == QUANTITY_NAMES && row->count);

  return kept ? *(const void *const *)(const void *)at : at;
}

PetscInt QuantityCount(const Quantity *row, const void *owner)
{
  const PetscBool integer = row->kind == QUANTITY_INT || row->kind == QUANTITY_INTS ? PETSC_TRUE : PETSC_FALSE;

  if (row->count) return owner ? *(const PetscInt *)((const char *)owner + row->count) : 0;
  if (row->kind == QUANTITY_NAMES) return (PetscInt)(row->size / sizeof(char *));
  return (PetscInt)(row->size / (integer ? sizeof(PetscInt) : sizeof(PetscReal)));
}

/* All numbers of a row, whose option is named in full */
static PetscErrorCode QuantityCheck(MPI_Comm comm, const char option[], const Quantity *row, const void *owner)
{
  const void     *value   = QuantityValues(row, owner);
  const PetscBool integer = row->kind == QUANTITY_INT || row->kind == QUANTITY_INTS ? PETSC_TRUE : PETSC_FALSE;
  const PetscInt  n       = QuantityCount(row, owner);
  char            limits[QUANTITY_HELP];

  PetscFunctionBeginUser;
  if (!row->bounded || row->kind > QUANTITY_MANY) PetscFunctionReturn(0); /* of a text its owner makes a number */
  for (PetscInt i = 0; i < n; i++) {
    const PetscReal x = integer ? (PetscReal)((const PetscInt *)value)[i] : ((const PetscReal *)value)[i];

    if (!QuantityIsOutside(row, x) || (row->none && x == 0)) continue;
    PetscCall(LimitsDescribe(row, x, sizeof(limits), limits));
    SETERRQ(comm, PETSC_ERR_USER_INPUT, "%s %.*g %s", option, integer ? 20 : 6, (double)x, limits);
  }
  PetscFunctionReturn(0);
}

/* Whether a row is given, as far as its owner keeps that */
static PetscBool QuantityIsGiven(const Quantity *row, const void *owner)
{
  char *const *name = (char *const *)(const void *)((const char *)owner + row->at);

  PetscInt n = 0;

  if (row->kind == QUANTITY_NAME) return **name ? PETSC_TRUE : PETSC_FALSE;
  if (row->kind == QUANTITY_NAMES && !row->count) return *name ? PETSC_TRUE : PETSC_FALSE;
  if (row->kind == QUANTITY_WORD) {
    while (row->words[n]) n++;
    return *(const int *)(const void *)name < n ? PETSC_TRUE : PETSC_FALSE;
  }
  return row->given ? *(const PetscBool *)((const char *)owner + row->given) : PETSC_TRUE;
}

/* What is required, and the numbers */
static PetscErrorCode QuantityJudge(MPI_Comm comm, const char name[], const Quantity *row, const void *owner)
{
  const PetscBool given = QuantityIsGiven(row, owner);
  HelpKind        help; /* asked for, it takes any scene */
  char            option[QUANTITY_HELP];

  PetscFunctionBeginUser;
  PetscCall(HelpIsAsked(&help));
  PetscCall(QuantityGetOption(name, row, sizeof(option), option));
  PetscCheck(!row->required || given || help != HELP_NONE, comm, PETSC_ERR_USER_INPUT, "%s must be given: %s", option,
             row->why);
  if (given) PetscCall(QuantityCheck(comm, option, row, owner));
  PetscFunctionReturn(0);
}

/* The values of a text "0.02,0.08" */
static PetscErrorCode ListInit(const Quantity *row, void *value)
{
  PetscReal *const real    = row->kind == QUANTITY_INTS ? NULL : value;
  PetscInt *const  integer = value;
  char            *end     = NULL;
  PetscInt         i       = 0;

  PetscFunctionBeginUser;
  for (const char *at = row->text; at && *at; at = *end ? end + 1 : end, i++) {
    const double x = strtod(at, &end);

    PetscCheck(end != at && (size_t)i * (real ? sizeof(*real) : sizeof(*integer)) < row->size, PETSC_COMM_SELF,
               PETSC_ERR_PLIB, "%s: '%s' is no list for it", row->name, row->text);
    if (real)
      real[i] = x;
    else
      integer[i] = (PetscInt)x;
  }
  PetscFunctionReturn(0);
}

PetscErrorCode QuantitiesInit(const QuantityTable *table, void *owner)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < table->n; i++) {
    const Quantity *row   = &table->row[i];
    void           *value = (char *)owner + row->at;

    if (row->kind == QUANTITY_INT) *(PetscInt *)value = (PetscInt)row->initial;
    if (row->kind == QUANTITY_REAL) *(PetscReal *)value = row->initial;
    if (row->kind == QUANTITY_BOOL || row->kind == QUANTITY_WORD) *(int *)value = (int)row->initial;
    if (row->kind == QUANTITY_NAME)
      PetscCall(PetscStrallocpy(row->text ? row->text : "", (char **)value));
    else if (row->kind == QUANTITY_REALS || row->kind == QUANTITY_LIST || row->kind == QUANTITY_INTS)
      PetscCall(ListInit(row, value));
    else if (row->text && row->kind != QUANTITY_MANY)
      PetscCall(PetscStrncpy(value, row->text, row->size));
  }
  PetscFunctionReturn(0);
}

const Quantity *QuantityFind(const QuantityTable *table, const char name[])
{
  for (PetscInt i = 0; i < table->n; i++)
    if (!strcmp(table->row[i].name + 1, name)) return &table->row[i];
  return NULL;
}

PetscErrorCode QuantitiesReadOf(MPI_Comm comm, const char name[], const QuantityTable *table, void *owner)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < table->n; i++) PetscCall(QuantityRead(comm, name, &table->row[i], owner));
  for (PetscInt i = 0; i < table->n; i++) PetscCall(QuantityJudge(comm, name, &table->row[i], owner));
  PetscFunctionReturn(0);
}

PetscErrorCode QuantitiesReadList(MPI_Comm comm, const QuantityList *list, void *owner, PetscInt *n, void *records)
{
  char   **names, *record;
  PetscInt count; /* *n, which stays 0 where the names are refused */

  PetscFunctionBeginUser;
  PetscCall(OptionsGetNames(comm, list->option, &count, &names));
  PetscCall(PetscCalloc((size_t)count * list->size, &record));
  *(void **)records = record, *n = count;
  for (PetscInt i = 0; i < *n; i++) *(char **)(void *)(record + (size_t)i * list->size) = names[i];
  for (PetscInt i = 0; i < *n; i++, record += list->size) {
    PetscCall(QuantitiesInit(list->table, record));
    PetscCall(QuantitiesReadOf(comm, names[i], list->table, record));
    if (list->check) PetscCall(list->check(comm, owner, record));
  }
  PetscCall(PetscFree(names));
  PetscFunctionReturn(0);
}

PetscErrorCode QuantitiesRead(MPI_Comm comm, const QuantityTable *table, void *owner)
{
  PetscFunctionBeginUser;
  PetscCall(QuantitiesReadOf(comm, NULL, table, owner));
  PetscFunctionReturn(0);
}

/* Names, how many there may be */
static PetscErrorCode NamesAddChecksum(char *const names[], PetscInt n, Checksum c)
{

  PetscFunctionBeginUser;
  PetscCall(ChecksumAddInts(c, 1, &n));
  for (PetscInt i = 0; i < n; i++) PetscCall(ChecksumAddString(c, names[i] ? names[i] : ""));
  PetscFunctionReturn(0);
}

PetscErrorCode QuantitiesAddChecksum(const QuantityTable *table, const void *owner, Checksum c)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < table->n; i++) {
    const Quantity *row   = &table->row[i];
    const void     *value = QuantityValues(row, owner);
    const PetscInt  n     = QuantityCount(row, owner);

    if (!row->restart) continue;
    if (row->kind == QUANTITY_INT || row->kind == QUANTITY_INTS)
      PetscCall(ChecksumAddInts(c, n, value));
    else if (row->kind <= QUANTITY_MANY)
      PetscCall(ChecksumAddReals(c, n, value));
    else if (row->kind == QUANTITY_NAMES)
      PetscCall(NamesAddChecksum(value, n, c));
    else if (row->kind == QUANTITY_NAME)
      PetscCall(NamesAddChecksum(value, 1, c));
    else if (row->kind == QUANTITY_TEXT || row->kind == QUANTITY_PATH)
      PetscCall(ChecksumAddString(c, value));
    else {
      const PetscInt word = *(const int *)value;

      PetscCall(ChecksumAddInts(c, 1, &word));
    }
  }
  PetscFunctionReturn(0);
}
