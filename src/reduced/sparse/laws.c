/*
   The laws of the pairs on a compliance without numbers (sparse.h). Damped forces q on the residual obey A q = b,
   solved by conjugate gradients with W^-1 in the place of A^-1: A is W and a little where the damping of the bodies is
   a part beta of their stiffness, the same for all or not.
*/
#include "base/algebra/copies.h"
#include "sparse.h"

#define LAG_RTOL   1e-14 /* of the residual of q, in the norm of b */
#define LAG_ENOUGH 1e-12 /* the same, where rounding leaves more */
#define LAG_MAX_IT 30
#define LAG_PROBES 3 /* power of W by which the share is found */

/* y := A x = W x / 2 + Cx x / dt - Cm'F Cm x / dt^2, F that of the coordinates */
static PetscErrorCode LagTimes(SparseLaws l, const PetscReal x[], PetscReal y[])
{
  const ReducedStepper s = l->stepper;
  const PetscInt       m = s->model->m, n = 3 * s->model->n_pairs;

  PetscFunctionBeginUser;
  PetscCall(SparseTimes(l->sparse, x, y, l->c));
  for (PetscInt i = 0; i < n; i++) y[i] = 0.5 * y[i] + l->c[i] / s->dt;
  PetscCall(PetscArrayzero(l->g, m));
  PetscCall(PetscArrayzero(l->z, 2 * m));
  ReducedBlockTimes(&(DenseBlock){s->model->Cm, m, n, m}, PETSC_FALSE, 1 / PetscSqr(s->dt), x, l->g);
  ReducedBlockTimes(&(DenseBlock){s->F, 2 * m, m, 2 * m}, PETSC_FALSE, 1, l->g, l->z);
  ReducedBlockTimes(&(DenseBlock){s->model->Cm, m, n, m}, PETSC_TRUE, -1, l->z, y);
  PetscFunctionReturn(0);
}

static PetscErrorCode LagMult(Mat A, Vec from, Vec to)
{
  SparseLaws       l;
  const PetscReal *x;
  PetscReal       *y;

  PetscFunctionBeginUser;
  PetscCall(MatShellGetContext(A, &l));
  PetscCall(VecGetArrayRead(from, &x));
  PetscCall(VecGetArray(to, &y));
  PetscCall(LagTimes(l, x, y));
  PetscCall(VecRestoreArray(to, &y));
  PetscCall(VecRestoreArrayRead(from, &x));
  PetscFunctionReturn(0);
}

static PetscErrorCode LagPress(PC pc, Vec from, Vec to)
{
  SparseLaws       l;
  const PetscReal *x;
  PetscReal       *y;

  PetscFunctionBeginUser;
  PetscCall(PCShellGetContext(pc, &l));
  PetscCall(VecGetArrayRead(from, &x));
  PetscCall(VecGetArray(to, &y));
  PetscCall(SparseHoldPress(&l->all, x, y));
  PetscCall(VecRestoreArray(to, &y));
  PetscCall(VecRestoreArrayRead(from, &x));
  PetscFunctionReturn(0);
}

/* x := A^-1 b from the guess x, to rounding: what is left is relative to b */
static PetscErrorCode LagSolve(SparseLaws l, const PetscReal b[], PetscReal x[])
{
  const PetscInt n = 3 * l->stepper->model->n_pairs;
  PetscReal      left, size;
  Mat            A;
  KSP            ksp;
  PC             pc;
  Vec            right, solution;

  PetscFunctionBeginUser;
  PetscCall(VecCreateSeqWithArray(PETSC_COMM_SELF, 1, n, b, &right));
  PetscCall(VecCreateSeqWithArray(PETSC_COMM_SELF, 1, n, x, &solution));
  PetscCall(VecNorm(right, NORM_2, &size));
  if (size == 0) PetscCall(VecSet(solution, 0)); /* to which the guess would be no answer */
  PetscCall(MatCreateShell(PETSC_COMM_SELF, n, n, n, n, l, &A));
  PetscCall(MatShellSetOperation(A, MATOP_MULT, (void (*)(void))LagMult));
  PetscCall(KSPCreate(PETSC_COMM_SELF, &ksp));
  PetscCall(KSPSetOperators(ksp, A, A));
  PetscCall(KSPSetType(ksp, KSPCG));
  PetscCall(KSPSetNormType(ksp, KSP_NORM_UNPRECONDITIONED));
  PetscCall(KSPSetInitialGuessNonzero(ksp, PETSC_TRUE));
  PetscCall(KSPSetTolerances(ksp, LAG_RTOL, 0, PETSC_DEFAULT, LAG_MAX_IT));
  PetscCall(CopiesEndTogether(l->sparse->run->comm, ksp));
  PetscCall(KSPGetPC(ksp, &pc));
  PetscCall(PCSetType(pc, PCSHELL));
  PetscCall(PCShellSetContext(pc, l));
  PetscCall(PCShellSetApply(pc, LagPress));
  PetscCall(KSPSolve(ksp, right, solution));
  PetscCall(KSPGetResidualNorm(ksp, &left));
  PetscCallMPI(MPI_Bcast(x, (PetscMPIInt)n, MPIU_REAL, 0, l->sparse->run->comm));
  PetscCallMPI(MPI_Bcast(&left, 1, MPIU_REAL, 0, l->sparse->run->comm));
  PetscCheck(
    left <= LAG_ENOUGH * size, l->sparse->run->comm, PETSC_ERR_NOT_CONVERGED,
    "damped forces on what the modes leave out: residual %.2e of %.2e after %d iterations of conjugate gradients; "
    "raise -dynamics_dense, or take -dynamics_model full",
    (double)left, (double)size, LAG_MAX_IT);
  PetscCall(VecDestroy(&solution));
  PetscCall(VecDestroy(&right));
  PetscCall(KSPDestroy(&ksp));
  PetscCall(MatDestroy(&A));
  PetscFunctionReturn(0);
}

