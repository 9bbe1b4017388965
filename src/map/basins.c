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

#define MAP_KIND    0.02 /* of a main line */
#define BASIN_BATCH 16   /* runs for each rank, after which they are kept and written */

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

  return (MapPoint){.line = point / map->axis[0].n, .place = point % map->axis[0].n, .second = {NAN, NAN}};
}

/* Jobs first .. first + n - 1 on the bodies of their lines, bodies[0] of `line`, or on one for all, shared among the
   ranks; all on every rank */
static PetscErrorCode BasinsRun(Map map, PetscInt line, MapBodies bodies[], PetscInt first, PetscInt n, BasinRun run[])
{
  const PetscInt each = map->n_disturbances * map->axis[0].n;
  PetscInt       k, last = -1, n_own = 0, n_all;
  PetscReal     *rate;
  BasinRun      *own, *all;
  MapMarch       march = NULL;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n, &own));
  PetscCall(PetscMalloc1(1, &rate));
  PetscCall(MapShareBegin(&map->share, map->comm));
  PetscCall(MapShareNext(&map->share, &k));
  while (k < n) {
    const PetscInt at = map->lines_differ ? (first + k) / each - line : 0;

    if (at != last) {
      PetscCall(MapMarchDestroy(&march));
      PetscCall(MapMarchCreate(map, &bodies[at], map->dt, MAP_RTOL, &march));
      PetscCall(PetscFree(rate));
      PetscCall(PetscMalloc1(bodies[at].model.m, &rate));
      last = at;
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

/* Rows of the jobs first .. end - 1, and those of the points that are complete with them; run [all] */
static PetscErrorCode BasinsWrite(Map map, PetscInt first, PetscInt end, BasinRun run[], ResultsTable table[2])
{
  const PetscInt n = map->n_disturbances;
  uint64_t       state;

  PetscFunctionBeginUser;
  for (PetscInt i = first; i < end; i++) {
    map->disturbed[run[i].row.regime]++;
    PetscCall(MapDisturbedAdd(map, table[0], i % n + 1, DrawEnergy(map, i, &state), &run[i].row));
  }
  for (PetscInt i = first / n; i < end / n; i++) PetscCall(BasinsJudge(map, &run[i * n], table[1]));
  for (int k = 0; k < 2; k++) PetscCall(ResultsTableCheck(table[k]));
  PetscFunctionReturn(0);
}

/* Jobs from *first on to the end of some lines: a batch of them is kept once it is complete, so that a killed map loses
   one batch. Bodies are made where something is left to run. */
static PetscErrorCode BasinsLines(Map map, const PetscInt lines[2], MapBodies bodies[], BasinRun run[],
                                  ResultsTable table[2], PetscInt *first)
{
  const PetscInt each = map->n_disturbances * map->axis[0].n, n_bodies = map->lines_differ ? lines[1] - lines[0] : 1;
  const PetscInt all  = each * (map->n_axes > 1 ? map->axis[1].n : 1);
  PetscBool      made = PETSC_FALSE;
  PetscMPIInt    size;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(map->comm, &size));
  for (PetscInt n; *first < lines[1] * each; *first += n) {
    n = all - *first;
    PetscCall(MapResumeRuns(map, *first, sizeof(*run), &n, &run[*first]));
    if (!n) {
      for (PetscInt i = 0; i < n_bodies && !made; i++) PetscCall(MapBodiesGet(map, lines[0] + i, &bodies[i]));
      for (PetscInt i = 0; i < n_bodies && !made; i++) bodies[i].n_hits = 0;
      made = PETSC_TRUE;
      n    = PetscMin(BASIN_BATCH * size, lines[1] * each - *first);
      PetscCall(BasinsRun(map, lines[0], bodies, *first, n, &run[*first]));
      PetscCall(MapKeepRuns(map, *first, sizeof(*run), n, &run[*first]));
    }
    PetscCall(BasinsWrite(map, *first, *first + n, run, table));
  }
  for (PetscInt i = 0; i < n_bodies && made; i++) PetscCall(MapBodiesDestroy(&bodies[i]));
  PetscFunctionReturn(0);
}

PetscErrorCode MapBasins(Map map, Results results)
{
  const PetscInt n_lines = map->n_axes > 1 ? map->axis[1].n : 1, each = map->n_disturbances * map->axis[0].n;
  PetscInt       first = 0, batch;
  PetscMPIInt    size;
  ResultsTable   table[2];
  MapBodies     *bodies;
  BasinRun      *run;

  PetscFunctionBeginUser;
  if (!each) PetscFunctionReturn(0);
  PetscCallMPI(MPI_Comm_size(map->comm, &size));
  PetscCall(MapCountBatch(map, each, 1, &batch));
  PetscCall(PetscCalloc2(batch, &bodies, n_lines * each, &run));
  PetscCall(MapDisturbedOpen(results, &table[0]));
  PetscCall(MapBasinOpen(results, &table[1]));
  PetscCall(ProgressBegin(&map->progress, "disturbed runs", (n_lines * each + size - 1) / size));
  for (PetscInt line = 0; line < n_lines; line += batch)
    PetscCall(BasinsLines(map, (const PetscInt[]){line, PetscMin(line + batch, n_lines)}, bodies, run, table, &first));
  PetscCall(ProgressEnd(&map->progress));
  for (int k = 0; k < 2; k++) PetscCall(ResultsTableClose(&table[k]));
  PetscCall(PetscFree2(bodies, run));
  PetscFunctionReturn(0);
}
