/* Small dense problems by LAPACK, alike on every rank that calls. Matrices are column-major, [n * n] unless stated. */
#pragma once

#include <petscsys.h>
#include <complex.h>

/* dense.c - LU factors in place of A; singular (may be NULL: then an error) = a pivot is zero */
PetscErrorCode DenseFactor(PetscInt n, PetscReal A[], PetscBLASInt pivot[], PetscBool *singular);
/* Rows and columns of a semidefinite symmetric A (overwritten) of which all others are combinations, but for a rest of
   `tolerance` on the diagonal: chosen [n], `rank` of them */
PetscErrorCode DenseChoose(PetscInt n, PetscReal A[], PetscReal tolerance, PetscInt *rank, PetscInt chosen[]);
/* B := op(A)^-1 B from the factors, B [m][n] */
PetscErrorCode DenseSolve(PetscInt n, const PetscReal LU[], const PetscBLASInt pivot[], PetscBool transposed,
                          PetscInt m, PetscReal B[]);
/* B := A^-1 B, B [m][n]; A overwritten. singular as above: then B is no solution */
PetscErrorCode DenseSolveWith(PetscInt n, PetscReal A[], PetscInt m, PetscReal B[], PetscBool *singular);
/* The least x of those with the least |A x - b|, in place of b; A [columns][rows] is overwritten, b has room for both.
   Singular values below rcond of the largest are none; rank = how many are left, -1 where LAPACK does not
   converge, which is an error without it */
PetscErrorCode DenseLeast(PetscInt rows, PetscInt columns, PetscReal A[], PetscReal b[], PetscReal rcond,
                          PetscInt *rank);
/* The same for complex matrices */
PetscErrorCode DenseComplexFactor(PetscInt n, PetscComplex A[], PetscBLASInt pivot[], PetscBool *singular);
PetscErrorCode DenseComplexSolve(PetscInt n, const PetscComplex LU[], const PetscBLASInt pivot[], PetscBool transposed,
                                 PetscInt m, PetscComplex B[]);
/* Eigenvalues wr + i wi of A (overwritten), right vectors R and left ones L in LAPACK's real storage, u^H A = w u^H;
   NULL for not */
PetscErrorCode DenseEigen(PetscInt n, PetscReal A[], PetscReal wr[], PetscReal wi[], PetscReal L[], PetscReal R[]);
/* The same of a complex matrix, both vectors or none */
PetscErrorCode DenseComplexEigen(PetscInt n, PetscComplex A[], PetscComplex w[], PetscComplex L[], PetscComplex R[]);
/* A x = w B x, A symmetric, B positive definite (else *definite is false) or NULL for the identity: w ascending,
   vectors in place of A */
PetscErrorCode DenseSymmetricEigen(PetscInt n, PetscReal A[], PetscReal B[], PetscReal w[], PetscBool *definite);
/* Eigenvalues of A x = w B x, both overwritten; infinite ones are returned as infinity */
PetscErrorCode DenseComplexEigenvalues(PetscInt n, PetscComplex A[], PetscComplex B[], PetscComplex w[]);
/* C [columns][rows] = a_i^T b_j, without conjugation, of vectors A [rows][n] and B [columns][n] */
PetscErrorCode DenseComplexProducts(PetscInt n, PetscInt rows, const PetscComplex A[], PetscInt columns,
                                    const PetscComplex B[], PetscComplex C[]);
/* A block of a matrix whose columns are stride apart; op(A) has rows x columns entries */
typedef struct {
  const PetscReal *A;
  PetscInt         rows, columns, stride;
} DenseBlock;
/* Y = op(A) X, X [m][columns], Y [m][rows] */
PetscErrorCode DenseTimes(const DenseBlock *block, PetscBool transposed, PetscInt m, const PetscComplex X[],
                          PetscComplex Y[]);
/* Y [m][rows] -= op(A) X, X [m][columns] */
PetscErrorCode DenseSubtract(DenseBlock A, PetscBool transposed, PetscInt m, const PetscReal X[], PetscReal Y[]);
/* The entries of a block, or of its transpose, side by side */
void DenseBlockGet(DenseBlock block, PetscBool transposed, PetscReal entries[]);
/* x^H E x of m vectors X [m][n], E real and symmetric */
PetscErrorCode DenseEnergies(PetscInt n, const PetscReal E[], PetscInt m, const PetscComplex X[], PetscReal energy[]);
/* Real parts, then imaginary parts [2 n] of x [n], and back */
void DenseSplit(PetscInt n, const PetscComplex x[], PetscReal parts[]);
void DenseUnite(PetscInt n, const PetscReal parts[], PetscComplex x[]);
/* x^T y without conjugation */
PetscComplex DenseDot(PetscInt n, const PetscComplex x[], const PetscComplex y[]);
/* Orthonormal basis of the columns of X [m][n]; *kept of them exceed drop times the longest, the others are left at the
   end as zeros */
PetscErrorCode DenseOrthonormalise(PetscInt n, PetscInt m, PetscReal drop, PetscComplex X[], PetscInt *kept);
/* Replaces the m vectors X [m][n], whatever their lengths, by *kept <= m real orthonormal ones that span the same space
   within drop */
PetscErrorCode DenseRealSpan(PetscInt n, PetscInt m, PetscReal drop, PetscComplex X[], PetscInt *kept);
