/*
   The error of the reduction before the run: eigenvalues of the reduced model about the sliding state beside those of the
   mesh in -modes_band, with the same pairs closed.
*/
#include "reducedimpl.h"
#include "base/gather.h"

/* Why the mesh has no modes to compare with, or NULL */
static PetscErrorCode CompareFindObstacle(ReducedRun r, const char **why)
{
  PetscBool has_band;

  PetscFunctionBeginUser;
  *why = r->compare ? NULL : "-dynamics_compare false";
  PetscCall(ModesHaveBand(r->mesh_modes, &has_band));
  if (!has_band && !*why) *why = "no -modes_band";
  for (PetscInt i = 0; i < r->run.n_interfaces && !*why; i++) {
    const ContactInterface *c = &r->run.interfaces[i];

    if (c->law != CONTACT_CONSTRAINT) *why = "the penalty law of the modes is not exact contact";
    if (!c->slides && c->mu > 0) *why = "nothing says along what the contact slides";
    if (c->damping || c->mu_slope != 0) *why = "friction that depends on the speed";
  }
  PetscFunctionReturn(0);
}

/* Eigenvalues of the reduced model with the pairs of the state closed */
static PetscErrorCode CompareLinearise(ReducedRun r, const SlidingState *state, PetscReal sigma[], PetscReal omega[])
{
  PetscInt  *group;
  PetscBool *closed;

  PetscFunctionBeginUser;
  PetscCall(GatherRecords(r->comm, state->n_pairs, sizeof(*group), state->group, NULL, &group));
  PetscCall(PetscMalloc1(r->model.n_pairs, &closed));
  r->n_closed = 0;
  for (PetscInt i = 0; i < r->model.n_pairs; i++) {
    closed[i] = group[i] >= 0 ? PETSC_TRUE : PETSC_FALSE;
    r->n_closed += closed[i];
  }
  PetscCall(ReducedLinearise(&r->model, closed, sigma, omega));
  PetscCall(PetscFree(closed));
  PetscCall(PetscFree(group));
  PetscFunctionReturn(0);
}

/* The nearest of n eigenvalues */
static void CompareMatch(PetscInt n, const PetscReal sigma[], const PetscReal omega[], ReducedPair *pair)
{
  PetscReal nearest = PETSC_MAX_REAL;

  for (PetscInt i = 0; i < n; i++) {
    const PetscReal distance = hypot(sigma[i] - pair->mesh[0], omega[i] - pair->mesh[1]);

    if (omega[i] < 0 || distance >= nearest) continue;
    nearest          = distance;
    pair->reduced[0] = sigma[i];
    pair->reduced[1] = omega[i];
  }
}

/* Modes of the mesh about the state */
static PetscErrorCode CompareSolveMesh(ReducedRun r, const SlidingState *state)
{
  const Mode *mode;
  Pencil      pencil;

  PetscFunctionBeginUser;
  PetscCall(OperatorsLinearise(r->run.operators, state, &pencil));
  PetscCall(ModesSetPencil(r->mesh_modes, pencil));
  PetscCall(ModesSolve(r->mesh_modes));
  PetscCall(ModesGet(r->mesh_modes, &r->n_compared, &mode));
  PetscCall(PetscCalloc1(r->n_compared, &r->compared));
  for (PetscInt i = 0; i < r->n_compared; i++) {
    r->compared[i].mesh[0] = mode[i].sigma;
    r->compared[i].mesh[1] = mode[i].omega;
    PetscCall(PetscStrncpy(r->compared[i].label, mode[i].label, sizeof(r->compared[i].label)));
    PetscCheck(!mode[i].unstable || mode[i].omega < 2 * PETSC_PI * r->cutoff, r->comm, PETSC_ERR_USER_INPUT,
               "-dynamics_cutoff %.6g Hz is below the unstable mode at %.6g Hz; take at least twice that",
               (double)r->cutoff, (double)(mode[i].omega / (2 * PETSC_PI)));
  }
  PetscCall(PencilDestroy(&pencil));
  PetscFunctionReturn(0);
}

PetscErrorCode ReducedCompare(ReducedRun r)
{
  PetscReal   *sigma, *omega;
  SlidingState state;

  PetscFunctionBeginUser;
  PetscCall(CompareFindObstacle(r, &r->not_compared));
  if (r->not_compared) PetscFunctionReturn(0);
  PetscCall(StaticsSolveSliding(r->run.statics, NULL, &state));
  PetscCall(StaticsRelease(r->run.statics));
  PetscCall(CompareSolveMesh(r, &state));
  PetscCall(PetscMalloc2(2 * r->model.m, &sigma, 2 * r->model.m, &omega));
  PetscCall(CompareLinearise(r, &state, sigma, omega));
  for (PetscInt i = 0; i < r->n_compared; i++) CompareMatch(2 * r->model.m, sigma, omega, &r->compared[i]);
  PetscCall(PetscFree2(sigma, omega));
  PetscCall(SlidingStateDestroy(&state));
  PetscFunctionReturn(0);
}

PetscErrorCode ReducedCompareView(ReducedRun r, PetscViewer viewer)
{
  PetscFunctionBeginUser;
  if (r->not_compared) {
    PetscCall(PetscViewerASCIIPrintf(viewer, "eigenvalues of the mesh not compared: %s\n", r->not_compared));
    PetscFunctionReturn(0);
  }
  PetscCall(PetscViewerASCIIPrintf(
    viewer, "eigenvalues about the sliding state, %" PetscInt_FMT " of %" PetscInt_FMT " pairs closed: mesh, reduced\n",
    r->n_closed, r->model.n_pairs));
  for (PetscInt i = 0; i < r->n_compared; i++) {
    const ReducedPair *c = &r->compared[i];

    PetscCall(PetscViewerASCIIPrintf(viewer, "  %10.4f Hz %+10.4f 1/s   %10.4f Hz %+10.4f 1/s  %s\n",
                                     (double)(c->mesh[1] / (2 * PETSC_PI)), (double)c->mesh[0],
                                     (double)(c->reduced[1] / (2 * PETSC_PI)), (double)c->reduced[0], c->label));
  }
  PetscFunctionReturn(0);
}
