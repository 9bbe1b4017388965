/*
   Materials of the parts that are not isotropic: engineering constants and axes from the options.

      -<part>_young   E              isotropic
                      E_p,E_z        transversely isotropic: the plane across axis 3 is isotropic
                      E_1,E_2,E_3    orthotropic
      -<part>_poisson nu | nu_p,nu_pz | nu_12,nu_13,nu_23
      -<part>_shear      | G_pz       | G_12,G_13,G_23

   nu_ij is the contraction along j for stress along i, so that nu_ij / E_i = nu_ji / E_j; p = 1 = 2, z = 3 and
   G_p = E_p / (2 (1 + nu_p)). Axes by directions in x, y, z: 1 as it is given, 2 made orthogonal to it, 3 = 1 x 2; of
   the transversely isotropic one axis 3 alone. Or by a cylinder: at the centre of each cell 1 is radial, 3 along the
   cylinder's axis, 2 = 3 x 1 circumferential. The conditions are those of kernels/element/orthotropic.h.
*/
#include "model/modelimpl.h"
#include "base/algebra/vec3.h"
#include "kernels/element/orthotropic.h"

#define PARALLEL 1e-6 /* sine of the angle below which two directions are the same */

static const char *const axis_option[N_AXES] = {"axis_1", "axis_2", "axis_3", "cylinder_axis", "cylinder_centre"};

/* Raises an error for another number of values than the number of moduli asks for */
static PetscErrorCode ConstantsCheckCounts(MPI_Comm comm, const char name[], PetscInt n_young, PetscInt n_poisson,
                                           PetscInt n_shear)
{
  static const PetscInt    poisson[4] = {1, 1, 2, 3}, shear[4] = {0, 0, 1, 3};
  static const char *const poissons[4] = {"nu", "nu", "nu_p,nu_pz", "nu_12,nu_13,nu_23"};
  static const char *const shears[4]   = {"", "", "G_pz", "G_12,G_13,G_23"};

  PetscFunctionBeginUser;
  PetscCheck(n_poisson == poisson[n_young] || (n_young < 2 && !n_poisson), comm, PETSC_ERR_USER_INPUT,
             "-%s_poisson has %" PetscInt_FMT " values, -%s_young %" PetscInt_FMT ": give %s", name, n_poisson, name,
             n_young, poissons[n_young]);
  PetscCheck(n_young >= 2 || !n_shear, comm, PETSC_ERR_USER_INPUT,
             "-%s_shear does nothing with one value of -%s_young: the material is isotropic", name, name);
  PetscCheck(n_shear == shear[n_young], comm, PETSC_ERR_USER_INPUT,
             "-%s_shear has %" PetscInt_FMT " values, -%s_young %" PetscInt_FMT ": give %s", name, n_shear, name,
             n_young, shears[n_young]);
  PetscFunctionReturn(0);
}

/* Raises an error for axes that the material does not have, or lacks */
static PetscErrorCode AxesCheckGiven(MPI_Comm comm, const char name[], PetscInt n_young, const PetscBool given[N_AXES])
{
  int first = 0, bits = 0;

  PetscFunctionBeginUser;
  while (first < N_AXES - 1 && !given[first]) first++;
  for (int k = 0; k < N_AXES; k++) bits |= given[k] ? 1 << k : 0;
  PetscCheck(n_young >= 2 || !bits, comm, PETSC_ERR_USER_INPUT,
             "-%s_%s does nothing with one value of -%s_young: the material is isotropic", name, axis_option[first],
             name);
  PetscCheck(n_young != 2 || bits == 1 << AXIS_3, comm, PETSC_ERR_USER_INPUT,
             "-%s_young with two values needs -%s_axis_3, across the isotropic plane, and no other axis", name, name);
  PetscCheck(n_young != 3 || bits == (1 << AXIS_1 | 1 << AXIS_2) || bits == (1 << AXIS_CYLINDER | 1 << AXIS_CENTRE),
             comm, PETSC_ERR_USER_INPUT,
             "-%s_young with three values needs either -%s_axis_1 and -%s_axis_2, or -%s_cylinder_axis and "
             "-%s_cylinder_centre, and no other axis",
             name, name, name, name, name);
  PetscFunctionReturn(0);
}

