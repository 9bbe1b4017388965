/*
   What the modes leave out: R = (1 - Phi Phi'M) (K - s M)^-1 (1 - M Phi Phi'), W = V'R V, m/N; s in (rad/s)^2. The
   right-hand sides lose the modes before the solution and the solutions after it, so that neither the shift nor the
   modes that are nearly free show by rounding. s = -(2 pi cut-off / 1e4)^2: of what lies above the cut-off it
   changes 1e-8 at most, and free bodies are regular. Where displacements follow others, u = Z q, Z (Z'(K - s M)
   Z)^-1 Z' stands for the inverse, and Phi = Z times the modes of q: all else is of all unknowns.

   With X = R V of the pairs also Cm = Phi'D X, Cx = X'D X and Mx = X'M X of the damping D and the mass M, and the same
   of parts with branches in place of D; X'D X = V'R D X costs a second solution per column but no room for all of X.
*/
#include "reduced/reducedimpl.h"
#include "solver/block/orthonormal.h"

/* Right-hand sides at once: the factors are read once for all of them. */
#define RESIDUAL_BLOCK 64
#define RESIDUAL_SHIFT 1e4 /* cut-off over the root of -s */

PetscErrorCode ReducedApplyResidual(ReducedRun r, Mat B, Mat X)
{
  Mat Z;

  PetscFunctionBeginUser;
  PetscCall(OperatorsGetDependents(r->run.operators, &Z, NULL));
  PetscCall(BlockTakeOut(r->reduction.MPhi, r->reduction.Phi, B));
  PetscCall(ShiftInvertApplyThrough(&r->reduction.inverse, Z, B, X));
  PetscCall(BlockTakeOut(r->reduction.Phi, r->reduction.MPhi, X));
  PetscFunctionReturn(0);
}

/* Columns first .. of V as the dense B: of G' and of the others */
static PetscErrorCode PortsGetColumns(ReducedRun r, Mat Gt, PetscInt first, Mat B)
{
  const PetscInt     n_pairs = 3 * r->reduction.model.n_pairs;
  PetscInt           n_own, n, stride, ldo;
  PetscScalar       *b;
  const PetscScalar *o;

  PetscFunctionBeginUser;
  PetscCall(BlockTakeColumns(Gt, first, B));
  PetscCall(MatGetLocalSize(B, &n_own, NULL));
  PetscCall(MatGetSize(B, NULL, &n));
  PetscCall(MatDenseGetLDA(B, &stride));
  PetscCall(MatDenseGetLDA(r->reduction.others, &ldo));
  PetscCall(MatDenseGetArray(B, &b));
  PetscCall(MatDenseGetArrayRead(r->reduction.others, &o));
  for (PetscInt k = PetscMax(first, n_pairs); k < first + n; k++)
    PetscCall(PetscArraycpy(&b[(k - first) * stride], &o[(k - n_pairs) * ldo], n_own));
  PetscCall(MatDenseRestoreArrayRead(r->reduction.others, &o));
  PetscCall(MatDenseRestoreArray(B, &b));
  PetscFunctionReturn(0);
}

/* Columns first .. of A [N] from X: V'X. Rows of pairs are those of this rank, zero elsewhere, and are summed over
   the ranks; those of the others, where N has them, are sums already. */
static PetscErrorCode ResidualTake(ReducedRun r, Mat X, PetscInt first, PetscInt N, PetscReal A[])
{
  const PetscInt     n_others = N - 3 * r->reduction.model.n_pairs;
  const PetscScalar *value;
  PetscReal         *H;
  PetscInt           n, stride;
  Mat                GX;

  PetscFunctionBeginUser;
  PetscCall(MatGetSize(X, NULL, &n));
  PetscCall(MatMatMult(r->reduction.G, X, MAT_INITIAL_MATRIX, PETSC_DEFAULT, &GX));
  PetscCall(MatDenseGetLDA(GX, &stride));
  PetscCall(MatDenseGetArrayRead(GX, &value));
  for (PetscInt k = 0; k < n; k++)
    for (PetscInt i = 0; i < 3 * r->reduction.n_local; i++)
      A[(first + k) * N + 3 * r->reduction.begin + i] = value[k * stride + i];
  PetscCall(MatDenseRestoreArrayRead(GX, &value));
  PetscCall(MatDestroy(&GX));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &A[first * N], (PetscMPIInt)(n * N), MPIU_REAL, MPI_SUM, r->comm));
  if (!n_others) PetscFunctionReturn(0);
  PetscCall(PetscMalloc1(n_others * n, &H));
  PetscCall(BlockGram(r->reduction.others, X, H));
  for (PetscInt k = 0; k < n; k++)
    PetscCall(PetscArraycpy(&A[(first + k) * N + N - n_others], &H[k * n_others], n_others));
  PetscCall(PetscFree(H));
  PetscFunctionReturn(0);
}

/* X of the columns first .. of V, and work of its size */
typedef struct {
  PetscInt first;
  Mat      X, B, Y;
} ResidualColumns;

