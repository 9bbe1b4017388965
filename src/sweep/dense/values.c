/*
   Whether the mass stays positive definite over the points: M(p) = sum_t c_t(p) A_t of given terms need not. On the
   mesh this is checked at the full solutions alone; here at every point, of V' M(p) V, which is all that the basis
   holds of it.

   The frictionless, undamped system among the values of the parameters: what friction and damping are proportional
   to (mu, alpha, beta, viscosity, ...) is set to zero, so that the sum of the terms is a symmetric K and M alone.
   Where some parameter is in a term that stays as well, or a term has no parameter, it cannot be turned off.
*/
#include "reduced.h"
#include "base/text.h"
#include <petscblaslapack.h>

/* Of sum_t |c_t| |v' A_t v|: less than that is rounding of the sum of the terms, n eps of some hundred vectors with
   a margin. */
#define MASS_LEAST 1e-12

/* Whether a mass term has this parameter in its coefficient; -1 for any: without one M(p) is that of the full
   solutions, checked there. */
static PetscBool MassDepends(const Reduced *reduced, PetscInt parameter)
{
  for (PetscInt t = 0; t < reduced->n_terms; t++) {
    const OperatorsTerm *term = &reduced->term[t];

    if (term->kind == OPERATORS_MASS && (parameter < 0 ? term->n > 0 : OperatorsTermDepends(term, parameter)))
      return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

/* sum_t |c_t| |v_i' A_t v_i| of vector i */
static PetscReal MassSize(const Reduced *reduced, const PetscReal p[], PetscInt i)
{
  PetscReal size = 0;

  for (PetscInt t = 0; t < reduced->n_terms; t++)
    if (reduced->term[t].kind == OPERATORS_MASS)
      size += PetscAbsReal(OperatorsTermCoefficient(&reduced->term[t], p) * reduced->A[t][i * (reduced->n + 1)]);
  return size;
}

static PetscErrorCode MassRefuse(const Reduced *reduced, const PetscReal p[])
{
  char text[256] = "", one[192];

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < reduced->n_parameters && reduced->parameter; k++) {
    if (!MassDepends(reduced, k)) continue;
    PetscCall(
      PetscSNPrintf(one, sizeof(one), "%s%s %.6g", text[0] ? ", " : " at ", reduced->parameter[k].name, (double)p[k]));
    PetscCall(WordsAdd(text, one, sizeof(text)));
  }
  SETERRQ(PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
          "the mass matrix has eigenvalues that are negative or zero%s: it must be positive definite at all points",
          text);
}

/* Cholesky factors of Ms - 1e-12 diag(sum_t |c_t| |v_i' A_t v_i|) exist exactly where that is positive definite;
   n^3 / 3 operations, few beside the eigenproblem. Not collective: one rank may fail alone, with the error of all. */
PetscErrorCode ReducedCheckMass(const Reduced *reduced, const PetscReal p[], const PetscReal Ms[])
{
  const PetscInt n = reduced->n_used;
  PetscBLASInt   size, info;
  PetscReal     *factor;

  PetscFunctionBeginUser;
  if (!n || !MassDepends(reduced, -1)) PetscFunctionReturn(0);
  PetscCall(PetscMalloc1(n * n, &factor));
  PetscCall(PetscArraycpy(factor, Ms, n * n));
  for (PetscInt i = 0; i < n; i++) factor[i * (n + 1)] -= MASS_LEAST * MassSize(reduced, p, i);
  PetscCall(PetscBLASIntCast(n, &size));
  LAPACKpotrf_("L", &size, factor, &size, &info);
  PetscCall(PetscFree(factor));
  PetscCheck(info >= 0, PETSC_COMM_SELF, PETSC_ERR_LIB, "LAPACK's potrf failed with info %d", (int)info);
  if (info) PetscCall(MassRefuse(reduced, p));
  PetscFunctionReturn(0);
}

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
