/*
   Steps between two points with nothing solved in between: across a change of contact status, from one line of a grid
   to the next, and between the points of a sweep in full. A match that is not certain is none, but for one by more than
   half across a change of status, which no point in between would make certain.

   Onsets of such a step lie where g of onset.c, known at both ends from the eigenvalues alone, is zero on the straight
   line between them: -d of a pair without damping, -kappa of one mode, the growth with damping. The error is the
   distance to the farther end, so that both ends are within it.
*/
#include "branch.h"
#include "change.h"

#define UNIQUE 0.5 /* strength that no second mode has as long as products are real */

/* Largest |lambda| of two points */
static PetscReal ModesScale(const ReducedModes *a, const ReducedModes *b)
{
  PetscReal largest = 0;

  for (PetscInt i = 0; i < a->n; i++) largest = PetscMax(largest, cabs(a->lambda[i]));
  for (PetscInt i = 0; i < b->n; i++) largest = PetscMax(largest, cabs(b->lambda[i]));
  return largest > 0 ? largest : 1;
}

/* The two points as frames, each in the pencil of its p, in one standard form, and what their modes have in common.
   No refinement: planes of full solutions are as good as they are. */
static PetscErrorCode PointsCompare(const Reduced *reduced, const PetscReal *const p[2],
                                    const BranchPoint *const point[2], const ReducedWindow *window, ModeFrame *frame[2],
                                    Match *match)
{
  const FrameUse use  = window ? FRAME_PENCIL : FRAME_PRODUCTS;
  StandardForm   form = {.scale = ModesScale(point[0]->modes, point[1]->modes)};

  PetscFunctionBeginUser;
  form.damped = ReducedIsDamped(reduced, p[0]) || ReducedIsDamped(reduced, p[1]) ? PETSC_TRUE : PETSC_FALSE;
  for (int k = 0; k < 2; k++) {
    PetscCall(ModeFrameCreate(reduced, p[k], &form, use, point[k]->modes, &frame[k]));
    frame[k]->value = point[k]->value;
  }
  PetscCall(MatchCreate(frame[0], frame[1], window, match));
  PetscFunctionReturn(0);
}

static PetscErrorCode PointsForget(ModeFrame *frame[2], Match *match)
{
  PetscFunctionBeginUser;
  PetscCall(MatchDestroy(match));
  for (int k = 0; k < 2; k++) PetscCall(ModeFrameDestroy(&frame[k]));
  PetscFunctionReturn(0);
}

PetscErrorCode TrackMatch(const Reduced *reduced, const PetscReal p[], const ReducedModes *a, const ReducedModes *b,
                          PetscInt from[], PetscBool *certain)
{
  const BranchPoint *const point[2] = {&(BranchPoint){.modes = a}, &(BranchPoint){.modes = b}};
  ModeFrame               *frame[2];
  Match                    match;

  PetscFunctionBeginUser;
  PetscCall(PointsCompare(reduced, (const PetscReal *[]){p, p}, point, NULL, frame, &match));
  PetscCall(MatchAssign(frame[0], frame[1], match.strength, NULL, &match));
  PetscCall(PetscArraycpy(from, match.from, b->n));
  *certain = match.all_certain;
  PetscCall(PointsForget(frame, &match));
  PetscFunctionReturn(0);
}

PetscErrorCode TrackSure(const Reduced *reduced, const PetscReal *const p[2], const ReducedModes *a,
                         const ReducedModes *b, PetscInt from[])
{
  const BranchPoint *const point[2] = {&(BranchPoint){.modes = a}, &(BranchPoint){.modes = b}};
  ModeFrame               *frame[2];
  Match                    match;

  PetscFunctionBeginUser;
  PetscCall(PointsCompare(reduced, p, point, NULL, frame, &match));
  match.least = UNIQUE;
  PetscCall(MatchAssign(frame[0], frame[1], match.strength, NULL, &match));
  PetscCall(PetscArraycpy(from, match.from, b->n));
  PetscCall(PointsForget(frame, &match));
  PetscFunctionReturn(0);
}

