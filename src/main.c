/* squeal: friction-induced vibration of bodies in sliding contact */
#include "chain.h"

/* From options to results; what is made is left in the chain where it fails */
static PetscErrorCode RunChain(MPI_Comm comm, Chain *chain)
{
  PetscViewer viewer = PETSC_VIEWER_STDOUT_(comm);

  PetscFunctionBeginUser;
  PetscCall(ChainCreate(comm, chain));
  PetscCall(OptionsDropUnlisted(comm));
  PetscCall(QuantitiesCheckUnknown(comm, ChainVisit, chain));
  PetscCall(OptionsCheckValues(comm));
  PetscCall(ChainCheckOptions(comm, chain));
  if (chain->model) PetscCall(ModelCheckGiven(chain->model));
  PetscCall(ResultsKeepScene(chain->results, ChainVisit, chain));
  PetscCall(ResultsOpenDirectory(chain->results));
  PetscCall(ChainSetUp(chain, viewer));
  PetscCall(ChainView(chain));
  PetscCall(ChainRun(chain));
  PetscCall(ResultsFinish(chain->results));
  if (chain->view) PetscCall(SquealViewStages(comm, viewer));
  PetscCall(OptionsWarnUnused(comm));
  PetscFunctionReturn(0);
}

static PetscErrorCode Run(MPI_Comm comm)
{
  Chain          chain = {0};
  PetscErrorCode failure;

  PetscFunctionBeginUser;
  failure = RunChain(comm, &chain);
  if (failure) ResultsUnlock(chain.results);
  PetscCall(failure);
  PetscCall(ChainDestroy(&chain));
  PetscFunctionReturn(0);
}

/* What the command line is for: help, nothing, or a run */
static PetscErrorCode Answer(MPI_Comm comm, PetscBool no_arguments)
{
  PetscBool help;

  PetscFunctionBeginUser;
  PetscCall(ChainHelp(comm, &help));
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
