/* Facets for unit tests: of each shape, curved at random about a flat one */
#pragma once

#include "kernels/contact/facet.h"

#define FACET_CASES 5

static const int facet_cases[FACET_CASES] = {3, 4, 6, 8, 9};

/* Deterministic numbers in [-1, 1] */
static inline double FacetRandom(void)
{
  static unsigned long long state = 88172645463325252ULL;

  state ^= state << 13;
  state ^= state >> 7;
  state ^= state << 17;
  return (double)(state >> 11) / 4503599627370496.0 - 1;
}

/* An affine facet, its nodes moved at random: by `plane` in the plane z = 0 and `warp` across it */
static inline void FacetMake(int n, double plane, double warp, double x[][3])
{
  const FacetShape *shape = FacetShapeOf(n);

  for (int i = 0; i < n; i++) {
    const double *s = shape->node[i];

    x[i][0] = 0.3 + 1.1 * s[0] + 0.2 * s[1] + plane * FacetRandom();
    x[i][1] = -0.1 + 0.9 * s[1] + 0.1 * s[0] + plane * FacetRandom();
    x[i][2] = warp * FacetRandom();
  }
}

/* A place within the facet, or up to `reach` times as far from its middle */
static inline void FacetPlace(int n, double reach, double at[2])
{
  const FacetShape *shape = FacetShapeOf(n);

  do {
    for (int d = 0; d < 2; d++) at[d] = shape->n_corners == 4 ? FacetRandom() : 0.5 + 0.5 * FacetRandom();
  } while (FacetBeyond(n, at) > 0);
  for (int d = 0; d < 2; d++) at[d] = shape->middle[d] + reach * (at[d] - shape->middle[d]);
}
