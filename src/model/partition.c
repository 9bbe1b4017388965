/*
   Partition: METIS on the dual graph of the mesh, whose vertices are cells and whose edges are faces between two
   cells.

   The cells at the contact are contracted to one vertex of the graph, weighted by their number, so that they end on
   one rank: the cells with a node on a face of a `together` set that lies opposite another such set (of the disc's
   whole face only the part under the pad), or on any of its faces when it is the only set. A contact of more cells
   than a rank's share is cut like the rest; pairs are found across ranks. METIS is seeded: the same mesh, the same
   partition.

   Karypis and Kumar, SIAM J. Sci. Comput. 20 (1998) 359-392.
*/
#include "modelimpl.h"

#include <metis.h>

#define KWAY_FROM 9   /* parts from which on METIS advises k-way partitioning; below, recursive bisection cuts less */
#define OPPOSITE  0.1 /* largest gap of facing boxes, relative to the diagonal of the face's box */

_Static_assert(sizeof(idx_t) == sizeof(PetscInt), "METIS and PETSc must have integers of the same size");

typedef int MetisPartition(idx_t *, idx_t *, idx_t *, idx_t *, idx_t *, idx_t *, idx_t *, idx_t *, real_t *, real_t *,
                           idx_t *, idx_t *, idx_t *);

typedef struct {
  PetscReal lower[3], upper[3]; /* m */
} Box;

static const Box BOX_EMPTY = {
  {PETSC_MAX_REAL, PETSC_MAX_REAL, PETSC_MAX_REAL},
  {PETSC_MIN_REAL, PETSC_MIN_REAL, PETSC_MIN_REAL}
};

/* Weighted graph in compressed rows, as METIS takes it */
typedef struct {
  PetscInt  n;                   /* vertices */
  PetscInt *of_cell;             /* [cells] vertex that holds the cell */
  PetscInt *weight;              /* [n] cells that it holds */
  PetscInt *start;               /* [n + 1] */
  PetscInt *neighbour, *n_faces; /* [start[n]] adjacent vertex, and faces between the two */
} Graph;

/* Widens a box to the nodes of a point */
static PetscErrorCode BoxAddPoint(DM dm, PetscInt point, Box *box)
{
  PetscScalar *x = NULL;
  PetscInt     size;
  PetscSection section;
  Vec          coordinates;

  PetscFunctionBeginUser;
  PetscCall(DMGetCoordinateSection(dm, &section));
  PetscCall(DMGetCoordinatesLocal(dm, &coordinates));
  PetscCall(DMPlexVecGetClosure(dm, section, coordinates, point, &size, &x));
  for (PetscInt i = 0; i < size; i++) {
    box->lower[i % 3] = PetscMin(box->lower[i % 3], PetscRealPart(x[i]));
    box->upper[i % 3] = PetscMax(box->upper[i % 3], PetscRealPart(x[i]));
  }
  PetscCall(DMPlexVecRestoreClosure(dm, section, coordinates, point, &size, &x));
  PetscFunctionReturn(0);
}

