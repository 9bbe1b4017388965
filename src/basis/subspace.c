/*
   The basis of a Galerkin method for right and left vectors together: two bases would make the dense problem
   ill-conditioned. With V'MV = I, or nearly, the pencil

      V'Q(lambda)V = lambda^2 V'MV + lambda V'CV + V'KV

   is kept dense, and grows by a row and a column for each vector: a matrix is never multiplied with a column twice.
*/
#include "subspace.h"
#include "base/events.h"
#include "solver/block/orthonormal.h"

#define SPACE_SYMMETRIC 1e-13 /* of |A x| |y|: less is rounding */

PetscErrorCode SubspaceCreate(Mat like, Mat M, PetscReal loose, Subspace *s)
{
  Vec u;

  PetscFunctionBeginUser;
  *s = (Subspace){.comm = PetscObjectComm((PetscObject)like), .M = M, .loose = loose};
  PetscCall(MatCreateVecs(like, &u, NULL));
  PetscCall(BVCreate(s->comm, &s->V));
  PetscCall(BVSetType(s->V, BVMAT));
  PetscCall(BVSetSizesFromVec(s->V, u, 1));
  PetscCall(VecDestroy(&u));
  PetscFunctionReturn(0);
}

/* Whether A is symmetric, by y'A x = x'A y of two random vectors */
static PetscErrorCode LooksSymmetric(Mat A, PetscBool *symmetric)
{
  PetscReal   yAx, xAy, Ax, y;
  PetscRandom random;
  Vec         v[3];

  PetscFunctionBeginUser;
  PetscCall(MatCreateVecs(A, &v[0], NULL));
  for (int i = 1; i < 3; i++) PetscCall(VecDuplicate(v[0], &v[i]));
  PetscCall(PetscRandomCreate(PetscObjectComm((PetscObject)A), &random));
  for (int i = 0; i < 2; i++) PetscCall(VecSetRandom(v[i], random));
  PetscCall(PetscRandomDestroy(&random));
  PetscCall(MatMult(A, v[0], v[2]));
  PetscCall(VecDot(v[2], v[1], &yAx));
  PetscCall(VecNorm(v[2], NORM_2, &Ax));
  PetscCall(VecNorm(v[1], NORM_2, &y));
  PetscCall(MatMult(A, v[1], v[2]));
  PetscCall(VecDot(v[2], v[0], &xAy));
  *symmetric = PetscAbsReal(yAx - xAy) <= SPACE_SYMMETRIC * Ax * y ? PETSC_TRUE : PETSC_FALSE;
  for (int i = 0; i < 3; i++) PetscCall(VecDestroy(&v[i]));
  PetscFunctionReturn(0);
}

/* A', or A itself where it is symmetric: A'V is asked for beside A V, since V'A V grows by a row and a column */
static PetscErrorCode TermTranspose(SubspaceTerm *term)
{
  PetscFunctionBeginUser;
  if (!term->symmetric) PetscCall(LooksSymmetric(term->A, &term->symmetric));
  if (!term->symmetric) PetscCall(MatTranspose(term->A, MAT_INITIAL_MATRIX, &term->transposed));
  if (!term->symmetric) PetscFunctionReturn(0);
  PetscCall(PetscObjectReference((PetscObject)term->A));
  term->transposed = term->A;
  PetscFunctionReturn(0);
}

PetscErrorCode SubspaceAddTerm(Subspace *s, Mat A, PetscBool symmetric, PetscBool sparse)
{
  SubspaceTerm *term;
  PetscInt      same = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscRealloc(sizeof(*s->term) * (size_t)(s->n_terms + 1), &s->term));
  while (same < s->n_terms && s->term[same].A != A) same++;
  term  = &s->term[s->n_terms];
  *term = (SubspaceTerm){.A = A, .same = same, .symmetric = symmetric};
  if (same < s->n_terms) {
    term->symmetric  = s->term[same].symmetric;
    term->transposed = s->term[same].transposed;
    PetscCall(PetscObjectReference((PetscObject)term->transposed));
  } else if (A) {
    if (sparse) PetscCall(EntryRowsCreate(A, &term->rows));
    if (!term->rows.few) PetscCall(TermTranspose(term));
  }
  PetscCall(PetscObjectReference((PetscObject)A));
  s->n_terms++;
  PetscFunctionReturn(0);
}

