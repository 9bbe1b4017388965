/*
   Modes with close eigenvalues, treated together by the plane that their vectors span. With the standard form

      undamped  A = K,                         B = M,                          z = x,                mu = kappa
      damped    A = [-K 0; 0 scale^2 M],       B = [scale C, scale^2 M; scale^2 M, 0],
                z = [x; mu x],                 mu = lambda / scale

   and orthonormal bases X of the right and Y of the left plane, the modes are the eigenvalues of (Y^T A X, Y^T B X).
   What Z adds, Q_eff - Q_vv = -Q_vz Q_zz^-1 Q_zv at the mean eigenvalue (see estimate.c), changes Y^T A X by

      -F (undamped), +F (damped),   F = Y_1^T Q_vz Q_zz^-1 Q_zv X_1,   X_1 the first block of X;

   the eigenvalues of the changed pencil are the new ones. They exist at a defective pair too, where they move by the
   root of the change. There the vectors of the modes are parallel and span no plane: inverse iteration about the mean
   finds the missing direction.
*/
#include "estimate.h"
#include "dense.h"

#define PARALLEL   1e-11 /* least independent part of a vector that is more than rounding */
#define OFF_CENTRE 1e-4  /* shift of the inverse iteration beside the mean, relative */
#define ITERATIONS 4

/* The plane of m modes */
typedef struct {
  const Estimate *e;
  PetscInt        m, N;
  PetscComplex    lambda; /* mean */
  PetscReal       scale;
  PetscComplex   *X, *Y; /* [m][N] */
} Plane;

/* Y += factor op(A) X with the leading n_v x n_v block of A, columns [n_v] at distances N */
static PetscErrorCode TimesBlock(const Plane *plane, const PetscReal A[], PetscBool transposed, PetscReal factor,
                                 const PetscComplex X[], PetscComplex Y[])
{
  const PetscInt n = plane->e->n_v, N = plane->N;
  PetscComplex  *y;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n, &y));
  for (PetscInt a = 0; a < plane->m; a++) {
    PetscCall(DenseTimes(n, n, A, plane->e->n, transposed, 1, X + a * N, y));
    for (PetscInt i = 0; i < n; i++) Y[a * N + i] += factor * y[i];
  }
  PetscCall(PetscFree(y));
  PetscFunctionReturn(0);
}

/* Y = A X, [m][N] */
static PetscErrorCode ApplyA(const Plane *plane, const PetscComplex X[], PetscComplex Y[])
{
  const Estimate *e      = plane->e;
  const PetscReal square = plane->scale * plane->scale;

  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(Y, plane->m * plane->N));
  PetscCall(TimesBlock(plane, e->K, PETSC_FALSE, e->damped ? -1 : 1, X, Y));
  if (e->damped) PetscCall(TimesBlock(plane, e->M, PETSC_FALSE, square, X + e->n_v, Y + e->n_v));
  PetscFunctionReturn(0);
}

/* Y = op(B) X, [m][N] */
static PetscErrorCode ApplyB(const Plane *plane, PetscBool transposed, const PetscComplex X[], PetscComplex Y[])
{
  const Estimate *e      = plane->e;
  const PetscReal square = plane->scale * plane->scale;

  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(Y, plane->m * plane->N));
  PetscCall(TimesBlock(plane, e->M, transposed, e->damped ? square : 1, X, Y + plane->N - e->n_v));
  if (!e->damped) PetscFunctionReturn(0);
  PetscCall(TimesBlock(plane, e->C, transposed, plane->scale, X, Y));
  PetscCall(TimesBlock(plane, e->M, transposed, square, X + e->n_v, Y));
  PetscFunctionReturn(0);
}

/* Factors of Q(lambda) on V */
static PetscErrorCode FactorQ(const Estimate *e, PetscComplex lambda, PetscComplex Q[], PetscBLASInt pivot[])
{
  PetscFunctionBeginUser;
  for (PetscInt j = 0; j < e->n_v; j++)
    for (PetscInt i = 0; i < e->n_v; i++) {
      const PetscInt at = j * e->n + i;

      Q[j * e->n_v + i] = e->K[at] + (e->damped ? lambda * e->C[at] : 0) + lambda * lambda * e->M[at];
    }
  PetscCall(ComplexFactor(e->n_v, Q, pivot, NULL));
  PetscFunctionReturn(0);
}

