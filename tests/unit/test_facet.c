/*
   Unit test of kernels/contact/facet.h and nearest.h for facets of all shapes: shape functions, areas, area vectors and their
   derivative, bounds, and the nearest point, against closed forms and constructions.
*/
#include <stdlib.h>
#include "check.h"
#include "facetcases.h"
#include "kernels/contact/nearest.h"

#define X(x) ((const double(*)[3])(x))

/* Breaks when: a shape function is not 1 at its node and 0 at the others, they do not sum up to 1, or a derivative is
   not theirs. They are quadratic along xi and eta at most, so that central differences are exact */
static int TestShapeFunctions(int n)
{
  const FacetShape *shape     = FacetShapeOf(n);
  double            kronecker = 0, sum = 0, derivative = 0;

  for (int k = 0; k < 100; k++) {
    double at[2], w[FACET_NODES], dw[FACET_NODES][2], one = -1;

    FacetPlace(n, 1.5, at);
    FacetWeights(n, at, w);
    shape->derivatives(at[0], at[1], dw);
    for (int i = 0; i < n; i++) one += w[i];
    sum = fmax(sum, fabs(one));
    for (int d = 0; d < 2; d++) {
      double after[FACET_NODES], before[FACET_NODES];

      FacetWeights(n, (const double[]){at[0] + (d == 0), at[1] + (d == 1)}, after);
      FacetWeights(n, (const double[]){at[0] - (d == 0), at[1] - (d == 1)}, before);
      for (int i = 0; i < n; i++) derivative = fmax(derivative, fabs((after[i] - before[i]) / 2 - dw[i][d]));
    }
  }
  for (int i = 0; i < n; i++) {
    double w[FACET_NODES];

    FacetWeights(n, shape->node[i], w);
    for (int j = 0; j < n; j++) kronecker = fmax(kronecker, fabs(w[j] - (i == j)));
  }
  return CheckClose("1 at their nodes, 0 at others", kronecker, 0, 0) + CheckClose("sum - 1", sum, 0, 1e-14) +
         CheckClose("derivatives against differences", derivative, 0, 1e-13);
}

/* Area vector of a facet by its border alone, 1/2 int x cross dx: exact along sides of second order with Simpson's
   rule, the product being cubic */
static void BorderArea(int n, const double x[][3], double area[3])
{
  const FacetShape *shape = FacetShapeOf(n);
  const int         m     = shape->n_corners;

  for (int d = 0; d < 3; d++) area[d] = 0;
  for (int k = 0; k < 3 * m; k++) {
    const double *from = shape->node[k / 3], *to = shape->node[(k / 3 + 1) % m], s = k % 3 * 0.5;
    double        p[3], a[3], b[3], t[3], cross[3];

    FacetTangents(n, x, (const double[]){from[0] + s * (to[0] - from[0]), from[1] + s * (to[1] - from[1])}, p, a, b);
    for (int d = 0; d < 3; d++) t[d] = (to[0] - from[0]) * a[d] + (to[1] - from[1]) * b[d];
    Vec3Cross(p, t, cross);
    for (int d = 0; d < 3; d++) area[d] += (k % 3 == 1 ? 4 : 1) / 12.0 * cross[d];
  }
}

/* Breaks when: a weight or point of a quadrature is wrong. Exact areas of curved facets from their borders; positive
   shares of flat ones, of second order as the literature has them: 1/19 and 16/57, 3/76 and 16/76, 1/36, 4/36, 16/36 */
