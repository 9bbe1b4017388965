/*
   The march of a point: steps in windows from where it begins, until its regime is known (map.h). An error of PETSc's
   that a motion without solution or beyond numbers makes is an outcome of the point, not of the run.
*/
#include "map/mapimpl.h"

/* Statuses at t_{n+1}: whether they are those at the beginning of the window, and whether all closed pairs stick */
static void MarchLook(MapMarch w, MapSample *sample)
{
  PetscInt n_closed = 0, n_stick = 0;

  for (PetscInt i = 0; i < w->bodies->model.n_pairs; i++) {
    const ContactStatus status = w->state.status[i];

    n_closed += status != CONTACT_OPEN;
    n_stick += status == CONTACT_STICK;
    if (status != w->status[i]) sample->changed = PETSC_TRUE;
  }
  sample->stick += (n_closed && n_stick == n_closed) / (PetscReal)w->n;
}

/* Whether contact feeds the motion */
static PetscBool MarchIsMade(const MapMarch w)
{
  return ReducedContactFeeds(w->contact, PetscAbsReal(w->friction) + w->given);
}

/* The steps of the next window, and what its forces are like: force = total normal force, N, slip = mean slip speed
   along t, m/s. A window with an impulse counts as one in which statuses change. PETSC_ERR_FP where contact makes
   the motion, which MapMarchTry() takes as an outcome. */
static PetscErrorCode MarchWindow(MapMarch w, MapPoint *row)
{
  const PetscInt n_pairs = w->bodies->model.n_pairs;
  PetscReal     *force   = &w->force[w->n * w->n_windows];
  PetscReal     *slip    = &w->slip[w->n * w->n_windows];
  MapSample     *now     = &w->sample[w->n_windows];

  PetscFunctionBeginUser;
  *now = (MapSample){0};
  PetscCall(PetscArraycpy(w->status, w->state.status, n_pairs));
  for (PetscInt k = 0; k < w->n; k++) {
    const PetscReal *kick = MapBodiesKick(w->bodies, w->state.time, w->dt, w->kick);

    if (kick) now->changed = now->hit = PETSC_TRUE;
    PetscCall(ReducedStep(w->stepper, &(ReducedDrive){w->loads, w->sliding, kick}, &w->state, &w->report));
    w->given += kick ? PetscAbsReal(w->report.external) : 0;
    ReducedGetContactWork(&w->bodies->model, &w->report, &w->contact, &w->friction);
    force[k] = slip[k] = 0;
    for (PetscInt i = 0; i < n_pairs; i++) {
      force[k] += w->state.p[3 * i];
      slip[k] += w->report.slip[2 * i] / (w->dt * (PetscReal)n_pairs);
    }
    MarchLook(w, now);
    row->steps++;
  }
  MapForceMeasure(w->n, force, now);
  w->n_windows++;
  PetscCheck(!MarchIsMade(w), PETSC_COMM_SELF, PETSC_ERR_FP, "contact gives %g J", (double)w->contact);
  PetscFunctionReturn(0);
}

/* Windows until the regime is known, after the last impulse, or the time is over */
static PetscErrorCode MarchRun(MapMarch w, MapPoint *row)
{
  PetscBool dies;

  PetscFunctionBeginUser;
  for (w->n_windows = 0; w->n_windows < w->n_most;) {
    PetscCall(MarchWindow(w, row));
    PetscCall(MapMarchDiesOut(w, &dies));
    row->end = !MapBodiesAreHit(w->bodies, w->state.time - w->dt)                 ? MAP_TIME
               : dies                                                             ? MAP_DECAYS
               : MapIsSettled(w->n_windows, w->sample, w->map->rtol, &row->error) ? MAP_SETTLED
               : MapIsSteady(w->n_windows, w->sample, w->map->rtol, &row->error)  ? MAP_STEADY
                                                                                  : MAP_TIME;
    if (row->end != MAP_TIME) break;
  }
  PetscCall(MapMarchJudge(w, row));
  PetscFunctionReturn(0);
}

/* given = energy at the start, and work of impulses, J, beside which works of contact and friction are judged. Only
   errors of the laws and of numbers are outcomes; others are raised. */
PetscErrorCode MapMarchTry(MapMarch w, MapPoint *row)
{
  PetscErrorCode error;
  PetscReal      kinetic;

  PetscFunctionBeginUser;
  w->contact = w->friction = 0;
  ReducedEnergy(&w->bodies->model, &w->state, &kinetic, &w->given);
  w->given += kinetic;
  PetscCall(PetscPushErrorHandler(PetscReturnErrorHandler, NULL));
  error = MarchRun(w, row);
  PetscCall(PetscPopErrorHandler());
  PetscCheck(!error || error == PETSC_ERR_NOT_CONVERGED || error == PETSC_ERR_FP, PETSC_COMM_SELF, error,
             "a transient of the map ended by PETSc's error %d", (int)error);
  if (error) row->regime = MAP_UNKNOWN, row->end = MAP_FAILED;
  row->fault = MarchIsMade(w) ? MAP_MADE : error == PETSC_ERR_FP ? MAP_NO_NUMBER : MAP_NO_FORCES;
  PetscFunctionReturn(0);
}
