/*
   The reduced model in the eigenvectors of the middle of a cell. With M0 of the middle and x = X1 of
   z = [h x; lambda x], damped

      A0 = [0 hI; -M0^-1 K / h, -M0^-1 C],   E = -G (dK x_l + lambda_l dC x_l),   B' = G dM lambda_l x_l,

   G = (lower half of W) M0^-1; undamped A0 = M0^-1 K, E = G dK x_l, B' = G dM x_l. What W = X^-1 leaves of W A0 X -
   Lambda and W X - I by rounding is part of E and B'. Row k of E is at s = value_k, which takes value_k B'_kl off.
*/
#include "frame.h"
#include "sweep/dense/eigen.h"
#include "base/algebra/dense.h"

/* What is needed until the frame is made */
typedef struct {
  PetscInt      n, N;
  DensePencil   pencil;
  PetscReal    *M, *A; /* [n * n] factors of M0; [N * N] A0 */
  PetscBLASInt *pivot;
  PetscComplex *X, *W;  /* [N][N] columns of X, rows of W */
  PetscComplex *x, *G;  /* [N][n] */
  PetscComplex *Sx, *H; /* [N][n], [N][N] columns: work */
  PetscReal    *S;      /* [n * n] */
} FrameWork;

/* A0 in work->A: K, then C in place of themselves become M0^-1 K, M0^-1 C */
static PetscErrorCode FrameMatrix(FrameWork *w, PetscBool damped, PetscReal h)
{
  const PetscInt n = w->n, N = w->N;
  DensePencil   *q = &w->pencil;

  PetscFunctionBeginUser;
  PetscCall(PetscArraycpy(w->M, q->M, n * n));
  PetscCall(DenseFactor(n, w->M, w->pivot, NULL));
  PetscCall(DenseSolve(n, w->M, w->pivot, PETSC_FALSE, n, q->K));
  if (damped) PetscCall(DenseSolve(n, w->M, w->pivot, PETSC_FALSE, n, q->C));
  PetscCall(PetscArrayzero(w->A, N * N));
  for (PetscInt j = 0; j < n; j++) {
    if (damped) w->A[(n + j) * N + j] = h;
    for (PetscInt i = 0; i < n; i++) {
      if (damped) w->A[j * N + n + i] = -q->K[j * n + i] / h;
      if (damped) w->A[(n + j) * N + n + i] = -q->C[j * n + i];
      if (!damped) w->A[j * N + i] = q->K[j * n + i];
    }
  }
  PetscFunctionReturn(0);
}

/* Eigenvalues and vectors of A0, X and W^T = X^-T */
static PetscErrorCode FrameEigen(FrameWork *w, CellFrame *frame, PetscBool *singular)
{
  const PetscInt N = w->N;
  PetscReal     *copy, *wr, *wi, *R;
  PetscComplex  *LU;
  PetscBLASInt  *pivot;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc6(N * N, &copy, N, &wr, N, &wi, N * N, &R, N * N, &LU, N, &pivot));
  PetscCall(PetscArraycpy(copy, w->A, N * N));
  PetscCall(DenseEigen(N, copy, wr, wi, NULL, R));
  for (PetscInt k = 0; k < N; k++) {
    const PetscBool second = wi[k] < 0 ? PETSC_TRUE : PETSC_FALSE; /* of a pair, whose parts stand in k - 1 and k */
    const PetscInt  re     = second ? k - 1 : k;

    frame->value[k] = CMPLX(wr[k], wi[k]);
    for (PetscInt i = 0; i < N; i++)
      w->X[k * N + i] = wi[k] == 0 ? R[k * N + i] : CMPLX(R[re * N + i], (second ? -1 : 1) * R[(re + 1) * N + i]);
  }
  PetscCall(PetscArraycpy(LU, w->X, N * N));
  PetscCall(PetscArrayzero(w->W, N * N));
  for (PetscInt k = 0; k < N; k++) w->W[k * N + k] = 1;
  PetscCall(DenseComplexFactor(N, LU, pivot, singular));
  if (!*singular) PetscCall(DenseComplexSolve(N, LU, pivot, PETSC_TRUE, N, w->W));
  PetscCall(PetscFree6(copy, wr, wi, R, LU, pivot));
  PetscFunctionReturn(0);
}

