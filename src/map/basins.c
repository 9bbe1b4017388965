/*
   Which motion a point ends in: transients from its sliding state with random velocities, -map_disturbances of each
   point, without the scene's impulses, and the probability of each regime.

      eta' = c P xi,   xi_i normal and independent,   |eta'|^2 / 2 = E,

   P the columns of the pairs: what blows of random size at all pairs, in all directions, leave, in any basis of modes.
   log E is uniform from -map_disturbance_least to -map_disturbance, or E is the latter. A run depends on the seed,
   its point and its number alone, hence not on the ranks. Vibrations whose main lines, in order, are further apart than
   MAP_KIND are kinds of their own. The interval of a probability is that of Clopper and Pearson, 95 %
   (base/statistics/estimate.c); it is of these disturbances, of which others have others.
*/
#include "mapimpl.h"
#include "base/gather.h"
#include "base/statistics/estimate.h"

#define MAP_KIND 0.02 /* of a main line */

/* A run that has ended; job: point by point, n_disturbances of each */
typedef struct {
  PetscInt job;
  MapPoint row;
} BasinRun;

/* Between 0 and 1, neither of them: splitmix64 (G. L. Steele, D. Lea, C. H. Flood, OOPSLA 2014) */
static PetscReal DrawNext(uint64_t *state)
{
  uint64_t z = *state += 0x9e3779b97f4a7c15u;

  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  z ^= z >> 31;
  return ((PetscReal)(z >> 12) + 0.5) / 4503599627370496.0;
}

/* By G. E. P. Box and M. E. Muller, Ann. Math. Stat. 29, 1958 */
static PetscReal DrawNormal(uint64_t *state)
{
  const PetscReal radius = PetscSqrtReal(-2 * PetscLogReal(DrawNext(state)));

  return radius * PetscCosReal(2 * PETSC_PI * DrawNext(state));
}

/* The energy of a run, J, and what is drawn next */
static PetscReal DrawEnergy(Map map, PetscInt job, uint64_t *state)
{
  const PetscReal most = map->disturbance, least = map->disturbance_least > 0 ? map->disturbance_least : most;

  *state = (uint64_t)map->seed;
  *state = (uint64_t)(DrawNext(state) * 4503599627370496.0) + 0x632be59bd9b4e019u * (uint64_t)(job + 1);
  return least * PetscPowReal(most / least, DrawNext(state));
}

/* Rates [m] of a run, m sqrt(kg)/s */
static void DrawRates(Map map, PetscInt job, const ReducedModel *model, PetscReal rate[])
{
  uint64_t        state;
  const PetscReal energy = DrawEnergy(map, job, &state);
  PetscReal       square = 0;

  for (PetscInt k = 0; k < model->m; k++) rate[k] = 0;
  for (PetscInt i = 0; i < 3 * model->n_pairs; i++) {
    const PetscReal xi = DrawNormal(&state);

    for (PetscInt k = 0; k < model->m; k++) rate[k] += xi * model->P[i * model->m + k];
  }
  for (PetscInt k = 0; k < model->m; k++) square += PetscSqr(rate[k]);
  for (PetscInt k = 0; k < model->m; k++) rate[k] *= square > 0 ? PetscSqrtReal(2 * energy / square) : 0;
}

static MapPoint BasinPlace(Map map, PetscInt job)
{
  const PetscInt point = job / map->n_disturbances;

  return (MapPoint){.line = point / map->axis[0].n, .place = point % map->axis[0].n};
}

/* Jobs first .. first + n - 1 on the bodies of their lines, or on one for all, shared among the ranks; all on every
   rank */
static PetscErrorCode BasinsRun(Map map, MapBodies bodies[], PetscInt first, PetscInt n, BasinRun run[])
{
  const PetscInt each = map->n_disturbances * map->axis[0].n;
  PetscInt       k, line = -1, n_own = 0, n_all;
  PetscReal     *rate;
  BasinRun      *own, *all;
  MapMarch       march = NULL;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n, &own));
  PetscCall(PetscMalloc1(1, &rate));
  PetscCall(MapShareBegin(&map->share, map->comm));
  PetscCall(MapShareNext(&map->share, &k));
  while (k < n) {
    const PetscInt at = map->lines_differ ? k / each : 0;

    if (at != line) {
      PetscCall(MapMarchDestroy(&march));
      PetscCall(MapMarchCreate(map, &bodies[at], map->dt, MAP_RTOL, &march));
      PetscCall(PetscFree(rate));
      PetscCall(PetscMalloc1(bodies[at].model.m, &rate));
      line = at;
    }
    own[n_own] = (BasinRun){first + k, BasinPlace(map, first + k)};
    DrawRates(map, first + k, &bodies[at].model, rate);
    PetscCall(MapMarchAlone(march, rate, &own[n_own++].row));
    PetscCall(ProgressStep(&map->progress));
    PetscCall(MapShareNext(&map->share, &k));
  }
  PetscCall(MapMarchDestroy(&march));
  PetscCall(GatherRecords(map->comm, n_own, sizeof(*own), own, &n_all, &all));
  for (PetscInt i = 0; i < n_all; i++) run[all[i].job - first] = all[i];
  PetscCall(PetscFree(all));
  PetscCall(PetscFree(rate));
  PetscCall(PetscFree(own));
  PetscFunctionReturn(0);
}

