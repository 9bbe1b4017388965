/*
   The tables of a sweep: sweep.csv, onsets.csv, parameters.csv, and where asked for verify.csv, robustness.csv and
   sensitivities.csv.
*/
#include "sweepimpl.h"

static const char *const table_kinds[] = {"lock_in", "lock_out", "divergence", "restabilisation", "jump"};

/* Number as text, empty where there is none */
static PetscErrorCode NumberOrEmpty(PetscReal value, char text[32])
{
  PetscFunctionBeginUser;
  text[0] = '\0';
  if (!PetscIsInfOrNanReal(value)) PetscCall(PetscSNPrintf(text, 32, "%.15g", (double)value));
  PetscFunctionReturn(0);
}

/* Distance of a point to the nearest onset of a branch, relative, or NaN. Growth near a lock-in goes as the square root
   of the distance of the parameter from its critical value, and so does the error bar there: hence it is listed. */
static PetscReal OnsetDistance(Sweep sweep, PetscInt point, PetscInt branch)
{
  const PetscReal value   = sweep->grid.value[0][point % sweep->grid.n[0]];
  PetscReal       nearest = NAN;

  for (PetscInt e = 0; e < sweep->events.n; e++) {
    const BranchEvent *event = &sweep->events.event[e];
    const PetscReal    distance =
      PetscAbsReal(value - event->critical) / PetscMax(PetscAbsReal(event->critical), PETSC_MACHINE_EPSILON);

    if (!event->found || SweepEventLine(sweep, e) != point / sweep->grid.n[0]) continue;
    if (event->branch[0] != branch && event->branch[1] != branch) continue;
    if (!(distance >= nearest)) nearest = distance;
  }
  return nearest;
}

/* One row of sweep.csv */
static PetscErrorCode SweepRowWrite(Sweep sweep, PetscInt i, const SweepMode *m, ResultsTable table)
{
  const SweepGrid *grid = &sweep->grid;
  const PetscReal  size = hypot(m->sigma, m->omega);
  char             error[32], error_hz[32], condition[32], distance[32], closed[32], second[32] = "", branch[32];
  PetscInt         n_closed;
  PetscBool        jump;

  PetscFunctionBeginUser;
  PetscCall(NumberOrEmpty(size > 0 ? m->error / size : NAN, error));
  PetscCall(NumberOrEmpty(m->error / (2 * PETSC_PI), error_hz));
  PetscCall(NumberOrEmpty(m->condition, condition));
  PetscCall(NumberOrEmpty(m->branch < 0 ? NAN : OnsetDistance(sweep, i, m->branch), distance));
  if (grid->n_axes == 2) PetscCall(NumberOrEmpty(grid->value[1][i / grid->n[0]], second));
  PetscCall(NumberOrEmpty(m->branch < 0 ? NAN : (PetscReal)(m->branch + 1), branch));
  PetscCall(SweepClosedAt(sweep, i, &n_closed, &jump));
  PetscCall(NumberOrEmpty(n_closed < 0 ? NAN : (PetscReal)n_closed, closed));
  PetscCall(ResultsTableRow(table, "%d,%.15g,%s,%.15g,%.15g,%s,%d,\"%s\",%s,%s,%s,%s,%s,%s,%d", (int)i + 1,
                            (double)grid->value[0][i % grid->n[0]], branch, (double)(m->omega / (2 * PETSC_PI)),
                            (double)m->sigma, error, (int)m->unstable, m->label, second,
                            m->unstable    ? "unstable"
                            : m->numerical ? "numerical"
                                           : "stable",
                            error_hz, condition, distance, closed, (int)jump));
  PetscFunctionReturn(0);
}

static PetscErrorCode SweepTableWrite(Sweep sweep, Results results)
{
  ResultsTable table;

  PetscFunctionBeginUser;
  PetscCall(
    ResultsTableOpen(results, "sweep",
                     "point,value,branch,freq_hz,growth_rad_s,error_estimate,unstable,label,value_2,class,error_"
                     "hz,condition,onset_distance,n_closed,jump",
                     &table));
  for (PetscInt i = 0; i < GridSize(&sweep->grid); i++)
    for (PetscInt k = 0; k < sweep->point[i].n; k++)
      PetscCall(SweepRowWrite(sweep, i, &sweep->point[i].mode[k], table));
  PetscCall(ResultsTableClose(&table));
  PetscFunctionReturn(0);
}