/* y += P'F P lambda / 2; G of the stepper holds F P / 2 */
static void LawsAddModes(SparseLaws l, const PetscReal lambda[], PetscReal y[])
{
  const ReducedStepper s = l->stepper;
  const PetscInt       m = s->model->m, n = 3 * s->model->n_pairs;

  for (PetscInt k = 0; k < 2 * m; k++) l->z[k] = 0;
  ReducedBlockTimes(&(DenseBlock){s->G, 2 * m, n, 2 * m}, PETSC_FALSE, 1, lambda, l->z);
  ReducedBlockTimes(&(DenseBlock){s->model->P, m, n, m}, PETSC_TRUE, 1, l->z, y);
}

/* q of forces lambda at t_{n+1}, A q = D lambda / 2, D = W - Cm'F P / dt, kept as the guess of the next one */
static PetscErrorCode LawsDelay(SparseLaws l, const PetscReal lambda[])
{
  const ReducedStepper s = l->stepper;
  const PetscInt       m = s->model->m, n = 3 * s->model->n_pairs;

  PetscFunctionBeginUser;
  PetscCall(SparseTimes(l->sparse, lambda, l->b, NULL));
  for (PetscInt i = 0; i < n; i++) l->b[i] *= 0.5;
  for (PetscInt k = 0; k < 2 * m; k++) l->z[k] = 0;
  ReducedBlockTimes(&(DenseBlock){s->G, 2 * m, n, 2 * m}, PETSC_FALSE, 1, lambda, l->z);
  ReducedBlockTimes(&(DenseBlock){s->model->Cm, m, n, m}, PETSC_TRUE, -1 / s->dt, l->z, l->b);
  PetscCall(LagSolve(l, l->b, l->q));
  PetscFunctionReturn(0);
}

PetscErrorCode SparseLawsFree(SparseLaws l, const PetscReal r[], const PetscReal g[], PetscReal dq[])
{
  const ReducedModel *model = l->stepper->model;
  const PetscInt      m = model->m, n = 3 * model->n_pairs;

  PetscFunctionBeginUser;
  PetscCall(SparseTimes(l->sparse, r, l->b, NULL));
  ReducedBlockTimes(&(DenseBlock){model->Cm, m, n, m}, PETSC_TRUE, 1, g, l->b);
  PetscCall(PetscArrayzero(dq, n));
  PetscCall(LagSolve(l, l->b, dq));
  PetscFunctionReturn(0);
}

PetscErrorCode SparseLawsDrag(SparseLaws l, const PetscReal lambda[], PetscReal q[], PetscReal next[])
{
  const ReducedStepper s = l->stepper;
  const PetscInt       m = s->model->m, n = 3 * s->model->n_pairs;

  PetscFunctionBeginUser;
  PetscCall(LawsDelay(l, lambda));
  PetscCall(PetscArraycpy(q, l->q, n));
  PetscCall(PetscArrayzero(l->g, m));
  ReducedBlockTimes(&(DenseBlock){s->model->Cm, m, n, m}, PETSC_FALSE, -1 / s->dt, q, l->g);
  ReducedBlockTimes(&(DenseBlock){s->F, 2 * m, m, 2 * m}, PETSC_FALSE, 1, l->g, next);
  PetscFunctionReturn(0);
}

/* Motions at t_{n+1} of forces lambda there */
static PetscErrorCode LawsMove(void *ctx, const PetscReal lambda[], PetscReal y[])
{
  const SparseLaws     l = ctx;
  const ReducedStepper s = l->stepper;

  PetscFunctionBeginUser;
  if (!s || !s->model->Cm) {
    PetscCall(SparseTimes(l->sparse, lambda, y, NULL));
  } else {
    const PetscInt m = s->model->m, n = 3 * s->model->n_pairs;

    PetscCall(LawsDelay(l, lambda));
    PetscCall(SparseTimes(l->sparse, l->q, y, NULL));
    PetscCall(PetscArrayzero(l->g, m));
    for (PetscInt k = 0; k < 2 * m; k++) l->z[k] = 0;
    ReducedBlockTimes(&(DenseBlock){s->model->Cm, m, n, m}, PETSC_FALSE, 1, l->q, l->g);
    ReducedBlockTimes(&(DenseBlock){s->F, 2 * m, m, 2 * m}, PETSC_FALSE, 1, l->g, l->z);
    ReducedBlockTimes(&(DenseBlock){s->model->P, m, n, m}, PETSC_TRUE, -1 / s->dt, l->z, y);
  }
  if (s) LawsAddModes(l, lambda, y);
  PetscFunctionReturn(0);
}

