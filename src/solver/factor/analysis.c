/*
   Symbolic analysis by itself, before the factorisation, which then finds it done: what the factors will need is known,
   shown by -squeal_view, and refused where the machine has not as much, before hours are spent or the system ends other
   programs. The estimate is that of MUMPS after its analysis (MUMPS Users' guide, INFO), in MB of each rank: INFO(15)
   in memory, INFO(17) with the factors on disk, ICNTL(22) = 1; INFO(30) and INFO(31) likewise for block low-rank
   factors, ICNTL(35) > 0. Ranks that share a machine share its memory.
*/
#include "shiftinvert.h"
#include "base/process/memory.h"
#include "ordering.h"
#include <math.h>

/* MB of factors, from which freed memory is given back before they are made: below it costs more than it gains. */
#define RETURN_FROM 500

#define SHOW_AGAIN 1.1 /* estimates that exceed those shown before by less are not shown */

static double shown = INFINITY; /* log handle: MB of the largest estimate that has been shown; infinite for none */

/* Order of the unknowns: the user's, else for LU on one rank METIS's; MUMPS chooses in the other cases */
static PetscErrorCode AnalysisGetOrdering(Mat A, PetscBool symmetric, IS *row, IS *column)
{
  char        type[64] = MATORDERINGEXTERNAL;
  PetscMPIInt size;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(PetscObjectComm((PetscObject)A), &size));
  if (size == 1 && !symmetric) PetscCall(PetscStrncpy(type, ORDERING_METIS, sizeof(type)));
  PetscCall(PetscOptionsGetString(NULL, "st_", "-pc_factor_mat_ordering_type", type, sizeof(type), NULL));
  PetscCall(OrderingRegister());
  PetscCall(MatGetOrdering(A, type, row, column));
  PetscFunctionReturn(0);
}

/* Analyses A by MUMPS */
static PetscErrorCode AnalysisRun(PC pc, Mat A, PetscBool symmetric)
{
  Mat           F;
  IS            row, column;
  MatFactorInfo info;

  PetscFunctionBeginUser;
  PetscCall(MatFactorInfoInitialize(&info));
  PetscCall(PCFactorSetUpMatSolverType(pc));
  PetscCall(PCFactorGetMatrix(pc, &F));
  PetscCall(AnalysisGetOrdering(A, symmetric, &row, &column));
  if (symmetric)
    PetscCall(MatCholeskyFactorSymbolic(F, A, row, &info));
  else
    PetscCall(MatLUFactorSymbolic(F, A, row, column, &info));
  PetscCall(ISDestroy(&row));
  PetscCall(ISDestroy(&column));
  PetscCall(PCFactorSetMatOrderingType(pc, MATORDERINGEXTERNAL)); /* it has been used */
  PetscFunctionReturn(0);
}

/* MUMPS' estimates, the same on all ranks: those of the machine that lacks most, by MPI_MAXLOC over the ranks.
   INFOG(3) below zero counts millions of entries. */
static PetscErrorCode AnalysisEstimate(MPI_Comm comm, Mat F, FactorCost *cost)
{
  PetscInt    entries, low_rank, on_disk, core, disk;
  PetscMPIInt rank;
  PetscBool   given;
  MPI_Comm    machine;
  struct {
    double lack;
    int    rank;
  } worst;
  PetscReal flops;
  double    mb[3];

  PetscFunctionBeginUser;
  PetscCall(MatMumpsGetInfog(F, 3, &entries));
  PetscCall(MatMumpsGetRinfog(F, 1, &flops));
  PetscCall(MatMumpsGetIcntl(F, 22, &on_disk));
  PetscCall(MatMumpsGetIcntl(F, 35, &low_rank));
  PetscCall(MatMumpsGetInfo(F, low_rank ? 30 : 15, &core));
  PetscCall(MatMumpsGetInfo(F, low_rank ? 31 : 17, &disk));
  mb[0] = (double)(on_disk ? disk : core);
  mb[1] = (double)disk;
  PetscCallMPI(MPI_Allreduce(mb, &cost->all, 1, MPI_DOUBLE, MPI_SUM, comm));
  PetscCallMPI(MPI_Comm_split_type(comm, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &machine));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, mb, 2, MPI_DOUBLE, MPI_SUM, machine));
  PetscCallMPI(MPI_Comm_free(&machine));
  if (cost->all >= RETURN_FROM) MemoryReturn();
  PetscCallMPI(MPI_Barrier(comm)); /* all ranks have, before any looks what is free */
  mb[2] = MemoryRoom(&given);
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  worst.lack = mb[0] - mb[2];
  worst.rank = rank;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &worst, 1, MPI_DOUBLE_INT, MPI_MAXLOC, comm));
  PetscCallMPI(MPI_Bcast(mb, 3, MPI_DOUBLE, worst.rank, comm));
  cost->entries = entries < 0 ? -1e6 * (double)entries : (double)entries;
  cost->flops   = flops;
  cost->needed  = mb[0];
  cost->disk    = mb[1];
  cost->room    = mb[2];
  PetscFunctionReturn(0);
}

