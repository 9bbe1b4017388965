/*
   The eigenvalues of a window from few of many vectors. The leading m vectors V of a model hold most of its modes, the
   others Z little: with the couplings at a point (linear, square) of Q = K + linear C + square M taken into V,

      right V - Z T,  T = Q_zz^-1 Q_zv,      left V - Z T',  T' = Q_zz^-T Q_vz',

   what is left of them at lambda is E(lambda) = (lambda - linear) C + (lambda^2 - square) M between Z and these (static
   condensation: R. J. Guyan, AIAA J. 3, 1965, about a shift). The m x m problem is solved whole, so that no mode of it
   is missed, and each mode is judged by what the couplings left would do to it,

      |(E' y)' Q_zz^-1 (E x)| / |y'Q' x|.

   Where that exceeds the tolerance for one of them, nothing is found, and the whole problem is to be solved.
*/
#include "eigen.h"
#include "base/algebra/dense.h"

/* Undamped: square of the end of the window, negative, where Q is taken; damped: real lambda there */
#define CONDENSE_SQUARE -0.4
#define CONDENSE_LAMBDA 0.4

typedef struct {
  const DensePencil *whole;
  DensePencil        few;
  PetscInt           m, z;
  PetscReal          linear, square;
  PetscReal         *LU, *right, *left; /* Q_zz; T and T' [m][z] */
  PetscReal         *rest[2][2];        /* [m][z] of M and C: A_zv - A_zz T, A_vz' - A_zz' T' */
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

/* few = A_vv - A_vz T - T'' (A_zv - A_zz T) */
static PetscErrorCode MatrixCondense(const Condensed *w, const PetscReal A[], const PetscReal rest[], PetscReal few[])
{
  const PetscInt n = w->whole->n, m = w->m, z = w->z;

  PetscFunctionBeginUser;
  DenseBlockGet((DenseBlock){A, m, m, n}, PETSC_FALSE, few);
  PetscCall(DenseSubtract((DenseBlock){A + m * n, m, z, n}, PETSC_FALSE, m, w->right, few));
  PetscCall(DenseSubtract((DenseBlock){w->left, m, z, z}, PETSC_TRUE, m, rest, few));
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

static PetscErrorCode CondensedCreate(const DensePencil *whole, PetscInt m, PetscReal high, Condensed *w)
{
  const PetscInt z = whole->n - m;

  PetscFunctionBeginUser;
  *w = (Condensed){.whole  = whole,
                   .few    = {.n = m, .damped = whole->damped, .symmetric = whole->symmetric},
                   .m      = m,
                   .z      = z,
                   .linear = whole->damped ? CONDENSE_LAMBDA * high : 0,
                   .square = (whole->damped ? PetscSqr(CONDENSE_LAMBDA) : CONDENSE_SQUARE) * high * high};
  PetscCall(PetscMalloc3(m * m, &w->few.K, m * m, &w->few.C, m * m, &w->few.M));
  PetscCall(PetscMalloc4(z * z, &w->LU, m * z, &w->right, m * z, &w->left, z, &w->pivot));
  for (int k = 0; k < 2; k++) PetscCall(PetscMalloc2(m * z, &w->rest[k][0], m * z, &w->rest[k][1]));
  PetscFunctionReturn(0);
}

static PetscErrorCode CondensedDestroy(Condensed *w)
{
  PetscFunctionBeginUser;
  for (int k = 0; k < 2; k++) PetscCall(PetscFree2(w->rest[k][0], w->rest[k][1]));
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
    PetscCall(MatrixCondense(w, A[k], w->rest[k][0], B[k]));
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

/* Largest relative change of a mode by the couplings left. Near a lock-in y'Q'x is small and the change large: too
   large a one sends the point to the whole problem */
static PetscErrorCode CondensedJudge(const Condensed *w, const ReducedModes *modes, PetscReal *worst)
{
  const PetscInt n = modes->n, m = w->m, z = w->z;
  PetscComplex  *r, *s, *Mx, *Cx;
  PetscReal     *parts;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc5(n * z, &r, n * z, &s, n * m, &Mx, n * m, &Cx, 2 * n * z, &parts));
  PetscCall(CouplingsLeft(w, modes, PETSC_FALSE, r));
  PetscCall(CouplingsLeft(w, modes, PETSC_TRUE, s));
  DenseSplit(n * z, r, parts);
  PetscCall(DenseSolve(z, w->LU, w->pivot, PETSC_FALSE, 2 * n, parts));
  DenseUnite(n * z, parts, r);
  PetscCall(DenseTimes(&(DenseBlock){w->few.M, m, m, m}, PETSC_FALSE, n, modes->x, Mx));
  PetscCall(DenseTimes(&(DenseBlock){w->few.C, m, m, m}, PETSC_FALSE, n, modes->x, Cx));
  *worst = 0;
  for (PetscInt i = 0; i < n; i++) {
    const PetscComplex lambda = modes->lambda[i], *y = modes->y + i * m;
    const PetscReal    size = cabs(lambda), change = cabs(DenseDot(z, s + i * z, r + i * z));
    const PetscReal    mass  = cabs(DenseDot(m, y, Mx + i * m));
    const PetscReal    slope = cabs(2 * lambda * DenseDot(m, y, Mx + i * m) + DenseDot(m, y, Cx + i * m));

    if (modes->rigid[i] || size == 0 || change == 0) continue;
    *worst = PetscMax(*worst, slope > 0 && mass > 0 ? change / (slope * size) : INFINITY);
  }
  PetscCall(PetscFree5(r, s, Mx, Cx, parts));
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

PetscErrorCode CondensedEigen(const DensePencil *pencil, const ReducedCore *core, const ReducedWindow *window,
                              ReducedModes *modes, PetscBool *found)
{
  Condensed    w;
  ReducedModes few;
  PetscBool    singular;
  PetscReal    worst = INFINITY;

  PetscFunctionBeginUser;
  *found = PETSC_FALSE;
  PetscCall(CondensedCreate(pencil, core->m, window->high, &w));
  PetscCall(PencilCondense(&w, &singular));
  if (!singular) {
    PetscCall(DensePencilEigen(&w.few, NULL, window, &few));
    if (few.n) PetscCall(CondensedJudge(&w, &few, &worst));
    if (worst <= core->rtol) *found = PETSC_TRUE;
    if (*found) PetscCall(CondensedLift(&w, &few, modes));
    PetscCall(ReducedModesDestroy(&few));
  }
  PetscCall(CondensedDestroy(&w));
  PetscFunctionReturn(0);
}
