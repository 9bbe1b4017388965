/*
   Block Krylov-Schur eigensolver, see blockkrylov.h: the type. The decomposition is in blockspace.c. At every look the
   projected problem G is brought to sorted Schur form T = Q' G Q, and eigenpairs of T, (theta, x = Q s), converge in
   order by the residual |B x|, B the last rows of G. A full space is restarted: converged Schur vectors are locked, and
   half of the others stay.
*/
#include "blockkrylov.h"
#include "blockspace.h"
#include <slepc/private/epsimpl.h>

/* Vectors in a block. On the default brake (36,453 unknowns, 51 modes with friction, right and left) blocks of 1, 4, 8, 16
   take 238, 296, 392, 560 solves, of 20, 6.6, 4.1, 3.1 ms */
#define BLOCK 8

typedef struct {
  PetscInt   size;  /* of a block, as given; 0: chosen */
  PetscInt   block; /* in use */
  BlockSpace space;
} EPS_BlockKrylov;

/* Sizes of the block and of the space: at a restart there must be room for the eigenvalues asked for and two blocks */
static PetscErrorCode BlockKrylovSizes(EPS eps)
{
  EPS_BlockKrylov *ctx   = eps->data;
  const PetscInt   block = PetscMin(ctx->size ? ctx->size : BLOCK, eps->n);

  PetscFunctionBegin;
  PetscCheck(ctx->size <= eps->n, PetscObjectComm((PetscObject)eps), PETSC_ERR_USER_INPUT,
             BLOCKKRYLOV_SIZE " %" PetscInt_FMT " must be at most %" PetscInt_FMT ", the unknowns", ctx->size, eps->n);
  if (eps->ncv <= 0) eps->ncv = PetscMin(eps->n, PetscMax(2 * eps->nev, eps->nev + 20) + 2 * block);
  PetscCheck(eps->ncv >= PetscMin(eps->n, eps->nev + 2), PetscObjectComm((PetscObject)eps), PETSC_ERR_USER_INPUT,
             "-eps_ncv %" PetscInt_FMT " must be at least %" PetscInt_FMT ": the eigenvalues asked for and two more",
             eps->ncv, eps->nev + 2);
  ctx->block = eps->ncv < eps->n ? PetscMin(block, (eps->ncv - eps->nev) / 2) : block;
  PetscCheck(!ctx->size || ctx->block == ctx->size, PetscObjectComm((PetscObject)eps), PETSC_ERR_USER_INPUT,
             BLOCKKRYLOV_SIZE " %" PetscInt_FMT " must be at most %" PetscInt_FMT
                              ": half of what -eps_ncv %" PetscInt_FMT " leaves beside %" PetscInt_FMT " eigenvalues",
             ctx->size, ctx->block, eps->ncv, eps->nev);
  eps->mpd = eps->ncv;
  if (eps->max_it <= 0) eps->max_it = PetscMax(100, 2 * eps->n / eps->ncv);
  PetscFunctionReturn(0);
}

static PetscErrorCode EPSSetUp_BlockKrylov(EPS eps)
{
  EPS_BlockKrylov *ctx = eps->data;

  PetscFunctionBegin;
  EPSCheckUnsupported(eps, EPS_FEATURE_BALANCE | EPS_FEATURE_ARBITRARY | EPS_FEATURE_REGION | EPS_FEATURE_EXTRACTION |
                             EPS_FEATURE_TWOSIDED);
  EPSCheckDefinite(eps);
  if (!eps->which) PetscCall(EPSSetWhichEigenpairs(eps, EPS_LARGEST_MAGNITUDE));
  PetscCheck(!eps->trueres && (eps->which == EPS_TARGET_MAGNITUDE || eps->which == EPS_LARGEST_MAGNITUDE),
             PetscObjectComm((PetscObject)eps), PETSC_ERR_SUP,
             "The solver '%s' finds the largest eigenvalues or those nearest to a target, without true residuals",
             ((PetscObject)eps)->type_name);
  PetscCall(BlockKrylovSizes(eps));
  PetscCall(EPSAllocateSolution(eps, ctx->block));
  PetscCall(BVSetMatrix(eps->V, NULL, PETSC_FALSE));
  PetscCall(DSSetType(eps->ds, eps->ishermitian ? DSHEP : DSNHEP));
  PetscCall(DSAllocate(eps->ds, eps->ncv));
  PetscFunctionReturn(0);
}

