/*
   Terms: matrices with monomials of the parameters for coefficients, c(p) = scale prod_i p_i^power_i, and the
   derivative

      dc/dp_j = sum over factors i of p_j:  scale power_i p_j^(power_i - 1) prod_{k != i} p_k^power_k

   where |p| stands for p if the factor is absolute; d|p|/dp at p = 0 is taken as 0, the mean of both sides. A factor
   may also be mu or mu' of an interface (frictionfactor.c), a function of several parameters, as is one more factor of
   viscoelastic materials (law.c).
*/
#include "terms.h"

PetscErrorCode TermsAdd(Terms *terms, OperatorsTermKind kind, Mat A, PetscBool symmetric, PetscInt n,
                        const PetscInt parameter[])
{
  OperatorsTerm *term;

  PetscFunctionBeginUser;
  PetscCheck(n <= OPERATORS_MAX_FACTORS, PETSC_COMM_SELF, PETSC_ERR_PLIB, "a term of %" PetscInt_FMT " factors", n);
  PetscCall(PetscRealloc((size_t)(terms->n + 1) * sizeof(*terms->term), &terms->term));
  term = &terms->term[terms->n++];
  PetscCall(PetscMemzero(term, sizeof(*term)));
  PetscCall(PetscObjectReference((PetscObject)A));
  term->kind       = kind;
  term->A          = A;
  term->frictional = symmetric ? PETSC_FALSE : PETSC_TRUE;
  term->symmetric  = symmetric;
  term->scale      = 1;
  term->constraint = -1;
  term->cause_kind = kind == OPERATORS_STIFFNESS ? "stiffness matrix"
                     : kind == OPERATORS_DAMPING ? "damping matrix"
                                                 : "mass matrix";
  term->n          = n;
  for (PetscInt i = 0; i < n; i++) {
    term->factor[i].parameter = parameter[i];
    term->factor[i].power     = 1;
  }
  PetscFunctionReturn(0);
}

PetscErrorCode TermsSetPowers(Terms *terms, const PetscInt power[])
{
  OperatorsTerm *term = &terms->term[terms->n - 1];

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < term->n; i++) term->factor[i].power = power[i];
  PetscFunctionReturn(0);
}

PetscErrorCode TermsSetCause(Terms *terms, const char kind[], const char owner[], const char what[])
{
  OperatorsTerm *term = &terms->term[terms->n - 1];

  PetscFunctionBeginUser;
  term->cause_kind = kind;
  PetscCall(PetscSNPrintf(term->cause, sizeof(term->cause), "%s%s%s", owner ? owner : "", owner ? "_" : "", what));
  PetscFunctionReturn(0);
}

PetscErrorCode TermsSetFactors(Terms *terms, Mat left, Mat right, PetscInt interface, PetscInt group)
{
  OperatorsTerm *term = &terms->term[terms->n - 1];

  PetscFunctionBeginUser;
  PetscCall(PetscObjectReference((PetscObject)left));
  PetscCall(PetscObjectReference((PetscObject)right));
  term->left      = left;
  term->right     = right;
  term->interface = interface;
  term->group     = group;
  PetscFunctionReturn(0);
}

PetscErrorCode TermsSetFriction(Terms *terms, PetscInt i, const OperatorsFriction *friction, PetscBool slope)
{
  OperatorsTerm *term = &terms->term[terms->n - 1];

  PetscFunctionBeginUser;
  term->factor[i].parameter = -1;
  term->factor[i].friction  = friction;
  term->factor[i].slope     = slope;
  PetscFunctionReturn(0);
}

/* x^n, without the rounding of pow() at n = 1, -1 and 2 */
static PetscReal Power(PetscReal x, PetscInt n)
{
  PetscReal y = 1;

  for (PetscInt i = 0; i < PetscAbsInt(n); i++) y *= x;
  return n < 0 ? 1 / y : y;
}

/* What factor i is a power of, before its absolute value */
static PetscReal FactorBase(const OperatorsTerm *term, const PetscReal p[], PetscInt i)
{
  const OperatorsFriction *friction = term->factor[i].friction;

  return friction ? FrictionFactorValue(friction, term->factor[i].slope, p) : p[term->factor[i].parameter];
}

/* Value of factor i */
static PetscReal FactorValue(const OperatorsTerm *term, const PetscReal p[], PetscInt i)
{
  const PetscReal value = FactorBase(term, p, i), base = term->factor[i].absolute ? PetscAbsReal(value) : value;

  return Power(base, term->factor[i].power);
}

