/*
   Lists of names, values that are no numbers, and unknown options.

   An option that nobody read is an error unless its prefix is one of PETSc's or SLEPc's. The valid names are exactly
   those that -help would print, so they are collected by reading all options once more (help.c); this happens only when
   there is something to complain about. Nearest = smallest Damerau-Levenshtein
   distance (adjacent swaps count once): F. J. Damerau, Comm. ACM 7, 1964; a prefix left out counts as one edit.
*/
#include "help.h"
#include <squeal/options.h>
#include <ctype.h>
#include <stdlib.h>
#include <strings.h>

#define MAX_NAME    HELP_MAX_NAME
#define MAX_RECORDS 64   /* names in one list of the scene */
#define MAX_LIST    4096 /* characters of a list of names */

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

/* Whether a name can be a prefix: a letter, then letters, digits and underscores */
static PetscBool NameIsIdentifier(const char name[])
{
  if (!isalpha((unsigned char)name[0])) return PETSC_FALSE;
  for (const char *c = name; *c; c++)
    if (!isalnum((unsigned char)*c) && *c != '_') return PETSC_FALSE;
  return PETSC_TRUE;
}

/* Whether a comma separated list holds the value */
static PetscBool ListHolds(const char list[], const char value[])
{
  const size_t length = strlen(value);

  for (const char *c = list; c; c = strchr(c, ',') ? strchr(c, ',') + 1 : NULL)
    if (!strncmp(c, value, length) && (c[length] == ',' || !c[length])) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* Raises an error for a name that the program's own options begin with, or that another list of the scene has too */
static PetscErrorCode NameCheckFree(MPI_Comm comm, const char option[], const char name[])
{
  static const char *const own[]   = {"dynamics", "model",  "modes",  "operators", "output", "projector",
                                      "rig",      "squeal", "static", "statics",   "sweep"};
  static const char *const lists[] = {"-parts",    "-supports", "-springs", "-dashpots", "-loads",
                                      "-contacts", "-probes",   "-motions", "-impulses"};
  const size_t             length  = strlen(name);
  char                     list[MAX_LIST];
  PetscBool                taken = PETSC_FALSE, set;

  PetscFunctionBeginUser;
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(own) && !taken; i++)
    PetscCall(PetscStrcasecmp(name, own[i], &taken));
  for (const char *const *p = library_prefixes; *p && !taken; p++)
    taken = !strncasecmp(*p, name, length) && !strcmp(*p + length, "_") ? PETSC_TRUE : PETSC_FALSE;
  PetscCheck(!taken, comm, PETSC_ERR_USER_INPUT, "%s '%s' is no name: other options begin with -%s_; choose another",
             option, name, name);
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(lists); i++) {
    PetscCall(PetscOptionsGetString(NULL, NULL, lists[i], list, sizeof(list), &set));
    PetscCheck(!set || !strcmp(lists[i], option) || !ListHolds(list, name), comm, PETSC_ERR_USER_INPUT,
               "%s and %s both name '%s', whose options begin with -%s_: choose another name in one of them", lists[i],
               option, name, name);
  }
  PetscFunctionReturn(0);
}

PetscErrorCode OptionsGetNames(MPI_Comm comm, const char option[], const char help[], PetscInt max, PetscInt *n,
                               char *names[])
{
  PetscBool same;
  PetscInt  count = max;

  PetscFunctionBeginUser;
  PetscCall(OptionsGetWords(comm, option, help, &count, names));
  for (PetscInt i = 0; i < count; i++) {
    PetscCheck(NameIsIdentifier(names[i]), comm, PETSC_ERR_USER_INPUT,
               "%s '%s' is no name: use letters, digits and underscores, a letter first", option, names[i]);
    for (PetscInt j = 0; j < i; j++) {
      PetscCall(PetscStrcasecmp(names[i], names[j], &same));
      PetscCheck(!same, comm, PETSC_ERR_USER_INPUT, "%s names '%s' twice", option, names[i]);
    }
    PetscCall(NameCheckFree(comm, option, names[i]));
  }
  *n = count;
  PetscFunctionReturn(0);
}

PetscErrorCode OptionsReadList(MPI_Comm comm, const OptionsList *list, void *owner, PetscInt *n, void *records)
{
  char *names[MAX_RECORDS], *record, prefix[MAX_NAME], title[MAX_NAME];

  PetscFunctionBeginUser;
  PetscCall(OptionsGetNames(comm, list->option, list->help, MAX_RECORDS, n, names));
  PetscCall(PetscCalloc((size_t)*n * list->size, &record));
  *(void **)records = record;
  for (PetscInt i = 0; i < *n; i++) *(char **)(void *)(record + (size_t)i * list->size) = names[i];
  for (PetscInt i = 0; i < *n; i++, record += list->size) {
    PetscCall(PetscSNPrintf(prefix, sizeof(prefix), "%s_", names[i]));
    PetscCall(PetscSNPrintf(title, sizeof(title), "%s %s", list->title, names[i]));
    PetscOptionsBegin(comm, prefix, title, NULL);
    PetscCall(list->read(PetscOptionsObject, owner, record));
    PetscOptionsEnd();
  }
  PetscFunctionReturn(0);
}

/* Splits a message such as "Input string abc has no numeric value" into the value and what is wrong with it. PETSc 3.22
   refuses what is not finite as "Newly set value nan less than allowed bound ..." */
