/*
   The linear system of chord.c: its indices in the frames of their pairs, the factors of a base set, and what borders
   them. Index 4 p + kind belongs to pair p; kinds 0 to 3 are those of chord.c's table.

      A(i, j) = r_i' (W kappa) t_j + c [i = j of kind 1],   r_i the row of index i at its pair, t_j the force of a unit
      of j

   Without unit, since W kappa has none. Base and border: with A0 the base's matrix, V = A0^-1 [A_0B, E_D] and the
   Schur complement S = [A_BB, 0; 0, 0] - [A_B0; E_D'] V, one row and column for each index that joined (B) or left
   (D).
*/
#include "base/algebra/versions.h"
#include "contact/compliance/complianceimpl.h"

/* a base of m indices is bordered by m / CHORD_SHARE at most: a column of V costs a solution, 2 m^2 operations, so
   that these many cost m^3 / 4 beside the 2 m^3 / 3 of new factors */
#define CHORD_SHARE 8
#define CHORD_LEAST 8 /* or by this */
/* a base of so many indices has factors in single precision, where pivots of this ratio leave these two figures */
#define CHORD_SINGLE       400
#define CHORD_SINGLE_PIVOT 1e-6
#define CHORD_PIVOT        1e-10 /* smallest pivot beside the largest, below which newton.c shifts the matrix */

/* Row of an index at its pair */
static inline void ChordRow(const ContactCompliance c, PetscInt i, PetscReal r[3])
{
  const ComplianceFrame *f    = &c->chord.frame[i / 4];
  const PetscInt         kind = i % 4;

  r[0] = kind == 0;
  r[1] = kind == 0 ? 0 : kind == 3 ? f->e[0] : -f->e[1];
  r[2] = kind == 0 ? 0 : kind == 3 ? f->e[1] : f->e[0];
}

/* l of a unit of an index: friction follows the normal force */
static inline void ChordAlong(const ContactCompliance c, PetscInt j, PetscReal t[3])
{
  const ComplianceFrame *f = &c->chord.frame[j / 4];

  ChordRow(c, j, t);
  if (j % 4) return;
  for (int d = 0; d < 2; d++) t[1 + d] = -f->mu * f->e[d];
}

/* y := what a unit of index j moves, [3 n] */
VERSIONS
static void ChordImage(const ContactCompliance c, PetscInt j, PetscReal y[])
{
  const PetscInt   N = 3 * c->n, p = j / 4;
  const PetscReal *W = &c->W[3 * p * N];
  PetscReal        t[3];

  ChordAlong(c, j, t);
  for (int d = 0; d < 3; d++) t[d] *= c->kappa[p];
  for (PetscInt i = 0; i < N; i++) y[i] = t[0] * W[i] + t[1] * W[N + i] + t[2] * W[2 * N + i];
}

/* A(i, j), y being the image of j */
static inline PetscReal ChordEntry(const ContactCompliance c, PetscInt i, PetscInt j, const PetscReal y[])
{
  const PetscReal *at = &y[3 * (i / 4)];
  PetscReal        r[3];

  ChordRow(c, i, r);
  return r[0] * at[0] + r[1] * at[1] + r[2] * at[2] + (i == j && i % 4 == 1 ? c->chord.frame[i / 4].c : 0);
}

/* A dense system of the border, factored */
static PetscErrorCode ChordFactorBorder(PetscInt m, PetscReal S[], PetscBLASInt pivot[], PetscBool *good)
{
  const PetscBLASInt rows  = (PetscBLASInt)m;
  PetscBLASInt       info  = 0;
  PetscReal          least = 1, largest = 1;

  PetscFunctionBeginUser;
  if (m) PetscCallBLAS("LAPACKgetrf", LAPACKgetrf_(&rows, &rows, S, &rows, pivot, &info));
  PetscCheck(info >= 0, PETSC_COMM_SELF, PETSC_ERR_LIB, "LAPACK getrf: info %d", (int)info);
  for (PetscInt i = 0; i < m * m; i += m + 1) {
    least   = i ? PetscMin(least, PetscAbsReal(S[i])) : PetscAbsReal(S[i]);
    largest = i ? PetscMax(largest, PetscAbsReal(S[i])) : PetscAbsReal(S[i]);
  }
  *good = least > CHORD_PIVOT * largest ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(0);
}

