/* Text of a file in memory, whole before it is written under its final name; entries of matrices */
#include "text.h"
#include "base/text.h"
#include <stdarg.h>
#include <stdio.h>

#define TEXT_LINE 256

PetscErrorCode TextCreate(MPI_Comm comm, Text *text)
{
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  text->buffer = NULL;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  if (!rank) PetscCall(PetscSegBufferCreate(1, 65536, &text->buffer));
  PetscFunctionReturn(0);
}

PetscErrorCode TextPrint(const Text *text, const char format[], ...)
{
  char    line[TEXT_LINE], *room;
  va_list values;
  int     length;

  PetscFunctionBeginUser;
  if (!text->buffer) PetscFunctionReturn(0);
  va_start(values, format);
  length = vsnprintf(line, sizeof(line), format, values);
  va_end(values);
  PetscCheck(length >= 0 && length < TEXT_LINE, PETSC_COMM_SELF, PETSC_ERR_PLIB, "a line of %d characters", length);
  PetscCall(PetscSegBufferGet(text->buffer, (size_t)length, &room));
  PetscCall(PetscArraycpy(room, line, length));
  PetscFunctionReturn(0);
}

PetscErrorCode TextWrite(Text *text, Substructure s, Results results, const char name[])
{
  ResultsPiece piece = {NULL, 0};
  char        *whole = NULL;

  PetscFunctionBeginUser;
  if (text->buffer) {
    PetscCall(PetscSegBufferGetSize(text->buffer, &piece.size));
    PetscCall(PetscSegBufferExtractAlloc(text->buffer, &whole));
    PetscCall(PetscSegBufferDestroy(&text->buffer));
    piece.bytes = whole;
  }
  PetscCall(ResultsBinaryWrite(results, s->comm, name, PETSC_TRUE, 1, &piece));
  PetscCall(PetscFree(whole));
  PetscFunctionReturn(0);
}

PetscInt TextMatrices(const Substructure s, TextMatrix matrix[3])
{
  PetscInt n = 0;

  matrix[n++] = (TextMatrix){s->K, 'k', "stiffness, N/m"};
  matrix[n++] = (TextMatrix){s->M, 'm', "mass, kg"};
  if (s->C) matrix[n++] = (TextMatrix){s->C, 'c', "damping, N s/m"};
  return n;
}

PetscErrorCode TextForEach(Mat A, TextEntry entry, void *ctx, PetscInt *n)
{
  PetscInt size, rows;
  Mat      whole;

  PetscFunctionBeginUser;
  *n = 0;
  PetscCall(SubstructureCollect(A, &whole));
  if (!whole) PetscFunctionReturn(0);
  PetscCall(MatGetSize(whole, &rows, NULL));
  for (PetscInt i = 0; i < rows; i++) {
    const PetscInt    *column;
    const PetscScalar *value;

    PetscCall(MatGetRow(whole, i, &size, &column, &value));
    for (PetscInt k = 0; k < size; k++) {
      if (column[k] < i || value[k] == 0) continue; /* row i of the upper half is column i of the lower one */
      ++*n;
      if (entry) PetscCall(entry(ctx, column[k], i, value[k]));
    }
    PetscCall(MatRestoreRow(whole, i, &size, &column, &value));
  }
  PetscCall(MatDestroy(&whole));
  PetscFunctionReturn(0);
}

PetscErrorCode TextParts(const Substructure s, size_t size, char parts[])
{
  PetscFunctionBeginUser;
  parts[0] = '\0';
  for (PetscInt i = 0; i < s->n_parts; i++) {
    PetscCall(WordsAdd(parts, i ? ", " : "", size));
    PetscCall(WordsAdd(parts, s->parts[i], size));
  }
  PetscFunctionReturn(0);
}

void TextPlace(const Substructure s, PetscInt k, PetscInt *node, PetscInt *direction)
{
  const PetscInt inside = k - s->interface.n;

  *node      = inside < 0 ? s->interface.row[k].node : s->interface.n_nodes + 1 + inside;
  *direction = inside < 0 ? s->interface.row[k].direction + 1 : 0;
}
