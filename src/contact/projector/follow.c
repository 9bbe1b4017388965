/*
   A slave on its way over the master: the facet that it faces, by perpendiculars along the normals of the undeformed
   facets.

   It walks from the facet where it was before across edges, until it lies within one; on an edge (to 1e-9 of a facet)
   it stays where it is. Between two facets that both have it beyond their common edge (a ridge) it faces the edge, on
   the facet of the lower number. Where the walk fails, all candidates of the last search are tried, and the nearest
   point of all is taken. Released: beyond the border of the surface by more than EDGE in natural coordinates (2 is a
   facet); up to there it faces the border. A node that was released is taken up again where it is above the surface, or
   at most DEEPEST sizes of a facet below; one that comes from the side deeper than that is left alone until it has come
   up, since making the gap good in one step would throw it out.
*/
#include "projectorimpl.h"
#include "kernels/drop.h"

#define INSIDE 1e-9 /* natural coordinates: on an edge */
#define EDGE   0.02 /* beyond the border of the surface */
#define STEPS  64   /* facets of one walk */

/* Corners at displacements u */
static void FacetPlace(const MasterFacet *f, const PetscReal u[], PetscReal x[4][3])
{
  for (int i = 0; i < 4; i++)
    for (int d = 0; d < 3; d++) x[i][d] = f->x[i][d] + u[3 * f->node[i] + d];
}

/* How far natural coordinates are beyond the facet, and the edge where that is most */
static PetscReal Beyond(const PetscReal natural[2], PetscInt *edge)
{
  const PetscReal x = PetscAbsReal(natural[0]), y = PetscAbsReal(natural[1]);

  *edge = x > y ? (natural[0] > 0 ? 1 : 3) : natural[1] > 0 ? 2 : 0;
  return PetscMax(x, y) - 1;
}

static void Clamp(PetscReal natural[2])
{
  for (int d = 0; d < 2; d++) natural[d] = PetscMax(-1, PetscMin(1, natural[d]));
}

/* How far natural coordinates are beyond edges where the surface ends */
static PetscReal BeyondBorder(const MasterFacet *f, const PetscReal natural[2])
{
  PetscReal beyond = -1;

  if (natural[0] > 0 ? f->beside[1] < 0 : f->beside[3] < 0) beyond = PetscAbsReal(natural[0]) - 1;
  if (natural[1] > 0 ? f->beside[2] < 0 : f->beside[0] < 0) beyond = PetscMax(beyond, PetscAbsReal(natural[1]) - 1);
  return beyond;
}

/* The neighbour beyond whose edge the point is most, -1 where it is beyond none that has a neighbour */
static PetscInt Neighbour(const MasterFacet *f, const PetscReal natural[2])
{
  const PetscInt  ex = natural[0] > 0 ? 1 : 3, ey = natural[1] > 0 ? 2 : 0;
  const PetscReal x = f->beside[ex] < 0 ? 0 : PetscAbsReal(natural[0]),
                  y = f->beside[ey] < 0 ? 0 : PetscAbsReal(natural[1]);

  if (PetscMax(x, y) <= 1 + INSIDE) return -1;
  return x > y ? f->beside[ex] : f->beside[ey];
}

/* Perpendicular on facet f */
static PetscBool Drop(const Surface *s, PetscInt f, const PetscReal x[3], const PetscReal u[], PetscReal natural[2])
{
  PetscReal corner[4][3];

  FacetPlace(&s->facet[f], u, corner);
  return FacetDrop((const double(*)[3])s->facet[f].x, (const double(*)[3])corner, x, natural) ? PETSC_TRUE
                                                                                              : PETSC_FALSE;
}

/* Ends a walk at facet f, at its edge where the point is a little beyond; -1 where it has left the surface */
static PetscInt WalkEnd(const Surface *s, PetscInt f, PetscReal natural[2])
{
  if (BeyondBorder(&s->facet[f], natural) > EDGE) return -1;
  Clamp(natural);
  return f;
}

/* Walks from facet f; -1 where the way leaves the live facets, the surface, or does not end */
static PetscInt Walk(const Surface *s, PetscInt f, const PetscReal x[3], const PetscReal u[], PetscReal natural[2])
{
  PetscInt before = -1;

  for (int step = 0; step < STEPS; step++) {
    PetscInt edge, next;

    if (!s->live[f] || !Drop(s, f, x, u, natural)) return -1;
    if (Beyond(natural, &edge) <= INSIDE) return WalkEnd(s, f, natural);
    next = Neighbour(&s->facet[f], natural);
    if (next < 0 || (next == before && f < next)) return WalkEnd(s, f, natural);
    if (next == before) {
      natural[0] = natural[1] = 0;
      (void)Drop(s, next, x, u, natural);
      return WalkEnd(s, next, natural);
    }
    before     = f;
    f          = next;
    natural[0] = natural[1] = 0;
  }
  return -1;
}

