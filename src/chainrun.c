/* What each analysis makes of the chain, in one row: what it needs, solution, view, tables */
#include "chain.h"

/* The pencil about one point, of modes and frequency responses */
static PetscErrorCode ChainGivePencil(Chain *chain)
{
  PetscBool terms;

  PetscFunctionBeginUser;
  PetscCall(ChainLinearise(chain));
  PetscCall(ModesWantTerms(chain->modes, &terms));
  if (chain->analysis == ANALYSIS_MODES && !terms) PetscCall(PencilReleaseTerms(chain->pencil));
  PetscCall(ModesSetPencil(chain->modes, chain->pencil));
  PetscCall(FrfSetPencil(chain->frf, chain->pencil));
  PetscFunctionReturn(0);
}

static PetscErrorCode ChainSolveModes(Chain *chain)
{
  PetscBool components, changes;

  PetscFunctionBeginUser;
  PetscCall(ModesWantComponents(chain->modes, &components));
  PetscCall(ModesPlaceChanges(chain->modes, &changes));
  PetscCall(ModesSolve(chain->modes));
  if (components) PetscCall(ModesFindComponents(chain->modes));
  if (changes) PetscCall(ModesFindChanges(chain->modes));
  PetscFunctionReturn(0);
}

/* In time on the mesh, or reduced */
static PetscErrorCode ChainIntegrate(Chain *chain)
{
  PetscBool reduced;

  PetscFunctionBeginUser;
  PetscCall(ReducedIsAsked(chain->reduced, &reduced));
  if (reduced)
    PetscCall(ReducedIntegrate(chain->reduced, chain->results));
  else
    PetscCall(DynamicsSolve(chain->dynamics, chain->results));
  PetscFunctionReturn(0);
}

/* The response, and the modes that it is made of */
static PetscErrorCode ChainWriteFrf(Chain *chain)
{
  PetscInt    n;
  const Mode *mode;

  PetscFunctionBeginUser;
  PetscCall(FrfWrite(chain->frf, chain->results));
  PetscCall(ModesGet(chain->modes, &n, &mode));
  if (n) PetscCall(ModesWrite(chain->modes, chain->results));
  PetscFunctionReturn(0);
}

/* What a run computes with: nothing is solved, all of the scene is read, paired, assembled, and shown */
static PetscErrorCode ChainShowScene(Chain *chain)
{
  const PetscBool is_shown = chain->view; /* with all else */

  PetscFunctionBeginUser;
  if (chain->model) PetscCall(ChainShow(chain, SHOWN_MODEL, !is_shown));
  if (chain->contact) PetscCall(ChainShow(chain, SHOWN_CONTACT, !is_shown));
  if (!chain->model) PetscCall(ChainShow(chain, SHOWN_OPERATORS, !is_shown));
  PetscFunctionReturn(0);
}

static PetscErrorCode ChainWriteScene(Chain *chain)
{
  PetscFunctionBeginUser;
  if (chain->contact) PetscCall(ContactWrite(chain->contact, chain->results));
  PetscFunctionReturn(0);
}

/* A step of an analysis that is one call */
#define STEP(name, call)                                                                                               \
  static PetscErrorCode name(Chain *chain)                                                                             \
  {                                                                                                                    \
    PetscFunctionBeginUser;                                                                                            \
    PetscCall(call);                                                                                                   \
    PetscFunctionReturn(0);                                                                                            \
  }

STEP(ChainWriteModes, ModesWrite(chain->modes, chain->results))
STEP(ChainForgetPencil, PencilDestroy(&chain->pencil)) /* A sweep makes pencils of its own */
STEP(ChainSolveSweep, SweepSolve(chain->sweep, chain->results))
STEP(ChainWriteSweep, SweepWrite(chain->sweep, chain->results))
STEP(ChainSolveStatics, StaticsSolve(chain->statics, chain->p))
STEP(ChainWriteStatics, StaticsWrite(chain->statics, chain->results))
STEP(ChainJudgeReduced, ReducedJudgeVerified(chain->reduced))
STEP(ChainSolveFrf, FrfSolve(chain->frf))
STEP(ChainSolveMap, MapSolve(chain->map, chain->results))
STEP(ChainJudgeMap, MapJudge(chain->map))
STEP(ChainSolveCycle, CycleSolve(chain->cycle, chain->results))

/* NULL for what an analysis has not. Those in time write as they go, and look for checkpoints before they begin */
static const struct {
  SquealStage stage;
  Shown       shown;
  PetscErrorCode (*prepare)(Chain *chain);
  PetscErrorCode (*solve)(Chain *chain);
  PetscErrorCode (*write)(Chain *chain);
  PetscErrorCode (*judge)(Chain *chain); /* raises an error where results that are written do not hold */
} runs[N_ANALYSES] = {
  [ANALYSIS_MODES]     = {SQUEAL_MODES, SHOWN_MODES, ChainGivePencil, ChainSolveModes, ChainWriteModes, NULL},
  [ANALYSIS_SWEEP]     = {SQUEAL_SWEEP, SHOWN_SWEEP, ChainForgetPencil, ChainSolveSweep, ChainWriteSweep, NULL},
  [ANALYSIS_STATIC]    = {SQUEAL_STATICS, SHOWN_STATICS, NULL, ChainSolveStatics, ChainWriteStatics, NULL},
  [ANALYSIS_TRANSIENT] = {SQUEAL_DYNAMICS, SHOWN_DYNAMICS, NULL, ChainIntegrate, NULL, ChainJudgeReduced},
  [ANALYSIS_FRF]       = {SQUEAL_FRF, SHOWN_FRF, ChainGivePencil, ChainSolveFrf, ChainWriteFrf, NULL},
  [ANALYSIS_MAP]       = {SQUEAL_DYNAMICS, SHOWN_MAP, NULL, ChainSolveMap, NULL, ChainJudgeMap},
  [ANALYSIS_CYCLE]     = {SQUEAL_DYNAMICS, SHOWN_CYCLE, NULL, ChainSolveCycle, NULL, NULL},
  [ANALYSIS_CHECK]     = {SQUEAL_MODEL, N_SHOWN, NULL, ChainShowScene, ChainWriteScene, NULL},
};

PetscErrorCode ChainRun(Chain *chain)
{
  const Analysis a = chain->analysis;

  PetscFunctionBeginUser;
  if (runs[a].write) PetscCall(ResultsBegin(chain->results, PETSC_FALSE));
  if (runs[a].prepare) PetscCall(runs[a].prepare(chain));
  PetscCall(SquealStageBegin(runs[a].stage));
  PetscCall(runs[a].solve(chain));
  PetscCall(SquealStageEnd(runs[a].stage));
  if (runs[a].shown < N_SHOWN) PetscCall(ChainShow(chain, runs[a].shown, PETSC_TRUE));
  if (runs[a].write) {
    PetscCall(SquealStageBegin(SQUEAL_RESULTS));
    PetscCall(runs[a].write(chain));
    PetscCall(SquealStageEnd(SQUEAL_RESULTS));
  }
  if (runs[a].judge) PetscCall(runs[a].judge(chain));
  PetscFunctionReturn(0);
}
