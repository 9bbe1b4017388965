/*
   The eigenvalues of a window from few of many vectors. The leading m vectors V of a model hold most of its modes, the
   others Z little: with the couplings at a point (linear, square) of Q = K + linear C + square M taken into V,

      right V - Z T,  T = Q_zz^-1 Q_zv,      left V - Z T',  T' = Q_zz^-T Q_vz',

   what is left of them at lambda is E(lambda) = (lambda - linear) C + (lambda^2 - square) M between Z and these (static
   condensation: R. J. Guyan, AIAA J. 3, 1965, about a shift). The m x m problem is solved whole. Of the model it has
   all modes but those that Q_zz(lambda) is singular at, so Z must have no modes of its own in the window. With
   d = lambda - linear these are, damped, eigenvalues 1 / d of

      P = [-Q_zz^-1 (C_zz + 2 linear M_zz), -Q_zz^-1 M_zz; 1, 0]          at the point;

   undamped, 1 / (square - lambda^2) of P = Q_zz^-1 M_zz. None has |d| <= R where |(R P)^k|^(1/k) < 1 for some k in any
   norm. R reaches all of the window; one whose growth exceeds WIDTH of its end takes the whole problem.

   Then the couplings left do W_ij = (E' y_i)' Q_zz(lambda_j)^-1 (E x_j) between modes i and j,
   and a mode is judged by |W_ii| / |y'Q' x|, and by what pairs do to each other: with w^2 = |W_ij W_ji| over both
   slopes, w^2 / |lambda_i - lambda_j|, not above w. Where that exceeds the tolerance, or Z may have modes in the
   window, nothing is found, and the whole problem is to be solved.
*/
#include "eigen.h"
#include "base/algebra/dense.h"

/* Undamped: square of the end of the window, negative, where Q is taken; damped: real lambda there */
#define CONDENSE_SQUARE -0.4
#define CONDENSE_LAMBDA 0.4
#define WIDTH           0.25 /* of the end of the window, beyond which R would reach many modes outside it */
#define REACH           0.8  /* bound of the eigenvalues of R P, and of the ratio of terms of Q_zz(lambda)^-1 */
#define SQUARINGS       4
#define TERMS           40
#define TERMS_RTOL      1e-2 /* of the sum: a change need not be known better */

typedef struct {
  const DensePencil *whole;
  DensePencil        few;
  PetscInt           m, z;
  PetscReal          linear, square, radius; /* R, rad/s; undamped (rad/s)^2 */
  PetscReal         *LU, *right, *left; /* Q_zz; T and T' [m][z] */
  PetscReal         *rest[2][2];        /* [m][z] of M and C: A_zv - A_zz T, A_vz' - A_zz' T' */
  PetscReal         *own[2];            /* [z][z] Q_zz^-1 M_zz; damped: Q_zz^-1 (C_zz + 2 linear M_zz) */
  PetscBLASInt      *pivot;
} Condensed;

/* rest = A_zv - A_zz T, or of the transposed A and T' */
static PetscErrorCode RestTake(const Condensed *w, const PetscReal A[], PetscBool left, PetscReal rest[])
{
  const PetscInt n = w->whole->n, m = w->m, z = w->z;

  PetscFunctionBeginUser;
  DenseBlockGet(left ? (DenseBlock){A + m * n, m, z, n} : (DenseBlock){A + m, z, m, n}, left, rest);
  PetscCall(DenseSubtract((DenseBlock){A + m * (n + 1), z, z, n}, left, m, left ? w->left : w->right, rest));
  PetscFunctionReturn(0);
}

/* few = A_vv - A_vz T - T'' (A_zv - A_zz T), T' that of left */
static PetscErrorCode MatrixCondense(const Condensed *w, const PetscReal A[], const PetscReal left[],
                                     const PetscReal rest[], PetscReal few[])
{
  const PetscInt n = w->whole->n, m = w->m, z = w->z;

  PetscFunctionBeginUser;
  DenseBlockGet((DenseBlock){A, m, m, n}, PETSC_FALSE, few);
  PetscCall(DenseSubtract((DenseBlock){A + m * n, m, z, n}, PETSC_FALSE, m, w->right, few));
  PetscCall(DenseSubtract((DenseBlock){left, m, z, z}, PETSC_TRUE, m, rest, few));
  PetscFunctionReturn(0);
}

