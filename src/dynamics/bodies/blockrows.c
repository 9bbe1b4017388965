/*
   Advance of bodies that are not swept, as that of swept ones (sweptbody.c). Of the symmetric half of K each block A of
   nodes i < j serves twice: g_i += A v_j, g_j += A' v_i. Both take the rows of A, loaded with the number behind each:
   the products of rows with v_j are summed over j and their components at the end, those with components of v_i are
   summed at once. Nodes that ranks share come first, so that the rows of these alone complete g there.
*/
#include "base/versions.h"
#include "bodiesimpl.h"

/* Sum of the first three numbers */
STENCIL_INLINE PetscReal BlockRowsSum(const StencilLanes *x)
{
  return (*x)[0] + (*x)[1] + (*x)[2];
}

/* y [3] = row i times x, of a whole row; x of node 0 */
STENCIL_INLINE void BlockRowsApply(const BlockRows *rows, PetscInt i, const PetscReal x[], PetscReal y[])
{
  StencilLanes sum[3] = {{0}, {0}, {0}};

  for (PetscInt k = rows->start[i]; k < rows->start[i + 1]; k++)
    for (int j = 0; j < 3; j++)
      sum[j] += *(const StencilLanes *)&rows->value[9 * k + 3 * j] * *(const StencilLanes *)&x[3 * rows->column[k]];
  for (int j = 0; j < 3; j++) y[j] = BlockRowsSum(&sum[j]);
}

/* y [n][4] += row i and its mirror image, column i, times x; x of node 0 */
STENCIL_INLINE void BlockRowsApplyBoth(const BlockRows *rows, PetscInt i, const PetscReal x[], PetscReal y[])
{
  const PetscReal   *u = &x[3 * i], *a = &rows->value[9 * rows->start[i]];
  const StencilLanes own[3] = {
    {u[0], u[0], u[0], 0},
    {u[1], u[1], u[1], 0},
    {u[2], u[2], u[2], 0}
  };
  StencilLanes sum[3];

  for (int j = 0; j < 3; j++) sum[j] = *(const StencilLanes *)&a[3 * j] * *(const StencilLanes *)u;
  for (PetscInt k = rows->start[i] + 1; k < rows->start[i + 1]; k++) {
    const StencilLanes v  = *(const StencilLanes *)&x[3 * rows->column[k]];
    StencilLanes      *at = (StencilLanes *)&y[4 * rows->column[k]], g = *at;

    a = &rows->value[9 * k];
    for (int j = 0; j < 3; j++) {
      const StencilLanes row = *(const StencilLanes *)&a[3 * j];

      sum[j] += row * v;
      g += row * own[j];
    }
    *at = g;
  }
  for (int j = 0; j < 3; j++) y[4 * i + j] += BlockRowsSum(&sum[j]);
}

/* Node i with g = K v and h = C v without the part of the mass */
STENCIL_INLINE void GeneralAdvanceNode(const General *general, PetscInt i, const PetscReal g[], const PetscReal h[],
                                       BodiesWork *w)
{
  const PetscInt  at = general->begin + 3 * i;
  const PetscReal m = general->mass[i], alpha = general->alpha[i];

  for (PetscInt j = 0; j < 3; j++) {
    const PetscReal v = w->v[at + j];

    w->sums.strain += 0.5 * w->u[at + j] * w->ku[at + j];
    w->sums.kinetic += 0.5 * m * v * v;
    w->ku[at + j] += w->dt * g[j];
    w->f[at + j] = -w->ku[at + j];
    if (!w->d) continue;
    w->sums.damping_old += v * w->d[at + j];
    w->d[at + j] = h[j] + alpha * v;
    w->sums.damping += v * w->d[at + j];
    w->f[at + j] -= w->d[at + j];
  }
}

VERSIONS
static void GeneralAdvanceNodes(const General *general, PetscInt begin, PetscInt end, BodiesWork *w)
{
  const PetscReal *const v = w->v + general->begin;

  for (PetscInt i = begin; i < end; i++) BlockRowsApplyBoth(&general->stiffness, i, v, general->product);
  for (PetscInt i = begin; i < end; i++) {
    PetscReal *g = &general->product[4 * i], h[3];

    if (w->d && general->beta[i] < 0)
      BlockRowsApply(&general->damping, i, v, h);
    else
      for (int j = 0; j < 3; j++) h[j] = general->beta[i] * g[j];
    GeneralAdvanceNode(general, i, g, h, w);
    for (int j = 0; j < 4; j++) g[j] = 0;
  }
}

PetscErrorCode GeneralAdvance(const General *general, PetscBool early, BodiesWork *w)
{
  PetscFunctionBeginUser;
  if (early)
    GeneralAdvanceNodes(general, 0, general->n_early, w);
  else
    GeneralAdvanceNodes(general, general->n_early, general->n, w);
  PetscFunctionReturn(0);
}
