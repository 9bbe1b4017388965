/*
   Idle - options of the command line that do nothing in rooms which take reduced models and run no transient from its
   beginning to its end. Private to them. What an options file says of a transient is fine, since files are shared.
*/
#pragma once

#include <squeal/reduced.h>

/* ReducedRefuseIdle - how a transient begins, what it records and checks; ramps, delays and velocities of the scene;
   `why` ends the message. Collective. */
PETSC_INTERN PetscErrorCode ReducedRefuseIdle(MPI_Comm comm, Operators operators, const char why[]);

/* ReducedRefuseLate - impulses that are not before the last step of runs to `end` (s), which nothing goes on from.
   Collective. */
PETSC_INTERN PetscErrorCode ReducedRefuseLate(ReducedRun reduced, PetscReal end);

/* ReducedRefuseImpulses - -impulses, and what the command line says of each. Collective, after ReducedPrepare(). */
PETSC_INTERN PetscErrorCode ReducedRefuseImpulses(ReducedRun reduced, const char why[]);
