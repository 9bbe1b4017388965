/*
   The lock of a folder: two runs that write into one would mix their rows. The first rank holds a lock (flock(2)) on a
   file in it, which the system takes back however the run ends. Where a file system has no locks, the file says who
   writes: a process of this machine that is gone, or has given its number to another, is no run.
*/
#include "resultsimpl.h"
#include "base/file.h"
#include "base/process/interrupt.h"
#include <errno.h>
#include <fcntl.h>
#include <petsctime.h>
#include <signal.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#define LOCK_FILE  ".squeal.lock"
#define LOCK_TRIES 60   /* ranks whose launcher was killed take one to two seconds to end */
#define LOCK_WAIT  0.05 /* s between them */

/* Who writes: a process, its launcher or shell, when it began in ticks of the system, and its machine */
typedef struct {
  long               process, parent;
  unsigned long long begun;
  char               machine[128];
} LockOwner;

/* When a process began, 0 where there is none: field 22 of proc_pid_stat(5), the 20th after the name in parentheses;
   and its parent, the 2nd */
static unsigned long long ProcessBegun(long process, long *parent)
{
  char               path[64], text[1024] = "", *rest;
  unsigned long long begun = 0;
  FILE              *file;

  (void)snprintf(path, sizeof(path), "/proc/%ld/stat", process);
  *parent = 0;
  file    = fopen(path, "r");
  if (!file) return 0;
  if (!fgets(text, sizeof(text), file)) text[0] = '\0';
  (void)fclose(file);
  rest = strrchr(text, ')');
  if (rest)
    (void)sscanf(rest + 1, " %*c %ld %*d %*d %*d %*d %*u %*u %*u %*u %*u %*u %*u %*d %*d %*d %*d %*d %*d %llu", parent,
                 &begun);
  return begun;
}

static LockOwner LockSelf(void)
{
  LockOwner self = {.process = (long)getpid()};

  self.begun = ProcessBegun(self.process, &self.parent);
  if (gethostname(self.machine, sizeof(self.machine) - 1)) self.machine[0] = '\0';
  return self;
}

/* Who the file says it is; process 0 for nobody */
static LockOwner LockRead(int fd)
{
  LockOwner     owner     = {.process = 0};
  char          text[256] = "";
  const ssize_t n         = pread(fd, text, sizeof(text) - 1, 0);

  if (n <= 0 || sscanf(text, "%ld %llu %127s %ld", &owner.process, &owner.begun, owner.machine, &owner.parent) < 2)
    owner.process = 0;
  return owner;
}

/* Whether whom the file names is another run, which may still go on. `sure` where that is known */
static PetscBool LockOwnerLives(const LockOwner *owner, PetscBool *sure)
{
  const LockOwner self = LockSelf();
  long            parent;

  *sure = strcmp(owner->machine, self.machine) ? PETSC_FALSE : PETSC_TRUE;
  if (!owner->process || (*sure && owner->process == self.process)) return PETSC_FALSE;
  if (!*sure) return PETSC_TRUE;
  return kill((pid_t)owner->process, 0) && errno == ESRCH ? PETSC_FALSE
                                                          : ProcessBegun(owner->process, &parent) == owner->begun;
}

/* Whether the file is still there under its name: whoever held it may have removed it in between */
static PetscBool LockIsNamed(int fd, const char path[])
{
  struct stat here, there;

  return !fstat(fd, &here) && !stat(path, &there) && here.st_ino == there.st_ino && here.st_dev == there.st_dev;
}

/* Tries to take the lock: the errno of a failure, EWOULDBLOCK where another run has it, ENOLCK where there are no
   locks */
static int LockTry(const char path[], int *fd)
{
  int error = 0;

  do {
    *fd = FileOpen(path, O_RDWR | O_CREAT | O_NOFOLLOW);
    if (*fd < 0) return errno;
    if (flock(*fd, LOCK_EX | LOCK_NB)) error = errno == EWOULDBLOCK ? errno : ENOLCK;
    if (error == EWOULDBLOCK) return error;
  } while (!LockIsNamed(*fd, path) && !close(*fd));
  return error;
}

