/*
   Nodes of a disc at one place (s, theta), s the radius, of a drum the place along the axis: the fit of fit.c sees them
   as one. Meshes that are swept through the thickness have a few at each place.
*/
#include "disc.h"
#include "base/algebra/vec3.h"
#include <math.h>
#include <stdlib.h>

#define PLACE_ALIKE 1e-7 /* of the outer radius, and rad: nodes closer than that are at one place */

/* A node, in steps of PLACE_ALIKE; two on both sides of a step stay apart, which costs a row */
typedef struct {
  PetscInt64 s, theta;
  PetscInt   node;
} DiscPlaceKey;

void DiscPolar(const Disc *disc, const PetscReal x[3], PetscReal *r, PetscReal *theta)
{
  const PetscReal d[3] = {x[0] - disc->centre[0], x[1] - disc->centre[1], x[2] - disc->centre[2]};
  const PetscReal a = Vec3Dot(d, disc->e1), b = Vec3Dot(d, disc->e2);

  *r     = PetscSqrtReal(a * a + b * b);
  *theta = atan2(b, a);
}

PetscReal DiscAlong(const Disc *disc, const PetscReal x[3])
{
  return Vec3Dot(x, disc->axis) - Vec3Dot(disc->centre, disc->axis);
}

void DiscPlace(const Disc *disc, const PetscReal x[3], PetscReal *s, PetscReal *theta)
{
  DiscPolar(disc, x, s, theta);
  if (disc->is_drum) *s = DiscAlong(disc, x);
}

static int DiscPlaceCompare(const void *first, const void *second)
{
  const DiscPlaceKey *a = first, *b = second;

  if (a->s != b->s) return a->s < b->s ? -1 : 1;
  if (a->theta != b->theta) return a->theta < b->theta ? -1 : 1;
  return (a->node > b->node) - (a->node < b->node);
}

PetscErrorCode DiscFindPlaces(Disc *disc, const PetscReal x[])
{
  DiscPlaceKey *key;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(disc->n_nodes, &key));
  PetscCall(PetscMalloc1(disc->n_nodes, &disc->place));
  for (PetscInt i = 0; i < disc->n_nodes; i++) {
    PetscReal s, theta;

    DiscPlace(disc, &x[3 * disc->node[i]], &s, &theta);
    key[i] = (DiscPlaceKey){llround(s / (PLACE_ALIKE * disc->r_outer)), llround(theta / PLACE_ALIKE), i};
  }
  if (disc->n_nodes) qsort(key, (size_t)disc->n_nodes, sizeof(*key), DiscPlaceCompare);
  disc->n_places = 0;
  for (PetscInt i = 0; i < disc->n_nodes; i++) {
    if (!i || key[i].s != key[i - 1].s || key[i].theta != key[i - 1].theta) disc->n_places++;
    disc->place[key[i].node] = disc->n_places - 1;
  }
  PetscCall(PetscFree(key));
  PetscFunctionReturn(0);
}
