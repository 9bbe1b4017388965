/*
   The small system where it is too large to be dense, by GMRES. Each application of W and V is one pair of triangular
   solves, with K_a at first. While nearly all pairs press that suffices; where it takes more solves than a
   factorisation costs, the bodies are factored with the pairs at their present status (refactor.c), and these factors
   take the place of those of K_a, here and in the systems that follow, until more pairs have changed than GMRES may
   take steps.

   The springs of a status are 1 / REFACTOR_YIELD as stiff as kappa, and l that much less exact than with K_a. So z is
   found in two steps where it must be exact: to GMRES_FIRST, then dz from residuals without these springs

      r = f - (K + pins) u - kappa G'l + kappa S'D l,   e = w - G u,   l = P dz, w = Q dz: the same system of r and e.
*/
#include "statics/pairs/small.h"

#define GMRES_ENOUGH 1e-10 /* of GMRES that gets no farther; refinement of the whole does the rest */
/* of the first step, and of the second relative to what the first left */
#define GMRES_FIRST   1e-8
#define GMRES_SECOND  1e-6
#define GMRES_RESTART 300
/* LU takes GMRES_LU times the flops of LDL'; a solve takes GMRES_FLOPS per entry of LDL', which are GMRES_SLOW times
   slower than those of a factorisation */
#define GMRES_LU    2.0
#define GMRES_FLOPS 4.0
#define GMRES_SLOW  8.0
/* least and most solves before the bodies are factored anew */
#define GMRES_LEAST 20
#define GMRES_MOST  200

/* The matrix-free system, and work [rows] */
typedef struct {
  const SmallSystem *system;
  PetscReal         *l, *w, *y;
} SmallShell;

/* y = Q_e^-1 [Q + (W - V D) P - W Q] z, 1 for Q_e with K_a */
static PetscErrorCode SmallShellMult(Mat A, Vec z, Vec y)
{
  const PetscScalar *from;
  PetscScalar       *to;
  const Compliance  *c;
  SmallShell        *s;

  PetscFunctionBeginUser;
  PetscCall(MatShellGetContext(A, &s));
  c = s->system->compliance;
  PetscCall(VecGetArrayRead(z, &from));
  SmallApplyLaws(c->rows, s->system->law, PETSC_FALSE, from, s->l, s->w);
  PetscCall(VecRestoreArrayRead(z, &from));
  PetscCall(ComplianceApply(c, s->system->friction, s->l, s->w, s->y));
  PetscCall(VecGetArray(y, &to));
  StatusFactorScale(c->status, s->y, to);
  PetscCall(VecRestoreArray(y, &to));
  PetscFunctionReturn(0);
}

/* Q_e^-1 of the right-hand side G K^-1 (f + what the constants of the laws and e give) - q0 - e */
static PetscErrorCode SmallShellConstants(SmallShell *s, Vec b)
{
  const SmallSystem *system = s->system;
  const Compliance  *c      = system->compliance;
  const PetscInt     n      = c->rows->n;
  PetscScalar       *value;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < n; i++) {
    s->l[i] = system->law[i].p0;
    s->w[i] = system->law[i].q0 + (system->added ? system->e[i] : 0);
  }
  PetscCall(ComplianceSolve(c, system->friction, system->f, s->l, s->w, c->u));
  PetscCall(ComplianceGetRows(c, c->u, s->y));
  for (PetscInt i = 0; i < n; i++) s->y[i] -= s->w[i];
  PetscCall(VecGetArray(b, &value));
  StatusFactorScale(c->status, s->y, value);
  PetscCall(VecRestoreArray(b, &value));
  PetscFunctionReturn(0);
}

/* How GMRES is to run; how it ended, what is left of |b| */
typedef struct {
  PetscInt  steps;
  PetscBool converged;
  PetscReal left;
} GMRESRun;

