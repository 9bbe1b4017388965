/*
   Modes of the separate bodies, K phi = omega^2 M phi below the cut-off, Phi' M Phi = I (phi in 1/sqrt(kg)): the
   pencil of the operators with every pair open and without damping, solved and proven complete by modes/. What it
   leaves out, damping, is projected exactly: C = Phi' C Phi, 1/s.

   Of bodies that a parameter has changed a little those modes are taken, as many, that resemble the ones of another
   reduction.
*/
#include "reduced/reducedimpl.h"
#include "solver/block/orthonormal.h"

/* Largest entry of |Phi' M Phi - I|: energies are sums of squares of coordinates, and are wrong by as much. */
#define ORTHONORMAL  1e-7
#define CUTOFF_NOISE 10 /* roundings of the largest K_ii / M_ii that the square of the cut-off exceeds */

/* Raises the error for a cut-off f whose (2 pi f)^2 is rounding: eigenvalues of K, M are right to some eps max K_ii
   / M_ii, (rad/s)^2. */
static PetscErrorCode ReducedCheckCutoff(ReducedRun r, const PencilMatrices *pencil)
{
  const PetscScalar *k, *m;
  PetscInt           n;
  PetscReal          largest = 0, least;
  Vec                K, M;

  PetscFunctionBeginUser;
  PetscCall(MatCreateVecs(pencil->K, &K, &M));
  PetscCall(MatGetDiagonal(pencil->K, K));
  PetscCall(MatGetDiagonal(pencil->M, M));
  PetscCall(VecGetLocalSize(K, &n));
  PetscCall(VecGetArrayRead(K, &k));
  PetscCall(VecGetArrayRead(M, &m));
  for (PetscInt i = 0; i < n; i++) largest = PetscMax(largest, m[i] > 0 ? k[i] / m[i] : 0);
  PetscCall(VecRestoreArrayRead(K, &k));
  PetscCall(VecRestoreArrayRead(M, &m));
  PetscCall(VecDestroy(&K));
  PetscCall(VecDestroy(&M));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &largest, 1, MPIU_REAL, MPI_MAX, r->comm));
  least = PetscSqrtReal(CUTOFF_NOISE * PETSC_MACHINE_EPSILON * largest) / (2 * PETSC_PI);
  PetscCheck(r->request.cutoff >= least, r->comm, PETSC_ERR_USER_INPUT,
             "-dynamics_cutoff %.6g Hz is too low: on this mesh frequencies below %.3g Hz are rounding; take one above "
             "the highest frequency of interest",
             (double)r->request.cutoff, (double)least);
  PetscFunctionReturn(0);
}

/* Raises the error for a cut-off without modes below it, or with all of them: counted by inertia before anything is
   solved. The end may move by 1e-4, off an eigenvalue. */
static PetscErrorCode ReducedCountModes(ReducedRun r, const PencilMatrices *pencil)
{
  PetscReal   omega = 2 * PETSC_PI * r->request.cutoff;
  PetscInt    n, n_unknowns;
  ShiftInvert counter;

  PetscFunctionBeginUser;
  PetscCall(MatGetSize(pencil->K, &n_unknowns, NULL));
  PetscCall(ShiftInvertCreate(pencil, omega * omega, PETSC_TRUE, &r->reduction.progress, &counter));
  PetscCall(ShiftInvertCountBelow(pencil, 1e-4, &counter, &omega, &n));
  PetscCall(ShiftInvertDestroy(&counter));
  PetscCheck(n > 0, r->comm, PETSC_ERR_USER_INPUT,
             "-dynamics_cutoff %.6g Hz: the unconnected bodies have no mode below it; take a higher one",
             (double)r->request.cutoff);
  PetscCheck(n < n_unknowns, r->comm, PETSC_ERR_USER_INPUT,
             "-dynamics_cutoff %.6g Hz: all %" PetscInt_FMT
             " modes lie below it, and no compliance is left for the pairs; "
             "take a lower one",
             (double)r->request.cutoff, n);
  PetscFunctionReturn(0);
}

