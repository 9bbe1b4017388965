/*
   Private to operators/: superelements, bodies that are matrices alone. Each unknown of one is a displacement of the
   mesh or of a point, u_s = B u, or is apart: an unknown of its own. With K_s (N/m), M_s (kg) and C_s (N s/m)

      K += k B' K_s B,   M += m B' M_s B,   C += c B' C_s B,   k, m, c = 1 in the scene.

   K_s and C_s may have skew parts, of friction and of a spin, where -..._skew says so (skew.c).

   A piece has matrices and scales of its own on the unknowns of another one (-..._of): what its parts add, so that
   their moduli may vary one by one.
*/
#pragma once

#include "operators/pencilimpl.h"

typedef enum { SUPERELEMENT_K, SUPERELEMENT_M, SUPERELEMENT_C, N_SUPERELEMENT } SuperelementMatrix;

#define SUPERELEMENT_APART (-1) /* direction of an unknown that is none of the mesh */

/* A line of its table: where an unknown is */
typedef struct {
  PetscInt  node, direction; /* 0 to 2 along, 3 to 5 about x, y, z */
  PetscReal x[3];            /* m */
} SuperelementRow;

/* A share of a displacement of a node that this rank owns in an unknown */
typedef struct {
  PetscInt  row, at; /* unknown from 0; 3 local node + direction */
  PetscReal weight;
} SuperelementShare;

typedef struct _p_Superelement {
  char     *name, *of; /* whose unknowns it shares; empty for its own */
  char      file[N_SUPERELEMENT][PETSC_MAX_PATH_LEN], table[PETSC_MAX_PATH_LEN];
  PetscReal scale[N_SUPERELEMENT];
  PetscInt  n_sets;
  char    **sets;
  PetscReal distance; /* m; 0: not given */
  PetscBool has_table, has_distance;
  PetscBool skew; /* K_s and C_s keep their skew parts */
  /* the one whose unknowns, rows, places and shares it borrows; NULL for its own */
  struct _p_Superelement *whole;
  /* read before the model is set up */
  PetscInt         n, n_apart; /* unknowns; of these apart */
  SuperelementRow *row;        /* [n] */
  /* by SuperelementsSetUp() */
  PetscInt           first_apart; /* global number of the first unknown apart; the others follow in their order */
  PetscInt           index[N_SUPERELEMENT]; /* parameters, -1 for none */
  PetscInt           n_follow;              /* places that a surface carries */
  PetscReal          off;                   /* largest distance of a place from its node, point or surface, m */
  Mat                A[N_SUPERELEMENT];     /* as they are read; NULL for none */
  Mat                mass;                  /* B' M_s B, which a pencil may outlive the terms of */
  PetscInt           n_shares;
  SuperelementShare *share;
} Superelement;

/* pieces.c - sorts what is read, finds what pieces are of, raises errors; a piece takes the places of its whole. Not
   collective. */
PETSC_INTERN PetscErrorCode SuperelementsSort(Operators operators, PetscInt n);
PETSC_INTERN void           SuperelementPlacePiece(Superelement *piece);
/* Goes from NULL through a superelement and its pieces; false, and NULL, behind the last */
PETSC_INTERN PetscBool SuperelementNext(Operators operators, const Superelement *whole, Superelement **piece);
/* Sum of one kind of their matrices times the scales of the scene, NULL without. Collective. */
PETSC_INTERN PetscErrorCode SuperelementSum(Operators operators, const Superelement *whole, int kind, Mat *sum);

/* superelement.c - reads the list and its tables; then tells the model how many unknowns are apart. Collective. */
PETSC_INTERN PetscErrorCode SuperelementsSetFromOptions(Operators operators);
PETSC_INTERN PetscErrorCode SuperelementsVisit(Operators operators, const QuantityVisitor *visitor);
PETSC_INTERN PetscErrorCode SuperelementsAddUnknowns(Operators operators);
/* superelement.c - parameters and terms. Collective. */
PETSC_INTERN PetscErrorCode SuperelementsSetUp(Operators operators);
PETSC_INTERN PetscErrorCode SuperelementsAddChecksum(Operators operators, Checksum checksum);
PETSC_INTERN PetscErrorCode SuperelementsDestroy(Operators operators);

/* skew.c - raises the error for a matrix that is not symmetric, and makes it exactly so, or for a half of one where it
   may be skew; its symmetric and its skew part, NULL where it has none. Collective. */
PETSC_INTERN PetscErrorCode SuperelementCheckEven(const Superelement *s, int i, const char option[], Mat *A);
PETSC_INTERN PetscErrorCode SuperelementSplit(Mat A, Mat *even, Mat *odd);

/* superelement.c - raises an error for one with mass, whose internal unknowns do not tell how they fall */
PETSC_INTERN PetscErrorCode SuperelementsCheckWeight(Operators operators);

/* table.c - reads the table. Collective. */
PETSC_INTERN PetscErrorCode SuperelementReadTable(MPI_Comm comm, Superelement *s);

/* A place, and the node of the mesh that is nearest */
typedef struct {
  PetscReal x[3];     /* m */
  PetscInt  number;   /* of the node over all ranks, -1 where none is within reach */
  PetscBool twice;    /* two are equally near */
  PetscReal distance; /* m */
} NearestNode;

/* nodes.c - the node nearest to each of n places among those of all ranks that are `on` (NULL: all) within `near` (m).
   Collective. */
PETSC_INTERN PetscErrorCode NodesFindNearest(MPI_Comm comm, const Mesh *mesh, const PetscBool on[], PetscReal near,
                                             PetscInt n, NearestNode place[]);

/* place.c - the shares of all unknowns that are not apart. Collective. */
PETSC_INTERN PetscErrorCode SuperelementPlace(Operators operators, Superelement *s);

/* force.c - adds c B' K_s B u of one superelement to forces [nodes][3], each at the rank that owns the node; of all of
   them; to the unknowns apart of f. Collective. */
PETSC_INTERN PetscErrorCode SuperelementAddForce(Operators operators, const PetscReal p[], const Superelement *s, Vec u,
                                                 const PetscReal displacement[], PetscReal force[]);
PETSC_INTERN PetscErrorCode SuperelementsAddForces(Operators operators, const PetscReal p[], Vec u,
                                                   const PetscReal displacement[], PetscReal force[]);
PETSC_INTERN PetscErrorCode SuperelementsAddForcesApart(Operators operators, const PetscReal p[], Vec u, Vec f);
