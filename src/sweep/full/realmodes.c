/*
   Projection on real modes, for comparison with other programs: at each point the pencil is projected on the n_real
   lowest real modes X of that point (basis/fill.c), as a deck for each value does it,

      (lambda^2 X' M X + lambda X' C X + X' K X) z = 0,

   lambda in rad/s. Nothing joins two points: there are no branches and no onsets, and no error is known.
*/
#include "follow.h"

#define SHIFT_LOW  0.1  /* of the lower end of the band, */
#define SHIFT_HIGH 1e-3 /* or of the upper one: distance of the shift below zero, where zeros are regular */

/* The shift is -omega^2, (rad/s)^2: below zero, so that zeros of free bodies are regular, and the nearest modes are
   the lowest. */
static PetscErrorCode RealBasisMake(Sweep sweep, const PetscReal p[])
{
  const PetscReal omega    = PetscMax(SHIFT_LOW * sweep->window.low, SHIFT_HIGH * sweep->window.high);
  const PetscBool friction = sweep->real_stiffness == SWEEP_SYMMETRISED ? PETSC_TRUE : PETSC_FALSE;

  PetscFunctionBeginUser;
  PetscCall(BasisDestroy(&sweep->basis));
  PetscCall(PencilSetParameters(sweep->pencil, p));
  PetscCall(BasisCreate(sweep->comm, sweep->pencil, &sweep->basis));
  sweep->basis.reduced.limit = sweep->limit;
  PetscCall(BasisFillReal(&sweep->basis, friction, sweep->n_real, -PetscSqr(omega), &sweep->progress));
  PetscFunctionReturn(0);
}

/* Replaces the basis of the sweep. One group: rank 0 solves the dense problem of the one point. */
PetscErrorCode SweepRealSolve(Sweep sweep, const PetscReal p[], const ReducedWindow *window, ReducedModes *modes)
{
  const PointGroups groups = {sweep->comm, 1, NULL};

  PetscFunctionBeginUser;
  PetscCall(RealBasisMake(sweep, p));
  PetscCall(PointsSolve(&groups, &sweep->basis.reduced, window, 1, p, modes));
  PetscFunctionReturn(0);
}

/* Modes and names at place i of the line */
static PetscErrorCode PlaceSolve(Sweep sweep, PetscInt i, LinePoints *points)
{
  const PetscReal *p     = &points->p[i * sweep->grid.n_parameters];
  ReducedModes    *modes = &points->modes[i];
  char(*label)[32];

  PetscFunctionBeginUser;
  PetscCall(SweepRealSolve(sweep, p, &sweep->window, modes));
  PetscCall(PetscMalloc1(modes->n, &points->branch[i]));
  PetscCall(PetscCalloc1(modes->n, &points->name[i]));
  PetscCall(PetscCalloc1(modes->n, &label));
  PetscCall(BasisKeepFree(&sweep->basis, sweep->modes, p));
  PetscCall(BasisLabelModes(&sweep->basis, sweep->modes, p, modes, label));
  for (PetscInt k = 0; k < modes->n; k++) {
    points->branch[i][k] = -1;
    PetscCall(PetscStrncpy(points->name[i][k].text, label[k], sizeof(points->name[i][k].text)));
  }
  PetscCall(PetscFree(label));
  PetscFunctionReturn(0);
}

PetscErrorCode SweepReal(Sweep sweep)
{
  LinePoints points;
  Follow     none = {NULL, NULL}; /* no branches are followed */
  PetscBool  taken;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(sweep->grid.n_places, &sweep->worst));
  PetscCall(SweepResumePlaces(sweep, &none));
  for (PetscInt line = 0; line < GridLines(&sweep->grid); line++) {
    PetscCall(LineCreate(sweep, line, &points));
    PetscCall(PetscCalloc1(points.n, &points.name));
    for (PetscInt i = 0; i < points.n; i++) {
      if (sweep->grid.place[points.first + i].point < 0) continue;
      PetscCall(SweepTakePlace(sweep, i, &points, &taken));
      if (taken) continue;
      PetscCall(PlaceSolve(sweep, i, &points));
      PetscCall(SweepKeepPlace(sweep, i, &points, &none));
    }
    PetscCall(LineFinish(sweep, 0, 0, &points));
    PetscCall(LineDestroy(&points));
  }
  PetscFunctionReturn(0);
}