/* T and T' at the point, and Q_vv - Q_vz T in few.K */
static PetscErrorCode CouplingsTake(Condensed *w, PetscBool *singular)
{
  const PetscInt n = w->whole->n, m = w->m, z = w->z;
  PetscReal     *Q;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n * n, &Q));
  DensePencilAt(w->whole, w->linear, w->square, Q);
  DenseBlockGet((DenseBlock){Q + m * (n + 1), z, z, n}, PETSC_FALSE, w->LU);
  DenseBlockGet((DenseBlock){Q + m, z, m, n}, PETSC_FALSE, w->right);
  DenseBlockGet((DenseBlock){Q + m * n, m, z, n}, PETSC_TRUE, w->left);
  DenseBlockGet((DenseBlock){Q, m, m, n}, PETSC_FALSE, w->few.K);
  PetscCall(DenseFactor(z, w->LU, w->pivot, singular));
  if (!*singular) {
    PetscCall(DenseSolve(z, w->LU, w->pivot, PETSC_FALSE, m, w->right));
    PetscCall(DenseSolve(z, w->LU, w->pivot, PETSC_TRUE, m, w->left));
    PetscCall(DenseSubtract((DenseBlock){Q + m * n, m, z, n}, PETSC_FALSE, m, w->right, w->few.K));
  }
  PetscCall(PetscFree(Q));
  PetscFunctionReturn(0);
}

static PetscErrorCode CondensedCreate(const DensePencil *whole, PetscInt m, const ReducedWindow *window, Condensed *w)
{
  const PetscInt     z = whole->n - m;
  const PetscReal    high = window->high;
  const PetscComplex end  = -window->growth + high * PETSC_i;

  PetscFunctionBeginUser;
  *w = (Condensed){.whole  = whole,
                   .few    = {.n = m, .damped = whole->damped, .symmetric = whole->symmetric},
                   .m      = m,
                   .z      = z,
                   .linear = whole->damped ? CONDENSE_LAMBDA * high : 0,
                   .square = (whole->damped ? PetscSqr(CONDENSE_LAMBDA) : CONDENSE_SQUARE) * high * high};
  w->radius = cabs(whole->damped ? end - w->linear : end * end - w->square);
  PetscCall(PetscMalloc2(z * z, &w->own[0], z * z, &w->own[1]));
  PetscCall(PetscMalloc3(m * m, &w->few.K, m * m, &w->few.C, m * m, &w->few.M));
  PetscCall(PetscMalloc4(z * z, &w->LU, m * z, &w->right, m * z, &w->left, z, &w->pivot));
  for (int k = 0; k < 2; k++) PetscCall(PetscMalloc2(m * z, &w->rest[k][0], m * z, &w->rest[k][1]));
  PetscFunctionReturn(0);
}

static PetscErrorCode CondensedDestroy(Condensed *w)
{
  PetscFunctionBeginUser;
  for (int k = 0; k < 2; k++) PetscCall(PetscFree2(w->rest[k][0], w->rest[k][1]));
  PetscCall(PetscFree2(w->own[0], w->own[1]));
  PetscCall(PetscFree4(w->LU, w->right, w->left, w->pivot));
  PetscCall(DensePencilDestroy(&w->few));
  PetscFunctionReturn(0);
}

/* The pencil on the m vectors */
static PetscErrorCode PencilCondense(Condensed *w, PetscBool *singular)
{
  const PetscReal *const A[2] = {w->whole->M, w->whole->C};
  PetscReal *const       B[2] = {w->few.M, w->few.C};

  PetscFunctionBeginUser;
  PetscCall(CouplingsTake(w, singular));
  if (*singular) PetscFunctionReturn(0);
  PetscCall(PetscArrayzero(w->few.C, w->m * w->m));
  for (int k = 0; k < (w->whole->damped ? 2 : 1); k++) {
    for (int i = 0; i < 2; i++) PetscCall(RestTake(w, A[k], i ? PETSC_TRUE : PETSC_FALSE, w->rest[k][i]));
    PetscCall(MatrixCondense(w, A[k], w->left, w->rest[k][0], B[k]));
  }
  for (PetscInt i = 0; i < w->m * w->m; i++) w->few.K[i] -= w->square * w->few.M[i] + w->linear * w->few.C[i];
  PetscFunctionReturn(0);
}

