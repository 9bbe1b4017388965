/*
   A line of the map in one direction: point after point, each from the end of the one before, until its regime is known (map.h).
   Runs on one rank, without messages. What a point begins with besides the state is made anew, so that it is the same
   whichever points were before it in this process.
*/
#include "mapimpl.h"

#define MARCH_RTOL     1e-12 /* of the contact laws */
#define MARCH_TINY     1e-9  /* of the mean force: a vibration that is rounding */
#define MARCH_SMALL    0.01  /* of the mean force: a vibration that is small */
#define MARCH_STICKING 0.01  /* share of the time */
#define MARCH_SETTLED  3     /* windows that agree */
#define MARCH_TREND    1.5   /* of the rms, from a quarter of the windows to the next: growth */

/* Work of a chain */
typedef struct {
  Map            map;
  MapBodies     *bodies;
  ReducedStepper stepper;
  ReducedState   state, rest; /* the motion; the sliding state of the point */
  ReducedReport  report;
  PetscReal     *sliding, *loads, *kick; /* [n_pairs] m, [n_loads], [m] */
  PetscInt       n, n_windows, n_most;   /* steps of a window; windows of the point, at most */
  PetscReal     *slip;                   /* [n_most n] mean slip speed along t, m/s */
  PetscReal     *force;                  /* [n_most n] N */
  ContactStatus *status;                 /* [n_pairs] at the beginning of the window */
  PetscBool     *closed, *known;         /* [n_pairs]; those of which `growth` is */
  PetscReal      growth;
  PetscReal     *lambda_n, *sigma, *omega; /* [n_pairs] N, [2 m] */
  MapSample     *sample;                   /* [n_most] */
} MarchWork;

static PetscErrorCode MarchWorkCreate(Map map, MapBodies *bodies, MarchWork *w)
{
  const ReducedModel *model = &bodies->model;

  PetscFunctionBeginUser;
  *w        = (MarchWork){.map = map, .bodies = bodies};
  w->n      = (PetscInt)(map->window / map->dt + 0.5);
  w->n_most = (PetscInt)(map->end / ((PetscReal)w->n * map->dt) + 1e-9);
  PetscCall(ReducedStateCreate(model, &w->state));
  PetscCall(ReducedStateCreate(model, &w->rest));
  PetscCall(ReducedReportCreate(model, &w->report));
  PetscCall(ReducedStepperCreate(model, map->dt, MARCH_RTOL, &w->stepper));
  PetscCall(PetscCalloc6(model->n_pairs, &w->sliding, model->n_loads, &w->loads, model->m, &w->kick, w->n_most * w->n,
                         &w->slip, w->n_most * w->n, &w->force, w->n_most, &w->sample));
  PetscCall(PetscCalloc6(model->n_pairs, &w->status, model->n_pairs, &w->closed, model->n_pairs, &w->known,
                         model->n_pairs, &w->lambda_n, 2 * model->m, &w->sigma, 2 * model->m, &w->omega));
  PetscFunctionReturn(0);
}

static PetscErrorCode MarchWorkDestroy(MarchWork *w)
{
  PetscFunctionBeginUser;
  PetscCall(ReducedStepperDestroy(&w->stepper));
  PetscCall(ReducedStateDestroy(&w->state));
  PetscCall(ReducedStateDestroy(&w->rest));
  PetscCall(ReducedReportDestroy(&w->report));
  PetscCall(PetscFree6(w->sliding, w->loads, w->kick, w->slip, w->force, w->sample));
  PetscCall(PetscFree6(w->status, w->closed, w->known, w->lambda_n, w->sigma, w->omega));
  PetscFunctionReturn(0);
}

/* Eigenvalues about sliding with the pairs of `status` closed: growth and frequency of the fastest mode, and the largest growth
   over angular frequency */
static PetscErrorCode MarchLinearise(MarchWork *w, const ContactStatus status[], PetscReal *growth, PetscReal *freq,
                                     PetscReal *index)
{
  const ReducedModel *model = &w->bodies->model;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < model->n_pairs; i++) {
    w->closed[i]   = status[i] != CONTACT_OPEN ? PETSC_TRUE : PETSC_FALSE;
    w->lambda_n[i] = w->rest.p[3 * i];
  }
  PetscCall(ReducedLineariseSliding(model, w->closed, w->lambda_n, w->sigma, w->omega));
  *growth = *index = -PETSC_INFINITY;
  *freq            = 0;
  for (PetscInt k = 0; k < 2 * model->m; k++) {
    const PetscReal size = hypot(w->sigma[k], w->omega[k]);

    if (!(w->omega[k] > 0)) continue;
    *index = PetscMax(*index, w->sigma[k] / size);
    if (w->sigma[k] <= *growth) continue;
    *growth = w->sigma[k];
    *freq   = w->omega[k] / (2 * PETSC_PI);
  }
  PetscFunctionReturn(0);
}

