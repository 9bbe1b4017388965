/*
   The branch of cycles through the one that was found, both ways by pseudo-arclength (solver/shooting.h), through folds, until
   the parameter leaves its range, the vibration vanishes or no further cycle is found. Distances are those of (eta, rate)
   over their rms in the first cycle, of T over itself and of the parameter over its range.
*/
#include "cycleimpl.h"

#define BRANCH_STEP    0.1 /* the first */
#define BRANCH_LONGEST 0.25
#define BRANCH_SHRINKS                                                                                                 \
  0.7 /* times the rms over that of the first cycle, at most: the vibration is not passed by zero */
#define BRANCH_SHORTEST 1e-4
#define BRANCH_EASY     3 /* steps of Newton's method after which the next step is longer */
#define BRANCH_MAX_IT   8
#define BRANCH_VANISHED 0.05 /* rms of the force over that of the first cycle */

/* The interface of which the parameter is the friction coefficient, -1 for none */
static PetscErrorCode BranchFind(LimitCycle c, PetscInt n, const ContactInterface interfaces[], PetscInt *found)
{
  char name[256], valid[1024] = "";

  PetscFunctionBeginUser;
  *found = -1;
  for (PetscInt k = 0; k < n; k++) {
    PetscBool same;

    PetscCall(PetscSNPrintf(name, sizeof(name), "%s_mu", interfaces[k].name));
    PetscCall(PetscStrcmp(name, c->parameter, &same));
    if (same) *found = k;
    if (k) PetscCall(PetscStrlcat(valid, ", ", sizeof(valid)));
    PetscCall(PetscStrlcat(valid, name, sizeof(valid)));
  }
  PetscCheck(*found >= 0, c->comm, PETSC_ERR_USER_INPUT,
             "-cycle_parameter '%s' is no parameter along which cycles can be followed; valid are %s", c->parameter,
             valid);
  PetscFunctionReturn(0);
}

PetscErrorCode CycleFindParameter(LimitCycle c)
{
  const ContactInterface *interfaces;
  PetscInt                n;

  PetscFunctionBeginUser;
  c->varied = -1;
  if (!c->parameter[0]) PetscFunctionReturn(0);
  PetscCall(ContactGetInterfaces(c->contact, &n, &interfaces));
  PetscCall(BranchFind(c, n, interfaces, &c->varied));
  c->value = interfaces[c->varied].mu;
  PetscCheck(c->value >= c->range[0] && c->value <= c->range[1], c->comm, PETSC_ERR_USER_INPUT,
             "-cycle_range %.6g,%.6g must hold -%s %.6g, where the transient finds the first cycle",
             (double)c->range[0], (double)c->range[1], c->parameter, (double)c->value);
  PetscFunctionReturn(0);
}

PetscErrorCode CycleSetParameter(LimitCycle c)
{
  const ReducedRun r = c->reduced;

  PetscFunctionBeginUser;
  if (c->varied < 0) PetscFunctionReturn(0);
  PetscCall(PetscCalloc1(r->model.n_pairs, &c->flow.varies));
  for (PetscInt i = 0; i < r->model.n_pairs; i++) c->flow.varies[i] = r->pair[i].interface == c->varied;
  c->flow.span = c->range[1] - c->range[0];
  PetscFunctionReturn(0);
}

static PetscErrorCode BranchCopy(PetscInt n, const ShootingCycle *from, ShootingCycle *to)
{
  PetscReal *x = to->x, *M = to->M;

  PetscFunctionBeginUser;
  *to   = *from;
  to->x = x;
  to->M = M;
  PetscCall(PetscArraycpy(x, from->x, n));
  PetscCall(PetscArraycpy(M, from->M, n * n));
  PetscFunctionReturn(0);
}

