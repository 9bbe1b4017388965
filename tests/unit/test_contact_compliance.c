/*
   Unit test of contact/compliance: one pair against the exact solution of kernels/cone.h, scenes at random against the
   laws, which compliancescene.h writes out a second time.
*/
#include "check.h"
#include "compliancescene.h"
#include "contact/compliance/contactcompliance.h"
#include "kernels/cone.h"
#include "petscmain.h"

/* What many scenes ended with */
typedef struct {
  PetscInt  unsolved, status[CONTACT_N_STATUS];
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
  PetscCall(ContactComplianceSetFriction(c, &(ComplianceFriction){.mu = s->mu}));
  PetscCall(ContactComplianceSolve(c, s->q, s->slip0, lambda, NULL, &report));
  PetscCall(ContactComplianceGetStatus(c, &status));
  for (PetscInt p = 0; p < s->n; p++) tally->status[status[p]]++;
  if (!report.converged) tally->unsolved++;
  tally->worst = fmax(tally->worst, SceneViolation(s, lambda));
  PetscCall(ContactComplianceDestroy(&c));
  PetscFunctionReturn(0);
}

/* mu, and motions of order 1 about a mean approach and sliding */
static void DrawMotion(ComplianceScene *s, PetscReal mu, PetscReal normal, PetscReal sliding)
{
  for (PetscInt p = 0; p < s->n; p++) {
    s->mu[p]            = mu;
    s->q[3 * p]         = normal + SceneDraw(s);
    s->q[3 * p + 1]     = SceneDraw(s);
    s->q[3 * p + 2]     = SceneDraw(s);
    s->slip0[2 * p]     = -sliding;
    s->slip0[2 * p + 1] = 0.1 * SceneDraw(s);
  }
}

/* Breaks when: the system of one pair has a wrong sign, or slip counts from another place. Friction below 1 and
   full-rank W: the solution is the only one but for strong coupling, where ConeSolve's may be another; then the laws hold */
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
    DrawMotion(&s, 0.5 + 0.5 * SceneDraw(&s), -0.5, 0);
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

/* Compliances of scenes */
typedef enum { BODY_HALF_SPACE, BODY_RANDOM, BODY_HOLDER, BODY_N } SceneBody;

static const char *const body_names[] = {"half-space", "random", "on a holder"};

static void AddBody(ComplianceScene *s, SceneBody body)
{
  if (body == BODY_RANDOM)
    SceneAddRandom(s, 3 * s->n, 1, 1);
  else
    SceneAddHalfSpace(s, body == BODY_HOLDER ? 0.3 : 1, 0.5);
  if (body == BODY_HOLDER) SceneAddHolder(s, 1);
}

/* 1 to 60 pairs, from no forces. Breaks when: the iteration ends elsewhere than at a solution, or not at all */
static PetscErrorCode TestScenes(SceneBody body, PetscReal mu, int *failed)
{
  static const PetscReal motions[3][2] = {
    {0,    0},
    {-0.5, 0},
    {-0.5, 5}
  };
  Tally tally = {0};
  char  name[64];

  PetscFunctionBeginUser;
  for (uint64_t seed = 1; seed <= 60; seed++) {
    const PetscReal *motion = motions[seed % 3];
    ComplianceScene  s;
    PetscReal       *lambda;

    PetscCall(SceneCreate(1 + (PetscInt)(seed * 7919 % 60), seed, &s));
    PetscCall(PetscCalloc1(3 * s.n, &lambda));
    AddBody(&s, body);
    DrawMotion(&s, mu, motion[0], motion[1]);
    PetscCall(SolveScene(&s, lambda, &tally));
    PetscCall(PetscFree(lambda));
    PetscCall(SceneDestroy(&s));
  }
  PetscCall(PetscSNPrintf(name, sizeof(name), "%s, mu %g", body_names[body], (double)mu));
  *failed += CheckTrue(name, tally.unsolved == 0, tally.unsolved);
  *failed += CheckClose(name, tally.worst, 0, 1e-11);
  PetscFunctionReturn(0);
}

static PetscErrorCode Tests(PetscMPIInt size, int *failed)
{
  PetscFunctionBeginUser;
  (void)size;
  PetscCall(TestOnePair(failed));
  for (SceneBody body = BODY_HALF_SPACE; body < BODY_N; body++) {
    PetscCall(TestScenes(body, 0.3, failed));
    PetscCall(TestScenes(body, 0.5, failed));
    PetscCall(TestScenes(body, 1, failed));
  }
  PetscFunctionReturn(0);
}

int main(int argc, char **argv)
{
  return PetscMain(argc, argv, Tests);
}
