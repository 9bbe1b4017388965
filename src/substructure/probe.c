/* What shows whether matrices and ties act beyond the parts: numbers outside of them */
#include "substructureimpl.h"
#include <string.h>

PetscErrorCode BodyCreateProbe(Mat A, IS unknowns, Vec *probe)
{
  const PetscInt *unknown;
  PetscInt        first, last, n;
  PetscScalar    *value;

  PetscFunctionBeginUser;
  PetscCall(MatCreateVecs(A, probe, NULL));
  PetscCall(VecGetOwnershipRange(*probe, &first, &last));
  PetscCall(VecGetArray(*probe, &value));
  for (PetscInt i = first; i < last; i++) value[i - first] = 1.5 + PetscSinReal(1 + 12.9898 * (PetscReal)(i % 9973));
  PetscCall(ISGetLocalSize(unknowns, &n));
  PetscCall(ISGetIndices(unknowns, &unknown));
  for (PetscInt k = 0; k < n; k++) value[unknown[k] - first] = 0;
  PetscCall(ISRestoreIndices(unknowns, &unknown));
  PetscCall(VecRestoreArray(*probe, &value));
  PetscFunctionReturn(0);
}

PetscErrorCode BodyMarkRows(Vec answer, IS unknowns, PetscBool joined[], PetscInt *n_marked)
{
  const PetscInt    *unknown;
  const PetscScalar *value;
  PetscInt           first, n;

  PetscFunctionBeginUser;
  *n_marked = 0;
  PetscCall(VecGetOwnershipRange(answer, &first, NULL));
  PetscCall(VecGetArrayRead(answer, &value));
  PetscCall(ISGetLocalSize(unknowns, &n));
  PetscCall(ISGetIndices(unknowns, &unknown));
  for (PetscInt k = 0; k < n; k++) {
    if (value[unknown[k] - first] == 0) continue;
    joined[k] = PETSC_TRUE;
    ++*n_marked;
  }
  PetscCall(ISRestoreIndices(unknowns, &unknown));
  PetscCall(VecRestoreArrayRead(answer, &value));
  PetscFunctionReturn(0);
}

PetscErrorCode BodyJoin(SubstructureBody *body, const PetscBool rows[], const char name[])
{
  PetscInt j = 0;

  PetscFunctionBeginUser;
  while (j < body->n_joints && strcmp(body->joint[j], name)) j++;
  j = PetscMin(j, SUBSTRUCTURE_JOINTS - 1);
  if (j == body->n_joints) PetscCall(PetscStrncpy(body->joint[body->n_joints++], name, sizeof(body->joint[0])));
  for (PetscInt k = 0; k < body->n_own; k++) {
    if (!rows[k]) continue;
    body->joined[k] = PETSC_TRUE;
    body->by[k] |= (PetscInt)1 << j;
  }
  PetscFunctionReturn(0);
}
