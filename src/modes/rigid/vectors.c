/*
   Vectors of the rigid modes of a damped system, K x = 0. The quadratic eigensolver finds x from [x; lambda x] scaled
   by its largest eigenvalues, which leaves little of it at lambda = 0. So these vectors are found apart, by inverse
   iteration on the undamped problem,

      (K - s M) x' = M x,   s = -(10 scale)^2 far below every elastic mode,

   which reduces what is elastic by |s| / omega^2 each time, and M-orthonormal. Left ones by the transposed problem. The
   two zeros of a rigid mode have one vector: of those that were kept some may be the same. Rounding makes a conjugate
   pair of two zeros, of which one is listed, or two real eigenvalues, so that the number of zeros found says nothing.
   Listed is one for each vector of the null space, first of all.
*/
#include "modes/modesimpl.h"
#include "base/algebra/dense.h"

#define NULL_GOOD     1e-10 /* backward error of an eigensolver's vector that needs nothing */
#define NULL_APART    1e-2  /* least eigenvalue of the Gram matrix of vectors that need nothing */
#define NULL_ENOUGH   1e-14 /* where the iteration ends */
#define NULL_LARGEST  1e-6  /* above it there is no such vector */
#define NULL_MAX_STEP 8

/* Makes x[j] M-orthonormal to those before it, twice for the sake of rounding; work = M x[j] */
static PetscErrorCode NullOrthonormalise(Mat M, PetscInt j, Vec x[], Vec work)
{
  PetscScalar dot;

  PetscFunctionBeginUser;
  for (int pass = 0; pass < 2; pass++)
    for (PetscInt i = 0; i < j; i++) {
      PetscCall(MatMult(M, x[j], work));
      PetscCall(VecDot(work, x[i], &dot));
      PetscCall(VecAXPY(x[j], -dot, x[i]));
    }
  PetscCall(MatMult(M, x[j], work));
  PetscCall(VecDot(work, x[j], &dot));
  PetscCall(VecScale(x[j], 1 / PetscSqrtReal(dot)));
  PetscFunctionReturn(0);
}

/* Largest |K x| / (|K| |x|) of the vectors, or with K' */
static PetscErrorCode NullMeasure(Mat K, PetscBool transposed, PetscInt n, Vec x[], Vec work, PetscReal error[])
{
  PetscReal norm, length, residual;

  PetscFunctionBeginUser;
  PetscCall(MatNorm(K, NORM_FROBENIUS, &norm));
  for (PetscInt j = 0; j < n; j++) {
    if (transposed)
      PetscCall(MatMultTranspose(K, x[j], work));
    else
      PetscCall(MatMult(K, x[j], work));
    PetscCall(VecNorm(work, NORM_2, &residual));
    PetscCall(VecNorm(x[j], NORM_2, &length));
    error[j] = residual / (norm * length);
  }
  PetscFunctionReturn(0);
}

PetscErrorCode NullFactor(Modes modes, const PencilMatrices *pencil, const Window *window)
{
  PetscFunctionBeginUser;
  if (modes->null.ksp) PetscFunctionReturn(0);
  PetscCall(
    ShiftInvertCreate(pencil, -PetscSqr(10 * window->known.scale), PETSC_FALSE, &modes->progress, &modes->null));
  PetscFunctionReturn(0);
}

PetscErrorCode NullForget(Modes modes)
{
  PetscFunctionBeginUser;
  PetscCall(ShiftInvertDestroy(&modes->null));
  PetscCall(VecDestroyVecs(modes->n_null_left, &modes->null_left));
  modes->n_null_left = 0;
  PetscFunctionReturn(0);
}

