/*
   A change over many nodes v, of a set or of a ring of the disc: mass m, stiffness k and viscosity c in all add

      dM = m sum_v s_v I_v,   dK = k sum_v s_v d_v d_v',   dC = c sum_v s_v d_v d_v',

   I_v the unit matrix of the node's three directions, d_v the unit vector d there: each node has its share s_v of a
   layer that follows it and has no stiffness of its own, or of springs to the ground. The shares add up to 1: those in
   area or length of a set (model/scene/spread.c), those in mass of a ring.
*/
#include "changes.h"
#include "modes/label/disc.h"

/* of the disc's outer radius: a node that is nearer to the end of a ring is in it. On a coarse mesh with a patch under
   the pad the centre of mass is off the axis by 8e-4 of it, and ends that are those of the disc would cut its rim */
#define RING_NEAR 2e-3

/* s_v in the first of three places of each local node */
static PetscErrorCode RingCreateShares(Modes modes, Model model, const struct _p_ModesChange *change, Vec *shares)
{
  const Disc      *disc;
  const Mesh      *mesh;
  const PetscReal *mass;
  PetscReal        total = 0, near;
  PetscScalar     *share;

  PetscFunctionBeginUser;
  PetscCall(ModesFindDisc(modes, &disc, &mass));
  PetscCheck(disc, modes->comm, PETSC_ERR_USER_INPUT,
             "-%s_ring needs a disc: no part is one by its name, tell it by -modes_disc", change->name);
  near = RING_NEAR * disc->r_outer;
  PetscCall(ModelGetMesh(model, &mesh));
  PetscCall(ModelCreateNodal(model, shares));
  PetscCall(VecGetArray(*shares, &share));
  for (PetscInt v = 0; v < mesh->n_nodes; v++) {
    PetscReal radius, angle;

    DiscPolar(disc, &mesh->x[3 * v], &radius, &angle);
    if (radius >= change->ring[0] - near && radius <= change->ring[1] + near) share[3 * v] = mass[v];
    total += share[3 * v];
  }
  PetscCall(VecRestoreArray(*shares, &share));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &total, 1, MPIU_REAL, MPI_SUM, modes->comm));
  PetscCheck(total > 0, modes->comm, PETSC_ERR_USER_INPUT,
             "-%s_ring %g,%g (m) has no node of the disc, which reaches from %g to %g m", change->name,
             (double)change->ring[0], (double)change->ring[1], (double)disc->r_inner, (double)disc->r_outer);
  PetscCall(VecScale(*shares, 1 / total));
  PetscCall(ModelSumShared(model, *shares));
  PetscFunctionReturn(0);
}

/* Sets s d d', or s times the unit matrix where direction is NULL, among the unknowns of a node; returns those free */
static PetscErrorCode NodeSet(const PetscInt unknown[3], PetscReal share, const PetscReal direction[3], Mat A)
{
  PetscFunctionBeginUser;
  for (int a = 0; a < 3; a++)
    for (int b = 0; b < 3; b++) {
      const PetscReal value = share * (direction ? direction[a] * direction[b] : a == b);

      if (unknown[a] < 0 || unknown[b] < 0 || value == 0) continue;
      PetscCall(MatSetValue(A, unknown[a], unknown[b], value, INSERT_VALUES));
    }
  PetscFunctionReturn(0);
}

/* A of all unknowns; how many nodes have a share */
static PetscErrorCode LayerCreateMatrix(Model model, Vec shares, const PetscReal direction[3], PetscInt *n_nodes,
                                        Mat *A)
{
  const PetscScalar *share;
  const Mesh        *mesh;
  MPI_Comm           comm;

  PetscFunctionBeginUser;
  PetscCall(ModelGetMesh(model, &mesh));
  PetscCall(ModelGetComm(model, &comm));
  PetscCall(MatCreateAIJ(comm, mesh->n_own, mesh->n_own, mesh->n_unknowns, mesh->n_unknowns, 3, NULL, 0, NULL, A));
  PetscCall(MatSetOption(*A, MAT_NEW_NONZERO_ALLOCATION_ERR, PETSC_FALSE));
  PetscCall(VecGetArrayRead(shares, &share));
  *n_nodes = 0;
  for (PetscInt v = 0; v < mesh->n_nodes; v++) {
    if (!mesh->owned[v] || !(share[3 * v] > 0)) continue;
    ++*n_nodes;
    PetscCall(NodeSet(&mesh->unknown[3 * v], share[3 * v], direction, *A));
  }
  PetscCall(VecRestoreArrayRead(shares, &share));
  PetscCall(MatAssemblyBegin(*A, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(*A, MAT_FINAL_ASSEMBLY));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, n_nodes, 1, MPIU_INT, MPI_SUM, comm));
  PetscFunctionReturn(0);
}

PetscErrorCode ChangeAddLayer(Modes modes, ModesChange change, PetscInt *n, ChangeTerm terms[])
{
  const PetscBool spring = change->stiffness > 0 || change->viscosity > 0 ? PETSC_TRUE : PETSC_FALSE;
  const char     *where  = change->has_ring ? "ring" : "set";
  ChangeTerm     *term   = &terms[*n];
  PetscReal       direction[3], norm;
  Operators       operators;
  Model           model;
  Vec             shares;

  PetscFunctionBeginUser;
  PetscCall(PencilGetOperators(modes->pencil, &operators));
  PetscCall(OperatorsGetModel(operators, &model, NULL));
  PetscCheck(model, modes->comm, PETSC_ERR_USER_INPUT, "-%s_%s needs a mesh: these matrices have none", change->name,
             where);
  if (spring) PetscCall(ChangeGetDirection(modes, change, 3, direction));
  if (change->has_ring)
    PetscCall(RingCreateShares(modes, model, change, &shares));
  else
    PetscCall(ModelCreateShares(model, change->name, change->set, SPREAD_TOTAL, &shares));
  *term = (ChangeTerm){.mass      = change->mass,
                       .viscosity = change->viscosity,
                       .stiffness = change->stiffness,
                       .layer     = PETSC_TRUE,
                       .symmetric = PETSC_TRUE};
  PetscCall(LayerCreateMatrix(model, shares, spring ? direction : NULL, &change->n_nodes, &term->A));
  ++*n;
  PetscCall(VecDestroy(&shares));
  PetscCall(MatNorm(term->A, NORM_FROBENIUS, &norm));
  PetscCheck(norm > 0 || modes->couplings, modes->comm, PETSC_ERR_USER_INPUT,
             "change %s does nothing: the nodes of -%s_%s are held%s", change->name, change->name, where,
             spring ? " along its direction" : "");
  PetscFunctionReturn(0);
}
