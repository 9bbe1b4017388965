/*
   Laws of materials in a pencil, whose stiffness depends on the eigenvalue: at its point h(lambda) A beyond K and C,
   zero at its reference frequency; see pencil.h and terms/law.c.
*/
#include "pencilimpl.h"

#define LAW_SAME 1e-9 /* relative: frequencies that are one */

PetscErrorCode OperatorsAddLaw(Operators o, const char owner[], const Viscoelastic *values,
                               const Quantity *(*row)(const char option[]), PetscInt young, Mat A)
{
  OperatorsLaw *law;
  PetscReal     limit[2];
  const char   *option;
  char          name[32];

  PetscFunctionBeginUser;
  PetscCall(PetscRealloc((size_t)(o->n_laws + 1) * sizeof(*o->law), &o->law));
  PetscCall(PetscNew(&law));
  o->law[o->n_laws++] = law;
  *law                = (OperatorsLaw){.law = *values, .young = young};
  for (PetscInt i = 0; i < values->n; i++) {
    PetscCall(ViscoelasticName(values, i, &option, name));
    PetscCall(ParametersAdd(
      &o->parameters, owner, name,
      &(OperatorsParameter){.row = row(option), .value = values->value[i], .damps = PETSC_TRUE, .law = PETSC_TRUE},
      &law->parameter[i]));
    if (values->kind != VISCOELASTIC_TABLE) continue;
    ViscoelasticLimits(values, limit);
    o->parameters.list[law->parameter[i]].lower  = limit[0];
    o->parameters.list[law->parameter[i]].upper  = limit[1];
    o->parameters.list[law->parameter[i]].closed = PETSC_TRUE;
  }
  for (int k = 0; k < 2 && A; k++) {
    PetscCall(TermsAdd(&o->terms, k ? OPERATORS_DAMPING : OPERATORS_STIFFNESS, A, PETSC_TRUE, 0, NULL));
    o->terms.term[o->terms.n - 1].law = law;
    PetscCall(ViscoelasticName(values, -1, &option, name));
    PetscCall(TermsSetCause(&o->terms, "material damping", owner, option));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode OperatorsDestroyLaws(Operators o)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < o->n_laws; i++) PetscCall(PetscFree(o->law[i]));
  PetscCall(PetscFree(o->law));
  PetscFunctionReturn(0);
}

PetscComplex PencilLawAt(const PencilLaw *law, PetscComplex lambda, PetscComplex *slope)
{
  const PetscReal    w = law->reference, viscous = w > 0 ? cimag(law->at) / w : 0;
  const PetscComplex scale = law->scale * CMPLX(1, law->detour);
  ViscoelasticAt     at;

  ViscoelasticEvaluate(&law->law, lambda, &at);
  if (slope) *slope = scale * (at.slope - viscous);
  return scale * (at.modulus - creal(law->at) - lambda * viscous);
}

PetscBool OperatorsHaveLaws(Operators o)
{
  return o->n_laws ? PETSC_TRUE : PETSC_FALSE;
}

PetscBool PencilHasLaws(Pencil pencil)
{
  return pencil->operators->n_laws && !pencil->real ? PETSC_TRUE : PETSC_FALSE;
}

PetscErrorCode PencilCheckRange(Pencil pencil, const char option[], const PetscReal range[2])
{
  const Operators o    = pencil->operators;
  const PetscReal turn = 2 * PETSC_PI;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < o->n_laws; i++) {
    const Viscoelastic law = OperatorsLawValues(o->law[i], pencil->parameters.p);
    PetscReal          known[2];

    ViscoelasticRange(&law, known);
    PetscCheck(range[0] >= known[0] * (1 - LAW_SAME) && range[1] <= known[1] * (1 + LAW_SAME), pencil->comm,
               PETSC_ERR_USER_INPUT,
               "%s asks for %.6g to %.6g Hz, a -..._table tells the modulus from %.6g to %.6g Hz: a table is not "
               "continued beyond its ends; extend it, or ask for less",
               option, (double)(range[0] / turn), (double)(range[1] / turn), (double)(known[0] / turn),
               (double)(known[1] / turn));
  }
  PetscFunctionReturn(0);
}

PetscReal PencilGetReference(Pencil pencil)
{
  return pencil->reference;
}

void PencilDropLoss(Pencil pencil)
{
  pencil->real = PETSC_TRUE;
  for (PetscInt t = 0; t < pencil->base.n; t++)
    if (pencil->base.term[t].law && pencil->base.term[t].kind == OPERATORS_DAMPING) pencil->base.term[t].scale = 0;
}