PetscErrorCode NullIterate(Modes modes, const PencilMatrices *pencil, PetscBool transposed, PetscInt n, Vec x[],
                           PetscReal error[])
{
  PetscReal   worst = PETSC_MAX_REAL;
  PetscRandom random;
  Vec         work;

  PetscFunctionBeginUser;
  PetscCall(VecDuplicate(x[0], &work));
  PetscCall(PetscRandomCreate(modes->comm, &random));
  for (PetscInt j = 0; j < n; j++) PetscCall(VecSetRandom(x[j], random));
  PetscCall(PetscRandomDestroy(&random));
  for (int step = 0; step < NULL_MAX_STEP && worst > NULL_ENOUGH; step++) {
    for (PetscInt j = 0; j < n; j++) {
      if (transposed)
        PetscCall(MatMultTranspose(pencil->M, x[j], work));
      else
        PetscCall(MatMult(pencil->M, x[j], work));
      PetscCall(ShiftInvertSolve(&modes->null, transposed, work, x[j]));
      PetscCall(NullOrthonormalise(pencil->M, j, x, work));
    }
    PetscCall(NullMeasure(pencil->K, transposed, n, x, work, error));
    worst = 0;
    for (PetscInt j = 0; j < n; j++) worst = PetscMax(worst, error[j]);
  }
  PetscCall(VecDestroy(&work));
  PetscFunctionReturn(0);
}

/* Puts the vectors, in the pencil's unknowns, in place of those of the rigid modes, in all unknowns with M-norm one */
static PetscErrorCode NullPut(Modes modes, PetscBool left, Vec x[], Spectrum *s)
{
  PetscReal square;
  Mat       M;
  Vec       work;

  PetscFunctionBeginUser;
  PetscCall(PencilGetMass(modes->pencil, &M));
  PetscCall(MatCreateVecs(M, &work, NULL));
  for (PetscInt i = 0, j = 0; i < modes->n; i++) {
    if (!modes->mode[i].rigid) continue;
    PetscCall(PencilExpand(modes->pencil, left, x[j++], s->xr[i]));
    PetscCall(VecDestroy(&s->xi[i]));
    PetscCall(MatMult(M, s->xr[i], work));
    PetscCall(VecDot(work, s->xr[i], &square));
    PetscCall(VecScale(s->xr[i], 1 / PetscSqrtReal(square)));
  }
  PetscCall(VecDestroy(&work));
  PetscFunctionReturn(0);
}

/* Least eigenvalue of the Gram matrix of the rigid modes' vectors, M-norm one each, n of them */
static PetscErrorCode NullApart(Modes modes, const Spectrum *s, PetscInt n, PetscReal *least)
{
  PetscReal *gram, *w;
  PetscInt   k = 0;
  Mat        M;
  Vec       *x, Mx;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc3(n, &x, n * n, &gram, n, &w));
  PetscCall(PencilGetMass(modes->pencil, &M));
  PetscCall(MatCreateVecs(M, &Mx, NULL));
  for (PetscInt i = 0; i < modes->n; i++)
    if (modes->mode[i].rigid) x[k++] = s->xr[i];
  for (PetscInt j = 0; j < n; j++) {
    PetscCall(MatMult(M, x[j], Mx));
    PetscCall(VecMDot(Mx, n, x, &gram[j * n]));
  }
  PetscCall(DenseSymmetricEigen(n, gram, NULL, w, NULL));
  *least = w[0];
  PetscCall(VecDestroy(&Mx));
  PetscCall(PetscFree3(x, gram, w));
  PetscFunctionReturn(0);
}

/* Whether the vectors of rigid modes, n of them, are good as they are */
static PetscErrorCode NullIsGood(Modes modes, PetscInt *n, PetscBool *good)
{
  PetscReal worst = 0, least = 1, left = 1;

  PetscFunctionBeginUser;
  *n = 0;
  for (PetscInt i = 0; i < modes->n; i++) {
    if (!modes->mode[i].rigid) continue;
    ++*n;
    worst = PetscMax(worst, modes->mode[i].backward_error);
  }
  if (*n > 1 && worst < NULL_GOOD) PetscCall(NullApart(modes, &modes->right, *n, &least));
  if (*n > 1 && worst < NULL_GOOD && modes->left_spectrum.n)
    PetscCall(NullApart(modes, &modes->left_spectrum, *n, &left));
  *good = worst < NULL_GOOD && PetscMin(least, left) > NULL_APART ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(0);
}

