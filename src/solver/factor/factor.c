/*
   The matrix of a shift and its factors: K - s M, or with damping K + s C + s^2 M, by a KSP with the user's -st_ksp_*,
   -st_pc_*, -st_mat_mumps_* options. At another shift, and for other values of the same pattern, the matrix is formed
   in place and the analysis serves again.
*/
#include "shiftinvert.h"
#include "base/algebra/matrixadd.h"
#include "lowrank.h"
#include <petscksp.h>
#include <petsc/private/petscimpl.h> /* PetscObjectStateGet() */

#define WORKSPACE_MOST 400 /* percent that MUMPS may have beyond its estimate before it is given up */

/* The stiffness that is factored: the symmetric part where friction is put on by an update */
static Mat ShiftInvertStiffness(const ShiftInvert *si, const PencilMatrices *pencil)
{
  return si->even && !pencil->symmetric ? pencil->K_even : pencil->K;
}

/* Whether the same matrices, with the pattern that they had, are factored again: PETSc counts changes of a pattern
   (MatGetNonzeroState()). */
PetscErrorCode ShiftInvertKeepsPattern(const ShiftInvert *si, const PencilMatrices *pencil, PetscBool *keeps)
{
  const Mat        now[3] = {ShiftInvertStiffness(si, pencil), pencil->C, pencil->M};
  PetscObjectState state;

  PetscFunctionBeginUser;
  *keeps = si->ksp && !si->released ? PETSC_TRUE : PETSC_FALSE;
  for (int i = 0; i < 3 && *keeps; i++) {
    *keeps = now[i] == si->term[i] ? PETSC_TRUE : PETSC_FALSE;
    if (!*keeps || !now[i]) continue;
    PetscCall(MatGetNonzeroState(now[i], &state));
    *keeps = state == si->pattern[i] ? PETSC_TRUE : PETSC_FALSE;
  }
  PetscFunctionReturn(0);
}

/* A += c X, in place where the pattern of A has that of X. Also for c = 0 the pattern becomes that of both, since the
   same matrix serves at other shifts; MatAXPY() does nothing then. */
static PetscErrorCode ShiftInvertAdd(PetscReal c, Mat X, MatStructure pattern, Mat A)
{
  PetscBool added;
  Mat       zeros;

  PetscFunctionBeginUser;
  PetscCall(MatrixAdd(c, X, A, &added));
  if (!added && c != 0) PetscCall(MatAXPY(A, c, X, pattern));
  if (added || c != 0) PetscFunctionReturn(0);
  PetscCall(MatDuplicate(X, MAT_DO_NOT_COPY_VALUES, &zeros));
  PetscCall(MatAXPY(A, 1, zeros, pattern));
  PetscCall(MatDestroy(&zeros));
  PetscFunctionReturn(0);
}

/* The upper half of K - s M, whose values the factorisation then takes where they are; NULL where it is not wanted or
   the user has a solver of his own */
static PetscErrorCode ShiftInvertHalf(const ShiftInvert *si, const PencilMatrices *pencil, Mat *A)
{
  static const char *const given[][2] = {
    {"-ksp_type", KSPPREONLY}, {"-pc_type", PCCHOLESKY}, {"-pc_factor_mat_solver_type", MATSOLVERMUMPS}};
  const Mat K    = ShiftInvertStiffness(si, pencil);
  PetscBool fits = si->even && si->halves && !pencil->C ? PETSC_TRUE : PETSC_FALSE, is, said;
  char      value[64];

  PetscFunctionBeginUser;
  *A = NULL;
  PetscCall(PetscObjectTypeCompare((PetscObject)K, MATSEQAIJ, &is));
  if (!is) fits = PETSC_FALSE;
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(given) && fits; i++) {
    PetscCall(PetscOptionsGetString(NULL, "st_", given[i][0], value, sizeof(value), &said));
    if (said) PetscCall(PetscStrcmp(value, given[i][1], &fits));
  }
  if (!fits) PetscFunctionReturn(0);
  PetscCall(MatConvert(K, MATSEQSBAIJ, MAT_INITIAL_MATRIX, A));
  PetscCall(MatrixAdd(-si->shift, pencil->M, *A, &fits));
  if (!fits) PetscCall(MatDestroy(A));
  PetscFunctionReturn(0);
}

