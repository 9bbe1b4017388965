/*
   A point that a rigid arm g (m) holds off a facet, at x(xi) + g, moves by

      u = sum_i w_i u_i + omega x g,   omega = sum_i [(h_i x n) (n . u_i) + n (n . (h_i x u_i)) / 2],

   where h_i = grad_s w_i = w_i,xi a^1 + w_i,eta a^2 with a^1 = b x n / J, a^2 = n x a / J of the tangents a, b, and J n
   = a x b. omega is the turning of the facet at xi: of rigid motions u_i = t + w x x_i it is w, on curved facets too,
   since sum_i h_i x_i' is the identity of the tangent plane. Pure.
*/
#pragma once

#include "facet.h"

/* Unit normal of a facet at natural coordinates, and the surface gradients h (1/m) of its weights */
static inline void FacetGradients(int n, const double x[][3], const double at[2], double normal[3], double h[][3])
{
  double dw[FACET_NODES][2], point[3], a[3], b[3], dual[2][3], area;

  FacetTangents(n, x, at, point, a, b);
  FacetShapeOf(n)->derivatives(at[0], at[1], dw);
  Vec3Cross(a, b, normal);
  area = Vec3Normalise(normal);
  Vec3Cross(b, normal, dual[0]);
  Vec3Cross(normal, a, dual[1]);
  for (int i = 0; i < n; i++)
    for (int d = 0; d < 3; d++) h[i][d] = (dw[i][0] * dual[0][d] + dw[i][1] * dual[1][d]) / area;
}

/* Matrices A_i, row-major [n][9], such that the point moves by sum_i A_i u_i */
static inline void FacetArm(int n, const double x[][3], const double at[2], const double g[3], double A[][9])
{
  double normal[3], h[FACET_NODES][3], w[FACET_NODES];

  FacetWeights(n, at, w);
  FacetGradients(n, x, at, normal, h);
  for (int i = 0; i < n; i++) {
    double turn[3], spin[3];

    Vec3Cross(h[i], normal, turn);
    Vec3Cross(normal, h[i], spin);
    for (int e = 0; e < 3; e++) {
      double omega[3], moved[3];

      for (int d = 0; d < 3; d++) omega[d] = turn[d] * normal[e] + normal[d] * spin[e] / 2;
      Vec3Cross(omega, g, moved);
      for (int d = 0; d < 3; d++) A[i][3 * d + e] = moved[d] + (d == e ? w[i] : 0);
    }
  }
}
