/*
   Modes of the reduced model beside those of a full solution at the same point: the true errors, and whether they are
   within what both state. Pure functions: no MPI, no options.
*/
#include "compare.h"

/* Those of the full solution */
typedef struct {
  PetscInt    n;
  const Mode *mode;
} FullModes;

/* Largest distance of a full eigenvalue in the window from the nearest reduced one, relative, and the frequency where
   it is */
static PetscReal LargestDistance(PetscInt n, const Mode full[], PetscReal growth, const ReducedModes *reduced,
                                 PetscReal *omega)
{
  PetscReal largest = 0;

  for (PetscInt i = 0; i < n; i++) {
    const PetscComplex lambda  = CMPLX(full[i].sigma, full[i].omega);
    PetscReal          nearest = PETSC_MAX_REAL;

    if (full[i].rigid || PetscAbsReal(full[i].sigma) > growth) continue;
    for (PetscInt k = 0; k < reduced->n; k++) nearest = PetscMin(nearest, cabs(reduced->lambda[k] - lambda));
    if (nearest <= largest * cabs(lambda)) continue;
    largest = nearest / cabs(lambda);
    *omega  = full[i].omega;
  }
  return largest;
}

/* ratio = |lambda_full - lambda_reduced| / (error_full + error_reduced), the largest of all modes, and how many
   exceed 1. A NaN counts as exceeding, hence the comparisons by !(<=). */
static void CheckRatios(PetscInt n, const Mode full[], PetscReal growth, const ReducedModes *reduced, FullCheck *check)
{
  for (PetscInt i = 0; i < n; i++) {
    const PetscComplex lambda  = CMPLX(full[i].sigma, full[i].omega);
    PetscReal          nearest = PETSC_MAX_REAL, stated = 1, ratio;

    if (full[i].rigid || !reduced->n || PetscAbsReal(full[i].sigma) > growth) continue;
    for (PetscInt k = 0; k < reduced->n; k++) {
      const PetscReal distance = cabs(reduced->lambda[k] - lambda);

      if (distance < nearest) nearest = distance, stated = reduced->error[k] + full[i].error;
    }
    ratio = nearest / stated;
    if (!(ratio <= 1)) check->n_beyond++;
    if (!(ratio <= check->ratio)) check->ratio = ratio;
  }
}

/* How many modes each solution has of those that both must have, how many grow, and the largest error that the full one
   states */
static void CheckCountModes(const ReducedWindow *window, const ModesLimit *limit, const FullModes *full,
                            const ReducedModes *reduced, FullCheck *check)
{
  const PetscReal growth = window->growth;

  for (PetscInt i = 0; i < full->n; i++) {
    if (PetscAbsReal(full->mode[i].sigma) > growth) continue;
    check->n_full++;
    check->n_unstable_full +=
      ModesLimitJudge(limit, full->mode[i].sigma, full->mode[i].omega, full->mode[i].error) == MODE_UNSTABLE;
    if (!full->mode[i].rigid)
      check->full = PetscMax(check->full, full->mode[i].error / hypot(full->mode[i].sigma, full->mode[i].omega));
  }
  for (PetscInt k = 0; k < reduced->n; k++) {
    const PetscReal omega = cimag(reduced->lambda[k]);

    if (omega < window->low || omega > window->high || PetscAbsReal(creal(reduced->lambda[k])) > growth) continue;
    check->n_reduced++;
    check->n_unstable_reduced +=
      ModesLimitJudge(limit, creal(reduced->lambda[k]), omega, reduced->error[k]) == MODE_UNSTABLE;
  }
}

void FullCompare(const ReducedWindow *window, const ModesLimit *limit, PetscInt n, const Mode full[],
                 const ReducedModes *reduced, FullCheck *check)
{
  CheckCountModes(window, limit, &(FullModes){n, full}, reduced, check);
  CheckRatios(n, full, window->growth, reduced, check);
  check->error = LargestDistance(n, full, window->growth, reduced, &check->omega);
}
