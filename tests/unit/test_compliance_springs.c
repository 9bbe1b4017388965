/*
   Unit test of laws in series with the pairs (contact/compliance/spring.c): on random problems all laws are judged from
   forces and displacements by formulas written down here, not by those of the solver; derivatives beside differences;
   linear laws beside a compliance that has them on its diagonal. Breaks when: a line is off its law where the iteration
   ends, a steep law runs away, a law that has no slope at its onset does not close, or steps depend on those before.
*/
#include "check.h"
#include "compliancescene.h"
#include "contact/compliance/compliance.h"
#include "petscmain.h"

#define PAIRS  25
#define ROWS   (3 * PAIRS)
#define SCENES 40 /* of each law */

typedef enum { LINEAR, EXPONENTIAL, POWER, TABLE, MIXED, KINDS } Kind; /* the first as in contact/pressure/pressure.c */

static const char *const kinds[]  = {"linear", "exponential", "power", "table", "mixed"};
static PetscReal         points[] = {-0.1, 0, 0.1, 0.3, 0.3, 2};

/* Forces are of order 1 on areas of order 1 */
static PairSpring SpringOf(Kind kind, PetscReal scale, PetscReal area)
{
  PairSpring spring = {{.kind = kind}, area};

  if (kind == LINEAR) spring.law.parameter[0] = 5 * scale;
  if (kind == EXPONENTIAL) spring.law.parameter[0] = 0.2, spring.law.parameter[1] = 0.3 * scale;
  if (kind == POWER) spring.law.parameter[0] = 30 * scale, spring.law.parameter[1] = 2.5;
  if (kind == TABLE) spring.law.n_points = 3, spring.law.point = points;
  return spring;
}

/* The pressure at a closing, and the closing at which it begins */
static PetscReal Pressed(const PairSpring *s, PetscReal c, PetscReal *onset)
{
  const PetscReal *a = s->law.parameter;

  if (s->law.kind == LINEAR) return *onset = 0, c > 0 ? a[0] * c : 0;
  if (s->law.kind == POWER) return *onset = 0, c > 0 ? a[0] * pow(c, a[1]) : 0;
  if (s->law.kind == EXPONENTIAL) {
    const PetscReal x = c / a[0] + 1;

    return *onset = -a[0], x > 0 ? a[1] / (exp(1) - 1) * x * (exp(x) - 1) : 0;
  }
  *onset = points[0];
  if (c <= points[0]) return 0;
  return c < points[2] ? 1.5 * (c - points[0]) : 0.3 + 8.5 * (c - points[2]);
}

static PairSpring SpringDraw(Kind kind, PetscInt p, ComplianceScene *s)
{
  const PetscReal area = 1 + 0.5 * SceneDraw(s);

  return SpringOf(kind == MIXED ? (Kind)(p % MIXED) : kind, exp(2 * SceneDraw(s)), area);
}

/* What is off the laws, of the largest force; r and lambda as found */
static PetscReal Judge(const ComplianceScene *s, const PairSpring spring[], const PetscReal lambda[],
                       const PetscReal r[])
{
  PetscReal off = 0, largest = 0.01, onset;

  for (PetscInt i = 0; i < ROWS; i++) largest = fmax(largest, fabs(lambda[i]));
  for (PetscInt i = 0; i < ROWS; i++) {
    PetscReal u = s->q[i];

    for (PetscInt j = 0; j < ROWS; j++) u += s->W[j * ROWS + i] * lambda[j];
    off = fmax(off, fabs(u - r[i]));
  }
  for (PetscInt p = 0; p < PAIRS; p++) {
    const PetscReal *l = &lambda[3 * p], *u = &r[3 * p];
    const PetscReal  t = hypot(l[1], l[2]), slip = hypot(u[1], u[2]), cone = s->mu[p] * l[0];

    off = fmax(off, fabs(l[0] - spring[p].area * Pressed(&spring[p], -u[0], &onset)));
    off = fmax(off, t - cone);
    if (t < cone * (1 - 1e-6)) off = fmax(off, slip);
    if (slip > 1e-6) off = fmax(off, hypot(l[1] + cone * u[1] / slip, l[2] + cone * u[2] / slip));
  }
  return off / largest;
}

