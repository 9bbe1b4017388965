/*
   Unit test of probes of a scene: the nearest node, one on all ranks together, and the same on 1, 2 and 3 ranks.

   References: grids of unit steps, so that the nearest node and the distances of ties are exact. Nodes are numbered
   against x and y, which decide ties.
*/
#include "boxes.h"
#include "check.h"

#define SCENE                                                                                                          \
  "-parts a,b -a_young 1 -a_density 1 -b_young 1 -b_density 1 -probes near,tie,inner,first,second -near_at 3.4,0.3,9 " \
  "-tie_at 2.5,1.5,0.5 -inner_at 3,1,7 -inner_part a -first_at 1,1,4 -second_at 1,1,4 -second_part b "
#define N_PROBES 5

static const PetscReal up[] = {0, 1, 2, 3, 4}, down[] = {4, 3, 2, 1, 0};
/* near: above b's top at z = 8; tie: the least x, y, z of eight nodes; inner: that of a, though b has a nearer
   one at z = 8; first, second: nodes of a and b stand at the same place */
static const PetscReal expected[N_PROBES][3] = {
  {3, 0, 8},
  {2, 1, 0},
  {3, 1, 4},
  {1, 1, 4},
  {1, 1, 4}
};
static const char *const expected_part[N_PROBES] = {"b", "a", "a", "a", "b"};

/* Whether a local vertex is a corner of a cell of the part, at this place */
static PetscErrorCode VertexIsOf(Model model, PetscInt vertex, const char part[], const PetscReal place[3],
                                 PetscBool *is)
{
  const Mesh    *mesh;
  const Element *element;
  PetscInt       vertices[ELEMENT_MAX_NODES];
  PetscReal      x[ELEMENT_MAX_DOFS];

  PetscFunctionBeginUser;
  *is = PETSC_FALSE;
  PetscCall(ModelGetMesh(model, &mesh));
  for (PetscInt c = 0; c < mesh->n_cells && !*is; c++) {
    if (strcmp(mesh->part[mesh->cell_part[c]], part)) continue;
    PetscCall(ModelGetCell(model, c, &element, vertices, x));
    for (int i = 0; i < 8 && !*is; i++)
      if (vertices[i] == vertex) PetscCall(PetscArraycmp(&x[3 * i], place, 3, is));
  }
  PetscFunctionReturn(0);
}

/* Breaks when: a rank takes its own nearest node, two ranks record a shared one, or none, the part is ignored, or ties
   fall as the ranks number the nodes */
static PetscErrorCode TestNearest(Model model, int *failed)
{
  const ModelScene *scene;

  PetscFunctionBeginUser;
  PetscCall(ModelGetScene(model, &scene));
  *failed += CheckClose("probes", (double)scene->n_probes, N_PROBES, 0);
  for (PetscInt i = 0; i < scene->n_probes; i++) {
    PetscInt  n_ranks = scene->probes[i].vertex >= 0 ? 1 : 0;
    PetscBool is      = PETSC_FALSE;

    if (n_ranks) PetscCall(VertexIsOf(model, scene->probes[i].vertex, expected_part[i], expected[i], &is));
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &n_ranks, 1, MPIU_INT, MPI_SUM, PETSC_COMM_WORLD));
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &is, 1, MPIU_BOOL, MPI_LOR, PETSC_COMM_WORLD));
    for (int d = 0; d < 3; d++) *failed += CheckClose(scene->probes[i].name, scene->probes[i].x[d], expected[i][d], 0);
    *failed += CheckClose("ranks that record it", (double)n_ranks, 1, 0);
    *failed += CheckTrue("the node belongs to the part", is, (double)i);
  }
  PetscFunctionReturn(0);
}

int main(int argc, char **argv)
{
  const Box box[] = {
    {.name = "a", .n = {5, 3, 5}, .x = {down, down + 2, up}                 },
    {.name = "b", .n = {5, 3, 2}, .x = {down, down + 2, (PetscReal[]){4, 8}}}
  };
  int   failed = 0;
  Model model;

  PetscFunctionBeginUser;
  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  PetscCall(BoxesCreateModel(PETSC_COMM_WORLD, 2, box, SCENE, &model));
  PetscCall(TestNearest(model, &failed));
  PetscCall(ModelDestroy(&model));
  PetscCall(PetscOptionsClear(NULL));
  PetscCall(PetscFinalize());
  printf("%d failed\n", failed);
  return failed ? 1 : 0;
}
