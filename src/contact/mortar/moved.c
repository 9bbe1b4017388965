/*
   Mortar pairs of surfaces that have moved, in time: the integrals of mortar.c over copies of both surfaces at the
   places where they lie, the master in its own frame. All slave nodes are on one rank. Normals are those of the
   undeformed master (surface/surface.h) where the slave's places have their feet; a pair is there where the slave has
   enough of the master under it (border.c), as at rest.

   Facets of the master farther off than a facet's size are not seen, so that bodies in flight have no pairs.
*/
#include "mortarimpl.h"
#include "base/algebra/vec3.h"

PetscErrorCode ContactMovedCreate(Contact contact, PetscInt interface, ContactMoved *moved)
{
  const ContactInterface *c = &contact->interfaces[interface];

  PetscFunctionBeginUser;
  *moved = (ContactMoved){.c = c};
  PetscCall(ContactGetSurface(contact, interface, &moved->master));
  PetscCall(MortarSplitMaster(&contact->surface[interface]));
  PetscCall(ContactSurfaceCreate(contact, c->slave, &moved->slave));
  PetscCall(MortarSplitSlave(&moved->slave));
  PetscFunctionReturn(0);
}

/* A copy with its own facets, nodes and boxes */
static PetscErrorCode SurfaceCopy(const ContactSurface *rest, const PetscInt number[], ContactSurface *s)
{
  PetscFunctionBeginUser;
  *s = *rest;
  PetscCall(PetscMalloc1(s->n_facets, &s->facet));
  PetscCall(PetscMalloc1(s->n_nodes, &s->vertex));
  PetscCall(PetscMalloc1(s->n_facets, &s->order));
  PetscCall(PetscMalloc1(2 * s->n_facets, &s->box));
  PetscCall(PetscArraycpy(s->facet, rest->facet, s->n_facets));
  PetscCall(PetscArraycpy(s->vertex, number, s->n_nodes));
  PetscCall(PetscArraycpy(s->order, rest->order, s->n_facets));
  PetscCall(PetscArraycpy(s->box, rest->box, s->n_boxes));
  PetscFunctionReturn(0);
}

PetscErrorCode ContactMovedNumber(ContactMoved *moved, const PetscInt slave[], const PetscInt master[])
{
  PetscFunctionBeginUser;
  PetscCall(SurfaceCopy(&moved->slave, slave, &moved->here[0]));
  PetscCall(SurfaceCopy(moved->master, master, &moved->here[1]));
  PetscCall(PetscMalloc1(moved->slave.n_nodes, &moved->look));
  PetscFunctionReturn(0);
}

/* Nodes at rest and u [nodes][3]; normals of the master that say whether it is flat are those at rest */
static void SurfaceMove(const ContactSurface *rest, const PetscReal u[], ContactSurface *s)
{
  for (PetscInt f = 0; f < s->n_facets; f++) {
    ContactFacet *facet = &s->facet[f];

    for (int i = 0; i < facet->n; i++)
      for (int d = 0; d < 3; d++) facet->x[i][d] = rest->facet[f].x[i][d] + u[3 * facet->node[i] + d];
    FacetMiddleNormal(facet->n, (const double(*)[3])facet->x, facet->normal);
    facet->size = PetscSqrtReal(Vec3Normalise(facet->normal));
    facet->flat = PETSC_FALSE;
  }
  ContactBoxesFit(&(ContactShape){.surface = s}, s->box);
}

/* Places of the slave as pairs, with their feet */
static PetscErrorCode PlacesFind(ContactMoved *moved, ContactMovedPairs *pairs)
{
  const ContactSurface *slave = &moved->here[0], *master = &moved->here[1];

  PetscFunctionBeginUser;
  MortarPlacesLook(slave, moved->look);
  for (PetscInt f = 0; f < slave->n_facets; f++)
    for (int j = 0; j < slave->facet[f].n; j++) {
      const PetscInt   v    = slave->facet[f].node[j];
      ContactPair     *pair = &pairs->pair[v];
      ContactPairFoot *at   = &pairs->feet[v];
      ContactFoot      foot;

      if (at->facet != -2) continue;
      pair->vertex = slave->vertex[v];
      at->place    = v;
      PetscCall(PetscArraycpy(pair->x, slave->facet[f].x[j], 3));
      PetscCall(MortarFootFind(master, pair->x, moved->look[v], &moved->near, &foot));
      ContactPairTakeFoot(moved->c, master, &foot, pair, at);
    }
  PetscFunctionReturn(0);
}

PetscErrorCode ContactMovedFind(ContactMoved *moved, const PetscReal *const u[2], ContactMovedPairs *pairs)
{
  const PetscInt n = moved->slave.n_nodes;
  MortarPairs    m = {.n_pairs = n};

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc2(n, &pairs->pair, n, &pairs->feet));
  for (PetscInt v = 0; v < n; v++) pairs->feet[v].facet = -2;
  if (u[0]) SurfaceMove(&moved->slave, u[0], &moved->here[0]);
  if (u[1]) SurfaceMove(moved->master, u[1], &moved->here[1]);
  PetscCall(PlacesFind(moved, pairs));
  m.pair  = pairs->pair;
  m.feet  = pairs->feet;
  m.folds = moved->master->folds || moved->slave.n_nodes > moved->slave.n_sorted ? PETSC_TRUE : PETSC_FALSE;
  PetscCall(MortarPairsMake(PETSC_COMM_SELF, &moved->here[0], &moved->here[1], moved->c->tolerance, &m));
  pairs->sides = m.sides;
  moved->n_failed += m.mortar.n_failed;
  for (PetscInt v = 0; v < n; v++)
    if (pairs->feet[v].facet < 0 || pairs->pair[v].area < 0) pairs->pair[v].area = 0;
  PetscCall(MortarPairsDestroy(&m));
  PetscFunctionReturn(0);
}

PetscErrorCode ContactMovedPairsDestroy(ContactMovedPairs *pairs)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree2(pairs->pair, pairs->feet));
  PetscCall(PetscFree(pairs->sides));
  PetscFunctionReturn(0);
}

PetscErrorCode ContactMovedCheck(MPI_Comm comm, const ContactMoved *moved)
{
  const ContactInterface *c = moved->c;
  const MortarPairs       m = {.mortar = {.n_failed = moved->n_failed}};

  PetscFunctionBeginUser;
  PetscCall(MortarSumsCheck(comm, "contact", c->name, c->slave, c->master, &m));
  PetscFunctionReturn(0);
}

PetscErrorCode ContactMovedDestroy(ContactMoved *moved)
{
  PetscFunctionBeginUser;
  PetscCall(ContactSurfaceDestroy(&moved->slave));
  for (int i = 0; i < 2; i++) PetscCall(ContactSurfaceDestroy(&moved->here[i]));
  PetscCall(PetscFree(moved->look));
  PetscCall(PetscFree(moved->near.facet));
  PetscFunctionReturn(0);
}
