/*
   TS of type "central" on oscillators. Breaks when a factor of the recursion, the first half step, the constraint's
   place in the step, or what TS's own options do is wrong. References: the recursion's characteristic polynomial, exact
   solutions.
*/
#include "check.h"
#include "petscmain.h"
#include "dynamics/central/tscentral.h"

/* Masses 1, stiffness omega^2, viscosity c (1/s), a wall that x >= 0 must not pass where asked for */
typedef struct {
  PetscReal omega2, c;
  PetscBool wall;
} Oscillator;

static PetscErrorCode Force(TS ts, const CentralStep *step, void *ctx)
{
  const Oscillator *o = ctx;

  PetscFunctionBeginUser;
  (void)ts;
  PetscCall(VecAXPBYPCZ(step->f, -o->omega2, -o->c, 0, step->u, step->v));
  PetscFunctionReturn(0);
}

/* The least force >= 0 with which u_{n+1} >= 0 */
static PetscErrorCode Wall(TS ts, const CentralStep *step, void *ctx)
{
  PetscScalar *x, *w, *g, predicted;

  PetscFunctionBeginUser;
  (void)ts, (void)ctx;
  PetscCall(VecGetArray(step->u, &x));
  PetscCall(VecGetArray(step->v, &w));
  PetscCall(VecGetArray(step->f, &g));
  predicted = x[0] + step->dt * (w[0] + step->kick * g[0]);
  if (predicted < 0) g[0] -= predicted / (step->dt * step->kick);
  PetscCall(VecRestoreArray(step->f, &g));
  PetscCall(VecRestoreArray(step->v, &w));
  PetscCall(VecRestoreArray(step->u, &x));
  PetscFunctionReturn(0);
}

/* Integrates from u, v; returns the last u and v, the time reached and the number of steps */
static PetscErrorCode Integrate(const char options[], Oscillator *o, PetscReal dt, PetscReal end, PetscReal u0,
                                PetscReal v0, PetscReal *u_end, PetscReal *v_end, PetscReal *time, PetscInt *steps)
{
  Vec u, v, minv;
  TS  ts;

  PetscFunctionBeginUser;
  PetscCall(PetscOptionsInsertString(NULL, options));
  PetscCall(VecCreateSeq(PETSC_COMM_SELF, 1, &u));
  PetscCall(VecDuplicate(u, &v));
  PetscCall(VecDuplicate(u, &minv));
  PetscCall(VecSet(u, u0));
  PetscCall(VecSet(v, v0));
  PetscCall(VecSet(minv, 1));
  PetscCall(TSCreate(PETSC_COMM_SELF, &ts));
  PetscCall(TSSetType(ts, TSCENTRAL));
  PetscCall(TSSetExactFinalTime(ts, TS_EXACTFINALTIME_STEPOVER));
  PetscCall(TSSetTimeStep(ts, dt));
  PetscCall(TSSetMaxTime(ts, end));
  PetscCall(TSSetFromOptions(ts));
  PetscCall(TS2SetSolution(ts, u, v));
  PetscCall(TSCentralSetForces(ts, minv, Force, o->wall ? Wall : NULL, o));
  PetscCall(TSSolve(ts, NULL));
  PetscCall(TSGetTime(ts, time));
  PetscCall(TSGetStepNumber(ts, steps));
  PetscCall(VecGetValues(u, 1, (PetscInt[]){0}, u_end));
  PetscCall(VecGetValues(v, 1, (PetscInt[]){0}, v_end));
  PetscCall(TSDestroy(&ts));
  PetscCall(VecDestroy(&minv));
  PetscCall(VecDestroy(&v));
  PetscCall(VecDestroy(&u));
  PetscCall(PetscOptionsClear(NULL));
  PetscFunctionReturn(0);
}

/* Error of u(1) = cos(omega) for omega = 3: it falls by 4 with half the step (order 2) */
static PetscErrorCode TestOrder(int *failed)
{
  Oscillator o = {.omega2 = 9};
  PetscReal  u, v, time, error[3];
  PetscInt   steps;

  PetscFunctionBeginUser;
  for (int i = 0; i < 3; i++) {
    PetscCall(Integrate("", &o, 0.01 / (1 << i), 1 - 1e-9, 1, 0, &u, &v, &time, &steps));
    error[i] = u - PetscCosReal(3 * time);
  }
  *failed += CheckClose("error falls by 4 with half the step", error[0] / error[1], 4, 0.01);
  *failed += CheckClose("and once more", error[1] / error[2], 4, 0.0025);
  PetscFunctionReturn(0);
}

/* z -> roots of z (z - 1)^2 ... = 0: with W = dt^2 omega^2 two steps obey u_{n+1} - 2 u_n + u_{n-1} = -W ((1/2 + b) u_n
   + (1/2 - b) u_{n-1}), so that the product of the roots is 1 + W (1/2 - b): amplitude decays by its square root in
   every step */
