/* Private to map/: the record of a map, and the files that fill it */
#pragma once

#include <squeal/quantity.h>
#include <squeal/map.h>
#include "base/process/progress.h"
#include "reduced/parameter.h"
#include "results/journal/journal.h"

#define MAP_RTOL             1e-9 /* of the contact laws (map.h) */
#define MAP_MAX_AXES         2
#define MAP_MAX_TEXT         65536 /* length of a list of values */
#define MAP_MAX_MODES        24    /* that grow at a point and are listed */
#define MAP_SETTLED_WINDOWS  3     /* that agree */
#define MAP_MAX_TWINS        8
#define MAP_STICKING_SHARE   0.01 /* of the time */
#define MAP_N_QUANTILES      3
#define MAP_MAX_POINTS       100000
#define MAP_MAX_DISTURBANCES 10000
#define MAP_MAX_STEPS        1e8 /* of a transient, whose record is kept until its regime is known */

typedef enum {
  MAP_STABLE,
  MAP_GROWTH,
  MAP_STICKING,
  MAP_CYCLE,
  MAP_QUASI,
  MAP_BISTABLE,
  MAP_UNKNOWN,
  MAP_N_REGIMES
} MapRegime;
typedef enum { MAP_DECAYS, MAP_SETTLED, MAP_STEADY, MAP_TIME, MAP_FAILED, MAP_N_ENDS } MapEnd;
/* why a transient failed */
typedef enum { MAP_NO_STATE, MAP_NO_FORCES, MAP_NO_NUMBER, MAP_MADE, MAP_N_FAULTS } MapFault;
typedef enum { MAP_HALF_STEP, MAP_TIGHT_LAWS, MAP_HIGHER_CUTOFF, MAP_N_CHECKS } MapCheckRun; /* of -map_verify */
typedef enum { MAP_BOTH, MAP_UP, MAP_DOWN, MAP_APART } MapDirection;

typedef struct {
  PetscInt         n_moved; /* parameters that take its values: the named one, then those linked with it */
  ReducedParameter moved[8];
  PetscInt         n;
  PetscReal       *value; /* [n] */
} MapAxis;

/* A row of map.csv; forces in N */
typedef struct {
  PetscInt  line, place, down; /* indices of the values; 1: the values are gone through backwards */
  MapRegime regime;
  MapEnd    end;
  MapFault  fault;            /* of one that failed */
  PetscReal freq, freq_error; /* Hz, of the main line; NAN without */
  PetscReal second[2];        /* Hz, of a quasi-periodic motion: the basic line beside the main one, its error */
  PetscReal mean, rms, peak;  /* of the normal force */
  PetscReal open, stick;      /* shares of the time */
  PetscReal growth, mode_freq,
    index;         /* 1/s, Hz, of the fastest mode; the largest growth over angular frequency of all */
  PetscReal whole; /* growth with the inertia of what the modes leave out, of bodies that have it */
  PetscReal error; /* of the rms, relative */
  PetscReal time;  /* s */
  PetscInt  steps;
  /* transients of the point, its own and its twins; of these vibrate; steps of all */
  PetscInt  n_runs, n_loud, all_steps;
  PetscInt  regimes;                                    /* of these: sum of 1 << MapRegime */
  PetscReal quantile[MAP_N_QUANTILES];                  /* N, 5, 50, 95 % of the rms of their windows */
  PetscInt  n_growing, n_unstable;                      /* modes of the sliding state that grow; of these unstable */
  PetscReal sigma[MAP_MAX_MODES], omega[MAP_MAX_MODES]; /* of the fastest of these, rad/s */
} MapPoint;

/* The mode that grows fastest, 1/s and Hz (0 of divergence), and the largest growth over angular frequency */
typedef struct {
  PetscReal growth, freq, index;
} MapFastest;

/* What forces in a window are like */
typedef struct {
  PetscReal mean, rms, peak, open, stick;
  PetscBool changed, hit; /* some pair changed its status, or impulses acted; these */
} MapSample;

