/*
   The built-in rig: a ring-shaped disc, a block-shaped pad on its face z = 0, and a beam glued on the pad.

   Two structured grids of hexahedra: the disc (ring, column, layer), periodic in the columns, and the block of pad
   and beam (x, y, z). They share no vertex; with the patch mesh of the disc the pad's lower nodes coincide with
   nodes of the disc's face, with the axisymmetric one they do not. Lengths in m.
*/
#include "model/modelimpl.h"
#include "kernels/discgrid.h"

/* Structured grid: node (i, j, k) is vertex first_node + i + nodes[0] (j mod nodes[1] + nodes[1] k) */
typedef struct {
  PetscInt cells[3], nodes[3];
  PetscInt first_cell, first_node;
} StructuredGrid;

static PetscInt StructuredGridNode(const StructuredGrid *g, const PetscInt at[3])
{
  return g->first_node + at[0] + g->nodes[0] * (at[1] % g->nodes[1] + g->nodes[1] * at[2]);
}

static PetscInt StructuredGridCountCells(const StructuredGrid *g)
{
  return g->cells[0] * g->cells[1] * g->cells[2];
}

static PetscInt StructuredGridCountNodes(const StructuredGrid *g)
{
  return g->nodes[0] * g->nodes[1] * g->nodes[2];
}

/* Node levels 0..beam_nz of the two spring rows: the nearest ones that may be moved there; the end levels stay */
static PetscErrorCode RigRowLevels(MPI_Comm comm, const Rig *rig, PetscInt level[2])
{
  const PetscInt last = rig->beam_nz - 1;

  PetscFunctionBeginUser;
  for (PetscInt r = 0; r < 2; r++) {
    level[r] = (PetscInt)PetscFloorReal(rig->beam_rows[r] / rig->beam_height * rig->beam_nz + 0.5);
    level[r] = PetscMax(1, PetscMin(last, level[r]));
  }
  if (level[0] == level[1]) level[level[1] < last ? 1 : 0] += level[1] < last ? 1 : -1;
  if (rig->beam_rows[0] <= 0) level[0] = 0;
  if (rig->beam_rows[1] >= rig->beam_height) level[1] = rig->beam_nz;
  PetscCheck((level[0] > 0 || rig->beam_rows[0] <= 0) && level[1] > level[0] &&
               (level[1] <= last || rig->beam_rows[1] >= rig->beam_height),
             comm, PETSC_ERR_USER_INPUT,
             "Option -rig_beam_elements %" PetscInt_FMT
             " has too few node levels for -rig_beam_rows %.6g,%.6g: 3 always suffice",
             rig->beam_nz, (double)rig->beam_rows[0], (double)rig->beam_rows[1]);
  PetscFunctionReturn(0);
}

/* The grids of the disc and of the block of pad and beam (empty without a pad) */
static void RigGrids(const Rig *rig, StructuredGrid *disc, StructuredGrid *block)
{
  *disc  = (StructuredGrid){.cells = {rig->disc_nr, rig->disc_ntheta, rig->disc_nz},
                            .nodes = {rig->disc_nr + 1, rig->disc_ntheta, rig->disc_nz + 1}};
  *block = (StructuredGrid){.first_cell = StructuredGridCountCells(disc), .first_node = StructuredGridCountNodes(disc)};
  if (!rig->with_pad) return;
  for (PetscInt d = 0; d < 3; d++) {
    block->cells[d] = rig->pad_n[d] + (d == 2 ? rig->beam_nz : 0);
    block->nodes[d] = block->cells[d] + 1;
  }
}