/* Whether the box of a face, widened by a part of its diagonal, meets another box */
static PetscBool BoxMeets(const Box *face, const Box *other)
{
  PetscReal square = 0, gap;

  for (PetscInt d = 0; d < 3; d++) square += PetscSqr(face->upper[d] - face->lower[d]);
  gap = OPPOSITE * PetscSqrtReal(square);
  for (PetscInt d = 0; d < 3; d++) {
    if (face->lower[d] - gap > other->upper[d] || face->upper[d] + gap < other->lower[d]) return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

/* Bounding box of a set; empty when the mesh has no such set */
static PetscErrorCode SetBox(DM dm, const char set[], Box *box)
{
  IS              points;
  const PetscInt *point;
  PetscInt        n;

  PetscFunctionBeginUser;
  *box = BOX_EMPTY;
  PetscCall(DMGetStratumIS(dm, set, 1, &points));
  if (!points) PetscFunctionReturn(0);
  PetscCall(ISGetLocalSize(points, &n));
  PetscCall(ISGetIndices(points, &point));
  for (PetscInt p = 0; p < n; p++) PetscCall(BoxAddPoint(dm, point[p], box));
  PetscCall(ISRestoreIndices(points, &point));
  PetscCall(ISDestroy(&points));
  PetscFunctionReturn(0);
}

/* Flags every cell that has a node in common with a point; at_contact [cells] */
static PetscErrorCode FlagCellsAt(DM dm, PetscInt point, PetscBool at_contact[])
{
  PetscInt *closure = NULL, *star = NULL, n_closure, n_star, vStart, vEnd, cStart, cEnd;

  PetscFunctionBeginUser;
  PetscCall(DMPlexGetDepthStratum(dm, 0, &vStart, &vEnd));
  PetscCall(DMPlexGetHeightStratum(dm, 0, &cStart, &cEnd));
  PetscCall(DMPlexGetTransitiveClosure(dm, point, PETSC_TRUE, &n_closure, &closure));
  for (PetscInt p = 0; p < n_closure; p++) {
    const PetscInt v = closure[2 * p];

    if (v < vStart || v >= vEnd) continue;
    PetscCall(DMPlexGetTransitiveClosure(dm, v, PETSC_FALSE, &n_star, &star));
    for (PetscInt s = 0; s < n_star; s++) {
      if (star[2 * s] >= cStart && star[2 * s] < cEnd) at_contact[star[2 * s] - cStart] = PETSC_TRUE;
    }
    PetscCall(DMPlexRestoreTransitiveClosure(dm, v, PETSC_FALSE, &n_star, &star));
  }
  PetscCall(DMPlexRestoreTransitiveClosure(dm, point, PETSC_TRUE, &n_closure, &closure));
  PetscFunctionReturn(0);
}

/* Flags the cells of one set that lie opposite another set, all of them when there is no other */
static PetscErrorCode FlagCellsOfSet(DM dm, PetscInt n_sets, char *const sets[], PetscInt set, const Box boxes[],
                                     PetscBool at_contact[])
{
  IS              points;
  const PetscInt *point;
  PetscInt        n;

  PetscFunctionBeginUser;
  PetscCall(DMGetStratumIS(dm, sets[set], 1, &points));
  if (!points) PetscFunctionReturn(0);
  PetscCall(ISGetLocalSize(points, &n));
  PetscCall(ISGetIndices(points, &point));
  for (PetscInt p = 0; p < n; p++) {
    Box       box   = BOX_EMPTY;
    PetscBool faces = n_sets == 1 ? PETSC_TRUE : PETSC_FALSE;

    PetscCall(BoxAddPoint(dm, point[p], &box));
    for (PetscInt other = 0; other < n_sets && !faces; other++) {
      if (other != set) faces = BoxMeets(&box, &boxes[other]);
    }
    if (faces) PetscCall(FlagCellsAt(dm, point[p], at_contact));
  }
  PetscCall(ISRestoreIndices(points, &point));
  PetscCall(ISDestroy(&points));
  PetscFunctionReturn(0);
}

/* Flags the cells at the contact; at_contact [cells] */
static PetscErrorCode FlagContact(DM dm, PetscInt n_sets, char *const sets[], PetscBool at_contact[])
{
  Box boxes[MODEL_MAX_NAMES];

  PetscFunctionBeginUser;
  for (PetscInt s = 0; s < n_sets; s++) PetscCall(SetBox(dm, sets[s], &boxes[s]));
  for (PetscInt s = 0; s < n_sets; s++) PetscCall(FlagCellsOfSet(dm, n_sets, sets, s, boxes, at_contact));
  PetscFunctionReturn(0);
}

/* Numbers the vertices of the graph: 0 is the contact (if there is any), then the other cells in their order.
   Fills graph->n, of_cell, weight, and order [cells], the cells vertex by vertex. */
static void GraphNumber(PetscInt n_cells, const PetscBool at_contact[], Graph *graph, PetscInt order[])
{
  PetscInt n_contact = 0, next;

  for (PetscInt c = 0; c < n_cells; c++) {
    if (!at_contact[c]) continue;
    graph->of_cell[c]  = 0;
    order[n_contact++] = c;
  }
  next     = n_contact;
  graph->n = n_contact ? 1 : 0;
  if (n_contact) graph->weight[0] = n_contact;
  for (PetscInt c = 0; c < n_cells; c++) {
    if (at_contact[c]) continue;
    graph->weight[graph->n] = 1;
    graph->of_cell[c]       = graph->n++;
    order[next++]           = c;
  }
}

/* Adds the neighbours of a cell to row `vertex`, which begins at graph->start[vertex] and ends at *end; slot [n]
   is the place of a neighbour where it is already in the row */
static PetscErrorCode GraphAddCell(DM dm, PetscInt cell, PetscInt vertex, PetscInt slot[], PetscInt *end, Graph *graph)
{
  const PetscInt *face, *pair;
  PetscInt        n_faces, n_pair, cStart;

  PetscFunctionBeginUser;
  PetscCall(DMPlexGetHeightStratum(dm, 0, &cStart, NULL));
  PetscCall(DMPlexGetConeSize(dm, cStart + cell, &n_faces));
  PetscCall(DMPlexGetCone(dm, cStart + cell, &face));
  for (PetscInt f = 0; f < n_faces; f++) {
    PetscCall(DMPlexGetSupportSize(dm, face[f], &n_pair));
    PetscCall(DMPlexGetSupport(dm, face[f], &pair));
    for (PetscInt s = 0; s < n_pair; s++) {
      const PetscInt other = graph->of_cell[pair[s] - cStart];

      if (other == vertex) continue;
      if (slot[other] < graph->start[vertex]) {
        slot[other]                   = (*end)++;
        graph->neighbour[slot[other]] = other;
        graph->n_faces[slot[other]]   = 0;
      }
      graph->n_faces[slot[other]]++;
    }
  }
  PetscFunctionReturn(0);
}

/* The contracted dual graph of a mesh that lies on this rank */
static PetscErrorCode GraphCreate(DM dm, PetscInt n_sets, char *const sets[], Graph *graph)
{
  PetscInt   cStart, cEnd, fStart, fEnd, n_cells, end = 0, *order, *slot;
  PetscBool *at_contact;

  PetscFunctionBeginUser;
  PetscCall(DMPlexGetHeightStratum(dm, 0, &cStart, &cEnd));
  PetscCall(DMPlexGetHeightStratum(dm, 1, &fStart, &fEnd));
  n_cells = cEnd - cStart;
  PetscCall(PetscMalloc5(n_cells, &graph->of_cell, n_cells, &graph->weight, n_cells + 1, &graph->start,
                         2 * (fEnd - fStart), &graph->neighbour, 2 * (fEnd - fStart), &graph->n_faces));
  PetscCall(PetscCalloc1(n_cells, &at_contact));
  PetscCall(PetscMalloc2(n_cells, &order, n_cells, &slot));
  PetscCall(FlagContact(dm, n_sets, sets, at_contact));
  GraphNumber(n_cells, at_contact, graph, order);
  for (PetscInt v = 0; v < graph->n; v++) slot[v] = -1;
  for (PetscInt v = 0, i = 0; v < graph->n; v++) {
    graph->start[v] = end;
    for (const PetscInt last = i + graph->weight[v]; i < last; i++)
      PetscCall(GraphAddCell(dm, order[i], v, slot, &end, graph));
  }
  graph->start[graph->n] = end;
  PetscCall(PetscFree2(order, slot));
  PetscCall(PetscFree(at_contact));
  PetscFunctionReturn(0);
}

static PetscErrorCode GraphDestroy(Graph *graph)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree5(graph->of_cell, graph->weight, graph->start, graph->neighbour, graph->n_faces));
  PetscFunctionReturn(0);
}

