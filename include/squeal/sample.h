/*
   Sample - complex modes of many brakes: parameters of the scene are drawn from distributions, and every sample is
   solved on one reduced basis (sweep.h) with an estimate of its error.

      p_k = F_k^-1(u_k),   u the points of a sequence that fills the unit cube

   Samples are matched to the modes of the scene's own values, the branches, by products of right and left vectors. Of
   each branch follow mean, deviation and quantiles of frequency and growth, the probability that it grows with its
   interval, and which variables they depend on (indices of Sobol, regression).

   With statics each sample has its own sliding state. A status is a class of points; all are projected on one basis.

   In place of samples there may be conditions of a test from a file, each with its modes, counted in frequency bands.
*/
#pragma once

#include <squeal/quantity.h>
#include <squeal/modes.h>
#include <squeal/statics.h>

typedef struct _p_Sample *Sample;

/*@ SampleCreate - makes an empty one. Collective. @*/
PetscErrorCode SampleCreate(MPI_Comm comm, Sample *sample);

/*@
   SampleSetFromOptions - reads what varies, how, and how often. Collective.

   Options are the rows of src/sample/quantities.c.

   Errors: PETSC_ERR_USER_INPUT for what no distribution can be.
@*/
PetscErrorCode SampleSetFromOptions(Sample sample);

/*@ SampleVisit - shows the rows of its options. Collective. @*/
PetscErrorCode SampleVisit(Sample sample, const QuantityVisitor *visitor);

/*@
   SampleSetRooms - what it computes with (referenced until SampleDestroy()): the system, affine in its parameters, the
   point p of the scene's own values, the solver of the full problems with its band, and the statics whose sliding state
   at each point is taken, or NULL: all pairs are closed. Collective.
@*/
PetscErrorCode SampleSetRooms(Sample sample, Operators operators, const PetscReal p[], Modes modes, Statics statics);

/*@ SampleGetVaried - which options of the scene are varied (borrowed), as one list with commas. Not collective. @*/
PetscErrorCode SampleGetVaried(Sample sample, const char **names);

/*@ SampleSolve - all samples, and what they tell. Collective. @*/
PetscErrorCode SampleSolve(Sample sample, Results results);

/*@ SampleView - what a person wants to know first. Collective. @*/
PetscErrorCode SampleView(Sample sample, PetscViewer viewer);

/*@ SampleWrite - samples.csv, samples_modes.csv, probability.csv, indices.csv; of conditions conditions.csv and
    conditions_bands.csv. Collective. @*/
PetscErrorCode SampleWrite(Sample sample, Results results);

/*@ SampleDestroy - frees it. Collective. @*/
PetscErrorCode SampleDestroy(Sample *sample);
