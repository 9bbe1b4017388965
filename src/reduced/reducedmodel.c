/* Copies of the reduced bodies (reduced.h), and their end */
#include "reducedimpl.h"

PetscErrorCode ReducedModelCopy(const ReducedModel *from, ReducedModel *to)
{
  const PetscInt   m = from->m, n = from->n_pairs, N = from->n_ports;
  const PetscInt   size[]   = {m, m * m, m * N, N * N, 3 * n * m, 9 * n * n, 9 * n * n};
  const PetscReal *source[] = {from->omega2, from->C, from->P, from->W, from->Cm, from->Cx, from->Mx};
  PetscReal      **copy[]   = {&to->omega2, &to->C, &to->P, &to->W, &to->Cm, &to->Cx, &to->Mx};

  PetscFunctionBeginUser;
  *to = *from;
  for (int i = 0; i < 7; i++) {
    if (!source[i]) continue;
    PetscCall(PetscMalloc1(size[i], copy[i]));
    PetscCall(PetscArraycpy(*copy[i], source[i], size[i]));
  }
  PetscCall(PetscMalloc4(n, &to->gap, n, &to->mu, n, &to->slope, n, &to->speed));
  PetscCall(PetscArraycpy(to->gap, from->gap, n));
  PetscCall(PetscArraycpy(to->mu, from->mu, n));
  PetscCall(PetscArraycpy(to->slope, from->slope, n));
  PetscCall(PetscArraycpy(to->speed, from->speed, n));
  PetscFunctionReturn(0);
}

PetscErrorCode ReducedModelDestroy(ReducedModel *model)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(model->omega2));
  PetscCall(PetscFree(model->C));
  PetscCall(PetscFree(model->P));
  PetscCall(PetscFree(model->W));
  PetscCall(PetscFree(model->Cm));
  PetscCall(PetscFree(model->Cx));
  PetscCall(PetscFree(model->Mx));
  PetscCall(PetscFree4(model->gap, model->mu, model->slope, model->speed));
  PetscFunctionReturn(0);
}
