/*
   Invariant planes of the undamped problem K x = kappa M x. At lock-in two vectors become parallel, while the plane
   that they span, and with it the mean and the discriminant of its two eigenvalues, stay smooth functions of the
   parameter. From vectors that are parallel up to rounding the plane cannot be had; inverse iteration of two columns at
   once,

      X <- orth((K - s M)^-1 M X),   Y <- orth((K - s M)^-T M^T Y),

   finds it to rounding: the error shrinks in each step by the ratio of distances of the pair and of the next eigenvalue
   from the shift s. The shift is kept off the pair, lest the plane be lost to its first vector.
   Reference: G. W. Stewart, J.-G. Sun, Matrix Perturbation Theory, Academic Press 1990, chapter V.
*/
#include "sweep/track/frame.h"
#include <petscblaslapack.h>

#define PLANE_SETTLED 1e-9 /* change by a step after which the plane is an invariant one */

/* The k leading orthonormal columns of Re and Im of the given k vectors; columns that are missing are filled with
   numbers that have no structure, for the iteration to turn into the plane */
static PetscErrorCode PlaneReal(PetscInt N, PetscInt k, const PetscInt member[], const PetscComplex vectors[],
                                PetscReal X[])
{
  PetscComplex *Z;
  PetscInt      kept;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(2 * k * N, &Z));
  for (PetscInt a = 0; a < k; a++)
    for (PetscInt r = 0; r < N; r++) {
      Z[2 * a * N + r]       = creal(vectors[member[a] * N + r]);
      Z[(2 * a + 1) * N + r] = cimag(vectors[member[a] * N + r]);
    }
  PetscCall(DenseOrthonormalise(N, 2 * k, FRAME_PARALLEL, Z, &kept));
  for (PetscInt a = 0; a < k; a++)
    for (PetscInt r = 0; r < N; r++)
      X[a * N + r] = a < kept ? creal(Z[a * N + r]) : sin(1.0 + (a + 1.3) * (r + 1.7) * (r + 0.9));
  PetscCall(PetscFree(Z));
  PetscFunctionReturn(0);
}

/* Factors of K - s M and room for one step */
typedef struct {
  const ModeFrame *frame;
  PetscInt         k;
  PetscReal       *LU, *old, *work, *R; /* [size * size], [k][size], [k][size], [k * (k + 1)] */
  PetscBLASInt    *pivot;
} PlaneWork;

/* X := op(K - s M)^-1 op(M) X, then orthonormal by QR; change = largest entry of old - X X' old, how far the plane
   turned: the columns themselves may turn within it. */
static PetscErrorCode PlaneStep(const PlaneWork *w, PetscBool transposed, PetscReal X[], PetscReal *change)
{
  const PetscInt  size = w->frame->form.n, k = w->k;
  const PetscReal one = 1, zero = 0;
  const char     *op = transposed ? "T" : "N";
  PetscBLASInt    n, columns, info, n_work;

  PetscFunctionBeginUser;
  PetscCall(PetscBLASIntCast(size, &n));
  PetscCall(PetscBLASIntCast(k, &columns));
  n_work = n * columns;
  PetscCall(PetscArraycpy(w->old, X, k * size));
  PetscCallBLAS("BLASgemm",
                BLASgemm_(op, "N", &n, &columns, &n, &one, w->frame->pencil.M, &n, w->old, &n, &zero, X, &n));
  PetscCall(DenseSolve(size, w->LU, w->pivot, transposed, k, X));
  PetscCallBLAS("LAPACKgeqrf", LAPACKgeqrf_(&n, &columns, X, &n, w->R, w->work, &n_work, &info));
  PetscCallBLAS("LAPACKorgqr", LAPACKorgqr_(&n, &columns, &columns, X, &n, w->R, w->work, &n_work, &info));
  /* |old - X X' old| */
  PetscCallBLAS("BLASgemm",
                BLASgemm_("T", "N", &columns, &columns, &n, &one, X, &n, w->old, &n, &zero, w->R, &columns));
  *change = 0;
  for (PetscInt a = 0; a < k; a++) {
    for (PetscInt r = 0; r < size; r++) {
      PetscReal rest = w->old[a * size + r];

      for (PetscInt b = 0; b < k; b++) rest -= X[b * size + r] * w->R[a * k + b];
      *change = PetscMax(*change, PetscAbsReal(rest));
    }
  }
  PetscFunctionReturn(0);
}

