/* The chain of a run, from options to what an analysis begins with: the rooms in their order. No physics */
#include "chain.h"
#include "base/algebra/vec3.h"
#include "solver/factor/shiftinvert.h"
#include <squeal/quantity.h>

static const Quantity rows[] = {
  {"-analysis", "what to compute", NULL, QUANTITY_WORD, QUANTITY_AT(Chain, analysis), .words = AnalysisNames},
  {"-squeal_view", "print choices and why, and the time of each stage", NULL, QUANTITY_BOOL, QUANTITY_AT(Chain, view)},
};
static const QuantityTable chain_quantities = {"Analysis", "squeal.h", PETSC_STATIC_ARRAY_LENGTH(rows), rows, .in = 0};

static const char *ViewIdle(const void *chain, const QuantityRun *run)
{
  (void)chain;
  return run->does & RUN_BODIES ? NULL : "not used by matrices without a mesh; give -operators_view";
}

#define VIEW(shown, name, help, bits)                                                                                  \
  [shown] = {name, help, NULL, QUANTITY_VIEWER, QUANTITY_AT(Chain, viewer[shown]), .in = (bits), .unread = NOTHING}
#define MESH_VIEW(shown, name, help, bits)                                                                             \
  [shown] = {name,                                                                                                     \
             help,                                                                                                     \
             NULL,                                                                                                     \
             QUANTITY_VIEWER,                                                                                          \
             QUANTITY_AT(Chain, viewer[shown]),                                                                        \
             .in     = (bits),                                                                                         \
             .unread = NOTHING,                                                                                        \
             .idle   = ViewIdle}
#define NOTHING ": it has nothing to show there"

static const Quantity views[N_SHOWN] = {
  MESH_VIEW(SHOWN_MODEL, "-model_view", "show mesh, parts, supports, springs and loads", 0),
  MESH_VIEW(SHOWN_CONTACT, "-contact_view", "show interfaces and their pairs", RUN_LINEAR | RUN_STATIC | RUN_CHECK),
  VIEW(SHOWN_OPERATORS, "-operators_view", "show the pencil of modes and sweeps, and its parameters",
       RUN_LINEAR | RUN_CHECK),
  VIEW(SHOWN_STATICS, "-static_view", "show the equilibrium", RUN_STATIC),
  VIEW(SHOWN_MODES, "-modes_view", "show the modes found", RUN_MODES | RUN_FRF),
  VIEW(SHOWN_SWEEP, "-sweep_view", "show what a sweep found", RUN_SWEEP),
  VIEW(SHOWN_FRF, "-frf_view", "show the frequency response and its peaks", RUN_FRF),
  VIEW(SHOWN_DYNAMICS, "-dynamics_view", "show bodies, step and balances of a run in time", RUN_TRANSIENT),
  VIEW(SHOWN_MAP, "-map_view", "show regimes and cost of a map", RUN_MAP),
  VIEW(SHOWN_SAMPLE, "-sample_view", "show what samples tell", RUN_SAMPLE),
  VIEW(SHOWN_SUPERELEMENT, "-superelement_view", "show sizes and errors of the superelement that is made",
       RUN_SUPERELEMENT),
  VIEW(SHOWN_QUIET, "-quiet_view", "show the quiet box and the nearest dangerous point", RUN_QUIET),
  VIEW(SHOWN_DESIGN, "-design_view", "show the design that was found", RUN_DESIGN),
  VIEW(SHOWN_CYCLE, "-cycle_view", "show cycles, their stability and errors", RUN_CYCLE),
};
const QuantityTable chain_views = {"What is shown, and where: ascii, or ascii:FILE, or ascii:FILE::append", "squeal.h",
                                   N_SHOWN, views, .in = 0};

/* Whether the analysis is a run in time, or is made of such runs */
static PetscBool ChainIsInTime(const Chain *chain)
{
  return 1U << chain->analysis & RUN_IN_TIME ? PETSC_TRUE : PETSC_FALSE;
}

