/*
   Points of a line between those that were solved. The standard form of the pencil is the same at all of them, damped
   when there is damping anywhere on the line.
*/
#include "frame.h"

void BranchLineSet(const BranchLine *line, PetscReal value, PetscReal p[])
{
  for (PetscInt i = 0; i < line->n_moved; i++) p[line->parameter[i]] = value;
}

static void SourceSetValue(ModeSource *source, PetscReal value)
{
  for (PetscInt i = 0; i < source->reduced->n_parameters; i++) source->p[i] = source->line->base[i];
  BranchLineSet(source->line, value, source->p);
}

/* Damped or not is asked at both ends and in the middle: a coefficient may vanish at an end, or at both. scale,
   rad/s, is the upper end of the window, alike for all points, so that products of two points have one measure. */
PetscErrorCode ModeSourceCreate(const Reduced *reduced, const BranchLine *line, ModeSource *source)
{
  const PetscReal first = line->value[0], last = line->value[line->n - 1], high = line->window->high;
  const PetscReal value[3] = {first, last, first + 0.5 * (last - first)};

  PetscFunctionBeginUser;
  *source = (ModeSource){.reduced = reduced, .line = line, .form = {.scale = high > 0 && high < 1e100 ? high : 1}};
  PetscCall(PetscMalloc1(reduced->n_parameters, &source->p));
  for (int i = 0; i < 3; i++) {
    SourceSetValue(source, value[i]);
    if (ReducedIsDamped(reduced, source->p)) source->form.damped = PETSC_TRUE;
  }
  PetscFunctionReturn(0);
}

PetscErrorCode ModeSourceTake(ModeSource *source, PetscReal value, const ReducedModes *modes, ModeFrame **frame)
{
  PetscFunctionBeginUser;
  SourceSetValue(source, value);
  PetscCall(ModeFrameCreate(source->reduced, source->p, &source->form, FRAME_REFINED, modes, frame));
  (*frame)->value = value;
  PetscFunctionReturn(0);
}

/* All modes of the window at a value; errors only where they are wanted, as the estimate costs more than the
   solution. */
PetscErrorCode ModeSourceSolve(ModeSource *source, PetscReal value, ModeFrame **frame)
{
  ReducedModes modes = {0};

  PetscFunctionBeginUser;
  SourceSetValue(source, value);
  source->n_solved++;
  PetscCall(ReducedSolve(source->reduced, source->p, source->line->window, &modes));
  if (source->estimate) PetscCall(ReducedEstimate(source->reduced, source->p, &modes));
  PetscCall(ModeSourceTake(source, value, &modes, frame));
  PetscCall(ReducedModesDestroy(&modes));
  PetscFunctionReturn(0);
}

PetscErrorCode ModeSourceFollow(ModeSource *source, PetscReal value, PetscComplex lambda, const ReducedModes *from,
                                ModeFrame **frame, PetscBool *found)
{
  ReducedModes modes = {0};

  PetscFunctionBeginUser;
  SourceSetValue(source, value);
  source->n_followed++;
  PetscCall(ReducedFollow(source->reduced, source->p, lambda, from, &modes));
  *found = modes.n ? PETSC_TRUE : PETSC_FALSE;
  if (*found && source->estimate) PetscCall(ReducedEstimate(source->reduced, source->p, &modes));
  if (*found) PetscCall(ModeSourceTake(source, value, &modes, frame));
  PetscCall(ReducedModesDestroy(&modes));
  PetscFunctionReturn(0);
}
