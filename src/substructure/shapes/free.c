/*
   Free interface: modes with nothing held, and what forces on the interface do beyond them,

      u = Phi eta + X f,   X = R E,   R = P (K - s M)^-1 P',   P = 1 - Phi Phi'M,

   E the unknown forces on the interface. u_b = Phi_b eta + S f, S = E'R E, tells f by u_b (Rubin):

      u = X S^-1 u_b + (Phi - X S^-1 Phi_b) eta.

   s = -(2 pi cut-off / 1e4)^2 makes free parts regular and changes what is above the cut-off by 1e-8, which is of the
   shapes alone: K_s and M_s are those of T.
*/
#include "substructure/substructureimpl.h"
#include "base/algebra/gram.h"
#include "base/algebra/product.h"
#include <petscblaslapack.h>

#define FREE_BLOCK 64   /* right-hand sides at once */
#define FREE_SHIFT 1e4  /* cut-off over the root of -s */
#define FREE_ALONE 1e-8 /* part of its own flexibility that an unknown must have beside the others */

/* Rows of the interface of a dense block, H [columns][n of the interface], on every rank */
static PetscErrorCode InterfaceRows(Substructure s, Mat X, PetscReal H[])
{
  const PetscInt     n = s->interface.n;
  const PetscScalar *x;
  PetscInt           columns, lda;

  PetscFunctionBeginUser;
  PetscCall(MatGetSize(X, NULL, &columns));
  PetscCall(MatDenseGetLDA(X, &lda));
  PetscCall(PetscArrayzero(H, (size_t)n * columns));
  PetscCall(MatDenseGetArrayRead(X, &x));
  for (PetscInt k = 0; k < n; k++) {
    const PetscInt row = s->interface.row[k].row - s->body.first;

    if (row < 0 || row >= s->body.n_own) continue;
    for (PetscInt j = 0; j < columns; j++) H[(size_t)j * n + k] = x[(size_t)j * lda + row];
  }
  PetscCall(MatDenseRestoreArrayRead(X, &x));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, H, (PetscMPIInt)(n * columns), MPIU_REAL, MPI_SUM, s->comm));
  PetscFunctionReturn(0);
}

/* X into the columns of the interface in T, and S [n][n] */
static PetscErrorCode FreeApplyResidual(Substructure s, Mat Phi, Mat MPhi, PetscReal S[])
{
  const PetscInt N     = s->interface.n;
  PencilMatrices whole = {.K = s->body.K, .M = s->body.M, .symmetric = PETSC_TRUE};
  ShiftInvert    inverse;

  PetscFunctionBeginUser;
  PetscCall(
    ShiftInvertCreate(&whole, -PetscSqr(2 * PETSC_PI * s->cutoff / FREE_SHIFT), PETSC_FALSE, &s->progress, &inverse));
  PetscCall(ProgressBegin(&s->progress, "residual flexibility, blocks", (N + FREE_BLOCK - 1) / FREE_BLOCK));
  for (PetscInt first = 0, n; first < N; first += n) {
    Mat B, X, columns;

    n = PetscMin(FREE_BLOCK, N - first);
    PetscCall(MatCreateDense(s->comm, s->body.n_own, PETSC_DECIDE, PETSC_DETERMINE, n, NULL, &B));
    PetscCall(BlockTakeColumns(s->interface.E, first, B));
    PetscCall(MatDuplicate(B, MAT_DO_NOT_COPY_VALUES, &X));
    PetscCall(BlockTakeOut(MPhi, Phi, B));
    PetscCall(ShiftInvertApplyBlock(&inverse, PETSC_FALSE, B, X));
    PetscCall(BlockTakeOut(Phi, MPhi, X));
    PetscCall(InterfaceRows(s, X, &S[(size_t)first * N]));
    PetscCall(MatDenseGetSubMatrix(s->T, PETSC_DECIDE, PETSC_DECIDE, first, first + n, &columns));
    PetscCall(MatCopy(X, columns, SAME_NONZERO_PATTERN));
    PetscCall(MatDenseRestoreSubMatrix(s->T, &columns));
    PetscCall(MatDestroy(&B));
    PetscCall(MatDestroy(&X));
    PetscCall(ProgressStep(&s->progress));
  }
  PetscCall(ProgressEnd(&s->progress));
  PetscCall(ShiftInvertDestroy(&inverse));
  PetscFunctionReturn(0);
}

