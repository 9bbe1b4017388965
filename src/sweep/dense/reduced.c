/*
   The reduced model at one point p of the parameters: K, C, M = sum_t c_t(p) V' A_t V, its eigenvalues in the window
   (eigen.c), and their vectors in a common form:

      order        by omega; equal ones (within 1e-7, members of a lock-in pair) by sigma
      clusters     eigenvalues equal within 1e-9: left vectors replaced by combinations with y_i^T D x_j = 0, i != j,
                   where D = M + C / (2 lambda), Q'(lambda) = 2 lambda D; any vectors of such a plane are
                   eigenvectors, and only these have conditions and sensitivities that mean something
      length       x^H Ms x = y^H Ms y = 1, Ms the symmetric terms of M
      product      y^T D x of the vectors so scaled (rigid modes, lambda = 0: y^T M x)

   A cluster whose matrix y_i^T D x_j is singular is defective, and is left as it is.
*/
#include "eigen.h"
#include <petscblaslapack.h>

#define FACTORS_FEW 8   /* rows of a product cost as much as the term itself where there are n / 8 */
#define PAIR       1e-7 /* relative difference of equal frequencies */
#define SAME_VALUE 1e-9 /* relative difference of equal eigenvalues */
/* Least pivot, relative, of the products y_i^T D x_j of a cluster that is not defective: below it their inverse
   would have no more digits than vectors of modes SAME_VALUE apart have. */
#define DEFECTIVE 1e-10

void ReducedClusterJoin(PetscInt n, PetscInt i, PetscInt j, PetscInt cluster[])
{
  const PetscInt first = PetscMin(cluster[i], cluster[j]), last = PetscMax(cluster[i], cluster[j]);

  for (PetscInt k = 0; k < n; k++)
    if (cluster[k] == last) cluster[k] = first;
}

PetscErrorCode ReducedModesCreate(PetscInt n, PetscInt size, ReducedModes *modes)
{
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(n, &modes->sharp));
  modes->n    = n;
  modes->size = size;
  PetscCall(PetscCalloc7(n, &modes->lambda, n * size, &modes->x, n * size, &modes->y, n, &modes->product, n,
                         &modes->error, n, &modes->noise, n, &modes->rigid));
  PetscFunctionReturn(0);
}

PetscErrorCode ReducedModesSelect(const ReducedModes *from, PetscInt n, const PetscInt list[], ReducedModes *to)
{
  const PetscInt size = from->size;

  PetscFunctionBeginUser;
  PetscCall(ReducedModesCreate(n, size, to));
  for (PetscInt i = 0; i < n; i++) {
    const PetscInt k = list ? list[i] : i;

    to->lambda[i]  = from->lambda[k];
    to->product[i] = from->product[k];
    to->error[i]   = from->error[k];
    to->sharp[i]   = from->sharp[k];
    to->noise[i]   = from->noise[k];
    to->rigid[i]   = from->rigid[k];
    PetscCall(PetscArraycpy(&to->x[i * size], &from->x[k * size], size));
    PetscCall(PetscArraycpy(&to->y[i * size], &from->y[k * size], size));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode ReducedModesDestroy(ReducedModes *modes)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(modes->sharp));
  PetscCall(PetscFree7(modes->lambda, modes->x, modes->y, modes->product, modes->error, modes->noise, modes->rigid));
  modes->n = 0;
  PetscFunctionReturn(0);
}

/* Adds c times the leading n x n block of A (column stride lda) */
static void AddBlock(PetscInt n, PetscInt lda, PetscReal c, const PetscReal A[], PetscReal sum[])
{
  for (PetscInt j = 0; j < n; j++)
    for (PetscInt i = 0; i < n; i++) sum[j * n + i] += c * A[j * lda + i];
}

PetscInt ReducedFactorsRank(const Reduced *reduced, PetscInt t, PetscInt n)
{
  const PetscInt rank = reduced->factors ? reduced->factors[t].rank : 0;

  return FACTORS_FEW * rank <= n ? rank : 0;
}

