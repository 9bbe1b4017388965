/*
   What a pencil hands out at its present point: sums sum_t c_t(p) A_t of terms, formed when asked for, and vectors of
   all unknowns u as those of the pencil, u = Z q.
*/
#include "pencilimpl.h"

/* What each sum is made of */
static const struct {
  TermsSumKind kind;
  PetscBool    symmetric;   /* without friction and damping */
  PencilSum    unprojected; /* the same sum when no constraint projects */
} sums[N_PENCIL_SUMS] = {
  [SUM_K]       = {{OPERATORS_STIFFNESS, TERMS_SYMMETRIC, 1}, PETSC_TRUE, SUM_K},
  [SUM_M]       = {{OPERATORS_MASS, TERMS_ALL, 1}, PETSC_TRUE, SUM_M},
  [SUM_C]       = {{OPERATORS_DAMPING, TERMS_ALL, 1}, PETSC_FALSE, SUM_C},
  [SUM_H]       = {{OPERATORS_STIFFNESS, TERMS_UNSYMMETRIC, 1}, PETSC_FALSE, SUM_H},
  [PROJECTED_K] = {{OPERATORS_STIFFNESS, TERMS_SYMMETRIC, 1}, PETSC_TRUE, SUM_K},
  [PROJECTED_M] = {{OPERATORS_MASS, TERMS_SYMMETRIC, 1}, PETSC_TRUE, SUM_M},
  [PENCIL_K]    = {{OPERATORS_STIFFNESS, TERMS_ALL, 1}, PETSC_FALSE, PENCIL_K},
  [PENCIL_M]    = {{OPERATORS_MASS, TERMS_ALL, 1}, PETSC_FALSE, SUM_M},
  [PENCIL_C]    = {{OPERATORS_DAMPING, TERMS_ALL, 1}, PETSC_FALSE, SUM_C},
};

/* One of the sums at the present point (borrowed); NULL when it vanishes. Without constraints the sums in u and in q
   are one and the same, so that one of each pair is formed (`unprojected`). H is the unsymmetric stiffness over the
   largest mu of the interfaces, N/m: K + mu H with a mu for all. */
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
    if (pencil->released && (at == PencilEven(pencil) || at == PENCIL_K))
      PetscCall(PencilRestore(pencil, at));
    else
      PetscCall(TermsSumForm(projected ? &pencil->projected : &pencil->base, &kind, p, sum));
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

/* K as a symmetric matrix and the product of two with a row for each pair, as far as it is such a sum: not with the
   exact constraint, whose left null space depends on mu, and not where loaded matrices are unsymmetric by themselves */
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
  PetscCall(PencilFormLaws(pencil));
  m->n_laws = pencil->n_laws;
  m->law    = pencil->law;
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
  m->n_laws                      = 0;
  m->law                         = NULL;
  PetscFunctionReturn(0);
}

/* u = Zr q, or of a left vector u = Zl q = Zr q + sum_i mu_i Zl_i q at the present point */
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

/* g = Zl' f, equations being taken from the left; of the transposed problem Zr' f */
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

/* q = E'u reads q off a u = Zr q, since E'Zr = I */
PetscErrorCode PencilRestrict(Pencil pencil, Vec u, Vec q)
{
  PetscFunctionBeginUser;
  if (pencil->E)
    PetscCall(MatMultTranspose(pencil->E, u, q));
  else
    PetscCall(VecCopy(u, q));
  PetscFunctionReturn(0);
}
