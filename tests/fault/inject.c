/*
   A library for LD_PRELOAD that lets one call of a program fail: the N-th one that opens, writes, flushes, renames or
   closes a file of a folder, or the N-th allocation. The environment holds the plan:

     FAULT_DIR     folder that is watched, as the program names it
     FAULT_CALLS   sum of the kinds of inject.h
     FAULT_AT      N, from 1; 0 lets nothing fail, and counts
     FAULT_ERRNO   what the call fails with
     FAULT_STAY    1: all calls after it fail as well, as on a full disk; the first write then takes half of its bytes
     FAULT_SIGNAL  a signal that the process gets before the call instead of a failure: 9 kills it there
     FAULT_RANK    rank of MPI whose calls count, 0 by default
     FAULT_ASK     in place of FAULT_AT: a socket of a test that names the calls; at each the run copies itself (branch.c)
     FAULT_NO_LOCKS  flock(2) fails, whatever else is planned
     FAULT_REPORT  file for the number of calls, whether one failed, and which one: int64, int64, text

   Allocations are told apart by who asks: the program itself (memory.c). serve.c starts the program again and again
   without loading its libraries each time.
*/
#define _GNU_SOURCE
#include "inject.h"
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <unistd.h>

typedef struct {
  int64_t count, failed;
  char    words[240];
} Report;

static struct {
  const char *dir;
  int         calls, error, stay, signal;
  int64_t     at;
  Report     *report;
} plan;

void FaultNext(const char name[], void *function)
{
  *(void **)function = dlsym(RTLD_NEXT, name);
}

static long Number(const char name[])
{
  const char *text = getenv(name);

  return text ? atol(text) : 0;
}

/* The report as shared memory, which outlives the process however it ends; the file is made by system calls that
   nobody watches */
static Report *ReportOpen(const char path[])
{
  const int fd    = (int)syscall(SYS_openat, AT_FDCWD, path, O_RDWR | O_CREAT | O_TRUNC, 0666);
  void     *found = MAP_FAILED;

  if (fd >= 0 && !syscall(SYS_ftruncate, fd, sizeof(Report)))
    found = mmap(NULL, sizeof(Report), PROT_READ | PROT_WRITE, MAP_SHARED, fd, 0);
  if (fd >= 0) (void)syscall(SYS_close, fd);
  return found == MAP_FAILED ? NULL : found;
}

void FaultSetUp(void)
{
  const char *path = getenv("FAULT_REPORT"), *rank = getenv("OMPI_COMM_WORLD_RANK"), *ask = getenv("FAULT_ASK");

  if (!path || (rank ? atol(rank) : 0) != Number("FAULT_RANK")) return;
  plan.report = ReportOpen(path);
  plan.dir    = getenv("FAULT_DIR");
  plan.at     = Number("FAULT_AT");
  plan.error  = (int)Number("FAULT_ERRNO");
  plan.stay   = (int)Number("FAULT_STAY");
  plan.signal = (int)Number("FAULT_SIGNAL");
  FaultMemorySetUp();
  if (ask && !FaultBranchSetUp(ask)) _exit(89);
  if (plan.report) plan.calls = (int)Number("FAULT_CALLS");
}

int FaultPathWatched(const char path[])
{
  return plan.report && plan.dir && !strncmp(path, plan.dir, strlen(plan.dir));
}

/* From here on the calls of this process, a copy, are its own, and this one is to fail */
static void PlanCopied(int64_t n)
{
  static Report own;

  own         = *plan.report;
  plan.report = &own;
  plan.at     = n;
}

int FaultTake(int kind, const char words[])
{
  int64_t n;

  if (!(plan.calls & kind)) return 0;
  n = __atomic_add_fetch(&plan.report->count, 1, __ATOMIC_RELAXED);
  if (FaultBranch(n, words)) PlanCopied(n);
  if (plan.at == 0 || n < plan.at || (n > plan.at && !plan.stay)) return 0;
  if (n == plan.at) (void)snprintf(plan.report->words, sizeof(plan.report->words), "%s", words);
  plan.report->failed++;
  if (plan.signal) (void)kill(getpid(), plan.signal);
  if (plan.signal) return 0;
  errno = plan.error;
  return n == plan.at && plan.stay && kind == FAULT_WRITE ? 2 : 1;
}
