/* Private to sweep/: the full problem at one point of the parameters, solved by improving what the basis gives */
#pragma once

#include "basis.h"
#include "solver/shiftinvert.h"

/* The full pencil at a point and its factorisation */
typedef struct {
  PencilMatrices matrices;
  ShiftInvert    factor;
} Correction;

typedef enum { CORRECT_BOTH, CORRECT_RIGHT, CORRECT_LEFT } CorrectionSides;

/* Sets the pencil to p and factors it at the upper end of the window; the correction is all zeros, or that of another
   point, whose analysis serves again. The caller destroys the factor. */
PetscErrorCode CorrectionCreate(Pencil pencil, const PetscReal p[], const ReducedWindow *window, Progress *progress,
                                Correction *correction);
/* Moves to other values p nearby: the pencil is made for them, the factorisation stays */
PetscErrorCode CorrectionMove(Pencil pencil, const PetscReal p[], Correction *correction);
/* Appends to the basis the corrections of all modes (right and left vectors) whose M-norm exceeds drop; n_added =
   vectors gained */
PetscErrorCode CorrectionApply(const Correction *correction, const ReducedModes *modes, PetscReal drop, Basis *basis,
                               PetscInt *n_added);

/* The same of right or left vectors only */
PetscErrorCode CorrectionApplySides(const Correction *correction, const ReducedModes *modes, CorrectionSides sides,
                                    PetscReal drop, Basis *basis, PetscInt *n_added);

/* Leaves out the modes that the step before has settled: known there, with an error below the tolerance */
PetscErrorCode CorrectionDropSettled(const ReducedModes *before, PetscReal tolerance, ReducedModes *modes);

/* Frictionless modes in the window (from zero on where its lower end is below half of the upper one) by Sylvester's law
   of inertia with the pencil at p, and by the basis; the two are equal where the basis holds every mode. Both are -1 where the
   matrices cannot be made frictionless. */
PetscErrorCode CorrectionCount(const Basis *basis, const PetscReal p[], const ReducedWindow *window,
                               ShiftInvert *counter, PetscInt *full, PetscInt *by_basis);
