/*
   One factorisation for everything: a KSP with the user's -st_ksp_*, -st_pc_*, -st_mat_mumps_* options, which SLEPc's
   spectral transformations of the right and of the transposed problem both call. MUMPS is the default: LDL' for a
   symmetric pencil, LU else. On one rank the LU gets METIS's order of the node graph; against PORD, the best of
   MUMPS' own, it is a tie on the default rig (23.9 M entries and 11.2 Gflop against 23.6 M and 10.9) and 6 % less
   fill and 16 % fewer operations at 94,491 unknowns (82.6 M and 57.5 against 87.8 M and 68.6; scripts/bench/modes
   --part orderings). AMD, AMF and QAMD give 13 to 35 % more fill. PETSc hands no order to MUMPS' LDL' nor on several
   ranks, where PORD stays.
*/
#include "shiftinvert.h"
#include "base/events.h"
#include <petscksp.h>

/* K - s M, or K + s C + s^2 M with damping */
static PetscErrorCode ShiftInvertMatrix(const PencilMatrices *pencil, PetscReal shift, Mat *A)
{
  PetscFunctionBeginUser;
  PetscCall(MatDuplicate(pencil->K, MAT_COPY_VALUES, A));
  if (pencil->C) {
    PetscCall(MatAXPY(*A, shift, pencil->C, DIFFERENT_NONZERO_PATTERN));
    PetscCall(MatAXPY(*A, shift * shift, pencil->M, DIFFERENT_NONZERO_PATTERN));
  } else {
    PetscCall(MatAXPY(*A, -shift, pencil->M, DIFFERENT_NONZERO_PATTERN));
  }
  PetscCall(MatSetOption(*A, MAT_SYMMETRIC, pencil->symmetric));
  PetscFunctionReturn(0);
}

/* Raises the error for a failed factorisation; a singular matrix sets *singular instead */
static PetscErrorCode ShiftInvertCheck(MPI_Comm comm, PC pc, PetscBool *singular)
{
  PCFailedReason reason;
  MatSolverType  type;
  PetscBool      is_mumps = PETSC_FALSE;
  PetscInt       info = 0, extra = 0;
  Mat            F;

  PetscFunctionBeginUser;
  *singular = PETSC_FALSE;
  PetscCall(PCGetFailedReason(pc, &reason));
  PetscCall(PCFactorGetMatSolverType(pc, &type));
  if (type) PetscCall(PetscStrcmp(type, MATSOLVERMUMPS, &is_mumps));
  if (is_mumps) {
    PetscCall(PCFactorGetMatrix(pc, &F));
    PetscCall(MatMumpsGetInfog(F, 1, &info));
    PetscCall(MatMumpsGetInfog(F, 2, &extra));
  }
  /* not PETSC_ERR_MEM, for which the message would be another */
  PetscCheck(info != -8 && info != -9 && info != -14 && info != -15 && info != -17 && info != -20, comm,
             PETSC_ERR_NOT_CONVERGED,
             "MUMPS' workspace is too small (INFOG(1) = %" PetscInt_FMT ", INFOG(2) = %" PetscInt_FMT
             "): raise -st_mat_mumps_icntl_14 (percent of extra workspace) or -st_mat_mumps_icntl_23 (MB per rank)",
             info, extra);
  PetscCheck(info != -13 && info != -7 && info != -19 && info != -5, comm, PETSC_ERR_NOT_CONVERGED,
             "MUMPS ran out of memory (INFOG(1) = %" PetscInt_FMT ", INFOG(2) = %" PetscInt_FMT
             "): raise -st_mat_mumps_icntl_23 (MB per rank) if it limits, use more ranks or a coarser mesh",
             info, extra);
  if (info == -10 || info == -6 || reason == PC_FACTOR_NUMERIC_ZEROPIVOT || reason == PC_FACTOR_STRUCT_ZEROPIVOT)
    *singular = PETSC_TRUE;
  PetscCheck(*singular || !reason, comm, PETSC_ERR_NOT_CONVERGED,
             "factorisation failed (MUMPS INFOG(1) = %" PetscInt_FMT ")", info);
  PetscFunctionReturn(0);
}

