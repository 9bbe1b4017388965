/*
   Internal forces of a displacement: f = sum over cells of K_e u_e (N), with Young's moduli at the point p, and those
   of bushings, points and superelements, at all nodes. Where supports hold a direction f is the force that they exert,
   as far as no load acts there. Displacements are taken relative to the first node of each cell: a translation gives no
   force, while in the assembled matrix its rounding resists like a spring of some 1e-16 of the stiffness.
*/
#include "operators/superelement/superelement.h"

/* Adds the forces of local cell c, f_i += sum_j K_ij (u_j - u_0), u_0 of its first node; u (m) and f (N) hold three
   values per local node. The rows of K_e sum to 0 over the nodes in each direction, so that u_0 takes nothing away
   but rounding. */
static PetscErrorCode OperatorsAddCellForce(Operators o, PetscInt c, PetscReal thickness, const Elasticity *material,
                                            const PetscScalar u[], PetscScalar f[])
{
  const Element *element;
  PetscInt       n, vertices[ELEMENT_MAX_NODES], at[ELEMENT_MAX_DOFS];
  PetscReal      x[ELEMENT_MAX_DOFS], ke[ELEMENT_MAX_DOFS * ELEMENT_MAX_DOFS], me[ELEMENT_MAX_DOFS * ELEMENT_MAX_DOFS];

  PetscFunctionBeginUser;
  PetscCall(ModelGetCellAt(o->model, c, thickness, &element, vertices, x));
  PetscCall(ElementMatrices(element, x, material, ke, me));
  n = 3 * element->n_nodes;
  for (PetscInt i = 0; i < n; i++) at[i] = 3 * vertices[i / 3] + i % 3;
  for (PetscInt i = 0; i < n; i++)
    for (PetscInt j = 3; j < n; j++) f[at[i]] += ke[n * i + j] * (u[at[j]] - u[at[j % 3]]);
  PetscFunctionReturn(0);
}

PetscErrorCode OperatorsAddCellForces(Operators o, const PetscReal p[], PetscInt part, const PetscScalar u[],
                                      PetscScalar f[])
{
  const Mesh *mesh;

  PetscFunctionBeginUser;
  PetscCall(ModelGetMesh(o->model, &mesh));
  for (PetscInt c = 0; c < mesh->n_cells; c++) {
    OperatorsMaterial values;
    Elasticity        material;

    if (part >= 0 && mesh->cell_part[c] != part) continue;
    PetscCall(OperatorsGetMaterial(o, p, mesh->cell_part[c], &values));
    PetscCall(ModelGetElasticity(o->model, c, values.young, 1, &material));
    PetscCall(OperatorsAddCellForce(o, c, values.thickness, &material, u, f));
  }
  PetscFunctionReturn(0);
}

/* Forces of displacements [nodes][3], complete at every node */
static PetscErrorCode OperatorsForcesOf(Operators o, const PetscReal p[], const PetscReal displacement[], Vec local)
{
  PetscScalar *force;

  PetscFunctionBeginUser;
  PetscCall(VecSet(local, 0));
  PetscCall(VecGetArray(local, &force));
  PetscCall(OperatorsAddCellForces(o, OperatorsPoint(o, p), -1, displacement, force));
  PetscCall(OperatorsAddJointForces(o, OperatorsPoint(o, p), PETSC_FALSE, displacement, force));
  PetscCall(VecRestoreArray(local, &force));
  PetscCall(ModelSumShared(o->model, local));
  PetscFunctionReturn(0);
}

PetscErrorCode OperatorsInternalForces(Operators operators, const PetscReal p[], Vec u, Vec local)
{
  const Mesh *mesh;
  PetscReal  *displacement;
  Vec         joined;

  PetscFunctionBeginUser;
  PetscCheck(operators->model, operators->comm, PETSC_ERR_ARG_WRONGSTATE,
             "internal forces need a model: loaded matrices have no elements");
  PetscCall(ModelGetMesh(operators->model, &mesh));
  PetscCall(PetscMalloc1(3 * mesh->n_nodes, &displacement));
  PetscCall(ModelGetNodal(operators->model, u, displacement));
  PetscCall(OperatorsForcesOf(operators, p, displacement, local));
  if (operators->n_superelements) {
    PetscScalar *force;

    PetscCall(ModelCreateNodal(operators->model, &joined));
    PetscCall(VecGetArray(joined, &force));
    PetscCall(SuperelementsAddForces(operators, OperatorsPoint(operators, p), u, displacement, force));
    PetscCall(VecRestoreArray(joined, &force));
    PetscCall(ModelSumShared(operators->model, joined));
    PetscCall(VecAXPY(local, 1, joined));
    PetscCall(VecDestroy(&joined));
  }
  PetscCall(PetscFree(displacement));
  PetscFunctionReturn(0);
}