/* What every analysis needs */
static PetscErrorCode ChainCreateScene(MPI_Comm comm, Chain *chain)
{
  PetscBool has_matrices;

  PetscFunctionBeginUser;
  PetscCall(SquealSetFromOptions(comm));
  PetscCall(QuantitiesRead(comm, &chain_quantities, chain));
  ShiftInvertShow(chain->view);
  PetscCall(QuantitiesRead(comm, &chain_views, chain));
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
  PetscCall(SoundCreate(comm, chain->model, chain->contact, &chain->sound));
  PetscCall(SoundSetFromOptions(chain->sound));
  PetscCall(ResultsCreate(comm, &chain->results));
  PetscCall(ResultsSetFromOptions(chain->results));
  PetscFunctionReturn(0);
}

/* Whether there are contacts, and loads, gravity, motions or interferences that close or open them */
static PetscErrorCode ChainIsLoaded(const Chain *chain, PetscInt n, const ContactInterface interfaces[],
                                    PetscBool *loaded)
{
  const ModelScene *scene;

  PetscFunctionBeginUser;
  PetscCall(ModelGetScene(chain->model, &scene));
  *loaded =
    scene->n_loads || scene->n_motions || Vec3Dot(scene->gravity, scene->gravity) > 0 ? PETSC_TRUE : PETSC_FALSE;
  if (!n) *loaded = PETSC_FALSE;
  for (PetscInt i = 0; i < n; i++)
    if (interfaces[i].interference > 0) *loaded = PETSC_TRUE;
  PetscFunctionReturn(0);
}

/* What -modes_contact auto takes. A -contact_force is that of all pairs closed, of all contacts: loads are not used. */
static PetscErrorCode ChainChooseContact(MPI_Comm comm, Chain *chain)
{
  const ContactInterface *interfaces;
  const char             *stated = NULL;
  PetscInt                n;
  PetscBool               loaded, is_static;

  PetscFunctionBeginUser;
  if (!chain->model) PetscFunctionReturn(0);
  PetscCall(ContactGetInterfaces(chain->contact, &n, &interfaces));
  PetscCall(ChainIsLoaded(chain, n, interfaces, &loaded));
  for (PetscInt i = n - 1; i >= 0; i--)
    if (interfaces[i].force > 0) stated = interfaces[i].name;
  PetscCall(ModesSetLoaded(chain->modes, loaded));
  PetscCall(ModesGetContact(chain->modes, &is_static));
  if (!stated) PetscFunctionReturn(0);
  PetscCall(ModesSetLoaded(chain->modes, PETSC_FALSE));
  PetscCall(ModesGetContact(chain->modes, &loaded));
  if (is_static && !loaded && 1U << chain->analysis & RUN_LINEAR)
    PetscCall(PetscPrintf(comm,
                          "note: -%s_force is that of all pairs closed: they are, and loads are not used; "
                          "-modes_contact static, without it, is about the loaded state\n",
                          stated));
  PetscFunctionReturn(0);
}

