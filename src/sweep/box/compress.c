/*
   A smaller basis for many points. The basis of the full solutions holds what single points need; of the modes of all
   points of the box fewer directions matter. From their snapshots s, right and left vectors at some points, in
   coordinates of the basis, the directions

      C W v = sigma^2 v,   C = sum (h / |lambda|)^2 s s',   W = |K| + h^2 M,  v' W v = 1

   come in the order of the energy that they hold (proper orthogonal decomposition; K. Karhunen, M. Loeve), h the upper
   end of the window and |K| the symmetric part of K at the nominal point without friction: that of friction on stiff
   pairs has negative eigenvalues as large as theirs. The leading directions are the model, the next ones estimate its
   error as new vectors do that of the basis itself (dense/estimate.c), to which the largest relative error of that,
   estimated at the points that it was made for, is added.

   Of the whole basis, in all of these directions, the leading ones are a core in which its modes are sought, with what
   the others do taken in (dense/condense.c): a point costs a problem of the core then, at an error of a small part of
   rtol.

   A point where both together exceed rtol is solved on the whole basis. As many directions m are taken as make the cost
   of a point, m^3 + f n^3, the least, f the share of these points that need the whole basis of n vectors.
*/
#include "box.h"
#include "sweep/dense/eigen.h"
#include "base/algebra/dense.h"
#include <petscblaslapack.h>

#define SNAPSHOTS     32   /* points whose modes are taken */
#define COMPRESS_FROM 5e-7 /* tolerances that are tried */
#define COMPRESS_TO   1e-3
#define ESTIMATES     40 /* fewer tell too little: of 15 vectors with 7 more the true error was all that was stated */
#define COMPRESS_STEP 2.25
#define COMPRESS_MOST 30   /* points, at which each is tried */
#define LEAST_OMEGA   0.01 /* slower modes count as if they were at this part of the upper end of the window */
#define CORE_FROM     200  /* vectors, below which all eigenvalues of the basis cost little */
#define CORE_RTOL     0.02 /* of rtol, what the others may add to a mode of the core */
#define CORE_POINTS   12   /* at which that is tried, and at how many of them it may fail */
#define CORE_FAIL     1
#define LEAST_GAIN    0.7 /* a basis that is not smaller than this part of the other one is of no use */

/* B [m][m] = V' A V of the leading n x n block of A (column stride lda), V [m][n] */
static PetscErrorCode MatrixProject(PetscInt n, PetscInt lda, const PetscReal A[], PetscInt m, const PetscReal V[],
                                    PetscReal B[])
{
  const PetscReal one = 1, zero = 0;
  PetscReal      *AV;
  PetscBLASInt    size, stride, columns;

  PetscFunctionBeginUser;
  PetscCall(PetscBLASIntCast(n, &size));
  PetscCall(PetscBLASIntCast(lda, &stride));
  PetscCall(PetscBLASIntCast(m, &columns));
  PetscCall(PetscMalloc1(n * m, &AV));
  PetscCallBLAS("BLASgemm", BLASgemm_("N", "N", &size, &columns, &size, &one, A, &stride, V, &size, &zero, AV, &size));
  PetscCallBLAS("BLASgemm",
                BLASgemm_("T", "N", &columns, &columns, &size, &one, V, &size, AV, &size, &zero, B, &columns));
  PetscCall(PetscFree(AV));
  PetscFunctionReturn(0);
}

/* Adds the real and imaginary parts of vectors X [m][n] of modes lambda to C [n][n], h / |lambda| times: errors are to
   be a part of each frequency */
static void SnapshotsAdd(PetscReal h, PetscInt n, PetscInt m, const PetscComplex lambda[], const PetscComplex X[],
                         PetscReal C[])
{
  for (PetscInt a = 0; a < m; a++)
    for (PetscInt j = 0; j < n; j++) {
      const PetscReal scale = PetscSqr(h / PetscMax(cabs(lambda[a]), LEAST_OMEGA * h));
      const PetscReal re = scale * creal(X[a * n + j]), im = scale * cimag(X[a * n + j]);

      for (PetscInt i = 0; i < n; i++) C[j * n + i] += re * creal(X[a * n + i]) + im * cimag(X[a * n + i]);
    }
}

