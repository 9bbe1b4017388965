/*
   What holds all over a cell. Lambda + E(p) - s (I + B'(p)) is not singular at s where there are weights v > 0 with

      a_k v_k > sum_l F_kl v_l + (a_k + |E_kk|) sum_l B'_kl v_l,   all k,

   a_k a lower bound of |s - c_k(p)| over the cell, c_k = value_k + E_kk(p): generalised diagonal dominance. The
   weights are those of v = T v + w with T the right side by a_k, found by iteration and then put to the test.

   Quiet, damped     a lambda of the region R may be nearest to one of the centres c_i that come near R; then
                     a_i >= dist(c_i, R) and a_k >= |c_i - c_k| / 2 of the others that come near. Or it is nearest to
                     a centre that does not; then all of them are at least as far as these must be
   quiet, undamped   kappa is real all over the cell where modes stay apart: no eigenvalue on the line half way between
                     neighbours, so that the strip between two lines holds one eigenvalue everywhere, which is real as
                     its conjugate would be in the strip, too
   dangerous         no eigenvalue on a circle about c_i within R, so that the one inside stays there
*/
#include "frame.h"

#define WEIGHT_PASSES  60 /* of the iteration */
#define WEIGHT_SETTLED 1e-2
#define DIVERGED       1e12
#define BACKGROUND     1e-3 /* weight of the rows that are not looked at */
#define NEARBY         0.3  /* centres within this part of the upper end of the band come near it */

/* Extent of the centre c_k over the cell, and its estimated error */
typedef struct {
  PetscReal re[2], im[2], reach, error;
} Centre;

static Centre CentreOf(const CellFrame *f, PetscInt k, PetscReal error)
{
  PetscReal re = f->rest[k], im = f->rest[k], reach = f->rest[k];

  for (PetscInt j = 0; j < f->d; j++) {
    re += PetscAbsReal(creal(f->shift[j * f->N + k]));
    im += PetscAbsReal(cimag(f->shift[j * f->N + k]));
    reach += cabs(f->shift[j * f->N + k]);
  }
  return (Centre){{creal(f->value[k]) - re, creal(f->value[k]) + re},
                  {cimag(f->value[k]) - im, cimag(f->value[k]) + im},
                  reach,
                  (f->damped ? 1 : 2) * error * cabs(f->value[k])};
}

/* Least |c_i - c_k| over the cell: their difference moves linearly, and is looked at along itself */
static PetscReal CentresApart(const CellFrame *f, PetscInt i, PetscInt k)
{
  const PetscComplex between = f->value[i] - f->value[k];
  const PetscReal    size    = cabs(between);
  PetscReal          apart   = size - f->rest[i] - f->rest[k];

  for (PetscInt j = 0; j < f->d && size > 0; j++)
    apart -= PetscAbsReal(creal(conj(between) * (f->shift[j * f->N + i] - f->shift[j * f->N + k]))) / size;
  return PetscMax(apart, 0);
}

/* Least distance of a centre from R = {growth above the limit, low <= omega <= high}, damped */
static PetscReal RegionDistance(const Centre *c, const CellRegion *r)
{
  const PetscReal ratio = r->limit.ratio, growth = PetscMax(r->limit.growth, ratio * r->low);
  const PetscReal across = PetscMax(0, growth - c->re[1]);
  const PetscReal along  = PetscMax(0, PetscMax(r->low - c->im[1], c->im[0] - r->high));
  const PetscReal wedge  = (ratio * c->im[0] - c->re[1]) / PetscSqrtReal(1 + ratio * ratio);

  return PetscMax(0, PetscMax(PetscSqrtReal(across * across + along * along), wedge) - c->error);
}

/* Work of the tests: centres, distances from the region, bounds, weights */
typedef struct {
  Centre    *centre;        /* [N] */
  PetscReal *far, *a;       /* [N] */
  PetscReal *v, *u, *begin; /* [N] */
  PetscInt  *order, n;      /* [N] the centres that come near */
} Work;

