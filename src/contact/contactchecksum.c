/*
   What the interfaces add to the checksum of a scene: what options say. A stiffness that is found by pressing follows
   from the rest of the scene.
*/
#include "contactimpl.h"

PetscErrorCode ContactAddChecksum(Contact contact, Checksum c)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < contact->n_interfaces; i++) {
    const ContactInterface *f         = &contact->interfaces[i];
    const PetscInt          flags[]   = {i, f->law, f->identify, f->damping};
    const PetscReal         numbers[] = {f->mu, f->mu_slope, f->tolerance, f->speed, f->identify ? 0 : f->kn, f->force};

    PetscCall(ChecksumSetPart(c, "contact %s", f->name));
    PetscCall(ModelAddSetChecksum(contact->model, f->slave, PETSC_TRUE, c));
    PetscCall(ModelAddSetChecksum(contact->model, f->master, PETSC_TRUE, c));
    PetscCall(ChecksumAddInts(c, PETSC_STATIC_ARRAY_LENGTH(flags), flags));
    PetscCall(ChecksumAddReals(c, PETSC_STATIC_ARRAY_LENGTH(numbers), numbers));
    PetscCall(ChecksumAddReals(c, 3, f->slip));
    PetscCall(ChecksumAddReals(c, 3, f->rotation));
    PetscCall(ChecksumAddReals(c, 3, f->center));
  }
  PetscFunctionReturn(0);
}
