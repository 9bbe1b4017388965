/*
   Tables of modulus and loss factor over frequency, from a file or lists, as rows with slopes: in x = log w, with
   secants d_k = (y_k+1 - y_k) / (x_k+1 - x_k), the slope between two of one sign is

      d_k-1 d_k / (r d_k + (1 - r) d_k-1),   r = (1 + h_k / (h_k-1 + h_k)) / 3,   h_k = x_k+1 - x_k,

   zero between two of different sign, and the secant itself at an end (Fritsch and Butland). Each temperature has a
   table of its own.
*/
#include "viscoelasticimpl.h"
#include "base/csv.h"

enum { COLUMN_FREQUENCY, COLUMN_MODULUS, COLUMN_LOSS, COLUMN_TEMPERATURE, N_TABLE_COLUMNS };
static const char *const columns[N_TABLE_COLUMNS] = {"frequency_hz", "modulus", "loss_factor", "temperature"};

/* Numbers of each row, as they are read */
typedef struct {
  PetscInt   n;
  PetscReal *value; /* [n][N_TABLE_COLUMNS] Hz, Pa, -, the temperature or 0 */
} TableValues;

static PetscErrorCode ValuesAdd(TableValues *t, const PetscReal value[N_TABLE_COLUMNS])
{
  PetscFunctionBeginUser;
  PetscCall(PetscRealloc((size_t)(N_TABLE_COLUMNS * (t->n + 1)) * sizeof(*t->value), &t->value));
  PetscCall(PetscArraycpy(&t->value[N_TABLE_COLUMNS * t->n++], value, N_TABLE_COLUMNS));
  PetscFunctionReturn(0);
}

/* Rows of a file; on one rank */
static PetscErrorCode ValuesRead(const ViscoelasticAsked *asked, Csv *csv, TableValues *t)
{
  PetscFunctionBeginUser;
  CsvOpen(csv, asked->file, N_TABLE_COLUMNS, columns, COLUMN_TEMPERATURE);
  while (CsvNext(csv)) {
    const PetscBool has = csv->at[COLUMN_TEMPERATURE] >= 0 && asked->has_temperature ? PETSC_TRUE : PETSC_FALSE;
    PetscReal       value[N_TABLE_COLUMNS] = {0};

    for (int k = 0; k < N_TABLE_COLUMNS; k++)
      if (k < COLUMN_TEMPERATURE || has) value[k] = CsvReal(csv, k, PETSC_FALSE);
    if (!csv->fault[0]) PetscCall(ValuesAdd(t, value));
  }
  if (!csv->fault[0] && asked->has_temperature && csv->at[COLUMN_TEMPERATURE] < 0)
    PetscCall(PetscSNPrintf(csv->fault, sizeof(csv->fault), "it has no column temperature"));
  CsvClose(csv);
  PetscFunctionReturn(0);
}

/* The same on all ranks */
static PetscErrorCode ValuesReadFile(MPI_Comm comm, const char name[], const ViscoelasticAsked *asked, TableValues *t)
{
  PetscMPIInt rank, count;
  Csv         csv = {.stream = NULL};

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  if (rank == 0) PetscCall(ValuesRead(asked, &csv, t));
  PetscCallMPI(MPI_Bcast(csv.fault, sizeof(csv.fault), MPI_CHAR, 0, comm));
  PetscCheck(!csv.fault[0], comm, PETSC_ERR_USER_INPUT, "-%s_table %s: %s", name, asked->file, csv.fault);
  PetscCallMPI(MPI_Bcast(&t->n, 1, MPIU_INT, 0, comm));
  if (rank) PetscCall(PetscMalloc1(N_TABLE_COLUMNS * t->n, &t->value));
  PetscCall(PetscMPIIntCast(N_TABLE_COLUMNS * t->n, &count));
  PetscCallMPI(MPI_Bcast(t->value, count, MPIU_REAL, 0, comm));
  PetscFunctionReturn(0);
}

/* The same of lists */
static PetscErrorCode ValuesTakeLists(MPI_Comm comm, const char name[], const ViscoelasticAsked *asked, TableValues *t)
{
  PetscFunctionBeginUser;
  for (int k = 0; k < N_TABLE_LISTS; k++)
    PetscCheck(asked->n_listed[k] == asked->n_listed[0], comm, PETSC_ERR_USER_INPUT,
               "-%s_table_frequency (Hz), -%s_table_modulus (Pa) and -%s_table_loss_factor make one table: they have "
               "%" PetscInt_FMT ", %" PetscInt_FMT " and %" PetscInt_FMT " values",
               name, name, name, asked->n_listed[0], asked->n_listed[1], asked->n_listed[2]);
  for (PetscInt i = 0; i < asked->n_listed[0]; i++)
    PetscCall(
      ValuesAdd(t, (PetscReal[N_TABLE_COLUMNS]){asked->listed[0][i], asked->listed[1][i], asked->listed[2][i]}));
  PetscFunctionReturn(0);
}

/* Raises an error for a row that is no material */
static PetscErrorCode ValuesCheck(MPI_Comm comm, const char name[], const TableValues *t)
{
  PetscFunctionBeginUser;
  PetscCheck(t->n >= 2, comm, PETSC_ERR_USER_INPUT,
             "-%s_table has %" PetscInt_FMT " rows: two frequencies are needed at least", name, t->n);
  for (PetscInt i = 0; i < t->n; i++) {
    const PetscReal *v = &t->value[N_TABLE_COLUMNS * i];

    PetscCheck(v[0] > 0 && v[1] > 0 && v[2] >= 0, comm, PETSC_ERR_USER_INPUT,
               "-%s_table: at %.6g Hz the modulus is %.6g and the loss factor %.6g: frequency and modulus must be "
               "positive, the loss factor not negative",
               name, (double)v[0], (double)v[1], (double)v[2]);
    PetscCheck(v[2] <= VISCOELASTIC_LOSS_MOST, comm, PETSC_ERR_USER_INPUT,
               "-%s_table: at %.6g Hz the loss factor is %.6g: it must be at most %d, no material has more", name,
               (double)v[0], (double)v[2], VISCOELASTIC_LOSS_MOST);
  }
  PetscFunctionReturn(0);
}

