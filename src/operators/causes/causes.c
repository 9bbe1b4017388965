/*
   Why an eigenvalue grows. From (lambda^2 M + lambda C + K) u = 0, lambda = sigma + i omega, K = sum_t c_t A_t and so
   on, the imaginary part of u^H (...) u = 0 is, with q_t = u^H A_t u,

      sigma D = - sum_stiffness c_t Im q_t - omega sum_damping c_t Re q_t - (sigma^2 - omega^2) sum_mass c_t Im q_t,

      D = 2 omega u^H M u + sum_damping c_t Im q_t      (kg rad/s times m^2),

   exactly and for any matrices: growth is a sum over the terms. What is symmetric without damping has no share, and a
   gyroscopic term one of rounding: it has a part in D alone. Where contact is exact, q^H (Zr + sum_i mu_i Zl_i)' (...)
   Zr q = 0: interface i adds w_i = mu_i (Zl_i q)^H (...) u, of which -Im w_i / D is the share, the limit of the
   penalty's. With a law of a material (viscoelastic.h) h(lambda) A stands beside its parts of K and C, and the share of
   the three is - Im G(lambda) u^H A u / D: what the material dissipates at the mode's own lambda, as K has no part.
*/
#include "products.h"
#include <complex.h>

/* Whether a term can have a share */
static PetscBool TermHasShare(const OperatorsTerm *term, const PetscReal p[])
{
  if (OperatorsTermCoefficient(term, p) == 0) return PETSC_FALSE;
  if (term->law) return term->kind == OPERATORS_DAMPING ? PETSC_TRUE : PETSC_FALSE;
  return term->kind == OPERATORS_DAMPING || !term->symmetric ? PETSC_TRUE : PETSC_FALSE;
}

/* Index of a cause, a new one where it is not there */
static PetscErrorCode CauseFind(Pencil pencil, const char kind[], const char name[], PetscInt *index)
{
  PetscInt i = 0;

  PetscFunctionBeginUser;
  while (i < pencil->n_causes && (strcmp(pencil->cause[i].name, name) || strcmp(pencil->cause[i].kind, kind))) i++;
  *index = i;
  if (i < pencil->n_causes) PetscFunctionReturn(0);
  PetscCall(PetscRealloc((size_t)++pencil->n_causes * sizeof(*pencil->cause), &pencil->cause));
  pencil->cause[i].kind = kind;
  PetscCall(PetscStrncpy(pencil->cause[i].name, name, sizeof(pencil->cause[i].name)));
  PetscFunctionReturn(0);
}

/* Keeps a term and its cause; the coefficient at the present point is folded into scale here, since shares are asked
   for after the point may have moved on */
static PetscErrorCode CauseTermAdd(Pencil pencil, const OperatorsTerm *term)
{
  Terms                  *causing = &pencil->causing;
  const PetscInt          n       = causing->n;
  const PetscBool         exact   = term->constraint >= 0 ? PETSC_TRUE : PETSC_FALSE;
  const Terms             one     = {.n = 1, .term = (OperatorsTerm *)term};
  const char             *name    = term->cause;
  const ContactInterface *c;
  PetscInt                n_interfaces;
  OperatorsTerm           plain; /* without its law */

  PetscFunctionBeginUser;
  if (exact) PetscCall(ContactGetInterfaces(pencil->operators->contact, &n_interfaces, &c));
  if (exact) name = c[pencil->left_interface[term->constraint]].name;
  PetscCall(TermsAppend(causing, &one));
  PetscCall(CauseFind(pencil, exact ? "friction" : term->cause_kind, name, &causing->term[n].cause_index));
  plain                  = causing->term[n];
  plain.law              = NULL;
  causing->term[n].scale = OperatorsTermCoefficient(&plain, pencil->parameters.p);
  causing->term[n].n     = 0;
  PetscCall(PencilFoldLaw(pencil, &causing->term[n]));
  PetscFunctionReturn(0);
}

