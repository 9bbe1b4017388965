/* Comparisons for unit tests: each prints value, expected value and tolerance, and returns 1 when it fails */
#pragma once

#include <math.h>
#include <stdio.h>

/* |value - expected| <= tolerance; not a number fails */
static inline int CheckClose(const char name[], double value, double expected, double tolerance)
{
  const int failed = !(fabs(value - expected) <= tolerance);

  printf("%s %-62s %.15g, expected %.15g +- %.1e\n", failed ? "FAIL" : "ok  ", name, value, expected, tolerance);
  return failed;
}

/* condition holds; value says by how much */
static inline int CheckTrue(const char name[], int condition, double value)
{
  printf("%s %-62s %.6g\n", condition ? "ok  " : "FAIL", name, value);
  return !condition;
}
