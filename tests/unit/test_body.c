/*
   Unit test of ModelGetBodies(): pieces that hang together by nodes, numbered by their place, the same on any ranks.

   References: the rig's pad and beam share nodes and the disc, whose nodes coincide with the pad's without being the
   same, is another body; boxes are placed so that x, then y, then z of their first node decides.
*/
#include "boxes.h"
#include "check.h"
#include "petscmain.h"

/* Number of local cells of a part of which a vertex has another body than `expected` */
static PetscErrorCode CountWrong(Model model, const char part[], const PetscInt body[], PetscInt expected,
                                 PetscInt *n_wrong, PetscInt *n_cells)
{
  const Mesh *mesh;

  PetscFunctionBeginUser;
  PetscCall(ModelGetMesh(model, &mesh));
  *n_wrong = *n_cells = 0;
  for (PetscInt c = 0; c < mesh->n_cells; c++) {
    const Element *element;
    PetscInt       vertices[ELEMENT_MAX_NODES];
    PetscReal      x[ELEMENT_MAX_DOFS];

    if (strcmp(mesh->part[mesh->cell_part[c]], part)) continue;
    PetscCall(ModelGetCell(model, c, &element, vertices, x));
    for (int i = 0; i < 8; i++) *n_wrong += body[vertices[i]] != expected;
    ++*n_cells;
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, n_wrong, 1, MPIU_INT, MPI_SUM, PETSC_COMM_WORLD));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, n_cells, 1, MPIU_INT, MPI_SUM, PETSC_COMM_WORLD));
  PetscFunctionReturn(0);
}

/* The bodies of a model with these parts are n_expected, part i is body[i] */
static PetscErrorCode CheckBodies(Model model, PetscInt n_expected, PetscInt n_parts, const char *const part[],
                                  const PetscInt expected[], int *failed)
{
  PetscInt n_bodies, *body, n_wrong, n_cells;

  PetscFunctionBeginUser;
  PetscCall(ModelGetBodies(model, &n_bodies, &body));
  *failed += CheckClose("bodies", (double)n_bodies, (double)n_expected, 0);
  for (PetscInt i = 0; i < n_parts; i++) {
    PetscCall(CountWrong(model, part[i], body, expected[i], &n_wrong, &n_cells));
    *failed += CheckTrue(part[i], n_cells > 0 && n_wrong == 0, (double)n_wrong);
  }
  PetscCall(PetscFree(body));
  PetscFunctionReturn(0);
}

/* Breaks when: coincident nodes join bodies, shared nodes of pad and beam do not, or a body that ranks share falls
   apart */
static PetscErrorCode TestRig(int *failed)
{
  static const char *const part[]     = {"disc", "pad", "beam"};
  static const PetscInt    expected[] = {0, 1, 1};
  Model                    model;

  PetscFunctionBeginUser;
  PetscCall(PetscOptionsClear(NULL));
  PetscCall(PetscOptionsInsertString(
    NULL, "-model_source rig -rig_disc_elements 8,24,1 -rig_pad_elements 4,4,2 -rig_beam_elements 10 -disc_young 1 "
          "-disc_density 1 -pad_young 1 -pad_density 1 -beam_young 1 -beam_density 1"));
  PetscCall(ModelCreate(PETSC_COMM_WORLD, &model));
  PetscCall(ModelSetFromOptions(model));
  PetscCall(ModelSetUp(model));
  PetscCall(CheckBodies(model, 2, 3, part, expected, failed));
  PetscCall(ModelDestroy(&model));
  PetscFunctionReturn(0);
}

/* Breaks when: bodies keep the order of the file or of the ranks, or the order by x, y, z fails where the first
   coordinates are equal; a and b are glued, c and d stand at the same x and y */
static PetscErrorCode TestBoxes(int *failed)
{
  static const PetscReal one[] = {0, 1, 1.25}, two[] = {5, 6, 7}, far[] = {1.5, 2.5},
                         long_x[]     = {-1, 3, 4, 5, 6, 7, 8, 9};
  static const char *const part[]     = {"a", "b", "c", "d", "e"};
  static const PetscInt    expected[] = {3, 3, 2, 1, 0};
  const Box                box[]      = {
                        {.name = "a", .n = {2, 2, 2}, .x = {one, two, one}    },
                        {.name = "b", .n = {2, 2, 2}, .x = {one, two, one + 1}, .glued = 1},
                        {.name = "c",           .n = {2, 2, 2},               .x = {one, one, far}              },
                        {.name = "d",           .n = {2, 2, 2},               .x = {one, one, one}},
                        {.name = "e",           .n = {8, 2, 2},               .x = {long_x, two, two}              }
  };
  Model model;

  PetscFunctionBeginUser;
  PetscCall(BoxesCreateModel(PETSC_COMM_WORLD, 5, box,
                             "-parts a,b,c,d,e -a_young 1 -a_density 1 -b_young 1 -b_density 1 -c_young 1 -c_density 1 "
                             "-d_young 1 -d_density 1 -e_young 1 -e_density 1",
                             &model));
  PetscCall(CheckBodies(model, 4, 5, part, expected, failed));
  PetscCall(ModelDestroy(&model));
  PetscFunctionReturn(0);
}

static PetscErrorCode Tests(PetscMPIInt size, int *failed)
{
  PetscFunctionBeginUser;
  (void)size;
  PetscCall(TestRig(failed));
  PetscCall(TestBoxes(failed));
  PetscFunctionReturn(0);
}

int main(int argc, char **argv)
{
  return PetscMain(argc, argv, Tests);
}
