/*
   Facets of a master surface: corners, area vectors, neighbours across edges, size and flatness. All ranks have those
   of all, ordered by place (a surface is small beside its body: n_facets of the order of n_nodes^(2/3)), so that a
   foot is found without an exchange, and the same facet by every rank.

      a_i = sum_f int_f N_i n dA  (m^2) over the facets f around node i (kernels/contact/facet.h)
      size = sqrt(|area vector of the facet's middle|), m
*/
#include "contact/contactimpl.h"
#include "base/gather.h"
#include "base/algebra/vec3.h"
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
  for (PetscInt k = 0; k < *n; k++) {
    ContactFacet   *f = &(*facets)[k];
    const PetscInt *node;

    f->n = (int)ModelFacesGet(&faces, mesh, k, &node, f->x);
    for (int i = 0; i < f->n; i++) {
      PetscCall(PetscArraycpy(f->across[i], &normals[3 * node[i]], 3));
      PetscCall(PetscArraycpy(f->unknowns[i], &mesh->unknown[3 * node[i]], 3));
      f->node[i] = mesh->number[node[i]];
      /* of second order: area vectors of corners and sides differ in length, and would leave n of first order
         (surface.h) */
      if (ContactFacetCorners(f) < f->n) (void)Vec3Normalise(f->across[i]);
    }
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

/* Facets that share an edge, by its corners, become neighbours. All edges are sorted by their corners: the two of one
   edge stand side by side. Of three facets at one edge, a branching surface, the middle one keeps the last: a walk
   takes one way. */
static PetscErrorCode SurfaceSetNeighbours(ContactSurface *s)
{
  FacetEdge *edge;
  PetscInt   n = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(4 * s->n_facets, &edge));
  for (PetscInt f = 0; f < s->n_facets; f++) {
    const int corners = ContactFacetCorners(&s->facet[f]);

    for (int e = 0; e < corners; e++) {
      const PetscInt a = s->facet[f].node[e], b = s->facet[f].node[(e + 1) % corners];

      edge[n++]             = (FacetEdge){PetscMin(a, b), PetscMax(a, b), f, e};
      s->facet[f].beside[e] = -1;
    }
  }
  if (n) qsort(edge, (size_t)n, sizeof(FacetEdge), FacetEdgeCompare);
  for (PetscInt i = 0; i + 1 < n; i++) {
    if (edge[i].a != edge[i + 1].a || edge[i].b != edge[i + 1].b) continue;
    s->facet[edge[i].facet].beside[edge[i].edge]         = edge[i + 1].facet;
    s->facet[edge[i + 1].facet].beside[edge[i + 1].edge] = edge[i].facet;
  }
  PetscCall(PetscFree(edge));
  PetscFunctionReturn(0);
}

/* By the sum of the corners, which has the same bits from whichever corner a rank counts (ContactFacetMiddle()), so
   that the order does not depend on the ranks */
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

/* Size and normal; flat where the facet's own normal and that of the surface differ from it by rounding alone (1e-13
   of unit vectors) at all nodes. On a flat facet n is one vector, and the foot is linear or bilinear in x. */
void ContactFacetMeasure(ContactFacet *f)
{
  const FacetShape *shape = FacetShapeOf(f->n);

  FacetMiddleNormal(f->n, (const double(*)[3])f->x, f->normal);
  f->size = PetscSqrtReal(Vec3Normalise(f->normal));
  f->flat = PETSC_TRUE;
  for (int i = 0; i < f->n; i++) {
    PetscReal own[3], mean[3] = {f->across[i][0], f->across[i][1], f->across[i][2]};

    FacetNormal(f->n, (const double(*)[3])f->x, shape->node[i], own);
    (void)Vec3Normalise(own);
    (void)Vec3Normalise(mean);
    for (int d = 0; d < 3; d++)
      if (PetscAbsReal(own[d] - f->normal[d]) > 1e-13 || PetscAbsReal(mean[d] - f->normal[d]) > 1e-13)
        f->flat = PETSC_FALSE;
  }
}

/* Nodes of a surface, ascending, and the places of those of the facets among them */
static PetscErrorCode SurfaceSetNodes(ContactSurface *s)
{
  PetscFunctionBeginUser;
  for (PetscInt f = 0; f < s->n_facets; f++) s->n_nodes += s->facet[f].n;
  PetscCall(PetscMalloc1(s->n_nodes, &s->vertex));
  s->n_nodes = 0;
  for (PetscInt f = 0; f < s->n_facets; f++)
    for (int i = 0; i < s->facet[f].n; i++) s->vertex[s->n_nodes++] = s->facet[f].node[i];
  PetscCall(PetscSortRemoveDupsInt(&s->n_nodes, s->vertex));
  for (PetscInt f = 0; f < s->n_facets; f++)
    for (int i = 0; i < s->facet[f].n; i++) {
      PetscInt *node = &s->facet[f].node[i];

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
  if (s->n_facets) qsort(s->facet, (size_t)s->n_facets, sizeof(ContactFacet), FacetCompare);
  for (PetscInt f = 0; f < s->n_facets; f++) {
    ContactFacetMeasure(&s->facet[f]);
    s->size += s->facet[f].size / (PetscReal)s->n_facets;
  }
  PetscCall(SurfaceSetNodes(s));
  s->n_sorted = s->n_nodes;
  PetscCall(SurfaceSetNeighbours(s));
  PetscCall(ContactBoxesBuild(s));
  PetscFunctionReturn(0);
}

/* Raises the error for a node of a master where the faces around it cancel, |a_i| below 1e-9 of a facet's area, so
   that it has no normal: both sides of a sheet in one set. All ranks have the same facets, and fail together. */
static PetscErrorCode MasterCheck(MPI_Comm comm, const ContactInterface *c, const ContactSurface *s)
{
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < s->n_facets; k++)
    for (int i = 0; i < s->facet[k].n; i++) {
      const ContactFacet *f = &s->facet[k];
      const PetscReal    *x = f->x[i];

      PetscCheck(Vec3Length(f->across[i]) > 1e-9 * PetscSqr(f->size), comm, PETSC_ERR_USER_INPUT,
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
    s->overhang = contact->interfaces[interface].overhang;
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
