/*
   Unit test of kernels/contact/drop.h on warped facets: a point above a known place, along the normal of the undeformed facet,
   is dropped back on that place. The reference is the construction.
*/
#include <stdlib.h>
#include "check.h"
#include "facetcases.h"
#include "kernels/contact/drop.h"

#define X(x) ((const double(*)[3])(x))

/* Nodes of a facet, deformed by a little more */
static void Deform(int n, double undeformed[][3], double deformed[][3])
{
  for (int k = 0; k < 3 * n; k++) deformed[k / 3][k % 3] = undeformed[k / 3][k % 3] + 0.01 * FacetRandom();
}

/* Largest error of the natural coordinates, for places up to `reach` times as far as the facet; interpolated: along the
   normal between the nodes, else that of the facet */
static double Worst(int n, int interpolated, double warp, double reach, double height)
{
  const FacetShape *shape = FacetShapeOf(n);
  const double      plane = n == shape->n_corners ? 0.15 : 0.05;
  double            worst = 0;

  for (int k = 0; k < 10000; k++) {
    const double h = height * FacetRandom();
    double       x[FACET_NODES][3], y[FACET_NODES][3], area[FACET_NODES][3], at[2], p[3], a[3], b[3], normal[3],
      w[FACET_NODES], found[2];

    FacetMake(n, plane, warp, x);
    Deform(n, x, y);
    FacetPlace(n, reach, at);
    for (int i = 0; i < n; i++) FacetNormal(n, X(x), shape->node[i], area[i]);
    FacetNormal(n, X(x), at, normal);
    FacetWeights(n, at, w);
    if (interpolated) FacetSum(n, w, X(area), normal);
    FacetTangents(n, X(y), at, p, a, b);
    for (int d = 0; d < 3; d++) {
      p[d] += h * normal[d];
      if (d < 2) found[d] = shape->middle[d];
    }
    if (!FacetDrop(n, X(x), interpolated ? X(area) : NULL, X(y), p, found)) return 1;
    worst = fmax(worst, fmax(fabs(found[0] - at[0]), fabs(found[1] - at[1])));
  }
  return worst;
}

/* Breaks when: the tangents of the deformed facet are taken for those of the undeformed one, the steps do not converge,
   or end before they have; a flat facet is dropped on from any height, a warped one from near it */
int main(void)
{
  int failed = 0;

  for (int k = 0; k < FACET_CASES; k++) {
    const int n = facet_cases[k], second = n > 4;

    printf("     %d nodes\n", n);
    failed += CheckClose("flat facets, from any height", Worst(n, 0, 0, 1, 10), 0, 1e-9);
    failed += CheckClose("warped facets, from one tenth of their size", Worst(n, second, 0.1, 1, 0.1), 0, 1e-7);
    failed += CheckClose("the same along the mean normal", Worst(n, 1, 0.1, 1, 0.1), 0, 1e-8);
    failed += CheckClose("beyond their edges", Worst(n, second, 0.05, 1.2, 0.02), 0, 1e-7);
  }
  printf("%d failed\n", failed);
  return failed ? EXIT_FAILURE : EXIT_SUCCESS;
}
