/* Private to operators/: lists of terms, their sums, and lists of parameters */
#pragma once

#include <squeal/pencil.h>

typedef struct {
  PetscInt       n;
  OperatorsTerm *term; /* each holds a reference of its matrix */
} Terms;

/* Which terms of a kind make a sum */
typedef enum { TERMS_ALL, TERMS_SYMMETRIC, TERMS_UNSYMMETRIC } TermsChoice;

/* scale sum_t c_t(p) A_t of the chosen terms of a kind */
typedef struct {
  OperatorsTermKind kind;
  TermsChoice       choice;
  PetscReal         scale;
} TermsSumKind;

/* Such a sum; its pattern is the union of those terms that it has been formed from */
typedef struct {
  Mat        A;       /* NULL when all coefficients are zero */
  PetscBool *has;     /* [terms] whether the pattern covers the term */
  PetscReal *c;       /* [terms] coefficients that it was formed with */
  PetscBool  current; /* formed at the present point, where its owner has one */
} TermsSum;

/* terms.c - adds A (one more reference) with a product of n parameters for coefficient, whose powers may be changed
   after; adds copies of all terms of another list; whether all coefficients of the chosen terms, of the mass or of all
   kinds, are zero at p */
PETSC_INTERN PetscErrorCode TermsAdd(Terms *terms, OperatorsTermKind kind, Mat A, PetscBool symmetric, PetscInt n,
                                     const PetscInt parameter[]);
/* Names what the last term may make modes grow by: kind, and the option <owner>_<what>, or <what> alone where owner is
   NULL */
PETSC_INTERN PetscErrorCode TermsSetCause(Terms *terms, const char kind[], const char owner[], const char what[]);
/* Gives the factors of the last term powers that are not 1 */
PETSC_INTERN PetscErrorCode TermsSetPowers(Terms *terms, const PetscInt power[]);
/* Tells that the last term is left' right, a row for each pair of an interface in one group */
PETSC_INTERN PetscErrorCode TermsSetFactors(Terms *terms, Mat left, Mat right, PetscInt interface, PetscInt group);
/* Makes factor i of the last term the friction coefficient, or its slope */
PETSC_INTERN PetscErrorCode TermsSetFriction(Terms *terms, PetscInt i, const OperatorsFriction *friction,
                                             PetscBool slope);
PETSC_INTERN PetscErrorCode TermsAppend(Terms *terms, const Terms *more);
PETSC_INTERN PetscBool TermsVanish(const Terms *terms, TermsChoice choice, PetscBool mass_only, const PetscReal p[]);
PETSC_INTERN PetscErrorCode TermsDestroy(Terms *terms);
/* Destroys the matrices of a list, which otherwise stays */
PETSC_INTERN PetscErrorCode TermsRelease(Terms *terms);
/* friction.c - scale L' W R with W = diag(weights), or the identity where weights is NULL */
PETSC_INTERN PetscErrorCode TermsProduct(PetscReal scale, Mat L, Vec weights, Mat R, Mat *A);

/* frictionfactor.c - mu, or mu', at p; its derivative by a parameter, 0 where it does not depend on it; whether it
   does */
PETSC_INTERN PetscReal FrictionFactorValue(const OperatorsFriction *friction, PetscBool slope, const PetscReal p[]);
PETSC_INTERN PetscReal FrictionFactorDerivative(const OperatorsFriction *friction, PetscBool slope, const PetscReal p[],
                                                PetscInt parameter);
PETSC_INTERN PetscBool FrictionFactorDepends(const OperatorsFriction *friction, PetscInt parameter);

/* law.c - the factor of a law in a term of K or C, 1 without one; its derivative by a parameter; whether it depends */
/* What K and i w C have of G at the reference w, Pa */
PETSC_INTERN PetscComplex TermLawModulus(const OperatorsTerm *term, const PetscReal p[]);
PETSC_INTERN PetscReal    TermLaw(const OperatorsTerm *term, const PetscReal p[]);
PETSC_INTERN PetscReal    TermLawDerivative(const OperatorsTerm *term, const PetscReal p[], PetscInt parameter);
PETSC_INTERN PetscBool    TermLawDepends(const OperatorsTerm *term, PetscInt parameter);
/* A law at the values of p; G and its derivatives at lambda, and of these by one parameter */
PETSC_INTERN void OperatorsLawAt(const OperatorsLaw *law, const PetscReal p[], PetscComplex lambda, ViscoelasticAt *at);
PETSC_INTERN Viscoelastic OperatorsLawValues(const OperatorsLaw *law, const PetscReal p[]);
PETSC_INTERN PetscComplex OperatorsLawDerivative(const OperatorsLaw *law, const ViscoelasticAt *at, PetscInt parameter);

/* sum.c - forms a sum at p: values in place where the pattern allows, nothing where the coefficients are the same */
PETSC_INTERN PetscErrorCode TermsSumForm(const Terms *terms, const TermsSumKind *kind, const PetscReal p[],
                                         TermsSum *sum);
/* sum = sum_t c_t A_t, c [terms] */
PETSC_INTERN PetscErrorCode TermsSumAdd(const Terms *terms, const PetscReal c[], TermsSum *sum);
PETSC_INTERN PetscErrorCode TermsSumDestroy(TermsSum *sum);

/* factors.c - the sum of the unsymmetric stiffness at p as a product, left' right, the pairs of all terms below one
   another; NULL where a term of it has no such factors */
PETSC_INTERN PetscErrorCode TermsFormFactors(const Terms *terms, const PetscReal p[], Mat *left, Mat *right);

/* Parameters and a point of them */
typedef struct {
  PetscInt            n;
  OperatorsParameter *list;
  PetscReal          *p; /* [n] */
} Parameters;

/* parameter.c - adds the parameter <owner>_<what> with value and marks of `like`, unit and limits of its row; all of
   another list, as they are; how far a group of pairs is closed, 0 to 1; raises the error for a value outside its
   limits */
PETSC_INTERN PetscErrorCode ParametersAdd(Parameters *parameters, const char owner[], const char what[],
                                          const OperatorsParameter *like, PetscInt *index);
PETSC_INTERN PetscErrorCode ParametersTake(Parameters *parameters, const Parameters *from);
PETSC_INTERN PetscErrorCode ParametersAddShare(Parameters *parameters, const char name[]);
PETSC_INTERN PetscInt       ParametersFind(const Parameters *parameters, const char name[]); /* index, or -1 */
PETSC_INTERN PetscErrorCode ParameterCheck(MPI_Comm comm, const OperatorsParameter *parameter, PetscReal value);
PETSC_INTERN PetscErrorCode ParametersDestroy(Parameters *parameters);
