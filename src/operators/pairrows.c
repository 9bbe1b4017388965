/*
   Rows of the closed pairs in the unknowns of a pencil, of the factors of K = K_even + left' right: those of all unknowns
   times Zr.

   Closed pairs that are mirror images of each other have, in the unknowns of one parity, rows of left and right that are
   equal or both opposite: l_p r_p' + l_q r_q' = 2 l_p r_p'. One of them stands for all, so that an update for friction needs
   a solve for each of these alone. Rows that are alike show in their products with a vector at random. Pairs in a
   plane, whose rows are zero in odd parities, are left out.
*/
#include "pencilimpl.h"
#include "base/gather.h"

#define TWINS_ALIKE 1e-11 /* of the largest product */
#define TWINS_ZERO  1e-14

/* Products of a row of left and one of right with the vector, and for how many rows it stands, 0 for none */
typedef struct {
  PetscReal product[2];
  PetscInt  weight;
} TwinRow;

/* Products of the rows of this rank */
static PetscErrorCode TwinsMultiply(const Mat factor[2], PetscInt *n, TwinRow *own[])
{
  PetscRandom        random;
  const PetscScalar *value;
  Vec                x, y;

  PetscFunctionBeginUser;
  PetscCall(MatCreateVecs(factor[0], &x, &y));
  PetscCall(PetscRandomCreate(PetscObjectComm((PetscObject)x), &random));
  PetscCall(VecSetRandom(x, random));
  PetscCall(PetscRandomDestroy(&random));
  PetscCall(VecGetLocalSize(y, n));
  PetscCall(PetscCalloc1(*n, own));
  for (int k = 0; k < 2; k++) {
    PetscCall(MatMult(factor[k], x, y));
    PetscCall(VecGetArrayRead(y, &value));
    for (PetscInt i = 0; i < *n; i++) (*own)[i].product[k] = PetscRealPart(value[i]);
    PetscCall(VecRestoreArrayRead(y, &value));
  }
  PetscCall(VecDestroy(&x));
  PetscCall(VecDestroy(&y));
  PetscFunctionReturn(0);
}

/* Whether two rows of left and right are alike, or both opposite */
static PetscBool TwinsAreAlike(const TwinRow *a, const TwinRow *b, const PetscReal largest[2])
{
  const PetscReal sign = a->product[1] * b->product[1] < 0 ? -1 : 1;

  for (int k = 0; k < 2; k++)
    if (PetscAbsReal(a->product[k] - sign * b->product[k]) > TWINS_ALIKE * largest[k]) return PETSC_FALSE;
  return PETSC_TRUE;
}

/* Magnitudes of the products with rows of right, in ascending order: the k-th is of row order[k] */
static PetscErrorCode TwinsSort(PetscInt n, const TwinRow all[], PetscReal size[], PetscInt order[])
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < n; i++) {
    size[i]  = PetscAbsReal(all[i].product[1]);
    order[i] = i;
  }
  PetscCall(PetscSortRealWithArrayInt(n, size, order));
  PetscFunctionReturn(0);
}

/* How many of n ascending numbers are below x */
static PetscInt TwinsCountBelow(PetscInt n, const PetscReal size[], PetscReal x)
{
  PetscInt low = 0;

  while (low < n) {
    const PetscInt middle = low + (n - low) / 2;

    if (size[middle] < x)
      low = middle + 1;
    else
      n = middle;
  }
  return low;
}

/* Weight of row i of all: rows that are alike, found among those of about the same product, where i is the first of them */
static PetscInt TwinsCount(PetscInt i, PetscInt n_all, const TwinRow all[], const PetscReal size[],
                           const PetscInt order[], const PetscReal largest[2])
{
  const PetscReal here = PetscAbsReal(all[i].product[1]), near = 2 * TWINS_ALIKE * largest[1];
  PetscInt        weight = 0;

  if (!(here > TWINS_ZERO * largest[1])) return 0;
  for (PetscInt k = TwinsCountBelow(n_all, size, here - near); k < n_all && size[k] <= here + near; k++) {
    if (!TwinsAreAlike(&all[i], &all[order[k]], largest)) continue;
    if (order[k] < i) return 0;
    weight++;
  }
  return weight;
}

