/*
   The dense quadratic problem (lambda^2 M + lambda C + K) x = 0 of a projection, M nearly I, through A z = mu z with

      A = [0 I; -M^-1 K / w^2 -M^-1 C / w],   z = [x; mu x],   lambda = w mu,

   w the upper end of the window, which leaves |mu| <= 1 there. Left vectors: u^H A = mu u^H, y = M^-T conj of u's second half.
*/
#include "projection.h"
#include "solver/dense/pencil.h"

#define FOLLOW_FAR   1e-3  /* relative change of lambda that is another mode's */
#define FOLLOW_ONE   0.999 /* cosine of the angle of two vectors that are one */
#define POLISH_STIFF 1e4   /* |K| beside the square of the upper end */
#define EDGE_POINTS  64    /* on each side of the window's edge, where kappa(lambda) is looked at */

/* Factors of M */
typedef struct {
  PetscReal    *LU; /* [k * k] */
  PetscBLASInt *pivot;
} MassFactors;

static PetscErrorCode MassFactorsCreate(const Projection *p, MassFactors *mass)
{
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(p->k * p->k, &mass->LU, p->k, &mass->pivot));
  PetscCall(PetscArraycpy(mass->LU, p->M, p->k * p->k));
  PetscCall(DenseFactor(p->k, mass->LU, mass->pivot, NULL));
  PetscFunctionReturn(0);
}

static PetscErrorCode MassFactorsDestroy(MassFactors *mass)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree2(mass->LU, mass->pivot));
  PetscFunctionReturn(0);
}

/* -scale M^-1 S into the rows k .. 2 k - 1 of k columns of A, [2 k * 2 k] */
static PetscErrorCode CompanionFillBlock(PetscInt k, const MassFactors *mass, PetscReal scale, const PetscReal S[],
                                         PetscReal A[])
{
  PetscReal *B;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(k * k, &B));
  PetscCall(PetscArraycpy(B, S, k * k));
  PetscCall(DenseSolve(k, mass->LU, mass->pivot, PETSC_FALSE, k, B));
  for (PetscInt j = 0; j < k; j++)
    for (PetscInt i = 0; i < k; i++) A[2 * j * k + k + i] = -scale * B[j * k + i];
  PetscCall(PetscFree(B));
  PetscFunctionReturn(0);
}

/* A, column-major */
static PetscErrorCode CompanionFill(const Projection *p, const MassFactors *mass, PetscReal w, PetscReal A[])
{
  const PetscInt k = p->k;

  PetscFunctionBeginUser;
  for (PetscInt j = 0; j < k; j++) A[(k + j) * 2 * k + j] = 1;
  PetscCall(CompanionFillBlock(k, mass, 1 / (w * w), p->K, A));
  PetscCall(CompanionFillBlock(k, mass, 1 / w, p->C, A + 2 * k * k));
  PetscFunctionReturn(0);
}

PetscBool ProjectionHas(const Projection *p, PetscComplex lambda)
{
  const Window      *w     = p->window;
  const PetscReal    omega = cimag(lambda);
  const PetscComplex kappa = ProjectionKappa(p, lambda);

  if (w->count) return cabs(kappa - p->si.shift) <= p->reach ? PETSC_TRUE : PETSC_FALSE;
  if (omega < w->edge[0] || omega > w->edge[1]) return PETSC_FALSE;
  if (PetscAbsReal(creal(lambda)) <= w->growth || p->reach == PETSC_MAX_REAL) return PETSC_TRUE;
  return creal(kappa) >= PetscSqr(w->edge[0]) && creal(kappa) <= PetscSqr(w->edge[1]) ? PETSC_TRUE : PETSC_FALSE;
}

static PetscReal LambdaFar(const Projection *p, PetscComplex lambda)
{
  return cabs(ProjectionKappa(p, lambda) - p->si.shift);
}

PetscReal ProjectionEdge(const Projection *p, PetscReal d)
{
  const Window *w       = p->window;
  PetscReal     largest = 0;

  /* at the pole -1 / beta overdamped modes gather; above the real axis kappa is largest on the edge */
  if (!w->count && w->low <= 0 && p->beta * w->growth >= 1) return PETSC_MAX_REAL;
  if (w->count && p->beta * d >= 1) return PETSC_MAX_REAL;
  for (int i = 0; i <= EDGE_POINTS; i++) {
    const PetscReal t = (PetscReal)i / EDGE_POINTS, sigma = (2 * t - 1) * w->growth;
    const PetscReal omega = w->low + t * (w->high - w->low);

    if (w->count) {
      const PetscComplex at = CMPLX(d * cos(2 * PETSC_PI * t), w->target + d * sin(2 * PETSC_PI * t));

      largest = PetscMax(largest, LambdaFar(p, at));
      continue;
    }
    largest = PetscMax(largest, PetscMax(LambdaFar(p, CMPLX(sigma, w->low)), LambdaFar(p, CMPLX(sigma, w->high))));
    largest =
      PetscMax(largest, PetscMax(LambdaFar(p, CMPLX(-w->growth, omega)), LambdaFar(p, CMPLX(w->growth, omega))));
  }
  return largest;
}

