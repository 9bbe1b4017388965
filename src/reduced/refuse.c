/*
   What a reduced model cannot do, by name, and what does nothing where no transient runs from its beginning to its end.
*/
#include "reducedimpl.h"
#include "idle.h"
#include <squeal/options.h>

PetscErrorCode ReducedRefuse(ReducedRun r)
{
  const ModelScene *scene;

  PetscFunctionBeginUser;
  PetscCall(ModelGetScene(r->run.model, &scene));
  for (PetscInt i = 0; i < r->run.n_interfaces; i++) {
    PetscReal way;
    PetscBool turning;

    PetscCall(ContactProjectorGetWay(r->run.projector, i, (const PetscReal[]){0, 1}, &way, &turning));
    PetscCheck(!turning, r->comm, PETSC_ERR_SUP,
               "-%s_kinematics turning: a reduced model keeps the pairs of the mesh, and no body can turn under the "
               "other; take prescribed sliding, or -dynamics_model full",
               r->run.interfaces[i].name);
  }
  PetscCheck(!scene->n_motions, r->comm, PETSC_ERR_SUP,
             "motion %s: a reduced model knows no prescribed motions; -dynamics_model full does",
             scene->n_motions ? scene->motions[0].name : "");
  PetscCheck(r->run.n_interfaces, r->comm, PETSC_ERR_SUP,
             "-dynamics_model reduced needs -contacts: without them -analysis frf tells the response");
  PetscFunctionReturn(0);
}

PetscErrorCode ReducedRefuseIdle(MPI_Comm comm, Operators operators, const char why[])
{
  static const char       idle[]  = "-dynamics_start -dynamics_shape -dynamics_shape_mode -dynamics_shape_amplitude "
                                    "-dynamics_history_interval -dynamics_pairs_interval "
                                    "-dynamics_snapshot_interval -dynamics_live -dynamics_restart "
                                    "-dynamics_checkpoint_interval -dynamics_check_interval -dynamics_verify "
                                    "-contact_view_kkt -ts_max_steps";
  static const char       ramps[] = "ramp ramp_shape delay";
  const ModelScene       *scene;
  const ContactInterface *c;
  PetscInt                n;
  Model                   model;
  Contact                 contact;

  PetscFunctionBeginUser;
  PetscCall(OptionsRefuse(comm, idle, why));
  PetscCall(OperatorsGetModel(operators, &model, &contact));
  PetscCall(ModelGetScene(model, &scene));
  PetscCall(ContactGetInterfaces(contact, &n, &c));
  for (PetscInt i = 0; i < scene->n_loads; i++) PetscCall(OptionsRefuseOf(comm, scene->loads[i].name, ramps, why));
  for (PetscInt i = 0; i < n; i++) PetscCall(OptionsRefuseOf(comm, c[i].name, ramps, why));
  for (PetscInt i = 0; i < scene->n_parts; i++) PetscCall(OptionsRefuseOf(comm, scene->parts[i].name, "velocity", why));
  PetscFunctionReturn(0);
}

PetscErrorCode ReducedRefuseLate(ReducedRun r, PetscReal end)
{
  PetscFunctionBeginUser;
  PetscCall(ExternalCheckLate(r->run.external, end, r->dt, LATE_NEVER));
  PetscFunctionReturn(0);
}

PetscErrorCode ReducedRefuseImpulses(ReducedRun r, const char why[])
{
  PetscInt n;

  PetscFunctionBeginUser;
  PetscCall(OptionsRefuse(r->comm, "-impulses", why));
  PetscCall(ExternalCountHits(r->run.external, &n));
  for (PetscInt i = 0; i < n; i++) {
    ExternalHit hit;

    PetscCall(ExternalGetHit(r->run.external, i, &hit));
    PetscCall(OptionsRefuseOf(r->comm, hit.name, "at part impulse time", why));
  }
  PetscFunctionReturn(0);
}
