/* Bodies of a scene, fields on them as state vectors, and these beside the assembled matrices */
#pragma once

#include "brake.h"
#include "dynamics/bodies/bodies.h"

typedef struct {
  Model         model;
  Contact       contact;
  Operators     operators;
  Bodies        bodies;
  const Layout *layout;
} Case;

/* Sets up a scene with more options */
static inline PetscErrorCode CaseCreate(const char scene[], const char options[], Case *c)
{
  PetscFunctionBeginUser;
  PetscCall(PetscOptionsClear(NULL));
  PetscCall(PetscOptionsInsertString(NULL, scene));
  PetscCall(PetscOptionsInsertString(NULL, options));
  PetscCall(OperatorsCreate(PETSC_COMM_WORLD, &c->operators));
  PetscCall(OperatorsSetFromOptions(c->operators));
  PetscCall(ModelCreate(PETSC_COMM_WORLD, &c->model));
  PetscCall(ModelSetFromOptions(c->model));
  PetscCall(ContactCreate(c->model, &c->contact));
  PetscCall(OperatorsSetModel(c->operators, c->model, c->contact));
  PetscCall(ModelKeepSlabs(c->model));
  PetscCall(ModelSetUp(c->model));
  PetscCall(ContactSetUp(c->contact));
  PetscCall(OperatorsSetUp(c->operators));
  PetscCall(BodiesCreate(PETSC_COMM_WORLD, &c->bodies));
  PetscCall(BodiesSetFromOptions(c->bodies));
  PetscCall(BodiesSetUp(c->bodies, c->operators));
  PetscCall(BodiesGetLayout(c->bodies, &c->layout));
  PetscFunctionReturn(0);
}

static inline PetscErrorCode CaseDestroy(Case *c)
{
  PetscFunctionBeginUser;
  PetscCall(BodiesDestroy(&c->bodies));
  PetscCall(OperatorsDestroy(&c->operators));
  PetscCall(ContactDestroy(&c->contact));
  PetscCall(ModelDestroy(&c->model));
  PetscFunctionReturn(0);
}

/* State vector of a field that wobbles within a few elements (m), zero in held directions */
static inline PetscErrorCode FieldSet(const Case *c, PetscInt seed, PetscReal x[])
{
  const Mesh *mesh;

  PetscFunctionBeginUser;
  PetscCall(ModelGetMesh(c->model, &mesh));
  PetscCall(PetscArrayzero(x, c->layout->n));
  for (PetscInt v = 0; v < c->layout->n_vertices; v++) {
    const PetscReal *p = &mesh->x[3 * v];
    PetscReal        u[3];

    if (c->layout->at[v] < 0) continue;
    for (int d = 0; d < 3; d++)
      u[d] = mesh->unknown[3 * v + d] < 0 ? 0 : PetscSinReal((d + seed + 1) * 130 * p[0] + 210 * p[1] - 170 * p[2] + d);
    LayoutSet(c->layout, v, u, x);
  }
  PetscFunctionReturn(0);
}

/* The values of a state vector at the unknowns, from the owners of the vertices */
static inline PetscErrorCode StateRestrict(const Case *c, const PetscReal x[], Vec u)
{
  const Mesh *mesh;

  PetscFunctionBeginUser;
  PetscCall(ModelGetMesh(c->model, &mesh));
  PetscCall(VecSetOption(u, VEC_IGNORE_NEGATIVE_INDICES, PETSC_TRUE));
  for (PetscInt v = 0; v < c->layout->n_vertices; v++) {
    PetscReal value[3];

    if (c->layout->at[v] < 0 || !c->layout->owned[v]) continue;
    LayoutGet(c->layout, v, x, value);
    PetscCall(VecSetValues(u, 3, &mesh->unknown[3 * v], value, INSERT_VALUES));
  }
  PetscCall(VecAssemblyBegin(u));
  PetscCall(VecAssemblyEnd(u));
  PetscFunctionReturn(0);
}

/* |state - A x| / |A x|, largest components; A NULL for zero */
static inline PetscErrorCode StateCompare(const Case *c, Mat A, const PetscReal x[], const PetscReal state[],
                                          PetscReal *error)
{
  Vec       vec, product, own;
  PetscReal norm = 0;

  PetscFunctionBeginUser;
  PetscCall(OperatorsCreateVec(c->operators, &vec));
  PetscCall(VecDuplicate(vec, &product));
  PetscCall(VecDuplicate(vec, &own));
  PetscCall(StateRestrict(c, x, vec));
  PetscCall(StateRestrict(c, state, own));
  if (A) PetscCall(MatMult(A, vec, product));
  PetscCall(VecNorm(product, NORM_INFINITY, &norm));
  PetscCall(VecAXPY(own, -1, product));
  PetscCall(VecNorm(own, NORM_INFINITY, error));
  if (norm > 0) *error /= norm;
  PetscCall(VecDestroy(&vec));
  PetscCall(VecDestroy(&product));
  PetscCall(VecDestroy(&own));
  PetscFunctionReturn(0);
}

/* Number of components at copies of vertices that differ from the owner's in any bit */
static inline PetscErrorCode CopiesCompare(const Case *c, const PetscReal x[], PetscInt *n_different)
{
  Vec          global, local;
  PetscScalar *value;
  DM           dm, cdm;

  PetscFunctionBeginUser;
  PetscCall(ModelGetDM(c->model, &dm));
  PetscCall(DMGetCoordinateDM(dm, &cdm));
  PetscCall(DMGetGlobalVector(cdm, &global));
  PetscCall(DMGetLocalVector(cdm, &local));
  PetscCall(VecSet(local, 0));
  *n_different = 0;
  for (int pass = 0; pass < 2; pass++) {
    PetscCall(VecGetArray(local, &value));
    for (PetscInt i = 0; i < 3 * c->layout->n_vertices; i++) {
      const PetscInt at = c->layout->at[i / 3];

      if (at < 0) continue;
      if (pass == 0)
        value[i] = x[at + i % 3 * c->layout->step[i / 3]];
      else
        *n_different += value[i] != x[at + i % 3 * c->layout->step[i / 3]];
    }
    PetscCall(VecRestoreArray(local, &value));
    if (pass == 0) PetscCall(DMLocalToGlobal(cdm, local, INSERT_VALUES, global));
    if (pass == 0) PetscCall(DMGlobalToLocal(cdm, global, INSERT_VALUES, local));
  }
  PetscCall(DMRestoreGlobalVector(cdm, &global));
  PetscCall(DMRestoreLocalVector(cdm, &local));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, n_different, 1, MPIU_INT, MPI_SUM, PETSC_COMM_WORLD));
  PetscFunctionReturn(0);
}