/* What not every analysis needs */
static PetscErrorCode ChainCreateAnalyses(MPI_Comm comm, Chain *chain)
{
  PetscFunctionBeginUser;
  PetscCall(DynamicsCreate(comm, &chain->dynamics));
  if (chain->model) PetscCall(DynamicsSetModel(chain->dynamics, chain->model, chain->contact));
  PetscCall(DynamicsSetSound(chain->dynamics, chain->sound));
  PetscCall(DynamicsSetFromOptions(chain->dynamics));
  PetscCall(ReducedCreate(comm, &chain->reduced));
  PetscCall(ReducedSetFromOptions(chain->reduced));
  PetscCall(MapCreate(comm, &chain->map));
  PetscCall(MapSetFromOptions(chain->map));
  PetscCall(CycleCreate(comm, &chain->cycle));
  PetscCall(CycleSetSound(chain->cycle, chain->sound));
  PetscCall(CycleSetFromOptions(chain->cycle));
  PetscCall(StaticsCreate(comm, &chain->statics));
  PetscCall(StaticsSetFromOptions(chain->statics));
  PetscCall(ModesCreate(comm, &chain->modes));
  PetscCall(ModesSetSound(chain->modes, chain->sound));
  PetscCall(ModesSetFromOptions(chain->modes));
  PetscCall(ChainChooseContact(comm, chain));
  PetscCall(SolverReadEigenOptions(comm));
  PetscCall(SolverReadFactorOptions(comm));
  PetscCall(SolverReadIterativeOptions(comm));
  PetscCall(SweepCreate(comm, &chain->sweep));
  PetscCall(SweepSetFromOptions(chain->sweep));
  PetscCall(SampleCreate(comm, &chain->sample));
  PetscCall(SampleSetFromOptions(chain->sample));
  PetscCall(QuietCreate(comm, &chain->quiet));
  PetscCall(QuietSetFromOptions(chain->quiet));
  PetscCall(DesignCreate(comm, &chain->design));
  PetscCall(DesignSetFromOptions(chain->design));
  PetscCall(FrfCreate(comm, &chain->frf));
  PetscCall(FrfSetSound(chain->frf, chain->sound));
  PetscCall(FrfSetFromOptions(chain->frf));
  PetscCall(SubstructureCreate(comm, &chain->substructure));
  PetscCall(SubstructureSetFromOptions(chain->substructure));
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
  PetscCall(ResultsDestroy(&chain->results));
  PetscCall(MapDestroy(&chain->map));
  PetscCall(CycleDestroy(&chain->cycle));
  PetscCall(ReducedDestroy(&chain->reduced));
  PetscCall(DynamicsDestroy(&chain->dynamics));
  PetscCall(SubstructureDestroy(&chain->substructure));
  PetscCall(FrfDestroy(&chain->frf));
  PetscCall(DesignDestroy(&chain->design));
  PetscCall(QuietDestroy(&chain->quiet));
  PetscCall(SampleDestroy(&chain->sample));
  PetscCall(SweepDestroy(&chain->sweep));
  PetscCall(ModesDestroy(&chain->modes));
  PetscCall(PencilDestroy(&chain->pencil));
  PetscCall(StaticsDestroy(&chain->statics));
  PetscCall(PetscFree(chain->p));
  PetscCall(OperatorsDestroy(&chain->operators));
  PetscCall(SoundDestroy(&chain->sound));
  PetscCall(ContactDestroy(&chain->contact));
  PetscCall(ModelDestroy(&chain->model));
  PetscFunctionReturn(0);
}

PetscErrorCode ChainGetScope(Chain *chain, Scope *scope)
{
  const AnalysisRow *row = &chain_analyses[chain->analysis];

  PetscFunctionBeginUser;
  *scope = (Scope){.analysis  = chain->analysis,
                   .does      = 1U << chain->analysis | row->does,
                   .uses      = row->uses,
                   .model     = chain->model,
                   .contact   = chain->contact,
                   .linear    = chain->modes,
                   .operators = chain->operators,
                   .statics   = chain->statics,
                   .dynamics  = chain->dynamics,
                   .reduced   = chain->reduced,
                   .results   = chain->results};
  if (row->add) PetscCall(row->add(chain, &scope->does));
  PetscFunctionReturn(0);
}

