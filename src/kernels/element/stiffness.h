/*
   Stiffness and stress of a linear elastic material, for any shape functions N_a with gradients in x (1/m).

   With the integrals G_ab[j][l] = int dN_a/dx_j dN_b/dx_l dV (m) of two functions, the 3 x 3 block of the stiffness
   (N/m) is

      K_ab[i][k] = sum_jl C_ijkl G_ab[j][l],

   where stress_ij = sum_kl C_ijkl du_k/dx_l. Isotropic, C_ijkl = lambda d_ij d_kl + shear (d_ik d_jl + d_il d_jk), it
   is lambda G + shear (G' + tr(G) I).
*/
#pragma once

#include <string.h>
#include <squeal/elasticity.h>

/* Place of component ij of a symmetric tensor in the order xx, yy, zz, yz, xz, xy */
static const int stiffness_voigt[3][3] = {{0, 5, 4}, {5, 1, 3}, {4, 3, 2}};

/* Blocks a <= b of n functions, isotropic */
static inline void StiffnessIsotropic(int n, const Elasticity *material, const double *G, int ld, double *K)
{
  for (int a = 0; a < 3 * n; a += 3) {
    for (int b = a; b < 3 * n; b += 3) {
      const double *g     = G + a * ld + b;
      double       *k     = K + a * ld + b;
      const double  trace = material->shear * (g[0] + g[ld + 1] + g[2 * ld + 2]);

      for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) k[i * ld + j] = material->lambda * g[i * ld + j] + material->shear * g[j * ld + i];
        k[i * ld + i] += trace;
      }
    }
  }
}

/* One block: K[i][k] = sum_jl C_ijkl G[j][l] */
static inline void StiffnessBlock(const double C[ELASTICITY_VOIGT][ELASTICITY_VOIGT], const double *G, int ld,
                                  double *K)
{
  for (int i = 0; i < 3; i++) {
    for (int k = 0; k < 3; k++) {
      double sum = 0;

      for (int j = 0; j < 3; j++) {
        const double *row = C[stiffness_voigt[i][j]];

        for (int l = 0; l < 3; l++) sum += row[stiffness_voigt[k][l]] * G[j * ld + l];
      }
      K[i * ld + k] = sum;
    }
  }
}

/*
   StiffnessFromGradients - stiffness (N/m) of n functions

   Input Parameters:
+  n        - number of functions
.  material - its density is not read
.  G        - integrals of the products of gradients (m), G[ld (3a + j) + 3b + l]; blocks a <= b are read, whole
-  ld       - leading dimension of G and K, at least 3 n

   Output Parameter:
.  K - K[ld (3a + i) + 3b + k], blocks a <= b are written, whole; must not overlap G
*/
static inline void StiffnessFromGradients(int n, const Elasticity *material, const double *G, int ld, double *K)
{
  if (!material->anisotropic) {
    StiffnessIsotropic(n, material, G, ld, K);
    return;
  }
  for (int a = 0; a < 3 * n; a += 3)
    for (int b = a; b < 3 * n; b += 3) StiffnessBlock(material->C, G + a * ld + b, ld, K + a * ld + b);
}

/* StressFromGradient - stress (Pa), symmetric, of the displacement gradient H[i][k] = du_i/dx_k */
static inline void StressFromGradient(const Elasticity *material, double H[3][3], double stress[3][3])
{
  const double strain[ELASTICITY_VOIGT] = {H[0][0],           H[1][1],           H[2][2],
                                           H[1][2] + H[2][1], H[0][2] + H[2][0], H[0][1] + H[1][0]};

  for (int i = 0; i < 3; i++) {
    for (int k = 0; k < 3; k++) {
      if (!material->anisotropic) {
        stress[i][k] = material->shear * (H[i][k] + H[k][i]);
        continue;
      }
      stress[i][k] = 0;
      for (int s = 0; s < ELASTICITY_VOIGT; s++) stress[i][k] += material->C[stiffness_voigt[i][k]][s] * strain[s];
    }
    if (!material->anisotropic) stress[i][i] += material->lambda * (H[0][0] + H[1][1] + H[2][2]);
  }
}
