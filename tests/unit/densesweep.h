/* Sweeps of the small models of densereduced.h, with their branches and events */
#pragma once

#include "check.h"
#include "densereduced.h"

#define MAX_POINTS 1201

/* A sweep with its results */
typedef struct {
  BranchLine   line;
  PetscInt     parameter[1];
  PetscReal    value[MAX_POINTS], base[1];
  ReducedModes modes[MAX_POINTS];
  PetscInt    *branch[MAX_POINTS], n_branches;
  BranchEvents events;
} Run;

/* n equal steps from first to last */
static inline PetscErrorCode RunSweep(const Dense *dense, const ReducedWindow *window, PetscReal first, PetscReal last,
                                      PetscInt n, Run *run)
{
  PetscFunctionBeginUser;
  memset(run, 0, sizeof(*run));
  run->line.n         = n;
  run->line.n_moved   = 1;
  run->line.parameter = run->parameter;
  run->line.value     = run->value;
  run->line.base      = run->base;
  run->line.window    = window;
  for (PetscInt k = 0; k < n; k++) {
    run->value[k] = first + (last - first) * k / (n - 1);
    PetscCall(ReducedSolve(&dense->system.reduced, &run->value[k], window, &run->modes[k]));
    PetscCall(PetscMalloc1(run->modes[k].n, &run->branch[k]));
  }
  PetscCall(TrackLine(&dense->system.reduced, &run->line, run->modes, run->branch, &run->n_branches, &run->events));
  PetscFunctionReturn(0);
}

static inline PetscErrorCode RunDestroy(Run *run)
{
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < run->line.n; k++) {
    PetscCall(ReducedModesDestroy(&run->modes[k]));
    PetscCall(PetscFree(run->branch[k]));
  }
  PetscCall(BranchEventsDestroy(&run->events));
  PetscFunctionReturn(0);
}

/* Mode of a branch at a point, -1 for none */
static inline PetscInt RunMode(const Run *run, PetscInt point, PetscInt branch)
{
  for (PetscInt i = 0; i < run->modes[point].n; i++)
    if (run->branch[point][i] == branch) return i;
  return -1;
}

/* Real part of kappa of a branch at a point; not a number where it does not exist */
static inline PetscReal RunKappa(const Run *run, PetscInt point, PetscInt branch)
{
  const PetscInt i = RunMode(run, point, branch);

  return i < 0 ? NAN : -creal(run->modes[point].lambda[i] * run->modes[point].lambda[i]);
}

/* Event e: kind, and a bracket about the expected value that is not wider than the step */
static inline int CheckEvent(const char name[], const Run *run, PetscInt e, BranchEventKind kind, PetscReal value)
{
  const BranchEvent *event = &run->events.event[e];

  if (e >= run->events.n) return CheckTrue(name, 0, (double)run->events.n);
  return CheckTrue(name, event->kind == kind, (double)event->kind) +
         CheckTrue("  bracket contains the value", event->lower <= value + 1e-8 && value - 1e-8 <= event->upper,
                   value) +
         CheckTrue("  not wider than the step",
                   event->upper - event->lower <= 1.0001 * fabs(run->value[1] - run->value[0]),
                   event->upper - event->lower);
}
