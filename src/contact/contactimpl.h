/* Private to contact/: the record of the interfaces */
#pragma once

#include <squeal/contact.h>

#define CONTACT_MAX 16 /* interfaces of one scene */

struct _p_Contact {
  MPI_Comm         comm;
  Model            model;
  PetscInt         n_interfaces;
  ContactInterface interfaces[CONTACT_MAX];
  PetscInt         n_pairs, n_pairs_all; /* on this rank, on all ranks */
  ContactPair     *pairs;                /* ordered by interface */
};

/* pair.c - appends the pairs of one interface to contact->pairs */
PETSC_INTERN PetscErrorCode ContactPairInterface(Contact contact, PetscInt interface);
