/*
   Laws of materials in a pencil, whose stiffness depends on the eigenvalue: at its point h(lambda) A beyond K and C,
   zero at its reference frequency; see pencil.h and terms/law.c.
*/
#include "pencilimpl.h"

#define LAW_SAME 1e-9 /* relative: frequencies that are one */

PetscErrorCode OperatorsAddLaw(Operators o, const char owner[], const Viscoelastic *values,
                               const Quantity *(*row)(const char option[]), PetscInt young, OperatorsLaw **added)
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
  *added              = law;
  for (PetscInt i = 0; i < values->n; i++) {
    PetscCall(ViscoelasticName(values, i, &option, name));
    PetscCall(ParametersAdd(
      &o->parameters, owner, name,
      &(OperatorsParameter){.row = row(option), .value = values->value[i], .damps = PETSC_TRUE, .law = PETSC_TRUE},
      &law->parameter[i]));
    ViscoelasticLimits(values, limit);
    if (PetscIsInfReal(limit[1])) continue;
    o->parameters.list[law->parameter[i]].lower  = limit[0];
    o->parameters.list[law->parameter[i]].upper  = limit[1];
    o->parameters.list[law->parameter[i]].closed = PETSC_TRUE;
  }
  PetscFunctionReturn(0);
}

PetscErrorCode OperatorsAddLawTerms(Operators o, const char owner[], OperatorsLaw *law, const OperatorsTerm *like)
{
  const char *option;
  char        name[32];

  PetscFunctionBeginUser;
  PetscCall(ViscoelasticName(&law->law, -1, &option, name));
  for (int k = 0; k < 2; k++) {
    OperatorsTerm *term;

    PetscCall(TermsAdd(&o->terms, k ? OPERATORS_DAMPING : OPERATORS_STIFFNESS, like->A, like->symmetric, 0, NULL));
    PetscCall(TermsSetCause(&o->terms, "material damping", owner, option));
    term             = &o->terms.term[o->terms.n - 1];
    term->law        = law;
    term->scale      = like->scale;
    term->n          = like->n;
    term->frictional = like->frictional;
    PetscCall(PetscArraycpy(term->factor, like->factor, like->n));
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
  const PetscReal w = law->reference, viscous = w > 0 ? cimag(law->at) / w : 0;
  ViscoelasticAt  at, held;

  ViscoelasticEvaluate(&law->law, lambda, &at);
  if (law->held != 0) {
    ViscoelasticEvaluate(&law->law, CMPLX(0, w), &held);
    at.modulus += law->held * (held.modulus - at.modulus);
    at.slope *= 1 - law->held;
  }
  if (slope) *slope = law->scale * (at.slope - viscous);
  return law->scale * (at.modulus - creal(law->at) - lambda * viscous);
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
    for (PetscInt t = 0; t < list[k]->n; t++) {
      list[k]->term[t].reference = omega;
      list[k]->term[t].stiffened = pencil->real ? PETSC_FALSE : PETSC_TRUE;
    }
  pencil->reference = omega;
  for (int i = 0; i < N_PENCIL_SUMS; i++) pencil->sum[i].current = PETSC_FALSE;
  pencil->has_factors = PETSC_FALSE;
  pencil->has_laws    = PETSC_FALSE;
  PetscFunctionReturn(0);
}

/* Whether a term, one of two, stands for a law; whether two, of which one does, are of one law: those of a layer, whose
   matrices have factors of their own */
static PetscBool TermIsLaw(const OperatorsTerm *term)
{
  return term->law && term->kind == OPERATORS_STIFFNESS ? PETSC_TRUE : PETSC_FALSE;
}

static PetscBool TermsAreOneLaw(const OperatorsTerm *a, const OperatorsTerm *b)
{
  return TermIsLaw(b) && a->law == b->law && a->constraint == b->constraint ? PETSC_TRUE : PETSC_FALSE;
}

/* The first terms of all laws; first may be NULL */
static PetscInt LawsFind(const Terms *list, PetscInt first[])
{
  PetscInt n = 0;

  for (PetscInt t = 0; t < list->n; t++) {
    PetscInt s = 0;

    if (!TermIsLaw(&list->term[t])) continue;
    while (!TermsAreOneLaw(&list->term[t], &list->term[s])) s++;
    if (s < t) continue;
    if (first) first[n] = t;
    n++;
  }
  return n;
}

/* Its matrix: that of its only term, or the sum of all at the point, which is written anew in place */
static PetscErrorCode LawTakeMatrix(const Terms *list, PetscInt first, const PetscReal p[], TermsSum *sum,
                                    PencilLaw *law)
{
  PetscReal *c;
  PetscInt   n = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(list->n, &c));
  for (PetscInt t = first; t < list->n; t++) {
    OperatorsTerm rest = list->term[t];

    if (!TermsAreOneLaw(&list->term[first], &rest)) continue;
    rest.law = NULL;
    c[t]     = OperatorsTermCoefficient(&rest, p);
    n++;
  }
  law->scale = n > 1 ? 1 : c[first];
  if (n > 1) PetscCall(TermsSumAdd(list, c, sum));
  PetscCall(PetscFree(c));
  if (law->A) PetscFunctionReturn(0);
  law->A = n > 1 ? sum->A : list->term[first].A;
  PetscCall(PetscObjectReference((PetscObject)law->A));
  PetscFunctionReturn(0);
}