static PetscErrorCode ChordSolveBorder(PetscInt m, const PetscReal S[], const PetscBLASInt pivot[], PetscReal x[])
{
  const PetscBLASInt rows = (PetscBLASInt)m, one = 1;
  PetscBLASInt       info = 0;

  PetscFunctionBeginUser;
  if (m)
    PetscCallBLAS("LAPACKgetrs",
                  LAPACKgetrs_("N", &rows, &one, (PetscReal *)S, &rows, (PetscBLASInt *)pivot, x, &rows, &info));
  PetscCheck(!info, PETSC_COMM_SELF, PETSC_ERR_LIB, "LAPACK getrs: info %d", (int)info);
  PetscFunctionReturn(0);
}

/* Columns that a base of m indices may be bordered by; V is kept for them, in the order they were asked for, until
   the base is renewed */
static inline PetscInt ChordMost(PetscInt m)
{
  return PetscMax(CHORD_LEAST, m / CHORD_SHARE);
}

/* Room for a base of m indices, one at least, and its borders: of a base of none PetscMalloc() makes V NULL, as where
   it is full */
static PetscErrorCode ChordReserve(ContactCompliance c)
{
  ComplianceChord *h = &c->chord;

  PetscFunctionBeginUser;
  h->most = ChordMost(h->m);
  if (h->LU && h->m <= h->room) PetscFunctionReturn(0);
  h->room = PetscMax(1, PetscMin(3 * c->n, h->m + h->m / 4));
  PetscCall(PetscFree6(h->LU, h->V, h->S, h->row, h->at, h->small));
  PetscCall(PetscMalloc6(h->room * h->room, &h->LU, ChordMost(h->room) * h->room, &h->V, PetscSqr(ChordMost(h->room)),
                         &h->S, 3 * h->room, &h->row, h->room, &h->at, ChordMost(h->room), &h->small));
  PetscFunctionReturn(0);
}

/* Column j of the base */
static void ChordSetColumn(ContactCompliance c, PetscInt j)
{
  ComplianceChord *h = &c->chord;
  PetscReal       *A = h->single ? h->b : &h->LU[j * h->m];

  ChordImage(c, h->index[j], c->force);
  for (PetscInt i = 0; i < h->m; i++) {
    const PetscReal *y = &c->force[h->at[i]], *r = &h->row[3 * i];

    A[i] = r[0] * y[0] + r[1] * y[1] + r[2] * y[2];
  }
  if (h->index[j] % 4 == 1) A[j] += h->frame[h->index[j] / 4].c;
  for (PetscInt i = 0; i < h->m && h->single; i++) ((float *)h->LU)[j * h->m + i] = (float)A[i];
}

/* Factors of the base; not good = singular */
static PetscBool ChordFactor(ContactCompliance c)
{
  ComplianceChord *h = &c->chord;

  for (PetscInt j = 0; j < h->m; j++) ChordSetColumn(c, j);
  c->report.factors++;
  if (h->single) return ComplianceSingleFactor(h->m, (float *)h->LU) > CHORD_SINGLE_PIVOT ? PETSC_TRUE : PETSC_FALSE;
  return ComplianceLUFactor(h->m, h->LU) > CHORD_PIVOT ? PETSC_TRUE : PETSC_FALSE;
}

