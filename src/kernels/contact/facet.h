/*
   Facet of a surface in space, of n = 3, 4, 6, 8 or 9 nodes (facetshape.h): x(xi, eta) = sum_i w_i(xi, eta) x_i. Pure
   functions; lengths in m. Facets of four nodes, the most frequent ones, have lines of their own where steps in time
   come by.

   Shares of a node in the area A, with J = x_,xi x x_,eta = n |J|:
      consistent   int w_i n dA (m^2), for loads. Of a flat facet of six nodes it is 0 at corners, of eight below 0.
      positive     what a spring, a stiffness per area or a part of a force can go by: of first order int w_i dA, of
                   second A int w_i^2 dA / sum_j int w_j^2 dA; of nine nodes these are Simpson's weights.
   Area vector of a node, of which the normal of a surface is the mean: of first order int w_i n dA, of second l_i J at
   the node, with the constants l_i of the positive shares: that of the facet itself there, with a positive weight.
*/
#pragma once

#include "base/algebra/vec3.h"
#include "facetshape.h"

/* Weights of the nodes at natural coordinates */
static inline void FacetWeights(int n, const double at[2], double w[])
{
  if (n == 4)
    Square4Weights(at[0], at[1], w);
  else
    FacetShapeOf(n)->weights(at[0], at[1], w);
}

/* sum_i w_i y_i of vectors at the nodes */
static inline void FacetSum(int n, const double w[], const double y[][3], double sum[3])
{
  for (int d = 0; d < 3; d++)
    sum[d] = n == 4 ? w[0] * y[0][d] + w[1] * y[1][d] + w[2] * y[2][d] + w[3] * y[3][d] : w[0] * y[0][d];
  for (int i = 1; i < n && n != 4; i++)
    for (int d = 0; d < 3; d++) sum[d] += w[i] * y[i][d];
}

/* Point and tangents of any facet */
static inline void FacetTangentsOf(const FacetShape *shape, const double x[][3], const double at[2], double point[3],
                                   double a[3], double b[3])
{
  double w[FACET_NODES], dw[FACET_NODES][2];

  shape->weights(at[0], at[1], w);
  shape->derivatives(at[0], at[1], dw);
  FacetSum(shape->n, w, x, point);
  for (int d = 0; d < 3; d++) a[d] = b[d] = 0;
  for (int i = 0; i < shape->n; i++)
    for (int d = 0; d < 3; d++) {
      a[d] += dw[i][0] * x[i][d];
      b[d] += dw[i][1] * x[i][d];
    }
}

/* Point and tangents d x / d xi, d x / d eta at natural coordinates */
static inline void FacetTangents(int n, const double x[][3], const double at[2], double point[3], double a[3],
                                 double b[3])
{
  const double xi = at[0], eta = at[1];
  double       w[4];

  if (n != 4) {
    FacetTangentsOf(FacetShapeOf(n), x, at, point, a, b);
    return;
  }
  Square4Weights(xi, eta, w);
  FacetSum(4, w, x, point);
  for (int d = 0; d < 3; d++) {
    a[d] = ((1 - eta) * (x[1][d] - x[0][d]) + (1 + eta) * (x[2][d] - x[3][d])) / 4;
    b[d] = ((1 - xi) * (x[3][d] - x[0][d]) + (1 + xi) * (x[2][d] - x[1][d])) / 4;
  }
}

/* Normal a x b at natural coordinates; its length is the area (m^2) of a unit square of them */
static inline void FacetNormal(int n, const double x[][3], const double at[2], double normal[3])
{
  double p[3], a[3], b[3];

  FacetTangents(n, x, at, p, a, b);
  Vec3Cross(a, b, normal);
}

/* Normal in the middle; its length is the area of a flat facet whose sides are straight, and halved by their nodes */
static inline void FacetMiddleNormal(int n, const double x[][3], double normal[3])
{
  const FacetShape *shape = FacetShapeOf(n);

  FacetNormal(n, x, shape->middle, normal);
  for (int d = 0; d < 3; d++) normal[d] *= shape->area;
}

