/* Lines of a vibration (lines.h) */
#include "lines.h"
#include "base/algebra/dense.h"
#include <complex.h>

#define LINES_MOST    12
#define LINES_FAINT   1e-3 /* of the strongest */
#define LINES_ORDER   8    /* |k| + |l| at most; numbers of a ratio */
#define LINES_NEAR    0.02 /* over the time: frequencies that are nearer are the same */
#define LINES_ROUNDS  3
#define LINES_PERIOD  20 /* periods of the strongest line, at least */
#define LINES_STEADY  0.1
#define LINES_NEWTON  12
#define LINES_COLUMNS (2 * LINES_MOST + 1)

/* A record, its middle at t = 0, the window, what lines leave of it */
typedef struct {
  PetscInt         n;
  const PetscReal *x;
  PetscReal       *w, *rest; /* [n] */
  PetscReal        dt;
} LineRecord;

/* Lines at hand: Hz; factors of cosines, of sines, and of 1 */
typedef struct {
  PetscInt  n;
  PetscReal freq[LINES_MOST], factor[LINES_COLUMNS];
} LineSet;

static PetscReal RecordTime(const LineRecord *r, PetscInt i)
{
  return ((PetscReal)i - 0.5 * (PetscReal)(r->n - 1)) * r->dt;
}

static PetscErrorCode LineRecordCreate(PetscInt n, const PetscReal x[], PetscReal dt, LineRecord *r)
{
  PetscFunctionBeginUser;
  *r = (LineRecord){.n = n, .x = x, .dt = dt};
  PetscCall(PetscMalloc2(n, &r->w, n, &r->rest));
  for (PetscInt i = 0; i < n; i++)
    r->w[i] = 0.5 - 0.5 * PetscCosReal(2 * PETSC_PI * (PetscReal)(i + 1) / (PetscReal)(n + 1));
  PetscFunctionReturn(0);
}

static PetscErrorCode LineRecordDestroy(LineRecord *r)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree2(r->w, r->rest));
  PetscFunctionReturn(0);
}

/* Radix-2 transform of n = 2^k numbers in place, sum z_j exp(-2 pi i j k / n) */
static void Transform(PetscInt n, PetscComplex z[])
{
  for (PetscInt i = 1, j = 0; i < n; i++) {
    PetscInt bit = n >> 1;

    for (; j & bit; bit >>= 1) j ^= bit;
    j ^= bit;
    if (i < j) {
      const PetscComplex other = z[i];

      z[i] = z[j];
      z[j] = other;
    }
  }
  for (PetscInt size = 2; size <= n; size *= 2)
    for (PetscInt k = 0; k < size / 2; k++) {
      const PetscComplex turn = cexp(-2 * PETSC_PI * I * (PetscReal)k / (PetscReal)size);

      for (PetscInt i = k; i < n; i += size) {
        const PetscComplex other = turn * z[i + size / 2];

        z[i + size / 2] = z[i] - other;
        z[i] += other;
      }
    }
}

/* The frequency, Hz, of the largest bin of what is left, four bins to each of the record */
static PetscErrorCode RecordPeak(const LineRecord *r, PetscReal *freq)
{
  PetscInt      size = 4, best = 0;
  PetscReal     largest = 0;
  PetscComplex *z;

  PetscFunctionBeginUser;
  while (size < 4 * r->n) size *= 2;
  PetscCall(PetscCalloc1(size, &z));
  for (PetscInt i = 0; i < r->n; i++) z[i] = r->w[i] * r->rest[i];
  Transform(size, z);
  for (PetscInt k = 3 * size / r->n + 1; k < size / 2; k++) {
    if (cabs(z[k]) <= largest) continue;
    largest = cabs(z[k]);
    best    = k;
  }
  PetscCall(PetscFree(z));
  *freq = (PetscReal)best / ((PetscReal)size * r->dt);
  PetscFunctionReturn(0);
}

/* Newton's method for the largest |S|^2, S = sum w x exp(-2 pi i f t), from a frequency near it, no further than width
   away */
static PetscReal RecordRefine(const LineRecord *r, PetscReal from, PetscReal width)
{
  PetscReal f = from;

  for (int it = 0; it < LINES_NEWTON; it++) {
    const PetscReal    a    = -2 * PETSC_PI;
    const PetscComplex turn = cexp(a * I * f * r->dt);
    PetscComplex       z = cexp(a * I * f * RecordTime(r, 0)), S[3] = {0, 0, 0};
    PetscReal          slope, bend, step;

    for (PetscInt i = 0; i < r->n; i++, z *= turn) {
      const PetscReal    t = a * RecordTime(r, i);
      const PetscComplex s = r->w[i] * r->rest[i] * z;

      S[0] += s;
      S[1] += t * s;
      S[2] += t * t * s;
    }
    slope = creal(conj(S[0]) * I * S[1]);
    bend  = creal(conj(S[1]) * S[1]) - creal(conj(S[0]) * S[2]);
    if (!(bend < 0)) break;
    step = -slope / bend;
    f    = PetscMin(from + width, PetscMax(from - width, f + step));
    if (PetscAbsReal(step) <= 1e-12 * f) break;
  }
  return f;
}

