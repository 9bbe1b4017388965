/*
   T'A T of each matrix of the parts, a block of columns at a time, and the sums K_s, M_s, C_s at the point of the
   scene. All are exactly symmetric, the mean of both halves. Where nothing is reduced they are A in the order of the
   interface.
*/
#include "substructureimpl.h"
#include "base/algebra/gram.h"
#include "base/algebra/product.h"

#define REDUCE_BLOCK 64 /* columns at once */

/* Columns first .. of R from H [n_columns][n], of which this rank takes its rows */
static PetscErrorCode ColumnsPut(PetscInt n, PetscInt first, PetscInt n_columns, const PetscReal H[], Mat R)
{
  PetscScalar *r;
  PetscInt     begin, end, lda;

  PetscFunctionBeginUser;
  PetscCall(MatGetOwnershipRange(R, &begin, &end));
  PetscCall(MatDenseGetLDA(R, &lda));
  PetscCall(MatDenseGetArray(R, &r));
  for (PetscInt j = 0; j < n_columns; j++)
    for (PetscInt i = begin; i < end; i++) r[(size_t)(first + j) * lda + i - begin] = H[(size_t)j * n + i];
  PetscCall(MatDenseRestoreArray(R, &r));
  PetscFunctionReturn(0);
}

/* The mean of R and its transpose, as a sparse matrix */
static PetscErrorCode MatrixFinish(Mat *R)
{
  Mat T, sparse;

  PetscFunctionBeginUser;
  PetscCall(MatTranspose(*R, MAT_INITIAL_MATRIX, &T));
  PetscCall(MatAXPY(*R, 1, T, SAME_NONZERO_PATTERN));
  PetscCall(MatScale(*R, 0.5));
  PetscCall(MatDestroy(&T));
  PetscCall(MatConvert(*R, MATAIJ, MAT_INITIAL_MATRIX, &sparse));
  PetscCall(MatDestroy(R));
  *R = sparse;
  PetscFunctionReturn(0);
}

static PetscErrorCode MatrixReduce(Substructure s, Mat A, Mat *R)
{
  PetscReal *H;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1((size_t)s->n * REDUCE_BLOCK, &H));
  PetscCall(MatCreateDense(s->comm, PETSC_DECIDE, PETSC_DECIDE, s->n, s->n, NULL, R));
  for (PetscInt first = 0, n; first < s->n; first += n) {
    Mat columns, product;

    n = PetscMin(REDUCE_BLOCK, s->n - first);
    PetscCall(MatCreateDense(s->comm, s->body.n_own, PETSC_DECIDE, PETSC_DETERMINE, n, NULL, &product));
    PetscCall(MatDenseGetSubMatrix(s->T, PETSC_DECIDE, PETSC_DECIDE, first, first + n, &columns));
    PetscCall(BlockMultiply(A, columns, product));
    PetscCall(MatDenseRestoreSubMatrix(s->T, &columns));
    PetscCall(BlockGram(s->T, product, H));
    PetscCall(ColumnsPut(s->n, first, n, H, *R));
    PetscCall(MatDestroy(&product));
  }
  PetscCall(MatAssemblyBegin(*R, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(*R, MAT_FINAL_ASSEMBLY));
  PetscCall(MatrixFinish(R));
  PetscCall(PetscFree(H));
  PetscFunctionReturn(0);
}

PetscErrorCode SubstructureReduce(Substructure s)
{
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(s->body.n_matrices, &s->A));
  for (PetscInt j = 0; j < s->body.n_matrices; j++) {
    if (s->T) {
      PetscCall(MatrixReduce(s, s->body.A[j], &s->A[j]));
    } else {
      PetscCall(MatPtAP(s->body.A[j], s->interface.E, MAT_INITIAL_MATRIX, PETSC_DEFAULT, &s->A[j]));
      PetscCall(MatProductClear(s->A[j]));
    }
  }
  PetscCall(BodySum(s, s->A, &s->K, &s->M, &s->C));
  PetscFunctionReturn(0);
}
