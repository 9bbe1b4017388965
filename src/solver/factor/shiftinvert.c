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
#include "lowrank.h"

#define UPDATE_STIFF 1e2 /* k_n mu of a pair beside the (geometric) mean of the bodies' stiffnesses: LU from here on */
#define UPDATE_ROOM  0.8 /* of the memory that is free: vectors that take more beside the factors are not kept */
#define UPDATE_SLOW  1.5 /* flops of the solves that make it beside those that LU takes more: LU from here on */
/* flops of LDL' per entry; from here on they run faster than a solve's, as the root of this */
#define UPDATE_DENSE 700
/* pairs for each right-hand side that is expected: the memory of more vectors is not worth their time */
#define UPDATE_KEPT  2.5
#define UPDATE_SHARE 0.75 /* of the entries of LDL': vectors of an update that take no more are kept */

PetscErrorCode ShiftInvertRegular(MPI_Comm comm, PetscBool regular, PetscReal shift)
{
  PetscFunctionBeginUser;
  PetscCheck(regular, comm, PETSC_ERR_MAT_LU_ZRPVT,
             "the problem is singular at every shift near %.6g: a part without mass, an unknown without stiffness and "
             "mass, or a "
             "constraint that follows from others",
             (double)shift);
  PetscFunctionReturn(0);
}

/* Whether the pairs are so stiff beside the bodies that an update would lose digits: it gets the gap of a pair as
   the difference of two displacements, and its force as k_n times that. |left| |right| / p is about the mean k_n mu
   of a pair, N/m; exp(mean log |K_ii|) the geometric mean of the bodies, in which few stiff unknowns do not count. */
static PetscErrorCode UpdateIsStiff(const PencilMatrices *pencil, PetscBool *stiff)
{
  PetscReal   left, right;
  PetscScalar sum;
  PetscInt    p, n;
  Vec         diagonal;

  PetscFunctionBeginUser;
  PetscCall(MatNorm(pencil->left, NORM_FROBENIUS, &left));
  PetscCall(MatNorm(pencil->right, NORM_FROBENIUS, &right));
  PetscCall(MatGetSize(pencil->left, &p, &n));
  PetscCall(MatCreateVecs(pencil->K_even, &diagonal, NULL));
  PetscCall(MatGetDiagonal(pencil->K_even, diagonal));
  PetscCall(VecAbs(diagonal));
  PetscCall(VecShift(diagonal, PETSC_MACHINE_EPSILON * left * right));
  PetscCall(VecLog(diagonal));
  PetscCall(VecSum(diagonal, &sum));
  PetscCall(VecDestroy(&diagonal));
  *stiff = left * right / p > UPDATE_STIFF * PetscExpReal(PetscRealPart(sum) / n) ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(0);
}

/* Whether the vectors of an update, one a pair, n p numbers, fit beside the factors, in MB of 8e-6 a number. */
static PetscErrorCode UpdateFits(const PencilMatrices *pencil, const ShiftInvert *si, double n, double p,
                                 PetscBool *fits)
{
  PetscInt n_local;

  PetscFunctionBeginUser;
  PetscCall(MatGetLocalSize(pencil->K_even, &n_local, NULL));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &n_local, 1, MPIU_INT, MPI_MAX, si->comm));
  *fits = n * p <= UPDATE_SHARE * si->cost.entries &&
              n_local * p <= PETSC_MAX_INT && /* as PETSc counts a rank's entries */
              si->cost.needed + 8e-6 * n * p <= UPDATE_ROOM * si->cost.room
            ? PETSC_TRUE
            : PETSC_FALSE;
  PetscFunctionReturn(0);
}

/* Why LU is better than LDL' and an update of p vectors, NULL where it is not. LU has twice the entries e of LDL' and
   takes twice the flops F to make; a solve takes 4 e flops with either. So an update costs 4 e p flops and LU F. In
   small fronts both run about as fast, and afterwards the update saves some, since it solves for right and left vectors
   at once; fronts that are denser, F / e, make a factorisation faster and no solve. Processor time of the update over
   that of LU, three scenes: 0.97 with 4 e p / F = 1.22 and F / e = 395, 1.04 with 1.35 and 670, 1.15 to 1.25 with 1.14
   and 1550 (scripts/bench/choices). Where the vectors are not kept every solve is two. */
