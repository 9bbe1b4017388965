/*
   The table of a friction law from its file: columns speed (m/s), pressure (Pa) and mu, a line for each pressure at
   each speed, in any order. Read on one rank, checked, and given to all.
*/
#include "law.h"
#include "base/csv.h"
#include <math.h>
#include <string.h>

#define TABLE_ROOM 20000 /* lines */

static const char *const columns[] = {"speed", "pressure", "mu"};

/* The lines as they are read, [3] each, and what is wrong */
typedef struct {
  PetscInt  n, n_speeds, n_pressures;
  PetscReal line[TABLE_ROOM][3];
  char      fault[256];
} MuLines;

/* All lines, on the rank that calls */
static void LinesRead(const char file[], MuLines *lines)
{
  Csv csv = {.stream = NULL};

  CsvOpen(&csv, file, 3, columns, 3);
  while (CsvNext(&csv)) {
    if (lines->n == TABLE_ROOM) (void)snprintf(csv.fault, sizeof(csv.fault), "it has more than %d lines", TABLE_ROOM);
    for (PetscInt i = 0; i < 3 && !csv.fault[0]; i++) {
      const double x = CsvReal(&csv, i, PETSC_FALSE);

      if (!csv.fault[0] && x < 0)
        (void)snprintf(csv.fault, sizeof(csv.fault), "line %d: %s %.6g must not be negative", (int)csv.line, columns[i],
                       x);
      if (!csv.fault[0]) lines->line[lines->n][i] = x;
    }
    if (!csv.fault[0]) lines->n++;
  }
  memcpy(lines->fault, csv.fault, sizeof(lines->fault));
  CsvClose(&csv);
}

/* The different numbers of column c, ascending, into `at` */
static PetscErrorCode LinesSort(const MuLines *lines, int c, PetscInt *n, PetscReal at[])
{
  PetscFunctionBeginUser;
  *n = lines->n;
  for (PetscInt i = 0; i < lines->n; i++) at[i] = lines->line[i][c];
  PetscCall(PetscSortRemoveDupsReal(n, at));
  PetscFunctionReturn(0);
}

static PetscInt PlaceOf(PetscInt n, const PetscReal at[], PetscReal x)
{
  PetscInt i = 0;

  while (i < n - 1 && at[i] < x) i++;
  return i;
}

/* speeds, pressures and mu into values; a fault where the lines are no grid that begins at 0 */
static void LinesTake(MuLines *lines, PetscReal values[])
{
  const PetscInt n = lines->n_speeds, m = lines->n_pressures;
  PetscReal     *speed = values, *pressure = speed + n, *mu = pressure + m;

  if (n < 2 || m < 2 || speed[0] != 0 || pressure[0] != 0) {
    (void)snprintf(
      lines->fault, sizeof(lines->fault),
      "it must have two speeds and two pressures at least, each from 0 on; it has %d from %.6g and %d from "
      "%.6g",
      (int)n, n ? (double)speed[0] : 0, (int)m, m ? (double)pressure[0] : 0);
    return;
  }
  for (PetscInt i = 0; i < n * m; i++) mu[i] = -1;
  for (PetscInt k = 0; k < lines->n && !lines->fault[0]; k++) {
    const PetscReal *l  = lines->line[k];
    PetscReal       *at = &mu[m * PlaceOf(n, speed, l[0]) + PlaceOf(m, pressure, l[1])];

    if (*at >= 0)
      (void)snprintf(lines->fault, sizeof(lines->fault), "speed %.6g, pressure %.6g is there twice", (double)l[0],
                     (double)l[1]);
    *at = l[2];
  }
  for (PetscInt i = 0; i < n * m && !lines->fault[0]; i++)
    if (mu[i] < 0)
      (void)snprintf(lines->fault, sizeof(lines->fault),
                     "it has no mu at speed %.6g, pressure %.6g: give each pressure at each speed",
                     (double)speed[i / m], (double)pressure[i % m]);
}

/* On rank 0: numbers of a block with speeds, pressures and mu */
static PetscErrorCode LinesBlock(const char file[], MuLines *lines, PetscReal **values)
{
  PetscReal *speed, *pressure;

  PetscFunctionBeginUser;
  LinesRead(file, lines);
  PetscCall(PetscMalloc2(lines->n, &speed, lines->n, &pressure));
  PetscCall(LinesSort(lines, 0, &lines->n_speeds, speed));
  PetscCall(LinesSort(lines, 1, &lines->n_pressures, pressure));
  if (!lines->fault[0] && lines->n_speeds * lines->n_pressures > TABLE_ROOM)
    (void)snprintf(lines->fault, sizeof(lines->fault), "its %d speeds and %d pressures are no grid",
                   (int)lines->n_speeds, (int)lines->n_pressures);
  if (!lines->fault[0]) {
    PetscCall(PetscMalloc1(lines->n_speeds + lines->n_pressures + lines->n_speeds * lines->n_pressures, values));
    PetscCall(PetscArraycpy(*values, speed, lines->n_speeds));
    PetscCall(PetscArraycpy(*values + lines->n_speeds, pressure, lines->n_pressures));
    LinesTake(lines, *values);
  }
  PetscCall(PetscFree2(speed, pressure));
  PetscFunctionReturn(0);
}

PetscErrorCode FrictionReadTable(MPI_Comm comm, const char name[], const char file[], FrictionLaw *law)
{
  MuLines    *lines;
  PetscReal  *values = NULL;
  PetscInt    n;
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  PetscCheck(file[0], comm, PETSC_ERR_USER_INPUT,
             "-%s_friction_law table needs -%s_mu_file, with the columns speed,pressure,mu", name, name);
  PetscCall(PetscNew(&lines));
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  if (rank == 0) PetscCall(LinesBlock(file, lines, &values));
  PetscCallMPI(MPI_Bcast(lines, (PetscMPIInt)sizeof(*lines), MPI_BYTE, 0, comm));
  PetscCheck(!lines->fault[0], comm, PETSC_ERR_FILE_UNEXPECTED, "cannot read '%s' of -%s_mu_file: %s", file, name,
             lines->fault);
  n = lines->n_speeds + lines->n_pressures + lines->n_speeds * lines->n_pressures;
  if (!values) PetscCall(PetscMalloc1(n, &values));
  PetscCallMPI(MPI_Bcast(values, (PetscMPIInt)n, MPIU_REAL, 0, comm));
  law->table = (FrictionTable){lines->n_speeds, lines->n_pressures, values, values + lines->n_speeds,
                               values + lines->n_speeds + lines->n_pressures};
  PetscCall(PetscFree(lines));
  PetscFunctionReturn(0);
}
