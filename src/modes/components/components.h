/* Private to modes/: which free modes of the bodies make up a mode (see components.c) */
#pragma once

#include "modes/modesimpl.h"

/* Parts, superelements after those of the mesh, that share nodes, ties or rigid points are one body */
struct _p_FreeBodies {
  PetscInt  n;
  char    **name;    /* [n] the names of its parts with + between */
  PetscInt *of;      /* [unknowns of this rank] body of each */
  PetscInt *of_part; /* [parts, superelements] body of each, -1 for one without unknowns */
};

/* Free modes of one frequency, which are any basis of a plane: they have one share */
typedef struct {
  PetscInt  first, n; /* modes of the pencil of the bodies */
  PetscReal omega;    /* rad/s */
  PetscReal error;    /* of omega, an estimate, rad/s */
  PetscReal residual; /* as of Modes, (rad/s)^2 */
  PetscReal mixed;    /* what its shapes are off by, relative */
  PetscBool rigid;
  PetscInt  body; /* -1: bodies of a solution, which knows none, may share it */
} FreeLevel;

/* A level of one body */
typedef struct {
  PetscInt n, first; /* of its modes that are of this body; before it in the body */
  char     name[32];
} FreeMode;

struct _p_ModesComponents {
  FreeBodies bodies; /* those of the modes (shallow) */
  PetscInt   n_levels;
  FreeLevel *level;      /* [levels] by frequency */
  FreeMode  *free;       /* [levels][bodies] */
  PetscReal *own;        /* [free modes][bodies]: phi' M_b phi, which is 1 for the body that moves */
  PetscReal *share;      /* [modes][levels + 1][bodies], the last one of the whole body: by left and right vector */
  PetscReal *energy;     /* likewise, of the right vector alone */
  PetscReal *mixed;      /* [modes] what the shape is off by, as in FreeLevel */
  PetscBool  found;      /* free modes from the modes found: unstable modes alone have rows */
  PetscBool  names;      /* kept for names alone: modes named after a part have energies, none has shares (kept.c) */
  Vec        probe;      /* of these the sum of the first free modes of the bodies, one of each; else NULL */
  PetscInt  *found_of;   /* [free modes] their bodies; NULL of a solution */
  PetscInt   n_vectors;  /* of the basis in which they were found; 0 of a solution */
  PetscInt (*column)[4]; /* [modes] right and left vector, real and imaginary part, in the basis; -1 for 0 */
  PetscReal *dot, *mass; /* [free modes][vectors] phi' M v; [bodies][vectors][vectors] v' M_b v */
};

/* names.c - whether mode i is unstable or named after a part. Not collective */
PETSC_INTERN PetscBool ComponentsAsks(const Modes modes, PetscInt i);

#define FREE_MOTIONS 6 /* rigid ones of a body in space */

/* Vectors among which free modes are sought, body by body: what of each belongs to the body alone. The last are
   FREE_MOTIONS */
typedef struct {
  PetscInt   n, n_bodies;
  Vec       *v;                 /* [n] in all unknowns (borrowed, but for the last FREE_MOTIONS) */
  PetscInt **row, *n_rows;      /* [bodies] the unknowns of this rank that are of each */
  PetscReal *mass, *stiffness;  /* [bodies][n][n] V_b' M V_b, V_b' K V_b */
  PetscInt  *n_rigid, *n_modes; /* [bodies] modes among them: rigid ones, the first; all */
  PetscReal *kappa, *Z;         /* [bodies][n] (rad/s)^2, ascending; [bodies][n][n] vector k is V_b Z[b][k] */
} FreeBasis;

/* Stiffness K + less and mass of the bodies apart, in all unknowns; less is NULL for none */
typedef struct {
  Mat K, less, M;
} FreeMatrices;

