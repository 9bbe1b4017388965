/*
   Unit test of ModelAddLoad(): forces on surfaces, curves, points and volumes add up to what is asked for, and on
   surfaces they are the integrals of the shape functions.

   Exact references on the face z = const of a graded box: int N_v dA = h_x(v) h_y(v), half the steps to the neighbours
   on both sides; with the box tapered to 0 <= y <= 1, 0 <= x <= 1 + y/2: area 5/4, int x dA = 19/24, int y dA = 2/3.
*/
#include "boxes.h"
#include "check.h"

#define SCENE                                                                                                          \
  "-parts bar -bar_young 1 -bar_density 1 -supports held -held_set bar_edge -loads face,line,tip,all "                 \
  "-face_set bar_top -face_force 3,-5,-100 -line_set bar_edge -line_force 2,0,1 -tip_set bar_corner "                  \
  "-tip_force 0,7,0 -all_set bar -all_force 1,2,3 "

static const PetscReal grid_x[] = {0, 0.125, 0.3, 0.45, 1}, grid_y[] = {0, 0.5, 0.6, 1}, grid_z[] = {0, 0.2, 1, 1.5};

/* The graded box, tapered or not */
static Box Bar(PetscReal taper)
{
  return (Box){
    .name  = "bar",
    .n     = {BOX_LENGTH(grid_x), BOX_LENGTH(grid_y), BOX_LENGTH(grid_z)},
    .x     = {grid_x,             grid_y,             grid_z            },
    .taper = taper
  };
}

/* The forces f[local vertices][3] of load i added to `before`; the caller frees them */
static PetscErrorCode LoadGet(Model model, PetscInt i, PetscReal before, PetscInt *n_vertices, PetscReal **f)
{
  const PetscScalar *values;
  Vec                local;

  PetscFunctionBeginUser;
  PetscCall(ModelCreateNodal(model, &local));
  PetscCall(VecSet(local, before));
  PetscCall(ModelAddLoad(model, i, NULL, local));
  PetscCall(VecGetLocalSize(local, n_vertices));
  PetscCall(PetscMalloc1(*n_vertices, f));
  PetscCall(VecGetArrayRead(local, &values));
  PetscCall(PetscArraycpy(*f, values, *n_vertices));
  PetscCall(VecRestoreArrayRead(local, &values));
  PetscCall(VecDestroy(&local));
  *n_vertices /= 3;
  PetscFunctionReturn(0);
}

/* Sum over all vertices of all ranks, each once: f_d in sum[d], x_e f_d in moment[e][d], and the number of vertices
   with a force */
static PetscErrorCode LoadSum(Model model, PetscInt n_vertices, const PetscReal f[], PetscReal sum[3],
                              PetscReal moment[3][3], PetscReal *count)
{
  const Mesh *mesh;
  PetscReal   total[13] = {0};

  PetscFunctionBeginUser;
  PetscCall(ModelGetMesh(model, &mesh));
  for (PetscInt v = 0; v < n_vertices; v++) {
    for (int d = 0; d < 3 && mesh->owned[v]; d++) {
      total[d] += f[3 * v + d];
      for (int e = 0; e < 3; e++) total[3 + 3 * e + d] += mesh->x[3 * v + e] * f[3 * v + d];
    }
    if (mesh->owned[v] && (f[3 * v] != 0 || f[3 * v + 1] != 0 || f[3 * v + 2] != 0)) total[12] += 1;
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, total, 13, MPIU_REAL, MPI_SUM, PETSC_COMM_WORLD));
  PetscCall(PetscArraycpy(sum, total, 3));
  PetscCall(PetscArraycpy(&moment[0][0], &total[3], 9));
  *count = total[12];
  PetscFunctionReturn(0);
}

/* Breaks when: vertices shared by ranks count twice or not at all, held ones (the edge) get nothing, or the number of
   vertices of a set is wrong */
static PetscErrorCode TestSums(Model model, int *failed)
{
  static const PetscReal n_expected[] = {5 * 4, 4, 1, 5 * 4 * 4};
  const ModelScene      *scene;
  PetscInt               n_vertices;
  PetscReal              sum[3], moment[3][3], count, *f;

  PetscFunctionBeginUser;
  PetscCall(ModelGetScene(model, &scene));
  *failed += CheckClose("loads", (double)scene->n_loads, 4, 0);
  for (PetscInt i = 0; i < scene->n_loads; i++) {
    PetscCall(LoadGet(model, i, 0, &n_vertices, &f));
    PetscCall(LoadSum(model, n_vertices, f, sum, moment, &count));
    for (int d = 0; d < 3; d++)
      *failed += CheckClose("sum of the forces, N", sum[d], scene->loads[i].force[d],
                            1e-13 * PetscMax(1, PetscAbsReal(scene->loads[i].force[d])));
    *failed += CheckClose("vertices with a force", count, n_expected[i], 0);
    PetscCall(PetscFree(f));
  }
  PetscFunctionReturn(0);
}

