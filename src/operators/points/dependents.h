/* Private to operators/: displacements that follow others, while Z is made of them */
#pragma once

#include "operators/pencilimpl.h"

/* The rows of this rank. They are gone through twice: D is NULL while they are counted */
typedef struct {
  PetscInt   first, n, n_lists; /* unknowns of this rank; points that are joined rigidly, ties, and one
                                   of all equations */
  PetscInt  *by;                /* [n] the one that claims an unknown, -1 for none */
  PetscInt  *count;             /* [n] entries of its row */
  PetscBool *follows;           /* [n] which do; the operators keep it */
  PetscInt   conflict;          /* two that claim the same one, a n_lists + b; -1 for none */
  Mat        D;
} Dependents;

/* follow.c - an unknown, of any rank, belongs to list `by`; it follows others, those that are held (-1) left out */
PETSC_INTERN PetscErrorCode DependentsClaim(Dependents *d, PetscInt unknown, PetscInt by);
PETSC_INTERN PetscErrorCode DependentsFollow(Dependents *d, PetscInt unknown, PetscInt n, const PetscInt column[],
                                             const PetscReal value[]);

/* A point's set, on all ranks: T(i, k) = t[6 i + k] at the unknowns [3 n], of which six are kept */
typedef struct {
  const Joint *point;
  PetscInt     n, *unknown, kept[6];
  PetscReal   *t;
} RigidSet;

/* Equations of -model_equations, on all ranks: unknown first[i] follows those up to first[i + 1], times their shares;
   -1 is held */
typedef struct {
  PetscInt   n, *first, *unknown;
  PetscReal *share;
} Equations;

/* equations.c - all of them, none without the option; their rows. Collective. */
PETSC_INTERN PetscErrorCode EquationsCreate(Operators operators, Equations *equations);
PETSC_INTERN PetscErrorCode EquationsDestroy(Equations *equations);
PETSC_INTERN PetscErrorCode EquationsAddRows(const Equations *equations, PetscInt by, Dependents *d);

/* What makes displacements follow, but for ties, which the contact has */
typedef struct {
  PetscInt  n_sets;
  RigidSet *set;
  Equations equations;
} Leaders;

/* rigid.c - the sets of all points that are joined rigidly; the rows of one. Collective. */
PETSC_INTERN PetscErrorCode RigidSetsCreate(Operators operators, PetscInt *n, RigidSet **sets);
PETSC_INTERN PetscErrorCode RigidSetsDestroy(PetscInt n, RigidSet *sets);
PETSC_INTERN PetscErrorCode RigidAddRows(const RigidSet *set, PetscInt by, Dependents *d);
