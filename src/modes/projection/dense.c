/*
   The modes of a projection from its dense problem, all of them about the upper end of the window, or
   followed from what they were.
*/
#include "projection.h"

#define FOLLOW_FAR   1e-3  /* relative change of lambda that is another mode's */
#define FOLLOW_ONE   0.999 /* cosine of the angle of two vectors that are one */
#define EDGE_POINTS  64    /* on each side of the window's edge, where kappa(lambda) is looked at */
#define EDGE_POLE    0.5   /* beside 1 / beta, radius about the pole -1 / beta within which nothing is claimed */
#define LAWS_MOVE    1.2   /* times a frequency: by so much laws may move it, from their reference */
#define LAWS_GROW    2     /* times a growth */
#define LAWS_MORE    4     /* further modes next to a target, of which one may come nearer */
#define FOLLOW_EQUAL 1e-9  /* relative distance of eigenvalues that are one */

/* Whether lambda is next to the pole of kappa, where modes gather that damping keeps from oscillating */
static PetscBool AtPole(const Projection *p, PetscComplex lambda)
{
  return cabs(1 + p->beta * lambda) < EDGE_POLE * (1 - 1e-9) ? PETSC_TRUE : PETSC_FALSE;
}

/* Overdamped modes gather about -1 / beta: 1 / beta where that is within the window, else 0 */
PetscReal ProjectionPole(const Projection *p)
{
  const Window *w = p->window;

  if (w->count || p->beta * w->growth <= 1 - EDGE_POLE || p->beta * w->low >= EDGE_POLE) return 0;
  return 1 / p->beta;
}

/* The same with factors at complex shifts: rigid modes, and what oscillates with no more growth or decay than is asked
   for, and less damping than MODES_DAMPED_MOST */
static PetscBool LambdaIsSought(const Projection *p, PetscComplex lambda)
{
  const Window   *w     = p->window;
  const PetscReal omega = cimag(lambda), sigma = creal(lambda);

  if (w->known.rigid && cabs(lambda) <= w->known.scale) return w->count || w->edge[0] == 0 ? PETSC_TRUE : PETSC_FALSE;
  if (omega <= w->known.scale || -sigma > MODES_DAMPED_MOST * cabs(lambda)) return PETSC_FALSE;
  if (w->count) return PETSC_TRUE;
  return omega >= w->edge[0] && omega <= w->edge[1] && PetscAbsReal(sigma) <= w->growth ? PETSC_TRUE : PETSC_FALSE;
}

/* Whether the window claims a mode and the basis can have it: of the modes nearest to a target those within reach, of a
   band those between its edges, away from the pole, with no more growth or decay than is asked for, or else, where they
   oscillate within the window or C = alpha M + beta K, with an undamped frequency root(kappa) in the band, which V
   holds */
PetscBool ProjectionHas(const Projection *p, PetscComplex lambda)
{
  const Window      *w     = p->window;
  const PetscReal    omega = cimag(lambda);
  const PetscComplex kappa = ProjectionKappa(p, lambda);

  if (p->about) return LambdaIsSought(p, lambda);
  if (w->count) return cabs(kappa - p->si.shift) <= p->reach ? PETSC_TRUE : PETSC_FALSE;
  if (omega < w->edge[0] || omega > w->edge[1]) return PETSC_FALSE;
  if ((PetscAbsReal(creal(lambda)) <= w->growth && !AtPole(p, lambda)) || p->reach == PETSC_MAX_REAL) return PETSC_TRUE;
  if (!p->exact && (AtPole(p, lambda) || omega == 0 || PetscAbsReal(creal(lambda)) > w->edge[1])) return PETSC_FALSE;
  return creal(kappa) >= PetscSqr(w->edge[0]) && creal(kappa) <= PetscSqr(w->edge[1]) ? PETSC_TRUE : PETSC_FALSE;
}

/* The same of eigenvalues of a nonlinear problem with its laws held, which these may move into the window: what
   oscillates, and rigid modes */