/* Lists n rigid modes, first of all: some twice, or less of them than there were */
static PetscErrorCode NullList(Modes modes, PetscInt n)
{
  Spectrum *const side[2] = {&modes->right, &modes->left_spectrum};
  PetscInt        n_rigid = 0, m, *from;
  Mode           *mode;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(modes->n + n, &from, modes->n, &mode));
  PetscCall(PetscArraycpy(mode, modes->mode, modes->n));
  for (PetscInt i = 0; i < modes->n; i++)
    if (mode[i].rigid) from[n_rigid++] = i;
  for (m = n_rigid; m < n; m++) from[m] = from[m % n_rigid];
  m = n;
  for (PetscInt i = 0; i < modes->n; i++)
    if (!mode[i].rigid) from[m++] = i;
  for (int k = 0; k < 2; k++)
    if (side[k]->n) PetscCall(SpectrumTakeFrom(side[k], m, from));
  PetscCall(PetscFree(modes->mode));
  PetscCall(PetscMalloc1(m, &modes->mode));
  for (PetscInt i = 0; i < m; i++) modes->mode[i] = mode[from[i]];
  modes->n = m;
  PetscCall(PetscFree2(from, mode));
  PetscFunctionReturn(0);
}

/* How many of n vectors are of the null space of K, and of K' where there are left ones: motions that nothing
   resists */
static PetscErrorCode NullCount(Modes modes, const PencilMatrices *pencil, PetscInt n, PetscInt *count)
{
  PetscReal *error;
  Vec        like, *x;

  PetscFunctionBeginUser;
  *count = n;
  PetscCall(MatCreateVecs(pencil->K, &like, NULL));
  PetscCall(VecDuplicateVecs(like, n, &x));
  PetscCall(PetscMalloc1(n, &error));
  for (int left = 0; left < (modes->left_spectrum.n ? 2 : 1); left++) {
    PetscInt found = 0;

    PetscCall(NullIterate(modes, pencil, left ? PETSC_TRUE : PETSC_FALSE, n, x, error));
    for (PetscInt j = 0; j < n; j++) found += error[j] < NULL_GOOD;
    *count = PetscMin(*count, found);
  }
  PetscCall(PetscFree(error));
  PetscCall(VecDestroyVecs(n, &x));
  PetscCall(VecDestroy(&like));
  PetscFunctionReturn(0);
}

PetscErrorCode NullVectorsRefine(Modes modes, const PencilMatrices *damped, const Window *window)
{
  const PencilMatrices pencil = {.K = damped->K, .M = damped->M, .symmetric = damped->symmetric};
  PetscInt             n, found = 0;
  PetscBool            good;
  PetscReal           *error;
  Vec                  like, *x;

  PetscFunctionBeginUser;
  PetscCall(NullIsGood(modes, &n, &good));
  if (!n) PetscFunctionReturn(0);
  if (good && n == window->known.rigid) {
    PetscCall(NullList(modes, n));
    PetscFunctionReturn(0);
  }
  PetscCall(NullFactor(modes, &pencil, window));
  if (n < window->known.rigid) PetscCall(NullCount(modes, &pencil, window->known.rigid, &found));
  n = PetscMax(n, found);
  PetscCall(NullList(modes, n));
  PetscCall(MatCreateVecs(pencil.K, &like, NULL));
  PetscCall(VecDuplicateVecs(like, n, &x));
  PetscCall(PetscMalloc1(n, &error));
  if (modes->left_spectrum.n) PetscCall(NullIterate(modes, &pencil, PETSC_TRUE, n, x, error));
  if (modes->left_spectrum.n) PetscCall(NullPut(modes, PETSC_TRUE, x, &modes->left_spectrum));
  PetscCall(NullIterate(modes, &pencil, PETSC_FALSE, n, x, error));
  PetscCall(NullPut(modes, PETSC_FALSE, x, &modes->right));
  for (PetscInt i = 0, j = 0; i < modes->n; i++)
    if (modes->mode[i].rigid) modes->mode[i].backward_error = error[j++];
  for (PetscInt j = 0; j < n; j++)
    PetscCheck(
      error[j] < NULL_LARGEST, modes->comm, PETSC_ERR_NOT_CONVERGED,
      "the vector of a rigid mode has a backward error of %.2g, more than %.0e: leave it out with a -modes_band "
      "above 0",
      (double)error[j], NULL_LARGEST);
  PetscCall(PetscFree(error));
  PetscCall(VecDestroyVecs(n, &x));
  PetscCall(VecDestroy(&like));
  PetscFunctionReturn(0);
}
