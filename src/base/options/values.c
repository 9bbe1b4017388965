/*
   Values that PETSc reads otherwise: arrays of a given length, words, viewers.
*/
#include <squeal/options.h>
#include <string.h>
#include <strings.h>

#define MAX_REALS 16
#define MAX_TEXT  512

/* Whether a number stands between two underscores */
static PetscBool NameHasNumber(const char name[])
{
  for (const char *c = strchr(name, '_'); c; c = strchr(c + 1, '_')) {
    const size_t digits = strspn(c + 1, "0123456789");

    if (digits && c[1 + digits] == '_') return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

PetscErrorCode OptionsIsOwn(const char option[], PetscBool *own)
{
  char       *all, *rest, name[MAX_TEXT];
  const char *value;
  PetscBool   more;

  PetscFunctionBeginUser;
  *own = PETSC_TRUE;
  if (!NameHasNumber(option)) PetscFunctionReturn(0);
  *own = PETSC_FALSE;
  PetscCall(PetscOptionsGetAll(NULL, &all));
  rest = all;
  PetscCall(OptionsNextGiven(&rest, sizeof(name), name, &value, &more));
  while (more && !*own) {
    *own = strcasecmp(name, option + 1) ? PETSC_FALSE : PETSC_TRUE;
    PetscCall(OptionsNextGiven(&rest, sizeof(name), name, &value, &more));
  }
  PetscCall(PetscFree(all));
  PetscFunctionReturn(0);
}

/* Raises the error for an option of more or fewer than n values, of which PETSc leaves out those beyond n */
static PetscErrorCode OptionsCheckCount(MPI_Comm comm, const char option[], PetscInt n, PetscBool *set)
{
  PetscReal all[MAX_REALS];
  PetscInt  count = MAX_REALS;
  PetscBool given;

  PetscFunctionBeginUser;
  PetscCall(PetscOptionsGetRealArray(NULL, NULL, option, all, &count, &given));
  PetscCheck(!given || count == n, comm, PETSC_ERR_USER_INPUT, "%s has %" PetscInt_FMT " values; give %" PetscInt_FMT,
             option, count, n);
  if (set) *set = given;
  PetscFunctionReturn(0);
}

/* Value of an option that is given, NULL for none, and whether it is given; leaves it unused where nobody used it */
PetscErrorCode OptionsFindGiven(const char name[], const char **value, PetscBool *given)
{
  PetscInt n;
  char   **names, **values;

  PetscFunctionBeginUser;
  *given = PETSC_FALSE;
  PetscCall(PetscOptionsLeftGet(NULL, &n, &names, &values));
  for (PetscInt i = 0; i < n && !*given; i++) {
    *given = strcasecmp(names[i], name + 1) ? PETSC_FALSE : PETSC_TRUE;
    *value = values[i];
  }
  PetscCall(PetscOptionsLeftRestore(NULL, &n, &names, &values));
  if (!*given) PetscCall(PetscOptionsFindPair(NULL, NULL, name, value, given));
  PetscFunctionReturn(0);
}

PetscErrorCode OptionsNextGiven(char **text, size_t size, char name[], const char **value, PetscBool *more)
{
  const size_t length = strcspn(*text, " ");
  char         dashed[MAX_TEXT];

  PetscFunctionBeginUser;
  *more = **text == '-' ? PETSC_TRUE : PETSC_FALSE;
  if (!*more) PetscFunctionReturn(0);
  PetscCall(PetscStrncpy(dashed, *text, PetscMin(length + 1, sizeof(dashed))));
  PetscCall(OptionsFindGiven(dashed, value, more));
  PetscCheck(*more, PETSC_COMM_SELF, PETSC_ERR_PLIB, "%s is given and cannot be found", dashed);
  PetscCall(PetscStrncpy(name, dashed + 1, size));
  *text += length;
  if (*value) *text += 1 + strlen(*value);
  *text += strspn(*text, " ");
  if (!*value) *value = "";
  PetscFunctionReturn(0);
}

/* Gives an option without a value the value that this stands for, so that OptionsCheckValues() sees it */
static PetscErrorCode OptionsFillValue(const char name[], const char text[])
{
  const char *value;
  PetscBool   set;

  PetscFunctionBeginUser;
  PetscCall(PetscOptionsFindPair(NULL, NULL, name, &value, &set));
  if (set && !(value && value[0])) PetscCall(PetscOptionsSetValue(NULL, name, text));
  PetscFunctionReturn(0);
}

PetscErrorCode OptionsGetBool(const char option[], PetscBool *value, PetscBool *set)
{
  PetscFunctionBeginUser;
  PetscCall(OptionsFillValue(option, "true"));
  PetscCall(PetscOptionsGetBool(NULL, NULL, option, value, set));
  PetscFunctionReturn(0);
}

PetscErrorCode OptionsGetReals(MPI_Comm comm, const char option[], PetscInt n, PetscReal values[], PetscBool *set)
{
  PetscInt count = n;

  PetscFunctionBeginUser;
  PetscCall(OptionsCheckWords(comm, option, PETSC_FALSE));
  PetscCall(PetscOptionsGetRealArray(NULL, NULL, option, values, &count, NULL));
  PetscCall(OptionsCheckCount(comm, option, n, set));
  PetscFunctionReturn(0);
}

PetscErrorCode OptionsGetSome(MPI_Comm comm, const char option[], const OptionsRoom *room, PetscInt *n)
{
  PetscInt   count = room->most + 1, *integer; /* PETSc leaves out what is beyond */
  PetscReal *real;
  PetscBool  given;

  PetscFunctionBeginUser;
  PetscCall(OptionsCheckWords(comm, option, room->ints ? PETSC_TRUE : PETSC_FALSE));
  PetscCall(PetscMalloc2(count, &real, count, &integer));
  if (room->ints)
    PetscCall(PetscOptionsGetIntArray(NULL, NULL, option, integer, &count, &given));
  else
    PetscCall(PetscOptionsGetRealArray(NULL, NULL, option, real, &count, &given));
  *n = given ? count : 0;
  PetscCheck(*n <= room->most, comm, PETSC_ERR_USER_INPUT, "%s has more than %" PetscInt_FMT " values", option,
             room->most);
  if (room->ints) PetscCall(PetscArraycpy(room->ints, integer, *n));
  if (room->reals) PetscCall(PetscArraycpy(room->reals, real, *n));
  PetscCall(PetscFree2(real, integer));
  PetscFunctionReturn(0);
}

PetscErrorCode OptionsGetInts(MPI_Comm comm, const char option[], PetscInt n, PetscInt values[], PetscBool *set)
{
  PetscInt count = n;

  PetscFunctionBeginUser;
  PetscCall(OptionsCheckWords(comm, option, PETSC_TRUE));
  PetscCall(PetscOptionsGetIntArray(NULL, NULL, option, values, &count, NULL));
  PetscCall(OptionsCheckCount(comm, option, n, set));
  PetscFunctionReturn(0);
}

/* Takes the blanks at both ends off */
static PetscErrorCode ItemTrim(char item[])
{
  const size_t first = strspn(item, " \t");
  size_t       last  = strlen(item);

  PetscFunctionBeginUser;
  while (last > first && strchr(" \t", item[last - 1])) last--;
  PetscCall(PetscMemmove(item, item + first, last - first));
  item[last - first] = '\0';
  PetscFunctionReturn(0);
}

PetscErrorCode ValuesCheckItems(MPI_Comm comm, const char option[], const char text[], char separator)
{
  const char by[] = {separator, '\0'};

  PetscFunctionBeginUser;
  if (!text[0]) PetscFunctionReturn(0); /* who reads it says what to give */
  for (const char *c = text; c; c = strchr(c, separator) ? strchr(c, separator) + 1 : NULL)
    PetscCheck(strspn(c, " \t") < strcspn(c, by), comm, PETSC_ERR_USER_INPUT,
               "%s '%s' has nothing before or after a '%s': leave that out, or name what it parts", option, text, by);
  PetscFunctionReturn(0);
}

PetscErrorCode ValuesSplit(MPI_Comm comm, const char option[], const char text[], char separator, int *n, char ***items)
{
  PetscFunctionBeginUser;
  PetscCall(ValuesCheckItems(comm, option, text, separator));
  PetscCall(PetscStrToArray(text, separator, n, items));
  for (int i = 0; i < *n; i++) PetscCall(ItemTrim((*items)[i]));
  PetscFunctionReturn(0);
}

PetscErrorCode OptionsGetWords(MPI_Comm comm, const char option[], PetscInt *n, char ***words)
{
  const char *text  = NULL;
  char      **split = NULL;
  int         count = 0;
  PetscBool   set;

  PetscFunctionBeginUser;
  PetscCall(PetscOptionsFindPair(NULL, NULL, option, &text, &set));
  if (set && text && text[0]) PetscCall(ValuesSplit(comm, option, text, ',', &count, &split));
  PetscCall(PetscMalloc1(count, words));
  for (int i = 0; i < count; i++) PetscCall(PetscStrallocpy(split[i], &(*words)[i]));
  PetscCall(PetscStrToArrayDestroy(count, split));
  *n = count;
  PetscFunctionReturn(0);
}

PetscErrorCode OptionsTextAppend(char text[], const char more[], size_t size)
{
  size_t length;

  PetscFunctionBeginUser;
  PetscCall(PetscStrlen(text, &length));
  PetscCall(PetscStrncpy(text + length, more, size - length));
  PetscFunctionReturn(0);
}

PetscErrorCode OptionsGetItems(const char option[], PetscInt *n, char *items[], PetscBool *set)
{
  PetscFunctionBeginUser;
  PetscCall(PetscOptionsGetStringArray(NULL, NULL, option, items, n, set));
  for (PetscInt i = 0; i < *n; i++)
    if (items[i]) PetscCall(ItemTrim(items[i]));
  PetscFunctionReturn(0);
}

PetscErrorCode OptionsGetViewer(MPI_Comm comm, const char option[], PetscViewer *viewer)
{
  PetscViewerFormat format;
  PetscBool         ascii, set;

  PetscFunctionBeginUser;
  *viewer = NULL;
  PetscCall(OptionsFillValue(option, "ascii"));
  PetscCall(PetscOptionsGetViewer(comm, NULL, NULL, option, viewer, &format, &set));
  if (!*viewer) PetscFunctionReturn(0);
  PetscCall(PetscObjectTypeCompare((PetscObject)*viewer, PETSCVIEWERASCII, &ascii));
  PetscCheck(ascii, comm, PETSC_ERR_USER_INPUT, "%s shows text: give ascii, or ascii:FILE, or ascii:FILE::append",
             option);
  PetscFunctionReturn(0);
}
