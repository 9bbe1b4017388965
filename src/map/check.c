/*
   What a map cannot do, and what does nothing in it: how a single transient begins, what it records, what comes after
   its end.
*/
#include "mapimpl.h"
#include "reduced/refuse.h"
#include <squeal/options.h>

PetscErrorCode MapCheck(Map map)
{
  const ModelScene       *scene;
  const ContactInterface *c;
  PetscInt                n;
  PetscBool               asked;
  Model                   model;
  Contact                 contact;

  PetscFunctionBeginUser;
  PetscCall(ReducedIsAsked(map->reduced, &asked));
  PetscCheck(asked, map->comm, PETSC_ERR_USER_INPUT, "-analysis map needs -dynamics_model reduced");
  PetscCall(OperatorsGetModel(map->operators, &model, &contact));
  PetscCheck(model && contact, map->comm, PETSC_ERR_USER_INPUT,
             "-analysis map needs a mesh: loaded matrices have no contact surfaces");
  PetscCall(ModelGetScene(model, &scene));
  PetscCall(ContactGetInterfaces(contact, &n, &c));
  for (PetscInt i = 0; i < n; i++)
    PetscCheck(c[i].slides, map->comm, PETSC_ERR_USER_INPUT,
               "contact %s: a map is about sliding; say along what by -%s_slip and -%s_speed", c[i].name, c[i].name,
               c[i].name);
  for (PetscInt i = 0; i < n; i++)
    PetscCheck(!FrictionNeedsPressure(&c[i].friction), map->comm, PETSC_ERR_SUP,
               "contact %s: -%s_friction_law table is for single transients and cycles, not for maps", c[i].name,
               c[i].name);
  PetscCheck(scene->n_loads > 0, map->comm, PETSC_ERR_USER_INPUT, "-analysis map needs -loads that press the contact");
  PetscFunctionReturn(0);
}

/* The first contact of which a pair does not slide, of all ranks; n for none. Also map->bytes, what the dense
   matrices of a line's bodies take. */
static PetscErrorCode CheckFindResting(Map map, Contact contact, PetscInt n, PetscInt *resting)
{
  const ContactPair *pair;
  PetscInt           n_pairs, n_all;

  PetscFunctionBeginUser;
  PetscCall(ContactGetPairs(contact, &n_pairs, &n_all, &pair));
  map->bytes = (1 + 3 * PetscSqr(3 * (PetscReal)n_all)) * sizeof(PetscReal); /* W, Cx, and the step's */
  *resting   = n;
  for (PetscInt i = 0; i < n_pairs; i++)
    if (pair[i].speed == 0) *resting = PetscMin(*resting, pair[i].interface);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, resting, 1, MPIU_INT, MPI_MIN, map->comm));
  PetscFunctionReturn(0);
}

PetscErrorCode MapCheckPrepared(Map map)
{
  const ContactInterface *c;
  PetscInt                n, n_hits, resting;
  Model                   model;
  Contact                 contact;

  PetscFunctionBeginUser;
  PetscCall(ReducedGetHits(map->reduced, &n_hits, NULL, NULL));
  PetscCheck(n_hits > 0, map->comm, PETSC_ERR_USER_INPUT,
             "-analysis map needs -impulses: without a blow at every point squeal would have to grow from rounding");
  PetscCall(OperatorsGetModel(map->operators, &model, &contact));
  PetscCall(ContactGetInterfaces(contact, &n, &c));
  PetscCall(CheckFindResting(map, contact, n, &resting));
  PetscCheck(resting == n, map->comm, PETSC_ERR_USER_INPUT,
             "contact %s: a map is about sliding, and its speed is 0; say it by -%s_speed",
             resting < n ? c[resting].name : "", resting < n ? c[resting].name : "");
  PetscFunctionReturn(0);
}

/* Steps in a window, and windows in the time, of a step dt that may be a whole part of the map's: windows are as
   long with both. */
void MapCountWindows(Map map, PetscReal dt, PetscInt *n_steps, PetscInt *n_windows)
{
  *n_steps   = (PetscInt)(map->window / map->dt + 0.5) * (PetscInt)(map->dt / dt + 0.5);
  *n_windows = (PetscInt)(map->end / ((PetscReal)*n_steps * dt) + 1e-9);
}

/* A window holds 32 steps at least, of which its spectrum is made, and a run eight windows, as `steady` asks for. */
PetscErrorCode MapCheckTimes(Map map)
{
  PetscInt n_steps, n_windows;

  PetscFunctionBeginUser;
  PetscCheck(map->disturbance_least <= map->disturbance, map->comm, PETSC_ERR_USER_INPUT,
             "-map_disturbance_least %.6g J must be at most -map_disturbance %.6g J", (double)map->disturbance_least,
             (double)map->disturbance);
  PetscCheck(map->window >= 32 * map->dt && map->end >= 8 * map->window, map->comm, PETSC_ERR_USER_INPUT,
             "-map_window %.6g s must be 32 steps of %.6g s at least, and -ts_max_time %.6g s 8 windows",
             (double)map->window, (double)map->dt, (double)map->end);
  PetscCheck(map->end <= MAP_MAX_STEPS * map->dt, map->comm, PETSC_ERR_USER_INPUT,
             "-ts_max_time %.6g s is %.3g steps of %.6g s; a point of a map takes at most %.0e", (double)map->end,
             (double)(map->end / map->dt), (double)map->dt, MAP_MAX_STEPS);
  MapCountWindows(map, map->dt, &n_steps, &n_windows);
  PetscCall(ReducedRefuseLate(map->reduced, (PetscReal)n_windows * (PetscReal)n_steps * map->dt));
  PetscFunctionReturn(0);
}
