/* Private to contact/: what a place follows on a surface */
#pragma once

#include "contact/contactimpl.h"

/* tie.c - the arm from a foot to a node, m; returns its length */
PETSC_INTERN PetscReal FootGetArm(const ContactFacet *facet, const ContactFoot *foot, const PetscReal x[3],
                                  PetscReal arm[3]);
/* tie.c - the nodes that a link follows, with their matrices A_i = w_i I + (turning of the facet by node i) x arm,
   [3][3] by rows, room for those of a facet; their number. Those with A_i = 0 are left out: on matching meshes without
   a gap one node of weight 1 remains. A node of weight 0 stays where the arm needs its part of the turning. */
PETSC_INTERN PetscInt LinkSetMaster(const ContactSurface *surface, const ContactFoot *foot, const PetscReal arm[3],
                                    ContactLinkNode master[]);
/* tie.c - the longest arm that is allowed on a facet, m: the distance, or without one a share of the facet */
PETSC_INTERN PetscReal TieReach(PetscReal distance, const ContactFacet *facet);
