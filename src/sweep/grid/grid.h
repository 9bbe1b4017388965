/* Private to sweep/: the points of a sweep, a grid over one or two parameters */
#pragma once

#include <squeal/pencil.h>

#define GRID_MAX_AXES 2

/* A place where the sweep looks: a point of the grid, or a value between two of them that brackets a change of contact
   status */
typedef struct {
  PetscReal value[GRID_MAX_AXES];
  PetscInt  point, line; /* of the grid, point -1 for none; index along the second axis */
  PetscInt  status;      /* which pairs are closed there, a row of SweepGrid.closed; 0 where all are everywhere */
} SweepPlace;

typedef struct {
  PetscInt    n_axes, n_parameters;
  PetscInt    n_moved[GRID_MAX_AXES];   /* parameters that take the values of this axis */
  PetscInt   *parameter[GRID_MAX_AXES]; /* [n_moved] their indices: the swept one, then those linked with it */
  PetscInt    n[GRID_MAX_AXES];
  PetscReal  *value[GRID_MAX_AXES];
  PetscBool   ratio[GRID_MAX_AXES]; /* distances along this axis are ratios: geometric mean, logarithmic plots */
  PetscReal  *base;                 /* [n_parameters] the point that is swept through */
  PetscInt    n_places;
  SweepPlace *place;    /* one line after the other */
  PetscInt   *at;       /* [points] index of the place */
  PetscInt    n_groups; /* of pairs that are closed at some places only; their parameters closed_g come last */
  PetscReal  *closed;   /* [statuses][n_groups] 1 closed, 0 open */
} SweepGrid;

/* "first:last:n", "first:last:n:log" or "v1,v2,..."; errors name the option */
PetscErrorCode GridValuesParse(MPI_Comm comm, const char option[], const char text[], PetscInt *n, PetscReal *value[],
                               PetscBool *ratio);
/* The parameter of that name; errors list the valid ones */
PetscErrorCode GridParameterFind(MPI_Comm comm, Operators operators, const char option[], const char name[],
                                 PetscInt *index);
/* axes.c - raises the error for a parameter that would be overwritten at every point: a stiffness that is identified, a
   force that the sliding state gives. */
PetscErrorCode GridParameterCheck(MPI_Comm comm, Operators operators, PetscBool sliding, const char option[],
                                  const char name[]);
PetscInt       GridSize(const SweepGrid *grid);
PetscInt       GridLines(const SweepGrid *grid);
/* The points of the grid as places, all of status 0 */
PetscErrorCode GridCreatePlaces(SweepGrid *grid);
/* Makes `place` the k-th; leaves out the k-th, which is no point of the grid */
PetscErrorCode GridInsert(SweepGrid *grid, PetscInt k, const SweepPlace *place);
void           GridRemove(SweepGrid *grid, PetscInt k);
/* The axis along which a parameter moves, -1 for none */
PetscInt GridAxisOf(const SweepGrid *grid, PetscInt parameter);
/* Values p[n_parameters] of all parameters at a place, NULL for those of the scene, and at a point */
void GridFill(const SweepGrid *grid, const SweepPlace *place, PetscReal p[]);
void GridPoint(const SweepGrid *grid, PetscInt point, PetscReal p[]);
/* The value half way between two */
PetscReal      GridMiddle(const SweepGrid *grid, PetscInt axis, PetscReal a, PetscReal b);
PetscErrorCode GridDestroy(SweepGrid *grid);
