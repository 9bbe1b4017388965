/*
   Points beside full solutions: spread evenly over them, each with its own equilibrium on the mesh, its own pencil
   about it, and the eigensolver. Nothing of the basis is used but what is compared.
*/
#include "sampleimpl.h"
#include <petsctime.h>
#include <time.h>

/* One point by the eigensolver. The basis may have seen it: of thousands it has seen few */
static PetscErrorCode SampleCompare(Sample s, PetscInt i, SampleCheck *check)
{
  ReducedModes modes;
  BoxFull      full;
  PetscReal   *p;
  PetscInt    *branch;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(s->box.n_parameters, &p));
  PetscCall(SampleParameters(s, i, p));
  PetscCall(SampleModesAt(s, p, &modes, &branch));
  PetscCall(BoxSolveFull(&s->box, p, &full));
  check->n_closed    = full.n_closed;
  check->same_status = !s->box.statics || full.status == s->box.status[i] ? PETSC_TRUE : PETSC_FALSE;
  FullCompare(&s->box.window, &s->box.limit, full.n, full.mode, &modes, &check->found);
  check->found.estimate = ReducedModesWorst(&modes, &s->box.window, PETSC_TRUE);
  PetscCall(PetscFree(branch));
  PetscCall(ReducedModesDestroy(&modes));
  PetscCall(PetscFree(p));
  PetscFunctionReturn(0);
}

PetscErrorCode SampleTimeTake(SampleTime *time)
{
  SampleTime now;

  PetscFunctionBeginUser;
  PetscCall(PetscTime(&now.wall));
  now.processor = (PetscLogDouble)clock() / (PetscLogDouble)CLOCKS_PER_SEC;
  *time = (SampleTime){now.wall - time->wall, now.processor - time->processor};
  PetscFunctionReturn(0);
}

/* What was solved for the samples is counted without what is solved again here */
PetscErrorCode SampleVerify(Sample s)
{
  const PetscInt n_large = s->n_large, n_divided = s->n_divided;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(s->n_verify, &s->check));
  PetscCall(SampleTimeTake(&s->took[1]));
  for (PetscInt k = 0; k < s->n_verify; k++) PetscCall(SampleCompare(s, SampleVerified(s, k), &s->check[k]));
  PetscCall(SampleTimeTake(&s->took[1]));
  s->n_large   = n_large;
  s->n_divided = n_divided;
  PetscFunctionReturn(0);
}

PetscInt SampleVerified(Sample s, PetscInt k)
{
  return (PetscInt)(((PetscReal)k + 0.5) * (PetscReal)s->n / (PetscReal)s->n_verify);
}
