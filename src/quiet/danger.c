/*
   Points where a mode grows. From one of them the scene's own values are a straight way off, on which growth begins
   somewhere: found by halving. The distance is the largest of all variables, each beside its half width, so that the
   others may move freely up to it: from a point at the surface the way goes on to the corner of the box through it to
   which growth rises, as the derivatives say, as long as that comes nearer.
*/
#include "quietimpl.h"
#include "sample/draw/sequence.h"

#define HALVINGS      30
#define WAY_RTOL      1e-5 /* of the distance */
#define TURNS         12
#define PROBES        64
#define CORNERS       6    /* all corners are looked at with that many variables at most */
#define OUTWARD       1e-3 /* a step of the confirmation */
#define OUTWARD_STEPS 8

PetscErrorCode QuietLook(Quiet q, const PetscReal t[], DangerPoint *point, PetscReal *worst, PetscBool *unstable)
{
  const Box   *box    = &q->box;
  PetscReal    excess = PETSC_NINFINITY, *p;
  ReducedModes modes;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(q->cube.n_parameters, &p));
  CubePoint(&q->cube, t, p);
  PetscCall(BoxSolve(box, box->small.n_used ? PETSC_TRUE : PETSC_FALSE, p, &modes));
  *point = (DangerPoint){.distance = CubeDistance(&q->cube, t), .sigma = NAN, .omega = NAN, .error = NAN};
  PetscCall(PetscArraycpy(point->t, t, q->cube.n));
  *unstable = PETSC_FALSE;
  for (PetscInt i = 0; i < modes.n; i++) {
    const PetscReal sigma = creal(modes.lambda[i]), omega = cimag(modes.lambda[i]);
    const PetscReal here = sigma - ModesLimitGrowth(&box->limit, cabs(modes.lambda[i]));

    if (!BoxHolds(box, modes.lambda[i])) continue;
    if (ModesLimitJudge(&box->limit, sigma, omega, modes.error[i]) == MODE_UNSTABLE) *unstable = PETSC_TRUE;
    if (here <= excess) continue;
    excess       = here;
    point->sigma = sigma, point->omega = omega, point->error = modes.error[i];
  }
  *worst       = ReducedModesWorst(&modes, &box->window, PETSC_TRUE);
  point->found = *unstable;
  PetscCall(ReducedModesDestroy(&modes));
  PetscCall(PetscFree(p));
  PetscFunctionReturn(0);
}

/* t = own + part (to - own) */
static void Along(const Cube *cube, const PetscReal to[], PetscReal part, PetscReal t[])
{
  for (PetscInt k = 0; k < cube->n; k++) t[k] = cube->own[k] + part * (to[k] - cube->own[k]);
}

PetscErrorCode QuietNearer(Quiet q, DangerPoint *point)
{
  DangerPoint far = *point, here;
  PetscReal   low = 0, high = 1, t[CUBE_MAX_VARIABLES], worst;
  PetscBool   unstable;

  PetscFunctionBeginUser;
  for (int pass = 0; pass < HALVINGS && high - low > WAY_RTOL * high; pass++) {
    Along(&q->cube, far.t, 0.5 * (low + high), t);
    PetscCall(QuietLook(q, t, &here, &worst, &unstable));
    if (unstable)
      *point = here, high = 0.5 * (low + high);
    else
      low = 0.5 * (low + high);
  }
  PetscFunctionReturn(0);
}

PetscErrorCode QuietShareNearest(Quiet q, const DangerPoint *point, PetscBool *nearer)
{
  struct {
    double distance;
    int    rank;
  } mine = {point->found ? point->distance : PETSC_MAX_REAL, 0}, least;
  PetscMPIInt rank;
  DangerPoint nearest = *point;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(q->comm, &rank));
  mine.rank = rank;
  PetscCallMPI(MPI_Allreduce(&mine, &least, 1, MPI_DOUBLE_INT, MPI_MINLOC, q->comm));
  PetscCallMPI(MPI_Bcast(&nearest, (PetscMPIInt)sizeof(nearest), MPI_BYTE, least.rank, q->comm));
  *nearer = nearest.found && (!q->danger.found || nearest.distance < q->danger.distance) ? PETSC_TRUE : PETSC_FALSE;
  if (*nearer) q->danger = nearest;
  PetscFunctionReturn(0);
}

