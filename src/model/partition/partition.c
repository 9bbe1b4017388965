/*
   Partition: METIS on the dual graph of the mesh, whose vertices are cells and whose edges are faces between two
   cells.

   Cells that stay together are contracted to one vertex of the graph, weighted by their cost: those at the contact
   (together.c), or, where the model asks for them, the slabs of swept bodies (slabs.c), which are then dealt out anew.
   METIS is seeded: the same mesh, the same partition.

   Karypis and Kumar, SIAM J. Sci. Comput. 20 (1998) 359-392.
*/
#include "model/modelimpl.h"
#include "partition.h"

#include <metis.h>

#define KWAY_FROM 9 /* parts from which on METIS advises k-way partitioning; below, recursive bisection cuts less */

_Static_assert(sizeof(idx_t) == sizeof(PetscInt), "METIS and PETSc must have integers of the same size");

typedef int MetisPartition(idx_t *, idx_t *, idx_t *, idx_t *, idx_t *, idx_t *, idx_t *, idx_t *, real_t *, real_t *,
                           idx_t *, idx_t *, idx_t *);

/* Weighted graph in compressed rows, as METIS takes it */
typedef struct {
  PetscInt  n;                   /* vertices: the clusters, then the cells that are alone in their order */
  PetscInt *of_cell;             /* [cells] vertex that holds the cell */
  PetscInt *weight;              /* [n] cost of its cells */
  PetscInt *start;               /* [n + 1] */
  PetscInt *neighbour, *n_faces; /* [start[n]] adjacent vertex, and faces between the two */
} CellGraph;

/* Numbers the vertices of the graph. Fills graph->n, of_cell, weight, and the cells vertex by vertex: those of v are
   order[first[v]] ... order[first[v + 1] - 1] */
static void GraphNumber(const Clusters *clusters, CellGraph *graph, PetscInt first[], PetscInt order[])
{
  const PetscInt n_cells = clusters->n_cells;

  graph->n = clusters->n;
  for (PetscInt c = 0; c < n_cells; c++)
    graph->of_cell[c] = clusters->of_cell[c] < 0 ? graph->n++ : clusters->of_cell[c];
  for (PetscInt v = 0; v <= n_cells; v++) first[v] = 0;
  for (PetscInt v = 0; v < graph->n; v++) graph->weight[v] = 0;
  for (PetscInt c = 0; c < n_cells; c++) {
    graph->weight[graph->of_cell[c]] += clusters->cost[c];
    first[graph->of_cell[c] + 1]++;
  }
  for (PetscInt v = 0; v < graph->n; v++) first[v + 1] += first[v];
  for (PetscInt c = 0; c < n_cells; c++) order[first[graph->of_cell[c]]++] = c;
  for (PetscInt v = graph->n; v > 0; v--) first[v] = first[v - 1];
  first[0] = 0;
}

/* Adds the neighbours of a cell to row `vertex`, which begins at graph->start[vertex] and ends at *end; slot [n]
   is the place of a neighbour where it is already in the row */
static PetscErrorCode GraphAddCell(DM dm, PetscInt cell, PetscInt vertex, PetscInt slot[], PetscInt *end,
                                   CellGraph *graph)
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
static PetscErrorCode CellGraphCreate(DM dm, const Clusters *clusters, CellGraph *graph)
{
  const PetscInt n_cells = clusters->n_cells;
  PetscInt       fStart, fEnd, end = 0, *first, *order, *slot;

  PetscFunctionBeginUser;
  PetscCall(DMPlexGetHeightStratum(dm, 1, &fStart, &fEnd));
  PetscCall(PetscMalloc5(n_cells, &graph->of_cell, n_cells, &graph->weight, n_cells + 1, &graph->start,
                         2 * (fEnd - fStart), &graph->neighbour, 2 * (fEnd - fStart), &graph->n_faces));
  PetscCall(PetscMalloc3(n_cells + 1, &first, n_cells, &order, n_cells, &slot));
  GraphNumber(clusters, graph, first, order);
  for (PetscInt v = 0; v < graph->n; v++) slot[v] = -1;
  for (PetscInt v = 0; v < graph->n; v++) {
    graph->start[v] = end;
    for (PetscInt i = first[v]; i < first[v + 1]; i++) PetscCall(GraphAddCell(dm, order[i], v, slot, &end, graph));
  }
  graph->start[graph->n] = end;
  PetscCall(PetscFree3(first, order, slot));
  PetscFunctionReturn(0);
}

/* Parts [n] of the vertices of the graph, balanced in weight, few faces between parts */
static PetscErrorCode GraphPartition(const CellGraph *graph, PetscInt n_parts, PetscInt part[])
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

