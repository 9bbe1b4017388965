/*
   The command line: what stands on it, by PETSc's own rule for names and values, and whether that does anything.

   An options file is shared between analyses: what it says for another one is fine. Who writes an option on the command
   line means it, so what no room of this analysis reads is an error. Which room read an option follows from what is
   marked as used after each has read its own.
*/
#include <squeal/options.h>
#include <strings.h>

#define MAX_WORD 256

PetscErrorCode OptionsNamesFile(const char name[], PetscBool *file, PetscBool *is_yaml)
{
  PetscFunctionBeginUser;
  PetscCall(PetscStrcasecmp(name, "-options_file", file));
  PetscCall(PetscStrcasecmp(name, "-options_file_yaml", is_yaml));
  if (*is_yaml) *file = PETSC_TRUE;
  PetscFunctionReturn(0);
}

/* Whether a word has a control character, which would break the line of a message */
static PetscBool WordHasControl(const char word[])
{
  for (const char *c = word; *c; c++)
    if ((unsigned char)*c < ' ' || *c == 127) return PETSC_TRUE;
  return PETSC_FALSE;
}

PetscErrorCode OptionsCheckArguments(int argc, char *const argv[])
{
  PetscBool is_name, is_next, file, is_yaml;

  PetscFunctionBeginUser;
  for (int i = 1; i < argc; i++) {
    PetscCall(PetscOptionsValidKey(argv[i], &is_name));
    PetscCheck(
      !WordHasControl(argv[i]), PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
      "word %d of the command line has a character that cannot be printed where the name of an option is due: write "
      "-NAME VALUE",
      i);
    PetscCheck(is_name, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
               "'%s' belongs to no option: write -NAME VALUE, where VALUE is one word without spaces, and an options "
               "file as -options_file FILE",
               argv[i]);
    PetscCheck(!strchr(argv[i], '='), PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
               "%s: write -NAME VALUE, with a space in place of =", argv[i]);
    PetscCall(OptionsNamesFile(argv[i], &file, &is_yaml));
    PetscCheck(!file || i + 1 < argc, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT, "%s has no value; give a file", argv[i]);
    if (i + 1 == argc) break;
    PetscCall(PetscOptionsValidKey(argv[i + 1], &is_next));
    PetscCheck(!file || !is_next, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT, "%s has no value; give a file", argv[i]);
    if (is_next) continue;
    PetscCheck(argv[i + 1][strspn(argv[i + 1], " \t\n")], PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
               "%s has an empty value; give one, or leave the option out", argv[i]);
    if (file) PetscCall(OptionsCheckFile(argv[i + 1], is_yaml));
    i++;
  }
  PetscFunctionReturn(0);
}

PetscErrorCode OptionsMoveFiles(int argc, char *argv[])
{
  char    **word;
  int       n = 0;
  PetscBool file, is_yaml;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(argc, &word));
  for (int pass = 0; pass < 2; pass++)
    for (int i = 1; i < argc; i++) {
      PetscBool is_name = PETSC_TRUE;

      PetscCall(OptionsNamesFile(argv[i], &file, &is_yaml));
      if (i + 1 < argc) PetscCall(PetscOptionsValidKey(argv[i + 1], &is_name));
      if ((int)file != pass) word[n++] = argv[i];
      if (is_name) continue;
      if ((int)file != pass) word[n++] = argv[i + 1];
      i++;
    }
  PetscCall(PetscArraycpy(&argv[1], word, n));
  PetscCall(PetscFree(word));
  PetscFunctionReturn(0);
}

PetscErrorCode OptionsFindLargest(char text[], size_t size)
{
  char    **word;
  int       n;
  size_t    line;
  PetscInt  count, most = 0;
  PetscBool file, is_yaml;

  PetscFunctionBeginUser;
  text[0] = '\0';
  PetscCall(PetscGetArgs(&n, &word));
  for (int i = 1; i + 1 < n; i++) {
    PetscCall(OptionsNamesFile(word[i], &file, &is_yaml));
    if (!file) continue;
    PetscCall(OptionsFindLine(word[i + 1], is_yaml, NULL, &line, &count));
    if (count > most) PetscCall(PetscSNPrintf(text, size, "%s gives %" PetscInt_FMT " options", word[i + 1], count));
    most = PetscMax(most, count);
  }
  PetscFunctionReturn(0);
}

