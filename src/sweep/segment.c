/*
   Segments: parts of a line within which the contact status is one and the same. Branches are followed inside a
   segment; at a jump the vectors on both sides are matched, and a branch whose partner is doubtful ends there.
*/
#include "line.h"

/* rename [new branches of the segment] = an older number, or -1 for one of their own. Numbers stay without gaps:
   those that keep their own are moved up to follow first_new, in the points up to last and in the events from
   first_event on. rename is overwritten. */
PetscErrorCode LineRename(Sweep sweep, PetscInt first_new, PetscInt rename[], PetscInt last, PetscInt first_event,
                          LinePoints *points)
{
  const PetscInt n_new = sweep->n_branches - first_new;
  PetscInt       next  = first_new;

  PetscFunctionBeginUser;
  for (PetscInt b = 0; b < n_new; b++)
    if (rename[b] < 0) rename[b] = next++;
  for (PetscInt k = 0; k < last; k++)
    for (PetscInt i = 0; i < points->modes[k].n; i++)
      if (points->branch[k][i] >= first_new) points->branch[k][i] = rename[points->branch[k][i] - first_new];
  for (PetscInt e = first_event; e < sweep->events.n; e++)
    for (int i = 0; i < 2; i++) {
      PetscInt *branch = &sweep->events.event[e].branch[i];

      if (*branch >= first_new) *branch = rename[*branch - first_new];
    }
  sweep->n_branches = next;
  PetscFunctionReturn(0);
}

/* Links the segment k to last - 1, whose branches are those from first_new on, to the place before it */
static PetscErrorCode SegmentLink(Sweep sweep, PetscInt first_new, PetscInt k, PetscInt last, PetscInt first_event,
                                  LinePoints *points)
{
  const PetscInt n = points->modes[k].n, n_new = sweep->n_branches - first_new;
  BranchPoint    before = {points->value[k - 1], &points->modes[k - 1], points->branch[k - 1]};
  BranchPoint    after  = {points->value[k], &points->modes[k], points->branch[k]};
  PetscInt      *own, *rename;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(n, &own, n_new, &rename));
  PetscCall(PetscArraycpy(own, points->branch[k], n));
  PetscCall(
    TrackJump(&sweep->basis.reduced, &points->p[k * sweep->grid.n_parameters], &before, &after, &sweep->events));
  for (PetscInt b = 0; b < n_new; b++) rename[b] = -1;
  for (PetscInt i = 0; i < n; i++)
    if (points->branch[k][i] < first_new) rename[own[i] - first_new] = points->branch[k][i];
  PetscCall(LineRename(sweep, first_new, rename, last, first_event, points));
  PetscCall(PetscFree2(own, rename));
  PetscFunctionReturn(0);
}

/* Each segment is followed by itself, with numbers of its own, and then linked to the place before it. */
PetscErrorCode LineTrackSegments(Sweep sweep, LinePoints *points)
{
  const SweepPlace *place = &sweep->grid.place[points->first];

  PetscFunctionBeginUser;
  for (PetscInt k = 0, last; k < points->n; k = last) {
    const PetscInt first_new = sweep->n_branches, first_event = sweep->events.n;
    BranchLine line = {sweep->grid.n_moved[0], 0, sweep->grid.parameter[0], &points->value[k], NULL, &sweep->window};

    for (last = k + 1; last < points->n && place[last].status == place[k].status;) last++;
    line.n    = last - k;
    line.base = &points->p[k * sweep->grid.n_parameters];
    PetscCall(TrackLine(&sweep->basis.reduced, &line, &points->modes[k], &points->branch[k], &sweep->n_branches,
                        &sweep->events));
    if (k) PetscCall(SegmentLink(sweep, first_new, k, last, first_event, points));
    for (PetscInt e = first_event; e < sweep->events.n; e++) sweep->events.event[e].place = points->first + k;
  }
  PetscFunctionReturn(0);
}
