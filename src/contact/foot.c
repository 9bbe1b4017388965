/*
   The foot of a slave on a master surface: the point x(xi) with x - x(xi) parallel to the normal n(xi) of the surface
   at rest.

   It walks from a facet across edges, until it lies within one; on an edge (to 1e-9 of a facet) it stays where it is.
   Between two facets that both have it beyond their common edge (a ridge) it faces the edge, on the facet of the lower
   number. Beyond the border of the surface it faces the border, up to CONTACT_EDGE.
*/
#include "contactimpl.h"
#include "kernels/drop.h"

#define INSIDE 1e-9 /* natural coordinates: on an edge */
#define STEPS  64   /* facets of one walk */

void ContactCorners(const ContactShape *shape, PetscInt f, PetscReal x[4][3])
{
  const ContactFacet *facet = &shape->surface->facet[f];

  for (int i = 0; i < 4; i++)
    for (int d = 0; d < 3; d++)
      x[i][d] = facet->x[i][d] + (shape->node ? shape->u[3 * shape->node[facet->node[i]] + d] : 0);
}

/* How far natural coordinates are beyond the facet */
static PetscReal Beyond(const PetscReal natural[2])
{
  return PetscMax(PetscAbsReal(natural[0]), PetscAbsReal(natural[1])) - 1;
}

static void Clamp(PetscReal natural[2])
{
  for (int d = 0; d < 2; d++) natural[d] = PetscMax(-1, PetscMin(1, natural[d]));
}

/* How far natural coordinates are beyond edges where the surface ends */
static PetscReal BeyondBorder(const ContactFacet *f, const PetscReal natural[2])
{
  PetscReal beyond = -1;

  if (natural[0] > 0 ? f->beside[1] < 0 : f->beside[3] < 0) beyond = PetscAbsReal(natural[0]) - 1;
  if (natural[1] > 0 ? f->beside[2] < 0 : f->beside[0] < 0) beyond = PetscMax(beyond, PetscAbsReal(natural[1]) - 1);
  return beyond;
}

/* The neighbour beyond whose edge the point is most, -1 where it is beyond none that has a neighbour */
static PetscInt Neighbour(const ContactFacet *f, const PetscReal natural[2])
{
  const PetscInt  ex = natural[0] > 0 ? 1 : 3, ey = natural[1] > 0 ? 2 : 0;
  const PetscReal x = f->beside[ex] < 0 ? 0 : PetscAbsReal(natural[0]),
                  y = f->beside[ey] < 0 ? 0 : PetscAbsReal(natural[1]);

  if (PetscMax(x, y) <= 1 + INSIDE) return -1;
  return x > y ? f->beside[ex] : f->beside[ey];
}

/* Foot on the plane of facet f, from the natural coordinates given */
static PetscBool Drop(const ContactShape *shape, PetscInt f, const PetscReal x[3], PetscReal natural[2])
{
  const ContactFacet *facet = &shape->surface->facet[f];
  PetscReal           corner[4][3];

  ContactCorners(shape, f, corner);
  return FacetDrop((const double(*)[3])facet->x, facet->flat ? NULL : (const double(*)[3])facet->area,
                   (const double(*)[3])corner, x, natural)
           ? PETSC_TRUE
           : PETSC_FALSE;
}

/* Ends a walk at its facet, at the edge where the point is a little beyond */
static void WalkEnd(const ContactShape *shape, ContactFoot *foot)
{
  foot->beyond = BeyondBorder(&shape->surface->facet[foot->facet], foot->natural);
  if (foot->beyond > CONTACT_EDGE) foot->facet = -1;
  Clamp(foot->natural);
}

void ContactFootWalk(const ContactShape *shape, const PetscReal x[3], ContactFoot *foot)
{
  PetscInt before = -1;

  for (int step = 0; step < STEPS; step++) {
    const PetscInt f = foot->facet;
    PetscInt       next;

    if ((shape->live && !shape->live[f]) || !Drop(shape, f, x, foot->natural)) break;
    next = Beyond(foot->natural) > INSIDE ? Neighbour(&shape->surface->facet[f], foot->natural) : -1;
    if (next < 0 || (next == before && f < next)) {
      WalkEnd(shape, foot);
      return;
    }
    foot->facet      = next;
    foot->natural[0] = foot->natural[1] = 0;
    if (next == before) {
      if (!Drop(shape, next, x, foot->natural)) break;
      WalkEnd(shape, foot);
      return;
    }
    before = f;
  }
  foot->facet = -1;
}

