/*
   Shapes of facets, a table: x(xi, eta) = sum_i w_i(xi, eta) x_i. Corners stand counter-clockwise, then the nodes
   between corners i and i + 1, then the middle one. Quadrilaterals have xi and eta in [-1, 1] from corner (-1, -1) on;
   triangles L_0 = 1 - xi - eta, L_1 = xi, L_2 = eta >= 0. The number of nodes tells the shape:

      3   w_i = L_i
      4   w_i = (1 + xi xi_i) (1 + eta eta_i) / 4
      6   w_i = L_i (2 L_i - 1) at corners, 4 L_i L_i+1 between them
      8   w_i = (1 + xi xi_i) (1 + eta eta_i) (xi xi_i + eta eta_i - 1) / 4 at corners, (1 - xi^2) (1 + eta eta_i) / 2
          or (1 - eta^2) (1 + xi xi_i) / 2 between them
      9   products of the quadratic Lagrange polynomials at -1, 0, 1

   Of second order are 6, 8 and 9, whose weights may be negative. A further shape is one more row.
*/
#pragma once

#include "kernels/element/quadrature.h"
#include <math.h>

#define FACET_NODES 9 /* of a facet, at most */

typedef struct {
  int n, n_corners;
  void (*weights)(double xi, double eta, double w[]);
  void (*derivatives)(double xi, double eta, double dw[][2]);
  void (*clamp)(double at[2]); /* into the facet */
  void (*snap)(double at[2]);  /* what is within 1e-9 of a corner, edge or half of one becomes exact */
  const double (*node)[2];     /* natural coordinates */
  const double (*edge)[3];     /* e_0 + e_1 xi + e_2 eta is how far a point is beyond edge i; 2 is a facet */
  const double (*point)[3];    /* xi, eta, weight of a quadrature, exact for int w_i x_,xi x x_,eta */
  int    n_points;
  double middle[2], area; /* of the natural domain */
  double low, high;       /* how far beyond the facet natural coordinates are followed */
  double lump[3];         /* of a corner, a side, the middle: int w_i^2 scaled to `area`; 0 of first order */
  double hull[3];         /* factors of corners, sides, middle in a last point of the hull; 0 for none */
} FacetShape;

/* Of first order */
static inline void Triangle3Weights(double xi, double eta, double w[])
{
  w[0] = (1 - xi) - eta;
  w[1] = xi;
  w[2] = eta;
}

static inline void Triangle3Derivatives(double xi, double eta, double dw[][2])
{
  (void)xi, (void)eta;
  for (int d = 0; d < 2; d++)
    for (int i = 0; i < 3; i++) dw[i][d] = i == 0 ? -1 : i == d + 1;
}

static inline void Square4Weights(double xi, double eta, double w[])
{
  w[0] = (1 - xi) * (1 - eta) / 4;
  w[1] = (1 + xi) * (1 - eta) / 4;
  w[2] = (1 + xi) * (1 + eta) / 4;
  w[3] = (1 - xi) * (1 + eta) / 4;
}

static const double square_node[FACET_NODES][2] = {{-1, -1}, {1, -1}, {1, 1},  {-1, 1}, {0, -1},
                                                   {1, 0},   {0, 1},  {-1, 0}, {0, 0}};

static inline void Square4Derivatives(double xi, double eta, double dw[][2])
{
  for (int i = 0; i < 4; i++) {
    const double *s = square_node[i];

    dw[i][0] = s[0] * (1 + s[1] * eta) / 4;
    dw[i][1] = s[1] * (1 + s[0] * xi) / 4;
  }
}

/* Of second order, with L of the three corners and their derivatives */
static inline void Triangle6Weights(double xi, double eta, double w[])
{
  double L[3];

  Triangle3Weights(xi, eta, L);
  for (int i = 0; i < 3; i++) {
    w[i]     = L[i] * (2 * L[i] - 1);
    w[3 + i] = 4 * L[i] * L[(i + 1) % 3];
  }
}

static inline void Triangle6Derivatives(double xi, double eta, double dw[][2])
{
  double L[3], dL[3][2];

  Triangle3Weights(xi, eta, L);
  Triangle3Derivatives(xi, eta, dL);
  for (int i = 0; i < 3; i++)
    for (int d = 0; d < 2; d++) {
      const int j = (i + 1) % 3;

      dw[i][d]     = (4 * L[i] - 1) * dL[i][d];
      dw[3 + i][d] = 4 * (dL[i][d] * L[j] + L[i] * dL[j][d]);
    }
}

