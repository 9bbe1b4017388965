/*
   Iteration of the block eigensolver, see block/krylov.h. The decomposition is in block/space.c. At every look the
   projected problem G is brought to sorted Schur form T = Q' G Q, and eigenpairs of T, (theta, x = Q s), converge in
   order by the residual |B x|, B the last rows of G. A full space is restarted: converged Schur vectors are locked, and
   most of the others stay.

   A look costs about as much as a few solves. The next one is taken where the residuals, which fall faster and faster,
   would arrive at the tolerance if they went on as between the last two looks, or before.
*/
#include "iterate.h"

#define LOOK_EARLY  0.6  /* of the way that is left by the last rate */
#define LOOK_RARELY 0.25 /* of the columns so far: longest way to the next look */
/* of the others at a restart: on the default brake with 112 columns 0.5, 0.7, 0.8 take 400, 384, 376 solves */
#define RESTART_KEEP 0.8
/* An eigenvalue is off by less than so many times its residual: of a normal operator by once, of others by the
   condition of the eigenvalue. */
#define REACH_TRUST 100

/* Sorted Schur form T = Q' G Q of the projected problem, the first `locked` columns of which are there already.
   Rank 0's G is that of all ranks, and of a symmetric problem the symmetric part: Ritz values decide what is
   collective, and must be alike to the last bit. */
static PetscErrorCode BlockKrylovProject(EPS eps, PetscInt locked)
{
  EPS_BlockKrylov  *ctx = eps->data;
  const BlockSpace *s   = &ctx->space;
  const PetscInt    ld  = s->ncv + s->block;
  PetscInt          stride;
  PetscScalar      *A, *Q;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Bcast(s->G, (PetscMPIInt)(s->m * ld), MPIU_SCALAR, 0, PetscObjectComm((PetscObject)eps)));
  PetscCall(DSSetDimensions(eps->ds, s->m, locked, locked));
  PetscCall(DSGetLeadingDimension(eps->ds, &stride));
  PetscCall(DSGetArray(eps->ds, DS_MAT_A, &A));
  for (PetscInt j = 0; j < s->m; j++)
    for (PetscInt i = 0; i < s->m; i++)
      A[j * stride + i] = eps->ishermitian ? 0.5 * (s->G[j * ld + i] + s->G[i * ld + j]) : s->G[j * ld + i];
  PetscCall(DSRestoreArray(eps->ds, DS_MAT_A, &A));
  PetscCall(DSGetArray(eps->ds, DS_MAT_Q, &Q)); /* DSSolve() leaves its columns before `locked` as they are */
  PetscCall(PetscArrayzero(Q, stride * stride));
  for (PetscInt j = 0; j < s->m; j++) Q[j * stride + j] = 1;
  PetscCall(DSRestoreArray(eps->ds, DS_MAT_Q, &Q));
  PetscCall(DSSetState(eps->ds, DS_STATE_RAW));
  PetscCall(DSSolve(eps->ds, eps->eigr, eps->eigi));
  PetscCall(DSSort(eps->ds, eps->eigr, eps->eigi, NULL, NULL, NULL));
  PetscCall(DSSynchronize(eps->ds, eps->eigr, eps->eigi));
  PetscFunctionReturn(0);
}

/* Residual of eigenpair k and of its conjugate, *next - 1. Where the space is closed it is rounding of what is largest
   in it, so that a small eigenvalue converges when the larger ones are locked. */
static PetscErrorCode BlockKrylovResidual(EPS eps, PetscInt locked, PetscInt k, PetscInt *next, PetscReal *residual)
{
  const BlockSpace *s      = &((EPS_BlockKrylov *)eps->data)->space;
  PetscInt          last   = k, stride;
  PetscReal         second = 0;
  PetscScalar      *X;

  PetscFunctionBegin;
  PetscCall(DSVectors(eps->ds, DS_MAT_X, &last, NULL));
  PetscCall(DSGetLeadingDimension(eps->ds, &stride));
  PetscCall(DSGetArray(eps->ds, DS_MAT_X, &X));
  if (last > k) second = BlockSpaceResidual(s, X + last * stride);
  *residual = SlepcAbsEigenvalue(BlockSpaceResidual(s, X + k * stride), second);
  PetscCall(DSRestoreArray(eps->ds, DS_MAT_X, &X));
  if (!s->p) *residual = PETSC_MACHINE_EPSILON * SlepcAbsEigenvalue(eps->eigr[locked], eps->eigi[locked]);
  *next = last + 1;
  PetscFunctionReturn(0);
}