/* W [n][n] of the nominal point */
static PetscErrorCode EnergyForm(const Box *box, PetscReal W[])
{
  const PetscInt  n = box->basis.reduced.n_used;
  const PetscReal h = box->window.high;
  DensePencil     pencil;
  PetscReal      *p;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(box->n_parameters, &p));
  PetscCall(PetscArraycpy(p, box->nominal, box->n_parameters));
  if (!ReducedFrictionless(&box->basis.reduced, p))
    PetscCall(PetscArraycpy(p, box->nominal, box->n_parameters)); /* it may not be definite, which is found out */
  PetscCall(ReducedPencil(&box->basis.reduced, p, n, &pencil));
  PetscCall(PetscFree(p));
  for (PetscInt j = 0; j < n; j++)
    for (PetscInt i = 0; i < n; i++)
      W[j * n + i] =
        0.5 * (pencil.K[j * n + i] + pencil.K[i * n + j] + h * h * (pencil.M[j * n + i] + pencil.M[i * n + j]));
  PetscCall(DensePencilDestroy(&pencil));
  PetscFunctionReturn(0);
}

/* V [n][n]: directions in the order of what they hold, orthonormal as the basis is in M (Gram-Schmidt, twice); w [n]
   sigma^2 likewise. found is false where W is not definite */
static PetscErrorCode DirectionsFind(const Box *box, const PetscReal C[], PetscReal V[], PetscReal w[],
                                     PetscBool *found)
{
  const PetscInt n = box->basis.reduced.n_used;
  PetscReal     *W, *WCW;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(n * n, &W, n * n, &WCW));
  PetscCall(EnergyForm(box, W));
  PetscCall(MatrixProject(n, n, C, n, W, WCW));
  PetscCall(DenseSymmetricEigen(n, WCW, W, w, found));
  for (PetscInt k = 0; k < n && *found; k++) {
    PetscReal *v = &V[k * n], square = 0;

    PetscCall(PetscArraycpy(v, &WCW[(n - 1 - k) * n], n));
    for (PetscInt l = 0; l < 2 * k; l++) {
      PetscReal product = 0;

      for (PetscInt i = 0; i < n; i++) product += v[i] * V[(l % k) * n + i];
      for (PetscInt i = 0; i < n; i++) v[i] -= product * V[(l % k) * n + i];
    }
    for (PetscInt i = 0; i < n; i++) square += v[i] * v[i];
    for (PetscInt i = 0; i < n; i++) v[i] /= PetscSqrtReal(square);
  }
  for (PetscInt k = 0; k < n / 2; k++) {
    const PetscReal swapped = w[k];

    w[k]         = w[n - 1 - k];
    w[n - 1 - k] = swapped;
  }
  PetscCall(PetscFree2(W, WCW));
  PetscFunctionReturn(0);
}

/* The factors of a term on m directions */
static PetscErrorCode FactorsProject(PetscInt n, const ReducedFactors *large, PetscInt m, const PetscReal V[],
                                     ReducedFactors *small)
{
  const PetscReal *from[] = {large->left, large->right}, one = 1, zero = 0;
  PetscReal      **to[] = {&small->left, &small->right};
  PetscBLASInt     rank, size, columns;

  PetscFunctionBeginUser;
  small->rank = large->rank;
  PetscCall(PetscBLASIntCast(large->rank, &rank));
  PetscCall(PetscBLASIntCast(n, &size));
  PetscCall(PetscBLASIntCast(m, &columns));
  for (int i = 0; i < 2 && rank; i++) {
    PetscCall(PetscMalloc1(m * rank, to[i]));
    PetscCallBLAS("BLASgemm",
                  BLASgemm_("N", "N", &rank, &columns, &size, &one, from[i], &rank, V, &size, &zero, *to[i], &rank));
  }
  PetscFunctionReturn(0);
}

/* The matrix of term t, from its factors where that is less work */
static PetscErrorCode TermOnDirections(const Reduced *large, PetscInt t, const PetscReal V[], Reduced *small)
{
  const ReducedFactors *factors = &small->factors[t];
  const PetscReal       one = 1, zero = 0;
  PetscBLASInt          rank, size;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(small->n * small->n, &small->A[t]));
  if (!ReducedFactorsRank(small, t, small->n)) {
    PetscCall(MatrixProject(large->n_used, large->n, large->A[t], small->n, V, small->A[t]));
    PetscFunctionReturn(0);
  }
  PetscCall(PetscBLASIntCast(factors->rank, &rank));
  PetscCall(PetscBLASIntCast(small->n, &size));
  PetscCallBLAS("BLASgemm", BLASgemm_("T", "N", &size, &size, &rank, &one, factors->left, &rank, factors->right, &rank,
                                      &zero, small->A[t], &size));
  PetscFunctionReturn(0);
}

