/*
   Equilibrium with Coulomb's law by continuation in a regularisation of friction and contact: a pair slips by soft p
   under friction p before it gives way, and an open one pulls with a force in proportion to its gap
   (kernels/contact/coulomb.h), so that no body ever floats. While the regularisation is strong, friction is small
   wherever slip is. It is lowered in steps, each begun from the equilibrium before it, until the laws themselves
   settle.

   At each softness Newton's method is made global by a line search: equilibrium is linear and holds all the way once a
   whole step was made, so that the residual of the laws alone decides how far to go (M. Hintermueller, K. Ito, K.
   Kunisch, SIAM J. Optim. 13, 2002, 865, for the active set as Newton's method).

   Cost: at most log(SOFTEST / HARDEST) / log(LAST_FACTOR) = 1246 softnesses are reached, 387 with LARGE_FACTOR in large
   problems; each with a step that failed before it and a try of the laws themselves, and each of these tries solves at
   most max_it small systems, those with drag among them.
*/
#include "statics/staticsimpl.h"

#define SOFTEST       1e4   /* softness that begins, over 1 / kappa */
#define PULL          1e-5  /* of an open pair over the softness */
#define HARD          4.0   /* softness from which on Coulomb's law itself is tried */
#define HARDEST       1e-12 /* softness that is rounding */
#define MOST_FACTOR   1e4   /* of the softness from step to step: at most, at first, and at last */
#define FIRST_FACTOR  16.0
#define LAST_FACTOR   1.03
#define LARGE_FACTOR  1.1  /* at last in large problems */
#define DESCENT       1e-4 /* of the residual along a step */
#define SHORTEST_STEP (1.0 / 65536)
#define ENOUGH        1e-10 /* residual of the laws, relative to the largest force */
#define ENOUGH_SOFT   1e-3  /* and of softened ones, from which only the next softness begins */
#define ENOUGH_PLACES 1e-14 /* or to the scale: rounding where forces are small beside gaps */
#define MOST_GROWTH   4.0   /* growth of the scale in a step */
#define LEAST_DRAG    1e-8  /* below 1, which is friction in proportion to slip */
#define MOST_DRAG     0.5
#define DRAG_FACTOR   30.0

/* Where a step or a softness begins */
typedef struct {
  PetscReal *l, *w; /* [rows] */
  PetscReal  residual, scale;
} Kept;

static PetscErrorCode Keep(const Active *a, PetscReal residual, Kept *kept)
{
  PetscFunctionBeginUser;
  PetscCall(PetscArraycpy(kept->l, a->l, a->rows->n));
  PetscCall(PetscArraycpy(kept->w, a->w, a->rows->n));
  kept->residual = residual;
  kept->scale    = a->scale;
  PetscFunctionReturn(0);
}

static PetscErrorCode GoBack(Active *a, const Kept *kept)
{
  PetscFunctionBeginUser;
  PetscCall(PetscArraycpy(a->l, kept->l, a->rows->n));
  PetscCall(PetscArraycpy(a->w, kept->w, a->rows->n));
  a->scale = kept->scale;
  PetscFunctionReturn(0);
}

/* soft without unit: slip (m) over friction / kappa (m); an open pair pulls with PULL soft of its gap */
static void SoftenSet(Active *a, PetscReal soft)
{
  for (PetscInt p = 0; p < a->rows->n_pairs; p++) {
    a->rows->law[p].soft = soft;
    a->rows->law[p].pull = PULL * soft;
  }
}

static void DragSet(Active *a, PetscReal drag)
{
  for (PetscInt p = 0; p < a->rows->n_pairs; p++) a->rows->law[p].drag = drag;
}

/* Statuses that l and w ask for, and the 2-norm of the residuals of all laws, m. The normal law of a closed pair is
   measured in the larger of force and displacement, as a length: l / k - w + g0 for k > 1, l - k (w - g0) else. */
static PetscErrorCode SoftenMeasure(Active *a, PetscReal *residual)
{
  PetscReal sum = 0;

  PetscFunctionBeginUser;
  for (PetscInt p = 0; p < a->rows->n_pairs; p++) {
    const PetscReal *l = &a->l[a->rows->first[p]], *w = &a->w[a->rows->first[p]];
    CoulombPair      pair = a->rows->law[p];
    PetscReal        normal;

    pair.mu *= a->friction;
    a->status[p] = CoulombDecide(&pair, a->status[p], l, w, 0);
    if (a->status[p] == CONTACT_OPEN) {
      pair.mu = 0;
      normal  = l[0] - pair.pull * (w[0] - CoulombOrigin(&pair));
    } else {
      const PetscReal beyond = w[0] - CoulombOrigin(&pair);

      normal = pair.k > 1 ? l[0] / pair.k - beyond : l[0] - pair.k * beyond;
    }
    sum += PetscSqr(normal) + PetscSqr(CoulombResidual(&pair, l, w));
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &sum, 1, MPIU_REAL, MPI_SUM, a->rows->comm));
  *residual = PetscSqrtReal(sum);
  PetscFunctionReturn(0);
}

/* Goes back from l, w towards where the step began until the residual falls; whether it does */
static PetscErrorCode SoftenSearch(Active *a, const Kept *from, PetscReal *residual, PetscBool *falls)
{
  PetscFunctionBeginUser;
  *falls = PETSC_FALSE;
  for (PetscReal step = 1; step >= SHORTEST_STEP; step /= 2) {
    PetscCall(SoftenMeasure(a, residual));
    *falls = *residual <= (1 - DESCENT * step) * from->residual ? PETSC_TRUE : PETSC_FALSE;
    if (*falls) break;
    for (PetscInt i = 0; i < a->rows->n; i++) {
      a->l[i] = (from->l[i] + a->l[i]) / 2;
      a->w[i] = (from->w[i] + a->w[i]) / 2;
    }
  }
  PetscFunctionReturn(0);
}

