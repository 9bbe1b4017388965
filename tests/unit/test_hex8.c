/*
   Unit tests of kernels/element/hex8.h, both formulations: what every element must satisfy, whatever its shape.
   E = 210 GPa, nu = 0.3, 7800 kg/m^3.
*/
#include <stdlib.h>
#include "check.h"
#include "hex8cases.h"
#include "kernels/contact/facet.h"

/* Eigenvalues w, ascending, of the symmetric a (destroyed) */
extern void dsyev_(const char *, const char *, const int *, double *, const int *, double *, double *, const int *,
                   int *);

/* Proper rotation by 0.7 about z, then 1.1 about x */
static void Rotation(double r[3][3])
{
  const double c = cos(0.7), s = sin(0.7), d = cos(1.1), t = sin(1.1);
  const double q[3][3] = {
    {c,     -s,    0 },
    {d * s, d * c, -t},
    {t * s, t * c, d }
  };

  memcpy(r, q, sizeof(q));
}

/* Largest entry of a[n] */
static double MaxAbs(int n, const double a[])
{
  double largest = 0;

  for (int i = 0; i < n; i++) largest = fmax(largest, fabs(a[i]));
  return largest;
}

/* Eigenvalues of the 24 x 24 matrix a, ascending */
static void Eigenvalues(const double a[N * N], double w[N])
{
  const int n = N, n_work = 100 * N;
  double    copy[N * N], work[100 * N];
  int       info;

  memcpy(copy, a, sizeof(copy));
  dsyev_("N", "U", &n, copy, &n, w, work, &n_work, &info);
  if (info) w[0] = NAN;
}

/* Breaks when: the blocks, the condensation or a gradient are wrong, or a mode is missing (hourglass) or spurious */
static int TestRigidModes(const Formulation *f, const Elasticity *e)
{
  double x[N], K[N * N], M[N * N], w[N], asymmetry = 0;
  int    failed = 0;

  PatchCell(0, x);
  failed += CheckTrue("matrices of the irregular element exist", f->matrices(NULL, x, e, K, M) == 0, 0);
  for (int i = 0; i < N * N; i++) asymmetry = fmax(asymmetry, fabs(K[i] - K[i % N * N + i / N]));
  Eigenvalues(K, w);
  failed += CheckClose("stiffness is symmetric", asymmetry, 0, 0);
  failed += CheckClose("six zero eigenvalues of the stiffness, relative", MaxAbs(6, w) / w[N - 1], 0, 1e-14);
  failed += CheckTrue("the seventh is positive, relative", w[6] > 1e-3 * w[N - 1], w[6] / w[N - 1]);
  Eigenvalues(M, w);
  failed += CheckTrue("mass is positive definite, smallest relative", w[0] > 1e-3 * w[N - 1], w[0] / w[N - 1]);
  return failed;
}

/* Volume (m^3) and first moments (m^4) of a hexahedron by the divergence theorem on its faces, 3 x 3 Gauss points:
   V = int x . n dA / 3, int x_i dV = int x_i^2 n_i dA / 2 */
static void VolumeByFaces(const double x[N], double *volume, double moment[3])
{
  static const int faces[6][4] = {
    {0, 3, 2, 1},
    {4, 5, 6, 7},
    {0, 1, 5, 4},
    {1, 2, 6, 5},
    {2, 3, 7, 6},
    {3, 0, 4, 7}
  };
  static const double p[3] = {-0.774596669241483377, 0, 0.774596669241483377}, w[3] = {5. / 9, 8. / 9, 5. / 9};

  *volume = moment[0] = moment[1] = moment[2] = 0;
  for (int face = 0; face < 6; face++) {
    double corner[4][3];

    for (int i = 0; i < 12; i++) corner[i / 3][i % 3] = x[3 * faces[face][i / 3] + i % 3];
    for (int q = 0; q < 9; q++) {
      double point[3], a[3], b[3], n[3];

      FacetTangents(4, (const double(*)[3])corner, (const double[]){p[q % 3], p[q / 3]}, point, a, b);
      Vec3Cross(a, b, n);
      for (int i = 0; i < 3; i++) {
        *volume += w[q % 3] * w[q / 3] * point[i] * n[i] / 3;
        moment[i] += w[q % 3] * w[q / 3] * point[i] * point[i] * n[i] / 2;
      }
    }
  }
}

