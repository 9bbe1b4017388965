/*
   Primal-dual active set on the laws of the pairs, a semismooth Newton method: the status of every pair makes its law
   linear; one small system gives all forces and displacements; they decide the next status. Without Coulomb pairs it
   ends exactly when no status changes. What is smaller than ACTIVE_ROUNDING of the largest displacement decides
   nothing.
*/
#include "statics/pairs/small.h"

/* of the largest displacement, force or gap: rounding of w = G u and of the small system */
#define ACTIVE_ROUNDING 1e-13
/* rows up to which single changes with friction, and small steps of it, are worth the time */
#define FEW 1000
/* residual of Coulomb's law at convergence, relative: Newton's method is quadratic there, and ends at rounding */
#define SLIPPING 1e-12
#define EXACT    1e-13 /* of GMRES */
/* of GMRES while statuses still change: they need no more, and the last iterations are solved to EXACT */
#define ROUGH 1e-3
/* of GMRES for corrections, which are small beside what they correct */
#define CORRECT 1e-8
/* least part of a step */
#define MIN_DAMP (1.0 / 128)
/* where statuses have gone round in circles rounding may have done it: pairs nearer to a border stay what they are */
#define SURE_ROUNDING   1e-11
#define SAFEGUARD_TRIES 10
#define ONE_BY_ONE      10 /* times max_it, when single pairs change */

/* Which of the wrong pairs change */
typedef enum { CHANGE_ALL, CHANGE_WORST, CHANGE_LAST } StatusChange;

/* Where the laws are linear, all change as long as fewer and fewer are wrong, or SAFEGUARD_TRIES times more; else the
   last: finite where there is one solution for any loads (J. J. Judice, F. M. Pires, Comput. Oper. Res. 21, 1994,
   587) */
typedef struct {
  PetscBool sure, linear;
  PetscInt  least, tries;
} Safeguard;

/* The pair of one rank that changes alone, as MPI_MAXLOC finds it; -1 on other ranks */
typedef struct {
  struct {
    double wrong;
    int    rank;
  } most;
  PetscInt pair;
} WrongPair;

static StatusChange SafeguardChoose(Safeguard *s, PetscInt n_wrong)
{
  if (!s->sure) return CHANGE_ALL;
  if (!s->linear) return CHANGE_WORST;
  if (n_wrong < s->least) {
    s->least = n_wrong;
    s->tries = SAFEGUARD_TRIES;
    return CHANGE_ALL;
  }
  return s->tries-- > 0 ? CHANGE_ALL : CHANGE_LAST;
}

/* Whether a hasty iteration gives up: where more pairs are wrong than there were before it may go round for long, and
   the continuation costs less */
static PetscBool SafeguardGivesUp(Safeguard *s, PetscInt n_wrong)
{
  if (n_wrong > s->least) return PETSC_TRUE;
  s->least = n_wrong;
  return PETSC_FALSE;
}

/* Laws l = P z + p0, w = Q z + q0 of all rows at the present status, lengths in m, P and Q without unit. Coulomb's
   slip is linearised at the present l, w; all others do not depend on them. */
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

/* z [d] of l and w of a pair, which need not obey the laws: where they do, l = P z + p0 and w = Q z + q0 (tangential
   blocks of P and Q have the sum I) */
static void LawInvert(const LawRow row[], PetscInt d, const PetscReal l[], const PetscReal w[], PetscReal z[])
{
  z[0] = row->P[0] >= row->Q[0] ? l[0] : w[0];
  for (PetscInt i = 1; i < d; i++) z[i] = l[i] - row[i].p0 - row[i].P[0] * z[0] + w[i] - row[i].q0;
}

/* Makes the laws those of what is added to the present l and w: p0 + P z - l in the place of p0 */
static void LawsShift(const Active *a, LawRow law[])
{
  for (PetscInt p = 0; p < a->rows->n_pairs; p++) {
    const PetscInt   first = a->rows->first[p], d = a->rows->law[p].d;
    const PetscReal *l = &a->l[first], *w = &a->w[first];
    LawRow          *row = &law[first];
    PetscReal        z[3];

    LawInvert(row, d, l, w, z);
    for (PetscInt i = 0; i < d; i++) {
      row[i].p0 -= l[i];
      row[i].q0 -= w[i];
      for (PetscInt k = 0; k < d; k++) {
        row[i].p0 += row[i].P[k] * z[k];
        row[i].q0 += row[i].Q[k] * z[k];
      }
    }
  }
}

/* z [rows] nearest to the present l and w */
static void LawsGuess(const Active *a, const LawRow law[], PetscReal z[])
{
  for (PetscInt p = 0; p < a->rows->n_pairs; p++) {
    const PetscInt first = a->rows->first[p];

    LawInvert(&law[first], a->rows->law[p].d, &a->l[first], &a->w[first], &z[first]);
  }
}

