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

static PetscReal SpringForce(const PairSpring *spring, PetscReal closing)
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

PetscReal SpringsMiss(PetscInt n, const PairSpring law[], const SpringPoint point[])
{
  PetscReal size[2] = {0, 0}, miss = 0;

  for (PetscInt p = 0; p < n; p++) {
    size[0] = PetscMax(size[0], point[p].force);
    size[1] = PetscMax(size[1], SpringClosing(&law[p], point[p].force) - SpringOnset(&law[p]));
  }
  for (PetscInt p = 0; p < n; p++) {
    const PetscReal force   = PetscAbsReal(point[p].force - SpringForce(&law[p], point[p].closing));
    const PetscReal onset   = SpringOnset(&law[p]);
    const PetscReal closing = PetscAbsReal(PetscMax(point[p].closing, onset) - SpringClosing(&law[p], point[p].force));

    if (force != 0 && closing != 0) miss = PetscMax(miss, PetscMin(force / size[0], closing / size[1]));
  }
  return miss;
}

void SpringsLay(PetscInt n, const PairSpring law[], const SpringPoint point[], PetscReal at[], SpringLine line[])
{
  for (PetscInt p = 0; p < n; p++) {
    const PetscReal onset = SpringOnset(&law[p]), force = point[p].force, closing = point[p].closing;

    at[p]   = force > 0 ? TangentNext(onset, at[p], SpringClosing(&law[p], force), closing) : PetscMax(closing, onset);
    line[p] = SpringTangent(&law[p], at[p]);
  }
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
