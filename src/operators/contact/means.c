/*
   Slaves of exact contact that are means of several nodes: the displacement u_0 of the node that is eliminated follows
   the mean that the constraint holds. With u~ = sum_k v_k u_k at each of these nodes, as on faces of second order,

      u_0 = (u~ - sum_k>0 v_k u_k) / v_0,

   a node between corners following these, one in the middle of a face nodes of its sides too. A pair at the border of
   the master has u_s = g u~ + sum_k g_k u~_k, with g_k of nodes k without pairs, which are free:

      u~ = (u_s - sum_k g_k u~_k) / g,   g = 1 - sum_k g_k.

   Hence u = T u^ = T_middles T_sides T_taken u^, u^ having u_s, or u~_k, in place of u_0.
*/
#include "operators/pencilimpl.h"

#define MEANS_SIDES 3 /* nodes in the mean of a node between two corners; that of the middle of a face has sides too */

/* The means of n pairs, then those of nodes without pairs, of interfaces with the exact law; the caller frees them */
static PetscErrorCode MeansList(Pencil pencil, PetscInt n, const ContactPair **list, PetscInt *n_means,
                                ContactMean **means)
{
  const ContactInterface *interfaces;
  const ContactMean      *alone;
  PetscInt                n_alone, n_interfaces;

  PetscFunctionBeginUser;
  PetscCall(ContactGetMeans(pencil->operators->contact, &n_alone, &alone));
  PetscCall(ContactGetInterfaces(pencil->operators->contact, &n_interfaces, &interfaces));
  PetscCall(PetscMalloc1(n + n_alone, means));
  for (*n_means = 0; *n_means < n; (*n_means)++)
    (*means)[*n_means] = (ContactMean){list[*n_means]->interface, list[*n_means]->n_own, list[*n_means]->own};
  for (PetscInt i = 0; i < n_alone; i++)
    if (interfaces[alone[i].interface].law == CONTACT_CONSTRAINT) (*means)[(*n_means)++] = alone[i];
  PetscFunctionReturn(0);
}

/* The identity, with room for `most` entries in a row; NULL where that is 1 on all ranks */
static PetscErrorCode IdentityCreate(Pencil pencil, PetscInt most, Mat *T)
{
  PetscInt first, last;

  PetscFunctionBeginUser;
  *T = NULL;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &most, 1, MPIU_INT, MPI_MAX, pencil->comm));
  if (most == 1) PetscFunctionReturn(0);
  PetscCall(MatGetOwnershipRange(pencil->base.term[0].A, &first, &last));
  PetscCall(MatCreateAIJ(pencil->comm, last - first, last - first, PETSC_DETERMINE, PETSC_DETERMINE, most, NULL, most,
                         NULL, T));
  for (PetscInt i = first; i < last; i++) PetscCall(MatSetValue(*T, i, i, 1, INSERT_VALUES));
  PetscFunctionReturn(0);
}

