/*
   What rounding changes of a point. Reduced bodies that were made on other numbers of ranks, or with other kernels of
   OpenBLAS, differ by up to 2e-10, forces by what the contact laws hold to. A motion that loses contact may be chaotic:
   its amplitude is then a sample of many, and which regime it ends in may be chance. A twin begins where the point does
   but for that, and its friction is as much another; along a chain it goes on from its own ends. Where the first one
   ends as the point's own transient did, rounding decides nothing. Where not, all twins are run, the others from x + c
   (x1 - x), with x where the point begins, x1 its first twin, and small integers c: small differences obey linear laws.
   Where x1 has come far along a chain they do not, and these are only other states about the point's; then

     bistable   some are stable and some vibrate; the numbers are of those that vibrate
     otherwise  where they vibrate, the numbers are of all

   as means over the transients, and error_estimate is what these differ by from those of as many others in 5 of 100
   (point/spread.c).
   A point whose transient dies out, linear but for its impulses, has no twin, unless one of the chain is under way.
*/
#include "map/mapimpl.h"

#define TWIN_ROUNDING MAP_RTOL /* of each coordinate and rate, and of friction, with changing signs */
#define TWIN_DIFFERS  1e-3     /* of the rms, relative: the transients are others */

PetscErrorCode MapTwinsCreate(MapMarch w)
{
  const ReducedModel *model = &w->bodies->model;
  const PetscInt      n     = w->map->n_twins;

  PetscFunctionBeginUser;
  w->n_twins = n;
  PetscCall(ReducedStateCreate(model, &w->start));
  PetscCall(ReducedStateCreate(model, &w->next));
  PetscCall(PetscCalloc7(n, &w->twin, model->n_pairs, &w->rest_known, model->n_pairs, &w->rest_friction, 1 + n, &w->run,
                         1 + n, &w->n_levels, (1 + n) * w->n_most, &w->level, (1 + n) * w->n_most, &w->sorted));
  for (PetscInt k = 0; k < n; k++) PetscCall(ReducedStateCreate(model, &w->twin[k]));
  PetscFunctionReturn(0);
}

PetscErrorCode MapTwinsDestroy(MapMarch w)
{
  PetscFunctionBeginUser;
  PetscCall(ReducedStateDestroy(&w->start));
  PetscCall(ReducedStateDestroy(&w->next));
  for (PetscInt k = 0; k < w->map->n_twins; k++) PetscCall(ReducedStateDestroy(&w->twin[k]));
  PetscCall(PetscFree7(w->twin, w->rest_known, w->rest_friction, w->run, w->n_levels, w->level, w->sorted));
  PetscFunctionReturn(0);
}

PetscErrorCode MapTwinsBegin(MapMarch w)
{
  PetscFunctionBeginUser;
  PetscCall(ReducedStateCopy(&w->bodies->model, &w->state, &w->start));
  PetscCall(PetscArraycpy(w->rest_known, w->known, w->bodies->model.n_pairs));
  PetscCall(PetscArraycpy(w->rest_friction, w->bodies->model.friction, w->bodies->model.n_pairs));
  w->rest_growth = w->growth;
  PetscFunctionReturn(0);
}

/* 1 and a rounding, or 1 less it; `bits` change with each, alike in every run (linear congruence modulo 2^32,
   factors of W. H. Press et al., Numerical Recipes, section 7.1), of which the highest bit, the best one, is taken. */
static PetscReal TwinFactor(uint32_t *bits)
{
  *bits = 1664525 * *bits + 1013904223;
  return *bits >> 31 ? 1 + TWIN_ROUNDING : 1 - TWIN_ROUNDING;
}

/* Twin k is where `from` is, but for rounding */
static PetscErrorCode TwinBranch(MapMarch w, const ReducedState *from, PetscInt k)
{
  const PetscInt m    = w->bodies->model.m;
  uint32_t       bits = (uint32_t)k + 1;

  PetscFunctionBeginUser;
  PetscCall(ReducedStateCopy(&w->bodies->model, from, &w->twin[k]));
  for (PetscInt i = 0; i < m; i++) w->twin[k].eta[i] *= TwinFactor(&bits);
  for (PetscInt i = 0; i < m; i++) w->twin[k].rate[i] *= TwinFactor(&bits);
  PetscFunctionReturn(0);
}

