/* Views of the objects of a run: -model_view and its like, and -squeal_view for all; its units */
#include "chain.h"

/* Whether the analysis has something to show there */
static PetscBool ChainShows(const Chain *chain, Shown what)
{
  const unsigned in = chain_views.row[what].in;

  return !in || in >> chain->analysis & 1 ? PETSC_TRUE : PETSC_FALSE;
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
  PetscBool shown;

  PetscFunctionBeginUser;
  if (chain->model) PetscCall(ChainShow(chain, SHOWN_MODEL, chain->view));
  if (chain->contact && ChainShows(chain, SHOWN_CONTACT)) PetscCall(ChainShow(chain, SHOWN_CONTACT, chain->view));
  shown = chain->view && chain->analysis != ANALYSIS_CHECK ? PETSC_TRUE : PETSC_FALSE; /* may take an equilibrium */
  if (ChainShows(chain, SHOWN_OPERATORS)) PetscCall(ChainShow(chain, SHOWN_OPERATORS, shown));
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

PetscErrorCode ChainWriteRows(MPI_Comm comm, void *ctx)
{
  QuantityJson json  = {.comm = comm};
  Chain        chain = {0};

  PetscFunctionBeginUser;
  (void)ctx;
  PetscCall(ChainCreate(comm, &chain));
  PetscCall(QuantitiesBeginJson(&json));
  PetscCall(ChainVisit(comm, &chain, &(QuantityVisitor){QuantitiesWriteJson, &json}));
  PetscCall(QuantitiesEndJson(&json));
  PetscCall(ChainDestroy(&chain));
  PetscFunctionReturn(0);
}
