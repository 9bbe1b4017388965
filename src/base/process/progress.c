/*
   Progress on stderr with the time left: on a terminal one line that is written over, elsewhere, with
   -squeal_progress 1, a line every five seconds.
*/
#include "progress.h"
#include <petsctime.h>
#include <unistd.h>

#define PROGRESS_SILENCE 2. /* s of a loop before it shows, on a terminal */
#define PROGRESS_PERIOD  5. /* s between lines elsewhere */

/* Log handles, alike for all who make progress */
static struct {
  PetscBool      on, terminal;
  PetscLogDouble begun, shown; /* of the run; of the last line */
} screen;

PetscErrorCode ProgressShow(MPI_Comm comm, PetscBool given, PetscBool show)
{
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  screen.terminal = isatty(STDERR_FILENO) ? PETSC_TRUE : PETSC_FALSE;
  screen.on       = given ? show : screen.terminal;
  if (rank) screen.on = PETSC_FALSE;
  if (!screen.begun) PetscCall(PetscTime(&screen.begun));
  PetscFunctionReturn(0);
}

PetscErrorCode ProgressStage(const char name[])
{
  PetscLogDouble now;

  PetscFunctionBeginUser;
  if (!screen.on) PetscFunctionReturn(0);
  PetscCall(PetscTime(&now));
  PetscCall(PetscFPrintf(PETSC_COMM_SELF, stderr, screen.terminal ? "\r%-50s%6.0f s" : "%s after %.0f s\n", name,
                         now - screen.begun));
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
  PetscLogDouble now, left;

  PetscFunctionBeginUser;
  progress->done++;
  if (!screen.on || !progress->what) PetscFunctionReturn(0);
  PetscCall(PetscTime(&now));
  if (now - progress->begun < PROGRESS_SILENCE) PetscFunctionReturn(0);
  if (now - screen.shown < (screen.terminal ? 0.2 : PROGRESS_PERIOD)) PetscFunctionReturn(0);
  screen.shown       = now;
  progress->expected = PetscMax(progress->expected, progress->done);
  left               = (now - progress->begun) * (double)(progress->expected - progress->done) / (double)progress->done;
  PetscCall(PetscFPrintf(PETSC_COMM_SELF, stderr,
                         screen.terminal ? "\r%s: %" PetscInt_FMT " of about %" PetscInt_FMT ", %.0f s left   "
                                         : "%s: %" PetscInt_FMT " of about %" PetscInt_FMT ", %.0f s left\n",
                         progress->what, progress->done, progress->expected, left));
  PetscFunctionReturn(0);
}

PetscErrorCode ProgressEnd(Progress *progress)
{
  PetscFunctionBeginUser;
  progress->what = NULL;
  if (screen.on && screen.terminal) PetscCall(PetscFPrintf(PETSC_COMM_SELF, stderr, "\r%78s\r", ""));
  PetscFunctionReturn(0);
}
