/* The tables of designs, and what a person wants to know first */
#include "designimpl.h"
#include "base/text.h"

/* The designs: their parameters, and how many modes of all scenarios are unstable */
static PetscErrorCode PointsWrite(Design d, Results results)
{
  ResultsTable table;
  char         line[2 * CUBE_MAX_TEXT];
  PetscReal    row[13 + CUBE_MAX_VARIABLES];

  PetscFunctionBeginUser;
  PetscCall(PetscStrncpy(line,
                         "design,scenarios,unstable_scenarios,unstable_modes,excess_rad_s,freq_hz,change,mass_ratio,"
                         "solved,full_excess_rad_s,found,statuses,other_statuses",
                         sizeof(line)));
  for (PetscInt k = 0; k < d->cube.n; k++) {
    PetscCall(TextAdd(line, ",", sizeof(line)));
    PetscCall(TextAdd(line, d->cube.name[k], sizeof(line)));
  }
  PetscCall(ResultsTableOpen(results, "design", line, &table));
  for (PetscInt i = 0; i < d->n_points; i++) {
    const DesignPoint *p      = &d->point[i];
    const PetscReal    head[] = {(PetscReal)(i + 1),
                                 (PetscReal)d->n_scenarios,
                                 (PetscReal)p->n_scenarios,
                                 (PetscReal)p->n_unstable,
                                 p->excess,
                                 p->omega / (2 * PETSC_PI),
                                 p->change,
                                 p->mass,
                              p->solved ? 1 : 0,
                              p->solved ? p->full_excess : NAN,
                              d->found && i == d->best ? 1 : 0,
                                 (PetscReal)p->n_classes,
                                 (PetscReal)p->n_apart};

    PetscCall(PetscArraycpy(row, head, 13));
    for (PetscInt k = 0; k < d->cube.n; k++) row[13 + k] = CubeValue(&d->cube, k, p->z[k]);
    PetscCall(ResultsTableNumbers(table, 13 + d->cube.n, row));
  }
  PetscCall(ResultsTableClose(&table));
  PetscFunctionReturn(0);
}

/* The corners in full */
static PetscErrorCode CornersWrite(Design d, Results results)
{
  ResultsTable table;
  char         line[2 * CUBE_MAX_TEXT];
  PetscReal    row[7 + CUBE_MAX_VARIABLES];

  PetscFunctionBeginUser;
  if (!d->corner) PetscFunctionReturn(0);
  PetscCall(
    PetscStrncpy(line, "modes,unstable,excess_rad_s,freq_hz,growth_rad_s,error_rad_s,closed_pairs", sizeof(line)));
  for (PetscInt k = 0; k < d->uncertain.n; k++) {
    PetscCall(TextAdd(line, ",", sizeof(line)));
    PetscCall(TextAdd(line, d->uncertain.name[k], sizeof(line)));
  }
  PetscCall(ResultsTableOpen(results, "design_corners", line, &table));
  for (PetscInt i = 0; i < d->n_corners; i++) {
    const DesignCorner *c      = &d->corner[i];
    const PetscReal     head[] = {(PetscReal)c->n_modes,
                                  (PetscReal)c->n_unstable,
                                  c->excess,
                                  c->omega / (2 * PETSC_PI),
                                  c->sigma,
                                  c->error,
                              c->n_closed < 0 ? NAN : (PetscReal)c->n_closed};

    PetscCall(PetscArraycpy(row, head, 7));
    for (PetscInt k = 0; k < d->uncertain.n; k++) row[7 + k] = CubeValue(&d->uncertain, k, c->t[k]);
    PetscCall(ResultsTableNumbers(table, 7 + d->uncertain.n, row));
  }
  PetscCall(ResultsTableClose(&table));
  PetscFunctionReturn(0);
}

static PetscErrorCode DesignPlace(void *ctx, PetscInt i, PetscReal p[])
{
  const Design     d = ctx;
  const PetscReal *t = &d->known[i * (d->cube.n + d->uncertain.n)];

  PetscFunctionBeginUser;
  DesignParameters(d, t, &t[d->cube.n], p);
  BoxPutClass(&d->box, d->known_status[i], p);
  PetscFunctionReturn(0);
}

/* The model over both boxes, for the page */
static PetscErrorCode DesignWriteModel(Design d, Results results)
{
  PetscInt  parameter[2 * CUBE_MAX_MOVED], variable[2 * CUBE_MAX_MOVED], n;
  PetscReal lower[2 * CUBE_MAX_MOVED], upper[2 * CUBE_MAX_MOVED];
  BoxVaried varied = {0, parameter, variable, lower, upper, d->n_known, DesignPlace, d};

  PetscFunctionBeginUser;
  n        = CubeMoved(&d->cube, parameter, variable, lower, upper);
  varied.n = n + CubeMoved(&d->uncertain, &parameter[n], &variable[n], &lower[n], &upper[n]);
  for (PetscInt i = n; i < varied.n; i++) variable[i] += d->cube.n;
  PetscCall(BoxExport(&d->box, &varied, results));
  PetscFunctionReturn(0);
}

PetscErrorCode DesignWrite(Design d, Results results)
{
  PetscFunctionBeginUser;
  PetscCall(PointsWrite(d, results));
  PetscCall(CornersWrite(d, results));
  PetscCall(DesignWriteModel(d, results));
  PetscFunctionReturn(0);
}