/* Ranks [cells] of the cells of rank 0 */
static PetscErrorCode CellsPartition(const CellGraph *graph, const Clusters *clusters, const Slabs *slabs,
                                     PetscInt n_parts, PetscInt rank[])
{
  PetscInt *part;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(graph->n, &part));
  PetscCall(GraphPartition(graph, n_parts, part));
  for (PetscInt c = 0; c < clusters->n_cells; c++) rank[c] = part[graph->of_cell[c]];
  PetscCall(SlabsDeal(slabs, clusters, n_parts, rank));
  PetscCall(PetscFree(part));
  PetscFunctionReturn(0);
}

/* Hands the ranks of the cells of rank 0 to PETSc */
static PetscErrorCode PartitionerSet(PetscPartitioner partitioner, PetscInt n_cells, PetscInt n_parts,
                                     const PetscInt rank[])
{
  PetscInt *sizes, *first, *points;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n_cells, &points));
  PetscCall(PetscCalloc2(n_parts, &sizes, n_parts + 1, &first));
  for (PetscInt c = 0; c < n_cells; c++) sizes[rank[c]]++;
  for (PetscInt p = 0; p < n_parts; p++) first[p + 1] = first[p] + sizes[p];
  for (PetscInt c = 0; c < n_cells; c++) points[first[rank[c]]++] = c;
  PetscCall(PetscPartitionerShellSetPartition(partitioner, n_parts, sizes, points));
  PetscCall(PetscFree2(sizes, first));
  PetscCall(PetscFree(points));
  PetscFunctionReturn(0);
}

/* No clusters; the cost of a cell is the entries of its matrices, 1 for a hexahedron of 8 nodes */
static PetscErrorCode ClustersCreate(Model model, Clusters *clusters)
{
  PetscFunctionBeginUser;
  clusters->n       = 0;
  clusters->n_cells = model->mesh.n_cells;
  PetscCall(PetscMalloc2(clusters->n_cells, &clusters->of_cell, clusters->n_cells, &clusters->cost));
  for (PetscInt c = 0; c < clusters->n_cells; c++) {
    const PetscInt n = model->mesh.element[c]->n_nodes;

    clusters->of_cell[c] = -1;
    clusters->cost[c]    = PetscMax(1, (n * n + 32) / 64);
  }
  PetscFunctionReturn(0);
}

/* Replaces the mesh by its parts */
static PetscErrorCode MeshDistribute(DM *dm, PetscInt n_cells, PetscInt n_parts, const PetscInt rank[])
{
  PetscPartitioner partitioner;
  DM               distributed;

  PetscFunctionBeginUser;
  PetscCall(DMPlexGetPartitioner(*dm, &partitioner));
  PetscCall(PetscPartitionerSetType(partitioner, PETSCPARTITIONERSHELL));
  PetscCall(PartitionerSet(partitioner, n_cells, n_parts, rank));
  PetscCall(DMPlexDistribute(*dm, 0, NULL, &distributed));
  PetscCall(DMDestroy(dm));
  *dm = distributed;
  PetscFunctionReturn(0);
}

/*
   PartitionMesh - distributes a mesh from rank 0 over all ranks, without overlap. Collective. With one rank it does
   nothing.

   Errors: PETSC_ERR_USER_INPUT when there are fewer cells to hand out than ranks.
*/
PetscErrorCode PartitionMesh(Model model)
{
  PetscMPIInt size;
  PetscInt    n[2], *rank;
  Clusters    clusters;
  Slabs       slabs = {0};
  CellGraph   graph = {0};

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(model->comm, &size));
  if (size == 1) PetscFunctionReturn(0);
  PetscCall(ClustersCreate(model, &clusters));
  if (model->keep_slabs)
    PetscCall(SlabsFind(model, size, &clusters, &slabs));
  else
    PetscCall(TogetherFind(model, size, &clusters));
  PetscCall(CellGraphCreate(model->dm, &clusters, &graph));
  n[0] = graph.n;
  n[1] = clusters.n_cells;
  PetscCallMPI(MPI_Bcast(n, 2, MPIU_INT, 0, model->comm));
  PetscCheck(n[0] >= size, model->comm, PETSC_ERR_USER_INPUT,
             "%d ranks are too many for a mesh of %" PetscInt_FMT
             " elements, those %s staying together: at most %" PetscInt_FMT,
             size, n[1], model->keep_slabs ? "of a slab" : "at the contact", n[0]);
  PetscCall(PetscMalloc1(clusters.n_cells, &rank));
  if (clusters.n_cells) PetscCall(CellsPartition(&graph, &clusters, &slabs, size, rank));
  PetscCall(MeshReset(model));
  PetscCall(MeshDistribute(&model->dm, clusters.n_cells, size, rank));
  PetscCall(MeshTabulate(model));
  PetscCall(PetscFree(rank));
  PetscCall(PetscFree5(graph.of_cell, graph.weight, graph.start, graph.neighbour, graph.n_faces));
  PetscCall(SlabsDestroy(&slabs));
  PetscCall(PetscFree2(clusters.of_cell, clusters.cost));
  PetscFunctionReturn(0);
}
