/*
   What percents of parameters of the scene change. Q(lambda; p) is a sum of terms c(p) lambda^k A, so that another
   point p' adds (c(p') - c(p)) lambda^k A of those terms that depend on it: no other term, and exactly so. The pairs
   that touch and their forces stay as they are: modes about a sliding state that p' moves are those about the state as
   it was.
*/
#include "changes.h"
#include <squeal/options.h>
#include <string.h>

PetscErrorCode ChangeCountParameterTerms(Modes modes, PetscInt *n)
{
  const OperatorsTerm *term;

  PetscFunctionBeginUser;
  PetscCall(PencilGetTerms(modes->pencil, n, &term));
  PetscFunctionReturn(0);
}

/* Appends a name to a list */
static PetscErrorCode NamesAppend(const char name[], size_t size, char list[])
{
  PetscFunctionBeginUser;
  if (list[0]) PetscCall(OptionsTextAppend(list, ", ", size));
  PetscCall(OptionsTextAppend(list, name, size));
  PetscFunctionReturn(0);
}

/* Index of the parameter of a change */
static PetscErrorCode ParameterFind(Modes modes, const struct _p_ModesChange *change, PetscInt *index)
{
  const OperatorsParameter *q;
  const PetscReal          *p;
  PetscInt                  n;
  char                      valid[4096] = "";

  PetscFunctionBeginUser;
  PetscCall(PencilGetParameters(modes->pencil, &n, &q, &p));
  *index = -1;
  for (PetscInt j = 0; j < n; j++) {
    if (!ModesParameterIsListed(&q[j])) continue;
    if (!strcmp(q[j].name, change->parameter)) *index = j;
    if (p[j] != 0) PetscCall(NamesAppend(q[j].name, sizeof(valid), valid));
  }
  PetscCheck(*index >= 0, modes->comm, PETSC_ERR_USER_INPUT,
             "-%s_parameter '%s' is no parameter that the matrices follow at once; valid are %s", change->name,
             change->parameter, valid[0] ? valid : "none");
  PetscCheck(p[*index] != 0, modes->comm, PETSC_ERR_USER_INPUT,
             "-%s_parameter %s is 0 in the scene: a percent of it is nothing", change->name, change->parameter);
  PetscFunctionReturn(0);
}

/* Moves the point q by the percent of one change */
static PetscErrorCode PointMove(Modes modes, ModesChange change, PetscReal q[])
{
  const OperatorsParameter *list;
  Operators                 operators;
  PetscInt                  index;

  PetscFunctionBeginUser;
  PetscCall(ParameterFind(modes, change, &index));
  PetscCall(PencilGetOperators(modes->pencil, &operators));
  PetscCall(PencilGetParameters(modes->pencil, NULL, &list, NULL));
  change->value = q[index] * (1 + change->percent / 100);
  PetscCheck(change->value != 0, modes->comm, PETSC_ERR_USER_INPUT, "-%s_percent %.6g leaves nothing of %s",
             change->name, (double)change->percent, change->parameter);
  PetscCall(OperatorsCheckParameter(operators, index, change->value));
  q[index] = change->value;
  PetscFunctionReturn(0);
}

/* Raises the error for the friction of an exact contact, which moves the projection Zl of forces too */
static PetscErrorCode CheckExact(Modes modes, PetscInt i, const OperatorsTerm *term)
{
  PetscFunctionBeginUser;
  for (PetscInt k = i; k >= 0 && term->constraint >= 0; k = modes->change[k].before)
    PetscCheck(modes->change[k].parameter[0], modes->comm, PETSC_ERR_USER_INPUT,
               "change %s moves the friction of an exact contact, which cannot be tried with %s: give that contact a "
               "stiffness, or try them by themselves",
               modes->change[i].name, modes->change[k].name);
  PetscFunctionReturn(0);
}

PetscErrorCode ChangeAddParameters(Modes modes, PetscInt i, PetscInt *n, ChangeTerm terms[])
{
  const OperatorsTerm *term;
  const PetscReal     *p;
  PetscReal           *q;
  PetscInt             n_terms, n_parameters;
  const PetscInt       first = *n;

  PetscFunctionBeginUser;
  PetscCall(PencilGetTerms(modes->pencil, &n_terms, &term));
  PetscCall(PencilGetParameters(modes->pencil, &n_parameters, NULL, &p));
  PetscCall(PetscMalloc1(n_parameters, &q));
  PetscCall(PetscArraycpy(q, p, n_parameters));
  for (PetscInt k = i; k >= 0; k = modes->change[k].before)
    if (modes->change[k].parameter[0]) PetscCall(PointMove(modes, &modes->change[k], q));
  for (PetscInt t = 0; t < n_terms; t++) {
    const PetscReal c = OperatorsTermCoefficient(&term[t], q) - OperatorsTermCoefficient(&term[t], p);

    if (c == 0) continue;
    PetscCall(CheckExact(modes, i, &term[t]));
    terms[*n] = (ChangeTerm){.A = term[t].A, .symmetric = term[t].symmetric};
    if (term[t].kind == OPERATORS_STIFFNESS) terms[*n].stiffness = c;
    if (term[t].kind == OPERATORS_DAMPING) terms[*n].viscosity = c;
    if (term[t].kind == OPERATORS_MASS) terms[*n].mass = c;
    PetscCall(PetscObjectReference((PetscObject)terms[*n].A));
    ++*n;
  }
  PetscCall(PetscFree(q));
  PetscCheck(*n > first, modes->comm, PETSC_ERR_USER_INPUT, "change %s does nothing: no matrix depends on %s here",
             modes->change[i].name, modes->change[i].parameter);
  PetscFunctionReturn(0);
}
