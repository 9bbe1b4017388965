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
  PetscCall(ReducedFindModes(r));
  PetscCall(ReducedSetPorts(r));
  PetscCall(ReducedSetPairs(r));
  PetscCall(ReducedSetResidual(r));
  PetscCall(ReducedStateCreate(&r->model, &r->state));
  PetscCall(ReducedReportCreate(&r->model, &r->report));
  PetscCall(PetscCalloc3(r->model.m, &r->acceleration, 2 * r->model.n_ports, &r->p_rate, r->model.n_ports, &r->shown));
  PetscCall(MatGetLocalSize(r->Phi, &n_own, NULL));
  PetscCall(MatCreateDense(r->comm, n_own, PETSC_DECIDE, PETSC_DETERMINE, 1, NULL, &r->column));
  PetscCall(ReducedDriveCreate(r));
  PetscFunctionReturn(0);
}

PetscErrorCode ReducedForget(ReducedRun r)
{
  PetscFunctionBeginUser;
  PetscCall(ReducedStateDestroy(&r->state));
  PetscCall(ReducedReportDestroy(&r->report));
  PetscCall(ReducedModelDestroy(&r->model));
  PetscCall(PetscFree3(r->acceleration, r->p_rate, r->shown));
  PetscCall(PetscFree3(r->loads, r->sliding, r->kick));
  PetscCall(PetscFree2(r->pairs, r->sums));
  PetscCall(PetscFree(r->pair));
  PetscCall(PetscFree2(r->hits, r->hit_due));
  PetscCall(PetscFree(r->vertex_port));
  PetscCall(MatDestroy(&r->column));
  PetscCall(MatDestroy(&r->Phi));
  PetscCall(MatDestroy(&r->MPhi));
  PetscCall(MatDestroy(&r->G));
  PetscCall(MatDestroy(&r->others));
  PetscCall(ShiftInvertDestroy(&r->inverse));
  PetscCall(ModesDestroy(&r->body_modes));
  PetscCall(PencilDestroy(&r->bodies));
  PetscCall(ChecksumDestroy(&r->scene));
  r->begin = 0;
  PetscFunctionReturn(0);
}

PetscErrorCode ReducedDestroy(ReducedRun *reduced)
{
  ReducedRun r = *reduced;

  PetscFunctionBeginUser;
  if (!r) PetscFunctionReturn(0);
  PetscCall(ReducedStepperDestroy(&r->stepper));
  PetscCall(ReducedForget(r));
  PetscCall(PetscFree(r->p));
  PetscCall(PetscFree(r->closed));
  PetscCall(PetscFree(r->lambda_n));
  PetscCall(PetscFree(r->compared));
  PetscCall(PetscFree(r->growing));
  PetscCall(PetscFree(r->force));
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
static PetscErrorCode ReducedReduceOther(ReducedRun r, PetscReal cutoff, const PetscReal p[], ReducedRun like,
                                         ReducedRun *other)
{
  PetscFunctionBeginUser;
  PetscCall(ReducedCreate(r->comm, other));
  (*other)->dynamics   = r->dynamics;
  (*other)->mesh_modes = r->mesh_modes;
  (*other)->run        = r->run;
  (*other)->cutoff     = cutoff > 0 ? cutoff : r->cutoff;
  (*other)->dt         = r->dt;
  (*other)->like       = like;
  (*other)->weighs     = r->weighs;
  if (p) PetscCall(OperatorsCreatePoint(r->run.operators, p, &(*other)->p));
  PetscCall(ReducedReduce(*other));
  PetscCall(ShiftInvertDestroy(&(*other)->inverse));
  PetscFunctionReturn(0);
}

PetscErrorCode ReducedReduceAt(ReducedRun r, PetscReal cutoff, const PetscReal p[], ReducedRun *at)
{
  PetscFunctionBeginUser;
  PetscCall(ReducedReduceOther(r, cutoff, p, NULL, at));
  PetscFunctionReturn(0);
}

PetscErrorCode ReducedReduceLike(ReducedRun r, PetscReal cutoff, const PetscReal p[], ReducedRun *at)
{
  PetscFunctionBeginUser;
  PetscCall(ReducedReduceOther(r, cutoff, p, r, at));
  PetscFunctionReturn(0);
}