static PetscErrorCode OnsetTableWrite(Sweep sweep, Results results)
{
  const OperatorsParameter *parameters;
  PetscInt                  n;
  ResultsTable              table;

  PetscFunctionBeginUser;
  PetscCall(OperatorsGetParameters(sweep->operators, &n, &parameters));
  PetscCall(ResultsTableOpen(
    results, "onsets", "parameter,critical_value,freq_hz,kind,label,error_estimate,branch,partner,confirmed,value_2",
    &table));
  for (PetscInt e = 0; e < sweep->events.n; e++) {
    const BranchEvent *event = &sweep->events.event[e];
    char               partner[32], second[32] = "";

    if (!event->found) continue;
    PetscCall(NumberOrEmpty(event->branch[1] < 0 ? NAN : (PetscReal)(event->branch[1] + 1), partner));
    if (sweep->grid.n_axes == 2) PetscCall(NumberOrEmpty(sweep->grid.value[1][SweepEventLine(sweep, e)], second));
    PetscCall(ResultsTableRow(table, "%s,%.15g,%.15g,%s,\"%s\",%.15g,%d,%s,%d,%s",
                              parameters[sweep->grid.parameter[0]].name, (double)event->critical,
                              (double)(event->omega / (2 * PETSC_PI)), table_kinds[event->kind],
                              sweep->label[event->branch[0]].text, (double)event->error, (int)event->branch[0] + 1,
                              partner, (int)sweep->is_confirmed[e], second));
  }
  PetscCall(ResultsTableClose(&table));
  PetscFunctionReturn(0);
}

static PetscErrorCode ParameterTableWrite(Sweep sweep, Results results)
{
  const OperatorsParameter *parameters;
  PetscInt                  n;
  ResultsTable              table;

  PetscFunctionBeginUser;
  PetscCall(OperatorsGetParameters(sweep->operators, &n, &parameters));
  PetscCall(ResultsTableOpen(results, "parameters", "parameter,value,unit,swept", &table));
  for (PetscInt i = 0; i < n; i++) {
    int swept = 0;

    for (PetscInt k = 0; k < sweep->grid.n_axes; k++)
      if (sweep->grid.parameter[k] == i) swept = (int)k + 1;
    PetscCall(ResultsTableRow(table, "%s,%.15g,%s,%d", parameters[i].name, (double)sweep->grid.base[i],
                              parameters[i].unit, swept));
  }
  PetscCall(ResultsTableClose(&table));
  PetscFunctionReturn(0);
}

static PetscErrorCode CheckTableWrite(Sweep sweep, Results results)
{
  ResultsTable table;

  PetscFunctionBeginUser;
  PetscCall(ResultsTableOpen(results, "verify",
                             "value,value_2,modes_full,modes_reduced,unstable_full,unstable_reduced,true_error,"
                             "error_estimate,freq_hz,full_error",
                             &table));
  for (PetscInt i = 0; i < sweep->n_checks; i++) {
    const SweepCheck *c          = &sweep->check[i];
    char              second[32] = "", estimate[32];

    if (sweep->grid.n_axes == 2) PetscCall(NumberOrEmpty(c->at.value[1], second));
    PetscCall(NumberOrEmpty(c->estimate, estimate));
    PetscCall(ResultsTableRow(table, "%.15g,%s,%d,%d,%d,%d,%.15g,%s,%.15g,%.15g", (double)c->at.value[0], second,
                              (int)c->n_full, (int)c->n_reduced, (int)c->n_unstable_full, (int)c->n_unstable_reduced,
                              (double)c->error, estimate, (double)(c->omega / (2 * PETSC_PI)), (double)c->full));
  }
  PetscCall(ResultsTableClose(&table));
  PetscFunctionReturn(0);
}

