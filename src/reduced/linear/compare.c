/*
   The error of the reduction before the run: eigenvalues of the reduced model about the sliding state, as they are and
   as the steps see them (warp.c), beside those of the mesh in -modes_band, with the same pairs closed. All have
   friction damping, as Coulomb's law in time does.
*/
#include "reduced/reducedimpl.h"
#include "base/gather.h"

/* Of the angular frequency: growth, 1/s, below it is not resolved any better, and its error is relative to that. */
#define GROWTH_LEAST 1e-4

/* Why the mesh has no modes to compare with, or NULL */
static PetscErrorCode CompareFindObstacle(ReducedRun r, const char **why)
{
  PetscBool has_band;

  PetscFunctionBeginUser;
  *why = r->request.compare ? NULL : "-dynamics_compare false";
  if (r->reduction.model.sparse && !*why) *why = "more pairs than -dynamics_dense";
  PetscCall(ModesHaveBand(r->mesh_modes, &has_band));
  if (!has_band && !*why) *why = "no -modes_band";
  for (PetscInt i = 0; i < r->run.n_interfaces && !*why; i++) {
    const ContactInterface *c = &r->run.interfaces[i];

    if (c->law != CONTACT_CONSTRAINT && !r->request.springs)
      *why = "the penalty law of the modes is not exact contact; -dynamics_contact penalty has it in time too";
    if (!c->slides && FrictionExists(&c->friction)) *why = "nothing says along what the contact slides";
    if (!c->damping && FrictionVaries(&c->friction)) *why = "friction that depends on a speed which is not given";
  }
  PetscFunctionReturn(0);
}

/* The pairs of all ranks that are closed in the state, and their normal forces */
static PetscErrorCode CompareTakeClosed(ReducedRun r, const SlidingState *state)
{
  PetscInt *group;

  PetscFunctionBeginUser;
  PetscCall(GatherRecords(r->comm, state->n_pairs, sizeof(*group), state->group, NULL, &group));
  PetscCall(
    GatherRecords(r->comm, state->n_pairs, sizeof(*r->result.lambda_n), state->lambda_n, NULL, &r->result.lambda_n));
  PetscCall(PetscMalloc1(r->reduction.model.n_pairs, &r->result.closed));
  r->result.n_closed = 0;
  for (PetscInt i = 0; i < r->reduction.model.n_pairs; i++) {
    r->result.closed[i] = group[i] >= 0 ? PETSC_TRUE : PETSC_FALSE;
    r->result.n_closed += r->result.closed[i];
  }
  PetscCall(PetscFree(group));
  PetscFunctionReturn(0);
}

/* The nearest of n eigenvalues to that of the mesh, in rad/s; of a pair of conjugates the one with omega >= 0. */
static void CompareMatch(PetscInt n, const PetscReal sigma[], const PetscReal omega[], const PetscReal mesh[2],
                         PetscReal found[2])
{
  PetscReal nearest = PETSC_MAX_REAL;

  for (PetscInt i = 0; i < n; i++) {
    const PetscReal distance = hypot(sigma[i] - mesh[0], omega[i] - mesh[1]);

    if (omega[i] < 0 || distance >= nearest) continue;
    nearest  = distance;
    found[0] = sigma[i];
    found[1] = omega[i];
  }
}

/* Modes of the mesh about the state */
static PetscErrorCode CompareSolveMesh(ReducedRun r, const SlidingState *state)
{
  const Mode *mode;
  Pencil      pencil;
  PetscBool   terms;

  PetscFunctionBeginUser;
  PetscCall(OperatorsLinearise(r->run.operators, state, &pencil));
  PetscCall(ModesSetPencil(r->mesh_modes, pencil));
  PetscCall(ModesPrepareComponents(r->mesh_modes, &terms));
  PetscCall(ModesSolve(r->mesh_modes));
  PetscCall(ModesFindComponents(r->mesh_modes));
  PetscCall(ModesGet(r->mesh_modes, &r->result.n_compared, &mode));
  PetscCall(PetscCalloc1(r->result.n_compared, &r->result.compared));
  for (PetscInt i = 0; i < r->result.n_compared; i++) {
    r->result.compared[i].mesh[0]  = mode[i].sigma;
    r->result.compared[i].mesh[1]  = mode[i].omega;
    r->result.compared[i].unstable = mode[i].unstable;
    PetscCall(PetscStrncpy(r->result.compared[i].label, mode[i].label, sizeof(r->result.compared[i].label)));
  }
  PetscCall(PencilDestroy(&pencil));
  PetscFunctionReturn(0);
}

