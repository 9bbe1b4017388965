/*
   Cells of the bodies: stiffness K_e (N/m) with the present Young's modulus, lumped mass (kg) and Rayleigh factors of
   their part, C_e = alpha M_e + beta K_e; and forces K_e u_e cell by cell, with displacements relative to the first
   node of each, so that a translation gives none.
*/
#include "bodiesimpl.h"

PetscReal BranchesStiffness(const Part *part)
{
  PetscReal sum = 0;

  for (PetscInt j = 0; j < ViscoelasticBranches(&part->law); j++) sum += part->law.value[j] / part->law.young;
  return sum;
}

PetscErrorCode BodiesGetCell(Bodies bodies, PetscInt c, BodiesCell *cell)
{
  const ModelScene *scene;
  const Element    *element;
  const Part       *part;
  Elasticity        material;
  PetscReal         x[ELEMENT_MAX_DOFS], me[ELEMENT_MAX_DOFS * ELEMENT_MAX_DOFS];

  PetscFunctionBeginUser;
  PetscCall(ModelGetScene(bodies->model, &scene));
  cell->part = bodies->mesh->cell_part[c];
  part       = &scene->parts[cell->part];
  PetscCall(ModelGetCellAt(bodies->model, c, part->layer.thickness, &element, cell->vertex, x));
  cell->n_nodes  = element->n_nodes;
  cell->alpha    = part->alpha;
  cell->beta     = part->beta;
  cell->branches = BranchesStiffness(part);
  PetscCall(ModelGetElasticity(bodies->model, c, part->young, part->density, &material));
  PetscCall(ElementMatrices(element, x, &material, cell->stiffness, me));
  ElementLump(element, me, cell->mass);
  PetscFunctionReturn(0);
}

/* Block of nodes a and b in their bases: Q_a A Q_b' */
static void BodiesCellTurnBlock(const PetscReal qa[9], const PetscReal qb[9], PetscInt n, PetscReal block[])
{
  PetscReal half[9];

  for (int i = 0; i < 3; i++)
    for (int e = 0; e < 3; e++)
      half[3 * i + e] = qa[3 * i] * block[e] + qa[3 * i + 1] * block[n + e] + qa[3 * i + 2] * block[2 * n + e];
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      block[n * i + j] = half[3 * i] * qb[3 * j] + half[3 * i + 1] * qb[3 * j + 1] + half[3 * i + 2] * qb[3 * j + 2];
}

void BodiesTurnCell(const Layout *layout, BodiesCell *cell)
{
  const PetscInt n = 3 * cell->n_nodes;

  for (PetscInt a = 0; a < cell->n_nodes; a++)
    for (PetscInt b = 0; b < cell->n_nodes; b++)
      BodiesCellTurnBlock(&layout->basis[9 * cell->vertex[a]], &layout->basis[9 * cell->vertex[b]], n,
                          &cell->stiffness[3 * a * n + 3 * b]);
}

/* Displacements (m) of a cell's nodes relative to the first one, Cartesian; whether there are any: cells at rest or
   in translation need no matrices. Backwards, since node 0 is taken off last. */
static PetscBool BodiesCellMoves(const Layout *layout, PetscInt n_nodes, const PetscInt vertex[], const PetscReal u[],
                                 PetscReal relative[])
{
  PetscBool moves = PETSC_FALSE;

  for (PetscInt a = 0; a < n_nodes; a++) LayoutGet(layout, vertex[a], u, &relative[3 * a]);
  for (PetscInt i = 3 * n_nodes - 1; i >= 0; i--) {
    relative[i] -= relative[i % 3];
    if (relative[i] != 0) moves = PETSC_TRUE;
  }
  return moves;
}

/* ku += K_e u_e */
static void BodiesCellAddForces(const Layout *layout, const BodiesCell *cell, const PetscReal relative[],
                                PetscReal ku[])
{
  const PetscInt n = 3 * cell->n_nodes;

  for (PetscInt a = 0; a < cell->n_nodes; a++) {
    PetscReal force[3] = {0, 0, 0};

    for (PetscInt i = 0; i < 3; i++)
      for (PetscInt j = 3; j < n; j++) force[i] += cell->stiffness[(3 * a + i) * n + j] * relative[j];
    LayoutAdd(layout, cell->vertex[a], force, ku);
  }
}

PetscErrorCode BodiesCellsAddForces(Bodies bodies, const PetscReal u[], PetscReal ku[])
{
  const Mesh *mesh = bodies->mesh;

  PetscFunctionBeginUser;
  for (PetscInt c = 0; c < mesh->n_cells; c++) {
    PetscReal  relative[ELEMENT_MAX_DOFS];
    BodiesCell cell;

    if (!BodiesCellMoves(&bodies->layout, mesh->element[c]->n_nodes, &mesh->cell_node[mesh->cell_first[c]], u,
                         relative))
      continue;
    PetscCall(BodiesGetCell(bodies, c, &cell));
    BodiesCellAddForces(&bodies->layout, &cell, relative, ku);
  }
  PetscFunctionReturn(0);
}
