/*
   Errors of each eigenvalue from right (x) and left (y, y^T Q(lambda) = 0) vectors; Q and D as in complexvec.h:

      backward error   |Q x| / ((|lambda|^2 |M| + |lambda| |C| + |K|) |x|)
      condition        |x|_M |y|_M / |y^T D x|
      error            |y^T Q x| / |y^T Q' x|, first order in the residual, but not below what rounding in K does
   (F. Tisseur, Lin. Alg. Appl. 309, 2000, for the quadratic problem.)
*/
#include "complexvec.h"

#define RIGID_NOISE 100 /* lambda^2 below this many times its error is a rigid mode */

/* Norm sqrt(x^H M x) of a vector of all unknowns, and scales it to one */
static PetscErrorCode NormaliseM(Mat M, ComplexVec x, Vec work, PetscReal *norm)
{
  PetscReal square, part = 0;

  PetscFunctionBeginUser;
  PetscCall(MatMult(M, x.r, work));
  PetscCall(VecDot(x.r, work, &square));
  if (x.i) {
    PetscCall(MatMult(M, x.i, work));
    PetscCall(VecDot(x.i, work, &part));
  }
  *norm = PetscSqrtReal(square + part);
  PetscCall(VecScale(x.r, 1 / *norm));
  if (x.i) PetscCall(VecScale(x.i, 1 / *norm));
  PetscFunctionReturn(0);
}

/* Expands a vector of the pencil to all unknowns in place */
static PetscErrorCode Expand(Operators operators, PetscBool left, Vec *x)
{
  Vec u;

  PetscFunctionBeginUser;
  if (!*x) PetscFunctionReturn(0);
  PetscCall(OperatorsCreateVec(operators, &u));
  PetscCall(OperatorsExpand(operators, left, *x, u));
  PetscCall(VecDestroy(x));
  *x = u;
  PetscFunctionReturn(0);
}

/* Frobenius norms of K, C, M */
static PetscErrorCode PencilNorms(const OperatorsPencil *pencil, PetscReal norms[3])
{
  PetscFunctionBeginUser;
  norms[1] = 0;
  PetscCall(MatNorm(pencil->K, NORM_FROBENIUS, &norms[0]));
  if (pencil->C) PetscCall(MatNorm(pencil->C, NORM_FROBENIUS, &norms[1]));
  PetscCall(MatNorm(pencil->M, NORM_FROBENIUS, &norms[2]));
  PetscFunctionReturn(0);
}

/* What rounding in K does to x'K x: machine epsilon times the energy without cancellation, sum_i K_ii |x_i|^2 */
static PetscErrorCode RoundingNoise(ComplexVec x, Vec diagonal, Vec work, PetscReal *noise)
{
  PetscReal part = 0;

  PetscFunctionBeginUser;
  PetscCall(VecPointwiseMult(work, x.r, diagonal));
  PetscCall(VecDot(work, x.r, noise));
  if (x.i) {
    PetscCall(VecPointwiseMult(work, x.i, diagonal));
    PetscCall(VecDot(work, x.i, &part));
  }
  *noise = PETSC_MACHINE_EPSILON * (*noise + part);
  PetscFunctionReturn(0);
}

/* Backward error of mode i, |y^T Q x| and |y^T D x| in the unknowns of the pencil; y_Dx is not touched without left vectors */
static PetscErrorCode MeasureResidual(Modes modes, const OperatorsPencil *pencil, PetscInt i, const PetscReal norms[3], Vec work[4], Mode *mode,
                                      PetscReal *y_Qx, PetscReal *y_Dx, PetscReal *noise)
{
  const Spectrum    *right = &modes->right, *left = &modes->left_spectrum;
  const PetscComplex lambda = SpectrumLambda(right, i);
  const ComplexVec         x = {right->xr[i], right->xi[i]}, z = {work[1], work[2]};
  PetscReal          size, part, residual, bound;
  PetscComplex       dot;

  PetscFunctionBeginUser;
  PetscCall(PencilApplyQ(pencil, lambda, x, work[0], z));
  PetscCall(VecNorm(x.r, NORM_2, &size));
  if (x.i) PetscCall(VecNorm(x.i, NORM_2, &part));
  if (x.i) size = PetscSqrtReal(size * size + part * part);
  PetscCall(VecNorm(z.r, NORM_2, &residual));
  PetscCall(VecNorm(z.i, NORM_2, &part));
  residual             = PetscSqrtReal(residual * residual + part * part);
  bound                = cabs(lambda) * cabs(lambda) * norms[2] + cabs(lambda) * norms[1] + norms[0];
  mode->backward_error = residual / (bound * size);
  PetscCall(RoundingNoise(x, work[3], work[0], noise));
  if (!left->n) PetscFunctionReturn(0);
  PetscCall(ComplexVecDot((ComplexVec){left->xr[i], left->xi[i]}, z, &dot));
  *y_Qx = cabs(dot);
  PetscCall(PencilApplyD(pencil, lambda, x, work[0], z));
  PetscCall(ComplexVecDot((ComplexVec){left->xr[i], left->xi[i]}, z, &dot));
  *y_Dx = cabs(dot);
  PetscFunctionReturn(0);
}

