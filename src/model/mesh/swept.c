/*
   Whether a motion sweeps a body.

   A swept body is a plane mesh times a row of equally spaced places: its node at (q, s) stands on line q at place s,
   with
      q = (r, z), s = angle      about an axis, here z, with r the distance from it, or
      q = (x, y), s = z          along an axis,
   and each of its cells lies between the places s_k and s_{k+1} of four lines. The three coordinates of all nodes are
   sorted, and values that differ by rounding are one level; the body is swept when the levels of s are equally spaced,
   every line has a node on each of them, every edge of a cell runs along a line or on a level, and the cells between
   the same four lines follow each other without a gap, all of one part. Cost O(n log n).

   Places k = 0..n-1 about an axis are cyclic. The slab between k and k + 1 has cells or has none: with all n slabs the
   body is closed; with one missing it is an arc, which begins behind that.
*/
#include "swept.h"
#include <stdlib.h>

#define SHORTEST 5 /* nodes of a line: the few layers of a thin plate are no lines worth a kernel of their own */
#define COLUMN   4 /* lines around a column of cells */

/* A node and its value of a coordinate */
typedef struct {
  PetscReal value;
  PetscInt  node;
} SweptPlace;

/* A node by the levels of its coordinates: two of its line, then its place on the line */
typedef struct {
  PetscInt level[3], node;
} Mark;

/* A cell by its lines, ascending, and its slab */
typedef struct {
  PetscInt line[COLUMN], slab, part;
} Block;

/* A body seen as swept by one motion */
typedef struct {
  Motion     motion;
  PetscInt   n_levels[3];
  PetscReal *at;     /* [n_levels[2]] place on a line, m or rad */
  Mark      *mark;   /* [n_nodes], line by line */
  PetscInt  *line;   /* [n_nodes] */
  PetscInt  *place;  /* [n_nodes] place on its line, from 0 */
  PetscInt   start;  /* place at which the lines begin */
  PetscBool  closed; /* all around */
} SweptColumn;

/* Distance across the axis, height (m) and angle in [0, 2 pi) of a node, or the two coordinates across the axis and
   that along it; a full turn but for the tolerance (rad) is none */
static void SweptCoordinates(const Motion *motion, const PetscReal x[3], PetscReal tolerance, PetscReal value[3])
{
  const int       a = (motion->axis + 1) % 3, b = (motion->axis + 2) % 3;
  const PetscReal across[2] = {x[a] - motion->centre[a], x[b] - motion->centre[b]};

  if (!motion->turned) {
    value[0] = x[a];
    value[1] = x[b];
    value[2] = x[motion->axis];
    return;
  }
  value[0] = hypot(across[0], across[1]);
  value[1] = x[motion->axis];
  value[2] = atan2(across[1], across[0]);
  if (value[2] < 0) value[2] += 2 * PETSC_PI;
  if (value[2] > 2 * PETSC_PI - tolerance) value[2] -= 2 * PETSC_PI;
}

static int LinePlaceCompare(const void *a, const void *b)
{
  const PetscReal x = ((const SweptPlace *)a)->value, y = ((const SweptPlace *)b)->value;

  return (x > y) - (x < y);
}

/* Writes the level of each node into component d of its mark, and the least value of each level into at[n] */
static PetscInt LevelsFind(PetscInt n, SweptPlace place[], PetscReal tolerance, int d, Mark mark[], PetscReal at[])
{
  PetscInt n_levels = 0;

  if (n) qsort(place, (size_t)n, sizeof(*place), LinePlaceCompare);
  for (PetscInt i = 0; i < n; i++) {
    if (!n_levels || place[i].value - at[n_levels - 1] > tolerance) at[n_levels++] = place[i].value;
    mark[place[i].node].level[d] = n_levels - 1;
  }
  return n_levels;
}

/* Tolerances of the three coordinates, m and rad; whether no node stands on the axis */
static PetscBool SweptTolerances(const Piece *piece, const Motion *motion, PetscReal tolerance[3])
{
  PetscReal least = PETSC_MAX_REAL, value[3];

  for (int d = 0; d < 3; d++) tolerance[d] = LINES_TOLERANCE * piece->size;
  if (!motion->turned) return PETSC_TRUE;
  for (PetscInt i = 0; i < piece->n_nodes; i++) {
    SweptCoordinates(motion, &piece->x[3 * i], 0, value);
    least = PetscMin(least, value[0]);
  }
  if (least <= 1e3 * tolerance[0]) return PETSC_FALSE;
  tolerance[2] /= least;
  return PETSC_TRUE;
}

/* Levels of all nodes, the coordinate of more levels first, so that neighbouring lines are near each other in the order
   of their levels */
