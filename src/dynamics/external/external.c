/*
   What the scene prescribes in time: life cycle, and the order in which the kinds act in a step. Energy: see
   external.h.
*/
#include "externalimpl.h"

PetscErrorCode ExternalCreate(MPI_Comm comm, Model model, External *external)
{
  PetscFunctionBeginUser;
  PetscCall(PetscNew(external));
  (*external)->comm  = comm;
  (*external)->model = model;
  PetscFunctionReturn(0);
}

PetscErrorCode ExternalSetFromOptions(External external)
{
  const ModelScene *scene;

  PetscFunctionBeginUser;
  PetscCall(ModelGetScene(external->model, &scene));
  PetscCall(PetscArraycpy(external->gravity, scene->gravity, 3));
  PetscCall(TimedLoadsSetFromOptions(external));
  PetscCall(MotionsSetFromOptions(external));
  PetscCall(ImpulsesSetFromOptions(external));
  PetscCall(VelocitySetFromOptions(external));
  PetscCall(PetscCalloc1(external->n_parts, &external->frames));
  PetscFunctionReturn(0);
}

PetscErrorCode ExternalVisit(External external, const QuantityVisitor *visitor)
{
  const ModelScene *scene;

  PetscFunctionBeginUser;
  PetscCall(ModelGetScene(external->model, &scene));
  for (PetscInt i = 0; i < external->n_loads; i++)
    PetscCall(RampVisit(visitor, "History of load", scene->loads[i].name, &external->loads[i].ramp, NULL));
  for (PetscInt i = 0; i < external->n_motions; i++)
    PetscCall(RampVisit(visitor, "History of motion", scene->motions[i].name, &external->motions[i].ramp, NULL));
  PetscCall(QuantitiesVisitList(visitor, &impulses_list, external->n_impulses, external->impulses));
  for (PetscInt i = 0; i < external->n_parts; i++)
    PetscCall(QuantitiesVisit(visitor, &start_velocity, scene->parts[i].name, &external->velocity[3 * i], NULL));
  PetscFunctionReturn(0);
}

PetscErrorCode ExternalSetUp(External external, Operators operators, Bodies bodies)
{
  PetscFunctionBeginUser;
  external->operators = operators;
  PetscCall(BodiesGetLayout(bodies, &external->layout));
  PetscCall(TimedLoadsSetUp(external));
  PetscCall(InertiaSetUp(external));
  PetscCall(MotionsSetUp(external, bodies));
  PetscCall(ImpulsesSetUp(external));
  PetscCall(ExternalLayMemory(external));
  PetscCall(TimedLoadsDraw(external));
  PetscFunctionReturn(0);
}

/* power->old: of the forces of the step before with v = v_{n-1/2}, to complete its work; power->now: of the new
   forces with the same v, whose other half comes with v_{n+1/2}. Drives act last, as they need no force but set
   velocities. */
PetscErrorCode ExternalAdvance(External external, const ExternalStep *step, ExternalPower *power)
{
  PetscFunctionBeginUser;
  power->old        = *external->drives;
  power->now        = 0;
  *external->drives = 0;
  PetscCall(TimedLoadsAdvance(external, step, power));
  PetscCall(InertiaAdvance(external, step, power));
  PetscCall(ImpulsesAdvance(external, step, power));
  PetscCall(MotionsAdvance(external, step));
  *external->begun = 1;
  PetscFunctionReturn(0);
}

PetscErrorCode ExternalFinish(External external, PetscReal dt, const PetscReal f[])
{
  PetscFunctionBeginUser;
  PetscCall(MotionsFinish(external, dt, f));
  PetscFunctionReturn(0);
}

PetscErrorCode ExternalGetMemory(External external, PetscInt *n, PetscReal **values)
{
  PetscFunctionBeginUser;
  PetscCheck(external->memory, external->comm, PETSC_ERR_ARG_WRONGSTATE, "ExternalSetUp() must come first");
  *n      = external->n_memory;
  *values = external->memory;
  PetscFunctionReturn(0);
}

PetscErrorCode ExternalAddChecksum(External external, Checksum c)
{
  PetscFunctionBeginUser;
  PetscCall(ChecksumSetPart(c, "the start"));
  PetscCall(ChecksumAddReals(c, 3 * external->n_parts, external->velocity));
  PetscCall(ModelAddLoadsChecksum(external->model, c));
  for (PetscInt i = 0; i < external->n_loads; i++) {
    PetscCall(ChecksumSetPart(c, "load %s", external->loads[i].name));
    PetscCall(RampAddChecksum(&external->loads[i].ramp, c));
  }
  for (PetscInt i = 0; i < external->n_motions; i++) {
    const Drive *m = &external->motions[i];

    PetscCall(ChecksumSetPart(c, "motion %s", m->prescribed->name));
    PetscCall(RampAddChecksum(&m->ramp, c));
  }
  for (PetscInt i = 0; i < external->n_acting; i++) {
    const Impulse *hit = &external->impulses[i];

    PetscCall(ChecksumSetPart(c, "impulse %s", hit->name));
    PetscCall(ChecksumAddInts(c, 1, &i));       /* the order counts */
    PetscCall(ChecksumAddString(c, hit->part)); /* nodes of two bodies may share a place */
    PetscCall(ChecksumAddReals(c, 3, hit->x));
    PetscCall(ChecksumAddReals(c, 3, hit->impulse));
    PetscCall(ChecksumAddReals(c, 1, &hit->time));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode ExternalView(External external, PetscViewer viewer)
{
  PetscFunctionBeginUser;
  PetscCall(TimedLoadsView(external, viewer));
  PetscCall(InertiaView(external, viewer));
  PetscCall(MotionsView(external, viewer));
  PetscCall(ImpulsesView(external, viewer));
  PetscCall(VelocityView(external, viewer));
  PetscFunctionReturn(0);
}

PetscErrorCode ExternalDestroy(External *external)
{
  PetscFunctionBeginUser;
  if (!*external) PetscFunctionReturn(0);
  PetscCall(TimedLoadsDestroy(*external));
  PetscCall(InertiaDestroy(*external));
  PetscCall(MotionsDestroy(*external));
  PetscCall(ImpulsesDestroy(*external));
  PetscCall(PetscFree((*external)->velocity));
  PetscCall(PetscFree((*external)->memory));
  PetscCall(PetscFree(*external));
  PetscFunctionReturn(0);
}
