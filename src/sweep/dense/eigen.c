/*
   The dense problem Q(lambda) x = (lambda^2 M + lambda C + K) x = 0, y^T Q(lambda) = 0, by shift and invert about a
   real shift s > 0 with P = Q(s) (P = K + s^2 M without damping):

      undamped  P^-1 M x = theta x,                        kappa = -lambda^2 = 1 / theta - s^2,  y = P^-T w
      damped    [0 I; -P^-1 s^2 M, -P^-1 (2 s^2 M + s C)] [x; theta x] = theta [x; theta x],
                lambda = s (1 + 1 / theta),                                                     y = P^-T b

   where w is the left vector of P^-1 M and b the second block of that of the companion matrix. (Put lambda = s (1 +
   nu): nu^2 s^2 M + nu (2 s^2 M + s C) + P = 0, theta = 1 / nu. For a left vector [a; b] the first column of the
   companion equation gives theta a^T = -b^T P^-1 s^2 M, and theta times the second b^T P^-1 (theta^2 P + theta (2 s^2
   M + s C) + s^2 M) = 0.)

   Contact makes K stiff: largest eigenvalues of K x = kappa M x may be 1e14 times those looked for, and QR iterations
   on M^-1 K leave errors of eps times the largest. Here they are eps (kappa + s^2)^2 / (kappa_min + s^2), whatever the
   largest; s^2 between the ends of the window makes that small for all of it. What remains is what rounding in the
   given K does, see DensePencilNoise().
*/
#include "eigen.h"
#include "base/events.h"

#define RIGID_FLOOR 100  /* kappa below this many times its rounding error is a rigid mode */
#define ON_SHIFT    1e3  /* an eigenvalue nearer to the shift than 1 / this of it spoils the others: another shift */
#define SAME_VECTOR 1e-3 /* a vector closer than this to those before is the second one of a double zero */
#define WINDOW_EDGE 1e-8 /* relative tolerance on the ends of the window */

/* Work of one solution */
typedef struct {
  const DensePencil *pencil;
  const PetscReal   *E;    /* [n * n] energy that rounding in K of the mesh scales with, or NULL */
  PetscInt           n, N; /* sizes of Q and of the standard problem */
  PetscReal          shift;
  PetscReal         *P, *B;   /* [n * n] factors of P; [N * N] */
  PetscReal         *wr, *wi; /* [N] theta */
  PetscReal         *R, *L;   /* [N * N] */
  PetscBLASInt      *pivot;
} Work;

/* Shift, rad/s: the middle of the window, but not above the largest K_ii / M_ii */
static PetscReal ShiftChoose(const DensePencil *pencil, const ReducedWindow *window)
{
  const PetscReal high = window->high, low = PetscMax(window->low, 0.01 * high);
  const PetscReal middle  = PetscSqrtReal(low) * PetscSqrtReal(high);
  PetscReal       largest = 0;

  for (PetscInt i = 0; i < pencil->n * pencil->n; i += pencil->n + 1)
    if (pencil->M[i] > 0) largest = PetscMax(largest, pencil->K[i] / pencil->M[i]);
  return largest > 0 ? PetscMin(middle, PetscSqrtReal(largest)) : middle > 0 ? middle : 1;
}

static PetscErrorCode WorkCreate(const DensePencil *pencil, PetscReal shift, Work *w)
{
  PetscFunctionBeginUser;
  w->pencil = pencil;
  w->n      = pencil->n;
  w->N      = pencil->damped ? 2 * w->n : w->n;
  w->shift  = shift;
  PetscCall(PetscMalloc3(w->n * w->n, &w->P, w->N * w->N, &w->B, w->n, &w->pivot));
  PetscCall(PetscCalloc4(w->N, &w->wr, w->N, &w->wi, w->N * w->N, &w->R, w->N * w->N, &w->L));
  PetscFunctionReturn(0);
}

static PetscErrorCode WorkDestroy(Work *w)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree3(w->P, w->B, w->pivot));
  PetscCall(PetscFree4(w->wr, w->wi, w->R, w->L));
  PetscFunctionReturn(0);
}

/* P = Q(shift) */
static void FormP(Work *w)
{
  const DensePencil *q = w->pencil;

  for (PetscInt i = 0; i < w->n * w->n; i++) w->P[i] = q->K[i] + w->shift * (w->shift * q->M[i] + q->C[i]);
}

