/*
   The dense problem of the Rayleigh-Ritz method in one body, H z = kappa G z with G = V' M V, H = V' K V of columns of
   length one in M. They are nearly dependent: directions of G below RITZ_DEPENDENT of the largest are left out, beyond
   them is rounding. Rigid motions R that nothing resists, K R = 0, are found among the last columns and split off: what
   the others hold beyond them is in G - G R R' G. Among the others rounding would make them springs.
*/
#include "components.h"
#include "base/algebra/dense.h"
#include <petscblaslapack.h>

#define RITZ_DEPENDENT 1e-12 /* square of a length: rounding of K is 1e-16 of what is stiffest */
#define RITZ_RIGID     1e-8  /* kappa beside the largest of the vectors: nothing resists this motion */

/* Rows and columns of a product, what is summed over, and the stride of all three matrices */
typedef struct {
  PetscInt rows, columns, inner, stride;
} ProductSize;

/* C = op(A) B */
static PetscErrorCode Product(const char op[], const ProductSize *size, const PetscReal A[], const PetscReal B[],
                              PetscReal C[])
{
  const PetscReal one = 1, zero = 0;
  PetscBLASInt    rows, columns, inner, ld;

  PetscFunctionBeginUser;
  PetscCall(PetscBLASIntCast(size->rows, &rows));
  PetscCall(PetscBLASIntCast(size->columns, &columns));
  PetscCall(PetscBLASIntCast(size->inner, &inner));
  PetscCall(PetscBLASIntCast(size->stride, &ld));
  PetscCallBLAS("BLASgemm", BLASgemm_(op, "N", &rows, &columns, &inner, &one, A, &ld, B, &ld, &zero, C, &ld));
  PetscFunctionReturn(0);
}

/* T [n][rank] with T' G T = 1 for G [n][n], positive; G is overwritten; directions below RITZ_DEPENDENT are left out */
static PetscErrorCode Orthonormalise(PetscInt n, PetscReal G[], PetscReal T[], PetscInt *rank)
{
  PetscReal *w;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n, &w));
  PetscCall(DenseSymmetricEigen(n, G, NULL, w, NULL));
  *rank = 0;
  for (PetscInt k = 0; k < n; k++) {
    if (!(w[k] > RITZ_DEPENDENT * w[n - 1])) continue;
    for (PetscInt i = 0; i < n; i++) T[*rank * n + i] = G[k * n + i] / PetscSqrtReal(w[k]);
    (*rank)++;
  }
  PetscCall(PetscFree(w));
  PetscFunctionReturn(0);
}

/* Modes of H among the directions T [n][rank]: kappa and T Y in place of T. H stays */
static PetscErrorCode DirectionsSolve(PetscInt n, PetscInt rank, const PetscReal H[], PetscReal T[], PetscReal kappa[])
{
  PetscReal *A, *B, *Y;

  PetscFunctionBeginUser;
  if (!rank) PetscFunctionReturn(0);
  PetscCall(PetscMalloc3(n * n, &A, n * n, &B, n * n, &Y));
  PetscCall(Product("N", &(ProductSize){n, rank, n, n}, H, T, A));
  PetscCall(Product("T", &(ProductSize){rank, rank, n, n}, T, A, B));
  for (PetscInt j = 0; j < rank; j++) PetscCall(PetscArraycpy(&Y[j * rank], &B[j * n], rank));
  PetscCall(DenseSymmetricEigen(rank, Y, NULL, kappa, NULL));
  for (PetscInt j = 0; j < rank; j++) PetscCall(PetscArraycpy(&B[j * n], &Y[j * rank], rank));
  PetscCall(Product("N", &(ProductSize){n, rank, rank, n}, T, B, A));
  PetscCall(PetscArraycpy(T, A, n * rank));
  PetscCall(PetscFree3(A, B, Y));
  PetscFunctionReturn(0);
}

/* The rigid motions of a body that nothing resists, among the last columns: R [n][n_rigid] in the scaled columns */
static PetscErrorCode BodyFindRigid(PetscInt n, const PetscReal G[], const PetscReal H[], PetscReal R[],
                                    PetscInt *n_rigid)
{
  const PetscInt m = FREE_MOTIONS, first = n - m;
  PetscReal      A[FREE_MOTIONS * FREE_MOTIONS], B[FREE_MOTIONS * FREE_MOTIONS], T[FREE_MOTIONS * FREE_MOTIONS];
  PetscReal      kappa[FREE_MOTIONS], most = 0;
  PetscInt       rank;

  PetscFunctionBeginUser;
  for (PetscInt j = 0; j < m; j++)
    for (PetscInt i = 0; i < m; i++) {
      A[j * m + i] = G[(first + j) * n + first + i];
      B[j * m + i] = H[(first + j) * n + first + i];
    }
  for (PetscInt j = 0; j < n; j++) most = PetscMax(most, H[j * n + j]);
  PetscCall(Orthonormalise(m, A, T, &rank));
  PetscCall(DirectionsSolve(m, rank, B, T, kappa));
  for (*n_rigid = 0; *n_rigid < rank && kappa[*n_rigid] <= RITZ_RIGID * most; (*n_rigid)++) {
    PetscCall(PetscArrayzero(&R[*n_rigid * n], first));
    PetscCall(PetscArraycpy(&R[*n_rigid * n + first], &T[*n_rigid * m], m));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode FreeBodySolve(PetscInt n, PetscReal G[], const PetscReal H[], const FreeBodyModes *modes)
{
  PetscReal *const Z = modes->Z, *const kappa = modes->kappa;
  PetscReal *GR, *A, *T;
  PetscInt   rank, n_rigid;

  PetscFunctionBeginUser;
  PetscCall(BodyFindRigid(n, G, H, Z, &n_rigid));
  PetscCall(PetscMalloc3(n * n, &GR, n * n, &A, n * n, &T));
  PetscCall(Product("N", &(ProductSize){n, n_rigid, n, n}, G, Z, GR));
  for (PetscInt j = 0; j < n; j++)
    for (PetscInt i = 0; i < n; i++)
      for (PetscInt k = 0; k < n_rigid; k++) G[j * n + i] -= GR[k * n + i] * GR[k * n + j];
  PetscCall(Orthonormalise(n, G, T, &rank));
  rank = PetscMin(rank, n - n_rigid);
  PetscCall(Product("T", &(ProductSize){n_rigid, rank, n, n}, GR, T, A));
  for (PetscInt j = 0; j < rank; j++)
    for (PetscInt k = 0; k < n_rigid; k++)
      for (PetscInt i = 0; i < n; i++) T[j * n + i] -= Z[k * n + i] * A[j * n + k];
  PetscCall(DirectionsSolve(n, rank, H, T, &kappa[n_rigid]));
  for (PetscInt k = 0; k < n_rigid; k++) kappa[k] = 0;
  PetscCall(PetscArraycpy(&Z[n_rigid * n], T, rank * n));
  *modes->n_rigid = n_rigid;
  *modes->n_modes = n_rigid + rank;
  PetscCall(PetscFree3(GR, A, T));
  PetscFunctionReturn(0);
}
