/* Private to contact/: the record of the interfaces */
#pragma once

#include "judge.h"
#include "contact/surface/surface.h"
#include <squeal/quantity.h>

#define CONTACT_MAX 16 /* interfaces of one scene */

struct _p_Contact {
  MPI_Comm          comm;
  Model             model;
  PetscInt          n_interfaces;
  ContactInterface *interfaces;
  PetscInt          n_pairs, n_pairs_all; /* on this rank, on all ranks */
  ContactPair      *pairs;                /* ordered by interface */
  ContactSurface    surface[CONTACT_MAX]; /* of the masters, made when they are asked for first */
  PetscInt          n_ties, n_links;      /* links of this rank */
  ContactTie       *ties;
  ContactLink      *links; /* ordered by tie */
};

/* pair.c - appends the pairs of one interface to contact->pairs */
PETSC_INTERN PetscErrorCode ContactPairInterface(Contact contact, PetscInt interface);
/* pair.c - the largest value of all ranks, and its place, m. Collective. */
PETSC_INTERN PetscErrorCode ContactShareWorst(MPI_Comm comm, PetscReal *value, PetscReal x[3]);

/* cover.c - areas of n new pairs, of local nodes node[n], where faces of the slave lie partly over the master; takes
   out those without. *lost: area over the master of faces without any pair, m^2. Collective. */
PETSC_INTERN PetscErrorCode ContactCoverAreas(Contact contact, PetscInt interface, PetscInt *n, const PetscInt node[],
                                              ContactPair pair[], PetscReal *lost);

/* quantities.c - the lists of interfaces and ties; contact.c, tie.c - what their rows do not say */
/* Why nobody reads how it slides in time, where it does not slide as told */
#define CONTACT_STILL "not used where nothing slides as told: give -@slip or -@rotation"
extern const QuantityList   contacts_list, ties_list;
PETSC_INTERN PetscErrorCode InterfaceCheckOptions(MPI_Comm comm, void *owner, void *record);
PETSC_INTERN PetscErrorCode TieCheckNames(MPI_Comm comm, void *owner, void *record);
PETSC_INTERN PetscErrorCode ContactTiesDestroy(Contact contact);
/* tie.c - adds surfaces and distances; in words. Collective. */
PETSC_INTERN PetscErrorCode ContactTiesAddChecksum(Contact contact, Checksum checksum);
PETSC_INTERN PetscErrorCode ContactTiesView(Contact contact, PetscViewer viewer);
