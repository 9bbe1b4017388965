/* The tables of samples */
#include "sampleimpl.h"
#include "base/text.h"

#define VERIFY_COLUMNS                                                                                                 \
  "modes_full,modes_reduced,unstable_full,unstable_reduced,true_error,error_estimate,freq_hz,full_error,"              \
  "modes_beyond_error,worst_ratio,n_closed,same_status"

/* Names of the variables behind the first columns, which end in a comma */
static PetscErrorCode VariableColumns(Sample s, const char first[], size_t size, char columns[])
{
  PetscFunctionBeginUser;
  PetscCall(PetscStrncpy(columns, first, size));
  for (PetscInt k = 0; k < s->n_variables; k++) {
    PetscCall(TextAdd(columns, ",", size));
    PetscCall(TextAdd(columns, s->variable[k].name, size));
  }
  PetscFunctionReturn(0);
}

/* A row for each sample: how many modes, how many of them grow, the one that grows fastest, and the variables */
static PetscErrorCode SamplesWrite(Sample s, Results results)
{
  ResultsTable table;
  char         columns[SAMPLE_MAX_TEXT];
  PetscReal    row[7 + SAMPLE_MAX_VARIABLES];

  PetscFunctionBeginUser;
  PetscCall(
    VariableColumns(s, "sample,modes,unstable,freq_hz,growth_rad_s,error_rad_s,n_closed", sizeof(columns), columns));
  PetscCall(ResultsTableOpen(results, "samples", columns, &table));
  for (PetscInt i = 0; i < s->n; i++) {
    const SampleMode *m          = SampleFind(s, i, s->nominal.n);
    PetscInt          n_unstable = 0;

    for (PetscInt k = 0; k < s->point[i].n; k++) {
      const SampleMode *each = &s->point[i].mode[k];

      n_unstable += ModesLimitJudge(&s->box.limit, each->sigma, each->omega, each->error) == MODE_UNSTABLE;
    }
    row[0] = (PetscReal)(i + 1);
    row[1] = (PetscReal)s->point[i].n;
    row[2] = (PetscReal)n_unstable;
    row[3] = m ? m->omega / (2 * PETSC_PI) : NAN;
    row[4] = m ? m->sigma : NAN;
    row[5] = m ? m->error : NAN;
    row[6] = s->box.statics ? (PetscReal)BoxClosed(&s->box, i) : NAN;
    PetscCall(SampleValues(s, i, &row[7]));
    PetscCall(ResultsTableNumbers(table, 7 + s->n_variables, row));
  }
  PetscCall(ResultsTableClose(&table));
  PetscFunctionReturn(0);
}

/* All modes of all samples */
static PetscErrorCode ModesRows(Sample s, Results results)
{
  ResultsTable table;

  PetscFunctionBeginUser;
  PetscCall(ResultsTableOpen(results, "samples_modes", "sample,branch,freq_hz,growth_rad_s,error_rad_s,class", &table));
  for (PetscInt i = 0; i < s->n; i++)
    for (PetscInt k = 0; k < s->point[i].n; k++) {
      const SampleMode *m = &s->point[i].mode[k];

      PetscCall(ResultsTableRow(table, "%d,%s,%.15g,%.15g,%.15g,%s", (int)i + 1,
                                SampleNumber(m->branch < 0 ? NAN : m->branch + 1).text,
                                (double)(m->omega / (2 * PETSC_PI)), (double)m->sigma, (double)m->error,
                                ModeStateName(ModesLimitJudge(&s->box.limit, m->sigma, m->omega, m->error))));
    }
  PetscCall(ResultsTableClose(&table));
  PetscFunctionReturn(0);
}

/* Five quantiles with commas between */
typedef struct {
  char text[N_QUANTILES * 26];
} Quantiles;

static Quantiles QuantilesText(const Moments *m)
{
  Quantiles q = {""};
  size_t    n = 0;

  for (int k = 0; k < N_QUANTILES; k++)
    n += (size_t)snprintf(q.text + n, sizeof(q.text) - n, "%s%s", k ? "," : "", SampleNumber(m->quantile[k]).text);
  return q;
}

