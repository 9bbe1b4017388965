/*
   Checkpoints of a run: everything that the next step depends on, so that a run goes on bitwise on the same number of
   ranks. Which numbers must agree between writer and reader: model, materials, contact, integrator.
*/
#include "dynamicsimpl.h"
#include "events.h"

#define N_REALS(type) ((PetscInt)(sizeof(type) / sizeof(PetscReal)))

/* Scalars of a run */
typedef struct {
  PetscReal    time, dt, dt_old, step;
  Ledger       ledger;
  LedgerPart   part;
  LedgerOrigin origin;
} Scalars;

typedef enum { SCALARS, U, V, KU, DAMPING, FORCE, PROJECTOR, EXTERNAL, HISTORY, N_ITEMS } Item;

/* Numbers that differ between runs that must not be mixed */
static PetscErrorCode MakePrint(Dynamics d, CheckpointPrint *print)
{
  const OperatorsParameter *parameter;
  const PetscReal          *mass;
  PetscInt                  n;
  PetscReal                *p = print->print;

  PetscFunctionBeginUser;
  *print = (CheckpointPrint){.n_print = 8};
  PetscCall(BodiesGetMass(d->bodies, &mass, NULL, NULL));
  for (PetscInt i = 0; i < d->layout->n; i++) p[0] += mass[i] * (1 + i % 7);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &p[0], 1, MPIU_REAL, MPI_SUM, d->comm));
  PetscCall(OperatorsGetParameters(d->operators, &n, &parameter));
  for (PetscInt i = 0; i < n; i++)
    p[1] = 0.99 * p[1] + asinh(parameter[i].value); /* large and small ones count alike */
  for (PetscInt i = 0; i < d->n_interfaces; i++) {
    const ContactInterface *c;

    PetscCall(ContactGetInterfaces(d->contact, &n, &c));
    p[2] = 0.99 * p[2] + c[i].mu + asinh(c[i].speed) + c[i].mu_slope;
    for (int k = 0; k < 3; k++) p[3] = 0.99 * p[3] + c[i].slip[k] + asinh(c[i].rotation[k]) + c[i].center[k];
  }
  p[4] = d->b;
  p[5] = (PetscReal)d->n_elements;
  p[6] = d->coriolis;
  p[7] = d->centrifugal;
  PetscFunctionReturn(0);
}

/* The arrays of the state vectors; those of the rooms are the caller's */
static PetscErrorCode ItemsFill(Dynamics d, Scalars *scalars, PetscScalar *u, PetscScalar *v, PetscScalar *f,
                                CheckpointItem item[N_ITEMS])
{
  const PetscInt n = d->layout->n;
  PetscReal     *damping, *external;
  PetscInt       n_external;

  PetscFunctionBeginUser;
  PetscCall(BodiesGetDampingForce(d->bodies, &damping));
  PetscCall(ExternalGetMemory(d->external, &n_external, &external));
  item[SCALARS]   = (CheckpointItem){"scalars", N_REALS(Scalars), (PetscReal *)scalars};
  item[U]         = (CheckpointItem){"displacements", n, u};
  item[V]         = (CheckpointItem){"velocities", n, v};
  item[KU]        = (CheckpointItem){"stiffness forces", n, d->ku};
  item[DAMPING]   = (CheckpointItem){"damping forces", damping ? n : 0, damping};
  item[FORCE]     = (CheckpointItem){"forces", f ? n : 0, f};
  item[PROJECTOR] = (CheckpointItem){"contact", 0, NULL};
  item[EXTERNAL]  = (CheckpointItem){"external", n_external, external};
  item[HISTORY]   = (CheckpointItem){"history", 0, NULL};
  PetscFunctionReturn(0);
}

/* Every velocity is a number: a spoilt state must not replace a good checkpoint */
static PetscErrorCode CheckNumbers(Dynamics d)
{
  PetscReal norm;

  PetscFunctionBeginUser;
  PetscCall(VecNorm(d->v, NORM_INFINITY, &norm));
  PetscCheck(!PetscIsInfOrNanReal(norm), d->comm, PETSC_ERR_FP,
             "velocities are no numbers: the checkpoint before is kept");
  PetscFunctionReturn(0);
}

static PetscErrorCode ScalarsGet(Dynamics d, Scalars *s)
{
  PetscInt step;

  PetscFunctionBeginUser;
  PetscCall(TSGetTime(d->ts, &s->time));
  PetscCall(TSGetTimeStep(d->ts, &s->dt));
  PetscCall(TSCentralGetLastStep(d->ts, &s->dt_old));
  PetscCall(TSGetStepNumber(d->ts, &step));
  s->step   = (PetscReal)step;
  s->ledger = d->ledger;
  s->part   = d->part;
  s->origin = d->origin;
  PetscFunctionReturn(0);
}

