/*
   Folds of the surfaces of mortar contact: edges at which the faces' own normals differ by more than 40 degrees, as at
   a chamfer. The faces around a node that hang together without crossing a fold are one side of it.

   A master has one normal a side at its nodes, so that none is a mean over a fold (surface/surface.h). A slave node at
   a fold has one pair for each of its sides, with the functions phi of the faces of that side alone: each carries its
   own pressure along its own normal. Where surfaces have folds, a facet lies over another only where their normals are
   within 40 degrees of opposite: the facets of a chamfer, whose dual functions have no gap at the fold, are open. Of
   feet in the same distance, as at a fold of the master, that is taken whose facet looks most towards the slave's side.
*/
#include "mortarimpl.h"
#include "base/algebra/vec3.h"

#define FOLD_AT 1e-6 /* of a facet: feet in the same distance */

/* Facets around the nodes of a surface, FACET_NODES times a facet and its place there, as in MortarBorder */
typedef struct {
  PetscInt *first, *around;
} FoldStar;

static PetscErrorCode StarCreate(const ContactSurface *s, FoldStar *star)
{
  PetscInt *place;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc2(s->n_nodes + 1, &star->first, FACET_NODES * s->n_facets, &star->around));
  for (PetscInt f = 0; f < s->n_facets; f++)
    for (int j = 0; j < s->facet[f].n; j++) star->first[s->facet[f].node[j] + 1]++;
  for (PetscInt v = 0; v < s->n_nodes; v++) star->first[v + 1] += star->first[v];
  PetscCall(PetscMalloc1(s->n_nodes + 1, &place));
  PetscCall(PetscArraycpy(place, star->first, s->n_nodes + 1));
  for (PetscInt f = 0; f < s->n_facets; f++)
    for (int j = 0; j < s->facet[f].n; j++) star->around[place[s->facet[f].node[j]]++] = FACET_NODES * f + j;
  PetscCall(PetscFree(place));
  PetscFunctionReturn(0);
}

/* The facet's own unit normal at its node j */
static void OwnNormal(const ContactFacet *f, int j, PetscReal n[3])
{
  FacetNormal(f->n, (const double(*)[3])f->x, FacetShapeOf(f->n)->node[j], n);
  (void)Vec3Normalise(n);
}

/* Whether two facets at a node, at their places there, share an edge at it that is no fold */
static PetscBool FacetsJoin(const ContactSurface *s, PetscInt a, PetscInt b)
{
  const ContactFacet *f = &s->facet[a / FACET_NODES], *g = &s->facet[b / FACET_NODES];
  const int           j = (int)(a % FACET_NODES), corners = ContactFacetCorners(f);
  const int           e = j < corners ? j : j - corners, before = j < corners ? (j + corners - 1) % corners : e;
  PetscReal           m[3], n[3];

  if (j >= 2 * corners || (f->beside[e] != b / FACET_NODES && f->beside[before] != b / FACET_NODES)) return PETSC_FALSE;
  OwnNormal(f, j, m);
  OwnNormal(g, (int)(b % FACET_NODES), n);
  return Vec3Dot(m, n) > MORTAR_FOLD ? PETSC_TRUE : PETSC_FALSE;
}

/* The sides of one node: side[] of the facets around it, from 0 on; their number */
static int NodeSides(const ContactSurface *s, PetscInt n, const PetscInt around[], PetscInt side[])
{
  int n_sides = 0;

  for (PetscInt i = 0; i < n; i++) side[i] = -1;
  for (PetscInt i = 0; i < n; i++) {
    PetscBool grows = PETSC_TRUE;

    if (side[i] >= 0) continue;
    side[i] = n_sides++;
    while (grows) {
      grows = PETSC_FALSE;
      for (PetscInt k = 0; k < n * n; k++)
        if (side[k / n] == side[i] && side[k % n] < 0 && FacetsJoin(s, around[k / n], around[k % n]))
          side[k % n] = side[i], grows = PETSC_TRUE;
    }
  }
  return n_sides;
}

