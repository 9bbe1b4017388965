/*
   Candidates: the facets of the master that a slave may meet soon, those within a margin of it
   (contact/surface/search.c). Their nodes and all slaves are the active nodes.

   A search is due when some slave has moved by half a margin, relative to the mean motion of the active nodes of the
   master and what these move against each other:

      |d_s - d_s(search) - mean| > margin / 2 - max_i |u_i - u_i(search) - mean|,     all in the frame of the master, m

   A slave then has not yet left its candidates at the next step, since it moves by far less than half a facet in one.
   Nodes that are no candidates are unseen in between, so that a few of each master, the outermost ones along the
   axes, are always active and stand for them; but where no slave travels, since no search comes then.
*/
#include "projectorimpl.h"
#include "base/events.h"

/* mean sizes of the facets: larger ones have more candidates and active nodes a step, smaller ones more searches */
#define MARGIN 1.0

/* The nodes of live facets are active, and the outermost nodes of a surface along each axis where slaves travel */
static void MasterActivate(const ProjectorMaster *m, const ProjectorNodes *nodes, PetscBool stays,
                           PetscBool is_active[])
{
  const ContactSurface *s = m->surface;

  for (PetscInt f = 0; f < s->n_facets; f++)
    for (int i = 0; i < s->facet[f].n && m->live[f]; i++) is_active[m->node[s->facet[f].node[i]]] = PETSC_TRUE;
  for (int d = 0; d < 3 && !stays; d++) {
    PetscInt low = m->node[0], high = m->node[0];

    for (PetscInt i = 1; i < s->n_nodes; i++) {
      if (nodes->x[3 * m->node[i] + d] < nodes->x[3 * low + d]) low = m->node[i];
      if (nodes->x[3 * m->node[i] + d] > nodes->x[3 * high + d]) high = m->node[i];
    }
    is_active[low] = is_active[high] = PETSC_TRUE;
  }
}

static void MasterSee(ProjectorMaster *m, const PetscBool is_active[])
{
  m->n_seen = 0;
  for (PetscInt i = 0; i < m->surface->n_nodes; i++)
    if (is_active[m->node[i]]) m->seen[m->n_seen++] = m->node[i];
}

/* Candidates of one slave, k */
static PetscErrorCode CandidatesFind(ContactProjector p, PetscInt k, PetscReal reach, const PetscReal u[])
{
  const PetscInt     i = p->pair[k].interface, node = p->pair[k].slave;
  ProjectorMaster   *m     = &p->master[i];
  const ContactShape shape = {.surface = m->surface, .node = m->node, .u = u};
  PetscReal         *d     = &p->place[3 * k], x[3];

  PetscFunctionBeginUser;
  FrameDisplacement(&p->frame[i], &p->nodes.x[3 * node], &u[3 * node], d);
  for (int j = 0; j < 3; j++) x[j] = p->nodes.x[3 * node + j] + d[j];
  p->first_candidate[k] = p->candidates.n;
  PetscCall(ContactFacetsNear(&shape, m->box, x, reach * p->margin[i], &p->candidates));
  for (PetscInt c = p->first_candidate[k]; c < p->candidates.n; c++) m->live[p->candidates.facet[c]] = PETSC_TRUE;
  p->is_active[node] = PETSC_TRUE;
  PetscFunctionReturn(0);
}

PetscErrorCode ProjectorSearch(ContactProjector p, PetscReal t, PetscReal reach, const PetscReal u[])
{
  PetscFunctionBeginUser;
  PetscCall(EventBegin(EVENT_SEARCH));
  PetscCall(PetscArrayzero(p->is_active, p->share.n_nodes));
  for (PetscInt i = 0; i < p->n_interfaces; i++) {
    ProjectorMaster   *m     = &p->master[i];
    const ContactShape shape = {.surface = m->surface, .node = m->node, .u = u};

    ContactBoxesFit(&shape, m->box);
    PetscCall(PetscArrayzero(m->live, m->surface->n_facets));
    p->margin[i] = MARGIN * m->surface->size;
  }
  p->candidates.n = 0;
  for (PetscInt k = 0; k < p->n_pairs; k++) PetscCall(CandidatesFind(p, k, reach, u));
  for (PetscInt i = 0; i < p->n_interfaces; i++)
    if (MortarIsHere(p, i)) PetscCall(MortarActivate(p, i, reach * p->margin[i], u));
  p->first_candidate[p->n_pairs] = p->candidates.n;
  for (PetscInt i = 0; i < p->n_interfaces; i++)
    MasterActivate(&p->master[i], &p->nodes, SlidingStays(&p->sliding[i]), p->is_active);
  for (PetscInt i = 0; i < p->n_interfaces; i++) MasterSee(&p->master[i], p->is_active);
  PetscCall(PetscArraycpy(p->u_search, u, 3 * p->share.n_nodes));
  p->t_search = t;
  PetscCall(EventEnd(EVENT_SEARCH));
  PetscFunctionReturn(0);
}

/* Mean motion of the active nodes of a master since the search, and the largest deviation from it */
static PetscReal MasterMotion(const ContactProjector p, const ProjectorMaster *s, const PetscReal u[],
                              PetscReal mean[3])
{
  PetscReal largest = 0;

  for (int d = 0; d < 3; d++) mean[d] = 0;
  for (PetscInt i = 0; i < s->n_seen; i++)
    for (int d = 0; d < 3; d++) mean[d] += u[3 * s->seen[i] + d] - p->u_search[3 * s->seen[i] + d];
  for (int d = 0; d < 3; d++) mean[d] /= (PetscReal)s->n_seen;
  for (PetscInt i = 0; i < s->n_seen; i++) {
    PetscReal square = 0;

    for (int d = 0; d < 3; d++) square += PetscSqr(u[3 * s->seen[i] + d] - p->u_search[3 * s->seen[i] + d] - mean[d]);
    largest = PetscMax(largest, square);
  }
  return PetscSqrtReal(largest);
}

/* Pairs are ordered by interface (surface.c): limit and mean are found anew where the interface changes */
PetscBool ProjectorNeedsSearch(ContactProjector p, const PetscReal u[])
{
  PetscInt  interface = -1;
  PetscReal mean[3] = {0}, limit = 0;

  for (PetscInt k = 0; k < p->n_pairs; k++) {
    const PetscInt i = p->pair[k].interface, node = p->pair[k].slave;
    PetscReal      d[3], square                   = 0;

    if (i != interface) limit = 0.5 * p->margin[i] - MasterMotion(p, &p->master[i], u, mean);
    interface = i;
    FrameDisplacement(&p->frame[i], &p->nodes.x[3 * node], &u[3 * node], d);
    for (int j = 0; j < 3; j++) square += PetscSqr(d[j] - p->place[3 * k + j] - mean[j]);
    if (limit <= 0 || square > limit * limit) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}
