/*
   Options of PETSc's and SLEPc's solvers, read on solvers that are made for nothing else: which names they know depends
   on their types, and a misspelt one must be an error before the run.
*/
#include "shiftinvert.h"
#include <slepceps.h>
#include <slepcpep.h>

static PetscErrorCode EpsReadOptions(MPI_Comm comm)
{
  EPS eps;

  PetscFunctionBeginUser;
  PetscCall(EPSCreate(comm, &eps));
  PetscCall(EPSSetType(eps, EPSKRYLOVSCHUR));
  PetscCall(EPSSetFromOptions(eps));
  PetscCall(EPSDestroy(&eps));
  PetscFunctionReturn(0);
}

static PetscErrorCode PepReadOptions(MPI_Comm comm)
{
  PEP pep;

  PetscFunctionBeginUser;
  PetscCall(PEPCreate(comm, &pep));
  PetscCall(PEPSetType(pep, PEPTOAR));
  PetscCall(PEPSetFromOptions(pep));
  PetscCall(PEPDestroy(&pep));
  PetscFunctionReturn(0);
}

/* Of a linear solver with the types that it has by default */
static PetscErrorCode KspReadOptions(MPI_Comm comm, const char prefix[], KSPType ksp_type, PCType pc_type)
{
  KSP ksp;
  PC  pc;

  PetscFunctionBeginUser;
  PetscCall(KSPCreate(comm, &ksp));
  PetscCall(KSPSetOptionsPrefix(ksp, prefix));
  PetscCall(KSPSetType(ksp, ksp_type));
  PetscCall(KSPGetPC(ksp, &pc));
  PetscCall(PCSetType(pc, pc_type));
  PetscCall(KSPSetFromOptions(ksp));
  PetscCall(KSPDestroy(&ksp));
  PetscFunctionReturn(0);
}

/* Whether a name that nobody has read begins so */
static PetscErrorCode PrefixIsLeft(const char prefix[], PetscBool *left)
{
  char   **names, **values;
  PetscInt n;

  PetscFunctionBeginUser;
  *left = PETSC_FALSE;
  PetscCall(PetscOptionsLeftGet(NULL, &n, &names, &values));
  for (PetscInt i = 0; i < n; i++)
    if (!strncmp(names[i], prefix, strlen(prefix))) *left = PETSC_TRUE;
  PetscCall(PetscOptionsLeftRestore(NULL, &n, &names, &values));
  PetscFunctionReturn(0);
}

PetscErrorCode SolverReadEigenOptions(MPI_Comm comm)
{
  PetscBool eps, pep;

  PetscFunctionBeginUser;
  PetscCall(PrefixIsLeft("eps_", &eps));
  PetscCall(PrefixIsLeft("pep_", &pep));
  if (eps) PetscCall(EpsReadOptions(comm));
  if (pep) PetscCall(PepReadOptions(comm));
  PetscFunctionReturn(0);
}

PetscErrorCode SolverReadFactorOptions(MPI_Comm comm)
{
  PetscBool left;

  PetscFunctionBeginUser;
  PetscCall(PrefixIsLeft("st_", &left));
  if (!left) PetscFunctionReturn(0);
  PetscCall(KspReadOptions(comm, "st_", KSPPREONLY, PCLU));
  PetscCall(KspReadOptions(comm, "st_inner_", KSPPREONLY, PCSHELL));
  PetscCall(KspReadOptions(comm, "st_pairs_", KSPGMRES, PCNONE));
  PetscFunctionReturn(0);
}
