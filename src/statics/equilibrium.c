/*
   Equilibrium of given forces: the contact problem, then displacements of all unknowns, then EQUILIBRIUM_REFINE steps
   of iterative refinement of both and one more of the displacements. With residuals of what was found,

      r = f - K u - G'l + S' D l  (N),   e = w - G u  (m),

   corrections obey the same small system of f = r and with e in its rows (small.c) at the same status. Several load
   steps matter for Coulomb's law only, where slip counts from the step before.
*/
#include "staticsimpl.h"
#include "base/text.h"

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

/* What the iteration ended with, and what may help */
static PetscErrorCode OutcomePrint(const Active *a, ActiveOutcome outcome, size_t size, char text[])
{
  static const char *const how[] = {
    [ACTIVE_CONVERGED] = "",
    [ACTIVE_SINGULAR]  = "the closed pairs leave a motion that nothing resists; give -supports or -springs",
    [ACTIVE_REPEATS]   = "the statuses of the pairs go round in a circle; change the -loads a little, or "
                         "-static_load_steps where pairs can stick",
    [ACTIVE_SLOW]      = "the pairs do not settle within -static_max_it %" PetscInt_FMT " iterations; allow more",
    [ACTIVE_JAMMED]    = "the bodies jam: friction presses them together by more than they yield",
    [ACTIVE_UNSOLVED]  = "GMRES on the rows of the pairs did not converge; allow more by -st_pairs_ksp_max_it",
    [ACTIVE_UNSETTLED] =
      "the pressures and closings or the friction coefficients of the pairs do not settle; give -static_load_steps"};
  char dense[96] = "";

  PetscFunctionBeginUser;
  if (!a->compliance->W && a->rows->n_all <= STATICS_MOST_DENSE && outcome != ACTIVE_JAMMED)
    PetscCall(
      PetscSNPrintf(dense, sizeof(dense), ", or raise -static_dense to %" PetscInt_FMT " rows", a->rows->n_all));
  PetscCall(PetscSNPrintf(text, size, how[outcome], a->max_it));
  PetscCall(WordsAdd(text, dense, size));
  PetscFunctionReturn(0);
}

/* Raises the error for what was not found: nothing proves that there is none. Where already pressing without friction
   failed, it is told whether that at least is proven to have no equilibrium. */
static PetscErrorCode EquilibriumComplain(const Active *a, ActiveOutcome outcome)
{
  Certificate without = {.proven = PETSC_FALSE};
  PetscInt    n;
  char        how[256];

  PetscFunctionBeginUser;
  PetscCall(EquilibriumCountClosed(a, &n));
  if (!a->pressed && PairRowsCoulomb(a->rows)) PetscCall(CertificateFind(a, 0, &without));
  PetscCall(VecDestroy(&without.motion));
  PetscCall(OutcomePrint(a, without.proven ? a->first : outcome, sizeof(how), how));
  PetscCheck(!without.proven, a->rows->comm, PETSC_ERR_NOT_CONVERGED,
             "no equilibrium found%s: friction alone can hold the bodies, and with it %s; or give a higher friction "
             "coefficient, -supports or -springs",
             a->place, how);
  PetscCheck(a->pressed, a->rows->comm, PETSC_ERR_NOT_CONVERGED, "no equilibrium found%s: %s", a->place, how);
  SETERRQ(a->rows->comm, PETSC_ERR_NOT_CONVERGED,
          "no %sequilibrium found%s: friction could be raised to %.4g of its value, where %" PetscInt_FMT
          " of %" PetscInt_FMT " pairs are closed; beyond, %s; %slower the friction coefficient",
          PairRowsCoulomb(a->rows) ? "" : "sliding ", a->place, (double)a->friction, n, a->rows->n_pairs_all, how,
          outcome == ACTIVE_JAMMED ? "" : "or ");
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

/* r (N) and e [rows] (m). What r has along free motions is taken out: the pins would answer it with reactions. */
static PetscErrorCode EquilibriumMissing(const Active *a, Vec r, PetscReal e[])
{
  PetscFunctionBeginUser;
  PetscCall(EquilibriumResidual(a, a->u, r));
  PetscCall(HoldRelieve(&a->compliance->hold, r));
  PetscCall(ComplianceGetRows(a->compliance, a->u, e));
  for (PetscInt i = 0; i < a->rows->n; i++) e[i] = a->w[i] - e[i];
  PetscFunctionReturn(0);
}

/* Displacements, and refinements of them and of the pairs */
static PetscErrorCode EquilibriumRefine(Active *a)
{
  PetscReal *e;
  Vec        r;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(a->rows->n, &e));
  PetscCall(VecDuplicate(a->u, &r));
  for (int i = 0; i < EQUILIBRIUM_REFINE; i++) {
    PetscCall(ComplianceSolve(a->compliance, 1, a->f, a->l, a->w, a->u));
    PetscCall(EquilibriumMissing(a, r, e));
    PetscCall(ActiveCorrect(a, r, e));
  }
  PetscCall(ComplianceSolve(a->compliance, 1, a->f, a->l, a->w, a->u));
  PetscCall(HoldProject(&a->compliance->hold, a->u));
  PetscCall(EquilibriumMissing(a, r, e));
  PetscCall(ComplianceSolve(a->compliance, 0, r, NULL, e, a->compliance->u));
  PetscCall(VecAXPY(a->u, 1, a->compliance->u));
  PetscCall(VecDestroy(&r));
  PetscCall(PetscFree(e));
  PetscFunctionReturn(0);
}

