/* Tables of -NAME_table: distributions of variables, factors of columns of conditions */
#include "sampleimpl.h"
#include "base/csv.h"

#define TABLE_MOST 10000 /* lines */

/* Reads the points of a table on one rank; the fault is in csv */
static PetscErrorCode TableReadFile(const char file[], const char what[], Distribution *d, Csv *csv)
{
  const char *const columns[] = {"value", what};

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(TABLE_MOST, &d->value, TABLE_MOST, &d->probability));
  CsvOpen(csv, file, 2, columns, 2);
  while (CsvNext(csv)) {
    if (d->n == TABLE_MOST) {
      (void)snprintf(csv->fault, sizeof(csv->fault), "more than %d rows", TABLE_MOST);
      break;
    }
    d->value[d->n]       = CsvReal(csv, 0, PETSC_FALSE);
    d->probability[d->n] = CsvReal(csv, 1, PETSC_FALSE);
    d->n++;
  }
  CsvClose(csv);
  PetscFunctionReturn(0);
}

/* Its columns value and `what`, alike on all ranks */
PetscErrorCode SampleTableRead(MPI_Comm comm, const SampleVariable *v, const char what[], Distribution *d)
{
  PetscMPIInt rank;
  Csv         csv = {0};

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  if (!rank) PetscCall(TableReadFile(v->table, what, d, &csv));
  if (rank) PetscCall(PetscMalloc2(TABLE_MOST, &d->value, TABLE_MOST, &d->probability));
  PetscCallMPI(MPI_Bcast(csv.fault, sizeof(csv.fault), MPI_CHAR, 0, comm));
  PetscCheck(!csv.fault[0], comm, PETSC_ERR_USER_INPUT, "-%s_table %s: %s", v->name, v->table, csv.fault);
  PetscCallMPI(MPI_Bcast(&d->n, 1, MPIU_INT, 0, comm));
  PetscCallMPI(MPI_Bcast(d->value, (PetscMPIInt)d->n, MPIU_REAL, 0, comm));
  PetscCallMPI(MPI_Bcast(d->probability, (PetscMPIInt)d->n, MPIU_REAL, 0, comm));
  PetscCheck(d->n >= 2, comm, PETSC_ERR_USER_INPUT, "-%s_table %s: two rows are needed at least", v->name, v->table);
  PetscFunctionReturn(0);
}
