/*
   Onsets: the critical values of the first parameter. Each is found on the reduced model by iteration (onset.c); then
   the vectors of the pair are corrected by the full pencil at that value, the basis takes the corrections in, and the
   value is found again. It counts as confirmed when this no longer changes it.

   Corrections take factors of the full pencil, not those at the very value: with P from another point they are the
   errors of the vectors times P^-1 Q, and Galerkin's method scales them. The error of an eigenvalue, of second order,
   then falls at least by ((c - 1) / (c + 1))^2, c the condition of P^-1 Q (L. V. Kantorovich, Uspekhi Mat. Nauk 3,
   1948), so that (c - 1)^2 / (4 c) of the change remains. Onsets with a small c are corrected together, by one
   factorisation, as long as their changes fall; then each is alone, with factors of its own next to the pair.
*/
#include "sweepimpl.h"

#define CONFIRMED 1e-7 /* relative change of the critical value by a further full correction */
/* Half width of the window around the pair, relative: the modes in it are corrected, and its upper end is the shift
   of an onset's own factors. */
#define ONSET_WIDTH 1e-2
/* Directions of corrections that are left out, beside their M-norm; far below the greedy choice's, as an onset is
   wanted to CONFIRMED. */
#define ONSET_DROP  1e-9
#define ONSET_STEPS 5
/* c up to which factors of another point serve: the error of an eigenvalue falls by ((16 - 1) / (16 + 1))^2 = 0.78
   at worst, and by ONSET_FALLS in practice or they are given up. */
#define ONSET_SPREAD 16
/* Onsets corrected together: bounds the right-hand sides that are in memory at once. */
#define ONSET_BLOCK 16
/* Least fall of the change from one correction to the next as long as factors of another point serve; slower than
   that, factors of its own cost less. */
#define ONSET_FALLS 0.1

/* An onset on its way */
typedef struct {
  PetscInt      e;
  BranchEvent  *event;
  SweepPlace    place;
  BranchLine    line;
  ReducedModes  critical; /* those that take part */
  ReducedWindow near;
  PetscReal    *p, change;      /* all parameters at the critical value; what the last correction says of its error */
  PetscBool     pending, alone; /* to be corrected; with factors of its own */
} OnsetWork;

/* Whether there is a value to confirm: a place where modes change places is none */
static PetscBool OnsetIsLocated(const BranchEvent *event)
{
  return event->found && !event->jumps ? PETSC_TRUE : PETSC_FALSE;
}

/* Finds the value on the reduced model, and the modes there. Every rank computes, but rank 0 decides: the iteration
   takes branches on rounding, and what follows is collective. The event holds no pointers, so that its bytes are
   all of it. */
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

/* Frequencies about an onset: close to the pair or the mode; the whole window for a divergence with damping, whose
   shift is far from all of them */
static ReducedWindow WindowNear(Sweep sweep, const PetscReal p[], const BranchEvent *event)
{
  ReducedWindow near = sweep->window;

  if (ReducedIsDamped(&sweep->basis.reduced, p) && !OnsetIsSimple(sweep, p, event)) return near;
  near.low  = event->omega * (1 - ONSET_WIDTH);
  near.high = PetscMax(event->omega * (1 + ONSET_WIDTH), ONSET_WIDTH * near.high);
  return near;
}

/* Adds the residuals at an onset: of a simple mode itself, else of the modes next to it */
static PetscErrorCode OnsetCollect(Sweep sweep, OnsetWork *w, CorrectionBlock *block)
{
  Correction *correction = &sweep->greedy.correction;

  PetscFunctionBeginUser;
  if (!OnsetIsSimple(sweep, w->p, w->event)) {
    PetscCall(ReducedModesDestroy(&w->critical));
    PetscCall(ReducedSolve(&sweep->basis.reduced, w->p, &w->near, &w->critical));
    PetscCall(ReducedModesBroadcast(sweep->comm, 0, &w->critical));
    w->event->n_solved++;
  }
  PetscCall(CorrectionMove(sweep->pencil, w->p, correction));
  PetscCall(CorrectionCollect(correction, &w->critical, CORRECT_BOTH, &sweep->basis, block));
  w->event->n_corrected++;
  PetscFunctionReturn(0);
}

