/*
   Whether the mass stays positive definite over the points: M(p) = sum_t c_t(p) A_t of given terms need not. On the
   mesh this is checked at the full solutions alone; here at every point, of V' M(p) V, which is all that the basis
   holds of it.
*/
#include "reduced.h"
#include "base/text.h"
#include <petscblaslapack.h>

/* Of sum_t |c_t| |v' A_t v|: less than that is rounding of the sum of the terms, n eps of some hundred vectors with
   a margin. */
#define MASS_LEAST 1e-12

/* Whether a mass term has this parameter in its coefficient; -1 for any: without one M(p) is that of the full
   solutions, checked there. */
static PetscBool MassDepends(const Reduced *reduced, PetscInt parameter)
{
  for (PetscInt t = 0; t < reduced->n_terms; t++) {
    const OperatorsTerm *term = &reduced->term[t];

    if (term->kind == OPERATORS_MASS && (parameter < 0 ? term->n > 0 : OperatorsTermDepends(term, parameter)))
      return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

/* sum_t |c_t| |v_i' A_t v_i| of vector i */
static PetscReal MassSize(const Reduced *reduced, const PetscReal p[], PetscInt i)
{
  PetscReal size = 0;

  for (PetscInt t = 0; t < reduced->n_terms; t++)
    if (reduced->term[t].kind == OPERATORS_MASS)
      size += PetscAbsReal(OperatorsTermCoefficient(&reduced->term[t], p) * reduced->A[t][i * (reduced->n + 1)]);
  return size;
}

static PetscErrorCode MassRefuse(const Reduced *reduced, const PetscReal p[])
{
  char text[256] = "", one[192];

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < reduced->n_parameters && reduced->parameter; k++) {
    if (!MassDepends(reduced, k)) continue;
    PetscCall(
      PetscSNPrintf(one, sizeof(one), "%s%s %.6g", text[0] ? ", " : " at ", reduced->parameter[k].name, (double)p[k]));
    PetscCall(WordsAdd(text, one, sizeof(text)));
  }
  SETERRQ(PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
          "the mass matrix has eigenvalues that are negative or zero%s: it must be positive definite at all points",
          text);
}

/* Cholesky factors of Ms - 1e-12 diag(sum_t |c_t| |v_i' A_t v_i|) exist exactly where that is positive definite;
   n^3 / 3 operations, few beside the eigenproblem. Not collective: one rank may fail alone, with the error of all. */
PetscErrorCode ReducedCheckMass(const Reduced *reduced, const PetscReal p[], const PetscReal Ms[])
{
  const PetscInt n = reduced->n_used;
  PetscBLASInt   size, info;
  PetscReal     *factor;

  PetscFunctionBeginUser;
  if (!n || !MassDepends(reduced, -1)) PetscFunctionReturn(0);
  PetscCall(PetscMalloc1(n * n, &factor));
  PetscCall(PetscArraycpy(factor, Ms, n * n));
  for (PetscInt i = 0; i < n; i++) factor[i * (n + 1)] -= MASS_LEAST * MassSize(reduced, p, i);
  PetscCall(PetscBLASIntCast(n, &size));
  LAPACKpotrf_("L", &size, factor, &size, &info);
  PetscCall(PetscFree(factor));
  PetscCheck(info >= 0, PETSC_COMM_SELF, PETSC_ERR_LIB, "LAPACK's potrf failed with info %d", (int)info);
  if (info) PetscCall(MassRefuse(reduced, p));
  PetscFunctionReturn(0);
}
