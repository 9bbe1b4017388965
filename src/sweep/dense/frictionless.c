/*
   The frictionless, undamped system among the values of the parameters: what friction and damping are proportional to
   (mu, alpha, beta, viscosity, ...) is set to zero.
*/
#include "reduced.h"

/* Whether a term belongs to the frictionless, undamped system */
static PetscBool TermStays(const OperatorsTerm *term)
{
  return term->symmetric && term->kind != OPERATORS_DAMPING ? PETSC_TRUE : PETSC_FALSE;
}

/* Whether a term of the frictionless system contains the parameter */
static PetscBool ParameterStays(const Reduced *reduced, PetscInt parameter)
{
  for (PetscInt t = 0; t < reduced->n_terms; t++) {
    const OperatorsTerm *term = &reduced->term[t];

    for (PetscInt k = 0; k < term->n && TermStays(term); k++)
      if (term->factor[k].parameter == parameter) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

PetscBool ReducedFrictionless(const Reduced *reduced, PetscReal p[])
{
  for (PetscInt t = 0; t < reduced->n_terms; t++) {
    const OperatorsTerm *term = &reduced->term[t];

    if (TermStays(term)) continue;
    for (PetscInt k = 0; k < term->n; k++)
      if (term->factor[k].power > 0 && !ParameterStays(reduced, term->factor[k].parameter))
        p[term->factor[k].parameter] = 0;
    if (OperatorsTermCoefficient(term, p) != 0) return PETSC_FALSE;
  }
  return PETSC_TRUE;
}
