/* Private: what all ranks solve for themselves is one solution */
#pragma once

#include <slepcds.h>

/* All ranks take the small projected problem of an eigensolver from one: on processors of two kinds they round
   differently */
static inline PetscErrorCode SolverSynchronize(DS ds)
{
  return DSSetParallel(ds, DS_PARALLEL_SYNCHRONIZED);
}
