/*
   The frictionless, undamped system among the values of the parameters: what friction and damping are proportional
   to (mu, alpha, beta, viscosity, ...) is set to zero, so that the sum of the terms is a symmetric K and M alone.
   Where some parameter is in a term that stays as well, or a term has no parameter, it cannot be turned off.
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
  for (PetscInt t = 0; t < reduced->n_terms; t++)
    if (TermStays(&reduced->term[t]) && OperatorsTermDepends(&reduced->term[t], parameter)) return PETSC_TRUE;
  return PETSC_FALSE;
}

static void ParameterVanish(const Reduced *reduced, PetscInt parameter, PetscReal p[])
{
  if (!ParameterStays(reduced, parameter)) p[parameter] = 0;
}

/* The coefficients and slopes of a friction law, not what speeds are measured by */
static void FrictionVanish(const Reduced *reduced, const OperatorsFriction *friction, PetscReal p[])
{
  const FrictionParameter *parameter;
  const PetscInt           n = FrictionGetParameters(&friction->law, &parameter);

  for (PetscInt j = 0; j < n; j++)
    if (friction->parameter[j] >= 0 && (parameter[j].coefficient || !parameter[j].row.bounded))
      ParameterVanish(reduced, friction->parameter[j], p);
}

/* p is overwritten term by term; false as soon as one that must vanish has a coefficient left, with p then of no
   use. Powers below zero do not vanish with their parameter and are left alone. */
PetscBool ReducedFrictionless(const Reduced *reduced, PetscReal p[])
{
  for (PetscInt t = 0; t < reduced->n_terms; t++) {
    const OperatorsTerm *term = &reduced->term[t];

    if (TermStays(term)) continue;
    for (PetscInt k = 0; k < term->n; k++) {
      if (term->factor[k].friction)
        FrictionVanish(reduced, term->factor[k].friction, p);
      else if (term->factor[k].power > 0)
        ParameterVanish(reduced, term->factor[k].parameter, p);
    }
    if (OperatorsTermCoefficient(term, p) != 0) return PETSC_FALSE;
  }
  return PETSC_TRUE;
}
