/*
   Equilibrium of given forces: the contact problem, then displacements of all unknowns, then one step of iterative
   refinement of both. With residuals of what was found,

      r = f - K u - G'l + S' D l,   e = w - G u,

   corrections obey the same small system with rhs = G K_a^-1 (r + kappa G'e) - e at the same status. Several load steps
   matter for Coulomb's law only, where slip counts from the step before.
*/
#include "staticsimpl.h"

#define EQUILIBRIUM_REFINE 2

/* Pairs closed now, over all ranks */
static PetscErrorCode EquilibriumCountClosed(const Active *a, PetscInt *n)
{
  PetscFunctionBeginUser;
  *n = 0;
  for (PetscInt p = 0; p < a->rows->n_pairs; p++) *n += a->status[p] != CONTACT_OPEN;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, n, 1, MPIU_INT, MPI_SUM, a->rows->comm));
  PetscFunctionReturn(0);
}

/* Raises the error for what has no equilibrium, even without friction */
static PetscErrorCode ComplainFrictionless(const Active *a, ActiveOutcome outcome)
{
  PetscFunctionBeginUser;
  PetscCheck(outcome != ACTIVE_SLOW, a->rows->comm, PETSC_ERR_NOT_CONVERGED,
             "no equilibrium found%s: the pairs do not settle within -static_max_it %" PetscInt_FMT
             " iterations; allow more",
             a->place, a->max_it);
  PetscCheck(!PairRowsCoulomb(a->rows), a->rows->comm, PETSC_ERR_NOT_CONVERGED,
             "no equilibrium%s: the -loads push the bodies along or off each other by more than friction holds, and "
             "nothing else does; give other -loads, a higher friction coefficient, -supports or -springs",
             a->place);
  SETERRQ(a->rows->comm, PETSC_ERR_NOT_CONVERGED,
          "no equilibrium%s, even without friction: the bodies come off each other or tip over, and nothing else holds "
          "them; the -loads must press the contacts together, within their edges",
          a->place);
}

/* Raises the error for loads along a motion that friction alone resists: it has been tried, and does not hold them */
static PetscErrorCode SlidingOffCheck(const Active *a)
{
  Hold free = {.n = 0};
  Mat  K, A;

  PetscFunctionBeginUser;
  PetscCall(OperatorsGetBodies(a->operators, a->p, &K, NULL, NULL));
  PetscCall(ComplianceAugment(K, a->rows, a->compliance->kappa, AUGMENT_NORMAL, NULL, &A));
  PetscCall(FreeMotionsCreate(a->operators, a->p, A, &free));
  PetscCall(HoldCheck(a->operators, &free, "loads, by more than friction is found to hold,", a->f, a->size));
  PetscCall(HoldDestroy(&free));
  PetscCall(MatDestroy(&A));
  PetscFunctionReturn(0);
}

/* Raises the error for what has no equilibrium */
static PetscErrorCode EquilibriumComplain(const Active *a, ActiveOutcome outcome)
{
  static const char *const how[] = {[ACTIVE_CONVERGED] = "",
                                    [ACTIVE_SINGULAR]  = "the bodies come off each other, and nothing else holds them",
                                    [ACTIVE_CYCLES]    = "the pairs do not settle between open and closed",
                                    [ACTIVE_SLOW]      = "the pairs do not settle within -static_max_it iterations",
                                    [ACTIVE_JAMMED]    = "the bodies jam"};
  PetscInt                 n;

  PetscFunctionBeginUser;
  PetscCall(EquilibriumCountClosed(a, &n));
  if (a->friction == 0) PetscCall(ComplainFrictionless(a, outcome));
  SETERRQ(a->rows->comm, PETSC_ERR_NOT_CONVERGED,
          "no sliding equilibrium%s: friction could be raised to %.4g of its value, where %" PetscInt_FMT
          " of %" PetscInt_FMT " pairs are closed; beyond, %s; lower the friction coefficient",
          a->place, (double)a->friction, n, a->rows->n_pairs_all, how[outcome]);
}

/* r = f - K u - G'l + S' D l, forces l in m; NULL stands for u = 0 */
static PetscErrorCode EquilibriumResidual(const Active *a, Vec u, Vec r)
{
  PetscFunctionBeginUser;
  if (u)
    PetscCall(OperatorsApplyBodies(a->operators, a->p, u, r));
  else
    PetscCall(VecSet(r, 0));
  PetscCall(VecAYPX(r, -1, a->f));
  PetscCall(ComplianceAddForces(a->compliance, 1, a->l, NULL, r));
  PetscFunctionReturn(0);
}

/* K_a^-1 (r + kappa G'e) of the residuals, into the work vector of the compliance, and e [rows] */
static PetscErrorCode EquilibriumMissing(const Active *a, PetscReal e[])
{
  Vec r;

  PetscFunctionBeginUser;
  PetscCall(VecDuplicate(a->u, &r));
  PetscCall(EquilibriumResidual(a, a->u, r));
  PetscCall(ComplianceGetRows(a->compliance, a->u, e));
  for (PetscInt i = 0; i < a->rows->n; i++) e[i] = a->w[i] - e[i];
  PetscCall(ComplianceSolve(a->compliance, 0, r, NULL, e, a->compliance->u));
  PetscCall(VecDestroy(&r));
  PetscFunctionReturn(0);
}

