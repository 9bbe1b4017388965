/*
   The eigenvalues of one window with one factorisation: right vectors, again where the shift is too near to one of
   them, left vectors, and again with more of them where some are missing.
*/
#include "modesimpl.h"

/* distance of an eigenvalue from the shift, beside the farthest: below it the shift is moved */
#define MODES_NEAR          1e-9
#define MODES_NEAR_SINGULAR 1e-5 /* the same where infinite eigenvalues are to be told from finite ones */

/* Right or left spectrum by the solver that fits the pencil */
static PetscErrorCode SpectrumSolve(Modes modes, const PencilMatrices *pencil, const Window *window, ShiftInvert *si,
                                    PetscBool transposed, Spectrum *spectrum)
{
  PetscFunctionBeginUser;
  if (pencil->C)
    PetscCall(DampedSolve(modes, pencil, window, si, transposed, spectrum));
  else
    PetscCall(UndampedSolve(modes, pencil, window, si, transposed, spectrum));
  PetscFunctionReturn(0);
}

/* Left vectors of a symmetric pencil are the right ones */
static PetscErrorCode SpectrumCopy(const Spectrum *from, Spectrum *to)
{
  PetscFunctionBeginUser;
  PetscCall(SpectrumCreate(from->n, to));
  for (PetscInt i = 0; i < from->n; i++)
    PetscCall(SpectrumAdd(to, from->sigma[i], from->omega[i], from->xr[i], from->xi[i]));
  PetscFunctionReturn(0);
}

/* Whether an eigenvalue kappa = -lambda^2 is so near to the shift that rounding of its inverse spoils the others */
static PetscBool ShiftSpoils(const Window *window, const Spectrum *s, PetscReal shift)
{
  PetscReal nearest  = PETSC_MAX_REAL,
            farthest = window->known.singular && !window->count ? UndampedRadius(window, shift, s) : 0;

  for (PetscInt i = 0; i < s->n; i++) {
    const PetscReal distance = SpectrumDistance(s, i, shift);

    nearest  = PetscMin(nearest, distance);
    farthest = PetscMax(farthest, distance);
  }
  return nearest < (window->known.singular && !window->count ? MODES_NEAR_SINGULAR : MODES_NEAR) * farthest
           ? PETSC_TRUE
           : PETSC_FALSE;
}

PetscErrorCode ModesSolveRight(Modes modes, const PencilMatrices *pencil, const Window *window, ShiftInvert *si)
{
  PetscFunctionBeginUser;
  PetscCall(SpectrumSolve(modes, pencil, window, si, PETSC_FALSE, &modes->right));
  for (int attempt = 1; attempt < 4 && !pencil->C && ShiftSpoils(window, &modes->right, si->shift); attempt++) {
    const PetscReal shift = si->shift * (1 + 1e-3 * attempt);

    PetscCall(SpectrumDestroy(&modes->right));
    PetscCall(ShiftInvertMove(pencil, shift, si));
    PetscCall(SpectrumSolve(modes, pencil, window, si, PETSC_FALSE, &modes->right));
  }
  PetscFunctionReturn(0);
}

/* A second attempt asks for more eigenvalues */
PetscErrorCode ModesSolveWindow(Modes modes, const PencilMatrices *pencil, Window *window, ShiftInvert *si)
{
  const PetscBool proven   = pencil->symmetric && !pencil->C ? PETSC_TRUE : PETSC_FALSE;
  PetscBool       complete = PETSC_TRUE;

  PetscFunctionBeginUser;
  window->route.proven = proven;
  for (int attempt = 0; attempt < 3; attempt++) {
    PetscCall(ModesSolveRight(modes, pencil, window, si));
    if (pencil->C) PetscCall(WindowCountRigid(modes, window, &modes->right));
    PetscCall(WindowSelect(window, &modes->right));
    if (proven) {
      PetscCall(WindowProve(modes, window, &modes->right, &complete));
      if (complete && modes->left) PetscCall(SpectrumCopy(&modes->right, &modes->left_spectrum));
    } else if (modes->left) {
      PetscCall(SpectrumSolve(modes, pencil, window, si, PETSC_TRUE, &modes->left_spectrum));
      PetscCall(LeftMatch(modes, window, &window->route.worst, &complete));
    }
    if (!pencil->C && window->known.finite >= 0 && WindowLacks(window, &modes->right)) complete = PETSC_FALSE;
    if (complete && !proven && !pencil->C && CopiesDoubtful(modes, window, &modes->right)) complete = PETSC_FALSE;
    if (complete) break;
    CopiesMakeRoom(modes, window, &modes->right);
    window->extra += 10 + modes->right.n / 2;
    PetscCall(SpectrumDestroy(&modes->right));
    PetscCall(SpectrumDestroy(&modes->left_spectrum));
  }
  PetscCheck(complete, modes->comm, PETSC_ERR_NOT_CONVERGED,
             "modes are missing after three attempts (%s); %s -modes_band or tighten -eps_tol",
             proven ? "inertia count" : "left and right differ", window->count ? "give" : "narrow");
  PetscFunctionReturn(0);
}

PetscErrorCode ModesFactor(Modes modes, const PencilMatrices *pencil, PetscReal shift, ReleaseKind release,
                           ShiftInvert *si)
{
  PetscFunctionBeginUser;
  *si            = modes->counter;
  si->release    = release;
  si->owner      = modes->pencil;
  modes->counter = (ShiftInvert){.progress = &modes->progress};
  PetscCall(ShiftInvertMove(pencil, shift, si));
  PetscFunctionReturn(0);
}
