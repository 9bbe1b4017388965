/*
   Segments of mortar contact: the parts in which a facet of the slave and one of the master lie over each other, seen
   along the normal of the slave in its middle, and the integrals over them

      D_j = int N~_j dA,   M_jk = int N~_j N~_k dA,   C_jl = int N~_j N_l dA   (m^2)

   over the slave's area, N_l the shape functions of the master and N~_j those of the slave, or of second order

      corners  N~_c = N_c + alpha sum of N_s of the two sides beside it,   sides  N~_s = (1 - 2 alpha) N_s,

   and of nine nodes the products of such functions along both axes. They sum up to 1. The coefficients of u = sum_j
   N~_j u~_j are those of the nodes at corners, u~_s = (u_s - alpha (u_c1 + u_c2)) / (1 - 2 alpha) at sides.

   The pressures that dual functions have, sum_j p_j phi_j, int phi_j N~_k dA = delta_jk D_j, are linear over flat faces
   of affine maps where int N~_j x dA = D_j x_j, x_j the node: then p_j = p(x_j) makes int (sum_k p_k phi_k) N~_j dA =
   D_j p(x_j) that of p. The error of modes by the interface is then of the order of the mesh's, else one below it. It
   holds at corners with

      alpha = 1/12 (six nodes),   1/5 (eight nodes),   0 (nine nodes, there at all of them).

   At sides of six and eight nodes it cannot: N~_s vanishes on the other sides, hence is a multiple of N_s, and int N_s
   x dA lies within the face; functions beyond the faces around a node mend it (contact/mortar/edges.c). D_j > 0 on
   whole faces; on parts of one it may be negative (border.c).

   Points are mapped along that normal to both facets. Facets with straight sides are cut exactly, and integrals of flat
   ones whose map is affine are exact with rules of that degree. Those of curved sides are fans of triangles.
   B. Wohlmuth, Discretization methods and iterative solvers based on domain decomposition, 2001; A. Popp et al., Dual
   quadratic mortar finite element methods for 3D finite deformation contact, SIAM J. Sci. Comput. 34, 2012. Pure
   functions; lengths in m.
*/
#pragma once

#include "overlap.h"

#define SEGMENT_STRAIGHT 1e-10 /* of a side: a node between its ends is on the line, above rounding of places */

/* alpha of a surface with faces of these numbers of nodes: that of eight where it has any, else that of six */
static inline double SegmentAlpha(int has_six, int has_eight)
{
  return has_eight ? 1 / 5.0 : has_six ? 1 / 12.0 : 0;
}

/* theta: how far the centre int N~_s x dA / D_s of a side lies within a face, over the way from the side's middle to
   that of what is opposite, on affine maps; 0 of first order */
static inline double SegmentInward(int n, double alpha)
{
  return n == 6 ? 1 / 5.0 : n == 8 ? 1 / 3.0 : n == 9 ? 2 * alpha / (1 + 4 * alpha) : 0;
}

/* A facet seen along the normal: places of its nodes in the plane, and convex pieces [n][corners], counter-clockwise */
typedef struct {
  int nodes;
  const double (*x)[3];
  double at[FACET_NODES][2];
  int    n, corners;
  double piece[FAN_MOST][4][2];
} SegmentFacet;

/* Points of a rule on the triangle (0, 0), (1, 0), (0, 1), weights of sum 1/2 */
typedef struct {
  int n;
  const double (*point)[3];
} SegmentRule;

/* Integrals over segments of one facet of the slave, and over those with one of the master */
typedef struct {
  double area;                                           /* int dA */
  double d[FACET_NODES], mass[FACET_NODES][FACET_NODES]; /* D, M */
  double cross[FACET_NODES][FACET_NODES];                /* C */
} SegmentSums;

/* What is cut: a facet of the slave and one of the master, seen along the normal of the first */
typedef struct {
  const SegmentFacet *s, *m;
  const double       *normal; /* [3] */
  double              alpha;
  const SegmentRule  *rule;
} SegmentCut;

/* N~ from N */
static inline void SegmentTransform(int n, double alpha, double w[])
{
  const int m = FacetShapeOf(n)->n_corners;

  if (n == m) return;
  for (int i = 0; i < m; i++) w[i] += alpha * (w[m + i] + w[m + (i + m - 1) % m]) + (n == 9 ? alpha * alpha * w[8] : 0);
  for (int i = m; i < 2 * m; i++) w[i] = (1 - 2 * alpha) * (w[i] + (n == 9 ? alpha * w[8] : 0));
  if (n == 9) w[8] *= (1 - 2 * alpha) * (1 - 2 * alpha);
}

