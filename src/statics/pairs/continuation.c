/*
   What the active set does not settle is either proven to have no equilibrium (certificate.c) or tried otherwise:
   with Coulomb's law by continuation in a regularisation of friction (soften.c), which begins as soon as more pairs
   become wrong from one iteration to the next, since going round costs more; where it fails the active set is asked
   to its end; statuses of sliding pairs, and of all without friction, are found by pivoting (pivot.c); then fewer
   change per iteration; then all friction coefficients are raised from 0 in steps, each begun from the equilibrium
   before it, with half the step after a failure. Equilibrium without friction is a convex problem. An equilibrium
   whose system has a determinant of the wrong sign (small.c, refactor.c) is none that can be reached from there,
   hence a failure too: on the way forces grow beyond any bound, the bodies jam. So they do where the last
   equilibrium's pairs would have such a system with the whole friction.
*/
#include "statics/staticsimpl.h"

/* least step of the factor of friction, in small problems */
#define MIN_STEP (1.0 / 1024)
/* and in large ones, each of whose steps costs solutions with K_a */
#define LARGE_STEP (1.0 / 16)

/* All pairs closed, without slip; l = w = 0, so that nothing of a failed try is left */
static PetscErrorCode Restart(Active *a)
{
  PetscFunctionBeginUser;
  for (PetscInt p = 0; p < a->rows->n_pairs; p++) a->status[p] = a->rows->law[p].d == 3 ? CONTACT_STICK : CONTACT_SLIP;
  PetscCall(PetscArrayzero(a->l, a->rows->n));
  PetscCall(PetscArrayzero(a->w, a->rows->n));
  PetscFunctionReturn(0);
}

/* Statuses by pivoting where laws are linear and the problem dense, confirmed by the iteration; else by changing
   fewer */
static PetscErrorCode IterateSurely(Active *a, ActiveOutcome *outcome)
{
  PetscBool found = PETSC_FALSE;

  PetscFunctionBeginUser;
  if (!ActiveIsLinear(a) && !ActiveIsFew(a)) PetscFunctionReturn(0);
  PetscCall(Restart(a));
  if (ActiveIsLinear(a) && a->compliance->W) {
    PetscCall(PivotSolve(a->compliance, a->friction, a->free, a->status, &found));
    if (found) PetscCall(ActiveIterate(a, PETSC_TRUE, outcome));
    if (found && *outcome == ACTIVE_CONVERGED) PetscFunctionReturn(0);
    PetscCall(Restart(a));
  }
  PetscCall(ActiveIterate(a, PETSC_TRUE, outcome));
  PetscFunctionReturn(0);
}

/* Why friction could not be raised further: whether the bodies jam at the whole of it. Pairs that obey Coulomb's law
   may slip anywhere without friction: where it could not be raised at all, a jam is the word of rounding, and what the
   first iteration ended with is told instead. */
static PetscErrorCode RaiseOutcome(Active *a, ActiveOutcome *outcome)
{
  PetscFunctionBeginUser;
  if (a->friction == 0 && PairRowsCoulomb(a->rows)) {
    if (*outcome == ACTIVE_JAMMED) *outcome = a->first;
    PetscFunctionReturn(0);
  }
  PetscCall(ActiveIsReversed(a, 1, &a->reversed));
  if (a->reversed) *outcome = ACTIVE_JAMMED;
  PetscFunctionReturn(0);
}

/* Raises friction in steps from the equilibrium without it: the factor `reached` goes from 0 to 1, first by a
   quarter, half as much after a failure, 1.5 times as much after a success. The state before a failed step is taken
   back whole. */
static PetscErrorCode Raise(Active *a, ActiveOutcome *outcome)
{
  const PetscBool few      = ActiveIsFew(a);
  const PetscReal min_step = few ? MIN_STEP : LARGE_STEP;
  PetscReal       reached = 0, step = 0.25, *l, *w;
  ContactStatus  *status;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc3(a->rows->n_pairs, &status, a->rows->n, &l, a->rows->n, &w));
  a->friction = 0;
  PetscCall(Restart(a));
  PetscCall(ActiveIterate(a, PETSC_FALSE, outcome));
  if (*outcome != ACTIVE_CONVERGED) PetscCall(IterateSurely(a, outcome));
  a->pressed = *outcome == ACTIVE_CONVERGED ? PETSC_TRUE : PETSC_FALSE;
  while (reached < 1 && *outcome == ACTIVE_CONVERGED && step >= min_step) {
    PetscCall(PetscArraycpy(status, a->status, a->rows->n_pairs));
    PetscCall(PetscArraycpy(l, a->l, a->rows->n));
    PetscCall(PetscArraycpy(w, a->w, a->rows->n));
    a->friction = PetscMin(1, reached + step);
    PetscCall(ActiveIterate(a, PETSC_FALSE, outcome));
    if (*outcome != ACTIVE_CONVERGED && few && a->compliance->W) PetscCall(ActiveIterate(a, PETSC_TRUE, outcome));
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
  if (*outcome != ACTIVE_CONVERGED && *outcome != ACTIVE_UNSOLVED && a->pressed) PetscCall(RaiseOutcome(a, outcome));
  PetscCall(PetscFree3(status, l, w));
  PetscFunctionReturn(0);
}

PetscErrorCode ActiveSolve(Active *a, ActiveOutcome *outcome)
{
  PetscFunctionBeginUser;
  a->friction = 1;
  a->hasty    = PairRowsCoulomb(a->rows);
  PetscCall(ActiveIterate(a, PETSC_FALSE, outcome));
  a->hasty = PETSC_FALSE;
  a->first = *outcome;
  if (*outcome == ACTIVE_CONVERGED) PetscFunctionReturn(0);
  PetscCall(CertificateCheck(a));
  if (PairRowsCoulomb(a->rows)) {
    PetscCall(Restart(a));
    PetscCall(ActiveSoften(a, outcome));
    if (*outcome == ACTIVE_CONVERGED) PetscFunctionReturn(0);
    PetscCall(Restart(a));
    PetscCall(ActiveIterate(a, PETSC_FALSE, outcome));
    a->first = *outcome;
    if (*outcome == ACTIVE_CONVERGED) PetscFunctionReturn(0);
  }
  PetscCall(IterateSurely(a, outcome));
  if (*outcome != ACTIVE_CONVERGED) PetscCall(Raise(a, outcome));
  PetscFunctionReturn(0);
}
