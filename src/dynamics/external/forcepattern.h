/*
   ForcePattern (private to dynamics/) - nodal forces whose direction and distribution stay as they are while a factor
   of time scales them: value[i] (N, or N s of an impulse) at number index[i] of a state vector, those of owned nodes
   first.
*/
#pragma once

#include "dynamics/bodies/bodies.h"

typedef struct {
  PetscInt   n, n_owned;
  PetscInt  *index;
  PetscReal *value;
} ForcePattern;

/* Forces at n local nodes (from 0), Cartesian, [n][3]; nodes without cells are left out. Not collective. */
PETSC_INTERN PetscErrorCode ForcePatternCreate(const Layout *layout, PetscInt n, const PetscInt vertex[],
                                               const PetscReal force[], ForcePattern *pattern);
PETSC_INTERN PetscErrorCode ForcePatternDestroy(ForcePattern *pattern);

/* f += factor value */
static inline void ForcePatternAdd(const ForcePattern *p, PetscReal factor, PetscReal f[])
{
  for (PetscInt i = 0; i < p->n; i++) f[p->index[i]] += factor * p->value[i];
}

/* Power (W) of the forces at factor 1, of owned nodes alone, so that ranks add up */
static inline PetscReal ForcePatternPower(const ForcePattern *p, const PetscReal v[])
{
  PetscReal power = 0;

  for (PetscInt i = 0; i < p->n_owned; i++) power += p->value[i] * v[p->index[i]];
  return power;
}
