/*
   Values between PetscOptionsBegin() and PetscOptionsEnd(): arrays of a given length, sets, viewers; and finite numbers.
*/
#include <squeal/options.h>

#define MAX_REALS 16

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

PetscErrorCode OptionsGetReals(OptionsItems PetscOptionsObject, const char option[], const char help[], PetscInt n,
                               PetscReal values[], PetscBool *set)
{
  PetscInt count = n;

  PetscFunctionBeginUser;
  PetscCall(PetscOptionsRealArray(option, help, "options.h", values, &count, NULL));
  PetscCall(OptionsCheckCount(PetscOptionsObject, option, n, set));
  PetscFunctionReturn(0);
}

PetscErrorCode OptionsGetInts(OptionsItems PetscOptionsObject, const char option[], const char help[], PetscInt n,
                              PetscInt values[])
{
  PetscInt count = n;

  PetscFunctionBeginUser;
  PetscCall(PetscOptionsIntArray(option, help, "options.h", values, &count, NULL));
  PetscCall(OptionsCheckCount(PetscOptionsObject, option, n, NULL));
  PetscFunctionReturn(0);
}

PetscErrorCode OptionsGetViewer(MPI_Comm comm, const char option[], const char help[], PetscViewer *viewer)
{
  PetscViewerFormat format;
  PetscBool         ascii;

  PetscFunctionBeginUser;
  *viewer = NULL;
  PetscOptionsBegin(comm, NULL, "What is shown, and where: ascii[:FILE[:FORMAT[:append]]]", NULL);
  PetscCall(PetscOptionsViewer(option, help, "options.h", viewer, &format, NULL));
  PetscOptionsEnd();
  if (!*viewer) PetscFunctionReturn(0);
  PetscCall(PetscObjectTypeCompare((PetscObject)*viewer, PETSCVIEWERASCII, &ascii));
  PetscCheck(ascii, comm, PETSC_ERR_USER_INPUT, "%s shows text: give ascii, or ascii:FILE, or ascii:FILE::append",
             option);
  PetscFunctionReturn(0);
}

PetscErrorCode OptionsGetSet(OptionsItems PetscOptionsObject, char **set)
{
  char name[256] = "";

  PetscFunctionBeginUser;
  PetscCall(PetscOptionsString("-set", "named surface, curve, point or volume of the mesh (required)", "options.h",
                               name, name, sizeof(name), NULL));
  PetscCheck(name[0], PetscOptionsObject->comm, PETSC_ERR_USER_INPUT, "-%sset must be given: a named set of the mesh",
             PetscOptionsObject->prefix);
  PetscCall(PetscStrallocpy(name, set));
  PetscFunctionReturn(0);
}

PetscErrorCode OptionsCheckFinite(MPI_Comm comm, const char name[], const char option[], const char unit[],
                                  const PetscReal value[3])
{
  PetscFunctionBeginUser;
  for (int d = 0; d < 3; d++)
    PetscCheck(!PetscIsInfOrNanReal(value[d]), comm, PETSC_ERR_USER_INPUT,
               "-%s_%s value %.6g must be a finite number (%s)", name, option, (double)value[d], unit);
  PetscFunctionReturn(0);
}
