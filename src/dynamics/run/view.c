/*
   What a run says when it is over: bodies, loads, contact, the step beside the critical one, its cost, the balance of
   energy.
*/
#include "dynamics/dynamicsimpl.h"

PetscErrorCode LedgerView(const Ledger *l, PetscViewer viewer)
{
  const struct {
    const char *name;
    PetscReal   value;
  } line[] = {
    {"kinetic", l->kinetic},
    {"strain", l->strain},
    {"work of loads", l->external},
    {"work of friction", l->friction},
    {"work of contact", l->contact},
    {"work of damping", l->damping},
    {"work of integrator", l->integrator},
    {"heat of friction", l->heat},
  };

  PetscFunctionBeginUser;
  PetscCall(PetscViewerASCIIPrintf(viewer, "energy in J at the end\n"));
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(line); i++)
    PetscCall(PetscViewerASCIIPrintf(viewer, "  %-18s %13.6e\n", line[i].name, (double)line[i].value));
  PetscCall(PetscViewerASCIIPrintf(viewer, "  %-18s %13.6e  %.1e of the largest\n", "left over", (double)l->error,
                                   (double)(l->throughput > 0 ? PetscAbsReal(l->error) / l->throughput : 0)));
  PetscFunctionReturn(0);
}

PetscErrorCode DynamicsView(Dynamics d, PetscViewer viewer)
{
  PetscReal  dt, time;
  ContactKKT kkt;

  PetscFunctionBeginUser;
  PetscCall(TSGetTimeStep(d->ts, &dt));
  PetscCall(TSGetTime(d->ts, &time));
  PetscCall(BodiesView(d->bodies, viewer));
  PetscCall(ExternalView(d->external, viewer));
  if (d->projector) PetscCall(ContactProjectorView(d->projector, viewer));
  PetscCall(PetscViewerASCIIPrintf(viewer, "step %.6g s, %.3g of the critical one %.6g s (single elements: %.6g s)\n",
                                   (double)dt, (double)(dt / d->critical.assembled), (double)d->critical.assembled,
                                   (double)d->critical.element));
  PetscCall(PetscViewerASCIIPrintf(viewer,
                                   "%" PetscInt_FMT " steps to %.6g s in %.4g s: %.4g us per step, %.4g ns per "
                                   "element and step\n",
                                   d->n_steps, (double)time, d->seconds, 1e6 * d->seconds / PetscMax(1, d->n_steps),
                                   1e9 * d->seconds / PetscMax(1, d->n_steps) / d->n_elements));
  PetscCall(LedgerView(&d->ledger.total, viewer));
  if (d->projector && d->view_kkt) {
    PetscCall(ContactProjectorGetKKT(d->projector, &kkt));
    PetscCall(ContactViewKKT(&kkt, viewer));
  }
  PetscFunctionReturn(0);
}
