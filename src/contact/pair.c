/*
   Pairing by position. Every rank finds the feet of its own slave nodes on the master surface (surface.h): the nearest
   point, and from there the facet whose normal leads to the node. A node beyond the border of the master has no pair: a
   distance along the surface is no gap. Those beside it have the area that lies over the master (cover.c). The master
   point moves with the facet's shape functions, so that matching meshes give node-to-node pairs.

   Slip: given, or the velocity of the slave relative to a master that turns with angular velocity w about c:
   v = -w x (x - c) in m/s. Both are projected on the tangent plane of the pair.
*/
#include "contactimpl.h"

#define PAIR_BARE                                                                                                      \
  "contact %s: the nodes of %s that touch %s lie on its border, and none of their faces lies over it; give two of "    \
  "-%s_surfaces that lie over each other"

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
static void PairLook(const ContactSurface *surface, const ContactPair *pair, const ContactPairFoot *foot,
                     PairFailure *failure)
{
  const ContactFacet *facet = &surface->facet[foot->facet];
  const PetscReal     along = Vec3Dot(foot->normal, pair->n);

  failure->n++;
  for (int i = 0; i < facet->n; i++)
    if (surface->vertex[facet->node[i]] == pair->vertex && PetscAbsReal(foot->weight[i] - 1) < 1e-9)
      failure->n_common++;
  if (along < 0) failure->n_towards++;
  if (along > 0) failure->n_with++;
}

/* Keeps that a slave at x lies beyond the border of the master */
static void PairOff(const ContactPairFoot *foot, const PetscReal x[3], PairFailure *failure)
{
  failure->n_off++;
  failure->off = PetscMax(failure->off, foot->beyond);
  if (failure->n_off > 1 && foot->beyond >= failure->nearest[0]) return;
  failure->nearest[0] = foot->beyond;
  failure->nearest[1] = foot->distance;
  for (int d = 0; d < 3; d++) failure->nearest_x[d] = x[d];
}

/* Keeps what fails of a pair */
static void PairJudge(const ContactSurface *surface, const ContactPair *pair, const ContactPairFoot *foot,
                      PairFailure *failure)
{
  const PetscReal distance = foot->beyond > 0 ? PetscAbsReal(pair->gap) : foot->distance;

  if (!foot->slides) failure->no_slip = 1;
  if (distance > failure->distance) {
    failure->distance = distance;
    for (int d = 0; d < 3; d++) failure->x[d] = pair->x[d];
  }
  PairLook(surface, pair, foot, failure);
}

/* The sides of a pair of a node and its foot: the node, and those of the facet that take part; *node is where the next
   of the interface are put */
static void PairSetSides(const ContactSurface *surface, const ContactPairFoot *foot, const PetscInt unknown[3],
                         ContactPair *pair, ContactPairNode **node)
{
  const ContactFacet *facet = &surface->facet[foot->facet];
  ContactPairNode    *side  = *node;

  pair->n_slave = pair->n_own = 1;
  pair->slave = pair->own = side;
  *side++                 = (ContactPairNode){pair->vertex, {unknown[0], unknown[1], unknown[2]}, 1};
  pair->master            = side;
  for (int i = 0; i < facet->n; i++) {
    const PetscInt *u = facet->unknowns[i];

    if (foot->weight[i] != 0)
      *side++ = (ContactPairNode){surface->vertex[facet->node[i]], {u[0], u[1], u[2]}, foot->weight[i]};
  }
  pair->n_master = (PetscInt)(side - pair->master);
  *node          = side;
}

