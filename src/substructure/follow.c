/*
   Displacements of the parts that follow others, by ties, rigid points and equations: u = Z q. Where all that one
   follows is inside, it is no unknown. One that follows others outside is an unknown of its own, and belongs to the
   interface: the tie, which is left out, is made again where the superelement is used. So does one that others outside
   follow.
*/
#include "substructureimpl.h"

/* Entries of a row that are not zero, and whether there is one alone, which is 1 */
static PetscErrorCode RowCount(Mat A, PetscInt row, PetscInt *n, PetscBool *is_itself)
{
  const PetscScalar *value;
  const PetscInt    *column;
  PetscInt           n_entries;

  PetscFunctionBeginUser;
  *n         = 0;
  *is_itself = PETSC_FALSE;
  PetscCall(MatGetRow(A, row, &n_entries, &column, &value));
  for (PetscInt k = 0; k < n_entries; k++) {
    if (value[k] == 0) continue;
    ++*n;
    if (column[k] == row && value[k] == 1) *is_itself = PETSC_TRUE;
  }
  if (*n != 1) *is_itself = PETSC_FALSE;
  PetscCall(MatRestoreRow(A, row, &n_entries, &column, &value));
  PetscFunctionReturn(0);
}

/* What each unknown is: itself, or one that follows inside (keep is false), or one set free (joined). n_mixed: those
   that follow both inside and outside */
static PetscErrorCode FollowSort(Mat all, Mat inside, IS unknowns, PetscBool keep[], PetscBool joined[],
                                 PetscInt *n_mixed)
{
  const PetscInt *unknown;
  PetscInt        n, first;

  PetscFunctionBeginUser;
  PetscCall(MatGetOwnershipRange(inside, &first, NULL));
  PetscCall(ISGetLocalSize(unknowns, &n));
  PetscCall(ISGetIndices(unknowns, &unknown));
  *n_mixed = 0;
  for (PetscInt k = 0; k < n; k++) {
    PetscInt  n_all, n_inside;
    PetscBool ignored;

    PetscCall(RowCount(all, unknown[k], &n_all, &keep[k]));
    if (keep[k]) continue;
    PetscCall(RowCount(inside, first + k, &n_inside, &ignored));
    if (n_inside == n_all) continue;
    if (n_inside) ++*n_mixed;
    keep[k] = joined[k] = PETSC_TRUE;
  }
  PetscCall(ISRestoreIndices(unknowns, &unknown));
  PetscFunctionReturn(0);
}

/* W [unknowns][unknowns], 1 on the diagonal of those set free, to Z, its columns of those that are kept */
static PetscErrorCode FollowCreate(Substructure s, Mat W, const PetscBool keep[], Mat *Z)
{
  PetscInt first, last, n = 0, *column, *diagonal;
  IS       rows, columns;
  Mat      D;

  PetscFunctionBeginUser;
  PetscCall(MatGetOwnershipRange(W, &first, &last));
  PetscCall(PetscMalloc2(last - first, &column, last - first, &diagonal));
  for (PetscInt i = first; i < last; i++)
    if (keep[i - first]) column[n++] = i;
  PetscCall(MatCreate(s->comm, &D));
  PetscCall(MatSetSizes(D, last - first, last - first, PETSC_DETERMINE, PETSC_DETERMINE));
  PetscCall(MatSetType(D, MATAIJ));
  PetscCall(MatSeqAIJSetPreallocation(D, 1, NULL));
  PetscCall(MatMPIAIJSetPreallocation(D, 1, NULL, 0, NULL));
  for (PetscInt i = first; i < last; i++) {
    PetscInt  n_entries;
    PetscBool is_itself;

    PetscCall(RowCount(W, i, &n_entries, &is_itself));
    PetscCall(MatSetValue(D, i, i, keep[i - first] && !is_itself ? 1 : 0, INSERT_VALUES));
  }
  PetscCall(MatAssemblyBegin(D, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(D, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAXPY(D, 1, W, DIFFERENT_NONZERO_PATTERN));
  PetscCall(ISCreateStride(s->comm, last - first, first, 1, &rows));
  PetscCall(ISCreateGeneral(s->comm, n, column, PETSC_COPY_VALUES, &columns));
  PetscCall(MatCreateSubMatrix(D, rows, columns, MAT_INITIAL_MATRIX, Z));
  PetscCall(ISDestroy(&rows));
  PetscCall(ISDestroy(&columns));
  PetscCall(MatDestroy(&D));
  PetscCall(PetscFree2(column, diagonal));
  PetscFunctionReturn(0);
}

/* Marks what others outside follow: they are tied to the parts there */
static PetscErrorCode FollowMark(Mat all, IS unknowns, PetscBool joined[])
{
  PetscInt n_marked;
  Vec      probe, answer;

  PetscFunctionBeginUser;
  PetscCall(BodyCreateProbe(all, unknowns, &probe));
  PetscCall(VecDuplicate(probe, &answer));
  PetscCall(MatMultTranspose(all, probe, answer));
  PetscCall(BodyMarkRows(answer, unknowns, joined, &n_marked));
  PetscCall(VecDestroy(&answer));
  PetscCall(VecDestroy(&probe));
  PetscFunctionReturn(0);
}

PetscErrorCode BodyFollow(Substructure s, IS unknowns, PetscBool keep[], Mat *Z)
{
  Mat       all, back, whole, inside;
  PetscInt  n, n_mixed;
  PetscBool frees = PETSC_FALSE, *joined;
  Mat       E;

  PetscFunctionBeginUser;
  *Z = NULL;
  PetscCall(ISGetLocalSize(unknowns, &n));
  for (PetscInt k = 0; k < n; k++) keep[k] = PETSC_TRUE;
  PetscCall(OperatorsGetDependents(s->operators, &all, &E));
  if (!all) PetscFunctionReturn(0);
  PetscCall(MatTranspose(E, MAT_INITIAL_MATRIX, &back)); /* u = Z E' u */
  PetscCall(MatMatMult(all, back, MAT_INITIAL_MATRIX, PETSC_DEFAULT, &whole));
  PetscCall(MatCreateSubMatrix(whole, unknowns, unknowns, MAT_INITIAL_MATRIX, &inside));
  PetscCall(PetscCalloc1(n, &joined));
  PetscCall(FollowSort(whole, inside, unknowns, keep, joined, &n_mixed));
  PetscCall(FollowMark(whole, unknowns, joined));
  for (PetscInt k = 0; k < n; k++)
    if (joined[k]) frees = PETSC_TRUE;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &n_mixed, 1, MPIU_INT, MPI_SUM, s->comm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &frees, 1, MPIU_BOOL, MPI_LOR, s->comm));
  PetscCheck(!n_mixed, s->comm, PETSC_ERR_SUP,
             "-superelement_parts: %" PetscInt_FMT " displacements follow both the parts and others, by a tie, a rigid "
             "point or an equation: that is not supported; make these others parts of the superelement",
             n_mixed);
  if (frees) PetscCall(BodyJoin(&s->body, joined, "a tie, a rigid point or an equation"));
  PetscCall(PetscFree(joined));
  PetscCall(FollowCreate(s, inside, keep, Z));
  PetscCall(MatDestroy(&inside));
  PetscCall(MatDestroy(&whole));
  PetscCall(MatDestroy(&back));
  PetscFunctionReturn(0);
}
