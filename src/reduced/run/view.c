/*
   What a reduced run says when it is over: size and cut-off with why, the comparison with the mesh, steps and cost,
   laws, energy.
*/
#include "reduced/reducedimpl.h"

/* By which route the contact laws were solved, in steps of this call */
static PetscErrorCode ReducedViewLaws(ReducedRun r, PetscViewer viewer)
{
  static const char *const routes[COMPLIANCE_N_ROUTES] = {[COMPLIANCE_CHORD]  = "factors of steps before",
                                                          [COMPLIANCE_NEWTON] = "Newton",
                                                          [COMPLIANCE_DAMPED] = "line search",
                                                          [COMPLIANCE_PATH]   = "path"};
  ComplianceReport         total;

  PetscFunctionBeginUser;
  PetscCall(ContactComplianceGetTotals(r->motion.stepper->laws, &total));
  PetscCall(PetscViewerASCIIPrintf(viewer,
                                   "contact laws: %" PetscInt_FMT " iterations, %" PetscInt_FMT " factors; steps by",
                                   total.iterations, total.factors));
  for (int i = 0; i < COMPLIANCE_N_ROUTES; i++)
    PetscCall(PetscViewerASCIIPrintf(viewer, " %s %" PetscInt_FMT "%s", routes[i], total.routes[i],
                                     i + 1 < COMPLIANCE_N_ROUTES ? "," : "\n"));
  PetscFunctionReturn(0);
}

/* What the modes hold of a motion that is there */
static PetscErrorCode ReducedViewShare(const char what[], PetscReal share, PetscViewer viewer)
{
  PetscFunctionBeginUser;
  if (share == 0) PetscFunctionReturn(0);
  PetscCall(
    PetscViewerASCIIPrintf(viewer, "  the modes hold %.6g %% of the %s\n", (double)PetscMin(100, 100 * share), what));
  PetscFunctionReturn(0);
}

/* What the cut-off makes of starts and impulses */
static PetscErrorCode ReducedViewShares(ReducedRun r, PetscViewer viewer)
{
  PetscFunctionBeginUser;
  PetscCall(ReducedViewShare("kinetic energy of the starting velocities", r->reduction.held.velocities, viewer));
  PetscCall(
    ReducedViewShare("displacements of -dynamics_shape (squares, by mass)", r->reduction.held.displacements, viewer));
  PetscCall(ReducedViewShare("velocities of -dynamics_shape (squares, by mass)", r->reduction.held.rates, viewer));
  if (r->reduction.n_hits)
    PetscCall(
      PetscViewerASCIIPrintf(viewer, "  only the modes below %.6g Hz receive impulses\n", (double)r->request.cutoff));
  PetscFunctionReturn(0);
}

/* Unknowns that a step does without */
static PetscErrorCode ReducedViewSaved(ReducedRun r, PetscViewer viewer)
{
  const Mesh *mesh;
  Model       model;

  PetscFunctionBeginUser;
  PetscCall(OperatorsGetModel(r->run.operators, &model, NULL));
  PetscCall(ModelGetMesh(model, &mesh));
  PetscCall(PetscViewerASCIIPrintf(viewer,
                                   "saved: %" PetscInt_FMT " modes and %" PetscInt_FMT
                                   " pairs in each step instead of %" PetscInt_FMT " unknowns\n",
                                   r->reduction.model.m, r->reduction.model.n_pairs, mesh->n_unknowns));
  PetscFunctionReturn(0);
}

PetscErrorCode ReducedView(ReducedRun r, PetscViewer viewer)
{
  const double seconds = (double)r->result.seconds;

  PetscFunctionBeginUser;
  PetscCall(PetscViewerASCIIPrintf(
    viewer,
    "reduced model: %" PetscInt_FMT " modes of the unconnected bodies below %.6g Hz (%s), lumped mass, %s; static "
    "compliance of %" PetscInt_FMT " pairs%s\n",
    r->reduction.model.m, (double)r->request.cutoff, r->reduction.why, r->reduction.model.C ? "damped" : "undamped",
    r->reduction.model.n_pairs, r->reduction.model.sparse ? ", by solutions with the sparse factors" : ""));
  PetscCall(ReducedViewSaved(r, viewer));
  PetscCall(ExternalView(r->run.external, viewer));
  PetscCall(ReducedViewShares(r, viewer));
  PetscCall(ReducedCompareView(r, viewer));
  PetscCall(ReducedGrowthView(r, viewer));
  if (!r->motion.stepper) PetscFunctionReturn(0); /* nothing has run in time */
  PetscCall(PetscViewerASCIIPrintf(
    viewer,
    "%" PetscInt_FMT " steps of %.6g s to %.6g s in %.4g s: %.4g us per step, %.3g iterations "
    "of the contact laws; set-up %.4g s\n",
    r->result.n_steps, (double)r->motion.dt, (double)r->motion.state.time, seconds,
    1e6 * seconds / (double)PetscMax(1, r->result.n_steps),
    (double)(r->result.n_its / (PetscReal)PetscMax(1, r->motion.step)), (double)r->result.setup_seconds));
  PetscCall(ReducedViewLaws(r, viewer));
  if (r->request.verify) PetscCall(ReducedVerifyView(r, viewer));
  PetscCall(LedgerView(&r->motion.ledger.total, viewer));
  if (r->run.view_kkt) {
    PetscCall(PetscViewerASCIIPrintf(viewer, "the worst of all steps:\n"));
    PetscCall(ContactViewKKT(&r->result.kkt, viewer));
  }
  PetscFunctionReturn(0);
}
