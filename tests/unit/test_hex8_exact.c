/*
   Unit tests of kernels/element/hex8.h against exact solutions of linear elasticity: the patch test, and pure bending by one
   element, which is what the incompatible modes are for. E = 210 GPa, nu = 0.3 unless said.
*/
#include <stdlib.h>
#include "check.h"
#include "hex8cases.h"

/* Solves a x = b for symmetric positive a; b becomes x */
extern void dposv_(const char *, const int *, const int *, double *, const int *, double *, const int *, int *);

/* Assembles the patch: stiffness K[48][48] */
static int PatchStiffness(const Formulation *f, const Elasticity *e, double K[48 * 48])
{
  memset(K, 0, sizeof(double) * 48 * 48);
  for (int cell = 0; cell < 7; cell++) {
    double x[N], Ke[N * N], Me[N * N];

    PatchCell(cell, x);
    if (f->matrices(NULL, x, e, Ke, Me)) return 1;
    for (int i = 0; i < N * N; i++) {
      const int r = i / N, s = i % N;

      K[48 * (3 * patch_cells[cell][r / 3] + r % 3) + 3 * patch_cells[cell][s / 3] + s % 3] += Ke[i];
    }
  }
  return 0;
}

/* Displacements u[48] of the patch: those of the cube's corners are given, those of the inner nodes are computed */
static int PatchSolve(const double K[48 * 48], double u[48])
{
  const int n = N, one = 1;
  double    a[N * N];
  int       info;

  for (int r = 0; r < N; r++) {
    u[N + r] = 0;
    for (int s = 0; s < N; s++) {
      u[N + r] -= K[48 * (N + r) + s] * u[s];
      a[N * r + s] = K[48 * (N + r) + N + s];
    }
  }
  dposv_("U", &n, &one, a, &n, u + N, &n, &info);
  return info != 0;
}

/* Breaks when: the bubbles do work on constant stress (without Taylor's centre Jacobian the error is a few percent).
   u = G x on the cube's corners must give u = G x inside, and corner forces sigma n / 4 summed over three faces. */
static int TestPatch(const Formulation *f, const Elasticity *e)
{
  static const double G[3][3] = {
    {1e-3,  2e-4,  -3e-4},
    {5e-4,  -7e-4, 4e-4 },
    {-2e-4, 6e-4,  9e-4 }
  };
  const double trace = G[0][0] + G[1][1] + G[2][2];
  double       K[48 * 48], u[48], exact[48], error = 0, force_error = 0;
  int          failed = PatchStiffness(f, e, K);

  for (int i = 0; i < 48; i++) {
    exact[i] = 0;
    for (int j = 0; j < 3; j++) exact[i] += G[i % 3][j] * patch_nodes[i / 3][j];
    u[i] = exact[i];
  }
  failed += PatchSolve(K, u);
  for (int i = N; i < 48; i++) error = fmax(error, fabs(u[i] - exact[i]));
  for (int i = 0; i < N; i++) {
    double force = 0, expected = 0;

    for (int s = 0; s < 48; s++) force += K[48 * i + s] * u[s];
    for (int j = 0; j < 3; j++) {
      const double stress = e->shear * (G[i % 3][j] + G[j][i % 3]) + (i % 3 == j ? e->lambda * trace : 0);

      expected += stress * hex8_sign[i / 3][j] / 4;
    }
    force_error = fmax(force_error, fabs(force - expected) / (e->shear * 1e-3));
  }
  failed += CheckClose("patch test, displacements of inner nodes, relative", error / 1e-3, 0, 1e-12);
  return failed + CheckClose("patch test, forces of constant stress, relative", force_error, 0, 1e-12);
}

/*
   Breaks when: bubbles are missing, wrongly scaled or wrongly condensed (incompatible), or present (full).
   Pure bending of a bar of length l and height h: u = (k x z, -nu k y z, -k (x^2 - nu y^2 + nu z^2) / 2), stress E k z
   along x only. At the nodes the quadratic terms are the same constant. Energy E I k^2 l / 2. With nu = 0 the
   trilinear element adds the shear strain k x, energy G k^2 int x^2 dV / 2: ratio 1 + (l/h)^2 / 2.
*/
static int TestBending(const Formulation *f, double poisson, double ratio)
{
  const double     l = 10, b = 2, h = 1, young = 210e9, exact = young * b * h * h * h / 12 * l / 2;
  const Elasticity e = ElasticityFromEngineering(young, poisson, 7800);
  double           x[N], K[N * N], M[N * N], u[N], energy = 0;
  int              failed = f->matrices(NULL, (Box(l, b, h, x), x), &e, K, M);

  for (int a = 0; a < N; a += 3) {
    u[a]     = x[a] * x[a + 2];
    u[a + 1] = -poisson * x[a + 1] * x[a + 2];
    u[a + 2] = 0;
  }
  for (int i = 0; i < N * N; i++) energy += u[i / N] * K[i] * u[i % N] / 2;
  printf("     bending with Poisson's ratio %g\n", poisson);
  return failed + CheckClose("energy of pure bending, bar 10 x 2 x 1, relative", energy / exact, ratio, 1e-12 * ratio);
}

int main(void)
{
  const Elasticity e      = ElasticityFromEngineering(210e9, 0.3, 7800);
  int              failed = 0;

  for (int k = 0; k < 2; k++) {
    const Formulation *f = &formulations[k];

    printf("--- %s\n", f->name);
    failed += TestPatch(f, &e);
    failed += TestBending(f, 0, f->matrices == Hex8FullMatrices ? 51 : 1);
  }
  failed += TestBending(&formulations[0], 0.3, 1);
  printf("%d failed\n", failed);
  return failed ? EXIT_FAILURE : EXIT_SUCCESS;
}