/* At the present point. Terms that are released keep what was formed before (PencilReleaseTerms() calls this first). */
PetscErrorCode PencilFormCauses(Pencil pencil)
{
  const PetscReal *p = pencil->parameters.p;

  PetscFunctionBeginUser;
  if (pencil->released) PetscFunctionReturn(0); /* formed before */
  PetscCall(TermsDestroy(&pencil->causing));
  PetscCall(PencilUnfoldLaws(pencil));
  pencil->n_causes = 0;
  PetscCall(PencilProjectTerms(pencil));
  for (PetscInt t = 0; t < pencil->base.n; t++)
    if (TermHasShare(&pencil->base.term[t], p)) PetscCall(CauseTermAdd(pencil, &pencil->base.term[t]));
  for (PetscInt t = 0; t < pencil->projected.n; t++) {
    const OperatorsTerm *term = &pencil->projected.term[t];

    if (term->law && term->kind == OPERATORS_STIFFNESS) continue; /* the one of damping stands for both */
    if (term->constraint >= 0 && OperatorsTermCoefficient(term, p) != 0) PetscCall(CauseTermAdd(pencil, term));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode PencilGetCauses(Pencil pencil, PetscInt *n, const PencilCause **causes)
{
  PetscFunctionBeginUser;
  PetscCall(PencilFormCauses(pencil));
  *n      = pencil->n_causes;
  *causes = pencil->cause;
  PetscFunctionReturn(0);
}

/* What a term adds to -sigma D, and to D where it is damping, of form = x^H A x times the coefficient (N m, N s m, kg
   m^2 with u in m). sigma in 1/s, omega in rad/s, so that growth[] is in rad/s. */
static PetscReal TermShare(const OperatorsTerm *term, PetscReal sigma, PetscReal omega, const PetscReal form[2],
                           PetscReal *D)
{
  const PetscReal re = term->scale * form[0], im = term->scale * form[1], square = sigma * sigma - omega * omega;
  ViscoelasticAt  at;

  if (term->law) {
    OperatorsLawAt(term->law, NULL, CMPLX(sigma, omega), &at);
    return cimag(at.modulus) * re + (term->constraint >= 0 ? creal(at.modulus) * im : 0);
  }
  if (term->constraint >= 0) { /* Im(lambda^k q) */
    if (term->kind == OPERATORS_STIFFNESS) return im;
    return term->kind == OPERATORS_DAMPING ? sigma * im + omega * re : square * im + 2 * sigma * omega * re;
  }
  if (term->kind == OPERATORS_STIFFNESS) return im;
  if (term->kind == OPERATORS_MASS) return square * im;
  *D += im;
  return omega * re;
}

/* Modes whose shares are measured together: their vectors, of all unknowns and of those of the pencil */
typedef struct {
  PetscInt          n;
  const PencilMode *mode;
  CauseVector       u[CAUSES_BLOCK], q[CAUSES_BLOCK];
  CauseBlock        block;
  PetscReal        *growth; /* [n][causes] -sigma D, then 1/s */
  PetscReal         D[CAUSES_BLOCK];
} CauseModes;

static PetscErrorCode CauseModesCreate(Pencil pencil, PetscInt n, const PencilMode mode[], PetscReal growth[],
                                       CauseModes *m)
{
  PetscFunctionBeginUser;
  *m = (CauseModes){.n = n, .mode = mode, .growth = growth};
  for (PetscInt i = 0; i < n; i++) {
    /* D vanishes with omega, and the imaginary part of the equation with it */
    PetscCheck(mode[i].omega > 0, pencil->comm, PETSC_ERR_ARG_OUTOFRANGE,
               "a real eigenvalue has no balance of this kind");
    m->D[i] = 2 * mode[i].omega; /* u^H M u = 1 */
    m->u[i] = (CauseVector){{mode[i].xr, mode[i].xi}, NULL};
    PetscCall(VecDuplicate(mode[i].xr, &m->u[i].y));
    PetscCall(VectorRestrict(pencil, &m->u[i], &m->q[i]));
  }
  PetscCall(CauseBlockCreate(n, m->u, &m->block));
  PetscCall(PetscArrayzero(growth, n * pencil->n_causes));
  PetscFunctionReturn(0);
}

static PetscErrorCode CauseModesDestroy(CauseModes *m)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < m->n; i++) {
    PetscCall(VectorDestroy(&m->q[i]));
    PetscCall(VecDestroy(&m->u[i].y));
  }
  PetscCall(CauseBlockDestroy(&m->block));
  PetscFunctionReturn(0);
}

/* Adds what a term does to all modes: a large one by one product for all */
static PetscErrorCode CauseModesAdd(Pencil pencil, const OperatorsTerm *term, CauseModes *m)
{
  const PetscBool exact = term->constraint >= 0 ? PETSC_TRUE : PETSC_FALSE;
  PetscBool       done  = PETSC_FALSE;

  PetscFunctionBeginUser;
  if (!exact && term->kind == OPERATORS_DAMPING) PetscCall(CauseBlockMultiply(&m->block, term->A, &done));
  for (PetscInt i = 0; i < m->n; i++) {
    PetscReal form[2];

    if (!m->mode[i].xi && term->kind != OPERATORS_DAMPING && !exact) continue; /* Im q_t = 0 */
    if (done)
      PetscCall(CauseBlockForm(&m->block, i, form));
    else
      PetscCall(VectorForm(exact ? &m->q[i] : &m->u[i], term->A, form));
    m->growth[i * pencil->n_causes + term->cause_index] +=
      TermShare(term, m->mode[i].sigma, m->mode[i].omega, form, &m->D[i]);
  }
  PetscFunctionReturn(0);
}