/* Weight of each row of this rank, of which `first` is the first of all, and how many stand for any */
static PetscErrorCode TwinsWeigh(PetscInt n_all, const TwinRow all[], PetscInt first, PetscInt n, TwinRow own[],
                                 PetscInt *n_kept)
{
  PetscReal largest[2] = {0, 0}, *size;
  PetscInt *order;

  PetscFunctionBeginUser;
  *n_kept = 0;
  for (PetscInt i = 0; i < 2 * n_all; i++)
    largest[i % 2] = PetscMax(largest[i % 2], PetscAbsReal(all[i / 2].product[i % 2]));
  PetscCall(PetscMalloc2(n_all, &size, n_all, &order));
  PetscCall(TwinsSort(n_all, all, size, order));
  for (PetscInt i = 0; i < n; i++) {
    own[i].weight = TwinsCount(first + i, n_all, all, size, order, largest);
    *n_kept += own[i].weight > 0;
  }
  PetscCall(PetscFree2(size, order));
  PetscFunctionReturn(0);
}

/* Rows of A with a weight, times that for the left factor */
static PetscErrorCode TwinsCopy(Mat A, PetscBool is_left, PetscInt n_kept, const TwinRow own[], Mat *B)
{
  PetscInt first, last, n_columns, longest = 0, row;

  PetscFunctionBeginUser;
  PetscCall(MatGetOwnershipRange(A, &first, &last));
  PetscCall(MatGetLocalSize(A, NULL, &n_columns));
  PetscCall(RowsLongest(A, &longest));
  PetscCall(MatCreateAIJ(PetscObjectComm((PetscObject)A), n_kept, n_columns, PETSC_DETERMINE, PETSC_DETERMINE, longest,
                         NULL, longest, NULL, B));
  PetscCall(MatGetOwnershipRange(*B, &row, NULL));
  for (PetscInt i = first; i < last; i++)
    if (own[i - first].weight) PetscCall(RowCopy(is_left ? (PetscReal)own[i - first].weight : 1, A, i, row++, *B));
  PetscCall(MatAssemblyBegin(*B, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(*B, MAT_FINAL_ASSEMBLY));
  PetscFunctionReturn(0);
}

/* Of rows of both factors that are alike one stands for all */
static PetscErrorCode TwinsCombine(Mat factor[2])
{
  PetscInt n, n_all, n_kept, first;
  TwinRow *own, *all;

  PetscFunctionBeginUser;
  PetscCall(TwinsMultiply(factor, &n, &own));
  PetscCall(GatherRecords(PetscObjectComm((PetscObject)factor[0]), n, sizeof(*own), own, &n_all, &all));
  PetscCall(MatGetOwnershipRange(factor[0], &first, NULL));
  PetscCall(TwinsWeigh(n_all, all, first, n, own, &n_kept));
  for (int k = 0; k < 2; k++) {
    Mat kept;

    PetscCall(TwinsCopy(factor[k], k ? PETSC_FALSE : PETSC_TRUE, n_kept, own, &kept));
    PetscCall(MatDestroy(&factor[k]));
    factor[k] = kept;
  }
  PetscCall(PetscFree(own));
  PetscCall(PetscFree(all));
  PetscFunctionReturn(0);
}

/* Rows A of all unknowns become A Zr, where there is a Zr */
static PetscErrorCode PencilProjectRows(Pencil pencil, Mat *A)
{
  Mat projected;

  PetscFunctionBeginUser;
  if (!*A || !pencil->Zr) PetscFunctionReturn(0);
  PetscCall(MatMatMult(*A, pencil->Zr, MAT_INITIAL_MATRIX, PETSC_DEFAULT, &projected));
  PetscCall(MatProductClear(projected));
  PetscCall(MatDestroy(A));
  *A = projected;
  PetscFunctionReturn(0);
}

PetscErrorCode PencilFormFactors(Pencil pencil)
{
  PetscFunctionBeginUser;
  if (pencil->has_factors) PetscFunctionReturn(0);
  for (int i = 0; i < 2; i++) PetscCall(MatDestroy(&pencil->factor[i]));
  PetscCall(TermsFormFactors(&pencil->base, pencil->parameters.p, &pencil->factor[0], &pencil->factor[1]));
  for (int i = 0; i < 2; i++) PetscCall(PencilProjectRows(pencil, &pencil->factor[i]));
  if (pencil->is_part && pencil->factor[0]) PetscCall(TwinsCombine(pencil->factor));
  pencil->has_factors = PETSC_TRUE;
  PetscFunctionReturn(0);
}