PetscErrorCode ReducedWeighModes(ReducedRun r)
{
  Mat M;

  PetscFunctionBeginUser;
  PetscCall(PencilGetMass(r->reduction.bodies, &M));
  PetscCall(BlockMultiply(M, r->reduction.Phi, r->reduction.MPhi));
  PetscFunctionReturn(0);
}

/* Columns of A in the order of `chosen` [m] in its place */
static PetscErrorCode ColumnsKeep(PetscInt m, const PetscInt chosen[], Mat *A)
{
  PetscInt n_own;
  MPI_Comm comm;
  Mat      B;

  PetscFunctionBeginUser;
  PetscCall(PetscObjectGetComm((PetscObject)*A, &comm));
  PetscCall(MatGetLocalSize(*A, &n_own, NULL));
  PetscCall(MatCreateDense(comm, n_own, PETSC_DECIDE, PETSC_DETERMINE, m, NULL, &B));
  for (PetscInt k = 0; k < m; k++) {
    Vec from, to;

    PetscCall(MatDenseGetColumnVecRead(*A, chosen[k], &from));
    PetscCall(MatDenseGetColumnVecWrite(B, k, &to));
    PetscCall(VecCopy(from, to));
    PetscCall(MatDenseRestoreColumnVecWrite(B, k, &to));
    PetscCall(MatDenseRestoreColumnVecRead(*A, chosen[k], &from));
  }
  PetscCall(MatDestroy(A));
  *A = B;
  PetscFunctionReturn(0);
}

/* Keeps of all modes the m that hold most of the modes of `like`: share_i = sum_j (Phi'M Phi_like)_ij^2, negative
   for the ascending sort. Frequencies stay in ascending order, rigid modes in front. */
static PetscErrorCode ReducedKeepAlike(ReducedRun r)
{
  const PetscInt n = r->reduction.model.m, m = r->request.like->reduction.model.m;
  PetscInt      *order;
  PetscReal     *A, *share;

  PetscFunctionBeginUser;
  PetscCheck(n >= m, r->comm, PETSC_ERR_USER_INPUT,
             "-cycle_range: at one of its values the bodies have %" PetscInt_FMT
             " modes below %.6g Hz, fewer than the %" PetscInt_FMT
             " of the scene: take a range nearer to the value of the scene, which must not be 0",
             n, (double)r->request.cutoff, m);
  PetscCall(PetscMalloc3(n * m, &A, n, &share, n, &order));
  PetscCall(BlockGram(r->reduction.MPhi, r->request.like->reduction.Phi, A));
  for (PetscInt i = 0; i < n; i++) {
    order[i] = i;
    share[i] = 0;
    for (PetscInt j = 0; j < m; j++) share[i] -= PetscSqr(A[i + n * j]);
  }
  PetscCall(PetscSortRealWithArrayInt(n, share, order));
  PetscCall(PetscSortInt(m, order)); /* frequencies ascend again */
  for (PetscInt k = 0; k < m; k++) r->reduction.model.omega2[k] = r->reduction.model.omega2[order[k]];
  PetscCall(ColumnsKeep(m, order, &r->reduction.Phi));
  PetscCall(ColumnsKeep(m, order, &r->reduction.MPhi));
  r->reduction.model.m = m;
  PetscCall(PetscFree3(A, share, order));
  PetscFunctionReturn(0);
}

