/*
   Modes of one point as a biorthogonal system. With the standard form A z = s B z (dense/standard.c) w^T B z is, when
   the two eigenvalues agree, twice the product with D = M + C / (2 lambda) over the scale, and exactly zero between
   different modes of one point. With w^T B z = 1 the product C_ij of the modes of two points is the coefficient of
   mode j of the one in the expansion by the modes i of the other.

   Modes of equal eigenvalues (within 1e-6, or within their errors) and pairs lambda, -conj(lambda) of an undamped
   system form a cluster. Their vectors are replaced by any basis of their plane and its dual: what is computed from the
   plane, sum_ij C_ij C'_ji = tr(P Q) with the spectral projectors P, Q, neither depends on the basis nor suffers from
   nearly parallel vectors at lock-in.
*/
#include "frame.h"

#define CLOSE     1e-6 /* relative difference of eigenvalues of one cluster */
#define CONJUGATE 1e-7 /* relative difference of frequencies of a pair */

/* The mode at -conj(lambda) within CONJUGATE |lambda|, or -1; with damping, or for lambda on an axis, there is
   none. */
PetscInt ModeFramePartner(const ModeFrame *f, PetscInt i)
{
  const PetscComplex lambda = f->modes.lambda[i];
  PetscInt           best   = -1;
  PetscReal          least  = CONJUGATE * cabs(lambda);

  if (f->form.damped || creal(lambda) == 0 || cimag(lambda) == 0) return -1;
  for (PetscInt j = 0; j < f->modes.n; j++) {
    const PetscReal distance = cabs(f->modes.lambda[j] + conj(lambda));

    if (j != i && distance <= least) best = j, least = distance;
  }
  return best;
}

/* Whether the vectors of modes i and j mean nothing one by one: closer than CLOSE |lambda|, or than both errors,
   rad/s, together. */
static PetscBool ModesAreClose(const ReducedModes *modes, PetscInt i, PetscInt j)
{
  const PetscReal distance = cabs(modes->lambda[i] - modes->lambda[j]);

  return distance <= CLOSE * cabs(modes->lambda[i]) + modes->error[i] + modes->error[j] ? PETSC_TRUE : PETSC_FALSE;
}

/* cluster[i] = first mode of that of mode i; membership is transitive. */
static void FrameCluster(ModeFrame *f)
{
  for (PetscInt i = 0; i < f->modes.n; i++) f->cluster[i] = i;
  for (PetscInt i = 0; i < f->modes.n; i++) {
    const PetscInt partner = ModeFramePartner(f, i);

    if (partner >= 0) ReducedClusterJoin(f->modes.n, i, partner, f->cluster);
    for (PetscInt j = i + 1; j < f->modes.n; j++)
      if (ModesAreClose(&f->modes, i, j)) ReducedClusterJoin(f->modes.n, i, j, f->cluster);
  }
}

/* z of x; a rigid mode of a damped system is a double zero, of which [x; 0] is one vector and [0; y], from the left,
   the dual of it with respect to B */
static void FrameVector(const ModeFrame *f, const PetscComplex x[], PetscInt i, PetscBool left, PetscComplex z[])
{
  const PetscInt n = f->form.n;

  StandardVector(&f->form, f->modes.lambda[i], x, z);
  for (PetscInt k = 0; k < n && f->form.damped && left && f->modes.rigid[i]; k++) z[n + k] = x[k], z[k] = 0;
}

/* Bases of the plane of k modes of an undamped system */
static PetscErrorCode ClusterRefine(ModeFrame *f, PetscInt k, const PetscInt member[])
{
  PetscReal *X, *Y;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(k * f->N, &X, k * f->N, &Y));
  PetscCall(ModePlaneRefine(f, k, member, X, Y));
  for (PetscInt a = 0; a < k; a++)
    for (PetscInt r = 0; r < f->N; r++) {
      f->X[member[a] * f->N + r] = X[a * f->N + r];
      f->Y[member[a] * f->N + r] = Y[a * f->N + r];
    }
  PetscCall(PetscFree2(X, Y));
  PetscFunctionReturn(0);
}

