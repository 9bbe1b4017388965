/* Private to contact/: the record of the interfaces */
#pragma once

#include "judge.h"
#include "contact/surface/surface.h"
#include <squeal/quantity.h>

#define CONTACT_MAX 16 /* interfaces of one scene */

/* The point that the slave node of a pair faces, with n, t and b of the pair, and the node */
typedef struct {
  PetscInt  facet;
  PetscReal weight[CONTACT_MAX_MASTER]; /* of the facet's nodes */
  PetscReal across;                     /* |sum_i w_i a_i| (surface/surface.h) */
  PetscReal distance;                   /* of the node, m */
  PetscReal beyond;                     /* that along the surface, of a node beyond the border of the master, m */
  PetscBool slides;                     /* the slip has a part in the tangent plane */
  PetscInt  node;                       /* local */
  PetscInt  place;                      /* of mortar: in the split surface of the slave (mortar/split.c) */
  PetscReal normal[3];                  /* of the slave there, times area, m^2 */
} ContactPairFoot;

struct _p_Contact {
  MPI_Comm          comm;
  Model             model;
  PetscInt          n_interfaces;
  ContactInterface *interfaces;
  ContactWear       wear;
  PetscInt          n_pairs, n_pairs_all; /* on this rank, on all ranks */
  ContactPair      *pairs;                /* ordered by interface */
  PetscBool         mortar[CONTACT_MAX];  /* what -contact_discretization comes to, known with the pairs */
  ContactPairFoot  *feet;                 /* of the pairs */
  ContactPairNode  *sides[CONTACT_MAX];   /* nodes of the pairs of each interface */
  PetscInt          n_means;
  ContactMean      *means;                /* of nodes without pairs */
  ContactSurface    surface[CONTACT_MAX]; /* of the masters, made when they are asked for first */
  PetscInt          n_ties, n_links;      /* links of this rank */
  ContactTie       *ties;
  ContactLink      *links;    /* ordered by tie */
  ContactLinkNode **followed; /* [n_ties] what those of each follow */
};

/* pair.c - appends the pairs of one interface to contact->pairs */
PETSC_INTERN PetscErrorCode ContactPairInterface(Contact contact, PetscInt interface);
/* pair.c - whether its pairs are means over both surfaces, before or after ContactSetUp(). Collective. */
PETSC_INTERN PetscErrorCode ContactIsMortar(Contact contact, PetscInt interface, PetscBool *mortar);
/* pair.c - the largest value of all ranks, and its place, m. Collective. */
PETSC_INTERN PetscErrorCode ContactShareWorst(MPI_Comm comm, PetscReal *value, PetscReal x[3]);
/* Whether a slave lies farther beyond the border of the master than is allowed */
static inline PetscBool ContactFootIsOff(const ContactSurface *surface, const ContactPairFoot *foot)
{
  const ContactFacet *facet = foot->facet < 0 ? NULL : &surface->facet[foot->facet];

  return !facet || foot->beyond > 0.5 * ContactEdge(surface, facet) * facet->size ? PETSC_TRUE : PETSC_FALSE;
}

/* surface/fold.c - says how many pairs of an interface lean at folds of the master. Collective. */
PETSC_INTERN PetscErrorCode ContactFoldWarn(Contact contact, PetscInt interface);

/* cover.c - areas of the pairs from the first on where faces of the slave lie partly over the master; takes out those
   without. *lost: area over the master of faces without any pair, m^2. Collective. */
PETSC_INTERN PetscErrorCode ContactCoverAreas(Contact contact, PetscInt interface, PetscInt first, PetscReal *lost);
/* cover.c - whether a facet of the master lies within the tolerance (m) of a face of this size (m), and looks towards
   it; e[2] is the face's normal at its middle, the origin */
PETSC_INTERN PetscBool ContactFacetFaces(const ContactFacet *facet, const double e[3][3], const double origin[3],
                                         PetscReal size, PetscReal tolerance);
/* pairfoot.c - weights, directions and gap of a pair at a foot */
PETSC_INTERN void ContactPairTakeFoot(const ContactInterface *c, const ContactSurface *surface, const ContactFoot *foot,
                                      ContactPair *pair, ContactPairFoot *at);
/* mortar/split.c - a pair for each side of the slave nodes at folds, from the first on; normals of the master at its
   folds. Collective. */
