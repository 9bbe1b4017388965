/*
   Lists of names, and values that are no numbers.
*/
#include "help.h"
#include "base/text.h"
#include <squeal/options.h>
#include <ctype.h>
#include <stdlib.h>
#include <strings.h>

#define MAX_NAME  HELP_MAX_NAME
#define MAX_LIST  4096 /* characters of a message */
#define MAX_SHOWN 160  /* characters of a list that are shown */

/* All lists of a scene */
static const char *const lists[] = {
  "-parts",         "-supports", "-springs",          "-dashpots",      "-loads",         "-contacts", "-probes",
  "-motions",       "-impulses", "-circles",          "-joints",        "-points",        "-terms",    "-ties",
  "-modes_changes", "-stages",   "-sample_variables", "-superelements", "-sample_columns"};

/* Whether a name can be a prefix: a letter, then letters, digits and underscores */
static PetscBool NameIsIdentifier(const char name[])
{
  if (!isalpha((unsigned char)name[0])) return PETSC_FALSE;
  for (const char *c = name; *c; c++)
    if (!isalnum((unsigned char)*c) && *c != '_') return PETSC_FALSE;
  return PETSC_TRUE;
}

/* Whether a comma separated list holds the value */
static PetscBool ListHolds(const char list[], const char value[])
{
  const size_t length = strlen(value);

  for (const char *c = list; c; c = strchr(c, ',') ? strchr(c, ',') + 1 : NULL)
    if (!strncmp(c + strspn(c, " "), value, length) && strchr(", ", c[strspn(c, " ") + length])) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* The names of a list of the scene; NULL for none */
static PetscErrorCode ListGiven(const char list[], const char **names)
{
  PetscBool given;

  PetscFunctionBeginUser;
  PetscCall(OptionsFindGiven(list, names, &given));
  if (!given || !*names || !(*names)[0]) *names = NULL;
  PetscFunctionReturn(0);
}

/* The list in words, of a long one how many names it has */
static PetscErrorCode ListShow(const char list[], const char names[], size_t size, char text[])
{
  PetscInt n = 1;

  PetscFunctionBeginUser;
  for (const char *c = names; *c; c++) n += *c == ',';
  if (strlen(names) < MAX_SHOWN)
    PetscCall(PetscSNPrintf(text, size, "%s %s", list, names));
  else
    PetscCall(PetscSNPrintf(text, size, "the %" PetscInt_FMT " names of %s", n, list));
  PetscFunctionReturn(0);
}

PetscErrorCode OptionsFindList(const char name[], size_t size, char text[])
{
  const char *names;

  PetscFunctionBeginUser;
  text[0] = '\0';
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(lists) && !text[0]; i++) {
    PetscCall(ListGiven(lists[i], &names));
    if (names && ListHolds(names, name)) PetscCall(ListShow(lists[i], names, size, text));
  }
  PetscFunctionReturn(0);
}

/* Raises an error for a name that the program's own options begin with, or that another list of the scene has too */
static PetscErrorCode NameCheckFree(MPI_Comm comm, const char option[], const char name[])
{
  static const char *const own[] = {"design", "dynamics",  "frf",          "model", "modes",  "operators",
                                    "output", "projector", "quiet",        "rig",   "sample", "squeal",
                                    "static", "statics",   "superelement", "sweep"};
  const char              *names;
  PetscBool                taken = PETSC_FALSE;

  PetscFunctionBeginUser;
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(own) && !taken; i++)
    PetscCall(PetscStrcasecmp(name, own[i], &taken));
  if (!taken) taken = LibraryHasPrefix(name);
  PetscCheck(!taken, comm, PETSC_ERR_USER_INPUT, "%s '%s' is no name: other options begin with -%s_; choose another",
             option, name, name);
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(lists); i++) {
    PetscCall(ListGiven(lists[i], &names));
    PetscCheck(!names || !strcmp(lists[i], option) || !ListHolds(names, name), comm, PETSC_ERR_USER_INPUT,
               "%s and %s both name '%s', whose options begin with -%s_: choose another name in one of them", lists[i],
               option, name, name);
  }
  PetscFunctionReturn(0);
}

