/*
   What rounding in the matrices of the mesh does to an eigenvalue kappa: eps sqrt(x^H E x y^H E y) / |y^T D x|, where

      E = sum over stiffness terms of |c_t| V' |diag A_t| V

   is the energy without the cancellation between neighbouring nodes. The dense matrices inherit it from the sparse
   ones. Groups of pairs that open count as closed: there may be hundreds of them, each a
   term of its own, and one matrix serves all.
*/
#include "reduced.h"
#include "base/algebra/dense.h"

/* Whether a factor of a term is the parameter of pairs that open */
static PetscBool FactorIsInternal(const Reduced *reduced, const OperatorsTerm *term, PetscInt i)
{
  const PetscInt k = term->factor[i].parameter;

  return k >= 0 && reduced->parameter && reduced->parameter[k].internal ? PETSC_TRUE : PETSC_FALSE;
}

/* Whether two terms have the same coefficient where all pairs are closed */
static PetscBool TermsAgree(const Reduced *reduced, const OperatorsTerm *a, const OperatorsTerm *b)
{
  PetscInt i = 0, j = 0;

  if (a->kind != b->kind || a->scale != b->scale || a->law != b->law || a->reference != b->reference ||
      a->stiffened != b->stiffened)
    return PETSC_FALSE;
  for (;; i++, j++) {
    while (i < a->n && FactorIsInternal(reduced, a, i)) i++;
    while (j < b->n && FactorIsInternal(reduced, b, j)) j++;
    if (i == a->n || j == b->n) return i == a->n && j == b->n ? PETSC_TRUE : PETSC_FALSE;
    if (a->factor[i].parameter != b->factor[j].parameter || a->factor[i].power != b->factor[j].power ||
        a->factor[i].absolute != b->factor[j].absolute || a->factor[i].friction != b->factor[j].friction ||
        a->factor[i].slope != b->factor[j].slope)
      return PETSC_FALSE;
  }
}

PetscInt RoundingTerm(const Reduced *reduced, PetscInt t)
{
  PetscInt first = 0;

  while (!TermsAgree(reduced, &reduced->term[first], &reduced->term[t])) first++;
  return first;
}

/* E [n_v][n_v] in the unit of the reduced stiffness, (rad/s)^2. Terms whose D is NULL have no more rounding than
   the dense matrices, or are in that of another. */
PetscErrorCode RoundingEnergy(const Reduced *reduced, const PetscReal p[], PetscReal E[])
{
  const PetscInt n_v = reduced->n_used;
  PetscReal     *q;

  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(E, n_v * n_v));
  PetscCall(PetscMalloc1(reduced->n_parameters, &q));
  for (PetscInt k = 0; k < reduced->n_parameters; k++)
    q[k] = reduced->parameter && reduced->parameter[k].internal ? 1 : p[k];
  for (PetscInt t = 0; t < reduced->n_terms && reduced->D; t++) {
    const PetscReal c = reduced->D[t] ? PetscAbsReal(OperatorsTermCoefficient(&reduced->term[t], q)) : 0;

    for (PetscInt i = 0; i < n_v * n_v && c > 0; i++) E[i] += c * reduced->D[t][i];
  }
  PetscCall(PetscFree(q));
  PetscFunctionReturn(0);
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
      PetscCall(RoundingEnergy(reduced, p, E));
    }
    PetscCall(RoundingProducts(n, E, 1, modes->x + i * n, modes->y + i * n, &noise));
    if (PetscSqr(cabs(modes->lambda[i])) * cabs(modes->product[i]) > ROUNDING_RIGID * noise) continue;
    modes->lambda[i] = 0;
    modes->rigid[i]  = PETSC_TRUE;
  }
  PetscCall(PetscFree(E));
  PetscFunctionReturn(0);
}
