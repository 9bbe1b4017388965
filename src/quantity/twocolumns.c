/*
   Tables of two columns, and the table that a temperature makes of one: with T(t) and g(T), both straight between their
   rows, g(T(t)) is straight between the times of T and those at which T passes a temperature of g.
*/
#include "ramp.h"
#include "base/csv.h"

/* A table of x, y; begins: at x = 0 */
typedef struct {
  const char *column[2], *many; /* the values of x in words */
  PetscBool   begins;
  PetscInt    n, room;
  PetscReal  *x, *y;
} TwoColumns;

static PetscErrorCode TwoColumnsAdd(TwoColumns *table, PetscReal x, PetscReal y)
{
  PetscFunctionBeginUser;
  if (table->n == table->room) {
    table->room = PetscMax(64, 2 * table->room);
    PetscCall(PetscRealloc((size_t)table->room * sizeof(*table->x), &table->x));
    PetscCall(PetscRealloc((size_t)table->room * sizeof(*table->y), &table->y));
  }
  table->x[table->n]   = x;
  table->y[table->n++] = y;
  PetscFunctionReturn(0);
}

static PetscErrorCode TwoColumnsFree(TwoColumns *table)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(table->x));
  PetscCall(PetscFree(table->y));
  PetscFunctionReturn(0);
}

/* Rows of the file on one rank; a fault in csv where they are no table */
static PetscErrorCode TwoColumnsReadRows(Csv *csv, const char file[], TwoColumns *table)
{
  PetscFunctionBeginUser;
  CsvOpen(csv, file, 2, table->column, 2);
  while (CsvNext(csv)) {
    const PetscReal x = CsvReal(csv, 0, PETSC_FALSE), y = CsvReal(csv, 1, PETSC_FALSE);

    if (csv->fault[0]) break;
    if (table->n ? x <= table->x[table->n - 1] : table->begins && x != 0) {
      PetscCall(PetscSNPrintf(csv->fault, sizeof(csv->fault), "line %d: %s %.6g: %s must %s", (int)csv->line,
                              table->column[0], (double)x, table->many, table->n ? "rise" : "begin at 0"));
      break;
    }
    PetscCall(TwoColumnsAdd(table, x, y));
  }
  if (!csv->fault[0] && table->n < 2)
    PetscCall(PetscSNPrintf(csv->fault, sizeof(csv->fault), "it has %" PetscInt_FMT " rows: two %s are needed at least",
                            table->n, table->many));
  CsvClose(csv);
  PetscFunctionReturn(0);
}

/* The same on all ranks, of -<name>_<what> file */
static PetscErrorCode TwoColumnsRead(MPI_Comm comm, const char name[], const char what[], const char file[],
                                     TwoColumns *table)
{
  PetscMPIInt rank, count;
  Csv         csv = {.stream = NULL};

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  if (!rank) PetscCall(TwoColumnsReadRows(&csv, file, table));
  PetscCallMPI(MPI_Bcast(csv.fault, sizeof(csv.fault), MPI_CHAR, 0, comm));
  if (csv.fault[0]) PetscCall(TwoColumnsFree(table));
  PetscCheck(!csv.fault[0], comm, PETSC_ERR_USER_INPUT, "-%s_%s %s: %s", name, what, file, csv.fault);
  PetscCallMPI(MPI_Bcast(&table->n, 1, MPIU_INT, 0, comm));
  PetscCall(PetscMPIIntCast(table->n, &count));
  if (rank) PetscCall(PetscMalloc1(table->n, &table->x));
  if (rank) PetscCall(PetscMalloc1(table->n, &table->y));
  PetscCallMPI(MPI_Bcast(table->x, count, MPIU_REAL, 0, comm));
  PetscCallMPI(MPI_Bcast(table->y, count, MPIU_REAL, 0, comm));
  PetscFunctionReturn(0);
}

/* Gives the rows to the ramp, with the integral of the factor */
static PetscErrorCode TwoColumnsGive(const TwoColumns *table, Ramp *ramp)
{
  const PetscReal *time = table->x, *factor = table->y;

  PetscFunctionBeginUser;
  ramp->n      = table->n;
  ramp->time   = table->x;
  ramp->factor = table->y;
  PetscCall(PetscCalloc1(ramp->n, &ramp->area));
  for (PetscInt i = 1; i < ramp->n; i++)
    ramp->area[i] = ramp->area[i - 1] + 0.5 * (factor[i - 1] + factor[i]) * (time[i] - time[i - 1]);
  PetscFunctionReturn(0);
}

