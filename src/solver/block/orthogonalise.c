/*
   A block W = V C + Q R, orthogonalised against a basis V and in itself so that the factors hold to rounding, as a
   Krylov decomposition needs them. In passes of matrix-matrix products (A. Stathopoulos, K. Wu, SIAM J. Sci. Comput.
   23, 2002)

      C' = V' M W,   G = W' M W - C'' C' = S (U D U') S,   W := (W - V C') T,   T = S^-1 U D^-1/2,

      C := C + C' R,   R := T^-1 R,   T^-1 = D^1/2 U' S,

   with S the square root of the diagonal of G and D not below rounding, which it is where V holds all of the block: T
   is always regular, so what one pass does not resolve the next one does. A row of R is the size of its direction.
   Without M a pass measures what the next one needs while it has V at hand (panel.h).

   A block that was measured to be nearly orthonormal may be left so: W = V C + Q R holds for any Q, and what the next
   block loses by it, times |C| beside R, is measured again.

   Rounding in G, epsilon times W' M W, is as much beside one in the new block as its largest entry beside S S D. Where
   that is little enough for those who know V' M V, a pass is the last one. A loose V is projected on by C' = (V'MV)^-1
   V' M W.
*/
#include "base/algebra/dense.h"
#include "orthonormal.h"
#include "panel.h"

/* What a pass does not resolve beside what there is, in squares: of lengths 1e-7, hence the condition that a pass
   removes. */
#define ROUNDING 1e-14
#define PASSES   8  /* each makes a condition up to 1e7 times better; two are usual */
#define SUMS     10 /* roundings of an entry of G */

/* One pass over a block of m columns, which were `columns` at the beginning */
typedef struct {
  PetscInt     m, columns;
  PetscScalar *C, *T;         /* [m][n] V' M W; [m][m] W' M W, then T; one behind the other */
  PetscBool    measured;      /* they are those of the block as it is */
  PetscReal   *size, *spread; /* [m] S; D */
  PetscScalar *R;             /* [columns][columns] rows of R, before and after */
  PetscReal    norm;          /* of the longest column at the beginning */
  PetscBool
    clean; /* the block was orthonormal to a half before, so that it is now to rounding; or loosely, or near enough */
} BlockPass;

/* The local rows of the active columns of a block; A is to be restored with it */
static PetscErrorCode PanelGet(BV V, Mat *A, Panel *panel)
{
  PetscFunctionBeginUser;
  PetscCall(BVGetMat(V, A));
  PetscCall(MatGetLocalSize(*A, &panel->rows, NULL));
  PetscCall(MatGetSize(*A, NULL, &panel->columns));
  PetscCall(MatDenseGetLDA(*A, &panel->stride));
  PetscCall(MatDenseGetArray(*A, &panel->a));
  PetscFunctionReturn(0);
}

static PetscErrorCode PanelRestore(BV V, Mat *A, Panel *panel)
{
  PetscFunctionBeginUser;
  PetscCall(MatDenseRestoreArray(*A, &panel->a));
  PetscCall(BVRestoreMat(V, A));
  PetscFunctionReturn(0);
}

/* Sums C and T of all ranks, in one message of m (n + m) numbers: they lie one behind the other. */
static PetscErrorCode PassSum(BV W, PetscInt n, BlockPass *pass)
{
  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, pass->C, (PetscMPIInt)(pass->m * (n + pass->m)), MPIU_SCALAR, MPIU_SUM,
                             PetscObjectComm((PetscObject)W)));
  pass->measured = PETSC_TRUE;
  PetscFunctionReturn(0);
}

/* C and W' M W by the products of SLEPc, where M comes between them */
static PetscErrorCode PassMeasureMass(BV V, PetscInt n, Mat M, BV W, BlockPass *pass)
{
  Mat C, T;
  BV  MW;

  PetscFunctionBeginUser;
  PetscCall(BVDuplicateResize(W, pass->m, &MW));
  PetscCall(BlockMultiplyVectors(M, W, MW));
  PetscCall(BVSetActiveColumns(V, 0, n));
  pass->T = pass->C + pass->m * n;
  PetscCall(MatCreateSeqDense(PETSC_COMM_SELF, n, pass->m, pass->C, &C));
  PetscCall(MatCreateSeqDense(PETSC_COMM_SELF, pass->m, pass->m, pass->T, &T));
  if (n) PetscCall(BVDot(MW, V, C));
  PetscCall(BVDot(MW, W, T));
  PetscCall(MatDestroy(&C));
  PetscCall(MatDestroy(&T));
  PetscCall(BVDestroy(&MW));
  pass->measured = PETSC_TRUE;
  PetscFunctionReturn(0);
}