/* What is left of a solution, f - K u - G'l + S' D l (N) and w - G u [rows] */
typedef struct {
  Vec              r;
  const PetscReal *e;
} LinearLeft;

/* l and w for the forces f, or what is added to them for what is left */
static PetscErrorCode ActiveSolveLinear(Active *a, const LinearLeft *left, PetscReal l[], PetscReal w[],
                                        SmallOutcome *outcome)
{
  LawRow    *law;
  PetscReal *z;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(a->rows->n, &law));
  PetscCall(PetscCalloc1(a->rows->n, &z));
  LawsSet(a, law);
  if (left)
    LawsShift(a, law);
  else
    LawsGuess(a, law, z);
  PetscCall(SmallSolve(&(SmallSystem){.compliance = a->compliance,
                                      .friction   = a->friction,
                                      .law        = law,
                                      .f          = left ? left->r : a->f,
                                      .e          = left ? left->e : NULL,
                                      .added      = left ? PETSC_TRUE : PETSC_FALSE,
                                      .free       = a->free,
                                      .rtol       = a->rtol,
                                      .n_factored = &a->n_factored,
                                      .far        = &a->far},
                       z, l, w, outcome, &a->reversed));
  PetscCall(PetscFree(law));
  PetscCall(PetscFree(z));
  PetscFunctionReturn(0);
}

PetscErrorCode ActiveLinear(Active *a, PetscReal l[], PetscReal w[], SmallOutcome *outcome)
{
  return ActiveSolveLinear(a, NULL, l, w, outcome);
}

PetscErrorCode ActiveFindScale(Active *a)
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

/* How wrong the status of pair p is, m; *next = what it should be. Between open and closed it is the length by which
   the normal law fails, between stick and slip the residual of Coulomb's law. */
static PetscReal Wrongness(const Active *a, PetscInt p, ContactStatus *next)
{
  const PetscInt   first = a->rows->first[p];
  const PetscReal *l = &a->l[first], *w = &a->w[first];
  CoulombPair      pair = a->rows->law[p];

  pair.mu *= a->friction;
  *next = CoulombDecide(&pair, a->status[p], l, w, a->rounding * a->scale);
  if (*next == a->status[p]) return 0;
  if (*next == CONTACT_OPEN || a->status[p] == CONTACT_OPEN) return PetscAbsReal(CoulombClosing(&pair, l, w));
  return CoulombResidual(&pair, l, w);
}

/* Wrong pairs over all ranks, and the one that changes alone: the most wrong or the last by its row. Of equally wrong
   ones that of the lowest rank is taken (MPI_MAXLOC); within a rank the first. */
static PetscErrorCode StatusFindWrong(const Active *a, PetscBool last, PetscInt *n_wrong, WrongPair *one)
{
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(a->rows->comm, &rank));
  *one     = (WrongPair){.most = {-1, rank}, .pair = -1};
  *n_wrong = 0;
  for (PetscInt p = 0; p < a->rows->n_pairs; p++) {
    ContactStatus   next;
    const PetscReal how = Wrongness(a, p, &next), wrong = last ? (PetscReal)(a->rows->begin + a->rows->first[p]) : how;

    if (next == a->status[p]) continue;
    (*n_wrong)++;
    if (one->pair >= 0 && wrong <= one->most.wrong) continue;
    one->pair       = p;
    one->most.wrong = wrong;
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, n_wrong, 1, MPIU_INT, MPI_SUM, a->rows->comm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &one->most, 1, MPI_DOUBLE_INT, MPI_MAXLOC, a->rows->comm));
  if (one->most.rank != rank) one->pair = -1;
  PetscFunctionReturn(0);
}

