/*
   A chain: a line of the map in one direction, point after point, each from the end of the one before, until its regime is known
   (map.h), or a point alone. Runs on one rank, without messages. What a point begins with besides the state is made anew.
*/
#include "mapimpl.h"

#define MARCH_TINY     1e-9 /* of the mean force: a vibration that is rounding */
#define MARCH_SMALL    0.01 /* of the mean force: a vibration that is small */
#define MARCH_STICKING 0.01 /* share of the time */
#define MARCH_TREND    1.5  /* of the rms, from a quarter of the windows to the next: growth */

/* Bodies, and work */
struct _p_MapMarch {
  Map            map;
  PetscReal      dt; /* s */
  MapBodies     *bodies;
  ReducedStepper stepper;
  ReducedState   state, rest; /* the motion; the sliding state of the point */
  ReducedReport  report;
  PetscReal     *sliding, *loads, *kick; /* [n_pairs] m, [n_loads], [m] */
  PetscInt       n, n_windows, n_most;   /* steps of a window; windows of the point, at most */
  PetscReal      contact, friction, given; /* works in the point; of impulses, with the energy that it began with, J */
  PetscReal     *slip;                   /* [n_most n] mean slip speed along t, m/s */
  PetscReal     *force;                  /* [n_most n] N */
  ContactStatus *status;                 /* [n_pairs] at the beginning of the window */
  PetscBool     *closed, *known;         /* [n_pairs]; those of which `growth` is */
  PetscReal      growth;
  PetscReal     *lambda_n, *sigma, *omega; /* [n_pairs] N, [2 m] */
  MapSample     *sample;                   /* [n_most] */
};

PetscErrorCode MapMarchCreate(Map map, MapBodies *bodies, PetscReal dt, PetscReal rtol, MapMarch *march)
{
  const ReducedModel *model = &bodies->model;
  MapMarch            w;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(march));
  w         = *march;
  w->map    = map;
  w->bodies = bodies;
  w->dt     = dt;
  MapCountWindows(map, dt, &w->n, &w->n_most);
  PetscCall(ReducedStateCreate(model, &w->state));
  PetscCall(ReducedStateCreate(model, &w->rest));
  PetscCall(ReducedReportCreate(model, &w->report));
  w->report.works = PETSC_FALSE;
  PetscCall(ReducedStepperCreate(model, dt, rtol, &w->stepper));
  PetscCall(PetscCalloc6(model->n_pairs, &w->sliding, model->n_loads, &w->loads, model->m, &w->kick, w->n_most * w->n,
                         &w->slip, w->n_most * w->n, &w->force, w->n_most, &w->sample));
  PetscCall(PetscCalloc6(model->n_pairs, &w->status, model->n_pairs, &w->closed, model->n_pairs, &w->known,
                         model->n_pairs, &w->lambda_n, 2 * model->m, &w->sigma, 2 * model->m, &w->omega));
  PetscFunctionReturn(0);
}

PetscErrorCode MapMarchDestroy(MapMarch *march)
{
  MapMarch w = *march;

  PetscFunctionBeginUser;
  if (!w) PetscFunctionReturn(0);
  PetscCall(ReducedStepperDestroy(&w->stepper));
  PetscCall(ReducedStateDestroy(&w->state));
  PetscCall(ReducedStateDestroy(&w->rest));
  PetscCall(ReducedReportDestroy(&w->report));
  PetscCall(PetscFree6(w->sliding, w->loads, w->kick, w->slip, w->force, w->sample));
  PetscCall(PetscFree6(w->status, w->closed, w->known, w->lambda_n, w->sigma, w->omega));
  PetscCall(PetscFree(*march));
  PetscFunctionReturn(0);
}

/* Eigenvalues about sliding with the pairs of `status` closed */
static PetscErrorCode MarchLinearise(MapMarch w, const ContactStatus status[], MapFastest *fastest)
{
  const ReducedModel *model = &w->bodies->model;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < model->n_pairs; i++) {
    w->closed[i]   = status[i] != CONTACT_OPEN ? PETSC_TRUE : PETSC_FALSE;
    w->lambda_n[i] = w->rest.p[3 * i];
  }
  PetscCall(ReducedLineariseSliding(model, w->closed, w->lambda_n, w->sigma, w->omega));
  MapModesJudge(2 * model->m, w->sigma, w->omega, fastest);
  w->growth = fastest->growth;
  PetscCall(PetscArraycpy(w->known, w->closed, model->n_pairs));
  PetscFunctionReturn(0);
}

/* Growth of the fastest mode about the sliding state with the inertia of what the modes leave out; after MarchLinearise() there */
static PetscErrorCode MarchWeigh(MapMarch w, MapPoint *row)
{
  MapFastest fastest;

  PetscFunctionBeginUser;
  PetscCall(ReducedLineariseInertia(&w->bodies->model, w->closed, w->lambda_n, w->sigma, w->omega));
  MapModesJudge(2 * w->bodies->model.m, w->sigma, w->omega, &fastest);
  row->whole = fastest.growth;
  PetscFunctionReturn(0);
}

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

