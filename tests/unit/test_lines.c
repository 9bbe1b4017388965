/*
   Unit test of ModelCreateLines(): which bodies are swept, about or along what, and where the nodes of the lines stand.

   References: the built-in axisymmetric disc has rings of 160 nodes at angles 2 pi k / 160 about z, the block of pad
   and beam eleven equally spaced nodes in x and in y and unequal ones in z; both by construction (-rig_*). On several
   ranks with whole slabs the arcs of all ranks make the ring.
*/
#include "boxes.h"
#include "check.h"
#include "petscmain.h"

#define MATERIALS                                                                                                      \
  "-disc_young 1 -disc_density 1 -pad_young 1 -pad_density 1 -beam_young 1 -beam_density 1 -model_source rig "
#define AXISYMMETRIC MATERIALS "-rig_disc_mesh axisymmetric -rig_beam_elements 20 -rig_beam_rows 0.0235,0.086 "
#define RING         MATERIALS "-rig_disc_mesh axisymmetric -rig_disc_elements 3,24,2 -rig_pad 0 -parts disc "

static PetscErrorCode RigCreateModel(const char scene[], Model *model)
{
  PetscFunctionBeginUser;
  PetscCall(PetscOptionsClear(NULL));
  PetscCall(PetscOptionsInsertString(NULL, scene));
  PetscCall(ModelCreate(PETSC_COMM_WORLD, model));
  PetscCall(ModelSetFromOptions(*model));
  PetscCall(ModelKeepSlabs(*model));
  PetscCall(ModelSetUp(*model));
  PetscFunctionReturn(0);
}

static PetscErrorCode LinesOfBody(Model model, PetscInt which, ModelLines **lines)
{
  PetscInt n_bodies, *body;

  PetscFunctionBeginUser;
  PetscCall(ModelGetBodies(model, &n_bodies, &body));
  PetscCall(ModelCreateLines(model, which, body, lines));
  PetscCall(PetscFree(body));
  PetscFunctionReturn(0);
}

/* Sum over the ranks */
static PetscInt Sum(PetscInt n)
{
  PetscInt sum = 0;

  return MPI_Allreduce(&n, &sum, 1, MPIU_INT, MPI_SUM, PETSC_COMM_WORLD) ? -1 : sum;
}

/* Coordinates of a point as its line has them: distance from the axis, height and angle, or the two across
   and that along */
static void Coordinates(const ModelLines *lines, const PetscReal x[3], PetscReal q[3])
{
  const int       a = (lines->axis + 1) % 3, b = (lines->axis + 2) % 3;
  const PetscReal u = x[a] - lines->centre[a], w = x[b] - lines->centre[b];

  q[0] = lines->turned ? hypot(u, w) : x[a];
  q[1] = lines->turned ? x[lines->axis] : x[b];
  q[2] = lines->turned ? atan2(w, u) : x[lines->axis];
}

/* Largest distance (m) of a node of the lines from where its line and number put it */
static PetscErrorCode LinesError(Model model, const ModelLines *lines, PetscReal *worst)
{
  const Mesh *mesh;

  PetscFunctionBeginUser;
  *worst = lines ? 0 : -1;
  PetscCall(ModelGetMesh(model, &mesh));
  for (PetscInt i = 0; lines && i < lines->n_lines * lines->n_nodes; i++) {
    const PetscInt k = i % lines->n_nodes;
    PetscReal      first[3], here[3], along;

    Coordinates(lines, &mesh->x[3 * lines->vertex[i - k]], first);
    Coordinates(lines, &mesh->x[3 * lines->vertex[i]], here);
    along = here[2] - lines->begin - lines->step * (PetscReal)k;
    if (lines->turned) along = here[0] * (along - 2 * PETSC_PI * round(along / (2 * PETSC_PI)));
    for (int d = 0; d < 2; d++) *worst = PetscMax(*worst, PetscAbsReal(here[d] - first[d]));
    *worst = PetscMax(*worst, PetscAbsReal(along));
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, worst, 1, MPIU_REAL, MPI_MAX, PETSC_COMM_WORLD));
  PetscFunctionReturn(0);
}

/* Number of cells of the lines' vertices that do not lie between nodes k and k + 1 of four lines, and the largest
   distance of two lines of one cell in their order */