/* Order of the eigenvalues of the operator by that of those which they stand for */
static PetscErrorCode EPSSetUpSort_BlockKrylov(EPS eps)
{
  const PetscBool target = eps->which == EPS_TARGET_MAGNITUDE ? PETSC_TRUE : PETSC_FALSE;
  SlepcSC         sc;

  PetscFunctionBegin;
  PetscCall(DSGetSlepcSC(eps->ds, &sc));
  eps->sc->comparison    = target ? SlepcCompareTargetMagnitude : SlepcCompareLargestMagnitude;
  eps->sc->comparisonctx = target ? &eps->target : NULL;
  eps->sc->map           = NULL;
  eps->sc->mapobj        = NULL;
  sc->rg                 = NULL;
  sc->comparison         = eps->sc->comparison;
  sc->comparisonctx      = eps->sc->comparisonctx;
  sc->map                = SlepcMap_ST;
  sc->mapobj             = (PetscObject)eps->st;
  PetscFunctionReturn(0);
}

/* Sorted Schur form of the projected problem, the first `locked` columns of which are there already */
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

/* Residual of eigenpair k and of its conjugate, *next - 1. Where the space is closed it is rounding of what is largest in
   it, so that a small eigenvalue converges when the larger ones are locked. */
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

/* Converged eigenvalues in order, k of them */
static PetscErrorCode BlockKrylovConverge(EPS eps, PetscInt locked, PetscInt *k)
{
  const PetscInt m = ((EPS_BlockKrylov *)eps->data)->space.m;

  PetscFunctionBegin;
  *k = locked;
  for (PetscInt next; *k < m; *k = next) {
    PetscScalar re = eps->eigr[*k], im = eps->eigi[*k];
    PetscReal   residual;

    PetscCall(BlockKrylovResidual(eps, locked, *k, &next, &residual));
    if (eps->conv == EPS_CONV_NORM) PetscCall(STBackTransform(eps->st, 1, &re, &im));
    PetscCall((*eps->converged)(eps, re, im, residual, &eps->errest[*k], eps->convergedctx));
    if (next - *k == 2) eps->errest[next - 1] = eps->errest[*k];
    if (eps->errest[*k] >= eps->tol) break;
  }
  PetscFunctionReturn(0);
}

