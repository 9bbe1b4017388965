/*
   What the impulses of a run did: when they acted, and whether they opened or stuck pairs of the contacts, in words and
   in impulses.csv. A response is linear while the same pairs touch as before the blow.
*/
#include "dynamicsimpl.h"

/* Over all contacts, since the first impulse: steps, those with other numbers of open or sticking pairs than before it,
   and how many pairs differ at most */
typedef struct {
  PetscReal steps, changed, most;
} ImpulseEffect;

/* The largest over the contacts, not the sum: one step in which two contacts change counts once */
static ImpulseEffect ImpulseMeasure(PetscInt n_interfaces, const ContactSums sums[])
{
  ImpulseEffect effect = {0, 0, 0};

  for (PetscInt i = 0; i < n_interfaces; i++) {
    const ContactSums *s = &sums[i];

    if (s->marked == 0) continue;
    effect.steps   = s->steps - s->marked;
    effect.changed = PetscMax(effect.changed, s->changed);
    effect.most    = PetscMax(effect.most, s->most);
  }
  return effect;
}

/* From the first impulse on numbers of open and sticking pairs are compared with those before it. */
PetscErrorCode DynamicsMarkImpulse(Dynamics d)
{
  PetscFunctionBeginUser;
  if (d->projector && ExternalIsHitting(d->external)) PetscCall(ContactProjectorMark(d->projector));
  PetscFunctionReturn(0);
}

PetscErrorCode DynamicsWriteImpulses(Dynamics d, const ContactSums sums[], const PetscReal time[])
{
  const ImpulseEffect effect = ImpulseMeasure(d->n_interfaces, sums);
  ResultsTable        table;
  PetscInt            n;

  PetscFunctionBeginUser;
  PetscCall(ExternalCountHits(d->external, &n));
  if (!n) PetscFunctionReturn(0);
  PetscCall(ResultsTableOpen(d->results, "impulses",
                             "name,time_s,x_m,y_m,z_m,impulse_x_n_s,impulse_y_n_s,impulse_z_n_s,steps_after,"
                             "steps_changed,pairs_changed",
                             &table));
  for (PetscInt i = 0; i < n; i++) {
    ExternalHit hit;

    PetscCall(ExternalGetHit(d->external, i, &hit));
    if (time[i] < 0) continue; /* the run ended before */
    PetscCall(ResultsTableRow(table, "%s,%.15g,%.15g,%.15g,%.15g,%.15g,%.15g,%.15g,%.15g,%.15g,%.15g", hit.name,
                              (double)time[i], (double)hit.x[0], (double)hit.x[1], (double)hit.x[2],
                              (double)hit.impulse[0], (double)hit.impulse[1], (double)hit.impulse[2],
                              (double)effect.steps, (double)effect.changed, (double)effect.most));
  }
  PetscCall(ResultsTableClose(&table));
  if (effect.changed > 0)
    PetscCall(PetscPrintf(d->comm,
                          "after the impulse %.0f of %.0f steps have other numbers of open or sticking pairs than "
                          "before it, by %.0f at most: the response is not linear\n",
                          (double)effect.changed, (double)effect.steps, (double)effect.most));
  PetscFunctionReturn(0);
}

/* An impulse that has acted has its time; 0 stands for none, as no impulse acts at t = 0 (external/impulse.c). */
PetscErrorCode DynamicsReportImpulses(Dynamics d)
{
  PetscReal *time;
  PetscInt   n;

  PetscFunctionBeginUser;
  PetscCall(ExternalCountHits(d->external, &n));
  PetscCall(PetscMalloc1(n, &time));
  for (PetscInt i = 0; i < n; i++) {
    ExternalHit hit;

    PetscCall(ExternalGetHit(d->external, i, &hit));
    time[i] = hit.time > 0 ? hit.time : -1;
  }
  PetscCall(DynamicsWriteImpulses(d, d->sums, time));
  PetscCall(PetscFree(time));
  PetscFunctionReturn(0);
}