/* r [modes][z] = E(lambda) x of all modes, or of the left vectors */
static PetscErrorCode CouplingsLeft(const Condensed *w, const ReducedModes *modes, PetscBool left, PetscComplex r[])
{
  const PetscComplex *x = left ? modes->y : modes->x;
  const PetscInt      z = w->z;
  PetscComplex       *part;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(modes->n * z, &part));
  PetscCall(PetscArrayzero(r, modes->n * z));
  for (int k = 0; k < (w->whole->damped ? 2 : 1); k++) {
    PetscCall(DenseTimes(&(DenseBlock){w->rest[k][left], z, w->m, z}, PETSC_FALSE, modes->n, x, part));
    for (PetscInt i = 0; i < modes->n; i++) {
      const PetscComplex lambda = modes->lambda[i], c = k ? lambda - w->linear : lambda * lambda - w->square;

      for (PetscInt j = i * z; j < (i + 1) * z; j++) r[j] += c * part[j];
    }
  }
  PetscCall(PetscFree(part));
  PetscFunctionReturn(0);
}

/* R P of the header, of size N = z or 2 z; signs of the whole do not matter */
static void OthersCompanion(const Condensed *w, PetscInt N, PetscReal P[])
{
  const PetscInt  z = w->z;
  const PetscReal R = w->radius;

  for (PetscInt j = 0; j < z; j++)
    for (PetscInt i = 0; i < z; i++) {
      if (N == z) {
        P[j * N + i] = R * w->own[0][j * z + i];
      } else {
        P[j * N + i]           = -R * w->own[1][j * z + i];
        P[(j + z) * N + i]     = -R * R * w->own[0][j * z + i];
        P[j * N + i + z]       = i == j;
        P[(j + z) * N + i + z] = 0;
      }
    }
}

/* Whether Z has no mode that R reaches. Each squaring of P makes |P^k|^(1/k) sharper */
static PetscErrorCode OthersFar(const Condensed *w, PetscBool *far)
{
  const PetscInt z = w->z, N = w->whole->damped ? 2 * z : z;
  PetscReal     *P, *square, k = 1;

  PetscFunctionBeginUser;
  *far = PETSC_FALSE;
  PetscCall(PetscMalloc1(N * N, &P));
  PetscCall(PetscMalloc1(N * N, &square));
  OthersCompanion(w, N, P);
  for (int i = 0; i < SQUARINGS && !*far; i++, k *= 2) {
    PetscReal *const old = P;
    PetscReal        sum = 0;

    PetscCall(PetscArrayzero(square, N * N));
    PetscCall(DenseSubtract((DenseBlock){P, N, N, N}, PETSC_FALSE, N, P, square));
    P = square, square = old;
    for (PetscInt j = 0; j < N * N; j++) sum += P[j] * P[j];
    if (PetscPowReal(sum, 0.25 / k) < REACH) *far = PETSC_TRUE;
  }
  PetscCall(PetscFree(P));
  PetscCall(PetscFree(square));
  PetscFunctionReturn(0);
}

/* Q_zz^-1 of the matrices of Z, and whether Z has no modes in the window */
static PetscErrorCode OthersTake(Condensed *w, PetscBool *far)
{
  const PetscInt n = w->whole->n, m = w->m, z = w->z;

  PetscFunctionBeginUser;
  DenseBlockGet((DenseBlock){w->whole->M + m * (n + 1), z, z, n}, PETSC_FALSE, w->own[0]);
  if (w->whole->damped) {
    DenseBlockGet((DenseBlock){w->whole->C + m * (n + 1), z, z, n}, PETSC_FALSE, w->own[1]);
    for (PetscInt i = 0; i < z * z; i++) w->own[1][i] += 2 * w->linear * w->own[0][i];
    PetscCall(DenseSolve(z, w->LU, w->pivot, PETSC_FALSE, z, w->own[1]));
  }
  PetscCall(DenseSolve(z, w->LU, w->pivot, PETSC_FALSE, z, w->own[0]));
  PetscCall(OthersFar(w, far));
  PetscFunctionReturn(0);
}

