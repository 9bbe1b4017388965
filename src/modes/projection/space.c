/*
   The basis of a projection and its dense model; see project.c.
*/
#include "projection.h"
#include "base/events.h"
#include "solver/block/orthonormal.h"

#define SPACE_SYMMETRIC 1e-13 /* of |A x| |y|: less is rounding */
#define SPACE_WIDTH     32    /* columns that are multiplied at once */
#define SPACE_LOOSE     1e-3  /* V'MV - I may be as large as this: the dense model has it */

/* Whether A is symmetric, by y'A x = x'A y of two random vectors */
static PetscErrorCode LooksSymmetric(Mat A, PetscBool *symmetric)
{
  PetscReal   yAx, xAy, Ax, y;
  PetscRandom random;
  Vec         v[3];

  PetscFunctionBeginUser;
  PetscCall(MatCreateVecs(A, &v[0], NULL));
  for (int i = 1; i < 3; i++) PetscCall(VecDuplicate(v[0], &v[i]));
  PetscCall(PetscRandomCreate(PetscObjectComm((PetscObject)A), &random));
  for (int i = 0; i < 2; i++) PetscCall(VecSetRandom(v[i], random));
  PetscCall(PetscRandomDestroy(&random));
  PetscCall(MatMult(A, v[0], v[2]));
  PetscCall(VecDot(v[2], v[1], &yAx));
  PetscCall(VecNorm(v[2], NORM_2, &Ax));
  PetscCall(VecNorm(v[1], NORM_2, &y));
  PetscCall(MatMult(A, v[1], v[2]));
  PetscCall(VecDot(v[2], v[0], &xAy));
  *symmetric = PetscAbsReal(yAx - xAy) <= SPACE_SYMMETRIC * Ax * y ? PETSC_TRUE : PETSC_FALSE;
  for (int i = 0; i < 3; i++) PetscCall(VecDestroy(&v[i]));
  PetscFunctionReturn(0);
}

/* A', or A itself where it is symmetric */
static PetscErrorCode TransposeCreate(Mat A, PetscBool symmetric, Mat *At)
{
  PetscFunctionBeginUser;
  if (!symmetric) PetscCall(LooksSymmetric(A, &symmetric));
  if (symmetric)
    PetscCall(PetscObjectReference((PetscObject)A));
  else
    PetscCall(MatTranspose(A, MAT_INITIAL_MATRIX, At));
  if (symmetric) *At = A;
  PetscFunctionReturn(0);
}

/* K' by K_even and the pairs */
static PetscErrorCode ProjectionSplit(Projection *p)
{
  Vec pairs;

  PetscFunctionBeginUser;
  p->transposed[0] = p->pencil->K_even;
  PetscCall(PetscObjectReference((PetscObject)p->pencil->K_even));
  PetscCall(MatTranspose(p->pencil->right, MAT_INITIAL_MATRIX, &p->spread));
  PetscCall(MatCreateVecs(p->pencil->left, NULL, &pairs));
  for (int i = 0; i < 2; i++) {
    PetscCall(BVCreate(p->modes->comm, &p->pairs[i]));
    PetscCall(BVSetType(p->pairs[i], BVMAT));
    PetscCall(BVSetSizesFromVec(p->pairs[i], pairs, 1));
  }
  PetscCall(VecDestroy(&pairs));
  PetscFunctionReturn(0);
}

PetscErrorCode ProjectionCreate(Modes modes, const PencilMatrices *pencil, const Window *window, Projection *p)
{
  const Mat matrix[3] = {pencil->K, pencil->C, pencil->M};
  Vec       u;

  PetscFunctionBeginUser;
  *p = (Projection){.modes = modes, .pencil = pencil, .window = window};
  if (pencil->left) PetscCall(ProjectionSplit(p));
  for (int i = 0; i < 3; i++) {
    if (!p->transposed[i]) PetscCall(TransposeCreate(matrix[i], pencil->symmetric, &p->transposed[i]));
    PetscCall(MatNorm(matrix[i], NORM_FROBENIUS, &p->norms[i]));
  }
  PetscCall(MatCreateVecs(pencil->M, &u, NULL));
  PetscCall(BVCreate(modes->comm, &p->V));
  PetscCall(BVSetType(p->V, BVMAT));
  PetscCall(BVSetSizesFromVec(p->V, u, 1));
  PetscCall(VecDestroy(&u));
  PetscFunctionReturn(0);
}