/* The design that was found, or the best one, beside the scene */
static PetscErrorCode FoundView(Design d, const DesignPoint *last, PetscViewer viewer)
{
  PetscInt n_unstable = 0;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < d->cube.n; k++) {
    const PetscReal own = CubeValue(&d->cube, k, d->cube.own[k]), value = CubeValue(&d->cube, k, last->z[k]);

    PetscCall(PetscViewerASCIIPrintf(viewer, "  %s: %.6g for %.6g", d->cube.name[k], (double)value, (double)own));
    if (own != 0) PetscCall(PetscViewerASCIIPrintf(viewer, ", %+.3g %%", (double)(100 * (value / own - 1))));
    PetscCall(PetscViewerASCIIPrintf(viewer, "\n"));
  }
  for (PetscInt i = 0; d->corner && i < d->n_corners; i++) n_unstable += d->corner[i].n_unstable ? 1 : 0;
  if (d->found && d->n_corners)
    PetscCall(
      PetscViewerASCIIPrintf(viewer, "in full at %" PetscInt_FMT " corners of the box%s: %" PetscInt_FMT " unstable\n",
                             d->n_corners, d->n_corners > 1 << d->uncertain.n ? " and points inside" : "", n_unstable));
  if (d->n_rejected)
    PetscCall(PetscViewerASCIIPrintf(viewer,
                                     "%" PetscInt_FMT
                                     " of the designs, stable at all scenarios, had an unstable corner "
                                     "in full, which then was one more scenario, or called for more margin\n",
                                     d->n_rejected));
  PetscFunctionReturn(0);
}

/* Which contact statuses were looked at */
static PetscErrorCode DesignStateView(Design d, const DesignPoint *last, PetscViewer viewer)
{
  const StatusList *list  = &d->box.statuses;
  PetscInt          least = list->n_pairs, most = 0;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < d->box.n_classes; i++) {
    least = PetscMin(least, list->n_closed[i]);
    most  = PetscMax(most, list->n_closed[i]);
  }
  PetscCall(PetscViewerASCIIPrintf(viewer,
                                   "sliding state of each design at each scenario: %" PetscInt_FMT
                                   " statuses in both boxes, %" PetscInt_FMT " to %" PetscInt_FMT " of %" PetscInt_FMT
                                   " pairs closed",
                                   d->box.n_classes, least, most, list->n_pairs));
  if (last->n_apart)
    PetscCall(PetscViewerASCIIPrintf(viewer,
                                     "; at %" PetscInt_FMT
                                     " scenarios of this one it is another: the nearest, %" PetscInt_FMT
                                     " pairs apart at most, but for full solutions",
                                     last->n_apart, last->apart));
  PetscCall(PetscViewerASCIIPrintf(viewer, "\n"));
  PetscFunctionReturn(0);
}

PetscErrorCode DesignView(Design d, PetscViewer viewer)
{
  const DesignPoint *first = &d->point[0], *best = &d->point[d->best];

  PetscFunctionBeginUser;
  PetscCall(PetscViewerASCIIPrintf(viewer,
                                   "the scene: %" PetscInt_FMT " of %" PetscInt_FMT
                                   " scenarios have an unstable mode, largest growth beyond the limit %.4g 1/s\n",
                                   first->n_scenarios, d->n_scenarios, (double)first->excess));
  if (d->found)
    PetscCall(
      PetscViewerASCIIPrintf(viewer,
                             "a design with %s%.4g %% unstable, by %" PetscInt_FMT
                             " designs; mass %+.3g %%, changes of %.3g of the half widths (root of the mean square)\n",
                             d->probability > 0 ? "at most " : "", (double)(100 * d->probability), d->n_points,
                             (double)(100 * (best->mass - 1)), (double)best->change));
  else
    PetscCall(PetscViewerASCIIPrintf(viewer,
                                     "no design was found in %" PetscInt_FMT
                                     " tries: the best one, number %" PetscInt_FMT ", has %" PetscInt_FMT
                                     " unstable scenarios, largest growth beyond the limit %.4g "
                                     "1/s%s; widen -design_percent, or raise -design_max or -design_starts\n",
                                     d->n_points, d->best + 1, best->n_scenarios, (double)best->excess,
                                     best->n_scenarios ? "" : ", but in full it has one"));
  if (d->n_elsewhere)
    PetscCall(PetscViewerASCIIPrintf(viewer,
                                     "looked at elsewhere: %" PetscInt_FMT
                                     " designs spread over the box, largest growth "
                                     "beyond the limit %.4g 1/s at the least bad one\n",
                                     d->n_elsewhere, (double)d->elsewhere));
  PetscCall(FoundView(d, best, viewer));
  if (d->box.statics) PetscCall(DesignStateView(d, best, viewer));
  if (d->box.whole)
    PetscCall(PetscViewerASCIIPrintf(viewer, "basis of all %" PetscInt_FMT " unknowns\n", d->box.basis.reduced.n_used));
  else
    PetscCall(PetscViewerASCIIPrintf(viewer,
                                     "basis of %" PetscInt_FMT " vectors from %" PetscInt_FMT " full solutions\n",
                                     d->box.basis.reduced.n_used, d->box.greedy.n_samples));
  PetscCall(PetscViewerASCIIPrintf(viewer,
                                   "time: basis %.2f s, designs %.2f s, corners %.2f s; %" PetscInt_FMT
                                   " full solutions, %" PetscInt_FMT " of them for the basis\n",
                                   d->seconds[0], d->seconds[1], d->seconds[2], d->n_full + d->box.greedy.n_samples,
                                   d->box.greedy.n_samples));
  PetscFunctionReturn(0);
}
