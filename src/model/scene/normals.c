/*
   Normals of a surface at its nodes, with their shares in the area as lengths. Those of faces of first order are
   the sums of the area vectors int N_v n dA. Of second order these may be zero at corners: there the faces' own normals
   are summed with positive weights, and get the positive shares as lengths (kernels/contact/facet.h).
*/
#include "model/modelimpl.h"
#include "base/algebra/vec3.h"
#include "kernels/contact/facet.h"

/* Adds the area vectors of the faces on this rank to sum[3 v]; second: whether any face is of second order */
static PetscErrorCode NormalsAdd(Model model, const char set[], PetscScalar sum[], PetscBool *second)
{
  ModelFaces faces;

  PetscFunctionBeginUser;
  *second = PETSC_FALSE;
  PetscCall(ModelGetSetFaces(model, set, &faces));
  for (PetscInt f = 0; f < faces.n; f++) {
    const PetscInt *node;
    double          x[FACET_NODES][3], share[FACET_NODES][3];
    const int       n = (int)ModelFacesGet(&faces, &model->mesh, f, &node, x);

    FacetNodeNormals(n, (const double(*)[3])x, share);
    for (int i = 0; i < 3 * n; i++) sum[3 * node[i / 3] + i % 3] += share[i / 3][i % 3];
    if (FacetShapeOf(n)->n_corners < n) *second = PETSC_TRUE;
  }
  PetscCall(ModelFacesDestroy(&faces));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, second, 1, MPIU_BOOL, MPI_LOR, model->comm));
  PetscFunctionReturn(0);
}

/* Gives normals the positive shares in the area as lengths */
static PetscErrorCode NormalsScale(Model model, const char set[], PetscReal normal[])
{
  const PetscScalar *share;
  Vec                shares;

  PetscFunctionBeginUser;
  PetscCall(ModelCreateShares(model, set, set, SPREAD_AREA, &shares));
  PetscCall(VecGetArrayRead(shares, &share));
  for (PetscInt v = 0; v < model->mesh.n_nodes; v++) {
    (void)Vec3Normalise(&normal[3 * v]);
    for (int d = 0; d < 3; d++) normal[3 * v + d] *= PetscRealPart(share[3 * v]);
  }
  PetscCall(VecRestoreArrayRead(shares, &share));
  PetscCall(VecDestroy(&shares));
  PetscFunctionReturn(0);
}

PetscErrorCode ModelGetSetNormals(Model model, const char set[], PetscReal **area_normals)
{
  const PetscInt n = 3 * model->mesh.n_nodes;
  PetscScalar   *sum;
  PetscBool      second;
  Vec            sums;

  PetscFunctionBeginUser;
  PetscCall(ModelCreateNodal(model, &sums));
  PetscCall(VecGetArray(sums, &sum));
  PetscCall(NormalsAdd(model, set, sum, &second));
  PetscCall(VecRestoreArray(sums, &sum));
  PetscCall(ModelSumShared(model, sums));
  PetscCall(PetscMalloc1(n, area_normals));
  PetscCall(VecGetArray(sums, &sum));
  PetscCall(PetscArraycpy(*area_normals, sum, n));
  PetscCall(VecRestoreArray(sums, &sum));
  PetscCall(VecDestroy(&sums));
  if (second) PetscCall(NormalsScale(model, set, *area_normals));
  PetscFunctionReturn(0);
}
