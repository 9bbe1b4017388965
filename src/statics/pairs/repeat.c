/*
   Whether the active set goes round in a circle. What a status of all pairs leads to is fixed where their laws are
   linear, so that one that repeats is a cycle; with Coulomb pairs in slip, whose laws change with the iterate, only
   where forces and displacements repeat too.
*/
#include "statics/staticsimpl.h"

/* change of an iterate that repeats, relative: Newton's method on its way to a solution changes by more, or has
   converged */
#define REPEAT_SAME 1e-9

PetscErrorCode RepeatFind(const Active *a, Repeat *seen, PetscBool *repeats)
{
  /* a status is told by sum_p (1 + status_p) frac(golden (row_p + 1)): multiples of 1 / golden ratio are spread
     evenly, and different statuses agree in the sum by accident only */
  const PetscReal golden = 0.61803398874989484820;
  const PetscBool linear = ActiveIsLinear(a);
  PetscReal       sum[2] = {0, 0};

  PetscFunctionBeginUser;
  for (PetscInt p = 0; p < a->rows->n_pairs; p++) {
    const PetscReal at = golden * (PetscReal)(a->rows->begin + a->rows->first[p] + 1);

    sum[0] += (1 + (PetscReal)a->status[p]) * (at - PetscFloorReal(at));
  }
  for (PetscInt i = 0; i < a->rows->n && !linear; i++) sum[1] += PetscAbsReal(a->l[i]) + PetscAbsReal(a->w[i]);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 2, MPIU_REAL, MPI_SUM, a->rows->comm));
  *repeats = PETSC_FALSE;
  for (PetscInt i = 0; i < PetscMin(seen->n, REPEAT_LONGEST); i++)
    if (seen->status[i] == sum[0] && PetscAbsReal(seen->iterate[i] - sum[1]) <= REPEAT_SAME * sum[1])
      *repeats = PETSC_TRUE;
  seen->status[seen->n % REPEAT_LONGEST]  = sum[0];
  seen->iterate[seen->n % REPEAT_LONGEST] = sum[1];
  seen->n++;
  PetscFunctionReturn(0);
}