/* The same for a few columns */
static PetscErrorCode AddFrictionPart(const Projection *p, Mat X, Mat Y)
{
  PetscInt n_local, m;
  Mat      forces, gaps;

  PetscFunctionBeginUser;
  PetscCall(MatGetLocalSize(p->pencil->left, &n_local, NULL));
  PetscCall(MatGetSize(X, NULL, &m));
  PetscCall(MatCreateDense(p->modes->comm, n_local, PETSC_DECIDE, PETSC_DETERMINE, m, NULL, &gaps));
  PetscCall(MatDuplicate(Y, MAT_DO_NOT_COPY_VALUES, &forces));
  PetscCall(BlockMultiply(p->pencil->left, X, gaps));
  PetscCall(BlockMultiply(p->spread, gaps, forces));
  PetscCall(MatAXPY(Y, 1, forces, SAME_NONZERO_PATTERN));
  PetscCall(MatDestroy(&gaps));
  PetscCall(MatDestroy(&forces));
  PetscFunctionReturn(0);
}

PetscErrorCode ProjectionAddFriction(const Projection *p, Mat X, Mat Y)
{
  PetscInt m;

  PetscFunctionBeginUser;
  if (!p->spread) PetscFunctionReturn(0);
  PetscCall(MatGetSize(X, NULL, &m));
  for (PetscInt first = 0; first < m; first += SPACE_WIDTH) {
    const PetscInt end = PetscMin(first + SPACE_WIDTH, m);
    Mat            x, y;

    PetscCall(MatDenseGetSubMatrix(X, PETSC_DECIDE, PETSC_DECIDE, first, end, &x));
    PetscCall(MatDenseGetSubMatrix(Y, PETSC_DECIDE, PETSC_DECIDE, first, end, &y));
    PetscCall(AddFrictionPart(p, x, y));
    PetscCall(MatDenseRestoreSubMatrix(Y, &y));
    PetscCall(MatDenseRestoreSubMatrix(X, &x));
  }
  PetscFunctionReturn(0);
}

/* Y = A X for the active columns of X and Y */
static PetscErrorCode PairsMultiply(Mat A, BV X, BV Y)
{
  Mat x, y;

  PetscFunctionBeginUser;
  PetscCall(BVGetMat(X, &x));
  PetscCall(BVGetMat(Y, &y));
  PetscCall(BlockMultiply(A, x, y));
  PetscCall(BVRestoreMat(Y, &y));
  PetscCall(BVRestoreMat(X, &x));
  PetscFunctionReturn(0);
}

/* The columns of the block behind the first ones of V, which gets room for `room` columns or a quarter more than it needs: a
   longer basis is a copy of it */
static PetscErrorCode BasisAppend(PetscInt first, PetscInt room, BV block, BV V)
{
  PetscInt n, has;

  PetscFunctionBeginUser;
  PetscCall(BVGetActiveColumns(block, NULL, &n));
  PetscCall(BVGetSizes(V, NULL, NULL, &has));
  if (first + n > has) PetscCall(BVResize(V, PetscMax(room, first + n + (first ? (first + n) / 4 : 0)), PETSC_TRUE));
  PetscCall(BVSetActiveColumns(V, first, first + n));
  PetscCall(BVCopy(block, V));
  PetscCall(BVSetActiveColumns(V, 0, first + n));
  PetscFunctionReturn(0);
}

/* From H = V' K_even W, [k * n], W the last n columns of V, V'K W = H + (L V)' R W in its place, and V'K'W = H + (R V)' L W;
   L V and R V are extended */
