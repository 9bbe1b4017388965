/*
   v of chord.c's iterations from few bytes: only the change of the forces since the last whole product is multiplied,
   by W in 16 bits,

      v = free + W f_a + W~ (f - f_a),     W~ = S T,   |W~_ij - W_ij| <= S / 2 of its tile,

   T whole numbers of 16 bits, S a scale of each tile of 16 x 16; the diagonal of W has all its figures. W f_a is exact.
   Roundings of the entries do not add up: their sum over a row is sqrt(sum S^2 df^2 / 12) in the mean, which is known,
   and a residual that is not far above it is found anew by a whole product, from which the next changes count. A step
   converges as it does with W; two whole products of ten are left of it, and a change that has become short
   is multiplied to rounding of W f. In single precision: half of 9.4 M numbers of 1024 pairs is 9.4 MB instead of
   37.7 MB, and a product takes a fifth of the time.
*/
#include "base/algebra/versions.h"
#include "contact/compliance/complianceimpl.h"

#define NEAR_TILE  16
#define NEAR_WHOLE 32767 /* of a number of 16 bits */
#define NEAR_UNIT  65536 /* of a number in its word of 32 bits */
#define NEAR_AHEAD 64    /* rows of words: what is read by then is on its way */
#define NEAR_LARGE 600   /* rows of W from which it leaves the cache of a core */
#define NEAR_SIGMA 4     /* times what an entry of v is off by in the mean: above the largest of some thousand, 3.5 */
#define NEAR_TRUST 2.5   /* errors of v: a smaller residual is found anew */

typedef float   NearRow __attribute__((vector_size(64), aligned(4), may_alias));
typedef int32_t NearWord __attribute__((vector_size(64), aligned(2), may_alias));

#define NEAR_READ(x) (*(const NearRow *)(x))
/* Columns 2 k and 2 k + 1 of a tile are one row of words of 32 bits, the lower and the upper half of each: both times
   2^16, which the scale takes back, without a shift of lanes */
#define NEAR_EVEN(w) __builtin_convertvector((w) << 16, NearRow)
#define NEAR_ODD(w)  __builtin_convertvector((w) & (int32_t)0xffff0000, NearRow)

#if __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__
#define NEAR_UPPER 1
#else
#define NEAR_UPPER 0
#endif

/* Place of row a, column b in a tile */
static inline PetscInt NearPlace(PetscInt a, PetscInt b)
{
  return (b / 2 * NEAR_TILE + a) * 2 + (b % 2 ? NEAR_UPPER : 1 - NEAR_UPPER);
}

/* Tiles (I, J), I >= J, one column of tiles behind the other */
static inline PetscInt NearTiles(PetscInt n)
{
  return n * (n + 1) / 2;
}

PetscBool ComplianceNearServes(const ContactCompliance c)
{
  return !ComplianceIsMap(c) && 3 * c->n >= NEAR_LARGE ? PETSC_TRUE : PETSC_FALSE;
}

/* One tile at row i and column j of W, its diagonal left out; returns its scale. Beyond the last row: zeros */
static PetscReal NearSetTile(const ContactCompliance c, PetscInt i, PetscInt j, int16_t tile[])
{
  const PetscInt N       = 3 * c->n;
  PetscReal      largest = 0;

  for (PetscInt b = j; b < PetscMin(N, j + NEAR_TILE); b++)
    for (PetscInt a = i; a < PetscMin(N, i + NEAR_TILE); a++)
      if (a != b) largest = PetscMax(largest, PetscAbsReal(c->W[b * N + a]));
  for (PetscInt b = j; b < j + NEAR_TILE; b++)
    for (PetscInt a = i; a < i + NEAR_TILE; a++) {
      const PetscReal w = a < N && b < N && a != b && largest > 0 ? c->W[b * N + a] / largest : 0;

      tile[NearPlace(a - i, b - j)] = (int16_t)lrint(NEAR_WHOLE * w);
    }
  return largest / NEAR_WHOLE / NEAR_UNIT;
}

