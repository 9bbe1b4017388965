/*
   The eigenvalues of a dense problem that belong to a window, rigid ones once. What is solved, and what rounding does
   to it, is described in basis/companion.c.
*/
#include "eigen.h"
#include "base/events.h"

/* kappa below this many times its rounding error is a rigid mode: where more than a percent of it is rounding it
   cannot be told from zero. */
#define RIGID_FLOOR 100
#define SAME_VECTOR 1e-3 /* a vector closer than this to those before is the second one of a double zero */
/* Relative tolerance on the ends of the window, so that a mode on an edge does not come and go by rounding. */
#define WINDOW_EDGE 1e-8

/* Shift h, rad/s, of (K + h C + h^2 M): real, at the geometric middle of the window; not above the largest
   sqrt(K_ii / M_ii), beyond which K is small beside h^2 M and loses digits in the sum. */
static PetscReal ShiftChoose(const DensePencil *pencil, const ReducedWindow *window)
{
  const PetscReal high = window->high, low = PetscMax(window->low, 0.01 * high);
  const PetscReal middle  = PetscSqrtReal(low) * PetscSqrtReal(high);
  PetscReal       largest = 0;

  for (PetscInt i = 0; i < pencil->n * pencil->n; i += pencil->n + 1)
    if (pencil->M[i] > 0) largest = PetscMax(largest, pencil->K[i] / pencil->M[i]);
  return largest > 0 ? PetscMin(middle, PetscSqrtReal(largest)) : middle > 0 ? middle : 1;
}

/* Change of y^T K x by a relative rounding of each K_ii, eps sqrt(sum |K_ii| |x_i|^2 sum |K_ii| |y_i|^2): the
   leading n rows of q. Divided by |y^T D x| it is that of kappa, (rad/s)^2. */
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

/* Whether lambda of entry i is zero within rounding of K, here and on the mesh, and of the shifted solution:
      |lambda|^2 x^H M x <= 100 (noise of the dense K + eps x^H E x + eps h^2 x^H M x),
   the last since eigenvalues come from those of a problem shifted by h. E = NULL: the mesh is left to
   RoundingMarkRigid(). */
static PetscErrorCode IsRigid(const DenseShifted *w, const PetscReal E[], PetscInt i, PetscComplex lambda,
                              PetscBool *rigid)
{
  const PetscInt  n      = w->n;
  const PetscReal square = cabs(lambda) * cabs(lambda), own = PETSC_MACHINE_EPSILON * w->shift * w->shift;
  PetscComplex   *x, *Mx;
  PetscReal       mass = 0, mesh = 0;

  PetscFunctionBeginUser;
  *rigid = PETSC_FALSE;
  if (square > w->shift * w->shift) PetscFunctionReturn(0);
  PetscCall(PetscMalloc2(n, &x, n, &Mx));
  PetscCall(DenseShiftedRight(w, i, x));
  PetscCall(DenseTimes(&(DenseBlock){w->pencil->M, n, n, n}, PETSC_FALSE, 1, x, Mx));
  for (PetscInt k = 0; k < n; k++) mass += creal(conj(x[k]) * Mx[k]);
  if (E) PetscCall(DenseEnergies(n, E, 1, x, &mesh));
  mesh *= PETSC_MACHINE_EPSILON;
  if (square * mass <= RIGID_FLOOR * (DensePencilNoise(w->pencil, n, x, x) + mesh + own * mass)) *rigid = PETSC_TRUE;
  PetscCall(PetscFree2(x, Mx));
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

/* Indices list [N] of the eigenvalues that belong to the window, rigid ones in front; lambda [N] of all; how many there
   are, and how many of them are rigid */
static PetscErrorCode List(const DenseShifted *w, const PetscReal E[], const ReducedWindow *window, PetscInt list[],
                           PetscComplex lambda[], PetscInt count[2])
{
  PetscInt n = 0, n_rigid = 0;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < w->N; i++) {
    PetscBool rigid;

    if (!DenseShiftedLambda(w, i, &lambda[i])) continue;
    PetscCall(IsRigid(w, E, i, lambda[i], &rigid));
    if (rigid) lambda[i] = 0;
    if (!IsInside(window, lambda[i])) continue;
    list[n] = i;
    if (rigid) {
      list[n]         = list[n_rigid];
      list[n_rigid++] = i;
    }
    n++;
  }
  count[0] = n;
  count[1] = n_rigid;
  PetscFunctionReturn(0);
}

/* Not collective. All eigenvalues of the dense problem are computed, N = n undamped or 2 n damped; left vectors
   only of those that are listed, and with a symmetric pencil they are the right ones. */
PetscErrorCode DensePencilEigen(const DensePencil *pencil, const PetscReal E[], const ReducedWindow *window,
                                ReducedModes *modes)
{
  PetscInt      count[2], *list;
  PetscComplex *lambda;
  DenseShifted  w;

  PetscFunctionBeginUser;
  PetscCall(EventBegin(EVENT_REDUCED));
  PetscCall(DenseShiftedSolve(pencil, ShiftChoose(pencil, window), &w));
  PetscCall(PetscMalloc2(w.N, &list, w.N, &lambda));
  PetscCall(List(&w, E, window, list, lambda, count));
  PetscCall(ReducedModesCreate(count[0], w.n, modes));
  for (PetscInt k = 0; k < count[0]; k++) {
    modes->lambda[k] = lambda[list[k]];
    modes->rigid[k]  = k < count[1] ? PETSC_TRUE : PETSC_FALSE;
    PetscCall(DenseShiftedRight(&w, list[k], modes->x + k * w.n));
    if (pencil->symmetric)
      PetscCall(PetscArraycpy(modes->y + k * w.n, modes->x + k * w.n, w.n));
    else
      PetscCall(DenseShiftedLeft(&w, list[k], modes->y + k * w.n));
  }
  if (pencil->damped) PetscCall(RigidOnce(count[1], modes));
  PetscCall(PetscFree2(list, lambda));
  PetscCall(DenseShiftedDestroy(&w));
  PetscCall(EventEnd(EVENT_REDUCED));
  PetscFunctionReturn(0);
}