/* Breaks when: the density, a weight or the node order is wrong, mass couples directions, or quadrature is too low for
   the total and the centre of mass of an irregular element */
static int TestMass(const Formulation *f, const Elasticity *e)
{
  double x[N], K[N * N], M[N * N], volume, measured, min_jacobian, moment[3], coupling = 0;
  int    failed = f->matrices(NULL, (PatchCell(6, x), x), e, K, M);

  VolumeByFaces(x, &volume, moment);
  Hex8Measure(NULL, x, &measured, &min_jacobian);
  failed += CheckClose("volume of an irregular element against its faces, relative", measured / volume, 1, 1e-14);
  for (int i = 0; i < 3; i++) {
    double total = 0, first = 0;

    for (int a = i; a < N; a += 3) {
      for (int b = 0; b < N; b++) {
        total += b % 3 == i ? M[N * a + b] : 0;
        first += b % 3 == i ? M[N * a + b] * x[b] : 0;
        coupling = fmax(coupling, b % 3 == i ? 0 : fabs(M[N * a + b]));
      }
    }
    failed += CheckClose("total mass in a direction, relative", total / (e->density * volume), 1, 1e-14);
    failed += CheckClose("first moment of mass, relative", first / (e->density * moment[i]), 1, 1e-13);
  }
  return failed + CheckClose("mass between directions", coupling, 0, 0);
}

/* Breaks when: the mass is lumped, or is not 1/27, 1/54, 1/108, 1/216 of a box between nodes 0, 1, 2, 3 edges apart */
static int TestMassOfBox(const Formulation *f, const Elasticity *e)
{
  double x[N], K[N * N], M[N * N], error = 0;
  int    failed = f->matrices(NULL, (Box(2, 3, 5, x), x), e, K, M);

  for (int a = 0; a < 8; a++) {
    for (int b = 0; b < 8; b++) {
      int edges = 0;

      for (int k = 0; k < 3; k++) edges += hex8_sign[a][k] != hex8_sign[b][k];
      error = fmax(error, fabs(M[N * 3 * a + 3 * b] / (30 * e->density) * 27 * (1 << edges) - 1));
    }
  }
  return failed + CheckClose("consistent mass of a box, relative error", error, 0, 1e-14);
}

/* Breaks when: a coordinate direction is treated differently. K(R x) = R K(x) R', M likewise */
static int TestRotation(const Formulation *f, const Elasticity *e)
{
  double r[3][3], x[N], y[N], K[N * N], M[N * N], Kr[N * N], Mr[N * N], error_k = 0, error_m = 0;
  int    failed = f->matrices(NULL, (PatchCell(4, x), x), e, K, M);

  Rotation(r);
  for (int i = 0; i < N; i++) {
    const double *p = x + i - i % 3, *row = r[i % 3];

    y[i] = 5 + row[0] * p[0] + row[1] * p[1] + row[2] * p[2];
  }
  failed += f->matrices(NULL, y, e, Kr, Mr);
  for (int i = 0; i < N * N; i++) {
    const int row = i / N, col = i % N;
    double    k = 0, m = 0;

    for (int p = 0; p < 9; p++) {
      const int    from = N * (row - row % 3 + p / 3) + col - col % 3 + p % 3;
      const double rr   = r[row % 3][p / 3] * r[col % 3][p % 3];

      k += rr * K[from];
      m += rr * M[from];
    }
    error_k = fmax(error_k, fabs(Kr[i] - k));
    error_m = fmax(error_m, fabs(Mr[i] - m));
  }
  failed += CheckClose("stiffness of a rotated and shifted element, relative", error_k / MaxAbs(N * N, K), 0, 1e-12);
  return failed + CheckClose("mass of a rotated and shifted element, relative", error_m / MaxAbs(N * N, M), 0, 1e-12);
}

