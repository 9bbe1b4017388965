/*
   What is not symmetric in a superelement, A = (A + A') / 2 + (A - A') / 2: in C_s the gyroscopic forces of a body that
   spins, in K_s those of friction inside of it. The symmetric part is a term as those of all bodies, the skew part one
   of those that come with friction: pencils have it, equilibria and integrations in time do not.
*/
#include "superelement.h"

#define SUPERELEMENT_EVEN 1e-8 /* of the norm: what differs from the transpose by less is rounding of a file */

/* |A - A'| / |A|, and whether A is one triangle: then |A - A'| is |A + A'| without its diagonal */
static PetscErrorCode SuperelementSkewness(Mat A, PetscReal *part, PetscBool *half)
{
  PetscReal norm, even, diagonal;
  Vec       d;
  Mat       T;

  PetscFunctionBeginUser;
  PetscCall(MatNorm(A, NORM_FROBENIUS, &norm));
  PetscCall(MatCreateVecs(A, &d, NULL));
  PetscCall(MatGetDiagonal(A, d));
  PetscCall(VecNorm(d, NORM_2, &diagonal));
  PetscCall(VecDestroy(&d));
  PetscCall(MatTranspose(A, MAT_INITIAL_MATRIX, &T));
  PetscCall(MatAXPY(T, 1, A, DIFFERENT_NONZERO_PATTERN));
  PetscCall(MatNorm(T, NORM_FROBENIUS, &even));
  PetscCall(MatAXPY(T, -2, A, SUBSET_NONZERO_PATTERN)); /* A' - A */
  PetscCall(MatNorm(T, NORM_FROBENIUS, part));
  PetscCall(MatDestroy(&T));
  even  = PetscSqrtReal(PetscMax(0, even * even - 4 * diagonal * diagonal));
  *half = *part > 0 && PetscAbsReal(even - *part) <= SUPERELEMENT_EVEN * norm ? PETSC_TRUE : PETSC_FALSE;
  *part = norm > 0 ? *part / norm : 0;
  PetscFunctionReturn(0);
}

PetscErrorCode SuperelementSplit(Mat A, Mat *even, Mat *odd)
{
  PetscReal part;
  PetscBool half;
  Mat       T;

  PetscFunctionBeginUser;
  *odd = NULL;
  PetscCall(SuperelementSkewness(A, &part, &half));
  if (part <= SUPERELEMENT_EVEN) {
    PetscCall(PetscObjectReference((PetscObject)A));
    *even = A;
    PetscFunctionReturn(0);
  }
  PetscCall(MatTranspose(A, MAT_INITIAL_MATRIX, &T));
  PetscCall(MatDuplicate(A, MAT_COPY_VALUES, even));
  PetscCall(MatAXPY(*even, 1, T, DIFFERENT_NONZERO_PATTERN));
  PetscCall(MatScale(*even, 0.5));
  PetscCall(MatDuplicate(A, MAT_COPY_VALUES, odd));
  PetscCall(MatAXPY(*odd, -1, T, DIFFERENT_NONZERO_PATTERN));
  PetscCall(MatScale(*odd, 0.5));
  PetscCall(MatDestroy(&T));
  PetscFunctionReturn(0);
}

PetscErrorCode SuperelementCheckEven(const Superelement *s, int i, const char option[], Mat *A)
{
  MPI_Comm        comm = PetscObjectComm((PetscObject)*A);
  const PetscBool may  = s->skew && i != SUPERELEMENT_M ? PETSC_TRUE : PETSC_FALSE;
  PetscReal       part;
  PetscBool       half;
  Mat             even, odd;

  PetscFunctionBeginUser;
  PetscCall(SuperelementSkewness(*A, &part, &half));
  PetscCheck(!may || !half, comm, PETSC_ERR_USER_INPUT, "%s %s holds one half of a matrix: give all of it", option,
             s->file[i]);
  PetscCheck(may || part <= SUPERELEMENT_EVEN || i == SUPERELEMENT_M, comm, PETSC_ERR_USER_INPUT,
             "%s %s differs by %.2g of its norm from its transpose: where that is of friction or of a spin, -%s_skew "
             "keeps it in modes, sweeps and frf; where the file holds half of it, give all of it",
             option, s->file[i], (double)part, s->name);
  PetscCheck(may || part <= SUPERELEMENT_EVEN, comm, PETSC_ERR_USER_INPUT,
             "%s %s differs by %.2g of its norm from its transpose, and a mass is symmetric; where the file holds half of "
             "it, give all of it",
             option, s->file[i], (double)part);
  if (may && part > SUPERELEMENT_EVEN) PetscFunctionReturn(0);
  PetscCall(MatTranspose(*A, MAT_INITIAL_MATRIX, &odd));
  PetscCall(MatDuplicate(*A, MAT_COPY_VALUES, &even));
  PetscCall(MatAXPY(even, 1, odd, DIFFERENT_NONZERO_PATTERN));
  PetscCall(MatScale(even, 0.5));
  PetscCall(MatDestroy(&odd));
  PetscCall(MatDestroy(A));
  *A = even;
  PetscFunctionReturn(0);
}

PetscErrorCode OperatorsCheckEven(Operators o, PetscBool damping, const char what[])
{
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < o->n_superelements + o->n_pieces; k++) {
    const Superelement *s = &o->superelements[k];

    for (int i = 0; i < N_SUPERELEMENT; i++) {
      PetscReal part;
      PetscBool half;

      if (!s->A[i] || !s->skew || (i == SUPERELEMENT_C && !damping)) continue;
      PetscCall(SuperelementSkewness(s->A[i], &part, &half));
      PetscCheck(part <= SUPERELEMENT_EVEN, o->comm, PETSC_ERR_SUP,
                 "%s is not supported with the skew part of -%s_%c, which modes, sweeps and frf have: take -%s_skew and "
                 "that part away",
                 what, s->name, "kmc"[i], s->name);
    }
  }
  PetscFunctionReturn(0);
}
