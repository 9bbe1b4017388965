/*
   Unit test of contact/compliance: one pair against the exact solution of kernels/contact/cone.h and against closed forms, made
   solutions of two pairs, friction along a line against the enumeration of all statuses, scenes at random against the
   laws, which compliancescene.h writes out a second time.
*/
#include "check.h"
#include "compliancescene.h"
#include "contact/compliance/compliance.h"
#include "enumerate.h"
#include "kernels/contact/cone.h"
#include "petscmain.h"

/* What many scenes ended with */
typedef struct {
  PetscInt  unsolved, status[CONTACT_N_STATUS], routes[COMPLIANCE_N_ROUTES];
  PetscReal worst;
} Tally;

/* One step from the guess lambda */
static PetscErrorCode SolveScene(const ComplianceScene *s, PetscReal lambda[], Tally *tally)
{
  ContactCompliance    c;
  ComplianceReport     report;
  const ContactStatus *status;

  PetscFunctionBeginUser;
  PetscCall(ContactComplianceCreate(s->n, s->W, &c));
  PetscCall(SceneSetFriction(c, s->n, s->mu, NULL, NULL, 0));
  PetscCall(ContactComplianceSolve(c, s->q, s->slip0, lambda, NULL, &report));
  PetscCall(ContactComplianceGetStatus(c, &status));
  for (PetscInt p = 0; p < s->n; p++) tally->status[status[p]]++;
  for (int i = 0; i < COMPLIANCE_N_ROUTES; i++) tally->routes[i] += report.routes[i];
  if (!report.converged) tally->unsolved++;
  tally->worst = fmax(tally->worst, SceneViolation(s, lambda));
  PetscCall(ContactComplianceDestroy(&c));
  PetscFunctionReturn(0);
}

/* Breaks when: the system of one pair has a wrong sign, or slip counts from another place. mu below 1: the solution is the
   only one but where W couples strongly; where ConeSolve's is another, the laws hold */
static PetscErrorCode TestOnePair(int *failed)
{
  Tally     tally = {0};
  PetscInt  other = 0;
  PetscReal apart = 0;

  PetscFunctionBeginUser;
  for (uint64_t seed = 1; seed <= 2000; seed++) {
    ComplianceScene s;
    PetscReal       W[3][3], q[3], p[3], lambda[3] = {0, 0, 0}, error = 0;

    PetscCall(SceneCreate(1, seed, &s));
    SceneAddRandom(&s, 4, 1, 1);
    SceneDrawMotion(&s, 0.5 + 0.5 * SceneDraw(&s), -0.5, 0);
    PetscCall(SolveScene(&s, lambda, &tally));
    for (int i = 0; i < 3; i++) {
      q[i] = s.q[i] - (i ? s.slip0[i - 1] : 0);
      for (int j = 0; j < 3; j++) W[i][j] = s.W[3 * i + j];
    }
    (void)ConeSolve((const PetscReal(*)[3])W, q, s.mu[0], p);
    for (int i = 0; i < 3; i++) error = fmax(error, fabs(lambda[i] - p[i]) / (1 + fabs(p[0])));
    if (error > 1e-6)
      other++;
    else
      apart = fmax(apart, error);
    PetscCall(SceneDestroy(&s));
  }
  *failed += CheckTrue("one pair: converged", tally.unsolved == 0, tally.unsolved);
  *failed += CheckTrue("one pair: all statuses",
                       tally.status[0] > 100 && tally.status[1] > 100 && tally.status[2] > 100, tally.status[1]);
  *failed += CheckClose("one pair: laws", tally.worst, 0, 1e-11);
  *failed += CheckClose("one pair: against ConeSolve", apart, 0, 1e-9);
  *failed += CheckTrue("one pair: other solutions are few", other < 20, other);
  PetscFunctionReturn(0);
}

/* mu + slope (s / dt - speed) of one pair without coupling: s + w_t mu(s) lambda_n = |q_T|, linear in s. Breaks when: mu is
   that of another slip, or a step, or is not limited by 0 */