/* Forces must not push along a free motion, friction included. Where they do, whether the active set found an end hangs
   on rounding: the proof says the same as where it found none */
static PetscErrorCode FrictionCheck(const Active *a)
{
  PetscBool moves;
  Vec       pushed;

  PetscFunctionBeginUser;
  if (!a->compliance->hold.n) PetscFunctionReturn(0);
  PetscCall(VecDuplicate(a->f, &pushed));
  PetscCall(EquilibriumResidual(a, NULL, pushed));
  PetscCall(HoldIsPushed(&a->compliance->hold, pushed, a->size, &moves));
  if (moves) PetscCall(CertificateCheck(a));
  PetscCall(HoldCheck(a->operators, &a->compliance->hold, "loads and friction", pushed, a->size));
  PetscCall(VecDestroy(&pushed));
  PetscFunctionReturn(0);
}

/* The closed pairs must hold what all pairs could */
static PetscErrorCode TippingCheck(const Active *a)
{
  const char *part;
  PetscInt    n;
  Mat         K, A;

  PetscFunctionBeginUser;
  PetscCall(EquilibriumCountClosed(a, &n));
  if (n == a->rows->n_pairs_all) PetscFunctionReturn(0);
  PetscCall(OperatorsGetBodies(a->operators, a->p, &K, NULL, NULL));
  PetscCall(ComplianceAugment(K, a->rows, a->compliance->kappa, PETSC_TRUE, a->status, &A));
  PetscCall(HoldFindLoose(a->operators, a->p, &a->compliance->hold, A, &part));
  PetscCall(MatDestroy(&A));
  if (!part) PetscFunctionReturn(0);
  PetscCall(CertificateCheck(a));
  SETERRQ(a->rows->comm, PETSC_ERR_NOT_CONVERGED,
          "no stable equilibrium%s: only %" PetscInt_FMT
          " of the pairs stay closed, and part %s can tip or slide on them without resistance; lower the friction "
          "coefficient, move the -loads, or give -supports or -springs",
          a->place, n, part);
}

PetscErrorCode EquilibriumBegin(Statics s, Active *a)
{
  PetscFunctionBeginUser;
  a->operators = s->operators;
  a->p         = s->p;
  a->max_it    = s->max_it;
  PetscCall(StaticsPlace(s, a->place, sizeof(a->place)));
  PetscCall(PetscCalloc2(a->rows->n, &a->free, a->rows->n, &a->w));
  if (a->w0) PetscCall(PetscArraycpy(a->w, a->w0, a->rows->n));
  PetscFunctionReturn(0);
}

PetscErrorCode EquilibriumFree(Active *a)
{
  PetscFunctionBeginUser;
  if (!a->compliance->W) PetscFunctionReturn(0);
  PetscCall(ComplianceSolve(a->compliance, 0, a->f, NULL, NULL, a->u));
  PetscCall(ComplianceGetRows(a->compliance, a->u, a->free));
  PetscFunctionReturn(0);
}

PetscErrorCode EquilibriumFind(Active *a)
{
  ActiveOutcome outcome;

  PetscFunctionBeginUser;
  PetscCall(RubbingSolve(a, &outcome));
  if (outcome != ACTIVE_CONVERGED) PetscCall(EquilibriumComplain(a, outcome));
  PetscFunctionReturn(0);
}

PetscErrorCode EquilibriumEnd(Active *a)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree2(a->free, a->w));
  PetscFunctionReturn(0);
}

/* Loads and prescribed motions go to their end by equal parts; each step begins from the forces of the last. Only the
   end is refined. */
PetscErrorCode EquilibriumSolve(Statics s, Active *a)
{
  PairRows *rows  = a->rows;
  const Vec whole = a->f;

  PetscFunctionBeginUser;
  PetscCall(EquilibriumBegin(s, a));
  PetscCall(VecDuplicate(whole, &a->f));
  for (PetscInt step = 1; step <= a->load_steps; step++) {
    const PetscReal part = (PetscReal)step / (PetscReal)a->load_steps;

    PairRowsMove(rows, part, part - 1 / (PetscReal)a->load_steps, step > 1 || a->w0 ? a->w : NULL);
    PetscCall(VecCopy(whole, a->f));
    PetscCall(VecScale(a->f, part));
    if (a->f0) PetscCall(VecAXPY(a->f, 1 - part, a->f0));
    PetscCall(EquilibriumFree(a));
    PetscCall(EquilibriumFind(a));
  }
  s->n_it += a->n_it;
  s->n_factored += a->n_factored;
  PetscCall(TippingCheck(a));
  PetscCall(EquilibriumRefine(a));
  PetscCall(FrictionCheck(a));
  PetscCall(VecDestroy(&a->f));
  a->f = whole;
  PetscCall(EquilibriumEnd(a));
  PetscFunctionReturn(0);
}
