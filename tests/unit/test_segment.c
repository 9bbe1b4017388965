/* Segments of mortar contact: integrals over facets of any shape under tiles of others against closed forms. Whole facets: D_j of the
   transformed shape functions, and int N~_j (x - x_j) dA = 0 at corners of second order and all of nine nodes. Facets of which tiles
   cover a part: the area, and int N~_j (x^m - x) dA = 0, since both facets hold the places of their points. Breaks when a piece or a
   corner is lost, a map or a transform is wrong, or the rule is too coarse */
#include "check.h"
#include "kernels/contact/segment.h"

#define POINTS 25

/* Gauss rule of five points a side on a square that is folded into the triangle, times the Jacobian: of degree 8 */
static SegmentRule Rule(double point[POINTS][3])
{
  static const double x[5] = {0.9061798459386640, 0.5384693101056831, 0, -0.5384693101056831, -0.9061798459386640};
  static const double w[5] = {0.2369268850561891, 0.4786286704993665, 0.5688888888888889, 0.4786286704993665,
                              0.2369268850561891};

  for (int i = 0; i < POINTS; i++) {
    const double a = (1 + x[i / 5]) / 2, b = (1 + x[i % 5]) / 2;

    point[i][0] = a;
    point[i][1] = b * (1 - a);
    point[i][2] = w[i / 5] * w[i % 5] / 4 * (1 - a);
  }
  return (SegmentRule){POINTS, (const double(*)[3])point};
}

/* A facet of n nodes of the size 1 at a place, turned; warp moves the third corner of a quadrilateral in the plane, and the
   nodes beside it, so that sides stay straight */
static void Place(int n, double angle, double dx, double dy, double warp, double x[][3])
{
  const FacetShape *shape = FacetShapeOf(n);

  for (int i = 0; i < n; i++) {
    const int    square = shape->n_corners == 4;
    const double r      = square ? (1 + shape->node[i][0]) / 2 : shape->node[i][0];
    const double s      = square ? (1 + shape->node[i][1]) / 2 : shape->node[i][1];
    const double a = r + warp * r * s * square - 0.5, b = s + 0.7 * warp * r * s * square - 0.5;

    x[i][0] = cos(angle) * a - sin(angle) * b + dx;
    x[i][1] = sin(angle) * a + cos(angle) * b + dy;
    x[i][2] = 0.1 * x[i][0] - 0.3 * x[i][1];
  }
}

/* Integrals of facet x under one of y */
static int Add(int n, const double x[][3], int m, const double y[][3], double alpha, SegmentSums *sums, double area[2])
{
  double       e[3][3], origin[3], point[POINTS][3];
  SegmentRule  rule = Rule(point);
  SegmentFacet s, t;
  FacetFan     f, g;
  int          good = 1;

  FanAxes(n, x, e, origin);
  SegmentFacetMake(n, x, (const double(*)[3])e, origin, &s);
  SegmentFacetMake(m, y, (const double(*)[3])e, origin, &t);
  FanMake(n, x, (const double(*)[3])e, origin, &f);
  FanMake(m, y, (const double(*)[3])e, origin, &g);
  area[0] += FanOverlap(&f, &g);
  area[1] = FanArea(&f);
  for (int i = 0; i < s.n; i++)
    for (int j = 0; j < t.n; j++) good &= SegmentAddPieces(&(SegmentCut){&s, &t, e[2], alpha, &rule}, i, j, sums);
  return !good;
}

static const int kinds[] = {3, 4, 6, 8, 9};

/* D_j of whole facets, over the area */
static int Whole(void)
{
  static const double share[][3] = {{1 / 3.0}, {0.25}, {1 / 18.0, 5 / 18.0}, {0.05, 0.2}, {1 / 36.0, 1 / 9.0, 4 / 9.0}};
  int                 fails      = 0;

  for (int i = 0; i < 5; i++) {
    const int    n = kinds[i], m = FacetShapeOf(n)->n_corners;
    const double alpha = SegmentAlpha(n == 6, n == 8);
    double       x[FACET_NODES][3], area[2] = {0, 0};
    SegmentSums  sums = {.d = {0}};

    Place(n, 0.3, 0.1, 0.2, 0, x);
    fails += Add(n, (const double(*)[3])x, n, (const double(*)[3])x, alpha, &sums, area);
    for (int j = 0; j < n; j++) {
      fails += CheckClose("D of a whole facet", sums.d[j], share[i][j / m] * area[1], 1e-14);
      for (int d = 0; d < 3 && n > m && (j < m || n == 9); d++) {
        double place = 0;

        for (int l = 0; l < n; l++) place += sums.cross[j][l] * x[l][d];
        fails += CheckClose("the place that D is at", place, sums.d[j] * x[j][d], 1e-14);
      }
    }
  }
  return fails;
}

/* Under three tiles of any shape that cover a part of it */
static int Tiles(int n, int m, double warp)
{
  const double alpha   = SegmentAlpha(n == 6, n == 8);
  const int    corners = FacetShapeOf(m)->n_corners;
  double       x[FACET_NODES][3], y[3][FACET_NODES][3], area[2] = {0, 0}, sum = 0;
  double       cross[FACET_NODES][3] = {{0}};
  SegmentSums  sums                  = {.d = {0}};
  int          fails                 = 0;

  Place(n, 0.4, 0.03, 0.05, warp, x);
  for (int t = 0; t < 3; t++) {
    Place(m, 0.1 + (corners == 3 ? acos(-1.0) : 0) * (t % 2), t == 2 ? -0.9 : 0.1, t == 1 ? 1.05 : 0.05, 0, y[t]);
    for (int j = 0; j < n * m; j++) sums.cross[j / m][j % m] = 0;
    fails += Add(n, (const double(*)[3])x, m, (const double(*)[3])y[t], alpha, &sums, area);
    for (int j = 0; j < n; j++)
      for (int k = 0; k < 3 * m; k++) cross[j][k % 3] += sums.cross[j][k / 3] * y[t][k / 3][k % 3];
  }
  for (int j = 0; j < n; j++) {
    sum += sums.d[j];
    if (n == FacetShapeOf(n)->n_corners) fails += CheckTrue("D is positive", sums.d[j] > 0, sums.d[j]);
    for (int d = 0; d < 3; d++) {
      double own = 0;

      for (int k = 0; k < n; k++) {
        double v[FACET_NODES];

        SegmentValue(n, alpha, k, v);
        for (int i = 0; i < n; i++) own += sums.mass[j][k] * v[i] * x[i][d];
      }
      fails += CheckClose("places of both facets", cross[j][d], own, 1e-14);
    }
  }
  return fails + CheckClose("area", sum, area[0], warp == 0 ? 1e-14 : 1e-7);
}

int main(void)
{
  int fails = Whole();

  for (int i = 0; i < 25; i++)
    for (int k = 0; k < 2; k++) fails += Tiles(kinds[i / 5], kinds[i % 5], 0.2 * k);
  return fails > 0;
}
