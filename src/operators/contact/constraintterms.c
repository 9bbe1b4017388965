/* Terms of the pencil by projection on the null spaces of the contact constraint (constraint.c): c (Zr' A Zr) and c
   mu_i (Zl_i' A Zr) of a term c A of all unknowns */
#include "operators/pencilimpl.h"

/* L' AZ; NULL where it is exactly zero, as mostly: friction at an interface touches the terms of the bodies beside it
   alone */
static PetscErrorCode ProjectFromLeft(Mat L, Mat AZ, Mat *projected)
{
  PetscReal norm;

  PetscFunctionBeginUser;
  PetscCall(MatTransposeMatMult(L, AZ, MAT_INITIAL_MATRIX, PETSC_DEFAULT, projected));
  PetscCall(MatProductClear(*projected));
  PetscCall(MatNorm(*projected, NORM_FROBENIUS, &norm));
  if (norm == 0) PetscCall(MatDestroy(projected));
  PetscFunctionReturn(0);
}

/* Zr' A Zr, Zl_1' A Zr, Zl_2' A Zr, ..., array [1 + n_left] */
static PetscErrorCode TermProject(Pencil pencil, Mat A, Mat image[])
{
  Mat AZ;

  PetscFunctionBeginUser;
  PetscCall(MatMatMult(A, pencil->Zr, MAT_INITIAL_MATRIX, PETSC_DEFAULT, &AZ));
  PetscCall(MatProductClear(AZ));
  PetscCall(ProjectFromLeft(pencil->Zr, AZ, &image[0]));
  for (PetscInt i = 0; i < pencil->n_left; i++) PetscCall(ProjectFromLeft(pencil->left[i], AZ, &image[1 + i]));
  PetscCall(MatDestroy(&AZ));
  PetscFunctionReturn(0);
}

/* Adds the terms of the pencil that a base term with these images makes: image 0 has its coefficient, image i that
   times mu_i as one more factor. Friction makes a term unsymmetric. */
static PetscErrorCode ImagesAdd(Pencil pencil, const OperatorsTerm *base, const Mat image[])
{
  const PetscInt n = base->n;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i <= pencil->n_left; i++) {
    OperatorsTerm *term;

    if (!image[i]) continue;
    PetscCall(TermsAdd(&pencil->projected, base->kind, image[i], i ? PETSC_FALSE : base->symmetric, 0, NULL));
    term             = &pencil->projected.term[pencil->projected.n - 1];
    term->scale      = base->scale;
    term->n          = n + (i ? 1 : 0);
    term->constraint = i - 1;
    term->law        = base->law;
    term->reference  = base->reference;
    term->stiffened  = base->stiffened;
    PetscCheck(term->n <= OPERATORS_MAX_FACTORS, pencil->comm, PETSC_ERR_PLIB, "a term of %" PetscInt_FMT " factors",
               term->n);
    PetscCall(PetscArraycpy(term->factor, base->factor, n));
    if (!i) continue;
    term->factor[n].parameter = -1;
    term->factor[n].power     = 1;
    term->factor[n].friction  = pencil->left_mu[i - 1];
  }
  PetscFunctionReturn(0);
}

/* Once for all points: coefficients are not projected. Costs n_terms (1 + n_left) triple products. */
PetscErrorCode PencilProjectTerms(Pencil pencil)
{
  PetscInt n_images;
  Mat     *image;

  PetscFunctionBeginUser;
  if (!pencil->Zr || pencil->projected.n) PetscFunctionReturn(0);
  n_images = 1 + pencil->n_left;
  PetscCall(PetscCalloc1(pencil->base.n * n_images, &image));
  for (PetscInt t = 0; t < pencil->base.n; t++) {
    const OperatorsTerm *term   = &pencil->base.term[t];
    PetscInt             shared = 0;

    /* K_p of a part is a term of stiffness and one of damping: each matrix is projected once */
    while (pencil->base.term[shared].A != term->A) shared++;
    if (shared == t) PetscCall(TermProject(pencil, term->A, &image[t * n_images]));
    PetscCall(ImagesAdd(pencil, term, &image[shared * n_images]));
  }
  for (PetscInt i = 0; i < pencil->base.n * n_images; i++) PetscCall(MatDestroy(&image[i]));
  PetscCall(PetscFree(image));
  PetscFunctionReturn(0);
}
