/*
   Materials whose stiffness depends on the eigenvalue: terms G(lambda; p) A, A of a part per unit of modulus, in two
   terms of a pencil at its reference frequency w, Re G(i w) A of K and Im G(i w) / w A of C, and what is beyond them,

      h(lambda) = G(lambda) - Re G(i w) - lambda Im G(i w) / w.

   The part's K is at E, which is G's static limit. The two terms share their matrix with that of E.
*/
#include "operators/operatorsimpl.h"

Viscoelastic OperatorsLawValues(const OperatorsLaw *law, const PetscReal p[])
{
  Viscoelastic at = law->law;

  if (law->young >= 0) at.young = p[law->young];
  for (PetscInt i = 0; i < at.n; i++)
    if (law->parameter[i] >= 0) at.value[i] = p[law->parameter[i]];
  return at;
}

void OperatorsLawAt(const OperatorsLaw *law, const PetscReal p[], PetscComplex lambda, ViscoelasticAt *at)
{
  const Viscoelastic values = OperatorsLawValues(law, p);

  ViscoelasticEvaluate(&values, lambda, at);
}

PetscComplex OperatorsLawDerivative(const OperatorsLaw *law, const ViscoelasticAt *at, PetscInt parameter)
{
  PetscComplex sum = law->young == parameter ? at->young : 0;

  for (PetscInt i = 0; i < law->law.n; i++)
    if (law->parameter[i] == parameter) sum += at->value[i];
  return sum;
}

/* What a complex modulus at the reference is in a term of its kind */
static PetscReal TermPart(const OperatorsTerm *term, PetscComplex modulus)
{
  return term->kind == OPERATORS_STIFFNESS ? creal(modulus) : cimag(modulus) / term->reference;
}

PetscReal TermLaw(const OperatorsTerm *term, const PetscReal p[])
{
  ViscoelasticAt at;

  if (!term->law) return 1;
  if (term->reference == 0) return 0;
  OperatorsLawAt(term->law, p, CMPLX(0, term->reference), &at);
  return TermPart(term, at.modulus);
}

PetscReal TermLawDerivative(const OperatorsTerm *term, const PetscReal p[], PetscInt parameter)
{
  ViscoelasticAt at;

  if (term->reference == 0) return 0;
  OperatorsLawAt(term->law, p, CMPLX(0, term->reference), &at);
  return TermPart(term, OperatorsLawDerivative(term->law, &at, parameter));
}

PetscBool TermLawDepends(const OperatorsTerm *term, PetscInt parameter)
{
  if (!term->law) return PETSC_FALSE;
  if (term->law->young == parameter) return PETSC_TRUE;
  for (PetscInt i = 0; i < term->law->law.n; i++)
    if (term->law->parameter[i] == parameter) return PETSC_TRUE;
  return PETSC_FALSE;
}
