/* The radiating surface as points of the quadrature of its faces */
#include "soundimpl.h"
#include "base/algebra/vec3.h"
#include "kernels/contact/facet.h"

/* Surfaces of contacts and ties, of which names are borrowed; the caller frees the list */
static PetscErrorCode SoundGetCovered(Sound sound, PetscInt *n, const char ***set)
{
  const ContactInterface *interface;
  const ContactTie       *tie;
  PetscInt                n_interfaces, n_ties, k = 0;

  PetscFunctionBeginUser;
  PetscCall(ContactGetInterfaces(sound->contact, &n_interfaces, &interface));
  PetscCall(ContactGetTies(sound->contact, &n_ties, &tie));
  *n = 2 * (n_interfaces + n_ties);
  PetscCall(PetscMalloc1(*n, set));
  for (PetscInt i = 0; i < n_interfaces; i++) {
    (*set)[k++] = interface[i].slave;
    (*set)[k++] = interface[i].master;
  }
  for (PetscInt i = 0; i < n_ties; i++) {
    (*set)[k++] = tie[i].slave;
    (*set)[k++] = tie[i].master;
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode SurfaceAllocate(PetscInt n, PetscInt n_nodes, SoundSurface *s)
{
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc4(n + 1, &s->first, n_nodes, &s->node, 3 * n_nodes, &s->row, n, &s->part));
  PetscCall(PetscMalloc3(3 * n, &s->x, 3 * n, &s->normal, n, &s->area));
  s->n        = 0;
  s->first[0] = 0;
  PetscFunctionReturn(0);
}

/* Appends the points of a face */
static void SurfaceAddFace(SoundSurface *s, const Mesh *mesh, const ModelFaces *faces, PetscInt f, PetscInt part,
                           PetscReal metre)
{
  const PetscInt   *node;
  double            x[FACET_NODES][3], w[FACET_NODES], area[3];
  const int         n     = (int)ModelFacesGet(faces, mesh, f, &node, x);
  const FacetShape *shape = FacetShapeOf(n);

  for (int q = 0; q < shape->n_points; q++) {
    const PetscInt p = s->n++, k = s->first[p];

    FacetWeights(n, shape->point[q], w);
    FacetSum(n, w, (const double(*)[3])x, &s->x[3 * p]);
    FacetNormal(n, (const double(*)[3])x, shape->point[q], area);
    s->area[p] = metre * metre * shape->point[q][2] * Vec3Length(area);
    Vec3Normalise(area);
    s->part[p] = part;
    for (int d = 0; d < 3; d++) s->normal[3 * p + d] = area[d];
    for (int d = 0; d < 3; d++) s->x[3 * p + d] *= metre;
    for (int i = 0; i < n; i++) {
      s->node[k + i] = node[i];
      for (int d = 0; d < 3; d++) s->row[3 * (k + i) + d] = metre * w[i] * area[d];
    }
    s->first[p + 1] = k + n;
  }
}

PetscErrorCode SoundSurfaceCreate(Sound sound, SoundSurface *surface)
{
  const Mesh  *mesh;
  ModelFaces  *faces;
  const char **covered;
  PetscInt     n_covered, n = 0, n_nodes = 0;

  PetscFunctionBeginUser;
  PetscCall(ModelGetMesh(sound->model, &mesh));
  PetscCall(SoundGetCovered(sound, &n_covered, &covered));
  PetscCall(PetscMalloc1(mesh->n_parts, &faces));
  for (PetscInt part = 0; part < mesh->n_parts; part++) {
    PetscCall(ModelGetOuterFaces(sound->model, part, n_covered, covered, &faces[part]));
    for (PetscInt f = 0; f < faces[part].n; f++) {
      const PetscInt size = faces[part].first[f + 1] - faces[part].first[f];

      n += FacetShapeOf((int)size)->n_points;
      n_nodes += size * FacetShapeOf((int)size)->n_points;
    }
  }
  PetscCall(SurfaceAllocate(n, n_nodes, surface));
  for (PetscInt part = 0; part < mesh->n_parts; part++) {
    for (PetscInt f = 0; f < faces[part].n; f++) SurfaceAddFace(surface, mesh, &faces[part], f, part, sound->metre);
    PetscCall(ModelFacesDestroy(&faces[part]));
  }
  PetscCall(PetscFree(faces));
  PetscCall(PetscFree(covered));
  PetscFunctionReturn(0);
}

PetscErrorCode SoundSurfaceDestroy(SoundSurface *s)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree4(s->first, s->node, s->row, s->part));
  PetscCall(PetscFree3(s->x, s->normal, s->area));
  PetscFunctionReturn(0);
}

PetscReal SoundSurfaceNormal(const SoundSurface *s, PetscInt q, const PetscReal v[])
{
  PetscReal sum = 0;

  for (PetscInt k = s->first[q]; k < s->first[q + 1]; k++) sum += Vec3Dot(&s->row[3 * k], &v[3 * s->node[k]]);
  return sum;
}

PetscReal SoundSurfaceDistance(const SoundSurface *s, PetscInt q, const PetscReal x[3])
{
  const PetscReal *y = &s->x[3 * q], R[3] = {x[0] - y[0], x[1] - y[1], x[2] - y[2]};

  return Vec3Dot(R, &s->normal[3 * q]) > 0 ? Vec3Length(R) : -Vec3Length(R);
}