PetscErrorCode ReducedCompareMesh(ReducedRun r)
{
  SlidingState state;

  PetscFunctionBeginUser;
  PetscCall(CompareFindObstacle(r, &r->result.not_compared));
  if (r->result.not_compared) PetscFunctionReturn(0);
  PetscCall(StaticsSolveSliding(r->run.statics, NULL, &state));
  PetscCall(StaticsRelease(r->run.statics));
  PetscCall(CompareTakeClosed(r, &state));
  PetscCall(CompareSolveMesh(r, &state));
  PetscCall(SlidingStateDestroy(&state));
  PetscFunctionReturn(0);
}

/* The largest errors of growth over the unstable modes, relative to it or to a small part of the frequency */
static void CompareJudge(ReducedRun r)
{
  r->result.miss_model = r->result.miss_steps = 0;
  for (PetscInt i = 0; i < r->result.n_compared; i++) {
    const ReducedPair *c = &r->result.compared[i];

    const PetscReal scale = PetscMax(c->mesh[0], GROWTH_LEAST * c->mesh[1]);

    if (!c->unstable) continue;
    r->result.miss_model = PetscMax(r->result.miss_model, PetscAbsReal(c->reduced[0] - c->mesh[0]) / scale);
    r->result.miss_steps = PetscMax(r->result.miss_steps, PetscAbsReal(c->steps[0] - c->reduced[0]) / scale);
  }
}

/* Steps are compared with the reduced model, not with the mesh: miss_model and miss_steps are two parts of the
   error, and add. */
PetscErrorCode ReducedCompare(ReducedRun r)
{
  const PetscInt n = 2 * r->reduction.model.m;
  PetscReal     *sigma, *omega;

  PetscFunctionBeginUser;
  if (r->result.not_compared) PetscFunctionReturn(0);
  PetscCall(PetscMalloc2(n, &sigma, n, &omega));
  PetscCall(ReducedLinearise(&r->reduction.model, r->result.closed, r->result.lambda_n, PETSC_FALSE, sigma, omega));
  for (PetscInt i = 0; i < r->result.n_compared; i++)
    CompareMatch(n, sigma, omega, r->result.compared[i].mesh, r->result.compared[i].reduced);
  PetscCall(
    ReducedLineariseSteps(&r->reduction.model, r->motion.dt, r->result.closed, r->result.lambda_n, sigma, omega));
  for (PetscInt i = 0; i < r->result.n_compared; i++)
    CompareMatch(n, sigma, omega, r->result.compared[i].reduced, r->result.compared[i].steps);
  PetscCall(PetscFree2(sigma, omega));
  CompareJudge(r);
  PetscFunctionReturn(0);
}

PetscErrorCode ReducedCompareView(ReducedRun r, PetscViewer viewer)
{
  PetscFunctionBeginUser;
  if (r->result.not_compared) {
    PetscCall(PetscViewerASCIIPrintf(viewer, "eigenvalues of the mesh not compared: %s\n", r->result.not_compared));
    PetscFunctionReturn(0);
  }
  PetscCall(PetscViewerASCIIPrintf(viewer,
                                   "eigenvalues about the sliding state, %" PetscInt_FMT " of %" PetscInt_FMT
                                   " pairs closed: mesh, reduced, reduced in steps of %.6g s\n",
                                   r->result.n_closed, r->reduction.model.n_pairs, (double)r->motion.dt));
  for (PetscInt i = 0; i < r->result.n_compared; i++) {
    const ReducedPair *c = &r->result.compared[i];

    PetscCall(PetscViewerASCIIPrintf(
      viewer, "  %10.4f Hz %+10.4f 1/s   %10.4f Hz %+10.4f 1/s   %10.4f Hz %+10.4f 1/s  %s\n",
      (double)(c->mesh[1] / (2 * PETSC_PI)), (double)c->mesh[0], (double)(c->reduced[1] / (2 * PETSC_PI)),
      (double)c->reduced[0], (double)(c->steps[1] / (2 * PETSC_PI)), (double)c->steps[0], c->label));
  }
  PetscCall(PetscViewerASCIIPrintf(viewer,
                                   "growth of unstable modes: reduced off by %.2g %% at most, steps by %.2g %% more\n",
                                   (double)(100 * r->result.miss_model), (double)(100 * r->result.miss_steps)));
  PetscFunctionReturn(0);
}