/* sum += L' R of all terms that go by their factors, `rank` rows together */
static PetscErrorCode AddFactors(const Reduced *reduced, const PetscReal c[], PetscInt n, PetscInt rank,
                                 PetscReal sum[])
{
  const PetscReal one = 1;
  PetscReal      *L, *R;
  PetscInt        at = 0;
  PetscBLASInt    size, rows;

  PetscFunctionBeginUser;
  if (!rank) PetscFunctionReturn(0);
  PetscCall(PetscMalloc2(n * rank, &L, n * rank, &R));
  for (PetscInt t = 0; t < reduced->n_terms; t++) {
    const PetscInt own = c[t] != 0 ? ReducedFactorsRank(reduced, t, n) : 0;

    for (PetscInt j = 0; j < n && own; j++)
      for (PetscInt i = 0; i < own; i++) {
        L[j * rank + at + i] = c[t] * reduced->factors[t].left[j * own + i];
        R[j * rank + at + i] = reduced->factors[t].right[j * own + i];
      }
    at += own;
  }
  PetscCall(PetscBLASIntCast(n, &size));
  PetscCall(PetscBLASIntCast(rank, &rows));
  PetscCallBLAS("BLASgemm", BLASgemm_("T", "N", &size, &size, &rows, &one, L, &rows, R, &rows, &one, sum, &size));
  PetscCall(PetscFree2(L, R));
  PetscFunctionReturn(0);
}

/* K(p) (or C, M) on the leading n x n block */
static PetscErrorCode ReducedSum(const Reduced *reduced, OperatorsTermKind kind, const PetscReal p[], PetscInt n,
                                 PetscReal sum[])
{
  PetscInt   rank = 0;
  PetscReal *c;

  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(sum, n * n));
  PetscCall(PetscMalloc1(reduced->n_terms, &c));
  for (PetscInt t = 0; t < reduced->n_terms; t++) {
    c[t] = reduced->term[t].kind == kind ? OperatorsTermCoefficient(&reduced->term[t], p) : 0;
    if (c[t] == 0) continue;
    rank += ReducedFactorsRank(reduced, t, n);
    if (!ReducedFactorsRank(reduced, t, n)) AddBlock(n, reduced->n, c[t], reduced->A[t], sum);
  }
  PetscCall(AddFactors(reduced, c, n, rank, sum));
  PetscCall(PetscFree(c));
  PetscFunctionReturn(0);
}

PetscBool ReducedIsDamped(const Reduced *reduced, const PetscReal p[])
{
  for (PetscInt t = 0; t < reduced->n_terms; t++)
    if (reduced->term[t].kind == OPERATORS_DAMPING && OperatorsTermCoefficient(&reduced->term[t], p) != 0)
      return PETSC_TRUE;
  return PETSC_FALSE;
}

/* Ms [n][n] = symmetric terms of M, which lengths are measured in: positive definite, while M with unsymmetric
   terms need give no norm. symmetric = whether the pencil has no others, so that y = x. */
static PetscErrorCode SumSymmetric(const Reduced *reduced, const PetscReal p[], PetscReal Ms[], PetscBool *symmetric)
{
  const PetscInt n = reduced->n_used;

  PetscFunctionBeginUser;
  *symmetric = PETSC_TRUE;
  PetscCall(PetscArrayzero(Ms, n * n));
  for (PetscInt t = 0; t < reduced->n_terms; t++) {
    const OperatorsTerm *term = &reduced->term[t];
    const PetscReal      c    = OperatorsTermCoefficient(term, p);

    if (c != 0 && (!term->symmetric || term->kind == OPERATORS_DAMPING)) *symmetric = PETSC_FALSE;
    if (c != 0 && !term->frictional && term->kind == OPERATORS_MASS) AddBlock(n, reduced->n, c, reduced->A[t], Ms);
  }
  PetscFunctionReturn(0);
}

/* Order of two indices of keys, for a stable sort */
static int CompareKeys(const void *a, const void *b, void *keys)
{
  const PetscReal difference = ((PetscReal *)keys)[*(const PetscInt *)a] - ((PetscReal *)keys)[*(const PetscInt *)b];

  return difference < 0 ? -1 : difference > 0;
}

