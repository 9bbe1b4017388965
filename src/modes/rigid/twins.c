/*
   Rigid modes of a damped system. Such a mode is a double zero, lambda^2 M x + lambda C x = 0 with C x = 0, that
   rounding splits into two tiny eigenvalues; with C x = alpha M x it is one zero and lambda = -alpha. Among the modes
   found to be rigid, as many are kept as the frictionless system has.
*/
#include "modes/modesimpl.h"

/* Removes mode i */
static PetscErrorCode ModeRemove(Modes modes, PetscInt i)
{
  PetscFunctionBeginUser;
  PetscCall(SpectrumRemove(&modes->right, i));
  if (modes->left_spectrum.n) PetscCall(SpectrumRemove(&modes->left_spectrum, i));
  for (PetscInt j = i; j + 1 < modes->n; j++) modes->mode[j] = modes->mode[j + 1];
  modes->n--;
  PetscFunctionReturn(0);
}

PetscErrorCode TwinsDrop(Modes modes, const Window *window)
{
  PetscInt n_rigid = 0;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < modes->n; i++) n_rigid += modes->mode[i].rigid;
  for (PetscInt i = modes->n - 1; i >= 0 && n_rigid > window->known.rigid; i--) {
    if (!modes->mode[i].rigid) continue;
    PetscCall(ModeRemove(modes, i));
    n_rigid--;
  }
  PetscFunctionReturn(0);
}

PetscErrorCode TwinsTrim(Modes modes, const Window *window)
{
  PetscFunctionBeginUser;
  while (window->count && modes->n > window->count) PetscCall(ModeRemove(modes, WindowFarthest(window, &modes->right)));
  PetscFunctionReturn(0);
}