static PetscErrorCode RiskTableWrite(Sweep sweep, Results results)
{
  ResultsTable table;

  PetscFunctionBeginUser;
  PetscCall(
    ResultsTableOpen(results, "robustness",
                     "label,freq_hz,growth_nominal_rad_s,growth_largest_rad_s,error_rad_s,unstable_combinations,"
                     "combinations",
                     &table));
  for (PetscInt i = 0; i < sweep->n_risks; i++) {
    const SweepRisk *r = &sweep->risk[i];
    char             nominal[32];

    PetscCall(NumberOrEmpty(r->nominal, nominal));
    PetscCall(ResultsTableRow(table, "\"%s\",%.15g,%s,%.15g,%.15g,%d,%d", r->label, (double)(r->omega / (2 * PETSC_PI)),
                              nominal, (double)r->largest, (double)r->error, (int)r->n_unstable,
                              (int)sweep->n_combinations));
  }
  PetscCall(ResultsTableClose(&table));
  PetscFunctionReturn(0);
}

/* Rows of one mode: derivatives by every parameter, per unit and per percent of its value */
static PetscErrorCode SensitivityRows(Sweep sweep, PetscInt point, const PetscReal p[], const ReducedModes *modes,
                                      PetscInt i, ResultsTable table)
{
  const OperatorsParameter *parameters;
  PetscInt                  n, near = 0;
  PetscComplex             *d;

  PetscFunctionBeginUser;
  PetscCall(PencilGetParameters(sweep->pencil, &n, &parameters, NULL));
  PetscCall(PetscMalloc1(n, &d));
  PetscCall(ReducedSensitivity(&sweep->basis.reduced, p, modes, i, d));
  for (PetscInt k = 0; k < sweep->point[point].n; k++) {
    const SweepMode *m = &sweep->point[point].mode[k], *best = &sweep->point[point].mode[near];

    if (cabs(CMPLX(m->sigma, m->omega) - modes->lambda[i]) < cabs(CMPLX(best->sigma, best->omega) - modes->lambda[i]))
      near = k;
  }
  for (PetscInt j = 0; j < n && !parameters[j].internal; j++)
    PetscCall(ResultsTableRow(
      table, "%d,%.15g,%d,%.15g,%s,%.15g,%.15g,%.15g,%.15g", (int)point + 1, (double)p[sweep->grid.parameter[0]],
      (int)sweep->point[point].mode[near].branch + 1, (double)(cimag(modes->lambda[i]) / (2 * PETSC_PI)),
      parameters[j].name, (double)(cimag(d[j]) / (2 * PETSC_PI)), (double)creal(d[j]),
      (double)(0.01 * p[j] * cimag(d[j]) / (2 * PETSC_PI)), (double)(0.01 * p[j] * creal(d[j]))));
  PetscCall(PetscFree(d));
  PetscFunctionReturn(0);
}

static PetscErrorCode SensitivityTableWrite(Sweep sweep, Results results)
{
  PetscReal   *p;
  ResultsTable table;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(sweep->grid.n_parameters, &p));
  PetscCall(ResultsTableOpen(results, "sensitivities",
                             "point,value,branch,freq_hz,parameter,freq_hz_per_unit,growth_rad_s_per_unit,freq_hz_per_"
                             "percent,growth_rad_s_per_percent",
                             &table));
  for (PetscInt i = 0; i < GridSize(&sweep->grid); i++) {
    ReducedModes modes;

    GridPoint(&sweep->grid, i, p);
    PetscCall(ReducedSolve(&sweep->basis.reduced, p, &sweep->window, &modes));
    for (PetscInt k = 0; k < modes.n && sweep->point[i].n; k++)
      PetscCall(SensitivityRows(sweep, i, p, &modes, k, table));
    PetscCall(ReducedModesDestroy(&modes));
  }
  PetscCall(ResultsTableClose(&table));
  PetscCall(PetscFree(p));
  PetscFunctionReturn(0);
}

PetscErrorCode SweepWrite(Sweep sweep, Results results)
{
  PetscFunctionBeginUser;
  PetscCall(SweepTableWrite(sweep, results));
  PetscCall(ParameterTableWrite(sweep, results));
  if (sweep->is_confirmed) PetscCall(OnsetTableWrite(sweep, results));
  if (sweep->n_checks) PetscCall(CheckTableWrite(sweep, results));
  if (sweep->n_risks) PetscCall(RiskTableWrite(sweep, results));
  if (sweep->sensitivities && sweep->basis.reduced.n) PetscCall(SensitivityTableWrite(sweep, results));
  PetscCall(SweepForget(sweep));
  PetscFunctionReturn(0);
}
