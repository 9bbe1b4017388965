/*
   The small response. With S = Z T Z', T quasi-triangular (LAPACK gees), Q^-1 b is the solution of

      undamped   (T - 1/d) y = -(1/d) Z' Q0^-1 b,          d = omega^2 - shift,            one column
      damped     (T - w) y   = -w Z' [0; Q0^-1 b],         w = shift / (i omega - shift),  complex,

   the latter in real arithmetic T Y - Y B = R for the two columns of Y = [re y, im y] with B = [re w, im w; -im w, re
   w]: both are what LAPACK's trsyl solves, at the cost of a product with T. Several frequencies are solved together,
   with their B along the diagonal of a larger one.
*/
#include "schur.h"
#include <slepcblaslapack.h>

/* S into T, and [0; Q0^-1 b], the states being [q; p] there, into b: Q0 = K + g C + g^2 M damped, K - g M undamped
   (g in rad/s or (rad/s)^2), with E added to K where it is to be rounded otherwise. */
static PetscErrorCode SchurForm(const ModesSpace *space, PetscBool rounded, const PetscReal b[], FrfSchur *s)
{
  const PetscReal  square = s->damped ? s->shift * s->shift : -s->shift;
  const PetscReal *E      = space->space.term[SPACE_E(space)].small;
  DensePencil      pencil = SubspacePencil(&space->space);
  PetscReal       *Q, *K;
  PetscBLASInt    *pivot;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc3(s->n * s->n, &Q, s->n * s->n, &K, s->n, &pivot));
  for (PetscInt i = 0; i < s->n * s->n; i++) K[i] = pencil.K[i] + (rounded ? E[i] : 0);
  pencil.K = K;
  PetscCall(DenseCompanion(&pencil, (PetscReal[2]){s->shift, square}, Q, pivot, s->T, NULL));
  PetscCall(PetscArraycpy(&s->b[s->length - s->n], b, s->n));
  PetscCall(DenseSolve(s->n, Q, pivot, PETSC_FALSE, 1, &s->b[s->length - s->n]));
  PetscCall(PetscFree3(Q, K, pivot));
  PetscFunctionReturn(0);
}

/* v := Z' v, work[length] */
static void SchurTurn(PetscInt length, const PetscReal Z[], PetscReal v[], PetscReal work[])
{
  for (PetscInt j = 0; j < length; j++) {
    work[j] = 0;
    for (PetscInt i = 0; i < length; i++) work[j] += Z[j * length + i] * v[i];
  }
  for (PetscInt j = 0; j < length; j++) v[j] = work[j];
}

/* T := Z' T Z quasi-triangular */
static PetscErrorCode SchurReduce(FrfSchur *s, PetscReal Z[])
{
  PetscBLASInt n, n_work, none, info;
  PetscReal   *wr, *wi, *work;

  PetscFunctionBeginUser;
  PetscCall(PetscBLASIntCast(s->length, &n));
  PetscCall(PetscBLASIntCast(66 * s->length + 64, &n_work)); /* blocks of 64 columns */
  PetscCall(PetscMalloc3(s->length, &wr, s->length, &wi, n_work, &work));
  PetscCallBLAS("LAPACKgees",
                LAPACKgees_("V", "N", NULL, &n, s->T, &n, &none, wr, wi, Z, &n, work, &n_work, NULL, &info));
  PetscCheck(!info, PETSC_COMM_SELF, PETSC_ERR_NOT_CONVERGED, "LAPACK gees: info %d", (int)info);
  PetscCall(PetscFree3(wr, wi, work));
  PetscFunctionReturn(0);
}

/* The Schur form is made once, 25 n^3 operations of `length` n; each frequency then costs n^2. Force and outputs
   are turned by Z: l' Z (T - ...)^-1 Z' b. */
PetscErrorCode FrfSchurCreate(const ModesSpace *space, PetscBool rounded, PetscReal shift, const FrfEnds *ends,
                              FrfSchur *s)
{
  const PetscInt n = space->space.n;
  PetscReal     *Z;

  PetscFunctionBeginUser;
  *s = (FrfSchur){
    .n = n, .shift = shift, .n_outputs = ends->n_outputs, .damped = space->pencil.C ? PETSC_TRUE : PETSC_FALSE};
  if (space->pencil.n_laws) {
    PetscCall(FrfLawsCreate(space, rounded, ends, &s->laws));
    PetscFunctionReturn(0);
  }
  s->length = s->damped ? 2 * n : n;
  PetscCall(PetscCalloc1(s->length * s->length, &s->T));
  PetscCall(PetscCalloc4(s->length, &s->b, ends->n_outputs * s->length, &s->l, 2 * FRF_BATCH * s->length, &s->x,
                         4 * FRF_BATCH * FRF_BATCH, &s->B));
  PetscCall(PetscMalloc1(s->length * s->length, &Z));
  PetscCall(SchurForm(space, rounded, ends->b, s));
  PetscCall(SchurReduce(s, Z));
  SchurTurn(s->length, Z, s->b, s->x);
  for (PetscInt p = 0; p < ends->n_outputs; p++) {
    PetscCall(PetscArraycpy(&s->l[p * s->length + s->length - n], &ends->l[p * n], n));
    SchurTurn(s->length, Z, &s->l[p * s->length], s->x);
  }
  PetscCall(PetscFree(Z));
  PetscFunctionReturn(0);
}

