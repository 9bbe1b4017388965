/*
   Layers whose thickness is given (material.h). A part is one where its outer faces across a direction n lie in pairs
   of parallel planes, all pairs as far apart as its volume over half of the area of these faces says. Where it is not
   given n is the direction in which most of its surface looks, the first eigenvector of

      sum over faces of a a' / |a|,   a the area vector.

   Other faces are its edge, which may be joined to nothing: what lies on a layer moves as it is, what is beside it
   would have to stretch.
*/
#include "modelimpl.h"
#include "base/algebra/vec3.h"
#include "base/process/fault.h"
#include "kernels/contact/facet.h"
#include <petscblaslapack.h>

#define LAYER_FLAT   1e-4  /* of the thickness: by how far nodes may be off the planes */
#define LAYER_ACROSS 0.5   /* cosine between n and the normal of a face above which it is no edge */
#define LAYER_AXIS   1e-12 /* components of n below are zero */
#define LAYER_THIN   1.5   /* the first eigenvalue over the second, below which the part is not thin */
#define LAYER_MAX    128   /* planes */

/* What is found of one part */
typedef struct {
  PetscReal area, volume; /* of the faces across n, m^2; m^3 */
  PetscInt  n;            /* planes */
  PetscReal plane[LAYER_MAX];
} LayerFound;

/* Area vector of a face, m^2 */
static void FaceArea(const ModelFaces *faces, const Mesh *mesh, PetscInt f, PetscReal area[3])
{
  const PetscInt *node;
  double          x[FACET_NODES][3], share[FACET_NODES][3];
  const int       n = (int)ModelFacesGet(faces, mesh, f, &node, x);

  FacetNodeNormals(n, (const double(*)[3])x, share);
  area[0] = area[1] = area[2] = 0;
  for (int i = 0; i < 3 * n; i++) area[i % 3] += share[i / 3][i % 3];
}

static PetscReal FaceAcross(const ModelFaces *faces, const Mesh *mesh, PetscInt f, const PetscReal n[3])
{
  PetscReal area[3];

  FaceArea(faces, mesh, f, area);
  return PetscAbsReal(Vec3Dot(area, n)) / Vec3Length(area);
}

/* The largest component of n positive, the first of those alike: LAPACK leaves the sign open */
static void LayerTurn(PetscReal n[3])
{
  int largest = 0;

  for (int d = 1; d < 3; d++)
    if (PetscAbsReal(n[d]) > PetscAbsReal(n[largest]) + LAYER_AXIS) largest = d;
  if (n[largest] < 0)
    for (int d = 0; d < 3; d++) n[d] = n[d] == 0 ? 0 : -n[d];
}

/* n; whether the part is thin along it */
static PetscErrorCode LayerFindNormal(const ModelFaces *faces, const Mesh *mesh, PetscReal normal[3], PetscBool *thin)
{
  PetscScalar  S[9] = {0}, work[32];
  PetscReal    w[3], area[3];
  PetscBLASInt n = 3, n_work = 32, info;

  PetscFunctionBeginUser;
  for (PetscInt f = 0; f < faces->n; f++) {
    PetscReal length;

    FaceArea(faces, mesh, f, area);
    length = Vec3Length(area);
    for (int k = 0; k < 9 && length > 0; k++) S[k] += area[k / 3] * area[k % 3] / length;
  }
  PetscCallBLAS("LAPACKsyev", LAPACKsyev_("V", "U", &n, S, &n, w, work, &n_work, &info));
  PetscCheck(!info, PETSC_COMM_SELF, PETSC_ERR_LIB, "LAPACK syev failed with %d", (int)info);
  for (int d = 0; d < 3; d++) normal[d] = PetscAbsReal(S[6 + d]) < LAYER_AXIS ? 0 : PetscRealPart(S[6 + d]);
  (void)Vec3Normalise(normal);
  LayerTurn(normal);
  *thin = w[2] > LAYER_THIN * w[1] ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(0);
}