/* Sides of all facets at all their nodes, side[around]; where new places of the surface begin at each node, of the
   sides but the first, place[n_nodes + 1] */
static PetscErrorCode SidesFind(const ContactSurface *s, const FoldStar *star, PetscInt side[], PetscInt place[])
{
  PetscFunctionBeginUser;
  place[0] = s->n_nodes;
  for (PetscInt v = 0; v < s->n_nodes; v++) {
    const PetscInt first = star->first[v];

    place[v + 1] = place[v] + NodeSides(s, star->first[v + 1] - first, &star->around[first], &side[first]) - 1;
  }
  PetscFunctionReturn(0);
}

PetscErrorCode MortarSplitMaster(ContactSurface *s)
{
  PetscInt *side, *place;
  FoldStar  star;

  PetscFunctionBeginUser;
  PetscCall(StarCreate(s, &star));
  PetscCall(PetscMalloc2(FACET_NODES * s->n_facets, &side, s->n_nodes + 1, &place));
  PetscCall(SidesFind(s, &star, side, place));
  for (PetscInt v = 0; v < s->n_nodes; v++)
    for (PetscInt i = star.first[v]; i < star.first[v + 1] && place[v + 1] > place[v]; i++) {
      ContactFacet *f = &s->facet[star.around[i] / FACET_NODES];
      PetscReal    *a = f->across[star.around[i] % FACET_NODES];

      a[0] = a[1] = a[2] = 0;
      for (PetscInt k = star.first[v]; k < star.first[v + 1]; k++) {
        const ContactFacet *g = &s->facet[star.around[k] / FACET_NODES];
        double              share[FACET_NODES][3];

        if (side[k] != side[i]) continue;
        FacetNodeNormals(g->n, (const double(*)[3])g->x, share);
        for (int d = 0; d < 3; d++) a[d] += share[star.around[k] % FACET_NODES][d];
      }
      if (ContactFacetCorners(f) < f->n) (void)Vec3Normalise(a);
    }
  s->folds = place[s->n_nodes] > s->n_nodes ? PETSC_TRUE : PETSC_FALSE;
  for (PetscInt f = 0; f < s->n_facets && s->folds; f++) ContactFacetMeasure(&s->facet[f]);
  PetscCall(PetscFree2(side, place));
  PetscCall(PetscFree2(star.first, star.around));
  PetscFunctionReturn(0);
}

PetscErrorCode MortarSplitSlave(ContactSurface *s)
{
  PetscInt *side, *place;
  FoldStar  star;

  PetscFunctionBeginUser;
  s->n_sorted = s->n_nodes;
  PetscCall(StarCreate(s, &star));
  PetscCall(PetscMalloc2(FACET_NODES * s->n_facets, &side, s->n_nodes + 1, &place));
  PetscCall(SidesFind(s, &star, side, place));
  PetscCall(PetscRealloc(sizeof(PetscInt) * (size_t)place[s->n_nodes], &s->vertex));
  for (PetscInt v = 0; v < s->n_nodes; v++) {
    for (PetscInt k = place[v]; k < place[v + 1]; k++) s->vertex[k] = s->vertex[v];
    for (PetscInt i = star.first[v]; i < star.first[v + 1]; i++)
      if (side[i]) s->facet[star.around[i] / FACET_NODES].node[star.around[i] % FACET_NODES] = place[v] + side[i] - 1;
  }
  s->n_nodes = place[s->n_nodes];
  PetscCall(PetscFree2(side, place));
  PetscCall(PetscFree2(star.first, star.around));
  PetscFunctionReturn(0);
}

void MortarPlacesLook(const ContactSurface *s, PetscReal look[][3])
{
  for (PetscInt v = 0; v < s->n_nodes; v++)
    for (int d = 0; d < 3; d++) look[v][d] = 0;
  for (PetscInt f = 0; f < s->n_facets; f++)
    for (int j = 0; j < s->facet[f].n; j++)
      for (int d = 0; d < 3; d++) look[s->facet[f].node[j]][d] += s->facet[f].normal[d] * PetscSqr(s->facet[f].size);
}

