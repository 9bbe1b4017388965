/*
   Contact statuses of the points of a box. A status is a class of points; pairs that are open in some classes and
   closed in others are affine terms of one pencil (grid/groups.c), so that a class is a value of the parameters
   closed_g, 0 or 1, and all classes are projected on one basis.
*/
#include "box.h"

/* Whom BoxLinearise() asks for points, with the nominal one behind them */
typedef struct {
  const Box   *box;
  PetscInt     n;
  StaticsPoint get;
  void        *ctx;
} PointsAndNominal;

static PetscErrorCode PointGet(void *ctx, PetscInt i, PetscReal p[])
{
  const PointsAndNominal *points = ctx;

  PetscFunctionBeginUser;
  if (i < points->n)
    PetscCall(points->get(points->ctx, i, p));
  else
    PetscCall(PetscArraycpy(p, points->box->nominal, points->box->n_base));
  PetscFunctionReturn(0);
}

/* The status of each of n points as a number of the list */
static PetscErrorCode StatusesNumber(Box *box, PetscInt n, const char closed[])
{
  const PetscInt n_local = box->statuses.n_local;
  PetscBool     *row;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n, &box->status));
  PetscCall(PetscMalloc1(n_local, &row));
  for (PetscInt i = 0; i < n; i++) {
    for (PetscInt k = 0; k < n_local; k++) row[k] = closed[(size_t)i * n_local + k] ? PETSC_TRUE : PETSC_FALSE;
    PetscCall(StatusListAdd(&box->statuses, row, &box->status[i]));
  }
  PetscCall(PetscFree(row));
  PetscFunctionReturn(0);
}

/* Keeps the statuses [size] of all points for a run that goes on */
static PetscErrorCode StatusesKeep(Box *box, size_t size, char closed[])
{
  JournalPack pack = {.write = PETSC_TRUE};
  JournalItem item;
  char        name[64];
  PetscBool   kept;

  PetscFunctionBeginUser;
  if (!box->journal) PetscFunctionReturn(0);
  PetscCall(PetscSNPrintf(name, sizeof(name), "%s_restart_statuses", box->begin));
  PetscCall(JournalPackMove(&pack, &box->equilibria, sizeof(box->equilibria)));
  PetscCall(JournalPackMove(&pack, closed, size));
  item = (JournalItem){"statuses", pack.n, pack.word};
  PetscCall(JournalKeep(box->journal, name, 1, &item, &kept));
  PetscCall(JournalPackDestroy(&pack));
  PetscFunctionReturn(0);
}

/* Takes up what StatusesKeep() kept; taken = whether it is there, whole and of this run */
static PetscErrorCode StatusesTake(Box *box, size_t size, char closed[], PetscBool *taken)
{
  JournalItem item = {"statuses", -1, NULL};
  JournalPack pack = {.good = PETSC_TRUE};
  char        name[64], then[64];

  PetscFunctionBeginUser;
  *taken = PETSC_FALSE;
  if (!box->journal) PetscFunctionReturn(0);
  PetscCall(PetscSNPrintf(name, sizeof(name), "%s_restart_statuses", box->begin));
  PetscCall(PetscSNPrintf(then, sizeof(then), "the %s begins anew", box->journal->run));
  PetscCall(JournalTake(box->journal, name, then, 1, &item, taken));
  if (!*taken) PetscFunctionReturn(0);
  pack.word = item.values;
  pack.n    = item.n;
  PetscCall(JournalPackMove(&pack, &box->equilibria, sizeof(box->equilibria)));
  PetscCall(JournalPackMove(&pack, closed, size));
  *taken = pack.good;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, taken, 1, MPIU_BOOL, MPI_LAND, box->comm));
  PetscCall(JournalPackDestroy(&pack));
  PetscFunctionReturn(0);
}

/* Statuses of n points from statics */
static PetscErrorCode StatusesFind(Box *box, PetscInt n, PointsAndNominal *points)
{
  const ContactPair *pair;
  Contact            contact;
  PetscInt           n_local, n_all;
  PetscBool          affine, taken;
  char              *closed;

  PetscFunctionBeginUser;
  PetscCall(StaticsIsAffine(box->statics, &affine));
  PetscCheck(affine, box->comm, PETSC_ERR_SUP,
             "a basis about the sliding state: pairs that hold by friction, friction damping, the stiffness of a "
             "-contact_pressure_law, -static_geometric and -static_follower change with it from point to point; give "
             "-modes_contact all");
  PetscCall(OperatorsGetModel(box->operators, NULL, &contact));
  PetscCall(ContactGetPairs(contact, &n_local, &n_all, &pair));
  PetscCall(StatusListCreate(box->comm, n_local, &box->statuses));
  PetscCall(PetscMalloc1((size_t)n * n_local, &closed));
  PetscCall(StatusesTake(box, (size_t)n * n_local, closed, &taken));
  if (!taken) {
    PetscCall(StaticsSolveMany(box->statics, n, PointGet, points, closed, &box->equilibria));
    PetscCall(StaticsRelease(box->statics));
    PetscCall(StatusesKeep(box, (size_t)n * n_local, closed));
  }
  PetscCall(StatusesNumber(box, n, closed));
  PetscCall(PetscFree(closed));
  PetscFunctionReturn(0);
}