/* Notes a height at which there are faces, where none is nearby */
static void LayerAddPlane(PetscReal height, PetscReal near, LayerFound *found)
{
  PetscInt i = 0;

  while (i < found->n && PetscAbsReal(found->plane[i] - height) > near) i++;
  if (i < found->n || found->n == LAYER_MAX) return;
  found->plane[found->n++] = height;
}

static PetscErrorCode LayerMeasure(Model model, PetscInt part, const ModelFaces *faces, Layer *layer, LayerFound *found)
{
  const Mesh *mesh = &model->mesh;

  PetscFunctionBeginUser;
  *found = (LayerFound){.n = 0};
  for (PetscInt c = 0; c < mesh->n_cells; c++) {
    const Element *element;
    PetscInt       nodes[ELEMENT_MAX_NODES];
    PetscReal      x[ELEMENT_MAX_DOFS], volume, jacobian;

    if (mesh->cell_part[c] != part) continue;
    PetscCall(ModelGetCell(model, c, &element, nodes, x));
    element->measure(element->solid, x, &volume, &jacobian);
    found->volume += volume;
  }
  for (PetscInt f = 0; f < faces->n; f++) {
    PetscReal area[3];

    FaceArea(faces, mesh, f, area);
    if (FaceAcross(faces, mesh, f, layer->normal) > LAYER_ACROSS)
      found->area += PetscAbsReal(Vec3Dot(area, layer->normal));
  }
  layer->mesh = found->area > 0 ? 2 * found->volume / found->area : 0;
  for (PetscInt f = 0; f < faces->n; f++) {
    const PetscInt *node;
    double          x[FACET_NODES][3];
    const PetscInt  n = ModelFacesGet(faces, mesh, f, &node, x);

    if (FaceAcross(faces, mesh, f, layer->normal) <= LAYER_ACROSS) continue;
    for (PetscInt i = 0; i < n; i++) LayerAddPlane(Vec3Dot(x[i], layer->normal), LAYER_FLAT * layer->mesh, found);
  }
  PetscFunctionReturn(0);
}

/* Whether the planes are pairs of the thickness */
static PetscErrorCode LayerIsFlat(const Layer *layer, LayerFound *found, PetscBool *flat)
{
  PetscFunctionBeginUser;
  *flat = found->n > 0 && found->n % 2 == 0 && found->n < LAYER_MAX ? PETSC_TRUE : PETSC_FALSE;
  PetscCall(PetscSortReal(found->n, found->plane));
  for (PetscInt i = 0; i + 1 < found->n; i += 2)
    if (PetscAbsReal(found->plane[i + 1] - found->plane[i] - layer->mesh) > 3 * LAYER_FLAT * layer->mesh)
      *flat = PETSC_FALSE;
  PetscFunctionReturn(0);
}

/* Whether a node at its edge, off its planes, belongs to another part too */
static PetscErrorCode LayerIsHeld(Model model, PetscInt part, const ModelFaces *faces, const Layer *layer,
                                  const LayerFound *found, PetscBool *held)
{
  const Mesh *mesh = &model->mesh;
  PetscBool  *other;

  PetscFunctionBeginUser;
  *held = PETSC_FALSE;
  PetscCall(PetscCalloc1(mesh->n_nodes, &other));
  for (PetscInt c = 0; c < mesh->n_cells; c++)
    for (PetscInt i = mesh->cell_first[c]; i < mesh->cell_first[c + 1] && mesh->cell_part[c] != part; i++)
      other[mesh->cell_node[i]] = PETSC_TRUE;
  for (PetscInt i = 0; i < faces->first[faces->n]; i++) {
    const PetscInt  node   = faces->node[i];
    const PetscReal height = Vec3Dot(&mesh->x[3 * node], layer->normal);
    PetscBool       inside = PETSC_TRUE;

    for (PetscInt k = 0; k < found->n; k++)
      if (PetscAbsReal(found->plane[k] - height) <= 2 * LAYER_FLAT * layer->mesh) inside = PETSC_FALSE;
    if (inside && other[node]) *held = PETSC_TRUE;
  }
  PetscCall(PetscFree(other));
  PetscFunctionReturn(0);
}

