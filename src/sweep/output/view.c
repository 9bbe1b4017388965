/*
   What a person wants to know of a sweep: how it was made, where it is stable, the onsets, the errors.
*/
#include "sweep/sweepimpl.h"

#define MAX_STRETCHES 12 /* of one contact status, that are listed */

/* The full solutions behind the basis */
static PetscErrorCode SamplesView(Sweep sweep, const OperatorsParameter parameters[], PetscViewer viewer)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < sweep->greedy.n_samples; i++) {
    const GreedySample *s = &sweep->greedy.sample[i];

    PetscCall(PetscViewerASCIIPrintf(viewer, "  full solution %" PetscInt_FMT " at", i + 1));
    for (PetscInt k = 0; k < sweep->grid.n_axes; k++)
      PetscCall(PetscViewerASCIIPrintf(viewer, " %s %.6g", parameters[sweep->grid.parameter[k][0]].name,
                                       (double)s->p[sweep->grid.parameter[k][0]]));
    if (s->krylov)
      PetscCall(PetscViewerASCIIPrintf(viewer, ", eigensolver: %" PetscInt_FMT " vectors\n", s->n_vectors));
    else
      PetscCall(PetscViewerASCIIPrintf(viewer, ", corrections: estimate before %.1e, %" PetscInt_FMT " vectors\n",
                                       (double)s->estimate, s->n_vectors));
  }
  PetscFunctionReturn(0);
}

/* Which parameters move together */
static PetscErrorCode LinksView(Sweep sweep, const OperatorsParameter parameters[], PetscViewer viewer)
{
  const SweepGrid *grid = &sweep->grid;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < grid->n_axes; k++) {
    if (grid->n_moved[k] == 1) continue;
    PetscCall(PetscViewerASCIIPrintf(viewer, "%s and with it", parameters[grid->parameter[k][0]].name));
    for (PetscInt i = 1; i < grid->n_moved[k]; i++)
      PetscCall(PetscViewerASCIIPrintf(viewer, "%s %s", i > 1 ? "," : "", parameters[grid->parameter[k][i]].name));
    PetscCall(PetscViewerASCIIPrintf(viewer, " take the value of each point\n"));
  }
  PetscFunctionReturn(0);
}

/* Where each branch is unstable: smallest and largest value of the first parameter, and its largest growth */
static PetscErrorCode BranchesView(Sweep sweep, PetscViewer viewer)
{
  const SweepGrid *grid = &sweep->grid;

  PetscFunctionBeginUser;
  for (PetscInt b = 0; b < sweep->n_branches; b++) {
    PetscReal largest = 0, omega = 0, first = 0, last = 0;
    PetscInt  n = 0;

    for (PetscInt i = 0; i < GridSize(grid); i++)
      for (PetscInt k = 0; k < sweep->point[i].n; k++) {
        const SweepMode *m = &sweep->point[i].mode[k];

        if (m->branch != b || m->state != MODE_UNSTABLE) continue;
        first = n ? PetscMin(first, grid->value[0][i % grid->n[0]]) : grid->value[0][i % grid->n[0]];
        last  = n++ ? PetscMax(last, grid->value[0][i % grid->n[0]]) : first;
        if (m->sigma > largest) largest = m->sigma, omega = m->omega;
      }
    if (n)
      PetscCall(PetscViewerASCIIPrintf(viewer,
                                       "  branch %" PetscInt_FMT " %s: unstable at %" PetscInt_FMT
                                       " points, %.6g to %.6g, up to %.5g 1/s at %.2f Hz\n",
                                       b + 1, sweep->label[b].text, n, (double)first, (double)last, (double)largest,
                                       (double)(omega / (2 * PETSC_PI))));
  }
  PetscFunctionReturn(0);
}

