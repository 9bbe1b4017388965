/* Private to map/: the record of a map, and the files that fill it */
#pragma once

#include <squeal/map.h>
#include <squeal/results.h>
#include "base/progress.h"
#include "reduced/parameter.h"

#define MAP_MAX_AXES  2
#define MAP_MAX_TEXT  65536 /* length of a list of values */
#define MAP_MAX_MODES 24    /* that grow at a point and are listed */
#define MAP_MAX_STEPS 1e8   /* of a transient, whose record is kept until its regime is known */

typedef enum { MAP_STABLE, MAP_GROWTH, MAP_STICKING, MAP_CYCLE, MAP_UNKNOWN, MAP_N_REGIMES } MapRegime;
typedef enum { MAP_DECAYS, MAP_SETTLED, MAP_TIME, MAP_FAILED, MAP_N_ENDS } MapEnd;
typedef enum { MAP_BOTH, MAP_UP, MAP_DOWN, MAP_APART } MapDirection;

typedef struct {
  PetscInt         n_moved; /* parameters that take its values: the named one, then those linked with it */
  ReducedParameter moved[8];
  PetscInt         n;
  PetscReal       *value; /* [n] */
  PetscBool        ratio;
} MapAxis;

/* A row of map.csv; forces in N */
typedef struct {
  PetscInt  line, place, down; /* indices of the values; 1: the values are gone through backwards */
  MapRegime regime;
  MapEnd    end;
  PetscReal freq, freq_error; /* Hz, of the main line */
  PetscReal mean, rms, peak;  /* of the normal force */
  PetscReal open, stick;      /* shares of the time */
  PetscReal growth, mode_freq,
    index;         /* 1/s, Hz, of the fastest mode; the largest growth over angular frequency of all */
  PetscReal error; /* of the rms, relative */
  PetscReal time;  /* s */
  PetscInt  steps;
  PetscInt  n_modes;                                    /* that grow, of the sliding state */
  PetscReal sigma[MAP_MAX_MODES], omega[MAP_MAX_MODES]; /* rad/s */
} MapPoint;

/* What forces in a window are like */
typedef struct {
  PetscReal mean, rms, peak, open, stick;
  PetscBool changed; /* some pair changed its status */
} MapSample;

/* Reduced bodies and what acts on them, dense, alike on all ranks */
typedef struct {
  ReducedModel model;
  PetscInt    *interface;          /* [n_pairs] */
  PetscReal   *mu, *slope, *speed; /* [n_pairs] of the scene */
  PetscInt     n_hits;
  PetscReal   *hits; /* [n_hits][m] Phi'J, m sqrt(kg)/s, then [n_hits] when they are due, s */
} MapBodies;

struct _p_Map {
  MPI_Comm   comm;
  ReducedRun reduced;
  Operators  operators;
  Progress   progress;
  /* set by options */
  char         parameter[256], link[1024], values[MAP_MAX_AXES][MAP_MAX_TEXT];
  PetscBool    linked;
  MapDirection direction;
  PetscReal    window, rtol;
  /* the grid */
  PetscInt   n_axes;
  MapAxis    axis[MAP_MAX_AXES];
  PetscReal *p;        /* of the operators */
  PetscReal  dt, end;  /* s */
  PetscReal  cutoff;   /* Hz */
  PetscInt   n_chains; /* lines in one direction each */
  /* results */
  PetscInt       n_rows;
  MapPoint      *row; /* [n_rows] */
  PetscInt       n_reductions, m, n_pairs;
  PetscLogDouble seconds[2]; /* reductions, transients */
  /* restart */
  PetscBool   restart;
  const char *folder;
  uint64_t    scene;     /* checksum */
  PetscInt    n_resumed; /* rows of this rank */
};

/* mapparameter.c - names, links and values of the axes */
PETSC_INTERN PetscErrorCode MapAxes(Map map);
/* Whether an axis has a parameter of the bodies */
PETSC_INTERN PetscBool MapAxisIsBody(const MapAxis *axis);

/* mapcheck.c - raises the error for a scene of which no map can be made, and for options of the command line that do nothing */
PETSC_INTERN PetscErrorCode MapCheck(Map map);

/* mapbodies.c - bodies of a line of the map; their friction, sliding [n_pairs] of a step (m) and loads [n_loads] at a place */
PETSC_INTERN PetscErrorCode MapBodiesCreate(Map map, PetscInt line, MapBodies *bodies);
PETSC_INTERN PetscErrorCode MapBodiesMove(Map map, const MapPoint *at, MapBodies *bodies, PetscReal sliding[],
                                          PetscReal loads[]);
PETSC_INTERN PetscErrorCode MapBodiesDestroy(MapBodies *bodies);

/* mapchain.c - all points of a line in one direction, row [n of the first axis]; not collective */
PETSC_INTERN PetscErrorCode MapChain(Map map, MapBodies *bodies, PetscInt chain, MapPoint row[]);

/* The end of a chain, to be kept or taken up */
typedef struct {
  const ReducedModel *model;
  ReducedState       *state;
} MapKept;

/* mapkeep.c - checksum of the scene; bodies and chains that a killed map goes on with: good is false, and the number of rows 0,
   where there are none of this scene; takes their files away. Chains are not collective */
PETSC_INTERN PetscErrorCode MapSumScene(Map map);
PETSC_INTERN PetscErrorCode MapKeepBodies(Map map, PetscInt line, MapBodies *bodies);
PETSC_INTERN PetscErrorCode MapResumeBodies(Map map, PetscInt line, MapBodies *bodies, PetscBool *good);
PETSC_INTERN PetscErrorCode MapKeepChain(Map map, PetscInt chain, PetscInt n_rows, MapPoint row[], const MapKept *kept);
PETSC_INTERN PetscErrorCode MapResumeChain(Map map, PetscInt chain, PetscInt *n_rows, MapPoint row[],
                                           const MapKept *kept);
PETSC_INTERN PetscErrorCode MapForget(Map map);

/* mapforce.c - pure: what n forces are like, f <= 0 being none; root of the mean square over n windows, and its relative standard
   error, as if they were independent; main line of forces dt apart, in records of n, Hz, 0 for none */
PETSC_INTERN void      MapForceMeasure(PetscInt n, const PetscReal f[], MapSample *sample);
PETSC_INTERN PetscReal MapForceLevel(PetscInt n, const MapSample sample[], PetscReal *error);
PETSC_INTERN PetscReal MapForceLine(PetscInt n_records, PetscInt n, const PetscReal f[], PetscReal dt);

/* mapwrite.c - the tables */
PETSC_INTERN PetscErrorCode MapTableOpen(Results results, ResultsTable *table);
PETSC_INTERN PetscErrorCode MapTableAdd(Map map, ResultsTable table, const MapPoint *point);
PETSC_INTERN PetscErrorCode MapModesOpen(Results results, ResultsTable *table);
PETSC_INTERN PetscErrorCode MapModesAdd(Map map, ResultsTable table, const MapPoint *point);
