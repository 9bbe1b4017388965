/* Areas in which facets lie over each other against closed forms: squares that are moved, turned and tilted, triangles, and a facet
   of any shape under tiles of others. Breaks when a corner is lost, or the way round of a triangle counts */
#include "check.h"
#include "kernels/contact/overlap.h"

/* A facet of n nodes on the square [0, 1]^2 or its lower left half, turned by an angle about its middle, then moved */
static void Place(int n, double size, double angle, double dx, double dy, double dz, double x[][3])
{
  const FacetShape *shape = FacetShapeOf(n);
  const double      c = cos(angle), s = sin(angle);

  for (int i = 0; i < n; i++) {
    const double half = shape->n_corners == 4 ? 0.5 : 1, base = shape->n_corners == 4 ? 0 : -0.5;
    const double a = size * (half * shape->node[i][0] + base), b = size * (half * shape->node[i][1] + base);

    x[i][0] = c * a - s * b + dx;
    x[i][1] = s * a + c * b + dy;
    x[i][2] = dz;
  }
}

static double Overlap(int n, const double x[][3], int m, const double y[][3])
{
  double   e[3][3], origin[3];
  FacetFan f, g;

  FanAxes(n, x, e, origin);
  FanMake(n, x, (const double(*)[3])e, origin, &f);
  FanMake(m, y, (const double(*)[3])e, origin, &g);
  return FanOverlap(&f, &g);
}

/* Two squares, each of 4, 8 or 9 nodes */
static int Squares(void)
{
  const int kinds[] = {4, 8, 9};
  double    x[FACET_NODES][3], y[FACET_NODES][3];
  int       fails = 0;

  for (int i = 0; i < 9; i++) {
    const int n = kinds[i / 3], m = kinds[i % 3];

    Place(n, 1, 0, 0, 0, 0, x);
    Place(m, 1, 0, 0.3, -0.2, 0.1, y);
    fails += CheckClose("moved squares", Overlap(n, (const double(*)[3])x, m, (const double(*)[3])y), 0.7 * 0.8, 1e-14);
    Place(m, 1, acos(-1.0) / 4, 0, 0, -0.1, y);
    fails += CheckClose("squares turned by 45 degrees", Overlap(n, (const double(*)[3])x, m, (const double(*)[3])y),
                        2 * (sqrt(2.0) - 1), 1e-14);
    Place(m, 1, 0, 1.1, 0, 0, y);
    fails += CheckClose("squares apart", Overlap(n, (const double(*)[3])x, m, (const double(*)[3])y), 0, 0);
    Place(m, 1, 0, 0, 0, 0, y);
    for (int k = 0; k < m; k++) y[k][2] = y[k][0]; /* seen along z it is the same square */
    fails += CheckClose("a tilted square", Overlap(n, (const double(*)[3])x, m, (const double(*)[3])y), 1, 1e-14);
  }
  return fails;
}

/* A facet of any shape under four tiles that cover it, of either orientation */
static int Tiles(void)
{
  const int kinds[] = {3, 4, 6, 8, 9};
  int       fails   = 0;

  for (int i = 0; i < 5; i++) {
    double x[FACET_NODES][3], y[FACET_NODES][3], area = 0;

    Place(kinds[i], 1, 0.3, 0.02, 0.05, 0, x);
    for (int t = 0; t < 4; t++) {
      Place(4, 2, 0, t % 2 ? 1.07 : -0.93, t / 2 ? 0.96 : -1.04, 0.2, y);
      for (int d = 0; d < 3 && t % 2; d++) { /* the other way round */
        const double keep = y[1][d];

        y[1][d] = y[3][d];
        y[3][d] = keep;
      }
      area += Overlap(kinds[i], (const double(*)[3])x, 4, (const double(*)[3])y);
    }
    fails += CheckClose("tiles", area, kinds[i] == 3 || kinds[i] == 6 ? 0.5 : 1, 1e-14);
  }
  return fails;
}

int main(void)
{
  return Squares() + Tiles() > 0;
}
