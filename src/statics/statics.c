/*
   Statics: life cycle, options, and the flow loads -> compliance -> pairs -> states, once a stage. One object solves at
   many points p of the parameters, one after the other: the statuses of the last solution begin the next, and the
   factorisation of K_a is kept as long as no parameter of the bodies changes (friction, contact stiffness and loads are
   not in it), and no stage lets other contacts slide. With -stages each point begins with all pairs closed: what they
   did at another point is no part of its history.
*/
#include "staticsimpl.h"
#include "base/events.h"
#include <squeal/options.h>

PetscErrorCode StaticsCreate(MPI_Comm comm, Statics *statics)
{
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(1, statics));
  (*statics)->comm = comm;
  PetscCall(QuantitiesInit(&statics_quantities, *statics));
  PetscFunctionReturn(0);
}

PetscErrorCode StaticsSetOperators(Statics statics, Operators operators)
{
  PetscFunctionBeginUser;
  statics->operators = operators;
  PetscCall(OperatorsGetModel(operators, &statics->model, &statics->contact));
  if (statics->model) PetscCall(StagesSetUp(statics));
  PetscFunctionReturn(0);
}

PetscErrorCode StaticsSetFromOptions(Statics s)
{
  PetscFunctionBeginUser;
  PetscCall(QuantitiesRead(s->comm, &statics_quantities, s));
  PetscCall(QuantitiesReadList(s->comm, &stages_list, s, &s->n_stages, &s->stages));
  PetscFunctionReturn(0);
}

PetscErrorCode StaticsVisit(Statics s, const QuantityVisitor *visitor)
{
  PetscFunctionBeginUser;
  PetscCall(QuantitiesVisit(visitor, &statics_quantities, NULL, s, NULL));
  PetscCall(QuantitiesVisitList(visitor, &stages_list, s->n_stages, s->stages));
  PetscFunctionReturn(0);
}

PetscErrorCode StaticsAddChecksum(Statics s, Checksum c)
{
  PetscFunctionBeginUser;
  if (s->model) PetscCall(ModelAddLoadsChecksum(s->model, c));
  PetscCall(ChecksumSetPart(c, "options of statics"));
  PetscCall(QuantitiesAddChecksum(&statics_quantities, s, c));
  for (PetscInt k = 0; k < s->n_stages; k++) {
    PetscCall(ChecksumSetPart(c, "stage %s", s->stages[k].name));
    PetscCall(QuantitiesAddChecksum(stages_list.table, &s->stages[k], c));
  }
  PetscFunctionReturn(0);
}

/* Motions that nothing resists are sought body by body (bodies/rigid.c): a point must not join two bodies rigidly.
   The least and the largest body of its nodes over all ranks are one where it does not. */
static PetscErrorCode StaticsCheckRigid(Statics s)
{
  const ModelScene *scene;
  PetscInt          n, *body;

  PetscFunctionBeginUser;
  PetscCall(ModelGetScene(s->model, &scene));
  PetscCall(ModelGetBodies(s->model, &n, &body));
  for (PetscInt i = 0; i < scene->n_points; i++) {
    const Joint *point   = &scene->points[i];
    PetscInt     ends[2] = {-1, -n}; /* last body, and the first with the other sign */

    for (PetscInt k = 0; k < point->mean.n; k++) {
      ends[0] = PetscMax(ends[0], body[point->mean.vertex[k]]);
      ends[1] = PetscMax(ends[1], -body[point->mean.vertex[k]]);
    }
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, ends, 2, MPIU_INT, MPI_MAX, s->comm));
    PetscCheck(
      !point->rigid || ends[0] == -ends[1], s->comm, PETSC_ERR_SUP,
      "-%s_join rigid: -%s_set %s has nodes of two bodies, which -analysis static and the sliding state do not "
      "support: use a point for each, and a bushing",
      point->name, point->name, point->set[0]);
  }
  PetscCall(PetscFree(body));
  PetscFunctionReturn(0);
}

