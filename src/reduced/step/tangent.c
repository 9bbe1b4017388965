/*
   Derivative of a step of the reduced model (reduced.h), exact where no status changes at once. With

      x = (eta, rate, lambda, q)     [2 m + 3 n_pairs (+ 3 n_pairs where the residual is damped)]

   all that a step knows of the past (y_n, from which slip counts, is P eta + W q and what loads add) beside which
   pairs rest, changes at t_n make

      dv = D dx          motions of the pairs without lambda_{n+1}, less those from which slip counts
      dlambda_{n+1}      as the laws answer dv (ContactComplianceTangent())
      dx_{n+1} = A dx + B dlambda_{n+1}.

   D, A, B are those of one length of step; their columns are the answers of the step's linear parts to unit vectors.
*/
#include "reduced/reducedimpl.h"
#include <petscblaslapack.h>

struct _p_ReducedTangent {
  ReducedStepper stepper;
  PetscInt       n, pairs;  /* of x; 3 n_pairs */
  PetscReal     *D, *A, *B; /* [n][3 pairs], [n][n], [3 pairs][n] */
  PetscReal     *dv, *dlambda, *next;
};

PetscInt ReducedTangentSize(const ReducedModel *model)
{
  return 2 * model->m + (model->Cx ? 6 : 3) * model->n_pairs;
}

/* What a step makes of a state without loads: z, lambda and q in `column`; y */
static PetscErrorCode TangentRespond(ReducedTangent t, const ReducedState *state, PetscReal column[], PetscReal y[])
{
  const ReducedModel *model = t->stepper->model;
  const PetscInt      m     = model->m;

  PetscFunctionBeginUser;
  PetscCall(ReducedStepRespond(t->stepper, state, column, t->next, y));
  for (PetscInt i = 0; i < t->pairs; i++) {
    column[2 * m + i] = state->p[i];
    if (model->Cx) column[2 * m + t->pairs + i] = t->next[i];
  }
  PetscFunctionReturn(0);
}

/* Column j of A and D: the unit vector of x, without forces at t_{n+1}. Undamped lambda_n is q as well. What slip
   counts from, P eta + W q, is taken off D along t and b. */
static PetscErrorCode TangentSetPast(ReducedTangent t, PetscInt j, ReducedState *state)
{
  const ReducedModel *model = t->stepper->model;
  const PetscInt      m = model->m, n = t->pairs, N = model->n_ports;
  PetscReal          *part[] = {state->eta, state->rate, state->last, state->q}, *dv = &t->D[j * n];
  const PetscInt      begin[] = {0, m, 2 * m, 2 * m + n};
  int                 k       = 3;

  PetscFunctionBeginUser;
  while (j < begin[k]) k--;
  part[k][j - begin[k]] = 1;
  if (!model->Cx && k == 2) state->q[j - begin[k]] = 1;
  PetscCall(TangentRespond(t, state, &t->A[j * t->n], dv));
  for (PetscInt i = 0; i < n; i++) {
    if (i % 3 && k == 0) dv[i] -= model->P[j + m * i];
    if (i % 3 && k >= 2 && state->q[j - begin[k]] != 0) dv[i] -= model->W[i + N * (j - begin[k])];
  }
  part[k][j - begin[k]] = 0;
  if (k >= 2) state->q[j - begin[k]] = 0;
  PetscFunctionReturn(0);
}

/* n + 3 n_pairs steps' linear parts, each of some (2 m)^2 operations: once for a length of step. */
static PetscErrorCode TangentFill(ReducedTangent t)
{
  ReducedState state;
  PetscReal   *y;

  PetscFunctionBeginUser;
  PetscCall(ReducedStateCreate(t->stepper->model, &state));
  PetscCall(PetscMalloc1(t->pairs, &y));
  for (PetscInt j = 0; j < t->n; j++) PetscCall(TangentSetPast(t, j, &state));
  for (PetscInt j = 0; j < t->pairs; j++) {
    state.p[j] = 1;
    PetscCall(TangentRespond(t, &state, &t->B[j * t->n], y));
    state.p[j] = 0;
  }
  PetscCall(PetscFree(y));
  PetscCall(ReducedStateDestroy(&state));
  PetscFunctionReturn(0);
}

PetscErrorCode ReducedTangentCreate(ReducedStepper stepper, ReducedTangent *tangent)
{
  ReducedTangent t;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&t));
  t->stepper = stepper;
  t->n       = ReducedTangentSize(stepper->model);
  t->pairs   = 3 * stepper->model->n_pairs;
  PetscCall(PetscCalloc3(t->n * t->pairs, &t->D, t->n * t->n, &t->A, t->pairs * t->n, &t->B));
  PetscCall(PetscMalloc1(t->pairs, &t->next));
  PetscCall(TangentFill(t));
  PetscCall(PetscFree(t->next));
  PetscCall(PetscMalloc3(t->n * t->pairs, &t->dv, t->n * t->pairs, &t->dlambda, t->n * t->n, &t->next));
  *tangent = t;
  PetscFunctionReturn(0);
}

/* X [columns][n] := dX_{n+1}, at most n columns; to be called after each step, while the laws hold its factors. */
PetscErrorCode ReducedTangentApply(ReducedTangent t, PetscInt columns, PetscReal X[])
{
  const PetscReal    one = 1;
  const PetscBLASInt n = (PetscBLASInt)t->n, k = (PetscBLASInt)columns, pairs = (PetscBLASInt)t->pairs;
  const DenseBlock   x = {X, t->n, columns, t->n};

  PetscFunctionBeginUser;
  PetscCheck(columns <= t->n, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
             "%" PetscInt_FMT " columns, must be %" PetscInt_FMT " at most", columns, t->n);
  ReducedTimes(&(DenseBlock){t->D, t->pairs, t->n, t->pairs}, &x, t->dv);
  if (pairs) PetscCall(ContactComplianceTangent(t->stepper->laws, columns, t->dv, t->dlambda));
  ReducedTimes(&(DenseBlock){t->A, t->n, t->n, t->n}, &x, t->next);
  if (pairs && k) BLASgemm_("N", "N", &n, &k, &pairs, &one, t->B, &n, t->dlambda, &pairs, &one, t->next, &n);
  ReducedStepperRelaxTangent(t->stepper, t->n, columns, X, t->next);
  PetscCall(PetscArraycpy(X, t->next, t->n * columns));
  PetscFunctionReturn(0);
}

PetscErrorCode ReducedTangentDestroy(ReducedTangent *tangent)
{
  ReducedTangent t = *tangent;

  PetscFunctionBeginUser;
  if (!t) PetscFunctionReturn(0);
  PetscCall(PetscFree3(t->D, t->A, t->B));
  PetscCall(PetscFree3(t->dv, t->dlambda, t->next));
  PetscCall(PetscFree(*tangent));
  PetscFunctionReturn(0);
}
