/*
   Size, volume and mass of the parts, and whether they tell of mixed units.

   Any consistent set of units serves: m, kg, s, N, Pa, or mm, t, s, N, MPa, which gives the same Hz. The speed of waves
   in a bar, sqrt(E / rho), tells which: 15 m/s (rubber) to 20 km/s (ceramics) in m and kg, a thousand times as much in
   mm and t. Neither fits where modulus and density are of two sets. Coordinates of a third one show by their size.
*/
#include "model/modelimpl.h"

#define SLOWEST        15.  /* m/s: soft rubber */
#define FASTEST        2e4  /* m/s: beyond beryllium and diamond, 12.9 and 18 km/s */
#define LIGHTEST_SI    1e-2 /* kg/m^3 */
#define LIGHTEST_GRAMS 1.5  /* g/cm^3: magnesium */
#define HEAVIEST_GRAMS 25.  /* g/cm^3: osmium */
#define HEAVIEST_TONNE 1e-6 /* t/mm^3; osmium has 2.3e-8 */
#define LARGEST_SI     20.  /* m */
#define SMALLEST_MM    0.5  /* mm */
#define HEAVIEST_PART  1e6  /* kg */
#define SLOW_PERIODS   50.  /* of the highest frequency of a window while a wave crosses a part: thousands of modes */

/* Bounding boxes and volumes of this rank's cells, then of all */
static PetscErrorCode ExtentsMeasure(Model model)
{
  const PetscInt n = model->scene.n_parts;
  PetscReal     *low, *volume;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n, &model->extent));
  PetscCall(PetscMalloc2(6 * n, &low, n, &volume)); /* [part][3] least coordinates, then the negative largest ones */
  for (PetscInt i = 0; i < 6 * n; i++) low[i] = PETSC_MAX_REAL;
  PetscCall(PetscArrayzero(volume, n));
  for (PetscInt c = 0; c < model->mesh.n_cells; c++) {
    const PetscInt part = model->mesh.cell_part[c];
    const Element *element;
    PetscInt       nodes[ELEMENT_MAX_NODES];
    PetscReal      x[ELEMENT_MAX_DOFS], cell, jacobian;

    PetscCall(ModelGetCell(model, c, &element, nodes, x));
    element->measure(element->solid, x, &cell, &jacobian);
    volume[part] += cell;
    for (PetscInt k = 0; k < 3 * element->n_nodes; k++) {
      low[6 * part + k % 3]     = PetscMin(low[6 * part + k % 3], x[k]);
      low[6 * part + 3 + k % 3] = PetscMin(low[6 * part + 3 + k % 3], -x[k]);
    }
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, low, (PetscMPIInt)(6 * n), MPIU_REAL, MPI_MIN, model->comm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, volume, (PetscMPIInt)n, MPIU_REAL, MPI_SUM, model->comm));
  for (PetscInt i = 0; i < n; i++) {
    for (int d = 0; d < 3; d++) model->extent[i].size[d] = -low[6 * i + d] - low[6 * i + 3 + d];
    model->extent[i].volume = volume[i];
  }
  PetscCall(PetscFree2(low, volume));
  PetscFunctionReturn(0);
}

/* Time that a wave takes along the longest side, s */
static PetscReal PartCrossing(const Part *p, const PartExtent *e)
{
  return PetscMax(e->size[0], PetscMax(e->size[1], e->size[2])) / PetscSqrtReal(p->young / p->density);
}

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

/* What the units of a part probably are where they do not fit together; NULL where they do */
static const char *PartDoubt(const Part *p, const PartExtent *e)
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
  static const char *const names[][2] = {
    {"m",         "mm"        },
    {"m^2",       "mm^2"      },
    {"m^3",       "mm^3"      },
    {"m/s",       "mm/s"      },
    {"s/m",       "s/mm"      },
    {"kg",        "t"         },
    {"kg/m^3",    "t/mm^3"    },
    {"kg m^2",    "t mm^2"    },
    {"Pa",        "MPa"       },
    {"m/N",       "mm/N"      },
    {"N/m",       "N/mm"      },
    {"N/m^3",     "N/mm^3"    },
    {"N s/m",     "N s/mm"    },
    {"N s/m^3",   "N s/mm^3"  },
    {"N m",       "N mm"      },
    {"N m/rad",   "N mm/rad"  },
    {"N m s/rad", "N mm s/rad"}
  };
  const char *units;

  PetscFunctionBeginUser;
  *unit = si;
  PetscCall(ModelUnits(model, &units));
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(names) && units && units[1] == 'm'; i++)
    if (!strcmp(names[i][0], si)) *unit = names[i][1];
  PetscFunctionReturn(0);
}