/* The rows of T of means of within[0] + 1 to within[1] nodes, or of its inverse; NULL where there are none */
static PetscErrorCode MeansCreateRows(Pencil pencil, PetscInt n, const ContactMean means[], const PetscInt within[2],
                                      PetscBool inverse, Mat *T)
{
  PetscInt most = 1;

  PetscFunctionBeginUser;
  for (PetscInt p = 0; p < n; p++)
    if (means[p].n > within[0] && means[p].n <= within[1]) most = PetscMax(most, means[p].n);
  PetscCall(IdentityCreate(pencil, most, T));
  if (!*T) PetscFunctionReturn(0);
  for (PetscInt p = 0; p < n; p++) {
    const PetscBool takes = means[p].n > within[0] && means[p].n <= within[1] ? PETSC_TRUE : PETSC_FALSE;

    for (PetscInt k = 0; takes && k < 3 * means[p].n; k++) {
      const ContactPairNode *own = &means[p].node[0], *node = &means[p].node[k / 3];
      const PetscReal        v = inverse ? node->weight : (node == own ? 1 : -node->weight) / own->weight;

      PetscCall(MatSetValues(*T, 1, &own->unknown[k % 3], 1, &node->unknown[k % 3], &v, INSERT_VALUES));
    }
  }
  PetscCall(MatAssemblyBegin(*T, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(*T, MAT_FINAL_ASSEMBLY));
  PetscFunctionReturn(0);
}

/* T_taken, or its inverse; NULL where no pair takes anything */
static PetscErrorCode TakenCreate(Pencil pencil, PetscInt n, const ContactPair **list, PetscBool inverse, Mat *T)
{
  PetscInt most = 1;

  PetscFunctionBeginUser;
  for (PetscInt p = 0; p < n; p++) most = PetscMax(most, 1 + list[p]->n_taken);
  PetscCall(IdentityCreate(pencil, most, T));
  if (!*T) PetscFunctionReturn(0);
  for (PetscInt p = 0; p < n; p++) {
    const PetscInt *own = list[p]->own[0].unknown;
    PetscReal       g   = 1;

    for (PetscInt k = 0; k < list[p]->n_taken; k++) g -= list[p]->taken[k].weight;
    for (PetscInt k = 0; k < 3 * list[p]->n_taken; k++) {
      const ContactPairNode *node = &list[p]->taken[k / 3];
      const PetscReal        v    = inverse ? node->weight : -node->weight / g;

      PetscCall(MatSetValues(*T, 1, &own[k % 3], 1, &node->unknown[k % 3], &v, INSERT_VALUES));
    }
    g = inverse ? g : 1 / g;
    for (int d = 0; d < 3; d++) PetscCall(MatSetValues(*T, 1, &own[d], 1, &own[d], &g, INSERT_VALUES));
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

/* T becomes F T, either of which may be NULL, the identity; F is taken */
static PetscErrorCode MeansTimes(Mat F, Mat *T)
{
  PetscFunctionBeginUser;
  if (!*T) {
    *T = F;
    PetscFunctionReturn(0);
  }
  PetscCall(MeansFollow(F, PETSC_FALSE, T));
  PetscCall(MatDestroy(&F));
  PetscFunctionReturn(0);
}

/* Sides are final where middles follow them */
PetscErrorCode MeansCreate(Pencil pencil, PetscInt n, const ContactPair **list)
{
  Mat          sides, middles;
  ContactMean *means;
  PetscInt     n_means;

  PetscFunctionBeginUser;
  PetscCall(MeansList(pencil, n, list, &n_means, &means));
  PetscCall(TakenCreate(pencil, n, list, PETSC_FALSE, &pencil->T));
  PetscCall(MeansCreateRows(pencil, n_means, means, (const PetscInt[]){1, MEANS_SIDES}, PETSC_FALSE, &sides));
  PetscCall(MeansTimes(sides, &pencil->T));
  PetscCall(MeansCreateRows(pencil, n_means, means, (const PetscInt[]){MEANS_SIDES, CONTACT_MAX_MASTER}, PETSC_FALSE,
                            &middles));
  PetscCall(MeansTimes(middles, &pencil->T));
  PetscCall(PetscFree(means));
  PetscFunctionReturn(0);
}

/* E' takes the kept unknowns out of u, not of u^: E becomes T^-1' E */
PetscErrorCode MeansTakeInjection(Pencil pencil, PetscInt n, const ContactPair **list)
{
  Mat          inverse;
  ContactMean *means;
  PetscInt     n_means;

  PetscFunctionBeginUser;
  PetscCall(MeansList(pencil, n, list, &n_means, &means));
  PetscCall(TakenCreate(pencil, n, list, PETSC_TRUE, &inverse));
  PetscCall(MeansFollow(inverse, PETSC_TRUE, &pencil->E));
  PetscCall(MatDestroy(&inverse));
  PetscCall(MeansCreateRows(pencil, n_means, means, (const PetscInt[]){1, CONTACT_MAX_MASTER}, PETSC_TRUE, &inverse));
  PetscCall(MeansFollow(inverse, PETSC_TRUE, &pencil->E));
  PetscCall(MatDestroy(&inverse));
  PetscCall(PetscFree(means));
  PetscFunctionReturn(0);
}
