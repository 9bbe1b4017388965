/*
   What prescribed displacements d do to the pairs: with u = d on held directions contact displacements are w = G u + m,
   m = e . (d_m - d_s) along each row's direction e, so that the gap is g = g0 - m_n - (G u)_n, and slip counts from
   m of the load step before. An interference (m) of the surfaces adds to m_n: they approach by it before bodies yield.
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
static PetscErrorCode MovedVerticesGather(MPI_Comm comm, const Mesh *mesh, const PetscReal nodal[], PetscInt *n,
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

/* m [rows] of what a stage prescribes; NULL where nothing is */
static PetscErrorCode MovedCreate(Model model, const Stage *stage, const PairRows *rows, PetscReal **moved)
{
  const Mesh  *mesh;
  PetscBool    overlaps = PETSC_FALSE;
  PetscInt     n        = 0;
  PetscReal   *nodal;
  MovedVertex *all = NULL;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < rows->n_interfaces; i++)
    if (stage->interference[i] != 0) overlaps = PETSC_TRUE;
  PetscCall(ModelGetMesh(model, &mesh));
  PetscCall(StageGetMotions(model, stage, &nodal));
  if (!nodal && !overlaps) PetscFunctionReturn(0);
  if (nodal) PetscCall(MovedVerticesGather(rows->comm, mesh, nodal, &n, &all));
  PetscCall(PetscMalloc1(rows->n, moved));
  for (PetscInt p = 0; p < rows->n_pairs; p++) {
    const ContactPair *q    = &rows->pair[p];
    const PetscReal   *e[3] = {q->n, q->t, q->b};
    PetscReal          d[3] = {0, 0, 0};

    for (PetscInt i = 0; i < q->n_master; i++) MovedAdd(n, all, q->master[i].number, q->master[i].weight, d);
    for (PetscInt k = 0; k < q->n_slave; k++) MovedAdd(n, all, q->slave[k].number, -q->slave[k].weight, d);
    for (PetscInt i = 0; i < rows->law[p].d; i++) (*moved)[rows->first[p] + i] = Vec3Dot(e[i], d);
    (*moved)[rows->first[p]] += stage->interference[q->interface];
  }
  PetscCall(PetscFree(all));
  PetscCall(PetscFree(nodal));
  PetscFunctionReturn(0);
}

PetscErrorCode PairRowsSetMoved(Model model, const Stage *before, const Stage *stage, PairRows *rows)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(rows->moved));
  PetscCall(PetscFree(rows->moved0));
  PetscCall(MovedCreate(model, stage, rows, &rows->moved));
  if (before) PetscCall(MovedCreate(model, before, rows, &rows->moved0));
  PetscFunctionReturn(0);
}

/* m of a row at a part of the way */
static PetscReal MovedAt(const PairRows *rows, PetscReal part, PetscInt i)
{
  const PetscReal end = rows->moved ? part * rows->moved[i] : 0;

  return rows->moved0 ? end + (1 - part) * rows->moved0[i] : end;
}

/* At a part of the way g0 = gap + worn - m_n. Slip counts from w + m of the part before: in w, which has no m, from w
   less what m has grown by. */
void PairRowsMove(PairRows *rows, PetscReal part, PetscReal before, const PetscReal w[])
{
  for (PetscInt p = 0; p < rows->n_pairs; p++) {
    const PetscInt first = rows->first[p];
    CoulombPair   *law   = &rows->law[p];

    law->g0 = rows->pair[p].gap + (rows->worn ? rows->worn[p] : 0) - MovedAt(rows, part, first);
    for (PetscInt i = 1; i < 3; i++) law->slip0[i - 1] = 0;
    for (PetscInt i = 1; i < law->d; i++)
      law->slip0[i - 1] = (w ? w[first + i] : 0) - (MovedAt(rows, part, first + i) - MovedAt(rows, before, first + i));
  }
}
