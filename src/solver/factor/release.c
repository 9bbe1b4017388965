/*
   What need not be there any more once a symmetric matrix has been factored. MUMPS has a copy of A = K_even - s M, or
   works on the values of its upper half: in the first case products with A are made from K, M and the pairs, in the
   other those with K from A,

      A x = K x - left' right x - s M x,   K x = A x + left' right x + s M x.
*/
#include "lowrank.h"
#include "shiftinvert.h"
#include "base/process/memory.h"

/* A + c (left' right + s M) that is not formed; left and right may be NULL */
typedef struct {
  Mat       A, M, left, right;
  PetscReal c, s;
} Shifted;

/* y = A x + c (left' (right x) + s M x), or transposed, where left and right exchange. */
static PetscErrorCode ShiftedApply(Mat B, PetscBool transposed, Vec x, Vec y)
{
  Shifted *shifted;

  PetscFunctionBeginUser;
  PetscCall(MatShellGetContext(B, &shifted));
  if (transposed)
    PetscCall(MatMultTranspose(shifted->M, x, y));
  else
    PetscCall(MatMult(shifted->M, x, y));
  PetscCall(VecScale(y, shifted->s));
  if (shifted->left) PetscCall(LowRankMultAdd(&(LowRank){.L = shifted->left, .R = shifted->right}, transposed, x, y));
  PetscCall(VecScale(y, shifted->c));
  if (transposed)
    PetscCall(MatMultTransposeAdd(shifted->A, x, y, y));
  else
    PetscCall(MatMultAdd(shifted->A, x, y, y));
  PetscFunctionReturn(0);
}

static PetscErrorCode ShiftedMult(Mat B, Vec x, Vec y)
{
  return ShiftedApply(B, PETSC_FALSE, x, y);
}

static PetscErrorCode ShiftedMultTranspose(Mat B, Vec x, Vec y)
{
  return ShiftedApply(B, PETSC_TRUE, x, y);
}

static PetscErrorCode ShiftedDestroy(Mat B)
{
  Shifted *shifted;

  PetscFunctionBeginUser;
  PetscCall(MatShellGetContext(B, &shifted));
  PetscCall(MatDestroy(&shifted->A));
  PetscCall(MatDestroy(&shifted->M));
  PetscCall(MatDestroy(&shifted->left));
  PetscCall(MatDestroy(&shifted->right));
  PetscCall(PetscFree(shifted));
  PetscFunctionReturn(0);
}

/* A plus, or minus, what friction and mass make of it */
static PetscErrorCode ShiftedCreate(const ShiftInvert *si, const PencilMatrices *pencil, Mat A, PetscReal c, Mat *B)
{
  PetscInt n_local, n;
  Shifted *shifted;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&shifted));
  *shifted = (Shifted){A, pencil->M, pencil->left, pencil->right, c, si->shift};
  PetscCall(PetscObjectReference((PetscObject)shifted->A));
  PetscCall(PetscObjectReference((PetscObject)shifted->M));
  if (shifted->left) PetscCall(PetscObjectReference((PetscObject)shifted->left));
  if (shifted->right) PetscCall(PetscObjectReference((PetscObject)shifted->right));
  PetscCall(MatGetLocalSize(A, &n_local, NULL));
  PetscCall(MatGetSize(A, &n, NULL));
  PetscCall(MatCreateShell(si->comm, n_local, n_local, n, n, shifted, B));
  PetscCall(MatShellSetOperation(*B, MATOP_MULT, (void (*)(void))ShiftedMult));
  PetscCall(MatShellSetOperation(*B, MATOP_MULT_TRANSPOSE, (void (*)(void))ShiftedMultTranspose));
  PetscCall(MatShellSetOperation(*B, MATOP_DESTROY, (void (*)(void))ShiftedDestroy));
  PetscFunctionReturn(0);
}

/* Whether the factors are those of MUMPS alone, which has what it needs of a symmetric matrix */
static PetscErrorCode ReleaseIsSafe(const ShiftInvert *si, PetscBool *safe)
{
  PetscBool     direct, cholesky, is_mumps = PETSC_FALSE;
  MatSolverType type;
  PC            pc;

  PetscFunctionBeginUser;
  PetscCall(KSPGetPC(si->ksp, &pc));
  PetscCall(PetscObjectTypeCompare((PetscObject)si->ksp, KSPPREONLY, &direct));
  PetscCall(PetscObjectTypeCompare((PetscObject)pc, PCCHOLESKY, &cholesky));
  PetscCall(PCFactorGetMatSolverType(pc, &type));
  if (type) PetscCall(PetscStrcmp(type, MATSOLVERMUMPS, &is_mumps));
  *safe = direct && cholesky && is_mumps ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(0);
}

/* K and K_even of the pencil, which the half stands for, or K and the pairs for K_even */
static PetscErrorCode ReleasePencil(const PencilMatrices *pencil, Mat half, ShiftInvert *si)
{
  PetscFunctionBeginUser;
  if (si->release != RELEASE_PENCIL || (!half && pencil->symmetric)) PetscFunctionReturn(0);
  PetscCall(MatDestroy(&si->product));
  if (half) PetscCall(ShiftedCreate(si, pencil, half, 1, &si->product));
  PetscCall(PencilReleaseSymmetric(si->owner, half, si->shift));
  si->regain = PETSC_TRUE;
  MemoryReturn();
  PetscFunctionReturn(0);
}

/* KSPSetReusePreconditioner() keeps PETSc from factoring the shell that takes the place of the matrix. */
PetscErrorCode ShiftInvertRelease(const PencilMatrices *pencil, ShiftInvert *si)
{
  PetscBool safe, is_half;
  Mat       A, shell;

  PetscFunctionBeginUser;
  if (si->release == RELEASE_NOTHING || !si->even || !si->factored || si->released) PetscFunctionReturn(0);
  PetscCall(ReleaseIsSafe(si, &safe));
  if (!safe) PetscFunctionReturn(0);
  PetscCall(KSPGetOperators(si->ksp, &A, NULL));
  PetscCall(PetscObjectTypeCompare((PetscObject)A, MATSEQSBAIJ, &is_half));
  if (!is_half) {
    PetscCall(ShiftedCreate(si, pencil, pencil->K, -1, &shell));
    PetscCall(KSPSetReusePreconditioner(si->ksp, PETSC_TRUE));
    PetscCall(KSPSetOperators(si->ksp, shell, shell));
    PetscCall(MatDestroy(&shell));
  }
  PetscCall(MatDestroy(&si->term[0]));
  si->released = PETSC_TRUE;
  PetscCall(ReleasePencil(pencil, is_half ? A : NULL, si));
  PetscFunctionReturn(0);
}

PetscErrorCode ShiftInvertRegain(const PencilMatrices *pencil, const ShiftInvert *si, PencilMatrices *whole)
{
  PencilMatrices own;

  PetscFunctionBeginUser;
  *whole = *pencil;
  if (!si->regain) PetscFunctionReturn(0);
  PetscCall(PencilGetMatrices(si->owner, &own));
  whole->K      = own.K;
  whole->K_even = own.K_even;
  PetscFunctionReturn(0);
}