/* Breaks when: the result depends on which node is the first. Numbering turned by a quarter about zeta */
static int TestRenumbering(const Formulation *f, const Elasticity *e)
{
  static const int turned[8] = {1, 2, 3, 0, 5, 6, 7, 4};
  double           x[N], y[N], K[N * N], M[N * N], Kt[N * N], Mt[N * N], error = 0;
  int              failed = f->matrices(NULL, (PatchCell(3, x), x), e, K, M);

  for (int i = 0; i < N; i++) y[i] = x[3 * turned[i / 3] + i % 3];
  failed += f->matrices(NULL, y, e, Kt, Mt);
  for (int i = 0; i < N * N; i++) {
    const int row = 3 * turned[i / N / 3] + i / N % 3, col = 3 * turned[i % N / 3] + i % N % 3;

    error = fmax(error, fabs(Kt[i] - K[N * row + col]));
  }
  return failed + CheckClose("stiffness with nodes renumbered, relative", error / MaxAbs(N * N, K), 0, 1e-12);
}

/* Breaks when: a mirrored, folded or flat element is accepted, or its matrices are half written */
static int TestInverted(const Formulation *f, const Elasticity *e)
{
  double x[N], K[N * N], M[N * N], volume, quality;
  int    failed = 0;

  for (int i = 0; i < N * N; i++) K[i] = M[i] = -1;
  Box(1, 1, 1, x);
  for (int i = 2; i < N; i += 3) x[i] = -x[i];
  failed += CheckTrue("a mirrored element is refused", f->matrices(NULL, x, e, K, M) == 1, 1);
  for (int i = 2; i < N; i += 3) x[i] = 0;
  failed += CheckTrue("a flat element is refused", f->matrices(NULL, x, e, K, M) == 1, 1);
  Hex8Measure(NULL, x, &volume, &quality);
  failed += CheckTrue("a flat element has no positive measure", quality <= 0, quality);
  Box(1, 1, 1, x);
  x[18] = x[19] = x[20] = -2;
  failed += CheckTrue("an element with a node pulled through is refused", f->matrices(NULL, x, e, K, M) == 1, 1);
  for (int i = 0; i < N * N; i++) failed += K[i] != -1 || M[i] != -1;
  return failed + CheckTrue("nothing was written by the refused", failed == 0, failed);
}

/* Breaks when: the measure misses corners, or is not scaled by the box. Pulling one node to c times its distance from
   the centre gives the Jacobian (3 c - 1) / 2 of the box's there: concave for c < 1/3, which no Gauss point sees */
static int TestMeasure(const Elasticity *e)
{
  double x[N], K[N * N], M[N * N], volume, quality;
  int    failed = 0;

  Box(2e-3, 3e-3, 5e-3, x);
  Hex8Measure(NULL, x, &volume, &quality);
  failed += CheckClose("volume of a box, m^3", volume, 30e-9, 1e-22);
  failed += CheckClose("smallest Jacobian of a box relative to the box", quality, 1, 1e-14);
  for (int i = 18; i < 21; i++) x[i] *= 0.3;
  Hex8Measure(NULL, x, &volume, &quality);
  failed += CheckTrue("Gauss points do not see a concave corner", Hex8FullMatrices(NULL, x, e, K, M) == 0, 0);
  return failed + CheckClose("a concave corner gives a negative Jacobian", quality, -0.05, 1e-14);
}

int main(void)
{
  const Elasticity e      = ElasticityFromEngineering(210e9, 0.3, 7800);
  int              failed = TestMeasure(&e);

  for (int k = 0; k < 2; k++) {
    const Formulation *f = &formulations[k];

    printf("--- %s\n", f->name);
    failed += TestRigidModes(f, &e) + TestMass(f, &e) + TestMassOfBox(f, &e);
    failed += TestRotation(f, &e) + TestRenumbering(f, &e) + TestInverted(f, &e);
  }
  printf("%d failed\n", failed);
  return failed ? EXIT_FAILURE : EXIT_SUCCESS;
}
