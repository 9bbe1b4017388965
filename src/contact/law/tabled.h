/*
   Friction of a table: mu_ij at slip speeds s_i (m/s) and pressures p_j (Pa), both ascending from 0, times a factor.
   In the cell of s and p, with x and y from 0 to 1 across it,

      mu = (1 - x) (1 - y) mu_ij + x (1 - y) mu_(i+1)j + (1 - x) y mu_i(j+1) + x y mu_(i+1)(j+1).

   Its slopes jump at the lines of the table, where those of the next cell count. Beyond the last speed and pressure mu
   stays what it is there, for solvers on their way; runs that end a step there are refused (FrictionCovers()).
*/
#pragma once

#include "law.h"

#define TABLE_FACTOR 0

/* Cell of x in [n] ascending numbers, and the place in it, within 0 and 1 */
static PetscInt TabledCell(PetscInt n, const PetscReal at[], PetscReal x, PetscReal *place)
{
  PetscInt low = 0, high = n - 1;

  while (high - low > 1) {
    const PetscInt middle = (low + high) / 2;

    if (at[middle] <= x)
      low = middle;
    else
      high = middle;
  }
  *place = PetscMin(1, PetscMax(0, (x - at[low]) / (at[low + 1] - at[low])));
  return low;
}

/* mu of a cell at (x, y), and its slopes by both, per width of the cell */
static PetscReal TabledMix(const FrictionLaw *law, PetscReal s, PetscReal slope[2], PetscReal width[2])
{
  const FrictionTable *t = &law->table;
  PetscReal            x, y;
  const PetscInt       i = TabledCell(t->n_speeds, t->speed, s, &x);
  const PetscInt       j = TabledCell(t->n_pressures, t->pressure, law->pressure, &y);
  const PetscReal     *a = &t->mu[i * t->n_pressures + j], *b = a + t->n_pressures;
  const PetscReal      f = law->parameter[TABLE_FACTOR];

  width[0] = t->speed[i + 1] - t->speed[i];
  width[1] = t->pressure[j + 1] - t->pressure[j];
  slope[0] = f * ((1 - y) * (b[0] - a[0]) + y * (b[1] - a[1]));
  slope[1] = f * ((1 - x) * (a[1] - a[0]) + x * (b[1] - b[0]));
  return f * ((1 - x) * ((1 - y) * a[0] + y * a[1]) + x * ((1 - y) * b[0] + y * b[1]));
}

static PetscReal TabledMu(const FrictionLaw *law, PetscReal s)
{
  PetscReal slope[2], width[2];

  return TabledMix(law, s, slope, width);
}

static PetscReal TabledSlope(const FrictionLaw *law, PetscReal s)
{
  PetscReal slope[2], width[2];

  (void)TabledMix(law, s, slope, width);
  return slope[0] / width[0];
}

static PetscReal TabledRise(const FrictionLaw *law, PetscReal s)
{
  PetscReal slope[2], width[2];

  (void)TabledMix(law, s, slope, width);
  return law->pressure * slope[1] / width[1];
}

static void TabledDerive(const FrictionLaw *law, PetscReal s, FrictionDerivative *d)
{
  FrictionLaw whole = *law;

  whole.parameter[TABLE_FACTOR] = 1;
  d->mu[TABLE_FACTOR]           = TabledMu(&whole, s);
  d->slope[TABLE_FACTOR]        = TabledSlope(&whole, s);
  d->stated[0]                  = TabledSlope(law, s);
}

static PetscBool TabledVaries(const FrictionLaw *law)
{
  (void)law;
  return PETSC_TRUE;
}

static const FrictionParameter tabled_rows[] = {
  {{"-mu_factor", "of all friction coefficients of the table", NULL, QUANTITY_REAL, .initial = 1, FRICTION_AT(0),
    QUANTITY_NOT_NEGATIVE, .varies = VARIES_ALL},
   .coefficient = PETSC_TRUE,
   .steady      = PETSC_TRUE,
   .rest        = PETSC_TRUE},
};

static const Quantity tabled_file = {
  "-mu_file",
  "with the columns speed,pressure,mu: each pressure at each speed, from 0 on, to beyond what comes to pass",
  NULL,
  QUANTITY_PATH,
  .path = "file",
  .at   = offsetof(FrictionOptions, file),
  .size = PETSC_MAX_PATH_LEN};

static const FrictionKind tabled_law = {.name      = "table",
                                        .n         = 1,
                                        .parameter = tabled_rows,
                                        .mu        = TabledMu,
                                        .slope     = TabledSlope,
                                        .derive    = TabledDerive,
                                        .varies    = TabledVaries,
                                        .rise      = TabledRise,
                                        .file      = &tabled_file};
