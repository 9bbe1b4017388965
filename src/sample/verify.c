/* Samples beside full solutions at the same points, spread evenly over them */
#include "sampleimpl.h"

/* One sample by the eigensolver. The basis may have seen it: of thousands it has seen few */
static PetscErrorCode SampleCompare(Sample s, PetscInt i, FullCheck *check)
{
  ReducedModes modes;
  const Mode  *full;
  PetscReal   *p;
  PetscInt    *branch, n;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(s->box.n_parameters, &p));
  PetscCall(SampleParameters(s, i, p));
  PetscCall(SampleModesAt(s, p, &modes, &branch));
  PetscCall(PencilSetParameters(s->box.pencil, p));
  PetscCall(ModesSolve(s->box.modes));
  PetscCall(ModesGet(s->box.modes, &n, &full));
  FullCompare(&s->box.window, &s->box.limit, n, full, &modes, check);
  check->estimate = ReducedModesWorst(&modes, &s->box.window, PETSC_TRUE);
  PetscCall(PetscFree(branch));
  PetscCall(ReducedModesDestroy(&modes));
  PetscCall(PetscFree(p));
  PetscFunctionReturn(0);
}

/* What was solved for the samples is counted without what is solved again here */
PetscErrorCode SampleVerify(Sample s)
{
  const PetscInt n_large = s->n_large, n_divided = s->n_divided;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(s->n_verify, &s->check));
  for (PetscInt k = 0; k < s->n_verify; k++) PetscCall(SampleCompare(s, SampleVerified(s, k), &s->check[k]));
  s->n_large   = n_large;
  s->n_divided = n_divided;
  PetscFunctionReturn(0);
}

PetscInt SampleVerified(Sample s, PetscInt k)
{
  return (PetscInt)(((PetscReal)k + 0.5) * (PetscReal)s->n / (PetscReal)s->n_verify);
}
