/*
   Frf - the frequency response of the linearised system: what a harmonic force does at the probes.

      (s^2 M + s C + K + mu H) u = f e^{st},   s = i omega, omega = 2 pi freq_hz;     H_p = u_p / |f|, m/N (receptance)

   It is also the Laplace transform of h_p(t), the answer to an impulse of 1 N s at rest. Superposition of the modes
   lambda_k of the quadratic pencil Q(s), with right and left vectors x_k, y_k,

      H_p(s) = sum_k  (l_p^T x_k) (y_k^T f) / ((y_k^T Q'(lambda_k) x_k) (s - lambda_k)) + conjugate  +  R_p(s),

   or without damping, in kappa = -s^2, sum_k (l_p^T x_k) (y_k^T f) / ((y_k^T M x_k) (kappa_k - kappa)) + R_p, lacks the
   residual R of the modes outside of the window. R comes from the factorisation that the modes were computed with:
   Galerkin's method on the span of the right and left vectors of the modes and of P^-1 f and P^-T l_p, P = K - s M (or,
   where a damped solution made it, Q at a real shift), and in further steps of P^-1 times what it leaves of f, and
   P^-T times what it leaves of l_p (modes/space/answers.c). Poles and residues of the modes stay as they are. One step
   gives the static correction of the textbooks. Rigid modes are modes with lambda = 0.

   In time the modes alone answer, since what lies outside of the window is no residual term there,

      h_p(t) = sum_k  2 Re( (l_p^T x_k) (y_k^T f) / (y_k^T Q'(lambda_k) x_k) e^{lambda_k t} ),   m/(N s).

   The error that is reported beside each frequency is the difference from the answer with one step more, in which the
   left vectors see the residual of the right ones,

      e_p = z_p^T (f - Q(s) u),   Q(s)^T z_p = l_p on the larger space,

   and in which the entries of K are rounded otherwise. It is an estimate, not a bound. An unstable mode is a pole
   as any other: the response is then that of the equations, which no motion approaches.
*/
#pragma once

#include <squeal/quantity.h>
#include <squeal/modes.h>
#include <squeal/results.h>
#include <squeal/sound.h>
#include <squeal/statics.h>

typedef struct _p_Frf *Frf;

/* A response function: one probe in one direction */
typedef struct {
  char name[128]; /* such as tip_z, or u3 for the third unknown of matrices without a mesh */
} FrfOutput;

/* A maximum of the response over the frequencies */
typedef struct {
  PetscReal freq_hz, magnitude; /* Hz, of the table; m/N, root of the sum of squares over the outputs */
  /* that contributes most, as ModesGet() counts from 0; -1 where its frequency is further away than its half width, 3
     %, and a step of the table, or there is none */
  PetscInt mode;
} FrfPeak;

/*@ FrfCreate - makes a solver. Collective. @*/
PetscErrorCode FrfCreate(MPI_Comm comm, Frf *frf);

/*@ FrfSetOperators - the scene with its probes (referenced until FrfDestroy()). Not collective. @*/
PetscErrorCode FrfSetOperators(Frf frf, Operators operators);

/*@ FrfSetModes - the solver of the modes (referenced until FrfDestroy()). Without -modes_band and -modes_target its
   band becomes 0 to 1.5 times the highest frequency. Not collective. @*/
PetscErrorCode FrfSetModes(Frf frf, Modes modes);

/*@ FrfSetResults - the folder in which a direct response is kept as it grows, for one that goes on; statics: of which
   the pencil has the sliding state, or NULL (both referenced until FrfWrite()). Not collective. @*/
PetscErrorCode FrfSetResults(Frf frf, Results results, Statics statics);

/*@ FrfSetSound - microphones that hear the force (referenced until FrfWrite()); NULL has none. Not collective. @*/
PetscErrorCode FrfSetSound(Frf frf, Sound sound);

/*@ FrfSetPencil - the system, at its point when FrfSolve() is called (referenced until then). Not collective. @*/
PetscErrorCode FrfSetPencil(Frf frf, Pencil pencil);

/*@
   FrfSetFromOptions - reads where it is hit, where it is looked at, and at which frequencies. Collective.

   Options are the rows of src/frf/quantities.c.

   Errors: PETSC_ERR_USER_INPUT for frequencies that are not positive, directions that are none.
@*/
PetscErrorCode FrfSetFromOptions(Frf frf);

/*@ FrfVisit - shows the rows of its options. Collective. @*/
PetscErrorCode FrfVisit(Frf frf, const QuantityVisitor *visitor);

/*@
   FrfSetUp - looks the places up. Collective; after ModelSetUp().

   Errors: PETSC_ERR_USER_INPUT for a place or frequencies that are not given, a probe that is unknown or held, and
   frequencies outside of -modes_band.
@*/
PetscErrorCode FrfSetUp(Frf frf);

/*@
   FrfSolve - the response at all frequencies. Collective.

   Errors: PETSC_ERR_USER_INPUT for a frequency that is a pole; PETSC_ERR_NOT_CONVERGED where -frf_max_steps do not make
   the estimated error as small as -frf_rtol.
@*/
PetscErrorCode FrfSolve(Frf frf);

/*@ FrfGet - the frequencies, Hz [n], and the outputs (borrowed). Not collective. @*/
PetscErrorCode FrfGet(Frf frf, PetscInt *n, const PetscReal **freq_hz, PetscInt *n_outputs, const FrfOutput **output);

/*@ FrfGetResponse - H of all outputs at frequency i, m/N [n_outputs] (borrowed), and its estimated error, the root of
   the sum of squares over the outputs, m/N. Not collective. @*/
PetscErrorCode FrfGetResponse(Frf frf, PetscInt i, const PetscReal **re, const PetscReal **im, PetscReal *error);

/*@ FrfGetPeaks - the maxima (borrowed). Not collective. @*/
PetscErrorCode FrfGetPeaks(Frf frf, PetscInt *n, const FrfPeak **peaks);

/*@ FrfView - what was done, and the peaks. Collective. @*/
PetscErrorCode FrfView(Frf frf, PetscViewer viewer);

/*@ FrfWrite - frf.csv and peaks.csv, with -frf_times also impulse.csv, with microphones
    sound_frf.csv. Collective. @*/
PetscErrorCode FrfWrite(Frf frf, Results results);

/*@ FrfDestroy - frees the solver. Collective. @*/
PetscErrorCode FrfDestroy(Frf *frf);
