/*
   PressureLaw - the pressure p = P(c) (Pa) of a contact with the penalty law over its closing c (m), as one value: its
   kind and its parameters. c is how far the surfaces have come into each other, minus the gap; rough surfaces press
   before they meet, at c below 0. P is 0 up to the onset, rises from there on, and P' = dP/dc (N/m^3) is the stiffness
   per area that small motions see. Passed whole and copied; every analysis asks it for P, P' and its inverse, none
   knows its parameters by name. A new law is a file in src/contact/pressure/ and a row in pressure.c there.
*/
#pragma once

#include <squeal/quantity.h>

#define PRESSURE_PARAMETERS 3 /* of a law, at most */

typedef struct {
  PetscInt64 kind; /* place in the table of laws; 0: linear, its parameter 0 is -contact_kn, infinite: exact contact */
  PetscReal  parameter[PRESSURE_PARAMETERS];
  PetscInt   n_points; /* of a table */
  PetscReal *point;    /* [n_points][2] closing, m, and pressure, Pa; the contact owns them, copies borrow */
} PressureLaw;

/*@ PressureLinear - p = k c, k N/m^3 (of a force per pair N/m), infinite for exact contact. Not collective. @*/
PressureLaw PressureLinear(PetscReal k);

/*@ PressureIsLinear - whether P' is the same at every pressure. Not collective. @*/
PetscBool PressureIsLinear(const PressureLaw *law);

/*@ PressureOnset - the closing (m) up to which there is no pressure. Not collective. @*/
PetscReal PressureOnset(const PressureLaw *law);

/*@ PressureAt, PressureSlope - P(c), Pa, and P'(c), N/m^3, at the onset that to its right. Not collective. @*/
PetscReal PressureAt(const PressureLaw *law, PetscReal c);
PetscReal PressureSlope(const PressureLaw *law, PetscReal c);

/*@ PressureClosing - the closing (m) at a pressure (Pa); the onset for none. Not collective. @*/
PetscReal PressureClosing(const PressureLaw *law, PetscReal p);

/*@ PressureEnergy - the energy that a closing (m) stores, int P dc, J/m^2. Not collective. @*/
PetscReal PressureEnergy(const PressureLaw *law, PetscReal c);

/*@ PressureGetParameters - number of parameters and their rows, -pressure_c0, of laws of this kind (borrowed). Not
    collective. @*/
PetscInt PressureGetParameters(const PressureLaw *law, const Quantity **rows);

/*@ PressureGetName - the word of -contact_pressure_law. Not collective. @*/
const char *PressureGetName(const PressureLaw *law);

/*@
   PressureSetFromOptions - reads the law of a contact. Collective.

   Input Parameters:
+  comm - ranks that read, all alike
-  name - of the contact, prefix of the options; shown for `contact`

   Output Parameter:
.  law  - a linear one has no stiffness yet

   Options are the rows of src/contact/pressure/pressure.c and of the file of each law beside it, which has p(c).

   Errors: PETSC_ERR_USER_INPUT for parameters beyond their limits, and on the command line for those of another law;
   for a table that does not rise, or does not begin without pressure.
@*/
PetscErrorCode PressureSetFromOptions(MPI_Comm comm, const char name[], PressureLaw *law);

/*@ PressureVisit - shows the rows of all laws of a contact. Collective. @*/
PetscErrorCode PressureVisit(const PressureLaw *law, const char name[], const QuantityVisitor *visitor);

/*@ PressureView - a law that is not linear, e.g. "pressure exponential, c0 1e-05, p0 1e+06". Collective. @*/
PetscErrorCode PressureView(const PressureLaw *law, PetscViewer viewer);

/*@ PressureAddChecksum - adds kind, parameters and points. Not collective. @*/
PetscErrorCode PressureAddChecksum(const PressureLaw *law, Checksum checksum);

/*@ PressureDestroy - frees what a law owns. Not collective. @*/
PetscErrorCode PressureDestroy(PressureLaw *law);

/* The normal law of a pair, lambda_n = A P(c); a stiffness k per pair, N/m, is p = k c on A = 1 */
typedef struct {
  PressureLaw law;
  PetscReal   area; /* m^2, or 1 */
} PairSpring;

/* c = closing + compliance lambda_n */
typedef struct {
  PetscReal closing, compliance; /* m, m/N */
} SpringLine;

/*@ SpringIsCurved, SpringOnset, SpringClosing - whether the law of a pair is not linear; the closing (m) at which it
    begins, that at a force (N). SpringEnergy - stored at a force, J. Not collective. @*/
PetscBool SpringIsCurved(const PairSpring *spring);
PetscReal SpringOnset(const PairSpring *spring);
PetscReal SpringClosing(const PairSpring *spring, PetscReal force);
PetscReal SpringEnergy(const PairSpring *spring, PetscReal force);

/*@ SpringTangent - the tangent of the law at a closing, rigid at the onset; a linear law itself. Not collective. @*/
SpringLine SpringTangent(const PairSpring *spring, PetscReal closing);

/*@ TangentNext - where Newton's method lays the next tangent of a law that stiffens, m: of one laid at the closing
    `at` came a force, at which the law has the closing `pressing`, and a closing: two points on the law, of which the
    one nearer to `at` is taken, so that no steep law runs away. At the onset the force tells. Not collective. @*/
PetscReal TangentNext(PetscReal onset, PetscReal at, PetscReal pressing, PetscReal closing);

/* What a solver on lines found of a pair: a force, N, not negative, and a closing, m */
typedef struct {
  PetscReal force, closing;
} SpringPoint;

/*@ SpringsMiss - how far the points [n] are off the laws: as a force or as a closing, whichever is less, of the largest
    force, and of the largest closing beyond its onset. Not collective. @*/
PetscReal SpringsMiss(PetscInt n, const PairSpring law[], const SpringPoint point[]);

/*@ SpringsLay - the next tangents of the laws [n], of the points that the lines before, laid at the closings `at`, led
    to: TangentNext(); one without force is at its closing. Not collective. @*/
void SpringsLay(PetscInt n, const PairSpring law[], const SpringPoint point[], PetscReal at[], SpringLine line[]);