/* Reduced bodies and what acts on them, dense, alike on all ranks */
typedef struct {
  ReducedModel model;
  PetscInt    *interface; /* [n_pairs] */
  FrictionLaw *friction;  /* [n_pairs] of the scene */
  PetscInt     n_hits;
  PetscReal   *hits; /* [n_hits][m] Phi'J, m sqrt(kg)/s, then [n_hits] when they are due, s */
  PetscBool    kept; /* by an earlier run, whose chains belong to them */
} MapBodies;

/* Differences of a run at a point from that of the map, NAN of what is not compared; or the largest of all points */
typedef struct {
  PetscInt  n, regime, failed; /* points: compared, since they vibrate in both runs alike; of another regime; failed */
  PetscReal rms, freq, growth; /* relative; Hz; 1/s */
} MapError;

/* A kind of motion that disturbed runs of a point end in: means, in a row; the least and the largest rms, N; runs, and
   the interval of its probability */
typedef struct {
  MapPoint  row;
  PetscReal least, most;
  PetscInt  n;
  PetscReal interval[2];
} MapBasin;

/* A counter that ranks share */
typedef struct {
  MPI_Win window;
  int    *counter; /* [1] on rank 0 */
} MapShare;

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
  PetscInt     n_verify;                       /* points of which errors are told */
  PetscInt     n_twins;                        /* of a point, at most */
  PetscInt     n_disturbances, seed;           /* runs of a point with random velocities */
  PetscReal    disturbance, disturbance_least; /* J */
  /* the grid */
  PetscInt   n_axes;
  MapAxis    axis[MAP_MAX_AXES];
  PetscReal *p;            /* of the operators */
  ModesLimit limit;        /* what counts as unstable */
  PetscReal  dt, end;      /* s */
  PetscReal  cutoff;       /* Hz */
  PetscBool  lines_differ; /* each has bodies of its own */
  PetscInt   n_ways;       /* chains of a line: its directions, or its points */
  PetscInt   n_linked;     /* points of a chain */
  PetscReal  bytes;        /* of reduced bodies, about */
  MapShare   share;
  /* results */
  PetscInt       n_rows;
  MapPoint      *row; /* [n_rows] lines, ways, places */
  PetscInt       n_reductions, m, n_pairs;
  PetscLogDouble seconds[2]; /* reductions, transients */
  MapError       error[MAP_N_CHECKS];
  PetscInt       disturbed[MAP_N_REGIMES]; /* runs with random velocities */
  /* restart */
  PetscBool   restart;
  const char *folder;
  Journal     journal;
  PetscBool   anew;      /* bodies were made that no earlier run has kept */
  PetscInt    n_resumed; /* rows of this rank */
  PetscInt    n_taken;   /* disturbed runs that an earlier run has kept */
};

/* quantities.c - what options set in it */
extern const QuantityTable map_quantities;