PetscErrorCode OptionsGetNames(MPI_Comm comm, const char option[], PetscInt *n, char ***names)
{
  PetscBool same;
  char    **name;

  PetscFunctionBeginUser;
  PetscCall(OptionsGetWords(comm, option, n, &name));
  for (PetscInt i = 0; i < *n; i++) {
    PetscCheck(NameIsIdentifier(name[i]), comm, PETSC_ERR_USER_INPUT,
               "%s '%s' is no name: use letters, digits and underscores, a letter first%s", option, name[i],
               strcmp(option, "-parts") ? "" : " (-NAME_volume gives the volume of the mesh)");
    for (PetscInt j = 0; j < i; j++) {
      PetscCall(PetscStrcasecmp(name[i], name[j], &same));
      PetscCheck(!same, comm, PETSC_ERR_USER_INPUT, "%s names '%s' twice", option, name[i]);
    }
    PetscCall(NameCheckFree(comm, option, name[i]));
  }
  *names = name;
  PetscFunctionReturn(0);
}

PetscErrorCode OptionsCheckName(MPI_Comm comm, const char option[], const char name[])
{
  char first[MAX_NAME];

  PetscFunctionBeginUser;
  PetscCheck(NameIsIdentifier(name), comm, PETSC_ERR_USER_INPUT,
             "%s '%s' is no name: use letters, digits and underscores, a letter first", option, name);
  PetscCall(PetscSNPrintf(first, sizeof(first), "%.*s", (int)strcspn(name, "_"), name));
  PetscCall(NameCheckFree(comm, option, name));
  PetscCall(NameCheckFree(comm, option, first));
  PetscFunctionReturn(0);
}

/* Whether an option without its dash, which begins with a name and _, is of another name of a list, which is longer */
static PetscErrorCode OptionIsOfLonger(const char option[], size_t length, PetscBool *longer)
{
  const char *name;

  PetscFunctionBeginUser;
  *longer = PETSC_FALSE;
  for (size_t k = 0; k < PETSC_STATIC_ARRAY_LENGTH(lists); k++) {
    PetscCall(ListGiven(lists[k], &name));
    for (name = name ? name : ""; *(name += strspn(name, ", ")); name += strcspn(name, ", ")) {
      const size_t of_name = strcspn(name, ", ");

      if (of_name > length && !strncasecmp(option, name, of_name) && option[of_name] == '_') *longer = PETSC_TRUE;
    }
  }
  PetscFunctionReturn(0);
}

/* The first option of a name that nobody has read, with its dash; empty for none */
static PetscErrorCode UnreadFind(const char name[], char option[MAX_NAME])
{
  const size_t length = strlen(name);
  PetscBool    longer;
  PetscInt     n;
  char       **names, **values;

  PetscFunctionBeginUser;
  option[0] = '\0';
  PetscCall(PetscOptionsLeftGet(NULL, &n, &names, &values));
  for (PetscInt i = 0; i < n && !option[0]; i++) {
    if (strncasecmp(names[i], name, length) || names[i][length] != '_') continue;
    PetscCall(OptionIsOfLonger(names[i], length, &longer));
    if (!longer) PetscCall(PetscSNPrintf(option, MAX_NAME, "-%s", names[i]));
  }
  PetscCall(PetscOptionsLeftRestore(NULL, &n, &names, &values));
  PetscFunctionReturn(0);
}

PetscErrorCode OptionsDropOf(MPI_Comm comm, const char name[], const char why[])
{
  char option[MAX_NAME], text[MAX_LIST] = "";

  PetscFunctionBeginUser;
  PetscCall(UnreadFind(name, option));
  while (option[0]) {
    PetscCall(OptionsRefuse(comm, option, why));
    if (text[0]) PetscCall(WordsAdd(text, ", ", sizeof(text)));
    PetscCall(WordsAdd(text, option, sizeof(text)));
    PetscCall(PetscOptionsClearValue(NULL, option));
    PetscCall(UnreadFind(name, option));
  }
  if (text[0]) PetscCall(PetscFPrintf(comm, stderr, "squeal: warning: %s: not used are %s\n", why, text));
  PetscFunctionReturn(0);
}

