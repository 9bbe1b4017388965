/*
   The exponential law: with x = c / c0 + 1, c0 the clearance (m) at which rough surfaces begin to press and p0 (Pa) the
   pressure where they meet, c = 0,

      P(c)  = p0 / (e - 1) x (e^x - 1),                    c > -c0,
      P'(c) = p0 / (c0 (e - 1)) (e^x - 1 + x e^x).

   and the energy p0 c0 / (e - 1) (x e^x - e^x + 1 - x^2 / 2). Its inverse solves x (e^x - 1) = y, y = (e - 1) p / p0,
   as F(x) = log x + log(e^x - 1) - log y = 0: F is concave and rises, so that Newton's method climbs without a step
   too long from the lower bound log(1 + sqrt y). Source: Abaqus Analysis User's Guide, "Contact pressure-overclosure
   relationships", softened contact. */
#pragma once

#include "kind.h"
#include <math.h>

#define EXPONENTIAL_STEPS 60 /* at most; some seven are taken */

typedef enum { EXPONENTIAL_C0, EXPONENTIAL_P0 } ExponentialParameter;

static PetscReal ExponentialOnset(const PressureLaw *law)
{
  return -law->parameter[EXPONENTIAL_C0];
}

static PetscReal ExponentialPressure(const PressureLaw *law, PetscReal c)
{
  const PetscReal x = c / law->parameter[EXPONENTIAL_C0] + 1;

  return law->parameter[EXPONENTIAL_P0] / expm1(1.) * x * expm1(x);
}

static PetscReal ExponentialSlope(const PressureLaw *law, PetscReal c)
{
  const PetscReal c0 = law->parameter[EXPONENTIAL_C0], x = c / c0 + 1;

  return law->parameter[EXPONENTIAL_P0] / (c0 * expm1(1.)) * (expm1(x) + x * exp(x));
}

static PetscReal ExponentialClosing(const PressureLaw *law, PetscReal p)
{
  const PetscReal y = expm1(1.) * p / law->parameter[EXPONENTIAL_P0];
  PetscReal       x = log1p(sqrt(y)), step = 1;

  for (int i = 0; i < EXPONENTIAL_STEPS && x > 0 && fabs(step) > PETSC_MACHINE_EPSILON * x; i++) {
    step = (log(x / y) + log(expm1(x))) / (1 / x + exp(x) / expm1(x));
    x -= step;
  }
  return law->parameter[EXPONENTIAL_C0] * (x - 1);
}

static PetscReal ExponentialEnergy(const PressureLaw *law, PetscReal c)
{
  const PetscReal c0 = law->parameter[EXPONENTIAL_C0], x = c / c0 + 1;

  return law->parameter[EXPONENTIAL_P0] * c0 / expm1(1.) * (x * exp(x) - expm1(x) - 0.5 * x * x);
}

static const Quantity exponential_rows[] = {
  {"-pressure_c0", "clearance at which the pressure begins", "m", QUANTITY_REAL, PRESSURE_PARAMETER(EXPONENTIAL_C0),
   QUANTITY_OR_NONE, PRESSURE_READ},
  {"-pressure_p0", "pressure at zero clearance", "Pa", QUANTITY_REAL, PRESSURE_PARAMETER(EXPONENTIAL_P0),
   QUANTITY_OR_NONE, PRESSURE_READ},
};

static const PressureKind exponential_pressure = {.name     = "exponential",
                                                  .n        = 2,
                                                  .n_rows   = 2,
                                                  .row      = exponential_rows,
                                                  .onset    = ExponentialOnset,
                                                  .pressure = ExponentialPressure,
                                                  .slope    = ExponentialSlope,
                                                  .closing  = ExponentialClosing,
                                                  .energy   = ExponentialEnergy};
