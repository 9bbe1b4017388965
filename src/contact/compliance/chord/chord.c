/*
   Newton's method with factors that stay from step to step. Indices of a pair, in its frame (n, x, e), e near the
   direction of its slip and x across it, each with a force dz and the row that this is found from,

      0  n        l = (1, -mu e) dz     v_n = 0                    closed
      1  across   l = x dz              v_x + c l_x = 0            slips, c = |v_T| / (mu l_n)
      2  across   l = x dz              v_x = 0                    sticks
      3  along    l = e dz              v_e = 0                    sticks

   of which the second says that friction is along the slip, v_T = -c l_T. With frame, mu and c held, the matrix A of a
   set of indices is that of W kappa in these directions, c on its diagonal, and statuses change the set alone. LU
   factors of a base set serve all near it: indices that join (B) and that leave (D) border it,

      [A0   A_0B  E_D] [x0 ]   [b0 ]
      [A_B0 A_BB  0  ] [x_B] = [b_B]      solved by the Schur complement on A0, of as many rows as indices changed
      [E_D' 0     0  ] [y  ]   [0  ]

   (P. E. Gill, W. Murray, M. A. Saunders, M. H. Wright, Math. Program. 45, 1989, 437). An iteration solves A dz = -v,
   the present c in place of the one held; then friction of sliding pairs is put on their cones. A pair whose c is
   beyond COMPLIANCE_WEAK carries next to nothing and has no index 1: its friction is turned to where it slides at the
   present v. What c, e and mu have changed since makes an iteration contract less, most at pairs that open, whose c
   grows to infinity: dz across is scaled to their present c, and their friction turned once more at the v that follows.
   mix.c makes up for some of the rest, and factors are renewed where they cost more iterations than new ones take time.
   Where that does not converge, newton.c follows.
*/
#include "contact/compliance/complianceimpl.h"

#define CHORD_MAX_IT   40
#define CHORD_BEYOND   1e9 /* times the square of the tolerance: what is solved is made as good, 1e-15 for 1e-12 */
#define CHORD_NONE     -2  /* pair of the worst residual where no iterate solves the laws */
#define CHORD_RENEWALS 8   /* of the factors in a step */
#define CHORD_SLOW     0.5 /* residual over the one before, of an iteration without change of status */
#define CHORD_PATIENCE 4   /* slow iterations */
#define CHORD_LONG     3.  /* slip over friction, from which that is turned by the pair alone */
#define CHORD_GROUP    4   /* pairs that are turned at once: a pass over v takes eight columns */
#define CHORD_WORTH    16. /* new factors of m indices take the time of m / CHORD_WORTH iterations */

/* A pair has the force l (m) from now on, and v follows by three columns of W instead of the whole product */
static void ChordPut(ContactCompliance c, PetscInt p, const PetscReal l[3])
{
  const PetscInt N = 3 * c->n;

  for (PetscInt i = 0; i < 3; i++) {
    const PetscReal  more = c->kappa[p] * (l[i] - c->l[3 * p + i]);
    const PetscReal *W    = &c->W[(3 * p + i) * N];

    c->l[3 * p + i] = l[i];
    for (PetscInt k = 0; k < N && more != 0; k++) c->v[k] += more * W[k];
  }
}

/* New statuses, true where there are any; a pair that opens loses its force at once, and one that starts to slide has
   the friction of its cone */
static PetscBool ChordChoose(ContactCompliance c)
{
  PetscBool changed = PETSC_FALSE;

  for (PetscInt p = 0; p < c->n; p++) c->chord.next[p] = (PetscInt)c->status[p];
  ComplianceChoose(c);
  for (PetscInt p = 0; p < c->n; p++) {
    const PetscReal *l = &c->l[3 * p], zero[3] = {0, 0, 0};
    PetscReal        d[2];

    if (c->chord.next[p] == (PetscInt)c->status[p]) continue;
    changed = PETSC_TRUE;
    if (c->status[p] == CONTACT_OPEN) ChordPut(c, p, zero);
    if (c->status[p] != CONTACT_SLIP) continue;
    ComplianceTurn(c, p, d);
    ChordPut(c, p, (PetscReal[3]){l[0], d[0] * l[0], d[1] * l[0]});
  }
  return changed;
}

/* Friction of a pair that slides, dz across, put on its cone |l_T| = mu l_n: scaled to the cone of the new l_n,
   turned by dz, and scaled again. mu is that of the present slip speed. */
