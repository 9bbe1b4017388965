/*
   Equilibrium of given forces: the contact problem, then displacements of all unknowns, then one step of iterative
   refinement of both. With residuals of what was found,

      r = f - K u - G'l + S' D l,   e = w - G u,

   corrections obey the same small system with rhs = G K_a^-1 (r + kappa G'e) - e at the same status. Several load steps
   matter for Coulomb's law only, where slip counts from the step before.
*/
#include "staticsimpl.h"

#define EQUILIBRIUM_REFINE 2

/* y = G x */
static PetscErrorCode EquilibriumRows(const Compliance *c, const PairRows *rows, Vec x, PetscReal y[])
{
  const PetscScalar *value;

  PetscFunctionBeginUser;
  PetscCall(MatMult(rows->G, x, c->row));
  PetscCall(VecGetArrayRead(c->row, &value));
  for (PetscInt i = 0; i < rows->n; i++) y[i] = PetscRealPart(value[i]);
  PetscCall(VecRestoreArrayRead(c->row, &value));
  PetscFunctionReturn(0);
}

/* Pairs closed now, over all ranks */
static PetscErrorCode EquilibriumCountClosed(const Active *a, PetscInt n[2])
{
  PetscFunctionBeginUser;
  n[0] = 0;
  n[1] = a->rows->n_pairs;
  for (PetscInt p = 0; p < a->rows->n_pairs; p++) n[0] += a->status[p] != CONTACT_OPEN;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, n, 2, MPIU_INT, MPI_SUM, a->rows->comm));
  PetscFunctionReturn(0);
}

/* Raises the error for what has no equilibrium, even without friction */
static PetscErrorCode ComplainFrictionless(const Active *a, ActiveOutcome outcome, const char place[],
                                           PetscBool coulomb)
{
  PetscFunctionBeginUser;
  PetscCheck(outcome != ACTIVE_SLOW, a->rows->comm, PETSC_ERR_NOT_CONVERGED,
             "no equilibrium found%s: the pairs do not settle within -static_max_it %" PetscInt_FMT
             " iterations; allow more",
             place, a->max_it);
  PetscCheck(!coulomb, a->rows->comm, PETSC_ERR_NOT_CONVERGED,
             "no equilibrium%s: the -loads push the bodies along or off each other by more than friction holds, and "
             "nothing else does; give other -loads, a higher friction coefficient, -supports or -springs",
             place);
  SETERRQ(a->rows->comm, PETSC_ERR_NOT_CONVERGED,
          "no equilibrium%s, even without friction: the bodies come off each other or tip over, and nothing else holds "
          "them; the -loads must press the contacts together, within their edges",
          place);
}

/* Raises the error for loads along a motion that friction alone resists: it has been tried, and does not hold them */
static PetscErrorCode SlidingOffCheck(const Active *a, Vec f, PetscReal size)
{
  const Compliance *c    = a->compliance;
  Hold              free = {.n = 0};
  Mat               K, A;

  PetscFunctionBeginUser;
  PetscCall(OperatorsGetBodies(a->operators, a->p, &K, NULL, NULL));
  PetscCall(ComplianceAugment(K, a->rows, c->kappa, AUGMENT_NORMAL, NULL, &A));
  PetscCall(FreeMotionsCreate(a->operators, a->p, A, &free));
  PetscCall(HoldCheck(a->operators, &free, "loads, by more than friction is found to hold,", f, size));
  PetscCall(HoldDestroy(&free));
  PetscCall(MatDestroy(&A));
  PetscFunctionReturn(0);
}

