/*
   Unknown options, and those that nobody reads.

   An option that nobody read is an error unless its prefix is one of PETSc's or SLEPc's. The valid names are exactly
   those that -help would print, so they are collected by reading all options once more (help.c); this happens only when
   there is something to complain about. Nearest = smallest Damerau-Levenshtein distance (adjacent swaps count once): F.
   J. Damerau, Comm. ACM 7, 1964; a prefix left out counts as one edit, that of another name (-contact_mu of a page,
   where the scene calls its contact brake) as two and a half.

   PETSc has read most of its own options before the run. What it reads later is listed below; anything else of its
   prefixes that is left then is never read: an error on the command line, while a file or an environment may be shared
   with other programs.
*/
#include "help.h"
#include <squeal/options.h>
#include <stdlib.h>
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

/* Others, for the nearest name: what it reads at its start, and types, which the help printer is not told of */
static const char *const read_first[] = {"bv_type",           "rg_type",
                                         "st_ksp_type",       "debug_terminal",
                                         "error_output_none", "error_output_stdout",
                                         "fp_trap",           "info",
                                         "info_exclude",      "log_sync",
                                         "log_trace",         "log_view_gpu_time",
                                         "log_view_memory",   "malloc_debug",
                                         "malloc_test",       "no_signal_handler",
                                         "on_error_abort",    "on_error_attach_debugger",
                                         "options_file",      "options_file_yaml",
                                         "options_monitor",   "start_in_debugger",
                                         "stop_for_debugger", "version"};

/* Options that were, and what to do without them */
static const struct {
  const char *name, *instead;
} former[] = {
  {"symmetry", "leave it out for all modes of the whole mesh, or mesh one half and hold its plane by -supports"},
  {"loss_frequency", "give -model_loss_frequency"},
  {"statics_view", "give -static_view"},
  {"projector_rtol", "leave it out: the laws of contact in time hold to 1e-10"},
  {"modes_groups", "leave it out: all ranks share each shift of -modes_shifts"},
};

/* What to do without an option that was; NULL for others */
static const char *FormerInstead(const char name[])
{
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(former); i++)
    if (!strcasecmp(name, former[i].name)) return former[i].instead;
  return NULL;
}

/* Number of edits (insert, delete, replace, swap neighbours) from a to b; both at most HELP_MAX_NAME - 1 long */
static int EditDistance(const char a[], const char b[])
{
  const int la = (int)strnlen(a, HELP_MAX_NAME - 1), lb = (int)strnlen(b, HELP_MAX_NAME - 1);
  int       d[3][HELP_MAX_NAME];

  for (int j = 0; j <= lb; j++) d[0][j] = j;
  for (int i = 1; i <= la; i++) {
    int *const now = d[i % 3], *const last = d[(i + 2) % 3], *const before = d[(i + 1) % 3];

    now[0] = i;
    for (int j = 1; j <= lb; j++) {
      const int differ = a[i - 1] != b[j - 1];

      now[j] = PetscMin(PetscMin(now[j - 1], last[j]) + 1, last[j - 1] + differ);
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) now[j] = PetscMin(now[j], before[j - 2] + 1);
    }
  }
  return d[la % 3][lb];
}

#define ONE_EDIT     2 /* distances are in halves of an edit */
#define OTHER_PREFIX 5
#define MAX_UNKNOWN  64 /* options that are looked at: of support: hub and hub_fix the first is the error */

/* How far a valid name is from an unknown one: a prefix left out, as of -contact_mu in -mu, is one edit */
static int NameDistance(const char unknown[], const char valid[], PetscBool is_librarys)
{
  const size_t      lu = strlen(unknown), lv = strlen(valid);
  const char *const tail = strchr(unknown, '_'), *const other = strchr(valid, '_');
  const int distance = ONE_EDIT * EditDistance(unknown, valid);

  if (lv > lu && valid[lv - lu - 1] == '_' && !strcmp(valid + lv - lu, unknown)) return ONE_EDIT;
  return !is_librarys && tail && other && !strcmp(tail, other) ? PetscMin(distance, OTHER_PREFIX) : distance;
}

/* Options of PETSc's and SLEPc's solvers: read when the rooms read theirs, or when SolverReadEigenOptions() and its
   like ask, but for those of viewers */
static PetscBool OptionIsSolvers(const char name[])
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

PetscBool UnknownIsLibrarysPrefix(const char name[])
{
  const size_t length = strlen(name);

  for (const char *const *p = library_prefixes; *p; p++)
    if (!strncasecmp(*p, name, length) && !strcmp(*p + length, "_")) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* Whether PETSc or SLEPc may still read one of their options */
static PetscBool OptionIsReadLater(const char name[])
{
  static const char *const viewed[] = {"eps_", "pep_", "st_", "ts_"};

  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(read_later); i++)
    if (!strcasecmp(name, read_later[i])) return PETSC_TRUE;
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(viewed); i++)
    if (!strncasecmp(name, viewed[i], strlen(viewed[i])) && strstr(name, "_view")) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* An option that nobody reads, and the valid name nearest to it */
typedef struct {
  char      name[HELP_MAX_NAME], nearest[HELP_MAX_NAME];
  PetscBool is_librarys;
  int       distance;
} UnknownOption;

