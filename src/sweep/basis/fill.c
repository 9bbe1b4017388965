/*
   Bases that need no choice of points: all unit vectors, for a small system, and, for comparison, the lowest real modes
   at one point, as complex modes of brakes usually are projected. They are those of the undamped system, either with
   the symmetric part of the stiffness K + mu H (Abaqus 2024, Analysis, "Complex Eigenvalue Extraction": "the eigenmodes
   of the undamped system with the symmetrized stiffness matrix must be extracted"), or without friction,

      (K + mu (H + H')/2) x = kappa M x      or      K x = kappa M x

   The symmetric part of one pair, k_n (N'N - mu (T'N + N'T)/2), has a negative eigenvalue, about -k_n mu^2 / 4: a pair
   stiffer than the bodies is an obstacle to other directions than N. No estimate of the error of the projection is to
   be had.
*/
#include "basis.h"
#include "base/algebra/dense.h"
#include "solver/block/orthonormal.h"
#include "solver/factor/shiftinvert.h"
#include <slepceps.h>

/* Unknowns up to which the basis is the whole space: so small a dense problem costs no more than one on a basis of
   a large mesh. */
#define WHOLE       200
#define BASIS_NAMES 600 /* vectors among which free modes are sought */
/* Relative residual of the real modes; far below the errors of the projection, which are to be compared. */
#define REAL_RTOL     1e-11
#define REAL_RESTARTS 200

PetscErrorCode BasisCreateModes(const Basis *basis, Modes modes, PetscInt n, PetscInt n_parts, BV *block)
{
  Vec      part[4], q;
  PetscInt m = 0;

  PetscFunctionBeginUser;
  PetscCall(BlockCreate(basis->space.V, n_parts * n, block));
  for (PetscInt i = 0; i < n; i++) {
    PetscCall(ModesGetVectors(modes, i, &part[0], &part[1], &part[2], &part[3]));
    for (int k = 0; k < n_parts; k++) {
      if (!part[k]) continue;
      PetscCall(BVGetColumn(*block, m, &q));
      PetscCall(PencilRestrict(basis->pencil, part[k], q));
      PetscCall(BVRestoreColumn(*block, m++, &q));
    }
  }
  PetscCall(BVSetActiveColumns(*block, 0, m));
  PetscFunctionReturn(0);
}

PetscErrorCode BasisKeepFree(const Basis *basis, Modes solver, const PetscReal p[])
{
  const PetscInt n = PetscMin(basis->reduced.n_used, BASIS_NAMES);
  Operators      operators;
  Vec           *v, q;

  PetscFunctionBeginUser;
  PetscCall(PencilSetParameters(basis->pencil, p));
  PetscCall(PencilGetOperators(basis->pencil, &operators));
  PetscCall(PetscMalloc1(n, &v));
  for (PetscInt i = 0; i < n; i++) {
    PetscCall(OperatorsCreateVec(operators, &v[i]));
    PetscCall(BVGetColumn(basis->space.V, i, &q));
    PetscCall(PencilExpand(basis->pencil, PETSC_FALSE, q, v[i]));
    PetscCall(BVRestoreColumn(basis->space.V, i, &q));
  }
  PetscCall(ModesKeepFree(solver, n, v));
  for (PetscInt i = 0; i < n; i++) PetscCall(VecDestroy(&v[i]));
  PetscCall(PetscFree(v));
  PetscFunctionReturn(0);
}

/* Names come from the shapes on the mesh: the complex coordinates of n modes are lifted as 4 n real columns in one
   product with V, which reads V once. */
PetscErrorCode BasisLabelModes(const Basis *basis, Modes solver, const PetscReal p[], const ReducedModes *modes,
                               char label[][32])
{
  const PetscInt n = modes->n;
  PetscReal     *columns;
  Vec           *shape;
  BV             block;

  PetscFunctionBeginUser;
  if (!n) PetscFunctionReturn(0);
  PetscCall(PetscMalloc2(4 * n * modes->size, &columns, 4 * n, &shape));
  DenseSplit(n * modes->size, modes->x, columns); /* xr, xi, yr, yi, [4 n][size] */
  DenseSplit(n * modes->size, modes->y, columns + 2 * n * modes->size);
  PetscCall(BlockCreate(basis->space.V, 4 * n, &block));
  PetscCall(BasisLift(basis, modes->size, 4 * n, columns, block));
  for (PetscInt i = 0; i < 4 * n; i++) {
    PetscCall(BVCreateVec(block, &shape[i]));
    PetscCall(BVCopyVec(block, i, shape[i]));
  }
  PetscCall(BVDestroy(&block));
  PetscCall(PencilSetParameters(basis->pencil, p));
  PetscCall(
    ModesLabelShapes(solver, &(ModesShapes){n, modes->rigid, shape, shape + n, shape + 2 * n, shape + 3 * n}, label));
  for (PetscInt i = 0; i < 4 * n; i++) PetscCall(VecDestroy(&shape[i]));
  PetscCall(PetscFree2(columns, shape));
  PetscFunctionReturn(0);
}

/* The model of all that the block holds; frees the block */
static PetscErrorCode BasisTake(Basis *basis, BV *block, PetscInt *n_added)
{
  PetscFunctionBeginUser;
  PetscCall(BasisAdd(basis, *block, 0, n_added));
  PetscCall(BasisUse(basis, basis->reduced.n));
  PetscCall(BVDestroy(block));
  PetscFunctionReturn(0);
}

