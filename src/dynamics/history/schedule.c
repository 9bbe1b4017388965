/*
   When something is recorded: at the multiples of an interval, each at the step nearest to it, which is the first with
   t >= k interval - dt / 2. Several multiples in one step are met together. Every rank computes the same from the
   same t and dt. Intervals are rounded to whole steps, so that rows are equally spaced in time.
*/
#include "historyimpl.h"

void ScheduleRound(Schedule *schedule, PetscReal dt)
{
  if (schedule->interval > 0 && dt > 0)
    schedule->interval = dt * PetscMax(1, PetscFloorReal(schedule->interval / dt + 0.5));
}

PetscBool ScheduleIsDue(const Schedule *schedule, PetscReal t, PetscReal dt)
{
  return schedule->interval > 0 && t >= schedule->next * schedule->interval - 0.5 * dt ? PETSC_TRUE : PETSC_FALSE;
}

PetscBool ScheduleMeet(Schedule *schedule, PetscReal t, PetscReal dt)
{
  PetscReal k;

  if (!ScheduleIsDue(schedule, t, dt)) return PETSC_FALSE;
  k = PetscMax(PetscFloorReal((t + 0.5 * dt) / schedule->interval), schedule->next);
  if (t >= (k + 1) * schedule->interval - 0.5 * dt) k += 1; /* the quotient was rounded down below a whole number */
  schedule->next = k + 1;
  return PETSC_TRUE;
}

void ScheduleRestore(Schedule *schedule, const Schedule *kept)
{
  const PetscReal met = (kept->next - 1) * kept->interval; /* the last one, s */

  if (schedule->interval <= 0) return;
  schedule->next = kept->next;
  if (schedule->interval != kept->interval) schedule->next = PetscFloorReal(met / schedule->interval * (1 + 1e-12)) + 1;
  if (kept->interval <= 0) schedule->next = 0; /* nothing was met: at once */
}
