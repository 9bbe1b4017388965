/*
   The state as fields on the mesh: displacement (m), force of the contact on each node (N), and its pressure on both
   surfaces from p_v = -F_v . n_v with the outward normal (Pa, pressure.c).
*/
#include "statics/staticsimpl.h"
#include "base/algebra/vec3.h"

/* The values of all local nodes from a vector in the order of their global numbers */
static PetscErrorCode NodesScatter(const Mesh *mesh, Vec values, PetscReal local[])
{
  Vec        place;
  IS         from;
  VecScatter scatter;

  PetscFunctionBeginUser;
  PetscCall(VecCreateSeqWithArray(PETSC_COMM_SELF, 1, mesh->n_nodes, local, &place));
  PetscCall(ISCreateGeneral(PETSC_COMM_SELF, mesh->n_nodes, mesh->number, PETSC_USE_POINTER, &from));
  PetscCall(VecScatterCreate(values, from, place, NULL, &scatter));
  PetscCall(VecScatterBegin(scatter, values, place, INSERT_VALUES, SCATTER_FORWARD));
  PetscCall(VecScatterEnd(scatter, values, place, INSERT_VALUES, SCATTER_FORWARD));
  PetscCall(VecScatterDestroy(&scatter));
  PetscCall(ISDestroy(&from));
  PetscCall(VecDestroy(&place));
  PetscFunctionReturn(0);
}

/* The pressures (Pa) of the nodes of a surface with faces of second order, by -F . n of each, N; else they stay what
   they are, force over the node's area */
static PetscErrorCode PressureSpread(Model model, const char set[], const PetscReal along[], PetscReal pressure[])
{
  const Mesh *mesh;
  PetscBool   recovered;
  Vec         forces;

  PetscFunctionBeginUser;
  PetscCall(ModelGetMesh(model, &mesh));
  PetscCall(PressureCreateForces(model, &forces));
  for (PetscInt v = 0; v < mesh->n_nodes; v++)
    if (mesh->owned[v]) PetscCall(VecSetValue(forces, mesh->number[v], along[v], INSERT_VALUES));
  PetscCall(VecAssemblyBegin(forces));
  PetscCall(VecAssemblyEnd(forces));
  PetscCall(PressureRecover(model, set, forces, &recovered));
  if (recovered) PetscCall(NodesScatter(mesh, forces, pressure));
  PetscCall(VecDestroy(&forces));
  PetscFunctionReturn(0);
}

/* Sets the pressure on one surface. The force of a node is that of all interfaces, and so is its pressure: on a node of
   several surfaces the last one counts, with its normal and area */
static PetscErrorCode PressureSet(Model model, const char set[], const PetscScalar force[], PetscReal pressure[])
{
  const Mesh *mesh;
  PetscInt    n, *v;
  PetscReal  *normals, *along, *spread;

  PetscFunctionBeginUser;
  PetscCall(ModelGetMesh(model, &mesh));
  PetscCall(ModelGetSetNormals(model, set, &normals));
  PetscCall(ModelGetSetNodes(model, set, &n, &v));
  PetscCall(PetscCalloc2(mesh->n_nodes, &along, mesh->n_nodes, &spread));
  for (PetscInt i = 0; i < n; i++) {
    const PetscReal area = Vec3Length(&normals[3 * v[i]]);

    for (int d = 0; d < 3 && area > 0; d++)
      along[v[i]] -= normals[3 * v[i] + d] / area * PetscRealPart(force[3 * v[i] + d]);
    if (area > 0) spread[v[i]] = along[v[i]] / area;
  }
  PetscCall(PressureSpread(model, set, along, spread));
  for (PetscInt i = 0; i < n; i++)
    if (Vec3Length(&normals[3 * v[i]]) > 0) pressure[v[i]] = spread[v[i]];
  PetscCall(PetscFree(v));
  PetscCall(PetscFree2(along, spread));
  PetscCall(PetscFree(normals));
  PetscFunctionReturn(0);
}

/* Pressure of all interfaces at the local nodes; the caller frees it */
static PetscErrorCode PressureCreate(Statics s, Vec force, PetscReal **pressure)
{
  const PetscScalar *value;
  PetscInt           n;

  PetscFunctionBeginUser;
  PetscCall(VecGetLocalSize(force, &n));
  PetscCall(PetscCalloc1(n / 3, pressure));
  PetscCall(VecGetArrayRead(force, &value));
  for (PetscInt i = 0; i < s->rows.n_interfaces; i++) {
    PetscCall(PressureSet(s->model, s->rows.interface[i].slave, value, *pressure));
    PetscCall(PressureSet(s->model, s->rows.interface[i].master, value, *pressure));
  }
  PetscCall(VecRestoreArrayRead(force, &value));
  PetscFunctionReturn(0);
}

PetscErrorCode StaticsWriteFields(Statics s, Results results)
{
  const PetscScalar *u, *f;
  PetscReal         *pressure;
  const Mesh        *mesh;
  PetscBool          wanted;
  ResultsField       field;
  Vec                displacement, force;

  PetscFunctionBeginUser;
  PetscCall(ResultsWantFields(results, &wanted));
  if (!wanted) PetscFunctionReturn(0);
  PetscCall(StaticsCreateDisplacements(s, &displacement));
  PetscCall(VecDuplicate(displacement, &force));
  PetscCall(ContactNodalForces(s->contact, s->state, force));
  PetscCall(PressureCreate(s, force, &pressure));
  PetscCall(ModelGetMesh(s->model, &mesh));
  PetscCall(ResultsFieldOpen(results, "static", mesh, &field));
  PetscCall(VecGetArrayRead(displacement, &u));
  PetscCall(VecGetArrayRead(force, &f));
  PetscCall(ResultsFieldWriteNodal(
    field, "static equilibrium", 3,
    (const ResultsNodal[]){{"displacement_m", 3, u}, {"contact_force_n", 3, f}, {"contact_pressure_pa", 1, pressure}}));
  PetscCall(VecRestoreArrayRead(force, &f));
  PetscCall(VecRestoreArrayRead(displacement, &u));
  PetscCall(ResultsFieldClose(&field));
  PetscCall(PetscFree(pressure));
  PetscCall(VecDestroy(&force));
  PetscCall(VecDestroy(&displacement));
  PetscFunctionReturn(0);
}