/* Finds the value again after a correction; spread = c of the factors there. change becomes the error that remains,
      |p_now - p_before| max(1, (c - 1)^2 / (4 c)),
   in the unit of the parameter: with factors of its own (c = 1) the change itself, which the next correction would
   undercut. Changes of less than CONFIRMED |p| end it, ONSET_STEPS corrections do so unconfirmed. */
static PetscErrorCode OnsetAgain(Sweep sweep, PetscReal spread, OnsetWork *w)
{
  const PetscReal before = w->event->critical, change = w->change, rest = PetscSqr(spread - 1) / (4 * spread);

  PetscFunctionBeginUser;
  PetscCall(OnsetReduced(sweep, &w->line, w->event, &w->critical));
  w->change  = PetscAbsReal(w->event->critical - before) * PetscMax(1, rest);
  w->pending = OnsetIsLocated(w->event) && w->change > CONFIRMED * PetscAbsReal(w->event->critical) &&
                   w->event->n_corrected < ONSET_STEPS
                 ? PETSC_TRUE
                 : PETSC_FALSE;
  if (w->change > ONSET_FALLS * change) w->alone = PETSC_TRUE;
  BranchLineSet(&w->line, w->event->critical, w->p);
  PetscFunctionReturn(0);
}

/* Corrects some onsets together with the factors there are, and finds them again */
static PetscErrorCode OnsetsCorrect(Sweep sweep, PetscInt n, OnsetWork *some[])
{
  const Correction *correction = &sweep->greedy.correction;
  CorrectionBlock   block      = {0};
  PetscInt          n_added;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < n; i++) PetscCall(OnsetCollect(sweep, some[i], &block));
  PetscCall(CorrectionApply(correction, (CorrectionDrop){.length = ONSET_DROP}, &sweep->basis, &block, &n_added));
  PetscCall(BasisUse(&sweep->basis, sweep->basis.reduced.n));
  for (PetscInt i = 0; i < n; i++) {
    const PetscReal spread = some[i]->alone ? 1 : CorrectionSpread(correction, &sweep->basis.reduced, some[i]->p);

    PetscCall(OnsetAgain(sweep, spread, some[i]));
  }
  PetscFunctionReturn(0);
}

/* Factors for an onset: of its own, next to the pair, where it is alone; else any that are near, or new ones for all.
   *owner = the onset alone whose factors they are, or NULL */
static PetscErrorCode OnsetFactor(Sweep sweep, OnsetWork *w, OnsetWork **owner)
{
  Correction          *correction = &sweep->greedy.correction;
  const ReducedWindow *window     = w->alone ? &w->near : &sweep->window;
  OnsetWork           *wanted     = w->alone ? w : NULL;
  PetscBool            serves     = correction->has_factor && *owner == wanted ? PETSC_TRUE : PETSC_FALSE;

  PetscFunctionBeginUser;
  if (serves && !w->alone)
    serves = CorrectionSpread(correction, &sweep->basis.reduced, w->p) <= ONSET_SPREAD ? PETSC_TRUE : PETSC_FALSE;
  if (!serves) PetscCall(CorrectionFactor(sweep->pencil, w->p, window, &sweep->progress, correction));
  *owner = wanted;
  PetscFunctionReturn(0);
}

/* Corrects until nothing is pending. Onsets are taken in their order; the others of a block are those for which the
   factors of its first one serve, so that one factorisation is shared by as many as possible. It ends: each pass
   raises n_corrected of its first onset, which ONSET_STEPS bounds. */
static PetscErrorCode OnsetsConverge(Sweep sweep, PetscInt n, OnsetWork work[])
{
  const Correction *correction = &sweep->greedy.correction;
  OnsetWork        *some[ONSET_BLOCK], *owner = NULL;

  PetscFunctionBeginUser;
  for (PetscInt first = 0; first < n;) {
    PetscInt m = 0;

    if (!work[first].pending) {
      first++;
      continue;
    }
    PetscCall(OnsetFactor(sweep, &work[first], &owner));
    some[m++] = &work[first];
    for (PetscInt i = first + 1; i < n && m < ONSET_BLOCK && !owner; i++)
      if (work[i].pending && !work[i].alone &&
          CorrectionSpread(correction, &sweep->basis.reduced, work[i].p) <= ONSET_SPREAD)
        some[m++] = &work[i];
    PetscCall(OnsetsCorrect(sweep, m, some));
  }
  PetscFunctionReturn(0);
}