/* X := op(A - mu B)^-1 op(B) X with factors of Q at the mu of lambda. Damped: u_2 = x_1 + mu u_1,
   Q u_1 = -(op(B) x)_1 - mu scale^2 op(M) x_1 */
static PetscErrorCode InverseStep(const Plane *plane, PetscComplex lambda, const PetscComplex Q[],
                                  const PetscBLASInt pivot[], PetscBool transposed, PetscComplex X[])
{
  const Estimate    *e = plane->e;
  const PetscInt     n = e->n_v, N = plane->N;
  const PetscComplex mu = lambda / plane->scale;
  PetscComplex      *BX;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(plane->m * N, &BX));
  PetscCall(ApplyB(plane, transposed, X, BX));
  for (PetscInt a = 0; a < plane->m; a++) {
    PetscComplex *const b = BX + a * N, *const x = X + a * N;

    /* the second block of op(B) x is scale^2 op(M) x_1 */
    for (PetscInt i = 0; i < n && e->damped; i++) b[i] = -b[i] - mu * b[n + i];
    PetscCall(ComplexSolve(n, Q, pivot, transposed, 1, b));
    for (PetscInt i = 0; i < n; i++) {
      if (e->damped) x[n + i] = x[i] + mu * b[i];
      x[i] = b[i];
    }
  }
  PetscCall(PetscFree(BX));
  PetscFunctionReturn(0);
}

/* Completes a plane of which only kept of m directions are known */
static PetscErrorCode InverseIterate(const Plane *plane, PetscBool transposed, PetscInt kept, PetscComplex X[])
{
  const PetscInt     n = plane->e->n_v, N = plane->N;
  const PetscComplex lambda = plane->lambda * (1 + OFF_CENTRE * CMPLX(1, 1));
  PetscComplex      *Q;
  PetscBLASInt      *pivot;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(n * n, &Q, n, &pivot));
  PetscCall(FactorQ(plane->e, lambda, Q, pivot));
  for (PetscInt i = kept * N; i < plane->m * N; i++) X[i] = cos(1.0 + i * (PetscReal)i); /* any other */
  for (int k = 0; k < ITERATIONS; k++) {
    PetscCall(InverseStep(plane, lambda, Q, pivot, transposed, X));
    PetscCall(ComplexOrthonormalise(N, plane->m, 0, X, &kept));
  }
  PetscCall(PetscFree2(Q, pivot));
  PetscFunctionReturn(0);
}

/* Orthonormal basis of the vectors x of the modes list[m] in the standard form */
static PetscErrorCode PlaneFill(const Plane *plane, const PetscInt list[], const PetscComplex x[], PetscBool left,
                                PetscComplex X[])
{
  const ReducedModes *modes = plane->e->modes;
  const PetscInt      n = plane->e->n_v, N = plane->N;
  PetscInt            kept;

  PetscFunctionBeginUser;
  for (PetscInt a = 0; a < plane->m; a++)
    for (PetscInt i = 0; i < N; i++)
      X[a * N + i] = x[list[a] * n + i % n] * (i < n ? 1 : modes->lambda[list[a]] / plane->scale);
  PetscCall(ComplexOrthonormalise(N, plane->m, PARALLEL, X, &kept));
  if (kept < plane->m) PetscCall(InverseIterate(plane, left, kept, X));
  PetscFunctionReturn(0);
}

static PetscErrorCode PlaneCreate(const Estimate *e, PetscInt m, const PetscInt list[], Plane *plane)
{
  PetscComplex mean = 0;

  PetscFunctionBeginUser;
  for (PetscInt a = 0; a < m; a++) mean += EstimateValue(e, e->modes->lambda[list[a]]) / m;
  plane->e      = e;
  plane->m      = m;
  plane->N      = e->damped ? 2 * e->n_v : e->n_v;
  plane->lambda = e->damped ? mean : cimag(mean) == 0 && creal(mean) > 0 ? CMPLX(0, sqrt(creal(mean))) : csqrt(-mean);
  plane->scale  = cabs(plane->lambda) > 0 ? cabs(plane->lambda) : 1;
  PetscCall(PetscMalloc2(m * plane->N, &plane->X, m * plane->N, &plane->Y));
  PetscCall(PlaneFill(plane, list, e->modes->x, PETSC_FALSE, plane->X));
  PetscCall(PlaneFill(plane, list, e->modes->y, PETSC_TRUE, plane->Y));
  PetscFunctionReturn(0);
}