/* Root of the mean square of what an entry is off by, S^2 / 12, in the row of tiles where it is largest, m/N */
static PetscErrorCode NearSetSpread(ComplianceNear *s)
{
  PetscReal *sum, largest = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(s->n, &sum));
  for (PetscInt j = 0, k = 0; j < s->n; j++)
    for (PetscInt i = j; i < s->n; i++, k++) {
      const PetscReal square = PetscSqr(NEAR_UNIT * (PetscReal)s->scale[k]);

      sum[i] += square;
      if (i > j) sum[j] += square;
    }
  for (PetscInt j = 0; j < s->n; j++) largest = PetscMax(largest, sum[j]);
  s->spread = PetscSqrtReal(largest / (12 * (PetscReal)s->n));
  PetscCall(PetscFree(sum));
  PetscFunctionReturn(0);
}

/* W in 16 bits, once: laws in series (spring.c) change its diagonal alone */
static PetscErrorCode NearCreate(ContactCompliance c)
{
  ComplianceNear *s = &c->near;
  const PetscInt  N = 3 * c->n;
  PetscInt        k = 0;

  PetscFunctionBeginUser;
  s->n = (N + NEAR_TILE - 1) / NEAR_TILE;
  PetscCall(
    PetscMalloc3(NearTiles(s->n) * NEAR_TILE * NEAR_TILE, &s->tile, NearTiles(s->n), &s->scale, s->n, &s->moves));
  PetscCall(PetscCalloc5(s->n * NEAR_TILE, &s->x, s->n * NEAR_TILE, &s->y, N, &s->from, N, &s->moved, N, &s->diagonal));
  for (PetscInt j = 0; j < s->n; j++)
    for (PetscInt i = j; i < s->n; i++, k++)
      s->scale[k] = (float)NearSetTile(c, i * NEAR_TILE, j * NEAR_TILE, &s->tile[k * NEAR_TILE * NEAR_TILE]);
  PetscCall(NearSetSpread(s));
  PetscFunctionReturn(0);
}

PetscErrorCode ComplianceNearTake(ContactCompliance c, const PetscReal from[], const PetscReal moved[])
{
  ComplianceNear *s = &c->near;
  const PetscInt  N = 3 * c->n;

  PetscFunctionBeginUser;
  if (!s->tile) PetscCall(NearCreate(c));
  PetscCall(PetscArraycpy(s->from, from, N));
  PetscCall(PetscArraycpy(s->moved, moved, N));
  for (PetscInt i = 0; i < N; i++) s->diagonal[i] = c->W[i * (N + 1)];
  s->stands = PETSC_TRUE;
  PetscFunctionReturn(0);
}

PetscErrorCode ComplianceNearDestroy(ContactCompliance c)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree3(c->near.tile, c->near.scale, c->near.moves));
  PetscCall(PetscFree5(c->near.x, c->near.y, c->near.from, c->near.moved, c->near.diagonal));
  PetscFunctionReturn(0);
}

/* y += S T x of a tile on the diagonal */
INTO_VERSIONS void NearDiagonal(const NearWord *restrict tile, float scale, const float *restrict x, float *restrict y)
{
  NearRow sum = {0};

  for (int k = 0; k < NEAR_TILE / 2; k++) sum += NEAR_EVEN(tile[k]) * x[2 * k] + NEAR_ODD(tile[k]) * x[2 * k + 1];
  *(NearRow *)y = NEAR_READ(y) + scale * sum;
}

/* y += W~ x of column j of tiles and, as a row, of those below its diagonal; tiles of two rows without a change, as of
   pairs that stay open, are not read */
INTO_VERSIONS void NearColumn(const ComplianceNear *s, PetscInt j, const NearWord *restrict tile,
                              const float *restrict scale, const float *restrict x, float *restrict y)
{
  const float *xj              = &x[j * NEAR_TILE];
  NearRow      dual[NEAR_TILE] = {{0}};

  NearDiagonal(tile, scale[0], xj, &y[j * NEAR_TILE]);
  for (PetscInt i = j + 1; i < s->n; i++) {
    const NearWord *t   = &tile[(i - j) * NEAR_TILE / 2];
    const NearRow   z   = NEAR_READ(&x[i * NEAR_TILE]) * scale[i - j];
    NearRow         sum = {0};

    if (!s->moves[i] && !s->moves[j]) continue;
#pragma GCC unroll 8
    for (int k = 0; k < NEAR_TILE / 2; k++) {
      const NearRow even = NEAR_EVEN(t[k]), odd = NEAR_ODD(t[k]);

      __builtin_prefetch(&t[k + NEAR_AHEAD]);

      sum += even * xj[2 * k] + odd * xj[2 * k + 1];
      dual[2 * k] += even * z;
      dual[2 * k + 1] += odd * z;
    }
    *(NearRow *)&y[i * NEAR_TILE] = NEAR_READ(&y[i * NEAR_TILE]) + scale[i - j] * sum;
  }
  for (int k = 0; k < NEAR_TILE; k++)
    for (int l = 0; l < NEAR_TILE; l++) y[j * NEAR_TILE + k] += dual[k][l];
}

