/*
   The volume elements of a Gmsh file as an interpolated DMPlex, one cell each in the order of the file. The node of an
   element that is no corner stands at the edge, face or cell whose vertices are the corners around it; elements that
   share an edge or face share its node.
*/
#include "volumes.h"
#include "model/modelimpl.h"

#define FAR_OFF 0.4 /* largest distance of a mid-side node from the middle of its edge, of the edge's length */

/* Cells as the vertices of their corners */
static PetscErrorCode CornersCreate(MPI_Comm comm, const GmshVolumes *volumes, DM *dm)
{
  const GmshMesh *mesh = volumes->mesh;
  PetscInt        cell[GMSH_MAX_NODES], c = 0;

  PetscFunctionBeginUser;
  PetscCall(DMPlexCreate(comm, dm));
  PetscCall(DMSetDimension(*dm, 3));
  PetscCall(DMCreateLabel(*dm, "celltype"));
  PetscCall(DMPlexSetChart(*dm, 0, volumes->n_cells + volumes->n_vertices));
  for (PetscInt e = 0; e < mesh->n_elements; e++) {
    const GmshShape *shape = mesh->elements[e].shape;

    if (shape->dim < 3) continue;
    PetscCall(DMPlexSetConeSize(*dm, c, shape->n_corners));
    PetscCall(DMPlexSetCellType(*dm, c++, shape->polytope));
  }
  for (PetscInt v = 0; v < volumes->n_vertices; v++)
    PetscCall(DMPlexSetCellType(*dm, volumes->n_cells + v, DM_POLYTOPE_POINT));
  PetscCall(DMSetUp(*dm));
  c = 0;
  for (PetscInt e = 0; e < mesh->n_elements; e++) {
    const GmshElement *element = &mesh->elements[e];

    if (element->shape->dim < 3) continue;
    for (PetscInt i = 0; i < element->shape->n_corners; i++)
      cell[i] = volumes->n_cells + volumes->vertex[element->node[i]];
    PetscCall(DMPlexInvertCell(element->shape->polytope, cell));
    PetscCall(DMPlexSetCone(*dm, c++, cell));
  }
  PetscCall(DMPlexSymmetrize(*dm));
  PetscCall(DMPlexStratify(*dm));
  PetscFunctionReturn(0);
}

/* Checks that a node on an edge is near the middle of it */
static void EdgeCheckMiddle(const GmshMesh *mesh, const GmshElement *element, PetscInt i, ReaderError *error)
{
  const PetscReal *middle = &mesh->x[3 * element->node[i]], *end[2] = {NULL, NULL};
  PetscReal        off = 0, length = 0;
  int              n_ends = 0;

  for (PetscInt k = 0; k < element->shape->n_corners; k++)
    if (element->shape->at[i] & 1u << k) {
      if (n_ends < 2) end[n_ends] = &mesh->x[3 * element->node[k]];
      n_ends++;
    }
  if (n_ends != 2) return;
  for (int d = 0; d < 3; d++) {
    off += PetscSqr(middle[d] - 0.5 * (end[0][d] + end[1][d]));
    length += PetscSqr(end[1][d] - end[0][d]);
  }
  if (off <= FAR_OFF * FAR_OFF * length) return;
  ReaderErrorSet(
    error, PETSC_ERR_USER_INPUT,
    "node %" PetscInt_FMT " of element %" PetscInt_FMT
    " is %.3g of the edge's length away from the middle of its edge; are mid-side nodes missing or swapped?",
    mesh->node_tags[element->node[i]], element->number, (double)PetscSqrtReal(off / length));
}

