/*
   What rounding in the matrices of the mesh does to an eigenvalue kappa: eps sqrt(x^H E x y^H E y) / |y^T D x|, where

      E = sum over stiffness terms of |c_t| V' |diag A_t| V

   is the energy without the cancellation between neighbouring nodes. The dense matrices inherit it from the sparse
   ones.
*/
#include "reduced.h"
#include "base/algebra/dense.h"

/* E [n_v][n_v] in the unit of the reduced stiffness, (rad/s)^2. Terms whose D is NULL have no more rounding than
   the dense matrices. */
void RoundingEnergy(const Reduced *reduced, const PetscReal p[], PetscReal E[])
{
  const PetscInt n_v = reduced->n_used;

  for (PetscInt i = 0; i < n_v * n_v; i++) E[i] = 0;
  for (PetscInt t = 0; t < reduced->n_terms && reduced->D; t++) {
    const PetscReal c = PetscAbsReal(OperatorsTermCoefficient(&reduced->term[t], p));

    for (PetscInt j = 0; j < n_v && reduced->D[t] && c > 0; j++)
      for (PetscInt i = 0; i < n_v; i++) E[j * n_v + i] += c * reduced->D[t][j * n_v + i];
  }
}

/* product [m] = eps sqrt(x^H E x) sqrt(y^H E y), which over |y^T D x| is the change of kappa. A sum that rounding
   made negative counts as zero. */
PetscErrorCode RoundingProducts(PetscInt n, const PetscReal E[], PetscInt m, const PetscComplex X[],
                                const PetscComplex Y[], PetscReal product[])
{
  PetscReal *left;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(m, &left));
  PetscCall(DenseEnergies(n, E, m, X, product));
  PetscCall(DenseEnergies(n, E, m, Y, left));
  for (PetscInt i = 0; i < m; i++)
    product[i] = PETSC_MACHINE_EPSILON * PetscSqrtReal(PetscMax(product[i], 0)) * PetscSqrtReal(PetscMax(left[i], 0));
  PetscCall(PetscFree(left));
  PetscFunctionReturn(0);
}

/* Marks modes of an undamped system that are zero: |lambda|^2 |y^T M x| <= ROUNDING_RIGID noise. Modes are sorted
   by frequency, so that it ends at the first whose frequency is not small; E is formed only if there are such. */
PetscErrorCode RoundingMarkRigid(const Reduced *reduced, const PetscReal p[], const ReducedWindow *window,
                                 ReducedModes *modes)
{
  const PetscInt  n     = modes->size;
  const PetscReal small = ROUNDING_SMALL * window->high; /* rad/s */
  PetscReal      *E     = NULL, noise;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < modes->n && PetscAbsReal(cimag(modes->lambda[i])) < small; i++) {
    if (cabs(modes->lambda[i]) >= small) continue; /* it diverges, or decays without a frequency */
    if (!E) {
      PetscCall(PetscMalloc1(n * n, &E));
      RoundingEnergy(reduced, p, E);
    }
    PetscCall(RoundingProducts(n, E, 1, modes->x + i * n, modes->y + i * n, &noise));
    if (PetscSqr(cabs(modes->lambda[i])) * cabs(modes->product[i]) > ROUNDING_RIGID * noise) continue;
    modes->lambda[i] = 0;
    modes->rigid[i]  = PETSC_TRUE;
  }
  PetscCall(PetscFree(E));
  PetscFunctionReturn(0);
}
