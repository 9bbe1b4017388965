/*
   Linear elasticity: stress = C strain, strain = sym(grad u).

   Isotropic: stress = lambda tr(strain) I + 2 shear strain,
   lambda = E nu / ((1 + nu)(1 - 2 nu)), shear = E / (2 (1 + nu)).

   Anisotropic: the components in the order xx, yy, zz, yz, xz, xy of the global axes (Voigt), shear strains twice those
   of the tensor (gamma_yz = du_y/dz + du_z/dy): stress[r] = sum_s C[r][s] strain[s], C symmetric.

   The matrices of it are in kernels/element/stiffness.h.
*/
#pragma once

#include <stdbool.h>

#define ELASTICITY_VOIGT 6

typedef struct {
  double lambda, shear;                         /* Lame's parameters, Pa; not read where anisotropic */
  double density;                               /* kg/m^3 */
  bool   anisotropic;                           /* the stiffness is C */
  double C[ELASTICITY_VOIGT][ELASTICITY_VOIGT]; /* Pa, symmetric, all entries; not read where isotropic */
} Elasticity;

static inline Elasticity ElasticityFromEngineering(double young, double poisson, double density)
{
  Elasticity e;

  e.lambda      = young * poisson / ((1 + poisson) * (1 - 2 * poisson));
  e.shear       = young / (2 * (1 + poisson));
  e.density     = density;
  e.anisotropic = false;
  return e;
}

/* Engineering constants of an orthotropic material in its axes 1, 2, 3. Stress along i alone gives the strains
   eps_i = sigma_i / E_i and eps_j = -nu_ij eps_i, hence nu_ij / E_i = nu_ji / E_j. */
typedef struct {
  double young[3];   /* E_1, E_2, E_3, Pa */
  double poisson[3]; /* nu_12, nu_13, nu_23 */
  double shear[3];   /* G_12, G_13, G_23, Pa */
} EngineeringConstants;
