/*
   Pencil: life cycle, point, access. What is handed out is a sum of terms at the present point, formed when asked
   for:

      lambda^2 M + lambda C + K,   K = K_even + sum_i mu_i (...),   in q where u = Z_r q

   K in N/m, C in N s/m, M in kg. A matrix that was handed out is valid until PencilSetParameters(). Terms are shared
   with the operators by reference.
*/
#include "pencilimpl.h"

/* state NULL: all pairs closed, with the forces of the options. Terms of bodies and spin first, those of the
   contact behind, which group them by closed_g; null spaces last, as they need all pairs. */
PetscErrorCode OperatorsLinearise(Operators operators, const SlidingState *state, Pencil *pencil)
{
  Pencil s;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(1, &s));
  *pencil          = s;
  s->comm          = operators->comm;
  s->operators     = operators;
  s->mass_singular = operators->mass_singular;
  PetscCall(PencilTakeState(s, state));
  PetscCall(PencilCheckSliding(s));
  PetscCall(OperatorsNeedSpin(operators));
  PetscCall(TermsAppend(&s->base, &operators->terms));
  PetscCall(TermsAppend(&s->base, &operators->spin));
  if (operators->model) PetscCall(PencilAddContact(s));
  if (state && state->geometric)
    PetscCall(TermsAdd(&s->base, OPERATORS_STIFFNESS, state->geometric, PETSC_TRUE, 0, NULL));
  if (state && state->follower) {
    PetscCall(TermsAdd(&s->base, OPERATORS_STIFFNESS, state->follower, PETSC_FALSE, 0, NULL));
    PetscCall(TermsSetCause(&s->base, "follower force", NULL, "static_follower"));
  }
  if (operators->model) PetscCall(PencilCreateNullSpaces(s));
  if (operators->model)
    PetscCall(PencilTakeDependents(s));
  else
    PetscCall(PencilScaleMultipliers(s));
  PetscFunctionReturn(0);
}

PetscErrorCode PencilGetParameters(Pencil pencil, PetscInt *n, const OperatorsParameter **parameters,
                                   const PetscReal **p)
{
  PetscFunctionBeginUser;
  if (n) *n = pencil->parameters.n;
  if (parameters) *parameters = pencil->parameters.list;
  if (p) *p = pencil->parameters.p;
  PetscFunctionReturn(0);
}

/* Raises the error for terms that are gone */
static PetscErrorCode PencilCheckTerms(Pencil pencil)
{
  PetscFunctionBeginUser;
  PetscCheck(!pencil->released, pencil->comm, PETSC_ERR_ARG_WRONGSTATE,
             "the terms of this pencil were released: it stays at its point");
  PetscFunctionReturn(0);
}

/* Nothing is formed here. Where p is the present point bitwise, sums and factors stay. */
PetscErrorCode PencilSetParameters(Pencil pencil, const PetscReal p[])
{
  const PetscInt n = pencil->parameters.n;
  PetscBool      same;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < n; i++) PetscCall(ParameterCheck(pencil->comm, &pencil->parameters.list[i], p[i]));
  PetscCall(PetscArraycmp(pencil->parameters.p, p, n, &same));
  if (same) PetscFunctionReturn(0);
  PetscCall(OperatorsCheckFriction(pencil->operators, p));
  PetscCall(PencilCheckPressure(pencil, p));
  PetscCall(PencilCheckTerms(pencil));
  PetscCall(PetscArraycpy(pencil->parameters.p, p, n));
  for (int i = 0; i < N_PENCIL_SUMS; i++) pencil->sum[i].current = PETSC_FALSE;
  pencil->has_factors = PETSC_FALSE;
  pencil->has_laws    = PETSC_FALSE;
  PetscFunctionReturn(0);
}

PetscErrorCode PencilGetTerms(Pencil pencil, PetscInt *n, const OperatorsTerm **terms)
{
  const Terms *list = pencil->Zr ? &pencil->projected : &pencil->base;

  PetscFunctionBeginUser;
  PetscCall(PencilCheckTerms(pencil));
  PetscCall(PencilProjectTerms(pencil));
  *n     = list->n;
  *terms = list->term;
  PetscFunctionReturn(0);
}

