/*
   Primal-dual active set on the laws of the pairs, a semismooth Newton method: the status of every pair makes its law
   linear; one small system gives all forces and displacements; they decide the next status. Without Coulomb pairs it
   ends exactly when no status changes. What is smaller than ACTIVE_ROUNDING of the largest displacement decides nothing.

   Where the statuses repeat or the system becomes singular, those of sliding pairs are found by pivoting (pivot.c); with
   Coulomb pairs only the pair that errs most changes per iteration. If that does not settle either, all friction coefficients are raised from 0 in steps, each begun from the equilibrium
   before it, with half the step after a failure. Equilibrium without friction is a convex problem. An equilibrium whose
   system has a determinant of the wrong sign (small.c) is none that can be reached from there, hence a failure too.
*/
#include "staticsimpl.h"

#define ACTIVE_ROUNDING 1e-13
#define SLIPPING        1e-12 /* residual of Coulomb's law at convergence, relative */
#define EXACT           1e-13 /* of GMRES */
#define ROUGH           1e-6  /* of GMRES while statuses still change */
#define CORRECT         1e-8  /* of GMRES for corrections */
#define MIN_STEP        (1.0 / 1024)
#define MIN_DAMP        (1.0 / 128)
#define MAX_KEPT        64 /* statuses remembered, to see when they repeat */
#define ONE_BY_ONE      10 /* times max_it, when single pairs change */
#define FEW             1000 /* rows of a dense problem up to which that, and small steps of friction, are worth the time */
#define LARGE_STEP      (1.0 / 16)

/* Laws of all rows at the present status */
static void LawsSet(const Active *a, LawRow law[])
{
  const PairRows *rows = a->rows;

  for (PetscInt p = 0; p < rows->n_pairs; p++) {
    const PetscInt first = rows->first[p], d = rows->law[p].d;
    CoulombPair    pair = rows->law[p];
    CoulombLaw     one;

    pair.mu *= a->friction;
    CoulombLinearise(&pair, a->status[p], &a->l[first], &a->w[first], &one);
    for (PetscInt i = 0; i < d; i++) {
      LawRow *row = &law[first + i];

      row->first = rows->begin + first;
      row->d     = d;
      row->p0    = one.p0[i];
      row->q0    = one.q0[i];
      row->slide = i ? 0 : rows->slide[p];
      for (PetscInt k = 0; k < d; k++) {
        row->P[k] = one.P[i][k];
        row->Q[k] = one.Q[i][k];
      }
    }
  }
}

/* One small system at the present status, for l and w, or with homogeneous laws for what is added to them */
static PetscErrorCode Solve(Active *a, PetscBool homogeneous, const PetscReal rhs[], PetscReal l[], PetscReal w[],
                            SmallOutcome *outcome)
{
  LawRow *law;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(a->rows->n, &law));
  LawsSet(a, law);
  for (PetscInt i = 0; i < a->rows->n && homogeneous; i++) law[i].p0 = law[i].q0 = 0;
  PetscCall(SmallSolve(&(SmallSystem){a->compliance, a->friction, law, rhs, a->rtol}, l, w, outcome, &a->reversed));
  PetscCall(PetscFree(law));
  PetscFunctionReturn(0);
}

/* Largest contact displacement or force, m */
static PetscErrorCode ActiveFindScale(Active *a)
{
  PetscReal scale = 0;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < a->rows->n; i++)
    scale = PetscMax(scale, PetscMax(PetscAbsReal(a->l[i]), PetscAbsReal(a->w[i])));
  for (PetscInt p = 0; p < a->rows->n_pairs; p++) scale = PetscMax(scale, PetscAbsReal(a->rows->law[p].g0));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &scale, 1, MPIU_REAL, MPI_MAX, a->rows->comm));
  a->scale = scale;
  PetscFunctionReturn(0);
}

