/*
   Geometric stiffness of the eight-node hexahedron: what a stress sigma (Pa) adds to the stiffness when the body turns,

      k_ab = int grad N_a . sigma . grad N_b dV   times the 3 x 3 identity   (N/m, symmetric; tension stiffens).

   sigma = C sym(H) is that of the static displacements u (m), H = sum_a u_a grad N_a over shape functions and bubbles
   (kernels/element/stiffness.h). The amplitudes of the bubbles are those of equilibrium, alpha = -K_aa^-1 K_au u. The
   bubbles carry stress but turn no fibre: their own geometric stiffness is left out, as is their mass
   (kernels/element/hex8.h).

   A rigid rotation, u_b = w x x_b, gives k u = w x f with f the nodal forces of sigma: exact for any shape, since the
   gradients of trilinear functions reproduce linear fields.

   Reference: Bathe, Finite Element Procedures, 1996, section 6.2.3, of which this is the initial stress part.
*/
#pragma once

#include "hex8.h"

/* All displacements x[3 (n_bubbles + 8)], bubbles first and then u: rows p of an upper triangle that Hex8Condense() has
   eliminated say sum_{s >= p} K_ps x_s = 0 */
static inline void Hex8Recover(int n_bubbles, double K[HEX8_ALL][HEX8_ALL], const double *u, double x[HEX8_ALL])
{
  const int first = 3 * n_bubbles;

  memcpy(x + first, u, sizeof(double) * HEX8_DOFS);
  for (int p = first - 1; p >= 0; p--) {
    x[p] = 0;
    for (int s = p + 1; s < first + HEX8_DOFS; s++) x[p] -= K[p][s] * x[s] / K[p][p];
  }
}

/* Stress (Pa) of displacements v[n][3] with gradients g[n][3] / j */
static inline void Hex8Stress(int n, const Elasticity *material, const double *v, const double *g, double j,
                              double stress[3][3])
{
  double H[3][3] = {{0}};

  for (int a = 0; a < 3 * n; a += 3) {
    for (int i = 0; i < 3; i++) {
      for (int k = 0; k < 3; k++) H[i][k] += v[a + i] * g[a + k] / j;
    }
  }
  StressFromGradient(material, H, stress);
}

/* Adds g_a . sigma . g_b / j to k[8][8] */
static inline void Hex8AddGeometric(const double *g, double j, double stress[3][3], double k[HEX8_NODES][HEX8_NODES])
{
  for (int a = 0; a < HEX8_NODES; a++) {
    double traction[3] = {0, 0, 0};

    for (int i = 0; i < 3; i++) {
      for (int l = 0; l < 3; l++) traction[l] += g[3 * a + i] * stress[i][l] / j;
    }
    for (int b = 0; b < HEX8_NODES; b++) {
      for (int l = 0; l < 3; l++) k[a][b] += traction[l] * g[3 * b + l];
    }
  }
}

/* Geometric stiffness [24][24] of an element with n_bubbles; returns 1 and writes nothing when the Jacobian is not
   positive */
static inline int Hex8Geometric(const double *x, const Elasticity *material, int n_bubbles, const double *u,
                                double *stiffness)
{
  const int     n = n_bubbles + HEX8_NODES;
  Hex8Integrals sum;
  double        K[HEX8_ALL][HEX8_ALL], v[HEX8_ALL], g[HEX8_ALL], k[HEX8_NODES][HEX8_NODES] = {{0}};
  double        xi[3] = {0, 0, 0}, N[HEX8_NODES], dN[HEX8_DOFS], c0[9], c[9];

  if (Hex8Integrate(x, n_bubbles, &sum)) return 1;
  Hex8Stiffness(n, material, sum.gradients, K);
  Hex8Condense(3 * n_bubbles, 3 * n, K);
  Hex8Recover(n_bubbles, K, u, v);
  Hex8Shape(xi, N, dN);
  (void)SolidJacobian(HEX8_NODES, x, dN, c0);
  for (int q = 0; q < 8; q++) {
    double j, stress[3][3];

    Hex8Point(q, HEX8_GAUSS, xi);
    Hex8Shape(xi, N, dN);
    j = SolidJacobian(HEX8_NODES, x, dN, c);
    Hex8Gradients(n_bubbles, xi, dN, c0, c, g);
    Hex8Stress(n, material, v, g, j, stress);
    Hex8AddGeometric(g + 3 * n_bubbles, j, stress, k);
  }
  memset(stiffness, 0, sizeof(double) * HEX8_DOFS * HEX8_DOFS);
  for (int r = 0; r < HEX8_DOFS; r++) {
    for (int b = 0; b < HEX8_NODES; b++) stiffness[HEX8_DOFS * r + 3 * b + r % 3] = k[r / 3][b];
  }
  return 0;
}

/*
   Hex8IncompatibleGeometric - geometric stiffness (N/m) of the element with incompatible modes, QM6

   Input Parameters:
+  solid    - not used
.  x        - positions of the nodes, [8][3], m
.  material - stiffness, Pa
-  u        - displacements of the nodes, [8][3], m

   Output Parameter:
.  stiffness - [24][24]

   Returns 0, or 1 when the Jacobian is not positive at the centre or a Gauss point; then nothing is written.
*/
static inline int Hex8IncompatibleGeometric(const Solid *solid, const double *x, const Elasticity *material,
                                            const double *u, double *stiffness)
{
  (void)solid;
  return Hex8Geometric(x, material, HEX8_BUBBLES, u, stiffness);
}

/* Hex8FullGeometric - the same for the fully integrated trilinear element */
static inline int Hex8FullGeometric(const Solid *solid, const double *x, const Elasticity *material, const double *u,
                                    double *stiffness)
{
  (void)solid;
  return Hex8Geometric(x, material, 0, u, stiffness);
}
