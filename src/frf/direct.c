/*
   The whole system at each frequency, in real arithmetic: without damping (K - omega^2 M) u = f, else with u = v + i w

      [ K - omega^2 M     -omega C    ] [v]   [f]
      [ -omega C      omega^2 M - K ] [w] = [0],

   symmetric where K, C, M are. The error is what the residual of the factorisation makes of the outputs,
   e_p = z_p^T (f - Q u) with Q^T z_p = l_p, and rounding in K: eps sum_i |z_i| K_ii |u_i|.
*/
#include "frfimpl.h"

/* Relative error from which on a frequency is a pole: fewer than three digits are left. */
#define DIRECT_POLE 1e-3

/* The system of one frequency: A of `parts` blocks of the pencil's unknowns */
typedef struct {
  PetscInt       parts;
  PencilMatrices matrices; /* K = A, so that the shift is zero; no C */
  ShiftInvert    factor;
  Vec            b, u, r, diagonal; /* of A's size */
  Vec           *l, *z;             /* [outputs] of A's size */
} Direct;

/* Puts a vector of the pencil into the first block of one of the system */
static PetscErrorCode DirectInsert(Vec from, Vec to)
{
  const PetscScalar *a;
  PetscScalar       *b;
  PetscInt           n;

  PetscFunctionBeginUser;
  PetscCall(VecSet(to, 0));
  PetscCall(VecGetLocalSize(from, &n));
  PetscCall(VecGetArrayRead(from, &a));
  PetscCall(VecGetArray(to, &b));
  PetscCall(PetscArraycpy(b, a, n));
  PetscCall(VecRestoreArray(to, &b));
  PetscCall(VecRestoreArrayRead(from, &a));
  PetscFunctionReturn(0);
}

/* -omega C - sum_l Im h_l A_l, the laws of materials */
static PetscErrorCode DirectLoss(const PencilMatrices *pencil, PetscReal omega, Mat *loss)
{
  PetscFunctionBeginUser;
  PetscCall(MatDuplicate(pencil->C ? pencil->C : pencil->law[0].A, MAT_COPY_VALUES, loss));
  PetscCall(MatScale(*loss, pencil->C ? -omega : 0));
  for (PetscInt l = 0; l < pencil->n_laws; l++)
    PetscCall(MatAXPY(*loss, -cimag(PencilLawAt(&pencil->law[l], CMPLX(0, omega), NULL)), pencil->law[l].A,
                      DIFFERENT_NONZERO_PATTERN));
  PetscFunctionReturn(0);
}

/* A at omega, rad/s: [A0, -omega C; -omega C, -A0], A0 = K - omega^2 M, or A0 alone. Both off-diagonal blocks are
   one matrix. MatConvert() interleaves the rows of both blocks by rank, as DirectInsert() has the vectors: each
   rank's v, then its w. */
static PetscErrorCode DirectMatrix(const PencilMatrices *pencil, PetscReal omega, Mat *A)
{
  const PetscBool real = pencil->C || pencil->n_laws ? PETSC_FALSE : PETSC_TRUE;
  Mat             block[4];

  PetscFunctionBeginUser;
  PetscCall(MatDuplicate(pencil->K, MAT_COPY_VALUES, &block[0]));
  PetscCall(MatAXPY(block[0], -omega * omega, pencil->M, DIFFERENT_NONZERO_PATTERN));
  for (PetscInt l = 0; l < pencil->n_laws; l++)
    PetscCall(MatAXPY(block[0], creal(PencilLawAt(&pencil->law[l], CMPLX(0, omega), NULL)), pencil->law[l].A,
                      DIFFERENT_NONZERO_PATTERN));
  if (real) {
    *A = block[0];
    PetscFunctionReturn(0);
  }
  PetscCall(MatDuplicate(block[0], MAT_COPY_VALUES, &block[3]));
  PetscCall(MatScale(block[3], -1));
  PetscCall(DirectLoss(pencil, omega, &block[1]));
  block[2] = block[1];
  PetscCall(MatCreateNest(PetscObjectComm((PetscObject)pencil->K), 2, NULL, 2, NULL, block, A));
  PetscCall(MatConvert(*A, MATAIJ, MAT_INPLACE_MATRIX, A));
  for (int i = 0; i < 4; i++)
    if (i != 2) PetscCall(MatDestroy(&block[i]));
  PetscFunctionReturn(0);
}