/* Columns of A = X'D X = V'R D X from X of pairs, and of Phi'D X, or NULL */
static PetscErrorCode ResidualTakeForm(ReducedRun r, Mat D, const ResidualColumns *c, PetscReal A[], PetscReal mixed[])
{
  PetscFunctionBeginUser;
  if (!A) PetscFunctionReturn(0);
  PetscCall(BlockMultiply(D, c->X, c->B));
  if (mixed) PetscCall(BlockGram(r->reduction.Phi, c->B, &mixed[c->first * r->reduction.model.m]));
  PetscCall(ReducedApplyResidual(r, c->B, c->Y));
  PetscCall(ResidualTake(r, c->Y, c->first, 3 * r->reduction.model.n_pairs, A));
  PetscFunctionReturn(0);
}

/* Columns first .. first + n - 1 of all that is made of V */
static PetscErrorCode ResidualBlock(ReducedRun r, Mat Gt, const Mat form[2], const PencilLaw law[], PetscInt first,
                                    PetscInt n)
{
  const PetscInt  N = r->reduction.model.n_ports;
  PetscInt        n_own;
  ResidualColumns c = {.first = first};

  PetscFunctionBeginUser;
  PetscCall(MatGetLocalSize(Gt, &n_own, NULL));
  PetscCall(MatCreateDense(r->comm, n_own, PETSC_DECIDE, PETSC_DETERMINE, n, NULL, &c.B));
  PetscCall(PortsGetColumns(r, Gt, first, c.B));
  PetscCall(MatDuplicate(c.B, MAT_DO_NOT_COPY_VALUES, &c.X));
  PetscCall(ReducedApplyResidual(r, c.B, c.X));
  PetscCall(ResidualTake(r, c.X, r->reduction.model.sparse ? first - 3 * r->reduction.model.n_pairs : first, N,
                         r->reduction.model.W));
  if (first < 3 * r->reduction.model.n_pairs) {
    PetscCall(MatDuplicate(c.B, MAT_DO_NOT_COPY_VALUES, &c.Y));
    PetscCall(ResidualTakeForm(r, form[0], &c, r->reduction.model.Cx, r->reduction.model.Cm));
    PetscCall(ResidualTakeForm(r, form[1], &c, r->reduction.model.Mx, NULL));
    for (PetscInt i = 0; i < r->reduction.model.n_branches; i++)
      PetscCall(ResidualTakeForm(r, law[i].A, &c, r->reduction.model.branch[i].Sx, r->reduction.model.branch[i].Sm));
    PetscCall(MatDestroy(&c.Y));
  }
  PetscCall(MatDestroy(&c.B));
  PetscCall(MatDestroy(&c.X));
  PetscFunctionReturn(0);
}

/* Blocks end at the last port of a pair, since only those of pairs have Cm, Cx, Mx. W is whole on every rank; 2
   solutions per damped pair port, 3 with Mx. */
PetscErrorCode ReducedSetResidual(ReducedRun r)
{
  const PetscInt  N = r->reduction.model.n_ports, n_pairs = 3 * r->reduction.model.n_pairs;
  const PetscReal shift = -PetscSqr(2 * PETSC_PI * r->request.cutoff / RESIDUAL_SHIFT);
  PencilMatrices  pencil;
  PetscInt        n, begin;
  PetscBool       sparse;
  PencilLaw      *law;
  Mat             Gt, C, form[2]; /* damping, mass */

  PetscFunctionBeginUser;
  PetscCall(OperatorsGetBodies(r->run.operators, r->request.p, NULL, NULL, &C));
  form[0] = C;
  PetscCall(PencilGetMatrices(r->reduction.bodies, &pencil));
  PetscCall(PencilGetMass(r->reduction.bodies, &form[1]));
  PetscCall(ShiftInvertCreate(&pencil, shift, PETSC_FALSE, &r->reduction.progress, &r->reduction.inverse));
  PetscCall(ReducedIsSparse(r, &sparse));
  if (sparse) PetscCall(ReducedSparseCreate(r, shift, C));
  PetscCall(ReducedBranchesBegin(r, &law));
  begin = sparse ? n_pairs : 0;
  PetscCall(MatTranspose(r->reduction.G, MAT_INITIAL_MATRIX, &Gt));
  PetscCall(PetscCalloc1(N * (N - begin), &r->reduction.model.W));
  if (C && !sparse) PetscCall(PetscCalloc1(n_pairs * n_pairs, &r->reduction.model.Cx));
  if (C && !sparse) PetscCall(PetscCalloc1(n_pairs * r->reduction.model.m, &r->reduction.model.Cm));
  if (r->request.weighs && !sparse) PetscCall(PetscCalloc1(n_pairs * n_pairs, &r->reduction.model.Mx));
  PetscCall(ProgressBegin(&r->reduction.progress, "compliance of the ports, blocks",
                          (N - begin + RESIDUAL_BLOCK - 1) / RESIDUAL_BLOCK));
  for (PetscInt first = begin; first < N; first += n) {
    n = PetscMin(RESIDUAL_BLOCK, (first < n_pairs ? n_pairs : N) - first);
    PetscCall(ResidualBlock(r, Gt, form, law, first, n));
    PetscCall(ProgressStep(&r->reduction.progress));
  }
  PetscCall(ProgressEnd(&r->reduction.progress));
  PetscCall(MatDestroy(&Gt));
  PetscCall(ReducedBranchesEnd(r, &law));
  if (sparse) PetscFunctionReturn(0);
  ReducedSymmetrise(N, r->reduction.model.W);
  if (C) ReducedSymmetrise(n_pairs, r->reduction.model.Cx);
  if (r->request.weighs) ReducedSymmetrise(n_pairs, r->reduction.model.Mx);
  PetscFunctionReturn(0);
}
