/*
   Forces of the contact at the nodes of the mesh: -lambda_n n + lambda_t t + lambda_b b on the master point, shared by
   the nodes of its facet with their weights, and the opposite on the slave. Nodes that a support holds are included. And
   what ties pass on: forces on slaves act on the nodes that they follow.
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

/* A vector of three zeros a node, ordered by the numbers of the nodes */
static PetscErrorCode NodalCreate(Contact contact, Vec *forces)
{
  const Mesh *mesh;
  PetscInt    n_own = 0;

  PetscFunctionBeginUser;
  PetscCall(ModelGetMesh(contact->model, &mesh));
  for (PetscInt v = 0; v < mesh->n_nodes; v++) n_own += mesh->owned[v];
  PetscCall(VecCreateMPI(contact->comm, 3 * n_own, PETSC_DETERMINE, forces));
  PetscCall(VecSetBlockSize(*forces, 3));
  PetscFunctionReturn(0);
}

/* Puts it, assembled, into a local vector, or adds it, and destroys it */
static PetscErrorCode NodalMove(Contact contact, Vec *forces, InsertMode mode, Vec local)
{
  const Mesh *mesh;
  VecScatter  scatter;
  IS          from;

  PetscFunctionBeginUser;
  PetscCall(ModelGetMesh(contact->model, &mesh));
  PetscCall(VecAssemblyBegin(*forces));
  PetscCall(VecAssemblyEnd(*forces));
  PetscCall(ISCreateBlock(PETSC_COMM_SELF, 3, mesh->n_nodes, mesh->number, PETSC_USE_POINTER, &from));
  PetscCall(VecScatterCreate(*forces, from, local, NULL, &scatter));
  PetscCall(VecScatterBegin(scatter, *forces, local, mode, SCATTER_FORWARD));
  PetscCall(VecScatterEnd(scatter, *forces, local, mode, SCATTER_FORWARD));
  PetscCall(VecScatterDestroy(&scatter));
  PetscCall(ISDestroy(&from));
  PetscCall(VecDestroy(forces));
  PetscFunctionReturn(0);
}

PetscErrorCode ContactNodalForces(Contact contact, const ContactState state[], Vec local)
{
  Vec forces;

  PetscFunctionBeginUser;
  PetscCall(NodalCreate(contact, &forces));
  for (PetscInt p = 0; p < contact->n_pairs; p++) PetscCall(PairAddForce(&contact->pairs[p], &state[p], forces));
  PetscCall(NodalMove(contact, &forces, INSERT_VALUES, local));
  PetscFunctionReturn(0);
}

/* Adds what passes of the force [3] on the slave of a link: to the nodes that it follows, and with the other sign to itself */
static PetscErrorCode LinkAddForce(const ContactLink *link, const PetscReal force[3], Vec forces)
{
  PetscScalar part[3];

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < link->n_master; i++) {
    for (int e = 0; e < 3; e++) {
      part[e] = 0;
      for (int d = 0; d < 3; d++) part[e] += link->follow[i][3 * d + e] * force[d];
    }
    PetscCall(VecSetValuesBlocked(forces, 1, &link->corner[i], part, ADD_VALUES));
  }
  for (int d = 0; d < 3; d++) part[d] = link->slave[d] < 0 ? 0 : -force[d];
  PetscCall(VecSetValuesBlocked(forces, 1, &link->vertex, part, ADD_VALUES));
  PetscFunctionReturn(0);
}

PetscErrorCode ContactPassForces(Contact contact, Vec local)
{
  const PetscReal *force;
  Vec              passed;

  PetscFunctionBeginUser;
  for (PetscInt t = 0; t < contact->n_ties; t++) { /* a slave of one may be a master of another */
    PetscCall(NodalCreate(contact, &passed));
    PetscCall(VecGetArrayRead(local, &force));
    for (PetscInt l = 0; l < contact->n_links; l++)
      PetscCall(LinkAddForce(&contact->links[l], &force[3 * contact->links[l].node], passed));
    PetscCall(VecRestoreArrayRead(local, &force));
    PetscCall(NodalMove(contact, &passed, ADD_VALUES, local));
  }
  PetscFunctionReturn(0);
}
