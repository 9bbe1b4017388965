/*
   Newton's method with factors that stay from step to step. A closed pair has the force

      slip   l = (1, d) l_n,     stick  l = (1, d) l_n + (0, x),     d near -mu e, e the direction of slip, x [2]

   and the rows v_n = 0, and v_T = 0 where it sticks. With d held the matrix A of these unknowns and rows is W kappa T on a
   set of indices, and statuses change the set alone. LU factors of a base set serve all near it: indices that join (B)
   and that leave (D) border it,

      [A0   A_0B  E_D] [x0 ]   [b0 ]
      [A_B0 A_BB  0  ] [x_B] = [b_B]      solved by the Schur complement on A0, of as many rows as indices changed
      [E_D' 0     0  ] [y  ]   [0  ]

   (P. E. Gill, W. Murray, M. A. Saunders, M. H. Wright, Math. Program. 45, 1989, 437). An iteration solves A dx = -v; then sliding
   pairs turn their friction to where they slide. Alone that contracts by mu l_n / |slip| times compliances, which all pairs turning
   together make as large as 1; mix.c makes it converge there too. Where it does not, newton.c follows.
*/
#include "complianceimpl.h"

#define CHORD_MAX_IT   40
#define CHORD_BEYOND   1e9   /* times the square of the tolerance: what is solved is made as good, 1e-15 for 1e-12 */
#define CHORD_NONE     -2    /* pair of the worst residual where no iterate solves the laws */
#define CHORD_RENEWALS 2     /* of the factors in a step: one costs as much as a step of newton.c */
#define CHORD_SLOW     0.5   /* residual over the one before, of an iteration without change of status */
#define CHORD_PATIENCE 4     /* slow iterations */
#define CHORD_SHARE    8     /* a base of m indices is bordered by m / CHORD_SHARE at most */
#define CHORD_LEAST    8     /* or by this */
#define CHORD_PIVOT    1e-10 /* smallest pivot beside the largest, below which newton.c shifts the matrix */

/* A(i, j) */
static inline PetscReal ChordEntry(const ContactCompliance c, PetscInt i, PetscInt j)
{
  const PetscInt   N = 3 * c->n, p = j / 3;
  const PetscReal *W = &c->W[j * N + i], *d = &c->chord.turn[2 * p];

  return c->kappa[p] * (j % 3 ? W[0] : W[0] + d[0] * W[N] + d[1] * W[2 * N]);
}

/* Smallest pivot beside the largest */
static PetscReal ChordPivotRatio(PetscInt m, const PetscReal LU[])
{
  PetscReal least = m ? PETSC_MAX_REAL : 1, largest = m ? 0 : 1;

  for (PetscInt i = 0; i < m * m; i += m + 1) {
    least   = PetscMin(least, PetscAbsReal(LU[i]));
    largest = PetscMax(largest, PetscAbsReal(LU[i]));
  }
  return least / largest;
}

static PetscErrorCode ChordFactor(PetscInt m, PetscReal A[], PetscBLASInt pivot[], PetscBool *good)
{
  const PetscBLASInt rows = (PetscBLASInt)m;
  PetscBLASInt       info = 0;

  PetscFunctionBeginUser;
  if (m) PetscCallBLAS("LAPACKgetrf", LAPACKgetrf_(&rows, &rows, A, &rows, pivot, &info));
  PetscCheck(info >= 0, PETSC_COMM_SELF, PETSC_ERR_LIB, "LAPACK getrf: info %d", (int)info);
  *good = ChordPivotRatio(m, A) > CHORD_PIVOT ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(0);
}

static PetscErrorCode ChordBackSolve(PetscInt m, const PetscReal LU[], const PetscBLASInt pivot[], PetscReal x[])
{
  const PetscBLASInt rows = (PetscBLASInt)m, one = 1;
  PetscBLASInt       info = 0;

  PetscFunctionBeginUser;
  if (m)
    PetscCallBLAS("LAPACKgetrs",
                  LAPACKgetrs_("N", &rows, &one, (PetscReal *)LU, &rows, (PetscBLASInt *)pivot, x, &rows, &info));
  PetscCheck(!info, PETSC_COMM_SELF, PETSC_ERR_LIB, "LAPACK getrs: info %d", (int)info);
  PetscFunctionReturn(0);
}

/* The base becomes the indices c->chord.index [m], with the directions `turn`; not good = singular, no base then */
PetscErrorCode ComplianceChordSetBase(ContactCompliance c)
{
  ComplianceChord *h = &c->chord;

  PetscFunctionBeginUser;
  h->most = PetscMin(3 * c->n, PetscMax(CHORD_LEAST, h->m / CHORD_SHARE));
  PetscCall(PetscFree5(h->LU, h->V, h->S, h->pivot, h->small));
  PetscCall(PetscMalloc5(h->m * h->m, &h->LU, h->most * h->m, &h->V, h->most * h->most, &h->S, h->m, &h->pivot, h->most,
                         &h->small));
  for (PetscInt i = 0; i < 3 * c->n; i++) h->place[i] = h->column[i] = -1;
  for (PetscInt j = 0; j < h->m; j++) {
    h->place[h->index[j]] = j;
    for (PetscInt i = 0; i < h->m; i++) h->LU[j * h->m + i] = ChordEntry(c, h->index[i], h->index[j]);
  }
  h->n_columns = 0;
  h->n_border  = -1;
  c->report.factors++;
  PetscCall(ChordFactor(h->m, h->LU, h->pivot, &h->exists));
  PetscFunctionReturn(0);
}

