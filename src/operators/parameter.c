/*
   Parameters: the numbers of the scene that the matrices depend on, in the order of the scene, and their values.
*/
#include "operatorsimpl.h"
#include <math.h>

PetscErrorCode ParameterAdd(Operators o, const char owner[], const char what[], const char unit[], PetscReal value,
                            PetscReal lower, PetscBool closed, PetscInt *index)
{
  const size_t        size = (size_t)o->n_parameters + 1;
  OperatorsParameter *q;

  PetscFunctionBeginUser;
  PetscCall(PetscRealloc(size * sizeof(*o->parameter), &o->parameter));
  PetscCall(PetscRealloc(size * sizeof(*o->p), &o->p));
  q = &o->parameter[o->n_parameters];
  PetscCall(PetscSNPrintf(q->name, sizeof(q->name), "%s_%s", owner, what));
  q->unit     = unit;
  q->value    = value;
  q->lower    = lower;
  q->upper    = INFINITY;
  q->closed   = closed;
  q->body     = o->n_body_terms ? PETSC_FALSE : PETSC_TRUE;
  q->internal = PETSC_FALSE;

  o->p[o->n_parameters] = value;
  *index                = o->n_parameters++;
  PetscFunctionReturn(0);
}

PetscErrorCode ParameterAddMu(Operators o, const char owner[], PetscReal value, PetscInt *index)
{
  PetscFunctionBeginUser;
  PetscCall(ParameterAdd(o, owner, "mu", "", value, -INFINITY, PETSC_FALSE, index));
  PetscCall(PetscRealloc((size_t)(o->n_mu + 1) * sizeof(*o->mu), &o->mu));
  o->mu[o->n_mu++] = *index;
  PetscFunctionReturn(0);
}

PetscErrorCode ParameterAddClosed(Operators o, PetscInt group)
{
  char     number[16];
  PetscInt index;

  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(number, sizeof(number), "%" PetscInt_FMT, group));
  PetscCall(ParameterAdd(o, "closed", number, "", 1, 0, PETSC_TRUE, &index));
  o->parameter[index].upper    = 1;
  o->parameter[index].internal = PETSC_TRUE;
  PetscFunctionReturn(0);
}

PetscReal OperatorsLargestMu(Operators o)
{
  PetscReal mu = 0;

  for (PetscInt i = 0; i < o->n_mu; i++)
    if (PetscAbsReal(o->p[o->mu[i]]) > PetscAbsReal(mu)) mu = o->p[o->mu[i]];
  return mu;
}

PetscErrorCode OperatorsGetParameters(Operators operators, PetscInt *n, const OperatorsParameter **parameters)
{
  PetscFunctionBeginUser;
  *n          = operators->n_parameters;
  *parameters = operators->parameter;
  PetscFunctionReturn(0);
}

PetscErrorCode OperatorsGetYoung(Operators operators, PetscInt part, PetscReal *young)
{
  PetscFunctionBeginUser;
  *young = operators->p[N_PART_PARAMETERS * part + PART_YOUNG];
  PetscFunctionReturn(0);
}

PetscErrorCode OperatorsGetDensity(Operators operators, PetscInt part, PetscReal *density)
{
  PetscFunctionBeginUser;
  *density = operators->p[N_PART_PARAMETERS * part + PART_DENSITY];
  PetscFunctionReturn(0);
}

PetscErrorCode OperatorsGetDamping(Operators operators, PetscInt part, PetscReal *alpha, PetscReal *beta)
{
  PetscFunctionBeginUser;
  *alpha = operators->p[N_PART_PARAMETERS * part + PART_ALPHA];
  *beta  = operators->p[N_PART_PARAMETERS * part + PART_BETA];
  PetscFunctionReturn(0);
}

PetscErrorCode OperatorsCheckParameter(Operators operators, PetscInt parameter, PetscReal value)
{
  const OperatorsParameter *q     = &operators->parameter[parameter];
  const char               *space = q->unit[0] ? " " : "";

  PetscFunctionBeginUser;
  PetscCheck(!q->internal || value <= q->upper, operators->comm, PETSC_ERR_USER_INPUT, "%s %.6g must be at most %.6g",
             q->name, (double)value, (double)q->upper);
  PetscCheck((q->internal || value < q->upper) && !PetscIsNanReal(value), operators->comm, PETSC_ERR_USER_INPUT,
             "%s %.6g%s%s must be a finite number", q->name, (double)value, space, q->unit);
  PetscCheck(value > q->lower || (q->closed && value == q->lower), operators->comm, PETSC_ERR_USER_INPUT,
             "%s %.6g%s%s must %s %.6g", q->name, (double)value, space, q->unit, q->closed ? "be at least" : "exceed",
             (double)q->lower);
  PetscFunctionReturn(0);
}

PetscErrorCode OperatorsSetParameters(Operators operators, const PetscReal value[])
{
  PetscBool same;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < operators->n_parameters; i++) PetscCall(OperatorsCheckParameter(operators, i, value[i]));
  PetscCall(PetscArraycmp(operators->p, value, operators->n_parameters, &same));
  if (same) PetscFunctionReturn(0);
  for (PetscInt i = 0; i < operators->n_parameters; i++) operators->parameter[i].value = value[i];
  PetscCall(PetscArraycpy(operators->p, value, operators->n_parameters));
  for (int i = 0; i < N_SUMS; i++) operators->sum[i].current = PETSC_FALSE;
  PetscFunctionReturn(0);
}
