/*
   Block Krylov-Schur eigensolver, see block/krylov.h: the type. Its iteration is in block/iterate.c.
*/
#include <squeal/options.h>
#include "iterate.h"
#include "solver/factor/shiftinvert.h"

/* Right-hand sides that are solved at once: vectors in a block, or in both blocks where two problems are solved
   together. On the default brake (36,453 unknowns, 51 modes with friction, right and left) blocks of 1, 4, 8, 16 take
   238, 296, 392, 560 solves, with LU of 20, 6.6, 4.1, 3.1 ms */
#define BLOCK 8

/* Sizes of the block and of the space: at a restart there must be room for the eigenvalues asked for and two blocks.
   Chosen, the space holds whole blocks, a third as many vectors again as are asked for and three blocks. On the default
   brake, with 57 asked for, in blocks of 4, 80, 88, 96, 104 columns take 296, 288, 284, 284 solves, and a column of
   both spaces takes 0.6 MB */
static PetscErrorCode BlockKrylovSizes(EPS eps)
{
  EPS_BlockKrylov *ctx    = eps->data;
  const PetscInt   chosen = PetscMax(ctx->least, ctx->paired ? BLOCK / 2 : BLOCK);
  const PetscInt   block  = PetscMin(ctx->size ? ctx->size : chosen, eps->n);

  PetscFunctionBegin;
  PetscCheck(ctx->size <= eps->n, PetscObjectComm((PetscObject)eps), PETSC_ERR_USER_INPUT,
             BLOCKKRYLOV_SIZE " %" PetscInt_FMT " must be at most %" PetscInt_FMT ", the unknowns", ctx->size, eps->n);
  if (eps->ncv <= 0) {
    const PetscInt room = eps->nev + PetscMax(eps->nev / 3 + block, 20) + 2 * block;

    eps->ncv = PetscMin(eps->n, (room + block - 1) / block * block);
  }
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

/* What the type does not offer is refused here rather than ignored. Orthogonality is the decomposition's own work
   (orthogonalise.c): the basis gets no inner product of SLEPc's. */
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
  PetscCall(SolverSynchronize(eps->ds));
  PetscCall(DSSetType(eps->ds, eps->ishermitian ? DSHEP : DSNHEP));
  PetscCall(DSAllocate(eps->ds, eps->ncv));
  PetscFunctionReturn(0);
}

/* Order of the eigenvalues theta of the operator by that of those which they stand for, kappa = target + 1 / theta
   (SlepcMap_ST). */
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

static const Quantity rows[] = {
  {BLOCKKRYLOV_SIZE, "vectors in a block (0: 8, 4 of each of two problems at once, or what there is room for)", NULL,
   QUANTITY_INT, QUANTITY_AT(EPS_BlockKrylov, size), QUANTITY_NOT_NEGATIVE},
};
static const QuantityTable block_quantities = {"Eigensolver", "modes.h", 1, rows, .in = RUN_LINEAR | RUN_REDUCED};

PetscErrorCode BlockKrylovVisit(const QuantityVisitor *visitor, const char why[])
{
  PetscFunctionBeginUser;
  PetscCall(QuantitiesVisit(visitor, &block_quantities, NULL, NULL, why));
  PetscFunctionReturn(0);
}

PetscErrorCode BlockKrylovReadOptions(MPI_Comm comm)
{
  EPS_BlockKrylov asked = {.size = 0};

  PetscFunctionBeginUser;
  PetscCall(QuantitiesRead(comm, &block_quantities, &asked));
  PetscFunctionReturn(0);
}

static PetscErrorCode EPSSetFromOptions_BlockKrylov(EPS eps, OptionsItems PetscOptionsObject)
{
  PetscFunctionBegin;
  (void)PetscOptionsObject;
  PetscCall(QuantitiesRead(PetscObjectComm((PetscObject)eps), &block_quantities, eps->data));
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
  PetscCall(BlockKrylovEnd(eps));
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
  eps->ops->solve          = BlockKrylovIterate;
  eps->ops->backtransform  = EPSBackTransform_BlockKrylov;
  eps->ops->computevectors = EPSComputeVectors_BlockKrylov;
  eps->ops->setfromoptions = EPSSetFromOptions_BlockKrylov;
  eps->ops->view           = EPSView_BlockKrylov;
  eps->ops->destroy        = EPSDestroy_BlockKrylov;
  PetscFunctionReturn(0);
}

/* What the solver keeps, NULL for another type */
static PetscErrorCode BlockKrylovGet(EPS eps, EPS_BlockKrylov **ctx)
{
  PetscBool mine;

  PetscFunctionBegin;
  PetscCall(PetscObjectTypeCompare((PetscObject)eps, EPSBLOCKKRYLOVSCHUR, &mine));
  *ctx = mine ? eps->data : NULL;
  PetscFunctionReturn(0);
}

PetscErrorCode BlockKrylovGetBlock(EPS eps, PetscInt *block)
{
  EPS_BlockKrylov *ctx;

  PetscFunctionBegin;
  PetscCall(BlockKrylovGet(eps, &ctx));
  *block = ctx ? ctx->block : 1;
  PetscFunctionReturn(0);
}

PetscErrorCode BlockKrylovSetLeast(EPS eps, PetscInt least)
{
  EPS_BlockKrylov *ctx;

  PetscFunctionBegin;
  PetscCall(BlockKrylovGet(eps, &ctx));
  if (ctx) ctx->least = least;
  PetscFunctionReturn(0);
}

