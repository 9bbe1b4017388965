/*
   What the kinds of External stand on: the vertices of a set, and the memory that a restart needs, one array in a fixed
   order.
*/
#include "externalimpl.h"

PetscErrorCode ExternalFindVertices(External external, const char set[], PetscInt *n, PetscInt *n_owned,
                                    PetscInt **vertex)
{
  const Layout *layout = external->layout;
  PetscInt      n_all, *point;

  PetscFunctionBeginUser;
  PetscCall(ModelGetSetNodes(external->model, set, &n_all, &point));
  PetscCall(PetscMalloc1(n_all, vertex));
  *n = 0;
  for (int pass = 0; pass < 2; pass++) {
    for (PetscInt k = 0; k < n_all; k++) {
      const PetscInt i = point[k];

      if (layout->at[i] >= 0 && layout->owned[i] == (pass == 0)) (*vertex)[(*n)++] = i;
    }
    if (pass == 0) *n_owned = *n;
  }
  PetscCall(PetscFree(point));
  PetscFunctionReturn(0);
}

/* The next n numbers of the memory */
static PetscReal *ExternalTakeMemory(PetscReal **next, PetscInt n)
{
  PetscReal *const here = *next;

  *next += n;
  return here;
}

/* begun, power of the drives (W), factor of each load, d of each bolt, (1/dt, time) of each impulse, forces of the
   frames. Pointers of the kinds go into this array; it moves when it grows, and all are set again. New numbers are at
   the end, and 0. */
PetscErrorCode ExternalLayMemory(External external)
{
  const PetscInt n_before = external->n_memory;
  PetscInt       n        = 2 + external->n_loads + 2 * external->n_acting;
  PetscReal     *next;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < external->n_loads; i++) n += external->loads[i].is_bolt ? 1 : 0;
  for (PetscInt i = 0; i < external->n_frames; i++) n += 3 * external->frames[i].n;
  PetscCall(PetscRealloc((size_t)n * sizeof(PetscReal), &external->memory));
  if (n > n_before) PetscCall(PetscArrayzero(&external->memory[n_before], n - n_before));
  external->n_memory = n;
  next               = external->memory;
  external->begun    = ExternalTakeMemory(&next, 1);
  external->drives   = ExternalTakeMemory(&next, 1);
  for (PetscInt i = 0; i < external->n_loads; i++) external->loads[i].last = ExternalTakeMemory(&next, 1);
  for (PetscInt i = 0; i < external->n_loads; i++)
    if (external->loads[i].is_bolt) external->loads[i].drawn = ExternalTakeMemory(&next, 1);
  for (PetscInt i = 0; i < external->n_acting; i++) external->impulses[i].last = ExternalTakeMemory(&next, 2);
  for (PetscInt i = 0; i < external->n_frames; i++)
    external->frames[i].last = ExternalTakeMemory(&next, 3 * external->frames[i].n);
  PetscFunctionReturn(0);
}
