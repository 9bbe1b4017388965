/*
   What -symmetry_rtol leaves out of the modes of each parity: matrices of the mean of the scene and its mirror image were
   solved, and E, by which those of the whole Q differ from them, was not. It couples parities alone, by

      c_ij = y_j^T Q(lambda_i) x_i / sqrt(y_i^T D x_i  y_j^T D x_j),   D as in complexvec.h,

   which shifts kappa_i = -lambda_i^2 by about the sum over modes j of other parities of

      min(|c|, |c_ij c_ji| / |kappa_i - kappa_j|),   |c|^2 = |c_ij c_ji|.

   Modes beyond the band are not known. With delta the part of its row by which a matrix differs, or the largest
   |c| / sqrt|kappa_i kappa_j| of those known where that is larger, sum_j |c|^2 / |kappa_j| is taken as delta^2 |kappa_i| times
   the condition of both, and the nearest of them to be at the end of the band.
*/
#include "complexvec.h"
#include <math.h>
#include <string.h>

#define ASYMMETRY_ROUNDING 1e-11 /* of a row, that is no more than errors of the matrices: as -symmetry_rtol by default */

/* Couplings of all modes, and what they are made with */
typedef struct {
  PencilMatrices m;
  PetscReal      delta, norm[3], ends[2]; /* Frobenius norms of K, C, M; ends of the band, rad/s */
  ComplexVec     x, Qx, *y;               /* of one mode; of all, [n]; unknowns of the pencil */
  Vec            work;
  PetscComplex  *c; /* [n][n] y_j^T Q(lambda_i) x_i */
} Asymmetry;

/* The ends of the band, rad/s; of the modes nearest to a target as far as the farthest of them */
static void AsymmetryEnds(Modes modes, PetscReal ends[2])
{
  const PetscReal target = 2 * PETSC_PI * modes->target;
  PetscReal       far    = 0;

  for (int i = 0; i < 2; i++) ends[i] = 2 * PETSC_PI * modes->band[i];
  if (modes->has_band) return;
  for (PetscInt i = 0; i < modes->n; i++) far = PetscMax(far, PetscAbsReal(modes->right.omega[i] - target));
  ends[0] = PetscMax(0, target - far);
  ends[1] = target + far;
}

/* A vector of the unknowns of the pencil from one of all; NULL where that is */
static PetscErrorCode AsymmetryRestrict(Modes modes, Vec full, Vec like, Vec *q)
{
  PetscFunctionBeginUser;
  *q = NULL;
  if (!full) PetscFunctionReturn(0);
  PetscCall(VecDuplicate(like, q));
  PetscCall(PencilRestrict(modes->pencil, full, *q));
  PetscFunctionReturn(0);
}

static PetscErrorCode AsymmetryCreate(Modes modes, PetscReal delta, Asymmetry *a)
{
  PetscFunctionBeginUser;
  *a = (Asymmetry){.delta = delta};
  AsymmetryEnds(modes, a->ends);
  PetscCall(PencilGetMatrices(modes->pencil, &a->m));
  PetscCall(MatNorm(a->m.K, NORM_FROBENIUS, &a->norm[0]));
  if (a->m.C) PetscCall(MatNorm(a->m.C, NORM_FROBENIUS, &a->norm[1]));
  PetscCall(MatNorm(a->m.M, NORM_FROBENIUS, &a->norm[2]));
  PetscCall(MatCreateVecs(a->m.K, &a->work, &a->Qx.r));
  PetscCall(VecDuplicate(a->Qx.r, &a->Qx.i));
  PetscCall(PetscCalloc2(modes->n, &a->y, modes->n * modes->n, &a->c));
  for (PetscInt i = 0; i < modes->left_spectrum.n; i++) {
    PetscCall(AsymmetryRestrict(modes, modes->left_spectrum.xr[i], a->work, &a->y[i].r));
    PetscCall(AsymmetryRestrict(modes, modes->left_spectrum.xi[i], a->work, &a->y[i].i));
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode AsymmetryDestroy(Modes modes, Asymmetry *a)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < modes->n; i++) {
    PetscCall(VecDestroy(&a->y[i].r));
    PetscCall(VecDestroy(&a->y[i].i));
  }
  PetscCall(PetscFree2(a->y, a->c));
  PetscCall(VecDestroy(&a->Qx.r));
  PetscCall(VecDestroy(&a->Qx.i));
  PetscCall(VecDestroy(&a->work));
  PetscFunctionReturn(0);
}

/* Length of a complex vector */
static PetscErrorCode AsymmetryLength(ComplexVec x, PetscReal *length)
{
  PetscReal part = 0;

  PetscFunctionBeginUser;
  PetscCall(VecNorm(x.r, NORM_2, length));
  if (x.i) PetscCall(VecNorm(x.i, NORM_2, &part));
  *length = hypot(*length, part);
  PetscFunctionReturn(0);
}