/* Sorts by frequency, equal ones by growth */
static PetscErrorCode ModesSort(ReducedModes *modes)
{
  const PetscInt n   = modes->n;
  ReducedModes   old = *modes;
  PetscReal     *sigma, *omega;
  PetscInt      *order;

  PetscFunctionBeginUser;
  if (n < 2) PetscFunctionReturn(0); /* PetscTimSort() reads the first entry of none */
  PetscCall(PetscMalloc3(n, &order, n, &sigma, n, &omega));
  for (PetscInt i = 0; i < n; i++) order[i] = i, sigma[i] = creal(old.lambda[i]), omega[i] = cimag(old.lambda[i]);
  PetscCall(PetscTimSort(n, order, sizeof(*order), CompareKeys, omega));
  for (PetscInt first = 0, last; first < n; first = last) {
    for (last = first + 1; last < n; last++)
      if (omega[order[last]] - omega[order[last - 1]] > PAIR * omega[order[last]]) break;
    PetscCall(PetscTimSort(last - first, order + first, sizeof(*order), CompareKeys, sigma));
  }
  PetscCall(ReducedModesSelect(&old, n, order, modes));
  PetscCall(PetscFree3(order, sigma, omega));
  PetscCall(ReducedModesDestroy(&old));
  PetscFunctionReturn(0);
}

/* z [n] = D x of mode i; Mx, Cx [modes][n], Cx is NULL without damping */
static void ApplyD(const ReducedModes *modes, PetscInt i, const PetscComplex Mx[], const PetscComplex Cx[],
                   PetscComplex z[])
{
  const PetscInt     n = modes->size;
  const PetscComplex c = Cx && modes->lambda[i] != 0 ? 1 / (2 * modes->lambda[i]) : 0;

  for (PetscInt k = 0; k < n; k++) z[k] = Mx[i * n + k] + (Cx ? c * Cx[i * n + k] : 0);
}

/* LU factors of the products G [m * m] in place, and whether they are singular within rounding */
static PetscErrorCode FactorProducts(PetscInt m, PetscComplex G[], PetscBLASInt pivot[], PetscBool *defective)
{
  PetscReal least = PETSC_MAX_REAL, largest = 0;

  PetscFunctionBeginUser;
  PetscCall(DenseComplexFactor(m, G, pivot, defective));
  for (PetscInt i = 0; i < m * m; i++) largest = PetscMax(largest, cabs(G[i]));
  for (PetscInt i = 0; i < m * m; i += m + 1) least = PetscMin(least, cabs(G[i]));
  if (!(least > DEFECTIVE * largest)) *defective = PETSC_TRUE;
  PetscFunctionReturn(0);
}

/* Left vectors of the cluster list[m] := G^-1 y, G_ij = y_i^T D x_j, unless that is defective; Dx [modes][n].
   Afterwards y_i^T D x_j = 1 for i = j, else 0, until lengths are set. */
static PetscErrorCode ClusterBiorthogonalise(PetscInt m, const PetscInt list[], const PetscComplex Dx[],
                                             ReducedModes *modes)
{
  const PetscInt n = modes->size;
  PetscComplex  *G, *Y;
  PetscBLASInt  *pivot;
  PetscBool      defective;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc3(m * m, &G, m * n, &Y, m, &pivot));
  for (PetscInt i = 0; i < m; i++)
    for (PetscInt j = 0; j < m; j++) G[j * m + i] = DenseDot(n, modes->y + list[i] * n, Dx + list[j] * n);
  for (PetscInt i = 0; i < m; i++)
    for (PetscInt k = 0; k < n; k++) Y[k * m + i] = modes->y[list[i] * n + k];
  PetscCall(FactorProducts(m, G, pivot, &defective));
  if (!defective) {
    PetscCall(DenseComplexSolve(m, G, pivot, PETSC_FALSE, n, Y));
    for (PetscInt i = 0; i < m; i++)
      for (PetscInt k = 0; k < n; k++) modes->y[list[i] * n + k] = Y[k * m + i];
  }
  PetscCall(PetscFree3(G, Y, pivot));
  PetscFunctionReturn(0);
}

