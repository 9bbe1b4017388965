/* Options of impulses and of velocities at the start */
#include "externalimpl.h"

#define IMPULSE(member) QUANTITY_AT(Impulse, member)

static const Quantity impulse[] = {
  {"-at", "place x,y,z; the nearest node is hit", "m", QUANTITY_REALS, IMPULSE(at), .given = offsetof(Impulse, has_at),
   .required = PETSC_TRUE, .why = "the place x,y,z (m)"},
  {"-part", "body of the node; any without it", NULL, QUANTITY_NAME, IMPULSE(part)},
  {"-impulse", "momentum in x,y,z; zeros for none", "N s", QUANTITY_REALS, IMPULSE(impulse),
   .given = offsetof(Impulse, has_impulse), .required = PETSC_TRUE, .why = "three values (N s), zeros for none"},
  {"-time", "when", "s", QUANTITY_REAL, IMPULSE(time), QUANTITY_NOT_NEGATIVE},
};
static const Quantity start[] = {
  {"-velocity", "at the start in x,y,z", "m/s", QUANTITY_REALS, .at = 0, .size = 3 * sizeof(PetscReal)},
};

static const QuantityTable impulses       = {"Impulse", "dynamics.h", PETSC_STATIC_ARRAY_LENGTH(impulse), impulse,
                                             .in = RUN_HISTORY | RUN_MAP};
const QuantityTable        start_velocity = {"Start of part", "dynamics.h", PETSC_STATIC_ARRAY_LENGTH(start), start,
                                             .in = RUN_HISTORY};
const QuantityList         impulses_list  = {"-impulses",     "at nodes, each the prefix of its -at and -impulse",
                                             sizeof(Impulse), &impulses,
                                             ImpulseCheck,    .in = RUN_HISTORY | RUN_MAP};