/* Undamped: real orthonormal bases of the right and left invariant planes of K x = kappa M x about the shift,
   (rad/s)^2, from starting bases X, Y [k][size], by inverse iteration of the plane, which a defective pair does not
   disturb. It ends at rounding (1e-15), or where a change below 1e-12 falls no more; 40 steps by the ratio 0.3 /
   0.7 that PlaneShift() admits are 2e-15. */
static PetscErrorCode PlaneIterate(const ModeFrame *f, PetscReal shift, PetscInt k, PetscReal X[], PetscReal Y[],
                                   PetscBool *settled)
{
  const PetscInt size     = f->form.n;
  PlaneWork      w        = {.frame = f, .k = k};
  PetscReal      change_x = 1, change_y = 1;
  PetscBool      singular;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc5(size * size, &w.LU, k * size, &w.old, k * size, &w.work, k * (k + 1), &w.R, size, &w.pivot));
  for (PetscInt r = 0; r < size * size; r++) w.LU[r] = f->pencil.K[r] - shift * f->pencil.M[r];
  PetscCall(DenseFactor(size, w.LU, w.pivot, &singular));
  for (int step = 0; step < 40 && !singular && PetscMax(change_x, change_y) > 1e-15; step++) {
    const PetscReal before = PetscMax(change_x, change_y);

    PetscCall(PlaneStep(&w, PETSC_FALSE, X, &change_x));
    PetscCall(PlaneStep(&w, PETSC_TRUE, Y, &change_y));
    if (step > 3 && before < 1e-12 && PetscMax(change_x, change_y) > 0.3 * before) break;
  }
  *settled = !singular && PetscMax(change_x, change_y) < PLANE_SETTLED ? PETSC_TRUE : PETSC_FALSE;
  PetscCall(PetscFree5(w.LU, w.old, w.work, w.R, w.pivot));
  PetscFunctionReturn(0);
}

/* A shift off the plane's eigenvalues and much closer to them than any other: mean + offset, offset three times
   their spread or 1e-3 of the mean, but a twentieth of the distance of the next eigenvalue where that is less.
   False where there is none, which is when the eigenvalues of the plane are far apart and the given vectors good. */
static PetscBool PlaneShift(const ModeFrame *f, PetscInt k, const PetscInt member[], PetscReal *shift)
{
  PetscReal mean = 0, distance = PETSC_MAX_REAL, spread = 0, offset;

  for (PetscInt a = 0; a < k; a++) mean += creal(StandardValue(&f->form, f->modes.lambda[member[a]])) / k;
  for (PetscInt i = 0; i < f->modes.n; i++) {
    const PetscReal from_mean = cabs(StandardValue(&f->form, f->modes.lambda[i]) - mean);
    PetscBool       inside    = PETSC_FALSE;

    for (PetscInt a = 0; a < k; a++) inside = (PetscBool)(inside || member[a] == i);
    if (inside)
      spread = PetscMax(spread, from_mean);
    else
      distance = PetscMin(distance, from_mean);
  }
  offset = PetscMax(1e-3 * PetscMax(PetscAbsReal(mean), 1e-6 * PetscSqr(f->form.scale)), 3 * spread);
  offset = PetscMin(offset, PetscMax(0.05 * distance, 1.5 * spread));
  *shift = mean + offset;
  return spread + offset < 0.3 * distance ? PETSC_TRUE : PETSC_FALSE;
}

PetscErrorCode ModePlaneFollow(const ModeFrame *f, PetscInt k, const PetscInt member[], PetscReal X[], PetscReal Y[],
                               PetscBool *settled)
{
  PetscReal shift;

  PetscFunctionBeginUser;
  *settled = PETSC_FALSE;
  PetscCall(PlaneReal(f->form.n, k, member, f->modes.x, X));
  PetscCall(PlaneReal(f->form.n, k, member, f->modes.y, Y));
  if (f->refine && PlaneShift(f, k, member, &shift)) PetscCall(PlaneIterate(f, shift, k, X, Y, settled));
  PetscFunctionReturn(0);
}

PetscErrorCode ModePlaneRefine(const ModeFrame *f, PetscInt k, const PetscInt member[], PetscReal X[], PetscReal Y[])
{
  PetscBool settled;

  PetscFunctionBeginUser;
  PetscCall(ModePlaneFollow(f, k, member, X, Y, &settled));
  PetscFunctionReturn(0);
}
