/* Private to sample/: its record */
#pragma once

#include <squeal/sample.h>
#include "conditions/conditions.h"
#include "draw/distribution.h"
#include "draw/sequence.h"
#include "base/statistics/estimate.h"
#include "statistics/indices.h"
#include "sweep/box/box.h"
#include "sweep/full/compare.h"

#define SAMPLE_MAX_VARIABLES (SOBOL_DIMENSIONS / 2) /* the design of the indices takes two dimensions for each */
#define SAMPLE_MANY          300 /* points from which on a model of fewer vectors is worth its making */
#define SAMPLE_MAX_TEXT      4096

/* What is drawn, and which parameters take its value */
typedef struct {
  char        *name;
  PetscInt     n_names;
  char       **names;
  Distribution distribution;
  PetscBool    relative;
  PetscBool    mean_given, deviation_given, lower_given, upper_given, peak_given;
  char         table[PETSC_MAX_PATH_LEN];
  PetscInt    *moved; /* [n_names] indices of the parameters */
  /* of a column of conditions, whose table are factors: its name, its place, what it is multiplied by */
  char      source[64];
  PetscInt  column;
  PetscReal scale;
} SampleVariable;

/* One eigenvalue of a sample */
typedef struct {
  PetscReal sigma, omega, error, growth_error; /* rad/s, the last one of sigma alone */
  PetscInt  branch;                            /* from 0 on, of the nominal modes; -1: none of them for certain */
} SampleMode;

/* Of the first rank, s; of its processor, which others may have used too */
typedef struct {
  PetscLogDouble wall, processor;
} SampleTime;

/* All in the band */
typedef struct {
  PetscInt    n;
  SampleMode *mode;
  PetscReal   worst; /* largest estimated relative error, but for rounding */
} SamplePoint;

/* A full solution beside the basis */
typedef struct {
  FullCheck found;
  PetscInt  n_closed;    /* pairs closed in its sliding state, -1 without */
  PetscBool same_status; /* which is that of the point */
} SampleCheck;

/* What is known of a branch; the last one is of all modes: the fastest growth */
typedef struct {
  PetscInt  n, n_unstable, n_surely, n_possibly; /* samples that have it; that grow, beyond their error, within it */
  Moments   frequency, growth;                   /* Hz, 1/s */
  PetscReal interval[2];                         /* of the probability of growth */
  char      label[32];
} SampleBranch;

/* A pass over points: which of them, and how many of these are solved */
typedef struct {
  PetscInt  round, n_before; /* modes of the nominal point in the pass before */
  PetscInt  n, *list, first;
  PetscInt  n_files;
  PetscBool begun; /* its beginning is kept */
} SamplePass;

struct _p_Sample {
  PetscInt     n_verify; /* full solutions to compare with */
  SampleCheck *check;    /* [n_verify] */
  MPI_Comm     comm;
  Operators    operators;
  Box          box;
  /* set by options */
  PetscInt        n_variables;
  SampleVariable *variable;
  SequenceKind    kind;
  char            correlations[SAMPLE_MAX_TEXT];
  PetscInt        n, n_rows, seed; /* samples; rows of the design of the indices, 0 for none */
  char            varied[SAMPLE_MAX_TEXT];
  PetscBool       restart;
  PetscBool       n_given, kind_given, seed_given, drawn; /* drawn: there were -sample_variables beside a file */
  char            file[PETSC_MAX_PATH_LEN];               /* of conditions, "" for samples */
  PetscInt        n_ignored, n_edges, n_columns;
  SampleVariable *column;  /* [n_columns] of -sample_columns; with a file they are among `variable` */
  char          **ignored; /* [n_ignored] columns of the file */
  PetscReal       edge[CONDITIONS_MAX_BANDS];
  /* of conditions */
  ConditionTable conditions;
  PetscInt       n_reversed, n_bands;
  PetscInt      *reversed; /* [n_reversed] parameters that turn with the disc */
  ConditionBand *band;     /* [n_bands] the last one is of all */
  /* results */
  Sequence      sequence;
  PetscReal    *factor; /* [n_variables][n_variables] L of the correlations L L', or NULL */
  PetscInt      n_points;
  SamplePoint  *point;          /* [n_points] the samples, then the rest of the design */
  ReducedModes  nominal, small; /* whose modes are the branches; the same on the model of fewer vectors */
  PetscInt      n_large;        /* points that were solved on the whole basis */
  SampleBranch *branch;         /* [nominal.n + 1] */
  PetscInt      n_divided;      /* solutions that following the branches took */
  SamplePass    pass;
  Results       results;
  Journal       journal; /* what a killed run goes on from */
  SampleTime    took[2]; /* basis and points; full solutions beside them */
};

extern const QuantityTable sample_quantities;
extern const QuantityList  sample_list, sample_columns;

/* A number as text, empty where it is none */
typedef struct {
  char text[32];
} ShortText;