/* The base becomes the indices c->chord.index [m], in the frames there are; not good = singular, no base then */
PetscErrorCode ComplianceChordSetBase(ContactCompliance c)
{
  ComplianceChord *h = &c->chord;

  PetscFunctionBeginUser;
  PetscCall(ChordReserve(c));
  for (PetscInt i = 0; i < 4 * c->n; i++) h->place[i] = h->column[i] = -1;
  for (PetscInt j = 0; j < h->m; j++) {
    h->place[h->index[j]] = j;
    h->at[j]              = 3 * (h->index[j] / 4);
    ChordRow(c, h->index[j], &h->row[3 * j]);
  }
  h->n_columns = 0;
  h->n_border  = -1;
  h->single    = h->m >= CHORD_SINGLE ? PETSC_TRUE : PETSC_FALSE;
  h->exists    = ChordFactor(c);
  if (h->exists || !h->single) PetscFunctionReturn(0);
  h->single = PETSC_FALSE;
  h->exists = ChordFactor(c);
  PetscFunctionReturn(0);
}

/* Indices of the present statuses in ascending order: of a closed pair 0; of one that slides 1, unless it is weak; of
   one that sticks 2 and 3 */
static PetscInt ChordWant(const ContactCompliance c, PetscInt want[])
{
  PetscInt n = 0;

  for (PetscInt p = 0; p < c->n; p++) {
    if (c->status[p] == CONTACT_OPEN) continue;
    want[n++] = 4 * p;
    if (c->status[p] == CONTACT_SLIP && c->chord.frame[p].c < COMPLIANCE_WEAK) want[n++] = 4 * p + 1;
    if (c->status[p] == CONTACT_STICK) want[n++] = 4 * p + 2;
    if (c->status[p] == CONTACT_STICK) want[n++] = 4 * p + 3;
  }
  return n;
}

/* The frames of all pairs at the present l, v: e along the trial slip, mu of the present slip speed, and c = |v_T| /
   (mu l_n), without unit, capped at COMPLIANCE_WEAK; those that are open belong to the weak */
static void ChordTurnFrames(ContactCompliance c)
{
  for (PetscInt p = 0; p < c->n; p++) {
    ComplianceFrame  *f = &c->chord.frame[p];
    const PetscReal  *v = &c->v[3 * p];
    PetscReal         w[3];
    const CoulombPair pair   = ComplianceGetPair(c, p, c->weight, w);
    const PetscReal   length = CoulombTrial(&pair, &c->l[3 * p], w, f->e), cone = pair.mu * c->l[3 * p];

    for (int d = 0; d < 2; d++) f->e[d] = length > 0 ? f->e[d] / length : 1 - d;
    f->mu = pair.mu + pair.rise;
    f->c  = c->status[p] == CONTACT_STICK ? 0 : COMPLIANCE_WEAK;
    if (c->status[p] == CONTACT_SLIP && cone > 0)
      f->c = PetscMin(COMPLIANCE_WEAK, PetscSqrtReal(v[1] * v[1] + v[2] * v[2]) / cone);
  }
}

/* A base of the present set, in frames as they are now */
PetscErrorCode ComplianceChordRenew(ContactCompliance c)
{
  ComplianceChord *h = &c->chord;

  PetscFunctionBeginUser;
  h->n_mixed = -1;
  ChordTurnFrames(c);
  h->m = ChordWant(c, h->index);
  PetscCall(ComplianceChordSetBase(c));
  PetscFunctionReturn(0);
}

/* A0^-1 times the columns that indices [n] add: their columns of A, or unit vectors of those in the base. Those that
   are not in the store join it together, for which the factors are read once; *good = there is room for them */
