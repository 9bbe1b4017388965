/*
   Cut-off and step. What -dynamics_cutoff and -ts_dt leave open is begun with what the band of interest tells, and then
   chosen such that growth of the unstable modes in that band is off by -dynamics_growth_rtol at most in the run: one
   half of it for the reduction, by a higher cut-off, one half for the step, whose error falls with its square.
*/
#include "reduced/reducedimpl.h"

#define CUTOFF 20e3 /* Hz, where nothing says which band is of interest */
/* Times the upper end of -modes_band: what the cut-off leaves out is a static compliance, exact to (f / f_cut)^2 =
   1/16 of itself. */
#define CUTOFF_BAND 4
#define RAISE       1.5 /* of the cut-off at once */
/* 1.5^4 = 5 times the first cut-off at most. */
#define MOST_RAISES 4
#define SHORTER     0.9 /* of the largest step that would do */

/* Hz. A cut-off that is chosen may be raised later; r->reduction.why is what the run says of it. */
PetscErrorCode ReducedChooseCutoff(ReducedRun r)
{
  PetscBool has_band;
  PetscReal band[2], growth;

  PetscFunctionBeginUser;
  r->reduction.chooses = r->request.cutoff > 0 ? PETSC_FALSE : PETSC_TRUE;
  r->reduction.why     = "as -dynamics_cutoff says";
  if (!r->reduction.chooses) PetscFunctionReturn(0);
  PetscCall(ModesHaveBand(r->mesh_modes, &has_band));
  if (has_band) PetscCall(ModesGetBand(r->mesh_modes, band, &growth));
  r->request.cutoff = has_band ? CUTOFF_BAND * band[1] : CUTOFF;
  r->reduction.why =
    has_band ? "4 times the end of -modes_band" : "no -modes_band says which frequencies are of interest";
  PetscFunctionReturn(0);
}

/* -ts_dt, or dt where that leaves it open; refused beyond one period of the cut-off. */
PetscErrorCode ReducedSetStep(ReducedRun r, PetscReal dt)
{
  PetscFunctionBeginUser;
  PetscCall(DynamicsGetStep(r->dynamics, dt, &r->run));
  r->motion.dt = r->run.dt;
  PetscCheck(
    r->motion.dt * r->request.cutoff <= 1 + 1e-9, r->comm, PETSC_ERR_USER_INPUT,
    "-ts_dt %.6g is longer than a period of -dynamics_cutoff %.6g Hz: contact cannot follow; take at most %.6g",
    (double)r->motion.dt, (double)r->request.cutoff, 1 / (double)r->request.cutoff);
  PetscFunctionReturn(0);
}

/* Raises the error for an unstable mode of the mesh above the cut-off */
static PetscErrorCode ChooseCheck(ReducedRun r)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < r->result.n_compared; i++)
    PetscCheck(!r->result.compared[i].unstable || r->result.compared[i].mesh[1] < 2 * PETSC_PI * r->request.cutoff,
               r->comm, PETSC_ERR_USER_INPUT,
               "-dynamics_cutoff %.6g Hz is below the unstable mode at %.6g Hz; take at least twice that",
               (double)r->request.cutoff, (double)(r->result.compared[i].mesh[1] / (2 * PETSC_PI)));
  PetscFunctionReturn(0);
}

/* Growth of the unstable modes beside that of the mesh, and with the inertia of what the cut-off leaves out: where no
   mesh is compared but -dynamics_growth_rtol is given, that is what it may be off by */
static PetscErrorCode ChooseJudge(ReducedRun r)
{
  PetscReal off;

  PetscFunctionBeginUser;
  PetscCall(ReducedCompare(r));
  PetscCall(ReducedWeighGrowth(r, &off));
  if (r->result.not_compared && r->request.has_rtol) r->result.miss_model = off;
  PetscFunctionReturn(0);
}

/* Says where what was asked for is not reached, by the cut-off or by the step */
static PetscErrorCode ChooseWarn(ReducedRun r)
{
  const PetscReal off = r->result.miss_model + r->result.miss_steps;

  PetscFunctionBeginUser;
  if (r->request.has_rtol && off > r->request.growth_rtol)
    PetscCall(PetscFPrintf(
      r->comm, stderr,
      "squeal: warning: -dynamics_growth_rtol %.3g is not reached: growth may be off by %.2g of itself with the "
      "cut-off %.6g Hz, and by %.2g with the step %.3g s; say a higher -dynamics_cutoff, a shorter -ts_dt\n",
      (double)r->request.growth_rtol, (double)r->result.miss_model, (double)r->request.cutoff,
      (double)r->result.miss_steps, (double)r->motion.dt));
  PetscFunctionReturn(0);
}

/* Each raise reduces the bodies again; the mesh is solved once. The step's error goes with dt^2, hence dt sqrt(half
   / miss), and a tenth less for what is of higher order. Eigenvalues are the same on all ranks, and so are the
   decisions. */
PetscErrorCode ReducedChoose(ReducedRun r)
{
  const PetscReal half = 0.5 * r->request.growth_rtol;

  PetscFunctionBeginUser;
  PetscCall(ReducedReduce(r));
  PetscCall(ReducedCompareMesh(r));
  PetscCall(ChooseCheck(r));
  PetscCall(ChooseJudge(r));
  if (!r->reduction.chooses) PetscFunctionReturn(0);
  for (int i = 0; i < MOST_RAISES && r->result.miss_model > half; i++) {
    r->request.cutoff *= RAISE;
    r->reduction.why = r->result.not_compared
                         ? "by the growth of unstable modes beside that with the inertia of what is above"
                         : "by the growth of unstable modes beside that of the mesh";
    PetscCall(ReducedForget(r));
    PetscCall(ReducedSetStep(r, 1 / (2 * PETSC_PI * r->request.cutoff)));
    PetscCall(ReducedReduce(r));
    PetscCall(ChooseJudge(r));
  }
  for (int i = 0; i < MOST_RAISES && r->result.miss_steps > half; i++) {
    const PetscReal dt = r->motion.dt;

    PetscCall(ReducedSetStep(r, SHORTER * dt * PetscSqrtReal(half / r->result.miss_steps)));
    if (r->motion.dt == dt) break; /* -ts_dt */
    PetscCall(ReducedCompare(r));
  }
  PetscCall(ChooseWarn(r));
  PetscFunctionReturn(0);
}
