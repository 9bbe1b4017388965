/* Private to sweep/: the points of a sweep, a grid over one or two parameters */
#pragma once

#include <squeal/operators.h>

#define GRID_MAX_AXES 2

typedef struct {
  PetscInt   n_axes, n_parameters;
  PetscInt   parameter[GRID_MAX_AXES]; /* indices of OperatorsGetParameters() */
  PetscInt   n[GRID_MAX_AXES];
  PetscReal *value[GRID_MAX_AXES];
  PetscBool  ratio[GRID_MAX_AXES]; /* distances along this axis are ratios: geometric mean, logarithmic plots */
  PetscReal *base;                 /* [n_parameters] values of the scene */
} Grid;

/* values.c - "first:last:n", "first:last:n:log" or "v1,v2,..."; errors name the option */
PetscErrorCode ValuesParse(MPI_Comm comm, const char option[], const char text[], PetscInt *n, PetscReal *value[],
                           PetscBool *ratio);
/* The parameter of that name; errors list the valid ones */
PetscErrorCode ParameterFind(MPI_Comm comm, const char option[], const char name[], PetscInt n,
                             const OperatorsParameter parameters[], PetscInt *index);
PetscInt       GridSize(const Grid *grid);
/* Values p[n_parameters] of all parameters at a point */
void GridPoint(const Grid *grid, PetscInt point, PetscReal p[]);
/* The value half way between two */
PetscReal      GridMiddle(const Grid *grid, PetscInt axis, PetscReal a, PetscReal b);
PetscErrorCode GridDestroy(Grid *grid);
