/*
   The state as fields on the mesh: displacement (m), force of the contact on each node (N), and its pressure on both
   surfaces, p_v = -F_v . n_v / A_v with the outward normal and the node's share of the area (Pa).
*/
#include "staticsimpl.h"

/* Sets the pressure on one surface. The force of a node is that of all interfaces, and so is its pressure: on a node of
   several surfaces the last one counts, with its normal and area */
static PetscErrorCode PressureSet(Model model, const char set[], const PetscScalar force[], PetscReal pressure[])
{
  const PetscInt *v;
  PetscInt        n;
  PetscReal      *normals;
  IS              is;

  PetscFunctionBeginUser;
  PetscCall(ModelGetSetNormals(model, set, &normals));
  PetscCall(ModelGetSetVertices(model, set, &is));
  PetscCall(ISGetLocalSize(is, &n));
  PetscCall(ISGetIndices(is, &v));
  for (PetscInt i = 0; i < n; i++) {
    const PetscInt at   = 3 * v[i];
    PetscReal      area = 0, along = 0;

    for (int d = 0; d < 3; d++) {
      area += PetscSqr(normals[at + d]);
      along -= normals[at + d] * PetscRealPart(force[at + d]);
    }
    if (area > 0) pressure[at / 3] = along / area;
  }
  PetscCall(ISRestoreIndices(is, &v));
  PetscCall(ISDestroy(&is));
  PetscCall(PetscFree(normals));
  PetscFunctionReturn(0);
}

/* Pressure of all interfaces at the local vertices; the caller frees it */
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
    (const ResultsNodal[]){
      {"displacement_m",      3, u       },
      {"contact_force_n",     3, f       },
      {"contact_pressure_pa", 1, pressure}
  }));
  PetscCall(VecRestoreArrayRead(force, &f));
  PetscCall(VecRestoreArrayRead(displacement, &u));
  PetscCall(ResultsFieldClose(&field));
  PetscCall(PetscFree(pressure));
  PetscCall(VecDestroy(&force));
  PetscCall(VecDestroy(&displacement));
  PetscFunctionReturn(0);
}
