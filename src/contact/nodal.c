/*
   Forces of the contact at the nodes of the mesh, N: f = -lambda_n n + lambda_t[0] t + lambda_t[1] b on the master,
   shared by its nodes with their weights, f_i = w_i f, and -v_k f on those of the slave: the transpose of u_m - u_s =
   sum_i w_i u_i - sum_k v_k u_k, so that the forces of a pair do the work of the pair and balance (both sums are 1).
   Nodes that a support holds are included, for reactions. And what ties pass on: with u_s = sum_i A_i u_i
   (ContactLink.follow), a force f on the slave acts as A_i' f on the nodes that it follows.
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
    for (int d = 0; d < 3; d++) part[d] = pair->master[i].weight * force[d];
    PetscCall(VecSetValuesBlocked(forces, 1, &pair->master[i].number, part, ADD_VALUES));
  }
  for (PetscInt k = 0; k < pair->n_slave; k++) {
    for (int d = 0; d < 3; d++) part[d] = -pair->slave[k].weight * force[d];
    PetscCall(VecSetValuesBlocked(forces, 1, &pair->slave[k].number, part, ADD_VALUES));
  }
  PetscFunctionReturn(0);
}

/* Three numbers a node, ordered by the global numbers of the nodes (no unknowns: held nodes have none), each on the
   rank that owns the node, and the way to a local vector, which has all copies */
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

/* Assembles the forces and puts them into a local vector, or adds them. Every copy of a node gets the same sum. */
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

/* Adds what passes of the force f (N, [3]) on the slave of a link: A_i' f to node i that it follows, and -f to
   itself, but in directions that a support holds, where f stays as its reaction; the rows of A_i of these directions
   are 0 (tie/tie.c) */
static PetscErrorCode LinkAddForce(const ContactLink *link, const PetscReal force[3], Vec forces)
{
  PetscScalar part[3];

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < link->n_master; i++) {
    for (int e = 0; e < 3; e++) {
      part[e] = 0;
      for (int d = 0; d < 3; d++) part[e] += link->master[i].follow[3 * d + e] * force[d];
    }
    PetscCall(VecSetValuesBlocked(forces, 1, &link->master[i].number, part, ADD_VALUES));
  }
  for (int d = 0; d < 3; d++) part[d] = link->slave[d] < 0 ? 0 : -force[d];
  PetscCall(VecSetValuesBlocked(forces, 1, &link->vertex, part, ADD_VALUES));
  PetscFunctionReturn(0);
}

/* Passes the forces on all slaves one step on; the largest that moves, N, over all ranks */
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

/* A slave of one tie may be a node that the slaves of another follow, so that forces go on step by step. A chain of
   ties ends: the last slaves lose f - f = 0 exactly, and the largest, 0, tells it on all ranks. A circle of ties
   would not end: the operators refuse it before (operators/points/dependents.c). */
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
