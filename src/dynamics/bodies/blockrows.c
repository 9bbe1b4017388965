/*
   Advance of bodies that are not swept, as that of swept ones (sweptbody.c). Of the symmetric half of K each block A of
   nodes i < j serves twice: g_i += A v_j, g_j += A' v_i. Both take the rows of A, loaded with the number behind each:
   the products of rows with v_j are summed over j and their components at the end, those with components of v_i are
   summed at once. Nodes that ranks share come first, so that the rows of these alone complete g there. The order of all
   sums is that of the blocks: runs repeat bitwise.
*/
#include "base/algebra/versions.h"
#include "bodiesimpl.h"

/* bytes of blocks that are asked for before their turn, some 110 blocks: the latency of memory at its speed */
#define AHEAD 8192

/* Sum of the first three numbers */
STENCIL_INLINE PetscReal BlockRowsSum(const StencilLanes *x)
{
  return (*x)[0] + (*x)[1] + (*x)[2];
}

/* y = row i times x, of a whole row; x of node 0 */
STENCIL_INLINE void BlockRowsApply(const BlockRows *rows, PetscInt i, const PetscReal x[], StencilLanes *y)
{
  StencilLanes sum[3] = {{0}, {0}, {0}};

  for (PetscInt k = rows->start[i]; k < rows->start[i + 1]; k++)
    for (int j = 0; j < 3; j++)
      sum[j] += *(const StencilLanes *)&rows->value[9 * k + 3 * j] * *(const StencilLanes *)&x[3 * rows->column[k]];
  for (int j = 0; j < 3; j++) (*y)[j] = BlockRowsSum(&sum[j]);
}

/* A row of a block. Volatile, so that it is loaded once: GCC would load it again for each of its two products, and the
   loads, many of them across two cache lines, are what limits the speed of blocks in cache */
STENCIL_INLINE void BlockRowsLoad(const PetscReal a[], StencilLanes *row)
{
  *row = *(const volatile StencilLanes *)a;
}

/* y [n][4] += row i and its mirror image, column i, times x; x of node 0. The diagonal block comes first in a row,
   and is symmetric. Reads of four numbers take one of the next node along: value[] and vectors are padded for it. */
STENCIL_INLINE void BlockRowsApplyBoth(const BlockRows *rows, PetscInt i, const PetscReal x[], PetscReal y[])
{
  const PetscReal *u = &x[3 * i], *a = &rows->value[9 * rows->start[i]];
  const PetscInt *column = &rows->column[rows->start[i]], *const end = &rows->column[rows->start[i + 1]];
  const StencilLanes own[3] = {{u[0], u[0], u[0], u[0]}, {u[1], u[1], u[1], u[1]}, {u[2], u[2], u[2], u[2]}};
  StencilLanes       sum[3];

  for (int j = 0; j < 3; j++) sum[j] = *(const StencilLanes *)&a[3 * j] * *(const StencilLanes *)u;
  while (++column < end) {
    const size_t       j  = (size_t)*column;
    const StencilLanes v  = *(const StencilLanes *)&x[3 * j];
    StencilLanes      *at = (StencilLanes *)&y[4 * j], g = {0};

    a += 9;
    __builtin_prefetch((const char *)a + AHEAD, 0, 3);
    for (int c = 0; c < 3; c++) {
      StencilLanes row;

      BlockRowsLoad(&a[3 * c], &row);
      sum[c] += row * v;
      g += row * own[c];
    }
    *at += g;
  }
  for (int j = 0; j < 3; j++) y[4 * i + j] += BlockRowsSum(&sum[j]);
}

VERSIONS
void BlockRowsMultiply(const BlockRows *rows, PetscInt begin, PetscInt end, const PetscReal x[], PetscReal y[])
{
  for (PetscInt i = begin; i < end; i++) {
    StencilLanes product;

    BlockRowsApply(rows, i, x, &product);
    for (int j = 0; j < 3; j++) y[3 * i + j] = product[j];
  }
}

/* Twice the energies, and the powers of damping, by components; the last number of each is void */
typedef struct {
  StencilLanes kinetic, strain, damping_old, damping;
} GeneralSums;

/* The first three numbers to y */
STENCIL_INLINE void GeneralStore(const StencilLanes *x, PetscReal y[])
{
  for (int j = 0; j < 3; j++) y[j] = (*x)[j];
}

/* Node i with g = K v and h = C v without the part of the mass, N/s and N: strain with the K u of before, then ku
   += dt g, d = h + alpha M v, f = -ku - d */
STENCIL_INLINE void GeneralAdvanceNode(const General *general, PetscInt i, const StencilLanes *g, const StencilLanes *h,
                                       const BodiesWork *w, GeneralSums *sums)
{
  const PetscInt     at = general->begin + 3 * i;
  const StencilLanes v = *(const StencilLanes *)&w->v[at], before = *(const StencilLanes *)&w->ku[at];
  const StencilLanes ku = before + w->dt * *g;
  StencilLanes       f  = -ku;

  sums->strain += *(const StencilLanes *)&w->u[at] * before;
  sums->kinetic += general->mass[i] * v * v;
  if (w->d) {
    const StencilLanes d = *h + general->alpha[i] * v;

    sums->damping_old += v * *(const StencilLanes *)&w->d[at];
    sums->damping += v * d;
    f -= d;
    GeneralStore(&d, &w->d[at]);
  }
  GeneralStore(&ku, &w->ku[at]);
  GeneralStore(&f, &w->f[at]);
}

/* Copies of what `work` has are local, since a store to a vector could change it */
VERSIONS
static void GeneralAdvanceNodes(const General *general, PetscInt begin, PetscInt end, BodiesWork *work)
{
  const General    of   = *general;
  const BodiesWork w    = *work;
  GeneralSums      sums = {{0}, {0}, {0}, {0}};

  for (PetscInt i = begin; i < end; i++) BlockRowsApplyBoth(&of.stiffness, i, w.v + of.begin, of.product);
  for (PetscInt i = begin; i < end; i++) {
    StencilLanes *product = (StencilLanes *)&of.product[4 * i];
    StencilLanes  g = *product, h = of.beta[i] * g;

    if (w.d && of.beta[i] < 0) BlockRowsApply(&of.damping, i, w.v + of.begin, &h);
    GeneralAdvanceNode(&of, i, &g, &h, &w, &sums);
    *product = (StencilLanes){0};
  }
  work->sums.kinetic += 0.5 * BlockRowsSum(&sums.kinetic);
  work->sums.strain += 0.5 * BlockRowsSum(&sums.strain);
  work->sums.damping_old += BlockRowsSum(&sums.damping_old);
  work->sums.damping += BlockRowsSum(&sums.damping);
}

PetscErrorCode GeneralAdvance(const General *general, PetscBool early, BodiesWork *w)
{
  const PetscInt begin = early ? 0 : general->n_early, end = early ? general->n_early : general->n;

  PetscFunctionBeginUser;
  GeneralAdvanceNodes(general, begin, end, w);
  if (end > begin)
    PetscCall(PetscLogFlops(2 * BLOCK_FLOPS *
                              (PetscLogDouble)(general->stiffness.start[end] - general->stiffness.start[begin]) +
                            NODE_FLOPS * (PetscLogDouble)(end - begin)));
  PetscFunctionReturn(0);
}
