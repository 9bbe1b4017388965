/*
   Progress line on stderr with the time left; quiet when stderr is no terminal, unless -squeal_progress 1.
*/
#include "progress.h"
#include <squeal/options.h>
#include <petsctime.h>
#include <unistd.h>

PetscErrorCode ProgressSetFromOptions(MPI_Comm comm, Progress *progress)
{
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  progress->on = isatty(STDERR_FILENO) ? PETSC_TRUE : PETSC_FALSE;
  PetscOptionsBegin(comm, NULL, "Progress", NULL);
  PetscCall(OptionsGetBool(PetscOptionsObject, "-squeal_progress",
                           "progress line on stderr; by default where it is a terminal", &progress->on));
  PetscOptionsEnd();
  if (rank) progress->on = PETSC_FALSE;
  PetscFunctionReturn(0);
}

PetscErrorCode ProgressBegin(Progress *progress, const char what[], PetscInt expected)
{
  PetscFunctionBeginUser;
  progress->what     = what;
  progress->done     = 0;
  progress->expected = expected;
  PetscCall(PetscTime(&progress->begun));
  PetscFunctionReturn(0);
}

PetscErrorCode ProgressStep(Progress *progress)
{
  PetscLogDouble now;

  PetscFunctionBeginUser;
  progress->done++;
  if (!progress->on || (progress->expected > 100 && progress->done % 5)) PetscFunctionReturn(0);
  PetscCall(PetscTime(&now));
  if (now - progress->begun < 2) PetscFunctionReturn(0);
  progress->expected = PetscMax(progress->expected, progress->done);
  progress->shown    = PETSC_TRUE;
  PetscCall(
    PetscFPrintf(PETSC_COMM_SELF, stderr, "\r%s: solve %" PetscInt_FMT " of about %" PetscInt_FMT ", %.0f s left   ",
                 progress->what, progress->done, progress->expected,
                 (now - progress->begun) * (double)(progress->expected - progress->done) / (double)progress->done));
  PetscFunctionReturn(0);
}

PetscErrorCode ProgressEnd(Progress *progress)
{
  PetscFunctionBeginUser;
  if (progress->shown) PetscCall(PetscFPrintf(PETSC_COMM_SELF, stderr, "\r%70s\r", ""));
  progress->shown = PETSC_FALSE;
  PetscFunctionReturn(0);
}