static void ChordSlide(ContactCompliance c, PetscInt p, PetscReal dz)
{
  const ComplianceFrame *f = &c->chord.frame[p];
  PetscReal             *l = &c->l[3 * p], w[3], length = PetscSqrtReal(l[1] * l[1] + l[2] * l[2]);
  const PetscReal        cone  = ComplianceGetPair(c, p, c->weight, w).mu * PetscMax(0, l[0]);
  const PetscReal        scale = length > 0 ? cone / length : 0;

  l[1]   = scale * l[1] - f->e[1] * dz;
  l[2]   = scale * l[2] + f->e[0] * dz;
  length = PetscSqrtReal(l[1] * l[1] + l[2] * l[2]);
  for (int d = 1; d < 3; d++) l[d] *= length > 0 ? cone / length : 0;
}

/* Whether friction of a pair drives its slip, as a root of v_x + c l_x has it that is no solution */
static inline PetscBool ChordDrives(const PetscReal l[3], const PetscReal v[3])
{
  return l[1] * v[1] + l[2] * v[2] > 0 ? PETSC_TRUE : PETSC_FALSE;
}

/* Adds dz */
static void ChordTake(ContactCompliance c, const PetscReal dz[])
{
  for (PetscInt p = 0; p < c->n; p++) {
    const ComplianceFrame *f    = &c->chord.frame[p];
    const PetscReal       *z    = &dz[4 * p];
    PetscReal             *l    = &c->l[3 * p], d[2];
    const PetscBool        weak = f->c >= COMPLIANCE_WEAK || ChordDrives(l, &c->v[3 * p]) ? PETSC_TRUE : PETSC_FALSE;

    if (c->status[p] == CONTACT_OPEN) continue;
    if (c->status[p] == CONTACT_SLIP && weak) ComplianceTurn(c, p, d);
    l[0] += z[0];
    if (c->status[p] == CONTACT_SLIP && !weak) ChordSlide(c, p, z[1]);
    for (int i = 0; i < 2 && c->status[p] == CONTACT_SLIP && weak; i++) l[1 + i] = d[i] * l[0];
    if (c->status[p] != CONTACT_STICK) continue;
    l[1] += f->e[0] * (z[3] - f->mu * z[0]) - f->e[1] * z[2];
    l[2] += f->e[1] * (z[3] - f->mu * z[0]) + f->e[0] * z[2];
  }
}

/* Friction of pairs whose slip is long beside it, turned to where it is along the slip that it leaves, v_T + c l_T = 0
   by the pair's own compliance alone: one group of pairs after the other, at the v that those before have left. Turned
   at the v before the iteration they contract only as the largest eigenvalue of W kappa over c, some 50 over 300 */
static void ChordTurn(ContactCompliance c)
{
  PetscReal more[2 * CHORD_GROUP];
  PetscInt  column[2 * CHORD_GROUP], n = 0;

  for (PetscInt p = 0; p < c->n; p++) {
    const PetscReal *v = &c->v[3 * p], own = ComplianceTangent(c, p);
    PetscReal       *l        = &c->l[3 * p], q[2], length;
    const PetscReal  friction = PetscSqrtReal(l[1] * l[1] + l[2] * l[2]);

    if (c->status[p] != CONTACT_SLIP || !(friction > 0)) continue;
    if (!(v[1] * v[1] + v[2] * v[2] > PetscSqr(CHORD_LONG * friction))) continue;
    for (int i = 0; i < 2; i++) q[i] = own * l[1 + i] - v[1 + i];
    length = PetscSqrtReal(q[0] * q[0] + q[1] * q[1]);
    for (int i = 0; i < 2 && length > 0; i++) {
      const PetscReal turned = friction * q[i] / length;

      column[n] = 3 * p + 1 + i;
      more[n++] = c->kappa[p] * (turned - l[1 + i]);
      l[1 + i]  = turned;
    }
    if (n < 2 * CHORD_GROUP) continue;
    ComplianceAddColumns(3 * c->n, c->W, n, column, more, c->v);
    n = 0;
  }
  ComplianceAddColumns(3 * c->n, c->W, n, column, more, c->v);
}

/* Whether new factors, after which one or two iterations are enough, take less time than the iterations that are left
   at the rate of the last one, log(goal / now) / log(now / last); a residual that does not fall has no end, and asks
   for new ones */
static PetscBool ChordIsWorth(const ContactCompliance c, const ComplianceMiss *miss, PetscReal last)
{
  const PetscReal goal = c->rtol * miss->scale + miss->noise, rate = miss->largest / last;

  if (!(rate < 1)) return PETSC_TRUE;
  return PetscLogReal(goal / miss->largest) / PetscLogReal(rate) > 2 + (PetscReal)c->chord.m / CHORD_WORTH
           ? PETSC_TRUE
           : PETSC_FALSE;
}

