/*
   Statics: life cycle, options, and one point of the parameters after the other: the statuses of the last solution
   begin the next, and the factorisation of K_a is kept as long as no parameter of the bodies changes (friction,
   contact stiffness and loads are not in it). The flow is in stages/run.c and stages/solve.c. With -stages each point
   begins with all pairs closed: what they did at another point is no part of its history.
*/
#include "staticsimpl.h"
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
  if (!s->rows.G) {
    PetscCall(OperatorsCheckEven(s->operators, PETSC_FALSE, "an equilibrium"));
    PetscCall(StaticsCreateRows(s));
  }
  PetscCall(OperatorsGetParameters(s->operators, &n, &parameters));
  for (PetscInt i = 0; i < n; i++) s->p[i] = p ? p[i] : parameters[i].value;
  for (PetscInt i = 0; i < n; i++) PetscCall(OperatorsCheckParameter(s->operators, i, s->p[i]));
  PetscFunctionReturn(0);
}

PetscErrorCode StaticsRelease(Statics statics)
{
  PetscFunctionBeginUser;
  PetscCall(ComplianceDestroy(&statics->compliance));
  PetscCall(PetscFree(statics->factored));
  for (PetscInt i = 0; i < statics->n_kept; i++) {
    PetscCall(ComplianceDestroy(&statics->kept[i].compliance));
    PetscCall(PetscFree(statics->kept[i].factored));
  }
  if (statics->operators) PetscCall(OperatorsReleaseBodies(statics->operators));
  PetscFunctionReturn(0);
}

PetscErrorCode StaticsSolve(Statics s, const PetscReal p[])
{
  PetscFunctionBeginUser;
  PetscCall(StaticsSetUp(s, p));
  PetscCall(PetscArrayzero(s->worn, s->rows.n_pairs));
  s->n_wear = 0;
  PetscCall(StagesSolve(s));
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
  PetscCall(StagesSolve(s));
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
  for (PetscInt i = 0; i < s->n_kept; i++) PetscCall(PairRowsDestroy(&s->kept[i].rows));
  PetscCall(PetscFree(s->kept));
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
