/*
   The places of the grid, one line of the first parameter after the other: solutions on the reduced model, branches
   along the line, the link to the line before, and names from the shapes on the mesh. Vectors are kept for one line
   only.
*/
#include "line.h"

/* A line has at least its n[0] points of the grid, in order, and between them the ends of brackets of a change of
   status (grid/sliding.c). */
PetscErrorCode LineCreate(Sweep sweep, PetscInt line, LinePoints *points)
{
  const SweepGrid *grid         = &sweep->grid;
  const PetscInt   n_parameters = grid->n_parameters;

  PetscFunctionBeginUser;
  *points       = (LinePoints){0};
  points->first = grid->at[line * grid->n[0]];
  points->n     = grid->at[(line + 1) * grid->n[0] - 1] + 1 - points->first;
  PetscCall(PetscCalloc4(points->n, &points->value, points->n * n_parameters, &points->p, points->n, &points->modes,
                         points->n, &points->branch));
  for (PetscInt i = 0; i < points->n; i++) {
    points->value[i] = grid->place[points->first + i].value[0];
    GridFill(grid, &grid->place[points->first + i], &points->p[i * n_parameters]);
  }
  PetscFunctionReturn(0);
}

/* A line with its modes on the reduced model */
static PetscErrorCode LineSolve(Sweep sweep, PetscInt line, LinePoints *points)
{
  PetscFunctionBeginUser;
  PetscCall(LineCreate(sweep, line, points));
  PetscCall(PointsSolve(&sweep->groups, &sweep->basis.reduced, &sweep->window, points->n, points->p, points->modes));
  for (PetscInt i = 0; i < points->n; i++) PetscCall(PetscMalloc1(points->modes[i].n, &points->branch[i]));
  PetscFunctionReturn(0);
}

PetscErrorCode LineDestroy(LinePoints *points)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < points->n; i++) {
    PetscCall(ReducedModesDestroy(&points->modes[i]));
    PetscCall(PetscFree(points->branch[i]));
    if (points->name) PetscCall(PetscFree(points->name[i]));
  }
  PetscCall(PetscFree(points->name));
  PetscCall(PetscFree4(points->value, points->p, points->modes, points->branch));
  points->n = 0;
  PetscFunctionReturn(0);
}

/* Rank 0 has followed the branches; the counts go first, as the others need room for the events. Events before
   n_before are alike on all ranks already. */
PetscErrorCode SweepShareEvents(Sweep sweep, PetscInt n_before)
{
  BranchEvents *events = &sweep->events;
  PetscInt      n[3]   = {sweep->n_branches, sweep->n_broken, events->n};
  PetscMPIInt   bytes;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Bcast(n, 3, MPIU_INT, 0, sweep->comm));
  sweep->n_branches = n[0];
  sweep->n_broken   = n[1];
  PetscCall(PetscRealloc(PetscMax(1, n[2]) * sizeof(BranchEvent), &events->event));
  events->n = n[2];
  PetscCall(PetscMPIIntCast((PetscInt)sizeof(BranchEvent) * (n[2] - n_before), &bytes));
  if (bytes) PetscCallMPI(MPI_Bcast(&events->event[n_before], bytes, MPI_BYTE, 0, sweep->comm));
  PetscFunctionReturn(0);
}

/* Gives all ranks the branches and events of rank 0, from event n_before on */
static PetscErrorCode TrackBroadcast(Sweep sweep, PetscInt n_before, LinePoints *points)
{
  PetscFunctionBeginUser;
  PetscCall(SweepShareEvents(sweep, n_before));
  for (PetscInt i = 0; i < points->n; i++)
    PetscCallMPI(MPI_Bcast(points->branch[i], (PetscMPIInt)points->modes[i].n, MPIU_INT, 0, sweep->comm));
  PetscFunctionReturn(0);
}

/* Gives branches of this line the numbers of those of the line before where their first points match; numbers from
   first_new and events from first_event on are those of this line */
static PetscErrorCode PointsLink(Sweep sweep, const LinePoints *before, PetscInt first_new, PetscInt first_event,
                                 LinePoints *points)
{
  const PetscInt n_new = sweep->n_branches - first_new;
  PetscInt      *from, *rename;
  PetscBool      certain;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(points->modes[0].n, &from, n_new, &rename));
  for (PetscInt b = 0; b < n_new; b++) rename[b] = -1;
  PetscCall(TrackMatch(&sweep->basis.reduced, points->p, &before->modes[0], &points->modes[0], from, &certain));
  for (PetscInt i = 0; i < points->modes[0].n; i++)
    if (from[i] >= 0) rename[points->branch[0][i] - first_new] = before->branch[0][from[i]];
  PetscCall(LineRename(sweep, first_new, rename, points->n, first_event, points));
  PetscCall(PetscFree2(from, rename));
  PetscFunctionReturn(0);
}

/* The record of each point, and the largest relative error of the places between, which belong to no point. condition
   = 1 / |y^T D x| >= 1 is by what factor errors of the matrices count in lambda; infinite at a defective pair. */
