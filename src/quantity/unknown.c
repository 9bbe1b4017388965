/*
   Unknown options.

   An option that nobody read is an error unless its prefix is one of PETSc's or SLEPc's. The valid names are those of
   the rows, and the ones of PETSc and SLEPc that base/options/libraries.c lists. Nearest = smallest Damerau-Levenshtein
   distance (adjacent swaps count once): F. J. Damerau, Comm. ACM 7, 1964; last words left out count as one edit, a
   prefix left out as one and a half, that of another name (-contact_mu of a page, where the scene calls its contact
   brake) as two and a half.
*/
#include "row.h"
#include "base/options/help.h"
#include <string.h>
#include <strings.h>

/* What to do without a box of some percent about the scene's own values */
#define SAMPLE_INSTEAD                                                                                                 \
  "give -analysis sample -sample_variables x -x_parameters NAME -x_distribution uniform -x_lower 0.9 -x_upper 1.1 "    \
  "-x_relative, for 10 % about the value of NAME"

/* Options that were, and what to do without them */
static const struct {
  const char *name, *instead;
} former[] = {
  {"symmetry", "leave it out for all modes of the whole mesh, or mesh one half and hold its plane by -supports"},
  {"loss_frequency", "give -model_loss_frequency"},
  {"statics_view", "give -static_view"},
  {"projector_rtol", "leave it out: the laws of contact in time hold to 1e-10"},
  {"dynamics_check_interval", "leave it out: tests check the laws from contact_pairs.csv and snapshots of every step"},
  {"sweep_uncertain", SAMPLE_INSTEAD},
  {"sweep_percent", SAMPLE_INSTEAD},
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

/* Last words of options under other names in the field, in capitals as in small letters */
static const struct {
  const char *word, *own;
} customary[] = {
  {"friction", "mu"},
  {"cof", "mu"},
  {"e", "young"},
  {"modulus", "young"},
  {"nu", "poisson"},
  {"rho", "density"},
  {"eta", "loss_factor"},
  {"damping", "loss_factor"},
  {"damping", "friction_damping"},
  {"stiffness", "kn"},
  {"stiffness_damping", "beta"},
  {"mass_damping", "alpha"},
  {"nev", "count"},
  {"number", "count"},
  {"frequencies", "band"},
  {"frequency_range", "band"},
  {"range", "band"},
  {"omega", "rotation"},
};

#define ONE_EDIT     2 /* distances are in halves of an edit */
#define OTHER_PREFIX 5
#define MAX_UNKNOWN  64 /* options that are looked at: of support: hub and hub_fix the first is the error */

/* Whether the last words of an unknown option mean those of a valid one, after the same prefix or after none */
static PetscBool NameMeans(const char unknown[], const char valid[])
{
  const size_t lu = strlen(unknown), lv = strlen(valid);

  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(customary); i++) {
    const size_t word = strlen(customary[i].word), own = strlen(customary[i].own);
    const size_t before = lu - word, prefix = lv - own;

    if (lu < word || lv <= own || strcasecmp(unknown + before, customary[i].word)) continue;
    if (strcmp(valid + prefix, customary[i].own) || valid[prefix - 1] != '_') continue;
    if (!before || (before == prefix && !strncmp(unknown, valid, prefix))) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

/* How far a valid name is from an unknown one: last words left out, as of -disc_loss_factor in
   -disc_loss, are one edit; a prefix left out, as of -contact_mu in -mu, is one and a half; another word of the field
   is none */
static int NameDistance(const char unknown[], const char valid[], PetscBool is_librarys)
{
  const size_t      lu = strlen(unknown), lv = strlen(valid);
  const char *const tail = strchr(unknown, '_'), *const other = strchr(valid, '_');
  const int distance = ONE_EDIT * EditDistance(unknown, valid);

  if (!is_librarys && NameMeans(unknown, valid)) return 0;
  if (lv > lu && valid[lv - lu - 1] == '_' && !strcmp(valid + lv - lu, unknown)) return ONE_EDIT + 1;
  if (lv > lu && valid[lu] == '_' && !strncmp(valid, unknown, lu)) return ONE_EDIT;
  return !is_librarys && tail && other && !strcmp(tail, other) ? PetscMin(distance, OTHER_PREFIX) : distance;
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
    u->is_librarys = u->is_librarys && !LibraryIsSolvers(names[i]) ? PETSC_TRUE : PETSC_FALSE;
    if (u->is_librarys && LibraryReadsLater(names[i])) continue;
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
  PetscCheck(strchr(u->name, '_') || strncmp(u->nearest, u->name, length) || u->nearest[length] != '_', comm,
             PETSC_ERR_USER_INPUT, "unknown option -%s; valid ones begin with -%s_, as -%s; -help lists them", u->name,
             u->name, u->nearest);
  PetscCall(UnknownFindList(u, sizeof(missing), missing));
  PetscCheck(u->distance > near, comm, PETSC_ERR_USER_INPUT, "unknown option -%s; the nearest valid one is -%s%s",
             u->name, u->nearest, missing);
  PetscCheck(!u->is_librarys, comm, PETSC_ERR_USER_INPUT, "-%s: nothing in squeal reads it; leave it out", u->name);
  SETERRQ(comm, PETSC_ERR_USER_INPUT, "unknown option -%s; -help lists the valid ones", u->name);
}

/* Compares the options of a table with all that are unknown */
static PetscErrorCode UnknownVisit(const QuantityTable *table, const char name[], void *owner, const char why[],
                                   void *ctx)
{
  UnknownOption *unknown = ctx;
  char           option[QUANTITY_HELP];

  PetscFunctionBeginUser;
  (void)owner;
  (void)why;
  for (PetscInt i = 0; i < table->n; i++) {
    if (table->row[i].kind == QUANTITY_PREFIX) continue;
    PetscCall(QuantityGetOption(name, &table->row[i], sizeof(option), option));
    for (UnknownOption *u = unknown; u->name[0]; u++) PetscCall(UnknownCompare(u, option + 1));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode QuantitiesCheckUnknown(MPI_Comm comm, QuantityShow show, void *ctx)
{
  UnknownOption *unknown, *best;
  PetscInt       n;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(MAX_UNKNOWN + 1, &unknown));
  PetscCall(UnknownTake(unknown, MAX_UNKNOWN, &n));
  if (n) PetscCall((*show)(ctx, &(QuantityVisitor){UnknownVisit, unknown}));
  best = unknown;
  for (UnknownOption *u = unknown; u->name[0]; u++) {
    for (size_t i = 0; LibraryName(i); i++) PetscCall(UnknownCompare(u, LibraryName(i)));
    if (FormerInstead(u->name)) u->distance = -1;
    if (u->distance < best->distance) best = u;
  }
  if (n) PetscCall(UnknownComplain(comm, best));
  PetscCall(PetscFree(unknown));
  PetscFunctionReturn(0);
}
