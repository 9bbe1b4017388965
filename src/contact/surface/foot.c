/*
   The foot of a slave on a master surface: the point x(xi) with x - x(xi) parallel to the normal n(xi) of the surface
   at rest. On a facet that is two equations in the natural coordinates xi (-1..1 on quadrilaterals, 2 is a facet),

      (x - sum_i w_i(xi) x_i) x n(xi) = 0,     n = sum_i w_i a_i / |sum_i w_i a_i|

   solved by Newton's method in kernels/contact/drop.h. n is continuous across edges, so that the foot moves
   continuously when x does; the nearest point with the facet's own normal would jump at each edge.

   It walks from a facet across edges, until it lies within one; on an edge (to 1e-9 of a facet) it stays where it is.
   Between two facets that both have it beyond their common edge (a ridge) it faces the edge, on the facet of the
   lower number. Beyond the border of the surface it faces the border, up to ContactEdge().
*/
#include "contact/contactimpl.h"
#include "kernels/contact/drop.h"

/* natural coordinates: on an edge; above rounding of drop.h, far below a facet */
#define INSIDE 1e-9
/* facets of one walk; a slave moves by less than a facet between two calls */
#define STEPS 64

/* How far natural coordinates are beyond edges where the surface ends */
static PetscReal BeyondBorder(const ContactFacet *f, const PetscReal natural[2])
{
  const FacetShape *shape  = FacetShapeOf(f->n);
  PetscReal         beyond = -1;

  for (int e = 0; e < shape->n_corners; e++)
    if (f->beside[e] < 0) beyond = PetscMax(beyond, FacetBeyondEdge(shape, e, natural));
  return beyond;
}

/* The neighbour beyond whose edge the point is most, -1 where it is beyond none that has a neighbour. Of two edges
   alike, beyond a corner, that of the even number: rounding does not decide between them where meshes match. */
static PetscInt Neighbour(const ContactFacet *f, const PetscReal natural[2])
{
  const FacetShape *shape = FacetShapeOf(f->n);
  PetscReal         most  = INSIDE;
  PetscInt          next  = -1;

  for (int e = 0; e < shape->n_corners; e++) {
    const PetscReal beyond = FacetBeyondEdge(shape, e, natural);

    if (f->beside[e] < 0 || beyond < most || (beyond == most && e % 2)) continue;
    most = beyond;
    next = f->beside[e];
  }
  return next;
}

/* Foot on facet f, from the natural coordinates given */
static PetscBool Drop(const ContactShape *shape, PetscInt f, const PetscReal x[3], PetscReal natural[2])
{
  const ContactFacet *facet = &shape->surface->facet[f];
  PetscReal           node[CONTACT_MAX_MASTER][3];

  ContactNodes(shape, f, node);
  return FacetDrop(facet->n, (const double(*)[3])facet->x, facet->flat ? NULL : (const double(*)[3])facet->across,
                   (const double(*)[3])node, x, natural)
           ? PETSC_TRUE
           : PETSC_FALSE;
}

/* The middle of a facet, from where it is searched */
static void Middle(const ContactFacet *f, PetscReal natural[2])
{
  for (int d = 0; d < 2; d++) natural[d] = FacetShapeOf(f->n)->middle[d];
}

/* Ends a walk at its facet; a foot beyond the border by more than ContactEdge() allows is none. One a little beyond
   is moved onto the edge. */
static void WalkEnd(const ContactShape *shape, ContactFoot *foot)
{
  const ContactFacet *facet = &shape->surface->facet[foot->facet];

  foot->beyond = BeyondBorder(facet, foot->natural);
  if (foot->beyond > ContactEdge(shape->surface, facet)) foot->facet = -1;
  FacetClamp(facet->n, foot->natural);
}

/* From foot->facet, which must exist. On each facet the search begins at foot->natural, those given for the first and
   the middle for the others. A step back to the facet before is a ridge, and ends the walk. */
void ContactFootWalk(const ContactShape *shape, const PetscReal x[3], ContactFoot *foot)
{
  PetscInt before = -1;

  for (int step = 0; step < STEPS; step++) {
    const PetscInt f = foot->facet;
    PetscInt       next;

    if ((shape->live && !shape->live[f]) || !Drop(shape, f, x, foot->natural)) break;
    next = FacetBeyond(shape->surface->facet[f].n, foot->natural) > INSIDE
             ? Neighbour(&shape->surface->facet[f], foot->natural)
             : -1;
    if (next < 0 || (next == before && f < next)) {
      WalkEnd(shape, foot);
      return;
    }
    foot->facet = next;
    Middle(&shape->surface->facet[next], foot->natural);
    if (next == before) {
      if (!Drop(shape, next, x, foot->natural)) break;
      WalkEnd(shape, foot);
      return;
    }
    before = f;
  }
  foot->facet = -1;
}

/* n here is sum_i w_i a_i without its division: gap and length (both times |n|) are compared by their ratio. The gap
   is n . (x - point) / |n| in m, negative below the surface. */
