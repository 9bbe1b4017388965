/*
   Forces of the contact at the nodes of the mesh: -lambda_n n + lambda_t t + lambda_b b on the master point, shared by
   the corners of its facet with their weights, and the opposite on the slave. Nodes that a support holds are included.
*/
#include "contactimpl.h"

/* The three places of vertex `number` in a vector of three values per vertex */
static void Places(PetscInt number, PetscInt place[3])
{
  for (PetscInt d = 0; d < 3; d++) place[d] = 3 * number + d;
}

/* Adds the force of one pair to slave and master */
static PetscErrorCode PairAddForce(const ContactPair *pair, PetscInt slave, const ContactState *state, Vec forces)
{
  PetscScalar force[3], part[3];
  PetscInt    place[3];

  PetscFunctionBeginUser;
  for (int d = 0; d < 3; d++)
    force[d] = -state->lambda_n * pair->n[d] + state->lambda_t[0] * pair->t[d] + state->lambda_t[1] * pair->b[d];
  for (PetscInt i = 0; i < pair->n_master; i++) {
    Places(pair->corner[i], place);
    for (int d = 0; d < 3; d++) part[d] = pair->weight[i] * force[d];
    PetscCall(VecSetValues(forces, 3, place, part, ADD_VALUES));
  }
  Places(slave, place);
  for (int d = 0; d < 3; d++) part[d] = -force[d];
  PetscCall(VecSetValues(forces, 3, place, part, ADD_VALUES));
  PetscFunctionReturn(0);
}

/* From a vector ordered by the numbers of the vertices to a local one */
static PetscErrorCode NumbersToLocal(const PetscInt number[], PetscInt n, Vec forces, Vec local)
{
  PetscInt  *place;
  VecScatter scatter;
  IS         from;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(3 * n, &place));
  for (PetscInt v = 0; v < n; v++) Places(number[v], &place[3 * v]);
  PetscCall(ISCreateGeneral(PETSC_COMM_SELF, 3 * n, place, PETSC_OWN_POINTER, &from));
  PetscCall(VecScatterCreate(forces, from, local, NULL, &scatter));
  PetscCall(VecScatterBegin(scatter, forces, local, INSERT_VALUES, SCATTER_FORWARD));
  PetscCall(VecScatterEnd(scatter, forces, local, INSERT_VALUES, SCATTER_FORWARD));
  PetscCall(VecScatterDestroy(&scatter));
  PetscCall(ISDestroy(&from));
  PetscFunctionReturn(0);
}

PetscErrorCode ContactNodalForces(Contact contact, const ContactState state[], Vec local)
{
  const Mesh *mesh;
  PetscInt    n_own = 0;
  Vec         forces;

  PetscFunctionBeginUser;
  PetscCall(ModelGetMesh(contact->model, &mesh));
  for (PetscInt v = 0; v < mesh->n_vertices; v++) n_own += mesh->owned[v];
  PetscCall(VecCreateMPI(contact->comm, 3 * n_own, PETSC_DETERMINE, &forces));
  for (PetscInt p = 0; p < contact->n_pairs; p++)
    PetscCall(PairAddForce(&contact->pairs[p], contact->vertex[p], &state[p], forces));
  PetscCall(VecAssemblyBegin(forces));
  PetscCall(VecAssemblyEnd(forces));
  PetscCall(NumbersToLocal(mesh->number, mesh->n_vertices, forces, local));
  PetscCall(VecDestroy(&forces));
  PetscFunctionReturn(0);
}
