/*
   All points on the basis: first it is made good at some of them, the nominal point foremost, then all are solved, with
   their branches, each on one rank; where the estimated error of one exceeds -sample_rtol the basis grows, and these
   are solved again.
*/
#include "sampleimpl.h"
#include "base/process/progress.h"

/* Points that the greedy choice looks at, each of its estimates solving the dense problem of every one of them; the
   first of a sequence fill the box evenly */
#define SAMPLE_TRAIN 100
/* Passes over points whose error exceeds rtol */
#define SAMPLE_ROUNDS 6
/* Points of each rank that are solved before their modes are sent */
#define BATCH 50
/* Halvings of the way from the nominal point, where branches are in doubt */
#define FOLLOW_DEPTH 3

/* Makes the basis good at the nominal point and at most SAMPLE_TRAIN of the list [n] */
static PetscErrorCode BasisGrow(Sample s, PetscInt n, const PetscInt list[])
{
  const PetscInt n_parameters = s->box.n_parameters, n_train = PetscMin(n, SAMPLE_TRAIN);
  PetscReal     *points;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1((n_train + 1) * n_parameters, &points));
  PetscCall(PetscArraycpy(points, s->box.nominal, n_parameters));
  for (PetscInt i = 0; i < n_train; i++) PetscCall(SampleParameters(s, list[i], &points[(i + 1) * n_parameters]));
  PetscCall(BoxFit(&s->box, n_train + 1, points));
  if (s->box.many) PetscCall(BoxCompress(&s->box, n_train + 1, points));
  PetscCall(PetscFree(points));
  PetscFunctionReturn(0);
}

/* The modes of the nominal point on the present basis, alike on all ranks, and on the model of fewer vectors, which
   goes where it has others */
static PetscErrorCode NominalSolve(Sample s)
{
  PetscBool same = PETSC_TRUE;

  PetscFunctionBeginUser;
  PetscCall(ReducedModesDestroy(&s->nominal));
  PetscCall(ReducedModesDestroy(&s->small));
  PetscCall(BoxSolve(&s->box, PETSC_FALSE, s->box.nominal, &s->nominal));
  PetscCall(ReducedModesBroadcast(s->comm, 0, &s->nominal));
  if (!s->box.small.n_used) PetscFunctionReturn(0);
  PetscCall(BoxSolve(&s->box, PETSC_TRUE, s->box.nominal, &s->small));
  if (s->small.n != s->nominal.n) same = PETSC_FALSE;
  for (PetscInt k = 0; k < s->nominal.n && same; k++)
    if (BoxHolds(&s->box, s->nominal.lambda[k]) &&
        cabs(s->small.lambda[k] - s->nominal.lambda[k]) > s->small.error[k] + s->nominal.error[k])
      same = PETSC_FALSE;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &same, 1, MPIU_BOOL, MPI_LAND, s->comm));
  if (!same) PetscCall(BoxForgetSmall(&s->box.small));
  PetscFunctionReturn(0);
}

PetscErrorCode SampleModesAt(Sample s, const PetscReal p[], ReducedModes *modes, PetscInt **branch)
{
  Box      *box   = &s->box;
  PetscBool small = box->small.n_used ? PETSC_TRUE : PETSC_FALSE;
  PetscInt *all;

  PetscFunctionBeginUser;
  if (small) {
    PetscCall(BoxSolve(box, PETSC_TRUE, p, modes));
    small = ReducedModesWorst(modes, &box->window, PETSC_FALSE) <= box->rtol ? PETSC_TRUE : PETSC_FALSE;
    if (!small) PetscCall(ReducedModesDestroy(modes));
  }
  if (!small) PetscCall(BoxSolve(box, PETSC_FALSE, p, modes));
  s->n_large += small ? 0 : 1;
  PetscCall(PetscMalloc1(modes->n, branch));
  PetscCall(PetscMalloc1(s->nominal.n, &all));
  for (PetscInt k = 0; k < s->nominal.n; k++) all[k] = k;
  PetscCall(BoxFollow(box, &(BoxModes){box->nominal, small ? &s->small : &s->nominal, all},
                      &(BoxModes){p, modes, *branch}, FOLLOW_DEPTH, &s->n_divided));
  PetscCall(PetscFree(all));
  PetscFunctionReturn(0);
}

/* What of the error of mode k its growth may have: none without damping and growth where no other mode is
   within both errors. kappa = -lambda^2 of a real pencil without damping are real or in pairs, so that one alone stays
   real, and lambda imaginary. */
static PetscReal GrowthError(const ReducedModes *modes, PetscInt k, PetscBool damped)
{
  PetscBool alone = !damped && creal(modes->lambda[k]) == 0 ? PETSC_TRUE : PETSC_FALSE;

  for (PetscInt j = 0; j < modes->n && alone; j++)
    if (j != k && cabs(modes->lambda[j] - modes->lambda[k]) <= modes->error[j] + modes->error[k]) alone = PETSC_FALSE;
  return alone ? 0 : modes->error[k];
}

