/*
   The normal law of one pair (pressurelaw.h): lambda_n = A P(c), N, over the closing c, m, and lines through it,

      c = o + s lambda_n,   the tangent at the closing c_0:   s = 1 / (A P'(c_0)),   o = c_0 - s A P(c_0).

   P' may vanish at the onset: the line there is rigid, s = 0. One whose force is too small to tell s stays finite.
*/
#include <squeal/contact.h>

PetscBool SpringIsCurved(const PairSpring *spring)
{
  return PressureIsLinear(&spring->law) ? PETSC_FALSE : PETSC_TRUE;
}

PetscReal SpringOnset(const PairSpring *spring)
{
  return PressureOnset(&spring->law);
}

PetscReal SpringClosing(const PairSpring *spring, PetscReal force)
{
  return PressureClosing(&spring->law, force / spring->area);
}

PetscReal SpringForce(const PairSpring *spring, PetscReal closing)
{
  return spring->area * PressureAt(&spring->law, closing);
}

PetscReal SpringEnergy(const PairSpring *spring, PetscReal force)
{
  return force > 0 ? spring->area * PressureEnergy(&spring->law, SpringClosing(spring, force)) : 0;
}

SpringLine SpringTangent(const PairSpring *spring, PetscReal closing)
{
  const PetscReal onset = SpringOnset(spring), slope = spring->area * PressureSlope(&spring->law, closing);
  SpringLine      line = {onset, 0};

  if (!SpringIsCurved(spring)) return (SpringLine){0, 1 / (spring->area * PressureSlope(&spring->law, 0))};
  if (closing <= onset || slope <= 0) return line;
  line.compliance = 1 / slope;
  line.closing    = closing - line.compliance * SpringForce(spring, closing);
  return line;
}

PetscReal TangentNext(PetscReal onset, PetscReal at, PetscReal pressing, PetscReal closing)
{
  if (at <= onset) return pressing;
  return PetscAbsReal(closing - at) < PetscAbsReal(pressing - at) ? PetscMax(closing, onset) : pressing;
}

PetscReal SpringNext(const PairSpring *spring, PetscReal at, PetscReal force, PetscReal closing)
{
  const PetscReal onset = SpringOnset(spring);

  return force > 0 ? TangentNext(onset, at, SpringClosing(spring, force), closing) : PetscMax(closing, onset);
}

/* Area (m^2) on which the pressure of a law acts; of a stiffness per pair 1, its pressure is a force */
static PetscReal PairArea(const ContactInterface *interface, const ContactPair *pair)
{
  return interface->per_area || !PressureIsLinear(&interface->pressure) ? pair->area : 1;
}

/* The law is an argument, not that of the interface, since a sweep varies it */
PetscReal ContactPairStiffness(const ContactInterface *interface, const ContactPair *pair, const PressureLaw *law,
                               PetscReal lambda_n)
{
  return PressureSlope(law, ContactPairClosing(interface, pair, law, lambda_n)) * PairArea(interface, pair);
}

PairSpring ContactPairSpring(const ContactInterface *interface, const ContactPair *pair, const PressureLaw *law)
{
  return (PairSpring){*law, PairArea(interface, pair)};
}

PetscReal ContactPairClosing(const ContactInterface *interface, const ContactPair *pair, const PressureLaw *law,
                             PetscReal lambda_n)
{
  return PressureClosing(law, lambda_n / PairArea(interface, pair));
}
