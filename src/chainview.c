/* Views of the objects of a run: -model_view and its like, and -squeal_view for all; its units */
#include "chain.h"

#define MODAL   (1 << ANALYSIS_MODES | 1 << ANALYSIS_FRF)
#define LINEAR  (MODAL | 1 << ANALYSIS_SWEEP)
#define AT_REST (LINEAR | 1 << ANALYSIS_STATIC)

static const struct {
  const char *option, *help;
  unsigned    in; /* bits of the analyses that have something to show */
} shown[N_SHOWN] = {
  [SHOWN_MODEL]     = {"-model_view", "show mesh, parts, supports, springs and loads", (1 << N_ANALYSES) - 1},
  [SHOWN_CONTACT]   = {"-contact_view", "show interfaces and their pairs", AT_REST},
  [SHOWN_OPERATORS] = {"-operators_view", "show the pencil of modes and sweeps, and its parameters", LINEAR},
  [SHOWN_STATICS]   = {"-static_view", "show the equilibrium", 1 << ANALYSIS_STATIC},
  [SHOWN_MODES]     = {"-modes_view", "show the modes found", MODAL},
  [SHOWN_SWEEP]     = {"-sweep_view", "show what a sweep found", 1 << ANALYSIS_SWEEP},
  [SHOWN_FRF]       = {"-frf_view", "show the frequency response and its peaks", 1 << ANALYSIS_FRF},
  [SHOWN_MAP]       = {"-map_view", "show regimes and cost of a map", 1 << ANALYSIS_MAP},
  [SHOWN_DYNAMICS]  = {"-dynamics_view", "show bodies, step and balances of a run in time", 1 << ANALYSIS_TRANSIENT},
  [SHOWN_CYCLE]     = {"-cycle_view", "show cycles, their stability and errors", 1 << ANALYSIS_CYCLE},
};

/* Whether the analysis has something to show there */
static PetscBool ChainShows(const Chain *chain, Shown what)
{
  return shown[what].in >> chain->analysis & 1 ? PETSC_TRUE : PETSC_FALSE;
}

PetscErrorCode ChainGetViewers(MPI_Comm comm, Chain *chain)
{
  PetscFunctionBeginUser;
  for (int i = 0; i < N_SHOWN; i++)
    PetscCall(OptionsGetViewer(comm, shown[i].option, shown[i].help, &chain->viewer[i]));
  PetscFunctionReturn(0);
}

PetscErrorCode ChainCheckViewers(MPI_Comm comm, const Chain *chain)
{
  PetscFunctionBeginUser;
  for (int i = 0; i < N_SHOWN; i++)
    if (chain->viewer[i] && !ChainShows(chain, (Shown)i))
      PetscCall(OptionsRefuse(comm, shown[i].option, "this analysis has nothing to show there"));
  PetscFunctionReturn(0);
}

/* The run in time */
static PetscErrorCode TransientView(Chain *chain, PetscViewer viewer)
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

static PetscErrorCode ShownView(Chain *chain, Shown what, PetscViewer viewer)
{
  const Scope scope = ChainGetScope(chain);

  PetscFunctionBeginUser;
  if (what == SHOWN_MODEL) PetscCall(ModelView(chain->model, viewer));
  if (what == SHOWN_MODEL) PetscCall(ScopeView(&scope, viewer));
  if (what == SHOWN_CONTACT) PetscCall(ContactView(chain->contact, viewer));
  if (what == SHOWN_OPERATORS) PetscCall(ChainLinearise(chain));
  if (what == SHOWN_OPERATORS) PetscCall(PencilView(chain->pencil, viewer));
  if (what == SHOWN_STATICS) PetscCall(StaticsView(chain->statics, viewer));
  if (what == SHOWN_MODES) PetscCall(ModesView(chain->modes, viewer));
  if (what == SHOWN_SWEEP) PetscCall(SweepView(chain->sweep, viewer));
  if (what == SHOWN_FRF) PetscCall(FrfView(chain->frf, viewer));
  if (what == SHOWN_DYNAMICS) PetscCall(TransientView(chain, viewer));
  if (what == SHOWN_MAP) PetscCall(MapView(chain->map, viewer));
  if (what == SHOWN_CYCLE) PetscCall(CycleView(chain->cycle, viewer));
  PetscFunctionReturn(0);
}

PetscErrorCode ChainShow(Chain *chain, Shown what, PetscBool wanted)
{
  const PetscViewer out = PETSC_VIEWER_STDOUT_(PETSC_COMM_WORLD);

  PetscFunctionBeginUser;
  if (wanted) PetscCall(ShownView(chain, what, out));
  if (chain->viewer[what] && !(wanted && chain->viewer[what] == out))
    PetscCall(ShownView(chain, what, chain->viewer[what]));
  PetscCall(PetscViewerDestroy(&chain->viewer[what]));
  PetscFunctionReturn(0);
}

PetscErrorCode ChainView(Chain *chain)
{
  PetscFunctionBeginUser;
  if (chain->model) PetscCall(ChainShow(chain, SHOWN_MODEL, chain->view));
  if (chain->contact && ChainShows(chain, SHOWN_CONTACT)) PetscCall(ChainShow(chain, SHOWN_CONTACT, chain->view));
  if (ChainShows(chain, SHOWN_OPERATORS)) PetscCall(ChainShow(chain, SHOWN_OPERATORS, chain->view));
  PetscFunctionReturn(0);
}

PetscErrorCode ChainSayUnits(Chain *chain)
{
  const char *units;
  MPI_Comm    comm;

  PetscFunctionBeginUser;
  PetscCall(ModelUnits(chain->model, &units));
  if (!units) PetscFunctionReturn(0);
  PetscCall(ResultsNote(chain->results, "units", "%s", units));
  PetscCall(ModelGetComm(chain->model, &comm));
  if (units[1] == 'm')
    PetscCall(PetscPrintf(
      comm, "units %s, by density and modulus of the parts: read mm, t, MPa, mJ where m, kg, Pa, J stand\n", units));
  PetscFunctionReturn(0);
}
