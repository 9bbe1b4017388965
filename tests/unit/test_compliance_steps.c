/*
   Unit test of contact/compliance in time: a holder on six springs carries 36 pairs on a half-space, pressed and slid over
   it. Trapezoidal rule per coordinate eta of the holder, with the forces at t_{n+1}:

      g = 1 / (4 / dt^2 + omega^2),   eta_{n+1} = g (4 / dt^2 eta + 4 / dt eta' + eta'' + f) + g P'lambda
      r = P eta_{n+1} + W_0 lambda,   hence   W = W_0 + sum of g P P'

   Kicked, all pairs part and meet again; without sliding, most stick.
*/
#include "check.h"
#include "compliancescene.h"
#include "contact/compliance/compliance.h"
#include "petscmain.h"

#define STEP_PAIRS 36
#define STEP_ROWS  (3 * STEP_PAIRS)
#define HOLDER     6
#define MASS       0.03 /* kg */

/* One run */
typedef struct {
  ComplianceScene   s;
  PetscReal         P[HOLDER][STEP_ROWS], omega[HOLDER], eta[HOLDER], rate[HOLDER], acceleration[HOLDER], f[HOLDER];
  PetscReal         lambda[STEP_ROWS], before[STEP_ROWS], r[STEP_ROWS], dt, sliding, worst;
  ContactCompliance c;
  PetscInt          n_apart, n_together, n_stick; /* steps with all pairs open, with most closed; pairs that stuck */
} SteppedRun;

static PetscErrorCode RunCreate(PetscReal mu, PetscReal dt, PetscReal sliding, PetscReal kick, SteppedRun *run)
{
  const int side = 6;

  PetscFunctionBeginUser;
  *run = (SteppedRun){.dt = dt, .sliding = sliding};
  PetscCall(SceneCreate(STEP_PAIRS, 7, &run->s));
  SceneAddHalfSpace(&run->s, 1e-8, 0.5);
  for (int k = 0; k < HOLDER; k++) {
    PetscReal m[6];

    for (int i = 0; i < 6; i++) m[i] = SceneDraw(&run->s) / sqrt(MASS);
    run->omega[k] = 2 * PETSC_PI * (2500 + 400 * k);
    run->rate[k]  = kick * SceneDraw(&run->s) * sqrt(MASS);
    for (int p = 0; p < STEP_PAIRS; p++) {
      const PetscReal x = (PetscReal)(p % side) / side - 0.5, y = (PetscReal)(p / side) / side - 0.5;

      run->P[k][3 * p]     = m[0] + m[3] * x + m[4] * y;
      run->P[k][3 * p + 1] = m[1] - m[5] * y;
      run->P[k][3 * p + 2] = m[2] + m[5] * x;
      run->f[k] -= 100. / STEP_PAIRS * run->P[k][3 * p];
    }
    run->acceleration[k] = run->f[k];
    for (int i = 0; i < STEP_ROWS; i++)
      for (int j = 0; j < STEP_ROWS; j++)
        run->s.W[j * STEP_ROWS + i] += run->P[k][i] * run->P[k][j] / (4 / (dt * dt) + run->omega[k] * run->omega[k]);
  }
  for (int p = 0; p < STEP_PAIRS; p++) run->s.mu[p] = mu;
  PetscCall(ContactComplianceCreate(STEP_PAIRS, run->s.W, &run->c));
  PetscCall(SceneSetFriction(run->c, STEP_PAIRS, run->s.mu, NULL, NULL, 0));
  PetscFunctionReturn(0);
}

static PetscErrorCode RunDestroy(SteppedRun *run)
{
  PetscFunctionBeginUser;
  PetscCall(ContactComplianceDestroy(&run->c));
  PetscCall(SceneDestroy(&run->s));
  PetscFunctionReturn(0);
}

/* Guess of the forces from the last two steps */
static void RunGuess(SteppedRun *run)
{
  for (int p = 0; p < STEP_PAIRS; p++) {
    PetscReal *now = &run->lambda[3 * p], *before = &run->before[3 * p];

    for (int i = 0; i < 3; i++) {
      const PetscReal next = 2 * now[i] - before[i];

      before[i] = now[i];
      now[i]    = next;
    }
    if (now[0] <= 0) now[0] = now[1] = now[2] = 0;
  }
}

