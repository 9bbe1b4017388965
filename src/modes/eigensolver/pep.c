/*
   PEP TOAR on the damped problem, with shift-and-invert about a real positive shift; see damped.c.
*/
#include "modes/modesimpl.h"

#define DAMPED_RESTARTS 20 /* of TOAR, before LAPACK is asked where it may be */

/* Puts the converged eigenvalues of the upper half plane into a spectrum; reach = largest distance from the shift */
static PetscErrorCode DampedCollect(PEP pep, PetscReal shift, PetscInt n, Spectrum *s)
{
  PetscInt n_converged;
  Vec      xr, xi;
  Mat      K;

  PetscFunctionBeginUser;
  PetscCall(PEPGetConverged(pep, &n_converged));
  PetscCall(PEPGetOperators(pep, 0, &K));
  PetscCall(MatCreateVecs(K, &xr, &xi));
  PetscCall(SpectrumCreate(n_converged, s));
  for (PetscInt i = 0; i < n_converged; i++) {
    PetscReal kr, ki;

    PetscCall(PEPGetEigenpair(pep, i, &kr, &ki, xr, xi));
    s->reach = PetscMax(s->reach, PetscSqrtReal((kr - shift) * (kr - shift) + ki * ki));
    if (ki >= 0) PetscCall(SpectrumAdd(s, kr, ki, xr, ki != 0 ? xi : NULL));
  }
  if (n_converged >= 2 * n) s->reach = PETSC_MAX_REAL;
  PetscCall(VecDestroy(&xr));
  PetscCall(VecDestroy(&xi));
  PetscCall(SpectrumSort(s));
  PetscFunctionReturn(0);
}

/* Solver for nev eigenvalues about the shift; the transposed problem starts from another random vector */
static PetscErrorCode DampedCreateSolver(Mat problem[3], ShiftInvert *si, PetscBool transposed, int start, PetscInt nev,
                                         PEP *pep)
{
  PetscInt n;
  BV       bv;
  DS       ds;
  ST       st;

  PetscFunctionBeginUser;
  PetscCall(MatGetSize(problem[0], &n, NULL));
  PetscCall(PEPCreate(si->comm, pep));
  PetscCall(PEPSetOperators(*pep, 3, problem));
  PetscCall(PEPSetProblemType(*pep, PEP_GENERAL));
  PetscCall(PEPSetType(*pep, PEPTOAR));
  PetscCall(PEPSetDimensions(*pep, nev, PetscMin(2 * n, nev + PetscMax(3 * nev / 5, 20)), PETSC_DEFAULT));
  PetscCall(PEPSetTolerances(*pep, 1e-11, 200));
  /* lambda = scale * mu with |mu| <= 1 in the window; explicit, since the norms of transposed matrices are not at
     hand */
  PetscCall(PEPSetScale(*pep, PEP_SCALE_SCALAR, 3 * si->shift, NULL, NULL, PETSC_DECIDE, PETSC_DECIDE));
  PetscCall(PEPGetDS(*pep, &ds));
  PetscCall(SolverSynchronize(ds));
  PetscCall(PEPGetST(*pep, &st));
  PetscCall(ShiftInvertAttach(si, transposed, st));
  PetscCall(PEPSetFromOptions(*pep));
  PetscCall(PEPSetWhichEigenpairs(*pep, PEP_TARGET_MAGNITUDE));
  PetscCall(PEPSetTarget(*pep, si->shift));
  PetscCall(PEPGetBV(*pep, &bv));
  PetscCall(SolverSeed(bv, (transposed ? 20051 : 2005) + 1000 * (unsigned long)start));
  PetscFunctionReturn(0);
}

/* SLEPc's own test after every restart, and the limit in time; ctx is the Modes */
static PetscErrorCode DampedStop(PEP pep, PetscInt its, PetscInt max_it, PetscInt n, PetscInt nev,
                                 PEPConvergedReason *reason, void *ctx)
{
  Modes modes = (Modes)ctx;

  PetscFunctionBeginUser;
  PetscCall(PEPStoppingBasic(pep, its, max_it, n, nev, reason, NULL));
  PetscCall(LimitAsk(modes, n, nev));
  if (*reason == PEP_CONVERGED_ITERATING && modes->over) *reason = PEP_DIVERGED_ITS;
  PetscFunctionReturn(0);
}

