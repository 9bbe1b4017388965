/*
   Map: life cycle, options, and the flow: axes -> bodies of some lines -> their chains, shared among the ranks -> rows.
*/
#include "mapimpl.h"
#include "reduced/refuse.h"
#include "base/gather.h"
#include "base/process/progress.h"
#include <squeal/options.h>
#include <petsctime.h>

PetscErrorCode MapCreate(MPI_Comm comm, Map *map)
{
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(1, map));
  (*map)->comm = comm;
  PetscCall(QuantitiesInit(&map_quantities, *map));
  PetscFunctionReturn(0);
}

PetscErrorCode MapSetFromOptions(Map map)
{
  PetscFunctionBeginUser;
  PetscCall(QuantitiesRead(map->comm, &map_quantities, map));
  PetscFunctionReturn(0);
}

PetscErrorCode MapVisit(Map map, const QuantityVisitor *visitor)
{
  PetscFunctionBeginUser;
  PetscCall(QuantitiesVisit(visitor, &map_quantities, NULL, map, NULL));
  PetscFunctionReturn(0);
}

PetscErrorCode MapSetModes(Map map, Modes modes)
{
  PetscFunctionBeginUser;
  PetscCall(ModesGetLimit(modes, &map->limit));
  PetscFunctionReturn(0);
}

PetscErrorCode MapSetRooms(Map map, ReducedRun reduced, Operators operators, const PetscReal p[])
{
  PetscFunctionBeginUser;
  map->reduced   = reduced;
  map->operators = operators;
  PetscCall(PetscFree(map->p));
  PetscCall(OperatorsCreatePoint(operators, p, &map->p));
  PetscFunctionReturn(0);
}

/* Where a point stands among all rows: lines, directions, places */
static PetscInt MapRowIndex(Map map, const MapPoint *row)
{
  const PetscInt both = map->direction == MAP_BOTH ? 1 : 0;

  return ((1 + both) * row->line + both * row->down) * map->axis[0].n + row->place;
}

/* Rows of the ranks, of chains ends[0] .. ends[1] - 1, to their places in map->row on every rank, and to the tables
   in the order of the chains, whichever rank ran them. Collective. */
static PetscErrorCode MapTakeRows(Map map, PetscInt n, const MapPoint row[], const PetscInt ends[2],
                                  ResultsTable table[2])
{
  MapPoint *all;
  PetscInt  n_all;

  PetscFunctionBeginUser;
  PetscCall(GatherRecords(map->comm, n, sizeof(*row), row, &n_all, &all));
  for (PetscInt i = 0; i < n_all; i++) map->row[MapRowIndex(map, &all[i])] = all[i];
  PetscCall(PetscFree(all));
  map->n_rows += n_all;
  for (PetscInt i = ends[0] * map->n_linked; i < ends[1] * map->n_linked; i++) {
    MapPoint at;

    MapChainPlace(map, i / map->n_linked, i % map->n_linked, &at);
    PetscCall(MapTableAdd(map, table[0], &map->row[MapRowIndex(map, &at)]));
    PetscCall(MapModesAdd(map, table[1], &map->row[MapRowIndex(map, &at)]));
  }
  for (int k = 0; k < 2; k++) PetscCall(ResultsTableCheck(table[k]));
  PetscFunctionReturn(0);
}

/* Chains ends[0] .. ends[1] - 1 on these bodies [lines], or on one for all; row [their points], of which n are this
   rank's. The march, with its factors, is kept from chain to chain of one line. */
