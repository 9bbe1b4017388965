/*
   The tables of a sweep: sweep.csv, onsets.csv, parameters.csv, and where asked for verify.csv and sensitivities.csv.
*/
#include "sweep/sweepimpl.h"
#include "sweep/box/box.h"
#include "base/text.h"

static const char *const event_kinds[] = {"lock_in", "lock_out", "divergence", "restabilisation", "jump"};
static const char *const by_damping[]  = {"negative_damping", "positive_damping"}; /* in place of the first two */

static const char *EventKind(const BranchEvent *event)
{
  const PetscBool is_two = event->kind == EVENT_LOCK_IN || event->kind == EVENT_LOCK_OUT ? PETSC_TRUE : PETSC_FALSE;

  return is_two && event->mechanism == MECHANISM_NEGATIVE_DAMPING ? by_damping[event->kind] : event_kinds[event->kind];
}

/* Number as text, empty where there is none */
typedef struct {
  char text[32];
} Number;

static Number NumberOrEmpty(PetscReal value)
{
  Number number = {""};

  if (!PetscIsInfOrNanReal(value)) (void)snprintf(number.text, sizeof(number.text), "%.15g", (double)value);
  return number;
}

/* Value of the second parameter on a line, empty where there is none */
static Number SecondValue(Sweep sweep, PetscInt line)
{
  return NumberOrEmpty(sweep->grid.n_axes == 2 ? sweep->grid.value[1][line] : NAN);
}

/* Distance of a point to the nearest onset of a branch, relative, or NaN. Growth near a lock-in goes as the square root
   of the distance of the parameter from its critical value, and so does the error bar there: hence it is listed. */
static PetscReal OnsetDistance(Sweep sweep, PetscInt point, PetscInt branch)
{
  const PetscReal value   = sweep->grid.value[0][point % sweep->grid.n[0]];
  PetscReal       nearest = NAN;

  for (PetscInt e = 0; e < sweep->events.n && sweep->onsets; e++) {
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
static PetscErrorCode PointRow(Sweep sweep, PetscInt i, const SweepMode *m, ResultsTable table)
{
  const PetscInt  n    = sweep->grid.n[0];
  const PetscReal size = hypot(m->sigma, m->omega), distance = m->branch < 0 ? NAN : OnsetDistance(sweep, i, m->branch);
  PetscBool       jump;
  const PetscInt  n_closed = SweepClosedAt(sweep, i, &jump);

  PetscFunctionBeginUser;
  PetscCall(ResultsTableRow(
    table, "%d,%.15g,%s,%.15g,%.15g,%s,%d,\"%s\",%s,%s,%s,%s,%s,%s,%d", (int)i + 1, (double)sweep->grid.value[0][i % n],
    NumberOrEmpty(m->branch < 0 ? NAN : m->branch + 1).text, (double)(m->omega / (2 * PETSC_PI)), (double)m->sigma,
    NumberOrEmpty(size > 0 ? m->error / size : NAN).text, (int)(m->state == MODE_UNSTABLE), m->label,
    SecondValue(sweep, i / n).text, m->numerical ? "numerical" : ModeStateName(m->state),
    NumberOrEmpty(m->error / (2 * PETSC_PI)).text, NumberOrEmpty(m->condition).text, NumberOrEmpty(distance).text,
    NumberOrEmpty(n_closed < 0 ? NAN : n_closed).text, (int)jump));
  PetscFunctionReturn(0);
}

static PetscErrorCode PointRows(Sweep sweep, ResultsTable table)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < GridSize(&sweep->grid); i++)
    for (PetscInt k = 0; k < sweep->point[i].n; k++) PetscCall(PointRow(sweep, i, &sweep->point[i].mode[k], table));
  PetscFunctionReturn(0);
}

