/*
   The matrices of a step, exact for forces g on the modes that stay constant in it. z = (eta, rate) obeys z' = A z +
   (0, g):

      z(dt) = E z + F g,   [E F; 0 I] = exp(dt [A (0 I)'; 0 0]),     A = [0 I; -Omega^2 -C]

   so that overdamped and almost rigid modes need no formula of their own. Rates are divided by the highest angular
   frequency, which balances A. Damping takes int rate'C rate dt, with x = (z, g) the form x'Q x (C. F. Van Loan, IEEE
   Trans. Automat. Contr. 23, 1978) in a part h = dt / 2^k that is short, since exp(-h B') grows, and then k times over
   twice the time:

      exp(h [-B' S; 0 B]) = [. G; 0 X],   Q = X'G,     B = [A (0 I)'; 0 0],  S = diag(0, C, 0)
      Q(2 h) = Q + X'Q X,   X(2 h) = X X.
*/
#include "reduced/sparse/sparse.h"
#include <slepcfn.h>
#include <petscblaslapack.h>

/* X := exp(X), [n][n], by SLEPc's FNEXP (scaling and squaring of a Pade approximation; SLEPc manual page FNEXP). */
static PetscErrorCode ExponentialOf(PetscInt n, PetscScalar X[])
{
  FN           fn;
  Mat          A, B;
  PetscScalar *value;

  PetscFunctionBeginUser;
  PetscCall(FNCreate(PETSC_COMM_SELF, &fn));
  PetscCall(FNSetType(fn, FNEXP));
  PetscCall(MatCreateSeqDense(PETSC_COMM_SELF, n, n, X, &A));
  PetscCall(MatDuplicate(A, MAT_DO_NOT_COPY_VALUES, &B));
  PetscCall(FNEvaluateFunctionMat(fn, A, B));
  PetscCall(MatDenseGetArray(B, &value));
  PetscCall(PetscArraycpy(X, value, n * n));
  PetscCall(MatDenseRestoreArray(B, &value));
  PetscCall(MatDestroy(&B));
  PetscCall(MatDestroy(&A));
  PetscCall(FNDestroy(&fn));
  PetscFunctionReturn(0);
}

/* dt B in the corner of X [size][size], rates and forces in units of the frequency w */
static void StepperSetGenerator(const ReducedModel *model, PetscReal dt, PetscReal w, PetscInt size, PetscReal X[])
{
  const PetscInt m = model->m;

  for (PetscInt i = 0; i < m; i++) {
    X[i + size * (m + i)]         = dt * w;
    X[m + i + size * i]           = -dt * model->omega2[i] / w;
    X[m + i + size * (2 * m + i)] = dt / w;
    for (PetscInt j = 0; j < m && model->C; j++) X[m + i + size * (m + j)] = -dt * model->C[i + m * j];
  }
}

/* E and F from exp(dt B), back to rates in m sqrt(kg)/s */
static PetscErrorCode StepperSetResponse(ReducedStepper s)
{
  const PetscInt m = s->model->m, n = 3 * m;
  PetscReal     *X;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(n * n, &X));
  StepperSetGenerator(s->model, s->dt, s->w, n, X);
  PetscCall(ExponentialOf(n, X));
  for (PetscInt j = 0; j < n; j++) {
    for (PetscInt i = 0; i < 2 * m; i++) {
      const PetscReal unit = (i >= m ? s->w : 1) / (j >= m && j < 2 * m ? s->w : 1);

      if (j < 2 * m)
        s->E[i + 2 * m * j] = unit * X[i + n * j];
      else
        s->F[i + 2 * m * (j - 2 * m)] = unit * X[i + n * j];
    }
  }
  PetscCall(PetscFree(X));
  PetscFunctionReturn(0);
}

/* Halvings k of the step after which no column of dt B [n][n] exceeds 1 in its sum: exp(-h B') is then at most e in
   size. */
