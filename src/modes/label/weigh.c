/*
   Masses of nodes, by which shapes are weighed for their names (label.c): of the cells of a part, or of points the
   largest diagonal entry of the mass matrix among their directions.
*/
#include "modes/modesimpl.h"
#include "disc.h"

/* Masses of the nodes of a cell (kg): equal ones, or the lumped ones of elements of second order */
static PetscErrorCode CellMasses(const Element *element, const PetscReal x[], PetscReal density, PetscReal mass[])
{
  const Elasticity unit = ElasticityFromEngineering(1, 0, density);
  PetscReal        volume, jacobian, ke[ELEMENT_MAX_DOFS * ELEMENT_MAX_DOFS], me[ELEMENT_MAX_DOFS * ELEMENT_MAX_DOFS];

  PetscFunctionBeginUser;
  if (element->n_nodes > element->n_corners) {
    PetscCall(ElementMatrices(element, x, &unit, ke, me));
    ElementLump(element, me, mass);
    PetscFunctionReturn(0);
  }
  element->measure(element->solid, x, &volume, &jacobian);
  for (PetscInt i = 0; i < element->n_nodes; i++) mass[i] = density * volume / (PetscReal)element->n_nodes;
  PetscFunctionReturn(0);
}

/* Nodal mass (kg) of one part, shape [local nodes]: only what this rank's cells give */
static PetscErrorCode PartMasses(Model model, PetscInt part, const OperatorsMaterial *material, PetscReal **mass)
{
  const Mesh *mesh;

  PetscFunctionBeginUser;
  PetscCall(ModelGetMesh(model, &mesh));
  PetscCall(PetscCalloc1(mesh->n_nodes, mass));
  for (PetscInt c = 0; c < mesh->n_cells; c++) {
    const Element *element;
    PetscInt       nodes[ELEMENT_MAX_NODES];
    PetscReal      x[ELEMENT_MAX_DOFS], share[ELEMENT_MAX_NODES];

    if (mesh->cell_part[c] != part) continue;
    PetscCall(ModelGetCellAt(model, c, material->thickness, &element, nodes, x));
    PetscCall(CellMasses(element, x, material->density, share));
    for (PetscInt i = 0; i < element->n_nodes; i++) (*mass)[nodes[i]] += share[i];
  }
  PetscFunctionReturn(0);
}

/* Masses of points, mass[parts], of the diagonal of the mass matrix */
static PetscErrorCode PointMasses(Modes modes, Operators operators, const Mesh *mesh, PetscReal *mass[])
{
  PetscReal *diagonal;
  Mat        M;
  Vec        d;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(3 * mesh->n_nodes, &diagonal));
  PetscCall(PencilGetMass(modes->pencil, &M));
  PetscCall(MatCreateVecs(M, &d, NULL));
  PetscCall(MatGetDiagonal(M, d));
  PetscCall(OperatorsGetNodal(operators, d, diagonal));
  for (PetscInt part = 0; part < mesh->n_parts; part++) PetscCall(PetscCalloc1(mesh->n_nodes, &mass[part]));
  for (PetscInt i = 0; i < 3 * mesh->n_nodes; i++) {
    PetscReal *m = &mass[mesh->cell_part[i / 3]][i / 3];

    *m = PetscMax(*m, diagonal[i]);
  }
  PetscCall(VecDestroy(&d));
  PetscCall(PetscFree(diagonal));
  PetscFunctionReturn(0);
}

PetscErrorCode LabelsWeigh(Modes modes, const Mesh *mesh, PetscReal *const **mass)
{
  const PetscReal *p;
  Operators        operators;
  Model            model;

  PetscFunctionBeginUser;
  *mass = modes->weights ? modes->weights->mass : NULL;
  if (*mass) PetscFunctionReturn(0);
  PetscCall(PetscCalloc1(1, &modes->weights));
  modes->weights->n = mesh->n_parts;
  PetscCall(PetscCalloc1(mesh->n_parts, &modes->weights->mass));
  *mass = modes->weights->mass;
  PetscCall(PencilGetOperators(modes->pencil, &operators));
  PetscCall(OperatorsGetModel(operators, &model, NULL));
  if (!model) {
    PetscCall(PointMasses(modes, operators, mesh, modes->weights->mass));
    PetscFunctionReturn(0);
  }
  PetscCall(PencilGetParameters(modes->pencil, NULL, NULL, &p));
  for (PetscInt part = 0; part < mesh->n_parts; part++) {
    OperatorsMaterial material;

    PetscCall(OperatorsGetMaterial(operators, p, part, &material));
    PetscCall(PartMasses(model, part, &material, &modes->weights->mass[part]));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode LabelsForgetWeights(Modes modes)
{
  PetscFunctionBeginUser;
  if (!modes->weights) PetscFunctionReturn(0);
  for (PetscInt part = 0; part < modes->weights->n; part++) PetscCall(PetscFree(modes->weights->mass[part]));
  PetscCall(PetscFree(modes->weights->mass));
  if (modes->weights->disc) PetscCall(DiscDestroy(modes->weights->disc));
  PetscCall(PetscFree(modes->weights->disc));
  PetscCall(PetscFree(modes->weights));
  PetscFunctionReturn(0);
}
