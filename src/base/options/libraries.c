/*
   Options of PETSc and SLEPc, which read them themselves: how their names begin, and which of them are read late.

   PETSc has read most of its own options before the run. What it reads later is listed below; anything else of its
   prefixes that is left then is never read: an error on the command line, while a file or an environment may be shared
   with other programs.
*/
#include "help.h"
#include <squeal/options.h>
#include <strings.h>

/* Prefixes of options that PETSc and SLEPc read themselves, some of them only at the end */
static const char *const library_prefixes[] = {
  "bv_",        "checkstack", "citations",   "debug",      "display",   "dm_",
  "draw",       "ds_",        "eps_",        "error_",     "fp_",       "get_total",
  "help",       "info",       "is_",         "ksp_",       "log_",      "malloc",
  "mat_",       "matptap",    "memory",      "mpi",        "no_signal", "objects",
  "on_error",   "options_",   "partitioner", "pc_",        "pep_",      "petscpartitioner",
  "petscspace", "python",     "rg_",         "saws",       "sf_",       "shared_tmp",
  "slepc",      "st_",        "start_in",    "stop_for",   "sub_",      "tmp",
  "ts_",        "use_gpu",    "vec_",        "vecscatter", "version",   "viewer",
  "x_virtual",  NULL};

/* Options that PETSc reads in the run or at its end, but for views of the solvers */
static const char *const read_later[] = {"citations",
                                         "dm_ds_jet_degree",
                                         "dm_plex_celltypes_view",
                                         "dm_plex_interpolate_orient_interfaces",
                                         "draw_pause",
                                         "get_total_flops",
                                         "is_view",
                                         "log_all",
                                         "log_exclude",
                                         "log_view",
                                         "malloc_dump",
                                         "malloc_view",
                                         "mat_freeintermediatedatastructures",
                                         "mat_inode_limit",
                                         "mat_no_inode",
                                         "mat_no_unroll",
                                         "mat_product_clear",
                                         "mat_view",
                                         "mat_view_ordering",
                                         "memory_view",
                                         "mpidump",
                                         "objects_dump",
                                         "options_left",
                                         "options_view",
                                         "sf_rank_order",
                                         "sf_type",
                                         "vec_view",
                                         "vec_view_stash",
                                         "vecscatter_merge",
                                         "vecstash_initial_size"};

/* Others, for the nearest name: what is read at the start, and by solvers that take it */
static const char *const read_first[] = {"eps_max_it",
                                         "eps_monitor",
                                         "eps_mpd",
                                         "eps_ncv",
                                         "eps_tol",
                                         "pep_max_it",
                                         "pep_monitor",
                                         "pep_mpd",
                                         "pep_ncv",
                                         "pep_tol",
                                         "st_ksp_max_it",
                                         "st_ksp_rtol",
                                         "st_mat_mumps_icntl_14",
                                         "st_mat_mumps_icntl_22",
                                         "st_mat_mumps_icntl_35",
                                         "st_mat_mumps_icntl_7",
                                         "st_mat_mumps_cntl_1",
                                         "st_pc_factor_mat_ordering_type",
                                         "st_pc_type",
                                         "ts_dt",
                                         "ts_max_steps",
                                         "ts_max_time",
                                         "ts_monitor",
                                         "ts_view",
                                         "bv_type",
                                         "rg_type",
                                         "st_ksp_type",
                                         "debug_terminal",
                                         "error_output_none",
                                         "error_output_stdout",
                                         "fp_trap",
                                         "info",
                                         "info_exclude",
                                         "log_sync",
                                         "log_trace",
                                         "log_view_gpu_time",
                                         "log_view_memory",
                                         "malloc_debug",
                                         "malloc_test",
                                         "no_signal_handler",
                                         "on_error_abort",
                                         "on_error_attach_debugger",
                                         "options_file",
                                         "options_file_yaml",
                                         "options_monitor",
                                         "start_in_debugger",
                                         "stop_for_debugger",
                                         "version"};

/* Options of PETSc's and SLEPc's solvers: read when the rooms read theirs, or when SolverReadEigenOptions() and its
   like ask, but for those of viewers */
PetscBool LibraryIsSolvers(const char name[])
{
  static const char *const prefixes[] = {"eps_", "pep_", "st_", "ts_", "bv_", "ds_", "rg_"};

  if (strstr(name, "_view")) return PETSC_FALSE;
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(prefixes); i++)
    if (!strncasecmp(name, prefixes[i], strlen(prefixes[i]))) return PETSC_TRUE;
  return PETSC_FALSE;
}

PetscErrorCode OptionIsLibrarys(const char name[], PetscBool *is_librarys)
{
  PetscFunctionBeginUser;
  *is_librarys = PETSC_FALSE;
  for (const char *const *prefix = library_prefixes; *prefix; prefix++)
    if (!strncasecmp(name, *prefix, strlen(*prefix))) *is_librarys = PETSC_TRUE;
  PetscFunctionReturn(0);
}

PetscBool LibraryHasPrefix(const char name[])
{
  const size_t length = strlen(name);

  for (const char *const *p = library_prefixes; *p; p++)
    if (!strncasecmp(*p, name, length) && !strcmp(*p + length, "_")) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* Whether PETSc or SLEPc may still read one of their options */
PetscBool LibraryReadsLater(const char name[])
{
  static const char *const viewed[] = {"eps_", "pep_", "st_", "ts_"};

  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(read_later); i++)
    if (!strcasecmp(name, read_later[i])) return PETSC_TRUE;
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(viewed); i++)
    if (!strncasecmp(name, viewed[i], strlen(viewed[i])) && strstr(name, "_view")) return PETSC_TRUE;
  return PETSC_FALSE;
}

const char *LibraryName(size_t i)
{
  const size_t n_later = PETSC_STATIC_ARRAY_LENGTH(read_later), n_first = PETSC_STATIC_ARRAY_LENGTH(read_first);

  if (i < n_later) return read_later[i];
  return i < n_later + n_first ? read_first[i - n_later] : NULL;
}

/* Whether PETSc reads this option only at its end */
static PetscBool OptionIsLate(const char name[])
{
  static const char *const late[] = {"log_",         "malloc",       "memory",    "objects_dump",
                                     "options_left", "options_view", "citations", "options_table",
                                     "get_total",    "version",      NULL};

  for (const char *const *prefix = late; *prefix; prefix++)
    if (!strncmp(name, *prefix, strlen(*prefix))) return PETSC_TRUE;
  return PETSC_FALSE;
}

PetscErrorCode OptionsWarnUnused(MPI_Comm comm)
{
  PetscInt    n;
  char      **names, **values, option[HELP_MAX_NAME];
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  PetscCall(PetscOptionsLeftGet(NULL, &n, &names, &values));
  for (PetscInt i = 0; i < n; i++) {
    if (OptionIsLate(names[i])) continue;
    PetscCall(PetscSNPrintf(option, sizeof(option), "-%s", names[i]));
    PetscCall(OptionsRefuse(comm, option, "nothing in this run has read it; what was written is without it"));
    if (rank) continue;
    PetscCall(PetscFPrintf(PETSC_COMM_SELF, stderr, "squeal: warning: option %s was not used\n", option));
  }
  PetscCall(PetscOptionsLeftRestore(NULL, &n, &names, &values));
  PetscFunctionReturn(0);
}