/* Memory: a term of stiffness is as large as K. What stays is the sums at the present point, to which the pencil is
   bound then (PencilCheckTerms()). */
PetscErrorCode PencilReleaseTerms(Pencil pencil)
{
  Operators      o = pencil->operators;
  PencilMatrices m;
  PencilParts    parts;

  PetscFunctionBeginUser;
  if (!o->model || pencil->released) PetscFunctionReturn(0);
  PetscCall(OperatorsReleaseBodies(o));
  PetscCall(PencilGetMatrices(pencil, &m));
  PetscCall(PencilGetFrictionless(pencil, &m));
  PetscCall(PencilGetParts(pencil, &parts));
  PetscCall(PencilFormCauses(pencil));
  PetscCall(PencilFormLaws(pencil));
  PetscCall(TermsRelease(&pencil->base));
  PetscCall(TermsRelease(&pencil->projected));
  PetscCall(TermsRelease(&o->terms));
  PetscCall(TermsRelease(&o->spin));
  pencil->released = PETSC_TRUE;
  PetscFunctionReturn(0);
}

PetscErrorCode PencilGetOperators(Pencil pencil, Operators *operators)
{
  PetscFunctionBeginUser;
  *operators = pencil->operators;
  PetscFunctionReturn(0);
}

PetscErrorCode PencilView(Pencil pencil, PetscViewer viewer)
{
  PencilMatrices m;
  PetscInt       n, n_pencil;
  PetscBool      spinning;
  Mat            M;
  MatInfo        info;

  PetscFunctionBeginUser;
  PetscCall(PencilGetMatrices(pencil, &m));
  PetscCall(PencilGetMass(pencil, &M));
  PetscCall(MatGetSize(M, &n, NULL));
  PetscCall(MatGetSize(m.K, &n_pencil, NULL));
  PetscCall(MatGetInfo(m.K, MAT_GLOBAL_SUM, &info));
  spinning =
    TermsVanish(&pencil->operators->spin, TERMS_ALL, PETSC_FALSE, pencil->parameters.p) ? PETSC_FALSE : PETSC_TRUE;
  PetscCall(PetscViewerASCIIPrintf(viewer, "operators: %" PetscInt_FMT " unknowns, %.0f nonzeros, %s, %s, %s mass\n",
                                   n_pencil, (double)info.nz_used,
                                   pencil->operators->n_named ? (m.symmetric ? "symmetric" : "unsymmetric")
                                   : m.symmetric              ? "no friction: symmetric"
                                   : spinning                 ? "spin or friction: unsymmetric"
                                                              : "friction: unsymmetric",
                                   m.n_laws ? "stiffness of the frequency: nonlinear problem"
                                   : m.C    ? "damped: quadratic problem"
                                            : "undamped",
                                   pencil->operators->lump ? "lumped" : "consistent"));
  if (n_pencil < n)
    PetscCall(PetscViewerASCIIPrintf(viewer, "  %" PetscInt_FMT " unknowns eliminated by constraints\n", n - n_pencil));
  PetscFunctionReturn(0);
}

PetscErrorCode PencilDestroy(Pencil *pencil)
{
  Pencil s = *pencil;

  PetscFunctionBeginUser;
  if (!s) PetscFunctionReturn(0);
  for (int i = 0; i < N_PENCIL_SUMS; i++) PetscCall(TermsSumDestroy(&s->sum[i]));
  PetscCall(TermsSumDestroy(&s->joining));
  for (int i = 0; i < 2; i++) PetscCall(MatDestroy(&s->factor[i]));
  PetscCall(MatDestroy(&s->half));
  PetscCall(PencilDestroyNullSpaces(s));
  PetscCall(TermsDestroy(&s->base));
  PetscCall(TermsDestroy(&s->causing));
  PetscCall(PetscFree(s->cause));
  PetscCall(PencilForgetLaws(s));
  PetscCall(PencilUnfoldLaws(s));
  PetscCall(ParametersDestroy(&s->parameters));
  PetscCall(PetscFree(s->group));
  PetscCall(PetscFree(s->slips));
  PetscCall(PetscFree(s->force));
  PetscCall(PetscFree(s->total));
  PetscCall(PetscFree(*pencil));
  PetscFunctionReturn(0);
}