/* Solves T X - X B = R, X in place of R, for the m columns of X: n^2 operations each. info > 0, or a scale of zero,
   means that T and B share an eigenvalue: a pole. */
static PetscErrorCode SchurSolve(const FrfSchur *s, PetscInt m, PetscBool *singular)
{
  const PetscBLASInt minus = -1;
  PetscBLASInt       n, n_columns, info;
  PetscReal          scale;

  PetscFunctionBeginUser;
  PetscCall(PetscBLASIntCast(s->length, &n));
  PetscCall(PetscBLASIntCast(m, &n_columns));
  PetscCallBLAS("LAPACKtrsyl",
                LAPACKtrsyl_("N", "N", &minus, &n, &n_columns, s->T, &n, s->B, &n_columns, s->x, &n, &scale, &info));
  PetscCheck(info >= 0, PETSC_COMM_SELF, PETSC_ERR_LIB, "LAPACK trsyl: info %d", (int)info);
  *singular = info > 0 || scale == 0 ? PETSC_TRUE : PETSC_FALSE;
  for (PetscInt i = 0; i < m * s->length && !*singular; i++) s->x[i] /= scale;
  PetscFunctionReturn(0);
}

/* B and the right-hand sides of n frequencies; false where one of them is the shift itself */
static PetscBool SchurFill(const FrfSchur *s, PetscInt n, const PetscReal omega[])
{
  const PetscInt two = s->damped ? 2 : 1, m = two * n;

  for (PetscInt i = 0; i < m * m; i++) s->B[i] = 0;
  for (PetscInt f = 0; f < n; f++) {
    const PetscReal    d = omega[f] * omega[f] - s->shift;
    const PetscComplex w = s->damped ? s->shift / CMPLX(-s->shift, omega[f]) : 1 / d;
    PetscReal         *B = &s->B[two * f * (m + 1)], *x = &s->x[two * f * s->length];

    if (!s->damped && d == 0) return PETSC_FALSE;
    B[0] = creal(w);
    if (s->damped) B[1] = -cimag(w), B[m] = cimag(w), B[m + 1] = creal(w); /* column-major */
    for (PetscInt i = 0; i < s->length; i++) x[i] = -creal(w) * s->b[i];
    for (PetscInt i = 0; i < s->length && s->damped; i++) x[s->length + i] = -cimag(w) * s->b[i];
  }
  return PETSC_TRUE;
}

/* H at n frequencies from their one or two columns of X */
static void SchurOutputs(const FrfSchur *s, PetscInt n, PetscReal re[], PetscReal im[])
{
  const PetscInt two = s->damped ? 2 : 1;

  for (PetscInt f = 0; f < n; f++)
    for (PetscInt p = 0; p < s->n_outputs; p++) {
      const PetscReal *l = &s->l[p * s->length], *x = &s->x[two * f * s->length], *y = x + s->length;
      PetscReal        sum[2] = {0, 0};

      for (PetscInt i = 0; i < s->length; i++) sum[0] += l[i] * x[i];
      for (PetscInt i = 0; i < s->length && s->damped; i++) sum[1] += l[i] * y[i];
      re[f * s->n_outputs + p] = sum[0];
      im[f * s->n_outputs + p] = sum[1];
    }
}

/* A batch in which one frequency is singular is solved again one by one, to tell which. */
PetscErrorCode FrfSchurRespond(const FrfSchur *s, PetscInt n, const PetscReal omega[], PetscReal re[], PetscReal im[],
                               PetscInt *pole)
{
  PetscBool singular = PETSC_FALSE, regular;

  PetscFunctionBeginUser;
  *pole = -1;
  for (PetscInt f = 0; f < n && s->laws.pencil.n_laws; f++) {
    PetscCall(
      FrfLawsRespond(&s->laws, omega[f], s->n_outputs, &re[f * s->n_outputs], &im[f * s->n_outputs], &singular));
    if (singular) *pole = f;
  }
  if (s->laws.pencil.n_laws) PetscFunctionReturn(0);
  regular = SchurFill(s, n, omega);
  if (regular) PetscCall(SchurSolve(s, s->damped ? 2 * n : n, &singular));
  if (n > 1 && (singular || !regular)) {
    for (PetscInt f = 0; f < n; f++) {
      PetscInt one;

      PetscCall(FrfSchurRespond(s, 1, &omega[f], &re[f * s->n_outputs], &im[f * s->n_outputs], &one));
      if (one == 0) *pole = f;
    }
    PetscFunctionReturn(0);
  }
  if (!regular) PetscCall(PetscArraycpy(s->x, s->b, s->length)); /* at the shift the answer is Q0^-1 b */
  if (singular) *pole = 0;
  SchurOutputs(s, n, re, im);
  PetscFunctionReturn(0);
}

PetscErrorCode FrfSchurDestroy(FrfSchur *s)
{
  PetscFunctionBeginUser;
  if (s->laws.pencil.n_laws) PetscCall(FrfLawsDestroy(&s->laws));
  PetscCall(PetscFree(s->T));
  PetscCall(PetscFree4(s->b, s->l, s->x, s->B));
  PetscFunctionReturn(0);
}