/* Consistent shares of the area vector, integral of w_i n dA (m^2), exact */
static inline void FacetAreaNormals(int n, const double x[][3], double share[][3])
{
  const FacetShape *shape = FacetShapeOf(n);

  for (int i = 0; i < n; i++) share[i][0] = share[i][1] = share[i][2] = 0;
  for (int q = 0; q < shape->n_points; q++) {
    const double *at = shape->point[q];
    double        w[FACET_NODES], normal[3];

    FacetWeights(n, at, w);
    FacetNormal(n, x, at, normal);
    for (int i = 0; i < n; i++)
      for (int d = 0; d < 3; d++) share[i][d] += at[2] * w[i] * normal[d];
  }
}

/* Matrix int w_i w_j dA (m^2), row-major [n][n], by the quadrature of the shape: of second order exact where sides are
   straight, opposite ones parallel, and halved by their nodes */
static inline void FacetMass(int n, const double x[][3], double mass[])
{
  const FacetShape *shape = FacetShapeOf(n);

  for (int k = 0; k < n * n; k++) mass[k] = 0;
  for (int q = 0; q < shape->n_points; q++) {
    const double *at = shape->point[q];
    double        w[FACET_NODES], normal[3], area;

    FacetWeights(n, at, w);
    FacetNormal(n, x, at, normal);
    area = at[2] * Vec3Length(normal);
    for (int k = 0; k < n * n; k++) mass[k] += w[k / n] * w[k % n] * area;
  }
}

/* Consistent shares of the area, integral of w_i dA (m^2) */
static inline void FacetAreas(int n, const double x[][3], double share[])
{
  const FacetShape *shape = FacetShapeOf(n);

  for (int i = 0; i < n; i++) share[i] = 0;
  for (int q = 0; q < shape->n_points; q++) {
    const double *at = shape->point[q];
    double        w[FACET_NODES], normal[3];

    FacetWeights(n, at, w);
    FacetNormal(n, x, at, normal);
    for (int i = 0; i < n; i++) share[i] += at[2] * w[i] * Vec3Length(normal);
  }
}

/* Positive shares of the area (m^2), which sum up to that of the consistent ones */
static inline void FacetPositiveAreas(int n, const double x[][3], double share[])
{
  double area = 0, sum = 0, mass[FACET_NODES * FACET_NODES];

  FacetAreas(n, x, share);
  if (FacetShapeOf(n)->lump[0] == 0) return;
  FacetMass(n, x, mass);
  for (int i = 0; i < n; i++) {
    area += share[i];
    sum += mass[(n + 1) * i];
  }
  for (int i = 0; i < n; i++) share[i] = mass[(n + 1) * i] * area / sum;
}

/* Points of the rule of the area vectors: their number, and place and weights of the nodes at one */
static inline int FacetRuleSize(const FacetShape *shape)
{
  return shape->lump[0] > 0 ? shape->n : shape->n_points;
}

static inline const double *FacetRulePoint(const FacetShape *shape, int q, double w[])
{
  const double *at = shape->lump[0] > 0 ? shape->node[q] : shape->point[q];

  if (shape->lump[0] > 0) {
    for (int i = 0; i < shape->n; i++) w[i] = i == q ? shape->lump[i / shape->n_corners] : 0;
  } else {
    shape->weights(at[0], at[1], w);
    for (int i = 0; i < shape->n; i++) w[i] *= at[2];
  }
  return at;
}

