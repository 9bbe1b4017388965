/*
   Pencil: life cycle, point, access. What is handed out is a sum of terms at the present point, formed when asked for.
*/
#include "pencilimpl.h"

PetscErrorCode OperatorsLinearise(Operators operators, const SlidingState *state, Pencil *pencil)
{
  Pencil s;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(1, &s));
  *pencil      = s;
  s->comm      = operators->comm;
  s->operators = operators;
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
  PetscCall(operators->model ? PencilTakeDependents(s) : PencilScaleMultipliers(s));
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

PetscErrorCode PencilSetParameters(Pencil pencil, const PetscReal p[])
{
  const PetscInt n = pencil->parameters.n;
  PetscBool      same;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < n; i++) PetscCall(ParameterCheck(pencil->comm, &pencil->parameters.list[i], p[i]));
  PetscCall(PetscArraycmp(pencil->parameters.p, p, n, &same));
  if (same) PetscFunctionReturn(0);
  PetscCall(OperatorsCheckFriction(pencil->operators, p));
  PetscCall(PencilCheckTerms(pencil));
  PetscCall(PetscArraycpy(pencil->parameters.p, p, n));
  for (int i = 0; i < N_PENCIL_SUMS; i++) pencil->sum[i].current = PETSC_FALSE;
  pencil->has_factors = PETSC_FALSE;
  PetscFunctionReturn(0);
}

/* What each sum is made of */
static const struct {
  TermsSumKind kind;
  PetscBool    symmetric;   /* without friction and damping */
  PencilSum    unprojected; /* the same sum when no constraint projects */
} sums[N_PENCIL_SUMS] = {
  [SUM_K]       = {{OPERATORS_STIFFNESS, TERMS_SYMMETRIC, 1},   PETSC_TRUE,  SUM_K   },
  [SUM_M]       = {{OPERATORS_MASS, TERMS_ALL, 1},              PETSC_TRUE,  SUM_M   },
  [SUM_C]       = {{OPERATORS_DAMPING, TERMS_ALL, 1},           PETSC_FALSE, SUM_C   },
  [SUM_H]       = {{OPERATORS_STIFFNESS, TERMS_UNSYMMETRIC, 1}, PETSC_FALSE, SUM_H   },
  [PROJECTED_K] = {{OPERATORS_STIFFNESS, TERMS_SYMMETRIC, 1},   PETSC_TRUE,  SUM_K   },
  [PROJECTED_M] = {{OPERATORS_MASS, TERMS_SYMMETRIC, 1},        PETSC_TRUE,  SUM_M   },
  [PENCIL_K]    = {{OPERATORS_STIFFNESS, TERMS_ALL, 1},         PETSC_FALSE, PENCIL_K},
  [PENCIL_M]    = {{OPERATORS_MASS, TERMS_ALL, 1},              PETSC_FALSE, SUM_M   },
  [PENCIL_C]    = {{OPERATORS_DAMPING, TERMS_ALL, 1},           PETSC_FALSE, SUM_C   },
};

/* One of the sums at the present point (borrowed); NULL when it vanishes */
static PetscErrorCode PencilFormSum(Pencil pencil, PencilSum which, Mat *A)
{
  const PencilSum  at        = pencil->Zr ? which : sums[which].unprojected;
  const PetscBool  projected = pencil->Zr && at >= PROJECTED_K ? PETSC_TRUE : PETSC_FALSE;
  const PetscReal *p = pencil->parameters.p, mu = OperatorsLargestMu(pencil->operators, p);
  TermsSum        *sum  = &pencil->sum[at];
  TermsSumKind     kind = sums[at].kind;

  PetscFunctionBeginUser;
  if (!sum->current) {
    if (projected) PetscCall(PencilProjectTerms(pencil));
    if (at == SUM_H && mu != 0) kind.scale = 1 / mu;
    PetscCall(pencil->released && (at == PencilEven(pencil) || at == PENCIL_K)
                ? PencilRestore(pencil, at)
                : TermsSumForm(projected ? &pencil->projected : &pencil->base, &kind, p, sum));
    if (sum->A) PetscCall(MatSetOption(sum->A, MAT_SYMMETRIC, sums[at].symmetric && pencil->operators->symmetric));
    if (sum->A && kind.kind == OPERATORS_MASS) PetscCall(PencilCheckMass(pencil, sum->A));
  }
  *A = sum->A;
  PetscFunctionReturn(0);
}