static PetscErrorCode RunStep(SteppedRun *run, PetscInt *unsolved)
{
  const PetscReal      dt = run->dt;
  PetscReal            ahead[HOLDER];
  PetscInt             n[CONTACT_N_STATUS] = {0};
  ComplianceReport     report;
  const ContactStatus *status;

  PetscFunctionBeginUser;
  for (int i = 0; i < STEP_ROWS; i++) run->s.q[i] = 0;
  for (int k = 0; k < HOLDER; k++) {
    const PetscReal g = 1 / (4 / (dt * dt) + PetscSqr(run->omega[k]));

    ahead[k] = g * (4 / (dt * dt) * run->eta[k] + 4 / dt * run->rate[k] + run->acceleration[k] + run->f[k]);
    for (int i = 0; i < STEP_ROWS; i++) run->s.q[i] += run->P[k][i] * ahead[k];
  }
  for (int i = 0; i < 2 * STEP_PAIRS; i++)
    run->s.slip0[i] = run->r[i / 2 * 3 + 1 + i % 2] - (i % 2 ? 0 : run->sliding * dt);
  RunGuess(run);
  PetscCall(ContactComplianceSolve(run->c, run->s.q, run->s.slip0, run->lambda, run->r, &report));
  *unsolved += !report.converged;
  run->worst = fmax(run->worst, SceneViolation(&run->s, run->lambda));
  PetscCall(ContactComplianceGetStatus(run->c, &status));
  for (int p = 0; p < STEP_PAIRS; p++) n[status[p]]++;
  run->n_apart += n[CONTACT_OPEN] == STEP_PAIRS;
  run->n_together += n[CONTACT_OPEN] < STEP_PAIRS / 2;
  run->n_stick += n[CONTACT_STICK];
  for (int k = 0; k < HOLDER; k++) {
    PetscReal       force = 0, eta;
    const PetscReal g     = 1 / (4 / (dt * dt) + PetscSqr(run->omega[k]));

    for (int i = 0; i < STEP_ROWS; i++) force += run->P[k][i] * run->lambda[i];
    eta                  = ahead[k] + g * force;
    run->rate[k]         = 2 / dt * (eta - run->eta[k]) - run->rate[k];
    run->eta[k]          = eta;
    run->acceleration[k] = run->f[k] + force - PetscSqr(run->omega[k]) * eta;
  }
  PetscFunctionReturn(0);
}

/* Breaks when: a step ends without a solution; sliding pairs need new factors for each iteration */
static PetscErrorCode TestRun(const char name[], const PetscReal values[4], PetscInt n_steps, SteppedRun *run,
                              ComplianceReport *all, int *failed)
{
  PetscInt unsolved = 0;

  PetscFunctionBeginUser;
  PetscCall(RunCreate(values[0], values[1], values[2], values[3], run));
  for (PetscInt k = 0; k < n_steps; k++) PetscCall(RunStep(run, &unsolved));
  PetscCall(ContactComplianceGetTotals(run->c, all));
  printf("%s: %.1f iterations, %.2f factors a step; routes %d %d %d %d\n", name,
         (double)all->iterations / (double)n_steps, (double)all->factors / (double)n_steps, (int)all->routes[0],
         (int)all->routes[1], (int)all->routes[2], (int)all->routes[3]);
  *failed += CheckTrue(name, unsolved == 0 && all->converged && all->steps == n_steps, unsolved);
  *failed += CheckClose(name, run->worst, 0, 1e-11);
  PetscCall(RunDestroy(run));
  PetscFunctionReturn(0);
}

static PetscErrorCode TestRuns(int *failed)
{
  SteppedRun       run;
  ComplianceReport all;

  PetscFunctionBeginUser;
  PetscCall(TestRun("sliding", (PetscReal[]){0.5, 8e-6, 1, 0.003}, 500, &run, &all, failed));
  *failed += CheckTrue("sliding: factors are renewed two to three times a step", all.factors < 3 * all.steps,
                       (double)all.factors);
  *failed += CheckTrue("sliding: few iterations, no other method",
                       all.routes[COMPLIANCE_CHORD] == all.steps && all.iterations < 10 * all.steps, all.iterations);
  PetscCall(TestRun("kicked", (PetscReal[]){0.5, 8e-6, 1, 0.3}, 500, &run, &all, failed));
  *failed +=
    CheckTrue("kicked: all pairs apart, then most together", run.n_apart > 50 && run.n_together > 5, run.n_together);
  PetscCall(TestRun("long steps, mu 1", (PetscReal[]){1, 1e-4, 0.1, 0.1}, 300, &run, &all, failed));
  PetscCall(TestRun("at rest", (PetscReal[]){0.5, 8e-6, 0, 0.01}, 200, &run, &all, failed));
  *failed += CheckTrue("at rest: pairs stick", run.n_stick > 1000, run.n_stick);
  PetscCall(TestRun("slow, mu 1", (PetscReal[]){1, 8e-6, 0.01, 0.01}, 200, &run, &all, failed));
  PetscFunctionReturn(0);
}