/* Stretches of a line with one contact status: how many, or, with a viewer, pairs closed and ends of each */
static PetscErrorCode StretchesView(Sweep sweep, PetscViewer viewer, PetscInt *n)
{
  const SweepGrid  *grid  = &sweep->grid;
  const SweepPlace *place = grid->place;

  PetscFunctionBeginUser;
  *n = 0;
  for (PetscInt k = 0, last; k < grid->n_places; k = last + 1) {
    for (last = k; last + 1 < grid->n_places && place[last + 1].status == place[k].status;) last++;
    if (viewer)
      PetscCall(PetscViewerASCIIPrintf(viewer, "%s%" PetscInt_FMT "%s %s %.6g", k ? ", " : ": ",
                                       sweep->statuses.n_closed[place[k].status], k ? "" : " pairs closed",
                                       last > k ? "from" : "at", (double)place[k].value[0]));
    if (viewer && last > k) PetscCall(PetscViewerASCIIPrintf(viewer, " to %.6g", (double)place[last].value[0]));
    ++*n;
  }
  PetscFunctionReturn(0);
}

/* How the contact status depends on the parameters */
static PetscErrorCode StatusView(Sweep sweep, PetscViewer viewer)
{
  const StatusList *list = &sweep->statuses;
  PetscInt          n    = 1, least, most;
  PetscBool         changes;

  PetscFunctionBeginUser;
  if (!sweep->statics) PetscFunctionReturn(0);
  changes = SweepClosedRange(sweep, &least, &most);
  if (sweep->grid.n_axes == 1) PetscCall(StretchesView(sweep, NULL, &n));
  if (!changes) {
    PetscCall(PetscViewerASCIIPrintf(
      viewer, "sliding state: the same %" PetscInt_FMT " of %" PetscInt_FMT " pairs closed everywhere", least,
      list->n_pairs));
  } else if (sweep->grid.n_axes > 1 || n > MAX_STRETCHES) {
    PetscCall(PetscViewerASCIIPrintf(viewer,
                                     "sliding state: contact status changes, %" PetscInt_FMT
                                     " different ones with %" PetscInt_FMT " to %" PetscInt_FMT " of %" PetscInt_FMT
                                     " pairs closed",
                                     list->n, least, most, list->n_pairs));
  } else {
    PetscCall(PetscViewerASCIIPrintf(viewer, "sliding state: contact status changes %" PetscInt_FMT " time%s", n - 1,
                                     n == 2 ? "" : "s"));
    PetscCall(StretchesView(sweep, viewer, &n));
    PetscCall(PetscViewerASCIIPrintf(viewer, " (of %" PetscInt_FMT ")", list->n_pairs));
  }
  if (sweep->method != SWEEP_FULL)
    PetscCall(PetscViewerASCIIPrintf(
      viewer, "; %" PetscInt_FMT " static solutions, %" PetscInt_FMT " groups of pairs as further parameters",
      sweep->n_static, sweep->grid.n_groups));
  PetscCall(PetscViewerASCIIPrintf(viewer, "\n"));
  PetscFunctionReturn(0);
}

/* True errors beside their estimates */
static PetscErrorCode ChecksView(Sweep sweep, PetscViewer viewer)
{
  PetscReal error = 0, estimate = 0;
  PetscInt  missed = 0, n = 0, n_beyond = 0;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < sweep->n_checks; i++) {
    const FullCheck *c = &sweep->check[i].found;

    error    = PetscMax(error, c->error);
    estimate = PetscMax(estimate, c->estimate);
    n += c->n_full;
    n_beyond += c->n_beyond;
    if (c->n_full != c->n_reduced || c->n_unstable_full != c->n_unstable_reduced) missed++;
  }
  if (sweep->n_checks)
    PetscCall(PetscViewerASCIIPrintf(viewer,
                                     "checked by %" PetscInt_FMT
                                     " full solutions between the points: largest true error %.1e (estimate %.1e), "
                                     "%" PetscInt_FMT " of %" PetscInt_FMT " modes beyond what is stated; "
                                     "%" PetscInt_FMT " with another number of modes or instabilities\n",
                                     sweep->n_checks, (double)error, (double)estimate, n_beyond, n, missed));
  PetscFunctionReturn(0);
}

