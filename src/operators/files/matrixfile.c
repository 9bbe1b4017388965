/*
   PETSc binary files of matrices, looked at before MatLoad() reads them: it takes a file of complex numbers for one of
   real numbers, leaves out what follows the last one, and believes all column numbers.

   A sparse file holds, in integers of 4 bytes and reals of 8, most significant byte first:
      1211216, rows, columns, n; entries of each row; columns of the n entries, row by row; the n entries.
   A dense file has n = -1 and all entries. Numbers beyond 1e60 are refused: their products are no numbers.
*/
#include "operators/pencilimpl.h"
#include "base/file.h"
#include <errno.h>
#include <sys/stat.h>

/* integers at a time: 16 kB on the stack */
#define MATRIX_FILE_CHUNK 4096
#define MATRIX_MAX_ROWS   100000000 /* 1e8: a larger number is none of rows */

/* The file, and what is wrong with it: empty where nothing is */
typedef struct {
  FILE    *stream;
  PetscInt rows, columns, n; /* n entries, -1 of a dense matrix */
  char     fault[256];
} MatrixFile;

/* Reads n integers; false where the file ends */
static PetscBool MatrixFileInts(MatrixFile *f, size_t n, PetscInt value[])
{
  unsigned char bytes[4 * MATRIX_FILE_CHUNK];

  if (fread(bytes, 4, n, f->stream) != n) return PETSC_FALSE;
  for (size_t i = 0; i < n; i++) {
    const unsigned char *b = &bytes[4 * i];

    value[i] = (PetscInt)(int32_t)((uint32_t)b[0] << 24 | (uint32_t)b[1] << 16 | (uint32_t)b[2] << 8 | (uint32_t)b[3]);
  }
  return PETSC_TRUE;
}

/* The head, and the size of the file that follows from it: 16 bytes, 4 for each row and column number, 8 for each
   entry. Complex entries are told by 8 bytes more of each. */
static PetscErrorCode MatrixFileHead(MatrixFile *f)
{
  const size_t size = sizeof(f->fault);
  PetscInt     head[4];
  double       real, entries;
  struct stat  what;

  PetscFunctionBeginUser;
  if (fstat(fileno(f->stream), &what) || !S_ISREG(what.st_mode)) {
    PetscCall(PetscSNPrintf(f->fault, size, "it is no regular file"));
  } else if (!MatrixFileInts(f, 4, head) || head[0] != MAT_FILE_CLASSID) {
    PetscCall(PetscSNPrintf(f->fault, size, "it is no matrix in PETSc's binary form"));
  } else if (head[1] < 1 || head[2] < 1 || head[1] > MATRIX_MAX_ROWS || head[2] > MATRIX_MAX_ROWS || head[3] < -1) {
    PetscCall(PetscSNPrintf(f->fault, size, "its head says %" PetscInt_FMT " rows, %" PetscInt_FMT " columns", head[1],
                            head[2]));
  }
  if (f->fault[0]) PetscFunctionReturn(0);
  f->rows    = head[1];
  f->columns = head[2];
  f->n       = head[3];
  entries    = f->n < 0 ? (double)f->rows * (double)f->columns : (double)f->n;
  real       = 16 + 8 * entries + (f->n < 0 ? 0 : 4 * ((double)f->rows + entries));
  if ((double)what.st_size == real + 8 * entries && entries > 0)
    PetscCall(PetscSNPrintf(f->fault, size, "its numbers are complex; write it with a PETSc of real numbers"));
  else if ((double)what.st_size != real)
    PetscCall(PetscSNPrintf(f->fault, size, "it has %.0f bytes, where %.0f would hold its %.0f entries",
                            (double)what.st_size, real, entries));
  PetscFunctionReturn(0);
}

/* Columns of the entries: within the matrix, ascending in each row. Read in pieces, so that the memory is that of
   the row counts. */
