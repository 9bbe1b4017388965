/* squeal: friction-induced vibration of bodies in sliding contact. The chain of a run, from options to results. */
#include "scope.h"
#include "solver/shiftinvert.h"

typedef enum { ANALYSIS_MODES, ANALYSIS_SWEEP, ANALYSIS_STATIC, ANALYSIS_TRANSIENT, N_ANALYSES } Analysis;

static const char *const analyses[N_ANALYSES] = {"modes", "sweep", "static", "transient"};

/* What shows itself, on stdout or where its own option says */
typedef enum {
  SHOWN_MODEL,
  SHOWN_CONTACT,
  SHOWN_OPERATORS,
  SHOWN_STATICS,
  SHOWN_MODES,
  SHOWN_SWEEP,
  SHOWN_DYNAMICS,
  N_SHOWN
} Shown;

static const struct {
  const char *option, *help;
  unsigned    in; /* bits of the analyses that have something to show */
} shown[N_SHOWN] = {
  [SHOWN_MODEL]     = {"-model_view",     "show mesh, parts, supports, springs and loads",           15                     },
  [SHOWN_CONTACT]   = {"-contact_view",   "show interfaces and their pairs",                         7                      },
  [SHOWN_OPERATORS] = {"-operators_view", "show the pencil of modes and sweeps, and its parameters", 3                      },
  [SHOWN_STATICS]   = {"-statics_view",   "show the equilibrium",                                    1 << ANALYSIS_STATIC   },
  [SHOWN_MODES]     = {"-modes_view",     "show the modes found",                                    1 << ANALYSIS_MODES    },
  [SHOWN_SWEEP]     = {"-sweep_view",     "show what a sweep found",                                 1 << ANALYSIS_SWEEP    },
  [SHOWN_DYNAMICS]  = {"-dynamics_view",  "show bodies, step and balances of a run in time",         1 << ANALYSIS_TRANSIENT},
};

/* The chain of a run: options, model, contact, operators, statics, pencil, modes, sweep, or dynamics; and results */
typedef struct {
  Model         model; /* NULL for matrices without a mesh */
  Contact       contact;
  Operators     operators;
  PetscReal    *p; /* values of the parameters: those of the scene, and what statics identify */
  Statics       statics;
  Pencil        pencil; /* at p, where modes, a file or a view ask for it */
  Modes         modes;
  Sweep         sweep;
  Dynamics      dynamics;
  Results       results;
  Analysis      analysis;
  OptionsClaims claims; /* who read what stands on the command line */
  PetscBool     view;
  PetscViewer   viewer[N_SHOWN]; /* of what the options below ask for and is not shown yet */
} Chain;

static PetscErrorCode ChainCreate(MPI_Comm comm, Chain *chain)
{
  PetscBool has_matrices;
  PetscInt  analysis = ANALYSIS_MODES;

  PetscFunctionBeginUser;
  PetscCall(OptionsClaimsCreate(&chain->claims));
  PetscCall(SquealSetFromOptions(comm));
  PetscOptionsBegin(comm, NULL, "Analysis", NULL);
  PetscCall(
    PetscOptionsEList("-analysis", "what to compute", "squeal.h", analyses, N_ANALYSES, analyses[0], &analysis, NULL));
  PetscCall(OptionsGetBool(PetscOptionsObject, "-squeal_view", "print choices and why, and the time of each stage",
                           &chain->view));
  PetscOptionsEnd();
  chain->analysis = (Analysis)analysis;
  for (int i = 0; i < N_SHOWN; i++)
    PetscCall(OptionsGetViewer(comm, shown[i].option, shown[i].help, &chain->viewer[i]));
  PetscCall(OperatorsCreate(comm, &chain->operators));
  PetscCall(OperatorsSetFromOptions(chain->operators));
  PetscCall(OperatorsHaveMatrices(chain->operators, &has_matrices));
  if (!has_matrices) {
    PetscCall(ModelCreate(comm, &chain->model));
    PetscCall(ModelSetFromOptions(chain->model));
    PetscCall(ContactCreate(chain->model, &chain->contact));
    PetscCall(ContactSetFromOptions(chain->contact));
    PetscCall(OperatorsSetModel(chain->operators, chain->model, chain->contact));
  }
  PetscCall(ResultsCreate(comm, &chain->results));
  PetscCall(ResultsSetFromOptions(chain->results));
  PetscCall(OptionsClaim(chain->claims, READER_ANY));
  PetscFunctionReturn(0);
}

