/*
   W = V'R V and Cx = V'R D R V as products: R by the factors of K - s M, the modes taken out of forces and of
   displacements as for the dense matrices (bodies/residual.c). Cm = Phi'D R V is dense: m solutions.
*/
#include "sparse.h"
#include "base/gather.h"

PetscErrorCode SparseForces(ReducedSparse s, const PetscReal p[], Mat B)
{
  const Reduction *r = &s->run->reduction;
  PetscScalar     *value;
  Vec              ports, force;

  PetscFunctionBeginUser;
  PetscCall(MatCreateVecs(r->G, NULL, &ports));
  PetscCall(VecGetArray(ports, &value));
  for (PetscInt i = 0; i < 3 * r->n_local; i++) value[i] = p[3 * r->begin + i];
  PetscCall(VecRestoreArray(ports, &value));
  PetscCall(MatDenseGetColumnVecWrite(B, 0, &force));
  PetscCall(MatMultTranspose(r->G, ports, force));
  PetscCall(MatDenseRestoreColumnVecWrite(B, 0, &force));
  PetscCall(VecDestroy(&ports));
  PetscFunctionReturn(0);
}

/* Pairs are numbered over the ranks in their order, so that rows of all ranks one behind another are those of all */
PetscErrorCode SparseRows(ReducedSparse s, Mat X, PetscReal rows[])
{
  const Reduction   *r = &s->run->reduction;
  const PetscScalar *value;
  PetscInt           n, stride;
  PetscReal         *all;
  Mat                GX;

  PetscFunctionBeginUser;
  PetscCall(MatGetSize(X, NULL, &n));
  PetscCall(MatMatMult(r->G, X, MAT_INITIAL_MATRIX, PETSC_DEFAULT, &GX));
  PetscCall(MatDenseGetLDA(GX, &stride));
  PetscCall(MatDenseGetArrayRead(GX, &value));
  for (PetscInt k = 0; k < n; k++) {
    PetscCall(GatherRecords(s->run->comm, r->n_local, 3 * sizeof(*value), &value[k * stride], NULL, &all));
    PetscCall(PetscArraycpy(&rows[3 * k * r->model.n_pairs], all, 3 * r->model.n_pairs));
    PetscCall(PetscFree(all));
  }
  PetscCall(MatDenseRestoreArrayRead(GX, &value));
  PetscCall(MatDestroy(&GX));
  PetscFunctionReturn(0);
}

/* x -= A (B'x), or A h where h is known: the modes taken out of one column (bodies/residual.c) */
static PetscErrorCode SparseComplement(ReducedSparse s, Mat A, Mat B, const PetscReal known[], Mat X)
{
  const PetscInt     m = s->run->reduction.model.m;
  const PetscScalar *a, *b;
  PetscScalar       *x;
  PetscInt           n, lda, ldb;

  PetscFunctionBeginUser;
  PetscCall(MatGetLocalSize(A, &n, NULL));
  PetscCall(MatDenseGetLDA(A, &lda));
  PetscCall(MatDenseGetLDA(B, &ldb));
  PetscCall(MatDenseGetArrayRead(A, &a));
  PetscCall(MatDenseGetArrayRead(B, &b));
  PetscCall(MatDenseGetArray(X, &x));
  PetscCall(PetscArrayzero(s->h, m));
  if (!known) {
    ReducedBlockTimes(&(DenseBlock){b, n, m, ldb}, PETSC_TRUE, 1, x, s->h);
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, s->h, (PetscMPIInt)m, MPIU_REAL, MPI_SUM, s->run->comm));
  }
  ReducedBlockTimes(&(DenseBlock){a, n, m, lda}, PETSC_FALSE, -1, known ? known : s->h, x);
  PetscCall(MatDenseRestoreArray(X, &x));
  PetscCall(MatDenseRestoreArrayRead(B, &b));
  PetscCall(MatDenseRestoreArrayRead(A, &a));
  PetscFunctionReturn(0);
}

