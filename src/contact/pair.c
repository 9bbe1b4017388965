/*
   Pairing by position. Every rank finds the feet of its own slave nodes on the master surface (surface.h): the nearest
   point, and from there the facet whose normal leads to the node. A node beyond the border of the master has no pair: a
   distance along the surface is no gap. Those beside it have the area that lies over the master (cover.c). The master
   point moves with the facet's shape functions, so that matching meshes give node-to-node pairs.

   Slip: given, or the velocity of the slave relative to a master that turns with angular velocity w about c:
   v = -w x (x - c) in m/s. Both are projected on the tangent plane of the pair.
*/
#include "contactimpl.h"

/* Nodes with their weights, directions, speed (m/s) and gap (m); false where the slip has no part in the tangent
   plane. Along a rotation the speed is |w x (x - c)| in the tangent plane, which differs from pair to pair; a
   direction that is given has the speed of the options everywhere. across = |sum_i w_i a_i| (m^2, or without unit on
   facets of second order) is the divisor of the tilt (surface/tilt.c). A gap below 1e-9 of the facet's size is
   rounding of the coordinates, and 0. */
static PetscBool PairSetMaster(const ContactInterface *c, const ContactSurface *surface, const ContactFoot *foot,
                               ContactPair *pair)
{
  const ContactFacet *facet = &surface->facet[foot->facet];
  PetscReal           weight[CONTACT_MAX_MASTER], along[3], e[3][3], a[3] = {0, 0, 0}, speed;

  ContactSlideAlong(c, pair->x, along);
  speed = ContactBasis(facet, foot->natural, along, weight, e);
  for (int i = 0; i < facet->n; i++) {
    if (weight[i] == 0) continue;
    for (int d = 0; d < 3; d++) {
      pair->master[pair->n_master][d] = facet->unknowns[i][d];
      a[d] += weight[i] * facet->across[i][d];
    }
    pair->corner[pair->n_master]   = surface->vertex[facet->node[i]];
    pair->weight[pair->n_master++] = weight[i];
  }
  for (int d = 0; d < 3; d++) {
    pair->n[d] = e[0][d];
    pair->t[d] = e[1][d];
    pair->b[d] = e[2][d];
  }
  pair->speed  = Vec3Dot(c->rotation, c->rotation) > 0 ? speed : speed > 0 ? c->speed : 0;
  pair->across = Vec3Length(a);
  pair->gap    = ContactGap(facet, weight, e[0], pair->x);
  if (PetscAbsReal(pair->gap) < 1e-9 * facet->size) pair->gap = 0;
  return speed > 0 ? PETSC_TRUE : PETSC_FALSE;
}

/* What fails, over all ranks: the largest distance of a pair along the normal (m) and where; of the slaves beyond the
   border of the master the farthest, and the nearest (its distance along the surface and in all, and where); whether a
   slip vanished; area over the master of faces without any pair (m^2, complete on every rank); slaves that are nodes of
   the master too, and whose surface looks towards the master's or with it */
typedef struct {
  PetscReal   distance, x[3], off, nearest[2], nearest_x[3], no_slip;
  const char *metre; /* what the scene has for m */
  PetscInt    n_common, n_towards, n_with, n, n_off;
} PairFailure;

/* Counts a pair that has one node twice, or of which one surface looks towards the other or where that looks */
static void PairLook(const ContactPair *pair, const PetscReal normal[3], PairFailure *failure)
{
  const PetscReal along = Vec3Dot(normal, pair->n);

  failure->n++;
  for (PetscInt i = 0; i < pair->n_master; i++)
    if (pair->corner[i] == pair->vertex && PetscAbsReal(pair->weight[i] - 1) < 1e-9) failure->n_common++;
  if (along < 0) failure->n_towards++;
  if (along > 0) failure->n_with++;
}

/* Keeps that a slave at x lies beyond the border of the master */
static void PairOff(const ContactFoot *foot, const PetscReal x[3], PairFailure *failure)
{
  failure->n_off++;
  failure->off = PetscMax(failure->off, foot->across);
  if (failure->n_off > 1 && foot->across >= failure->nearest[0]) return;
  failure->nearest[0] = foot->across;
  failure->nearest[1] = foot->distance;
  for (int d = 0; d < 3; d++) failure->nearest_x[d] = x[d];
}

