/*
   Rows in words: the value in force, the default, the sentence of -help. scene.yaml and -help show the same.
*/
#include "row.h"
#include "base/text.h"
#include <string.h>

PetscErrorCode QuantityGetInitial(const Quantity *row, size_t size, char text[])
{
  const PetscInt n = QuantityCount(row, NULL);
  PetscInt       n_words;

  PetscFunctionBeginUser;
  PetscCall(PetscStrncpy(text, row->text ? row->text : "", size));
  if (row->text || row->required) PetscFunctionReturn(0);
  if (row->kind == QUANTITY_INT || row->kind == QUANTITY_REAL)
    (void)snprintf(text, size, "%.15g", (double)row->initial);
  if (row->kind == QUANTITY_BOOL) PetscCall(PetscStrncpy(text, row->initial != 0 ? "TRUE" : "FALSE", size));
  for (n_words = 0; row->words && row->words[n_words]; n_words++)
    if (row->initial == n_words) PetscCall(PetscStrncpy(text, row->words[n_words], size));
  if (row->kind == QUANTITY_REALS || row->kind == QUANTITY_INTS)
    for (PetscInt i = 0; i < n; i++) PetscCall(TextAdd(text, i ? ",0" : "0", size));
  PetscFunctionReturn(0);
}

PetscErrorCode QuantityGetText(const char option[], const Quantity *row, size_t size, char text[])
{
  const char *given = NULL;
  PetscBool   set;

  PetscFunctionBeginUser;
  PetscCall(OptionsFindGiven(option, &given, &set));
  if (set)
    PetscCall(PetscStrncpy(text, given ? given : "", size));
  else
    PetscCall(QuantityGetInitial(row, size, text));
  PetscFunctionReturn(0);
}

PetscErrorCode QuantityGetHelp(const Quantity *row, size_t size, char help[])
{
  const char  *second = strpbrk(row->help, ";(");
  const size_t length = strlen(row->help);
  size_t       first  = second ? (size_t)(second - row->help) : length;

  PetscFunctionBeginUser;
  if (first < length && first > 0 && row->help[first - 1] == ' ') first--;
  PetscCall(PetscSNPrintf(help, size, "%.*s%s%s%s%s", (int)first, row->help, row->unit ? ", " : "",
                          row->unit ? row->unit : "", row->required ? " (required)" : "", row->help + first));
  for (PetscInt i = 0; row->words && row->words[i]; i++) {
    PetscCall(TextAdd(help, i ? " " : " (one of ", size));
    PetscCall(TextAdd(help, row->words[i], size));
  }
  if (row->words) PetscCall(TextAdd(help, ")", size));
  PetscFunctionReturn(0);
}

PetscErrorCode QuantitiesAddTexts(const QuantityTable *table, const char name[], void *owner, const char why[],
                                  void *ctx)
{
  QuantityTexts *texts = ctx;
  char           option[QUANTITY_HELP];

  PetscFunctionBeginUser;
  (void)owner;
  (void)why;
  PetscCall(PetscRealloc((size_t)(texts->n + table->n) * sizeof(*texts->text), &texts->text));
  for (PetscInt i = 0; i < table->n; i++) {
    QuantityText *text = &texts->text[texts->n];

    if (table->row[i].kind == QUANTITY_PREFIX) continue;
    PetscCall(QuantityGetOption(name, &table->row[i], sizeof(option), option));
    PetscCall(PetscStrncpy(text->name, option + 1, sizeof(text->name)));
    PetscCall(QuantityGetText(option, &table->row[i], sizeof(text->value), text->value));
    text->shows = table->row[i].kind == QUANTITY_VIEWER ? PETSC_TRUE : PETSC_FALSE;
    texts->n++;
  }
  PetscFunctionReturn(0);
}
