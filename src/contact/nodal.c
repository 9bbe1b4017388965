/*
   Forces of the contact at the nodes of the mesh: -lambda_n n + lambda_t t + lambda_b b on the master point, shared by
   the nodes of its facet with their weights, and the opposite on the slave. Nodes that a support holds are included.
   And what ties pass on: forces on slaves act on the nodes that they follow.
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

/* Three numbers a node, ordered by the numbers of the nodes, and the way to a local vector */
typedef struct {
  Vec        forces;
  VecScatter way;
} Nodal;

static PetscErrorCode NodalCreate(Contact contact, Vec local, Nodal *nodal)
{
  const Mesh *mesh;
  PetscInt    n_own = 0;
  IS          from;

  PetscFunctionBeginUser;
  PetscCall(ModelGetMesh(contact->model, &mesh));
  for (PetscInt v = 0; v < mesh->n_nodes; v++) n_own += mesh->owned[v];
  PetscCall(VecCreateMPI(contact->comm, 3 * n_own, PETSC_DETERMINE, &nodal->forces));
  PetscCall(VecSetBlockSize(nodal->forces, 3));
  PetscCall(ISCreateBlock(PETSC_COMM_SELF, 3, mesh->n_nodes, mesh->number, PETSC_USE_POINTER, &from));
  PetscCall(VecScatterCreate(nodal->forces, from, local, NULL, &nodal->way));
  PetscCall(ISDestroy(&from));
  PetscFunctionReturn(0);
}

/* Assembles the forces and puts them into a local vector, or adds them */
static PetscErrorCode NodalMove(const Nodal *nodal, InsertMode mode, Vec local)
{
  PetscFunctionBeginUser;
  PetscCall(VecAssemblyBegin(nodal->forces));
  PetscCall(VecAssemblyEnd(nodal->forces));
  PetscCall(VecScatterBegin(nodal->way, nodal->forces, local, mode, SCATTER_FORWARD));
  PetscCall(VecScatterEnd(nodal->way, nodal->forces, local, mode, SCATTER_FORWARD));
  PetscFunctionReturn(0);
}

static PetscErrorCode NodalDestroy(Nodal *nodal)
{
  PetscFunctionBeginUser;
  PetscCall(VecScatterDestroy(&nodal->way));
  PetscCall(VecDestroy(&nodal->forces));
  PetscFunctionReturn(0);
}

PetscErrorCode ContactNodalForces(Contact contact, const ContactState state[], Vec local)
{
  Nodal nodal;

  PetscFunctionBeginUser;
  PetscCall(NodalCreate(contact, local, &nodal));
  for (PetscInt p = 0; p < contact->n_pairs; p++) PetscCall(PairAddForce(&contact->pairs[p], &state[p], nodal.forces));
  PetscCall(NodalMove(&nodal, INSERT_VALUES, local));
  PetscCall(NodalDestroy(&nodal));
  PetscFunctionReturn(0);
}

/* Adds what passes of the force [3] on the slave of a link: to the nodes that it follows, and with the other sign to
   itself */
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

/* Passes the forces on all slaves one step on; the largest that moves, N */
static PetscErrorCode ForcesPass(Contact contact, const Nodal *nodal, Vec local, PetscReal *largest)
{
  const PetscReal *force;

  PetscFunctionBeginUser;
  PetscCall(VecSet(nodal->forces, 0));
  PetscCall(VecGetArrayRead(local, &force));
  for (PetscInt l = 0; l < contact->n_links; l++)
    PetscCall(LinkAddForce(&contact->links[l], &force[3 * contact->links[l].node], nodal->forces));
  PetscCall(VecRestoreArrayRead(local, &force));
  PetscCall(NodalMove(nodal, ADD_VALUES, local));
  PetscCall(VecNorm(nodal->forces, NORM_INFINITY, largest));
  PetscFunctionReturn(0);
}

PetscErrorCode ContactPassForces(Contact contact, Vec local)
{
  PetscReal largest = 1;
  Nodal     nodal;

  PetscFunctionBeginUser;
  if (!contact->n_ties) PetscFunctionReturn(0);
  PetscCall(NodalCreate(contact, local, &nodal));
  while (largest > 0) PetscCall(ForcesPass(contact, &nodal, local, &largest)); /* slaves of one may lead in another */
  PetscCall(NodalDestroy(&nodal));
  PetscFunctionReturn(0);
}