/* One step of the iteration: u = T v; the largest u_k / v_k */
static PetscReal WeightsIterate(const CellFrame *f, const Work *w)
{
  const PetscInt N     = f->N;
  PetscReal      worst = 0;

  for (PetscInt k = 0; k < N; k++) {
    PetscReal sum = 0, mass = 0;

    for (PetscInt l = 0; l < N; l++) sum += f->F[k * N + l] * w->v[l], mass += f->B[k * N + l] * w->v[l];
    w->u[k] = (sum + (w->a[k] + w->centre[k].reach) * mass) / w->a[k];
    worst   = PetscMax(worst, w->u[k] / w->v[k]);
  }
  return worst;
}

/* w of the iteration, in work->begin and v; false where a bound a is none */
static PetscBool WeightsBegin(const CellFrame *f, const Work *w, PetscInt n_focus, const PetscInt focus[])
{
  PetscReal scale = 0;

  for (PetscInt i = 0; i < n_focus; i++) scale = PetscMax(scale, cabs(f->value[focus[i]]));
  for (PetscInt k = 0; k < f->N; k++) {
    if (!(w->a[k] > 0)) return PETSC_FALSE;
    w->begin[k] = BACKGROUND * PetscSqrtReal(scale / PetscMax(cabs(f->value[k]), 1e-3 * scale));
  }
  for (PetscInt i = 0; i < n_focus; i++) w->begin[focus[i]] = 1;
  for (PetscInt k = 0; k < f->N; k++) w->v[k] = w->begin[k];
  return PETSC_TRUE;
}

/* Looks for weights v, the rows `focus` first in line, and puts them to the test; margin = what is left of a in the
   worst of these rows */
static PetscBool IsDominant(const CellFrame *f, const Work *w, PetscInt n_focus, const PetscInt focus[],
                            PetscReal *margin)
{
  if (!WeightsBegin(f, w, n_focus, focus)) return PETSC_FALSE;
  for (int pass = 0; pass < WEIGHT_PASSES; pass++) {
    PetscReal change = 0;

    (void)WeightsIterate(f, w);
    for (PetscInt k = 0; k < f->N; k++) {
      const PetscReal next = w->u[k] + w->begin[k];

      change  = PetscMax(change, PetscAbsReal(next - w->v[k]) / w->v[k]);
      w->v[k] = next;
      if (!(next < DIVERGED)) return PETSC_FALSE;
    }
    if (change < WEIGHT_SETTLED) break;
  }
  if (!(WeightsIterate(f, w) < 1)) return PETSC_FALSE;
  *margin = PETSC_MAX_REAL;
  for (PetscInt i = 0; i < n_focus; i++)
    *margin = PetscMin(*margin, w->a[focus[i]] * (1 - w->u[focus[i]] / w->v[focus[i]]));
  return PETSC_TRUE;
}

/* The variable whose cut changes row i most */
static PetscInt AxisOf(const CellFrame *f, PetscInt i)
{
  PetscInt axis = 0;

  for (PetscInt j = 1; j < f->d; j++)
    if (f->influence[j * f->N + i] > f->influence[axis * f->N + i]) axis = j;
  return axis;
}

static PetscErrorCode WorkCreate(const CellFrame *f, const CellRegion *r, Work *w)
{
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc7(f->N, &w->centre, f->N, &w->far, f->N, &w->a, f->N, &w->v, f->N, &w->u, f->N, &w->begin, f->N,
                         &w->order));
  for (PetscInt k = 0; k < f->N; k++) w->centre[k] = CentreOf(f, k, r->error);
  PetscFunctionReturn(0);
}

static PetscErrorCode WorkDestroy(Work *w)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree7(w->centre, w->far, w->a, w->v, w->u, w->begin, w->order));
  PetscFunctionReturn(0);
}

/* The piece of R that is nearest to centre i */
static PetscBool PieceIsQuiet(const CellFrame *f, Work *w, PetscInt i, PetscReal *margin)
{
  for (PetscInt k = 0; k < f->N; k++) w->a[k] = w->far[k];
  for (PetscInt m = 0; m < w->n; m++) {
    const PetscInt k = w->order[m];

    if (k != i) w->a[k] = PetscMax(w->a[k], 0.5 * CentresApart(f, i, k));
  }
  return IsDominant(f, w, 1, &i, margin);
}

