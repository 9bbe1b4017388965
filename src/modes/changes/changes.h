/* Private to modes/changes/: a point mass, a spring, a dashpot or an absorber that is added to a system whose modes are
   known, and what these are then */
#pragma once

#include "modes/modesimpl.h"
#include "modes/space/krylov.h"

/* One change as its options give it */
struct _p_ModesChange {
  char     *name, *part, *to_part, *with, *unknown, *to_unknown; /* empty where not given */
  PetscBool has_at, has_to, has_direction;
  PetscReal at[3], to[3], direction[3]; /* places asked for, m */
  PetscReal mass, stiffness, viscosity; /* kg, N/m, N s/m; a mass with one of the others hangs on it */
  PetscInt  before;                     /* the change that is made with it, -1 for none */
  PetscReal x[2][3];                    /* places of its nodes, m */
};

/* Of several changes together: m a a', c a a' and k a a' are added to M, C and K; `hung`: mass m on a spring k and a
   dashpot c, whose motion is a further unknown */
typedef struct {
  Vec       force; /* a, of all unknowns */
  PetscReal mass, viscosity, stiffness;
  PetscBool hung;
} ChangeTerm;

#define CHANGE_TERMS 3 /* of one change: a mass along x, y, z */

/* A mode of the changed system, and the one before the change that it resembles most: overlap = |u^H M x|^2 /
   (u^H M u x^H M x) of their right vectors u and x, M as it was */
typedef struct {
  PetscComplex lambda;  /* rad/s */
  PetscReal    error;   /* rad/s */
  PetscInt     before;  /* index of that mode */
  PetscReal    overlap; /* 0 to 1 */
  ModeState    state;
  PetscBool    uncertain; /* the error is large, and within it the mode may be unstable */
} ChangedMode;

/* Those in the band, in order of frequency */
struct _p_ModesChanged {
  PetscInt     n, n_left_out; /* and eigenvalues of the space whose error is no less than they are */
  ChangedMode *mode;          /* [n] */
};

/* The modes of the system as it was, and behind them its answers to the terms of a change, in steps of two Krylov
   chains; those of the last two and of the last step are the columns of the space from first[0] and first[1] */
typedef struct {
  Pencil      owner;
  ModesSpace  space;
  ModesKrylov right, left; /* left is empty for a symmetric pencil */
  PetscInt    n_modes, n_states[2], first[2];
  PetscInt    n_solves;
  PetscInt    n_before; /* modes of the system as it was */
  PetscReal  *before;   /* [2 n_before][n_modes] coordinates of their right vectors, real and imaginary parts */
  PetscReal  *length;   /* [n_before] u^H M u of these */
  PetscInt    n_forces; /* terms that it has answers to */
  Vec        *force;    /* [n_forces] of these */
  PetscReal  *side[2];  /* [n_forces][columns] coordinates of Zl' a and Zr' a */
} ChangeSpace;

/* place.c - how many terms a change may have with those made with it, and these; the caller destroys their vectors */
PETSC_INTERN PetscInt       ChangeMostTerms(const Modes modes, PetscInt i);
PETSC_INTERN PetscErrorCode ChangeCreateTerms(Modes modes, PetscInt i, PetscInt *n, ChangeTerm **terms);
PETSC_INTERN PetscErrorCode ChangeDestroyTerms(PetscInt n, ChangeTerm **terms);

/* basis.c - modes; in place of other answers those to the terms, which may be there already. Collective. */
PETSC_INTERN PetscErrorCode ChangeSpaceCreate(Modes modes, PetscInt most_terms, ChangeSpace *space);
PETSC_INTERN PetscErrorCode ChangeSpaceRespond(ChangeSpace *space, PetscInt n, const ChangeTerm terms[]);
PETSC_INTERN PetscErrorCode ChangeSpaceDestroy(ChangeSpace *space);

/* Which eigenvalues are listed, omega in edge[0] to edge[1] and |sigma| <= growth, and what errors of the modes come to
   over their conditions, rad/s */
typedef struct {
  PetscReal edge[2], growth, noise;
} ChangeRange;

/* dense.c - eigenvalues of the changed system on the space, and their errors */
PETSC_INTERN PetscErrorCode ChangeSolve(const ChangeSpace *space, PetscInt n, const ChangeTerm terms[],
                                        const ChangeRange *range, struct _p_ModesChanged *changed);

/* before.c - u^H M u of mode i as it was; finds `before` and `overlap` of a mode with right vector x [at least the
   columns of the space] */
PETSC_INTERN PetscErrorCode ChangeMeasureBefore(const ChangeSpace *space, PetscInt i, PetscReal *length);
PETSC_INTERN PetscErrorCode ChangeFindBefore(const ChangeSpace *space, const PetscComplex x[], ChangedMode *mode);

/* quantities.c - the list of the changes; place.c - what no row says of one */
extern const QuantityList   changes_list;
PETSC_INTERN PetscErrorCode ChangeCheck(MPI_Comm comm, void *modes, void *change);