PetscErrorCode OptionsFindPlace(const char name[], char text[], size_t size)
{
  char    **word;
  int       n;
  size_t    line = 0;
  PetscInt  count;
  PetscBool file, is_yaml, given;

  PetscFunctionBeginUser;
  text[0] = '\0';
  PetscCall(OptionsCommandGives(name, &given));
  PetscCall(PetscGetArgs(&n, &word));
  for (int i = n - 2; i > 0 && !line && !given; i--) {
    PetscCall(OptionsNamesFile(word[i], &file, &is_yaml));
    if (file) PetscCall(OptionsFindLine(word[i + 1], is_yaml, name, &line, &count));
    if (line) PetscCall(PetscSNPrintf(text, size, "%s:%zu: ", word[i + 1], line));
  }
  PetscFunctionReturn(0);
}

/* Whether a word is a number that is not finite; 1e999 is none either */
static PetscBool WordIsInfinite(const char word[])
{
  char        *end;
  const double value = strtod(word, &end);

  return end != word && !*end && PetscIsInfOrNanReal((PetscReal)value) ? PETSC_TRUE : PETSC_FALSE;
}

/* Raises an error for an infinite number in a value such as 1:2:3,4 */
static PetscErrorCode ValueCheckFinite(const char name[], const char value[])
{
  char word[MAX_WORD];

  PetscFunctionBeginUser;
  for (const char *c = value; *c; c += strspn(c, ",: ")) {
    const size_t length = strcspn(c, ",: ");

    PetscCall(PetscStrncpy(word, c, PetscMin(length + 1, sizeof(word))));
    PetscCheck(!WordIsInfinite(word), PETSC_COMM_SELF, PETSC_ERR_USER_INPUT, "%s value %s must be a finite number",
               name, word);
    c += length;
  }
  PetscFunctionReturn(0);
}

PetscErrorCode OptionsCheckNumber(const char option[])
{
  const char *value;
  PetscBool   set;

  PetscFunctionBeginUser;
  PetscCall(PetscOptionsFindPair(NULL, NULL, option, &value, &set));
  if (set && value) PetscCall(ValueCheckFinite(option, value));
  PetscFunctionReturn(0);
}

PetscErrorCode OptionsCheckNumbers(void)
{
  char     *all, *word, *rest;
  char      name[MAX_WORD] = "";
  PetscBool is_name;

  PetscFunctionBeginUser;
  PetscCall(PetscOptionsGetAll(NULL, &all));
  for (word = strtok_r(all, " ", &rest); word; word = strtok_r(NULL, " ", &rest)) {
    PetscCall(PetscOptionsValidKey(word, &is_name));
    if (is_name) PetscCall(PetscStrncpy(name, word, sizeof(name)));
    PetscCheck(!word[strcspn(word, "\n\r")], PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
               "%s has a value that goes on in a new line after '%.*s'; give it in one line", name,
               (int)strcspn(word, "\n\r"), word);
    if (!is_name && strcasecmp(name, "-output_dir")) PetscCall(ValueCheckFinite(name, word));
  }
  PetscCall(PetscFree(all));
  PetscFunctionReturn(0);
}

PetscErrorCode OptionsCheckValues(MPI_Comm comm)
{
  char       *all, *word, *rest;
  const char *text;
  PetscBool   is_name, set, is_librarys;

  PetscFunctionBeginUser;
  PetscCall(PetscOptionsGetAll(NULL, &all));
  for (word = strtok_r(all, " ", &rest); word; word = strtok_r(NULL, " ", &rest)) {
    PetscCall(PetscOptionsValidKey(word, &is_name));
    if (!is_name) continue;
    PetscCall(OptionIsLibrarys(word + 1, &is_librarys));
    if (is_librarys) continue;
    PetscCall(PetscOptionsFindPair(NULL, NULL, word, &text, &set));
    PetscCheck(!set || (text && text[0]), comm, PETSC_ERR_USER_INPUT,
               "%s has no value; give one, or leave the option out", word);
    if (set && strspn(text, "0123456789.+-eE, ") == strlen(text)) PetscCall(ValuesCheckItems(comm, word, text, ','));
  }
  PetscCall(PetscFree(all));
  PetscFunctionReturn(0);
}
