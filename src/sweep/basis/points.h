/* Private to sweep/: many points on the reduced model, shared among ranks */
#pragma once

#include "sweep/dense/reduced.h"

/* Groups of ranks, each of which takes its share of the points */
typedef struct {
  MPI_Comm comm;
  PetscInt n_groups;
} Groups;

/* Whether this rank solves point i, and the rank that does */
PetscMPIInt GroupsOwner(const Groups *groups, PetscInt i);
/* Modes with estimated errors at n points [n][n_parameters], alike on all ranks. Collective. */
PetscErrorCode PointsSolve(const Groups *groups, const Reduced *reduced, const ReducedWindow *window, PetscInt n,
                           const PetscReal points[], ReducedModes modes[]);
/* Gives all ranks the modes of one of them, freeing what they had. Collective. */
PetscErrorCode ReducedModesBroadcast(MPI_Comm comm, PetscMPIInt owner, ReducedModes *modes);
/* Largest estimated relative error of the modes in the window, but for rounding; rigid ones do not count */
PetscReal ModesWorst(const ReducedModes *modes, const ReducedWindow *window);
/* The same at n points. Collective. */
PetscErrorCode PointsEstimate(const Groups *groups, const Reduced *reduced, const ReducedWindow *window, PetscInt n,
                              const PetscReal points[], PetscReal worst[]);