/* Whether run a comes before b: by regime, then by main line */
static PetscBool BasinIsBefore(const MapPoint *a, const MapPoint *b)
{
  return a->regime != b->regime ? (PetscBool)(a->regime < b->regime) : (PetscBool)(a->freq < b->freq);
}

/* Whether run b, which follows a, is of another kind */
static PetscBool BasinDiffers(const MapPoint *a, const MapPoint *b)
{
  return a->regime != b->regime || b->freq - a->freq > MAP_KIND * b->freq ? PETSC_TRUE : PETSC_FALSE;
}

/* Kinds of a point's runs, which are sorted here, and how probable each is */
static PetscErrorCode BasinsJudge(Map map, BasinRun run[], ResultsTable table)
{
  const PetscInt n = map->n_disturbances;

  PetscFunctionBeginUser;
  for (PetscInt i = 1; i < n; i++)
    for (PetscInt j = i; j > 0 && BasinIsBefore(&run[j].row, &run[j - 1].row); j--) {
      const BasinRun other = run[j];

      run[j]     = run[j - 1];
      run[j - 1] = other;
    }
  for (PetscInt i = 0, end; i < n; i = end) {
    MapBasin basin = {.row = run[i].row, .least = run[i].row.rms, .most = run[i].row.rms};

    for (end = i + 1; end < n && !BasinDiffers(&run[end - 1].row, &run[end].row); end++) {
      basin.row.freq += run[end].row.freq;
      basin.row.rms += run[end].row.rms;
      basin.least = PetscMin(basin.least, run[end].row.rms);
      basin.most  = PetscMax(basin.most, run[end].row.rms);
    }
    basin.n = end - i;
    basin.row.freq /= (PetscReal)basin.n;
    basin.row.rms /= (PetscReal)basin.n;
    ClopperPearson(basin.n, basin.n, n, basin.interval);
    PetscCall(MapBasinAdd(map, table, &basin));
  }
  PetscFunctionReturn(0);
}

/* Rows of n jobs, then those of their points */
static PetscErrorCode BasinsWrite(Map map, PetscInt n, BasinRun run[], ResultsTable table[2])
{
  uint64_t state;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < n; i++) {
    const PetscInt number = run[i].job % map->n_disturbances;

    map->disturbed[run[i].row.regime]++;
    PetscCall(MapDisturbedAdd(map, table[0], number + 1, DrawEnergy(map, run[i].job, &state), &run[i].row));
  }
  for (PetscInt i = 0; i < n; i += map->n_disturbances) PetscCall(BasinsJudge(map, &run[i], table[1]));
  for (int k = 0; k < 2; k++) PetscCall(ResultsTableCheck(table[k]));
  PetscFunctionReturn(0);
}

PetscErrorCode MapBasins(Map map, Results results)
{
  const PetscInt n_lines = map->n_axes > 1 ? map->axis[1].n : 1, each = map->n_disturbances * map->axis[0].n;
  PetscInt       batch;
  PetscMPIInt    size;
  ResultsTable   table[2];
  MapBodies     *bodies;
  BasinRun      *run;

  PetscFunctionBeginUser;
  if (!each) PetscFunctionReturn(0);
  PetscCallMPI(MPI_Comm_size(map->comm, &size));
  PetscCall(MapCountBatch(map, each, 1, &batch));
  PetscCall(PetscCalloc2(batch, &bodies, batch * each, &run));
  PetscCall(MapDisturbedOpen(results, &table[0]));
  PetscCall(MapBasinOpen(results, &table[1]));
  PetscCall(ProgressBegin(&map->progress, "disturbed runs", (n_lines * each + size - 1) / size));
  for (PetscInt line = 0; line < n_lines; line += batch) {
    const PetscInt n = PetscMin(batch, n_lines - line), n_bodies = map->lines_differ ? n : 1;

    for (PetscInt i = 0; i < n_bodies; i++) PetscCall(MapBodiesCreate(map, line + i, 0, &bodies[i]));
    for (PetscInt i = 0; i < n_bodies; i++) bodies[i].n_hits = 0;
    PetscCall(BasinsRun(map, bodies, line * each, n * each, run));
    PetscCall(BasinsWrite(map, n * each, run, table));
    for (PetscInt i = 0; i < n_bodies; i++) PetscCall(MapBodiesDestroy(&bodies[i]));
  }
  PetscCall(ProgressEnd(&map->progress));
  for (int k = 0; k < 2; k++) PetscCall(ResultsTableClose(&table[k]));
  PetscCall(PetscFree2(bodies, run));
  PetscFunctionReturn(0);
}