/* H: the one given, at any mu, or that of a model, which vanishes with mu; with -terms it is part of K */
static PetscErrorCode PencilFormFriction(Pencil pencil, Mat *H)
{
  const OperatorsTerm *last = &pencil->base.term[pencil->base.n - 1];

  PetscFunctionBeginUser;
  if (pencil->operators->model)
    PetscCall(PencilFormSum(pencil, SUM_H, H));
  else
    *H = last->frictional && !pencil->operators->n_named ? last->A : NULL;
  PetscFunctionReturn(0);
}

PetscErrorCode PencilGetParts(Pencil pencil, PencilParts *parts)
{
  const PetscBool named = pencil->operators->n_named ? PETSC_TRUE : PETSC_FALSE;

  PetscFunctionBeginUser;
  PetscCall(PencilFormSum(pencil, named ? PENCIL_K : SUM_K, &parts->K));
  PetscCall(PencilFormSum(pencil, SUM_M, &parts->M));
  PetscCall(PencilFormSum(pencil, SUM_C, &parts->C));
  PetscCall(PencilFormFriction(pencil, &parts->H));
  parts->mu = named ? 0 : OperatorsLargestMu(pencil->operators, pencil->parameters.p);
  PetscFunctionReturn(0);
}

PetscErrorCode PencilGetMass(Pencil pencil, Mat *M)
{
  PetscFunctionBeginUser;
  PetscCall(PencilFormSum(pencil, SUM_M, M));
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

/* Whether what is in C at this point is symmetric, as the damping of bodies, dashpots and friction is */
static PetscBool DampingIsSymmetric(const Terms *terms, const PetscReal p[])
{
  for (PetscInt t = 0; t < terms->n; t++) {
    const OperatorsTerm *term = &terms->term[t];

    if (term->kind != OPERATORS_DAMPING || term->symmetric) continue;
    if (OperatorsTermCoefficient(term, p) != 0) return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

/* K as a symmetric matrix and the product of two with a row for each pair, as far as it is such a sum */
static PetscErrorCode PencilGetFactors(Pencil pencil, PencilMatrices *m)
{
  PetscFunctionBeginUser;
  m->K_even = m->left = m->right = NULL;
  m->prefers_even                = pencil->operators->factors == OPERATORS_EVEN ? PETSC_TRUE : PETSC_FALSE;
  if (m->symmetric || !pencil->operators->symmetric || pencil->n_left) PetscFunctionReturn(0);
  if (pencil->operators->factors == OPERATORS_LU) PetscFunctionReturn(0);
  PetscCall(PencilFormFactors(pencil));
  if (!pencil->factor[0]) PetscFunctionReturn(0);
  PetscCall(PencilFormSum(pencil, PROJECTED_K, &m->K_even));
  m->left  = pencil->factor[0];
  m->right = pencil->factor[1];
  PetscFunctionReturn(0);
}

PetscErrorCode PencilGetMatrices(Pencil pencil, PencilMatrices *m)
{
  const Terms     *terms = pencil->Zr ? &pencil->projected : &pencil->base;
  const PetscReal *p     = pencil->parameters.p;
  PetscBool        frictionless, same_mass;

  PetscFunctionBeginUser;
  PetscCall(PencilProjectTerms(pencil));
  frictionless = TermsVanish(terms, TERMS_UNSYMMETRIC, PETSC_FALSE, p);
  same_mass    = TermsVanish(terms, TERMS_UNSYMMETRIC, PETSC_TRUE, p);
  m->symmetric = pencil->operators->symmetric && frictionless ? PETSC_TRUE : PETSC_FALSE;
  m->singular  = pencil->mass_singular;
  PetscCall(PencilFormSum(pencil, frictionless ? PROJECTED_K : PENCIL_K, &m->K));
  PetscCall(PencilFormSum(pencil, same_mass ? PROJECTED_M : PENCIL_M, &m->M));
  PetscCall(PencilFormSum(pencil, PENCIL_C, &m->C));
  if (m->C && pencil->operators->symmetric) PetscCall(MatSetOption(m->C, MAT_SYMMETRIC, DampingIsSymmetric(terms, p)));
  PetscCall(PencilGetFactors(pencil, m));
  PetscFunctionReturn(0);
}

PetscErrorCode PencilGetFrictionless(Pencil pencil, PencilMatrices *m)
{
  PetscFunctionBeginUser;
  PetscCall(PencilFormSum(pencil, PROJECTED_K, &m->K));
  PetscCall(PencilFormSum(pencil, PROJECTED_M, &m->M));
  m->C         = NULL;
  m->symmetric = pencil->operators->symmetric;
  m->singular  = pencil->mass_singular;
  m->K_even = m->left = m->right = NULL;
  m->prefers_even                = PETSC_FALSE;
  PetscFunctionReturn(0);
}

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
  PetscCall(TermsRelease(&pencil->base));
  PetscCall(TermsRelease(&pencil->projected));
  PetscCall(TermsRelease(&o->terms));
  PetscCall(TermsRelease(&o->spin));
  pencil->released = PETSC_TRUE;
  PetscFunctionReturn(0);
}

PetscErrorCode PencilExpand(Pencil pencil, PetscBool left, Vec q, Vec u)
{
  Vec part;

  PetscFunctionBeginUser;
  if (!pencil->Zr) {
    PetscCall(VecCopy(q, u));
    PetscFunctionReturn(0);
  }
  PetscCall(MatMult(pencil->Zr, q, u));
  if (!left) PetscFunctionReturn(0);
  PetscCall(VecDuplicate(u, &part));
  for (PetscInt i = 0; i < pencil->n_left; i++) {
    PetscCall(MatMult(pencil->left[i], q, part));
    PetscCall(VecAXPY(u, FrictionFactorValue(pencil->left_mu[i], PETSC_FALSE, pencil->parameters.p), part));
  }
  PetscCall(VecDestroy(&part));
  PetscFunctionReturn(0);
}

PetscErrorCode PencilProjectForce(Pencil pencil, PetscBool transposed, Vec f, Vec g)
{
  Vec part;

  PetscFunctionBeginUser;
  if (!pencil->Zr) {
    PetscCall(VecCopy(f, g));
    PetscFunctionReturn(0);
  }
  PetscCall(MatMultTranspose(pencil->Zr, f, g));
  if (transposed) PetscFunctionReturn(0);
  PetscCall(VecDuplicate(g, &part));
  for (PetscInt i = 0; i < pencil->n_left; i++) {
    PetscCall(MatMultTranspose(pencil->left[i], f, part));
    PetscCall(VecAXPY(g, FrictionFactorValue(pencil->left_mu[i], PETSC_FALSE, pencil->parameters.p), part));
  }
  PetscCall(VecDestroy(&part));
  PetscFunctionReturn(0);
}

PetscErrorCode PencilRestrict(Pencil pencil, Vec u, Vec q)
{
  PetscFunctionBeginUser;
  if (pencil->E)
    PetscCall(MatMultTranspose(pencil->E, u, q));
  else
    PetscCall(VecCopy(u, q));
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
  PetscCall(PetscViewerASCIIPrintf(
    viewer, "operators: %" PetscInt_FMT " unknowns, %.0f nonzeros, %s, %s, %s mass\n", n_pencil, (double)info.nz_used,
    pencil->operators->n_named ? (m.symmetric ? "symmetric" : "unsymmetric")
    : m.symmetric              ? "no friction: symmetric"
    : spinning                 ? "spin or friction: unsymmetric"
                               : "friction: unsymmetric",
    m.C ? "damped: quadratic problem" : "undamped", pencil->operators->lump ? "lumped" : "consistent"));
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
  for (int i = 0; i < 2; i++) PetscCall(MatDestroy(&s->factor[i]));
  PetscCall(MatDestroy(&s->half));
  PetscCall(PencilDestroyNullSpaces(s));
  PetscCall(TermsDestroy(&s->base));
  PetscCall(TermsDestroy(&s->causing));
  PetscCall(PetscFree(s->cause));
  PetscCall(ParametersDestroy(&s->parameters));
  PetscCall(PetscFree(s->group));
  PetscCall(PetscFree(s->slips));
  PetscCall(PetscFree(s->force));
  PetscCall(PetscFree(s->total));
  PetscCall(PetscFree(*pencil));
  PetscFunctionReturn(0);
}
