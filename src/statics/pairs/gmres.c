/*
   The small system where it is too large to be dense, by GMRES. Each application of W and V is one pair of triangular
   solves with K_a. While nearly all pairs press that suffices; where it takes more solves than a factorisation costs,
   the bodies are factored with the pairs at their present status (refactor.c), and these factors are the
   preconditioner, here and in the systems that follow, until more pairs have changed than GMRES may take steps.
*/
#include "statics/pairs/small.h"

#define GMRES_ENOUGH  1e-10 /* of GMRES that gets no farther; refinement of the whole does the rest */
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
  PetscReal         *l, *w;
} SmallShell;

/* y = [Q + (W - V D) P - W Q] z */
static PetscErrorCode SmallShellMult(Mat A, Vec z, Vec y)
{
  const PetscScalar *from;
  PetscScalar       *to;
  SmallShell        *s;

  PetscFunctionBeginUser;
  PetscCall(MatShellGetContext(A, &s));
  PetscCall(VecGetArrayRead(z, &from));
  SmallApplyLaws(s->system->compliance->rows, s->system->law, PETSC_FALSE, from, s->l, s->w);
  PetscCall(VecRestoreArrayRead(z, &from));
  PetscCall(VecGetArray(y, &to));
  PetscCall(ComplianceApply(s->system->compliance, s->system->friction, s->l, s->w, to));
  PetscCall(VecRestoreArray(y, &to));
  PetscFunctionReturn(0);
}

static PetscErrorCode SmallPrecondition(PC pc, Vec r, Vec z)
{
  StatusFactor factor;

  PetscFunctionBeginUser;
  PetscCall(PCShellGetContext(pc, &factor));
  PetscCall(StatusFactorApply(factor, r, z));
  PetscFunctionReturn(0);
}

/* How GMRES is to run, with factors at a status or NULL; how it ended, what is left of |b| */
typedef struct {
  StatusFactor factor;
  PetscInt     steps;
  PetscBool    converged;
  PetscReal    left;
} GMRESRun;

/* The solver of the system, with the factors at a status or NULL: residuals of rtol |b| are left, |b| = whole */
static PetscErrorCode SmallCreateGMRES(SmallShell *s, Mat A, const GMRESRun *run, PetscReal whole, KSP *ksp)
{
  PC pc;

  PetscFunctionBeginUser;
  PetscCall(KSPCreate(s->system->compliance->rows->comm, ksp));
  PetscCall(KSPSetOptionsPrefix(*ksp, "st_pairs_"));
  PetscCall(KSPSetOperators(*ksp, A, A));
  PetscCall(KSPSetType(*ksp, KSPGMRES));
  PetscCall(KSPSetPCSide(*ksp, PC_RIGHT));
  PetscCall(KSPGMRESSetRestart(*ksp, GMRES_RESTART));
  PetscCall(KSPGMRESSetCGSRefinementType(*ksp, KSP_GMRES_CGS_REFINE_IFNEEDED));
  PetscCall(KSPSetTolerances(*ksp, PETSC_SMALL * PETSC_SMALL, s->system->rtol * whole, PETSC_DEFAULT, run->steps));
  PetscCall(KSPGetPC(*ksp, &pc));
  PetscCall(PCSetType(pc, run->factor ? PCSHELL : PCNONE));
  if (run->factor) {
    PetscCall(PCShellSetContext(pc, run->factor));
    PetscCall(PCShellSetApply(pc, SmallPrecondition));
  }
  PetscCall(KSPSetFromOptions(*ksp));
  PetscFunctionReturn(0);
}

