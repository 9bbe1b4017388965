/*
   What rounding in the matrices of the mesh does to an eigenvalue kappa: eps sqrt(x^H E x y^H E y) / |y^T D x|, where

      E = sum over stiffness terms of |c_t| V' |diag A_t| V

   is the energy without the cancellation between neighbouring nodes. The dense matrices inherit it from the sparse
   ones.
*/
#include "reduced.h"

void RoundingEnergy(const Reduced *reduced, const PetscReal p[], PetscReal E[])
{
  const PetscInt n = reduced->n, n_v = reduced->n_used;

  for (PetscInt i = 0; i < n_v * n_v; i++) E[i] = 0;
  for (PetscInt t = 0; t < reduced->n_terms && reduced->D; t++) {
    const PetscReal c = PetscAbsReal(OperatorsTermCoefficient(&reduced->term[t], p));

    for (PetscInt j = 0; j < n_v && reduced->D[t] && c > 0; j++)
      for (PetscInt i = 0; i < n_v; i++) E[j * n_v + i] += c * reduced->D[t][j * n + i];
  }
}

/* x^H E x with real symmetric E [n * n]; work [n] */
static PetscReal Energy(PetscInt n, const PetscReal E[], const PetscComplex x[], PetscComplex work[])
{
  PetscReal sum = 0;

  for (PetscInt j = 0; j < n; j++) {
    work[j] = 0;
    for (PetscInt i = 0; i < n; i++) work[j] += E[j * n + i] * x[i];
    sum += creal(conj(x[j]) * work[j]);
  }
  return PetscMax(sum, 0);
}

PetscReal RoundingProduct(PetscInt n, const PetscReal E[], const PetscComplex x[], const PetscComplex y[],
                          PetscComplex work[])
{
  return PETSC_MACHINE_EPSILON * PetscSqrtReal(Energy(n, E, x, work)) * PetscSqrtReal(Energy(n, E, y, work));
}

PetscErrorCode RoundingMarkRigid(const Reduced *reduced, const PetscReal p[], const ReducedWindow *window,
                                 ReducedModes *modes)
{
  const PetscInt n = modes->size;
  PetscReal     *E = NULL;
  PetscComplex  *work;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < modes->n && cabs(modes->lambda[i]) < ROUNDING_SMALL * window->high; i++) {
    if (!E) {
      PetscCall(PetscMalloc2(n * n, &E, n, &work));
      RoundingEnergy(reduced, p, E);
    }
    if (PetscSqr(cabs(modes->lambda[i])) * cabs(modes->product[i]) >
        ROUNDING_RIGID * RoundingProduct(n, E, modes->x + i * n, modes->y + i * n, work))
      continue;
    modes->lambda[i] = 0;
    modes->rigid[i]  = PETSC_TRUE;
  }
  if (E) PetscCall(PetscFree2(E, work));
  PetscFunctionReturn(0);
}
