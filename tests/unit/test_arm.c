/*
   Unit test of kernels/contact/arm.h for facets of all shapes, curved: the point that a rigid arm holds, against rigid motions and
   against the turning of facets that are moved a little.
*/
#include "check.h"
#include "facetcases.h"
#include "kernels/contact/arm.h"

#define X(x) ((const double(*)[3])(x))

/* A facet, a place on it and an arm, m */
typedef struct {
  int    n;
  double x[FACET_NODES][3], at[2], g[3];
} ArmCase;

static void ArmMake(int n, ArmCase *c)
{
  c->n = n;
  FacetMake(n, 0.05, 0.2, c->x);
  FacetPlace(n, 1, c->at);
  for (int d = 0; d < 3; d++) c->g[d] = 0.3 * FacetRandom();
}

/* What the matrices make of displacements u of the nodes */
static void ArmApply(const ArmCase *c, double u[][3], double moved[3])
{
  double A[FACET_NODES][9];

  FacetArm(c->n, X(c->x), c->at, c->g, A);
  for (int d = 0; d < 3; d++) {
    moved[d] = 0;
    for (int i = 0; i < c->n; i++)
      for (int e = 0; e < 3; e++) moved[d] += A[i][3 * d + e] * u[i][e];
  }
}

/* Breaks when: omega of a rigid motion is not its turning, as with gradients of flat facets alone or an arm of the wrong
   side */
static int TestRigid(int n)
{
  double worst = 0;

  for (int k = 0; k < 100; k++) {
    ArmCase c;
    double  t[3], w[3], u[FACET_NODES][3], place[3], weight[FACET_NODES], turned[3], moved[3];

    ArmMake(n, &c);
    for (int d = 0; d < 3; d++) t[d] = FacetRandom(), w[d] = FacetRandom();
    for (int i = 0; i < n; i++) {
      Vec3Cross(w, c.x[i], u[i]);
      for (int d = 0; d < 3; d++) u[i][d] += t[d];
    }
    FacetWeights(n, c.at, weight);
    FacetSum(n, weight, X(c.x), place);
    for (int d = 0; d < 3; d++) place[d] += c.g[d];
    Vec3Cross(w, place, turned);
    ArmApply(&c, u, moved);
    for (int d = 0; d < 3; d++) worst = fmax(worst, fabs(moved[d] - t[d] - turned[d]));
  }
  return CheckClose("rigid motions", worst, 0, 1e-13);
}

/* Tangents of the facet moved by s u; weights are quadratic along xi and eta at most, so that these differences are exact */
static void TangentsMoved(const ArmCase *c, double s, double u[][3], double a[2][3])
{
  double y[FACET_NODES][3];

  for (int i = 0; i < c->n; i++)
    for (int d = 0; d < 3; d++) y[i][d] = c->x[i][d] + s * u[i][d];
  for (int k = 0; k < 2; k++) {
    double w[FACET_NODES], after[3], before[3];

    FacetWeights(c->n, (const double[]){c->at[0] + (k == 0), c->at[1] + (k == 1)}, w);
    FacetSum(c->n, w, X(y), after);
    FacetWeights(c->n, (const double[]){c->at[0] - (k == 0), c->at[1] - (k == 1)}, w);
    FacetSum(c->n, w, X(y), before);
    for (int d = 0; d < 3; d++) a[k][d] = (after[d] - before[d]) / 2;
  }
}

/* Turning of the facet per s: n x dn of its normal, and about n the mean turning of two lines that stand upright on each
   other at rest, t_1 and t_2 */
static void FacetTurned(const ArmCase *c, double u[][3], double omega[3])
{
  const double step = 1e-5;
  double       rest[2][3], side[2][2][3], n[3], normal[2][3], dn[3], t[2][3], dt[2][3], spin, length, along;

  TangentsMoved(c, 0, u, rest);
  for (int s = 0; s < 2; s++) {
    TangentsMoved(c, s ? step : -step, u, side[s]);
    Vec3Cross(side[s][0], side[s][1], normal[s]);
    Vec3Normalise(normal[s]);
  }
  length = Vec3Length(rest[0]);
  along  = Vec3Dot(rest[0], rest[1]) / (length * length);
  for (int d = 0; d < 3; d++) t[1][d] = rest[1][d] - along * rest[0][d];
  for (int d = 0; d < 3; d++) {
    t[0][d]  = rest[0][d] / length;
    dn[d]    = (normal[1][d] - normal[0][d]) / (2 * step);
    dt[0][d] = (side[1][0][d] - side[0][0][d]) / (2 * step) / length;
    dt[1][d] = ((side[1][1][d] - side[0][1][d]) - along * (side[1][0][d] - side[0][0][d])) / (2 * step);
  }
  length = Vec3Normalise(t[1]);
  for (int d = 0; d < 3; d++) dt[1][d] /= length;
  Vec3Cross(t[0], t[1], n);
  spin = (Vec3Dot(t[1], dt[0]) - Vec3Dot(t[0], dt[1])) / 2;
  Vec3Cross(n, dn, omega);
  for (int d = 0; d < 3; d++) omega[d] += spin * n[d];
}

/* Breaks when: the tilt or the turning about the normal has a wrong factor, sign or transpose, which rigid motions alone
   might not show */
static int TestDifferences(int n)
{
  double worst = 0;

  for (int k = 0; k < 100; k++) {
    ArmCase c;
    double  u[FACET_NODES][3], w[FACET_NODES], omega[3], arm[3], mean[3], moved[3];

    ArmMake(n, &c);
    for (int i = 0; i < n; i++)
      for (int d = 0; d < 3; d++) u[i][d] = FacetRandom();
    FacetTurned(&c, u, omega);
    FacetWeights(n, c.at, w);
    FacetSum(n, w, X(u), mean);
    Vec3Cross(omega, c.g, arm);
    ArmApply(&c, u, moved);
    for (int d = 0; d < 3; d++) worst = fmax(worst, fabs(moved[d] - mean[d] - arm[d]));
  }
  return CheckClose("finite differences of any motion", worst, 0, 1e-6);
}

int main(void)
{
  int failed = 0;

  for (int i = 0; i < FACET_CASES; i++) {
    printf("%d nodes\n", facet_cases[i]);
    failed += TestRigid(facet_cases[i]) + TestDifferences(facet_cases[i]);
  }
  return failed ? 1 : 0;
}
