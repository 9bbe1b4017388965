/*
   Maxwell branches in a step (reduced.h): the mean of their elongations z_j is (1 - b_j / tau_j) z_j at its beginning
   and b_j times the mean rate of the coordinates, so that a step sees dampers E_j b_j S beside C, Cm, Cx, and forces
   that it knows. Of the elongations it leaves e^(-dt / tau_j), and adds (1 - b_j / tau_j) of what the coordinates move.
*/
#include "reduced/reducedimpl.h"

#define BRANCH_SERIES 1e-3 /* of dt / tau: below it b / tau is a sum of powers, with as many digits as are needed */

/* b / tau, x = dt / tau */
static PetscReal BranchLag(PetscReal x)
{
  return x < BRANCH_SERIES ? x / 2 - x * x / 6 + x * x * x / 24 : 1 + expm1(-x) / x;
}

/* A block of the step's own, with that of the dampers: X' = X + scale S */
static void BranchAdd(PetscInt n, PetscReal scale, const PetscReal S[], PetscReal X[])
{
  for (PetscInt i = 0; i < n; i++) X[i] += scale * S[i];
}

PetscErrorCode ReducedStepperSetBranches(ReducedStepper s)
{
  const ReducedModel *model = s->model;
  const PetscInt      m = model->m, n = 3 * model->n_pairs;

  PetscFunctionBeginUser;
  if (!model->n_branches) PetscFunctionReturn(0);
  PetscCall(ReducedStepperOwnDamping(s));
  if (!s->damped.C) PetscCall(PetscCalloc1(m * m, &s->damped.C));
  if (!s->damped.Cm) PetscCall(PetscCalloc1(n * m, &s->damped.Cm));
  if (!s->damped.Cx) PetscCall(PetscCalloc1(n * n, &s->damped.Cx));
  PetscCall(PetscCalloc2(m + n, &s->known, m + n, &s->elongation));
  for (PetscInt i = 0; i < model->n_branches; i++) {
    const ReducedBranch *b = &model->branch[i];

    for (PetscInt j = 0; j < b->n; j++) {
      const PetscReal damper = b->stiff[j] * b->time[j] * BranchLag(s->dt / b->time[j]);

      BranchAdd(m * m, damper, b->S, s->damped.C);
      BranchAdd(n * m, damper, b->Sm, s->damped.Cm);
      BranchAdd(n * n, damper, b->Sx, s->damped.Cx);
    }
  }
  PetscFunctionReturn(0);
}

/* f += S e of the coordinates e [m + 3 n_pairs] */
static void BranchTimes(const ReducedModel *model, const ReducedBranch *b, const PetscReal e[], PetscReal f[])
{
  const PetscInt   m = model->m, n = 3 * model->n_pairs;
  const DenseBlock mixed = {b->Sm, m, n, m};

  ReducedBlockTimes(&(DenseBlock){b->S, m, m, m}, PETSC_FALSE, 1, e, f);
  ReducedBlockTimes(&mixed, PETSC_FALSE, 1, &e[m], f);
  ReducedBlockTimes(&mixed, PETSC_TRUE, 1, e, &f[m]);
  ReducedBlockTimes(&(DenseBlock){b->Sx, n, n, n}, PETSC_FALSE, 1, &e[m], &f[m]);
}

void ReducedBranchForces(const ReducedModel *model, PetscReal dt, const PetscReal z[], PetscReal work[],
                         PetscReal force[])
{
  const PetscInt n = model->m + 3 * model->n_pairs;

  for (PetscInt k = 0; k < n; k++) force[k] = 0;
  for (PetscInt i = 0; i < model->n_branches; i++) {
    const ReducedBranch *b = &model->branch[i];

    for (PetscInt k = 0; k < n; k++) work[k] = 0;
    for (PetscInt j = 0; j < b->n; j++, z += n) BranchAdd(n, b->stiff[j] * (1 - BranchLag(dt / b->time[j])), z, work);
    BranchTimes(model, b, work, force);
  }
}

void ReducedStepperKnowBranches(ReducedStepper s, const ReducedState *state)
{
  if (s->known) ReducedBranchForces(s->model, s->dt, state->z, s->elongation, s->known);
}

PetscErrorCode ReducedStepperDragBranches(ReducedStepper s)
{
  const PetscInt n = 3 * s->model->n_pairs;

  PetscFunctionBeginUser;
  if (!s->known) PetscFunctionReturn(0);
  PetscCall(PetscArraycpy(s->r, &s->known[s->model->m], n));
  PetscCall(ReducedStepperApplyH(s, 1, s->r));
  for (PetscInt i = 0; i < n; i++) s->dq[i] -= s->r[i];
  PetscFunctionReturn(0);
}

PetscReal ReducedStepperAdvanceBranches(ReducedStepper s, ReducedState *state)
{
  const ReducedModel *model = s->model;
  const PetscInt      m = model->m, n = m + 3 * model->n_pairs;
  PetscReal          *z = state->z, work = 0;

  if (!model->n_branches) return 0;
  for (PetscInt k = 0; k < n; k++) {
    s->elongation[k] = k < m ? s->next[k] - s->x[k] : s->q[k - m] - state->q[k - m];
    work += s->known[k] * s->elongation[k];
  }
  for (PetscInt i = 0; i < model->n_branches; i++)
    for (PetscInt j = 0; j < model->branch[i].n; j++, z += n) {
      const PetscReal x = s->dt / model->branch[i].time[j], decay = PetscExpReal(-x), share = 1 - BranchLag(x);

      for (PetscInt k = 0; k < n; k++) z[k] = decay * z[k] + share * s->elongation[k];
    }
  return work;
}
