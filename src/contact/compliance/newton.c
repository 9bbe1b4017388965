/*
   Semismooth Newton method on the laws of the pairs (P. Alart, A. Curnier, Comput. Methods Appl. Mech. Eng. 92, 1991,
   353): the statuses that l, v ask for make all laws linear; the linear system of the closed pairs gives the next l, v.
   Damped, the step is shortened until the norm of the natural map is below the largest of the last few (L. Grippo,
   F. Lampariello, S. Lucidi, SIAM J. Numer. Anal. 23, 1986, 707). Both give up where that does not fall any more; what
   they leave is the best that they have seen.
*/
#include "complianceimpl.h"

/* steps in a row without a lower residual: a semismooth method may rise for some steps while statuses settle */
#define NEWTON_PATIENCE 8
#define NEWTON_MEMORY   5 /* norms that a damped step is compared with */
/* of the decrease that a step promises (the usual constant of Armijo's rule) */
#define NEWTON_ENOUGH 1e-4
#define NEWTON_REFINE 3   /* steps at most on what is solved, */
#define NEWTON_ALONG  100 /* tolerances: until friction is along slip to this part of the largest force */
/* of a step; below it the step is given up */
#define NEWTON_SHORTEST 1. / 64

/* The matrix at the present laws, as it was before: l and v are what it is made of */
static PetscErrorCode NewtonAssembleAgain(ContactCompliance c)
{
  PetscFunctionBeginUser;
  PetscCall(PetscArraycpy(c->l, c->l0, 3 * c->n));
  PetscCall(PetscArraycpy(c->v, c->v0, 3 * c->n));
  PetscCall(ComplianceAssemble(c, 0));
  PetscFunctionReturn(0);
}

/* The matrix at the present laws, factored: in the fast way, with exchange of rows, shifted where it is singular */
static PetscErrorCode NewtonFactor(ContactCompliance c, PetscBool *singular)
{
  PetscBool good;

  PetscFunctionBeginUser;
  *singular = PETSC_FALSE;
  PetscCall(ComplianceAssemble(c, 0));
  ComplianceFactorFast(c, c->row[c->n_closed], &good);
  if (good) PetscFunctionReturn(0);
  PetscCall(NewtonAssembleAgain(c));
  PetscCall(ComplianceFactor(c, c->row[c->n_closed], singular));
  if (!*singular) PetscFunctionReturn(0);
  PetscCall(NewtonAssembleAgain(c));
  ComplianceShift(c, 0);
  PetscCall(ComplianceFactor(c, c->row[c->n_closed], singular));
  PetscFunctionReturn(0);
}

/* One step on l, v: statuses of the present l, v, or as they are where kept, their laws, the linear system, the new l,
   and v of it anew (not v + dv, whose rounding would stay). l0, v0 keep the point before. */
static PetscErrorCode NewtonStep(ContactCompliance c, PetscBool keep, PetscBool *singular)
{
  PetscBool solved;

  PetscFunctionBeginUser;
  *singular = PETSC_FALSE;
  PetscCall(PetscArraycpy(c->l0, c->l, 3 * c->n));
  PetscCall(PetscArraycpy(c->v0, c->v, 3 * c->n));
  if (!keep) ComplianceChoose(c);
  ComplianceLinearise(c);
  if (ComplianceIsMap(c)) {
    PetscCall(ComplianceKrylovSolve(c));
    solved = PETSC_TRUE;
  } else
    PetscCall(ComplianceDualSolve(c, &solved));
  if (!solved) PetscCall(NewtonFactor(c, singular));
  if (!solved) PetscCall(ComplianceBackSolve(c, c->row[c->n_closed], c->rhs));
  ComplianceTake(c);
  PetscCall(ComplianceMove(c));
  c->report.iterations++;
  PetscFunctionReturn(0);
}

/* Shortens the step from l0, v0, along which v is linear, until the norm of the natural map is below (1 - 1e-4 t)
   `above`, t the part of the step that is left; true where it is. v is halved with l instead of multiplied by W
   again. */
static PetscBool NewtonShorten(ContactCompliance c, PetscReal above, ComplianceMiss *miss)
{
  for (PetscReal t = 1; t > NEWTON_SHORTEST; t /= 2) {
    if (miss->norm <= (1 - NEWTON_ENOUGH * t) * above) return PETSC_TRUE;
    for (PetscInt i = 0; i < 3 * c->n; i++) {
      c->l[i] = 0.5 * (c->l[i] + c->l0[i]);
      c->v[i] = 0.5 * (c->v[i] + c->v0[i]);
    }
    ComplianceMeasure(c, miss);
  }
  return PETSC_FALSE;
}

