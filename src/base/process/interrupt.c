/*
   The end by ^C or SIGTERM: one line on stderr and in the log, then the end that the signal brings, hence exit status
   130 or 143 in a shell. mpirun asks all its ranks at once, of which the first speaks; whoever asks a single rank gets
   the line from that one. A run in time listens itself while it steps (dynamics/run/stop.h). After an error that rank
   says nothing more: MPI_Abort() makes mpirun end all ranks by SIGTERM. Where another rank failed alone, for want of
   memory, the first one cannot know that from a request by the user, and may say so in a second line.

   A handler may call nothing that locks or allocates, and reaches nothing but static memory.
*/
#include "print.h"
#include "interrupt.h"
#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

static const int             signals[]  = {SIGINT, SIGTERM};
static volatile sig_atomic_t first_rank = 0;
static pid_t                 launcher   = 0;
static char                  removed[PETSC_MAX_PATH_LEN]; /* a file that goes then; empty for none */
static char                  left[2][256] = {"nothing was finished"};
static volatile sig_atomic_t said         = 0; /* which of them holds; the other one may be being written */

static void InterruptEnd(int number, siginfo_t *info, void *ctx)
{
  char line[320] = "squeal: error: stopped by ";

  (void)ctx;
  (void)strcat(line, number == SIGINT ? "SIGINT; " : "SIGTERM; ");
  (void)strcat(line, left[said]);
  (void)strcat(line, "\n");
  if (first_rank || info->si_pid != launcher) PrintAtOnce(line);
  if (removed[0]) (void)unlink(removed);
  (void)raise(number); /* the action before is the default one again */
}

void InterruptSays(const char format[], ...)
{
  va_list values;

  va_start(values, format);
  (void)vsnprintf(left[!said], sizeof(left[0]), format, values);
  va_end(values);
  said = !said;
}

void InterruptRemoves(const char path[])
{
  (void)strncpy(removed, path, sizeof(removed) - 1);
}

PetscErrorCode InterruptInstall(MPI_Comm comm)
{
  struct sigaction action, before;
  PetscMPIInt      rank;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  first_rank = rank == 0;
  launcher   = getppid();
  PetscCall(PetscMemzero(&action, sizeof(action)));
  action.sa_sigaction = InterruptEnd;
  action.sa_flags     = SA_SIGINFO | SA_RESETHAND | SA_NODEFER;
  (void)sigemptyset(&action.sa_mask);
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(signals); i++) {
    if (!sigaction(signals[i], NULL, &before) && before.sa_handler == SIG_IGN) continue; /* as nohup and & wish */
    (void)sigaction(signals[i], &action, NULL);
  }
  PetscFunctionReturn(0);
}

void InterruptRemove(void)
{
  struct sigaction before;

  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(signals); i++)
    if (!sigaction(signals[i], NULL, &before) && before.sa_handler != SIG_IGN) (void)signal(signals[i], SIG_DFL);
}