PetscErrorCode PartsCheckUnits(Model model)
{
  PetscFunctionBeginUser;
  PetscCall(ExtentsMeasure(model));
  for (PetscInt i = 0; i < model->scene.n_parts; i++) {
    const Part       *p     = &model->scene.parts[i];
    const PartExtent *e     = &model->extent[i];
    const char       *doubt = PartDoubt(p, e);

    if (!doubt) continue;
    PetscCall(
      PetscFPrintf(model->comm, stderr,
                   "squeal: warning: units of part %s: size %.4g x %.4g x %.4g, mass %.4g, E %.4g, rho %.4g; probably "
                   "%s\n",
                   p->name, (double)e->size[0], (double)e->size[1], (double)e->size[2],
                   (double)(e->volume * p->density), (double)p->young, (double)p->density, doubt));
    break; /* the others will be alike */
  }
  PetscFunctionReturn(0);
}

PetscErrorCode ModelDescribeDoubt(Model model, PetscReal hz, size_t size, char text[])
{
  PetscInt  slowest = -1;
  PetscReal longest = SLOW_PERIODS / hz;

  PetscFunctionBeginUser;
  text[0] = '\0';
  for (PetscInt i = 0; i < model->scene.n_parts; i++) {
    const PetscReal crossing = PartCrossing(&model->scene.parts[i], &model->extent[i]);

    if (crossing <= longest) continue;
    longest = crossing;
    slowest = i;
  }
  if (slowest < 0) PetscFunctionReturn(0);
  const Part *p     = &model->scene.parts[slowest];
  const char *doubt = PartDoubt(p, &model->extent[slowest]);

  PetscCall(PetscSNPrintf(text, size,
                          "a wave along part %s takes %.3g s, %.0f periods of %.6g Hz; probably %s%s (-%s_young %.6g, "
                          "-%s_density %.6g)",
                          p->name, (double)longest, (double)(longest * hz), (double)hz,
                          doubt ? "" : "its modulus, density or mesh has other units", doubt ? doubt : "", p->name,
                          (double)p->young, p->name, (double)p->density));
  PetscFunctionReturn(0);
}

PetscErrorCode PartView(Model model, PetscInt part, PetscViewer viewer)
{
  const Part       *p = &model->scene.parts[part];
  const PartExtent *e = &model->extent[part];
  const char       *pascal, *dense, *metre, *volume, *kilogram;

  PetscFunctionBeginUser;
  PetscCall(ModelGetUnit(model, "Pa", &pascal));
  PetscCall(ModelGetUnit(model, "kg/m^3", &dense));
  PetscCall(ModelGetUnit(model, "m", &metre));
  PetscCall(ModelGetUnit(model, "m^3", &volume));
  PetscCall(ModelGetUnit(model, "kg", &kilogram));
  PetscCall(PetscViewerASCIIPrintf(viewer, "  part %s: E %.6g %s, nu %.6g, rho %.6g %s, alpha %.6g 1/s, beta %.6g s\n",
                                   p->name, (double)p->young, pascal, (double)p->poisson, (double)p->density, dense,
                                   (double)p->alpha, (double)p->beta));
  if (p->anisotropy.n) PetscCall(AnisotropyView(model, &p->anisotropy, viewer));
  if (p->spin.given) PetscCall(SpinView(&p->spin, viewer));
  if (p->loss > 0)
    PetscCall(PetscViewerASCIIPrintf(
      viewer, "    loss factor %.6g at %.6g Hz, in beta: %.6g at half that frequency, %.6g at twice it\n",
      (double)p->loss, (double)model->scene.loss_frequency, (double)(p->loss / 2), (double)(2 * p->loss)));
  PetscCall(PetscViewerASCIIPrintf(viewer,
                                   "    %.4g x %.4g x %.4g %s, %.4g %s, %.4g %s; a wave along it takes %.3g s\n",
                                   (double)e->size[0], (double)e->size[1], (double)e->size[2], metre, (double)e->volume,
                                   volume, (double)(e->volume * p->density), kilogram, (double)PartCrossing(p, e)));
  PetscFunctionReturn(0);
}