/* next := first - (Q_zz^-1 Q_zz(lambda) - 1) x of all modes, part [2][modes][z]; whether that is x nearly */
static PetscErrorCode OthersIterate(const Condensed *w, const ReducedModes *modes, const PetscComplex first[],
                                    PetscComplex part[], PetscComplex x[], PetscBool *ended)
{
  const PetscInt      z = w->z, n = modes->n, damped = w->whole->damped;
  PetscComplex *const more = part + n * z;

  PetscFunctionBeginUser;
  *ended = PETSC_TRUE;
  PetscCall(DenseTimes(&(DenseBlock){w->own[0], z, z, z}, PETSC_FALSE, n, x, part));
  if (damped) PetscCall(DenseTimes(&(DenseBlock){w->own[1], z, z, z}, PETSC_FALSE, n, x, more));
  for (PetscInt i = 0; i < n; i++) {
    const PetscComplex lambda = modes->lambda[i], d = lambda - w->linear;
    PetscReal          size = 0, change = 0;

    for (PetscInt j = i * z; j < (i + 1) * z; j++) {
      const PetscComplex by   = damped ? d * more[j] + d * d * part[j] : (lambda * lambda - w->square) * part[j];
      const PetscComplex next = first[j] - by;

      change += PetscSqr(cabs(next - x[j]));
      size += PetscSqr(cabs(next));
      x[j] = next;
    }
    if (!(change <= PetscSqr(TERMS_RTOL) * size)) *ended = PETSC_FALSE;
  }
  PetscFunctionReturn(0);
}

/* x [modes][z] := Q_zz(lambda)^-1 x, by the geometric series about the point */
static PetscErrorCode OthersSolve(const Condensed *w, const ReducedModes *modes, PetscComplex x[], PetscBool *ended)
{
  const PetscInt size = modes->n * w->z;
  PetscReal     *parts;
  PetscComplex  *first, *part;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc3(2 * size, &parts, size, &first, 2 * size, &part));
  DenseSplit(size, x, parts);
  PetscCall(DenseSolve(w->z, w->LU, w->pivot, PETSC_FALSE, 2 * modes->n, parts));
  DenseUnite(size, parts, x);
  PetscCall(PetscArraycpy(first, x, size));
  *ended = PETSC_FALSE;
  for (int i = 0; i < TERMS && !*ended; i++) PetscCall(OthersIterate(w, modes, first, part, x, ended));
  PetscCall(PetscFree3(parts, first, part));
  PetscFunctionReturn(0);
}

/* |y'Q' x| of all modes of the core; 0 where y'M x is none */
static PetscErrorCode SlopesTake(const Condensed *w, const ReducedModes *modes, PetscReal slope[])
{
  const PetscInt n = modes->n, m = w->m;
  PetscComplex  *Mx, *Cx;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(n * m, &Mx, n * m, &Cx));
  PetscCall(DenseTimes(&(DenseBlock){w->few.M, m, m, m}, PETSC_FALSE, n, modes->x, Mx));
  PetscCall(DenseTimes(&(DenseBlock){w->few.C, m, m, m}, PETSC_FALSE, n, modes->x, Cx));
  for (PetscInt i = 0; i < n; i++) {
    const PetscComplex *y = modes->y + i * m, mass = DenseDot(m, y, Mx + i * m);

    slope[i] = mass == 0 ? 0 : cabs(2 * modes->lambda[i] * mass + DenseDot(m, y, Cx + i * m));
  }
  PetscCall(PetscFree2(Mx, Cx));
  PetscFunctionReturn(0);
}

/* Sum of the changes of mode i, rad/s; W [right][left] */
static PetscReal ModeChange(const ReducedModes *modes, PetscInt i, const PetscComplex W[], const PetscReal slope[])
{
  const PetscInt n   = modes->n;
  PetscReal      sum = cabs(W[i * (n + 1)]) / slope[i];

  for (PetscInt j = 0; j < n; j++) {
    const PetscReal both = cabs(W[j * n + i] * W[i * n + j]) / (slope[i] * slope[j]), pair = PetscSqrtReal(both);
    const PetscReal gap  = cabs(modes->lambda[i] - modes->lambda[j]);

    if (j != i && !modes->rigid[j] && both > 0) sum += gap > pair ? both / gap : pair;
  }
  return sum;
}

