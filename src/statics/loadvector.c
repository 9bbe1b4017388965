/*
   The loads as a vector of the unknowns. What falls on held directions goes straight into a support and is no part of
   it; the size counts everything.
*/
#include "staticsimpl.h"

PetscErrorCode StaticsCreateLoad(Operators operators, Vec *f, PetscReal *size)
{
  const ModelScene *scene;
  Vec               local;
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
  PetscCall(OperatorsCreateVec(operators, f));
  PetscCall(OperatorsTakeNodal(operators, local, *f));
  PetscCall(VecDestroy(&local));
  PetscFunctionReturn(0);
}
