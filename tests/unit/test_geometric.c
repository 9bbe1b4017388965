/*
   Unit tests of kernels/element/geometric.h: uniform stress, rigid motions, and Euler's buckling load of a slender bar.
   E = 210 GPa, nu = 0.3 unless said.
*/
#include <stdlib.h>
#include "kernels/element/geometric.h"
#include "check.h"
#include "hex8cases.h"

typedef int (*GeometricFunction)(const Solid *, const double *, const Elasticity *, const double *, double *);

static const GeometricFunction geometric[] = {Hex8IncompatibleGeometric, Hex8FullGeometric};

/* Solves a x = l b x for symmetric a and positive b; w becomes l in ascending order */
extern void dsygv_(const int *, const char *, const char *, const int *, double *, const int *, double *, const int *,
                   double *, double *, const int *, int *);

/* Solves a x = b for symmetric positive a; b becomes x */
extern void dposv_(const char *, const int *, const int *, double *, const int *, double *, const int *, int *);

/* u = G x at n positions */
static void Linear(const double G[3][3], int n, const double x[], double u[])
{
  for (int i = 0; i < 3 * n; i++)
    u[i] = G[i % 3][0] * x[i - i % 3] + G[i % 3][1] * x[i - i % 3 + 1] + G[i % 3][2] * x[i - i % 3 + 2];
}

/* w' k u */
static double Work(const double w[N], const double k[N * N], const double u[N])
{
  double sum = 0;

  for (int i = 0; i < N * N; i++) sum += w[i / N] * k[i] * u[i % N];
  return sum;
}

/* Breaks when: bubbles take part in uniform stress, a gradient is not divided by the Jacobian, or stress is not
   symmetric. u = G x on a patch of irregular elements filling the unit cube, moved by F x: energy tr(F sigma F'). */
static int TestUniform(int f, const Elasticity *e)
{
  static const double G[3][3] = {
    {1e-3,  2e-4,  -3e-4},
    {5e-4,  -7e-4, 4e-4 },
    {-2e-4, 6e-4,  9e-4 }
  };
  static const double F[3][3] = {
    {0.3,  -1.2, 0.7},
    {0.8,  0.5,  2.0},
    {-0.4, 1.1,  0.2}
  };
  double exact = 0, energy = 0;
  int    failed = 0;

  for (int cell = 0; cell < 7; cell++) {
    double x[N], u[N], w[N], k[N * N];

    PatchCell(cell, x);
    Linear(G, 8, x, u);
    Linear(F, 8, x, w);
    failed += geometric[f](NULL, x, e, u, k);
    energy += Work(w, k, w);
  }
  for (int i = 0; i < 27; i++) {
    const int    a = i / 9, b = i / 3 % 3, c = i % 3;
    const double stress = e->shear * (G[b][c] + G[c][b]) + (b == c ? e->lambda * (G[0][0] + G[1][1] + G[2][2]) : 0);

    exact += F[a][b] * stress * F[a][c];
  }
  return failed + CheckClose("uniform stress in an irregular patch, energy of F x, relative", energy / exact, 1, 1e-12);
}

/* Breaks when: the bubbles are not recovered, or with the wrong sign. Any u gives stress whose nodal forces K u turn
   with the element, k (w x x) = w x K u; a translation meets no resistance; k is symmetric. */
static int TestRigid(int f, const Elasticity *e)
{
  const double w[3] = {0.3, -0.7, 0.5};
  double       x[N], u[N], turn[N], K[N * N], M[N * N], k[N * N], error = 0, shift = 0, asymmetry = 0, scale = 0;
  int          failed;

  PatchCell(2, x);
  for (int i = 0; i < N; i++) u[i] = 1e-3 * sin(1 + 7.0 * i * i);
  for (int i = 0; i < N; i += 3) Vec3Cross(w, x + i, turn + i);
  failed = formulations[f].matrices(NULL, x, e, K, M) + geometric[f](NULL, x, e, u, k);
  for (int i = 0; i < N; i += 3) {
    double force[3] = {0, 0, 0}, expected[3], moved[3] = {0, 0, 0}, sum[3] = {0, 0, 0};

    for (int s = 0; s < 3 * N; s++) {
      force[s / N] += K[N * (i + s / N) + s % N] * u[s % N];
      moved[s / N] += k[N * (i + s / N) + s % N] * turn[s % N];
      sum[s / N] += k[N * (i + s / N) + s % N];
    }
    Vec3Cross(w, force, expected);
    for (int d = 0; d < 3; d++) {
      scale = fmax(scale, fabs(expected[d]));
      error = fmax(error, fabs(moved[d] - expected[d]));
      shift = fmax(shift, fabs(sum[d]));
    }
  }
  for (int i = 0; i < N * N; i++) asymmetry = fmax(asymmetry, fabs(k[i] - k[N * (i % N) + i / N]));
  failed += CheckClose("rotation turns the nodal forces, relative", error / scale, 0, 1e-12);
  failed += CheckClose("translation meets no resistance, relative", shift / scale, 0, 1e-12);
  return failed + CheckClose("asymmetry, relative", asymmetry / scale, 0, 1e-13);
}

/*
   Half of a simply supported bar along x that bends in z, nu = 0: CELLS elements, two nodes over the height and two
   over the width; x = 0 is the plane of symmetry, z is held at the other end, y everywhere. Unknowns u_x, u_z of each
   node.
*/
#define CELLS 16
#define NODES (4 * (CELLS + 1))
#define HALF  (2 * NODES)