/* Whether who has the lock may be about to end: it has not said yet who it is, or its launcher or shell is gone */
static PetscBool LockOwnerEnds(const LockOwner *owner)
{
  const LockOwner self = LockSelf();
  long            parent;

  if (!owner->process) return PETSC_TRUE;
  if (strcmp(owner->machine, self.machine)) return PETSC_FALSE;
  return ProcessBegun(owner->process, &parent) != owner->begun || parent != owner->parent ? PETSC_TRUE : PETSC_FALSE;
}

/* The same, for three seconds again and again where who has it may be about to end; owner = who that is where another
   run does */
static int LockWait(const char path[], int *fd, LockOwner *owner)
{
  int error = LockTry(path, fd);

  for (int i = 0; error == EWOULDBLOCK; i++) {
    *owner = LockRead(*fd);
    (void)close(*fd);
    *fd = -1;
    if (i == LOCK_TRIES || !LockOwnerEnds(owner)) break;
    (void)PetscSleep(LOCK_WAIT);
    error = LockTry(path, fd);
  }
  return error;
}

/* Where there are no locks: the owner that the file names decides, and is warned of where nobody can know */
static PetscErrorCode LockAsk(Results results, LockOwner *owner, int *error)
{
  PetscBool sure = PETSC_TRUE, lives;

  PetscFunctionBeginUser;
  *owner = LockRead(results->lock);
  lives  = LockOwnerLives(owner, &sure);
  *error = lives && sure ? EWOULDBLOCK : 0;
  if (lives && !sure)
    PetscCall(PetscFPrintf(PETSC_COMM_SELF, stderr,
                           "squeal: warning: process %ld on %s may still write into %s, whose file system has no locks "
                           "that would tell: both runs would spoil each other's files\n",
                           owner->process, owner->machine, results->dir));
  PetscFunctionReturn(0);
}

/* Takes the lock on the rank that calls, and says who has it */
static PetscErrorCode LockTake(Results results, const char path[], LockOwner *owner, int *error)
{
  const LockOwner self = LockSelf();
  char            text[256];

  PetscFunctionBeginUser;
  *error = LockWait(path, &results->lock, owner);
  if (*error == ENOLCK) PetscCall(LockAsk(results, owner, error));
  PetscCall(
    PetscSNPrintf(text, sizeof(text), "%ld %llu %s %ld\n", self.process, self.begun, self.machine, self.parent));
  if (!*error && (ftruncate(results->lock, 0) || pwrite(results->lock, text, strlen(text), 0) < 0)) *error = errno;
  if (*error && results->lock >= 0) (void)close(results->lock);
  if (*error) results->lock = -1;
  if (!*error) InterruptRemoves(path);
  PetscFunctionReturn(0);
}

PetscErrorCode ResultsLock(Results results)
{
  char        path[PETSC_MAX_PATH_LEN];
  LockOwner   owner = {.process = 0};
  PetscMPIInt rank;
  int         error = 0;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(results->comm, &rank));
  PetscCall(PetscSNPrintf(path, sizeof(path), "%s/" LOCK_FILE, results->dir));
  if (rank == 0) PetscCall(LockTake(results, path, &owner, &error));
  PetscCallMPI(MPI_Bcast(&error, 1, MPI_INT, 0, results->comm));
  PetscCallMPI(MPI_Bcast(&owner, (PetscMPIInt)sizeof(owner), MPI_BYTE, 0, results->comm));
  PetscCheck(
    error != EWOULDBLOCK, results->comm, PETSC_ERR_FILE_OPEN,
    "another run writes into the folder -output_dir %s: process %ld on %s; choose another, or wait for its end",
    results->dir, owner.process, owner.machine);
  PetscCheck(!error, results->comm, PETSC_ERR_FILE_OPEN, "cannot write %s: %s; choose another -output_dir", path,
             FileReason(error));
  PetscFunctionReturn(0);
}

void ResultsUnlock(Results results)
{
  char path[PETSC_MAX_PATH_LEN + sizeof(LOCK_FILE)];

  if (!results || results->lock < 0) return;
  (void)snprintf(path, sizeof(path), "%s/" LOCK_FILE, results->dir);
  InterruptRemoves("");
  (void)unlink(path); /* before the lock goes, so that nobody's own is removed */
  (void)close(results->lock);
  results->lock = -1;
}