/* The law of a term at a point, in place: who has got it before looks on at it */
static PetscErrorCode LawTake(const Terms *list, PetscInt first, const PetscReal p[], TermsSum *sum, PencilLaw *law)
{
  const OperatorsTerm *term = &list->term[first];

  PetscFunctionBeginUser;
  law->symmetric = term->symmetric;
  law->reference = term->reference;
  law->law       = OperatorsLawValues(term->law, p);
  law->at        = TermLawModulus(term, p);
  PetscCall(LawTakeMatrix(list, first, p, sum, law));
  PetscFunctionReturn(0);
}

PetscErrorCode OperatorsGetLaws(Operators o, const PetscReal p[], PetscInt *n, PencilLaw **law)
{
  PetscInt *first;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(o->n_laws, law));
  PetscCall(PetscMalloc1(o->n_laws, &first));
  *n = LawsFind(&o->terms, first);
  for (PetscInt l = 0; l < *n; l++) {
    TermsSum sum = {.A = NULL};

    PetscCall(LawTake(&o->terms, first[l], OperatorsPoint(o, p), &sum, &(*law)[l]));
    PetscCall(TermsSumDestroy(&sum));
  }
  PetscCall(PetscFree(first));
  PetscFunctionReturn(0);
}

PetscErrorCode PencilFormLaws(Pencil pencil)
{
  const Terms *list = pencil->Zr ? &pencil->projected : &pencil->base;
  PetscInt    *first;

  PetscFunctionBeginUser;
  if (!PencilHasLaws(pencil) || pencil->released || pencil->has_laws) PetscFunctionReturn(0);
  PetscCall(PencilProjectTerms(pencil));
  pencil->n_laws = LawsFind(list, NULL);
  PetscCall(PetscMalloc1(pencil->n_laws, &first));
  (void)LawsFind(list, first);
  if (!pencil->law) PetscCall(PetscCalloc1(pencil->n_laws, &pencil->law));
  if (!pencil->law_sum) PetscCall(PetscCalloc1(pencil->n_laws, &pencil->law_sum));
  for (PetscInt l = 0; l < pencil->n_laws; l++)
    PetscCall(LawTake(list, first[l], pencil->parameters.p, &pencil->law_sum[l], &pencil->law[l]));
  PetscCall(PetscFree(first));
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
  for (PetscInt i = 0; i < pencil->n_laws; i++) {
    PetscCall(MatDestroy(&pencil->law[i].A));
    PetscCall(TermsSumDestroy(&pencil->law_sum[i]));
  }
  PetscCall(PetscFree(pencil->law));
  PetscCall(PetscFree(pencil->law_sum));
  pencil->n_laws = 0;
  PetscFunctionReturn(0);
}
