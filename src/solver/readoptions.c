/*
   Options of PETSc's and SLEPc's solvers, read on solvers that are made for nothing else: which names they know depends
   on their types, and a misspelt one must be an error before the run.
*/
#include "shiftinvert.h"
#include <slepceps.h>
#include <slepcpep.h>
#include <strings.h>

/* What SLEPc's eigensolvers let one change of what is solved and how, and completeness rests on */
static const char *const solved[] = {"all",
                                     "balance",
                                     "balance_cutoff",
                                     "balance_its",
                                     "basis",
                                     "conv_abs",
                                     "conv_norm",
                                     "conv_rel",
                                     "conv_user",
                                     "extract",
                                     "gen_hermitian",
                                     "gen_indefinite",
                                     "gen_non_hermitian",
                                     "general",
                                     "gyroscopic",
                                     "harmonic",
                                     "harmonic_largest",
                                     "harmonic_relative",
                                     "harmonic_right",
                                     "hermitian",
                                     "hyperbolic",
                                     "interval",
                                     "krylovschur_detect_zeros",
                                     "krylovschur_partitions",
                                     "largest_imaginary",
                                     "largest_magnitude",
                                     "largest_real",
                                     "nev",
                                     "non_hermitian",
                                     "pos_gen_non_hermitian",
                                     "purify",
                                     "refine",
                                     "refined",
                                     "refined_harmonic",
                                     "ritz",
                                     "scale",
                                     "scale_factor",
                                     "scale_its",
                                     "scale_lambda",
                                     "smallest_imaginary",
                                     "smallest_magnitude",
                                     "smallest_real",
                                     "stop_basic",
                                     "stop_user",
                                     "target",
                                     "target_imaginary",
                                     "target_magnitude",
                                     "target_real",
                                     "true_residual",
                                     "two_sided",
                                     "type"};

/* The same of the spectral transformation and its factors */
static const char *const transformed[] = {"cayley_antishift", "filter_degree", "filter_interval", "filter_range",
                                          "matmode",          "matstructure",  "pc_type",         "shift",
                                          "transform",        "type"};

/* Raises an error for an option, given or in a file, of a prefix and one of the names */
static PetscErrorCode SolverRefuse(MPI_Comm comm, const char prefix[], size_t n, const char *const names[],
                                   const char why[])
{
  char        option[64];
  const char *value;
  PetscBool   set;

  PetscFunctionBeginUser;
  for (size_t i = 0; i < n; i++) {
    PetscCall(PetscSNPrintf(option, sizeof(option), "-%s%s", prefix, names[i]));
    PetscCall(PetscOptionsFindPair(NULL, NULL, option, &value, &set));
    PetscCheck(!set, comm, PETSC_ERR_USER_INPUT, "%s%s%s: %s", option, value && value[0] ? " " : "", value ? value : "",
               why);
  }
  PetscFunctionReturn(0);
}

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
    if (!strncasecmp(names[i], prefix, strlen(prefix))) *left = PETSC_TRUE;
  PetscCall(PetscOptionsLeftRestore(NULL, &n, &names, &values));
  PetscFunctionReturn(0);
}

PetscErrorCode SolverReadEigenOptions(MPI_Comm comm)
{
  static const char other[] = "not offered, other modes would be found; choose them by -modes_band or -modes_target";
  PetscBool         eps, pep;

  PetscFunctionBeginUser;
  PetscCall(SolverRefuse(comm, "eps_", PETSC_STATIC_ARRAY_LENGTH(solved), solved, other));
  PetscCall(SolverRefuse(comm, "pep_", PETSC_STATIC_ARRAY_LENGTH(solved), solved, other));
  PetscCall(PrefixIsLeft("eps_", &eps));
  PetscCall(PrefixIsLeft("pep_", &pep));
  if (eps) PetscCall(EpsReadOptions(comm));
  if (pep) PetscCall(PepReadOptions(comm));
  PetscFunctionReturn(0);
}

PetscErrorCode SolverReadFactorOptions(MPI_Comm comm)
{
  static const char exact[] =
    "not offered, the matrix is factorised, and the shift follows from -modes_band or -modes_target; leave it out";
  PetscBool left;

  PetscFunctionBeginUser;
  PetscCall(SolverRefuse(comm, "st_", PETSC_STATIC_ARRAY_LENGTH(transformed), transformed, exact));
  PetscCall(PrefixIsLeft("st_", &left));
  if (!left) PetscFunctionReturn(0);
  PetscCall(KspReadOptions(comm, "st_", KSPPREONLY, PCLU));
  PetscCall(KspReadOptions(comm, "st_pairs_", KSPGMRES, PCNONE));
  PetscFunctionReturn(0);
}
