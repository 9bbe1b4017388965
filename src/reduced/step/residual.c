/*
   What the damping of the residual adds (reduced.h). With F that of the coordinates, eta_{n+1} = e - G q_{n+1} + F P'
   lambda_{n+1} / 2,

      q_{n+1} = H (W lambda_{n+1} / 2 - Cm' F P' lambda_{n+1} / (2 dt) + what is known),   H = (W / 2 + Cx / dt - Cm'G /
      dt)^-1, G = F Cm / dt

   of which the step needs H W and H Cm'. Pairs give way in fewer directions than they have where both sides are held in
   one, or where more slaves than nodes of the master meet: forces z then move nothing, W z = Cx z = Cm z = P z = 0, and
   q is sought on ports of which the rows of the others are combinations. H is the inverse there. Forces that differ by
   such z move the same, and nothing tells them apart. On the others q is lambda_{n+1}: else a step would keep what it
   began with, and a cycle would be one of many.

   W must be regular in all directions in which pairs give way, which are those of P and W together: mean forces on
   bodies that give way by their modes alone hold back what alternates from step to step by nothing, and it grows
*/
#include "reduced/reducedimpl.h"
#include <petscblaslapack.h>

/* Of the largest diagonal: what is below is rounding, as of ContactComplianceCheckDefinite() */
#define RESIDUAL_RANK_RTOL 1e-10

/* Directions in which the pairs give way, by modes or by what these leave out: the rank of W + P'P, each over its
   largest diagonal */
static PetscErrorCode StepperCountDirections(const ReducedModel *model, PetscReal tolerance, PetscInt *directions)
{
  const PetscInt n = 3 * model->n_pairs, m = model->m;
  PetscReal      largest[2] = {0, 0}, *A;
  PetscInt      *chosen;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(n * n, &A, n, &chosen));
  ReducedTimesTransposed(&(DenseBlock){model->P, m, n, m}, &(DenseBlock){model->P, m, n, m}, A);
  for (PetscInt i = 0; i < n; i++) {
    largest[0] = PetscMax(largest[0], A[i + n * i]);
    largest[1] = PetscMax(largest[1], model->W[i + model->n_ports * i]);
  }
  for (PetscInt j = 0; j < n; j++)
    for (PetscInt i = 0; i < n; i++) {
      if (largest[0] > 0) A[i + n * j] /= largest[0];
      if (largest[1] > 0) A[i + n * j] += model->W[i + model->n_ports * j] / largest[1];
    }
  PetscCall(DenseChoose(n, A, tolerance, directions, chosen));
  PetscCall(PetscFree2(A, chosen));
  PetscFunctionReturn(0);
}

/* The ports on which q is sought, as many as the rank of W by pivoting on its diagonal. Fewer than the directions
   in which pairs give way at all: refused. */
static PetscErrorCode StepperChoosePorts(ReducedStepper s)
{
  const PetscInt n = 3 * s->model->n_pairs, N = s->model->n_ports;
  PetscInt       directions = n;
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
  if (s->rank < n) PetscCall(StepperCountDirections(s->model, RESIDUAL_RANK_RTOL, &directions));
  PetscCheck(s->rank >= directions, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "-dynamics_cutoff: of the %" PetscInt_FMT " directions in which contact pairs give way only %" PetscInt_FMT
             " are left above it, and their forces would alternate and grow; take a lower one, or -dynamics_model full",
             directions, s->rank);
  for (PetscInt i = 0; i < n && s->rank == n; i++) s->chosen[i] = i; /* all, in their order */
  PetscFunctionReturn(0);
}

/* The other ports behind the chosen ones, and their columns of W as sums of those of the chosen, combined = W_cc^-1
   W_co [n - rank][rank]. */