/* Twin k > 0 is c times as far from the point as its first twin was: c = -1, 2, -2, 3, ... The statuses are those
   of the first twin; steps find their own. */
static PetscErrorCode TwinFollow(MapMarch w, PetscInt k)
{
  const ReducedModel *model = &w->bodies->model;
  const PetscReal     c = (PetscReal)(k % 2 ? -(k + 1) / 2 : k / 2 + 1), *x = w->start.eta;
  PetscReal          *y = w->twin[k].eta;

  PetscFunctionBeginUser;
  PetscCall(ReducedStateCopy(model, &w->next, &w->twin[k]));
  for (PetscInt i = 0; i < ReducedStateSize(model); i++) y[i] = x[i] + c * (y[i] - x[i]);
  PetscFunctionReturn(0);
}

/* Friction of twin k, which is another by rounding */
static PetscErrorCode TwinSetFriction(MapMarch w, PetscInt k)
{
  ReducedModel *model = &w->bodies->model;
  uint32_t      bits  = (uint32_t)(MAP_MAX_TWINS + k);

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < model->n_pairs; i++) FrictionScale(&model->friction[i], TwinFactor(&bits));
  PetscCall(ReducedStepperTakeFriction(w->stepper));
  PetscFunctionReturn(0);
}

/* What the transient that has just ended was */
static void TwinTake(MapMarch w, const MapPoint *run, MapPoint *row)
{
  const PetscInt k = w->n_runs;

  row->n_runs++;
  row->regimes |= 1 << run->regime;
  row->all_steps += run->steps;
  if (run->end == MAP_FAILED) return;
  w->run[k]      = *run;
  w->n_levels[k] = 0;
  for (PetscInt i = w->first; i < w->n_windows; i++) w->level[w->n_most * k + w->n_levels[k]++] = w->sample[i].rms;
  w->n_runs++;
}

/* Twin k from its state until its regime is known; one that fails goes on from the end of the point's own transient */
static PetscErrorCode TwinRun(MapMarch w, PetscInt k, const MapPoint *begin, MapPoint *row)
{
  const ReducedState own = w->state;
  MapPoint           run = *begin;

  PetscFunctionBeginUser;
  w->state      = w->twin[k];
  w->state.time = 0;
  w->growth     = w->rest_growth;
  PetscCall(PetscArraycpy(w->known, w->rest_known, w->bodies->model.n_pairs));
  PetscCall(TwinSetFriction(w, k));
  PetscCall(MapMarchTry(w, &run));
  TwinTake(w, &run, row);
  w->twin[k] = w->state;
  w->state   = own;
  PetscCall(PetscArraycpy(w->bodies->model.friction, w->rest_friction, w->bodies->model.n_pairs));
  if (run.end == MAP_FAILED) PetscCall(TwinBranch(w, &w->state, k));
  PetscFunctionReturn(0);
}

static PetscBool TwinVibrates(const MapPoint *run)
{
  return run->regime != MAP_STABLE && run->regime != MAP_UNKNOWN ? PETSC_TRUE : PETSC_FALSE;
}

/* Whether run k is another one than the point's own */
static PetscBool TwinDiffers(const MapMarch w, PetscInt k)
{
  const MapPoint *a = &w->run[0], *b = &w->run[k];

  if (a->regime != b->regime) return PETSC_TRUE;
  if (!TwinVibrates(a)) return PETSC_FALSE;
  return a->end != b->end || a->steps != b->steps || PetscAbsReal(b->rms - a->rms) > TWIN_DIFFERS * a->rms
           ? PETSC_TRUE
           : PETSC_FALSE;
}

/* Whether the point's own transient dies out, and is linear but for its impulses */
static PetscBool TwinIsNeedless(const MapMarch w)
{
  if (w->run[0].end != MAP_DECAYS) return PETSC_FALSE;
  for (PetscInt k = 0; k < w->n_windows; k++)
    if (w->sample[k].changed && !w->sample[k].hit) return PETSC_FALSE;
  return PETSC_TRUE;
}