/* S = L L' in its lower half; an error where an unknown of the interface has no flexibility beside the others */
static PetscErrorCode FreeFactor(Substructure s, PetscReal S[])
{
  const PetscInt n = s->interface.n;
  PetscBLASInt   size, info;
  PetscReal     *own, least = 1;

  PetscFunctionBeginUser;
  PetscCall(PetscBLASIntCast(n, &size));
  PetscCall(PetscMalloc1(n, &own));
  for (PetscInt j = 0; j < n; j++)
    for (PetscInt i = j; i < n; i++) S[(size_t)j * n + i] = 0.5 * (S[(size_t)j * n + i] + S[(size_t)i * n + j]);
  for (PetscInt k = 0; k < n; k++) own[k] = S[(size_t)k * n + k];
  PetscCallBLAS("LAPACKpotrf", LAPACKpotrf_("L", &size, S, &size, &info));
  for (PetscInt k = 0; k < n && !info; k++) least = PetscMin(least, PetscSqr(S[(size_t)k * n + k]) / own[k]);
  if (info) least = 0;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &least, 1, MPIU_REAL, MPI_MIN, s->comm));
  PetscCheck(
    least > FREE_ALONE, s->comm, PETSC_ERR_USER_INPUT,
    "-superelement_method free: beside %" PetscInt_FMT " modes below %.6g Hz the %" PetscInt_FMT
    " unknowns of the interface have no flexibility of their own; take fixed, a lower -superelement_cutoff, or "
    "sets of fewer nodes",
    s->n_modal, (double)s->cutoff, n);
  PetscCall(PetscFree(own));
  PetscFunctionReturn(0);
}

/* X S^-1 in the place of X */
static PetscErrorCode FreeTakeForces(Substructure s, const PetscReal S[])
{
  const PetscReal one = 1;
  PetscBLASInt    rows, n, lda;
  PetscInt        stride;
  PetscScalar    *t;

  PetscFunctionBeginUser;
  PetscCall(PetscBLASIntCast(s->body.n_own, &rows));
  PetscCall(PetscBLASIntCast(s->interface.n, &n));
  PetscCall(MatDenseGetLDA(s->T, &stride));
  PetscCall(PetscBLASIntCast(PetscMax(1, stride), &lda));
  PetscCall(MatDenseGetArray(s->T, &t));
  if (rows) {
    PetscCallBLAS("BLAStrsm", BLAStrsm_("R", "L", "T", "N", &rows, &n, &one, S, &n, t, &lda));
    PetscCallBLAS("BLAStrsm", BLAStrsm_("R", "L", "N", "N", &rows, &n, &one, S, &n, t, &lda));
  }
  PetscCall(MatDenseRestoreArray(s->T, &t));
  PetscFunctionReturn(0);
}

/* Phi - T_b Phi_b behind T_b */
static PetscErrorCode FreeAddModes(Substructure s, Mat Phi)
{
  const PetscInt N = s->interface.n;
  PetscReal     *rows;
  Mat            statics, modal;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1((size_t)N * s->n_modal, &rows));
  PetscCall(InterfaceRows(s, Phi, rows));
  PetscCall(MatDenseGetSubMatrix(s->T, PETSC_DECIDE, PETSC_DECIDE, 0, N, &statics));
  PetscCall(BlockAddProduct(-1, statics, rows, Phi));
  PetscCall(MatDenseRestoreSubMatrix(s->T, &statics));
  PetscCall(MatDenseGetSubMatrix(s->T, PETSC_DECIDE, PETSC_DECIDE, N, s->n, &modal));
  PetscCall(MatCopy(Phi, modal, SAME_NONZERO_PATTERN));
  PetscCall(MatDenseRestoreSubMatrix(s->T, &modal));
  PetscCall(PetscFree(rows));
  PetscFunctionReturn(0);
}

/* On the interface T is the unit matrix and zeros, but for rounding: exactly then */
static PetscErrorCode FreeMakeExact(Substructure s)
{
  PetscScalar *t;
  PetscInt     lda;

  PetscFunctionBeginUser;
  PetscCall(MatDenseGetLDA(s->T, &lda));
  PetscCall(MatDenseGetArray(s->T, &t));
  for (PetscInt k = 0; k < s->interface.n; k++) {
    const PetscInt row = s->interface.row[k].row - s->body.first;

    for (PetscInt j = 0; j < s->n && row >= 0 && row < s->body.n_own; j++) t[(size_t)j * lda + row] = j == k;
  }
  PetscCall(MatDenseRestoreArray(s->T, &t));
  PetscFunctionReturn(0);
}

PetscErrorCode FreeCreateBasis(Substructure s)
{
  MatrixModes modes;
  PetscReal  *S;
  Mat         Phi, MPhi;

  PetscFunctionBeginUser;
  PetscCall(MatrixModesSolve(s->comm, s->body.K, s->body.M, s->cutoff, &modes));
  PetscCall(TallCreate(s, modes.n));
  PetscCall(MatrixModesTake(s, &modes, s->body.node, &Phi));
  PetscCall(MatrixModesDestroy(&modes));
  PetscCall(MatDuplicate(Phi, MAT_DO_NOT_COPY_VALUES, &MPhi));
  PetscCall(BlockMultiply(s->body.M, Phi, MPhi));
  PetscCall(PetscMalloc1((size_t)s->interface.n * s->interface.n, &S));
  PetscCall(FreeApplyResidual(s, Phi, MPhi, S));
  PetscCall(FreeFactor(s, S));
  PetscCall(FreeTakeForces(s, S));
  PetscCall(FreeAddModes(s, Phi));
  PetscCall(FreeMakeExact(s));
  PetscCall(PetscFree(S));
  PetscCall(MatDestroy(&Phi));
  PetscCall(MatDestroy(&MPhi));
  PetscFunctionReturn(0);
}
