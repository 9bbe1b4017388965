/*
   Options of PETSc's and SLEPc's solvers, read on solvers that are made for nothing else: which names they know depends
   on their types, and a misspelt one must be an error before the run.
*/
#include "solver/block/krylov.h"
#include "solver/factor/shiftinvert.h"
#include <squeal/options.h>
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
                                     "two_sided"};

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

/* Whether -eps_type asks for the solver */
static PetscErrorCode EpsTypeIs(const char type[], PetscBool *is)
{
  char value[64] = "";

  PetscFunctionBeginUser;
  PetscCall(PetscOptionsGetString(NULL, NULL, "-eps_type", value, sizeof(value), NULL));
  PetscCall(PetscStrcmp(value, type, is));
  PetscFunctionReturn(0);
}

/* Raises an error for a type of eigensolver that makes no statement about which modes it finds first */
static PetscErrorCode SolverCheckTypes(MPI_Comm comm)
{
  static const char *const type[] = {"type"}, *const valid[] = {EPSBLOCKKRYLOVSCHUR, EPSKRYLOVSCHUR};
  static const char other[] = "not offered, other modes would be found; choose them by -modes_band or -modes_target";
  static const char offered[] =
    "not offered, other modes would be found; valid are " EPSBLOCKKRYLOVSCHUR " and " EPSKRYLOVSCHUR;
  PetscBool is, any = PETSC_FALSE;

  PetscFunctionBeginUser;
  PetscCall(SolverRefuse(comm, "pep_", 1, type, other));
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(valid); i++) {
    PetscCall(EpsTypeIs(valid[i], &is));
    if (is) any = PETSC_TRUE;
  }
  if (!any) PetscCall(SolverRefuse(comm, "eps_", 1, type, offered));
  PetscFunctionReturn(0);
}

PetscErrorCode SolverVisit(const QuantityVisitor *visitor)
{
  PetscBool single;

  PetscFunctionBeginUser;
  PetscCall(QuantitiesVisit(visitor, &solver_quantities, NULL, NULL, NULL));
  PetscCall(EpsTypeIs(EPSKRYLOVSCHUR, &single));
  PetscCall(BlockKrylovVisit(
    visitor, single ? "not used by -eps_type " EPSKRYLOVSCHUR ", which has no blocks; leave one out" : NULL));
  PetscFunctionReturn(0);
}

