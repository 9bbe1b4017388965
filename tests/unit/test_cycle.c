/* Unit test of reduced/cycle and of shooting: the limit cycle of an oscillator with friction that lifts off */
#include "check.h"
#include "oscillator.h"
#include "petscmain.h"
#include <slepcsys.h>

/* What a cycle is known by */
typedef struct {
  PetscReal mu, period, peak, multiplier /* modulus of the largest but for the phase's */;
  PetscReal phase, check, slope; /* multiplier of the phase less 1, check of the derivative less 1, dT/dtheta */
} Known;

static PetscErrorCode OscillatorSolve(Oscillator *o, PetscInt n, Known *found, int *failed)
{
  ShootingStability stability;
  CycleMeasure      measure;

  PetscFunctionBeginUser;
  o->flow.n_steps = n;
  PetscCall(ShootingSolve(&o->shooting, &o->cycle));
  PetscCall(ShootingGetStability(&o->shooting, &o->cycle, &stability));
  PetscCall(CycleFlowMeasure(&o->flow, &o->cycle, &measure, NULL));
  *found = (Known){
    .mu         = o->cycle.value,
    .period     = o->cycle.period,
    .peak       = measure.peak,
    .multiplier = hypot(stability.largest[0], stability.largest[1]),
    .phase      = stability.phase[0] - 1,
    .check      = stability.check - 1,
    .slope      = stability.slope,
  };
  *failed += CheckTrue("converged in few steps of Newton's method", o->cycle.converged && o->cycle.its <= 5,
                       (double)o->cycle.its);
  PetscFunctionReturn(0);
}

/* Breaks when: the step or its derivative is wrong, or shooting converges to something else. The error of the step is of
   second order, those of dT/dtheta and of the phase's multiplier of first, since events break the symmetry in time */
static PetscErrorCode TestKnown(const Known *known, int *failed)
{
  Oscillator o;
  Known      coarse, found;

  PetscFunctionBeginUser;
  PetscCall(OscillatorCreate(known->mu, &o));
  PetscCall(OscillatorSettle(&o, 1.003 * known->period));
  PetscCall(OscillatorSolve(&o, 256, &found, failed));
  *failed += CheckClose("256 steps: period", found.period, known->period, 1e-5 * known->period);
  PetscCall(OscillatorSolve(&o, 4096, &coarse, failed));
  PetscCall(OscillatorSolve(&o, 16384, &found, failed));
  *failed += CheckClose("16384 steps: period", found.period, known->period, 1e-8 * known->period);
  *failed +=
    CheckClose("largest force, extrapolated", (16 * found.peak - coarse.peak) / 15, known->peak, 1e-8 * known->peak);
  *failed += CheckClose("multiplier", found.multiplier, known->multiplier, 1e-7);
  *failed += CheckClose("multiplier of the phase less 1", found.phase, 0, 5e-4);
  *failed += CheckClose("dT/dtheta", found.slope, 0, 5e-4);
  *failed += CheckClose("check of the derivative less 1", found.check, 0, 1e-6);
  *failed += CheckClose("4096 steps: that", coarse.check, 0, 1e-6);
  PetscCall(OscillatorDestroy(&o));
  PetscFunctionReturn(0);
}

/* Breaks when: the branch turns the wrong way, or the tangent is not that of the branch: from mu 0.8 by arclength beyond
   1, and back to it at that value */
static PetscErrorCode TestBranch(const Known known[2], int *failed)
{
  Oscillator        o;
  Known             found;
  ShootingTangent   tangent = {.period = 0, .value = 0};
  ShootingDirection straight;
  int               n = 0;

  PetscFunctionBeginUser;
  PetscCall(OscillatorCreate(known[0].mu, &o));
  PetscCall(PetscCalloc1(o.flow.n, &tangent.x));
  PetscCall(OscillatorSettle(&o, 1.003 * known[0].period));
  PetscCall(OscillatorSolve(&o, 512, &found, failed));
  for (; n < 60 && o.cycle.value < known[1].mu; n++) {
    PetscCall(ShootingGetTangent(&o.shooting, &o.cycle, &tangent, &straight));
    PetscCall(ShootingAdvance(&o.shooting, 0.1, &tangent, &o.cycle));
    if (!o.cycle.converged) break;
  }
  *failed += CheckTrue("the branch passes mu 1", o.cycle.value > known[1].mu, (double)o.cycle.value);
  o.cycle.value = known[1].mu;
  PetscCall(OscillatorSolve(&o, 4096, &found, failed));
  *failed += CheckClose("mu 1 from the branch: period", found.period, known[1].period, 1e-7 * known[1].period);
  PetscCall(PetscFree(tangent.x));
  PetscCall(OscillatorDestroy(&o));
  PetscFunctionReturn(0);
}