/* The solver of the system: residuals of rtol |b| are left, |b| = whole */
static PetscErrorCode SmallCreateGMRES(SmallShell *s, Mat A, const GMRESRun *run, PetscReal whole, KSP *ksp)
{
  const PetscReal rtol =
    StatusFactorServes(s->system->compliance->status) ? PetscMax(GMRES_FIRST, s->system->rtol) : s->system->rtol;
  PC pc;

  PetscFunctionBeginUser;
  PetscCall(KSPCreate(s->system->compliance->rows->comm, ksp));
  PetscCall(KSPSetOptionsPrefix(*ksp, "st_pairs_"));
  PetscCall(KSPSetOperators(*ksp, A, A));
  PetscCall(KSPSetType(*ksp, KSPGMRES));
  PetscCall(KSPSetPCSide(*ksp, PC_RIGHT));
  PetscCall(KSPGMRESSetRestart(*ksp, GMRES_RESTART));
  PetscCall(KSPGMRESSetCGSRefinementType(*ksp, KSP_GMRES_CGS_REFINE_IFNEEDED));
  PetscCall(KSPSetTolerances(*ksp, PETSC_SMALL * PETSC_SMALL, rtol * whole, PETSC_DEFAULT, run->steps));
  PetscCall(KSPGetPC(*ksp, &pc));
  PetscCall(PCSetType(pc, PCNONE));
  PetscCall(KSPSetFromOptions(*ksp));
  PetscFunctionReturn(0);
}

/* z = z + A^-1 (b - A z), in run->steps at most; from 0 where the guess z leaves more than that does */
static PetscErrorCode SmallRunGMRES(SmallShell *s, Mat A, Vec z, GMRESRun *run)
{
  KSPConvergedReason reason;
  PetscReal          whole;
  KSP                ksp;
  Vec                b, r, dz;

  PetscFunctionBeginUser;
  PetscCall(VecDuplicate(z, &b));
  PetscCall(VecDuplicate(z, &r));
  PetscCall(VecDuplicate(z, &dz));
  PetscCall(SmallShellConstants(s, b));
  PetscCall(VecNorm(b, NORM_2, &whole));
  PetscCall(SmallCreateGMRES(s, A, run, whole, &ksp));
  PetscCall(MatMult(A, z, r));
  PetscCall(VecAYPX(r, -1, b));
  PetscCall(VecNorm(r, NORM_2, &run->left));
  if (!(run->left < whole)) {
    PetscCall(VecSet(z, 0));
    PetscCall(VecCopy(b, r));
  }
  PetscCall(KSPSolve(ksp, r, dz));
  PetscCall(VecAXPY(z, 1, dz));
  PetscCall(KSPGetConvergedReason(ksp, &reason));
  PetscCall(KSPGetResidualNorm(ksp, &run->left));
  if (whole > 0) run->left /= whole;
  run->converged = reason > 0 ? PETSC_TRUE : PETSC_FALSE;
  PetscCall(VecDestroy(&b));
  PetscCall(VecDestroy(&r));
  PetscCall(VecDestroy(&dz));
  PetscCall(KSPDestroy(&ksp));
  PetscFunctionReturn(0);
}

/* Solves that cost as much as LU: GMRES_LU flops / (GMRES_SLOW GMRES_FLOPS entries), both of LDL' */
static PetscInt SmallTrialSolves(const Compliance *c)
{
  const FactorCost *cost = &c->inverse.cost;

  if (cost->entries <= 0) return GMRES_MOST; /* not known */
  return (PetscInt)PetscMin(GMRES_MOST,
                            PetscMax(GMRES_LEAST, GMRES_LU * cost->flops / (GMRES_SLOW * GMRES_FLOPS * cost->entries)));
}

static PetscBool GMRESSuffices(const GMRESRun *run)
{
  return run->converged || run->left <= GMRES_ENOUGH ? PETSC_TRUE : PETSC_FALSE;
}

/* With factors at these laws, without friction as long as these will do; for longer with those that are the last */
static PetscErrorCode SmallRunFactored(SmallShell *s, Mat A, FactorDistance d, Vec z, GMRESRun *run,
                                       PetscBool *singular)
{
  const StatusFactor status = s->system->compliance->status;
  PetscBool          whole  = d.same && !d.whole ? PETSC_TRUE : PETSC_FALSE;

  PetscFunctionBeginUser;
  if (!d.same || whole) PetscCall(StatusFactorSet(status, s->system, whole, singular));
  for (PetscBool more = PETSC_TRUE; more && !*singular;) {
    PetscCall(StatusFactorCompare(status, s->system, &d));
    if (d.whole) run->steps *= 2;
    PetscCall(SmallRunGMRES(s, A, z, run));
    more = !d.whole && !GMRESSuffices(run) ? PETSC_TRUE : PETSC_FALSE;
    if (more) PetscCall(StatusFactorSet(status, s->system, PETSC_TRUE, singular));
  }
  PetscFunctionReturn(0);
}

