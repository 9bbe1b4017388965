/*
   Faces of a named surface: their nodes, seen from outside the body, and how many lie between two cells.
*/
#include "modelimpl.h"
#include "base/algebra/vec3.h"
#include <petscsf.h>

#define FACE_MAX_NODES 9 /* of a biquadratic quadrilateral */

/* Whether the corners of a face are clockwise seen from outside its cell: the normal a x b, a and b the diagonals of a
   quadrilateral or two edges of a triangle, points to the middle of the cell's corners then */
static PetscErrorCode FaceIsReversed(Model model, PetscInt face, PetscInt n, const PetscInt corner[], PetscBool *is)
{
  const PetscReal *x = model->mesh.x;
  const PetscInt  *cells, last = n == 4 ? 3 : 2, from = n == 4 ? 1 : 0;
  const Element   *element;
  PetscInt         cStart, nodes[ELEMENT_MAX_NODES];
  PetscReal        cell_x[ELEMENT_MAX_DOFS], a[3], b[3], normal[3], outward[3] = {0, 0, 0};

  PetscFunctionBeginUser;
  PetscCall(DMPlexGetHeightStratum(model->dm, 0, &cStart, NULL));
  PetscCall(DMPlexGetSupport(model->dm, face, &cells));
  PetscCall(ModelGetCell(model, cells[0] - cStart, &element, nodes, cell_x));
  for (int d = 0; d < 3; d++) {
    a[d] = x[3 * corner[n == 4 ? 2 : 1] + d] - x[3 * corner[0] + d];
    b[d] = x[3 * corner[last] + d] - x[3 * corner[from] + d];
    for (PetscInt i = 0; i < n; i++) outward[d] += x[3 * corner[i] + d] / (PetscReal)n;
    for (PetscInt i = 0; i < element->n_corners; i++) outward[d] -= cell_x[3 * i + d] / (PetscReal)element->n_corners;
  }
  Vec3Cross(a, b, normal);
  *is = Vec3Dot(normal, outward) < 0 ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(0);
}

/* The node in the middle of the edge of a face between two corners, -1 without */
static PetscErrorCode FaceFindMiddle(Model model, PetscInt face, PetscInt a, PetscInt b, PetscInt *node)
{
  const PetscInt *edges, *ends;
  PetscInt        n;

  PetscFunctionBeginUser;
  *node = -1;
  PetscCall(DMPlexGetConeSize(model->dm, face, &n));
  PetscCall(DMPlexGetCone(model->dm, face, &edges));
  for (PetscInt e = 0; e < n && *node < 0; e++) {
    PetscInt end[2];

    PetscCall(DMPlexGetCone(model->dm, edges[e], &ends));
    for (int i = 0; i < 2; i++) end[i] = model->node_of[ends[i]];
    if ((end[0] == a && end[1] == b) || (end[0] == b && end[1] == a)) *node = model->node_of[edges[e]];
  }
  PetscFunctionReturn(0);
}

/* Nodes of a face: corners, middles of the edges, middle of the face */
static PetscErrorCode FaceGetNodes(Model model, PetscInt face, PetscInt *n, PetscInt node[])
{
  PetscInt  vStart, vEnd, n_points, n_corners = 0, *closure = NULL;
  PetscBool reversed;

  PetscFunctionBeginUser;
  PetscCall(DMPlexGetDepthStratum(model->dm, 0, &vStart, &vEnd));
  PetscCall(DMPlexGetTransitiveClosure(model->dm, face, PETSC_TRUE, &n_points, &closure));
  for (PetscInt j = 0; j < n_points; j++)
    if (closure[2 * j] >= vStart && closure[2 * j] < vEnd) node[n_corners++] = model->node_of[closure[2 * j]];
  PetscCall(DMPlexRestoreTransitiveClosure(model->dm, face, PETSC_TRUE, &n_points, &closure));
  PetscCall(FaceIsReversed(model, face, n_corners, node, &reversed));
  for (PetscInt i = 1; i < (n_corners + 1) / 2 && reversed; i++) {
    const PetscInt other = node[n_corners - i];

    node[n_corners - i] = node[i];
    node[i]             = other;
  }
  *n = n_corners;
  for (PetscInt i = 0; i < n_corners; i++) {
    PetscCall(FaceFindMiddle(model, face, node[i], node[(i + 1) % n_corners], &node[*n]));
    if (node[*n] >= 0) ++*n;
  }
  if (model->node_of[face] >= 0) node[(*n)++] = model->node_of[face];
  PetscFunctionReturn(0);
}

PetscErrorCode ModelGetSetFaces(Model model, const char set[], ModelFaces *faces)
{
  PetscInt range[2], n_points, n_all, *p;

  PetscFunctionBeginUser;
  PetscCall(DMPlexGetHeightStratum(model->dm, 1, &range[0], &range[1]));
  PetscCall(SetGetPoints(model, set, range, &n_points, &p));
  faces->n = 0;
  PetscCall(PetscMalloc2(n_points + 1, &faces->first, FACE_MAX_NODES * n_points, &faces->node));
  faces->first[0] = 0;
  for (PetscInt i = 0; i < n_points; i++) {
    const PetscInt begin = faces->first[faces->n];
    PetscInt       n_cells, n;

    PetscCall(DMPlexGetSupportSize(model->dm, p[i], &n_cells));
    if (!n_cells) continue;
    PetscCall(FaceGetNodes(model, p[i], &n, &faces->node[begin]));
    faces->first[++faces->n] = begin + n;
  }
  PetscCall(PetscFree(p));
  PetscCallMPI(MPI_Allreduce(&faces->n, &n_all, 1, MPIU_INT, MPI_SUM, model->comm));
  PetscCheck(n_all, model->comm, PETSC_ERR_USER_INPUT, "the set '%s' has no faces: a surface is needed", set);
  PetscFunctionReturn(0);
}