/* Solver with MUMPS as default */
static PetscErrorCode ShiftInvertCreateSolver(MPI_Comm comm, Mat A, PetscBool symmetric, PetscBool want_inertia,
                                              KSP *ksp)
{
  PC  pc;
  Mat F;

  PetscFunctionBeginUser;
  PetscCall(KSPCreate(comm, ksp));
  PetscCall(KSPSetOptionsPrefix(*ksp, "st_"));
  PetscCall(KSPSetOperators(*ksp, A, A));
  PetscCall(KSPSetType(*ksp, KSPPREONLY));
  PetscCall(KSPGetPC(*ksp, &pc));
  PetscCall(PCSetType(pc, symmetric ? PCCHOLESKY : PCLU));
  PetscCall(PCFactorSetMatSolverType(pc, MATSOLVERMUMPS));
  PetscCall(KSPSetFromOptions(*ksp));
  if (want_inertia) {
    PetscCall(PCFactorSetUpMatSolverType(pc));
    PetscCall(PCFactorGetMatrix(pc, &F));
    PetscCall(MatMumpsSetIcntl(F, 13, 1)); /* MUMPS counts negative pivots of the root only without ScaLAPACK */
    PetscCall(MatMumpsSetIcntl(F, 24, 1)); /* null pivots are counted, INFOG(28), instead of an error */
  }
  PetscFunctionReturn(0);
}

/* Raises the error for what no shift makes regular */
static PetscErrorCode ShiftInvertRegular(MPI_Comm comm, int regular, PetscReal shift)
{
  PetscFunctionBeginUser;
  PetscCheck(
    regular, comm, PETSC_ERR_MAT_LU_ZRPVT,
    "the problem is singular at every shift near %.6g: a part without mass or an unknown without stiffness and mass",
    (double)shift);
  PetscFunctionReturn(0);
}

PetscErrorCode ShiftInvertCreate(const PencilMatrices *pencil, PetscReal shift, PetscBool want_inertia,
                                 Progress *progress, ShiftInvert *si)
{
  PetscBool singular = PETSC_TRUE;
  Mat       A;
  PC        pc;

  PetscFunctionBeginUser;
  PetscCall(EventBegin(EVENT_FACTOR));
  si->progress = progress;
  si->after    = NULL;
  si->shift    = shift;
  PetscCall(PetscObjectGetComm((PetscObject)pencil->K, &si->comm));
  for (int attempt = 0; attempt < 4 && singular; attempt++, si->shift *= singular ? 1 + 1e-4 * attempt : 1) {
    PetscCall(ShiftInvertMatrix(pencil, si->shift, &A));
    PetscCall(
      ShiftInvertCreateSolver(si->comm, A, pencil->symmetric && !(pencil->C && !want_inertia), want_inertia, &si->ksp));
    PetscCall(ShiftInvertAnalyse(si, A));
    PetscCall(KSPSetUp(si->ksp));
    PetscCall(KSPGetPC(si->ksp, &pc));
    PetscCall(ShiftInvertCheck(si->comm, pc, &singular));
    if (!singular) PetscCall(MatNorm(A, NORM_FROBENIUS, &si->size));
    PetscCall(MatDestroy(&A));
    if (singular) PetscCall(KSPDestroy(&si->ksp));
  }
  PetscCall(ShiftInvertRegular(si->comm, !singular, shift));
  PetscCall(EventEnd(EVENT_FACTOR));
  PetscFunctionReturn(0);
}

PetscErrorCode ShiftInvertSolve(const ShiftInvert *si, PetscBool transposed, Vec b, Vec x)
{
  KSPConvergedReason reason;

  PetscFunctionBeginUser;
  PetscCall(transposed ? KSPSolveTranspose(si->ksp, b, x) : KSPSolve(si->ksp, b, x));
  PetscCall(KSPGetConvergedReason(si->ksp, &reason));
  PetscCheck(reason >= 0, si->comm, PETSC_ERR_NOT_CONVERGED,
             "the linear solver failed (%s): see -st_ksp_type, -st_ksp_rtol and -st_ksp_max_it, or leave them out",
             KSPConvergedReasons[reason]);
  PetscFunctionReturn(0);
}

