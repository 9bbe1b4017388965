/*
   Reads a file of conditions: its first line has the names of the columns, with units in brackets,

      condition,direction,pressure [bar],mu,temperature [degC]
      stop 1,forward,10,0.45,100

   Without a column `condition` (or `name`) rows have their numbers for names; without `direction` all go forward. One
   rank reads, as text; all others take its numbers.
*/
#include "conditions.h"
#include "base/csv.h"
#include <string.h>

#define TABLE_MOST_ROWS 100000
#define NAME_LENGTH     64

/* Units of columns, in those of the options */
typedef struct {
  const char *name, *si;
  PetscReal   factor;
} ColumnUnit;

static const ColumnUnit units[] = {{"Pa", "Pa", 1},
                                   {"kPa", "Pa", 1e3},
                                   {"MPa", "Pa", 1e6},
                                   {"GPa", "Pa", 1e9},
                                   {"bar", "Pa", 1e5},
                                   {"psi", "Pa", 6894.757293168361},
                                   {"N/m^3", "N/m^3", 1},
                                   {"N/m", "N/m", 1},
                                   {"N", "N", 1},
                                   {"kN", "N", 1e3},
                                   {"m", "m", 1},
                                   {"mm", "m", 1e-3},
                                   {"um", "m", 1e-6},
                                   {"s", "s", 1},
                                   {"min", "s", 60},
                                   {"h", "s", 3600},
                                   {"Hz", "Hz", 1},
                                   {"rad/s", "rad/s", 1},
                                   {"m/s", "m/s", 1},
                                   {"km/h", "m/s", 1 / 3.6},
                                   {"rpm", "rad/s", PETSC_PI / 30},
                                   {"1/min", "rad/s", PETSC_PI / 30},
                                   {"%", "1", 0.01},
                                   {"-", "1", 1},
                                   {"degC", "K", 1},
                                   {"K", "K", 1},
                                   {"kg/m^3", "kg/m^3", 1}};

/* What one rank reads: lengths are fixed, so that it can be sent as it is */
typedef struct {
  PetscInt n, n_columns, name_at, direction_at; /* columns of the file */
  char     head[CSV_MAX_COLUMNS][NAME_LENGTH];
  PetscInt unit[CSV_MAX_COLUMNS]; /* its place in the list, -1 for none */
  char     fault[256];
} ConditionHead;

/* Cuts "pressure [bar]" into its name, and finds its unit */
static void HeadCut(ConditionHead *h, PetscInt c, char name[])
{
  char *unit = strchr(name, '['), *end = unit ? strchr(unit, ']') : NULL;

  h->unit[c] = -1;
  if (!unit) return;
  if (end) *end = '\0';
  for (int k = 0; k < (int)PETSC_STATIC_ARRAY_LENGTH(units); k++)
    if (end && !strcmp(unit + 1, units[k].name)) h->unit[c] = k;
  *unit = '\0';
  for (size_t k = strlen(name); k && name[k - 1] == ' '; k--) name[k - 1] = '\0';
  if (h->unit[c] >= 0 || h->fault[0]) return;
  (void)snprintf(h->fault, sizeof(h->fault),
                 "column '%.40s' has no unit of these in its brackets: Pa, kPa, MPa, GPa, "
                 "bar, psi, N, kN, N/m, N/m^3, m, mm, um, s, min, h, Hz, rad/s, rpm, 1/min, "
                 "m/s, km/h, kg/m^3, %%, degC, K, -",
                 h->head[c]);
}