/* Factors for the present statuses, renewed where the border is too large or that is worth it; *good = false where
   there are none, and where dual.c costs less than new ones */
static PetscErrorCode ChordPrepare(ContactCompliance c, PetscBool worth, PetscInt *renewals, PetscInt *slow,
                                   PetscBool *good)
{
  PetscBool dual;

  PetscFunctionBeginUser;
  *good = PETSC_FALSE;
  if (!worth && *slow < CHORD_PATIENCE) PetscCall(ComplianceChordBorder(c, good));
  if (*good) PetscFunctionReturn(0);
  PetscCall(ComplianceDualServes(c, &dual));
  if (dual) PetscFunctionReturn(0);
  if ((*renewals)++ < CHORD_RENEWALS) {
    *slow = 0;
    PetscCall(ComplianceChordRenew(c));
  }
  PetscCall(ComplianceChordBorder(c, good));
  PetscFunctionReturn(0);
}

/* Keeps the best l that solves the laws; *done = that is as good as rounding allows, or falls no more */
static PetscErrorCode ChordKeep(ContactCompliance c, const ComplianceMiss *miss, PetscReal last, ComplianceMiss *best,
                                PetscBool *done)
{
  PetscFunctionBeginUser;
  *done = PETSC_FALSE;
  if (ComplianceIsSolved(c, miss) && (best->worst == CHORD_NONE || miss->largest < best->largest)) {
    *best = *miss;
    PetscCall(PetscArraycpy(c->best, c->l, 3 * c->n));
  }
  if (best->worst == CHORD_NONE) PetscFunctionReturn(0);
  if (best->largest <= PetscMin(c->rtol, CHORD_BEYOND * c->rtol * c->rtol) * best->scale + best->noise ||
      !(miss->norm < CHORD_SLOW * last))
    *done = PETSC_TRUE;
  PetscFunctionReturn(0);
}

/* v at l and its natural map. After an iteration friction is turned at that v where W stays in the cache of a core:
   that takes two columns of a pair, of many pairs as long as a whole product, and more than an iteration on few bytes
   of W */
static PetscErrorCode ChordMove(ContactCompliance c, PetscBool turns, ComplianceMiss *miss)
{
  PetscFunctionBeginUser;
  if (ComplianceNearServes(c)) {
    PetscCall(ComplianceNearMove(c, miss));
    PetscFunctionReturn(0);
  }
  PetscCall(ComplianceMove(c));
  if (turns) ChordTurn(c);
  ComplianceMeasure(c, miss);
  PetscFunctionReturn(0);
}

/* Ends with the iterate of least miss, which need not be the last. */
PetscErrorCode ComplianceChordIterate(ContactCompliance c, ComplianceMiss *miss)
{
  PetscInt       slow = 0, renewals = 0;
  PetscBool      good = PETSC_TRUE, worth = PETSC_FALSE, done;
  ComplianceMiss best = {.worst = CHORD_NONE};

  PetscFunctionBeginUser;
  PetscCall(ChordMove(c, PETSC_FALSE, miss));
  PetscCall(ChordKeep(c, miss, PETSC_MAX_REAL, &best, &done));
  c->chord.n_mixed = -1;
  for (PetscInt it = 0; it < CHORD_MAX_IT && slow <= CHORD_PATIENCE && !done; it++) {
    const ComplianceMiss last = *miss;

    if (ChordChoose(c)) c->chord.n_mixed = -1;
    PetscCall(ChordPrepare(c, worth, &renewals, &slow, &good));
    if (!good) break;
    PetscCall(PetscArraycpy(c->v0, c->l, 3 * c->n));
    PetscCall(ComplianceChordSolve(c, c->chord.z));
    ChordTake(c, c->chord.z);
    ComplianceMix(c, c->v0);
    PetscCall(ChordMove(c, PETSC_TRUE, miss));
    c->report.iterations++;
    slow += !(miss->norm < CHORD_SLOW * last.norm);
    worth = ChordIsWorth(c, miss, last.largest);
    PetscCall(ChordKeep(c, miss, last.norm, &best, &done));
  }
  if (best.worst == CHORD_NONE || miss->largest <= best.largest) PetscFunctionReturn(0);
  PetscCall(PetscArraycpy(c->l, c->best, 3 * c->n));
  PetscCall(ChordMove(c, PETSC_FALSE, miss));
  *miss = best;
  PetscFunctionReturn(0);
}
