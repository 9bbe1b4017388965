/*
   Loads of the model in time: F(t) = r(t) F (N) with a history r, distributed by the model once for all. Of the work
   dt/2 (v_{n-1/2} + v_{n+1/2})'F(t_n), J, a step takes the power v'F at both of its ends: now with r(t_n), and `old`
   with the factor of the step before, whose second half it is (history/ledger.c).
*/
#include "externalimpl.h"
#include "base/algebra/vec3.h"

PetscErrorCode TimedLoadsSetFromOptions(External external)
{
  const ModelScene *scene;

  PetscFunctionBeginUser;
  PetscCall(ModelGetScene(external->model, &scene));
  external->n_loads = scene->n_loads;
  PetscCall(PetscCalloc1(external->n_loads, &external->loads));
  for (PetscInt i = 0; i < external->n_loads; i++) {
    TimedLoad *load = &external->loads[i];

    PetscCall(PetscStrallocpy(scene->loads[i].name, &load->name));
    load->is_bolt = scene->loads[i].is_bolt;
    PetscCall(RampSetFromOptions(external->comm, "History of load", load->name, &load->ramp));
  }
  PetscFunctionReturn(0);
}

/* Full forces of load i at the nodes that have some; local is work */
static PetscErrorCode TimedLoadGather(External external, PetscInt i, Vec local)
{
  const Layout    *layout = external->layout;
  const PetscReal *force;
  PetscInt         n = 0, *vertex;
  PetscReal       *f;

  PetscFunctionBeginUser;
  PetscCall(VecSet(local, 0));
  PetscCall(OperatorsAddLoad(external->operators, NULL, i, 1, local));
  PetscCall(PetscMalloc2(layout->n_vertices, &vertex, 3 * layout->n_vertices, &f));
  PetscCall(VecGetArrayRead(local, &force));
  for (PetscInt v = 0; v < layout->n_vertices; v++) {
    if (force[3 * v] == 0 && force[3 * v + 1] == 0 && force[3 * v + 2] == 0) continue;
    PetscCall(PetscArraycpy(&f[3 * n], &force[3 * v], 3));
    vertex[n++] = v;
  }
  PetscCall(VecRestoreArrayRead(local, &force));
  PetscCall(ForcePatternCreate(layout, n, vertex, f, &external->loads[i].pattern));
  PetscCall(PetscFree2(vertex, f));
  PetscFunctionReturn(0);
}

PetscErrorCode TimedLoadsSetUp(External external)
{
  Vec local;

  PetscFunctionBeginUser;
  if (!external->n_loads) PetscFunctionReturn(0);
  PetscCall(ModelCreateNodal(external->model, &local));
  for (PetscInt i = 0; i < external->n_loads; i++) PetscCall(TimedLoadGather(external, i, local));
  PetscCall(VecDestroy(&local));
  PetscFunctionReturn(0);
}

PetscErrorCode TimedLoadsDraw(External external)
{
  const ModelScene *scene;

  PetscFunctionBeginUser;
  PetscCall(ModelGetScene(external->model, &scene));
  for (PetscInt i = 0; i < external->n_loads; i++)
    if (external->loads[i].drawn) *external->loads[i].drawn = scene->loads[i].shortening;
  PetscFunctionReturn(0);
}

PetscErrorCode ExternalDrawBolts(External external, Statics statics)
{
  const ModelScene *scene;

  PetscFunctionBeginUser;
  PetscCall(ModelGetScene(external->model, &scene));
  for (PetscInt i = 0; i < external->n_loads; i++)
    if (scene->loads[i].has_tension) PetscCall(StaticsGetShortening(statics, i, external->loads[i].drawn));
  PetscFunctionReturn(0);
}

PetscErrorCode TimedLoadsAdvance(External external, const ExternalStep *step, ExternalPower *power)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < external->n_loads; i++) {
    TimedLoad      *load   = &external->loads[i];
    const PetscReal drawn  = load->drawn ? *load->drawn : 1;
    const PetscReal factor = drawn * RampValue(&load->ramp, step->time);
    const PetscReal full   = ForcePatternPower(&load->pattern, step->v);

    power->old += *load->last * full;
    power->now += factor * full;
    ForcePatternAdd(&load->pattern, factor, step->f);
    *load->last = factor;
  }
  PetscFunctionReturn(0);
}

const Ramp *ExternalGetLoad(External external, PetscInt i)
{
  return &external->loads[i].ramp;
}

PetscErrorCode TimedLoadsView(External external, PetscViewer viewer)
{
  const ModelScene *scene;
  char              words[160];

  PetscFunctionBeginUser;
  PetscCall(ModelGetScene(external->model, &scene));
  for (PetscInt i = 0; i < external->n_loads; i++) {
    const TimedLoad *load = &external->loads[i];
    const PetscReal *f    = scene->loads[i].force; /* of a pressure it is known since the mesh is */

    PetscCall(RampDescribe(&load->ramp, sizeof(words), words));
    if (scene->loads[i].is_bolt) {
      PetscCall(PetscViewerASCIIPrintf(viewer, "  bolt %s: %s %.6g %s, %s\n", load->name,
                                       scene->loads[i].has_tension ? "tension" : "shortened by",
                                       (double)PetscMax(scene->loads[i].tension, scene->loads[i].shortening),
                                       scene->loads[i].has_tension ? "N" : "m", words));
      continue;
    }
    PetscCall(PetscViewerASCIIPrintf(viewer, "  load %s: %.6g N, %s\n", load->name, (double)Vec3Length(f), words));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode TimedLoadsDestroy(External external)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < external->n_loads; i++) {
    PetscCall(PetscFree(external->loads[i].name));
    PetscCall(RampDestroy(&external->loads[i].ramp));
    PetscCall(ForcePatternDestroy(&external->loads[i].pattern));
  }
  PetscCall(PetscFree(external->loads));
  PetscFunctionReturn(0);
}