/* C and W' W */
static PetscErrorCode PassMeasure(BV V, PetscInt n, BV W, BlockPass *pass)
{
  Panel v, w;
  Mat   A, B;

  PetscFunctionBeginUser;
  PetscCall(PanelGet(W, &B, &w));
  if (n) {
    PetscCall(BVSetActiveColumns(V, 0, n));
    PetscCall(PanelGet(V, &A, &v));
    PetscCall(PanelProduct(&v, &w, pass->C));
    PetscCall(PanelRestore(V, &A, &v));
  }
  pass->T = pass->C + pass->m * n;
  PetscCall(PanelProduct(&w, &w, pass->T));
  PetscCall(PanelRestore(W, &B, &w));
  PetscCall(PassSum(W, n, pass));
  PetscFunctionReturn(0);
}

/* C := (V'MV)^-1 C where V is loose; products [m][n] = C as it was measured, V' M W */
static PetscErrorCode PassProject(PetscInt n, const PetscReal gram[], BlockPass *pass, PetscScalar products[])
{
  PetscReal    *factors;
  PetscBLASInt *pivot;

  PetscFunctionBeginUser;
  PetscCall(PetscArraycpy(products, pass->C, pass->m * n));
  if (!gram || !n) PetscFunctionReturn(0);
  PetscCall(PetscMalloc2(n * n, &factors, n, &pivot));
  PetscCall(PetscArraycpy(factors, gram, n * n));
  PetscCall(DenseFactor(n, factors, pivot, NULL));
  PetscCall(DenseSolve(n, factors, pivot, PETSC_FALSE, pass->m, pass->C));
  PetscCall(PetscFree2(factors, pivot));
  PetscFunctionReturn(0);
}

/* S and S^-1 G S^-1 of G = W' M W - C'' C', which takes the place of W' M W in T; lost = the largest part of a
   square by which it shrinks to that of S. The difference loses digits where the block lies in V nearly: the size
   is kept above rounding, and the next pass finds what is left. */
static void PassReduce(PetscInt n, PetscBool first, const PetscScalar products[], BlockPass *pass, PetscReal *lost)
{
  const PetscInt           m     = pass->m;
  const PetscScalar *const C     = pass->C;
  PetscScalar *const       G     = pass->T;
  PetscReal                moved = 0;

  *lost = 1;
  for (PetscInt j = 0; j < m; j++) {
    const PetscReal before = PetscMax(G[j * m + j], 0);

    if (first) pass->norm = PetscMax(pass->norm, PetscSqrtReal(before));
    for (PetscInt i = 0; i < m; i++)
      for (PetscInt k = 0; k < n; k++) G[j * m + i] -= products[i * n + k] * C[j * n + k];
    pass->size[j] = PetscSqrtReal(PetscMax(G[j * m + j], ROUNDING * before));
    if (pass->size[j] == 0) pass->size[j] = 1;
    moved = PetscMax(moved, before - G[j * m + j]);
    *lost = PetscMax(*lost, before / PetscSqr(pass->size[j]));
  }
  pass->clean = moved < 0.5 ? PETSC_TRUE : PETSC_FALSE;
  for (PetscInt j = 0; j < m; j++) {
    if (pass->size[j] < 0.7 || pass->size[j] > 1.4) pass->clean = PETSC_FALSE;
    for (PetscInt i = 0; i < m; i++) G[j * m + i] /= pass->size[i] * pass->size[j];
  }
}

/* U and D of G, which is left in T, and S; D is kept above ROUNDING of its largest, so that D^-1/2 is finite. All
   ranks have the decomposition of the first (GramEigen()). With SUMS eps lost / D_min the block is as near to
   orthonormal as `loose` asks for, and no further pass is made. */