/* Condition, error, and what follows from them; the vectors become vectors of all unknowns with M-norm one */
static PetscErrorCode MeasureMode(Modes modes, const OperatorsPencil *pencil, Mat M, PetscInt i, const PetscReal norms[3], Vec work[4], Vec full)
{
  Spectrum       *right = &modes->right, *left = &modes->left_spectrum;
  Mode           *mode  = &modes->mode[i];
  const PetscReal size  = cabs(SpectrumLambda(right, i));
  PetscReal       y_Qx = 0, y_Dx = 1, norm_x, norm_y = 1, noise, kappa;

  PetscFunctionBeginUser;
  PetscCall(MeasureResidual(modes, pencil, i, norms, work, mode, &y_Qx, &y_Dx, &noise));
  PetscCall(Expand(modes->operators, PETSC_FALSE, &right->xr[i]));
  PetscCall(Expand(modes->operators, PETSC_FALSE, &right->xi[i]));
  PetscCall(NormaliseM(M, (ComplexVec){right->xr[i], right->xi[i]}, full, &norm_x));
  if (left->n) {
    PetscCall(Expand(modes->operators, PETSC_TRUE, &left->xr[i]));
    PetscCall(Expand(modes->operators, PETSC_TRUE, &left->xi[i]));
    PetscCall(NormaliseM(M, (ComplexVec){left->xr[i], left->xi[i]}, full, &norm_y));
  }
  mode->sigma     = right->sigma[i];
  mode->omega     = right->omega[i];
  mode->condition = left->n ? norm_x * norm_y / y_Dx : NAN;
  noise *= (left->n ? mode->condition : 1) / (norm_x * norm_x);
  kappa       = PetscMax(noise, left->n ? y_Qx / y_Dx : 0); /* error of lambda^2 */
  mode->rigid = size * size <= RIGID_NOISE * kappa ? PETSC_TRUE : PETSC_FALSE;
  mode->error = mode->rigid ? PetscMax(size, PetscSqrtReal(kappa)) : kappa / (2 * size);
  if (mode->rigid) mode->sigma = mode->omega = 0;
  mode->unstable = mode->sigma > 3 * mode->error && mode->sigma > 1e-9 * size ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(0);
}

PetscErrorCode QualityMeasure(Modes modes, const OperatorsPencil *pencil)
{
  PetscReal norms[3];
  Vec       work[4], full; /* three for products, and the diagonal of K */
  Mat       M;

  PetscFunctionBeginUser;
  for (int k = 0; k < 4; k++) PetscCall(MatCreateVecs(pencil->K, &work[k], NULL));
  PetscCall(MatGetDiagonal(pencil->K, work[3]));
  PetscCall(OperatorsCreateVec(modes->operators, &full));
  PetscCall(OperatorsGetMatrices(modes->operators, NULL, &M, NULL, NULL, NULL));
  PetscCall(PencilNorms(pencil, norms));
  if (modes->left_spectrum.n) PetscCall(LeftBiorthogonalise(modes, pencil, work));
  modes->n = modes->right.n;
  PetscCall(PetscCalloc1(modes->n, &modes->mode));
  for (PetscInt i = 0; i < modes->n; i++) PetscCall(MeasureMode(modes, pencil, M, i, norms, work, full));
  for (int k = 0; k < 4; k++) PetscCall(VecDestroy(&work[k]));
  PetscCall(VecDestroy(&full));
  PetscFunctionReturn(0);
}
