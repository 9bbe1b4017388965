/* Private to reduced/cycle/: the flow of the reduced model, models over a parameter, and what is found */
#pragma once

#include <squeal/cycle.h>
#include <squeal/options.h>
#include <squeal/quantity.h>
#include "reduced/parameter.h"
#include "reduced/reducedimpl.h"
#include "solver/shooting/shooting.h"

#define CYCLE_BY  "-analysis cycle"
#define CYCLE_FAR 1e3 /* s, when ramps are over */

/* Matrices of a reduced model that a parameter of the bodies changes */
typedef enum { FAMILY_K, FAMILY_C, FAMILY_P, FAMILY_W, FAMILY_CM, FAMILY_CX, FAMILY_N_PARTS } CycleFamilyPart;

/* Reduced models over a parameter of the bodies */
typedef struct CycleModels {
  ReducedRun                scene; /* borrowed, as are the next two */
  const ReducedParameter   *parameter;
  const struct CycleModels *beside; /* further ones that take memory meanwhile, borrowed; NULL for none */
  PetscReal                *p;      /* [parameters] of the operators */
  PetscReal                 range[2];
  PetscBool                 logarithmic;
  PetscInt                  n, size[FAMILY_N_PARTS];
  PetscReal *(*part)[FAMILY_N_PARTS]; /* [n] matrices at the points, from the end of the range to its beginning */
  PetscReal      error;               /* of the interpolation, relative */
  ReducedModel   model;               /* at `value` */
  PetscReal      value, *Q;           /* [m][m] modes of the model in coordinates of the scene */
  PetscInt       n_reductions;
  PetscLogDouble seconds;
} CycleFamily;

/* What probes do in a cycle, one direction: rms and largest distance from the mean, m; rms and largest velocity, m/s */
typedef struct {
  PetscReal displacement_rms, displacement_peak, velocity_rms, velocity_peak;
} CycleProbe;

/* A reduced model under constant loads and sliding; x is in coordinates of the scene */
typedef struct {
  ReducedModel           *model;             /* borrowed; what is varied changes in it */
  const ReducedParameter *varied;            /* borrowed; NULL for none */
  CycleFamily            *family;            /* its models, where it changes the bodies */
  PetscReal               value;             /* of the parameter in the model */
  PetscInt               *interface;         /* [n_pairs] */
  PetscReal              *loads;             /* [n_loads] factors */
  FrictionLaw            *stated;            /* [n_pairs] of the scene */
  PetscReal              *share;             /* [n_pairs] of the speed that is prescribed as sliding: 1 after ramps */
  PetscReal              *way;               /* [n_pairs] in a step, m */
  PetscInt                n_steps, n;        /* in a period; unknowns of the state */
  PetscInt                first, n_looked;   /* ports of the probes */
  PetscReal               contact, friction; /* works in a period that is measured, J */
  PetscReal              *force; /* [n_steps] normal force after each, N; NULL but while a cycle is measured */
  PetscReal              *shown; /* [n_steps][3][n_looked] displacement, residual part of it, velocity of the modes */
  PetscReal              *rates; /* [n_steps][m] of the scene's modes; NULL but while a cycle is heard */
  PetscReal               dt;    /* of the stepper */
  ReducedStepper          stepper;
  ReducedTangent          tangent;
  ReducedState            state;
  ReducedReport           report;
  PetscInt                n_flows; /* periods that were integrated */
} CycleFlow;

/* What a cycle radiates: harmonic 0, all together, and 1 to n, each a row of sound.h */
typedef struct {
  PetscInt   n, n_row;
  PetscReal *row; /* [n + 1][n_row], NULL where nobody listens */
} CycleSound;

/* A cycle in numbers */
typedef struct {
  PetscReal freq;                   /* Hz */
  PetscReal mean, rms, peak, least; /* of the normal force, N; rms about the mean */
  PetscReal open;                   /* share of the steps without force */
  PetscBool made;                   /* contact, which does no work, feeds it */
} CycleMeasure;

