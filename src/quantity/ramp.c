/*
   Ramps in time from the options of their owner, and in words.
*/
#include "ramp.h"

static const char *const shapes[] = {[RAMP_LINEAR] = "linear", [RAMP_SMOOTH] = "smooth", NULL};

static const char *RampIdleShape(const void *ramp, const QuantityRun *run)
{
  (void)run;
  return ((const Ramp *)ramp)->length > 0 ? NULL : "not used without a positive -@ramp";
}

static const Quantity rows[] = {
  {"-ramp", "time from nothing to all of it", "s", QUANTITY_REAL, QUANTITY_AT(Ramp, length), QUANTITY_NOT_NEGATIVE},
  {"-ramp_shape", "how it grows", NULL, QUANTITY_WORD, QUANTITY_AT(Ramp, shape), .initial = RAMP_SMOOTH,
   .words = shapes, .idle = RampIdleShape},
  {"-delay", "time at which it begins", "s", QUANTITY_REAL, QUANTITY_AT(Ramp, delay), QUANTITY_NOT_NEGATIVE},
};

PetscErrorCode RampVisit(const QuantityVisitor *visitor, const char title[], const char name[], Ramp *ramp,
                         const char why[])
{
  const QuantityTable table = {title, "dynamics.h", PETSC_STATIC_ARRAY_LENGTH(rows), rows, .in = RUN_HISTORY};

  PetscFunctionBeginUser;
  PetscCall(QuantitiesVisit(visitor, &table, name, ramp, why));
  PetscFunctionReturn(0);
}

PetscErrorCode RampSetFromOptions(MPI_Comm comm, const char title[], const char name[], Ramp *ramp)
{
  PetscFunctionBeginUser;
  *ramp = (Ramp){.shape = RAMP_SMOOTH};
  PetscCall(RampVisit(&(QuantityVisitor){QuantitiesReadVisited, &comm}, title, name, ramp, NULL));
  PetscFunctionReturn(0);
}

PetscErrorCode RampDescribe(const Ramp *ramp, size_t size, char words[])
{
  char from[64] = "";

  PetscFunctionBeginUser;
  if (ramp->delay > 0) PetscCall(PetscSNPrintf(from, sizeof(from), " from %.6g s", ramp->delay));
  if (ramp->length > 0)
    PetscCall(PetscSNPrintf(words, size, "%s ramp over %.6g s%s", shapes[ramp->shape], ramp->length, from));
  else
    PetscCall(PetscSNPrintf(words, size, "at once%s", from));
  PetscFunctionReturn(0);
}