/* Keeps the k converged Schur vectors and about half of the others, not half a complex pair */
static PetscErrorCode BlockKrylovRestart(EPS eps, PetscInt locked, PetscInt k)
{
  BlockSpace *s    = &((EPS_BlockKrylov *)eps->data)->space;
  PetscInt    keep = PetscMin((s->m - k) / 2, s->ncv - s->p - k);
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

/* All columns between two looks: one costs about as much as a few solves */
static PetscErrorCode BlockKrylovExtend(EPS eps, PetscInt locked)
{
  BlockSpace    *s    = &((EPS_BlockKrylov *)eps->data)->space;
  const PetscInt next = s->m < eps->nev ? eps->nev + eps->nev / 2 : s->m + PetscMax(1, s->m / 12);

  PetscFunctionBegin;
  while (s->p && s->m + s->p <= s->ncv && s->m < PetscMax(next, locked + 1)) PetscCall(BlockSpaceExtend(s));
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

/* An iteration fills the space once; the test of convergence is asked at every look */
static PetscErrorCode BlockKrylovIterate(EPS eps)
{
  BlockSpace *s      = &((EPS_BlockKrylov *)eps->data)->space;
  PetscInt    locked = 0, k = 0;
  PetscBool   full;

  PetscFunctionBegin;
  eps->its = 1;
  PetscCall(BlockSpaceStart(s));
  while (eps->reason == EPS_CONVERGED_ITERATING && s->p) {
    PetscCall(BlockKrylovExtend(eps, locked));
    PetscCall(BlockKrylovProject(eps, locked));
    PetscCall(BlockKrylovConverge(eps, locked, &k));
    PetscCall(EPSMonitor(eps, eps->its, k, eps->eigr, eps->eigi, eps->errest, s->m));
    full = !s->p || s->m + s->p > s->ncv ? PETSC_TRUE : PETSC_FALSE;
    PetscCall(
      (*eps->stopping)(eps, eps->its - (full ? 0 : 1), eps->max_it, k, eps->nev, &eps->reason, eps->stoppingctx));
    if (eps->reason == EPS_CONVERGED_ITERATING && !s->p && k == locked) eps->reason = EPS_DIVERGED_BREAKDOWN;
    if (eps->reason != EPS_CONVERGED_ITERATING) {
      PetscCall(BlockKrylovVectors(eps, k));
    } else if (full) {
      PetscCall(BlockKrylovRestart(eps, locked, k));
      locked = k;
      eps->its++;
    }
  }
  if (eps->reason == EPS_CONVERGED_ITERATING) PetscCall(BlockKrylovExhaust(eps, k));
  PetscFunctionReturn(0);
}

static PetscErrorCode EPSSolve_BlockKrylov(EPS eps)
{
  EPS_BlockKrylov *ctx = eps->data;
  Mat              M   = NULL;

  PetscFunctionBegin;
  if (eps->isgeneralized && eps->ispositive) PetscCall(STGetBilinearForm(eps->st, &M));
  PetscCall(BlockSpaceCreate(eps->st, eps->V, M, eps->ncv, ctx->block, &ctx->space));
  PetscCall(BlockKrylovIterate(eps));
  PetscCall(BlockSpaceDestroy(&ctx->space));
  PetscCall(MatDestroy(&M));
  PetscFunctionReturn(0);
}

/* Purification: what vectors hold of the null space of a singular M goes by Op */
static PetscErrorCode EPSComputeVectors_BlockKrylov(EPS eps)
{
  Mat M;

  PetscFunctionBegin;
  if (!eps->purify || !eps->ispositive || !eps->isgeneralized || !eps->nconv) PetscFunctionReturn(0);
  PetscCall(STGetBilinearForm(eps->st, &M));
  PetscCall(BlockSpacePurify(eps->st, eps->V, M, eps->nconv, ((EPS_BlockKrylov *)eps->data)->block));
  PetscCall(MatDestroy(&M));
  PetscFunctionReturn(0);
}

static PetscErrorCode EPSBackTransform_BlockKrylov(EPS eps)
{
  PetscFunctionBegin;
  PetscCall(STBackTransform(eps->st, eps->nconv, eps->eigr, eps->eigi));
  PetscFunctionReturn(0);
}

static PetscErrorCode EPSSetFromOptions_BlockKrylov(EPS eps, PetscOptionItems *PetscOptionsObject)
{
  EPS_BlockKrylov *ctx = eps->data;

  PetscFunctionBegin;
  PetscOptionsHeadBegin(PetscOptionsObject, "EPS block Krylov-Schur options");
  PetscCall(PetscOptionsInt(BLOCKKRYLOV_SIZE, "vectors in a block (0: 8, or as many as there is room for)",
                            "blockkrylov.h", ctx->size, &ctx->size, NULL));
  PetscOptionsHeadEnd();
  PetscCheck(ctx->size >= 0, PetscObjectComm((PetscObject)eps), PETSC_ERR_USER_INPUT,
             BLOCKKRYLOV_SIZE " %" PetscInt_FMT " must not be negative", ctx->size);
  PetscFunctionReturn(0);
}

static PetscErrorCode EPSView_BlockKrylov(EPS eps, PetscViewer viewer)
{
  const EPS_BlockKrylov *ctx = eps->data;
  PetscBool              is_ascii;

  PetscFunctionBegin;
  PetscCall(PetscObjectTypeCompare((PetscObject)viewer, PETSCVIEWERASCII, &is_ascii));
  if (is_ascii && ctx->block)
    PetscCall(PetscViewerASCIIPrintf(viewer, "  blocks of %" PetscInt_FMT " vectors\n", ctx->block));
  PetscFunctionReturn(0);
}

static PetscErrorCode EPSDestroy_BlockKrylov(EPS eps)
{
  PetscFunctionBegin;
  PetscCall(PetscFree(eps->data));
  PetscFunctionReturn(0);
}

static PetscErrorCode EPSCreate_BlockKrylov(EPS eps)
{
  EPS_BlockKrylov *ctx;

  PetscFunctionBegin;
  PetscCall(PetscNew(&ctx));
  eps->data                = ctx;
  eps->useds               = PETSC_TRUE;
  eps->categ               = EPS_CATEGORY_KRYLOV;
  eps->ops->setup          = EPSSetUp_BlockKrylov;
  eps->ops->setupsort      = EPSSetUpSort_BlockKrylov;
  eps->ops->solve          = EPSSolve_BlockKrylov;
  eps->ops->backtransform  = EPSBackTransform_BlockKrylov;
  eps->ops->computevectors = EPSComputeVectors_BlockKrylov;
  eps->ops->setfromoptions = EPSSetFromOptions_BlockKrylov;
  eps->ops->view           = EPSView_BlockKrylov;
  eps->ops->destroy        = EPSDestroy_BlockKrylov;
  PetscFunctionReturn(0);
}

PetscErrorCode BlockKrylovGetBlock(EPS eps, PetscInt *block)
{
  PetscBool mine;

  PetscFunctionBegin;
  PetscCall(PetscObjectTypeCompare((PetscObject)eps, EPSBLOCKKRYLOVSCHUR, &mine));
  *block = mine ? ((EPS_BlockKrylov *)eps->data)->block : 1;
  PetscFunctionReturn(0);
}

PetscErrorCode BlockKrylovRegister(void)
{
  PetscFunctionBegin;
  PetscCall(EPSRegister(EPSBLOCKKRYLOVSCHUR, EPSCreate_BlockKrylov));
  PetscFunctionReturn(0);
}