/* The first line; csv then has all columns of the file under their names [CSV_MAX_COLUMNS] */
static void HeadRead(Csv *csv, ConditionHead *h, char name[][NAME_LENGTH], const char *column[])
{
  csv->n = h->n_columns = csv->n_columns;
  h->name_at = h->direction_at = -1;
  if (h->n_columns >= CSV_MAX_COLUMNS)
    (void)snprintf(h->fault, sizeof(h->fault), "it has more than %d columns", CSV_MAX_COLUMNS - 1);
  for (PetscInt c = 0; c < h->n_columns; c++) {
    (void)snprintf(h->head[c], NAME_LENGTH, "%s", csv->word[c]);
    (void)snprintf(name[c], NAME_LENGTH, "%s", csv->word[c]);
    HeadCut(h, c, name[c]);
    if (!name[c][0] && !h->fault[0]) (void)snprintf(h->fault, sizeof(h->fault), "column %d has no name", (int)c + 1);
    for (PetscInt k = 0; k < c; k++)
      if (!strcmp(name[k], name[c]) && !h->fault[0])
        (void)snprintf(h->fault, sizeof(h->fault), "two of its columns have the name '%.40s'", name[c]);
    if (!strcmp(name[c], "condition") || !strcmp(name[c], "name")) h->name_at = c;
    if (!strcmp(name[c], "direction")) h->direction_at = c;
    column[c]  = name[c];
    csv->at[c] = (int)c;
  }
  csv->column = column;
}

/* 1 or -1 of "forward", "reverse" */
static PetscReal DirectionRead(Csv *csv, PetscInt c)
{
  const char *word = csv->word[c];

  if (!strcmp(word, "forward") || !strcmp(word, "1")) return 1;
  if (!strcmp(word, "reverse") || !strcmp(word, "-1")) return -1;
  if (!csv->fault[0])
    (void)snprintf(csv->fault, sizeof(csv->fault), "line %d: direction '%.40s' must be forward or reverse",
                   (int)csv->line, word);
  return 1;
}

/* Room for one more row */
static PetscErrorCode TableGrow(ConditionTable *t)
{
  PetscFunctionBeginUser;
  t->n++;
  PetscCall(PetscRealloc((size_t)(t->n * t->n_columns) * sizeof(PetscReal), &t->value));
  PetscCall(PetscRealloc((size_t)t->n * sizeof(PetscReal), &t->direction));
  PetscCall(PetscRealloc((size_t)t->n * sizeof(char *), &t->name));
  PetscFunctionReturn(0);
}

/* The rows on one rank */
static PetscErrorCode RowsRead(Csv *csv, const ConditionHead *h, ConditionTable *t)
{
  PetscFunctionBeginUser;
  while (CsvNext(csv)) {
    char number[16];

    if (t->n == TABLE_MOST_ROWS) {
      (void)snprintf(csv->fault, sizeof(csv->fault), "more than %d rows", TABLE_MOST_ROWS);
      break;
    }
    PetscCall(TableGrow(t));
    (void)snprintf(number, sizeof(number), "%d", (int)t->n);
    PetscCall(PetscStrallocpy(h->name_at < 0 ? number : csv->word[h->name_at], &t->name[t->n - 1]));
    t->direction[t->n - 1] = h->direction_at < 0 ? 1 : DirectionRead(csv, h->direction_at);
    for (PetscInt c = 0, k = 0; c < h->n_columns; c++)
      if (c != h->name_at && c != h->direction_at)
        t->value[(t->n - 1) * t->n_columns + k++] = CsvReal(csv, c, PETSC_FALSE);
  }
  if (!t->n && !csv->fault[0]) (void)snprintf(csv->fault, sizeof(csv->fault), "it has no rows");
  PetscFunctionReturn(0);
}

/* The columns that are numbers */
static PetscErrorCode ColumnsTake(const ConditionHead *h, ConditionTable *t)
{
  PetscFunctionBeginUser;
  PetscCall(
    PetscMalloc4(h->n_columns, &t->column, h->n_columns, &t->head, h->n_columns, &t->unit, h->n_columns, &t->si));
  for (PetscInt c = 0, k = 0; c < h->n_columns; c++) {
    char *end;

    if (c == h->name_at || c == h->direction_at) continue;
    t->unit[k] = h->unit[c] < 0 ? 1 : units[h->unit[c]].factor;
    t->si[k]   = h->unit[c] < 0 ? NULL : units[h->unit[c]].si;
    PetscCall(PetscStrallocpy(h->head[c], &t->head[k]));
    PetscCall(PetscStrallocpy(h->head[c], &t->column[k]));
    end = strchr(t->column[k], '[');
    if (end) *end = '\0';
    for (size_t m = strlen(t->column[k]); m && t->column[k][m - 1] == ' '; m--) t->column[k][m - 1] = '\0';
    k++;
  }
  PetscFunctionReturn(0);
}

