/*
   Designs to begin anew with: points of a Sobol sequence over the box of what may be changed, each looked at with the
   contact statuses of the design before. Those count that are the least bad ones; of the others one scenario tells
   enough, that which was dangerous before first.
*/
#include "designimpl.h"
#include "sample/draw/sequence.h"

#define SEED 3 /* of the scrambling; any will do */

/* Puts a design into the list, where it is one of the least bad ones */
static PetscErrorCode StartsInsert(PetscInt size, const PetscReal z[], PetscReal excess, DesignList *list)
{
  PetscInt at = PetscMin(list->n, DESIGN_STARTS - 1);

  PetscFunctionBeginUser;
  if (list->n == DESIGN_STARTS && excess >= list->excess[at]) PetscFunctionReturn(0);
  for (; at > 0 && list->excess[at - 1] > excess; at--) {
    list->excess[at] = list->excess[at - 1];
    PetscCall(PetscArraycpy(list->z[at], list->z[at - 1], size));
  }
  list->excess[at] = excess;
  PetscCall(PetscArraycpy(list->z[at], z, size));
  list->n = PetscMin(list->n + 1, DESIGN_STARTS);
  PetscFunctionReturn(0);
}

PetscErrorCode DesignStarts(Design d, DesignList *starts)
{
  Sequence  sequence = {SEQUENCE_SOBOL, SEED, d->n_starts, d->cube.n, NULL};
  PetscReal z[CUBE_MAX_VARIABLES], excess;
  PetscInt *order;

  PetscFunctionBeginUser;
  starts->n = 0;
  PetscCall(PetscMalloc1(d->n_scenarios, &order));
  for (PetscInt i = 0; i < d->n_scenarios; i++) order[i] = i;
  PetscCall(SequenceSetUp(&sequence));
  for (PetscInt i = 0; i < d->n_starts; i++) {
    const PetscReal bound = starts->n == DESIGN_STARTS ? starts->excess[DESIGN_STARTS - 1] : PETSC_INFINITY;

    SequencePoint(&sequence, i, z);
    for (PetscInt k = 0; k < d->cube.n; k++) z[k] = 2 * z[k] - 1;
    PetscCall(DesignGlance(d, z, bound, order, &excess, NULL));
    PetscCall(StartsInsert(d->cube.n, z, excess, starts));
  }
  d->n_elsewhere += d->n_starts;
  if (starts->n) d->elsewhere = starts->excess[0];
  PetscCall(SequenceDestroy(&sequence));
  PetscCall(PetscFree(order));
  PetscFunctionReturn(0);
}