/* K - s M, or K + s C + s^2 M with damping; in place where the pattern is kept */
static PetscErrorCode ShiftInvertMatrix(const ShiftInvert *si, const PencilMatrices *pencil, PetscBool in_place, Mat *A)
{
  const Mat          K       = ShiftInvertStiffness(si, pencil);
  const MatStructure pattern = in_place ? SUBSET_NONZERO_PATTERN : DIFFERENT_NONZERO_PATTERN;
  const PetscReal    s       = si->shift;

  PetscFunctionBeginUser;
  if (si->bare) { /* the caller's own, at shift 0: no copy */
    PetscCall(PetscObjectReference((PetscObject)K));
    *A = K;
    PetscFunctionReturn(0);
  }
  if (in_place) {
    PetscCall(KSPGetOperators(si->ksp, A, NULL));
    PetscCall(PetscObjectReference((PetscObject)*A));
    PetscCall(MatZeroEntries(*A));
    PetscCall(ShiftInvertAdd(1, K, pattern, *A));
  } else {
    PetscCall(ShiftInvertHalf(si, pencil, A));
    if (*A) PetscFunctionReturn(0);
    PetscCall(MatDuplicate(K, MAT_COPY_VALUES, A));
  }
  if (pencil->C) PetscCall(ShiftInvertAdd(s, pencil->C, pattern, *A));
  PetscCall(ShiftInvertAdd(pencil->C ? s * s : -s, pencil->M, pattern, *A));
  PetscCall(MatSetOption(*A, MAT_SYMMETRIC, pencil->symmetric || si->even ? PETSC_TRUE : PETSC_FALSE));
  PetscFunctionReturn(0);
}

/* Remembers what was factored */
static PetscErrorCode ShiftInvertRemember(const PencilMatrices *pencil, ShiftInvert *si)
{
  const Mat now[3] = {ShiftInvertStiffness(si, pencil), pencil->C, pencil->M};

  PetscFunctionBeginUser;
  for (int i = 0; i < 3; i++) {
    if (now[i]) PetscCall(PetscObjectReference((PetscObject)now[i]));
    PetscCall(MatDestroy(&si->term[i]));
    si->term[i] = now[i];
    if (now[i]) PetscCall(MatGetNonzeroState(now[i], &si->pattern[i]));
    if (now[i]) PetscCall(PetscObjectStateGet((PetscObject)now[i], &si->values[i]));
  }
  PetscFunctionReturn(0);
}

/* Raises the error for a failed factorisation; a singular matrix sets *singular instead. INFOG(1) by the MUMPS
   Users' guide: -8, -9, -14, -15, -17, -20 workspace or buffers, -5, -7, -13, -19 memory, -6, -10 singular in
   structure or numbers; INFOG(28) null pivots. */
static PetscErrorCode ShiftInvertCheck(const ShiftInvert *si, PC pc, PetscBool *singular)
{
  PCFailedReason reason;
  MatSolverType  type;
  PetscBool      is_mumps = PETSC_FALSE;
  PetscInt       info = 0, extra = 0, n_null = 0;
  const MPI_Comm comm = si->comm;
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
    if ((si->inertia && !si->counts) || si->bare) PetscCall(MatMumpsGetInfog(F, 28, &n_null));
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
  if (n_null || info == -10 || info == -6 || reason == PC_FACTOR_NUMERIC_ZEROPIVOT ||
      reason == PC_FACTOR_STRUCT_ZEROPIVOT)
    *singular = PETSC_TRUE;
  PetscCheck(*singular || !reason, comm, PETSC_ERR_NOT_CONVERGED,
             "factorisation failed (MUMPS INFOG(1) = %" PetscInt_FMT ")", info);
  PetscFunctionReturn(0);
}

