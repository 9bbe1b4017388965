/* Corrections of all modes on the basis until their backward errors are at rounding, and these modes as spectra */
#include "projection.h"

#define SETTLE_ROUNDS   8
#define SETTLE_ABOUT    12 /* rounds about a complex shift */
#define SETTLE_ROUNDING 10 /* times the limits of errors, where corrections add nothing to the basis any more */

/* The largest backward errors of right and left vectors */
static void WorstErrors(const ProjectionModes *found, PetscReal worst[2])
{
  worst[0] = worst[1] = 0;
  for (PetscInt i = 0; i < found->n; i++)
    for (int side = 0; side < 2; side++) worst[side] = PetscMax(worst[side], found->backward[side][i]);
}

/* Whether the modes have no more digits than these on a basis that corrections left as it was */
static PetscBool AtRounding(const Projection *p, const ProjectionModes *found, PetscInt size_before)
{
  PetscReal worst[2];

  WorstErrors(found, worst);
  return found->size == size_before && worst[0] <= SETTLE_ROUNDING * p->limit[0] &&
             worst[1] <= SETTLE_ROUNDING * p->limit[1]
           ? PETSC_TRUE
           : PETSC_FALSE;
}

/* With -info */
static PetscErrorCode InfoRound(const Projection *p, const ProjectionModes *found, PetscInt n_columns)
{
  PetscReal worst[2];

  PetscFunctionBeginUser;
  WorstErrors(found, worst);
  PetscCall(PetscInfo(p->space.V,
                      "%" PetscInt_FMT " modes on %" PetscInt_FMT
                      " vectors: backward errors %.1e right, %.1e left, %" PetscInt_FMT
                      " corrections; measure %.3g, |kappa - s| %.4g of %.4g\n",
                      found->n, found->size, (double)worst[0], (double)worst[1], n_columns,
                      (double)p->window->route.beyond, (double)found->lambda_reach, (double)p->reach));
  PetscFunctionReturn(0);
}

/* The modes on the present basis: followed from what they were, or all anew */
static PetscErrorCode FindModes(const Projection *p, PetscBool anew, ProjectionModes *found)
{
  ProjectionModes before   = *found;
  PetscBool       followed = PETSC_FALSE;

  PetscFunctionBeginUser;
  if (!anew) PetscCall(ProjectionFollow(p, &before, found, &followed));
  if (anew || !followed) PetscCall(ProjectionEigen(p, found));
  if ((anew || !followed) && p->pencil->n_laws) PetscCall(ProjectionLawsSolve(p, found));
  if (!anew) PetscCall(ProjectionModesDestroy(&before));
  PetscFunctionReturn(0);
}

PetscErrorCode ProjectionIterate(Projection *p, ProjectionModes *found, PetscBool *settled)
{
  const int most      = p->about ? SETTLE_ABOUT : SETTLE_ROUNDS;
  PetscInt  n_columns = 1, size = 0;

  PetscFunctionBeginUser;
  *settled = PETSC_FALSE;
  for (int round = 0; round < most && n_columns; round++, size = found->size) {
    PetscCall(FindModes(p, round ? PETSC_FALSE : PETSC_TRUE, found));
    if (!p->about && found->lambda_reach > p->reach) break;
    PetscCall(ProjectionCorrect(p, found, &n_columns));
    PetscCall(InfoRound(p, found, n_columns));
    if (AtRounding(p, found, size)) n_columns = 0;
  }
  *settled = n_columns ? PETSC_FALSE : PETSC_TRUE;
  PetscFunctionReturn(0);
}

PetscErrorCode ProjectionPut(Projection *p, const ProjectionModes *found)
{
  Modes modes = p->modes;

  PetscFunctionBeginUser;
  PetscCall(SpectrumDestroy(&modes->right));
  PetscCall(SpectrumDestroy(&modes->left_spectrum));
  PetscCall(ProjectionLift(p, found, PETSC_FALSE, &modes->right));
  PetscCall(WindowSelect(p->window, &modes->right));
  if (!modes->left) PetscFunctionReturn(0);
  PetscCall(ProjectionLift(p, found, PETSC_TRUE, &modes->left_spectrum));
  PetscCall(WindowSelect(p->window, &modes->left_spectrum));
  PetscFunctionReturn(0);
}
