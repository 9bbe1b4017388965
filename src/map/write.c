/*
   map.csv: a row for each point and direction.
*/
#include "mapimpl.h"
#include "base/text.h"

static const char *const regimes[MAP_N_REGIMES] = {
  [MAP_STABLE] = "stable",        [MAP_GROWTH] = "growth",     [MAP_STICKING] = "sticking", [MAP_CYCLE] = "cycle",
  [MAP_QUASI] = "quasi_periodic", [MAP_BISTABLE] = "bistable", [MAP_UNKNOWN] = "unknown"};
static const char *const ends[MAP_N_ENDS] = {[MAP_DECAYS]  = "decays",
                                             [MAP_SETTLED] = "settled",
                                             [MAP_STEADY]  = "steady",
                                             [MAP_TIME]    = "time",
                                             [MAP_FAILED]  = "failed"};

PetscErrorCode MapTableOpen(Results results, ResultsTable *table)
{
  PetscFunctionBeginUser;
  PetscCall(ResultsTableOpen(
    results, "map",
    "point,parameter,value,parameter_2,value_2,direction,regime,freq_hz,freq_error_hz,force_rms_n,force_peak_n,"
    "force_mean_n,open_share,stick_share,growth_rad_s,growth_freq_hz,index,error_estimate,steps,time_s,status,n_"
    "growing,runs,runs_vibrating,regimes,decided_by,force_rms_p05_n,force_rms_p50_n,force_rms_p95_n,n_unstable,"
    "freq_2_hz,freq_2_error_hz",
    table));
  PetscFunctionReturn(0);
}

static PetscBool MapVibrates(const MapPoint *row)
{
  return row->regime == MAP_CYCLE || row->regime == MAP_STICKING || row->regime == MAP_QUASI ? PETSC_TRUE : PETSC_FALSE;
}

/* Whether a point vibrates one way and is stable the other; its row of the other way is n places behind that of
   this one, or in front of it. */
static PetscBool MapHangsOnWay(Map map, const MapPoint *row)
{
  const MapPoint *other;

  if (map->direction != MAP_BOTH) return PETSC_FALSE;
  other = row + (row->down ? -map->axis[0].n : map->axis[0].n);
  return (MapVibrates(row) && other->regime == MAP_STABLE) || (MapVibrates(other) && row->regime == MAP_STABLE)
           ? PETSC_TRUE
           : PETSC_FALSE;
}

