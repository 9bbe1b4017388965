/*
   The reduced basis. Blocks of vectors are made orthonormal in M; the dense model V' A_t V is extended by the rows and
   columns of the new vectors.
*/
#include "basis.h"
#include "base/events.h"
#include "solver/block/orthonormal.h"
#include "solver/factor/shiftinvert.h"

PetscErrorCode BasisCreate(MPI_Comm comm, Pencil pencil, Basis *basis)
{
  PencilMatrices frictionless;
  PetscBool      singular;
  Vec            u;

  PetscFunctionBeginUser;
  PetscCall(PetscMemzero(basis, sizeof(*basis)));
  basis->comm   = comm;
  basis->pencil = pencil;
  PetscCall(PencilGetFrictionless(pencil, &frictionless));
  PetscCall(MassIsSingular(&frictionless, &singular)); /* of which vectors orthonormal in M hold nothing */
  PetscCheck(
    !singular, comm, PETSC_ERR_SUP,
    "unknowns or directions have no mass (multipliers, nodes without inertia, a mass of fewer points): sweeps on a basis "
    "are not offered with them; give -sweep_method full");
  PetscCall(MatDuplicate(frictionless.M, MAT_COPY_VALUES, &basis->M));
  PetscCall(MatSetOption(basis->M, MAT_SYMMETRIC, PETSC_TRUE));
  PetscCall(MatCreateVecs(basis->M, &u, NULL));
  PetscCall(BVCreate(comm, &basis->vectors));
  PetscCall(BVSetType(basis->vectors, BVMAT));
  PetscCall(BVSetSizesFromVec(basis->vectors, u, 1));
  PetscCall(VecDestroy(&u));
  PetscCall(PencilGetParameters(pencil, &basis->reduced.n_parameters, &basis->reduced.parameter, NULL));
  PetscCall(PencilGetTerms(pencil, &basis->reduced.n_terms, &basis->reduced.term));
  PetscCall(PetscCalloc1(basis->reduced.n_terms, &basis->reduced.A));
  PetscCall(PetscCalloc1(basis->reduced.n_terms, &basis->reduced.D));
  PetscCall(PetscCalloc1(basis->reduced.n_terms, &basis->rows));
  PetscFunctionReturn(0);
}

PetscErrorCode BasisCreateBlock(const Basis *basis, PetscInt n, BV *block)
{
  PetscFunctionBeginUser;
  PetscCall(BlockCreate(basis->vectors, n, block));
  PetscFunctionReturn(0);
}

/* The rows of a term, found when it is first asked for */
static PetscErrorCode BasisGetEntryRows(Basis *basis, PetscInt t, const EntryRows **rows)
{
  PetscFunctionBeginUser;
  if (!basis->rows[t].made) PetscCall(EntryRowsCreate(basis->reduced.term[t].A, &basis->rows[t]));
  *rows = &basis->rows[t];
  PetscFunctionReturn(0);
}

/* One V' |diag A| V, extended likewise */
static PetscErrorCode DiagonalExtend(Basis *basis, PetscInt t, BV block, PetscInt first, PetscInt n)
{
  PetscReal      **reduced = &basis->reduced.D[t];
  const EntryRows *rows;
  Mat              H;
  Vec              diagonal;

  PetscFunctionBeginUser;
  PetscCall(BasisGetEntryRows(basis, t, &rows));
  PetscCall(BlockGrow(first, n, reduced));
  PetscCall(MatCreateVecs(basis->reduced.term[t].A, &diagonal, NULL));
  PetscCall(MatGetDiagonal(basis->reduced.term[t].A, diagonal));
  PetscCall(VecAbs(diagonal));
  PetscCall(EntryRowsProducts(rows, basis->vectors, diagonal, block, &H));
  PetscCall(BlockCopy(H, PETSC_FALSE, n, *reduced + first * n));
  PetscCall(BlockCopy(H, PETSC_TRUE, n, *reduced + first));
  PetscCall(MatDestroy(&H));
  PetscCall(VecDestroy(&diagonal));
  PetscFunctionReturn(0);
}

