/*
   Dimensions and counts of the built-in rig: options and checks. Lengths in m.

   Defaults are those of the seed paper, and where it is silent the values that reproduce its modes: 21 x 100 x 3
   elements in the disc with a patch under the pad, or its axisymmetric 16 x 160 x 4; spring rows at 20 and 80 mm.
*/
#include "model/modelimpl.h"
#include <squeal/options.h>

/* The pad stands on the disc's face and the patch leaves rings and columns beside it */
static PetscErrorCode RigCheckFootprint(MPI_Comm comm, const Rig *rig)
{
  const PetscReal reach =
    PetscSqrtReal(PetscSqr(rig->pad_radius + 0.5 * rig->pad_size[0]) + PetscSqr(0.5 * rig->pad_size[1]));

  PetscFunctionBeginUser;
  PetscCheck(
    rig->pad_radius - 0.5 * rig->pad_size[0] > rig->disc_inner && reach < rig->disc_outer, comm, PETSC_ERR_USER_INPUT,
    "Pad at -rig_pad_radius %.6g with -rig_pad_size %.6g,%.6g does not lie on the disc's face, radii %.6g to %.6g m",
    (double)rig->pad_radius, (double)rig->pad_size[0], (double)rig->pad_size[1], (double)rig->disc_inner,
    (double)rig->disc_outer);
  PetscCheck(!rig->patch || (rig->disc_nr >= rig->pad_n[0] + 2 && rig->disc_ntheta >= rig->pad_n[1] + 4), comm,
             PETSC_ERR_USER_INPUT,
             "Option -rig_disc_elements %" PetscInt_FMT ",%" PetscInt_FMT
             " is too coarse for the patch of -rig_pad_elements %" PetscInt_FMT ",%" PetscInt_FMT
             ": at least %" PetscInt_FMT ",%" PetscInt_FMT " are needed",
             rig->disc_nr, rig->disc_ntheta, rig->pad_n[0], rig->pad_n[1], rig->pad_n[0] + 2, rig->pad_n[1] + 4);
  PetscFunctionReturn(0);
}

static PetscReal Smallest(PetscReal a, PetscReal b, PetscReal c)
{
  return PetscMin(a, PetscMin(b, c));
}

/* Every dimension and count is positive and the disc a ring; then the footprint */
static PetscErrorCode RigCheck(MPI_Comm comm, const Rig *rig)
{
  const PetscReal disc_n   = Smallest(rig->disc_nr, rig->disc_ntheta, rig->disc_nz);
  const PetscReal pad_size = Smallest(rig->pad_size[0], rig->pad_size[1], rig->pad_size[2]);
  const PetscReal pad_n    = Smallest(rig->pad_n[0], rig->pad_n[1], rig->pad_n[2]);
  const struct {
    const char *option;
    PetscReal   smallest;
  } positive[] = {
    {"disc_inner",     rig->disc_inner    },
    {"disc_thickness", rig->disc_thickness},
    {"disc_elements",  disc_n             },
    {"pad_size",       pad_size           },
    {"pad_elements",   pad_n              },
    {"beam_height",    rig->beam_height   },
    {"beam_elements",  rig->beam_nz       },
  };

  PetscFunctionBeginUser;
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(positive); i++) {
    PetscCheck(positive[i].smallest > 0, comm, PETSC_ERR_USER_INPUT,
               "Option -"
               "rig_"
               "%s %.6g must be positive",
               positive[i].option, (double)positive[i].smallest);
  }
  PetscCheck(rig->disc_outer > rig->disc_inner, comm, PETSC_ERR_USER_INPUT,
             "Option -rig_disc_outer %.6g must exceed -rig_disc_inner %.6g (m)", (double)rig->disc_outer,
             (double)rig->disc_inner);
  PetscCheck(0 <= rig->disc_spread && rig->disc_spread <= 1, comm, PETSC_ERR_USER_INPUT,
             "Option -rig_disc_spread %.6g must lie between 0 and 1", (double)rig->disc_spread);
  PetscCheck(rig->disc_ntheta >= 3, comm, PETSC_ERR_USER_INPUT,
             "Option -rig_disc_elements has %" PetscInt_FMT " columns, valid are 3 or more", rig->disc_ntheta);
  PetscCheck(0 <= rig->beam_rows[0] && rig->beam_rows[0] < rig->beam_rows[1] && rig->beam_rows[1] <= rig->beam_height,
             comm, PETSC_ERR_USER_INPUT,
             "Option -rig_beam_rows %.6g,%.6g must ascend within 0 and the beam's height %.6g m",
             (double)rig->beam_rows[0], (double)rig->beam_rows[1], (double)rig->beam_height);
  if (rig->with_pad || rig->patch) PetscCall(RigCheckFootprint(comm, rig));
  PetscFunctionReturn(0);
}

