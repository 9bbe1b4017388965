/*
   The block Krylov decomposition, see block/space.h. Whatever is added to V is orthogonalised against all of it, so
   that G may be full, and a random block may join at any time: its rows in G are zero. Op V = V G + Q B holds to
   rounding for any V (G. W. Stewart, SIAM J. Matrix Anal. Appl. 23, 2002), so that fewer digits of orthogonality will
   do.
*/
#include "space.h"
#include "orthonormal.h"

/* How far a basis may be from orthonormal. Left at that, the next block loses some 30 times as much. On the default
   brake 1e-8, 1e-10, 1e-12 spare 62, 45, 17 of 72 second passes; with 1e-8 eigenvalues of 1e-8 of the largest lose
   digits where a space is closed */
#define SEMI      1e-10
#define VANISHED  4e-15 /* a direction that rounding made, beside its block: left out of the decomposition */
#define EXHAUSTED 1e-12 /* the same of what Op makes of random vectors: there are no further directions */

PetscErrorCode BlockSpaceCreate(ST st, BV V, Mat M, PetscInt ncv, PetscInt block, BlockSpace *s)
{
  PetscFunctionBeginUser;
  *s = (BlockSpace){.st = st, .V = V, .M = M, .ncv = ncv, .block = block};
  if (M) PetscCall(PetscObjectReference((PetscObject)M));
  PetscCall(BVGetSizes(V, NULL, &s->n, NULL));
  PetscCall(BVDuplicateResize(V, block, &s->W));
  PetscCall(PetscCalloc2(ncv * (ncv + block), &s->G, block * (ncv + block), &s->scratch));
  PetscFunctionReturn(0);
}

/* W = Op times n columns of V from `first` on */
static PetscErrorCode SpaceApply(BlockSpace *s, PetscInt first, PetscInt n)
{
  Mat Op;

  PetscFunctionBeginUser;
  PetscCall(BVSetActiveColumns(s->V, first, first + n));
  PetscCall(BVSetActiveColumns(s->W, 0, n));
  PetscCall(STGetOperator(s->st, &Op));
  PetscCall(BVMatMult(s->V, Op, s->W));
  PetscCall(STRestoreOperator(s->st, &Op));
  PetscFunctionReturn(0);
}

/* Makes the block W orthonormal to the first n columns of V, which its columns follow, as many as there are in it */
static PetscErrorCode SpaceAppend(BlockSpace *s, PetscInt n, PetscReal drop, PetscScalar H[], PetscInt *rank)
{
  BlockFactors factors = {.ld = s->ncv + s->block, .most = s->n - n, .H = H, .drop = drop, .enough = SEMI};

  PetscFunctionBeginUser;
  PetscCall(BlockFactorise(s->V, n, s->M, s->W, &factors));
  PetscCall(BVGetActiveColumns(s->W, NULL, rank));
  if (!*rank) PetscFunctionReturn(0);
  PetscCall(BVSetActiveColumns(s->V, n, n + *rank));
  PetscCall(BVCopy(s->W, s->V));
  PetscFunctionReturn(0);
}

/* Random directions in the range of Op, of those that V has not, up to n of them: what Op makes of a random block
   that is orthogonal to V, so that what V has does not hide them. Of a generalised problem with a singular M only
   directions in that range belong to finite eigenvalues. */
static PetscErrorCode SpaceAppendRandom(BlockSpace *s, PetscInt n, PetscInt *rank)
{
  const PetscInt first = s->m + s->p;

  PetscFunctionBeginUser;
  PetscCall(BVSetActiveColumns(s->V, first, first + n));
  for (PetscInt j = first; j < first + n; j++) PetscCall(BVSetRandomColumn(s->V, j));
  PetscCall(BVSetActiveColumns(s->W, 0, n));
  PetscCall(BVCopy(s->V, s->W));
  PetscCall(SpaceAppend(s, first, EXHAUSTED, s->scratch, rank));
  if (!*rank) PetscFunctionReturn(0);
  PetscCall(SpaceApply(s, first, *rank));
  PetscCall(SpaceAppend(s, first, EXHAUSTED, s->scratch, rank));
  s->p += *rank;
  PetscFunctionReturn(0);
}

/* Random directions until the last block is full or there are no more */
static PetscErrorCode SpaceFill(BlockSpace *s)
{
  PetscInt missing, rank = 1;

  PetscFunctionBeginUser;
  while (rank && (missing = PetscMin(s->block - s->p, s->n - s->m - s->p)) > 0)
    PetscCall(SpaceAppendRandom(s, missing, &rank));
  PetscFunctionReturn(0);
}

