/*
   The reduced basis. Blocks of vectors are made orthonormal in M; the dense model V' A_t V is extended by the rows and
   columns of the new vectors.
*/
#include "basis.h"
#include "base/events.h"
#include "solver/orthonormal.h"

PetscErrorCode BasisCreate(MPI_Comm comm, Pencil pencil, Basis *basis)
{
  PencilMatrices frictionless;
  Vec            u;

  PetscFunctionBeginUser;
  PetscCall(PetscMemzero(basis, sizeof(*basis)));
  basis->comm   = comm;
  basis->pencil = pencil;
  PetscCall(PencilGetFrictionless(pencil, &frictionless));
  PetscCall(MatDuplicate(frictionless.M, MAT_COPY_VALUES, &basis->M));
  PetscCall(MatSetOption(basis->M, MAT_SYMMETRIC, PETSC_TRUE));
  PetscCall(MatCreateVecs(basis->M, &u, NULL));
  PetscCall(BVCreate(comm, &basis->vectors));
  PetscCall(BVSetType(basis->vectors, BVMAT));
  PetscCall(BVSetSizesFromVec(basis->vectors, u, 1));
  PetscCall(VecDestroy(&u));
  PetscCall(PencilGetParameters(pencil, &basis->reduced.n_parameters, NULL, NULL));
  PetscCall(PencilGetTerms(pencil, &basis->reduced.n_terms, &basis->reduced.term));
  PetscCall(PetscCalloc1(basis->reduced.n_terms, &basis->reduced.A));
  PetscCall(PetscCalloc1(basis->reduced.n_terms, &basis->reduced.D));
  PetscFunctionReturn(0);
}

PetscErrorCode BasisCreateBlock(const Basis *basis, PetscInt n, BV *block)
{
  PetscFunctionBeginUser;
  PetscCall(BVDuplicateResize(basis->vectors, n, block));
  PetscCall(BVSetActiveColumns(*block, 0, n));
  PetscFunctionReturn(0);
}

/* One V' |diag A| V, extended likewise */
static PetscErrorCode DiagonalExtend(const Basis *basis, const OperatorsTerm *term, BV block, PetscInt first,
                                     PetscInt n, PetscReal **reduced)
{
  BV  scaled;
  Mat H;
  Vec diagonal;

  PetscFunctionBeginUser;
  PetscCall(BlockGrow(first, n, reduced));
  PetscCall(MatCreateVecs(term->A, &diagonal, NULL));
  PetscCall(MatGetDiagonal(term->A, diagonal));
  PetscCall(VecAbs(diagonal));
  PetscCall(BVDuplicateResize(block, n - first, &scaled));
  PetscCall(BVCopy(block, scaled));
  PetscCall(BVGetMat(scaled, &H));
  PetscCall(MatDiagonalScale(H, diagonal, NULL));
  PetscCall(BVRestoreMat(scaled, &H));
  PetscCall(BlockProducts(basis->vectors, NULL, scaled, &H));
  PetscCall(BlockCopy(H, PETSC_FALSE, n, *reduced + first * n));
  PetscCall(BlockCopy(H, PETSC_TRUE, n, *reduced + first));
  PetscCall(MatDestroy(&H));
  PetscCall(BVDestroy(&scaled));
  PetscCall(VecDestroy(&diagonal));
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
      PetscCall(BlockExtend(basis->vectors, r->term[t].A, r->term[t].symmetric, block, first, &r->A[t]));
    }
    if (r->term[t].kind == OPERATORS_STIFFNESS)
      PetscCall(DiagonalExtend(basis, &r->term[t], block, first, n, &r->D[t]));
  }
  r->n = n;
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

    PetscCall(BasisCreateBlock(basis, n - first, &block));
    PetscCall(BVSetActiveColumns(basis->vectors, first, n));
    PetscCall(BVCopy(basis->vectors, block));
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
  }
  PetscCall(PetscFree(basis->reduced.A));
  PetscCall(PetscFree(basis->reduced.D));
  PetscCall(BVDestroy(&basis->vectors));
  PetscCall(MatDestroy(&basis->M));
  PetscFunctionReturn(0);
}
