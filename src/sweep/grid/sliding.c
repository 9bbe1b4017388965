/*
   -modes_contact static: the contact status at every place of the sweep is that of the sliding state at the same values
   of the parameters. All statuses are known before the reduced model is made. Pairs that are open at some places and
   closed at others become groups with the parameters closed_g = 0 or 1, so that their stiffness, too, is an affine term
   of the pencil: one basis then serves all statuses.

   A change of status between two points is bracketed by bisection, the widest bracket first, and the ends of the
   bracket become places of the sweep themselves. A further status found on the way becomes a segment of its own.
*/
#include "sweep/sweepimpl.h"
#include "sweep/grid/groups.h"

/* Of a sweep, each a contact problem of statics. */
#define MAX_BISECTIONS 30
/* Relative width of a bracket that is not divided any more. From steps of a tenth it takes 10 bisections. */
#define BRACKET_WIDTH 1e-4

/* Pairs of no group (-1) are open. The number of the status is alike on all ranks (StatusListAdd()). */
PetscErrorCode SweepStatusTake(Sweep sweep, const SlidingState *state, PetscInt *status)
{
  PetscBool *closed;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(state->n_pairs, &closed));
  for (PetscInt i = 0; i < state->n_pairs; i++) closed[i] = state->group[i] >= 0 ? PETSC_TRUE : PETSC_FALSE;
  PetscCall(StatusListAdd(&sweep->statuses, closed, status));
  PetscCall(PetscFree(closed));
  PetscFunctionReturn(0);
}

PetscErrorCode SweepStatusSolve(Sweep sweep, const SweepPlace *place, PetscInt *status)
{
  SlidingState state;
  PetscReal   *p;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(sweep->grid.n_parameters, &p));
  GridFill(&sweep->grid, place, p);
  PetscCall(StaticsSolveSliding(sweep->statics, p, &state));
  PetscCall(SweepStatusTake(sweep, &state, status));
  PetscCall(SlidingStateDestroy(&state));
  sweep->n_static++;
  PetscCall(PetscFree(p));
  PetscFunctionReturn(0);
}

/* The place before the widest bracket, relative to its values, of a change of status on one line that is to be divided,
   or -1 */
static PetscInt WidestChange(const SweepGrid *grid)
{
  PetscReal widest = BRACKET_WIDTH;
  PetscInt  at     = -1;

  for (PetscInt k = 0; k + 1 < grid->n_places; k++) {
    const SweepPlace *a = &grid->place[k], *b = a + 1;
    const PetscReal   largest = PetscMax(PetscAbsReal(a->value[0]), PetscAbsReal(b->value[0]));
    const PetscReal   width   = PetscAbsReal(b->value[0] - a->value[0]) / largest;

    if (a->line == b->line && a->status != b->status && width > widest) widest = width, at = k;
  }
  return at;
}

/* Narrows the brackets: a middle of one of the two statuses halves one; of a third status makes two. What is left
   of bisections are places amid their own status, which tell nothing and are taken out, from the back, so that
   indices stay right. */
static PetscErrorCode ChangesBracket(Sweep sweep)
{
  SweepGrid *grid = &sweep->grid;

  PetscFunctionBeginUser;
  for (PetscInt n = 0, k = WidestChange(grid); n < MAX_BISECTIONS && k >= 0; n++, k = WidestChange(grid)) {
    SweepPlace middle = grid->place[k];

    middle.point    = -1;
    middle.value[0] = GridMiddle(grid, 0, middle.value[0], grid->place[k + 1].value[0]);
    PetscCall(SweepStatusSolve(sweep, &middle, &middle.status));
    PetscCall(GridInsert(grid, k + 1, &middle));
  }
  for (PetscInt k = grid->n_places - 2; k > 0; k--) { /* only the ends of the brackets are of use */
    const SweepPlace *place = &grid->place[k];

    if (place->point < 0 && place[-1].status == place->status && place[1].status == place->status) GridRemove(grid, k);
  }
  PetscFunctionReturn(0);
}

PetscBool SweepClosedRange(Sweep sweep, PetscInt *least, PetscInt *most)
{
  const SweepGrid *grid     = &sweep->grid;
  const PetscInt  *n_closed = sweep->statuses.n_closed;
  PetscBool        changes  = PETSC_FALSE;

  *least = *most = n_closed[grid->place[0].status];
  for (PetscInt k = 1; k < grid->n_places; k++) {
    *least = PetscMin(*least, n_closed[grid->place[k].status]);
    *most  = PetscMax(*most, n_closed[grid->place[k].status]);
    if (grid->place[k].status != grid->place[0].status) changes = PETSC_TRUE;
  }
  return changes;
}