static PetscErrorCode OnsetRows(Sweep sweep, ResultsTable table)
{
  const OperatorsParameter *parameters;
  PetscInt                  n;

  PetscFunctionBeginUser;
  PetscCall(OperatorsGetParameters(sweep->operators, &n, &parameters));
  for (PetscInt e = 0; e < sweep->events.n; e++) {
    const BranchEvent *event = &sweep->events.event[e];

    if (!event->found) continue;
    PetscCall(ResultsTableRow(
      table, "%s,%.15g,%.15g,%s,\"%s\",%.15g,%d,%s,%d,%s,%s", parameters[sweep->grid.parameter[0][0]].name,
      (double)event->critical, (double)(event->omega / (2 * PETSC_PI)), EventKind(event),
      sweep->label[event->branch[0]].text, (double)event->error, (int)event->branch[0] + 1,
      NumberOrEmpty(event->branch[1] < 0 ? NAN : event->branch[1] + 1).text, (int)sweep->is_confirmed[e],
      SecondValue(sweep, SweepEventLine(sweep, e)).text, MechanismName(event->mechanism, PETSC_FALSE)));
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode ParameterRows(Sweep sweep, ResultsTable table)
{
  const OperatorsParameter *parameters;
  PetscInt                  n;

  PetscFunctionBeginUser;
  PetscCall(OperatorsGetParameters(sweep->operators, &n, &parameters));
  for (PetscInt i = 0; i < n; i++) {
    const PetscInt  axis = GridAxisOf(&sweep->grid, i), first = axis < 0 ? -1 : sweep->grid.parameter[axis][0];
    const PetscBool swept = first == i ? PETSC_TRUE : PETSC_FALSE;

    PetscCall(ResultsTableRow(table, "%s,%.15g,%s,%d,%s", parameters[i].name, (double)sweep->grid.base[i],
                              parameters[i].unit, swept ? (int)axis + 1 : 0,
                              first >= 0 && !swept ? parameters[first].name : ""));
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode CheckRows(Sweep sweep, ResultsTable table)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < sweep->n_checks; i++) {
    const FullCheck *c = &sweep->check[i].found;

    PetscCall(
      ResultsTableRow(table, "%.15g,%s,%d,%d,%d,%d,%.15g,%s,%.15g,%.15g,%d,%s", (double)sweep->check[i].at.value[0],
                      NumberOrEmpty(sweep->grid.n_axes == 2 ? sweep->check[i].at.value[1] : NAN).text, (int)c->n_full,
                      (int)c->n_reduced, (int)c->n_unstable_full, (int)c->n_unstable_reduced, (double)c->error,
                      NumberOrEmpty(c->estimate).text, (double)(c->omega / (2 * PETSC_PI)), (double)c->full,
                      (int)c->n_beyond, NumberOrEmpty(sweep->method == SWEEP_REAL ? NAN : c->ratio).text));
  }
  PetscFunctionReturn(0);
}

/* Names of the parameters of an axis with + between, as one row */
static PetscErrorCode LinkName(const SweepGrid *grid, PetscInt axis, const OperatorsParameter parameters[], size_t size,
                               char name[])
{
  PetscFunctionBeginUser;
  name[0] = '\0';
  for (PetscInt i = 0; i < grid->n_moved[axis]; i++) {
    PetscCall(TextAdd(name, i ? "+" : "", size));
    PetscCall(TextAdd(name, parameters[grid->parameter[axis][i]].name, size));
  }
  PetscFunctionReturn(0);
}

/* A row: derivative d of an eigenvalue by a parameter of value p */
static PetscErrorCode DerivativeRow(const char row[], const char name[], PetscReal p, PetscComplex d,
                                    ResultsTable table)
{
  PetscFunctionBeginUser;
  PetscCall(ResultsTableRow(table, "%s,%s,%.15g,%.15g,%.15g,%.15g", row, name, (double)(cimag(d) / (2 * PETSC_PI)),
                            (double)creal(d), (double)(0.01 * p * cimag(d) / (2 * PETSC_PI)),
                            (double)(0.01 * p * creal(d))));
  PetscFunctionReturn(0);
}

/* Rows of one mode: derivatives by every parameter, per unit and per percent of its value; then along each axis of
   linked parameters, the sum of theirs */
static PetscErrorCode ModeSensitivityRows(Sweep sweep, PetscInt point, const PetscReal p[], const ReducedModes *modes,
                                          PetscInt i, ResultsTable table)
{
  const OperatorsParameter *parameters;
  const SweepGrid          *grid = &sweep->grid;
  PetscInt                  n, near = 0;
  PetscComplex             *d;
  char                      row[128], name[1024];

  PetscFunctionBeginUser;
  PetscCall(PencilGetParameters(sweep->pencil, &n, &parameters, NULL));
  PetscCall(PetscMalloc1(n, &d));
  PetscCall(ReducedSensitivity(&sweep->basis.reduced, p, modes, i, d));
  for (PetscInt k = 0; k < sweep->point[point].n; k++) {
    const SweepMode *m = &sweep->point[point].mode[k], *best = &sweep->point[point].mode[near];

    if (cabs(CMPLX(m->sigma, m->omega) - modes->lambda[i]) < cabs(CMPLX(best->sigma, best->omega) - modes->lambda[i]))
      near = k;
  }
  PetscCall(PetscSNPrintf(row, sizeof(row), "%d,%.15g,%d,%.15g", (int)point + 1, (double)p[grid->parameter[0][0]],
                          (int)sweep->point[point].mode[near].branch + 1,
                          (double)(cimag(modes->lambda[i]) / (2 * PETSC_PI))));
  for (PetscInt j = 0; j < n; j++)
    if (!parameters[j].internal && !parameters[j].state)
      PetscCall(DerivativeRow(row, parameters[j].name, p[j], d[j], table));
  for (PetscInt k = 0; k < grid->n_axes; k++) {
    PetscComplex sum   = 0;
    PetscBool    loads = PETSC_TRUE; /* and the like, on which no matrix depends */

    for (PetscInt m = 0; m < grid->n_moved[k]; m++) {
      sum += d[grid->parameter[k][m]];
      if (!parameters[grid->parameter[k][m]].state) loads = PETSC_FALSE;
    }
    if (grid->n_moved[k] == 1 || loads) continue;
    PetscCall(LinkName(grid, k, parameters, sizeof(name), name));
    PetscCall(DerivativeRow(row, name, p[grid->parameter[k][0]], sum, table));
  }
  PetscCall(PetscFree(d));
  PetscFunctionReturn(0);
}

static PetscErrorCode SensitivityRows(Sweep sweep, ResultsTable table)
{
  PetscReal *p;

  PetscFunctionBeginUser;
  if (!sweep->basis.reduced.n) PetscFunctionReturn(0);
  PetscCall(PetscMalloc1(sweep->grid.n_parameters, &p));
  for (PetscInt i = 0; i < GridSize(&sweep->grid); i++) {
    ReducedModes modes;

    GridPoint(&sweep->grid, i, p);
    PetscCall(ReducedSolve(&sweep->basis.reduced, p, &sweep->window, &modes));
    for (PetscInt k = 0; k < modes.n && sweep->point[i].n; k++)
      PetscCall(ModeSensitivityRows(sweep, i, p, &modes, k, table));
    PetscCall(ReducedModesDestroy(&modes));
  }
  PetscCall(PetscFree(p));
  PetscFunctionReturn(0);
}

/* A table */
typedef struct {
  const char *name, *columns;
  PetscErrorCode (*rows)(Sweep sweep, ResultsTable table);
} SweepTable;

static PetscErrorCode TableWrite(Sweep sweep, Results results, const SweepTable *t)
{
  ResultsTable table;

  PetscFunctionBeginUser;
  PetscCall(ResultsTableOpen(results, t->name, t->columns, &table));
  PetscCall(t->rows(sweep, table));
  PetscCall(ResultsTableClose(&table));
  PetscFunctionReturn(0);
}

static const SweepTable point_table = {
  "sweep",
  "point,value,branch,freq_hz,growth_rad_s,error_estimate,unstable,label,value_2,"
  "class,error_hz,condition,onset_distance,n_closed,jump",
  PointRows,
};

static const SweepTable parameter_table = {
  "parameters",
  "parameter,value,unit,swept,link",
  ParameterRows,
};

static const SweepTable onset_table = {
  "onsets",
  "parameter,critical_value,freq_hz,kind,label,error_estimate,branch,partner,"
  "confirmed,value_2,mechanism",
  OnsetRows,
};

static const SweepTable check_table = {
  "verify",
  "value,value_2,modes_full,modes_reduced,unstable_full,unstable_reduced,"
  "true_error,error_estimate,freq_hz,full_error,modes_beyond_error,worst_ratio",
  CheckRows,
};

static const SweepTable sensitivity_table = {
  "sensitivities",
  "point,value,branch,freq_hz,parameter,freq_hz_per_unit,"
  "growth_rad_s_per_unit,freq_hz_per_percent,growth_rad_s_per_percent",
  SensitivityRows,
};

static PetscErrorCode SweepModelPlace(void *ctx, PetscInt i, PetscReal p[])
{
  const SweepGrid *grid = ctx;

  PetscFunctionBeginUser;
  GridFill(grid, &grid->place[i], p);
  PetscFunctionReturn(0);
}

/* The reduced model over the ranges of the axes, for the page; none where a value of an axis is the only one */
static PetscErrorCode SweepWriteModel(Sweep sweep, Results results)
{
  SweepGrid *grid      = &sweep->grid;
  Box        box       = {.comm         = sweep->comm,
                          .operators    = sweep->operators,
                          .nominal      = grid->base,
                          .n_parameters = grid->n_parameters,
                          .window       = sweep->window,
                          .limit        = sweep->limit,
                          .statuses     = sweep->statuses,
                          .groups_of    = {.n_groups = grid->n_groups, .closed = grid->closed}};
  BoxVaried  varied    = {.n_points = grid->n_places, .get = SweepModelPlace, .ctx = grid};
  PetscInt  *parameter = NULL, *axis = NULL, n = 0;
  PetscReal *ends = NULL;

  PetscFunctionBeginUser;
  for (PetscInt a = 0; a < grid->n_axes; a++) {
    if (grid->n[a] < 2) PetscFunctionReturn(0);
    n += grid->n_moved[a];
  }
  PetscCall(PetscMalloc3(n, &parameter, n, &axis, 2 * n, &ends));
  for (PetscInt a = 0; a < grid->n_axes; a++)
    for (PetscInt m = 0; m < grid->n_moved[a]; m++, varied.n++) {
      parameter[varied.n] = grid->parameter[a][m];
      axis[varied.n]      = a;
      ends[varied.n] = ends[n + varied.n] = grid->value[a][0];
      for (PetscInt i = 1; i < grid->n[a]; i++) {
        ends[varied.n]     = PetscMin(ends[varied.n], grid->value[a][i]);
        ends[n + varied.n] = PetscMax(ends[n + varied.n], grid->value[a][i]);
      }
    }
  varied.parameter = parameter, varied.variable = axis, varied.lower = ends, varied.upper = ends + n;
  box.basis = sweep->basis;
  PetscCall(BoxExport(&box, &varied, results));
  PetscCall(PetscFree3(parameter, axis, ends));
  PetscFunctionReturn(0);
}

PetscErrorCode SweepWrite(Sweep sweep, Results results)
{
  PetscFunctionBeginUser;
  PetscCall(TableWrite(sweep, results, &point_table));
  PetscCall(TableWrite(sweep, results, &parameter_table));
  if (sweep->is_confirmed) PetscCall(TableWrite(sweep, results, &onset_table));
  if (sweep->n_checks) PetscCall(TableWrite(sweep, results, &check_table));
  if (sweep->sensitivities && sweep->basis.reduced.n) PetscCall(TableWrite(sweep, results, &sensitivity_table));
  if (sweep->method != SWEEP_FULL && sweep->basis.reduced.n) PetscCall(SweepWriteModel(sweep, results));
  PetscCall(SweepForget(sweep));
  PetscFunctionReturn(0);
}