/* Solves a point, and finds its branches */
static PetscErrorCode SampleSolvePoint(Sample s, PetscInt i, SamplePoint *point)
{
  ReducedModes modes;
  PetscReal   *p;
  PetscInt    *branch;
  PetscBool    damped;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(s->box.n_parameters, &p));
  PetscCall(SampleParameters(s, i, p));
  damped = ReducedIsDamped(&s->box.basis.reduced, p);
  PetscCall(SampleModesAt(s, p, &modes, &branch));
  PetscCall(PetscMalloc1(modes.n, &point->mode));
  point->n     = 0;
  point->worst = ReducedModesWorst(&modes, &s->box.window, PETSC_FALSE);
  for (PetscInt k = 0; k < modes.n; k++)
    if (BoxHolds(&s->box, modes.lambda[k]))
      point->mode[point->n++] = (SampleMode){creal(modes.lambda[k]), cimag(modes.lambda[k]), modes.error[k],
                                             GrowthError(&modes, k, damped), branch[k]};
  PetscCall(PetscFree(branch));
  PetscCall(ReducedModesDestroy(&modes));
  PetscCall(PetscFree(p));
  PetscFunctionReturn(0);
}

/* Solves the points of the list from the first on that is not yet */
static PetscErrorCode PointsRun(Sample s, PetscInt n, PetscInt list[])
{
  const PetscInt batch = BATCH * s->box.groups.n_groups;
  PetscMPIInt    rank;
  Progress       progress;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(s->comm, &rank));
  PetscCall(ProgressBegin(&progress, "samples", n));
  for (PetscInt first = s->pass.first; first < n; first += batch) {
    const PetscInt last = PetscMin(n, first + batch);

    for (PetscInt k = first; k < last; k++) {
      PetscCall(PetscFree(s->point[list[k]].mode));
      if (PointGroupsOwner(&s->box.groups, k) == rank) PetscCall(SampleSolvePoint(s, list[k], &s->point[list[k]]));
      PetscCall(ProgressStep(&progress));
    }
    PetscCall(SampleKeep(s, PETSC_FALSE, first, last - first, &list[first]));
    PetscCall(SampleShare(s, first, last - first, &list[first]));
  }
  PetscCall(ProgressEnd(&progress));
  PetscFunctionReturn(0);
}

/* The points whose error exceeds rtol, the worst in front: list, and how many */
static PetscErrorCode PointsExceeding(Sample s, PetscInt *n, PetscInt list[])
{
  PetscReal *worst;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(s->n_points, &worst));
  *n = 0;
  for (PetscInt i = 0; i < s->n_points; i++) {
    if (s->point[i].worst <= s->box.rtol) continue;
    worst[*n] = -s->point[i].worst;
    list[*n]  = i;
    *n        = *n + 1;
  }
  PetscCall(PetscSortRealWithArrayInt(*n, worst, list));
  PetscCall(PetscFree(worst));
  PetscFunctionReturn(0);
}

/* A pass over the points of the list. All are solved anew where the nominal modes are no longer as many as in the pass
   before, since branches are numbered by them. */
static PetscErrorCode SamplePassRun(Sample s)
{
  SamplePass *pass = &s->pass;
  PetscInt   *all;

  PetscFunctionBeginUser;
  if (!pass->begun) PetscCall(SampleKeep(s, PETSC_TRUE, 0, pass->n, pass->list));
  PetscCall(BasisGrow(s, pass->n, pass->list));
  PetscCall(NominalSolve(s));
  if (pass->round && s->nominal.n != pass->n_before) {
    PetscCall(PetscMalloc1(s->n_points, &all));
    for (PetscInt i = 0; i < s->n_points; i++) all[i] = i;
    PetscCall(PointsRun(s, s->n_points, all));
    PetscCall(PetscFree(all));
  } else {
    PetscCall(PointsRun(s, pass->n, pass->list));
  }
  pass->n_before = s->nominal.n;
  pass->first    = 0;
  pass->begun    = PETSC_FALSE;
  PetscFunctionReturn(0);
}

PetscErrorCode SamplePoints(Sample s)
{
  SamplePass *pass = &s->pass;
  PetscInt    n;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(s->n_points, &s->point));
  PetscCall(PetscMalloc1(s->n_points, &pass->list));
  pass->n = s->n_points;
  for (PetscInt i = 0; i < pass->n; i++) pass->list[i] = i;
  PetscCall(SampleResume(s));
  for (; pass->round < SAMPLE_ROUNDS && pass->n; pass->round++) {
    PetscCall(SamplePassRun(s));
    if (s->box.whole) break;
    PetscCall(PointsExceeding(s, &pass->n, pass->list));
  }
  n = pass->n;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &s->n_divided, 1, MPIU_INT, MPI_SUM, s->comm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &s->n_large, 1, MPIU_INT, MPI_SUM, s->comm));
  PetscCheck(s->box.whole || !n, s->comm, PETSC_ERR_NOT_CONVERGED,
             "-sample_rtol %.6g was not reached at %" PetscInt_FMT " of the %" PetscInt_FMT
             " points; raise -sample_rtol or -sample_max_solutions",
             (double)s->box.rtol, n, s->n_points);
  PetscFunctionReturn(0);
}
