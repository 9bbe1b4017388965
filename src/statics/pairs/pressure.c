/*
   Pressure laws that are not linear, lambda_n = A P(c), c = w - g0 the closing (m): Newton's method about the active
   set. At closings c_i each pair is linear, a tangent

      l = k_i (w - g0 - s_i),   k_i = A P'(c_i) / kappa,   s_i = c_i - P(c_i) / P'(c_i),

   and one active set finds l and w of all pairs, on the one factorisation. Each pair then has two points on its law,
   that at the closing w - g0 and that at the pressure kappa l / A; the tangent is laid anew at the one that lies nearer
   to c_i. On a law that stiffens this is the pressure on the way up and the closing on the way down, so that no
   exponential runs away (as junctions are limited in circuits: L. W. Nagel, SPICE2, 1975), and near the solution both
   are one, which makes the last steps quadratic.

   It begins with all pairs rigid at the onset of their laws, where P' may vanish: forces of exact contact tell first
   closings whatever the units of a law. So does a pair that was open. A pair that the tangent calls open beyond the
   onset is closed in truth, and gets its tangent there.
*/
#include "statics/staticsimpl.h"

/* of the largest force, or of the largest closing beyond the onset */
#define PRESSURES_SETTLED 1e-12
/* what rounding of w leaves where bodies move much farther than they close: no better after one more step */
#define PRESSURES_ROUNDED 1e-8
#define PRESSURES_STEPS   100

/* Closing (m) and force (N) of a pair as they are */
typedef struct {
  PetscReal closing, force;
} PairNow;

static PairNow PairSee(const Active *a, PetscInt p)
{
  const PetscInt first = a->rows->first[p];

  return (PairNow){a->w[first] - a->rows->law[p].g0, a->compliance->kappa * a->l[first]};
}

/* The closing at which the law of a pair begins, m */
static PetscReal PairOnset(const PairRows *rows, PetscInt p)
{
  return PressureOnset(&rows->pressure[rows->pair[p].interface]);
}

/* The largest miss of all laws, as a force or as a closing, whichever is less */
static PetscErrorCode PressuresMeasure(const Active *a, PetscReal *residual)
{
  const PairRows *rows    = a->rows;
  PetscReal       size[2] = {0, 0}; /* N, m */

  PetscFunctionBeginUser;
  *residual = 0;
  for (PetscInt p = 0; p < rows->n_pairs; p++) {
    const PairNow now = PairSee(a, p);

    size[0] = PetscMax(size[0], PetscAbsReal(now.force));
    if (PairIsCurved(rows, p)) size[1] = PetscMax(size[1], PairClosing(rows, p, now.force) - PairOnset(rows, p));
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, size, 2, MPIU_REAL, MPI_MAX, rows->comm));
  for (PetscInt p = 0; p < rows->n_pairs; p++) {
    const PairNow now = PairSee(a, p);
    PetscReal     force, closing;

    if (!PairIsCurved(rows, p)) continue;
    force   = PetscAbsReal(now.force - PairForce(rows, p, now.closing));
    closing = PetscAbsReal(PetscMax(now.closing, PairOnset(rows, p)) - PairClosing(rows, p, now.force));
    if (force == 0 || closing == 0) continue;
    *residual = PetscMax(*residual, PetscMin(force / size[0], closing / size[1]));
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, residual, 1, MPIU_REAL, MPI_MAX, rows->comm));
  PetscFunctionReturn(0);
}

/* Where the tangent of a pair is laid next, m */
static PetscReal PairNext(const Active *a, PetscInt p)
{
  const PetscReal at = a->rows->closing[p], onset = PairOnset(a->rows, p);
  const PairNow   now = PairSee(a, p);

  if (a->status[p] == CONTACT_OPEN) return PetscMax(now.closing, onset);
  return TangentNext(onset, at, PairClosing(a->rows, p, now.force), now.closing);
}

/* Tangents at the points found, or, where exact contact jams or leaves a motion, with the stiffness kappa from the
   onset on to begin with */
static void PressuresNext(Active *a, PetscBool softly)
{
  PairRows *rows = a->rows;

  for (PetscInt p = 0; p < rows->n_pairs; p++) {
    if (!PairIsCurved(rows, p)) continue;
    if (softly)
      rows->law[p].k = 1;
    else
      PairRowsSetClosing(rows, p, a->compliance->kappa, PairNext(a, p));
  }
}

/* Steps of the tangents until the laws hold */
static PetscErrorCode PressuresIterate(Active *a, ActiveOutcome *outcome)
{
  PetscReal residual, before = PETSC_MAX_REAL;

  PetscFunctionBeginUser;
  PetscCall(ActiveSolve(a, outcome));
  if (*outcome != ACTIVE_CONVERGED) {
    PressuresNext(a, PETSC_TRUE);
    PetscCall(ActiveSolve(a, outcome));
  }
  for (PetscInt it = 0; it < PRESSURES_STEPS && *outcome == ACTIVE_CONVERGED; it++) {
    PetscCall(PressuresMeasure(a, &residual));
    if (residual <= PRESSURES_SETTLED) PetscFunctionReturn(0);
    if (residual <= PRESSURES_ROUNDED && residual > before / 2) PetscFunctionReturn(0);
    before = residual;
    PressuresNext(a, PETSC_FALSE);
    PetscCall(ActiveSolve(a, outcome));
  }
  if (*outcome == ACTIVE_CONVERGED) *outcome = ACTIVE_UNSETTLED;
  PetscFunctionReturn(0);
}

PetscErrorCode PressuresSolve(Active *a, ActiveOutcome *outcome)
{
  const PetscBool curved = PairRowsCurved(a->rows);

  PetscFunctionBeginUser;
  a->tentative = curved || a->passing ? PETSC_TRUE : PETSC_FALSE;
  if (curved)
    PetscCall(PressuresIterate(a, outcome));
  else
    PetscCall(ActiveSolve(a, outcome));
  if (!a->tentative || a->passing || a->compliance->W || *outcome != ACTIVE_CONVERGED) PetscFunctionReturn(0);
  PetscCall(ActiveIsReversed(a, a->friction, &a->reversed));
  if (a->reversed) *outcome = ACTIVE_JAMMED;
  PetscFunctionReturn(0);
}
