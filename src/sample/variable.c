/*
   Variables: what their options say of their distributions, the parameters of the scene that take their values, and
   the values of each point.

      z = L Phi^-1(u),   x_k = F_k^-1(Phi(z_k)),   L L' the correlations of the normal scores z (Gaussian copula)

   Points are the samples, then the rest of the design of the indices (statistics/indices.c): with u of 2 n dimensions
   the first n_rows samples are the points A, the same rows of the last n dimensions B, and behind the samples come B
   and, for each variable, A with that of B.
*/
#include "sampleimpl.h"
#include "sweep/grid/grid.h"
#include <squeal/options.h>
#include <stdlib.h>
#include <string.h>

/* Raises an error for points that are no distribution */
static PetscErrorCode TableCheck(MPI_Comm comm, const SampleVariable *v, const Distribution *d)
{
  PetscFunctionBeginUser;
  for (PetscInt k = 1; k < d->n; k++)
    PetscCheck(d->value[k] > d->value[k - 1] && d->probability[k] > d->probability[k - 1], comm, PETSC_ERR_USER_INPUT,
               "-%s_table %s: value and probability must ascend, which %.6g, %.6g behind %.6g, %.6g do not", v->name,
               v->table, (double)d->value[k], (double)d->probability[k], (double)d->value[k - 1],
               (double)d->probability[k - 1]);
  PetscCheck(d->probability[0] == 0 && d->probability[d->n - 1] == 1, comm, PETSC_ERR_USER_INPUT,
             "-%s_table %s: probability must go from 0 to 1, not from %.6g to %.6g", v->name, v->table,
             (double)d->probability[0], (double)d->probability[d->n - 1]);
  PetscFunctionReturn(0);
}

/* What a distribution needs, and what it has no use for */
static PetscErrorCode VariableCheckGiven(MPI_Comm comm, const SampleVariable *v)
{
  const DistributionKind kind = v->distribution.kind;
  const PetscBool normal = kind == DISTRIBUTION_NORMAL || kind == DISTRIBUTION_LOGNORMAL ? PETSC_TRUE : PETSC_FALSE;
  const PetscBool ends   = kind == DISTRIBUTION_UNIFORM || kind == DISTRIBUTION_TRIANGULAR ? PETSC_TRUE : PETSC_FALSE;

  PetscFunctionBeginUser;
  PetscCheck(!normal || v->deviation_given, comm, PETSC_ERR_USER_INPUT,
             "-%s_distribution normal and lognormal need -%s_deviation", v->name, v->name);
  PetscCheck(normal || (!v->mean_given && !v->deviation_given), comm, PETSC_ERR_USER_INPUT,
             "-%s_mean and -%s_deviation are those of -%s_distribution normal and lognormal", v->name, v->name,
             v->name);
  PetscCheck(!ends || (v->lower_given && v->upper_given), comm, PETSC_ERR_USER_INPUT,
             "-%s_distribution uniform and triangular need -%s_lower and -%s_upper", v->name, v->name, v->name);
  PetscCheck(kind == DISTRIBUTION_TRIANGULAR || !v->peak_given, comm, PETSC_ERR_USER_INPUT,
             "-%s_peak is that of -%s_distribution triangular", v->name, v->name);
  PetscCheck((kind == DISTRIBUTION_TABLE) == (v->table[0] != '\0'), comm, PETSC_ERR_USER_INPUT,
             "-%s_table and -%s_distribution table need each other", v->name, v->name);
  PetscCheck(!v->lower_given || !v->upper_given || v->distribution.lower < v->distribution.upper, comm,
             PETSC_ERR_USER_INPUT, "-%s_lower %.6g must be below -%s_upper %.6g", v->name,
             (double)v->distribution.lower, v->name, (double)v->distribution.upper);
  PetscFunctionReturn(0);
}

PetscErrorCode SampleVariableCheck(MPI_Comm comm, void *owner, void *record)
{
  SampleVariable *v = record;

  PetscFunctionBeginUser;
  (void)owner;
  PetscCall(VariableCheckGiven(comm, v));
  if (!v->lower_given) v->distribution.lower = PETSC_NINFINITY;
  if (!v->upper_given) v->distribution.upper = PETSC_INFINITY;
  if (!v->table[0]) PetscFunctionReturn(0);
  PetscCall(SampleTableRead(comm, v, "probability", &v->distribution));
  PetscCall(TableCheck(comm, v, &v->distribution));
  PetscFunctionReturn(0);
}

