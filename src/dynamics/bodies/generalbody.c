/*
   Bodies that are not swept: K in rows of 3 x 3 blocks, one for each pair of nodes of this rank that share a cell;
   memory limits the speed, hence the symmetric half alone is kept. C = alpha M + beta K; rows between parts of
   different beta have blocks of their own for the second term, whole rows of them.
*/
#include "bodiesimpl.h"
#include <stdint.h>

static PetscErrorCode GeneralFindCells(Bodies b, BodiesRowCells *cells)
{
  const General *g    = &b->general;
  const Mesh    *mesh = b->mesh;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(b->layout.n_vertices, &cells->of_vertex, mesh->n_cells, &cells->cell));
  for (PetscInt v = 0; v < b->layout.n_vertices; v++) cells->of_vertex[v] = -1;
  for (PetscInt i = 0; i < g->n; i++) cells->of_vertex[g->vertex[i]] = i;
  cells->n_nodes = g->n;
  for (PetscInt c = 0; c < mesh->n_cells; c++)
    if (cells->of_vertex[mesh->cell_node[mesh->cell_first[c]]] >= 0) cells->cell[cells->n++] = c;
  PetscFunctionReturn(0);
}

/* Goes through the pairs of nodes of each cell: at[row] is raised by one for each, and tells its place in `column`
   where that is not NULL */
static void NeighboursTake(const BodiesRowCells *cells, const Mesh *mesh, PetscBool upper, PetscInt at[],
                           PetscInt column[])
{
  for (PetscInt i = 0; i < cells->n; i++) {
    const PetscInt  n_nodes = mesh->element[cells->cell[i]]->n_nodes;
    const PetscInt *vertex  = &mesh->cell_node[mesh->cell_first[cells->cell[i]]];

    for (PetscInt k = 0; k < n_nodes * n_nodes; k++) {
      const PetscInt row = cells->of_vertex[vertex[k / n_nodes]], other = cells->of_vertex[vertex[k % n_nodes]];

      if (upper && other < row) continue;
      if (column) column[at[row]] = other;
      at[row]++;
    }
  }
}

/* Neighbours of all rows, once for each cell that they share: those of a row end before column[end[row]]. Counted
   first, then filled, the running ends being the places of the next entries. */
static PetscErrorCode NeighboursCreate(const BodiesRowCells *cells, const Mesh *mesh, PetscBool upper, PetscInt **end,
                                       PetscInt **column)
{
  PetscInt n = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(cells->n_nodes + 1, end));
  NeighboursTake(cells, mesh, upper, *end, NULL);
  for (PetscInt row = 0; row <= cells->n_nodes; row++) {
    const PetscInt count = (*end)[row];

    (*end)[row] = n;
    n += count;
  }
  PetscCall(PetscMalloc1(n, column));
  NeighboursTake(cells, mesh, upper, *end, *column);
  PetscFunctionReturn(0);
}

PetscErrorCode BlockRowsCreate(const BodiesRowCells *cells, const Mesh *mesh, PetscBool upper, BlockRows *rows)
{
  PetscInt *end, *all;

  PetscFunctionBeginUser;
  rows->n     = cells->n_nodes;
  rows->upper = upper;
  PetscCall(PetscCalloc1(rows->n + 1, &rows->start));
  PetscCall(NeighboursCreate(cells, mesh, upper, &end, &all));
  for (PetscInt row = 0; row < rows->n; row++) {
    const PetscInt begin = row ? end[row - 1] : 0;
    PetscInt       n     = end[row] - begin;

    PetscCall(PetscSortRemoveDupsInt(&n, &all[begin]));
    PetscCall(PetscArraymove(&all[rows->start[row]], &all[begin], n));
    rows->start[row + 1] = rows->start[row] + n;
  }
  PetscCall(PetscMalloc1(rows->start[rows->n], &rows->column));
  PetscCall(PetscArraycpy(rows->column, all, rows->start[rows->n]));
  PetscCall(PetscCalloc1(9 * rows->start[rows->n] + 1, &rows->value));
  PetscCall(PetscFree(end));
  PetscCall(PetscFree(all));
  PetscFunctionReturn(0);
}

/* Columns are found by bisection; value [9] of a block by rows */
PetscErrorCode BlockRowsAdd(const BodiesRowCells *cells, const BodiesCell *cell, PetscReal scale, BlockRows *rows)
{
  const PetscInt n = cell->n_nodes;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < n * n; i++) {
    const PetscInt a = i / n, e = i % n, row = cells->of_vertex[cell->vertex[a]];
    const PetscInt column = cells->of_vertex[cell->vertex[e]];
    PetscInt       k;

    if (rows->upper && column < row) continue;
    PetscCall(PetscFindInt(column, rows->start[row + 1] - rows->start[row], &rows->column[rows->start[row]], &k));
    for (int j = 0; j < 9; j++)
      rows->value[9 * (rows->start[row] + k) + j] += scale * cell->stiffness[(3 * a + j / 3) * 3 * n + 3 * e + j % 3];
  }
  PetscFunctionReturn(0);
}