/* Whether a slave lies farther beyond the border of the master than is allowed */
static PetscBool FootIsOff(const ContactSurface *surface, const ContactFoot *foot)
{
  const ContactFacet *facet = &surface->facet[foot->facet];

  return foot->across > 0.5 * ContactEdge(surface, facet) * facet->size ? PETSC_TRUE : PETSC_FALSE;
}

/* Makes the pair of a slave node, but for its place in the list; false where no master lies under it */
static PetscBool PairMake(const ContactInterface *c, const ContactSurface *surface, const PetscReal normal[3],
                          ContactPair *pair, PairFailure *failure)
{
  ContactFoot foot;
  PetscReal   distance;

  ContactFootFind(surface, pair->x, &foot);
  if (foot.facet < 0 || FootIsOff(surface, &foot)) {
    PairOff(&foot, pair->x, failure);
    return PETSC_FALSE;
  }
  if (!PairSetMaster(c, surface, &foot, pair)) failure->no_slip = 1;
  distance = foot.across > 0 ? PetscAbsReal(pair->gap) : foot.distance;
  if (distance > failure->distance) {
    failure->distance = distance;
    for (int d = 0; d < 3; d++) failure->x[d] = pair->x[d];
  }
  PairLook(pair, normal, failure);
  return PETSC_TRUE;
}

/* Pairs the slave nodes that this rank owns with the facets under them; what fails is kept in *failure. vertices: of
   the new pairs, which the caller frees */
static PetscErrorCode PairNodes(Contact contact, PetscInt interface, const ContactSurface *surface,
                                PairFailure *failure, PetscInt **vertices)
{
  const ContactInterface *c = &contact->interfaces[interface];
  const Mesh             *mesh;
  PetscReal              *normals; /* [node][3], times area, m^2 */
  PetscInt                n, n_new = 0;

  PetscFunctionBeginUser;
  PetscCall(ModelGetMesh(contact->model, &mesh));
  PetscCall(ModelGetSetNormals(contact->model, c->slave, &normals));
  PetscCall(ModelGetOwnedNodes(contact->model, c->slave, &n, vertices));
  PetscCall(PetscRealloc(sizeof(ContactPair) * (size_t)(contact->n_pairs + n), &contact->pairs));
  for (PetscInt i = 0; i < n; i++) {
    const PetscInt v    = (*vertices)[i];
    ContactPair   *pair = &contact->pairs[contact->n_pairs];

    *pair = (ContactPair){.interface = interface, .vertex = mesh->number[v], .area = Vec3Length(&normals[3 * v])};
    PetscCall(PetscArraycpy(pair->x, &mesh->x[3 * v], 3));
    PetscCall(PetscArraycpy(pair->slave, &mesh->unknown[3 * v], 3));
    if (!PairMake(c, surface, &normals[3 * v], pair, failure)) continue;
    (*vertices)[n_new++] = v;
    contact->n_pairs++;
  }
  PetscCall(PetscFree(normals));
  PetscFunctionReturn(0);
}

/* Areas of the pairs from the first on; those on the border of the master, none of whose faces lies over it, are taken
   out: an error where they are all. lost: area over the master that no pair gets, m^2 */
static PetscErrorCode PairsCover(Contact contact, PetscInt interface, PetscInt first, const PetscInt vertices[],
                                 PetscReal *lost)
{
  ContactInterface *c = &contact->interfaces[interface];
  PetscInt          n = contact->n_pairs - first, kept = n, all[2];

  PetscFunctionBeginUser;
  PetscCall(ContactCoverAreas(contact, interface, &kept, vertices, &contact->pairs[first], lost));
  contact->n_pairs = first + kept;
  all[0]           = n - kept;
  all[1]           = kept;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, all, 2, MPIU_INT, MPI_SUM, contact->comm));
  PetscCheck(
    all[1] || !all[0], contact->comm, PETSC_ERR_USER_INPUT,
    "contact %s: the nodes of %s that touch %s lie on its border, and none of their faces lies over it; give two of "
    "-%s_surfaces that lie over each other",
    c->name, c->slave, c->master, c->name);
  c->n_off += all[0];
  PetscFunctionReturn(0);
}

/* Raises the error for surfaces between which nothing can slide: they share most of their nodes, or one looks where
   the other does. A line of common nodes, a hinge or the tip of a crack, is no fault: u_m - u_s of such a pair is
   zero. The counts are those of all ranks. */
