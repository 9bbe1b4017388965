/*
   Q(i omega) z = b with z = v + i w, b = f + i g, in real arithmetic:

      [ K - omega^2 M    -omega C        ] [v]   [ f]
      [ -omega C         omega^2 M - K   ] [w] = [-g],

   of which the transpose is the same of K', C', M': with these symmetric it is symmetric, too, and LDL' will do. This
   is K2 + omega C2 + omega^2 M2 of a real pencil, K2 = diag(K, -K), M2 = diag(-M, M) and C2 with -C off the diagonal.
   Where C is of one part, the copies of the others meet in that part alone, and factors have little more than twice the
   entries of the real ones.
*/
#include "complexshift.h"

/* diag(A, -A), or where `across` says so [0, -A; -A, 0] */
static PetscErrorCode StackCreate(Mat A, PetscBool across, Mat *stack)
{
  Mat less, nest, block[4] = {NULL, NULL, NULL, NULL};

  PetscFunctionBeginUser;
  PetscCall(MatDuplicate(A, MAT_COPY_VALUES, &less));
  PetscCall(MatScale(less, -1));
  if (across)
    block[1] = block[2] = less;
  else
    block[0] = A, block[3] = less;
  PetscCall(MatCreateNest(PetscObjectComm((PetscObject)A), 2, NULL, 2, NULL, block, &nest));
  PetscCall(MatConvert(nest, MATAIJ, MAT_INITIAL_MATRIX, stack));
  PetscCall(MatDestroy(&nest));
  PetscCall(MatDestroy(&less));
  PetscFunctionReturn(0);
}

PetscErrorCode ComplexShiftCreate(const PencilMatrices *pencil, Progress *progress, ComplexShift *c)
{
  PetscFunctionBeginUser;
  *c = (ComplexShift){.factor = {.progress = progress, .even_damped = pencil->symmetric}};
  PetscCall(StackCreate(pencil->K, PETSC_FALSE, &c->matrices.K));
  PetscCall(StackCreate(pencil->C, PETSC_TRUE, &c->matrices.C));
  PetscCall(StackCreate(pencil->M, PETSC_FALSE, &c->matrices.M));
  PetscCall(MatScale(c->matrices.M, -1));
  c->matrices.symmetric = pencil->symmetric;
  PetscFunctionReturn(0);
}

PetscErrorCode ComplexShiftMove(ComplexShift *c, PetscReal omega)
{
  PetscFunctionBeginUser;
  PetscCall(ShiftInvertMove(&c->matrices, omega, &c->factor));
  PetscFunctionReturn(0);
}

/* Columns that are real and imaginary parts in turn one above the other, the lower one times -1; or back */
static PetscErrorCode StackMove(PetscBool back, Mat pairs, Mat stack)
{
  PetscScalar *p, *s;
  PetscInt     n, m, ldp, lds;

  PetscFunctionBeginUser;
  PetscCall(MatGetLocalSize(pairs, &n, NULL));
  PetscCall(MatGetSize(stack, NULL, &m));
  PetscCall(MatDenseGetLDA(pairs, &ldp));
  PetscCall(MatDenseGetLDA(stack, &lds));
  PetscCall(MatDenseGetArray(pairs, &p));
  PetscCall(MatDenseGetArray(stack, &s));
  for (PetscInt j = 0; j < m; j++)
    for (PetscInt i = 0; i < n; i++) {
      PetscScalar *pair = &p[2 * j * ldp + i], *in = &s[j * lds + i];

      if (back)
        pair[0] = in[0], pair[ldp] = in[n];
      else
        in[0] = pair[0], in[n] = -pair[ldp];
    }
  PetscCall(MatDenseRestoreArray(stack, &s));
  PetscCall(MatDenseRestoreArray(pairs, &p));
  PetscFunctionReturn(0);
}

PetscErrorCode ComplexShiftSolve(const ComplexShift *c, PetscBool transposed, Mat B, Mat Z)
{
  PetscInt n, m;
  Mat      b, z;

  PetscFunctionBeginUser;
  PetscCall(MatGetLocalSize(B, &n, NULL));
  PetscCall(MatGetSize(B, NULL, &m));
  PetscCall(MatCreateDense(c->factor.comm, 2 * n, PETSC_DECIDE, PETSC_DETERMINE, m / 2, NULL, &b));
  PetscCall(MatDuplicate(b, MAT_DO_NOT_COPY_VALUES, &z));
  PetscCall(StackMove(PETSC_FALSE, B, b));
  PetscCall(ShiftInvertApplyBlock(&c->factor, transposed, b, z));
  PetscCall(StackMove(PETSC_TRUE, Z, z));
  PetscCall(MatDestroy(&b));
  PetscCall(MatDestroy(&z));
  PetscFunctionReturn(0);
}

PetscErrorCode ComplexShiftDestroy(ComplexShift *c)
{
  PetscFunctionBeginUser;
  PetscCall(MatDestroy(&c->matrices.K));
  PetscCall(MatDestroy(&c->matrices.C));
  PetscCall(MatDestroy(&c->matrices.M));
  PetscCall(ShiftInvertDestroy(&c->factor));
  PetscFunctionReturn(0);
}