/* Corners of the cells [cells][8] in the order of DMPlex */
static PetscErrorCode StructuredGridFillCells(const StructuredGrid *g, PetscInt cells[])
{
  static const PetscInt corner[8][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                                        {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
  const PetscInt        n            = StructuredGridCountCells(g);

  PetscFunctionBeginUser;
  for (PetscInt c = 0; c < n; c++) {
    PetscInt *cell = cells + 8 * (g->first_cell + c);

    for (PetscInt v = 0; v < 8; v++) {
      const PetscInt at[3] = {c % g->cells[0] + corner[v][0], c / g->cells[0] % g->cells[1] + corner[v][1],
                              c / (g->cells[0] * g->cells[1]) + corner[v][2]};
      cell[v]              = StructuredGridNode(g, at);
    }
    PetscCall(DMPlexInvertCell(DM_POLYTOPE_HEXAHEDRON, cell));
  }
  PetscFunctionReturn(0);
}

/* Coordinates [nodes][3] (m) of the disc: the plane grid on nz + 1 levels, the uppermost at z = 0 */
static void DiscFillNodes(const Rig *rig, const StructuredGrid *g, PetscReal x[])
{
  DiscGrid plane = {.inner  = rig->disc_inner,
                    .outer  = rig->disc_outer,
                    .nr     = (int)rig->disc_nr,
                    .ntheta = (int)rig->disc_ntheta,
                    .patch  = rig->patch,
                    .centre = rig->pad_radius,
                    .size   = {rig->pad_size[0], rig->pad_size[1]},
                    .spread = rig->disc_spread,
                    .nx     = (int)rig->pad_n[0],
                    .ny     = (int)rig->pad_n[1]};

  if (rig->patch) DiscGridGrade(&plane);
  for (PetscInt j = 0; j < g->nodes[1]; j++) {
    for (PetscInt i = 0; i < g->nodes[0]; i++) {
      double xy[2];

      DiscGridNode(&plane, (int)i, (int)j, xy);
      for (PetscInt k = 0; k < g->nodes[2]; k++) {
        PetscReal *node = x + 3 * StructuredGridNode(g, (PetscInt[]){i, j, k});

        node[0] = xy[0];
        node[1] = xy[1];
        node[2] = rig->disc_thickness * (k - g->cells[2]) / g->cells[2];
      }
    }
  }
}

/* Coordinates [nodes][3] (m) of pad and beam: uniform but for the beam's two levels of spring rows */
static void BlockFillNodes(const Rig *rig, const StructuredGrid *g, const PetscInt level[2], PetscReal x[])
{
  for (PetscInt k = 0; k < g->nodes[2]; k++) {
    const PetscInt up = k - rig->pad_n[2];
    PetscReal      z =
      up < 0 ? rig->pad_size[2] * k / rig->pad_n[2] : rig->pad_size[2] + rig->beam_height * up / rig->beam_nz;

    for (PetscInt r = 0; r < 2; r++) z = level[r] == up ? rig->pad_size[2] + rig->beam_rows[r] : z;
    for (PetscInt j = 0; j < g->nodes[1]; j++) {
      for (PetscInt i = 0; i < g->nodes[0]; i++) {
        PetscReal *node = x + 3 * StructuredGridNode(g, (PetscInt[]){i, j, k});

        node[0] = DiscPatchNode(rig->pad_radius, rig->pad_size[0], i - 0.5 * rig->pad_n[0], (int)rig->pad_n[0]);
        node[1] = DiscPatchNode(0, rig->pad_size[1], j - 0.5 * rig->pad_n[1], (int)rig->pad_n[1]);
        node[2] = z;
      }
    }
  }
}

/* Marks n cells from `first` with a label */
static PetscErrorCode LabelCells(DM dm, const char name[], PetscInt first, PetscInt n)
{
  DMLabel label;

  PetscFunctionBeginUser;
  PetscCall(DMGetLabel(dm, name, &label));
  for (PetscInt c = first; c < first + n; c++) PetscCall(DMLabelSetValue(label, c, 1));
  PetscFunctionReturn(0);
}

/* Marks the faces between nodes of equal index `at` along an axis of the grid */
static PetscErrorCode LabelSide(DM dm, const char name[], const StructuredGrid *g, PetscInt axis, PetscInt at)
{
  const PetscInt a = (axis + 1) % 3, b = (axis + 2) % 3, around[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  PetscInt       vStart;
  DMLabel        label;

  PetscFunctionBeginUser;
  PetscCall(DMGetLabel(dm, name, &label));
  PetscCall(DMPlexGetDepthStratum(dm, 0, &vStart, NULL));
  for (PetscInt f = 0; f < g->cells[a] * g->cells[b]; f++) {
    PetscInt        corners[4], n_faces, node[3];
    const PetscInt *face;

    node[axis] = at;
    for (PetscInt v = 0; v < 4; v++) {
      node[a]    = f % g->cells[a] + around[v][0];
      node[b]    = f / g->cells[a] + around[v][1];
      corners[v] = vStart + StructuredGridNode(g, node);
    }
    PetscCall(DMPlexGetFullJoin(dm, 4, corners, &n_faces, &face));
    PetscCheck(n_faces == 1, PETSC_COMM_SELF, PETSC_ERR_PLIB, "%" PetscInt_FMT " faces join four nodes of %s", n_faces,
               name);
    PetscCall(DMLabelSetValue(label, face[0], 1));
    PetscCall(DMPlexRestoreJoin(dm, 4, corners, &n_faces, &face));
  }
  PetscFunctionReturn(0);
}

/* Marks the nodes of the beam's two faces y = const on the levels of the spring rows */
static PetscErrorCode LabelRows(DM dm, const char name[], const Rig *rig, const StructuredGrid *g,
                                const PetscInt level[2])
{
  PetscInt vStart;
  DMLabel  label;

  PetscFunctionBeginUser;
  PetscCall(DMGetLabel(dm, name, &label));
  PetscCall(DMPlexGetDepthStratum(dm, 0, &vStart, NULL));
  for (PetscInt row = 0; row < 4; row++) {
    for (PetscInt i = 0; i < g->nodes[0]; i++) {
      const PetscInt at[3] = {i, row % 2 ? g->cells[1] : 0, rig->pad_n[2] + level[row / 2]};

      PetscCall(DMLabelSetValue(label, vStart + StructuredGridNode(g, at), 1));
    }
  }
  PetscFunctionReturn(0);
}

/* Creates the named sets on every rank; rank 0, which holds the mesh, fills them */
static PetscErrorCode RigLabel(DM dm, const Rig *rig, const StructuredGrid *disc, const StructuredGrid *block,
                               const PetscInt level[2])
{
  const char *const names[] = {"disc", "disc_inner", "disc_face", "pad", "beam", "pad_face", "beam_top", "beam_rows"};
  const PetscInt    n_names = rig->with_pad ? PETSC_STATIC_ARRAY_LENGTH(names) : 3,
                 layer      = block->cells[0] * block->cells[1];
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < n_names; i++) PetscCall(DMCreateLabel(dm, names[i]));
  PetscCallMPI(MPI_Comm_rank(PetscObjectComm((PetscObject)dm), &rank));
  if (rank) PetscFunctionReturn(0);
  PetscCall(LabelCells(dm, "disc", 0, StructuredGridCountCells(disc)));
  PetscCall(LabelSide(dm, "disc_inner", disc, 0, 0));
  PetscCall(LabelSide(dm, "disc_face", disc, 2, disc->cells[2]));
  if (!rig->with_pad) PetscFunctionReturn(0);
  PetscCall(LabelCells(dm, "pad", block->first_cell, layer * rig->pad_n[2]));
  PetscCall(LabelCells(dm, "beam", block->first_cell + layer * rig->pad_n[2], layer * rig->beam_nz));
  PetscCall(LabelSide(dm, "pad_face", block, 2, 0));
  PetscCall(LabelSide(dm, "beam_top", block, 2, block->cells[2]));
  PetscCall(LabelRows(dm, "beam_rows", rig, block, level));
  PetscFunctionReturn(0);
}

/*
   RigGenerate - the rig as an interpolated DMPlex, all of it on rank 0, with its sets as labels. Collective.

   Errors: PETSC_ERR_USER_INPUT when the beam has too few node levels for its spring rows.
*/
PetscErrorCode RigGenerate(MPI_Comm comm, const Rig *rig, DM *dm)
{
  StructuredGrid disc, block;
  PetscInt       level[2] = {0, 0}, n_cells, n_nodes, *cells = NULL;
  PetscReal     *x = NULL;
  PetscMPIInt    rank;

  PetscFunctionBeginUser;
  RigGrids(rig, &disc, &block);
  if (rig->with_pad) PetscCall(RigRowLevels(comm, rig, level));
  n_cells = StructuredGridCountCells(&disc) + StructuredGridCountCells(&block);
  n_nodes = StructuredGridCountNodes(&disc) + StructuredGridCountNodes(&block);
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  if (rank == 0) {
    PetscCall(PetscMalloc2(8 * n_cells, &cells, 3 * n_nodes, &x));
    PetscCall(StructuredGridFillCells(&disc, cells));
    PetscCall(StructuredGridFillCells(&block, cells));
    DiscFillNodes(rig, &disc, x);
    BlockFillNodes(rig, &block, level, x);
  }
  PetscCall(DMPlexCreateFromCellListPetsc(comm, 3, n_cells, n_nodes, 8, PETSC_TRUE, cells, 3, x, dm));
  PetscCall(PetscFree2(cells, x));
  PetscCall(RigLabel(*dm, rig, &disc, &block, level));
  PetscFunctionReturn(0);
}
