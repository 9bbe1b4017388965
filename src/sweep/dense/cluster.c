/*
   Modes with close eigenvalues, treated together by the plane that their vectors span. With the standard form
   A z = s B z (standard.c) and orthonormal bases X of the right and Y of the left plane, the modes are the eigenvalues
   of (Y^T A X, Y^T B X). What Z adds, Q_eff - Q_vv = -Q_vz Q_zz^-1 Q_zv at the mean eigenvalue (see estimate.c),
   changes Y^T A X by

      -F (undamped), +F / scale (damped),   F = Y_1^T Q_vz Q_zz^-1 Q_zv X_1,   X_1 the first block of X;

   the eigenvalues of the changed pencil are the new ones. They exist at a defective pair too, where they move by the
   root of the change. There the vectors of the modes are parallel and span no plane: inverse iteration about the mean
   finds the missing direction.
*/
#include "estimate.h"

#define PLANE_PARALLEL 1e-11 /* least independent part of a vector that is more than rounding */
/* Shift of the inverse iteration beside the mean, relative, into the complex plane: at the mean itself Q is
   singular. Each step multiplies other modes by 1e-4 |lambda| over their distance. */
#define OFF_CENTRE 1e-4
/* With modes 1e-2 |lambda| away four steps leave some (1.4e-2)^4 = 4e-8 of them. */
#define ITERATIONS 4

/* The plane of m modes */
typedef struct {
  const Estimate *e;
  PetscInt        m, N;
  PetscComplex    lambda; /* mean */
  StandardForm    form;
  PetscComplex   *X, *Y; /* [m][N] */
} Plane;

/* X := op(A - s B)^-1 op(B) X with factors of Q(lambda). Damped, the second block of (A - s B) u = b := op(B) x is
   solved by u_2 = (x_1 + lambda u_1) / scale, since b_2 = op(M) x_1, and then op(Q) u_1 = -scale b_1 - lambda b_2 */
static PetscErrorCode InverseStep(const Plane *plane, PetscComplex lambda, const PetscComplex Q[],
                                  const PetscBLASInt pivot[], PetscBool transposed, PetscComplex X[])
{
  const PetscInt  n = plane->e->n_v, N = plane->N;
  const PetscBool damped = plane->form.damped;
  const PetscReal scale  = plane->form.scale;
  PetscComplex   *BX;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(plane->m * N, &BX));
  PetscCall(StandardApply(&plane->form, STANDARD_B, transposed, plane->m, X, BX));
  for (PetscInt a = 0; a < plane->m; a++) {
    PetscComplex *const b = BX + a * N, *const x = X + a * N;

    for (PetscInt i = 0; i < n && damped; i++) b[i] = -scale * b[i] - lambda * b[n + i];
    PetscCall(DenseComplexSolve(n, Q, pivot, transposed, 1, b));
    for (PetscInt i = 0; i < n; i++) {
      if (damped) x[n + i] = (x[i] + lambda * b[i]) / scale;
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
  DensePencilEvaluate(&plane->e->pencil, lambda, 0, n, Q);
  PetscCall(DenseComplexFactor(n, Q, pivot, NULL));
  for (PetscInt i = kept * N; i < plane->m * N; i++) X[i] = cos(1.0 + i * (PetscReal)i); /* any other */
  for (int k = 0; k < ITERATIONS; k++) {
    PetscCall(InverseStep(plane, lambda, Q, pivot, transposed, X));
    PetscCall(DenseOrthonormalise(N, plane->m, 0, X, &kept));
  }
  PetscCall(PetscFree2(Q, pivot));
  PetscFunctionReturn(0);
}

/* Orthonormal basis of the vectors x of the modes list[m] in the standard form. Where vectors are parallel, fewer
   than m directions are independent and the others are found by inverse iteration, left ones with the transposed
   factors. */
static PetscErrorCode PlaneFill(const Plane *plane, const PetscInt list[], const PetscComplex x[], PetscBool left,
                                PetscComplex X[])
{
  const PetscInt n = plane->e->n_v, N = plane->N;
  PetscInt       kept;

  PetscFunctionBeginUser;
  for (PetscInt a = 0; a < plane->m; a++)
    StandardVector(&plane->form, plane->e->modes->lambda[list[a]], x + list[a] * n, X + a * N);
  PetscCall(DenseOrthonormalise(N, plane->m, PLANE_PARALLEL, X, &kept));
  if (kept < plane->m) PetscCall(InverseIterate(plane, left, kept, X));
  PetscFunctionReturn(0);
}

static PetscErrorCode PlaneCreate(const Estimate *e, PetscInt m, const PetscInt list[], Plane *plane)
{
  PetscComplex mean = 0;

  PetscFunctionBeginUser;
  for (PetscInt a = 0; a < m; a++) mean += StandardValue(&e->form, e->modes->lambda[list[a]]) / m;
  plane->e      = e;
  plane->m      = m;
  plane->N      = StandardSize(&e->form);
  plane->form   = e->form;
  plane->lambda = e->form.damped                        ? mean
                  : cimag(mean) == 0 && creal(mean) > 0 ? CMPLX(0, sqrt(creal(mean)))
                                                        : csqrt(-mean);
  if (cabs(plane->lambda) > 0) plane->form.scale = cabs(plane->lambda);
  PetscCall(PetscMalloc2(m * plane->N, &plane->X, m * plane->N, &plane->Y));
  PetscCall(PlaneFill(plane, list, e->modes->x, PETSC_FALSE, plane->X));
  PetscCall(PlaneFill(plane, list, e->modes->y, PETSC_TRUE, plane->Y));
  PetscFunctionReturn(0);
}

/* F [m][m], F_ij = y_i^T Q_vz Q_zz^-1 Q_zv x_j in F[j * m + i], first blocks of X and Y, at the mean lambda: one
   factorisation of Q_zz for all modes of the plane. */
static PetscErrorCode FormF(const Plane *plane, PetscComplex F[], PetscBool *singular)
{
  const Estimate *e = plane->e;
  const PetscInt  m = plane->m, n = e->n_v;
  PetscComplex   *first[2], *r[2], *lambda;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc4(m * n, &first[0], m * n, &first[1], m * e->n_z, &r[0], m * e->n_z, &r[1]));
  for (PetscInt a = 0; a < m; a++) {
    PetscCall(PetscArraycpy(first[0] + a * n, plane->X + a * plane->N, n));
    PetscCall(PetscArraycpy(first[1] + a * n, plane->Y + a * plane->N, n));
  }
  PetscCall(PetscMalloc1(m, &lambda));
  for (PetscInt i = 0; i < m; i++) lambda[i] = plane->lambda;
  PetscCall(EstimateCouple(e, lambda, PETSC_FALSE, m, first[0], r[0]));
  PetscCall(EstimateCouple(e, lambda, PETSC_TRUE, m, first[1], r[1]));
  PetscCall(PetscFree(lambda));
  PetscCall(EstimateSolve(e, plane->lambda, m, r[0], singular));
  for (PetscInt i = 0; i < m; i++)
    for (PetscInt j = 0; j < m; j++) F[j * m + i] = DenseDot(e->n_z, r[1] + i * e->n_z, r[0] + j * e->n_z);
  PetscCall(PetscFree4(first[0], first[1], r[0], r[1]));
  PetscFunctionReturn(0);
}

