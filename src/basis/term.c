/*
   V' A V of all terms, extended by new columns W at the end of V: V' A W, and (V' A' W)' in the new rows. Matrices that
   fill all rows are multiplied side by side, so that V is read once for all of them; those of a small part by their
   rows. Friction is

      V' (A + L' R) W = V' A W + (L V)' R W,   V' (A + L' R)' W = V' A W + (R V)' L W,   A = A'.

   Between new columns all entries are w_i'A'w_j as of rows: e_i, what rounding does to A'w_i, is of no concern then to
   a mode x that does not move where A is, e_i'x = 0. Taken from both sides, it is, and nothing states that error: 1e-10
   of a disc's mode beside a beam 1e6 times stiffer than it.
*/
#include "subspace.h"
#include "solver/block/orthonormal.h"

#define TERM_WIDTH 32  /* columns that are multiplied at once */
#define TERM_MOST  192 /* images of them at most */

/* The room is a quarter more than what is needed where that is more: a longer basis is a copy of it */
PetscErrorCode SubspaceAppend(PetscInt first, PetscInt room, BV block, BV V)
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

/* The matrices that products with W are needed of, each once: A of term t is columns[t], A' is rows[t]; -1 for none */
typedef struct {
  PetscInt m, *columns, *rows;
  Mat     *A;
} TermProducts;

/* Where A stands among the first m, or behind them */
static PetscInt TermFind(TermProducts *p, Mat A)
{
  PetscInt i = 0;

  while (i < p->m && p->A[i] != A) i++;
  if (i == p->m) p->A[p->m++] = A;
  return i;
}

static PetscErrorCode TermProductsCreate(const Subspace *s, TermProducts *p)
{
  PetscFunctionBeginUser;
  p->m = 0;
  PetscCall(PetscMalloc3(2 * s->n_terms, &p->A, s->n_terms, &p->columns, s->n_terms, &p->rows));
  for (PetscInt t = 0; t < s->n_terms; t++) {
    const SubspaceTerm *term = &s->term[t];

    p->columns[t] = term->transposed ? TermFind(p, term->A) : -1;
  }
  for (PetscInt t = 0; t < s->n_terms; t++)
    p->rows[t] = s->term[t].transposed ? TermFind(p, s->term[t].transposed) : -1;
  PetscFunctionReturn(0);
}

/* Columns j, j + 1, ... of the block, as many as there is room for */
static PetscErrorCode TermProductsFill(const Subspace *s, const TermProducts *p, PetscInt k, BV block, PetscInt *j)
{
  const PetscScalar *h;
  PetscInt           m, n, first;
  BV                 images;
  Mat                H;

  PetscFunctionBeginUser;
  PetscCall(BVGetActiveColumns(block, NULL, &m));
  n     = PetscMin(PetscMax(1, PetscMin(TERM_WIDTH, TERM_MOST / p->m)), m - *j);
  first = k - m + *j;
  PetscCall(BlockCreate(s->V, n * p->m, &images));
  PetscCall(BVSetActiveColumns(block, *j, *j + n));
  PetscCall(BlockMultiplySideBySide(p->m, p->A, block, images));
  PetscCall(BVSetActiveColumns(block, 0, m));
  PetscCall(BlockProducts(s->V, NULL, images, &H));
  PetscCall(BVDestroy(&images));
  PetscCall(MatDenseGetArrayRead(H, &h));
  for (PetscInt t = 0; t < s->n_terms; t++) {
    if (p->columns[t] < 0) continue;
    for (PetscInt c = 0; c < n; c++) {
      PetscCall(PetscArraycpy(&s->term[t].small[(first + c) * k], &h[(p->columns[t] * n + c) * k], k - m));
      for (PetscInt r = 0; r < k; r++) s->term[t].small[r * k + first + c] = h[(p->rows[t] * n + c) * k + r];
    }
  }
  PetscCall(MatDenseRestoreArrayRead(H, &h));
  PetscCall(MatDestroy(&H));
  *j += n;
  PetscFunctionReturn(0);
}

/* The rows of the images of new columns, of all ranks, behind those of `first` columns */
static PetscErrorCode FactorExtend(PetscInt first, BV images, SubspaceTerm *term, PetscReal **factor)
{
  const PetscScalar *local;
  PetscInt           n_own, n, stride, at = 0;
  PetscMPIInt        size, own, *count, *begin;
  MPI_Comm           comm = PetscObjectComm((PetscObject)images);
  Mat                columns;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(comm, &size));
  PetscCall(BVGetActiveColumns(images, NULL, &n));
  PetscCall(BVGetSizes(images, &n_own, &term->rank, NULL));
  PetscCall(PetscMalloc2(size, &count, size, &begin));
  PetscCall(PetscRealloc(sizeof(PetscReal) * (size_t)((first + n) * term->rank), factor));
  PetscCall(PetscMPIIntCast(n_own, &own));
  PetscCallMPI(MPI_Allgather(&own, 1, MPI_INT, count, 1, MPI_INT, comm));
  for (PetscMPIInt r = 0; r < size; r++) begin[r] = (PetscMPIInt)at, at += count[r];
  PetscCall(BVGetMat(images, &columns));
  PetscCall(MatDenseGetLDA(columns, &stride));
  PetscCall(MatDenseGetArrayRead(columns, &local));
  for (PetscInt j = 0; j < n; j++)
    PetscCallMPI(MPI_Allgatherv(local + j * stride, own, MPIU_SCALAR, *factor + (first + j) * term->rank, count, begin,
                                MPIU_SCALAR, comm));
  PetscCall(MatDenseRestoreArrayRead(columns, &local));
  PetscCall(BVRestoreMat(images, &columns));
  PetscCall(PetscFree2(count, begin));
  PetscFunctionReturn(0);
}