/* ritz.c - AX = M X, (K + less) X */
PETSC_INTERN PetscErrorCode FreeMatricesMultiply(const FreeMatrices *bodies, Mat X, const Mat AX[2]);
/*  makes room for n vectors, which the caller sets; measures and solves; columns first, first + 1, ... of F
   become modes begin .. end - 1 of body b, zero elsewhere. Collective, results alike on all ranks */
PETSC_INTERN PetscErrorCode FreeBasisCreate(const FreeBodies *of, Mat M, PetscInt n, FreeBasis *basis);
PETSC_INTERN PetscErrorCode FreeBasisSolve(const FreeMatrices *bodies, FreeBasis *basis);
typedef struct {
  PetscInt begin, end, first;
} LiftRange;

PETSC_INTERN PetscErrorCode FreeBasisLift(const FreeBasis *basis, PetscInt b, const LiftRange *range, Mat F);
PETSC_INTERN PetscErrorCode FreeBasisDestroy(FreeBasis *basis);
/* reduce.c - the modes of a body among its scaled vectors, of G and H [n][n]; G is overwritten. Not collective */
typedef struct {
  PetscReal *Z, *kappa; /* [n][n], [n] as of FreeBasis */
  PetscInt  *n_rigid, *n_modes;
} FreeBodyModes;

PETSC_INTERN PetscErrorCode FreeBodySolve(PetscInt n, PetscReal G[], const PetscReal H[], const FreeBodyModes *modes);
/* One free mode among the bodies' */
typedef struct {
  PetscInt  column, body, of; /* column in F, its body, its number there */
  PetscReal kappa, error;
  PetscBool rigid;
} FoundMode;

/* judge.c - kappa by Rayleigh's quotient and errors of those of n free modes that are not rigid, the columns phi of F
   with phi'M phi = 1, from what is known of kappa; Z as of OperatorsGetDependents(). Collective */
PETSC_INTERN PetscErrorCode FoundJudge(const FreeMatrices *bodies, Mat Z, Mat F, PetscInt n, FoundMode found[]);
/* found.c - sets the last vectors of a basis, rigid motions; the first n_modes[b] modes of each body that are
   good, named after the disc where they are of it, body by body, c->found_of. Collective */
PETSC_INTERN PetscErrorCode FreeBasisSetMotions(Operators operators, FreeBasis *basis);
PETSC_INTERN PetscErrorCode FreeBasisCollect(Operators operators, const FreeMatrices *bodies, const FreeBasis *basis,
                                             const PetscInt n_modes[], ModesComponents c, Modes free);
/* found.c - free modes from the modes found, without a solution: those below the highest that takes part in a mode that
   is unstable or named after a part; `free` is empty before. They
   follow body by body, c->found_of. Collective */
PETSC_INTERN PetscErrorCode FreeModesTake(Modes modes, ModesComponents c, Modes free);

/* components.c - a solver of free modes, empty; sorts free modes into levels: those whose errors overlap are one;
   shares and energies of modes in them. Collective */
PETSC_INTERN PetscErrorCode FreeModesBegin(Modes modes, Modes *free);
PETSC_INTERN PetscErrorCode FreeLevelsFind(const Modes free, ModesComponents c);
PETSC_INTERN PetscErrorCode FreeSharesFind(Modes modes, const Modes free, ModesComponents c);

/* bodies.c - bodies of the unknowns of a pencil with pairs open, whose terms are there. Collective */
PETSC_INTERN PetscErrorCode FreeBodiesFind(Pencil pencil, FreeBodies **bodies);
/* sums[b] += sum of a_u b_u over the unknowns of body b of this rank; a zero vector is NULL. Not collective */
PETSC_INTERN PetscErrorCode FreeBodiesAddDot(const FreeBodies *bodies, Vec a, Vec b, PetscReal sums[]);
/* names.c - numbers and names of the levels of each body; then new labels of the modes that are named after a part */
PETSC_INTERN PetscErrorCode FreeLevelsName(Modes modes, const Modes free, Mat M, ModesComponents c);
PETSC_INTERN PetscErrorCode ComponentsLabel(Modes modes);
