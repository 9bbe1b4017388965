/*
   Stencil of a swept body: internal forces g = K v (N/s for velocities) line by line.

   Each line holds equal nodes k = 0 .. n - 1, so that line i feels a line j that shares a cell with it through the
   same 3 x 3 blocks at every k: A0 at the same k, A+ at k + 1, A- at k - 1. The cells are mirror symmetric along the
   line, hence with S = diag(1, 1, -1) in the components (p, q, c), c along the sweep, A- = S A+ S, and A0 of the
   cells before k is S A0 S of those after it:
      g_i[k] = sum_j  E0 u_j[k] + E1 (u_j[k+1] + u_j[k-1]) + O1 (u_j[k+1] - u_j[k-1])
   E even (pp, pq, qp, qq, cc), O odd (pc, qc, cp, cq): 14 numbers instead of 27. At the ends of open lines the
   neighbours beyond the end are zero, and what the missing cells of that side have in A0 is taken off again.

   Each component of a line is a row of numbers with ghosts before and after it. Eight nodes of a line are worked on
   at once.
*/
#pragma once

#include <stddef.h>

#define STENCIL_WIDTH        8
#define STENCIL_COEFFICIENTS 14 /* E0, E1: pp pq qp qq cc; O1: pc qc cp cq */

/* A vector register's worth of doubles, at any address */
typedef double StencilLanes __attribute__((vector_size(32), aligned(8), may_alias));

typedef struct {
  StencilLanes a, b;
} StencilVector;

#define STENCIL_INLINE static inline __attribute__((always_inline))

STENCIL_INLINE StencilVector StencilLoad(const double x[])
{
  return (StencilVector){*(const StencilLanes *)x, *(const StencilLanes *)(x + 4)};
}

STENCIL_INLINE void StencilStore(StencilVector y, double x[])
{
  *(StencilLanes *)x       = y.a;
  *(StencilLanes *)(x + 4) = y.b;
}

STENCIL_INLINE StencilVector StencilPlus(StencilVector x, StencilVector y)
{
  return (StencilVector){x.a + y.a, x.b + y.b};
}

STENCIL_INLINE StencilVector StencilMinus(StencilVector x, StencilVector y)
{
  return (StencilVector){x.a - y.a, x.b - y.b};
}

STENCIL_INLINE StencilVector StencilTimes(StencilVector x, StencilVector y)
{
  return (StencilVector){x.a * y.a, x.b * y.b};
}

/* y += c x */
STENCIL_INLINE void StencilAdd(double c, StencilVector x, StencilVector *y)
{
  y->a += c * x.a;
  y->b += c * x.b;
}

/* y += w x, each with each */
STENCIL_INLINE void StencilAddProduct(StencilVector w, StencilVector x, StencilVector *y)
{
  y->a += w.a * x.a;
  y->b += w.b * x.b;
}

STENCIL_INLINE double StencilSumLanes(const StencilLanes *x)
{
  return ((*x)[0] + (*x)[1]) + ((*x)[2] + (*x)[3]);
}

STENCIL_INLINE double StencilSum(StencilVector x)
{
  const StencilLanes sum = x.a + x.b;

  return StencilSumLanes(&sum);
}

/* Nodes and coefficients of one line's neighbours, itself among them */
typedef struct {
  int              n;
  const ptrdiff_t *at;                               /* [n] where node 0 of the first row of the neighbour stands */
  const double (*coefficient)[STENCIL_COEFFICIENTS]; /* [n] */
  const double (*before)[9]; /* [n] A0 of the cells before a node, column after column, and a number behind them all */
} StencilLine;

/* y += even coefficients e of x; y += odd coefficients o of x; components p, q, c */
STENCIL_INLINE void StencilEven(const double e[5], const StencilVector x[3], StencilVector y[3])
{
  StencilAdd(e[0], x[0], &y[0]);
  StencilAdd(e[1], x[1], &y[0]);
  StencilAdd(e[2], x[0], &y[1]);
  StencilAdd(e[3], x[1], &y[1]);
  StencilAdd(e[4], x[2], &y[2]);
}

STENCIL_INLINE void StencilOdd(const double o[4], const StencilVector x[3], StencilVector y[3])
{
  StencilAdd(o[0], x[2], &y[0]);
  StencilAdd(o[1], x[2], &y[1]);
  StencilAdd(o[2], x[0], &y[2]);
  StencilAdd(o[3], x[1], &y[2]);
}

/* g [3] at nodes k .. k + 7, as if lines had no ends; row [3] places of the rows of p, q, c behind the first one */
STENCIL_INLINE void StencilApply(const StencilLine *line, ptrdiff_t k, const ptrdiff_t row[3], const double u[],
                                 StencilVector g[3])
{
  for (int i = 0; i < 3; i++) g[i] = (StencilVector){{0}, {0}};
  for (int n = 0; n < line->n; n++) {
    const double *c = line->coefficient[n], *x = u + line->at[n] + k;
    StencilVector here[3], sum[3], difference[3];

    for (int i = 0; i < 3; i++) {
      const StencilVector after = StencilLoad(x + row[i] + 1), before = StencilLoad(x + row[i] - 1);

      here[i]       = StencilLoad(x + row[i]);
      sum[i]        = StencilPlus(after, before);
      difference[i] = StencilMinus(after, before);
    }
    StencilEven(&c[0], here, g);
    StencilEven(&c[5], sum, g);
    StencilOdd(&c[10], difference, g);
  }
}

/* What cells that are not there would add at node k: before it, or with mirror = -1 after it */
STENCIL_INLINE void StencilMissing(const StencilLine *line, ptrdiff_t k, double mirror, const ptrdiff_t row[3],
                                   const double u[], double g[3])
{
  StencilLanes sum[3] = {{0}, {0}, {0}};

  for (int n = 0; n < line->n; n++) {
    const double *a = line->before[n], *x = u + line->at[n] + k;

    sum[0] += *(const StencilLanes *)a * x[row[0]];
    sum[1] += *(const StencilLanes *)(a + 3) * x[row[1]];
    sum[2] += *(const StencilLanes *)(a + 6) * (mirror * x[row[2]]);
  }
  sum[0] += sum[1] + sum[2];
  g[0] = sum[0][0];
  g[1] = sum[0][1];
  g[2] = mirror * sum[0][2];
}