typedef struct {
  PetscReal    value, value_error; /* the latter of folds, else negative */
  PetscInt     n_steps, its;
  PetscReal    residual;
  CycleMeasure found, finer, higher; /* finer: with twice the steps; higher: with a higher cut-off; where asked for */
  CycleMeasure spread; /* largest differences of frequency, rms and peak where the steps begin elsewhere */
  PetscBool    has_finer, has_higher, wants_higher, fold;
  ShootingStability stability, finer_stability, higher_stability;
  PetscReal         multiplier_spread;
  CycleProbe       *probe, *finer_probe, *spread_probe; /* [n_looked] */
  CycleSound        sound, finer_sound, higher_sound;
} CyclePoint;

typedef struct _p_CycleHigher *CycleHigher;

struct _p_LimitCycle {
  MPI_Comm           comm;
  PetscInt           steps, max_it, max_points; /* options */
  PetscReal          rtol, range[2], amplitude;
  char               parameter[256];
  PetscBool          verify, verify_cutoff, from_mode, has_range;
  ReducedRun         reduced;
  Operators          operators;
  Results            results;
  Sound              sound; /* NULL: nobody listens */
  PetscReal         *p;     /* [parameters] of the operators */
  ReducedParameter   varied;
  CycleFamily       *family;
  const CycleFamily *beside; /* borrowed: of the cycles with a lower cut-off */
  CycleHigher        higher; /* bodies with a higher cut-off; NULL unless asked for */
  CycleFlow          flow;
  Shooting           shooting;
  PetscReal          closure;  /* of the guess: distance over the size of the vibration */
  PetscReal          onset[3]; /* parameter, growth (1/s) and frequency (Hz) where -cycle_start mode begins */
  PetscInt           n_points;
  CyclePoint        *point;
  PetscBool          in_front; /* cycles that are taken come before those that are there */
  PetscReal          rms;      /* of the vibration that distances are over, N */
  const char        *end[2];   /* why the branch ends, both ways; NULL for no branch */
};

/* quantities.c - rows of the options */
extern const QuantityTable cycle_quantities;

/* family.c - the models, p [parameters] and others `beside` them, or NULL, borrowed; whether there is one at a value;
   that at it; eta of columns `stride` apart from the scene's coordinates to those of the model, or back */
PETSC_INTERN PetscErrorCode CycleFamilyCreate(ReducedRun scene, const ReducedParameter *parameter,
                                              const PetscReal range[2], PetscReal p[], const CycleFamily *beside,
                                              CycleFamily **family);
PETSC_INTERN PetscBool      CycleFamilyHolds(const CycleFamily *family, PetscReal value);
PETSC_INTERN PetscErrorCode CycleFamilySet(CycleFamily *family, PetscReal value);
PETSC_INTERN PetscErrorCode CycleFamilyTurn(const CycleFamily *family, PetscBool to_scene, PetscInt columns,
                                            PetscInt stride, PetscReal X[]);
PETSC_INTERN PetscErrorCode CycleFamilyDestroy(CycleFamily **family);

/* memory.c - shows what `most` of its models take, with those beside it, and raises the error where there is less.
   Collective */
PETSC_INTERN PetscErrorCode CycleFamilyCheckMemory(const CycleFamily *family, PetscInt most);

/* flow.c - the model of a run, loads and sliding constant from its time on; the state of a run as x; Phi, M
   (ShootingFlow); the parameter in the model */
PETSC_INTERN PetscErrorCode CycleFlowCreate(ReducedRun reduced, CycleFlow *flow);
PETSC_INTERN PetscErrorCode CycleFlowPack(const CycleFlow *flow, const ReducedState *state, PetscReal x[]);
PETSC_INTERN PetscErrorCode CycleFlowSetValue(CycleFlow *flow, PetscReal value);
PETSC_INTERN PetscErrorCode CycleFlowRun(void *flow, const PetscReal x[], PetscReal period, PetscReal value,
                                         PetscReal y[], PetscReal M[]);
PETSC_INTERN PetscErrorCode CycleFlowDestroy(CycleFlow *flow);

