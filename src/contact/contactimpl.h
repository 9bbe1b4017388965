/* Private to contact/: the record of the interfaces */
#pragma once

#include "judge.h"
#include "surface.h"

#define CONTACT_MAX 16 /* interfaces of one scene */

struct _p_Contact {
  MPI_Comm         comm;
  Model            model;
  PetscInt         n_interfaces;
  ContactInterface interfaces[CONTACT_MAX];
  PetscInt         n_pairs, n_pairs_all; /* on this rank, on all ranks */
  ContactPair     *pairs;                /* ordered by interface */
  ContactSurface   surface[CONTACT_MAX]; /* of the masters, made when they are asked for first */
};

/* pair.c - appends the pairs of one interface to contact->pairs */
PETSC_INTERN PetscErrorCode ContactPairInterface(Contact contact, PetscInt interface);
