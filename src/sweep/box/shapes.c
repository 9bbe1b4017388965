/*
   The vectors of the reduced model on the mesh, reduced_shapes.h5: arrays vector_001 and so on, m, in the order of
   reduced_model.bin, so that a mode x of it moves as sum_k x_k v_k.
*/
#include "box.h"
#include "solver/block/orthonormal.h"

#define SHAPES_MOST 96e6 /* bytes of all vectors */
#define SHAPES_ONCE 16   /* vectors that are lifted together */

/* Vectors first .. first + m - 1 of the model as columns of a block */
static PetscErrorCode ShapesLift(const Box *box, PetscInt first, PetscInt m, BV block)
{
  const PetscInt n = box->basis.reduced.n_used;
  PetscReal     *unit;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(m * n, &unit));
  for (PetscInt k = 0; k < m; k++) unit[k * n + first + k] = 1;
  PetscCall(BasisLift(&box->basis, n, m, box->small.n_used ? box->few + first * n : unit, block));
  PetscCall(PetscFree(unit));
  PetscFunctionReturn(0);
}

/* Those on the mesh, one array each; nodal [nodes][3] for work */
static PetscErrorCode ShapesWrite(const Box *box, PetscInt first, PetscInt m, BV block, PetscReal nodal[],
                                  ResultsField field)
{
  Vec shape;

  PetscFunctionBeginUser;
  PetscCall(OperatorsCreateVec(box->operators, &shape));
  for (PetscInt k = 0; k < m; k++) {
    char key[32], title[32];
    Vec  q;

    PetscCall(BVGetColumn(block, k, &q));
    PetscCall(PencilExpand(box->basis.pencil, PETSC_FALSE, q, shape));
    PetscCall(BVRestoreColumn(block, k, &q));
    PetscCall(OperatorsGetNodal(box->operators, shape, nodal));
    PetscCall(PetscSNPrintf(key, sizeof(key), "vector_%03d", (int)(first + k + 1)));
    PetscCall(PetscSNPrintf(title, sizeof(title), "vector %d", (int)(first + k + 1)));
    PetscCall(ResultsFieldWriteNodal(field, title, 1, &(const ResultsNodal){key, 3, nodal}));
  }
  PetscCall(VecDestroy(&shape));
  PetscFunctionReturn(0);
}

PetscErrorCode BoxExportShapes(const Box *box, Results results)
{
  const PetscInt n = box->small.n_used ? box->small.n_used : box->basis.reduced.n_used;
  const Mesh    *mesh;
  PetscBool      wanted;
  PetscInt       n_nodes;
  PetscReal     *nodal, size;
  ResultsField   field;
  BV             block;

  PetscFunctionBeginUser;
  PetscCall(OperatorsGetMesh(box->operators, &mesh));
  PetscCall(ResultsWantFields(results, &wanted));
  if (!mesh || !wanted || !box->basis.pencil) PetscFunctionReturn(0);
  n_nodes = mesh->n_nodes;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &n_nodes, 1, MPIU_INT, MPI_SUM, box->comm));
  size = 3.0 * sizeof(PetscReal) * (PetscReal)n_nodes * (PetscReal)n;
  if (size > SHAPES_MOST) {
    PetscCall(PetscPrintf(box->comm,
                          "reduced_shapes.h5 is not written: %" PetscInt_FMT " vectors on the mesh are %.0f MB, and at "
                          "most %.0f MB are; the page has sliders without moving shapes\n",
                          n, (double)size / 1e6, SHAPES_MOST / 1e6));
    PetscFunctionReturn(0);
  }
  PetscCall(PetscMalloc1(3 * mesh->n_nodes, &nodal));
  PetscCall(ResultsFieldOpen(results, "reduced_shapes", mesh, &field));
  for (PetscInt first = 0; first < n; first += SHAPES_ONCE) {
    const PetscInt m = PetscMin(SHAPES_ONCE, n - first);

    PetscCall(BlockCreate(box->basis.space.V, m, &block));
    PetscCall(ShapesLift(box, first, m, block));
    PetscCall(ShapesWrite(box, first, m, block, nodal, field));
    PetscCall(BVDestroy(&block));
  }
  PetscCall(ResultsFieldClose(&field));
  PetscCall(PetscFree(nodal));
  PetscFunctionReturn(0);
}