/* Changes wrong statuses as the safeguard says; n_changed of all that are wrong, over all ranks */
static PetscErrorCode StatusUpdate(Active *a, Safeguard *guard, PetscInt *n_changed)
{
  ContactStatus next;
  WrongPair     worst, last;

  PetscFunctionBeginUser;
  PetscCall(StatusFindWrong(a, PETSC_FALSE, n_changed, &worst));
  PetscCall(StatusFindWrong(a, PETSC_TRUE, n_changed, &last));
  switch (SafeguardChoose(guard, *n_changed)) {
  case CHANGE_ALL:
    for (PetscInt p = 0; p < a->rows->n_pairs; p++) {
      (void)Wrongness(a, p, &next);
      a->status[p] = next;
    }
    break;
  case CHANGE_LAST:
    worst.pair = last.pair; /* fall through */
  case CHANGE_WORST:
    if (worst.pair < 0) break;
    (void)Wrongness(a, worst.pair, &next);
    a->status[worst.pair] = next;
  }
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

/* Whether the determinant may be negative: without friction, or where no pair has some, it is positive (small.c) */
static PetscBool ActiveMayReverse(const Active *a, PetscReal friction)
{
  return friction != 0 && (PairRowsCoulomb(a->rows) || a->rows->S) ? PETSC_TRUE : PETSC_FALSE;
}

/* Whether the determinant is negative at the present statuses, with a factor of friction that may be another one */
PetscErrorCode ActiveIsReversed(Active *a, PetscReal friction, PetscBool *reversed)
{
  Active  at = *a;
  LawRow *law;

  PetscFunctionBeginUser;
  at.friction = friction;
  *reversed   = PETSC_FALSE;
  if (!ActiveMayReverse(a, friction)) PetscFunctionReturn(0);
  PetscCall(PetscMalloc1(a->rows->n, &law));
  LawsSet(&at, law);
  PetscCall(SmallIsReversed(
    &(SmallSystem){.compliance = a->compliance, .friction = friction, .law = law, .n_factored = &a->n_factored},
    reversed));
  PetscCall(PetscFree(law));
  PetscFunctionReturn(0);
}

/* One iteration: laws of the statuses, l and w that obey them, new statuses. It has converged where no status changes
   and Coulomb's law holds, after a last system solved to EXACT, and where its determinant has the right sign. Bounds:
   max_it iterations, ten times as many where single pairs change. */
PetscErrorCode ActiveIterate(Active *a, PetscBool sure, ActiveOutcome *outcome)
{
  const PetscInt max_it    = sure ? ONE_BY_ONE * a->max_it : a->max_it;
  PetscReal      residual  = 0, *l, *w;
  PetscInt       n_changed = 1;
  Repeat         seen      = {.n = 0};
  Safeguard      guard     = {.sure = sure, .linear = ActiveIsLinear(a), .least = PETSC_MAX_INT};
  PetscBool      repeats;
  SmallOutcome   small;

  PetscFunctionBeginUser;
  *outcome = ACTIVE_SLOW;
  PetscCall(PetscMalloc2(a->rows->n, &l, a->rows->n, &w));
  a->rtol     = sure || PairRowsCoulomb(a->rows) ? EXACT : ROUGH;
  a->rounding = sure ? SURE_ROUNDING : ACTIVE_ROUNDING;
  for (PetscInt it = 0; it < max_it && *outcome == ACTIVE_SLOW; it++, a->n_it++) {
    repeats = PETSC_FALSE;
    if (n_changed && !(sure && guard.linear)) PetscCall(RepeatFind(a, &seen, &repeats));
    PetscCall(PetscArraycpy(l, a->l, a->rows->n));
    PetscCall(PetscArraycpy(w, a->w, a->rows->n));
    PetscCall(ActiveLinear(a, a->l, a->w, &small));
    if (small != SMALL_GOOD || repeats) {
      *outcome = repeats ? ACTIVE_REPEATS : small == SMALL_UNSOLVED ? ACTIVE_UNSOLVED : ACTIVE_SINGULAR;
      break;
    }
    PetscCall(ActiveFindScale(a));
    if (!n_changed) PetscCall(Damp(a, l, w, residual));
    PetscCall(StatusUpdate(a, &guard, &n_changed));
    PetscCall(ActiveSlipResidual(a, &residual));
    if (a->hasty && SafeguardGivesUp(&guard, n_changed)) *outcome = ACTIVE_REPEATS;
    if (n_changed || residual > SLIPPING) continue;
    if (a->rtol == EXACT || a->compliance->W) {
      if (!a->compliance->W && !a->tentative) PetscCall(ActiveIsReversed(a, a->friction, &a->reversed));
      *outcome = a->reversed ? ACTIVE_JAMMED : ACTIVE_CONVERGED;
    }
    a->rtol = EXACT;
  }
  PetscCall(PetscFree2(l, w));
  PetscFunctionReturn(0);
}

PetscErrorCode ActiveCorrect(Active *a, Vec r, const PetscReal e[])
{
  PetscReal   *l, *w;
  SmallOutcome outcome;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(a->rows->n, &l, a->rows->n, &w));
  a->rtol = CORRECT;
  PetscCall(ActiveSolveLinear(a, &(LinearLeft){r, e}, l, w, &outcome));
  for (PetscInt i = 0; i < a->rows->n && outcome == SMALL_GOOD; i++) {
    a->l[i] += l[i];
    a->w[i] += w[i];
  }
  PetscCall(PetscFree2(l, w));
  PetscFunctionReturn(0);
}

PetscBool ActiveIsFew(const Active *a)
{
  return a->rows->n_all <= FEW ? PETSC_TRUE : PETSC_FALSE;
}
