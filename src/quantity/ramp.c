/*
   Ramps and what they come to from the options of their owner, and in words.
*/
#include "ramp.h"

static const char *const shapes[] = {[RAMP_LINEAR] = "linear", [RAMP_SMOOTH] = "smooth", NULL};

static const char *RampIdleShape(const void *ramp, const QuantityRun *run)
{
  (void)run;
  return ((const Ramp *)ramp)->length > 0 ? NULL : "not used without a positive -@ramp";
}

static const char *RampIdlePhase(const void *ramp, const QuantityRun *run)
{
  (void)run;
  return ((const Ramp *)ramp)->frequency > 0 ? NULL : "not used without -@frequency";
}

static const Quantity rows[] = {
  {"-ramp", "time from nothing to all of it", "s", QUANTITY_REAL, QUANTITY_AT(Ramp, length), QUANTITY_NOT_NEGATIVE},
  {"-ramp_shape", "how it grows", NULL, QUANTITY_WORD, QUANTITY_AT(Ramp, shape), .initial = RAMP_SMOOTH,
   .words = shapes, .idle = RampIdleShape},
  {"-delay", "time at which it begins", "s", QUANTITY_REAL, QUANTITY_AT(Ramp, delay), QUANTITY_NOT_NEGATIVE},
  {"-frequency", "it swings about zero from the delay on, as a cosine", "Hz", QUANTITY_REAL,
   QUANTITY_AT(Ramp, frequency), QUANTITY_OR_NONE},
  {"-phase", "phase of the cosine of -..._frequency when it begins", "degrees", QUANTITY_REAL, QUANTITY_AT(Ramp, phase),
   .idle = RampIdlePhase},
  {"-history", "instead of a frequency: file of time_s,factor from the delay on, straight between its rows", NULL,
   QUANTITY_PATH, QUANTITY_AT(Ramp, file), .path = "file"},
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
  PetscCall(RampSetUp(comm, name, ramp));
  PetscFunctionReturn(0);
}

PetscErrorCode RampSwings(const char name[], PetscBool *swings)
{
  char      option[160];
  PetscReal frequency = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(option, sizeof(option), "-%s_frequency", name));
  PetscCall(PetscOptionsGetReal(NULL, NULL, option, &frequency, NULL));
  *swings = frequency > 0 ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(0);
}

PetscErrorCode RampSetUp(MPI_Comm comm, const char name[], Ramp *ramp)
{
  PetscFunctionBeginUser;
  if (!ramp->file[0]) PetscFunctionReturn(0);
  PetscCheck(!(ramp->frequency > 0), comm, PETSC_ERR_USER_INPUT,
             "-%s_frequency and -%s_history are given; give one of them", name, name);
  PetscCheck(ramp->length == 0, comm, PETSC_ERR_USER_INPUT,
             "-%s_ramp and -%s_history are given; let the table begin with the ramp", name, name);
  PetscCall(RampReadTable(comm, name, ramp));
  PetscFunctionReturn(0);
}

PetscErrorCode RampDestroy(Ramp *ramp)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(ramp->time));
  PetscCall(PetscFree(ramp->factor));
  PetscCall(PetscFree(ramp->area));
  ramp->n = 0;
  PetscFunctionReturn(0);
}

PetscErrorCode RampAddChecksum(const Ramp *ramp, Checksum checksum)
{
  const PetscReal all[] = {(PetscReal)ramp->shape, ramp->delay, ramp->length, ramp->frequency, ramp->phase};

  PetscFunctionBeginUser;
  PetscCall(ChecksumAddReals(checksum, PETSC_STATIC_ARRAY_LENGTH(all), all));
  PetscCall(ChecksumAddReals(checksum, ramp->n, ramp->time));
  PetscCall(ChecksumAddReals(checksum, ramp->n, ramp->factor));
  PetscFunctionReturn(0);
}

PetscErrorCode RampDescribe(const Ramp *ramp, size_t size, char words[])
{
  const PetscInt last     = ramp->n - 1;
  char           from[64] = "", then[80] = "";

  PetscFunctionBeginUser;
  if (ramp->delay > 0) PetscCall(PetscSNPrintf(from, sizeof(from), " from %.6g s", ramp->delay));
  if (ramp->frequency > 0)
    PetscCall(
      PetscSNPrintf(then, sizeof(then), ", swings at %.6g Hz from %.6g degrees on", ramp->frequency, ramp->phase));
  if (ramp->n)
    PetscCall(PetscSNPrintf(then, sizeof(then), ", then a table to %.6g s, %.6g of it from there on",
                            (double)ramp->time[last], (double)ramp->factor[last]));
  if (ramp->length > 0)
    PetscCall(PetscSNPrintf(words, size, "%s ramp over %.6g s%s%s", shapes[ramp->shape], ramp->length, from, then));
  else
    PetscCall(PetscSNPrintf(words, size, "at once%s%s", from, then));
  PetscFunctionReturn(0);
}
