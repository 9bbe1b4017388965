/*
   Unit test of sweep/: changes of contact status along a line. Statuses and their groups of pairs on several ranks;
   branches and events across a jump of a small model, hidden by a congruence, with the parameters v and c,

      K = diag(1 + v + c / 2, 2, 5, 7 + 0.3 c) + w (e0 e1' - e1 e0'),   M = 1,   w = 0.05,

   whose first two modes are unstable for |v - 1 + c / 2| < 2 w: with c = 1 from v = 0.4 to 0.6, with c = 0 from 0.9 on.
*/
#include "check.h"
#include "densereduced.h"
#include "petscmain.h"
#include "sweep/line.h"

#define N_STATUSES 4
#define N_PAIRS    10
#define N_PLACES   12

static const ReducedWindow everything = {0, 100, 100, 0};

/* Pair p of ten in status s; each rank has those with p mod ranks = rank */
static PetscBool IsClosed(PetscInt s, PetscInt p)
{
  if (p == 9) return PETSC_FALSE;                                 /* never */
  if (p == 7 || p == 8) return s == 0 ? PETSC_TRUE : PETSC_FALSE; /* together */
  if (p == 0) return s != 2 ? PETSC_TRUE : PETSC_FALSE;
  return PETSC_TRUE;
}

/* Statuses 0, 1, 2, and 0 once more. Breaks when: ranks number statuses or groups differently, a status is taken for
   another one, or pairs of different histories share a group. Reference: IsClosed(), counted by hand */
static PetscErrorCode TestStatuses(int *failed)
{
  const PetscInt expected[3] = {9, 7, 6};
  PetscInt       index[N_STATUSES], group[N_PAIRS], n_groups, n_local = 0, wrong = 0;
  PetscMPIInt    rank, size;
  PetscReal     *value;
  StatusList     list;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(PETSC_COMM_WORLD, &rank));
  PetscCallMPI(MPI_Comm_size(PETSC_COMM_WORLD, &size));
  for (PetscInt p = rank; p < N_PAIRS; p += size) n_local++;
  PetscCall(StatusListCreate(PETSC_COMM_WORLD, n_local, &list));
  for (PetscInt s = 0; s < N_STATUSES; s++) {
    PetscBool closed[N_PAIRS];

    for (PetscInt i = 0; i < n_local; i++) closed[i] = IsClosed(s % 3, rank + i * size);
    PetscCall(StatusListAdd(&list, closed, &index[s]));
    *failed += CheckTrue("index of a status", index[s] == s % 3, (double)index[s]);
  }
  *failed += CheckTrue("different statuses", list.n == 3 && list.n_pairs == N_PAIRS, (double)list.n);
  for (PetscInt s = 0; s < list.n; s++)
    *failed += CheckTrue("pairs closed", list.n_closed[s] == expected[s], (double)list.n_closed[s]);
  PetscCall(StatusListGroup(&list, group, &n_groups, &value));
  *failed += CheckTrue("groups", n_groups == 2, (double)n_groups);
  for (PetscInt i = 0; i < n_local; i++)
    for (PetscInt s = 0; s < 3 && n_groups == 2; s++) {
      const PetscReal closed = group[i] > 0 ? value[s * 2 + group[i] - 1] : (PetscReal)(group[i] + 1);

      wrong += closed != (PetscReal)IsClosed(s, rank + i * size);
    }
  *failed += CheckTrue("values of groups that differ from the status", wrong == 0, (double)wrong);
  PetscCall(PetscFree(value));
  PetscCall(StatusListDestroy(&list));
  PetscFunctionReturn(0);
}

/* The model of the file's head */
static void ModelCreateJump(Dense *dense)
{
  const PetscReal  kappa[4] = {1, 2, 5, 7}, slope[4] = {1, 0, 0, 0}, w = 0.05;
  const DenseEntry flutter[2] = {
    {0, 1, w },
    {1, 0, -w}
  };
  const PetscReal by_c[16] = {[0] = 0.5, [15] = 0.3};

  DenseDiagonal(dense, 4, kappa, slope, 2, flutter);
  DenseAdd(dense, OPERATORS_STIFFNESS, 0, by_c);
  dense->system.term[dense->system.reduced.n_terms - 1].factor[0].parameter = 1;
  dense->system.reduced.n_parameters                                        = 2;
}

