/*
   Unit test of reduced/warp: eigenvalues of a small model about steady sliding as steps see them, by the formula, beside those of
   the matrix of one step, which is the derivative of ReducedStep() and knows no formula. Only motions are compared. What steps do
   to forces that alternate (step/relax.c) adds eigenvalues of its own and moves these by less than is allowed: case `cycle` tests that.
*/
#include "check.h"
#include "petscmain.h"
#include "reduced/reducedimpl.h"
#include <complex.h>
#include <slepcsys.h>

#define M_MODES 4
#define PAIRS   2
#define PORTS   (3 * PAIRS + 1) /* and a load */
#define SPEED   10
#define MU      0.4

typedef struct {
  ReducedModel model;
  PetscReal    omega2[M_MODES], C[M_MODES * M_MODES], P[M_MODES * PORTS], W[PORTS * PORTS], Cm[M_MODES * 3 * PAIRS],
    Cx[9 * PAIRS * PAIRS], gap[PAIRS];
  FrictionLaw law[PAIRS];
} Small;

/* Two pairs that a load presses; nothing moves along b, where friction alone would damp. damping 0: none */
static void SmallCreate(PetscReal damping, Small *s)
{
  const PetscReal frequency[M_MODES] = {0, 1, 1.3, 6};
  const PetscReal shape[4][M_MODES]  = {
     {0.6, 0.8, 0.3, 0.5}, {0.5, -0.4, 0.7, 0.2}, {0.7, -0.3, 0.6, -0.6}, {0.3, 0.6, 0.5, 0.1}};

  *s = (Small){.gap = {0}};
  for (int i = 0; i < PAIRS; i++) s->law[i] = (FrictionLaw){.speed = SPEED, .parameter = {MU}};
  s->model = (ReducedModel){.m        = M_MODES,
                            .n_pairs  = PAIRS,
                            .n_loads  = 1,
                            .n_ports  = PORTS,
                            .omega2   = s->omega2,
                            .C        = damping > 0 ? s->C : NULL,
                            .P        = s->P,
                            .W        = s->W,
                            .Cm       = damping > 0 ? s->Cm : NULL,
                            .Cx       = damping > 0 ? s->Cx : NULL,
                            .gap      = s->gap,
                            .friction = s->law};
  for (int k = 0; k < M_MODES; k++) {
    s->omega2[k] = frequency[k] * frequency[k];
    for (int i = 0; i < PAIRS; i++)
      for (int d = 0; d < 2; d++) s->P[k + M_MODES * (3 * i + d)] = shape[2 * i + d][k];
    s->P[k + M_MODES * 3 * PAIRS] = -shape[0][k] - shape[2][k];
    for (int l = 0; l < M_MODES; l++) s->C[k + M_MODES * l] = damping * (k == l ? 1 : 0.3);
    for (int i = 0; i < 3 * PAIRS; i++) s->Cm[k + M_MODES * i] = i % 3 == 2 ? 0 : 0.02 * damping * (1 + i - k);
  }
  for (int i = 0; i < PORTS; i++) s->W[i * (PORTS + 1)] = 0.2 + 0.01 * i;
  s->W[3] = s->W[3 * PORTS] = 0.05;
  s->W[1] = s->W[PORTS] = 0.03;
  for (int i = 0; i < 3 * PAIRS; i++) s->Cx[i * (3 * PAIRS + 1)] = i % 3 == 2 ? 1e-9 : 0.05 * damping;
}

/* Eigenvalues (of e^(s dt)) of the matrix of a step about the sliding state, [*n], which the caller frees */
static PetscErrorCode StepEigen(const Small *s, PetscReal dt, PetscInt *n, PetscReal **re, PetscReal **im)
{
  const PetscReal load = 1, way[PAIRS] = {SPEED * dt, SPEED * dt};
  PetscReal      *X;
  PetscBool       found;
  ReducedState    state;
  ReducedReport   report;
  ReducedStepper  stepper;
  ReducedTangent  tangent;

  PetscFunctionBeginUser;
  *n = ReducedTangentSize(&s->model);
  PetscCall(ReducedStateCreate(&s->model, &state));
  PetscCall(ReducedReportCreate(&s->model, &report));
  PetscCall(ReducedEquilibrium(&s->model, &load, &state, &found));
  PetscCheck(found, PETSC_COMM_SELF, PETSC_ERR_PLIB, "no sliding state");
  PetscCall(ReducedStepperCreate(&s->model, dt, 1e-13, &stepper));
  PetscCall(ReducedStep(stepper, &(ReducedDrive){&load, way, NULL}, &state, &report));
  for (int i = 0; i < PAIRS; i++)
    PetscCheck(state.status[i] == CONTACT_SLIP, PETSC_COMM_SELF, PETSC_ERR_PLIB, "pair %d does not slide", i);
  PetscCall(ReducedTangentCreate(stepper, &tangent));
  PetscCall(PetscCalloc1(*n * *n, &X));
  for (PetscInt i = 0; i < *n; i++) X[i * (*n + 1)] = 1;
  PetscCall(ReducedTangentApply(tangent, *n, X));
  PetscCall(PetscMalloc2(*n, re, *n, im));
  PetscCall(DenseEigen(*n, X, *re, *im, NULL, NULL));
  PetscCall(PetscFree(X));
  PetscCall(ReducedTangentDestroy(&tangent));
  PetscCall(ReducedStepperDestroy(&stepper));
  PetscCall(ReducedReportDestroy(&report));
  PetscCall(ReducedStateDestroy(&state));
  PetscFunctionReturn(0);
}

