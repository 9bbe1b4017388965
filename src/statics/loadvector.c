/*
   The loads as a vector of the unknowns. What falls on held directions goes straight into a support and is no part of
   it; the size counts everything.
*/
#include "staticsimpl.h"

/* Moves a local vector of three values per vertex to the unknowns; each vertex is complete on every rank that has it */
static PetscErrorCode UnknownsTake(Model model, Vec local, Vec f)
{
  const PetscScalar *value;
  const PetscInt    *unknowns;
  PetscInt           n, begin, end;

  PetscFunctionBeginUser;
  PetscCall(ModelGetUnknowns(model, &unknowns));
  PetscCall(VecGetOwnershipRange(f, &begin, &end));
  PetscCall(VecGetLocalSize(local, &n));
  PetscCall(VecGetArrayRead(local, &value));
  for (PetscInt i = 0; i < n; i++)
    if (unknowns[i] >= begin && unknowns[i] < end) PetscCall(VecSetValue(f, unknowns[i], value[i], INSERT_VALUES));
  PetscCall(VecRestoreArrayRead(local, &value));
  PetscCall(VecAssemblyBegin(f));
  PetscCall(VecAssemblyEnd(f));
  PetscFunctionReturn(0);
}

PetscErrorCode StaticsCreateLoad(Operators operators, Vec *f, PetscReal *size)
{
  const Load *loads;
  PetscInt    n;
  Vec         local;
  Model       model;

  PetscFunctionBeginUser;
  PetscCall(OperatorsGetModel(operators, &model, NULL));
  PetscCall(ModelGetLoads(model, &n, &loads));
  PetscCall(ModelCreateNodal(model, &local));
  *size = 0;
  for (PetscInt i = 0; i < n; i++) {
    PetscCall(ModelAddLoad(model, i, local));
    for (int d = 0; d < 3; d++) *size += PetscAbsReal(loads[i].force[d]);
  }
  PetscCall(OperatorsCreateVec(operators, f));
  PetscCall(UnknownsTake(model, local, *f));
  PetscCall(VecDestroy(&local));
  PetscFunctionReturn(0);
}