/* What all frequencies share */
static PetscErrorCode DirectCreate(Frf frf, const PencilMatrices *pencil, Direct *d)
{
  Vec      b, *l;
  PetscInt n;

  PetscFunctionBeginUser;
  d->parts = pencil->C || pencil->n_laws ? 2 : 1;
  PetscCall(FrfProject(frf, &b, &l));
  PetscCall(VecGetLocalSize(b, &n));
  PetscCall(VecCreateMPI(frf->comm, d->parts * n, PETSC_DETERMINE, &d->b));
  PetscCall(VecDuplicate(d->b, &d->u));
  PetscCall(VecDuplicate(d->b, &d->r));
  PetscCall(VecDuplicate(d->b, &d->diagonal));
  PetscCall(VecDuplicateVecs(d->b, frf->n_outputs, &d->l));
  PetscCall(VecDuplicateVecs(d->b, frf->n_outputs, &d->z));
  PetscCall(DirectInsert(b, d->b));
  for (PetscInt p = 0; p < frf->n_outputs; p++) PetscCall(DirectInsert(l[p], d->l[p]));
  PetscCall(VecDestroy(&b));
  PetscCall(VecDestroyVecs(frf->n_outputs, &l));
  PetscFunctionReturn(0);
}

/* Exchanges the blocks of u, (v, w) -> (w, v), so that l^T of it is the imaginary part, l being zero in the second
   block. */
static PetscErrorCode DirectExchange(Vec u)
{
  PetscScalar *a;
  PetscInt     n;

  PetscFunctionBeginUser;
  PetscCall(VecGetLocalSize(u, &n));
  PetscCall(VecGetArray(u, &a));
  for (PetscInt i = 0; i < n / 2; i++) {
    const PetscScalar v = a[i];

    a[i]         = a[n / 2 + i];
    a[n / 2 + i] = v;
  }
  PetscCall(VecRestoreArray(u, &a));
  PetscFunctionReturn(0);
}

/* What residual r = b - A u and rounding make of an output, m/N: |z^T r| + eps sum_i |z_i A_ii u_i|. */
static PetscErrorCode DirectError(Direct *d, Vec z, PetscReal *error)
{
  PetscReal residual, noise;
  Vec       work;

  PetscFunctionBeginUser;
  PetscCall(VecDot(z, d->r, &residual));
  PetscCall(VecDuplicate(z, &work));
  PetscCall(VecPointwiseMult(work, z, d->u));
  PetscCall(VecPointwiseMult(work, work, d->diagonal));
  PetscCall(VecNorm(work, NORM_1, &noise));
  PetscCall(VecDestroy(&work));
  *error = PetscAbsReal(residual) + PETSC_MACHINE_EPSILON * noise;
  PetscFunctionReturn(0);
}

/* What the force radiates: u of all unknowns, from the first block and the second */
static PetscErrorCode DirectHear(Frf frf, Direct *d, PetscInt i)
{
  PencilMatrices     pencil;
  Vec                part[2] = {NULL, NULL};
  const PetscScalar *u;
  PetscScalar       *to;
  PetscInt           n;

  PetscFunctionBeginUser;
  PetscCall(PencilGetMatrices(frf->pencil, &pencil));
  PetscCall(VecGetArrayRead(d->u, &u));
  for (PetscInt k = 0; k < d->parts; k++) {
    PetscCall(MatCreateVecs(pencil.K, &part[k], NULL));
    PetscCall(VecGetLocalSize(part[k], &n));
    PetscCall(VecGetArrayWrite(part[k], &to));
    PetscCall(PetscArraycpy(to, &u[k * n], n));
    PetscCall(VecRestoreArrayWrite(part[k], &to));
  }
  PetscCall(VecRestoreArrayRead(d->u, &u));
  PetscCall(FrfHear(frf, i, 0, part[0], part[1]));
  for (int k = 0; k < 2; k++) PetscCall(VecDestroy(&part[k]));
  PetscFunctionReturn(0);
}

