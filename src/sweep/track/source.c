/*
   Points of a line between those that were solved. The standard form of the pencil is the same at all of them, damped
   when there is damping anywhere on the line.
*/
#include "frame.h"

static void SourceSetValue(ModeSource *source, PetscReal value)
{
  for (PetscInt i = 0; i < source->reduced->n_parameters; i++) source->p[i] = source->line->base[i];
  source->p[source->line->parameter] = value;
}

PetscErrorCode ModeSourceCreate(const Reduced *reduced, const ReducedWindow *window, const Line *line,
                                ModeSource *source)
{
  const PetscReal first = line->value[0], last = line->value[line->n - 1];
  const PetscReal value[3] = {first, last, first + 0.5 * (last - first)};
  const PetscInt  n        = reduced->n_used;
  PetscReal      *C;

  PetscFunctionBeginUser;
  source->reduced  = reduced;
  source->window   = window;
  source->line     = line;
  source->scale    = window->high > 0 && window->high < 1e100 ? window->high : 1;
  source->damped   = PETSC_FALSE;
  source->estimate = PETSC_FALSE;
  PetscCall(PetscMalloc1(reduced->n_parameters, &source->p));
  PetscCall(PetscMalloc1(n * n, &C));
  for (int i = 0; i < 3; i++) {
    PetscBool any;

    SourceSetValue(source, value[i]);
    PetscCall(ReducedSum(reduced, OPERATORS_DAMPING, source->p, n, C, &any));
    source->damped = (PetscBool)(source->damped || any);
  }
  PetscCall(PetscFree(C));
  PetscFunctionReturn(0);
}

PetscErrorCode ModeSourceTake(ModeSource *source, PetscReal value, const ReducedModes *modes, ModeFrame **frame)
{
  PetscFunctionBeginUser;
  SourceSetValue(source, value);
  PetscCall(
    ModeFrameCreate(source->reduced, source->p, value, source->damped, source->scale, PETSC_TRUE, modes, frame));
  PetscFunctionReturn(0);
}

PetscErrorCode ModeSourceSolve(ModeSource *source, PetscReal value, ModeFrame **frame)
{
  ReducedModes modes = {0};

  PetscFunctionBeginUser;
  SourceSetValue(source, value);
  PetscCall(ReducedSolve(source->reduced, source->p, source->window, &modes));
  if (source->estimate) PetscCall(ReducedEstimate(source->reduced, source->p, &modes));
  PetscCall(ModeSourceTake(source, value, &modes, frame));
  PetscCall(ReducedModesDestroy(&modes));
  PetscFunctionReturn(0);
}

PetscErrorCode ModeSourceDestroy(ModeSource *source)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(source->p));
  PetscFunctionReturn(0);
}
