/*
   Undamped problem K x = kappa M x, kappa = -lambda^2, half the size of the quadratic one: EPS block Krylov-Schur
   with shift-and-invert about a real shift, symmetric (GHEP) or not (GNHEP). A kappa in the complex plane stands for
   lambda = sqrt(-kappa) and -lambda; the one with omega >= 0 is kept, so that a complex pair of kappa gives both
   members of a lock-in pair.

   Krylov-Schur converges eigenvalues in the order of their distance from the shift, so the window is covered when the
   farthest converged one lies outside the circle about the shift through the ends of the window.
*/
#include "modesimpl.h"
#include "solver/blockkrylov.h"
#include <complex.h>

/* Without a target, or with one near zero, the shift lies below zero, where rigid modes may be. Rounding of an eigenvalue there by its inverse,
   1 / (kappa - shift), spoils the others by as much: 1e-8 |K| / |M| below leaves 1e-8 of the largest at worst.
   In a band it lies amid kappa, so that few modes outside are as near as those inside; where the band begins at low
   frequencies, which there lose digits, at a quarter. */
PetscReal UndampedShift(const Window *window)
{
  const PetscReal low = window->low * window->low, high = window->high * window->high;

  if (window->count)
    return window->target > 10 * window->scale ? window->target * window->target : -PetscSqr(10 * window->scale);
  return low + PetscMin(0.5, 0.25 + 1.5 * low / high) * (high - low);
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

/* Puts the converged pairs into a spectrum; reach = distance of the farthest from the shift, infinite when all n are
   there */
static PetscErrorCode UndampedCollect(EPS eps, PetscReal shift, PetscInt n, Spectrum *s)
{
  PetscInt           n_converged;
  EPSConvergedReason reason;
  Vec                xr, xi;
  Mat                K;

  PetscFunctionBeginUser;
  PetscCall(EPSGetConverged(eps, &n_converged));
  PetscCall(EPSGetOperators(eps, &K, NULL));
  PetscCall(MatCreateVecs(K, &xr, &xi));
  PetscCall(SpectrumCreate(n_converged, s));
  for (PetscInt i = 0; i < n_converged; i++) {
    PetscReal    kr, ki;
    PetscComplex lambda;

    PetscCall(EPSGetEigenpair(eps, i, &kr, &ki, xr, xi));
    lambda = csqrt(-CMPLX(kr, ki));
    if (cimag(lambda) < 0) lambda = -lambda;
    if (ki == 0) lambda = kr > 0 ? CMPLX(0, sqrt(kr)) : CMPLX(sqrt(-kr), 0);
    PetscCall(SpectrumAdd(s, creal(lambda), cimag(lambda), xr, ki != 0 ? xi : NULL));
    s->reach = PetscMax(s->reach, cabs(CMPLX(kr - shift, ki)));
  }
  PetscCall(EPSGetConvergedReason(eps, &reason));
  if (n_converged >= n || reason == EPS_DIVERGED_BREAKDOWN)
    s->reach = PETSC_MAX_REAL; /* breakdown: M is singular, no more finite ones */
  PetscCall(VecDestroy(&xr));
  PetscCall(VecDestroy(&xi));
  PetscCall(SpectrumSort(s));
  PetscFunctionReturn(0);
}

PetscErrorCode SolverSeed(BV bv, unsigned long seed)
{
  PetscMPIInt rank;
  PetscRandom random;

  PetscFunctionBeginUser;
  PetscCall(BVGetRandomContext(bv, &random));
  PetscCallMPI(MPI_Comm_rank(PetscObjectComm((PetscObject)bv), &rank));
  PetscCall(PetscRandomSetSeed(random, seed + (unsigned long)rank));
  PetscCall(PetscRandomSeed(random));
  PetscFunctionReturn(0);
}

/* Solver for nev eigenvalues about the shift; the transposed problem starts from another random vector */
static PetscErrorCode UndampedCreateSolver(const PencilMatrices *pencil, ShiftInvert *si, PetscBool transposed,
                                           PetscInt nev, EPS *eps)
{
  BV bv;
  ST st;

  PetscFunctionBeginUser;
  PetscCall(EPSCreate(si->comm, eps));
  PetscCall(EPSSetOperators(*eps, pencil->K, pencil->M));
  PetscCall(EPSSetProblemType(*eps, pencil->symmetric ? EPS_GHEP : EPS_GNHEP));
  PetscCall(EPSSetType(*eps, EPSBLOCKKRYLOVSCHUR));
  PetscCall(EPSSetDimensions(*eps, nev, PETSC_DEFAULT, PETSC_DEFAULT));
  PetscCall(EPSSetTolerances(*eps, 1e-11, 200));
  PetscCall(EPSGetST(*eps, &st));
  PetscCall(ShiftInvertAttach(si, transposed, st));
  PetscCall(EPSSetFromOptions(*eps));
  PetscCall(EPSSetWhichEigenpairs(*eps, EPS_TARGET_MAGNITUDE));
  PetscCall(EPSSetTarget(*eps, si->shift));
  PetscCall(EPSGetBV(*eps, &bv));
  PetscCall(SolverSeed(bv, transposed ? 20051 : 2005));
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

/* M itself where it is known to be symmetric, else its transpose: formed, since products with blocks of vectors need it */
static PetscErrorCode UndampedTranspose(PencilMatrices *problem)
{
  PetscBool known, symmetric;
  Mat       K = problem->K, M = problem->M;

  PetscFunctionBeginUser;
  PetscCall(MatCreateTranspose(K, &problem->K));
  PetscCall(MatIsSymmetricKnown(M, &known, &symmetric));
  if (known && symmetric)
    PetscCall(PetscObjectReference((PetscObject)M));
  else
    PetscCall(MatTranspose(M, MAT_INITIAL_MATRIX, &problem->M));
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
  PetscCall(PetscSNPrintf(text, size, "%s, blocks of %" PetscInt_FMT ", %s", type, block, factors));
  PetscFunctionReturn(0);
}

PetscErrorCode UndampedSolve(Modes modes, const PencilMatrices *pencil, const Window *window, ShiftInvert *si,
                             PetscBool transposed, Spectrum *spectrum)
{
  PencilMatrices problem = *pencil;
  PetscInt       n, nev = window->extra + (window->count           ? window->count + window->count / 2
                                           : window->expected >= 0 ? window->expected
                                                                   : 40);
  PetscBool      covered = PETSC_FALSE;

  PetscFunctionBeginUser;
  PetscCall(MatGetSize(pencil->K, &n, NULL));
  if (transposed) PetscCall(UndampedTranspose(&problem));
  for (int attempt = 0; attempt < 8 && !covered; attempt++, nev += nev / 2) {
    EPS eps;

    nev = PetscMin(nev, n);
    PetscCall(UndampedCreateSolver(&problem, si, transposed, nev, &eps));
    PetscCall(EPSSetStoppingTestFunction(eps, UndampedStop, modes, NULL));
    PetscCall(LimitAttach(modes, nev, si));
    PetscCall(ProgressBegin(&modes->progress, transposed ? "left vectors" : "right vectors", 2 * nev + nev / 4));
    PetscCall(EPSSolve(eps));
    PetscCall(ProgressEnd(&modes->progress));
    PetscCall(UndampedDescribe(eps, si, sizeof(modes->solver), modes->solver));
    PetscCall(UndampedCollect(eps, si->shift, n, spectrum));
    covered =
      spectrum->reach > UndampedRadius(window, si->shift, spectrum) || spectrum->n == n ? PETSC_TRUE : PETSC_FALSE;
    if (!covered) PetscCall(LimitCheck(modes, PETSC_FALSE, spectrum));
    if (!covered && nev < n) PetscCall(SpectrumDestroy(spectrum));
    PetscCall(EPSDestroy(&eps));
    if (nev == n) break;
  }
  if (!covered) PetscCall(WindowComplain(modes, window, "eps"));
  if (transposed) PetscCall(MatDestroy(&problem.K));
  if (transposed) PetscCall(MatDestroy(&problem.M));
  PetscFunctionReturn(0);
}
