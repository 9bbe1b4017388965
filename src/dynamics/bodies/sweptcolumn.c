/*
   Coefficients of the stencil of a swept body (kernels/element/stencil.h) from one cell of each column between four
   lines. A cell between nodes k and k + 1 gives, for nodes of lines i and j, blocks of K_e at (k, k): A0 of the cells
   after the node; (k + 1, k + 1): A0 of those before; (k, k + 1): A+; (k + 1, k): A-. They are summed over the columns,
   once more with the beta of the parts for the damping, and tested for mirror symmetry.
*/
#include "bodiesimpl.h"

/* relative to the largest coefficient: rounding of K_e; a tapered or twisted cell differs by far more */
#define MIRROR_TOLERANCE 1e-10

/* Blocks of a line and its neighbour, in the components p, q, c */
typedef struct {
  PetscReal after[9], before[9], up[9], down[9];
} ColumnBlocks;

/* A column by its cell between nodes 0 and 1 */
typedef struct {
  PetscInt  cell, line[8];
  PetscBool second[8];            /* the node is node 1 */
  PetscReal alpha, beta, mass[8]; /* of the cell, 1/s, s, kg, known when it is summed */
} Column;

typedef struct {
  PetscInt      n_columns;
  Column       *column;
  PetscInt      n_keys, *key; /* pairs i n_lines + j that share a cell, ascending */
  ColumnBlocks *stiffness, *damping;
} ColumnSection;

/* Line and node along it of each local node, -1 of nodes elsewhere */
static PetscErrorCode ColumnsFindVertices(const SweptBody *s, PetscInt n_vertices, PetscInt line[], PetscInt node[])
{
  const ModelLines *lines = s->lines;

  PetscFunctionBeginUser;
  for (PetscInt v = 0; v < n_vertices; v++) line[v] = node[v] = -1;
  for (PetscInt i = 0; i < lines->n_lines * lines->n_nodes; i++) {
    line[lines->vertex[i]] = i / lines->n_nodes;
    node[lines->vertex[i]] = i % lines->n_nodes;
  }
  PetscFunctionReturn(0);
}

/* Whether a cell lies between nodes 0 and 1 of four lines; then the lines and sides of its nodes */
static PetscBool ColumnBegins(PetscInt n_nodes, const PetscInt vertex[], const PetscInt line[], const PetscInt node[],
                              Column *column)
{
  PetscInt n_second = 0;

  if (n_nodes != 8) return PETSC_FALSE;
  for (PetscInt a = 0; a < 8; a++) {
    if (node[vertex[a]] != 0 && node[vertex[a]] != 1) return PETSC_FALSE;
    column->line[a]   = line[vertex[a]];
    column->second[a] = node[vertex[a]] == 1 ? PETSC_TRUE : PETSC_FALSE;
    n_second += column->second[a];
  }
  return n_second == 4 ? PETSC_TRUE : PETSC_FALSE;
}

/* The columns; `complete` is whether they hold all local cells of the body: n_columns times the cells along a line.
   One cell stands for its column, hence the material must not change along it either. */
static PetscErrorCode ColumnsFind(Bodies b, const SweptBody *s, ColumnSection *section, PetscBool *complete)
{
  const PetscInt n_along = s->lines->n_nodes - (s->lines->closed ? 0 : 1);
  PetscInt       n_own = 0, size = 0, *line, *node;

  PetscFunctionBeginUser;
  *complete = PETSC_TRUE;
  PetscCall(PetscMalloc2(b->layout.n_vertices, &line, b->layout.n_vertices, &node));
  PetscCall(ColumnsFindVertices(s, b->layout.n_vertices, line, node));
  for (PetscInt c = 0; c < b->mesh->n_cells; c++) {
    const PetscInt *vertex = &b->mesh->cell_node[b->mesh->cell_first[c]];
    Column          column;

    if (b->body[vertex[0]] != s->body) continue;
    n_own++;
    if (!ModelMaterialIsSwept(b->model, b->mesh->cell_part[c], s->lines)) *complete = PETSC_FALSE;
    if (!ColumnBegins(b->mesh->element[c]->n_nodes, vertex, line, node, &column)) continue;
    if (section->n_columns == size) {
      size = 2 * size + 16;
      PetscCall(PetscRealloc((size_t)size * sizeof(Column), &section->column));
    }
    column.cell                           = c;
    section->column[section->n_columns++] = column;
  }
  if (n_own != section->n_columns * n_along) *complete = PETSC_FALSE;
  PetscCall(PetscFree2(line, node));
  PetscFunctionReturn(0);
}