/* Breaks when: the branch does not turn where the pair stays closed all the time: there the motion is linear, and all
   amplitudes have the friction of the onset. Reference: mu, at which an eigenvalue of the closed oscillator is imaginary, and its period */
static PetscErrorCode TestOnset(const Known *known, int *failed)
{
  Oscillator        o;
  Known             found;
  CycleMeasure      measure;
  ShootingTangent   tangent = {.period = 0, .value = -1};
  ShootingDirection straight;

  PetscFunctionBeginUser;
  PetscCall(OscillatorCreate(known->mu, &o));
  PetscCall(PetscCalloc1(o.flow.n, &tangent.x));
  PetscCall(OscillatorSettle(&o, 1.003 * known->period));
  PetscCall(OscillatorSolve(&o, 513, &found, failed));
  for (int n = 0; n < 4; n++) {
    PetscCall(ShootingGetTangent(&o.shooting, &o.cycle, &tangent, &straight));
    PetscCall(ShootingAdvance(&o.shooting, 0.1, &tangent, &o.cycle));
    *failed += CheckTrue("towards the onset", o.cycle.converged, (double)o.cycle.value);
  }
  PetscCall(CycleFlowMeasure(&o.flow, &o.cycle, &measure, NULL));
  *failed += CheckTrue("the pair stays closed", measure.least > 0.1, (double)measure.least);
  *failed += CheckClose("mu of the onset", o.cycle.value, 0.773194444444, 1e-4);
  *failed += CheckClose("its period", o.cycle.period, 4.33580978345, 1e-4);
  PetscCall(PetscFree(tangent.x));
  PetscCall(OscillatorDestroy(&o));
  PetscFunctionReturn(0);
}

/* Its cycle in numbers, with errors */
static PetscErrorCode OscillatorRefine(Oscillator *o, CyclePoint *p)
{
  struct _p_ReducedRun silent = {.comm = PETSC_COMM_SELF};
  struct _p_LimitCycle c      = {.reduced = &silent, .flow = o->flow, .shooting = o->shooting};

  PetscFunctionBeginUser;
  c.shooting.ctx = &c.flow;
  if (o->cycle.converged) PetscCall(CycleFlowMeasure(&c.flow, &o->cycle, &p->found, NULL));
  if (o->cycle.converged) PetscCall(ShootingGetStability(&c.shooting, &o->cycle, &p->stability));
  PetscCall(CycleRefine(&c, &o->cycle, NULL, p));
  o->flow = c.flow;
  PetscFunctionReturn(0);
}

/* Frequency, rms, largest force and multiplier of the cycle next to `from`, of n steps that begin a time `later` */
static PetscErrorCode OscillatorFind(Oscillator *o, const PetscReal from[], PetscInt n, PetscReal later,
                                     PetscReal found[4], int *failed)
{
  CycleMeasure m;
  Known        known;

  PetscFunctionBeginUser;
  o->flow.n_steps = 3;
  PetscCall(PetscArraycpy(o->cycle.x, from, o->flow.n));
  if (later > 0) PetscCall(CycleFlowRun(&o->flow, from, later, o->cycle.value, o->cycle.x, NULL));
  PetscCall(OscillatorSolve(o, n, &known, failed));
  PetscCall(CycleFlowMeasure(&o->flow, &o->cycle, &m, NULL));
  PetscCall(PetscArraycpy(found, ((PetscReal[]){m.freq, m.rms, m.peak, known.multiplier}), 4));
  PetscFunctionReturn(0);
}

/* Breaks when: dT/dtheta is not that of the cycles whose steps lie elsewhere, found by themselves (forward differences of second order),
   the derivative of a step is wrong, or the multiplier of the phase is not the eigenvalue of M, 1 - dT/dtheta nearly. The unit of theta, by
   dPhi/dT, is off by the second order in the step */
static PetscErrorCode TestPhase(const Known *known, int *failed)
{
  const PetscInt n = 129;
  Oscillator     o;
  Known          found;
  PetscReal      x[7], v[2][4], later, T[3], slope;

  PetscFunctionBeginUser;
  PetscCall(OscillatorCreate(known->mu, &o));
  PetscCall(OscillatorSettle(&o, 1.003 * known->period));
  PetscCall(OscillatorSolve(&o, n, &found, failed));
  PetscCall(PetscArraycpy(x, o.cycle.x, 7));
  later = 0.002 * found.period / n;
  T[0]  = found.period;
  for (int k = 0; k < 2; k++) {
    PetscCall(OscillatorFind(&o, x, n, (k + 1) * later, v[k], failed));
    T[k + 1] = o.cycle.period;
  }
  slope = (4 * T[1] - 3 * T[0] - T[2]) / (2 * later);
  *failed += CheckTrue("the place of the steps matters", fabs(slope) > 1e-3, slope);
  *failed += CheckClose("dT/dtheta by cycles whose steps lie elsewhere", found.slope, slope, 5e-3 * fabs(slope));
  *failed += CheckClose("129 steps: check of the derivative less 1", found.check, 0, 1e-6);
  *failed += CheckClose("multiplier of the phase less 1", found.phase, -slope, 0.02 * fabs(slope));
  PetscCall(OscillatorDestroy(&o));
  PetscFunctionReturn(0);
}

