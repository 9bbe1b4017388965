/*
   Branches and events along a line. From each point to the next the modes are matched (match.c); where a component of
   the match is not certain the interval is halved, and where two stable modes are predicted to be unstable between the
   points (interval.c) it is divided there, up to DEPTH times and with at most BUDGET solutions between two points. What
   is still ambiguous then (a mode that turns into another one within a thousandth of the step) is resolved by the
   greedy assignment of match.c.

   Events are the changes of stability of a branch between neighbouring points of this refined sequence. Where the
   contact status changes, eigenvalues jump: nothing is to be had in between, and a match that is not certain is none.
*/
#include "branch.h"
#include "base/events.h"

#define DEPTH  10
#define BUDGET 200
#define UNIQUE 0.5 /* strength of a match across a jump */

typedef struct {
  ModeSource    source;
  BranchList    branches;
  BranchEvents *events;
  PetscInt      solved; /* in the present interval of the line */
} Tracker;

/* Appends to events; a list begins as {0} */
static PetscErrorCode BranchEventsAdd(BranchEvents *events, const BranchEvent *event)
{
  PetscFunctionBeginUser;
  PetscCall(PetscRealloc((events->n + 1) * sizeof(*event), &events->event));
  events->event[events->n++] = *event;
  PetscFunctionReturn(0);
}

PetscErrorCode BranchEventsDestroy(BranchEvents *events)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(events->event));
  events->n = 0;
  PetscFunctionReturn(0);
}

/* The branch with which mode i of an unstable point interacts: its partner of the pair, with damping the nearest
   eigenvalue */
static PetscInt EventPartner(const ModeFrame *frame, PetscInt i)
{
  const PetscComplex lambda  = frame->modes.lambda[i];
  PetscInt           partner = ModeFramePartner(frame, i);
  PetscReal          nearest = 0.1 * cabs(lambda);

  for (PetscInt k = 0; k < frame->modes.n && frame->form.damped; k++) {
    const PetscReal distance = cabs(frame->modes.lambda[k] - lambda);

    if (k != i && distance <= nearest) partner = k, nearest = distance;
  }
  return partner < 0 ? -1 : frame->branch[partner];
}

/* Event between a and b of mode i, which is unstable at the frame, one of them */
static BranchEvent EventOf(const ModeFrame *frame, PetscInt i, const ModeFrame *a, const ModeFrame *b)
{
  return (BranchEvent){
    .lambda   = frame->modes.lambda[i],
    .omega    = cimag(frame->modes.lambda[i]),
    .lower    = PetscMin(a->value, b->value),
    .upper    = PetscMax(a->value, b->value),
    .critical = frame->value,
    .branch   = {frame->branch[i], EventPartner(frame, i)}
  };
}

/* Event of mode i of a, j of b, of which one is unstable */
static PetscErrorCode EventMake(const ModeFrame *a, PetscInt i, const ModeFrame *b, PetscInt j, BranchEvents *events)
{
  const PetscBool at_a = ReducedModeIsUnstable(&a->modes, i), begins = (PetscBool)(at_a == (a->value > b->value));
  BranchEvent     event = EventOf(at_a ? a : b, at_a ? i : j, a, b);

  PetscFunctionBeginUser;
  if (cimag(event.lambda) == 0)
    event.kind = begins ? EVENT_DIVERGENCE : EVENT_RESTABILISATION;
  else
    event.kind = begins ? EVENT_LOCK_IN : EVENT_LOCK_OUT;
  PetscCall(BranchEventsAdd(events, &event));
  PetscFunctionReturn(0);
}

/* Takes the step from a to b as it is */
static PetscErrorCode TrackerAdvance(Tracker *tracker, const ModeFrame *a, ModeFrame *b, Match *match)
{
  PetscFunctionBeginUser;
  PetscCall(BranchListContinue(&tracker->branches, a, b, match));
  for (PetscInt j = 0; j < b->modes.n; j++) {
    const PetscInt i = match->from[j];

    if (i >= 0 && ReducedModeIsUnstable(&a->modes, i) != ReducedModeIsUnstable(&b->modes, j))
      PetscCall(EventMake(a, i, b, j, tracker->events));
  }
  PetscFunctionReturn(0);
}

/* Whether to divide the step, and where */
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

/* From a, whose branches are known, to b */
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

/* Largest |lambda| of two points */
static PetscReal ModesScale(const ReducedModes *a, const ReducedModes *b)
{
  PetscReal largest = 0;

  for (PetscInt i = 0; i < a->n; i++) largest = PetscMax(largest, cabs(a->lambda[i]));
  for (PetscInt i = 0; i < b->n; i++) largest = PetscMax(largest, cabs(b->lambda[i]));
  return largest > 0 ? largest : 1;
}