/* K times the displacements that supports prescribe, N: what they add to the right-hand side with the other sign. */
PetscErrorCode OperatorsPrescribedForces(Operators operators, const PetscReal p[], const PetscReal prescribed[],
                                         Vec local)
{
  PetscFunctionBeginUser;
  if (prescribed)
    PetscCall(OperatorsForcesOf(operators, p, prescribed, local));
  else
    PetscCall(VecSet(local, 0));
  PetscFunctionReturn(0);
}

PetscErrorCode OperatorsPrescribedDrag(Operators o, const PetscReal p[], const PetscReal prescribed[], Vec local)
{
  const PetscReal  *value = OperatorsPoint(o, p);
  const ModelScene *scene;
  PetscScalar      *force, *part;
  PetscInt          n;

  PetscFunctionBeginUser;
  PetscCall(ModelGetScene(o->model, &scene));
  PetscCall(VecSet(local, 0));
  PetscCall(VecGetLocalSize(local, &n));
  PetscCall(PetscMalloc1(n, &part));
  PetscCall(VecGetArray(local, &force));
  for (PetscInt k = 0; k < scene->n_parts; k++) {
    const PetscReal beta = value[N_PART_PARAMETERS * k + PART_BETA];

    if (beta == 0) continue;
    PetscCall(PetscArrayzero(part, n));
    PetscCall(OperatorsAddCellForces(o, value, k, prescribed, part));
    for (PetscInt i = 0; i < n; i++) force[i] += beta * part[i];
  }
  PetscCall(OperatorsAddJointForces(o, value, PETSC_TRUE, prescribed, force));
  PetscCall(VecRestoreArray(local, &force));
  PetscCall(PetscFree(part));
  PetscCall(ModelSumShared(o->model, local));
  PetscFunctionReturn(0);
}

/* Adds the weight of local cell c: sum_j m_ij g, the mass matrix times a uniform acceleration */
static PetscErrorCode OperatorsAddCellWeight(Operators o, PetscInt c, PetscReal thickness, const Elasticity *material,
                                             PetscScalar f[])
{
  const ModelScene *scene;
  const Element    *element;
  PetscInt          n, vertices[ELEMENT_MAX_NODES];
  PetscReal x[ELEMENT_MAX_DOFS], ke[ELEMENT_MAX_DOFS * ELEMENT_MAX_DOFS], me[ELEMENT_MAX_DOFS * ELEMENT_MAX_DOFS];

  PetscFunctionBeginUser;
  PetscCall(ModelGetScene(o->model, &scene));
  PetscCall(ModelGetCellAt(o->model, c, thickness, &element, vertices, x));
  PetscCall(ElementMatrices(element, x, material, ke, me));
  n = 3 * element->n_nodes;
  for (PetscInt i = 0; i < n; i++)
    for (PetscInt j = i % 3; j < n; j += 3) f[3 * vertices[i / 3] + i % 3] += me[n * i + j] * scene->gravity[i % 3];
  PetscFunctionReturn(0);
}

/* The consistent mass in all runs: lumped or not, a body weighs the same. E = 1, nu = 0 stand in for a stiffness that
   is not used. total (N) counts what falls on held directions too. */
