/* The terms of a reduced model as its file has them: those with the same monomial of the variables summed */
#include "export.h"

#define IN_STEP 1e-12 /* of their values: parameters that move in proportion */
#define ALIKE   1e-12 /* of their length: rows that are the same, or have the same direction */

/* Whether varied parameter i moves as `ratio` times parameter j does, the scene's own values, too */
static PetscBool MovesInStep(const Box *box, const BoxVaried *varied, PetscInt i, PetscInt j, PetscReal *ratio)
{
  const PetscReal a[] = {varied->lower[i], varied->upper[i], box->nominal[varied->parameter[i]]};
  const PetscReal b[] = {varied->lower[j], varied->upper[j], box->nominal[varied->parameter[j]]};

  *ratio = b[1] != 0 ? a[1] / b[1] : a[0] / b[0];
  if (!varied->variable || varied->variable[i] != varied->variable[j] || !(PetscAbsReal(*ratio) > 0))
    return PETSC_FALSE;
  for (int k = 0; k < 3; k++)
    if (!(PetscAbsReal(a[k] - *ratio * b[k]) <= IN_STEP * PetscAbsReal(a[k]))) return PETSC_FALSE;
  return PETSC_TRUE;
}

PetscErrorCode ExportVariablesCreate(const Box *box, const BoxVaried *varied, ExportVariables *v)
{
  PetscFunctionBeginUser;
  v->n = 0;
  PetscCall(PetscMalloc3(varied->n, &v->of, varied->n, &v->ratio, varied->n, &v->first));
  for (PetscInt i = 0; i < varied->n; i++) {
    PetscInt k = 0;

    while (k < v->n && !MovesInStep(box, varied, i, v->first[k], &v->ratio[i])) k++;
    v->of[i] = k;
    if (k < v->n) continue;
    v->ratio[i]      = 1;
    v->first[v->n++] = i;
  }
  PetscFunctionReturn(0);
}

PetscErrorCode ExportVariablesDestroy(ExportVariables *v)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree3(v->of, v->ratio, v->first));
  PetscFunctionReturn(0);
}

/* Which of the varied parameters factor k of a term is, -1 for none of them */
static PetscInt FactorVaried(const OperatorsTerm *term, PetscInt k, const BoxVaried *varied)
{
  for (PetscInt i = 0; i < varied->n; i++) {
    if (!term->factor[k].friction && term->factor[k].parameter == varied->parameter[i]) return i;
    for (PetscInt q = 0; q < FRICTION_PARAMETERS && term->factor[k].friction; q++)
      if (term->factor[k].friction->parameter[q] == varied->parameter[i]) return i;
  }
  return -1;
}

