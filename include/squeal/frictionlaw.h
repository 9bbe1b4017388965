/*
   FrictionLaw - the friction coefficient mu(s) of a contact over the slip speed s >= 0 (m/s), as one value: its kind,
   its parameters, and the stated sliding speed. Passed whole and copied; every analysis asks it for mu(s) and mu'(s),
   none knows its parameters by name. A new law is a file in src/contact/law/ and a row in law.c there.

   mu of a table depends on the pressure p (Pa) too: who asks a law that needs it sets it before (FrictionPressed()).
*/
#pragma once

#include <squeal/quantity.h>

#define FRICTION_PARAMETERS 4 /* of a law, at most */

/* mu over speed and pressure, both ascending from 0 */
typedef struct {
  PetscInt         n_speeds, n_pressures; /* 0 of other laws */
  const PetscReal *speed, *pressure;      /* m/s, Pa; one block with mu, which the contact owns and copies borrow */
  const PetscReal *mu;                    /* [n_speeds][n_pressures] */
} FrictionTable;

typedef struct {
  PetscInt64    kind;  /* place in the table of laws; 0: Coulomb's */
  PetscReal     speed; /* stated sliding speed, m/s; 0 where nothing slides as told */
  PetscReal     parameter[FRICTION_PARAMETERS];
  PetscReal     area;     /* of a pair, m^2, whose forces tell pressures; 0 of a contact as a whole */
  PetscReal     pressure; /* at which mu is asked, Pa; of a law that needs it */
  FrictionTable table;
} FrictionLaw;

/* A parameter of a law: its option, without the name of the contact, and what depends on it */
typedef struct {
  Quantity  row;         /* -mu_static; bounded: a coefficient must not be negative, others must be positive */
  PetscBool coefficient; /* mu is proportional to all of these together, and not negative in time */
  PetscBool steady;      /* mu at the stated speed depends on it; else mu' alone */
  PetscBool rest;        /* mu at rest depends on it */
} FrictionParameter;

/* Derivatives at one slip speed */
typedef struct {
  PetscReal mu[FRICTION_PARAMETERS];    /* d mu / d parameter */
  PetscReal slope[FRICTION_PARAMETERS]; /* d mu' / d parameter */
  PetscReal stated[2];                  /* d mu / d v, d mu' / d v at s = v, the stated speed */
} FrictionDerivative;

/*@ FrictionAt - the same law with another stated speed, m/s. Not collective. @*/
FrictionLaw FrictionAt(const FrictionLaw *law, PetscReal speed);

/*@ FrictionOfPair - that of a pair, of its stated speed (m/s) and area (m^2). Not collective. @*/
FrictionLaw FrictionOfPair(const FrictionLaw *law, PetscReal speed, PetscReal area);

/*@ FrictionNeedsPressure - whether mu changes with the pressure. FrictionPressed - the law of a pair at the pressure of
    a force, N; 0 for none. Not collective. @*/
PetscBool   FrictionNeedsPressure(const FrictionLaw *law);
FrictionLaw FrictionPressed(const FrictionLaw *law, PetscReal force);

/*@ FrictionRise - p d mu / dp at the slip speed s and the pressure p of the law: without unit. Not collective. @*/
PetscReal FrictionRise(const FrictionLaw *law, PetscReal s);

/*@ FrictionCovers - whether the law tells mu at the slip speed s and its pressure: a table does up to its last ones.
    Not collective. @*/
PetscBool FrictionCovers(const FrictionLaw *law, PetscReal s);

/*@ FrictionComplain - raises PETSC_ERR_USER_INPUT for a pair of the contact `name` (NULL: of any) that slides at s
    (m/s) under p (Pa) at the time t (s, negative: at rest), where its table ends. Collective. @*/
PetscErrorCode FrictionComplain(MPI_Comm comm, const char name[], const FrictionLaw *law, PetscReal t, PetscReal s,
                                PetscReal p);

/*@ FrictionMu, FrictionSlope - mu(s), and mu'(s) in s/m, at the slip speed s >= 0 (m/s). Not collective. @*/
PetscReal FrictionMu(const FrictionLaw *law, PetscReal s);
PetscReal FrictionSlope(const FrictionLaw *law, PetscReal s);

/*@ FrictionSteady, FrictionSteadySlope - the same at the stated speed v. FrictionSteadyTangent - of the friction mu(p)
    p there its change over that of p, mu + p d mu / dp. Not collective. @*/
PetscReal FrictionSteady(const FrictionLaw *law);
PetscReal FrictionSteadySlope(const FrictionLaw *law);
PetscReal FrictionSteadyTangent(const FrictionLaw *law);

/*@ FrictionDerive - derivatives at the stated speed. Not collective. @*/
void FrictionDerive(const FrictionLaw *law, FrictionDerivative *derivative);

/*@ FrictionExists - whether there is any: a coefficient that is not 0. Not collective. @*/
PetscBool FrictionExists(const FrictionLaw *law);

/*@ FrictionVaries - whether mu changes with the slip speed. Not collective. @*/
PetscBool FrictionVaries(const FrictionLaw *law);

/*@ FrictionNeedsSpeed - whether mu in steady sliding changes with the stated speed; not where the law is given about
   it. Not collective. @*/
PetscBool FrictionNeedsSpeed(const FrictionLaw *law);

/*@ FrictionIsValid - whether all parameters are finite, coefficients not negative, and the others within their
   limits. Not collective. @*/
PetscBool FrictionIsValid(const FrictionLaw *law);

/*@ FrictionScale - multiplies the coefficients. Not collective. @*/
void FrictionScale(FrictionLaw *law, PetscReal factor);

/*@ FrictionGetParameters - number of parameters and what they are, of laws of this kind (borrowed). Not collective. @*/
PetscInt FrictionGetParameters(const FrictionLaw *law, const FrictionParameter **parameters);

/*@
   FrictionSetFromOptions - reads the law of a contact. Collective.

   Input Parameters:
+  comm - ranks that read, all alike
-  name - of the contact, prefix of the options; shown for `contact`

   Output Parameter:
.  law  - with the stated speed 0

   Options are the rows of src/contact/law/law.c and of the file of each law beside it, which has mu(s).

   Errors: PETSC_ERR_USER_INPUT for parameters beyond their limits, and on the command line for those of another law.
@*/
PetscErrorCode FrictionSetFromOptions(MPI_Comm comm, const char name[], FrictionLaw *law);

/*@ FrictionCheckNotNegative - raises PETSC_ERR_USER_INPUT for a negative coefficient, which no run in time has.
   Collective. @*/
PetscErrorCode FrictionCheckNotNegative(MPI_Comm comm, const char name[], const FrictionLaw *law);

/*@ FrictionWarnLarge - a warning for coefficients as large as those in per cent. Collective. @*/
PetscErrorCode FrictionWarnLarge(MPI_Comm comm, const char name[], const FrictionLaw *law);

/*@ FrictionVisit - shows the rows of all laws of a contact. Collective. @*/
PetscErrorCode FrictionVisit(const FrictionLaw *law, const char name[], const QuantityVisitor *visitor);

/*@ FrictionView - the parameters, e.g. "mu 0.4". Collective. @*/
PetscErrorCode FrictionView(const FrictionLaw *law, PetscViewer viewer);

/*@ FrictionAddChecksum - adds kind and parameters. Not collective. @*/
PetscErrorCode FrictionAddChecksum(const FrictionLaw *law, Checksum checksum);

/*@ FrictionDestroy - frees what a law owns. Not collective. @*/
PetscErrorCode FrictionDestroy(FrictionLaw *law);
