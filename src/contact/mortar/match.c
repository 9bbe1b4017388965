/*
   Whether two meshes match: every slave node over the master has its foot at a node of it, and every node of the master
   under the slave is such a foot. The second fails where the facets of the master divide those of the slave: the nodes
   between would carry nothing, and a uniform pressure not pass.

   A node of the master lies under the slave where its nearest point there lies within the border, on a facet that looks
   towards it, no farther off than the tolerance and MATCH_RISE of the facet's size: finer facets of one curve lie off
   the chord of coarser ones by a part theta / 8 of its length, theta the angle that it spans.
*/
#include "mortarimpl.h"
#include "base/algebra/vec3.h"

/* a foot at a node has a weight of 1 but for this: of a facet, far above rounding of places */
#define MATCH_NODE 1e-6
#define MATCH_RISE 0.1

/* Marks the nodes of the master that are feet, met[n_nodes] over all ranks; *between where some foot is at none */
static PetscErrorCode MatchFeet(Contact contact, PetscInt first, const ContactSurface *master, PetscBool met[],
                                PetscBool *between)
{
  PetscFunctionBeginUser;
  *between = PETSC_FALSE;
  for (PetscInt p = first; p < contact->n_pairs; p++) {
    const ContactPairFoot *foot = &contact->feet[p];
    PetscReal              most = 0;

    if (ContactFootIsOff(master, foot)) continue;
    for (int i = 0; i < master->facet[foot->facet].n; i++) {
      most = PetscMax(most, foot->weight[i]);
      if (foot->weight[i] >= 1 - MATCH_NODE) met[master->facet[foot->facet].node[i]] = PETSC_TRUE;
    }
    if (most < 1 - MATCH_NODE) *between = PETSC_TRUE;
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, between, 1, MPIU_BOOL, MPI_LOR, contact->comm));
  if (master->n_nodes)
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, met, (PetscMPIInt)master->n_nodes, MPIU_BOOL, MPI_LOR, contact->comm));
  PetscFunctionReturn(0);
}

/* Whether node i of a facet of the master lies under the slave */
static PetscBool NodeIsUnder(const ContactSurface *slave, const ContactFacet *facet, int i, PetscReal tolerance)
{
  const ContactFacet *over;
  ContactFoot         foot;

  ContactFootFind(slave, facet->x[i], &foot);
  if (foot.facet < 0 || foot.across > 0) return PETSC_FALSE;
  over = &slave->facet[foot.facet];
  return Vec3Dot(over->normal, facet->normal) < 0 && foot.distance <= tolerance + MATCH_RISE * over->size ? PETSC_TRUE
                                                                                                          : PETSC_FALSE;
}

/* Whether some node of the master under the slave is no foot. Both surfaces are on every rank; each rank looks at some
   facets. */
static PetscErrorCode MatchUnder(MPI_Comm comm, const ContactSurface *slave, const ContactSurface *master,
                                 PetscReal tolerance, const PetscBool met[], PetscBool *missed)
{
  PetscMPIInt rank, n_ranks;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  PetscCallMPI(MPI_Comm_size(comm, &n_ranks));
  *missed = PETSC_FALSE;
  for (PetscInt f = rank; f < master->n_facets && slave->n_facets && !*missed; f += n_ranks)
    for (int i = 0; i < master->facet[f].n; i++)
      if (!met[master->facet[f].node[i]] && NodeIsUnder(slave, &master->facet[f], i, tolerance)) *missed = PETSC_TRUE;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, missed, 1, MPIU_BOOL, MPI_LOR, comm));
  PetscFunctionReturn(0);
}

PetscErrorCode ContactMeshesMatch(Contact contact, PetscInt interface, PetscInt first, PetscBool *match)
{
  const ContactInterface *c     = &contact->interfaces[interface];
  ContactSurface          slave = {.n_facets = 0};
  const ContactSurface   *master;
  PetscBool              *met, fails;

  PetscFunctionBeginUser;
  PetscCall(ContactGetSurface(contact, interface, &master));
  PetscCall(PetscCalloc1(master->n_nodes, &met));
  PetscCall(MatchFeet(contact, first, master, met, &fails));
  if (!fails) {
    PetscCall(ContactSurfaceCreate(contact, c->slave, &slave));
    PetscCall(MatchUnder(contact->comm, &slave, master, c->tolerance, met, &fails));
    PetscCall(ContactSurfaceDestroy(&slave));
  }
  PetscCall(PetscFree(met));
  *match = fails ? PETSC_FALSE : PETSC_TRUE;
  PetscFunctionReturn(0);
}

/* Marks the nodes of the master that slaves of a tie follow alone, or that are nodes of both, met[n_nodes] over all
   ranks; *between where some slave follows several */
static PetscErrorCode MatchLinks(Contact contact, PetscInt first, const ContactSurface *slave,
                                 const ContactSurface *master, PetscBool met[], PetscBool *between)
{
  PetscInt at;

  PetscFunctionBeginUser;
  *between = PETSC_FALSE;
  for (PetscInt l = first; l < contact->n_links; l++) {
    const ContactLinkNode *most = &contact->links[l].master[0];

    for (PetscInt i = 1; i < contact->links[l].n_master; i++)
      if (contact->links[l].master[i].weight > most->weight) most = &contact->links[l].master[i];
    PetscCall(PetscFindInt(most->number, master->n_nodes, master->vertex, &at));
    if (most->weight < 1 - MATCH_NODE)
      *between = PETSC_TRUE;
    else
      met[at] = PETSC_TRUE;
  }
  for (PetscInt i = 0; i < slave->n_nodes; i++) {
    PetscCall(PetscFindInt(slave->vertex[i], master->n_nodes, master->vertex, &at));
    if (at >= 0) met[at] = PETSC_TRUE;
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, between, 1, MPIU_BOOL, MPI_LOR, contact->comm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, met, (PetscMPIInt)master->n_nodes, MPIU_BOOL, MPI_LOR, contact->comm));
  PetscFunctionReturn(0);
}

PetscErrorCode ContactTieMatches(Contact contact, PetscInt tie, PetscInt first, const ContactSurface *master,
                                 PetscBool *match)
{
  const ContactTie *t     = &contact->ties[tie];
  ContactSurface    slave = {.n_facets = 0};
  PetscBool        *met, fails;

  PetscFunctionBeginUser;
  PetscCall(ContactSurfaceCreate(contact, t->slave, &slave));
  PetscCall(PetscCalloc1(master->n_nodes, &met));
  PetscCall(MatchLinks(contact, first, &slave, master, met, &fails));
  if (!fails) PetscCall(MatchUnder(contact->comm, &slave, master, t->distance, met, &fails));
  PetscCall(PetscFree(met));
  PetscCall(ContactSurfaceDestroy(&slave));
  *match = fails ? PETSC_FALSE : PETSC_TRUE;
  PetscFunctionReturn(0);
}