static PetscErrorCode StepperCombine(ReducedStepper s)
{
  const ReducedModel *model = s->model;
  const PetscInt      n = 3 * model->n_pairs, N = model->n_ports, rank = s->rank;
  PetscInt            last = rank;
  PetscReal          *A;
  PetscBLASInt       *pivot;

  PetscFunctionBeginUser;
  if (rank == n) PetscFunctionReturn(0);
  for (PetscInt i = 0; i < n; i++) {
    PetscInt k = 0;

    while (k < rank && s->chosen[k] != i) k++;
    if (k == rank) s->chosen[last++] = i;
  }
  PetscCall(PetscMalloc1(rank * (n - rank), &s->combined));
  PetscCall(PetscMalloc2(rank * rank, &A, rank, &pivot));
  for (PetscInt l = 0; l < n; l++)
    for (PetscInt k = 0; k < rank; k++)
      *(l < rank ? &A[k + rank * l] : &s->combined[k + rank * (l - rank)]) = model->W[s->chosen[k] + N * s->chosen[l]];
  PetscCall(DenseFactor(rank, A, pivot, NULL));
  PetscCall(DenseSolve(rank, A, pivot, PETSC_FALSE, n - rank, s->combined));
  PetscCall(PetscFree2(A, pivot));
  PetscFunctionReturn(0);
}

/* q of the other ports := lambda, what that changes taken over by the chosen ones: W q stays the same. */
void ReducedStepperSettle(ReducedStepper s, const PetscReal lambda[])
{
  const PetscInt rank = s->rank;

  for (PetscInt l = rank; l < 3 * s->model->n_pairs; l++) {
    const PetscInt  other = s->chosen[l];
    const PetscReal off   = s->q[other] - lambda[other];

    s->q[other] = lambda[other];
    for (PetscInt k = 0; k < rank; k++) s->q[s->chosen[k]] += s->combined[k + rank * (l - rank)] * off;
  }
}

/* Of X the chosen rows are known; zero in the others then */
PetscErrorCode ReducedStepperApplyH(ReducedStepper s, PetscInt columns, PetscReal X[])
{
  const PetscInt n = 3 * s->model->n_pairs, rank = s->rank;
  PetscReal     *Y;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(rank * columns, &Y));
  for (PetscInt j = 0; j < columns; j++)
    for (PetscInt i = 0; i < rank; i++) Y[i + rank * j] = X[s->chosen[i] + n * j];
  PetscCall(DenseSolve(rank, s->A, s->pivot, PETSC_FALSE, columns, Y));
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

/* Undamped there is no H, and q = lambda. H W and H Cm' have zero rows at ports that are not chosen. */
PetscErrorCode ReducedStepperSetResidual(ReducedStepper s)
{
  const ReducedModel *model = s->model;
  const PetscInt      m = model->m, n = 3 * model->n_pairs;
  PetscBool           singular;

  PetscFunctionBeginUser;
  s->rank = n;
  if (!n) PetscFunctionReturn(0);
  PetscCall(StepperChoosePorts(s));
  if (!model->Cx) PetscFunctionReturn(0);
  PetscCall(StepperCombine(s));
  PetscCall(PetscMalloc2(n * n, &s->HW, n * m, &s->HC));
  PetscCall(PetscMalloc2(s->rank * s->rank, &s->A, s->rank, &s->pivot));
  PetscCall(StepperFormResidual(s, s->A));
  for (PetscInt j = 0; j < n; j++) PetscCall(PetscArraycpy(&s->HW[n * j], &model->W[model->n_ports * j], n));
  for (PetscInt j = 0; j < n; j++)
    for (PetscInt k = 0; k < m; k++) s->HC[j + n * k] = model->Cm[k + m * j];
  PetscCall(DenseFactor(s->rank, s->A, s->pivot, &singular));
  PetscCheck(!singular, PETSC_COMM_SELF, PETSC_ERR_MAT_LU_ZRPVT,
             "the compliance of the contact pairs is singular: take a lower -dynamics_cutoff");
  PetscCall(ReducedStepperApplyH(s, n, s->HW));
  PetscCall(ReducedStepperApplyH(s, m, s->HC));
  if (!model->n_branches) PetscCall(PetscFree2(s->A, s->pivot));
  PetscFunctionReturn(0);
}