/* Raises the error for what has no equilibrium */
static PetscErrorCode EquilibriumComplain(const Active *a, const char place[], ActiveOutcome outcome)
{
  static const char *const how[] = {[ACTIVE_CONVERGED] = "",
                                    [ACTIVE_SINGULAR]  = "the bodies come off each other, and nothing else holds them",
                                    [ACTIVE_CYCLES]    = "the pairs do not settle between open and closed",
                                    [ACTIVE_SLOW]      = "the pairs do not settle within -static_max_it iterations",
                                    [ACTIVE_JAMMED]    = "the bodies jam"};
  PetscInt                 n[2];

  PetscFunctionBeginUser;
  PetscCall(EquilibriumCountClosed(a, n));
  if (a->friction == 0)
    PetscCall(ComplainFrictionless(a, outcome, place, a->rows->n_all == n[1] ? PETSC_FALSE : PETSC_TRUE));
  SETERRQ(a->rows->comm, PETSC_ERR_NOT_CONVERGED,
          "no sliding equilibrium%s: friction could be raised to %.4g of its value, where %" PetscInt_FMT
          " of %" PetscInt_FMT " pairs are closed; beyond, %s; lower the friction coefficient",
          place, (double)a->friction, n[0], n[1], how[outcome]);
}

/* r = f - K u - G'l + S' D l, forces l in m; NULL stands for u = 0 */
static PetscErrorCode EquilibriumResidual(const Active *a, Vec f, Vec u, Vec r)
{
  const Compliance *c    = a->compliance;
  const PairRows   *rows = a->rows;
  PetscScalar      *value;

  PetscFunctionBeginUser;
  if (u)
    PetscCall(OperatorsApplyBodies(a->operators, a->p, u, r));
  else
    PetscCall(VecSet(r, 0));
  PetscCall(VecAYPX(r, -1, f));
  PetscCall(VecGetArray(c->row, &value));
  for (PetscInt i = 0; i < rows->n; i++) value[i] = -c->kappa * a->l[i];
  PetscCall(VecRestoreArray(c->row, &value));
  PetscCall(MatMultTransposeAdd(rows->G, c->row, r, r));
  if (!rows->S) PetscFunctionReturn(0);
  PetscCall(VecSet(c->row, 0));
  PetscCall(VecGetArray(c->row, &value));
  for (PetscInt p = 0; p < rows->n_pairs; p++) value[rows->first[p]] = c->kappa * rows->slide[p] * a->l[rows->first[p]];
  PetscCall(VecRestoreArray(c->row, &value));
  PetscCall(MatMultTransposeAdd(rows->S, c->row, r, r));
  PetscFunctionReturn(0);
}

/* K_a^-1 (r + kappa G'e) of the residuals at u, into the work vector of the compliance, and e [rows] */
static PetscErrorCode EquilibriumMissing(const Active *a, Vec f, Vec u, PetscReal e[])
{
  Vec r;

  PetscFunctionBeginUser;
  PetscCall(VecDuplicate(u, &r));
  PetscCall(EquilibriumResidual(a, f, u, r));
  PetscCall(EquilibriumRows(a->compliance, a->rows, u, e));
  for (PetscInt i = 0; i < a->rows->n; i++) e[i] = a->w[i] - e[i];
  PetscCall(ComplianceSolve(a->compliance, 0, r, a->zero, e, a->compliance->u));
  PetscCall(VecDestroy(&r));
  PetscFunctionReturn(0);
}

/* Displacements, and refinements of them and of the pairs */
static PetscErrorCode EquilibriumRefine(Active *a, Vec f, Vec u)
{
  const PairRows *rows = a->rows;
  PetscReal      *e, *rhs;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(rows->n, &e, rows->n, &rhs));
  for (int i = 0; i < EQUILIBRIUM_REFINE; i++) {
    PetscCall(ComplianceSolve(a->compliance, 1, f, a->l, a->w, u));
    PetscCall(EquilibriumMissing(a, f, u, e));
    PetscCall(EquilibriumRows(a->compliance, rows, a->compliance->u, rhs));
    for (PetscInt k = 0; k < rows->n; k++) rhs[k] -= e[k];
    PetscCall(ActiveCorrect(a, rhs));
  }
  PetscCall(ComplianceSolve(a->compliance, 1, f, a->l, a->w, u));
  PetscCall(HoldProject(&a->compliance->hold, u));
  PetscCall(EquilibriumMissing(a, f, u, e));
  PetscCall(VecAXPY(u, 1, a->compliance->u));
  PetscCall(PetscFree2(e, rhs));
  PetscFunctionReturn(0);
}

