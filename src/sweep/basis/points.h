/* Private to sweep/: many points on the reduced model, shared among ranks */
#pragma once

#include "sweep/dense/reduced.h"

#define POINTS_MARGIN 3 /* on the estimate: largest true over stated error of scripts/study/errors is 0.91 */
#define RATIO_FROM    5 /* a range whose ends differ by this factor is measured in ratios */

/* Solutions that stay right as long as the model does, each on the rank that made it; begins as {0} */
typedef struct {
  PetscInt      n, n_used; /* points; vectors of the model */
  PetscInt     *estimated; /* [n] size of the basis that the errors are from */
  PetscReal    *p;         /* [n][n_parameters] */
  ReducedModes *all;       /* [n] with all beyond the growth of the window, known or not */
  ReducedModes *modes;     /* [n] with errors */
  ReducedWindow window;
} PointStore;

/* Groups of ranks, each of which takes its share of the points */
typedef struct {
  MPI_Comm    comm;
  PetscInt    n_groups;
  PointStore *store; /* NULL: nothing is kept */
} PointGroups;

/* The rank that solves point i */
PetscMPIInt PointGroupsOwner(const PointGroups *groups, PetscInt i);
/* Modes with estimated errors at n points [n][n_parameters], alike on all ranks. Collective. */
PetscErrorCode PointsSolve(const PointGroups *groups, const Reduced *reduced, const ReducedWindow *window, PetscInt n,
                           const PetscReal points[], ReducedModes modes[]);
/* One point with estimated errors, taken from the store (may be NULL) where it has it, which keeps it. Not
   collective. */
PetscErrorCode PointStoreSolve(PointStore *store, const Reduced *reduced, const ReducedWindow *window,
                               const PetscReal p[], ReducedModes *modes);
/* Errors of the modes of a point with the margin that they are handed on with. Not collective. */
PetscErrorCode PointEstimate(const Reduced *reduced, const PetscReal p[], ReducedModes *modes);
PetscErrorCode PointStoreDestroy(PointStore *store);
/* Gives all ranks the modes of one of them, freeing what they had. Collective. */
PetscErrorCode ReducedModesBroadcast(MPI_Comm comm, PetscMPIInt owner, ReducedModes *modes);
/* Largest estimated relative error of the modes in the window, with or without rounding; rigid ones do not count */
PetscReal ReducedModesWorst(const ReducedModes *modes, const ReducedWindow *window, PetscBool rounding);
/* The same at n points, without rounding. Collective. */
PetscErrorCode PointsEstimate(const PointGroups *groups, const Reduced *reduced, const ReducedWindow *window,
                              PetscInt n, const PetscReal points[], PetscReal worst[]);
/* Extent of the points along each parameter, scale[n_parameters] of points [n][n_parameters]: the length of the range,
   or the negative logarithm of its ratio where the ends differ by a factor of RATIO_FROM; 0 for a parameter that does
   not vary. Groups of pairs that open or close count as one parameter together: the distance of two statuses, squared,
   is the share of the groups in which they differ. */
PetscErrorCode PointsScale(Pencil pencil, PetscInt n_points, const PetscReal points[], PetscReal scale[]);
