/*
   A block W = V C + Q R, orthogonalised against a basis V and in itself so that the factors hold to rounding, as a
   Krylov decomposition needs them. In passes of matrix-matrix products (A. Stathopoulos, K. Wu, SIAM J. Sci. Comput. 23,
   2002)

      C' = V' M W,   G = W' M W - C'' C' = S (U D U') S,   W := (W - V C') T,   T = S^-1 U D^-1/2,

      C := C + C' R,   R := T^-1 R,   T^-1 = D^1/2 U' S,

   with S the square root of the diagonal of G and D not below rounding: T is always regular, so what one pass does not
   resolve the next one does. A row of R is the size of its direction.
*/
#include "orthonormal.h"

#define ROUNDING 1e-14 /* what a pass does not resolve beside what there is */
#define PASSES   8     /* each makes a condition up to 1e7 times better; two are usual */

/* One pass over a block of m columns, which were `columns` at the beginning */
typedef struct {
  PetscInt     m, columns;
  Mat          C, T;          /* V' M W; W' M W, then T */
  PetscReal   *size, *spread; /* [m] S; D */
  PetscScalar *R;             /* [columns][columns] rows of R, before and after */
  PetscReal    norm;          /* of the longest column at the beginning */
  PetscBool    clean;         /* the block was orthonormal to a half before, so that it is now to rounding */
} BlockPass;

/* C and W' M W */
static PetscErrorCode PassMeasure(BV V, PetscInt n, Mat M, BV W, BlockPass *pass)
{
  BV MW = W;

  PetscFunctionBeginUser;
  if (M) {
    PetscCall(BVDuplicateResize(W, pass->m, &MW));
    PetscCall(BlockMultiplyVectors(M, W, MW));
  }
  PetscCall(BVSetActiveColumns(V, 0, n));
  PetscCall(MatCreateSeqDense(PETSC_COMM_SELF, n, pass->m, NULL, &pass->C));
  PetscCall(MatCreateSeqDense(PETSC_COMM_SELF, pass->m, pass->m, NULL, &pass->T));
  if (n) PetscCall(BVDot(MW, V, pass->C));
  PetscCall(BVDot(MW, W, pass->T));
  if (M) PetscCall(BVDestroy(&MW));
  PetscFunctionReturn(0);
}

/* U and D of G, which is left in T, and S */
static PetscErrorCode PassDecompose(MPI_Comm comm, PetscInt n, PetscBool first, BlockPass *pass)
{
  const PetscInt     m = pass->m;
  const PetscScalar *C;
  PetscScalar       *G;
  PetscReal          moved = 0;

  PetscFunctionBeginUser;
  PetscCall(MatDenseGetArrayRead(pass->C, &C));
  PetscCall(MatDenseGetArray(pass->T, &G));
  for (PetscInt j = 0; j < m; j++) {
    const PetscReal before = PetscMax(G[j * m + j], 0);

    if (first) pass->norm = PetscMax(pass->norm, PetscSqrtReal(before));
    for (PetscInt i = 0; i < m; i++)
      for (PetscInt k = 0; k < n; k++) G[j * m + i] -= C[i * n + k] * C[j * n + k];
    pass->size[j] = PetscSqrtReal(PetscMax(G[j * m + j], ROUNDING * before));
    if (pass->size[j] == 0) pass->size[j] = 1;
    moved = PetscMax(moved, before - G[j * m + j]);
  }
  pass->clean = moved < 0.5 ? PETSC_TRUE : PETSC_FALSE;
  for (PetscInt j = 0; j < m; j++) {
    if (pass->size[j] < 0.7 || pass->size[j] > 1.4) pass->clean = PETSC_FALSE;
    for (PetscInt i = 0; i < m; i++) G[j * m + i] /= pass->size[i] * pass->size[j];
  }
  PetscCall(GramEigen(comm, m, G, pass->spread));
  if (m && pass->spread[0] < 0.5) pass->clean = PETSC_FALSE;
  for (PetscInt i = 0; i < m; i++) pass->spread[i] = PetscMax(pass->spread[i], ROUNDING * pass->spread[m - 1]);
  PetscCall(MatDenseRestoreArray(pass->T, &G));
  PetscCall(MatDenseRestoreArrayRead(pass->C, &C));
  PetscFunctionReturn(0);
}