PetscErrorCode BlockSpaceStart(BlockSpace *s)
{
  PetscFunctionBeginUser;
  s->p = 0;
  PetscCall(SpaceFill(s));
  PetscFunctionReturn(0);
}

/* Takes in W, which is Op times the last block: its coordinates are the next p columns of G, and what is new in it
   the next block. m grows by p. */
static PetscErrorCode SpaceTake(BlockSpace *s)
{
  const PetscInt n = s->m + s->p, ld = s->ncv + s->block;
  PetscInt       rank;

  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(s->G + s->m * ld, s->p * ld));
  PetscCall(SpaceAppend(s, n, VANISHED, s->G + s->m * ld, &rank));
  s->applied += s->p;
  s->m = n;
  s->p = rank;
  PetscCall(SpaceFill(s));
  PetscFunctionReturn(0);
}

PetscErrorCode BlockSpaceExtend(BlockSpace *s)
{
  PetscFunctionBeginUser;
  PetscCall(SpaceApply(s, s->m, s->p));
  PetscCall(SpaceTake(s));
  PetscFunctionReturn(0);
}

/* The last block, into the columns of X from `first` on */
static PetscErrorCode SpaceCopy(const BlockSpace *s, PetscInt first, Mat X)
{
  Mat v, x;

  PetscFunctionBeginUser;
  PetscCall(BVSetActiveColumns(s->V, s->m, s->m + s->p));
  PetscCall(BVGetMat(s->V, &v));
  PetscCall(MatDenseGetSubMatrix(X, PETSC_DECIDE, PETSC_DECIDE, first, first + s->p, &x));
  PetscCall(MatCopy(v, x, SAME_NONZERO_PATTERN));
  PetscCall(MatDenseRestoreSubMatrix(X, &x));
  PetscCall(BVRestoreMat(s->V, &v));
  PetscFunctionReturn(0);
}

/* n columns of X from `first` on := M times them */
static PetscErrorCode ColumnsMultiply(Mat M, PetscInt first, PetscInt n, Mat X)
{
  Mat x;

  PetscFunctionBeginUser;
  PetscCall(MatDenseGetSubMatrix(X, PETSC_DECIDE, PETSC_DECIDE, first, first + n, &x));
  PetscCall(BlockMultiply(M, x, x));
  PetscCall(MatDenseRestoreSubMatrix(X, &x));
  PetscFunctionReturn(0);
}

/* X = the last blocks of both times the matrices of their right-hand sides; a matrix that is that of both is read
   once */
static PetscErrorCode SpacesMultiply(const BlockSpace *right, const BlockSpace *left, Mat X)
{
  Mat M, Mt;

  PetscFunctionBeginUser;
  PetscCall(SpaceCopy(right, 0, X));
  PetscCall(SpaceCopy(left, right->p, X));
  PetscCall(STGetMatrix(right->st, 1, &M));
  PetscCall(STGetMatrix(left->st, 1, &Mt));
  PetscCall(ColumnsMultiply(M, 0, right->p + (M == Mt ? left->p : 0), X));
  if (M != Mt) PetscCall(ColumnsMultiply(Mt, right->p, left->p, X));
  PetscFunctionReturn(0);
}

/* Takes in the columns of X from `first` on */
static PetscErrorCode SpaceTakeColumns(BlockSpace *s, PetscInt first, Mat X)
{
  Mat x, w;

  PetscFunctionBeginUser;
  PetscCall(BVSetActiveColumns(s->W, 0, s->p));
  PetscCall(BVGetMat(s->W, &w));
  PetscCall(MatDenseGetSubMatrix(X, PETSC_DECIDE, PETSC_DECIDE, first, first + s->p, &x));
  PetscCall(MatCopy(x, w, SAME_NONZERO_PATTERN));
  PetscCall(MatDenseRestoreSubMatrix(X, &x));
  PetscCall(BVRestoreMat(s->W, &w));
  PetscCall(SpaceTake(s));
  PetscFunctionReturn(0);
}

/* Op = (K - s M)^-1 M of the right space, (K - s M)^-T M' of the left one: one array of right_p + left_p columns,
   multiplied, solved and taken in. */