/* The backward error of mode i on the matrices of the whole, and its couplings */
static PetscErrorCode AsymmetryCouple(Modes modes, PetscInt i, Asymmetry *a)
{
  const PetscComplex lambda = SpectrumLambda(&modes->right, i);
  const PetscReal    size = cabs(lambda), bound = size * size * a->norm[2] + size * a->norm[1] + a->norm[0];
  PetscReal          length, residual;

  PetscFunctionBeginUser;
  PetscCall(AsymmetryRestrict(modes, modes->right.xr[i], a->work, &a->x.r));
  PetscCall(AsymmetryRestrict(modes, modes->right.xi[i], a->work, &a->x.i));
  PetscCall(VecSet(a->Qx.r, 0));
  PetscCall(VecSet(a->Qx.i, 0));
  PetscCall(ComplexVecMultAdd(a->m.K, 1, a->x, a->work, a->Qx));
  PetscCall(ComplexVecMultAdd(a->m.M, lambda * lambda, a->x, a->work, a->Qx));
  if (a->m.C) PetscCall(ComplexVecMultAdd(a->m.C, lambda, a->x, a->work, a->Qx));
  PetscCall(AsymmetryLength(a->x, &length));
  PetscCall(AsymmetryLength(a->Qx, &residual));
  modes->mode[i].backward_error = PetscMax(modes->mode[i].backward_error, residual / (bound * length));
  for (PetscInt j = 0; j < modes->left_spectrum.n; j++)
    if (strcmp(modes->parity[i], modes->parity[j]) != 0)
      PetscCall(ComplexVecDot(a->y[j], a->Qx, &a->c[i * modes->n + j]));
  PetscCall(VecDestroy(&a->x.r));
  PetscCall(VecDestroy(&a->x.i));
  PetscFunctionReturn(0);
}

/* About by how much |kappa_i| is off */
static PetscReal AsymmetryShift(Modes modes, PetscInt i, const Asymmetry *a)
{
  const PetscComplex lambda = SpectrumLambda(&modes->right, i), *c = a->c;
  const PetscReal    size   = cabs(lambda);
  const Mode        *mode   = modes->mode;
  PetscReal          shift = 0, delta = a->delta, nearness = 0, condition = 1;

  for (PetscInt j = 0; j < modes->n; j++) {
    const PetscComplex other   = SpectrumLambda(&modes->right, j);
    const PetscReal    product = hypot(mode[i].product[0], mode[i].product[1]) * hypot(mode[j].product[0], mode[j].product[1]);
    const PetscReal    both    = cabs(c[i * modes->n + j]) * cabs(c[j * modes->n + i]) / product; /* |c|^2 */
    const PetscReal    gap     = cabs(lambda * lambda - other * other);

    if (isfinite(mode[j].condition)) condition = PetscMax(condition, mode[j].condition);
    if (!(both > 0)) continue;
    shift += gap * gap > both ? both / gap : PetscSqrtReal(both);
    if (!mode[j].rigid) delta = PetscMax(delta, PetscSqrtReal(both) / (size * cabs(other)));
  }
  for (int k = 0; k < 2; k++) {
    const PetscReal square = a->ends[k] * a->ends[k], gap = cabs(lambda * lambda + square);

    if (square > 0) nearness = PetscMax(nearness, gap > 0 ? square / gap : INFINITY);
  }
  if (isfinite(mode[i].condition)) condition *= PetscMax(1, mode[i].condition);
  return shift + size * size * PetscMin(condition * delta, condition * delta * delta * nearness);
}

PetscErrorCode AsymmetryMeasure(Modes modes)
{
  PetscInt  n;
  PetscReal delta;
  Asymmetry a;

  PetscFunctionBeginUser;
  PetscCall(PencilGetParities(modes->pencil, &n, &delta));
  if (delta <= ASYMMETRY_ROUNDING) PetscFunctionReturn(0);
  PetscCall(AsymmetryCreate(modes, delta, &a));
  for (PetscInt i = 0; i < modes->n; i++) PetscCall(AsymmetryCouple(modes, i, &a));
  for (PetscInt i = 0; i < modes->n; i++) {
    Mode *mode = &modes->mode[i];

    if (mode->rigid) continue;
    mode->error += AsymmetryShift(modes, i, &a) / (2 * cabs(SpectrumLambda(&modes->right, i)));
    if (mode->sigma <= mode->error) mode->unstable = PETSC_FALSE;
  }
  PetscCall(AsymmetryDestroy(modes, &a));
  PetscFunctionReturn(0);
}
