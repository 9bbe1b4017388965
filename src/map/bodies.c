/*
   Bodies of a line of the map, reduced with its value of the second parameter where that is one of theirs, and what
   acts on them at a place: friction, sliding and loads of the model that belong to the values there.
*/
#include "mapimpl.h"

#define MAP_BATCH 8 /* times the lines that ranks need at once, of which bodies are reduced before any is run */
/* Bytes for their bodies on each rank, 250 MB; the lines that ranks need at once are held whatever they take. */
#define MAP_MEMORY 2.5e8

/* What is kept of a reduced run */
static PetscErrorCode MapBodiesTake(ReducedRun run, MapBodies *b)
{
  ReducedModel    *model;
  const PetscReal *hits, *due;

  PetscFunctionBeginUser;
  PetscCall(ReducedGetModel(run, &model));
  PetscCall(ReducedModelCopy(model, &b->model));
  PetscCall(PetscMalloc1(model->n_pairs, &b->friction));
  PetscCall(PetscArraycpy(b->friction, model->friction, model->n_pairs));
  PetscCall(PetscMalloc1(model->n_pairs, &b->interface));
  for (PetscInt i = 0; i < model->n_pairs; i++) PetscCall(ReducedGetInterface(run, i, &b->interface[i]));
  PetscCall(ReducedGetHits(run, &b->n_hits, &hits, &due));
  PetscCall(PetscMalloc1(b->n_hits * (model->m + 1), &b->hits));
  PetscCall(PetscArraycpy(b->hits, hits, b->n_hits * model->m));
  PetscCall(PetscArraycpy(&b->hits[b->n_hits * model->m], due, b->n_hits));
  PetscFunctionReturn(0);
}

/* Collective. cutoff 0: that of the map. Parameters of the bodies are on the second axis alone (MapAxes()), hence
   one reduction a line. */
PetscErrorCode MapBodiesCreate(Map map, PetscInt line, PetscReal cutoff, MapBodies *b)
{
  const OperatorsParameter *list;
  PetscReal                *p;
  PetscInt                  n;
  ReducedRun                run;

  PetscFunctionBeginUser;
  PetscCall(PetscMemzero(b, sizeof(*b)));
  PetscCall(OperatorsGetParameters(map->operators, &n, &list));
  PetscCall(PetscMalloc1(n, &p));
  PetscCall(PetscArraycpy(p, map->p, n));
  for (PetscInt k = 1; k < map->n_axes; k++)
    for (PetscInt i = 0; i < map->axis[k].n_moved; i++)
      if (map->axis[k].moved[i].kind == REDUCED_BODY) p[map->axis[k].moved[i].index] = map->axis[k].value[line];
  PetscCall(ReducedReduceAt(map->reduced, cutoff, p, NULL, &run));
  PetscCall(MapBodiesTake(run, b));
  PetscCall(ReducedDestroy(&run));
  PetscCall(PetscFree(p));
  map->n_reductions++;
  PetscFunctionReturn(0);
}

/* From the values of the scene, which are kept beside the model: friction, loads (factors) and speeds (m/s) at a
   place. A parameter of the bodies is in them already. */
PetscErrorCode MapBodiesMove(Map map, const MapPoint *at, MapBodies *b, PetscReal speed[], PetscReal loads[])
{
  const PetscInt     n = b->model.n_pairs, index[MAP_MAX_AXES] = {at->place, at->line};
  const ReducedMoved moved = {&b->model, b->interface, b->friction, loads};

  PetscFunctionBeginUser;
  PetscCall(PetscArraycpy(b->model.friction, b->friction, n));
  for (PetscInt i = 0; i < b->model.n_loads; i++) loads[i] = 1;
  for (PetscInt k = 0; k < map->n_axes; k++)
    for (PetscInt i = 0; i < map->axis[k].n_moved; i++)
      ReducedParameterMove(&map->axis[k].moved[i], map->axis[k].value[index[k]], &moved);
  for (PetscInt i = 0; i < n; i++) speed[i] = b->model.friction[i].speed;
  PetscFunctionReturn(0);
}

PetscBool MapBodiesAreHit(const MapBodies *b, PetscReal t)
{
  const PetscReal *due = &b->hits[b->model.m * b->n_hits];

  for (PetscInt i = 0; i < b->n_hits; i++)
    if (due[i] > t) return PETSC_FALSE;
  return PETSC_TRUE;
}

/* Phi'J, m sqrt(kg)/s, of the impulses that act in the step from t, in shares as in reduced/step/drive.c; NULL for
   none. */
const PetscReal *MapBodiesKick(const MapBodies *b, PetscReal t, PetscReal dt, PetscReal kick[])
{
  const PetscInt m   = b->model.m;
  PetscBool      any = PETSC_FALSE;

  for (PetscInt i = 0; i < b->n_hits; i++) {
    const PetscReal share = 1 - PetscAbsReal(b->hits[m * b->n_hits + i] - t) / dt;

    if (!(share > 0)) continue;
    for (PetscInt k = 0; k < m; k++) kick[k] = (any ? kick[k] : 0) + share * b->hits[m * i + k];
    any = PETSC_TRUE;
  }
  return any ? kick : NULL;
}

PetscErrorCode MapBodiesDestroy(MapBodies *b)
{
  PetscFunctionBeginUser;
  PetscCall(ReducedModelDestroy(&b->model));
  PetscCall(PetscFree(b->friction));
  PetscCall(PetscFree(b->interface));
  PetscCall(PetscFree(b->hits));
  PetscFunctionReturn(0);
}

/* How many lines are reduced before their chains are run: enough that no rank waits for bodies (n_jobs chains on
   each), MAP_BATCH times that for the sharing to be even, as memory allows. */
PetscErrorCode MapCountBatch(Map map, PetscInt n_jobs, PetscInt n_bodies, PetscInt *batch)
{
  const PetscInt n_lines = map->n_axes > 1 ? map->axis[1].n : 1;
  PetscMPIInt    size;
  PetscInt       least;

  PetscFunctionBeginUser;
  *batch = n_lines;
  if (!map->lines_differ) PetscFunctionReturn(0);
  PetscCallMPI(MPI_Comm_size(map->comm, &size));
  least  = (size + n_jobs - 1) / n_jobs;
  *batch = PetscMin(MAP_BATCH * least, (PetscInt)(MAP_MEMORY / ((PetscReal)n_bodies * map->bytes)));
  *batch = PetscMin(n_lines, PetscMax(least, *batch));
  PetscFunctionReturn(0);
}
