/* Vectors in space: a . b, a x b, |a|; order of places */
#pragma once

#include <math.h>

static inline double Vec3Dot(const double a[3], const double b[3])
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* c = a x b; c is neither of them */
static inline void Vec3Cross(const double a[3], const double b[3], double c[3])
{
  c[0] = a[1] * b[2] - a[2] * b[1];
  c[1] = a[2] * b[0] - a[0] * b[2];
  c[2] = a[0] * b[1] - a[1] * b[0];
}

static inline double Vec3Length(const double a[3])
{
  return sqrt(Vec3Dot(a, a));
}

/* Scales to length one and returns the length before; nothing stays nothing */
static inline double Vec3Normalise(double a[3])
{
  const double length = Vec3Length(a);

  for (int d = 0; d < 3 && length > 0; d++) a[d] /= length;
  return length;
}

/* By z, then y, then x: the order of pairs in tables, which does not depend on the ranks */
static inline int Vec3ComparePlaces(const double a[3], const double b[3])
{
  for (int d = 2; d >= 0; d--)
    if (a[d] != b[d]) return a[d] < b[d] ? -1 : 1;
  return 0;
}
