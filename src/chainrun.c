/* What each analysis makes of the chain, in one row: what it needs, solution, view, tables, what it does
   and what it uses of the scene */
#include "chain.h"
#include <string.h>

/* The pencil about one point, of modes and frequency responses */
static PetscErrorCode ChainGivePencil(Chain *chain)
{
  PetscBool terms, components;

  PetscFunctionBeginUser;
  PetscCall(ChainLinearise(chain));
  PetscCall(ModesSetPencil(chain->modes, chain->pencil));
  if (chain->analysis == ANALYSIS_MODES) {
    PetscCall(ModesWantTerms(chain->modes, &terms));
    PetscCall(ModesPrepareComponents(chain->modes, &components));
    if (!terms && !components) PetscCall(PencilReleaseTerms(chain->pencil));
  }
  PetscCall(FrfSetPencil(chain->frf, chain->pencil));
  PetscFunctionReturn(0);
}

static PetscErrorCode ChainSolveModes(Chain *chain)
{
  PetscBool changes;

  PetscFunctionBeginUser;
  PetscCall(ModesPlaceChanges(chain->modes, &changes));
  PetscCall(ModesSolve(chain->modes));
  PetscCall(ModesFindComponents(chain->modes));
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

/* The wear of a point of a sweep over wear_time ends at its value */
static PetscErrorCode ChainCheckWear(const Chain *chain)
{
  const ContactWear *wear;

  PetscFunctionBeginUser;
  if (!chain->contact) PetscFunctionReturn(0);
  PetscCall(ContactGetWear(chain->contact, &wear));
  PetscCheck(wear->depth == 0 && wear->settled == 0, PETSC_COMM_WORLD, PETSC_ERR_USER_INPUT,
             "-wear_%s %g: points of a sweep over wear_time would have worn for less than their value; leave it out",
             wear->depth > 0 ? "depth" : "settled", (double)(wear->depth > 0 ? wear->depth : wear->settled));
  PetscFunctionReturn(0);
}

/* Options that are varied, as one list, may be of what makes damping, of which one point may have none. A component
   ends in _x, _y or _z: damper_viscosity_x */
static PetscErrorCode ChainAddVaried(Chain *chain, const char varied[], unsigned *does)
{
  char **name;
  int    n;

  PetscFunctionBeginUser;
  PetscCall(PetscStrToArray(varied, ',', &n, &name));
  for (int i = 0; i < n; i++) {
    const size_t   length = strlen(name[i]);
    QuantitySearch search = {.option = name[i] + strspn(name[i], " ")};

    for (int pass = 0; pass < 2 && !search.found; pass++) {
      if (pass && length > 2 && name[i][length - 2] == '_') name[i][length - 2] = '\0';
      PetscCall(ChainVisit(chain, &(QuantityVisitor){QuantitiesSearch, &search}));
    }
    if (search.found && search.row.varies & VARIES_DAMPING) *does |= RUN_DAMPED | RUN_UNDAMPED;
    if (search.found && !strcmp(search.row.name, "-wear_time")) {
      *does |= RUN_WEARS;
      PetscCall(ChainCheckWear(chain));
    }
  }
  PetscCall(PetscStrToArrayDestroy(n, name));
  PetscFunctionReturn(0);
}

/* Real modes have no damping */
static PetscErrorCode ChainAddSweep(Chain *chain, unsigned *does)
{
  const char *swept;
  PetscBool   real;

  PetscFunctionBeginUser;
  PetscCall(SweepGetAsked(chain->sweep, &swept, &real));
  if (real) *does |= RUN_UNDAMPED;
  PetscCall(ChainAddVaried(chain, swept, does));
  PetscFunctionReturn(0);
}

static PetscErrorCode ChainAddSample(Chain *chain, unsigned *does)
{
  const char *varied;

  PetscFunctionBeginUser;
  PetscCall(SampleGetVaried(chain->sample, &varied));
  PetscCall(ChainAddVaried(chain, varied, does));
  PetscFunctionReturn(0);
}

static PetscErrorCode ChainAddQuiet(Chain *chain, unsigned *does)
{
  const char *varied;

  PetscFunctionBeginUser;
  PetscCall(QuietGetVaried(chain->quiet, &varied));
  PetscCall(ChainAddVaried(chain, varied, does));
  PetscFunctionReturn(0);
}

static PetscErrorCode ChainAddDesign(Chain *chain, unsigned *does)
{
  const char *varied;

  PetscFunctionBeginUser;
  PetscCall(DesignGetVaried(chain->design, &varied));
  PetscCall(ChainAddVaried(chain, varied, does));
  PetscFunctionReturn(0);
}

/* A cycle is looked for at the end of a transient, or near the mode that becomes unstable */
static PetscErrorCode ChainAddCycle(Chain *chain, unsigned *does)
{
  PetscBool follows;

  PetscFunctionBeginUser;
  PetscCall(CycleFollowsTransient(chain->cycle, &follows));
  if (follows) *does |= RUN_HISTORY;
  PetscFunctionReturn(0);
}

/* The run in time */
static PetscErrorCode ChainViewTransient(Chain *chain, PetscViewer viewer)
{
  PetscBool reduced;

  PetscFunctionBeginUser;
  PetscCall(ReducedIsAsked(chain->reduced, &reduced));
  PetscCall(OperatorsViewOmitted(chain->operators, viewer));
  if (reduced)
    PetscCall(ReducedView(chain->reduced, viewer));
  else
    PetscCall(DynamicsView(chain->dynamics, viewer));
  PetscFunctionReturn(0);
}

static PetscErrorCode ChainViewModes(Chain *chain, PetscViewer viewer)
{
  PetscFunctionBeginUser;
  PetscCall(StaticsViewWear(chain->statics, viewer));
  PetscCall(ModesView(chain->modes, viewer));
  PetscFunctionReturn(0);
}

static PetscErrorCode ChainViewFrf(Chain *chain, PetscViewer viewer)
{
  PetscFunctionBeginUser;
  PetscCall(StaticsViewWear(chain->statics, viewer));
  PetscCall(FrfView(chain->frf, viewer));
  PetscFunctionReturn(0);
}

/* A step of an analysis that is one call, and a view */
#define STEP(name, call)                                                                                               \
  static PetscErrorCode name(Chain *chain)                                                                             \
  {                                                                                                                    \
    PetscFunctionBeginUser;                                                                                            \
    PetscCall(call);                                                                                                   \
    PetscFunctionReturn(0);                                                                                            \
  }

#define SHOW(name, call)                                                                                               \
  static PetscErrorCode name(Chain *chain, PetscViewer viewer)                                                         \
  {                                                                                                                    \
    PetscFunctionBeginUser;                                                                                            \
    PetscCall(call);                                                                                                   \
    PetscFunctionReturn(0);                                                                                            \
  }

STEP(ChainWriteModes, ModesWrite(chain->modes, chain->results))
STEP(ChainForgetPencil, PencilDestroy(&chain->pencil)) /* A sweep makes pencils of its own */
STEP(ChainSolveSweep, SweepSolve(chain->sweep, chain->results))
STEP(ChainWriteSweep, SweepWrite(chain->sweep, chain->results))
STEP(ChainSolveSample, SampleSolve(chain->sample, chain->results))
STEP(ChainWriteSample, SampleWrite(chain->sample, chain->results))
STEP(ChainSolveQuiet, QuietSolve(chain->quiet, chain->results))
STEP(ChainWriteQuiet, QuietWrite(chain->quiet, chain->results))
STEP(ChainSolveDesign, DesignSolve(chain->design, chain->results))
STEP(ChainWriteDesign, DesignWrite(chain->design, chain->results))
STEP(ChainSolveStatics, StaticsSolveWorn(chain->statics, chain->p))
STEP(ChainWriteStatics, StaticsWrite(chain->statics, chain->results))
STEP(ChainJudgeReduced, ReducedJudgeVerified(chain->reduced))
STEP(ChainSolveFrf, FrfSolve(chain->frf))
STEP(ChainSolveMap, MapSolve(chain->map, chain->results))
STEP(ChainJudgeMap, MapJudge(chain->map))
STEP(ChainSolveSubstructure, SubstructureSolve(chain->substructure))
STEP(ChainWriteSubstructure, SubstructureWrite(chain->substructure, chain->results))
STEP(ChainSolveCycle, CycleSolve(chain->cycle, chain->results))
SHOW(ChainViewStatics, StaticsView(chain->statics, viewer))
SHOW(ChainViewSweep, SweepView(chain->sweep, viewer))
SHOW(ChainViewSample, SampleView(chain->sample, viewer))
SHOW(ChainViewQuiet, QuietView(chain->quiet, viewer))
SHOW(ChainViewDesign, DesignView(chain->design, viewer))
SHOW(ChainViewMap, MapView(chain->map, viewer))
SHOW(ChainViewSubstructure, SubstructureView(chain->substructure, viewer))
SHOW(ChainViewCycle, CycleView(chain->cycle, viewer))

/* The bits of `does` hold in every such run; what depends on options add() and scope.c add. Those in time write as they
   go, and look for checkpoints before they begin */
#define LINEAR (USES_DAMPING | USES_SPIN)
const AnalysisRow chain_analyses[N_ANALYSES] = {
  [ANALYSIS_MODES]  = {SQUEAL_MODES, SHOWN_MODES, ChainGivePencil, ChainSolveModes, ChainWriteModes, ChainViewModes,
                       .uses = LINEAR | USES_LAWS},
  [ANALYSIS_SWEEP]  = {SQUEAL_SWEEP, SHOWN_SWEEP, ChainForgetPencil, ChainSolveSweep, ChainWriteSweep, ChainViewSweep,
                       .add = ChainAddSweep, .uses = LINEAR | USES_LAWS},
  [ANALYSIS_STATIC] = {SQUEAL_STATICS, SHOWN_STATICS, NULL, ChainSolveStatics, ChainWriteStatics, ChainViewStatics,
                       .does = RUN_EQUILIBRIUM, .uses = USES_LOADS | USES_LAWS},
  [ANALYSIS_TRANSIENT] = {SQUEAL_DYNAMICS, SHOWN_DYNAMICS, NULL, ChainIntegrate, NULL, ChainViewTransient,
                          ChainJudgeReduced, .does = RUN_HISTORY,
                          .uses = USES_LOADS | USES_PLACES | USES_DAMPING | USES_BRANCHES},
  [ANALYSIS_FRF]       = {SQUEAL_FRF, SHOWN_FRF, ChainGivePencil, ChainSolveFrf, ChainWriteFrf, ChainViewFrf,
                          .does = RUN_EPS | RUN_PEP, .uses = LINEAR | USES_PLACES | USES_LAWS},
  [ANALYSIS_MAP]       = {SQUEAL_DYNAMICS, SHOWN_MAP, NULL, ChainSolveMap, NULL, ChainViewMap, ChainJudgeMap,
                          .uses = USES_LOADS | USES_DAMPING},
  [ANALYSIS_CYCLE]  = {SQUEAL_DYNAMICS, SHOWN_CYCLE, NULL, ChainSolveCycle, NULL, ChainViewCycle, .add = ChainAddCycle,
                       .uses = USES_LOADS | USES_PLACES | USES_DAMPING},
  [ANALYSIS_SAMPLE] = {SQUEAL_SWEEP, SHOWN_SAMPLE, ChainForgetPencil, ChainSolveSample, ChainWriteSample,
                       ChainViewSample, .add = ChainAddSample, .uses = LINEAR},
  [ANALYSIS_SUPERELEMENT] = {SQUEAL_MODES, SHOWN_SUPERELEMENT, NULL, ChainSolveSubstructure, ChainWriteSubstructure,
                             ChainViewSubstructure, .does = RUN_FACTORS | RUN_EPS, .uses = USES_DAMPING},
  [ANALYSIS_QUIET]  = {SQUEAL_SWEEP, SHOWN_QUIET, ChainForgetPencil, ChainSolveQuiet, ChainWriteQuiet, ChainViewQuiet,
                       .add = ChainAddQuiet, .uses = LINEAR},
  [ANALYSIS_DESIGN] = {SQUEAL_SWEEP, SHOWN_DESIGN, ChainForgetPencil, ChainSolveDesign, ChainWriteDesign,
                       ChainViewDesign, .add = ChainAddDesign, .uses = LINEAR},
  [ANALYSIS_CHECK]  = {SQUEAL_MODEL, N_SHOWN, NULL, ChainShowScene, ChainWriteScene, .uses = USES_ALL},
};

PetscErrorCode ChainRun(Chain *chain)
{
  const AnalysisRow *row = &chain_analyses[chain->analysis];

  PetscFunctionBeginUser;
  if (row->write) PetscCall(ResultsBegin(chain->results, PETSC_FALSE));
  if (row->prepare) PetscCall(row->prepare(chain));
  PetscCall(SquealStageBegin(row->stage));
  PetscCall(row->solve(chain));
  PetscCall(SquealStageEnd(row->stage));
  if (row->shown < N_SHOWN) PetscCall(ChainShow(chain, row->shown, PETSC_TRUE));
  if (row->write) {
    PetscCall(SquealStageBegin(SQUEAL_RESULTS));
    PetscCall(row->write(chain));
    PetscCall(SquealStageEnd(SQUEAL_RESULTS));
  }
  if (row->judge) PetscCall(row->judge(chain));
  PetscFunctionReturn(0);
}