/* Symmetric: M x = theta P x; definite is false where P is not */
static PetscErrorCode SolveSymmetric(Work *w, PetscBool *definite)
{
  PetscFunctionBeginUser;
  FormP(w);
  PetscCall(PetscArraycpy(w->R, w->pencil->M, w->n * w->n));
  PetscCall(PetscArrayzero(w->wi, w->n));
  PetscCall(DenseSymmetricEigen(w->n, w->R, w->P, w->wr, definite));
  PetscFunctionReturn(0);
}

/* Companion matrix of theta^2 + theta P^-1 (2 s^2 M + s C) + P^-1 s^2 M, [2 n * 2 n] */
static PetscErrorCode FormCompanion(Work *w)
{
  const DensePencil *q = w->pencil;
  const PetscInt     n = w->n, N = w->N;
  const PetscReal    s = w->shift;
  PetscReal         *row; /* lower half, [2 n][n] */

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n * N, &row));
  for (PetscInt i = 0; i < n * n; i++) {
    row[i]         = -s * s * q->M[i];
    row[n * n + i] = -s * (2 * s * q->M[i] + q->C[i]);
  }
  PetscCall(DenseSolve(n, w->P, w->pivot, PETSC_FALSE, N, row));
  PetscCall(PetscArrayzero(w->B, N * N));
  for (PetscInt i = 0; i < n; i++) w->B[(n + i) * N + i] = 1;
  for (PetscInt j = 0; j < N; j++) PetscCall(PetscArraycpy(w->B + j * N + n, row + j * n, n));
  PetscCall(PetscFree(row));
  PetscFunctionReturn(0);
}

/* General: LU of P, then the standard problem */
static PetscErrorCode SolveGeneral(Work *w, PetscBool *singular)
{
  PetscFunctionBeginUser;
  FormP(w);
  PetscCall(DenseFactor(w->n, w->P, w->pivot, singular));
  if (*singular) PetscFunctionReturn(0);
  if (w->pencil->damped) {
    PetscCall(FormCompanion(w));
  } else {
    PetscCall(PetscArraycpy(w->B, w->pencil->M, w->n * w->n));
    PetscCall(DenseSolve(w->n, w->P, w->pivot, PETSC_FALSE, w->n, w->B));
  }
  PetscCall(DenseEigen(w->N, w->B, w->wr, w->wi, w->L, w->R));
  PetscFunctionReturn(0);
}

