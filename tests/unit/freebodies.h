/*
   What the tests of turning surfaces and preload share: a disc, pad and beam that nothing holds, so that rigid
   motions are motions of the unknowns, and displacement fields as vectors. The pad stands on nodes of the disc, or
   between them.
*/
#pragma once

#include "base/algebra/vec3.h"
#include "brake.h"

#define FREE                                                                                                           \
  "-model_source rig -rig_disc_elements 6,12,1 -rig_pad_elements 3,3,2 -rig_beam_elements 4 -contacts contact "        \
  "-contact_surfaces pad_face,disc_face -contact_slip 3,4,0 -contact_mu 0.5 -contact_kn 1e8 -beam_density 7800 "       \
  "-beam_young 190e9 -contact_tolerance 1e-3 "
#define BETWEEN "-rig_disc_mesh axisymmetric "

static const PetscReal turn[3] = {0.3, -0.7, 0.5}; /* a rotation, rad */

/* A field over the vertices at x; from any local vector of three values per vertex where it is given */
typedef void (*Field)(const PetscReal x[3], const PetscReal value[3], PetscReal u[3]);

static inline void Rotation(const PetscReal x[3], const PetscReal value[3], PetscReal u[3])
{
  (void)value;
  Vec3Cross(turn, x, u);
}

/* A field as a vector of the unknowns, at the vertices of a set or, where it is NULL, at all */
static inline PetscErrorCode FieldCreate(const Chain *chain, Field field, const char set[], Vec local, Vec *u)
{
  const Mesh        *mesh;
  const PetscScalar *value = NULL;
  PetscInt           n, *vertices = NULL;

  PetscFunctionBeginUser;
  PetscCall(OperatorsCreateVec(chain->operators, u));
  PetscCall(VecSetOption(*u, VEC_IGNORE_NEGATIVE_INDICES, PETSC_TRUE));
  PetscCall(ModelGetMesh(chain->model, &mesh));
  n = mesh->n_nodes;
  if (set) PetscCall(ModelGetSetNodes(chain->model, set, &n, &vertices));
  if (local) PetscCall(VecGetArrayRead(local, &value));
  for (PetscInt i = 0; i < n; i++) {
    const PetscInt v = 3 * (vertices ? vertices[i] : i);
    PetscReal      here[3];

    field(&mesh->x[v], value ? &value[v] : NULL, here);
    PetscCall(VecSetValues(*u, 3, &mesh->unknown[v], here, INSERT_VALUES));
  }
  if (local) PetscCall(VecRestoreArrayRead(local, &value));
  PetscCall(PetscFree(vertices));
  PetscCall(VecAssemblyBegin(*u));
  PetscCall(VecAssemblyEnd(*u));
  PetscFunctionReturn(0);
}

/* |A x - y| / |y|; y may be NULL for zero: |A x| / |A|_F |x| */
static inline PetscErrorCode Mismatch(Mat A, Vec x, Vec y, PetscReal *error)
{
  PetscReal scale, norm;
  Vec       r;

  PetscFunctionBeginUser;
  PetscCall(MatCreateVecs(A, NULL, &r));
  PetscCall(MatMult(A, x, r));
  if (y) {
    PetscCall(VecNorm(y, NORM_2, &scale));
    PetscCall(VecAXPY(r, -1, y));
  } else {
    PetscCall(MatNorm(A, NORM_FROBENIUS, &scale));
    PetscCall(VecNorm(x, NORM_2, &norm));
    scale *= norm;
  }
  PetscCall(VecNorm(r, NORM_2, error));
  *error /= scale;
  PetscCall(VecDestroy(&r));
  PetscFunctionReturn(0);
}
