/*
   Forces of the contact at the nodes of the mesh: -lambda_n n + lambda_t t + lambda_b b on the master point, shared by
   the nodes of its facet with their weights, and the opposite on the slave. Nodes that a support holds are included.
*/
#include "contactimpl.h"

/* Adds the force of one pair to slave and master */
static PetscErrorCode PairAddForce(const ContactPair *pair, const ContactState *state, Vec forces)
{
  PetscScalar force[3], part[3];

  PetscFunctionBeginUser;
  for (int d = 0; d < 3; d++)
    force[d] = -state->lambda_n * pair->n[d] + state->lambda_t[0] * pair->t[d] + state->lambda_t[1] * pair->b[d];
  for (PetscInt i = 0; i < pair->n_master; i++) {
    for (int d = 0; d < 3; d++) part[d] = pair->weight[i] * force[d];
    PetscCall(VecSetValuesBlocked(forces, 1, &pair->corner[i], part, ADD_VALUES));
  }
  for (int d = 0; d < 3; d++) part[d] = -force[d];
  PetscCall(VecSetValuesBlocked(forces, 1, &pair->vertex, part, ADD_VALUES));
  PetscFunctionReturn(0);
}

PetscErrorCode ContactNodalForces(Contact contact, const ContactState state[], Vec local)
{
  const Mesh *mesh;
  PetscInt    n_own = 0;
  Vec         forces; /* ordered by the numbers of the nodes */
  VecScatter  scatter;
  IS          from;

  PetscFunctionBeginUser;
  PetscCall(ModelGetMesh(contact->model, &mesh));
  for (PetscInt v = 0; v < mesh->n_nodes; v++) n_own += mesh->owned[v];
  PetscCall(VecCreateMPI(contact->comm, 3 * n_own, PETSC_DETERMINE, &forces));
  PetscCall(VecSetBlockSize(forces, 3));
  for (PetscInt p = 0; p < contact->n_pairs; p++) PetscCall(PairAddForce(&contact->pairs[p], &state[p], forces));
  PetscCall(VecAssemblyBegin(forces));
  PetscCall(VecAssemblyEnd(forces));
  PetscCall(ISCreateBlock(PETSC_COMM_SELF, 3, mesh->n_nodes, mesh->number, PETSC_USE_POINTER, &from));
  PetscCall(VecScatterCreate(forces, from, local, NULL, &scatter));
  PetscCall(VecScatterBegin(scatter, forces, local, INSERT_VALUES, SCATTER_FORWARD));
  PetscCall(VecScatterEnd(scatter, forces, local, INSERT_VALUES, SCATTER_FORWARD));
  PetscCall(VecScatterDestroy(&scatter));
  PetscCall(ISDestroy(&from));
  PetscCall(VecDestroy(&forces));
  PetscFunctionReturn(0);
}
