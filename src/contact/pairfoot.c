/* A pair at the foot of its slave node: weights, directions, speed and gap */
#include "contactimpl.h"

/* Weights, directions, speed (m/s) and gap (m). Along a rotation the speed is |w x (x - c)| in the tangent plane, which
   differs from pair to pair; a direction that is given has the speed of the options everywhere. across = |sum_i w_i
   a_i| (m^2, or without unit on facets of second order) is the divisor of the tilt (surface/tilt.c). A gap below 1e-9
   of the facet's size is rounding of the coordinates, and 0. */
static void PairSetFoot(const ContactInterface *c, const ContactFacet *facet, const ContactFoot *foot,
                        ContactPair *pair, ContactPairFoot *at)
{
  PetscReal along[3], e[3][3], a[3] = {0, 0, 0}, speed;

  ContactSlideAlong(c, pair->x, along);
  at->facet = foot->facet;
  speed     = ContactBasis(facet, foot->natural, along, at->weight, e);
  for (int i = 0; i < facet->n; i++)
    for (int d = 0; d < 3 && at->weight[i] != 0; d++) a[d] += at->weight[i] * facet->across[i][d];
  for (int d = 0; d < 3; d++) {
    pair->n[d] = e[0][d];
    pair->t[d] = e[1][d];
    pair->b[d] = e[2][d];
  }
  pair->speed = Vec3Dot(c->rotation, c->rotation) > 0 ? speed : speed > 0 ? c->speed : 0;
  at->slides  = speed > 0 ? PETSC_TRUE : PETSC_FALSE;
  at->across  = Vec3Length(a);
  pair->gap   = ContactGap(facet, at->weight, e[0], pair->x);
  if (PetscAbsReal(pair->gap) < 1e-9 * facet->size) pair->gap = 0;
}

void ContactPairTakeFoot(const ContactInterface *c, const ContactSurface *surface, const ContactFoot *foot,
                         ContactPair *pair, ContactPairFoot *at)
{
  at->facet    = foot->facet;
  at->distance = foot->distance;
  at->beyond   = foot->across;
  if (foot->facet >= 0) PairSetFoot(c, &surface->facet[foot->facet], foot, pair, at);
}