/* Whether the law of a material, which is no monomial, changes with a varied parameter */
static PetscBool LawIsVaried(const OperatorsLaw *law, const BoxVaried *varied)
{
  for (PetscInt i = 0; i < varied->n && law; i++) {
    if (law->young == varied->parameter[i]) return PETSC_TRUE;
    for (PetscInt q = 0; q < VISCOELASTIC_PARAMETERS; q++)
      if (law->parameter[q] == varied->parameter[i]) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

/* What is varied of a term is a monomial: friction that changes with the speed is none */
static PetscBool TermIsMonomial(const OperatorsTerm *term, const BoxVaried *varied)
{
  for (PetscInt k = 0; k < term->n; k++)
    if (FactorVaried(term, k, varied) >= 0 && term->factor[k].friction &&
        (FrictionVaries(&term->factor[k].friction->law) || term->factor[k].slope))
      return PETSC_FALSE;
  return LawIsVaried(term->law, varied) ? PETSC_FALSE : PETSC_TRUE;
}

/* Group of pairs of a term that is closed or open, -1 for none */
static PetscInt TermGroup(const Box *box, const OperatorsTerm *term)
{
  const PetscInt first = box->n_parameters - box->groups_of.n_groups;

  for (PetscInt k = 0; k < term->n; k++)
    if (!term->factor[k].friction && term->factor[k].parameter >= first) return term->factor[k].parameter - first;
  return -1;
}

/* Its monomial, factors in the order of the variables; *scale times what the ratios make of it */
static void TermMonomial(const OperatorsTerm *term, const BoxVaried *varied, const ExportVariables *v, ExportTerm *as,
                         PetscReal *scale)
{
  as->kind      = term->kind;
  as->n_factors = 0;
  for (PetscInt k = 0; k < term->n; k++) {
    const PetscInt i = FactorVaried(term, k, varied);
    ExportFactor   f;
    PetscInt       at = as->n_factors;

    if (i < 0) continue;
    f = (ExportFactor){v->of[i], term->factor[k].power, term->factor[k].absolute};
    *scale *= PetscPowRealInt(f.absolute ? PetscAbsReal(v->ratio[i]) : v->ratio[i], f.power);
    for (; at > 0 && as->factor[at - 1].variable > f.variable; at--) as->factor[at] = as->factor[at - 1];
    as->factor[at] = f;
    as->n_factors++;
  }
}

/* The term with that monomial, with rows or without; a new one behind the others where there is none */
static PetscErrorCode TermsFind(ExportTerms *terms, const ExportTerm *as, PetscBool rows, ExportTerm **found)
{
  const size_t size = (size_t)(terms->n * terms->n);

  PetscFunctionBeginUser;
  for (PetscInt t = 0; t < terms->n_terms; t++) {
    ExportTerm *one  = &terms->term[t];
    PetscBool   same = one->kind == as->kind && one->n_factors == as->n_factors && (one->A ? !rows : rows);

    for (PetscInt k = 0; k < as->n_factors && same; k++)
      same = one->factor[k].variable == as->factor[k].variable && one->factor[k].power == as->factor[k].power &&
             one->factor[k].absolute == as->factor[k].absolute;
    *found = one;
    if (same) PetscFunctionReturn(0);
  }
  PetscCall(PetscRealloc((size_t)(terms->n_terms + 1) * sizeof(ExportTerm), &terms->term));
  *found              = &terms->term[terms->n_terms++];
  **found             = *as;
  (*found)->zero      = PETSC_TRUE;
  (*found)->rows_of   = -1;
  (*found)->symmetric = rows ? PETSC_FALSE : PETSC_TRUE;
  if (!rows) PetscCall(PetscCalloc1(size, &(*found)->A));
  PetscFunctionReturn(0);
}

/* Adds scale left' right of a group, row by row, right rows of length 1 whose largest entry is positive */
static PetscErrorCode RowsAdd(PetscInt n, PetscReal scale, const ReducedFactors *factors, PetscInt group,
                              ExportTerm *to)
{
  const PetscInt rank = factors->rank, all = to->n_rows + rank;

  PetscFunctionBeginUser;
  PetscCall(PetscRealloc((size_t)all * sizeof(*to->group), &to->group));
  PetscCall(PetscRealloc((size_t)(all * n) * sizeof(*to->left), &to->left));
  PetscCall(PetscRealloc((size_t)(all * n) * sizeof(*to->right), &to->right));
  for (PetscInt r = 0; r < rank; r++) {
    PetscReal *left = &to->left[(to->n_rows + r) * n], *right = &to->right[(to->n_rows + r) * n], square = 0, most = 0;

    to->group[to->n_rows + r] = group;
    for (PetscInt j = 0; j < n; j++) {
      const PetscReal value = factors->right[j * rank + r];

      square += value * value;
      if (PetscAbsReal(value) > (1 + ALIKE) * PetscAbsReal(most)) most = value;
    }
    square = most < 0 ? -PetscSqrtReal(square) : PetscSqrtReal(square);
    for (PetscInt j = 0; j < n; j++) {
      left[j]  = scale * square * factors->left[j * rank + r];
      right[j] = square != 0 ? factors->right[j * rank + r] / square : 0;
    }
  }
  to->n_rows = all;
  PetscFunctionReturn(0);
}

/* Weights of left rows along the right ones, where all are */
static PetscErrorCode RowsWeigh(PetscInt n, ExportTerm *t)
{
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(t->n_rows, &t->weight));
  t->along = PETSC_TRUE;
  for (PetscInt r = 0; r < t->n_rows && t->along; r++) {
    const PetscReal *left = &t->left[r * n], *right = &t->right[r * n];
    PetscReal        most = 0;

    for (PetscInt j = 0; j < n; j++) t->weight[r] += left[j] * right[j], most = PetscMax(most, PetscAbsReal(left[j]));
    for (PetscInt j = 0; j < n; j++)
      if (!(PetscAbsReal(left[j] - t->weight[r] * right[j]) <= ALIKE * most)) t->along = PETSC_FALSE;
  }
  PetscFunctionReturn(0);
}

/* An earlier term with the same right rows */
static void RowsFindSame(const ExportTerms *terms, ExportTerm *t)
{
  for (PetscInt s = 0; &terms->term[s] < t && t->rows_of < 0; s++) {
    const ExportTerm *one  = &terms->term[s];
    PetscBool         same = one->n_rows == t->n_rows && one->n_rows && one->rows_of < 0;

    for (PetscInt r = 0; r < t->n_rows && same; r++) same = one->group[r] == t->group[r];
    for (PetscInt k = 0; k < t->n_rows * terms->n && same; k++)
      same = PetscAbsReal(one->right[k] - t->right[k]) <= ALIKE;
    if (same) t->rows_of = s;
  }
}

/* Only the lower triangle, by columns */
static void TrianglePack(PetscInt n, PetscReal A[])
{
  PetscInt at = 0;

  for (PetscInt j = 0; j < n; j++)
    for (PetscInt i = j; i < n; i++) A[at++] = 0.5 * (A[j * n + i] + A[i * n + j]);
}

static PetscErrorCode TermsFinish(ExportTerms *terms)
{
  PetscFunctionBeginUser;
  for (PetscInt t = 0; t < terms->n_terms; t++) {
    ExportTerm *one = &terms->term[t];

    if (one->A && one->symmetric) TrianglePack(terms->n, one->A);
    if (one->A) continue;
    PetscCall(RowsWeigh(terms->n, one));
    RowsFindSame(terms, one);
  }
  PetscFunctionReturn(0);
}

PetscErrorCode ExportTermsCreate(const Box *box, const Reduced *reduced, const BoxVaried *varied,
                                 const ExportVariables *v, ExportTerms *terms, PetscBool *made)
{
  const PetscInt n = reduced->n, size = n * n;
  PetscReal     *ones;
  ExportTerm    *to, as;

  PetscFunctionBeginUser;
  *terms = (ExportTerms){.n = n};
  *made  = PETSC_TRUE;
  for (PetscInt t = 0; t < reduced->n_terms; t++) {
    if (!TermIsMonomial(&reduced->term[t], varied)) *made = PETSC_FALSE;
    if (TermGroup(box, &reduced->term[t]) >= 0 && !(reduced->factors && reduced->factors[t].left)) *made = PETSC_FALSE;
  }
  PetscCall(PetscMalloc1(box->n_parameters, &ones));
  PetscCall(PetscArraycpy(ones, box->nominal, box->n_parameters));
  for (PetscInt i = 0; i < varied->n; i++) ones[varied->parameter[i]] = 1;
  for (PetscInt g = 1; g <= box->groups_of.n_groups; g++) ones[box->n_parameters - g] = 1;
  for (int k = 0; k < 3; k++) {
    static const OperatorsTermKind kinds[] = {OPERATORS_STIFFNESS, OPERATORS_DAMPING, OPERATORS_MASS};

    PetscCall(TermsFind(terms, &(ExportTerm){.kind = kinds[k]}, PETSC_FALSE, &to));
  }
  for (PetscInt t = 0; t < reduced->n_terms && *made; t++) {
    const PetscInt group = TermGroup(box, &reduced->term[t]);
    PetscReal      scale = OperatorsTermCoefficient(&reduced->term[t], ones);

    as = (ExportTerm){.n_factors = 0};
    TermMonomial(&reduced->term[t], varied, v, &as, &scale);
    if (scale == 0) continue;
    PetscCall(TermsFind(terms, &as, group >= 0 ? PETSC_TRUE : PETSC_FALSE, &to));
    to->zero = PETSC_FALSE;
    if (group >= 0) {
      if (reduced->factors[t].rank) PetscCall(RowsAdd(n, scale, &reduced->factors[t], group, to));
      continue;
    }
    if (!reduced->term[t].symmetric) to->symmetric = PETSC_FALSE;
    for (PetscInt k = 0; k < size; k++) to->A[k] += scale * reduced->A[t][k];
  }
  if (*made) PetscCall(TermsFinish(terms));
  PetscCall(PetscFree(ones));
  PetscFunctionReturn(0);
}

PetscErrorCode ExportTermsDestroy(ExportTerms *terms)
{
  PetscFunctionBeginUser;
  for (PetscInt t = 0; t < terms->n_terms; t++) {
    PetscCall(PetscFree(terms->term[t].A));
    PetscCall(PetscFree(terms->term[t].group));
    PetscCall(PetscFree(terms->term[t].left));
    PetscCall(PetscFree(terms->term[t].right));
    PetscCall(PetscFree(terms->term[t].weight));
  }
  PetscCall(PetscFree(terms->term));
  PetscFunctionReturn(0);
}