/* Whether Ritz value k lies beyond the reach for certain */
static PetscErrorCode BlockKrylovIsBeyond(EPS eps, PetscInt k, PetscBool *beyond)
{
  const EPS_BlockKrylov *ctx = eps->data;
  PetscScalar            re = eps->eigr[k], im = eps->eigi[k];

  PetscFunctionBegin;
  *beyond = PETSC_FALSE;
  if (!(ctx->reach > 0) || !(REACH_TRUST * eps->errest[k] < 1)) PetscFunctionReturn(0);
  PetscCall(STBackTransform(eps->st, 1, &re, &im));
  if (SlepcAbsEigenvalue(re - eps->target, im) * (1 - REACH_TRUST * eps->errest[k]) > ctx->reach) *beyond = PETSC_TRUE;
  PetscFunctionReturn(0);
}

/* Counts the eigenvalues that have converged, in order, and finds the worst of those that are wanted: converged
   stops at the first that has not, though later ones have, so that none is left out. A conjugate pair is one step
   of the loop. */
static PetscErrorCode BlockKrylovConverge(EPS eps)
{
  EPS_BlockKrylov *ctx = eps->data;
  const PetscInt   m   = ctx->space.m;
  PetscBool        beyond;

  PetscFunctionBegin;
  ctx->converged = ctx->locked;
  ctx->worst     = 0;
  ctx->reached   = PETSC_FALSE;
  for (PetscInt k = ctx->locked, next; k < m && (k < eps->nev || k == ctx->converged); k = next) {
    PetscScalar re = eps->eigr[k], im = eps->eigi[k];
    PetscReal   residual;

    PetscCall(BlockKrylovResidual(eps, ctx->locked, k, &next, &residual));
    if (eps->conv == EPS_CONV_NORM) PetscCall(STBackTransform(eps->st, 1, &re, &im));
    PetscCall((*eps->converged)(eps, re, im, residual, &eps->errest[k], eps->convergedctx));
    if (next - k == 2) eps->errest[next - 1] = eps->errest[k];
    PetscCall(BlockKrylovIsBeyond(eps, k, &beyond));
    if (k == ctx->converged && beyond) ctx->reached = PETSC_TRUE;
    if (k == ctx->converged && eps->errest[k] < eps->tol) ctx->converged = next;
    if (beyond) break;
    if (k < eps->nev) ctx->worst = PetscMax(ctx->worst, eps->errest[k] / eps->tol);
  }
  PetscFunctionReturn(0);
}

/* Keeps the k converged Schur vectors and most of the others, not half a complex pair: keep at most what leaves
   room for the last block. Without a last block (p = 0) the space is invariant and goes on with random directions. */
static PetscErrorCode BlockKrylovRestart(EPS eps, PetscInt locked, PetscInt k)
{
  BlockSpace *s    = &((EPS_BlockKrylov *)eps->data)->space;
  PetscInt    keep = PetscMin((PetscInt)(RESTART_KEEP * (s->m - k)), s->ncv - s->p - k);
  Mat         Q, T;

  PetscFunctionBegin;
  if (!s->p) keep = 0;
  if (keep && !eps->ishermitian) PetscCall(DSGetTruncateSize(eps->ds, k, s->m, &keep));
  PetscCall(DSGetMat(eps->ds, DS_MAT_Q, &Q));
  PetscCall(DSGetMat(eps->ds, DS_MAT_A, &T));
  PetscCall(BlockSpaceRestart(s, locked, k, keep, Q, T));
  PetscCall(DSRestoreMat(eps->ds, DS_MAT_A, &T));
  PetscCall(DSRestoreMat(eps->ds, DS_MAT_Q, &Q));
  if (!s->p) PetscCall(BlockSpaceStart(s));
  PetscFunctionReturn(0);
}

