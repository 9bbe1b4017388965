/* Private to sweep/: the full problem at one point of the parameters, solved by improving what the basis gives */
#pragma once

#include "basis.h"
#include "solver/factor/shiftinvert.h"

/* The full pencil at a point and a factorisation, which may be that of another point; begins as {0} */
typedef struct {
  PencilMatrices matrices;
  ShiftInvert    factor;
  PetscReal     *p;          /* [n_parameters] where it was factored */
  PetscBool      has_factor; /* and at the upper end of the window */
} Correction;

typedef enum { CORRECT_BOTH, CORRECT_RIGHT, CORRECT_LEFT } CorrectionSides;

/* Residuals of modes at any number of points, whose corrections are then solved for together; begins as {0} */
typedef struct {
  BV         side[2];  /* of right and left vectors */
  PetscInt   n[2];     /* columns */
  PetscReal *omega[2]; /* |lambda| of the mode of each, rad/s */
} CorrectionBlock;

/* What is left out of corrections: what is shorter than `length` in M, where `energy` is zero; else of each one at most
   `energy` |lambda|^2 in z'(K + h^2 M) z, so that kappa errs by `energy` |kappa| where its vectors lack it */
typedef struct {
  PetscReal length, energy;
} CorrectionDrop;

/* Sets the pencil to p and factors it at the upper end of the window; where the correction is that of another point its
   analysis serves again */
PetscErrorCode CorrectionFactor(Pencil pencil, const PetscReal p[], const ReducedWindow *window, Progress *progress,
                                Correction *correction);
PetscErrorCode CorrectionDestroy(Correction *correction);
/* Moves to other values p: the pencil is made for them, the factorisation stays */
PetscErrorCode CorrectionMove(Pencil pencil, const PetscReal p[], Correction *correction);
/* How well the factorisation serves p: the largest over the least ratio of a coefficient of the stiffness at p and
   where it was factored, one at the same point, not finite where a term comes, goes, or changes its sign. The
   eigenvalues of P^-1 K(p), P factored below all of them and without friction, lie between those two ratios. */
PetscReal CorrectionSpread(const Correction *correction, const Reduced *reduced, const PetscReal p[]);
/* Adds the residuals of modes at the point that the pencil is at */
PetscErrorCode CorrectionCollect(const Correction *correction, const ReducedModes *modes, CorrectionSides sides,
                                 const Basis *basis, CorrectionBlock *block);
/* Appends the corrections to the basis, n_added = vectors gained, and empties the block */
PetscErrorCode CorrectionApply(const Correction *correction, CorrectionDrop drop, Basis *basis, CorrectionBlock *block,
                               PetscInt *n_added);

/* Its two steps: Z = P^-1 and P^-T of both sides, in as many columns; and what these hold beyond the basis into it */
PetscErrorCode CorrectionSolve(const Correction *correction, const Basis *basis, CorrectionBlock *block, BV *Z);
PetscErrorCode CorrectionAppend(const Correction *correction, CorrectionDrop drop, Basis *basis, CorrectionBlock *block,
                                BV Z, PetscInt *n_added);

/* Leaves out the modes that the step before has settled: known there, with an error below the tolerance */
PetscErrorCode CorrectionDropSettled(const ReducedModes *before, PetscReal tolerance, ReducedModes *modes);

/* Frictionless modes in the window (from zero on where its lower end is below half of the upper one) by Sylvester's law
   of inertia with the pencil at p, and by the basis; the two are equal where the basis holds every mode. Both are -1
   where the matrices cannot be made frictionless. */
PetscErrorCode CorrectionCount(const Basis *basis, const PetscReal p[], const ReducedWindow *window,
                               ShiftInvert *counter, PetscInt *full, PetscInt *by_basis);
