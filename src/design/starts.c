/*
   Designs to begin anew with: points of a Sobol sequence over the box of what may be changed, each looked at with the
   contact statuses of the design before. Those count that are the least bad ones; of the others one scenario tells
   enough, that which was dangerous before first.
*/
#include "designimpl.h"
#include "sample/draw/sequence.h"

/* Puts a design into the list [n] of those that are the least bad, of room for `most` */
static void StartsInsert(PetscInt size, PetscInt most, const PetscReal z[], PetscReal own, PetscInt *n,
                         PetscReal list[], PetscReal excess[])
{
  PetscInt at = *n;

  if (*n == most && own >= excess[most - 1]) return;
  if (*n == most) at = most - 1;
  for (; at > 0 && excess[at - 1] > own; at--) {
    excess[at] = excess[at - 1];
    for (PetscInt k = 0; k < size; k++) list[at * size + k] = list[(at - 1) * size + k];
  }
  excess[at] = own;
  for (PetscInt k = 0; k < size; k++) list[at * size + k] = z[k];
  if (*n < most) ++*n;
}

PetscErrorCode DesignStarts(Design d, PetscInt *n, PetscReal z[], PetscReal excess[])
{
  const PetscInt most     = *n;
  Sequence       sequence = {SEQUENCE_SOBOL, 3, PetscMax(1, d->n_starts), d->cube.n, NULL};
  PetscReal      point[CUBE_MAX_VARIABLES], own;
  PetscInt      *order;

  PetscFunctionBeginUser;
  *n = 0;
  PetscCall(PetscMalloc1(d->n_scenarios, &order));
  for (PetscInt i = 0; i < d->n_scenarios; i++) order[i] = i;
  PetscCall(SequenceSetUp(&sequence));
  for (PetscInt i = 0; i < d->n_starts; i++) {
    SequencePoint(&sequence, i, point);
    for (PetscInt k = 0; k < d->cube.n; k++) point[k] = 2 * point[k] - 1;
    PetscCall(DesignGlance(d, point, *n == most ? excess[most - 1] : PETSC_INFINITY, order, &own));
    StartsInsert(d->cube.n, most, point, own, n, z, excess);
  }
  d->n_elsewhere += d->n_starts;
  if (*n) d->elsewhere = excess[0];
  PetscCall(SequenceDestroy(&sequence));
  PetscCall(PetscFree(order));
  PetscFunctionReturn(0);
}