static PetscErrorCode TestFallingFriction(int *failed)
{
  const PetscReal mu[1] = {0.4}, speed[1] = {0.5}, dt = 0.1, wn = 2, wt = 0.5, q[3] = {-3, 0.3, 0.4}, none[2] = {0, 0};
  const PetscReal W[9] = {wn, 0, 0, 0, wt, 0, 0, 0, wt}, slopes[3] = {-0.05, 0.03, -0.2};

  PetscFunctionBeginUser;
  for (int k = 0; k < 3; k++) {
    const PetscReal   slope[1] = {slopes[k]}, force = -q[0] / wn;
    const PetscReal   line      = (0.5 - wt * force * (mu[0] - slope[0] * speed[0])) / (1 + wt * force * slope[0] / dt);
    const PetscReal   slip      = line >= 0 ? line : 0.5; /* mu = 0 there */
    const PetscReal   own       = fmax(0, mu[0] + slope[0] * (slip / dt - speed[0]));
    PetscReal         lambda[3] = {0, 0, 0};
    ContactCompliance c;
    ComplianceReport  report;

    PetscCall(ContactComplianceCreate(1, W, &c));
    PetscCall(SceneSetFriction(c, 1, mu, slope, speed, dt));
    PetscCall(ContactComplianceSolve(c, q, none, lambda, NULL, &report));
    *failed += CheckTrue("falling friction: converged", report.converged, report.residual);
    *failed += CheckClose("falling friction: along the slip", lambda[1], -0.6 * own * force, 1e-11);
    *failed += CheckClose("falling friction: across", lambda[2], -0.8 * own * force, 1e-11);
    PetscCall(ContactComplianceDestroy(&c));
  }
  PetscFunctionReturn(0);
}

/* Force and motion of a pair that obey the laws, of a status */
static void MakePair(ComplianceScene *s, PetscInt p, ContactStatus status, PetscReal l[3], PetscReal v[3])
{
  const PetscReal angle = PETSC_PI * SceneDraw(s), part = status == CONTACT_STICK ? 0.8 : 1;

  for (int i = 0; i < 3; i++) l[i] = v[i] = 0;
  if (status == CONTACT_OPEN) {
    for (int i = 0; i < 3; i++) v[i] = i ? SceneDraw(s) : 1.5 + SceneDraw(s);
    return;
  }
  l[0] = 1.5 + SceneDraw(s);
  l[1] = -part * s->mu[p] * l[0] * cos(angle);
  l[2] = -part * s->mu[p] * l[0] * sin(angle);
  if (status == CONTACT_STICK) return;
  v[1] = 0.7 * cos(angle);
  v[2] = 0.7 * sin(angle);
}

/* Two pairs, made solutions of every pair of statuses; I and a little of a random W: the only one. Breaks when: a pair's
   force acts on the wrong rows of the other */
static PetscErrorCode TestTwoPairs(int *failed)
{
  Tally     tally = {0};
  PetscReal worst = 0;

  PetscFunctionBeginUser;
  for (uint64_t seed = 0; seed < 180; seed++) {
    ComplianceScene s;
    PetscReal       l[6], v[6], lambda[6] = {0}, r[6];

    PetscCall(SceneCreate(2, seed, &s));
    SceneAddRandom(&s, 6, 0.3, 1);
    for (int i = 0; i < 6; i++) s.W[7 * i] += 1;
    s.mu[0] = 0.3, s.mu[1] = 0.6;
    MakePair(&s, 0, (ContactStatus)(seed % 3), l, v);
    MakePair(&s, 1, (ContactStatus)(seed / 3 % 3), &l[3], &v[3]);
    SceneMove(&s, l, r);
    for (int i = 0; i < 4; i++) s.slip0[i] = SceneDraw(&s);
    for (int i = 0; i < 6; i++) s.q[i] = v[i] - r[i] + (i % 3 ? s.slip0[i / 3 * 2 + i % 3 - 1] : 0);
    PetscCall(SolveScene(&s, lambda, &tally));
    for (int i = 0; i < 6; i++) worst = fmax(worst, fabs(lambda[i] - l[i]));
    PetscCall(SceneDestroy(&s));
  }
  *failed += CheckTrue("two pairs: converged", tally.unsolved == 0, tally.unsolved);
  *failed += CheckClose("two pairs: made solutions", worst, 0, 1e-10);
  PetscFunctionReturn(0);
}

#define LINE_PAIRS 4

/* Friction along one line: forces of a choice of statuses (0 open, 1 stick, 2 and 3 slip forwards and back), x [n][2];
   whether they obey all laws */
