/* Private to contact/mortar: integrals of mortar contact over facets of the slave */
#pragma once

#include "contact/contactimpl.h"
#include "kernels/contact/segment.h"

#define MORTAR_RULES 9 /* of the triangle, by their points along a side */

/* C of a facet of the slave with one of the master, m^2 */
typedef struct {
  PetscInt  facet;
  PetscReal cross[FACET_NODES][FACET_NODES];
} MortarBlock;

typedef struct {
  const ContactSurface *slave, *master;
  PetscReal             alpha;     /* kernels/contact/segment.h */
  PetscReal             tolerance; /* largest distance along the normal, m */
  PetscReal (*point[MORTAR_RULES + 1])[3];
  SegmentRule      rule[MORTAR_RULES + 1]; /* n points along a side, exact to degree 2 n - 1 */
  ContactFacetList near;
  PetscInt         n_failed; /* segments that could not be mapped */
} Mortar;

/* Integrals over one facet of the slave, with all of the master under it */
typedef struct {
  SegmentSums  sums;                           /* D, M */
  PetscReal    dual[FACET_NODES][FACET_NODES]; /* phi_j = sum_k dual_jk N~_k */
  PetscInt     n, room;
  MortarBlock *block;
} MortarFacet;

/* facets.c - rules and lists; frees them */
PETSC_INTERN PetscErrorCode MortarCreate(const ContactSurface *slave, const ContactSurface *master, PetscReal tolerance,
                                         Mortar *mortar);
PETSC_INTERN PetscErrorCode MortarDestroy(Mortar *mortar);
/* facets.c - integrals of facet f of the slave and its dual functions; n 0 where no master lies under it */
PETSC_INTERN PetscErrorCode MortarIntegrate(Mortar *mortar, PetscInt f, MortarFacet *facet);
