/*
   Unit test of ModelKeepSlabs(): each rank has whole slabs of swept bodies in one row, and the same cost as the others.

   References: the disc has 160 slabs of 64 cells by construction, pad and beam 2000 cells; costs of cells are 2 about
   an axis, 3 along one and 8 else (slabs.c), so that at best ranks differ by less than one slab.
*/
#include "boxes.h"
#include "check.h"
#include "petscmain.h"

#define N_SLABS      160
#define CELLS        64 /* of a slab */
#define MATERIALS    "-disc_young 1 -disc_density 1 -pad_young 1 -pad_density 1 -beam_young 1 -beam_density 1 "
#define RIG          MATERIALS "-model_source rig -rig_beam_elements 10 "
#define AXISYMMETRIC RIG "-rig_disc_mesh axisymmetric "

static PetscErrorCode RigCreateModel(const char scene[], Model *model)
{
  PetscFunctionBeginUser;
  PetscCall(PetscOptionsClear(NULL));
  PetscCall(PetscOptionsInsertString(NULL, scene));
  PetscCall(ModelCreate(PETSC_COMM_WORLD, model));
  PetscCall(ModelSetFromOptions(*model));
  if (strstr(scene, "-rig_pad 0") == NULL) PetscCall(ModelKeepTogether(*model, "pad_face")); /* must not matter */
  PetscCall(ModelKeepTogether(*model, "disc_face"));
  PetscCall(ModelKeepSlabs(*model));
  PetscCall(ModelSetUp(*model));
  PetscFunctionReturn(0);
}

/* Local cells of the disc in each slab, count [N_SLABS], and all others */
static PetscErrorCode CountCells(Model model, PetscInt count[], PetscInt *n_disc, PetscInt *n_others)
{
  const Mesh    *mesh;
  const Element *element;
  PetscInt       vertices[ELEMENT_MAX_NODES];
  PetscReal      x[ELEMENT_MAX_DOFS];

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < N_SLABS; k++) count[k] = 0;
  *n_disc = *n_others = 0;
  PetscCall(ModelGetMesh(model, &mesh));
  for (PetscInt c = 0; c < mesh->n_cells; c++) {
    PetscReal centre[2] = {0, 0}, turns;

    if (mesh->cell_part[c] > 0) {
      ++*n_others;
      continue;
    }
    ++*n_disc;
    PetscCall(ModelGetCell(model, c, &element, vertices, x));
    for (int i = 0; i < 8; i++)
      for (int d = 0; d < 2; d++) centre[d] += x[3 * i + d];
    turns = atan2(centre[1], centre[0]) / (2 * PETSC_PI);
    count[(PetscInt)((turns < 0 ? turns + 1 : turns) * N_SLABS)]++;
  }
  PetscFunctionReturn(0);
}

/* Cost of pad and beam: of their cells, and of the pairs of the 100 cells of the pad at the contact, 28 each */
#define COST_OTHERS (3 * 2000 + 28 * 100)

/* Largest cost of a rank over the mean, less 1 */
static PetscReal Imbalance(PetscReal cost, PetscMPIInt size)
{
  PetscReal sum = -1, most = -1;

  if (MPI_Allreduce(&cost, &sum, 1, MPIU_REAL, MPI_SUM, PETSC_COMM_WORLD)) return -1;
  if (MPI_Allreduce(&cost, &most, 1, MPIU_REAL, MPI_MAX, PETSC_COMM_WORLD)) return -1;
  return most * size / sum - 1;
}

/* Breaks when: a slab is cut, the slabs of a rank are not in one row, pad and beam are cut, they are on another rank
   than the disc under them, their cost is forgotten, or the partition changes from run to run */
static PetscErrorCode TestRing(PetscMPIInt size, int *failed)
{
  PetscInt  count[N_SLABS], again[N_SLABS], n_disc, n_others, n_rows = 0, n_cut = 0, before = 0, after = 0;
  PetscBool same;
  Model     model;

  PetscFunctionBeginUser;
  for (int run = 0; run < 2; run++) {
    PetscCall(RigCreateModel(AXISYMMETRIC, &model));
    PetscCall(CountCells(model, run ? again : count, &n_disc, &n_others));
    PetscCall(ModelDestroy(&model));
  }
  PetscCall(PetscArraycmp(count, again, N_SLABS, &same));
  for (PetscInt k = 0; k < N_SLABS; k++) {
    n_cut += count[k] != 0 && count[k] != CELLS;
    n_rows += count[k] && !count[(k + 1) % N_SLABS];
  }
  while (before < N_SLABS && count[N_SLABS - 1 - before]) before++;
  while (after < N_SLABS && count[after]) after++;
  *failed += CheckTrue("ring: the same partition again", same, same);
  *failed += CheckClose("ring: slabs that are cut", (double)n_cut, 0, 0);
  *failed += CheckClose("ring: rows of slabs", (double)n_rows, size > 1, 0);
  *failed += CheckTrue("ring: pad and beam on one rank", n_others == 0 || n_others == 2000, (double)n_others);
  if (n_others)
    *failed += CheckTrue("ring: slabs to both sides of the pad", after && PetscAbsInt(before - after) <= 1, after);
  *failed +=
    CheckClose("ring: imbalance of the cost", Imbalance((PetscReal)(2 * n_disc + (n_others ? COST_OTHERS : 0)), size),
               0, 2.0 * CELLS * size / (2 * N_SLABS * CELLS + COST_OTHERS));
  *failed += CheckTrue("ring: imbalance of the cost at most 2 %",
                       Imbalance((PetscReal)(2 * n_disc + (n_others ? COST_OTHERS : 0)), size) < 0.02, size);
  PetscFunctionReturn(0);
}