/* Gap and distance of x to the point of facet f at natural coordinates within it */
static void FacetDistance(const Surface *s, PetscInt f, const PetscReal x[3], const PetscReal u[],
                          const PetscReal natural[2], PetscReal *gap, PetscReal *distance)
{
  PetscReal corner[4][3], point[3], a[3], b[3], n[3], dot = 0, square = 0, length = 0;

  FacetPlace(&s->facet[f], u, corner);
  FacetTangents((const double(*)[3])corner, natural[0], natural[1], point, a, b);
  FacetNormal((const double(*)[3])s->facet[f].x, natural[0], natural[1], n);
  for (int d = 0; d < 3; d++) {
    dot += n[d] * (x[d] - point[d]);
    square += PetscSqr(x[d] - point[d]);
    length += n[d] * n[d];
  }
  *gap      = dot / PetscSqrtReal(length);
  *distance = PetscSqrtReal(square);
}

/* Nearest point among the candidates that x is not too deep below; -1 where it is beyond the border */
static PetscInt Nearest(const Surface *s, PetscInt n, const PetscInt candidate[], const PetscReal x[3],
                        const PetscReal u[], PetscReal deepest, PetscReal natural[2])
{
  PetscReal best = PETSC_MAX_REAL, beyond = 0;
  PetscInt  found = -1;

  for (PetscInt c = 0; c < n; c++) {
    const PetscInt f     = candidate[c];
    PetscReal      at[2] = {0, 0}, gap, distance, border;

    if (!Drop(s, f, x, u, at)) continue;
    border = BeyondBorder(&s->facet[f], at);
    Clamp(at);
    FacetDistance(s, f, x, u, at, &gap, &distance);
    if (gap < -deepest * s->facet[f].size || distance >= best) continue;
    best       = distance;
    beyond     = border;
    found      = f;
    natural[0] = at[0];
    natural[1] = at[1];
  }
  return beyond > EDGE ? -1 : found;
}

void PairFollow(ContactProjector p, PetscInt k, const PetscReal d[3], const PetscReal u[], PetscReal deepest)
{
  Pair            *pair = &p->pair[k];
  const Surface   *s    = &p->surface[pair->interface];
  const PetscReal *X    = &p->nodes.x[3 * pair->slave];
  const PetscReal  x[3] = {X[0] + d[0], X[1] + d[1], X[2] + d[2]};
  const PetscInt   c    = p->first_candidate[k];

  if (pair->facet >= 0) {
    pair->facet = Walk(s, pair->facet, x, u, pair->natural);
    if (pair->facet >= 0) return;
    deepest = PETSC_MAX_REAL; /* it was above: what is below now has been pressed there */
  }
  pair->facet = Nearest(s, p->first_candidate[k + 1] - c, &p->candidate[c], x, u, deepest, pair->natural);
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

/* Tangents: t along the slip, b = n x t; returns the length of the slip in the tangent plane */
static PetscReal TangentsSet(const PetscReal along[3], PetscReal e[3][3])
{
  const PetscReal dot  = along[0] * e[0][0] + along[1] * e[0][1] + along[2] * e[0][2];
  PetscReal       full = 0, square = 0, length;

  for (int d = 0; d < 3; d++) {
    e[1][d] = along[d] - dot * e[0][d];
    full += along[d] * along[d];
    square += e[1][d] * e[1][d];
  }
  length = PetscSqrtReal(square);
  if (square > 1e-12 * full) {
    for (int d = 0; d < 3; d++) e[1][d] *= 1 / length;
  } else {
    AnyTangent(e[0], e[1]);
  }
  for (int d = 0; d < 3; d++) e[2][d] = e[0][(d + 1) % 3] * e[1][(d + 2) % 3] - e[0][(d + 2) % 3] * e[1][(d + 1) % 3];
  return length;
}

/* Unit normal at natural coordinates */
static void NormalSet(const MasterFacet *f, const PetscReal natural[2], PetscReal n[3])
{
  PetscReal inverse;

  for (int d = 0; d < 3; d++) n[d] = f->normal[d];
  if (f->flat) return;
  FacetNormal((const double(*)[3])f->x, natural[0], natural[1], n);
  inverse = 1 / PetscSqrtReal(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
  for (int d = 0; d < 3; d++) n[d] *= inverse;
}

PetscReal PairSetBasis(const Surface *s, Pair *pair)
{
  const MasterFacet *f = &s->facet[pair->facet];

  FacetWeights(pair->natural[0], pair->natural[1], pair->weight);
  NormalSet(f, pair->natural, pair->e[0]);
  for (int i = 0; i < 4; i++) pair->node[i] = f->node[i];
  return TangentsSet(pair->along, pair->e);
}

PetscReal PairGap(const Surface *s, const Pair *pair, const PetscReal x[3], const PetscReal d[3], const PetscReal u[])
{
  const MasterFacet *f = &s->facet[pair->facet];
  const PetscReal   *w = pair->weight, *u0 = &u[3 * f->node[0]], *u1 = &u[3 * f->node[1]], *u2 = &u[3 * f->node[2]],
                  *u3 = &u[3 * f->node[3]];
  PetscReal gap       = 0;

  for (int j = 0; j < 3; j++) {
    const PetscReal place = (x[j] - f->x[0][j]) - w[1] * (f->x[1][j] - f->x[0][j]) - w[2] * (f->x[2][j] - f->x[0][j]) -
                            w[3] * (f->x[3][j] - f->x[0][j]);
    const PetscReal moved = (d[j] - u0[j]) - w[1] * (u1[j] - u0[j]) - w[2] * (u2[j] - u0[j]) - w[3] * (u3[j] - u0[j]);

    gap += pair->e[0][j] * (place + moved);
  }
  return gap;
}
