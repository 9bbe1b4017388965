/*
   Materials whose stiffness depends on the eigenvalue: terms G(lambda; p) A, A of a part per unit of modulus, in two
   terms of a pencil at its reference frequency w, Re G(i w) A of K and Im G(i w) / w A of C, and what is beyond them,

      h(lambda) = G(lambda) - Re G(i w) - lambda Im G(i w) / w.

   The part's K is at E, which is G's static limit. The two terms share their matrix with that of E.

   Factors of a real K stand for those of the complex stiffness E* = E + G(i w) in corrections of modes. What a real
   modulus r leaves of it is |E* - r| / r of the former at most, least at

      r = |E*|^2 / Re E*,   |E* - r| / r = eta / sqrt(1 + eta^2) < 1,   eta = Im E* / Re E*,

   so that these converge whatever the loss factor is, up to VISCOELASTIC_LOSS_MOST (residuals are judged beside
   r, which is eta^2 times Re E*: beyond some 1,000 they settle too early): with stiffened terms K has r - E in
   place of Re G, h the rest.
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

PetscComplex TermLawModulus(const OperatorsTerm *term, const PetscReal p[])
{
  const Viscoelastic values = OperatorsLawValues(term->law, p);
  ViscoelasticAt     at;

  if (term->reference == 0) return 0;
  ViscoelasticEvaluate(&values, CMPLX(0, term->reference), &at);
  return term->stiffened ? at.modulus + PetscSqr(cimag(at.modulus)) / (values.young + creal(at.modulus)) : at.modulus;
}

PetscReal TermLaw(const OperatorsTerm *term, const PetscReal p[])
{
  PetscComplex modulus;

  if (!term->law) return 1;
  if (term->reference == 0) return 0;
  modulus = TermLawModulus(term, p);
  return term->kind == OPERATORS_STIFFNESS ? creal(modulus) : cimag(modulus) / term->reference;
}

PetscReal TermLawDerivative(const OperatorsTerm *term, const PetscReal p[], PetscInt parameter)
{
  PetscComplex   slope, modulus;
  PetscReal      tangent;
  ViscoelasticAt at;

  if (term->reference == 0) return 0;
  OperatorsLawAt(term->law, p, CMPLX(0, term->reference), &at);
  slope = OperatorsLawDerivative(term->law, &at, parameter);
  if (term->kind != OPERATORS_STIFFNESS) return cimag(slope) / term->reference;
  if (!term->stiffened) return creal(slope);
  modulus = OperatorsLawValues(term->law, p).young + at.modulus;
  tangent = cimag(modulus) / creal(modulus);
  if (term->law->young == parameter) slope += 1;
  return creal(slope) * (1 - tangent * tangent) + 2 * tangent * cimag(slope) - (term->law->young == parameter);
}

PetscBool TermLawDepends(const OperatorsTerm *term, PetscInt parameter)
{
  if (!term->law) return PETSC_FALSE;
  if (term->law->young == parameter) return PETSC_TRUE;
  for (PetscInt i = 0; i < term->law->law.n; i++)
    if (term->law->parameter[i] == parameter) return PETSC_TRUE;
  return PETSC_FALSE;
}