/* Groups with the exact constraint are no affine terms */
static PetscErrorCode StatusGroupsComplain(Sweep sweep)
{
  const PetscReal          *value = sweep->grid.value[0];
  const OperatorsParameter *parameters;
  PetscInt                  n, least, most;

  PetscFunctionBeginUser;
  (void)SweepClosedRange(sweep, &least, &most);
  PetscCall(OperatorsGetParameters(sweep->operators, &n, &parameters));
  SETERRQ(
    sweep->comm, PETSC_ERR_SUP,
    "a sweep about the sliding state with -contact_law constraint: which pairs are closed changes between %s %.6g and "
    "%.6g (%" PetscInt_FMT " to %" PetscInt_FMT " of %" PetscInt_FMT
    "); give -contact_law penalty, -sweep_method full or -modes_contact all",
    parameters[sweep->grid.parameter[0][0]].name, (double)value[0], (double)value[sweep->grid.n[0] - 1], least, most,
    sweep->statuses.n_pairs);
}

/* Makes the pencil with the groups, and gives the grid the values of their parameters */
static PetscErrorCode StatusGroupsSet(Sweep sweep)
{
  SweepGrid   *grid = &sweep->grid;
  StatusPencil made;
  PetscReal   *p;
  PetscBool    exact;

  PetscFunctionBeginUser;
  PetscCall(StatusPencilCreate(&sweep->statuses, sweep->operators, &exact, &made));
  if (exact) PetscCall(StatusGroupsComplain(sweep));
  sweep->pencil      = made.pencil;
  grid->n_groups     = made.n_groups;
  grid->closed       = made.closed;
  grid->n_parameters = made.n_parameters;
  PetscCall(PetscRealloc((size_t)grid->n_parameters * sizeof(*grid->base), &grid->base));
  for (PetscInt g = 0; g < grid->n_groups; g++) /* of the first status; each place has its own */
    grid->base[grid->n_parameters - grid->n_groups + g] = grid->closed[g];
  PetscCall(PetscMalloc1(grid->n_parameters, &p));
  GridFill(grid, &grid->place[grid->n_places - 1], p);
  PetscCall(StatusPencilFormPattern(&made, p));
  PetscCall(PetscFree(p));
  PetscFunctionReturn(0);
}

/* The reduced model needs a pencil that is affine in closed_g. Where statics say it is not, the method falls back
   to full solutions, unless something was asked for that only the reduced one has. */
PetscErrorCode SweepChooseMethod(Sweep sweep)
{
  PetscBool affine, asked = sweep->method_given || sweep->rtol_given || sweep->max_given ? PETSC_TRUE : PETSC_FALSE;

  PetscFunctionBeginUser;
  if (!sweep->statics || sweep->method == SWEEP_FULL) PetscFunctionReturn(0);
  PetscCall(StaticsIsAffine(sweep->statics, &affine));
  if (affine) PetscFunctionReturn(0);
  if (sweep->n_verify || sweep->sensitivities) asked = PETSC_TRUE; /* not of full solutions */
  PetscCheck(!asked, sweep->comm, PETSC_ERR_SUP,
             "a sweep about the sliding state: pairs that hold by friction, friction damping, the stiffness of a "
             "-contact_pressure_law, -static_geometric and -static_follower change with it from point to point; give "
             "-sweep_method full alone, or -modes_contact all");
  sweep->method = SWEEP_FULL;
  PetscCall(PetscPrintf(sweep->comm, "-sweep_method full: pairs that hold by friction, friction damping, pressure "
                                     "laws, geometric stiffness or follower forces change with the sliding state\n"));
  PetscFunctionReturn(0);
}

PetscErrorCode SweepStatuses(Sweep sweep)
{
  const ContactPair *pair;
  SweepGrid         *grid = &sweep->grid;
  Contact            contact;
  PetscInt           n, n_all;

  PetscFunctionBeginUser;
  PetscCall(OperatorsGetModel(sweep->operators, NULL, &contact));
  sweep->statuses.n_pairs = -1;
  if (contact) {
    PetscCall(ContactGetPairs(contact, &n, &n_all, &pair));
    PetscCall(StatusListCreate(sweep->comm, n, &sweep->statuses));
  }
  if (!sweep->statics) {
    PetscCall(OperatorsLinearise(sweep->operators, NULL, &sweep->pencil));
    PetscFunctionReturn(0);
  }
  if (sweep->method == SWEEP_FULL) PetscFunctionReturn(0);
  for (PetscInt k = 0; k < grid->n_places; k++)
    PetscCall(SweepStatusSolve(sweep, &grid->place[k], &grid->place[k].status));
  PetscCall(ChangesBracket(sweep));
  for (PetscInt i = 0; i < sweep->n_checks; i++)
    PetscCall(SweepStatusSolve(sweep, &sweep->check[i].at, &sweep->check[i].at.status));
  PetscCall(StaticsRelease(sweep->statics));
  PetscCall(StatusGroupsSet(sweep));
  PetscFunctionReturn(0);
}

PetscInt SweepClosedAt(Sweep sweep, PetscInt point, PetscBool *jump)
{
  const SweepGrid  *grid  = &sweep->grid;
  const SweepPlace *place = &grid->place[grid->at[point]];

  *jump = PETSC_FALSE;
  if (!sweep->statics) return sweep->statuses.n_pairs;
  if (point % grid->n[0]) *jump = (PetscBool)(grid->place[grid->at[point - 1]].status != place->status);
  return sweep->statuses.n_closed[place->status];
}