/* Raises an error where mean or peak are those of the scene, and its parameters have several values */
static PetscErrorCode VariableCheckOwn(Sample s, const SampleVariable *v)
{
  const DistributionKind kind = v->distribution.kind;
  const PetscBool normal = kind == DISTRIBUTION_NORMAL || kind == DISTRIBUTION_LOGNORMAL ? PETSC_TRUE : PETSC_FALSE;
  const PetscBool given  = normal ? v->mean_given : (PetscBool)(kind != DISTRIBUTION_TRIANGULAR || v->peak_given);
  const PetscReal first  = s->box.nominal[v->moved[0]];

  PetscFunctionBeginUser;
  for (PetscInt i = 1; i < v->n_names && !given && !v->relative; i++)
    PetscCheck(s->box.nominal[v->moved[i]] == first, s->comm, PETSC_ERR_USER_INPUT,
               "-%s_%s is the value of the scene by default, but %s %.6g and %s %.6g differ: give it, or -%s_relative",
               v->name, normal ? "mean" : "peak", v->names[0], (double)first, v->names[i],
               (double)s->box.nominal[v->moved[i]], v->name);
  PetscFunctionReturn(0);
}

/* Mean or peak are those of the scene where nothing is said, and the rest must fit them */
static PetscErrorCode VariableComplete(Sample s, SampleVariable *v)
{
  Distribution   *d   = &v->distribution;
  const PetscReal own = v->relative ? 1 : s->box.nominal[v->moved[0]];

  PetscFunctionBeginUser;
  PetscCall(VariableCheckOwn(s, v));
  if (!v->mean_given) d->mean = own;
  if (!v->peak_given) d->peak = own;
  PetscCheck(d->kind != DISTRIBUTION_LOGNORMAL || d->mean > 0, s->comm, PETSC_ERR_USER_INPUT,
             "-%s_mean %.6g of a lognormal distribution must be positive", v->name, (double)d->mean);
  PetscCheck(d->kind != DISTRIBUTION_TRIANGULAR || (d->peak >= d->lower && d->peak <= d->upper), s->comm,
             PETSC_ERR_USER_INPUT, "-%s_peak %.6g must lie between -%s_lower %.6g and -%s_upper %.6g", v->name,
             (double)d->peak, v->name, (double)d->lower, v->name, (double)d->upper);
  PetscCheck(DistributionQuantile(d, 0.25) < DistributionQuantile(d, 0.75), s->comm, PETSC_ERR_USER_INPUT,
             "-%s_lower %.6g and -%s_upper %.6g leave nothing of the distribution", v->name, (double)d->lower, v->name,
             (double)d->upper);
  PetscFunctionReturn(0);
}

/* The parameters of a variable */
static PetscErrorCode VariableFind(Sample s, SampleVariable *v)
{
  const OperatorsParameter *list;
  PetscInt                  n;
  char                      option[160];

  PetscFunctionBeginUser;
  PetscCall(OperatorsGetParameters(s->operators, &n, &list));
  PetscCall(PetscSNPrintf(option, sizeof(option), "-%s_parameters", v->name));
  if (s->file[0] && !v->source[0]) PetscCall(PetscStrncpy(option, "-sample_conditions: column", sizeof(option)));
  PetscCall(PetscMalloc1(v->n_names, &v->moved));
  for (PetscInt i = 0; i < v->n_names; i++) {
    PetscCall(GridParameterFind(s->comm, s->operators, option, v->names[i], &v->moved[i]));
    PetscCall(
      GridParameterCheck(s->comm, s->operators, s->box.statics ? PETSC_TRUE : PETSC_FALSE, option, v->names[i]));
    if (s->file[0]) PetscCall(ConditionsCheckUnit(s, v, &list[v->moved[i]]));
    PetscCheck(s->box.statics || !list[v->moved[i]].state, s->comm, PETSC_ERR_USER_INPUT,
               "%s %s changes modes through the sliding state alone: give -modes_contact static", option, v->names[i]);
    PetscCheck(!v->relative || s->box.nominal[v->moved[i]] != 0, s->comm, PETSC_ERR_USER_INPUT,
               "-%s_relative: %s is 0 in this scene, and so is any factor of it; give -%s another value", v->name,
               v->names[i], v->names[i]);
    for (PetscInt k = 0; &s->variable[k] <= v; k++)
      for (PetscInt j = 0; j < (&s->variable[k] == v ? i : s->variable[k].n_names); j++)
        PetscCheck(s->variable[k].moved[j] != v->moved[i], s->comm, PETSC_ERR_USER_INPUT,
                   "-%s_parameters names '%s', which -%s_parameters has already", v->name, v->names[i],
                   s->variable[k].name);
  }
  PetscCall(OperatorsCheckMoved(s->operators, option, v->n_names, v->moved));
  if (!s->file[0]) PetscCall(VariableComplete(s, v));
  PetscFunctionReturn(0);
}