static PetscErrorCode PointsKeep(Sweep sweep, const LinePoints *points)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < points->n; i++) {
    const ReducedModes *modes = &points->modes[i];
    const PetscInt      at    = sweep->grid.place[points->first + i].point;
    SweepPoint         *point = &sweep->point[PetscMax(at, 0)];

    sweep->worst[points->first + i] = ReducedModesWorst(modes, &sweep->window, PETSC_FALSE);
    if (at < 0) continue;
    point->n = modes->n;
    PetscCall(PetscCalloc1(modes->n, &point->mode));
    for (PetscInt k = 0; k < modes->n; k++) {
      point->mode[k].sigma     = creal(modes->lambda[k]);
      point->mode[k].omega     = cimag(modes->lambda[k]);
      point->mode[k].error     = sweep->method == SWEEP_REAL ? NAN : modes->error[k];
      point->mode[k].noise     = modes->noise[k];
      point->mode[k].condition = cabs(modes->product[k]) > 0 ? 1 / cabs(modes->product[k]) : INFINITY;
      point->mode[k].branch    = points->branch[i][k];
      if (points->name) PetscCall(PetscStrncpy(point->mode[k].label, points->name[i][k].text, 32));
    }
  }
  PetscFunctionReturn(0);
}

/* Where each branch is looked at for its name, or -1: where it grows faster than anywhere before, on this or on an
   earlier line; a branch without a name and without growth nearest to the middle of the line */
static void LabelPoints(Sweep sweep, const LinePoints *points, PetscInt at[])
{
  for (PetscInt b = 0; b < sweep->n_branches; b++) at[b] = -1;
  for (PetscInt i = 0; i < points->n; i++)
    for (PetscInt k = 0; k < points->modes[i].n; k++) {
      const PetscInt  b = points->branch[i][k], middle = points->n / 2;
      const PetscReal sigma = PetscAbsReal(creal(points->modes[i].lambda[k]));
      PetscBool       nearer, unnamed;

      if (b < 0) continue;
      nearer  = at[b] < 0 || PetscAbsInt(i - middle) < PetscAbsInt(at[b] - middle) ? PETSC_TRUE : PETSC_FALSE;
      unnamed = sweep->label[b].text[0] ? PETSC_FALSE : PETSC_TRUE;
      if (sigma < sweep->label[b].growth || (sigma == sweep->label[b].growth && !(unnamed && nearer))) continue;
      at[b]                  = i;
      sweep->label[b].growth = sigma;
    }
}

/* Gives the branches that are to be looked at at point i the names of their modes there, known before */
static PetscErrorCode PointTakeNames(Sweep sweep, const LinePoints *points, PetscInt i, const PetscInt at[])
{
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < points->modes[i].n; k++) {
    const PetscInt b = points->branch[i][k];

    if (b < 0 || at[b] != i) continue;
    PetscCall(PetscStrncpy(sweep->label[b].text, points->name[i][k].text, sizeof(sweep->label[b].text)));
  }
  PetscFunctionReturn(0);
}

/* Names the branches that are to be looked at at point i by their shapes */
static PetscErrorCode PointLabel(Sweep sweep, const LinePoints *points, PetscInt i, const PetscInt at[])
{
  const ReducedModes *modes = &points->modes[i];
  ReducedModes        some;
  PetscInt           *list, n = 0;
  char(*label)[32];

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(modes->n, &list, modes->n, &label));
  for (PetscInt k = 0; k < modes->n; k++)
    if (points->branch[i][k] >= 0 && at[points->branch[i][k]] == i) list[n++] = k;
  if (n) {
    PetscCall(ReducedModesSelect(modes, n, list, &some));
    PetscCall(BasisLabelModes(&sweep->basis, sweep->modes, &points->p[i * sweep->grid.n_parameters], &some, label));
    for (PetscInt k = 0; k < n; k++)
      PetscCall(PetscStrncpy(sweep->label[points->branch[i][list[k]]].text, label[k], 32));
    PetscCall(ReducedModesDestroy(&some));
  }
  PetscCall(PetscFree2(list, label));
  PetscFunctionReturn(0);
}

PetscErrorCode SweepClassify(Sweep sweep)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < GridSize(&sweep->grid); i++)
    for (PetscInt k = 0; k < sweep->point[i].n; k++) {
      SweepMode      *m    = &sweep->point[i].mode[k];
      const PetscReal tiny = MODES_TINY * hypot(m->sigma, m->omega);

      m->state     = ModesLimitJudge(&sweep->limit, m->sigma, m->omega, isnan(m->error) ? 0 : m->error);
      m->numerical = m->state == MODE_STABLE && (isinf(m->error) || m->sigma > tiny) ? PETSC_TRUE : PETSC_FALSE;
      if (m->branch >= 0) PetscCall(PetscStrncpy(m->label, sweep->label[m->branch].text, sizeof(m->label)));
    }
  PetscFunctionReturn(0);
}

