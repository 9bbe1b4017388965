/*
   What acts in the step from t_n: factors of the loads and of friction at its end, the way of the prescribed sliding,
   impulses. One at
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
  const ReducedModel *model = &r->reduction.model;
  const PetscInt      first = model->n_loads - (model->dragged ? 2 : 1) * model->n_motions;
  const PetscInt      n     = first - (ModelHasGravity(r->run.model) ? 1 : 0);

  for (PetscInt i = 0; i < first; i++) factor[i] = i < n ? RampValue(ExternalGetLoad(r->run.external, i), t) : 1;
  for (PetscInt i = 0; i < model->n_motions; i++) {
    const Ramp *ramp = ExternalGetMotion(r->run.external, i);

    factor[first + i] = RampValue(ramp, t);
    if (model->dragged) factor[first + model->n_motions + i] = RampRate(ramp, t);
  }
}

void ReducedSetSteadyLoads(ReducedRun r, PetscReal t, PetscReal factor[])
{
  const ReducedModel *model   = &r->reduction.model;
  PetscReal          *motions = &factor[ReducedFirstMotion(model) - 3 * model->n_pairs];
  const ModelScene   *scene;

  (void)ModelGetScene(r->run.model, &scene);
  ReducedSetLoads(r, t, factor);
  for (PetscInt i = 0; i < scene->n_loads; i++)
    if (scene->loads[i].swings) factor[i] = 0;
  for (PetscInt i = 0; i < model->n_motions; i++) {
    if (scene->motions[i].swings) motions[i] = 0;
    if (model->dragged) motions[model->n_motions + i] = 0;
  }
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

PetscErrorCode ReducedSetFriction(ReducedRun r, PetscReal t, PetscBool *changed)
{
  PetscFunctionBeginUser;
  *changed = PETSC_FALSE;
  for (PetscInt i = 0; i < r->reduction.model.n_pairs; i++) {
    const ContactPair *pair     = &r->reduction.pair[i];
    FrictionLaw       *friction = &r->reduction.model.friction[i];
    PetscReal          factor;
    PetscBool          varies;

    PetscCall(ContactProjectorGetFriction(r->run.projector, pair->interface, t, &factor, &varies));
    if (!varies) continue;
    *friction = FrictionOfPair(&r->run.interfaces[pair->interface].friction, pair->speed, pair->area);
    FrictionScale(friction, factor);
    *changed = PETSC_TRUE;
  }
  PetscFunctionReturn(0);
}

PetscErrorCode ReducedDriveSet(ReducedRun r, ReducedDrive *drive)
{
  const PetscReal end = r->motion.state.time + r->motion.dt;
  PetscBool       hit, changed;

  PetscFunctionBeginUser;
  PetscCall(ReducedSetFriction(r, end, &changed));
  if (changed) PetscCall(ReducedStepperTakeFriction(r->motion.stepper));
  ReducedSetLoads(r, end, r->motion.loads);
  for (PetscInt i = 0; i < r->reduction.model.n_pairs; i++) PetscCall(ReducedGetWay(r, i, &r->motion.sliding[i]));
  PetscCall(DriveKick(r, &hit));
  *drive = (ReducedDrive){r->motion.loads, r->motion.sliding, hit ? r->motion.kick : NULL};
  PetscFunctionReturn(0);
}
