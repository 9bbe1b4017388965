/*
   What the damping of the residual adds (reduced.h). With F that of the coordinates, eta_{n+1} = e - G q_{n+1} + F P' lambda_{n+1} / 2,

      q_{n+1} = H (W lambda_{n+1} / 2 - Cm' F P' lambda_{n+1} / (2 dt) + what is known),   H = (W / 2 + Cx / dt - Cm'G / dt)^-1,
      G = F Cm / dt

   of which the step needs H W and H Cm'. Where both sides of a pair are held in a direction, its rows of W, Cx and P are zero: q is
   sought on the other ports, and H is the inverse there.

   W must be regular on these: mean forces on bodies that give way by their modes alone hold back what alternates from step to
   step by nothing, and it grows
*/
#include "reducedimpl.h"
#include <petscblaslapack.h>

/* Of the largest diagonal of W: what is below is rounding, as of ContactComplianceCheckDefinite() */
#define RESIDUAL_RANK_RTOL 1e-10

/* Ports of the pairs in which a body moves */
static PetscInt StepperCountMoving(const ReducedModel *model, PetscReal tolerance)
{
  const PetscInt n = 3 * model->n_pairs, m = model->m;
  PetscInt       moving  = 0;
  PetscReal      largest = 0;

  for (PetscInt i = 0; i < m * n; i++) largest = PetscMax(largest, PetscAbsReal(model->P[i]));
  for (PetscInt i = 0; i < n; i++) {
    PetscReal p = 0;

    for (PetscInt k = 0; k < m; k++) p = PetscMax(p, PetscAbsReal(model->P[k + m * i]));
    moving += p > RESIDUAL_RANK_RTOL * largest || model->W[i + model->n_ports * i] > tolerance ? 1 : 0;
  }
  return moving;
}

/* The ports on which q is sought */
static PetscErrorCode StepperChoosePorts(ReducedStepper s)
{
  const PetscInt n = 3 * s->model->n_pairs, N = s->model->n_ports;
  PetscInt       moving;
  PetscReal     *W, largest = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n, &s->chosen));
  PetscCall(PetscMalloc1(n * n, &W));
  for (PetscInt j = 0; j < n; j++) {
    PetscCall(PetscArraycpy(&W[n * j], &s->model->W[N * j], n));
    largest = PetscMax(largest, W[j + n * j]);
  }
  PetscCall(DenseChoose(n, W, RESIDUAL_RANK_RTOL * largest, &s->rank, s->chosen));
  PetscCall(PetscFree(W));
  moving = StepperCountMoving(s->model, RESIDUAL_RANK_RTOL * largest);
  PetscCheck(s->rank >= moving, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "-dynamics_cutoff: of the %" PetscInt_FMT " directions in which contact pairs give way only %" PetscInt_FMT
             " are left above it, and their forces would alternate and grow; take a lower one, or -dynamics_model full",
             moving, s->rank);
  for (PetscInt i = 0; i < n && s->rank == n; i++) s->chosen[i] = i; /* all, in their order */
  PetscFunctionReturn(0);
}

/* X [columns][n], of which the chosen rows are known, := H X, zero in the others; A [rank][rank] LU factors */
static PetscErrorCode StepperApplyH(ReducedStepper s, const PetscReal A[], const PetscBLASInt pivot[], PetscInt columns,
                                    PetscReal X[])
{
  const PetscInt n = 3 * s->model->n_pairs, rank = s->rank;
  PetscReal     *Y;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(rank * columns, &Y));
  for (PetscInt j = 0; j < columns; j++)
    for (PetscInt i = 0; i < rank; i++) Y[i + rank * j] = X[s->chosen[i] + n * j];
  PetscCall(DenseSolve(rank, A, pivot, PETSC_FALSE, columns, Y));
  PetscCall(PetscArrayzero(X, n * columns));
  for (PetscInt j = 0; j < columns; j++)
    for (PetscInt i = 0; i < rank; i++) X[s->chosen[i] + n * j] = Y[i + rank * j];
  PetscCall(PetscFree(Y));
  PetscFunctionReturn(0);
}

/* W / 2 + Cx / dt - Cm'G / dt on the chosen ports, in A [rank][rank] */
static PetscErrorCode StepperFormResidual(ReducedStepper s, PetscReal A[])
{
  const ReducedModel *model = s->model;
  const PetscInt      m = model->m, n = 3 * model->n_pairs, rank = s->rank;
  PetscReal          *G, *CG;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(n * n, &CG, n * m, &G));
  ReducedTimes(&(DenseBlock){s->F, m, m, 2 * m}, &(DenseBlock){model->Cm, m, n, m}, G);
  for (PetscInt i = 0; i < n * m; i++) G[i] /= s->dt;
  ReducedTimesTransposed(&(DenseBlock){model->Cm, m, n, m}, &(DenseBlock){G, m, n, m}, CG);
  for (PetscInt l = 0; l < rank; l++)
    for (PetscInt k = 0; k < rank; k++) {
      const PetscInt i = s->chosen[k], j = s->chosen[l];

      A[k + rank * l] = 0.5 * model->W[i + model->n_ports * j] + (model->Cx[i + n * j] - CG[i + n * j]) / s->dt;
    }
  PetscCall(PetscFree2(CG, G));
  PetscFunctionReturn(0);
}

PetscErrorCode ReducedStepperSetResidual(ReducedStepper s)
{
  const ReducedModel *model = s->model;
  const PetscInt      m = model->m, n = 3 * model->n_pairs;
  PetscReal          *A;
  PetscBLASInt       *pivot;
  PetscBool           singular;

  PetscFunctionBeginUser;
  s->rank = n;
  if (!n) PetscFunctionReturn(0);
  PetscCall(StepperChoosePorts(s));
  if (!model->Cx) PetscFunctionReturn(0);
  PetscCall(PetscMalloc2(n * n, &s->HW, n * m, &s->HC));
  PetscCall(PetscMalloc2(s->rank * s->rank, &A, s->rank, &pivot));
  PetscCall(StepperFormResidual(s, A));
  for (PetscInt j = 0; j < n; j++) PetscCall(PetscArraycpy(&s->HW[n * j], &model->W[model->n_ports * j], n));
  for (PetscInt j = 0; j < n; j++)
    for (PetscInt k = 0; k < m; k++) s->HC[j + n * k] = model->Cm[k + m * j];
  PetscCall(DenseFactor(s->rank, A, pivot, &singular));
  PetscCheck(!singular, PETSC_COMM_SELF, PETSC_ERR_MAT_LU_ZRPVT,
             "the compliance of the contact pairs is singular: take a lower -dynamics_cutoff");
  PetscCall(StepperApplyH(s, A, pivot, n, s->HW));
  PetscCall(StepperApplyH(s, A, pivot, m, s->HC));
  PetscCall(PetscFree2(A, pivot));
  PetscFunctionReturn(0);
}
