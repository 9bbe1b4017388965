/*
   Sweep - complex modes over one or two parameters of the scene. The pencil is affine in monomials of the parameters,

      Q(lambda; p) = lambda^2 M(p) + lambda C(p) + K(p),   each of M, C, K = sum_t c_t(p) A_t,

   and is projected on a small basis V of right and left eigenvectors from full solutions at a few points (Galerkin, the
   same V on both sides: the error of an eigenvalue is then the product of the errors of its right and left vector). A
   point costs one dense problem of the size of V. The points of the full solutions are chosen where the estimated error
   is largest, until it is below -sweep_rtol for every eigenvalue of the band at every point. The error is an estimate,
   not a bound; -sweep_verify compares it with full solutions at points that the basis has never seen.

   Branches follow a mode from point to point by products of right and left vectors; an onset is where one of them
   becomes unstable or stable again. On the basis steps are divided where products do not tell, and onsets are found to
   rounding.
   -sweep_method full solves at the points alone: a branch ends where products do not tell, and an onset has an error
   that reaches both of its points.
*/
#pragma once

#include <squeal/quantity.h>
#include <squeal/modes.h>
#include <squeal/statics.h>

typedef struct _p_Sweep *Sweep;

/*@ SweepCreate - makes a sweep. Collective. @*/
PetscErrorCode SweepCreate(MPI_Comm comm, Sweep *sweep);

/*@ SweepSetModes - the solver of the full problems, with its band (referenced until SweepDestroy()). Collective. @*/
PetscErrorCode SweepSetModes(Sweep sweep, Modes modes);

/*@ SweepSetOperators - the system, affine in its parameters, from which the sweep makes the pencils that it needs
    (referenced until SweepDestroy()), and the point p of its parameters that is swept through, or NULL for the values
    of the scene. Collective. @*/
PetscErrorCode SweepSetOperators(Sweep sweep, Operators operators, const PetscReal p[]);

/*@
   SweepSetStatics - takes the closed pairs from the sliding state at each point (referenced until SweepDestroy());
   NULL: all pairs are closed, as without this call. A change of status between two points is bracketed by further
   static solutions, and modes that are unstable on one side of it only are onsets of the kind jump. The basis covers
   all statuses: what is open at some points and closed at others are further affine terms. Robustness keeps the status
   of the scene's own values. Collective.

   Where the pencil is not affine (StaticsIsAffine()) and no method is given, SweepSolve() solves each point in full.
   Errors of SweepSolve(): PETSC_ERR_SUP, with -sweep_method reduced or real given, where the pencil is not affine, or
   where the status changes and the contact is exact.
@*/
PetscErrorCode SweepSetStatics(Sweep sweep, Statics statics);

/*@
   SweepSetFromOptions - reads what to vary and how accurately. Collective.

   Options are the rows of src/sweep/quantities.c.
@*/
PetscErrorCode SweepSetFromOptions(Sweep sweep);

/*@ SweepVisit - shows the rows of its options. Collective. @*/
PetscErrorCode SweepVisit(Sweep sweep, const QuantityVisitor *visitor);

/*@ SweepGetAsked - -sweep_parameter (borrowed), and whether it projects on real modes, which have no damping. Not
   collective. @*/
PetscErrorCode SweepGetAsked(Sweep sweep, const char **parameter, PetscBool *real);

/*@ SweepSolve - all points, branches, onsets and what else was asked for. Collective. @*/
PetscErrorCode SweepSolve(Sweep sweep, Results results);

/*@ SweepView - what a person wants to know first. Collective. @*/
PetscErrorCode SweepView(Sweep sweep, PetscViewer viewer);

/*@ SweepWrite - sweep.csv, onsets.csv, sensitivities.csv. Collective. @*/
PetscErrorCode SweepWrite(Sweep sweep, Results results);

/*@ SweepDestroy - frees the sweep. Collective. @*/
PetscErrorCode SweepDestroy(Sweep *sweep);