/* What not every analysis needs; each reader claims what is read in its turn */
static PetscErrorCode ChainCreateAnalyses(MPI_Comm comm, Chain *chain)
{
  PetscFunctionBeginUser;
  PetscCall(DynamicsCreate(comm, &chain->dynamics));
  if (chain->model) PetscCall(DynamicsSetModel(chain->dynamics, chain->model, chain->contact));
  PetscCall(DynamicsSetFromOptions(chain->dynamics));
  PetscCall(OptionsClaim(chain->claims, READER_DYNAMICS));
  PetscCall(StaticsCreate(comm, &chain->statics));
  PetscCall(StaticsSetFromOptions(chain->statics));
  PetscCall(OptionsClaim(chain->claims, READER_STATICS));
  PetscCall(ModesCreate(comm, &chain->modes));
  PetscCall(ModesSetFromOptions(chain->modes));
  PetscCall(SolverReadEigenOptions(comm));
  PetscCall(OptionsClaim(chain->claims, READER_MODES));
  PetscCall(SolverReadFactorOptions(comm));
  PetscCall(OptionsClaim(chain->claims, READER_FACTOR));
  PetscCall(SweepCreate(comm, &chain->sweep));
  PetscCall(SweepSetFromOptions(chain->sweep));
  PetscCall(OptionsClaim(chain->claims, READER_SWEEP));
  PetscFunctionReturn(0);
}

static PetscErrorCode ChainDestroy(Chain *chain)
{
  PetscFunctionBeginUser;
  for (int i = 0; i < N_SHOWN; i++) PetscCall(PetscViewerDestroy(&chain->viewer[i]));
  PetscCall(OptionsClaimsDestroy(&chain->claims));
  PetscCall(ResultsDestroy(&chain->results));
  PetscCall(DynamicsDestroy(&chain->dynamics));
  PetscCall(SweepDestroy(&chain->sweep));
  PetscCall(ModesDestroy(&chain->modes));
  PetscCall(PencilDestroy(&chain->pencil));
  PetscCall(StaticsDestroy(&chain->statics));
  PetscCall(PetscFree(chain->p));
  PetscCall(OperatorsDestroy(&chain->operators));
  PetscCall(ContactDestroy(&chain->contact));
  PetscCall(ModelDestroy(&chain->model));
  PetscFunctionReturn(0);
}

/* Raises an error for what stands on the command line and has no effect in this analysis */
static PetscErrorCode ChainCheckOptions(MPI_Comm comm, const Chain *chain)
{
  const Analysis analysis = chain->analysis;
  const Scope    scope    = {.analysis  = analyses[analysis],
                             .sweep     = analysis == ANALYSIS_SWEEP,
                             .transient = analysis == ANALYSIS_TRANSIENT,
                             .modes     = analysis <= ANALYSIS_SWEEP,
                             .model     = chain->model,
                             .contact   = chain->contact,
                             .linear    = chain->modes,
                             .dynamics  = chain->dynamics};

  PetscFunctionBeginUser;
  PetscCall(ScopeCheck(comm, &scope, chain->claims));
  for (int i = 0; i < N_SHOWN; i++)
    if (chain->viewer[i] && !(shown[i].in >> analysis & 1))
      PetscCall(OptionsRefuse(comm, shown[i].option, "this analysis has nothing to show there"));
  PetscFunctionReturn(0);
}

/* Reads all options on a chain of its own, to list the valid names */
static PetscErrorCode ReadAgain(MPI_Comm comm, void *ctx)
{
  Chain chain = {0};

  PetscFunctionBeginUser;
  (void)ctx;
  PetscCall(ChainCreate(comm, &chain));
  PetscCall(ChainCreateAnalyses(comm, &chain));
  PetscCall(ChainDestroy(&chain));
  PetscFunctionReturn(0);
}

static PetscErrorCode ChainSetUp(Chain *chain)
{
  const PetscBool transient = chain->analysis == ANALYSIS_TRANSIENT ? PETSC_TRUE : PETSC_FALSE;
  PetscBool       pairs     = PETSC_TRUE;

  PetscFunctionBeginUser;
  if (transient) PetscCall(DynamicsNeedsPairs(chain->dynamics, &pairs));
  if (chain->model) {
    if (transient) PetscCall(ModelKeepSlabs(chain->model));
    if (pairs) PetscCall(ModelHoldMotions(chain->model)); /* in time they move */
    PetscCall(SquealStageBegin(SQUEAL_MODEL));
    PetscCall(ModelSetUp(chain->model));
    PetscCall(SquealStageEnd(SQUEAL_MODEL));
    PetscCall(SquealStageBegin(SQUEAL_CONTACT));
    if (pairs) PetscCall(ContactSetUp(chain->contact));
    PetscCall(SquealStageEnd(SQUEAL_CONTACT));
  }
  PetscCall(SquealStageBegin(SQUEAL_OPERATORS));
  PetscCall(OperatorsSetUp(chain->operators));
  PetscCall(SquealStageEnd(SQUEAL_OPERATORS));
  PetscFunctionReturn(0);
}

