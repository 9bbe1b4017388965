/* Private to quiet/: coefficients of the pencil over a cell */
#pragma once

#include "quiet/cube.h"

/* c(p) = c(pc) + sum_j slope_j (t_j - tc_j) + rest, |rest| <= remainder at every point of the cell */
typedef struct {
  PetscReal slope[CUBE_MAX_VARIABLES], remainder;
} Enclosure;

/* Of a term over the cell [low, high] of t about its middle. Monomials: a bound; the friction coefficient as a law of
   several parameters: as its corners tell. */
PETSC_INTERN PetscErrorCode EnclosureFind(const Cube *cube, const OperatorsTerm *term, const PetscReal low[],
                                          const PetscReal high[], Enclosure *enclosure);
/* Raises an error for a box over which a term has no such bound: a parameter changes its sign. exact = no friction law
   varies. Collective. */
PETSC_INTERN PetscErrorCode EnclosureCheck(MPI_Comm comm, const Cube *cube, const OperatorsParameter parameter[],
                                           PetscInt n_terms, const OperatorsTerm term[], PetscBool *exact);