/* Sum of the impulses that act at t_n, or NULL: one between two steps acts at both in shares, as in any reduced run */
static const PetscReal *MarchKick(MarchWork *w)
{
  const MapBodies *b   = w->bodies;
  const PetscInt   m   = b->model.m;
  PetscBool        any = PETSC_FALSE;

  for (PetscInt i = 0; i < b->n_hits; i++) {
    const PetscReal share = 1 - PetscAbsReal(b->hits[m * b->n_hits + i] - w->state.time) / w->map->dt;

    if (!(share > 0)) continue;
    for (PetscInt k = 0; k < m; k++) w->kick[k] = (any ? w->kick[k] : 0) + share * b->hits[m * i + k];
    any = PETSC_TRUE;
  }
  return any ? w->kick : NULL;
}

/* Statuses at t_{n+1}: whether they are those at the beginning of the window, and whether all closed pairs stick */
static void MarchLook(MarchWork *w, MapSample *sample)
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

/* The steps of the next window, and what its forces are like */
static PetscErrorCode MarchWindow(MarchWork *w, MapPoint *row)
{
  const PetscInt n_pairs = w->bodies->model.n_pairs;
  PetscReal     *force   = &w->force[w->n * w->n_windows];
  PetscReal     *slip    = &w->slip[w->n * w->n_windows];
  MapSample     *now     = &w->sample[w->n_windows];

  PetscFunctionBeginUser;
  *now = (MapSample){0};
  PetscCall(PetscArraycpy(w->status, w->state.status, n_pairs));
  for (PetscInt k = 0; k < w->n; k++) {
    const PetscReal *kick = MarchKick(w);

    if (kick) now->changed = PETSC_TRUE;
    PetscCall(ReducedStep(w->stepper, &(ReducedDrive){w->loads, w->sliding, kick}, &w->state, &w->report));
    force[k] = slip[k] = 0;
    for (PetscInt i = 0; i < n_pairs; i++) {
      force[k] += w->state.p[3 * i];
      slip[k] += w->report.slip[2 * i] / (w->map->dt * (PetscReal)n_pairs);
    }
    MarchLook(w, now);
    row->steps++;
  }
  MapForceMeasure(w->n, force, now);
  w->n_windows++;
  PetscFunctionReturn(0);
}

/* Whether `growth` is that of the pairs that are closed now, all of which slip */
static PetscBool MarchIsKnown(const MarchWork *w)
{
  for (PetscInt i = 0; i < w->bodies->model.n_pairs; i++)
    if (w->state.status[i] != (w->known[i] ? CONTACT_SLIP : CONTACT_OPEN)) return PETSC_FALSE;
  return PETSC_TRUE;
}

/* Whether the last motion dies out: no mode of the sliding state, or with the pairs that are closed now, grows, and the rms falls
   from window to window: two of them in which no pair changed its status, or four of a small vibration */
static PetscErrorCode MarchDiesOut(MarchWork *w, PetscBool *dies)
{
  const MapSample *s    = &w->sample[w->n_windows - 1];
  const PetscBool  tiny = s->rms <= MARCH_TINY * s->mean, small = s->rms <= MARCH_SMALL * s->mean;
  const PetscInt   n = s->changed ? 4 : 2;
  PetscReal        freq, index;

  PetscFunctionBeginUser;
  *dies = PETSC_FALSE;
  if (w->n_windows < n || (s->changed && !small)) PetscFunctionReturn(0);
  for (PetscInt k = 1; k < n && !tiny; k++)
    if (s[1 - k].rms >= s[-k].rms) PetscFunctionReturn(0);
  if (!MarchIsKnown(w) && !s->changed) {
    PetscCall(MarchLinearise(w, w->state.status, &w->growth, &freq, &index));
    PetscCall(PetscArraycpy(w->known, w->closed, w->bodies->model.n_pairs));
  }
  *dies = w->growth < 0 ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(0);
}

/* Whether the rms of the last windows agrees in a vibration in which pairs change their status; the largest relative difference */
static PetscBool MarchIsSettled(const MarchWork *w, PetscReal *change)
{
  const MapSample *s = &w->sample[w->n_windows - 1];

  *change = 0;
  if (w->n_windows < MARCH_SETTLED) return PETSC_FALSE;
  for (PetscInt k = 1; k < MARCH_SETTLED; k++) {
    if (!s[-k].changed || !s->changed || !(s->rms > 0)) return PETSC_FALSE;
    *change = PetscMax(*change, PetscAbsReal(s[-k].rms / s->rms - 1));
  }
  return *change <= w->map->rtol ? PETSC_TRUE : PETSC_FALSE;
}

/* What a transient that did not settle is. It grows where the rms of the last quarter of the windows is that much beyond the one
   before, or, where a mode grows, where it rises in each window of the last half, or where no pair changed its status there, so
   that the motion is linear */
