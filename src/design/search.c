/*
   The designs one after the other. First the cuts of those before lead to a good one; where they do not, designs spread
   over the box are looked at, and the search begins anew from the least bad ones, each with its share of the designs
   that may still be tried. From the scene to a good design the limit is crossed somewhere: there, found by halving,
   the cuts are sharp, and the next design from these is tried. As long as that is good, and nearer to the scene, it
   goes on.
*/
#include "designimpl.h"
#include "base/process/progress.h"

#define RADIUS       0.5 /* of trust, of the half widths, to begin with */
#define LEAST_RADIUS 1e-3
#define GAIN         2e-3 /* of the goal, that another design must promise */
#define HALF_TURNS   14   /* halvings of the way from a bad design to a good one */

/* Change and mass of a design beside the scene */
static void PointMeasure(const Design d, DesignPoint *point)
{
  PetscReal square = 0;

  point->mass = 1;
  for (PetscInt k = 0; k < d->cube.n; k++) {
    square += PetscSqr(point->z[k] - d->cube.own[k]);
    point->mass += d->mass_slope[k] * (point->z[k] - d->cube.own[k]);
  }
  point->change = PetscSqrtReal(square / (PetscReal)d->cube.n);
}

/* What is minimised */
static PetscReal PointGoal(const Design d, const DesignPoint *point)
{
  return 0.5 * PetscSqr(point->change) * (PetscReal)d->cube.n + d->mass_weight * (point->mass - 1);
}

/* Whether no more scenarios are unstable than may be */
static PetscBool IsAllowed(const Design d, const DesignPoint *point)
{
  return (PetscReal)point->n_scenarios <= d->probability * (PetscReal)d->n_scenarios + 1e-9 ? PETSC_TRUE : PETSC_FALSE;
}

/* The full solution at the worst scenario that counts */
static PetscErrorCode PointAccept(Design d, DesignPoint *point)
{
  DesignCorner corner;

  PetscFunctionBeginUser;
  PetscCall(DesignFull(d, point->z, &d->scenario[point->worst * d->uncertain.n], &corner));
  point->solved      = PETSC_TRUE;
  point->full_excess = corner.excess;
  point->good        = corner.n_unstable ? PETSC_FALSE : PETSC_TRUE;
  if (!point->good) d->margin *= 2;
  PetscFunctionReturn(0);
}

/* The next row of the table. It is looked at with the contact statuses of the design before; where it is good with
   them its own are found, and if they are others it is looked at with these */
static PetscErrorCode DesignTry(Design d, const PetscReal z[], DesignPoint **point)
{
  PetscBool changed = PETSC_FALSE;

  PetscFunctionBeginUser;
  *point = &d->point[d->n_points++];
  PetscCall(PetscArraycpy((*point)->z, z, d->cube.n));
  PointMeasure(d, *point);
  PetscCall(DesignLook(d, PETSC_TRUE, *point));
  if (IsAllowed(d, *point)) PetscCall(DesignFindStatuses(d, z, &changed));
  if (changed) PetscCall(DesignLook(d, PETSC_TRUE, *point));
  if (IsAllowed(d, *point)) PetscCall(PointAccept(d, *point));
  PetscFunctionReturn(0);
}

/* Whether a step leads away from the least bad design; the bounds may leave nothing to change */
static PetscBool StepMoves(const Design d, const PetscReal z[])
{
  PetscReal most = 0;

  for (PetscInt k = 0; k < d->cube.n; k++) most = PetscMax(most, PetscAbsReal(z[k] - d->point[d->best].z[k]));
  return most > LEAST_RADIUS ? PETSC_TRUE : PETSC_FALSE;
}

/* Until one is good, or there are `most`: from the least bad one, and less far where a step has failed */
static PetscErrorCode SearchGood(Design d, PetscInt most)
{
  PetscReal radius = RADIUS, z[CUBE_MAX_VARIABLES];
  PetscBool moves = PETSC_TRUE, first = PETSC_TRUE;

  PetscFunctionBeginUser;
  PetscCall(PetscArraycpy(z, d->n_points ? d->point[d->best].z : d->cube.own, d->cube.n));
  if (d->n_points && !d->again) PetscCall(DesignStep(d, d->point[d->best].z, radius, z));
  PetscCallMPI(MPI_Bcast(z, (PetscMPIInt)d->cube.n, MPIU_REAL, 0, d->comm));
  while (d->n_points < most && !d->found && radius > LEAST_RADIUS && moves) {
    DesignPoint *point;

    PetscCall(DesignTry(d, z, &point));
    d->found = point->good;
    if (!first && !d->found && point->excess >= d->point[d->best].excess)
      radius /= 2;
    else
      d->best = d->n_points - 1;
    first = PETSC_FALSE;
    if (!d->found) PetscCall(DesignStep(d, d->point[d->best].z, radius, z));
    PetscCallMPI(MPI_Bcast(z, (PetscMPIInt)d->cube.n, MPIU_REAL, 0, d->comm));
    moves = StepMoves(d, z);
  }
  PetscFunctionReturn(0);
}

