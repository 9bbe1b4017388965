/* Private to reduced/cycle/: the flow of the reduced model, and what is found */
#pragma once

#include <squeal/cycle.h>
#include "reduced/reducedimpl.h"
#include "solver/shooting.h"

/* A reduced model under constant loads and sliding */
typedef struct {
  ReducedModel  *model;      /* borrowed; its friction changes */
  PetscReal     *loads;      /* [n_loads] factors */
  PetscReal     *speed;      /* [n_pairs] prescribed sliding, m/s */
  PetscReal     *way;        /* [n_pairs] in a step, m */
  PetscBool     *varies;     /* [n_pairs] mu of these is the parameter; NULL for none */
  PetscReal      span;       /* of the parameter */
  PetscInt       n_steps, n; /* in a period; unknowns of the state */
  PetscReal     *force;      /* [n_steps] normal force after each, N */
  PetscReal      dt;         /* of the stepper */
  ReducedStepper stepper;
  ReducedTangent tangent;
  ReducedState   state;
  ReducedReport  report;
  PetscInt       n_flows; /* periods that were integrated */
} CycleFlow;

/* A cycle in numbers */
typedef struct {
  PetscReal freq;                   /* Hz */
  PetscReal mean, rms, peak, least; /* of the normal force, N; rms about the mean */
  PetscReal open;                   /* share of the steps without force */
} CycleMeasure;

typedef struct {
  PetscReal         value;
  PetscInt          n_steps, its;
  PetscReal         residual;
  CycleMeasure      found, finer; /* finer: with twice the steps, where asked for */
  PetscBool         has_finer;
  ShootingStability stability, finer_stability;
} CyclePoint;

struct _p_LimitCycle {
  MPI_Comm    comm;
  PetscInt    steps, max_it, max_points; /* options */
  PetscReal   rtol, range[2];
  char        parameter[256];
  PetscBool   verify;
  ReducedRun  reduced;
  Contact     contact;
  PetscInt    varied; /* interface of the parameter, -1 for none */
  PetscReal   value;  /* of the parameter, in the scene */
  CycleFlow   flow;
  Shooting    shooting;
  PetscReal   closure; /* of the guess: distance over the size of the vibration */
  PetscInt    n_points;
  CyclePoint *point;
  PetscReal   rms;    /* of the first cycle, N */
  const char *end[2]; /* why the branch ends, both ways; NULL for no branch */
};

/* flow.c - the model of a run at its end, loads and sliding constant from there; the state of a run as x, and back; Phi, M
   (ShootingFlow); the last period in numbers */
PETSC_INTERN PetscErrorCode CycleFlowCreate(ReducedRun reduced, CycleFlow *flow);
PETSC_INTERN void           CycleFlowPack(const CycleFlow *flow, const ReducedState *state, PetscReal x[]);
PETSC_INTERN PetscErrorCode CycleFlowSetSteps(CycleFlow *flow, PetscInt n_steps);
PETSC_INTERN PetscErrorCode CycleFlowRun(void *flow, const PetscReal x[], PetscReal period, PetscReal value,
                                         PetscReal y[], PetscReal M[]);
PETSC_INTERN void           CycleFlowMeasure(const CycleFlow *flow, PetscReal period, CycleMeasure *measure);
PETSC_INTERN PetscErrorCode CycleFlowDestroy(CycleFlow *flow);

/* guess.c - period and state at the end of the run, and the sizes of what changes */
PETSC_INTERN PetscErrorCode CycleGuess(LimitCycle cycle, ShootingCycle *guess);

/* cycle.c - the cycle in numbers, with its stability and error, becomes a row */
PETSC_INTERN PetscErrorCode CycleTake(LimitCycle cycle, const ShootingCycle *at);

/* branch.c - the parameter, before the transient, and in the flow; the branch, in order, through the one cycle that was taken */
PETSC_INTERN PetscErrorCode CycleFindParameter(LimitCycle cycle);
PETSC_INTERN PetscErrorCode CycleSetParameter(LimitCycle cycle);
PETSC_INTERN PetscErrorCode CycleFollow(LimitCycle cycle, const ShootingCycle *start);