static PetscErrorCode MatrixFileColumns(MatrixFile *f)
{
  const size_t size = sizeof(f->fault);
  PetscInt    *count, column[MATRIX_FILE_CHUNK];
  double       sum = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(f->rows, &count));
  for (PetscInt i = 0; i < f->rows && !f->fault[0]; i++) {
    if (!MatrixFileInts(f, 1, &count[i]) || count[i] < 0 || count[i] > f->columns)
      PetscCall(PetscSNPrintf(f->fault, size, "row %" PetscInt_FMT " has no valid number of entries", i));
    sum += (double)count[i];
  }
  if (!f->fault[0] && sum != (double)f->n)
    PetscCall(PetscSNPrintf(f->fault, size, "its rows have %.0f entries, the head says %" PetscInt_FMT, sum, f->n));
  for (PetscInt i = 0; i < f->rows && !f->fault[0]; i++) {
    PetscInt last = -1;

    for (PetscInt k = 0; k < count[i] && !f->fault[0]; k += MATRIX_FILE_CHUNK) {
      const PetscInt n = PetscMin(count[i] - k, MATRIX_FILE_CHUNK);

      (void)MatrixFileInts(f, (size_t)n, column);
      for (PetscInt j = 0; j < n && !f->fault[0]; last = column[j++])
        if (column[j] <= last || column[j] >= f->columns)
          PetscCall(PetscSNPrintf(f->fault, size,
                                  "row %" PetscInt_FMT " has an entry in column %" PetscInt_FMT
                                  ": columns ascend from 0 to %" PetscInt_FMT,
                                  i, column[j], f->columns - 1));
    }
  }
  PetscCall(PetscFree(count));
  PetscFunctionReturn(0);
}

/* The numbers: finite, and of a magnitude whose products are */
static PetscErrorCode MatrixFileNumbers(MatrixFile *f)
{
  unsigned char b[8];

  PetscFunctionBeginUser;
  for (double k = 0; fread(b, 8, 1, f->stream) == 1 && !f->fault[0]; k++) {
    uint64_t word = 0;
    double   value;

    for (int i = 0; i < 8; i++) word = word << 8 | b[i];
    (void)memcpy(&value, &word, sizeof(value));
    if (!isfinite(value))
      PetscCall(PetscSNPrintf(f->fault, sizeof(f->fault), "its entry %.0f is not finite", k));
    else if (fabs(value) > MATRIX_LARGEST)
      PetscCall(PetscSNPrintf(f->fault, sizeof(f->fault), "its entry %.0f is %g: numbers must be of at most %g", k,
                              value, MATRIX_LARGEST));
  }
  PetscFunctionReturn(0);
}

/* What is wrong with the file, on the rank that calls */
static PetscErrorCode MatrixFileRead(const char file[], MatrixFile *f)
{
  PetscFunctionBeginUser;
  f->stream = FileStream(file, "rb");
  if (!f->stream) {
    PetscCall(PetscSNPrintf(f->fault, sizeof(f->fault), "%s", FileReason(errno)));
    PetscFunctionReturn(0);
  }
  PetscCall(MatrixFileHead(f));
  if (!f->fault[0] && f->n >= 0) PetscCall(MatrixFileColumns(f));
  if (!f->fault[0]) PetscCall(MatrixFileNumbers(f));
  (void)fclose(f->stream);
  PetscFunctionReturn(0);
}

/* An error, alike on all ranks, for a file that does not hold a real matrix of finite numbers */
static PetscErrorCode MatrixFileCheck(MPI_Comm comm, const char option[], const char file[])
{
  MatrixFile  f = {.stream = NULL};
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  if (rank == 0) PetscCall(MatrixFileRead(file, &f));
  PetscCallMPI(MPI_Bcast(f.fault, sizeof(f.fault), MPI_CHAR, 0, comm));
  PetscCheck(!f.fault[0], comm, PETSC_ERR_FILE_UNEXPECTED,
             "cannot read '%s' of %s: %s; give a file written by -operators_save or MatView()", file, option, f.fault);
  PetscFunctionReturn(0);
}

/* of the diagonal: what is smaller, of the mass along a direction, is none. Files may hold ten figures alone. */
#define MASS_ROUNDING 1e-10

/* How many eigenvalues of a symmetric matrix M + shift diag(M) are negative or zero: signs of the pivots of L D L' (J.
   J. Sylvester) */
