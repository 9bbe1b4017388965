/*
   Unit test of solver/panel: products of tall matrices with narrow blocks against sums in long double, for numbers of rows
   and columns about the sizes of a slice and of a step. What a slice or a rest of it leaves out or takes twice, and columns
   that lie apart, would show. And solver/blockproduct, a sparse matrix times so many vectors, against MatMult(): what takes
   rows for alike that are not, or a rest of rows or columns for none, would show. And solver/blockfactor on a basis that is
   orthonormal but for little.
*/
#include "solver/block/orthonormal.h"
#include "solver/block/panel.h"
#include "check.h"
#include "petscmain.h"

#define APART   3 /* rows between the columns */
#define LOOSE_V 6 /* columns of a basis that is not orthonormal, and of a block */
#define LOOSE_W 4

/* Entries between -1 and 1, alike in every run */
static PetscErrorCode PanelMake(PetscInt rows, PetscInt columns, PetscReal phase, Panel *P)
{
  PetscFunctionBeginUser;
  *P = (Panel){rows, columns, rows + APART, NULL};
  PetscCall(PetscMalloc1((rows + APART) * columns + 1, &P->a));
  for (PetscInt i = 0; i < (rows + APART) * columns; i++) P->a[i] = sin(phase + 1.7 * i + 1e-3 * i * (PetscReal)i);
  PetscFunctionReturn(0);
}

/* Column i of V times column j of W */
static PetscReal Dot(const Panel *V, PetscInt i, const Panel *W, PetscInt j)
{
  long double sum = 0;

  for (PetscInt r = 0; r < V->rows; r++) sum += (long double)V->a[i * V->stride + r] * W->a[j * W->stride + r];
  return (PetscReal)sum;
}

/* The larger one, or what is no number */
static PetscReal Worse(PetscReal a, PetscReal b)
{
  return PetscIsNanReal(a) || b <= a ? a : b;
}

/* Largest |product - V' W| */
static PetscReal Difference(const Panel *V, const Panel *W, const PetscScalar product[])
{
  PetscReal worst = 0;

  for (PetscInt j = 0; j < W->columns; j++)
    for (PetscInt i = 0; i < V->columns; i++)
      worst = Worse(worst, PetscAbsReal(product[j * V->columns + i] - Dot(V, i, W, j)));
  return worst;
}

/* (W - V C) T, row r, column j */
static PetscReal Updated(const Panel *V, const Panel *C, const Panel *T, const Panel *W, PetscInt r, PetscInt j)
{
  long double sum = 0;

  for (PetscInt i = 0; i < W->columns; i++) {
    long double w = W->a[i * W->stride + r];

    for (PetscInt k = 0; k < V->columns; k++) w -= (long double)V->a[k * V->stride + r] * C->a[i * V->columns + k];
    sum += w * (T ? T->a[j * W->columns + i] : (i == j));
  }
  return (PetscReal)sum;
}

/* Raises *worst to the largest difference of the update by C and T, and of what is measured meanwhile where it is */
static PetscErrorCode UpdateDiffers(const Panel *V, const Panel *C, const Panel *T, const Panel *W, PetscBool measure,
                                    PetscReal *worst)
{
  const PetscInt n = V->columns, m = W->columns;
  PetscScalar   *product, *gram;
  Panel          X = *W;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc3(W->stride * m, &X.a, n * m + 1, &product, m * m, &gram));
  PetscCall(PetscArraycpy(X.a, W->a, W->stride * m));
  PetscCall(PanelUpdate(V, C->a, T ? T->a : NULL, &X, measure ? product : NULL, measure ? gram : NULL));
  if (measure) {
    *worst = Worse(*worst, Difference(V, &X, product) / (1 + W->rows));
    *worst = Worse(*worst, Difference(&X, &X, gram) / (1 + W->rows));
  }
  for (PetscInt j = 0; j < m; j++)
    for (PetscInt r = 0; r < W->stride; r++) {
      const PetscReal expected = r < W->rows ? Updated(V, C, T, W, r, j) : W->a[j * W->stride + r];

      *worst = Worse(*worst, PetscAbsReal(X.a[j * W->stride + r] - expected));
    }
  PetscCall(PetscFree3(X.a, product, gram));
  PetscFunctionReturn(0);
}

