/*
   Branches and events along a line. From each point to the next the modes are matched (match.c); where a component of
   the match is not certain the interval is halved, and where two stable modes are predicted to be unstable between the
   points (interval.c) it is divided there, up to DEPTH times and with at most BUDGET solutions between two points. What
   is still ambiguous then (a mode that turns into another one within a thousandth of the step) is resolved by the
   greedy assignment of match.c.

   Events are the changes of stability of a branch between neighbouring points of this refined sequence.
*/
#include "branch.h"
#include "change.h"
#include "base/events.h"

/* Divisions of a step by halves: 2^-10, a thousandth of it, remains. */
#define DEPTH 10
/* Solutions between two points at most; a step that needs more goes through changes that a finer sweep should show. */
#define BUDGET 200

typedef struct {
  ModeSource    source;
  BranchList    branches;
  BranchEvents *events;
  PetscInt      solved; /* in the present interval of the line */
} Tracker;

/* Takes the step from a to b as it is */
static PetscErrorCode TrackerAdvance(Tracker *tracker, const ModeFrame *a, ModeFrame *b, Match *match)
{
  PetscFunctionBeginUser;
  PetscCall(BranchListContinue(&tracker->branches, a, b, match));
  for (PetscInt j = 0; j < b->modes.n; j++) {
    const PetscInt  i    = match->from[j];
    const PetscBool at_a = i >= 0 ? ModeFrameIsUnstable(a, i) : PETSC_FALSE;

    if (i < 0 || at_a == ModeFrameIsUnstable(b, j)) continue;
    if (at_a)
      PetscCall(ChangeAdd(a, i, b, tracker->events));
    else
      PetscCall(ChangeAdd(b, j, a, tracker->events));
  }
  PetscFunctionReturn(0);
}

/* Whether to divide the step, and where. A certain match is assigned for trial first, as the prediction needs
   partners. The resolution is the share of this step that DEPTH leaves. */
static PetscErrorCode TrackerDivides(const ModeFrame *a, const ModeFrame *b, PetscInt depth, Match *match,
                                     PetscReal *value, PetscBool *divides)
{
  PetscReal t = 0.5;

  PetscFunctionBeginUser;
  *divides = match->all_certain ? PETSC_FALSE : PETSC_TRUE;
  if (match->all_certain) {
    PetscCall(MatchAssign(a, b, match->strength, NULL, match));
    PetscCall(IntervalPredict(a, b, match, PetscPowRealInt(0.5, DEPTH - depth), &t, divides));
  }
  *value = a->value + t * (b->value - a->value);
  if (*value == a->value || *value == b->value) *divides = PETSC_FALSE;
  PetscFunctionReturn(0);
}

/* From a, whose branches are known, to b: by recursion, left part first, since branches are handed on in order.
   Depth and budget bound it. */
static PetscErrorCode TrackerStep(Tracker *tracker, const ModeFrame *a, ModeFrame *b, PetscInt depth)
{
  Match      match;
  ModeFrame *middle;
  PetscReal  value;
  PetscBool  divides = PETSC_FALSE;

  PetscFunctionBeginUser;
  PetscCall(MatchCreate(a, b, tracker->source.line->window, &match));
  if (depth < DEPTH && tracker->solved < BUDGET) PetscCall(TrackerDivides(a, b, depth, &match, &value, &divides));
  if (divides) {
    tracker->solved++;
    PetscCall(ModeSourceSolve(&tracker->source, value, &middle));
    PetscCall(TrackerStep(tracker, a, middle, depth + 1));
    PetscCall(TrackerStep(tracker, middle, b, depth + 1));
    PetscCall(ModeFrameDestroy(&middle));
  } else {
    PetscCall(TrackerAdvance(tracker, a, b, &match));
  }
  PetscCall(MatchDestroy(&match));
  PetscFunctionReturn(0);
}

/* Errors of the points between are needed when those of the points are known: stability depends on them */
static PetscBool HaveErrors(const ReducedModes modes[], PetscInt n)
{
  for (PetscInt k = 0; k < n; k++)
    for (PetscInt i = 0; i < modes[k].n; i++)
      if (modes[k].error[i] > 0) return PETSC_TRUE;
  return PETSC_FALSE;
}

PetscErrorCode TrackLine(const Reduced *reduced, const BranchLine *line, const ReducedModes modes[], PetscInt *branch[],
                         PetscInt *n_branches, BranchEvents *events)
{
  Tracker    tracker = {.branches = {.first = *n_branches}, .events = events};
  ModeFrame *frame   = NULL, *next;

  PetscFunctionBeginUser;
  if (!line->n) PetscFunctionReturn(0);
  PetscCall(EventBegin(EVENT_TRACK));
  PetscCall(ModeSourceCreate(reduced, line, &tracker.source));
  tracker.source.estimate = HaveErrors(modes, line->n);
  for (PetscInt k = 0; k < line->n; k++) {
    PetscCall(ModeSourceTake(&tracker.source, line->value[k], &modes[k], &next));
    tracker.solved = 0;
    if (k == 0)
      PetscCall(BranchListBegin(&tracker.branches, next));
    else
      PetscCall(TrackerStep(&tracker, frame, next, 0));
    PetscCall(PetscArraycpy(branch[k], next->branch, modes[k].n));
    PetscCall(ModeFrameDestroy(&frame));
    frame = next;
  }
  PetscCall(ModeFrameDestroy(&frame));
  *n_branches += tracker.branches.n;
  PetscCall(BranchListDestroy(&tracker.branches));
  PetscCall(PetscFree(tracker.source.p));
  PetscCall(EventEnd(EVENT_TRACK));
  PetscFunctionReturn(0);
}
