/*
   Pairing by position. Every rank gets all facets of the master surface (a surface is small beside its body) and
   projects its own slave nodes on them; the nearest facet wins. The master point moves with the facet's bilinear
   weights, so that matching meshes give node-to-node pairs.

   Slip: given, or the velocity of the slave relative to a master that turns with angular velocity w about c:
   v = -w x (x - c) in m/s. Both are projected on the tangent plane of the pair.
*/
#include "contactimpl.h"
#include "base/gather.h"
#include "kernels/facet.h"

PetscErrorCode FacetsLocal(Model model, const char set[], PetscInt *n, Facet **facets)
{
  const Mesh *mesh;
  PetscReal  *normals;
  PetscInt   *corners;

  PetscFunctionBeginUser;
  PetscCall(ModelGetMesh(model, &mesh));
  PetscCall(ModelGetSetNormals(model, set, &normals));
  PetscCall(ModelGetSetFaces(model, set, n, &corners));
  PetscCall(PetscMalloc1(*n, facets));
  for (PetscInt i = 0; i < 4 * *n; i++) {
    const PetscInt v = 3 * corners[i];

    PetscCall(PetscArraycpy((*facets)[i / 4].x[i % 4], &mesh->x[v], 3));
    PetscCall(PetscArraycpy((*facets)[i / 4].normal[i % 4], &normals[v], 3));
    PetscCall(PetscArraycpy((*facets)[i / 4].unknowns[i % 4], &mesh->unknown[v], 3));
    (*facets)[i / 4].vertex[i % 4] = mesh->number[corners[i]];
  }
  PetscCall(PetscFree(normals));
  PetscCall(PetscFree(corners));
  PetscFunctionReturn(0);
}

/* All facets of the master surface, on every rank */
static PetscErrorCode FacetsGather(MPI_Comm comm, Model model, const char set[], PetscInt *n, Facet **facets)
{
  PetscInt n_local;
  Facet   *local;

  PetscFunctionBeginUser;
  PetscCall(FacetsLocal(model, set, &n_local, &local));
  PetscCall(GatherRecords(comm, n_local, sizeof(Facet), local, n, facets));
  PetscCall(PetscFree(local));
  PetscFunctionReturn(0);
}