/* The rest of R, which is NEARBY at least from all centres */
static PetscBool RestIsQuiet(const CellFrame *f, const CellRegion *r, Work *w, PetscInt first)
{
  PetscReal margin;

  for (PetscInt k = 0; k < f->N; k++) w->a[k] = PetscMax(w->far[k], NEARBY * r->high - w->centre[k].error);
  return IsDominant(f, w, 1, &first, &margin);
}

static PetscErrorCode DampedIsQuiet(const CellFrame *f, const CellRegion *r, Work *w, PetscBool *quiet,
                                    PetscReal *margin, PetscInt *axis)
{
  PetscReal nearest = PETSC_MAX_REAL;
  PetscInt  first   = 0;

  PetscFunctionBeginUser;
  w->n    = 0;
  *quiet  = PETSC_TRUE;
  *margin = PETSC_MAX_REAL;
  for (PetscInt k = 0; k < f->N; k++) {
    w->far[k] = RegionDistance(&w->centre[k], r);
    if (w->far[k] < NEARBY * r->high) w->order[w->n++] = k;
    if (w->far[k] < nearest) nearest = w->far[k], first = k;
  }
  if (!w->n) w->order[w->n++] = first;
  *axis = AxisOf(f, first);
  if (nearest <= 0 || !RestIsQuiet(f, r, w, first)) *quiet = PETSC_FALSE;
  for (PetscInt m = 0; m < w->n && *quiet; m++) {
    PetscReal of_piece;

    *quiet = PieceIsQuiet(f, w, w->order[m], &of_piece);
    if (*quiet)
      *margin = PetscMin(*margin, of_piece);
    else
      *axis = AxisOf(f, w->order[m]);
  }
  PetscFunctionReturn(0);
}

static int CompareReal(const void *a, const void *b, void *values)
{
  const PetscReal difference =
    creal(((PetscComplex *)values)[*(const PetscInt *)a]) - creal(((PetscComplex *)values)[*(const PetscInt *)b]);

  return difference < 0 ? -1 : difference > 0;
}

/* The line half way between centres i and k, kappa_i < kappa_k */
static PetscBool LineIsClear(const CellFrame *f, Work *w, PetscInt i, PetscInt k, PetscReal *margin)
{
  const PetscReal middle = 0.5 * creal(f->value[i] + f->value[k]);
  const PetscInt  pair[] = {i, k};

  for (PetscInt l = 0; l < f->N; l++) {
    PetscReal apart = PetscAbsReal(creal(f->value[l]) - middle) - f->rest[l] - 0.5 * (f->rest[i] + f->rest[k]);

    for (PetscInt j = 0; j < f->d; j++) {
      const PetscComplex *shift = f->shift + j * f->N;

      apart -= PetscAbsReal(creal(shift[l] - 0.5 * (shift[i] + shift[k])));
    }
    w->a[l] = apart - w->centre[l].error;
  }
  return IsDominant(f, w, 2, pair, margin);
}

/* The line kappa = 0, beyond which omega is 0: divergence */
static PetscBool ZeroIsClear(const CellFrame *f, Work *w, PetscReal *margin)
{
  const PetscInt first = w->order[0];

  for (PetscInt l = 0; l < f->N; l++) w->a[l] = PetscMax(w->centre[l].re[0], -w->centre[l].re[1]) - w->centre[l].error;
  return IsDominant(f, w, 1, &first, margin);
}

/* Lines between neighbours, from below the band to beyond it. A strip that may hold a frequency of the band needs both.
   Rigid modes, kappa = 0 by rounding, are not looked at below. */
