/*
   Parameters: the numbers of the scene that matrices depend on, in the order of the scene, with the limits of
   the rows of their options: lower < p (<= where closed) and p <= upper. Names are <owner>_<what>, those of the options
   without the dash, units SI until the scene's units are put in for views.
*/
#include "terms.h"
#include <math.h>
#include <string.h>

static PetscErrorCode ParameterPut(Parameters *parameters, const char name[], const OperatorsParameter *like)
{
  const size_t        size = (size_t)parameters->n + 1;
  OperatorsParameter *q;

  PetscFunctionBeginUser;
  PetscCall(PetscRealloc(size * sizeof(*parameters->list), &parameters->list));
  PetscCall(PetscRealloc(size * sizeof(*parameters->p), &parameters->p));
  q  = &parameters->list[parameters->n];
  *q = *like;
  PetscCall(PetscStrncpy(q->name, name, sizeof(q->name)));
  q->unit                      = like->row && like->row->unit ? like->row->unit : "";
  parameters->p[parameters->n] = q->value;
  parameters->n++;
  PetscFunctionReturn(0);
}

PetscErrorCode ParametersAdd(Parameters *parameters, const char owner[], const char what[],
                             const OperatorsParameter *like, PetscInt *index)
{
  const Quantity    *row = like->row;
  OperatorsParameter q   = *like;
  char               name[sizeof(q.name)];

  PetscFunctionBeginUser;
  PetscCheck(!row || like->law || row->varies & VARIES_LINEAR, PETSC_COMM_SELF, PETSC_ERR_PLIB,
             "the row of %s says that nobody varies it", what);
  q.lower  = row && row->bounded ? row->least : -INFINITY;
  q.upper  = row && row->bounded && row->most != 0 ? row->most : INFINITY;
  q.closed = row && row->bounded && !row->open ? PETSC_TRUE : PETSC_FALSE;
  if (q.lower < 0 && (q.length || q.divides)) q.lower = 0;
  if (q.length) q.closed = PETSC_TRUE;
  if (q.divides) q.closed = PETSC_FALSE;
  PetscCall(PetscSNPrintf(name, sizeof(name), "%s%s%s", owner ? owner : "", owner ? "_" : "", what));
  *index = parameters->n;
  PetscCall(ParameterPut(parameters, name, &q));
  PetscFunctionReturn(0);
}

PetscErrorCode ParametersTake(Parameters *parameters, const Parameters *from)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < from->n; i++) PetscCall(ParameterPut(parameters, from->list[i].name, &from->list[i]));
  PetscFunctionReturn(0);
}

PetscErrorCode ParametersAddShare(Parameters *parameters, const char name[])
{
  const OperatorsParameter share = {.value = 1, .lower = 0, .upper = 1, .closed = PETSC_TRUE, .internal = PETSC_TRUE};

  PetscFunctionBeginUser;
  PetscCall(ParameterPut(parameters, name, &share));
  PetscFunctionReturn(0);
}

PetscInt ParametersFind(const Parameters *parameters, const char name[])
{
  for (PetscInt i = 0; i < parameters->n; i++)
    if (!strcmp(parameters->list[i].name, name)) return i;
  return -1;
}

PetscErrorCode ParameterCheck(MPI_Comm comm, const OperatorsParameter *q, PetscReal value)
{
  const char *space = q->unit[0] ? " " : "";

  PetscFunctionBeginUser;
  PetscCheck((q->internal || !PetscIsInfReal(value)) && !PetscIsNanReal(value), comm, PETSC_ERR_USER_INPUT,
             "%s %.6g%s%s must be a finite number", q->name, (double)value, space, q->unit);
  PetscCheck(value <= q->upper, comm, PETSC_ERR_USER_INPUT, "%s %.6g%s%s must be at most %.6g", q->name, (double)value,
             space, q->unit, (double)q->upper);
  PetscCheck(
    q->fastest == 0 || PetscAbsReal(value) <= q->fastest, comm, PETSC_ERR_USER_INPUT,
    "%s %.6g rad/s must be at most %.6g rad/s: beyond, the part moves faster than waves in it, and centrifugal "
    "forces strain it by more than its length; is it another unit? 1 rev/min is 0.10472 rad/s",
    q->name, (double)value, (double)q->fastest);
  PetscCheck(value > q->lower || (q->closed && value == q->lower), comm, PETSC_ERR_USER_INPUT,
             "%s %.6g%s%s must %s %.6g", q->name, (double)value, space, q->unit, q->closed ? "be at least" : "exceed",
             (double)q->lower);
  PetscFunctionReturn(0);
}

PetscErrorCode ParametersDestroy(Parameters *parameters)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(parameters->list));
  PetscCall(PetscFree(parameters->p));
  parameters->n = 0;
  PetscFunctionReturn(0);
}
