/*
   Fill-reducing order by METIS nested dissection for MUMPS on one rank, as the MatOrderingType "metis".

   The unknowns of a mesh node have the same neighbours. Consecutive rows of identical pattern are therefore one node
   of the graph that METIS dissects, weighted by their number; its edges are those of A + A'.

   METIS returns perm (old number of each new row) and iperm (new number of each old row). PETSc's LU hands the row
   ordering unchanged to MUMPS as PERM_IN, the position of each variable in the pivot sequence: this is iperm, and the
   factorisations of PETSc itself, which expect perm, must not use this order. PETSc passes no order to the LDL' of
   MUMPS, nor to MUMPS on several ranks: there the type has no effect, and -mat_mumps_icntl_7 selects one of MUMPS'
   own.

   Reference: Karypis, Kumar, A fast and high quality multilevel scheme for partitioning irregular graphs, SIAM J. Sci.
   Comput. 20, 1998.
*/
#include "ordering.h"
#include <metis.h>

/* Graph of groups of rows, in the form METIS takes */
typedef struct {
  idx_t  n;             /* nodes */
  idx_t *start, *edges; /* neighbours of v are edges[start[v]] .. edges[start[v + 1] - 1] */
  idx_t *weight;        /* rows per node */
} UnknownGraph;

/* Whether rows i and j have the same columns */
static PetscBool SamePattern(const PetscInt ia[], const PetscInt ja[], PetscInt i, PetscInt j)
{
  const PetscInt length = ia[i + 1] - ia[i];

  if (ia[j + 1] - ia[j] != length) return PETSC_FALSE;
  for (PetscInt k = 0; k < length; k++) {
    if (ja[ia[i] + k] != ja[ia[j] + k]) return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

/* Numbers the groups of consecutive rows of identical pattern: group[n_rows], weight[n_groups], n_groups */
static idx_t GroupRows(PetscInt n_rows, const PetscInt ia[], const PetscInt ja[], idx_t group[], idx_t weight[])
{
  idx_t n = 0;

  for (PetscInt i = 0; i < n_rows; i++) {
    if (i == 0 || !SamePattern(ia, ja, i - 1, i)) weight[n++] = 0;
    group[i] = n - 1;
    weight[n - 1]++;
  }
  return n;
}

/* Counts (edges NULL) or stores the ends of all arcs of A and of A' between different groups, each at end[node].
   Neighbouring columns of one group are one arc; what still stands twice goes by GraphUnique(). */
static void VisitArcs(PetscInt n_rows, const PetscInt ia[], const PetscInt ja[], const idx_t group[], idx_t end[],
                      idx_t edges[])
{
  for (PetscInt i = 0; i < n_rows; i++) {
    if (i > 0 && group[i] == group[i - 1]) continue; /* the first row of a group has the pattern of all */
    for (PetscInt k = ia[i]; k < ia[i + 1]; k++) {
      const idx_t g = group[i], h = group[ja[k]];

      if (g == h || (k > ia[i] && h == group[ja[k - 1]])) continue;
      if (edges) {
        edges[end[g]] = h;
        edges[end[h]] = g;
      }
      end[g]++;
      end[h]++;
    }
  }
}

/* Removes repeated neighbours, in place; seen[n] is work: seen[w] = the last node that w was met at. */
static void GraphUnique(UnknownGraph *graph, idx_t seen[])
{
  idx_t kept = 0, first = 0;

  for (idx_t v = 0; v < graph->n; v++) seen[v] = -1;
  for (idx_t v = 0; v < graph->n; v++) {
    const idx_t last = graph->start[v + 1];

    for (idx_t k = first; k < last; k++) {
      const idx_t w = graph->edges[k];

      if (seen[w] == v) continue;
      seen[w]              = v;
      graph->edges[kept++] = w;
    }
    first               = last;
    graph->start[v + 1] = kept;
  }
}

/* Graph of A + A' on the groups of rows, and group[n_rows]; the caller frees the graph by UnknownGraphDestroy() */
static PetscErrorCode UnknownGraphCreate(PetscInt n_rows, const PetscInt ia[], const PetscInt ja[], idx_t group[],
                                         UnknownGraph *graph)
{
  idx_t *end;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n_rows, &graph->weight));
  graph->n = GroupRows(n_rows, ia, ja, group, graph->weight);
  PetscCall(PetscCalloc1(graph->n + 1, &graph->start));
  PetscCall(PetscMalloc1(graph->n, &end));
  VisitArcs(n_rows, ia, ja, group, graph->start + 1, NULL);
  for (idx_t v = 0; v < graph->n; v++) {
    end[v] = graph->start[v];
    graph->start[v + 1] += graph->start[v];
  }
  PetscCall(PetscMalloc1(graph->start[graph->n], &graph->edges));
  VisitArcs(n_rows, ia, ja, group, end, graph->edges);
  GraphUnique(graph, end);
  PetscCall(PetscFree(end));
  PetscFunctionReturn(0);
}

