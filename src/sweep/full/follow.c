/*
   Branches of a sweep in full. Of each point the vectors are kept until the next one is solved, right and left ones, as
   coordinates in an orthonormal basis of what they span. The vectors of the next point extend that basis, and the
   pencil of that point between the vectors of the basis is a reduced model and, at these modes, without error: on it
   they are matched as at any step of track/ (TrackStep()). The products of the earlier point have the damping that it
   has there, on which those of real eigenvalues depend altogether, but the mass of the later one. In a grid each line
   begins at the first point of the line before.

   All vectors are those of all unknowns, since which of them an exact constraint eliminates may change from point to
   point.
*/
#include "follow.h"

/* p of the model are the factors of the damping of this point and of the one before (FollowModel()). */
static PetscErrorCode PointStepFrom(Sweep sweep, StepKind kind, const Reduced *reduced, const FollowPoint *from,
                                    FollowPoint *point)
{
  PointStep step = {.kind       = kind,
                    .window     = &sweep->window,
                    .p          = {(PetscReal[]){0, 1}, (PetscReal[]){1, 0}},
                    .a          = {from->value, &from->modes, from->branch},
                    .b          = {point->value, &point->modes, point->branch},
                    .before     = &from->memory,
                    .after      = &point->memory,
                    .n_branches = sweep->n_branches};

  PetscFunctionBeginUser;
  PetscCall(TrackStep(reduced, &step, &sweep->events));
  sweep->n_branches = step.n_branches;
  sweep->n_broken += step.n_broken;
  PetscFunctionReturn(0);
}

/* Gives all ranks what rank 0 found, from event n_before on: collective calls depend on it */
static PetscErrorCode PointShare(Sweep sweep, PetscInt n_before, FollowPoint *point)
{
  PetscFunctionBeginUser;
  PetscCall(SweepShareEvents(sweep, n_before));
  PetscCallMPI(MPI_Bcast(point->branch, (PetscMPIInt)point->modes.n, MPIU_INT, 0, sweep->comm));
  PetscCall(ReducedModesBroadcast(sweep->comm, 0, &point->memory.modes));
  PetscCallMPI(MPI_Bcast(point->memory.branch, (PetscMPIInt)point->memory.modes.n, MPIU_INT, 0, sweep->comm));
  PetscFunctionReturn(0);
}

/* The first point of all begins a branch with each mode. The one before is brought into the longer basis of this
   one: its coordinates are those of the leading vectors, zeros follow. */
static PetscErrorCode PointFollow(Sweep sweep, Pencil pencil, StepKind kind, const FollowPoint *from,
                                  FollowPoint *point)
{
  const PetscInt first_event = sweep->events.n, size = point->modes.size;
  FollowPoint    before; /* in the basis of the point */
  Reduced        reduced;

  PetscFunctionBeginUser;
  PetscCall(FollowModel(pencil, from, point, &reduced));
  reduced.limit = sweep->limit;
  for (PetscInt k = 0; k < point->modes.n && !from; k++) point->branch[k] = sweep->n_branches++;
  if (from) {
    before = *from;
    PetscCall(FollowMove(&from->modes, size, NULL, &before.modes));
    PetscCall(FollowMove(&from->memory.modes, size, NULL, &before.memory.modes));
    PetscCall(PointStepFrom(sweep, kind, &reduced, &before, point));
    PetscCall(PointShare(sweep, first_event, point));
    for (PetscInt e = first_event; e < sweep->events.n; e++) sweep->events.event[e].place = point->place;
    PetscCall(ReducedModesDestroy(&before.modes));
    PetscCall(ReducedModesDestroy(&before.memory.modes));
  }
  PetscCall(FollowModelDestroy(&reduced));
  PetscFunctionReturn(0);
}

static PetscErrorCode PointDestroy(FollowPoint **point)
{
  FollowPoint *p = *point;

  PetscFunctionBeginUser;
  if (!p) PetscFunctionReturn(0);
  PetscCall(MatDestroy(&p->C));
  PetscCall(BVDestroy(&p->vectors));
  PetscCall(ReducedModesDestroy(&p->modes));
  PetscCall(ReducedModesDestroy(&p->memory.modes));
  PetscCall(PetscFree(p->memory.branch));
  PetscCall(PetscFree(p->branch));
  PetscCall(PetscFree(*point));
  PetscFunctionReturn(0);
}

/* The point whose modes the eigensolver has just found */
static PetscErrorCode PointCreate(Sweep sweep, const FollowPoint *from, PetscInt i, const LinePoints *points,
                                  FollowPoint **point)
{
  const ReducedModes *found = &points->modes[i];

  PetscFunctionBeginUser;
  PetscCall(PetscNew(point));
  (*point)->place = points->first + i;
  (*point)->value = points->value[i];
  PetscCall(PetscMalloc1(found->n, &(*point)->branch));
  PetscCall(FollowRead(sweep, from, found, *point));
  PetscFunctionReturn(0);
}

/* The points kept: the one before, and with two axes the first one of the line, to which the next line is linked.
   Both may be the same point, which is then freed once. */
PetscErrorCode FollowTake(Sweep sweep, Pencil pencil, PetscInt i, LinePoints *points, Follow *follow)
{
  const SweepPlace *place = &sweep->grid.place[points->first + i];
  FollowPoint      *from  = i ? follow->before : follow->first, *point;
  StepKind          kind  = i ? STEP_SMOOTH : STEP_LINK;

  PetscFunctionBeginUser;
  if (i && place[-1].status != place->status) kind = STEP_JUMP;
  PetscCall(PointCreate(sweep, from, i, points, &point));
  PetscCall(PointFollow(sweep, pencil, kind, from, point));
  PetscCall(FollowShrink(point));
  PetscCall(PetscArraycpy(points->branch[i], point->branch, point->modes.n));
  if (follow->before != follow->first) PetscCall(PointDestroy(&follow->before));
  follow->before = point;
  if (i || sweep->grid.n_axes == 1) PetscFunctionReturn(0);
  PetscCall(PointDestroy(&follow->first));
  follow->first = point;
  PetscFunctionReturn(0);
}

PetscErrorCode FollowDestroy(Follow *follow)
{
  PetscFunctionBeginUser;
  if (follow->before != follow->first) PetscCall(PointDestroy(&follow->before));
  PetscCall(PointDestroy(&follow->first));
  PetscFunctionReturn(0);
}