static PetscErrorCode MapShareChains(Map map, MapBodies bodies[], const PetscInt ends[2], PetscInt *n, MapPoint row[])
{
  PetscInt k, line = -1;
  MapMarch march = NULL;

  PetscFunctionBeginUser;
  *n = 0;
  PetscCall(MapShareBegin(&map->share, map->comm));
  PetscCall(MapShareNext(&map->share, &k));
  while (k < ends[1] - ends[0]) {
    const PetscInt own = map->lines_differ ? k / map->n_ways : 0;

    if (own != line) PetscCall(MapMarchDestroy(&march));
    if (own != line) PetscCall(MapMarchCreate(map, &bodies[own], map->dt, MAP_RTOL, &march));
    line = own;
    PetscCall(MapChain(march, ends[0] + k, &row[*n]));
    *n += map->n_linked;
    PetscCall(MapShareNext(&map->share, &k));
  }
  PetscCall(MapMarchDestroy(&march));
  PetscFunctionReturn(0);
}

/* All lines */
static PetscErrorCode MapLines(Map map, ResultsTable table[2])
{
  const PetscInt n_lines = map->n_axes > 1 ? map->axis[1].n : 1;
  PetscInt       batch, n_own;
  PetscLogDouble begin, ready, end;
  MapBodies     *bodies;
  MapPoint      *row;

  PetscFunctionBeginUser;
  PetscCall(MapCountBatch(map, map->n_ways, 1, &batch));
  PetscCall(PetscCalloc1(batch, &bodies));
  PetscCall(PetscCalloc1(batch * map->n_ways * map->n_linked, &row));
  for (PetscInt line = 0; line < n_lines; line += batch) {
    const PetscInt n = PetscMin(batch, n_lines - line), n_bodies = map->lines_differ ? n : 1;
    const PetscInt ends[2] = {map->n_ways * line, map->n_ways * (line + n)};

    PetscCall(PetscTime(&begin));
    for (PetscInt i = 0; i < n_bodies; i++) PetscCall(MapBodiesGet(map, line + i, &bodies[i]));
    PetscCall(PetscTime(&ready));
    PetscCall(MapShareChains(map, bodies, ends, &n_own, row));
    PetscCall(MapTakeRows(map, n_own, row, ends, table));
    for (PetscInt i = 0; i < n_bodies; i++) PetscCall(MapBodiesDestroy(&bodies[i]));
    PetscCall(PetscTime(&end));
    map->seconds[0] += ready - begin;
    map->seconds[1] += end - ready;
  }
  PetscCall(PetscFree(row));
  PetscCall(PetscFree(bodies));
  PetscFunctionReturn(0);
}

/* A chain has n_linked points: a line in one direction, or a single point where all stand apart; n_ways chains for
   each line. */
static PetscErrorCode MapSetUp(Map map, Results results)
{
  PetscInt n_points;

  PetscFunctionBeginUser;
  PetscCall(MapCheck(map));
  PetscCall(ReducedPrepare(map->reduced, results));
  PetscCall(ReducedRefuseVarying(map->reduced, "-analysis map"));
  PetscCall(MapCheckPrepared(map));
  PetscCall(MapAxes(map));
  PetscCall(ReducedGetRun(map->reduced, &map->cutoff, &map->dt, &map->end));
  PetscCall(MapCheckTimes(map));
  map->n_ways   = map->direction == MAP_BOTH ? 2 : map->direction == MAP_APART ? map->axis[0].n : 1;
  map->n_linked = map->direction == MAP_APART ? 1 : map->axis[0].n;
  n_points      = map->axis[0].n * (map->n_axes > 1 ? map->axis[1].n : 1);
  if (map->n_axes > 1) map->lines_differ = MapAxisIsBody(&map->axis[1]);
  PetscCheck(map->n_verify <= n_points, map->comm, PETSC_ERR_USER_INPUT,
             "-map_verify %" PetscInt_FMT " must be at most the %" PetscInt_FMT " points of the map", map->n_verify,
             n_points);
  PetscCall(ResultsGetDirectory(results, &map->folder));
  PetscCall(MapJournalOpen(map, results));
  PetscFunctionReturn(0);
}

/* Collective. Bodies are reduced by all ranks together, chains run by one each; rows are gathered after each batch,
   so that a table grows as the map does. */