/* How many runs vibrate, and quantiles of the rms of the windows of all */
static PetscErrorCode TwinsArrange(MapMarch w, MapPoint *row)
{
  PetscInt n = 0;

  PetscFunctionBeginUser;
  row->n_loud = 0;
  for (PetscInt k = 0; k < w->n_runs; k++) {
    row->n_loud += TwinVibrates(&w->run[k]);
    for (PetscInt i = 0; i < w->n_levels[k]; i++) w->sorted[n++] = w->level[w->n_most * k + i];
  }
  PetscCall(MapSpreadQuantiles(n, w->sorted, row->quantile));
  PetscFunctionReturn(0);
}

/* The largest difference of another run becomes the error where that is smaller */
static void TwinsEnlarge(MapMarch w, MapPoint *row)
{
  for (PetscInt k = 1; k < w->n_runs; k++) {
    const MapPoint *run = &w->run[k];

    if (PetscAbsReal(run->rms - row->rms) > row->error * row->rms) row->error = PetscAbsReal(run->rms / row->rms - 1);
    if (PetscAbsReal(run->freq - row->freq) > row->freq_error) row->freq_error = PetscAbsReal(run->freq - row->freq);
    row->second[1] = PetscMax(row->second[1], PetscAbsReal(run->second[0] - row->second[0]));
  }
}

/* A motion with two basic frequencies that not all runs have is a vibration like others; where all have it, the errors
   are those of all */
static void TwinsLookAtLines(const MapMarch w, MapPoint *row)
{
  if (row->regime != MAP_QUASI) return;
  for (PetscInt k = 0; k < w->n_runs; k++)
    if (w->run[k].regime != MAP_QUASI) row->regime = MAP_CYCLE;
  for (PetscInt k = 0; k < w->n_runs; k++)
    row->second[1] =
      PetscMax(row->second[1], PetscMax(w->run[k].second[1], PetscAbsReal(w->run[k].second[0] - row->second[0])));
  if (row->regime != MAP_QUASI) row->second[0] = row->second[1] = NAN;
}

/* Leaves the runs that vibrate */
static PetscErrorCode TwinsKeepLoud(MapMarch w)
{
  PetscInt n = 0;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < w->n_runs; k++) {
    if (!TwinVibrates(&w->run[k])) continue;
    w->run[n]      = w->run[k];
    w->n_levels[n] = w->n_levels[k];
    PetscCall(PetscArraymove(&w->level[w->n_most * n], &w->level[w->n_most * k], w->n_levels[k]));
    n++;
  }
  w->n_runs = n;
  PetscFunctionReturn(0);
}

/* A vibration in which no closed pair may slide in so much of the time that it is sticking, or not */
static void TwinsLookAtSticking(const MapMarch w, MapPoint *row)
{
  PetscReal stick[1 + MAP_MAX_TWINS];

  if (row->regime != MAP_CYCLE && row->regime != MAP_STICKING) return;
  for (PetscInt k = 0; k < w->n_runs; k++) stick[k] = w->run[k].stick;
  row->regime = row->stick > MAP_STICKING_SHARE ? MAP_STICKING : MAP_CYCLE;
  row->regimes |= 1 << row->regime;
  if (PetscAbsReal(row->stick - MAP_STICKING_SHARE) <= MapSpreadOfMean(w->n_runs, stick))
    row->regimes |= 1 << MAP_CYCLE | 1 << MAP_STICKING;
}

/* The middle one of the main lines of those runs that have one: a mean of different ones would be no line */
static PetscErrorCode TwinsTakeLine(const MapMarch w, MapPoint *row)
{
  PetscReal freq[1 + MAP_MAX_TWINS], error = 0;
  PetscInt  n = 0;

  PetscFunctionBeginUser;
  row->freq = row->freq_error = NAN;
  for (PetscInt k = 0; k < w->n_runs; k++) {
    if (PetscIsNanReal(w->run[k].freq)) continue;
    freq[n++] = w->run[k].freq;
    if (w->run[k].freq_error > error) error = w->run[k].freq_error;
  }
  if (!n) PetscFunctionReturn(0);
  PetscCall(PetscSortReal(n, freq));
  row->freq       = freq[(n - 1) / 2];
  row->freq_error = PetscMax(error, PetscMax(freq[n - 1] - row->freq, row->freq - freq[0]));
  PetscFunctionReturn(0);
}