/* Corners of the box, then points of a sequence: t of point i; false behind the last */
static PetscBool ProbePoint(const Cube *cube, const Sequence *sequence, PetscInt i, PetscReal t[])
{
  const PetscInt n_corners = cube->n <= CORNERS ? 1 << cube->n : 0;

  if (i < n_corners) {
    for (PetscInt k = 0; k < cube->n; k++) t[k] = i >> k & 1 ? 1 : -1;
    return PETSC_TRUE;
  }
  if (i - n_corners >= PROBES) return PETSC_FALSE;
  SequencePoint(sequence, i - n_corners, t);
  for (PetscInt k = 0; k < cube->n; k++) t[k] = 2 * t[k] - 1;
  return PETSC_TRUE;
}

/* Of the scene's own values, alike on all ranks */
static PetscErrorCode ProbeOwn(Quiet q)
{
  DangerPoint own;
  PetscReal   worst;
  PetscBool   unstable;

  PetscFunctionBeginUser;
  PetscCall(QuietLook(q, q->cube.own, &own, &worst, &unstable));
  PetscCall(QuietShareNearest(q, &own, &unstable));
  PetscFunctionReturn(0);
}

PetscErrorCode QuietProbe(Quiet q)
{
  Sequence    sequence = {SEQUENCE_SOBOL, 1, PROBES, q->cube.n, NULL};
  DangerPoint nearest  = {.found = PETSC_FALSE}, here;
  PetscReal   t[CUBE_MAX_VARIABLES], worst;
  PetscBool   unstable;
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  PetscCall(ProbeOwn(q));
  if (q->danger.found) PetscFunctionReturn(0);
  PetscCallMPI(MPI_Comm_rank(q->comm, &rank));
  PetscCall(SequenceSetUp(&sequence));
  for (PetscInt i = 0; ProbePoint(&q->cube, &sequence, i, t); i++) {
    if (PointGroupsOwner(&q->box.groups, i) != rank || CubeDistance(&q->cube, t) > 1) continue;
    if (nearest.found && CubeDistance(&q->cube, t) >= nearest.distance)
      Along(&q->cube, t, (1 - WAY_RTOL) * nearest.distance / CubeDistance(&q->cube, t), t);
    PetscCall(QuietLook(q, t, &here, &worst, &unstable));
    if (!unstable) continue;
    PetscCall(QuietNearer(q, &here));
    if (!nearest.found || here.distance < nearest.distance) nearest = here;
  }
  PetscCall(SequenceDestroy(&sequence));
  PetscCall(QuietShareNearest(q, &nearest, &unstable));
  PetscFunctionReturn(0);
}

/* Signs of d growth / d t_k of the mode of a point: the corner of the box of that distance to which growth rises */
static PetscErrorCode RisingCorner(Quiet q, const DangerPoint *at, PetscReal corner[])
{
  const Cube    *cube    = &q->cube;
  const Reduced *reduced = q->box.small.n_used ? &q->box.small : &q->box.basis.reduced;
  PetscReal     *p, nearest = PETSC_MAX_REAL;
  PetscInt       mode = 0;
  PetscComplex  *derivative;
  ReducedModes   modes;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(cube->n_parameters, &p, reduced->n_parameters, &derivative));
  CubePoint(cube, at->t, p);
  PetscCall(ReducedSolve(reduced, p, &q->box.window, &modes));
  for (PetscInt i = 0; i < modes.n; i++)
    if (cabs(modes.lambda[i] - CMPLX(at->sigma, at->omega)) < nearest)
      nearest = cabs(modes.lambda[i] - CMPLX(at->sigma, at->omega)), mode = i;
  if (modes.n) PetscCall(ReducedSensitivity(reduced, p, &modes, mode, derivative));
  for (PetscInt k = 0; k < cube->n; k++) {
    PetscReal rise = 0;

    for (PetscInt m = 0; m < cube->n_moved[k] && modes.n; m++)
      rise += creal(derivative[cube->moved[k][m]]) * (cube->upper[k][m] - cube->lower[k][m]);
    corner[k] =
      rise > 0 ? cube->own[k] + at->distance * (1 - cube->own[k]) : cube->own[k] - at->distance * (1 + cube->own[k]);
  }
  PetscCall(ReducedModesDestroy(&modes));
  PetscCall(PetscFree2(p, derivative));
  PetscFunctionReturn(0);
}

