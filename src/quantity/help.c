/* Rows as -help shows them: name, value in force, sentence with unit, and the default where it is another one */
#include "row.h"
#include <string.h>
#include <strings.h>

PetscErrorCode QuantitiesPrint(const QuantityTable *table, const char name[], void *owner, const char why[], void *ctx)
{
  QuantityPage   *page = ctx;
  const PetscBool same = !strcmp(page->title, table->title) && !name ? PETSC_TRUE : PETSC_FALSE;
  char            option[QUANTITY_HELP], value[QUANTITY_SHOWN], initial[QUANTITY_SHOWN], help[2 * QUANTITY_HELP];

  PetscFunctionBeginUser;
  (void)owner;
  (void)why;
  for (PetscInt i = 0; i < table->n; i++) {
    const Quantity *row = &table->row[i];

    if (row->kind == QUANTITY_PREFIX) continue;
    if (!i && !same) PetscCall(PetscPrintf(page->comm, "%s%s%s\n", table->title, name ? " " : "", name ? name : ""));
    PetscCall(QuantityGetOption(name, row, sizeof(option), option));
    PetscCall(QuantityGetInitial(row, sizeof(initial), initial));
    PetscCall(QuantityGetText(option, row, sizeof(value), value));
    PetscCall(QuantityGetHelp(row, sizeof(help), help));
    PetscCall(PetscPrintf(page->comm, "  %-29s %-14s %s", option, page->example ? initial : value, help));
    if (!page->example && strcasecmp(value, initial) && !row->required)
      PetscCall(PetscPrintf(page->comm, " [default %s]", initial[0] ? initial : "none"));
    PetscCall(PetscPrintf(page->comm, "\n"));
  }
  PetscCall(PetscStrncpy(page->title, name ? "" : table->title, sizeof(page->title)));
  PetscFunctionReturn(0);
}
