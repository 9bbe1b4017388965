/* A coarse brake (disc, pad, beam; 2127 unknowns) as options, and the chain that is set up from options */
#pragma once

#include <squeal/pencil.h>

#define BRAKE                                                                                                          \
  "-model_source rig -rig_disc_elements 8,24,1 -rig_pad_elements 4,4,2 -rig_beam_elements 10 -supports hub "           \
  "-hub_set disc_inner -springs rows -rows_set beam_rows -contacts contact -contact_surfaces pad_face,disc_face "
#define SLIP         "-contact_slip 0,1,0 "
#define CONSTRAINED  "-contact_law constraint "
#define TWO_CONTACTS "-contacts contact,more -more_surfaces pad_face,disc_face -more_slip 1,1,0 "
#define DAMPED       "-contact_friction_damping -dashpots oil -oil_set beam_rows "
#define BODIES_1     "-disc_young 210e9 -disc_density 7800 -pad_young 25.1e9 -pad_density 2500 "
#define BODIES_2     "-disc_young 110e9 -disc_density 7100 -pad_young 71e9 -pad_density 1300 "
#define BEAM_1       "-beam_young 2100e9 -beam_density 78000 -rows_stiffness 0,8.422e6,0 -contact_kn 2.5895e8 "
#define BEAM_2       "-beam_young 190e9 -beam_density 7700 -rows_stiffness 0,3.1e7,0 -contact_kn 7.7e9 "
#define BEAM_XYZ     "-beam_young 190e9 -beam_density 7700 -rows_stiffness 1e6,3.1e7,2e5 -contact_kn 7.7e9 "
#define ROLLING      "-contact_force 130 -contact_mu_slope -0.02 -oil_viscosity 3,3,0 -disc_beta 1e-7 -pad_alpha 12 "

typedef struct {
  Model     model;
  Contact   contact;
  Operators operators;
  Pencil    pencil; /* NULL before ChainLinearise() */
} Chain;

/* Sets up a scene with a set of values */
static inline PetscErrorCode ChainCreate(const char scene[], const char values[], Chain *chain)
{
  PetscFunctionBeginUser;
  PetscCall(PetscOptionsClear(NULL));
  PetscCall(PetscOptionsInsertString(NULL, scene));
  PetscCall(PetscOptionsInsertString(NULL, values));
  PetscCall(OperatorsCreate(PETSC_COMM_WORLD, &chain->operators));
  PetscCall(OperatorsSetFromOptions(chain->operators));
  PetscCall(ModelCreate(PETSC_COMM_WORLD, &chain->model));
  PetscCall(ModelSetFromOptions(chain->model));
  PetscCall(ContactCreate(chain->model, &chain->contact));
  PetscCall(ContactSetFromOptions(chain->contact));
  PetscCall(OperatorsSetModel(chain->operators, chain->model, chain->contact));
  PetscCall(ModelSetUp(chain->model));
  PetscCall(ContactSetUp(chain->contact));
  PetscCall(OperatorsSetUp(chain->operators));
  chain->pencil = NULL;
  PetscFunctionReturn(0);
}

/* Another pencil in place of the one before */
static inline PetscErrorCode ChainLinearise(Chain *chain, const SlidingState *state)
{
  PetscFunctionBeginUser;
  PetscCall(PencilDestroy(&chain->pencil));
  PetscCall(OperatorsLinearise(chain->operators, state, &chain->pencil));
  PetscFunctionReturn(0);
}

static inline PetscErrorCode ChainDestroy(Chain *chain)
{
  PetscFunctionBeginUser;
  PetscCall(PencilDestroy(&chain->pencil));
  PetscCall(OperatorsDestroy(&chain->operators));
  PetscCall(ContactDestroy(&chain->contact));
  PetscCall(ModelDestroy(&chain->model));
  PetscFunctionReturn(0);
}

/* All loads of the scene as a vector of the unknowns, N */
static inline PetscErrorCode ChainCreateLoads(const Chain *chain, Vec *f)
{
  const Mesh        *mesh;
  const PetscScalar *value;
  const ModelScene  *scene;
  PetscInt           n;
  Vec                local;

  PetscFunctionBeginUser;
  PetscCall(OperatorsCreateVec(chain->operators, f));
  PetscCall(VecSetOption(*f, VEC_IGNORE_NEGATIVE_INDICES, PETSC_TRUE));
  PetscCall(ModelCreateNodal(chain->model, &local));
  PetscCall(ModelGetScene(chain->model, &scene));
  for (PetscInt i = 0; i < scene->n_loads; i++) PetscCall(ModelAddLoad(chain->model, i, NULL, local));
  PetscCall(ModelGetMesh(chain->model, &mesh));
  PetscCall(VecGetLocalSize(local, &n));
  PetscCall(VecGetArrayRead(local, &value));
  PetscCall(VecSetValues(*f, n, mesh->unknown, value, INSERT_VALUES));
  PetscCall(VecRestoreArrayRead(local, &value));
  PetscCall(VecAssemblyBegin(*f));
  PetscCall(VecAssemblyEnd(*f));
  PetscCall(VecDestroy(&local));
  PetscFunctionReturn(0);
}

/* N, T and B of one interface, NULL for what is not needed */
static inline PetscErrorCode InterfaceOperators(Contact contact, PetscInt interface, Mat *N, Mat *T, Mat *B)
{
  const ContactPair *pairs;
  PetscInt           n = 0, n_pairs, n_all, *pair;

  PetscFunctionBeginUser;
  PetscCall(ContactGetPairs(contact, &n_pairs, &n_all, &pairs));
  PetscCall(PetscMalloc1(n_pairs, &pair));
  for (PetscInt p = 0; p < n_pairs; p++)
    if (pairs[p].interface == interface) pair[n++] = p;
  PetscCall(ContactCreatePairOperators(contact, n, pair, N, T, B));
  PetscCall(PetscFree(pair));
  PetscFunctionReturn(0);
}

/* r = (N - mu T) u over the pairs of the first interface */
static inline PetscErrorCode ChainConstrain(const Chain *chain, PetscReal mu, Vec u, Vec *r)
{
  Mat N, T;

  PetscFunctionBeginUser;
  PetscCall(InterfaceOperators(chain->contact, 0, &N, &T, NULL));
  PetscCall(MatAXPY(N, -mu, T, DIFFERENT_NONZERO_PATTERN));
  PetscCall(MatCreateVecs(N, NULL, r));
  PetscCall(MatMult(N, u, *r));
  PetscCall(MatDestroy(&N));
  PetscCall(MatDestroy(&T));
  PetscFunctionReturn(0);
}
