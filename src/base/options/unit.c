/*
   Numbers with a unit, as "210 GPa", which no option takes: what to write instead, in m, kg, s, N, Pa and in mm, t, s,
   N, MPa. Units that may be others are left out: m (minutes), g (giga), t, and %, in which some options are.
*/
#include <squeal/options.h>
#include <stdlib.h>
#include <string.h>

/* A unit by its name, in those of both sets */
typedef struct {
  const char *name;
  double      si, mm;
  const char *in_si, *in_mm;
} Unit;

#define RPM (PETSC_PI / 30)
#define DEG (PETSC_PI / 180)

static const Unit units[] = {{"Pa", 1, 1e-6, "Pa", "MPa"},
                             {"kPa", 1e3, 1e-3, "Pa", "MPa"},
                             {"MPa", 1e6, 1, "Pa", "MPa"},
                             {"N/mm^2", 1e6, 1, "Pa", "MPa"},
                             {"N/mm2", 1e6, 1, "Pa", "MPa"},
                             {"GPa", 1e9, 1e3, "Pa", "MPa"},
                             {"bar", 1e5, 0.1, "Pa", "MPa"},
                             {"cm", 1e-2, 10, "m", "mm"},
                             {"mm", 1e-3, 1, "m", "mm"},
                             {"um", 1e-6, 1e-3, "m", "mm"},
                             {"kg", 1, 1e-3, "kg", "t"},
                             {"kg/m^3", 1, 1e-12, "kg/m^3", "t/mm^3"},
                             {"kg/m3", 1, 1e-12, "kg/m^3", "t/mm^3"},
                             {"g/cm^3", 1e3, 1e-9, "kg/m^3", "t/mm^3"},
                             {"g/cm3", 1e3, 1e-9, "kg/m^3", "t/mm^3"},
                             {"t/mm^3", 1e12, 1, "kg/m^3", "t/mm^3"},
                             {"N/m", 1, 1e-3, "N/m", "N/mm"},
                             {"kN/m", 1e3, 1, "N/m", "N/mm"},
                             {"N/mm", 1e3, 1, "N/m", "N/mm"},
                             {"kN/mm", 1e6, 1e3, "N/m", "N/mm"},
                             {"N/m^3", 1, 1e-9, "N/m^3", "N/mm^3"},
                             {"N/mm^3", 1e9, 1, "N/m^3", "N/mm^3"},
                             {"Nm", 1, 1e3, "N m", "N mm"},
                             {"N m", 1, 1e3, "N m", "N mm"},
                             {"m/s", 1, 1e3, "m/s", "mm/s"},
                             {"mm/s", 1e-3, 1, "m/s", "mm/s"},
                             {"N", 1, 1, "N", ""},
                             {"kN", 1e3, 1e3, "N", ""},
                             {"Hz", 1, 1, "Hz", ""},
                             {"kHz", 1e3, 1e3, "Hz", ""},
                             {"s", 1, 1, "s", ""},
                             {"ms", 1e-3, 1e-3, "s", ""},
                             {"us", 1e-6, 1e-6, "s", ""},
                             {"rad/s", 1, 1, "rad/s", ""},
                             {"rpm", RPM, RPM, "rad/s", ""},
                             {"1/min", RPM, RPM, "rad/s", ""},
                             {"deg", DEG, DEG, "rad", ""}};

PetscErrorCode ValueExplainUnit(const char value[], char text[], size_t size)
{
  char        *end;
  const double number = strtod(value, &end);
  size_t       length;

  PetscFunctionBeginUser;
  text[0] = '\0';
  if (end == value) PetscFunctionReturn(0);
  end += strspn(end, " \t");
  length = strlen(end);
  while (length && strchr(" \t", end[length - 1])) length--;
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(units); i++) {
    const Unit *u = &units[i];

    if (strlen(u->name) != length || strncmp(u->name, end, length)) continue;
    PetscCall(PetscSNPrintf(text, size, "write %.12g, in %s", number * u->si, u->in_si));
    if (!u->in_mm[0]) break;
    PetscCall(PetscSNPrintf(text, size, "write %.12g, in %s, or %.12g, in %s, where the scene is in mm, t, s",
                            number * u->si, u->in_si, number * u->mm, u->in_mm));
    break;
  }
  PetscFunctionReturn(0);
}