static inline void Square8Weights(double xi, double eta, double w[])
{
  for (int i = 0; i < 8; i++) {
    const double a = xi * square_node[i][0], b = eta * square_node[i][1];

    if (i < 4)
      w[i] = (1 + a) * (1 + b) * (a + b - 1) / 4;
    else
      w[i] = i % 2 == 0 ? (1 - xi * xi) * (1 + b) / 2 : (1 - eta * eta) * (1 + a) / 2;
  }
}

static inline void Square8Derivatives(double xi, double eta, double dw[][2])
{
  for (int i = 0; i < 8; i++) {
    const double *s = square_node[i], a = xi * s[0], b = eta * s[1];

    if (i < 4) {
      dw[i][0] = s[0] * (1 + b) * (2 * a + b) / 4;
      dw[i][1] = s[1] * (1 + a) * (2 * b + a) / 4;
    } else {
      dw[i][0] = i % 2 == 0 ? -xi * (1 + b) : (1 - eta * eta) * s[0] / 2;
      dw[i][1] = i % 2 == 0 ? (1 - xi * xi) * s[1] / 2 : -eta * (1 + a);
    }
  }
}

/* Lagrange polynomial that is 1 at node -1, 0 or 1, and its derivative */
static inline double Line3Weight(double node, double s)
{
  return node == 0 ? (1 - s) * (1 + s) : s * (s + node) / 2;
}

static inline double Line3Derivative(double node, double s)
{
  return node == 0 ? -2 * s : s + node / 2;
}

static inline void Square9Weights(double xi, double eta, double w[])
{
  for (int i = 0; i < 9; i++) w[i] = Line3Weight(square_node[i][0], xi) * Line3Weight(square_node[i][1], eta);
}

static inline void Square9Derivatives(double xi, double eta, double dw[][2])
{
  for (int i = 0; i < 9; i++) {
    const double *s = square_node[i];

    dw[i][0] = Line3Derivative(s[0], xi) * Line3Weight(s[1], eta);
    dw[i][1] = Line3Weight(s[0], xi) * Line3Derivative(s[1], eta);
  }
}

static inline double Square4Snap(double s)
{
  if (s > 1 - 1e-9) return 1;
  if (s < -1 + 1e-9) return -1;
  return fabs(s) < 1e-9 ? 0 : s;
}

static inline void SquareSnap(double at[2])
{
  for (int d = 0; d < 2; d++) at[d] = Square4Snap(at[d]);
}

static inline void SquareClamp(double at[2])
{
  for (int d = 0; d < 2; d++) at[d] = fmax(-1, fmin(1, at[d]));
}

/* L_0 = (1 - xi) - eta is then exact too, as the weights form it */
static inline void TriangleSnap(double at[2])
{
  for (int d = 0; d < 2; d++) at[d] = (Square4Snap(2 * at[d] - 1) + 1) / 2;
  if (fabs((1 - at[0]) - at[1]) < 1e-9) at[1] = 1 - at[0];
  if (fabs((1 - at[0]) - at[1] - 0.5) < 1e-9) at[1] = 0.5 - at[0];
}

/* Across the edge that is passed most, as in an equilateral triangle, then into a corner */
static inline void TriangleClamp(double at[2])
{
  double L[3], least;
  int    i = 0;

  Triangle3Weights(at[0], at[1], L);
  for (int k = 1; k < 3; k++) i = L[k] < L[i] ? k : i;
  if (!(L[i] < 0)) return;
  least = L[i];
  L[i]  = 0;
  for (int k = 1; k < 3; k++) L[(i + k) % 3] += least / 2;
  for (int k = 0; k < 3; k++) L[k] = fmax(0, fmin(1, L[k]));
  at[0] = L[1];
  at[1] = i == 0 ? 1 - L[1] : L[2];
}

static const double square_edge[4][3] = {{-1, 0, -1}, {-1, 1, 0}, {-1, 0, 1}, {-1, -1, 0}};

static const double triangle_edge[3][3] = {{0, 0, -2}, {-2, 2, 2}, {0, -2, 0}};

