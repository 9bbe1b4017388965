/*
   A basis over a box. Points are chosen by the greedy choice of a sweep (basis/greedy.c) among those that are given,
   whatever their number of parameters: by their distances first, then by the estimated error.

   The contact status of a point is that of its own sliding state (status.c).
*/
#include "box.h"
#include "base/algebra/dense.h"

#define BOX_LOOKS  6    /* at other points after a full solution, of the statuses that there are */
#define BOX_MANY   0.2  /* of rtol, for the basis; the rest is for the fewer vectors that many points are on */
#define BOX_SAFE   0.2  /* of that, where corrections are made: all other points are asked for their estimates, too */
#define BOX_ENERGY 0.05 /* of that, what the corrections of a mode may lose */
#define BOX_GUARD                                                                                                      \
  0.03 /* as basis/greedy.c holds modes beyond the band, so that branches are followed across its ends */

PetscErrorCode BoxSetRooms(Box *box, MPI_Comm comm, Operators operators, const PetscReal p[], Modes modes,
                           Statics statics)
{
  PetscFunctionBeginUser;
  box->comm      = comm;
  box->operators = operators;
  box->modes     = modes;
  box->statics   = statics;
  PetscCall(PetscFree(box->nominal));
  PetscCall(OperatorsCreatePoint(operators, p, &box->nominal));
  PetscFunctionReturn(0);
}

/* Room for samples is that of the full solutions and of the points that are only looked at */
static PetscErrorCode BoxBeginGreedy(Box *box)
{
  Greedy *g = &box->greedy;

  PetscFunctionBeginUser;
  g->modes       = box->modes;
  g->window      = box->window;
  g->groups      = &box->groups;
  g->rtol        = box->rtol;
  g->goal        = box->many ? BOX_MANY : 1;
  g->safe        = BOX_SAFE * g->goal;
  g->option      = box->option;
  g->advice      = box->advice;
  g->max_samples = box->max_solutions;
  g->progress    = &box->progress;
  g->last        = PETSC_MAX_REAL;
  g->most_looks  = BOX_LOOKS;
  g->lazy        = PETSC_TRUE;
  g->energy      = BOX_ENERGY * g->safe * box->rtol;
  PetscCall(PetscCalloc1(g->max_samples + 2 + LOOK_MOST, &g->sample));
  PetscFunctionReturn(0);
}

PetscErrorCode BoxSetUp(Box *box, PetscInt n, StaticsPoint get, void *ctx)
{
  PetscReal   band[2];
  PetscMPIInt size;

  PetscFunctionBeginUser;
  PetscCall(ModesGetBand(box->modes, band, &box->window.growth));
  PetscCall(ModesGetLimit(box->modes, &box->limit));
  box->window.low  = 2 * PETSC_PI * band[0];
  box->window.high = 2 * PETSC_PI * band[1];
  PetscCallMPI(MPI_Comm_size(box->comm, &size));
  box->groups = (PointGroups){box->comm, box->n_groups ? box->n_groups : size, NULL};
  PetscCall(BoxLinearise(box, n, get, ctx));
  PetscCall(PencilSetParameters(box->pencil, box->nominal));
  PetscCall(ModesSetPencil(box->modes, box->pencil));
  PetscCall(BasisCreate(box->comm, box->pencil, &box->basis));
  box->basis.reduced.limit = box->limit;
  PetscCall(BoxBeginGreedy(box));
  PetscCall(BasisFillWhole(&box->basis, &box->whole));
  if (box->whole) box->window.rtol = PETSC_MAX_REAL;
  if (!box->whole) box->basis.reduced.left_out = box->greedy.energy;
  PetscFunctionReturn(0);
}

