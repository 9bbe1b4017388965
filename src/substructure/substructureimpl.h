/* Private to substructure/: the record of a superelement that is made */
#pragma once

#include "solver/factor/shiftinvert.h"
#include <squeal/modes.h>
#include <squeal/quantity.h>
#include <squeal/substructure.h>

typedef enum { SUBSTRUCTURE_FIXED, SUBSTRUCTURE_FREE, SUBSTRUCTURE_NONE, N_SUBSTRUCTURE_METHODS } SubstructureMethod;

#define SUBSTRUCTURE_JOINTS 16
#define SUBSTRUCTURE_NO_MODE                                                                                           \
  "-superelement_band %.6g,%.6g: the superelement by itself has no mode there, so that nothing tells how right it "    \
  "is; take a wider band"

/* The parts by themselves. Their unknowns are those of their nodes that neither a support holds nor a tie or a rigid
   point inside moves: the rows of all matrices here, spread over the ranks as their nodes are. */
typedef struct {
  PetscInt              n_own, first, n; /* rows of this rank, the first of them, those of all ranks */
  PetscInt             *node;            /* [n_own] 3 local node + direction */
  PetscBool            *joined;          /* [n_own] what is left out acts there */
  PetscBool            *pressed;         /* [n_own] contacts act there, which are left out */
  PetscInt             *by;              /* [n_own] bits of the joints that do */
  PetscInt              n_joints;        /* things left out, such as pad_young; the last one stands for all others */
  char                  joint[SUBSTRUCTURE_JOINTS][96];
  PetscInt              n_matrices;
  Mat                  *A;        /* [n_matrices] */
  PetscInt              n_terms;  /* those that act on the parts, of the operators */
  const OperatorsTerm **term;     /* [n_terms] */
  PetscInt             *of_term;  /* [n_terms] matrix of each */
  Mat                   K, M, C;  /* sums at p; C is NULL without damping */
  PetscBool            *has_part; /* [nodes] whether a local node is of the parts */
} SubstructureBody;

/* An unknown of the interface, alike on all ranks */
typedef struct {
  PetscReal x[3];            /* m */
  PetscInt  node, direction; /* node from 1 */
  PetscInt  row;             /* of the matrices of the parts */
} InterfaceRow;

typedef struct {
  PetscInt      n, n_nodes; /* unknowns, nodes that have some */
  PetscInt      n_kept;     /* unknowns inside that are kept as they are, behind those */
  PetscInt      n_held;     /* displacements of its nodes that supports or motions hold */
  InterfaceRow *row;        /* [n + n_kept] by node, nodes by place: x, then y, then z */
  PetscInt      n_inside;   /* rows of this rank that are not of it */
  PetscInt     *inside;     /* [n_inside] local rows */
  Mat           E;          /* [rows][n + n_kept] ones */
} SubstructureInterface;

/* Modes of K x = kappa M x below a frequency; owns all of it */
typedef struct {
  Operators  operators;
  Pencil     pencil;
  Modes      modes;
  PetscInt   n;
  PetscReal *kappa; /* [n] (rad/s)^2, 0 for rigid ones */
  PetscBool  rigid; /* there are such */
} MatrixModes;

/* A mode of the superelement in its band */
typedef struct {
  PetscBool held;
  PetscReal frequency, error; /* Hz */
} SubstructureMode;

struct _p_Substructure {
  MPI_Comm         comm;
  Operators        operators;
  const PetscReal *p;
  Model            model;
  /* set by options */
  PetscInt           n_parts, n_sets, n_formats;
  char             **parts, **sets, **formats;
  PetscReal          band[2], cutoff; /* Hz */
  PetscReal          rtol;            /* of a frequency; 0: none */
  PetscBool          has_band, has_cutoff;
  SubstructureMethod method;
  /* built by SubstructureSolve() */
  SubstructureBody      body;
  SubstructureInterface interface;
  ShiftInvert           inside;    /* factors of K_ii, where there is something inside */
  PetscInt              n_modal;   /* modal coordinates, those of answers to inertia behind those of modes */
  PetscInt              n_inertia; /* of these answers to inertia */
  PetscInt              n;         /* unknowns of the interface, those kept, and modal coordinates */
  Mat                   T;         /* [rows][n] dense; NULL where nothing is reduced */
  Mat                  *A;         /* [matrices of the body] T'A T */
  Mat                   K, M, C;   /* sums of them at p */
  PetscReal             any;       /* error of a frequency at the end of the band in any structure; -1: not known */
  PetscInt              n_modes;
  SubstructureMode     *mode; /* [n_modes] in the band, those with a free interface first */
  Progress              progress;
};

/* quantities.c - what options set in it; words of -superelement_formats */
extern const QuantityTable substructure_quantities;
extern const char *const   substructure_methods[];
extern const char *const   substructure_formats[];