/* Leaves of the chosen eigenvalues, list [n], the count nearest to the target; *d = distance of the farthest */
static void KeepNearest(const Window *window, const PetscComplex lambda[], PetscInt list[], PetscInt *n, PetscReal *d)
{
  const PetscComplex target = CMPLX(0, window->target);

  for (PetscInt i = 1; i < *n; i++)
    for (PetscInt j = i; j > 0 && cabs(lambda[list[j]] - target) < cabs(lambda[list[j - 1]] - target); j--) {
      const PetscInt swap = list[j];

      list[j]     = list[j - 1];
      list[j - 1] = swap;
    }
  *n = PetscMin(*n, window->count);
  *d = *n ? cabs(lambda[list[*n - 1]] - target) : 0;
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

/* Copies a vector of LAPACK's real storage; left ones are conjugated, and multiplied by M^-T */
static PetscErrorCode VectorCopy(PetscInt k, const PetscReal *re, const PetscReal *im, const MassFactors *mass,
                                 PetscComplex x[])
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < k; i++) x[i] = CMPLX(re[i], im ? (mass ? -im[i] : im[i]) : 0);
  if (mass) {
    PetscReal *parts;

    PetscCall(PetscMalloc1(2 * k, &parts));
    DenseSplit(k, x, parts);
    PetscCall(DenseSolve(k, mass->LU, mass->pivot, PETSC_TRUE, 2, parts));
    DenseUnite(k, parts, x);
    PetscCall(PetscFree(parts));
  }
  VectorTurn(k, im ? PETSC_FALSE : PETSC_TRUE, x);
  PetscFunctionReturn(0);
}

/* Room for n modes of the present basis; left vectors that nobody asks for need no digits */
static PetscErrorCode ProjectionModesCreate(const Projection *p, PetscInt n, ProjectionModes *modes)
{
  PetscFunctionBeginUser;
  *modes = (ProjectionModes){.n = n, .size = p->k};
  PetscCall(PetscMalloc3(n, &modes->lambda, n * p->k, &modes->vectors[0], n * p->k, &modes->vectors[1]));
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

/* Eigenvalues (rad/s) and vectors of the companion form, those of rank 0 on all; L, R [2 k][2 k] */
static PetscErrorCode CompanionSolve(const Projection *p, const MassFactors *mass, PetscComplex lambda[], PetscReal L[],
                                     PetscReal R[])
{
  const PetscInt  n = 2 * p->k;
  const PetscReal w = PetscMax(PetscMax(p->window->high, p->window->target), PetscSqrtReal(PetscAbsReal(p->si.shift)));
  PetscReal      *A, *wr, *wi;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(n * n, &A));
  PetscCall(PetscMalloc2(n, &wr, n, &wi));
  PetscCall(CompanionFill(p, mass, w, A));
  PetscCall(DenseEigen(n, A, wr, wi, L, R));
  for (PetscInt i = 0; i < n; i++) lambda[i] = w * CMPLX(wr[i], wi[i]);
  PetscCallMPI(MPI_Bcast(lambda, (PetscMPIInt)(2 * n), MPIU_REAL, 0, p->modes->comm));
  PetscCallMPI(MPI_Bcast(L, (PetscMPIInt)(n * n), MPIU_REAL, 0, p->modes->comm));
  PetscCallMPI(MPI_Bcast(R, (PetscMPIInt)(n * n), MPIU_REAL, 0, p->modes->comm));
  PetscCall(PetscFree2(wr, wi));
  PetscCall(PetscFree(A));
  PetscFunctionReturn(0);
}

/* Whether two of the modes are one and the same */
static PetscBool HasTwice(const ProjectionModes *m)
{
  for (PetscInt i = 0; i < m->n; i++)
    for (PetscInt j = 0; j < i; j++) {
      PetscComplex dot = 0;

      if (cabs(m->lambda[i] - m->lambda[j]) > FOLLOW_FAR * cabs(m->lambda[i]) || m->lambda[i] == 0) continue;
      for (PetscInt k = 0; k < m->size; k++)
        dot += conj(m->vectors[0][i * m->size + k]) * m->vectors[0][j * m->size + k];
      if (cabs(dot) > FOLLOW_ONE && cabs(m->lambda[i] - m->lambda[j]) < 1e-9 * cabs(m->lambda[i])) return PETSC_TRUE;
    }
  return PETSC_FALSE;
}

/* The values of rank 0 on all */
static PetscErrorCode ModesShare(MPI_Comm comm, ProjectionModes *m)
{
  PetscMPIInt count;

  PetscFunctionBeginUser;
  PetscCall(PetscMPIIntCast(2 * m->n * m->size, &count));
  PetscCallMPI(MPI_Bcast(m->lambda, (PetscMPIInt)(2 * m->n), MPIU_REAL, 0, comm));
  for (int side = 0; side < 2; side++) PetscCallMPI(MPI_Bcast(m->vectors[side], count, MPIU_REAL, 0, comm));
  PetscFunctionReturn(0);
}

