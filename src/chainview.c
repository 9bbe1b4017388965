/* Views of the objects of a run: -model_view and its like, and -squeal_view for all; its units */
#include "chain.h"
#include "base/options/help.h"

/* Whether the analysis has something to show there */
static PetscBool ChainShows(const Chain *chain, Shown what)
{
  const unsigned in = chain_views.row[what].in;

  return !in || in >> chain->analysis & 1 ? PETSC_TRUE : PETSC_FALSE;
}

static PetscErrorCode ShownView(Chain *chain, Shown what, PetscViewer viewer)
{
  Scope scope;

  PetscFunctionBeginUser;
  PetscCall(ChainGetScope(chain, &scope));
  if (what == SHOWN_MODEL) PetscCall(ModelView(chain->model, viewer));
  if (what == SHOWN_MODEL) PetscCall(OperatorsViewSuperelements(chain->operators, viewer));
  if (what == SHOWN_MODEL) PetscCall(StaticsViewStages(chain->statics, viewer));
  if (what == SHOWN_MODEL) PetscCall(ScopeView(&scope, viewer));
  if (what == SHOWN_CONTACT) PetscCall(ContactView(chain->contact, viewer));
  if (what == SHOWN_OPERATORS) PetscCall(ChainLinearise(chain));
  if (what == SHOWN_OPERATORS) PetscCall(PencilView(chain->pencil, viewer));
  for (int a = 0; a < N_ANALYSES; a++)
    if (chain_analyses[a].shown == what) PetscCall(chain_analyses[a].view(chain, viewer));
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

/* The rows, as a page or as JSON */
static PetscErrorCode ChainPrintRows(MPI_Comm comm, Chain *chain, HelpKind kind, PetscBool example)
{
  QuantityJson json = {.comm = comm};
  QuantityPage page = {.comm = comm, .example = example};

  PetscFunctionBeginUser;
  if (kind == HELP_JSON) {
    PetscCall(QuantitiesBeginJson(&json));
    PetscCall(ChainVisit(chain, &(QuantityVisitor){QuantitiesWriteJson, &json}));
    PetscCall(QuantitiesEndJson(&json));
    PetscFunctionReturn(0);
  }
  PetscCall(PetscPrintf(comm, "squeal %s: friction-induced vibration of bodies in sliding contact\n", SQUEAL_VERSION));
  PetscCall(ChainVisit(chain, &(QuantityVisitor){QuantitiesPrint, &page}));
  PetscCall(PetscPrintf(comm,
                        "PETSc's and SLEPc's own, such as -ts_max_time, -ts_dt, -eps_*, -pep_*, -st_*, -log_view, "
                        "-options_file%s\n",
                        kind == HELP_ALL ? ", as they print them, a viewer as ascii alone (also binary, draw, socket):"
                                         : ": squeal -help_all"));
  PetscFunctionReturn(0);
}

PetscErrorCode ChainHelp(MPI_Comm comm, PetscBool *asked)
{
  Chain     chain = {0}, again = {0};
  HelpKind  kind;
  PetscBool example;

  PetscFunctionBeginUser;
  PetscCall(HelpBegin(&kind, &example));
  *asked = kind == HELP_NONE ? PETSC_FALSE : PETSC_TRUE;
  if (!*asked) PetscFunctionReturn(0);
  PetscCall(ChainCreate(comm, &chain));
  PetscCall(ChainPrintRows(comm, &chain, kind, example));
  PetscCall(ChainDestroy(&chain));
  if (kind != HELP_ALL) PetscFunctionReturn(0);
  PetscCall(HelpShowLibraries(PETSC_TRUE));
  PetscCall(ChainCreate(comm, &again));
  PetscCall(ChainDestroy(&again));
  PetscCall(HelpShowLibraries(PETSC_FALSE));
  PetscFunctionReturn(0);
}
