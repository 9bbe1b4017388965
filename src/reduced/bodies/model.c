/* Copies of the reduced bodies (reduced.h), states, reports of steps, and their end */
#include "reduced/reducedimpl.h"

PetscErrorCode ReducedModelCopy(const ReducedModel *from, ReducedModel *to)
{
  const PetscInt   m = from->m, n = from->n_pairs, N = from->n_ports;
  const PetscInt   size[]   = {m,
                               m * m,
                               m * N,
                               N * N,
                               3 * n * m,
                               9 * n * n,
                               9 * n * n,
                               from->n_motions * N,
                               from->n_motions * from->n_motions,
                               from->n_motions * from->n_motions};
  const PetscReal *source[] = {from->omega2, from->C,  from->P, from->W,     from->Cm,
                               from->Cx,     from->Mx, from->Y, from->kappa, from->drag};
  PetscReal **copy[] = {&to->omega2, &to->C, &to->P, &to->W, &to->Cm, &to->Cx, &to->Mx, &to->Y, &to->kappa, &to->drag};

  PetscFunctionBeginUser;
  *to        = *from;
  to->sparse = NULL; /* maps and cycles have dense models */
  for (int i = 0; i < 10; i++) {
    if (!source[i]) continue;
    PetscCall(PetscMalloc1(size[i], copy[i]));
    PetscCall(PetscArraycpy(*copy[i], source[i], size[i]));
  }
  PetscCall(PetscMalloc2(n, &to->gap, n, &to->friction));
  PetscCall(PetscArraycpy(to->gap, from->gap, n));
  PetscCall(PetscArraycpy(to->friction, from->friction, n));
  if (!from->spring) PetscFunctionReturn(0);
  PetscCall(PetscMalloc1(n, &to->spring));
  PetscCall(PetscArraycpy(to->spring, from->spring, n));
  PetscFunctionReturn(0);
}

PetscErrorCode ReducedModelDestroy(ReducedModel *model)
{
  PetscFunctionBeginUser;
  PetscCall(ReducedSparseDestroy(&model->sparse));
  PetscCall(PetscFree(model->omega2));
  PetscCall(PetscFree(model->C));
  PetscCall(PetscFree(model->P));
  PetscCall(PetscFree(model->W));
  PetscCall(PetscFree(model->Cm));
  PetscCall(PetscFree(model->Cx));
  PetscCall(PetscFree(model->Mx));
  PetscCall(PetscFree(model->Y));
  PetscCall(PetscFree(model->kappa));
  PetscCall(PetscFree(model->drag));
  PetscCall(PetscFree2(model->gap, model->friction));
  PetscCall(PetscFree(model->spring));
  PetscFunctionReturn(0);
}

PetscInt ReducedStateSize(const ReducedModel *model)
{
  return 2 * model->m + 2 * model->n_ports + 9 * model->n_pairs;
}

PetscErrorCode ReducedStateCreate(const ReducedModel *model, ReducedState *state)
{
  PetscFunctionBeginUser;
  *state = (ReducedState){.time = 0};
  PetscCall(PetscCalloc2(ReducedStateSize(model), &state->eta, model->n_pairs, &state->status));
  state->rate  = state->eta + model->m;
  state->p     = state->rate + model->m;
  state->last  = state->p + model->n_ports;
  state->begin = state->last + model->n_ports;
  state->q     = state->begin + 3 * model->n_pairs;
  state->y     = state->q + 3 * model->n_pairs;
  PetscFunctionReturn(0);
}

PetscErrorCode ReducedStateCopy(const ReducedModel *model, const ReducedState *from, ReducedState *to)
{
  PetscFunctionBeginUser;
  to->time = from->time;
  PetscCall(PetscArraycpy(to->eta, from->eta, ReducedStateSize(model)));
  PetscCall(PetscArraycpy(to->status, from->status, model->n_pairs));
  PetscFunctionReturn(0);
}

PetscErrorCode ReducedStateDestroy(ReducedState *state)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree2(state->eta, state->status));
  PetscFunctionReturn(0);
}

PetscErrorCode ReducedReportCreate(const ReducedModel *model, ReducedReport *report)
{
  const PetscInt n = model->n_pairs;

  PetscFunctionBeginUser;
  *report = (ReducedReport){.works = PETSC_TRUE};
  PetscCall(PetscCalloc4(n, &report->contact, n, &report->friction, n, &report->heat, 2 * n, &report->slip));
  PetscFunctionReturn(0);
}

PetscErrorCode ReducedReportDestroy(ReducedReport *report)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree4(report->contact, report->friction, report->heat, report->slip));
  PetscFunctionReturn(0);
}
