/*
   The loads, and the weight of the parts, as a vector of the unknowns. What falls on held directions goes straight into a support and is no part of
   it; the size counts everything.
*/
#include "staticsimpl.h"

PetscErrorCode StaticsCreateLoad(Operators operators, const PetscReal p[], Vec *f, PetscReal *size)
{
  const ModelScene *scene;
  Vec               local;
  PetscReal         weight[3];
  Model             model;

  PetscFunctionBeginUser;
  PetscCall(OperatorsGetModel(operators, &model, NULL));
  PetscCall(ModelGetScene(model, &scene));
  PetscCall(ModelCreateNodal(model, &local));
  *size = 0;
  for (PetscInt i = 0; i < scene->n_loads; i++) {
    PetscCall(ModelAddLoad(model, i, local));
    for (int d = 0; d < 3; d++) *size += PetscAbsReal(scene->loads[i].force[d]);
  }
  PetscCall(OperatorsAddWeight(operators, p, local, weight));
  for (int d = 0; d < 3; d++) *size += PetscAbsReal(weight[d]);
  PetscCall(OperatorsCreateVec(operators, f));
  PetscCall(OperatorsTakeNodal(operators, local, *f));
  PetscCall(VecDestroy(&local));
  PetscFunctionReturn(0);
}
