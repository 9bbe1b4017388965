/*
   The law of a pair while it wears in an implicit step dt: forces and gap at the end of the step obey

      c = w - g0 = C(lambda_n / A) + W (lambda_n / A)^a,   W = (k_s + k_m) v dt   (m / Pa^a),

   g0 that of the step's beginning, C the closing of the pressure law. W is a compliance in series with the contact:
   for a = 1 and a linear law the pair stays linear, 1 / k = 1 / k_n + W / A. Steps of any length are stable;
   explicit ones would need W / A < 2 / k with the largest stiffness k, N/m, of bodies and contact that a pair sees.
   Else the law is one more that is not linear (pairs/pressure.c).
   Without wear W is 0, and what stands here is the pressure law.
*/
#include "statics/staticsimpl.h"
#include <math.h>

#define WORN_STEPS 200 /* of bisection at most */

/* W of a pair, 0 outside of steps of wear */
static PetscReal PairWear(const PairRows *rows, PetscInt p)
{
  return rows->wearing ? rows->wear[p] : 0;
}

static const PressureLaw *PairLaw(const PairRows *rows, PetscInt p)
{
  return &rows->pressure[rows->pair[p].interface];
}

static PetscReal PairExponent(const PairRows *rows, PetscInt p)
{
  return rows->interface[rows->pair[p].interface].wear_exponent;
}

PetscBool PairIsCurved(const PairRows *rows, PetscInt p)
{
  return !PressureIsLinear(PairLaw(rows, p)) || (PairWear(rows, p) > 0 && PairExponent(rows, p) != 1) ? PETSC_TRUE
                                                                                                      : PETSC_FALSE;
}

PetscReal PairWorn(const PairRows *rows, PetscInt p, PetscReal force)
{
  const PetscReal W = PairWear(rows, p);

  return W > 0 && force > 0 ? W * PetscPowReal(force / rows->pair[p].area, PairExponent(rows, p)) : 0;
}

PetscReal PairClosing(const PairRows *rows, PetscInt p, PetscReal force)
{
  const ContactPair *pair = &rows->pair[p];

  return ContactPairClosing(&rows->interface[pair->interface], pair, PairLaw(rows, p), PetscMax(0, force)) +
         PairWorn(rows, p, force);
}

PetscReal PairSlope(const PairRows *rows, PetscInt p, PetscReal closing, PetscReal force)
{
  const ContactPair *pair = &rows->pair[p];
  const PressureLaw *law  = PairLaw(rows, p);
  const PetscReal    W = PairWear(rows, p), a = PairExponent(rows, p);
  const PetscReal    k = PressureIsLinear(law) ? ContactPairStiffness(&rows->interface[pair->interface], pair, law, 0)
                                               : pair->area * PressureSlope(law, closing - PairWorn(rows, p, force));

  if (W == 0) return k;
  return 1 / (1 / k + (a == 1 ? W : W * a * PetscPowReal(force / pair->area, a - 1)) / pair->area);
}

/* The force at which the wear alone would close so far is one that is too large */
PetscReal PairForce(const PairRows *rows, PetscInt p, PetscReal closing)
{
  const ContactPair *pair  = &rows->pair[p];
  const PetscReal    W     = PairWear(rows, p);
  const PetscReal    onset = PressureOnset(PairLaw(rows, p));
  PetscReal          below = 0, above;

  if (W == 0) return pair->area * PressureAt(PairLaw(rows, p), closing);
  if (closing <= onset) return 0;
  above = pair->area * PetscPowReal((closing - onset) / W, 1 / PairExponent(rows, p));
  for (int i = 0; i < WORN_STEPS && above - below > PETSC_MACHINE_EPSILON * above; i++) {
    const PetscReal middle = (below + above) / 2;

    if (middle <= below || middle >= above) break;
    if (PairClosing(rows, p, middle) > closing)
      above = middle;
    else
      below = middle;
  }
  return (below + above) / 2;
}
