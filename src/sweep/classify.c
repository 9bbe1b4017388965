/*
   Which instability is real. A positive growth is `unstable` when it exceeds three times the estimated error of its
   eigenvalue, and `numerical` when the error bar covers zero. Growth near a lock-in goes as the square root of the
   distance of the parameter from its critical value, and so does the error bar there: the distance is listed too.
*/
#include "sweepimpl.h"

#define TINY 1e-9 /* growth below this, relative to |lambda|, is rounding */

PetscErrorCode SweepClassify(Sweep sweep)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < GridSize(&sweep->grid); i++)
    for (PetscInt k = 0; k < sweep->point[i].n; k++) {
      SweepMode         *m      = &sweep->point[i].mode[k];
      const PetscComplex lambda = CMPLX(m->sigma, m->omega);

      m->unstable  = ReducedIsUnstable(lambda, PetscIsInfOrNanReal(m->error) ? 0 : m->error);
      m->numerical = !m->unstable && m->sigma > TINY * cabs(lambda) ? PETSC_TRUE : PETSC_FALSE;
      PetscCall(PetscStrncpy(m->label, sweep->label[m->branch].text, sizeof(m->label)));
    }
  PetscFunctionReturn(0);
}

PetscInt SweepEventLine(Sweep sweep, PetscInt e)
{
  return sweep->grid.place[sweep->events.event[e].place].line;
}

PetscReal SweepOnsetDistance(Sweep sweep, PetscInt point, PetscInt branch)
{
  const PetscReal value   = sweep->grid.value[0][point % sweep->grid.n[0]];
  PetscReal       nearest = NAN;

  for (PetscInt e = 0; e < sweep->events.n; e++) {
    const Event    *event = &sweep->events.event[e];
    const PetscReal distance =
      PetscAbsReal(value - event->critical) / PetscMax(PetscAbsReal(event->critical), PETSC_MACHINE_EPSILON);

    if (!event->found || SweepEventLine(sweep, e) != point / sweep->grid.n[0]) continue;
    if (event->branch[0] != branch && event->branch[1] != branch) continue;
    if (!(distance >= nearest)) nearest = distance;
  }
  return nearest;
}