static const char *UpdateIsWorse(const FactorCost *cost, double p, PetscBool fits)
{
  PetscReal rate;

  if (2 * cost->needed > cost->room) return NULL;
  if (!fits) return "an update for friction would take more memory";
  rate = PetscMax(1, PetscSqrtReal(cost->flops / (UPDATE_DENSE * cost->entries)));
  return 4 * cost->entries * p * rate > UPDATE_SLOW * cost->flops ? "an update for friction would take longer" : NULL;
}

/* Whether friction is to be put on factors of the symmetric part by an update (lowrank.h), and whether its vectors,
   one a pair, are kept. The symbolic analysis is run for it, whose estimates are alike on all ranks, and so is the
   choice. */
static PetscErrorCode ShiftInvertChoose(const PencilMatrices *pencil, ShiftInvert *si, PetscBool *store)
{
  PetscInt  n, p;
  PetscBool keeps, stiff;

  PetscFunctionBeginUser;
  *store   = PETSC_FALSE;
  si->why  = NULL;
  si->even = (!pencil->C || si->even_damped) && (pencil->symmetric || pencil->left) ? PETSC_TRUE : PETSC_FALSE;
  if (!si->even || pencil->symmetric) PetscFunctionReturn(0);
  PetscCall(UpdateIsStiff(pencil, &stiff));
  if (stiff) si->why = "pairs too stiff for an update";
  if (!stiff || pencil->prefers_even) {
    PetscCall(ShiftInvertKeepsPattern(si, pencil, &keeps));
    if (!keeps) PetscCall(ShiftInvertPrepare(pencil, si));
    PetscCall(MatGetSize(pencil->left, &p, &n));
    PetscCall(UpdateFits(pencil, si, n, p, store));
    si->why = UpdateIsWorse(&si->cost, p, *store);
    if (si->solves > 0 && p > UPDATE_KEPT * si->solves) *store = PETSC_FALSE;
  }
  if (pencil->prefers_even) si->why = NULL;
  if (si->why) si->even = *store = PETSC_FALSE;
  PetscFunctionReturn(0);
}

static PetscErrorCode UpdateDestroy(ShiftInvert *si)
{
  PetscFunctionBeginUser;
  if (si->update) PetscCall(LowRankDestroy(si->update));
  PetscCall(PetscFree(si->update));
  PetscFunctionReturn(0);
}

/* Friction on the factors of the symmetric part */
static PetscErrorCode UpdateCreate(const PencilMatrices *pencil, PetscBool store, ShiftInvert *si, PetscBool *singular)
{
  PetscBool rows, inverse;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(1, &si->update));
  PetscCall(ShiftInvertSolvesRows(si->ksp, &rows));
  PetscCall(ShiftInvertGivesInverse(si->ksp, &inverse));
  if (rows) si->update->solve_rows = ShiftInvertApplyRows;
  if (inverse) si->update->inverse = ShiftInvertGetInverse;
  si->update->solve = ShiftInvertApplyFactors;
  si->update->ctx   = si->ksp;
  PetscCall(LowRankSetUp(pencil->left, pencil->right, store, si->update, singular));
  PetscFunctionReturn(0);
}

/* Factors at si->shift, friction put on them. What is released before is got again where the update is singular. */
static PetscErrorCode ShiftInvertTry(const PencilMatrices *pencil, PetscBool stands, PetscBool store, ShiftInvert *si,
                                     PetscBool *singular)
{
  PencilMatrices whole;

  PetscFunctionBeginUser;
  *singular = PETSC_FALSE;
  PetscCall(ShiftInvertRegain(pencil, si, &whole));
  if (!stands) PetscCall(ShiftInvertFactor(&whole, si, singular));
  if (*singular) PetscFunctionReturn(0);
  PetscCall(ShiftInvertRelease(&whole, si));
  if (si->even && !pencil->symmetric) PetscCall(UpdateCreate(pencil, store, si, singular));
  if (*singular) PetscCall(UpdateDestroy(si));
  PetscFunctionReturn(0);
}

/* A singular matrix moves the shift by 1e-4, then 2e-4 and 3e-4 of itself; factors that stand are used for the
   first try alone. Raises the error where no shift is regular. */
