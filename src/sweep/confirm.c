/*
   Onsets: the critical values of the first parameter. Each is found on the reduced model by iteration (onset.c); then
   the full pencil is factored at that value, the vectors of the pair are corrected with it, the basis takes the
   corrections in, and the value is found again. It counts as confirmed when this no longer changes it.
*/
#include "sweepimpl.h"

#define CONFIRMED   1e-7 /* relative change of the critical value by a further full correction */
#define ONSET_WIDTH 1e-2 /* half width of the frequencies around the pair, relative */
#define ONSET_DROP  1e-9
#define ONSET_STEPS 5

/* Finds the value on the reduced model, and the modes there; alike on all ranks */
static PetscErrorCode OnsetReduced(Sweep sweep, const BranchLine *line, BranchEvent *event, ReducedModes *critical)
{
  PetscFunctionBeginUser;
  PetscCall(ReducedModesDestroy(critical));
  PetscCall(OnsetFind(&sweep->basis.reduced, line, event, critical));
  PetscCallMPI(MPI_Bcast(event, (PetscMPIInt)sizeof(*event), MPI_BYTE, 0, sweep->comm));
  PetscCall(ReducedModesBroadcast(sweep->comm, 0, critical));
  PetscFunctionReturn(0);
}

/* Whether the onset is that of a simple mode: sigma = 0 with damping */
static PetscBool OnsetIsSimple(Sweep sweep, const PetscReal p[], const BranchEvent *event)
{
  if (event->kind != EVENT_LOCK_IN && event->kind != EVENT_LOCK_OUT) return PETSC_FALSE;
  return ReducedIsDamped(&sweep->basis.reduced, p);
}

/* Frequencies about an onset: close to the pair or the mode; the whole window for a divergence with damping, whose shift
   is far from all of them */
static ReducedWindow WindowNear(Sweep sweep, const PetscReal p[], const BranchEvent *event)
{
  ReducedWindow near = sweep->window;

  if (ReducedIsDamped(&sweep->basis.reduced, p) && !OnsetIsSimple(sweep, p, event)) return near;
  near.low  = event->omega * (1 - ONSET_WIDTH);
  near.high = PetscMax(event->omega * (1 + ONSET_WIDTH), ONSET_WIDTH * near.high);
  return near;
}

/* The basis takes in corrections at p: of a simple mode itself, critical, else of the modes in the window */
static PetscErrorCode OnsetCorrect(Sweep sweep, const Correction *correction, const PetscReal p[],
                                   const ReducedWindow *near, BranchEvent *event, ReducedModes *critical)
{
  PetscInt n_added;

  PetscFunctionBeginUser;
  if (!OnsetIsSimple(sweep, p, event)) {
    PetscCall(ReducedModesDestroy(critical));
    PetscCall(ReducedSolve(&sweep->basis.reduced, p, near, critical));
    PetscCall(ReducedModesBroadcast(sweep->comm, 0, critical));
    event->n_solved++;
  }
  PetscCall(CorrectionApply(correction, critical, ONSET_DROP, &sweep->basis, &n_added));
  sweep->basis.reduced.n_used = sweep->basis.reduced.n;
  event->n_corrected++;
  PetscFunctionReturn(0);
}

/* Alternates corrections by the full problem and the reduced iteration; change = the last one of the critical value */
static PetscErrorCode OnsetConverge(Sweep sweep, const BranchLine *line, PetscReal p[], BranchEvent *event,
                                    ReducedModes *critical, PetscReal *change)
{
  Correction   *correction = &sweep->onset_correction;
  ReducedWindow near;

  PetscFunctionBeginUser;
  *change = PETSC_MAX_REAL;
  BranchLineSet(line, event->critical, p);
  near = WindowNear(sweep, p, event);
  PetscCall(CorrectionCreate(sweep->pencil, p, &near, &sweep->progress, correction));
  for (int step = 0; step < ONSET_STEPS && event->found && *change > CONFIRMED * PetscAbsReal(event->critical);
       step++) {
    const PetscReal before = event->critical;

    BranchLineSet(line, before, p);
    if (step) PetscCall(CorrectionMove(sweep->pencil, p, correction));
    PetscCall(OnsetCorrect(sweep, correction, p, &near, event, critical));
    PetscCall(OnsetReduced(sweep, line, event, critical));
    *change = PetscAbsReal(event->critical - before);
  }
  PetscFunctionReturn(0);
}