/* Distance of e^(s dt) to the nearest of n numbers */
static PetscReal Nearest(double complex s, PetscReal dt, PetscInt n, const PetscReal re[], const PetscReal im[])
{
  const double complex wanted  = cexp(s * dt);
  PetscReal            nearest = PETSC_MAX_REAL;

  for (PetscInt i = 0; i < n; i++) nearest = PetscMin(nearest, hypot(re[i] - creal(wanted), im[i] - cimag(wanted)));
  return nearest;
}

/* Largest distances over all eigenvalues: of those by the formula, and of those without steps */
static PetscErrorCode Distances(const Small *s, PetscReal dt, PetscReal *formula, PetscReal *smooth)
{
  const PetscBool closed[PAIRS] = {PETSC_TRUE, PETSC_TRUE};
  PetscReal       sigma[2][2 * M_MODES], omega[2][2 * M_MODES], *re, *im;
  PetscInt        n;

  PetscFunctionBeginUser;
  PetscCall(StepEigen(s, dt, &n, &re, &im));
  PetscCall(ReducedLineariseSteps(&s->model, dt, closed, NULL, sigma[0], omega[0]));
  PetscCall(ReducedLinearise(&s->model, closed, NULL, PETSC_FALSE, sigma[1], omega[1]));
  *formula = *smooth = 0;
  for (int i = 0; i < 2 * M_MODES; i++) {
    *formula = PetscMax(*formula, Nearest(sigma[0][i] + omega[0][i] * I, dt, n, re, im));
    *smooth  = PetscMax(*smooth, Nearest(sigma[1][i] + omega[1][i] * I, dt, n, re, im));
  }
  PetscCall(PetscFree2(re, im));
  PetscFunctionReturn(0);
}

/* How many modes a step takes as coupled, damped by beta K: the first is rigid, the noise that of its C on a mesh; link:
   what couples the second and the third */
static PetscErrorCode Coupled(PetscReal noise, PetscReal link, PetscInt *n)
{
  Small          s;
  ReducedStepper stepper;

  PetscFunctionBeginUser;
  SmallCreate(0.01, &s);
  for (int k = 0; k < M_MODES; k++)
    for (int l = 0; l < M_MODES; l++) s.C[k + M_MODES * l] = k == l ? 0.01 * s.omega2[k] : noise * (k + l - 2.5);
  for (int i = 0; i < 3 * PAIRS * M_MODES; i++) s.Cm[i] = 0;
  s.C[0] = noise;
  s.C[1 + M_MODES * 2] += link;
  s.C[2 + M_MODES * 1] += link;
  PetscCall(ReducedStepperCreate(&s.model, 0.15, 1e-13, &stepper));
  *n = stepper->coupled.n;
  PetscCall(ReducedStepperDestroy(&stepper));
  PetscFunctionReturn(0);
}

/* Breaks when: rounding couples modes, of which rigid ones have no C_ii, or what couples them is taken for it */
static PetscErrorCode TestCoupled(int *failed)
{
  PetscInt n[3];

  PetscFunctionBeginUser;
  PetscCall(Coupled(1e-14, 0, &n[0]));
  PetscCall(Coupled(-1e-14, 0, &n[1]));
  PetscCall(Coupled(1e-14, 1e-8, &n[2]));
  *failed += CheckTrue("rounding couples no mode", n[0] == 0, (double)n[0]);
  *failed += CheckTrue("nor where a C_ii below zero is rounding", n[1] == 0, (double)n[1]);
  *failed += CheckTrue("a damper between two modes couples both", n[2] == 2, (double)n[2]);
  PetscFunctionReturn(0);
}

/* Breaks when: a mass, a damper or the way back to s is wrong */
static PetscErrorCode Tests(PetscMPIInt size, int *failed)
{
  Small     s;
  PetscReal formula, smooth;

  PetscFunctionBeginUser;
  (void)size;
  PetscCall(SlepcInitialize(NULL, NULL, NULL, NULL)); /* of matrix functions */
  SmallCreate(0, &s);
  PetscCall(Distances(&s, 0.15, &formula, &smooth));
  *failed += CheckTrue("undamped: steps of 0.15 s are seen", smooth > 1e-4, (double)smooth);
  *failed += CheckClose("undamped: the formula is exact", formula, 0, 1e-9);
  SmallCreate(0.01, &s);
  PetscCall(Distances(&s, 0.15, &formula, &smooth));
  *failed += CheckTrue("damped: steps of 0.15 s are seen", smooth > 1e-4, (double)smooth);
  *failed +=
    CheckTrue("damped: the formula leaves 2 % of it at most", formula < 0.02 * smooth, (double)(formula / smooth));
  PetscCall(TestCoupled(failed));
  PetscCall(SlepcFinalize());
  PetscFunctionReturn(0);
}

int main(int argc, char **argv)
{
  return PetscMain(argc, argv, Tests);
}
