/*
   The reduced model about steady sliding as steps of length dt see it, in closed form. In a step mean forces act on
   modes that answer exactly, residual and laws know means and differences. For what changes by e^(s dt) from step to
   step, (difference / dt) / mean = z = (2 / dt) tanh(s dt / 2), and a mode, x = omega dt / 2, answers by

      (omega^2 + c (x / sin x)^2 z + (x / tan x)^2 z^2) eta = P'lambda     (in c to first order, else exact)

   so that the model with these masses and dampers has the eigenvalues z, from which s follows. To leading order modes
   answer too weakly by (omega dt)^2 / 6, omega that of the motion, where the compliance W does not.
*/
#include "reduced/reducedimpl.h"
#include <complex.h>

#define WARP_LEAST 1e-6 /* of cos x, which vanishes at a mode of two steps a period */

/* The factors of coordinate k: root = |tan x| / x, 1 / root of its mass (x / tan x)^2, and damper = 1 / |cos x|. At
   x = pi / 2, two steps a period, the mass vanishes; WARP_LEAST keeps the numbers finite. ReducedSetStep() admits x
   up to pi. */
static void WarpFactors(const ReducedModel *model, PetscReal dt, PetscInt k, PetscReal *root, PetscReal *damper)
{
  const PetscReal x = 0.5 * dt * PetscSqrtReal(model->omega2[k]);

  *damper = 1 / PetscMax(PetscAbsReal(cos(x)), WARP_LEAST);
  *root   = x > 0 ? *damper * PetscAbsReal(sin(x)) / x : 1;
}

/* Row and column k of A [m][m] times a factor */
static void WarpSquare(PetscInt m, PetscInt k, PetscReal factor, PetscReal A[])
{
  for (PetscInt l = 0; l < m; l++) {
    A[k + m * l] *= factor;
    A[l + m * k] *= factor;
  }
}

/* The model in coordinates of mass 1 */
static void WarpModel(PetscReal dt, const ReducedModel *model, ReducedModel *warped)
{
  const PetscInt m = model->m;

  for (PetscInt k = 0; k < m; k++) {
    PetscReal root, damper;

    WarpFactors(model, dt, k, &root, &damper);
    warped->omega2[k] *= PetscSqr(root);
    for (PetscInt i = 0; i < model->n_ports; i++) warped->P[k + m * i] *= root;
    for (PetscInt i = 0; model->Cm && i < 3 * model->n_pairs; i++) warped->Cm[k + m * i] *= root;
    if (model->C) WarpSquare(m, k, damper, warped->C);
    for (PetscInt j = 0; j < model->n_branches; j++) {
      WarpSquare(m, k, damper, warped->branch[j].S);
      for (PetscInt i = 0; i < 3 * model->n_pairs; i++) warped->branch[j].Sm[k + m * i] *= root;
    }
  }
}

/* s = (2 / dt) artanh(z dt / 2) of each eigenvalue z. */
PetscErrorCode ReducedLineariseSteps(const ReducedModel *model, PetscReal dt, const PetscBool closed[],
                                     const PetscReal lambda_n[], PetscReal sigma[], PetscReal omega[])
{
  ReducedModel warped;

  PetscFunctionBeginUser;
  PetscCall(ReducedModelCopy(model, &warped));
  WarpModel(dt, model, &warped);
  PetscCall(ReducedLinearise(&warped, closed, lambda_n, PETSC_FALSE, sigma, omega));
  for (PetscInt i = 0; i < 2 * model->m; i++) {
    const double complex s = 2 / dt * catanh(0.5 * dt * (sigma[i] + omega[i] * I));

    sigma[i] = creal(s);
    omega[i] = cimag(s);
  }
  PetscCall(ReducedModelDestroy(&warped));
  PetscFunctionReturn(0);
}
