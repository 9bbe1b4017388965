/*
   Search: which facets of the master may a slave meet soon. Bounding volumes of the facets, a tree halved along the
   longest side of each box, made once of the undeformed surface; its boxes are enlarged and shrunk to the present
   places of the nodes when a search is due, from the leaves up. Candidates of a slave are the facets whose boxes are
   within a margin of it; their corners and all slaves are the active nodes.

   A search is due when some slave has moved by half a margin, relative to the mean motion of the active nodes of the
   master and what these move against each other. Nodes that are no candidates are unseen in between, so that a few of
   each master, the outermost ones along the axes, are always active and stand for them. All is in the frame of the
   master, in m.
*/
#include "projectorimpl.h"
#include "base/events.h"

#define LEAF       4   /* facets of a leaf, at most */
#define MARGIN     1.0 /* mean sizes of the facets */
#define MAX_LEVELS 64  /* of the tree, which is balanced */

/* Mean of the corners of a facet along one axis, times 4 */
static PetscReal FacetMiddle(const MasterFacet *f, int d)
{
  return (f->x[0][d] + f->x[2][d]) + (f->x[1][d] + f->x[3][d]);
}

/* Longest side of the box of the middles of facets order[0..n) */
static int LongestSide(const Surface *s, PetscInt n, const PetscInt order[])
{
  PetscReal low[3], high[3];
  int       longest = 0;

  for (int d = 0; d < 3; d++) low[d] = high[d] = FacetMiddle(&s->facet[order[0]], d);
  for (PetscInt i = 1; i < n; i++)
    for (int d = 0; d < 3; d++) {
      low[d]  = PetscMin(low[d], FacetMiddle(&s->facet[order[i]], d));
      high[d] = PetscMax(high[d], FacetMiddle(&s->facet[order[i]], d));
    }
  for (int d = 1; d < 3; d++)
    if (high[d] - low[d] > high[longest] - low[longest]) longest = d;
  return longest;
}

/* Bounds of facets order[first .. first + n) and all below it */
static PetscErrorCode BoxBuild(Surface *s, PetscInt first, PetscInt n)
{
  const PetscInt here = s->n_boxes++;
  PetscReal     *key;
  int            side;

  PetscFunctionBeginUser;
  s->box[here] = (Bounds){.first = first, .n = n};
  if (n <= LEAF) PetscFunctionReturn(0);
  side = LongestSide(s, n, &s->order[first]);
  PetscCall(PetscMalloc1(n, &key));
  for (PetscInt i = 0; i < n; i++) key[i] = FacetMiddle(&s->facet[s->order[first + i]], side);
  PetscCall(PetscSortRealWithArrayInt(n, key, &s->order[first]));
  PetscCall(PetscFree(key));
  PetscCall(BoxBuild(s, first, n / 2));
  s->box[here].right = s->n_boxes;
  PetscCall(BoxBuild(s, first + n / 2, n - n / 2));
  s->box[here].n = 0;
  PetscFunctionReturn(0);
}

PetscErrorCode SurfaceBuildBoxes(Surface *s)
{
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(s->n_facets, &s->order));
  PetscCall(PetscMalloc1(2 * s->n_facets, &s->box));
  for (PetscInt f = 0; f < s->n_facets; f++) s->order[f] = f;
  s->n_boxes = 0;
  PetscCall(BoxBuild(s, 0, s->n_facets));
  PetscFunctionReturn(0);
}

/* Grows a box to hold another one */
static void BoxGrow(Bounds *box, const PetscReal low[3], const PetscReal high[3])
{
  for (int d = 0; d < 3; d++) {
    box->low[d]  = PetscMin(box->low[d], low[d]);
    box->high[d] = PetscMax(box->high[d], high[d]);
  }
}

/* Boxes at displacements u of the nodes; children stand after their parents */
static void SurfaceFitBoxes(Surface *s, const PetscReal u[])
{
  for (PetscInt b = s->n_boxes - 1; b >= 0; b--) {
    Bounds *box = &s->box[b];

    for (int d = 0; d < 3; d++) {
      box->low[d]  = PETSC_MAX_REAL;
      box->high[d] = -PETSC_MAX_REAL;
    }
    for (PetscInt i = 4 * box->first; i < 4 * (box->first + box->n); i++) {
      const MasterFacet *f = &s->facet[s->order[i / 4]];
      PetscReal          x[3];

      for (int d = 0; d < 3; d++) x[d] = f->x[i % 4][d] + u[3 * f->node[i % 4] + d];
      BoxGrow(box, x, x);
    }
    if (box->n) continue;
    BoxGrow(box, s->box[b + 1].low, s->box[b + 1].high);
    BoxGrow(box, s->box[box->right].low, s->box[box->right].high);
  }
}

static PetscBool BoxIsNear(const Bounds *box, const PetscReal x[3], PetscReal margin)
{
  for (int d = 0; d < 3; d++)
    if (x[d] < box->low[d] - margin || x[d] > box->high[d] + margin) return PETSC_FALSE;
  return PETSC_TRUE;
}

/* Whether the box of one facet is near */
static PetscBool FacetIsNear(const MasterFacet *f, const PetscReal u[], const PetscReal x[3], PetscReal margin)
{
  Bounds box = {
    .low  = {PETSC_MAX_REAL,  PETSC_MAX_REAL,  PETSC_MAX_REAL },
    .high = {-PETSC_MAX_REAL, -PETSC_MAX_REAL, -PETSC_MAX_REAL}
  };

  for (int i = 0; i < 4; i++) {
    PetscReal corner[3];

    for (int d = 0; d < 3; d++) corner[d] = f->x[i][d] + u[3 * f->node[i] + d];
    BoxGrow(&box, corner, corner);
  }
  return BoxIsNear(&box, x, margin);
}

