/*
   Unit tests of kernels/element/stiffness.h: stiffness and stress of a material given by its matrix C.
   References: the isotropic formulas with Lame's parameters; work and forces of uniform strain.
*/
#include "kernels/element/geometric.h"
#include "check.h"
#include "hex8cases.h"

/* C with all 21 constants different, Pa: diagonally dominant, so positive */
static Elasticity General(void)
{
  Elasticity e = {.density = 1, .anisotropic = true};

  for (int r = 0; r < 6; r++)
    for (int s = 0; s < 6; s++) e.C[r][s] = 1e9 * (r == s ? 10 + 2 * r : 0.1 * (1 + r + s + r * s));
  return e;
}

/* C of Lame's parameters */
static Elasticity Written(const Elasticity *isotropic)
{
  Elasticity e = *isotropic;

  e.anisotropic = true;
  for (int r = 0; r < 6; r++)
    for (int s = 0; s < 6; s++) e.C[r][s] = (r < 3 && s < 3 ? e.lambda : 0) + (r == s ? (r < 3 ? 2 : 1) * e.shear : 0);
  return e;
}

/* Stress of the gradient G, from C written out: engineering shear strains, order xx, yy, zz, yz, xz, xy */
static void Stress(const Elasticity *e, const double *G, double stress[6])
{
  const double strain[6] = {G[0], G[4], G[8], G[5] + G[7], G[2] + G[6], G[1] + G[3]};

  for (int r = 0; r < 6; r++) {
    stress[r] = 0;
    for (int s = 0; s < 6; s++) stress[r] += e->C[r][s] * strain[s];
  }
}

/* Breaks when: an index of C is in the wrong place. Isotropic constants written out as C give the isotropic matrices */
static int TestIsotropic(int f)
{
  const Elasticity lame = ElasticityFromEngineering(210e9, 0.3, 7800), written = Written(&lame);
  double           x[N], u[N], a[3][N * N], b[3][N * N], error = 0, scale[3] = {0, 0, 0};
  int              failed = 0;

  PatchCell(3, x);
  for (int i = 0; i < N; i++) u[i] = 1e-3 * sin(1 + 7.0 * i * i);
  failed += formulations[f].matrices(NULL, x, &lame, a[0], a[1]);
  failed += formulations[f].matrices(NULL, x, &written, b[0], b[1]);
  failed += (f ? Hex8FullGeometric : Hex8IncompatibleGeometric)(NULL, x, &lame, u, a[2]);
  failed += (f ? Hex8FullGeometric : Hex8IncompatibleGeometric)(NULL, x, &written, u, b[2]);
  for (int k = 0; k < 3; k++) {
    for (int i = 0; i < N * N; i++) scale[k] = fmax(scale[k], fabs(a[k][i]));
    for (int i = 0; i < N * N; i++) error = fmax(error, fabs(a[k][i] - b[k][i]) / scale[k]);
  }
  return failed + CheckClose("isotropic constants as C: all matrices, relative", error, 0, 1e-13);
}

/* Breaks when: C is not used whole, or transposed into the wrong block. u = G x on an irregular patch that fills the
   unit cube: energy strain' C strain, and the inner nodes are in equilibrium */
static int TestPatch(int f, const Elasticity *e)
{
  static const double G[3][3] = {
    {1e-3,  2e-4,  -3e-4},
    {5e-4,  -7e-4, 4e-4 },
    {-2e-4, 6e-4,  9e-4 }
  };
  const double strain[6] = {G[0][0], G[1][1], G[2][2], G[1][2] + G[2][1], G[0][2] + G[2][0], G[0][1] + G[1][0]};
  double       stress[6], exact = 0, energy = 0, force[16][3] = {{0}}, inner = 0, largest = 0;
  int          failed = 0;

  for (int cell = 0; cell < 7; cell++) {
    double x[N], u[N], K[N * N], M[N * N];

    PatchCell(cell, x);
    for (int i = 0; i < N; i++) u[i] = Vec3Dot(G[i % 3], x + i - i % 3);
    failed += formulations[f].matrices(NULL, x, e, K, M);
    for (int i = 0; i < N * N; i++) {
      energy += u[i / N] * K[i] * u[i % N];
      force[patch_cells[cell][i / N / 3]][i / N % 3] += K[i] * u[i % N];
    }
  }
  Stress(e, &G[0][0], stress);
  for (int r = 0; r < 6; r++) exact += stress[r] * strain[r];
  for (int i = 0; i < 48; i++) {
    largest = fmax(largest, fabs(force[i / 3][i % 3]));
    if (i >= 24) inner = fmax(inner, fabs(force[i / 3][i % 3]));
  }
  failed += CheckClose("energy of uniform strain, relative", energy / exact, 1, 1e-12);
  return failed + CheckClose("forces at inner nodes, relative", inner / largest, 0, 1e-12);
}

/* Breaks when: StressFromGradient() forgets that C takes twice the shear strain, or swaps components */
static int TestStress(const Elasticity *e)
{
  static const int ij[6][2] = {
    {0, 0},
    {1, 1},
    {2, 2},
    {1, 2},
    {0, 2},
    {0, 1}
  };
  double H[3][3] = {
    {1e-3,  2e-4,  -3e-4},
    {5e-4,  -7e-4, 4e-4 },
    {-2e-4, 6e-4,  9e-4 }
  };
  double expected[6], stress[3][3], error = 0, scale = 0;

  Stress(e, &H[0][0], expected);
  StressFromGradient(e, H, stress);
  for (int r = 0; r < 6; r++) {
    const int i = ij[r][0], j = ij[r][1];

    error = fmax(error, fmax(fabs(stress[i][j] - expected[r]), fabs(stress[j][i] - expected[r])));
    scale = fmax(scale, fabs(expected[r]));
  }
  return CheckClose("stress of a gradient, relative", error / scale, 0, 1e-14);
}

int main(void)
{
  const Elasticity general = General();
  int              failed  = 0;

  for (int f = 0; f < 2; f++) {
    printf("%s\n", formulations[f].name);
    failed += TestIsotropic(f) + TestPatch(f, &general);
  }
  failed += TestStress(&general);
  return failed != 0;
}
