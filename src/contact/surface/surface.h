/*
   Surface of a master: facets, their corners' normals, neighbours and bounding volumes. Private to contact/ and the
   projector, which find pairs on it with the same functions, at rest and at displacements.

   The normal at a point of a facet is n = a / |a|, a = sum_i w_i a_i with the facet's own shape functions w_i, where
   a_i (m^2) sums the area vectors of the facets around node i (kernels/contact/facet.h); on facets of second order a_i
   is divided by its length, since those of corners and sides differ, which would leave n of first order. n is
   continuous across edges and of second order in the size of the facets, where that of the facet itself jumps and is of
   first order; on facets of second order it is of third order at least. tilt.c has its derivative.
   A slave at x faces the point x(xi) of the facet to which x - x(xi) is parallel to n(xi). Every node of a slave face
   is a slave, those between its corners too.
*/
#pragma once

#include <squeal/contact.h>
#include "kernels/contact/facet.h"

/* Facet, undeformed */
typedef struct {
  int       n;                        /* nodes, which tell the shape (kernels/contact/facetshape.h) */
  PetscBool flat;                     /* n is the same everywhere, across the facet */
  PetscInt  node[CONTACT_MAX_MASTER]; /* places in ContactSurface.vertex, corners first */
  PetscInt  unknowns[CONTACT_MAX_MASTER][3];
  PetscInt  beside[4];                     /* facet across the edge from corner i to i + 1, -1 at the border */
  PetscReal x[CONTACT_MAX_MASTER][3];      /* m */
  PetscReal across[CONTACT_MAX_MASTER][3]; /* a_i, m^2, or of second order unit vectors along them */
  PetscReal size;                          /* square root of its area, m */
  PetscReal normal[3];                     /* unit vector across the middle */
} ContactFacet;

/* Bounding volume: leaves hold facets order[first .. first + n), others have n = 0 and the boxes after it and `right`
   */
typedef struct {
  PetscReal low[3], high[3];
  PetscInt  first, n, right;
} ContactBox;

/* On every rank, in an order that does not depend on the ranks */
typedef struct {
  PetscInt      n_facets, n_boxes, *order;
  ContactFacet *facet;
  ContactBox   *box;              /* at rest */
  PetscInt      n_nodes, *vertex; /* global numbers of the nodes, ascending */
  PetscInt      n_sorted; /* of these, where nodes at folds have places for each side after them (mortar/split.c) */
  PetscBool     folds;    /* of a master: its normals are of one side of them each (mortar/split.c) */
  PetscReal     size;     /* mean of the facets, m */
  PetscReal     overhang; /* largest distance beyond the border of a slave that faces it, m; 0: CONTACT_EDGE */
} ContactSurface;

/* The surface as it lies */
typedef struct {
  const ContactSurface *surface;
  const PetscInt       *node; /* [n_nodes] places of its nodes in u; NULL at rest */
  const PetscReal      *u;    /* displacements, m */
  const PetscBool      *live; /* [n_facets] may be walked over; NULL for all */
} ContactShape;

/* Foot of a slave on a surface, within a facet or at its edge */
typedef struct {
  PetscInt  facet; /* -1 for none */
  PetscReal natural[2];
  PetscReal distance; /* of the slave, m */
  PetscReal beyond;   /* the border of the surface, in natural coordinates (2 is a facet); <= 0 within */
  PetscReal across;   /* distance along the surface from a foot on the border, m; 0 where the foot is within */
} ContactFoot;

/* Facets found, a list that grows */
typedef struct {
  PetscInt n, room, *facet;
} ContactFacetList;

#define CONTACT_EDGE 0.02 /* beyond the border a slave still faces it, in natural coordinates: 1 % of a facet */

/* How far beyond the border a slave still faces a facet, in natural coordinates */
static inline PetscReal ContactEdge(const ContactSurface *s, const ContactFacet *f)
{
  return s->overhang > 0 ? 2 * s->overhang / f->size : CONTACT_EDGE;
}

/* By x, then y, then z */
static inline int ContactPlaceCompare(const PetscReal a[3], const PetscReal b[3])
{
  for (int d = 0; d < 3; d++)
    if (a[d] != b[d]) return a[d] < b[d] ? -1 : 1;
  return 0;
}

/* Corners of a facet */
static inline int ContactFacetCorners(const ContactFacet *f)
{
  return FacetShapeOf(f->n)->n_corners;
}