static PetscErrorCode LinesCells(Model model, const ModelLines *lines, PetscInt *n_cells, PetscInt *n_wrong,
                                 PetscInt *apart)
{
  const Mesh *mesh;
  PetscInt   *place;

  PetscFunctionBeginUser;
  *n_cells = *n_wrong = *apart = 0;
  if (!lines) PetscFunctionReturn(0);
  PetscCall(ModelGetMesh(model, &mesh));
  PetscCall(PetscMalloc1(mesh->n_nodes, &place));
  for (PetscInt v = 0; v < mesh->n_nodes; v++) place[v] = -1;
  for (PetscInt i = 0; i < lines->n_lines * lines->n_nodes; i++) place[lines->vertex[i]] = i;
  for (PetscInt c = 0; c < mesh->n_cells; c++) {
    const Element *element;
    PetscInt       vertices[ELEMENT_MAX_NODES], k[2] = {-1, -1}, count[2] = {0, 0}, line[2] = {PETSC_MAX_INT, 0};
    PetscReal      x[ELEMENT_MAX_DOFS];

    PetscCall(ModelGetCell(model, c, &element, vertices, x));
    if (place[vertices[0]] < 0) continue;
    ++*n_cells;
    for (int i = 0; i < 8; i++) {
      const PetscInt at = place[vertices[i]], here = at % lines->n_nodes;

      for (int e = 0; e < 2; e++) {
        if (k[e] < 0) k[e] = here;
        if (k[e] != here) continue;
        count[e]++;
        break;
      }
      line[0] = PetscMin(line[0], at / lines->n_nodes);
      line[1] = PetscMax(line[1], at / lines->n_nodes);
    }
    *apart = PetscMax(*apart, line[1] - line[0]);
    *n_wrong += count[0] != 4 || count[1] != 4 ||
                (PetscAbsInt(k[0] - k[1]) != 1 && !(lines->closed && PetscAbsInt(k[0] - k[1]) == lines->n_nodes - 1));
  }
  PetscCall(PetscFree(place));
  PetscFunctionReturn(0);
}

/* Breaks when: lines miss nodes or take those of another line, angles begin or turn the wrong way, an arc is taken
   for a ring or begins within itself, or lines that share a cell are far from each other */
static PetscErrorCode TestDisc(Model model, PetscMPIInt size, int *failed)
{
  ModelLines *lines;
  PetscReal   worst;
  PetscInt    n_cells, n_wrong, apart, n_slabs;

  PetscFunctionBeginUser;
  PetscCall(LinesOfBody(model, 0, &lines));
  *failed += CheckClose("disc: ranks with lines", (double)Sum(lines ? 1 : 0), size, 0);
  PetscCall(LinesError(model, lines, &worst));
  PetscCall(LinesCells(model, lines, &n_cells, &n_wrong, &apart));
  *failed += CheckClose("disc: cells", (double)Sum(n_cells), 10240, 0);
  *failed += CheckClose("disc: cells that are not between their lines", (double)Sum(n_wrong), 0, 0);
  *failed += CheckClose("disc: worst place of a node, m", worst, 0, 1e-15);
  n_slabs = lines ? lines->n_nodes - (lines->closed ? 0 : 1) : 0;
  *failed += CheckClose("disc: slabs of all ranks", (double)Sum(n_slabs), 160, 0);
  if (lines) {
    *failed += CheckTrue("disc: turned about z", lines->turned && lines->axis == 2, lines->axis);
    *failed += CheckTrue("disc: closed on one rank only", (size == 1) == lines->closed, size);
    *failed += CheckClose("disc: lines", (double)lines->n_lines, 17 * 5, 0);
    *failed += CheckClose("disc: step, rad", lines->step, 2 * PETSC_PI / 160, 1e-14);
    *failed += CheckClose("disc: centre, m", PetscAbsReal(lines->centre[0]) + PetscAbsReal(lines->centre[1]), 0, 0);
    *failed += CheckTrue("disc: lines of a cell apart at most", apart <= 6, (double)apart);
  }
  PetscCall(ModelDestroyLines(&lines));
  PetscFunctionReturn(0);
}

