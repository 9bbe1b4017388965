/*
   Unit test of kernels/facet.h: the derivative of the corner shares of the area vector, which is quadratic in the
   positions, so that its central difference is exact.
*/
#include <stdlib.h>
#include "check.h"
#include "kernels/facet.h"

/* Shares of the facet x + step u */
static void Moved(double x[4][3], double u[4][3], double step, double share[4][3])
{
  double y[4][3];

  for (int k = 0; k < 12; k++) y[k / 3][k % 3] = x[k / 3][k % 3] + step * u[k / 3][k % 3];
  FacetAreaNormals((const double(*)[3])y, share);
}

/* Breaks when: xi and eta are exchanged, or a sign or a factor of the turning is wrong. A warped facet, any
   displacement of its corners. */
static int TestTurning(void)
{
  static double x[4][3] = {
    {0,    0,   0.1 },
    {1.1,  0.2, -0.2},
    {0.9,  1.3, 0.4 },
    {-0.2, 0.8, 0.1 }
  };
  double u[4][3], c[4][4][3], before[4][3], after[4][3], error = 0, largest = 0;

  for (int k = 0; k < 12; k++) u[k / 3][k % 3] = sin(1 + 5.0 * k * k);
  Moved(x, u, -1, before);
  Moved(x, u, 1, after);
  FacetTurning((const double(*)[3])x, c);
  for (int k = 0; k < 12; k++) {
    const int    i = k / 3, d = k % 3, e = (d + 1) % 3, f = (d + 2) % 3;
    const double exact   = (after[i][d] - before[i][d]) / 2;
    double       turning = 0;

    for (int j = 0; j < 4; j++) turning += u[j][e] * c[i][j][f] - u[j][f] * c[i][j][e];
    error   = fmax(error, fabs(turning - exact));
    largest = fmax(largest, fabs(exact));
  }
  return CheckClose("derivative of the corner shares, relative", error / largest, 0, 1e-14);
}

int main(void)
{
  const int failed = TestTurning();

  printf("%d failed\n", failed);
  return failed ? EXIT_FAILURE : EXIT_SUCCESS;
}
