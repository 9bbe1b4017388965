/* Rows of options: read, checked, refused, summed. A value is read where it lies */
#include <squeal/quantity.h>
#include <string.h>

/* An upper limit of rounding alone: nobody comes near it */
#define QUANTITY_FAR 1e20

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
  PetscCheck(row->size == sizeof(*value), PETSC_COMM_SELF, PETSC_ERR_PLIB, "%s is no enumeration", row->name);
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

/* At most as many values as its place holds; how many, stands at .count */
static PetscErrorCode QuantityReadList(OptionsItems PetscOptionsObject, const char header[], const Quantity *row,
                                       const char help[], void *owner, PetscBool *given)
{
  const PetscBool integers = row->kind == QUANTITY_INTS ? PETSC_TRUE : PETSC_FALSE;
  const PetscInt  most     = (PetscInt)(row->size / (integers ? sizeof(PetscInt) : sizeof(PetscReal)));
  PetscInt       *count = (PetscInt *)((char *)owner + row->count), *ints, n = most + 1;
  PetscReal      *reals;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc2(n, &ints, n, &reals));
  PetscCall(OptionsCheckWords(PetscOptionsObject, row->name, integers));
  if (integers)
    PetscCall(PetscOptionsIntArray(row->name, help, header, ints, &n, given));
  else
    PetscCall(PetscOptionsRealArray(row->name, help, header, reals, &n, given));
  PetscCheck(!*given || n <= most, PetscOptionsObject->comm, PETSC_ERR_USER_INPUT,
             "%s has more than %" PetscInt_FMT " values", row->name, most);
  if (*given) *count = n;
  if (*given) PetscCall(PetscMemcpy(QuantityValue(row, owner), integers ? (void *)ints : (void *)reals,
                                    (size_t)n * (row->size / (size_t)most)));
  PetscCall(PetscFree2(ints, reals));
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

/* The unit behind what the help says first: "largest growth, 1/s (0: any)" */
static PetscErrorCode HelpWithUnit(const Quantity *row, size_t size, char help[])
{
  const char  *second = strpbrk(row->help, ";(");
  const size_t length = strlen(row->help);
  size_t       first  = second ? (size_t)(second - row->help) : length;

  PetscFunctionBeginUser;
  if (first < length && first > 0 && row->help[first - 1] == ' ') first--;
  if (row->unit)
    PetscCall(PetscSNPrintf(help, size, "%.*s, %s%s", (int)first, row->help, row->unit, row->help + first));
  else
    PetscCall(PetscStrncpy(help, row->help, size));
  PetscFunctionReturn(0);
}

static PetscErrorCode QuantityRead(OptionsItems PetscOptionsObject, const char header[], const Quantity *row, void *owner)
{
  void     *value = QuantityValue(row, owner);
  PetscBool given = PETSC_FALSE;
  char      help[QUANTITY_HELP];

  PetscFunctionBeginUser;
  PetscCall(HelpWithUnit(row, sizeof(help), help));
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
  case QUANTITY_LIST:
  case QUANTITY_INTS:
    PetscCall(QuantityReadList(PetscOptionsObject, header, row, help, owner, &given));
    break;
  default:
    PetscCall(QuantityReadNumber(PetscOptionsObject, row, help, value, &given));
  }
  if (row->given) *(PetscBool *)((char *)owner + row->given) = given;
  PetscFunctionReturn(0);
}

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
    PetscCall(PetscStrncpy(text, row->open ? "must be positive" : "must not be negative", size));
  if (row->unit) PetscCall(PetscStrlcat(text, " (", size));
  if (row->unit) PetscCall(PetscStrlcat(text, row->unit, size));
  if (row->unit) PetscCall(PetscStrlcat(text, ")", size));
  if (row->why) PetscCall(PetscStrlcat(text, ": ", size));
  if (row->why) PetscCall(PetscStrlcat(text, row->why, size));
  PetscFunctionReturn(0);
}

