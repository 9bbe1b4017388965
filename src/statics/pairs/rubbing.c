/*
   Friction coefficients that depend on the pressure: those of each pair at the force found, and the equilibrium again,
   until they stay. A step takes out all but about p (d mu / dp) / mu times the share of friction in the normal forces.
*/
#include "statics/staticsimpl.h"

#define RUBBING_SETTLED 1e-13 /* of the largest coefficient */
#define RUBBING_ROUNDED 1e-10 /* what rounding may leave: no better after one more step */
#define RUBBING_STEPS   100

/* Whether any pair of any rank has such a law */
static PetscErrorCode RubbingIsAsked(const PairRows *rows, PetscBool *asked)
{
  PetscFunctionBeginUser;
  *asked = PETSC_FALSE;
  for (PetscInt i = 0; i < rows->n_interfaces; i++)
    if (FrictionNeedsPressure(&rows->interface[i].friction)) *asked = PETSC_TRUE;
  PetscFunctionReturn(0);
}

/* Raises the error for a pair beyond its table */
static PetscErrorCode RubbingCheck(const PairRows *rows, PetscInt interface, const PetscReal at[2])
{
  const ContactInterface *c   = &rows->interface[interface];
  FrictionLaw             law = c->friction;

  PetscFunctionBeginUser;
  law.pressure = at[1];
  if (at[1] > 0 && !FrictionCovers(&law, at[0]))
    PetscCall(FrictionComplain(rows->comm, c->name, &law, -1, at[0], at[1]));
  PetscFunctionReturn(0);
}

/* The coefficients at the forces found; by how much they change, of the largest */
static PetscErrorCode RubbingTake(Active *a, PetscReal *change)
{
  PairRows *rows    = a->rows;
  PetscReal most[2] = {0, 0}; /* change, and coefficient */
  PetscReal(*at)[2];          /* of each interface the largest speed and pressure */

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(rows->n_interfaces, &at));
  for (PetscInt p = 0; p < rows->n_pairs; p++) {
    const PetscReal before = rows->law[p].mu + PetscAbsReal(rows->slide[p]);
    const PetscReal force  = PetscMax(0, a->compliance->kappa * a->l[rows->first[p]]);
    const PetscInt  i      = rows->pair[p].interface;

    PetscCall(PairRowsSetFriction(a->operators, a->p, p, force, rows));
    most[0]  = PetscMax(most[0], PetscAbsReal(rows->law[p].mu + PetscAbsReal(rows->slide[p]) - before));
    most[1]  = PetscMax(most[1], before);
    at[i][0] = PetscMax(at[i][0], rows->slides[i] ? rows->pair[p].speed : 0);
    at[i][1] = PetscMax(at[i][1], force / rows->pair[p].area);
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, most, 2, MPIU_REAL, MPI_MAX, rows->comm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, at, 2 * (PetscMPIInt)rows->n_interfaces, MPIU_REAL, MPI_MAX, rows->comm));
  *change = most[1] > 0 ? most[0] / most[1] : most[0] > 0;
  for (PetscInt i = 0; i < rows->n_interfaces && *change <= RUBBING_ROUNDED; i++)
    PetscCall(RubbingCheck(rows, i, at[i]));
  PetscCall(PetscFree(at));
  PetscFunctionReturn(0);
}

PetscErrorCode RubbingSolve(Active *a, ActiveOutcome *outcome)
{
  PetscReal change = PETSC_MAX_REAL, before;
  PetscBool asked;

  PetscFunctionBeginUser;
  PetscCall(PressuresSolve(a, outcome));
  PetscCall(RubbingIsAsked(a->rows, &asked));
  if (!asked) PetscFunctionReturn(0);
  for (PetscInt it = 0; it < RUBBING_STEPS && *outcome == ACTIVE_CONVERGED; it++) {
    before = change;
    PetscCall(RubbingTake(a, &change));
    if (change <= RUBBING_SETTLED || (change <= RUBBING_ROUNDED && change > before / 2)) PetscFunctionReturn(0);
    PetscCall(PressuresSolve(a, outcome));
  }
  if (*outcome == ACTIVE_CONVERGED) *outcome = ACTIVE_UNSETTLED;
  PetscFunctionReturn(0);
}