static int StepperCountHalvings(PetscInt n, const PetscReal B[])
{
  PetscReal largest = 0;
  int       k       = 0;

  for (PetscInt j = 0; j < n; j++) {
    PetscReal sum = 0;

    for (PetscInt i = 0; i < n; i++) sum += PetscAbsReal(B[i + n * j]);
    largest = PetscMax(largest, sum);
  }
  for (; largest > 1; largest /= 2) k++;
  return k;
}

/* X [n][n] and Q over h; the generator is h of dt B, S in those units */
static PetscErrorCode StepperSetShortDamping(ReducedStepper s, PetscReal h, const PetscReal B[], PetscReal X[],
                                             PetscReal Q[])
{
  const PetscInt m = s->model->m, n = 3 * m, N = 2 * n;
  PetscReal     *Y;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(N * N, &Y));
  for (PetscInt i = 0; i < n; i++) {
    for (PetscInt j = 0; j < n; j++) {
      Y[i + N * j]           = -h * B[j + n * i];
      Y[n + i + N * (n + j)] = h * B[i + n * j];
    }
  }
  for (PetscInt i = 0; i < m; i++)
    for (PetscInt j = 0; j < m; j++) Y[m + i + N * (n + m + j)] = h * s->dt * s->w * s->w * s->model->C[i + m * j];
  PetscCall(ExponentialOf(N, Y));
  for (PetscInt j = 0; j < n; j++) PetscCall(PetscArraycpy(&X[n * j], &Y[n + N * (n + j)], n));
  ReducedTimesTransposed(&(DenseBlock){X, n, n, n}, &(DenseBlock){&Y[N * n], n, n, N}, Q);
  PetscCall(PetscFree(Y));
  PetscFunctionReturn(0);
}

/* Q [3 m][3 m], made when works are asked for the first time; the exponential of twice the size costs eight times
   that of E and F. */
PetscErrorCode ReducedStepperSetDamping(ReducedStepper s)
{
  const PetscInt m = s->model->m, n = 3 * m;
  PetscReal     *B, *X, *Y, *Q;
  int            k;

  PetscFunctionBeginUser;
  if (!s->model->C || s->coupled.Q) PetscFunctionReturn(0);
  PetscCall(PetscCalloc4(n * n, &B, n * n, &X, n * n, &Y, n * n, &Q));
  StepperSetGenerator(s->model, s->dt, s->w, n, B);
  k = StepperCountHalvings(n, B);
  PetscCall(StepperSetShortDamping(s, PetscPowReal(2, -(PetscReal)k), B, X, Q));
  for (; k > 0; k--) {
    const DenseBlock x = {X, n, n, n};

    ReducedTimes(&(DenseBlock){Q, n, n, n}, &x, B);
    ReducedTimesTransposed(&x, &(DenseBlock){B, n, n, n}, Y);
    for (PetscInt i = 0; i < n * n; i++) Q[i] += Y[i];
    ReducedTimes(&x, &x, Y);
    PetscCall(PetscArraycpy(X, Y, n * n));
  }
  for (PetscInt j = 0; j < n; j++)
    for (PetscInt i = 0; i < n; i++)
      Q[i + n * j] /= (i >= m && i < 2 * m ? s->w : 1) * (j >= m && j < 2 * m ? s->w : 1);
  PetscCall(ReducedStepperSetCoupledDamping(s, Q));
  PetscCall(PetscFree4(B, X, Y, Q));
  PetscFunctionReturn(0);
}

PetscErrorCode ReducedStepperTakeFriction(ReducedStepper s)
{
  const ReducedModel *model = s->model;

  PetscFunctionBeginUser;
  if (!model->n_pairs) PetscFunctionReturn(0);
  PetscCall(ContactComplianceSetFriction(s->laws, model->friction, s->dt));
  PetscCall(ContactComplianceSetMemory(s->laws, 0, NULL));
  PetscFunctionReturn(0);
}