/* Gives all ranks the rows of rank 0 */
static PetscErrorCode RowsShare(MPI_Comm comm, ConditionTable *t)
{
  PetscMPIInt rank, n;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  PetscCallMPI(MPI_Bcast(&t->n, 1, MPIU_INT, 0, comm));
  if (rank) PetscCall(PetscMalloc1(t->n * t->n_columns, &t->value));
  if (rank) PetscCall(PetscMalloc1(t->n, &t->direction));
  if (rank) PetscCall(PetscCalloc1(t->n, &t->name));
  PetscCall(PetscMPIIntCast(t->n * t->n_columns, &n));
  PetscCallMPI(MPI_Bcast(t->value, n, MPIU_REAL, 0, comm));
  PetscCallMPI(MPI_Bcast(t->direction, (PetscMPIInt)t->n, MPIU_REAL, 0, comm));
  for (PetscInt i = 0; i < t->n; i++) {
    PetscMPIInt length = rank ? 0 : (PetscMPIInt)strlen(t->name[i]) + 1;

    PetscCallMPI(MPI_Bcast(&length, 1, MPI_INT, 0, comm));
    if (rank) PetscCall(PetscMalloc1(length, &t->name[i]));
    PetscCallMPI(MPI_Bcast(t->name[i], length, MPI_CHAR, 0, comm));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode ConditionTableRead(MPI_Comm comm, const char file[], ConditionTable *t)
{
  ConditionHead h = {0};
  PetscMPIInt   rank;
  Csv           csv = {0};
  char          name[CSV_MAX_COLUMNS][NAME_LENGTH];
  const char   *column[CSV_MAX_COLUMNS];

  PetscFunctionBeginUser;
  *t = (ConditionTable){0};
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  if (!rank) CsvOpen(&csv, file, 0, NULL, 0);
  if (!rank && !csv.fault[0]) HeadRead(&csv, &h, name, column);
  t->n_columns = h.n_columns - (h.name_at >= 0) - (h.direction_at >= 0);
  if (!rank && !csv.fault[0] && !h.fault[0]) PetscCall(RowsRead(&csv, &h, t));
  if (!rank && csv.fault[0]) PetscCall(PetscStrncpy(h.fault, csv.fault, sizeof(h.fault)));
  if (!rank) CsvClose(&csv);
  PetscCallMPI(MPI_Bcast(&h, (PetscMPIInt)sizeof(h), MPI_BYTE, 0, comm));
  PetscCheck(!h.fault[0], comm, PETSC_ERR_USER_INPUT, "-sample_conditions %s: %s", file, h.fault);
  t->n_columns = h.n_columns - (h.name_at >= 0) - (h.direction_at >= 0);
  t->reverses  = h.direction_at >= 0 ? PETSC_TRUE : PETSC_FALSE;
  PetscCall(ColumnsTake(&h, t));
  PetscCall(RowsShare(comm, t));
  PetscFunctionReturn(0);
}

PetscErrorCode ConditionTableDestroy(ConditionTable *t)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < t->n && t->name; i++) PetscCall(PetscFree(t->name[i]));
  for (PetscInt c = 0; c < t->n_columns && t->column; c++) {
    PetscCall(PetscFree(t->column[c]));
    PetscCall(PetscFree(t->head[c]));
  }
  if (t->column) PetscCall(PetscFree4(t->column, t->head, t->unit, t->si));
  PetscCall(PetscFree(t->name));
  PetscCall(PetscFree(t->value));
  PetscCall(PetscFree(t->direction));
  PetscFunctionReturn(0);
}