/* Cosines and sines of the lines at a time, and 1 */
static PetscInt SetWaves(const LineSet *set, PetscReal t, PetscReal wave[])
{
  for (PetscInt k = 0; k < set->n; k++) {
    wave[k]          = PetscCosReal(2 * PETSC_PI * set->freq[k] * t);
    wave[set->n + k] = PetscSinReal(2 * PETSC_PI * set->freq[k] * t);
  }
  wave[2 * set->n] = 1;
  return 2 * set->n + 1;
}

/* What the waves leave of the record */
static void RecordTake(LineRecord *r, const LineSet *set)
{
  PetscReal wave[LINES_COLUMNS];

  for (PetscInt i = 0; i < r->n; i++) {
    const PetscInt n = SetWaves(set, RecordTime(r, i), wave);

    r->rest[i] = r->x[i];
    for (PetscInt k = 0; k < n; k++) r->rest[i] -= set->factor[k] * wave[k];
  }
}

/* Adds a line to what is left, sign 1, or takes it off again, -1 */
static void RecordAdd(LineRecord *r, const LineSet *set, PetscInt k, PetscReal sign)
{
  const PetscReal a = sign * set->factor[k], b = sign * set->factor[set->n + k], w = 2 * PETSC_PI * set->freq[k];

  for (PetscInt i = 0; i < r->n; i++)
    r->rest[i] += a * PetscCosReal(w * RecordTime(r, i)) + b * PetscSinReal(w * RecordTime(r, i));
}

/* Factors of the waves by least squares with the window; *good false where lines are too near to each other */
static PetscErrorCode SetFit(const LineRecord *r, LineSet *set, PetscBool *good)
{
  PetscReal    A[LINES_COLUMNS * LINES_COLUMNS] = {0}, wave[LINES_COLUMNS];
  PetscBLASInt pivot[LINES_COLUMNS];
  PetscInt     n = 2 * set->n + 1;
  PetscBool    singular;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < n; k++) set->factor[k] = 0;
  for (PetscInt i = 0; i < r->n; i++) {
    (void)SetWaves(set, RecordTime(r, i), wave);
    for (PetscInt k = 0; k < n; k++) {
      set->factor[k] += r->w[i] * wave[k] * r->x[i];
      for (PetscInt l = 0; l <= k; l++) A[k + n * l] += r->w[i] * wave[k] * wave[l];
    }
  }
  for (PetscInt k = 0; k < n; k++)
    for (PetscInt l = 0; l < k; l++) A[l + n * k] = A[k + n * l];
  PetscCall(DenseFactor(n, A, pivot, &singular));
  *good = singular ? PETSC_FALSE : PETSC_TRUE;
  if (*good) PetscCall(DenseSolve(n, A, pivot, PETSC_FALSE, 1, set->factor));
  PetscFunctionReturn(0);
}

static PetscReal SetAmplitude(const LineSet *set, PetscInt k)
{
  return hypot(set->factor[k], set->factor[set->n + k]);
}

/* Each line again with the others taken away */
static PetscErrorCode SetSeek(LineRecord *r, PetscReal width, LineSet *set, PetscBool *good)
{
  PetscFunctionBeginUser;
  for (int round = 0; round < LINES_ROUNDS; round++) {
    LineSet found;

    PetscCall(SetFit(r, set, good));
    if (!*good) PetscFunctionReturn(0);
    found = *set;
    RecordTake(r, set);
    for (PetscInt k = 0; k < set->n; k++) {
      RecordAdd(r, set, k, 1);
      found.freq[k] = RecordRefine(r, set->freq[k], width);
      RecordAdd(r, set, k, -1);
    }
    *set = found;
  }
  PetscCall(SetFit(r, set, good));
  PetscFunctionReturn(0);
}

/* Lines down to those that are faint, or no other than one before */
static PetscErrorCode SetFind(LineRecord *r, PetscReal span, LineSet *set, PetscBool *good)
{
  PetscFunctionBeginUser;
  set->n = 0;
  *good  = PETSC_TRUE;
  PetscCall(SetFit(r, set, good));
  while (set->n < LINES_MOST && *good) {
    PetscReal *freq = &set->freq[set->n], strongest = 0;
    PetscBool  near = PETSC_FALSE;

    RecordTake(r, set);
    PetscCall(RecordPeak(r, freq));
    *freq = RecordRefine(r, *freq, 0.5 / span);
    for (PetscInt k = 0; k < set->n; k++)
      if (PetscAbsReal(set->freq[k] - *freq) < 1 / span) near = PETSC_TRUE;
    if (near) break;
    set->n++;
    PetscCall(SetFit(r, set, good));
    for (PetscInt k = 0; k < set->n; k++) strongest = PetscMax(strongest, SetAmplitude(set, k));
    if (!(SetAmplitude(set, set->n - 1) >= LINES_FAINT * strongest)) break;
  }
  if (set->n && *good) PetscCall(SetSeek(r, 0.5 / span, set, good));
  PetscFunctionReturn(0);
}

