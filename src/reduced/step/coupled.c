/*
   The matrices of a step by modes that damping couples, with others or with the residual, and modes that it does not:
   of a body that is damped as alpha M + beta K alone C is diagonal and Cm is zero. What is below 1e-10 of

      |C_ij| / sqrt(C_ii C_jj),   |Cm_ij| / sqrt(C_ii Cx_jj)

   is rounding, and is left out of the step as a whole, so that its balance of energy holds without it. A C_ii below
   1e-4 of the largest counts as that: of a rigid mode with beta K alone it is rounding itself, and C_ij is, too, by
   eps beta times the square of the mesh's highest frequency, some 1e-13 of the largest C_ii. A mode alone
   needs six numbers of E and F and six of Q, those that are coupled blocks of their own.
*/
#include "reduced/reducedimpl.h"

#define COUPLED_RTOL  1e-10
#define COUPLED_FLOOR 1e-4

/* C, Cm and Cx of the stepper's own, as those of the model */
PetscErrorCode ReducedStepperOwnDamping(ReducedStepper s)
{
  const ReducedModel *from = s->model;
  const PetscInt      m = from->m, n = 3 * from->n_pairs;
  ReducedModel       *own = &s->damped;

  PetscFunctionBeginUser;
  *own   = *from;
  own->C = own->Cm = own->Cx = NULL;
  if (from->C) PetscCall(PetscMalloc1(m * m, &own->C));
  if (from->Cm) PetscCall(PetscMalloc1(n * m, &own->Cm));
  if (from->Cx) PetscCall(PetscMalloc1(n * n, &own->Cx));
  if (from->C) PetscCall(PetscArraycpy(own->C, from->C, m * m));
  if (from->Cm) PetscCall(PetscArraycpy(own->Cm, from->Cm, n * m));
  if (from->Cx) PetscCall(PetscArraycpy(own->Cx, from->Cx, n * n));
  s->model = own;
  PetscFunctionReturn(0);
}

/* The smallest C_ii that counts */
static PetscReal CoupledLeast(const ReducedModel *model)
{
  PetscReal most = 0;

  for (PetscInt i = 0; i < model->m; i++) most = PetscMax(most, model->C[i + model->m * i]);
  return COUPLED_FLOOR * most;
}

/* Leaves rounding out of C and Cm; which modes are left coupled, [m] */
static void CoupledFind(const ReducedModel *model, PetscBool coupled[])
{
  const PetscInt  m = model->m, n = 3 * model->n_pairs;
  const PetscReal square = PetscSqr(COUPLED_RTOL), least = CoupledLeast(model);
  PetscReal      *C = model->C, *Cm = model->Cm;

  for (PetscInt j = 0; j < m; j++)
    for (PetscInt i = 0; i < j; i++) {
      const PetscReal most = square * PetscMax(least, C[i + m * i]) * PetscMax(least, C[j + m * j]);

      if (PetscMax(PetscSqr(C[i + m * j]), PetscSqr(C[j + m * i])) > most)
        coupled[i] = coupled[j] = PETSC_TRUE;
      else
        C[i + m * j] = C[j + m * i] = 0;
    }
  for (PetscInt j = 0; j < n && Cm; j++)
    for (PetscInt i = 0; i < m; i++) {
      const PetscReal own = model->Cx ? PetscMax(0, model->Cx[j + n * j]) : 0;

      if (PetscSqr(Cm[i + m * j]) > square * PetscMax(least, C[i + m * i]) * own)
        coupled[i] = PETSC_TRUE;
      else
        Cm[i + m * j] = 0;
    }
}

PetscErrorCode ReducedStepperFindCoupled(ReducedStepper s)
{
  const PetscInt  m = s->model->m;
  ReducedCoupled *c = &s->coupled;
  PetscBool      *coupled;

  PetscFunctionBeginUser;
  if (s->model->C && s->model != &s->damped) PetscCall(ReducedStepperOwnDamping(s));
  PetscCall(PetscCalloc1(m, &coupled));
  if (s->model->C) CoupledFind(s->model, coupled);
  PetscCall(PetscMalloc1(m, &c->mode));
  for (PetscInt i = 0; i < m; i++)
    if (coupled[i]) c->mode[c->n++] = i;
  c->n_alone = m - c->n;
  for (PetscInt i = 0, k = c->n; i < m; i++)
    if (!coupled[i]) c->mode[k++] = i;
  PetscCall(PetscFree(coupled));
  PetscFunctionReturn(0);
}

