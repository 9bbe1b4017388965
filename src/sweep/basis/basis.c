/*
   The reduced basis: V [unknowns][n], V' M V = I with M (kg, frictionless) of the pencil's parameters when it was
   made. The first n_used vectors make the model, A_t -> V' A_t V for every term t of the pencil, in the unit of the
   term over kg; the others tell its error (dense/estimate.c). D_t = V' |diag A_t| V of the stiffness terms tells
   what rounding in them does (dense/rounding.c).
*/
#include "basis.h"
#include "base/events.h"
#include "solver/block/orthonormal.h"
#include "solver/factor/shiftinvert.h"

/* M is singular where there are unknowns without mass, along which no vector has a length. The terms keep the order
   of the pencil, so that reduced.A[t] belongs to term[t] for good. */
PetscErrorCode BasisCreate(MPI_Comm comm, Pencil pencil, Basis *basis)
{
  PencilMatrices frictionless;
  PetscBool      singular;

  PetscFunctionBeginUser;
  PetscCall(PetscMemzero(basis, sizeof(*basis)));
  basis->comm   = comm;
  basis->pencil = pencil;
  PetscCall(PencilGetFrictionless(pencil, &frictionless));
  PetscCall(MassIsSingular(&frictionless, &singular)); /* of which vectors orthonormal in M hold nothing */
  PetscCheck(!singular, comm, PETSC_ERR_SUP,
             "unknowns or directions have no mass (multipliers, nodes without inertia, a mass of fewer points): sweeps "
             "on a basis "
             "are not offered with them; give -sweep_method full");
  PetscCall(MatDuplicate(frictionless.M, MAT_COPY_VALUES, &basis->M));
  PetscCall(MatSetOption(basis->M, MAT_SYMMETRIC, PETSC_TRUE));
  PetscCall(SubspaceCreate(basis->M, basis->M, 0, &basis->space));
  PetscCall(PencilGetParameters(pencil, &basis->reduced.n_parameters, &basis->reduced.parameter, NULL));
  PetscCall(PencilGetTerms(pencil, &basis->reduced.n_terms, &basis->reduced.term));
  PetscCall(PetscCalloc1(basis->reduced.n_terms, &basis->reduced.A));
  PetscCall(PetscCalloc1(basis->reduced.n_terms, &basis->reduced.factors));
  PetscCall(PetscCalloc1(basis->reduced.n_terms, &basis->reduced.D));
  for (PetscInt t = 0; t < basis->reduced.n_terms; t++) {
    const OperatorsTerm *term = &basis->reduced.term[t];

    if (term->left)
      PetscCall(SubspaceAddProduct(&basis->space, term->A, term->left, term->right));
    else
      PetscCall(SubspaceAddTerm(&basis->space, term->A, term->symmetric, PETSC_TRUE));
  }
  PetscFunctionReturn(0);
}

/* H += V' |diag A_t| block, NULL at first */
static PetscErrorCode DiagonalAdd(Basis *basis, PetscInt t, BV block, Mat *H)
{
  const EntryRows *rows = &basis->space.term[basis->space.term[t].same].rows;
  Mat              own;
  Vec              diagonal;

  PetscFunctionBeginUser;
  PetscCall(MatCreateVecs(basis->reduced.term[t].A, &diagonal, NULL));
  PetscCall(MatGetDiagonal(basis->reduced.term[t].A, diagonal));
  PetscCall(VecAbs(diagonal));
  PetscCall(EntryRowsProducts(rows, basis->space.V, diagonal, block, &own));
  PetscCall(VecDestroy(&diagonal));
  if (*H) {
    PetscCall(MatAXPY(*H, 1, own, SAME_NONZERO_PATTERN));
    PetscCall(MatDestroy(&own));
  } else {
    *H = own;
  }
  PetscFunctionReturn(0);
}

/* V' |diag A| V of term t and of all that share its D, [n][n] by columns, extended by the block of vectors first to n -
   1: H = V' |diag A| block gives the last columns, and, transposed, the last rows. A diagonal matrix is symmetric
   between any vectors. */
static PetscErrorCode DiagonalExtend(Basis *basis, PetscInt t, BV block, PetscInt first, PetscInt n)
{
  PetscReal **reduced = &basis->reduced.D[t];
  Mat         H       = NULL;

  PetscFunctionBeginUser;
  PetscCall(BlockGrow(first, n, reduced));
  for (PetscInt s = t; s < basis->reduced.n_terms; s++)
    if (RoundingTerm(&basis->reduced, s) == t) PetscCall(DiagonalAdd(basis, s, block, &H));
  PetscCall(BlockCopy(H, PETSC_FALSE, n, *reduced + first * n));
  PetscCall(BlockCopy(H, PETSC_TRUE, n, *reduced + first));
  PetscCall(MatDestroy(&H));
  PetscFunctionReturn(0);
}