/* How wrong the status of pair p is, m; *next = what it should be */
static PetscReal Wrongness(const Active *a, PetscInt p, ContactStatus *next)
{
  const PetscInt   first = a->rows->first[p];
  const PetscReal *l = &a->l[first], *w = &a->w[first];
  CoulombPair      pair = a->rows->law[p];

  pair.mu *= a->friction;
  *next = CoulombDecide(&pair, a->status[p], l, w, ACTIVE_ROUNDING * a->scale);
  if (*next == a->status[p]) return 0;
  if (*next == CONTACT_OPEN || a->status[p] == CONTACT_OPEN) return PetscAbsReal(CoulombClosing(&pair, l, w));
  return CoulombResidual(&pair, l, w);
}

/* Changes all wrong statuses, or that of the most wrong pair only; n_changed over all ranks */
static PetscErrorCode StatusUpdate(Active *a, PetscBool single, PetscInt *n_changed)
{
  struct {
    double wrong;
    int    rank;
  } worst          = {0, 0};
  PetscInt      at = -1;
  ContactStatus next, best = CONTACT_OPEN;
  PetscMPIInt   rank;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(a->rows->comm, &rank));
  *n_changed = 0;
  for (PetscInt p = 0; p < a->rows->n_pairs; p++) {
    const PetscReal wrong = Wrongness(a, p, &next);

    if (next == a->status[p]) continue;
    (*n_changed)++;
    if (!single) a->status[p] = next;
    if (at >= 0 && wrong <= worst.wrong) continue;
    at          = p;
    best        = next;
    worst.wrong = wrong;
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, n_changed, 1, MPIU_INT, MPI_SUM, a->rows->comm));
  if (!single || !*n_changed) PetscFunctionReturn(0);
  worst.rank  = rank;
  worst.wrong = at < 0 ? -1 : worst.wrong;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &worst, 1, MPI_DOUBLE_INT, MPI_MAXLOC, a->rows->comm));
  if (worst.rank == rank) a->status[at] = best;
  PetscFunctionReturn(0);
}

/* Largest residual of Coulomb's law, relative: of slip to the largest force, which may be far below the displacements
   (soft springs), else to the largest of both */
static PetscErrorCode ActiveSlipResidual(const Active *a, PetscReal *residual)
{
  PetscReal largest[3] = {0, 0, 0}; /* of slip, of the others, and force */

  PetscFunctionBeginUser;
  for (PetscInt p = 0; p < a->rows->n_pairs; p++) {
    const PetscReal *l = &a->l[a->rows->first[p]], *w = &a->w[a->rows->first[p]];
    const int        kind = a->status[p] == CONTACT_SLIP ? 0 : 1;
    CoulombPair      pair = a->rows->law[p];

    pair.mu *= a->friction;
    largest[kind] = PetscMax(largest[kind], CoulombResidual(&pair, l, w));
    largest[2]    = PetscMax(largest[2], PetscAbsReal(l[0]));
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, largest, 3, MPIU_REAL, MPI_MAX, a->rows->comm));
  *residual = PetscMax(largest[0] > 0 ? largest[0] / largest[2] : 0, largest[1] > 0 ? largest[1] / a->scale : 0);
  PetscFunctionReturn(0);
}

/* Shortens a step from l0, w0 that keeps all statuses, yet does not lower the residual of Coulomb's law, `before`:
   Newton's method may turn slip around for ever. Equilibrium and normal laws are linear and hold all the way. */
static PetscErrorCode Damp(Active *a, const PetscReal l0[], const PetscReal w0[], PetscReal before)
{
  PetscReal residual;

  PetscFunctionBeginUser;
  for (PetscReal step = 1; step > MIN_DAMP; step /= 2) {
    PetscCall(ActiveSlipResidual(a, &residual));
    if (residual < before || before <= SLIPPING) break;
    for (PetscInt i = 0; i < a->rows->n; i++) {
      a->l[i] = (l0[i] + a->l[i]) / 2;
      a->w[i] = (w0[i] + a->w[i]) / 2;
    }
  }
  PetscFunctionReturn(0);
}

