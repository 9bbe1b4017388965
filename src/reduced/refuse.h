/* Refuse - what comes too late for rooms that take reduced models. Private to them */
#pragma once

#include <squeal/reduced.h>

/* ReducedRefuseVarying - motions, and loads, sliding and friction that go on to change, which `by`, such as "-analysis
   map", has not; after ReducedPrepare(). Collective. */
PETSC_INTERN PetscErrorCode ReducedRefuseVarying(ReducedRun reduced, const char by[]);

/* ReducedRefuseLate - impulses that are not before the last step of runs to `end` (s), which nothing goes on from.
   Collective. */
PETSC_INTERN PetscErrorCode ReducedRefuseLate(ReducedRun reduced, PetscReal end);
