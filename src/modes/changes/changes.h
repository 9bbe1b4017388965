/* Private to modes/changes/: what is added to a system whose modes are known - a point mass, a spring, a dashpot or an
   absorber, a layer over many nodes, percents of a parameter - and what these are then */
#pragma once

#include "modes/modesimpl.h"
#include "modes/space/answers.h"

/* One change as its options give it */
struct _p_ModesChange {
  char     *name, *part, *to_part, *with, *unknown, *to_unknown, *set, *parameter; /* empty where not given */
  PetscBool has_at, has_to, has_direction, has_ring, has_percent;
  PetscReal at[3], to[3], direction[3]; /* places asked for, m */
  PetscReal ring[2];                    /* radii on the disc, m */
  PetscReal mass, stiffness, viscosity; /* kg, N/m, N s/m; a mass with one of the others hangs on it, but of a layer */
  PetscReal percent;                    /* of the parameter */
  PetscInt  before;                     /* the change that is made with it, -1 for none */
  PetscReal x[2][3];                    /* places of its nodes, m */
  PetscInt  n_nodes;                    /* of a layer */
  PetscReal value;                      /* of the parameter with the change */
};

/* Of several changes together: m a a', c a a' and k a a', or m A, c A and k A, are added to M, C and K; `hung`: mass m
   on a spring k and a dashpot c, whose motion is a further unknown */
typedef struct {
  Vec       force;     /* a, of all unknowns; NULL: A counts */
  Mat       A;         /* of all unknowns where it is a layer, else of those of the pencil */
  PetscBool layer;     /* symmetric then */
  PetscBool symmetric; /* A is */
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

/* The modes of the system as it was, and behind them its answers to the terms of a change; those of the last two steps
   and of the last one are the columns of the space from first[0] and first[1] */
typedef struct {
  Pencil        owner;
  ModesSpace    space;
  ModesAnswers  answers;
  PetscInt      n_modes, first[2];
  PetscInt      n_solves;
  PetscInt      n_before; /* modes of the system as it was */
  PetscReal    *before;   /* [2 n_before][n_modes] coordinates of their right vectors, real and imaginary parts */
  PetscReal    *length;   /* [n_before] u^H M u of these */
  PetscComplex *lambda;   /* [n_before] their eigenvalues */
  PetscReal    *after;    /* the same of left ones */
  PetscInt      n_terms;  /* that it has answers to */
  ChangeTerm   *term;     /* [n_terms] of these */
  PetscReal **side[2]; /* [n_terms][columns] coordinates of Zl' a and Zr' a; of a matrix [columns][columns] V' A V, and
                           NULL */
} ChangeSpace;

/* terms.c - the terms of a change and of those made with it; the caller destroys them */
PETSC_INTERN PetscErrorCode ChangeCreateTerms(Modes modes, PetscInt i, PetscInt *n, ChangeTerm **terms);
PETSC_INTERN PetscErrorCode ChangeDestroyTerms(PetscInt n, ChangeTerm **terms);
/* place.c, layer.c - adds the terms of one change at nodes, of one over many nodes, behind n that there are */
PETSC_INTERN PetscErrorCode ChangeAddForces(Modes modes, ModesChange change, PetscInt *n, ChangeTerm terms[]);
PETSC_INTERN PetscErrorCode ChangeAddLayer(Modes modes, ModesChange change, PetscInt *n, ChangeTerm terms[]);
/* place.c - the direction of a spring or dashpot as a unit vector, of n = 3 of a node or 1 */
PETSC_INTERN PetscErrorCode ChangeGetDirection(Modes modes, const struct _p_ModesChange *change, PetscInt n,
                                               PetscReal direction[3]);
/* parameter.c - how many terms depend on parameters at most; what the parameters of change i and of those made with it
   add, all at once, behind n that there are */
PETSC_INTERN PetscErrorCode ChangeCountParameterTerms(Modes modes, PetscInt *n);
PETSC_INTERN PetscErrorCode ChangeAddParameters(Modes modes, PetscInt i, PetscInt *n, ChangeTerm terms[]);

/* Eigenvalues and right or left vectors as coordinates in the first `stride` columns of the space */
typedef struct {
  PetscInt      n, stride;
  PetscComplex *lambda; /* [n] rad/s */
  PetscReal    *x;      /* [2 n][stride] real and imaginary parts */
  PetscBool     left;
} ChangeVectors;

typedef struct {
  PetscInt n;
  Vec     *force; /* [n] in the equations of the pencil */
} ChangeForces;

/* spread.c - of the terms that the space has answers to: V' A V of all that have matrices; orthonormal forces that span
   Delta(lambda_j) x_j of such terms, or their transposed ones of left vectors, beyond known orthonormal ones (NULL for
   none) but for what is `drop` of the longest; the caller destroys them. Collective. */
PETSC_INTERN PetscErrorCode ChangeSpaceProject(ChangeSpace *space);
PETSC_INTERN PetscErrorCode ChangeSpaceForces(const ChangeSpace *space, const ChangeVectors *vectors,
                                              const ChangeForces *known, PetscReal drop, ChangeForces *forces);

/* Which eigenvalues are listed, omega in edge[0] to edge[1] and |sigma| <= growth, and what errors of the modes come to
   over their conditions, rad/s */
typedef struct {
  PetscReal edge[2], growth, noise;
} ChangeRange;

/* basis.c - modes; in place of other answers those to the terms, which may be there already. Collective. */
PETSC_INTERN PetscErrorCode ChangeSpaceCreate(Modes modes, const ChangeRange *range, ChangeSpace *space);
/* the terms on the modes alone, without answers */
PETSC_INTERN PetscErrorCode ChangeSpaceTake(ChangeSpace *space, PetscInt n, const ChangeTerm terms[]);
PETSC_INTERN PetscErrorCode ChangeSpaceRespond(ChangeSpace *space, PetscInt n, const ChangeTerm terms[],
                                               const ChangeRange *range);
PETSC_INTERN PetscErrorCode ChangeSpaceDestroy(ChangeSpace *space);

/* dense.c - eigenvalues of the changed system on the space, and their errors */
PETSC_INTERN PetscErrorCode ChangeSolve(const ChangeSpace *space, PetscInt n, const ChangeTerm terms[],
                                        const ChangeRange *range, struct _p_ModesChanged *changed);

/* The same of the terms that the space has answers to, with right (v[0]) and left (v[1]) vectors, for which lambda is
   one array; the caller frees all three arrays */
PETSC_INTERN PetscErrorCode ChangeSolveVectors(const ChangeSpace *space, const ChangeRange *range, ChangeVectors v[2]);

/* before.c - u^H M u of mode i as it was; finds `before` and `overlap` of a mode with right vector x [at least the
   columns of the space] */
PETSC_INTERN PetscErrorCode ChangeMeasureBefore(const ChangeSpace *space, PetscInt i, PetscReal *length);
PETSC_INTERN PetscErrorCode ChangeFindBefore(const ChangeSpace *space, const PetscComplex x[], ChangedMode *mode);

/* quantities.c - the list of the changes; check.c - what no row says of one */
extern const QuantityList   changes_list;
PETSC_INTERN PetscErrorCode ChangeCheck(MPI_Comm comm, void *modes, void *change);

/* coupling.c - modes_couplings.csv, where it is asked for. Collective. */
PETSC_INTERN PetscErrorCode ChangesWriteCouplings(Modes modes, const ChangeRange *range, Results results);