/* Eigenvalues s[m] of the changed pencil of the plane */
static PetscErrorCode PlaneEigenvalues(const Plane *plane, const PetscComplex F[], PetscComplex s[])
{
  const PetscInt  m    = plane->m;
  const PetscReal unit = plane->form.damped ? 1 / plane->form.scale : -1;
  PetscComplex   *A, *B;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(m * m, &A, m * m, &B));
  PetscCall(StandardProject(&plane->form, m, plane->X, plane->Y, A, B));
  for (PetscInt i = 0; i < m * m; i++) A[i] += unit * F[i];
  PetscCall(DenseComplexEigenvalues(m, A, B, s));
  PetscCall(PetscFree2(A, B));
  PetscFunctionReturn(0);
}

/* Orders s[m] like the modes list[m]: repeatedly the nearest pair of those left. The order of two values means
   nothing by itself; the nearest one is the least change that both could have had. */
static PetscErrorCode MatchNearest(const Plane *plane, const PetscInt list[], PetscComplex s[])
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
        const PetscReal distance = cabs(s[b] - StandardValue(&plane->form, plane->e->modes->lambda[list[a]]));

        if (done[b] || (at >= 0 && !(distance < least))) continue;
        least = distance, at = a, with = b;
      }
    /* the value with comes to place at, and that of at to place with */
    swap = s[at], s[at] = s[with], s[with] = swap;
    done[at] = PETSC_TRUE;
  }
  PetscCall(PetscFree(done));
  PetscFunctionReturn(0);
}

PetscErrorCode EstimateCluster(const Estimate *e, PetscInt m, const PetscInt list[], PetscComplex s[],
                               PetscBool *singular)
{
  Plane         plane;
  PetscComplex *F;

  PetscFunctionBeginUser;
  PetscCall(PlaneCreate(e, m, list, &plane));
  PetscCall(PetscMalloc1(m * m, &F));
  PetscCall(FormF(&plane, F, singular));
  if (!*singular) {
    PetscCall(PlaneEigenvalues(&plane, F, s));
    PetscCall(MatchNearest(&plane, list, s));
  }
  PetscCall(PetscFree(F));
  PetscCall(PetscFree2(plane.X, plane.Y));
  PetscFunctionReturn(0);
}