/* Blocks [to][from] of A, columns stride apart: those of the coupled modes in each of these, without gaps */
static void CoupledTake(const ReducedCoupled *c, PetscInt m, PetscInt to, PetscInt from, const PetscReal A[],
                        PetscReal B[])
{
  for (PetscInt b = 0; b < from; b++)
    for (PetscInt j = 0; j < c->n; j++)
      for (PetscInt a = 0; a < to; a++)
        for (PetscInt i = 0; i < c->n; i++) *B++ = A[a * m + c->mode[i] + to * m * (b * m + c->mode[j])];
}

PetscErrorCode ReducedStepperSetCoupled(ReducedStepper s)
{
  const PetscInt  m = s->model->m, n = 3 * s->model->n_pairs;
  ReducedCoupled *c = &s->coupled;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc3(4 * c->n * c->n, &c->E, 2 * c->n * c->n, &c->F, c->n_alone, &c->own));
  PetscCall(PetscCalloc2(3 * c->n, &c->x, 3 * c->n, &c->y));
  CoupledTake(c, m, 2, 2, s->E, c->E);
  CoupledTake(c, m, 2, 1, s->F, c->F);
  for (PetscInt k = 0; k < c->n_alone; k++) {
    const PetscInt i = c->mode[c->n + k];

    for (PetscInt a = 0; a < 2; a++) {
      for (PetscInt b = 0; b < 2; b++) c->own[k].E[b][a] = s->E[a * m + i + 2 * m * (b * m + i)];
      c->own[k].E[2][a] = s->F[a * m + i + 2 * m * i];
    }
  }
  if (!s->model->Cm) PetscFunctionReturn(0);
  PetscCall(PetscMalloc1(n * c->n, &c->Cm));
  for (PetscInt j = 0; j < n; j++)
    for (PetscInt i = 0; i < c->n; i++) c->Cm[i + c->n * j] = s->model->Cm[c->mode[i] + m * j];
  if (!s->HC) PetscFunctionReturn(0);
  PetscCall(PetscMalloc1(n * c->n, &c->HC));
  for (PetscInt i = 0; i < c->n; i++) PetscCall(PetscArraycpy(&c->HC[n * i], &s->HC[n * c->mode[i]], n));
  PetscFunctionReturn(0);
}

/* Of Q [3 m][3 m] */
PetscErrorCode ReducedStepperSetCoupledDamping(ReducedStepper s, const PetscReal Q[])
{
  const PetscInt  m = s->model->m;
  ReducedCoupled *c = &s->coupled;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(9 * c->n * c->n + 1, &c->Q));
  CoupledTake(c, m, 3, 3, Q, c->Q);
  for (PetscInt k = 0; k < c->n_alone; k++) {
    const PetscInt i  = c->mode[c->n + k];
    PetscReal     *to = c->own[k].Q;

    for (PetscInt b = 0; b < 3; b++)
      for (PetscInt a = 0; a <= b; a++) *to++ = (a < b ? 2 : 1) * Q[a * m + i + 3 * m * (b * m + i)];
  }
  PetscFunctionReturn(0);
}

PetscErrorCode ReducedStepperDestroyCoupled(ReducedStepper s)
{
  ReducedCoupled *c = &s->coupled;

  PetscFunctionBeginUser;
  PetscCall(PetscFree(c->mode));
  PetscCall(PetscFree3(c->E, c->F, c->own));
  PetscCall(PetscFree2(c->x, c->y));
  PetscCall(PetscFree(c->Cm));
  PetscCall(PetscFree(c->HC));
  PetscCall(PetscFree(c->Q));
  PetscCall(PetscFree(s->damped.C));
  PetscCall(PetscFree(s->damped.Cm));
  PetscCall(PetscFree(s->damped.Cx));
  PetscFunctionReturn(0);
}

/* x [blocks][n] of the coupled modes */
static void CoupledGather(const ReducedCoupled *c, PetscInt m, PetscInt blocks, const PetscReal from[], PetscReal x[])
{
  for (PetscInt b = 0; b < blocks; b++)
    for (PetscInt i = 0; i < c->n; i++) x[b * c->n + i] = from[b * m + c->mode[i]];
}

