/* Private to sweep/: many points on the reduced model, shared among ranks */
#pragma once

#include "sweep/dense/reduced.h"

#define RATIO_FROM 5 /* a range whose ends differ by this factor is measured in ratios */

/* Groups of ranks, each of which takes its share of the points */
typedef struct {
  MPI_Comm comm;
  PetscInt n_groups;
} PointGroups;

/* Modes with estimated errors at n points [n][n_parameters], alike on all ranks. Collective. */
PetscErrorCode PointsSolve(const PointGroups *groups, const Reduced *reduced, const ReducedWindow *window, PetscInt n,
                           const PetscReal points[], ReducedModes modes[]);
/* Gives all ranks the modes of one of them, freeing what they had. Collective. */
PetscErrorCode ReducedModesBroadcast(MPI_Comm comm, PetscMPIInt owner, ReducedModes *modes);
/* Largest estimated relative error of the modes in the window, with or without rounding; rigid ones do not count */
PetscReal ReducedModesWorst(const ReducedModes *modes, const ReducedWindow *window, PetscBool rounding);
/* The same at n points, without rounding. Collective. */
PetscErrorCode PointsEstimate(const PointGroups *groups, const Reduced *reduced, const ReducedWindow *window,
                              PetscInt n, const PetscReal points[], PetscReal worst[]);
/* Extent of the points along each parameter, scale[n_parameters] of points [n][n_parameters]: the length of the range, or the negative logarithm of
   its ratio where the ends differ by a factor of RATIO_FROM; 0 for a parameter that does not vary. Groups of pairs that
   open or close count as one parameter together: the distance of two statuses, squared, is the share of the groups in
   which they differ. */
PetscErrorCode PointsScale(Pencil pencil, PetscInt n_points, const PetscReal points[], PetscReal scale[]);