/* The option of a row, with the name of its owner: -pad_mu */
static PetscErrorCode QuantityGetOption(const char name[], const Quantity *row, size_t size, char option[])
{
  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(option, size, "-%s%s%s", name ? name : "", name ? "_" : "", row->name + 1));
  PetscFunctionReturn(0);
}

/* Whether a number is outside the limits of its row */
static PetscBool QuantityIsOutside(const Quantity *row, PetscReal x)
{
  if (!(x >= row->least) || (row->open && x == row->least)) return PETSC_TRUE;
  return row->most != 0 && (x > row->most || (row->open && x == row->most)) ? PETSC_TRUE : PETSC_FALSE;
}

/* All numbers of a row */
static PetscErrorCode QuantityCheck(MPI_Comm comm, const char name[], const Quantity *row, void *owner)
{
  const void    *value   = QuantityValue(row, owner);
  const PetscInt integer = row->kind == QUANTITY_INT || row->kind == QUANTITY_INTS;
  PetscInt       n       = (PetscInt)(row->size / (integer ? sizeof(PetscInt) : sizeof(PetscReal)));
  char           limits[QUANTITY_HELP], option[QUANTITY_HELP];

  PetscFunctionBeginUser;
  if (row->kind == QUANTITY_LIST || row->kind == QUANTITY_INTS) n = *(const PetscInt *)((const char *)owner + row->count);
  for (PetscInt i = 0; i < n; i++) {
    const PetscReal x = integer ? (PetscReal)((const PetscInt *)value)[i] : ((const PetscReal *)value)[i];

    if (!QuantityIsOutside(row, x)) continue;
    PetscCall(LimitsDescribe(row, x, sizeof(limits), limits));
    PetscCall(QuantityGetOption(name, row, sizeof(option), option));
    SETERRQ(comm, PETSC_ERR_USER_INPUT, "%s %.*g %s", option, integer ? 20 : 6, (double)x, limits);
  }
  PetscFunctionReturn(0);
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
    if (row->text) PetscCall(PetscStrncpy(value, row->text, row->size));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode QuantitiesReadOf(MPI_Comm comm, const char name[], const QuantityTable *table, void *owner)
{
  char prefix[QUANTITY_HELP] = "";

  PetscFunctionBeginUser;
  if (name) PetscCall(PetscSNPrintf(prefix, sizeof(prefix), "%s_", name));
  PetscOptionsBegin(comm, name ? prefix : NULL, table->title, NULL);
  for (PetscInt i = 0; i < table->n; i++)
    PetscCall(QuantityRead(PetscOptionsObject, table->header, &table->row[i], owner));
  PetscOptionsEnd();
  for (PetscInt i = 0; i < table->n; i++)
    if (table->row[i].bounded) PetscCall(QuantityCheck(comm, name, &table->row[i], owner));
  for (PetscInt i = 0; i < table->n; i++) {
    const char *why = table->row[i].idle ? table->row[i].idle(owner) : NULL;
    char        option[QUANTITY_HELP];

    PetscCall(QuantityGetOption(name, &table->row[i], sizeof(option), option));
    if (why) PetscCall(OptionsRefuse(comm, option, why));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode QuantitiesRead(MPI_Comm comm, const QuantityTable *table, void *owner)
{
  PetscFunctionBeginUser;
  PetscCall(QuantitiesReadOf(comm, NULL, table, owner));
  PetscFunctionReturn(0);
}

PetscErrorCode QuantitiesAddChecksum(const QuantityTable *table, const void *owner, Checksum c)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < table->n; i++) {
    const Quantity *row   = &table->row[i];
    const void     *value = (const char *)owner + row->at;
    const PetscInt  count = row->count ? *(const PetscInt *)((const char *)owner + row->count) : 1;

    if (!row->restart) continue;
    if (row->kind == QUANTITY_INT || row->kind == QUANTITY_INTS) PetscCall(ChecksumAddInts(c, count, value));
    else if (row->kind == QUANTITY_LIST) PetscCall(ChecksumAddReals(c, count, value));
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
