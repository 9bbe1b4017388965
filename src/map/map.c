/*
   Map: life cycle, options, and the flow: axes -> bodies of some lines -> their chains, shared among the ranks -> rows.
*/
#include "mapimpl.h"
#include "base/gather.h"
#include "base/progress.h"
#include <squeal/options.h>
#include <petsctime.h>

#define WINDOW 5e-3 /* s */
#define RTOL   0.01

PetscErrorCode MapCreate(MPI_Comm comm, Map *map)
{
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(1, map));
  (*map)->comm    = comm;
  (*map)->window  = WINDOW;
  (*map)->rtol    = RTOL;
  (*map)->restart = PETSC_TRUE;
  PetscFunctionReturn(0);
}

PetscErrorCode MapSetFromOptions(Map map)
{
  static const char *const directions[] = {"both", "up", "down", "apart"};
  PetscInt                 direction    = 0;

  PetscFunctionBeginUser;
  PetscOptionsBegin(map->comm, NULL, "Map", NULL);
  PetscCall(PetscOptionsString("-map_parameter", "one or two options of the scene to vary, e.g. contact_mu,press_force",
                               "map.h", map->parameter, map->parameter, sizeof(map->parameter), NULL));
  PetscCall(PetscOptionsString("-map_values", "first:last:n, first:last:n:log, or v1,v2,... in the parameter's unit",
                               "map.h", map->values[0], map->values[0], sizeof(map->values[0]), NULL));
  PetscCall(PetscOptionsString("-map_values_2", "those of the second parameter", "map.h", map->values[1],
                               map->values[1], sizeof(map->values[1]), NULL));
  PetscCall(PetscOptionsString("-map_link", "parameters that take the same value, e.g. inner_mu,outer_mu; ':' between",
                               "map.h", map->link, map->link, sizeof(map->link), &map->linked));
  PetscCall(PetscOptionsEList("-map_direction",
                              "ways through the values of the first parameter, each from the end of "
                              "its neighbour, or every point from its own sliding state",
                              "map.h", directions, 4, directions[0], &direction, NULL));
  PetscCall(PetscOptionsReal("-map_window", "of which amplitude and frequency are taken, s", "map.h", map->window,
                             &map->window, NULL));
  PetscCall(PetscOptionsReal("-map_rtol", "change of the rms between windows below which an amplitude is settled",
                             "map.h", map->rtol, &map->rtol, NULL));
  PetscCall(OptionsGetBool(PetscOptionsObject, "-map_restart",
                           "go on where a map of the same scene in -output_dir was "
                           "stopped",
                           &map->restart));
  PetscOptionsEnd();
  PetscCheck(map->window > 0 && map->window < 1e6, map->comm, PETSC_ERR_USER_INPUT,
             "-map_window %.6g must be a positive time (s)", (double)map->window);
  PetscCheck(map->rtol > 0 && map->rtol < 1, map->comm, PETSC_ERR_USER_INPUT, "-map_rtol %.6g must lie between 0 and 1",
             (double)map->rtol);
  map->direction = (MapDirection)direction;
  PetscFunctionReturn(0);
}

PetscErrorCode MapSetRooms(Map map, ReducedRun reduced, Operators operators, const PetscReal p[])
{
  const OperatorsParameter *list;
  PetscInt                  n;

  PetscFunctionBeginUser;
  map->reduced   = reduced;
  map->operators = operators;
  PetscCall(OperatorsGetParameters(operators, &n, &list));
  PetscCall(PetscFree(map->p));
  PetscCall(OperatorsCreatePoint(operators, &map->p));
  if (p) PetscCall(PetscArraycpy(map->p, p, n));
  PetscFunctionReturn(0);
}

/* Rows of a round, in the order of the chains */
static PetscErrorCode MapTakeRound(Map map, PetscInt n, const MapPoint row[], ResultsTable table[2])
{
  MapPoint *all;
  PetscInt  n_all;

  PetscFunctionBeginUser;
  PetscCall(GatherRecords(map->comm, n, sizeof(*row), row, &n_all, &all));
  for (PetscInt i = 0; i < n_all; i++) {
    PetscCall(MapTableAdd(map, table[0], &all[i]));
    PetscCall(MapModesAdd(map, table[1], &all[i]));
    map->row[map->n_rows++] = all[i];
  }
  for (int k = 0; k < 2; k++) PetscCall(ResultsTableCheck(table[k]));
  PetscCall(PetscFree(all));
  PetscFunctionReturn(0);
}

/* Chains first .. last - 1 on these bodies [lines], or on one for all */
static PetscErrorCode MapRounds(Map map, MapBodies bodies[], PetscInt first, PetscInt last, ResultsTable table[2])
{
  const PetscInt  n = map->axis[0].n, n_ways = map->direction == MAP_BOTH ? 2 : 1;
  const PetscBool each = map->n_axes > 1 && MapAxisIsBody(&map->axis[1]) ? PETSC_TRUE : PETSC_FALSE;
  PetscMPIInt     rank, size;
  MapPoint       *row;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(map->comm, &rank));
  PetscCallMPI(MPI_Comm_size(map->comm, &size));
  PetscCall(PetscCalloc1(n, &row));
  for (PetscInt round = first; round < last; round += size) {
    const PetscInt chain = round + rank;

    if (chain < last) PetscCall(MapChain(map, &bodies[each ? (chain - first) / n_ways : 0], chain, row));
    PetscCall(MapTakeRound(map, chain < last ? n : 0, row, table));
  }
  PetscCall(PetscFree(row));
  PetscFunctionReturn(0);
}

