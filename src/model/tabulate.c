/*
   Tables of the local mesh: places and numbers of the nodes, elements, nodes and parts of the cells.

   The points of the DM are known to model/ alone. Those that bear a node are those for which the section of the
   coordinates has three values: nodes, and in quadratic meshes edges, faces and cells. Node numbers follow that
   section. Node i of a cell stands at the point whose nodes are the corners element->at[i].
*/
#include "modelimpl.h"

/* Nodes of the points and points of the nodes */
static PetscErrorCode MeshSetNodes(Model model)
{
  PetscInt     pStart, pEnd, sStart, sEnd, size, dof, offset;
  PetscSection section;

  PetscFunctionBeginUser;
  PetscCall(DMPlexGetChart(model->dm, &pStart, &pEnd));
  PetscCall(DMGetCoordinateSection(model->dm, &section));
  PetscCall(PetscSectionGetChart(section, &sStart, &sEnd));
  PetscCall(PetscSectionGetStorageSize(section, &size));
  model->mesh.n_nodes = size / 3;
  PetscCall(PetscMalloc1(pEnd, &model->node_of));
  PetscCall(PetscMalloc1(model->mesh.n_nodes, &model->point_of));
  for (PetscInt p = pStart; p < pEnd; p++) {
    model->node_of[p] = -1;
    if (p < sStart || p >= sEnd) continue;
    PetscCall(PetscSectionGetDof(section, p, &dof));
    if (!dof) continue;
    PetscCall(PetscSectionGetOffset(section, p, &offset));
    model->node_of[p]           = offset / 3;
    model->point_of[offset / 3] = p;
  }
  PetscFunctionReturn(0);
}

/* Places of the nodes, m */
static PetscErrorCode MeshSetPlaces(Model model)
{
  Mesh *const        mesh = &model->mesh;
  const PetscScalar *place;
  PetscReal         *x;
  Vec                coordinates;

  PetscFunctionBeginUser;
  PetscCall(DMGetCoordinatesLocal(model->dm, &coordinates));
  PetscCall(PetscMalloc1(3 * mesh->n_nodes, &x));
  PetscCall(VecGetArrayRead(coordinates, &place));
  PetscCall(PetscArraycpy(x, place, 3 * mesh->n_nodes));
  PetscCall(VecRestoreArrayRead(coordinates, &place));
  mesh->x = x;
  PetscFunctionReturn(0);
}

/* Numbers and owners of the nodes: offsets are -(3 g + 1) for nodes of other ranks */
static PetscErrorCode MeshSetNumbers(Model model)
{
  Mesh *const  mesh = &model->mesh;
  PetscInt    *number, offset;
  PetscBool   *owned;
  PetscSection global;
  DM           places;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(mesh->n_nodes, &number));
  PetscCall(PetscMalloc1(mesh->n_nodes, &owned));
  PetscCall(DMGetCoordinateDM(model->dm, &places));
  PetscCall(DMGetGlobalSection(places, &global));
  for (PetscInt v = 0; v < mesh->n_nodes; v++) {
    PetscCall(PetscSectionGetOffset(global, model->point_of[v], &offset));
    owned[v]  = offset >= 0 ? PETSC_TRUE : PETSC_FALSE;
    number[v] = (owned[v] ? offset : -(offset + 1)) / 3;
  }
  mesh->number = number;
  mesh->owned  = owned;
  PetscFunctionReturn(0);
}

PetscErrorCode PointGetCorners(DM dm, PetscInt point, PetscInt n, const PetscInt vertex[], unsigned *corners)
{
  PetscInt n_points, *closure = NULL;

  PetscFunctionBeginUser;
  *corners = 0;
  PetscCall(DMPlexGetTransitiveClosure(dm, point, PETSC_TRUE, &n_points, &closure));
  for (PetscInt j = 0; j < n_points; j++)
    for (PetscInt i = 0; i < n; i++)
      if (closure[2 * j] == vertex[i]) *corners |= 1u << i;
  PetscCall(DMPlexRestoreTransitiveClosure(dm, point, PETSC_TRUE, &n_points, &closure));
  PetscFunctionReturn(0);
}

/* Nodes of a cell in the order of its element; `points` bear them, the corners last and in the order of the closure */
static PetscErrorCode CellOrderNodes(Model model, const Element *element, const PetscInt points[], PetscInt nodes[])
{
  const PetscInt n = element->n_nodes, n_corners = element->n_corners;
  PetscInt       vertex[ELEMENT_MAX_CORNERS];

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < n_corners; i++) {
    vertex[i] = points[n - n_corners + element->closure_order[i]];
    nodes[i]  = model->node_of[vertex[i]];
  }
  for (PetscInt k = 0; k < n - n_corners; k++) {
    unsigned corners;

    PetscCall(PointGetCorners(model->dm, points[k], n_corners, vertex, &corners));
    for (PetscInt i = n_corners; i < n; i++)
      if (element->at[i] == corners) nodes[i] = model->node_of[points[k]];
  }
  PetscFunctionReturn(0);
}

/* Points of a cell that bear nodes, in the order of its closure: nodes come last */
static PetscErrorCode CellGetPoints(Model model, PetscInt cell, PetscInt *n, PetscInt points[])
{
  PetscInt n_points, *closure = NULL;

  PetscFunctionBeginUser;
  *n = 0;
  PetscCall(DMPlexGetTransitiveClosure(model->dm, cell, PETSC_TRUE, &n_points, &closure));
  for (PetscInt j = 0; j < n_points; j++)
    if (model->node_of[closure[2 * j]] >= 0) points[(*n)++] = closure[2 * j];
  PetscCall(DMPlexRestoreTransitiveClosure(model->dm, cell, PETSC_TRUE, &n_points, &closure));
  PetscFunctionReturn(0);
}