/* A chain that is run (point/chain.c): bodies, and work */
typedef struct _p_MapMarch *MapMarch;
struct _p_MapMarch {
  Map              map;
  PetscReal        dt; /* s */
  MapBodies       *bodies;
  ReducedStepper   stepper;
  ReducedState     state, rest; /* the motion; the sliding state of the point */
  ReducedReport    report;
  PetscReal       *sliding, *loads, *kick; /* [n_pairs] m, [n_loads], [m] */
  const PetscReal *disturbance;            /* [m] rates beside those of the sliding state, m sqrt(kg)/s, or NULL */
  PetscInt         n, n_windows, n_most;   /* steps of a window; windows of the point, at most */
  PetscInt         first;                  /* window from which the numbers of a transient are */
  /* works in a transient; of impulses, with the energy that it began with, J */
  PetscReal      contact, friction, given;
  PetscReal     *slip;           /* [n_most n] mean slip speed along t, m/s */
  PetscReal     *force;          /* [n_most n] N */
  ContactStatus *status;         /* [n_pairs] at the beginning of the window */
  PetscBool     *closed, *known; /* [n_pairs]; those of which `growth` is */
  PetscReal      growth;
  PetscReal     *lambda_n, *sigma, *omega; /* [n_pairs] N, [2 m] */
  MapSample     *sample;                   /* [n_most] */
  /* twins (point/twins.c) */
  PetscInt      n_twins;     /* of a point, at most */
  PetscInt      n_alive;     /* of these, that go on from ends of their own */
  ReducedState  start, next; /* where the point begins, and its first twin */
  ReducedState *twin;        /* [n_twins] */
  PetscReal     rest_growth; /* `growth` there, `known` and friction [n_pairs] */
  PetscBool    *rest_known;
  FrictionLaw  *rest_friction;
  PetscInt      n_runs; /* the point's own transient and its twins, but for those that have failed */
  MapPoint     *run;
  PetscInt     *n_levels; /* [n_runs], and N [n_runs][n_most], rms of the windows that their numbers are of */
  PetscReal    *level, *sorted;
};

/* map/parameter.c - names, links and values of the axes */
PETSC_INTERN PetscErrorCode MapAxes(Map map);
/* Whether an axis has a parameter of the bodies */
PETSC_INTERN PetscBool MapAxisIsBody(const MapAxis *axis);

/* map/check.c - raises the error for a scene of which no map can be made, and for options of the command line that do
   nothing; after ReducedPrepare() for a scene without impulses or sliding; for a window, an end and impulses that do
   not fit to each other and to the step */
PETSC_INTERN PetscErrorCode MapCheck(Map map);
PETSC_INTERN PetscErrorCode MapCheckPrepared(Map map);
PETSC_INTERN PetscErrorCode MapCheckTimes(Map map);

/* map/check.c - steps dt (s) of a window, which lasts as long with any dt that divides the map's step, and windows of a
   point at most. Not collective. */
PETSC_INTERN void MapCountWindows(Map map, PetscReal dt, PetscInt *n_steps, PetscInt *n_windows);

/* point/modes.c - pure: of n eigenvalues (rad/s) the fastest mode; into the row those that grow, fastest first */
PETSC_INTERN void MapModesJudge(PetscInt n, const PetscReal sigma[], const PetscReal omega[], MapFastest *fastest);
PETSC_INTERN void MapModesTake(PetscInt n, const PetscReal sigma[], const PetscReal omega[], const ModesLimit *limit,
                               MapPoint *row);

/* map/bodies.c - bodies of a line of the map below a cut-off, Hz, 0: the map's; their friction, speeds of sliding
   [n_pairs] (m/s) and loads [n_loads] at a place */
PETSC_INTERN PetscErrorCode MapBodiesCreate(Map map, PetscInt line, PetscReal cutoff, MapBodies *bodies);
PETSC_INTERN PetscErrorCode MapBodiesMove(Map map, const MapPoint *at, MapBodies *bodies, PetscReal speed[],
                                          PetscReal loads[]);
PETSC_INTERN PetscErrorCode MapBodiesDestroy(MapBodies *bodies);

/* map/bodies.c - whether all impulses of the bodies are due at t (s) at the latest. Not collective. */
PETSC_INTERN PetscBool MapBodiesAreHit(const MapBodies *bodies, PetscReal t);
/* map/bodies.c - sum [m] of the impulses that act at t in steps of dt (s), or NULL: one between two steps acts at both
   in shares, as in any reduced run. Not collective. */
PETSC_INTERN const PetscReal *MapBodiesKick(const MapBodies *bodies, PetscReal t, PetscReal dt, PetscReal kick[]);

