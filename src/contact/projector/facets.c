/*
   Facets of a master surface: corners by the numbers of the nodes, neighbours across edges, size and normal. All ranks
   have those of all, ordered by place.
*/
#include "projectorimpl.h"
#include "base/gather.h"
#include "kernels/facet.h"
#include <stdlib.h>

/* An edge of a facet, corners ascending */
typedef struct {
  PetscInt a, b, facet, edge;
} Edge;

static int EdgeCompare(const void *left, const void *right)
{
  const Edge *x = (const Edge *)left, *y = (const Edge *)right;

  if (x->a != y->a) return x->a < y->a ? -1 : 1;
  if (x->b != y->b) return x->b < y->b ? -1 : 1;
  return (x->facet > y->facet) - (x->facet < y->facet);
}

/* Facets that share an edge become neighbours */
static PetscErrorCode SurfaceSetNeighbours(Surface *s)
{
  Edge *edge;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(4 * s->n_facets, &edge));
  for (PetscInt f = 0; f < s->n_facets; f++)
    for (PetscInt e = 0; e < 4; e++) {
      const PetscInt a = s->facet[f].node[e], b = s->facet[f].node[(e + 1) % 4];

      edge[4 * f + e]       = (Edge){PetscMin(a, b), PetscMax(a, b), f, e};
      s->facet[f].beside[e] = -1;
    }
  qsort(edge, (size_t)(4 * s->n_facets), sizeof(Edge), EdgeCompare);
  for (PetscInt i = 0; i + 1 < 4 * s->n_facets; i++) {
    if (edge[i].a != edge[i + 1].a || edge[i].b != edge[i + 1].b) continue;
    s->facet[edge[i].facet].beside[edge[i].edge]         = edge[i + 1].facet;
    s->facet[edge[i + 1].facet].beside[edge[i + 1].edge] = edge[i].facet;
  }
  PetscCall(PetscFree(edge));
  PetscFunctionReturn(0);
}

/* By the sum of the corners, so that the order does not depend on the ranks */
static int FacetCompare(const void *left, const void *right)
{
  const Facet *f = (const Facet *)left, *g = (const Facet *)right;
  PetscReal    a[3], b[3];

  for (int d = 0; d < 3; d++) {
    a[d] = (f->x[0][d] + f->x[2][d]) + (f->x[1][d] + f->x[3][d]);
    b[d] = (g->x[0][d] + g->x[2][d]) + (g->x[1][d] + g->x[3][d]);
  }
  return PlaceCompare(a, b);
}

/* Size and normal; flat where those of the corners differ from it by rounding alone */
static void FacetMeasure(MasterFacet *f)
{
  static const PetscReal corner[4][2] = {
    {-1, -1},
    {1,  -1},
    {1,  1 },
    {-1, 1 }
  };
  PetscReal length;

  FacetNormal((const double(*)[3])f->x, 0, 0, f->normal);
  length  = PetscSqrtReal(PetscSqr(f->normal[0]) + PetscSqr(f->normal[1]) + PetscSqr(f->normal[2]));
  f->size = 2 * PetscSqrtReal(length);
  f->flat = PETSC_TRUE;
  for (int d = 0; d < 3; d++) f->normal[d] /= length;
  for (int i = 0; i < 4; i++) {
    PetscReal n[3];

    FacetNormal((const double(*)[3])f->x, corner[i][0], corner[i][1], n);
    length = PetscSqrtReal(PetscSqr(n[0]) + PetscSqr(n[1]) + PetscSqr(n[2]));
    for (int d = 0; d < 3; d++)
      if (PetscAbsReal(n[d] / length - f->normal[d]) > 1e-13) f->flat = PETSC_FALSE;
  }
}

/* Facets with the numbers of the nodes */
static PetscErrorCode SurfaceSetFacets(Contact contact, const char set[], PetscInt n_nodes, const PetscInt number[],
                                       Surface *s)
{
  PetscInt n_local;
  Facet   *local, *all;

  PetscFunctionBeginUser;
  PetscCall(FacetsLocal(contact->model, set, &n_local, &local));
  PetscCall(GatherRecords(contact->comm, n_local, sizeof(Facet), local, &s->n_facets, &all));
  PetscCall(PetscFree(local));
  qsort(all, (size_t)s->n_facets, sizeof(Facet), FacetCompare);
  PetscCall(PetscMalloc1(s->n_facets, &s->facet));
  PetscCall(PetscCalloc1(s->n_facets, &s->live));
  s->size = 0;
  for (PetscInt f = 0; f < s->n_facets; f++) {
    MasterFacet *m = &s->facet[f];

    PetscCall(PetscArraycpy(&m->x[0][0], &all[f].x[0][0], 12));
    for (int i = 0; i < 4; i++) PetscCall(PetscFindInt(all[f].vertex[i], n_nodes, number, &m->node[i]));
    FacetMeasure(m);
    s->size += m->size / (PetscReal)s->n_facets;
  }
  PetscCall(PetscFree(all));
  PetscFunctionReturn(0);
}

/* Nodes of a surface, ascending */
static PetscErrorCode SurfaceSetNodes(Surface *s)
{
  PetscFunctionBeginUser;
  s->n_nodes = 4 * s->n_facets;
  PetscCall(PetscMalloc1(s->n_nodes, &s->node));
  for (PetscInt i = 0; i < s->n_nodes; i++) s->node[i] = s->facet[i / 4].node[i % 4];
  PetscCall(PetscSortRemoveDupsInt(&s->n_nodes, s->node));
  PetscCall(PetscMalloc1(s->n_nodes, &s->seen));
  PetscFunctionReturn(0);
}

PetscErrorCode MasterCreate(Contact contact, const char set[], PetscInt n_nodes, const PetscInt number[], Surface *s)
{
  PetscFunctionBeginUser;
  PetscCall(SurfaceSetFacets(contact, set, n_nodes, number, s));
  PetscCall(SurfaceSetNeighbours(s));
  PetscCall(SurfaceSetNodes(s));
  PetscCall(SurfaceBuildBoxes(s));
  PetscFunctionReturn(0);
}

PetscErrorCode MasterDestroy(Surface *s)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(s->facet));
  PetscCall(PetscFree(s->live));
  PetscCall(PetscFree(s->node));
  PetscCall(PetscFree(s->seen));
  PetscCall(PetscFree(s->order));
  PetscCall(PetscFree(s->box));
  PetscFunctionReturn(0);
}
