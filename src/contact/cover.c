/*
   Area of a slave node where its faces lie partly over the master, beside a hole, a slot or the rim. A face f of area
   A_f, with positive shares s_fv of its nodes (kernels/contact/facet.h), sum_v s_fv = A_f, of which the part c_f lies
   over the master, gives it to those of its nodes that have a pair, P_f:

      a_v = sum_f  s_fv c_f A_f / sum_{u in P_f} s_fu

   so that sum_v a_v = sum_f c_f A_f is the area in contact, and k sum_v a_v the stiffness of a contact per area k. c_f
   is the sum of the areas in which f and the facets of the master lie over each other along the normal of f
   (kernels/contact/overlap.h), over that of f. Faces with pairs at all nodes, of which less than 1 % hangs over (as
   chords of one circle differ), count in full, and so do they where -X_overhang is given, since then nodes beyond the
   border press on it. A face without pairs gives nothing.
*/
#include "contactimpl.h"
#include "base/algebra/vec3.h"
#include "kernels/contact/overlap.h"

/* a face of which more lies over the master counts in full: chords of one circle by different meshes differ by less */
#define COVERED 0.99
/* of the area of all its faces: a node with less has rounding of the overlap, and no pair */
#define BARE 1e-9

/* The master, its facets near a face, and the area over it that no pair gets, m^2 */
typedef struct {
  const ContactInterface *c;
  const ContactSurface   *surface;
  ContactFacetList        near;
  PetscReal               lost;
} Cover;

PetscBool ContactFacetFaces(const ContactFacet *g, const double e[3][3], const double origin[3], PetscReal size,
                            PetscReal tolerance)
{
  PetscReal away[3];

  for (int d = 0; d < 3; d++) away[d] = ContactFacetMiddle(g, d) / 4 - origin[d];
  return Vec3Dot(g->normal, e[2]) < 0 && PetscAbsReal(Vec3Dot(away, e[2])) <= tolerance + (size + g->size) / 2
           ? PETSC_TRUE
           : PETSC_FALSE;
}

/* c_f of a face */
static PetscErrorCode FaceCover(Cover *k, int n, const double x[][3], PetscReal *part)
{
  const ContactShape rest     = {.surface = k->surface};
  PetscBool          border   = PETSC_FALSE;
  PetscInt           n_facing = 0;
  PetscReal          area = 0, size = 0;
  double             e[3][3], origin[3];
  FacetFan           f, g;

  PetscFunctionBeginUser;
  FanAxes(n, x, e, origin);
  FanMake(n, x, (const double(*)[3])e, origin, &f);
  for (int i = 0; i < n; i++) {
    const PetscReal away[3] = {x[i][0] - origin[0], x[i][1] - origin[1], x[i][2] - origin[2]};

    size = PetscMax(size, Vec3Length(away));
  }
  k->near.n = 0;
  PetscCall(ContactFacetsNear(&rest, k->surface->box, origin, size + k->c->tolerance, &k->near));
  for (PetscInt i = 0; i < k->near.n; i++) {
    const ContactFacet *facet = &k->surface->facet[k->near.facet[i]];

    if (!ContactFacetFaces(facet, (const double(*)[3])e, origin, 2 * size, k->c->tolerance)) continue;
    n_facing++;
    for (int b = 0; b < ContactFacetCorners(facet); b++)
      if (facet->beside[b] < 0) border = PETSC_TRUE;
    FanMake(facet->n, (const double(*)[3])facet->x, (const double(*)[3])e, origin, &g);
    area += FanOverlap(&f, &g);
  }
  *part = border || !n_facing ? PetscMin(1, area / FanArea(&f)) : 1;
  PetscFunctionReturn(0);
}

/* Adds what a face gives its nodes to sum[v][3]: the area, and 1 where it is not all of their shares; has[v][3] tells
   pairs */