PetscErrorCode RampReadTable(MPI_Comm comm, const char name[], Ramp *ramp)
{
  TwoColumns table = {.column = {"time_s", "factor"}, .many = "times", .begins = PETSC_TRUE};

  PetscFunctionBeginUser;
  PetscCall(TwoColumnsRead(comm, name, "history", ramp->file, &table));
  PetscCall(TwoColumnsGive(&table, ramp));
  PetscFunctionReturn(0);
}

/* The row of a table at or before x, the last but one at most */
static PetscInt TwoColumnsFind(const TwoColumns *table, PetscReal x)
{
  PetscInt k = 0;

  while (k < table->n - 2 && x >= table->x[k + 1]) k++;
  return k;
}

static PetscReal TwoColumnsValue(const TwoColumns *table, PetscReal x)
{
  const PetscInt  k    = TwoColumnsFind(table, x);
  const PetscReal part = (x - table->x[k]) / (table->x[k + 1] - table->x[k]);

  return (1 - part) * table->y[k] + part * table->y[k + 1];
}

/* Adds to `made` the times at which T, straight from row i to the next, passes temperatures of g, in their order */
static PetscErrorCode TwoColumnsPass(const TwoColumns *T, PetscInt i, const TwoColumns *g, TwoColumns *made)
{
  const PetscReal from = T->y[i], to = T->y[i + 1], end = T->x[i + 1];
  const PetscBool down = to < from ? PETSC_TRUE : PETSC_FALSE;

  PetscFunctionBeginUser;
  for (PetscInt j = 0; j < g->n; j++) {
    const PetscInt  k    = down ? g->n - 1 - j : j;
    const PetscReal at   = g->x[k];
    const PetscBool away = at <= PetscMin(from, to) || at >= PetscMax(from, to) ? PETSC_TRUE : PETSC_FALSE;
    const PetscReal time = away ? end : T->x[i] + (at - from) / (to - from) * (end - T->x[i]);

    if (time > made->x[made->n - 1] && time < end) PetscCall(TwoColumnsAdd(made, time, g->y[k]));
  }
  PetscFunctionReturn(0);
}

/* Raises the error for temperatures that g has not, and for factors below zero */
static PetscErrorCode TwoColumnsCheck(MPI_Comm comm, const char name[], const TwoColumns *T, const TwoColumns *g)
{
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < g->n; k++)
    PetscCheck(g->y[k] >= 0, comm, PETSC_ERR_USER_INPUT,
               "-%s_mu_temperature: factor %.6g at temperature %.6g: friction would become negative", name,
               (double)g->y[k], (double)g->x[k]);
  for (PetscInt i = 0; i < T->n; i++)
    PetscCheck(T->y[i] >= g->x[0] && T->y[i] <= g->x[g->n - 1], comm, PETSC_ERR_USER_INPUT,
               "-%s_temperature_history: temperature %.6g at %.6g s: -%s_mu_temperature has those from %.6g to %.6g, "
               "and is not continued beyond",
               name, (double)T->y[i], (double)T->x[i], name, (double)g->x[0], (double)g->x[g->n - 1]);
  PetscFunctionReturn(0);
}

PetscErrorCode RampReadTemperature(MPI_Comm comm, const char name[], const char history[], const char factors[],
                                   Ramp *ramp)
{
  TwoColumns T    = {.column = {"time_s", "temperature"}, .many = "times", .begins = PETSC_TRUE};
  TwoColumns g    = {.column = {"temperature", "factor"}, .many = "temperatures"};
  TwoColumns made = {.n = 0};

  PetscFunctionBeginUser;
  PetscCall(TwoColumnsRead(comm, name, "temperature_history", history, &T));
  PetscCall(TwoColumnsRead(comm, name, "mu_temperature", factors, &g));
  PetscCall(TwoColumnsCheck(comm, name, &T, &g));
  PetscCall(TwoColumnsAdd(&made, T.x[0], TwoColumnsValue(&g, T.y[0])));
  for (PetscInt i = 0; i < T.n - 1; i++) {
    PetscCall(TwoColumnsPass(&T, i, &g, &made));
    PetscCall(TwoColumnsAdd(&made, T.x[i + 1], TwoColumnsValue(&g, T.y[i + 1])));
  }
  PetscCall(PetscStrncpy(ramp->file, history, sizeof(ramp->file)));
  ramp->warms = PETSC_TRUE;
  PetscCall(TwoColumnsGive(&made, ramp));
  PetscCall(TwoColumnsFree(&T));
  PetscCall(TwoColumnsFree(&g));
  PetscFunctionReturn(0);
}
