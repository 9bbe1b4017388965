/*
   What of C is alpha M + beta K moves the undamped modes but leaves their vectors:

      lambda^2 + (alpha + beta kappa) lambda + kappa = 0,   kappa = omega^2;

   alpha and beta by least squares from y'Cx / y'Mx of the undamped modes. The rest couples them: beyond.c.
*/
#include "projection.h"

#define FIT_DISTINCT 1e-6 /* variance of kappa beside its mean square: below it beta cannot be told from alpha */

/* y'Cx / y'Mx of column j; NAN where that says nothing */
static PetscErrorCode ModeDamping(const ModalBlock modal[2], PetscInt j, PetscReal *damping)
{
  const PetscBool paired = modal[1].n == modal[0].n ? PETSC_TRUE : PETSC_FALSE;
  PetscReal       product[2];
  Vec             y, Ax;

  PetscFunctionBeginUser;
  PetscCall(BVGetColumn(modal[paired].x, j, &y));
  for (int i = 0; i < 2; i++) {
    const BV images = i ? modal[0].Mx : modal[0].Cx;

    PetscCall(BVGetColumn(images, j, &Ax));
    PetscCall(VecDot(Ax, y, &product[i]));
    PetscCall(BVRestoreColumn(images, j, &Ax));
  }
  PetscCall(BVRestoreColumn(modal[paired].x, j, &y));
  *damping = product[1] != 0 ? product[0] / product[1] : NAN;
  PetscFunctionReturn(0);
}

PetscErrorCode ProjectionFit(Projection *p, const Spectrum *right, const ModalBlock modal[2])
{
  PetscReal sum[6] = {0, 0, 0, 0, 0, 0}; /* 1, kappa, kappa^2, c, c kappa, c^2, with kappa relative to the window's */
  PetscReal unit   = PetscSqr(PetscMax(p->window->high, p->window->target)), det;

  PetscFunctionBeginUser;
  p->alpha = p->beta = 0;
  unit               = PetscMax(unit, PetscSqr(p->window->known.scale));
  for (PetscInt j = 0; j < modal[0].n; j++) {
    const PetscInt  i     = modal[0].mode[j];
    const PetscReal kappa = right->omega[i] * right->omega[i] / unit;
    PetscReal       c;

    if (right->xi[i] || right->sigma[i] != 0) continue;
    PetscCall(ModeDamping(modal, j, &c));
    if (!isfinite(c)) continue;
    sum[0] += 1, sum[1] += kappa, sum[2] += kappa * kappa, sum[3] += c, sum[4] += c * kappa;
    sum[5] += c * c;
  }
  det = sum[0] * sum[2] - sum[1] * sum[1];
  if (det > FIT_DISTINCT * sum[0] * sum[2]) p->beta = PetscMax(0, (sum[0] * sum[4] - sum[1] * sum[3]) / det);
  if (sum[0] > 0) p->alpha = PetscMax(0, (sum[3] - p->beta * sum[1]) / sum[0]);
  if (p->beta < FIT_DISTINCT * FIT_DISTINCT * p->alpha) p->beta = 0;
  if (p->alpha < FIT_DISTINCT * FIT_DISTINCT * p->beta) p->alpha = 0;
  p->misfit = sum[5] - 2 * (p->alpha * sum[3] + p->beta * sum[4]) + PetscSqr(p->alpha) * sum[0] +
              2 * p->alpha * p->beta * sum[1] + PetscSqr(p->beta) * sum[2];
  p->misfit = sum[5] > 0 ? PetscSqrtReal(PetscMax(0, p->misfit) / sum[5]) : 0;
  p->beta /= unit;
  PetscFunctionReturn(0);
}