/* Eigenvectors X = V (Q s) of the k converged */
static PetscErrorCode BlockKrylovVectors(EPS eps, PetscInt k)
{
  Mat X;

  PetscFunctionBegin;
  PetscCall(DSVectors(eps->ds, DS_MAT_X, NULL, NULL));
  PetscCall(DSGetMat(eps->ds, DS_MAT_X, &X));
  PetscCall(BVSetActiveColumns(eps->V, 0, ((EPS_BlockKrylov *)eps->data)->space.m));
  PetscCall(BVMultInPlace(eps->V, X, 0, k));
  PetscCall(DSRestoreMat(eps->ds, DS_MAT_X, &X));
  eps->nconv = k;
  PetscFunctionReturn(0);
}

/* The space is full, or there are no more directions */
static PetscBool BlockKrylovIsFull(const BlockSpace *s)
{
  return !s->p || s->m + s->p > s->ncv ? PETSC_TRUE : PETSC_FALSE;
}

/* Where the next look is taken: residuals fall by the factor before / worst over the n - seen columns since the
   last one, rate = its logarithm per column. worst is in units of the tolerance, so that log(worst) / rate columns
   are left; LOOK_EARLY of them are waited for, since the rate grows. */
static void BlockKrylovPlan(EPS_BlockKrylov *ctx, PetscReal before)
{
  const PetscInt  n    = ctx->space.applied;
  const PetscReal rate = ctx->seen > 0 && ctx->worst > 0 ? PetscLogReal(before / ctx->worst) / (n - ctx->seen) : 0;
  PetscReal       wait = LOOK_RARELY * n;

  if (rate > 0 && ctx->worst > 1) wait = PetscMin(wait, LOOK_EARLY * PetscLogReal(ctx->worst) / rate);
  ctx->seen = n;
  ctx->look = n + PetscMax(1, (PetscInt)wait);
}

/* The iteration ends by the test of SLEPc, by the reach, or where nothing is left; only a full space counts as an
   iteration. */
static PetscErrorCode BlockKrylovLook(EPS eps)
{
  EPS_BlockKrylov *ctx    = eps->data;
  BlockSpace      *s      = &ctx->space;
  const PetscReal  before = ctx->worst;
  const PetscBool  full   = BlockKrylovIsFull(s);

  PetscFunctionBegin;
  PetscCall(BlockKrylovProject(eps, ctx->locked));
  PetscCall(BlockKrylovConverge(eps));
  PetscCall(EPSMonitor(eps, ctx->its, ctx->converged, eps->eigr, eps->eigi, eps->errest, s->m));
  PetscCall((*eps->stopping)(eps, ctx->its - (full ? 0 : 1), eps->max_it, ctx->converged, eps->nev, &eps->reason,
                             eps->stoppingctx));
  if (eps->reason == EPS_CONVERGED_ITERATING && ctx->reached) eps->reason = EPS_CONVERGED_USER;
  if (eps->reason == EPS_CONVERGED_ITERATING && !s->p && ctx->converged == ctx->locked)
    eps->reason = EPS_DIVERGED_BREAKDOWN;
  BlockKrylovPlan(ctx, before);
  if (eps->reason != EPS_CONVERGED_ITERATING || !full) PetscFunctionReturn(0);
  PetscCall(BlockKrylovRestart(eps, ctx->locked, ctx->converged));
  ctx->locked = ctx->converged;
  ctx->its++;
  PetscFunctionReturn(0);
}

