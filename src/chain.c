/* The chain of a run, from options to what an analysis begins with: the rooms in their order. No physics */
#include "chain.h"
#include "solver/factor/shiftinvert.h"
#include <squeal/quantity.h>

static const char *const analyses[] = {"modes", "sweep", "static", "transient", "frf", "map", "cycle", NULL};

static const Quantity rows[] = {
  {"-analysis", "what to compute", NULL, QUANTITY_WORD, QUANTITY_AT(Chain, analysis), .words = analyses},
  {"-squeal_view", "print choices and why, and the time of each stage", NULL, QUANTITY_BOOL, QUANTITY_AT(Chain, view)},
};
static const QuantityTable chain_quantities = {"Analysis", "squeal.h", PETSC_STATIC_ARRAY_LENGTH(rows), rows};

PetscBool ChainIsInTime(const Chain *chain)
{
  const Analysis a = chain->analysis;

  return a == ANALYSIS_TRANSIENT || a == ANALYSIS_MAP || a == ANALYSIS_CYCLE ? PETSC_TRUE : PETSC_FALSE;
}

/* What every analysis needs */
static PetscErrorCode ChainCreateScene(MPI_Comm comm, Chain *chain)
{
  PetscBool has_matrices;

  PetscFunctionBeginUser;
  PetscCall(OptionsClaimsCreate(&chain->claims));
  PetscCall(SquealSetFromOptions(comm));
  PetscCall(QuantitiesRead(comm, &chain_quantities, chain));
  ShiftInvertShow(chain->view);
  PetscCall(ChainGetViewers(comm, chain));
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
  PetscCall(ReducedCreate(comm, &chain->reduced));
  PetscCall(ReducedSetFromOptions(chain->reduced));
  PetscCall(OptionsClaim(chain->claims, READER_DYNAMICS));
  PetscCall(MapCreate(comm, &chain->map));
  PetscCall(MapSetFromOptions(chain->map));
  PetscCall(OptionsClaim(chain->claims, READER_MAP));
  PetscCall(CycleCreate(comm, &chain->cycle));
  PetscCall(CycleSetFromOptions(chain->cycle));
  PetscCall(OptionsClaim(chain->claims, READER_CYCLE));
  PetscCall(StaticsCreate(comm, &chain->statics));
  PetscCall(StaticsSetFromOptions(chain->statics));
  PetscCall(OptionsClaim(chain->claims, READER_STATICS));
  PetscCall(ModesCreate(comm, &chain->modes));
  PetscCall(ModesSetFromOptions(chain->modes));
  PetscCall(SolverReadEigenOptions(comm));
  PetscCall(OptionsClaim(chain->claims, READER_MODES));
  PetscCall(SolverReadFactorOptions(comm));
  PetscCall(OptionsClaim(chain->claims, READER_FACTOR));
  PetscCall(SolverReadIterativeOptions(comm));
  PetscCall(OptionsClaim(chain->claims, READER_ITERATIVE));
  PetscCall(SweepCreate(comm, &chain->sweep));
  PetscCall(SweepSetFromOptions(chain->sweep));
  PetscCall(OptionsClaim(chain->claims, READER_SWEEP));
  PetscCall(FrfCreate(comm, &chain->frf));
  PetscCall(FrfSetFromOptions(chain->frf));
  PetscCall(OptionsClaim(chain->claims, READER_FRF));
  PetscFunctionReturn(0);
}

PetscErrorCode ChainCreate(MPI_Comm comm, Chain *chain)
{
  PetscFunctionBeginUser;
  PetscCall(ChainCreateScene(comm, chain));
  PetscCall(ChainCreateAnalyses(comm, chain));
  PetscFunctionReturn(0);
}

