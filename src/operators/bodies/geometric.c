/*
   Geometric stiffness of the bodies, K_sigma = sum over cells of int (grad N_a . sigma grad N_b) I dV, N/m, of the
   stress sigma of static displacements u, sigma = D B u_e, linear in u (kernels/element/geometric.h).
*/
#include "operators/operatorsimpl.h"

/* Adds local cell c with displacements u, three values per local node */
static PetscErrorCode GeometricAddCell(Model model, PetscInt c, PetscReal thickness, const Elasticity *material,
                                       const PetscReal u[], Mat K)
{
  const Element *element;
  const Mesh    *mesh;
  PetscInt       n, vertices[ELEMENT_MAX_NODES], rows[ELEMENT_MAX_DOFS];
  PetscReal      x[ELEMENT_MAX_DOFS], ue[ELEMENT_MAX_DOFS], ke[ELEMENT_MAX_DOFS * ELEMENT_MAX_DOFS];

  PetscFunctionBeginUser;
  PetscCall(ModelGetMesh(model, &mesh));
  PetscCall(ModelGetCellAt(model, c, thickness, &element, vertices, x));
  n = 3 * element->n_nodes;
  for (PetscInt i = 0; i < n; i++) {
    const PetscInt at = 3 * vertices[i / 3] + i % 3;

    rows[i] = mesh->unknown[at];
    ue[i]   = u[at];
  }
  PetscCall(ElementGeometric(element, x, material, ue, ke));
  PetscCall(MatSetValues(K, n, rows, n, rows, ke, ADD_VALUES));
  PetscFunctionReturn(0);
}

/* Adds all local cells */
static PetscErrorCode GeometricAddCells(Operators operators, const PetscReal p[], Model model, const PetscReal u[],
                                        const PetscReal share[], Mat K)
{
  const ModelScene *scene;
  const Mesh       *mesh;
  PetscReal       **seen;

  PetscFunctionBeginUser;
  PetscCall(ModelGetMesh(model, &mesh));
  PetscCall(ModelGetScene(model, &scene));
  PetscCall(PetscMalloc1(scene->n_parts, &seen));
  for (PetscInt i = 0; i < scene->n_parts; i++) PetscCall(OperatorsGetSeen(operators, p, i, share, u, &seen[i]));
  for (PetscInt c = 0; c < mesh->n_cells; c++) {
    OperatorsMaterial values;
    Elasticity        material;

    PetscCall(OperatorsGetMaterial(operators, p, mesh->cell_part[c], &values));
    PetscCall(ModelGetElasticity(model, c, values.young, values.density, &material));
    PetscCall(GeometricAddCell(model, c, values.thickness, &material,
                               seen[mesh->cell_part[c]] ? seen[mesh->cell_part[c]] : u, K));
  }
  for (PetscInt i = 0; i < scene->n_parts; i++) PetscCall(PetscFree(seen[i]));
  PetscCall(PetscFree(seen));
  PetscFunctionReturn(0);
}

/* In the pattern of K of the bodies; u [nodes][3], m, of all local nodes. The caller destroys it. */
PetscErrorCode OperatorsCreateGeometric(Operators operators, const PetscReal p[], const PetscReal u[],
                                        const PetscReal share[], Mat *K)
{
  Mat bodies;

  PetscFunctionBeginUser;
  PetscCall(OperatorsGetBodies(operators, p, &bodies, NULL, NULL)); /* couples the same unknowns */
  PetscCall(MatDuplicate(bodies, MAT_DO_NOT_COPY_VALUES, K));
  PetscCall(MatSetOption(*K, MAT_NO_OFF_PROC_ENTRIES, PETSC_FALSE)); /* which sums of matrices set */
  PetscCall(GeometricAddCells(operators, p, operators->model, u, share, *K));
  PetscCall(MatAssemblyBegin(*K, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(*K, MAT_FINAL_ASSEMBLY));
  PetscFunctionReturn(0);
}