/* What the reduced model is made of, and what it saves */
static PetscErrorCode BasisView(Sweep sweep, PetscViewer viewer)
{
  PetscFunctionBeginUser;
  if (sweep->whole)
    PetscCall(PetscViewerASCIIPrintf(viewer, "basis of all %" PetscInt_FMT " unknowns: no error but rounding\n",
                                     sweep->basis.reduced.n_used));
  else if (sweep->method == SWEEP_REDUCED)
    PetscCall(PetscViewerASCIIPrintf(viewer,
                                     "basis of %" PetscInt_FMT " vectors; largest estimated error %.1e (an estimate, "
                                     "not a bound); modes counted without friction at the full solutions\n",
                                     sweep->basis.reduced.n_used, (double)sweep->greedy.worst));
  if (sweep->method == SWEEP_REDUCED && !sweep->whole && GridSize(&sweep->grid) > sweep->greedy.n_samples)
    PetscCall(PetscViewerASCIIPrintf(
      viewer, "saved: %" PetscInt_FMT " full solutions of the %" PetscInt_FMT " points, by the basis\n",
      GridSize(&sweep->grid) - sweep->greedy.n_samples, GridSize(&sweep->grid)));
  PetscFunctionReturn(0);
}

/* How far branches were followed from point to point */
static PetscErrorCode FollowView(Sweep sweep, PetscViewer viewer)
{
  PetscBool affine = PETSC_TRUE;

  PetscFunctionBeginUser;
  if (!sweep->n_branches && sweep->method == SWEEP_FULL)
    PetscCall(PetscViewerASCIIPrintf(viewer, "branches and onsets: not followed without left vectors (-modes_left)\n"));
  if (!sweep->n_broken) PetscFunctionReturn(0);
  if (sweep->statics) PetscCall(StaticsIsAffine(sweep->statics, &affine));
  PetscCall(
    PetscViewerASCIIPrintf(viewer,
                           "branches that end since the step is too large to tell which mode goes on: %" PetscInt_FMT
                           "; finer -sweep_values%s follow them\n",
                           sweep->n_broken, affine ? ", or -sweep_method reduced," : ""));
  PetscFunctionReturn(0);
}

PetscErrorCode SweepView(Sweep sweep, PetscViewer viewer)
{
  const OperatorsParameter *parameters;
  PetscInt                  n, n_unstable = 0, n_neutral = 0, n_numerical = 0;

  PetscFunctionBeginUser;
  PetscCall(OperatorsGetParameters(sweep->operators, &n, &parameters));
  for (PetscInt i = 0; i < GridSize(&sweep->grid); i++)
    for (PetscInt k = 0; k < sweep->point[i].n; k++) {
      n_unstable += sweep->point[i].mode[k].state == MODE_UNSTABLE;
      n_neutral += sweep->point[i].mode[k].state == MODE_NEUTRAL;
      n_numerical += sweep->point[i].mode[k].numerical;
    }
  PetscCall(LinksView(sweep, parameters, viewer));
  PetscCall(StatusView(sweep, viewer));
  PetscCall(BranchesView(sweep, viewer));
  if (sweep->is_confirmed) PetscCall(SweepViewOnsets(sweep, &parameters[sweep->grid.parameter[0][0]], viewer));
  PetscCall(ChecksView(sweep, viewer));
  PetscCall(PetscViewerASCIIPrintf(viewer,
                                   "%" PetscInt_FMT " points, %" PetscInt_FMT " branches, %" PetscInt_FMT
                                   " unstable eigenvalues, %" PetscInt_FMT " more numerical only",
                                   GridSize(&sweep->grid), sweep->n_branches, n_unstable, n_numerical));
  if (n_neutral) PetscCall(PetscViewerASCIIPrintf(viewer, ", %" PetscInt_FMT " neutral", n_neutral));
  PetscCall(PetscViewerASCIIPrintf(viewer, "\n"));
  if (sweep->method == SWEEP_FULL) PetscCall(FollowView(sweep, viewer));
  PetscCall(SamplesView(sweep, parameters, viewer));
  PetscCall(BasisView(sweep, viewer));
  if (sweep->is_confirmed && sweep->method != SWEEP_FULL) PetscCall(SweepViewOnsetCost(sweep, viewer));
  PetscCall(PetscViewerASCIIPrintf(viewer, "time: basis %.2f s, points %.2f s, onsets %.2f s, checks %.2f s",
                                   sweep->seconds[0], sweep->seconds[1], sweep->seconds[2], sweep->seconds[3]));
  if (sweep->statics) PetscCall(PetscViewerASCIIPrintf(viewer, ", contact status %.2f s", sweep->seconds[4]));
  PetscCall(PetscViewerASCIIPrintf(viewer, "\n"));
  PetscFunctionReturn(0);
}