/* Makes a direction a unit vector; an error for none */
static PetscErrorCode AxisNormalise(MPI_Comm comm, const char name[], int which, PetscReal axis[3])
{
  PetscFunctionBeginUser;
  PetscCheck(Vec3Normalise(axis) > 0, comm, PETSC_ERR_USER_INPUT, "-%s_%s 0,0,0 is no direction", name,
             axis_option[which]);
  PetscFunctionReturn(0);
}

/* Takes what is along the unit vector `first` off axis, and returns the sine of the angle between them */
static PetscReal AxisMakeOrthogonal(const PetscReal first[3], PetscReal axis[3])
{
  const PetscReal along = Vec3Dot(first, axis);

  for (int d = 0; d < 3; d++) axis[d] -= along * first[d];
  return Vec3Normalise(axis);
}

/* Rows of an orthogonal basis whose row 2 is a->axis[2] */
static void AxesComplete(Anisotropy *a)
{
  int least = 0;

  for (int d = 1; d < 3; d++)
    if (PetscAbsReal(a->axis[2][d]) < PetscAbsReal(a->axis[2][least])) least = d;
  for (int d = 0; d < 3; d++) a->axis[0][d] = d == least ? 1 : 0;
  (void)AxisMakeOrthogonal(a->axis[2], a->axis[0]);
  Vec3Cross(a->axis[2], a->axis[0], a->axis[1]);
}

static PetscErrorCode AxesSet(MPI_Comm comm, const char name[], const PetscReal given[N_AXES][3], Anisotropy *a)
{
  PetscFunctionBeginUser;
  if (a->n == 2 || a->cylinder) {
    const int which = a->cylinder ? AXIS_CYLINDER : AXIS_3;

    PetscCall(PetscArraycpy(a->axis[2], given[which], 3));
    PetscCall(AxisNormalise(comm, name, which, a->axis[2]));
    AxesComplete(a);
    PetscCall(PetscArraycpy(a->centre, given[AXIS_CENTRE], 3));
    PetscFunctionReturn(0);
  }
  for (int k = 0; k < 2; k++) {
    PetscCall(PetscArraycpy(a->axis[k], given[k], 3));
    PetscCall(AxisNormalise(comm, name, k, a->axis[k]));
  }
  PetscCheck(AxisMakeOrthogonal(a->axis[0], a->axis[1]) > PARALLEL, comm, PETSC_ERR_USER_INPUT,
             "-%s_axis_1 %g,%g,%g and -%s_axis_2 %g,%g,%g are parallel", name, (double)given[0][0], (double)given[0][1],
             (double)given[0][2], name, (double)given[1][0], (double)given[1][1], (double)given[1][2]);
  Vec3Cross(a->axis[0], a->axis[1], a->axis[2]);
  PetscFunctionReturn(0);
}

/* Raises an error that names the condition of a positive definite stiffness that fails, by the names of n = 2 or 3
   moduli */
static PetscErrorCode ConstantsCheckDefinite(MPI_Comm comm, const char name[], PetscInt n,
                                             const EngineeringConstants *e)
{
  static const char *const axes[2][3]  = {{"p", "p", "z"}, {"1", "2", "3"}};
  static const char *const pairs[2][3] = {{"p", "pz", "pz"}, {"12", "13", "23"}};
  const char *const       *axis = axes[n - 2], *const *pair = pairs[n - 2];
  const double             determinant = OrthotropicDeterminant(e);

  PetscFunctionBeginUser;
  for (int i = 0; i < 3; i++)
    PetscCheck(e->young[i] > 0, comm, PETSC_ERR_USER_INPUT, "-%s_young: E_%s %.6g must be positive (Pa)", name, axis[i],
               e->young[i]);
  for (int k = 0; k < 3; k++) {
    const int    i = orthotropic_pair[k][0], j = orthotropic_pair[k][1];
    const double limit = PetscSqrtReal(e->young[i] / e->young[j]);

    PetscCheck(PetscAbsReal(e->poisson[k]) < limit, comm, PETSC_ERR_USER_INPUT,
               "-%s_poisson: |nu_%s| %.6g must be below sqrt(E_%s / E_%s) = %.6g, or the stiffness is not positive "
               "definite",
               name, pair[k], PetscAbsReal(e->poisson[k]), axis[i], axis[j], limit);
    PetscCheck(e->shear[k] > 0, comm, PETSC_ERR_USER_INPUT, "-%s_shear: G_%s %.6g must be positive (Pa)", name, pair[k],
               e->shear[k]);
  }
  PetscCheck(n == 3 || determinant > 0, comm, PETSC_ERR_USER_INPUT,
             "-%s_poisson: (1 + nu_p) (1 - nu_p - 2 nu_pz nu_zp) = %.6g must be positive, or the stiffness is not "
             "positive definite; nu_p %.6g, nu_pz %.6g, nu_zp = nu_pz E_z / E_p",
             name, determinant, e->poisson[0], e->poisson[1]);
  PetscCheck(determinant > 0, comm, PETSC_ERR_USER_INPUT,
             "-%s_poisson: 1 - nu_12 nu_21 - nu_13 nu_31 - nu_23 nu_32 - 2 nu_21 nu_32 nu_13 = %.6g must be positive, "
             "or the stiffness is not positive definite; nu_12 %.6g, nu_13 %.6g, nu_23 %.6g",
             name, determinant, e->poisson[0], e->poisson[1], e->poisson[2]);
  PetscFunctionReturn(0);
}