static PetscErrorCode TestDissipation(int *failed)
{
  const PetscReal b = 0.8, W = 0.09, product = 1 + W * (0.5 - b), half = 1 - 0.5 * W * (0.5 + b);
  const PetscReal angle = PetscAcosReal(half / PetscSqrtReal(product));
  Oscillator      o     = {.omega2 = W};
  PetscReal       u, v, time, u1;
  PetscInt        steps;

  PetscFunctionBeginUser;
  PetscCall(Integrate("-ts_central_b 0.8", &o, 1, 39.5, 1, 0, &u, &v, &time, &steps));
  *failed += CheckTrue("steps of 1 to 39.5", steps == 40, (double)steps);
  u1 = 1 - 0.5 * W; /* first step: v_{1/2} = a_0 / 2 */
  {
    const PetscReal r = PetscSqrtReal(product), s = (u1 / r - PetscCosReal(angle)) / PetscSinReal(angle);

    *failed += CheckClose("b = 0.8 decays as its recursion", u,
                          PetscPowReal(r, 40) * (PetscCosReal(40 * angle) + s * PetscSinReal(40 * angle)), 1e-12);
  }
  PetscFunctionReturn(0);
}

/* The largest u of 2000 steps stays below 10 just below the critical step and passes 1000 just above it */
static PetscErrorCode TestCritical(int *failed)
{
  const struct {
    const char *options;
    PetscReal   b, c;
  } kind[] = {
    {"",                   0.5,  0  },
    {"",                   0.5,  0.4},
    {"-ts_central_b 0.75", 0.75, 0.2}
  };

  PetscFunctionBeginUser;
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(kind); i++) {
    Oscillator      o = {.omega2 = 1, .c = kind[i].c};
    const PetscReal limit =
      (2 / kind[i].b) / (kind[i].c + PetscSqrtReal(PetscSqr(kind[i].c) + 2 / kind[i].b)); /* dt^2 + 2 c dt = 2 / b */
    PetscReal u, v, time;
    PetscInt  steps;

    PetscCall(Integrate(kind[i].options, &o, 0.999 * limit, 2000 * limit, 1, 0, &u, &v, &time, &steps));
    *failed += CheckTrue("bounded below the critical step", PetscAbsReal(u) < 10, u);
    PetscCall(Integrate(kind[i].options, &o, 1.01 * limit, 2000 * limit, 1, 0, &u, &v, &time, &steps));
    *failed += CheckTrue("unbounded above the critical step", PetscAbsReal(u) > 1000, u);
  }
  PetscFunctionReturn(0);
}

/* A free mass at speed -1 from 1: stops at the wall at the end of the step that would pass it, exactly, and stays */
static PetscErrorCode TestWall(int *failed)
{
  Oscillator o = {.wall = PETSC_TRUE};
  PetscReal  u, v, time;
  PetscInt   steps;

  PetscFunctionBeginUser;
  PetscCall(Integrate("", &o, 0.3, 10, 1, -1, &u, &v, &time, &steps));
  *failed += CheckClose("mass at the wall", u, 0, 1e-14);
  *failed += CheckClose("and at rest", v, 0, 1e-15);
  PetscFunctionReturn(0);
}

/* TS's own options: number of steps, a last step that ends at the end, the step itself */
static PetscErrorCode TestOptions(int *failed)
{
  Oscillator o = {.omega2 = 1};
  PetscReal  u, v, time;
  PetscInt   steps;

  PetscFunctionBeginUser;
  PetscCall(Integrate("-ts_max_steps 7", &o, 0.1, 10, 1, 0, &u, &v, &time, &steps));
  *failed += CheckTrue("-ts_max_steps 7", steps == 7, (double)steps);
  PetscCall(Integrate("-ts_dt 0.05", &o, 0.1, 0.999, 1, 0, &u, &v, &time, &steps));
  *failed += CheckTrue("-ts_dt 0.05", steps == 20, (double)steps);
  PetscCall(Integrate("-ts_exact_final_time matchstep", &o, 0.3, 1, 1, 0, &u, &v, &time, &steps));
  *failed += CheckClose("-ts_exact_final_time matchstep", time, 1, 1e-14);
  PetscCall(Integrate("-ts_exact_final_time matchstep", &o, 0.0015, 1, 1, 0, &u, &v, &time, &steps));
  *failed += CheckClose("a shorter last step keeps the order", u, PetscCosReal(1), 2e-7);
  PetscFunctionReturn(0);
}

static PetscErrorCode Tests(PetscMPIInt size, int *failed)
{
  PetscFunctionBeginUser;
  (void)size;
  PetscCall(TSCentralRegister());
  PetscCall(TestOrder(failed));
  PetscCall(TestDissipation(failed));
  PetscCall(TestCritical(failed));
  PetscCall(TestWall(failed));
  PetscCall(TestOptions(failed));
  PetscFunctionReturn(0);
}

int main(int argc, char **argv)
{
  return PetscMain(argc, argv, Tests);
}