/* G = F P / 2 of unit forces at t_{n+1}; damped R = H D / 2 = (H W - H Cm' F P / dt) / 2 */
static PetscErrorCode StepperSetForces(ReducedStepper s)
{
  const ReducedModel *model = s->model;
  const PetscInt      m = model->m, n = 3 * model->n_pairs;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(2 * m * n, &s->G));
  ReducedTimes(&(DenseBlock){s->F, 2 * m, m, 2 * m}, &(DenseBlock){model->P, m, n, m}, s->G);
  for (PetscInt i = 0; i < 2 * m * n; i++) s->G[i] *= 0.5;
  if (!s->HW) PetscFunctionReturn(0);
  PetscCall(PetscMalloc1(n * n, &s->R));
  ReducedTimes(&(DenseBlock){s->HC, n, m, n}, &(DenseBlock){s->G, m, n, 2 * m}, s->R);
  for (PetscInt i = 0; i < n * n; i++) s->R[i] = 0.5 * s->HW[i] - s->R[i] / s->dt;
  PetscFunctionReturn(0);
}

/* dy / dlambda of the pairs, m/N: with D = W - Cm' F P' / dt, (P'F P + D'H D) / 2; undamped W + P'F P / 2. G and R
   hold F P / 2 and H D / 2. The mean with its transpose, symmetric to the last bit, as the solver of the laws asks
   for. */
static PetscErrorCode StepperSetCompliance(ReducedStepper s)
{
  const ReducedModel *model = s->model;
  const PetscInt      m = model->m, n = 3 * model->n_pairs;
  const DenseBlock    half = {s->G, m, n, 2 * m};
  PetscReal          *PFP, *D;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(n * n, &PFP, n * n, &D));
  ReducedTimesTransposed(&(DenseBlock){model->P, m, n, m}, &half, PFP);
  for (PetscInt j = 0; j < n; j++)
    for (PetscInt i = 0; i < n; i++) s->W[i + n * j] = model->W[i + model->n_ports * j];
  if (s->R) {
    ReducedTimesTransposed(&(DenseBlock){model->Cm, m, n, m}, &half, D);
    for (PetscInt i = 0; i < n * n; i++) D[i] = s->W[i] - 2 * D[i] / s->dt;
    ReducedTimesTransposed(&(DenseBlock){D, n, n, n}, &(DenseBlock){s->R, n, n, n}, s->W);
  }
  for (PetscInt j = 0; j < n; j++)
    for (PetscInt i = 0; i <= j; i++)
      s->W[i + n * j] = s->W[j + n * i] = 0.5 * (s->W[i + n * j] + s->W[j + n * i] + PFP[i + n * j] + PFP[j + n * i]);
  PetscCall(PetscFree2(PFP, D));
  PetscFunctionReturn(0);
}

/* The solver of the contact laws on that compliance */
static PetscErrorCode StepperSetLaws(ReducedStepper s)
{
  const ReducedModel *model = s->model;
  PetscBool           definite;

  PetscFunctionBeginUser;
  if (!model->n_pairs) PetscFunctionReturn(0);
  PetscCall(ContactComplianceCreate(model->n_pairs, s->W, &s->laws));
  PetscCall(ContactComplianceCheckDefinite(s->laws, &definite));
  PetscCheck(
    definite, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
    "the compliance of the contact pairs is not positive semidefinite: rounding of a -dynamics_cutoff that leaves too "
    "little above it; take a lower one");
  PetscCall(ContactComplianceSetFriction(s->laws, model->friction, s->dt));
  if (model->spring) PetscCall(ContactComplianceSetSprings(s->laws, model->spring));
  PetscCall(ContactComplianceSetTolerance(s->laws, s->rtol));
  PetscFunctionReturn(0);
}