/* Parts [n] of the vertices of the graph, balanced in weight, few faces between parts */
static PetscErrorCode GraphPartition(const Graph *graph, PetscInt n_parts, PetscInt part[])
{
  MetisPartition *const partition = n_parts < KWAY_FROM ? METIS_PartGraphRecursive : METIS_PartGraphKway;
  PetscInt              n = graph->n, n_weights = 1, cut, options[METIS_NOPTIONS];
  int                   status;

  PetscFunctionBeginUser;
  METIS_SetDefaultOptions(options);
  options[METIS_OPTION_SEED] = 1;
  status = partition(&n, &n_weights, graph->start, graph->neighbour, graph->weight, NULL, graph->n_faces, &n_parts,
                     NULL, NULL, options, &cut, part);
  PetscCheck(status == METIS_OK, PETSC_COMM_SELF, PETSC_ERR_LIB,
             "METIS failed with status %d on %" PetscInt_FMT " vertices", status, n);
  PetscFunctionReturn(0);
}

/* Hands the parts of the cells of rank 0 to PETSc */
static PetscErrorCode PartitionerSet(PetscPartitioner partitioner, const Graph *graph, PetscInt n_cells,
                                     PetscInt n_parts)
{
  PetscInt *part, *sizes, *first, *points;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(graph->n, &part, n_cells, &points));
  PetscCall(PetscCalloc2(n_parts, &sizes, n_parts + 1, &first));
  if (n_cells) PetscCall(GraphPartition(graph, n_parts, part));
  for (PetscInt c = 0; c < n_cells; c++) sizes[part[graph->of_cell[c]]]++;
  for (PetscInt p = 0; p < n_parts; p++) first[p + 1] = first[p] + sizes[p];
  for (PetscInt c = 0; c < n_cells; c++) points[first[part[graph->of_cell[c]]]++] = c;
  PetscCall(PetscPartitionerShellSetPartition(partitioner, n_parts, sizes, points));
  PetscCall(PetscFree2(sizes, first));
  PetscCall(PetscFree2(part, points));
  PetscFunctionReturn(0);
}