/* Frees the arrays of a graph */
static PetscErrorCode UnknownGraphDestroy(UnknownGraph *graph)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(graph->start));
  PetscCall(PetscFree(graph->edges));
  PetscCall(PetscFree(graph->weight));
  PetscFunctionReturn(0);
}

/* Nested dissection: perm[n], the nodes in order of elimination */
static PetscErrorCode GraphDissect(UnknownGraph *graph, idx_t perm[])
{
  idx_t *iperm, options[METIS_NOPTIONS];
  int    status;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(graph->n, &iperm));
  METIS_SetDefaultOptions(options);
  status = METIS_NodeND(&graph->n, graph->start, graph->edges, graph->weight, options, perm, iperm);
  PetscCheck(status != METIS_ERROR_MEMORY, PETSC_COMM_SELF, PETSC_ERR_MEM,
             "METIS found no memory to order a graph of %" PetscInt_FMT " vertices", (PetscInt)graph->n);
  PetscCheck(status == METIS_OK, PETSC_COMM_SELF, PETSC_ERR_LIB,
             "METIS failed with status %d on a graph of %" PetscInt_FMT " vertices", status, (PetscInt)graph->n);
  PetscCall(PetscFree(iperm));
  PetscFunctionReturn(0);
}

/* Position of each row, position[n_rows], when the groups are eliminated in the order perm, each row after row */
static PetscErrorCode ExpandOrder(const UnknownGraph *graph, const idx_t perm[], PetscInt n_rows, const idx_t group[],
                                  PetscInt position[])
{
  PetscInt *next, count = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(graph->n, &next));
  for (idx_t k = 0; k < graph->n; k++) {
    next[perm[k]] = count;
    count += graph->weight[perm[k]];
  }
  for (PetscInt i = 0; i < n_rows; i++) position[i] = next[group[i]]++;
  PetscCall(PetscFree(next));
  PetscFunctionReturn(0);
}

/* Positions of the rows of a sequential matrix in the pivot sequence, as row and column IS */
static PetscErrorCode MatGetOrdering_Metis(Mat A, MatOrderingType type, IS *row, IS *col)
{
  UnknownGraph    graph = {0};
  PetscInt        n, *position;
  const PetscInt *ia, *ja;
  idx_t          *group, *perm;
  MatType         mat_type;
  PetscBool       done;

  PetscFunctionBeginUser;
  PetscCall(MatGetType(A, &mat_type));
  PetscCall(MatGetRowIJ(A, 0, PETSC_FALSE, PETSC_FALSE, &n, &ia, &ja, &done));
  PetscCheck(done, PetscObjectComm((PetscObject)A), PETSC_ERR_SUP, "Ordering %s needs a matrix of type %s, not %s",
             type, MATSEQAIJ, mat_type);
  PetscCheck(ia[n] < IDX_MAX / 2, PetscObjectComm((PetscObject)A), PETSC_ERR_SUP,
             "Ordering %s: %" PetscInt_FMT " nonzeros exceed METIS's integers of %d bits", type, ia[n], IDXTYPEWIDTH);
  PetscCall(PetscMalloc3(n, &group, n, &perm, n, &position));
  PetscCall(UnknownGraphCreate(n, ia, ja, group, &graph));
  PetscCall(MatRestoreRowIJ(A, 0, PETSC_FALSE, PETSC_FALSE, NULL, &ia, &ja, &done));
  PetscCall(GraphDissect(&graph, perm));
  PetscCall(ExpandOrder(&graph, perm, n, group, position));
  PetscCall(UnknownGraphDestroy(&graph));
  PetscCall(ISCreateGeneral(PETSC_COMM_SELF, n, position, PETSC_COPY_VALUES, row));
  PetscCall(ISDuplicate(*row, col));
  PetscCall(PetscFree3(group, perm, position));
  PetscFunctionReturn(0);
}

PetscErrorCode OrderingRegister(void)
{
  PetscFunctionBeginUser;
  PetscCall(MatOrderingRegister(ORDERING_METIS, MatGetOrdering_Metis));
  PetscFunctionReturn(0);
}