/* The slope between two secants of lengths h */
static PetscReal SlopeBetween(const PetscReal h[2], const PetscReal d[2])
{
  const PetscReal r = (1 + h[1] / (h[0] + h[1])) / 3;

  return d[0] * d[1] > 0 ? d[0] * d[1] / (r * d[1] + (1 - r) * d[0]) : 0;
}

/* The slope of row i */
static PetscComplex RowSlope(const ViscoelasticRow row[], PetscInt n, PetscInt i)
{
  PetscReal    h[2];
  PetscComplex d[2];

  for (int k = 0; k < 2; k++) {
    const PetscInt from = PetscMin(PetscMax(i - 1 + k, 0), n - 2);

    h[k] = row[from + 1].x - row[from].x;
    d[k] = (row[from + 1].modulus - row[from].modulus) / h[k];
  }
  if (i == 0 || i == n - 1) return d[0];
  return CMPLX(SlopeBetween(h, (PetscReal[2]){creal(d[0]), creal(d[1])}),
               SlopeBetween(h, (PetscReal[2]){cimag(d[0]), cimag(d[1])}));
}

/* The rows of a temperature, with their slopes, in the order of the file */
static PetscErrorCode TableMake(MPI_Comm comm, const char name[], const TableValues *t, ViscoelasticTable *table)
{
  PetscInt n = 0;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < t->n; i++) n += t->value[N_TABLE_COLUMNS * i + COLUMN_TEMPERATURE] == table->temperature;
  PetscCall(PetscMalloc1(n, &table->row));
  n = 0;
  for (PetscInt i = 0; i < t->n; i++) {
    const PetscReal *v = &t->value[N_TABLE_COLUMNS * i], x = PetscLogReal(2 * PETSC_PI * v[0]);

    if (v[COLUMN_TEMPERATURE] != table->temperature) continue;
    PetscCheck(
      !n || x > table->row[n - 1].x, comm, PETSC_ERR_USER_INPUT,
      "-%s_table: %.6g Hz after %.6g Hz: frequencies must rise; give -%s_table_temperature where the table has "
      "several",
      name, (double)v[0], (double)(PetscExpReal(table->row[n - 1].x) / (2 * PETSC_PI)), name);
    table->row[n++] = (ViscoelasticRow){.x = x, .modulus = CMPLX(v[1], v[1] * v[2])};
  }
  PetscCheck(n >= 2, comm, PETSC_ERR_USER_INPUT,
             "-%s_table has 1 row of the temperature %.6g: two frequencies are needed at least", name,
             (double)table->temperature);
  for (PetscInt i = 0; i < n; i++) table->row[i].slope = RowSlope(table->row, n, i);
  table->n_rows = n;
  PetscFunctionReturn(0);
}

/* A table of each temperature, ascending */
static PetscErrorCode TablesMake(MPI_Comm comm, const char name[], const TableValues *t, PetscInt *n_tables,
                                 ViscoelasticTable **tables)
{
  PetscReal *temperature;
  PetscInt   n = t->n;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n, &temperature));
  for (PetscInt i = 0; i < n; i++) temperature[i] = t->value[N_TABLE_COLUMNS * i + COLUMN_TEMPERATURE];
  PetscCall(PetscSortRemoveDupsReal(&n, temperature));
  PetscCall(PetscMalloc1(n, tables));
  for (PetscInt k = 0; k < n; k++) {
    (*tables)[k] = (ViscoelasticTable){.temperature = temperature[k]};
    PetscCall(TableMake(comm, name, t, &(*tables)[k]));
  }
  *n_tables = n;
  PetscCall(PetscFree(temperature));
  PetscFunctionReturn(0);
}

PetscErrorCode ViscoelasticReadTable(MPI_Comm comm, const char name[], const ViscoelasticAsked *asked,
                                     Viscoelastic *law)
{
  TableValues        t = {.n = 0};
  ViscoelasticTable *tables;
  PetscReal          limit[2];

  PetscFunctionBeginUser;
  if (asked->has_file)
    PetscCall(ValuesReadFile(comm, name, asked, &t));
  else
    PetscCall(ValuesTakeLists(comm, name, asked, &t));
  PetscCall(ValuesCheck(comm, name, &t));
  PetscCall(TablesMake(comm, name, &t, &law->n_tables, &tables));
  PetscCall(PetscFree(t.value));
  law->kind  = VISCOELASTIC_TABLE;
  law->table = tables;
  if (!asked->has_temperature) PetscFunctionReturn(0);
  law->n        = 1;
  law->value[0] = asked->temperature;
  ViscoelasticLimits(law, limit);
  PetscCheck(asked->temperature >= limit[0] && asked->temperature <= limit[1], comm, PETSC_ERR_USER_INPUT,
             "-%s_table_temperature %.6g: the table has temperatures from %.6g to %.6g, and is not continued beyond",
             name, (double)asked->temperature, (double)limit[0], (double)limit[1]);
  PetscFunctionReturn(0);
}