PetscErrorCode ComplianceChordColumns(ContactCompliance c, PetscInt n, const PetscInt index[], PetscBool *good)
{
  ComplianceChord *h     = &c->chord;
  const PetscInt   first = h->n_columns;
  PetscInt         more  = 0;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < n; k++) more += h->column[index[k]] < 0;
  *good = first + more <= h->most ? PETSC_TRUE : PETSC_FALSE;
  for (PetscInt k = 0; k < n && *good; k++) {
    const PetscInt j = index[k];
    PetscReal     *x = &h->V[h->n_columns * h->m];

    if (h->column[j] >= 0) continue;
    h->column[j] = h->n_columns++;
    ChordImage(c, j, c->force);
    for (PetscInt i = 0; i < h->m; i++) x[i] = h->place[j] < 0 ? ChordEntry(c, h->index[i], j, c->force) : 0;
    if (h->place[j] >= 0) x[h->place[j]] = 1;
  }
  ComplianceChordBaseSolve(c, h->n_columns - first, &h->V[first * h->m]);
  PetscFunctionReturn(0);
}

/* f := kappa times the forces of a vector of the base, [3 n] */
static void ChordForce(const ContactCompliance c, const PetscReal x[], PetscReal f[])
{
  const ComplianceChord *h = &c->chord;

  for (PetscInt i = 0; i < 3 * c->n; i++) f[i] = 0;
  for (PetscInt j = 0; j < h->m; j++) {
    const PetscInt p = h->index[j] / 4;
    PetscReal      t[3];

    ChordAlong(c, h->index[j], t);
    for (int d = 0; d < 3; d++) f[3 * p + d] += c->kappa[p] * t[d] * x[j];
  }
}

/* Row of index i times a vector x of the base, whose forces are f */
static PetscReal ChordRowTimes(const ContactCompliance c, PetscInt i, const PetscReal x[], const PetscReal f[])
{
  const PetscBLASInt N = (PetscBLASInt)(3 * c->n), one = 1;
  PetscReal          r[3], sum                         = 0;

  if (c->chord.place[i] >= 0) return x[c->chord.place[i]];
  ChordRow(c, i, r);
  for (int d = 0; d < 3; d++)
    if (r[d] != 0) sum += r[d] * BLASdot_(&N, &c->W[(3 * (i / 4) + d) * N], &one, f, &one);
  return sum;
}

/* Indices that differ between the base and `want`; false where they are too many */
static PetscBool ChordCompare(ContactCompliance c, PetscInt n_want, const PetscInt want[], PetscInt *n)
{
  ComplianceChord *h = &c->chord;

  *n = 0;
  for (PetscInt a = 0, b = 0; a < n_want || b < h->m;) {
    const PetscInt i = a < n_want ? want[a] : 4 * c->n, j = b < h->m ? h->index[b] : 4 * c->n;

    if (i <= j) a++;
    if (j <= i) b++;
    if (i == j) continue;
    if (*n == h->most) return PETSC_FALSE;
    h->next[(*n)++] = PetscMin(i, j);
  }
  return PETSC_TRUE;
}

/* Column b of the Schur complement */
static void ChordBorderColumn(ContactCompliance c, PetscInt n, PetscInt b)
{
  ComplianceChord *h = &c->chord;
  const PetscInt   j = h->border[b];
  const PetscReal *v = &h->V[h->column[j] * h->m];

  ChordImage(c, j, c->force);
  for (PetscInt a = 0; a < n; a++) {
    const PetscInt i = h->border[a];

    h->S[b * n + a] = h->place[i] < 0 && h->place[j] < 0 ? ChordEntry(c, i, j, c->force) : 0;
  }
  ChordForce(c, v, c->force);
  for (PetscInt a = 0; a < n; a++) h->S[b * n + a] -= ChordRowTimes(c, h->border[a], v, c->force);
}

/* The border for the present statuses; *good = the factors serve */
PetscErrorCode ComplianceChordBorder(ContactCompliance c, PetscBool *good)
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
  PetscCall(PetscArraycpy(h->border, h->next, n));
  PetscCall(ComplianceChordColumns(c, n, h->border, good));
  for (PetscInt b = 0; b < n && *good; b++) ChordBorderColumn(c, n, b);
  if (*good) PetscCall(ChordFactorBorder(n, h->S, h->small, good));
  if (!*good) h->n_border = -1;
  PetscFunctionReturn(0);
}