/* All pairs closed, those of Coulomb's law without slip */
static void StaticsCloseAll(Statics s)
{
  for (PetscInt p = 0; p < s->rows.n_pairs; p++) s->status[p] = s->rows.law[p].d == 3 ? CONTACT_STICK : CONTACT_SLIP;
}

/* Pairs, rows and room for the results */
static PetscErrorCode StaticsCreateRows(Statics s)
{
  const OperatorsParameter *parameters;

  PetscFunctionBeginUser;
  PetscCheck(s->model, s->comm, PETSC_ERR_USER_INPUT,
             "-analysis static and -modes_contact static need a mesh and contact, "
             "not loaded matrices");
  PetscCall(PairRowsCreate(s->operators, PETSC_FALSE, StagesGet(s, 0), &s->rows));
  PetscCall(PetscCalloc1(s->rows.n_pairs, &s->worn));
  s->rows.worn = s->worn;
  PetscCheck(s->rows.n_pairs_all, s->comm, PETSC_ERR_USER_INPUT,
             "-analysis static and -modes_contact static need -contacts");
  PetscCall(StaticsCheckRigid(s));
  PetscCall(OperatorsGetParameters(s->operators, &s->n_parameters, &parameters));
  PetscCall(PetscMalloc3(s->rows.n_pairs, &s->status, s->rows.n_pairs, &s->state, s->rows.n_interfaces, &s->resultant));
  StaticsCloseAll(s);
  PetscCall(OperatorsCreateVec(s->operators, &s->u));
  PetscCall(OperatorsCreatePoint(s->operators, NULL, &s->p));
  PetscFunctionReturn(0);
}

PetscErrorCode StaticsSetUp(Statics s, const PetscReal p[])
{
  const OperatorsParameter *parameters;
  PetscInt                  n;

  PetscFunctionBeginUser;
  if (!s->rows.G) PetscCall(StaticsCreateRows(s));
  PetscCall(OperatorsGetParameters(s->operators, &n, &parameters));
  for (PetscInt i = 0; i < n; i++) s->p[i] = p ? p[i] : parameters[i].value;
  for (PetscInt i = 0; i < n; i++) PetscCall(OperatorsCheckParameter(s->operators, i, s->p[i]));
  PetscFunctionReturn(0);
}

/* Nothing moves without loads on what can move, unless bodies interfere, g0 < 0 with all motions done. Both numbers
   are those of all ranks. The laws are set again in the first load step. */
static PetscErrorCode StaticsCheckLoad(Statics s, Vec f)
{
  PetscReal least = 0, size;

  PetscFunctionBeginUser;
  PetscCall(VecNorm(f, NORM_2, &size));
  PairRowsMove(&s->rows, 1, 0, NULL);
  for (PetscInt p = 0; p < s->rows.n_pairs; p++) least = PetscMin(least, s->rows.law[p].g0);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &least, 1, MPIU_REAL, MPI_MIN, s->comm));
  PetscCheck(size > 0 || least < 0, s->comm, PETSC_ERR_USER_INPUT,
             "nothing presses the bodies together: give -loads on what -supports do not hold, e.g. -loads press "
             "-press_set beam_top -press_force 0,0,-100");
  PetscFunctionReturn(0);
}

/* Keeps the factorisation of the call before where no parameter of the bodies has changed since. kappa stays with it;
   the laws of the pairs, whose k is k_n / kappa, are set anew. */