PetscErrorCode PencilSetReference(Pencil pencil, PetscReal omega)
{
  Terms *const list[] = {&pencil->base, &pencil->projected};

  PetscFunctionBeginUser;
  if (!pencil->operators->n_laws || omega == pencil->reference) PetscFunctionReturn(0);
  PetscCheck(!pencil->released, pencil->comm, PETSC_ERR_ARG_WRONGSTATE, "the terms of this pencil were released");
  PetscCall(PencilProjectTerms(pencil));
  for (int k = 0; k < 2; k++)
    for (PetscInt t = 0; t < list[k]->n; t++) list[k]->term[t].reference = omega;
  pencil->reference = omega;
  for (int i = 0; i < N_PENCIL_SUMS; i++) pencil->sum[i].current = PETSC_FALSE;
  pencil->has_factors = PETSC_FALSE;
  pencil->has_laws    = PETSC_FALSE;
  PetscFunctionReturn(0);
}

/* The law of a term at a point, in place: who has got it before looks on at it */
static PetscErrorCode LawTake(const PetscReal p[], const OperatorsTerm *term, PencilLaw *law)
{
  OperatorsTerm  rest = *term;
  ViscoelasticAt at;

  PetscFunctionBeginUser;
  rest.law       = NULL;
  law->symmetric = term->symmetric;
  law->scale     = OperatorsTermCoefficient(&rest, p);
  law->reference = term->reference;
  law->law       = OperatorsLawValues(term->law, p);
  law->at        = 0;
  ViscoelasticEvaluate(&law->law, CMPLX(0, term->reference), &at);
  if (term->reference > 0) law->at = at.modulus;
  if (law->A) PetscFunctionReturn(0);
  PetscCall(PetscObjectReference((PetscObject)term->A));
  law->A = term->A;
  PetscFunctionReturn(0);
}

/* Whether a term, one of two, stands for a law */
static PetscBool TermIsLaw(const OperatorsTerm *term)
{
  return term->law && term->kind == OPERATORS_STIFFNESS ? PETSC_TRUE : PETSC_FALSE;
}

PetscErrorCode OperatorsGetLaws(Operators o, const PetscReal p[], PetscInt *n, PencilLaw **law)
{
  PetscFunctionBeginUser;
  *n = 0;
  PetscCall(PetscCalloc1(o->n_laws, law));
  for (PetscInt t = 0; t < o->terms.n; t++)
    if (TermIsLaw(&o->terms.term[t])) PetscCall(LawTake(OperatorsPoint(o, p), &o->terms.term[t], &(*law)[(*n)++]));
  PetscFunctionReturn(0);
}

PetscErrorCode PencilFormLaws(Pencil pencil)
{
  const Terms *list = pencil->Zr ? &pencil->projected : &pencil->base;
  PetscInt     n    = 0;

  PetscFunctionBeginUser;
  if (!PencilHasLaws(pencil) || pencil->released || pencil->has_laws) PetscFunctionReturn(0);
  PetscCall(PencilProjectTerms(pencil));
  for (PetscInt t = 0; t < list->n; t++) n += TermIsLaw(&list->term[t]);
  if (!pencil->law) PetscCall(PetscCalloc1(n, &pencil->law));
  pencil->n_laws = n;
  for (PetscInt t = 0, l = 0; t < list->n; t++)
    if (TermIsLaw(&list->term[t])) PetscCall(LawTake(pencil->parameters.p, &list->term[t], &pencil->law[l++]));
  pencil->has_laws = PETSC_TRUE;
  PetscFunctionReturn(0);
}

PetscErrorCode PencilFoldLaw(Pencil pencil, OperatorsTerm *term)
{
  OperatorsLaw *law;

  PetscFunctionBeginUser;
  if (!term->law) PetscFunctionReturn(0);
  PetscCall(PetscRealloc((size_t)(pencil->n_folded + 1) * sizeof(*pencil->folded), &pencil->folded));
  PetscCall(PetscNew(&law));
  pencil->folded[pencil->n_folded++] = law;
  *law = (OperatorsLaw){.law = OperatorsLawValues(term->law, pencil->parameters.p), .young = -1};
  for (PetscInt i = 0; i < VISCOELASTIC_PARAMETERS; i++) law->parameter[i] = -1;
  term->law = law;
  PetscFunctionReturn(0);
}

PetscErrorCode PencilUnfoldLaws(Pencil pencil)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < pencil->n_folded; i++) PetscCall(PetscFree(pencil->folded[i]));
  PetscCall(PetscFree(pencil->folded));
  pencil->n_folded = 0;
  PetscFunctionReturn(0);
}

PetscErrorCode PencilForgetLaws(Pencil pencil)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < pencil->n_laws; i++) PetscCall(MatDestroy(&pencil->law[i].A));
  PetscCall(PetscFree(pencil->law));
  pencil->n_laws = 0;
  PetscFunctionReturn(0);
}
