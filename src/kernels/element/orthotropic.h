/*
   Stiffness of an orthotropic material from its engineering constants, and in axes that are turned.

   In the axes of the material the inverse of the stiffness is, in the order 11, 22, 33, 23, 13, 12,

      [  1/E_1     -nu_12/E_1  -nu_13/E_1                          ]
      [ -nu_12/E_1  1/E_2      -nu_23/E_2                          ]
      [ -nu_13/E_1 -nu_23/E_2   1/E_3                              ]
      [                                     1/G_23  1/G_13  1/G_12 ]  (diagonal).

   With nu_ji = nu_ij E_j / E_i it is positive definite where E_i > 0, G_ij > 0, |nu_ij| < sqrt(E_i / E_j) and

      D = 1 - nu_12 nu_21 - nu_13 nu_31 - nu_23 nu_32 - 2 nu_21 nu_32 nu_13 > 0.

   Reference: R. M. Jones, Mechanics of Composite Materials, 1999, sections 2.3 to 2.6.
*/
#pragma once

#include "stiffness.h"

/* The two axes of the constants that stand for pairs: 12, 13, 23 */
static const int orthotropic_pair[3][2] = {{0, 1}, {0, 2}, {1, 2}};

/* D */
static inline double OrthotropicDeterminant(const EngineeringConstants *e)
{
  const double n12 = e->poisson[0], n13 = e->poisson[1], n23 = e->poisson[2];
  const double n21 = n12 * e->young[1] / e->young[0], n31 = n13 * e->young[2] / e->young[0];
  const double n32 = n23 * e->young[2] / e->young[1];

  return 1 - n12 * n21 - n13 * n31 - n23 * n32 - 2 * n21 * n32 * n13;
}

/* OrthotropicStiffness - C (Pa) in the axes of the material, whose constants must be positive definite */
static inline void OrthotropicStiffness(const EngineeringConstants *e, double C[ELASTICITY_VOIGT][ELASTICITY_VOIGT])
{
  const double E1 = e->young[0], E2 = e->young[1], E3 = e->young[2];
  const double n12 = e->poisson[0], n13 = e->poisson[1], n23 = e->poisson[2];
  const double n21 = n12 * E2 / E1, n31 = n13 * E3 / E1, n32 = n23 * E3 / E2, D = OrthotropicDeterminant(e);

  memset(C, 0, sizeof(double) * ELASTICITY_VOIGT * ELASTICITY_VOIGT);
  C[0][0] = E1 * (1 - n23 * n32) / D;
  C[1][1] = E2 * (1 - n13 * n31) / D;
  C[2][2] = E3 * (1 - n12 * n21) / D;
  C[0][1] = C[1][0] = E1 * (n21 + n31 * n23) / D;
  C[0][2] = C[2][0] = E1 * (n31 + n21 * n32) / D;
  C[1][2] = C[2][1] = E2 * (n32 + n12 * n31) / D;
  C[3][3]           = e->shear[2];
  C[4][4]           = e->shear[1];
  C[5][5]           = e->shear[0];
}

/*
   OrthotropicTurn - C in global axes, times a factor

   Input Parameters:
+  axis   - rows are the axes 1, 2, 3 of the material, orthogonal unit vectors
.  C      - in these axes, Pa
-  factor - -

   Output Parameter:
.  turned - T C T' with the matrix T of the stresses, sigma_global = T sigma: column pq of T is, at ij,
            axis[p][i] axis[q][j], and for p != q also axis[q][i] axis[p][j]
*/
static inline void OrthotropicTurn(const double axis[3][3], const double C[ELASTICITY_VOIGT][ELASTICITY_VOIGT],
                                   double factor, double turned[ELASTICITY_VOIGT][ELASTICITY_VOIGT])
{
  double T[ELASTICITY_VOIGT][ELASTICITY_VOIGT], TC[ELASTICITY_VOIGT][ELASTICITY_VOIGT];

  for (int i = 0; i < 3; i++) {
    for (int j = i; j < 3; j++) {
      for (int p = 0; p < 3; p++) {
        for (int q = p; q < 3; q++)
          T[stiffness_voigt[i][j]][stiffness_voigt[p][q]] =
            axis[p][i] * axis[q][j] + (p == q ? 0 : axis[q][i] * axis[p][j]);
      }
    }
  }
  for (int r = 0; r < ELASTICITY_VOIGT; r++) {
    for (int s = 0; s < ELASTICITY_VOIGT; s++) {
      TC[r][s] = 0;
      for (int t = 0; t < ELASTICITY_VOIGT; t++) TC[r][s] += factor * T[r][t] * C[t][s];
    }
  }
  for (int r = 0; r < ELASTICITY_VOIGT; r++) {
    for (int s = 0; s < ELASTICITY_VOIGT; s++) {
      turned[r][s] = 0;
      for (int t = 0; t < ELASTICITY_VOIGT; t++) turned[r][s] += TC[r][t] * T[s][t];
    }
  }
}