/* Share of the node at z in the length of the edge: half the steps to its neighbours */
static PetscReal EdgeShare(PetscReal z)
{
  const PetscInt n     = BOX_LENGTH(grid_z);
  PetscReal      share = 0;

  for (PetscInt k = 0; k < n - 1; k++)
    if (PetscAbsReal(grid_z[k] - z) < 1e-12 || PetscAbsReal(grid_z[k + 1] - z) < 1e-12)
      share += (grid_z[k + 1] - grid_z[k]) / 2;
  return share / (grid_z[n - 1] - grid_z[0]);
}

/* Breaks when: a node of a curve gets another share than that of its length, or one that ranks share gets more than the
   others of a point or a volume */
static PetscErrorCode TestEqual(Model model, int *failed)
{
  static const PetscReal n_expected[] = {4, 1, 5 * 4 * 4}, force[] = {2, 7, 1};
  static const int       direction[] = {0, 1, 0};
  const Mesh            *mesh;

  PetscFunctionBeginUser;
  PetscCall(ModelGetMesh(model, &mesh));
  for (PetscInt i = 0; i < 3; i++) {
    PetscInt  n_vertices;
    PetscReal worst = 0, *f;

    PetscCall(LoadGet(model, i + 1, 0, &n_vertices, &f));
    for (PetscInt v = 0; v < n_vertices; v++) {
      const PetscReal here = f[3 * v + direction[i]], share = i ? 1 / n_expected[i] : EdgeShare(mesh->x[3 * v + 2]);

      if (here != 0) worst = PetscMax(worst, PetscAbsReal(here - force[i] * share));
    }
    PetscCall(PetscFree(f));
    *failed += CheckClose("forces without faces, largest error, N", worst, 0, 1e-14);
  }
  PetscFunctionReturn(0);
}

/* Half the steps from x[i] to its neighbours, for the node at `at` */
static PetscReal Share(PetscInt n, const PetscReal x[], PetscReal at)
{
  for (PetscInt i = 0; i < n; i++)
    if (PetscAbsReal(x[i] - at) < 1e-12) return (x[PetscMin(i + 1, n - 1)] - x[PetscMax(i - 1, 0)]) / 2;
  return 0;
}

/* Breaks when: nodes share a surface equally or by some other rule, a vertex lacks the faces of another rank, or the
   load replaces what is there (here 10 N everywhere) */
static PetscErrorCode TestDistribution(Model model, int *failed)
{
  const Mesh *mesh;
  PetscInt    n_vertices;
  PetscReal   worst = 0, *f;

  PetscFunctionBeginUser;
  PetscCall(ModelGetMesh(model, &mesh));
  PetscCall(LoadGet(model, 0, 10, &n_vertices, &f));
  for (PetscInt v = 0; v < n_vertices; v++) {
    const PetscReal top = PetscAbsReal(mesh->x[3 * v + 2] - 1.5) < 1e-12 ? 1 : 0;
    const PetscReal share =
      top * Share(BOX_LENGTH(grid_x), grid_x, mesh->x[3 * v]) * Share(BOX_LENGTH(grid_y), grid_y, mesh->x[3 * v + 1]);

    worst = PetscMax(worst, PetscAbsReal(f[3 * v] - 10 - 3 * share));
    worst = PetscMax(worst, PetscAbsReal(f[3 * v + 1] - 10 + 5 * share));
    worst = PetscMax(worst, PetscAbsReal(f[3 * v + 2] - 10 + 100 * share));
  }
  PetscCall(PetscFree(f));
  *failed += CheckClose("consistent forces on a graded surface, largest error, N", worst, 0, 1e-13 * 100);
  PetscFunctionReturn(0);
}

/* Breaks when: a face's corners share by fewer than 2 x 2 points, or all alike */
static PetscErrorCode TestMoments(int *failed)
{
  const PetscReal centroid[3] = {19.0 / 24 / 1.25, 2.0 / 3 / 1.25, 1.5};
  const Box       bar         = Bar(0.5);
  PetscInt        n_vertices;
  PetscReal       sum[3], moment[3][3], count, *f;
  Model           model;

  PetscFunctionBeginUser;
  PetscCall(BoxesCreateModel(PETSC_COMM_WORLD, 1, &bar, SCENE, &model));
  PetscCall(LoadGet(model, 0, 0, &n_vertices, &f));
  PetscCall(LoadSum(model, n_vertices, f, sum, moment, &count));
  for (int e = 0; e < 3; e++)
    *failed += CheckClose("first moment on trapezoids, N m", moment[e][2], -100 * centroid[e], 1e-13 * 100);
  PetscCall(PetscFree(f));
  PetscCall(ModelDestroy(&model));
  PetscFunctionReturn(0);
}

int main(int argc, char **argv)
{
  const Box bar    = Bar(0);
  int       failed = 0;
  Model     model;

  PetscFunctionBeginUser;
  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  PetscCall(BoxesCreateModel(PETSC_COMM_WORLD, 1, &bar, SCENE, &model));
  PetscCall(TestSums(model, &failed));
  PetscCall(TestEqual(model, &failed));
  PetscCall(TestDistribution(model, &failed));
  PetscCall(ModelDestroy(&model));
  PetscCall(TestMoments(&failed));
  PetscCall(PetscOptionsClear(NULL));
  PetscCall(PetscFinalize());
  printf("%d failed\n", failed);
  return failed ? 1 : 0;
}
