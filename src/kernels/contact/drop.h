/*
   Foot of a point on a facet: natural coordinates at which p - x is along the normal, x being the point of the deformed
   facet. The normal is that of the undeformed facet, or, with vectors a_i at its nodes, n = sum_i w_i a_i, which need
   not be across the facet: then (I - n n' / n'n) a . (p - x) = 0, b alike, with the tangents a, b of the undeformed
   facet. The coordinates may lie outside of the facet, to say on which side of it the point is; they are kept within
   what its shape allows, since a facet far outside itself may fold. Pure functions; lengths in m.
*/
#pragma once

#include "facet.h"

/* Between low and high */
static inline double DropLimit(double s, double low, double high)
{
  return s > high ? high : s < low ? low : s;
}

/* Takes the part along the interpolated normal out of two tangents */
static inline void DropAcross(int n_nodes, const double area[][3], const double at[2], double a[3], double b[3])
{
  double w[FACET_NODES], n[3], nn = 0, an = 0, bn = 0;

  FacetWeights(n_nodes, at, w);
  FacetSum(n_nodes, w, area, n);
  for (int d = 0; d < 3; d++) nn += n[d] * n[d], an += a[d] * n[d], bn += b[d] * n[d];
  for (int d = 0; d < 3; d++) {
    a[d] -= an / nn * n[d];
    b[d] -= bn / nn * n[d];
  }
}

/* Made for four nodes once more, where GCC would not */
#if defined(__GNUC__)
__attribute__((always_inline))
#endif
static inline int
DropSteps(int n, const double undeformed[][3], const double area[][3], const double deformed[][3], const double p[3],
          double natural[2])
{
  const double low = FacetShapeOf(n)->low, high = FacetShapeOf(n)->high;

  for (int it = 0; it < 30; it++) {
    double       x[3], a[3], b[3], a0[3], b0[3], aa = 0, ab = 0, ba = 0, bb = 0, ra = 0, rb = 0, det, step;
    const double xi = natural[0], eta = natural[1];

    FacetTangents(n, undeformed, natural, x, a0, b0);
    if (area) DropAcross(n, area, natural, a0, b0);
    FacetTangents(n, deformed, natural, x, a, b);
    for (int d = 0; d < 3; d++) {
      aa += a0[d] * a[d], ab += a0[d] * b[d], ba += b0[d] * a[d], bb += b0[d] * b[d];
      ra += a0[d] * (p[d] - x[d]), rb += b0[d] * (p[d] - x[d]);
    }
    det = aa * bb - ab * ba;
    if (!(det > 0)) return 0;
    natural[0] = DropLimit(xi + (bb * ra - ab * rb) / det, low, high);
    natural[1] = DropLimit(eta + (aa * rb - ba * ra) / det, low, high);
    step       = fabs(natural[0] - xi) + fabs(natural[1] - eta);
    if (step < (area ? 1e-10 : 1e-6)) return 1; /* on a flat facet 1e-12 is left at most, on a warped one a hundredth */
  }
  return 0;
}

/* Newton steps from the natural coordinates given; area NULL for the facet's own normal; 1 when they have converged */
static inline int FacetDrop(int n, const double undeformed[][3], const double area[][3], const double deformed[][3],
                            const double p[3], double natural[2])
{
  return n == 4 ? DropSteps(4, undeformed, area, deformed, p, natural)
                : DropSteps(n, undeformed, area, deformed, p, natural);
}