static PetscErrorCode ProbabilityRow(Sample s, PetscInt b, ResultsTable table)
{
  const SampleBranch *branch = &s->branch[b];
  const PetscBool     any    = b == s->nominal.n ? PETSC_TRUE : PETSC_FALSE;
  const PetscComplex  lambda = any ? CMPLX(NAN, NAN) : s->nominal.lambda[b];
  const Moments      *f = &branch->frequency, *g = &branch->growth;

  PetscFunctionBeginUser;
  PetscCall(ResultsTableRow(
    table, "%s,\"%s\",%s,%s,%d,%s,%s,%s,%s,%s,%s,%d,%s,%.15g,%.15g,%d", any ? "any" : SampleNumber(b + 1).text,
    branch->label, SampleNumber(cimag(lambda) / (2 * PETSC_PI)).text, SampleNumber(creal(lambda)).text, (int)branch->n,
    SampleNumber(f->mean).text, SampleNumber(f->deviation).text, QuantilesText(f).text, SampleNumber(g->mean).text,
    SampleNumber(g->deviation).text, QuantilesText(g).text, (int)branch->n_unstable,
    SampleNumber(branch->n ? (PetscReal)branch->n_unstable / (PetscReal)branch->n : NAN).text,
    (double)branch->interval[0], (double)branch->interval[1], (int)(branch->n_possibly - branch->n_surely)));
  PetscFunctionReturn(0);
}

static PetscErrorCode ProbabilityWrite(Sample s, Results results)
{
  ResultsTable table;

  PetscFunctionBeginUser;
  PetscCall(ResultsTableOpen(
    results, "probability",
    "branch,label,freq_hz,growth_rad_s,samples,freq_mean_hz,freq_deviation_hz,freq_1_hz,freq_5_hz,freq_50_hz,freq_95_"
    "hz,"
    "freq_99_hz,growth_mean_rad_s,growth_deviation_rad_s,growth_1_rad_s,growth_5_rad_s,growth_50_rad_s,growth_95_rad_s,"
    "growth_99_rad_s,unstable,probability,probability_lower,probability_upper,open",
    &table));
  for (PetscInt b = 0; b <= s->nominal.n; b++)
    if (s->branch[b].frequency.n || b == s->nominal.n) PetscCall(ProbabilityRow(s, b, table));
  PetscCall(ResultsTableClose(&table));
  PetscFunctionReturn(0);
}

