/*
   Undamped problem K x = kappa M x, kappa = -lambda^2, half the size of the quadratic one: EPS block Krylov-Schur
   with shift-and-invert about a real shift, symmetric (GHEP) or not (GNHEP). A kappa in the complex plane stands for
   lambda = sqrt(-kappa) and -lambda; the one with omega >= 0 is kept, so that a complex pair of kappa gives both
   members of a lock-in pair.

   Krylov-Schur converges eigenvalues in the order of their distance from the shift, so the window is covered when the
   farthest converged one lies outside the circle about the shift through the ends of the window.
*/
#include "modes/modesimpl.h"
#include "solver/block/krylov.h"
#include <complex.h>

/* Eigenvalues so many times as far from the shift as the nearest are infinite where unknowns are without mass: rounding
   makes them of the root of machine epsilon, with multipliers, whose infinite eigenvalues are defective */
#define UNDAMPED_INFINITE 1e6
/* the same up to which vectors keep half their digits, of which rounding takes the square */
#define UNDAMPED_CLEAN 1e4
#define UNDAMPED_AWAY  100 /* farther below zero, times, where what is asked for is not nearer than that */

/* Where unknowns are without mass: takes out what rounding made of infinite eigenvalues */
static PetscErrorCode UndampedDropInfinite(const Window *window, PetscReal shift, Spectrum *s)
{
  PetscReal nearest = PETSC_MAX_REAL;

  PetscFunctionBeginUser;
  if (!window->known.singular) PetscFunctionReturn(0);
  for (PetscInt i = 0; i < s->n; i++) nearest = PetscMin(nearest, SpectrumDistance(s, i, shift));
  for (PetscInt i = s->n; i-- > 0;)
    if (SpectrumDistance(s, i, shift) > UNDAMPED_INFINITE * nearest ||
        hypot(s->sigma[i], s->omega[i]) > window->known.most)
      PetscCall(SpectrumRemove(s, i));
  PetscFunctionReturn(0);
}

/* Puts the converged pairs into a spectrum; reach = distance of the farthest from the shift, infinite when all n are
   there; covered = nothing is missing in the radius */
static PetscErrorCode UndampedCollect(EPS eps, PetscReal shift, PetscInt n, const Window *window, Spectrum *s,
                                      PetscBool *covered)
{
  PetscInt           n_converged;
  EPSConvergedReason reason;

  PetscFunctionBeginUser;
  PetscCall(EPSGetConverged(eps, &n_converged));
  PetscCall(SpectrumCreate(n_converged, s));
  for (PetscInt i = 0; i < n_converged; i++) {
    PetscReal    kr, ki;
    PetscComplex lambda;
    Vec          xr, xi;

    PetscCall(EPSGetEigenvalue(eps, i, &kr, &ki));
    PetscCall(BlockKrylovTakeVector(eps, i, window->guard, &xr, &xi));
    lambda = csqrt(-CMPLX(kr, ki));
    if (cimag(lambda) < 0) lambda = -lambda;
    if (ki == 0) lambda = kr > 0 ? CMPLX(0, sqrt(kr)) : CMPLX(sqrt(-kr), 0);
    PetscCall(SpectrumTake(s, creal(lambda), cimag(lambda), xr, xi));
    s->reach = PetscMax(s->reach, cabs(CMPLX(kr - shift, ki)));
  }
  PetscCall(EPSGetConvergedReason(eps, &reason));
  if (n_converged >= n || reason == EPS_DIVERGED_BREAKDOWN)
    s->reach = PETSC_MAX_REAL; /* breakdown: M is singular, no more finite ones */
  PetscCall(BlockKrylovReached(eps, covered));
  if (s->reach > UndampedRadius(window, shift, s) || s->reach == PETSC_MAX_REAL) *covered = PETSC_TRUE;
  PetscCall(UndampedDropInfinite(window, shift, s));
  PetscCall(SpectrumSort(s));
  PetscFunctionReturn(0);
}

/* SLEPc's own test after every restart, and the limit in time; ctx is the Modes */
static PetscErrorCode UndampedStop(EPS eps, PetscInt its, PetscInt max_it, PetscInt n, PetscInt nev,
                                   EPSConvergedReason *reason, void *ctx)
{
  Modes modes = (Modes)ctx;

  PetscFunctionBeginUser;
  PetscCall(EPSStoppingBasic(eps, its, max_it, n, nev, reason, NULL));
  PetscCall(LimitAsk(modes, n, nev));
  if (*reason == EPS_CONVERGED_ITERATING && modes->over) *reason = EPS_DIVERGED_ITS;
  PetscFunctionReturn(0);
}

/* K' and M itself where it is known to be symmetric, else its transpose: formed, since products with blocks of vectors
   need it */
