/*
   Fixed interface: static shapes of its displacements, -K_ii^-1 K_ib, and the modes of what lies inside while it is
   held (Craig and Bampton). K_s has no entry between the two, T'M T does.
*/
#include "substructure/substructureimpl.h"
#include "base/algebra/product.h"

#define FIXED_BLOCK 64 /* right-hand sides at once */

PetscErrorCode FixedFactor(Substructure s)
{
  PencilMatrices inside = {.symmetric = PETSC_TRUE};

  PetscFunctionBeginUser;
  if (s->inside.ksp) PetscFunctionReturn(0);
  PetscCall(InterfaceTakeInside(s, s->body.K, &inside.K));
  PetscCall(InterfaceTakeInside(s, s->body.M, &inside.M));
  PetscCall(ShiftInvertCreate(&inside, 0, PETSC_FALSE, &s->progress, &s->inside));
  PetscCall(MatDestroy(&inside.K));
  PetscCall(MatDestroy(&inside.M));
  PetscFunctionReturn(0);
}

/* Raises the error for parts that the interface does not hold */
static PetscErrorCode FixedCheckHeld(Substructure s, PetscBool held)
{
  PetscFunctionBeginUser;
  PetscCheck(held, s->comm, PETSC_ERR_USER_INPUT,
             "-superelement_sets: with its %" PetscInt_FMT
             " nodes held the parts still move rigidly: name sets that hold them, or take -superelement_method free",
             s->interface.n_nodes);
  PetscFunctionReturn(0);
}

/* Static shapes of all unknowns of the interface into T */
static PetscErrorCode FixedAddStatic(Substructure s)
{
  PetscInt first, last, begin, n;
  IS       rows, columns;
  Mat      KE, Kib;

  PetscFunctionBeginUser;
  PetscCall(MatMatMult(s->body.K, s->interface.E, MAT_INITIAL_MATRIX, PETSC_DEFAULT, &KE));
  PetscCall(MatGetOwnershipRangeColumn(KE, &first, &last));
  PetscCall(ISCreateGeneral(s->comm, s->interface.n_inside, s->interface.inside, PETSC_COPY_VALUES, &rows));
  PetscCall(ISShift(rows, s->body.first, rows));
  PetscCall(ISCreateStride(s->comm, last - first, first, 1, &columns));
  PetscCall(MatCreateSubMatrix(KE, rows, columns, MAT_INITIAL_MATRIX, &Kib));
  PetscCall(ISDestroy(&rows));
  PetscCall(ISDestroy(&columns));
  PetscCall(MatDestroy(&KE));
  PetscCall(ProgressBegin(&s->progress, "static shapes, blocks", (s->interface.n + FIXED_BLOCK - 1) / FIXED_BLOCK));
  for (begin = 0; begin < s->interface.n; begin += n) {
    Mat B, X;

    n = PetscMin(FIXED_BLOCK, s->interface.n - begin);
    PetscCall(MatCreateDense(s->comm, s->interface.n_inside, PETSC_DECIDE, PETSC_DETERMINE, n, NULL, &B));
    PetscCall(BlockTakeColumns(Kib, begin, B));
    PetscCall(MatScale(B, -1));
    PetscCall(MatDuplicate(B, MAT_DO_NOT_COPY_VALUES, &X));
    PetscCall(ShiftInvertApplyBlock(&s->inside, PETSC_FALSE, B, X));
    PetscCall(InterfaceScatter(s, X, begin, s->T));
    PetscCall(MatDestroy(&B));
    PetscCall(MatDestroy(&X));
    PetscCall(ProgressStep(&s->progress));
  }
  PetscCall(ProgressEnd(&s->progress));
  PetscCall(MatDestroy(&Kib));
  PetscFunctionReturn(0);
}

/* Places of the rows inside [n_inside], as 3 local node + direction */
static PetscErrorCode FixedNodes(Substructure s, PetscInt **node)
{
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(s->interface.n_inside, node));
  for (PetscInt k = 0; k < s->interface.n_inside; k++) (*node)[k] = s->body.node[s->interface.inside[k]];
  PetscFunctionReturn(0);
}

PetscErrorCode FixedCreateBasis(Substructure s)
{
  MatrixModes modes;
  PetscInt   *node;
  Mat         K, M, Phi;

  PetscFunctionBeginUser;
  PetscCall(InterfaceTakeInside(s, s->body.K, &K));
  PetscCall(InterfaceTakeInside(s, s->body.M, &M));
  PetscCall(MatrixModesSolve(s->comm, K, M, s->cutoff, &modes));
  PetscCall(FixedCheckHeld(s, modes.rigid ? PETSC_FALSE : PETSC_TRUE));
  PetscCall(TallCreate(s, modes.n));
  if (modes.n) {
    PetscCall(FixedNodes(s, &node));
    PetscCall(MatrixModesTake(s, &modes, node, &Phi));
    PetscCall(InterfaceScatter(s, Phi, s->interface.n, s->T));
    PetscCall(MatDestroy(&Phi));
    PetscCall(PetscFree(node));
  }
  PetscCall(MatrixModesDestroy(&modes));
  PetscCall(MatDestroy(&K));
  PetscCall(MatDestroy(&M));
  PetscCall(FixedFactor(s));
  PetscCall(FixedCheckHeld(s, s->inside.shift == 0 ? PETSC_TRUE : PETSC_FALSE));
  PetscCall(FixedAddStatic(s));
  if (s->rtol > 0) PetscCall(InertiaAdd(s));
  PetscFunctionReturn(0);
}
