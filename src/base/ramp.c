/*
   Ramps in time from the options of their owner, and in words.
*/
#include "ramp.h"

static const char *const shapes[RAMP_N_SHAPES] = {[RAMP_LINEAR] = "linear", [RAMP_SMOOTH] = "smooth"};

/* A time of at least 0, s */
static PetscErrorCode TimeSetFromOptions(OptionsItems PetscOptionsObject, const char option[], const char help[],
                                         double *time)
{
  const char *prefix = PetscOptionsObject->prefix ? PetscOptionsObject->prefix : "";
  PetscReal   value  = *time;

  PetscFunctionBeginUser;
  PetscCall(OptionsCheckNumber(PetscOptionsObject, option));
  PetscCall(OptionsGetReal(PetscOptionsObject, option, help, value, &value, NULL));
  PetscCheck(value >= 0, PetscOptionsObject->comm, PETSC_ERR_USER_INPUT, "-%s%s %.6g must be a time of at least 0 (s)",
             prefix, option + 1, (double)value);
  *time = value;
  PetscFunctionReturn(0);
}

PetscErrorCode RampSetFromOptions(OptionsItems PetscOptionsObject, Ramp *ramp)
{
  const char *prefix = PetscOptionsObject->prefix ? PetscOptionsObject->prefix : "";
  PetscInt    shape  = RAMP_SMOOTH;
  char        option[256], why[256];

  PetscFunctionBeginUser;
  *ramp = (Ramp){.shape = RAMP_SMOOTH};
  PetscCall(TimeSetFromOptions(PetscOptionsObject, "-ramp", "time from nothing to all of it, s", &ramp->length));
  PetscCall(
    PetscOptionsEList("-ramp_shape", "how it grows", "ramp.h", shapes, RAMP_N_SHAPES, shapes[shape], &shape, NULL));
  PetscCall(TimeSetFromOptions(PetscOptionsObject, "-delay", "time at which it begins, s", &ramp->delay));
  ramp->shape = (RampShape)shape;
  if (ramp->length > 0) PetscFunctionReturn(0);
  PetscCall(PetscSNPrintf(option, sizeof(option), "-%sramp_shape", prefix));
  PetscCall(PetscSNPrintf(why, sizeof(why), "not used without a positive -%sramp", prefix));
  PetscCall(OptionsRefuse(PetscOptionsObject->comm, option, why));
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