/* sound.c - keeps the rates of the next period that is measured, where somebody listens; what that cycle radiates, of
   modes up to `cutoff` (Hz), for the caller to free; the table. Collective */
PETSC_INTERN PetscErrorCode CycleListen(LimitCycle cycle);
PETSC_INTERN PetscErrorCode CycleHear(LimitCycle cycle, PetscReal period, PetscReal cutoff, CycleSound *heard);
PETSC_INTERN PetscErrorCode CycleWriteSound(LimitCycle cycle);

/* measure.c - a cycle in numbers; probe [n_looked] or NULL */
PETSC_INTERN PetscErrorCode CycleFlowMeasure(CycleFlow *flow, const ShootingCycle *cycle, CycleMeasure *measure,
                                             CycleProbe probe[]);

/* guess.c - period and state at the end of the run, and the sizes of what changes: rms of eta, of rates and of
   forces */
PETSC_INTERN PetscErrorCode CycleGuess(LimitCycle cycle, ShootingCycle *guess);
PETSC_INTERN PetscErrorCode CycleSetSizes(LimitCycle cycle, const PetscReal size[3]);

/* onset.c - where a mode of the sliding state becomes unstable, and the cycle of an amplitude that begins there; the
   direction from rest to it */
PETSC_INTERN PetscErrorCode CycleBegin(LimitCycle cycle, ShootingCycle *at, ShootingTangent *growing);

/* cycle.c - the parameter in the flow, and models over it; how shooting goes about it; the cycle in numbers, with its
   stability and error, becomes a row; `along`: of a fold, whose parameter is known to `error`, or NULL and -1 */
PETSC_INTERN PetscErrorCode CycleSetParameter(LimitCycle cycle);
PETSC_INTERN PetscErrorCode CycleSetShooting(LimitCycle cycle, PetscReal period);
PETSC_INTERN PetscErrorCode CycleTake(LimitCycle cycle, const ShootingCycle *at, const ShootingTangent *along,
                                      PetscReal error);

/* refine.c - the same cycle with other steps, for its errors; of a fold, whose parameter is a result, the one at the
   same distance `along` the branch */
PETSC_INTERN PetscErrorCode CycleRefine(LimitCycle cycle, const ShootingCycle *at, const ShootingTangent *along,
                                        CyclePoint *point);

/* higher.c - the same flow on bodies with 2.25 times the cut-off, after CycleSetSizes(); the cycle there that a cycle
   is near, `along` as for CycleRefine(): of a fold the change of the parameter adds to its error */
PETSC_INTERN PetscErrorCode CycleHigherCreate(LimitCycle cycle, CycleHigher *higher);
PETSC_INTERN PetscErrorCode CycleHigherLook(CycleHigher higher, const ShootingCycle *at, const ShootingTangent *along,
                                            CyclePoint *point);
PETSC_INTERN PetscErrorCode CycleHigherDestroy(CycleHigher *higher);

/* branch.c - the branch, in order, through the one cycle that was taken; `growing`: the direction along it that is gone
   last, NULL for rising values */
PETSC_INTERN PetscErrorCode CycleFollow(LimitCycle cycle, const ShootingCycle *start, const ShootingTangent *growing);

/* write.c - all tables as they are by now; the error of a number beside that of twice the steps and the spread over
   where steps begin, and that of the largest multiplier by the steps; the class of a cycle that was found to `rtol`:
   stable, unstable, numerical where its error leaves that open, unverified where the error is not known, and why that
   is, NULL for the first two */
PETSC_INTERN PetscErrorCode CycleWrite(LimitCycle cycle);
PETSC_INTERN PetscReal      CycleError(PetscReal found, PetscReal finer, PetscReal spread);
PETSC_INTERN PetscReal      CycleMultiplierError(const CyclePoint *point);
PETSC_INTERN const char    *CycleClass(const CyclePoint *point, PetscReal rtol, const char **why);
PETSC_INTERN PetscReal      CycleMultiplier(const ShootingStability *stability);
