/*
   Single unknowns: those of a node, that of a number, and vectors with entries there, as forces of 1 N and places that
   answer are.
*/
#include "operators/operatorsimpl.h"
#include <stdlib.h>

PetscErrorCode OperatorsGetNodeUnknowns(Operators operators, PetscInt vertex, PetscInt unknown[3])
{
  const Mesh *mesh;
  Model       model;
  MPI_Comm    comm;

  PetscFunctionBeginUser;
  PetscCall(OperatorsGetModel(operators, &model, NULL));
  PetscCall(ModelGetComm(model, &comm));
  PetscCall(ModelGetMesh(model, &mesh));
  for (int d = 0; d < 3; d++) unknown[d] = vertex >= 0 ? mesh->unknown[3 * vertex + d] : -1;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, unknown, 3, MPIU_INT, MPI_MAX, comm));
  PetscFunctionReturn(0);
}

PetscErrorCode OperatorsFindUnknown(Operators operators, const char option[], const char word[], PetscInt *unknown)
{
  char      *end;
  const long number = strtol(word, &end, 10);
  PetscInt   n;
  Vec        u;

  PetscFunctionBeginUser;
  PetscCall(OperatorsCreateVec(operators, &u));
  PetscCall(VecGetSize(u, &n));
  PetscCall(VecDestroy(&u));
  PetscCheck(end != word && !*end && number >= 1 && number <= n, operators->comm, PETSC_ERR_USER_INPUT,
             "%s '%s' must be the number of an unknown, 1 to %" PetscInt_FMT ": the matrices have no mesh", option,
             word, n);
  *unknown = (PetscInt)number - 1;
  PetscFunctionReturn(0);
}

PetscErrorCode OperatorsAddEntries(Operators operators, Vec u, PetscInt n, const PetscInt entry[],
                                   const PetscReal value[])
{
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(operators->comm, &rank));
  PetscCall(VecSetOption(u, VEC_IGNORE_NEGATIVE_INDICES, PETSC_TRUE));
  if (!rank) PetscCall(VecSetValues(u, n, entry, value, ADD_VALUES));
  PetscCall(VecAssemblyBegin(u));
  PetscCall(VecAssemblyEnd(u));
  PetscFunctionReturn(0);
}