/* Treats all clusters; members need not be neighbours in the order, since both members of a pair have one frequency */
static PetscErrorCode ClustersTreat(const PetscComplex Dx[], ReducedModes *modes)
{
  PetscInt  *list, m;
  PetscBool *done;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc2(modes->n, &list, modes->n, &done));
  for (PetscInt first = 0; first < modes->n; first++) {
    if (done[first]) continue;
    list[0] = first, m = 1;
    for (PetscInt j = first + 1; j < modes->n; j++) {
      const PetscReal distance = cabs(modes->lambda[j] - modes->lambda[list[m - 1]]);

      if (done[j] || distance > SAME_VALUE * cabs(modes->lambda[j])) continue;
      list[m++] = j;
      done[j]   = PETSC_TRUE;
    }
    if (m > 1) PetscCall(ClusterBiorthogonalise(m, list, Dx, modes));
  }
  PetscCall(PetscFree2(list, done));
  PetscFunctionReturn(0);
}

/* Scales all vectors X [m][n] to X^H Ms X = 1: with a basis orthonormal in M of kg the shapes on the mesh have unit
   modal mass, 1/sqrt(kg). */
static PetscErrorCode VectorsNormalise(PetscInt n, PetscInt m, const PetscReal Ms[], PetscComplex X[])
{
  PetscReal *square;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(m, &square));
  PetscCall(DenseEnergies(n, Ms, m, X, square));
  for (PetscInt i = 0; i < m; i++) {
    PetscCheck(square[i] > 0, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
               "mode without mass: the mass matrix is not positive");
    for (PetscInt k = i * n; k < (i + 1) * n; k++) X[k] /= PetscSqrtReal(square[i]);
  }
  PetscCall(PetscFree(square));
  PetscFunctionReturn(0);
}

/* Right vectors first, as D x must be of the final length; products after both have theirs. Then |y^T D x| <= 1 for
   a symmetric M without damping. */
static PetscErrorCode ModesFinish(const DensePencil *pencil, const PetscReal Ms[], ReducedModes *modes)
{
  const PetscInt n = modes->size, m = modes->n;
  PetscComplex  *Mx, *Cx            = NULL, *Dx;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(m * n, &Mx, m * n, &Dx));
  PetscCall(VectorsNormalise(n, m, Ms, modes->x));
  PetscCall(DenseTimes(&(DenseBlock){pencil->M, n, n, n}, PETSC_FALSE, m, modes->x, Mx));
  if (pencil->damped) {
    PetscCall(PetscMalloc1(m * n, &Cx));
    PetscCall(DenseTimes(&(DenseBlock){pencil->C, n, n, n}, PETSC_FALSE, m, modes->x, Cx));
  }
  for (PetscInt i = 0; i < m; i++) ApplyD(modes, i, Mx, Cx, Dx + i * n);
  PetscCall(ClustersTreat(Dx, modes));
  PetscCall(VectorsNormalise(n, m, Ms, modes->y));
  for (PetscInt i = 0; i < m; i++) modes->product[i] = DenseDot(n, modes->y + i * n, Dx + i * n);
  PetscCall(PetscFree(Cx));
  PetscCall(PetscFree2(Mx, Dx));
  PetscFunctionReturn(0);
}

/* K, C, M [n][n] at p, with the basis orthonormal in M: K (rad/s)^2, C rad/s, M without unit. n <= reduced->n
   leading vectors. */
PetscErrorCode ReducedPencil(const Reduced *reduced, const PetscReal p[], PetscInt n, DensePencil *pencil)
{
  PetscFunctionBeginUser;
  PetscCall(ReducedPencilLoose(reduced, p, n, pencil));
  PetscCall(ReducedSum(reduced, OPERATORS_STIFFNESS, p, n, pencil->K));
  PetscFunctionReturn(0);
}