/* Places 0.05, 0.15, ... 0.95 and the ends of a bracket about 0.5, above which c = 0 */
static PetscErrorCode PlacesCreate(const Dense *dense, Sweep sweep, LinePoints *points)
{
  static PetscReal value[N_PLACES], p[2 * N_PLACES], closed[2] = {1, 0}, base[2];
  static PetscInt  swept[1] = {0};

  PetscFunctionBeginUser;
  sweep->grid = (SweepGrid){.n_axes       = 1,
                            .n_moved      = {1},
                            .parameter    = {swept},
                            .n_parameters = 2,
                            .n_groups     = 1,
                            .closed       = closed,
                            .base         = base};
  PetscCall(PetscCalloc1(N_PLACES, &sweep->grid.place));
  sweep->grid.n_places = N_PLACES;
  sweep->basis.reduced = dense->system.reduced;
  sweep->window        = everything;
  points->n            = N_PLACES;
  points->value        = value;
  points->p            = p;
  PetscCall(PetscCalloc2(N_PLACES, &points->modes, N_PLACES, &points->branch));
  for (PetscInt k = 0; k < N_PLACES; k++) {
    SweepPlace *place = &sweep->grid.place[k];

    value[k] = k < 5 ? 0.05 + 0.1 * (double)k : 0.05 + 0.1 * (double)(k - 2);
    if (k == 5 || k == 6) value[k] = k == 5 ? 0.4999 : 0.5001;
    place->value[0] = value[k];
    place->status   = k > 5;
    GridFill(&sweep->grid, place, p + 2 * k);
    PetscCall(ReducedSolve(&dense->system.reduced, p + 2 * k, &everything, &points->modes[k]));
    PetscCall(PetscMalloc1(points->modes[k].n, &points->branch[k]));
  }
  PetscFunctionReturn(0);
}

/* The onset of event e is found with the status of its own segment */
static PetscErrorCode CheckOnset(Sweep sweep, PetscInt e, BranchEventKind kind, PetscReal expected, int *failed)
{
  const PetscReal  ends[2] = {0.05, 0.95};
  BranchEvent      event;
  PetscReal        p[2];
  const PetscInt   parameter[1] = {0};
  const BranchLine line         = {1, 2, parameter, ends, p, &everything};

  PetscFunctionBeginUser;
  if (e >= sweep->events.n) PetscFunctionReturn(0);
  event = sweep->events.event[e];
  GridFill(&sweep->grid, &sweep->grid.place[event.place], p);
  PetscCall(OnsetFind(&sweep->basis.reduced, &line, &event, NULL));
  *failed += CheckTrue("kind of the onset", event.kind == kind && event.found, (double)event.kind);
  *failed += CheckClose("onset within a segment", event.critical, expected, 1e-10);
  PetscFunctionReturn(0);
}

/* Breaks when: branches are followed across a change of status as if it were smooth, do not go on behind it, or a jump
   is not told from an onset. Reference: closed form of the file's head */
