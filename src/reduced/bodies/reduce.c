/*
   Reduction of the bodies of a run: modes below the cut-off, ports, pairs, the residual; again at another cut-off or
   other parameters.
*/
#include "reduced/reducedimpl.h"

/* Collective. Modes first, as ports are looked at by them (P = V'Phi); the residual last, from both. */
PetscErrorCode ReducedReduce(ReducedRun r)
{
  PetscInt n_own;

  PetscFunctionBeginUser;
  PetscCall(ReducedCheckMemory(r));
  PetscCall(ReducedFindModes(r));
  PetscCall(ReducedSetPorts(r));
  PetscCall(ReducedSetPairs(r));
  PetscCall(ReducedSetResidual(r));
  PetscCall(ReducedSettleDrag(r));
  PetscCall(ReducedStateCreate(&r->reduction.model, &r->motion.state));
  PetscCall(ReducedReportCreate(&r->reduction.model, &r->motion.report));
  PetscCall(PetscCalloc3(r->reduction.model.m, &r->motion.acceleration, 2 * r->reduction.model.n_ports,
                         &r->motion.p_rate, r->reduction.model.n_ports, &r->motion.shown));
  PetscCall(MatGetLocalSize(r->reduction.Phi, &n_own, NULL));
  PetscCall(MatCreateDense(r->comm, n_own, PETSC_DECIDE, PETSC_DETERMINE, 1, NULL, &r->motion.column));
  PetscCall(ReducedDriveCreate(r));
  PetscFunctionReturn(0);
}

PetscErrorCode ReducedForget(ReducedRun r)
{
  PetscFunctionBeginUser;
  PetscCall(ReducedStateDestroy(&r->motion.state));
  PetscCall(ReducedReportDestroy(&r->motion.report));
  PetscCall(ReducedModelDestroy(&r->reduction.model));
  PetscCall(PetscFree3(r->motion.acceleration, r->motion.p_rate, r->motion.shown));
  PetscCall(PetscFree3(r->motion.loads, r->motion.sliding, r->motion.kick));
  PetscCall(PetscFree2(r->motion.pairs, r->motion.sums));
  PetscCall(PetscFree(r->reduction.pair));
  PetscCall(PetscFree2(r->reduction.hits, r->reduction.hit_due));
  PetscCall(PetscFree(r->reduction.vertex_port));
  PetscCall(MatDestroy(&r->motion.column));
  PetscCall(MatDestroy(&r->reduction.Phi));
  PetscCall(MatDestroy(&r->reduction.MPhi));
  PetscCall(MatDestroy(&r->reduction.G));
  PetscCall(MatDestroy(&r->reduction.others));
  PetscCall(ShiftInvertDestroy(&r->reduction.inverse));
  PetscCall(ModesDestroy(&r->reduction.body_modes));
  PetscCall(PencilDestroy(&r->reduction.bodies));
  PetscCall(ChecksumDestroy(&r->scene));
  r->reduction.begin = 0;
  PetscFunctionReturn(0);
}

PetscErrorCode ReducedDestroy(ReducedRun *reduced)
{
  ReducedRun r = *reduced;

  PetscFunctionBeginUser;
  if (!r) PetscFunctionReturn(0);
  PetscCall(ReducedStepperDestroy(&r->motion.stepper));
  PetscCall(ReducedForget(r));
  PetscCall(PetscFree(r->request.p));
  PetscCall(PetscFree(r->result.closed));
  PetscCall(PetscFree(r->result.lambda_n));
  PetscCall(PetscFree(r->result.compared));
  PetscCall(PetscFree(r->result.growing));
  PetscCall(PetscFree(r->result.force));
  PetscCall(PetscFree(*reduced));
  PetscFunctionReturn(0);
}

PetscErrorCode ReducedCreate(MPI_Comm comm, ReducedRun *reduced)
{
  PetscFunctionBeginUser;
  PetscCall(PetscNew(reduced));
  (*reduced)->comm = comm;
  PetscCall(QuantitiesInit(&reduced_quantities, *reduced));
  PetscFunctionReturn(0);
}

/* The bodies below a cut-off with parameters p, in the modes that resemble those of `like`, or in all. The rooms
   are borrowed from r; factors of the residual are freed, since nothing is lifted to the mesh from there. */
PetscErrorCode ReducedReduceAt(ReducedRun r, PetscReal cutoff, const PetscReal p[], ReducedRun like, ReducedRun *other)
{
  PetscFunctionBeginUser;
  PetscCall(ReducedCreate(r->comm, other));
  (*other)->dynamics       = r->dynamics;
  (*other)->mesh_modes     = r->mesh_modes;
  (*other)->run            = r->run;
  (*other)->request.cutoff = cutoff > 0 ? cutoff : r->request.cutoff;
  (*other)->motion.dt      = r->motion.dt;
  (*other)->request.like   = like;
  (*other)->request.weighs = r->request.weighs;
  (*other)->request.dense  = r->request.dense;
  (*other)->request.steps  = r->request.steps;
  if (p) PetscCall(OperatorsCreatePoint(r->run.operators, p, &(*other)->request.p));
  PetscCall(ReducedReduce(*other));
  if (!(*other)->reduction.model.sparse) PetscCall(ShiftInvertDestroy(&(*other)->reduction.inverse));
  PetscFunctionReturn(0);
}
