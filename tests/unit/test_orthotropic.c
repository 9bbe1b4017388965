/*
   Unit tests of kernels/element/orthotropic.h: the strains that engineering constants say, in any axes, and blocks of elements
   under them. Constants in GPa are those of a lining, all nine different.
*/
#include "kernels/element/orthotropic.h"
#include "check.h"
#include "hex8cases.h"

static const EngineeringConstants lining = {
  {8e9,  7e9,   3e9   },
  {0.25, 0.31,  0.17  },
  {3e9,  1.5e9, 1.25e9}
};

/* Orthogonal axes by rows, none along x, y or z: Rodrigues' turn by 0.7 rad about (1, 2, 2) / 3 */
static void Axes(double axis[3][3])
{
  const double e[3] = {1.0 / 3, 2.0 / 3, 2.0 / 3}, c = cos(0.7), s = sin(0.7);

  for (int k = 0; k < 3; k++) {
    double unit[3] = {k == 0, k == 1, k == 2}, cross[3];

    Vec3Cross(e, unit, cross);
    for (int d = 0; d < 3; d++) axis[k][d] = c * unit[d] + s * cross[d] + (1 - c) * e[k] * e[d];
  }
}

/* Strain in global axes of a stress in global axes, by the definition of the constants in the axes of the material */
static void Strain(const EngineeringConstants *e, double axis[3][3], const double stress[3][3], double strain[3][3])
{
  double local[3][3] = {{0}}, eps[3][3];

  for (int i = 0; i < 81; i++)
    local[i / 27][i / 9 % 3] += axis[i / 27][i / 3 % 3] * stress[i / 3 % 3][i % 3] * axis[i / 9 % 3][i % 3];
  eps[1][1] = (local[1][1] - e->poisson[2] * local[2][2]) / e->young[1] - e->poisson[0] * local[0][0] / e->young[0];
  eps[2][2] =
    local[2][2] / e->young[2] - e->poisson[1] * local[0][0] / e->young[0] - e->poisson[2] * local[1][1] / e->young[1];
  eps[0][0] =
    local[0][0] / e->young[0] - e->poisson[0] * local[1][1] / e->young[0] - e->poisson[1] * local[2][2] / e->young[0];
  eps[0][1] = eps[1][0] = local[0][1] / (2 * e->shear[0]);
  eps[0][2] = eps[2][0] = local[0][2] / (2 * e->shear[1]);
  eps[1][2] = eps[2][1] = local[1][2] / (2 * e->shear[2]);
  for (int i = 0; i < 9; i++) strain[i / 3][i % 3] = 0;
  for (int i = 0; i < 81; i++)
    strain[i / 27][i / 9 % 3] += axis[i / 3 % 3][i / 27] * eps[i / 3 % 3][i % 3] * axis[i % 3][i / 9 % 3];
}

/* Material in turned axes */
static Elasticity Turned(double axis[3][3], double factor)
{
  Elasticity e = {.density = 1, .anisotropic = true};
  double     C[6][6];

  OrthotropicStiffness(&lining, C);
  OrthotropicTurn((const double(*)[3])axis, (const double(*)[6])C, factor, e.C);
  return e;
}

/* Breaks when: a constant is in the wrong place, nu_ij stands for nu_ji, or the axes turn the wrong way. Uniform stress
   of all six kinds: the stiffness gives it back from the strain */
static int TestStress(const Elasticity *e, double axis[3][3])
{
  double error = 0;

  for (int r = 0; r < 6; r++) {
    const int i = r < 3 ? r : (r - 2) % 3, j = r < 3 ? r : (r - 1) % 3;
    double    stress[3][3] = {{0}}, strain[3][3], back[3][3];

    stress[i][j] = stress[j][i] = 1e6;
    Strain(&lining, axis, (const double(*)[3])stress, strain);
    StressFromGradient(e, strain, back);
    for (int k = 0; k < 9; k++) error = fmax(error, fabs(back[k / 3][k % 3] - stress[k / 3][k % 3]) / 1e6);
  }
  return CheckClose("stress from the strain of the engineering constants, relative", error, 0, 1e-12);
}

/* Breaks when: an element does not pass the patch test in skew axes. Uniform stress in an irregular patch that fills the
   unit cube: the forces at the corners of each side sum to stress times area, none is left inside */
static int TestBlock(int f, const Elasticity *e, double axis[3][3], int i, int j)
{
  double stress[3][3] = {{0}}, strain[3][3], force[16][3] = {{0}}, error = 0;
  int    failed = 0;

  stress[i][j] = stress[j][i] = 1e6;
  Strain(&lining, axis, (const double(*)[3])stress, strain);
  for (int cell = 0; cell < 7; cell++) {
    double x[N], u[N], K[N * N], M[N * N];

    PatchCell(cell, x);
    for (int k = 0; k < N; k++) u[k] = Vec3Dot(strain[k % 3], x + k - k % 3);
    failed += formulations[f].matrices(NULL, x, e, K, M);
    for (int k = 0; k < N * N; k++) force[patch_cells[cell][k / N / 3]][k / N % 3] += K[k] * u[k % N];
  }
  for (int node = 8; node < 16; node++)
    for (int d = 0; d < 3; d++) error = fmax(error, fabs(force[node][d]) / 1e6);
  for (int d = 0; d < 3; d++) {
    double sum[3] = {0, 0, 0}; /* work on the displacements x_d e_k: stress_kd times the volume */

    for (int node = 0; node < 8; node++)
      for (int k = 0; k < 3; k++) sum[k] += patch_nodes[node][d] * force[node][k];
    for (int k = 0; k < 3; k++) error = fmax(error, fabs(sum[k] - stress[k][d]) / 1e6);
  }
  return failed + CheckClose("uniform stress on a block in skew axes, forces, relative", error, 0, 1e-10);
}

/* Breaks when: the factor of a sweep reaches some constants only */
static int TestFactor(const Elasticity *e, const Elasticity *doubled)
{
  double error = 0;

  for (int r = 0; r < 36; r++) error = fmax(error, fabs(doubled->C[r / 6][r % 6] / e->C[r / 6][r % 6] - 2));
  return CheckClose("twice the stiffness", error, 0, 1e-14);
}

/* Breaks when: D or an inequality is wrong. C becomes singular with D: diagonal entries grow as 1 / D near D = 0 */
static int TestDeterminant(void)
{
  EngineeringConstants e = {
    {1, 1, 1},
    {0, 0, 0},
    {1, 1, 1}
  };
  int failed = CheckClose("D without contraction", OrthotropicDeterminant(&e), 1, 0);

  for (int k = 0; k < 3; k++) e.poisson[k] = 0.5;
  failed += CheckClose("D of an incompressible isotropic material", OrthotropicDeterminant(&e), 0, 1e-15);
  for (int k = 0; k < 3; k++) e.poisson[k] = 0.3;
  return failed + CheckClose("D = (1 + nu)^2 (1 - 2 nu)", OrthotropicDeterminant(&e), 1.3 * 1.3 * 0.4, 1e-15);
}

int main(void)
{
  double     axis[3][3];
  Elasticity e, doubled;
  int        failed = 0;

  Axes(axis);
  e       = Turned(axis, 1);
  doubled = Turned(axis, 2);
  failed += TestStress(&e, axis) + TestFactor(&e, &doubled) + TestDeterminant();
  for (int f = 0; f < 2; f++) {
    printf("%s\n", formulations[f].name);
    for (int k = 0; k < 6; k++) failed += TestBlock(f, &e, axis, k < 3 ? k : (k - 2) % 3, k < 3 ? k : (k - 1) % 3);
  }
  return failed != 0;
}