/* The pencil of all statuses, with room for their parameters at the nominal point */
static PetscErrorCode StatusesLinearise(Box *box, PetscInt n)
{
  PetscReal *p;
  PetscBool  exact;

  PetscFunctionBeginUser;
  PetscCall(StatusPencilCreate(&box->statuses, box->operators, &exact, &box->groups_of));
  PetscCheck(!exact, box->comm, PETSC_ERR_SUP,
             "a basis about the sliding state with -contact_law constraint: which pairs are closed changes from point "
             "to point; give -contact_law penalty or -modes_contact all");
  box->n_classes    = box->statuses.n;
  box->pencil       = box->groups_of.pencil;
  box->n_parameters = box->groups_of.n_parameters;
  PetscCall(PetscRealloc((size_t)box->n_parameters * sizeof(*box->nominal), &box->nominal));
  BoxPutStatus(box, n, box->nominal);
  PetscCall(PetscMalloc1(box->n_parameters, &p));
  PetscCall(PetscArraycpy(p, box->nominal, box->n_parameters));
  PetscCall(StatusPencilFormPattern(&box->groups_of, p));
  PetscCall(PetscFree(p));
  PetscFunctionReturn(0);
}

PetscErrorCode BoxLinearise(Box *box, PetscInt n, StaticsPoint get, void *ctx)
{
  const OperatorsParameter *list;

  PetscFunctionBeginUser;
  PetscCall(OperatorsGetParameters(box->operators, &box->n_base, &list));
  if (box->statics) {
    PetscCall(StatusesFind(box, n + 1, &(PointsAndNominal){box, n, get, ctx}));
    PetscCall(StatusesLinearise(box, n));
  } else {
    PetscCall(OperatorsLinearise(box->operators, NULL, &box->pencil));
    PetscCall(PencilGetParameters(box->pencil, &box->n_parameters, NULL, NULL));
  }
  PetscFunctionReturn(0);
}

void BoxPutClass(const Box *box, PetscInt status, PetscReal p[])
{
  const PetscInt n_groups = box->groups_of.n_groups;

  for (PetscInt g = 0; g < n_groups; g++)
    p[box->n_parameters - n_groups + g] = box->groups_of.closed[status * n_groups + g];
}

void BoxPutStatus(const Box *box, PetscInt i, PetscReal p[])
{
  if (box->status) BoxPutClass(box, box->status[i], p);
}

PetscErrorCode BoxFindClasses(Box *box, PetscInt n, StaticsPoint get, void *ctx, PetscInt status[], PetscInt apart[])
{
  const PetscInt n_local = box->statuses.n_local;
  PetscBool     *row;
  char          *closed;
  StaticsMany    how;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2((size_t)n * n_local, &closed, n_local, &row));
  PetscCall(StaticsSolveMany(box->statics, n, get, ctx, closed, &how));
  PetscCall(StaticsRelease(box->statics));
  for (PetscInt i = 0; i < n; i++) {
    for (PetscInt k = 0; k < n_local; k++) row[k] = closed[(size_t)i * n_local + k] ? PETSC_TRUE : PETSC_FALSE;
    PetscCall(StatusListNearest(&box->statuses, box->n_classes, row, &status[i], &apart[i]));
  }
  PetscCall(PetscFree2(closed, row));
  PetscFunctionReturn(0);
}

PetscErrorCode BoxSolveFull(Box *box, const PetscReal p[], BoxFull *full)
{
  SlidingState state;
  Pencil       pencil = box->pencil;
  PetscBool   *closed;

  PetscFunctionBeginUser;
  *full = (BoxFull){.status = 0, .n_closed = -1};
  if (box->statics) {
    PetscCall(StaticsSolveSliding(box->statics, p, &state));
    PetscCall(StaticsRelease(box->statics));
    PetscCall(PetscMalloc1(state.n_pairs, &closed));
    for (PetscInt k = 0; k < state.n_pairs; k++) closed[k] = state.group[k] >= 0 ? PETSC_TRUE : PETSC_FALSE;
    PetscCall(StatusListAdd(&box->statuses, closed, &full->status));
    full->n_closed = box->statuses.n_closed[full->status];
    PetscCall(OperatorsLinearise(box->operators, &state, &pencil));
    PetscCall(SlidingStateDestroy(&state));
    PetscCall(PetscFree(closed));
  } else {
    PetscCall(PencilSetParameters(pencil, p));
  }
  PetscCall(ModesSetPencil(box->modes, pencil));
  PetscCall(ModesSolve(box->modes));
  PetscCall(ModesGet(box->modes, &full->n, &full->mode));
  PetscCall(ModesSetPencil(box->modes, box->pencil));
  if (box->statics) PetscCall(PencilDestroy(&pencil));
  PetscFunctionReturn(0);
}

PetscInt BoxClosed(const Box *box, PetscInt i)
{
  return box->statics ? box->statuses.n_closed[box->status[i]] : -1;
}
