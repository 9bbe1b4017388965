/*
   The error of the model at some points of a map, on request: the transient from the sliding state of the point, as the map runs
   it where each point stands apart, then with half the step, and with 1.5 times the cut-off. Differences are the errors.
*/
#include "mapimpl.h"
#include "base/gather.h"

#define VERIFY_HIGHER 1.5 /* times the cut-off */
#define VERIFY_RUNS   3   /* of a point: */

enum { VERIFY_MAP, VERIFY_STEP, VERIFY_CUTOFF };

/* A transient that has ended */
typedef struct {
  PetscInt job;
  MapPoint row;
} VerifiedPoint;

/* The k-th point of n, spread evenly */
static void VerifyPlace(Map map, PetscInt k, MapPoint *row)
{
  const PetscInt n = map->axis[0].n * (map->n_axes > 1 ? map->axis[1].n : 1);
  const PetscInt i = (PetscInt)(((PetscReal)k + 0.5) * (PetscReal)n / (PetscReal)map->n_verify);

  *row = (MapPoint){.line = i / map->axis[0].n, .place = i % map->axis[0].n};
}

/* Bodies of the points at both cut-offs, [2] of each point or of all */
static PetscErrorCode VerifyCreateBodies(Map map, PetscInt n, MapBodies bodies[])
{
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < n; k++) {
    MapPoint at;

    VerifyPlace(map, k, &at);
    PetscCall(MapBodiesCreate(map, at.line, 0, &bodies[2 * k]));
    PetscCall(MapBodiesCreate(map, at.line, VERIFY_HIGHER * map->cutoff, &bodies[2 * k + 1]));
  }
  PetscFunctionReturn(0);
}

/* One transient */
static PetscErrorCode VerifyRunOne(Map map, PetscInt job, MapBodies bodies[], VerifiedPoint *done)
{
  const PetscInt point = job / VERIFY_RUNS, kind = job % VERIFY_RUNS;
  MapMarch       march;

  PetscFunctionBeginUser;
  *done = (VerifiedPoint){.job = job};
  VerifyPlace(map, point, &done->row);
  PetscCall(MapMarchCreate(map, &bodies[2 * (map->lines_differ ? point : 0) + (kind == VERIFY_CUTOFF)],
                           kind == VERIFY_STEP ? map->dt / 2 : map->dt, &march));
  PetscCall(MapMarchAlone(march, &done->row));
  PetscCall(MapMarchDestroy(&march));
  PetscFunctionReturn(0);
}

/* All transients [runs of each point], on every rank */
static PetscErrorCode VerifyRunAll(Map map, MapBodies bodies[], MapPoint row[])
{
  const PetscInt n     = VERIFY_RUNS * map->n_verify;
  PetscInt       n_own = 0, n_all, k;
  VerifiedPoint *own, *all;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(n, &own));
  PetscCall(MapShareBegin(&map->share, map->comm));
  PetscCall(MapShareNext(&map->share, &k));
  while (k < n) {
    PetscCall(VerifyRunOne(map, k, bodies, &own[n_own++]));
    PetscCall(MapShareNext(&map->share, &k));
  }
  PetscCall(GatherRecords(map->comm, n_own, sizeof(*own), own, &n_all, &all));
  for (PetscInt i = 0; i < n_all; i++) row[all[i].job] = all[i].row;
  PetscCall(PetscFree(all));
  PetscCall(PetscFree(own));
  PetscFunctionReturn(0);
}

/* What a run differs by from that of the map, and the largest of all points */
static void VerifyCompare(const MapPoint *first, const MapPoint *other, MapError *error, MapError *most)
{
  *error = (MapError){.regime = other->regime != first->regime,
                      .rms    = other->rms / first->rms - 1,
                      .freq   = other->freq - first->freq,
                      .growth = other->growth - first->growth};
  most->regime += error->regime;
  if (error->regime || first->regime == MAP_UNKNOWN) return;
  if (first->regime != MAP_STABLE) most->rms = PetscMax(most->rms, PetscAbsReal(error->rms));
  most->freq   = PetscMax(most->freq, PetscAbsReal(error->freq));
  most->growth = PetscMax(most->growth, PetscAbsReal(error->growth));
}

static PetscErrorCode VerifyWrite(Map map, const MapPoint row[], Results results)
{
  ResultsTable table;

  PetscFunctionBeginUser;
  PetscCall(MapErrorsOpen(results, &table));
  for (PetscInt i = 0; i < VERIFY_RUNS * map->n_verify; i++) {
    const PetscInt kind = i % VERIFY_RUNS;
    MapError       error, none = {0};

    VerifyCompare(&row[i - kind], &row[i], &error, kind == VERIFY_MAP ? &none : &map->error[kind - 1]);
    PetscCall(MapErrorsAdd(map, table,
                           kind == VERIFY_MAP    ? "map"
                           : kind == VERIFY_STEP ? "half_step"
                                                 : "higher_cutoff",
                           &row[i], &error));
  }
  PetscCall(ResultsTableClose(&table));
  PetscFunctionReturn(0);
}

PetscErrorCode MapVerify(Map map, Results results)
{
  const PetscInt n = map->lines_differ ? map->n_verify : 1;
  MapBodies     *bodies;
  MapPoint      *row;

  PetscFunctionBeginUser;
  if (!map->n_verify) PetscFunctionReturn(0);
  PetscCall(PetscCalloc1(2 * n, &bodies));
  PetscCall(PetscCalloc1(VERIFY_RUNS * map->n_verify, &row));
  PetscCall(VerifyCreateBodies(map, n, bodies));
  PetscCall(VerifyRunAll(map, bodies, row));
  PetscCall(VerifyWrite(map, row, results));
  for (PetscInt k = 0; k < 2 * n; k++) PetscCall(MapBodiesDestroy(&bodies[k]));
  PetscCall(PetscFree(row));
  PetscCall(PetscFree(bodies));
  PetscFunctionReturn(0);
}