/* Norms that damped steps are compared with */
typedef struct {
  PetscReal norm[NEWTON_MEMORY];
  PetscInt  n;
} NewtonMemory;

static PetscReal NewtonLargest(const NewtonMemory *memory)
{
  PetscReal largest = 0;

  for (PetscInt i = 0; i < PetscMin(memory->n, NEWTON_MEMORY); i++) largest = PetscMax(largest, memory->norm[i]);
  return largest;
}

/* Keeps the best l; true as long as there is a better one from time to time */
static PetscErrorCode NewtonKeep(ContactCompliance c, const ComplianceMiss *miss, ComplianceMiss *best, PetscInt *since,
                                 PetscBool *hope)
{
  PetscFunctionBeginUser;
  (*since)++;
  if (miss->largest < best->largest) {
    *best  = *miss;
    *since = 0;
    PetscCall(PetscArraycpy(c->best, c->l, 3 * c->n));
  }
  *hope = *since < NEWTON_PATIENCE && !PetscIsInfOrNanReal(miss->norm) ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(0);
}

/* How far friction is off the direction of slip, relative to the largest force: the natural map hardly feels the
   direction of a slip that is short beside l */
static PetscReal NewtonDirection(ContactCompliance c, const ComplianceMiss *miss)
{
  PetscReal off = 0;

  ComplianceChoose(c);
  for (PetscInt p = 0; p < c->n; p++) {
    const PetscReal *l = &c->l[3 * p], *v = &c->v[3 * p], slip = hypot(v[1], v[2]);

    if (c->status[p] == CONTACT_SLIP && slip > 0) off = PetscMax(off, PetscAbsReal(l[1] * v[2] - l[2] * v[1]) / slip);
  }
  return off / miss->scale;
}

/* Steps on what is solved, until friction is along the slip; one that does not lower the residual is taken back.
   c->best holds the point before. */
PetscErrorCode ComplianceRefine(ContactCompliance c, ComplianceMiss *miss)
{
  const PetscInt N = 3 * c->n;

  PetscFunctionBeginUser;
  for (PetscInt it = 0; it < NEWTON_REFINE; it++) {
    const ComplianceMiss last = *miss;
    PetscBool            singular;

    if (NewtonDirection(c, miss) <= NEWTON_ALONG * c->rtol) break;
    PetscCall(PetscArraycpy(c->best, c->l, N));
    PetscCall(NewtonStep(c, PETSC_FALSE, &singular));
    ComplianceMeasure(c, miss);
    if (miss->largest < last.largest) continue;
    *miss = last;
    PetscCall(PetscArraycpy(c->l, c->best, N));
    PetscCall(ComplianceMove(c));
    break;
  }
  PetscFunctionReturn(0);
}

PetscErrorCode ComplianceIterate(ContactCompliance c, PetscBool damped, PetscInt max_it, ComplianceMiss *miss)
{
  NewtonMemory   memory = {.n = 0};
  ComplianceMiss best;
  PetscInt       since = 0;
  PetscBool      hope  = PETSC_TRUE, singular;

  PetscFunctionBeginUser;
  PetscCall(ComplianceMove(c));
  ComplianceMeasure(c, miss);
  best = *miss;
  PetscCall(PetscArraycpy(c->best, c->l, 3 * c->n));
  for (PetscInt it = 0; it < max_it && hope && !ComplianceIsSolved(c, miss); it++) {
    memory.norm[memory.n++ % NEWTON_MEMORY] = miss->norm;
    PetscCall(NewtonStep(c, (PetscBool)(ComplianceIsMap(c) && !damped && it == 0), &singular));
    ComplianceMeasure(c, miss);
    if (damped) hope = NewtonShorten(c, NewtonLargest(&memory), miss);
    if (hope) PetscCall(NewtonKeep(c, miss, &best, &since, &hope));
  }
  if (!ComplianceIsSolved(c, miss)) {
    *miss = best;
    PetscCall(PetscArraycpy(c->l, c->best, 3 * c->n));
    PetscCall(ComplianceMove(c));
  }
  PetscFunctionReturn(0);
}
