/*
   Private to sample/: points of the unit cube, u in (0, 1)^d. Point i depends on the kind, the seed and i alone (of a
   Latin hypercube on the number of points too), whichever rank asks. Pure functions: no MPI, no options.
*/
#pragma once

#include "directions.h"
#include <petscsys.h>
#include <stdint.h>

typedef enum { SEQUENCE_SOBOL, SEQUENCE_LATIN, SEQUENCE_RANDOM } SequenceKind;

typedef struct {
  SequenceKind kind;
  uint64_t     seed;
  PetscInt     n, n_dimensions; /* points, SOBOL_DIMENSIONS at most */
  PetscInt    *stratum;         /* [n_dimensions][n] of a Latin hypercube */
} Sequence;

/* kind, seed, n and n_dimensions are set; makes the rest */
PetscErrorCode SequenceSetUp(Sequence *sequence);
/* u [n_dimensions] of point i in 0 .. n - 1 */
void           SequencePoint(const Sequence *sequence, PetscInt i, PetscReal u[]);
PetscErrorCode SequenceDestroy(Sequence *sequence);
/* The 32 digits of Sobol's own point i, in Gray code's order, before they are scrambled */
uint32_t SobolDigits(PetscInt i, PetscInt dimension);
