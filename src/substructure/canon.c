/*
   Modes in a basis that neither ranks nor rounding choose. Vectors of one eigenvalue may be turned into each other, and
   each may have either sign. Phi of a cluster becomes Phi Q, where Phi'M W = Q R, R upper triangular with a positive
   diagonal; W has values that depend on the places of the nodes alone.
*/
#include "substructureimpl.h"
#include "base/algebra/gram.h"
#include "base/algebra/product.h"

#define CANON_CLOSE 1e-6 /* of kappa: modes nearer to each other are of a cluster */
#define CANON_WAVES 5    /* some waves in the size of the mesh: no symmetry of a body is theirs */

/* End of the cluster that begins at mode k */
static PetscInt ClusterEnd(const MatrixModes *modes, PetscInt k)
{
  PetscInt end = k + 1;

  while (end < modes->n && modes->kappa[end] - modes->kappa[end - 1] <= CANON_CLOSE * modes->kappa[end]) end++;
  return end;
}

/* Columns of W as many as the largest cluster has modes */
static PetscErrorCode WavesCreate(Substructure s, Mat like, PetscInt n, const PetscInt node[], Mat *W)
{
  const Mesh  *mesh;
  PetscScalar *w;
  PetscInt     n_own, lda;
  PetscReal    size = 0;

  PetscFunctionBeginUser;
  PetscCall(ModelGetMesh(s->model, &mesh));
  for (PetscInt i = 0; i < 3 * mesh->n_nodes; i++) size = PetscMax(size, PetscAbsReal(mesh->x[i]));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &size, 1, MPIU_REAL, MPI_MAX, s->comm));
  PetscCall(MatGetLocalSize(like, &n_own, NULL));
  PetscCall(MatCreateDense(s->comm, n_own, PETSC_DECIDE, PETSC_DETERMINE, n, NULL, W));
  PetscCall(MatDenseGetLDA(*W, &lda));
  PetscCall(MatDenseGetArray(*W, &w));
  for (PetscInt j = 0; j < n; j++)
    for (PetscInt k = 0; k < n_own; k++) {
      const PetscReal *x = &mesh->x[3 * (node[k] / 3)];

      w[(size_t)j * lda + k] = PetscSinReal(CANON_WAVES * (x[0] + 0.71 * x[1] + 0.43 * x[2]) / size * (1 + 0.37 * j) +
                                            2.1 * (node[k] % 3) + 0.9 * j + 0.3);
    }
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
  PetscInt   widest = 0, n = modes->n;
  PetscReal *P, *Q;
  Mat        M, found, W, MW;

  PetscFunctionBeginUser;
  PetscCall(MatrixModesCopy(s, modes, &found));
  PetscCall(PencilGetMass(modes->pencil, &M));
  for (PetscInt k = 0; k < n; k = ClusterEnd(modes, k)) widest = PetscMax(widest, ClusterEnd(modes, k) - k);
  PetscCall(WavesCreate(s, M, widest, node, &W));
  PetscCall(MatDuplicate(W, MAT_DO_NOT_COPY_VALUES, &MW));
  PetscCall(BlockMultiply(M, W, MW));
  PetscCall(PetscMalloc1(n * widest, &P));
  PetscCall(PetscCalloc1(n * n, &Q));
  PetscCall(BlockGram(found, MW, P));
  for (PetscInt k = 0; k < n; k = ClusterEnd(modes, k)) {
    const PetscInt size = ClusterEnd(modes, k) - k;

    ClusterTurn(size, n, &P[k]);
    for (PetscInt j = 0; j < size; j++)
      for (PetscInt i = 0; i < size; i++) Q[(k + j) * n + k + i] = P[j * n + k + i];
  }
  PetscCall(MatDuplicate(found, MAT_DO_NOT_COPY_VALUES, Phi));
  PetscCall(MatZeroEntries(*Phi));
  PetscCall(BlockAddProduct(1, found, Q, *Phi));
  PetscCall(PetscFree(P));
  PetscCall(PetscFree(Q));
  PetscCall(MatDestroy(&W));
  PetscCall(MatDestroy(&MW));
  PetscCall(MatDestroy(&found));
  PetscFunctionReturn(0);
}
