/*
   Named sets: vertices of a set and area-weighted normals of a surface, complete on every rank that has the vertex,
   also where the set's own faces live on another rank.
*/
#include "modelimpl.h"
#include "kernels/facet.h"
#include <petscsf.h>

/* The named sets of the mesh as "disc, pad", for messages; the same text on all ranks */
static PetscErrorCode SetListNames(DM dm, char list[], size_t size)
{
  PetscInt                 n;
  const char              *name;
  static const char *const own[] = {"depth", "celltype", "dim", NULL};

  PetscFunctionBeginUser;
  list[0] = 0;
  PetscCall(DMGetNumLabels(dm, &n));
  for (PetscInt i = 0; i < n; i++) {
    PetscBool skip = PETSC_FALSE;

    PetscCall(DMGetLabelName(dm, i, &name));
    for (const char *const *o = own; *o && !skip; o++) PetscCall(PetscStrcmp(name, *o, &skip));
    if (skip) continue;
    if (list[0]) PetscCall(PetscStrlcat(list, ", ", size));
    PetscCall(PetscStrlcat(list, name, size));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode ModelComplainSet(Model model, const char what[], const char name[])
{
  char list[1024];

  PetscFunctionBeginUser;
  PetscCall(SetListNames(model->dm, list, sizeof(list)));
  SETERRQ(model->comm, PETSC_ERR_USER_INPUT, "the mesh has no %s named '%s'; it names: %s", what, name, list);
}

/* Points of this rank that carry the label; NULL when there are none. An error when no rank has any. */
static PetscErrorCode SetGetPoints(Model model, const char set[], IS *points)
{
  DMLabel  label;
  PetscInt n = 0, n_all;

  PetscFunctionBeginUser;
  *points = NULL;
  PetscCall(DMGetLabel(model->dm, set, &label));
  if (label) PetscCall(DMLabelGetStratumIS(label, 1, points));
  if (*points) PetscCall(ISGetLocalSize(*points, &n));
  PetscCallMPI(MPI_Allreduce(&n, &n_all, 1, MPIU_INT, MPI_SUM, model->comm));
  if (!n_all) PetscCall(ModelComplainSet(model, "set", set));
  PetscFunctionReturn(0);
}

/* Marks (adds 1 to the first component of) every vertex in the closure of the points */
static PetscErrorCode MarkClosure(DM dm, IS points, PetscScalar mark[])
{
  const PetscInt *p;
  PetscInt        n, vStart, vEnd, n_closure, *closure = NULL;

  PetscFunctionBeginUser;
  PetscCall(DMPlexGetDepthStratum(dm, 0, &vStart, &vEnd));
  PetscCall(ISGetLocalSize(points, &n));
  PetscCall(ISGetIndices(points, &p));
  for (PetscInt i = 0; i < n; i++) {
    PetscCall(DMPlexGetTransitiveClosure(dm, p[i], PETSC_TRUE, &n_closure, &closure));
    for (PetscInt j = 0; j < n_closure; j++)
      if (closure[2 * j] >= vStart && closure[2 * j] < vEnd) mark[3 * (closure[2 * j] - vStart)] += 1;
    PetscCall(DMPlexRestoreTransitiveClosure(dm, p[i], PETSC_TRUE, &n_closure, &closure));
  }
  PetscCall(ISRestoreIndices(points, &p));
  PetscFunctionReturn(0);
}

PetscErrorCode ModelGetSetVertices(Model model, const char set[], IS *vertices)
{
  PetscScalar *mark;
  PetscInt     n = 0, *list;
  Vec          marks;
  IS           points;

  PetscFunctionBeginUser;
  PetscCall(SetGetPoints(model, set, &points));
  PetscCall(ModelCreateNodal(model, &marks));
  PetscCall(VecGetArray(marks, &mark));
  if (points) PetscCall(MarkClosure(model->dm, points, mark));
  PetscCall(VecRestoreArray(marks, &mark));
  PetscCall(ModelSumShared(model, marks));
  PetscCall(PetscMalloc1(model->mesh.n_vertices, &list));
  PetscCall(VecGetArray(marks, &mark));
  for (PetscInt v = 0; v < model->mesh.n_vertices; v++)
    if (PetscRealPart(mark[3 * v]) > 0) list[n++] = v;
  PetscCall(VecRestoreArray(marks, &mark));
  PetscCall(ISCreateGeneral(PETSC_COMM_SELF, n, list, PETSC_COPY_VALUES, vertices));
  PetscCall(PetscFree(list));
  PetscCall(VecDestroy(&marks));
  PetscCall(ISDestroy(&points));
  PetscFunctionReturn(0);
}

PetscErrorCode ModelGetOwnedVertices(Model model, const char set[], IS *vertices)
{
  const PetscInt *v;
  PetscInt        n, n_owned = 0, *owned;
  IS              all;

  PetscFunctionBeginUser;
  PetscCall(ModelGetSetVertices(model, set, &all));
  PetscCall(ISGetLocalSize(all, &n));
  PetscCall(ISGetIndices(all, &v));
  PetscCall(PetscMalloc1(n, &owned));
  for (PetscInt i = 0; i < n; i++)
    if (model->mesh.owned[v[i]]) owned[n_owned++] = v[i];
  PetscCall(ISRestoreIndices(all, &v));
  PetscCall(ISDestroy(&all));
  PetscCall(ISCreateGeneral(PETSC_COMM_SELF, n_owned, owned, PETSC_COPY_VALUES, vertices));
  PetscCall(PetscFree(owned));
  PetscFunctionReturn(0);
}

/* Reverses the corners of a face when they are clockwise seen from outside its cell */
static PetscErrorCode FaceOrient(Model model, PetscInt face, PetscInt corners[4])
{
  const PetscInt  n_nodes = model->scene.element->n_nodes;
  const PetscInt *cells;
  PetscInt        cStart, vertices[ELEMENT_MAX_NODES];
  PetscReal       cell_x[ELEMENT_MAX_DOFS], x[4][3], normal[3], outward[3] = {0, 0, 0}, side = 0;

  PetscFunctionBeginUser;
  PetscCall(DMPlexGetHeightStratum(model->dm, 0, &cStart, NULL));
  PetscCall(DMPlexGetSupport(model->dm, face, &cells));
  PetscCall(ModelGetCell(model, cells[0] - cStart, vertices, cell_x));
  for (int i = 0; i < 4; i++) PetscCall(PetscArraycpy(x[i], &model->mesh.x[3 * corners[i]], 3));
  for (int d = 0; d < 3; d++) {
    for (int i = 0; i < 4; i++) outward[d] += x[i][d] / 4;
    for (PetscInt i = 0; i < n_nodes; i++) outward[d] -= cell_x[3 * i + d] / (PetscReal)n_nodes;
  }
  FacetNormal((const double(*)[3])x, 0, 0, normal);
  for (int d = 0; d < 3; d++) side += normal[d] * outward[d];
  if (side < 0) {
    const PetscInt second = corners[1];

    corners[1] = corners[3];
    corners[3] = second;
  }
  PetscFunctionReturn(0);
}

PetscErrorCode ModelGetSetFaces(Model model, const char set[], ModelFaces *faces)
{
  const PetscInt *p;
  PetscInt        fStart, fEnd, vStart, vEnd, n_points = 0, n_closure, *closure = NULL, n_all;
  IS              points;

  PetscFunctionBeginUser;
  PetscCall(SetGetPoints(model, set, &points));
  PetscCall(DMPlexGetHeightStratum(model->dm, 1, &fStart, &fEnd));
  PetscCall(DMPlexGetDepthStratum(model->dm, 0, &vStart, &vEnd));
  if (points) PetscCall(ISGetLocalSize(points, &n_points));
  faces->n = 0;
  PetscCall(PetscMalloc2(n_points + 1, &faces->first, 4 * n_points, &faces->node));
  faces->first[0] = 0;
  if (points) PetscCall(ISGetIndices(points, &p));
  for (PetscInt i = 0; i < n_points; i++) {
    PetscInt *const face = &faces->node[faces->first[faces->n]], n_cells, k = 0;

    if (p[i] < fStart || p[i] >= fEnd) continue;
    PetscCall(DMPlexGetSupportSize(model->dm, p[i], &n_cells));
    if (!n_cells) continue;
    PetscCall(DMPlexGetTransitiveClosure(model->dm, p[i], PETSC_TRUE, &n_closure, &closure));
    for (PetscInt j = 0; j < n_closure; j++)
      if (closure[2 * j] >= vStart && closure[2 * j] < vEnd && k < 4) face[k++] = closure[2 * j] - vStart;
    PetscCall(DMPlexRestoreTransitiveClosure(model->dm, p[i], PETSC_TRUE, &n_closure, &closure));
    PetscCall(FaceOrient(model, p[i], face));
    faces->n++;
    faces->first[faces->n] = faces->first[faces->n - 1] + k;
  }
  if (points) PetscCall(ISRestoreIndices(points, &p));
  PetscCall(ISDestroy(&points));
  PetscCallMPI(MPI_Allreduce(&faces->n, &n_all, 1, MPIU_INT, MPI_SUM, model->comm));
  PetscCheck(n_all, model->comm, PETSC_ERR_USER_INPUT, "the set '%s' has no faces: a surface is needed", set);
  PetscFunctionReturn(0);
}

PetscErrorCode ModelFacesDestroy(ModelFaces *faces)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree2(faces->first, faces->node));
  PetscFunctionReturn(0);
}

