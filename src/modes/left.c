/*
   Left vectors for right ones. The two spectra were computed apart; here each right eigenvalue gets its left partner,
   or the spectra are found to differ, so that a mode is missing in one of them. Eigenvalues that are no farther apart
   than left and right ones may be may have exchanged partners, or be one multiple eigenvalue: in such a cluster the
   left vectors are combined so that

      y_i^T D((lambda_i + lambda_j) / 2) x_j = delta_ij,   D(s) = M + C / (2 s),

   which holds for different eigenvalues of the quadratic problem as well. Without that neither condition, error nor
   residue would mean anything for a double mode. Right vectors of one multiple eigenvalue are any basis of their space,
   and
   |x_i| |y_i| depends on it: they are made orthogonal in M before, x_i^H M x_j = 0, the basis for which it is least.
*/
#include "complexvec.h"
#include "base/algebra/dense.h"

#define LEFT_MATCH 1e-5  /* left and right eigenvalues farther apart than this, relative, are different ones */
#define LEFT_EQUAL 1e-11 /* right eigenvalues no farther apart, relative, are one: any combination is an eigenvector */
#define LEFT_APART 0.999999 /* square of the cosine of two vectors, above which they are parallel */
#define LEFT_RIGID 1e-5     /* both smaller than this beside the largest of the window: zeros */

/* Nearest entry of the left spectrum that is not used yet */
static PetscInt LeftNearest(const Spectrum *left, const PetscBool used[], PetscComplex lambda, PetscReal *distance)
{
  PetscInt best = -1;

  *distance = PETSC_MAX_REAL;
  for (PetscInt j = 0; j < left->n; j++) {
    const PetscReal here = cabs(SpectrumLambda(left, j) - lambda);

    if (used[j] || here >= *distance) continue;
    *distance = here;
    best      = j;
  }
  return best;
}

/* Largest |lambda| of a spectrum */
static PetscReal LeftLargest(const Spectrum *s)
{
  PetscReal largest = 0;

  for (PetscInt j = 0; j < s->n; j++) largest = PetscMax(largest, cabs(SpectrumLambda(s, j)));
  return largest;
}

/* Relative distance of two eigenvalues; rigid modes are zeros up to the square root of rounding, hence all alike */
static PetscReal LeftDistance(PetscComplex a, PetscComplex b, PetscReal largest)
{
  if (PetscMax(cabs(a), cabs(b)) < LEFT_RIGID * largest) return 0;
  return cabs(a - b) / PetscMax(cabs(a), 1e-3 * largest);
}

/* Whether a left eigenvalue that no right one matches lies well inside the window */
static PetscBool LeftIsInside(const Window *window, const Spectrum *left, PetscInt j, PetscReal tiny)
{
  const PetscReal omega = left->omega[j];

  if (window->count || omega < tiny || PetscAbsReal(left->sigma[j]) > window->growth) return PETSC_FALSE;
  return omega > window->low * (1 + LEFT_MATCH) && omega < window->high * (1 - LEFT_MATCH) ? PETSC_TRUE : PETSC_FALSE;
}

PetscErrorCode LeftMatch(Modes modes, const Window *window, PetscReal *worst, PetscBool *complete)
{
  Spectrum       *right = &modes->right, *left = &modes->left_spectrum, matched;
  const PetscReal tiny =
    PetscMax(window->known.scale, LEFT_RIGID * LeftLargest(right)); /* rigid modes: zeros up to the root of rounding */
  PetscBool *used;

  PetscFunctionBeginUser;
  *worst    = 0;
  *complete = PETSC_TRUE;
  PetscCall(PetscCalloc1(left->n, &used));
  PetscCall(SpectrumCreate(right->n, &matched));
  for (PetscInt i = 0; i < right->n; i++) {
    PetscReal       distance;
    PetscInt        j    = LeftNearest(left, used, SpectrumLambda(right, i), &distance);
    const PetscReal size = cabs(SpectrumLambda(right, i));

    if (j < 0 || distance > LEFT_MATCH * size) {
      *complete = size < tiny ? PETSC_TRUE : PETSC_FALSE;
      if (!*complete) break; /* a zero pairs with any zero; it stays rigid whatever its left vector */
      PetscCall(SpectrumAdd(&matched, right->sigma[i], right->omega[i], right->xr[i], right->xi[i]));
    } else {
      used[j] = PETSC_TRUE;
      if (size > tiny) *worst = PetscMax(*worst, distance / size);
      PetscCall(SpectrumTake(&matched, left->sigma[j], left->omega[j], left->xr[j], left->xi[j]));
      left->xr[j] = left->xi[j] = NULL;
    }
  }
  for (PetscInt j = 0; j < left->n; j++)
    if (!used[j] && LeftIsInside(window, left, j, tiny)) *complete = PETSC_FALSE;
  PetscCall(PetscFree(used));
  PetscCall(SpectrumDestroy(left));
  *left = matched;
  PetscFunctionReturn(0);
}

