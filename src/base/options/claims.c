/* What stands on the command line: see arguments.c */
#include <squeal/options.h>
#include <strings.h>
#include "base/text.h"

/* Names and values of the command line, by PETSc's rule; the caller frees both arrays */
static PetscErrorCode ArgumentsGet(PetscInt *n, const char ***name, const char ***value)
{
  char    **argv;
  int       argc;
  PetscBool is_name, is_next;

  PetscFunctionBeginUser;
  PetscCall(PetscGetArgs(&argc, &argv));
  PetscCall(PetscCalloc2(argc, name, argc, value));
  *n = 0;
  for (int i = 1; i < argc; i++) {
    PetscCall(PetscOptionsValidKey(argv[i], &is_name));
    if (!is_name) continue;
    is_next = PETSC_TRUE;
    if (i + 1 < argc) PetscCall(PetscOptionsValidKey(argv[i + 1], &is_next));
    (*name)[*n]      = argv[i];
    (*value)[(*n)++] = is_next ? NULL : argv[i + 1];
  }
  PetscFunctionReturn(0);
}

PetscErrorCode OptionsCommandGives(const char name[], PetscBool *gives)
{
  const char **given, **value;
  PetscInt     n;

  PetscFunctionBeginUser;
  *gives = PETSC_FALSE;
  PetscCall(ArgumentsGet(&n, &given, &value));
  for (PetscInt i = 0; i < n; i++)
    if (!strcasecmp(given[i] + strspn(given[i], "-"), name)) *gives = PETSC_TRUE;
  PetscCall(PetscFree2(given, value));
  PetscFunctionReturn(0);
}

/* Raises an error for an option of the command line; `length` characters of its name count */
static PetscErrorCode ArgumentsRefuse(MPI_Comm comm, const char option[], size_t length, const char why[])
{
  const char **name, **value;
  PetscInt     n;

  PetscFunctionBeginUser;
  PetscCall(ArgumentsGet(&n, &name, &value));
  for (PetscInt i = n - 1; i >= 0; i--) /* the last one is in force */
    PetscCheck(strncasecmp(name[i], option, length), comm, PETSC_ERR_USER_INPUT, "%s%s%s: %s", name[i],
               value[i] ? " " : "", value[i] ? value[i] : "", why);
  PetscCall(PetscFree2(name, value));
  PetscFunctionReturn(0);
}

/* The same of each word after `begin`; whole = 1 for names, 0 for what names begin with */
static PetscErrorCode ArgumentsRefuseEach(MPI_Comm comm, const char begin[], const char words[], size_t whole,
                                          const char why[])
{
  char option[256];

  PetscFunctionBeginUser;
  for (const char *word = words; *word; word += strcspn(word, " "), word += strspn(word, " ")) {
    PetscCall(PetscSNPrintf(option, sizeof(option), "%s%.*s", begin, (int)strcspn(word, " "), word));
    PetscCall(ArgumentsRefuse(comm, option, strlen(option) + whole, why));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode OptionsRefuse(MPI_Comm comm, const char options[], const char why[])
{
  PetscFunctionBeginUser;
  PetscCall(ArgumentsRefuseEach(comm, "", options, 1, why));
  PetscFunctionReturn(0);
}

PetscErrorCode OptionsRefuseOf(MPI_Comm comm, const char owner[], const char names[], const char why[])
{
  char begin[256];

  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(begin, sizeof(begin), "-%s_", owner));
  PetscCall(ArgumentsRefuseEach(comm, begin, names, 1, why));
  PetscFunctionReturn(0);
}

PetscErrorCode OptionsDropBeside(MPI_Comm comm, const char owner[], const char names[], const char choice[],
                                 const char chosen[])
{
  char why[256], options[2048] = "", option[256];

  PetscFunctionBeginUser;
  for (const char *word = names; *word; word += strcspn(word, " "), word += strspn(word, " ")) {
    PetscCall(PetscSNPrintf(option, sizeof(option), "-%s_%.*s ", owner, (int)strcspn(word, " "), word));
    PetscCall(TextAdd(options, option, sizeof(options)));
  }
  PetscCall(PetscSNPrintf(why, sizeof(why), "-%s_%s is %s", owner, choice, chosen));
  PetscCall(OptionsDrop(comm, options, why));
  PetscFunctionReturn(0);
}

PetscErrorCode OptionsRefusePrefix(MPI_Comm comm, const char prefixes[], const char why[])
{
  PetscFunctionBeginUser;
  PetscCall(ArgumentsRefuseEach(comm, "", prefixes, 0, why));
  PetscFunctionReturn(0);
}