/* One onset to the end */
static PetscErrorCode OnsetConfirm(Sweep sweep, PetscInt e)
{
  BranchEvent *event  = &sweep->events.event[e];
  PetscReal    change = PETSC_MAX_REAL, *p;
  BranchLine   line   = {sweep->grid.n_moved[0], sweep->grid.n[0], sweep->grid.parameter[0], sweep->grid.value[0], NULL,
                         &sweep->window};
  SweepPlace   place  = sweep->grid.place[event->place];
  ReducedModes critical = {0};

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(sweep->grid.n_parameters, &p));
  GridFill(&sweep->grid, &place, p);
  line.base = p;
  PetscCall(OnsetReduced(sweep, &line, event, &critical));
  if (event->found && sweep->method == SWEEP_REDUCED)
    PetscCall(OnsetConverge(sweep, &line, p, event, &critical, &change));
  PetscCall(ReducedModesDestroy(&critical));
  sweep->is_confirmed[e] =
    event->found && change <= CONFIRMED * PetscAbsReal(event->critical) ? PETSC_TRUE : PETSC_FALSE;
  if (change < PETSC_MAX_REAL) event->error = PetscMax(change, event->error);
  if (sweep->is_confirmed[e] && sweep->statics) { /* the same pairs must be closed as where it was found */
    PetscInt status;

    place.value[0] = event->critical;
    PetscCall(SweepStatusSolve(sweep, &place, &status));
    sweep->is_confirmed[e] = status == place.status ? PETSC_TRUE : PETSC_FALSE;
  }
  PetscCall(PetscFree(p));
  PetscFunctionReturn(0);
}

PetscInt SweepEventLine(Sweep sweep, PetscInt e)
{
  return sweep->grid.place[sweep->events.event[e].place].line;
}

/* Whether onset e comes after onset e + 1: by line, then by critical value */
static PetscBool OnsetIsAfter(Sweep sweep, PetscInt e)
{
  const BranchEvent *event   = &sweep->events.event[e];
  const PetscInt     line[2] = {SweepEventLine(sweep, e), SweepEventLine(sweep, e + 1)};

  if (line[0] != line[1]) return line[0] > line[1] ? PETSC_TRUE : PETSC_FALSE;
  return event[0].critical > event[1].critical ? PETSC_TRUE : PETSC_FALSE;
}

static void OnsetsSort(Sweep sweep)
{
  for (PetscInt i = 1; i < sweep->events.n; i++)
    for (PetscInt e = i - 1; e >= 0 && OnsetIsAfter(sweep, e); e--) {
      const BranchEvent event = sweep->events.event[e];
      const PetscBool   yes   = sweep->is_confirmed[e];

      sweep->events.event[e]     = sweep->events.event[e + 1];
      sweep->is_confirmed[e]     = sweep->is_confirmed[e + 1];
      sweep->events.event[e + 1] = event;
      sweep->is_confirmed[e + 1] = yes;
    }
}

PetscErrorCode SweepOnsets(Sweep sweep)
{
  Progress progress;
  PetscInt n = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(PetscMax(1, sweep->events.n), &sweep->is_confirmed));
  for (PetscInt e = 0; e < sweep->events.n; e++) n += sweep->events.event[e].kind != EVENT_JUMP;
  PetscCall(ProgressBegin(&progress, "onsets", n));
  for (PetscInt e = 0; e < sweep->events.n; e++) {
    if (sweep->events.event[e].kind == EVENT_JUMP) continue;
    PetscCall(OnsetConfirm(sweep, e));
    PetscCall(ProgressStep(&progress));
  }
  PetscCall(ProgressEnd(&progress));
  PetscCall(ShiftInvertDestroy(&sweep->onset_correction.factor));
  OnsetsSort(sweep);
  PetscFunctionReturn(0);
}