/* Whether x lies farther than `reach` outside the bounding box of the facet */
static PetscBool FacetIsFar(const Facet *f, const PetscReal x[3], PetscReal reach)
{
  for (int d = 0; d < 3; d++) {
    const PetscReal low  = PetscMin(PetscMin(f->x[0][d], f->x[1][d]), PetscMin(f->x[2][d], f->x[3][d]));
    const PetscReal high = PetscMax(PetscMax(f->x[0][d], f->x[1][d]), PetscMax(f->x[2][d], f->x[3][d]));

    if (x[d] < low - reach || x[d] > high + reach) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

/* Nearest facet to x, with natural coordinates and distance */
static PetscInt FacetNearest(PetscInt n, const Facet facets[], const PetscReal x[3], PetscReal natural[2],
                             PetscReal *distance)
{
  PetscInt best = -1;

  *distance = PETSC_MAX_REAL;
  for (PetscInt f = 0; f < n; f++) {
    PetscReal here, at[2];

    if (FacetIsFar(&facets[f], x, *distance)) continue;
    here = FacetProject((const double(*)[3])facets[f].x, x, at);
    if (here >= *distance) continue;
    *distance  = here;
    natural[0] = at[0];
    natural[1] = at[1];
    best       = f;
  }
  return best;
}

static PetscReal Dot(const PetscReal a[3], const PetscReal b[3])
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void Cross(const PetscReal a[3], const PetscReal b[3], PetscReal c[3])
{
  c[0] = a[1] * b[2] - a[2] * b[1];
  c[1] = a[2] * b[0] - a[0] * b[2];
  c[2] = a[0] * b[1] - a[1] * b[0];
}

/* Scales to length one and returns the length before */
static PetscReal Normalise(PetscReal a[3])
{
  const PetscReal length = PetscSqrtReal(Dot(a, a));

  for (int d = 0; d < 3 && length > 0; d++) a[d] /= length;
  return length;
}

/* Gap n . (x_s - x_m); what is below 1e-9 of the facet's diagonal is rounding of the coordinates, and no gap */
static PetscReal PairGap(const Facet *facet, const PetscReal weight[4], const ContactPair *pair)
{
  PetscReal apart[3], diagonal[3], gap;

  for (int d = 0; d < 3; d++) {
    apart[d] = pair->x[d];
    for (int i = 0; i < 4; i++) apart[d] -= weight[i] * facet->x[i][d];
    diagonal[d] = facet->x[2][d] - facet->x[0][d];
  }
  gap = Dot(pair->n, apart);
  return PetscAbsReal(gap) < 1e-9 * PetscSqrtReal(Dot(diagonal, diagonal)) ? 0 : gap;
}

/* Corners with their weights, the interpolated normal and the gap along it */
static void PairSetMaster(const Facet *facet, const PetscReal natural[2], ContactPair *pair)
{
  PetscReal weight[4];

  FacetWeights(natural[0], natural[1], weight);
  for (int i = 0; i < 4; i++) {
    if (weight[i] == 0) continue;
    for (int d = 0; d < 3; d++) {
      pair->n[d] += weight[i] * facet->normal[i][d];
      pair->master[pair->n_master][d] = facet->unknowns[i][d];
    }
    pair->corner[pair->n_master]   = facet->vertex[i];
    pair->weight[pair->n_master++] = weight[i];
  }
  (void)Normalise(pair->n);
  pair->gap = PairGap(facet, weight, pair);
}

/* A unit vector across n, where the direction of slip is not needed */
static void AnyTangent(const PetscReal n[3], PetscReal t[3])
{
  PetscReal axis[3] = {0, 0, 0};
  int       least   = 0;

  for (int d = 1; d < 3; d++)
    if (PetscAbsReal(n[d]) < PetscAbsReal(n[least])) least = d;
  axis[least] = 1;
  Cross(n, axis, t);
  (void)Normalise(t);
}

/* Slip direction, transverse direction and speed; false when the slip has no part in the tangent plane */
static PetscBool PairSetSlip(const ContactInterface *c, ContactPair *pair)
{
  const PetscReal arm[3] = {c->center[0] - pair->x[0], c->center[1] - pair->x[1], c->center[2] - pair->x[2]};
  const PetscBool turns  = Dot(c->rotation, c->rotation) > 0 ? PETSC_TRUE : PETSC_FALSE;
  PetscReal       normal_part, full, speed;

  if (turns)
    Cross(c->rotation, arm, pair->t);
  else
    for (int d = 0; d < 3; d++) pair->t[d] = c->slip[d];
  full        = PetscSqrtReal(Dot(pair->t, pair->t));
  normal_part = Dot(pair->t, pair->n);
  for (int d = 0; d < 3; d++) pair->t[d] -= normal_part * pair->n[d];
  speed = Normalise(pair->t);
  if (!(speed > 1e-6 * full)) AnyTangent(pair->n, pair->t);
  pair->speed = turns ? speed : full > 0 ? c->speed : 0;
  Cross(pair->n, pair->t, pair->b);
  return speed > 1e-6 * full ? PETSC_TRUE : PETSC_FALSE;
}

/* Worst failure over all ranks: distance of a node without partner (m), its position, and whether a slip vanished */
typedef struct {
  PetscReal distance, x[3], no_slip;
} PairFailure;

/* What is known of the slave nodes: arrays of the local vertices */
typedef struct {
  const PetscReal *x;        /* [vertex][3], m */
  const PetscInt  *unknowns; /* [vertex][3] */
  PetscReal       *normals;  /* [vertex][3], times area, m^2 */
} SlaveNodes;

/* The pair of local vertex v with the facet nearest to it; what fails is kept in *failure */
static PetscErrorCode PairSet(const ContactInterface *c, const SlaveNodes *nodes, PetscInt v, PetscInt n_facets,
                              const Facet facets[], ContactPair *pair, PairFailure *failure)
{
  const PetscReal *normal     = &nodes->normals[3 * v];
  PetscReal        natural[2] = {0, 0}, distance;
  PetscInt         f;

  PetscFunctionBeginUser;
  PetscCall(PetscArraycpy(pair->x, &nodes->x[3 * v], 3));
  PetscCall(PetscArraycpy(pair->slave, &nodes->unknowns[3 * v], 3));
  pair->area = PetscSqrtReal(Dot(normal, normal));
  f          = FacetNearest(n_facets, facets, pair->x, natural, &distance);
  if (distance > failure->distance) {
    failure->distance = distance;
    PetscCall(PetscArraycpy(failure->x, pair->x, 3));
  }
  if (f < 0) PetscFunctionReturn(0);
  PairSetMaster(&facets[f], natural, pair);
  if (!PairSetSlip(c, pair)) failure->no_slip = 1;
  PetscFunctionReturn(0);
}

/* Appends n pairs of an interface, of which slave and master are to be found; first is the place of the first */
static PetscErrorCode PairsAppend(Contact contact, PetscInt interface, PetscInt n, PetscInt *first)
{
  PetscFunctionBeginUser;
  *first = contact->n_pairs;
  contact->n_pairs += n;
  PetscCall(PetscRealloc(sizeof(ContactPair) * (size_t)contact->n_pairs, &contact->pairs));
  PetscCall(PetscRealloc(sizeof(PetscInt) * (size_t)contact->n_pairs, &contact->vertex));
  for (PetscInt p = *first; p < contact->n_pairs; p++) contact->pairs[p] = (ContactPair){.interface = interface};
  PetscFunctionReturn(0);
}

/* Pairs the slave nodes that this rank owns */
static PetscErrorCode PairNodes(Contact contact, PetscInt interface, PetscInt n_facets, const Facet facets[],
                                PairFailure *failure)
{
  const ContactInterface *c = &contact->interfaces[interface];
  const PetscInt         *vertices;
  const Mesh             *mesh;
  SlaveNodes              nodes;
  PetscInt                n, first;
  IS                      is;

  PetscFunctionBeginUser;
  PetscCall(ModelGetMesh(contact->model, &mesh));
  PetscCall(ModelGetCoordinates(contact->model, &nodes.x));
  PetscCall(ModelGetUnknowns(contact->model, &nodes.unknowns));
  PetscCall(ModelGetSetNormals(contact->model, c->slave, &nodes.normals));
  PetscCall(ModelGetOwnedVertices(contact->model, c->slave, &is));
  PetscCall(ISGetLocalSize(is, &n));
  PetscCall(ISGetIndices(is, &vertices));
  PetscCall(PairsAppend(contact, interface, n, &first));
  for (PetscInt i = 0; i < n; i++) {
    contact->vertex[first + i] = mesh->number[vertices[i]];
    PetscCall(PairSet(c, &nodes, vertices[i], n_facets, facets, &contact->pairs[first + i], failure));
  }
  PetscCall(ISRestoreIndices(is, &vertices));
  PetscCall(ISDestroy(&is));
  PetscCall(PetscFree(nodes.normals));
  PetscFunctionReturn(0);
}

/* Raises the error for a node without partner, or where the slip that is given vanishes */
static PetscErrorCode PairCheck(MPI_Comm comm, ContactInterface *c, PairFailure *failure)
{
  const PetscBool given = Dot(c->slip, c->slip) > 0 || Dot(c->rotation, c->rotation) > 0 ? PETSC_TRUE : PETSC_FALSE;
  struct {
    double distance;
    int    rank;
  } worst = {failure->distance, 0};

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(comm, &worst.rank));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &worst, 1, MPI_DOUBLE_INT, MPI_MAXLOC, comm));
  PetscCallMPI(MPI_Bcast(failure->x, 3, MPIU_REAL, worst.rank, comm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &failure->no_slip, 1, MPIU_REAL, MPI_MAX, comm));
  PetscCheck(worst.distance <= c->tolerance, comm, PETSC_ERR_USER_INPUT,
             "contact %s: the node of %s at %.6g, %.6g, %.6g m finds no partner on %s (nearest %.6g m away, "
             "-%s_tolerance is %.6g m)",
             c->name, c->slave, (double)failure->x[0], (double)failure->x[1], (double)failure->x[2], c->master,
             worst.distance, c->name, (double)c->tolerance);
  c->slides = failure->no_slip == 0 ? PETSC_TRUE : PETSC_FALSE;
  PetscCheck(
    c->slides || !given || (c->mu == 0 && !c->damping), comm, PETSC_ERR_USER_INPUT,
    "contact %s: the sliding velocity vanishes in the surface at some pair; give -%s_slip x,y,z along the surface",
    c->name, c->name);
  PetscFunctionReturn(0);
}

PetscErrorCode ContactPairInterface(Contact contact, PetscInt interface)
{
  ContactInterface *c       = &contact->interfaces[interface];
  const PetscInt    first   = contact->n_pairs;
  PairFailure       failure = {
          0, {0, 0, 0},
           0
  };
  PetscInt  n_facets;
  PetscReal area = 0;
  Facet    *facets;

  PetscFunctionBeginUser;
  PetscCall(FacetsGather(contact->comm, contact->model, c->master, &n_facets, &facets));
  PetscCall(PairNodes(contact, interface, n_facets, facets, &failure));
  PetscCall(PetscFree(facets));
  PetscCall(PairCheck(contact->comm, c, &failure));
  for (PetscInt p = first; p < contact->n_pairs; p++) area += contact->pairs[p].area;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &area, 1, MPIU_REAL, MPI_SUM, contact->comm));
  for (PetscInt p = first; p < contact->n_pairs; p++)
    contact->pairs[p].force = c->force * contact->pairs[p].area / area;
  PetscFunctionReturn(0);
}