PetscErrorCode PencilMeasureCauses(Pencil pencil, PetscInt n, const PencilMode mode[], PetscReal growth[],
                                   PetscReal energy[])
{
  const PetscInt n_causes = pencil->n_causes;
  CauseModes     m;

  PetscFunctionBeginUser;
  for (PetscInt first = 0; first < n; first += CAUSES_BLOCK) {
    PetscCall(CauseModesCreate(pencil, PetscMin(CAUSES_BLOCK, n - first), &mode[first], &growth[first * n_causes], &m));
    for (PetscInt t = 0; t < pencil->causing.n; t++) PetscCall(CauseModesAdd(pencil, &pencil->causing.term[t], &m));
    for (PetscInt i = 0; i < m.n; i++) {
      for (PetscInt k = 0; k < n_causes; k++) m.growth[i * n_causes + k] /= -m.D[i];
      energy[first + i] = m.mode[i].omega * m.D[i] / 4;
    }
    PetscCall(CauseModesDestroy(&m));
  }
  PetscFunctionReturn(0);
}

/* The factor of a term of damping, of materials Im G(lambda) / Im lambda */
static PetscReal TermLoss(const OperatorsTerm *term, PetscComplex lambda)
{
  ViscoelasticAt at;

  if (!term->law || cimag(lambda) == 0) return TermLaw(term, NULL);
  OperatorsLawAt(term->law, NULL, lambda, &at);
  return cimag(at.modulus) / cimag(lambda);
}

/* Forms and products of a term times its coefficient: form = x_0^H A x_0, product[a][b] = y_a' A x_b, turned[a][b]
   = y_a' A' x_b, which is not computed where A is symmetric, being equal, and of an exact contact, where product
   stands for it. */
static PetscErrorCode TermMeasureForms(const OperatorsTerm *term, PetscComplex lambda, PetscInt n,
                                       const CauseVector x[], const CauseVector y[], PencilForms *forms)
{
  const PetscReal scale = term->scale * TermLoss(term, lambda);

  PetscFunctionBeginUser;
  *forms = (PencilForms){.kind     = term->kind,
                         .exact    = term->constraint >= 0 ? PETSC_TRUE : PETSC_FALSE,
                         .friction = term->constraint >= 0 || !strcmp(term->cause_kind, "friction")};
  PetscCall(VectorForm(&x[0], term->A, forms->form));
  for (int k = 0; k < 2; k++) forms->form[k] *= scale;
  for (PetscInt a = 0; a < n; a++)
    for (PetscInt b = 0; b < n; b++) {
      PetscCall(VectorProduct(&y[a], term->A, PETSC_FALSE, &x[b], &forms->product[a][b]));
      forms->product[a][b] *= scale;
      forms->turned[a][b] = forms->product[a][b];
      if (forms->exact || term->symmetric) continue;
      PetscCall(VectorProduct(&y[a], term->A, PETSC_TRUE, &x[b], &forms->turned[a][b]));
      forms->turned[a][b] *= scale;
    }
  PetscFunctionReturn(0);
}

PetscErrorCode PencilMeasureForms(Pencil pencil, PetscComplex lambda, const PencilVectors *v, PetscInt *n,
                                  PencilForms **forms)
{
  CauseVector x[2][2] = {0}, y[2][2] = {0}; /* of all unknowns, of those of the pencil; a mode each */

  PetscFunctionBeginUser;
  *n = pencil->causing.n;
  PetscCall(PetscMalloc1(*n, forms));
  for (PetscInt a = 0; a < v->n; a++) {
    x[0][a] = (CauseVector){{v->xr[a], v->xi[a]}, NULL};
    y[0][a] = (CauseVector){{v->yr[a], v->yi[a]}, NULL};
    PetscCall(VecDuplicate(v->xr[a], &x[0][a].y));
    PetscCall(VectorRestrict(pencil, &x[0][a], &x[1][a]));
    PetscCall(VectorRestrict(pencil, &y[0][a], &y[1][a]));
  }
  for (PetscInt t = 0; t < *n; t++) {
    const OperatorsTerm *term  = &pencil->causing.term[t];
    const int            space = term->constraint >= 0;

    PetscCall(TermMeasureForms(term, lambda, v->n, x[space], y[space], &(*forms)[t]));
  }
  for (PetscInt a = 0; a < v->n; a++) {
    PetscCall(VectorDestroy(&x[1][a]));
    PetscCall(VectorDestroy(&y[1][a]));
    PetscCall(VecDestroy(&x[0][a].y));
  }
  PetscFunctionReturn(0);
}