/* Raises the error where the factors do not fit */
static PetscErrorCode AnalysisCheck(MPI_Comm comm, Mat A, const FactorCost *cost)
{
  char      disk[128] = "";
  PetscInt  n;
  PetscBool given;

  PetscFunctionBeginUser;
  PetscCall(MatGetSize(A, &n, NULL));
  (void)MemoryRoom(&given);
  if (cost->disk < 0.9 * cost->needed)
    PetscCall(
      PetscSNPrintf(disk, sizeof(disk), ", or factors on disk by -st_mat_mumps_icntl_22 1 (%.0f MB)", cost->disk));
  PetscCheck(cost->needed <= cost->room, comm, PETSC_ERR_USER_INPUT,
             "the factors of %" PetscInt_FMT
             " unknowns need %.0f MB on one machine by MUMPS' estimate, and %s %.6g MB: "
             "take a coarser mesh, more machines%s%s",
             n, cost->needed, given ? "-squeal_memory allows" : "there are free", cost->room, disk,
             given ? "" : "; -squeal_memory MB says otherwise");
  PetscFunctionReturn(0);
}

/* Shows what the factors need, where it is more than was shown before */
static PetscErrorCode AnalysisShow(MPI_Comm comm, PetscBool symmetric, const FactorCost *cost)
{
  PetscFunctionBeginUser;
  if (!(cost->all > SHOW_AGAIN * shown)) PetscFunctionReturn(0);
  PetscCall(PetscPrintf(comm, "factors: %s, %.1f M entries, %.0f MB by MUMPS' estimate, %.0f MB to be had\n",
                        symmetric ? "LDL'" : "LU", 1e-6 * cost->entries, cost->all, cost->room));
  shown = cost->all;
  PetscFunctionReturn(0);
}

void ShiftInvertShow(PetscBool show)
{
  shown = show ? 0 : INFINITY;
}

PetscBool ShiftInvertShows(void)
{
  return shown < INFINITY ? PETSC_TRUE : PETSC_FALSE;
}

/* Solvers other than MUMPS have no estimate: *cost stays zero, and nothing is checked. */
PetscErrorCode ShiftInvertAnalyse(const ShiftInvert *si, Mat A, FactorCost *cost)
{
  PC            pc;
  Mat           F;
  MatSolverType solver;
  PetscBool     is_mumps = PETSC_FALSE, symmetric;

  PetscFunctionBeginUser;
  *cost = (FactorCost){0};
  PetscCall(KSPGetPC(si->ksp, &pc));
  PetscCall(PCFactorGetMatSolverType(pc, &solver));
  if (solver) PetscCall(PetscStrcmp(solver, MATSOLVERMUMPS, &is_mumps));
  if (!is_mumps) PetscFunctionReturn(0);
  PetscCall(PetscObjectTypeCompare((PetscObject)pc, PCCHOLESKY, &symmetric));
  PetscCall(AnalysisRun(pc, A, symmetric));
  PetscCall(PCFactorGetMatrix(pc, &F));
  PetscCall(AnalysisEstimate(si->comm, F, cost));
  PetscCall(AnalysisShow(si->comm, symmetric, cost));
  PetscCall(AnalysisCheck(si->comm, A, cost));
  PetscFunctionReturn(0);
}