static PetscErrorCode SweptFindLevels(const Piece *piece, const PetscReal tolerance[3], SweptColumn *swept)
{
  const PetscInt n = piece->n_nodes;
  PetscReal      value[3];
  SweptPlace    *place;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n, &place));
  for (int d = 0; d < 3; d++) {
    for (PetscInt i = 0; i < n; i++) {
      SweptCoordinates(&swept->motion, &piece->x[3 * i], tolerance[2], value);
      place[i] = (SweptPlace){value[d], i};
    }
    swept->n_levels[d] = LevelsFind(n, place, tolerance[d], d, swept->mark, swept->at);
  }
  PetscCall(PetscFree(place));
  for (PetscInt i = 0; i < n; i++) {
    Mark *const    mark = &swept->mark[i];
    const PetscInt last = mark->level[1];

    mark->node = i;
    if (swept->n_levels[0] >= swept->n_levels[1]) continue;
    mark->level[1] = mark->level[0];
    mark->level[0] = last;
  }
  PetscFunctionReturn(0);
}

static int MarkCompare(const void *a, const void *b)
{
  const PetscInt *x = ((const Mark *)a)->level, *y = ((const Mark *)b)->level;
  int             d = 0;

  while (d < 2 && x[d] == y[d]) d++;
  return (x[d] > y[d]) - (x[d] < y[d]);
}

/* Line and place of each node; whether every line has exactly one node at each place */
static PetscBool SweptFindLines(PetscInt n_nodes, SweptColumn *swept)
{
  const PetscInt n = swept->n_levels[2];

  if (n < SHORTEST || n_nodes % n) return PETSC_FALSE;
  if (n_nodes) qsort(swept->mark, (size_t)n_nodes, sizeof(*swept->mark), MarkCompare);
  for (PetscInt i = 0; i < n_nodes; i++) {
    const PetscInt *level = swept->mark[i].level, *first = swept->mark[i - i % n].level;

    if (level[0] != first[0] || level[1] != first[1] || level[2] != i % n) return PETSC_FALSE;
    swept->line[swept->mark[i].node]  = i / n;
    swept->place[swept->mark[i].node] = i % n;
  }
  return PETSC_TRUE;
}

/* Lines and slab of a cell; whether its edges in one direction run along four lines by one place and all others lie on
   levels */
static PetscBool BlockFind(const SweptColumn *swept, const PetscInt corners[LINES_CORNERS], Block *block)
{
  const PetscInt n       = swept->n_levels[2];
  int            n_along = 0;

  for (int e = 0; e < MOTION_PAIRS * MOTION_EDGES; e++) {
    const int     *edge = motion_hex8_edge[e / MOTION_EDGES][e % MOTION_EDGES];
    const PetscInt p = corners[edge[0]], q = corners[edge[1]], step = (swept->place[q] - swept->place[p] + n) % n;

    if (swept->line[p] != swept->line[q] && step == 0) continue;
    if (swept->line[p] != swept->line[q] || (step != 1 && step != n - 1) || n_along == COLUMN) return PETSC_FALSE;
    block->slab            = step == 1 ? swept->place[p] : swept->place[q];
    block->line[n_along++] = swept->line[p];
  }
  return n_along == COLUMN ? PETSC_TRUE : PETSC_FALSE;
}

static int BlockCompare(const void *a, const void *b)
{
  const Block *x = a, *y = b;
  int          i = 0;

  while (i < COLUMN - 1 && x->line[i] == y->line[i]) i++;
  if (x->line[i] != y->line[i]) return x->line[i] < y->line[i] ? -1 : 1;
  return (x->slab > y->slab) - (x->slab < y->slab);
}

/* Where the lines begin, from the slabs that have cells: has [places]; whether they are one row. Numbers the slabs of
   the blocks from there. */
static PetscBool SlabsOrder(PetscInt n_cells, const PetscBool has[], SweptColumn *swept, Block block[])
{
  const PetscInt n         = swept->n_levels[2];
  PetscInt       n_missing = 0;

  swept->start = 0;
  for (PetscInt k = 0; k < n; k++) {
    if (has[k]) continue;
    n_missing++;
    swept->start = (k + 1) % n;
  }
  swept->closed = n_missing ? PETSC_FALSE : PETSC_TRUE;
  for (PetscInt c = 0; c < n_cells; c++) block[c].slab = (block[c].slab - swept->start + n) % n;
  return n_missing <= 1 && (swept->motion.turned || (n_missing == 1 && !swept->start)) ? PETSC_TRUE : PETSC_FALSE;
}