static PetscErrorCode PairsExtend(Projection *p, PetscInt first, BV block, PetscScalar H[], PetscScalar transposed[])
{
  const Mat    sides[2] = {p->pencil->left, p->pencil->right};
  PetscScalar *sums[2]  = {H, transposed};
  PetscInt     n;
  BV           images[2];

  PetscFunctionBeginUser;
  PetscCall(BVGetActiveColumns(block, NULL, &n));
  for (int i = 0; i < 2; i++) {
    PetscCall(BlockCreate(p->pairs[i], n, &images[i]));
    PetscCall(PairsMultiply(sides[i], block, images[i]));
    PetscCall(BasisAppend(first, p->room, images[i], p->pairs[i]));
  }
  PetscCall(PetscArraycpy(transposed, H, n * p->k));
  for (int i = 0; i < 2; i++) {
    Mat product, sum;

    PetscCall(MatCreateSeqDense(PETSC_COMM_SELF, p->k, n, sums[i], &sum));
    PetscCall(BlockProducts(p->pairs[i], NULL, images[1 - i], &product));
    PetscCall(MatAXPY(sum, 1, product, SAME_NONZERO_PATTERN));
    PetscCall(MatDestroy(&product));
    PetscCall(MatDestroy(&sum));
  }
  for (int i = 0; i < 2; i++) PetscCall(BVDestroy(&images[i]));
  PetscFunctionReturn(0);
}

/* The products of V with columns first .. first + n - 1 of the images into the last columns of a model, or its last rows */
static PetscErrorCode ModelFill(const Projection *p, PetscBool rows, PetscInt n, PetscScalar H[], PetscReal model[])
{
  const PetscInt k = p->k, first = k - n;
  Mat            part;

  PetscFunctionBeginUser;
  PetscCall(MatCreateSeqDense(PETSC_COMM_SELF, k, n, H, &part));
  PetscCall(BlockCopy(part, rows, k, rows ? model + first : model + first * k));
  PetscCall(MatDestroy(&part));
  PetscFunctionReturn(0);
}

/* V' A W for SPACE_WIDTH columns of the block W from `first` on and m matrices: h[m][columns of W][k], of which those */
static PetscErrorCode ModelsMultiply(const Projection *p, PetscInt m, const Mat A[], PetscInt first, BV block,
                                     PetscScalar h[])
{
  PetscInt columns, n;
  BV       images;
  Mat      H;

  PetscFunctionBeginUser;
  PetscCall(BVGetActiveColumns(block, NULL, &columns));
  n = PetscMin(SPACE_WIDTH, columns - first);
  PetscCall(BlockCreate(p->V, n * m, &images));
  PetscCall(BVSetActiveColumns(block, first, first + n));
  PetscCall(BlockMultiplySideBySide(m, A, block, images));
  PetscCall(BVSetActiveColumns(block, 0, columns));
  PetscCall(BlockProducts(p->V, NULL, images, &H));
  for (PetscInt i = 0; i < m; i++) {
    Mat part;

    PetscCall(MatDenseGetSubMatrix(H, PETSC_DECIDE, PETSC_DECIDE, i * n, (i + 1) * n, &part));
    PetscCall(BlockCopy(part, PETSC_FALSE, p->k, &h[(i * columns + first) * p->k]));
    PetscCall(MatDenseRestoreSubMatrix(H, &part));
  }
  PetscCall(MatDestroy(&H));
  PetscCall(BVDestroy(&images));
  PetscFunctionReturn(0);
}

/* The matrices that the models need products with: K (K_even, where pairs make the rest), C, M, and of their transposed ones
   those that differ; at[0 .. 2] and at[3 .. 5] = which serves for whom. Returns how many */