/* With the factors that stand, where no more rows have another law than GMRES may take steps; without, unless that
   has taken more solves than a factorisation costs before; else with new ones, or for longer with those that stand
   where they are of these very laws. */
static PetscErrorCode SmallTryGMRES(SmallShell *s, Mat A, Vec z, SmallOutcome *outcome)
{
  const Compliance *c        = s->system->compliance;
  const PetscInt    trials   = SmallTrialSolves(c);
  GMRESRun          run      = {.steps = trials, .left = 1};
  PetscBool         singular = PETSC_FALSE;
  FactorDistance    d;

  PetscFunctionBeginUser;
  PetscCall(StatusFactorCompare(c->status, s->system, &d));
  if (d.stands && d.n_other <= trials) {
    PetscCall(SmallRunGMRES(s, A, z, &run));
  } else if (!d.stands && !*s->system->far) {
    PetscCall(SmallRunGMRES(s, A, z, &run));
    *s->system->far = (PetscBool)!run.converged;
  }
  if (!GMRESSuffices(&run)) PetscCall(SmallRunFactored(s, A, d, z, &run, &singular));
  *outcome = singular ? SMALL_SINGULAR : GMRESSuffices(&run) ? SMALL_GOOD : SMALL_UNSOLVED;
  PetscFunctionReturn(0);
}

/* z from a guess of it */
static PetscErrorCode SmallRun(const SmallSystem *system, PetscReal z[], SmallOutcome *outcome)
{
  const Compliance *c = system->compliance;
  const PetscInt    n = c->rows->n;
  SmallShell        s = {.system = system};
  Mat               A;
  Vec               x;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc3(n, &s.l, n, &s.w, n, &s.y));
  PetscCall(VecDuplicate(c->row, &x));
  PetscCall(MatCreateShell(c->rows->comm, n, n, PETSC_DETERMINE, PETSC_DETERMINE, &s, &A));
  PetscCall(MatShellSetOperation(A, MATOP_MULT, (void (*)(void))SmallShellMult));
  PetscCall(VecPlaceArray(x, z));
  PetscCall(SmallTryGMRES(&s, A, x, outcome));
  PetscCall(VecResetArray(x));
  PetscCall(MatDestroy(&A));
  PetscCall(VecDestroy(&x));
  PetscCall(PetscFree3(s.l, s.w, s.y));
  PetscFunctionReturn(0);
}

/* z += dz, the second step */
static PetscErrorCode SmallRefine(const SmallSystem *system, PetscReal z[], SmallOutcome *outcome)
{
  const Compliance *c    = system->compliance;
  const PetscInt    n    = c->rows->n;
  SmallSystem       left = *system;
  PetscReal        *l, *w, *e, *dz;
  LawRow           *law;
  Vec               r;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc5(n, &l, n, &w, n, &e, n, &dz, n, &law));
  PetscCall(VecDuplicate(c->u, &r));
  SmallApplyLaws(c->rows, system->law, PETSC_TRUE, z, l, w);
  for (PetscInt i = 0; i < n && system->added; i++) w[i] += system->e[i];
  PetscCall(ComplianceSolve(c, system->friction, system->f, l, w, c->u));
  PetscCall(ComplianceResidual(c, system->friction, system->f, l, c->u, r));
  PetscCall(ComplianceGetRows(c, c->u, e));
  for (PetscInt i = 0; i < n; i++) {
    e[i]      = w[i] - e[i];
    dz[i]     = 0;
    law[i]    = system->law[i];
    law[i].p0 = law[i].q0 = 0;
  }
  left.law   = law;
  left.added = PETSC_TRUE;
  left.rtol  = GMRES_SECOND;
  left.f     = r;
  left.e     = e;
  PetscCall(SmallRun(&left, dz, outcome));
  for (PetscInt i = 0; i < n && *outcome == SMALL_GOOD; i++) z[i] += dz[i];
  PetscCall(VecDestroy(&r));
  PetscCall(PetscFree5(l, w, e, dz, law));
  PetscFunctionReturn(0);
}

PetscErrorCode SmallSolveSparse(const SmallSystem *system, PetscReal z[], SmallOutcome *outcome)
{
  PetscFunctionBeginUser;
  PetscCall(SmallRun(system, z, outcome));
  if (*outcome != SMALL_GOOD || system->rtol >= GMRES_FIRST || !StatusFactorServes(system->compliance->status))
    PetscFunctionReturn(0);
  PetscCall(SmallRefine(system, z, outcome));
  PetscFunctionReturn(0);
}
