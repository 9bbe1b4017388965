/* Private to contact/: the record of the interfaces */
#pragma once

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

/* A pair before the laws */
typedef struct {
  const ContactState *state;
  PetscReal           mu;
  PetscReal           kn;    /* N/m, infinite where contact is exact */
  PetscReal           gap;   /* of the mesh as it is, m */
  PetscReal           width; /* m */
  PetscBool           told;  /* slips along t as it is told, not where it moves to */
} ContactJudged;

/* kkt.c - residuals of the pairs of all ranks; displacement is the largest of this rank, m. Collective. */
PETSC_INTERN PetscErrorCode ContactJudge(MPI_Comm comm, PetscInt n, const ContactJudged pair[], PetscReal displacement,
                                         ContactKKT *kkt);