static PetscErrorCode SurfacesCheck(MPI_Comm comm, const ContactInterface *c, PairFailure *failure)
{
  PetscFunctionBeginUser;
  PetscCheck(
    2 * failure->n_common <= failure->n, comm, PETSC_ERR_USER_INPUT,
    "contact %s: %" PetscInt_FMT " of %" PetscInt_FMT
    " nodes of -%s_surfaces %s,%s are nodes of both, and rub on nothing; give each body nodes of its own there",
    c->name, failure->n_common, failure->n, c->name, c->slave, c->master);
  PetscCheck(failure->n_towards || !failure->n_with, comm, PETSC_ERR_USER_INPUT,
             "contact %s: both of -%s_surfaces %s,%s look the same way; give two that face each other", c->name,
             c->name, c->slave, c->master);
  PetscFunctionReturn(0);
}

/* The largest value of all ranks with its x, on all of them; of equal ones that of the lowest rank (MPI_MAXLOC) */
PetscErrorCode ContactShareWorst(MPI_Comm comm, PetscReal *value, PetscReal x[3])
{
  struct {
    double value;
    int    rank;
  } worst = {*value, 0};

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(comm, &worst.rank));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &worst, 1, MPI_DOUBLE_INT, MPI_MAXLOC, comm));
  PetscCallMPI(MPI_Bcast(x, 3, MPIU_REAL, worst.rank, comm));
  *value = worst.value;
  PetscFunctionReturn(0);
}

/* Counts the slaves beyond the border of the master: an error where they are all. Of the ranks with such slaves the
   one nearest to the border says where: the largest of -(distance along the surface), so that a rank without any, at
   -PETSC_MAX_REAL, says nothing. */
static PetscErrorCode OffCheck(MPI_Comm comm, ContactInterface *c, PairFailure *failure)
{
  PetscReal *const along = failure->nearest, *const x = failure->nearest_x;
  PetscReal order = failure->n_off ? -along[0] : -PETSC_MAX_REAL, away[3] = {along[0], along[1], 0};

  PetscFunctionBeginUser;
  /* n_common, n_towards, n_with, n and n_off stand one after the other in PairFailure */
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &failure->n_common, 5, MPIU_INT, MPI_SUM, comm));
  c->n_off    = failure->n_off;
  c->n_slaves = failure->n + failure->n_off;
  if (!c->n_off) PetscFunctionReturn(0);
  PetscCallMPI(MPI_Allreduce(&failure->off, &c->off, 1, MPIU_REAL, MPI_MAX, comm));
  PetscCall(ContactShareWorst(comm, &(PetscReal){order}, x));
  PetscCall(ContactShareWorst(comm, &order, away));
  PetscCheck(
    failure->n, comm, PETSC_ERR_USER_INPUT,
    "contact %s: no node of %s finds a partner on %s; the nearest, at %.6g, %.6g, %.6g %s, is %.6g %s away, %.6g %s of "
    "it beyond the border along the surface; give two of -%s_surfaces that touch",
    c->name, c->slave, c->master, (double)x[0], (double)x[1], (double)x[2], failure->metre, (double)away[1],
    failure->metre, (double)away[0], failure->metre, c->name);
  PetscFunctionReturn(0);
}

/* Says how many slaves carry nothing */
static PetscErrorCode OffWarn(Contact contact, const ContactInterface *c, PetscReal lost)
{
  const MPI_Comm comm = contact->comm;
  const char    *metre, *area;

  PetscFunctionBeginUser;
  if (!c->n_off) PetscFunctionReturn(0);
  PetscCall(ModelGetUnit(contact->model, "m", &metre));
  PetscCall(ModelGetUnit(contact->model, "m^2", &area));
  PetscCall(
    PetscFPrintf(comm, stderr,
                 "squeal: warning: contact %s: %" PetscInt_FMT " of %" PetscInt_FMT
                 " nodes of %s have no master under them, and carry nothing; the farthest is %.3g %s beyond the "
                 "border of %s",
                 c->name, c->n_off, c->n_slaves, c->slave, (double)c->off, metre, c->master));
  if (lost > 0)
    PetscCall(PetscFPrintf(comm, stderr,
                           "; %.3g %s over it carry nothing either, on faces none of whose nodes has a pair",
                           (double)lost, area));
  PetscCall(PetscFPrintf(comm, stderr, "\n"));
  PetscFunctionReturn(0);
}