/* omega2 of a rigid mode is 0 exactly, whatever rounding its eigenvalue has. */
static PetscErrorCode ReducedTakeModes(ReducedRun r)
{
  const Mode *mode;
  PetscInt    m, n_own;
  Mat         M;

  PetscFunctionBeginUser;
  PetscCall(ModesGet(r->reduction.body_modes, &m, &mode));
  PetscCall(PencilGetMass(r->reduction.bodies, &M));
  PetscCall(MatGetLocalSize(M, &n_own, NULL));
  PetscCall(MatCreateDense(r->comm, n_own, PETSC_DECIDE, PETSC_DETERMINE, m, NULL, &r->reduction.Phi));
  PetscCall(PetscCalloc1(m, &r->reduction.model.omega2));
  for (PetscInt k = 0; k < m; k++) {
    Vec x, column;

    PetscCall(ModesGetVectors(r->reduction.body_modes, k, &x, NULL, NULL, NULL));
    PetscCall(MatDenseGetColumnVecWrite(r->reduction.Phi, k, &column));
    PetscCall(VecCopy(x, column));
    PetscCall(MatDenseRestoreColumnVecWrite(r->reduction.Phi, k, &column));
    r->reduction.model.omega2[k] = mode[k].rigid ? 0 : PetscSqr(mode[k].omega);
  }
  r->reduction.model.m = m;
  PetscCall(MatDuplicate(r->reduction.Phi, MAT_DO_NOT_COPY_VALUES, &r->reduction.MPhi));
  PetscCall(ReducedWeighModes(r));
  PetscFunctionReturn(0);
}

/* Raises an error for vectors that are not orthonormal in M */
static PetscErrorCode ReducedCheckModes(ReducedRun r)
{
  const PetscInt m = r->reduction.model.m;
  PetscReal     *H;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(m * m, &H));
  PetscCall(BlockGram(r->reduction.Phi, r->reduction.MPhi, H));
  for (PetscInt i = 0; i < m * m; i++)
    r->reduction.orthonormal = PetscMax(r->reduction.orthonormal, PetscAbsReal(H[i] - (i % m == i / m)));
  PetscCall(PetscFree(H));
  PetscCheck(r->reduction.orthonormal < ORTHONORMAL, r->comm, PETSC_ERR_PLIB,
             "modes of the bodies are orthonormal to %.2e only", (double)r->reduction.orthonormal);
  PetscFunctionReturn(0);
}

/* Phi'C Phi, 1/s, symmetric to the last bit: sums over ranks are not, and steps take C as symmetric. */
static PetscErrorCode ReducedSetDamping(ReducedRun r)
{
  const PetscInt m = r->reduction.model.m;
  Mat            C, CPhi;

  PetscFunctionBeginUser;
  PetscCall(OperatorsGetBodies(r->run.operators, r->request.p, NULL, NULL, &C));
  if (!C) PetscFunctionReturn(0);
  PetscCall(MatDuplicate(r->reduction.Phi, MAT_DO_NOT_COPY_VALUES, &CPhi));
  PetscCall(BlockMultiply(C, r->reduction.Phi, CPhi));
  PetscCall(PetscMalloc1(m * m, &r->reduction.model.C));
  PetscCall(BlockGram(r->reduction.Phi, CPhi, r->reduction.model.C));
  ReducedSymmetrise(m, r->reduction.model.C);
  PetscCall(MatDestroy(&CPhi));
  PetscFunctionReturn(0);
}

/* Collective. The solver of the modes is kept with its vectors; of its band 0 to the cut-off all modes are known to
   be found, by count. */
PetscErrorCode ReducedFindModes(ReducedRun r)
{
  const PetscReal band[2] = {0, r->request.cutoff};
  PencilMatrices  pencil;

  PetscFunctionBeginUser;
  PetscCall(OperatorsLineariseBodies(r->run.operators, r->request.p, PETSC_FALSE, &r->reduction.bodies));
  PetscCall(PencilGetMatrices(r->reduction.bodies, &pencil));
  PetscCheck(!pencil.C, r->comm, PETSC_ERR_PLIB, "modes of the bodies see damping");
  PetscCall(ReducedCheckCutoff(r, &pencil));
  PetscCall(ReducedCountModes(r, &pencil));
  PetscCall(ModesCreate(r->comm, &r->reduction.body_modes));
  PetscCall(ModesSetPencil(r->reduction.body_modes, r->reduction.bodies));
  PetscCall(ModesSetBand(r->reduction.body_modes, band));
  PetscCall(ModesSolve(r->reduction.body_modes));
  PetscCall(ReducedTakeModes(r));
  if (r->request.like) PetscCall(ReducedKeepAlike(r));
  PetscCall(ReducedCheckModes(r));
  PetscCall(ReducedSetDamping(r));
  PetscFunctionReturn(0);
}