/* Pairs of lines that share a column, and room for their blocks: 64 pairs of nodes a cell, ascending without
   repetition, so that neighbours of a line follow one another. */
static PetscErrorCode SectionFindKeys(PetscInt n_lines, ColumnSection *section)
{
  PetscFunctionBeginUser;
  section->n_keys = 64 * section->n_columns;
  PetscCall(PetscMalloc1(section->n_keys, &section->key));
  for (PetscInt i = 0; i < section->n_keys; i++) {
    const Column *column = &section->column[i / 64];

    section->key[i] = column->line[i / 8 % 8] * n_lines + column->line[i % 8];
  }
  PetscCall(PetscSortRemoveDupsInt(&section->n_keys, section->key));
  PetscCall(PetscCalloc2(section->n_keys, &section->stiffness, section->n_keys, &section->damping));
  PetscFunctionReturn(0);
}

/* Adds the block of nodes a and b = pair / 8, pair % 8 of a column's cell, scaled; pqc [3] places of p, q, c among the
   components */
static void ColumnAddBlock(const Column *column, const BodiesCell *cell, PetscInt pair, const PetscInt pqc[3],
                           PetscReal scale, ColumnBlocks *blocks)
{
  const PetscInt a = pair / 8, b = pair % 8;
  PetscReal     *sum = column->second[a] ? (column->second[b] ? blocks->before : blocks->down)
                                         : (column->second[b] ? blocks->up : blocks->after);

  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) sum[3 * i + j] += scale * cell->stiffness[24 * (3 * a + pqc[i]) + 3 * b + pqc[j]];
}

/* Sums the cells, of which one at a time is in memory */
static PetscErrorCode ColumnSectionSum(Bodies b, const SweptBody *s, ColumnSection *section)
{
  const PetscInt pqc[3] = {(s->along + 1) % 3, (s->along + 2) % 3, s->along};

  PetscFunctionBeginUser;
  for (PetscInt c = 0; c < section->n_columns; c++) {
    Column    *column = &section->column[c];
    BodiesCell cell;

    PetscCall(BodiesGetCell(b, column->cell, &cell));
    BodiesTurnCell(&b->layout, &cell);
    column->alpha = cell.alpha;
    column->beta  = cell.beta;
    PetscCall(PetscArraycpy(column->mass, cell.mass, 8));
    for (PetscInt i = 0; i < 64; i++) {
      PetscInt k;

      PetscCall(
        PetscFindInt(column->line[i / 8] * s->lines->n_lines + column->line[i % 8], section->n_keys, section->key, &k));
      ColumnAddBlock(column, &cell, i, pqc, 1, &section->stiffness[k]);
      ColumnAddBlock(column, &cell, i, pqc, cell.beta, &section->damping[k]);
    }
  }
  PetscFunctionReturn(0);
}

/* Whether the blocks of the one side are those of the other, mirrored in the plane across the sweep: x = S y S, S =
   diag(1, 1, -1) in the components p, q, c */