/* Bodies that an earlier run has kept, or made and kept */
static PetscErrorCode MapBodiesGet(Map map, PetscInt line, MapBodies *bodies)
{
  PetscBool good;

  PetscFunctionBeginUser;
  PetscCall(MapResumeBodies(map, line, bodies, &good));
  if (!good) PetscCall(MapBodiesCreate(map, line, bodies));
  if (!good) PetscCall(MapKeepBodies(map, line, bodies));
  map->m       = bodies->model.m;
  map->n_pairs = bodies->model.n_pairs;
  PetscFunctionReturn(0);
}

/* All lines, some at a time where each has bodies of its own: so many that no rank is idle */
static PetscErrorCode MapLines(Map map, ResultsTable table[2])
{
  const PetscInt  n_ways = map->direction == MAP_BOTH ? 2 : 1, n_lines = map->n_axes > 1 ? map->axis[1].n : 1;
  const PetscBool each = map->n_axes > 1 && MapAxisIsBody(&map->axis[1]) ? PETSC_TRUE : PETSC_FALSE;
  PetscMPIInt     size;
  PetscInt        batch;
  PetscLogDouble  begin, ready, end;
  MapBodies      *bodies;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(map->comm, &size));
  batch = each ? (size + n_ways - 1) / n_ways : n_lines;
  PetscCall(PetscCalloc1(batch, &bodies));
  for (PetscInt line = 0; line < n_lines; line += batch) {
    const PetscInt n = PetscMin(batch, n_lines - line), n_bodies = each ? n : 1;

    PetscCall(PetscTime(&begin));
    for (PetscInt i = 0; i < n_bodies; i++) PetscCall(MapBodiesGet(map, line + i, &bodies[i]));
    PetscCall(PetscTime(&ready));
    PetscCall(MapRounds(map, bodies, n_ways * line, n_ways * (line + n), table));
    for (PetscInt i = 0; i < n_bodies; i++) PetscCall(MapBodiesDestroy(&bodies[i]));
    PetscCall(PetscTime(&end));
    map->seconds[0] += ready - begin;
    map->seconds[1] += end - ready;
  }
  PetscCall(PetscFree(bodies));
  PetscFunctionReturn(0);
}

PetscErrorCode MapSolve(Map map, Results results)
{
  const PetscInt n_ways = map->direction == MAP_BOTH ? 2 : 1;
  PetscInt       n_rows;
  PetscMPIInt    size;
  ResultsTable   table[2];

  PetscFunctionBeginUser;
  PetscCall(MapCheck(map));
  PetscCall(ReducedPrepare(map->reduced, results));
  PetscCall(MapAxes(map));
  PetscCall(ReducedGetRun(map->reduced, &map->cutoff, &map->dt, &map->end));
  PetscCheck(map->window >= 32 * map->dt && map->end >= 8 * map->window, map->comm, PETSC_ERR_USER_INPUT,
             "-map_window %.6g s must be 32 steps of %.6g s at least, and -ts_max_time %.6g s 8 windows",
             (double)map->window, (double)map->dt, (double)map->end);
  PetscCheck(map->end <= MAP_MAX_STEPS * map->dt, map->comm, PETSC_ERR_USER_INPUT,
             "-ts_max_time %.6g s is %.3g steps of %.6g s; a point of a map takes at most %.0e", (double)map->end,
             (double)(map->end / map->dt), (double)map->dt, MAP_MAX_STEPS);
  n_rows = n_ways * map->axis[0].n * (map->n_axes > 1 ? map->axis[1].n : 1);
  PetscCall(PetscCalloc1(n_rows, &map->row));
  PetscCallMPI(MPI_Comm_size(map->comm, &size));
  PetscCall(ResultsGetDirectory(results, &map->folder));
  PetscCall(MapSumScene(map));
  PetscCall(MapTableOpen(results, &table[0]));
  PetscCall(MapModesOpen(results, &table[1]));
  PetscCall(ProgressBegin(&map->progress, "points of the map", (n_rows + size - 1) / size));
  PetscCall(MapLines(map, table));
  PetscCall(ProgressEnd(&map->progress));
  for (int k = 0; k < 2; k++) PetscCall(ResultsTableClose(&table[k]));
  PetscCall(MapForget(map));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &map->n_resumed, 1, MPIU_INT, MPI_SUM, map->comm));
  PetscFunctionReturn(0);
}

PetscErrorCode MapDestroy(Map *map)
{
  PetscFunctionBeginUser;
  if (!*map) PetscFunctionReturn(0);
  for (PetscInt k = 0; k < MAP_MAX_AXES; k++) PetscCall(PetscFree((*map)->axis[k].value));
  PetscCall(PetscFree((*map)->row));
  PetscCall(PetscFree((*map)->p));
  PetscCall(PetscFree(*map));
  PetscFunctionReturn(0);
}
