/*
   The small response with materials whose stiffness depends on the frequency (pencil.h): T(i omega) of each frequency
   is factorised, as no Schur form serves for two of them; n^3 operations each.
*/
#include "schur.h"

PetscErrorCode FrfLawsCreate(const ModesSpace *space, PetscBool rounded, const FrfEnds *ends, FrfLaws *s)
{
  const DensePencil whole = SubspacePencil(&space->space);
  const PetscReal  *E     = space->space.term[SPACE_E(space)].small;
  const PetscInt    n = whole.n, square = n * n;

  PetscFunctionBeginUser;
  s->pencil = whole;
  PetscCall(PetscMalloc5(square, &s->pencil.K, square, &s->pencil.C, square, &s->pencil.M, whole.n_laws, &s->law,
                         (1 + ends->n_outputs) * n, &s->b));
  PetscCall(PetscMalloc3(square, &s->T, n, &s->x, n, &s->pivot));
  for (PetscInt i = 0; i < square; i++) s->pencil.K[i] = whole.K[i] + (rounded ? E[i] : 0);
  if (whole.damped) PetscCall(PetscArraycpy(s->pencil.C, whole.C, square));
  PetscCall(PetscArraycpy(s->pencil.M, whole.M, square));
  for (PetscInt l = 0; l < whole.n_laws; l++) {
    s->law[l] = whole.law[l];
    PetscCall(PetscMalloc1(square, &s->law[l].A));
    PetscCall(PetscArraycpy(s->law[l].A, whole.law[l].A, square));
  }
  s->pencil.law = s->law;
  PetscCall(PetscArraycpy(s->b, ends->b, n));
  PetscCall(PetscArraycpy(s->b + n, ends->l, ends->n_outputs * n));
  PetscFunctionReturn(0);
}

PetscErrorCode FrfLawsRespond(const FrfLaws *s, PetscReal omega, PetscInt n_outputs, PetscReal re[], PetscReal im[],
                              PetscBool *singular)
{
  const PetscInt n = s->pencil.n;

  PetscFunctionBeginUser;
  DensePencilEvaluate(&s->pencil, CMPLX(0, omega), 0, n, s->T);
  PetscCall(DenseComplexFactor(n, s->T, s->pivot, singular));
  if (*singular) PetscFunctionReturn(0);
  for (PetscInt i = 0; i < n; i++) s->x[i] = s->b[i];
  PetscCall(DenseComplexSolve(n, s->T, s->pivot, PETSC_FALSE, 1, s->x));
  for (PetscInt p = 0; p < n_outputs; p++) {
    PetscComplex sum = 0;

    for (PetscInt i = 0; i < n; i++) sum += s->b[(1 + p) * n + i] * s->x[i];
    re[p] = creal(sum);
    im[p] = cimag(sum);
  }
  PetscFunctionReturn(0);
}

PetscErrorCode FrfLawsDestroy(FrfLaws *s)
{
  PetscFunctionBeginUser;
  for (PetscInt l = 0; l < s->pencil.n_laws; l++) PetscCall(PetscFree(s->law[l].A));
  PetscCall(PetscFree5(s->pencil.K, s->pencil.C, s->pencil.M, s->law, s->b));
  PetscCall(PetscFree3(s->T, s->x, s->pivot));
  s->pencil.n_laws = 0;
  PetscFunctionReturn(0);
}
