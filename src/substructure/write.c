/* Files of a superelement: the table of its unknowns, its modes with their errors, and its matrices */
#include "files/text.h"
#include <string.h>

/* Numbers as PETSc's binary files have them, the highest byte first */
static PetscErrorCode BytesTurn(void *values, PetscDataType type, PetscInt n)
{
  PetscFunctionBeginUser;
#if !defined(PETSC_WORDS_BIGENDIAN)
  PetscCall(PetscByteSwap(values, type, n));
#endif
  (void)values;
  (void)type;
  (void)n;
  PetscFunctionReturn(0);
}

/* A matrix of rank 0 as MatView() writes it: 4 numbers, lengths of the rows, columns, values */
static PetscErrorCode MatrixPack(Mat A, PetscInt *n_ints, PetscInt **ints, PetscInt *n_values, PetscScalar **values)
{
  PetscInt n, at = 0;

  PetscFunctionBeginUser;
  PetscCall(MatGetSize(A, &n, NULL));
  *n_values = 0;
  for (PetscInt i = 0; i < n; i++) {
    PetscInt length;

    PetscCall(MatGetRow(A, i, &length, NULL, NULL));
    *n_values += length;
    PetscCall(MatRestoreRow(A, i, &length, NULL, NULL));
  }
  *n_ints = 4 + n + *n_values;
  PetscCall(PetscMalloc1(*n_ints, ints));
  PetscCall(PetscMalloc1(*n_values, values));
  PetscCall(PetscArraycpy(*ints, ((PetscInt[]){MAT_FILE_CLASSID, n, n, *n_values}), 4));
  for (PetscInt i = 0; i < n; i++) {
    const PetscInt    *column;
    const PetscScalar *value;
    PetscInt           length;

    PetscCall(MatGetRow(A, i, &length, &column, &value));
    (*ints)[4 + i] = length;
    PetscCall(PetscArraycpy(&(*ints)[4 + n + at], column, length));
    PetscCall(PetscArraycpy(&(*values)[at], value, length));
    at += length;
    PetscCall(MatRestoreRow(A, i, &length, &column, &value));
  }
  PetscCall(BytesTurn(*ints, PETSC_INT, *n_ints));
  PetscCall(BytesTurn(*values, PETSC_SCALAR, *n_values));
  PetscFunctionReturn(0);
}

/* Nothing for NULL */
static PetscErrorCode MatrixWriteBinary(Substructure s, Results results, const char name[], Mat A)
{
  PetscInt     n_ints = 0, n_values = 0, *ints = NULL;
  PetscScalar *values = NULL;
  Mat          whole;

  PetscFunctionBeginUser;
  if (!A) PetscFunctionReturn(0);
  PetscCall(SubstructureCollect(A, &whole));
  if (whole) PetscCall(MatrixPack(whole, &n_ints, &ints, &n_values, &values));
  PetscCall(MatDestroy(&whole));
  PetscCall(ResultsBinaryWrite(
    results, s->comm, name, PETSC_TRUE, 2,
    (ResultsPiece[]){{ints, sizeof(*ints) * (size_t)n_ints}, {values, sizeof(*values) * (size_t)n_values}}));
  PetscCall(PetscFree(ints));
  PetscCall(PetscFree(values));
  PetscFunctionReturn(0);
}

/* As -NAME_table of a superelement reads it, each number as it is */
static PetscErrorCode SubstructureWriteTable(Substructure s, Results results)
{
  ResultsTable table;

  PetscFunctionBeginUser;
  PetscCall(ResultsTableOpen(results, "superelement_table", "unknown,node,direction,x,y,z", &table));
  for (PetscInt k = 0; k < s->interface.n; k++) {
    const InterfaceRow *row = &s->interface.row[k];

    PetscCall(ResultsTableRow(table, "%" PetscInt_FMT ",%" PetscInt_FMT ",%c,%.17g,%.17g,%.17g", k + 1, row->node,
                              "xyz"[row->direction], (double)row -> x[0], (double)row -> x[1], (double)row -> x[2]));
  }
  for (PetscInt k = s->interface.n; k < s->n; k++)
    PetscCall(ResultsTableRow(table, "%" PetscInt_FMT ",0,internal,,,", k + 1));
  PetscCall(ResultsTableClose(&table));
  PetscFunctionReturn(0);
}

static PetscErrorCode SubstructureWriteModes(Substructure s, Results results)
{
  ResultsTable table;
  PetscInt     number = 0;

  PetscFunctionBeginUser;
  PetscCall(ResultsTableOpen(results, "superelement", "interface,mode,frequency_hz,error_hz,relative_error", &table));
  for (PetscInt k = 0; k < s->n_modes; k++) {
    const SubstructureMode *mode = &s->mode[k];

    number = k && mode->held == s->mode[k - 1].held ? number + 1 : 1;
    PetscCall(ResultsTableRow(table, "%s,%" PetscInt_FMT ",%.15g,%.15g,%.15g", mode->held ? "held" : "free", number,
                              (double)mode->frequency, (double)mode->error,
                              (double)(mode->frequency > 0 ? mode->error / mode->frequency : 0)));
  }
  if (s->any >= 0)
    PetscCall(ResultsTableRow(table, "any,0,%.15g,%.15g,%.15g", (double)s->band[1], (double)(s->any * s->band[1]),
                              (double)s->any));
  PetscCall(ResultsTableClose(&table));
  PetscFunctionReturn(0);
}

/* Whether a format is asked for: squeal's own where none is named */
static PetscBool SubstructureHasFormat(const Substructure s, const char format[])
{
  for (PetscInt i = 0; i < s->n_formats; i++)
    if (!strcmp(s->formats[i], format)) return PETSC_TRUE;
  return s->n_formats ? PETSC_FALSE : (PetscBool)!strcmp(format, "squeal");
}

PetscErrorCode SubstructureWrite(Substructure s, Results results)
{
  PetscFunctionBeginUser;
  if (SubstructureHasFormat(s, "squeal")) {
    PetscCall(MatrixWriteBinary(s, results, "superelement_k.bin", s->K));
    PetscCall(MatrixWriteBinary(s, results, "superelement_m.bin", s->M));
    PetscCall(MatrixWriteBinary(s, results, "superelement_c.bin", s->C));
  }
  if (SubstructureHasFormat(s, "market")) PetscCall(MarketWrite(s, results));
  if (SubstructureHasFormat(s, "nastran")) PetscCall(NastranWrite(s, results));
  if (SubstructureHasFormat(s, "abaqus")) PetscCall(AbaqusWrite(s, results));
  PetscCall(SubstructureWriteTable(s, results));
  PetscCall(SubstructureWriteModes(s, results));
  PetscFunctionReturn(0);
}
