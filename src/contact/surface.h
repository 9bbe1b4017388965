/*
   Surface of a master: facets, their corners' normals, neighbours and bounding volumes. Private to contact/ and the
   projector, which find pairs on it with the same functions, at rest and at displacements.

   The normal at a point of a facet is n = a / |a|, a = sum_i w_i a_i (m^2), where a_i sums, over the facets around corner
   i, their shares of the area vector. It is continuous across edges and of second order in the size of the facets; that
   of the facet itself jumps there and is of first order. tilt.c has its derivative.
   A slave at x faces the point x(xi) of the facet to which x - x(xi) is parallel to n(xi).
*/
#pragma once

#include <squeal/contact.h>

/* Facet, undeformed */
typedef struct {
  PetscInt  node[4]; /* corners: places in ContactSurface.vertex */
  PetscInt  unknowns[4][3];
  PetscInt  beside[4];  /* facet across the edge from corner i to i + 1, -1 at the border */
  PetscReal x[4][3];    /* m */
  PetscReal area[4][3]; /* area vectors a_i, m^2 */
  PetscReal size;       /* square root of its area, m */
  PetscBool flat;       /* n is the same everywhere, across the facet */
  PetscReal normal[3];  /* unit vector across the middle */
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
  PetscInt      n_nodes, *vertex; /* global numbers of the corners, ascending */
  PetscReal     size;             /* mean of the facets, m */
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
} ContactFoot;

/* Facets found, a list that grows */
typedef struct {
  PetscInt n, room, *facet;
} ContactFacetList;

#define CONTACT_EDGE 0.02 /* beyond the border a slave still faces it, in natural coordinates */

/* By x, then y, then z */
static inline int ContactPlaceCompare(const PetscReal a[3], const PetscReal b[3])
{
  for (int d = 0; d < 3; d++)
    if (a[d] != b[d]) return a[d] < b[d] ? -1 : 1;
  return 0;
}

/* Mean of the corners of a facet along one axis, times 4 */
static inline PetscReal ContactFacetMiddle(const ContactFacet *f, int d)
{
  return (f->x[0][d] + f->x[2][d]) + (f->x[1][d] + f->x[3][d]);
}

/* surface.c - facets of a set on this rank, node[] being global numbers, without neighbours; the caller frees them */
PETSC_INTERN PetscErrorCode ContactFacetsLocal(Model model, const char set[], PetscInt *n, ContactFacet **facets);
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

/* foot.c - corners of a facet as it lies, m */
PETSC_INTERN void ContactCorners(const ContactShape *shape, PetscInt f, PetscReal x[4][3]);
/* foot.c - walks across edges to the facet that x faces, from foot->facet; facet -1 where the way leaves the live
   facets or the surface, or does not end */
PETSC_INTERN void ContactFootWalk(const ContactShape *shape, const PetscReal x[3], ContactFoot *foot);
/* foot.c - takes facet f where its point is nearer to x than the foot so far, and x not deeper below than `deepest`
   sizes of the facet */
PETSC_INTERN void ContactFootTry(const ContactShape *shape, PetscInt f, const PetscReal x[3], PetscReal deepest,
                                 ContactFoot *foot);
/* foot.c - weights and n, t, b at natural coordinates, t along a vector; returns the length of its part across n, 0
   where it has none and t is any tangent */
PETSC_INTERN PetscReal ContactBasis(const ContactFacet *facet, const PetscReal natural[2], const PetscReal along[3],
                                    PetscReal weight[4], PetscReal e[3][3]);
/* foot.c - n . (x - x_m) at rest, m */
PETSC_INTERN PetscReal ContactGap(const ContactFacet *facet, const PetscReal weight[4], const PetscReal n[3],
                                  const PetscReal x[3]);
/* foot.c - direction in which a slave at x slides on the master: with rotation its velocity (m/s), else the vector of
   the options, 0 where nothing says one */
PETSC_INTERN void ContactSlideAlong(const ContactInterface *c, const PetscReal x[3], PetscReal v[3]);