/* Appends a pair for each slave node that this rank owns, with its foot and its area in the surface of the slave */
static PetscErrorCode FootPairs(Contact contact, PetscInt interface, const ContactSurface *surface)
{
  const ContactInterface *c = &contact->interfaces[interface];
  const Mesh             *mesh;
  PetscReal              *normals; /* [node][3], times area, m^2 */
  PetscInt                n, *vertex;

  PetscFunctionBeginUser;
  PetscCall(ModelGetMesh(contact->model, &mesh));
  PetscCall(ModelGetSetNormals(contact->model, c->slave, &normals));
  PetscCall(ModelGetOwnedNodes(contact->model, c->slave, &n, &vertex));
  PetscCall(PetscRealloc(sizeof(ContactPair) * (size_t)(contact->n_pairs + n), &contact->pairs));
  PetscCall(PetscRealloc(sizeof(ContactPairFoot) * (size_t)(contact->n_pairs + n), &contact->feet));
  for (PetscInt i = 0; i < n; i++) {
    const PetscInt   v    = vertex[i];
    ContactPair     *pair = &contact->pairs[contact->n_pairs];
    ContactPairFoot *foot = &contact->feet[contact->n_pairs++];
    ContactFoot      found;

    *pair = (ContactPair){.interface = interface, .vertex = mesh->number[v], .area = Vec3Length(&normals[3 * v])};
    *foot = (ContactPairFoot){.node = v};
    PetscCall(PetscArraycpy(pair->x, &mesh->x[3 * v], 3));
    PetscCall(PetscArraycpy(foot->normal, &normals[3 * v], 3));
    ContactFootFind(surface, pair->x, &found);
    ContactPairTakeFoot(c, surface, &found, pair, foot);
  }
  PetscCall(PetscFree(vertex));
  PetscCall(PetscFree(normals));
  PetscFunctionReturn(0);
}

/* Sides of the pairs from the first on; slaves beyond the border of the master are taken out. Of mortar contact that is
   those without an area over it, but one that lies over the master is kept where it is too far from it, to say so. */
static PetscErrorCode PairsChoose(Contact contact, PetscInt interface, PetscInt first, const ContactSurface *surface,
                                  PairFailure *failure)
{
  const ContactInterface *c    = &contact->interfaces[interface];
  PetscInt                kept = first;
  ContactPairNode        *node = NULL;
  const Mesh             *mesh;

  PetscFunctionBeginUser;
  PetscCall(ModelGetMesh(contact->model, &mesh));
  if (contact->mortar[interface]) {
    PetscCall(ContactMortarPairs(contact, interface, first));
  } else {
    PetscCall(PetscMalloc1((1 + CONTACT_MAX_MASTER) * (contact->n_pairs - first), &node));
    contact->sides[interface] = node;
  }
  for (PetscInt p = first; p < contact->n_pairs; p++) {
    const ContactPairFoot *foot = &contact->feet[p];
    ContactPair           *pair = &contact->pairs[p];
    const PetscBool        far  = foot->beyond == 0 && foot->distance > c->tolerance ? PETSC_TRUE : PETSC_FALSE;

    if (foot->facet < 0 || (node ? ContactFootIsOff(surface, foot) : pair->area == 0 && !far)) {
      PairOff(foot, pair->x, failure);
      continue;
    }
    if (node) PairSetSides(surface, foot, &mesh->unknown[3 * foot->node], pair, &node);
    PairJudge(surface, pair, foot, failure);
    contact->feet[kept]    = *foot;
    contact->pairs[kept++] = *pair;
  }
  contact->n_pairs = kept;
  PetscFunctionReturn(0);
}

/* Whether the pairs from the first on are means over both surfaces: as told, or where the meshes do not match */
static PetscErrorCode DiscretizationChoose(Contact contact, PetscInt interface, PetscInt first)
{
  const ContactDiscretization told  = contact->interfaces[interface].discretization;
  PetscBool                   match = told == CONTACT_NODE ? PETSC_TRUE : PETSC_FALSE;

  PetscFunctionBeginUser;
  if (told == CONTACT_AUTO) PetscCall(ContactMeshesMatch(contact, interface, first, &match));
  contact->mortar[interface] = match ? PETSC_FALSE : PETSC_TRUE;
  PetscFunctionReturn(0);
}

PetscErrorCode ContactIsMortar(Contact contact, PetscInt interface, PetscBool *mortar)
{
  const PetscInt        first = contact->n_pairs;
  const ContactSurface *surface;

  PetscFunctionBeginUser;
  if (!contact->n_pairs_all) {
    PetscCall(ContactGetSurface(contact, interface, &surface));
    if (contact->interfaces[interface].discretization == CONTACT_AUTO)
      PetscCall(FootPairs(contact, interface, surface));
    PetscCall(DiscretizationChoose(contact, interface, first));
    contact->n_pairs = first;
  }
  *mortar = contact->mortar[interface];
  PetscFunctionReturn(0);
}

/* Areas of the pairs from the first on; those on the border of the master, none of whose faces lies over it, are taken
   out: an error where they are all. lost: area over the master that no pair gets, m^2 */
