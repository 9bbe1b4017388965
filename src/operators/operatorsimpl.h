/* Private to operators/: the record of the matrices */
#pragma once

#include <squeal/operators.h>

/* The four matrices, in the order of their option names */
typedef enum { OPERATOR_K, OPERATOR_M, OPERATOR_C, OPERATOR_H, N_OPERATORS } OperatorKind;

struct _p_Operators {
  MPI_Comm comm;
  Model    model; /* NULL for loaded or dense matrices */
  Contact  contact;
  /* set by options */
  char       load[N_OPERATORS][PETSC_MAX_PATH_LEN], save[PETSC_MAX_PATH_LEN];
  PetscReal *dense[N_OPERATORS];
  PetscInt   n_dense[N_OPERATORS];
  PetscBool  lump;
  /* built by OperatorsSetUp() */
  Mat             A[N_OPERATORS]; /* C and H may be NULL */
  PetscReal       mu;
  Mat             Zr, Zl;    /* right and left null spaces of the constraints; NULL without constraints */
  PetscBool       symmetric; /* K, M and C are symmetric; always true for a model */
  OperatorsPencil pencil, frictionless;
};

/* assemble.c - K, M, C of the bodies, springs and dashpots */
PETSC_INTERN PetscErrorCode OperatorsAssemble(Operators operators);

/* pattern.c - empty matrix of all unknowns, preallocated for the couplings of all cells */
PETSC_INTERN PetscErrorCode PatternCreate(Model model, Mat *A);

/* friction.c - adds the contact's part to K and C, makes H */
PETSC_INTERN PetscErrorCode OperatorsAddContact(Operators operators);

/* constraint.c - null spaces of the interfaces that obey the exact constraint */
PETSC_INTERN PetscErrorCode OperatorsCreateNullSpaces(Operators operators);

/* load.c - matrices from files and options, and to files */
PETSC_INTERN PetscErrorCode OperatorsLoadFromOptions(Operators operators, PetscOptionItems *PetscOptionsObject);
PETSC_INTERN PetscErrorCode OperatorsLoad(Operators operators);
PETSC_INTERN PetscErrorCode OperatorsSave(Operators operators);
