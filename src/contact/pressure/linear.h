/* The linear law, p = k c: k is -contact_kn or -contact_kn_per_area, which have rows of their own. */
#pragma once

#include "kind.h"

static PetscReal LinearOnset(const PressureLaw *law)
{
  (void)law;
  return 0;
}

static PetscReal LinearPressure(const PressureLaw *law, PetscReal c)
{
  return law->parameter[0] * c;
}

static PetscReal LinearSlope(const PressureLaw *law, PetscReal c)
{
  (void)c;
  return law->parameter[0];
}

static PetscReal LinearClosing(const PressureLaw *law, PetscReal p)
{
  return p / law->parameter[0];
}

static PetscReal LinearEnergy(const PressureLaw *law, PetscReal c)
{
  return 0.5 * law->parameter[0] * c * c;
}

static const PressureKind linear_pressure = {.name     = "linear",
                                             .n        = 0,
                                             .n_rows   = 0,
                                             .onset    = LinearOnset,
                                             .pressure = LinearPressure,
                                             .slope    = LinearSlope,
                                             .closing  = LinearClosing,
                                             .energy   = LinearEnergy};
