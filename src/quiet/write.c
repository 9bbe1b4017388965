/* The tables of quiet boxes, and what a person wants to know first */
#include "quietimpl.h"
#include "base/text.h"

/* Growth, frequency and the like, empty where there is none */
typedef struct {
  char text[32];
} QuietText;

static QuietText TextOf(PetscReal value)
{
  QuietText number = {""};

  if (!PetscIsInfOrNanReal(value) && value < PETSC_MAX_REAL && value > -PETSC_MAX_REAL)
    (void)snprintf(number.text, sizeof(number.text), "%.15g", (double)value);
  return number;
}

/* Lower and upper end of a variable in the largest quiet box; of the parts, in the box that was given */
static void QuietEnds(const Quiet q, PetscInt k, PetscReal end[2])
{
  const PetscReal own = q->cube.own[k], size = q->goal == QUIET_BOX ? q->size : 1;

  end[0] = CubeValue(&q->cube, k, own - size * (own + 1));
  end[1] = CubeValue(&q->cube, k, own + size * (1 - own));
}

/* A row for each variable, then one of the whole: sizes, margin, error, the nearest dangerous point */
static PetscErrorCode BoundsWrite(Quiet q, Results results)
{
  const DangerPoint *d = &q->danger;
  ResultsTable       table;
  PetscReal          end[2];

  PetscFunctionBeginUser;
  PetscCall(ResultsTableOpen(results, "quiet", "variable,own,lower,upper,quiet_lower,quiet_upper,danger", &table));
  for (PetscInt k = 0; k < q->cube.n; k++) {
    QuietEnds(q, k, end);
    PetscCall(ResultsTableRow(table, "%s,%.15g,%.15g,%.15g,%.15g,%.15g,%s", q->cube.name[k],
                              (double)CubeValue(&q->cube, k, q->cube.own[k]), (double)CubeValue(&q->cube, k, -1),
                              (double)CubeValue(&q->cube, k, 1), (double)end[0], (double)end[1],
                              TextOf(d->found ? CubeValue(&q->cube, k, d->t[k]) : NAN).text));
  }
  PetscCall(ResultsTableClose(&table));
  PetscFunctionReturn(0);
}

/* What is stated, in one row */
static PetscErrorCode StatementWrite(Quiet q, Results results)
{
  static const char *const goals[] = {[QUIET_BOX] = "box", [QUIET_PARTS] = "parts"};
  const DangerPoint       *d       = &q->danger;
  const QuietChecks       *c       = &q->checks;
  ResultsTable             table;

  PetscFunctionBeginUser;
  PetscCall(
    ResultsTableOpen(results, "quiet_statement",
                     "goal,size,quiet_share,dangerous_share,open_share,margin_rad_s,error,danger_distance,"
                     "danger_label,danger_freq_hz,danger_growth_rad_s,danger_error_rad_s,confirmed,full_freq_hz,"
                     "full_growth_rad_s,full_error_rad_s,cells,random,random_unstable,random_growth_rad_s,"
                     "full,full_unstable,full_true_error,full_modes_beyond_error,full_other_status,"
                     "closed_pairs,status_points,other_status,other_pairs,other_distance",
                     &table));
  PetscCall(ResultsTableRow(
    table,
    "%s,%.15g,%.15g,%.15g,%.15g,%s,%.15g,%s,\"%s\",%s,%s,%s,%s,%s,%s,%s,%d,%d,%d,%s,%d,%d,%.15g,%d,%d,"
    "%s,%d,%d,%d,%s",
    goals[q->goal], (double)q->size, (double)q->share[CELL_QUIET], (double)q->share[CELL_DANGEROUS],
    (double)q->share[CELL_OPEN], TextOf(q->margin).text, (double)PetscMax(q->error, c->error),
    TextOf(d->found ? d->distance : NAN).text, d->label, TextOf(d->found ? d->omega / (2 * PETSC_PI) : NAN).text,
    TextOf(d->found ? d->sigma : NAN).text, TextOf(d->found ? d->error : NAN).text,
    !d->found      ? ""
    : d->confirmed ? "yes"
                   : "no",
    TextOf(d->confirmed ? d->full_omega / (2 * PETSC_PI) : NAN).text, TextOf(d->confirmed ? d->full_sigma : NAN).text,
    TextOf(d->confirmed ? d->full_error : NAN).text, (int)q->n_tested, (int)c->n, (int)c->n_unstable,
    TextOf(c->growth).text, (int)c->n_full, (int)c->n_full_unstable, (double)c->true_error, (int)c->n_beyond,
    (int)c->n_full_other, TextOf(q->box.statics ? (PetscReal)BoxClosed(&q->box, 0) : NAN).text, (int)q->n_status,
    (int)q->n_other, (int)q->apart, TextOf(q->n_other ? q->other_distance : NAN).text));
  PetscCall(ResultsTableClose(&table));
  PetscFunctionReturn(0);
}