/* The two points as frames, and their match; p = parameters at b */
static PetscErrorCode PointsMatch(const Reduced *reduced, const PetscReal p[], const BranchPoint *const point[2],
                                  ModeFrame *frame[2], Match *match)
{
  const StandardForm form = {.scale  = ModesScale(point[0]->modes, point[1]->modes),
                             .damped = ReducedIsDamped(reduced, p)};

  PetscFunctionBeginUser;
  for (int k = 0; k < 2; k++) {
    PetscCall(ModeFrameCreate(reduced, p, &form, PETSC_FALSE, point[k]->modes, &frame[k]));
    frame[k]->value = point[k]->value;
  }
  PetscCall(MatchCreate(frame[0], frame[1], NULL, match));
  PetscCall(MatchAssign(frame[0], frame[1], match->strength, NULL, match));
  PetscFunctionReturn(0);
}

PetscErrorCode TrackMatch(const Reduced *reduced, const PetscReal p[], const ReducedModes *a, const ReducedModes *b,
                          PetscInt from[], PetscBool *certain)
{
  const BranchPoint *const point[2] = {&(BranchPoint){.modes = a}, &(BranchPoint){.modes = b}};
  ModeFrame               *frame[2];
  Match                    match;

  PetscFunctionBeginUser;
  PetscCall(PointsMatch(reduced, p, point, frame, &match));
  PetscCall(PetscArraycpy(from, match.from, b->n));
  *certain = match.all_certain;
  PetscCall(MatchDestroy(&match));
  for (int k = 0; k < 2; k++) PetscCall(ModeFrameDestroy(&frame[k]));
  PetscFunctionReturn(0);
}

/* Ends the branches whose match is neither certain nor by more than half, which no second mode can have */
static void MatchDropDoubtful(Match *match)
{
  for (PetscInt j = 0; j < match->nb; j++) {
    const PetscInt i = match->from[j];

    if (i >= 0 && !match->certain[match->component_a[i]] && match->strength[i * match->nb + j] < UNIQUE)
      match->from[j] = -1;
  }
}

/* Event of mode i, which is unstable at this frame and not at the other */
static PetscErrorCode JumpMake(const ModeFrame *frame, PetscInt i, const ModeFrame *other, BranchEvents *events)
{
  BranchEvent event = EventOf(frame, i, frame, other);

  PetscFunctionBeginUser;
  event.kind     = EVENT_JUMP;
  event.found    = PETSC_TRUE;
  event.critical = 0.5 * (event.lower + event.upper);
  event.error    = 0.5 * (event.upper - event.lower);
  event.above    = frame->value > other->value ? PETSC_TRUE : PETSC_FALSE;
  PetscCall(BranchEventsAdd(events, &event));
  PetscFunctionReturn(0);
}

/* Events of the modes that are unstable on one side only */
static PetscErrorCode JumpsFind(const ModeFrame *a, const ModeFrame *b, const Match *match, BranchEvents *events)
{
  PetscBool *goes_on;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(a->modes.n, &goes_on));
  for (PetscInt j = 0; j < b->modes.n; j++) {
    const PetscInt i = match->from[j];

    if (!ReducedModeIsUnstable(&b->modes, j)) continue;
    if (i >= 0 && ReducedModeIsUnstable(&a->modes, i))
      goes_on[i] = PETSC_TRUE;
    else
      PetscCall(JumpMake(b, j, a, events));
  }
  for (PetscInt i = 0; i < a->modes.n; i++)
    if (ReducedModeIsUnstable(&a->modes, i) && !goes_on[i]) PetscCall(JumpMake(a, i, b, events));
  PetscCall(PetscFree(goes_on));
  PetscFunctionReturn(0);
}

PetscErrorCode TrackJump(const Reduced *reduced, const PetscReal p[], const BranchPoint *a, BranchPoint *b,
                         BranchEvents *events)
{
  const BranchPoint *const point[2] = {a, b};
  ModeFrame               *frame[2];
  Match                    match;

  PetscFunctionBeginUser;
  PetscCall(PointsMatch(reduced, p, point, frame, &match));
  MatchDropDoubtful(&match);
  for (PetscInt j = 0; j < b->modes->n; j++)
    if (match.from[j] >= 0) b->branch[j] = a->branch[match.from[j]];
  for (int k = 0; k < 2; k++) PetscCall(PetscArraycpy(frame[k]->branch, point[k]->branch, point[k]->modes->n));
  PetscCall(JumpsFind(frame[0], frame[1], &match, events));
  PetscCall(MatchDestroy(&match));
  for (int k = 0; k < 2; k++) PetscCall(ModeFrameDestroy(&frame[k]));
  PetscFunctionReturn(0);
}