/* C and R after the pass; T from U, D and S */
static PetscErrorCode PassAccumulate(PetscInt n, BlockPass *pass, BlockFactors *factors)
{
  const PetscInt     m = pass->m, ld = factors->ld;
  const PetscScalar *C;
  PetscScalar       *U;

  PetscFunctionBeginUser;
  PetscCall(MatDenseGetArrayRead(pass->C, &C));
  PetscCall(MatDenseGetArray(pass->T, &U));
  for (PetscInt j = 0; j < pass->columns; j++) {
    PetscScalar *const H = factors->H + j * ld, *const R = pass->R;

    for (PetscInt k = 0; k < m; k++) {
      for (PetscInt i = 0; i < n; i++) H[i] += C[k * n + i] * H[n + k];
      R[k] = pass->size[k] * H[n + k];
    }
    for (PetscInt i = 0; i < m; i++) {
      H[n + i] = 0;
      for (PetscInt k = 0; k < m; k++) H[n + i] += U[i * m + k] * R[k];
      H[n + i] *= PetscSqrtReal(pass->spread[i]);
    }
  }
  for (PetscInt i = 0; i < m; i++)
    for (PetscInt k = 0; k < m; k++) U[i * m + k] /= pass->size[k] * PetscSqrtReal(pass->spread[i]);
  PetscCall(MatDenseRestoreArray(pass->T, &U));
  PetscCall(MatDenseRestoreArrayRead(pass->C, &C));
  PetscFunctionReturn(0);
}

/* Norms of the rows of R, in size[] */
static void PassRows(PetscInt n, const BlockFactors *factors, BlockPass *pass)
{
  for (PetscInt i = 0; i < pass->m; i++) {
    pass->size[i] = 0;
    for (PetscInt j = 0; j < pass->columns; j++) pass->size[i] += PetscSqr(factors->H[j * factors->ld + n + i]);
    pass->size[i] = PetscSqrtReal(pass->size[i]);
  }
}

/* Leaves out direction i */
static PetscErrorCode PassDrop(PetscInt n, PetscInt i, BV W, BlockFactors *factors, BlockPass *pass)
{
  PetscFunctionBeginUser;
  pass->m--;
  for (PetscInt j = 0; j < pass->columns; j++) {
    PetscScalar *const R = factors->H + j * factors->ld + n;

    R[i]       = R[pass->m];
    R[pass->m] = 0;
  }
  if (i < pass->m) PetscCall(BVCopyColumn(W, pass->m, i));
  pass->size[i] = pass->size[pass->m];
  PetscFunctionReturn(0);
}

/* Leaves out directions that are rounding, and the smallest where there are more than there may be */
static PetscErrorCode PassTrim(PetscInt n, BV W, BlockFactors *factors, BlockPass *pass)
{
  PetscFunctionBeginUser;
  PassRows(n, factors, pass);
  while (pass->m) {
    PetscInt smallest = 0;

    for (PetscInt i = 1; i < pass->m; i++)
      if (pass->size[i] < pass->size[smallest]) smallest = i;
    if (pass->m <= factors->most && pass->size[smallest] > factors->drop * pass->norm) break;
    PetscCall(PassDrop(n, smallest, W, factors, pass));
  }
  PetscCall(BVSetActiveColumns(W, 0, pass->m));
  PetscFunctionReturn(0);
}

/* W := (W - V C) T with its factors */
static PetscErrorCode PassRun(BV V, PetscInt n, Mat M, BV W, BlockFactors *factors, BlockPass *pass)
{
  PetscFunctionBeginUser;
  PetscCall(PassMeasure(V, n, M, W, pass));
  PetscCall(PassDecompose(PetscObjectComm((PetscObject)W), n, pass->norm < 0 ? PETSC_TRUE : PETSC_FALSE, pass));
  PetscCall(PassAccumulate(n, pass, factors));
  if (n) PetscCall(BVMult(W, -1, 1, V, pass->C));
  PetscCall(BVMultInPlace(W, pass->T, 0, pass->m));
  PetscCall(MatDestroy(&pass->C));
  PetscCall(MatDestroy(&pass->T));
  PetscCall(PassTrim(n, W, factors, pass));
  PetscFunctionReturn(0);
}

PetscErrorCode BlockFactorise(BV V, PetscInt n, Mat M, BV W, BlockFactors *factors)
{
  BlockPass pass = {.norm = -1, .clean = PETSC_FALSE};

  PetscFunctionBeginUser;
  PetscCall(BVGetActiveColumns(W, NULL, &pass.columns));
  pass.m = pass.columns;
  if (!pass.m) PetscFunctionReturn(0);
  PetscCall(PetscMalloc3(pass.m, &pass.size, pass.m, &pass.spread, pass.m, &pass.R));
  for (PetscInt j = 0; j < pass.m; j++) {
    PetscCall(PetscArrayzero(factors->H + j * factors->ld, n + pass.m));
    factors->H[j * factors->ld + n + j] = 1;
  }
  for (int i = 0; i < PASSES && pass.m && !pass.clean; i++) PetscCall(PassRun(V, n, M, W, factors, &pass));
  PetscCall(PetscFree3(pass.size, pass.spread, pass.R));
  PetscFunctionReturn(0);
}