static PetscErrorCode StaticsFactor(Statics s)
{
  const OperatorsParameter *parameters;
  PetscInt                  n;
  PetscBool                 same = s->factored ? PETSC_TRUE : PETSC_FALSE;

  PetscFunctionBeginUser;
  PetscCall(OperatorsGetParameters(s->operators, &n, &parameters));
  if (!s->factored) PetscCall(PetscMalloc1(s->n_parameters, &s->factored));
  for (PetscInt i = 0; i < s->n_parameters; i++) {
    if (same && parameters[i].body && s->p[i] != s->factored[i]) same = PETSC_FALSE;
    s->factored[i] = s->p[i];
  }
  if (!same) {
    s->n_factored++;
    PetscCall(ComplianceDestroy(&s->compliance));
    PetscCall(ComplianceCreate(s->operators, s->p, &s->rows, s->dense, &s->progress, &s->compliance));
  }
  PetscCall(PairRowsSetLaws(s->operators, s->p, s->compliance.kappa, &s->rows));
  PetscFunctionReturn(0);
}

PetscErrorCode StaticsRelease(Statics statics)
{
  PetscFunctionBeginUser;
  PetscCall(ComplianceDestroy(&statics->compliance));
  PetscCall(PetscFree(statics->factored));
  if (statics->operators) PetscCall(OperatorsReleaseBodies(statics->operators));
  PetscFunctionReturn(0);
}

/* Rows of the contacts that slide in a stage. Others than before need a factorisation of their own; the statuses of
   the pairs stay, as far as the new rows have them. */
static PetscErrorCode StaticsSetLayout(Statics s, const Stage *stage)
{
  PetscBool same = PETSC_TRUE;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < s->rows.n_interfaces; i++)
    if (stage->slides[i] != s->rows.slides[i]) same = PETSC_FALSE;
  if (same) PetscFunctionReturn(0);
  PetscCall(ComplianceDestroy(&s->compliance));
  PetscCall(PetscFree(s->factored));
  PetscCall(PairRowsDestroy(&s->rows));
  PetscCall(PairRowsCreate(s->operators, PETSC_FALSE, stage, &s->rows));
  s->rows.worn = s->worn;
  for (PetscInt p = 0; p < s->rows.n_pairs; p++)
    if (s->rows.law[p].d == 1 && s->status[p] == CONTACT_STICK) s->status[p] = CONTACT_SLIP;
  PetscFunctionReturn(0);
}

/* Forces l (m) and displacements w (m) of the rows as the stage before left them */
static PetscErrorCode StaticsTakeUp(Statics s, PetscReal l[], PetscReal **w)
{
  const PairRows *rows = &s->rows;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(rows->n, w));
  PetscCall(ComplianceGetRows(&s->compliance, s->u, *w));
  for (PetscInt p = 0; p < rows->n_pairs; p++) {
    l[rows->first[p]] = s->state[p].lambda_n / s->compliance.kappa;
    for (PetscInt i = 1; i < rows->law[p].d; i++)
      l[rows->first[p] + i] = -s->state[p].lambda_t[i - 1] / s->compliance.kappa;
  }
  PetscFunctionReturn(0);
}

/* Stage k from the loads f0 of the one before it (NULL at first), which become its own; size is that of the largest
   loads until now, N */
static PetscErrorCode StaticsSolveStage(Statics s, PetscInt k, Vec *f0, PetscReal *size)
{
  const Stage *stage = StagesGet(s, k);
  PetscReal   *l, *w0 = NULL, end;
  Vec          f;

  PetscFunctionBeginUser;
  s->stage = k;
  PetscCall(StaticsSetLayout(s, stage));
  if (!k && s->n_stages) StaticsCloseAll(s);
  PetscCall(PairRowsSetMoved(s->model, StagesGet(s, k - 1), stage, &s->rows));
  PetscCall(StaticsCreateLoad(s->operators, s->p, stage, &f, &end));
  *size = PetscMax(*size, end);
  if (!k) PetscCall(StaticsCheckLoad(s, f));
  PetscCall(PetscCalloc1(s->rows.n, &l));
  PetscCall(StaticsFactor(s));
  if (k) PetscCall(StaticsTakeUp(s, l, &w0));
  PetscCall(HoldCheck(s->operators, &s->compliance.hold, "the loads", f, *size));
  PetscCall(EquilibriumSolve(s, &(Active){.rows       = &s->rows,
                                          .compliance = &s->compliance,
                                          .f          = f,
                                          .f0         = *f0,
                                          .w0         = w0,
                                          .size       = *size,
                                          .load_steps = s->load_steps,
                                          .status     = s->status,
                                          .l          = l,
                                          .u          = s->u}));
  s->n_free = s->compliance.hold.n;
  PetscCall(StaticsSetState(s, f, l));
  if (s->n_stages) PetscCall(StaticsFindReactions(s));
  PetscCall(PetscFree(l));
  PetscCall(PetscFree(w0));
  PetscCall(VecDestroy(f0));
  *f0 = f;
  PetscFunctionReturn(0);
}

