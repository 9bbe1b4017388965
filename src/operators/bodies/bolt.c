/*
   Bolts (model/scene/loads/bolt.c): the load -d K_a j of a shortening d, and the tension T = j' K_a (u + d j), with the
   stiffness K_a of the part on one side of the cut and j = n at the nodes of the cut.
*/
#include "operators/operatorsimpl.h"

#define BOLT_SHARE 1e-2 /* of |d K_a j| in the size of the loads: as of motions (statics/bodies/loadvector.c) */

/* The nodes of the cut on this rank */
static PetscErrorCode BoltFind(Operators o, PetscInt i, const Load **load, PetscInt *n, PetscInt **node)
{
  const ModelScene *scene;

  PetscFunctionBeginUser;
  PetscCall(ModelGetScene(o->model, &scene));
  *load = &scene->loads[i];
  PetscCall(ModelGetSetNodes(o->model, (*load)->set, n, node));
  PetscFunctionReturn(0);
}

/* += d j */
static void BoltDraw(const Load *load, PetscReal d, PetscInt n, const PetscInt node[], PetscReal seen[])
{
  for (PetscInt k = 0; k < 3 * n; k++) seen[3 * node[k / 3] + k % 3] += d * load->axis[k % 3];
}

/* K_a (u + d j), complete at every node; u NULL for 0 */
static PetscErrorCode BoltCreateForces(Operators o, const PetscReal p[], PetscInt i, const PetscReal u[], PetscReal d,
                                       Vec *forces)
{
  const Load  *load;
  const Mesh  *mesh;
  PetscInt     n, *node;
  PetscReal   *seen;
  PetscScalar *f;

  PetscFunctionBeginUser;
  PetscCall(ModelGetMesh(o->model, &mesh));
  PetscCall(BoltFind(o, i, &load, &n, &node));
  PetscCall(PetscCalloc1(3 * mesh->n_nodes, &seen));
  if (u) PetscCall(PetscArraycpy(seen, u, 3 * mesh->n_nodes));
  BoltDraw(load, d, n, node, seen);
  PetscCall(ModelCreateNodal(o->model, forces));
  PetscCall(VecGetArray(*forces, &f));
  PetscCall(OperatorsAddCellForces(o, OperatorsPoint(o, p), load->of_part, seen, f));
  PetscCall(VecRestoreArray(*forces, &f));
  PetscCall(ModelSumShared(o->model, *forces));
  PetscCall(PetscFree(seen));
  PetscCall(PetscFree(node));
  PetscFunctionReturn(0);
}

/* j' f */
static PetscErrorCode BoltSum(Operators o, PetscInt i, Vec forces, PetscReal *sum)
{
  const PetscScalar *f;
  const Load        *load;
  const Mesh        *mesh;
  PetscInt           n, *node;

  PetscFunctionBeginUser;
  *sum = 0;
  PetscCall(ModelGetMesh(o->model, &mesh));
  PetscCall(BoltFind(o, i, &load, &n, &node));
  PetscCall(VecGetArrayRead(forces, &f));
  for (PetscInt k = 0; k < 3 * n; k++)
    if (mesh->owned[node[k / 3]]) *sum += load->axis[k % 3] * PetscRealPart(f[3 * node[k / 3] + k % 3]);
  PetscCall(VecRestoreArrayRead(forces, &f));
  PetscCall(PetscFree(node));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 1, MPIU_REAL, MPI_SUM, o->comm));
  PetscFunctionReturn(0);
}

/* Of a bolt its shortening, m, with its share */
static PetscReal BoltShortening(Operators o, const PetscReal p[], const ModelScene *scene, PetscInt i, PetscReal share)
{
  return scene->loads[i].has_tension ? share : share * OperatorsPoint(o, p)[o->load_size[i].force];
}

PetscErrorCode OperatorsGetSeen(Operators o, const PetscReal p[], PetscInt part, const PetscReal share[],
                                const PetscReal u[], PetscReal **seen)
{
  const ModelScene *scene;
  const Mesh       *mesh;
  PetscInt          n, *node;

  PetscFunctionBeginUser;
  *seen = NULL;
  PetscCall(ModelGetMesh(o->model, &mesh));
  PetscCall(ModelGetScene(o->model, &scene));
  for (PetscInt i = 0; i < scene->n_loads && share; i++) {
    const Load *load = &scene->loads[i];

    if (!load->is_bolt || load->of_part != part) continue;
    if (!*seen) {
      PetscCall(PetscMalloc1(3 * mesh->n_nodes, seen));
      PetscCall(PetscArraycpy(*seen, u, 3 * mesh->n_nodes));
    }
    PetscCall(BoltFind(o, i, &load, &n, &node));
    BoltDraw(load, BoltShortening(o, p, scene, i, share[i]), n, node, *seen);
    PetscCall(PetscFree(node));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode OperatorsAddBolt(Operators o, const PetscReal p[], PetscInt i, PetscReal d, Vec local, PetscReal *size)
{
  PetscReal norm;
  Vec       forces;

  PetscFunctionBeginUser;
  if (d == 0) PetscFunctionReturn(0);
  PetscCall(BoltCreateForces(o, p, i, NULL, d, &forces));
  PetscCall(VecAXPY(local, -1, forces));
  PetscCall(VecNorm(forces, NORM_1, &norm)); /* of this rank's nodes */
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &norm, 1, MPIU_REAL, MPI_SUM, o->comm));
  *size += BOLT_SHARE * norm;
  PetscCall(VecDestroy(&forces));
  PetscFunctionReturn(0);
}

PetscErrorCode OperatorsGetBolt(Operators o, const PetscReal p[], PetscInt i, PetscReal share, const PetscReal u[],
                                OperatorsBolt *bolt)
{
  const ModelScene *scene;
  Vec               forces;

  PetscFunctionBeginUser;
  PetscCall(ModelGetScene(o->model, &scene));
  bolt->shortening = BoltShortening(o, p, scene, i, share);
  PetscCall(BoltCreateForces(o, p, i, u, bolt->shortening, &forces));
  PetscCall(BoltSum(o, i, forces, &bolt->tension));
  PetscCall(VecDestroy(&forces));
  PetscCall(BoltCreateForces(o, p, i, NULL, 1, &forces));
  PetscCall(BoltSum(o, i, forces, &bolt->stiffness));
  PetscCall(VecDestroy(&forces));
  PetscFunctionReturn(0);
}