/* Finds an onset on the reduced model */
static PetscErrorCode OnsetStart(Sweep sweep, PetscInt e, OnsetWork *w)
{
  const SweepGrid *grid = &sweep->grid;

  PetscFunctionBeginUser;
  w->e     = e;
  w->event = &sweep->events.event[e];
  w->place = grid->place[w->event->place];
  PetscCall(PetscMalloc1(grid->n_parameters, &w->p));
  GridFill(grid, &w->place, w->p);
  w->line   = (BranchLine){grid->n_moved[0], grid->n[0], grid->parameter[0], grid->value[0], w->p, &sweep->window};
  w->change = PETSC_MAX_REAL;
  PetscCall(OnsetReduced(sweep, &w->line, w->event, &w->critical));
  w->pending = OnsetIsLocated(w->event) && sweep->method == SWEEP_REDUCED ? PETSC_TRUE : PETSC_FALSE;
  if (w->event->found) BranchLineSet(&w->line, w->event->critical, w->p);
  if (w->event->found) w->near = WindowNear(sweep, w->p, w->event);
  PetscFunctionReturn(0);
}

/* What became of an onset. About the sliding state the reduced model was made for the contact status of its
   segment: the critical value counts only if the status there is the same one. */
static PetscErrorCode OnsetEnd(Sweep sweep, OnsetWork *w)
{
  BranchEvent *event     = w->event;
  PetscBool   *confirmed = &sweep->is_confirmed[w->e];

  PetscFunctionBeginUser;
  *confirmed =
    OnsetIsLocated(event) && w->change <= CONFIRMED * PetscAbsReal(event->critical) ? PETSC_TRUE : PETSC_FALSE;
  if (w->change < PETSC_MAX_REAL && !event->jumps) event->error = PetscMax(w->change, event->error);
  if (*confirmed && sweep->statics) { /* the same pairs must be closed as where it was found */
    PetscInt status;

    w->place.value[0] = event->critical;
    PetscCall(SweepStatusSolve(sweep, &w->place, &status));
    *confirmed = status == w->place.status ? PETSC_TRUE : PETSC_FALSE;
  }
  PetscCall(ReducedModesDestroy(&w->critical));
  PetscCall(PetscFree(w->p));
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

/* By insertion: there are few, and the confirmations move with their events. */
void SweepSortOnsets(Sweep sweep)
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
  OnsetWork *work;
  Progress   progress;
  PetscInt   n = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(PetscMax(1, sweep->events.n), &sweep->is_confirmed));
  PetscCall(PetscCalloc1(PetscMax(1, sweep->events.n), &work));
  for (PetscInt e = 0; e < sweep->events.n; e++) n += sweep->events.event[e].kind != EVENT_JUMP;
  if (n) PetscCall(BasisTruncate(&sweep->basis)); /* what tells errors elsewhere would only make the problems larger */
  PetscCall(ProgressBegin(&progress, "onsets", n));
  n = 0;
  for (PetscInt e = 0; e < sweep->events.n; e++) {
    if (sweep->events.event[e].kind == EVENT_JUMP) continue;
    PetscCall(OnsetStart(sweep, e, &work[n++]));
    PetscCall(ProgressStep(&progress));
  }
  PetscCall(ProgressEnd(&progress));
  PetscCall(OnsetsConverge(sweep, n, work));
  for (PetscInt i = 0; i < n; i++) PetscCall(OnsetEnd(sweep, &work[i]));
  PetscCall(PetscFree(work));
  PetscCall(CorrectionDestroy(&sweep->greedy.correction));
  SweepSortOnsets(sweep);
  PetscFunctionReturn(0);
}