static PetscErrorCode UndampedTranspose(const PencilMatrices *pencil, Mat problem[2])
{
  PetscBool known, symmetric;

  PetscFunctionBeginUser;
  PetscCall(MatCreateTranspose(pencil->K, &problem[0]));
  PetscCall(MatIsSymmetricKnown(pencil->M, &known, &symmetric));
  problem[1] = pencil->M;
  if (known && symmetric)
    PetscCall(PetscObjectReference((PetscObject)pencil->M));
  else
    PetscCall(MatTranspose(pencil->M, MAT_INITIAL_MATRIX, &problem[1]));
  PetscFunctionReturn(0);
}

/* What an eigensolver is made for */
typedef struct {
  Modes                 modes;
  const PencilMatrices *pencil;
  const Window         *window;
  ShiftInvert          *si;
} Undamped;

/* Matrices of the problem, or of the transposed one */
static PetscErrorCode UndampedSetOperators(const Undamped *u, PetscBool transposed, EPS eps)
{
  Mat problem[2];

  PetscFunctionBeginUser;
  if (!transposed) {
    PetscCall(EPSSetOperators(eps, u->pencil->K, u->pencil->M));
    PetscFunctionReturn(0);
  }
  PetscCall(UndampedTranspose(u->pencil, problem));
  PetscCall(EPSSetOperators(eps, problem[0], problem[1]));
  for (int i = 0; i < 2; i++) PetscCall(MatDestroy(&problem[i]));
  PetscFunctionReturn(0);
}

/* Solver for nev eigenvalues about the shift; the transposed problem starts from another random vector */
static PetscErrorCode UndampedCreateSolver(const Undamped *u, PetscBool transposed, PetscInt nev, EPS *eps)
{
  const Window *window = u->window;
  BV            bv;
  DS            ds;
  ST            st;

  PetscFunctionBeginUser;
  PetscCall(EPSCreate(u->si->comm, eps));
  PetscCall(UndampedSetOperators(u, transposed, *eps));
  PetscCall(EPSSetProblemType(*eps, u->pencil->symmetric ? EPS_GHEP : EPS_GNHEP));
  PetscCall(EPSSetType(*eps, EPSBLOCKKRYLOVSCHUR));
  PetscCall(EPSSetDimensions(*eps, nev, PETSC_DEFAULT, PETSC_DEFAULT));
  PetscCall(EPSSetTolerances(*eps, 1e-11, 200));
  PetscCall(EPSGetDS(*eps, &ds));
  PetscCall(SolverSynchronize(ds)); /* of other types by -eps_type too */
  PetscCall(EPSGetST(*eps, &st));
  PetscCall(ShiftInvertAttach(u->si, transposed, st));
  PetscCall(BlockKrylovSetLeast(*eps, u->modes->block[0]));
  PetscCall(EPSSetFromOptions(*eps));
  PetscCall(EPSSetWhichEigenpairs(*eps, EPS_TARGET_MAGNITUDE));
  PetscCall(EPSSetTarget(*eps, u->si->shift));
  PetscCall(EPSGetBV(*eps, &bv));
  PetscCall(SolverSeed(bv, transposed ? 20051 : 2005));
  PetscCall(EPSSetStoppingTestFunction(*eps, UndampedStop, u->modes, NULL));
  if (!window->count && !window->guard)
    PetscCall(BlockKrylovSetReach(*eps, UndampedRadius(window, u->si->shift, NULL)));
  PetscFunctionReturn(0);
}

/* With LDL' and an update one call solves for right and left blocks: the solver of the left problem goes along, from
   its own start, and is kept */
static PetscErrorCode UndampedPair(const Undamped *u, PetscInt nev, EPS right, PetscBool *paired)
{
  Modes modes = u->modes;

  PetscFunctionBeginUser;
  *paired = PETSC_FALSE;
  PetscCall(EPSDestroy(&modes->left_solver));
  if (!modes->left || !u->si->update) PetscFunctionReturn(0);
  PetscCall(UndampedCreateSolver(u, PETSC_TRUE, nev, &modes->left_solver));
  PetscCall(BlockKrylovSetOther(right, modes->left_solver, ShiftInvertApplyBoth, u->si, paired));
  if (!*paired) PetscCall(EPSDestroy(&modes->left_solver));
  PetscFunctionReturn(0);
}

/* The solver of an attempt: the one that has gone along with the right problem, or a new one */
static PetscErrorCode UndampedGetSolver(const Undamped *u, PetscBool transposed, PetscInt nev, EPS *eps)
{
  Modes       modes  = u->modes;
  PetscBool   paired = PETSC_FALSE;
  const char *what   = transposed ? "left vectors" : "right vectors";

  PetscFunctionBeginUser;
  if (transposed && modes->left_solver) {
    *eps               = modes->left_solver;
    modes->left_solver = NULL;
  } else {
    PetscCall(UndampedCreateSolver(u, transposed, nev, eps));
    if (!transposed) PetscCall(UndampedPair(u, nev, *eps, &paired));
  }
  PetscCall(LimitAttach(modes, nev, u->si));
  PetscCall(
    ProgressBegin(&modes->progress, paired ? "right and left vectors" : what, (paired ? 2 : 1) * (2 * nev + nev / 4)));
  PetscFunctionReturn(0);
}

