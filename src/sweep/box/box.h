/*
   Private to the rooms above sweep/: a reduced basis over a box of any number of parameters, made good at scattered
   points of it, on which any point is then solved with an estimate of its errors.
*/
#pragma once

#include "sweep/basis/kept.h"
#include "sweep/grid/groups.h"
#include "sweep/track/track.h"
#include <squeal/statics.h>

/* What is given, then what is made */
typedef struct {
  MPI_Comm       comm;
  Operators      operators;
  Modes          modes;
  Statics        statics; /* about whose sliding state at each point the pencil is, or NULL: all pairs are closed */
  PetscReal     *nominal; /* [n_base]; [n_parameters] from BoxSetUp() on */
  PetscReal      rtol;
  const char    *option, *advice; /* that rtol is of, and what to do where it is not reached */
  PetscInt       max_solutions, n_groups;
  PetscBool      many;    /* points come, for which BoxCompress() pays */
  const Journal *journal; /* for what a killed run goes on from, or NULL; */
  const char    *begin;   /* its files begin so */
  /* */
  PetscInt      n_base, n_parameters; /* parameters of the operators; of the pencil, with those of the statuses */
  StatusList    statuses;             /* empty without statics */
  PetscInt     *status;               /* [points of BoxSetUp() + 1] of each, of the nominal point in the end */
  StaticsMany   equilibria;           /* how they were found */
  PetscInt      n_classes;            /* the first statuses, which the pencil knows */
  StatusPencil  groups_of;            /* the parameters of the statuses */
  Pencil        pencil;
  ReducedWindow window; /* of the eigenvalues asked for */
  ModesLimit    limit;
  Basis         basis;
  Greedy        greedy;
  BasisKept     kept;
  PointGroups   groups;
  Progress      progress;
  PetscBool     whole;  /* the basis is the whole space: no error but rounding */
  Reduced       small;  /* of fewer vectors, for many points; n_used is 0 where there is none */
  PetscReal    *few;    /* [small.n_used][n] these vectors in the basis */
  Reduced       turned; /* the basis in directions that hold less and less, with a core; likewise */
  PetscReal    *turn;   /* [n][n] these directions in the basis */
} Box;

/* Sets these, with the nominal point p, NULL for that of the scene. Collective. */
PETSC_INTERN PetscErrorCode BoxSetRooms(Box *box, MPI_Comm comm, Operators operators, const PetscReal p[], Modes modes,
                                        Statics statics);
/* The statuses at n points, the pencil that holds at all of them, and the basis where it is the whole space. `get`
   tells all parameters p [n_base] of a point. Collective.
   Errors: PETSC_ERR_SUP where sliding states make the pencil not affine. */
PETSC_INTERN PetscErrorCode BoxSetUp(Box *box, PetscInt n, StaticsPoint get, void *ctx);
/* status.c - statuses of n points and of the nominal one, behind them, and the pencil that holds at all. Collective. */
PETSC_INTERN PetscErrorCode BoxLinearise(Box *box, PetscInt n, StaticsPoint get, void *ctx);
/* Puts the status of point i, as BoxSetUp() had it, or one of its classes, into p [n_parameters]. Not collective. */
PETSC_INTERN void BoxPutStatus(const Box *box, PetscInt i, PetscReal p[]);
PETSC_INTERN void BoxPutClass(const Box *box, PetscInt status, PetscReal p[]);
/* The classes of n other points, with statics: `status` [n] that of fewest other pairs, and how many these are, `apart`
   [n]. Collective. */
PETSC_INTERN PetscErrorCode BoxFindClasses(Box *box, PetscInt n, StaticsPoint get, void *ctx, PetscInt status[],
                                           PetscInt apart[]);
/* A point by the eigensolver, about its own sliding state; modes are the eigensolver's until it solves again */
typedef struct {
  PetscInt    n, status, n_closed; /* closed: -1 without statics */
  const Mode *mode;
} BoxFull;
/* At p [n_base or more]. Collective. */
PETSC_INTERN PetscErrorCode BoxSolveFull(Box *box, const PetscReal p[], BoxFull *full);
/* Pairs that are closed there, of all ranks; -1 without statics */
PETSC_INTERN PetscInt BoxClosed(const Box *box, PetscInt i);
/* Enlarges the basis until all n points [n][n_parameters] are estimated within rtol, the first of them by the
   eigensolver. Collective. Errors: PETSC_ERR_NOT_CONVERGED. */
PETSC_INTERN PetscErrorCode BoxFit(Box *box, PetscInt n, const PetscReal points[]);
/* compress.c - makes a model of fewer vectors from the modes of some of the points, estimated within rtol at all of
   them; none where that saves nothing. Collective. */
PETSC_INTERN PetscErrorCode BoxCompress(Box *box, PetscInt n, const PetscReal points[]);
/* export.c - parameters of the operators that vary, where between, and which of them move in step; points whose contact
   statuses are known, all parameters of each */
typedef struct {
  PetscInt         n;
  const PetscInt  *parameter, *variable; /* [n] of the same variable: in step; NULL: each by itself */
  const PetscReal *lower, *upper;
  PetscInt         n_points;
  StaticsPoint     get;
  void            *ctx;
} BoxVaried;
/* Writes reduced_model.bin, of the model of fewer vectors where there is one; nothing where it is too large for a page,
   which the run says, or where a coefficient is no monomial. Collective. */
PETSC_INTERN PetscErrorCode BoxExport(const Box *box, const BoxVaried *varied, Results results);
/* shapes.c - writes reduced_shapes.h5, the vectors of that model on the mesh; nothing where they are too large, without
   a mesh, or with -output_fields 0. Collective. */
PETSC_INTERN PetscErrorCode BoxExportShapes(const Box *box, Results results);
/* Frees it. Not collective. */
PETSC_INTERN PetscErrorCode BoxForgetSmall(Reduced *small);
/* Modes of one point with estimated errors, in the window or a little beyond it (guarded), on the basis or on the model
   of fewer vectors, `small`. Not collective. */
PETSC_INTERN PetscErrorCode BoxSolve(const Box *box, PetscBool small, const PetscReal p[], ReducedModes *modes);
/* The same of n points on the basis, without errors, shared among the ranks, alike on all. Collective. */
PETSC_INTERN PetscErrorCode BoxSolveAll(const Box *box, PetscInt n, const PetscReal points[], ReducedModes modes[]);
/* Whether an eigenvalue is in the window itself. Not collective. */
PETSC_INTERN PetscBool BoxHolds(const Box *box, PetscComplex lambda);
/* Modes at a point with all parameters p, and the branch [modes->n] of each */
typedef struct {
  const PetscReal    *p;
  const ReducedModes *modes;
  PetscInt           *branch;
} BoxModes;
/* Branch of each mode of b from those of a; -1 for those that are none of a's for certain. Where a mode on either side
   is left without partner the way between is divided, `depth` times at most. n_solved grows by the solutions that took.
   Modes are those of the basis, or of `small`, by their size. Not collective. */
PETSC_INTERN PetscErrorCode BoxFollow(const Box *box, const BoxModes *a, BoxModes *b, int depth, PetscInt *n_solved);
PETSC_INTERN PetscErrorCode BoxDestroy(Box *box);