/* The variable of that name */
static PetscErrorCode VariableNamed(Sample s, const char name[], PetscInt *k)
{
  PetscFunctionBeginUser;
  for (*k = 0; *k < s->n_variables; ++*k)
    if (!strcmp(s->variable[*k].name, name)) PetscFunctionReturn(0);
  SETERRQ(s->comm, PETSC_ERR_USER_INPUT, "-sample_correlations: '%s' is none of -sample_variables", name);
}

/* L of R = L L' in place, by rows from the first on (A.-L. Cholesky); columns behind the diagonal become zero */
static PetscErrorCode CorrelationsFactor(Sample s, PetscReal L[])
{
  const PetscInt n = s->n_variables;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < n; i++)
    for (PetscInt j = 0; j < n; j++) {
      PetscReal sum = L[i * n + j];

      for (PetscInt k = 0; k < PetscMin(i, j); k++) sum -= L[i * n + k] * L[j * n + k];
      PetscCheck(i != j || sum > 0, s->comm, PETSC_ERR_USER_INPUT,
                 "-sample_correlations %s: no variables can have all of these at once", s->correlations);
      L[i * n + j] = i == j ? PetscSqrtReal(sum) : j < i ? sum / L[j * n + j] : 0;
    }
  PetscFunctionReturn(0);
}

/* "a:b:0.5,a:c:-0.2" */
static PetscErrorCode CorrelationsRead(Sample s)
{
  const PetscInt n = s->n_variables;
  char         **item;
  int            n_items;

  PetscFunctionBeginUser;
  if (!s->correlations[0]) PetscFunctionReturn(0);
  PetscCall(PetscCalloc1(n * n, &s->factor));
  for (PetscInt k = 0; k < n; k++) s->factor[k * n + k] = 1;
  PetscCall(ValuesSplit(s->comm, "-sample_correlations", s->correlations, ',', &n_items, &item));
  for (int i = 0; i < n_items; i++) {
    char    **word, *end;
    int       n_words;
    PetscInt  a, b;
    PetscReal r;

    PetscCall(ValuesSplit(s->comm, "-sample_correlations", item[i], ':', &n_words, &word));
    PetscCheck(n_words == 3, s->comm, PETSC_ERR_USER_INPUT,
               "-sample_correlations '%s' must be two variables and a number, as a:b:0.5", item[i]);
    PetscCall(VariableNamed(s, word[0], &a));
    PetscCall(VariableNamed(s, word[1], &b));
    r = strtod(word[2], &end);
    PetscCheck(!*end && r > -1 && r < 1 && a != b, s->comm, PETSC_ERR_USER_INPUT,
               "-sample_correlations '%s' must be two variables and a number between -1 and 1", item[i]);
    PetscCheck(s->factor[a * n + b] == 0, s->comm, PETSC_ERR_USER_INPUT,
               "-sample_correlations '%s': these two have one already, %.6g", item[i], (double)s->factor[a * n + b]);
    s->factor[a * n + b] = s->factor[b * n + a] = r;
    PetscCall(PetscStrToArrayDestroy(n_words, word));
  }
  PetscCall(PetscStrToArrayDestroy(n_items, item));
  PetscCall(CorrelationsFactor(s, s->factor));
  PetscFunctionReturn(0);
}

