/* The tables of conditions: all their modes, and how many of them squeal in each frequency band */
#include "sample/sampleimpl.h"
#include "base/text.h"

/* Heads of the columns of the file behind the fixed ones */
static PetscErrorCode ConditionsHead(Sample s, size_t size, char columns[])
{
  PetscFunctionBeginUser;
  PetscCall(PetscStrncpy(columns,
                         "condition,name,branch,label,freq_hz,growth_rad_s,error_rad_s,damping_ratio,class,n_closed,"
                         "direction",
                         size));
  for (PetscInt c = 0; c < s->conditions.n_columns; c++) {
    PetscCall(TextAdd(columns, ",", size));
    PetscCall(TextAdd(columns, s->conditions.head[c], size));
  }
  PetscFunctionReturn(0);
}

/* The row of a mode of condition i; values are those of the file, as text */
static PetscErrorCode ConditionRow(Sample s, PetscInt i, const SampleMode *m, const char values[], ResultsTable table)
{
  const ConditionTable *t        = &s->conditions;
  const PetscInt        n_closed = BoxClosed(&s->box, i);

  PetscFunctionBeginUser;
  PetscCall(ResultsTableRow(table, "%d,\"%s\",%s,\"%s\",%.15g,%.15g,%.15g,%.15g,%s,%s,%d%s", (int)i + 1, t->name[i],
                            SampleNumber(m->branch < 0 ? NAN : m->branch + 1).text,
                            m->branch < 0 ? "" : s->branch[m->branch].label, (double)(m->omega / (2 * PETSC_PI)),
                            (double)m->sigma, (double)m->error,
                            (double)(m->omega > 0 ? 0 - m->sigma / hypot(m->sigma, m->omega) : 0),
                            ModeStateName(ModesLimitJudge(&s->box.limit, m->sigma, m->omega, m->error)),
                            SampleNumber(n_closed < 0 ? NAN : (PetscReal)n_closed).text, (int)t->direction[i], values));
  PetscFunctionReturn(0);
}

static PetscErrorCode ConditionsRows(Sample s, Results results)
{
  const ConditionTable *t = &s->conditions;
  ResultsTable          table;
  char                  columns[SAMPLE_MAX_TEXT];

  PetscFunctionBeginUser;
  PetscCall(ConditionsHead(s, sizeof(columns), columns));
  PetscCall(ResultsTableOpen(results, "conditions", columns, &table));
  for (PetscInt i = 0; i < t->n; i++) {
    char   values[SAMPLE_MAX_TEXT] = "";
    size_t n                       = 0;

    for (PetscInt c = 0; c < t->n_columns; c++)
      n += (size_t)snprintf(values + n, sizeof(values) - n, ",%.15g", (double)t->value[i * t->n_columns + c]);
    for (PetscInt k = 0; k < s->point[i].n; k++) PetscCall(ConditionRow(s, i, &s->point[i].mode[k], values, table));
  }
  PetscCall(ResultsTableClose(&table));
  PetscFunctionReturn(0);
}

/* The last band is that of all */
static PetscErrorCode BandsWrite(Sample s, Results results)
{
  ResultsTable table;

  PetscFunctionBeginUser;
  PetscCall(ResultsTableOpen(
    results, "conditions_bands",
    "freq_from_hz,freq_to_hz,conditions,occurrence_percent,open,modes,worst,growth_rad_s,freq_hz", &table));
  for (PetscInt b = 0; b < s->n_bands; b++) {
    const ConditionBand *band = &s->band[b];
    const PetscBool      any  = band->worst >= 0 ? PETSC_TRUE : PETSC_FALSE;

    PetscCall(ResultsTableRow(table, "%.15g,%.15g,%d,%.15g,%d,%d,\"%s\",%s,%s", (double)band->low, (double)band->high,
                              (int)band->n_conditions, 100.0 * (double)band->n_conditions / (double)s->n,
                              (int)band->n_open, (int)band->n_modes, any ? s->conditions.name[band->worst] : "",
                              SampleNumber(any ? band->growth : NAN).text,
                              SampleNumber(any ? band->frequency : NAN).text));
  }
  PetscCall(ResultsTableClose(&table));
  PetscFunctionReturn(0);
}

PetscErrorCode ConditionsWrite(Sample s, Results results)
{
  PetscFunctionBeginUser;
  PetscCall(ConditionsRows(s, results));
  PetscCall(BandsWrite(s, results));
  PetscFunctionReturn(0);
}

PetscErrorCode ConditionsView(Sample s, PetscViewer viewer)
{
  const ConditionBand *all = &s->band[s->n_bands - 1];

  PetscFunctionBeginUser;
  PetscCall(PetscViewerASCIIPrintf(viewer, "%" PetscInt_FMT " conditions of %s, %" PetscInt_FMT " of them unstable\n",
                                   s->n, s->file, all->n_conditions));
  for (PetscInt b = 0; b < s->n_bands - 1; b++) {
    const ConditionBand *band = &s->band[b];

    if (!band->n_conditions) continue;
    PetscCall(PetscViewerASCIIPrintf(
      viewer, "  %.6g to %.6g Hz: %" PetscInt_FMT " conditions, %.3g %%; fastest %.4g 1/s at %.2f Hz, condition %s\n",
      (double)band->low, (double)band->high, band->n_conditions, 100.0 * (double)band->n_conditions / (double)s->n,
      (double)band->growth, (double)band->frequency, s->conditions.name[band->worst]));
  }
  PetscFunctionReturn(0);
}
