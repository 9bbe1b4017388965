/*
   Stribeck friction: it falls from static to kinetic over the Stribeck speed s_0, and rises with the viscous part b,

      mu(s)  = mu_k + (mu_s - mu_k) e + b s,        e = exp(-(s / s_0)^2),
      mu'(s) = -2 (mu_s - mu_k) e s / s_0^2 + b.

   Unlike static_kinetic it is level at rest, mu'(0) = b, and falls most at s_0 / sqrt(2). Held contacts have mu_s.
   Source: B. Armstrong-Helouvry, P. Dupont, C. Canudas de Wit, Automatica 30 (1994) 1083, with the exponent 2.
*/
#pragma once

#include "law.h"

typedef enum { STRIBECK_STATIC, STRIBECK_KINETIC, STRIBECK_VISCOUS, STRIBECK_SPEED } StribeckParameter;

/* (mu_s - mu_k) e at s */
static PetscReal StribeckFall(const FrictionLaw *law, PetscReal s)
{
  const PetscReal x = s / law->parameter[STRIBECK_SPEED];

  return (law->parameter[STRIBECK_STATIC] - law->parameter[STRIBECK_KINETIC]) * PetscExpReal(-x * x);
}

static PetscReal StribeckMu(const FrictionLaw *law, PetscReal s)
{
  return law->parameter[STRIBECK_KINETIC] + StribeckFall(law, s) + law->parameter[STRIBECK_VISCOUS] * s;
}

static PetscReal StribeckSlope(const FrictionLaw *law, PetscReal s)
{
  const PetscReal s0 = law->parameter[STRIBECK_SPEED];

  return -2 * StribeckFall(law, s) * s / (s0 * s0) + law->parameter[STRIBECK_VISCOUS];
}

static void StribeckDerive(const FrictionLaw *law, PetscReal s, FrictionDerivative *d)
{
  const PetscReal s0 = law->parameter[STRIBECK_SPEED], x = s / s0, e = PetscExpReal(-x * x),
                  fall = StribeckFall(law, s);

  d->mu[STRIBECK_STATIC]     = e;
  d->mu[STRIBECK_KINETIC]    = 1 - e;
  d->mu[STRIBECK_VISCOUS]    = s;
  d->mu[STRIBECK_SPEED]      = 2 * fall * x * x / s0;
  d->slope[STRIBECK_STATIC]  = -2 * e * x / s0;
  d->slope[STRIBECK_KINETIC] = 2 * e * x / s0;
  d->slope[STRIBECK_VISCOUS] = 1;
  d->slope[STRIBECK_SPEED]   = 4 * fall * x * (1 - x * x) / (s0 * s0);
  d->stated[0]               = StribeckSlope(law, s);
  d->stated[1]               = -2 * fall * (1 - 2 * x * x) / (s0 * s0);
}

static PetscBool StribeckVaries(const FrictionLaw *law)
{
  const PetscReal *p = law->parameter;

  return p[STRIBECK_STATIC] != p[STRIBECK_KINETIC] || p[STRIBECK_VISCOUS] != 0 ? PETSC_TRUE : PETSC_FALSE;
}

static const char *StribeckRemark(const FrictionLaw *law)
{
  const PetscReal *p = law->parameter;

  if (p[STRIBECK_STATIC] == 0 && p[STRIBECK_KINETIC] == 0)
    return "no friction at low speed: -..._mu_static and -..._mu_kinetic are zero or not given";
  return p[STRIBECK_KINETIC] > p[STRIBECK_STATIC] ? "kinetic friction is above static: it rises with the slip speed"
                                                  : NULL;
}

static const FrictionParameter stribeck_rows[] = {
  {{"-mu_static", "friction coefficient at rest", NULL, QUANTITY_REAL, FRICTION_AT(STRIBECK_STATIC),
    QUANTITY_NOT_NEGATIVE, .varies = VARIES_ALL},
   .coefficient = PETSC_TRUE,
   .steady      = PETSC_TRUE,
   .rest        = PETSC_TRUE},
  {{"-mu_kinetic", "friction coefficient far beyond the Stribeck speed, without its viscous part", NULL, QUANTITY_REAL,
    FRICTION_AT(STRIBECK_KINETIC), QUANTITY_NOT_NEGATIVE, .varies = VARIES_ALL},
   .coefficient = PETSC_TRUE,
   .steady      = PETSC_TRUE},
  {{"-mu_viscous", "viscous part of the friction coefficient, which grows with the slip speed", "s/m", QUANTITY_REAL,
    FRICTION_AT(STRIBECK_VISCOUS), QUANTITY_NOT_NEGATIVE, .varies = VARIES_ALL},
   .coefficient = PETSC_TRUE,
   .steady      = PETSC_TRUE},
  {{"-mu_stribeck_speed", "slip speed at which what static is above kinetic has fallen to 1/e", "m/s", QUANTITY_REAL,
    FRICTION_AT(STRIBECK_SPEED), QUANTITY_OR_NONE, .varies = VARIES_ALL},
   .steady = PETSC_TRUE},
};

static const FrictionKind stribeck_law = {.name      = "stribeck",
                                          .n         = 4,
                                          .parameter = stribeck_rows,
                                          .mu        = StribeckMu,
                                          .slope     = StribeckSlope,
                                          .derive    = StribeckDerive,
                                          .varies    = StribeckVaries,
                                          .remark    = StribeckRemark};