/* Solves for the force and for every output, and measures the error: the root of the sum of squares over the
   outputs. One factorisation, 1 + n_outputs solves. */
static PetscErrorCode DirectRespond(Frf frf, Direct *d, PetscInt i)
{
  const PetscInt n = frf->n_outputs;
  PetscReal      error;

  PetscFunctionBeginUser;
  PetscCall(ShiftInvertSolve(&d->factor, PETSC_FALSE, d->b, d->u));
  PetscCall(MatMult(d->matrices.K, d->u, d->r));
  PetscCall(VecAYPX(d->r, -1, d->b));
  PetscCall(VecMDot(d->u, n, d->l, &frf->re[i * n]));
  for (PetscInt p = 0; p < n; p++) {
    PetscCall(ShiftInvertSolve(&d->factor, PETSC_TRUE, d->l[p], d->z[p]));
    PetscCall(DirectError(d, d->z[p], &error));
    frf->error[i] = hypot(frf->error[i], error);
  }
  if (FrfHears(frf)) PetscCall(DirectHear(frf, d, i));
  if (d->parts == 2) {
    PetscCall(DirectExchange(d->u));
    PetscCall(VecMDot(d->u, n, d->l, &frf->im[i * n]));
  }
  PetscFunctionReturn(0);
}

/* One frequency */
static PetscErrorCode DirectSolve(Frf frf, const PencilMatrices *pencil, Direct *d, PetscInt i)
{
  const PetscReal omega = 2 * PETSC_PI * frf->freq[i];

  PetscFunctionBeginUser;
  PetscCall(DirectMatrix(pencil, omega, &d->matrices.K));
  d->matrices.M         = d->matrices.K;
  d->matrices.symmetric = pencil->symmetric;
  PetscCall(MatGetDiagonal(d->matrices.K, d->diagonal));
  PetscCall(ShiftInvertCreate(&d->matrices, 0, PETSC_FALSE, &frf->progress, &d->factor));
  PetscCall(DirectRespond(frf, d, i));
  PetscCheck(frf->error[i] < DIRECT_POLE * FrfMagnitude(frf, i), frf->comm, PETSC_ERR_USER_INPUT,
             "-frf_frequencies: %.15g Hz is a pole to rounding, where the response is infinite; move the frequency, or "
             "give damping",
             (double)frf->freq[i]);
  PetscCall(ShiftInvertDestroy(&d->factor));
  PetscCall(MatDestroy(&d->matrices.K));
  PetscFunctionReturn(0);
}

PetscErrorCode FrfSolveDirect(Frf frf)
{
  PencilMatrices pencil;
  PetscInt       n_kept;
  Direct         d = {0};

  PetscFunctionBeginUser;
  PetscCall(PencilGetMatrices(frf->pencil, &pencil));
  PetscCall(DirectCreate(frf, &pencil, &d));
  PetscCall(FrfResume(frf, &n_kept));
  PetscCall(ProgressBegin(&frf->progress, "frequencies", frf->n - n_kept));
  for (PetscInt i = n_kept; i < frf->n; i++) {
    PetscCall(DirectSolve(frf, &pencil, &d, i));
    PetscCall(FrfKeep(frf, i + 1));
    PetscCall(ProgressStep(&frf->progress));
  }
  PetscCall(ProgressEnd(&frf->progress));
  PetscCall(VecDestroy(&d.b));
  PetscCall(VecDestroy(&d.u));
  PetscCall(VecDestroy(&d.r));
  PetscCall(VecDestroy(&d.diagonal));
  PetscCall(VecDestroyVecs(frf->n_outputs, &d.l));
  PetscCall(VecDestroyVecs(frf->n_outputs, &d.z));
  PetscCall(FrfFindPeaks(frf, NULL));
  PetscFunctionReturn(0);
}
