/*
   Static and kinetic friction, which falls from one to the other over a decay speed s_0,

      mu(s) = mu_k + (mu_s - mu_k) e,  e = exp(-s / s_0),      mu'(s) = -(mu_s - mu_k) e / s_0.

   Held contacts have mu_s.
*/
#pragma once

#include "law.h"

/* e at s */
static PetscReal StaticKineticDecay(const FrictionLaw *law, PetscReal s)
{
  return PetscExpReal(-s / law->parameter[2]);
}

static PetscReal StaticKineticMu(const FrictionLaw *law, PetscReal s)
{
  return law->parameter[1] + (law->parameter[0] - law->parameter[1]) * StaticKineticDecay(law, s);
}

static PetscReal StaticKineticSlope(const FrictionLaw *law, PetscReal s)
{
  return -(law->parameter[0] - law->parameter[1]) * StaticKineticDecay(law, s) / law->parameter[2];
}

static void StaticKineticDerive(const FrictionLaw *law, PetscReal s, FrictionDerivative *d)
{
  const PetscReal e = StaticKineticDecay(law, s), s0 = law->parameter[2],
                  fall = (law->parameter[0] - law->parameter[1]) * e;

  d->mu[0]     = e;
  d->mu[1]     = 1 - e;
  d->mu[2]     = fall * s / (s0 * s0);
  d->slope[0]  = -e / s0;
  d->slope[1]  = e / s0;
  d->slope[2]  = fall * (1 - s / s0) / (s0 * s0);
  d->stated[0] = -fall / s0;
  d->stated[1] = fall / (s0 * s0);
}

static PetscBool StaticKineticVaries(const FrictionLaw *law)
{
  return law->parameter[0] != law->parameter[1] ? PETSC_TRUE : PETSC_FALSE;
}

static const char *StaticKineticRemark(const FrictionLaw *law)
{
  if (law->parameter[0] == 0 && law->parameter[1] == 0)
    return "no friction: -..._mu_static and -..._mu_kinetic are zero or not given";
  return law->parameter[1] > law->parameter[0] ? "kinetic friction is above static: it rises with the slip speed"
                                               : NULL;
}

static const FrictionParameter static_kinetic_rows[] = {
  {{"-mu_static", "friction coefficient at rest", NULL, QUANTITY_REAL, FRICTION_AT(0), QUANTITY_NOT_NEGATIVE,
    .varies = VARIES_ALL},
   .coefficient = PETSC_TRUE,
   .steady      = PETSC_TRUE,
   .rest        = PETSC_TRUE},
  {{"-mu_kinetic", "friction coefficient far beyond the decay speed", NULL, QUANTITY_REAL, FRICTION_AT(1),
    QUANTITY_NOT_NEGATIVE, .varies = VARIES_ALL},
   .coefficient = PETSC_TRUE,
   .steady      = PETSC_TRUE},
  {{"-mu_decay_speed", "slip speed over which what static is above kinetic falls to 1/e", "m/s", QUANTITY_REAL,
    FRICTION_AT(2), QUANTITY_OR_NONE, .varies = VARIES_ALL},
   .steady = PETSC_TRUE},
};

static const FrictionKind static_kinetic_law = {.name      = "static_kinetic",
                                                .n         = 3,
                                                .parameter = static_kinetic_rows,
                                                .mu        = StaticKineticMu,
                                                .slope     = StaticKineticSlope,
                                                .derive    = StaticKineticDerive,
                                                .varies    = StaticKineticVaries,
                                                .remark    = StaticKineticRemark};