/* Raises the error for a node too far from its partner, or where the slip that is given vanishes */
static PetscErrorCode PartnerCheck(MPI_Comm comm, ContactInterface *c, PairFailure *failure)
{
  const PetscBool given =
    Vec3Dot(c->slip, c->slip) > 0 || Vec3Dot(c->rotation, c->rotation) > 0 ? PETSC_TRUE : PETSC_FALSE;

  PetscFunctionBeginUser;
  PetscCall(OffCheck(comm, c, failure));
  PetscCall(ContactShareWorst(comm, &failure->distance, failure->x));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &failure->no_slip, 1, MPIU_REAL, MPI_MAX, comm));
  PetscCheck(
    failure->distance <= c->tolerance, comm, PETSC_ERR_USER_INPUT,
    "contact %s: the node of %s at %.6g, %.6g, %.6g %s finds no partner on %s: it is %.6g %s above or below it, "
    "-%s_tolerance is %.6g %s; give a larger one for a gap that may close, or a set of the nodes that touch",
    c->name, c->slave, (double)failure->x[0], (double)failure->x[1], (double)failure->x[2], failure->metre, c->master,
    (double)failure->distance, failure->metre, c->name, (double)c->tolerance, failure->metre);
  PetscCall(SurfacesCheck(comm, c, failure));
  c->slides = failure->no_slip == 0 ? PETSC_TRUE : PETSC_FALSE;
  PetscCheck(
    c->slides || !given || (!FrictionExists(&c->friction) && !c->damping), comm, PETSC_ERR_USER_INPUT,
    "contact %s: the sliding velocity vanishes in the surface at some pair; give -%s_slip x,y,z along the surface",
    c->name, c->name);
  PetscCheck(!c->slides || c->kt == 0, comm, PETSC_ERR_USER_INPUT,
             "-%s_kt%s %.6g is of pairs that stick, and contact %s slides; leave it out, or -%s_slip and -%s_rotation",
             c->name, c->kt_per_area ? "_per_area" : "", (double)c->kt, c->name, c->name, c->name);
  PetscFunctionReturn(0);
}

/* The pairs of one interface, appended to those before. -X_force F is shared by area, lambda_p = F a_p / sum a: a
   uniform pressure, until statics tells better. The areas are those over the master, hence after PairsCover(). */
PetscErrorCode ContactPairInterface(Contact contact, PetscInt interface)
{
  ContactInterface     *c       = &contact->interfaces[interface];
  const PetscInt        first   = contact->n_pairs;
  PairFailure           failure = {.distance = 0};
  const ContactSurface *surface;
  PetscReal             area = 0, lost;
  PetscInt             *vertices;

  PetscFunctionBeginUser;
  PetscCall(ContactGetSurface(contact, interface, &surface));
  PetscCall(ModelGetUnit(contact->model, "m", &failure.metre));
  PetscCall(PairNodes(contact, interface, surface, &failure, &vertices));
  PetscCall(PartnerCheck(contact->comm, c, &failure));
  PetscCall(PairsCover(contact, interface, first, vertices, &lost));
  PetscCall(OffWarn(contact, c, lost));
  PetscCall(PetscFree(vertices));
  for (PetscInt p = first; p < contact->n_pairs; p++) area += contact->pairs[p].area;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &area, 1, MPIU_REAL, MPI_SUM, contact->comm));
  for (PetscInt p = first; p < contact->n_pairs; p++)
    contact->pairs[p].force = c->force * contact->pairs[p].area / area;
  PetscFunctionReturn(0);
}

/* Area (m^2) on which the pressure of a law acts; of a stiffness per pair 1, its pressure is a force */
static PetscReal PairArea(const ContactInterface *interface, const ContactPair *pair)
{
  return interface->per_area || !PressureIsLinear(&interface->pressure) ? pair->area : 1;
}

/* The law is an argument, not that of the interface, since a sweep varies it */
PetscReal ContactPairStiffness(const ContactInterface *interface, const ContactPair *pair, const PressureLaw *law,
                               PetscReal lambda_n)
{
  return PressureSlope(law, ContactPairClosing(interface, pair, law, lambda_n)) * PairArea(interface, pair);
}

PetscReal ContactPairClosing(const ContactInterface *interface, const ContactPair *pair, const PressureLaw *law,
                             PetscReal lambda_n)
{
  return PressureClosing(law, lambda_n / PairArea(interface, pair));
}