static PetscBool LambdaMayBe(const Projection *p, PetscComplex lambda)
{
  const Window *w = p->window;

  if (!p->pencil->n_laws) return ProjectionHas(p, lambda);
  if (w->known.rigid && cabs(lambda) <= w->known.scale) return ProjectionHas(p, lambda);
  if (cimag(lambda) <= w->known.scale) return PETSC_FALSE;
  if (w->count) return ProjectionHas(p, lambda);
  return cimag(lambda) >= w->edge[0] / LAWS_MOVE && cimag(lambda) <= LAWS_MOVE * w->edge[1] &&
             PetscAbsReal(creal(lambda)) <= LAWS_GROW * w->growth
           ? PETSC_TRUE
           : PETSC_FALSE;
}

/* |kappa(lambda) - s|, (rad/s)^2: how far from the shift the undamped mode of lambda is */
static PetscReal LambdaFar(const Projection *p, PetscComplex lambda)
{
  return cabs(ProjectionKappa(p, lambda) - p->si.shift);
}

/* |lambda / (1 + beta lambda)|, s^-1: how much R weighs */
static PetscReal LambdaRatio(const Projection *p, PetscComplex lambda)
{
  return cabs(lambda / (1 + p->beta * lambda));
}

/* The largest value of an analytic function on the edge of what a band claims: of the rectangle |sigma| <= growth, low
   <= omega <= high without the circle about the pole -1 / beta */
static PetscReal EdgeLargest(const Projection *p, PetscReal (*size)(const Projection *, PetscComplex))
{
  const Window *w       = p->window;
  PetscReal     largest = 0;

  for (int i = 0; i <= EDGE_POINTS; i++) {
    const PetscReal    t = (PetscReal)i / EDGE_POINTS, sigma = (2 * t - 1) * w->growth;
    const PetscReal    omega = w->low + t * (w->high - w->low);
    const PetscComplex pole =
      p->beta > 0 ? CMPLX(EDGE_POLE * cos(PETSC_PI * t) - 1, EDGE_POLE * sin(PETSC_PI * t)) / p->beta : 0;
    const PetscComplex at[] = {CMPLX(sigma, w->low), CMPLX(sigma, w->high), CMPLX(-w->growth, omega),
                               CMPLX(w->growth, omega), pole};

    for (int k = 0; k < 5; k++)
      if (!AtPole(p, at[k]) && PetscAbsReal(creal(at[k])) <= w->growth && cimag(at[k]) >= w->low &&
          cimag(at[k]) <= w->high)
        largest = PetscMax(largest, size(p, at[k]));
  }
  return largest;
}

/* |kappa - s| is largest on the edge of a region without the pole: of a circle of radius d about the target, or of what
   a band claims */
PetscReal ProjectionEdge(const Projection *p, PetscReal d)
{
  const Window *w       = p->window;
  PetscReal     largest = 0;

  if (!w->count) return EdgeLargest(p, LambdaFar);
  if (d == PETSC_MAX_REAL || p->beta * d >= 1) return PETSC_MAX_REAL;
  for (int i = 0; i <= EDGE_POINTS; i++) {
    const PetscReal angle = 2 * PETSC_PI * i / EDGE_POINTS;

    largest = PetscMax(largest, LambdaFar(p, CMPLX(d * cos(angle), w->target + d * sin(angle))));
  }
  return largest;
}

/* At the upper end of the window, or, where the pole is near, anywhere */
PetscReal ProjectionLargestRatio(const Projection *p)
{
  const PetscReal high = PetscMax(p->window->high, p->window->target);

  if (p->pencil->n_laws) return high;
  if (ProjectionPole(p) == 0) return LambdaRatio(p, CMPLX(0, high));
  return EdgeLargest(p, LambdaRatio);
}

/* Of the chosen eigenvalues, list [n], those nearest to the target come first. Those asked for are left, the second of
   each double zero besides (rigid/twins.c), and `more`; *d = distance of the farthest, or PETSC_MAX_REAL where there
   are too few: the others lie farther than all of them */
