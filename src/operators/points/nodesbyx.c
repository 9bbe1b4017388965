/* Nodes of this rank in ascending x: those within a distance of a place are a run of them */
#include "nodesbyx.h"

PetscErrorCode NodesByXCreate(const Mesh *mesh, NodesByX *nodes)
{
  PetscFunctionBeginUser;
  nodes->mesh = mesh;
  PetscCall(PetscMalloc2(mesh->n_nodes, &nodes->x, mesh->n_nodes, &nodes->order));
  for (PetscInt v = 0; v < mesh->n_nodes; v++) {
    nodes->x[v]     = mesh->x[3 * v];
    nodes->order[v] = v;
  }
  PetscCall(PetscSortRealWithArrayInt(mesh->n_nodes, nodes->x, nodes->order));
  PetscFunctionReturn(0);
}

PetscInt NodesByXBegin(const NodesByX *nodes, PetscReal x)
{
  PetscInt begin = 0, end = nodes->mesh->n_nodes;

  while (begin < end) {
    const PetscInt middle = begin + (end - begin) / 2;

    if (nodes->x[middle] < x)
      begin = middle + 1;
    else
      end = middle;
  }
  return begin;
}

PetscErrorCode NodesByXDestroy(NodesByX *nodes)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree2(nodes->x, nodes->order));
  PetscFunctionReturn(0);
}