/* All stages at the point that is set, with the gaps as they are worn */
static PetscErrorCode StaticsSolveStages(Statics s)
{
  PetscReal size = 0;
  Vec       f    = NULL;

  PetscFunctionBeginUser;
  PetscCall(EventBegin(EVENT_STATICS));
  s->n_it = s->n_factored = s->n_reactions = 0;
  s->peak                                  = 0;
  for (PetscInt k = 0; k < StagesCount(s); k++) PetscCall(StaticsSolveStage(s, k, &f, &size));
  s->solved = PETSC_TRUE;
  PetscCall(VecDestroy(&f));
  PetscCall(EventEnd(EVENT_STATICS));
  PetscFunctionReturn(0);
}

PetscErrorCode StaticsSolve(Statics s, const PetscReal p[])
{
  PetscFunctionBeginUser;
  PetscCall(StaticsSetUp(s, p));
  PetscCall(PetscArrayzero(s->worn, s->rows.n_pairs));
  s->n_wear = 0;
  PetscCall(StaticsSolveStages(s));
  PetscFunctionReturn(0);
}

PetscErrorCode StaticsSetWears(Statics statics, PetscBool wears)
{
  PetscFunctionBeginUser;
  statics->wears = wears;
  PetscFunctionReturn(0);
}

PetscErrorCode StaticsSolveWorn(Statics s, const PetscReal p[])
{
  PetscInt  n_it, n_factored;
  PetscBool worn;

  PetscFunctionBeginUser;
  PetscCall(StaticsSolve(s, p));
  PetscCall(StaticsWear(s, &worn));
  if (!worn) PetscFunctionReturn(0);
  n_it       = s->n_it;
  n_factored = s->n_factored;
  PetscCall(StaticsSolveStages(s));
  s->n_it += n_it;
  s->n_factored += n_factored;
  PetscFunctionReturn(0);
}

PetscErrorCode StaticsGetState(Statics statics, const ContactState **state, Vec *u)
{
  PetscFunctionBeginUser;
  PetscCheck(statics->solved, statics->comm, PETSC_ERR_ARG_WRONGSTATE, "StaticsSolve() comes first");
  if (state) *state = statics->state;
  if (u) *u = statics->u;
  PetscFunctionReturn(0);
}

PetscErrorCode StaticsGetKKT(Statics statics, ContactKKT *kkt, PetscReal *equilibrium)
{
  PetscFunctionBeginUser;
  *kkt         = statics->kkt;
  *equilibrium = statics->equilibrium;
  PetscFunctionReturn(0);
}

PetscErrorCode StaticsDestroy(Statics *statics)
{
  Statics s = *statics;

  PetscFunctionBeginUser;
  if (!s) PetscFunctionReturn(0);
  PetscCall(StaticsRelease(s));
  PetscCall(PairRowsDestroy(&s->rows));
  PetscCall(StagesDestroy(s));
  PetscCall(PetscFree(s->reaction));
  PetscCall(PetscFree3(s->status, s->state, s->resultant));
  PetscCall(PetscFree(s->p));
  PetscCall(PetscFree(s->worn));
  PetscCall(PetscFree(s->wear_row));
  PetscCall(VecDestroy(&s->u));
  PetscCall(PetscFree(*statics));
  PetscFunctionReturn(0);
}