/* Whether a name is that of a disc's shape */
static PetscBool LabelIsDisc(Sweep sweep, PetscInt branch)
{
  return branch >= 0 && sweep->label[branch].text[0] == '(' ? PETSC_TRUE : PETSC_FALSE;
}

/* Whether modes k - 1 and k are the two members of a lock-in pair, lambda and -conj(lambda): mirror images in the
   growth, equal within what sorting calls an equal frequency (PAIR of dense/reduced.c). */
static PetscBool ModesArePair(const ReducedModes *modes, PetscInt k)
{
  const PetscComplex a = modes->lambda[k - 1], b = modes->lambda[k];

  return creal(b) > 0 && cabs(a + conj(b)) <= 1e-7 * cabs(b) ? PETSC_TRUE : PETSC_FALSE;
}

/* Which of two branches takes the unstable member of a pair is a matter of choice: the one named after the disc does */
static PetscErrorCode PairsByLabel(Sweep sweep, PetscInt first_event, const LinePoints *points)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < points->n; i++)
    for (PetscInt k = 1; k < points->modes[i].n; k++) {
      PetscInt      *a = &points->branch[i][k - 1], *b = &points->branch[i][k];
      const PetscInt unstable = *b;

      if (!ModesArePair(&points->modes[i], k) || LabelIsDisc(sweep, *b) || !LabelIsDisc(sweep, *a)) continue;
      *b = *a;
      *a = unstable;
    }
  for (PetscInt e = first_event; e < sweep->events.n; e++) {
    PetscInt *branch = sweep->events.event[e].branch, first = branch[0];

    if (branch[1] < 0 || LabelIsDisc(sweep, branch[0]) || !LabelIsDisc(sweep, branch[1])) continue;
    branch[0] = branch[1];
    branch[1] = first;
  }
  PetscFunctionReturn(0);
}

PetscReal SweepWorst(Sweep sweep)
{
  PetscReal worst = 0;

  for (PetscInt k = 0; k < sweep->grid.n_places; k++) worst = PetscMax(worst, sweep->worst[k]);
  return worst;
}

PetscErrorCode SweepLinesForget(Sweep sweep)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < GridSize(&sweep->grid); i++) PetscCall(PetscFree(sweep->point[i].mode));
  PetscCall(PetscFree(sweep->label));
  PetscCall(PetscFree(sweep->worst));
  PetscCall(BranchEventsDestroy(&sweep->events));
  sweep->n_branches = 0;
  PetscFunctionReturn(0);
}

PetscErrorCode LineFinish(Sweep sweep, PetscInt first_new, PetscInt first_event, LinePoints *points)
{
  PetscInt *at;

  PetscFunctionBeginUser;
  PetscCall(PetscRealloc(sizeof(*sweep->label) * (size_t)PetscMax(1, sweep->n_branches), &sweep->label));
  PetscCall(PetscArrayzero(sweep->label + first_new, sweep->n_branches - first_new));
  PetscCall(PetscMalloc1(sweep->n_branches, &at));
  LabelPoints(sweep, points, at);
  for (PetscInt i = 0; i < points->n; i++) {
    if (points->name)
      PetscCall(PointTakeNames(sweep, points, i, at));
    else
      PetscCall(PointLabel(sweep, points, i, at));
  }
  PetscCall(PetscFree(at));
  PetscCall(PairsByLabel(sweep, first_event, points));
  PetscCall(PointsKeep(sweep, points));
  PetscFunctionReturn(0);
}

/* The free modes that give names, of the first point */
static PetscErrorCode FreeKeep(Sweep sweep)
{
  PetscReal *p;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(sweep->grid.n_parameters, &p));
  GridPoint(&sweep->grid, 0, p);
  PetscCall(BasisKeepFree(&sweep->basis, sweep->modes, p));
  PetscCall(PetscFree(p));
  PetscFunctionReturn(0);
}

/* Lines one after the other, as the first point of each is matched with that of the line before. Branch numbers
   begin at n_before and events at first_event on each line; both are alike on all ranks after TrackBroadcast(). */
PetscErrorCode SweepLines(Sweep sweep)
{
  LinePoints before = {0}, points;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(sweep->grid.n_places, &sweep->worst));
  PetscCall(FreeKeep(sweep));
  for (PetscInt line = 0; line < GridLines(&sweep->grid); line++) {
    const PetscInt n_before = sweep->n_branches, first_event = sweep->events.n;

    PetscCall(LineSolve(sweep, line, &points));
    PetscCall(LineTrackSegments(sweep, &points));
    PetscCall(TrackBroadcast(sweep, first_event, &points));
    if (line) PetscCall(PointsLink(sweep, &before, n_before, first_event, &points));
    PetscCall(LineFinish(sweep, n_before, first_event, &points));
    PetscCall(LineDestroy(&before));
    before = points;
  }
  PetscCall(LineDestroy(&before));
  PetscFunctionReturn(0);
}