/* x and G from X and W */
static PetscErrorCode FrameVectors(FrameWork *w, PetscBool damped, PetscReal h)
{
  const PetscInt n = w->n, N = w->N;
  PetscReal     *parts;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(2 * N * n, &parts));
  for (PetscInt k = 0; k < N; k++) {
    for (PetscInt i = 0; i < n; i++) w->x[k * n + i] = damped ? w->X[k * N + i] / h : w->X[k * N + i];
    for (PetscInt i = 0; i < n; i++) w->G[k * n + i] = w->W[k * N + (damped ? n : 0) + i];
    DenseSplit(n, &w->G[k * n], &parts[2 * k * n]);
  }
  PetscCall(DenseSolve(n, w->M, w->pivot, PETSC_TRUE, 2 * N, parts));
  for (PetscInt k = 0; k < N; k++) DenseUnite(n, &parts[2 * k * n], &w->G[k * n]);
  PetscCall(PetscFree(parts));
  PetscFunctionReturn(0);
}

/* W A0 X - Lambda and W X - I as parts of F and B, which begin here */
static PetscErrorCode FrameResiduals(FrameWork *w, CellFrame *frame)
{
  const PetscInt N = w->N;
  PetscComplex  *AX;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(N * N, &AX));
  PetscCall(DenseTimes(&(DenseBlock){w->A, N, N, N}, PETSC_FALSE, N, w->X, AX));
  PetscCall(DenseComplexProducts(N, N, w->W, N, AX, w->H));
  PetscCall(DenseComplexProducts(N, N, w->W, N, w->X, AX));
  for (PetscInt k = 0; k < N; k++)
    for (PetscInt l = 0; l < N; l++) {
      const PetscComplex one = k == l ? 1 : 0;

      frame->B[k * N + l] = cabs(AX[l * N + k] - one);
      frame->F[k * N + l] = cabs(w->H[l * N + k] - frame->value[k] * AX[l * N + k]);
    }
  PetscCall(PetscFree(AX));
  PetscFunctionReturn(0);
}

/* H [N][N] (columns l) = G S (factor_l x_l) for S [n * n], with the sign and the power of lambda of a kind */
static PetscErrorCode FrameTransform(FrameWork *w, const CellFrame *frame, OperatorsTermKind kind, PetscComplex H[])
{
  const PetscInt n = w->n, N = w->N;

  PetscFunctionBeginUser;
  PetscCall(DenseTimes(&(DenseBlock){w->S, n, n, n}, PETSC_FALSE, N, w->x, w->Sx));
  for (PetscInt l = 0; l < N; l++) {
    const PetscComplex power = frame->damped && kind != OPERATORS_STIFFNESS ? frame->value[l] : 1;
    const PetscReal    sign  = frame->damped && kind != OPERATORS_MASS ? -1 : 1;

    for (PetscInt i = 0; i < n; i++) w->Sx[l * n + i] *= sign * power;
  }
  PetscCall(DenseComplexProducts(n, N, w->G, N, w->Sx, H));
  PetscFunctionReturn(0);
}

/* S := sum of c[t] A_t of a kind; whether there is anything */
static PetscBool FrameSum(FrameWork *w, const Reduced *reduced, OperatorsTermKind kind, const PetscReal c[])
{
  const PetscInt n     = w->n;
  PetscBool      found = PETSC_FALSE;

  for (PetscInt i = 0; i < n * n; i++) w->S[i] = 0;
  for (PetscInt t = 0; t < reduced->n_terms; t++) {
    if (reduced->term[t].kind != kind || c[t] == 0) continue;
    found = PETSC_TRUE;
    for (PetscInt j = 0; j < n; j++)
      for (PetscInt i = 0; i < n; i++) w->S[j * n + i] += c[t] * reduced->A[t][j * reduced->n + i];
  }
  return found;
}