/* Closed pairs, and those that stick, as indices in ascending order */
static PetscInt ChordWant(const ContactCompliance c, PetscInt want[])
{
  PetscInt n = 0;

  for (PetscInt p = 0; p < c->n; p++)
    for (PetscInt i = 0; i < (c->status[p] == CONTACT_OPEN ? 0 : c->status[p] == CONTACT_STICK ? 3 : 1); i++)
      want[n++] = 3 * p + i;
  return n;
}

/* A base of the present set, friction turned as it is now */
static PetscErrorCode ChordRenew(ContactCompliance c)
{
  ComplianceChord *h = &c->chord;

  PetscFunctionBeginUser;
  h->n_mixed = -1;
  h->m = ChordWant(c, h->index);
  for (PetscInt p = 0; p < c->n; p++)
    for (PetscInt i = 0; i < 2; i++)
      h->turn[2 * p + i] = c->status[p] == CONTACT_SLIP && c->l[3 * p] > 0 ? c->l[3 * p + 1 + i] / c->l[3 * p] : 0;
  PetscCall(ComplianceChordSetBase(c));
  PetscFunctionReturn(0);
}

/* A0^-1 times the column that index j adds: its column of A, or its unit vector where it is in the base; from the
   store, or NULL where that is full */
PetscErrorCode ComplianceChordColumn(ContactCompliance c, PetscInt j, const PetscReal **v)
{
  ComplianceChord *h = &c->chord;

  PetscFunctionBeginUser;
  *v = NULL;
  if (h->column[j] < 0) {
    PetscReal *x = &h->V[h->n_columns * h->m];

    if (h->n_columns == h->most) PetscFunctionReturn(0);
    h->column[j] = h->n_columns++;
    for (PetscInt i = 0; i < h->m; i++) x[i] = h->place[j] < 0 ? ChordEntry(c, h->index[i], j) : 0;
    if (h->place[j] >= 0) x[h->place[j]] = 1;
    PetscCall(ChordBackSolve(h->m, h->LU, h->pivot, x));
  }
  *v = &h->V[h->column[j] * h->m];
  PetscFunctionReturn(0);
}

/* Row of index i times a vector of the base */
static PetscReal ChordRow(const ContactCompliance c, PetscInt i, const PetscReal x[])
{
  const ComplianceChord *h   = &c->chord;
  PetscReal              sum = 0;

  if (h->place[i] >= 0) return x[h->place[i]];
  for (PetscInt j = 0; j < h->m; j++) sum += ChordEntry(c, i, h->index[j]) * x[j];
  return sum;
}

/* Indices that differ between the base and `want`; false where they are too many */
static PetscBool ChordCompare(ContactCompliance c, PetscInt n_want, const PetscInt want[], PetscInt *n)
{
  ComplianceChord *h = &c->chord;

  *n = 0;
  for (PetscInt a = 0, b = 0; a < n_want || b < h->m;) {
    const PetscInt i = a < n_want ? want[a] : 3 * c->n, j = b < h->m ? h->index[b] : 3 * c->n;

    if (i <= j) a++;
    if (j <= i) b++;
    if (i == j) continue;
    if (*n == h->most) return PETSC_FALSE;
    h->next[(*n)++] = PetscMin(i, j);
  }
  return PETSC_TRUE;
}

/* The border for the present statuses; *good = the factors serve */
static PetscErrorCode ChordBorder(ContactCompliance c, PetscBool *good)
{
  ComplianceChord *h = &c->chord;
  PetscInt         n, n_want = ChordWant(c, h->want);
  PetscBool        same;

  PetscFunctionBeginUser;
  *good = h->exists && ChordCompare(c, n_want, h->want, &n) ? PETSC_TRUE : PETSC_FALSE;
  if (!*good) PetscFunctionReturn(0);
  same = n == h->n_border ? PETSC_TRUE : PETSC_FALSE;
  if (same) PetscCall(PetscArraycmp(h->next, h->border, n, &same));
  if (same) PetscFunctionReturn(0);
  h->n_border = n;
  for (PetscInt b = 0; b < n; b++) {
    const PetscReal *v;
    const PetscInt   j = h->border[b] = h->next[b];

    PetscCall(ComplianceChordColumn(c, j, &v));
    if (!v) *good = PETSC_FALSE;
    for (PetscInt a = 0; a < n && v; a++) {
      const PetscInt i = h->next[a];

      h->S[b * n + a] = (h->place[i] < 0 && h->place[j] < 0 ? ChordEntry(c, i, j) : 0) - ChordRow(c, i, v);
    }
  }
  if (*good) PetscCall(ChordFactor(n, h->S, h->small, good));
  if (!*good) h->n_border = -1;
  PetscFunctionReturn(0);
}