/* The same with W / (2 share) for D'A^-1 D / 2 */
static PetscErrorCode LawsMoveNearly(void *ctx, const PetscReal lambda[], PetscReal y[])
{
  const SparseLaws l = ctx;

  PetscFunctionBeginUser;
  PetscCall(SparseTimes(l->sparse, lambda, y, NULL));
  for (PetscInt i = 0; i < 3 * l->sparse->run->reduction.model.n_pairs; i++) y[i] /= 2 * l->share;
  if (l->stepper) LawsAddModes(l, lambda, y);
  PetscFunctionReturn(0);
}

static PetscErrorCode LawsHold(void *ctx, const PetscBool held[])
{
  const SparseLaws l = ctx;

  PetscFunctionBeginUser;
  PetscCall(SparseHoldSet(&l->pairs, held));
  for (PetscInt i = 0; i < 3 * l->sparse->run->reduction.model.n_pairs; i++) l->tau[i] = 2 * l->share * l->pairs.tau[i];
  PetscFunctionReturn(0);
}

/* Of W / (2 share) and the modes, whose f were multiplied by 2 share, with the springs */
static PetscErrorCode LawsPress(void *ctx, const PetscReal force[], PetscReal motion[])
{
  const SparseLaws l = ctx;

  PetscFunctionBeginUser;
  PetscCall(SparseHoldMove(&l->pairs, force, motion));
  for (PetscInt i = 0; i < 3 * l->sparse->run->reduction.model.n_pairs; i++) motion[i] /= 2 * l->share;
  PetscFunctionReturn(0);
}

/* 1/2 + x'Cx x / (dt x'W x) for a smooth x, W^k times numbers that are no mode of a symmetric scene */
static PetscErrorCode LawsSetShare(SparseLaws l)
{
  const PetscInt n     = 3 * l->sparse->run->reduction.model.n_pairs;
  PetscReal      power = 0, loss = 0, largest;

  PetscFunctionBeginUser;
  l->share = 0.5;
  if (!l->stepper || !l->stepper->model->Cm) PetscFunctionReturn(0);
  for (PetscInt i = 0; i < n; i++) l->a[i] = 1 + 0.3 * PetscSinReal((PetscReal)i);
  for (int k = 0; k < LAG_PROBES; k++) {
    PetscCall(SparseTimes(l->sparse, l->a, l->b, l->c));
    power = loss = largest = 0;
    for (PetscInt i = 0; i < n; i++) {
      power += l->a[i] * l->b[i];
      loss += l->a[i] * l->c[i];
      largest = PetscMax(largest, PetscAbsReal(l->b[i]));
    }
    for (PetscInt i = 0; i < n && largest > 0; i++) l->a[i] = l->b[i] / largest;
  }
  if (power > 0) l->share += loss / (power * l->stepper->dt);
  PetscFunctionReturn(0);
}

/* f of the modes: what a force at t_{n+1} moves them, the diagonal of F / 2 */
PetscErrorCode SparseLawsCreate(ReducedSparse sparse, ReducedStepper stepper, SparseLaws *laws)
{
  const ReducedModel *model = &sparse->run->reduction.model;
  const PetscInt      n = 3 * model->n_pairs, m = model->m;
  SparseLaws          l;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(laws));
  l          = *laws;
  l->sparse  = sparse;
  l->stepper = stepper;
  PetscCall(PetscCalloc7(n, &l->q, n, &l->a, n, &l->b, n, &l->c, n, &l->tau, 2 * m, &l->g, 2 * m, &l->z));
  PetscCall(LawsSetShare(l));
  PetscCall(SparseHoldCreate(sparse, &l->pairs));
  for (PetscInt k = 0; k < m && stepper; k++) l->pairs.f[k] = l->share * stepper->F[k + 2 * m * k];
  if (!stepper || !model->Cm) PetscFunctionReturn(0);
  PetscCall(SparseHoldCreate(sparse, &l->all));
  PetscCall(SparseHoldSet(&l->all, NULL));
  PetscFunctionReturn(0);
}

void SparseLawsGetMap(SparseLaws l, ComplianceMap *map)
{
  *map = (ComplianceMap){
    l->sparse->run->comm, l, l->sparse->kappa, l->tau, LawsMove, LawsMoveNearly, LawsHold, LawsPress};
}

PetscErrorCode SparseLawsDestroy(SparseLaws *laws)
{
  SparseLaws l = *laws;

  PetscFunctionBeginUser;
  if (!l) PetscFunctionReturn(0);
  PetscCall(SparseHoldDestroy(&l->pairs));
  PetscCall(SparseHoldDestroy(&l->all));
  PetscCall(PetscFree7(l->q, l->a, l->b, l->c, l->tau, l->g, l->z));
  PetscCall(PetscFree(*laws));
  PetscFunctionReturn(0);
}