static PetscErrorCode PairsCover(Contact contact, PetscInt interface, PetscInt first, PetscReal *lost)
{
  ContactInterface *c = &contact->interfaces[interface];
  const PetscInt    n = contact->n_pairs - first;
  PetscInt          all[2];

  PetscFunctionBeginUser;
  PetscCall(ContactCoverAreas(contact, interface, first, lost));
  all[1] = contact->n_pairs - first;
  all[0] = n - all[1];
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, all, 2, MPIU_INT, MPI_SUM, contact->comm));
  PetscCheck(all[1] || !all[0], contact->comm, PETSC_ERR_USER_INPUT, PAIR_BARE, c->name, c->slave, c->master, c->name);
  c->n_off += all[0];
  PetscFunctionReturn(0);
}

/* Raises the error for surfaces between which nothing can slide: they share most of their nodes, or one looks where
   the other does. A line of common nodes, a hinge or the tip of a crack, is no fault: u_m - u_s of such a pair is
   zero. The counts are those of all ranks. */
static PetscErrorCode SurfacesCheck(MPI_Comm comm, const ContactInterface *c, PairFailure *failure)
{
  PetscFunctionBeginUser;
  PetscCheck(2 * failure->n_common <= failure->n, comm, PETSC_ERR_USER_INPUT,
             "contact %s: %" PetscInt_FMT " of %" PetscInt_FMT
             " nodes of -%s_surfaces %s,%s are nodes of both, and rub on nothing; give each body nodes of its own "
             "there, each set faces of one body",
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
  PetscCheck(failure->n || away[1] > c->tolerance, comm, PETSC_ERR_USER_INPUT, PAIR_BARE, c->name, c->slave, c->master,
             c->name);
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
  const MPI_Comm  comm   = contact->comm;
  const PetscBool mortar = contact->mortar[c - contact->interfaces];
  const char     *metre, *area;

  PetscFunctionBeginUser;
  if (!c->n_off) PetscFunctionReturn(0);
  PetscCall(ModelGetUnit(contact->model, "m", &metre));
  PetscCall(ModelGetUnit(contact->model, "m^2", &area));
  PetscCall(PetscFPrintf(comm, stderr,
                         "squeal: warning: contact %s: %" PetscInt_FMT " of %" PetscInt_FMT
                         " nodes of %s have %s, and %s; the farthest is %.3g %s beyond the border of %s",
                         c->name, c->n_off, c->n_slaves, c->slave,
                         mortar ? "no or little of the master under them" : "no master under them",
                         mortar ? "no pair" : "carry nothing", (double)c->off, metre, c->master));
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

/* Says what was chosen unasked, and an interference (m) beside which the contact of this area (m^2) is small */
static PetscErrorCode ChoicesTell(Contact contact, const ContactInterface *c, PetscReal area)
{
  const char *metre;

  PetscFunctionBeginUser;
  PetscCall(ModelGetUnit(contact->model, "m", &metre));
  if (c->discretization == CONTACT_AUTO && contact->mortar[c - contact->interfaces])
    PetscCall(PetscPrintf(contact->comm, "contact %s: meshes do not match: mortar\n", c->name));
  if (c->interference > 0.1 * PetscSqrtReal(area))
    PetscCall(PetscFPrintf(contact->comm, stderr,
                           "squeal: warning: -%s_interference %.6g %s is more than 10 %% of the size of the contact, "
                           "%.3g %s; is it in %s?\n",
                           c->name, (double)c->interference, metre, (double)PetscSqrtReal(area), metre, metre));
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
  PetscReal             area = 0, lost = 0;

  PetscFunctionBeginUser;
  PetscCall(ContactGetSurface(contact, interface, &surface));
  PetscCall(ModelGetUnit(contact->model, "m", &failure.metre));
  PetscCall(FootPairs(contact, interface, surface));
  PetscCall(DiscretizationChoose(contact, interface, first));
  if (contact->mortar[interface]) PetscCall(ContactMortarSplit(contact, interface, first));
  PetscCall(PairsChoose(contact, interface, first, surface, &failure));
  PetscCall(PartnerCheck(contact->comm, c, &failure));
  if (!contact->mortar[interface]) PetscCall(PairsCover(contact, interface, first, &lost));
  PetscCall(OffWarn(contact, c, lost));
  for (PetscInt p = first; p < contact->n_pairs; p++) area += contact->pairs[p].area;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &area, 1, MPIU_REAL, MPI_SUM, contact->comm));
  PetscCall(ChoicesTell(contact, c, area));
  for (PetscInt p = first; p < contact->n_pairs; p++)
    contact->pairs[p].force = c->force * contact->pairs[p].area / area;
  PetscFunctionReturn(0);
}