/* Numbers of a vibration that the runs have, each another one: means */
static PetscErrorCode TwinsAverage(MapMarch w, MapPoint *row)
{
  const PetscReal n = (PetscReal)w->n_runs;

  PetscFunctionBeginUser;
  row->mean = row->rms = row->peak = row->open = row->stick = 0;
  for (PetscInt k = 0; k < w->n_runs; k++) {
    const MapPoint *run = &w->run[k];

    row->mean += run->mean / n;
    row->rms += PetscSqr(run->rms) / n;
    row->open += run->open / n;
    row->stick += run->stick / n;
    row->peak = PetscMax(row->peak, run->peak);
  }
  row->rms   = PetscSqrtReal(row->rms);
  row->error = MapSpreadOfLevel(w->n_runs, w->n_levels, w->n_most, w->level);
  PetscCall(TwinsTakeLine(w, row));
  TwinsLookAtLines(w, row);
  TwinsLookAtSticking(w, row);
  PetscFunctionReturn(0);
}

/* What all runs say of the point */
static PetscErrorCode TwinsJudge(MapMarch w, PetscBool differ, MapPoint *row)
{
  PetscFunctionBeginUser;
  PetscCall(TwinsArrange(w, row));
  if (row->n_loud && row->n_loud < w->n_runs) {
    row->regime = MAP_BISTABLE;
    PetscCall(TwinsKeepLoud(w));
    PetscCall(TwinsAverage(w, row));
  } else if (differ && row->n_loud)
    PetscCall(TwinsAverage(w, row));
  else
    TwinsEnlarge(w, row);
  PetscFunctionReturn(0);
}

/* Twins of a point that has not failed, the first one and, where it differs or they are under way, all; whether one
   differs. n_alive twins have states of their own from the point before; after it all have where one differed, else
   the first alone, or none where it would tell nothing. */
static PetscErrorCode TwinsMarch(MapMarch w, const MapPoint *begin, MapPoint *row, PetscBool *differ)
{
  const PetscBool needless = TwinIsNeedless(w);
  const PetscInt  n_alive  = w->n_alive;

  PetscFunctionBeginUser;
  *differ    = PETSC_FALSE;
  w->n_alive = 0;
  if (!w->n_twins || (needless && !n_alive)) PetscFunctionReturn(0);
  if (!n_alive) PetscCall(TwinBranch(w, &w->start, 0));
  PetscCall(ReducedStateCopy(&w->bodies->model, &w->twin[0], &w->next));
  PetscCall(TwinRun(w, 0, begin, row));
  *differ = w->n_runs < 2 || TwinDiffers(w, 1) ? PETSC_TRUE : PETSC_FALSE;
  if (*differ || n_alive == w->n_twins)
    for (PetscInt k = 1; k < w->n_twins; k++) {
      if (n_alive < w->n_twins) PetscCall(TwinFollow(w, k));
      PetscCall(TwinRun(w, k, begin, row));
    }
  for (PetscInt k = 1; k < w->n_runs; k++)
    if (TwinDiffers(w, k)) *differ = PETSC_TRUE;
  w->n_alive = *differ ? w->n_twins : needless ? 0 : 1;
  PetscFunctionReturn(0);
}

/* The point's own transient is run 0; a failed one has no twins. Afterwards row has what all say together. */
PetscErrorCode MapTwinsRun(MapMarch w, const MapPoint *begin, MapPoint *row)
{
  const MapPoint own    = *row;
  PetscBool      differ = PETSC_FALSE;

  PetscFunctionBeginUser;
  w->n_runs = 0;
  TwinTake(w, &own, row);
  if (w->n_runs)
    PetscCall(TwinsMarch(w, begin, row, &differ));
  else
    w->n_alive = 0;
  PetscCall(TwinsJudge(w, differ, row));
  PetscFunctionReturn(0);
}