/* c of a pair at the present l, v; 0 without friction */
static PetscReal ChordPresent(const ContactCompliance c, PetscInt p)
{
  const PetscReal *v = &c->v[3 * p], *l = &c->l[3 * p];
  const PetscReal  friction = PetscSqrtReal(l[1] * l[1] + l[2] * l[2]);

  return friction > 0 ? PetscSqrtReal(v[1] * v[1] + v[2] * v[2]) / friction : 0;
}

/* What index i has to make 0, m, at the present l, v: v_n, v_x, v_e, or v_x + c l_x with the present c = |v_T| /
   |l_T|, while the matrix has the c of the frame */
static PetscReal ChordMiss(const ContactCompliance c, PetscInt i)
{
  const PetscReal *v = &c->v[3 * (i / 4)], *l = &c->l[3 * (i / 4)];
  PetscReal        r[3], slip;

  if (i % 4 == 0) return v[0];
  ChordRow(c, i, r);
  if (i % 4 > 1) return r[1] * v[1] + r[2] * v[2];
  slip = ChordPresent(c, i / 4);
  return r[1] * (v[1] + slip * l[1]) + r[2] * (v[2] + slip * l[2]);
}

/* dz across the slip of pair p for the present c in place of the one held, over that for the one held, by its own row
   alone, (w + c) dz = what v_x has without dz and l_x, w = x'(W kappa) x: where c is large, others hardly feel dz */
static PetscReal ChordOwn(const ContactCompliance c, PetscInt p)
{
  const PetscReal held = c->chord.frame[p].c, present = ChordPresent(c, p), own = ComplianceTangent(c, p);

  return own + present > 0 ? (own + held) / (own + present) : 1;
}

/* A dz of the present set against what its rows miss; dz [4 n], m, zero elsewhere. b = A0^-1 b0, then S s = b_B -
   [A_B0; E_D'] b, then x0 = b - V s. b0 of a row that left is any, since y takes it up: 0, for a gap that has opened is
   large beside what the others miss, and would leave its rounding. Indices that left have dz = 0 to rounding by the
   border, and exactly 0 here. Those across slip then answer to their present c. */
PetscErrorCode ComplianceChordSolve(ContactCompliance c, PetscReal dz[])
{
  ComplianceChord *h = &c->chord;
  PetscReal       *b = h->b, *s = h->s;

  PetscFunctionBeginUser;
  for (PetscInt j = 0; j < h->m; j++) b[j] = -ChordMiss(c, h->index[j]);
  for (PetscInt k = 0; k < h->n_border; k++)
    if (h->place[h->border[k]] >= 0) b[h->place[h->border[k]]] = 0;
  ComplianceChordBaseSolve(c, 1, b);
  if (h->n_border) ChordForce(c, b, c->force);
  for (PetscInt k = 0; k < h->n_border; k++) {
    const PetscInt i = h->border[k];

    s[k] = (h->place[i] < 0 ? -ChordMiss(c, i) : 0) - ChordRowTimes(c, i, b, c->force);
  }
  PetscCall(ChordSolveBorder(h->n_border, h->S, h->small, s));
  for (PetscInt k = 0; k < h->n_border; k++) {
    const PetscReal *v = &h->V[h->column[h->border[k]] * h->m];

    for (PetscInt j = 0; j < h->m; j++) b[j] -= s[k] * v[j];
  }
  PetscCall(PetscArrayzero(dz, 4 * c->n));
  for (PetscInt j = 0; j < h->m; j++) dz[h->index[j]] = b[j];
  for (PetscInt k = 0; k < h->n_border; k++) dz[h->border[k]] = h->place[h->border[k]] < 0 ? s[k] : 0;
  for (PetscInt p = 0; p < c->n; p++)
    if (dz[4 * p + 1] != 0) dz[4 * p + 1] *= ChordOwn(c, p);
  PetscFunctionReturn(0);
}
