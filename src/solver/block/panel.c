/*
   Products of tall and narrow matrices. A block of a few columns against a basis of hundreds is bound by the reading of
   the basis, which a general dgemm copies before it multiplies. Here PANEL_ROWS rows of all columns, which stay in the
   second cache, meet everything that they are needed for, four columns of the block at a time.
*/
#include "base/algebra/versions.h"
#include "panel.h"

/* Rows of a slice, a multiple of PANEL_STEP: 256 of 100 columns are 200 kB, within a second cache. */
#define PANEL_ROWS 256
#define PANEL_STEP 8 /* rows at a time */
#define PANEL_FOUR 4 /* columns of a block at a time */
/* Columns whose rows are asked for from memory before their turn. */
#define PANEL_AHEAD 6

typedef PetscScalar PanelLanes __attribute__((vector_size(32), aligned(8), may_alias));

/* A slice of V: rows, a multiple of PANEL_STEP, of n columns */
typedef struct {
  PetscInt           rows, n, stride;
  const PetscScalar *v;
} Slice;

/* Columns k and k + 1 of a slice, twice the last one where there is no other, and those that are asked for from memory
   meanwhile */
typedef struct {
  const PetscScalar *first, *second, *next[2];
} ColumnPair;

INTO_VERSIONS ColumnPair SlicePair(const Slice *s, PetscInt k)
{
  const PetscInt           last = s->n - 1;
  const PetscScalar *const v    = s->v;
  const size_t             d    = (size_t)s->stride;

  return (ColumnPair){v + k * d,
                      v + PetscMin(k + 1, last) * d,
                      {v + PetscMin(k + PANEL_AHEAD, last) * d, v + PetscMin(k + 1 + PANEL_AHEAD, last) * d}};
}

/* w -= V c for four columns w, PANEL_ROWS apart; c [n][4] */
INTO_VERSIONS void SliceSubtract(const Slice *s, const PetscScalar c[], PetscScalar w[])
{
  const PetscInt rows = s->rows, n = s->n;

  for (PetscInt k = 0; k < n; k += 2) {
    const ColumnPair v = SlicePair(s, k);
    PetscScalar      scale[2][PANEL_FOUR];

    for (int j = 0; j < PANEL_FOUR; j++) {
      scale[0][j] = c[k * PANEL_FOUR + j];
      scale[1][j] = k + 1 < n ? c[(k + 1) * PANEL_FOUR + j] : 0;
    }
    for (PetscInt r = 0; r < rows; r += PANEL_STEP) {
      __builtin_prefetch(&v.next[0][r]);
      __builtin_prefetch(&v.next[1][r]);
      for (PetscInt h = r; h < r + PANEL_STEP; h += 4) {
        const PanelLanes first = *(const PanelLanes *)&v.first[h], second = *(const PanelLanes *)&v.second[h];

        for (int j = 0; j < PANEL_FOUR; j++) {
          PanelLanes *const x = (PanelLanes *)&w[j * PANEL_ROWS + h];

          *x = *x - scale[0][j] * first - scale[1][j] * second;
        }
      }
    }
  }
}

/* product[4][n] += V' w for four columns w, PANEL_ROWS apart. Two columns of V at a time: eight sums in registers,
   each number read for four products. Sums of four lanes are added at the end, in a fixed order. */
INTO_VERSIONS void SliceProduct(const Slice *s, const PetscScalar w[], PetscScalar product[])
{
  const PetscInt rows = s->rows, n = s->n;

  for (PetscInt k = 0; k < n; k += 2) {
    const ColumnPair v = SlicePair(s, k);
    PanelLanes       sum[2][PANEL_FOUR];

    for (int h = 0; h < 2; h++)
      for (int j = 0; j < PANEL_FOUR; j++) sum[h][j] = (PanelLanes){0};
    for (PetscInt r = 0; r < rows; r += PANEL_STEP) {
      __builtin_prefetch(&v.next[0][r]);
      __builtin_prefetch(&v.next[1][r]);
      for (PetscInt h = r; h < r + PANEL_STEP; h += 4)
        for (int j = 0; j < PANEL_FOUR; j++) {
          const PanelLanes x = *(const PanelLanes *)&w[j * PANEL_ROWS + h];

          sum[0][j] += x * *(const PanelLanes *)&v.first[h];
          sum[1][j] += x * *(const PanelLanes *)&v.second[h];
        }
    }
    for (int j = 0; j < PANEL_FOUR; j++)
      for (PetscInt h = 0; h < PetscMin(2, n - k); h++)
        product[(size_t)j * n + k + h] += (sum[h][j][0] + sum[h][j][1]) + (sum[h][j][2] + sum[h][j][3]);
  }
}