PetscErrorCode ModelCountInnerFaces(Model model, const char set[], PetscInt *n)
{
  const PetscInt *p, *shared;
  PetscInt        fStart, fEnd, n_points = 0, n_shared, n_cells, place;
  PetscSF         sf;
  IS              points;

  PetscFunctionBeginUser;
  *n = 0;
  PetscCall(SetGetPoints(model, set, &points));
  PetscCall(DMPlexGetHeightStratum(model->dm, 1, &fStart, &fEnd));
  PetscCall(DMGetPointSF(model->dm, &sf));
  PetscCall(PetscSFGetGraph(sf, NULL, &n_shared, &shared, NULL)); /* points that another rank owns, ascending */
  if (points) PetscCall(ISGetLocalSize(points, &n_points));
  if (points) PetscCall(ISGetIndices(points, &p));
  for (PetscInt i = 0; i < n_points; i++) {
    if (p[i] < fStart || p[i] >= fEnd) continue;
    PetscCall(DMPlexGetSupportSize(model->dm, p[i], &n_cells));
    place = -1;
    if (n_cells == 1 && n_shared > 0) PetscCall(PetscFindInt(p[i], n_shared, shared, &place));
    *n += n_cells > 1 || place >= 0;
  }
  if (points) PetscCall(ISRestoreIndices(points, &p));
  PetscCall(ISDestroy(&points));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, n, 1, MPIU_INT, MPI_SUM, model->comm));
  PetscFunctionReturn(0);
}

