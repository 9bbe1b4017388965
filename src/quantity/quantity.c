/* Rows of options: read, checked, refused, summed. A value is read where it lies */
#include <squeal/quantity.h>

/* Help as -help shows it: "largest growth, 1/s" */
#define QUANTITY_HELP 512

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
  while (row->words[n]) n++;
  PetscCall(PetscOptionsEList(row->name, help, header, row->words, n, row->words[chosen], &chosen, given));
  *value = (int)chosen;
  PetscFunctionReturn(0);
}

static PetscErrorCode QuantityReadText(OptionsItems PetscOptionsObject, const char header[], const Quantity *row,
                                       const char help[], char text[], PetscBool *given)
{
  PetscFunctionBeginUser;
  PetscCall(PetscOptionsString(row->name, help, header, text, text, row->size, given));
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
  else
    PetscCall(OptionsGetReals(PetscOptionsObject, row->name, help, (PetscInt)(row->size / sizeof(*real)), real, given));
  PetscFunctionReturn(0);
}

static PetscErrorCode QuantityRead(OptionsItems PetscOptionsObject, const char header[], const Quantity *row, void *owner)
{
  void     *value = QuantityValue(row, owner);
  PetscBool given = PETSC_FALSE;
  char      help[QUANTITY_HELP];

  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(help, sizeof(help), "%s%s%s", row->help, row->unit ? ", " : "", row->unit ? row->unit : ""));
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
  case QUANTITY_PATH:
    PetscCall(OptionsGetPath(PetscOptionsObject, row->name, help, value, &given));
    break;
  default:
    PetscCall(QuantityReadNumber(PetscOptionsObject, row, help, value, &given));
  }
  if (row->given) *(PetscBool *)((char *)owner + row->given) = given;
  PetscFunctionReturn(0);
}

/* What a row asks of its value, e.g. "must lie between 0 and 1" */
static PetscErrorCode LimitsDescribe(const Quantity *row, size_t size, char text[])
{
  const double least = (double)row->least, most = (double)row->most;

  PetscFunctionBeginUser;
  if (row->most != 0)
    PetscCall(PetscSNPrintf(text, size, "must lie between %.6g and %.6g", least, most));
  else if (row->least != 0)
    PetscCall(PetscSNPrintf(text, size, "must be at least %.6g", least));
  else
    PetscCall(PetscStrncpy(text, row->open ? "must be positive" : "must not be negative", size));
  if (row->unit) PetscCall(PetscStrlcat(text, " (", size));
  if (row->unit) PetscCall(PetscStrlcat(text, row->unit, size));
  if (row->unit) PetscCall(PetscStrlcat(text, ")", size));
  if (row->why) PetscCall(PetscStrlcat(text, ": ", size));
  if (row->why) PetscCall(PetscStrlcat(text, row->why, size));
  PetscFunctionReturn(0);
}

static PetscErrorCode QuantityCheck(MPI_Comm comm, const Quantity *row, const void *value)
{
  const PetscReal x   = row->kind == QUANTITY_INT ? (PetscReal)*(const PetscInt *)value : *(const PetscReal *)value;
  PetscBool       bad = PETSC_FALSE;
  char            limits[QUANTITY_HELP];

  PetscFunctionBeginUser;
  if (x < row->least || (row->open && x == row->least)) bad = PETSC_TRUE;
  if (row->most != 0 && (x > row->most || (row->open && x == row->most))) bad = PETSC_TRUE;
  if (!bad) PetscFunctionReturn(0);
  PetscCall(LimitsDescribe(row, sizeof(limits), limits));
  PetscCheck(row->kind != QUANTITY_INT, comm, PETSC_ERR_USER_INPUT, "%s %" PetscInt_FMT " %s", row->name,
             *(const PetscInt *)value, limits);
  SETERRQ(comm, PETSC_ERR_USER_INPUT, "%s %.6g %s", row->name, (double)x, limits);
}

PetscErrorCode QuantitiesInit(const QuantityTable *table, void *owner)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < table->n; i++) {
    const Quantity *row   = &table->row[i];
    void           *value = QuantityValue(row, owner);

    if (row->kind == QUANTITY_INT) *(PetscInt *)value = (PetscInt)row->initial;
    if (row->kind == QUANTITY_REAL) *(PetscReal *)value = row->initial;
    if (row->kind == QUANTITY_BOOL || row->kind == QUANTITY_WORD) *(int *)value = (int)row->initial;
  }
  PetscFunctionReturn(0);
}

PetscErrorCode QuantitiesRead(MPI_Comm comm, const QuantityTable *table, void *owner)
{
  PetscFunctionBeginUser;
  PetscOptionsBegin(comm, NULL, table->title, NULL);
  for (PetscInt i = 0; i < table->n; i++)
    PetscCall(QuantityRead(PetscOptionsObject, table->header, &table->row[i], owner));
  PetscOptionsEnd();
  for (PetscInt i = 0; i < table->n; i++)
    if (table->row[i].bounded) PetscCall(QuantityCheck(comm, &table->row[i], QuantityValue(&table->row[i], owner)));
  for (PetscInt i = 0; i < table->n; i++) {
    const char *why = table->row[i].idle ? table->row[i].idle(owner) : NULL;

    if (why) PetscCall(OptionsRefuse(comm, table->row[i].name, why));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode QuantitiesAddChecksum(const QuantityTable *table, const void *owner, Checksum c)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < table->n; i++) {
    const Quantity *row   = &table->row[i];
    const void     *value = (const char *)owner + row->at;

    if (!row->restart) continue;
    if (row->kind == QUANTITY_INT) PetscCall(ChecksumAddInts(c, 1, value));
    else if (row->kind == QUANTITY_REAL || row->kind == QUANTITY_REALS)
      PetscCall(ChecksumAddReals(c, (PetscInt)(row->size / sizeof(PetscReal)), value));
    else if (row->kind == QUANTITY_TEXT || row->kind == QUANTITY_PATH)
      PetscCall(ChecksumAddString(c, value));
    else {
      const PetscInt word = *(const int *)value;

      PetscCall(ChecksumAddInts(c, 1, &word));
    }
  }
  PetscFunctionReturn(0);
}
