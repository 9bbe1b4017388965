/*
   Blocks of vectors made orthonormal in M (A. Stathopoulos, K. Wu, SIAM J. Sci. Comput. 23, 2002: SVQB):

      W -= V V' M W,   G = W' M W = U D U',   W := W U D^-1/2,

   where directions with D below the square of the drop tolerance are left out. All of it is matrix-matrix work; done
   twice it is orthonormal to rounding.
*/
#include "orthonormal.h"
#include "base/algebra/dense.h"

/* A direction smaller than this beside its block is rounding: the Gram matrix has it squared, 1e-18, below eps. */
#define REORTHOGONALISE 1e-9
/* Squares of singular values below this part of the largest are rounding of the Gram matrix. */
#define COMPRESS_ROUNDING 1e-13

/* H = X' A Y, sequential on every rank, of the active columns from the first on; A NULL: X' Y. A Y is freed again. */
PetscErrorCode BlockProducts(BV X, Mat A, BV Y, Mat *H)
{
  PetscInt nx, ny;
  BV       AY = Y;

  PetscFunctionBeginUser;
  PetscCall(BVGetActiveColumns(X, NULL, &nx));
  PetscCall(BVGetActiveColumns(Y, NULL, &ny));
  if (A) {
    PetscCall(BVDuplicateResize(Y, ny, &AY));
    PetscCall(BlockMultiplyVectors(A, Y, AY));
  }
  PetscCall(MatCreateSeqDense(PETSC_COMM_SELF, nx, ny, NULL, H));
  PetscCall(BVDot(AY, X, *H));
  if (A) PetscCall(BVDestroy(&AY));
  PetscFunctionReturn(0);
}

PetscErrorCode BlockProject(BV V, PetscInt n, Mat M, BV W)
{
  Mat coefficients;

  PetscFunctionBeginUser;
  if (!n) PetscFunctionReturn(0);
  PetscCall(BVSetActiveColumns(V, 0, n));
  PetscCall(BlockProducts(V, M, W, &coefficients));
  PetscCall(BVMult(W, -1, 1, V, coefficients));
  PetscCall(MatDestroy(&coefficients));
  PetscFunctionReturn(0);
}

/* G = U diag(w) U', w ascending, U in place of G. Bases of equal eigenvalues are arbitrary and differ by rounding:
   those of the first rank are that of all. */
PetscErrorCode GramEigen(MPI_Comm comm, PetscInt size, PetscScalar G[], PetscReal w[])
{
  PetscFunctionBeginUser;
  PetscCall(DenseSymmetricEigen(size, G, NULL, w, NULL));
  PetscCallMPI(MPI_Bcast(G, (PetscMPIInt)(size * size), MPIU_SCALAR, 0, comm));
  PetscCallMPI(MPI_Bcast(w, (PetscMPIInt)size, MPIU_REAL, 0, comm));
  PetscFunctionReturn(0);
}

/* Makes the block orthonormal in M; its active columns become those above the drop tolerance */
static PetscErrorCode BlockScale(Mat M, PetscReal drop, BV W)
{
  PetscInt     m, kept = 0;
  PetscReal   *eigenvalue;
  PetscScalar *G;
  Mat          gram;

  PetscFunctionBeginUser;
  PetscCall(BVGetActiveColumns(W, NULL, &m));
  if (!m) PetscFunctionReturn(0);
  PetscCall(BlockProducts(W, M, W, &gram));
  PetscCall(PetscMalloc1(m, &eigenvalue));
  PetscCall(MatDenseGetArray(gram, &G));
  PetscCall(GramEigen(PetscObjectComm((PetscObject)W), m, G, eigenvalue));
  drop = PetscMax(drop, REORTHOGONALISE * PetscSqrtReal(PetscMax(eigenvalue[m - 1], 0)));
  for (PetscInt i = m - 1; i >= 0 && eigenvalue[i] > drop * drop; i--) kept++;
  for (PetscInt k = 0; k < kept; k++)
    for (PetscInt i = 0; i < m; i++) G[k * m + i] = G[(m - kept + k) * m + i] / PetscSqrtReal(eigenvalue[m - kept + k]);
  PetscCall(MatDenseRestoreArray(gram, &G));
  PetscCall(BVMultInPlace(W, gram, 0, kept));
  PetscCall(BVSetActiveColumns(W, 0, kept));
  PetscCall(MatDestroy(&gram));
  PetscCall(PetscFree(eigenvalue));
  PetscFunctionReturn(0);
}

