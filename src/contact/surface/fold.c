/*
   Folds of a master. The normal of a pair is a mean over the facets around the nodes under it (surface.h). On a smooth
   surface it leans from the facet's own normal by half the angle between facets at most; at a fold, an edge of a body
   in the set, it points half way round the edge, and the pair with it. Pairs
   of mortar contact do not (mortar/split.c). A pair's lean is

      cos(lean) = n . m,   m = sum_i w_i m_i / |sum_i w_i m_i|

   with the unit normals m_i of the facet itself at its nodes and the weights w_i of its foot.
*/
#include "contact/contactimpl.h"
#include "base/algebra/vec3.h"

/* cosine of 20 degrees less rounding: a regular polygon of nine sides is no fold */
#define FOLD_COSINE (0.93969262078590838 - 1e-6)

/* cos(lean) */
static PetscReal PairLean(const ContactFacet *facet, const ContactPair *pair, const ContactPairFoot *foot)
{
  const FacetShape *shape   = FacetShapeOf(facet->n);
  PetscReal         mean[3] = {0, 0, 0};

  for (int i = 0; i < facet->n; i++) {
    PetscReal own[3];

    FacetNormal(facet->n, (const double(*)[3])facet->x, shape->node[i], own);
    (void)Vec3Normalise(own);
    for (int d = 0; d < 3; d++) mean[d] += foot->weight[i] * own[d];
  }
  (void)Vec3Normalise(mean);
  return Vec3Dot(mean, pair->n);
}

/* Of pairs of nodes and points: warns of slave nodes at folds that press on the master with two sides, by one pair */
static PetscErrorCode SlaveFoldWarn(Contact contact, PetscInt interface)
{
  const ContactInterface *c = &contact->interfaces[interface];
  PetscInt                n;

  PetscFunctionBeginUser;
  PetscCall(ContactFoldCount(contact, interface, &n));
  if (!n) PetscFunctionReturn(0);
  PetscCall(PetscFPrintf(contact->comm, stderr,
                         "squeal: warning: contact %s: %" PetscInt_FMT " of the nodes of %s lie at its folds and touch "
                         "%s on two sides, with one pair each, so that pressures beside them are off; give "
                         "-%s_discretization mortar\n",
                         c->name, n, c->slave, c->master, c->name));
  PetscFunctionReturn(0);
}

PetscErrorCode ContactFoldWarn(Contact contact, PetscInt interface)
{
  const ContactInterface *c = &contact->interfaces[interface];
  const ContactSurface   *surface;
  PetscInt                n[2] = {0, 0}; /* that lean, of all */

  PetscFunctionBeginUser;
  if (!contact->mortar[interface]) PetscCall(SlaveFoldWarn(contact, interface));
  PetscCall(ContactGetSurface(contact, interface, &surface));
  for (PetscInt p = 0; p < contact->n_pairs; p++) {
    const ContactPair     *pair = &contact->pairs[p];
    const ContactPairFoot *foot = &contact->feet[p];

    if (pair->interface != interface) continue;
    n[0] += PairLean(&surface->facet[foot->facet], pair, foot) < FOLD_COSINE ? 1 : 0;
    n[1]++;
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, n, 2, MPIU_INT, MPI_SUM, contact->comm));
  if (!n[0]) PetscFunctionReturn(0);
  PetscCall(PetscFPrintf(contact->comm, stderr,
                         "squeal: warning: contact %s: the normals of %" PetscInt_FMT " of %" PetscInt_FMT
                         " pairs lean by more than 20 degrees from the faces of %s, whose normals are means over a "
                         "fold there; give as master a set that ends at the fold\n",
                         c->name, n[0], n[1], c->master));
  PetscFunctionReturn(0);
}
