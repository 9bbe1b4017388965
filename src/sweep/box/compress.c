/*
   A smaller basis for many points. The basis of the full solutions holds what single points need; of the modes of all
   points of the box fewer directions matter. From their snapshots s, right and left vectors at some points, in
   coordinates of the basis, the directions

      C W v = sigma^2 v,   C = sum (h / |lambda|)^2 s s',   W = |K| + h^2 M,  v' W v = 1

   come in the order of the energy that they hold (proper orthogonal decomposition; K. Karhunen, M. Loeve), h the
   upper end of the window and |K| the symmetric part of K at the nominal point. The leading ones are the model, the
   next ones estimate its error as new vectors do that of the basis itself (dense/estimate.c), to which the largest
   relative error of that, estimated at the points that it was made for, is added.

   A point where both together exceed rtol is solved on the whole basis. As many directions m are taken as make the cost
   of a point, m^3 + f n^3, the least, f the share of these points that need the whole basis of n vectors.
*/
#include "box.h"
#include "sweep/dense/eigen.h"
#include "base/algebra/dense.h"

#define SNAPSHOTS     32   /* points whose modes are taken */
#define COMPRESS_FROM 5e-7 /* tolerances that are tried */
#define COMPRESS_TO   1e-3
#define ESTIMATES     40 /* fewer tell too little: of 15 vectors with 7 more the true error was all that was stated */
#define COMPRESS_STEP 1.5
#define LEAST_OMEGA       0.01 /* slower modes count as if they were at this part of the upper end of the window */
#define LEAST_GAIN    0.7  /* a basis that is not smaller than this part of the other one is of no use */

/* B [m][m] = V' A V of the leading n x n block of A (column stride lda), V [m][n] */
static PetscErrorCode MatrixProject(PetscInt n, PetscInt lda, const PetscReal A[], PetscInt m, const PetscReal V[],
                                    PetscReal B[])
{
  PetscReal *AV;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(n * m, &AV));
  for (PetscInt k = 0; k < m; k++)
    for (PetscInt j = 0; j < n; j++) {
      const PetscReal v = V[k * n + j];

      for (PetscInt i = 0; i < n; i++) AV[k * n + i] += v * A[j * lda + i];
    }
  for (PetscInt k = 0; k < m; k++)
    for (PetscInt l = 0; l < m; l++) {
      PetscReal sum = 0;

      for (PetscInt i = 0; i < n; i++) sum += V[l * n + i] * AV[k * n + i];
      B[k * m + l] = sum;
    }
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

  PetscFunctionBeginUser;
  PetscCall(ReducedPencil(&box->basis.reduced, box->nominal, n, &pencil));
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

/* The model of the m leading directions, and those that follow for its estimate, half as many but ESTIMATES at least */
static PetscErrorCode SmallMake(const Box *box, PetscInt m, const PetscReal V[], Reduced *small)
{
  const Reduced *large = &box->basis.reduced;
  const PetscInt n     = large->n_used;

  PetscFunctionBeginUser;
  *small        = *large;
  small->n_used = m;
  small->n      = PetscMin(n, m + PetscMax(m / 2, ESTIMATES));
  PetscCall(PetscCalloc1(large->n_terms, &small->A));
  PetscCall(PetscCalloc1(large->n_terms, &small->D));
  for (PetscInt t = 0; t < large->n_terms; t++) {
    PetscCall(PetscMalloc1(small->n * small->n, &small->A[t]));
    PetscCall(MatrixProject(n, large->n, large->A[t], small->n, V, small->A[t]));
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
    PetscCall(SmallMake(box, m, V, &small));
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

PetscErrorCode BoxCompress(Box *box, PetscInt n_points, const PetscReal points[])
{
  const PetscInt n = box->basis.reduced.n_used, n_snapshots = PetscMin(n_points, SNAPSHOTS);
  PetscReal     *C, *V, *w;
  PetscBool      found;

  PetscFunctionBeginUser;
  PetscCall(BoxForgetSmall(&box->small));
  if (box->whole) PetscFunctionReturn(0);
  PetscCall(PetscCalloc3(n * n, &C, n * n, &V, n, &w));
  PetscCall(SnapshotsTake(box, n_snapshots, points, C));
  PetscCall(DirectionsFind(box, C, V, w, &found));
  PetscCallMPI(MPI_Bcast(&found, 1, MPIU_BOOL, 0, box->comm));
  if (found) PetscCall(SmallChoose(box, n_points, points, V, w));
  PetscCall(PetscFree3(C, V, w));
  PetscFunctionReturn(0);
}