typedef struct {
  double K[HALF * HALF], M[HALF * HALF], S[HALF * HALF]; /* stiffness, mass, geometric stiffness of a unit load */
  double length, u[HALF];                                /* half the length; displacements under the unit load */
} Bar;

/* Node a of a cell; unknown of direction i, or -1 */
static int BarUnknown(int cell, int a, int i)
{
  const int section = cell + (hex8_sign[a][0] > 0),
            node    = 4 * section + (hex8_sign[a][1] > 0) + 2 * (hex8_sign[a][2] > 0);

  if (i == 1 || (i == 0 && section == 0) || (i == 2 && section == CELLS)) return -1;
  return 2 * node + i / 2;
}

/* Adds an element's matrix to that of the bar */
static void BarAdd(int cell, const double k[N * N], double A[HALF * HALF])
{
  for (int i = 0; i < N * N; i++) {
    const int r = BarUnknown(cell, i / N / 3, i / N % 3), s = BarUnknown(cell, i % N / 3, i % N % 3);

    if (r >= 0 && s >= 0) A[HALF * r + s] += k[i];
  }
}

/* Matrices of the bar; a held unknown gets a spring and a mass of its own */
static int BarCreate(int f, const Elasticity *e, Bar *bar)
{
  const int one = 1, n = HALF;
  double    x[N], k[N * N], m[N * N], a[HALF * HALF], u[N];
  int       failed, info;

  memset(bar, 0, sizeof(*bar));
  bar->length = 25;
  Box(bar->length / CELLS, 1, 1, x);
  failed = formulations[f].matrices(NULL, x, e, k, m);
  for (int cell = 0; cell < CELLS; cell++) {
    BarAdd(cell, k, bar->K);
    BarAdd(cell, m, bar->M);
  }
  for (int i = 0; i < HALF; i++)
    if (bar->K[HALF * i + i] == 0) bar->K[HALF * i + i] = e->shear, bar->M[HALF * i + i] = m[0];
  for (int node = NODES - 4; node < NODES; node++) bar->u[2 * node] = -0.25;
  memcpy(a, bar->K, sizeof(a));
  dposv_("U", &n, &one, a, &n, bar->u, &n, &info);
  for (int cell = 0; cell < CELLS; cell++) {
    for (int i = 0; i < N; i++) {
      const int r = BarUnknown(cell, i / 3, i % 3);

      u[i] = r < 0 ? 0 : bar->u[r];
    }
    failed += geometric[f](NULL, x, e, u, k);
    BarAdd(cell, k, bar->S);
  }
  return failed + info;
}

/* Smallest l of A x = l B x */
static double Smallest(const double A[HALF * HALF], const double B[HALF * HALF])
{
  const int     type = 1, n = HALF, n_work = 64 * HALF;
  static double a[HALF * HALF], b[HALF * HALF], w[HALF], work[64 * HALF];
  int           info;

  memcpy(a, A, sizeof(a));
  memcpy(b, B, sizeof(b));
  dsygv_(&type, "N", "U", &n, a, &n, b, &n, w, work, &n_work, &info);
  return info ? NAN : w[0];
}

/* Breaks when: compression stiffens, or the stress is scaled wrongly. A simply supported bar, 50 times as long as high:
   buckles at P = P_E / (1 + P_E / (5/6 G A)), P_E = pi^2 E I / L^2 (Engesser; Timoshenko, Gere, Theory of Elastic
   Stability, 1961, section 2.17), and omega^2 falls as 1 - p / P. This mesh leaves 0.14 %, one twice as fine
   0.02 %. */
static int TestBuckling(int f, const Elasticity *e)
{
  static const double p[] = {-1, 0.5, 1};
  static Bar          bar;
  static double       K[HALF * HALF];
  int                 failed = BarCreate(f, e, &bar);
  const double        young = 2 * e->shear, length = 2 * bar.length;
  const double        euler = acos(-1) * acos(-1) * young / 12 / (length * length);
  const double        load = euler / (1 + euler / (5.0 / 6 * e->shear)), free = Smallest(bar.K, bar.M);

  failed += CheckClose("buckling load beside Euler's with shear", -1 / Smallest(bar.S, bar.K) / load, 1, 2e-3);
  for (int i = 0; i < 3; i++) {
    for (int r = 0; r < HALF * HALF; r++) K[r] = bar.K[r] + p[i] * load * bar.S[r];
    printf("     load %g of the buckling load\n", p[i]);
    failed += CheckClose("omega^2 relative to that without load", Smallest(K, bar.M) / free, 1 - p[i], 2e-3);
  }
  return failed;
}

int main(void)
{
  const Elasticity e        = ElasticityFromEngineering(210e9, 0.3, 7800);
  const Elasticity straight = ElasticityFromEngineering(210e9, 0, 7800);
  int              failed   = 0;

  for (int f = 0; f < 2; f++) {
    printf("--- %s\n", formulations[f].name);
    failed += TestUniform(f, &e);
    failed += TestRigid(f, &e);
  }
  failed += TestBuckling(0, &straight);
  printf("%d failed\n", failed);
  return failed ? EXIT_FAILURE : EXIT_SUCCESS;
}