PetscErrorCode BlockKrylovSetReach(EPS eps, PetscReal reach)
{
  EPS_BlockKrylov *ctx;

  PetscFunctionBegin;
  PetscCall(BlockKrylovGet(eps, &ctx));
  if (ctx) ctx->reach = reach;
  PetscFunctionReturn(0);
}

PetscErrorCode BlockKrylovReached(EPS eps, PetscBool *reached)
{
  EPS_BlockKrylov *ctx;

  PetscFunctionBegin;
  PetscCall(BlockKrylovGet(eps, &ctx));
  *reached = ctx ? ctx->reached : PETSC_FALSE;
  PetscFunctionReturn(0);
}

/* Column j of V as a vector on the memory of V, which it keeps alive by a reference. */
static PetscErrorCode ColumnTake(BV V, PetscInt j, Vec *x)
{
  const MPI_Comm comm = PetscObjectComm((PetscObject)V);
  PetscScalar   *a;
  PetscInt       n_local, n, stride;
  PetscMPIInt    size;
  Mat            A;

  PetscFunctionBegin;
  PetscCall(BVGetSizes(V, &n_local, &n, NULL));
  PetscCall(BVSetActiveColumns(V, 0, j + 1));
  PetscCall(BVGetMat(V, &A));
  PetscCall(MatDenseGetLDA(A, &stride));
  PetscCall(MatDenseGetArray(A, &a));
  PetscCallMPI(MPI_Comm_size(comm, &size));
  if (size == 1)
    PetscCall(VecCreateSeqWithArray(comm, 1, n, a + (size_t)j * stride, x));
  else
    PetscCall(VecCreateMPIWithArray(comm, 1, n_local, n, a + (size_t)j * stride, x));
  PetscCall(MatDenseRestoreArray(A, &a));
  PetscCall(BVRestoreMat(V, &A));
  PetscCall(PetscObjectCompose((PetscObject)*x, "basis", (PetscObject)V));
  PetscFunctionReturn(0);
}

/* The vectors are complete from their first use on */
static PetscErrorCode BlockKrylovPurify(EPS eps)
{
  PetscFunctionBegin;
  if (eps->state == EPS_STATE_SOLVED) PetscCall(EPSComputeVectors_BlockKrylov(eps));
  eps->state = EPS_STATE_EIGENVECTORS;
  PetscFunctionReturn(0);
}

/* Copies, as the second of a conjugate pair needs them too, whose first has the columns */
static PetscErrorCode EigenvectorCopy(EPS eps, PetscInt i, Vec *xr, Vec *xi)
{
  PetscScalar ki;

  PetscFunctionBegin;
  PetscCall(BVCreateVec(eps->V, xr));
  PetscCall(BVCreateVec(eps->V, xi));
  PetscCall(EPSGetEigenpair(eps, i, NULL, &ki, *xr, *xi));
  if (ki == 0) PetscCall(VecDestroy(xi));
  PetscFunctionReturn(0);
}

/* SLEPc stores the vector of a conjugate pair as two columns, real and imaginary part; the second of the pair has
   the same with the other sign, and gets a copy. */
PetscErrorCode BlockKrylovTakeVector(EPS eps, PetscInt i, PetscBool copy, Vec *xr, Vec *xi)
{
  const PetscInt   column = eps->perm[i];
  EPS_BlockKrylov *ctx;
  PetscBool        apart; /* -bv_type vecs has no array of all columns */

  PetscFunctionBegin;
  PetscCall(BlockKrylovGet(eps, &ctx));
  PetscCall(PetscObjectTypeCompare((PetscObject)eps->V, BVVECS, &apart));
  if (!ctx || copy || apart || eps->eigi[column] < 0) {
    PetscCall(EigenvectorCopy(eps, i, xr, xi));
    PetscFunctionReturn(0);
  }
  *xi = NULL;
  PetscCall(BlockKrylovPurify(eps));
  PetscCall(ColumnTake(eps->V, column, xr));
  if (eps->eigi[column] > 0) PetscCall(ColumnTake(eps->V, column + 1, xi));
  PetscFunctionReturn(0);
}

/* Whether it is a generalised problem of this type by shift-and-invert */
static PetscErrorCode BlockKrylovInverts(EPS eps, PetscBool *inverts)
{
  EPS_BlockKrylov *ctx;
  ST               st;

  PetscFunctionBegin;
  PetscCall(BlockKrylovGet(eps, &ctx));
  PetscCall(EPSGetST(eps, &st));
  PetscCall(PetscObjectTypeCompare((PetscObject)st, STSINVERT, inverts));
  if (!ctx || !eps->isgeneralized || eps->ispositive) *inverts = PETSC_FALSE;
  PetscFunctionReturn(0);
}

/* Both must be generalised problems by shift-and-invert: then both blocks are right-hand sides of one matrix and
   its transpose. */
PetscErrorCode BlockKrylovSetOther(EPS right, EPS left, BlockKrylovSolve solve, void *solve_ctx, PetscBool *paired)
{
  PetscBool other;

  PetscFunctionBegin;
  PetscCall(BlockKrylovInverts(right, paired));
  PetscCall(BlockKrylovInverts(left, &other));
  if (!other) *paired = PETSC_FALSE;
  if (*paired) {
    EPS_BlockKrylov *first = right->data, *second = left->data;

    first->other     = left;
    first->solve     = solve;
    first->solve_ctx = solve_ctx;
    first->paired = second->paired = PETSC_TRUE;
  }
  PetscFunctionReturn(0);
}

PetscErrorCode BlockKrylovRegister(void)
{
  PetscFunctionBegin;
  PetscCall(EPSRegister(EPSBLOCKKRYLOVSCHUR, EPSCreate_BlockKrylov));
  PetscFunctionReturn(0);
}