/* Inverse of the complex m x m matrix G, both by rows; I where G is defective */
static PetscErrorCode ComplexInverse(PetscInt m, const PetscComplex G[], PetscComplex inverse[])
{
  PetscReal     size[2] = {0, 0};
  PetscComplex *factors;
  PetscBLASInt *pivot;
  PetscBool     singular;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(m * m, &factors, m, &pivot));
  PetscCall(PetscArraycpy(factors, G, m * m));
  for (PetscInt i = 0; i < m * m; i++) inverse[i] = i % (m + 1) == 0;
  PetscCall(DenseComplexFactor(m, factors, pivot, &singular));
  if (!singular) PetscCall(DenseComplexSolve(m, factors, pivot, PETSC_FALSE, m, inverse));
  for (PetscInt i = 0; i < m * m; i++) {
    size[0] = PetscMax(size[0], cabs(G[i]));
    size[1] = PetscMax(size[1], cabs(inverse[i]));
  }
  for (PetscInt i = 0; i < m * m && !(size[0] * size[1] < 1e12); i++) inverse[i] = i % (m + 1) == 0;
  PetscCall(PetscFree2(factors, pivot));
  PetscFunctionReturn(0);
}

/* w^H z */
static PetscErrorCode LeftInner(ComplexVec w, ComplexVec z, PetscComplex *inner)
{
  PetscComplex rest = 0;

  PetscFunctionBeginUser;
  PetscCall(ComplexVecDot((ComplexVec){w.r, NULL}, z, inner));
  if (w.i) PetscCall(ComplexVecDot((ComplexVec){w.i, NULL}, z, &rest));
  *inner -= I * rest;
  PetscFunctionReturn(0);
}

/* Makes right vector i orthogonal in M to right vector j, unless they are parallel: an eigenvalue with one vector
   alone */
static PetscErrorCode LeftOrthogonalisePair(Spectrum *right, Mat M, PetscInt i, PetscInt j, ComplexVec z)
{
  const ComplexVec w = {right->xr[j], right->xi[j]};
  ComplexVec       x = {right->xr[i], right->xi[i]};
  PetscComplex     xx, wx, ww;

  PetscFunctionBeginUser;
  PetscCall(ComplexVecMult(M, x, z));
  PetscCall(LeftInner(x, z, &xx));
  PetscCall(LeftInner(w, z, &wx));
  PetscCall(ComplexVecMult(M, w, z));
  PetscCall(LeftInner(w, z, &ww));
  if (!(PetscSqr(cabs(wx)) < LEFT_APART * creal(xx) * creal(ww))) PetscFunctionReturn(0);
  if (w.i && !x.i) {
    PetscCall(VecDuplicate(x.r, &right->xi[i]));
    PetscCall(VecSet(right->xi[i], 0));
    x.i = right->xi[i];
  }
  PetscCall(ComplexVecAXPY(x.i ? -wx / ww : -creal(wx / ww), w, x));
  PetscFunctionReturn(0);
}