/* What a change c [n_terms] of the coefficients does to E and B', in work: E [N][N] and B [N][N], by columns */
static PetscErrorCode FrameChange(FrameWork *w, const Reduced *reduced, const CellFrame *frame, const PetscReal c[],
                                  PetscComplex E[], PetscComplex B[])
{
  const PetscInt N = w->N;

  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(E, N * N));
  PetscCall(PetscArrayzero(B, N * N));
  for (OperatorsTermKind kind = OPERATORS_STIFFNESS; kind <= OPERATORS_MASS; kind++) {
    if (!FrameSum(w, reduced, kind, c)) continue;
    PetscCall(FrameTransform(w, frame, kind, w->H));
    for (PetscInt l = 0; l < N; l++)
      for (PetscInt k = 0; k < N; k++) {
        const PetscComplex h = w->H[l * N + k];

        E[l * N + k] += kind == OPERATORS_MASS ? -frame->value[k] * h : h;
        if (kind == OPERATORS_MASS) B[l * N + k] += h;
      }
  }
  PetscFunctionReturn(0);
}

/* The linear part of variable j, whose coefficients change by c at its end of the cell */
static void FrameAddLinear(CellFrame *frame, PetscInt j, const PetscComplex E[], const PetscComplex B[])
{
  const PetscInt N = frame->N;

  for (PetscInt k = 0; k < N; k++) {
    const PetscReal size = cabs(frame->value[k]);

    frame->shift[j * N + k] = E[k * N + k];
    for (PetscInt l = 0; l < N; l++) {
      const PetscReal e = cabs(E[l * N + k]);

      frame->B[k * N + l] += cabs(B[l * N + k]);
      if (l == k) continue;
      frame->F[k * N + l] += e;
      if (size > 0 && cabs(frame->value[l]) > 0)
        frame->influence[j * N + k] += e * PetscSqrtReal(size / cabs(frame->value[l]));
    }
    frame->influence[j * N + k] += frame->damped ? PetscAbsReal(creal(E[k * N + k])) : 0;
  }
}

/* What is beyond the linear parts of all coefficients, of one term */
static void FrameAddRest(CellFrame *frame, const PetscComplex E[], const PetscComplex B[])
{
  const PetscInt N = frame->N;

  for (PetscInt k = 0; k < N; k++) {
    frame->rest[k] += cabs(E[k * N + k]);
    for (PetscInt l = 0; l < N; l++) {
      frame->B[k * N + l] += cabs(B[l * N + k]);
      if (l != k) frame->F[k * N + l] += cabs(E[l * N + k]);
    }
  }
}

/* F, B, rest and shift over the cell of half widths `half` */
static PetscErrorCode FrameFill(FrameWork *w, const Reduced *reduced, const Enclosure enclosure[],
                                const PetscReal half[], CellFrame *frame)
{
  const PetscInt N = w->N;
  PetscReal     *c;
  PetscComplex  *E, *B;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc3(reduced->n_terms, &c, N * N, &E, N * N, &B));
  for (PetscInt j = 0; j < frame->d; j++) {
    for (PetscInt t = 0; t < reduced->n_terms; t++) c[t] = enclosure[t].slope[j] * half[j];
    PetscCall(FrameChange(w, reduced, frame, c, E, B));
    FrameAddLinear(frame, j, E, B);
  }
  for (PetscInt t = 0; t < reduced->n_terms; t++) {
    if (enclosure[t].remainder == 0) continue;
    PetscCall(PetscArrayzero(c, reduced->n_terms));
    c[t] = enclosure[t].remainder;
    PetscCall(FrameChange(w, reduced, frame, c, E, B));
    FrameAddRest(frame, E, B);
  }
  for (PetscInt k = 0; k < N; k++) frame->rest[k] += frame->F[k * N + k], frame->F[k * N + k] = 0;
  PetscCall(PetscFree3(c, E, B));
  PetscFunctionReturn(0);
}