/* Stiffness, masses (kg), alpha M (kg/s) and beta (s) of all cells; beta is -1 where no cell was yet, and -2 where
   cells differ */
static PetscErrorCode GeneralSum(Bodies b, const BodiesRowCells *cells)
{
  General *g = &b->general;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < g->n; i++) g->beta[i] = -1;
  for (PetscInt c = 0; c < cells->n; c++) {
    BodiesCell cell;

    PetscCall(BodiesGetCell(b, cells->cell[c], &cell));
    BodiesTurnCell(&b->layout, &cell);
    PetscCall(BlockRowsAdd(cells, &cell, 1, &g->stiffness));
    for (PetscInt a = 0; a < cell.n_nodes; a++) {
      const PetscInt i = cells->of_vertex[cell.vertex[a]];

      g->mass[i] += cell.mass[a];
      g->alpha[i] += cell.alpha * cell.mass[a];
      g->beta[i] = g->beta[i] == -1 || g->beta[i] == cell.beta ? cell.beta : -2;
    }
  }
  PetscFunctionReturn(0);
}

/* Whether a node of the cell has cells of different beta */
static PetscBool GeneralIsMixed(const General *g, const BodiesRowCells *cells, PetscInt n_nodes,
                                const PetscInt vertex[])
{
  for (PetscInt a = 0; a < n_nodes; a++)
    if (g->beta[cells->of_vertex[vertex[a]]] == -2) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* Empties rows but for those of nodes with different beta */
static PetscErrorCode BlockRowsKeepMixed(const General *g, BlockRows *rows)
{
  PetscInt end = 0;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < rows->n; i++) {
    const PetscInt begin = rows->start[i], n = g->beta[i] == -2 ? rows->start[i + 1] - begin : 0;

    PetscCall(PetscArraymove(&rows->column[end], &rows->column[begin], n));
    PetscCall(PetscArraymove(&rows->value[9 * end], &rows->value[9 * begin], 9 * n));
    rows->start[i] = end;
    end += n;
  }
  rows->start[rows->n] = end;
  PetscFunctionReturn(0);
}

/* Blocks of the second term of C for the nodes of which the cells have different beta */
static PetscErrorCode GeneralSumDamping(Bodies b, const BodiesRowCells *cells)
{
  General *g     = &b->general;
  PetscInt mixed = 0;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < g->n; i++) mixed += g->beta[i] == -2;
  if (!mixed) {
    PetscCall(PetscCalloc1(g->n + 1, &g->damping.start));
    PetscFunctionReturn(0);
  }
  PetscCall(BlockRowsCreate(cells, b->mesh, PETSC_FALSE, &g->damping));
  for (PetscInt c = 0; c < cells->n; c++) {
    const PetscInt  n_nodes = b->mesh->element[cells->cell[c]]->n_nodes;
    const PetscInt *vertex  = &b->mesh->cell_node[b->mesh->cell_first[cells->cell[c]]];
    BodiesCell      cell;

    if (!GeneralIsMixed(g, cells, n_nodes, vertex)) continue;
    PetscCall(BodiesGetCell(b, cells->cell[c], &cell));
    BodiesTurnCell(&b->layout, &cell);
    PetscCall(BlockRowsAdd(cells, &cell, cell.beta, &g->damping));
  }
  PetscCall(BlockRowsKeepMixed(g, &g->damping));
  PetscFunctionReturn(0);
}

/* product [n][4], g = K v of the step, is aligned for loads of four numbers; `room` is what is freed. */
PetscErrorCode GeneralSetUp(Bodies b)
{
  General       *g     = &b->general;
  BodiesRowCells cells = {0};

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc4(g->n, &g->mass, g->n, &g->alpha, g->n, &g->beta, 4 * g->n + 4, &g->room));
  g->product = g->room;
  while ((uintptr_t)g->product % sizeof(StencilLanes)) g->product++;
  PetscCall(GeneralFindCells(b, &cells));
  PetscCall(BlockRowsCreate(&cells, b->mesh, PETSC_TRUE, &g->stiffness));
  PetscCall(GeneralSum(b, &cells));
  PetscCall(GeneralSumDamping(b, &cells));
  PetscCall(PetscFree2(cells.of_vertex, cells.cell));
  PetscFunctionReturn(0);
}

PetscErrorCode BlockRowsDestroy(BlockRows *rows)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(rows->start));
  PetscCall(PetscFree(rows->column));
  PetscCall(PetscFree(rows->value));
  PetscFunctionReturn(0);
}

PetscErrorCode GeneralDestroy(General *general)
{
  PetscFunctionBeginUser;
  PetscCall(BlockRowsDestroy(&general->stiffness));
  PetscCall(BlockRowsDestroy(&general->damping));
  PetscCall(PetscFree(general->vertex));
  PetscCall(PetscFree4(general->mass, general->alpha, general->beta, general->room));
  PetscFunctionReturn(0);
}