PetscErrorCode MapSolve(Map map, Results results)
{
  PetscInt     n_rows;
  PetscMPIInt  size;
  ResultsTable table[2];

  PetscFunctionBeginUser;
  PetscCall(MapSetUp(map, results));
  n_rows = map->n_ways * map->n_linked * (map->n_axes > 1 ? map->axis[1].n : 1);
  PetscCall(PetscCalloc1(n_rows, &map->row));
  PetscCallMPI(MPI_Comm_size(map->comm, &size));
  PetscCall(MapTableOpen(results, &table[0]));
  PetscCall(MapModesOpen(results, &table[1]));
  PetscCall(MapShareCreate(map->comm, &map->share));
  PetscCall(ProgressBegin(&map->progress, "points of the map", (n_rows + size - 1) / size));
  PetscCall(MapLines(map, table));
  PetscCall(ProgressEnd(&map->progress));
  for (int k = 0; k < 2; k++) PetscCall(ResultsTableClose(&table[k])); /* before what may take longer */
  PetscCall(MapVerify(map, results));
  PetscCall(MapBasins(map, results));
  PetscCall(MapShareDestroy(&map->share));
  PetscCall(MapForget(map));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &map->n_resumed, 1, MPIU_INT, MPI_SUM, map->comm));
  PetscFunctionReturn(0);
}

/* A point that failed is an answer of the map; none that succeeded is an error. */
PetscErrorCode MapJudge(Map map)
{
  static const char *const why[MAP_N_FAULTS] = {[MAP_NO_STATE]  = "no sliding state balances the loads",
                                                [MAP_NO_FORCES] = "the contact forces do not converge",
                                                [MAP_NO_NUMBER] = "the motion grows beyond all numbers",
                                                [MAP_MADE]      = "normal contact, which does no work, feeds the "
                                                                  "motion: take a lower -dynamics_cutoff, or look "
                                                                  "at the point by -dynamics_model full"};
  const MapPoint          *first             = NULL;
  PetscInt                 n                 = 0;
  char                     text[512], other[320] = "";

  PetscFunctionBeginUser;
  for (PetscInt i = map->n_rows - 1; i >= 0; i--)
    if (map->row[i].end == MAP_FAILED) first = &map->row[i], n++;
  if (!n) PetscFunctionReturn(0);
  if (map->n_axes > 1)
    PetscCall(PetscSNPrintf(other, sizeof(other), ", %s %.6g", map->axis[1].moved[0].name,
                            (double)map->axis[1].value[first->line]));
  PetscCall(PetscSNPrintf(text, sizeof(text), "point %" PetscInt_FMT ", %s %.6g%s: %s",
                          first->line * map->axis[0].n + first->place + 1, map->axis[0].moved[0].name,
                          (double)map->axis[0].value[first->place], other, why[first->fault]));
  PetscCheck(n < map->n_rows, map->comm, PETSC_ERR_NOT_CONVERGED,
             "-analysis map: none of %" PetscInt_FMT " transients succeeded; the first is %s", n, text);
  PetscCall(PetscFPrintf(map->comm, stderr,
                         "squeal: warning: -analysis map: %" PetscInt_FMT " of %" PetscInt_FMT
                         " transients failed; the first is %s\n",
                         n, map->n_rows, text));
  PetscFunctionReturn(0);
}

PetscErrorCode MapDestroy(Map *map)
{
  PetscFunctionBeginUser;
  if (!*map) PetscFunctionReturn(0);
  for (PetscInt k = 0; k < MAP_MAX_AXES; k++) PetscCall(PetscFree((*map)->axis[k].value));
  PetscCall(PetscFree((*map)->row));
  PetscCall(PetscFree((*map)->p));
  PetscCall(ChecksumDestroy(&(*map)->journal.scene));
  PetscCall(PetscFree(*map));
  PetscFunctionReturn(0);
}
