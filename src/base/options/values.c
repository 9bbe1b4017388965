/*
   Values between PetscOptionsBegin() and PetscOptionsEnd(): arrays of a given length, viewers.
*/
#include <squeal/options.h>
#include <string.h>
#include <strings.h>

#define MAX_REALS 16
#define MAX_TEXT  (32 * MAX_REALS)

/* Raises the error for an option of more or fewer than n values, of which PETSc leaves out those beyond n */
static PetscErrorCode OptionsCheckCount(OptionsItems PetscOptionsObject, const char option[], PetscInt n,
                                        PetscBool *set)
{
  const char *prefix = PetscOptionsObject->prefix ? PetscOptionsObject->prefix : "";
  PetscReal   all[MAX_REALS];
  PetscInt    count = MAX_REALS;
  PetscBool   given;

  PetscFunctionBeginUser;
  PetscCall(PetscOptionsGetRealArray(PetscOptionsObject->options, prefix, option, all, &count, &given));
  PetscCheck(!given || count == n, PetscOptionsObject->comm, PETSC_ERR_USER_INPUT,
             "-%s%s has %" PetscInt_FMT " values; give %" PetscInt_FMT, prefix, option + 1, count, n);
  if (set) *set = given;
  PetscFunctionReturn(0);
}

/* Tells PETSc's help printer of an option with its value now and its default; for what PETSc would show in part */
static PetscErrorCode OptionsShow(OptionsItems PetscOptionsObject, const char option[], const char help[],
                                  const char now[], const char initial[])
{
  const char *prefix = PetscOptionsObject->prefix ? PetscOptionsObject->prefix : "";

  PetscFunctionBeginUser;
  if (PetscOptionsObject->printhelp && PetscOptionsObject->count == 1)
    PetscCall((*PetscHelpPrintf)(PetscOptionsObject->comm, "  -%s%s <now %s : formerly %s>: %s (options.h)\n", prefix,
                                 option + 1, now, initial, help));
  PetscFunctionReturn(0);
}

/* Text of an array: 0,8.4e6,0 */
static PetscErrorCode ArrayPrint(PetscInt n, const PetscReal *reals, const PetscInt *integers, char text[MAX_TEXT])
{
  char number[32];

  PetscFunctionBeginUser;
  text[0] = '\0';
  for (PetscInt i = 0; i < n; i++) {
    PetscCall(
      PetscSNPrintf(number, sizeof(number), "%s%.12g", i ? "," : "", reals ? (double)reals[i] : (double)integers[i]));
    PetscCall(PetscStrlcat(text, number, MAX_TEXT));
  }
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
static PetscErrorCode OptionsFillValue(PetscOptions options, const char name[], const char text[])
{
  const char *value;
  PetscBool   set;

  PetscFunctionBeginUser;
  PetscCall(PetscOptionsFindPair(options, NULL, name, &value, &set));
  if (set && !(value && value[0])) PetscCall(PetscOptionsSetValue(options, name, text));
  PetscFunctionReturn(0);
}

PetscErrorCode OptionsGetBool(OptionsItems PetscOptionsObject, const char option[], const char help[], PetscBool *value)
{
  char name[256];

  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(name, sizeof(name), "-%s%s", PetscOptionsObject->prefix ? PetscOptionsObject->prefix : "",
                          option + 1));
  PetscCall(OptionsFillValue(PetscOptionsObject->options, name, "true"));
  PetscCall(PetscOptionsBool(option, help, "options.h", *value, value, NULL));
  PetscFunctionReturn(0);
}

PetscErrorCode OptionsGetReals(OptionsItems PetscOptionsObject, const char option[], const char help[], PetscInt n,
                               PetscReal values[], PetscBool *set)
{
  PetscInt count = n;
  char     now[MAX_TEXT], initial[MAX_TEXT];

  PetscFunctionBeginUser;
  PetscCall(ArrayPrint(n, values, NULL, initial));
  PetscCall(OptionsCheckWords(PetscOptionsObject, option, PETSC_FALSE));
  PetscCall(
    PetscOptionsGetRealArray(PetscOptionsObject->options, PetscOptionsObject->prefix, option, values, &count, NULL));
  PetscCall(ArrayPrint(n, values, NULL, now));
  PetscCall(OptionsShow(PetscOptionsObject, option, help, now, initial));
  PetscCall(OptionsCheckCount(PetscOptionsObject, option, n, set));
  PetscFunctionReturn(0);
}