/* The nine constants of n = 2 or 3 moduli */
static void ConstantsComplete(PetscInt n, const PetscReal young[3], const PetscReal poisson[3],
                              const PetscReal shear[3], EngineeringConstants *e)
{
  for (int k = 0; k < 3; k++) {
    e->young[k]   = n == 2 ? young[k / 2] : young[k];
    e->poisson[k] = n == 2 ? poisson[k ? 1 : 0] : poisson[k];
    e->shear[k]   = n == 2 ? shear[0] : shear[k];
  }
  if (n == 2) e->shear[0] = young[0] / (2 * (1 + poisson[0]));
}

PetscErrorCode PartSetElasticity(MPI_Comm comm, Part *part)
{
  const ElasticityAsked *asked = &part->asked;
  Anisotropy            *a     = &part->anisotropy;

  PetscFunctionBeginUser;
  part->young   = asked->young[0];
  part->poisson = asked->poisson[0];
  PetscCall(ConstantsCheckCounts(comm, part->name, asked->n_young, asked->n_poisson, asked->n_shear));
  PetscCall(AxesCheckGiven(comm, part->name, asked->n_young, asked->given));
  if (asked->n_young < 2) PetscFunctionReturn(0);
  a->n        = asked->n_young;
  a->cylinder = asked->given[AXIS_CYLINDER];
  PetscCall(AxesSet(comm, part->name, asked->axis, a));
  ConstantsComplete(a->n, asked->young, asked->poisson, asked->shear, &a->constants);
  PetscCall(ConstantsCheckDefinite(comm, part->name, a->n, &a->constants));
  OrthotropicStiffness(&a->constants, a->C);
  PetscFunctionReturn(0);
}

PetscErrorCode AnisotropyView(Model model, const Anisotropy *a, PetscViewer viewer)
{
  const EngineeringConstants *e = &a->constants;
  const char                 *pascal, *metre;

  PetscFunctionBeginUser;
  PetscCall(ModelGetUnit(model, "Pa", &pascal));
  PetscCall(ModelGetUnit(model, "m", &metre));
  PetscCall(PetscViewerASCIIPrintf(viewer, "    %s: E %.6g, %.6g, %.6g %s, nu_12 %.6g, nu_13 %.6g, nu_23 %.6g, ",
                                   a->n == 2 ? "transversely isotropic" : "orthotropic", e->young[0], e->young[1],
                                   e->young[2], pascal, e->poisson[0], e->poisson[1], e->poisson[2]));
  PetscCall(PetscViewerASCIIPrintf(viewer, "G_12 %.6g, G_13 %.6g, G_23 %.6g %s\n", e->shear[0], e->shear[1],
                                   e->shear[2], pascal));
  if (a->cylinder)
    PetscCall(PetscViewerASCIIPrintf(viewer,
                                     "    radial, circumferential, axial about %.6g, %.6g, %.6g through %.6g, %.6g, "
                                     "%.6g %s\n",
                                     (double)a->axis[2][0], (double)a->axis[2][1], (double)a->axis[2][2],
                                     (double)a->centre[0], (double)a->centre[1], (double)a->centre[2], metre));
  for (int k = a->n == 2 ? 2 : 0; k < 3 && !a->cylinder; k++)
    PetscCall(PetscViewerASCIIPrintf(viewer, "    axis %d: %.6g, %.6g, %.6g\n", k + 1, (double)a->axis[k][0],
                                     (double)a->axis[k][1], (double)a->axis[k][2]));
  PetscFunctionReturn(0);
}
