/*
   Ramps of loads, motions and sliding speeds: a factor of time r(t), which is 0 before a delay and 1 after delay +
   length; between them, with x = (t - delay) / length,

      linear   r = x
      smooth   r = (1 - cos(pi x)) / 2     (no jump of the rate)

   its rate r'(t) (1/s), and its integral R(t) = int_0^t r (s), for speeds that are ramped and the way they make. A
   length of 0 is a jump at the delay. Times in s.
*/
#pragma once

#include <squeal/quantity.h>
#include <math.h>

#define RAMP_PI 3.14159265358979323846

typedef enum { RAMP_LINEAR, RAMP_SMOOTH, RAMP_N_SHAPES } RampShape;

typedef struct {
  RampShape shape;
  double    delay, length;
} Ramp;

/* Place on the ramp, 0 to 1 */
static inline double RampPlace(const Ramp *ramp, double t)
{
  const double x = t - ramp->delay;

  return x < 0 ? 0 : x >= ramp->length ? 1 : x / ramp->length;
}

static inline double RampValue(const Ramp *ramp, double t)
{
  const double x = RampPlace(ramp, t);

  return ramp->shape == RAMP_SMOOTH ? 0.5 * (1 - cos(RAMP_PI * x)) : x;
}

static inline double RampIntegral(const Ramp *ramp, double t)
{
  const double x      = RampPlace(ramp, t);
  const double rising = ramp->shape == RAMP_SMOOTH ? 0.5 * (x - sin(RAMP_PI * x) / RAMP_PI) : 0.5 * x * x;
  const double after  = t - ramp->delay - ramp->length;

  return ramp->length * rising + (after > 0 ? after : 0);
}

/*@
   RampSetFromOptions - reads the ramp of a name; title heads it in -help, before the name. Collective.

   Options are the rows of ramp.c.

   Output Parameter:
.  ramp - the defaults where nothing is given, whatever it was before

   Errors: PETSC_ERR_USER_INPUT for a length or delay that is negative or not finite, and for a shape of no ramp on the
   command line.
@*/
PETSC_INTERN PetscErrorCode RampSetFromOptions(MPI_Comm comm, const char title[], const char name[], Ramp *ramp);

/*@ RampVisit - shows its rows; why: nobody reads them, or NULL. Collective. @*/
PETSC_INTERN PetscErrorCode RampVisit(const QuantityVisitor *visitor, const char title[], const char name[], Ramp *ramp,
                                      const char why[]);

/*@ RampDescribe - words that follow a load or motion, such as "smooth ramp over 0.002 s from 0.001 s" or "at once". Not
    collective. @*/
PETSC_INTERN PetscErrorCode RampDescribe(const Ramp *ramp, size_t size, char words[]);
