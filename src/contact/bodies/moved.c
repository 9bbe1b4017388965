/*
   Nodes that motions move, and what they do to pairs.
*/
#include "contact/bodies/moved.h"
#include "base/gather.h"
#include "base/algebra/vec3.h"
#include <stdlib.h>

static int MovedVertexCompare(const void *left, const void *right)
{
  const MovedVertex *a = left, *b = right;

  return (a->number > b->number) - (a->number < b->number);
}

PetscErrorCode MovedVerticesGather(MPI_Comm comm, const Mesh *mesh, const PetscReal nodal[], PetscInt *n,
                                   MovedVertex **all)
{
  PetscInt     n_here = 0;
  MovedVertex *here;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(mesh->n_nodes, &here));
  for (PetscInt v = 0; v < mesh->n_nodes; v++) {
    const PetscReal *d = &nodal[3 * v];

    if (!mesh->owned[v] || Vec3Dot(d, d) == 0) continue;
    here[n_here++] = (MovedVertex){mesh->number[v], {d[0], d[1], d[2]}};
  }
  PetscCall(GatherRecords(comm, n_here, sizeof(MovedVertex), here, n, all));
  PetscCall(PetscFree(here));
  if (*n) qsort(*all, (size_t)*n, sizeof(MovedVertex), MovedVertexCompare);
  PetscFunctionReturn(0);
}

/* sum += weight d of a node */
static void MovedAdd(PetscInt n, const MovedVertex all[], PetscInt number, PetscReal weight, PetscReal sum[3])
{
  const MovedVertex  key   = {.number = number};
  const MovedVertex *found = n ? bsearch(&key, all, (size_t)n, sizeof(key), MovedVertexCompare) : NULL;

  for (int d = 0; d < 3 && found; d++) sum[d] += weight * found->d[d];
}

void MovedApart(PetscInt n, const MovedVertex all[], const ContactPair *pair, PetscReal d[3])
{
  for (int i = 0; i < 3; i++) d[i] = 0;
  for (PetscInt i = 0; i < pair->n_master; i++) MovedAdd(n, all, pair->master[i].number, pair->master[i].weight, d);
  for (PetscInt k = 0; k < pair->n_slave; k++) MovedAdd(n, all, pair->slave[k].number, -pair->slave[k].weight, d);
}