/* Events of the modes that are unstable on one side only; a mode of a that goes on unstable is told by goes_on. */
static PetscErrorCode JumpsFind(const ModeFrame *a, const ModeFrame *b, const Match *match, BranchEvents *events)
{
  PetscBool *goes_on;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(a->modes.n, &goes_on));
  for (PetscInt j = 0; j < b->modes.n; j++) {
    const PetscInt i = match->from[j];

    if (!ModeFrameIsUnstable(b, j)) continue;
    if (i >= 0 && ModeFrameIsUnstable(a, i))
      goes_on[i] = PETSC_TRUE;
    else
      PetscCall(ChangeAddJump(b, j, a, events));
  }
  for (PetscInt i = 0; i < a->modes.n; i++)
    if (ModeFrameIsUnstable(a, i) && !goes_on[i]) PetscCall(ChangeAddJump(a, i, b, events));
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
  PetscCall(PointsCompare(reduced, (const PetscReal *[]){p, p}, point, NULL, frame, &match));
  match.least = UNIQUE;
  PetscCall(MatchAssign(frame[0], frame[1], match.strength, NULL, &match));
  for (PetscInt j = 0; j < b->modes->n; j++)
    if (match.from[j] >= 0) b->branch[j] = a->branch[match.from[j]];
  for (int k = 0; k < 2; k++) PetscCall(PetscArraycpy(frame[k]->branch, point[k]->branch, point[k]->modes->n));
  PetscCall(JumpsFind(frame[0], frame[1], &match, events));
  PetscCall(PointsForget(frame, &match));
  PetscFunctionReturn(0);
}

/* g of onset.c at a point, of n modes that are a pair, or several, at the other one, times n for a pair, which does
   not move its zero; m = their mean omega^2, (rad/s)^2. L, rad/s, is the limit of growth. */
static PetscReal StepValue(const ModeFrame *f, PetscInt n, const PetscInt member[], PetscReal *m)
{
  const PetscComplex *lambda = f->modes.lambda;
  const PetscReal     L      = ModesLimitGrowth(&f->limit, cabs(lambda[member[0]]));
  PetscComplex        mean = 0, square = 0;

  *m = PetscSqr(cimag(lambda[member[0]]));
  if (f->form.damped) return creal(lambda[member[0]]) - L;
  for (PetscInt k = 0; k < n; k++) mean += StandardValue(&f->form, lambda[member[k]]) / n;
  for (PetscInt k = 0; k < n; k++) square += cpow(StandardValue(&f->form, lambda[member[k]]) - mean, 2);
  *m = creal(mean);
  return n > 1 ? -creal(square) - n * 4 * L * L * (*m + L * L) : -*m - PetscSqr(f->limit.growth);
}

/* Where the event of mode i, unstable at u and not at s, lies: the zero of g on the straight line, t = g_u / (g_u -
   g_s) from u, or half way where to [modes of u], the modes of s, does not tell the ends (NULL: none). */
static PetscErrorCode StepPlace(const ModeFrame *u, const ModeFrame *s, PetscInt i, const PetscInt to[],
                                BranchEvent *event)
{
  PetscInt *member, *partner, n = 0;
  PetscReal t = 0.5, g[2] = {0}, m[2] = {0};
  PetscBool told = to ? PETSC_TRUE : PETSC_FALSE;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(u->modes.n, &member, u->modes.n, &partner));
  for (PetscInt k = 0; k < u->modes.n && told; k++) {
    if (k != i && (u->form.damped || u->cluster[k] != u->cluster[i])) continue;
    if (to[k] < 0) told = PETSC_FALSE;
    member[n]    = k;
    partner[n++] = to[k];
  }
  if (told) g[0] = StepValue(u, n, member, &m[0]);
  if (told) g[1] = StepValue(s, n, partner, &m[1]);
  if (g[0] > 0) t = g[0] / (g[0] - PetscMin(g[1], 0)); /* growth at s is within its error */
  event->found    = PETSC_TRUE;
  event->critical = u->value + t * (s->value - u->value);
  event->error    = PetscMax(event->critical - event->lower, event->upper - event->critical);
  if (told && event->omega > 0) event->omega = PetscSqrtReal(PetscMax(m[0] + t * (m[1] - m[0]), 0));
  PetscCall(PetscFree2(member, partner));
  PetscFunctionReturn(0);
}