/* Whether an eigenvalue lies on the shift: |theta| s^2 (undamped), |theta| (damped) are about one otherwise */
static PetscBool IsOnShift(const Work *w)
{
  const PetscReal unit = w->pencil->damped ? 1 : w->shift * w->shift;

  for (PetscInt i = 0; i < w->N; i++)
    if (hypot(w->wr[i], w->wi[i]) * unit > ON_SHIFT) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* Solves about the shift, moved away from eigenvalues (unstable real ones) where necessary */
static PetscErrorCode WorkSolve(Work *w, PetscBool symmetric)
{
  PetscBool bad = PETSC_TRUE;

  PetscFunctionBeginUser;
  for (int attempt = 0; attempt < 12 && bad; attempt++) {
    if (attempt) w->shift *= 1.7;
    if (symmetric) {
      PetscCall(SolveSymmetric(w, &bad));
      bad = bad ? PETSC_FALSE : PETSC_TRUE;
    } else {
      PetscCall(SolveGeneral(w, &bad));
    }
    if (!bad) bad = IsOnShift(w);
  }
  PetscCheck(!bad, PETSC_COMM_SELF, PETSC_ERR_NOT_CONVERGED,
             "dense pencil of size %" PetscInt_FMT ": no shift up to %.6g rad/s at which it is regular", w->n,
             (double)w->shift);
  PetscFunctionReturn(0);
}

/* lambda of theta_i, omega >= 0; false for what is not listed: infinite ones, the one of a conjugate pair */
static PetscBool LambdaGet(const Work *w, PetscInt i, PetscComplex *lambda)
{
  const PetscComplex theta = CMPLX(w->wr[i], w->wi[i]);
  PetscComplex       kappa;

  if (theta == 0) return PETSC_FALSE;
  if (w->pencil->damped) {
    *lambda = w->wi[i] == 0 ? CMPLX(w->shift * (1 + 1 / w->wr[i]), 0) : w->shift * (1 + 1 / theta);
    return cimag(*lambda) >= 0 ? PETSC_TRUE : PETSC_FALSE;
  }
  if (w->wi[i] == 0) {
    const PetscReal real = 1 / w->wr[i] - w->shift * w->shift;

    *lambda = real > 0 ? CMPLX(0, PetscSqrtReal(real)) : CMPLX(PetscSqrtReal(-real), 0);
    return PETSC_TRUE;
  }
  kappa   = 1 / theta - w->shift * w->shift;
  *lambda = csqrt(-kappa);
  if (cimag(*lambda) < 0) *lambda = -*lambda;
  return PETSC_TRUE;
}

/* Rows of eigenvector i of LAPACK's real storage from offset on, x [n]; conjugate for left vectors */
static void VectorGet(const Work *w, const PetscReal V[], PetscInt i, PetscInt offset, PetscBool left, PetscComplex x[])
{
  const PetscReal  sign = left ? -1 : 1;
  const PetscInt   at   = w->wi[i] < 0 ? i - 1 : i;
  const PetscReal *r = V + at * w->N + offset, *c = r + w->N;

  for (PetscInt k = 0; k < w->n; k++)
    x[k] = w->wi[i] == 0 ? CMPLX(r[k], 0) : CMPLX(r[k], w->wi[i] > 0 ? sign * c[k] : -sign * c[k]);
}

/* y = P^-T b */
static PetscErrorCode LeftGet(const Work *w, PetscInt i, PetscComplex y[])
{
  const PetscInt n = w->n;
  PetscReal     *parts;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(2 * n, &parts));
  VectorGet(w, w->L, i, w->N - n, PETSC_TRUE, y);
  DenseSplit(n, y, parts);
  PetscCall(DenseSolve(n, w->P, w->pivot, PETSC_TRUE, 2, parts));
  DenseUnite(n, parts, y);
  PetscCall(PetscFree(parts));
  PetscFunctionReturn(0);
}

PetscReal DensePencilNoise(const DensePencil *q, PetscInt n, const PetscComplex x[], const PetscComplex y[])
{
  PetscReal sum_x = 0, sum_y = 0;

  for (PetscInt i = 0; i < n; i++) {
    const PetscReal k = PetscAbsReal(q->K[i * (q->n + 1)]);

    sum_x += k * (PetscSqr(creal(x[i])) + PetscSqr(cimag(x[i])));
    sum_y += k * (PetscSqr(creal(y[i])) + PetscSqr(cimag(y[i])));
  }
  return PETSC_MACHINE_EPSILON * PetscSqrtReal(sum_x) * PetscSqrtReal(sum_y);
}

/* Whether lambda is zero within rounding: of K, here and on the mesh, and of the shifted solution */
static PetscErrorCode IsRigid(const Work *w, PetscComplex lambda, const PetscComplex x[], PetscBool *rigid)
{
  const PetscInt  n      = w->n;
  const PetscReal square = cabs(lambda) * cabs(lambda), own = PETSC_MACHINE_EPSILON * w->shift * w->shift;
  PetscComplex   *Mx;
  PetscReal       mass = 0, mesh = 0;

  PetscFunctionBeginUser;
  *rigid = PETSC_FALSE;
  if (square > w->shift * w->shift) PetscFunctionReturn(0);
  PetscCall(PetscMalloc1(n, &Mx));
  PetscCall(DenseTimes(&(DenseBlock){w->pencil->M, n, n, n}, PETSC_FALSE, 1, x, Mx));
  for (PetscInt k = 0; k < n; k++) mass += creal(conj(x[k]) * Mx[k]);
  PetscCall(PetscFree(Mx));
  if (w->E) PetscCall(DenseEnergies(n, w->E, 1, x, &mesh));
  mesh *= PETSC_MACHINE_EPSILON;
  if (square * mass <= RIGID_FLOOR * (DensePencilNoise(w->pencil, n, x, x) + mesh + own * mass)) *rigid = PETSC_TRUE;
  PetscFunctionReturn(0);
}

