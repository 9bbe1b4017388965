/*
   Dimensions and counts of the built-in rig: options and checks. Lengths in m.

   Defaults are those of the seed paper, and where it is silent the values that reproduce its modes: 21 x 100 x 3
   elements in the disc with a patch under the pad, or its axisymmetric 16 x 160 x 4; spring rows at 20 and 80 mm.
*/
#include "model/modelimpl.h"

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

/* The disc is a ring, with columns; then the footprint */
static PetscErrorCode RigCheck(MPI_Comm comm, const Rig *rig)
{
  PetscFunctionBeginUser;
  PetscCheck(rig->disc_outer > rig->disc_inner, comm, PETSC_ERR_USER_INPUT,
             "Option -rig_disc_outer %.6g must exceed -rig_disc_inner %.6g (m)", (double)rig->disc_outer,
             (double)rig->disc_inner);
  PetscCheck(rig->disc_ntheta >= 3, comm, PETSC_ERR_USER_INPUT,
             "Option -rig_disc_elements has %" PetscInt_FMT " columns, valid are 3 or more", rig->disc_ntheta);
  PetscCheck(0 <= rig->beam_rows[0] && rig->beam_rows[0] < rig->beam_rows[1] && rig->beam_rows[1] <= rig->beam_height,
             comm, PETSC_ERR_USER_INPUT,
             "Option -rig_beam_rows %.6g,%.6g must ascend within 0 and the beam's height %.6g m",
             (double)rig->beam_rows[0], (double)rig->beam_rows[1], (double)rig->beam_height);
  if (rig->with_pad || rig->patch) PetscCall(RigCheckFootprint(comm, rig));
  PetscFunctionReturn(0);
}

/*
   RigSetFromOptions - reads dimensions and counts of the rig. Collective.

   Options are the rows of rig_quantities.

   Errors: PETSC_ERR_USER_INPUT for impossible dimensions and counts.
*/
PetscErrorCode RigSetFromOptions(MPI_Comm comm, Rig *rig)
{
  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(rig, 1));
  PetscCall(QuantitiesInit(&rig_quantities, rig));
  PetscCall(QuantitiesRead(comm, &rig_quantities, rig));
  if (!rig->patch && !rig->has_disc_elements) rig->disc_nr = 16, rig->disc_ntheta = 160, rig->disc_nz = 4;
  PetscCall(RigCheck(comm, rig));
  PetscFunctionReturn(0);
}