/* Appends a candidate */
static PetscErrorCode CandidateAppend(ContactProjector p, PetscInt *n, PetscInt facet)
{
  PetscFunctionBeginUser;
  if (*n == p->max_candidates) {
    p->max_candidates = 2 * p->max_candidates + 64;
    PetscCall(PetscRealloc(sizeof(PetscInt) * (size_t)p->max_candidates, &p->candidate));
  }
  p->candidate[(*n)++] = facet;
  PetscFunctionReturn(0);
}

/* Appends the facets near x, ascending */
static PetscErrorCode SurfaceFind(ContactProjector p, Surface *s, const PetscReal u[], const PetscReal x[3],
                                  PetscReal margin, PetscInt *n)
{
  PetscInt       stack[MAX_LEVELS], depth = 0;
  const PetscInt before = *n;

  PetscFunctionBeginUser;
  stack[depth++] = 0;
  while (depth > 0) {
    const PetscInt b   = stack[--depth];
    const Bounds  *box = &s->box[b];

    if (!BoxIsNear(box, x, margin)) continue;
    if (!box->n) {
      stack[depth++] = box->right;
      stack[depth++] = b + 1;
    }
    for (PetscInt i = box->first; i < box->first + box->n; i++)
      if (FacetIsNear(&s->facet[s->order[i]], u, x, margin)) PetscCall(CandidateAppend(p, n, s->order[i]));
  }
  PetscCall(PetscSortInt(*n - before, &p->candidate[before]));
  PetscFunctionReturn(0);
}

/* The outermost nodes of a surface along each axis are active, and the corners of live facets */
static void SurfaceActivate(const Surface *s, const Nodes *nodes, PetscBool is_active[])
{
  for (PetscInt f = 0; f < s->n_facets; f++)
    for (int i = 0; i < 4 && s->live[f]; i++) is_active[s->facet[f].node[i]] = PETSC_TRUE;
  for (int d = 0; d < 3; d++) {
    PetscInt low = s->node[0], high = s->node[0];

    for (PetscInt i = 1; i < s->n_nodes; i++) {
      if (nodes->x[3 * s->node[i] + d] < nodes->x[3 * low + d]) low = s->node[i];
      if (nodes->x[3 * s->node[i] + d] > nodes->x[3 * high + d]) high = s->node[i];
    }
    is_active[low] = is_active[high] = PETSC_TRUE;
  }
}

static void SurfaceSee(Surface *s, const PetscBool is_active[])
{
  s->n_seen = 0;
  for (PetscInt i = 0; i < s->n_nodes; i++)
    if (is_active[s->node[i]]) s->seen[s->n_seen++] = s->node[i];
}

PetscErrorCode ProjectorSearch(ContactProjector p, PetscReal t, PetscReal reach, const PetscReal u[])
{
  PetscInt n = 0;

  PetscFunctionBeginUser;
  PetscCall(EventBegin(EVENT_SEARCH));
  PetscCall(PetscArrayzero(p->is_active, p->share.n_nodes));
  for (PetscInt i = 0; i < p->n_interfaces; i++) {
    SurfaceFitBoxes(&p->surface[i], u);
    PetscCall(PetscArrayzero(p->surface[i].live, p->surface[i].n_facets));
    p->margin[i] = MARGIN * p->surface[i].size;
  }
  for (PetscInt k = 0; k < p->n_pairs; k++) {
    const PetscInt i = p->pair[k].interface, node = p->pair[k].slave;
    PetscReal     *d = &p->place[3 * k], x[3];

    FrameDisplacement(&p->frame[i], &p->nodes.x[3 * node], &u[3 * node], d);
    for (int j = 0; j < 3; j++) x[j] = p->nodes.x[3 * node + j] + d[j];
    p->first_candidate[k] = n;
    PetscCall(SurfaceFind(p, &p->surface[i], u, x, reach * p->margin[i], &n));
    for (PetscInt c = p->first_candidate[k]; c < n; c++) p->surface[i].live[p->candidate[c]] = PETSC_TRUE;
    p->is_active[node] = PETSC_TRUE;
  }
  p->first_candidate[p->n_pairs] = n;
  for (PetscInt i = 0; i < p->n_interfaces; i++) SurfaceActivate(&p->surface[i], &p->nodes, p->is_active);
  for (PetscInt i = 0; i < p->n_interfaces; i++) SurfaceSee(&p->surface[i], p->is_active);
  PetscCall(PetscArraycpy(p->u_search, u, 3 * p->share.n_nodes));
  p->t_search = t;
  PetscCall(EventEnd(EVENT_SEARCH));
  PetscFunctionReturn(0);
}

/* Mean motion of the active nodes of a master since the search, and the largest deviation from it */
static PetscReal SurfaceMotion(const ContactProjector p, const Surface *s, const PetscReal u[], PetscReal mean[3])
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

PetscBool ProjectorNeedsSearch(ContactProjector p, const PetscReal u[])
{
  PetscInt  interface = -1;
  PetscReal mean[3], limit = 0;

  for (PetscInt k = 0; k < p->n_pairs; k++) {
    const PetscInt i = p->pair[k].interface, node = p->pair[k].slave;
    PetscReal      d[3], square                   = 0;

    if (i != interface) limit = 0.5 * p->margin[i] - SurfaceMotion(p, &p->surface[i], u, mean);
    interface = i;
    FrameDisplacement(&p->frame[i], &p->nodes.x[3 * node], &u[3 * node], d);
    for (int j = 0; j < 3; j++) square += PetscSqr(d[j] - p->place[3 * k + j] - mean[j]);
    if (limit <= 0 || square > limit * limit) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}