/* On rank 0 */
static PetscErrorCode RefineAlone(Quiet q, DangerPoint *best)
{
  PetscReal part = 1;

  PetscFunctionBeginUser;
  for (int turn = 0; turn < TURNS; turn++) {
    PetscReal   corner[CUBE_MAX_VARIABLES], t[CUBE_MAX_VARIABLES], worst;
    DangerPoint here;
    PetscBool   unstable;

    PetscCall(RisingCorner(q, best, corner));
    for (PetscInt k = 0; k < q->cube.n; k++) t[k] = best->t[k] + part * (corner[k] - best->t[k]);
    PetscCall(QuietLook(q, t, &here, &worst, &unstable));
    if (unstable) PetscCall(QuietNearer(q, &here));
    if (unstable && here.distance < best->distance * (1 - WAY_RTOL))
      *best = here;
    else
      part /= 2;
  }
  PetscFunctionReturn(0);
}

PetscErrorCode QuietRefine(Quiet q)
{
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  if (!q->danger.found || q->danger.distance == 0) PetscFunctionReturn(0);
  PetscCallMPI(MPI_Comm_rank(q->comm, &rank));
  if (!rank) PetscCall(RefineAlone(q, &q->danger));
  PetscCallMPI(MPI_Bcast(&q->danger, (PetscMPIInt)sizeof(q->danger), MPI_BYTE, 0, q->comm));
  PetscFunctionReturn(0);
}

/* The mode of the full solution at t that grows fastest beyond the limit */
static PetscErrorCode FullLook(Quiet q, DangerPoint *at)
{
  BoxFull    full;
  PetscReal *p;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(q->cube.n_parameters, &p));
  CubePoint(&q->cube, at->t, p);
  PetscCall(BoxSolveFull(&q->box, p, &full));
  at->other      = q->box.statics && full.status != q->box.status[0] ? PETSC_TRUE : PETSC_FALSE;
  at->full_sigma = at->full_omega = at->full_error = NAN;
  for (PetscInt i = 0; i < full.n; i++) {
    const Mode *mode = &full.mode[i];

    if (ModesLimitJudge(&q->box.limit, mode->sigma, mode->omega, mode->error) != MODE_UNSTABLE) continue;
    if (at->full_sigma >= mode->sigma) continue;
    at->full_sigma = mode->sigma, at->full_omega = mode->omega, at->full_error = mode->error;
  }
  at->confirmed = PetscIsNanReal(at->full_sigma) ? PETSC_FALSE : PETSC_TRUE;
  PetscCall(PetscFree(p));
  PetscFunctionReturn(0);
}

/* The surface is known to the error of the model only: where the full solution does not grow yet the point steps
   outward, within the box */
PetscErrorCode QuietConfirm(Quiet q)
{
  DangerPoint *at = &q->danger;
  PetscReal    t[CUBE_MAX_VARIABLES], worst;
  PetscBool    unstable;

  PetscFunctionBeginUser;
  if (!at->found) PetscFunctionReturn(0);
  PetscCall(FullLook(q, at));
  for (int step = 0; step < OUTWARD_STEPS && !at->confirmed; step++) {
    DangerPoint next;

    if (at->distance >= 1) break;
    Along(&q->cube, at->t, PetscMin(1 + OUTWARD * (1 << step), 1 / at->distance), t);
    for (PetscInt k = 0; k < q->cube.n; k++) t[k] = PetscMin(1, PetscMax(-1, t[k])); /* but for rounding they are */
    PetscCall(QuietLook(q, t, &next, &worst, &unstable));
    PetscCallMPI(MPI_Bcast(&next, (PetscMPIInt)sizeof(next), MPI_BYTE, 0, q->comm));
    PetscCall(FullLook(q, &next));
    *at = next;
  }
  at->found = PETSC_TRUE;
  PetscFunctionReturn(0);
}