void ProjectionKeepNearest(const Window *window, PetscInt more, const PetscComplex lambda[], PetscInt list[],
                           PetscInt *n, PetscReal *d)
{
  const PetscComplex target = CMPLX(0, window->target);
  PetscInt           zeros  = 0, second;

  for (PetscInt i = 0; i < *n; i++) zeros += cabs(lambda[list[i]]) <= window->known.scale;
  second = PetscMin(window->known.rigid, PetscMax(0, zeros - window->known.rigid));
  for (PetscInt i = 1; i < *n; i++)
    for (PetscInt j = i; j > 0 && cabs(lambda[list[j]] - target) < cabs(lambda[list[j - 1]] - target); j--) {
      const PetscInt swap = list[j];

      list[j]     = list[j - 1];
      list[j - 1] = swap;
    }
  *n = PetscMin(*n, window->count + second + more);
  *d = *n < window->count + second ? PETSC_MAX_REAL : cabs(lambda[list[*n - 1]] - target);
}

/* Scales a vector to length one and turns a complex one so that x^T x is real and positive */
static void VectorTurn(PetscInt k, PetscBool is_real, PetscComplex x[])
{
  PetscReal    length = 0;
  PetscComplex square = 0;

  for (PetscInt i = 0; i < k; i++) {
    length += creal(conj(x[i]) * x[i]);
    square += x[i] * x[i];
  }
  square = !is_real && cabs(square) > 0 ? conj(csqrt(square / cabs(square))) : 1;
  for (PetscInt i = 0; i < k; i++) x[i] *= square / sqrt(length);
}

/* Room for n modes of the present basis; left vectors that nobody asks for need no digits */
PetscErrorCode ProjectionModesCreate(const Projection *p, PetscInt n, ProjectionModes *modes)
{
  PetscFunctionBeginUser;
  *modes = (ProjectionModes){.n = n, .size = p->space.n};
  PetscCall(PetscMalloc3(n, &modes->lambda, n * p->space.n, &modes->vectors[0], n * p->space.n, &modes->vectors[1]));
  PetscCall(PetscMalloc2(n, &modes->backward[0], n, &modes->backward[1]));
  for (PetscInt i = 0; i < n; i++) {
    modes->backward[0][i] = INFINITY;
    modes->backward[1][i] = p->modes->left ? INFINITY : 0;
  }
  PetscFunctionReturn(0);
}

PetscErrorCode ProjectionModesDestroy(ProjectionModes *modes)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree3(modes->lambda, modes->vectors[0], modes->vectors[1]));
  PetscCall(PetscFree2(modes->backward[0], modes->backward[1]));
  PetscFunctionReturn(0);
}

/* Whether two of the modes are one and the same */
PetscBool ProjectionHasTwice(const ProjectionModes *m)
{
  for (PetscInt i = 0; i < m->n; i++)
    for (PetscInt j = 0; j < i; j++) {
      PetscComplex dot = 0;

      if (cabs(m->lambda[i] - m->lambda[j]) > FOLLOW_FAR * cabs(m->lambda[i]) || m->lambda[i] == 0) continue;
      for (PetscInt k = 0; k < m->size; k++)
        dot += conj(m->vectors[0][i * m->size + k]) * m->vectors[0][j * m->size + k];
      if (cabs(dot) > FOLLOW_ONE && cabs(m->lambda[i] - m->lambda[j]) < FOLLOW_EQUAL * cabs(m->lambda[i]))
        return PETSC_TRUE;
    }
  return PETSC_FALSE;
}

/* The values of rank 0 on all */
PetscErrorCode ProjectionModesShare(MPI_Comm comm, ProjectionModes *m)
{
  PetscMPIInt count;

  PetscFunctionBeginUser;
  PetscCall(PetscMPIIntCast(2 * m->n * m->size, &count));
  PetscCallMPI(MPI_Bcast(m->lambda, (PetscMPIInt)(2 * m->n), MPIU_REAL, 0, comm));
  for (int side = 0; side < 2; side++) PetscCallMPI(MPI_Bcast(m->vectors[side], count, MPIU_REAL, 0, comm));
  PetscFunctionReturn(0);
}

