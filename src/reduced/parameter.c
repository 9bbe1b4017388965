/* Parameters that reduced models are varied over: see parameter.h. Named as in sweeps; what acts on the bodies from
   outside comes first. */
#include "parameter.h"
#include "base/algebra/vec3.h"
#include "base/text.h"

/* A name that is looked for */
typedef struct {
  const char       *name;
  PetscBool         found;
  ReducedParameter *p;
  char              valid[2048];
} ParameterSearch;

/* Limits in time beside those of the row: friction never drives, and a load is moved by a factor from its own size */
typedef enum { AS_ITS_ROW, NOT_NEGATIVE, POSITIVE } ParameterLimit;

/* Takes candidate <owner>_<what> where it is the name looked for, and adds it to the valid ones */
static PetscErrorCode ParameterTry(const char owner[], const char what[], const Quantity *row,
                                   const ReducedParameter *candidate, ParameterLimit limit, ParameterSearch *search)
{
  ReducedParameter p = *candidate;
  PetscBool        same;

  PetscFunctionBeginUser;
  if (!(row->varies & VARIES_IN_TIME)) PetscFunctionReturn(0);
  p.least = row->bounded ? row->least : PETSC_NINFINITY;
  p.open  = limit == POSITIVE ? PETSC_TRUE : row->open;
  if (limit != AS_ITS_ROW) p.least = PetscMax(0, p.least);
  if (!p.unit) p.unit = row->unit ? row->unit : "-";
  PetscCall(PetscSNPrintf(p.name, sizeof(p.name), "%s%s%s", owner, what[0] ? "_" : "", what));
  PetscCall(WordsAdd(search->valid, search->valid[0] ? ", " : "", sizeof(search->valid)));
  PetscCall(WordsAdd(search->valid, p.name, sizeof(search->valid)));
  PetscCall(PetscStrcmp(p.name, search->name, &same));
  if (same && !search->found) *search->p = p;
  if (same) search->found = PETSC_TRUE;
  PetscFunctionReturn(0);
}

/* Friction and speed of a contact */
static PetscErrorCode ParameterOfContact(const ContactInterface *c, PetscInt i, ParameterSearch *search)
{
  const ReducedParameter   speed = {.kind = REDUCED_SPEED, .index = i, .value = c->speed};
  const FrictionParameter *law;
  const PetscInt           n = FrictionGetParameters(&c->friction, &law);

  PetscFunctionBeginUser;
  for (PetscInt j = 0; j < n; j++) {
    const ReducedParameter p = {.kind = REDUCED_FRICTION, .index = i, .value = c->friction.parameter[j], .law = j};

    PetscCall(ParameterTry(c->name, law[j].row.name + 1, &law[j].row, &p,
                           law[j].coefficient ? NOT_NEGATIVE : AS_ITS_ROW, search));
  }
  if (c->speed > 0) PetscCall(ParameterTry(c->name, "speed", ContactFindRow("speed"), &speed, AS_ITS_ROW, search));
  PetscFunctionReturn(0);
}

/* A pressure, or the length of a force or moment; a load of both has no one size */
static PetscErrorCode ParameterOfLoad(const Load *load, PetscInt i, ParameterSearch *search)
{
  const PetscReal force = load->is_pressure ? 0 : Vec3Length(load->force), moment = Vec3Length(load->moment);

  const ReducedParameter press = {.kind = REDUCED_LOAD, .index = i, .value = load->pressure};
  const ReducedParameter push  = {.kind = REDUCED_LOAD, .index = i, .value = force};
  const ReducedParameter draw  = {.kind = REDUCED_LOAD, .index = i, .value = load->shortening};
  const ReducedParameter turn  = {.kind = REDUCED_LOAD, .index = i, .value = moment};

  PetscFunctionBeginUser;
  if (load->is_pressure)
    PetscCall(ParameterTry(load->name, "pressure", ModelFindRow("-loads", "pressure"), &press, POSITIVE, search));
  if (force > 0 && moment == 0)
    PetscCall(ParameterTry(load->name, "force", ModelFindRow("-loads", "force"), &push, POSITIVE, search));
  if (load->has_shortening)
    PetscCall(ParameterTry(load->name, "shortening", ModelFindRow("-loads", "shortening"), &draw, POSITIVE, search));
  if (moment > 0 && force == 0)
    PetscCall(ParameterTry(load->name, "moment", ModelFindRow("-loads", "moment"), &turn, POSITIVE, search));
  PetscFunctionReturn(0);
}