/* X = R B, B overwritten; Phi'B where it is known */
static PetscErrorCode SparseApply(ReducedSparse s, const PetscReal known[], Mat B, Mat X)
{
  Reduction *r = &s->run->reduction;

  PetscFunctionBeginUser;
  PetscCall(SparseComplement(s, r->MPhi, r->Phi, known, B));
  PetscCall(ShiftInvertApplyThrough(&r->inverse, s->Z, B, X));
  PetscCall(SparseComplement(s, r->Phi, r->MPhi, NULL, X));
  PetscFunctionReturn(0);
}

PetscErrorCode SparseTimes(ReducedSparse s, const PetscReal p[], PetscReal Wp[], PetscReal Cxp[])
{
  const ReducedModel *model = &s->run->reduction.model;
  const PetscInt      m = model->m, n = 3 * model->n_pairs;
  Vec                 x, f;

  PetscFunctionBeginUser;
  PetscCall(SparseForces(s, p, s->B));
  PetscCall(PetscArrayzero(s->known, m));
  ReducedBlockTimes(&(DenseBlock){model->P, m, n, m}, PETSC_FALSE, 1, p, s->known);
  PetscCall(SparseApply(s, s->known, s->B, s->X));
  if (Wp) PetscCall(SparseRows(s, s->X, Wp));
  if (!Cxp) PetscFunctionReturn(0);
  PetscCall(MatDenseGetColumnVecRead(s->X, 0, &x));
  PetscCall(MatDenseGetColumnVecWrite(s->B, 0, &f));
  PetscCall(MatMult(s->D, x, f));
  PetscCall(MatDenseRestoreColumnVecWrite(s->B, 0, &f));
  PetscCall(MatDenseRestoreColumnVecRead(s->X, 0, &x));
  PetscCall(SparseApply(s, NULL, s->B, s->X));
  PetscCall(SparseRows(s, s->X, Cxp));
  PetscFunctionReturn(0);
}

/* Stiffness of a pair by the diagonal of K at its nodes, 3 / trace V'diag(K)^-1 V; the mean where a pair is held */
static PetscErrorCode SparseSetStiffness(ReducedSparse s)
{
  const Reduction *r = &s->run->reduction;
  PetscReal       *own, sum      = 0;
  PetscInt         first, n_free = 0;
  Vec              diagonal;
  Mat              G;

  PetscFunctionBeginUser;
  PetscCall(MatCreateVecs(s->base, &diagonal, NULL));
  PetscCall(MatGetDiagonal(s->base, diagonal));
  PetscCall(VecSqrtAbs(diagonal));
  PetscCall(VecReciprocal(diagonal));
  PetscCall(MatDuplicate(s->G, MAT_COPY_VALUES, &G));
  PetscCall(MatDiagonalScale(G, NULL, diagonal));
  PetscCall(MatGetOwnershipRange(G, &first, NULL));
  PetscCall(PetscCalloc1(r->n_local, &own));
  for (PetscInt i = 0; i < 3 * r->n_local; i++) {
    const PetscScalar *value;
    PetscInt           n;

    PetscCall(MatGetRow(G, first + i, &n, NULL, &value));
    for (PetscInt k = 0; k < n; k++) own[i / 3] += PetscSqr(value[k]);
    PetscCall(MatRestoreRow(G, first + i, &n, NULL, &value));
  }
  PetscCall(GatherRecords(s->run->comm, r->n_local, sizeof(*own), own, NULL, &s->kappa));
  for (PetscInt p = 0; p < r->model.n_pairs; p++) {
    if (s->kappa[p] > 0) s->kappa[p] = 3 / s->kappa[p];
    sum += s->kappa[p];
    n_free += s->kappa[p] > 0;
  }
  for (PetscInt p = 0; p < r->model.n_pairs; p++)
    if (s->kappa[p] == 0) s->kappa[p] = n_free ? sum / n_free : 1;
  PetscCall(PetscFree(own));
  PetscCall(MatDestroy(&G));
  PetscCall(VecDestroy(&diagonal));
  PetscFunctionReturn(0);
}

