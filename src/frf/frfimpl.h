/* Private to frf/: the record of the solver */
#pragma once

#include "results/journal/journal.h"
#include "solver/factor/shiftinvert.h"
#include <squeal/quantity.h>
#include <squeal/frf.h>
#include <squeal/sound.h>
#include <squeal/statics.h>
#include <complex.h>

typedef enum { FRF_MODAL, FRF_DIRECT, N_FRF_METHODS } FrfMethod;

struct _p_Frf {
  MPI_Comm  comm;
  Operators operators;
  Modes     modes;
  Pencil    pencil;
  Statics   statics; /* whose sliding state the pencil is about, or NULL */
  Journal   journal; /* of a direct response */
  Sound     sound;
  /* set by options */
  char       force[256], frequencies[4096], times[4096], directions[8];
  PetscBool  has_directions;
  PetscInt   n_places; /* names of -frf_probes; 0: all */
  char     **place;    /* [n_places] */
  PetscInt   n;        /* frequencies */
  PetscReal *freq;     /* [n] Hz */
  PetscInt   n_times;
  PetscReal *time; /* [n_times] s, of the answer to an impulse */
  FrfMethod  method;
  PetscReal  rtol;
  PetscInt   max_steps;
  PetscBool  restart;
  /* input and outputs, vectors of all unknowns */
  char       input[256]; /* in words */
  Vec        f;          /* force of 1 N */
  PetscInt   n_outputs;
  FrfOutput *output; /* [n_outputs] */
  Vec       *l;      /* [n_outputs] unit vector of the unknown */
  /* results */
  PetscReal *re, *im; /* [n][n_outputs] m/N */
  PetscReal *error;   /* [n] m/N */
  PetscInt   n_heard; /* numbers of a row of sound_frf.csv behind freq_hz, 0 without microphones */
  PetscReal *heard;   /* [n][n_heard] */
  PetscReal *impulse; /* [n_times][n_outputs] m/(N s) */
  PetscInt   n_peaks;
  FrfPeak   *peak;
  PetscInt   n_steps, n_vectors, n_solves; /* of the residual term */
  Progress   progress;
};

/* quantities.c - what options set in it */
extern const QuantityTable frf_quantities;

/* places.c - the force, and the unknowns that are recorded */
PETSC_INTERN PetscErrorCode FrfFindForce(Frf frf);
PETSC_INTERN PetscErrorCode FrfFindOutputs(Frf frf);
/* The force and the outputs in the unknowns of the pencil: right[1] = Zl' f, left[n_outputs] = Zr' l; the caller
   destroys the vectors */
PETSC_INTERN PetscErrorCode FrfProject(Frf frf, Vec *right, Vec **left);

/* modal.c, direct.c - the response at all frequencies */
PETSC_INTERN PetscErrorCode FrfSolveModal(Frf frf);
PETSC_INTERN PetscErrorCode FrfSolveDirect(Frf frf);

/* kept.c - how many frequencies an earlier run has kept; keeps the first n; takes away what is kept. Collective. */
PETSC_INTERN PetscErrorCode FrfResume(Frf frf, PetscInt *n);
PETSC_INTERN PetscErrorCode FrfKeep(Frf frf, PetscInt n);
PETSC_INTERN PetscErrorCode FrfForget(Frf frf);

/* tables/sound.c - whether somebody listens; the row of frequency i, of an answer in the unknowns of the pencil, im
   NULL for a real one; the table. Collective. */
PETSC_INTERN PetscBool      FrfHears(Frf frf);
PETSC_INTERN PetscErrorCode FrfHear(Frf frf, PetscInt i, PetscReal error, Vec re, Vec im);
PETSC_INTERN PetscErrorCode FrfWriteSound(Frf frf, Results results);

/* contribution.c - how much each mode gives to the response */
typedef struct {
  PetscInt n;
  PetscReal
    *residue; /* [n] |l^T x| |y^T f| / |y^T Q' x| over the outputs, m/(N s); of a rigid mode / |y^T M x|, 1/kg */
} FrfResidues;

PETSC_INTERN PetscErrorCode FrfResiduesCreate(Frf frf, FrfResidues *residues);
/* The mode that gives most at omega (rad/s), -1 for none */
PETSC_INTERN PetscErrorCode FrfResiduesLargest(Frf frf, const FrfResidues *residues, PetscReal omega, PetscInt *mode);
PETSC_INTERN PetscErrorCode FrfResiduesDestroy(FrfResidues *residues);
/* v^T (xr + i xi), xi NULL for a real vector */
PETSC_INTERN PetscErrorCode FrfDot(Vec v, Vec xr, Vec xi, PetscComplex *dot);
/* Raises an error for a frequency at which an undamped mode lies */
PETSC_INTERN PetscErrorCode FrfCheckPoles(Frf frf);

/* peaks.c - maxima of the response; residues NULL: no mode is told */
PETSC_INTERN PetscErrorCode FrfFindPeaks(Frf frf, const FrfResidues *residues);
/* Root of the sum of squares over the outputs at frequency i, m/N */
PETSC_INTERN PetscReal FrfMagnitude(Frf frf, PetscInt i);

/* impulse.c - the answer of the modes to an impulse */
PETSC_INTERN PetscErrorCode FrfSolveImpulse(Frf frf);