/* Normal at natural coordinates, of any length */
static void NormalSet(const ContactFacet *f, const PetscReal weight[4], PetscReal n[3])
{
  for (int d = 0; d < 3; d++)
    n[d] =
      weight[0] * f->area[0][d] + weight[1] * f->area[1][d] + weight[2] * f->area[2][d] + weight[3] * f->area[3][d];
}

void ContactFootTry(const ContactShape *shape, PetscInt f, const PetscReal x[3], PetscReal deepest, ContactFoot *foot)
{
  const ContactFacet *facet = &shape->surface->facet[f];
  PetscReal           corner[4][3], weight[4], n[3], gap = 0, square = 0, length = 0;
  ContactFoot         here = {.facet = f};

  if (!Drop(shape, f, x, here.natural)) return;
  here.beyond = BeyondBorder(facet, here.natural);
  Clamp(here.natural);
  ContactCorners(shape, f, corner);
  FacetWeights(here.natural[0], here.natural[1], weight);
  NormalSet(facet, weight, n);
  for (int d = 0; d < 3; d++) {
    const PetscReal apart = x[d] - (weight[0] * corner[0][d] + weight[1] * corner[1][d] + weight[2] * corner[2][d] +
                                    weight[3] * corner[3][d]);

    gap += n[d] * apart;
    square += apart * apart;
    length += n[d] * n[d];
  }
  here.distance = PetscSqrtReal(square);
  if (gap >= -deepest * facet->size * PetscSqrtReal(length) && here.distance < foot->distance) *foot = here;
}

/* Unit vector across n and the axis that is most nearly across it */
static void AnyTangent(const PetscReal n[3], PetscReal t[3])
{
  PetscReal length;
  int       least = 0;

  for (int d = 1; d < 3; d++)
    if (PetscAbsReal(n[d]) < PetscAbsReal(n[least])) least = d;
  length             = PetscSqrtReal(1 - n[least] * n[least]);
  t[least]           = 0;
  t[(least + 1) % 3] = n[(least + 2) % 3] / length;
  t[(least + 2) % 3] = -n[(least + 1) % 3] / length;
}

/* t along a vector, b = n x t; returns the length of the part of the vector across n, 0 where it is none */
static PetscReal TangentsSet(const PetscReal along[3], PetscReal e[3][3])
{
  const PetscReal dot  = along[0] * e[0][0] + along[1] * e[0][1] + along[2] * e[0][2];
  PetscReal       full = 0, square = 0, length = 0;

  for (int d = 0; d < 3; d++) {
    e[1][d] = along[d] - dot * e[0][d];
    full += along[d] * along[d];
    square += e[1][d] * e[1][d];
  }
  if (square > 1e-12 * full) {
    length = PetscSqrtReal(square);
    for (int d = 0; d < 3; d++) e[1][d] *= 1 / length;
  } else {
    AnyTangent(e[0], e[1]);
  }
  for (int d = 0; d < 3; d++) e[2][d] = e[0][(d + 1) % 3] * e[1][(d + 2) % 3] - e[0][(d + 2) % 3] * e[1][(d + 1) % 3];
  return length;
}

PetscReal ContactBasis(const ContactFacet *f, const PetscReal natural[2], const PetscReal along[3], PetscReal weight[4],
                       PetscReal e[3][3])
{
  FacetWeights(natural[0], natural[1], weight);
  for (int d = 0; d < 3; d++) e[0][d] = f->normal[d];
  if (!f->flat) {
    PetscReal inverse;

    NormalSet(f, weight, e[0]);
    inverse = 1 / PetscSqrtReal(PetscSqr(e[0][0]) + PetscSqr(e[0][1]) + PetscSqr(e[0][2]));
    for (int d = 0; d < 3; d++) e[0][d] *= inverse;
  }
  return TangentsSet(along, e);
}

PetscReal ContactGap(const ContactFacet *f, const PetscReal w[4], const PetscReal n[3], const PetscReal x[3])
{
  PetscReal gap = 0;

  for (int j = 0; j < 3; j++)
    gap += n[j] * ((x[j] - f->x[0][j]) - w[1] * (f->x[1][j] - f->x[0][j]) - w[2] * (f->x[2][j] - f->x[0][j]) -
                   w[3] * (f->x[3][j] - f->x[0][j]));
  return gap;
}

void ContactSlideAlong(const ContactInterface *c, const PetscReal x[3], PetscReal v[3])
{
  const PetscReal *w = c->rotation;

  for (int d = 0; d < 3; d++) v[d] = c->slip[d];
  if (w[0] == 0 && w[1] == 0 && w[2] == 0) return;
  for (int d = 0; d < 3; d++) {
    const int e = (d + 1) % 3, f = (d + 2) % 3;

    v[d] = -(w[e] * (x[f] - c->center[f]) - w[f] * (x[e] - c->center[e]));
  }
}