/* Keeps a valid name where none was nearer; those of TS for implicit steps are not valid */
static PetscErrorCode UnknownCompare(UnknownOption *u, const char valid[])
{
  const int distance = NameDistance(u->name, valid, u->is_librarys);

  PetscFunctionBeginUser;
  if (distance >= u->distance || !strncmp(valid, "ksp_", 4) || !strncmp(valid, "pc_", 3)) PetscFunctionReturn(0);
  u->distance = distance;
  PetscCall(PetscStrncpy(u->nearest, valid, sizeof(u->nearest)));
  PetscFunctionReturn(0);
}

/* All unknown options, at most `most` of them */
static PetscErrorCode UnknownTake(UnknownOption list[], PetscInt most, PetscInt *n_unknown)
{
  PetscInt n;
  char   **names, **values;

  PetscFunctionBeginUser;
  *n_unknown = 0;
  PetscCall(PetscOptionsLeftGet(NULL, &n, &names, &values));
  for (PetscInt i = 0; i < n && *n_unknown < most; i++) {
    UnknownOption *u       = &list[*n_unknown];
    PetscBool      unknown = PETSC_TRUE;

    *u = (UnknownOption){.distance = PETSC_MAX_INT};
    PetscCall(OptionIsLibrarys(names[i], &u->is_librarys));
    u->is_librarys = u->is_librarys && !OptionIsSolvers(names[i]) ? PETSC_TRUE : PETSC_FALSE;
    if (u->is_librarys && OptionIsReadLater(names[i])) continue;
    if (u->is_librarys) PetscCall(OptionsCommandGives(names[i], &unknown));
    if (!unknown) continue;
    PetscCall(PetscStrncpy(u->name, names[i], sizeof(u->name)));
    ++*n_unknown;
  }
  PetscCall(PetscOptionsLeftRestore(NULL, &n, &names, &values));
  PetscFunctionReturn(0);
}

/* What may be missing where only the name before the tail differs, as of -pad_density and -disc_density: in which list
   the other is */
static PetscErrorCode UnknownFindList(const UnknownOption *u, size_t size, char text[])
{
  const size_t length = strlen(u->name), other = strlen(u->nearest);
  size_t       tail = 0;
  char         name[HELP_MAX_NAME], list[HELP_MAX_NAME];

  PetscFunctionBeginUser;
  text[0] = '\0';
  while (tail < PetscMin(length, other) && u->name[length - tail - 1] == u->nearest[other - tail - 1]) tail++;
  while (tail && u->nearest[other - tail] != '_') tail--;
  if (!tail || tail == length) PetscFunctionReturn(0);
  PetscCall(PetscStrncpy(name, u->nearest, other - tail + 1));
  PetscCall(OptionsFindList(name, sizeof(list), list));
  if (list[0]) PetscCall(PetscSNPrintf(text, size, ", for %.*s is not in %s", (int)(length - tail), u->name, list));
  PetscFunctionReturn(0);
}

/* Raises the error; the names of the libraries are near each other */
static PetscErrorCode UnknownComplain(MPI_Comm comm, const UnknownOption *u)
{
  char      missing[3 * HELP_MAX_NAME];
  const int length = (int)strlen(u->name), near = ONE_EDIT * (u->is_librarys ? 1 + length / 6 : 2 + length / 3);

  PetscFunctionBeginUser;
  PetscCheck(!FormerInstead(u->name), comm, PETSC_ERR_USER_INPUT, "-%s is no more: %s", u->name,
             FormerInstead(u->name));
  PetscCall(UnknownFindList(u, sizeof(missing), missing));
  PetscCheck(u->distance > near, comm, PETSC_ERR_USER_INPUT, "unknown option -%s; the nearest valid one is -%s%s",
             u->name, u->nearest, missing);
  PetscCheck(!u->is_librarys, comm, PETSC_ERR_USER_INPUT, "-%s: nothing in squeal reads it; leave it out", u->name);
  SETERRQ(comm, PETSC_ERR_USER_INPUT, "unknown option -%s; -help lists the valid ones", u->name);
}

PetscErrorCode OptionsCheckUnknown(MPI_Comm comm, PetscErrorCode (*read_again)(MPI_Comm, void *), void *ctx)
{
  UnknownOption *unknown;
  PetscInt       n, best = 0;
  HelpList       valid = {0};

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(MAX_UNKNOWN, &unknown));
  PetscCall(UnknownTake(unknown, MAX_UNKNOWN, &n));
  if (n) PetscCall(HelpCollect(comm, read_again, ctx, &valid));
  for (PetscInt k = 0; k < n; k++) {
    if (FormerInstead(unknown[k].name)) unknown[k].distance = -1;
    for (int i = 0; i < valid.n; i++) PetscCall(UnknownCompare(&unknown[k], valid.option[i].name));
    for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(read_later); i++)
      PetscCall(UnknownCompare(&unknown[k], read_later[i]));
    for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(read_first); i++)
      PetscCall(UnknownCompare(&unknown[k], read_first[i]));
    if (unknown[k].distance < unknown[best].distance) best = k;
  }
  free(valid.option);
  if (n) PetscCall(UnknownComplain(comm, &unknown[best]));
  PetscCall(PetscFree(unknown));
  PetscFunctionReturn(0);
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