/* Lines of the whole and of its halves, in one order; *good false where some cannot be told from each other */
static PetscErrorCode SetsFind(PetscInt n, const PetscReal x[], PetscReal dt, LineSet set[3], PetscBool *good)
{
  const PetscReal span = (PetscReal)(n - 1) * dt;

  PetscFunctionBeginUser;
  for (int part = 0; part < 3; part++) {
    LineRecord r;

    PetscCall(LineRecordCreate(part ? n / 2 : n, part == 2 ? &x[n - n / 2] : x, dt, &r));
    if (part) set[part] = set[0];
    if (part)
      PetscCall(SetSeek(&r, 0.5 / span, &set[part], good));
    else
      PetscCall(SetFind(&r, span, &set[part], good));
    PetscCall(LineRecordDestroy(&r));
    if (!*good || !set[0].n) break;
  }
  PetscFunctionReturn(0);
}

/* Whether f is k f_1 + l f_2, of n basic frequencies */
static PetscBool IsSum(PetscReal f, PetscInt n, const Line basic[], PetscReal near)
{
  for (int k = -LINES_ORDER; k <= LINES_ORDER; k++)
    for (int l = n > 1 ? -LINES_ORDER : 0; l <= (n > 1 ? LINES_ORDER : 0); l++) {
      const int order = (k < 0 ? -k : k) + (l < 0 ? -l : l);

      if (!order || order > LINES_ORDER) continue;
      if (PetscAbsReal(k * basic[0].freq + (n > 1 ? l * basic[1].freq : 0) - f) <= near) return PETSC_TRUE;
    }
  return PETSC_FALSE;
}

static PetscBool IsRatio(const Line basic[2], PetscReal near)
{
  for (int q = 1; q <= LINES_ORDER; q++)
    for (int p = 1; p < 4 * LINES_ORDER; p++)
      if (PetscAbsReal(q * basic[1].freq - p * basic[0].freq) <= q * near) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* Line k of the whole, and whether it is as strong in both halves */
static PetscBool LineTake(const LineSet set[3], PetscInt k, Line *line)
{
  const PetscReal a = SetAmplitude(&set[1], k), b = SetAmplitude(&set[2], k);

  *line = (Line){set[0].freq[k], 0.5 * PetscAbsReal(set[1].freq[k] - set[2].freq[k]), SetAmplitude(&set[0], k)};
  return PetscAbsReal(a - b) <= LINES_STEADY * PetscMax(a, b) ? PETSC_TRUE : PETSC_FALSE;
}

/* The strongest line that is no sum of n basic ones; -1 for none */
static PetscInt SetStrongest(const LineSet *set, PetscInt n, const Line basic[], PetscReal near)
{
  PetscInt best = -1;

  for (PetscInt k = 0; k < set->n; k++)
    if ((best < 0 || SetAmplitude(set, k) > SetAmplitude(set, best)) && !(n && IsSum(set->freq[k], n, basic, near)))
      best = k;
  return best;
}

PetscErrorCode LinesFindTwo(PetscInt n, const PetscReal x[], PetscReal dt, Line line[2], PetscBool *two)
{
  const PetscReal span = (PetscReal)(n - 1) * dt;
  PetscReal       near = LINES_NEAR / span;
  LineSet         set[3];
  PetscBool       good;
  PetscInt        k;

  PetscFunctionBeginUser;
  *two = PETSC_FALSE;
  if (n < 4 * LINES_COLUMNS) PetscFunctionReturn(0);
  PetscCall(SetsFind(n, x, dt, set, &good));
  if (!good || set[0].n < 2) PetscFunctionReturn(0);
  k    = SetStrongest(&set[0], 0, NULL, 0);
  good = LineTake(set, k, &line[0]);
  near = PetscMax(near, 3 * line[0].error);
  k    = SetStrongest(&set[0], 1, line, near);
  if (!good || line[0].freq * span < LINES_PERIOD || k < 0) PetscFunctionReturn(0);
  if (!LineTake(set, k, &line[1]) || line[1].amplitude < LINES_FAINT * line[0].amplitude) PetscFunctionReturn(0);
  near = PetscMax(near, 3 * line[1].error);
  if (IsRatio(line, near)) PetscFunctionReturn(0);
  for (k = 0; k < set[0].n; k++)
    if (SetAmplitude(&set[0], k) >= LINES_FAINT * line[0].amplitude && !IsSum(set[0].freq[k], 2, line, near))
      PetscFunctionReturn(0);
  *two = PETSC_TRUE;
  PetscFunctionReturn(0);
}
