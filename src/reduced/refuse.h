/* Refuse - what comes too late for rooms that take reduced models. Private to them */
#pragma once

#include <squeal/reduced.h>

/* ReducedRefuseLate - impulses that are not before the last step of runs to `end` (s), which nothing goes on from.
   Collective. */
PETSC_INTERN PetscErrorCode ReducedRefuseLate(ReducedRun reduced, PetscReal end);