/* One step with a drag, taken back where the residual does not fall; small is SMALL_UNSOLVED where no step will help */
static PetscErrorCode SoftenStep(Active *a, const Kept *from, PetscReal drag, PetscReal *residual, PetscBool *falls,
                                 SmallOutcome *small)
{
  const PetscBool first = from->residual == PETSC_MAX_REAL ? PETSC_TRUE : PETSC_FALSE;

  PetscFunctionBeginUser;
  *falls = PETSC_FALSE;
  DragSet(a, drag);
  PetscCall(ActiveLinear(a, a->l, a->w, small));
  DragSet(a, 0);
  if (*small == SMALL_GOOD) {
    PetscCall(ActiveFindScale(a));
    if (first || a->scale <= MOST_GROWTH * from->scale) PetscCall(SoftenSearch(a, from, residual, falls));
  }
  if (*falls) PetscFunctionReturn(0);
  PetscCall(GoBack(a, from));
  if (first)
    *residual = from->residual;
  else
    PetscCall(SoftenMeasure(a, residual));
  PetscFunctionReturn(0);
}

/* Residual from which on the laws are obeyed, m */
static PetscErrorCode SoftenEnough(const Active *a, PetscReal soft, PetscReal *enough)
{
  PetscReal force = 0;

  PetscFunctionBeginUser;
  for (PetscInt p = 0; p < a->rows->n_pairs; p++) force = PetscMax(force, PetscAbsReal(a->l[a->rows->first[p]]));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &force, 1, MPIU_REAL, MPI_MAX, a->rows->comm));
  *enough = PetscMax((soft > 0 ? ENOUGH_SOFT : ENOUGH) * force, ENOUGH_PLACES * a->scale);
  PetscFunctionReturn(0);
}

/* Newton's method at a softness; l and w are in equilibrium (balanced), or the first step is a whole one from the
   statuses given. Where a step does not lower the residual it is tried again with a drag, friction that grows along
   the slip; the drag falls by DRAG_FACTOR after each step that does. */
static PetscErrorCode SoftenIterate(Active *a, PetscReal soft, PetscBool balanced, PetscBool *converged)
{
  PetscReal    residual = PETSC_MAX_REAL, drag = 0, enough;
  PetscBool    falls;
  SmallOutcome small = SMALL_GOOD;
  Kept         from;

  PetscFunctionBeginUser;
  *converged = PETSC_FALSE;
  SoftenSet(a, soft);
  PetscCall(PetscMalloc2(a->rows->n, &from.l, a->rows->n, &from.w));
  if (balanced) PetscCall(SoftenMeasure(a, &residual));
  for (PetscInt it = 0; it < a->max_it && drag <= MOST_DRAG && !*converged; it++, a->n_it++) {
    PetscCall(Keep(a, residual, &from));
    PetscCall(SoftenStep(a, &from, drag, &residual, &falls, &small));
    if (small == SMALL_UNSOLVED) break;
    if (!falls) {
      drag = PetscMax(DRAG_FACTOR * drag, LEAST_DRAG);
      continue;
    }
    drag = drag > LEAST_DRAG ? drag / DRAG_FACTOR : 0;
    PetscCall(SoftenEnough(a, soft, &enough));
    *converged = residual <= enough ? PETSC_TRUE : PETSC_FALSE;
  }
  PetscCall(PetscFree2(from.l, from.w));
  PetscFunctionReturn(0);
}

/* Lowers the softness down to HARDEST, with a smaller step after a failure; converged at softness 0 */
static PetscErrorCode SoftenLower(Active *a, Kept *kept, PetscBool *converged)
{
  const PetscReal last = ActiveIsFew(a) ? LAST_FACTOR : LARGE_FACTOR;
  PetscReal       soft = SOFTEST, factor = FIRST_FACTOR;

  PetscFunctionBeginUser;
  while (*converged && factor > last) {
    PetscReal next = soft <= HARD ? 0 : soft / factor;

    PetscCall(Keep(a, 0, kept));
    do {
      PetscCall(SoftenIterate(a, next, PETSC_TRUE, converged));
      if (*converged) break;
      if (next > 0) factor = PetscSqrtReal(factor);
      next = soft / factor;
      PetscCall(GoBack(a, kept));
    } while (factor > last);
    if (next == 0) break;
    if (next < HARDEST) *converged = PETSC_FALSE;
    soft   = next;
    factor = PetscMin(PetscSqr(factor), MOST_FACTOR);
  }
  PetscFunctionReturn(0);
}

PetscErrorCode ActiveSoften(Active *a, ActiveOutcome *outcome)
{
  PetscBool converged;
  Kept      kept;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(a->rows->n, &kept.l, a->rows->n, &kept.w));
  PetscCall(SoftenIterate(a, SOFTEST, PETSC_FALSE, &converged));
  PetscCall(SoftenLower(a, &kept, &converged));
  SoftenSet(a, 0);
  PetscCall(PetscFree2(kept.l, kept.w));
  if (converged) PetscCall(ActiveIterate(a, PETSC_FALSE, outcome));
  PetscFunctionReturn(0);
}