/* How much a facet looks towards a slave's side at a foot: the cosine, its own normal times -look */
static PetscReal FootLooks(const ContactFacet *f, const PetscReal natural[2], const PetscReal look[3])
{
  PetscReal n[3];

  FacetNormal(f->n, (const double(*)[3])f->x, natural, n);
  (void)Vec3Normalise(n);
  return -Vec3Dot(n, look) / Vec3Length(look);
}

/* Moves a foot to that of the facets in the same distance which looks most towards the slave's side */
static PetscErrorCode FootTurn(const ContactSurface *master, const PetscReal x[3], const PetscReal look[3],
                               ContactFacetList *near, ContactFoot *foot)
{
  const ContactShape rest = {.surface = master};
  PetscReal          most, reach;

  PetscFunctionBeginUser;
  if (foot->facet < 0 || foot->across > FOLD_AT * master->facet[foot->facet].size) PetscFunctionReturn(0);
  most    = FootLooks(&master->facet[foot->facet], foot->natural, look);
  reach   = foot->distance + FOLD_AT * master->facet[foot->facet].size;
  near->n = 0;
  PetscCall(ContactFacetsNear(&rest, master->box, x, reach, near));
  for (PetscInt i = 0; i < near->n; i++) {
    ContactFoot there = {.facet = -1, .distance = PETSC_MAX_REAL};
    PetscReal   looks;

    ContactFootTry(&rest, near->facet[i], x, PETSC_MAX_REAL, &there);
    if (there.facet < 0 || there.distance > reach) continue;
    looks = FootLooks(&master->facet[there.facet], there.natural, look);
    if (looks < most + FOLD_AT) continue;
    most        = looks;
    foot->facet = there.facet;
    for (int d = 0; d < 2; d++) foot->natural[d] = there.natural[d];
    FacetShapeOf(master->facet[there.facet].n)->snap(foot->natural);
  }
  PetscFunctionReturn(0);
}

PetscErrorCode MortarFootFind(const ContactSurface *master, const PetscReal x[3], const PetscReal look[3],
                              ContactFacetList *near, ContactFoot *foot)
{
  PetscFunctionBeginUser;
  ContactFootFind(master, x, foot);
  PetscCall(FootTurn(master, x, look, near, foot));
  PetscFunctionReturn(0);
}

/* Appends the pairs of the other sides of this rank's slave nodes */
static PetscErrorCode PairsAppend(Contact contact, PetscInt first, const ContactSurface *slave)
{
  const PetscInt n = contact->n_pairs - first;
  PetscInt      *own, extra = slave->n_nodes - slave->n_sorted;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(slave->n_sorted, &own));
  for (PetscInt i = 0; i < slave->n_sorted; i++) own[i] = -1;
  PetscCall(PetscRealloc(sizeof(ContactPair) * (size_t)(contact->n_pairs + extra), &contact->pairs));
  PetscCall(PetscRealloc(sizeof(ContactPairFoot) * (size_t)(contact->n_pairs + extra), &contact->feet));
  for (PetscInt p = first; p < first + n; p++) {
    PetscInt at;

    PetscCall(PetscFindInt(contact->pairs[p].vertex, slave->n_sorted, slave->vertex, &at));
    PetscCheck(at >= 0, PETSC_COMM_SELF, PETSC_ERR_PLIB, "a pair's slave node is no node of the slave surface");
    contact->feet[p].place = at;
    own[at]                = p;
  }
  for (PetscInt k = slave->n_sorted; k < slave->n_nodes; k++) {
    PetscInt at;

    PetscCall(PetscFindInt(slave->vertex[k], slave->n_sorted, slave->vertex, &at));
    if (own[at] < 0) continue;
    contact->pairs[contact->n_pairs]        = contact->pairs[own[at]];
    contact->feet[contact->n_pairs]         = contact->feet[own[at]];
    contact->feet[contact->n_pairs++].place = k;
  }
  PetscCall(PetscFree(own));
  PetscFunctionReturn(0);
}

