/* Chain (private to main.c) - the chain of a run, from options to results */
#pragma once

#include "scope.h"

/* What shows itself, on stdout or where its own option says */
typedef enum {
  SHOWN_MODEL,
  SHOWN_CONTACT,
  SHOWN_OPERATORS,
  SHOWN_STATICS,
  SHOWN_MODES,
  SHOWN_SWEEP,
  SHOWN_FRF,
  SHOWN_DYNAMICS,
  SHOWN_MAP,
  SHOWN_CYCLE,
  SHOWN_SAMPLE,
  SHOWN_SUPERELEMENT,
  SHOWN_QUIET,
  SHOWN_DESIGN,
  N_SHOWN
} Shown;

/* The chain of a run: options, model, contact, operators, statics, pencil, then modes, sweep, frequency response or
   dynamics; and results */
typedef struct {
  Model        model; /* NULL for matrices without a mesh */
  Contact      contact;
  Sound        sound;
  Operators    operators;
  PetscReal   *p; /* values of the parameters: those of the scene, and what statics identify */
  Statics      statics;
  Pencil       pencil; /* at p, where modes, a file or a view ask for it */
  Modes        modes;
  Sweep        sweep;
  Sample       sample;
  Quiet        quiet;
  Design       design;
  Frf          frf;
  Dynamics     dynamics;
  ReducedRun   reduced; /* the same runs on few coordinates, where asked for */
  Map          map;
  LimitCycle   cycle;        /* limit cycles of it */
  Substructure substructure; /* parts as a superelement */
  Results      results;
  Analysis     analysis;
  PetscBool    view;
  PetscViewer  viewer[N_SHOWN]; /* of what the options below ask for and is not shown yet */
} Chain;

/* An analysis: NULL for what it has not */
typedef struct {
  SquealStage stage;
  Shown       shown; /* N_SHOWN: nothing */
  PetscErrorCode (*prepare)(Chain *chain);
  PetscErrorCode (*solve)(Chain *chain);
  PetscErrorCode (*write)(Chain *chain);
  PetscErrorCode (*view)(Chain *chain, PetscViewer viewer); /* of `shown` */
  PetscErrorCode (*judge)(Chain *chain);               /* raises an error where results that are written do not hold */
  PetscErrorCode (*add)(Chain *chain, unsigned *does); /* RunBits that depend on its own options */
  unsigned does;                                       /* RunBits of every such run, beside its own */
  unsigned uses; /* SceneUses; USES_ALL takes the options of every analysis, too */
} AnalysisRow;
extern const AnalysisRow chain_analyses[N_ANALYSES];

/* Reads the options of every analysis. Collective */
PETSC_INTERN PetscErrorCode ChainCreate(MPI_Comm comm, Chain *chain);
/* Shows the rows of all rooms, in their order. Collective */
PETSC_INTERN PetscErrorCode ChainVisit(void *chain, const QuantityVisitor *visitor);
/* Raises an error for what stands on the command line and has no effect in this analysis. Collective */
PETSC_INTERN PetscErrorCode ChainCheckOptions(MPI_Comm comm, Chain *chain);
/* Model, contact and terms; what rooms need of each other; matrices for a file where asked for */
PETSC_INTERN PetscErrorCode ChainSetUp(Chain *chain, PetscViewer viewer);
PETSC_INTERN PetscErrorCode ChainDestroy(Chain *chain);
/* The pencil at p: about the sliding state there, or with all pairs closed; made once */
PETSC_INTERN PetscErrorCode ChainLinearise(Chain *chain);

/* Which objects -X_view asks for, a row for each Shown */
extern const QuantityTable chain_views;

/* The run as scope.h sees it */
PETSC_INTERN PetscErrorCode ChainGetScope(Chain *chain, Scope *scope);

/* chainrun.c - computes, shows and writes what the analysis is for */
PETSC_INTERN PetscErrorCode ChainRun(Chain *chain);

/* chainview.c - the set of units to scene.yaml, and in a line where it is not that of the words of lines and tables */
PETSC_INTERN PetscErrorCode ChainSayUnits(Chain *chain);
/* Shows an object on stdout where wanted, and where its option says */
PETSC_INTERN PetscErrorCode ChainShow(Chain *chain, Shown what, PetscBool wanted);
/* With -help or -help_json, prints the rows of all rooms, with -help_all what PETSc and SLEPc print of theirs, too;
   without a scene, of one with a name in each list. Whether it was asked for */
PETSC_INTERN PetscErrorCode ChainHelp(MPI_Comm comm, PetscBool *asked);
/* Shows what there is before the analysis */
PETSC_INTERN PetscErrorCode ChainView(Chain *chain);
