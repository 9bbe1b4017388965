/*
   Unit test of dynamics/run/stop.c: the first signal leaves a mark, the second ends the process, others are not touched,
   and handlers of before come back. Processes that are to die are children of this one.
*/
#include "dynamics/run/stop.h"
#include "check.h"
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

static volatile sig_atomic_t n_before = 0;

static void CountBefore(int number)
{
  (void)number;
  n_before++;
}

/* Signal that ends a child which gets signal a and then b while it listens; 0 when it lives through both */
static int EndedBy(int a, int b)
{
  const pid_t child  = fork();
  int         status = 0;

  if (child == 0) {
    (void)signal(a, SIG_DFL); /* libraries that are loaded with PETSc may have set their own */
    (void)signal(b, SIG_DFL);
    if (StopInstall()) _exit(1);
    raise(a);
    if (!StopRequested()) _exit(2);
    raise(b);
    _exit(0);
  }
  if (child < 0 || waitpid(child, &status, 0) != child) return -1;
  return WIFSIGNALED(status) ? WTERMSIG(status) : -WEXITSTATUS(status);
}

/* Breaks when: a signal is not caught, or keeps the process from being ended by a second one */
static int TestSignals(void)
{
  static const int signals[] = {SIGINT, SIGTERM, SIGUSR1};
  int              failed    = 0;

  for (int i = 0; i < 3; i++) {
    failed += CheckTrue("the first signal marks, the second ends", EndedBy(signals[i], signals[i]) == signals[i], i);
    failed += CheckTrue("a signal of another kind marks again", EndedBy(signals[i], signals[(i + 1) % 3]) == 0, i);
  }
  return failed + CheckTrue("other signals end the process as ever", EndedBy(SIGINT, SIGHUP) == SIGHUP, SIGHUP);
}

/* Breaks when: a mark of an earlier run stops the next one, or a handler of before is lost, also after the mark */
static int TestRemove(void)
{
  const struct sigaction count  = {.sa_handler = CountBefore};
  int                    failed = 0;

  if (sigaction(SIGTERM, &count, NULL)) return 1;
  for (int run = 1; run <= 2; run++) {
    failed += CheckTrue("listens", !StopInstall() && !StopRequested(), run);
    raise(SIGTERM);
    failed += CheckTrue("marked, and the handler of before not called", StopRequested() && n_before == run - 1, run);
    failed += CheckTrue("removed", !StopRemove() && !StopRemove(), run);
    raise(SIGTERM);
    failed += CheckTrue("the handler of before is called", n_before == run, n_before);
  }
  return failed;
}

int main(void)
{
  return TestSignals() + TestRemove() ? 1 : 0;
}