/* Cm = V'R D Phi, m numbers a port */
static PetscErrorCode SparseSetCoupling(ReducedSparse s)
{
  ReducedModel  *model = &s->run->reduction.model;
  const PetscInt n = 3 * model->n_pairs, m = model->m;
  PetscReal     *rows;
  Vec            phi, f;

  PetscFunctionBeginUser;
  if (!s->D) PetscFunctionReturn(0);
  PetscCall(PetscMalloc1(n, &rows));
  PetscCall(PetscMalloc1(n * m, &model->Cm));
  for (PetscInt k = 0; k < m; k++) {
    PetscCall(MatDenseGetColumnVecRead(s->run->reduction.Phi, k, &phi));
    PetscCall(MatDenseGetColumnVecWrite(s->B, 0, &f));
    PetscCall(MatMult(s->D, phi, f));
    PetscCall(MatDenseRestoreColumnVecWrite(s->B, 0, &f));
    PetscCall(MatDenseRestoreColumnVecRead(s->run->reduction.Phi, k, &phi));
    PetscCall(SparseApply(s, NULL, s->B, s->X));
    PetscCall(SparseRows(s, s->X, rows));
    for (PetscInt i = 0; i < n; i++) model->Cm[k + m * i] = rows[i];
  }
  PetscCall(PetscFree(rows));
  PetscFunctionReturn(0);
}

/* Maps, cycles and laws in series need the numbers; the others are few pairs */
PetscErrorCode ReducedIsSparse(ReducedRun r, PetscBool *sparse)
{
  const ContactPair *pair;
  PetscInt           n_local, n;

  PetscFunctionBeginUser;
  PetscCall(ContactGetPairs(r->run.contact, &n_local, &n, &pair));
  *sparse = r->request.steps && !r->request.springs && n > r->request.dense ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(0);
}

PetscErrorCode ReducedSparseCreate(ReducedRun r, PetscReal shift, Mat D)
{
  PencilMatrices pencil;
  PetscInt       n_own;
  ReducedSparse  s;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&s));
  r->reduction.model.sparse = s;
  s->run                    = r;
  s->D                      = D;
  if (D) PetscCall(PetscObjectReference((PetscObject)D)); /* the operators may let go of it */
  PetscCall(PencilGetMatrices(r->reduction.bodies, &pencil));
  PetscCall(OperatorsGetDependents(r->run.operators, &s->Z, NULL));
  if (s->Z) {
    PetscCall(MatMatMult(r->reduction.G, s->Z, MAT_INITIAL_MATRIX, PETSC_DEFAULT, &s->G));
  } else {
    PetscCall(PetscObjectReference((PetscObject)r->reduction.G));
    s->G = r->reduction.G;
  }
  PetscCall(MatDuplicate(pencil.K, MAT_COPY_VALUES, &s->base));
  PetscCall(MatAXPY(s->base, -shift, pencil.M, DIFFERENT_NONZERO_PATTERN));
  PetscCall(MatGetLocalSize(r->reduction.Phi, &n_own, NULL));
  PetscCall(MatCreateDense(r->comm, n_own, PETSC_DECIDE, PETSC_DETERMINE, 1, NULL, &s->B));
  PetscCall(MatDuplicate(s->B, MAT_DO_NOT_COPY_VALUES, &s->X));
  PetscCall(PetscMalloc2(r->reduction.model.m, &s->h, r->reduction.model.m, &s->known));
  PetscCall(SparseSetStiffness(s));
  PetscCall(SparseSetCoupling(s));
  PetscFunctionReturn(0);
}

PetscErrorCode ReducedSparseDestroy(ReducedSparse *sparse)
{
  ReducedSparse s = *sparse;

  PetscFunctionBeginUser;
  if (!s) PetscFunctionReturn(0);
  PetscCall(MatDestroy(&s->D));
  PetscCall(MatDestroy(&s->G));
  PetscCall(MatDestroy(&s->base));
  PetscCall(MatDestroy(&s->B));
  PetscCall(MatDestroy(&s->X));
  PetscCall(PetscFree(s->kappa));
  PetscCall(PetscFree2(s->h, s->known));
  PetscCall(PetscFree(*sparse));
  PetscFunctionReturn(0);
}
