/*
   Instead of a whole run for each call that fails, one run copies itself (fork(2)) at each of them: in the copy the call
   fails, and the run waits for the copy's end, then goes on as if nothing had been. What lies before the call, most of a
   run, is done once. FAULT_ASK is the path of a socket of the test (branches.py), which talks to the run so:

     test -> run   int64   number of the next call to fail, 0 for none
     run  -> test  Record  that call has come, in words; the test then puts a copy of the folder in place of the folder,
                           which is renamed to FAULT_DIR.kept
     test -> run   int64   anything: copy yourself
     run  -> test  int64   process of the copy, then at its end the status of waitpid(2); the test puts the folder back,
                           and the exchange begins again

   A copy has none of the run's other threads. Open MPI 5 waits for one of them in MPI_Finalize(), which a copy leaves out
   therefore: it is alone, and nothing of squeal follows. For the same reason MPI_Abort() just ends it.
*/
#define _GNU_SOURCE
#include "inject.h"
#include <errno.h>
#include <mpi.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

typedef struct {
  int64_t n;
  char    words[240];
} Record;

static int     copied;    /* whether this is a copy */
static int     test = -1; /* the socket */
static int64_t next;

/* Ends this run where the test has ended */
static int64_t Hear(void)
{
  int64_t value = 0;
  ssize_t n;

  do n = recv(test, &value, sizeof(value), MSG_WAITALL);
  while (n < 0 && errno == EINTR);
  if (n != (ssize_t)sizeof(value)) _exit(91);
  return value;
}

static void Tell(const void *what, size_t size)
{
  if (send(test, what, size, MSG_NOSIGNAL) != (ssize_t)size) _exit(90);
}

int FaultBranchSetUp(const char path[])
{
  struct sockaddr_un address = {.sun_family = AF_UNIX};

  if (strlen(path) >= sizeof(address.sun_path)) return 0;
  (void)strcpy(address.sun_path, path);
  test = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  if (test < 0 || connect(test, (struct sockaddr *)&address, sizeof(address))) return 0;
  next = Hear();
  return 1;
}

int FaultBranch(int64_t n, const char words[])
{
  Record  record = {.n = n};
  int64_t value;
  int     status = 0;

  if (test < 0 || n != next) return 0;
  (void)snprintf(record.words, sizeof(record.words), "%s", words);
  Tell(&record, sizeof(record));
  (void)Hear();
  value = fork();
  if (value == 0) {
    (void)syscall(SYS_close, test);
    test   = -1;
    copied = 1;
    FaultFilesCopied();
    return 1;
  }
  Tell(&value, sizeof(value));
  while (value > 0 && waitpid((pid_t)value, &status, 0) < 0 && errno == EINTR) continue;
  value = status;
  Tell(&value, sizeof(value));
  next = Hear();
  return 0;
}

int MPI_Finalize(void)
{
  int (*next)(void);

  if (copied) return MPI_SUCCESS;
  FaultNext("MPI_Finalize", &next);
  return next();
}

int MPI_Abort(MPI_Comm comm, int status)
{
  int (*next)(MPI_Comm, int);

  if (copied) (void)fflush(NULL);
  if (copied) _exit(status);
  FaultNext("MPI_Abort", &next);
  return next(comm, status);
}