static PetscBool ColumnBlocksMirror(const PetscReal x[9], const PetscReal y[9], PetscReal scale)
{
  for (int i = 0; i < 9; i++) {
    const PetscReal sign = (i / 3 == 2) == (i % 3 == 2) ? 1 : -1;

    if (PetscAbsReal(x[i] - sign * y[i]) > MIRROR_TOLERANCE * scale) return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

static PetscBool ColumnSectionMirrors(const ColumnSection *section)
{
  PetscReal scale = 0;

  for (PetscInt k = 0; k < section->n_keys; k++)
    for (int i = 0; i < 9; i++) scale = PetscMax(scale, PetscAbsReal(section->stiffness[k].after[i]));
  for (PetscInt k = 0; k < section->n_keys; k++) {
    const ColumnBlocks *blocks = &section->stiffness[k];

    if (!ColumnBlocksMirror(blocks->before, blocks->after, scale) ||
        !ColumnBlocksMirror(blocks->down, blocks->up, scale))
      return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

/* E0 = A0 after + before, E1 = (A+ + A-) / 2 on the even entries, O1 = (A+ - A-) / 2 on the odd ones: 14 numbers
   for the 27 of three blocks, the others vanishing by the mirror symmetry */
static void SweptSetCoefficients(const ColumnBlocks *blocks, double c[STENCIL_COEFFICIENTS], double before[9])
{
  static const int even[5] = {0, 1, 3, 4, 8}, odd[4] = {2, 5, 6, 7};

  for (int i = 0; i < 5; i++) {
    c[i]     = blocks->after[even[i]] + blocks->before[even[i]];
    c[5 + i] = 0.5 * (blocks->up[even[i]] + blocks->down[even[i]]);
  }
  for (int i = 0; i < 4; i++) c[10 + i] = 0.5 * (blocks->up[odd[i]] - blocks->down[odd[i]]);
  for (int i = 0; i < 9; i++) before[i] = blocks->before[3 * (i % 3) + i / 3];
}

/* The neighbours of the lines, in the order of the keys; coefficients [2 n]: those of the stiffness, then those of
   the damping. */
static PetscErrorCode SweptSetLines(SweptBody *s, const ColumnSection *section)
{
  const PetscInt n_lines = s->lines->n_lines, n = section->n_keys;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc2(n_lines, &s->stiffness, n_lines, &s->damping));
  PetscCall(PetscMalloc3(n, &s->at, 2 * n, &s->coefficient, 2 * n + 1, &s->before));
  for (PetscInt k = 0; k < n; k++) {
    const PetscInt i = section->key[k] / n_lines, j = section->key[k] % n_lines;

    s->at[k] = 3 * (ptrdiff_t)j * s->stride;
    SweptSetCoefficients(&section->stiffness[k], s->coefficient[k], s->before[k]);
    SweptSetCoefficients(&section->damping[k], s->coefficient[n + k], s->before[n + k]);
    if (!s->stiffness[i].n++) {
      s->stiffness[i].at          = &s->at[k];
      s->stiffness[i].coefficient = (const double(*)[STENCIL_COEFFICIENTS]) & s->coefficient[k];
      s->stiffness[i].before      = (const double(*)[9]) & s->before[k];
    }
  }
  PetscFunctionReturn(0);
}

/* Makes the damping of a line a stencil of its own, whose coefficients follow all those of the stiffness */
static void SweptDampLine(SweptBody *s, PetscInt n_keys, PetscInt l)
{
  s->damping[l] = s->stiffness[l];
  s->damping[l].coefficient += n_keys;
  s->damping[l].before += n_keys;
}

/* Masses of the nodes (kg), and damping factors of the lines: alpha (1/s) weighted by mass, beta (s) where all
   cells have the same. The ends of an open line have the masses of one side alone. */
static PetscErrorCode SweptSetMasses(SweptBody *s, const ColumnSection *section)
{
  const PetscInt n_lines = s->lines->n_lines, last = s->lines->n_nodes - 1;
  PetscReal     *whole;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(n_lines, &whole));
  PetscCall(PetscCalloc3(n_lines, &s->beta, n_lines, &s->alpha, n_lines * s->stride, &s->mass));
  for (PetscInt l = 0; l < n_lines; l++) s->beta[l] = -1;
  for (PetscInt i = 0; i < 8 * section->n_columns; i++) {
    const Column   *column = &section->column[i / 8];
    const PetscInt  l      = column->line[i % 8];
    const PetscReal mass = column->mass[i % 8], beta = column->beta;
    PetscReal      *row = &s->mass[l * s->stride];

    whole[l] += mass;
    s->alpha[l] += mass * column->alpha;
    for (PetscInt k = 0; k <= last; k++)
      if (s->lines->closed || k != (column->second[i % 8] ? 0 : last)) row[k] += mass;
    if (s->beta[l] >= 0 && s->beta[l] != beta) SweptDampLine(s, section->n_keys, l);
    s->beta[l] = beta;
  }
  for (PetscInt l = 0; l < n_lines; l++) s->alpha[l] /= whole[l];
  PetscCall(PetscFree(whole));
  PetscFunctionReturn(0);
}

PetscErrorCode SweptSetUp(Bodies b, SweptBody *s, PetscBool *mirrored)
{
  ColumnSection section = {0};

  PetscFunctionBeginUser;
  PetscCall(ColumnsFind(b, s, &section, mirrored));
  if (*mirrored) {
    PetscCall(SectionFindKeys(s->lines->n_lines, &section));
    PetscCall(ColumnSectionSum(b, s, &section));
    *mirrored = ColumnSectionMirrors(&section);
  }
  if (*mirrored) {
    PetscCall(SweptSetLines(s, &section));
    PetscCall(SweptSetMasses(s, &section));
  }
  PetscCall(PetscFree(section.column));
  PetscCall(PetscFree(section.key));
  PetscCall(PetscFree2(section.stiffness, section.damping));
  PetscFunctionReturn(0);
}