/* The same for all right vectors of one eigenvalue among first .. first + m - 1, twice as rounding wants it */
static PetscErrorCode LeftOrthogonalise(Modes modes, const PencilMatrices *pencil, PetscInt first, PetscInt m,
                                        Vec work[])
{
  Spectrum       *right   = &modes->right;
  const PetscReal largest = LeftLargest(right);

  PetscFunctionBeginUser;
  for (PetscInt i = first; i < first + m; i++)
    for (int pass = 0; pass < 2; pass++)
      for (PetscInt j = first; j < i; j++)
        if (LeftDistance(SpectrumLambda(right, i), SpectrumLambda(right, j), largest) <= LEFT_EQUAL)
          PetscCall(LeftOrthogonalisePair(right, pencil->M, i, j, (ComplexVec){work[1], work[2]}));
  PetscFunctionReturn(0);
}

/* G_ij = y_i^T D((lambda_i + lambda_j) / 2) x_j of the vectors first .. first + m - 1, row-major */
static PetscErrorCode LeftForm(Modes modes, const PencilMatrices *pencil, PetscInt first, PetscInt m, Vec work[],
                               PetscComplex G[])
{
  const Spectrum *right = &modes->right, *left = &modes->left_spectrum;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < m; i++)
    for (PetscInt j = 0; j < m; j++) {
      const PetscComplex lambda = 0.5 * (SpectrumLambda(right, first + i) + SpectrumLambda(right, first + j));
      const ComplexVec   x = {right->xr[first + j], right->xi[first + j]}, z = {work[1], work[2]};

      PetscCall(ComplexVecApplyD(pencil, lambda, x, work[0], z));
      PetscCall(ComplexVecDot((ComplexVec){left->xr[first + i], left->xi[first + i]}, z, &G[i * m + j]));
    }
  PetscFunctionReturn(0);
}

/* Replaces the left vectors first .. first + m - 1 by combinations with G = I */
static PetscErrorCode LeftBiorthogonaliseCluster(Modes modes, const PencilMatrices *pencil, PetscInt first, PetscInt m,
                                                 Vec work[])
{
  const Spectrum *right = &modes->right, *left = &modes->left_spectrum;
  PetscComplex   *G, *inverse;
  Vec            *yr, *yi;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(m * m, &G, m * m, &inverse));
  PetscCall(LeftOrthogonalise(modes, pencil, first, m, work));
  PetscCall(LeftForm(modes, pencil, first, m, work, G));
  PetscCall(ComplexInverse(m, G, inverse));
  PetscCall(VecDuplicateVecs(work[0], m, &yr));
  PetscCall(VecDuplicateVecs(work[0], m, &yi));
  for (PetscInt i = 0; i < m; i++)
    for (PetscInt j = 0; j < m; j++) {
      const ComplexVec y = {left->xr[first + j], left->xi[first + j]};

      PetscCall(ComplexVecAXPY(inverse[i * m + j], y, (ComplexVec){yr[i], yi[i]}));
    }
  for (PetscInt i = 0; i < m; i++) {
    PetscCall(VecCopy(yr[i], left->xr[first + i]));
    if (!left->xi[first + i] && right->xi[first + i]) PetscCall(VecDuplicate(yi[i], &left->xi[first + i]));
    if (left->xi[first + i]) PetscCall(VecCopy(yi[i], left->xi[first + i]));
  }
  PetscCall(VecDestroyVecs(m, &yr));
  PetscCall(VecDestroyVecs(m, &yi));
  PetscCall(PetscFree2(G, inverse));
  PetscFunctionReturn(0);
}

PetscErrorCode LeftBiorthogonalise(Modes modes, const PencilMatrices *pencil, Vec work[])
{
  const Spectrum *right   = &modes->right;
  const PetscReal largest = LeftLargest(right);

  PetscFunctionBeginUser;
  for (PetscInt first = 0, m; first < right->n; first += m) {
    for (m = 1; first + m < right->n; m++)
      if (LeftDistance(SpectrumLambda(right, first + m), SpectrumLambda(right, first + m - 1), largest) > LEFT_MATCH)
        break;
    if (m > 1) PetscCall(LeftBiorthogonaliseCluster(modes, pencil, first, m, work));
  }
  PetscFunctionReturn(0);
}