/* z = z + A^-1 (b - A z), in run->steps at most; from 0 where the guess z leaves more than that does */
static PetscErrorCode SmallRunGMRES(SmallShell *s, Mat A, Vec b, Vec z, GMRESRun *run)
{
  KSPConvergedReason reason;
  PetscReal          whole;
  KSP                ksp;
  Vec                r, dz;

  PetscFunctionBeginUser;
  PetscCall(VecNorm(b, NORM_2, &whole));
  PetscCall(SmallCreateGMRES(s, A, run, whole, &ksp));
  PetscCall(VecDuplicate(b, &r));
  PetscCall(VecDuplicate(b, &dz));
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

/* With the factors that stand, where no more rows have another law than GMRES may take steps; without, unless that
   has taken more solves than a factorisation costs before; else with new ones, or for longer with those that stand
   where they are of these very laws. A step with factors takes two solves. */
static PetscErrorCode SmallTryGMRES(SmallShell *s, Mat A, Vec b, Vec z, SmallOutcome *outcome)
{
  const Compliance *c        = s->system->compliance;
  const PetscInt    trials   = SmallTrialSolves(c);
  GMRESRun          run      = {.steps = trials, .left = 1};
  PetscBool         singular = PETSC_FALSE;
  FactorDistance    d;

  PetscFunctionBeginUser;
  PetscCall(StatusFactorCompare(c->status, s->system, &d));
  if (d.stands && d.n_other <= (s->system->last ? 0 : trials / 2)) {
    run.factor = c->status;
    run.steps  = trials / 2;
    PetscCall(SmallRunGMRES(s, A, b, z, &run));
  } else if (!s->system->last && !*s->system->far) {
    PetscCall(SmallRunGMRES(s, A, b, z, &run));
    *s->system->far = (PetscBool)!run.converged;
  }
  if (!GMRESSuffices(&run)) {
    if (!d.same) PetscCall(StatusFactorSet(c->status, s->system, &singular));
    run.factor = c->status;
    run.steps  = trials;
    if (!singular) PetscCall(SmallRunGMRES(s, A, b, z, &run));
  }
  *outcome = singular ? SMALL_SINGULAR : GMRESSuffices(&run) ? SMALL_GOOD : SMALL_UNSOLVED;
  PetscFunctionReturn(0);
}

/* b = rhs - what the constants of the laws give */
static PetscErrorCode SmallShellConstants(SmallShell *s, Vec b)
{
  const SmallSystem *system = s->system;
  const PetscInt     n      = system->compliance->rows->n;
  PetscScalar       *value;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < n; i++) {
    s->l[i] = system->law[i].p0;
    s->w[i] = system->law[i].q0;
  }
  PetscCall(VecGetArray(b, &value));
  PetscCall(ComplianceApply(system->compliance, system->friction, s->l, s->w, value));
  for (PetscInt i = 0; i < n; i++) value[i] = system->rhs[i] - value[i];
  PetscCall(VecRestoreArray(b, &value));
  PetscFunctionReturn(0);
}

PetscErrorCode SmallSolveSparse(const SmallSystem *system, PetscReal z[], SmallOutcome *outcome)
{
  const Compliance *c = system->compliance;
  const PetscInt    n = c->rows->n;
  SmallShell        s = {.system = system};
  Mat               A;
  Vec               b, x;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(n, &s.l, n, &s.w));
  PetscCall(VecDuplicate(c->row, &b));
  PetscCall(VecDuplicate(c->row, &x));
  PetscCall(SmallShellConstants(&s, b));
  PetscCall(MatCreateShell(c->rows->comm, n, n, PETSC_DETERMINE, PETSC_DETERMINE, &s, &A));
  PetscCall(MatShellSetOperation(A, MATOP_MULT, (void (*)(void))SmallShellMult));
  PetscCall(VecPlaceArray(x, z));
  PetscCall(SmallTryGMRES(&s, A, b, x, outcome));
  PetscCall(VecResetArray(x));
  PetscCall(MatDestroy(&A));
  PetscCall(VecDestroy(&b));
  PetscCall(VecDestroy(&x));
  PetscCall(PetscFree2(s.l, s.w));
  PetscFunctionReturn(0);
}