/* Sets node[point] of the points of a cell that bear nodes but its vertices */
static PetscErrorCode CellSetMiddles(DM dm, PetscInt cell, const GmshVolumes *volumes, const GmshElement *element,
                                     PetscInt node[], ReaderError *error)
{
  const GmshMesh  *mesh  = volumes->mesh;
  const GmshShape *shape = element->shape;
  PetscInt         corner[GMSH_MAX_NODES], n_points, vStart, *closure = NULL;

  PetscFunctionBeginUser;
  PetscCall(DMPlexGetDepthStratum(dm, 0, &vStart, NULL));
  for (PetscInt i = 0; i < shape->n_corners; i++) corner[i] = vStart + volumes->vertex[element->node[i]];
  PetscCall(DMPlexGetTransitiveClosure(dm, cell, PETSC_TRUE, &n_points, &closure));
  for (PetscInt j = 0; j < n_points - shape->n_corners; j++) {
    const PetscInt point = closure[2 * j];
    unsigned       corners;

    PetscCall(PointGetCorners(dm, point, shape->n_corners, corner, &corners));
    for (PetscInt i = shape->n_corners; i < shape->n_nodes; i++) {
      if (shape->at[i] != corners) continue;
      if (node[point] >= 0 && node[point] != element->node[i])
        ReaderErrorSet(error, PETSC_ERR_USER_INPUT,
                       "element %" PetscInt_FMT " has node %" PetscInt_FMT " where a neighbour has node %" PetscInt_FMT
                       " on their common edge or face",
                       element->number, mesh->node_tags[element->node[i]], mesh->node_tags[node[point]]);
      node[point] = element->node[i];
      EdgeCheckMiddle(mesh, element, i, error);
    }
  }
  PetscCall(DMPlexRestoreTransitiveClosure(dm, cell, PETSC_TRUE, &n_points, &closure));
  PetscFunctionReturn(0);
}

/* Checks that no neighbour puts a node on an edge or face of a cell that has none there */
static PetscErrorCode CellCheckOrder(DM dm, PetscInt cell, const GmshElement *element, const PetscInt node[],
                                     ReaderError *error)
{
  PetscInt n_points, n = 0, *closure = NULL;

  PetscFunctionBeginUser;
  PetscCall(DMPlexGetTransitiveClosure(dm, cell, PETSC_TRUE, &n_points, &closure));
  for (PetscInt j = 0; j < n_points; j++) n += node[closure[2 * j]] >= 0;
  PetscCall(DMPlexRestoreTransitiveClosure(dm, cell, PETSC_TRUE, &n_points, &closure));
  if (n > element->shape->n_nodes)
    ReaderErrorSet(error, PETSC_ERR_USER_INPUT,
                   "element %" PetscInt_FMT " has %" PetscInt_FMT
                   " nodes, and its neighbours more on common edges or faces; elements that touch must have one order",
                   element->number, element->shape->n_nodes);
  PetscFunctionReturn(0);
}

/* The point of each node of the file. No node may stand at two: a corner of one element in the middle of another's edge
   or face */
static PetscErrorCode NodesSetPoints(const GmshMesh *mesh, PetscInt n_points, const PetscInt node[], PetscInt point[],
                                     ReaderError *error)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < mesh->n_nodes; i++) point[i] = -1;
  for (PetscInt p = 0; p < n_points; p++) {
    if (node[p] < 0) continue;
    if (point[node[p]] >= 0)
      ReaderErrorSet(error, PETSC_ERR_USER_INPUT,
                     "node %" PetscInt_FMT
                     " is a corner of one element and in the middle of an edge or face of another, "
                     "or on two edges; elements that touch must share whole edges and faces",
                     mesh->node_tags[node[p]]);
    point[node[p]] = p;
  }
  PetscFunctionReturn(0);
}

/* Node of the file that each point bears, -1 for none; node [points] */
static PetscErrorCode PointsSetNodes(DM dm, const GmshVolumes *volumes, PetscInt node[], ReaderError *error)
{
  const GmshMesh *mesh = volumes->mesh;
  PetscInt        pEnd, vStart, c = 0;
  PetscBool       second = PETSC_FALSE;

  PetscFunctionBeginUser;
  PetscCall(DMPlexGetChart(dm, NULL, &pEnd));
  PetscCall(DMPlexGetDepthStratum(dm, 0, &vStart, NULL));
  for (PetscInt p = 0; p < pEnd; p++) node[p] = -1;
  for (PetscInt i = 0; i < mesh->n_nodes; i++)
    if (volumes->vertex[i] >= 0) node[vStart + volumes->vertex[i]] = i;
  for (PetscInt e = 0; e < mesh->n_elements; e++) {
    const GmshElement *element = &mesh->elements[e];

    if (element->shape->dim < 3) continue;
    if (element->shape->n_nodes > element->shape->n_corners) {
      PetscCall(CellSetMiddles(dm, c, volumes, element, node, error));
      second = PETSC_TRUE;
    }
    c++;
  }
  PetscCall(NodesSetPoints(mesh, pEnd, node, volumes->point, error));
  c = 0;
  for (PetscInt e = 0; e < mesh->n_elements && second; e++)
    if (mesh->elements[e].shape->dim == 3) PetscCall(CellCheckOrder(dm, c++, &mesh->elements[e], node, error));
  PetscFunctionReturn(0);
}