static PetscErrorCode RigReadDisc(OptionsItems PetscOptionsObject, Rig *rig)
{
  const char *const meshes[] = {"axisymmetric", "patch"};
  PetscInt          mesh     = 1, elements[3];

  PetscFunctionBeginUser;
  PetscCall(OptionsGetReal(PetscOptionsObject, "-disc_inner", "Inner radius of the disc (m)", rig->disc_inner,
                           &rig->disc_inner, NULL));
  PetscCall(OptionsGetReal(PetscOptionsObject, "-disc_outer", "Outer radius of the disc (m)", rig->disc_outer,
                           &rig->disc_outer, NULL));
  PetscCall(OptionsGetReal(PetscOptionsObject, "-disc_thickness", "Thickness of the disc (m)", rig->disc_thickness,
                           &rig->disc_thickness, NULL));
  PetscCall(PetscOptionsEList("-disc_mesh", "Grid of the disc: axisymmetric, or with a patch that matches the pad",
                              "model.h", meshes, 2, meshes[mesh], &mesh, NULL));
  rig->patch = mesh ? PETSC_TRUE : PETSC_FALSE;
  PetscCall(PetscArraycpy(elements, rig->patch ? ((PetscInt[]){21, 100, 3}) : ((PetscInt[]){16, 160, 4}), 3));
  PetscCall(OptionsGetInts(PetscOptionsObject, "-disc_elements",
                           "Elements of the disc: rings, columns, layers (21,100,3, axisymmetric 16,160,4)", 3,
                           elements));
  rig->disc_nr     = elements[0];
  rig->disc_ntheta = elements[1];
  rig->disc_nz     = elements[2];
  PetscCall(OptionsGetReal(PetscOptionsObject, "-disc_spread",
                           "Rings away from the patch: 0 keep their radii, 1 become uniform (-)", rig->disc_spread,
                           &rig->disc_spread, NULL));
  PetscFunctionReturn(0);
}

static PetscErrorCode RigReadPad(OptionsItems PetscOptionsObject, Rig *rig)
{
  PetscFunctionBeginUser;
  PetscCall(OptionsGetBool(PetscOptionsObject, "-pad", "Pad and beam as well as the disc", &rig->with_pad));
  PetscCall(OptionsGetReal(PetscOptionsObject, "-pad_radius", "Radius of the pad's centre (m)", rig->pad_radius,
                           &rig->pad_radius, NULL));
  PetscCall(OptionsGetReals(PetscOptionsObject, "-pad_size", "Size of the pad in x, y, z (m; 0.01,0.01,0.01)", 3,
                            rig->pad_size, NULL));
  PetscCall(
    OptionsGetInts(PetscOptionsObject, "-pad_elements", "Elements of the pad in x, y, z (10,10,10)", 3, rig->pad_n));
  PetscFunctionReturn(0);
}

static PetscErrorCode RigReadBeam(OptionsItems PetscOptionsObject, Rig *rig)
{
  PetscFunctionBeginUser;
  PetscCall(OptionsGetReal(PetscOptionsObject, "-beam_height", "Height of the beam (m)", rig->beam_height,
                           &rig->beam_height, NULL));
  PetscCall(OptionsGetInt(PetscOptionsObject, "-beam_elements", "Elements of the beam over its height (-)",
                          rig->beam_nz, &rig->beam_nz, NULL));
  PetscCall(OptionsGetReals(PetscOptionsObject, "-beam_rows",
                            "Heights of the spring rows above the beam's lower end (m; 0.02,0.08)", 2, rig->beam_rows,
                            NULL));
  PetscFunctionReturn(0);
}

/*
   RigSetFromOptions - reads dimensions and counts of the rig. Collective.

   Options Database Keys:
+  -rig_disc_inner, -rig_disc_outer, -rig_disc_thickness <0.05, 0.12, 0.01> - m
.  -rig_disc_mesh <patch|axisymmetric>        - grid of the disc
.  -rig_disc_elements <21,100,3 or 16,160,4>  - rings, columns, layers
.  -rig_disc_spread <0>                       - 0: rings of the patch keep their radii all around, 1: they even out
.  -rig_pad <true>                            - false: the disc alone
.  -rig_pad_radius <0.11>                     - radius of the pad's centre, m
.  -rig_pad_size <0.01,0.01,0.01>             - m
.  -rig_pad_elements <10,10,10>               - in x, y, z
.  -rig_beam_height <0.1>                     - m
.  -rig_beam_elements <20>                    - over the height
.  -rig_beam_rows <0.02,0.08>                 - heights of the rows of spring nodes above the beam's lower end, m
-  -rig_save <file>                           - write mesh and sets as a Gmsh file

   Errors: PETSC_ERR_USER_INPUT for impossible dimensions and counts.
*/
PetscErrorCode RigSetFromOptions(MPI_Comm comm, Rig *rig)
{
  PetscFunctionBeginUser;
  *rig = (Rig){
    .disc_inner     = 0.05,
    .disc_outer     = 0.12,
    .disc_thickness = 0.01,
    .with_pad       = PETSC_TRUE,
    .pad_radius     = 0.11,
    .pad_size       = {0.01, 0.01, 0.01},
    .pad_n          = {10,    10,       10},
    .beam_height    = 0.1,
    .beam_nz        = 20,
    .beam_rows      = {0.02,  0.08}
  };
  PetscOptionsBegin(comm, "rig_", "Built-in disc, pad and beam", NULL);
  PetscCall(RigReadDisc(PetscOptionsObject, rig));
  PetscCall(RigReadPad(PetscOptionsObject, rig));
  PetscCall(RigReadBeam(PetscOptionsObject, rig));
  PetscCall(PetscOptionsString("-save", "file of Gmsh to write the mesh and its sets to", "model.h", rig->save,
                               rig->save, sizeof(rig->save), NULL));
  PetscOptionsEnd();
  PetscCall(RigCheck(comm, rig));
  PetscFunctionReturn(0);
}