/* Whether no mode of a component is unstable, of which there are some */
static PetscBool ComponentIsStable(const ModeFrame *f, const PetscInt component[], PetscInt c)
{
  PetscInt n = 0;

  for (PetscInt i = 0; i < f->modes.n; i++) {
    if (component[i] == c && ModeFrameIsUnstable(f, i)) return PETSC_FALSE;
    n += component[i] == c;
  }
  return n > 0 ? PETSC_TRUE : PETSC_FALSE;
}

/* Onsets seen from u, some of whose modes are unstable while what they come from at s is not: along a branch, to [modes
   of u] = mode of s, and of modes that only together are those of the other point, half way */
static PetscErrorCode StepOnsets(const ModeFrame *u, const PetscInt component[], const ModeFrame *s,
                                 const PetscInt component_s[], const PetscInt to[], BranchEvents *events)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < u->modes.n; i++) {
    PetscInt j = to[i];

    if (!ModeFrameIsUnstable(u, i) || (j >= 0 && ModeFrameIsUnstable(s, j))) continue;
    if (j < 0 && !ComponentIsStable(s, component_s, component[i])) continue;
    PetscCall(ChangeAdd(u, i, s, events));
    PetscCall(StepPlace(u, s, i, j < 0 ? NULL : to, &events->event[events->n - 1]));
  }
  PetscFunctionReturn(0);
}

/* Modes of b, or -1, of those of a */
static PetscErrorCode MatchInvert(const Match *match, PetscInt **to)
{
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(match->na, to));
  for (PetscInt i = 0; i < match->na; i++) (*to)[i] = -1;
  for (PetscInt j = 0; j < match->nb; j++)
    if (match->from[j] >= 0) (*to)[match->from[j]] = j;
  PetscFunctionReturn(0);
}

/* Events of the step, and how many branches end in it though their modes have not left the window */
static PetscErrorCode StepEvents(const ModeFrame *a, const ModeFrame *b, const Match *match, PointStep *step,
                                 BranchEvents *events)
{
  PetscInt *to;

  PetscFunctionBeginUser;
  if (step->kind == STEP_JUMP) PetscCall(JumpsFind(a, b, match, events));
  if (step->kind != STEP_SMOOTH) PetscFunctionReturn(0);
  PetscCall(MatchInvert(match, &to));
  PetscCall(StepOnsets(a, match->component_a, b, match->component_b, to, events));
  PetscCall(StepOnsets(b, match->component_b, a, match->component_a, match->from, events));
  for (PetscInt i = 0; i < a->modes.n; i++) step->n_broken += to[i] < 0 && !match->certain[match->component_a[i]];
  PetscCall(PetscFree(to));
  PetscFunctionReturn(0);
}

PetscErrorCode TrackStep(const Reduced *reduced, PointStep *step, BranchEvents *events)
{
  const BranchPoint *const   point[2] = {&step->a, &step->b};
  const ReducedWindow *const window   = step->kind == STEP_SMOOTH ? step->window : NULL;
  BranchList                 list;
  ModeFrame                 *frame[2];
  Match                      match;

  PetscFunctionBeginUser;
  PetscCall(PointsCompare(reduced, step->p, point, window, frame, &match));
  match.least = step->kind == STEP_JUMP ? UNIQUE : PETSC_MAX_REAL; /* else what is not certain is none */
  PetscCall(PetscArraycpy(frame[0]->branch, step->a.branch, step->a.modes->n));
  PetscCall(BranchListResume(&list, step->n_branches, frame[0], step->before));
  PetscCall(BranchListContinue(&list, frame[0], frame[1], &match));
  PetscCall(PetscArraycpy(step->b.branch, frame[1]->branch, step->b.modes->n));
  PetscCall(StepEvents(frame[0], frame[1], &match, step, events));
  PetscCall(BranchListSave(&list, frame[1], step->after));
  step->n_branches = list.n;
  PetscCall(BranchListDestroy(&list));
  PetscCall(PointsForget(frame, &match));
  PetscFunctionReturn(0);
}