/* Mode i from what it was before */
static PetscErrorCode FollowMode(const Projection *p, const DensePencil *dense, const ProjectionModes *before,
                                 PetscInt i, ProjectionModes *modes, PetscBool *found)
{
  const PetscComplex was     = before->lambda[i];
  const PetscBool    is_real = cimag(was) == 0 ? PETSC_TRUE : PETSC_FALSE;

  PetscFunctionBeginUser;
  *found           = PETSC_TRUE;
  modes->lambda[i] = was;
  for (int side = 0; side < 2; side++) {
    PetscComplex *x = &modes->vectors[side][i * p->k];

    PetscCall(PetscArrayzero(x, p->k));
    PetscCall(PetscArraycpy(x, &before->vectors[side][i * before->size], before->size));
    if (before->backward[side][i] <= p->limit[side]) modes->backward[side][i] = before->backward[side][i];
  }
  if ((p->window->rigid && cabs(was) <= p->window->scale) ||
      (isfinite(modes->backward[0][i]) && isfinite(modes->backward[1][i])))
    PetscFunctionReturn(0);
  PetscCall(
    DensePencilFollow(dense, &modes->lambda[i], &modes->vectors[0][i * p->k], &modes->vectors[1][i * p->k], found));
  if (is_real) modes->lambda[i] = creal(modes->lambda[i]);
  if (!(cabs(modes->lambda[i] - was) <= FOLLOW_FAR * cabs(was))) *found = PETSC_FALSE;
  for (int side = 0; side < 2; side++) VectorTurn(p->k, is_real, &modes->vectors[side][i * p->k]);
  PetscFunctionReturn(0);
}

/* Where the model is stiff beside the window, its eigenvalues have errors of that many roundings: improves them one by
   one, where that is found */
static PetscErrorCode ModesPolish(const Projection *p, ProjectionModes *modes)
{
  const PetscReal w    = PetscMax(p->window->high, p->window->target);
  PetscReal       norm = 0;
  ProjectionModes better;
  PetscBool       followed;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < p->k * p->k; i++) norm = PetscMax(norm, PetscAbsReal(p->K[i]));
  if (norm <= POLISH_STIFF * w * w) PetscFunctionReturn(0);
  PetscCall(ProjectionFollow(p, modes, &better, &followed));
  if (!followed) PetscFunctionReturn(0);
  PetscCall(ProjectionModesDestroy(modes));
  *modes = better;
  PetscFunctionReturn(0);
}

PetscErrorCode ProjectionEigen(const Projection *p, ProjectionModes *modes)
{
  const PetscInt k = p->k, n = 2 * k;
  PetscComplex  *lambda;
  PetscReal     *L, *R, d = 0;
  PetscInt      *list, m = 0;
  MassFactors    mass;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc4(n, &lambda, n * n, &L, n * n, &R, n, &list));
  PetscCall(MassFactorsCreate(p, &mass));
  PetscCall(CompanionSolve(p, &mass, lambda, L, R));
  for (PetscInt i = 0; i < n; i++)
    if (cimag(lambda[i]) >= 0 && ProjectionHas(p, lambda[i])) list[m++] = i;
  if (p->window->count) KeepNearest(p->window, lambda, list, &m, &d);
  PetscCall(ProjectionModesCreate(p, m, modes));
  for (PetscInt i = 0; i < m; i++) {
    const PetscInt  at     = list[i] * n;
    const PetscBool paired = cimag(lambda[list[i]]) > 0 ? PETSC_TRUE : PETSC_FALSE;

    modes->lambda[i] = lambda[list[i]];
    PetscCall(VectorCopy(k, &R[at], paired ? &R[at + n] : NULL, NULL, &modes->vectors[0][i * k]));
    PetscCall(VectorCopy(k, &L[at + k], paired ? &L[at + n + k] : NULL, &mass, &modes->vectors[1][i * k]));
  }
  PetscCall(MassFactorsDestroy(&mass));
  modes->lambda_reach = ProjectionEdge(p, d);
  PetscCall(ModesPolish(p, modes));
  PetscCall(PetscFree4(lambda, L, R, list));
  PetscFunctionReturn(0);
}

PetscErrorCode ProjectionFollow(const Projection *p, const ProjectionModes *before, ProjectionModes *modes,
                                PetscBool *followed)
{
  const DensePencil dense = {.n = p->k, .damped = PETSC_TRUE, .K = p->K, .C = p->C, .M = p->M};

  PetscFunctionBeginUser;
  PetscCall(ProjectionModesCreate(p, before->n, modes));
  modes->lambda_reach = before->lambda_reach;
  *followed           = PETSC_TRUE;
  for (PetscInt i = 0; i < before->n && *followed; i++) PetscCall(FollowMode(p, &dense, before, i, modes, followed));
  if (*followed && HasTwice(modes)) *followed = PETSC_FALSE;
  PetscCallMPI(MPI_Bcast(followed, 1, MPIU_BOOL, 0, p->modes->comm));
  if (*followed) PetscCall(ModesShare(p->modes->comm, modes));
  if (!*followed) PetscCall(ProjectionModesDestroy(modes));
  PetscFunctionReturn(0);
}