static PetscErrorCode PassDecompose(MPI_Comm comm, PetscInt n, const BlockFactors *factors, BlockPass *pass)
{
  const PetscInt m = pass->m;
  PetscReal      lost;
  PetscScalar   *products;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(m * n, &products));
  PetscCall(PassProject(n, factors->gram, pass, products));
  PassReduce(n, pass->norm < 0 ? PETSC_TRUE : PETSC_FALSE, products, pass, &lost);
  PetscCall(PetscFree(products));
  PetscCall(GramEigen(comm, m, pass->T, pass->spread));
  if (m && pass->spread[0] < 0.5) pass->clean = PETSC_FALSE;
  for (PetscInt i = 0; i < m; i++)
    pass->spread[i] = PetscMax(pass->spread[i], ROUNDING * PetscMax(1, pass->spread[m - 1]));
  if (m && SUMS * PETSC_MACHINE_EPSILON * lost / pass->spread[0] <= factors->loose) pass->clean = PETSC_TRUE;
  PetscFunctionReturn(0);
}

/* C := C + C' R, R := T^-1 R in the columns of H [.][ld], C in rows 0 .. n - 1 and R behind them, so that V C + W R
   stays the block as it came; T from U, D and S for the block itself. */
static void PassAccumulate(PetscInt n, BlockPass *pass, BlockFactors *factors)
{
  const PetscInt           m = pass->m, ld = factors->ld;
  const PetscScalar *const C = pass->C;
  PetscScalar *const       U = pass->T;

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
}

/* W := (W - V C) T by the products of SLEPc */
static PetscErrorCode PassApplyMass(BV V, PetscInt n, BV W, BlockPass *pass)
{
  Mat C, T;

  PetscFunctionBeginUser;
  PetscCall(MatCreateSeqDense(PETSC_COMM_SELF, n, pass->m, pass->C, &C));
  PetscCall(MatCreateSeqDense(PETSC_COMM_SELF, pass->m, pass->m, pass->T, &T));
  if (n) PetscCall(BVSetActiveColumns(V, 0, n));
  if (n) PetscCall(BVMult(W, -1, 1, V, C));
  PetscCall(BVMultInPlace(W, T, 0, pass->m));
  PetscCall(MatDestroy(&C));
  PetscCall(MatDestroy(&T));
  pass->measured = PETSC_FALSE;
  PetscFunctionReturn(0);
}

/* The same, and where another pass will follow what it measures, so that V is read once for both */
static PetscErrorCode PassApply(BV V, PetscInt n, BV W, BlockPass *pass)
{
  const PetscBool    again = pass->clean ? PETSC_FALSE : PETSC_TRUE;
  PetscScalar *const C = pass->C, *const T = pass->T;
  Panel v, w;
  Mat   A, B;

  PetscFunctionBeginUser;
  PetscCall(PanelGet(W, &B, &w));
  v = (Panel){w.rows, 0, w.rows, NULL};
  if (n) PetscCall(BVSetActiveColumns(V, 0, n));
  if (n) PetscCall(PanelGet(V, &A, &v));
  PetscCall(PanelUpdate(&v, C, T, &w, again ? C : NULL, again ? T : NULL));
  if (n) PetscCall(PanelRestore(V, &A, &v));
  PetscCall(PanelRestore(W, &B, &w));
  pass->measured = PETSC_FALSE;
  if (again) PetscCall(PassSum(W, n, pass));
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
  pass->measured = PETSC_FALSE;
  for (PetscInt j = 0; j < pass->columns; j++) {
    PetscScalar *const R = factors->H + j * factors->ld + n;

    R[i]       = R[pass->m];
    R[pass->m] = 0;
  }
  if (i < pass->m) PetscCall(BVCopyColumn(W, pass->m, i));
  pass->size[i] = pass->size[pass->m];
  PetscFunctionReturn(0);
}

/* Leaves out directions that are rounding, rows of R below drop times the longest column of the block, and the
   smallest where there are more than there may be. */
static PetscErrorCode PassTrim(PetscInt n, BV W, BlockFactors *factors, BlockPass *pass)
{
  PetscFunctionBeginUser;
  PassRows(n, factors, pass);
  while (pass->m) {
    PetscInt smallest = 0;

    for (PetscInt i = 1; i < pass->m; i++)
      if (pass->size[i] < pass->size[smallest]) smallest = i;
    if (pass->norm > 0 && pass->m <= factors->most && pass->size[smallest] > factors->drop * pass->norm) break;
    PetscCall(PassDrop(n, smallest, W, factors, pass));
  }
  PetscCall(BVSetActiveColumns(W, 0, pass->m));
  PetscFunctionReturn(0);
}

