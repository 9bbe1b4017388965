/* Private to contact/mortar: integrals of mortar contact and mortar ties over facets of the slave */
#pragma once

#include "contact/contactimpl.h"
#include "kernels/contact/segment.h"

/* of 40 degrees, less rounding: a regular polygon of nine sides has no fold */
#define MORTAR_FOLD  (0.76604444311897801 + 1e-6)
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
  PetscReal        facing;   /* least cosine between a facet's normal and the reverse of one under it; 0 but at folds */
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

/* How a facet of the slave lies to the master */
typedef enum { MORTAR_BESIDE, MORTAR_PARTLY, MORTAR_OVER } MortarCover;

#define MORTAR_COVERED 0.999 /* of the area of a facet that counts as all over the master */

/* Nodes of the slave with and without pairs (border.c) */
typedef struct {
  const ContactSurface *slave;
  PetscReal            *part;           /* [nodes] r */
  PetscReal            *sum, *whole;    /* [nodes] sum_f D_k, and the largest int N~_k dA over one face, m^2 */
  PetscInt             *cover;          /* [facets] MortarCover */
  PetscBool            *kept;           /* [nodes] */
  const PetscBool      *out;            /* [nodes] of a tie: without pairs, for other reasons; NULL of a contact */
  PetscInt             *first, *around; /* [nodes + 1]; FACET_NODES times a facet around each, and its place there */
  PetscInt             *mark;           /* [nodes] 0 between calls */
  ContactFacetList      takes;          /* nodes that take phi of a facet */
} MortarBorder;

static inline const PetscReal *MortarBorderPlace(const MortarBorder *border, PetscInt node)
{
  const PetscInt at = border->around[border->first[node]];

  return border->slave->facet[at / FACET_NODES].x[at % FACET_NODES];
}

PETSC_INTERN PetscErrorCode MortarBorderCreate(const ContactSurface *slave, MortarBorder *border);
PETSC_INTERN PetscErrorCode MortarBorderDestroy(MortarBorder *border);
/* border.c - adds what facet f has over the master */
PETSC_INTERN void MortarBorderAdd(MortarBorder *border, PetscInt f, PetscReal alpha, const SegmentSums *sums);
/* border.c - which nodes keep their pairs, from what all ranks have added; of[v] >= 0 tells that this rank has added
   all faces around v. Collective. */
PETSC_INTERN PetscErrorCode MortarBorderDecide(MPI_Comm comm, const PetscInt of[], MortarBorder *border);
/* border.c - nodes that take phi of a facet (borrowed, until the next call); 0 for none */
PETSC_INTERN PetscErrorCode MortarBorderTakers(MortarBorder *border, PetscInt f, PetscInt *n, const PetscInt **node);
/* border.c - c of a node for each of n that take; 1 for itself */
PETSC_INTERN void MortarBorderShares(const MortarBorder *border, PetscInt v, PetscInt n, const PetscInt node[],
                                     PetscReal share[]);

/* What one facet adds to the weight of a node in a pair, m^2 */
typedef struct {
  PetscInt        pair, order;
  ContactPairNode node;
} MortarEntry;

typedef struct {
  PetscInt     n, room;
  MortarEntry *entry;
} MortarEntries;

typedef struct MortarSideSums MortarSideSums; /* edges.c */