/* The pencil at p: about the sliding state there, or with all pairs closed */
static PetscErrorCode ChainLinearise(Chain *chain)
{
  SlidingState state;
  PetscBool    is_static;

  PetscFunctionBeginUser;
  if (chain->pencil) PetscFunctionReturn(0);
  PetscCall(ModesGetContact(chain->modes, &is_static));
  if (is_static) {
    PetscCall(SquealStageBegin(SQUEAL_STATICS));
    PetscCall(StaticsSolveSliding(chain->statics, chain->p, &state));
    PetscCall(StaticsRelease(chain->statics));
    PetscCall(SquealStageEnd(SQUEAL_STATICS));
  }
  PetscCall(SquealStageBegin(SQUEAL_OPERATORS));
  PetscCall(OperatorsLinearise(chain->operators, is_static ? &state : NULL, &chain->pencil));
  if (!is_static) PetscCall(PencilSetParameters(chain->pencil, chain->p));
  PetscCall(SquealStageEnd(SQUEAL_OPERATORS));
  if (is_static) PetscCall(SlidingStateDestroy(&state));
  PetscFunctionReturn(0);
}

static PetscErrorCode ShownView(Chain *chain, Shown what, PetscViewer viewer)
{
  PetscFunctionBeginUser;
  if (what == SHOWN_MODEL) PetscCall(ModelView(chain->model, viewer));
  if (what == SHOWN_CONTACT) PetscCall(ContactView(chain->contact, viewer));
  if (what == SHOWN_OPERATORS) PetscCall(ChainLinearise(chain));
  if (what == SHOWN_OPERATORS) PetscCall(PencilView(chain->pencil, viewer));
  if (what == SHOWN_STATICS) PetscCall(StaticsView(chain->statics, viewer));
  if (what == SHOWN_MODES) PetscCall(ModesView(chain->modes, viewer));
  if (what == SHOWN_SWEEP) PetscCall(SweepView(chain->sweep, viewer));
  if (what == SHOWN_DYNAMICS) PetscCall(DynamicsView(chain->dynamics, viewer));
  PetscFunctionReturn(0);
}

/* Shows it on stdout where wanted, and where its option says */
static PetscErrorCode ChainShow(Chain *chain, Shown what, PetscBool wanted)
{
  const PetscViewer out = PETSC_VIEWER_STDOUT_(PETSC_COMM_WORLD);

  PetscFunctionBeginUser;
  if (wanted) PetscCall(ShownView(chain, what, out));
  if (chain->viewer[what] && !(wanted && chain->viewer[what] == out))
    PetscCall(ShownView(chain, what, chain->viewer[what]));
  PetscCall(PetscViewerDestroy(&chain->viewer[what]));
  PetscFunctionReturn(0);
}

/* What there is before the analysis */
static PetscErrorCode ChainView(Chain *chain)
{
  PetscFunctionBeginUser;
  if (chain->model) PetscCall(ChainShow(chain, SHOWN_MODEL, chain->view));
  if (chain->contact && chain->analysis != ANALYSIS_TRANSIENT) PetscCall(ChainShow(chain, SHOWN_CONTACT, chain->view));
  if (chain->analysis == ANALYSIS_MODES || chain->analysis == ANALYSIS_SWEEP)
    PetscCall(ChainShow(chain, SHOWN_OPERATORS, chain->view));
  PetscFunctionReturn(0);
}

/* What rooms need of each other, the contact stiffness where pressing is to tell it, and the matrices for a file */
static PetscErrorCode ChainConnect(Chain *chain, PetscViewer viewer)
{
  const char *folder;
  PetscBool   is_static;

  PetscFunctionBeginUser;
  PetscCall(StaticsSetOperators(chain->statics, chain->operators));
  PetscCall(DynamicsSetOperators(chain->dynamics, chain->operators, chain->statics));
  PetscCall(ModesGetContact(chain->modes, &is_static));
  PetscCall(StaticsCheckUse(chain->statics, is_static && chain->analysis != ANALYSIS_STATIC));
  PetscCall(OperatorsCreatePoint(chain->operators, &chain->p));
  PetscCall(StaticsIdentifyAll(chain->statics, chain->p, viewer));
  PetscCall(SweepSetOperators(chain->sweep, chain->operators, chain->p));
  PetscCall(SweepSetModes(chain->sweep, chain->modes));
  if (is_static) PetscCall(SweepSetStatics(chain->sweep, chain->statics));
  PetscCall(OperatorsGetSave(chain->operators, &folder));
  if (!folder[0]) PetscFunctionReturn(0);
  PetscCall(ChainLinearise(chain));
  PetscCall(PencilSave(chain->pencil));
  PetscFunctionReturn(0);
}