/* Solver with MUMPS as default: ICNTL(14) extra workspace in percent, ICNTL(13) = 1 no ScaLAPACK at the root,
   ICNTL(24) = 1 null pivots found, ICNTL(33) = 1 determinant. */
static PetscErrorCode ShiftInvertCreateSolver(ShiftInvert *si, Mat A)
{
  PC  pc;
  Mat F;

  PetscFunctionBeginUser;
  PetscCall(KSPCreate(si->comm, &si->ksp));
  PetscCall(KSPSetOptionsPrefix(si->ksp, "st_"));
  PetscCall(KSPSetOperators(si->ksp, A, A));
  PetscCall(KSPSetType(si->ksp, KSPPREONLY));
  PetscCall(KSPGetPC(si->ksp, &pc));
  PetscCall(PCSetType(pc, si->even ? PCCHOLESKY : PCLU));
  PetscCall(PCFactorSetMatSolverType(pc, MATSOLVERMUMPS));
  if (si->bare)
    PetscCall(MatSetOptionsPrefixFactor(A, "st_"));
  else
    PetscCall(KSPSetFromOptions(si->ksp));
  if (si->inertia || si->workspace || si->bare) {
    PetscCall(PCFactorSetUpMatSolverType(pc));
    PetscCall(PCFactorGetMatrix(pc, &F));
  }
  if (si->workspace) PetscCall(MatMumpsSetIcntl(F, 14, si->workspace));
  if (si->bare) {
    PetscCall(MatMumpsSetIcntl(F, 24, 1));
    PetscCall(MatMumpsSetIcntl(F, 33, 1));
  }
  if (si->inertia) {
    PetscCall(MatMumpsSetIcntl(F, 13, 1)); /* MUMPS counts negative pivots of the root only without ScaLAPACK */
    PetscCall(MatMumpsSetIcntl(F, 24, 1)); /* null pivots are counted, INFOG(28), instead of an error */
  }
  PetscFunctionReturn(0);
}

/* Whether factors serve again without any work: the same matrices with the same values (PetscObjectStateGet()
   counts changes), the same shift bit by bit, LDL' with inertia. */
PetscErrorCode ShiftInvertStands(const PencilMatrices *pencil, PetscReal shift, const ShiftInvert *si,
                                 PetscBool *stands)
{
  const Mat now[3] = {ShiftInvertStiffness(si, pencil), pencil->C, pencil->M};

  PetscFunctionBeginUser;
  *stands = PETSC_FALSE;
  if (!si->even || !si->inertia || si->shift != shift || !si->factored) PetscFunctionReturn(0);
  PetscCall(ShiftInvertKeepsPattern(si, pencil, stands));
  for (int i = 0; i < 3 && *stands; i++) {
    PetscObjectState state;

    if (!now[i]) continue;
    PetscCall(PetscObjectStateGet((PetscObject)now[i], &state));
    *stands = state == si->values[i] ? PETSC_TRUE : PETSC_FALSE;
  }
  PetscFunctionReturn(0);
}

/* The matrix and its analysis. With the same pattern both stay and values alone are formed anew; else the old
   factors go first, as two sets would not fit. */
PetscErrorCode ShiftInvertPrepare(const PencilMatrices *pencil, ShiftInvert *si)
{
  PetscBool keeps;
  Mat       A;

  PetscFunctionBeginUser;
  si->factored = PETSC_FALSE;
  PetscCall(ShiftInvertKeepsPattern(si, pencil, &keeps));
  si->released = PETSC_FALSE;
  if (!keeps) PetscCall(KSPDestroy(&si->ksp)); /* before there is another matrix beside its factors */
  PetscCall(ShiftInvertMatrix(si, pencil, keeps, &A));
  if (keeps) {
    PetscCall(KSPSetOperators(si->ksp, A, A));
  } else {
    PetscCall(ShiftInvertCreateSolver(si, A));
    PetscCall(ShiftInvertAnalyse(si, A, &si->cost));
  }
  PetscCall(ShiftInvertRemember(pencil, si));
  PetscCall(MatDestroy(&A));
  PetscFunctionReturn(0);
}

