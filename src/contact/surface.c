/*
   Facets of a master surface: corners, area vectors, neighbours across edges, size and flatness. All ranks have those
   of all, ordered by place (a surface is small beside its body).
*/
#include "contactimpl.h"
#include "base/gather.h"
#include "kernels/facet.h"
#include <stdlib.h>

PetscErrorCode ContactFacetsLocal(Model model, const char set[], PetscInt *n, ContactFacet **facets)
{
  const Mesh *mesh;
  PetscReal  *normals;
  ModelFaces  faces;

  PetscFunctionBeginUser;
  PetscCall(ModelGetMesh(model, &mesh));
  PetscCall(ModelGetSetNormals(model, set, &normals));
  PetscCall(ModelGetSetFaces(model, set, &faces));
  *n = faces.n;
  PetscCall(PetscCalloc1(*n, facets));
  for (PetscInt i = 0; i < 4 * *n; i++) {
    ContactFacet  *f = &(*facets)[i / 4];
    const PetscInt v = 3 * faces.node[i];

    PetscCall(PetscArraycpy(f->x[i % 4], &mesh->x[v], 3));
    PetscCall(PetscArraycpy(f->area[i % 4], &normals[v], 3));
    PetscCall(PetscArraycpy(f->unknowns[i % 4], &mesh->unknown[v], 3));
    f->node[i % 4] = mesh->number[faces.node[i]];
  }
  PetscCall(PetscFree(normals));
  PetscCall(ModelFacesDestroy(&faces));
  PetscFunctionReturn(0);
}

/* An edge of a facet, corners ascending */
typedef struct {
  PetscInt a, b, facet, edge;
} FacetEdge;

static int FacetEdgeCompare(const void *left, const void *right)
{
  const FacetEdge *x = (const FacetEdge *)left, *y = (const FacetEdge *)right;

  if (x->a != y->a) return x->a < y->a ? -1 : 1;
  if (x->b != y->b) return x->b < y->b ? -1 : 1;
  return (x->facet > y->facet) - (x->facet < y->facet);
}

/* Facets that share an edge become neighbours */
static PetscErrorCode SurfaceSetNeighbours(ContactSurface *s)
{
  FacetEdge *edge;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(4 * s->n_facets, &edge));
  for (PetscInt f = 0; f < s->n_facets; f++)
    for (PetscInt e = 0; e < 4; e++) {
      const PetscInt a = s->facet[f].node[e], b = s->facet[f].node[(e + 1) % 4];

      edge[4 * f + e]       = (FacetEdge){PetscMin(a, b), PetscMax(a, b), f, e};
      s->facet[f].beside[e] = -1;
    }
  qsort(edge, (size_t)(4 * s->n_facets), sizeof(FacetEdge), FacetEdgeCompare);
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
  const ContactFacet *f = (const ContactFacet *)left, *g = (const ContactFacet *)right;
  PetscReal           a[3], b[3];

  for (int d = 0; d < 3; d++) {
    a[d] = ContactFacetMiddle(f, d);
    b[d] = ContactFacetMiddle(g, d);
  }
  return ContactPlaceCompare(a, b);
}

/* Size and normal; flat where the facet's own normal and that of the surface differ from it by rounding alone at all
   corners */
static void FacetMeasure(ContactFacet *f)
{
  static const PetscReal corner[4][2] = {
    {-1, -1},
    {1,  -1},
    {1,  1 },
    {-1, 1 }
  };

  FacetNormal((const double(*)[3])f->x, 0, 0, f->normal);
  f->size = 2 * PetscSqrtReal(Vec3Normalise(f->normal));
  f->flat = PETSC_TRUE;
  for (int i = 0; i < 4; i++) {
    PetscReal own[3], mean[3] = {f->area[i][0], f->area[i][1], f->area[i][2]};

    FacetNormal((const double(*)[3])f->x, corner[i][0], corner[i][1], own);
    (void)Vec3Normalise(own);
    (void)Vec3Normalise(mean);
    for (int d = 0; d < 3; d++)
      if (PetscAbsReal(own[d] - f->normal[d]) > 1e-13 || PetscAbsReal(mean[d] - f->normal[d]) > 1e-13)
        f->flat = PETSC_FALSE;
  }
}

/* Nodes of a surface, ascending, and the places of the corners among them */
static PetscErrorCode SurfaceSetNodes(ContactSurface *s)
{
  PetscFunctionBeginUser;
  s->n_nodes = 4 * s->n_facets;
  PetscCall(PetscMalloc1(s->n_nodes, &s->vertex));
  for (PetscInt i = 0; i < s->n_nodes; i++) s->vertex[i] = s->facet[i / 4].node[i % 4];
  PetscCall(PetscSortRemoveDupsInt(&s->n_nodes, s->vertex));
  for (PetscInt i = 0; i < 4 * s->n_facets; i++) {
    PetscInt *node = &s->facet[i / 4].node[i % 4];

    PetscCall(PetscFindInt(*node, s->n_nodes, s->vertex, node));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode ContactSurfaceCreate(Contact contact, const char set[], ContactSurface *s)
{
  PetscInt      n_local;
  ContactFacet *local;

  PetscFunctionBeginUser;
  PetscCall(ContactFacetsLocal(contact->model, set, &n_local, &local));
  PetscCall(GatherRecords(contact->comm, n_local, sizeof(ContactFacet), local, &s->n_facets, &s->facet));
  PetscCall(PetscFree(local));
  qsort(s->facet, (size_t)s->n_facets, sizeof(ContactFacet), FacetCompare);
  for (PetscInt f = 0; f < s->n_facets; f++) {
    FacetMeasure(&s->facet[f]);
    s->size += s->facet[f].size / (PetscReal)s->n_facets;
  }
  PetscCall(SurfaceSetNodes(s));
  PetscCall(SurfaceSetNeighbours(s));
  PetscCall(ContactBoxesBuild(s));
  PetscFunctionReturn(0);
}

/* Raises the error for a node of a master where the faces around it cancel, so that it has no normal */
static PetscErrorCode MasterCheck(MPI_Comm comm, const ContactInterface *c, const ContactSurface *s)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < 4 * s->n_facets; i++) {
    const ContactFacet *f = &s->facet[i / 4];
    const PetscReal    *x = f->x[i % 4];

    PetscCheck(Vec3Length(f->area[i % 4]) > 1e-9 * PetscSqr(f->size), comm, PETSC_ERR_USER_INPUT,
               "contact %s: %s has no normal at %.6g, %.6g, %.6g m, where its faces look in opposite directions",
               c->name, c->master, (double)x[0], (double)x[1], (double)x[2]);
  }
  PetscFunctionReturn(0);
}

PetscErrorCode ContactGetSurface(Contact contact, PetscInt interface, const ContactSurface **surface)
{
  ContactSurface *s = &contact->surface[interface];

  PetscFunctionBeginUser;
  if (!s->facet) {
    PetscCall(ContactSurfaceCreate(contact, contact->interfaces[interface].master, s));
    PetscCall(MasterCheck(contact->comm, &contact->interfaces[interface], s));
  }
  *surface = s;
  PetscFunctionReturn(0);
}

PetscErrorCode ContactSurfaceDestroy(ContactSurface *s)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(s->facet));
  PetscCall(PetscFree(s->vertex));
  PetscCall(PetscFree(s->order));
  PetscCall(PetscFree(s->box));
  PetscFunctionReturn(0);
}
