/*
   Where the eigensolvers look: the shift of a window, and how far about it all eigenvalues of the window are.
*/
#include "modes/modesimpl.h"

PetscReal DampedShift(const Window *window)
{
  const PetscReal high = PetscMax(window->high, window->target);

  return high * PetscMax(0.3, PetscMin(1, high * window->known.damping));
}

PetscReal DampedRadius(const Window *window, PetscReal shift, const Spectrum *found)
{
  if (!window->count) return hypot(window->high, shift + window->growth);
  if (found->n < window->count) return PETSC_MAX_REAL;
  return hypot(window->target, shift) + WindowNearest(window, found);
}

/* Without a target, or with one near zero, the shift lies below zero, where rigid modes may be. Rounding of an
   eigenvalue there by its inverse, 1 / (kappa - shift), spoils the others by as much: 1e-8 of the unknowns' own below
   leaves 1e-8 of these at worst. In a band it lies amid kappa, so that few modes outside are as near as those inside;
   where the band begins at low frequencies, which there lose digits, at 0.3: on the default brake 0.25, 0.3, 0.35 take
   288, 280, 272 solves, and right and left eigenvalues agree to 7e-11, 3e-11, 9e-11, with LU to 3e-11, 4e-11, 1e-9. */
PetscReal UndampedShift(const Window *window)
{
  const PetscReal low = window->low * window->low, high = window->high * window->high;
  const PetscReal below = -PetscSqr((window->known.singular ? 100 : 10) * window->known.scale);

  if (window->count) return window->target > 10 * window->known.scale ? window->target * window->target : below;
  return low + PetscMin(0.5, 0.3 + 1.2 * low / high) * (high - low);
}

/* Radius about the shift, in the plane of kappa = -lambda^2, that the converged eigenvalues must exceed. Band: the
   farthest corner sigma + i omega of the window. Target t: all |lambda - i t| <= d lie within |kappa - t^2| <= 2 t d
   + d^2. */
PetscReal UndampedRadius(const Window *window, PetscReal shift, const Spectrum *found)
{
  const PetscReal low = window->low, high = window->high, s = window->growth, t = window->target;
  PetscReal       d;

  if (!window->count)
    return PetscMax(hypot(high * high - s * s - shift, 2 * s * high), hypot(low * low - s * s - shift, 2 * s * low));
  if (found->n < window->count) return PETSC_MAX_REAL;
  d = WindowNearest(window, found);
  return 2 * t * d + d * d + PetscAbsReal(shift - t * t);
}

static PetscReal WindowDistance(const Window *window, const Spectrum *s, PetscInt i)
{
  return PetscSqrtReal(PetscSqr(s->omega[i] - window->target) + PetscSqr(s->sigma[i]));
}

/* Distance of the count-th nearest eigenvalue to the target */
PetscReal WindowNearest(const Window *window, const Spectrum *found)
{
  PetscReal distance = 0;

  for (PetscInt i = 0; i < found->n; i++) {
    PetscInt nearer = 0;

    for (PetscInt j = 0; j < found->n; j++)
      nearer += WindowDistance(window, found, j) < WindowDistance(window, found, i);
    if (nearer < window->count) distance = PetscMax(distance, WindowDistance(window, found, i));
  }
  return distance;
}

/* The eigenvalue farthest from the target; of a double one the last, so that the order of frequency decides */
PetscInt WindowFarthest(const Window *window, const Spectrum *s)
{
  PetscInt farthest = 0;

  for (PetscInt i = 1; i < s->n; i++)
    if (WindowDistance(window, s, i) >= WindowDistance(window, s, farthest)) farthest = i;
  return farthest;
}

PetscBool WindowLacks(const Window *window, const Spectrum *s)
{
  const PetscInt wanted = window->known.finite < 0 ? window->count : PetscMin(window->count, window->known.finite);

  return window->known.singular && window->count && s->n < wanted ? PETSC_TRUE : PETSC_FALSE;
}

PetscInt DampedFirst(const Window *window)
{
  if (window->count) return 2 * (PetscMax(0, window->known.below) + window->count + window->extra);
  return window->known.within >= 0 ? 2 * (window->known.within + window->extra) : 40;
}
