/* Private to sweep/: changes of stability between two points. Pure functions on small arrays: no MPI, no options. */
#pragma once

#include "frame.h"

/* Appends the event of mode i, which is unstable at this point and not at the other */
PetscErrorCode ChangeAdd(const ModeFrame *frame, PetscInt i, const ModeFrame *other, BranchEvents *events);
/* The same across a change of contact status, half way */
PetscErrorCode ChangeAddJump(const ModeFrame *frame, PetscInt i, const ModeFrame *other, BranchEvents *events);
