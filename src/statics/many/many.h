/* Private to statics/: equilibria at many points on a basis of those at some of them */
#pragma once

#include "statics/staticsimpl.h"
#include "basis/subspace.h"

/* The contact problem on the basis, alike on every rank: K = sum_t c_t A_t, rows g of the pairs and s of their
   friction. Vectors 0 .. n_less - 1 make the model that the error is estimated with */
typedef struct {
  PetscInt    n, n_less, n_pairs, n_terms;
  PetscReal **A;     /* [n_terms] [n][n] N/m */
  PetscReal  *G, *S; /* [n][n_pairs], one column a vector */
} ManyModel;

/* A point: coefficients of the terms, forces on the basis, stiffness (N/m), friction and gap (m) of each pair */
typedef struct {
  PetscReal *c, *f, *k, *slide, *gap;
} ManyPoint;

/* What was found there */
typedef struct {
  PetscBool found;   /* the statuses settled */
  PetscReal error;   /* m: largest change of a closing by the vectors that the model of n_less has not */
  PetscReal nearest; /* m: least distance of a closing from 0 */
} ManyAnswer;

/* manydense.c - closed [n_pairs] and closings w - gap [n_pairs], m, from the closed pairs to begin with; q [n]. Not
   collective. */
PETSC_INTERN PetscErrorCode ManySolve(const ManyModel *model, const ManyPoint *point, char closed[],
                                      PetscReal closing[], PetscReal q[], ManyAnswer *answer);

/* near.c - statuses, displacements and rows of the statics at p, from the displacements that they have, by the factors
   that they have; found is false where that does not settle. Collective. */
PETSC_INTERN PetscErrorCode ManyNear(Statics statics, const PetscReal p[], PetscBool *found);
/* Makes the displacements of the statics those of a force in a pair, as all ranks number them, the pairs closed [local]
   as they are at p. Collective. */
PETSC_INTERN PetscErrorCode ManyInfluence(Statics statics, const PetscReal p[], const char closed[], PetscInt pair);

#define MANY_LOADS   32  /* loads of which those of all points are sums; others are projected each time */
#define MANY_VECTORS 512 /* room for their products */

/* The loads of a point: their parts of those that the basis keeps; n is -1 before they are found */
typedef struct {
  PetscInt  n;
  PetscReal part[MANY_LOADS];
} ManyLoad;

/* The basis on the mesh */
typedef struct {
  Statics    statics;
  Pencil     bodies; /* all pairs open */
  PetscInt   n_terms;
  PetscInt  *term; /* [n_terms] of the pencil's, those of the stiffness */
  Subspace   space;
  PetscReal  scale;        /* m, of displacements */
  PetscInt   n_influences; /* vectors until the last influence of a pair: those of the model for the error, and half of
                             the equilibria behind them */
  BV         loads;        /* [n_loads] orthonormal, of which those of all points are made */
  PetscInt   n_loads;
  PetscReal *loaded; /* [MANY_LOADS][MANY_VECTORS] V'loads */
  ManyModel  model;
} ManyBasis;

/* manybasis.c - from the equilibrium that the statics have just found; good is false where its bodies are not those
   terms */
PETSC_INTERN PetscErrorCode ManyBasisCreate(Statics statics, ManyBasis *basis, PetscBool *good);
/* Adds the equilibrium that the statics have just found */
PETSC_INTERN PetscErrorCode ManyBasisAdd(ManyBasis *basis);
/* Makes V q the displacements of the statics. Collective. */
PETSC_INTERN PetscErrorCode ManyBasisExpand(const ManyBasis *basis, PetscReal q[]);
/* The point p on the basis, with arrays of the caller: c [n_terms], f [n], k, slide, gap [n_pairs]. Collective. */
PETSC_INTERN PetscErrorCode ManyBasisPoint(ManyBasis *basis, const PetscReal p[], ManyLoad *load, ManyPoint *point);
PETSC_INTERN PetscErrorCode ManyBasisDestroy(ManyBasis *basis);
