/*
   When something is recorded: at the multiples of an interval, each at the step nearest to it, which is the first with
   t >= k interval - dt / 2. Several multiples in one step are met together. Every rank computes the same from the
   same t and dt. Intervals are rounded to whole steps, so that rows are equally spaced in time, and are the run at
   most.
*/
#include "historyimpl.h"
#include <squeal/options.h>

static void ScheduleRound(Schedule *schedule, PetscReal dt)
{
  if (schedule->interval > 0 && dt > 0)
    schedule->interval = dt * PetscMax(1, PetscFloorReal(schedule->interval / dt + 0.5));
}

PetscBool ScheduleIsDue(const Schedule *schedule, PetscReal t, PetscReal dt)
{
  return schedule->interval > 0 && t >= schedule->next * schedule->interval - 0.5 * dt ? PETSC_TRUE : PETSC_FALSE;
}

/* next: the first multiple k that was not met yet */
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

/* An interval in whole steps; it is the run at most, to the last step at t, after whose start nothing would come.
   Raises an error for a longer one of the command line */
static PetscErrorCode HistoryRound(MPI_Comm comm, const char option[], PetscReal t, PetscReal dt, Schedule *s)
{
  char why[160];

  PetscFunctionBeginUser;
  ScheduleRound(s, dt);
  if (s->interval == 0 || ScheduleIsDue(&(Schedule){s->interval, 1}, t, dt)) PetscFunctionReturn(0);
  PetscCall(PetscSNPrintf(
    why, sizeof(why), "longer than the run: nothing but its start would be recorded; take at most %.6g s", (double)t));
  PetscCall(OptionsRefuse(comm, option, why));
  s->interval = t;
  PetscFunctionReturn(0);
}

/* What is not recorded: fields without files for them, states of pairs where there are none */
static PetscErrorCode HistoryOmit(History h)
{
  PetscBool fields;

  PetscFunctionBeginUser;
  PetscCall(ResultsWantFields(h->source.results, &fields));
  if (!fields) h->frames.interval = 0;
  if (!h->source.projector) h->pairs.interval = 0;
  PetscFunctionReturn(0);
}

PetscErrorCode HistoryFit(History h, PetscReal end, PetscReal dt)
{
  const PetscReal last = dt > 0 ? dt * PetscCeilReal(end / dt * (1 - 1e-12)) : 0;

  PetscFunctionBeginUser;
  PetscCall(HistoryOmit(h));
  if (dt <= 0) PetscFunctionReturn(0);
  PetscCall(HistoryRound(h->comm, "-dynamics_history_interval", last, dt, &h->rows));
  PetscCall(HistoryRound(h->comm, "-dynamics_pairs_interval", last, dt, &h->pairs));
  PetscCall(HistoryRound(h->comm, "-dynamics_snapshot_interval", last, dt, &h->frames));
  PetscFunctionReturn(0);
}
