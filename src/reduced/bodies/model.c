/* Copies of the reduced bodies (reduced.h), states, reports of steps, and their end */
#include "reduced/reducedimpl.h"

/* Numbers of S in all its blocks */
static PetscInt BranchSize(const ReducedModel *model)
{
  const PetscInt m = model->m, n = 3 * model->n_pairs;

  return m * m + n * m + n * n;
}

PetscErrorCode ReducedBranchesCreate(PetscInt n_parts, ReducedModel *model)
{
  const PetscInt m = model->m, n = 3 * model->n_pairs, size = BranchSize(model);

  PetscFunctionBeginUser;
  model->n_branches = n_parts;
  PetscCall(PetscCalloc2(n_parts, &model->branch, n_parts * size, &model->S));
  for (PetscInt i = 0; i < n_parts; i++) {
    ReducedBranch *b = &model->branch[i];

    b->S  = &model->S[i * size];
    b->Sm = b->S + m * m;
    b->Sx = b->Sm + n * m;
  }
  PetscFunctionReturn(0);
}

/* The branches of a model like those of another */
static PetscErrorCode BranchesCopy(const ReducedModel *from, ReducedModel *to)
{
  PetscFunctionBeginUser;
  PetscCall(ReducedBranchesCreate(from->n_branches, to));
  for (PetscInt i = 0; i < from->n_branches; i++) {
    to->branch[i].n = from->branch[i].n;
    PetscCall(PetscArraycpy(to->branch[i].stiff, from->branch[i].stiff, VISCOELASTIC_BRANCHES));
    PetscCall(PetscArraycpy(to->branch[i].time, from->branch[i].time, VISCOELASTIC_BRANCHES));
  }
  PetscCall(PetscArraycpy(to->S, from->S, from->n_branches * BranchSize(from)));
  PetscFunctionReturn(0);
}

PetscInt ReducedBranches(const ReducedModel *model)
{
  PetscInt n = 0;

  for (PetscInt i = 0; i < model->n_branches; i++) n += model->branch[i].n;
  return n;
}

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
  PetscCall(BranchesCopy(from, to));
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
  PetscCall(PetscFree2(model->branch, model->S));
  model->n_branches = 0;
  PetscCall(PetscFree2(model->gap, model->friction));
  PetscCall(PetscFree(model->spring));
  PetscFunctionReturn(0);
}

PetscInt ReducedStateSize(const ReducedModel *model)
{
  return 2 * model->m + 2 * model->n_ports + 9 * model->n_pairs +
         ReducedBranches(model) * (model->m + 3 * model->n_pairs);
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
  state->z     = state->y + 3 * model->n_pairs;
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