PetscErrorCode BlockSpaceExtendBoth(BlockSpace *right, BlockSpace *left, BlockKrylovSolve solve, void *ctx)
{
  const PetscInt n_right = right->p, n = right->p + left->p;
  PetscInt       n_local;
  PetscScalar   *x; /* not set to zero before it is written, as the matrix' own would be */
  Mat            X;

  PetscFunctionBeginUser;
  PetscCall(BVGetSizes(right->V, &n_local, NULL, NULL));
  PetscCall(PetscMalloc1(n_local * n, &x));
  PetscCall(MatCreateDense(PetscObjectComm((PetscObject)right->V), n_local, PETSC_DECIDE, PETSC_DETERMINE, n, x, &X));
  PetscCall(SpacesMultiply(right, left, X));
  PetscCall((*solve)(ctx, n_right, X));
  PetscCall(SpaceTakeColumns(right, 0, X));
  PetscCall(SpaceTakeColumns(left, n_right, X));
  PetscCall(MatDestroy(&X));
  PetscCall(PetscFree(x));
  PetscFunctionReturn(0);
}

/* G := [T; B Q] of k columns, [k + p][k], the converged without B, whose residual is below the tolerance: that is
   what locking leaves out of the decomposition. */
static PetscErrorCode SpaceProject(BlockSpace *s, PetscInt converged, PetscInt k, Mat Q, Mat T)
{
  const PetscInt     ld = s->ncv + s->block;
  const PetscScalar *q, *t;
  PetscScalar       *G;
  PetscInt           stride;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(s->ncv * ld, &G));
  PetscCall(MatDenseGetLDA(Q, &stride));
  PetscCall(MatDenseGetArrayRead(Q, &q));
  PetscCall(MatDenseGetArrayRead(T, &t));
  for (PetscInt j = 0; j < k; j++) {
    for (PetscInt i = 0; i < k; i++) G[j * ld + i] = t[j * stride + i];
    for (PetscInt c = 0; c < s->m && j >= converged; c++)
      for (PetscInt i = 0; i < s->p; i++) G[j * ld + k + i] += s->G[c * ld + s->m + i] * q[j * stride + c];
  }
  PetscCall(MatDenseRestoreArrayRead(T, &t));
  PetscCall(MatDenseRestoreArrayRead(Q, &q));
  PetscCall(PetscArraycpy(s->G, G, s->ncv * ld));
  PetscCall(PetscFree(G));
  PetscFunctionReturn(0);
}

PetscErrorCode BlockSpaceRestart(BlockSpace *s, PetscInt locked, PetscInt converged, PetscInt kept, Mat Q, Mat T)
{
  const PetscInt k = converged + kept;

  PetscFunctionBeginUser;
  PetscCall(SpaceProject(s, converged, k, Q, T));
  PetscCall(BVSetActiveColumns(s->V, locked, s->m));
  PetscCall(BVMultInPlace(s->V, Q, locked, k));
  for (PetscInt j = 0; j < s->p && k < s->m; j++) PetscCall(BVCopyColumn(s->V, s->m + j, k + j));
  s->m = k;
  PetscFunctionReturn(0);
}

PetscReal BlockSpaceResidual(const BlockSpace *s, const PetscScalar x[])
{
  const PetscInt ld  = s->ncv + s->block;
  PetscReal      sum = 0;

  for (PetscInt i = 0; i < s->p; i++) {
    PetscReal b = 0;

    for (PetscInt j = 0; j < s->m; j++) b += s->G[j * ld + s->m + i] * x[j];
    sum += b * b;
  }
  return PetscSqrtReal(sum);
}

/* One application of Op takes a vector into its range, where a singular M has no null space; lengths are set anew. */
PetscErrorCode BlockSpacePurify(ST st, BV V, Mat M, PetscInt n, PetscInt block)
{
  BlockSpace s;

  PetscFunctionBeginUser;
  PetscCall(BlockSpaceCreate(st, V, NULL, 1, block, &s));
  for (PetscInt first = 0; first < n; first += block) {
    const PetscInt last = PetscMin(first + block, n);

    PetscCall(SpaceApply(&s, first, last - first));
    PetscCall(BVSetActiveColumns(V, first, last));
    PetscCall(BVCopy(s.W, V));
  }
  PetscCall(BlockSpaceDestroy(&s));
  PetscCall(BVSetActiveColumns(V, 0, n));
  PetscCall(BVSetMatrix(V, M, PETSC_FALSE));
  PetscCall(BVNormalize(V, NULL));
  PetscCall(BVSetMatrix(V, NULL, PETSC_FALSE));
  PetscFunctionReturn(0);
}

PetscErrorCode BlockSpaceDestroy(BlockSpace *s)
{
  PetscFunctionBeginUser;
  PetscCall(BVDestroy(&s->W));
  PetscCall(MatDestroy(&s->M));
  PetscCall(PetscFree2(s->G, s->scratch));
  PetscFunctionReturn(0);
}