/* Whether lambda belongs to the window */
static PetscBool IsInside(const ReducedWindow *window, PetscComplex lambda)
{
  const PetscReal sigma = PetscAbsReal(creal(lambda)), omega = cimag(lambda);

  if (omega < window->low * (1 - WINDOW_EDGE) || (sigma > window->growth && window->rtol <= 0)) return PETSC_FALSE;
  return omega <= window->high * (1 + WINDOW_EDGE) ? PETSC_TRUE : PETSC_FALSE;
}

/* Rigid modes of a damped system, listed first: a double zero gives twice the same vector */
static PetscErrorCode RigidOnce(PetscInt n_rigid, ReducedModes *modes)
{
  const PetscInt size = modes->size;
  PetscInt       right, left, drop;

  PetscFunctionBeginUser;
  if (!n_rigid) PetscFunctionReturn(0);
  PetscCall(DenseRealSpan(size, n_rigid, SAME_VECTOR, modes->x, &right));
  PetscCall(DenseRealSpan(size, n_rigid, SAME_VECTOR, modes->y, &left));
  drop = n_rigid - PetscMin(right, left);
  modes->n -= drop;
  for (PetscInt i = n_rigid - drop; i < modes->n; i++) {
    modes->lambda[i] = modes->lambda[i + drop];
    modes->rigid[i]  = modes->rigid[i + drop];
    PetscCall(PetscArraymove(modes->x + i * size, modes->x + (i + drop) * size, size));
    PetscCall(PetscArraymove(modes->y + i * size, modes->y + (i + drop) * size, size));
  }
  PetscFunctionReturn(0);
}

/* Indices list [N] of the eigenvalues that belong to the window, rigid ones in front; lambda [N] of all */
static PetscErrorCode List(const Work *w, const ReducedWindow *window, PetscInt list[], PetscComplex lambda[],
                           PetscInt *n, PetscInt *n_rigid)
{
  PetscComplex *x;

  PetscFunctionBeginUser;
  *n = *n_rigid = 0;
  PetscCall(PetscMalloc1(w->n, &x));
  for (PetscInt i = 0; i < w->N; i++) {
    PetscBool rigid;

    if (!LambdaGet(w, i, &lambda[i])) continue;
    VectorGet(w, w->R, i, 0, PETSC_FALSE, x);
    PetscCall(IsRigid(w, lambda[i], x, &rigid));
    if (rigid) lambda[i] = 0;
    if (!IsInside(window, lambda[i])) continue;
    list[*n] = i;
    if (rigid) {
      list[*n]           = list[*n_rigid];
      list[(*n_rigid)++] = i;
    }
    ++*n;
  }
  PetscCall(PetscFree(x));
  PetscFunctionReturn(0);
}

PetscErrorCode DensePencilEigen(const DensePencil *pencil, const PetscReal E[], const ReducedWindow *window,
                                ReducedModes *modes)
{
  PetscInt      n, n_rigid, *list;
  PetscComplex *lambda;
  Work          w;

  PetscFunctionBeginUser;
  PetscCall(EventBegin(EVENT_REDUCED));
  PetscCall(WorkCreate(pencil, ShiftChoose(pencil, window), &w));
  w.E = E;
  PetscCall(WorkSolve(&w, pencil->symmetric));
  PetscCall(PetscMalloc2(w.N, &list, w.N, &lambda));
  PetscCall(List(&w, window, list, lambda, &n, &n_rigid));
  PetscCall(ReducedModesCreate(n, w.n, modes));
  for (PetscInt k = 0; k < n; k++) {
    modes->lambda[k] = lambda[list[k]];
    modes->rigid[k]  = k < n_rigid ? PETSC_TRUE : PETSC_FALSE;
    VectorGet(&w, w.R, list[k], 0, PETSC_FALSE, modes->x + k * w.n);
    if (pencil->symmetric)
      PetscCall(PetscArraycpy(modes->y + k * w.n, modes->x + k * w.n, w.n));
    else
      PetscCall(LeftGet(&w, list[k], modes->y + k * w.n));
  }
  if (pencil->damped) PetscCall(RigidOnce(n_rigid, modes));
  PetscCall(PetscFree2(list, lambda));
  PetscCall(WorkDestroy(&w));
  PetscCall(EventEnd(EVENT_REDUCED));
  PetscFunctionReturn(0);
}