/* Breaks when: the unequal levels in z count as lines, the shortest are taken, or pad and beam are two bodies */
static PetscErrorCode TestBlock(Model model, int *failed)
{
  ModelLines *lines;
  PetscReal   worst;
  PetscInt    n_cells, n_wrong, apart;

  PetscFunctionBeginUser;
  PetscCall(LinesOfBody(model, 1, &lines));
  PetscCall(LinesError(model, lines, &worst));
  PetscCall(LinesCells(model, lines, &n_cells, &n_wrong, &apart));
  *failed += CheckClose("block: ranks with lines", (double)Sum(lines ? 1 : 0), 1, 0);
  *failed += CheckClose("block: cells", (double)Sum(n_cells), 3000, 0);
  *failed += CheckClose("block: cells that are not between their lines", (double)Sum(n_wrong), 0, 0);
  *failed += CheckClose("block: worst place of a node, m", worst, 0, 1e-15);
  if (lines) {
    *failed += CheckTrue("block: along x", !lines->turned && lines->axis == 0 && !lines->closed, lines->axis);
    *failed += CheckClose("block: nodes of a line", (double)lines->n_nodes, 11, 0);
    *failed += CheckClose("block: lines", (double)lines->n_lines, 11 * 31, 0);
    *failed += CheckClose("block: begin, m", lines->begin, 0.105, 1e-15);
    *failed += CheckClose("block: step, m", lines->step, 0.001, 1e-15);
    *failed += CheckTrue("block: lines of a cell apart at most", apart <= 12, (double)apart);
  }
  PetscCall(ModelDestroyLines(&lines));
  PetscFunctionReturn(0);
}

static PetscErrorCode TestRig(PetscMPIInt size, int *failed)
{
  Model model;

  PetscFunctionBeginUser;
  PetscCall(RigCreateModel(AXISYMMETRIC, &model));
  PetscCall(TestDisc(model, size, failed));
  PetscCall(TestBlock(model, failed));
  PetscCall(ModelDestroy(&model));
  PetscFunctionReturn(0);
}

/* Breaks when: few layers in z count as lines, or a disc with a patch as turned */
static PetscErrorCode TestPatch(int *failed)
{
  ModelLines *lines;
  Model       model;

  PetscFunctionBeginUser;
  PetscCall(RigCreateModel(MATERIALS "-rig_pad 0 -parts disc", &model));
  PetscCall(LinesOfBody(model, 0, &lines));
  *failed += CheckClose("disc with a patch: ranks with lines", (double)Sum(lines ? 1 : 0), 0, 0);
  PetscCall(ModelDestroyLines(&lines));
  PetscCall(ModelDestroy(&model));
  PetscFunctionReturn(0);
}

/* What is done to the nodes of a ring of 3 x 24 x 2 cells about z */
typedef enum { ROUNDED, MOVED, SPREAD, CARRIED, SMALL } Change;

static void ChangeNode(Change change, PetscInt v, PetscReal x[3])
{
  const PetscReal old[3] = {x[0], x[1], x[2]}, angle = atan2(x[1], x[0]), r = hypot(x[0], x[1]);

  if (change == ROUNDED) x[v % 3] *= 1 + 1e-13 * (PetscReal)(v % 7);
  if (change == MOVED && v == 40) x[2] += 1e-6 * 0.01;
  if (change == SPREAD && PetscAbsReal(angle - PETSC_PI / 2) < 1e-6) {
    x[0] = r * cos(angle + 1e-5);
    x[1] = r * sin(angle + 1e-5);
  }
  for (int d = 0; d < 3 && change == CARRIED; d++) x[d] = old[(d + 2) % 3] + (PetscReal[]){0.3, -1.7, 2.5}[d];
  for (int d = 0; d < 3 && change == SMALL; d++) x[d] = old[d] * 1e-6;
}

/* Lines of the changed ring, which the caller destroys with the model */
static PetscErrorCode RingLines(Change change, Model *model, ModelLines **lines)
{
  const Mesh *mesh;

  PetscFunctionBeginUser;
  PetscCall(RigCreateModel(RING, model));
  PetscCall(ModelGetMesh(*model, &mesh));
  for (PetscInt v = 0; v < mesh->n_nodes; v++) ChangeNode(change, v, (PetscReal *)&mesh->x[3 * v]);
  PetscCall(LinesOfBody(*model, 0, lines));
  PetscFunctionReturn(0);
}

