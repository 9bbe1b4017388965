/*
   Damping so strong beyond the basis that no real factor makes it weak, as stiffness damping b K of one part with b
   omega > 1 is: its modes are overdamped, or nearly so, and gather at -1 / b in thousands. The window is then solved in
   parts, each with factors of Q at i omega_k in the middle of it (about.c). Each begins from the undamped vectors of
   the whole window and from random ones, with a few steps of the same factors: what these vectors do not bring into the
   part is not there, as in every Krylov method. All eigenvalues of the dense problem that are in the part have to
   settle.

   What is damped by more than MODES_DAMPED_MOST of critical damping is not sought: with symmetric K, C, M the
   overdamped modes of b K are real, -1 / b or less, and friction leaves them near that.
*/
#include "basis/complexshift.h"
#include "projection.h"
#include "solver/block/orthonormal.h"

#define STRONG_EACH   24   /* modes without damping in a part of a band, about */
#define STRONG_MOST   16   /* parts */
#define STRONG_STRIP  1e-3 /* by so much two parts overlap, relative */
#define STRONG_SAME   1e-6 /* relative distance of eigenvalues that are one */
#define STRONG_TRIALS 3

/* Into how many parts a window goes; of undamped modes in a band n are there */
static PetscInt StrongParts(const Window *window, PetscInt n)
{
  if (window->count) return 1;
  return PetscMax(1, PetscMin(STRONG_MOST, (n + STRONG_EACH / 2) / STRONG_EACH));
}

/* Part k of n of a band; the nearest to a target are one part */
static Window StrongPart(const Window *window, PetscInt n, PetscInt k)
{
  Window part = *window;

  if (k) part.low = ShiftsSeam(window, n, k) * (1 - STRONG_STRIP), part.edge[0] = part.low;
  if (k + 1 < n) part.high = ShiftsSeam(window, n, k + 1) * (1 + STRONG_STRIP), part.edge[1] = part.high;
  return part;
}

/* Whether each of the eigenvalues is one of those that have settled */
static PetscBool StrongAreThose(const ProjectionModes *all, const ProjectionModes *found, PetscReal zero)
{
  for (PetscInt i = 0; i < all->n; i++) {
    PetscReal nearest = INFINITY;

    for (PetscInt j = 0; j < found->n; j++) nearest = PetscMin(nearest, cabs(all->lambda[i] - found->lambda[j]));
    if (nearest > STRONG_SAME * cabs(all->lambda[i]) && cabs(all->lambda[i]) > zero) return PETSC_FALSE;
  }
  return all->n == found->n ? PETSC_TRUE : PETSC_FALSE;
}

/* The modes of a part, settled; and as many as LAPACK finds in it at the end */
static PetscErrorCode StrongSolve(Projection *p, ProjectionModes *found, PetscBool *settled)
{
  PetscBool whole = PETSC_FALSE;

  PetscFunctionBeginUser;
  *settled = PETSC_TRUE;
  for (int trial = 0; trial < STRONG_TRIALS && *settled && !whole; trial++) {
    ProjectionModes all;

    if (trial) PetscCall(ProjectionModesDestroy(found));
    PetscCall(ProjectionIterate(p, found, settled));
    if (!*settled) break;
    PetscCall(ProjectionEigen(p, &all));
    whole = StrongAreThose(&all, found, p->window->known.scale);
    PetscCall(ProjectionModesDestroy(&all));
  }
  if (!whole) *settled = PETSC_FALSE;
  PetscFunctionReturn(0);
}

PetscErrorCode ProjectionSolveStrong(Projection *p, PetscInt n_undamped, Window *window, const char **why)
{
  Modes          modes    = p->modes;
  const PetscInt n        = StrongParts(window, n_undamped);
  Spectrum       found[2] = {{0}, {0}};
  PetscInt       n_modal;
  ComplexShift   about;

  PetscFunctionBeginUser;
  PetscCall(ProjectionFindNull(p));                        /* while its factors are there */
  if (!modes->keep) PetscCall(ShiftInvertDestroy(&p->si)); /* its shift stays */
  n_modal = p->space.n;
  PetscCall(ComplexShiftCreate(p->pencil, &modes->progress, &about));
  p->about = &about;
  p->alpha = p->beta = 0;
  for (PetscInt k = 0; k < n && !*why; k++) {
    Window          part = StrongPart(window, n, k);
    ProjectionModes in_part;
    PetscBool       settled;

    p->window = &part;
    p->finer  = 1;
    PetscCall(SubspaceTruncate(&p->space, n_modal));
    PetscCall(ComplexShiftMove(&about, window->count ? window->target : 0.5 * (part.low + part.high)));
    PetscCall(ProjectionSearchAbout(p, CMPLX(0, PetscMax(part.high, part.target)), 1913 + (unsigned long)k));
    PetscCall(StrongSolve(p, &in_part, &settled));
    PetscCall(LimitAsk(modes, found[0].n, n_undamped));
    PetscCall(LimitCheck(modes, PETSC_TRUE, &found[0]));
    if (!settled) *why = "corrections about complex shifts do not settle";
    if (settled) PetscCall(ProjectionPut(p, &in_part));
    if (settled) PetscCall(ShiftsAppend(modes, k ? ShiftsSeam(window, n, k) : 0, &found[0], &found[1]));
    window->route.n_basis = PetscMax(window->route.n_basis, in_part.size);
    PetscCall(ProjectionModesDestroy(&in_part));
  }
  modes->right          = found[0];
  modes->left_spectrum  = found[1];
  window->route.n_about = n;
  p->window             = window;
  p->about              = NULL;
  PetscCall(ComplexShiftDestroy(&about));
  PetscFunctionReturn(0);
}
