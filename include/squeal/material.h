/*
   Part - a body of the scene by its material: elasticity, density, damping, and its spin. SI units
*/
#pragma once

#include <petscsys.h>
#include <squeal/elasticity.h>
#include <squeal/viscoelastic.h>

/* Axes that a material may be given by: those that are its own, of a cylinder its axis, and a point of that */
enum { AXIS_1, AXIS_2, AXIS_3, AXIS_CYLINDER, AXIS_CENTRE, N_AXES };

/* Elasticity as it is given */
typedef struct {
  PetscInt  n_young, n_poisson, n_shear;
  PetscReal young[3], poisson[3], shear[3]; /* Pa; -; Pa */
  PetscReal axis[N_AXES][3];                /* directions; m */
  PetscBool given[N_AXES];
} ElasticityAsked;

/* Elasticity of a part that is not isotropic, in axes 1, 2, 3 of its own */
typedef struct {
  PetscInt             n;         /* Young's moduli given: 0 isotropic, 2 transversely isotropic about axis 3, 3 */
  EngineeringConstants constants; /* Pa, all nine */
  PetscReal            C[ELASTICITY_VOIGT][ELASTICITY_VOIGT]; /* in the axes, Pa */
  PetscReal            axis[3][3]; /* rows: unit vectors; with a cylinder only axis 3 is that of the cells */
  PetscBool            cylinder;   /* axis 1 is radial, 2 circumferential about axis 3 */
  PetscReal            centre[3];  /* a point of that axis, m */
} Anisotropy;

/* Steady spin of a body of revolution in the fixed frame */
typedef struct {
  PetscBool given, has_axis, has_centre;
  PetscReal rate;               /* rad/s, positive by the right-hand rule about the axis */
  PetscReal axis[3], centre[3]; /* unit vector; a point of the axis, m */
  PetscReal radius;             /* of gyration about the axis, m; set up with the mesh */
  PetscInt  body;               /* of those parts that share nodes, the first; set up with the mesh */
} Spin;

/* Thickness of a flat layer, in place of that of its mesh: its cells are stretched across it by thickness / mesh, and
   what lies on it moves with it as it is. With x = x_p + n x_n, d/dx_n -> (mesh / thickness) d/dx_n and dV ->
   (thickness / mesh) dV, hence exactly, h the thickness,

      K(h) = h K_pp + (K_pn + K_np) + K_nn / h,   M(h) = h M_1                                                        */
typedef struct {
  PetscBool given, has_axis; /* n is */
  PetscReal thickness;       /* m, > 0 */
  PetscReal mesh, normal[3]; /* that of the mesh, m; n, a unit vector; set up with the mesh */
} Layer;

/* Material of one body; SI units */
typedef struct {
  char             *name, *volume; /* of the mesh, of which -parts names the part: the same name where none is given */
  PetscReal         young;         /* Young's modulus, Pa, > 0; E_1 where not isotropic */
  PetscReal         poisson;       /* Poisson's ratio, in (-1, 0.5); not read where not isotropic */
  PetscReal         density;       /* kg/m^3, > 0 */
  PetscReal         alpha;         /* Rayleigh factor of the mass, 1/s: C = alpha M + beta K */
  PetscReal         beta;          /* Rayleigh factor of the stiffness, s, loss included */
  PetscReal         loss; /* loss factor at the scene's loss_frequency, part of beta; without one that of `law` */
  ElasticityAsked   asked;
  Anisotropy        anisotropy;
  Spin              spin;
  Layer             layer;
  ViscoelasticAsked viscous;
  Viscoelastic      law; /* of the stiffness, at the values of the scene */
} Part;
