/*
   The mesh as tables, and one of its cells: element, nodes, places of the nodes (m).
*/
#include "modelimpl.h"
#include "base/algebra/vec3.h"

PetscErrorCode ModelGetMesh(Model model, const Mesh **mesh)
{
  PetscFunctionBeginUser;
  *mesh = &model->mesh;
  PetscFunctionReturn(0);
}

PetscErrorCode ModelGetCell(Model model, PetscInt c, const Element **element, PetscInt nodes[], PetscReal x[])
{
  const Mesh *mesh = &model->mesh;

  PetscFunctionBeginUser;
  *element = mesh->element[c];
  for (PetscInt i = 0; i < mesh->element[c]->n_nodes; i++) {
    nodes[i] = mesh->cell_node[mesh->cell_first[c] + i];
    for (int d = 0; d < 3; d++) x[3 * i + d] = mesh->x[3 * nodes[i] + d];
  }
  PetscFunctionReturn(0);
}

PetscErrorCode ModelGetCellAt(Model model, PetscInt c, PetscReal thickness, const Element **element, PetscInt nodes[],
                              PetscReal x[])
{
  const Layer *layer = &model->scene.parts[model->mesh.cell_part[c]].layer;

  PetscFunctionBeginUser;
  PetscCall(ModelGetCell(model, c, element, nodes, x));
  if (!layer->given || thickness == 0 || thickness == layer->mesh) PetscFunctionReturn(0);
  for (PetscInt i = 0; i < (*element)->n_nodes; i++) {
    const PetscReal more = (thickness / layer->mesh - 1) * Vec3Dot(&x[3 * i], layer->normal);

    for (int d = 0; d < 3; d++) x[3 * i + d] += more * layer->normal[d];
  }
  PetscFunctionReturn(0);
}
