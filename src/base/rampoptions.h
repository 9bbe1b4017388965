/* Private: options of ramps in time */
#pragma once

#include <squeal/options.h>
#include "kernels/ramp.h"

/*@
   RampSetFromOptions - reads a ramp between PetscOptionsBegin(), whose prefix names its owner, and PetscOptionsEnd().
   Collective.

   Options Database Keys (press_ being the prefix):
+  -press_ramp <0>                      - length, s; 0 is a jump
.  -press_ramp_shape <smooth|linear>    - cosine, without jumps of the rate, or straight
-  -press_delay <0>                     - time at which it begins, s

   Output Parameter:
.  ramp - the defaults where nothing is given, whatever it was before

   Errors: PETSC_ERR_USER_INPUT for a length or delay that is negative or not finite.
@*/
PETSC_INTERN PetscErrorCode RampSetFromOptions(OptionsItems PetscOptionsObject, Ramp *ramp);

/*@ RampDescribe - words that follow a load or motion, such as "smooth ramp over 0.002 s from 0.001 s" or "at once". Not
    collective. @*/
PETSC_INTERN PetscErrorCode RampDescribe(const Ramp *ramp, size_t size, char words[]);
