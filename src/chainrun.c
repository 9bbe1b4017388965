/* What each analysis makes of the chain: solution, view, tables */
#include "chain.h"

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

/* The pencil of those that are about one point */
static PetscErrorCode ChainGivePencil(Chain *chain)
{
  PetscBool components;

  PetscFunctionBeginUser;
  if (chain->analysis == ANALYSIS_SWEEP) PetscCall(PencilDestroy(&chain->pencil)); /* a sweep makes its own */
  if (chain->analysis != ANALYSIS_MODES && chain->analysis != ANALYSIS_FRF) PetscFunctionReturn(0);
  PetscCall(ChainLinearise(chain));
  PetscCall(ModesWantComponents(chain->modes, &components)); /* which ask for another pencil */
  if (chain->analysis == ANALYSIS_MODES && !components) PetscCall(PencilReleaseTerms(chain->pencil));
  PetscCall(ModesSetPencil(chain->modes, chain->pencil));
  PetscCall(FrfSetPencil(chain->frf, chain->pencil));
  PetscFunctionReturn(0);
}

static PetscErrorCode ChainSolve(Chain *chain)
{
  const Analysis analysis = chain->analysis;
  PetscBool      components;

  PetscFunctionBeginUser;
  if (analysis == ANALYSIS_MODES) PetscCall(ModesSolve(chain->modes));
  PetscCall(ModesWantComponents(chain->modes, &components));
  if (analysis == ANALYSIS_MODES && components) PetscCall(ModesFindComponents(chain->modes));
  if (analysis == ANALYSIS_SWEEP) PetscCall(SweepSolve(chain->sweep, chain->results));
  if (analysis == ANALYSIS_STATIC) PetscCall(StaticsSolve(chain->statics, chain->p));
  if (analysis == ANALYSIS_TRANSIENT) PetscCall(ChainIntegrate(chain));
  if (analysis == ANALYSIS_FRF) PetscCall(FrfSolve(chain->frf));
  if (analysis == ANALYSIS_MAP) PetscCall(MapSolve(chain->map, chain->results));
  if (analysis == ANALYSIS_CYCLE) PetscCall(CycleSolve(chain->cycle, chain->results));
  PetscFunctionReturn(0);
}

/* Tables and fields of what is not in time */
static PetscErrorCode ChainWrite(Chain *chain)
{
  const Analysis analysis = chain->analysis;

  PetscFunctionBeginUser;
  PetscCall(SquealStageBegin(SQUEAL_RESULTS));
  if (analysis == ANALYSIS_MODES) PetscCall(ModesWrite(chain->modes, chain->results));
  if (analysis == ANALYSIS_SWEEP) PetscCall(SweepWrite(chain->sweep, chain->results));
  if (analysis == ANALYSIS_STATIC) PetscCall(StaticsWrite(chain->statics, chain->results));
  if (analysis == ANALYSIS_FRF) PetscCall(ChainWriteFrf(chain));
  PetscCall(SquealStageEnd(SQUEAL_RESULTS));
  PetscFunctionReturn(0);
}

PetscErrorCode ChainRun(Chain *chain)
{
  static const struct {
    SquealStage stage;
    Shown       shown;
  } run[N_ANALYSES] = {[ANALYSIS_MODES]     = {SQUEAL_MODES, SHOWN_MODES},
                       [ANALYSIS_SWEEP]     = {SQUEAL_SWEEP, SHOWN_SWEEP},
                       [ANALYSIS_STATIC]    = {SQUEAL_STATICS, SHOWN_STATICS},
                       [ANALYSIS_TRANSIENT] = {SQUEAL_DYNAMICS, SHOWN_DYNAMICS},
                       [ANALYSIS_FRF]       = {SQUEAL_FRF, SHOWN_FRF},
                       [ANALYSIS_MAP]       = {SQUEAL_DYNAMICS, SHOWN_MAP},
                       [ANALYSIS_CYCLE]     = {SQUEAL_DYNAMICS, SHOWN_CYCLE}};

  PetscFunctionBeginUser;
  /* those look for checkpoints before */
  if (!ChainIsInTime(chain)) PetscCall(ResultsBegin(chain->results, PETSC_FALSE));
  PetscCall(ChainGivePencil(chain));
  PetscCall(SquealStageBegin(run[chain->analysis].stage));
  PetscCall(ChainSolve(chain));
  PetscCall(SquealStageEnd(run[chain->analysis].stage));
  PetscCall(ChainShow(chain, run[chain->analysis].shown, PETSC_TRUE));
  if (!ChainIsInTime(chain)) PetscCall(ChainWrite(chain)); /* which writes as it goes */
  if (chain->analysis == ANALYSIS_MAP) PetscCall(MapJudge(chain->map));
  if (chain->analysis == ANALYSIS_TRANSIENT) PetscCall(ReducedJudgeVerified(chain->reduced));
  PetscFunctionReturn(0);
}