/* The percentage of workspace beyond its estimate, of `most`, that MUMPS is to be given for another try, INFOG(1) = -8
   or -9, as several ranks on small matrices and late pivots need; 0 for none: what -mat_mumps_icntl_14 says stays, and
   where ICNTL(23) limits the memory MUMPS takes no notice of more */
static PetscErrorCode FactorWantsSpace(Mat F, const char prefix[], PetscInt most, PetscInt *percent)
{
  PetscInt  info, now, limit;
  PetscBool given;

  PetscFunctionBeginUser;
  PetscCall(MatMumpsGetInfog(F, 1, &info));
  PetscCall(MatMumpsGetIcntl(F, 14, &now));
  PetscCall(MatMumpsGetIcntl(F, 23, &limit));
  PetscCall(PetscOptionsHasName(NULL, prefix, "-mat_mumps_icntl_14", &given));
  *percent = 0;
  if ((info == -8 || info == -9) && !given && limit <= 0 && now < most)
    *percent = PetscMin(PetscMax(100, 4 * now), most);
  PetscFunctionReturn(0);
}

/* Whether to try again with si->workspace raised; then the factors are gone */
static PetscErrorCode ShiftInvertWantsSpace(ShiftInvert *si, PC pc, PetscBool *wants)
{
  MatSolverType type;
  PetscInt      percent;
  Mat           F;

  PetscFunctionBeginUser;
  *wants = PETSC_FALSE;
  PetscCall(PCFactorGetMatSolverType(pc, &type));
  if (type) PetscCall(PetscStrcmp(type, MATSOLVERMUMPS, wants));
  if (!*wants) PetscFunctionReturn(0);
  PetscCall(PCFactorGetMatrix(pc, &F));
  PetscCall(FactorWantsSpace(F, "st_", WORKSPACE_MOST, &percent));
  *wants = percent > 0 ? PETSC_TRUE : PETSC_FALSE;
  if (!*wants) PetscFunctionReturn(0);
  si->workspace = percent;
  PetscCall(KSPDestroy(&si->ksp));
  PetscFunctionReturn(0);
}

/* Tries again with more workspace where MUMPS asks for it; it ends, since FactorWantsSpace() gives at most
   WORKSPACE_MOST. si->factored tells whether there are factors then. */
PetscErrorCode ShiftInvertFactor(const PencilMatrices *pencil, ShiftInvert *si, PetscBool *singular)
{
  PetscBool again = PETSC_TRUE;
  PC        pc;

  PetscFunctionBeginUser;
  while (again) {
    PetscCall(ShiftInvertPrepare(pencil, si));
    PetscCall(KSPSetUp(si->ksp));
    PetscCall(KSPGetPC(si->ksp, &pc));
    PetscCall(ShiftInvertWantsSpace(si, pc, &again));
  }
  PetscCall(ShiftInvertCheck(si, pc, singular));
  si->factored = *singular ? PETSC_FALSE : PETSC_TRUE;
  if (*singular) PetscCall(KSPDestroy(&si->ksp));
  PetscFunctionReturn(0);
}

/* RINFOG(12) is the mantissa of the determinant; its exponent, INFOG(34), is not needed */
PetscErrorCode ShiftInvertIsNegative(const ShiftInvert *si, PetscBool *negative)
{
  PetscReal mantissa;
  PetscBool is_mumps;
  Mat       F;

  PetscFunctionBeginUser;
  PetscCall(ShiftInvertGetFactors(si->ksp, &F, &is_mumps));
  PetscCall(MatMumpsGetRinfog(F, 12, &mantissa));
  *negative = mantissa < 0 ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(0);
}