/* Area vectors of the nodes (m^2) */
static inline void FacetNodeNormals(int n, const double x[][3], double share[][3])
{
  const FacetShape *shape = FacetShapeOf(n);

  for (int i = 0; i < n; i++) share[i][0] = share[i][1] = share[i][2] = 0;
  for (int q = 0; q < FacetRuleSize(shape); q++) {
    double        w[FACET_NODES], normal[3];
    const double *at = FacetRulePoint(shape, q, w);

    FacetNormal(n, x, at, normal);
    for (int i = 0; i < n; i++)
      for (int d = 0; d < 3; d++) share[i][d] += w[i] * normal[d];
  }
}

/* Vectors c (m) that turn the area vectors of the nodes, d share_i = sum_j u_j x c_ij for displacements u_j of the
   nodes; of the derivative of w_i (x_,xi x x_,eta), by the same rule */
static inline void FacetTurning(int n, const double x[][3], double c[FACET_NODES][FACET_NODES][3])
{
  const FacetShape *shape = FacetShapeOf(n);

  for (int k = 0; k < 3 * n * n; k++) c[k / (3 * n)][k / 3 % n][k % 3] = 0;
  for (int q = 0; q < FacetRuleSize(shape); q++) {
    double        w[FACET_NODES], dw[FACET_NODES][2], p[3], a[3], b[3];
    const double *at = FacetRulePoint(shape, q, w);

    shape->derivatives(at[0], at[1], dw);
    FacetTangents(n, x, at, p, a, b);
    for (int k = 0; k < 3 * n * n; k++) {
      const double *s = dw[k / 3 % n];

      c[k / (3 * n)][k / 3 % n][k % 3] += w[k / (3 * n)] * (s[0] * b[k % 3] - s[1] * a[k % 3]);
    }
  }
}

/* How far natural coordinates are beyond the edge from corner `edge` to the next one; < 0 on its inner side */
static inline double FacetBeyondEdge(const FacetShape *shape, int edge, const double at[2])
{
  return shape->edge[edge][0] + shape->edge[edge][1] * at[0] + shape->edge[edge][2] * at[1];
}

/* How far they are beyond the facet */
static inline double FacetBeyond(int n, const double at[2])
{
  const FacetShape *shape;
  double            beyond = -2;

  if (n == 4) return (fabs(at[0]) > fabs(at[1]) ? fabs(at[0]) : fabs(at[1])) - 1;
  shape = FacetShapeOf(n);
  for (int e = 0; e < shape->n_corners; e++) beyond = fmax(beyond, FacetBeyondEdge(shape, e, at));
  return beyond;
}

/* Into the facet */
static inline void FacetClamp(int n, double at[2])
{
  if (n == 4)
    for (int d = 0; d < 2; d++) at[d] = at[d] > 1 ? 1 : at[d] < -1 ? -1 : at[d];
  else
    FacetShapeOf(n)->clamp(at);
}

/* Takes a point into low and high */
static inline void FacetBound(const double x[3], double low[3], double high[3])
{
  for (int d = 0; d < 3; d++) {
    low[d]  = x[d] < low[d] ? x[d] : low[d];
    high[d] = x[d] > high[d] ? x[d] : high[d];
  }
}

/* Takes all of a facet into low and high: its corners and, of second order, the control points of Bezier's form of it,
   whose hull holds it */
static inline void FacetBounds(int n, const double x[][3], double low[3], double high[3])
{
  const FacetShape *shape   = FacetShapeOf(n);
  const int         m       = shape->n_corners;
  double            last[3] = {0, 0, 0};

  for (int i = 0; i < m; i++) FacetBound(x[i], low, high);
  if (n == m) return;
  for (int i = 0; i < m; i++) {
    double side[3];

    for (int d = 0; d < 3; d++) side[d] = 2 * x[m + i][d] - (x[i][d] + x[(i + 1) % m][d]) / 2;
    FacetBound(side, low, high);
  }
  if (shape->hull[0] == 0) return;
  for (int i = 0; i < n; i++)
    for (int d = 0; d < 3; d++) last[d] += shape->hull[i / m] * x[i][d];
  FacetBound(last, low, high);
}