void ContactFootTry(const ContactShape *shape, PetscInt f, const PetscReal x[3], PetscReal deepest, ContactFoot *foot)
{
  const ContactFacet *facet = &shape->surface->facet[f];
  PetscReal   node[CONTACT_MAX_MASTER][3], weight[CONTACT_MAX_MASTER], n[3], point[3], gap = 0, square = 0, length = 0;
  ContactFoot here = {.facet = f};

  Middle(facet, here.natural);
  if (!Drop(shape, f, x, here.natural)) return;
  here.beyond = BeyondBorder(facet, here.natural);
  FacetClamp(facet->n, here.natural);
  ContactNodes(shape, f, node);
  FacetWeights(facet->n, here.natural, weight);
  FacetSum(facet->n, weight, (const double(*)[3])facet->across, n);
  FacetSum(facet->n, weight, (const double(*)[3])node, point);
  for (int d = 0; d < 3; d++) {
    const PetscReal apart = x[d] - point[d];

    gap += n[d] * apart;
    square += apart * apart;
    length += n[d] * n[d];
  }
  here.distance = PetscSqrtReal(square);
  if (gap >= -deepest * facet->size * PetscSqrtReal(length) && here.distance < foot->distance) *foot = here;
}

/* Distance along the surface, across its normal, from a foot on the border, m: sqrt(distance^2 - gap^2), which
   rounding may make negative; 0 for a foot within */
static PetscReal FootAcross(const ContactSurface *surface, const ContactFoot *foot, const PetscReal x[3])
{
  const ContactFacet *f       = &surface->facet[foot->facet];
  const PetscReal     none[3] = {0, 0, 0};
  PetscReal           weight[CONTACT_MAX_MASTER], e[3][3], gap;

  if (BeyondBorder(f, foot->natural) < -INSIDE) return 0;
  (void)ContactBasis(f, foot->natural, none, weight, e);
  gap = ContactGap(f, weight, e[0], x);
  return PetscSqrtReal(PetscMax(0, PetscSqr(foot->distance) - PetscSqr(gap)));
}

/* The walk starts at the nearest point, so that of several parts of a surface that all face x the nearest is taken.
   snap() moves natural coordinates that differ from a node's or side's by rounding onto it: matching meshes get
   weights that are exactly 0 and 1. */
void ContactFootFind(const ContactSurface *surface, const PetscReal x[3], ContactFoot *foot)
{
  const ContactShape rest = {.surface = surface};
  ContactFoot        walk;

  ContactFootNearest(surface, x, foot);
  if (foot->facet < 0) return;
  walk = *foot;
  ContactFootWalk(&rest, x, &walk);
  if (walk.facet < 0 || walk.beyond > 0) foot->across = FootAcross(surface, foot, x);
  if (walk.facet < 0) return;
  foot->facet = walk.facet;
  for (int i = 0; i < 2; i++) foot->natural[i] = walk.natural[i];
  FacetShapeOf(surface->facet[foot->facet].n)->snap(foot->natural);
}

/* Unit vector across n and the axis that is most nearly across it: of the least |n_d|, below 1 / sqrt(3), so that the
   division is never by a small number */
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

/* t along a vector v less its part along n, b = n x t; returns |v - n (n . v)| in the unit of v. Where that is below
   1e-6 |v| (squares: 1e-12) it is what rounding leaves of v along n: t is any tangent then, and 0 is returned. */
PetscReal ContactTangents(const PetscReal along[3], PetscReal e[3][3])
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

PetscReal ContactBasis(const ContactFacet *f, const PetscReal natural[2], const PetscReal along[3], PetscReal weight[],
                       PetscReal e[3][3])
{
  FacetWeights(f->n, natural, weight);
  for (int d = 0; d < 3; d++) e[0][d] = f->normal[d];
  if (!f->flat) {
    PetscReal inverse;

    FacetSum(f->n, weight, (const double(*)[3])f->across, e[0]);
    inverse = 1 / PetscSqrtReal(PetscSqr(e[0][0]) + PetscSqr(e[0][1]) + PetscSqr(e[0][2]));
    for (int d = 0; d < 3; d++) e[0][d] *= inverse;
  }
  return ContactTangents(along, e);
}

/* n . (x - x_0 - sum_{i>0} w_i (x_i - x_0)): differences of places first, so that a gap of 1e-9 m at places of 1 m
   keeps its figures, and two nodes in one place have exactly 0 */
PetscReal ContactGap(const ContactFacet *f, const PetscReal w[], const PetscReal n[3], const PetscReal x[3])
{
  PetscReal gap = 0;

  for (int j = 0; j < 3; j++) {
    PetscReal along = x[j] - f->x[0][j];

    for (int i = 1; i < 3; i++) along -= w[i] * (f->x[i][j] - f->x[0][j]);
    for (int i = 3; i < f->n; i++) along -= w[i] * (f->x[i][j] - f->x[0][j]);
    gap += n[j] * along;
  }
  return gap;
}

/* -w x (x - c): the rotation w (rad/s) is of the master, and v is of the slave relative to it */
void ContactSlideAlong(const ContactInterface *c, const PetscReal x[3], PetscReal v[3])
{
  const PetscReal *w = c->rotation;

  for (int d = 0; d < 3; d++) v[d] = c->slip[d];
  if (w[0] == 0 && w[1] == 0 && w[2] == 0) return;
  for (int d = 0; d < 3; d++) {
    const int e = (d + 1) % 3, f = (d + 2) % 3;

    v[d] = -(w[e] * (x[f] - c->centre[f]) - w[f] * (x[e] - c->centre[e]));
  }
}