VERSIONS
/* y = W~ x without the diagonal */
static void NearTimes(const ComplianceNear *s, const float x[], float y[])
{
  const NearWord *tile  = (const NearWord *)s->tile;
  const float    *scale = s->scale;

  for (PetscInt j = 0; j < s->n; j++) s->moves[j] = PETSC_FALSE;
  for (PetscInt i = 0; i < s->n * NEAR_TILE; i++) {
    if (x[i] != 0) s->moves[i / NEAR_TILE] = PETSC_TRUE;
    y[i] = 0;
  }
  for (PetscInt j = 0; j < s->n; j++) {
    NearColumn(s, j, tile, scale, x, y);
    tile += (s->n - j) * NEAR_TILE / 2;
    scale += s->n - j;
  }
}

/* v and W f_a by a whole product, from which changes count; laws in series may have changed the diagonal before it */
static PetscErrorCode NearBegin(ContactCompliance c)
{
  ComplianceNear *s = &c->near;
  const PetscInt  N = 3 * c->n;

  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(s->moved, N));
  ComplianceAddMotion(c, s->moved);
  for (PetscInt p = 0; p < c->n; p++)
    for (PetscInt i = 3 * p; i < 3 * p + 3; i++) {
      s->from[i]     = c->kappa[p] * c->l[i];
      s->diagonal[i] = c->W[i * (N + 1)];
      c->v[i]        = c->free[i] + s->moved[i];
    }
  s->stands = PETSC_TRUE;
  s->error  = 0;
  PetscFunctionReturn(0);
}

/* v at the present l, and what it is off by at most, m */
static void NearMove(ContactCompliance c)
{
  ComplianceNear *s    = &c->near;
  const PetscInt  N    = 3 * c->n;
  PetscReal      *more = c->force, unit = 0, square = 0;

  for (PetscInt p = 0; p < c->n; p++)
    for (PetscInt i = 3 * p; i < 3 * p + 3; i++) {
      more[i] = c->kappa[p] * c->l[i] - s->from[i];
      unit    = PetscMax(unit, PetscAbsReal(more[i]));
    }
  for (PetscInt i = 0; i < N && unit > 0; i++) {
    s->x[i] = (float)(more[i] / unit);
    square += PetscSqr((PetscReal)s->x[i]);
  }
  if (unit > 0) NearTimes(s, s->x, s->y);
  for (PetscInt i = 0; i < N; i++)
    c->v[i] = c->free[i] + (s->moved[i] + (unit > 0 ? unit * (PetscReal)s->y[i] + s->diagonal[i] * more[i] : 0));
  s->error = NEAR_SIGMA * s->spread * unit * PetscSqrtReal(square);
}

/* What is judged to be solved must be so to rounding; before that a residual may be off by 0.4 of it. */
PetscErrorCode ComplianceNearMove(ContactCompliance c, ComplianceMiss *miss)
{
  const PetscReal *error = &c->near.error;

  PetscFunctionBeginUser;
  if (!c->near.tile) PetscCall(NearCreate(c));
  if (c->near.stands)
    NearMove(c);
  else
    PetscCall(NearBegin(c));
  ComplianceMeasure(c, miss);
  if (*error <= miss->noise || (miss->largest >= NEAR_TRUST * *error && !ComplianceIsSolved(c, miss)))
    PetscFunctionReturn(0);
  PetscCall(NearBegin(c));
  ComplianceMeasure(c, miss);
  PetscFunctionReturn(0);
}
