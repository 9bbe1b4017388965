/*
   What a transient is when it ends, and whether it has: windows that die out, settle or are steady (map.h), and its
   numbers.
*/
#include "map/mapimpl.h"
#include "base/statistics/lines.h"

#define MARCH_TINY  1e-9 /* of the mean force: a vibration that is rounding */
#define MARCH_SMALL 0.01 /* of the mean force: a vibration that is small */
#define MARCH_TREND 1.5  /* of the rms, from a quarter of the windows to the next: growth */

/* About the sliding state with the pairs of `status` closed, and its normal forces; w->growth and w->known tell of
   which pairs the eigenvalues are. */
PetscErrorCode MapMarchLinearise(MapMarch w, const ContactStatus status[], MapFastest *fastest)
{
  const ReducedModel *model = &w->bodies->model;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < model->n_pairs; i++) {
    w->closed[i]   = status[i] != CONTACT_OPEN ? PETSC_TRUE : PETSC_FALSE;
    w->lambda_n[i] = w->rest.p[3 * i];
  }
  PetscCall(ReducedLinearise(model, w->closed, w->lambda_n, PETSC_FALSE, w->sigma, w->omega));
  MapModesJudge(2 * model->m, w->sigma, w->omega, fastest);
  w->growth = fastest->growth;
  PetscCall(PetscArraycpy(w->known, w->closed, model->n_pairs));
  PetscFunctionReturn(0);
}

/* Whether `growth` is that of the pairs that are closed now, all of which slip */
static PetscBool MarchIsKnown(const MapMarch w)
{
  for (PetscInt i = 0; i < w->bodies->model.n_pairs; i++)
    if (w->state.status[i] != (w->known[i] ? CONTACT_SLIP : CONTACT_OPEN)) return PETSC_FALSE;
  return PETSC_TRUE;
}

/* Whether friction of some pair changes with its slip, so that a motion is not linear though no status changes */
static PetscBool MarchIsCurved(const MapMarch w)
{
  for (PetscInt i = 0; i < w->bodies->model.n_pairs; i++)
    if (FrictionVaries(&w->bodies->model.friction[i])) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* n windows in turn in which the rms falls, in a linear or small motion about pairs whose eigenvalues all decay; a
   vibration that is rounding need not fall. */
PetscErrorCode MapMarchDiesOut(MapMarch w, PetscBool *dies)
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
  if (!MarchIsKnown(w) && !s->changed) PetscCall(MapMarchLinearise(w, w->state.status, &fastest));
  *dies = w->growth < 0 ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(0);
}

/* What a transient that did not settle is. It grows where the rms of the last quarter of the windows is that much
   beyond the one before, or, where a mode grows, where it rises in each window of the last half, or where no pair
   changed its status there, so that the motion is linear; friction that changes with the slip makes a motion curved,
   which is stable where its rms falls */
static MapRegime MarchTrend(const MapMarch w)
{
  const PetscInt   n    = w->n_windows;
  const MapSample *s    = w->sample;
  PetscBool        calm = MarchIsKnown(w), rises = PETSC_TRUE, linear;
  PetscReal        error;
  const PetscReal  ratio =
    MapForceLevel(n / 4, &s[n - n / 4], &error) / MapForceLevel(n / 4, &s[n - 2 * (n / 4)], &error);

  for (PetscInt k = n - n / 2; k < n; k++) {
    if (s[k].changed) calm = PETSC_FALSE;
    if (s[k].rms <= (1 + w->map->rtol) * s[k - 1].rms) rises = PETSC_FALSE;
  }
  linear = calm && !MarchIsCurved(w) ? PETSC_TRUE : PETSC_FALSE;
  if (w->growth < 0 && (linear || (calm && ratio < 1 - w->map->rtol))) return MAP_STABLE;
  if (ratio >= MARCH_TREND || (w->growth > 0 && (linear || rises))) return MAP_GROWTH;
  if (ratio <= 1 / MARCH_TREND && w->growth < 0) return MAP_STABLE;
  return MAP_CYCLE;
}

/* Means over windows first .., the largest value of all. */
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

/* The main line; freq_error is the difference of the lines of two halves. Of a vibration with two basic frequencies
   both, over all windows as one record */
static PetscErrorCode MarchFindLines(MapMarch w, MapPoint *row)
{
  const PetscInt   n = w->n, windows = w->n_windows - w->first, half = windows / 2;
  const PetscReal *slip = &w->slip[n * w->first];
  PetscBool        two  = PETSC_FALSE;
  Line             line[2];

  PetscFunctionBeginUser;
  if (row->regime == MAP_STABLE) PetscFunctionReturn(0);
  row->freq = MapForceLine(windows, n, slip, w->dt);
  if (half)
    row->freq_error =
      PetscAbsReal(MapForceLine(half, n, slip, w->dt) - MapForceLine(half, n, &slip[n * (windows - half)], w->dt));
  if (row->regime != MAP_GROWTH) PetscCall(LinesFindTwo(n * windows, slip, w->dt, line, &two));
  if (!two) PetscFunctionReturn(0);
  row->regime     = MAP_QUASI;
  row->freq       = line[0].freq;
  row->freq_error = line[0].error;
  row->second[0]  = line[1].freq;
  row->second[1]  = line[1].error;
  PetscFunctionReturn(0);
}

/* Numbers over the last window where it decays, the windows that agree where it settled, else the last half. */
PetscErrorCode MapMarchJudge(MapMarch w, MapPoint *row)
{
  const PetscInt  last   = w->n_windows;
  const PetscInt  first  = row->end == MAP_DECAYS    ? last - 1
                           : row->end == MAP_SETTLED ? last - MAP_SETTLED_WINDOWS
                                                     : last / 2;
  const PetscReal change = row->error;

  PetscFunctionBeginUser;
  w->first = first;
  MarchAverage(w, first, row);
  row->rms    = MapForceLevel(last - first, &w->sample[first], &row->error);
  row->time   = w->state.time;
  row->regime = row->end == MAP_DECAYS ? MAP_STABLE : row->end == MAP_TIME ? MarchTrend(w) : MAP_CYCLE;
  if (row->end == MAP_DECAYS) row->error = NAN;
  if (row->end == MAP_SETTLED) row->error = change;
  if (row->regime == MAP_CYCLE && row->stick > MAP_STICKING_SHARE) row->regime = MAP_STICKING;
  row->freq = row->freq_error = NAN;
  PetscCall(MarchFindLines(w, row));
  PetscFunctionReturn(0);
}