static PetscBool LineSolve(const ComplianceScene *s, const int status[], long double x[])
{
  const int   n = (int)s->n, N = 2 * n;
  long double A[4 * LINE_PAIRS * LINE_PAIRS] = {0}, v[2 * LINE_PAIRS];

  for (int i = 0; i < N; i++) {
    const int         sign = status[i / 2] == 2 ? 1 : -1;
    const long double mu   = s->mu[i / 2];

    x[i] = 0;
    if (status[i / 2] == 0 || (i % 2 && status[i / 2] > 1)) { /* no force; lambda_t + sign mu lambda_n = 0 */
      A[i * N + i] = 1;
      if (status[i / 2]) A[i * N + i - 1] = sign * mu;
      continue;
    }
    x[i] = -(long double)s->q[i / 2 * 3 + i % 2];
    for (int j = 0; j < N; j++) A[i * N + j] = s->W[(j / 2 * 3 + j % 2) * 3 * n + i / 2 * 3 + i % 2];
  }
  if (!LongSolve(N, A, 1, x)) return PETSC_FALSE;
  for (int i = 0; i < N; i++) {
    v[i] = s->q[i / 2 * 3 + i % 2];
    for (int j = 0; j < N; j++) v[i] += s->W[(j / 2 * 3 + j % 2) * 3 * n + i / 2 * 3 + i % 2] * x[j];
  }
  for (int p = 0; p < n; p++) {
    if (status[p] == 0 && v[2 * p] < 0) return PETSC_FALSE;
    if (status[p] && x[2 * p] < 0) return PETSC_FALSE;
    if (status[p] == 1 && fabsl(x[2 * p + 1]) > s->mu[p] * x[2 * p]) return PETSC_FALSE;
    if ((status[p] == 2 && v[2 * p + 1] < 0) || (status[p] == 3 && v[2 * p + 1] > 0)) return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

/* Distance of lambda from the nearest of all solutions, and how many there are */
static PetscReal LineNearest(const ComplianceScene *s, const PetscReal lambda[], PetscInt *n_solutions)
{
  PetscReal nearest = PETSC_MAX_REAL;

  *n_solutions = 0;
  for (int k = 0; k < 1 << (2 * s->n); k++) {
    long double x[2 * LINE_PAIRS];
    int         status[LINE_PAIRS];
    PetscReal   apart = 0;

    for (int p = 0; p < (int)s->n; p++) status[p] = k >> (2 * p) & 3;
    if (!LineSolve(s, status, x)) continue;
    (*n_solutions)++;
    for (int i = 0; i < 2 * (int)s->n; i++)
      apart = fmax(apart, fabs((double)x[i] - lambda[i / 2 * 3 + i % 2]) / (1 + fabs(lambda[i / 2 * 3])));
    nearest = fmin(nearest, apart);
  }
  return nearest;
}

/* Strong coupling, mu up to 3, where several solutions are common. Breaks when: what is found is none of them */
static PetscErrorCode TestLine(int *failed)
{
  Tally     tally   = {0};
  PetscReal worst   = 0;
  PetscInt  several = 0;

  PetscFunctionBeginUser;
  for (uint64_t seed = 1; seed <= 300; seed++) {
    ComplianceScene s;
    PetscReal       lambda[3 * LINE_PAIRS] = {0};
    PetscInt        n_solutions;

    PetscCall(SceneCreate(1 + (PetscInt)(seed % LINE_PAIRS), seed, &s));
    SceneAddRandom(&s, 2 * s.n, 1, 1);
    SceneDrawMotion(&s, 1.5 + 1.5 * SceneDraw(&s), -0.5, 0);
    for (PetscInt i = 0; i < 2 * s.n; i++) s.slip0[i] = 0;
    for (PetscInt i = 0; i < 9 * s.n * s.n; i++)
      if (i % 3 == 2 || i / (3 * s.n) % 3 == 2) s.W[i] = 0;
    for (PetscInt p = 0; p < s.n; p++) s.q[3 * p + 2] = 0;
    PetscCall(SolveScene(&s, lambda, &tally));
    worst = fmax(worst, LineNearest(&s, lambda, &n_solutions));
    several += n_solutions > 1;
    PetscCall(SceneDestroy(&s));
  }
  *failed += CheckTrue("along a line: converged", tally.unsolved == 0, tally.unsolved);
  *failed += CheckTrue("along a line: scenes with several solutions", several > 5, several);
  *failed += CheckClose("along a line: one of all solutions", worst, 0, 1e-8);
  PetscFunctionReturn(0);
}

/* 1 to 60 pairs, from no forces. Breaks when: the methods end elsewhere than at a solution, or not at all */
static PetscErrorCode TestScenes(SceneBody body, PetscReal mu, PetscInt *n_paths, int *failed)
{
  static const PetscReal motions[3][2] = {
    {0,    0},
    {-0.5, 0},
    {-0.5, 5}
  };
  Tally tally = {0};
  char  name[64];

  PetscFunctionBeginUser;
  for (uint64_t seed = 1; seed <= 45; seed++) {
    const PetscReal *motion = motions[seed % 3];
    ComplianceScene  s;
    PetscReal       *lambda;

    PetscCall(SceneCreate(1 + (PetscInt)(seed * 7919 % (body > BODY_HOLDER ? 25 : SCENE_MOST)), seed, &s));
    PetscCall(PetscCalloc1(3 * s.n, &lambda));
    SceneAddBody(&s, body);
    SceneDrawMotion(&s, mu, motion[0], motion[1]);
    if (body == BODY_RIGID || body == BODY_TWICE) PetscCall(SceneMakeConsistent(&s));
    PetscCall(SolveScene(&s, lambda, &tally));
    PetscCall(PetscFree(lambda));
    PetscCall(SceneDestroy(&s));
  }
  *n_paths += tally.routes[COMPLIANCE_PATH];
  PetscCall(PetscSNPrintf(name, sizeof(name), "%s, mu %g: converged", scene_bodies[body], (double)mu));
  *failed += CheckTrue(name, tally.unsolved == 0, tally.unsolved);
  PetscCall(PetscSNPrintf(name, sizeof(name), "%s, mu %g: laws", scene_bodies[body], (double)mu));
  *failed += CheckClose(name, tally.worst, 0, 1e-11);
  PetscFunctionReturn(0);
}

/* Most pairs stick, some slide, some are open: steps of Newton's method on motions. Breaks when: such a step is another than that on
   forces, so that Newton's method takes more steps or none ends it; a slope that changes nothing keeps it from that */
static PetscErrorCode TestDual(int *failed)
{
  const PetscInt    n                       = 49;
  PetscInt          count[CONTACT_N_STATUS] = {0};
  ComplianceScene   s;
  ContactCompliance c;
  ComplianceReport  report[2];
  PetscReal        *lambda[2], *slope, *speed, off = 0;

  PetscFunctionBeginUser;
  PetscCall(SceneCreate(n, 3, &s));
  SceneAddBody(&s, BODY_HALF_SPACE);
  SceneDrawMotion(&s, 3, -10, 0);
  PetscCall(PetscCalloc4(3 * n, &lambda[0], 3 * n, &lambda[1], n, &slope, n, &speed));
  for (int k = 0; k < 2; k++) {
    for (PetscInt p = 0; p < n; p++) slope[p] = k * 1e-30;
    PetscCall(ContactComplianceCreate(n, s.W, &c));
    PetscCall(SceneSetFriction(c, n, s.mu, slope, speed, 1));
    PetscCall(ContactComplianceSolve(c, s.q, s.slip0, lambda[k], NULL, &report[k]));
    PetscCall(ContactComplianceDestroy(&c));
  }
  for (PetscInt i = 0; i < 3 * n; i++) off = PetscMax(off, PetscAbsReal(lambda[0][i] - lambda[1][i]));
  for (PetscInt p = 0; p < n; p++) {
    const PetscReal *l = &lambda[0][3 * p];

    count[l[0] <= 0 ? CONTACT_OPEN : hypot(l[1], l[2]) < (1 - 1e-9) * s.mu[p] * l[0] ? CONTACT_STICK : CONTACT_SLIP]++;
  }
  *failed +=
    CheckTrue("on motions: most stick, some slide, some are open",
              2 * count[CONTACT_STICK] > n && count[CONTACT_SLIP] && count[CONTACT_OPEN], count[CONTACT_STICK]);
  *failed += CheckTrue("on motions: by Newton's method", report[0].route == COMPLIANCE_NEWTON, report[0].route);
  *failed += CheckTrue("on motions: few steps", report[0].iterations < 10, report[0].iterations);
  *failed += CheckClose("on motions: laws", SceneViolation(&s, lambda[0]), 0, 1e-11);
  *failed += CheckClose("on motions: forces of the other route", off, 0, 1e-11);
  PetscCall(PetscFree4(lambda[0], lambda[1], slope, speed));
  PetscCall(SceneDestroy(&s));
  PetscFunctionReturn(0);
}

static PetscErrorCode Tests(PetscMPIInt size, int *failed)
{
  PetscInt n_paths = 0;

  PetscFunctionBeginUser;
  (void)size;
  PetscCall(TestOnePair(failed));
  PetscCall(TestFallingFriction(failed));
  PetscCall(TestTwoPairs(failed));
  PetscCall(TestLine(failed));
  PetscCall(TestDual(failed));
  for (SceneBody body = BODY_HALF_SPACE; body < BODY_N; body++) {
    PetscCall(TestScenes(body, 0.3, &n_paths, failed));
    PetscCall(TestScenes(body, 0.5, &n_paths, failed));
    PetscCall(TestScenes(body, 1, &n_paths, failed));
  }
  *failed += CheckTrue("some scenes need the path", n_paths > 10, n_paths);
  PetscFunctionReturn(0);
}

int main(int argc, char **argv)
{
  return PetscMain(argc, argv, Tests);
}