/* int N~_j dA over a whole facet, to the accuracy of the rule of its shape, m^2: N~ is linear in N */
static inline void SegmentWhole(int n, const double x[][3], double alpha, double whole[])
{
  FacetAreas(n, x, whole);
  SegmentTransform(n, alpha, whole);
}

/* u~ of node i as a sum of the values at the nodes, v[n] */
static inline void SegmentValue(int n, double alpha, int i, double v[])
{
  const int    m     = FacetShapeOf(n)->n_corners;
  const double scale = 1 / (1 - 2 * alpha);

  for (int k = 0; k < n; k++) v[k] = k == i;
  if (i < m) return;
  if (i < 2 * m) {
    v[i]               = scale;
    v[i - m]           = -alpha * scale;
    v[(i - m + 1) % m] = -alpha * scale;
    return;
  }
  for (int k = 0; k < n; k++) v[k] = scale * scale * (k == i ? 1 : k < m ? alpha * alpha : -alpha);
}

/* Whether the sides of a facet are straight in the plane and its corners turn one way */
static inline int SegmentIsPolygon(int n, const double at[][2])
{
  const int m     = FacetShapeOf(n)->n_corners;
  double    least = 0, most = 0;

  for (int i = 0; i < m; i++) {
    const double *a = at[i], *b = at[(i + 1) % m], turn = TriangleTwice(a, b, at[(i + 2) % m]);
    const double  square = (b[0] - a[0]) * (b[0] - a[0]) + (b[1] - a[1]) * (b[1] - a[1]);

    if (n > m && fabs(TriangleTwice(a, b, at[m + i])) > SEGMENT_STRAIGHT * square) return 0;
    least = turn < least ? turn : least;
    most  = turn > most ? turn : most;
  }
  return least == 0 || most == 0;
}

/* Turns pieces counter-clockwise */
static inline void SegmentTurn(SegmentFacet *f)
{
  for (int i = 0; i < f->n; i++) {
    double(*p)[2] = f->piece[i], twice = 0;

    for (int k = 2; k < f->corners; k++) twice += TriangleTwice(p[0], p[k - 1], p[k]);
    for (int d = 0; d < 2 && twice < 0; d++) {
      const double keep = p[1][d];

      p[1][d]              = p[f->corners - 1][d];
      p[f->corners - 1][d] = keep;
    }
  }
}

/* A facet seen along e[2]; x [n] is kept */
static inline void SegmentFacetMake(int n, const double x[][3], const double e[3][3], const double origin[3],
                                    SegmentFacet *f)
{
  FacetFan fan;

  f->nodes = n;
  f->x     = x;
  for (int i = 0; i < n; i++) FanPlace(e, origin, x[i], f->at[i]);
  if (SegmentIsPolygon(n, (const double(*)[2])f->at)) {
    f->n       = 1;
    f->corners = FacetShapeOf(n)->n_corners;
    for (int k = 0; k < 2 * f->corners; k++) f->piece[0][k / 2][k % 2] = f->at[k / 2][k % 2];
  } else {
    FanMake(n, x, e, origin, &fan);
    f->n       = fan.n;
    f->corners = 3;
    for (int k = 0; k < 6 * fan.n; k++) f->piece[k / 6][k / 2 % 3][k % 2] = fan.x[k / 6][k / 2 % 3][k % 2];
  }
  SegmentTurn(f);
}

/* Natural coordinates of a point of the plane, by Newton's method from the middle; affine facets take one step. 0
   where it does not converge */
