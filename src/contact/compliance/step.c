/*
   One step on W as it is: scales of the pairs, the order of the methods, the report. Statuses are decided at its end.

   Where mu falls so steeply with the slip speed that a step has more than one solution, a pair may stick by its static
   friction, or slide with less at once. A pair that rests goes on resting while mu(0) holds it, and so does one whose
   slip would turn back within the step: it passes rest. Such pairs have mu(0) first; those that slide with that are
   released, and the laws are solved again.
*/
#include "complianceimpl.h"

#define COMPLIANCE_POWER     30 /* iterations for the largest eigenvalue, */
#define COMPLIANCE_POWER_MAP 6  /* of a map, whose products cost more */
#define COMPLIANCE_MAX_IT    40 /* of Newton's method */

/* kappa = 3 / trace W_pp, N/m; that of the mean where a pair is held in all directions, W_pp = 0, whose force is any
   that the laws ask for */
static void StiffnessSet(ContactCompliance c)
{
  const PetscInt N   = 3 * c->n;
  PetscReal      sum = 0;

  for (PetscInt i = 0; i < N; i++) sum += c->W[i * N + i];
  for (PetscInt p = 0; p < c->n; p++) {
    PetscReal trace = 0;

    for (PetscInt i = 3 * p; i < 3 * p + 3; i++) trace += c->W[i * N + i];
    c->kappa[p] = trace > 0 ? 3 / trace : sum > 0 ? N / sum : 1;
  }
}

/* Statuses are decided by l - a v, a = 1 / sqrt(largest eigenvalue of W kappa): between what a pair feels alone, 1,
   and what all feel together. With 1, a motion of all pairs that hardly changes their forces would change all their
   statuses. Power iteration in the inner product x' kappa y, in which W kappa is symmetric, from a vector that is no
   mode of a symmetric scene. A rough value is enough: any a > 0 has the same solutions. */
static PetscErrorCode WeightSet(ContactCompliance c)
{
  const PetscReal    zero = 0, one = 1;
  const PetscBLASInt N = (PetscBLASInt)(3 * c->n), inc = 1;
  const PetscInt     most    = ComplianceIsMap(c) ? COMPLIANCE_POWER_MAP : COMPLIANCE_POWER;
  PetscReal          largest = 1;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < N; i++) c->l[i] = 1 + 0.3 * PetscSinReal((PetscReal)i);
  for (PetscInt k = 0; k < most && N; k++) {
    PetscReal before = 0, after = 0;

    for (PetscInt i = 0; i < N; i++) c->force[i] = c->kappa[i / 3] * c->l[i];
    if (ComplianceIsMap(c))
      PetscCall(c->krylov.map.nearly(c->krylov.map.ctx, c->force, c->v));
    else
      BLASgemv_("N", &N, &N, &one, c->W, &N, c->force, &inc, &zero, c->v, &inc);
    for (PetscInt i = 0; i < N; i++) {
      before += c->kappa[i / 3] * PetscSqr(c->l[i]);
      after += c->kappa[i / 3] * PetscSqr(c->v[i]);
    }
    if (!(after > 0)) break;
    largest = PetscSqrtReal(after / before);
    for (PetscInt i = 0; i < N; i++) c->l[i] = c->v[i] / PetscSqrtReal(after);
  }
  c->weight = 1 / PetscSqrtReal(PetscMax(1, largest));
  PetscFunctionReturn(0);
}

PetscErrorCode ComplianceSetScales(ContactCompliance c)
{
  PetscFunctionBeginUser;
  if (!ComplianceIsMap(c)) StiffnessSet(c);
  PetscCall(WeightSet(c));
  PetscFunctionReturn(0);
}

/* Motions without forces, free = q - (0, slip0), m, and the guess; a guess that pulls or drives is none. Not finite
   is an error here, before it can run through all four methods. */
static PetscErrorCode StepBegin(ContactCompliance c, const PetscReal q[], const PetscReal slip0[],
                                const PetscReal lambda[])
{
  PetscFunctionBeginUser;
  c->blend  = 0;
  c->report = (ComplianceReport){.worst = -1, .steps = 1};
  for (PetscInt p = 0; p < c->n; p++) {
    for (PetscInt i = 0; i < 3; i++) {
      const PetscReal at = q[3 * p + i] - (i ? slip0[2 * p + i - 1] : 0), force = lambda[3 * p + i] / c->kappa[p];

      PetscCheck(!PetscIsInfOrNanReal(at) && !PetscIsInfOrNanReal(force), PETSC_COMM_SELF, PETSC_ERR_FP,
                 "Contact pair %" PetscInt_FMT ": displacement %g m or force %g N is not finite", p, (double)at,
                 (double)lambda[3 * p + i]);
      c->free[3 * p + i] = at;
      c->l[3 * p + i]    = lambda[3 * p] > 0 ? force : 0;
    }
    if (ComplianceIsMap(c)) continue; /* begins with the statuses of the step before */
    c->status[p] = lambda[3 * p] > 0 ? CONTACT_SLIP : CONTACT_OPEN;
  }
  PetscFunctionReturn(0);
}