/* Where modes beyond the growth that was asked for were found, window.rtol admits those that are known well */
PetscErrorCode BoxFit(Box *box, PetscInt n, const PetscReal points[])
{
  Greedy    *g     = &box->greedy;
  PointStore store = {0};

  PetscFunctionBeginUser;
  if (box->whole) PetscFunctionReturn(0);
  box->groups.store = &store;
  if (box->journal && !box->kept.basis) {
    box->kept = (BasisKept){.journal = box->journal, .basis = &box->basis, .greedy = &box->greedy, .begin = box->begin};
    PetscCall(BasisResume(&box->kept));
  }
  PetscCall(GreedyRun(g, n, points, &box->basis));
  box->groups.store = NULL;
  PetscCall(PointStoreDestroy(&store));
  if (g->reach > box->window.growth) box->window.rtol = box->rtol / POINTS_MARGIN;
  PetscFunctionReturn(0);
}

/* The window and a little more */
static ReducedWindow WindowGuarded(const Box *box)
{
  ReducedWindow guarded = box->window;

  guarded.low  = guarded.low < 0.5 * guarded.high ? 0 : guarded.low * (1 - BOX_GUARD);
  guarded.high = guarded.high * (1 + BOX_GUARD);
  return guarded;
}

/* Modes at p by the turned basis, in coordinates of the basis, without errors */
static PetscErrorCode SolveTurned(const Box *box, const ReducedWindow *window, const PetscReal p[], ReducedModes *modes)
{
  const PetscInt n = box->turned.n_used;
  PetscComplex  *turned;

  PetscFunctionBeginUser;
  PetscCall(ReducedSolve(&box->turned, p, window, modes));
  PetscCall(PetscMalloc1(modes->n * n, &turned));
  for (int left = 0; left < 2; left++) {
    PetscComplex *const x = left ? modes->y : modes->x;

    PetscCall(PetscArraycpy(turned, x, modes->n * n));
    PetscCall(DenseTimes(&(DenseBlock){box->turn, n, n, n}, PETSC_FALSE, modes->n, turned, x));
  }
  PetscCall(PetscFree(turned));
  PetscFunctionReturn(0);
}

/* Errors on few vectors are those beside the basis, and its own */
PetscErrorCode BoxSolve(const Box *box, PetscBool small, const PetscReal p[], ReducedModes *modes)
{
  const ReducedWindow guarded = WindowGuarded(box);

  PetscFunctionBeginUser;
  if (!small && box->turned.n_used) {
    PetscCall(SolveTurned(box, &guarded, p, modes));
    PetscCall(PointEstimate(&box->basis.reduced, p, modes));
    for (PetscInt i = 0; i < modes->n; i++) modes->error[i] += box->turned.core.rtol * cabs(modes->lambda[i]);
  } else {
    PetscCall(PointStoreSolve(NULL, small ? &box->small : &box->basis.reduced, &guarded, p, modes));
  }
  for (PetscInt i = 0; i < modes->n && small; i++) modes->error[i] += box->greedy.worst * cabs(modes->lambda[i]);
  PetscFunctionReturn(0);
}

PetscErrorCode BoxSolveAll(const Box *box, PetscInt n, const PetscReal points[], ReducedModes modes[])
{
  const ReducedWindow guarded = WindowGuarded(box);
  PetscMPIInt         rank;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(box->comm, &rank));
  PetscCall(PetscMemzero(modes, (size_t)n * sizeof(*modes)));
  for (PetscInt i = 0; i < n; i++)
    if (PointGroupsOwner(&box->groups, i) == rank)
      PetscCall(ReducedSolve(&box->basis.reduced, &points[i * box->n_parameters], &guarded, &modes[i]));
  for (PetscInt i = 0; i < n; i++)
    PetscCall(ReducedModesBroadcast(box->comm, PointGroupsOwner(&box->groups, i), &modes[i]));
  PetscFunctionReturn(0);
}

PetscBool BoxHolds(const Box *box, PetscComplex lambda)
{
  const ReducedWindow *w = &box->window;

  return cimag(lambda) >= w->low && cimag(lambda) <= w->high ? PETSC_TRUE : PETSC_FALSE;
}

