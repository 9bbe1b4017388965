/* Private to operators/: the record of the terms, the parameters and the sums of terms */
#pragma once

#include <squeal/operators.h>
#include <squeal/options.h>

/* The four matrices, in the order of their option names */
typedef enum { OPERATOR_K, OPERATOR_M, OPERATOR_C, OPERATOR_H, N_OPERATORS } OperatorKind;

/* Parameters of each part; they come first and in this order */
typedef enum { PART_YOUNG, PART_DENSITY, PART_ALPHA, PART_BETA, N_PART_PARAMETERS } PartParameter;

typedef struct {
  PetscInt       n;
  OperatorsTerm *term; /* each holds a reference of its matrix */
} Terms;

/* Which terms of a kind make a sum */
typedef enum { TERMS_ALL, TERMS_SYMMETRIC, TERMS_UNSYMMETRIC } TermsChoice;

/* sum_t scale c_t(p) A_t; its pattern is the union of those terms that it has been formed from */
typedef struct {
  Mat        A;       /* NULL when all coefficients are zero */
  PetscBool *has;     /* [terms] whether the pattern covers the term */
  PetscReal *c;       /* [terms] coefficients that it was formed with */
  PetscBool  current; /* formed at the present values */
} TermsSum;

/* Sums in all unknowns, BODIES the stiffness without contact, K symmetric and H = unsymmetric / mu; then those in the
   unknowns of the pencil, PROJECTED from the symmetric terms, PENCIL from all */
typedef enum {
  SUM_BODIES,
  SUM_K,
  SUM_M,
  SUM_C,
  SUM_H,
  PROJECTED_K,
  PROJECTED_M,
  PENCIL_K,
  PENCIL_M,
  PENCIL_C,
  N_SUMS
} SumKind;

/* Indices of the parameters of an interface, -1 where there is none */
typedef struct {
  PetscInt mu; /* none where nothing says along what it slides */
  PetscInt kn, slope, force, speed;
} InterfaceParameters;

struct _p_Operators {
  MPI_Comm comm;
  Model    model; /* NULL for loaded or dense matrices */
  Contact  contact;
  /* set by options */
  char       load[N_OPERATORS][PETSC_MAX_PATH_LEN], save[PETSC_MAX_PATH_LEN];
  PetscReal *dense[N_OPERATORS];
  PetscInt   n_dense[N_OPERATORS];
  PetscBool  lump;
  PetscReal  loaded_mu; /* -contact_mu of loaded or dense matrices */
  /* built by OperatorsSetUp() */
  PetscInt             n_parameters;
  OperatorsParameter  *parameter;
  PetscReal           *p;         /* [n_parameters] the present values once more */
  PetscInt             n_mu, *mu; /* parameters that are friction coefficients */
  PetscInt             n_scene;   /* parameters that are options of the scene; the internal ones follow */
  InterfaceParameters *interface; /* of each interface */
  Terms                base;      /* in all unknowns: those of the bodies, of the contact, of the preload */
  PetscInt             n_body_terms;
  PetscBool            symmetric; /* K, M and C are symmetric without friction; always true for a model */
  /* set by OperatorsSetClosed() and OperatorsSetPreload() */
  PetscInt  n_groups;
  PetscInt *group;               /* [local pairs] -1 open, 0 closed, else a group; NULL for all closed */
  Mat       geometric, follower; /* NULL for none */
  /* built when asked for */
  PetscBool constrained; /* the null spaces are those of the closed pairs */
  Mat       Zr, E;       /* right null space of the constraints and its injection; NULL without constraints */
  PetscInt  n_left;      /* Zl = Zr + sum_i p[left_mu[i]] left[i] */
  Mat      *left;
  PetscInt *left_mu;
  Terms     projected; /* in the unknowns of the pencil; empty without constraints, then base serves */
  TermsSum  sum[N_SUMS];
};

/* parameter.c - adds a parameter with its present value; lower itself is a value where `closed`; the last one is the
   status of a group of pairs, from 0, open, to 1, closed */
PETSC_INTERN PetscErrorCode ParameterAdd(Operators operators, const char owner[], const char what[], const char unit[],
                                         PetscReal value, PetscReal lower, PetscBool closed, PetscInt *index);
PETSC_INTERN PetscErrorCode ParameterAddMu(Operators operators, const char owner[], PetscReal value, PetscInt *index);
PETSC_INTERN PetscErrorCode ParameterAddClosed(Operators operators, PetscInt group);

/* parameter.c - the friction coefficient of largest absolute value, 0 without any */
PETSC_INTERN PetscReal OperatorsLargestMu(Operators operators);

/* terms.c - adds A (one more reference) with a product of n parameters for coefficient, whose powers may be changed
   after; whether all coefficients of the chosen terms, of the mass or of all kinds, are zero at p */
PETSC_INTERN PetscErrorCode TermsAdd(Terms *terms, OperatorsTermKind kind, Mat A, PetscBool symmetric, PetscInt n,
                                     const PetscInt parameter[]);
PETSC_INTERN PetscBool TermsVanish(const Terms *terms, TermsChoice choice, PetscBool mass_only, const PetscReal p[]);
PETSC_INTERN PetscErrorCode TermsTruncate(Terms *terms, PetscInt n);
PETSC_INTERN PetscErrorCode TermsDestroy(Terms *terms);

/* sum.c - forms the sum of the chosen terms of a kind at p: values in place where the pattern allows */
PETSC_INTERN PetscErrorCode TermsSumForm(const Terms *terms, OperatorsTermKind kind, TermsChoice choice,
                                         PetscReal scale, const PetscReal p[], TermsSum *sum);
PETSC_INTERN PetscErrorCode TermsSumDestroy(TermsSum *sum);

/* assemble.c - terms of the bodies, springs and dashpots */
PETSC_INTERN PetscErrorCode OperatorsAssemble(Operators operators);

/* pattern.c - empty matrix of all unknowns, preallocated for the couplings of the cells of one part */
PETSC_INTERN PetscErrorCode PatternCreate(Model model, PetscInt part, Mat *A);

/* friction.c - parameters of the contact, and terms of its closed pairs; raises an error where the scene does not say
   what sliding state the pencil would be linearised about */
PETSC_INTERN PetscErrorCode OperatorsAddContactParameters(Operators operators);
PETSC_INTERN PetscErrorCode OperatorsAddContact(Operators operators);
PETSC_INTERN PetscErrorCode OperatorsCheckLinear(Operators operators);

/* closed.c - group of a local pair: -1 open, 0 closed, else closed as far as a parameter says */
PETSC_INTERN PetscInt OperatorsPairGroup(Operators operators, PetscInt pair);

/* constraint.c - null spaces of the closed pairs that obey the exact constraint, and terms between them, where they are
   not there yet */
PETSC_INTERN PetscErrorCode OperatorsCreateNullSpaces(Operators operators);
PETSC_INTERN PetscErrorCode OperatorsProjectTerms(Operators operators);
PETSC_INTERN PetscErrorCode OperatorsDestroyNullSpaces(Operators operators);

/* load.c - matrices from files and options, and to files */
PETSC_INTERN PetscErrorCode OperatorsLoadFromOptions(Operators operators, OptionsItems PetscOptionsObject);
PETSC_INTERN PetscErrorCode OperatorsLoad(Operators operators);