static PetscErrorCode SceneDrawAll(Kind kind, int seed, ComplianceScene *s, PairSpring spring[PAIRS])
{
  PetscFunctionBeginUser;
  PetscCall(SceneCreate(PAIRS, (uint64_t)seed + 1, s));
  SceneAddBody(s, BODY_HALF_SPACE);
  for (PetscInt i = 0; i < ROWS; i++) s->q[i] = SceneDraw(s) - (i % 3 ? 0 : 0.7);
  for (PetscInt p = 0; p < PAIRS; p++) {
    s->mu[p]  = 0.3;
    spring[p] = SpringDraw(kind, p, s);
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode LawsCreate(const ComplianceScene *s, const PairSpring spring[], ContactCompliance *c)
{
  PetscFunctionBeginUser;
  PetscCall(ContactComplianceCreate(PAIRS, s->W, c));
  PetscCall(SceneSetFriction(*c, PAIRS, s->mu, NULL, NULL, 0));
  PetscCall(ContactComplianceSetSprings(*c, spring));
  PetscFunctionReturn(0);
}

/* Steps from one motion to another, from lifted to pressed ten times as much: all laws hold at each; the next after
   its memory was taken and given to another is the same to the last bit */
static PetscErrorCode TestLaws(Kind kind, int *failed)
{
  PetscReal worst = 0, apart = 0;
  PetscInt  unsolved = 0, iterations = 0;
  char      name[80];

  PetscFunctionBeginUser;
  for (int seed = 0; seed < SCENES; seed++) {
    ComplianceScene   s;
    PairSpring        spring[PAIRS];
    ContactCompliance c, again;
    ComplianceReport  report;
    PetscReal         lambda[ROWS] = {0}, other[ROWS], r[ROWS], *memory;
    PetscInt          n;

    PetscCall(SceneDrawAll(kind, seed, &s, spring));
    PetscCall(LawsCreate(&s, spring, &c));
    PetscCall(LawsCreate(&s, spring, &again));
    for (int k = 0; k < 6; k++) {
      for (PetscInt i = 0; i < ROWS; i++)
        s.q[i] = k % 3 == 2 ? 10 * s.q[i] : (i % 3 ? 0 : k % 3 ? 0.5 : -0.7) + SceneDraw(&s) * (k % 2 ? 1 : 0.01);
      PetscCall(ContactComplianceGetMemory(c, &n, &memory));
      PetscCall(ContactComplianceSetMemory(again, n, memory));
      PetscCall(PetscFree(memory));
      PetscCall(PetscArraycpy(other, lambda, ROWS));
      PetscCall(ContactComplianceSolve(again, s.q, s.slip0, other, NULL, NULL));
      PetscCall(ContactComplianceSolve(c, s.q, s.slip0, lambda, r, &report));
      for (PetscInt i = 0; i < ROWS; i++) apart = fmax(apart, fabs(other[i] - lambda[i]));
      unsolved += !report.converged;
      iterations += report.iterations;
      worst = fmax(worst, Judge(&s, spring, lambda, r));
    }
    PetscCall(ContactComplianceDestroy(&again));
    PetscCall(ContactComplianceDestroy(&c));
    PetscCall(SceneDestroy(&s));
  }
  PetscCall(PetscSNPrintf(name, sizeof(name), "%s: steps that did not converge", kinds[kind]));
  *failed += CheckClose(name, (double)unsolved, 0, 0);
  PetscCall(PetscSNPrintf(name, sizeof(name), "%s: off the laws, of the largest force", kinds[kind]));
  *failed += CheckClose(name, worst, 0, 1e-9);
  PetscCall(PetscSNPrintf(name, sizeof(name), "%s: after a restart", kinds[kind]));
  *failed += CheckClose(name, apart, 0, 0);
  printf("     %s: %.1f iterations a step\n", kinds[kind], (double)iterations / (6 * SCENES));
  PetscFunctionReturn(0);
}

/* d lambda / dq along a direction by central differences */
static PetscErrorCode TestTangent(Kind kind, int *failed)
{
  PetscReal worst = 0;
  char      name[80];

  PetscFunctionBeginUser;
  for (int seed = 0; seed < SCENES; seed++) {
    ComplianceScene   s;
    PairSpring        spring[PAIRS];
    ContactCompliance c;
    PetscReal         lambda[3][ROWS] = {{0}}, dq[ROWS], q[ROWS], dlambda[ROWS], off = 0, size = 0;

    PetscCall(SceneDrawAll(kind, seed, &s, spring));
    PetscCall(LawsCreate(&s, spring, &c));
    for (PetscInt i = 0; i < ROWS; i++) dq[i] = SceneDraw(&s);
    PetscCall(ContactComplianceSolve(c, s.q, s.slip0, lambda[0], NULL, NULL));
    PetscCall(ContactComplianceTangent(c, 1, dq, dlambda));
    for (int k = 1; k < 3; k++) {
      PetscCall(PetscArraycpy(lambda[k], lambda[0], ROWS));
      for (PetscInt i = 0; i < ROWS; i++) q[i] = s.q[i] + (k == 1 ? 1e-7 : -1e-7) * dq[i];
      PetscCall(ContactComplianceSolve(c, q, s.slip0, lambda[k], NULL, NULL));
    }
    for (PetscInt i = 0; i < ROWS; i++) {
      off  = fmax(off, fabs((lambda[1][i] - lambda[2][i]) / 2e-7 - dlambda[i]));
      size = fmax(size, fabs(dlambda[i]));
    }
    worst = fmax(worst, off / size);
    PetscCall(ContactComplianceDestroy(&c));
    PetscCall(SceneDestroy(&s));
  }
  PetscCall(PetscSNPrintf(name, sizeof(name), "%s: derivative beside differences", kinds[kind]));
  *failed += CheckClose(name, worst, 0, 1e-5);
  PetscFunctionReturn(0);
}

/* 1 / k on the diagonal is the same */
static PetscErrorCode TestDiagonal(int *failed)
{
  ComplianceScene   s;
  PairSpring        spring[PAIRS];
  ContactCompliance c;
  PetscReal         lambda[2][ROWS] = {{0}}, apart = 0;

  PetscFunctionBeginUser;
  PetscCall(SceneDrawAll(LINEAR, 99, &s, spring));
  PetscCall(LawsCreate(&s, spring, &c));
  PetscCall(ContactComplianceSolve(c, s.q, s.slip0, lambda[0], NULL, NULL));
  PetscCall(ContactComplianceDestroy(&c));
  for (PetscInt p = 0; p < PAIRS; p++) s.W[3 * p * (ROWS + 1)] += 1 / (spring[p].area * spring[p].law.parameter[0]);
  PetscCall(ContactComplianceCreate(PAIRS, s.W, &c));
  PetscCall(SceneSetFriction(c, PAIRS, s.mu, NULL, NULL, 0));
  PetscCall(ContactComplianceSolve(c, s.q, s.slip0, lambda[1], NULL, NULL));
  for (PetscInt i = 0; i < ROWS; i++) apart = fmax(apart, fabs(lambda[0][i] - lambda[1][i]));
  *failed += CheckClose("linear: as on the diagonal of the compliance", apart, 0, 1e-12);
  PetscCall(ContactComplianceDestroy(&c));
  PetscCall(SceneDestroy(&s));
  PetscFunctionReturn(0);
}

static PetscErrorCode Tests(PetscMPIInt size, int *failed)
{
  PetscFunctionBeginUser;
  (void)size;
  for (Kind kind = LINEAR; kind < KINDS; kind++) PetscCall(TestLaws(kind, failed));
  for (Kind kind = LINEAR; kind < TABLE; kind++) PetscCall(TestTangent(kind, failed));
  PetscCall(TestDiagonal(failed));
  PetscFunctionReturn(0);
}

int main(int argc, char **argv)
{
  return PetscMain(argc, argv, Tests);
}
