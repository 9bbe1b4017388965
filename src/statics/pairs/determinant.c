/*
   The sign of the determinant of the small system where that is not dense. With w = G u, l = P z and w = Q z of all
   pairs

      | K_a   kappa (G'(P - Q) - S' D P) | | u |
      | -G                 Q             | | z |

   has the small system Q + (W - V D) P - W Q as its Schur complement, and K_a is positive: both determinants have one
   sign. Where u = Z q stand Z'K_a Z, Z'G', Z'S' and G Z. MUMPS' LU of the whole tells it.
*/
#include "statics/staticsimpl.h"
#include "solver/factor/shiftinvert.h"

/* Percent of workspace beyond MUMPS' estimate: at first, and before it is given up */
#define DETERMINANT_SPACE 50
/* percent: 51 times the estimate */
#define DETERMINANT_MOST 5000

/* One factor of the laws as a matrix of all rows: a (P - Q), a P of sliding pairs, or a Q */
typedef enum { LAW_DIFFERENCE, LAW_SLIDE, LAW_DISPLACEMENT } LawFactor;

/* One factor of the laws as a matrix of all rows, blocks of a pair's 1 or 3 on its diagonal: kappa (P - Q) or -kappa
   friction D P (N/m), or Q */
static PetscErrorCode LawMatrix(const SmallSystem *s, LawFactor which, Mat *A)
{
  const PairRows *rows = s->compliance->rows;

  PetscFunctionBeginUser;
  PetscCall(MatCreateAIJ(rows->comm, rows->n, rows->n, PETSC_DETERMINE, PETSC_DETERMINE, 3, NULL, 0, NULL, A));
  for (PetscInt i = 0; i < rows->n; i++) {
    const LawRow *law = &s->law[i];

    for (PetscInt k = 0; k < law->d; k++) {
      const PetscReal P = law->P[k], Q = law->Q[k];
      const PetscReal value = which == LAW_DISPLACEMENT ? Q
                              : which == LAW_SLIDE      ? -s->compliance->kappa * s->friction * law->slide * P
                                                        : s->compliance->kappa * (P - Q);

      PetscCall(MatSetValue(*A, rows->begin + i, law->first + k, value, INSERT_VALUES));
    }
  }
  PetscCall(MatAssemblyBegin(*A, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(*A, MAT_FINAL_ASSEMBLY));
  PetscFunctionReturn(0);
}

/* kappa (G'(P - Q) - S' D P) */
static PetscErrorCode ForceMatrix(const SmallSystem *s, Mat *B)
{
  const PairRows *rows = s->compliance->rows;
  Mat             law, slide;

  PetscFunctionBeginUser;
  PetscCall(LawMatrix(s, LAW_DIFFERENCE, &law));
  PetscCall(MatTransposeMatMult(rows->G, law, MAT_INITIAL_MATRIX, PETSC_DEFAULT, B));
  PetscCall(MatDestroy(&law));
  if (!rows->S) PetscFunctionReturn(0);
  PetscCall(LawMatrix(s, LAW_SLIDE, &law));
  PetscCall(MatTransposeMatMult(rows->S, law, MAT_INITIAL_MATRIX, PETSC_DEFAULT, &slide));
  PetscCall(MatAXPY(*B, 1, slide, DIFFERENT_NONZERO_PATTERN));
  PetscCall(MatDestroy(&slide));
  PetscCall(MatDestroy(&law));
  PetscFunctionReturn(0);
}

/* Z' times the forces of pairs and their displacements times Z in their place */
static PetscErrorCode ProjectBlocks(Mat Z, Mat block[4])
{
  Mat force, rows;

  PetscFunctionBeginUser;
  PetscCall(MatTransposeMatMult(Z, block[1], MAT_INITIAL_MATRIX, PETSC_DEFAULT, &force));
  PetscCall(MatMatMult(block[2], Z, MAT_INITIAL_MATRIX, PETSC_DEFAULT, &rows));
  for (int i = 1; i < 3; i++) PetscCall(MatDestroy(&block[i]));
  block[1] = force;
  block[2] = rows;
  PetscFunctionReturn(0);
}

/* Factors A with a percentage of extra workspace and takes the sign of its determinant, which a singular matrix has
   not: pairs share a force. MUMPS: ICNTL(33) = 1 computes the determinant, whose mantissa is RINFOG(12) (the exponent
   in INFOG(34) is not needed); ICNTL(14) is the percentage; ICNTL(24) = 1 finds null pivots, INFOG(28) counts them.
   reason is INFOG(1); percent becomes that of another try, 0 for none. */
static PetscErrorCode DeterminantTry(Mat A, PetscInt *percent, PetscInt *reason, PetscBool *negative)
{
  MatFactorInfo info;
  PetscReal     mantissa;
  PetscInt      n_null;
  IS            rows, columns;
  Mat           F;

  PetscFunctionBeginUser;
  PetscCall(MatFactorInfoInitialize(&info));
  PetscCall(MatGetOrdering(A, MATORDERINGEXTERNAL, &rows, &columns));
  PetscCall(MatGetFactor(A, MATSOLVERMUMPS, MAT_FACTOR_LU, &F));
  PetscCall(MatMumpsSetIcntl(F, 33, 1));
  PetscCall(MatMumpsSetIcntl(F, 14, *percent));
  PetscCall(MatMumpsSetIcntl(F, 24, 1));
  PetscCall(MatLUFactorSymbolic(F, A, rows, columns, &info));
  PetscCall(MatLUFactorNumeric(F, A, &info));
  PetscCall(MatMumpsGetInfog(F, 1, reason));
  PetscCall(MatMumpsGetInfog(F, 28, &n_null));
  PetscCall(MatMumpsGetRinfog(F, 12, &mantissa));
  PetscCall(FactorWantsSpace(F, NULL, DETERMINANT_MOST, percent));
  *negative = mantissa < 0 && !n_null ? PETSC_TRUE : PETSC_FALSE;
  PetscCall(ISDestroy(&rows));
  PetscCall(ISDestroy(&columns));
  PetscCall(MatDestroy(&F));
  PetscFunctionReturn(0);
}

/* Rows without a stiffness of their own delay pivots by more than MUMPS foresees: then with more room */
static PetscErrorCode DeterminantSign(Mat A, PetscInt *n_factored, PetscBool *negative)
{
  PetscInt reason, percent = DETERMINANT_SPACE;

  PetscFunctionBeginUser;
  do {
    PetscCall(DeterminantTry(A, &percent, &reason, negative));
    (*n_factored)++;
  } while (percent > 0);
  PetscCheck(reason >= 0 || reason == -10, PetscObjectComm((PetscObject)A), PETSC_ERR_NOT_CONVERGED,
             "whether the bodies jam cannot be said: MUMPS' factorisation failed (INFOG(1) = %" PetscInt_FMT
             "); raise -static_dense to the number of rows",
             reason);
  PetscFunctionReturn(0);
}

PetscErrorCode SmallIsReversed(const SmallSystem *s, PetscInt *n_factored, PetscBool *reversed)
{
  Mat block[4], nest, whole;

  PetscFunctionBeginUser;
  PetscCall(KSPGetOperators(s->compliance->inverse.ksp, &block[0], NULL));
  PetscCall(ForceMatrix(s, &block[1]));
  PetscCall(MatDuplicate(s->compliance->rows->G, MAT_COPY_VALUES, &block[2]));
  PetscCall(MatScale(block[2], -1));
  if (s->compliance->Z) PetscCall(ProjectBlocks(s->compliance->Z, block));
  PetscCall(LawMatrix(s, LAW_DISPLACEMENT, &block[3]));
  PetscCall(MatCreateNest(s->compliance->rows->comm, 2, NULL, 2, NULL, block, &nest));
  PetscCall(MatConvert(nest, MATAIJ, MAT_INITIAL_MATRIX, &whole));
  PetscCall(DeterminantSign(whole, n_factored, reversed));
  PetscCall(MatDestroy(&whole));
  PetscCall(MatDestroy(&nest));
  for (int i = 1; i < 4; i++) PetscCall(MatDestroy(&block[i]));
  PetscFunctionReturn(0);
}