/* The first of some words as an option; what comes after it */
static const char *WordTake(const char *words, char option[MAX_NAME])
{
  const size_t length = strcspn(words, " ");

  (void)snprintf(option, MAX_NAME, "%.*s", (int)length, words);
  return words + length + strspn(words + length, " ");
}

PetscErrorCode OptionsDrop(MPI_Comm comm, const char options[], const char why[])
{
  char      option[MAX_NAME];
  PetscBool given, command = PETSC_FALSE;

  PetscFunctionBeginUser;
  for (const char *word = options; *word && !command;) {
    word = WordTake(word, option);
    PetscCall(OptionsCommandGives(option + 1, &command));
  }
  for (const char *word = options; *word && !command;) {
    word = WordTake(word, option);
    PetscCall(PetscOptionsHasName(NULL, NULL, option, &given));
    if (!given) continue;
    PetscCall(PetscOptionsClearValue(NULL, option));
    PetscCall(PetscFPrintf(comm, stderr, "squeal: warning: %s of an options file is not used: %s\n", option, why));
  }
  PetscFunctionReturn(0);
}

/* What a file says of names of a list that are in its place now no more */
static PetscErrorCode FileDropUnlisted(MPI_Comm comm, PetscOptions file, const char list[])
{
  const char *given, *now;
  char        name[MAX_NAME], shown[MAX_LIST], why[MAX_LIST];
  PetscBool   set;

  PetscFunctionBeginUser;
  PetscCall(PetscOptionsFindPair(file, NULL, list, &given, &set));
  if (!set || !given) PetscFunctionReturn(0);
  PetscCall(ListGiven(list, &now));
  PetscCall(ListShow(list, now ? now : "", sizeof(shown), shown));
  for (; *(given += strspn(given, ", ")); given += strcspn(given, ", ")) {
    PetscCall(PetscSNPrintf(name, sizeof(name), "%.*s", (int)strcspn(given, ", "), given));
    PetscCall(PetscSNPrintf(why, sizeof(why), "'%s' is not in %s, which stands in place of an options file's list",
                            name, shown));
    if (!now || !ListHolds(now, name)) PetscCall(OptionsDropOf(comm, name, why));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode OptionsDropUnlisted(MPI_Comm comm)
{
  char   **word;
  int      n;
  PetscInt n_unread;

  PetscFunctionBeginUser;
  PetscCall(PetscOptionsAllUsed(NULL, &n_unread));
  PetscCall(PetscGetArgs(&n, &word));
  for (int i = 1; i + 1 < n && n_unread; i++) {
    PetscOptions file;
    PetscBool    is_file, is_yaml;

    PetscCall(OptionsNamesFile(word[i], &is_file, &is_yaml));
    if (!is_file) continue;
    PetscCall(PetscOptionsCreate(&file));
    if (is_yaml)
      PetscCall(PetscOptionsInsertFileYAML(comm, file, word[i + 1], PETSC_TRUE));
    else
      PetscCall(PetscOptionsInsertFile(comm, file, word[i + 1], PETSC_TRUE));
    for (size_t k = 0; k < PETSC_STATIC_ARRAY_LENGTH(lists); k++) PetscCall(FileDropUnlisted(comm, file, lists[k]));
    PetscCall(PetscOptionsDestroy(&file));
  }
  PetscFunctionReturn(0);
}

#define NUMBER       " has no numeric value: write it as 0.3 or 16e9, without a unit, several with commas"
#define INTEGER_ONLY " has no integer value: write it as 4 or 1000, without a point, an exponent or a unit"

/* Splits a message such as "Input string abc has no numeric value" into the value and what is wrong with it. PETSc 3.22
   refuses what is not finite as "Newly set value nan less than allowed bound ..." */
static PetscBool MessageSplit(const char message[], char value[MAX_NAME], const char **wrong)
{
  static const struct {
    const char *start, *end, *wrong; /* wrong NULL: the end says it */
  } forms[] = {
    {"Input string ", " has no numeric", NUMBER},
    {"Input string ", " has no integer", INTEGER_ONLY},
    {"Input string ", " has no ", NULL},
    {"String of length zero ", "has no ", "a number is missing beside a comma"},
    {"Newly set value ", " less ", " must be a finite number"},
    {"Newly set value ", " greater ", " must be a finite number"},
    {"Unknown logical value: ", NULL, " is neither true nor false"},
  };

  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(forms); i++) {
    const char *end = forms[i].end ? strstr(message, forms[i].end) : NULL;

    if (strncmp(message, forms[i].start, strlen(forms[i].start)) || (forms[i].end && !end)) continue;
    message += strlen(forms[i].start);
    *wrong = forms[i].wrong ? forms[i].wrong : end;
    return snprintf(value, MAX_NAME, "%.*s", (int)(end ? end - message : (ptrdiff_t)strlen(message)), message) <
           MAX_NAME;
  }
  return PETSC_FALSE;
}

/* Whether a name ends in one of the words; in any where there are none */
static PetscBool NameEnds(const char name[], const char *const endings[])
{
  const size_t length = strlen(name);

  for (const char *const *end = endings; end && *end; end++)
    if (length >= strlen(*end) && !strcasecmp(name + length - strlen(*end), *end)) return PETSC_TRUE;
  return endings ? PETSC_FALSE : PETSC_TRUE;
}

PetscErrorCode OptionsWithValue(const char value[], const char *const endings[], char text[], size_t size)
{
  char       *all, *rest, name[MAX_NAME];
  const char *given;
  PetscBool   more;

  PetscFunctionBeginUser;
  text[0] = '\0';
  PetscCall(PetscOptionsGetAll(NULL, &all));
  rest = all;
  PetscCall(OptionsNextGiven(&rest, sizeof(name), name, &given, &more));
  while (more) {
    if (given && given[0] && NameEnds(name, endings) && ListHolds(given, value)) {
      PetscCall(WordsAdd(text, text[0] ? " or -" : "-", size));
      PetscCall(WordsAdd(text, name, size));
    }
    PetscCall(OptionsNextGiven(&rest, sizeof(name), name, &given, &more));
  }
  PetscCall(PetscFree(all));
  PetscFunctionReturn(0);
}

PetscErrorCode OptionsExplainValue(const char message[], char text[], size_t size)
{
  char        value[MAX_NAME], names[MAX_LIST], place[PETSC_MAX_PATH_LEN], unit[MAX_NAME];
  const char *wrong;
  int         most;
  PetscFunctionBeginUser;
  text[0] = '\0';
  if (sscanf(message, "Number of options %*d < max number of options %d", &most) == 1) {
    PetscCall(OptionsFindLargest(place, sizeof(place)));
    PetscCall(PetscSNPrintf(
      text, size,
      "%s; PETSc %d.%d takes %d options of all files and the command line: unite supports, loads or probes of "
      "one kind in one set of the mesh, leave defaults out, or compile with PETSc 3.22, which takes any number",
      place[0] ? place : "too many options", PETSC_VERSION_MAJOR, PETSC_VERSION_MINOR, most));
  }
  if (!MessageSplit(message, value, &wrong)) PetscFunctionReturn(0);
  PetscCall(OptionsWithValue(value + strspn(value, " "), NULL, names, sizeof(names)));
  if (!names[0]) PetscFunctionReturn(0);
  PetscCall(OptionsFindPlace(names + 1, place, sizeof(place)));
  PetscCall(ValueExplainUnit(strstr(wrong, "integer") ? "" : value, unit, sizeof(unit)));
  PetscCall(PetscSNPrintf(text, size, "%s%s: %s%s%s", place, names, value, unit[0] ? " has a unit: " : wrong, unit));
  PetscFunctionReturn(0);
}