/* A number that differs for different statuses of all pairs */
static PetscErrorCode StatusPrint(const Active *a, PetscReal *print)
{
  const PetscReal golden = 0.61803398874989484820;

  PetscFunctionBeginUser;
  *print = 0;
  for (PetscInt p = 0; p < a->rows->n_pairs; p++) {
    const PetscReal at = golden * (PetscReal)(a->rows->begin + a->rows->first[p] + 1);

    *print += (1 + (PetscReal)a->status[p]) * (at - PetscFloorReal(at));
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, print, 1, MPIU_REAL, MPI_SUM, a->rows->comm));
  PetscFunctionReturn(0);
}

/* Whether the present status was there before; remembers it. With Coulomb pairs in slip, whose laws change with the
   iterate, a repeated status is no cycle. */
static PetscErrorCode StatusRepeats(const Active *a, PetscReal kept[MAX_KEPT], PetscInt *n_kept, PetscBool *repeats)
{
  PetscReal print;

  PetscFunctionBeginUser;
  *repeats = PETSC_FALSE;
  PetscCall(StatusPrint(a, &print));
  for (PetscInt i = 0; i < PetscMin(*n_kept, MAX_KEPT) && !PairRowsCoulomb(a->rows); i++)
    if (kept[i] == print) *repeats = PETSC_TRUE;
  kept[(*n_kept)++ % MAX_KEPT] = print;
  PetscFunctionReturn(0);
}

/* Iterates from the present status at the present friction */
static PetscErrorCode Iterate(Active *a, PetscBool single, ActiveOutcome *outcome)
{
  const PetscInt max_it = single ? ONE_BY_ONE * a->max_it : a->max_it;
  PetscReal      kept[MAX_KEPT], residual = 0, *l, *w;
  PetscInt       n_kept = 0, n_changed = 1;
  PetscBool      repeats;
  SmallOutcome   small;

  PetscFunctionBeginUser;
  *outcome = ACTIVE_SLOW;
  PetscCall(PetscMalloc2(a->rows->n, &l, a->rows->n, &w));
  a->rtol = single || PairRowsCoulomb(a->rows) ? EXACT : ROUGH;
  for (PetscInt it = 0; it < max_it && *outcome == ACTIVE_SLOW; it++, a->n_it++) {
    repeats = PETSC_FALSE;
    if (n_changed) PetscCall(StatusRepeats(a, kept, &n_kept, &repeats));
    PetscCall(PetscArraycpy(l, a->l, a->rows->n));
    PetscCall(PetscArraycpy(w, a->w, a->rows->n));
    PetscCall(Solve(a, PETSC_FALSE, a->free, a->l, a->w, &small));
    if (small == SMALL_SINGULAR || repeats) {
      *outcome = repeats ? ACTIVE_CYCLES : ACTIVE_SINGULAR;
      break;
    }
    PetscCall(ActiveFindScale(a));
    if (!n_changed) PetscCall(Damp(a, l, w, residual));
    PetscCall(StatusUpdate(a, single, &n_changed));
    PetscCall(ActiveSlipResidual(a, &residual));
    if (n_changed || residual > SLIPPING) continue;
    if (a->rtol == EXACT || a->compliance->W) *outcome = a->reversed ? ACTIVE_JAMMED : ACTIVE_CONVERGED;
    a->rtol = EXACT;
  }
  PetscCall(PetscFree2(l, w));
  PetscFunctionReturn(0);
}

/* All pairs closed, without slip */
static PetscErrorCode Restart(Active *a)
{
  PetscFunctionBeginUser;
  for (PetscInt p = 0; p < a->rows->n_pairs; p++) a->status[p] = a->rows->law[p].d == 3 ? CONTACT_STICK : CONTACT_SLIP;
  PetscCall(PetscArrayzero(a->l, a->rows->n));
  PetscCall(PetscArrayzero(a->w, a->rows->n));
  PetscFunctionReturn(0);
}