/* Mode i from what it was on fewer vectors, padded by zeros, by inverse iteration on the dense pencil: an LU of n rows
   in place of all eigenvalues of a problem of 2 n. A mode whose errors are met already, or a rigid one, stays as it
   is. */
static PetscErrorCode FollowMode(const Projection *p, const DensePencil *dense, const ProjectionModes *before,
                                 PetscInt i, ProjectionModes *modes, PetscBool *found)
{
  const PetscComplex was     = before->lambda[i];
  const PetscBool    is_real = cimag(was) == 0 ? PETSC_TRUE : PETSC_FALSE;

  PetscFunctionBeginUser;
  *found           = PETSC_TRUE;
  modes->lambda[i] = was;
  for (int side = 0; side < 2; side++) {
    PetscComplex *x = &modes->vectors[side][i * p->space.n];

    PetscCall(PetscArrayzero(x, p->space.n));
    PetscCall(PetscArraycpy(x, &before->vectors[side][i * before->size], before->size));
    if (before->backward[side][i] <= p->limit[side]) modes->backward[side][i] = before->backward[side][i];
  }
  if ((p->window->known.rigid && cabs(was) <= p->window->known.scale) ||
      (isfinite(modes->backward[0][i]) && isfinite(modes->backward[1][i])))
    PetscFunctionReturn(0);
  PetscCall(DensePencilFollow(dense, &modes->lambda[i], &modes->vectors[0][i * p->space.n],
                              &modes->vectors[1][i * p->space.n], found));
  if (is_real) modes->lambda[i] = creal(modes->lambda[i]);
  if (!(cabs(modes->lambda[i] - was) <= FOLLOW_FAR * cabs(was))) *found = PETSC_FALSE;
  for (int side = 0; side < 2; side++) VectorTurn(p->space.n, is_real, &modes->vectors[side][i * p->space.n]);
  PetscFunctionReturn(0);
}

/* All eigenvalues of the dense problem, those of real matrices behind those with laws held at the reference: what
   oscillates of a nonlinear problem is of the latter, rigid motions, which no law knows, of the former */
typedef struct {
  PetscInt     n_frozen, n;
  DenseFrozen  frozen;
  DenseShifted shifted;
} DenseAll;

/* About the upper end of the window, those of rank 0 on all */
static PetscErrorCode DenseAllSolve(const Projection *p, const DensePencil *dense, DenseAll *w)
{
  const PetscReal high     = PetscMax(p->window->high, p->window->target);
  const PetscReal shift    = PetscMax(high, PetscSqrtReal(PetscAbsReal(p->si.shift)));
  PetscReal      *values[] = {&w->shifted.shift, NULL, NULL};

  PetscFunctionBeginUser;
  *w = (DenseAll){.n = 0};
  if (dense->n_laws) {
    PetscCall(DenseFrozenSolve(p->modes->comm, dense, shift, PETSC_TRUE, &w->frozen));
    w->n = w->n_frozen = w->frozen.N;
    PetscCallMPI(MPI_Bcast(w->frozen.theta, (PetscMPIInt)(2 * w->n), MPIU_REAL, 0, p->modes->comm));
  }
  if (dense->n_laws && !p->window->known.rigid) PetscFunctionReturn(0);
  PetscCall(DenseShiftedSolve(dense, shift, &w->shifted));
  w->n += w->shifted.N;
  values[1] = w->shifted.schur.wr, values[2] = w->shifted.schur.wi;
  for (int i = 0; i < 3; i++)
    PetscCallMPI(MPI_Bcast(values[i], (PetscMPIInt)(i ? w->shifted.N : 1), MPIU_REAL, 0, p->modes->comm));
  PetscFunctionReturn(0);
}