/* Solves; failed = LAPACK could not reorder the Schur form (xTREXC: eigenvalues too close to swap), which depends on
   the start vector and happens where the Krylov space is the whole space */
static PetscErrorCode DampedRunSolver(Modes modes, PEP pep, PetscBool *failed)
{
  PetscErrorCode error;

  PetscFunctionBeginUser;
  PetscCall(PetscPushErrorHandler(PetscReturnErrorHandler, NULL));
  error = PEPSolve(pep);
  PetscCall(PetscPopErrorHandler());
  *failed = error == PETSC_ERR_LIB ? PETSC_TRUE : PETSC_FALSE;
  if (*failed) PetscCall(PetscFPTrapPop());                /* the one that SLEPc left behind */
  if (error && !*failed) PetscCall(LimitCheckLeft(modes)); /* its message was not kept */
  if (!*failed) PetscCall(error);
  PetscFunctionReturn(0);
}

PetscErrorCode DampedSolvePep(Modes modes, const PencilMatrices *pencil, const Window *window, ShiftInvert *si,
                              PetscBool transposed, Spectrum *spectrum)
{
  Mat       problem[3] = {pencil->K, pencil->C, pencil->M};
  PetscInt  n, nev;
  PetscBool covered = PETSC_FALSE, failed = PETSC_FALSE, dense = PETSC_FALSE, next;

  PetscFunctionBeginUser;
  PetscCall(MatGetSize(pencil->K, &n, NULL));
  nev = DampedFirst(window);
  for (int i = 0; i < 3 && transposed; i++) PetscCall(MatCreateTranspose(problem[i], &problem[i]));
  for (int attempt = 0; attempt < 8 && !covered; attempt++, nev += failed ? 0 : nev / 2) {
    PEP pep;

    nev = PetscMin(nev, 2 * n);
    if (attempt) PetscCall(DampedIsDense(modes, pencil->K, nev, attempt, &dense));
    if (dense) break;
    PetscCall(DampedCreateSolver(problem, si, transposed, attempt, nev, &pep));
    PetscCall(DampedIsDense(modes, pencil->K, nev, 1, &next));
    if (next) PetscCall(PEPSetTolerances(pep, PETSC_DEFAULT, DAMPED_RESTARTS));
    PetscCall(PEPSetStoppingTestFunction(pep, DampedStop, modes, NULL));
    PetscCall(LimitAttach(modes, nev / 2, si)); /* conjugates are one mode */
    PetscCall(ProgressBegin(&modes->progress, transposed ? "left vectors" : "right vectors", 2 * nev + nev / 4));
    PetscCall(DampedRunSolver(modes, pep, &failed));
    PetscCall(ProgressEnd(&modes->progress));
    if (failed) {
      PetscCall(PEPDestroy(&pep));
      continue;
    }
    PetscCall(DampedCollect(pep, si->shift, n, spectrum));
    covered = spectrum->reach > DampedRadius(window, si->shift, spectrum) ? PETSC_TRUE : PETSC_FALSE;
    if (!covered) PetscCall(LimitCheck(modes, PETSC_TRUE, spectrum));
    if (!covered && nev < 2 * n) PetscCall(SpectrumDestroy(spectrum));
    PetscCall(PEPDestroy(&pep));
    if (nev == 2 * n) break;
  }
  if (!covered && !dense) PetscCall(WindowComplain(modes, window, "pep"));
  if (dense) PetscCall(DampedSolveDense(modes, pencil, window, si->shift, transposed, spectrum));
  for (int i = 0; i < 3 && transposed; i++) PetscCall(MatDestroy(&problem[i]));
  PetscFunctionReturn(0);
}