PetscErrorCode ContactMortarSplit(Contact contact, PetscInt interface, PetscInt first)
{
  ContactSurface  *master = &contact->surface[interface], slave = {0};
  ContactFacetList near = {0};
  PetscReal(*look)[3];

  PetscFunctionBeginUser;
  PetscCall(ContactSurfaceCreate(contact, contact->interfaces[interface].slave, &slave));
  PetscCall(MortarSplitSlave(&slave));
  PetscCall(PairsAppend(contact, first, &slave));
  PetscCall(MortarSplitMaster(master));
  PetscCall(PetscMalloc1(slave.n_nodes, &look));
  MortarPlacesLook(&slave, look);
  for (PetscInt p = first; p < contact->n_pairs && (master->folds || slave.n_nodes > slave.n_sorted); p++) {
    ContactPairFoot *at = &contact->feet[p];
    ContactFoot      foot;

    PetscCall(PetscArraycpy(at->normal, look[at->place], 3));
    PetscCall(MortarFootFind(master, contact->pairs[p].x, look[at->place], &near, &foot));
    ContactPairTakeFoot(&contact->interfaces[interface], master, &foot, &contact->pairs[p], at);
  }
  PetscCall(PetscFree(look));
  PetscCall(PetscFree(near.facet));
  PetscCall(ContactSurfaceDestroy(&slave));
  PetscFunctionReturn(0);
}

/* Whether a side of a slave node, which looks along a vector, lies on a master that looks towards it */
static PetscErrorCode SideTouches(const ContactSurface *master, const PetscReal x[3], const PetscReal look[3],
                                  PetscReal tolerance, ContactFacetList *near, PetscBool *touches)
{
  ContactFoot foot;

  PetscFunctionBeginUser;
  *touches = PETSC_FALSE;
  PetscCall(MortarFootFind(master, x, look, near, &foot));
  if (foot.facet < 0 || foot.across > FOLD_AT * master->facet[foot.facet].size) PetscFunctionReturn(0);
  if (foot.distance > tolerance) PetscFunctionReturn(0);
  if (FootLooks(&master->facet[foot.facet], foot.natural, look) > MORTAR_FOLD) *touches = PETSC_TRUE;
  PetscFunctionReturn(0);
}

PetscErrorCode ContactFoldCount(Contact contact, PetscInt interface, PetscInt *n)
{
  const ContactInterface *c     = &contact->interfaces[interface];
  ContactSurface          slave = {0};
  const ContactSurface   *master;
  ContactFacetList        near = {0};
  PetscInt               *sides;
  PetscReal(*look)[3];

  PetscFunctionBeginUser;
  *n = 0;
  PetscCall(ContactGetSurface(contact, interface, &master));
  PetscCall(ContactSurfaceCreate(contact, c->slave, &slave));
  PetscCall(MortarSplitSlave(&slave));
  PetscCall(PetscCalloc1(slave.n_sorted, &sides));
  PetscCall(PetscMalloc1(slave.n_nodes, &look));
  MortarPlacesLook(&slave, look);
  for (PetscInt f = 0; f < slave.n_facets && slave.n_nodes > slave.n_sorted; f++)
    for (int j = 0; j < slave.facet[f].n; j++) {
      const PetscInt place = slave.facet[f].node[j];
      PetscBool      touches;
      PetscInt       at;

      if (Vec3Length(look[place]) == 0) continue;
      PetscCall(PetscFindInt(slave.vertex[place], slave.n_sorted, slave.vertex, &at));
      PetscCall(SideTouches(master, slave.facet[f].x[j], look[place], c->tolerance, &near, &touches));
      for (int d = 0; d < 3; d++) look[place][d] = 0; /* each once */
      if (touches && ++sides[at] == 2) (*n)++;
    }
  PetscCall(PetscFree(sides));
  PetscCall(PetscFree(look));
  PetscCall(PetscFree(near.facet));
  PetscCall(ContactSurfaceDestroy(&slave));
  PetscFunctionReturn(0);
}