static PetscErrorCode MassCountPivots(Mat S, Vec diagonal, PetscReal shift, PetscInt *bad)
{
  MatFactorInfo info;
  PetscInt      negative, zero;
  Mat           F;
  IS            row, column;
  Mat           M;
  Vec           moved;

  PetscFunctionBeginUser;
  PetscCall(VecDuplicate(diagonal, &moved));
  PetscCall(VecCopy(diagonal, moved));
  PetscCall(VecScale(moved, shift));
  PetscCall(MatDuplicate(S, MAT_COPY_VALUES, &M));
  PetscCall(MatSetOption(M, MAT_NEW_NONZERO_ALLOCATION_ERR, PETSC_FALSE)); /* a row may be empty */
  PetscCall(MatDiagonalSet(M, moved, ADD_VALUES));
  PetscCall(VecDestroy(&moved));
  PetscCall(MatFactorInfoInitialize(&info));
  PetscCall(MatGetFactor(M, MATSOLVERMUMPS, MAT_FACTOR_CHOLESKY, &F));
  PetscCall(MatMumpsSetIcntl(F, 13, 1)); /* pivots of the root are counted only without ScaLAPACK */
  PetscCall(MatMumpsSetIcntl(F, 24, 1)); /* null pivots are counted */
  PetscCall(MatGetOrdering(M, MATORDERINGEXTERNAL, &row, &column));
  PetscCall(MatCholeskyFactorSymbolic(F, M, row, &info));
  PetscCall(MatCholeskyFactorNumeric(F, M, &info));
  PetscCall(MatGetInertia(F, &negative, &zero, NULL));
  *bad = negative + zero;
  PetscCall(ISDestroy(&row));
  PetscCall(ISDestroy(&column));
  PetscCall(MatDestroy(&F));
  PetscCall(MatDestroy(&M));
  PetscFunctionReturn(0);
}

/* Unknowns of all ranks without any mass; an error for one with mass that is not positive on the diagonal: e_i' M
   e_i > 0 is necessary for definiteness, and cheap. S is twice the symmetric part, hence the half in the message. */
static PetscErrorCode MassCountEmpty(Mat S, const char whose[], PetscInt *empty)
{
  const PetscScalar *value;
  const PetscInt    *column;
  PetscInt           begin, end, n;
  double             fault[2] = {0, -1}; /* least diagonal entry, and its row */

  PetscFunctionBeginUser;
  *empty = 0;
  PetscCall(MatGetOwnershipRange(S, &begin, &end));
  for (PetscInt row = begin; row < end; row++) {
    PetscReal diagonal = 0, size = 0;

    PetscCall(MatGetRow(S, row, &n, &column, &value));
    for (PetscInt k = 0; k < n; k++) {
      if (column[k] == row) diagonal = PetscRealPart(value[k]);
      size = PetscMax(size, PetscAbsScalar(value[k]));
    }
    PetscCall(MatRestoreRow(S, row, &n, &column, &value));
    if (size == 0) ++*empty;
    if (size > 0 && diagonal <= 0 && fault[1] < 0) fault[0] = (double)diagonal / 2, fault[1] = (double)row;
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, empty, 1, MPIU_INT, MPI_SUM, PetscObjectComm((PetscObject)S)));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &fault[0], 1, MPI_DOUBLE, MPI_MIN, PetscObjectComm((PetscObject)S)));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &fault[1], 1, MPI_DOUBLE, MPI_MAX, PetscObjectComm((PetscObject)S)));
  PetscCheck(fault[1] < 0, PetscObjectComm((PetscObject)S), PETSC_ERR_USER_INPUT,
             "%sthe mass matrix has %.6g on its diagonal, such as in row %.0f: it must be positive definite", whose,
             fault[0], fault[1]);
  PetscFunctionReturn(0);
}

/* S = M + M', twice the symmetric part: only its signs count. A diagonal S needs no factors: |S|_F is then |diag S|.
   Else the pivots of S - 1e-10 diag(S) tell whether directions have no mass, and, where they do, those of S + 1e-10
   diag(S) whether any has a negative one. Rows without entries (multipliers) count in both, and are taken off. */
PetscErrorCode MassCheck(Mat M, const char whose[], PetscBool *singular)
{
  PetscInt  empty, bad = 0;
  PetscReal norm, largest;
  Vec       diagonal;
  Mat       S;

  PetscFunctionBeginUser;
  PetscCall(MatTranspose(M, MAT_INITIAL_MATRIX, &S));
  PetscCall(MatAYPX(S, 1, M, DIFFERENT_NONZERO_PATTERN));
  PetscCall(MassCountEmpty(S, whose, &empty));
  PetscCall(MatCreateVecs(S, &diagonal, NULL));
  PetscCall(MatGetDiagonal(S, diagonal));
  PetscCall(VecNorm(diagonal, NORM_2, &largest));
  PetscCall(MatNorm(S, NORM_FROBENIUS, &norm));
  if (norm > largest * (1 + 1e-15)) PetscCall(MassCountPivots(S, diagonal, -MASS_ROUNDING, &bad));
  *singular = bad > empty ? PETSC_TRUE : PETSC_FALSE;
  if (*singular) PetscCall(MassCountPivots(S, diagonal, MASS_ROUNDING, &bad));
  PetscCall(VecDestroy(&diagonal));
  bad -= bad ? empty : 0;
  PetscCheck(bad <= 0, PetscObjectComm((PetscObject)M), PETSC_ERR_USER_INPUT,
             "%sthe mass matrix has %" PetscInt_FMT
             " negative eigenvalues: it must be positive definite, or have no mass along some directions",
             whose, bad);
  PetscCall(MatDestroy(&S));
  PetscFunctionReturn(0);
}