PetscErrorCode ReducedPencilLoose(const Reduced *reduced, const PetscReal p[], PetscInt n, DensePencil *pencil)
{
  PetscFunctionBeginUser;
  *pencil = (DensePencil){.n = n, .damped = ReducedIsDamped(reduced, p)};
  PetscCall(PetscMalloc3(n * n, &pencil->K, n * n, &pencil->C, n * n, &pencil->M));
  PetscCall(PetscArrayzero(pencil->K, n * n));
  PetscCall(ReducedSum(reduced, OPERATORS_DAMPING, p, n, pencil->C));
  PetscCall(ReducedSum(reduced, OPERATORS_MASS, p, n, pencil->M));
  PetscFunctionReturn(0);
}

/* Not collective: each rank solves points of its own. Modes are sorted, scaled and biorthogonal; errors are 0 until
   ReducedEstimate(). */
PetscErrorCode ReducedSolveAll(const Reduced *reduced, const PetscReal p[], const ReducedWindow *window,
                               ReducedModes *modes)
{
  const PetscInt n = reduced->n_used;
  DensePencil    pencil;
  PetscReal     *Ms, *E   = NULL;
  PetscBool      found    = PETSC_FALSE;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n * n, &Ms));
  PetscCall(ReducedPencil(reduced, p, n, &pencil));
  PetscCall(SumSymmetric(reduced, p, Ms, &pencil.symmetric));
  PetscCall(ReducedCheckMass(reduced, p, Ms));
  if (pencil.damped) PetscCall(PetscMalloc1(n * n, &E));
  if (pencil.damped) PetscCall(RoundingEnergy(reduced, p, E));
  if (reduced->core.m) PetscCall(CondensedEigen(&pencil, E, &reduced->core, window, modes, &found));
  if (!found) PetscCall(DensePencilEigen(&pencil, E, window, modes));
  PetscCall(ModesSort(modes));
  PetscCall(ModesFinish(&pencil, Ms, modes));
  if (!pencil.damped) PetscCall(RoundingMarkRigid(reduced, p, window, modes));
  PetscCall(DensePencilDestroy(&pencil));
  PetscCall(PetscFree(E));
  PetscCall(PetscFree(Ms));
  PetscFunctionReturn(0);
}

PetscErrorCode ReducedSolve(const Reduced *reduced, const PetscReal p[], const ReducedWindow *window,
                            ReducedModes *modes)
{
  PetscFunctionBeginUser;
  PetscCall(ReducedSolveAll(reduced, p, window, modes));
  PetscCall(ReducedDropInexact(reduced, p, window, modes));
  PetscFunctionReturn(0);
}

/* Vectors to begin with: those of the first mode of from, longer ones filled up with zeros as V has grown; or
   numbers without structure, alike on all ranks, which no vector is orthogonal to. */
static void FollowBegin(PetscInt n, const ReducedModes *from, PetscComplex x[], PetscComplex y[])
{
  for (PetscInt i = 0; i < n; i++) {
    x[i] = !from ? cos(1.0 + i * (PetscReal)i) : i < from->size ? from->x[i] : 0;
    y[i] = !from ? sin(1.3 + i * (PetscReal)i) : i < from->size ? from->y[i] : 0;
  }
}

PetscErrorCode ReducedFollow(const Reduced *reduced, const PetscReal p[], PetscComplex lambda, const ReducedModes *from,
                             ReducedModes *modes)
{
  const PetscInt n = reduced->n_used;
  DensePencil    pencil;
  PetscReal     *Ms;
  PetscBool      found;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n * n, &Ms));
  PetscCall(ReducedPencil(reduced, p, n, &pencil));
  PetscCall(SumSymmetric(reduced, p, Ms, &pencil.symmetric));
  PetscCall(ReducedModesCreate(1, n, modes));
  FollowBegin(n, from, modes->x, modes->y);
  PetscCall(DensePencilFollow(&pencil, &lambda, modes->x, modes->y, &found));
  modes->lambda[0] = lambda;
  modes->n         = found ? 1 : 0;
  if (found) PetscCall(ModesFinish(&pencil, Ms, modes));
  PetscCall(DensePencilDestroy(&pencil));
  PetscCall(PetscFree(Ms));
  PetscFunctionReturn(0);
}