PetscErrorCode ModelGetSetNormals(Model model, const char set[], PetscReal **area_normals)
{
  const PetscInt n = 3 * model->mesh.n_vertices;
  ModelFaces     faces;
  PetscScalar   *sum;
  Vec            sums;

  PetscFunctionBeginUser;
  PetscCall(ModelCreateNodal(model, &sums));
  PetscCall(ModelGetSetFaces(model, set, &faces));
  PetscCall(VecGetArray(sums, &sum));
  for (PetscInt f = 0; f < faces.n; f++) {
    const PetscInt *node = &faces.node[faces.first[f]];
    double          x[4][3], share[4][3];

    for (int i = 0; i < 4; i++) PetscCall(PetscArraycpy(x[i], &model->mesh.x[3 * node[i]], 3));
    FacetAreaNormals((const double(*)[3])x, share);
    for (int i = 0; i < 4; i++)
      for (int d = 0; d < 3; d++) sum[3 * node[i] + d] += share[i][d];
  }
  PetscCall(VecRestoreArray(sums, &sum));
  PetscCall(ModelFacesDestroy(&faces));
  PetscCall(ModelSumShared(model, sums));
  PetscCall(PetscMalloc1(n, area_normals));
  PetscCall(VecGetArray(sums, &sum));
  PetscCall(PetscArraycpy(*area_normals, sum, n));
  PetscCall(VecRestoreArray(sums, &sum));
  PetscCall(VecDestroy(&sums));
  PetscFunctionReturn(0);
}