static int TestAreas(int n)
{
  static const double known[FACET_NODES + 1][3] = {
    [3] = {1 / 3.0   },
    [4] = {        1 / 4.0 },
    [6] = { 1 / 19.0,        16 / 57.0},
    [8] = {        3 / 76.0, 16 / 76.0},
    [9] = {        1 / 36.0,       4 / 36.0, 16 / 36.0}
  };
  const FacetShape *shape = FacetShapeOf(n);
  const double      flat  = (1.1 * 0.9 - 0.2 * 0.1) * shape->area;
  double x[FACET_NODES][3], share[FACET_NODES], normal[FACET_NODES][3], border[3], area = 0, miss = 0, own = 0, sum;

  FacetMake(n, 0.2, 0.3, x);
  BorderArea(n, X(x), border);
  FacetAreaNormals(n, X(x), normal);
  for (int d = 0; d < 3; d++) {
    for (int i = 0; i < n; i++) border[d] -= normal[i][d];
    area = fmax(area, fabs(border[d]));
  }
  FacetAreas(n, X(x), share);
  for (int i = 0; i < n; i++) border[0] = i ? border[0] + share[i] : share[i];
  FacetPositiveAreas(n, X(x), share);
  sum = -border[0];
  for (int i = 0; i < n; i++) sum += share[i];
  FacetMake(n, 0, 0, x);
  FacetPositiveAreas(n, X(x), share);
  FacetNodeNormals(n, X(x), normal);
  for (int i = 0; i < n; i++) {
    miss = fmax(miss, fabs(share[i] - known[n][i / shape->n_corners] * flat));
    own  = fmax(own, fabs(normal[i][2] - share[i]));
  }
  return CheckClose("area vector of a curved facet", area, 0, 1e-14) +
         CheckClose("positive shares in its area", sum, 0, 1e-14) +
         CheckClose("positive shares of a flat one", miss, 0, 1e-14) + CheckClose("their area vectors", own, 0, 1e-14);
}

/* Breaks when: consistent shares are lumped. Of flat facets: a third, a quarter; 0 and a third; -1/12 and a third; as
   the positive ones of nine nodes. The mass matrix sums up to them */
static int TestConsistent(int n)
{
  static const double known[FACET_NODES + 1][3] = {
    [3] = {1 / 3.0   },
    [4] = { 1 / 4.0  },
    [6] = { 0,         1 / 3.0},
    [8] = {   -1 / 12.0,    1 / 3.0},
    [9] = { 1 / 36.0, 4 / 36.0, 16 / 36.0}
  };
  const FacetShape *shape = FacetShapeOf(n);
  const double      flat  = (1.1 * 0.9 - 0.2 * 0.1) * shape->area;
  double            x[FACET_NODES][3], share[FACET_NODES], mass[FACET_NODES * FACET_NODES], miss = 0, rows = 0;

  FacetMake(n, 0, 0, x);
  FacetAreas(n, X(x), share);
  FacetMass(n, X(x), mass);
  for (int i = 0; i < n; i++) {
    double row = -share[i];

    for (int j = 0; j < n; j++) row += mass[n * i + j];
    miss = fmax(miss, fabs(share[i] - known[n][i / shape->n_corners] * flat));
    rows = fmax(rows, fabs(row));
  }
  return CheckClose("consistent shares of a flat facet", miss, 0, 1e-14) +
         CheckClose("rows of the mass", rows, 0, 1e-14);
}

/* Area vectors of the facet x + step u */
static void Moved(int n, double x[][3], double u[][3], double step, double share[][3])
{
  double y[FACET_NODES][3];

  for (int k = 0; k < 3 * n; k++) y[k / 3][k % 3] = x[k / 3][k % 3] + step * u[k / 3][k % 3];
  FacetNodeNormals(n, X(y), share);
}

/* Breaks when: xi and eta are exchanged, or a sign or a factor of the turning is wrong. A warped facet, any
   displacement of its nodes: the area vectors are quadratic in the places, so that central differences are exact */
static int TestTurning(int n)
{
  double x[FACET_NODES][3], u[FACET_NODES][3], c[FACET_NODES][FACET_NODES][3], before[FACET_NODES][3],
    after[FACET_NODES][3], error = 0, largest = 0;

  FacetMake(n, 0.2, 0.4, x);
  for (int k = 0; k < 3 * n; k++) u[k / 3][k % 3] = sin(1 + 5.0 * k * k);
  Moved(n, x, u, -1, before);
  Moved(n, x, u, 1, after);
  FacetTurning(n, X(x), c);
  for (int k = 0; k < 3 * n; k++) {
    const int    i = k / 3, d = k % 3, e = (d + 1) % 3, f = (d + 2) % 3;
    const double exact   = (after[i][d] - before[i][d]) / 2;
    double       turning = 0;

    for (int j = 0; j < n; j++) turning += u[j][e] * c[i][j][f] - u[j][f] * c[i][j][e];
    error   = fmax(error, fabs(turning - exact));
    largest = fmax(largest, fabs(exact));
  }
  return CheckClose("derivative of the area vectors, relative", error / largest, 0, 1e-14);
}

