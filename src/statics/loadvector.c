/*
   The loads as a vector of the unknowns. What falls on held directions goes straight into a support and is no part of
   it; the size counts everything.
*/
#include "staticsimpl.h"

/* Moves a local vector of three values per vertex to the unknowns; each vertex is complete on every rank that has it */
static PetscErrorCode UnknownsTake(Model model, Vec local, Vec f)
{
  const PetscScalar *value;
  const Mesh        *mesh;
  PetscInt           n, begin, end;

  PetscFunctionBeginUser;
  PetscCall(ModelGetMesh(model, &mesh));
  PetscCall(VecGetOwnershipRange(f, &begin, &end));
  PetscCall(VecGetLocalSize(local, &n));
  PetscCall(VecGetArrayRead(local, &value));
  for (PetscInt i = 0; i < n; i++)
    if (mesh->unknown[i] >= begin && mesh->unknown[i] < end)
      PetscCall(VecSetValue(f, mesh->unknown[i], value[i], INSERT_VALUES));
  PetscCall(VecRestoreArrayRead(local, &value));
  PetscCall(VecAssemblyBegin(f));
  PetscCall(VecAssemblyEnd(f));
  PetscFunctionReturn(0);
}

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
  PetscCall(UnknownsTake(model, local, *f));
  PetscCall(VecDestroy(&local));
  PetscFunctionReturn(0);
}
