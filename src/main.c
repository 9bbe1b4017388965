/* squeal: friction-induced vibration of bodies in sliding contact */
#include "chain.h"

/* Reads all options on a chain of its own, to list the valid names */
static PetscErrorCode ReadAgain(MPI_Comm comm, void *ctx)
{
  Chain chain = {0};

  PetscFunctionBeginUser;
  (void)ctx;
  PetscCall(ChainCreate(comm, &chain));
  PetscCall(ChainDestroy(&chain));
  PetscFunctionReturn(0);
}

/* From options to results; what is made is left in the chain where it fails */
static PetscErrorCode RunChain(MPI_Comm comm, Chain *chain)
{
  PetscViewer viewer = PETSC_VIEWER_STDOUT_(comm);

  PetscFunctionBeginUser;
  PetscCall(ChainCreate(comm, chain));
  PetscCall(OptionsDropUnlisted(comm));
  PetscCall(OptionsCheckUnknown(comm, ReadAgain, NULL));
  PetscCall(OptionsCheckValues(comm));
  PetscCall(ChainCheckOptions(comm, chain));
  if (chain->model) PetscCall(ModelCheckGiven(chain->model));
  PetscCall(ResultsKeepScene(chain->results, ReadAgain, NULL));
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
  PetscCall(SquealViewOptions(comm, ReadAgain, ChainWriteRows, NULL, &help));
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