/* The cycle at the end of the range, from one beyond it */
static PetscErrorCode BranchClip(LimitCycle c, ShootingCycle *at, PetscBool *taken)
{
  PetscFunctionBeginUser;
  at->value = PetscMin(c->range[1], PetscMax(c->range[0], at->value));
  PetscCall(ShootingSolve(&c->shooting, at));
  *taken = at->converged;
  PetscFunctionReturn(0);
}

/* Whether to go on after a step, and how far the next one goes; why not, else */
static PetscBool BranchGoesOn(const LimitCycle c, const ShootingCycle *at, PetscReal *step, const char **end)
{
  if (!at->converged) {
    *step /= 2;
    if (*step < BRANCH_SHORTEST) *end = "no further cycle is found";
    return *end ? PETSC_FALSE : PETSC_TRUE;
  }
  *step = at->its <= BRANCH_EASY ? PetscMin(1.5 * *step, BRANCH_LONGEST) : *step;
  *step = PetscMin(*step, BRANCH_SHRINKS * c->point[c->n_points - 1].found.rms / c->rms);
  if (at->value <= c->range[0] || at->value >= c->range[1])
    *end = "end of -cycle_range";
  else if (c->point[c->n_points - 1].found.rms < BRANCH_VANISHED * c->rms)
    *end = "the vibration vanishes";
  else if (c->n_points >= c->max_points)
    *end = "-cycle_points";
  return *end ? PETSC_FALSE : PETSC_TRUE;
}

/* One way along the branch, the parameter falling or rising at first */
static PetscErrorCode BranchWalk(LimitCycle c, PetscReal direction, ShootingCycle *at, const char **end)
{
  ShootingTangent tangent = {.period = 0, .value = direction * c->flow.span};
  PetscReal       step    = BRANCH_STEP;
  PetscBool       on      = PETSC_TRUE;

  PetscFunctionBeginUser;
  *end = NULL;
  PetscCall(PetscCalloc1(c->flow.n, &tangent.x));
  PetscCall(ShootingGetTangent(&c->shooting, at, &tangent));
  while (on) {
    PetscBool taken, beyond;

    PetscCall(ShootingAdvance(&c->shooting, step, &tangent, at));
    taken  = at->converged;
    beyond = taken && (at->value < c->range[0] || at->value > c->range[1]) ? PETSC_TRUE : PETSC_FALSE;
    if (beyond) PetscCall(BranchClip(c, at, &taken));
    if (beyond && !taken) *end = "none is found at the end of -cycle_range"; /* `at` is no cycle to go on from */
    if (taken) PetscCall(CycleTake(c, at));
    on = *end ? PETSC_FALSE : BranchGoesOn(c, at, &step, end);
    if (taken && on) PetscCall(ShootingGetTangent(&c->shooting, at, &tangent));
  }
  PetscCall(PetscFree(tangent.x));
  PetscFunctionReturn(0);
}

PetscErrorCode CycleFollow(LimitCycle c, const ShootingCycle *start)
{
  const PetscInt n = c->flow.n, max_it = c->shooting.max_it, max_points = c->max_points;
  ShootingCycle  at;

  PetscFunctionBeginUser;
  c->rms             = c->point[0].found.rms;
  c->shooting.max_it = BRANCH_MAX_IT;
  PetscCall(PetscMalloc2(n, &at.x, n * n, &at.M));
  for (int way = 0; way < 2; way++) {
    PetscCall(BranchCopy(n, start, &at));
    c->max_points = way ? c->n_points + max_points / 2 : 1 + max_points / 2;
    PetscCall(BranchWalk(c, way ? 1 : -1, &at, &c->end[way]));
    for (PetscInt i = 0, j = c->n_points - 1; !way && i < j; i++, j--) {
      const CyclePoint first = c->point[i];

      c->point[i] = c->point[j];
      c->point[j] = first;
    }
  }
  c->max_points      = max_points;
  c->shooting.max_it = max_it;
  PetscCall(PetscFree2(at.x, at.M));
  PetscFunctionReturn(0);
}
