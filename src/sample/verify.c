/*
   Points beside full solutions: spread evenly over them, each with its own equilibrium on the mesh, its own pencil
   about it, and the eigensolver. Nothing of the basis is used but what is compared.
*/
#include "sampleimpl.h"
#include <petsctime.h>

/* The pencil about the sliding state at p, found anew; whether its status is that of point i */
static PetscErrorCode SampleLinearise(Sample s, PetscInt i, const PetscReal p[], Pencil *pencil, SampleCheck *check)
{
  SlidingState state;
  PetscBool   *closed;
  PetscInt     status;

  PetscFunctionBeginUser;
  PetscCall(StaticsSolveSliding(s->box.statics, p, &state));
  PetscCall(StaticsRelease(s->box.statics));
  PetscCall(PetscMalloc1(state.n_pairs, &closed));
  for (PetscInt k = 0; k < state.n_pairs; k++) closed[k] = state.group[k] >= 0 ? PETSC_TRUE : PETSC_FALSE;
  PetscCall(StatusListAdd(&s->box.statuses, closed, &status));
  check->n_closed    = s->box.statuses.n_closed[status];
  check->same_status = status == s->box.status[i] ? PETSC_TRUE : PETSC_FALSE;
  PetscCall(OperatorsLinearise(s->box.operators, &state, pencil));
  PetscCall(SlidingStateDestroy(&state));
  PetscCall(PetscFree(closed));
  PetscFunctionReturn(0);
}

/* One point by the eigensolver. The basis may have seen it: of thousands it has seen few */
static PetscErrorCode SampleCompare(Sample s, PetscInt i, SampleCheck *check)
{
  ReducedModes modes;
  const Mode  *full;
  Pencil       pencil = s->box.pencil;
  PetscReal   *p;
  PetscInt    *branch, n;

  PetscFunctionBeginUser;
  check->same_status = PETSC_TRUE;
  check->n_closed    = -1;
  PetscCall(PetscMalloc1(s->box.n_parameters, &p));
  PetscCall(SampleParameters(s, i, p));
  PetscCall(SampleModesAt(s, p, &modes, &branch));
  if (s->box.statics)
    PetscCall(SampleLinearise(s, i, p, &pencil, check));
  else
    PetscCall(PencilSetParameters(pencil, p));
  PetscCall(ModesSetPencil(s->box.modes, pencil));
  PetscCall(ModesSolve(s->box.modes));
  PetscCall(ModesGet(s->box.modes, &n, &full));
  FullCompare(&s->box.window, &s->box.limit, n, full, &modes, &check->found);
  check->found.estimate = ReducedModesWorst(&modes, &s->box.window, PETSC_TRUE);
  PetscCall(ModesSetPencil(s->box.modes, s->box.pencil));
  if (s->box.statics) PetscCall(PencilDestroy(&pencil));
  PetscCall(PetscFree(branch));
  PetscCall(ReducedModesDestroy(&modes));
  PetscCall(PetscFree(p));
  PetscFunctionReturn(0);
}

/* What was solved for the samples is counted without what is solved again here */
PetscErrorCode SampleVerify(Sample s)
{
  const PetscInt n_large = s->n_large, n_divided = s->n_divided;
  PetscLogDouble begun, ended;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(s->n_verify, &s->check));
  PetscCall(PetscTime(&begun));
  for (PetscInt k = 0; k < s->n_verify; k++) PetscCall(SampleCompare(s, SampleVerified(s, k), &s->check[k]));
  PetscCall(PetscTime(&ended));
  s->seconds[1] = ended - begun;
  s->n_large    = n_large;
  s->n_divided  = n_divided;
  PetscFunctionReturn(0);
}

PetscInt SampleVerified(Sample s, PetscInt k)
{
  return (PetscInt)(((PetscReal)k + 0.5) * (PetscReal)s->n / (PetscReal)s->n_verify);
}