/* F_ij in F[j * m + i] */
static PetscErrorCode FormF(const Plane *plane, PetscComplex F[], PetscBool *singular)
{
  const Estimate *e = plane->e;
  const PetscInt  m = plane->m, n = e->n_v;
  PetscComplex   *first[2], *r[2];

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc4(m * n, &first[0], m * n, &first[1], m * e->n_z, &r[0], m * e->n_z, &r[1]));
  for (PetscInt a = 0; a < m; a++) {
    PetscCall(PetscArraycpy(first[0] + a * n, plane->X + a * plane->N, n));
    PetscCall(PetscArraycpy(first[1] + a * n, plane->Y + a * plane->N, n));
  }
  PetscCall(EstimateCouple(e, plane->lambda, PETSC_FALSE, m, first[0], r[0]));
  PetscCall(EstimateCouple(e, plane->lambda, PETSC_TRUE, m, first[1], r[1]));
  PetscCall(EstimateSolve(e, plane->lambda, m, r[0], singular));
  for (PetscInt i = 0; i < m; i++)
    for (PetscInt j = 0; j < m; j++) F[j * m + i] = DenseDot(e->n_z, r[1] + i * e->n_z, r[0] + j * e->n_z);
  PetscCall(PetscFree4(first[0], first[1], r[0], r[1]));
  PetscFunctionReturn(0);
}

/* Eigenvalues mu[m] of the changed pencil of the plane */
static PetscErrorCode PlaneEigenvalues(const Plane *plane, PetscComplex F[], PetscComplex mu[])
{
  const PetscInt  m = plane->m, N = plane->N;
  const PetscReal sign = plane->e->damped ? 1 : -1, unit = plane->e->damped ? plane->scale : 1;
  PetscComplex   *AX, *BX, *B;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc3(m * N, &AX, m * N, &BX, m * m, &B));
  PetscCall(ApplyA(plane, plane->X, AX));
  PetscCall(ApplyB(plane, PETSC_FALSE, plane->X, BX));
  for (PetscInt i = 0; i < m; i++)
    for (PetscInt j = 0; j < m; j++) {
      F[j * m + i] = DenseDot(N, plane->Y + i * N, AX + j * N) + sign * F[j * m + i];
      B[j * m + i] = DenseDot(N, plane->Y + i * N, BX + j * N);
    }
  PetscCall(ComplexEigenvalues(m, F, B, mu));
  for (PetscInt i = 0; i < m; i++) mu[i] *= unit;
  PetscCall(PetscFree3(AX, BX, B));
  PetscFunctionReturn(0);
}

/* Orders mu[m] like the modes list[m]: repeatedly the nearest pair of those left */
static PetscErrorCode MatchNearest(const Plane *plane, const PetscInt list[], PetscComplex mu[])
{
  const PetscInt m = plane->m;
  PetscBool     *done;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(m, &done));
  for (PetscInt step = 0; step < m; step++) {
    PetscInt     at = -1, with = -1;
    PetscReal    least = INFINITY;
    PetscComplex swap;

    for (PetscInt a = 0; a < m; a++)
      for (PetscInt b = 0; b < m && !done[a]; b++) {
        const PetscReal distance = cabs(mu[b] - EstimateValue(plane->e, plane->e->modes->lambda[list[a]]));

        if (done[b] || (at >= 0 && !(distance < least))) continue;
        least = distance, at = a, with = b;
      }
    /* the value with comes to place at, and that of at to place with */
    swap = mu[at], mu[at] = mu[with], mu[with] = swap;
    done[at] = PETSC_TRUE;
  }
  PetscCall(PetscFree(done));
  PetscFunctionReturn(0);
}

PetscErrorCode EstimateCluster(const Estimate *e, PetscInt m, const PetscInt list[], PetscComplex mu[],
                               PetscBool *singular)
{
  Plane         plane;
  PetscComplex *F;

  PetscFunctionBeginUser;
  PetscCall(PlaneCreate(e, m, list, &plane));
  PetscCall(PetscMalloc1(m * m, &F));
  PetscCall(FormF(&plane, F, singular));
  if (!*singular) {
    PetscCall(PlaneEigenvalues(&plane, F, mu));
    PetscCall(MatchNearest(&plane, list, mu));
  }
  PetscCall(PetscFree(F));
  PetscCall(PetscFree2(plane.X, plane.Y));
  PetscFunctionReturn(0);
}
