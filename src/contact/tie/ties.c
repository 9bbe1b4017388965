/* Ties: access to them and their links; their parameters as a sum, and in words */
#include "contact/contactimpl.h"

PetscErrorCode ContactGetTies(Contact contact, PetscInt *n, const ContactTie **ties)
{
  PetscFunctionBeginUser;
  *n    = contact ? contact->n_ties : 0;
  *ties = contact ? contact->ties : NULL;
  PetscFunctionReturn(0);
}

PetscErrorCode ContactGetLinks(Contact contact, PetscInt *n, const ContactLink **links)
{
  PetscFunctionBeginUser;
  *n     = contact ? contact->n_links : 0;
  *links = contact ? contact->links : NULL;
  PetscFunctionReturn(0);
}

PetscErrorCode ContactTiesAddChecksum(Contact contact, Checksum c)
{
  PetscFunctionBeginUser;
  for (PetscInt t = 0; t < contact->n_ties; t++) {
    const ContactTie *tie = &contact->ties[t];

    PetscCall(ChecksumSetPart(c, "tie %s", tie->name));
    PetscCall(ModelAddSetChecksum(contact->model, tie->slave, PETSC_FALSE, c));
    PetscCall(ModelAddSetChecksum(contact->model, tie->master, PETSC_TRUE, c));
    PetscCall(ChecksumAddReals(c, 1, &tie->distance));
    PetscCall(ChecksumAddInts(c, 2, (const PetscInt[]){tie->free, tie->discretization}));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode ContactTiesView(Contact contact, PetscViewer viewer)
{
  const char *unit;

  PetscFunctionBeginUser;
  for (PetscInt t = 0; t < contact->n_ties; t++) {
    const ContactTie *tie = &contact->ties[t];

    PetscCall(ModelGetUnit(contact->model, "m", &unit));
    PetscCall(PetscViewerASCIIPrintf(
      viewer, "tie %s: %" PetscInt_FMT " nodes of %s follow %s%s, the farthest %.6g %s off it", tie->name, tie->n,
      tie->slave, tie->master, tie->mortar ? " by mortar" : "", (double)tie->offset, unit));
    if (tie->n_common)
      PetscCall(PetscViewerASCIIPrintf(viewer, " (%" PetscInt_FMT " are nodes of both)", tie->n_common));
    PetscCall(PetscViewerASCIIPrintf(viewer, "\n"));
    if (tie->n_far)
      PetscCall(PetscViewerASCIIPrintf(viewer, "  %" PetscInt_FMT " nodes of %s are farther off, and stay free\n",
                                       tie->n_far, tie->slave));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode ContactTiesDestroy(Contact contact)
{
  PetscFunctionBeginUser;
  for (PetscInt t = 0; t < contact->n_ties; t++) {
    if (contact->followed) PetscCall(PetscFree(contact->followed[t]));
    PetscCall(PetscFree(contact->ties[t].name));
    PetscCall(PetscFree(contact->ties[t].slave));
    PetscCall(PetscFree(contact->ties[t].master));
  }
  PetscCall(PetscFree(contact->ties));
  PetscCall(PetscFree(contact->links));
  PetscCall(PetscFree(contact->followed));
  PetscFunctionReturn(0);
}
