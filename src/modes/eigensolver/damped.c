/*
   Damped problem (lambda^2 M + lambda C + K) x = 0: PEP TOAR with shift-and-invert about a real positive shift s. The
   modes lie near the imaginary axis at +- i omega, at distances sqrt(omega^2 + s^2) from the shift, so they converge
   from low to high frequency, and a window is reached by converging all below it. Of each conjugate pair the one with
   omega > 0 is kept.

   With C = beta K all of them lie on the circle |lambda + 1/beta| = 1/beta, and thousands of overdamped ones gather
   near
   -1/beta. These must stay farther from the shift than the window's corners, sigma + i high: a shift of 0.3 high is the
   fastest where beta high is small, one of high where it is near one. Systems of few unknowns are solved by LAPACK
   (dampeddense.c).
*/
#include "modes/modesimpl.h"

PetscErrorCode DampedSolve(Modes modes, const PencilMatrices *pencil, const Window *window, ShiftInvert *si,
                           PetscBool transposed, Spectrum *spectrum)
{
  PetscBool dense, empty;

  PetscFunctionBeginUser;
  PetscCall(DampedHasEmpty(pencil->K, &empty));
  PetscCall(DampedIsDense(modes, pencil->K, DampedFirst(window), 0, &dense));
  if (dense)
    PetscCall(DampedSolveDense(modes, pencil, window, si->shift, transposed, spectrum));
  else if (empty)
    PetscCall(DampedSolveSpread(modes, pencil, window, si->shift, transposed, spectrum));
  else
    PetscCall(DampedSolvePep(modes, pencil, window, si, transposed, spectrum));
  PetscFunctionReturn(0);
}