/* map/share.c - numbers 0, 1, ... for ranks that ask; Begin anew is collective, Next is not */
PETSC_INTERN PetscErrorCode MapShareCreate(MPI_Comm comm, MapShare *share);
PETSC_INTERN PetscErrorCode MapShareBegin(MapShare *share, MPI_Comm comm);
PETSC_INTERN PetscErrorCode MapShareNext(MapShare *share, PetscInt *k);
PETSC_INTERN PetscErrorCode MapShareDestroy(MapShare *share);

/* bodies.c - lines at a time: where each has bodies of its own, so many that no rank is idle for long, as far as their
   bodies are small. A line has n_jobs for the ranks, and n_bodies */
PETSC_INTERN PetscErrorCode MapCountBatch(Map map, PetscInt n_jobs, PetscInt n_bodies, PetscInt *batch);

/* point/chain.c - the k-th point of a chain, without numbers; steps dt on some bodies (borrowed), laws to rtol; all
   points of a chain, row [n_linked], and a point from its own sliding state, with rates [m] beside that or NULL, row
   with its place; not collective */
PETSC_INTERN void           MapChainPlace(Map map, PetscInt chain, PetscInt k, MapPoint *row);
PETSC_INTERN PetscErrorCode MapMarchCreate(Map map, MapBodies *bodies, PetscReal dt, PetscReal rtol, MapMarch *march);
PETSC_INTERN PetscErrorCode MapChain(MapMarch march, PetscInt chain, MapPoint row[]);
PETSC_INTERN PetscErrorCode MapMarchAlone(MapMarch march, const PetscReal rate[], MapPoint *row);
PETSC_INTERN PetscErrorCode MapMarchDestroy(MapMarch *march);

/* point/march.c - a transient from `state` until its regime is known; end MAP_FAILED where it has none. Not
   collective */
PETSC_INTERN PetscErrorCode MapMarchTry(MapMarch march, MapPoint *row);

/* point/judge.c - eigenvalues about sliding with the pairs of `status` closed; whether the last motion dies out: no
   mode of the sliding state, or with the pairs that are closed now, grows, and the rms falls from window to window: two
   of them in which no pair changed its status, or four of a small vibration; the regime of a transient that has ended,
   and its numbers: of the windows that agree, or the last half of all. Not collective */
PETSC_INTERN PetscErrorCode MapMarchLinearise(MapMarch march, const ContactStatus status[], MapFastest *fastest);
PETSC_INTERN PetscErrorCode MapMarchDiesOut(MapMarch march, PetscBool *dies);
PETSC_INTERN PetscErrorCode MapMarchJudge(MapMarch march, MapPoint *row);

/* point/twins.c - what rounding changes of a point: room for twins; where the point begins, after its sliding state;
   after its transient the twins of it, from `begin`, its row before, and what they say, into the row. Not collective */
PETSC_INTERN PetscErrorCode MapTwinsCreate(MapMarch march);
PETSC_INTERN PetscErrorCode MapTwinsBegin(MapMarch march);
PETSC_INTERN PetscErrorCode MapTwinsRun(MapMarch march, const MapPoint *begin, MapPoint *row);
PETSC_INTERN PetscErrorCode MapTwinsDestroy(MapMarch march);

/* The end of a chain, to be kept or taken up */
typedef struct {
  const ReducedModel *model;
  ReducedState       *state;
  PetscInt            n_twins;
  ReducedState       *twin; /* [n_twins] and how many are alive */
  PetscInt           *n_alive;
} MapKept;

/* map/keep.c - the journal; bodies and chains that a killed map goes on with: good is false, and the number of rows 0,
   where there are none of this scene; takes their files away. Chains are not collective, and are taken with kept bodies
   only */
PETSC_INTERN PetscErrorCode MapJournalOpen(Map map, Results results);
PETSC_INTERN PetscErrorCode MapKeepChain(Map map, PetscInt chain, PetscInt n_rows, MapPoint row[], MapKept *kept);
PETSC_INTERN PetscErrorCode MapResumeChain(Map map, PetscInt chain, PetscInt *n_rows, MapPoint row[], MapKept *kept);
PETSC_INTERN PetscErrorCode MapForget(Map map);
/* disturbed runs from `first` on, n of some size each, alike on all ranks; n = 0 where none are kept. Collective */
PETSC_INTERN PetscErrorCode MapKeepRuns(Map map, PetscInt first, size_t size, PetscInt n, void *run);
PETSC_INTERN PetscErrorCode MapResumeRuns(Map map, PetscInt first, size_t size, PetscInt *n, void *run);