/* The model of the m leading directions, and those that follow for its estimate, half as many but ESTIMATES at least;
   lean: terms that go by their factors have nothing else */
static PetscErrorCode SmallMake(const Box *box, PetscInt m, const PetscReal V[], PetscBool lean, Reduced *small)
{
  const Reduced *large = &box->basis.reduced;
  const PetscInt n     = large->n_used;

  PetscFunctionBeginUser;
  *small        = *large;
  small->n_used = m;
  small->n      = PetscMin(n, m + PetscMax(m / 2, ESTIMATES));
  PetscCall(PetscCalloc1(large->n_terms, &small->A));
  PetscCall(PetscCalloc1(large->n_terms, &small->D));
  PetscCall(PetscCalloc1(large->n_terms, &small->factors));
  for (PetscInt t = 0; t < large->n_terms; t++) {
    if (large->factors) PetscCall(FactorsProject(n, &large->factors[t], small->n, V, &small->factors[t]));
    if (!lean || !ReducedFactorsRank(small, t, small->n)) PetscCall(TermOnDirections(large, t, V, small));
    if (!large->D || !large->D[t]) continue;
    PetscCall(PetscMalloc1(m * m, &small->D[t]));
    PetscCall(MatrixProject(n, n, large->D[t], m, V, small->D[t]));
  }
  PetscFunctionReturn(0);
}

/* Cost of a point in operations of a vector cubed, as far as the n points tell */
static PetscErrorCode SmallCost(const Box *box, const Reduced *small, PetscInt n, const PetscReal points[],
                                PetscReal *cost)
{
  PetscReal *worst, exceeding = 0;

  PetscFunctionBeginUser;
  points += PetscMax(0, n - COMPRESS_MOST) * box->n_parameters; /* the last ones: snapshots are of the first */
  n = PetscMin(n, COMPRESS_MOST);
  PetscCall(PetscMalloc1(n, &worst));
  PetscCall(PointsEstimate(&box->groups, small, &box->window, n, points, worst));
  for (PetscInt i = 0; i < n; i++) exceeding += worst[i] + box->greedy.worst > box->rtol ? 1 : 0;
  *cost = PetscPowReal(small->n_used, 3) + exceeding / (PetscReal)n * PetscPowReal(box->basis.reduced.n_used, 3);
  PetscCall(PetscFree(worst));
  PetscFunctionReturn(0);
}

/* The covariance C of right and left vectors of all modes at n points */
static PetscErrorCode SnapshotsTake(const Box *box, PetscInt n, const PetscReal points[], PetscReal C[])
{
  const PetscInt  size = box->basis.reduced.n_used;
  const PetscReal h    = box->window.high;
  ReducedModes   *modes;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n, &modes));
  PetscCall(BoxSolveAll(box, n, points, modes));
  for (PetscInt i = 0; i < n; i++) {
    SnapshotsAdd(h, size, modes[i].n, modes[i].lambda, modes[i].x, C);
    SnapshotsAdd(h, size, modes[i].n, modes[i].lambda, modes[i].y, C);
    PetscCall(ReducedModesDestroy(&modes[i]));
  }
  PetscCall(PetscFree(modes));
  PetscFunctionReturn(0);
}

/* Tries fewer and fewer directions, those whose part of the largest sigma exceeds a tolerance, until the cost rises.
   The number is that of rank 0, whose rounding decides for all. */
static PetscErrorCode SmallChoose(Box *box, PetscInt n_points, const PetscReal points[], const PetscReal V[],
                                  const PetscReal w[])
{
  const PetscInt n     = box->basis.reduced.n_used;
  PetscReal      least = PetscPowReal(LEAST_GAIN * n, 3), cost;

  PetscFunctionBeginUser;
  for (PetscReal tolerance = COMPRESS_FROM; tolerance < COMPRESS_TO; tolerance *= COMPRESS_STEP) {
    Reduced   small;
    PetscInt  m = 0;
    PetscBool better;

    while (m < n && w[m] > PetscSqr(tolerance) * w[0]) m++;
    PetscCallMPI(MPI_Bcast(&m, 1, MPIU_INT, 0, box->comm));
    if (PetscPowReal(m, 3) >= least) continue;
    PetscCall(SmallMake(box, m, V, PETSC_FALSE, &small));
    PetscCall(SmallCost(box, &small, n_points, points, &cost));
    better = cost < least ? PETSC_TRUE : PETSC_FALSE;
    if (!better) PetscCall(BoxForgetSmall(&small));
    if (!better && box->small.n_used) break;
    if (!better) continue;
    PetscCall(BoxForgetSmall(&box->small));
    box->small = small;
    least      = cost;
  }
  PetscFunctionReturn(0);
}

