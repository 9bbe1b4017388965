/*
   Dynamics: what the options ask for. Times in s, lengths in m.
*/
#include "dynamicsimpl.h"

/* The modes of -dynamics_filters: none named, or 0, for all unstable ones */
static PetscErrorCode DynamicsSetFiltersModes(Dynamics d)
{
  PetscFunctionBeginUser;
  if (!d->n_asked || (d->n_asked == 1 && d->asked[0] == 0)) PetscFunctionReturn(0);
  d->filters.n = d->n_asked;
  PetscCall(PetscMalloc1(d->n_asked, &d->filters.mode));
  PetscCall(PetscArraycpy(d->filters.mode, d->asked, d->n_asked));
  PetscFunctionReturn(0);
}

PetscErrorCode DynamicsSetFromOptions(Dynamics d)
{
  PetscReal dt;
  PetscBool set, central;

  PetscFunctionBeginUser;
  PetscCall(QuantitiesRead(d->comm, &dynamics_quantities, d));
  PetscCall(DynamicsSetFiltersModes(d));
  PetscCall(TSSetFromOptions(d->ts));
  PetscCall(PetscObjectTypeCompare((PetscObject)d->ts, TSCENTRAL, &central));
  PetscCheck(central, d->comm, PETSC_ERR_USER_INPUT,
             "-ts_type does not suit exact contact: leave it out, it is " TSCENTRAL);
  PetscCall(PetscOptionsGetReal(NULL, NULL, "-ts_dt", &dt, &set));
  if (set) d->dt_asked = dt;
  d->dt_given = set;
  PetscCheck(!PetscIsInfOrNanReal(d->dt_asked) && d->dt_asked >= 0, d->comm, PETSC_ERR_USER_INPUT,
             "-ts_dt %.6g must be a positive time (s)", (double)d->dt_asked);
  PetscCall(TSCentralGetB(d->ts, &d->b));
  PetscCall(HistorySetFromOptions(d->history));
  if (d->external) PetscCall(ExternalSetFromOptions(d->external));
  if (d->projector) PetscCall(ContactProjectorSetFromOptions(d->projector));
  PetscCall(BodiesSetFromOptions(d->bodies));
  PetscFunctionReturn(0);
}

PetscErrorCode DynamicsVisit(Dynamics d, const QuantityVisitor *visitor)
{
  PetscFunctionBeginUser;
  PetscCall(QuantitiesVisit(visitor, &dynamics_quantities, NULL, d, NULL));
  PetscCall(TSCentralVisit(d->ts, visitor));
  PetscCall(HistoryVisit(d->history, visitor));
  if (d->external) PetscCall(ExternalVisit(d->external, visitor));
  if (d->projector) PetscCall(ContactProjectorVisit(d->projector, visitor));
  PetscCall(BodiesVisit(d->bodies, visitor));
  PetscFunctionReturn(0);
}
