/*
   Units of a scene: which set its numbers are in, and their names.

   Any consistent set of units serves: m, kg, s, N, Pa, or mm, t, s, N, MPa, which gives the same Hz. The speed of waves
   in a bar, sqrt(E / rho), tells which: 15 m/s (rubber) to 20 km/s (ceramics) in m and kg, a thousand times as much in
   mm and t. Neither fits where modulus and density are of two sets. Coordinates of a third one show by their size.
*/
#include "modelimpl.h"

#define SLOWEST        15.  /* m/s: soft rubber */
#define FASTEST        2e4  /* m/s: beyond beryllium and diamond, 12.9 and 18 km/s */
#define LIGHTEST_SI    1e-2 /* kg/m^3 */
#define LIGHTEST_GRAMS 1.5  /* g/cm^3: magnesium */
#define HEAVIEST_GRAMS 25.  /* g/cm^3: osmium */
#define HEAVIEST_TONNE 1e-6 /* t/mm^3; osmium has 2.3e-8 */
#define LARGEST_SI     20.  /* m */
#define SMALLEST_MM    0.5  /* mm */
#define HEAVIEST_PART  1e6  /* kg */

/* Speed of waves by the least of all moduli, m/s; shear moduli count as the Young's modulus of about twice as much */
static PetscReal PartSlowest(const Part *p)
{
  const EngineeringConstants *e     = &p->anisotropy.constants;
  PetscReal                   least = p->young;

  for (int k = 0; k < 3 && p->anisotropy.n; k++) least = PetscMin(least, PetscMin(e->young[k], 2 * e->shear[k]));
  return PetscSqrtReal(least / p->density);
}

/* Whether density and modulus of a part are in t/mm^3 and MPa */
static PetscBool PartInTonnes(const Part *p)
{
  const PetscReal speed = PetscSqrtReal(p->young / p->density);

  return p->density < HEAVIEST_TONNE && speed >= 1e3 * SLOWEST && speed <= 1e3 * FASTEST ? PETSC_TRUE : PETSC_FALSE;
}

const char *PartDoubt(const Part *p, const PartExtent *e)
{
  const PetscReal speed   = PetscSqrtReal(p->young / p->density);
  const PetscReal longest = PetscMax(e->size[0], PetscMax(e->size[1], e->size[2]));

  if (PartInTonnes(p))
    return longest < SMALLEST_MM ? "the mesh is in m, but the material in t/mm^3 and MPa: scale the mesh" : NULL;
  if (p->density < HEAVIEST_TONNE) return "the density is in t/mm^3: give kg/m^3 (steel 7850), or the modulus in MPa";
  if (p->density < LIGHTEST_SI)
    return "the density is in kg/mm^3 or g/mm^3: give kg/m^3 with Pa and m, or t/mm^3 with MPa and mm";
  if (speed > FASTEST && p->density > LIGHTEST_GRAMS && p->density < HEAVIEST_GRAMS)
    return "the density is in g/cm^3: give kg/m^3 (steel 7850)";
  if (speed < SLOWEST) return "the modulus is in MPa or GPa: give Pa (steel 210e9)";
  if (PartSlowest(p) < SLOWEST) return "one of the moduli is in MPa or GPa: give all in Pa";
  if (longest > LARGEST_SI) return "the mesh is in mm: scale it to m, or give t/mm^3 and MPa";
  if (e->volume * p->density > HEAVIEST_PART) return "the mesh is in mm or cm: scale it to m";
  return NULL;
}

PetscErrorCode ModelUnits(Model model, const char **units)
{
  PetscInt n_tonnes = 0;

  PetscFunctionBeginUser;
  *units = NULL;
  for (PetscInt i = 0; i < model->scene.n_parts; i++) {
    if (PartDoubt(&model->scene.parts[i], &model->extent[i])) PetscFunctionReturn(0);
    n_tonnes += PartInTonnes(&model->scene.parts[i]);
  }
  if (n_tonnes == model->scene.n_parts) *units = "mm, t, s, N, MPa";
  if (!n_tonnes) *units = "m, kg, s, N, Pa";
  PetscFunctionReturn(0);
}

PetscErrorCode ModelGetUnit(Model model, const char si[], const char **unit)
{
  static const char *const names[][2] = {{"m", "mm"},
                                         {"m^2", "mm^2"},
                                         {"m^3", "mm^3"},
                                         {"m/s", "mm/s"},
                                         {"m/s^2", "mm/s^2"},
                                         {"s/m", "s/mm"},
                                         {"kg", "t"},
                                         {"kg/m^3", "t/mm^3"},
                                         {"kg m^2", "t mm^2"},
                                         {"Pa", "MPa"},
                                         {"m/N", "mm/N"},
                                         {"N/m", "N/mm"},
                                         {"N/m^3", "N/mm^3"},
                                         {"N s/m", "N s/mm"},
                                         {"N s/m^3", "N s/mm^3"},
                                         {"N m", "N mm"},
                                         {"N m/rad", "N mm/rad"},
                                         {"N m s/rad", "N mm s/rad"}};
  const char              *units;

  PetscFunctionBeginUser;
  *unit = si;
  PetscCall(ModelUnits(model, &units));
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(names) && units && units[1] == 'm'; i++)
    if (!strcmp(names[i][0], si)) *unit = names[i][1];
  PetscFunctionReturn(0);
}