/* Begins the space */
static PetscErrorCode BlockKrylovBegin(EPS eps)
{
  EPS_BlockKrylov *ctx = eps->data;
  Mat              M   = NULL;

  PetscFunctionBegin;
  PetscCall(EPSSetUp(eps));
  if (eps->isgeneralized && eps->ispositive) PetscCall(STGetBilinearForm(eps->st, &M));
  PetscCall(BlockSpaceCreate(eps->st, eps->V, M, eps->ncv, ctx->block, &ctx->space));
  PetscCall(MatDestroy(&M));
  PetscCall(BlockSpaceStart(&ctx->space));
  ctx->locked = ctx->converged = ctx->seen = 0;
  ctx->its                                 = 1;
  ctx->look                                = eps->nev + eps->nev / 2;
  ctx->begun                               = PETSC_TRUE;
  eps->reason                              = EPS_CONVERGED_ITERATING;
  PetscFunctionReturn(0);
}

/* Whether the space can grow, and its solution has not ended */
static PetscBool BlockKrylovGrows(EPS eps)
{
  const EPS_BlockKrylov *ctx = eps->data;

  return eps->reason == EPS_CONVERGED_ITERATING && !BlockKrylovIsFull(&ctx->space) ? PETSC_TRUE : PETSC_FALSE;
}

/* Adds a block, also to the space of the transposed problem, and looks where it is time */
static PetscErrorCode BlockKrylovStep(EPS eps)
{
  EPS_BlockKrylov *const ctx = eps->data, *const other = ctx->other ? ctx->other->data : NULL;
  const PetscBool both = ctx->other && BlockKrylovGrows(ctx->other) ? PETSC_TRUE : PETSC_FALSE;

  PetscFunctionBegin;
  if (both)
    PetscCall(BlockSpaceExtendBoth(&ctx->space, &other->space, ctx->solve, ctx->solve_ctx));
  else if (BlockKrylovGrows(eps))
    PetscCall(BlockSpaceExtend(&ctx->space));
  if (ctx->space.applied >= ctx->look || BlockKrylovIsFull(&ctx->space)) PetscCall(BlockKrylovLook(eps));
  if (both && (other->space.applied >= other->look || BlockKrylovIsFull(&other->space)))
    PetscCall(BlockKrylovLook(ctx->other));
  PetscFunctionReturn(0);
}

/* The converged ones where a restart found no further direction: their Schur form is all that there is */
static PetscErrorCode BlockKrylovExhaust(EPS eps, PetscInt k)
{
  PetscFunctionBegin;
  eps->reason = EPS_DIVERGED_BREAKDOWN;
  if (!k) PetscFunctionReturn(0);
  PetscCall(BlockKrylovProject(eps, 0));
  PetscCall(BlockKrylovVectors(eps, k));
  PetscFunctionReturn(0);
}

PetscErrorCode BlockKrylovEnd(EPS eps)
{
  EPS_BlockKrylov *ctx = eps->data;

  PetscFunctionBegin;
  if (ctx->begun) PetscCall(BlockSpaceDestroy(&ctx->space));
  ctx->begun = PETSC_FALSE;
  PetscFunctionReturn(0);
}

/* An iteration fills the space once. A space that has grown beside another goes on, or ends, from where it is. */
PetscErrorCode BlockKrylovIterate(EPS eps)
{
  EPS_BlockKrylov *ctx  = eps->data;
  const PetscBool  goes = ctx->begun;

  PetscFunctionBegin;
  if (!goes) PetscCall(BlockKrylovBegin(eps));
  if (ctx->other && !((EPS_BlockKrylov *)ctx->other->data)->begun) PetscCall(BlockKrylovBegin(ctx->other));
  eps->reason = EPS_CONVERGED_ITERATING;
  if (goes && ctx->space.m > ctx->locked) PetscCall(BlockKrylovLook(eps));
  while (eps->reason == EPS_CONVERGED_ITERATING && ctx->space.p) PetscCall(BlockKrylovStep(eps));
  if (eps->reason == EPS_CONVERGED_ITERATING)
    PetscCall(BlockKrylovExhaust(eps, ctx->converged));
  else
    PetscCall(BlockKrylovVectors(eps, ctx->converged));
  eps->its = ctx->its;
  PetscCall(BlockKrylovEnd(eps));
  PetscFunctionReturn(0);
}