/* Unit vectors are orthonormalised in M like any others; the model is then exact, and there is nothing to estimate.
   Not whole where M lets some of them vanish. */
PetscErrorCode BasisFillWhole(Basis *basis, PetscBool *whole)
{
  PetscInt n, first, last, n_added;
  Mat      unit;
  BV       block;

  PetscFunctionBeginUser;
  *whole = PETSC_FALSE;
  PetscCall(MatGetSize(basis->M, &n, NULL));
  if (n > WHOLE) PetscFunctionReturn(0);
  PetscCall(BlockCreate(basis->space.V, n, &block));
  PetscCall(MatGetOwnershipRange(basis->M, &first, &last));
  PetscCall(BVGetMat(block, &unit));
  PetscCall(MatZeroEntries(unit));
  for (PetscInt i = first; i < last; i++) PetscCall(MatSetValue(unit, i, i, 1, INSERT_VALUES));
  PetscCall(MatAssemblyBegin(unit, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(unit, MAT_FINAL_ASSEMBLY));
  PetscCall(BVRestoreMat(block, &unit));
  PetscCall(BasisTake(basis, &block, &n_added));
  *whole = n_added == n ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(0);
}

/* S = (A + A')/2, which is A itself where A is symmetric; a reference then, so that the caller destroys it in both
   cases. */
static PetscErrorCode SymmetricPart(Mat A, PetscBool symmetric, Mat *S)
{
  PetscFunctionBeginUser;
  if (symmetric) {
    *S = A;
    PetscCall(PetscObjectReference((PetscObject)A));
    PetscFunctionReturn(0);
  }
  PetscCall(MatTranspose(A, MAT_INITIAL_MATRIX, S));
  PetscCall(MatAXPY(*S, 1, A, DIFFERENT_NONZERO_PATTERN));
  PetscCall(MatScale(*S, 0.5));
  PetscCall(MatSetOption(*S, MAT_SYMMETRIC, PETSC_TRUE));
  PetscFunctionReturn(0);
}

/* The n_modes eigenvalues kappa, (rad/s)^2, next to the shift of a symmetric problem, with factors there. Ranks
   take the same decisions in the projected problem (SolverSynchronize()); fewer converged than asked for is an
   error, since the basis would silently be another one. */
static PetscErrorCode RealSolve(const PencilMatrices *m, PetscInt n_modes, ShiftInvert *si, EPS *eps)
{
  PetscInt n, n_found;
  DS       ds;
  ST       st;

  PetscFunctionBeginUser;
  PetscCall(MatGetSize(m->K, &n, NULL));
  n_modes = PetscMin(n_modes, n);
  PetscCall(EPSCreate(si->comm, eps));
  PetscCall(EPSSetOperators(*eps, m->K, m->M));
  PetscCall(EPSSetProblemType(*eps, EPS_GHEP));
  PetscCall(EPSSetDimensions(*eps, n_modes, PETSC_DEFAULT, PETSC_DEFAULT));
  PetscCall(EPSSetTolerances(*eps, REAL_RTOL, REAL_RESTARTS));
  PetscCall(EPSSetTarget(*eps, si->shift));
  PetscCall(EPSSetWhichEigenpairs(*eps, EPS_TARGET_MAGNITUDE));
  PetscCall(EPSGetDS(*eps, &ds));
  PetscCall(SolverSynchronize(ds));
  PetscCall(EPSGetST(*eps, &st));
  PetscCall(ShiftInvertAttach(si, PETSC_FALSE, st));
  PetscCall(EPSSolve(*eps));
  PetscCall(EPSGetConverged(*eps, &n_found));
  PetscCheck(n_found >= n_modes, si->comm, PETSC_ERR_NOT_CONVERGED,
             "-sweep_real_modes %" PetscInt_FMT ": %" PetscInt_FMT " converged; give fewer", n_modes, n_found);
  PetscFunctionReturn(0);
}

PetscErrorCode BasisFillReal(Basis *basis, PetscBool friction, PetscInt n_modes, PetscReal shift, Progress *progress)
{
  PencilMatrices pencil, real = {.symmetric = PETSC_TRUE};
  ShiftInvert    si;
  EPS            eps;
  BV             block;
  Vec            q;

  PetscFunctionBeginUser;
  if (friction)
    PetscCall(PencilGetMatrices(basis->pencil, &pencil));
  else
    PetscCall(PencilGetFrictionless(basis->pencil, &pencil));
  PetscCall(SymmetricPart(pencil.K, pencil.symmetric, &real.K));
  PetscCall(SymmetricPart(pencil.M, pencil.symmetric, &real.M));
  PetscCall(ShiftInvertCreate(&real, shift, PETSC_FALSE, progress, &si));
  PetscCall(RealSolve(&real, n_modes, &si, &eps));
  PetscCall(EPSGetDimensions(eps, &n_modes, NULL, NULL));
  PetscCall(BlockCreate(basis->space.V, n_modes, &block));
  for (PetscInt i = 0; i < n_modes; i++) {
    PetscCall(BVGetColumn(block, i, &q));
    PetscCall(EPSGetEigenvector(eps, i, q, NULL));
    PetscCall(BVRestoreColumn(block, i, &q));
  }
  PetscCall(BasisTake(basis, &block, NULL));
  PetscCall(EPSDestroy(&eps));
  PetscCall(ShiftInvertDestroy(&si));
  PetscCall(MatDestroy(&real.K));
  PetscCall(MatDestroy(&real.M));
  PetscFunctionReturn(0);
}