/* Whether a damping term is not zero in all of the cell */
static PetscBool CellIsDamped(const Reduced *reduced, const PetscReal p[], const Enclosure enclosure[], PetscInt d)
{
  for (PetscInt t = 0; t < reduced->n_terms; t++) {
    if (reduced->term[t].kind != OPERATORS_DAMPING) continue;
    if (OperatorsTermCoefficient(&reduced->term[t], p) != 0 || enclosure[t].remainder != 0) return PETSC_TRUE;
    for (PetscInt j = 0; j < d; j++)
      if (enclosure[t].slope[j] != 0) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

static PetscErrorCode FrameAllocate(PetscInt n, PetscInt N, PetscInt d, FrameWork *w, CellFrame *frame)
{
  PetscFunctionBeginUser;
  w->n = n, w->N = N;
  frame->N = N, frame->d = d;
  PetscCall(PetscMalloc3(n * n, &w->M, N * N, &w->A, n, &w->pivot));
  PetscCall(
    PetscMalloc7(N * N, &w->X, N * N, &w->W, N * n, &w->x, N * n, &w->G, N * n, &w->Sx, N * N, &w->H, n * n, &w->S));
  PetscCall(PetscCalloc6(N, &frame->value, N * N, &frame->F, N * N, &frame->B, N, &frame->rest, d * N, &frame->shift,
                         d * N, &frame->influence));
  PetscFunctionReturn(0);
}

/* N is 0 where the middle is defective: nothing can be shown then */
PetscErrorCode CellFrameCreate(const Reduced *reduced, const Cube *cube, const PetscReal low[], const PetscReal high[],
                               PetscReal scale, CellFrame *frame)
{
  const PetscInt n = reduced->n_used;
  FrameWork      w;
  Enclosure     *enclosure;
  PetscReal      t[CUBE_MAX_VARIABLES], half[CUBE_MAX_VARIABLES], *p;
  PetscBool      singular;

  PetscFunctionBeginUser;
  *frame = (CellFrame){0};
  PetscCall(PetscMalloc2(reduced->n_terms, &enclosure, cube->n_parameters, &p));
  for (PetscInt j = 0; j < cube->n; j++) t[j] = 0.5 * (low[j] + high[j]), half[j] = 0.5 * (high[j] - low[j]);
  CubePoint(cube, t, p);
  for (PetscInt i = 0; i < reduced->n_terms; i++)
    PetscCall(EnclosureFind(cube, &reduced->term[i], low, high, &enclosure[i]));
  PetscCall(ReducedPencil(reduced, p, n, &w.pencil));
  frame->damped = CellIsDamped(reduced, p, enclosure, cube->n);
  PetscCall(FrameAllocate(n, frame->damped ? 2 * n : n, cube->n, &w, frame));
  PetscCall(FrameMatrix(&w, frame->damped, scale));
  PetscCall(FrameEigen(&w, frame, &singular));
  if (!singular) {
    PetscCall(FrameVectors(&w, frame->damped, scale));
    PetscCall(FrameResiduals(&w, frame));
    PetscCall(FrameFill(&w, reduced, enclosure, half, frame));
  } else {
    frame->N = 0;
  }
  PetscCall(DensePencilDestroy(&w.pencil));
  PetscCall(PetscFree3(w.M, w.A, w.pivot));
  PetscCall(PetscFree7(w.X, w.W, w.x, w.G, w.Sx, w.H, w.S));
  PetscCall(PetscFree2(enclosure, p));
  PetscFunctionReturn(0);
}

PetscErrorCode CellFrameDestroy(CellFrame *frame)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree6(frame->value, frame->F, frame->B, frame->rest, frame->shift, frame->influence));
  PetscFunctionReturn(0);
}