/* Breaks when: rounding of a file is too much, one displaced node or one unequal angle goes unseen, the axis must pass
   through the origin or be z, or the tolerance is absolute */
static PetscErrorCode TestRings(PetscMPIInt size, int *failed)
{
  static const struct {
    const char *name;
    int         swept;
  } expected[] = {
    {"ring with rounding: ranks with lines",      1},
    {"one node moved: ranks with lines",          0},
    {"one angle unequal: ranks with lines",       0},
    {"axis x off the origin: ranks with lines",   1},
    {"a millionth of the size: ranks with lines", 1}
  };

  PetscFunctionBeginUser;
  for (int change = ROUNDED; change <= SMALL; change++) {
    ModelLines *lines;
    PetscReal   worst;
    Model       model;

    PetscCall(RingLines((Change)change, &model, &lines));
    PetscCall(LinesError(model, lines, &worst));
    if (expected[change].swept) {
      *failed += CheckClose(expected[change].name, (double)Sum(lines ? 1 : 0), size, 0);
      *failed += CheckClose("worst place of a node, m", worst, 0, 1e-12);
    } else if (size == 1)
      *failed += CheckClose(expected[change].name, (double)Sum(lines ? 1 : 0), 0, 0);
    if (lines && change == CARRIED) {
      *failed += CheckTrue("turned about x", lines->turned && lines->axis == 0, lines->axis);
      *failed += CheckClose("centre y, m", lines->centre[1], -1.7, 1e-15);
      *failed += CheckClose("centre z, m", lines->centre[2], 2.5, 1e-15);
    }
    PetscCall(ModelDestroyLines(&lines));
    PetscCall(ModelDestroy(&model));
  }
  PetscFunctionReturn(0);
}

/* Breaks when: a column of two parts counts as one. Two glued boxes, z equally
   spaced over both, x and y not: swept along z only as long as both have the same section and one part. */
static PetscErrorCode TestColumns(int *failed)
{
  static const PetscReal x[] = {0, 1, 3}, y[] = {0, 2, 3}, z[] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10};
  const Box              one = {
                 .name = "a", .n = {3, 3, 11},
                      .x = {x, y, z }
  };
  const Box two[] = {
    {.name = "a",     .n = {3, 3, 6},     .x = {x, y, z}},
    { .name = "b", .n = {3, 3, 6}, .x = {x, y, z + 5},     .glued = 1}
  };
  ModelLines *lines;
  Model       model;

  PetscFunctionBeginUser;
  PetscCall(BoxesCreateModel(PETSC_COMM_SELF, 1, &one, "-parts a -a_young 1 -a_density 1", &model));
  PetscCall(LinesOfBody(model, 0, &lines));
  *failed += CheckTrue("a bar: along z", lines && !lines->turned && lines->axis == 2, lines ? lines->axis : -1);
  *failed += CheckClose("a bar: nodes of a line", lines ? (double)lines->n_nodes : -1, 11, 0);
  PetscCall(ModelDestroyLines(&lines));
  PetscCall(ModelDestroy(&model));
  PetscCall(
    BoxesCreateModel(PETSC_COMM_SELF, 2, two, "-parts a,b -a_young 1 -a_density 1 -b_young 1 -b_density 1", &model));
  PetscCall(LinesOfBody(model, 0, &lines));
  *failed += CheckTrue("a bar of two parts: no lines", !lines, lines ? 1 : 0);
  PetscCall(ModelDestroyLines(&lines));
  PetscCall(ModelDestroy(&model));
  PetscFunctionReturn(0);
}

static PetscErrorCode Tests(PetscMPIInt size, int *failed)
{
  PetscFunctionBeginUser;
  PetscCall(TestRig(size, failed));
  PetscCall(TestPatch(failed));
  PetscCall(TestRings(size, failed));
  if (size == 1) PetscCall(TestColumns(failed));
  PetscFunctionReturn(0);
}

int main(int argc, char **argv)
{
  return PetscMain(argc, argv, Tests);
}