/* Mean of the corners of a facet along one axis, times 4; the same from whichever corner they are counted */
static inline PetscReal ContactFacetMiddle(const ContactFacet *f, int d)
{
  const PetscReal a = f->x[0][d], b = f->x[1][d], c = f->x[2][d];
  const PetscReal low = PetscMin(a, PetscMin(b, c)), high = PetscMax(a, PetscMax(b, c));

  if (ContactFacetCorners(f) == 4) return (a + c) + (b + f->x[3][d]);
  return ((low + high) + PetscMax(PetscMin(a, b), PetscMin(PetscMax(a, b), c))) * 4 / 3;
}

/* surface.c - facets of a set on this rank, node[] being global numbers, without neighbours; the caller frees them */
PETSC_INTERN PetscErrorCode ContactFacetsLocal(Model model, const char set[], PetscInt *n, ContactFacet **facets);
/* surface.c - size, normal and flatness of a facet, from its places and a_i */
PETSC_INTERN void ContactFacetMeasure(ContactFacet *f);
/* surface.c - surface of the master of an interface, made when it is asked for first (borrowed). Collective. */
PETSC_INTERN PetscErrorCode ContactGetSurface(Contact contact, PetscInt interface, const ContactSurface **surface);
/* surface.c - any surface, into one that is all 0. Collective. */
PETSC_INTERN PetscErrorCode ContactSurfaceCreate(Contact contact, const char set[], ContactSurface *surface);
PETSC_INTERN PetscErrorCode ContactSurfaceDestroy(ContactSurface *surface);

/* search.c - bounding volumes of a surface at rest; those of the same tree as the surface lies */
PETSC_INTERN PetscErrorCode ContactBoxesBuild(ContactSurface *surface);
PETSC_INTERN void           ContactBoxesFit(const ContactShape *shape, ContactBox box[]);
/* search.c - facets near x, ascending, appended to the n of a list that grows */
PETSC_INTERN PetscErrorCode ContactFacetsNear(const ContactShape *shape, const ContactBox box[], const PetscReal x[3],
                                              PetscReal margin, ContactFacetList *list);
/* search.c - the nearest point of the surface at rest */
PETSC_INTERN void ContactFootNearest(const ContactSurface *surface, const PetscReal x[3], ContactFoot *foot);

/* search.c - nodes of a facet as it lies, m */
PETSC_INTERN void ContactNodes(const ContactShape *shape, PetscInt f, PetscReal x[][3]);
/* foot.c - walks across edges to the facet that x faces, from foot->facet; facet -1 where the way leaves the live
   facets or the surface, or does not end */
PETSC_INTERN void ContactFootWalk(const ContactShape *shape, const PetscReal x[3], ContactFoot *foot);
/* foot.c - takes facet f where its point is nearer to x than the foot so far, and x not deeper below than `deepest`
   sizes of the facet */
PETSC_INTERN void ContactFootTry(const ContactShape *shape, PetscInt f, const PetscReal x[3], PetscReal deepest,
                                 ContactFoot *foot);
/* foot.c - foot of a node on the surface at rest: the nearest point, and from there the facet whose normal leads to the
   node; matching nodes meet exactly. Beyond the border it is the nearest point, and foot->across is more than what
   ContactEdge() allows */
PETSC_INTERN void ContactFootFind(const ContactSurface *surface, const PetscReal x[3], ContactFoot *foot);
/* foot.c - weights and n, t, b at natural coordinates, t along a vector; returns the length of its part across n, 0
   where it has none and t is any tangent */
PETSC_INTERN PetscReal ContactBasis(const ContactFacet *facet, const PetscReal natural[2], const PetscReal along[3],
                                    PetscReal weight[], PetscReal e[3][3]);
/* foot.c - t and b of e[3] = n, t, b, whose n is set: t along a vector; returns as ContactBasis() does */
PETSC_INTERN PetscReal ContactTangents(const PetscReal along[3], PetscReal e[3][3]);
/* foot.c - n . (x - x_m) at rest, m */
PETSC_INTERN PetscReal ContactGap(const ContactFacet *facet, const PetscReal weight[], const PetscReal n[3],
                                  const PetscReal x[3]);
/* foot.c - direction in which a slave at x slides on the master: with rotation its velocity (m/s), else the vector of
   the options, 0 where nothing says one */
PETSC_INTERN void ContactSlideAlong(const ContactInterface *c, const PetscReal x[3], PetscReal v[3]);
