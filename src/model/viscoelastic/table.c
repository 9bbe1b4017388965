/*
   Tables of modulus and loss factor over frequency, from a file or lists, as rows with slopes: in x = log w, with
   secants d_k = (y_k+1 - y_k) / (x_k+1 - x_k), the slope between two of one sign is

      d_k-1 d_k / (r d_k + (1 - r) d_k-1),   r = (1 + h_k / (h_k-1 + h_k)) / 3,   h_k = x_k+1 - x_k,

   zero between two of different sign, and the secant itself at an end (Fritsch and Butland).
*/
#include "viscoelasticimpl.h"
#include "base/csv.h"

enum { COLUMN_FREQUENCY, COLUMN_MODULUS, COLUMN_LOSS, COLUMN_TEMPERATURE, N_TABLE_COLUMNS };
static const char *const columns[N_TABLE_COLUMNS] = {"frequency_hz", "modulus", "loss_factor", "temperature"};

#define TABLE_SAME 1e-9 /* relative: temperatures that are one */

/* Three numbers of each row, as they are read */
typedef struct {
  PetscInt   n;
  PetscReal *value; /* [n][3] Hz, Pa, - */
} TableValues;

static PetscErrorCode ValuesAdd(TableValues *t, const PetscReal value[3])
{
  PetscFunctionBeginUser;
  PetscCall(PetscRealloc((size_t)(3 * (t->n + 1)) * sizeof(*t->value), &t->value));
  PetscCall(PetscArraycpy(&t->value[3 * t->n++], value, 3));
  PetscFunctionReturn(0);
}

/* Rows of a file, those of the temperature that is asked for; on one rank */
static PetscErrorCode ValuesRead(const ViscoelasticAsked *asked, Csv *csv, TableValues *t)
{
  PetscFunctionBeginUser;
  CsvOpen(csv, asked->file, N_TABLE_COLUMNS, columns, COLUMN_TEMPERATURE);
  while (CsvNext(csv)) {
    const PetscReal value[3] = {CsvReal(csv, COLUMN_FREQUENCY, PETSC_FALSE), CsvReal(csv, COLUMN_MODULUS, PETSC_FALSE),
                                CsvReal(csv, COLUMN_LOSS, PETSC_FALSE)};
    const PetscBool has      = csv->at[COLUMN_TEMPERATURE] >= 0 ? PETSC_TRUE : PETSC_FALSE;
    const PetscReal degrees  = has ? CsvReal(csv, COLUMN_TEMPERATURE, PETSC_FALSE) : 0;
    const PetscReal apart    = PetscAbsReal(degrees - asked->temperature);

    if (asked->has_temperature && apart > TABLE_SAME * PetscAbsReal(asked->temperature)) continue;
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
  if (rank) PetscCall(PetscMalloc1(3 * t->n, &t->value));
  PetscCall(PetscMPIIntCast(3 * t->n, &count));
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
    PetscCall(ValuesAdd(t, (PetscReal[3]){asked->listed[0][i], asked->listed[1][i], asked->listed[2][i]}));
  PetscFunctionReturn(0);
}

/* Raises an error for rows that are no material, or do not rise */
static PetscErrorCode ValuesCheck(MPI_Comm comm, const char name[], const TableValues *t)
{
  PetscFunctionBeginUser;
  PetscCheck(t->n >= 2, comm, PETSC_ERR_USER_INPUT,
             "-%s_table has %" PetscInt_FMT " rows%s: two frequencies are needed at least", name, t->n,
             t->n ? "" : " of that temperature");
  for (PetscInt i = 0; i < t->n; i++) {
    const PetscReal *v = &t->value[3 * i];

    PetscCheck(v[0] > 0 && v[1] > 0 && v[2] >= 0, comm, PETSC_ERR_USER_INPUT,
               "-%s_table: at %.6g Hz the modulus is %.6g and the loss factor %.6g: frequency and modulus must be "
               "positive, the loss factor not negative",
               name, (double)v[0], (double)v[1], (double)v[2]);
    PetscCheck(
      !i || v[0] > v[-3], comm, PETSC_ERR_USER_INPUT,
      "-%s_table: %.6g Hz after %.6g Hz: frequencies must rise; give -%s_table_temperature where the table has "
      "several",
      name, (double)v[0], (double)v[-3], name);
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

PetscErrorCode ViscoelasticReadTable(MPI_Comm comm, const char name[], const ViscoelasticAsked *asked,
                                     Viscoelastic *law)
{
  TableValues      t = {.n = 0};
  ViscoelasticRow *row;

  PetscFunctionBeginUser;
  if (asked->has_file)
    PetscCall(ValuesReadFile(comm, name, asked, &t));
  else
    PetscCall(ValuesTakeLists(comm, name, asked, &t));
  PetscCall(ValuesCheck(comm, name, &t));
  PetscCall(PetscMalloc1(t.n, &row));
  for (PetscInt i = 0; i < t.n; i++) {
    const PetscReal *v = &t.value[3 * i];

    row[i] = (ViscoelasticRow){.x = PetscLogReal(2 * PETSC_PI * v[0]), .modulus = CMPLX(v[1], v[1] * v[2])};
  }
  for (PetscInt i = 0; i < t.n; i++) row[i].slope = RowSlope(row, t.n, i);
  PetscCall(PetscFree(t.value));
  law->kind   = VISCOELASTIC_TABLE;
  law->n_rows = t.n;
  law->row    = row;
  PetscFunctionReturn(0);
}
