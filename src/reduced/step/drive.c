/*
   What acts in the step from t_n: factors of the loads at its end, the way of the prescribed sliding, impulses. One at
   T between two times of the run acts at both, in the shares max(0, 1 - |T - t_n| / dt), so that its mean time is T:
   all at one of them would shift the phase of what it starts by up to omega dt.
*/
#include "reduced/reducedimpl.h"

PetscErrorCode ReducedDriveCreate(ReducedRun r)
{
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc3(r->reduction.model.n_loads, &r->motion.loads, r->reduction.model.n_pairs, &r->motion.sliding,
                         r->reduction.model.m, &r->motion.kick));
  PetscFunctionReturn(0);
}

void ReducedSetLoads(ReducedRun r, PetscReal t, PetscReal factor[])
{
  const PetscInt n = r->reduction.model.n_loads - (ModelHasGravity(r->run.model) ? 1 : 0);

  for (PetscInt i = 0; i < r->reduction.model.n_loads; i++)
    factor[i] = i < n && !r->run.from_static ? ExternalGetLoadFactor(r->run.external, i, t) : 1;
}

/* Sum of the shares of Phi'J, m sqrt(kg)/s; hit is false where there is none. Shares of the two times around T add
   up to 1. */
static PetscErrorCode DriveKick(ReducedRun r, PetscBool *hit)
{
  const PetscInt m = r->reduction.model.m;

  PetscFunctionBeginUser;
  *hit = PETSC_FALSE;
  PetscCall(PetscArrayzero(r->motion.kick, m));
  for (PetscInt i = 0; i < r->reduction.n_hits; i++) {
    const PetscReal share = 1 - PetscAbsReal(r->reduction.hit_due[i] - r->motion.state.time) / r->motion.dt;

    if (!(share > 0)) continue;
    for (PetscInt k = 0; k < m; k++) r->motion.kick[k] += share * r->reduction.hits[m * i + k];
    *hit = PETSC_TRUE;
  }
  PetscFunctionReturn(0);
}

/* One that acts in some step before t_n has acted */
PetscErrorCode ReducedReportHits(ReducedRun r)
{
  PetscReal *time;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(r->reduction.n_hits, &time));
  for (PetscInt i = 0; i < r->reduction.n_hits; i++)
    time[i] = r->reduction.hit_due[i] < r->motion.state.time ? r->reduction.hit_due[i] : -1;
  PetscCall(DynamicsWriteImpulses(r->dynamics, r->motion.sums, time));
  PetscCall(PetscFree(time));
  PetscFunctionReturn(0);
}

PetscErrorCode ReducedGetWay(ReducedRun r, PetscInt i, PetscReal *way)
{
  const PetscReal t[2] = {r->motion.state.time, r->motion.state.time + r->motion.dt};
  PetscBool       turning;

  PetscFunctionBeginUser;
  PetscCall(ContactProjectorGetWay(r->run.projector, r->reduction.pair[i].interface, t, way, &turning));
  *way *= r->reduction.pair[i].speed;
  PetscFunctionReturn(0);
}

PetscErrorCode ReducedDriveSet(ReducedRun r, ReducedDrive *drive)
{
  const PetscReal end = r->motion.state.time + r->motion.dt;
  PetscBool       hit;

  PetscFunctionBeginUser;
  ReducedSetLoads(r, end, r->motion.loads);
  for (PetscInt i = 0; i < r->reduction.model.n_pairs; i++) PetscCall(ReducedGetWay(r, i, &r->motion.sliding[i]));
  PetscCall(DriveKick(r, &hit));
  *drive = (ReducedDrive){r->motion.loads, r->motion.sliding, hit ? r->motion.kick : NULL};
  PetscFunctionReturn(0);
}