PetscErrorCode ChainDestroy(Chain *chain)
{
  PetscFunctionBeginUser;
  for (int i = 0; i < N_SHOWN; i++) PetscCall(PetscViewerDestroy(&chain->viewer[i]));
  PetscCall(OptionsClaimsDestroy(&chain->claims));
  PetscCall(ResultsDestroy(&chain->results));
  PetscCall(MapDestroy(&chain->map));
  PetscCall(CycleDestroy(&chain->cycle));
  PetscCall(ReducedDestroy(&chain->reduced));
  PetscCall(DynamicsDestroy(&chain->dynamics));
  PetscCall(FrfDestroy(&chain->frf));
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

Scope ChainGetScope(const Chain *chain)
{
  const Analysis analysis = chain->analysis;

  return (Scope){.analysis  = analyses[analysis],
                 .sweep     = analysis == ANALYSIS_SWEEP,
                 .transient = ChainIsInTime(chain),
                 .map       = analysis == ANALYSIS_MAP,
                 .cycle     = analysis == ANALYSIS_CYCLE,
                 .frf       = analysis == ANALYSIS_FRF,
                 .modes     = analysis <= ANALYSIS_SWEEP || analysis == ANALYSIS_FRF,
                 .model     = chain->model,
                 .contact   = chain->contact,
                 .linear    = chain->modes,
                 .operators = chain->operators,
                 .varied    = chain->sweep,
                 .dynamics  = chain->dynamics,
                 .reduced   = chain->reduced};
}

PetscErrorCode ChainCheckOptions(MPI_Comm comm, const Chain *chain)
{
  const Scope scope = ChainGetScope(chain);

  PetscFunctionBeginUser;
  PetscCall(ScopeCheck(comm, &scope, chain->claims));
  PetscCall(ChainCheckViewers(comm, chain));
  PetscFunctionReturn(0);
}

/* Whether a run in time reads matrices: for a sliding state, for filters of modes, for files, to press */
static PetscErrorCode ChainNeedsMatrices(const Chain *chain, PetscBool pairs, PetscBool *needs)
{
  const ContactInterface *interfaces;
  const char             *folder;
  PetscInt                n;

  PetscFunctionBeginUser;
  PetscCall(OperatorsGetSave(chain->operators, &folder));
  PetscCall(ContactGetInterfaces(chain->contact, &n, &interfaces));
  *needs = pairs || folder[0] ? PETSC_TRUE : PETSC_FALSE;
  for (PetscInt i = 0; i < n; i++)
    if (interfaces[i].identify) *needs = PETSC_TRUE;
  PetscFunctionReturn(0);
}

/* Modes of the mesh that a reduced transient is compared with have what friction damps in time */
static PetscErrorCode ChainDampFriction(Chain *chain)
{
  PetscBool compared;

  PetscFunctionBeginUser;
  if (!chain->contact || chain->analysis != ANALYSIS_TRANSIENT) PetscFunctionReturn(0);
  PetscCall(ReducedIsCompared(chain->reduced, &compared));
  if (compared) PetscCall(ModesHaveBand(chain->modes, &compared));
  if (compared) PetscCall(ContactDampFriction(chain->contact));
  PetscFunctionReturn(0);
}

/* Model, pairs and terms */
static PetscErrorCode ChainAssemble(Chain *chain)
{
  const PetscBool transient = ChainIsInTime(chain);
  PetscBool       pairs = PETSC_TRUE, reduced = PETSC_FALSE, matrices = PETSC_TRUE;

  PetscFunctionBeginUser;
  if (transient) PetscCall(DynamicsNeedsPairs(chain->dynamics, &pairs));
  if (transient) PetscCall(ReducedIsAsked(chain->reduced, &reduced));
  if (reduced) PetscCall(OperatorsLump(chain->operators));
  if (reduced) PetscCall(ChainDampFriction(chain));
  if (reduced) pairs = PETSC_TRUE;
  if (chain->model) {
    if (transient && !reduced) PetscCall(ModelKeepSlabs(chain->model));
    if (pairs) PetscCall(ModelHoldMotions(chain->model)); /* in time they move */
    PetscCall(SquealStageBegin(SQUEAL_MODEL));
    PetscCall(ModelSetUp(chain->model));
    PetscCall(ChainSayUnits(chain));
    PetscCall(SquealStageEnd(SQUEAL_MODEL));
    PetscCall(SquealStageBegin(SQUEAL_CONTACT));
    if (pairs)
      PetscCall(ContactSetUp(chain->contact));
    else
      PetscCall(ContactSetUpTies(chain->contact));
    PetscCall(SquealStageEnd(SQUEAL_CONTACT));
    PetscCall(ChainNeedsMatrices(chain, pairs, &matrices));
    if (!matrices) PetscCall(OperatorsOmitMatrices(chain->operators));
  }
  PetscCall(SquealStageBegin(SQUEAL_OPERATORS));
  PetscCall(OperatorsSetUp(chain->operators));
  PetscCall(SquealStageEnd(SQUEAL_OPERATORS));
  PetscFunctionReturn(0);
}

PetscErrorCode ChainLinearise(Chain *chain)
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

/* What rooms need of each other, the contact stiffness where pressing is to tell it, and the matrices for a file */
static PetscErrorCode ChainConnect(Chain *chain, PetscViewer viewer)
{
  const char *folder;
  PetscBool   sliding;

  PetscFunctionBeginUser;
  PetscCall(StaticsSetOperators(chain->statics, chain->operators));
  PetscCall(DynamicsSetOperators(chain->dynamics, chain->operators, chain->statics));
  PetscCall(ReducedSetRooms(chain->reduced, chain->dynamics, chain->modes));
  PetscCall(OperatorsCreatePoint(chain->operators, NULL, &chain->p));
  PetscCall(StaticsIdentifyAll(chain->statics, chain->p, viewer));
  PetscCall(SweepSetOperators(chain->sweep, chain->operators, chain->p));
  PetscCall(SweepSetModes(chain->sweep, chain->modes));
  PetscCall(ModesGetContact(chain->modes, &sliding));
  if (sliding) PetscCall(SweepSetStatics(chain->sweep, chain->statics));
  PetscCall(MapSetRooms(chain->map, chain->reduced, chain->operators, chain->p));
  PetscCall(CycleSetRooms(chain->cycle, chain->reduced, chain->operators, chain->p));
  PetscCall(FrfSetOperators(chain->frf, chain->operators));
  PetscCall(FrfSetModes(chain->frf, chain->modes));
  PetscCall(FrfSetResults(chain->frf, chain->results, sliding ? chain->statics : NULL));
  if (chain->analysis == ANALYSIS_FRF) PetscCall(FrfSetUp(chain->frf));
  PetscCall(OperatorsGetSave(chain->operators, &folder));
  if (!folder[0]) PetscFunctionReturn(0);
  PetscCall(ChainLinearise(chain));
  PetscCall(PencilSave(chain->pencil));
  PetscCall(StaticsSaveLoad(chain->statics, chain->p, chain->pencil));
  PetscFunctionReturn(0);
}

PetscErrorCode ChainSetUp(Chain *chain, PetscViewer viewer)
{
  PetscBool terms;

  PetscFunctionBeginUser;
  PetscCall(ChainAssemble(chain));
  PetscCall(ChainConnect(chain, viewer));
  PetscCall(PetscOptionsHasName(NULL, NULL, "-terms", &terms));
  if (chain->model) PetscCall(ContactCheckBodies(chain->contact, terms));
  PetscFunctionReturn(0);
}
