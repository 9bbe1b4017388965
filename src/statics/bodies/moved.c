/*
   What prescribed displacements d do to the pairs: with u = d on held directions contact displacements are w = G u + m,
   m = e . (d_m - d_s) along each row's direction e, so that the gap is g = g0 - m_n - (G u)_n, and slip counts from
   m of the load step before.
*/
#include "statics/staticsimpl.h"
#include "base/gather.h"
#include "base/algebra/vec3.h"
#include <stdlib.h>

/* A node that a motion moves */
typedef struct {
  PetscInt  number; /* over all ranks */
  PetscReal d[3];   /* m */
} MovedVertex;

static int MovedVertexCompare(const void *left, const void *right)
{
  const MovedVertex *a = left, *b = right;

  return (a->number > b->number) - (a->number < b->number);
}

/* Those of all ranks, ascending, on every rank; the caller frees them */
static PetscErrorCode MovedVerticesGather(MPI_Comm comm, const Mesh *mesh, PetscInt *n, MovedVertex **all)
{
  PetscInt     n_here = 0;
  MovedVertex *here;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(mesh->n_nodes, &here));
  for (PetscInt v = 0; v < mesh->n_nodes; v++) {
    const PetscReal *d = &mesh->prescribed[3 * v];

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

PetscErrorCode PairRowsSetMoved(Model model, PairRows *rows)
{
  const Mesh  *mesh;
  PetscInt     n;
  MovedVertex *all;

  PetscFunctionBeginUser;
  PetscCall(ModelGetMesh(model, &mesh));
  if (!mesh->prescribed) PetscFunctionReturn(0);
  PetscCall(MovedVerticesGather(rows->comm, mesh, &n, &all));
  PetscCall(PetscMalloc1(rows->n, &rows->moved));
  for (PetscInt p = 0; p < rows->n_pairs; p++) {
    const ContactPair *q    = &rows->pair[p];
    const PetscReal   *e[3] = {q->n, q->t, q->b};
    PetscReal          d[3] = {0, 0, 0};

    for (PetscInt i = 0; i < q->n_master; i++) MovedAdd(n, all, q->master[i].number, q->master[i].weight, d);
    for (PetscInt k = 0; k < q->n_slave; k++) MovedAdd(n, all, q->slave[k].number, -q->slave[k].weight, d);
    for (PetscInt i = 0; i < rows->law[p].d; i++) rows->moved[rows->first[p] + i] = Vec3Dot(e[i], d);
  }
  PetscCall(PetscFree(all));
  PetscFunctionReturn(0);
}

/* At a part of the motions g0 = gap - part m_n. Slip counts from w + before m of the step before: in w, which has no
   m, from w - (part - before) m. */
void PairRowsMove(PairRows *rows, PetscReal part, PetscReal before, const PetscReal w[])
{
  for (PetscInt p = 0; p < rows->n_pairs; p++) {
    const PetscInt first = rows->first[p];
    CoulombPair   *law   = &rows->law[p];

    law->g0 = rows->pair[p].gap - (rows->moved ? part * rows->moved[first] : 0);
    for (PetscInt i = 1; i < 3; i++) law->slip0[i - 1] = 0;
    for (PetscInt i = 1; i < law->d; i++)
      law->slip0[i - 1] = (w ? w[first + i] : 0) - (rows->moved ? (part - before) * rows->moved[first + i] : 0);
  }
}