/* The solver and what it solves with, in words */
static PetscErrorCode UndampedDescribe(EPS eps, const ShiftInvert *si, size_t size, char text[])
{
  const char *const factors = si->update ? "LDL' and an update for friction" : si->even ? "LDL'" : "LU";
  EPSType           type;
  PetscInt          block;

  PetscFunctionBeginUser;
  PetscCall(EPSGetType(eps, &type));
  PetscCall(BlockKrylovGetBlock(eps, &block));
  PetscCall(PetscSNPrintf(text, size, "%s, blocks of %" PetscInt_FMT ", %s%s%s", type, block, factors,
                          si->why ? ": " : "", si->why ? si->why : ""));
  PetscFunctionReturn(0);
}

/* The eigenvalues about the shift of the factors */
static PetscErrorCode UndampedSolveAbout(Modes modes, const PencilMatrices *pencil, const Window *window,
                                         ShiftInvert *si, PetscBool transposed, Spectrum *spectrum)
{
  const Undamped u = {modes, pencil, window, si};
  PetscInt       n, nev = window->extra + (window->count                 ? window->count + window->count / 2
                                           : window->known.expected >= 0 ? window->known.expected
                                                                         : 40);
  PetscBool      covered = PETSC_FALSE;

  PetscFunctionBeginUser;
  PetscCall(MatGetSize(pencil->K, &n, NULL));
  for (int attempt = 0; attempt < 8 && !covered; attempt++, nev += nev / 2) {
    EPS eps;

    nev = PetscMin(nev, n);
    PetscCall(UndampedGetSolver(&u, transposed, nev, &eps));
    PetscCall(EPSSolve(eps));
    PetscCall(ProgressEnd(&modes->progress));
    PetscCall(UndampedDescribe(eps, si, sizeof(modes->solver), modes->solver));
    PetscCall(BlockKrylovGetBlock(eps, &modes->block[1]));
    PetscCall(SavedByFactors(modes, si));
    PetscCall(UndampedCollect(eps, si->shift, n, window, spectrum, &covered));
    if (!covered) PetscCall(LimitCheck(modes, PETSC_FALSE, spectrum));
    if (!covered && nev < n) PetscCall(SpectrumDestroy(spectrum));
    PetscCall(EPSDestroy(&eps));
    if (nev == n) break;
  }
  if (!covered) PetscCall(WindowComplain(modes, window, "eps"));
  PetscFunctionReturn(0);
}

/* Whether an eigenvalue that was asked for is missing, or so far beside the nearest that its vector may be spoiled */
static PetscBool UndampedLacks(const Window *window, PetscReal shift, const Spectrum *s)
{
  PetscReal nearest = PETSC_MAX_REAL, farthest = 0, reach;

  if (!window->known.singular || !window->count) return PETSC_FALSE;
  if (WindowLacks(window, s)) return PETSC_TRUE;
  reach = WindowNearest(window, s);
  for (PetscInt i = 0; i < s->n; i++) {
    const PetscReal distance = SpectrumDistance(s, i, shift);

    nearest = PetscMin(nearest, distance);
    if (hypot(s->omega[i] - window->target, s->sigma[i]) <= reach) farthest = PetscMax(farthest, distance);
  }
  return farthest > UNDAMPED_CLEAN * nearest ? PETSC_TRUE : PETSC_FALSE;
}

/* With unknowns without mass and an eigenvalue next to the shift, as a rigid mode is, others that were asked for may be
   as far as infinite ones seem to be: a shift farther below zero has all finite ones nearer */
PetscErrorCode UndampedSolve(Modes modes, const PencilMatrices *pencil, const Window *window, ShiftInvert *si,
                             PetscBool transposed, Spectrum *spectrum)
{
  const PetscReal least = PetscSqr(10 * window->known.scale);
  const PetscReal most  = PetscMax(1e8 * PetscSqr(window->known.scale), UNDAMPED_AWAY * PetscSqr(window->target));

  PetscFunctionBeginUser;
  PetscCall(UndampedSolveAbout(modes, pencil, window, si, transposed, spectrum));
  while (UndampedLacks(window, si->shift, spectrum)) {
    const PetscReal away = UNDAMPED_AWAY * PetscMax(PetscAbsReal(si->shift), least);

    if (away > most * (1 + PETSC_SQRT_MACHINE_EPSILON)) break;
    PetscCall(SpectrumDestroy(spectrum));
    PetscCall(ShiftInvertMove(pencil, -away, si));
    PetscCall(UndampedSolveAbout(modes, pencil, window, si, transposed, spectrum));
  }
  PetscFunctionReturn(0);
}