/* Breaks when: something of the factors that the next steps see is lost */
static PetscErrorCode TestMemory(int *failed)
{
  SteppedRun        run, again;
  ContactCompliance c;
  PetscInt          n, unsolved   = 0;
  PetscReal        *values, apart = 0;

  PetscFunctionBeginUser;
  PetscCall(RunCreate(0.5, 8e-6, 1, 0.003, &run));
  for (int k = 0; k < 77; k++) PetscCall(RunStep(&run, &unsolved));
  PetscCall(ContactComplianceGetMemory(run.c, &n, &values));
  PetscCall(ContactComplianceCreate(STEP_PAIRS, run.s.W, &c));
  PetscCall(SceneSetFriction(c, run.s.n, run.s.mu, NULL, NULL, 0));
  PetscCall(ContactComplianceSetMemory(c, n, values));
  again   = run;
  again.c = c;
  for (int k = 0; k < 50; k++) PetscCall(RunStep(&run, &unsolved));
  for (int k = 0; k < 50; k++) PetscCall(RunStep(&again, &unsolved));
  for (int i = 0; i < STEP_ROWS; i++) apart = fmax(apart, fabs(run.lambda[i] - again.lambda[i]));
  for (int i = 0; i < STEP_ROWS; i++) apart = fmax(apart, fabs(run.r[i] - again.r[i]));
  *failed += CheckTrue("restart: there are factors to keep", n > 0, n);
  *failed += CheckClose("restart: bitwise", apart, 0, 0);
  PetscCall(PetscFree(values));
  PetscCall(ContactComplianceDestroy(&c));
  PetscCall(RunDestroy(&run));
  PetscFunctionReturn(0);
}

/* Forces of a step in which all pairs open, which makes factors of no row, and of one in which two of them close */
static PetscErrorCode CloseTwo(ContactCompliance c, PetscReal lambda[STEP_ROWS], ComplianceReport *report)
{
  PetscReal q[STEP_ROWS], slip0[2 * STEP_PAIRS] = {0};

  PetscFunctionBeginUser;
  for (int i = 0; i < STEP_ROWS; i++) {
    q[i]      = i % 3 ? 1e-7 * (i % 5) : 1e-3;
    lambda[i] = i % 3 ? 0 : 1;
  }
  PetscCall(ContactComplianceSolve(c, q, slip0, lambda, NULL, NULL));
  q[0] = -1e-6;
  q[9] = -2e-6;
  PetscCall(ContactComplianceSolve(c, q, slip0, lambda, NULL, report));
  PetscFunctionReturn(0);
}

/* Breaks when: something that earlier steps left is used after the memory was cleared, as room for factors once was */
static PetscErrorCode TestCleared(int *failed)
{
  SteppedRun       run, fresh;
  ComplianceReport report[2];
  PetscInt         unsolved = 0;
  PetscReal        lambda[2][STEP_ROWS], apart = 0;

  PetscFunctionBeginUser;
  PetscCall(RunCreate(0.5, 8e-6, 1, 0.003, &run));
  PetscCall(RunCreate(0.5, 8e-6, 1, 0.003, &fresh));
  for (int k = 0; k < 77; k++) PetscCall(RunStep(&run, &unsolved));
  PetscCall(ContactComplianceSetMemory(run.c, 0, NULL));
  PetscCall(CloseTwo(run.c, lambda[0], &report[0]));
  PetscCall(CloseTwo(fresh.c, lambda[1], &report[1]));
  for (int i = 0; i < STEP_ROWS; i++) apart = fmax(apart, fabs(lambda[0][i] - lambda[1][i]));
  *failed += CheckTrue("cleared: two pairs close", lambda[0][0] > 0 && lambda[0][9] > 0, lambda[0][0]);
  *failed += CheckClose("cleared: bitwise a new one", apart, 0, 0);
  *failed += CheckClose("cleared: as many factors", (double)report[0].factors, (double)report[1].factors, 0);
  *failed += CheckClose("cleared: as many iterations", (double)report[0].iterations, (double)report[1].iterations, 0);
  PetscCall(RunDestroy(&fresh));
  PetscCall(RunDestroy(&run));
  PetscFunctionReturn(0);
}

static PetscErrorCode Tests(PetscMPIInt size, int *failed)
{
  PetscFunctionBeginUser;
  (void)size;
  PetscCall(TestRuns(failed));
  PetscCall(TestMemory(failed));
  PetscCall(TestCleared(failed));
  PetscFunctionReturn(0);
}

int main(int argc, char **argv)
{
  return PetscMain(argc, argv, Tests);
}