static const double triangle_node[6][2] = {{0, 0}, {1, 0}, {0, 1}, {0.5, 0}, {0.5, 0.5}, {0, 0.5}};

static const double square4_point[4][3] = {
  {-GAUSS2, -GAUSS2, 1}, {GAUSS2, -GAUSS2, 1}, {-GAUSS2, GAUSS2, 1}, {GAUSS2, GAUSS2, 1}};

static const double square9_point[9][3] = {
  {-GAUSS3, -GAUSS3, 25 / 81.0}, {0, -GAUSS3, 40 / 81.0}, {GAUSS3, -GAUSS3, 25 / 81.0},
  {-GAUSS3, 0, 40 / 81.0},       {0, 0, 64 / 81.0},       {GAUSS3, 0, 40 / 81.0},
  {-GAUSS3, GAUSS3, 25 / 81.0},  {0, GAUSS3, 40 / 81.0},  {GAUSS3, GAUSS3, 25 / 81.0}};

static const double triangle1_point[1][3] = {{1 / 3.0, 1 / 3.0, 0.5}};

/* Radon's rule of degree 5 (quadrature.h) */
static const double triangle7_point[7][3] = {
  {1 / 3.0, 1 / 3.0, TRI_WM}, {TRI_A, TRI_A, TRI_WA},  {TRI_A1, TRI_A, TRI_WA}, {TRI_A, TRI_A1, TRI_WA},
  {TRI_B, TRI_B, TRI_WB},     {TRI_B1, TRI_B, TRI_WB}, {TRI_B, TRI_B1, TRI_WB}};

#define SQUARE                                                                                                         \
  .n_corners = 4, .clamp = SquareClamp, .snap = SquareSnap, .node = square_node, .edge = square_edge, .area = 4
#define TRIANGLE                                                                                                       \
  .n_corners = 3, .clamp = TriangleClamp, .snap = TriangleSnap, .node = triangle_node, .edge = triangle_edge,          \
  .area = 0.5, .middle = {1 / 3.0, 1 / 3.0}

static const FacetShape facet_triangle3 = {TRIANGLE,
                                           .n           = 3,
                                           .weights     = Triangle3Weights,
                                           .derivatives = Triangle3Derivatives,
                                           .point       = triangle1_point,
                                           .n_points    = 1,
                                           .low         = -1,
                                           .high        = 2};
static const FacetShape facet_square4   = {SQUARE,
                                           .n           = 4,
                                           .weights     = Square4Weights,
                                           .derivatives = Square4Derivatives,
                                           .point       = square4_point,
                                           .n_points    = 4,
                                           .low         = -3,
                                           .high        = 3};
static const FacetShape facet_triangle6 = {TRIANGLE,
                                           .n           = 6,
                                           .weights     = Triangle6Weights,
                                           .derivatives = Triangle6Derivatives,
                                           .point       = triangle7_point,
                                           .n_points    = 7,
                                           .low         = -0.5,
                                           .high        = 1.5,
                                           .lump        = {1 / 38.0, 8 / 57.0}};
static const FacetShape facet_square8   = {SQUARE,
                                           .n           = 8,
                                           .weights     = Square8Weights,
                                           .derivatives = Square8Derivatives,
                                           .point       = square9_point,
                                           .n_points    = 9,
                                           .low         = -2,
                                           .high        = 2,
                                           .lump        = {3 / 19.0, 16 / 19.0},
                                           .hull        = {-0.75, 1}};
static const FacetShape facet_square9   = {SQUARE,
                                           .n           = 9,
                                           .weights     = Square9Weights,
                                           .derivatives = Square9Derivatives,
                                           .point       = square9_point,
                                           .n_points    = 9,
                                           .low         = -2,
                                           .high        = 2,
                                           .lump        = {1 / 9.0, 4 / 9.0, 16 / 9.0},
                                           .hull        = {0.25, -1, 4}};

/* By the number of nodes */
static const FacetShape *const facet_shapes[FACET_NODES + 1] = {
  0, 0, 0, &facet_triangle3, &facet_square4, 0, &facet_triangle6, 0, &facet_square8, &facet_square9};

/* The shape of n nodes: 3, 4, 6, 8 or 9 */
static inline const FacetShape *FacetShapeOf(int n)
{
  return facet_shapes[n];
}