static VERSIONS void SliceSubtractAll(const Slice *s, PetscInt fours, const PetscScalar c[], PetscScalar w[])
{
  for (PetscInt f = 0; f < fours; f++)
    SliceSubtract(s, &c[(size_t)f * PANEL_FOUR * s->n], &w[f * PANEL_FOUR * PANEL_ROWS]);
}

static VERSIONS void SliceProductAll(const Slice *s, PetscInt fours, const PetscScalar w[], PetscScalar product[])
{
  for (PetscInt f = 0; f < fours; f++)
    SliceProduct(s, &w[f * PANEL_FOUR * PANEL_ROWS], &product[(size_t)f * PANEL_FOUR * s->n]);
}

/* What a walk through the slices works with; columns of the block are filled up to a multiple of four with zeros */
typedef struct {
  PetscInt     n, m, fours;
  PetscScalar *c, *t;          /* [fours][n][4] C and [fours][4 fours][4] -T */
  PetscScalar *w, *turned;     /* [4 fours][PANEL_ROWS] the block in a slice, and times T */
  PetscScalar *product, *gram; /* [4 fours][n], [4 fours][4 fours] sums */
  PetscScalar *rest;           /* [n][PANEL_STEP] the last rows of V */
} PanelWork;

/* A [m][n] by columns as [fours][height][4], times scale */
static void PanelPack(PetscInt n, PetscInt height, PetscInt m, PetscReal scale, const PetscScalar A[],
                      PetscScalar packed[])
{
  for (PetscInt j = 0; j < m; j++)
    for (PetscInt k = 0; k < n; k++)
      packed[((size_t)(j / PANEL_FOUR) * height + k) * PANEL_FOUR + j % PANEL_FOUR] = scale * A[(size_t)j * n + k];
}

static PetscErrorCode PanelWorkCreate(PetscInt n, PetscInt m, PanelWork *work)
{
  const size_t fours = (size_t)(m + PANEL_FOUR - 1) / PANEL_FOUR, all = PANEL_FOUR * fours;

  PetscFunctionBeginUser;
  *work = (PanelWork){.n = n, .m = m, .fours = (PetscInt)fours};
  PetscCall(PetscCalloc3(all * n, &work->c, all * all, &work->t, (size_t)n * PANEL_STEP, &work->rest));
  PetscCall(PetscCalloc4(all * PANEL_ROWS, &work->w, all * PANEL_ROWS, &work->turned, all * n, &work->product,
                         all * all, &work->gram));
  PetscFunctionReturn(0);
}

static PetscErrorCode PanelWorkDestroy(PanelWork *work)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree3(work->c, work->t, work->rest));
  PetscCall(PetscFree4(work->w, work->turned, work->product, work->gram));
  PetscFunctionReturn(0);
}

/* The slice from row `first` on, of PANEL_ROWS or the last ones, and how many of its rows are real. The last rows,
   fewer than PANEL_STEP, are copied and filled up with zeros, which add nothing. */
static PetscInt PanelCut(const Panel *V, PetscInt first, PanelWork *work, Slice *s)
{
  const PetscInt left = PetscMin(PANEL_ROWS, V->rows - first);

  *s = (Slice){left - left % PANEL_STEP, V->columns, V->stride, V->a + first};
  if (s->rows) return s->rows;
  for (PetscInt k = 0; k < V->columns; k++) {
    PetscScalar *const column = &work->rest[(size_t)k * PANEL_STEP];

    for (PetscInt r = 0; r < PANEL_STEP; r++) column[r] = r < left ? V->a[(size_t)k * V->stride + first + r] : 0;
  }
  s->rows   = PANEL_STEP;
  s->stride = PANEL_STEP;
  s->v      = work->rest;
  return left;
}