/* Elements of the cells, NULL where the table has none, and their nodes */
static PetscErrorCode MeshSetCells(Model model, PetscInt cStart)
{
  Mesh *const     mesh = &model->mesh;
  PetscInt       *first, *node, n, points[ELEMENT_MAX_NODES];
  const Element **element;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(mesh->n_cells, &element));
  PetscCall(PetscMalloc1(mesh->n_cells + 1, &first));
  first[0] = 0;
  for (PetscInt c = 0; c < mesh->n_cells; c++) {
    DMPolytopeType shape;

    PetscCall(CellGetPoints(model, cStart + c, &n, points));
    PetscCall(DMPlexGetCellType(model->dm, cStart + c, &shape));
    element[c]   = ElementFind(shape, n, model->formulation);
    first[c + 1] = first[c] + n;
  }
  PetscCall(PetscMalloc1(first[mesh->n_cells], &node));
  for (PetscInt c = 0; c < mesh->n_cells; c++) {
    PetscCall(CellGetPoints(model, cStart + c, &n, points));
    for (PetscInt i = 0; i < n; i++) node[first[c] + i] = model->node_of[points[i]];
    if (element[c]) PetscCall(CellOrderNodes(model, element[c], points, &node[first[c]]));
  }
  mesh->element    = element;
  mesh->cell_first = first;
  mesh->cell_node  = node;
  PetscFunctionReturn(0);
}

/* Parts of the cells, and their names */
static PetscErrorCode MeshSetParts(Model model)
{
  Mesh *const  mesh = &model->mesh;
  PetscInt    *cell_part;
  const char **part;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(mesh->n_cells, &cell_part));
  PetscCall(PetscMalloc1(model->scene.n_parts, &part));
  for (PetscInt i = 0; i < model->scene.n_parts; i++) part[i] = model->scene.parts[i].name;
  PetscCall(PartsFindCells(model, cell_part));
  mesh->n_parts   = model->scene.n_parts;
  mesh->cell_part = cell_part;
  mesh->part      = part;
  PetscFunctionReturn(0);
}

PetscErrorCode MeshTabulate(Model model)
{
  PetscInt cStart, cEnd;

  PetscFunctionBeginUser;
  PetscCall(DMPlexGetHeightStratum(model->dm, 0, &cStart, &cEnd));
  model->mesh = (Mesh){.n_cells = cEnd - cStart};
  PetscCall(MeshSetNodes(model));
  PetscCall(MeshSetPlaces(model));
  PetscCall(MeshSetNumbers(model));
  PetscCall(MeshSetCells(model, cStart));
  PetscCall(MeshSetParts(model));
  PetscFunctionReturn(0);
}

PetscErrorCode MeshReset(Model model)
{
  Mesh *const mesh = &model->mesh;

  PetscFunctionBeginUser;
  PetscCall(PetscFree(model->node_of));
  PetscCall(PetscFree(model->point_of));
  PetscCall(PetscFree(mesh->x));
  PetscCall(PetscFree(mesh->number));
  PetscCall(PetscFree(mesh->owned));
  PetscCall(PetscFree(mesh->unknown));
  PetscCall(PetscFree(mesh->prescribed));
  PetscCall(PetscFree(mesh->element));
  PetscCall(PetscFree(mesh->cell_first));
  PetscCall(PetscFree(mesh->cell_node));
  PetscCall(PetscFree(mesh->cell_part));
  PetscCall(PetscFree(mesh->part));
  PetscFunctionReturn(0);
}

/* Nodes beside a node along one edge: the node in its middle where it has one, else that at its other end */
static PetscErrorCode EdgeAddNodes(Model model, PetscInt edge, PetscInt node, PetscInt *n, PetscInt beside[])
{
  const PetscInt  middle = model->node_of[edge];
  const PetscInt *ends;

  PetscFunctionBeginUser;
  if (middle >= 0 && middle != node) beside[(*n)++] = middle;
  if (middle >= 0 && middle != node) PetscFunctionReturn(0);
  PetscCall(DMPlexGetCone(model->dm, edge, &ends));
  for (int i = 0; i < 2; i++)
    if (model->node_of[ends[i]] != node) beside[(*n)++] = model->node_of[ends[i]];
  PetscFunctionReturn(0);
}

PetscErrorCode ModelGetNeighbours(Model model, PetscInt v, PetscInt *n, PetscInt **neighbours)
{
  const PetscInt *edges, point = model->point_of[v];
  PetscInt        n_edges, depth;

  PetscFunctionBeginUser;
  *n = 0;
  PetscCall(DMPlexGetPointDepth(model->dm, point, &depth));
  PetscCall(DMPlexGetSupportSize(model->dm, point, &n_edges));
  PetscCall(DMPlexGetSupport(model->dm, point, &edges));
  PetscCall(PetscMalloc1(n_edges + 2, neighbours));
  if (depth == 1) PetscCall(EdgeAddNodes(model, point, v, n, *neighbours));
  for (PetscInt e = 0; e < n_edges && depth == 0; e++) PetscCall(EdgeAddNodes(model, edges[e], v, n, *neighbours));
  PetscFunctionReturn(0);
}