static void CoupledAdd(const ReducedCoupled *c, PetscInt m, PetscInt blocks, const PetscReal x[], PetscReal to[])
{
  for (PetscInt b = 0; b < blocks; b++)
    for (PetscInt i = 0; i < c->n; i++) to[b * m + c->mode[i]] += x[b * c->n + i];
}

void ReducedStepperMove(ReducedStepper s, const PetscReal x[], PetscReal next[])
{
  ReducedCoupled *c = &s->coupled;
  const PetscInt  m = s->model->m, n = c->n;

  for (PetscInt i = 0; i < 2 * m; i++) next[i] = 0;
  for (PetscInt k = 0; k < c->n_alone; k++) {
    const PetscInt i = c->mode[n + k];
    PetscReal(*E)[2] = c->own[k].E;

    for (int a = 0; a < 2; a++) next[a * m + i] = E[0][a] * x[i] + E[1][a] * x[m + i] + E[2][a] * x[2 * m + i];
  }
  for (PetscInt i = 0; i < 2 * n; i++) c->y[i] = 0;
  CoupledGather(c, m, 3, x, c->x);
  ReducedBlockTimes(&(DenseBlock){c->E, 2 * n, 2 * n, 2 * n}, PETSC_FALSE, 1, c->x, c->y);
  ReducedBlockTimes(&(DenseBlock){c->F, 2 * n, n, 2 * n}, PETSC_FALSE, 1, &c->x[2 * n], c->y);
  CoupledAdd(c, m, 2, c->y, next);
}

void ReducedStepperPush(ReducedStepper s, const PetscReal g[], PetscReal next[])
{
  ReducedCoupled *c = &s->coupled;
  const PetscInt  m = s->model->m, n = c->n;

  for (PetscInt k = 0; k < c->n_alone; k++) {
    const PetscInt i = c->mode[n + k];

    for (int a = 0; a < 2; a++) next[a * m + i] += c->own[k].E[2][a] * g[i];
  }
  for (PetscInt i = 0; i < 2 * n; i++) c->y[i] = 0;
  CoupledGather(c, m, 1, g, c->x);
  ReducedBlockTimes(&(DenseBlock){c->F, 2 * n, n, 2 * n}, PETSC_FALSE, 1, c->x, c->y);
  CoupledAdd(c, m, 2, c->y, next);
}

void ReducedStepperDelay(ReducedStepper s, const PetscReal change[], PetscReal dq[])
{
  ReducedCoupled *c = &s->coupled;
  const PetscInt  n = 3 * s->model->n_pairs;

  CoupledGather(c, s->model->m, 1, change, c->x);
  ReducedBlockTimes(&(DenseBlock){c->HC, n, c->n, n}, PETSC_FALSE, -1 / s->dt, c->x, dq);
}

void ReducedStepperDrag(ReducedStepper s, PetscReal scale, const PetscReal dq[], PetscReal g[])
{
  ReducedCoupled *c = &s->coupled;
  const PetscInt  n = 3 * s->model->n_pairs;

  for (PetscInt i = 0; i < c->n; i++) c->y[i] = 0;
  ReducedBlockTimes(&(DenseBlock){c->Cm, c->n, n, c->n}, PETSC_FALSE, scale, dq, c->y);
  CoupledAdd(c, s->model->m, 1, c->y, g);
}

PetscReal ReducedStepperDampingForm(ReducedStepper s, const PetscReal x[])
{
  ReducedCoupled *c = &s->coupled;
  const PetscInt  m = s->model->m, n = 3 * c->n;
  PetscReal       sum;

  CoupledGather(c, m, 3, x, c->x);
  sum = ReducedForm(n, n, c->Q, c->x);
  for (PetscInt k = 0; k < c->n_alone; k++) {
    const PetscInt   i = c->mode[c->n + k];
    const PetscReal  z = x[i], v = x[m + i], g = x[2 * m + i];
    const PetscReal *Q = c->own[k].Q;

    sum += Q[0] * z * z + Q[1] * z * v + Q[2] * v * v + Q[3] * z * g + Q[4] * v * g + Q[5] * g * g;
  }
  return sum;
}