/* Displacements, and refinements of them and of the pairs */
static PetscErrorCode EquilibriumRefine(Active *a)
{
  PetscReal *e, *rhs;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(a->rows->n, &e, a->rows->n, &rhs));
  for (int i = 0; i < EQUILIBRIUM_REFINE; i++) {
    PetscCall(ComplianceSolve(a->compliance, 1, a->f, a->l, a->w, a->u));
    PetscCall(EquilibriumMissing(a, e));
    PetscCall(ComplianceGetRows(a->compliance, a->compliance->u, rhs));
    for (PetscInt k = 0; k < a->rows->n; k++) rhs[k] -= e[k];
    PetscCall(ActiveCorrect(a, rhs));
  }
  PetscCall(ComplianceSolve(a->compliance, 1, a->f, a->l, a->w, a->u));
  PetscCall(HoldProject(&a->compliance->hold, a->u));
  PetscCall(EquilibriumMissing(a, e));
  PetscCall(VecAXPY(a->u, 1, a->compliance->u));
  PetscCall(PetscFree2(e, rhs));
  PetscFunctionReturn(0);
}

/* Forces must not push along a free motion, friction included */
static PetscErrorCode FrictionCheck(const Active *a)
{
  Vec pushed;

  PetscFunctionBeginUser;
  if (!a->compliance->hold.n) PetscFunctionReturn(0);
  PetscCall(VecDuplicate(a->f, &pushed));
  PetscCall(EquilibriumResidual(a, NULL, pushed));
  PetscCall(HoldCheck(a->operators, &a->compliance->hold, "loads and friction", pushed, a->size));
  PetscCall(VecDestroy(&pushed));
  PetscFunctionReturn(0);
}

/* The closed pairs must hold what all pairs could */
static PetscErrorCode TippingCheck(const Active *a)
{
  PetscInt n;
  Mat      K, A;

  PetscFunctionBeginUser;
  PetscCall(EquilibriumCountClosed(a, &n));
  if (n == a->rows->n_all) PetscFunctionReturn(0);
  PetscCall(OperatorsGetBodies(a->operators, a->p, &K, NULL, NULL));
  PetscCall(ComplianceAugment(K, a->rows, a->compliance->kappa, AUGMENT_CLOSED, a->status, &A));
  PetscCall(HoldCheckClosed(a->operators, a->p, &a->compliance->hold, a->place, A, n));
  PetscCall(MatDestroy(&A));
  PetscFunctionReturn(0);
}

/* One load step, from which u, l and w follow */
static PetscErrorCode EquilibriumStep(Active *a)
{
  ActiveOutcome outcome;

  PetscFunctionBeginUser;
  PetscCall(ComplianceSolve(a->compliance, 0, a->f, NULL, NULL, a->u));
  PetscCall(ComplianceGetRows(a->compliance, a->u, a->free));
  PetscCall(ActiveSolve(a, &outcome));
  if (outcome == ACTIVE_CONVERGED) PetscFunctionReturn(0);
  if (outcome == ACTIVE_SLOW && a->friction == 0 && PairRowsCoulomb(a->rows)) PetscCall(SlidingOffCheck(a));
  PetscCall(EquilibriumComplain(a, outcome));
  PetscFunctionReturn(0);
}

PetscErrorCode EquilibriumSolve(Statics s, Active *a)
{
  PairRows *rows  = a->rows;
  const Vec whole = a->f;

  PetscFunctionBeginUser;
  a->operators = s->operators;
  a->p         = s->p;
  a->max_it    = s->max_it;
  PetscCall(StaticsPlace(s, a->place, sizeof(a->place)));
  PetscCall(PetscCalloc2(rows->n, &a->free, rows->n, &a->w));
  PetscCall(VecDuplicate(whole, &a->f));
  for (PetscInt p = 0; p < rows->n_pairs; p++) rows->law[p].slip0[0] = rows->law[p].slip0[1] = 0;
  for (PetscInt step = 1; step <= a->load_steps; step++) {
    for (PetscInt p = 0; p < rows->n_pairs && step > 1; p++)
      for (PetscInt i = 1; i < rows->law[p].d; i++) rows->law[p].slip0[i - 1] = a->w[rows->first[p] + i];
    PetscCall(VecCopy(whole, a->f));
    PetscCall(VecScale(a->f, (PetscReal)step / (PetscReal)a->load_steps));
    PetscCall(EquilibriumStep(a));
  }
  s->n_it = a->n_it;
  PetscCall(TippingCheck(a));
  PetscCall(EquilibriumRefine(a));
  PetscCall(FrictionCheck(a));
  PetscCall(VecDestroy(&a->f));
  a->f = whole;
  PetscCall(PetscFree2(a->free, a->w));
  PetscFunctionReturn(0);
}
