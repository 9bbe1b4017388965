/*
   Who reads what stands on the command line: see arguments.c.
*/
#include <squeal/options.h>

struct _p_OptionsClaims {
  PetscInt     n;
  const char **name, **value; /* as on the command line; value NULL without */
  int         *reader;        /* -1: nobody yet */
};

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

PetscErrorCode OptionsRefuse(MPI_Comm comm, const char option[], const char why[])
{
  const char **name, **value;
  PetscInt     n;
  PetscBool    same;

  PetscFunctionBeginUser;
  PetscCall(ArgumentsGet(&n, &name, &value));
  for (PetscInt i = 0; i < n; i++) {
    PetscCall(PetscStrcasecmp(name[i], option, &same));
    PetscCheck(!same, comm, PETSC_ERR_USER_INPUT, "%s%s%s: %s", option, value[i] ? " " : "", value[i] ? value[i] : "",
               why);
  }
  PetscCall(PetscFree2(name, value));
  PetscFunctionReturn(0);
}

PetscErrorCode OptionsClaimsCreate(OptionsClaims *claims)
{
  OptionsClaims c;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&c));
  PetscCall(ArgumentsGet(&c->n, &c->name, &c->value));
  PetscCall(PetscMalloc1(c->n, &c->reader));
  for (PetscInt i = 0; i < c->n; i++) c->reader[i] = -1;
  *claims = c;
  PetscFunctionReturn(0);
}

PetscErrorCode OptionsClaim(OptionsClaims c, int reader)
{
  PetscBool used;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < c->n; i++) {
    if (c->reader[i] >= 0) continue;
    PetscCall(PetscOptionsUsed(NULL, c->name[i] + strspn(c->name[i], "-"), &used));
    if (used) c->reader[i] = reader;
  }
  PetscFunctionReturn(0);
}

PetscErrorCode OptionsClaimsCheck(MPI_Comm comm, OptionsClaims c, const OptionsReader readers[], const char analysis[])
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < c->n; i++) {
    const OptionsReader *reader = c->reader[i] < 0 ? NULL : &readers[c->reader[i]];

    PetscCheck(!reader || reader->in_force, comm, PETSC_ERR_USER_INPUT,
               "%s%s%s: not used by -analysis %s; it belongs to %s", c->name[i], c->value[i] ? " " : "",
               c->value[i] ? c->value[i] : "", analysis, reader->belongs);
  }
  PetscFunctionReturn(0);
}

PetscErrorCode OptionsClaimsDestroy(OptionsClaims *claims)
{
  OptionsClaims c = *claims;

  PetscFunctionBeginUser;
  if (!c) PetscFunctionReturn(0);
  PetscCall(PetscFree2(c->name, c->value));
  PetscCall(PetscFree(c->reader));
  PetscCall(PetscFree(*claims));
  PetscFunctionReturn(0);
}