/* Parameters of the bodies, not those of contacts */
static PetscErrorCode ParameterOfBodies(Operators operators, const PetscReal values[], ParameterSearch *search)
{
  const OperatorsParameter *list;
  PetscInt                  n;

  PetscFunctionBeginUser;
  PetscCall(OperatorsGetParameters(operators, &n, &list));
  for (PetscInt i = 0; i < n; i++) {
    const ReducedParameter p = {.unit = list[i].unit, .kind = REDUCED_BODY, .index = i, .value = values[i]};

    if (list[i].body) PetscCall(ParameterTry(list[i].name, "", list[i].row, &p, AS_ITS_ROW, search));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode ReducedParameterFind(Operators operators, const PetscReal p[], const char option[], const char what[],
                                    const char name[], ReducedParameter *parameter)
{
  const ModelScene       *scene;
  const ContactInterface *c;
  PetscInt                n;
  MPI_Comm                comm;
  Model                   model;
  Contact                 contact;
  ParameterSearch         search = {.name = name, .p = parameter};

  PetscFunctionBeginUser;
  PetscCall(OperatorsGetModel(operators, &model, &contact));
  PetscCall(ModelGetComm(model, &comm));
  PetscCall(ModelGetScene(model, &scene));
  PetscCall(ContactGetInterfaces(contact, &n, &c));
  for (PetscInt i = 0; i < n; i++) PetscCall(ParameterOfContact(&c[i], i, &search));
  for (PetscInt i = 0; i < scene->n_loads; i++) PetscCall(ParameterOfLoad(&scene->loads[i], i, &search));
  PetscCall(ParameterOfBodies(operators, p, &search));
  PetscCheck(search.found, comm, PETSC_ERR_USER_INPUT, "%s '%s' is no parameter %s; valid are %s", option, name, what,
             search.valid);
  PetscFunctionReturn(0);
}

/* value must be above `least`, or equal to it where that is not open; what the bodies allow is the operators' to
   say. */
PetscErrorCode ReducedParameterCheck(Operators operators, const char option[], const ReducedParameter *p,
                                     PetscReal value)
{
  const PetscBool good =
    p->kind == REDUCED_BODY || value > p->least || (!p->open && value == p->least) ? PETSC_TRUE : PETSC_FALSE;
  MPI_Comm comm;
  Model    model;

  PetscFunctionBeginUser;
  PetscCall(OperatorsGetModel(operators, &model, NULL));
  PetscCall(ModelGetComm(model, &comm));
  if (p->kind == REDUCED_BODY) PetscCall(OperatorsCheckParameter(operators, p->index, value));
  PetscCheck(good, comm, PETSC_ERR_USER_INPUT, "%s: %s %.6g must %s", option, p->name, (double)value,
             p->open ? "be positive" : "not be negative");
  PetscFunctionReturn(0);
}

/* Models are moved in place, in the unit of the parameter: a load by its factor value / p->value, since ports of
   loads are those of the scene's force; a speed by the same ratio for every pair, as pairs of one contact may have
   speeds of their own. */
void ReducedParameterMove(const ReducedParameter *p, PetscReal value, const ReducedMoved *moved)
{
  const ReducedModel *model = moved->model;

  if (p->kind == REDUCED_LOAD) moved->loads[p->index] = value / p->value;
  if (p->kind > REDUCED_SPEED) return;
  for (PetscInt i = 0; i < model->n_pairs; i++) {
    if (moved->interface[i] != p->index) continue;
    if (p->kind == REDUCED_FRICTION) model->friction[i].parameter[p->law] = value;
    if (p->kind == REDUCED_SPEED) model->friction[i].speed = moved->friction[i].speed * value / p->value;
  }
}

/* By what a cut-off rises with the parameter, so that as many modes stay below it: frequencies go as the root of a
   stiffness, or of 1 / mass (unit "kg..."); what damps or gyrates leaves it. Never below 1, so that no mode is
   lost. */
PetscErrorCode ReducedParameterGetRise(const ReducedParameter *p, PetscReal value, PetscReal *rise)
{
  PetscBool damps, weighs;

  PetscFunctionBeginUser;
  *rise = 1;
  PetscCall(OperatorsUnitIsGyration(p->unit, &damps));
  PetscCall(PetscStrncmp(p->unit, "kg", 2, &weighs));
  if (damps || value <= 0 || p->value <= 0) PetscFunctionReturn(0);
  *rise = PetscSqrtReal(PetscMax(1, weighs ? p->value / value : value / p->value));
  PetscFunctionReturn(0);
}
