/*
   The next design: with z0 = own - w m', the free minimum,

      min 1/2 |z - z0|^2   for   A z <= b,   rows: the cuts, z <= upper, -z <= -lower

   by its dual, a problem with bounds alone, which TAO solves:

      min 1/2 mu' A A' mu + mu' (b - A z0),   mu >= 0,   z = z0 - A' mu

   Where the rows contradict each other the dual has no minimum; mu is kept below a limit then, so that z comes near to
   what they ask for.
*/
#include "designimpl.h"
#include <petsctao.h>

#define DUAL_LIMIT 1e4

/* A [rows][n], b [rows] of unit rows; the design's own numbers */
typedef struct {
  PetscInt   rows, n;
  PetscReal *A, *b, z0[CUBE_MAX_VARIABLES];
} Program;

/* z = z0 - A' mu */
static void ProgramPrimal(const Program *q, const PetscReal mu[], PetscReal z[])
{
  for (PetscInt k = 0; k < q->n; k++) z[k] = q->z0[k];
  for (PetscInt i = 0; i < q->rows; i++)
    for (PetscInt k = 0; k < q->n; k++) z[k] -= mu[i] * q->A[i * q->n + k];
}

/* f = 1/2 |z - z0|^2 + mu' (b - A z0), gradient b - A z */
static PetscErrorCode ProgramDual(Tao tao, Vec x, PetscReal *f, Vec gradient, void *ctx)
{
  const Program   *q = ctx;
  const PetscReal *mu;
  PetscReal       *g, z[CUBE_MAX_VARIABLES];

  PetscFunctionBeginUser;
  (void)tao;
  PetscCall(VecGetArrayRead(x, &mu));
  PetscCall(VecGetArrayWrite(gradient, &g));
  ProgramPrimal(q, mu, z);
  *f = 0;
  for (PetscInt k = 0; k < q->n; k++) *f += 0.5 * PetscSqr(z[k] - q->z0[k]);
  for (PetscInt i = 0; i < q->rows; i++) {
    PetscReal at_z0 = q->b[i];

    g[i] = q->b[i];
    for (PetscInt k = 0; k < q->n; k++) g[i] -= q->A[i * q->n + k] * z[k], at_z0 -= q->A[i * q->n + k] * q->z0[k];
    *f += mu[i] * at_z0;
  }
  PetscCall(VecRestoreArrayWrite(gradient, &g));
  PetscCall(VecRestoreArrayRead(x, &mu));
  PetscFunctionReturn(0);
}

static PetscErrorCode ProgramSolve(Program *q, PetscReal z[])
{
  const PetscReal *mu;
  Tao              tao;
  Vec              x, lower, upper;

  PetscFunctionBeginUser;
  PetscCall(VecCreateSeq(PETSC_COMM_SELF, q->rows, &x));
  PetscCall(VecDuplicate(x, &lower));
  PetscCall(VecDuplicate(x, &upper));
  PetscCall(VecSet(lower, 0));
  PetscCall(VecSet(upper, DUAL_LIMIT));
  PetscCall(TaoCreate(PETSC_COMM_SELF, &tao));
  PetscCall(TaoSetType(tao, TAOBLMVM));
  PetscCall(TaoSetSolution(tao, x));
  PetscCall(TaoSetVariableBounds(tao, lower, upper));
  PetscCall(TaoSetObjectiveAndGradient(tao, NULL, ProgramDual, q));
  PetscCall(TaoSetTolerances(tao, 1e-10, 0, 1e-12));
  PetscCall(TaoSetMaximumIterations(tao, 5000));
  PetscCall(TaoSetMaximumFunctionEvaluations(tao, 50000));
  PetscCall(TaoSolve(tao));
  PetscCall(VecGetArrayRead(x, &mu));
  ProgramPrimal(q, mu, z);
  PetscCall(VecRestoreArrayRead(x, &mu));
  PetscCall(TaoDestroy(&tao));
  PetscCall(VecDestroy(&x));
  PetscCall(VecDestroy(&lower));
  PetscCall(VecDestroy(&upper));
  PetscFunctionReturn(0);
}

/* Row i of the program becomes a' z <= b, scaled to |a| = 1 */
static void ProgramRow(Program *q, PetscInt i, const PetscReal a[], PetscReal b)
{
  PetscReal square = 0;

  for (PetscInt k = 0; k < q->n; k++) square += a[k] * a[k];
  for (PetscInt k = 0; k < q->n; k++) q->A[i * q->n + k] = square > 0 ? a[k] / PetscSqrtReal(square) : 0;
  q->b[i] = square > 0 ? b / PetscSqrtReal(square) : 0;
}

PetscErrorCode DesignStep(Design d, const PetscReal from[], PetscReal radius, PetscReal z[])
{
  const PetscInt n = d->cube.n;
  Program        q = {.rows = d->n_cuts + 2 * n, .n = n};
  PetscReal      a[CUBE_MAX_VARIABLES];

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(q.rows * n, &q.A, q.rows, &q.b));
  for (PetscInt k = 0; k < n; k++) q.z0[k] = d->cube.own[k] - d->mass_weight * d->mass_slope[k];
  for (PetscInt i = 0; i < d->n_cuts; i++) {
    const DesignCut *cut = &d->cut[i];
    PetscReal        b = -cut->a, size = 0;

    for (PetscInt k = 0; k < n; k++) b += cut->g[k] * cut->at[k], size += PetscSqr(cut->g[k]);
    ProgramRow(&q, i, cut->g, b - d->margin * PetscSqrtReal(size));
  }
  for (PetscInt k = 0; k < n; k++) {
    PetscCall(PetscArrayzero(a, n));
    a[k] = 1;
    ProgramRow(&q, d->n_cuts + 2 * k, a, PetscMin(1, from[k] + radius));
    a[k] = -1;
    ProgramRow(&q, d->n_cuts + 2 * k + 1, a, PetscMin(1, radius - from[k]));
  }
  PetscCall(ProgramSolve(&q, z));
  for (PetscInt k = 0; k < n; k++)
    z[k] = PetscMin(PetscMin(1, from[k] + radius), PetscMax(PetscMax(-1, from[k] - radius), z[k]));
  PetscCall(PetscFree2(q.A, q.b));
  PetscFunctionReturn(0);
}