/* One size: the worst of all differences */
static PetscErrorCode SizeDiffers(PetscInt rows, PetscInt n, PetscInt m, PetscReal *worst)
{
  PetscScalar *product;
  Panel        V, W, C, T;

  PetscFunctionBeginUser;
  PetscCall(PanelMake(rows, n, 0.3, &V));
  PetscCall(PanelMake(rows, m, 1.1, &W));
  PetscCall(PanelMake(n, m, 2.3, &C)); /* taken as [m][n] */
  PetscCall(PanelMake(m, m, 0.7, &T));
  PetscCall(PetscMalloc1(n * m + 1, &product));
  PetscCall(PanelProduct(&V, &W, product));
  *worst = Difference(&V, &W, product) / (1 + rows);
  for (int measure = 0; measure < 2; measure++) {
    PetscCall(UpdateDiffers(&V, &C, &T, &W, measure ? PETSC_TRUE : PETSC_FALSE, worst));
    PetscCall(UpdateDiffers(&V, &C, NULL, &W, measure ? PETSC_TRUE : PETSC_FALSE, worst));
  }
  PetscCall(PetscFree(product));
  PetscCall(PetscFree(V.a));
  PetscCall(PetscFree(W.a));
  PetscCall(PetscFree(C.a));
  PetscCall(PetscFree(T.a));
  PetscFunctionReturn(0);
}

/* A sparse matrix whose rows are of many kinds: three with the same columns, three as long with others, and three that are
   longer and longer, of which the first may be empty */
static PetscErrorCode SparseMake(PetscInt rows, PetscInt columns, Mat *A)
{
  PetscFunctionBeginUser;
  PetscCall(MatCreateSeqAIJ(PETSC_COMM_SELF, rows, columns, columns, NULL, A));
  for (PetscInt i = 0; i < rows; i++) {
    const PetscInt kind = i / 3 % 3, length = kind == 2 ? i % 3 * 4 : 7, first = kind == 0 ? i / 3 : 2 * i;

    for (PetscInt k = 0; k < length; k++)
      PetscCall(MatSetValue(*A, i, (first + 5 * k) % columns, sin(i + 0.3 * k), INSERT_VALUES));
  }
  PetscCall(MatAssemblyBegin(*A, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(*A, MAT_FINAL_ASSEMBLY));
  PetscFunctionReturn(0);
}

/* Raises *worst to the largest difference of A X from its columns by MatMult(), for m columns that lie apart */
static PetscErrorCode ProductDiffers(Mat A, PetscInt m, PetscReal *worst)
{
  PetscInt  rows, columns;
  PetscReal norm;
  Panel     x, y;
  Mat       X, Y;

  PetscFunctionBeginUser;
  PetscCall(MatGetSize(A, &rows, &columns));
  PetscCall(PanelMake(columns, m, 0.4, &x));
  PetscCall(PanelMake(rows, m, 0.9, &y));
  PetscCall(MatCreateSeqDense(PETSC_COMM_SELF, columns, m, x.a, &X));
  PetscCall(MatCreateSeqDense(PETSC_COMM_SELF, rows, m, y.a, &Y));
  PetscCall(MatDenseSetLDA(X, x.stride));
  PetscCall(MatDenseSetLDA(Y, y.stride));
  PetscCall(BlockMultiply(A, X, Y));
  for (PetscInt j = 0; j < m; j++) {
    Vec u, v, expected;

    PetscCall(MatDenseGetColumnVecRead(X, j, &u));
    PetscCall(MatDenseGetColumnVecRead(Y, j, &v));
    PetscCall(VecDuplicate(v, &expected));
    PetscCall(MatMult(A, u, expected));
    PetscCall(VecAXPY(expected, -1, v));
    PetscCall(VecNorm(expected, NORM_INFINITY, &norm));
    *worst = Worse(*worst, norm);
    PetscCall(VecDestroy(&expected));
    PetscCall(MatDenseRestoreColumnVecRead(Y, j, &v));
    PetscCall(MatDenseRestoreColumnVecRead(X, j, &u));
  }
  PetscCall(MatDestroy(&X));
  PetscCall(MatDestroy(&Y));
  PetscCall(PetscFree(x.a));
  PetscCall(PetscFree(y.a));
  PetscFunctionReturn(0);
}

/* Sparse products of many sizes */
static PetscErrorCode TestSparse(int *failed)
{
  const PetscInt rows[] = {1, 3, 64, 200}, widths[] = {1, 7, 8, 9, 16, 19, 33};
  PetscReal      worst = 0;

  PetscFunctionBeginUser;
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(rows); i++) {
    Mat A;

    PetscCall(SparseMake(rows[i], 150, &A));
    for (size_t k = 0; k < PETSC_STATIC_ARRAY_LENGTH(widths); k++) PetscCall(ProductDiffers(A, widths[k], &worst));
    PetscCall(MatDestroy(&A));
  }
  *failed += CheckClose("sparse products of 28 sizes, largest difference", worst, 0, 1e-14);
  PetscFunctionReturn(0);
}

