/*
   Unit test of kernels/drop.h on warped facets: a point above a known place, along the normal of the undeformed facet,
   is dropped back on that place. The reference is the construction.
*/
#include <stdlib.h>
#include "check.h"
#include "kernels/drop.h"

/* Deterministic numbers in [-1, 1] */
static double Random(void)
{
  static unsigned long long state = 88172645463325252ULL;

  state ^= state << 13;
  state ^= state >> 7;
  state ^= state << 17;
  return (double)(state >> 11) / 4503599627370496.0 - 1;
}

/* A unit square with corners moved at random, by `plane` in its plane and `warp` across it; deformed by a little more
   */
static void Facets(double plane, double warp, double undeformed[4][3], double deformed[4][3])
{
  static const double square[4][2] = {
    {0, 0},
    {1, 0},
    {1, 1},
    {0, 1}
  };

  for (int i = 0; i < 4; i++)
    for (int d = 0; d < 3; d++) {
      undeformed[i][d] = d < 2 ? square[i][d] + plane * Random() : warp * Random();
      deformed[i][d]   = undeformed[i][d] + 0.01 * Random();
    }
}

/* Largest error of the natural coordinates, for places up to `reach` in them */
static double Worst(double warp, double reach, double height)
{
  double worst = 0;

  for (int k = 0; k < 10000; k++) {
    const double at[2] = {reach * Random(), reach * Random()}, h = height * Random();
    double       x[4][3], y[4][3], p[3], a[3], b[3], n[3], found[2] = {0, 0};

    Facets(0.15, warp, x, y);
    FacetNormal((const double(*)[3])x, at[0], at[1], n);
    FacetTangents((const double(*)[3])y, at[0], at[1], p, a, b);
    for (int d = 0; d < 3; d++) p[d] += h * n[d];
    if (!FacetDrop((const double(*)[3])x, NULL, (const double(*)[3])y, p, found)) return 1;
    worst = fmax(worst, fmax(fabs(found[0] - at[0]), fabs(found[1] - at[1])));
  }
  return worst;
}

/* Breaks when: the tangents of the deformed facet are taken for those of the undeformed one, the steps do not converge,
   or end before they have; a flat facet is dropped on from any height, a warped one from near it */
int main(void)
{
  int failed = CheckClose("flat facets, from any height", Worst(0, 1, 10), 0, 1e-9);

  failed += CheckClose("warped facets, from one tenth of their size", Worst(0.1, 1, 0.1), 0, 1e-7);
  failed += CheckClose("beyond their edges", Worst(0.05, 1.3, 0.02), 0, 1e-7);
  printf("%d failed\n", failed);
  return failed ? EXIT_FAILURE : EXIT_SUCCESS;
}