/*
   PartitionMesh - distributes a mesh from rank 0 over all ranks, without overlap. Collective. With one rank it does
   nothing.

   Errors: PETSC_ERR_USER_INPUT when there are fewer cells to hand out than ranks.
*/
PetscErrorCode PartitionMesh(DM *dm, PetscInt n_together, char *const together[])
{
  const MPI_Comm   comm = PetscObjectComm((PetscObject)*dm);
  PetscPartitioner partitioner;
  PetscMPIInt      size;
  PetscInt         cStart, cEnd, n[2];
  Graph            graph = {0};
  DM               distributed;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(comm, &size));
  if (size == 1) PetscFunctionReturn(0);
  PetscCall(DMPlexGetHeightStratum(*dm, 0, &cStart, &cEnd));
  if (cEnd > cStart) PetscCall(GraphCreate(*dm, n_together, together, &graph));
  if (cEnd > cStart &&
      graph.weight[0] * size > cEnd - cStart) { /* the contact is more than one rank's share: cut it too */
    PetscCall(GraphDestroy(&graph));
    PetscCall(GraphCreate(*dm, 0, NULL, &graph));
  }
  n[0] = graph.n;
  n[1] = cEnd - cStart;
  PetscCallMPI(MPI_Bcast(n, 2, MPIU_INT, 0, comm));
  PetscCheck(n[0] >= size, comm, PETSC_ERR_USER_INPUT,
             "%d ranks are too many for a mesh of %" PetscInt_FMT
             " elements, those at the contact staying together: at most %" PetscInt_FMT,
             size, n[1], n[0]);
  PetscCall(DMPlexGetPartitioner(*dm, &partitioner));
  PetscCall(PetscPartitionerSetType(partitioner, PETSCPARTITIONERSHELL));
  PetscCall(PartitionerSet(partitioner, &graph, cEnd - cStart, size));
  PetscCall(GraphDestroy(&graph));
  PetscCall(DMPlexDistribute(*dm, 0, NULL, &distributed));
  PetscCall(DMDestroy(dm));
  *dm = distributed;
  PetscFunctionReturn(0);
}
