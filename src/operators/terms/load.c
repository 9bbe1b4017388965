/*
   Loads at a point p of the parameters. A load keeps its direction, and p gives its size: <name>_force |F| (N), or
   <name>_pressure (Pa), and of a load on a point <name>_moment |M| (N m),

      f = (p_F / |F|) f_F + (p_M / |M|) f_M    (N),

   with f_F, f_M, F, M of the scene; <name>_tension (N) or <name>_shortening (m) of a bolt (bodies/bolt.c). What
   swings has no part in it. No matrix of the bodies depends on them: pencils do through the sliding state alone.
*/
#include "operators/operatorsimpl.h"
#include "base/algebra/vec3.h"

/* Adds the parameter <load>_<what> of the size that the scene gives, or of none for 0 */
static PetscErrorCode SizeAdd(Operators o, const Load *load, const char what[], OperatorsParameter like,
                              PetscInt *index)
{
  PetscFunctionBeginUser;
  *index     = -1;
  like.state = PETSC_TRUE;
  like.row   = ModelFindRow("-loads", what);
  if (like.value != 0) PetscCall(ParametersAdd(&o->parameters, load->name, what, &like, index));
  PetscFunctionReturn(0);
}

PetscErrorCode OperatorsAddLoadParameters(Operators o)
{
  const ModelScene *scene;

  PetscFunctionBeginUser;
  PetscCall(ModelGetScene(o->model, &scene));
  PetscCall(PetscMalloc1(scene->n_loads, &o->load_size));
  for (PetscInt i = 0; i < scene->n_loads; i++) {
    const Load              *load  = &scene->loads[i];
    const OperatorsParameter force = {.value = Vec3Length(load->force), .length = PETSC_TRUE};
    const OperatorsParameter press = {.value = load->pressure};
    const OperatorsParameter bolt  = {.value = load->has_tension ? load->tension : load->shortening};
    const OperatorsParameter turn  = {.value = Vec3Length(load->moment), .length = PETSC_TRUE};

    o->load_size[i] = (LoadParameters){-1, -1};
    if (load->swings) continue;
    if (load->is_bolt)
      PetscCall(SizeAdd(o, load, load->has_tension ? "tension" : "shortening", bolt, &o->load_size[i].force));
    else if (load->is_pressure)
      PetscCall(SizeAdd(o, load, "pressure", press, &o->load_size[i].force));
    else
      PetscCall(SizeAdd(o, load, "force", force, &o->load_size[i].force));
    PetscCall(SizeAdd(o, load, "moment", turn, &o->load_size[i].moment));
  }
  PetscFunctionReturn(0);
}

/* What p makes of the size of the scene, p / p_scene; a size that is 0 in the scene is no parameter, and stays */
static PetscReal SizeFactor(Operators o, const PetscReal p[], PetscInt parameter)
{
  return parameter < 0 ? 1 : OperatorsPoint(o, p)[parameter] / o->parameters.p[parameter];
}

PetscErrorCode OperatorsAddLoad(Operators o, const PetscReal p[], PetscInt i, PetscReal factor, Vec local)
{
  const PetscReal   both[2] = {factor, factor};
  const ModelScene *scene;
  PetscReal         size = 0;

  PetscFunctionBeginUser;
  PetscCall(ModelGetScene(o->model, &scene));
  if (scene->loads[i].is_bolt)
    PetscCall(OperatorsAddBolt(o, p, i, factor, local, &size));
  else
    PetscCall(ModelAddLoad(o->model, i, both, local));
  PetscFunctionReturn(0);
}

PetscErrorCode OperatorsAddLoads(Operators o, const PetscReal p[], const PetscReal share[], Vec local, PetscReal *size)
{
  const ModelScene *scene;

  PetscFunctionBeginUser;
  *size = 0;
  PetscCall(ModelGetScene(o->model, &scene));
  for (PetscInt i = 0; i < scene->n_loads; i++) {
    const LoadParameters *q         = &o->load_size[i];
    const PetscReal       part      = share ? share[i] : 1;
    const PetscReal       factor[2] = {part * SizeFactor(o, p, q->force), part * SizeFactor(o, p, q->moment)};
    const PetscReal       force = q->force < 0 ? 0 : PetscAbsReal(factor[0]), moment = q->moment < 0 ? 0 : factor[1];

    if (scene->loads[i].is_bolt) {
      const PetscReal length = scene->loads[i].has_tension ? 1 : OperatorsPoint(o, p)[q->force];

      PetscCall(OperatorsAddBolt(o, p, i, part * length, local, size));
      continue;
    }
    if (scene->loads[i].swings) continue;
    PetscCall(ModelAddLoad(o->model, i, factor, local));
    *size += PetscMax(force, moment) * scene->loads[i].size;
  }
  PetscFunctionReturn(0);
}