PetscErrorCode ChainVisit(void *ctx, const QuantityVisitor *visitor)
{
  Chain *chain = ctx;

  PetscFunctionBeginUser;
  PetscCall(SquealVisit(PETSC_COMM_WORLD, visitor));
  PetscCall(QuantitiesVisit(visitor, &chain_quantities, NULL, chain, NULL));
  PetscCall(QuantitiesVisit(visitor, &chain_views, NULL, chain, NULL));
  PetscCall(OperatorsVisit(chain->operators, visitor));
  if (chain->model) PetscCall(ModelVisit(chain->model, visitor));
  if (chain->contact) PetscCall(ContactVisit(chain->contact, visitor));
  PetscCall(SoundVisit(chain->sound, visitor));
  PetscCall(ResultsVisit(chain->results, visitor));
  PetscCall(DynamicsVisit(chain->dynamics, visitor));
  PetscCall(ReducedVisit(chain->reduced, visitor));
  PetscCall(MapVisit(chain->map, visitor));
  PetscCall(CycleVisit(chain->cycle, visitor));
  PetscCall(StaticsVisit(chain->statics, visitor));
  PetscCall(ModesVisit(chain->modes, visitor));
  PetscCall(SweepVisit(chain->sweep, visitor));
  PetscCall(SampleVisit(chain->sample, visitor));
  PetscCall(QuietVisit(chain->quiet, visitor));
  PetscCall(DesignVisit(chain->design, visitor));
  PetscCall(FrfVisit(chain->frf, visitor));
  PetscCall(SubstructureVisit(chain->substructure, visitor));
  PetscCall(SolverVisit(visitor));
  PetscFunctionReturn(0);
}

PetscErrorCode ChainCheckOptions(MPI_Comm comm, Chain *chain)
{
  Scope       scope;
  QuantityRun run;

  PetscFunctionBeginUser;
  PetscCall(ChainGetScope(chain, &scope));
  if (scope.uses == USES_ALL) PetscFunctionReturn(0); /* it reads what any analysis would */
  PetscCall(ScopeGetRun(comm, &scope, &run));
  PetscCall(ChainVisit(chain, &(QuantityVisitor){QuantitiesRefuse, &run}));
  PetscCall(ScopeCheckLaws(comm, &scope));
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
  PetscBool       pairs = PETSC_TRUE, reduced = PETSC_FALSE, matrices = PETSC_TRUE, areas;

  PetscFunctionBeginUser;
  PetscCall(ScopeNeedsAreas(chain->model ? chain->contact : NULL, &areas));
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
    if (pairs || areas)
      PetscCall(ContactSetUp(chain->contact));
    else
      PetscCall(ContactSetUpTies(chain->contact));
    PetscCall(SquealStageEnd(SQUEAL_CONTACT));
    if (1U << chain->analysis & (RUN_MODES | RUN_FRF | RUN_TRANSIENT | RUN_CYCLE)) PetscCall(SoundSetUp(chain->sound));
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
  PetscCall(StaticsSetWears(chain->statics, ChainIsInTime(chain) ? PETSC_FALSE : PETSC_TRUE));
  PetscCall(DynamicsSetOperators(chain->dynamics, chain->operators, chain->statics));
  PetscCall(ReducedSetRooms(chain->reduced, chain->dynamics, chain->modes));
  PetscCall(OperatorsCreatePoint(chain->operators, NULL, &chain->p));
  PetscCall(StaticsIdentifyAll(chain->statics, chain->p, viewer));
  PetscCall(SweepSetOperators(chain->sweep, chain->operators, chain->p));
  PetscCall(SweepSetModes(chain->sweep, chain->modes));
  PetscCall(ModesGetContact(chain->modes, &sliding));
  if (sliding) PetscCall(SweepSetStatics(chain->sweep, chain->statics));
  PetscCall(SampleSetRooms(chain->sample, chain->operators, chain->p, chain->modes, sliding ? chain->statics : NULL));
  PetscCall(DesignSetRooms(chain->design, chain->operators, chain->p, chain->modes, sliding ? chain->statics : NULL));
  PetscCall(QuietSetRooms(chain->quiet, chain->operators, chain->p, chain->modes, sliding ? chain->statics : NULL));
  PetscCall(MapSetRooms(chain->map, chain->reduced, chain->operators, chain->p));
  PetscCall(MapSetModes(chain->map, chain->modes));
  PetscCall(CycleSetRooms(chain->cycle, chain->reduced, chain->operators, chain->p));
  PetscCall(SubstructureSetOperators(chain->substructure, chain->operators, chain->p));
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
  PetscCall(OperatorsHaveTerms(chain->operators, &terms));
  if (chain->model) PetscCall(ContactCheckBodies(chain->contact, terms));
  PetscFunctionReturn(0);
}