/* The pairs of an interface, or of a tie, as they are made */
typedef struct {
  Mortar                 mortar;
  MortarFacet            facet;
  MortarBorder           border;
  MortarSideSums        *edges;   /* [slave facets], NULL where no face needs them */
  ContactPair           *pair;    /* [n_pairs] */
  const ContactPairFoot *feet;    /* [n_pairs] of a contact, which tell places; NULL of a tie */
  PetscInt               n_pairs; /* of all slave nodes of this rank */
  PetscInt              *of;      /* [slave nodes] their pairs, -1 for none on this rank */
  PetscInt              *node;    /* [n_pairs] their places in the slave's surface */
  PetscReal             *own;     /* [n_pairs] D of the node itself, m^2 */
  PetscReal (*off)[3];            /* [n_pairs] sum_l int phi_p N_l dA (x_l - x_p), m^3 */
  PetscInt         n_bare;        /* pairs with D_p <= 0 */
  const PetscBool *out;           /* MortarBorder */
  PetscBool        folds;         /* facets must look at each other within 40 degrees (split.c) */
  PetscInt         direction;     /* of a tie: along which its equations are */
  PetscInt         lost;          /* of a tie: a facet over a free master without any pair near it, -1 for none */
  ContactPairNode *sides, *end;   /* nodes of the sides, and where they end; the caller frees them */
  MortarEntries    under;         /* int phi_p N_l dA at the nodes of the master */
  MortarEntries    taken;         /* c_pk D_k of nodes without pairs, by their places in the slave's surface */
} MortarPairs;

/* split.c - gives nodes of a slave at folds a place for each side, the others after those of all nodes */
PETSC_INTERN PetscErrorCode MortarSplitSlave(ContactSurface *s);
/* split.c - normals at the folds of a master, of each side alone */
PETSC_INTERN PetscErrorCode MortarSplitMaster(ContactSurface *s);
/* split.c - sums of the area vectors of the facets at each place of the slave, m^2 */
PETSC_INTERN void MortarPlacesLook(const ContactSurface *s, PetscReal look[][3]);
/* split.c - the foot of a place of the slave that looks along a vector */
PETSC_INTERN PetscErrorCode MortarFootFind(const ContactSurface *master, const PetscReal x[3], const PetscReal look[3],
                                           ContactFacetList *near, ContactFoot *foot);
/* mortar.c - areas and sides of the pairs, whose nodes are m->sides; pair, n_pairs, out and direction are set.
   Collective. */
PETSC_INTERN PetscErrorCode MortarPairsMake(MPI_Comm comm, const ContactSurface *slave, const ContactSurface *master,
                                            PetscReal tolerance, MortarPairs *m);
PETSC_INTERN PetscErrorCode MortarPairsDestroy(MortarPairs *m);
/* mortar.c - raises the error for faces over which no point can be found, and for sums that no contact or tie (what)
   has */
PETSC_INTERN PetscErrorCode MortarSumsCheck(MPI_Comm comm, const char what[], const char name[], const char slave[],
                                            const char master[], const MortarPairs *m);
/* sides.c - adds weight (m^2) at node l of a facet of the master to pair p */
PETSC_INTERN PetscErrorCode MortarMasterAdd(MortarPairs *m, PetscInt p, const ContactFacet *master, int l,
                                            PetscReal weight);
/* edges.c - linear pressures at the sides of faces of second order: what faces all over the master have there, of a
   face as it is integrated, then given to the nodes of this rank */
PETSC_INTERN PetscErrorCode MortarEdgesCreate(MortarPairs *m);
PETSC_INTERN PetscErrorCode MortarEdgesKeep(MortarPairs *m, PetscInt f);
PETSC_INTERN PetscErrorCode MortarEdgesTake(MortarPairs *m);
PETSC_INTERN PetscErrorCode MortarEdgesDestroy(MortarPairs *m);
/* sides.c - u~ of a node of the slave as a sum over nodes, itself first; their number */
PETSC_INTERN int MortarMean(const MortarPairs *m, PetscInt node, ContactPairNode mean[FACET_NODES]);
/* sides.c - sum_k v_k x_k - sum_l w_l x_l of a pair, m */
PETSC_INTERN PetscErrorCode MortarOffset(const MortarPairs *m, PetscInt p, PetscReal offset[3]);
/* sides.c - appends an entry */
PETSC_INTERN PetscErrorCode MortarEntryAdd(MortarEntries *list, PetscInt pair, PetscInt number,
                                           const PetscInt unknown[3], PetscReal weight);
/* sides.c - sides and gaps of the pairs */
PETSC_INTERN PetscErrorCode MortarSetSides(MortarPairs *m);
