/*
   The power law of the closing c (m),

      P(c) = k c^m,   P'(c) = m k c^(m - 1),   c > 0,   m >= 1,

   k in Pa/m^m. m = 2 to 3.3 are measured for machined and lapped surfaces (M. Burdekin, N. Back, A. Cowley, J. Mech.
   Eng. Sci. 20, 1978, 121).
*/
#pragma once

#include "kind.h"
#include <math.h>

typedef enum { POWER_K, POWER_M } PowerParameter;

static PetscReal PowerOnset(const PressureLaw *law)
{
  (void)law;
  return 0;
}

static PetscReal PowerPressure(const PressureLaw *law, PetscReal c)
{
  return law->parameter[POWER_K] * pow(c, law->parameter[POWER_M]);
}

static PetscReal PowerSlope(const PressureLaw *law, PetscReal c)
{
  return law->parameter[POWER_K] * law->parameter[POWER_M] * pow(c, law->parameter[POWER_M] - 1);
}

static PetscReal PowerClosing(const PressureLaw *law, PetscReal p)
{
  return pow(p / law->parameter[POWER_K], 1 / law->parameter[POWER_M]);
}

static PetscReal PowerEnergy(const PressureLaw *law, PetscReal c)
{
  const PetscReal m = law->parameter[POWER_M];

  return law->parameter[POWER_K] * PetscPowReal(c, m + 1) / (m + 1);
}

static const Quantity power_rows[] = {
  {"-pressure_k", "pressure at a closing of 1 m", "Pa/m^m", QUANTITY_REAL, PRESSURE_PARAMETER(POWER_K),
   QUANTITY_OR_NONE, PRESSURE_READ},
  {"-pressure_m", "power of the closing", NULL, QUANTITY_REAL, PRESSURE_PARAMETER(POWER_M), .initial = 2,
   QUANTITY_WITHIN(1, 20), PRESSURE_READ},
};

static const PressureKind power_pressure = {.name     = "power",
                                            .n        = 2,
                                            .n_rows   = 2,
                                            .row      = power_rows,
                                            .onset    = PowerOnset,
                                            .pressure = PowerPressure,
                                            .slope    = PowerSlope,
                                            .closing  = PowerClosing,
                                            .energy   = PowerEnergy};