/* Rows of the indices of a branch, of its frequency and of its growth */
static PetscErrorCode IndexRows(Sample s, PetscInt b, PetscReal value[], ResultsTable table)
{
  VariableIndex index[SAMPLE_MAX_VARIABLES];
  PetscReal     r_squared;
  PetscInt      n_rows;

  PetscFunctionBeginUser;
  for (int which = 0; which < 2; which++) {
    SampleBranchValues(s, b, which, value);
    PetscCall(SampleIndices(s, value, index, &r_squared, &n_rows));
    for (PetscInt k = 0; k < s->n_variables; k++) {
      const VariableIndex *v    = &index[k];
      int                  rank = 1;

      for (PetscInt j = 0; j < s->n_variables; j++) rank += PetscAbsReal(index[j].slope) > PetscAbsReal(v->slope);
      PetscCall(ResultsTableRow(
        table, "%s,\"%s\",%s,%s,%s,%s,%s,%s,%d,%s,%s,%s,%s", b == s->nominal.n ? "any" : SampleNumber(b + 1).text,
        s->branch[b].label, which ? "growth_rad_s" : "freq_hz", s->variable[k].name, SampleNumber(v->first).text,
        SampleNumber(v->first_error).text, SampleNumber(v->total).text, SampleNumber(v->total_error).text, (int)n_rows,
        SampleNumber(v->slope).text, SampleNumber(v->slope_error).text,
        SampleNumber(PetscIsNanReal(v->slope) ? NAN : rank).text, SampleNumber(r_squared).text));
    }
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode IndicesWrite(Sample s, Results results)
{
  ResultsTable table;
  PetscReal   *value;

  PetscFunctionBeginUser;
  PetscCall(ResultsTableOpen(results, "indices",
                             "branch,label,of,variable,first,first_error,total,total_error,rows,slope,slope_error,rank,"
                             "r_squared",
                             &table));
  PetscCall(PetscMalloc1(s->n_points, &value));
  for (PetscInt b = 0; b <= s->nominal.n; b++)
    if (s->branch[b].frequency.n) PetscCall(IndexRows(s, b, value, table));
  PetscCall(PetscFree(value));
  PetscCall(ResultsTableClose(&table));
  PetscFunctionReturn(0);
}

/* Samples beside full solutions */
static PetscErrorCode SamplesVerifyWrite(Sample s, Results results)
{
  ResultsTable table;

  PetscFunctionBeginUser;
  if (!s->n_verify) PetscFunctionReturn(0);
  PetscCall(ResultsTableOpen(results, s->file[0] ? "conditions_verify" : "samples_verify",
                             s->file[0] ? "condition," VERIFY_COLUMNS : "sample," VERIFY_COLUMNS, &table));
  for (PetscInt k = 0; k < s->n_verify; k++) {
    const FullCheck *c = &s->check[k].found;

    PetscCall(ResultsTableRow(table, "%d,%d,%d,%d,%d,%.15g,%.15g,%.15g,%.15g,%d,%.15g,%s,%d",
                              (int)SampleVerified(s, k) + 1, (int)c->n_full, (int)c->n_reduced, (int)c->n_unstable_full,
                              (int)c->n_unstable_reduced, (double)c->error, (double)c->estimate,
                              (double)(c->omega / (2 * PETSC_PI)), (double)c->full, (int)c->n_beyond, (double)c->ratio,
                              SampleNumber(s->check[k].n_closed < 0 ? NAN : (PetscReal)s->check[k].n_closed).text,
                              (int)s->check[k].same_status));
  }
  PetscCall(ResultsTableClose(&table));
  PetscFunctionReturn(0);
}

/* Sample i; behind them the scene's own values */
static PetscErrorCode SamplePlace(void *ctx, PetscInt i, PetscReal p[])
{
  const Sample s = ctx;

  PetscFunctionBeginUser;
  if (i < s->n)
    PetscCall(SampleParameters(s, i, p));
  else
    PetscCall(PetscArraycpy(p, s->box.nominal, s->box.n_parameters));
  PetscFunctionReturn(0);
}

/* The model, for the page, over what the samples have */
static PetscErrorCode SampleModelWrite(Sample s, Results results)
{
  PetscInt   n = 0, *parameter, *variable;
  PetscReal *lower, *upper, *p;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < s->n_variables; k++) n += s->variable[k].n_names;
  PetscCall(PetscMalloc5(n, &parameter, n, &variable, n, &lower, n, &upper, s->box.n_parameters, &p));
  n = 0;
  for (PetscInt k = 0; k < s->n_variables; k++)
    for (PetscInt m = 0; m < s->variable[k].n_names; m++, n++) parameter[n] = s->variable[k].moved[m], variable[n] = k;
  for (PetscInt i = 0; i < s->n; i++) {
    PetscCall(SampleParameters(s, i, p));
    for (PetscInt j = 0; j < n; j++) {
      lower[j] = i ? PetscMin(lower[j], p[parameter[j]]) : p[parameter[j]];
      upper[j] = i ? PetscMax(upper[j], p[parameter[j]]) : p[parameter[j]];
    }
  }
  PetscCall(BoxExport(&s->box, &(BoxVaried){n, parameter, variable, lower, upper, s->n + 1, SamplePlace, s}, results));
  PetscCall(PetscFree5(parameter, variable, lower, upper, p));
  PetscFunctionReturn(0);
}

PetscErrorCode SampleWrite(Sample s, Results results)
{
  PetscFunctionBeginUser;
  PetscCall(SamplesVerifyWrite(s, results));
  if (s->file[0]) {
    PetscCall(ConditionsWrite(s, results));
  } else {
    PetscCall(SamplesWrite(s, results));
    PetscCall(ModesRows(s, results));
    PetscCall(ProbabilityWrite(s, results));
    PetscCall(IndicesWrite(s, results));
    PetscCall(SampleModelWrite(s, results));
  }
  PetscCall(SampleForget(s));
  PetscFunctionReturn(0);
}