static PetscBool MessageSplit(const char message[], char value[MAX_NAME], const char **wrong)
{
  static const struct {
    const char *start, *end, *wrong; /* wrong NULL: the end says it */
  } forms[] = {
    {"Input string ",           " has no ",  NULL                        },
    {"Newly set value ",        " less ",    " must be a finite number"  },
    {"Newly set value ",        " greater ", " must be a finite number"  },
    {"Unknown logical value: ", NULL,        " is neither true nor false"},
  };

  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(forms); i++) {
    const char *end = forms[i].end ? strstr(message, forms[i].end) : NULL;

    if (strncmp(message, forms[i].start, strlen(forms[i].start)) || (forms[i].end && !end)) continue;
    message += strlen(forms[i].start);
    *wrong = forms[i].wrong ? forms[i].wrong : end;
    return snprintf(value, MAX_NAME, "%.*s", (int)(end ? end - message : (ptrdiff_t)strlen(message)), message) <
           MAX_NAME;
  }
  return PETSC_FALSE;
}

PetscErrorCode OptionsExplainValue(const char message[], char text[], size_t size)
{
  char        value[MAX_NAME], *all, *word, *rest, *name = NULL;
  const char *wrong;

  PetscFunctionBeginUser;
  text[0] = '\0';
  if (!MessageSplit(message, value, &wrong)) PetscFunctionReturn(0);
  PetscCall(PetscOptionsGetAll(NULL, &all));
  for (word = strtok_r(all, " ", &rest); word; word = strtok_r(NULL, " ", &rest)) {
    if (word[0] == '-' && isalpha((unsigned char)word[1]))
      name = word;
    else if (name && ListHolds(word, value)) {
      PetscCall(PetscStrlcat(text, text[0] ? " or " : "", size));
      PetscCall(PetscStrlcat(text, name, size));
    }
  }
  PetscCall(PetscFree(all));
  if (!text[0]) PetscFunctionReturn(0);
  PetscCall(PetscStrlcat(text, ": ", size));
  PetscCall(PetscStrlcat(text, value, size));
  PetscCall(PetscStrlcat(text, wrong, size));
  PetscFunctionReturn(0);
}

/* Number of edits (insert, delete, replace, swap neighbours) from a to b; both at most MAX_NAME - 1 long */
static int EditDistance(const char a[], const char b[])
{
  const int la = (int)strnlen(a, MAX_NAME - 1), lb = (int)strnlen(b, MAX_NAME - 1);
  int       d[3][MAX_NAME];

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

/* How far a valid name is from an unknown one: a prefix left out, as of -contact_mu in -mu, is one edit */
static int NameDistance(const char unknown[], const char valid[])
{
  const size_t lu = strlen(unknown), lv = strlen(valid);

  if (lv > lu && valid[lv - lu - 1] == '_' && !strcmp(valid + lv - lu, unknown)) return 1;
  return EditDistance(unknown, valid);
}

/* Options of PETSc's and SLEPc's solvers: read when the rooms read theirs, or when SolverReadOptions() asks, but for
   those of MUMPS and of viewers */
static PetscBool OptionIsSolvers(const char name[])
{
  static const char *const prefixes[] = {"eps_", "pep_", "st_", "ts_"};

  if (strstr(name, "mat_mumps_icntl_") || strstr(name, "mat_mumps_cntl_") || strstr(name, "_view")) return PETSC_FALSE;
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

/* Raises the error for one unknown option */
static PetscErrorCode ComplainUnknown(MPI_Comm comm, const char name[], const char nearest[])
{
  PetscFunctionBeginUser;
  PetscCheck(!nearest, comm, PETSC_ERR_USER_INPUT, "unknown option -%s; the nearest valid one is -%s", name, nearest);
  SETERRQ(comm, PETSC_ERR_USER_INPUT, "unknown option -%s; -help lists the valid ones", name);
}

PetscErrorCode OptionsCheckUnknown(MPI_Comm comm, PetscErrorCode (*read_again)(MPI_Comm, void *), void *ctx)
{
  PetscInt  n, best = PETSC_MAX_INT;
  char    **names, **values, unknown[MAX_NAME] = "", nearest[MAX_NAME] = "";
  HelpList  valid = {0};
  PetscBool is_librarys;

  PetscFunctionBeginUser;
  PetscCall(PetscOptionsLeftGet(NULL, &n, &names, &values));
  for (PetscInt i = 0; i < n && !unknown[0]; i++) {
    PetscCall(OptionIsLibrarys(names[i], &is_librarys));
    if (!is_librarys || OptionIsSolvers(names[i])) PetscCall(PetscStrncpy(unknown, names[i], sizeof(unknown)));
  }
  PetscCall(PetscOptionsLeftRestore(NULL, &n, &names, &values));
  if (!unknown[0]) PetscFunctionReturn(0);

  PetscCall(HelpCollect(comm, read_again, ctx, &valid));
  for (int i = 0; i < valid.n; i++) {
    const int distance = NameDistance(unknown, valid.option[i].name);

    if (distance >= best) continue;
    best = distance;
    PetscCall(PetscStrncpy(nearest, valid.option[i].name, sizeof(nearest)));
  }
  free(valid.option);
  PetscCall(ComplainUnknown(comm, unknown, best <= 2 + (PetscInt)strlen(unknown) / 3 ? nearest : NULL));
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
  char      **names, **values, option[MAX_NAME];
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