/* Whether the cells of every column are one in each slab, all of the same part */
static PetscBool ColumnsHold(PetscInt n_cells, PetscInt n_slabs, Block block[])
{
  if (n_slabs < 1 || n_cells % n_slabs) return PETSC_FALSE;
  if (n_cells) qsort(block, (size_t)n_cells, sizeof(*block), BlockCompare);
  for (PetscInt c = 0; c < n_cells; c++) {
    const Block *first = &block[c - c % n_slabs];

    if (block[c].slab != c % n_slabs || block[c].part != first->part) return PETSC_FALSE;
    for (int i = 0; i < COLUMN; i++)
      if (block[c].line[i] != first->line[i]) return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

/* Whether all cells lie between the lines as swept ones do */
static PetscErrorCode SweptCheckCells(const Piece *piece, SweptColumn *swept, PetscBool *holds)
{
  const PetscInt n = swept->n_levels[2];
  PetscBool     *has;
  Block         *block;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(piece->n_cells, &block));
  PetscCall(PetscCalloc1(n, &has));
  for (PetscInt c = 0; c < piece->n_cells && *holds; c++) {
    *holds        = BlockFind(swept, &piece->corners[LINES_CORNERS * c], &block[c]);
    block[c].part = piece->part[c];
    if (!*holds) continue;
    has[block[c].slab] = PETSC_TRUE;
    PetscCall(PetscSortInt(COLUMN, block[c].line));
  }
  if (*holds) *holds = SlabsOrder(piece->n_cells, has, swept, block);
  if (*holds) *holds = ColumnsHold(piece->n_cells, n - (swept->closed ? 0 : 1), block);
  PetscCall(PetscFree(has));
  PetscCall(PetscFree(block));
  PetscFunctionReturn(0);
}

/* First place of the lines and the step; whether all places are equally spaced */
static PetscBool SweptSpacing(const SweptColumn *swept, PetscReal tolerance, PetscReal *begin, PetscReal *step)
{
  const PetscInt  n = swept->n_levels[2], last = (swept->start + n - 1) % n;
  const PetscReal turn = 2 * PETSC_PI;

  *begin = swept->at[swept->start];
  *step  = (swept->at[last] + (last < swept->start ? turn : 0) - *begin) / (PetscReal)(n - 1);
  if (swept->closed) *step = turn / (PetscReal)n;
  for (PetscInt k = 0; k < n; k++) {
    const PetscInt  place = (swept->start + k) % n;
    const PetscReal at    = swept->at[place] + (place < swept->start ? turn : 0);

    if (PetscAbsReal(at - *begin - (PetscReal)k * *step) > 2 * tolerance) return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

/* The lines of a body that is swept */
static PetscErrorCode SweptFillLines(const Piece *piece, const SweptColumn *swept, PetscReal begin, PetscReal step,
                                     ModelLines **lines)
{
  const PetscInt n = swept->n_levels[2];

  PetscFunctionBeginUser;
  PetscCall(PetscNew(lines));
  **lines = (ModelLines){.turned  = swept->motion.turned ? PETSC_TRUE : PETSC_FALSE,
                         .axis    = swept->motion.axis,
                         .begin   = begin,
                         .step    = step,
                         .n_lines = piece->n_nodes / n,
                         .n_nodes = n,
                         .closed  = swept->closed};
  PetscCall(PetscMalloc1(piece->n_nodes, &(*lines)->vertex));
  for (PetscInt i = 0; i < piece->n_nodes; i++) {
    const PetscInt place = (swept->start + i % n) % n;

    (*lines)->vertex[i] = piece->vertex[swept->mark[i - i % n + place].node];
  }
  PetscFunctionReturn(0);
}

PetscErrorCode SweptCreateLines(const Piece *piece, const Motion *motion, ModelLines **lines)
{
  const PetscInt n = piece->n_nodes;
  PetscReal      tolerance[3], begin, step;
  PetscBool      holds;
  SweptColumn    swept = {.motion = *motion};

  PetscFunctionBeginUser;
  *lines = NULL;
  if (!SweptTolerances(piece, motion, tolerance)) PetscFunctionReturn(0);
  PetscCall(PetscMalloc4(n, &swept.at, n, &swept.mark, n, &swept.line, n, &swept.place));
  PetscCall(SweptFindLevels(piece, tolerance, &swept));
  holds = SweptFindLines(n, &swept);
  if (holds) PetscCall(SweptCheckCells(piece, &swept, &holds));
  if (holds) holds = SweptSpacing(&swept, tolerance[2], &begin, &step);
  if (holds) PetscCall(SweptFillLines(piece, &swept, begin, step, lines));
  PetscCall(PetscFree4(swept.at, swept.mark, swept.line, swept.place));
  PetscFunctionReturn(0);
}
