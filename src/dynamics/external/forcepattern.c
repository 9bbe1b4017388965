/*
   Nodal forces of a fixed distribution in the components of their nodes (forcepattern.h): a list of places in the
   state vector and values (N, or N s of an impulse), those of owned nodes first, so that their power sums over the
   ranks count each node once while all copies of a node get the same force.
*/
#include "forcepattern.h"

/* Appends the nonzero components of a Cartesian force at a node */
static void ForcePatternAppend(const Layout *layout, PetscInt vertex, const PetscReal force[3], ForcePattern *p)
{
  for (int j = 0; j < 3; j++) {
    const PetscReal *q     = &layout->basis[9 * vertex + 3 * j];
    const PetscReal  value = q[0] * force[0] + q[1] * force[1] + q[2] * force[2];

    if (value == 0) continue;
    p->index[p->n]   = layout->at[vertex] + j * layout->step[vertex];
    p->value[p->n++] = value;
  }
}

PetscErrorCode ForcePatternCreate(const Layout *layout, PetscInt n, const PetscInt vertex[], const PetscReal force[],
                                  ForcePattern *p)
{
  PetscFunctionBeginUser;
  p->n = 0;
  PetscCall(PetscMalloc2(3 * n, &p->index, 3 * n, &p->value));
  for (PetscInt i = 0; i < n; i++)
    if (layout->at[vertex[i]] >= 0 && layout->owned[vertex[i]]) ForcePatternAppend(layout, vertex[i], &force[3 * i], p);
  p->n_owned = p->n;
  for (PetscInt i = 0; i < n; i++)
    if (layout->at[vertex[i]] >= 0 && !layout->owned[vertex[i]])
      ForcePatternAppend(layout, vertex[i], &force[3 * i], p);
  PetscFunctionReturn(0);
}

PetscErrorCode ForcePatternDestroy(ForcePattern *p)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree2(p->index, p->value));
  PetscFunctionReturn(0);
}