/* The regimes of the transients of a point, "cycle+stable" */
static PetscErrorCode MapListRegimes(const MapPoint *row, size_t length, char list[])
{
  PetscFunctionBeginUser;
  list[0] = '\0';
  for (int k = 0; k < MAP_N_REGIMES; k++) {
    if (!(row->regimes >> k & 1)) continue;
    if (list[0]) PetscCall(TextAdd(list, "+", length));
    PetscCall(TextAdd(list, regimes[k], length));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode MapTableAdd(Map map, ResultsTable table, const MapPoint *point)
{
  const MapAxis  *x = &map->axis[0], *y = &map->axis[1];
  MapPoint        known       = *point;
  const MapPoint *r           = &known;
  char            second[192] = ",", list[96];

  PetscFunctionBeginUser;
  PetscCall(MapListRegimes(point, sizeof(list), list));
  if (r->end == MAP_FAILED)
    known.freq = known.freq_error = known.second[0] = known.second[1] = known.rms = known.peak = known.mean =
      known.open = known.stick = known.error = NAN;
  if (map->n_axes > 1)
    PetscCall(PetscSNPrintf(second, sizeof(second), "%s,%.15g", y->moved[0].name, (double)y->value[r->line]));
  PetscCall(ResultsTableRow(
    table,
    "%d,%s,%.15g,%s,%s,%s,%.15g,%.15g,%.15g,%.15g,%.15g,%.15g,%.15g,%.15g,%.15g,%.15g,%.15g,%d,%.15g,%s,%d,%d,%d,%s,%s,"
    "%.15g,%.15g,%.15g,%d,%.15g,%.15g",
    (int)(r->line * x->n + r->place + 1), x->moved[0].name, (double)x->value[r->place], second,
    map->direction == MAP_APART ? "apart"
    : r->down                   ? "down"
                                : "up",
    regimes[r->regime], (double)r->freq, (double)r->freq_error, (double)r->rms, (double)r->peak, (double)r->mean,
    (double)r->open, (double)r->stick, (double)r->growth, (double)r->mode_freq, (double)r->index, (double)r->error,
    (int)r->steps, (double)r->time, ends[r->end], (int)r->n_growing, (int)r->n_runs, (int)r->n_loud, list,
    r->regime == MAP_BISTABLE   ? "rounding"
    : MapHangsOnWay(map, point) ? "direction"
                                : "",
    (double)r->quantile[0], (double)r->quantile[1], (double)r->quantile[2], (int)r->n_unstable, (double)r->second[0],
    (double)r->second[1]));
  PetscFunctionReturn(0);
}

/* The second value of a row as text, empty for none */
static PetscErrorCode MapSecond(Map map, const MapPoint *r, char second[64])
{
  PetscFunctionBeginUser;
  second[0] = '\0';
  if (map->n_axes > 1) PetscCall(PetscSNPrintf(second, 64, "%.15g", (double)map->axis[1].value[r->line]));
  PetscFunctionReturn(0);
}

PetscErrorCode MapModesOpen(Results results, ResultsTable *table)
{
  PetscFunctionBeginUser;
  PetscCall(
    ResultsTableOpen(results, "map_modes", "point,value,value_2,freq_hz,growth_rad_s,damping_ratio,state", table));
  PetscFunctionReturn(0);
}

PetscErrorCode MapModesAdd(Map map, ResultsTable table, const MapPoint *r)
{
  const MapAxis *x = &map->axis[0];
  char           second[64];

  PetscFunctionBeginUser;
  if (r->down && map->direction == MAP_BOTH) PetscFunctionReturn(0);
  PetscCall(MapSecond(map, r, second));
  for (PetscInt k = 0; k < PetscMin(r->n_growing, MAP_MAX_MODES); k++)
    PetscCall(ResultsTableRow(table, "%d,%.15g,%s,%.15g,%.15g,%.15g,%s", (int)(r->line * x->n + r->place + 1),
                              (double)x->value[r->place], second, (double)(r->omega[k] / (2 * PETSC_PI)),
                              (double)r->sigma[k], (double)(-r->sigma[k] / hypot(r->sigma[k], r->omega[k])),
                              ModeStateName(ModesLimitJudge(&map->limit, r->sigma[k], r->omega[k], 0))));
  PetscFunctionReturn(0);
}

PetscErrorCode MapErrorsOpen(Results results, ResultsTable *table)
{
  PetscFunctionBeginUser;
  PetscCall(ResultsTableOpen(results, "map_errors",
                             "point,value,value_2,run,regime,freq_hz,force_rms_n,growth_rad_s,growth_freq_hz,"
                             "freq_error_hz,force_rms_error,growth_error_rad_s,steps,time_s,status",
                             table));
  PetscFunctionReturn(0);
}

PetscErrorCode MapErrorsAdd(Map map, ResultsTable table, const char run[], const MapPoint *r, const MapError *error)
{
  const MapAxis *x = &map->axis[0];
  char           second[64];

  PetscFunctionBeginUser;
  PetscCall(MapSecond(map, r, second));
  PetscCall(ResultsTableRow(table, "%d,%.15g,%s,%s,%s,%.15g,%.15g,%.15g,%.15g,%.15g,%.15g,%.15g,%d,%.15g,%s",
                            (int)(r->line * x->n + r->place + 1), (double)x->value[r->place], second, run,
                            regimes[r->regime], (double)(r->end == MAP_FAILED ? NAN : r->freq),
                            (double)(r->end == MAP_FAILED ? NAN : r->rms), (double)r->growth, (double)r->mode_freq,
                            (double)error->freq, (double)error->rms, (double)error->growth, (int)r->steps,
                            (double)r->time, ends[r->end]));
  PetscFunctionReturn(0);
}

PetscErrorCode MapDisturbedOpen(Results results, ResultsTable *table)
{
  PetscFunctionBeginUser;
  PetscCall(
    ResultsTableOpen(results, "map_disturbed",
                     "point,value,value_2,run,energy_j,regime,freq_hz,force_rms_n,error_estimate,steps,time_s,status,"
                     "freq_2_hz,freq_2_error_hz",
                     table));
  PetscFunctionReturn(0);
}

PetscErrorCode MapDisturbedAdd(Map map, ResultsTable table, PetscInt run, PetscReal energy, const MapPoint *r)
{
  const PetscReal none = r->end == MAP_FAILED ? NAN : 0;
  char            second[64];

  PetscFunctionBeginUser;
  PetscCall(MapSecond(map, r, second));
  PetscCall(ResultsTableRow(table, "%d,%.15g,%s,%d,%.15g,%s,%.15g,%.15g,%.15g,%d,%.15g,%s,%.15g,%.15g",
                            (int)(r->line * map->axis[0].n + r->place + 1), (double)map->axis[0].value[r->place],
                            second, (int)run, (double)energy, regimes[r->regime], (double)(r->freq + none),
                            (double)(r->rms + none), (double)(r->error + none), (int)r->steps, (double)r->time,
                            ends[r->end], (double)(r->second[0] + none), (double)(r->second[1] + none)));
  PetscFunctionReturn(0);
}

PetscErrorCode MapBasinOpen(Results results, ResultsTable *table)
{
  PetscFunctionBeginUser;
  PetscCall(
    ResultsTableOpen(results, "map_basins",
                     "point,value,value_2,regime,freq_hz,force_rms_n,force_rms_least_n,force_rms_most_n,runs,of,"
                     "probability,probability_low,probability_high",
                     table));
  PetscFunctionReturn(0);
}

PetscErrorCode MapBasinAdd(Map map, ResultsTable table, const MapBasin *basin)
{
  const MapPoint *r    = &basin->row;
  const PetscReal none = r->end == MAP_FAILED ? NAN : 0;
  char            second[64];

  PetscFunctionBeginUser;
  PetscCall(MapSecond(map, r, second));
  PetscCall(ResultsTableRow(table, "%d,%.15g,%s,%s,%.15g,%.15g,%.15g,%.15g,%d,%d,%.15g,%.15g,%.15g",
                            (int)(r->line * map->axis[0].n + r->place + 1), (double)map->axis[0].value[r->place],
                            second, regimes[r->regime], (double)(r->freq + none), (double)(r->rms + none),
                            (double)(basin->least + none), (double)(basin->most + none), (int)basin->n,
                            (int)map->n_disturbances, (double)basin->n / (double)map->n_disturbances,
                            (double)basin->interval[0], (double)basin->interval[1]));
  PetscFunctionReturn(0);
}

/* Rows of a regime */
static PetscInt MapCount(Map map, MapRegime regime)
{
  PetscInt n = 0;

  for (PetscInt i = 0; i < map->n_rows; i++) n += map->row[i].regime == regime;
  return n;
}

/* Points that vibrate in one direction and are stable in the other */
static PetscInt MapCountBistable(Map map)
{
  PetscInt count = 0;

  for (PetscInt i = 0; i < map->n_rows; i++) count += MapVibrates(&map->row[i]) && MapHangsOnWay(map, &map->row[i]);
  return count;
}

/* Twins that were run */
static PetscInt MapCountTwins(Map map)
{
  PetscInt n = 0;

  for (PetscInt i = 0; i < map->n_rows; i++) n += map->row[i].n_runs - 1;
  return n;
}

/* Points of which map_modes.csv lists some of the growing modes alone */
static PetscInt MapCountCrowded(Map map)
{
  PetscInt n = 0;

  for (PetscInt i = 0; i < map->n_rows; i++) n += map->row[i].n_growing > MAP_MAX_MODES;
  return n;
}

static PetscErrorCode MapViewAxis(const MapAxis *axis, PetscViewer viewer)
{
  PetscFunctionBeginUser;
  PetscCall(PetscViewerASCIIPrintf(viewer, "  %s", axis->moved[0].name));
  for (PetscInt i = 1; i < axis->n_moved; i++) PetscCall(PetscViewerASCIIPrintf(viewer, ", %s", axis->moved[i].name));
  PetscCall(PetscViewerASCIIPrintf(viewer, " %.6g to %.6g %s, %" PetscInt_FMT " values%s\n", (double)axis->value[0],
                                   (double)axis->value[axis->n - 1], axis->moved[0].unit, axis->n,
                                   MapAxisIsBody(axis) ? ", bodies reduced for each" : ""));
  PetscFunctionReturn(0);
}

/* What a run of -map_verify differs by, at the points that vibrate in it as in that of the map */
static PetscErrorCode MapViewError(Map map, MapCheckRun run, PetscViewer viewer)
{
  static const char *const names[] = {"half the step", "contact laws to 1e-12", "2.25 times the cut-off"};
  const MapError          *e       = &map->error[run];

  PetscFunctionBeginUser;
  PetscCall(PetscViewerASCIIPrintf(viewer,
                                   "  %s at %" PetscInt_FMT " points: %" PetscInt_FMT
                                   " of another regime, %" PetscInt_FMT " failed, %" PetscInt_FMT
                                   " vibrate in both runs",
                                   names[run], map->n_verify, e->regime, e->failed, e->n));
  if (e->n)
    PetscCall(PetscViewerASCIIPrintf(viewer, ": force_rms_n off by %.2g %% at most, freq_hz by %.2g",
                                     100 * (double)e->rms, (double)e->freq));
  PetscCall(PetscViewerASCIIPrintf(viewer, "\n"));
  if (run == MAP_HIGHER_CUTOFF && e->failed < map->n_verify)
    PetscCall(PetscViewerASCIIPrintf(
      viewer, "  inertia of all that the cut-off leaves out: growth_rad_s of these points off by %.2g at most\n",
      (double)e->growth));
  PetscFunctionReturn(0);
}

PetscErrorCode MapView(Map map, PetscViewer viewer)
{
  PetscReal steps = 0;
  PetscInt  early = 0;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < map->n_rows; i++) {
    steps += (PetscReal)map->row[i].all_steps;
    early += map->row[i].end < MAP_TIME;
  }
  PetscCall(PetscViewerASCIIPrintf(
    viewer,
    "map: %" PetscInt_FMT " transients of %" PetscInt_FMT " modes below %.6g Hz and %" PetscInt_FMT
    " pairs, steps of %.6g s, of at most %.6g s each\n",
    map->n_rows, map->m, (double)map->cutoff, map->n_pairs, (double)map->dt, (double)map->end));
  if (map->n_resumed)
    PetscCall(PetscViewerASCIIPrintf(viewer, "  %" PetscInt_FMT " of them kept by an earlier run\n", map->n_resumed));
  for (PetscInt k = 0; k < map->n_axes; k++) PetscCall(MapViewAxis(&map->axis[k], viewer));
  PetscCall(PetscViewerASCIIPrintf(viewer, " "));
  for (int k = 0; k < MAP_N_REGIMES; k++)
    PetscCall(PetscViewerASCIIPrintf(viewer, " %s %" PetscInt_FMT "%s", regimes[k], MapCount(map, (MapRegime)k),
                                     k + 1 < MAP_N_REGIMES ? "," : "\n"));
  if (map->n_twins)
    PetscCall(PetscViewerASCIIPrintf(
      viewer,
      "  %" PetscInt_FMT " twins, which begin 1e-9 apart; rounding decides whether %" PetscInt_FMT " rows vibrate\n",
      MapCountTwins(map), MapCount(map, MAP_BISTABLE)));
  if (map->direction == MAP_BOTH)
    PetscCall(PetscViewerASCIIPrintf(viewer, "  %" PetscInt_FMT " points vibrate one way and are stable the other\n",
                                     MapCountBistable(map)));
  if (MapCountCrowded(map))
    PetscCall(PetscViewerASCIIPrintf(
      viewer,
      "  %" PetscInt_FMT " points have more than %d growing modes, of which map_modes.csv lists the fastest %d\n",
      MapCountCrowded(map), MAP_MAX_MODES, MAP_MAX_MODES));
  PetscCall(PetscViewerASCIIPrintf(viewer,
                                   "  %" PetscInt_FMT " transients ended before their time, their regime known; %.0f "
                                   "steps, %.3g s; %" PetscInt_FMT " reductions of the bodies, %.3g s\n",
                                   early, (double)steps, (double)map->seconds[1], map->n_reductions,
                                   (double)map->seconds[0]));
  for (int k = 0; k < MAP_N_REGIMES && map->n_disturbances; k++)
    PetscCall(PetscViewerASCIIPrintf(viewer, "%s %s %" PetscInt_FMT "%s", k ? "" : "  disturbed runs:", regimes[k],
                                     map->disturbed[k], k + 1 < MAP_N_REGIMES ? "," : "\n"));
  if (map->n_taken)
    PetscCall(
      PetscViewerASCIIPrintf(viewer, "  %" PetscInt_FMT " of these runs kept by an earlier run\n", map->n_taken));
  for (int k = 0; k < MAP_N_CHECKS && map->n_verify; k++) PetscCall(MapViewError(map, (MapCheckRun)k, viewer));
  PetscFunctionReturn(0);
}