/* The model on the vectors that there are */
static void BasisFollow(Basis *basis)
{
  Reduced *r = &basis->reduced;

  for (PetscInt t = 0; t < r->n_terms; t++) {
    const SubspaceTerm *term = &basis->space.term[basis->space.term[t].same];

    r->A[t]       = basis->space.term[t].small;
    r->factors[t] = (ReducedFactors){term->rank, term->factor[0], term->factor[1]};
  }
  r->n = basis->space.n;
}

/* The vectors first to n - 1 in a block of their own; all n are active then. A copy, since products of a BV with a
   part of itself would need both parts active at once. */
static PetscErrorCode BasisCopyBlock(Basis *basis, PetscInt first, PetscInt n, BV *block)
{
  PetscFunctionBeginUser;
  PetscCall(BlockCreate(basis->space.V, n - first, block));
  PetscCall(BVSetActiveColumns(basis->space.V, first, n));
  PetscCall(BVCopy(basis->space.V, *block));
  PetscCall(BVSetActiveColumns(basis->space.V, 0, n));
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
    if (r->term[t].kind == OPERATORS_STIFFNESS && RoundingTerm(r, t) == t)
      PetscCall(DiagonalExtend(basis, t, block, first, n));
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
  PetscCall(BVSetActiveColumns(basis->space.V, 0, r->n));
  PetscCall(EventEnd(EVENT_ORTHOGONALISE));
  PetscFunctionReturn(0);
}

/* The ends of blocks stay those of what is left: the last block ends at n. */
PetscErrorCode BasisTruncate(Basis *basis)
{
  Reduced *r = &basis->reduced;

  PetscFunctionBeginUser;
  PetscCall(SubspaceTruncate(&basis->space, r->n_used));
  BasisFollow(basis);
  while (basis->n_blocks > 1 && basis->block_end[basis->n_blocks - 2] >= r->n) basis->n_blocks--;
  basis->block_end[basis->n_blocks - 1] = r->n;
  PetscFunctionReturn(0);
}

/* n_added <= columns of the block: what V holds already, or what is shorter than drop in M, adds nothing. Every
   block that added something is noted, so that a restart repeats the same sums. */
PetscErrorCode BasisAdd(Basis *basis, BV block, PetscReal drop, PetscInt *n_added)
{
  PetscInt n;

  PetscFunctionBeginUser;
  PetscCall(SubspaceAdd(&basis->space, drop, block, &n));
  BasisFollow(basis);
  PetscCheck(basis->n_blocks < BASIS_MAX_BLOCKS, basis->comm, PETSC_ERR_PLIB, "too many blocks of vectors");
  if (n) basis->block_end[basis->n_blocks++] = basis->space.n;
  if (n_added) *n_added = n;
  PetscFunctionReturn(0);
}

PetscErrorCode BasisRebuild(Basis *basis, PetscInt n_blocks)
{
  PetscFunctionBeginUser;
  for (; basis->n_blocks < n_blocks; basis->n_blocks++) {
    const PetscInt first = basis->reduced.n, n = basis->block_end[basis->n_blocks];
    BV             block;

    PetscCall(BasisCopyBlock(basis, first, n, &block));
    PetscCall(SubspaceExtend(&basis->space, block));
    BasisFollow(basis);
    PetscCall(BVDestroy(&block));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode BasisLift(const Basis *basis, PetscInt size, PetscInt m, const PetscReal coordinates[], BV block)
{
  PetscFunctionBeginUser;
  PetscCall(BlockLift(basis->space.V, size, m, coordinates, block));
  PetscCall(BVSetActiveColumns(basis->space.V, 0, basis->reduced.n));
  PetscFunctionReturn(0);
}

PetscErrorCode BasisDestroy(Basis *basis)
{
  PetscFunctionBeginUser;
  for (PetscInt t = 0; t < basis->reduced.n_terms && basis->reduced.D; t++) PetscCall(PetscFree(basis->reduced.D[t]));
  PetscCall(PetscFree(basis->reduced.A));
  PetscCall(PetscFree(basis->reduced.factors));
  PetscCall(PetscFree(basis->reduced.D));
  PetscCall(SubspaceDestroy(&basis->space));
  PetscCall(MatDestroy(&basis->M));
  PetscFunctionReturn(0);
}