/* H = X' A Y for the active columns, A with few rows */
static PetscErrorCode TermProducts(const EntryRows *rows, BV X, Mat A, BV Y, Mat *H)
{
  PetscInt n;
  BV       AY;

  PetscFunctionBeginUser;
  PetscCall(BVGetActiveColumns(Y, NULL, &n));
  PetscCall(BVDuplicateResize(Y, n, &AY));
  PetscCall(BlockMultiplyVectors(A, Y, AY));
  PetscCall(EntryRowsProducts(rows, X, NULL, AY, H));
  PetscCall(BVDestroy(&AY));
  PetscFunctionReturn(0);
}

/* One V' A V, extended by the columns of the block, the last ones of V */
static PetscErrorCode TermExtend(Basis *basis, PetscInt t, BV block, PetscInt first, PetscInt n)
{
  const OperatorsTerm *term    = &basis->reduced.term[t];
  PetscReal          **reduced = &basis->reduced.A[t];
  const EntryRows     *rows;
  Mat                  H;

  PetscFunctionBeginUser;
  PetscCall(BasisGetEntryRows(basis, t, &rows));
  if (!rows->few) {
    PetscCall(BlockExtend(basis->vectors, term->A, term->symmetric, block, first, reduced));
    PetscFunctionReturn(0);
  }
  PetscCall(BlockGrow(first, n, reduced));
  PetscCall(TermProducts(rows, basis->vectors, term->A, block, &H));
  PetscCall(BlockCopy(H, PETSC_FALSE, n, *reduced + first * n));
  if (term->symmetric) {
    PetscCall(BlockCopy(H, PETSC_TRUE, n, *reduced + first));
  } else { /* its products with all of V cost little */
    PetscCall(MatDestroy(&H));
    PetscCall(TermProducts(rows, block, term->A, basis->vectors, &H));
    PetscCall(BlockCopy(H, PETSC_FALSE, n, *reduced + first));
  }
  PetscCall(MatDestroy(&H));
  PetscFunctionReturn(0);
}

/* The first term with this matrix: damping shares those of stiffness and mass */
static PetscInt TermWithMatrix(const Reduced *r, Mat A)
{
  PetscInt t = 0;

  while (r->term[t].A != A) t++;
  return t;
}

/* Every V' A_t V, extended by the columns of the block */
static PetscErrorCode ReducedExtend(Basis *basis, BV block)
{
  Reduced *r     = &basis->reduced;
  PetscInt first = r->n, n;

  PetscFunctionBeginUser;
  PetscCall(BVGetActiveColumns(block, NULL, &n));
  n += first;
  PetscCall(BVSetActiveColumns(basis->vectors, 0, n));
  for (PetscInt t = 0; t < r->n_terms; t++) {
    const PetscInt same = TermWithMatrix(r, r->term[t].A);

    if (same < t) {
      PetscCall(BlockGrow(first, n, &r->A[t]));
      PetscCall(PetscArraycpy(r->A[t], r->A[same], n * n));
    } else {
      PetscCall(TermExtend(basis, t, block, first, n));
    }
  }
  r->n = n;
  PetscFunctionReturn(0);
}

/* The vectors first to n - 1 in a block of their own; all n are active then */
static PetscErrorCode BasisCopyBlock(Basis *basis, PetscInt first, PetscInt n, BV *block)
{
  PetscFunctionBeginUser;
  PetscCall(BasisCreateBlock(basis, n - first, block));
  PetscCall(BVSetActiveColumns(basis->vectors, first, n));
  PetscCall(BVCopy(basis->vectors, *block));
  PetscCall(BVSetActiveColumns(basis->vectors, 0, n));
  PetscFunctionReturn(0);
}

/* The diagonals of vectors first to n - 1 */
static PetscErrorCode DiagonalsExtend(Basis *basis, PetscInt first, PetscInt n)
{
  const Reduced *r = &basis->reduced;
  BV             block;

  PetscFunctionBeginUser;
  PetscCall(BasisCopyBlock(basis, first, n, &block));
  for (PetscInt t = 0; t < r->n_terms; t++)
    if (r->term[t].kind == OPERATORS_STIFFNESS) PetscCall(DiagonalExtend(basis, t, block, first, n));
  PetscCall(BVDestroy(&block));
  PetscFunctionReturn(0);
}