/* lambda of entry i, false for what is not listed */
static PetscBool DenseAllLambda(const Projection *p, const DenseAll *w, PetscInt i, PetscComplex *lambda)
{
  const PetscBool frozen = i < w->n_frozen ? PETSC_TRUE : PETSC_FALSE;
  PetscBool       rigid;

  if (!(frozen ? DenseFrozenLambda(&w->frozen, i, lambda) : DenseShiftedLambda(&w->shifted, i - w->n_frozen, lambda)))
    return PETSC_FALSE;
  rigid = p->window->known.rigid && cabs(*lambda) <= p->window->known.scale ? PETSC_TRUE : PETSC_FALSE;
  return !w->n_frozen || frozen != rigid ? PETSC_TRUE : PETSC_FALSE;
}

static PetscErrorCode DenseAllVectors(const DenseAll *w, PetscInt i, PetscComplex x[], PetscComplex y[])
{
  PetscFunctionBeginUser;
  if (i < w->n_frozen) {
    DenseFrozenRight(&w->frozen, i, x);
    PetscCall(DenseFrozenLeft(&w->frozen, i, y));
  } else {
    PetscCall(DenseShiftedRight(&w->shifted, i - w->n_frozen, x));
    PetscCall(DenseShiftedLeft(&w->shifted, i - w->n_frozen, y));
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode DenseAllDestroy(DenseAll *w)
{
  PetscFunctionBeginUser;
  if (w->n_frozen) PetscCall(DenseFrozenDestroy(&w->frozen));
  if (w->n > w->n_frozen) PetscCall(DenseShiftedDestroy(&w->shifted));
  PetscFunctionReturn(0);
}

PetscErrorCode ProjectionEigen(const Projection *p, ProjectionModes *modes)
{
  const DensePencil dense = SubspacePencil(&p->space);
  const PetscInt    k     = p->space.n;
  PetscComplex     *lambda;
  PetscReal         d = 0;
  PetscInt         *list, m = 0;
  DenseAll          w;

  PetscFunctionBeginUser;
  PetscCall(DenseAllSolve(p, &dense, &w));
  PetscCall(PetscMalloc2(w.n, &lambda, w.n, &list));
  for (PetscInt i = 0; i < w.n; i++)
    if (DenseAllLambda(p, &w, i, &lambda[i]) && LambdaMayBe(p, lambda[i])) list[m++] = i;
  if (p->window->count) ProjectionKeepNearest(p->window, w.n_frozen ? LAWS_MORE : 0, lambda, list, &m, &d);
  PetscCall(ProjectionModesCreate(p, m, modes));
  for (PetscInt i = 0; i < m; i++) {
    modes->lambda[i] = lambda[list[i]];
    PetscCall(DenseAllVectors(&w, list[i], &modes->vectors[0][i * k], &modes->vectors[1][i * k]));
    for (int side = 0; side < 2; side++)
      VectorTurn(k, cimag(modes->lambda[i]) == 0 ? PETSC_TRUE : PETSC_FALSE, &modes->vectors[side][i * k]);
  }
  PetscCall(ProjectionModesShare(p->modes->comm, modes));
  modes->lambda_reach = ProjectionEdge(p, d);
  PetscCall(PetscFree2(lambda, list));
  PetscCall(DenseAllDestroy(&w));
  PetscFunctionReturn(0);
}

PetscErrorCode ProjectionFollow(const Projection *p, const ProjectionModes *before, ProjectionModes *modes,
                                PetscBool *followed)
{
  const DensePencil dense = SubspacePencil(&p->space);

  PetscFunctionBeginUser;
  PetscCall(ProjectionModesCreate(p, before->n, modes));
  modes->lambda_reach = before->lambda_reach;
  *followed           = PETSC_TRUE;
  for (PetscInt i = 0; i < before->n && *followed; i++) PetscCall(FollowMode(p, &dense, before, i, modes, followed));
  if (*followed && ProjectionHasTwice(modes)) *followed = PETSC_FALSE;
  PetscCallMPI(MPI_Bcast(followed, 1, MPIU_BOOL, 0, p->modes->comm));
  if (*followed) PetscCall(ProjectionModesShare(p->modes->comm, modes));
  if (!*followed) PetscCall(ProjectionModesDestroy(modes));
  PetscFunctionReturn(0);
}