static PetscErrorCode ScalarsSet(Dynamics d, const Scalars *s)
{
  PetscFunctionBeginUser;
  PetscCall(TSSetTime(d->ts, s->time));
  if (d->dt_asked == 0) PetscCall(TSSetTimeStep(d->ts, s->dt));
  PetscCall(TSCentralSetLastStep(d->ts, s->dt_old));
  PetscCall(TSSetStepNumber(d->ts, (PetscInt)s->step));
  d->ledger = s->ledger;
  d->part   = s->part;
  d->origin = s->origin;
  PetscFunctionReturn(0);
}

/* Arrays of u, v and, for b > 1/2, of the forces */
static PetscErrorCode StateArrays(Dynamics d, PetscBool restore, PetscScalar **u, PetscScalar **v, PetscScalar **f)
{
  Vec force, force_old;

  PetscFunctionBeginUser;
  PetscCall(TSCentralGetForces(d->ts, &force, &force_old));
  if (!restore) *f = NULL;
  PetscCall(restore ? VecRestoreArray(d->u, u) : VecGetArray(d->u, u));
  PetscCall(restore ? VecRestoreArray(d->v, v) : VecGetArray(d->v, v));
  if (force_old) PetscCall(restore ? VecRestoreArray(force, f) : VecGetArray(force, f));
  PetscFunctionReturn(0);
}

PetscErrorCode DynamicsKeep(Dynamics d)
{
  CheckpointItem  item[N_ITEMS];
  CheckpointPrint print;
  PetscScalar    *u, *v, *f;
  Scalars         scalars;

  PetscFunctionBeginUser;
  PetscCall(EventBegin(EVENT_CHECKPOINT));
  PetscCall(CheckNumbers(d));
  PetscCall(MakePrint(d, &print));
  PetscCall(ScalarsGet(d, &scalars));
  PetscCall(StateArrays(d, PETSC_FALSE, &u, &v, &f));
  PetscCall(ItemsFill(d, &scalars, u, v, f, item));
  if (d->projector) PetscCall(ContactProjectorGetMemory(d->projector, &item[PROJECTOR].n, &item[PROJECTOR].values));
  PetscCall(HistoryGetMemory(d->history, &item[HISTORY].n, &item[HISTORY].values));
  PetscCall(CheckpointWrite(d->comm, d->results, &print, N_ITEMS, item));
  PetscCall(PetscFree(item[HISTORY].values));
  PetscCall(PetscFree(item[PROJECTOR].values));
  PetscCall(StateArrays(d, PETSC_TRUE, &u, &v, &f));
  PetscCall(EventEnd(EVENT_CHECKPOINT));
  PetscFunctionReturn(0);
}

/* Contact from its memory, at the displacements that were read */
static PetscErrorCode ProjectorGoOn(Dynamics d, PetscReal time, const PetscReal u[], const CheckpointItem *item)
{
  PetscFunctionBeginUser;
  if (!d->projector) PetscFunctionReturn(0);
  for (PetscInt i = 0; i < d->surface.n; i++) LayoutGet(d->layout, d->surface.vertex[i], u, &d->surface.u[3 * i]);
  PetscCall(ContactProjectorSetMemory(d->projector, time, d->surface.u, item->n, item->values));
  PetscFunctionReturn(0);
}

PetscErrorCode DynamicsGoOn(Dynamics d)
{
  CheckpointItem  item[N_ITEMS];
  CheckpointPrint print;
  PetscScalar    *u, *v, *f;
  Scalars         scalars;

  PetscFunctionBeginUser;
  PetscCall(MakePrint(d, &print));
  PetscCall(StateArrays(d, PETSC_FALSE, &u, &v, &f));
  PetscCall(ItemsFill(d, &scalars, u, v, f, item));
  item[PROJECTOR].n = item[HISTORY].n = -1;
  PetscCall(CheckpointRead(d->comm, d->results, &print, N_ITEMS, item));
  PetscCall(ScalarsSet(d, &scalars));
  PetscCall(ProjectorGoOn(d, scalars.time, u, &item[PROJECTOR]));
  PetscCall(HistorySetMemory(d->history, item[HISTORY].n, item[HISTORY].values));
  PetscCall(PetscFree(item[HISTORY].values));
  PetscCall(PetscFree(item[PROJECTOR].values));
  PetscCall(StateArrays(d, PETSC_TRUE, &u, &v, &f));
  PetscFunctionReturn(0);
}
