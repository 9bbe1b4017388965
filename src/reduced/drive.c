/*
   What acts in the step from t_n: factors of the loads at its end, the way of the prescribed sliding, impulses that fall into it.
*/
#include "reducedimpl.h"

PetscErrorCode ReducedDriveCreate(ReducedRun r)
{
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc3(r->model.n_loads, &r->loads, r->model.n_pairs, &r->sliding, r->model.m, &r->kick));
  PetscCall(PetscMalloc1(r->n_hits, &r->hit_time));
  for (PetscInt i = 0; i < r->n_hits; i++) r->hit_time[i] = -1;
  PetscFunctionReturn(0);
}

void ReducedSetLoads(ReducedRun r, PetscReal t, PetscReal factor[])
{
  const PetscInt n = r->model.n_loads - (ModelHasGravity(r->run.model) ? 1 : 0);

  for (PetscInt i = 0; i < r->model.n_loads; i++)
    factor[i] = i < n && !r->run.from_static ? ExternalGetLoadFactor(r->run.external, i, t) : 1;
}

/* Sum of Phi'J of the impulses that are due before `end` and have not acted; hit is false where there is none */
static PetscErrorCode DriveKick(ReducedRun r, PetscReal end, PetscBool *hit)
{
  const PetscInt m = r->model.m;

  PetscFunctionBeginUser;
  *hit = PETSC_FALSE;
  PetscCall(PetscArrayzero(r->kick, m));
  for (PetscInt i = 0; i < r->n_hits; i++) {
    if (r->hit_time[i] >= 0 || r->hit_due[i] >= end) continue;
    for (PetscInt k = 0; k < m; k++) r->kick[k] += r->hits[m * i + k];
    r->hit_time[i] = r->state.time;
    *hit           = PETSC_TRUE;
  }
  PetscFunctionReturn(0);
}

PetscErrorCode ReducedGetWay(ReducedRun r, PetscInt i, PetscReal *way)
{
  const PetscReal t[2] = {r->state.time, r->state.time + r->dt};
  PetscBool       turning;

  PetscFunctionBeginUser;
  PetscCall(ContactProjectorGetWay(r->run.projector, r->pair[i].interface, t, way, &turning));
  *way *= r->pair[i].speed;
  PetscFunctionReturn(0);
}

PetscErrorCode ReducedDriveSet(ReducedRun r, ReducedDrive *drive)
{
  const PetscReal end = r->state.time + r->dt;
  PetscBool       hit;

  PetscFunctionBeginUser;
  ReducedSetLoads(r, end, r->loads);
  for (PetscInt i = 0; i < r->model.n_pairs; i++) PetscCall(ReducedGetWay(r, i, &r->sliding[i]));
  PetscCall(DriveKick(r, end, &hit));
  *drive = (ReducedDrive){r->loads, r->sliding, hit ? r->kick : NULL};
  PetscFunctionReturn(0);
}