/* A diagonal matrix of positive entries */
static PetscErrorCode MassMake(PetscInt n, Mat *M)
{
  PetscFunctionBeginUser;
  PetscCall(MatCreateSeqAIJ(PETSC_COMM_SELF, n, n, 1, NULL, M));
  for (PetscInt i = 0; i < n; i++) PetscCall(MatSetValue(*M, i, i, 2 + sin(i), INSERT_VALUES));
  PetscCall(MatAssemblyBegin(*M, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(*M, MAT_FINAL_ASSEMBLY));
  PetscFunctionReturn(0);
}

/* The largest entry of X' M Y - d I */
static PetscErrorCode ProductsWorst(BV X, Mat M, BV Y, PetscReal d, PetscReal *worst)
{
  Mat H;

  PetscFunctionBeginUser;
  PetscCall(BlockProducts(X, M, Y, &H));
  if (d != 0) PetscCall(MatShift(H, -d));
  PetscCall(MatNorm(H, NORM_FROBENIUS, worst));
  PetscCall(MatDestroy(&H));
  PetscFunctionReturn(0);
}

/* V of LOOSE_V columns with V'MV of the identity but for a hundredth, which is in gram; and W = V c + 1e-4 random */
static PetscErrorCode LooseMake(Mat M, BV V, BV W, PetscReal gram[])
{
  PetscScalar  H[LOOSE_V * LOOSE_V], c[LOOSE_V * LOOSE_W];
  BlockFactors factors = {.ld = LOOSE_V, .most = LOOSE_V, .H = H};
  Mat          C, G;

  PetscFunctionBeginUser;
  PetscCall(BVSetRandom(V));
  PetscCall(BVSetRandom(W));
  PetscCall(BlockFactorise(W, 0, M, V, &factors));
  PetscCall(BVSetActiveColumns(W, 0, LOOSE_W));
  for (int i = 0; i < LOOSE_V * LOOSE_V; i++) H[i] = i % (LOOSE_V + 1) ? 0.01 * sin(i) : 1;
  for (int i = 0; i < LOOSE_V * LOOSE_W; i++) c[i] = cos(i);
  PetscCall(MatCreateSeqDense(PETSC_COMM_SELF, LOOSE_V, LOOSE_V, H, &G));
  PetscCall(BVMultInPlace(V, G, 0, LOOSE_V));
  PetscCall(MatDestroy(&G));
  PetscCall(BlockProducts(V, M, V, &G));
  PetscCall(BlockCopy(G, PETSC_FALSE, LOOSE_V, gram));
  PetscCall(MatDestroy(&G));
  PetscCall(MatCreateSeqDense(PETSC_COMM_SELF, LOOSE_V, LOOSE_W, c, &C));
  PetscCall(BVMult(W, 1, 1e-4, V, C));
  PetscCall(MatDestroy(&C));
  PetscFunctionReturn(0);
}

/* Breaks when: a basis that is not orthonormal is projected on without V'MV, a pass that is the last one leaves too much, or the
   factors are not those of the block. Reference: the block itself */
static PetscErrorCode TestLoose(int *failed)
{
  PetscScalar  H[(LOOSE_V + LOOSE_W) * LOOSE_W];
  PetscReal    gram[LOOSE_V * LOOSE_V], worst;
  BlockFactors factors = {.ld = LOOSE_V + LOOSE_W, .most = LOOSE_W, .H = H, .loose = 1e-3, .gram = gram};
  Mat          M, all;
  BV           V, W, before;

  PetscFunctionBeginUser;
  PetscCall(MassMake(300, &M));
  PetscCall(BVCreate(PETSC_COMM_SELF, &V));
  PetscCall(BVSetType(V, BVMAT));
  PetscCall(BVSetSizes(V, 300, 300, LOOSE_V));
  PetscCall(BlockCreate(V, LOOSE_W, &W));
  PetscCall(BlockCreate(V, LOOSE_W, &before));
  PetscCall(LooseMake(M, V, W, gram));
  PetscCall(BVCopy(W, before));
  PetscCall(BlockFactorise(V, LOOSE_V, M, W, &factors));
  PetscCall(ProductsWorst(V, M, W, 0, &worst));
  *failed += CheckClose("V'M Q of a loose V", worst, 0, 1e-6);
  PetscCall(ProductsWorst(W, M, W, 1, &worst));
  *failed += CheckClose("Q'M Q - I", worst, 0, 1e-6);
  PetscCall(BVResize(V, LOOSE_V + LOOSE_W, PETSC_TRUE));
  PetscCall(BVSetActiveColumns(V, LOOSE_V, LOOSE_V + LOOSE_W));
  PetscCall(BVCopy(W, V));
  PetscCall(BVSetActiveColumns(V, 0, LOOSE_V + LOOSE_W));
  PetscCall(MatCreateSeqDense(PETSC_COMM_SELF, LOOSE_V + LOOSE_W, LOOSE_W, H, &all));
  PetscCall(BVMult(before, -1, 1, V, all));
  PetscCall(ProductsWorst(before, NULL, before, 0, &worst));
  *failed += CheckClose("W - V C - Q R, squared", worst, 0, 1e-24);
  PetscCall(MatDestroy(&all));
  PetscCall(BVDestroy(&before));
  PetscCall(BVDestroy(&W));
  PetscCall(BVDestroy(&V));
  PetscCall(MatDestroy(&M));
  PetscFunctionReturn(0);
}

static PetscErrorCode TestPanel(PetscMPIInt size, int *failed)
{
  const PetscInt rows[] = {0, 1, 7, 8, 9, 255, 256, 263, 264, 521}, columns[] = {0, 1, 2, 7, 40},
                 widths[] = {1, 3, 4, 5, 8, 13};
  PetscReal worst         = 0, one;

  PetscFunctionBeginUser;
  (void)size;
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(rows); i++)
    for (size_t j = 0; j < PETSC_STATIC_ARRAY_LENGTH(columns); j++)
      for (size_t k = 0; k < PETSC_STATIC_ARRAY_LENGTH(widths); k++) {
        PetscCall(SizeDiffers(rows[i], columns[j], widths[k], &one));
        worst = Worse(worst, one);
      }
  *failed += CheckClose("300 sizes, largest difference", worst, 0, 1e-12);
  PetscCall(TestSparse(failed));
  PetscCall(SlepcInitialize(NULL, NULL, NULL, NULL));
  PetscCall(TestLoose(failed));
  PetscCall(SlepcFinalize());
  PetscFunctionReturn(0);
}

int main(int argc, char **argv)
{
  return PetscMain(argc, argv, TestPanel);
}