PetscErrorCode SampleFindVariables(Sample s)
{
  PetscFunctionBeginUser;
  PetscCheck(s->n_variables || s->file[0], s->comm, PETSC_ERR_USER_INPUT,
             "-analysis sample needs -sample_variables, or -sample_conditions");
  for (PetscInt k = 0; k < s->n_variables; k++) PetscCall(VariableFind(s, &s->variable[k]));
  PetscCheck(s->n_verify <= s->n, s->comm, PETSC_ERR_USER_INPUT,
             "-sample_verify %" PetscInt_FMT " must be at most %s %" PetscInt_FMT, s->n_verify,
             s->file[0] ? "the number of conditions," : "-sample_count", s->n);
  s->n_points = s->n;
  if (s->file[0]) {
    PetscCall(ConditionsFindReversed(s));
    PetscFunctionReturn(0);
  }
  PetscCall(CorrelationsRead(s));
  PetscCheck(!s->factor || !s->n_rows, s->comm, PETSC_ERR_USER_INPUT,
             "-sample_indices are those of independent variables: leave out -sample_correlations");
  PetscCheck(s->n_rows <= s->n, s->comm, PETSC_ERR_USER_INPUT,
             "-sample_indices %" PetscInt_FMT " must be at most -sample_count %" PetscInt_FMT, s->n_rows, s->n);
  s->sequence = (Sequence){s->kind, (uint64_t)s->seed, s->n, (s->n_rows ? 2 : 1) * s->n_variables, NULL};
  PetscCall(SequenceSetUp(&s->sequence));
  s->n_points = s->n + (s->n_rows ? (s->n_variables + 1) * s->n_rows : 0);
  PetscFunctionReturn(0);
}

/* Correlates u in place */
static void UniformCorrelate(Sample s, PetscReal u[])
{
  const PetscInt n = s->n_variables;
  PetscReal      z[SAMPLE_MAX_VARIABLES];

  for (PetscInt k = 0; k < n; k++) z[k] = NormalQuantile(u[k]);
  for (PetscInt k = 0; k < n; k++) {
    PetscReal sum = 0;

    for (PetscInt j = 0; j <= k; j++) sum += s->factor[k * n + j] * z[j];
    u[k] = NormalProbability(sum);
  }
}

PetscErrorCode SampleValues(Sample s, PetscInt i, PetscReal value[])
{
  const PetscInt n = s->n_variables, part = i < s->n ? -1 : (i - s->n) / s->n_rows; /* 0: B, k + 1: A with k of B */
  PetscReal      u[SOBOL_DIMENSIONS];

  PetscFunctionBeginUser;
  SequencePoint(&s->sequence, part < 0 ? i : (i - s->n) % s->n_rows, u);
  for (PetscInt k = 0; k < n && part >= 0; k++)
    if (part == 0 || part == k + 1) u[k] = u[n + k];
  if (s->factor) UniformCorrelate(s, u);
  for (PetscInt k = 0; k < n; k++) value[k] = DistributionQuantile(&s->variable[k].distribution, u[k]);
  PetscFunctionReturn(0);
}

/* All parameters of the operators at point i; ctx is the sample */
PetscErrorCode SampleGet(void *ctx, PetscInt i, PetscReal p[])
{
  Sample    s = ctx;
  PetscReal value[SAMPLE_MAX_VARIABLES];

  PetscFunctionBeginUser;
  PetscCall(PetscArraycpy(p, s->box.nominal, s->box.n_base));
  if (s->file[0]) {
    PetscCall(ConditionsGet(s, i, p));
    PetscFunctionReturn(0);
  }
  PetscCall(SampleValues(s, i, value));
  for (PetscInt k = 0; k < s->n_variables; k++) {
    const SampleVariable *v = &s->variable[k];

    for (PetscInt m = 0; m < v->n_names; m++)
      p[v->moved[m]] = v->relative ? value[k] * s->box.nominal[v->moved[m]] : value[k];
  }
  PetscFunctionReturn(0);
}

PetscErrorCode SampleParameters(Sample s, PetscInt i, PetscReal p[])
{
  PetscFunctionBeginUser;
  PetscCall(SampleGet(s, i, p));
  BoxPutStatus(&s->box, i, p);
  PetscFunctionReturn(0);
}
