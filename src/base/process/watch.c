/*
   A rank that is killed, by the system where memory runs out or by a person, can say nothing, and the launcher then
   kills the others before one of them could. Hence each of several ranks has a parent, which waits: it says which rank
   was killed, by which signal, and where results are, and dies of the same signal, so that the launcher sees what it
   would have seen. Signals of the launcher it passes on; the rank is in a process group of its own, else it would get
   them twice. Each dies with its parent, prctl(2), so that none is left where only one is killed.

   SIGINT and SIGTERM have a line already (interrupt.c), as have faults of the program, which PETSc catches.
*/
#define _DEFAULT_SOURCE /* MAP_ANONYMOUS */
#include "watch.h"
#include <errno.h>
#include <limits.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

static pid_t watched;       /* the rank, for the handler */
static char *folder = NULL; /* [PATH_MAX] that rank and parent share: empty until there are results */

static void PassOn(int number)
{
  (void)kill(watched, number);
}

/* Signals pass through; the rank ignores what nohup and & wish, or not */
static void WatchSignals(void)
{
  static const int passed[] = {SIGHUP, SIGINT, SIGQUIT, SIGTERM, SIGUSR1, SIGUSR2, SIGTSTP, SIGCONT};
  struct sigaction action   = {.sa_handler = PassOn, .sa_flags = SA_RESTART};

  for (size_t i = 0; i < sizeof(passed) / sizeof(passed[0]); i++) (void)sigaction(passed[i], &action, NULL);
}

static void WatchSay(const char rank[], int number)
{
  const char *const name  = number == SIGKILL ? "SIGKILL" : number == SIGXCPU ? "SIGXCPU" : strsignal(number);
  const char *const cause = number == SIGKILL ? ", by the system where memory has run out, or by hand" : "";
  const char *const where = folder[0] ? "files in " : "nothing has been written";
  const char *const kept  = folder[0] ? " that bear their final name are complete" : "";
  char              line[PATH_MAX + 256];
  const int n = snprintf(line, sizeof(line), "squeal: error: rank %s was killed by %s%s; %s%s%s\n", rank, name, cause,
                         where, folder, kept);

  if (write(STDERR_FILENO, line, (size_t)n) < 0) return; /* nobody reads */
}

/* Waits for the rank, and ends as it does */
static void WatchEnd(const char rank[])
{
  const struct rlimit none = {0, 0};
  int                 status, number;

  while (waitpid(watched, &status, 0) < 0)
    if (errno != EINTR) _exit(1);
  if (WIFEXITED(status)) _exit(WEXITSTATUS(status));
  number = WTERMSIG(status);
  if (number != SIGINT && number != SIGTERM) WatchSay(rank, number);
  (void)setrlimit(RLIMIT_CORE, &none); /* the rank has left its own */
  (void)signal(number, SIG_DFL);
  (void)raise(number);
  _exit(1);
}

void WatchBegin(void)
{
  const char *const size = getenv("OMPI_COMM_WORLD_SIZE"), *const rank = getenv("OMPI_COMM_WORLD_RANK");
  const pid_t parent = getpid();

  if (!size || !rank || atoi(size) < 2) return;
  folder = mmap(NULL, PATH_MAX, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (folder == MAP_FAILED) folder = NULL;
  (void)signal(SIGCHLD, SIG_DFL); /* else nobody learns how the rank ended */
  watched = folder ? fork() : -1;
  if (watched > 0) {
    WatchSignals();
    (void)prctl(PR_SET_PDEATHSIG, SIGKILL);
    WatchEnd(rank);
  }
  if (watched) return; /* no memory for that: the rank goes on alone */
  (void)prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(1); /* it was killed before that */
  (void)setpgid(0, 0);
}

void WatchFolder(const char name[])
{
  if (folder) (void)snprintf(folder, PATH_MAX, "%s", name);
}