/* Breaks when: the bounds of a curved facet are those of its nodes, or too wide for a flat one */
static int TestBounds(int n)
{
  double x[FACET_NODES][3], out = 0, wide = 0;

  for (int k = 0; k < 1000; k++) {
    const double bulge  = k % 2 ? 0.3 : 0;
    double       low[3] = {9, 9, 9}, high[3] = {-9, -9, -9}, at[2], p[3], a[3], b[3];

    FacetMake(n, bulge, bulge, x);
    FacetBounds(n, X(x), low, high);
    FacetPlace(n, 1, at);
    FacetTangents(n, X(x), at, p, a, b);
    for (int d = 0; d < 3; d++) out = fmax(out, fmax(low[d] - p[d], p[d] - high[d]));
    for (int i = 0; i < n && bulge == 0; i++)
      for (int d = 0; d < 3; d++) low[d] = fmax(low[d], x[i][d]), high[d] = fmin(high[d], x[i][d]);
    for (int i = 0; i < FacetShapeOf(n)->n_corners && bulge == 0; i++) wide = fmax(wide, high[2] - low[2]);
  }
  return CheckClose("points of the facet out of its bounds", out, 0, 1e-15) +
         CheckClose("a flat one's height", wide, 0, 1e-15);
}

/* Breaks when: the nearest point is not found within a curved facet, by a point above a known one across the facet; or
   beyond an edge of a flat triangle or rectangle, by the closed form: there the edge is nearest */
static int TestProject(int n)
{
  const FacetShape *shape = FacetShapeOf(n);
  double            worst = 0, edge = 0;

  for (int k = 0; k < 1000; k++) {
    const double h = 0.1 * FacetRandom();
    double       x[FACET_NODES][3], at[2], found[2], p[3], a[3], b[3], normal[3];

    FacetMake(n, 0.1, 0.05, x);
    FacetPlace(n, 0.99, at);
    FacetTangents(n, X(x), at, p, a, b);
    FacetNormal(n, X(x), at, normal);
    (void)Vec3Normalise(normal);
    for (int d = 0; d < 3; d++) p[d] += h * normal[d];
    worst = fmax(worst, fabs(FacetProject(n, X(x), p, found) - fabs(h)));
    worst = fmax(worst, fmax(fabs(found[0] - at[0]), fabs(found[1] - at[1])));
  }
  for (int i = 0; i < shape->n_corners; i++) {
    const double *from = shape->node[i], *to = shape->node[(i + 1) % shape->n_corners];
    double        x[FACET_NODES][3], p[3], a[3], b[3], t[3], natural[2];

    FacetMake(n, 0, 0, x);
    FacetTangents(n, X(x), (const double[]){from[0] + 0.3 * (to[0] - from[0]), from[1] + 0.3 * (to[1] - from[1])}, p, a,
                  b);
    for (int d = 0; d < 3; d++) t[d] = x[(i + 1) % shape->n_corners][d] - x[i][d];
    (void)Vec3Normalise(t);
    p[0] += 0.2 * t[1];
    p[1] -= 0.2 * t[0];
    edge = fmax(edge, n == 4 ? 0 : fabs(FacetProject(n, X(x), p, natural) - 0.2));
  }
  return CheckClose("nearest point of a curved facet", worst, 0, 1e-7) +
         CheckClose("beyond its edges, m", edge, 0, 1e-12);
}

int main(void)
{
  int failed = 0;

  for (int k = 0; k < FACET_CASES; k++) {
    const int n = facet_cases[k];

    printf("     %d nodes\n", n);
    failed +=
      TestShapeFunctions(n) + TestAreas(n) + TestConsistent(n) + TestTurning(n) + TestBounds(n) + TestProject(n);
  }
  printf("%d failed\n", failed);
  return failed ? EXIT_FAILURE : EXIT_SUCCESS;
}