/* Orthonormal basis of the plane of k modes of a damped system, in place in Z (X or Y) */
static PetscErrorCode ClusterOrthonormalise(ModeFrame *f, PetscInt k, const PetscInt member[], PetscComplex Z[])
{
  PetscComplex *plane;
  PetscInt      kept;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(k * f->N, &plane));
  for (PetscInt a = 0; a < k; a++) PetscCall(PetscArraycpy(plane + a * f->N, Z + member[a] * f->N, f->N));
  PetscCall(DenseOrthonormalise(f->N, k, FRAME_PARALLEL, plane, &kept));
  for (PetscInt a = 0; a < k; a++) PetscCall(PetscArraycpy(Z + member[a] * f->N, plane + a * f->N, f->N));
  PetscCall(PetscFree(plane));
  PetscFunctionReturn(0);
}

/* Row operations that make the Gram matrix W^T X of the cluster the identity: Gauss-Jordan with pivoting on the rows of
   W and Y. A plane that is defective beyond the cluster leaves zero rows, which match nothing. */
static PetscErrorCode ClusterDualise(ModeFrame *f, PetscInt k, const PetscInt member[])
{
  const PetscInt N = f->N;

  PetscFunctionBeginUser;
  for (PetscInt a = 0; a < k; a++) {
    PetscComplex *const Xa = f->X + member[a] * N, *const Wa = f->W + member[a] * N, *const Ya = f->Y + member[a] * N;
    PetscInt     pivot   = a;
    PetscReal    largest = 0;
    PetscComplex g;

    for (PetscInt b = a; b < k; b++) {
      const PetscReal size = cabs(DenseDot(N, f->W + member[b] * N, Xa));

      if (size > largest) largest = size, pivot = b;
    }
    for (PetscInt r = 0; r < N && pivot != a; r++) {
      PetscComplex *const Wp = f->W + member[pivot] * N, *const Yp = f->Y + member[pivot] * N;
      const PetscComplex w = Wa[r], y = Ya[r];

      Wa[r] = Wp[r], Ya[r] = Yp[r], Wp[r] = w, Yp[r] = y;
    }
    g = DenseDot(N, Wa, Xa);
    for (PetscInt r = 0; r < N; r++) {
      Wa[r] = largest > 0 ? Wa[r] / g : 0;
      Ya[r] = largest > 0 ? Ya[r] / g : 0;
    }
    for (PetscInt b = 0; b < k; b++) {
      PetscComplex *const Wb = f->W + member[b] * N, *const Yb = f->Y + member[b] * N;
      const PetscComplex c = b == a ? 0 : DenseDot(N, Wb, Xa);

      for (PetscInt r = 0; r < N; r++) Wb[r] -= c * Wa[r], Yb[r] -= c * Ya[r];
    }
  }
  PetscFunctionReturn(0);
}

/* Bases of the plane of the cluster that begins with mode first, or, with W known, their duals */
static PetscErrorCode ClusterBases(ModeFrame *f, PetscBool dual, PetscInt first)
{
  PetscInt *member, k = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(f->modes.n, &member));
  for (PetscInt i = first; i < f->modes.n; i++)
    if (f->cluster[i] == first) member[k++] = i;
  if (dual) {
    PetscCall(ClusterDualise(f, k, member));
  } else if (k > 1 && !f->form.damped) {
    PetscCall(ClusterRefine(f, k, member));
  } else if (k > 1 && !f->modes.rigid[first]) {
    PetscCall(ClusterOrthonormalise(f, k, member, f->X));
    PetscCall(ClusterOrthonormalise(f, k, member, f->Y));
  }
  PetscCall(PetscFree(member));
  PetscFunctionReturn(0);
}

