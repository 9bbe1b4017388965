/*
   Modes in a basis that neither ranks nor rounding choose. Vectors of one eigenvalue may be turned into each other, and
   each may have either sign. Phi of a cluster becomes Phi Q, where Phi'M W = Q R, R upper triangular with a positive
   diagonal; W has values that depend on the places of the nodes alone.
*/
#include "substructure/substructureimpl.h"
#include "base/algebra/gram.h"
#include "base/algebra/product.h"

#define CANON_CLOSE 1e-6 /* of kappa: modes nearer to each other are of a cluster */
#define CANON_WAVES 5    /* some waves in the size of the mesh: no symmetry of a body is theirs */

/* End of the cluster that begins at value k of n, ascending */
static PetscInt ClusterEnd(PetscInt n, const PetscReal kappa[], PetscInt k)
{
  PetscInt end = k + 1;

  while (end < n && kappa[end] - kappa[end - 1] <= CANON_CLOSE * kappa[end]) end++;
  return end;
}

PetscInt CanonWidest(PetscInt n, const PetscReal kappa[])
{
  PetscInt widest = 0;

  for (PetscInt k = 0; k < n; k = ClusterEnd(n, kappa, k)) widest = PetscMax(widest, ClusterEnd(n, kappa, k) - k);
  return widest;
}

PetscErrorCode CanonSize(Substructure s, PetscReal *size)
{
  const Mesh *mesh;

  PetscFunctionBeginUser;
  *size = 0;
  PetscCall(ModelGetMesh(s->model, &mesh));
  for (PetscInt i = 0; i < 3 * mesh->n_nodes; i++) *size = PetscMax(*size, PetscAbsReal(mesh->x[i]));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, size, 1, MPIU_REAL, MPI_MAX, s->comm));
  PetscFunctionReturn(0);
}

PetscReal CanonWave(const PetscReal x[3], PetscInt direction, PetscReal size, PetscInt j)
{
  return PetscSinReal(CANON_WAVES * (x[0] + 0.71 * x[1] + 0.43 * x[2]) / size * (1 + 0.37 * (PetscReal)j) +
                      2.1 * (PetscReal)direction + 0.9 * (PetscReal)j + 0.3);
}

/* Columns of W as many as the largest cluster has modes */
static PetscErrorCode WavesCreate(Substructure s, Mat like, PetscInt n, const PetscInt node[], Mat *W)
{
  const Mesh  *mesh;
  PetscScalar *w;
  PetscInt     n_own, lda;
  PetscReal    size;

  PetscFunctionBeginUser;
  PetscCall(ModelGetMesh(s->model, &mesh));
  PetscCall(CanonSize(s, &size));
  PetscCall(MatGetLocalSize(like, &n_own, NULL));
  PetscCall(MatCreateDense(s->comm, n_own, PETSC_DECIDE, PETSC_DETERMINE, n, NULL, W));
  PetscCall(MatDenseGetLDA(*W, &lda));
  PetscCall(MatDenseGetArray(*W, &w));
  for (PetscInt j = 0; j < n; j++)
    for (PetscInt k = 0; k < n_own; k++)
      w[(size_t)j * lda + k] = CanonWave(&mesh->x[3 * (node[k] / 3)], node[k] % 3, size, j);
  PetscCall(MatDenseRestoreArray(*W, &w));
  PetscFunctionReturn(0);
}

/* Q of P = Q R [n][n], leading dimension ld, by Gram and Schmidt, twice; in place of P */
static void ClusterTurn(PetscInt n, PetscInt ld, PetscReal P[])
{
  for (PetscInt j = 0; j < n; j++) {
    PetscReal *p = &P[j * ld], square = 0;

    for (PetscInt i = 0; i < 2 * j; i++) {
      const PetscReal *q   = &P[(i % j) * ld];
      PetscReal        dot = 0;

      for (PetscInt k = 0; k < n; k++) dot += q[k] * p[k];
      for (PetscInt k = 0; k < n; k++) p[k] -= dot * q[k];
    }
    for (PetscInt k = 0; k < n; k++) square += p[k] * p[k];
    for (PetscInt k = 0; k < n && square > 0; k++) p[k] /= PetscSqrtReal(square);
  }
}

void CanonTurn(PetscInt n, const PetscReal kappa[], PetscReal P[], PetscReal Q[])
{
  for (PetscInt i = 0; i < n * n; i++) Q[i] = 0;
  for (PetscInt k = 0; k < n; k = ClusterEnd(n, kappa, k)) {
    const PetscInt size = ClusterEnd(n, kappa, k) - k;

    ClusterTurn(size, n, &P[k]);
    for (PetscInt j = 0; j < size; j++)
      for (PetscInt i = 0; i < size; i++) Q[(k + j) * n + k + i] = P[j * n + k + i];
  }
}

/* The vectors as they are found */
static PetscErrorCode MatrixModesCopy(Substructure s, const MatrixModes *modes, Mat *Phi)
{
  PetscInt n_own;
  Mat      M;

  PetscFunctionBeginUser;
  PetscCall(PencilGetMass(modes->pencil, &M));
  PetscCall(MatGetLocalSize(M, &n_own, NULL));
  PetscCall(MatCreateDense(s->comm, n_own, PETSC_DECIDE, PETSC_DETERMINE, modes->n, NULL, Phi));
  for (PetscInt k = 0; k < modes->n; k++) {
    Vec x, column;

    PetscCall(ModesGetVectors(modes->modes, k, &x, NULL, NULL, NULL));
    PetscCall(MatDenseGetColumnVecWrite(*Phi, k, &column));
    PetscCall(VecCopy(x, column));
    PetscCall(MatDenseRestoreColumnVecWrite(*Phi, k, &column));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode MatrixModesTake(Substructure s, const MatrixModes *modes, const PetscInt node[], Mat *Phi)
{
  const PetscInt n = modes->n, widest = CanonWidest(n, modes->kappa);
  PetscReal     *P, *Q;
  Mat            M, found, W, MW;

  PetscFunctionBeginUser;
  PetscCall(MatrixModesCopy(s, modes, &found));
  PetscCall(PencilGetMass(modes->pencil, &M));
  PetscCall(WavesCreate(s, M, widest, node, &W));
  PetscCall(MatDuplicate(W, MAT_DO_NOT_COPY_VALUES, &MW));
  PetscCall(BlockMultiply(M, W, MW));
  PetscCall(PetscMalloc2(n * widest, &P, n * n, &Q));
  PetscCall(BlockGram(found, MW, P));
  CanonTurn(n, modes->kappa, P, Q);
  PetscCall(MatDuplicate(found, MAT_DO_NOT_COPY_VALUES, Phi));
  PetscCall(MatZeroEntries(*Phi));
  PetscCall(BlockAddProduct(1, found, Q, *Phi));
  PetscCall(PetscFree2(P, Q));
  PetscCall(MatDestroy(&W));
  PetscCall(MatDestroy(&MW));
  PetscCall(MatDestroy(&found));
  PetscFunctionReturn(0);
}