/* Twice: rounding of the first projection, eps |W|, grows with the scaling of a short direction; the second takes
   it out. All directions have length one by then: one that falls below 0.1 was rounding. */
PetscErrorCode BlockOrthonormalise(BV V, PetscInt n, Mat M, PetscReal drop, BV W)
{
  PetscInt m;

  PetscFunctionBeginUser;
  PetscCall(BlockProject(V, n, M, W));
  PetscCall(BlockScale(M, drop, W));
  PetscCall(BVGetActiveColumns(W, NULL, &m));
  if (!m) PetscFunctionReturn(0);
  PetscCall(BlockProject(V, n, M, W));
  PetscCall(BlockScale(M, 0.1, W));
  PetscFunctionReturn(0);
}

PetscErrorCode BlockCreate(BV like, PetscInt n, BV *block)
{
  PetscFunctionBeginUser;
  PetscCall(BVDuplicateResize(like, n, block));
  PetscCall(BVSetActiveColumns(*block, 0, n));
  PetscFunctionReturn(0);
}

/* Principal components of B with each column in units of its tolerance: B diag(1 / tolerance) = U sigma V', of
   which B becomes the columns of U with sigma > 1, ascending, orthonormal; sigma [kept]. */
PetscErrorCode BlockCompress(Mat A, const PetscReal tolerance[], BV B, PetscReal sigma[])
{
  PetscInt     m, kept = 0;
  PetscScalar *G;
  PetscReal   *square;
  Mat          gram;

  PetscFunctionBeginUser;
  PetscCall(BVGetActiveColumns(B, NULL, &m));
  if (!m) PetscFunctionReturn(0);
  PetscCall(BlockProducts(B, A, B, &gram));
  PetscCall(PetscMalloc1(m, &square));
  PetscCall(MatDenseGetArray(gram, &G));
  for (PetscInt j = 0; j < m; j++)
    for (PetscInt i = 0; i < m; i++) G[j * m + i] /= tolerance[i] * tolerance[j];
  PetscCall(GramEigen(PetscObjectComm((PetscObject)B), m, G, square));
  while (kept < m && square[m - 1 - kept] > PetscMax(1, COMPRESS_ROUNDING * square[m - 1])) kept++;
  for (PetscInt k = 0; k < kept; k++) {
    sigma[k] = PetscSqrtReal(square[m - kept + k]);
    for (PetscInt i = 0; i < m; i++) G[k * m + i] = G[(m - kept + k) * m + i] / (sigma[k] * tolerance[i]);
  }
  PetscCall(MatDenseRestoreArray(gram, &G));
  PetscCall(BVMultInPlace(B, gram, 0, kept));
  PetscCall(BVSetActiveColumns(B, 0, kept));
  PetscCall(MatDestroy(&gram));
  PetscCall(PetscFree(square));
  PetscFunctionReturn(0);
}

PetscErrorCode BlockCopy(Mat H, PetscBool transposed, PetscInt n, PetscReal A[])
{
  const PetscScalar *h;
  PetscInt           rows, columns, stride;

  PetscFunctionBeginUser;
  PetscCall(MatGetSize(H, &rows, &columns));
  PetscCall(MatDenseGetLDA(H, &stride));
  PetscCall(MatDenseGetArrayRead(H, &h));
  for (PetscInt c = 0; c < columns; c++)
    for (PetscInt r = 0; r < rows; r++) A[transposed ? r * n + c : c * n + r] = PetscRealPart(h[c * stride + r]);
  PetscCall(MatDenseRestoreArrayRead(H, &h));
  PetscFunctionReturn(0);
}

/* A [n][n] for A [first][first], its entries in the corner; the others are not set. */
PetscErrorCode BlockGrow(PetscInt first, PetscInt n, PetscReal **A)
{
  PetscReal *old = *A;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n * n, A));
  for (PetscInt j = 0; j < first; j++) PetscCall(PetscArraycpy(&(*A)[j * n], &old[j * first], first));
  PetscCall(PetscFree(old));
  PetscFunctionReturn(0);
}

PetscErrorCode BlockLift(BV V, PetscInt size, PetscInt m, const PetscReal coordinates[], BV block)
{
  Mat C;

  PetscFunctionBeginUser;
  PetscCall(MatCreateSeqDense(PETSC_COMM_SELF, size, m, (PetscScalar *)coordinates, &C));
  PetscCall(BVSetActiveColumns(V, 0, size));
  PetscCall(BVSetActiveColumns(block, 0, m));
  PetscCall(BVMult(block, 1, 0, V, C));
  PetscCall(MatDestroy(&C));
  PetscFunctionReturn(0);
}