/* Whether both points have a mode inside the window that the other has none for */
static PetscBool BranchesLack(const Box *box, const BoxModes *a, const BoxModes *b, const PetscInt from[])
{
  PetscInt lonely_a = 0, lonely_b = 0;

  for (PetscInt i = 0; i < a->modes->n; i++) {
    PetscBool goes_on = a->branch[i] < 0 ? PETSC_TRUE : PETSC_FALSE;

    for (PetscInt j = 0; j < b->modes->n; j++)
      if (from[j] == i) goes_on = PETSC_TRUE;
    if (!goes_on && BoxHolds(box, a->modes->lambda[i])) lonely_a++;
  }
  for (PetscInt j = 0; j < b->modes->n; j++)
    if (from[j] < 0 && BoxHolds(box, b->modes->lambda[j])) lonely_b++;
  return lonely_a && lonely_b ? PETSC_TRUE : PETSC_FALSE;
}

/* Whether modes are those of the model of fewer vectors */
static PetscBool BoxIsSmall(const Box *box, const ReducedModes *modes)
{
  return modes->size == box->small.n_used ? PETSC_TRUE : PETSC_FALSE;
}

/* By way of the middle, in two halves */
static PetscErrorCode FollowDivided(const Box *box, const BoxModes *a, BoxModes *b, int depth, PetscInt *n_solved)
{
  ReducedModes modes;
  PetscReal   *p;
  BoxModes     middle = {.modes = &modes};

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(box->n_parameters, &p));
  for (PetscInt k = 0; k < box->n_parameters; k++) p[k] = 0.5 * (a->p[k] + b->p[k]);
  middle.p = p;
  PetscCall(BoxSolve(box, BoxIsSmall(box, a->modes), p, &modes));
  ++*n_solved;
  PetscCall(PetscMalloc1(modes.n, &middle.branch));
  PetscCall(BoxFollow(box, a, &middle, depth - 1, n_solved));
  PetscCall(BoxFollow(box, &middle, b, depth - 1, n_solved));
  PetscCall(PetscFree(middle.branch));
  PetscCall(ReducedModesDestroy(&modes));
  PetscCall(PetscFree(p));
  PetscFunctionReturn(0);
}

PetscErrorCode BoxFollow(const Box *box, const BoxModes *a, BoxModes *b, int depth, PetscInt *n_solved)
{
  PetscInt *from;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(b->modes->n, &from));
  PetscCall(TrackSure(BoxIsSmall(box, a->modes) ? &box->small : &box->basis.reduced, (const PetscReal *[]){a->p, b->p},
                      a->modes, b->modes, from));
  if (depth > 0 && BranchesLack(box, a, b, from)) {
    PetscCall(FollowDivided(box, a, b, depth, n_solved));
  } else {
    for (PetscInt j = 0; j < b->modes->n; j++) b->branch[j] = from[j] < 0 ? -1 : a->branch[from[j]];
  }
  PetscCall(PetscFree(from));
  PetscFunctionReturn(0);
}

PetscErrorCode BoxForgetSmall(Reduced *small)
{
  PetscFunctionBeginUser;
  for (PetscInt t = 0; t < small->n_terms && small->A; t++) {
    PetscCall(PetscFree(small->A[t]));
    PetscCall(PetscFree(small->D[t]));
    PetscCall(PetscFree(small->factors[t].left));
    PetscCall(PetscFree(small->factors[t].right));
  }
  PetscCall(PetscFree(small->factors));
  PetscCall(PetscFree(small->A));
  PetscCall(PetscFree(small->D));
  *small = (Reduced){0};
  PetscFunctionReturn(0);
}

PetscErrorCode BoxDestroy(Box *box)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(box->nominal));
  PetscCall(BoxForgetSmall(&box->small));
  PetscCall(BoxForgetSmall(&box->turned));
  PetscCall(PetscFree(box->turn));
  PetscCall(PetscFree(box->few));
  PetscCall(GreedyDestroy(&box->greedy));
  PetscCall(BasisDestroy(&box->basis));
  PetscCall(PencilDestroy(&box->pencil));
  PetscCall(StatusListDestroy(&box->statuses));
  PetscCall(PetscFree(box->groups_of.closed));
  PetscCall(PetscFree(box->status));
  PetscFunctionReturn(0);
}