PetscErrorCode OptionsGetSome(OptionsItems PetscOptionsObject, const char option[], const char help[],
                              const char initial[], const OptionsRoom *room, PetscInt *n)
{
  const char *prefix = PetscOptionsObject->prefix ? PetscOptionsObject->prefix : "";
  char        now[MAX_TEXT];
  PetscInt    count = room->most + 1, *integer; /* PETSc leaves out what is beyond */
  PetscReal  *real;
  PetscBool   given;

  PetscFunctionBeginUser;
  PetscCall(OptionsCheckWords(PetscOptionsObject, option, room->ints ? PETSC_TRUE : PETSC_FALSE));
  PetscCall(PetscMalloc2(count, &real, count, &integer));
  if (room->ints)
    PetscCall(PetscOptionsGetIntArray(PetscOptionsObject->options, prefix, option, integer, &count, &given));
  else
    PetscCall(PetscOptionsGetRealArray(PetscOptionsObject->options, prefix, option, real, &count, &given));
  *n = given ? count : 0;
  PetscCheck(*n <= room->most, PetscOptionsObject->comm, PETSC_ERR_USER_INPUT,
             "-%s%s has more than %" PetscInt_FMT " values", prefix, option + 1, room->most);
  if (room->ints) PetscCall(PetscArraycpy(room->ints, integer, *n));
  if (room->reals) PetscCall(PetscArraycpy(room->reals, real, *n));
  PetscCall(PetscFree2(real, integer));
  PetscCall(ArrayPrint(*n, room->reals, room->ints, now));
  /* as PETSc shows one number */
  if (*n == 1 && room->reals) PetscCall(PetscSNPrintf(now, sizeof(now), "%g", (double)room->reals[0]));
  PetscCall(OptionsShow(PetscOptionsObject, option, help, *n ? now : initial, initial));
  PetscFunctionReturn(0);
}

PetscErrorCode OptionsGetInts(OptionsItems PetscOptionsObject, const char option[], const char help[], PetscInt n,
                              PetscInt values[], PetscBool *set)
{
  PetscInt count = n;
  char     now[MAX_TEXT], initial[MAX_TEXT];

  PetscFunctionBeginUser;
  PetscCall(ArrayPrint(n, NULL, values, initial));
  PetscCall(OptionsCheckWords(PetscOptionsObject, option, PETSC_TRUE));
  PetscCall(
    PetscOptionsGetIntArray(PetscOptionsObject->options, PetscOptionsObject->prefix, option, values, &count, NULL));
  PetscCall(ArrayPrint(n, NULL, values, now));
  PetscCall(OptionsShow(PetscOptionsObject, option, help, now, initial));
  PetscCall(OptionsCheckCount(PetscOptionsObject, option, n, set));
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

PetscErrorCode OptionsGetWords(MPI_Comm comm, const char option[], const char help[], PetscInt *n, char ***words)
{
  const char *text  = NULL;
  char      **split = NULL;
  int         count = 0;
  PetscBool   set;

  PetscFunctionBeginUser;
  PetscOptionsBegin(comm, NULL, "Names in the scene", NULL);
  PetscCall(PetscOptionsFindPair(NULL, NULL, option, &text, &set));
  PetscCall(OptionsShow(PetscOptionsObject, option, help, "", ""));
  PetscOptionsEnd();
  if (set && text && text[0]) PetscCall(ValuesSplit(comm, option, text, ',', &count, &split));
  PetscCall(PetscMalloc1(count, words));
  for (int i = 0; i < count; i++) PetscCall(PetscStrallocpy(split[i], &(*words)[i]));
  PetscCall(PetscStrToArrayDestroy(count, split));
  *n = count;
  PetscFunctionReturn(0);
}

PetscErrorCode OptionsGetItems(OptionsItems PetscOptionsObject, const char option[], const char help[], PetscInt *n,
                               char *items[], PetscBool *set)
{
  PetscFunctionBeginUser;
  PetscCall(PetscOptionsStringArray(option, help, "options.h", items, n, set));
  for (PetscInt i = 0; i < *n; i++)
    if (items[i]) PetscCall(ItemTrim(items[i]));
  PetscFunctionReturn(0);
}

PetscErrorCode OptionsGetViewer(MPI_Comm comm, const char option[], const char help[], PetscViewer *viewer)
{
  PetscViewerFormat format;
  PetscBool         ascii, set;

  PetscFunctionBeginUser;
  *viewer = NULL;
  PetscCall(OptionsFillValue(NULL, option, "ascii"));
  PetscOptionsBegin(comm, NULL, "What is shown, and where: ascii, or ascii:FILE, or ascii:FILE::append", NULL);
  PetscCall(PetscOptionsGetViewer(comm, NULL, NULL, option, viewer, &format, &set));
  PetscCall(OptionsShow(PetscOptionsObject, option, help, "", ""));
  PetscOptionsEnd();
  if (!*viewer) PetscFunctionReturn(0);
  PetscCall(PetscObjectTypeCompare((PetscObject)*viewer, PETSCVIEWERASCII, &ascii));
  PetscCheck(ascii, comm, PETSC_ERR_USER_INPUT, "%s shows text: give ascii, or ascii:FILE, or ascii:FILE::append",
             option);
  PetscFunctionReturn(0);
}