static inline ShortText SampleNumber(PetscReal value)
{
  ShortText number = {""};

  if (!PetscIsInfOrNanReal(value)) (void)snprintf(number.text, sizeof(number.text), "%.15g", (double)value);
  return number;
}

/* conditions/columns.c - what -sample_columns say is checked, one record after the other; columns of the file as
   variables; parameters that turn with the disc; all parameters p at condition i, those of the scene before */
PETSC_INTERN PetscErrorCode SampleColumnCheck(MPI_Comm comm, void *owner, void *record);
PETSC_INTERN PetscErrorCode ConditionsSetColumns(Sample sample);
PETSC_INTERN PetscErrorCode ConditionsFindReversed(Sample sample);
PETSC_INTERN PetscErrorCode ConditionsCheckUnit(Sample sample, const SampleVariable *v,
                                                const OperatorsParameter *parameter);
PETSC_INTERN PetscErrorCode ConditionsGet(Sample sample, PetscInt i, PetscReal p[]);
/* conditions/bands.c - what all conditions do in each frequency band */
PETSC_INTERN PetscErrorCode SampleBands(Sample sample);
/* conditions/write.c */
PETSC_INTERN PetscErrorCode ConditionsWrite(Sample sample, Results results);
PETSC_INTERN PetscErrorCode ConditionsView(Sample sample, PetscViewer viewer);

/* table.c - the file of -NAME_table with columns value and `what`, which are value and probability of d */
PETSC_INTERN PetscErrorCode SampleTableRead(MPI_Comm comm, const SampleVariable *v, const char what[], Distribution *d);
/* variable.c - raises errors for what no distribution can be, and finds the parameters; values [n_variables] of
   point i, and all parameters p there */
PETSC_INTERN PetscErrorCode SampleFindVariables(Sample sample);
/* check.c - raises the error for a value that a parameter cannot have, warns of a sign that changes */
PETSC_INTERN PetscErrorCode SamplesCheckValues(Sample sample);
PETSC_INTERN PetscErrorCode SampleVariableCheck(MPI_Comm comm, void *owner, void *record);
PETSC_INTERN PetscErrorCode SampleValues(Sample sample, PetscInt i, PetscReal value[]);
PETSC_INTERN PetscErrorCode SampleParameters(Sample sample, PetscInt i, PetscReal p[]);
/* All but what its status is: StaticsPoint of the sample as context */
PETSC_INTERN PetscErrorCode SampleGet(void *sample, PetscInt i, PetscReal p[]);
/* points.c - the basis and all points on it */
PETSC_INTERN PetscErrorCode SamplePoints(Sample sample);
/* Modes at p on the model of fewer vectors, where it is good enough, or on the whole basis; their branches [modes->n]
   from the nominal modes, freed by the caller. Not collective. */
PETSC_INTERN PetscErrorCode SampleModesAt(Sample sample, const PetscReal p[], ReducedModes *modes, PetscInt **branch);
/* kept.c - the journal, before BoxSetUp(); keeps the beginning of a pass with its list [n], or what was solved of it;
   takes up what an earlier run kept; deletes all that is kept; gives all ranks the points list [n], the k-th in a
   pass of which is first + k, each from the rank that solved it */
PETSC_INTERN PetscErrorCode SampleJournalOpen(Sample sample, Results results);
PETSC_INTERN PetscErrorCode SampleKeep(Sample sample, PetscBool begins, PetscInt first, PetscInt n, PetscInt list[]);
PETSC_INTERN PetscErrorCode SampleResume(Sample sample);
PETSC_INTERN PetscErrorCode SampleForget(Sample sample);
PETSC_INTERN PetscErrorCode SampleShare(Sample sample, PetscInt first, PetscInt n, const PetscInt list[]);
/* verify.c - full solutions at some samples; which one the k-th is */
PETSC_INTERN PetscErrorCode SampleVerify(Sample sample);
PETSC_INTERN PetscInt       SampleVerified(Sample sample, PetscInt k);
/* verify.c - from zero the time now, then what passed since */
PETSC_INTERN PetscErrorCode SampleTimeTake(SampleTime *time);
/* branches.c - the mode of a branch at a point, NULL where it has none; branch nominal.n: the mode that grows fastest;
   all branches */
PETSC_INTERN const SampleMode *SampleFind(Sample sample, PetscInt i, PetscInt branch);
PETSC_INTERN PetscErrorCode    SampleBranches(Sample sample);
/* The values of a branch at all points, as SampleFind() has them: which = 0 frequency, 1 growth */
PETSC_INTERN void SampleBranchValues(Sample sample, PetscInt branch, int which, PetscReal value[]);
/* Indices of a branch [n_variables], r_squared of the regression, rows of the design that count */
PETSC_INTERN PetscErrorCode SampleIndices(Sample sample, const PetscReal value[], VariableIndex index[],
                                          PetscReal *r_squared, PetscInt *n_rows);