/* A dx = -v on the present set; dx [3n], zero elsewhere */
static PetscErrorCode ChordSolve(ContactCompliance c, PetscReal dx[])
{
  ComplianceChord *h = &c->chord;
  PetscReal       *b = h->b, *s = h->s;

  PetscFunctionBeginUser;
  for (PetscInt j = 0; j < h->m; j++) b[j] = -c->v[h->index[j]];
  PetscCall(ChordBackSolve(h->m, h->LU, h->pivot, b));
  for (PetscInt k = 0; k < h->n_border; k++) {
    const PetscInt i = h->border[k];

    s[k] = (h->place[i] < 0 ? -c->v[i] : 0) - ChordRow(c, i, b);
  }
  PetscCall(ChordBackSolve(h->n_border, h->S, h->small, s));
  for (PetscInt k = 0; k < h->n_border; k++) {
    const PetscReal *v = &h->V[h->column[h->border[k]] * h->m];

    for (PetscInt j = 0; j < h->m; j++) b[j] -= s[k] * v[j];
  }
  PetscCall(PetscArrayzero(dx, 3 * c->n));
  for (PetscInt j = 0; j < h->m; j++) dx[h->index[j]] = b[j];
  for (PetscInt k = 0; k < h->n_border; k++) dx[h->border[k]] = h->place[h->border[k]] < 0 ? s[k] : 0;
  PetscFunctionReturn(0);
}

/* A pair has the force l from now on, and v follows */
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

/* New statuses, true where there are any; a pair that opens loses its force at once, and one that starts to slide has the
   friction of its cone */
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

/* Adds dx: friction of sliding pairs is turned to where they slide at the present v */
static void ChordTake(ContactCompliance c, const PetscReal dx[])
{
  for (PetscInt p = 0; p < c->n; p++) {
    PetscReal *l = &c->l[3 * p], d[2];

    if (c->status[p] == CONTACT_OPEN) continue;
    ComplianceTurn(c, p, d);
    l[0] += dx[3 * p];
    for (PetscInt i = 0; i < 2; i++)
      l[1 + i] = c->status[p] == CONTACT_SLIP ? d[i] * l[0]
                                              : l[1 + i] + c->chord.turn[2 * p + i] * dx[3 * p] + dx[3 * p + 1 + i];
  }
}

/* Factors for the present statuses, renewed where the border is too large or they no longer contract and no dual.c costs less */
static PetscErrorCode ChordPrepare(ContactCompliance c, PetscInt *renewals, PetscInt *slow, PetscBool *good)
{
  PetscBool dual;

  PetscFunctionBeginUser;
  PetscCall(ChordBorder(c, good));
  if (*renewals == CHORD_RENEWALS || (*good && *slow < CHORD_PATIENCE)) PetscFunctionReturn(0);
  PetscCall(ComplianceDualServes(c, &dual));
  if (dual) *good = PETSC_FALSE;
  if (dual) PetscFunctionReturn(0);
  (*renewals)++;
  *slow = 0;
  PetscCall(ChordRenew(c));
  PetscCall(ChordBorder(c, good));
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

PetscErrorCode ComplianceChordIterate(ContactCompliance c, ComplianceMiss *miss)
{
  PetscInt       slow = 0, renewals = 0;
  PetscBool      good = PETSC_TRUE, done;
  ComplianceMiss best = {.worst = CHORD_NONE};

  PetscFunctionBeginUser;
  PetscCall(ComplianceMove(c));
  ComplianceMeasure(c, miss);
  PetscCall(ChordKeep(c, miss, PETSC_MAX_REAL, &best, &done));
  c->chord.n_mixed = -1;
  for (PetscInt it = 0; it < CHORD_MAX_IT && slow <= CHORD_PATIENCE && !done; it++) {
    const PetscReal last = miss->norm;

    if (ChordChoose(c)) c->chord.n_mixed = -1;
    PetscCall(ChordPrepare(c, &renewals, &slow, &good));
    if (!good) break;
    PetscCall(PetscArraycpy(c->v0, c->l, 3 * c->n));
    PetscCall(ChordSolve(c, c->l0));
    ChordTake(c, c->l0);
    ComplianceMix(c, c->v0);
    PetscCall(ComplianceMove(c));
    ComplianceMeasure(c, miss);
    c->report.iterations++;
    slow += !(miss->norm < CHORD_SLOW * last);
    PetscCall(ChordKeep(c, miss, last, &best, &done));
  }
  if (best.worst == CHORD_NONE || miss->largest <= best.largest) PetscFunctionReturn(0);
  *miss = best;
  PetscCall(PetscArraycpy(c->l, c->best, 3 * c->n));
  PetscCall(ComplianceMove(c));
  PetscFunctionReturn(0);
}