/* Whether many iterations are worth their time */
static PetscBool IsFew(const Active *a)
{
  return a->compliance->W && a->rows->n_all <= FEW ? PETSC_TRUE : PETSC_FALSE;
}

/* Raises friction in steps from the equilibrium without it */
static PetscErrorCode Raise(Active *a, ActiveOutcome *outcome)
{
  const PetscBool few      = IsFew(a);
  const PetscReal min_step = few ? MIN_STEP : LARGE_STEP;
  PetscReal       reached = 0, step = 0.25, *l, *w;
  ContactStatus  *status;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc3(a->rows->n_pairs, &status, a->rows->n, &l, a->rows->n, &w));
  a->friction = 0;
  PetscCall(Restart(a));
  PetscCall(Iterate(a, few, outcome));
  while (reached < 1 && *outcome == ACTIVE_CONVERGED && step >= min_step) {
    PetscCall(PetscArraycpy(status, a->status, a->rows->n_pairs));
    PetscCall(PetscArraycpy(l, a->l, a->rows->n));
    PetscCall(PetscArraycpy(w, a->w, a->rows->n));
    a->friction = PetscMin(1, reached + step);
    PetscCall(Iterate(a, PETSC_FALSE, outcome));
    if (*outcome != ACTIVE_CONVERGED && few) PetscCall(Iterate(a, PETSC_TRUE, outcome));
    if (*outcome == ACTIVE_CONVERGED) {
      reached = a->friction;
      step *= 1.5;
      continue;
    }
    PetscCall(PetscArraycpy(a->status, status, a->rows->n_pairs));
    PetscCall(PetscArraycpy(a->l, l, a->rows->n));
    PetscCall(PetscArraycpy(a->w, w, a->rows->n));
    step /= 2;
    if (step >= min_step) *outcome = ACTIVE_CONVERGED;
  }
  a->friction = reached;
  PetscCall(PetscFree3(status, l, w));
  PetscFunctionReturn(0);
}

/* Statuses by pivoting, or with Coulomb pairs by single changes, confirmed by the iteration */
static PetscErrorCode IterateSurely(Active *a, ActiveOutcome *outcome)
{
  PetscBool found;

  PetscFunctionBeginUser;
  PetscCall(Restart(a));
  if (!PairRowsCoulomb(a->rows)) {
    PetscCall(PivotSolve(a->compliance, a->friction, a->free, a->status, &found));
    if (found) PetscCall(Iterate(a, PETSC_FALSE, outcome));
    if (*outcome == ACTIVE_CONVERGED) PetscFunctionReturn(0);
    PetscCall(Restart(a));
  }
  PetscCall(Iterate(a, PETSC_TRUE, outcome));
  PetscFunctionReturn(0);
}

PetscErrorCode ActiveSolve(Active *a, ActiveOutcome *outcome)
{
  PetscFunctionBeginUser;
  a->friction = 1;
  PetscCall(Iterate(a, PETSC_FALSE, outcome));
  if (*outcome == ACTIVE_CONVERGED) PetscFunctionReturn(0);
  if (IsFew(a)) PetscCall(IterateSurely(a, outcome));
  if (*outcome != ACTIVE_CONVERGED) PetscCall(Raise(a, outcome));
  PetscFunctionReturn(0);
}

PetscErrorCode ActiveCorrect(Active *a, const PetscReal rhs[])
{
  PetscReal   *l, *w;
  SmallOutcome outcome;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(a->rows->n, &l, a->rows->n, &w));
  a->rtol = CORRECT;
  PetscCall(Solve(a, PETSC_TRUE, rhs, l, w, &outcome));
  for (PetscInt i = 0; i < a->rows->n && outcome == SMALL_GOOD; i++) {
    a->l[i] += l[i];
    a->w[i] += w[i];
  }
  PetscCall(PetscFree2(l, w));
  PetscFunctionReturn(0);
}
