/* Places that are no nodes of the mesh, and follow a surface as the slaves of a tie do (tie.c) */
#include "tie.h"

PetscErrorCode ContactFollow(Contact contact, const char set[], PetscReal distance, PetscInt n, ContactFollower place[])
{
  ContactSurface surface = {0};

  PetscFunctionBeginUser;
  PetscCall(ContactSurfaceCreate(contact, set, &surface));
  for (PetscInt i = 0; i < n; i++) {
    ContactFollower    *at = &place[i];
    const ContactFacet *facet;
    ContactFoot         foot;
    PetscReal           arm[3];

    at->n_master = 0;
    ContactFootFind(&surface, at->x, &foot);
    if (foot.facet < 0) continue;
    facet   = &surface.facet[foot.facet];
    at->off = FootGetArm(facet, &foot, at->x, arm);
    if (at->off <= TieReach(distance, facet)) at->n_master = LinkSetMaster(&surface, &foot, arm, at->master);
  }
  PetscCall(ContactSurfaceDestroy(&surface));
  PetscFunctionReturn(0);
}