static PetscErrorCode TestSegments(int *failed)
{
  struct _p_Sweep sweep;
  LinePoints      points;
  Dense           dense;
  PetscInt        wrong = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscMemzero(&sweep, sizeof(sweep)));
  PetscCall(PetscMemzero(&points, sizeof(points)));
  ModelCreateJump(&dense);
  PetscCall(PlacesCreate(&dense, &sweep, &points));
  PetscCall(LineTrackSegments(&sweep, &points));
  *failed += CheckTrue("branches", sweep.n_branches == 4, (double)sweep.n_branches);
  for (PetscInt k = 0; k < N_PLACES; k++)
    for (PetscInt i = 2; i < 4; i++) wrong += points.branch[k][i] != points.branch[0][i];
  *failed += CheckTrue("single modes that changed their branch", wrong == 0, (double)wrong);
  *failed += CheckTrue("events", sweep.events.n == 3, (double)sweep.events.n);
  if (sweep.events.n == 3) {
    const BranchEvent *jump = &sweep.events.event[2]; /* found when the segments on both sides are known */

    *failed += CheckTrue("a jump, unstable below", jump->kind == EVENT_JUMP && !jump->above, (double)jump->kind);
    *failed += CheckClose("its place", jump->critical, 0.5, 1e-12);
    *failed += CheckClose("half its bracket", jump->error, 1e-4, 1e-12);
    *failed += CheckClose("omega below it", jump->omega * jump->omega, 2, 3e-3);
    *failed += CheckTrue("with a partner", jump->branch[0] >= 0 && jump->branch[1] >= 0, (double)jump->branch[1]);
  }
  PetscCall(CheckOnset(&sweep, 0, EVENT_LOCK_IN, 0.4, failed));
  PetscCall(CheckOnset(&sweep, 1, EVENT_LOCK_IN, 0.9, failed));
  for (PetscInt k = 0; k < N_PLACES; k++) {
    PetscCall(ReducedModesDestroy(&points.modes[k]));
    PetscCall(PetscFree(points.branch[k]));
  }
  PetscCall(PetscFree2(points.modes, points.branch));
  PetscCall(PetscFree(sweep.grid.place));
  PetscCall(BranchEventsDestroy(&sweep.events));
  PetscFunctionReturn(0);
}

/* Three modes that a jump mixes: K = diag(1, 2, 3, 9) before, Q diag(1.1, 2.1, 3.1) Q' with Q = 1 - 2/3 e e' after,
   whose overlaps are 1/9 and 4/9. Breaks when: a doubtful match is forced. Reference: Q */
static PetscErrorCode TestDoubt(int *failed)
{
  const PetscReal before[16] = {[0] = 1, [5] = 2, [10] = 3, [15] = 9}, after[3] = {1.1, 2.1, 3.1}, p[2] = {0, 1};
  PetscReal       change[16]   = {0};
  PetscInt        branch[2][4] = {
           {0, 1, 2, 3},
           {4, 5, 6, 7}
  };
  ReducedModes modes[2];
  BranchEvents events = {0};
  Dense        dense;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < 9; i++) {
    const PetscInt r = i / 3, c = i % 3;

    for (PetscInt k = 0; k < 3; k++) change[4 * r + c] += ((r == k) - 2.0 / 3) * after[k] * ((c == k) - 2.0 / 3);
    change[4 * r + c] -= before[4 * r + c];
  }
  DenseBegin(&dense, 4, PETSC_TRUE);
  DenseAddUnitMass(&dense);
  DenseAdd(&dense, OPERATORS_STIFFNESS, -1, before);
  DenseAdd(&dense, OPERATORS_STIFFNESS, 0, change);
  for (int k = 0; k < 2; k++) PetscCall(ReducedSolve(&dense.system.reduced, &p[k], &everything, &modes[k]));
  PetscCall(TrackJump(&dense.system.reduced, &p[1], &(BranchPoint){0, &modes[0], branch[0]},
                      &(BranchPoint){1, &modes[1], branch[1]}, &events));
  *failed += CheckTrue("branches that begin anew", branch[1][0] == 4 && branch[1][1] == 5 && branch[1][2] == 6,
                       (double)branch[1][0]);
  *failed += CheckTrue("a branch that goes on", branch[1][3] == 3, (double)branch[1][3]);
  *failed += CheckTrue("no event of stable modes", events.n == 0, (double)events.n);
  for (int k = 0; k < 2; k++) PetscCall(ReducedModesDestroy(&modes[k]));
  PetscCall(BranchEventsDestroy(&events));
  PetscFunctionReturn(0);
}

static PetscErrorCode Tests(PetscMPIInt size, int *failed)
{
  PetscFunctionBeginUser;
  (void)size;
  PetscCall(TestStatuses(failed));
  PetscCall(TestSegments(failed));
  PetscCall(TestDoubt(failed));
  PetscFunctionReturn(0);
}

int main(int argc, char **argv)
{
  return PetscMain(argc, argv, Tests);
}
