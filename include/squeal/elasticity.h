/*
   Isotropic linear elasticity: stress = lambda tr(strain) I + 2 mu_lame strain,
   lambda = E nu / ((1 + nu)(1 - 2 nu)), mu_lame = E / (2 (1 + nu)).
   With strain = sym(grad u) the stiffness of two shape functions with gradients g, h (1/m) is the 3 x 3 block
   lambda g h' + mu_lame (h g' + (g . h) I), to be multiplied by the volume (m^3).
*/
#pragma once

typedef struct {
  double lambda, shear; /* Lame's parameters, Pa */
  double density;       /* kg/m^3 */
} Elasticity;

static inline Elasticity ElasticityFromEngineering(double young, double poisson, double density)
{
  const Elasticity e = {young * poisson / ((1 + poisson) * (1 - 2 * poisson)), young / (2 * (1 + poisson)), density};
  return e;
}
