/*
   Derivatives of the pencil by its parameters, between a left and a right vector. With Q = sum_t c_t(p) lambda^k_t
   A_t, k = 0, 1, 2 for a term of K, C, M,

      y' (dQ / dp_j) x = sum_t (dc_t / dp_j) lambda^k_t y' A_t x

   so that one product with each term serves all parameters; of a law of a material c(p) G(lambda; p) in place of c
   lambda^k.
*/
#include "products.h"
#include <complex.h>

/* d (c G(lambda)) / dp_j */
static PetscComplex LawDerivative(const OperatorsTerm *term, const PetscReal p[], PetscComplex lambda, PetscInt j)
{
  OperatorsTerm  plain = *term;
  ViscoelasticAt at;

  plain.law = NULL;
  OperatorsLawAt(term->law, p, lambda, &at);
  return OperatorsTermDerivative(&plain, p, j) * at.modulus +
         OperatorsTermCoefficient(&plain, p) * OperatorsLawDerivative(term->law, &at, j);
}

PetscErrorCode PencilMeasureDerivatives(Pencil pencil, PetscReal sigma, PetscReal omega, const PencilVectors *v,
                                        PetscComplex derivative[])
{
  const PetscComplex lambda   = CMPLX(sigma, omega);
  const PetscComplex powers[] = {
    [OPERATORS_STIFFNESS] = 1, [OPERATORS_DAMPING] = lambda, [OPERATORS_MASS] = lambda * lambda};
  const OperatorsTerm *term;
  const PetscReal     *p;
  PetscInt             n, n_parameters;
  CauseVector          x[2] = {{{v->xr[0], v->xi[0]}, NULL}}, y[2] = {{{v->yr[0], v->yi[0]}, NULL}};
  const int            space = pencil->Zr ? 1 : 0;

  PetscFunctionBeginUser;
  PetscCall(PencilGetTerms(pencil, &n, &term));
  PetscCall(PencilGetParameters(pencil, &n_parameters, NULL, &p));
  PetscCall(PetscArrayzero(derivative, n_parameters));
  PetscCall(VectorRestrict(pencil, &x[0], &x[1]));
  PetscCall(VectorRestrict(pencil, &y[0], &y[1]));
  for (PetscInt t = 0; t < n; t++) {
    PetscComplex product;

    if (!term[t].n && !term[t].law) continue;
    if (term[t].law && term[t].kind == OPERATORS_DAMPING) continue; /* the one of stiffness stands for all of G */
    PetscCall(VectorProduct(&y[space], term[t].A, PETSC_FALSE, &x[space], &product));
    for (PetscInt j = 0; j < n_parameters; j++)
      derivative[j] += (term[t].law ? LawDerivative(&term[t], p, lambda, j)
                                    : OperatorsTermDerivative(&term[t], p, j) * powers[term[t].kind]) *
                       product;
  }
  PetscCall(VectorDestroy(&x[1]));
  PetscCall(VectorDestroy(&y[1]));
  PetscFunctionReturn(0);
}