/* Breaks when: a stated error is not by the cycles that it is said to come from: one place of steps left out, both added, other factors */
static PetscErrorCode TestErrors(const Known *known, int *failed)
{
  static const char *const name[] = {"error of the frequency", "of the rms", "of the peak", "of the multiplier"};
  const PetscInt           n      = 33;
  Oscillator               o;
  Known                    unused;
  CyclePoint               p = {.n_steps = n};
  PetscReal                x[7], v[4][4], stated[4];
  const char              *why;

  PetscFunctionBeginUser;
  PetscCall(OscillatorCreate(known->mu, &o));
  PetscCall(OscillatorSettle(&o, 1.003 * known->period));
  PetscCall(OscillatorSolve(&o, n, &unused, failed));
  PetscCall(OscillatorRefine(&o, &p));
  PetscCall(PetscArraycpy(x, o.cycle.x, 7));
  for (int k = 0; k < 3; k++) PetscCall(OscillatorFind(&o, x, n, k * unused.period / (3 * n), v[k], failed));
  PetscCall(OscillatorFind(&o, x, 2 * n + 1, 0, v[3], failed));
  stated[0] = CycleError(p.found.freq, p.finer.freq, p.spread.freq);
  stated[1] = CycleError(p.found.rms, p.finer.rms, p.spread.rms);
  stated[2] = CycleError(p.found.peak, p.finer.peak, p.spread.peak);
  stated[3] = CycleMultiplierError(&p);
  for (int i = 0; i < 4; i++) {
    const PetscReal finer = fabs(v[3][i] - v[0][i]), other = fmax(fabs(v[1][i] - v[0][i]), fabs(v[2][i] - v[0][i]));
    const PetscReal error = i < 3 ? 4. / 3 * finer + other : fmax(2 * finer, other);
    *failed += CheckClose(name[i], stated[i], error, 2e-3 * error);
  }
  *failed += CheckTrue("its class", !strcmp(CycleClass(&p, 1e-9, &why), "stable"), (double)v[0][3]);
  p.wants_higher = PETSC_TRUE;
  *failed += CheckTrue("none with a part unknown", strstr(CycleClass(&p, 1e-9, &why), "unverified") && strstr(why, "cut"), 0);
  PetscCall(OscillatorDestroy(&o));
  PetscFunctionReturn(0);
}

/* Breaks when: what a failed flow leaves is taken for a cycle that ends where it began. Laws have no solution far beyond all forces */
static PetscErrorCode TestFailed(const Known *known, int *failed)
{
  Oscillator o;
  CyclePoint p = {.n_steps = 33};
  PetscReal  y[7];

  PetscFunctionBeginUser;
  PetscCall(OscillatorCreate(known->mu, &o));
  o.flow.n_steps = 33;
  o.cycle.period = known->period;
  for (int i = 0; i < 4; i++) o.cycle.x[i] = 1e307;
  PetscCall(CycleFlowRun(&o.flow, o.cycle.x, known->period, known->mu, y, NULL));
  *failed += CheckTrue("a flow that fails ends at no number", PetscIsInfOrNanReal(y[0]), (double)y[0]);
  PetscCall(PetscArraycpy(o.cycle.x, y, o.flow.n));
  PetscCall(ShootingSolve(&o.shooting, &o.cycle));
  *failed += CheckTrue("no cycle from there", !o.cycle.converged, (double)o.cycle.residual);
  PetscCall(OscillatorRefine(&o, &p));
  *failed += CheckTrue("no error by it", !p.has_finer, (double)p.spread.freq);
  PetscCall(OscillatorDestroy(&o));
  PetscFunctionReturn(0);
}

/* Breaks when: the flow depends on what was run before, about another x: where friction falls so steeply with the slip speed that a step
   has two solutions, a pair that sticks must be held by x alone, and one that slides must not be */
