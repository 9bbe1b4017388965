/* A matrix in PETSc's binary form, as MatView() writes it, which cannot write into memory */
#include "text.h"

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

PetscErrorCode BinaryWrite(Substructure s, Results results, const char name[], Mat A)
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
