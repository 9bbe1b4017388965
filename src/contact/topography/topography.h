/* Private to contact/: gaps of the unloaded surfaces from a file, and the wear that makes them grow */
#pragma once

#include "contact/contactimpl.h"

/* Rows of -wear_time and the like */
extern const QuantityTable wear_quantities;

/* topography.c - reads the file of -contact_gap, on all ranks alike; puts its gaps into the pairs of the interface,
   which are there. Collective. */
PETSC_INTERN PetscErrorCode ContactGapsRead(MPI_Comm comm, ContactInterface *c);
PETSC_INTERN PetscErrorCode ContactGapsSet(Contact contact, PetscInt interface);

/* Warns of gaps of files, and of a worn depth, that are in m where the scene is in mm. Collective. */
PETSC_INTERN PetscErrorCode ContactLengthsWarn(Contact contact);

/* wear.c - raises the error for wear of an interface that cannot wear so; quadratic: its slave has faces of second
   order. Collective. */
PETSC_INTERN PetscErrorCode ContactWearCheck(MPI_Comm comm, const ContactInterface *c, PetscBool quadratic);
