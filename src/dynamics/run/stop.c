/*
   Stop: signals that ask a run to end. A handler can reach nothing but static memory.
*/
#include "stop.h"
#include <errno.h>
#include <signal.h>
#include <string.h>

#define N_SIGNALS 3

static const int             signals[N_SIGNALS] = {SIGINT, SIGTERM, SIGUSR1};
static struct sigaction      before[N_SIGNALS];
static PetscBool             listening = PETSC_FALSE;
static volatile sig_atomic_t requested = 0;

/* what a signal handler may do (C17 7.14.1.1): set a volatile sig_atomic_t */
static void NoteRequest(int number)
{
  (void)number;
  requested = 1;
}

PetscErrorCode StopInstall(void)
{
  struct sigaction action;

  PetscFunctionBeginUser;
  requested = 0;
  if (listening) PetscFunctionReturn(0);
  PetscCall(PetscMemzero(&action, sizeof(action)));
  action.sa_handler = NoteRequest;
  action.sa_flags   = SA_RESETHAND | SA_RESTART; /* once; calls that it interrupts go on */
  (void)sigemptyset(&action.sa_mask);
  for (int i = 0; i < N_SIGNALS; i++)
    PetscCheck(!sigaction(signals[i], &action, &before[i]), PETSC_COMM_SELF, PETSC_ERR_SYS,
               "cannot listen to signal %d: %s", signals[i], strerror(errno));
  listening = PETSC_TRUE;
  PetscFunctionReturn(0);
}

PetscErrorCode StopRemove(void)
{
  PetscFunctionBeginUser;
  for (int i = 0; i < N_SIGNALS && listening; i++)
    PetscCheck(!sigaction(signals[i], &before[i], NULL), PETSC_COMM_SELF, PETSC_ERR_SYS,
               "cannot give signal %d back: %s", signals[i], strerror(errno));
  listening = PETSC_FALSE;
  PetscFunctionReturn(0);
}

PetscBool StopRequested(void)
{
  return requested ? PETSC_TRUE : PETSC_FALSE;
}
