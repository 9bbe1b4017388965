/*
   Values in words: "first:last:n", "first:last:n:log" or "v1,v2,...".
*/
#include <squeal/options.h>
#include <stdlib.h>
#include <string.h>

#define MAX_VALUES 100000

/* Reads one number; false where the word is none */
static PetscBool NumberParse(const char word[], PetscReal *value)
{
  char *end;

  *value = strtod(word, &end);
  return end != word && !*end && !PetscIsInfOrNanReal(*value) ? PETSC_TRUE : PETSC_FALSE;
}

/* What names the option in errors */
typedef struct {
  MPI_Comm    comm;
  const char *name, *text;
} ValuesOption;

/* Raises an error for a number with a unit */
static PetscErrorCode WordCheckUnit(const ValuesOption *option, const char word[])
{
  char text[256];

  PetscFunctionBeginUser;
  PetscCall(ValueExplainUnit(word, text, sizeof(text)));
  PetscCheck(!text[0], option->comm, PETSC_ERR_USER_INPUT, "%s '%s': %s has a unit: %s", option->name, option->text,
             word, text);
  PetscFunctionReturn(0);
}

/* first:last:n[:log] */
static PetscErrorCode RangeParse(const ValuesOption *option, int n_words, char *words[], PetscInt *n,
                                 PetscReal *value[], PetscBool *ratio)
{
  const PetscBool is_log = n_words == 4 && !strcmp(words[3], "log") ? PETSC_TRUE : PETSC_FALSE;
  PetscReal       first, last, count;

  PetscFunctionBeginUser;
  PetscCheck(n_words == 3 || is_log, option->comm, PETSC_ERR_USER_INPUT,
             "%s '%s' is no range: give first:last:n or first:last:n:log", option->name, option->text);
  for (int i = 0; i < 2; i++) PetscCall(WordCheckUnit(option, words[i]));
  PetscCheck(NumberParse(words[0], &first) && NumberParse(words[1], &last) && NumberParse(words[2], &count),
             option->comm, PETSC_ERR_USER_INPUT,
             "%s '%s' holds what is no number: give first:last:n or first:last:n:log", option->name, option->text);
  PetscCheck(count == PetscFloorReal(count) && count >= 2 && count <= MAX_VALUES, option->comm, PETSC_ERR_USER_INPUT,
             "%s '%s' asks for %.6g values; n must be an integer from 2 to %d", option->name, option->text,
             (double)count, MAX_VALUES);
  PetscCheck(first != last, option->comm, PETSC_ERR_USER_INPUT, "%s '%s' begins where it ends", option->name,
             option->text);
  PetscCheck(!is_log || first * last > 0, option->comm, PETSC_ERR_USER_INPUT,
             "%s '%s': a logarithmic range needs ends of one sign, not zero", option->name, option->text);
  *n     = (PetscInt)count;
  *ratio = is_log;
  PetscCall(PetscMalloc1(*n, value));
  for (PetscInt i = 0; i < *n; i++) {
    const PetscReal t = (PetscReal)i / (PetscReal)(*n - 1);

    (*value)[i] = is_log ? first * PetscPowReal(last / first, t) : first + t * (last - first);
  }
  (*value)[*n - 1] = last;
  PetscFunctionReturn(0);
}

/* v1,v2,... */
static PetscErrorCode ListParse(const ValuesOption *option, PetscInt *n, PetscReal *value[])
{
  char **words;
  int    n_words;

  PetscFunctionBeginUser;
  PetscCall(ValuesSplit(option->comm, option->name, option->text, ',', &n_words, &words));
  PetscCheck(n_words > 0, option->comm, PETSC_ERR_USER_INPUT,
             "%s is empty: give first:last:n, first:last:n:log or v1,v2,...", option->name);
  *n = n_words;
  PetscCall(PetscMalloc1(*n, value));
  for (PetscInt i = 0; i < *n; i++) {
    PetscCall(WordCheckUnit(option, words[i]));
    PetscCheck(NumberParse(words[i], &(*value)[i]), option->comm, PETSC_ERR_USER_INPUT, "%s: '%s' is no number",
               option->name, words[i]);
    PetscCheck(i < 2 || ((*value)[i] - (*value)[i - 1]) * ((*value)[1] - (*value)[0]) > 0, option->comm,
               PETSC_ERR_USER_INPUT, "%s: values must ascend or descend, and %.6g follows %.6g", option->name,
               (double)(*value)[i], (double)(*value)[i - 1]);
  }
  PetscCheck(*n < 2 || (*value)[0] != (*value)[1], option->comm, PETSC_ERR_USER_INPUT, "%s: value %.6g stands twice",
             option->name, (double)(*value)[0]);
  PetscCall(PetscStrToArrayDestroy(n_words, words));
  PetscFunctionReturn(0);
}

PetscErrorCode ValuesParse(MPI_Comm comm, const char option[], const char text[], PetscInt *n, PetscReal *value[],
                           PetscBool *is_log)
{
  const ValuesOption given = {comm, option, text};
  char             **words;
  int                n_words;

  PetscFunctionBeginUser;
  *is_log = PETSC_FALSE;
  if (strchr(text, ':')) {
    PetscCall(ValuesSplit(comm, option, text, ':', &n_words, &words));
    PetscCall(RangeParse(&given, n_words, words, n, value, is_log));
    PetscCall(PetscStrToArrayDestroy(n_words, words));
  } else {
    PetscCall(ListParse(&given, n, value));
  }
  PetscFunctionReturn(0);
}
