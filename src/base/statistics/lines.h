/*
   Lines of a vibration, and whether it has one basic frequency or two.

   Lines are found one after the other (J. Laskar, Icarus 88, 1990): the frequency that maximises |sum w x exp(-2 pi i f
   t)|, w Hann's window, what all lines so far leave of x being searched next; then each is sought again with the others
   taken away. Of lines far apart, T long, the error goes with T^-4. A vibration is quasi-periodic where its lines are
   k f_1 + l f_2, |k| + |l| <= 8, f_1 the strongest and f_2 the strongest that is no multiple of it, where f_2 / f_1 is
   no ratio of numbers up to 8, and both are as strong in the first half of the time as in the second, to 10 %. Lines
   below 1e-3 of the strongest need no explanation. Any two sums that make the same lines serve as well.

   Pure: no MPI, no options.
*/
#pragma once

#include <petscsys.h>

/* Hz; error: half the difference of two halves of the time */
typedef struct {
  PetscReal freq, error, amplitude;
} Line;

/* The two basic lines of n values dt (s) apart; *two false where there are none */
PETSC_INTERN PetscErrorCode LinesFindTwo(PetscInt n, const PetscReal x[], PetscReal dt, Line line[2], PetscBool *two);
