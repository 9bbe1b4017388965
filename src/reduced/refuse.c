/* What a reduced model cannot do, by name; what comes too late */
#include "reducedimpl.h"
#include "refuse.h"
#include <squeal/options.h>

PetscErrorCode ReducedRefuse(ReducedRun r)
{
  PetscBool laws = PETSC_FALSE;

  PetscFunctionBeginUser;
  PetscCall(OperatorsCheckEven(r->run.operators, PETSC_TRUE, "-dynamics_model reduced"));
  for (PetscInt i = 0; i < r->run.n_interfaces; i++) {
    const ContactInterface *c = &r->run.interfaces[i];
    PetscReal               way;
    PetscBool               turning;

    PetscCall(ContactProjectorGetWay(r->run.projector, i, (const PetscReal[]){0, 1}, &way, &turning));
    PetscCheck(!turning, r->comm, PETSC_ERR_SUP,
               "-%s_kinematics turning: a reduced model keeps the pairs of the mesh, and no body can turn under the "
               "other; take prescribed sliding, or -dynamics_model full",
               c->name);
    PetscCheck(
      !r->request.springs || !c->identify, r->comm, PETSC_ERR_USER_INPUT,
      "-%s_kn identify: -dynamics_contact penalty needs a number, N/m; -analysis modes prints the one that it finds",
      c->name);
  }
  for (PetscInt i = 0; i < r->run.n_interfaces; i++)
    if (r->run.interfaces[i].law == CONTACT_PENALTY) laws = PETSC_TRUE;
  PetscCheck(
    laws || !r->request.springs || !r->run.n_interfaces, r->comm, PETSC_ERR_USER_INPUT,
    "-dynamics_contact penalty: no contact has a law, all are -..._law constraint; give one -..._kn_per_area or "
    "-..._pressure_law, or leave it out");
  PetscCall(ExternalCheckMotions(r->run.external, r->run.from_static));
  PetscCheck(r->run.n_interfaces, r->comm, PETSC_ERR_SUP,
             "-dynamics_model reduced needs -contacts: without them -analysis frf tells the response");
  PetscFunctionReturn(0);
}

PetscErrorCode ReducedRefuseVarying(ReducedRun r, const char by[])
{
  const ModelScene *scene;

  PetscFunctionBeginUser;
  PetscCall(ModelGetScene(r->run.model, &scene));
  PetscCheck(!scene->n_motions, r->comm, PETSC_ERR_SUP, "motion %s: %s has no prescribed motions; a transient has",
             scene->n_motions ? scene->motions[0].name : "", by);
  for (PetscInt i = 0; i < scene->n_loads; i++)
    PetscCheck(!RampVaries(ExternalGetLoad(r->run.external, i)), r->comm, PETSC_ERR_SUP,
               "-%s_frequency or _history: %s has loads that stay; leave it out", scene->loads[i].name, by);
  for (PetscInt i = 0; i < r->run.n_interfaces; i++) {
    PetscBool steady;

    PetscCall(ContactProjectorGetSteady(r->run.projector, i, &steady));
    PetscCheck(steady, r->comm, PETSC_ERR_SUP,
               "-%s_frequency, _history, _mu_history or _temperature_history: %s has sliding and friction that stay; "
               "leave it out",
               r->run.interfaces[i].name, by);
  }
  PetscFunctionReturn(0);
}

PetscErrorCode ReducedRefuseLate(ReducedRun r, PetscReal end)
{
  PetscFunctionBeginUser;
  PetscCall(ExternalCheckLate(r->run.external, end, r->motion.dt, LATE_NEVER));
  PetscFunctionReturn(0);
}
