/*
   Derivatives of an eigenvalue by the parameters. Differentiate Q(lambda; p) x = 0 and multiply by y^T from the left:

      y^T Q'(lambda) x d lambda + sum_t dc_t lambda^k y^T A_t x = 0,   k = 0, 1, 2 for a term of K, C, M,
      d lambda / d p_j = -sum_t (dc_t / dp_j) lambda^k y^T A_t x / (2 lambda y^T D x),

   rad/s per unit of the parameter. A rigid mode stays at lambda = 0 as long as it is one: its derivative is zero. At a
   defective pair eigenvalues move as square roots, and the derivative is not finite.
*/
#include "reduced.h"
#include "base/algebra/dense.h"

/* d lambda / d c_t = -lambda^k y^T A_t x / (2 lambda y^T D x), rad/s per unit of the coefficient; one product with
   A_t for all parameters that are in it. */
static PetscErrorCode TermDerivative(const Reduced *reduced, PetscInt t, const ReducedModes *modes, PetscInt i,
                                     PetscComplex Ax[], PetscComplex *derivative)
{
  const PetscInt     n      = modes->size;
  const PetscComplex lambda = modes->lambda[i], *x = modes->x + i * n, *y = modes->y + i * n;
  const PetscComplex powers[] = {
    [OPERATORS_STIFFNESS] = 1, [OPERATORS_DAMPING] = lambda, [OPERATORS_MASS] = lambda * lambda};

  PetscFunctionBeginUser;
  PetscCall(DenseTimes(&(DenseBlock){reduced->A[t], n, n, reduced->n}, PETSC_FALSE, 1, x, Ax));
  *derivative = -powers[reduced->term[t].kind] * DenseDot(n, y, Ax) / (2 * lambda * modes->product[i]);
  PetscFunctionReturn(0);
}

PetscErrorCode ReducedSensitivity(const Reduced *reduced, const PetscReal p[], const ReducedModes *modes, PetscInt i,
                                  PetscComplex derivative[])
{
  PetscComplex *Ax;

  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(derivative, reduced->n_parameters));
  if (modes->rigid[i]) PetscFunctionReturn(0);
  PetscCall(PetscMalloc1(modes->size, &Ax));
  for (PetscInt t = 0; t < reduced->n_terms; t++) {
    const OperatorsTerm *term = &reduced->term[t];
    PetscComplex         by_coefficient;

    if (!term->n) continue;
    PetscCall(TermDerivative(reduced, t, modes, i, Ax, &by_coefficient));
    for (PetscInt j = 0; j < reduced->n_parameters; j++) {
      const PetscReal c = OperatorsTermDerivative(term, p, j);

      if (c != 0) derivative[j] += c * by_coefficient;
    }
  }
  PetscCall(PetscFree(Ax));
  PetscFunctionReturn(0);
}