PetscErrorCode ShiftInvertMove(const PencilMatrices *pencil, PetscReal shift, ShiftInvert *si)
{
  PetscBool      singular = PETSC_TRUE, store, stands;
  PencilMatrices whole;

  PetscFunctionBeginUser;
  PetscCall(EventBegin(EVENT_FACTOR));
  PetscCall(PetscObjectGetComm((PetscObject)pencil->K, &si->comm));
  PetscCall(UpdateDestroy(si));
  PetscCall(ShiftInvertRegain(pencil, si, &whole));
  PetscCall(ShiftInvertChoose(&whole, si, &store));
  PetscCall(ShiftInvertStands(&whole, shift, si, &stands));
  si->shift = shift;
  for (int attempt = 0; attempt < 4 && singular; attempt++, si->shift *= singular ? 1 + 1e-4 * attempt : 1) {
    PetscCall(ShiftInvertTry(pencil, stands, store, si, &singular));
    stands = PETSC_FALSE;
  }
  PetscCall(ShiftInvertRegular(si->comm, singular ? PETSC_FALSE : PETSC_TRUE, shift));
  if (!si->counts) PetscCall(ShiftInvertMakeTrial(si));
  PetscCall(EventEnd(EVENT_FACTOR));
  PetscFunctionReturn(0);
}

PetscErrorCode ShiftInvertCreate(const PencilMatrices *pencil, PetscReal shift, PetscBool inertia, Progress *progress,
                                 ShiftInvert *si)
{
  PetscFunctionBeginUser;
  *si = (ShiftInvert){.progress = progress, .inertia = inertia};
  PetscCall(ShiftInvertMove(pencil, shift, si));
  PetscFunctionReturn(0);
}

/* x = A^-1 b by the update, for a block of one */
static PetscErrorCode UpdateSolve(const ShiftInvert *si, PetscBool transposed, Vec b, Vec x)
{
  PetscInt     n_local, n;
  PetscScalar *out;
  Mat          X;

  PetscFunctionBeginUser;
  PetscCall(VecGetLocalSize(b, &n_local));
  PetscCall(VecGetSize(b, &n));
  PetscCall(VecCopy(b, x));
  PetscCall(VecGetArray(x, &out));
  PetscCall(MatCreateDense(si->comm, n_local, PETSC_DECIDE, n, 1, out, &X));
  PetscCall(LowRankApply(si->update, transposed ? 0 : 1, X));
  PetscCall(MatDestroy(&X));
  PetscCall(VecRestoreArray(x, &out));
  PetscFunctionReturn(0);
}

PetscErrorCode ShiftInvertSolve(const ShiftInvert *si, PetscBool transposed, Vec b, Vec x)
{
  KSPConvergedReason reason;

  PetscFunctionBeginUser;
  if (si->update) {
    PetscCall(UpdateSolve(si, transposed, b, x));
    PetscFunctionReturn(0);
  }
  if (transposed)
    PetscCall(KSPSolveTranspose(si->ksp, b, x));
  else
    PetscCall(KSPSolve(si->ksp, b, x));
  PetscCall(KSPGetConvergedReason(si->ksp, &reason));
  PetscCheck(reason >= 0, si->comm, PETSC_ERR_NOT_CONVERGED,
             "the linear solver failed (%s): see -st_ksp_type, -st_ksp_rtol and -st_ksp_max_it, or leave them out",
             KSPConvergedReasons[reason]);
  PetscFunctionReturn(0);
}

PetscErrorCode ShiftInvertStepped(const ShiftInvert *si, PetscInt n)
{
  PetscFunctionBeginUser;
  for (PetscInt j = 0; j < n; j++) PetscCall(ProgressStep(si->progress));
  if (si->after) PetscCall((*si->after)(si->after_ctx));
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
  PetscCall(ShiftInvertStepped(si, 1));
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
  PetscCall(ShiftInvertStepped(si, n));
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

/* SLEPc's spectral transformation gets a shell preconditioner, which solves with our factors: it forms no matrix of
   its own (ST_MATMODE_SHELL) and reads no options but st_inner_. */
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

PetscBool ShiftInvertIsDamped(const ShiftInvert *si)
{
  return si->term[1] ? PETSC_TRUE : PETSC_FALSE;
}

PetscErrorCode ShiftInvertDestroy(ShiftInvert *si)
{
  PetscFunctionBeginUser;
  PetscCall(UpdateDestroy(si));
  PetscCall(ShiftInvertDestroyTrial(si));
  PetscCall(MatDestroy(&si->product));
  PetscCall(KSPDestroy(&si->ksp));
  for (int i = 0; i < 3; i++) PetscCall(MatDestroy(&si->term[i]));
  PetscFunctionReturn(0);
}