/* A copy of the modes with X, Y, W [n][N] in the standard form: W = B^T Y, and w_i^T x_j = 1 for i = j, else 0
   within clusters by construction and between them by the eigenproblem. branch = -1. FRAME_REFINED: planes are improved
   by inverse iteration (onset/plane.c). */
PetscErrorCode ModeFrameCreate(const Reduced *reduced, const PetscReal p[], const StandardForm *form, FrameUse use,
                               const ReducedModes *modes, ModeFrame **frame)
{
  const PetscInt n = modes->n, size = reduced->n_used;
  ModeFrame     *f;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&f));
  f->refine  = use == FRAME_REFINED ? PETSC_TRUE : PETSC_FALSE;
  f->limit   = reduced->limit;
  f->reduced = reduced;
  PetscCall(PetscMalloc1(reduced->n_parameters, &f->p));
  PetscCall(PetscArraycpy(f->p, p, reduced->n_parameters));
  f->form = (StandardForm){&f->pencil, size, form->damped, form->scale};
  f->N    = StandardSize(&f->form);
  PetscCall(ReducedModesSelect(modes, n, NULL, &f->modes));
  if (use == FRAME_PRODUCTS)
    PetscCall(ReducedPencilLoose(reduced, p, size, &f->pencil));
  else
    PetscCall(ReducedPencil(reduced, p, size, &f->pencil));
  PetscCall(PetscMalloc5(n, &f->cluster, n, &f->branch, n * f->N, &f->X, n * f->N, &f->Y, n * f->N, &f->W));
  FrameCluster(f);
  for (PetscInt i = 0; i < n; i++) {
    f->branch[i] = -1;
    FrameVector(f, f->modes.x + i * size, i, PETSC_FALSE, f->X + i * f->N);
    FrameVector(f, f->modes.y + i * size, i, PETSC_TRUE, f->Y + i * f->N);
  }
  for (int dual = 0; dual < 2; dual++) {
    if (dual) PetscCall(StandardApply(&f->form, STANDARD_B, PETSC_TRUE, n, f->Y, f->W));
    for (PetscInt i = 0; i < n; i++)
      if (f->cluster[i] == i) PetscCall(ClusterBases(f, dual ? PETSC_TRUE : PETSC_FALSE, i));
  }
  *frame = f;
  PetscFunctionReturn(0);
}

PetscBool ModeFrameIsUnstable(const ModeFrame *frame, PetscInt i)
{
  const PetscComplex lambda = frame->modes.lambda[i];

  return ModesLimitIsExceeded(&frame->limit, creal(lambda), cimag(lambda), frame->modes.error[i]);
}

PetscErrorCode ModeFrameDestroy(ModeFrame **frame)
{
  ModeFrame *f = *frame;

  PetscFunctionBeginUser;
  if (!f) PetscFunctionReturn(0);
  PetscCall(ReducedModesDestroy(&f->modes));
  PetscCall(DensePencilDestroy(&f->pencil));
  PetscCall(PetscFree(f->p));
  PetscCall(PetscFree5(f->cluster, f->branch, f->X, f->Y, f->W));
  PetscCall(PetscFree(*frame));
  PetscFunctionReturn(0);
}

PetscInt ModeFrameClusterSize(const ModeFrame *f, PetscInt i)
{
  PetscInt size = 0;

  for (PetscInt k = 0; k < f->modes.n; k++) size += f->cluster[k] == f->cluster[i];
  return size;
}

/* sum [cluster] += sum over its modes j of (w^T x_j) (w_j^T x): the coefficient of (w, x) in itself by way of the
   cluster. */
void ModeFrameOverlap(const ModeFrame *f, const PetscComplex w[], const PetscComplex x[], PetscComplex sum[])
{
  for (PetscInt j = 0; j < f->modes.n; j++)
    sum[f->cluster[j]] += DenseDot(f->N, w, f->X + j * f->N) * DenseDot(f->N, f->W + j * f->N, x);
}