/* The rows of a term, and room for what they make of the vectors */
static PetscErrorCode TermSetPairs(MPI_Comm comm, Mat left, Mat right, SubspaceTerm *term)
{
  Vec pairs;

  PetscFunctionBeginUser;
  term->left  = left;
  term->right = right;
  PetscCall(MatCreateVecs(left, NULL, &pairs));
  for (int i = 0; i < 2; i++) {
    PetscCall(BVCreate(comm, &term->image[i]));
    PetscCall(BVSetType(term->image[i], BVMAT));
    PetscCall(BVSetSizesFromVec(term->image[i], pairs, 1));
  }
  PetscCall(VecDestroy(&pairs));
  PetscFunctionReturn(0);
}

PetscErrorCode SubspaceAddProduct(Subspace *s, Mat A, Mat left, Mat right)
{
  SubspaceTerm *term;
  PetscInt      same = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscRealloc(sizeof(*s->term) * (size_t)(s->n_terms + 1), &s->term));
  while (same < s->n_terms && s->term[same].A != A) same++;
  term  = &s->term[s->n_terms];
  *term = (SubspaceTerm){.A = A, .same = same, .product = PETSC_TRUE};
  PetscCall(PetscObjectReference((PetscObject)A));
  if (same == s->n_terms) {
    PetscCall(EntryRowsCreate(A, &term->rows));
    PetscCall(TermSetPairs(s->comm, left, right, term));
  }
  s->n_terms++;
  PetscFunctionReturn(0);
}

PetscErrorCode SubspaceAddPencil(Subspace *s, const PencilMatrices *pencil)
{

  PetscFunctionBeginUser;
  PetscCall(
    SubspaceAddTerm(s, pencil->left ? pencil->K_even : pencil->K, pencil->symmetric || pencil->left, PETSC_FALSE));
  PetscCall(SubspaceAddTerm(s, pencil->C, pencil->symmetric, PETSC_FALSE));
  PetscCall(SubspaceAddTerm(s, pencil->M, pencil->symmetric, PETSC_FALSE));
  s->n_laws = pencil->n_laws;
  PetscCall(PetscCalloc1(s->n_laws, &s->law));
  PetscCall(PetscCalloc1(s->n_laws, &s->turned));
  for (PetscInt i = 0; i < s->n_laws; i++) {
    s->law[i].law = &pencil->law[i];
    PetscCall(SubspaceAddTerm(s, pencil->law[i].A, pencil->law[i].symmetric, PETSC_FALSE));
    s->turned[i]   = pencil->law[i];
    s->turned[i].A = s->term[SUBSPACE_PENCIL + i].transposed;
  }
  if (!pencil->left) PetscFunctionReturn(0);
  PetscCall(TermSetPairs(s->comm, pencil->left, pencil->right, &s->term[SUBSPACE_K]));
  PetscFunctionReturn(0);
}

/* The block W by what it holds beyond V, W - V V'M W, orthonormal: V'W = 0, W'W = I in M */
static PetscErrorCode SubspaceOrthonormalise(Subspace *s, PetscReal drop, BV block)
{
  BlockFactors factors = {.drop = drop, .loose = s->loose};

  PetscFunctionBeginUser;
  if (s->loose == 0) {
    PetscCall(BlockOrthonormalise(s->V, s->n, s->M, drop, block));
    PetscFunctionReturn(0);
  }
  if (s->n) factors.gram = s->term[SUBSPACE_M].small;
  PetscCall(BVGetActiveColumns(block, NULL, &factors.most));
  factors.ld = s->n + factors.most;
  PetscCall(PetscMalloc1(factors.ld * factors.most, &factors.H));
  PetscCall(BlockFactorise(s->V, s->n, s->M, block, &factors));
  PetscCall(PetscFree(factors.H));
  PetscFunctionReturn(0);
}