static PetscBool FactorDepends(const OperatorsTerm *term, PetscInt i, PetscInt parameter)
{
  if (term->factor[i].friction) return FrictionFactorDepends(term->factor[i].friction, parameter);
  return term->factor[i].parameter == parameter ? PETSC_TRUE : PETSC_FALSE;
}

/* Derivative of factor i by a parameter that it depends on: inner power |b|^(power - 1) sign(b), b the parameter, mu
   or mu', inner = db/dp */
static PetscReal FactorDerivative(const OperatorsTerm *term, const PetscReal p[], PetscInt i, PetscInt parameter)
{
  const OperatorsFriction *friction = term->factor[i].friction;

  const PetscReal value = FactorBase(term, p, i);
  const PetscReal sign  = !term->factor[i].absolute ? 1 : (PetscReal)((value > 0) - (value < 0));
  const PetscReal base  = term->factor[i].absolute ? PetscAbsReal(value) : value;
  const PetscReal inner = friction ? FrictionFactorDerivative(friction, term->factor[i].slope, p, parameter) : 1;
  const PetscInt  power = term->factor[i].power;

  return inner * sign * (PetscReal)power * Power(base, power - 1);
}

PetscReal OperatorsTermCoefficient(const OperatorsTerm *term, const PetscReal p[])
{
  PetscReal c = term->scale;

  for (PetscInt i = 0; i < term->n; i++) c *= FactorValue(term, p, i);
  return c * TermLaw(term, p);
}

PetscBool OperatorsTermDepends(const OperatorsTerm *term, PetscInt parameter)
{
  for (PetscInt i = 0; i < term->n; i++)
    if (FactorDepends(term, i, parameter)) return PETSC_TRUE;
  return TermLawDepends(term, parameter);
}

PetscReal OperatorsTermDerivative(const OperatorsTerm *term, const PetscReal p[], PetscInt parameter)
{
  PetscReal sum = 0, others = term->scale;

  for (PetscInt i = 0; i < term->n; i++) {
    PetscReal c = term->scale * TermLaw(term, p);

    if (!FactorDepends(term, i, parameter)) continue;
    for (PetscInt k = 0; k < term->n; k++)
      c *= k == i ? FactorDerivative(term, p, k, parameter) : FactorValue(term, p, k);
    sum += c;
  }
  if (!TermLawDepends(term, parameter)) return sum;
  for (PetscInt i = 0; i < term->n; i++) others *= FactorValue(term, p, i);
  return sum + others * TermLawDerivative(term, p, parameter);
}

PetscBool TermsVanish(const Terms *terms, TermsChoice choice, PetscBool mass_only, const PetscReal p[])
{
  for (PetscInt t = 0; t < terms->n; t++) {
    const OperatorsTerm *term = &terms->term[t];

    if (mass_only && term->kind != OPERATORS_MASS) continue;
    if (choice != TERMS_ALL && term->frictional == (choice == TERMS_SYMMETRIC)) continue;
    if (OperatorsTermCoefficient(term, p) != 0) return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

PetscErrorCode TermsAppend(Terms *terms, const Terms *more)
{
  PetscFunctionBeginUser;
  PetscCall(PetscRealloc((size_t)(terms->n + more->n) * sizeof(*terms->term), &terms->term));
  for (PetscInt t = 0; t < more->n; t++) {
    terms->term[terms->n++] = more->term[t];
    PetscCall(PetscObjectReference((PetscObject)more->term[t].A));
    if (more->term[t].left) PetscCall(PetscObjectReference((PetscObject)more->term[t].left));
    if (more->term[t].right) PetscCall(PetscObjectReference((PetscObject)more->term[t].right));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode TermsRelease(Terms *terms)
{
  PetscFunctionBeginUser;
  for (PetscInt t = 0; t < terms->n; t++) PetscCall(MatDestroy(&terms->term[t].A));
  PetscFunctionReturn(0);
}

PetscErrorCode TermsDestroy(Terms *terms)
{
  PetscFunctionBeginUser;
  for (PetscInt t = 0; t < terms->n; t++) {
    PetscCall(MatDestroy(&terms->term[t].A));
    PetscCall(MatDestroy(&terms->term[t].left));
    PetscCall(MatDestroy(&terms->term[t].right));
  }
  PetscCall(PetscFree(terms->term));
  terms->n = 0;
  PetscFunctionReturn(0);
}
