/* Private to modes/, sweep/, frf/: one real basis V for right and left vectors, and matrices on it, which grow with
   it */
#pragma once

#include "entryrows.h"
#include "pencil.h"
#include <squeal/pencil.h>

/* A, or A + left' right, on the basis */
typedef struct {
  Mat        A, transposed;      /* references; A' is A itself where it is symmetric, NULL where A goes by its rows */
  PetscBool  symmetric, product; /* product: A is left' right, and goes by these */
  PetscInt   same;               /* the first term with this matrix, which has its rows */
  Mat        left, right;        /* borrowed, a row for each closed pair, A symmetric; NULL for none */
  BV         image[2];           /* left V, right V */
  EntryRows  rows;               /* of A, where these are looked at */
  PetscInt   rank;               /* of a product: its rows on all ranks, which each has, of the columns: */
  PetscReal *factor[2];          /* [n][rank] left V, right V */
  PetscReal *small;              /* [n * n], column-major */
} SubspaceTerm;

/* The first three terms of a pencil, before those of its laws. Without damping there is no C: A and small are NULL. */
enum { SUBSPACE_K, SUBSPACE_C, SUBSPACE_M, SUBSPACE_PENCIL };

/* Damped modes let V'MV differ from the identity by `loose` and measure it (BlockFactorise()): they put it into their
   dense pencil. Sweeps and responses count on the identity, and leave out directions by their own length
   (BlockOrthonormalise()). */
typedef struct {
  MPI_Comm comm;
  BV       V;
  /* its columns are orthonormal in M (borrowed), the identity where NULL; term[SUBSPACE_M].A where loose */
  Mat           M;
  PetscReal     loose;   /* zero: to rounding */
  PetscInt      n, room; /* columns; for how many there is to be room at least */
  PetscInt      n_terms;
  SubspaceTerm *term;
  PetscInt      n_laws; /* of the pencil, their terms from SUBSPACE_PENCIL on */
  DenseLaw     *law;    /* [n_laws] as SubspacePencil() hands them out */
  PencilLaw    *turned; /* [n_laws] with A' */
} Subspace;

/* No columns and no terms, vectors in the unknowns of the square matrix like */
PETSC_INTERN PetscErrorCode SubspaceCreate(Mat like, Mat M, PetscReal loose, Subspace *space);
/* A further term while there are no columns; symmetric = it is known to be; sparse = by the rows that have entries,
   where these are few. A NULL: an empty one */
PETSC_INTERN PetscErrorCode SubspaceAddTerm(Subspace *space, Mat A, PetscBool symmetric, PetscBool sparse);
/* One that is a product of few rows, A = left' right: a column more costs products with these alone */
PETSC_INTERN PetscErrorCode SubspaceAddProduct(Subspace *space, Mat A, Mat left, Mat right);
/* K, C and M of a pencil, the first terms */
PETSC_INTERN PetscErrorCode SubspaceAddPencil(Subspace *space, const PencilMatrices *pencil);
/* What the block (overwritten) holds beyond V, but for directions shorter than drop: beside its longest column where
   the basis is loose, in M else; n_added columns, may be NULL. All terms follow. */
PETSC_INTERN PetscErrorCode SubspaceAdd(Subspace *space, PetscReal drop, BV block, PetscInt *n_added);
/* The terms of columns n .. n + m - 1 of V, which stand there already and, apart, in the m columns of the block */
PETSC_INTERN PetscErrorCode SubspaceExtend(Subspace *space, BV block);
/* Leaves the first n columns */
PETSC_INTERN PetscErrorCode SubspaceTruncate(Subspace *space, PetscInt n);
/* The pencil on V; its arrays are those of the terms */
PETSC_INTERN DensePencil    SubspacePencil(const Subspace *space);
PETSC_INTERN PetscErrorCode SubspaceDestroy(Subspace *space);

/* term.c - extends `small` of all terms by the columns of the block, which are the last ones of V's `k` active ones */
PETSC_INTERN PetscErrorCode SubspaceTermsExtend(Subspace *space, PetscInt k, BV block);
/* The first columns of V and the images of pairs are followed by those of the block */
PETSC_INTERN PetscErrorCode SubspaceAppend(PetscInt first, PetscInt room, BV block, BV V);