static PetscErrorCode UndampedIsQuiet(const CellFrame *f, const CellRegion *r, Work *w, PetscBool *quiet,
                                      PetscReal *margin, PetscInt *axis)
{
  const PetscReal low = r->low * r->low, high = r->high * r->high, tiny = 1e-9 * high;
  PetscReal       of_line;

  PetscFunctionBeginUser;
  *quiet  = PETSC_TRUE;
  *margin = PETSC_MAX_REAL;
  for (PetscInt k = 0; k < f->N; k++) w->order[k] = k;
  if (f->N > 1) PetscCall(PetscTimSort(f->N, w->order, sizeof(*w->order), CompareReal, f->value));
  *axis = AxisOf(f, w->order[0]);
  if (r->low == 0 && PetscAbsReal(creal(f->value[w->order[0]])) > tiny) {
    *quiet  = creal(f->value[w->order[0]]) > 0 && ZeroIsClear(f, w, &of_line) ? PETSC_TRUE : PETSC_FALSE;
    *margin = *quiet ? of_line / (2 * PetscSqrtReal(high)) : 0;
  }
  for (PetscInt m = 0; m + 1 < f->N && *quiet; m++) {
    const PetscInt i = w->order[m], k = w->order[m + 1], before = m ? w->order[m - 1] : i;
    const PetscInt behind = m + 2 < f->N ? w->order[m + 2] : k;
    /* of the strips below and above the line: lower strip from half way to `before`, upper one to `behind` */
    const PetscReal from = 0.5 * (w->centre[before].re[0] + w->centre[i].re[0]);
    const PetscReal to   = m + 2 < f->N ? 0.5 * (w->centre[k].re[1] + w->centre[behind].re[1]) : PETSC_MAX_REAL;

    if ((m && from > high) || to < low || w->centre[k].re[1] <= tiny) continue;
    *quiet = LineIsClear(f, w, i, k, &of_line);
    if (*quiet)
      *margin = PetscMin(*margin, of_line / (2 * PetscSqrtReal(PetscMax(creal(f->value[k]), tiny))));
    else
      *axis = AxisOf(f, i);
  }
  PetscFunctionReturn(0);
}

PetscErrorCode CellFrameIsQuiet(const CellFrame *f, const CellRegion *r, PetscBool *quiet, PetscReal *margin,
                                PetscInt *axis)
{
  Work w;

  PetscFunctionBeginUser;
  *quiet = PETSC_FALSE, *margin = 0, *axis = 0;
  if (!f->N) PetscFunctionReturn(0);
  PetscCall(WorkCreate(f, r, &w));
  if (f->damped)
    PetscCall(DampedIsQuiet(f, r, &w, quiet, margin, axis));
  else
    PetscCall(UndampedIsQuiet(f, r, &w, quiet, margin, axis));
  PetscCall(WorkDestroy(&w));
  PetscFunctionReturn(0);
}

/* How far a circle about the centre may reach and stay within R: damped by distances, undamped with |Im kappa| =
   2 sigma omega and omega^2 between Re kappa and |kappa| */
static PetscReal DepthOf(const CellFrame *f, const Centre *c, const CellRegion *r)
{
  const PetscReal size   = hypot(PetscMax(-c->re[0], c->re[1]), PetscMax(-c->im[0], c->im[1]));
  const PetscReal ratio  = r->limit.ratio;
  const PetscReal growth = PetscMax(r->limit.growth, ratio * (f->damped ? size : r->high));
  PetscReal       depth;

  if (f->damped)
    depth = PetscMin(c->re[0] - growth, PetscMin(c->im[0] - r->low, r->high - c->im[1]));
  else
    depth = PetscMin(c->im[0] - 2 * growth * r->high, PetscMin(c->re[0] - r->low * r->low, r->high * r->high - size));
  return depth / (1 + ratio) - c->error;
}

PetscErrorCode CellFrameIsDangerous(const CellFrame *f, const CellRegion *r, PetscBool *dangerous)
{
  Work      w;
  PetscReal margin;

  PetscFunctionBeginUser;
  *dangerous = PETSC_FALSE;
  if (!f->N) PetscFunctionReturn(0);
  PetscCall(WorkCreate(f, r, &w));
  for (PetscInt i = 0; i < f->N && !*dangerous; i++) {
    PetscReal depth = DepthOf(f, &w.centre[i], r);

    for (PetscInt k = 0; k < f->N && depth > 0; k++)
      if (k != i) depth = PetscMin(depth, 0.5 * CentresApart(f, i, k));
    if (depth <= 0) continue;
    for (PetscInt k = 0; k < f->N; k++) w.a[k] = k == i ? depth : CentresApart(f, i, k) - depth;
    *dangerous = IsDominant(f, &w, 1, &i, &margin);
  }
  PetscCall(WorkDestroy(&w));
  PetscFunctionReturn(0);
}