/* Forces must not push along a free motion, friction included */
static PetscErrorCode FrictionCheck(const Active *a, Vec f, PetscReal size)
{
  Vec pushed;

  PetscFunctionBeginUser;
  if (!a->compliance->hold.n) PetscFunctionReturn(0);
  PetscCall(VecDuplicate(f, &pushed));
  PetscCall(EquilibriumResidual(a, f, NULL, pushed));
  PetscCall(HoldCheck(a->operators, &a->compliance->hold, "loads and friction", pushed, size));
  PetscCall(VecDestroy(&pushed));
  PetscFunctionReturn(0);
}

/* The closed pairs must hold what all pairs could */
static PetscErrorCode TippingCheck(const Active *a, const char place[])
{
  PetscInt n[2];
  Mat      K, A;

  PetscFunctionBeginUser;
  PetscCall(EquilibriumCountClosed(a, n));
  if (n[0] == n[1] && a->rows->n_all == n[1]) PetscFunctionReturn(0);
  PetscCall(OperatorsGetBodies(a->operators, a->p, &K, NULL, NULL));
  PetscCall(ComplianceAugment(K, a->rows, a->compliance->kappa, AUGMENT_CLOSED, a->status, &A));
  PetscCall(HoldCheckClosed(a->operators, a->p, &a->compliance->hold, place, A, n[0]));
  PetscCall(MatDestroy(&A));
  PetscFunctionReturn(0);
}

/* One load step: f, from which u, l and w follow */
static PetscErrorCode EquilibriumStep(Active *a, const char place[], Vec f, PetscReal size, Vec u)
{
  ActiveOutcome outcome;
  PetscInt      n[2];

  PetscFunctionBeginUser;
  PetscCall(ComplianceSolve(a->compliance, 0, f, a->zero, a->zero, u));
  PetscCall(EquilibriumRows(a->compliance, a->rows, u, a->free));
  PetscCall(ActiveSolve(a, &outcome));
  if (outcome == ACTIVE_CONVERGED) PetscFunctionReturn(0);
  PetscCall(EquilibriumCountClosed(a, n));
  if (outcome == ACTIVE_SLOW && a->friction == 0 && a->rows->n_all != n[1]) PetscCall(SlidingOffCheck(a, f, size));
  PetscCall(EquilibriumComplain(a, place, outcome));
  PetscFunctionReturn(0);
}

PetscErrorCode EquilibriumSolve(Statics s, const EquilibriumProblem *e)
{
  PairRows *rows = e->rows;
  Active    a    = {.operators  = s->operators,
                    .p          = s->p,
                    .rows       = rows,
                    .compliance = e->compliance,
                    .max_it     = s->max_it,
                    .status     = e->status,
                    .l          = e->l};
  char      place[256];
  Vec       part;

  PetscFunctionBeginUser;
  PetscCall(StaticsPlace(s, place, sizeof(place)));
  PetscCall(PetscCalloc3(rows->n, &a.free, rows->n, &a.w, rows->n, &a.zero));
  PetscCall(VecDuplicate(e->f, &part));
  for (PetscInt p = 0; p < rows->n_pairs; p++) rows->law[p].slip0[0] = rows->law[p].slip0[1] = 0;
  for (PetscInt step = 1; step <= e->load_steps; step++) {
    for (PetscInt p = 0; p < rows->n_pairs && step > 1; p++)
      for (PetscInt i = 1; i < rows->law[p].d; i++) rows->law[p].slip0[i - 1] = a.w[rows->first[p] + i];
    PetscCall(VecCopy(e->f, part));
    PetscCall(VecScale(part, (PetscReal)step / (PetscReal)e->load_steps));
    PetscCall(EquilibriumStep(&a, place, part, e->size, e->u));
  }
  s->n_it = a.n_it;
  PetscCall(TippingCheck(&a, place));
  PetscCall(EquilibriumRefine(&a, e->f, e->u));
  PetscCall(FrictionCheck(&a, e->f, e->size));
  PetscCall(VecDestroy(&part));
  PetscCall(PetscFree3(a.free, a.w, a.zero));
  PetscFunctionReturn(0);
}