/* Leaves out columns that are rounding before they are made directions with the help of others, as with a singular M
   those are of which it knows nothing: their parts beyond it would grow from pass to pass. A loose V is taken as
   orthonormal here */
static PetscErrorCode PassForget(PetscInt n, BV W, BlockFactors *factors, BlockPass *pass)
{
  PetscFunctionBeginUser;
  if (pass->norm < 0) PetscFunctionReturn(0); /* the first pass measures it */
  PassRows(n, factors, pass);
  for (PetscInt j = pass->m - 1; j >= 0; j--) {
    const PetscScalar *C      = &pass->C[j * n];
    PetscReal          square = pass->T[j * pass->m + j];

    for (PetscInt i = 0; i < n; i++) square -= C[i] * C[i];
    pass->spread[j] = pass->size[j] * PetscSqrtReal(PetscMax(square, 0)); /* work: its part of W */
  }
  for (PetscInt j = pass->m - 1; j >= 0; j--)
    if (pass->spread[j] <= factors->drop * pass->norm) PetscCall(PassDrop(n, j, W, factors, pass));
  PetscCall(BVSetActiveColumns(W, 0, pass->m));
  PetscFunctionReturn(0);
}

/* Whether [V W]'[V W] was measured to be the identity within `enough`; NaN is not */
static PetscBool PassIsNear(PetscInt n, const BlockPass *pass, PetscReal enough)
{
  for (PetscInt k = 0; k < pass->m * n; k++)
    if (!(PetscAbsReal(pass->C[k]) <= enough)) return PETSC_FALSE;
  for (PetscInt j = 0; j < pass->m; j++)
    for (PetscInt i = 0; i < pass->m; i++)
      if (!(PetscAbsReal(pass->T[j * pass->m + i] - (i == j ? 1 : 0)) <= enough)) return PETSC_FALSE;
  return PETSC_TRUE;
}

/* W := (W - V C) T with its factors */
static PetscErrorCode PassRun(BV V, PetscInt n, Mat M, BV W, BlockFactors *factors, BlockPass *pass)
{
  PetscFunctionBeginUser;
  if (!pass->measured) {
    if (M)
      PetscCall(PassMeasureMass(V, n, M, W, pass));
    else
      PetscCall(PassMeasure(V, n, W, pass));
  }
  PetscCall(PassForget(n, W, factors, pass));
  if (!pass->m) PetscFunctionReturn(0);
  if (!pass->measured) {
    if (M)
      PetscCall(PassMeasureMass(V, n, M, W, pass));
    else
      PetscCall(PassMeasure(V, n, W, pass));
  }
  PetscCall(PassDecompose(PetscObjectComm((PetscObject)W), n, factors, pass));
  PassAccumulate(n, pass, factors);
  if (M)
    PetscCall(PassApplyMass(V, n, W, pass));
  else
    PetscCall(PassApply(V, n, W, pass));
  if (pass->measured && PassIsNear(n, pass, factors->enough)) pass->clean = PETSC_TRUE;
  PetscCall(PassTrim(n, W, factors, pass));
  PetscFunctionReturn(0);
}

/* H begins as [0; I]: W = V 0 + W I. Directions may come out in another order than the columns. */
PetscErrorCode BlockFactorise(BV V, PetscInt n, Mat M, BV W, BlockFactors *factors)
{
  BlockPass pass = {.norm = -1, .clean = PETSC_FALSE};

  PetscFunctionBeginUser;
  PetscCall(BVGetActiveColumns(W, NULL, &pass.columns));
  pass.m = pass.columns;
  if (!pass.m) PetscFunctionReturn(0);
  PetscCall(PetscMalloc4(pass.m, &pass.size, pass.m, &pass.spread, pass.m, &pass.R, pass.m * (n + pass.m), &pass.C));
  for (PetscInt j = 0; j < pass.m; j++) {
    PetscCall(PetscArrayzero(factors->H + j * factors->ld, n + pass.m));
    factors->H[j * factors->ld + n + j] = 1;
  }
  for (int i = 0; i < PASSES && pass.m && !pass.clean; i++) PetscCall(PassRun(V, n, M, W, factors, &pass));
  PetscCall(PetscFree4(pass.size, pass.spread, pass.R, pass.C));
  PetscFunctionReturn(0);
}