/* The steps of the next window, and what its forces are like */
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

    if (kick) now->changed = PETSC_TRUE;
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

/* Whether `growth` is that of the pairs that are closed now, all of which slip */
static PetscBool MarchIsKnown(const MapMarch w)
{
  for (PetscInt i = 0; i < w->bodies->model.n_pairs; i++)
    if (w->state.status[i] != (w->known[i] ? CONTACT_SLIP : CONTACT_OPEN)) return PETSC_FALSE;
  return PETSC_TRUE;
}

/* Whether the last motion dies out: no mode of the sliding state, or with the pairs that are closed now, grows, and the rms falls
   from window to window: two of them in which no pair changed its status, or four of a small vibration */
static PetscErrorCode MarchDiesOut(MapMarch w, PetscBool *dies)
{
  const MapSample *s    = &w->sample[w->n_windows - 1];
  const PetscBool  tiny = s->rms <= MARCH_TINY * s->mean, small = s->rms <= MARCH_SMALL * s->mean;
  const PetscInt   n = s->changed ? 4 : 2;
  MapFastest       fastest;

  PetscFunctionBeginUser;
  *dies = PETSC_FALSE;
  if (w->n_windows < n || (s->changed && !small)) PetscFunctionReturn(0);
  for (PetscInt k = 1; k < n && !tiny; k++)
    if (s[1 - k].rms >= s[-k].rms) PetscFunctionReturn(0);
  if (!MarchIsKnown(w) && !s->changed) PetscCall(MarchLinearise(w, w->state.status, &fastest));
  *dies = w->growth < 0 ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(0);
}

/* What a transient that did not settle is. It grows where the rms of the last quarter of the windows is that much beyond the one
   before, or, where a mode grows, where it rises in each window of the last half, or where no pair changed its status there, so
   that the motion is linear */
static MapRegime MarchTrend(const MapMarch w)
{
  const PetscInt   n      = w->n_windows;
  const MapSample *s      = w->sample;
  PetscBool        linear = MarchIsKnown(w), rises = PETSC_TRUE;
  PetscReal        error;
  const PetscReal  ratio =
    MapForceLevel(n / 4, &s[n - n / 4], &error) / MapForceLevel(n / 4, &s[n - 2 * (n / 4)], &error);

  for (PetscInt k = n - n / 2; k < n; k++) {
    if (s[k].changed) linear = PETSC_FALSE;
    if (s[k].rms <= (1 + w->map->rtol) * s[k - 1].rms) rises = PETSC_FALSE;
  }
  if (linear && w->growth < 0) return MAP_STABLE;
  if (ratio >= MARCH_TREND || (w->growth > 0 && (linear || rises))) return MAP_GROWTH;
  if (ratio <= 1 / MARCH_TREND && w->growth < 0) return MAP_STABLE;
  return MAP_CYCLE;
}

/* Means over windows first .. */
static void MarchAverage(MapMarch w, PetscInt first, MapPoint *row)
{
  const PetscReal n = (PetscReal)(w->n_windows - first);

  for (PetscInt k = first; k < w->n_windows; k++) {
    const MapSample *s = &w->sample[k];

    row->mean += s->mean / n;
    row->open += s->open / n;
    row->stick += s->stick / n;
    row->peak = k == first ? s->peak : PetscMax(row->peak, s->peak);
  }
}

/* The regime of a transient that has ended, and its numbers: of the windows that agree, or the last half of all */
static void MarchJudge(MapMarch w, MapPoint *row)
{
  const PetscInt  n = w->n, last = w->n_windows;
  const PetscInt  first = row->end == MAP_DECAYS    ? last - 1
                          : row->end == MAP_SETTLED ? last - MAP_SETTLED_WINDOWS
                                                    : last / 2;
  const PetscInt  half  = (last - first) / 2;
  const PetscReal dt = w->dt, change = row->error;

  MarchAverage(w, first, row);
  row->rms    = MapForceLevel(last - first, &w->sample[first], &row->error);
  row->time   = w->state.time;
  row->regime = row->end == MAP_DECAYS ? MAP_STABLE : row->end == MAP_TIME ? MarchTrend(w) : MAP_CYCLE;
  if (row->end == MAP_DECAYS) row->error = NAN;
  if (row->end == MAP_SETTLED) row->error = change;
  if (row->regime == MAP_CYCLE && row->stick > MARCH_STICKING) row->regime = MAP_STICKING;
  row->freq = row->freq_error = NAN;
  if (row->regime == MAP_STABLE) return;
  row->freq = MapForceLine(last - first, n, &w->slip[n * first], dt);
  if (half)
    row->freq_error = PetscAbsReal(MapForceLine(half, n, &w->slip[n * first], dt) -
                                   MapForceLine(half, n, &w->slip[n * (last - half)], dt));
}