static PetscErrorCode FaceGive(Cover *k, int n, const PetscInt node[], const double x[][3], const PetscScalar has[],
                               PetscScalar sum[])
{
  double    share[FACET_NODES];
  PetscReal part, area = 0, paired = 0, gives;
  PetscBool all = PETSC_TRUE;

  PetscFunctionBeginUser;
  FacetPositiveAreas(n, x, share);
  for (int i = 0; i < n; i++) {
    area += share[i];
    if (PetscRealPart(has[3 * node[i]]) > 0)
      paired += share[i];
    else
      all = PETSC_FALSE;
  }
  if (all && k->c->overhang > 0)
    part = 1;
  else
    PetscCall(FaceCover(k, n, x, &part));
  if (all && part > COVERED) part = 1;
  if (paired <= 0) k->lost += part * area;
  gives = paired > 0 ? part * area / paired : 0;
  for (int i = 0; i < n; i++) {
    if (PetscRealPart(has[3 * node[i]]) <= 0) continue;
    sum[3 * node[i]] += gives * share[i];
    if (!all || part < 1) sum[3 * node[i] + 1] += 1;
  }
  PetscFunctionReturn(0);
}

/* Sums what all faces of this rank give */
static PetscErrorCode FacesGive(Contact contact, Cover *k, Vec has, Vec sums)
{
  const PetscScalar *pair;
  const Mesh        *mesh;
  PetscScalar       *sum;
  ModelFaces         faces;

  PetscFunctionBeginUser;
  PetscCall(ModelGetMesh(contact->model, &mesh));
  PetscCall(ModelGetSetFaces(contact->model, k->c->slave, &faces));
  PetscCall(VecGetArrayRead(has, &pair));
  PetscCall(VecGetArray(sums, &sum));
  for (PetscInt f = 0; f < faces.n; f++) {
    const PetscInt *node;
    double          x[FACET_NODES][3];
    const int       n = (int)ModelFacesGet(&faces, mesh, f, &node, x);

    PetscCall(FaceGive(k, n, node, (const double(*)[3])x, pair, sum));
  }
  PetscCall(VecRestoreArray(sums, &sum));
  PetscCall(VecRestoreArrayRead(has, &pair));
  PetscCall(ModelFacesDestroy(&faces));
  PetscCall(ModelSumShared(contact->model, sums));
  PetscFunctionReturn(0);
}

/* Collective. Pairs that keep no more than BARE of their area are taken out of the list. */
PetscErrorCode ContactCoverAreas(Contact contact, PetscInt interface, PetscInt first, PetscReal *lost)
{
  const PetscInt     n    = contact->n_pairs - first;
  ContactPair       *pair = &contact->pairs[first];
  ContactPairFoot   *foot = &contact->feet[first];
  Cover              k    = {.c = &contact->interfaces[interface]};
  const PetscScalar *sum;
  PetscScalar       *one;
  PetscInt           kept = 0;
  Vec                has, sums;

  PetscFunctionBeginUser;
  PetscCall(ContactGetSurface(contact, interface, &k.surface));
  PetscCall(ModelCreateNodal(contact->model, &has));
  PetscCall(ModelCreateNodal(contact->model, &sums));
  PetscCall(VecGetArray(has, &one));
  for (PetscInt i = 0; i < n; i++) one[3 * foot[i].node] = 1;
  PetscCall(VecRestoreArray(has, &one));
  PetscCall(ModelSumShared(contact->model, has));
  PetscCall(FacesGive(contact, &k, has, sums));
  PetscCall(VecGetArrayRead(sums, &sum));
  for (PetscInt i = 0; i < n; i++) {
    const PetscReal whole = pair[i].area;

    if (PetscRealPart(sum[3 * foot[i].node + 1]) > 0) pair[i].area = PetscRealPart(sum[3 * foot[i].node]);
    if (pair[i].area <= BARE * whole) continue;
    foot[kept]   = foot[i];
    pair[kept++] = pair[i];
  }
  contact->n_pairs = first + kept;
  PetscCall(VecRestoreArrayRead(sums, &sum));
  PetscCallMPI(MPI_Allreduce(&k.lost, lost, 1, MPIU_REAL, MPI_SUM, contact->comm));
  PetscCall(PetscFree(k.near.facet));
  PetscCall(VecDestroy(&has));
  PetscCall(VecDestroy(&sums));
  PetscFunctionReturn(0);
}