PetscErrorCode OperatorsAddWeight(Operators operators, const PetscReal p[], Vec local, PetscReal total[3])
{
  const ModelScene *scene;
  const Mesh       *mesh;
  PetscScalar      *force;
  PetscInt          n;
  Vec               weight;

  PetscFunctionBeginUser;
  for (int d = 0; d < 3; d++) total[d] = 0;
  if (!operators->model || !ModelHasGravity(operators->model)) PetscFunctionReturn(0);
  PetscCall(SuperelementsCheckWeight(operators));
  PetscCall(ModelGetMesh(operators->model, &mesh));
  PetscCall(ModelGetScene(operators->model, &scene));
  PetscCall(ModelCreateNodal(operators->model, &weight));
  PetscCall(VecGetLocalSize(weight, &n));
  PetscCall(VecGetArray(weight, &force));
  for (PetscInt c = 0; c < mesh->n_cells; c++) {
    OperatorsMaterial values;
    Elasticity        material;

    PetscCall(OperatorsGetMaterial(operators, p, mesh->cell_part[c], &values));
    material = ElasticityFromEngineering(1, 0, values.density);
    PetscCall(OperatorsAddCellWeight(operators, c, values.thickness, &material, force));
  }
  for (PetscInt i = 0; i < n; i++) total[i % 3] += PetscRealPart(force[i]);
  PetscCall(OperatorsAddJointWeight(operators, OperatorsPoint(operators, p), force, total));
  PetscCall(VecRestoreArray(weight, &force));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, total, 3, MPIU_REAL, MPI_SUM, operators->comm));
  PetscCall(ModelSumShared(operators->model, weight));
  PetscCall(VecAXPY(local, 1, weight));
  PetscCall(VecDestroy(&weight));
  PetscFunctionReturn(0);
}

/* Nodal values, complete at every node, into the rows of this rank; held directions have none, and their values are
   left behind; unknowns that no node has become 0. */
PetscErrorCode OperatorsTakeNodal(Operators operators, Vec local, Vec f)
{
  const PetscScalar *force;
  const Mesh        *mesh;
  PetscScalar       *value;

  PetscFunctionBeginUser;
  PetscCall(ModelGetMesh(operators->model, &mesh));
  PetscCall(VecGetArrayRead(local, &force));
  PetscCall(VecGetArray(f, &value));
  for (PetscInt i = 0; i < 3 * mesh->n_nodes; i++) {
    const PetscInt row = mesh->unknown[i] - mesh->first_own;

    if (mesh->unknown[i] >= 0 && row >= 0 && row < mesh->n_own) value[row] = force[i];
  }
  for (PetscInt row = mesh->n_own - MeshCountApart(mesh); row < mesh->n_own; row++) value[row] = 0;
  PetscCall(VecRestoreArray(f, &value));
  PetscCall(VecRestoreArrayRead(local, &force));
  PetscFunctionReturn(0);
}

/* f += forces of the springs, N: stiffness terms whose first parameter comes after those of the parts and before
   those of bushings and points */
static PetscErrorCode OperatorsAddSpringForces(Operators o, const PetscReal p[], Vec u, Vec f)
{
  const ModelScene *scene;
  Vec               part;

  PetscFunctionBeginUser;
  PetscCall(ModelGetScene(o->model, &scene));
  PetscCall(VecDuplicate(f, &part));
  for (PetscInt t = 0; t < o->terms.n; t++) {
    const OperatorsTerm *term = &o->terms.term[t];

    if (term->law || term->kind != OPERATORS_STIFFNESS ||
        term->factor[0].parameter < N_PART_PARAMETERS * scene->n_parts)
      continue;
    if (term->factor[0].parameter >= o->n_local) continue; /* bushings and points are among the internal forces */
    PetscCall(MatMult(term->A, u, part));
    PetscCall(VecAXPY(f, OperatorsTermCoefficient(term, p), part));
  }
  PetscCall(VecDestroy(&part));
  PetscFunctionReturn(0);
}

PetscErrorCode OperatorsApplyBodies(Operators operators, const PetscReal p[], Vec u, Vec f)
{
  Vec local;

  PetscFunctionBeginUser;
  PetscCall(ModelCreateNodal(operators->model, &local));
  PetscCall(OperatorsInternalForces(operators, p, u, local));
  PetscCall(OperatorsTakeNodal(operators, local, f));
  PetscCall(VecDestroy(&local));
  PetscCall(OperatorsAddSpringForces(operators, OperatorsPoint(operators, p), u, f));
  PetscCall(SuperelementsAddForcesApart(operators, OperatorsPoint(operators, p), u, f));
  PetscFunctionReturn(0);
}
