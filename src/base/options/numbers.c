/*
   Numbers. PETSc reads `default`, `decide` and `mouse` as -2 and -1, which are codes of its own functions and no
   numbers of a scene, and an integer that its type does not hold as another one: both are refused.
*/
#include <squeal/options.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#define MAX_NUMBER 256

/* Whether a word is one that PETSc takes for a number */
static PetscBool WordIsCode(const char word[])
{
  static const char *const codes[] = {"default", "decide", "determine", "unlimited", "current", "mouse"};

  if (!strncasecmp(word, "petsc_", 6)) word += 6;
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(codes); i++)
    if (!strcasecmp(word, codes[i])) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* Raises an error for one word of a value */
static PetscErrorCode WordCheck(MPI_Comm comm, const char name[], const char word[], PetscBool integer)
{
  char        *end;
  const double value = strtod(word, &end);

  PetscFunctionBeginUser;
  PetscCheck(!WordIsCode(word), comm, PETSC_ERR_USER_INPUT,
             "%s: %s has no numeric value: write it as %s, several with commas", name, word,
             integer ? "4 or 1000, without a point, an exponent or a unit" : "0.3 or 16e9, without a unit");
  PetscCheck(!integer || end == word || *end || (value <= PETSC_MAX_INT && value >= -PETSC_MAX_INT), comm,
             PETSC_ERR_USER_INPUT, "%s %s must be an integer from -%" PetscInt_FMT " to %" PetscInt_FMT, name, word,
             PETSC_MAX_INT, PETSC_MAX_INT);
  PetscFunctionReturn(0);
}

PetscErrorCode OptionsCheckWords(MPI_Comm comm, const char option[], PetscBool integer)
{
  const char *value;
  char        word[MAX_NUMBER];
  PetscBool   set;

  PetscFunctionBeginUser;
  PetscCall(PetscOptionsFindPair(NULL, NULL, option, &value, &set));
  if (!set || !value) PetscFunctionReturn(0);
  for (const char *c = value; *c; c += strspn(c, ", ")) {
    const size_t length = strcspn(c, ", ");

    PetscCall(PetscStrncpy(word, c, PetscMin(length + 1, sizeof(word))));
    PetscCall(WordCheck(comm, option, word, integer));
    c += length;
  }
  PetscFunctionReturn(0);
}

PetscErrorCode OptionsGetReal(MPI_Comm comm, const char option[], PetscReal *value, PetscBool *set)
{
  PetscFunctionBeginUser;
  PetscCall(OptionsCheckWords(comm, option, PETSC_FALSE));
  PetscCall(PetscOptionsGetReal(NULL, NULL, option, value, set));
  PetscFunctionReturn(0);
}

PetscErrorCode OptionsGetInt(MPI_Comm comm, const char option[], PetscInt *value, PetscBool *set)
{
  PetscFunctionBeginUser;
  PetscCall(OptionsCheckWords(comm, option, PETSC_TRUE));
  PetscCall(PetscOptionsGetInt(NULL, NULL, option, value, set));
  PetscFunctionReturn(0);
}
