/*
   The window of the eigenvalues asked for. With a symmetric pencil without damping and friction the number of eigenvalues
   kappa = omega^2 below s is the number of negative pivots of K - s M (Sylvester's law of inertia; B. N. Parlett, The Symmetric
   Eigenvalue Problem, SIAM 1998, sect. 3.3). It sizes the Krylov space, and proves that no real mode is missing.
*/
#include "modesimpl.h"

/* Frictionless modes with frequency below omega (rad/s) */
static PetscErrorCode CountBelow(Modes modes, const OperatorsPencil *pencil, PetscReal omega, PetscInt *n)
{
  ShiftInvert si;

  PetscFunctionBeginUser;
  *n = 0;
  if (omega <= 0) PetscFunctionReturn(0);
  PetscCall(ShiftInvertCreate(pencil, omega * omega, PETSC_TRUE, &modes->progress, &si));
  PetscCall(ShiftInvertGetInertia(&si, n));
  PetscCall(ShiftInvertDestroy(&si));
  PetscFunctionReturn(0);
}

/* A frequency (rad/s) that is small beside all elastic modes, from the size of the matrices */
static PetscErrorCode WindowScale(const OperatorsPencil *pencil, PetscReal *scale)
{
  PetscReal K, M;

  PetscFunctionBeginUser;
  PetscCall(MatNorm(pencil->K, NORM_FROBENIUS, &K));
  PetscCall(MatNorm(pencil->M, NORM_FROBENIUS, &M));
  *scale = 1e-5 * PetscSqrtReal(K / M);
  PetscFunctionReturn(0);
}

PetscErrorCode WindowFind(Modes modes, Window *window)
{
  OperatorsPencil frictionless;
  PetscInt        below_high;

  PetscFunctionBeginUser;
  PetscCall(OperatorsGetFrictionless(modes->operators, &frictionless));
  window->low      = 2 * PETSC_PI * modes->band[0];
  window->high     = 2 * PETSC_PI * modes->band[1];
  window->target   = 2 * PETSC_PI * modes->target;
  window->count    = modes->has_band ? 0 : modes->count;
  window->expected = window->below = -1;
  window->extra    = 6;
  PetscCall(WindowScale(&frictionless, &window->scale));
  if (!frictionless.symmetric) PetscFunctionReturn(0);
  if (!modes->has_band) {
    PetscCall(CountBelow(modes, &frictionless, window->target, &window->below));
    PetscFunctionReturn(0);
  }
  PetscCall(CountBelow(modes, &frictionless, window->low, &window->below));
  PetscCall(CountBelow(modes, &frictionless, window->high, &below_high));
  window->expected = below_high - window->below;
  PetscFunctionReturn(0);
}

/* The damped problem converges from zero upwards and must know how far: the frictionless, undamped modes tell */
PetscErrorCode WindowReach(Modes modes, Window *window)
{
  OperatorsPencil frictionless;
  ShiftInvert     si;
  Spectrum        nearest;

  PetscFunctionBeginUser;
  PetscCall(OperatorsGetFrictionless(modes->operators, &frictionless));
  PetscCall(ShiftInvertCreate(&frictionless, UndampedShift(window), PETSC_FALSE, &modes->progress, &si));
  PetscCall(UndampedSolve(modes, &frictionless, window, &si, PETSC_FALSE, &nearest));
  PetscCall(WindowSelect(window, &nearest));
  for (PetscInt i = 0; i < nearest.n; i++) window->high = PetscMax(window->high, nearest.omega[i]);
  window->high = PetscMax(window->high, window->scale);
  PetscCall(SpectrumDestroy(&nearest));
  PetscCall(ShiftInvertDestroy(&si));
  PetscFunctionReturn(0);
}

/* With damping a rigid mode is a double zero, which rounding splits into two tiny eigenvalues: as many are kept as the
   frictionless system has rigid modes, so that each is listed once */
PetscErrorCode WindowDropTwins(Modes modes, const Window *window, Spectrum *s)
{
  OperatorsPencil frictionless;
  PetscInt        n_zero = 0, n_rigid;

  PetscFunctionBeginUser;
  while (n_zero < s->n && PetscAbsReal(s->sigma[n_zero]) < window->scale && s->omega[n_zero] < window->scale) n_zero++;
  if (!n_zero || window->below < 0) PetscFunctionReturn(0);
  PetscCall(OperatorsGetFrictionless(modes->operators, &frictionless));
  PetscCall(CountBelow(modes, &frictionless, window->scale, &n_rigid));
  if (n_rigid < n_zero) PetscCall(SpectrumKeep(s, n_zero - n_rigid, s->n - (n_zero - n_rigid)));
  PetscFunctionReturn(0);
}

PetscErrorCode WindowSelect(const Window *window, Spectrum *s)
{
  PetscInt first = 0, n = s->n;

  PetscFunctionBeginUser;
  if (window->count) { /* drop the farther end until the count is left; the spectrum is in order of frequency */
    while (n > window->count) {
      const PetscReal below = window->target - s->omega[first], above = s->omega[first + n - 1] - window->target;

      if (below > above) first++;
      n--;
    }
  } else {
    while (n > 0 && s->omega[first] < window->low) first++, n--;
    while (n > 0 && s->omega[first + n - 1] > window->high) n--;
  }
  PetscCall(SpectrumKeep(s, first, n));
  PetscFunctionReturn(0);
}

PetscErrorCode WindowProve(Modes modes, Window *window, const Spectrum *s, PetscBool *complete)
{
  OperatorsPencil frictionless;
  PetscInt        below_low, below_high;

  PetscFunctionBeginUser;
  if (window->count && s->n) { /* just outside the outermost modes; an eigenvalue that close to the end belongs to them */
    PetscCall(OperatorsGetFrictionless(modes->operators, &frictionless));
    PetscCall(CountBelow(modes, &frictionless, s->omega[0] * (1 - 1e-6), &below_low));
    PetscCall(CountBelow(modes, &frictionless, s->omega[s->n - 1] * (1 + 1e-6), &below_high));
    window->expected = below_high - below_low;
  }
  *complete = s->n == window->expected || (window->count && window->expected >= s->n && s->n == window->count) ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(0);
}

PetscErrorCode WindowDescribe(const Window *window, const Spectrum *s, PetscBool proven, PetscBool left, PetscReal worst, char text[], size_t size)
{
  char frictionless[96] = "";

  PetscFunctionBeginUser;
  if (window->expected >= 0 && !window->count)
    PetscCall(PetscSNPrintf(frictionless, sizeof(frictionless), "; without friction and damping %" PetscInt_FMT " (inertia)", window->expected));
  if (proven)
    PetscCall(PetscSNPrintf(text, size, "none is missing: inertia of K - s M at the ends of the band counts %" PetscInt_FMT, window->expected));
  else if (left)
    PetscCall(PetscSNPrintf(text, size,
                            "none is missing: %" PetscInt_FMT " right and left eigenvalues, from independent starts, agree to %.1e%s", s->n,
                            (double)worst, frictionless));
  else PetscCall(PetscSNPrintf(text, size, "completeness was not checked, since -modes_left is off%s", frictionless));
  PetscFunctionReturn(0);
}