/* `real` rows of the block from row `first` on, zeros behind them */
static PetscErrorCode PanelLoad(const Panel *W, PetscInt first, PetscInt real, PanelWork *work)
{
  PetscFunctionBeginUser;
  for (PetscInt j = 0; j < work->m; j++) {
    PetscScalar *const w = &work->w[j * PANEL_ROWS];

    PetscCall(PetscArraycpy(w, &W->a[(size_t)j * W->stride + first], real));
    for (PetscInt r = real; r < PANEL_STEP; r++) w[r] = 0;
  }
  PetscFunctionReturn(0);
}

PetscErrorCode PanelProduct(const Panel *V, const Panel *W, PetscScalar product[])
{
  PanelWork work;

  PetscFunctionBeginUser;
  PetscCall(PanelWorkCreate(V->columns, W->columns, &work));
  for (PetscInt first = 0, real; first < V->rows; first += real) {
    Slice slice;

    real = PanelCut(V, first, &work, &slice);
    PetscCall(PanelLoad(W, first, real, &work));
    SliceProductAll(&slice, work.fours, work.w, work.product);
  }
  PetscCall(PetscArraycpy(product, work.product, (size_t)V->columns * W->columns));
  PetscCall(PanelWorkDestroy(&work));
  PetscCall(PetscLogFlops(2. * V->rows * V->columns * W->columns));
  PetscFunctionReturn(0);
}

/* work->turned = work->w T where there is one, and what is written */
static const PetscScalar *PanelTurn(PetscBool has_T, PetscInt rows, PanelWork *work)
{
  const Slice block = {rows, PANEL_FOUR * work->fours, PANEL_ROWS, work->w};

  if (!has_T) return work->w;
  for (PetscInt i = 0; i < block.n * PANEL_ROWS; i++) work->turned[i] = 0;
  SliceSubtractAll(&block, work->fours, work->t, work->turned);
  return work->turned;
}

/* Products of V and of the block with the block w of a slice */
static void PanelMeasure(const Slice *slice, const PetscScalar w[], PanelWork *work)
{
  const Slice block = {slice->rows, PANEL_FOUR * work->fours, PANEL_ROWS, w};

  SliceProductAll(slice, work->fours, w, work->product);
  SliceProductAll(&block, work->fours, w, work->gram);
}

/* W := (W - V C) T, and where product is wanted V' W and W' W of the new W, by one walk through V: the slice that
   was subtracted from is still in the cache. */
PetscErrorCode PanelUpdate(const Panel *V, const PetscScalar C[], const PetscScalar T[], Panel *W,
                           PetscScalar product[], PetscScalar gram[])
{
  const PetscInt n = V->columns, m = W->columns;
  PanelWork      work;

  PetscFunctionBeginUser;
  PetscCall(PanelWorkCreate(n, m, &work));
  PanelPack(n, n, m, 1, C, work.c);
  if (T) PanelPack(m, PANEL_FOUR * work.fours, m, -1, T, work.t);
  for (PetscInt first = 0, real; first < V->rows; first += real) {
    const PetscScalar *w;
    Slice              slice;

    real = PanelCut(V, first, &work, &slice);
    PetscCall(PanelLoad(W, first, real, &work));
    SliceSubtractAll(&slice, work.fours, work.c, work.w);
    w = PanelTurn(T ? PETSC_TRUE : PETSC_FALSE, slice.rows, &work);
    if (product) PanelMeasure(&slice, w, &work);
    for (PetscInt j = 0; j < m; j++)
      PetscCall(PetscArraycpy(&W->a[(size_t)j * W->stride + first], &w[j * PANEL_ROWS], real));
  }
  if (product) PetscCall(PetscArraycpy(product, work.product, (size_t)n * m));
  for (PetscInt j = 0; j < m && product; j++)
    PetscCall(PetscArraycpy(&gram[j * m], &work.gram[(size_t)j * PANEL_FOUR * work.fours], m));
  PetscCall(PanelWorkDestroy(&work));
  PetscCall(PetscLogFlops((product ? 4. : 2.) * W->rows * (n + m) * m));
  PetscFunctionReturn(0);
}
