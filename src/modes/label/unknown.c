/*
   Names of modes of matrices without parts: the unknown that moves most, that with the largest |x_k|^2. Rounding tells
   which basis of the vectors of equal eigenvalues the solver finds, and which of two unknowns that move alike moves
   more. So a mode of several is named by sum_j |x_jk|^2 over all of them, M-orthonormal, which is that of any basis:
   the first one after the largest, the next one after the next largest; of unknowns that move alike the first one
   counts.
*/
#include "modes/modesimpl.h"

#define LABEL_EQUAL 1e-9 /* of the eigenvalue: eigenvalues that are one */

/* The first entry that is the largest but for rounding. Collective */
static PetscErrorCode FirstOfLargest(Vec size, PetscInt *at)
{
  const PetscScalar *s;
  PetscReal          largest;
  PetscInt           first, last, k;

  PetscFunctionBeginUser;
  PetscCall(VecMax(size, NULL, &largest));
  PetscCall(VecGetOwnershipRange(size, &first, &last));
  PetscCall(VecGetArrayRead(size, &s));
  for (k = 0; k < last - first && s[k] < (1 - LABEL_TIE) * largest;) k++;
  PetscCall(VecRestoreArrayRead(size, &s));
  *at = k < last - first ? first + k : PETSC_MAX_INT;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, at, 1, MPIU_INT, MPI_MIN, PetscObjectComm((PetscObject)size)));
  PetscFunctionReturn(0);
}

/* size += |x|^2 of each unknown */
static PetscErrorCode AddSquares(Vec x, Vec work, Vec size)
{
  PetscFunctionBeginUser;
  if (!x) PetscFunctionReturn(0);
  PetscCall(VecPointwiseMult(work, x, x));
  PetscCall(VecAXPY(size, 1, work));
  PetscFunctionReturn(0);
}

/* Whether modes i and j, neither at zero, have one eigenvalue */
static PetscBool SameEigenvalue(const Mode *i, const Mode *j)
{
  const PetscReal apart = hypot(i->sigma - j->sigma, i->omega - j->omega);

  return apart < LABEL_EQUAL * hypot(i->sigma, i->omega) ? PETSC_TRUE : PETSC_FALSE;
}

PetscErrorCode ModesLabelUnknowns(Modes modes)
{
  PetscInt at = 0, end, n_unknowns;
  Vec      size, work;

  PetscFunctionBeginUser;
  if (!modes->n) PetscFunctionReturn(0);
  PetscCall(VecDuplicate(modes->right.xr[0], &size));
  PetscCall(VecDuplicate(size, &work));
  PetscCall(VecGetSize(size, &n_unknowns));
  for (PetscInt i = 0; i < modes->n; i = end) {
    PetscCall(VecSet(size, 0));
    for (end = i; end == i || (end < modes->n && SameEigenvalue(&modes->mode[i], &modes->mode[end])); end++) {
      PetscCall(AddSquares(modes->right.xr[end], work, size));
      PetscCall(AddSquares(modes->right.xi[end], work, size));
    }
    for (PetscInt j = i; j < end; j++) {
      /* a defective eigenvalue has more modes than unknowns */
      if (j - i < n_unknowns) PetscCall(FirstOfLargest(size, &at));
      PetscCall(PetscSNPrintf(modes->mode[j].label, sizeof(modes->mode[j].label), "u%" PetscInt_FMT, at + 1));
      PetscCall(VecSetValue(size, at, -1, INSERT_VALUES));
      PetscCall(VecAssemblyBegin(size));
      PetscCall(VecAssemblyEnd(size));
    }
  }
  PetscCall(VecDestroy(&size));
  PetscCall(VecDestroy(&work));
  PetscFunctionReturn(0);
}