/* On rank 0, which has the mesh */
static PetscErrorCode LayerFind(Model model, PetscInt part, Layer *layer, Fault *fault)
{
  const char *name = model->scene.parts[part].name;
  ModelFaces  faces;
  LayerFound  found;
  PetscBool   flat, held, thin = PETSC_TRUE;

  PetscFunctionBeginUser;
  PetscCall(PartGetFaces(model, part, &faces));
  if (!layer->has_axis) PetscCall(LayerFindNormal(&faces, &model->mesh, layer->normal, &thin));
  PetscCall(LayerMeasure(model, part, &faces, layer, &found));
  PetscCall(LayerIsFlat(layer, &found, &flat));
  PetscCall(LayerIsHeld(model, part, &faces, layer, &found, &held));
  if (!thin)
    PetscCall(FaultNote(fault, PETSC_ERR_USER_INPUT,
                        "-%s_thickness %.6g: part %s is thin along no direction; give -%s_thickness_axis x,y,z", name,
                        (double)layer->thickness, name, name));
  else if (!flat)
    PetscCall(FaultNote(fault, PETSC_ERR_USER_INPUT,
                        "-%s_thickness %.6g needs flat layers of one thickness: the faces of part %s across %.4g,%.4g,"
                        "%.4g do not lie in pairs of planes %.6g apart (to %g of it); mesh it with this thickness",
                        name, (double)layer->thickness, name, (double)layer->normal[0], (double)layer->normal[1],
                        (double)layer->normal[2], (double)layer->mesh, LAYER_FLAT));
  else if (held)
    PetscCall(FaultNote(fault, PETSC_ERR_USER_INPUT,
                        "-%s_thickness %.6g: the edge of part %s shares nodes with another part, which would have to "
                        "stretch with it; mesh it with this thickness",
                        name, (double)layer->thickness, name));
  PetscCall(ModelFacesDestroy(&faces));
  PetscFunctionReturn(0);
}

PetscErrorCode LayersMeasure(Model model)
{
  Fault       fault = {0};
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(model->comm, &rank));
  for (PetscInt part = 0; part < model->scene.n_parts; part++) {
    Part     *p        = &model->scene.parts[part];
    PetscReal found[4] = {0};

    PetscCheck(p->layer.given || !p->layer.has_axis, model->comm, PETSC_ERR_USER_INPUT,
               "-%s_thickness_axis does nothing without -%s_thickness", p->name, p->name);
    if (!p->layer.given) continue;
    PetscCheck(!p->layer.has_axis || Vec3Normalise(p->layer.normal) > 0, model->comm, PETSC_ERR_USER_INPUT,
               "-%s_thickness_axis 0,0,0 is no direction", p->name);
    PetscCheck(!p->spin.given, model->comm, PETSC_ERR_USER_INPUT,
               "-%s_thickness %.6g and -%s_spin exclude each other: the stress of a spin is of the mesh as it is",
               p->name, (double)p->layer.thickness, p->name);
    if (!rank) PetscCall(LayerFind(model, part, &p->layer, &fault));
    PetscCall(FaultsRaise(model->comm, &fault));
    found[0] = p->layer.mesh;
    PetscCall(PetscArraycpy(&found[1], p->layer.normal, 3));
    PetscCallMPI(MPI_Bcast(found, 4, MPIU_REAL, 0, model->comm));
    p->layer.mesh = found[0];
    PetscCall(PetscArraycpy(p->layer.normal, &found[1], 3));
  }
  PetscFunctionReturn(0);
}