/* From the least bad designs of the whole box, each with cuts of its own: those of others may exclude where it leads */
static PetscErrorCode SearchElsewhere(Design d)
{
  DesignList starts;

  PetscFunctionBeginUser;
  if (d->found || d->n_elsewhere || !d->n_starts || d->n_points == d->max_designs) PetscFunctionReturn(0);
  PetscCall(DesignStarts(d, &starts));
  for (PetscInt i = 0; i < starts.n && !d->found && d->n_points < d->max_designs; i++) {
    const PetscInt left = d->max_designs - d->n_points, share = (left + starts.n - i - 1) / (starts.n - i);
    const PetscInt most = d->n_points + share;
    DesignPoint   *point;

    d->n_cuts = 0;
    d->again  = PETSC_FALSE;
    PetscCall(DesignTry(d, starts.z[i], &point));
    d->best  = d->n_points - 1;
    d->found = point->good;
    if (!d->found) PetscCall(SearchGood(d, most));
  }
  PetscFunctionReturn(0);
}

/* Whether a design may be taken; where one unstable scenario decides, those come first that were unstable before */
static PetscErrorCode IsGood(Design d, const PetscReal z[], PetscInt order[], PetscBool *good)
{
  DesignPoint point = {.n_unstable = 0};
  PetscReal   excess;
  PetscBool   unstable;

  PetscFunctionBeginUser;
  if (d->probability > 0) {
    PetscCall(PetscArraycpy(point.z, z, d->cube.n));
    PetscCall(DesignLook(d, PETSC_FALSE, &point));
    *good = IsAllowed(d, &point);
  } else {
    PetscCall(DesignGlance(d, z, PETSC_INFINITY, order, &excess, &unstable));
    *good = unstable ? PETSC_FALSE : PETSC_TRUE;
  }
  PetscFunctionReturn(0);
}

/* bad := a bad design next to the limit on the way to the best one, whose cuts are kept; older ones that the best one
   does not keep are dropped */
static PetscErrorCode SearchEdge(Design d, PetscReal bad[])
{
  const PetscReal *best = d->point[d->best].z;
  PetscReal        good_end[CUBE_MAX_VARIABLES];
  DesignPoint      middle;
  PetscInt        *order;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(d->n_scenarios, &order));
  for (PetscInt i = 0; i < d->n_scenarios; i++) order[i] = i;
  PetscCall(PetscArraycpy(good_end, best, d->cube.n));
  for (int turn = 0; turn < HALF_TURNS; turn++) {
    PetscBool good;

    for (PetscInt k = 0; k < d->cube.n; k++) middle.z[k] = 0.5 * (bad[k] + good_end[k]);
    PetscCall(IsGood(d, middle.z, order, &good));
    PetscCall(PetscArraycpy(good ? good_end : bad, middle.z, d->cube.n));
  }
  DesignForget(d, good_end);
  middle = (DesignPoint){.n_unstable = 0};
  PetscCall(PetscArraycpy(middle.z, bad, d->cube.n));
  PetscCall(DesignLook(d, PETSC_TRUE, &middle));
  PetscCall(PetscFree(order));
  PetscFunctionReturn(0);
}

/* Better ones */
static PetscErrorCode SearchBetter(Design d)
{
  PetscReal bad[CUBE_MAX_VARIABLES], z[CUBE_MAX_VARIABLES];

  PetscFunctionBeginUser;
  PetscCall(PetscArraycpy(bad, d->cube.own, d->cube.n));
  while (d->n_points < d->max_designs && d->best > 0) {
    DesignPoint *point, next = {.n_unstable = 0};

    PetscCall(SearchEdge(d, bad));
    PetscCall(DesignStep(d, d->point[d->best].z, RADIUS, z));
    PetscCallMPI(MPI_Bcast(z, (PetscMPIInt)d->cube.n, MPIU_REAL, 0, d->comm));
    PetscCall(PetscArraycpy(next.z, z, d->cube.n));
    PointMeasure(d, &next);
    if (PointGoal(d, &next) >= PointGoal(d, &d->point[d->best]) * (1 - GAIN)) break;
    PetscCall(DesignTry(d, z, &point));
    if (point->good)
      d->best = d->n_points - 1;
    else
      PetscCall(PetscArraycpy(bad, z, d->cube.n));
  }
  PetscFunctionReturn(0);
}

/* The rejected design is from now on what it is at that corner in full */
PetscErrorCode DesignReject(Design d, const DesignCorner *corner)
{
  DesignPoint *point = &d->point[d->best];

  PetscFunctionBeginUser;
  PetscCall(DesignAddScenario(d, corner->t, &d->again));
  if (!d->again) d->margin *= 2;
  point->good = d->found = PETSC_FALSE;
  point->n_scenarios     = 1;
  point->n_unstable      = corner->n_unstable;
  point->excess = point->full_excess = corner->excess;
  point->omega                       = corner->omega;
  d->n_rejected++;
  PetscCall(PetscFree(d->corner));
  PetscFunctionReturn(0);
}

void DesignChooseBest(Design d)
{
  for (PetscInt i = 0; i < d->n_points; i++) {
    const DesignPoint *a = &d->point[i], *b = &d->point[d->best];

    if (PetscMax(a->excess, a->full_excess) < PetscMax(b->excess, b->full_excess)) d->best = i;
  }
}

PetscErrorCode DesignSearch(Design d)
{
  Progress progress;

  PetscFunctionBeginUser;
  if (!d->point) PetscCall(PetscCalloc1(d->max_designs, &d->point));
  PetscCall(ProgressBegin(&progress, "designs", 2));
  PetscCall(SearchGood(d, d->max_designs));
  PetscCall(SearchElsewhere(d));
  PetscCall(ProgressStep(&progress));
  if (d->found) PetscCall(SearchBetter(d));
  PetscCall(ProgressEnd(&progress));
  PetscFunctionReturn(0);
}
