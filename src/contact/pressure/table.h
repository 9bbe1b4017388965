/*
   The law of a table: points (c_i, p_i), closing (m) and pressure (Pa), both ascending, straight lines between them,

      P(c) = p_i + P' (c - c_i),   P'(c) = (p_(i+1) - p_i) / (c_(i+1) - c_i),   c_i <= c < c_(i+1),

   the last line going on. The first pressure is 0: its closing is the onset. P' jumps at the points.

   Of a lining of thickness h (m) a compressibility test gives strains e_i at the pressures, or the compressions e_i h_s
   of a sample of thickness h_s. The lining in the mesh has a modulus E through its thickness (Pa) and takes p / E of
   them; what is left is a spring in series with it, at its back:

      c_i = h (e_i - p_i / E).
*/
#pragma once

#include "kind.h"

static const char *TableIdleLining(const void *law, const QuantityRun *run)
{
  (void)run;
  return ((const PressureLaw *)law)->parameter[TABLE_THICKNESS] > 0 ? NULL : "not used without -@pressure_thickness";
}

/* The point before which the line of c lies, or with k = 1 that of the pressure c: the last, but never the end */
static const PetscReal *TableFind(const PressureLaw *law, int k, PetscReal c)
{
  PetscInt low = 0, high = law->n_points - 1;

  while (high - low > 1) {
    const PetscInt middle = (low + high) / 2;

    if (law->point[2 * middle + k] <= c)
      low = middle;
    else
      high = middle;
  }
  return &law->point[2 * low];
}

static PetscReal TableOnset(const PressureLaw *law)
{
  return law->point[0];
}

static PetscReal TableSlope(const PressureLaw *law, PetscReal c)
{
  const PetscReal *at = TableFind(law, 0, c);

  return (at[3] - at[1]) / (at[2] - at[0]);
}

static PetscReal TablePressure(const PressureLaw *law, PetscReal c)
{
  const PetscReal *at = TableFind(law, 0, c);

  return at[1] + (at[3] - at[1]) * ((c - at[0]) / (at[2] - at[0]));
}

static PetscReal TableClosing(const PressureLaw *law, PetscReal p)
{
  const PetscReal *at = TableFind(law, 1, p);

  return at[0] + (at[2] - at[0]) * ((p - at[1]) / (at[3] - at[1]));
}

static PetscReal TableEnergy(const PressureLaw *law, PetscReal c)
{
  const PetscReal *at     = TableFind(law, 0, c);
  PetscReal        energy = 0;

  for (const PetscReal *i = law->point; i < at; i += 2) energy += 0.5 * (i[1] + i[3]) * (i[2] - i[0]);
  return energy + 0.5 * (at[1] + TablePressure(law, c)) * (c - at[0]);
}

static const Quantity table_rows[] = {
  {"-pressure_table", "closing, pressure, closing, pressure, ..., both ascending, the first pressure 0", "m, Pa",
   QUANTITY_MANY, .at = offsetof(PressureLaw, point), .size = sizeof(PetscReal *),
   .count = offsetof(PressureLaw, n_points), .room = PRESSURE_ROOM, PRESSURE_TABLE},
  {"-pressure_file", "or a file with closing,pressure in each line", NULL, QUANTITY_PATH, .path = "file",
   .at = offsetof(PressureOptions, file), .size = PETSC_MAX_PATH_LEN, PRESSURE_TABLE},
  {"-pressure_thickness", "of a lining whose strain, as of a compressibility test, is given in place of the closing",
   "m", QUANTITY_REAL, PRESSURE_PARAMETER(TABLE_THICKNESS), QUANTITY_OR_NONE, PRESSURE_TABLE},
  {"-pressure_sample", "thickness of the sample whose compression in m is given in place of the strain", "m",
   QUANTITY_REAL, PRESSURE_PARAMETER(TABLE_SAMPLE), QUANTITY_OR_NONE, PRESSURE_TABLE, .idle = TableIdleLining},
  {"-pressure_modulus", "of the lining in the mesh through its thickness, whose own strain is taken off the table",
   "Pa", QUANTITY_REAL, PRESSURE_PARAMETER(TABLE_LINING), QUANTITY_OR_NONE, PRESSURE_TABLE, .idle = TableIdleLining},
};

static const PressureKind table_pressure = {.name     = "table",
                                            .n_rows   = 5,
                                            .row      = table_rows,
                                            .onset    = TableOnset,
                                            .pressure = TablePressure,
                                            .slope    = TableSlope,
                                            .closing  = TableClosing,
                                            .energy   = TableEnergy};
