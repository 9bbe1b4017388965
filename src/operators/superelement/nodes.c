/* The nodes of the mesh that are nearest to places, over all ranks */
#include "superelement.h"
#include "operators/points/nodesbyx.h"
#include "base/algebra/vec3.h"

#define NODES_SAME 1e-9 /* of the size of the mesh: distances that differ by less are the same */

/* The least distance of a node of this rank from a place, `far` where none is nearer; most[0], most[1]: largest number
   and largest of their negative among those within `far` */
static PetscReal NodesNear(const NodesByX *nodes, const PetscBool on[], const PetscReal x[3], PetscReal far,
                           PetscInt most[2])
{
  PetscReal least = far;

  most[0] = most[1] = PETSC_MIN_INT;
  for (PetscInt i = NodesByXBegin(nodes, x[0] - far); i < nodes->mesh->n_nodes && nodes->x[i] <= x[0] + far; i++) {
    const PetscInt   v        = nodes->order[i];
    const PetscReal *at       = &nodes->mesh->x[3 * v];
    const PetscReal  way[3]   = {at[0] - x[0], at[1] - x[1], at[2] - x[2]};
    const PetscReal  distance = Vec3Length(way);

    if (distance > far || (on && !on[v])) continue;
    least   = PetscMin(least, distance);
    most[0] = PetscMax(most[0], nodes->mesh->number[v]);
    most[1] = PetscMax(most[1], -nodes->mesh->number[v]);
  }
  return least;
}

PetscErrorCode NodesFindNearest(MPI_Comm comm, const Mesh *mesh, const PetscBool on[], PetscReal near, PetscInt n,
                                NearestNode place[])
{
  NodesByX    nodes;
  PetscReal  *least, size;
  PetscInt   *most;
  PetscMPIInt count;

  PetscFunctionBeginUser;
  PetscCall(MeshSize(comm, mesh, &size));
  PetscCall(PetscMPIIntCast(2 * n, &count));
  PetscCall(PetscMalloc2(n, &least, 2 * n, &most));
  PetscCall(NodesByXCreate(mesh, &nodes));
  for (PetscInt i = 0; i < n; i++) least[i] = NodesNear(&nodes, on, place[i].x, near, most);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, least, count / 2, MPIU_REAL, MPI_MIN, comm));
  for (PetscInt i = 0; i < n; i++) (void)NodesNear(&nodes, on, place[i].x, least[i] + NODES_SAME * size, &most[2 * i]);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, most, count, MPIU_INT, MPI_MAX, comm));
  for (PetscInt i = 0; i < n; i++) {
    place[i].number   = most[2 * i] == PETSC_MIN_INT || least[i] >= near ? -1 : most[2 * i];
    place[i].twice    = place[i].number >= 0 && most[2 * i] != -most[2 * i + 1] ? PETSC_TRUE : PETSC_FALSE;
    place[i].distance = least[i];
  }
  PetscCall(NodesByXDestroy(&nodes));
  PetscCall(PetscFree2(least, most));
  PetscFunctionReturn(0);
}
