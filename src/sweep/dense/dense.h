/* Private to sweep/: small dense problems by LAPACK. Matrices are column-major, [n * n] unless stated. */
#pragma once

#include <petscsys.h>
#include <complex.h>

/* dense.c - LU factors in place of A; singular (may be NULL: then an error) = a pivot is zero */
PetscErrorCode DenseFactor(PetscInt n, PetscReal A[], PetscBLASInt pivot[], PetscBool *singular);
/* B := op(A)^-1 B from the factors, B [m][n] */
PetscErrorCode DenseSolve(PetscInt n, const PetscReal LU[], const PetscBLASInt pivot[], PetscBool transposed,
                          PetscInt m, PetscReal B[]);
/* The same for complex matrices */
PetscErrorCode ComplexFactor(PetscInt n, PetscComplex A[], PetscBLASInt pivot[], PetscBool *singular);
PetscErrorCode ComplexSolve(PetscInt n, const PetscComplex LU[], const PetscBLASInt pivot[], PetscBool transposed,
                            PetscInt m, PetscComplex B[]);
/* Eigenvalues wr + i wi of A (overwritten), right vectors R and left ones L in LAPACK's real storage, u^H A = w u^H */
PetscErrorCode DenseEigen(PetscInt n, PetscReal A[], PetscReal wr[], PetscReal wi[], PetscReal L[], PetscReal R[]);
/* A x = w B x, A symmetric, B positive definite (else *definite is false): w ascending, vectors in place of A */
PetscErrorCode DenseSymmetricEigen(PetscInt n, PetscReal A[], PetscReal B[], PetscReal w[], PetscBool *definite);
/* Eigenvalues of A x = w B x, both overwritten; infinite ones are returned as infinity */
PetscErrorCode ComplexEigenvalues(PetscInt n, PetscComplex A[], PetscComplex B[], PetscComplex w[]);
/* Y = op(A) X for the leading block op(A) [rows][columns] of A (column stride lda), X [m][columns], Y [m][rows] */
PetscErrorCode DenseTimes(PetscInt rows, PetscInt columns, const PetscReal A[], PetscInt lda, PetscBool transposed,
                          PetscInt m, const PetscComplex X[], PetscComplex Y[]);
/* x^T y without conjugation */
PetscComplex DenseDot(PetscInt n, const PetscComplex x[], const PetscComplex y[]);
/* Orthonormal basis of the columns of X [m][n]; *kept of them exceed drop, the others are left at the end as zeros */
PetscErrorCode ComplexOrthonormalise(PetscInt n, PetscInt m, PetscReal drop, PetscComplex X[], PetscInt *kept);
/* Replaces the m vectors X [m][n] by *kept <= m real orthonormal ones that span the same space */
PetscErrorCode ComplexRealSpan(PetscInt n, PetscInt m, PetscReal drop, PetscComplex X[], PetscInt *kept);