PETSC_INTERN PetscErrorCode ContactMortarSplit(Contact contact, PetscInt interface, PetscInt first);
/* mortar/split.c - nodes of the slave at folds that lie on the master with two sides or more. Collective. */
PETSC_INTERN PetscErrorCode ContactFoldCount(Contact contact, PetscInt interface, PetscInt *n);
/* mortar/mortar.c - sides, areas over the master (0 for none) and gaps of the pairs from the first on, which are those
   of all slave nodes of the interface and have their feet. Collective. */
PETSC_INTERN PetscErrorCode ContactMortarPairs(Contact contact, PetscInt interface, PetscInt first);
/* Surfaces of a mortar interface that move, in time (mortar/moved.c) */
typedef struct {
  const ContactInterface *c;
  const ContactSurface   *master;  /* at rest */
  ContactSurface          slave;   /* at rest, with a place for each side of its folds */
  ContactSurface          here[2]; /* slave and master where they lie, nodes numbered by the caller */
  PetscReal (*look)[3];            /* [places] of the slave: sums of area vectors there, m^2 */
  ContactFacetList near;
  PetscInt         n_failed; /* segments that could not be mapped, since the beginning */
} ContactMoved;

/* Their pairs at one moment, [places of the slave]; area 0: none. Numbers of nodes are those of the caller. */
typedef struct {
  ContactPair     *pair;
  ContactPairFoot *feet;
  ContactPairNode *sides;
} ContactMovedPairs;

/* mortar/moved.c - both surfaces of an interface. Collective. */
PETSC_INTERN PetscErrorCode ContactMovedCreate(Contact contact, PetscInt interface, ContactMoved *moved);
/* mortar/moved.c - numbers of the nodes at the places of the slave and of the master, ascending as vertex[] */
PETSC_INTERN PetscErrorCode ContactMovedNumber(ContactMoved *moved, const PetscInt slave[], const PetscInt master[]);
/* mortar/moved.c - the pairs where the slave's places lie at u[0] [places][3] and the master's nodes at u[1] (m) from
   rest, NULL: at rest; on one rank */
PETSC_INTERN PetscErrorCode ContactMovedFind(ContactMoved *moved, const PetscReal *const u[2],
                                             ContactMovedPairs *pairs);
PETSC_INTERN PetscErrorCode ContactMovedPairsDestroy(ContactMovedPairs *pairs);
/* mortar/moved.c - raises the error for faces over which no point can be found. Collective. */
PETSC_INTERN PetscErrorCode ContactMovedCheck(MPI_Comm comm, const ContactMoved *moved);
PETSC_INTERN PetscErrorCode ContactMovedDestroy(ContactMoved *moved);
/* mortar/match.c - whether the meshes of an interface match, from all its slave nodes, the pairs from the first on.
   Collective. */
PETSC_INTERN PetscErrorCode ContactMeshesMatch(Contact contact, PetscInt interface, PetscInt first, PetscBool *match);

/* mortar/match.c - whether the meshes of a tie match, from its links to feet, those from the first on. Collective. */
PETSC_INTERN PetscErrorCode ContactTieMatches(Contact contact, PetscInt tie, PetscInt first,
                                              const ContactSurface *master, PetscBool *match);
/* mortar/glue.c - appends the mortar links of the nodes of this rank, counts them; *held = 1 and x (m) where a support
   holds slaves in a direction in which the master is free. Collective. */
PETSC_INTERN PetscErrorCode ContactGlue(Contact contact, PetscInt t, const ContactSurface *master, ContactTie *count,
                                        PetscReal *held, PetscReal x[3]);

/* quantities.c - the lists of interfaces and ties; contact.c, tie/tie.c - what their rows do not say */
/* Why nobody reads how it slides in time, where it does not slide as told */
#define CONTACT_STILL "not used where nothing slides as told: give -@slip or -@rotation"
extern const QuantityList   contacts_list, ties_list;
PETSC_INTERN PetscErrorCode InterfaceCheckOptions(MPI_Comm comm, void *owner, void *record);
PETSC_INTERN PetscErrorCode TieCheckNames(MPI_Comm comm, void *owner, void *record);
PETSC_INTERN PetscErrorCode ContactTiesDestroy(Contact contact);
/* tie/ties.c - adds surfaces and distances; in words. Collective. */
PETSC_INTERN PetscErrorCode ContactTiesAddChecksum(Contact contact, Checksum checksum);
PETSC_INTERN PetscErrorCode ContactTiesView(Contact contact, PetscViewer viewer);