static PetscErrorCode TestNoMemory(const Known *known, int *failed)
{
  const PetscReal x[2][7] = {
    {-0.5, -0.9, 0.12,   -0.16,   1, -0.5,   0}, /* velocity -0.2 along t, of sliding at 0.2 m/s: at rest, friction within 0.8 */
    {-0.5, -0.9, 0.0912, -0.1216, 1, -0.304, 0}, /* slides by 0.048 m/s */
  };
  Oscillator    o;
  PetscReal     y[4][7];
  ContactStatus first[2];

  PetscFunctionBeginUser;
  PetscCall(OscillatorCreate(known->mu, &o));
  o.law            = (FrictionLaw){.kind = 1, .speed = 0.2, .parameter = {0.8, 0.3, 0.01}}; /* static, kinetic, m/s of its fall */
  o.flow.stated[0] = o.law;
  o.flow.n_steps   = 1;
  *failed += CheckClose("mu at rest", FrictionMu(&o.law, 0), 0.8, 1e-12);
  *failed += CheckTrue("it falls", FrictionMu(&o.law, 0.1) < 0.31, FrictionMu(&o.law, 0.1));
  for (int k = 0; k < 4; k++) {
    PetscCall(CycleFlowRun(&o.flow, x[k % 2], 0.01, known->mu, y[k], NULL));
    if (k < 2) first[k] = o.flow.state.status[0];
  }
  *failed += CheckTrue("the pair that rests goes on", first[0] == CONTACT_STICK, first[0]);
  *failed += CheckTrue("the one that slides goes on", first[1] == CONTACT_SLIP, first[1]);
  for (int k = 0; k < 2; k++)
    for (int i = 0; i < 7; i++) *failed += CheckClose("the same after another x", y[k + 2][i], y[k][i], 0);
  PetscCall(OscillatorDestroy(&o));
  PetscFunctionReturn(0);
}

/* A rotation by T about (p, 0), which fails beyond period 2 pi: a cycle of any x with that period, at the edge of what there is */
static PetscErrorCode EdgeFlow(void *ctx, const PetscReal x[], PetscReal T, PetscReal p, PetscReal y[], PetscReal M[])
{
  const PetscReal c = cos(T), s = sin(T);

  PetscFunctionBeginUser;
  y[0] = T > 2 * PETSC_PI ? *(PetscReal *)ctx : p + c * (x[0] - p) + s * x[1];
  y[1] = c * x[1] - s * (x[0] - p);
  for (int i = 0; i < 4 && M; i++) M[i] = (PetscReal[]){c, -s, s, c}[i];
  PetscFunctionReturn(0);
}

/* Breaks when: a cycle next to which the flow fails is told to be one at which the branch splits */
static PetscErrorCode TestEdge(int *failed)
{
  PetscReal         infinite = INFINITY, x[2] = {1, 0}, M[4] = {1, 0, 0, 1}, t[2] = {0, 0}, one[2] = {1, 1};
  ShootingTangent   tangent = {.x = t};
  ShootingDirection direction;
  Shooting          shooting = {.n = 2, .flow = EdgeFlow, .ctx = &infinite, .size = one, .weight = one, .least = -1};
  ShootingCycle     cycle    = {.x = x, .M = M, .period = 2 * PETSC_PI};

  PetscFunctionBeginUser;
  shooting.span = 1;
  PetscCall(ShootingGetTangent(&shooting, &cycle, &tangent, &direction));
  *failed += CheckTrue("no derivative where the flow fails", direction == SHOOTING_NO_DERIVATIVE, (double)direction);
  cycle.period = 1.9 * PETSC_PI; /* M - I alone is regular there: the branch goes on, with p */
  PetscCall(EdgeFlow(&infinite, x, cycle.period, 0, t, M));
  t[0] = t[1] = 0;
  PetscCall(ShootingGetTangent(&shooting, &cycle, &tangent, &direction));
  *failed += CheckTrue("a direction next to it", direction == SHOOTING_ALONG, (double)direction);
  PetscFunctionReturn(0);
}

static PetscErrorCode Tests(PetscMPIInt size, int *failed)
{
  const Known known[2] = {
    {.mu = 0.8, .period = 4.3887041961153, .peak = 0.95737523205229, .multiplier = 0.9159677852  },
    {.mu = 1.0, .period = 4.5481402173278, .peak = 1.5984947760782,  .multiplier = 0.913051671821}
  };

  PetscFunctionBeginUser;
  (void)size;
  PetscCall(SlepcInitialize(NULL, NULL, NULL, NULL)); /* of matrix functions */
  PetscCall(TestEdge(failed));
  for (int i = 0; i < 2; i++) PetscCall(TestKnown(&known[i], failed));
  PetscCall(TestBranch(known, failed));
  PetscCall(TestOnset(known, failed));
  PetscCall(TestPhase(known, failed));
  PetscCall(TestErrors(known, failed));
  PetscCall(TestFailed(known, failed));
  PetscCall(TestNoMemory(known, failed));
  PetscCall(SlepcFinalize());
  PetscFunctionReturn(0);
}

int main(int argc, char **argv)
{
  return PetscMain(argc, argv, Tests);
}