/* Computes, shows and writes what the analysis is for */
static PetscErrorCode ChainRun(Chain *chain)
{
  static const struct {
    SquealStage stage;
    Shown       shown;
  } run[N_ANALYSES] = {
    [ANALYSIS_MODES]     = {SQUEAL_MODES,    SHOWN_MODES   },
    [ANALYSIS_SWEEP]     = {SQUEAL_SWEEP,    SHOWN_SWEEP   },
    [ANALYSIS_STATIC]    = {SQUEAL_STATICS,  SHOWN_STATICS },
    [ANALYSIS_TRANSIENT] = {SQUEAL_DYNAMICS, SHOWN_DYNAMICS}
  };
  const Analysis analysis = chain->analysis;

  PetscFunctionBeginUser;
  if (analysis == ANALYSIS_MODES) {
    PetscCall(ChainLinearise(chain));
    PetscCall(ModesSetPencil(chain->modes, chain->pencil));
  }
  if (analysis == ANALYSIS_SWEEP) PetscCall(PencilDestroy(&chain->pencil)); /* a sweep makes its own */
  PetscCall(SquealStageBegin(run[analysis].stage));
  if (analysis == ANALYSIS_MODES) PetscCall(ModesSolve(chain->modes));
  if (analysis == ANALYSIS_SWEEP) PetscCall(SweepSolve(chain->sweep, chain->results));
  if (analysis == ANALYSIS_STATIC) PetscCall(StaticsSolve(chain->statics, chain->p));
  if (analysis == ANALYSIS_TRANSIENT) PetscCall(DynamicsSolve(chain->dynamics, chain->results));
  PetscCall(SquealStageEnd(run[analysis].stage));
  PetscCall(ChainShow(chain, run[analysis].shown, PETSC_TRUE));
  if (analysis == ANALYSIS_TRANSIENT) PetscFunctionReturn(0); /* which writes as it goes */
  PetscCall(SquealStageBegin(SQUEAL_RESULTS));
  if (analysis == ANALYSIS_MODES) PetscCall(ModesWrite(chain->modes, chain->results));
  if (analysis == ANALYSIS_SWEEP) PetscCall(SweepWrite(chain->sweep, chain->results));
  if (analysis == ANALYSIS_STATIC) PetscCall(StaticsWrite(chain->statics, chain->results));
  PetscCall(SquealStageEnd(SQUEAL_RESULTS));
  PetscFunctionReturn(0);
}

static PetscErrorCode Run(MPI_Comm comm)
{
  Chain       chain  = {0};
  PetscViewer viewer = PETSC_VIEWER_STDOUT_(comm);

  PetscFunctionBeginUser;
  PetscCall(ChainCreate(comm, &chain));
  PetscCall(ChainCreateAnalyses(comm, &chain));
  PetscCall(OptionsCheckUnknown(comm, ReadAgain, NULL));
  PetscCall(OptionsCheckValues(comm));
  PetscCall(ChainCheckOptions(comm, &chain));
  if (chain.model) PetscCall(ModelCheckGiven(chain.model));
  PetscCall(ResultsKeepScene(chain.results, ReadAgain, NULL));
  PetscCall(ResultsOpenDirectory(chain.results));
  PetscCall(ChainSetUp(&chain));
  PetscCall(ChainConnect(&chain, viewer));
  PetscCall(ChainView(&chain));
  PetscCall(ChainRun(&chain));
  PetscCall(ResultsFinish(chain.results));
  if (chain.view) PetscCall(SquealViewStages(comm, viewer));
  PetscCall(OptionsWarnUnused(comm));
  PetscCall(ChainDestroy(&chain));
  PetscFunctionReturn(0);
}

/* What the command line is for: help, nothing, or a run */
static PetscErrorCode Answer(MPI_Comm comm, PetscBool no_arguments)
{
  PetscBool help;

  PetscFunctionBeginUser;
  PetscCall(SquealViewOptions(comm, ReadAgain, NULL, &help));
  if (help) PetscFunctionReturn(0);
  if (no_arguments) PetscCall(SquealViewUsage(comm));
  PetscCall(Run(comm));
  PetscFunctionReturn(0);
}

int main(int argc, char **argv)
{
  const PetscBool no_arguments = argc == 1;
  PetscErrorCode  error        = SquealInitialize(&argc, &argv, NULL);

  if (!error) error = Answer(PETSC_COMM_WORLD, no_arguments);
  return SquealFinalize(error);
}