/* Largest relative change of a mode by the couplings left: near a lock-in y'Q'x is small and the change large */
static PetscErrorCode CondensedJudge(const Condensed *w, const ReducedModes *modes, PetscReal *worst)
{
  const PetscInt n = modes->n, z = w->z;
  PetscComplex  *r, *s, *W;
  PetscReal     *slope;
  PetscBool      ended;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc4(n * z, &r, n * z, &s, n * n, &W, n, &slope));
  PetscCall(CouplingsLeft(w, modes, PETSC_FALSE, r));
  PetscCall(CouplingsLeft(w, modes, PETSC_TRUE, s));
  PetscCall(OthersSolve(w, modes, r, &ended));
  PetscCall(DenseComplexProducts(z, n, s, n, r, W));
  PetscCall(SlopesTake(w, modes, slope));
  *worst = ended ? 0 : INFINITY;
  for (PetscInt i = 0; i < n; i++) {
    if (modes->rigid[i]) continue;
    const PetscReal change = slope[i] > 0 ? ModeChange(modes, i, W, slope) / cabs(modes->lambda[i]) : INFINITY;

    *worst = change <= *worst ? *worst : change; /* also of one that is no number */
  }
  PetscCall(PetscFree4(r, s, W, slope));
  PetscFunctionReturn(0);
}

/* Vectors of all n from those of m: below x stands -T x, below y -T' y */
static PetscErrorCode CondensedLift(const Condensed *w, const ReducedModes *few, ReducedModes *modes)
{
  const PetscInt n = w->whole->n, m = w->m, z = w->z;
  PetscComplex  *part;

  PetscFunctionBeginUser;
  PetscCall(ReducedModesCreate(few->n, n, modes));
  PetscCall(PetscMalloc1(few->n * z, &part));
  for (int left = 0; left < 2; left++) {
    PetscComplex *const from = left ? few->y : few->x, *const to = left ? modes->y : modes->x;

    PetscCall(DenseTimes(&(DenseBlock){left ? w->left : w->right, z, m, z}, PETSC_FALSE, few->n, from, part));
    for (PetscInt i = 0; i < few->n; i++) {
      PetscCall(PetscArraycpy(to + i * n, from + i * m, m));
      for (PetscInt j = 0; j < z; j++) to[i * n + m + j] = -part[i * z + j];
    }
  }
  PetscCall(PetscArraycpy(modes->lambda, few->lambda, few->n));
  PetscCall(PetscArraycpy(modes->rigid, few->rigid, few->n));
  PetscCall(PetscFree(part));
  PetscFunctionReturn(0);
}

/* What rounding on the mesh and of the whole K is to modes of the core: E + diag |K| on the vectors V - Z T */
static PetscErrorCode EnergyCondense(const Condensed *w, const PetscReal E[], PetscReal few[])
{
  const PetscInt n = w->whole->n;
  PetscReal     *sum, *rest;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc2(n * n, &sum, w->m * w->z, &rest));
  if (E) PetscCall(PetscArraycpy(sum, E, n * n));
  for (PetscInt i = 0; i < n * n; i += n + 1) sum[i] += PetscAbsReal(w->whole->K[i]);
  PetscCall(RestTake(w, sum, PETSC_FALSE, rest));
  PetscCall(MatrixCondense(w, sum, w->right, rest, few));
  PetscCall(PetscFree2(sum, rest));
  PetscFunctionReturn(0);
}

PetscErrorCode CondensedEigen(const DensePencil *pencil, const PetscReal E[], const ReducedCore *core,
                              const ReducedWindow *window, ReducedModes *modes, PetscBool *found)
{
  Condensed    w;
  ReducedModes few;
  PetscReal   *energy, worst = INFINITY;
  PetscBool    singular, far = PETSC_FALSE;

  PetscFunctionBeginUser;
  *found = PETSC_FALSE;
  if (window->growth > WIDTH * window->high) PetscFunctionReturn(0);
  PetscCall(CondensedCreate(pencil, core->m, window, &w));
  PetscCall(PencilCondense(&w, &singular));
  if (!singular) PetscCall(OthersTake(&w, &far));
  if (far) {
    PetscCall(PetscMalloc1(w.m * w.m, &energy));
    PetscCall(EnergyCondense(&w, E, energy));
    PetscCall(DensePencilEigen(&w.few, energy, window, &few));
    if (few.n) PetscCall(CondensedJudge(&w, &few, &worst));
    if (worst <= core->rtol) *found = PETSC_TRUE;
    if (*found) PetscCall(CondensedLift(&w, &few, modes));
    PetscCall(ReducedModesDestroy(&few));
    PetscCall(PetscFree(energy));
  }
  PetscCall(CondensedDestroy(&w));
  PetscFunctionReturn(0);
}
