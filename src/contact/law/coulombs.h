/*
   Coulomb's law, and one that changes linearly with the slip speed,

      mu(s) = max(0, mu + mu_slope (s - v)),

   v the stated speed, to which mu belongs. Where it would fall below 0 it stays at 0, since friction never drives. At v
   it is mu itself, which modes may have negative: the slave then slides against t.
*/
#pragma once

#include "law.h"

static PetscReal CoulombsMu(const FrictionLaw *law, PetscReal s)
{
  const PetscReal mu = law->parameter[0], slope = law->parameter[1];

  return slope == 0 || s == law->speed ? mu : PetscMax(0, mu + slope * (s - law->speed));
}

static PetscReal CoulombsSlope(const FrictionLaw *law, PetscReal s)
{
  return s == law->speed || CoulombsMu(law, s) > 0 ? law->parameter[1] : 0;
}

static void CoulombsDerive(const FrictionLaw *law, PetscReal s, FrictionDerivative *d)
{
  const PetscBool falls = s == law->speed || CoulombsMu(law, s) > 0 ? PETSC_TRUE : PETSC_FALSE;

  d->mu[0]    = falls ? 1 : 0;
  d->mu[1]    = falls ? s - law->speed : 0;
  d->slope[1] = falls ? 1 : 0;
}

static PetscBool CoulombsVaries(const FrictionLaw *law)
{
  return law->parameter[1] != 0 ? PETSC_TRUE : PETSC_FALSE;
}

static const FrictionParameter coulombs_rows[] = {
  {{"-mu", "friction coefficient", NULL, QUANTITY_REAL, FRICTION_AT(0), .varies = VARIES_ALL},
   .coefficient = PETSC_TRUE,
   .steady      = PETSC_TRUE,
   .rest        = PETSC_TRUE},
  {{"-mu_slope", "its slope with the slip speed about the stated one", "s/m", QUANTITY_REAL, FRICTION_AT(1),
    .in = RUN_MOVES, .unread = ": the loads tell the forces, and nothing moves", .varies = VARIES_ALL},
   .coefficient = PETSC_FALSE},
};

static const FrictionKind coulombs_law = {.name      = "coulomb",
                                          .n         = 2,
                                          .parameter = coulombs_rows,
                                          .about     = PETSC_TRUE,
                                          .mu        = CoulombsMu,
                                          .slope     = CoulombsSlope,
                                          .derive    = CoulombsDerive,
                                          .varies    = CoulombsVaries};
