/*
   Unit test of contact/tilt on one and on several ranks, by a rigid rotation.
*/
#include "freebodies.h"
#include "check.h"
#include "gridfile.h"
#include "scratch.h"

/* Moves every vertex by z += 2 (x - 0.1)^2 - 3 x y, so that the surfaces are curved and still touch */
static PetscErrorCode Bend(Model model)
{
  const Mesh      *mesh;
  const PetscReal *x;

  PetscFunctionBeginUser;
  PetscCall(ModelGetMesh(model, &mesh));
  x = mesh->x;
  for (PetscInt v = 0; v < 3 * mesh->n_nodes; v += 3) {
    PetscReal *z = (PetscReal *)&x[v + 2];

    *z += 2 * (x[v] - 0.1) * (x[v] - 0.1) - 3 * x[v] * x[v + 1];
  }
  PetscFunctionReturn(0);
}

/* Breaks when: a facet around a vertex is left out, on another rank or on this, or the mean is not that of pairing. The
   normals turn with the bodies: tilt (w x x) = (w x n) . t and . b, by hand. */
static PetscErrorCode TestTilt(const Chain *chain, int *failed)
{
  const ContactPair *pairs;
  PetscInt           n, n_all;
  PetscReal          error[2];
  PetscScalar       *value[2];
  Mat                tilt[2];
  Vec                x, expected[2];

  PetscFunctionBeginUser;
  PetscCall(ContactGetPairs(chain->contact, &n, &n_all, &pairs));
  PetscCall(ContactCreateTilt(chain->contact, &tilt[0], &tilt[1]));
  PetscCall(FieldCreate(chain, Rotation, NULL, NULL, &x));
  for (int k = 0; k < 2; k++) {
    PetscCall(MatCreateVecs(tilt[k], NULL, &expected[k]));
    PetscCall(VecGetArray(expected[k], &value[k]));
    for (PetscInt p = 0; p < n; p++) {
      PetscReal change[3];

      Vec3Cross(turn, pairs[p].n, change);
      value[k][p] = Vec3Dot(change, k ? pairs[p].b : pairs[p].t);
    }
    PetscCall(VecRestoreArray(expected[k], &value[k]));
    PetscCall(Mismatch(tilt[k], x, expected[k], &error[k]));
    PetscCall(VecDestroy(&expected[k]));
    PetscCall(MatDestroy(&tilt[k]));
  }
  PetscCall(VecDestroy(&x));
  *failed += CheckClose("rotation turns the normals along t, relative", error[0], 0, 1e-12);
  *failed += CheckClose("rotation turns the normals along b, relative", error[1], 0, 1e-12);
  PetscFunctionReturn(0);
}

/* The tilt on flat or curved surfaces: vertices are moved before pairing */
static PetscErrorCode TestSurfaces(const char title[], const char scene[], PetscBool curved, int *failed)
{
  Chain chain = {0};

  PetscFunctionBeginUser;
  printf("--- %s\n", title);
  PetscCall(PetscOptionsClear(NULL));
  PetscCall(PetscOptionsInsertString(NULL, scene));
  PetscCall(PetscOptionsInsertString(NULL, BODIES_1));
  PetscCall(OperatorsCreate(PETSC_COMM_WORLD, &chain.operators));
  PetscCall(ModelCreate(PETSC_COMM_WORLD, &chain.model));
  PetscCall(ModelSetFromOptions(chain.model));
  PetscCall(ContactCreate(chain.model, &chain.contact));
  PetscCall(ContactSetFromOptions(chain.contact));
  PetscCall(OperatorsSetModel(chain.operators, chain.model, chain.contact));
  PetscCall(ModelSetUp(chain.model));
  if (curved) PetscCall(Bend(chain.model));
  PetscCall(ContactSetUp(chain.contact));
  PetscCall(OperatorsSetUp(chain.operators));
  PetscCall(TestTilt(&chain, failed));
  PetscCall(ChainDestroy(&chain));
  PetscFunctionReturn(0);
}

/* Faces of six and of nine nodes on faces of their kind, node between nodes */
static PetscErrorCode TestSecondOrder(int tetrahedra, int *failed)
{
  const GridBox box[2] = {
    {"lower", {3, 4, 1}, {0, 0, 0},          {0.2, 0.2, 0.03}  },
    {"upper", {2, 2, 1}, {0.01, 0.02, 0.03}, {0.15, 0.18, 0.06}}
  };
  char    scene[4 * PETSC_MAX_PATH_LEN], path[PETSC_MAX_PATH_LEN + 32];
  Scratch scratch;

  PetscFunctionBeginUser;
  PetscCall(ScratchCreate(&scratch));
  PetscCall(GridWriteFile(ScratchPath(&scratch, "boxes.msh", path), tetrahedra, 2, box));
  PetscCall(PetscSNPrintf(scene, sizeof(scene),
                          "-model_source file -model_mesh %s -parts lower,upper -lower_young 1e9 -lower_density 1000 "
                          "-upper_young 1e9 -upper_density 1000 -contacts contact -contact_surfaces "
                          "upper_bottom,lower_top -contact_slip 3,4,0 -contact_mu 0.5 -contact_kn 1e8 "
                          "-contact_tolerance 1e-3 ",
                          path));
  PetscCall(
    TestSurfaces(tetrahedra ? "flat, six nodes a face" : "flat, nine nodes a face", scene, PETSC_FALSE, failed));
  PetscCall(TestSurfaces(tetrahedra ? "curved, six nodes" : "curved, nine nodes", scene, PETSC_TRUE, failed));
  (void)ScratchRemove(&scratch, "boxes.msh");
  (void)ScratchDestroy(&scratch);
  PetscFunctionReturn(0);
}

int main(int argc, char **argv)
{
  int failed = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  PetscCall(TestSurfaces("flat, node on node", FREE, PETSC_FALSE, &failed));
  PetscCall(TestSurfaces("flat, nodes between nodes", FREE BETWEEN, PETSC_FALSE, &failed));
  PetscCall(TestSurfaces("curved, node on node", FREE, PETSC_TRUE, &failed));
  PetscCall(TestSurfaces("curved, nodes between nodes", FREE BETWEEN, PETSC_TRUE, &failed));
  for (int tetrahedra = 0; tetrahedra < 2; tetrahedra++) PetscCall(TestSecondOrder(tetrahedra, &failed));
  PetscCall(PetscOptionsClear(NULL));
  PetscCall(PetscFinalize());
  printf("%d failed\n", failed);
  return failed ? 1 : 0;
}