/* All cells that are left: their ends, and what is known of them */
static PetscErrorCode CellsWrite(Quiet q, Results results)
{
  static const char *const states[] = {[CELL_OPEN] = "open", [CELL_QUIET] = "quiet", [CELL_DANGEROUS] = "dangerous"};
  ResultsTable             table;
  char                     line[3 * CUBE_MAX_TEXT] = ""; /* each name twice */

  PetscFunctionBeginUser;
  PetscCall(PetscStrncpy(line, "state,margin_rad_s,growth_rad_s", sizeof(line)));
  for (PetscInt k = 0; k < q->cube.n; k++) {
    PetscCall(TextAdd(line, ",lower_", sizeof(line)));
    PetscCall(TextAdd(line, q->cube.name[k], sizeof(line)));
    PetscCall(TextAdd(line, ",upper_", sizeof(line)));
    PetscCall(TextAdd(line, q->cube.name[k], sizeof(line)));
  }
  PetscCall(ResultsTableOpen(results, "quiet_cells", line, &table));
  for (PetscInt i = 0; i < q->n_cells; i++) {
    const QuietCell *cell   = &q->cell[i];
    size_t           length = 0;

    if (cell->split) continue;
    for (PetscInt k = 0; k < q->cube.n; k++)
      length +=
        (size_t)snprintf(line + length, sizeof(line) - length, ",%.15g,%.15g",
                         (double)CubeValue(&q->cube, k, cell->low[k]), (double)CubeValue(&q->cube, k, cell->high[k]));
    PetscCall(ResultsTableRow(table, "%s,%s,%s%s", states[cell->state],
                              TextOf(cell->state == CELL_QUIET ? cell->margin : NAN).text,
                              TextOf(cell->axis < 0 ? NAN : cell->growth).text, line));
  }
  PetscCall(ResultsTableClose(&table));
  PetscFunctionReturn(0);
}

/* The model, for the page */
static PetscErrorCode ModelWrite(Quiet q, Results results)
{
  PetscInt  parameter[CUBE_MAX_MOVED], variable[CUBE_MAX_MOVED];
  PetscReal lower[CUBE_MAX_MOVED], upper[CUBE_MAX_MOVED];
  BoxVaried varied = {.parameter = parameter, .variable = variable, .lower = lower, .upper = upper};

  PetscFunctionBeginUser;
  varied.n = CubeMoved(&q->cube, parameter, variable, lower, upper);
  PetscCall(BoxExport(&q->box, &varied, results));
  PetscFunctionReturn(0);
}

PetscErrorCode QuietWrite(Quiet q, Results results)
{
  PetscFunctionBeginUser;
  PetscCall(BoundsWrite(q, results));
  PetscCall(StatementWrite(q, results));
  PetscCall(CellsWrite(q, results));
  PetscCall(ModelWrite(q, results));
  PetscFunctionReturn(0);
}