PetscErrorCode PartGetFaces(Model model, PetscInt part, ModelFaces *faces)
{
  PetscInt cStart, fStart, fEnd;

  PetscFunctionBeginUser;
  PetscCall(DMPlexGetHeightStratum(model->dm, 0, &cStart, NULL));
  PetscCall(DMPlexGetHeightStratum(model->dm, 1, &fStart, &fEnd));
  faces->n = 0;
  PetscCall(PetscMalloc2(fEnd - fStart + 1, &faces->first, FACE_MAX_NODES * (fEnd - fStart), &faces->node));
  faces->first[0] = 0;
  for (PetscInt face = fStart; face < fEnd; face++) {
    const PetscInt *cells, begin  = faces->first[faces->n];
    PetscInt        n_cells, n_in = 0, n;

    PetscCall(DMPlexGetSupportSize(model->dm, face, &n_cells));
    PetscCall(DMPlexGetSupport(model->dm, face, &cells));
    for (PetscInt i = 0; i < n_cells; i++) n_in += model->mesh.cell_part[cells[i] - cStart] == part;
    if (n_in != 1) continue;
    PetscCall(FaceGetNodes(model, face, &n, &faces->node[begin]));
    faces->first[++faces->n] = begin + n;
  }
  PetscFunctionReturn(0);
}

/* Whether a face is in one of n sets */
static PetscErrorCode FaceIsIn(Model model, PetscInt face, PetscInt n, const char *const set[], PetscBool *in)
{
  DMLabel  label;
  PetscInt value = -1;

  PetscFunctionBeginUser;
  *in = PETSC_FALSE;
  for (PetscInt i = 0; i < n && !*in; i++) {
    PetscCall(DMGetLabel(model->dm, set[i], &label));
    if (label) PetscCall(DMLabelGetValue(label, face, &value));
    if (label && value == SET_CLOSED) *in = PETSC_TRUE;
  }
  PetscFunctionReturn(0);
}

/* How many other ranks have each point that this rank owns, from the first point on; the caller frees it */
static PetscErrorCode PointsCountSharers(Model model, PetscInt **sharers)
{
  const PetscInt *degree;
  PetscInt        start, end, n_roots;
  PetscSF         sf;

  PetscFunctionBeginUser;
  PetscCall(DMPlexGetChart(model->dm, &start, &end));
  PetscCall(PetscCalloc1(end - start, sharers));
  PetscCall(DMGetPointSF(model->dm, &sf));
  PetscCall(PetscSFGetGraph(sf, &n_roots, NULL, NULL, NULL));
  if (n_roots < 0) PetscFunctionReturn(0);
  PetscCall(PetscSFComputeDegreeBegin(sf, &degree));
  PetscCall(PetscSFComputeDegreeEnd(sf, &degree));
  PetscCall(PetscArraycpy(*sharers, degree, PetscMin(n_roots, end - start)));
  PetscFunctionReturn(0);
}

PetscErrorCode ModelGetOuterFaces(Model model, PetscInt part, PetscInt n, const char *const set[], ModelFaces *faces)
{
  PetscInt cStart, fStart, fEnd, *sharers;

  PetscFunctionBeginUser;
  PetscCall(DMPlexGetHeightStratum(model->dm, 0, &cStart, NULL));
  PetscCall(DMPlexGetHeightStratum(model->dm, 1, &fStart, &fEnd));
  PetscCall(PointsCountSharers(model, &sharers));
  faces->n = 0;
  PetscCall(PetscMalloc2(fEnd - fStart + 1, &faces->first, FACE_MAX_NODES * (fEnd - fStart), &faces->node));
  faces->first[0] = 0;
  for (PetscInt face = fStart; face < fEnd; face++) {
    const PetscInt *cells, begin = faces->first[faces->n];
    PetscInt        n_cells, size;
    PetscBool       elsewhere, in;

    PetscCall(DMPlexGetSupportSize(model->dm, face, &n_cells));
    PetscCall(DMPlexGetSupport(model->dm, face, &cells));
    if (n_cells != 1 || sharers[face] || model->mesh.cell_part[cells[0] - cStart] != part) continue;
    PetscCall(PointIsElsewhere(model, face, &elsewhere));
    PetscCall(FaceIsIn(model, face, n, set, &in));
    if (elsewhere || in) continue;
    PetscCall(FaceGetNodes(model, face, &size, &faces->node[begin]));
    faces->first[++faces->n] = begin + size;
  }
  PetscCall(PetscFree(sharers));
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
  PetscInt  range[2], n_points, n_cells, *p;
  PetscBool elsewhere;

  PetscFunctionBeginUser;
  *n = 0;
  PetscCall(DMPlexGetHeightStratum(model->dm, 1, &range[0], &range[1]));
  PetscCall(SetGetPoints(model, set, range, &n_points, &p));
  for (PetscInt i = 0; i < n_points; i++) {
    PetscCall(DMPlexGetSupportSize(model->dm, p[i], &n_cells));
    PetscCall(PointIsElsewhere(model, p[i], &elsewhere));
    *n += n_cells > 1 || (n_cells == 1 && elsewhere);
  }
  PetscCall(PetscFree(p));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, n, 1, MPIU_INT, MPI_SUM, model->comm));
  PetscFunctionReturn(0);
}
