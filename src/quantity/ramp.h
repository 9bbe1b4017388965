/*
   Histories of loads, motions, sliding speeds and friction: a factor of time r(t) h(s), s = t - delay. The ramp r is 0
   before the delay and 1 after delay + length; between them, with x = s / length,

      linear   r = x
      smooth   r = (1 - cos(pi x)) / 2     (no jump of the rate)

   A length of 0 is a jump at the delay. What it comes to is

      h = 1, h = cos(2 pi f s + phase), or a table of h at times s, straight between them, then its last value,

   its rate d(r h) / dt to the right (1/s), and its integral over the time from 0 on (s), for speeds and the way they
   make. Times in s. What swings about zero has no part in an equilibrium (RampSwings()).
*/
#pragma once

#include <squeal/checksum.h>
#include <squeal/quantity.h>
#include <math.h>

#define RAMP_PI 3.14159265358979323846

typedef enum { RAMP_LINEAR, RAMP_SMOOTH, RAMP_N_SHAPES } RampShape;

typedef struct {
  RampShape  shape;
  double     delay, length;
  double     frequency, phase;         /* of h, Hz, 0: none; degrees */
  char       file[PETSC_MAX_PATH_LEN]; /* of a table, "" for none */
  PetscBool  warms;                    /* the table is g(T(t)), the file that of T */
  PetscInt   n;                        /* its rows */
  PetscReal *time, *factor, *area;     /* [n] s from the delay on; h there; integral of h until there, s */
} Ramp;

/* Whether something is left to change when the ramp is over */
static inline PetscBool RampVaries(const Ramp *ramp)
{
  return ramp->n || ramp->frequency > 0 ? PETSC_TRUE : PETSC_FALSE;
}

/* history.c - r h at time t, its rate to the right, 1/s, and its integral from 0 to t, s */
PETSC_INTERN double RampValue(const Ramp *ramp, double t);
PETSC_INTERN double RampRate(const Ramp *ramp, double t);
PETSC_INTERN double RampIntegral(const Ramp *ramp, double t);

/* twocolumns.c - the rows of its file, -<name>_history, on all ranks. Collective */
PETSC_INTERN PetscErrorCode RampReadTable(MPI_Comm comm, const char name[], Ramp *ramp);

/*@
   RampSetFromOptions - reads the history of a name; title heads it in -help, before the name. Collective.

   Options are the rows of ramp.c. The caller frees what is read by RampDestroy().

   Output Parameter:
.  ramp - the defaults where nothing is given, whatever it was before

   Errors: PETSC_ERR_USER_INPUT for a length or delay that is negative or not finite, for a shape of no ramp on the
   command line, for a table that is none, and for two histories.
@*/
PETSC_INTERN PetscErrorCode RampSetFromOptions(MPI_Comm comm, const char title[], const char name[], Ramp *ramp);

/*@ RampSetUp - reads the table of one whose rows are read, and checks both. Collective. @*/
PETSC_INTERN PetscErrorCode RampSetUp(MPI_Comm comm, const char name[], Ramp *ramp);

/*@ RampReadTemperature - the table g(T(t)) of a temperature over time and a factor over temperature, files
   time_s,temperature and temperature,factor, -<name>_temperature_history and -<name>_mu_temperature (twocolumns.c).
   Collective.

   Errors: PETSC_ERR_USER_INPUT for tables that are none, for factors below zero, for temperatures that the second has
   not. @*/
PETSC_INTERN PetscErrorCode RampReadTemperature(MPI_Comm comm, const char name[], const char history[],
                                                const char factors[], Ramp *ramp);

/*@
   RampCheckSteps - that steps of dt (s) see its swing and its table (resolved.c). Collective.

   Errors: PETSC_ERR_USER_INPUT for fewer than two steps a cycle; a warning for fewer than ten, and for a row between
   two steps that they leave out.
@*/
PETSC_INTERN PetscErrorCode RampCheckSteps(MPI_Comm comm, const char name[], const Ramp *ramp, PetscReal dt);

/*@ RampDestroy - frees its table. Not collective. @*/
PETSC_INTERN PetscErrorCode RampDestroy(Ramp *ramp);

/*@ RampSwings - whether the options of a name give it a frequency, and so no mean. Collective. @*/
PETSC_INTERN PetscErrorCode RampSwings(const char name[], PetscBool *swings);

/*@ RampVisit - shows its rows; why: nobody reads them, or NULL. Collective. @*/
PETSC_INTERN PetscErrorCode RampVisit(const QuantityVisitor *visitor, const char title[], const char name[], Ramp *ramp,
                                      const char why[]);

/*@ RampAddChecksum - adds all that it is to the part of the checksum that is set. Collective. @*/
PETSC_INTERN PetscErrorCode RampAddChecksum(const Ramp *ramp, Checksum checksum);

/*@ RampDescribe - words that follow a load or motion, such as "smooth ramp over 0.002 s from 0.001 s" or "at once,
    swings at 50 Hz from 0 degrees on". Not collective. @*/
PETSC_INTERN PetscErrorCode RampDescribe(const Ramp *ramp, size_t size, char words[]);
