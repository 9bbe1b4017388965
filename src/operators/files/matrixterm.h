/* Private to operators/: named matrices of the list -terms, and how matrices without a mesh are read */
#pragma once

#include "operators/operatorsimpl.h"

#define OPERATORS_MAX_DENSE 10000 /* entries of an inline matrix: 100 x 100 */
#define MATRIX_SYMMETRIC    1e-14 /* of the Frobenius norm: entries that differ by no more count as equal */

/* What -<name>_symmetry says of a matrix */
typedef enum { MATRIX_ANY, MATRIX_EVEN, MATRIX_SKEW } MatrixSymmetry;

typedef struct _p_MatrixTerm {
  char             *name; /* the prefix of its options */
  char              file[PETSC_MAX_PATH_LEN];
  PetscReal        *dense; /* [n_dense] entries by rows */
  PetscInt          n_dense;
  OperatorsTermKind kind;
  MatrixSymmetry    symmetry;
  PetscReal         scale;
  PetscInt          n; /* factors */
  char             *parameter[OPERATORS_MAX_FACTORS];
  PetscInt          n_powers, power[8]; /* given; one of each factor */
  char              parameters[512];    /* as they are given */
  PetscBool         has_parameters;
  PetscReal         loss; /* hysteretic loss factor */
  ViscoelasticAsked viscous;
  Viscoelastic      law; /* of a stiffness, moduli in units of the matrix; E = 1 */
  /* read by MatrixTermsAdd() */
  Mat       A;
  PetscBool even; /* A is symmetric */
} MatrixTerm;

/* matrixterm.c - whether |a_ij - a_ji| <= MATRIX_SYMMETRIC |A|, one answer for all ranks: what MatIsSymmetric() finds
   outside of the diagonal blocks it tells each rank by itself. Collective */
PETSC_INTERN PetscErrorCode MatrixIsSymmetric(Mat A, PetscBool *symmetric);

/* matrixterm.c - the parameters and terms; what they are made with, but for the entries; frees the list */
PETSC_INTERN PetscErrorCode MatrixTermsAdd(Operators operators);
PETSC_INTERN PetscErrorCode MatrixTermsAddChecksum(Operators operators, Checksum checksum);
PETSC_INTERN PetscErrorCode MatrixTermsDestroy(Operators operators);

/* matrixtermoptions.c - the list and the options of each name; then the parameters that they name */
PETSC_INTERN PetscErrorCode MatrixTermsSetFromOptions(Operators operators);
/* Shows the rows of the parameters that terms name */
PETSC_INTERN PetscErrorCode MatrixTermsVisitParameters(Operators operators, const QuantityVisitor *visitor);
PETSC_INTERN PetscErrorCode MatrixTermsAddParameters(Operators operators);

/* matrixfile.c - a matrix from a list of all its entries, or from a file, that `option` gives */
PETSC_INTERN PetscErrorCode MatrixReadDense(MPI_Comm comm, const char option[], PetscInt n_values,
                                            const PetscReal values[], Mat *A);
PETSC_INTERN PetscErrorCode MatrixReadFile(MPI_Comm comm, const char option[], const char file[], Mat *A);
