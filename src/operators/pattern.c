/*
   Preallocation: couplings of the unknowns of two vertices of a common cell of one part. Each rank counts, for every
   vertex that it has, the distinct neighbours through its own cells, apart by whether the neighbour's unknowns live
   with the row's owner; the counts are summed over the ranks that share the vertex. Neighbours that two ranks see count
   twice: an upper bound, exact in the interior, at a fifth of the time of DMCreateMatrix(), which walks the closure of
   edges and faces too.
*/
#include "operatorsimpl.h"

/* Cells of a part around each local vertex as lists: those of vertex v are cell[first[v]] .. cell[first[v + 1] - 1] */
typedef struct {
  PetscInt  n_vertices, vStart, n_cells;
  PetscInt *first, *cell;
} Star;

static PetscErrorCode StarCreate(Model model, DM dm, PetscInt part, PetscInt n_nodes, Star *s)
{
  const PetscInt *cell_part;
  PetscInt        cStart, cEnd, vEnd, vertices[ELEMENT_MAX_NODES];
  PetscReal       x[ELEMENT_MAX_DOFS];

  PetscFunctionBeginUser;
  PetscCall(ModelGetCellParts(model, &cell_part));
  PetscCall(DMPlexGetHeightStratum(dm, 0, &cStart, &cEnd));
  PetscCall(DMPlexGetDepthStratum(dm, 0, &s->vStart, &vEnd));
  s->n_cells    = cEnd - cStart;
  s->n_vertices = vEnd - s->vStart;
  PetscCall(PetscCalloc2(s->n_vertices + 2, &s->first, n_nodes * s->n_cells, &s->cell));
  for (PetscInt c = 0; c < s->n_cells; c++) {
    if (cell_part[c] != part) continue;
    PetscCall(ModelGetCell(model, c, vertices, x));
    for (PetscInt i = 0; i < n_nodes; i++) s->first[vertices[i] - s->vStart + 2]++;
  }
  for (PetscInt v = 0; v < s->n_vertices; v++) s->first[v + 2] += s->first[v + 1];
  for (PetscInt c = 0; c < s->n_cells; c++) {
    if (cell_part[c] != part) continue;
    PetscCall(ModelGetCell(model, c, vertices, x));
    for (PetscInt i = 0; i < n_nodes; i++) s->cell[s->first[vertices[i] - s->vStart + 1]++] = c;
  }
  PetscFunctionReturn(0);
}

/* Owner of each local vertex, by the first of its unknowns; -1 when all are fixed */
static PetscErrorCode OwnersFind(MPI_Comm comm, const Star *s, const PetscInt unknowns[], PetscInt n_own,
                                 PetscMPIInt owner[])
{
  PetscLayout layout;

  PetscFunctionBeginUser;
  PetscCall(PetscLayoutCreateFromSizes(comm, n_own, PETSC_DETERMINE, 1, &layout));
  for (PetscInt v = 0; v < s->n_vertices; v++) {
    PetscInt d = 0;

    while (d < 3 && unknowns[3 * v + d] < 0) d++;
    owner[v] = -1;
    if (d < 3) PetscCall(PetscLayoutFindOwner(layout, unknowns[3 * v + d], &owner[v]));
  }
  PetscCall(PetscLayoutDestroy(&layout));
  PetscFunctionReturn(0);
}

/* Adds to count[v][0] the neighbours of v with the same owner, to count[v][1] the others */
static PetscErrorCode NeighboursCount(Model model, const Star *s, PetscInt n_nodes, const PetscMPIInt owner[],
                                      PetscScalar count[])
{
  PetscInt *seen, vertices[ELEMENT_MAX_NODES];
  PetscReal x[ELEMENT_MAX_DOFS];

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(s->n_vertices, &seen));
  for (PetscInt v = 0; v < s->n_vertices; v++) seen[v] = -1;
  for (PetscInt v = 0; v < s->n_vertices; v++)
    for (PetscInt k = s->first[v]; k < s->first[v + 1]; k++) {
      PetscCall(ModelGetCell(model, s->cell[k], vertices, x));
      for (PetscInt i = 0; i < n_nodes; i++) {
        const PetscInt w = vertices[i] - s->vStart;

        if (seen[w] == v || owner[w] < 0) continue;
        seen[w] = v;
        count[3 * v + (owner[w] != owner[v])] += 1;
      }
    }
  PetscCall(PetscFree(seen));
  PetscFunctionReturn(0);
}

/* Entries per owned row inside and outside the diagonal block */
static PetscErrorCode RowsCount(MPI_Comm comm, Model model, DM dm, PetscInt part, PetscInt n_own, PetscInt first_own,
                                PetscInt inside[], PetscInt outside[])
{
  const Element  *element;
  const PetscInt *unknowns;
  PetscMPIInt    *owner;
  PetscScalar    *count;
  Vec             counts, coordinates;
  Star            star;

  PetscFunctionBeginUser;
  PetscCall(ModelGetElement(model, &element));
  PetscCall(ModelGetUnknowns(model, &unknowns));
  PetscCall(StarCreate(model, dm, part, element->n_nodes, &star));
  PetscCall(PetscMalloc1(star.n_vertices, &owner));
  PetscCall(OwnersFind(comm, &star, unknowns, n_own, owner));
  PetscCall(DMGetCoordinatesLocal(dm, &coordinates));
  PetscCall(VecDuplicate(coordinates, &counts));
  PetscCall(VecSet(counts, 0));
  PetscCall(VecGetArray(counts, &count));
  PetscCall(NeighboursCount(model, &star, element->n_nodes, owner, count));
  PetscCall(VecRestoreArray(counts, &count));
  PetscCall(ModelSumShared(model, counts));
  PetscCall(VecGetArray(counts, &count));
  for (PetscInt i = 0; i < 3 * star.n_vertices; i++) {
    const PetscInt row = unknowns[i] - first_own, v = i / 3;

    if (unknowns[i] < first_own || row >= n_own) continue;
    inside[row]  = PetscMin(n_own, 3 * (PetscInt)count[3 * v]);
    outside[row] = 3 * (PetscInt)count[3 * v + 1];
  }
  PetscCall(VecRestoreArray(counts, &count));
  PetscCall(VecDestroy(&counts));
  PetscCall(PetscFree2(star.first, star.cell));
  PetscCall(PetscFree(owner));
  PetscFunctionReturn(0);
}

PetscErrorCode PatternCreate(Model model, PetscInt part, Mat *A)
{
  PetscInt n_own, n_all, first_own, *inside, *outside;
  MPI_Comm comm;
  Vec      u;
  DM       dm;

  PetscFunctionBeginUser;
  PetscCall(ModelGetComm(model, &comm));
  PetscCall(ModelGetDM(model, &dm));
  PetscCall(DMGetGlobalVector(dm, &u));
  PetscCall(VecGetLocalSize(u, &n_own));
  PetscCall(VecGetSize(u, &n_all));
  PetscCall(VecGetOwnershipRange(u, &first_own, NULL));
  PetscCall(DMRestoreGlobalVector(dm, &u));
  PetscCall(PetscCalloc2(n_own, &inside, n_own, &outside));
  PetscCall(RowsCount(comm, model, dm, part, n_own, first_own, inside, outside));
  for (PetscInt i = 0; i < n_own; i++) outside[i] = PetscMin(n_all - n_own, outside[i]);
  PetscCall(MatCreateAIJ(comm, n_own, n_own, n_all, n_all, 0, inside, 0, outside, A));
  PetscCall(PetscFree2(inside, outside));
  PetscFunctionReturn(0);
}