/* map/keep.c - bodies that an earlier run has kept, or made and kept. Collective */
PETSC_INTERN PetscErrorCode MapBodiesGet(Map map, PetscInt line, MapBodies *bodies);

/* point/force.c - pure: what n forces are like, f <= 0 being none; root of the mean square over n windows, and its
   relative standard error, as if they were independent; main line of forces dt apart, in records of n, Hz, NAN for
   none */
PETSC_INTERN void      MapForceMeasure(PetscInt n, const PetscReal f[], MapSample *sample);
PETSC_INTERN PetscReal MapForceLevel(PetscInt n, const MapSample sample[], PetscReal *error);
PETSC_INTERN PetscReal MapForceLine(PetscInt n_records, PetscInt n, const PetscReal f[], PetscReal dt);
/* whether n windows end in a vibration that is settled, or steady in the mean (map.h), and its error then */
PETSC_INTERN PetscBool MapIsSettled(PetscInt n, const MapSample sample[], PetscReal rtol, PetscReal *error);
PETSC_INTERN PetscBool MapIsSteady(PetscInt n, const MapSample sample[], PetscReal rtol, PetscReal *error);

/* point/spread.c - pure: quantiles 5, 50 and 95 % of n numbers, which are sorted; what in 5 of 100 the mean of n
   numbers is off from that of as many others; the same, relative, of the root of the mean square over n_runs transients
   of n[] windows, of rms [n_runs][stride] */
PETSC_INTERN PetscErrorCode MapSpreadQuantiles(PetscInt n, PetscReal x[], PetscReal quantile[MAP_N_QUANTILES]);
PETSC_INTERN PetscReal      MapSpreadOfMean(PetscInt n, const PetscReal x[]);
PETSC_INTERN PetscReal MapSpreadOfLevel(PetscInt n_runs, const PetscInt n[], PetscInt stride, const PetscReal rms[]);

/* map/verify.c - errors of step, contact laws and cut-off at some points, into map_errors.csv */
PETSC_INTERN PetscErrorCode MapVerify(Map map, Results results);

/* map/basins.c - disturbed runs of all points and what they end in, into map_disturbed.csv and map_basins.csv */
PETSC_INTERN PetscErrorCode MapBasins(Map map, Results results);

/* map/write.c - the tables */
PETSC_INTERN PetscErrorCode MapTableOpen(Results results, ResultsTable *table);
PETSC_INTERN PetscErrorCode MapTableAdd(Map map, ResultsTable table, const MapPoint *point);
PETSC_INTERN PetscErrorCode MapModesOpen(Results results, ResultsTable *table);
PETSC_INTERN PetscErrorCode MapModesAdd(Map map, ResultsTable table, const MapPoint *point);
PETSC_INTERN PetscErrorCode MapErrorsOpen(Results results, ResultsTable *table);
PETSC_INTERN PetscErrorCode MapErrorsAdd(Map map, ResultsTable table, const char run[], const MapPoint *point,
                                         const MapError *error);
PETSC_INTERN PetscErrorCode MapDisturbedOpen(Results results, ResultsTable *table);
PETSC_INTERN PetscErrorCode MapDisturbedAdd(Map map, ResultsTable table, PetscInt run, PetscReal energy,
                                            const MapPoint *point);
PETSC_INTERN PetscErrorCode MapBasinOpen(Results results, ResultsTable *table);
PETSC_INTERN PetscErrorCode MapBasinAdd(Map map, ResultsTable table, const MapBasin *basin);