/* body.c - unknowns, terms and matrices of the parts. Collective. */
PETSC_INTERN PetscErrorCode BodyCreate(Substructure s);
PETSC_INTERN PetscErrorCode BodyDestroy(SubstructureBody *body);
/* The sums K, M, C of the terms of the parts, with these matrices for theirs; C NULL without damping. Collective. */
PETSC_INTERN PetscErrorCode BodySum(const Substructure s, const Mat A[], Mat *K, Mat *M, Mat *C);
/* Rows that something left out acts on, by its name. Not collective. */
PETSC_INTERN PetscErrorCode BodyJoin(SubstructureBody *body, const PetscBool rows[], const char name[]);
/* probe.c - a number for each unknown that others are not likely to cancel in a sum; 0 for those of the parts.
   Collective. */
PETSC_INTERN PetscErrorCode BodyCreateProbe(Mat A, IS unknowns, Vec *probe);
/* Marks the unknowns [of this rank] at which the answer to it is not zero, and counts them. Not collective. */
PETSC_INTERN PetscErrorCode BodyMarkRows(Vec answer, IS unknowns, PetscBool joined[], PetscInt *n_marked);
/* follow.c - what follows others: Z [all unknowns of the parts][those that follow none inside], NULL without; keep
   [unknowns of this rank] tells these. Collective. */
PETSC_INTERN PetscErrorCode BodyFollow(Substructure s, IS unknowns, PetscBool keep[], Mat *Z);

/* interface.c - the unknowns of the sets, with `all` those inside behind them; E. Collective. */
PETSC_INTERN PetscErrorCode InterfaceCreate(Substructure s, PetscBool all);
PETSC_INTERN PetscErrorCode InterfaceDestroy(SubstructureInterface *interface);
/* Submatrix of what lies inside. Collective. */
PETSC_INTERN PetscErrorCode InterfaceTakeInside(Substructure s, Mat A, Mat *inside);
/* Rows inside of a dense block to and from a block of all rows; columns from `first` on of the latter */
PETSC_INTERN PetscErrorCode InterfaceScatter(Substructure s, Mat inside, PetscInt first, Mat all);
PETSC_INTERN PetscErrorCode InterfaceGather(Substructure s, Mat all, Mat inside);

/* shapes/modes.c - all modes of two matrices below a frequency, Hz. Collective. */
PETSC_INTERN PetscErrorCode MatrixModesSolve(MPI_Comm comm, Mat K, Mat M, PetscReal cutoff, MatrixModes *modes);
PETSC_INTERN PetscErrorCode MatrixModesDestroy(MatrixModes *modes);
/* shapes/canon.c - their vectors as columns of a dense block, in a basis free of rounding's choice: node [own rows
   of K] tells place and direction of each. Collective. */
PETSC_INTERN PetscErrorCode MatrixModesTake(Substructure s, const MatrixModes *modes, const PetscInt node[], Mat *Phi);

/* The same for any vectors of n values, ascending: most of a cluster; Q [n][n] from P = X'M W [n][widest], which it
   overwrites, W from the waves at the places of the unknowns */
PETSC_INTERN PetscInt       CanonWidest(PetscInt n, const PetscReal kappa[]);
PETSC_INTERN void           CanonTurn(PetscInt n, const PetscReal kappa[], PetscReal P[], PetscReal Q[]);
PETSC_INTERN PetscErrorCode CanonSize(Substructure s, PetscReal *size);
PETSC_INTERN PetscReal      CanonWave(const PetscReal x[3], PetscInt direction, PetscReal size, PetscInt j);

/* shapes/inertia.c - answers to the inertia of the static shapes behind the modes of T. Collective. */
PETSC_INTERN PetscErrorCode InertiaAdd(Substructure s);

/* shapes/: fixed.c, free.c - T. Collective. */
PETSC_INTERN PetscErrorCode FixedCreateBasis(Substructure s);
PETSC_INTERN PetscErrorCode FreeCreateBasis(Substructure s);
/* shapes/fixed.c - factors of K_ii, once. Collective. */
PETSC_INTERN PetscErrorCode FixedFactor(Substructure s);
/* shapes/tall.c - room for T with the unknowns of the interface as they are. Collective. */
PETSC_INTERN PetscErrorCode TallCreate(Substructure s, PetscInt n_modal);

/* reduce.c - T'A T of all matrices, and their sums. Collective. */
PETSC_INTERN PetscErrorCode SubstructureReduce(Substructure s);

/* errors.c - modes in the band, and their errors. Collective. */
PETSC_INTERN PetscErrorCode SubstructureMeasure(Substructure s);

/* files/collect.c - a matrix on rank 0, NULL on the others. Collective. */
PETSC_INTERN PetscErrorCode SubstructureCollect(Mat A, Mat *whole);
