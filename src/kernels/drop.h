/*
   Foot of a point on a bilinear facet: natural coordinates at which p - x is along the normal, x being the point of the
   deformed facet. The normal is that of the undeformed facet, or, with area vectors a_i at its corners, n = sum_i w_i
   a_i, which need not be across the facet: then (I - n n' / n'n) a . (p - x) = 0, b alike, with the tangents a, b of the
   undeformed facet. The coordinates may lie outside [-1, 1], to say on which side of the facet the point is; they are
   kept within DROP_FAR, since a facet far outside itself may fold. Pure functions; lengths in m.
*/
#pragma once

#include "facet.h"

#define DROP_FAR 3.0

/* Between -DROP_FAR and DROP_FAR */
static inline double DropLimit(double s)
{
  return s > DROP_FAR ? DROP_FAR : s < -DROP_FAR ? -DROP_FAR : s;
}

/* Takes the part along the interpolated normal out of two tangents */
static inline void DropAcross(const double area[4][3], double xi, double eta, double a[3], double b[3])
{
  double w[4], n[3], nn = 0, an = 0, bn = 0;

  FacetWeights(xi, eta, w);
  for (int d = 0; d < 3; d++) {
    n[d] = w[0] * area[0][d] + w[1] * area[1][d] + w[2] * area[2][d] + w[3] * area[3][d];
    nn += n[d] * n[d], an += a[d] * n[d], bn += b[d] * n[d];
  }
  for (int d = 0; d < 3; d++) {
    a[d] -= an / nn * n[d];
    b[d] -= bn / nn * n[d];
  }
}

/* Newton steps from the natural coordinates given; area NULL for the facet's own normal; 1 when they have converged */
static inline int FacetDrop(const double undeformed[4][3], const double area[4][3], const double deformed[4][3],
                            const double p[3], double natural[2])
{
  for (int it = 0; it < 30; it++) {
    double       x[3], a[3], b[3], a0[3], b0[3], aa = 0, ab = 0, ba = 0, bb = 0, ra = 0, rb = 0, det, step;
    const double xi = natural[0], eta = natural[1];

    FacetTangents(undeformed, xi, eta, x, a0, b0);
    if (area) DropAcross(area, xi, eta, a0, b0);
    FacetTangents(deformed, xi, eta, x, a, b);
    for (int d = 0; d < 3; d++) {
      aa += a0[d] * a[d], ab += a0[d] * b[d], ba += b0[d] * a[d], bb += b0[d] * b[d];
      ra += a0[d] * (p[d] - x[d]), rb += b0[d] * (p[d] - x[d]);
    }
    det = aa * bb - ab * ba;
    if (!(det > 0)) return 0;
    natural[0] = DropLimit(xi + (bb * ra - ab * rb) / det);
    natural[1] = DropLimit(eta + (aa * rb - ba * ra) / det);
    step       = fabs(natural[0] - xi) + fabs(natural[1] - eta);
    if (step < (area ? 1e-10 : 1e-6)) return 1; /* on a flat facet 1e-12 is left at most, on a warped one a hundredth */
  }
  return 0;
}