/* y = A^-1 x or A^-T x, a step of the eigensolver */
static PetscErrorCode ShiftInvertRun(PC pc, PetscBool transposed, Vec x, Vec y)
{
  ShiftInvert *si;

  PetscFunctionBeginUser;
  PetscCall(PCShellGetContext(pc, &si));
  PetscCall(EventBegin(EVENT_SOLVE));
  PetscCall(ShiftInvertSolve(si, transposed, x, y));
  PetscCall(EventEnd(EVENT_SOLVE));
  PetscCall(ProgressStep(si->progress));
  if (si->after) PetscCall((*si->after)(si->after_ctx));
  PetscFunctionReturn(0);
}

static PetscErrorCode ShiftInvertApply(PC pc, Vec x, Vec y)
{
  return ShiftInvertRun(pc, PETSC_FALSE, x, y);
}

static PetscErrorCode ShiftInvertApplyTranspose(PC pc, Vec x, Vec y)
{
  return ShiftInvertRun(pc, PETSC_TRUE, x, y);
}

/* Y = A^-1 X or A^-T X for the columns of X, as many steps of the eigensolver */
static PetscErrorCode ShiftInvertRunBlock(PC pc, PetscBool transposed, Mat X, Mat Y)
{
  ShiftInvert *si;
  PetscInt     n;

  PetscFunctionBeginUser;
  PetscCall(PCShellGetContext(pc, &si));
  PetscCall(ShiftInvertApplyBlock(si, transposed, X, Y));
  PetscCall(MatGetSize(X, NULL, &n));
  for (PetscInt j = 0; j < n; j++) PetscCall(ProgressStep(si->progress));
  if (si->after) PetscCall((*si->after)(si->after_ctx));
  PetscFunctionReturn(0);
}

static PetscErrorCode ShiftInvertMatApply(PC pc, Mat X, Mat Y)
{
  return ShiftInvertRunBlock(pc, PETSC_FALSE, X, Y);
}

static PetscErrorCode ShiftInvertMatApplyTranspose(PC pc, Mat X, Mat Y)
{
  return ShiftInvertRunBlock(pc, PETSC_TRUE, X, Y);
}

PetscErrorCode ShiftInvertAttach(ShiftInvert *si, PetscBool transposed, ST st)
{
  KSP ksp;
  PC  pc;

  PetscFunctionBeginUser;
  PetscCall(STSetType(st, STSINVERT));
  PetscCall(STSetMatMode(st, ST_MATMODE_SHELL));
  PetscCall(STGetKSP(st, &ksp));
  PetscCall(KSPSetOptionsPrefix(ksp, "st_inner_"));
  PetscCall(KSPSetType(ksp, KSPPREONLY));
  PetscCall(KSPGetPC(ksp, &pc));
  PetscCall(PCSetType(pc, PCSHELL));
  PetscCall(PCShellSetContext(pc, si));
  PetscCall(PCShellSetApply(pc, transposed ? ShiftInvertApplyTranspose : ShiftInvertApply));
  PetscCall(PCShellSetMatApply(pc, transposed ? ShiftInvertMatApplyTranspose : ShiftInvertMatApply));
  PetscFunctionReturn(0);
}

PetscErrorCode ShiftInvertCountBelow(const PencilMatrices *pencil, PetscReal away, Progress *progress, PetscReal *omega,
                                     PetscInt *n)
{
  PetscInt n_null = 1;

  PetscFunctionBeginUser;
  *n = 0;
  if (*omega <= 0) PetscFunctionReturn(0);
  for (int attempt = 0; attempt < 4 && n_null; attempt++) {
    ShiftInvert si;
    PC          pc;
    Mat         F;

    *omega *= 1 + attempt * away;
    PetscCall(ShiftInvertCreate(pencil, *omega * *omega, PETSC_TRUE, progress, &si));
    PetscCall(KSPGetPC(si.ksp, &pc));
    PetscCall(PCFactorGetMatrix(pc, &F));
    PetscCall(MatGetInertia(F, n, &n_null, NULL));
    PetscCall(ShiftInvertDestroy(&si));
  }
  PetscCall(ShiftInvertRegular(PetscObjectComm((PetscObject)pencil->K), !n_null, *omega * *omega));
  PetscFunctionReturn(0);
}

PetscErrorCode ShiftInvertDestroy(ShiftInvert *si)
{
  PetscFunctionBeginUser;
  PetscCall(KSPDestroy(&si->ksp));
  PetscFunctionReturn(0);
}
