/*
   The error of the model at some points of a map, on request: the transient from the sliding state of the point, as the
   map runs it where each point stands apart, then with half the step, with tighter contact laws, and with 2.25 times
   the cut-off. Differences are the errors: of amplitude and frequency where both runs vibrate. That of growth, which is
   of the bodies, is told by the inertia of all that the cut-off leaves out: a higher one may hold little of it
   (small_brake_map.yaml at 12 kHz and mu 0.6: 1.174 1/s, beside the mesh 1.175, of which 27 kHz makes 0.32, since the
   pad has no mode in between).
*/
#include "mapimpl.h"
#include "base/gather.h"

#define VERIFY_RTOL   1e-12 /* of the contact laws */
#define VERIFY_RUNS   (1 + MAP_N_CHECKS)
#define VERIFY_BODIES 2 /* of a line: with the map's cut-off, and with the higher one */

/* A transient that has ended */
typedef struct {
  PetscInt job;
  MapPoint row;
} VerifiedPoint;

/* Points first .. last - 1, and the bodies of their lines */
typedef struct {
  PetscInt   first, last;
  PetscInt  *slot; /* [n_verify] of a point's line among the bodies */
  PetscInt   n_lines;
  MapBodies *bodies; /* [n_lines][2] */
} VerifyBatch;

/* The k-th point of n, spread evenly; lines ascend */
static void VerifyPlace(Map map, PetscInt k, MapPoint *row)
{
  const PetscInt n = map->axis[0].n * (map->n_axes > 1 ? map->axis[1].n : 1);
  const PetscInt i = (PetscInt)(((PetscReal)k + 0.5) * (PetscReal)n / (PetscReal)map->n_verify);

  *row = (MapPoint){.line = i / map->axis[0].n, .place = i % map->axis[0].n, .second = {NAN, NAN}};
}

/* The next points, of `most` lines, and their bodies: each line is reduced once for each cut-off */
static PetscErrorCode VerifyBegin(Map map, PetscInt most, VerifyBatch *b)
{
  PetscInt line = -1;

  PetscFunctionBeginUser;
  b->first   = b->last;
  b->n_lines = 0;
  for (; b->last < map->n_verify; b->last++) {
    MapPoint at;

    VerifyPlace(map, b->last, &at);
    if (line < 0 || (map->lines_differ && at.line != line)) {
      if (b->n_lines == most) break;
      PetscCall(MapBodiesCreate(map, at.line, 0, &b->bodies[VERIFY_BODIES * b->n_lines]));
      PetscCall(
        MapBodiesCreate(map, at.line, REDUCED_HIGHER * map->cutoff, &b->bodies[VERIFY_BODIES * b->n_lines + 1]));
      b->n_lines++;
    }
    line             = at.line;
    b->slot[b->last] = b->n_lines - 1;
  }
  PetscFunctionReturn(0);
}

/* One transient, run `job` of all points */
static PetscErrorCode VerifyRunOne(Map map, PetscInt job, const VerifyBatch *b, VerifiedPoint *done)
{
  const PetscInt point = job / VERIFY_RUNS, check = job % VERIFY_RUNS - 1;
  MapMarch       march;

  PetscFunctionBeginUser;
  *done = (VerifiedPoint){.job = job};
  VerifyPlace(map, point, &done->row);
  PetscCall(MapMarchCreate(map, &b->bodies[VERIFY_BODIES * b->slot[point] + (check == MAP_HIGHER_CUTOFF)],
                           check == MAP_HALF_STEP ? map->dt / 2 : map->dt,
                           check == MAP_TIGHT_LAWS ? VERIFY_RTOL : MAP_RTOL, &march));
  PetscCall(MapMarchAlone(march, NULL, &done->row));
  PetscCall(MapMarchDestroy(&march));
  PetscFunctionReturn(0);
}

/* All transients of a batch, row [runs of each of all points], on every rank */
static PetscErrorCode VerifyRunAll(Map map, const VerifyBatch *b, MapPoint row[])
{
  const PetscInt first = VERIFY_RUNS * b->first, n = VERIFY_RUNS * b->last - first;
  PetscInt       n_own = 0, n_all, k;
  VerifiedPoint *own, *all;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(n, &own));
  PetscCall(MapShareBegin(&map->share, map->comm));
  PetscCall(MapShareNext(&map->share, &k));
  while (k < n) {
    PetscCall(VerifyRunOne(map, first + k, b, &own[n_own++]));
    PetscCall(MapShareNext(&map->share, &k));
  }
  PetscCall(GatherRecords(map->comm, n_own, sizeof(*own), own, &n_all, &all));
  for (PetscInt i = 0; i < n_all; i++) row[all[i].job] = all[i].row;
  PetscCall(PetscFree(all));
  PetscCall(PetscFree(own));
  PetscFunctionReturn(0);
}