static inline int SegmentLocate(const SegmentFacet *f, const double p[2], double natural[2])
{
  const FacetShape *shape = FacetShapeOf(f->nodes);

  for (int d = 0; d < 2; d++) natural[d] = shape->middle[d];
  for (int it = 0; it < 30; it++) {
    double w[FACET_NODES], dw[FACET_NODES][2], J[2][2] = {{0, 0}, {0, 0}}, r[2] = {p[0], p[1]}, det, step[2];

    shape->weights(natural[0], natural[1], w);
    shape->derivatives(natural[0], natural[1], dw);
    for (int i = 0; i < f->nodes; i++)
      for (int d = 0; d < 2; d++) {
        r[d] -= w[i] * f->at[i][d];
        for (int k = 0; k < 2; k++) J[d][k] += dw[i][k] * f->at[i][d];
      }
    det = J[0][0] * J[1][1] - J[0][1] * J[1][0];
    if (det == 0) return 0;
    step[0] = (J[1][1] * r[0] - J[0][1] * r[1]) / det;
    step[1] = (J[0][0] * r[1] - J[1][0] * r[0]) / det;
    for (int d = 0; d < 2; d++) natural[d] += step[d];
    if (fabs(step[0]) + fabs(step[1]) < 1e-13) return 1;
    if (it && fabs(step[0]) + fabs(step[1]) < 1e-11) return 1; /* squared by the step that was just made */
    if (fabs(natural[0]) + fabs(natural[1]) > 20) return 0;
  }
  return 0;
}

/* Adds one point of the plane, dA being its area there (m^2), times that of the slave over it. 0 where a map fails. */
static inline int SegmentAddPoint(const SegmentCut *cut, const double p[2], double dA, SegmentSums *sums)
{
  const SegmentFacet *s = cut->s, *m = cut->m;
  double              here[2], there[2], N[FACET_NODES], w[FACET_NODES], own[3];

  if (!SegmentLocate(s, p, here) || !SegmentLocate(m, p, there)) return 0;
  FacetNormal(s->nodes, s->x, here, own);
  dA *= Vec3Length(own) / fabs(Vec3Dot(own, cut->normal));
  FacetWeights(s->nodes, here, N);
  SegmentTransform(s->nodes, cut->alpha, N);
  FacetWeights(m->nodes, there, w);
  sums->area += dA;
  for (int j = 0; j < s->nodes; j++) {
    sums->d[j] += N[j] * dA;
    for (int k = 0; k < s->nodes; k++) sums->mass[j][k] += N[j] * N[k] * dA;
    for (int l = 0; l < m->nodes; l++) sums->cross[j][l] += N[j] * w[l] * dA;
  }
  return 1;
}

/* Adds what two convex pieces have in common, a polygon that is a fan of triangles from its first corner; 0 where a map
   fails */
static inline int SegmentAddPieces(const SegmentCut *cut, int i, int j, SegmentSums *sums)
{
  const SegmentFacet *s = cut->s, *m = cut->m;
  double              p[POLYGON_MOST][2];
  int                 n = s->corners, good = 1;

  for (int k = 0; k < 2 * n; k++) p[k / 2][k % 2] = s->piece[i][k / 2][k % 2];
  for (int k = 0; k < m->corners && n > 2; k++) n = PolygonCut(n, p, m->piece[j][k], m->piece[j][(k + 1) % m->corners]);
  for (int k = 1; k + 1 < n; k++) {
    const double twice = TriangleTwice(p[0], p[k], p[k + 1]);

    for (int q = 0; q < cut->rule->n && twice > 0; q++) {
      const double *L = cut->rule->point[q];
      double        at[2];

      for (int d = 0; d < 2; d++) at[d] = p[0][d] + L[0] * (p[k][d] - p[0][d]) + L[1] * (p[k + 1][d] - p[0][d]);
      if (!SegmentAddPoint(cut, at, L[2] * twice, sums)) good = 0;
    }
  }
  return good;
}

/* Degree of the shape functions in the natural coordinates */
static inline int SegmentDegree(int n)
{
  return n == 3 ? 1 : n == 8 ? 3 : n == 9 ? 4 : 2;
}

/* Whether the map of a facet to the plane is affine, to rounding */
static inline int SegmentIsAffine(const SegmentFacet *f)
{
  const int m    = FacetShapeOf(f->nodes)->n_corners;
  double    size = 0, off = 0;

  for (int d = 0; d < 2; d++) {
    const double *a = f->at[0], *b = f->at[1], *c = f->at[2];

    size += fabs(b[d] - a[d]) + fabs(c[d] - b[d]);
    if (m == 4) off += fabs(a[d] - b[d] + c[d] - f->at[3][d]);
    for (int i = 0; i < m && f->nodes > m; i++) off += fabs(2 * f->at[m + i][d] - f->at[i][d] - f->at[(i + 1) % m][d]);
    if (f->nodes == 9) off += fabs(2 * f->at[8][d] - a[d] - c[d]);
  }
  return off < SEGMENT_STRAIGHT * size;
}