PetscErrorCode MatrixReadDense(MPI_Comm comm, const char option[], PetscInt n_values, const PetscReal values[], Mat *A)
{
  const PetscInt n = (PetscInt)(PetscSqrtReal((PetscReal)n_values) + 0.5);
  PetscInt       first, last;

  PetscFunctionBeginUser;
  PetscCheck(n * n == n_values, comm, PETSC_ERR_USER_INPUT,
             "%s has %" PetscInt_FMT " values, which is no square number", option, n_values);
  for (PetscInt i = 0; i < n_values; i++)
    PetscCheck(PetscAbsReal(values[i]) <= MATRIX_LARGEST, comm, PETSC_ERR_USER_INPUT,
               "%s value %.6g must be of at most %g", option, (double)values[i], MATRIX_LARGEST);
  PetscCall(MatCreateAIJ(comm, PETSC_DECIDE, PETSC_DECIDE, n, n, n, NULL, n, NULL, A));
  PetscCall(MatGetOwnershipRange(*A, &first, &last));
  for (PetscInt i = first; i < last; i++)
    for (PetscInt j = 0; j < n; j++) PetscCall(MatSetValue(*A, i, j, values[i * n + j], INSERT_VALUES));
  PetscCall(MatAssemblyBegin(*A, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(*A, MAT_FINAL_ASSEMBLY));
  PetscFunctionReturn(0);
}

/* Opens a binary file of PETSc, which by itself would read NAME.info beside it as an options file, and write one */
PetscErrorCode MatrixViewerOpen(MPI_Comm comm, const char file[], PetscFileMode mode, PetscViewer *viewer)
{
  PetscFunctionBeginUser;
  PetscCall(PetscViewerCreate(comm, viewer));
  PetscCall(PetscViewerSetType(*viewer, PETSCVIEWERBINARY));
  PetscCall(PetscViewerBinarySetSkipInfo(*viewer, PETSC_TRUE));
  PetscCall(PetscViewerBinarySetSkipOptions(*viewer, PETSC_TRUE));
  PetscCall(PetscViewerFileSetMode(*viewer, mode));
  PetscCall(PetscViewerFileSetName(*viewer, file));
  PetscFunctionReturn(0);
}

PetscErrorCode MatrixReadFile(MPI_Comm comm, const char option[], const char file[], Mat *A)
{
  PetscViewer viewer;

  PetscFunctionBeginUser;
  PetscCall(MatrixFileCheck(comm, option, file));
  PetscCall(MatrixViewerOpen(comm, file, FILE_MODE_READ, &viewer));
  PetscCall(MatCreate(comm, A));
  PetscCall(MatSetType(*A, MATAIJ));
  PetscCall(MatLoad(*A, viewer));
  PetscCall(PetscViewerDestroy(&viewer));
  PetscFunctionReturn(0);
}

/* Rows of a matrix in any order: one number a row, of its number, columns and values, so that the sum does not hang
   on how the rows are spread over the ranks */
PetscErrorCode MatrixAddChecksum(Mat A, Checksum c)
{
  PetscInt  begin, end;
  uint64_t *piece;

  PetscFunctionBeginUser;
  PetscCall(MatGetOwnershipRange(A, &begin, &end));
  PetscCall(PetscMalloc1(end - begin, &piece));
  for (PetscInt row = begin; row < end; row++) {
    const PetscInt    *columns;
    const PetscScalar *values;
    PetscInt           n;
    uint64_t          *sum = &piece[row - begin];

    PetscCall(MatGetRow(A, row, &n, &columns, &values));
    *sum = ChecksumBytes(CHECKSUM_BEGIN, &row, sizeof(row));
    *sum = ChecksumBytes(*sum, columns, (size_t)n * sizeof(*columns));
    *sum = ChecksumBytes(*sum, values, (size_t)n * sizeof(*values));
    PetscCall(MatRestoreRow(A, row, &n, &columns, &values));
  }
  PetscCall(ChecksumAddPieces(c, end - begin, piece));
  PetscCall(PetscFree(piece));
  PetscFunctionReturn(0);
}