/* The same where the compliance has no numbers: sums of modes and residual that are positive by themselves */
static PetscErrorCode StepperSetSparseLaws(ReducedStepper s)
{
  const ReducedModel *model = s->model;
  ComplianceMap       map;

  PetscFunctionBeginUser;
  PetscCall(SparseLawsCreate(model->sparse, s, &s->sparse));
  SparseLawsGetMap(s->sparse, &map);
  PetscCall(ContactComplianceCreateMap(model->n_pairs, &map, &s->laws));
  PetscCall(ContactComplianceSetFriction(s->laws, model->friction, s->dt));
  PetscCall(ContactComplianceSetTolerance(s->laws, PetscMax(s->rtol, SPARSE_RTOL)));
  PetscFunctionReturn(0);
}

/* w, rad/s: the highest frequency, or 1 / dt where that is more: rates over w are of the size of coordinates. Some
   (3 m)^3 and n^3 operations, once for all steps of one length. */
PetscErrorCode ReducedStepperCreate(const ReducedModel *model, PetscReal dt, PetscReal rtol, ReducedStepper *stepper)
{
  const PetscInt m = model->m, n = 3 * model->n_pairs;
  ReducedStepper s;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(stepper));
  s        = *stepper;
  s->model = model;
  s->dt    = dt;
  s->rtol  = rtol;
  PetscCall(ReducedStepperSetBranches(s));
  PetscCall(ReducedStepperFindCoupled(s));
  model = s->model;
  s->w  = PetscMax(1 / dt, m ? PetscSqrtReal(model->omega2[m - 1]) : 0);
  PetscCall(PetscMalloc3(4 * m * m, &s->E, 2 * m * m, &s->F, model->sparse ? 0 : n * n, &s->W));
  PetscCall(PetscCalloc5(3 * m, &s->x, 3 * m, &s->next, 3 * m, &s->product, n, &s->free, n, &s->slip0));
  PetscCall(PetscCalloc3(model->n_ports, &s->mean, n, &s->r, model->n_ports, &s->port));
  PetscCall(PetscCalloc4(n, &s->q, n, &s->dq, n, &s->slip, model->n_pairs, &s->relaxed));
  PetscCall(StepperSetResponse(s));
  s->rank = n;
  if (model->sparse) {
    PetscCall(StepperSetForces(s));
    PetscCall(StepperSetSparseLaws(s));
    PetscCall(ReducedStepperSetCoupled(s));
    PetscFunctionReturn(0);
  }
  PetscCall(ReducedStepperSetResidual(s));
  PetscCall(StepperSetForces(s));
  PetscCall(StepperSetCompliance(s));
  PetscCall(PetscFree(s->R));
  PetscCall(PetscFree(s->G));
  PetscCall(ReducedStepperSetCoupled(s));
  PetscCall(StepperSetLaws(s));
  PetscFunctionReturn(0);
}

PetscErrorCode ReducedStepperDestroy(ReducedStepper *stepper)
{
  ReducedStepper s = *stepper;

  PetscFunctionBeginUser;
  if (!s) PetscFunctionReturn(0);
  PetscCall(ContactComplianceDestroy(&s->laws));
  PetscCall(SparseLawsDestroy(&s->sparse));
  PetscCall(PetscFree3(s->E, s->F, s->W));
  PetscCall(PetscFree2(s->HW, s->HC));
  PetscCall(PetscFree2(s->A, s->pivot));
  PetscCall(ReducedStepperDestroyCoupled(s));
  PetscCall(PetscFree2(s->known, s->elongation));
  PetscCall(PetscFree(s->R));
  PetscCall(PetscFree(s->G));
  PetscCall(PetscFree(s->chosen));
  PetscCall(PetscFree(s->combined));
  PetscCall(PetscFree5(s->x, s->next, s->product, s->free, s->slip0));
  PetscCall(PetscFree3(s->mean, s->r, s->port));
  PetscCall(PetscFree4(s->q, s->dq, s->slip, s->relaxed));
  PetscCall(PetscFree(*stepper));
  PetscFunctionReturn(0);
}
