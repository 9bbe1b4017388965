/*
   Tables of the local mesh: places and numbers of the vertices, corners and parts of the cells. The points of the DM
   are known to model/ alone: vertex v is point vStart + v, cell c is point cStart + c.
*/
#include "modelimpl.h"
#include <petscsf.h>

/* Places of the vertices, m */
static PetscErrorCode MeshSetPlaces(Model model)
{
  Mesh *const        mesh = &model->mesh;
  const PetscScalar *place;
  PetscReal         *x;
  Vec                coordinates;

  PetscFunctionBeginUser;
  PetscCall(DMGetCoordinatesLocal(model->dm, &coordinates));
  PetscCall(PetscMalloc1(3 * mesh->n_vertices, &x));
  PetscCall(VecGetArrayRead(coordinates, &place));
  PetscCall(PetscArraycpy(x, place, 3 * mesh->n_vertices));
  PetscCall(VecRestoreArrayRead(coordinates, &place));
  mesh->x = x;
  PetscFunctionReturn(0);
}

/* Numbers and owners of the vertices */
static PetscErrorCode MeshSetNumbers(Model model)
{
  Mesh *const     mesh = &model->mesh;
  const PetscInt *here;
  PetscInt       *number;
  PetscBool      *owned;
  IS              numbers;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(mesh->n_vertices, &number));
  PetscCall(PetscMalloc1(mesh->n_vertices, &owned));
  PetscCall(DMPlexGetVertexNumbering(model->dm, &numbers)); /* -(g + 1) for vertices of other ranks */
  PetscCall(ISGetIndices(numbers, &here));
  for (PetscInt v = 0; v < mesh->n_vertices; v++) {
    owned[v]  = here[v] >= 0 ? PETSC_TRUE : PETSC_FALSE;
    number[v] = owned[v] ? here[v] : -(here[v] + 1);
  }
  PetscCall(ISRestoreIndices(numbers, &here));
  mesh->number = number;
  mesh->owned  = owned;
  PetscFunctionReturn(0);
}

/* Corners of the cells in the element's order */
static PetscErrorCode MeshSetCorners(Model model, PetscInt cStart, PetscInt vStart)
{
  Mesh *const mesh = &model->mesh;
  PetscInt    n_points, *corner, *closure = NULL;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(mesh->n_nodes * mesh->n_cells, &corner));
  for (PetscInt c = 0; c < mesh->n_cells; c++) {
    PetscInt first = 0;

    PetscCall(DMPlexGetTransitiveClosure(model->dm, cStart + c, PETSC_TRUE, &n_points, &closure));
    while (closure[2 * first] < vStart || closure[2 * first] >= vStart + mesh->n_vertices) first++;
    for (PetscInt i = 0; i < mesh->n_nodes; i++)
      corner[mesh->n_nodes * c + i] = closure[2 * (first + model->scene.element->closure_order[i])] - vStart;
  }
  if (closure) PetscCall(DMPlexRestoreTransitiveClosure(model->dm, cStart, PETSC_TRUE, &n_points, &closure));
  mesh->corner = corner;
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
  PetscInt cStart, cEnd, vStart, vEnd;

  PetscFunctionBeginUser;
  PetscCall(DMPlexGetHeightStratum(model->dm, 0, &cStart, &cEnd));
  PetscCall(DMPlexGetDepthStratum(model->dm, 0, &vStart, &vEnd));
  model->mesh = (Mesh){.shape      = model->scene.element->shape,
                       .n_vertices = vEnd - vStart,
                       .n_cells    = cEnd - cStart,
                       .n_nodes    = model->scene.element->n_nodes};
  PetscCall(MeshSetParts(model));
  PetscCall(MeshSetPlaces(model));
  PetscCall(MeshSetNumbers(model));
  PetscCall(MeshSetCorners(model, cStart, vStart));
  PetscFunctionReturn(0);
}

PetscErrorCode MeshReset(Model model)
{
  Mesh *const mesh = &model->mesh;

  PetscFunctionBeginUser;
  PetscCall(PetscFree(mesh->x));
  PetscCall(PetscFree(mesh->number));
  PetscCall(PetscFree(mesh->owned));
  PetscCall(PetscFree(mesh->unknown));
  PetscCall(PetscFree(mesh->prescribed));
  PetscCall(PetscFree(mesh->corner));
  PetscCall(PetscFree(mesh->cell_part));
  PetscCall(PetscFree(mesh->part));
  PetscFunctionReturn(0);
}

PetscErrorCode ModelGetNeighbours(Model model, PetscInt v, PetscInt *n, PetscInt **neighbours)
{
  const PetscInt *edges, *ends;
  PetscInt        vStart;

  PetscFunctionBeginUser;
  PetscCall(DMPlexGetDepthStratum(model->dm, 0, &vStart, NULL));
  PetscCall(DMPlexGetSupportSize(model->dm, vStart + v, n));
  PetscCall(DMPlexGetSupport(model->dm, vStart + v, &edges));
  PetscCall(PetscMalloc1(*n, neighbours));
  for (PetscInt e = 0; e < *n; e++) {
    PetscCall(DMPlexGetCone(model->dm, edges[e], &ends));
    (*neighbours)[e] = (ends[0] == vStart + v ? ends[1] : ends[0]) - vStart;
  }
  PetscFunctionReturn(0);
}
