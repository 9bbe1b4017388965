/* What quiet boxes tell a person */
#include "quietimpl.h"

/* The box in the variables' own units */
static PetscErrorCode BoxView(Quiet q, PetscViewer viewer)
{
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < q->cube.n; k++) {
    const PetscReal own = q->cube.own[k], size = q->size;

    PetscCall(PetscViewerASCIIPrintf(viewer, "  %s: %.6g to %.6g about %.6g\n", q->cube.name[k],
                                     (double)CubeValue(&q->cube, k, own - size * (own + 1)),
                                     (double)CubeValue(&q->cube, k, own + size * (1 - own)),
                                     (double)CubeValue(&q->cube, k, own)));
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode StatementView(Quiet q, PetscViewer viewer)
{
  PetscFunctionBeginUser;
  if (q->goal == QUIET_PARTS)
    PetscCall(PetscViewerASCIIPrintf(
      viewer, "of the box %.4g %% is quiet, %.4g %% dangerous, %.4g %% left open, by %" PetscInt_FMT " cells\n",
      (double)(100 * q->share[CELL_QUIET]), (double)(100 * q->share[CELL_DANGEROUS]),
      (double)(100 * q->share[CELL_OPEN]), q->n_tested));
  else if (q->size > 0)
    PetscCall(PetscViewerASCIIPrintf(
      viewer, "no mode of the band grows in %.6g of the box, shown by %" PetscInt_FMT " cells%s\n", (double)q->size,
      q->n_tested, q->size < 1 ? ":" : ", which is all of it:"));
  else
    PetscCall(
      PetscViewerASCIIPrintf(viewer, "no box is quiet: %s\n",
                             q->danger.found && q->danger.distance == 0
                               ? "a mode grows at the scene's own values"
                               : "nothing could be shown about the scene's own values; raise -quiet_max_cells"));
  if (q->goal == QUIET_BOX && q->size > 0) PetscCall(BoxView(q, viewer));
  if (q->margin < PETSC_MAX_REAL && (q->goal == QUIET_PARTS || q->size > 0))
    PetscCall(PetscViewerASCIIPrintf(viewer, "margin: at least %.3g rad/s in each cell\n", (double)q->margin));
  PetscFunctionReturn(0);
}

static PetscErrorCode DangerView(Quiet q, PetscViewer viewer)
{
  const DangerPoint *d = &q->danger;

  PetscFunctionBeginUser;
  if (!d->found) {
    PetscCall(PetscViewerASCIIPrintf(viewer, "no dangerous point was found in the box\n"));
    PetscFunctionReturn(0);
  }
  PetscCall(PetscViewerASCIIPrintf(viewer, "nearest dangerous point, at %.6g of the box:", (double)d->distance));
  for (PetscInt k = 0; k < q->cube.n; k++)
    PetscCall(PetscViewerASCIIPrintf(viewer, "%s %s %.6g", k ? "," : "", q->cube.name[k],
                                     (double)CubeValue(&q->cube, k, d->t[k])));
  PetscCall(PetscViewerASCIIPrintf(viewer, "; %s at %.2f Hz grows by %.4g 1/s", d->label[0] ? d->label : "a mode",
                                   (double)(d->omega / (2 * PETSC_PI)), (double)d->sigma));
  if (d->confirmed)
    PetscCall(PetscViewerASCIIPrintf(viewer, "; full solution: %.2f Hz, %.4g 1/s\n",
                                     (double)(d->full_omega / (2 * PETSC_PI)), (double)d->full_sigma));
  else
    PetscCall(PetscViewerASCIIPrintf(viewer, "; the full solution there does not grow\n"));
  PetscFunctionReturn(0);
}

static PetscErrorCode RandomView(Quiet q, PetscViewer viewer)
{
  const QuietChecks *c = &q->checks;

  PetscFunctionBeginUser;
  if (c->n)
    PetscCall(PetscViewerASCIIPrintf(viewer, "%" PetscInt_FMT " random points inside: %" PetscInt_FMT " unstable\n",
                                     c->n, c->n_unstable));
  if (c->n_full)
    PetscCall(PetscViewerASCIIPrintf(viewer,
                                     "%" PetscInt_FMT " of them in full: %" PetscInt_FMT
                                     " unstable, largest true error %.1e, %" PetscInt_FMT
                                     " modes beyond what is stated\n",
                                     c->n_full, c->n_full_unstable, (double)c->true_error, c->n_beyond));
  PetscFunctionReturn(0);
}

/* Of which contact status the statement is, and whether the box has others */
static PetscErrorCode QuietStateView(Quiet q, PetscViewer viewer)
{
  PetscFunctionBeginUser;
  PetscCall(PetscViewerASCIIPrintf(viewer,
                                   "sliding state: what is shown is about the %" PetscInt_FMT
                                   " pairs closed at the scene's own values; ",
                                   BoxClosed(&q->box, 0)));
  if (q->n_other)
    PetscCall(PetscViewerASCIIPrintf(viewer,
                                     "at %" PetscInt_FMT " of %" PetscInt_FMT
                                     " points of the box others are, by %" PetscInt_FMT
                                     " pairs at most, the nearest at %.3g of the box: there it says nothing of the "
                                     "brake; full solutions have their own\n",
                                     q->n_other, q->n_status, q->apart, (double)q->other_distance));
  else
    PetscCall(
      PetscViewerASCIIPrintf(viewer, "so they are at all of %" PetscInt_FMT " points of the box\n", q->n_status));
  if (q->checks.n_full_other)
    PetscCall(PetscViewerASCIIPrintf(viewer,
                                     "%" PetscInt_FMT " of the random points in full have other pairs closed; errors "
                                     "leave them out\n",
                                     q->checks.n_full_other));
  PetscFunctionReturn(0);
}

PetscErrorCode QuietView(Quiet q, PetscViewer viewer)
{
  const PetscInt  n     = q->box.small.n_used ? q->box.small.n_used : q->box.basis.reduced.n_used;
  const PetscReal error = PetscMax(q->error, q->checks.error);

  PetscFunctionBeginUser;
  PetscCall(StatementView(q, viewer));
  PetscCall(DangerView(q, viewer));
  PetscCall(RandomView(q, viewer));
  PetscCall(PetscViewerASCIIPrintf(viewer, "what is shown holds for the reduced model of %" PetscInt_FMT " vectors%s; ",
                                   n, q->exact ? "" : ", as far as the corners of the cells tell"));
  if (q->box.whole)
    PetscCall(PetscViewerASCIIPrintf(viewer, "these are all unknowns: no error but rounding\n"));
  else
    PetscCall(PetscViewerASCIIPrintf(
      viewer, "its error is an estimate, at most %.1e, from %" PetscInt_FMT " full solutions, and is taken off\n",
      (double)error, q->box.greedy.n_samples));
  if (q->box.statics) PetscCall(QuietStateView(q, viewer));
  PetscCall(PetscViewerASCIIPrintf(viewer, "time: basis %.2f s, cells %.2f s, dangerous point %.2f s, checks %.2f s\n",
                                   q->seconds[0], q->seconds[1], q->seconds[2], q->seconds[3]));
  PetscFunctionReturn(0);
}