/* What a run differs by from that of the map: rms relative, frequency in Hz, growth in 1/s; NAN where a run does
   not vibrate, or the check does not tell it. */
static MapError VerifyCompare(const MapPoint *first, const MapPoint *other, MapCheckRun check)
{
  const PetscBool loud  = first->regime != MAP_STABLE && other->regime != MAP_STABLE ? PETSC_TRUE : PETSC_FALSE;
  MapError        error = {.rms = NAN, .freq = NAN, .growth = NAN};

  error.failed = first->end == MAP_FAILED || other->end == MAP_FAILED;
  if (error.failed) return error;
  error.regime = other->regime != first->regime;
  error.n      = loud && !error.regime;
  if (loud) {
    error.rms  = other->rms / first->rms - 1;
    error.freq = other->freq - first->freq;
  }
  if (check == MAP_HIGHER_CUTOFF) error.growth = first->whole - first->growth;
  return error;
}

/* The largest difference becomes that of one more point; NAN are no larger than any */
static void VerifyAdd(const MapError *error, MapError *most)
{
  most->n += error->n;
  most->regime += error->regime;
  most->failed += error->failed;
  if (error->n && PetscAbsReal(error->rms) > most->rms) most->rms = PetscAbsReal(error->rms);
  if (error->n && PetscAbsReal(error->freq) > most->freq) most->freq = PetscAbsReal(error->freq);
  if (PetscAbsReal(error->growth) > most->growth) most->growth = PetscAbsReal(error->growth);
}

static PetscErrorCode VerifyWrite(Map map, const VerifyBatch *b, const MapPoint row[], ResultsTable table)
{
  static const char *const names[MAP_N_CHECKS] = {
    [MAP_HALF_STEP] = "half_step", [MAP_TIGHT_LAWS] = "tight_laws", [MAP_HIGHER_CUTOFF] = "higher_cutoff"};

  PetscFunctionBeginUser;
  for (PetscInt point = b->first; point < b->last; point++) {
    const MapPoint *first = &row[VERIFY_RUNS * point];

    PetscCall(MapErrorsAdd(map, table, "map", first, &(MapError){.rms = NAN, .freq = NAN, .growth = NAN}));
    for (int check = 0; check < MAP_N_CHECKS; check++) {
      const MapError error = VerifyCompare(first, &first[1 + check], (MapCheckRun)check);

      VerifyAdd(&error, &map->error[check]);
      PetscCall(MapErrorsAdd(map, table, names[check], &first[1 + check], &error));
    }
  }
  PetscCall(ResultsTableCheck(table));
  PetscFunctionReturn(0);
}

/* The inertia of what the cut-off leaves out is asked for here (ReducedWeigh()), and costs the map itself nothing.
   Batches keep the memory of bodies within bounds. */
PetscErrorCode MapVerify(Map map, Results results)
{
  PetscInt     most;
  VerifyBatch  batch = {0};
  MapPoint    *row;
  ResultsTable table;

  PetscFunctionBeginUser;
  if (!map->n_verify) PetscFunctionReturn(0);
  PetscCall(ReducedWeigh(map->reduced, PETSC_TRUE));
  PetscCall(MapCountBatch(map, VERIFY_RUNS, VERIFY_BODIES, &most));
  most = map->lines_differ ? PetscMin(most, map->n_verify) : 1;
  PetscCall(
    PetscCalloc3(map->n_verify, &batch.slot, VERIFY_BODIES * most, &batch.bodies, VERIFY_RUNS * map->n_verify, &row));
  PetscCall(MapErrorsOpen(results, &table));
  while (batch.last < map->n_verify) {
    PetscCall(VerifyBegin(map, most, &batch));
    PetscCall(VerifyRunAll(map, &batch, row));
    PetscCall(VerifyWrite(map, &batch, row, table));
    for (PetscInt k = 0; k < VERIFY_BODIES * batch.n_lines; k++) PetscCall(MapBodiesDestroy(&batch.bodies[k]));
  }
  PetscCall(ResultsTableClose(&table));
  PetscCall(PetscFree3(batch.slot, batch.bodies, row));
  PetscFunctionReturn(0);
}
