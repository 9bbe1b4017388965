/*
   Coulomb friction at a pair: the disc of admissible friction and the natural map. Pure functions.

   |z| <= mu p_n is the disc; the natural map p_T - Proj(z), z = p_T less a multiple of the slip, vanishes where
   friction obeys the law.
*/
#pragma once

#include <math.h>

/* Factor that takes a vector of this squared length to the disc */
static inline double FrictionShorten(double square, double radius)
{
  return square <= radius * radius ? 1 : radius / sqrt(square);
}

/* |p - Proj(z)| */
static inline double FrictionMiss(const double p[2], const double z[2], double radius)
{
  const double factor  = FrictionShorten(z[0] * z[0] + z[1] * z[1], radius);
  const double miss[2] = {p[0] - factor * z[0], p[1] - factor * z[1]};

  return sqrt(miss[0] * miss[0] + miss[1] * miss[1]);
}