static MapRegime MarchTrend(const MarchWork *w)
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
static void MarchAverage(MarchWork *w, PetscInt first, MapPoint *row)
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
static void MarchJudge(MarchWork *w, MapPoint *row)
{
  const PetscInt  n = w->n, last = w->n_windows;
  const PetscInt  first = row->end == MAP_DECAYS ? last - 1 : row->end == MAP_SETTLED ? last - MARCH_SETTLED : last / 2;
  const PetscInt  half  = (last - first) / 2;
  const PetscReal dt = w->map->dt, change = row->error;

  MarchAverage(w, first, row);
  row->rms    = MapForceLevel(last - first, &w->sample[first], &row->error);
  row->time   = w->state.time;
  row->regime = row->end == MAP_DECAYS ? MAP_STABLE : row->end == MAP_SETTLED ? MAP_CYCLE : MarchTrend(w);
  if (row->end == MAP_DECAYS) row->error = NAN;
  if (row->end == MAP_SETTLED) row->error = change;
  if (row->regime == MAP_CYCLE && row->stick > MARCH_STICKING) row->regime = MAP_STICKING;
  if (row->regime == MAP_STABLE) return;
  row->freq       = MapForceLine(last - first, n, &w->slip[n * first], dt);
  row->freq_error = half ? PetscAbsReal(MapForceLine(half, n, &w->slip[n * first], dt) -
                                        MapForceLine(half, n, &w->slip[n * (last - half)], dt))
                         : 0;
}

/* Windows until the regime is known or the time is over */
static PetscErrorCode MarchRun(MarchWork *w, MapPoint *row)
{
  PetscBool dies;

  PetscFunctionBeginUser;
  for (w->n_windows = 0; w->n_windows < w->n_most;) {
    PetscCall(MarchWindow(w, row));
    PetscCall(MarchDiesOut(w, &dies));
    row->end = dies ? MAP_DECAYS : MarchIsSettled(w, &row->error) ? MAP_SETTLED : MAP_TIME;
    if (row->end != MAP_TIME) break;
  }
  MarchJudge(w, row);
  PetscFunctionReturn(0);
}

/* The modes of the last linearisation that grow */
static void MarchTakeModes(MarchWork *w, MapPoint *row)
{
  for (PetscInt k = 0; k < 2 * w->bodies->model.m && row->n_modes < MAP_MAX_MODES; k++) {
    if (!(w->omega[k] > 0) || !(w->sigma[k] > 0)) continue;
    row->sigma[row->n_modes]   = w->sigma[k];
    row->omega[row->n_modes++] = w->omega[k];
  }
}

/* The sliding state of a point, its eigenvalues, and where the point begins: there, or where the one before ended */
static PetscErrorCode MarchBegin(MarchWork *w, PetscBool go_on, MapPoint *row, PetscBool *begun)
{
  const ReducedModel *model = &w->bodies->model;
  PetscBool           found;

  PetscFunctionBeginUser;
  PetscCall(MapBodiesMove(w->map, row, w->bodies, w->sliding, w->loads));
  PetscCall(ReducedStepperTakeFriction(w->stepper));
  PetscCall(ReducedEquilibrium(model, w->loads, &w->rest, &found));
  row->growth = row->mode_freq = row->index = NAN;
  if (found) PetscCall(MarchLinearise(w, w->rest.status, &row->growth, &row->mode_freq, &row->index));
  if (found) MarchTakeModes(w, row);
  if (found) PetscCall(PetscArraycpy(w->known, w->closed, model->n_pairs));
  if (found && !go_on) PetscCall(ReducedStateCopy(model, &w->rest, &w->state));
  w->growth     = row->growth;
  w->state.time = 0;
  *begun        = found || go_on ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(0);
}

/* A point; false where it failed, of which no other rank knows: laws without solution, or a motion beyond all numbers */
static PetscErrorCode MarchPoint(MarchWork *w, PetscBool go_on, MapPoint *row, PetscBool *good)
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
  if (!*good) row->regime = MAP_UNKNOWN;
  if (!*good) row->end = MAP_FAILED;
  PetscFunctionReturn(0);
}

PetscErrorCode MapChain(Map map, MapBodies *bodies, PetscInt chain, MapPoint row[])
{
  const PetscInt n = map->axis[0].n, n_ways = map->direction == MAP_BOTH ? 2 : 1;
  PetscInt       first;
  PetscBool      good = PETSC_FALSE;
  MapKept        kept;
  MarchWork      w;

  PetscFunctionBeginUser;
  PetscCall(MarchWorkCreate(map, bodies, &w));
  kept = (MapKept){&bodies->model, &w.state};
  PetscCall(MapResumeChain(map, chain, &first, row, &kept));
  if (first) good = row[first - 1].end != MAP_FAILED ? PETSC_TRUE : PETSC_FALSE;
  for (PetscInt k = first; k < n; k++) {
    const PetscInt down = n_ways == 2 ? chain % 2 : map->direction == MAP_DOWN;

    row[k] = (MapPoint){.line = chain / n_ways, .down = down, .place = down ? n - 1 - k : k};
    PetscCall(MarchPoint(&w, good && map->direction != MAP_APART, &row[k], &good));
    PetscCall(MapKeepChain(map, chain, k + 1, row, &kept));
    PetscCall(ProgressStep(&map->progress));
  }
  PetscCall(MarchWorkDestroy(&w));
  PetscFunctionReturn(0);
}