/* Breaks when: the slab between the last node of the lines and the first is taken for another. The disc alone: rows
   begin at angle 0, and a rank has a third or half of the slabs. */
static PetscErrorCode TestAlone(PetscMPIInt size, int *failed)
{
  PetscInt count[N_SLABS], n_disc, n_others, n_cut = 0;
  Model    model;

  PetscFunctionBeginUser;
  PetscCall(RigCreateModel(AXISYMMETRIC "-rig_pad 0 -parts disc ", &model));
  PetscCall(CountCells(model, count, &n_disc, &n_others));
  PetscCall(ModelDestroy(&model));
  for (PetscInt k = 0; k < N_SLABS; k++) n_cut += count[k] != 0 && count[k] != CELLS;
  *failed += CheckClose("alone: slabs that are cut", (double)n_cut, 0, 0);
  *failed += CheckClose("alone: slabs of a rank", (double)n_disc / CELLS, (double)N_SLABS / size, size == 3 ? 0.7 : 0);
  PetscFunctionReturn(0);
}

/* Breaks when: a body that is not swept is not cut, or its cost does not count; METIS may err by a few cells */
static PetscErrorCode TestPatch(PetscMPIInt size, int *failed)
{
  PetscInt count[N_SLABS], n_disc, n_others;
  Model    model;

  PetscFunctionBeginUser;
  PetscCall(RigCreateModel(RIG, &model));
  PetscCall(CountCells(model, count, &n_disc, &n_others));
  PetscCall(ModelDestroy(&model));
  *failed += CheckTrue("patch: pad and beam on one rank", n_others == 0 || n_others == 2000, (double)n_others);
  *failed += CheckTrue("patch: cells of the disc", n_disc > 0, (double)n_disc);
  *failed += CheckClose("patch: imbalance of the cost",
                        Imbalance((PetscReal)(8 * n_disc + (n_others ? COST_OTHERS : 0)), size), 0, 0.02);
  PetscFunctionReturn(0);
}

/* Breaks when: a body that is longer than a rank's share stays whole, or a whole one is not made up for. Two equal bars
   of 12 slabs along z: on 2 ranks one bar each, on 3 ranks 8 slabs each. */
static PetscErrorCode TestBars(PetscMPIInt size, int *failed)
{
  static const PetscReal x[] = {0, 1, 3}, far[] = {5, 6, 8}, y[] = {0, 2, 3},
                         z[] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12};
  const Box box[] = {{.name = "a", .n = {3, 3, 13}, .x = {x, y, z}}, {.name = "b", .n = {3, 3, 13}, .x = {far, y, z}}};
  char      path[PETSC_MAX_PATH_LEN];
  PetscInt  n_bodies, n_here = 0, *body;
  const Mesh *mesh;
  Model       model;
  ModelLines *lines;

  PetscFunctionBeginUser;
  PetscCall(BoxesWrite(PETSC_COMM_WORLD, 2, box, path));
  PetscCall(PetscOptionsClear(NULL));
  PetscCall(PetscOptionsInsertString(NULL, "-parts a,b -a_young 1 -a_density 1 -b_young 1 -b_density 1"));
  PetscCall(PetscOptionsSetValue(NULL, "-model_mesh", path));
  PetscCall(ModelCreate(PETSC_COMM_WORLD, &model));
  PetscCall(ModelSetFromOptions(model));
  PetscCall(ModelKeepSlabs(model));
  PetscCall(ModelSetUp(model));
  PetscCall(BoxesRemove(PETSC_COMM_WORLD, path));
  PetscCall(ModelGetMesh(model, &mesh));
  PetscCall(ModelGetBodies(model, &n_bodies, &body));
  for (PetscInt b = 0; b < n_bodies; b++) {
    PetscCall(ModelCreateLines(model, b, body, &lines));
    n_here += lines ? 4 * (lines->n_nodes - 1) : 0;
    PetscCall(ModelDestroyLines(&lines));
  }
  *failed += CheckClose("bars: cells of a rank", (double)mesh->n_cells, 96.0 / size, 0);
  *failed += CheckClose("bars: cells of the lines of a rank", (double)n_here, 96.0 / size, 0);
  PetscCall(PetscFree(body));
  PetscCall(ModelDestroy(&model));
  PetscFunctionReturn(0);
}

static PetscErrorCode Tests(PetscMPIInt size, int *failed)
{
  PetscFunctionBeginUser;
  PetscCall(TestRing(size, failed));
  PetscCall(TestAlone(size, failed));
  PetscCall(TestPatch(size, failed));
  PetscCall(TestBars(size, failed));
  PetscFunctionReturn(0);
}

int main(int argc, char **argv)
{
  return PetscMain(argc, argv, Tests);
}