PetscErrorCode BasisUse(Basis *basis, PetscInt n)
{
  Reduced *r = &basis->reduced;

  PetscFunctionBeginUser;
  if (n <= r->n_used) PetscFunctionReturn(0);
  PetscCall(EventBegin(EVENT_ORTHOGONALISE));
  for (PetscInt b = 0; r->n_used < n; b++) { /* in the blocks of BasisAdd(), so that a restart has the same sums */
    const PetscInt first = r->n_used;

    if (basis->block_end[b] <= first) continue;
    r->n_used = PetscMin(n, basis->block_end[b]);
    PetscCall(DiagonalsExtend(basis, first, r->n_used));
  }
  PetscCall(BVSetActiveColumns(basis->vectors, 0, r->n));
  PetscCall(EventEnd(EVENT_ORTHOGONALISE));
  PetscFunctionReturn(0);
}

/* The leading block n x n of an old one, first x first */
static PetscErrorCode BlockShrink(PetscInt first, PetscInt n, PetscReal **A)
{
  PetscFunctionBeginUser;
  for (PetscInt j = 1; j < n; j++) PetscCall(PetscArraymove(&(*A)[j * n], &(*A)[j * first], n));
  PetscCall(PetscRealloc(sizeof(PetscReal) * (size_t)(n * n), A));
  PetscFunctionReturn(0);
}

PetscErrorCode BasisTruncate(Basis *basis)
{
  Reduced *r = &basis->reduced;

  PetscFunctionBeginUser;
  for (PetscInt t = 0; t < r->n_terms; t++) PetscCall(BlockShrink(r->n, r->n_used, &r->A[t]));
  r->n = r->n_used;
  while (basis->n_blocks > 1 && basis->block_end[basis->n_blocks - 2] >= r->n) basis->n_blocks--;
  basis->block_end[basis->n_blocks - 1] = r->n;
  PetscCall(BVResize(basis->vectors, r->n, PETSC_TRUE));
  PetscFunctionReturn(0);
}

PetscErrorCode BasisAdd(Basis *basis, BV block, PetscReal drop, PetscInt *n_added)
{
  const PetscInt first = basis->reduced.n;
  PetscInt       n;

  PetscFunctionBeginUser;
  PetscCall(EventBegin(EVENT_ORTHOGONALISE));
  PetscCall(BlockOrthonormalise(basis->vectors, first, basis->M, drop, block));
  PetscCall(BVGetActiveColumns(block, NULL, &n));
  if (n) {
    PetscCall(BVResize(basis->vectors, first + n, PETSC_TRUE));
    PetscCall(BVSetActiveColumns(basis->vectors, first, first + n));
    PetscCall(BVCopy(block, basis->vectors));
    PetscCall(ReducedExtend(basis, block));
    PetscCheck(basis->n_blocks < BASIS_MAX_BLOCKS, basis->comm, PETSC_ERR_PLIB, "too many blocks of vectors");
    basis->block_end[basis->n_blocks++] = first + n;
  }
  if (n_added) *n_added = n;
  PetscCall(EventEnd(EVENT_ORTHOGONALISE));
  PetscFunctionReturn(0);
}

PetscErrorCode BasisRebuild(Basis *basis, PetscInt n_blocks)
{
  PetscFunctionBeginUser;
  for (; basis->n_blocks < n_blocks; basis->n_blocks++) {
    const PetscInt first = basis->reduced.n, n = basis->block_end[basis->n_blocks];
    BV             block;

    PetscCall(BasisCopyBlock(basis, first, n, &block));
    PetscCall(ReducedExtend(basis, block));
    PetscCall(BVDestroy(&block));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode BasisLift(const Basis *basis, PetscInt size, PetscInt m, const PetscReal coordinates[], BV block)
{
  PetscFunctionBeginUser;
  PetscCall(BlockLift(basis->vectors, size, m, coordinates, block));
  PetscCall(BVSetActiveColumns(basis->vectors, 0, basis->reduced.n));
  PetscFunctionReturn(0);
}

PetscErrorCode BasisDestroy(Basis *basis)
{
  PetscFunctionBeginUser;
  for (PetscInt t = 0; t < basis->reduced.n_terms && basis->reduced.A; t++) {
    PetscCall(PetscFree(basis->reduced.A[t]));
    PetscCall(PetscFree(basis->reduced.D[t]));
    PetscCall(EntryRowsDestroy(&basis->rows[t]));
  }
  PetscCall(PetscFree(basis->rows));
  PetscCall(PetscFree(basis->reduced.A));
  PetscCall(PetscFree(basis->reduced.D));
  PetscCall(BVDestroy(&basis->vectors));
  PetscCall(MatDestroy(&basis->M));
  PetscFunctionReturn(0);
}
