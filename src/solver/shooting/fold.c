/*
   Folds of a branch (shooting.h): where its parameter p turns back, the zero of the slope v(s) = dp/ds along the
   branch, s the distance from `start` along its tangent. Regula falsi with the change of the end that stays
   (Illinois: M. Dowell, P. Jarratt, BIT 11, 1971, 168), since each value of v costs a cycle.
*/
#include "shooting.h"

#define FOLD_MAX_IT 12
#define FOLD_RTOL   1e-4 /* of the slope dp/ds between the two cycles: the parameter is off by the square of that */

/* The cycle at a distance from `start` along `along`, and the branch's direction there; found is false where there is
   none */
static PetscErrorCode FoldTry(const Shooting *s, PetscReal step, const ShootingCycle *start,
                              const ShootingTangent *along, ShootingPlace *at, PetscBool *found)
{
  ShootingDirection direction = SHOOTING_SPLITS;

  PetscFunctionBeginUser;
  PetscCall(ShootingCopy(s->n, start, &at->cycle));
  PetscCall(ShootingAdvance(s, step, along, &at->cycle));
  PetscCall(PetscArraycpy(at->tangent.x, along->x, s->n));
  at->tangent.period = along->period;
  at->tangent.value  = along->value;
  if (at->cycle.converged) PetscCall(ShootingGetTangent(s, &at->cycle, &at->tangent, &direction));
  *found = direction == SHOOTING_ALONG ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(0);
}

/* va and vb are slopes of opposite sign at distances a and b from start; the new place is where the line through
   both is zero. *error, in the unit of the parameter, by a parabola of slope v there: |v| (b - a) / 2. -1 where a
   cycle or a direction is lost. */
PetscErrorCode ShootingFindFold(const Shooting *s, const ShootingPlace *start, PetscReal step, PetscReal beyond,
                                ShootingPlace *fold, PetscReal *error)
{
  PetscReal a = 0, b = step, va = start->tangent.value, vb = beyond;
  PetscBool found = PETSC_TRUE;
  int       side  = 0;

  PetscFunctionBeginUser;
  *error = -1;
  for (int it = 0; it < FOLD_MAX_IT && found; it++) {
    const PetscReal at = (a * vb - b * va) / (vb - va);
    PetscReal       v;

    PetscCall(FoldTry(s, at, &start->cycle, &start->tangent, fold, &found));
    if (!found) break;
    v      = fold->tangent.value;
    *error = 0.5 * PetscAbsReal(v) * (b - a); /* p is a parabola there, of slope v at `at` */
    if (PetscAbsReal(v) <= FOLD_RTOL * PetscAbsReal(start->tangent.value - beyond)) break;
    if ((v > 0) == (va > 0)) { /* regula falsi; the end that stays counts half (Illinois) */
      a  = at;
      va = v;
      if (side == 1) vb /= 2;
      side = 1;
    } else {
      b  = at;
      vb = v;
      if (side == 2) va /= 2;
      side = 2;
    }
  }
  if (!found) *error = -1;
  PetscFunctionReturn(0);
}