/* Adds V' L' R W in the rows before, and V' R' L W in the new ones; L V and R V follow */
static PetscErrorCode PairsExtend(const Subspace *s, PetscInt k, BV block, SubspaceTerm *term)
{
  const Mat          sides[2] = {term->left, term->right};
  const PetscScalar *h[2];
  PetscInt           n, first;
  BV                 images[2];
  Mat                H[2];

  PetscFunctionBeginUser;
  PetscCall(BVGetActiveColumns(block, NULL, &n));
  first = k - n;
  for (int i = 0; i < 2; i++) {
    PetscCall(BlockCreate(term->image[i], n, &images[i]));
    PetscCall(BlockMultiplySideBySide(1, &sides[i], block, images[i]));
    PetscCall(SubspaceAppend(first, s->room, images[i], term->image[i]));
    if (term->product) PetscCall(FactorExtend(first, images[i], term, &term->factor[i]));
  }
  for (int i = 0; i < 2; i++) {
    PetscCall(BlockProducts(term->image[i], NULL, images[1 - i], &H[i]));
    PetscCall(MatDenseGetArrayRead(H[i], &h[i]));
  }
  for (PetscInt c = 0; c < n; c++) {
    for (PetscInt r = 0; r < first; r++) term->small[(first + c) * k + r] += h[0][c * k + r];
    for (PetscInt r = 0; r < k; r++) term->small[r * k + first + c] += h[1][c * k + r];
  }
  for (int i = 0; i < 2; i++) {
    PetscCall(MatDenseRestoreArrayRead(H[i], &h[i]));
    PetscCall(MatDestroy(&H[i]));
    PetscCall(BVDestroy(&images[i]));
  }
  PetscFunctionReturn(0);
}

/* X' A Y for the active columns, A with few rows, into its place, and into the transposed one where that is not NULL */
static PetscErrorCode RowsFill(const SubspaceTerm *term, BV X, BV Y, PetscInt k, PetscReal *const place[2])
{
  PetscInt n;
  BV       AY;
  Mat      H;

  PetscFunctionBeginUser;
  PetscCall(BVGetActiveColumns(Y, NULL, &n));
  PetscCall(BVDuplicateResize(Y, n, &AY));
  PetscCall(BlockMultiplyVectors(term->A, Y, AY));
  PetscCall(EntryRowsProducts(&term->rows, X, NULL, AY, &H));
  PetscCall(BlockCopy(H, PETSC_FALSE, k, place[0]));
  if (place[1]) PetscCall(BlockCopy(H, PETSC_TRUE, k, place[1]));
  PetscCall(MatDestroy(&H));
  PetscCall(BVDestroy(&AY));
  PetscFunctionReturn(0);
}

/* One with few rows: of an unsymmetric one, products with all of V cost little */
static PetscErrorCode RowsExtend(const Subspace *s, PetscInt t, PetscInt k, BV block)
{
  const SubspaceTerm *term = &s->term[t];
  PetscReal          *columns, *rows;
  PetscInt            n;

  PetscFunctionBeginUser;
  PetscCall(BVGetActiveColumns(block, NULL, &n));
  columns = term->small + (k - n) * k;
  rows    = term->small + k - n;
  if (term->same < t) {
    PetscCall(PetscArraycpy(term->small, s->term[term->same].small, k * k));
    PetscFunctionReturn(0);
  }
  PetscCall(RowsFill(term, s->V, block, k, (PetscReal *[2]){columns, term->symmetric ? rows : NULL}));
  if (!term->symmetric) PetscCall(RowsFill(term, block, s->V, k, (PetscReal *[2]){rows, NULL}));
  PetscFunctionReturn(0);
}

/* Zeros in the last m columns and rows of small [k][k] */
static void TermClear(PetscInt k, PetscInt m, PetscReal small[])
{
  for (PetscInt c = k - m; c < k; c++)
    for (PetscInt r = 0; r < k; r++) small[c * k + r] = small[r * k + c] = 0;
}

PetscErrorCode SubspaceTermsExtend(Subspace *s, PetscInt k, BV block)
{
  TermProducts products;
  PetscInt     m, j = 0;

  PetscFunctionBeginUser;
  PetscCall(BVGetActiveColumns(block, NULL, &m));
  for (PetscInt t = 0; t < s->n_terms; t++)
    if (s->term[t].A) PetscCall(BlockGrow(k - m, k, &s->term[t].small));
  PetscCall(TermProductsCreate(s, &products));
  while (products.m && j < m) PetscCall(TermProductsFill(s, &products, k, block, &j));
  PetscCall(PetscFree3(products.A, products.columns, products.rows));
  for (PetscInt t = 0; t < s->n_terms; t++) {
    SubspaceTerm *term = &s->term[t];

    if (term->product && term->left) TermClear(k, m, term->small);
    if (term->left) PetscCall(PairsExtend(s, k, block, term));
    if (term->A && !term->transposed && !(term->product && term->left)) PetscCall(RowsExtend(s, t, k, block));
  }
  PetscFunctionReturn(0);
}
