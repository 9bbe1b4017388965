/*
   Values at the local nodes, three each in the layout of the DM's coordinates, and displacements of the unknowns as
   such values.
*/
#include "modelimpl.h"

PetscErrorCode ModelCreateNodal(Model model, Vec *nodal)
{
  Vec coordinates;

  PetscFunctionBeginUser;
  PetscCall(DMGetCoordinatesLocal(model->dm, &coordinates));
  PetscCall(VecDuplicate(coordinates, nodal));
  PetscCall(VecSet(*nodal, 0));
  PetscFunctionReturn(0);
}

PetscErrorCode ModelCreateVec(Model model, Vec *u)
{
  PetscFunctionBeginUser;
  PetscCall(VecCreate(model->comm, u));
  PetscCall(VecSetSizes(*u, model->mesh.n_own, model->mesh.n_unknowns));
  PetscCall(VecSetType(*u, VECSTANDARD));
  PetscFunctionReturn(0);
}

/* Values of the unknowns that nodes have, into a local vector of the DM, whose global ones have no others */
static PetscErrorCode UnknownsTake(Model model, Vec u, Vec local)
{
  const PetscScalar *value;
  Vec                global;

  PetscFunctionBeginUser;
  if (!model->mesh.n_apart) {
    PetscCall(DMGlobalToLocal(model->dm, u, INSERT_VALUES, local));
    PetscFunctionReturn(0);
  }
  PetscCall(DMGetGlobalVector(model->dm, &global));
  PetscCall(VecGetArrayRead(u, &value));
  PetscCall(VecPlaceArray(global, value));
  PetscCall(DMGlobalToLocal(model->dm, global, INSERT_VALUES, local));
  PetscCall(VecResetArray(global));
  PetscCall(VecRestoreArrayRead(u, &value));
  PetscCall(DMRestoreGlobalVector(model->dm, &global));
  PetscFunctionReturn(0);
}

PetscErrorCode ModelGetNodal(Model model, Vec u, PetscReal nodal[])
{
  const PetscScalar *value;
  Vec                local;

  PetscFunctionBeginUser;
  PetscCall(DMGetLocalVector(model->dm, &local));
  PetscCall(VecSet(local, 0)); /* the held displacements, which vectors of the unknowns do not have */
  if (u) PetscCall(UnknownsTake(model, u, local));
  PetscCall(VecGetArrayRead(local, &value));
  PetscCall(PetscArraycpy(nodal, value, 3 * model->mesh.n_nodes));
  PetscCall(VecRestoreArrayRead(local, &value));
  PetscCall(DMRestoreLocalVector(model->dm, &local));
  PetscFunctionReturn(0);
}

PetscErrorCode ModelSumShared(Model model, Vec local)
{
  DM  cdm;
  Vec global;

  PetscFunctionBeginUser;
  PetscCall(DMGetCoordinateDM(model->dm, &cdm));
  PetscCall(DMGetGlobalVector(cdm, &global));
  PetscCall(VecSet(global, 0));
  PetscCall(DMLocalToGlobal(cdm, local, ADD_VALUES, global));
  PetscCall(DMGlobalToLocal(cdm, global, INSERT_VALUES, local));
  PetscCall(DMRestoreGlobalVector(cdm, &global));
  PetscFunctionReturn(0);
}
