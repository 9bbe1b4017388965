/*
   Bilinear quadrilateral facet of a surface in space: x(xi, eta) = sum_i w_i(xi, eta) x_i, corners counter-clockwise
   from (-1, -1); w_i = (1 + xi xi_i)(1 + eta eta_i) / 4. Pure functions; lengths in m.
*/
#pragma once

#include "base/vec3.h"
#include <math.h>

/* Weights of the four corners at (xi, eta) */
static inline void FacetWeights(double xi, double eta, double w[4])
{
  w[0] = (1 - xi) * (1 - eta) / 4;
  w[1] = (1 + xi) * (1 - eta) / 4;
  w[2] = (1 + xi) * (1 + eta) / 4;
  w[3] = (1 - xi) * (1 + eta) / 4;
}

/* Point and tangents d x / d xi, d x / d eta at (xi, eta) */
static inline void FacetTangents(const double x[4][3], double xi, double eta, double point[3], double a[3], double b[3])
{
  double w[4];

  FacetWeights(xi, eta, w);
  for (int d = 0; d < 3; d++) {
    point[d] = w[0] * x[0][d] + w[1] * x[1][d] + w[2] * x[2][d] + w[3] * x[3][d];
    a[d]     = ((1 - eta) * (x[1][d] - x[0][d]) + (1 + eta) * (x[2][d] - x[3][d])) / 4;
    b[d]     = ((1 - xi) * (x[3][d] - x[0][d]) + (1 + xi) * (x[2][d] - x[1][d])) / 4;
  }
}

/* Normal a x b at (xi, eta); its length is the area (m^2) of a unit square of (xi, eta) */
static inline void FacetNormal(const double x[4][3], double xi, double eta, double n[3])
{
  double p[3], a[3], b[3];

  FacetTangents(x, xi, eta, p, a, b);
  Vec3Cross(a, b, n);
}

/* Corner shares of the area vector, integral of w_i n dA (m^2); 2 x 2 Gauss points are exact */
static inline void FacetAreaNormals(const double x[4][3], double share[4][3])
{
  static const double g[2] = {-0.57735026918962576451, 0.57735026918962576451};

  for (int i = 0; i < 4; i++) share[i][0] = share[i][1] = share[i][2] = 0;
  for (int q = 0; q < 4; q++) {
    double w[4], n[3];

    FacetWeights(g[q % 2], g[q / 2], w);
    FacetNormal(x, g[q % 2], g[q / 2], n);
    for (int i = 0; i < 4; i++)
      for (int d = 0; d < 3; d++) share[i][d] += w[i] * n[d];
  }
}

/* Vectors c (m) that turn the corner shares of the area vector, d share_i = sum_j u_j x c_ij for displacements u_j of
   the corners; of the derivative of int w_i (x_,xi x x_,eta), by the same quadrature */
static inline void FacetTurning(const double x[4][3], double c[4][4][3])
{
  static const double g = 0.57735026918962576451, sign[4][2] = {
                                                    {-1, -1},
                                                    {1,  -1},
                                                    {1,  1 },
                                                    {-1, 1 }
  };

  for (int k = 0; k < 48; k++) c[k / 12][k / 3 % 4][k % 3] = 0;
  for (int q = 0; q < 4; q++) {
    const double xi = g * sign[q][0], eta = g * sign[q][1];
    double       w[4], p[3], a[3], b[3];

    FacetWeights(xi, eta, w);
    FacetTangents(x, xi, eta, p, a, b);
    for (int k = 0; k < 48; k++) {
      const double *s = sign[k / 3 % 4];

      c[k / 12][k / 3 % 4][k % 3] +=
        w[k / 12] * (s[0] * (1 + s[1] * eta) * b[k % 3] - s[1] * (1 + s[0] * xi) * a[k % 3]) / 4;
    }
  }
}

/* Moves a natural coordinate into [-1, 1]; values within 1e-9 of an end or of the middle become exact */
static inline double FacetSnap(double s)
{
  if (s > 1 - 1e-9) return 1;
  if (s < -1 + 1e-9) return -1;
  return fabs(s) < 1e-9 ? 0 : s;
}

/* Point of the facet nearest to p by projected Gauss-Newton steps; returns the distance (m) and its natural
   coordinates */
static inline double FacetProject(const double x[4][3], const double p[3], double natural[2])
{
  double xi = 0, eta = 0, q[3], a[3], b[3], distance = 0;

  for (int it = 0; it < 20; it++) {
    double       aa = 0, ab = 0, bb = 0, ra = 0, rb = 0, det, step;
    const double xi0 = xi, eta0 = eta;

    FacetTangents(x, xi, eta, q, a, b);
    for (int d = 0; d < 3; d++) {
      aa += a[d] * a[d], ab += a[d] * b[d], bb += b[d] * b[d];
      ra += a[d] * (p[d] - q[d]), rb += b[d] * (p[d] - q[d]);
    }
    det = aa * bb - ab * ab;
    if (det <= 0) break;
    xi   = fmin(1, fmax(-1, xi + (bb * ra - ab * rb) / det));
    eta  = fmin(1, fmax(-1, eta + (aa * rb - ab * ra) / det));
    step = fmax(fabs(xi - xi0), fabs(eta - eta0));
    if (step < 1e-14) break;
  }
  natural[0] = FacetSnap(xi);
  natural[1] = FacetSnap(eta);
  FacetTangents(x, natural[0], natural[1], q, a, b);
  for (int d = 0; d < 3; d++) distance += (p[d] - q[d]) * (p[d] - q[d]);
  return sqrt(distance);
}