/* Windows until the regime is known, after the last impulse, or the time is over */
static PetscErrorCode MarchRun(MapMarch w, MapPoint *row)
{
  PetscBool dies;

  PetscFunctionBeginUser;
  for (w->n_windows = 0; w->n_windows < w->n_most;) {
    PetscCall(MarchWindow(w, row));
    PetscCall(MarchDiesOut(w, &dies));
    row->end = !MapBodiesAreHit(w->bodies, w->state.time - w->dt)                 ? MAP_TIME
               : dies                                                             ? MAP_DECAYS
               : MapIsSettled(w->n_windows, w->sample, w->map->rtol, &row->error) ? MAP_SETTLED
               : MapIsSteady(w->n_windows, w->sample, w->map->rtol, &row->error)  ? MAP_STEADY
                                                                                  : MAP_TIME;
    if (row->end != MAP_TIME) break;
  }
  MarchJudge(w, row);
  PetscFunctionReturn(0);
}

/* The sliding state of a point, its eigenvalues, and where the point begins: there, or where the one before ended */
static PetscErrorCode MarchBegin(MapMarch w, PetscBool go_on, MapPoint *row, PetscBool *begun)
{
  const ReducedModel *model   = &w->bodies->model;
  MapFastest          fastest = {NAN, NAN, NAN};
  PetscBool           found;
  PetscReal           kinetic;

  PetscFunctionBeginUser;
  PetscCall(MapBodiesMove(w->map, row, w->bodies, w->sliding, w->loads));
  for (PetscInt i = 0; i < model->n_pairs; i++) w->sliding[i] *= w->dt;
  PetscCall(ReducedStepperTakeFriction(w->stepper));
  PetscCall(ReducedEquilibrium(model, w->loads, &w->rest, &found));
  w->growth = NAN;
  if (found) PetscCall(MarchLinearise(w, w->rest.status, &fastest));
  if (found) MapModesTake(2 * model->m, w->sigma, w->omega, row);
  if (found && model->Mx) PetscCall(MarchWeigh(w, row));
  if (found && !go_on) PetscCall(ReducedStateCopy(model, &w->rest, &w->state));
  row->growth    = fastest.growth;
  row->mode_freq = fastest.freq;
  row->index     = fastest.index;
  w->state.time  = 0;
  w->contact = w->friction = 0;
  ReducedEnergy(model, &w->state, &kinetic, &w->given);
  w->given += kinetic;
  *begun         = found || go_on ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(0);
}

/* A point; false where it failed, of which no other rank knows: laws without solution, or a motion beyond numbers */
static PetscErrorCode MarchPoint(MapMarch w, PetscBool go_on, MapPoint *row, PetscBool *good)
{
  PetscErrorCode error = 0;
  PetscBool      begun;

  PetscFunctionBeginUser;
  PetscCall(MarchBegin(w, go_on, row, &begun));
  if (begun) {
    PetscCall(PetscPushErrorHandler(PetscReturnErrorHandler, NULL));
    error = MarchRun(w, row);
    PetscCall(PetscPopErrorHandler());
  }
  PetscCheck(!error || error == PETSC_ERR_NOT_CONVERGED || error == PETSC_ERR_FP, PETSC_COMM_SELF, error,
             "a transient of the map ended by PETSc's error %d", (int)error);
  *good = begun && !error ? PETSC_TRUE : PETSC_FALSE;
  if (!*good) row->regime = MAP_UNKNOWN, row->end = MAP_FAILED;
  row->fault = !begun                ? MAP_NO_STATE
               : MarchIsMade(w)        ? MAP_MADE
               : error == PETSC_ERR_FP ? MAP_NO_NUMBER
                                       : MAP_NO_FORCES;
  PetscFunctionReturn(0);
}

void MapChainPlace(Map map, PetscInt chain, PetscInt k, MapPoint *row)
{
  const PetscInt way = chain % map->n_ways, down = map->direction == MAP_BOTH ? way : map->direction == MAP_DOWN;
  const PetscInt place = map->direction == MAP_APART ? way : down ? map->n_linked - 1 - k : k;

  *row = (MapPoint){.line = chain / map->n_ways, .place = place, .down = down};
}

PetscErrorCode MapChain(MapMarch w, PetscInt chain, MapPoint row[])
{
  Map       map  = w->map;
  PetscBool good = PETSC_FALSE;
  PetscInt  first;
  MapKept   kept = {&w->bodies->model, &w->state, 0};

  PetscFunctionBeginUser;
  PetscCall(MapResumeChain(map, chain, &first, row, &kept));
  if (first) good = row[first - 1].end != MAP_FAILED ? PETSC_TRUE : PETSC_FALSE;
  for (PetscInt k = first; k < map->n_linked; k++) {
    MapChainPlace(map, chain, k, &row[k]);
    PetscCall(MarchPoint(w, good, &row[k], &good));
    PetscCall(MapKeepChain(map, chain, k + 1, row, &kept));
    PetscCall(ProgressStep(&map->progress));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode MapMarchAlone(MapMarch w, MapPoint *row)
{
  PetscBool good;

  PetscFunctionBeginUser;
  PetscCall(MarchPoint(w, PETSC_FALSE, row, &good));
  PetscFunctionReturn(0);
}