PetscErrorCode SubspaceAdd(Subspace *s, PetscReal drop, BV block, PetscInt *n_added)
{
  PetscInt n, n_all;

  PetscFunctionBeginUser;
  PetscCall(EventBegin(EVENT_ORTHOGONALISE));
  PetscCall(SubspaceOrthonormalise(s, drop, block));
  PetscCall(BVGetActiveColumns(block, NULL, &n));
  PetscCall(BVGetSizes(s->V, NULL, &n_all, NULL));
  n = PetscMin(n, n_all - s->n); /* there are no more directions */
  PetscCall(BVSetActiveColumns(block, 0, n));
  if (n) {
    PetscCall(SubspaceAppend(s->n, s->room, block, s->V));
    PetscCall(SubspaceExtend(s, block));
  }
  if (n_added) *n_added = n;
  PetscCall(EventEnd(EVENT_ORTHOGONALISE));
  PetscFunctionReturn(0);
}

PetscErrorCode SubspaceExtend(Subspace *s, BV block)
{
  PetscInt m;

  PetscFunctionBeginUser;
  PetscCall(BVGetActiveColumns(block, NULL, &m));
  PetscCall(BVSetActiveColumns(s->V, 0, s->n + m));
  PetscCall(SubspaceTermsExtend(s, s->n + m, block));
  s->n += m;
  PetscFunctionReturn(0);
}

/* The dense matrices are column-major with as many rows as there are columns of V: those of a leading part move
   together, column by column, from the front. */
PetscErrorCode SubspaceTruncate(Subspace *s, PetscInt n)
{
  PetscFunctionBeginUser;
  for (PetscInt t = 0; t < s->n_terms; t++) {
    SubspaceTerm *term = &s->term[t];

    if (!term->small) continue;
    for (PetscInt j = 1; j < n; j++) PetscCall(PetscArraymove(&term->small[j * n], &term->small[j * s->n], n));
    PetscCall(PetscRealloc(sizeof(PetscReal) * (size_t)(n * n), &term->small));
    for (int i = 0; i < 2 && term->left; i++) PetscCall(BVResize(term->image[i], PetscMax(n, 1), PETSC_TRUE));
  }
  s->n = n;
  PetscCall(BVResize(s->V, PetscMax(n, 1), PETSC_TRUE));
  PetscCall(BVSetActiveColumns(s->V, 0, n));
  PetscFunctionReturn(0);
}

DensePencil SubspacePencil(const Subspace *s)
{
  const SubspaceTerm *term = s->term;

  for (PetscInt i = 0; i < s->n_laws; i++) s->law[i].A = term[SUBSPACE_PENCIL + i].small;
  return (DensePencil){.n      = s->n,
                       .damped = term[SUBSPACE_C].A ? PETSC_TRUE : PETSC_FALSE,
                       .K      = term[SUBSPACE_K].small,
                       .C      = term[SUBSPACE_C].small,
                       .M      = term[SUBSPACE_M].small,
                       .n_laws = s->n_laws,
                       .law    = s->law};
}

PetscErrorCode SubspaceDestroy(Subspace *s)
{
  PetscFunctionBeginUser;
  for (PetscInt t = 0; t < s->n_terms; t++) {
    SubspaceTerm *term = &s->term[t];

    PetscCall(MatDestroy(&term->A));
    PetscCall(MatDestroy(&term->transposed));
    for (int i = 0; i < 2; i++) PetscCall(BVDestroy(&term->image[i]));
    PetscCall(EntryRowsDestroy(&term->rows));
    for (int i = 0; i < 2; i++) PetscCall(PetscFree(term->factor[i]));
    PetscCall(PetscFree(term->small));
  }
  PetscCall(PetscFree(s->term));
  PetscCall(PetscFree(s->law));
  PetscCall(PetscFree(s->turned));
  PetscCall(BVDestroy(&s->V));
  s->n = s->n_terms = 0;
  PetscFunctionReturn(0);
}