static PetscErrorCode EpsReadOptions(MPI_Comm comm)
{
  EPS eps;

  PetscFunctionBeginUser;
  PetscCall(BlockKrylovRegister());
  PetscCall(BlockKrylovReadOptions(comm));
  PetscCall(EPSCreate(comm, &eps));
  PetscCall(EPSSetType(eps, EPSBLOCKKRYLOVSCHUR));
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

/* Of a linear solver with the types that it has by default. Where MUMPS factorises, it reads its own options as it
   does: hence a matrix of one unknown, on the first rank. */
static PetscErrorCode KspReadOptions(MPI_Comm comm, const char prefix[], KSPType ksp_type, PCType pc_type)
{
  PetscMPIInt rank;
  KSP         ksp;
  Mat         A;
  PC          pc;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  PetscCall(MatCreateAIJ(comm, rank ? 0 : 1, rank ? 0 : 1, 1, 1, 1, NULL, 0, NULL, &A));
  if (!rank) PetscCall(MatSetValue(A, 0, 0, 1, INSERT_VALUES));
  PetscCall(MatAssemblyBegin(A, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(A, MAT_FINAL_ASSEMBLY));
  PetscCall(KSPCreate(comm, &ksp));
  PetscCall(KSPSetOptionsPrefix(ksp, prefix));
  PetscCall(KSPSetOperators(ksp, A, A));
  PetscCall(KSPSetType(ksp, ksp_type));
  PetscCall(KSPGetPC(ksp, &pc));
  PetscCall(PCSetType(pc, pc_type));
  if (!strcmp(pc_type, PCLU)) PetscCall(PCFactorSetMatSolverType(pc, MATSOLVERMUMPS));
  PetscCall(KSPSetFromOptions(ksp));
  if (!strcmp(pc_type, PCLU)) PetscCall(KSPSetUp(ksp));
  PetscCall(KSPDestroy(&ksp));
  PetscCall(MatDestroy(&A));
  PetscFunctionReturn(0);
}

/* Whether a name that nobody has read begins with one of the prefixes; with -help_all, which lists them, always */
static PetscErrorCode PrefixIsLeft(size_t n_prefixes, const char *const prefix[], PetscBool *left)
{
  char   **names, **values;
  PetscInt n;

  PetscFunctionBeginUser;
  PetscCall(PetscOptionsHasHelp(NULL, left));
  PetscCall(PetscOptionsLeftGet(NULL, &n, &names, &values));
  for (PetscInt i = 0; i < n; i++)
    for (size_t k = 0; k < n_prefixes; k++)
      if (!strncasecmp(names[i], prefix[k], strlen(prefix[k]))) *left = PETSC_TRUE;
  PetscCall(PetscOptionsLeftRestore(NULL, &n, &names, &values));
  PetscFunctionReturn(0);
}

/* PetscOptionsHasName() knows whole names alone: all options are walked through, without regard to case, as PETSc
   compares them. */
PetscErrorCode SolverOptionsGiven(const char prefix[], PetscBool *given)
{
  char       *all, *text, name[256];
  const char *value;
  PetscBool   more = PETSC_TRUE;

  PetscFunctionBeginUser;
  *given = PETSC_FALSE;
  PetscCall(PetscOptionsGetAll(NULL, &all));
  text = all;
  while (more && !*given) {
    PetscCall(OptionsNextGiven(&text, sizeof(name), name, &value, &more));
    if (more) *given = strncasecmp(name, prefix, strlen(prefix)) ? PETSC_FALSE : PETSC_TRUE;
  }
  PetscCall(PetscFree(all));
  PetscFunctionReturn(0);
}

/* Names that would change which modes are found are refused first; what is left must be known to a solver that is
   made here and destroyed again, or -options_left names it. */
PetscErrorCode SolverReadEigenOptions(MPI_Comm comm)
{
  static const char        other[]  = "not offered, other modes would be found; choose them by -modes_band or "
                                      "-modes_target";
  static const char *const shared[] = {"eps_", "bv_", "ds_", "rg_"}, *const quadratic[] = {"pep_"};
  PetscBool eps, pep;

  PetscFunctionBeginUser;
  PetscCall(SolverRefuse(comm, "eps_", PETSC_STATIC_ARRAY_LENGTH(solved), solved, other));
  PetscCall(SolverRefuse(comm, "pep_", PETSC_STATIC_ARRAY_LENGTH(solved), solved, other));
  PetscCall(SolverCheckTypes(comm));
  PetscCall(PrefixIsLeft(PETSC_STATIC_ARRAY_LENGTH(shared), shared, &eps));
  PetscCall(PrefixIsLeft(PETSC_STATIC_ARRAY_LENGTH(quadratic), quadratic, &pep));
  if (eps) PetscCall(EpsReadOptions(comm));
  if (pep) PetscCall(PepReadOptions(comm));
  PetscFunctionReturn(0);
}

PetscErrorCode SolverReadFactorOptions(MPI_Comm comm)
{
  static const char exact[] =
    "not offered, the matrix is factorised, and the shift follows from -modes_band or -modes_target; leave it out";
  static const char nobody[] =
    "no solver of squeal reads it: steps in time are explicit, and those that factorise a matrix read -st_ksp_*, "
    "-st_pc_* and -st_mat_mumps_*";
  static const char *const factors[] = {"st_", "mat_mumps_"}, *const others[] = {"-snes_", "-ksp_", "-pc_"};
  PetscBool left;

  PetscFunctionBeginUser;
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(others); i++)
    PetscCall(OptionsRefusePrefix(comm, others[i], nobody));
  PetscCall(SolverRefuse(comm, "st_", PETSC_STATIC_ARRAY_LENGTH(transformed), transformed, exact));
  PetscCall(PrefixIsLeft(PETSC_STATIC_ARRAY_LENGTH(factors), factors, &left));
  if (!left) PetscFunctionReturn(0);
  PetscCall(KspReadOptions(comm, "st_", KSPPREONLY, PCLU));
  PetscCall(KspReadOptions(comm, "st_pairs_", KSPGMRES, PCNONE));
  PetscFunctionReturn(0);
}

/* Of the names that nobody has read so far, those that an iterative solver would read: they are good options in the
   wrong place, and refused as such. */
PetscErrorCode SolverReadIterativeOptions(MPI_Comm comm)
{
  static const char why[] =
    "not used: it belongs to an iterative -st_ksp_type such as gmres, since a factorised matrix "
    "needs no iteration";
  static const char *const iterated[] = {"st_ksp_"};
  PetscBool                left, used;
  PetscInt                 n;
  char                   **names, **values, option[256];

  PetscFunctionBeginUser;
  PetscCall(PrefixIsLeft(1, iterated, &left));
  if (!left) PetscFunctionReturn(0);
  PetscCall(PetscOptionsHelpPrintedDestroy(&PetscOptionsHelpPrintedSingleton)); /* -help lists a prefix once */
  PetscCall(PetscOptionsLeftGet(NULL, &n, &names, &values));
  PetscCall(KspReadOptions(comm, "st_", KSPGMRES, PCNONE));
  for (PetscInt i = 0; i < n; i++) {
    PetscCall(PetscOptionsUsed(NULL, names[i], &used));
    PetscCall(PetscSNPrintf(option, sizeof(option), "-%s", names[i]));
    if (used) PetscCall(OptionsRefuse(comm, option, why));
  }
  PetscCall(PetscOptionsLeftRestore(NULL, &n, &names, &values));
  PetscFunctionReturn(0);
}
