/* Boxes of second order in a Gmsh file, for unit tests: hex27, or each hexahedron cut into six tet10 */
#pragma once

#include <petscsys.h>
#include <stdio.h>

typedef struct {
  const char *name;
  int         n[3]; /* hexahedra */
  double      low[3], high[3];
} GridBox;

/* Corners of a hexahedron in half steps, and its other nodes as the middles of these corners, in Gmsh's order */
static const int grid_corner[8][3] = {
  {0, 0, 0},
  {2, 0, 0},
  {2, 2, 0},
  {0, 2, 0},
  {0, 0, 2},
  {2, 0, 2},
  {2, 2, 2},
  {0, 2, 2}
};
static const char *const grid_hex27[]    = {"0",  "1",  "2",  "3",  "4",  "5",  "6",  "7",  "01", "03",
                                            "04", "12", "15", "23", "26", "37", "45", "47", "56", "67",
                                            "02", "05", "07", "16", "27", "46", "06", NULL};
static const char *const grid_tet10[]    = {"0", "1", "2", "3", "01", "12", "02", "03", "23", "13", NULL};
static const char *const grid_cell[2][7] = {
  {"01234567"},
  { "0126", "0236", "0376", "0746", "0456", "0516"}
};
static const char *const grid_face[2][2][3] = {
  {{"0321"},       {"4567"}      },
  {{"021", "032"}, {"456", "467"}}
}; /* bottom, top */

/* Number of a node of a box at half steps from the cell, `from` of its middle of corners */
static inline int GridNode(const GridBox *b, int first, const int cell[3], const char cut[], const char *middle)
{
  const int *p = grid_corner[cut[middle[0] - '0'] - '0'], *q = middle[1] ? grid_corner[cut[middle[1] - '0'] - '0'] : p;
  int        at[3];

  for (int d = 0; d < 3; d++) at[d] = 2 * cell[d] + (p[d] + q[d]) / 2;
  return first + at[0] + (2 * b->n[0] + 1) * (at[1] + (2 * b->n[1] + 1) * at[2]);
}

static inline int GridCount(const GridBox *b)
{
  return (2 * b->n[0] + 1) * (2 * b->n[1] + 1) * (2 * b->n[2] + 1);
}

/* Cells and, of the first and last layer, faces of one box; counts them where file is NULL */
static inline void GridWriteCells(FILE *file, int tetrahedra, const GridBox *b, int group, int first, int *count)
{
  const char *const *nodes = tetrahedra ? grid_tet10 : grid_hex27;

  for (int c = 0; c < b->n[0] * b->n[1] * b->n[2]; c++) {
    const int cell[3] = {c % b->n[0], c / b->n[0] % b->n[1], c / b->n[0] / b->n[1]};

    for (const char *const *cut = grid_cell[tetrahedra]; *cut; cut++) {
      ++*count;
      if (file) fprintf(file, "%d %d 2 %d %d", *count, tetrahedra ? 11 : 12, group, group);
      for (const char *const *i = nodes; *i && file; i++) fprintf(file, " %d", GridNode(b, first, cell, *cut, *i));
      if (file) fprintf(file, "\n");
    }
    for (int top = 0; top < 2; top++)
      for (const char *const *cut = grid_face[tetrahedra][top]; *cut && cell[2] == (top ? b->n[2] - 1 : 0); cut++) {
        ++*count;
        if (file) fprintf(file, "%d %d 2 %d %d", *count, tetrahedra ? 2 : 3, group + 1 + top, group + 1 + top);
        for (int i = 0; (*cut)[i] && file; i++)
          fprintf(file, " %d", GridNode(b, first, cell, *cut, (const char[]){(char)('0' + i), 0}));
        if (file) fprintf(file, "\n");
      }
  }
}

/* The file, written by the first rank: volumes `name`, surfaces `name`_bottom and `name`_top */
static inline PetscErrorCode GridWriteFile(const char path[], int tetrahedra, int n, const GridBox box[])
{
  FILE    *file;
  PetscInt n_nodes = 0;
  int      count   = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscFOpen(PETSC_COMM_WORLD, path, "w", &file));
  if (file) {
    fprintf(file, "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n%d\n", 3 * n);
    for (int i = 0; i < 3 * n; i++)
      fprintf(file, "%d %d \"%s%s\"\n", i % 3 ? 2 : 3, i + 1, box[i / 3].name,
              i % 3 == 0   ? ""
              : i % 3 == 1 ? "_bottom"
                           : "_top");
    for (int i = 0; i < n; i++) n_nodes += GridCount(&box[i]);
    fprintf(file, "$EndPhysicalNames\n$Nodes\n%d\n", (int)n_nodes);
    for (int i = 0, first = 1; i < n; first += GridCount(&box[i++]))
      for (int v = 0; v < GridCount(&box[i]); v++) {
        const int at[3] = {v % (2 * box[i].n[0] + 1), v / (2 * box[i].n[0] + 1) % (2 * box[i].n[1] + 1),
                           v / (2 * box[i].n[0] + 1) / (2 * box[i].n[1] + 1)};

        fprintf(file, "%d", first + v);
        for (int d = 0; d < 3; d++)
          fprintf(file, " %.17g", box[i].low[d] + (box[i].high[d] - box[i].low[d]) * at[d] / (2 * box[i].n[d]));
        fprintf(file, "\n");
      }
    for (int i = 0; i < n; i++) GridWriteCells(NULL, tetrahedra, &box[i], 1, 1, &count);
    fprintf(file, "$EndNodes\n$Elements\n%d\n", count);
    count = 0;
    for (int i = 0, first = 1; i < n; first += GridCount(&box[i++]))
      GridWriteCells(file, tetrahedra, &box[i], 3 * i + 1, first, &count);
    fprintf(file, "$EndElements\n");
  }
  PetscCall(PetscFClose(PETSC_COMM_WORLD, file));
  PetscCallMPI(MPI_Barrier(PETSC_COMM_WORLD));
  PetscFunctionReturn(0);
}