/* Whether the core is good enough at p */
static PetscErrorCode CoreHolds(const Reduced *reduced, const PetscReal p[], const ReducedWindow *window,
                                PetscBool *holds)
{
  DensePencil  pencil;
  ReducedModes modes;

  PetscFunctionBeginUser;
  PetscCall(ReducedPencil(reduced, p, reduced->n_used, &pencil));
  PetscCall(CondensedEigen(&pencil, NULL, &reduced->core, window, &modes, holds));
  if (*holds) PetscCall(ReducedModesDestroy(&modes));
  PetscCall(DensePencilDestroy(&pencil));
  PetscFunctionReturn(0);
}

/* The turned basis, and the smallest core that is good enough at nearly all of some points: n_used = 0 where none is.
   What rank 0 finds decides for all. */
static PetscErrorCode CoreChoose(Box *box, PetscInt n_points, const PetscReal points[], const PetscReal V[])
{
  static const PetscReal share[] = {0.2, 0.25, 0.3, 0.4};
  const PetscInt         n = box->basis.reduced.n_used, step = PetscMax(1, n_points / CORE_POINTS);
  PetscBool              chosen = PETSC_FALSE;

  PetscFunctionBeginUser;
  if (n < CORE_FROM || box->window.rtol > 0) PetscFunctionReturn(0);
  PetscCall(PetscMalloc1(n * n, &box->turn));
  PetscCall(PetscArraycpy(box->turn, V, n * n));
  PetscCall(SmallMake(box, n, V, PETSC_TRUE, &box->turned));
  for (size_t k = 0; k < PETSC_STATIC_ARRAY_LENGTH(share) && !chosen; k++) {
    PetscInt failed = 0;

    box->turned.core = (ReducedCore){(PetscInt)(share[k] * (PetscReal)n), CORE_RTOL * box->rtol};
    for (PetscInt i = 0; i < n_points && failed <= CORE_FAIL; i += step) {
      PetscBool holds;

      PetscCall(CoreHolds(&box->turned, &points[i * box->n_parameters], &box->window, &holds));
      failed += holds ? 0 : 1;
    }
    chosen = failed <= CORE_FAIL ? PETSC_TRUE : PETSC_FALSE;
    PetscCallMPI(MPI_Bcast(&chosen, 1, MPIU_BOOL, 0, box->comm));
  }
  if (!chosen) PetscCall(BoxForgetSmall(&box->turned));
  PetscFunctionReturn(0);
}

PetscErrorCode BoxCompress(Box *box, PetscInt n_points, const PetscReal points[])
{
  const PetscInt n = box->basis.reduced.n_used, n_snapshots = PetscMin(n_points, SNAPSHOTS);
  PetscReal     *C, *V, *w;
  PetscBool      found;

  PetscFunctionBeginUser;
  PetscCall(BoxForgetSmall(&box->small));
  PetscCall(BoxForgetSmall(&box->turned));
  PetscCall(PetscFree(box->turn));
  PetscCall(PetscFree(box->few));
  if (box->whole) PetscFunctionReturn(0);
  PetscCall(PetscCalloc3(n * n, &C, n * n, &V, n, &w));
  PetscCall(SnapshotsTake(box, n_snapshots, points, C));
  PetscCall(DirectionsFind(box, C, V, w, &found));
  PetscCallMPI(MPI_Bcast(&found, 1, MPIU_BOOL, 0, box->comm));
  if (found) PetscCall(SmallChoose(box, n_points, points, V, w));
  if (box->small.n_used) {
    PetscCall(PetscMalloc1(n * box->small.n_used, &box->few));
    PetscCall(PetscArraycpy(box->few, V, n * box->small.n_used));
  }
  if (found) PetscCall(CoreChoose(box, n_points, points, V));
  PetscCall(PetscFree3(C, V, w));
  PetscFunctionReturn(0);
}
