/*
   Slaves of exact contact that are means of several nodes, u_s = sum_k v_k u_k, as on faces of second order: the
   displacement u_0 of the node that is eliminated follows the mean that the constraint holds,

      u_0 = (u_s - sum_k>0 v_k u_k) / v_0,   u = T u~,

   u~ having u_s in place of u_0. A node between corners follows these, one in the middle of a face nodes of its sides
   too, hence T = T_middles T_sides.
*/
#include "operators/pencilimpl.h"

#define MEANS_SIDES 3 /* nodes in the mean of a node between two corners; that of the middle of a face has sides too */

/* The rows of T of means of within[0] + 1 to within[1] nodes, or of its inverse; NULL where there are none */
static PetscErrorCode MeansCreateRows(Pencil pencil, PetscInt n, const ContactPair **list, const PetscInt within[2],
                                      PetscBool inverse, Mat *T)
{
  PetscInt first, last, most = 1;

  PetscFunctionBeginUser;
  *T = NULL;
  for (PetscInt p = 0; p < n; p++)
    if (list[p]->n_slave > within[0] && list[p]->n_slave <= within[1]) most = PetscMax(most, list[p]->n_slave);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &most, 1, MPIU_INT, MPI_MAX, pencil->comm));
  if (most == 1) PetscFunctionReturn(0);
  PetscCall(MatGetOwnershipRange(pencil->base.term[0].A, &first, &last));
  PetscCall(MatCreateAIJ(pencil->comm, last - first, last - first, PETSC_DETERMINE, PETSC_DETERMINE, most, NULL, most,
                         NULL, T));
  for (PetscInt i = first; i < last; i++) PetscCall(MatSetValue(*T, i, i, 1, INSERT_VALUES));
  for (PetscInt p = 0; p < n; p++) {
    const PetscBool takes = list[p]->n_slave > within[0] && list[p]->n_slave <= within[1] ? PETSC_TRUE : PETSC_FALSE;

    for (PetscInt k = 0; takes && k < 3 * list[p]->n_slave; k++) {
      const ContactPairNode *own = &list[p]->slave[0], *node = &list[p]->slave[k / 3];
      const PetscReal        v = inverse ? node->weight : (node == own ? 1 : -node->weight) / own->weight;

      PetscCall(MatSetValues(*T, 1, &own->unknown[k % 3], 1, &node->unknown[k % 3], &v, INSERT_VALUES));
    }
  }
  PetscCall(MatAssemblyBegin(*T, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(*T, MAT_FINAL_ASSEMBLY));
  PetscFunctionReturn(0);
}

PetscErrorCode MeansFollow(Mat T, PetscBool transpose, Mat *X)
{
  Mat TX;

  PetscFunctionBeginUser;
  if (!T) PetscFunctionReturn(0);
  if (transpose)
    PetscCall(MatTransposeMatMult(T, *X, MAT_INITIAL_MATRIX, PETSC_DEFAULT, &TX));
  else
    PetscCall(MatMatMult(T, *X, MAT_INITIAL_MATRIX, PETSC_DEFAULT, &TX));
  PetscCall(MatProductClear(TX));
  PetscCall(MatDestroy(X));
  *X = TX;
  PetscFunctionReturn(0);
}

/* T_middles T_sides: sides are final where middles follow them */
PetscErrorCode MeansCreate(Pencil pencil, PetscInt n, const ContactPair **list)
{
  Mat middles;

  PetscFunctionBeginUser;
  PetscCall(MeansCreateRows(pencil, n, list, (const PetscInt[]){1, MEANS_SIDES}, PETSC_FALSE, &pencil->T));
  PetscCall(
    MeansCreateRows(pencil, n, list, (const PetscInt[]){MEANS_SIDES, CONTACT_MAX_MASTER}, PETSC_FALSE, &middles));
  if (!pencil->T) {
    pencil->T = middles;
    PetscFunctionReturn(0);
  }
  PetscCall(MeansFollow(middles, PETSC_FALSE, &pencil->T));
  PetscCall(MatDestroy(&middles));
  PetscFunctionReturn(0);
}

/* E' takes the kept unknowns out of u, not of u~: E becomes T^-1' E */
PetscErrorCode MeansTakeInjection(Pencil pencil, PetscInt n, const ContactPair **list)
{
  Mat inverse;

  PetscFunctionBeginUser;
  PetscCall(MeansCreateRows(pencil, n, list, (const PetscInt[]){1, CONTACT_MAX_MASTER}, PETSC_TRUE, &inverse));
  PetscCall(MeansFollow(inverse, PETSC_TRUE, &pencil->E));
  PetscCall(MatDestroy(&inverse));
  PetscFunctionReturn(0);
}