static PetscInt ModelsNeed(const Projection *p, Mat needed[], PetscInt at[])
{
  const Mat A[] = {p->spread ? p->transposed[0] : p->pencil->K, p->pencil->C, p->pencil->M};
  PetscInt  m   = 3;

  for (int i = 0; i < 3; i++) {
    needed[i] = A[i];
    at[i] = at[3 + i] = i;
  }
  for (int i = 0; i < 3; i++)
    if (p->transposed[i] != A[i]) at[3 + i] = m, needed[m++] = p->transposed[i];
  return m;
}

/* V'KV, V'CV and V'MV, extended by the block */
static PetscErrorCode ModelsExtend(Projection *p, PetscInt first, BV block)
{
  PetscReal  **model[] = {&p->K, &p->C, &p->M};
  PetscInt     n, m, at[6];
  PetscScalar *h, *transposed;
  Mat          needed[6];

  PetscFunctionBeginUser;
  PetscCall(BVGetActiveColumns(block, NULL, &n));
  m = ModelsNeed(p, needed, at);
  PetscCall(PetscMalloc2(m * n * p->k, &h, n * p->k, &transposed));
  for (PetscInt j = 0; j < n; j += SPACE_WIDTH) PetscCall(ModelsMultiply(p, m, needed, j, block, h));
  if (p->spread) PetscCall(PairsExtend(p, first, block, h, transposed));
  for (int i = 0; i < 3; i++) {
    PetscScalar *const rows = !i && p->spread ? transposed : &h[at[3 + i] * n * p->k];

    PetscCall(BlockGrow(first, p->k, model[i]));
    PetscCall(ModelFill(p, PETSC_FALSE, n, &h[at[i] * n * p->k], *model[i]));
    PetscCall(ModelFill(p, PETSC_TRUE, n, rows, *model[i]));
  }
  PetscCall(PetscFree2(h, transposed));
  PetscFunctionReturn(0);
}

PetscErrorCode ProjectionAdd(Projection *p, PetscReal drop, BV block)
{
  const PetscInt first = p->k;
  PetscInt       n;
  BlockFactors   factors = {.drop = drop, .loose = SPACE_LOOSE, .gram = first ? p->M : NULL};

  PetscFunctionBeginUser;
  PetscCall(EventBegin(EVENT_ORTHOGONALISE));
  PetscCall(BVGetActiveColumns(block, NULL, &n));
  factors.ld   = first + n;
  factors.most = n;
  PetscCall(PetscMalloc1(factors.ld * n, &factors.H));
  PetscCall(BlockFactorise(p->V, first, p->pencil->M, block, &factors));
  PetscCall(PetscFree(factors.H));
  PetscCall(BVGetActiveColumns(block, NULL, &n));
  if (n) {
    p->k = first + n;
    PetscCall(BasisAppend(first, p->room, block, p->V));
    PetscCall(ModelsExtend(p, first, block));
  }
  PetscCall(EventEnd(EVENT_ORTHOGONALISE));
  PetscFunctionReturn(0);
}

PetscErrorCode ProjectionForget(Projection *p)
{
  PetscFunctionBeginUser;
  p->k = 0;
  PetscCall(PetscFree(p->K));
  PetscCall(PetscFree(p->C));
  PetscCall(PetscFree(p->M));
  PetscCall(BVResize(p->V, 1, PETSC_FALSE));
  for (int i = 0; i < 2 && p->spread; i++) PetscCall(BVResize(p->pairs[i], 1, PETSC_FALSE));
  PetscFunctionReturn(0);
}

PetscErrorCode ProjectionDestroy(Projection *p)
{
  PetscFunctionBeginUser;
  for (int i = 0; i < 3; i++) PetscCall(MatDestroy(&p->transposed[i]));
  for (int i = 0; i < 2; i++) PetscCall(BVDestroy(&p->pairs[i]));
  PetscCall(MatDestroy(&p->spread));
  PetscCall(BVDestroy(&p->V));
  PetscCall(PetscFree(p->K));
  PetscCall(PetscFree(p->C));
  PetscCall(PetscFree(p->M));
  PetscCall(ShiftInvertDestroy(&p->si));
  PetscFunctionReturn(0);
}