/* Section of three coordinates at every point that bears a node */
static PetscErrorCode PlacesLayOut(DM dm, const PetscInt node[], PetscSection *section)
{
  PetscInt pStart, pEnd;

  PetscFunctionBeginUser;
  PetscCall(DMPlexGetChart(dm, &pStart, &pEnd));
  PetscCall(DMSetCoordinateDim(dm, 3));
  PetscCall(DMGetCoordinateSection(dm, section));
  PetscCall(PetscSectionSetNumFields(*section, 1));
  PetscCall(PetscSectionSetFieldComponents(*section, 0, 3));
  PetscCall(PetscSectionSetChart(*section, pStart, pEnd));
  for (PetscInt p = pStart; p < pEnd; p++) {
    if (node[p] < 0) continue;
    PetscCall(PetscSectionSetDof(*section, p, 3));
    PetscCall(PetscSectionSetFieldDof(*section, p, 0, 3));
  }
  PetscCall(PetscSectionSetUp(*section));
  PetscFunctionReturn(0);
}

/* Coordinates of the points that bear nodes, m */
static PetscErrorCode PlacesSet(DM dm, const GmshMesh *mesh, const PetscInt node[])
{
  PetscInt     pStart, pEnd, size, offset;
  PetscSection section;
  PetscScalar *x;
  Vec          places;

  PetscFunctionBeginUser;
  PetscCall(DMPlexGetChart(dm, &pStart, &pEnd));
  PetscCall(PlacesLayOut(dm, node, &section));
  PetscCall(PetscSectionGetStorageSize(section, &size));
  PetscCall(VecCreate(PETSC_COMM_SELF, &places));
  PetscCall(PetscObjectSetName((PetscObject)places, "coordinates"));
  PetscCall(VecSetSizes(places, size, PETSC_DETERMINE));
  PetscCall(VecSetBlockSize(places, 3));
  PetscCall(VecSetType(places, VECSTANDARD));
  PetscCall(VecGetArray(places, &x));
  for (PetscInt p = pStart; p < pEnd; p++) {
    if (node[p] < 0) continue;
    PetscCall(PetscSectionGetOffset(section, p, &offset));
    for (int d = 0; d < 3; d++) x[offset + d] = mesh->x[3 * node[p] + d];
  }
  PetscCall(VecRestoreArray(places, &x));
  PetscCall(DMSetCoordinatesLocal(dm, places));
  PetscCall(VecDestroy(&places));
  PetscFunctionReturn(0);
}

/* Raises the error of a rank, rank 0, whose cells do not fit to each other */
static PetscErrorCode VolumesExplain(const GmshMesh *mesh, const char file[])
{
  PetscInt element[2];

  PetscFunctionBeginUser;
  PetscCall(VolumesFindTwisted(mesh, element));
  PetscCheck(element[0] < 0, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "Option -model_mesh %s: elements %" PetscInt_FMT " and %" PetscInt_FMT
             " have the corners of their common face in different orders around it; write those of a hexahedron or "
             "wedge in Gmsh's order",
             file, element[0], element[1]);
  SETERRQ(PETSC_COMM_SELF, PETSC_ERR_USER_INPUT, "Option -model_mesh %s: its volume elements do not fit at their faces",
          file);
}

PetscErrorCode VolumesCreateMesh(MPI_Comm comm, const char file[], const GmshVolumes *volumes, ReaderError *error,
                                 DM *dm)
{
  PetscErrorCode code;
  PetscInt       pEnd, *node;
  DM             corners;

  PetscFunctionBeginUser;
  PetscCall(CornersCreate(comm, volumes, &corners));
  PetscCall(PetscPushErrorHandler(PetscReturnErrorHandler, NULL));
  code = DMPlexInterpolate(corners, dm);
  PetscCall(PetscPopErrorHandler());
  if (code) PetscCall(VolumesExplain(volumes->mesh, file));
  PetscCall(DMDestroy(&corners));
  PetscCall(DMPlexGetChart(*dm, NULL, &pEnd));
  PetscCall(PetscMalloc1(pEnd, &node));
  PetscCall(PointsSetNodes(*dm, volumes, node, error));
  PetscCall(PlacesSet(*dm, volumes->mesh, node));
  PetscCall(PetscFree(node));
  PetscFunctionReturn(0);
}
