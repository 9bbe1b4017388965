/*
   A chain: a line of the map in one direction, point after point, each from the end of the one before, until its regime
   is known (map.h), or a point alone. Runs on one rank, without messages. What a point begins with besides the state is
   made anew.
*/
#include "map/mapimpl.h"

/* Work for one step length on one line's bodies: statuses, windows and samples of the whole time. Works of the step
   are not asked for, a tenth of its time; those of contact are. */
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
  PetscCall(MapTwinsCreate(w));
  PetscFunctionReturn(0);
}

PetscErrorCode MapMarchDestroy(MapMarch *march)
{
  MapMarch w = *march;

  PetscFunctionBeginUser;
  if (!w) PetscFunctionReturn(0);
  PetscCall(MapTwinsDestroy(w));
  PetscCall(ReducedStepperDestroy(&w->stepper));
  PetscCall(ReducedStateDestroy(&w->state));
  PetscCall(ReducedStateDestroy(&w->rest));
  PetscCall(ReducedReportDestroy(&w->report));
  PetscCall(PetscFree6(w->sliding, w->loads, w->kick, w->slip, w->force, w->sample));
  PetscCall(PetscFree6(w->status, w->closed, w->known, w->lambda_n, w->sigma, w->omega));
  PetscCall(PetscFree(*march));
  PetscFunctionReturn(0);
}

/* Growth of the fastest mode about the sliding state with the inertia of what the modes leave out; after
   MapMarchLinearise() there */
static PetscErrorCode MarchWeigh(MapMarch w, MapPoint *row)
{
  MapFastest fastest;

  PetscFunctionBeginUser;
  PetscCall(ReducedLinearise(&w->bodies->model, w->closed, w->lambda_n, PETSC_TRUE, w->sigma, w->omega));
  MapModesJudge(2 * w->bodies->model.m, w->sigma, w->omega, &fastest);
  row->whole = fastest.growth;
  PetscFunctionReturn(0);
}

/* The sliding state of a point, its eigenvalues, and where the point begins: there, or where the one before ended.
   sliding [pairs] = speed dt, m. Without a sliding state a point can only go on from another. */
static PetscErrorCode MarchBegin(MapMarch w, PetscBool go_on, MapPoint *row, PetscBool *begun)
{
  const ReducedModel *model   = &w->bodies->model;
  MapFastest          fastest = {NAN, NAN, NAN};
  PetscBool           found;

  PetscFunctionBeginUser;
  PetscCall(MapBodiesMove(w->map, row, w->bodies, w->sliding, w->loads));
  for (PetscInt i = 0; i < model->n_pairs; i++) w->sliding[i] *= w->dt;
  PetscCall(ReducedStepperTakeFriction(w->stepper));
  PetscCall(ReducedEquilibrium(model, w->loads, &w->rest, &found));
  w->growth = NAN;
  PetscCall(PetscArrayzero(w->known, model->n_pairs));
  if (found) PetscCall(MapMarchLinearise(w, w->rest.status, &fastest));
  if (found) MapModesTake(2 * model->m, w->sigma, w->omega, &w->map->limit, row);
  if (found && model->Mx) PetscCall(MarchWeigh(w, row));
  if (found && !go_on) PetscCall(ReducedStateCopy(model, &w->rest, &w->state));
  for (PetscInt k = 0; k < model->m && w->disturbance; k++) w->state.rate[k] += w->disturbance[k];
  row->growth    = fastest.growth;
  row->mode_freq = fastest.freq;
  row->index     = fastest.index;
  w->state.time  = 0;
  *begun         = found || go_on ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(0);
}

/* A point; false where it failed, of which no other rank knows: laws without solution, or a motion beyond numbers */
static PetscErrorCode MarchPoint(MapMarch w, PetscBool go_on, MapPoint *row, PetscBool *good)
{
  MapPoint begin;

  PetscFunctionBeginUser;
  PetscCall(MarchBegin(w, go_on, row, good));
  begin = *row;
  if (*good) {
    PetscCall(MapTwinsBegin(w));
    PetscCall(MapMarchTry(w, row));
  } else
    row->regime = MAP_UNKNOWN, row->end = MAP_FAILED, row->fault = MAP_NO_STATE;
  if (row->end == MAP_FAILED) *good = PETSC_FALSE;
  PetscCall(MapTwinsRun(w, &begin, row));
  PetscFunctionReturn(0);
}

void MapChainPlace(Map map, PetscInt chain, PetscInt k, MapPoint *row)
{
  const PetscInt way = chain % map->n_ways, down = map->direction == MAP_BOTH ? way : map->direction == MAP_DOWN;
  const PetscInt place = map->direction == MAP_APART ? way : down ? map->n_linked - 1 - k : k;

  *row = (MapPoint){.line = chain / map->n_ways, .place = place, .down = down, .second = {NAN, NAN}};
}

/* Two neighbours of a chain where the transients of the first are each another one, and some of all die out and some
   vibrate: chance decides at which of the two each ends, and n that end alike do not exclude the other end, whose share
   may be up to 1 - 0.05^(1/n). Both rows list both regimes. */
static void ChainListChance(MapPoint *before, MapPoint *row)
{
  MapPoint *const both[2] = {before, row};
  PetscBool       dies = PETSC_FALSE, vibrates = PETSC_FALSE;

  for (int i = 0; i < 2; i++) {
    if (both[i]->regime == MAP_UNKNOWN) return;
    if (both[i]->regime == MAP_STABLE || both[i]->regime == MAP_BISTABLE) dies = PETSC_TRUE;
    if (both[i]->regime != MAP_STABLE) vibrates = PETSC_TRUE;
  }
  for (int i = 0; i < 2 && dies && vibrates; i++)
    both[i]->regimes |= 1 << (both[i]->regime == MAP_STABLE ? MAP_CYCLE : MAP_STABLE);
}

/* Rows are kept after each point, with the state at its end; rows that an earlier run kept are not run again. A
   failed point breaks the chain: the next one begins at its own sliding state. */
PetscErrorCode MapChain(MapMarch w, PetscInt chain, MapPoint row[])
{
  Map       map   = w->map;
  PetscBool good  = PETSC_FALSE;
  PetscInt  first = 0;
  MapKept   kept  = {&w->bodies->model, &w->state, w->n_twins, w->twin, &w->n_alive};

  PetscFunctionBeginUser;
  w->n_alive = 0;
  if (w->bodies->kept) PetscCall(MapResumeChain(map, chain, &first, row, &kept));
  if (first) good = row[first - 1].end != MAP_FAILED ? PETSC_TRUE : PETSC_FALSE;
  for (PetscInt k = first; k < map->n_linked; k++) {
    const PetscBool apart = k && w->n_twins > 1 && w->n_alive == w->n_twins ? PETSC_TRUE : PETSC_FALSE;

    MapChainPlace(map, chain, k, &row[k]);
    PetscCall(MarchPoint(w, good, &row[k], &good));
    if (apart) ChainListChance(&row[k - 1], &row[k]);
    PetscCall(MapKeepChain(map, chain, k + 1, row, &kept));
    PetscCall(ProgressStep(&map->progress));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode MapMarchAlone(MapMarch w, const PetscReal rate[], MapPoint *row)
{
  PetscBool good;

  PetscFunctionBeginUser;
  w->n_twins     = 0;
  w->disturbance = rate;
  PetscCall(MarchPoint(w, PETSC_FALSE, row, &good));
  PetscFunctionReturn(0);
}