/* The residual is relative to scale + noise / rtol, hence below rtol exactly where ComplianceIsSolved() says so */
static void StepJudge(ContactCompliance c, const ComplianceMiss *miss)
{
  c->report.converged = ComplianceIsSolved(c, miss);
  c->report.residual  = miss->largest > 0 ? miss->largest / (miss->scale + miss->noise / c->rtol) : 0;
  c->report.worst     = miss->worst;
}

void ComplianceReportStep(ContactCompliance c)
{
  ComplianceReport *one = &c->report, *all = &c->totals;

  one->routes[one->route]++;
  all->converged = one->converged && all->converged ? PETSC_TRUE : PETSC_FALSE;
  all->route     = PetscMax(all->route, one->route);
  all->iterations += one->iterations;
  all->factors += one->factors;
  all->steps++;
  for (PetscInt i = 0; i < COMPLIANCE_N_ROUTES; i++) all->routes[i] += one->routes[i];
  if (!(one->residual > all->residual)) return;
  all->residual = one->residual;
  all->worst    = one->worst;
}

/* The methods one after the other until the laws hold */
static PetscErrorCode StepIterate(ContactCompliance c, ComplianceMiss *miss)
{
  PetscFunctionBeginUser;
  if (ComplianceIsMap(c)) {
    PetscCall(ComplianceIterate(c, PETSC_FALSE, COMPLIANCE_MAX_IT, miss));
  } else
    PetscCall(ComplianceChordIterate(c, miss));
  c->report.route = ComplianceIsMap(c) ? COMPLIANCE_NEWTON : COMPLIANCE_CHORD;
  while (!ComplianceIsSolved(c, miss) && c->report.route < (ComplianceIsMap(c) ? COMPLIANCE_DAMPED : COMPLIANCE_PATH)) {
    c->report.route++;
    if (c->report.route == COMPLIANCE_NEWTON) PetscCall(ComplianceIterate(c, PETSC_FALSE, COMPLIANCE_MAX_IT, miss));
    if (c->report.route == COMPLIANCE_DAMPED) PetscCall(ComplianceIterate(c, PETSC_TRUE, COMPLIANCE_MAX_IT, miss));
    if (c->report.route == COMPLIANCE_PATH) PetscCall(ComplianceFollow(c, miss));
  }
  if (ComplianceIsSolved(c, miss)) PetscCall(ComplianceRefine(c, miss));
  ComplianceChoose(c);
  PetscFunctionReturn(0);
}

/* Releases held pairs that slide, and holds those that turn back beside the guess, each once in a step; true where
   there are any, so that the laws are solved again */
static PetscBool StepHoldOthers(ContactCompliance c, const PetscReal lambda[])
{
  PetscBool changed = PETSC_FALSE;

  for (PetscInt p = 0; p < c->n; p++) {
    const PetscReal *l = &c->l[3 * p], *before = &lambda[3 * p];

    if (!c->varies[p] || c->status[p] != CONTACT_SLIP || c->hold[p] == HOLD_RELEASED) continue;
    if (c->hold[p] == HOLD_NONE && l[1] * before[1] + l[2] * before[2] >= 0) continue;
    c->hold[p] = c->hold[p] == HOLD_NONE ? HOLD_RESTS : HOLD_RELEASED;
    changed    = PETSC_TRUE;
  }
  return changed;
}

/* Laws that do not hold with pairs held are solved from the guess without */
static PetscErrorCode StepLetGo(ContactCompliance c, const PetscReal q[], const PetscReal slip0[],
                                const PetscReal lambda[], ComplianceMiss *miss)
{
  PetscBool held = PETSC_FALSE;

  PetscFunctionBeginUser;
  for (PetscInt p = 0; p < c->n; p++) {
    if (c->hold[p] == HOLD_RESTS) held = PETSC_TRUE;
    c->hold[p] = HOLD_RELEASED;
  }
  if (!held) PetscFunctionReturn(0);
  PetscCall(StepBegin(c, q, slip0, lambda));
  PetscCall(StepIterate(c, miss));
  PetscFunctionReturn(0);
}

PetscErrorCode ComplianceSolveLines(ContactCompliance c, const PetscReal q[], const PetscReal slip0[],
                                    PetscReal lambda[])
{
  ComplianceMiss miss;

  PetscFunctionBeginUser;
  for (PetscInt p = 0; p < c->n; p++) c->hold[p] = c->rests[p] ? HOLD_RESTS : HOLD_NONE;
  PetscCall(StepBegin(c, q, slip0, lambda));
  do PetscCall(StepIterate(c, &miss));
  while (ComplianceIsSolved(c, &miss) && StepHoldOthers(c, lambda));
  if (!ComplianceIsSolved(c, &miss)) PetscCall(StepLetGo(c, q, slip0, lambda, &miss));
  StepJudge(c, &miss);
  for (PetscInt i = 0; i < 3 * c->n; i++) lambda[i] = c->kappa[i / 3] * c->l[i];
  PetscFunctionReturn(0);
}
